//! Contours of a scene's objects, and the quadric search's tables of them, made anew whenever an offset moves.

use crate::error::{Error, Result};
use crate::pieces::{Contour, ContourSource, CutOptions, Tables, cut};
use crate::profile::{Profile, Shape};
use crate::scene::{Object, Offset, Scene};
use std::sync::Arc;

/// Rows of equal height; a power of 4, as the shader computes where levels begin.
const ROWS: u32 = 64;

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

    /// Equal for objects of one profile.
    pub fn key(&self) -> usize {
        Arc::as_ptr(&self.source) as usize
    }

    /// The contour under `offset`.
    pub fn contour(&self, offset: &Offset) -> Result<Contour> {
        self.source.contour(offset)
    }

    /// Appends the tables under `offset` to `out`, from the next multiple of `align` vectors on (their layout is
    /// `search_quadric.glsl`'s); returns where they stand: first vector, rows, first record from there, topmost level.
    pub fn append(
        &self,
        offset: &Offset,
        align: usize,
        out: &mut Vec<[f32; 4]>,
    ) -> Result<[u32; 4]> {
        let contour = self.contour(offset)?;
        let tables = Tables::new(&cut(&contour, &CutOptions::default()), ROWS);
        let index = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        out.resize(out.len().next_multiple_of(align), [0.0; 4]);
        let begin = out.len();
        for (n, [low, high]) in tables.nodes.iter().enumerate() {
            let run = tables.rows.get(n).copied().unwrap_or(0);
            out.push([*low, *high, f32::from_bits(run), 0.0]);
        }
        let first_record = index(out.len() - begin);
        for record in &tables.records {
            out.extend([record.quadric, record.guard, record.range]);
        }
        let top = index(tables.levels.len().saturating_sub(1));
        Ok([index(begin), ROWS, first_record, top])
    }
}

fn named(error: Error, number: usize, object: &Object) -> Error {
    let error = error.at_key(format!("object.{number}.profile"));
    match &object.file {
        Some(file) => error.in_file(file),
        None => error,
    }
}
