//! The tables of the searches that read no map, made anew whenever an offset moves.

use crate::error::{Error, Result};
use crate::pieces::{Cones, Contour, ContourSource, CutOptions, Tables, cut, outline_of};
use crate::profile::{Profile, Shape};
use crate::scene::{Object, Offset, Scene, Shadow};
use crate::settings::{Settings, Solver};
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

    /// The contour under `offset`.
    ///
    /// # Errors
    /// Where that of an odd profile cannot be closed.
    fn contour(&self, offset: &Offset) -> Result<Contour> {
        self.source.contour(offset)
    }
}

/// One object's table, as the shader of its search reads it.
pub(crate) enum Table {
    /// `search_quadric.glsl`'s.
    Quadric(Tables),
    /// `search_cone.glsl`'s.
    Cone(Cones),
}

impl Table {
    /// Appends the table to `out`, from the next multiple of `align` vectors on; returns where it stands: first vector, rows, first
    /// record from there, topmost level.
    pub fn append(&self, align: usize, out: &mut Vec<[f32; 4]>) -> [u32; 4] {
        let index = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        out.resize(out.len().next_multiple_of(align), [0.0; 4]);
        let begin = out.len();
        let tables = match self {
            Self::Quadric(tables) => tables,
            Self::Cone(cones) => {
                out.extend(&cones.rows);
                return [
                    index(begin),
                    index(cones.rows.len()),
                    cones.reach.to_bits(),
                    0,
                ];
            }
        };
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
}

/// What a frame's objects are searched by.
pub(crate) struct Searches {
    /// The table of each object; none where its contour does not close, or a map is searched.
    tables: Vec<Option<Table>>,
    asked: Solver,
}

impl Searches {
    /// `contours` are empty, or one for each object. What is done in another way is told in `notes`, once.
    ///
    /// # Errors
    /// Where the search asked for cannot draw an object, and another must be asked for.
    pub fn new(
        contours: &[Contours],
        scene: &Scene,
        settings: &Settings,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        let asked = settings.solver;
        let mut tables = Vec::new();
        for (number, (contours, object)) in contours.iter().zip(&scene.objects).enumerate() {
            let found = contours.contour(&object.offset);
            if asked == Solver::Cone {
                let rows = settings.map_rows.unwrap_or(object.map_rows);
                let cones = found
                    .and_then(|contour| Cones::new(&contour, rows))
                    .map_err(|e| named(e, number, object))?;
                tables.push(Some(Table::Cone(cones)));
                continue;
            }
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
            let table =
                |contour| Table::Quadric(Tables::new(&cut(&contour, &contours.options), ROWS));
            tables.push(found.ok().map(table));
        }
        // A shadow's ray meets every solid by one search.
        if scene.shadow != Shadow::Off && tables.iter().any(Option::is_none) {
            tables.clear();
        }
        Ok(Self { tables, asked })
    }

    /// The search of object `number`.
    pub fn solver(&self, number: usize) -> Solver {
        match self.asked {
            Solver::Quadric if self.table(number).is_none() => FALLBACK,
            asked => asked,
        }
    }

    /// Its table, where it has one.
    pub fn table(&self, number: usize) -> Option<&Table> {
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
