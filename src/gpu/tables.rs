//! Tables of the searches that read no map, as vectors of 16 bytes for a shader.

use crate::pieces::{Cones, Piece, Tables};
use crate::shader::generated::PIECE_ROWS;

/// A table that may stand anywhere in a buffer.
pub(crate) struct Packed {
    pub vectors: Vec<[u32; 4]>,
    /// How many of them the search itself reads, from the beginning on.
    pub own: usize,
    /// What `Solid.pieces` of `blocks.glsl` holds behind the place where it begins.
    facts: [u32; 3],
}

impl Packed {
    /// `Solid.pieces` of a table that begins with vector `begin` of the buffer.
    pub fn block(&self, begin: u32) -> [u32; 4] {
        let [a, b, c] = self.facts;
        [begin, a, b, c]
    }

    /// The layout of `piece_tables.glsl`.
    pub fn pieces(pieces: &[Piece]) -> Self {
        let tables = Tables::new(pieces, PIECE_ROWS);
        let largest = tables.nodes.iter().fold(1e-6f32, |m, n| m.max(n[1]));
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
        let mut vectors: Vec<_> = words
            .chunks_exact(4)
            .map(|w| [w[0], w[1], w[2], w[3]])
            .collect();
        let first_record = vectors.len();
        for record in &tables.records {
            vectors.extend([record.quadric, record.guard].map(|v| v.map(f32::to_bits)));
        }
        let own = vectors.len();
        vectors.extend(tables.records.iter().map(|r| r.range.map(f32::to_bits)));
        Self {
            vectors,
            own,
            facts: [index(first_record), index(own), unit.to_bits()],
        }
    }

    /// The layout of `search_cone.glsl`.
    pub fn cones(cones: &Cones) -> Self {
        let vectors: Vec<_> = cones.rows.iter().map(|r| r.map(f32::to_bits)).collect();
        let rows = vectors.len();
        Self {
            vectors,
            own: rows,
            facts: [index(rows), cones.reach.to_bits(), 0],
        }
    }
}

fn index(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
