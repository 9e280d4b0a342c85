//! Surfaces under an offset: the boundary as quadrics or as another search's table, and the GPU data
//! made from it.

use crate::error::{Error, Result};
use crate::search::{Reads, Search, SearchTable};
use crate::solid::contour::OffsetContour;
use crate::solid::proxy_hull::GpuProxyHull;
use crate::solid::tables;
use crate::surface::{FitOptions, QuadricPatch, extent, fit_patches};
use range_alloc::RangeAllocator;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock};

/// A range of vectors in the buffer of all tables; freed when dropped.
#[derive(Debug)]
pub(crate) struct Slot {
    pub range: Range<u32>,
    pub ranges: Arc<Mutex<RangeAllocator<u32>>>,
}

impl Slot {
    pub fn begin(&self) -> u32 {
        self.range.start
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        if let Ok(mut ranges) = self.ranges.lock() {
            ranges.free_range(self.range.clone());
        }
    }
}

/// The parts of a surface that have slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Tables that searches walk.
    Tables,
    /// Frusta that the vertex shaders of hulls expand.
    Frusta,
    /// Patches that lists are made from.
    Patches,
}

impl Part {
    pub const ALL: [Self; 3] = [Self::Tables, Self::Frusta, Self::Patches];
}

/// One surface, made on first use, shared by all objects that show it.
pub(crate) struct OffsetSurface {
    contour: Arc<OffsetContour>,
    recipe: Recipe,
    made: OnceLock<Result<Made>>,
    tables: OnceLock<SearchTable>,
    listed: OnceLock<Vec<[u32; 4]>>,
    hull: OnceLock<GpuProxyHull>,
    slots: [OnceLock<Slot>; 3],
}

#[derive(Clone, Copy)]
pub(crate) enum Recipe {
    /// Quadrics of a level that follow the contour within a tolerance in object units.
    Patches { level: u8, tolerance: f64 },
    /// The table of a search of another crate, with this number of rows.
    Table { search: &'static Search, rows: u32 },
}

enum Made {
    /// Patches, then their largest radius, least `z` and largest `z`.
    Patches(Vec<QuadricPatch>, [f64; 3]),
    Table(SearchTable),
}

impl OffsetSurface {
    pub fn new(contour: Arc<OffsetContour>, recipe: Recipe) -> Self {
        Self {
            contour,
            recipe,
            made: OnceLock::new(),
            tables: OnceLock::new(),
            listed: OnceLock::new(),
            hull: OnceLock::new(),
            slots: [const { OnceLock::new() }; 3],
        }
    }

    /// True if it was made, or if making it failed.
    pub fn is_made(&self) -> bool {
        self.made.get().is_some()
    }

    pub fn make(&self) {
        let _ = self.made();
    }

    /// The reason why there is no such surface.
    pub fn failure(&self) -> Option<&Error> {
        self.made().err()
    }

    fn made(&self) -> std::result::Result<&Made, &Error> {
        let make = || {
            let contour = self.contour.get().map_err(Clone::clone)?;
            Ok(match self.recipe {
                Recipe::Patches { tolerance, .. } => {
                    let patches = fit_patches(contour, &FitOptions { tolerance });
                    let [[_, widest], [low, high]] = extent(&patches);
                    Made::Patches(patches, [widest, low, high])
                }
                Recipe::Table { search, rows } => Made::Table(match search.reads {
                    Reads::Table(make) => make(contour, rows)?,
                    Reads::Map { .. } => SearchTable::default(),
                }),
            })
        };
        self.made.get_or_init(make).as_ref()
    }

    /// Its patches; `None` for another search's table, and if there is no such surface.
    fn quadrics(&self) -> Option<&[QuadricPatch]> {
        match self.made() {
            Ok(Made::Patches(patches, _)) => Some(patches),
            _ => None,
        }
    }

    /// The tables that the search walks.
    pub fn tables(&self) -> &SearchTable {
        let make = || match (self.quadrics(), self.contour.get()) {
            (Some(patches), Ok(contour)) => SearchTable::new(patches, contour),
            _ => SearchTable::default(),
        };
        match self.made() {
            Ok(Made::Table(table)) => table,
            _ => self.tables.get_or_init(make),
        }
    }

    /// Patches that lists are made from; empty if there are none, or too many.
    pub fn listed(&self) -> &[[u32; 4]] {
        let make = || tables::listed(self.quadrics().unwrap_or_default());
        self.listed.get_or_init(make)
    }

    /// Makes the hull that the rasteriser draws; an empty one for another search's table.
    pub fn make_hull(&self) {
        let make = || GpuProxyHull::new(self.quadrics().unwrap_or_default());
        self.hull.get_or_init(make);
    }

    /// The hull that the rasteriser draws; `None` before it is made.
    pub fn hull(&self) -> Option<&GpuProxyHull> {
        self.hull.get()
    }

    pub fn is_of_patches(&self) -> bool {
        matches!(self.recipe, Recipe::Patches { .. })
    }

    /// Largest radius, least and largest `z`; only for patches.
    pub fn extent(&self) -> [f64; 3] {
        match self.made() {
            Ok(Made::Patches(_, extent)) => *extent,
            _ => [0.0; 3],
        }
    }

    /// Largest distance that it may bulge beyond the contour: the tolerance of a coarse level, 0
    /// for the exact one.
    pub fn slack(&self) -> f64 {
        match self.recipe {
            Recipe::Patches { level, tolerance } if level > 0 => tolerance,
            _ => 0.0,
        }
    }

    pub fn patches(&self) -> usize {
        self.quadrics().unwrap_or_default().len()
    }

    pub fn vectors(&self, part: Part) -> &[[u32; 4]] {
        match part {
            Part::Tables => &self.tables().vectors,
            Part::Frusta => self.hull().map_or(&[], |hull| &hull.vectors),
            Part::Patches => self.listed(),
        }
    }

    pub fn slot(&self, part: Part) -> Option<&Slot> {
        self.slots[part as usize].get()
    }

    /// The number in the buffer of all tables from which shaders count a part's vectors; 0 if the part
    /// is not stored.
    pub fn start(&self, part: Part) -> u32 {
        let before = || match part {
            Part::Tables => self.tables().before,
            Part::Frusta | Part::Patches => 0,
        };
        self.slot(part).map_or(0, |slot| slot.begin() + before())
    }

    /// Keeps the slot of a part, unless it has one.
    pub fn keep_slot(&self, part: Part, slot: Slot) {
        self.slots[part as usize].get_or_init(|| slot);
    }
}
