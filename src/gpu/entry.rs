//! What a renderer keeps of an object: its values, what is prepared from them, how it is drawn.

use super::block::{note_growth, solid_block};
use super::blocks::SolidBlock;
use super::map_key::MapFacts;
use super::offset_surface::OffsetSurface;
use super::plan::Work;
use super::shape_texture::{ArcTexture, ShapeTexture};
use super::solid::Solid;
use super::table_slot::Part;
use super::textures::TextureSet;
use crate::scene::{GrownObject, Object};
use crate::settings::{SearchSettings, Solver};
use crate::shader::generated::TILE_LISTS;
use crate::shader::{Kind, Variant};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// An object of a renderer. It stays the same object whatever is set, and is never another's once
/// removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId {
    pub(super) number: u32,
    pub(super) generation: u32,
}

impl ObjectId {
    /// The id as one number, never 0, for interfaces that carry plain numbers.
    #[must_use]
    pub const fn to_bits(self) -> u64 {
        (self.generation as u64) << 32 | (self.number as u64 + 1)
    }

    /// The id of [`ObjectId::to_bits`]. Any other number is the id of no object.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // the two halves
    pub const fn from_bits(bits: u64) -> Self {
        Self {
            number: (bits as u32).wrapping_sub(1),
            generation: (bits >> 32) as u32,
        }
    }
}

/// One object.
pub(super) struct Entry {
    pub object: Object,
    /// What was set since it was prepared last.
    pub wanted: Option<Object>,
    /// What is drawn in its place, in a box that has grown with the offset.
    pub grown: Option<GrownObject>,
    /// None before the first frame, and where that failed.
    pub prepared: Option<Prepared>,
    pub draw: Draw,
    pub instances: Range<u32>,
    /// Bits of the slots that hold something older.
    pub stale: u32,
}

/// What follows from an object's values, whatever the view.
pub(super) struct Prepared {
    /// Kept, as the cache keeps nothing.
    pub solid: Arc<Solid>,
    /// Which level of the surface it is drawn by.
    pub level: u8,
    /// Surfaces of other levels that the view asked for before.
    pub levels: Vec<Arc<OffsetSurface>>,
    /// What it is drawn by, which is not always what was asked for.
    pub solver: Solver,
    /// What the search walks.
    pub surface: Option<Arc<OffsetSurface>>,
    /// What rays can be held to before they are searched.
    pub proxy: Option<Arc<OffsetSurface>>,
    pub map: Option<Arc<ShapeTexture>>,
    pub facts: MapFacts,
    pub arc: Option<Arc<ArcTexture>>,
    /// Its map's number among those that shadows read.
    pub shadow_map: u32,
    pub textures: Arc<TextureSet>,
    pub variant: Variant,
}

/// What follows from the view, too.
#[derive(Default)]
pub(super) struct Draw {
    pub work: Option<Work>,
    pub pipeline: vk::Pipeline,
    /// The pipelines of the box's sides, where they cut a hull: of what is solid there, and of what may be.
    pub sides: [vk::Pipeline; 2],
    /// The pipeline of squares of several copies, in a pass.
    pub bins: vk::Pipeline,
    /// The pipeline that lists tiles, where the work is of beams.
    pub list: vk::Pipeline,
    /// The pipelines of tiles whose patches are listed; the last is of those whose rays enter box
    /// and solid at once, null where the box cuts nothing.
    pub listed: [vk::Pipeline; TILE_LISTS as usize],
    /// What the pipeline was compiled for.
    pub key: Option<(Variant, Kind)>,
    pub tables_offset: u32,
    /// Likewise of the patches that lists are made from, and the vector with which they begin.
    pub patches_offset: u32,
    pub patches: u32,
    /// Vectors with which frusta, tables begin.
    pub frusta: u32,
    /// How many vectors after the frusta the rows of the box's sides begin.
    pub side_rows: u32,
    pub tables: u32,
}

impl Entry {
    /// The values that were set last.
    pub fn latest(&self) -> &Object {
        self.wanted.as_ref().unwrap_or(&self.object)
    }

    /// The values that were prepared last, in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        self.grown.as_ref().map_or(&self.object, |g| &g.object)
    }

    pub fn placements_len(&self) -> usize {
        self.latest().placements().len()
    }

    /// What shaders read of it; none before it is prepared.
    pub fn block(&self, settings: &SearchSettings) -> Option<SolidBlock> {
        let p = self.prepared.as_ref()?;
        let length = p.arc.as_ref().map_or(1.0, |a| a.length);
        let (instances, map) = (&self.instances, p.shadow_map);
        let mut block = solid_block(
            self.drawn(),
            &p.facts,
            length,
            instances,
            map,
            p.solver,
            settings,
        );
        if let Some(grown) = &self.grown {
            note_growth(&mut block, &grown.growth, grown.object.profile.radius);
        }
        #[allow(clippy::cast_possible_truncation)]
        if let Some(surface) = p.fitted() {
            block.bounds[1] += surface.slack() as f32;
        }
        block.hull[0] = self.draw.frusta;
        block.hull[2] = self.draw.patches;
        block.hull[3] = self.draw.frusta + self.draw.side_rows;
        let walked = p.surface.as_ref().or(p.proxy.as_ref());
        if let Some(surface) = walked.filter(|s| s.slot(Part::Tables).is_some()) {
            block.patches = surface.tables().block(self.draw.tables);
            block.hull[1] = surface.tables().beams(self.draw.tables);
        }
        Some(block)
    }
}
