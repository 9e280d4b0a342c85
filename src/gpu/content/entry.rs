//! A renderer's record of an object: its values, and the resources that are derived from them.

use crate::gpu::resources::block::{note_growth, solid_block};
use crate::gpu::resources::shape_texture::MapFacts;
use crate::gpu::resources::shape_texture::{ArcTexture, ShapeTexture};
use crate::gpu::resources::solid_cache::Solid;
use crate::gpu::resources::textures::TextureSet;
use crate::scene::{GrownObject, Object};
use crate::settings::{SearchSettings, Solver};
use crate::shader::SolidBlock;
use crate::shader::Variant;
use crate::shader::generated::FRUSTUM_VECTORS;
use crate::solid::offset_surface::OffsetSurface;
use crate::solid::outline_cache::OffsetContour;
use crate::solid::table_slot::{Part, Slot};
use std::ops::Range;
use std::sync::Arc;

/// One object.
pub(in crate::gpu) struct Entry {
    pub object: Object,
    /// Values that were set since the last refresh.
    pub wanted: Option<Object>,
    /// The object that is drawn in its place, in a box that has grown with the offset.
    pub grown: Option<GrownObject>,
    /// `None` before the first refresh, and if that failed.
    pub derived: Option<Derived>,
    pub instances: Range<u32>,
    /// The renderer's version at the last change.
    pub version: u64,
}

/// Resources that follow from an object's values, whatever the view.
pub(in crate::gpu) struct Derived {
    /// Keeps the solid alive; the cache does not.
    pub solid: Arc<Solid>,
    /// The contour whose patches are searched, or would be if it closed; `None` for a search on the
    /// map or on a table of its own.
    pub contour: Option<Arc<OffsetContour>>,
    /// Surfaces by level, for levels that views needed. Empty for a search on the map.
    pub levels: Vec<(u8, Arc<OffsetSurface>)>,
    /// The search that draws the object; it may differ from the settings.
    pub solver: Solver,
    /// True if cells and lists of patches may replace the tree.
    pub takes_patches: bool,
    pub map: Option<Arc<ShapeTexture>>,
    pub facts: MapFacts,
    pub arc: Option<Arc<ArcTexture>>,
    /// The number of the object's map among the maps that shadows read.
    pub shadow_map: u32,
    pub textures: Arc<TextureSet>,
    pub variant: Variant,
}

impl Entry {
    pub fn new(object: Object, instances: Range<u32>, version: u64) -> Self {
        Self {
            object,
            wanted: None,
            grown: None,
            derived: None,
            instances,
            version,
        }
    }

    /// The values that were set last.
    pub fn latest(&self) -> &Object {
        self.wanted.as_ref().unwrap_or(&self.object)
    }

    /// The values of the last refresh, in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        self.grown.as_ref().map_or(&self.object, |g| &g.object)
    }

    /// The block that shaders read, for this surface; `None` before the object is derived.
    pub fn block(
        &self,
        number: u32,
        surface: Option<&OffsetSurface>,
        settings: &SearchSettings,
    ) -> Option<SolidBlock> {
        let p = self.derived.as_ref()?;
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
        block.instances[3] = number;
        if let Some(grown) = &self.grown {
            note_growth(&mut block, &grown.growth, grown.object.profile.radius);
        }
        let Some(surface) = surface else {
            return Some(block);
        };
        #[allow(clippy::cast_possible_truncation)]
        if p.solver.follows_tolerance() {
            block.bounds[1] += surface.slack() as f32;
        }
        let begin = |part| surface.slot(part).map(Slot::begin);
        if let Some(tables) = begin(Part::Tables) {
            block.patches = surface.tables().block(tables);
        }
        if let Some(frusta) = begin(Part::Frusta) {
            block.hull[0] = frusta;
            block.hull[3] = frusta + surface.hull().hull.frusta.len() as u32 * FRUSTUM_VECTORS;
        }
        block.hull[2] = begin(Part::Patches).unwrap_or(0);
        Some(block)
    }
}
