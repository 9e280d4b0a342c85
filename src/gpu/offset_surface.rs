//! Surfaces under an offset: the boundary as quadrics or cones, or the envelope of a map, and what
//! is made of them for the GPU.

use super::bins::{Inner, Outer};
use super::outlined::Outlined;
use super::proxy_hull::GpuProxyHull;
use super::table_slot::{Part, Slot};
use super::tables::{self, GpuTables};
use crate::error::Result;
use crate::maps::envelope::Envelope;
use crate::scene::Offset;
use crate::surface::{Cones, FitOptions, QuadricPatch, fit_patches};
use std::sync::{Arc, OnceLock};

/// One surface, made when first wanted, shared by all objects that show it.
pub(crate) struct OffsetSurface {
    recipe: Recipe,
    made: OnceLock<Result<Made>>,
    tables: OnceLock<GpuTables>,
    listed: OnceLock<Vec<[u32; 4]>>,
    hull: OnceLock<GpuProxyHull>,
    inner: OnceLock<Inner>,
    outer: OnceLock<Outer>,
    slots: [OnceLock<Slot>; 3],
}

/// What a surface is made from.
pub(crate) enum Recipe {
    /// Quadrics that follow the outline under an offset, of this level, within this distance in
    /// object units.
    Patches(Arc<Outlined>, Offset, u8, f64),
    /// A row of so many empty cones around it, relaxed or not.
    Cones(Arc<Outlined>, Offset, u32, bool),
    /// Where a map's solid may be.
    Envelope(Envelope),
}

enum Made {
    /// And their largest radius, least and largest `z`.
    Patches(Vec<QuadricPatch>, [f64; 3]),
    Cones(Cones),
    Envelope,
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

    /// Whether it is made, or has failed to be.
    pub fn is_made(&self) -> bool {
        self.made.get().is_some()
    }

    /// Makes it, if it is not made yet.
    pub fn make(&self) {
        let _ = self.made();
    }

    /// Why there is no such surface.
    pub fn failure(&self) -> Option<&crate::error::Error> {
        self.made().err()
    }

    fn made(&self) -> std::result::Result<&Made, &crate::error::Error> {
        self.made.get_or_init(|| self.recipe.follow()).as_ref()
    }

    /// What the search walks.
    pub fn tables(&self) -> &GpuTables {
        self.tables
            .get_or_init(|| match (self.made(), &self.recipe) {
                (Ok(Made::Patches(patches, _)), _) => GpuTables::patches(patches),
                (Ok(Made::Cones(cones)), _) => GpuTables::cones(cones),
                (Ok(Made::Envelope), Recipe::Envelope(envelope)) => GpuTables::envelope(envelope),
                _ => GpuTables::patches(&[]),
            })
    }

    /// What lists of patches are made from; nothing where there are none, or too many.
    pub fn listed(&self) -> &[[u32; 4]] {
        self.listed.get_or_init(|| match self.made() {
            Ok(Made::Patches(patches, _)) => tables::listed(patches),
            _ => Vec::new(),
        })
    }

    /// What the rasteriser draws; of cones nothing.
    pub fn hull(&self) -> &GpuProxyHull {
        self.hull.get_or_init(|| match (self.made(), &self.recipe) {
            (Ok(Made::Patches(patches, _)), _) => GpuProxyHull::new(patches),
            (Ok(Made::Envelope), Recipe::Envelope(envelope)) => GpuProxyHull::convex(envelope),
            _ => GpuProxyHull::new(&[]),
        })
    }

    /// What its solid is sure to hide; of patches alone.
    pub fn inner(&self) -> Option<&Inner> {
        match self.made() {
            Ok(Made::Patches(patches, _)) => Some(self.inner.get_or_init(|| Inner::new(patches))),
            _ => None,
        }
    }

    /// Where its solid can be; of patches alone.
    pub fn outer(&self) -> Option<&Outer> {
        match self.made() {
            Ok(Made::Patches(patches, _)) => Some(self.outer.get_or_init(|| Outer::new(patches))),
            _ => None,
        }
    }

    /// Whether it is the boundary itself; an envelope only says where the solid may be, and rays
    /// are searched as in the box.
    pub fn is_boundary(&self) -> bool {
        !matches!(self.recipe, Recipe::Envelope(_))
    }

    /// Largest radius, least and largest `z`; of patches alone.
    pub fn extent(&self) -> [f64; 3] {
        match self.made() {
            Ok(Made::Patches(_, extent)) => *extent,
            _ => [0.0; 3],
        }
    }

    /// By how much it may bulge beyond the contour: as much of a coarse level, nothing of the exact
    /// one.
    pub fn slack(&self) -> f64 {
        match self.recipe {
            Recipe::Patches(_, _, level, tolerance) if level > 0 => tolerance,
            _ => 0.0,
        }
    }

    /// How many patches it has.
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

    /// Keeps the place of a part; returns the vector with which it begins.
    pub fn keep_slot(&self, part: Part, slot: Slot) -> u32 {
        self.slots[part as usize].get_or_init(|| slot).begin()
    }
}

impl Recipe {
    fn follow(&self) -> Result<Made> {
        match self {
            Self::Patches(outlined, offset, _, tolerance) => {
                let contour = outlined.contour(offset)?;
                let options = FitOptions {
                    tolerance: *tolerance,
                };
                let patches = fit_patches(&contour, &options);
                let none = [0.0f64, f64::INFINITY, f64::NEG_INFINITY];
                let extent = patches.iter().fold(none, |m, p| {
                    [m[0].max(p.r[1]), m[1].min(p.z[0]), m[2].max(p.z[1])]
                });
                Ok(Made::Patches(patches, extent))
            }
            Self::Cones(outlined, offset, rows, relaxed) => {
                let contour = outlined.contour(offset)?;
                let make = if *relaxed { Cones::relaxed } else { Cones::new };
                Ok(Made::Cones(make(&contour, *rows)?))
            }
            Self::Envelope(_) => Ok(Made::Envelope),
        }
    }
}
