//! The quadric search's tables, made anew whenever an offset moves.

use crate::error::{Error, Result};
use crate::pieces::{ContourSource, CutOptions, Tables, cut, outline_of};
use crate::profile::{Profile, Shape};
use crate::scene::{Object, Offset, Scene, Shadow};
use crate::settings::Solver;
use std::sync::Arc;

/// Rows of equal height; a power of 4, as the shader computes where levels begin.
const ROWS: u32 = 64;

/// The search of what has no contour: it reads the map alone.
const FALLBACK: Solver = Solver::Live;

/// What does not depend on the offset, of one object; objects of one profile share it.
#[derive(Clone)]
pub(crate) struct Contours {
    profile: Arc<Profile>,
    source: Arc<ContourSource>,
    options: CutOptions,
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
        let (source, options) = match &object.profile.shape {
            Shape::Outline(outline) => (ContourSource::new(outline)?, CutOptions::default()),
            Shape::Raster(raster) => {
                // The curve that the picture was drawn from, as well as its pixels tell.
                let traced = outline_of(raster);
                let tolerance = traced.tolerance;
                (
                    ContourSource::new(&traced.outline)?,
                    CutOptions { tolerance },
                )
            }
        };
        Ok(Self {
            profile: object.profile.clone(),
            source: Arc::new(source),
            options,
        })
    }

    /// The tables under `offset`.
    ///
    /// # Errors
    /// Where the contour of an odd profile cannot be closed.
    pub fn tables(&self, offset: &Offset) -> Result<Tables> {
        let contour = self.source.contour(offset)?;
        Ok(Tables::new(&cut(&contour, &self.options), ROWS))
    }
}

/// Appends tables to `out`, from the next multiple of `align` vectors on (their layout is `search_quadric.glsl`'s); returns where
/// they stand: first vector, rows, first record from there, topmost level.
pub(crate) fn append(tables: &Tables, align: usize, out: &mut Vec<[f32; 4]>) -> [u32; 4] {
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
    [index(begin), ROWS, first_record, top]
}

/// What a frame's objects are searched by.
pub(crate) struct Searches {
    /// The tables of each object; none where its contour does not close, or other searches are asked for.
    tables: Vec<Option<Tables>>,
    asked: Solver,
}

impl Searches {
    /// `contours` are empty, or one for each object. What goes wrong is told in `notes`, once.
    pub fn new(
        contours: &[Contours],
        scene: &Scene,
        asked: Solver,
        notes: &mut Vec<String>,
    ) -> Self {
        let mut tables = Vec::new();
        for (number, (contour, object)) in contours.iter().zip(&scene.objects).enumerate() {
            let found = contour.tables(&object.offset);
            if let Err(error) = &found {
                let note = format!(
                    "object.{number} ({}) is drawn by the search {} in place of {}: {}",
                    object.name,
                    FALLBACK.name(),
                    asked.name(),
                    error.message
                );
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
            tables.push(found.ok());
        }
        // A shadow's ray meets every solid by one search.
        if scene.shadow != Shadow::Off && tables.iter().any(Option::is_none) {
            tables.clear();
        }
        Self { tables, asked }
    }

    /// The search of object `number`.
    pub fn solver(&self, number: usize) -> Solver {
        match self.asked {
            Solver::Quadric if self.tables(number).is_none() => FALLBACK,
            asked => asked,
        }
    }

    /// Its tables, where it has any.
    pub fn tables(&self, number: usize) -> Option<&Tables> {
        self.tables.get(number)?.as_ref()
    }
}

fn named(error: Error, number: usize, object: &Object) -> Error {
    let error = error.at_key(format!("object.{number}.profile"));
    match &object.file {
        Some(file) => error.in_file(file),
        None => error,
    }
}
