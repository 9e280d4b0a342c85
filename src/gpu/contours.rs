//! The quadric search's tables, made anew whenever an offset moves.

use crate::error::{Error, Result};
use crate::pieces::{ContourSource, CutOptions, Piece, Tables, cut};
use crate::profile::{Profile, Shape};
use crate::scene::{Object, Offset, Scene};
use crate::shader::generated::PIECE_ROWS;
use std::sync::Arc;

/// What does not depend on the offset, of one object; objects of one profile share it.
#[derive(Clone)]
pub(crate) struct Contours {
    profile: Arc<Profile>,
    source: Arc<ContourSource>,
}

impl Contours {
    /// Of every object of a scene, in order.
    pub fn of(scene: &Scene) -> Result<Vec<Self>> {
        let mut all: Vec<Self> = Vec::new();
        for (number, object) in scene.objects.iter().enumerate() {
            let known = all
                .iter()
                .find(|c| Arc::ptr_eq(&c.profile, &object.profile))
                .cloned();
            all.push(match known {
                Some(known) => known,
                None => Self::new(object).map_err(|e| named(e, number, object))?,
            });
        }
        Ok(all)
    }

    fn new(object: &Object) -> Result<Self> {
        let source = match &object.profile.shape {
            Shape::Outline(outline) => ContourSource::new(outline),
            Shape::Raster(raster) => ContourSource::new(&raster.outline()),
        }?;
        Ok(Self {
            profile: object.profile.clone(),
            source: Arc::new(source),
        })
    }

    /// The boundary under `offset`.
    pub fn pieces(&self, offset: &Offset) -> Result<Vec<Piece>> {
        let contour = self.source.contour(offset)?;
        Ok(cut(&contour, &CutOptions::default()))
    }
}

/// Tables in a buffer, in vectors of 16 bytes.
pub(crate) struct Placed {
    /// As `Solid.pieces` of `blocks.glsl` has it.
    pub block: [u32; 4],
    /// What the search itself reads, from their beginning on.
    pub vectors: usize,
}

/// Appends the tables of these pieces to `out`, from the next multiple of `align` vectors on; their layout is `piece_tables.glsl`'s.
pub(crate) fn append_tables(pieces: &[Piece], align: usize, out: &mut Vec<[u32; 4]>) -> Placed {
    let tables = Tables::new(pieces, PIECE_ROWS);
    let largest = tables.nodes.iter().fold(f32::MIN_POSITIVE, |m, n| m.max(n[1]));
    // A little more than what 16 bits hold, so that roundings of the product stay inside.
    let unit = largest * (1.0 + 1e-6) / 65535.0;
    let words: Vec<u32> = tables
        .nodes
        .iter()
        .map(|[low, high]| {
            let low = (low / unit).floor().clamp(0.0, 65535.0) as u32;
            let high = (high / unit).ceil().clamp(0.0, 65535.0) as u32;
            low | high << 16
        })
        .chain(tables.rows.iter().copied())
        .collect();
    let index = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    out.resize(out.len().next_multiple_of(align), [0; 4]);
    let begin = out.len();
    out.extend(words.chunks_exact(4).map(|w| [w[0], w[1], w[2], w[3]]));
    let first_record = out.len() - begin;
    for record in &tables.records {
        out.extend([record.quadric, record.guard].map(|v| v.map(f32::to_bits)));
    }
    let vectors = out.len() - begin;
    out.extend(tables.records.iter().map(|r| r.range.map(f32::to_bits)));
    Placed {
        block: [index(begin), index(first_record), index(vectors), unit.to_bits()],
        vectors,
    }
}

fn named(error: Error, number: usize, object: &Object) -> Error {
    let error = error.at_key(format!("object.{number}.profile"));
    match &object.file {
        Some(file) => error.in_file(file),
        None => error,
    }
}
