//! Surfaces under an offset: the boundary as quadrics or as another search's table, and the GPU
//! data made from it.

use crate::error::Result;
use crate::search::{Reads, Search, SearchTable};
use crate::solid::outline_cache::OffsetContour;
use crate::solid::proxy_hull::GpuProxyHull;
use crate::solid::table_slot::{Part, Slot};
use crate::solid::tables::{self, GpuTables};
use crate::surface::{Cylinders, FitOptions, QuadricPatch, fit_patches};
use std::sync::{Arc, OnceLock};

/// One surface, made on first use, shared by all objects that show it.
pub(crate) struct OffsetSurface {
    recipe: Recipe,
    made: OnceLock<Result<Made>>,
    tables: OnceLock<GpuTables>,
    listed: OnceLock<Vec<[u32; 4]>>,
    hull: OnceLock<GpuProxyHull>,
    inner: OnceLock<Cylinders>,
    outer: OnceLock<Cylinders>,
    slots: [OnceLock<Slot>; 3],
}

/// The source of a surface.
pub(crate) enum Recipe {
    /// Quadrics that follow a contour, at this level, within this tolerance in object units.
    Patches(Arc<OffsetContour>, u8, f64),
    /// The table of a search, with this number of rows.
    Search(&'static Search, Arc<OffsetContour>, u32),
}

enum Made {
    /// Patches, then their largest radius, least `z` and largest `z`.
    Patches(Vec<QuadricPatch>, [f64; 3]),
    Table(SearchTable),
}

impl OffsetSurface {
    pub fn new(recipe: Recipe) -> Self {
        Self {
            recipe,
            made: OnceLock::new(),
            tables: OnceLock::new(),
            listed: OnceLock::new(),
            hull: OnceLock::new(),
            inner: OnceLock::new(),
            outer: OnceLock::new(),
            slots: [const { OnceLock::new() }; 3],
        }
    }

    /// True if it was made, or if making it failed.
    pub fn is_made(&self) -> bool {
        self.made.get().is_some()
    }

    /// Makes it, if it is not made yet.
    pub fn make(&self) {
        let _ = self.made();
    }

    /// The reason why there is no such surface.
    pub fn failure(&self) -> Option<&crate::error::Error> {
        self.made().err()
    }

    fn made(&self) -> std::result::Result<&Made, &crate::error::Error> {
        self.made.get_or_init(|| self.recipe.follow()).as_ref()
    }

    /// The tables that the search walks.
    pub fn tables(&self) -> &GpuTables {
        self.tables.get_or_init(|| match self.made() {
            Ok(Made::Patches(patches, _)) => GpuTables::patches(patches),
            Ok(Made::Table(table)) => GpuTables::of_search(table),
            Err(_) => GpuTables::patches(&[]),
        })
    }

    /// Patches that lists are made from; empty if there are none, or too many.
    pub fn listed(&self) -> &[[u32; 4]] {
        self.listed.get_or_init(|| match self.made() {
            Ok(Made::Patches(patches, _)) => tables::listed(patches),
            _ => Vec::new(),
        })
    }

    /// The hull that the rasteriser draws; empty for another search's table.
    pub fn hull(&self) -> &GpuProxyHull {
        self.hull.get_or_init(|| match self.made() {
            Ok(Made::Patches(patches, _)) => GpuProxyHull::new(patches),
            _ => GpuProxyHull::new(&[]),
        })
    }

    /// Cylinders inside its solid, which hide everything behind them; only for patches.
    pub fn inner(&self) -> Option<&Cylinders> {
        match self.made() {
            Ok(Made::Patches(patches, _)) => {
                Some(self.inner.get_or_init(|| Cylinders::inner(patches)))
            }
            _ => None,
        }
    }

    /// Cylinders around its solid; only for patches.
    pub fn outer(&self) -> Option<&Cylinders> {
        match self.made() {
            Ok(Made::Patches(patches, _)) => {
                Some(self.outer.get_or_init(|| Cylinders::outer(patches)))
            }
            _ => None,
        }
    }

    /// True if it is made of patches.
    pub fn is_of_patches(&self) -> bool {
        matches!(self.recipe, Recipe::Patches(..))
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
            Recipe::Patches(_, level, tolerance) if level > 0 => tolerance,
            _ => 0.0,
        }
    }

    /// Number of its patches.
    pub fn patches(&self) -> usize {
        match self.made() {
            Ok(Made::Patches(patches, _)) => patches.len(),
            _ => 0,
        }
    }

    pub fn vectors(&self, part: Part) -> &[[u32; 4]] {
        match part {
            Part::Tables => &self.tables().vectors,
            Part::Frusta => &self.hull().vectors,
            Part::Patches => self.listed(),
        }
    }

    pub fn slot(&self, part: Part) -> Option<&Slot> {
        self.slots[part as usize].get()
    }

    /// Stores the slot of a part and returns its first vector.
    pub fn keep_slot(&self, part: Part, slot: Slot) -> u32 {
        self.slots[part as usize].get_or_init(|| slot).begin()
    }
}

impl Recipe {
    fn follow(&self) -> Result<Made> {
        match self {
            Self::Patches(contour, _, tolerance) => {
                let options = FitOptions {
                    tolerance: *tolerance,
                };
                let contour = contour.get().map_err(Clone::clone)?;
                let patches = fit_patches(contour, &options);
                let none = [0.0f64, f64::INFINITY, f64::NEG_INFINITY];
                let extent = patches.iter().fold(none, |m, p| {
                    [m[0].max(p.r[1]), m[1].min(p.z[0]), m[2].max(p.z[1])]
                });
                Ok(Made::Patches(patches, extent))
            }
            Self::Search(search, contour, rows) => match search.reads {
                Reads::Table(make) => {
                    let contour = contour.get().map_err(Clone::clone)?;
                    Ok(Made::Table(make(contour, *rows)?))
                }
                Reads::Map { .. } => Ok(Made::Table(SearchTable::default())),
            },
        }
    }
}
