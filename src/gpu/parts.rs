//! The buffer that all objects' tables and bands share: what stands where.

use super::cuts::Cut;
use std::sync::Arc;

/// Parts of the buffer, one after the other; objects of one cut share theirs.
#[derive(Default)]
pub(crate) struct Parts {
    parts: Vec<Part>,
    end: usize,
}

struct Part {
    cut: Arc<Cut>,
    of: Of,
    begin: usize,
}

/// Which of a cut's two parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Of {
    /// What searches walk.
    Tables,
    /// What `hull.vert` and `convex_hull.vert` grow.
    Bands,
}

impl Part {
    fn vectors(&self) -> &[[u32; 4]] {
        match self.of {
            Of::Tables => &self.cut.tables().vectors,
            Of::Bands => &self.cut.shell().vectors,
        }
    }

    fn is(&self, cut: &Arc<Cut>, of: Of) -> bool {
        Arc::ptr_eq(&self.cut, cut) && self.of == of
    }
}

impl Parts {
    /// The vector of the buffer with which a part of a cut begins, a multiple of `align`.
    pub fn place(&mut self, cut: &Arc<Cut>, of: Of, align: usize) -> u32 {
        let known = self.parts.iter().find(|p| p.is(cut, of));
        let begin = known.map(|p| p.begin).unwrap_or_else(|| {
            let begin = self.end.next_multiple_of(align);
            let cut = cut.clone();
            let part = Part { cut, of, begin };
            self.end = begin + part.vectors().len();
            self.parts.push(part);
            begin
        });
        u32::try_from(begin).unwrap_or(u32::MAX)
    }

    /// Vectors of all parts, and of what is left free between them.
    pub fn end(&self) -> usize {
        self.end
    }

    /// Where each part begins, and what it holds.
    pub fn vectors(&self) -> impl Iterator<Item = (usize, &[[u32; 4]])> {
        self.parts.iter().map(|p| (p.begin, p.vectors()))
    }

    /// Whether a buffer would hold the same.
    pub fn same(&self, other: &Self) -> bool {
        let pairs = || self.parts.iter().zip(&other.parts);
        self.parts.len() == other.parts.len()
            && pairs().all(|(a, b)| a.is(&b.cut, b.of) && a.begin == b.begin)
    }
}
