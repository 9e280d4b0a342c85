//! The tables of the searches that read no map, made anew whenever an offset moves.

use crate::error::{Error, Result};
use crate::pieces::{Cones, Contour, ContourSource, CutOptions, Piece, Tables, cut, outline_of};
use crate::profile::{Profile, Shape};
use crate::scene::{Object, Offset, Scene, Shadow};
use crate::settings::{Settings, Solver};
use crate::shader::generated::PIECE_ROWS;
use std::sync::Arc;

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

    /// Equal for objects of one profile.
    pub fn key(&self) -> usize {
        Arc::as_ptr(&self.source) as usize
    }

    /// The contour under `offset`.
    ///
    /// # Errors
    /// Where that of an odd profile cannot be closed.
    pub fn contour(&self, offset: &Offset) -> Result<Contour> {
        self.source.contour(offset)
    }
}

/// One object's table, as the shader of its search reads it.
pub(crate) enum Table {
    /// What `search_quadric.glsl`'s tables and hulls are made from.
    Pieces(Vec<Piece>),
    /// `search_cone.glsl`'s.
    Cone(Cones),
}

/// A table in a buffer, in vectors of 16 bytes.
pub(crate) struct Placed {
    /// As `Solid.pieces` of `blocks.glsl` has it.
    pub block: [u32; 4],
    /// What the search itself reads, from the beginning on.
    pub vectors: usize,
}

impl Table {
    /// Appends the table to `out`, from the next multiple of `align` vectors on.
    pub fn append(&self, align: usize, out: &mut Vec<[u32; 4]>) -> Placed {
        out.resize(out.len().next_multiple_of(align), [0; 4]);
        match self {
            Self::Pieces(pieces) => append_pieces(pieces, out),
            Self::Cone(cones) => {
                let begin = out.len();
                out.extend(cones.rows.iter().map(|row| row.map(f32::to_bits)));
                let rows = cones.rows.len();
                Placed {
                    block: [index(begin), index(rows), cones.reach.to_bits(), 0],
                    vectors: rows,
                }
            }
        }
    }

    /// The pieces, if that is what it holds.
    pub fn pieces(&self) -> Option<&[Piece]> {
        match self {
            Self::Pieces(pieces) => Some(pieces),
            Self::Cone(_) => None,
        }
    }
}

fn index(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// The layout of `piece_tables.glsl`.
fn append_pieces(pieces: &[Piece], out: &mut Vec<[u32; 4]>) -> Placed {
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
    let begin = out.len();
    out.extend(words.chunks_exact(4).map(|w| [w[0], w[1], w[2], w[3]]));
    let first_record = out.len() - begin;
    for record in &tables.records {
        out.extend([record.quadric, record.guard].map(|v| v.map(f32::to_bits)));
    }
    let vectors = out.len() - begin;
    out.extend(tables.records.iter().map(|r| r.range.map(f32::to_bits)));
    Placed {
        block: [
            index(begin),
            index(first_record),
            index(vectors),
            unit.to_bits(),
        ],
        vectors,
    }
}

/// What a frame's objects are searched by.
pub(crate) struct Searches {
    /// The table of each object; none where its contour does not close, or a map is searched.
    tables: Vec<Option<Table>>,
    asked: Solver,
    notes: Vec<String>,
}

impl Searches {
    /// `contours` are empty, or one for each object.
    ///
    /// # Errors
    /// Where the search asked for cannot draw an object, and another must be asked for.
    pub fn new(contours: &[Contours], scene: &Scene, settings: &Settings) -> Result<Self> {
        let asked = settings.solver;
        let mut tables = Vec::new();
        let mut notes = Vec::new();
        if asked.is_mesh() {
            return Ok(Self {
                tables,
                asked,
                notes,
            });
        }
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
                notes.push(format!(
                    "object.{number} ({}) is drawn by the search {} in place of {}: {}",
                    object.name,
                    FALLBACK.name(),
                    asked.name(),
                    error.message
                ));
            }
            let table = |contour| Table::Pieces(cut(&contour, &contours.options));
            tables.push(found.ok().map(table));
        }
        // A shadow's ray meets every solid by one search.
        if scene.shadow != Shadow::Off && tables.iter().any(Option::is_none) {
            tables.clear();
        }
        Ok(Self {
            tables,
            asked,
            notes,
        })
    }

    /// What is done in another way than asked for.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The search of object `number`.
    pub fn solver(&self, number: usize) -> Solver {
        match self.asked {
            Solver::Quadric | Solver::Hull if self.table(number).is_none() => FALLBACK,
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
