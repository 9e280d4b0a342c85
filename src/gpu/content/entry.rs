//! A renderer's record of an object: its values, and the resources that are derived from them.

use crate::gpu::resources::host_image::ObjectImages;
use crate::gpu::resources::shape_texture::{ArcTexture, MapFacts, ShapeTexture};
use crate::gpu::resources::solid_cache::Solid;
use crate::gpu::resources::textures::TextureSet;
use crate::scene::{Copies, GrownObject, Growth, Object, Placement};
use crate::settings::{SearchSettings, Solver};
use crate::shader::{ObjectBlock, Variant, is_beveled};
use crate::solid::offset_surface::OffsetSurface;
use crate::solid::outline_cache::OffsetContour;
use crate::solid::reach::{farthest_corner, largest_width};
use crate::solid::table_slot::{Part, Slot};
use std::ops::Range;
use std::sync::Arc;

/// One object.
pub(in crate::gpu) struct Entry {
    pub object: Object,
    /// Values that were set since the last refresh.
    pub wanted: Option<Object>,
    pub images: ObjectImages,
    /// Images that were set since the last refresh.
    pub wanted_images: Option<ObjectImages>,
    /// The object that is drawn in its place, in a box that has grown with the offset.
    pub grown: Option<GrownObject>,
    /// `None` before the first refresh, and if that failed.
    pub derived: Option<Derived>,
    pub instances: Range<u32>,
    /// Views whose mask shares no bit with it do not show the object.
    pub mask: u32,
    /// The renderer's version at the last change.
    pub version: u64,
    pub history: History,
}

/// An object's last frame.
#[derive(Clone, Debug)]
pub(in crate::gpu) enum History {
    /// There was no last frame.
    New,
    /// Its values were those of this frame.
    Still,
    /// Its values were these.
    Moved(LastValues),
}

/// An object's values of the last frame, for motion.
#[derive(Clone, Debug)]
pub(in crate::gpu) struct LastValues {
    pub placement: Placement,
    pub instances: Copies,
    pub extend: f64,
}

impl LastValues {
    pub fn of(object: &Object) -> Self {
        Self {
            placement: object.placement,
            instances: object.instances.clone(),
            extend: object.offset.extend,
        }
    }

    /// The placements, if there are as many as `now`.
    pub fn placements(&self, now: usize) -> Option<&[Placement]> {
        let all = match self.instances.is_empty() {
            true => std::slice::from_ref(&self.placement),
            false => &self.instances,
        };
        (all.len() == now).then_some(all)
    }
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
            images: ObjectImages::default(),
            wanted_images: None,
            grown: None,
            derived: None,
            instances,
            mask: u32::MAX,
            version,
            history: History::New,
        }
    }

    /// The values that were set last.
    pub fn latest(&self) -> &Object {
        self.wanted.as_ref().unwrap_or(&self.object)
    }

    /// The images that were set last.
    pub fn latest_images(&self) -> &ObjectImages {
        self.wanted_images.as_ref().unwrap_or(&self.images)
    }

    /// The values of the last refresh, in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        self.grown.as_ref().map_or(&self.object, |g| &g.object)
    }

    /// The growth of the box with the offset.
    pub fn growth(&self) -> Growth {
        self.grown.as_ref().map(|g| g.growth).unwrap_or_default()
    }

    /// The block that shaders read, for this surface; `None` before anything was derived.
    /// `window`: first vector of the tables of all levels.
    pub fn block(
        &self,
        surface: Option<&OffsetSurface>,
        window: u32,
        settings: &SearchSettings,
    ) -> Option<ObjectBlock> {
        let derived = self.derived.as_ref()?;
        let (object, map, solver) = (self.drawn(), &derived.facts, derived.solver);
        #[allow(clippy::cast_possible_truncation)]
        let f = |v: f64| v as f32;
        let (look, beveled) = (&object.texturing, is_beveled(object));
        let length = derived.arc.as_ref().map_or(1.0, |arc| arc.length);
        let [x, y] = object.axis_offset();
        let steps = settings.max_steps;
        let steps = steps.unwrap_or_else(|| solver.default_steps(beveled));
        let [red, green, blue] = object.color;
        // Textures find the profile's box in a box that has grown.
        let growth = self.growth();
        let profile_radius = object.profile.radius * growth.height() - growth.side;
        let [across, up, high] = object.repeat;
        let mirrored = (0..3).map(|i| u32::from(object.mirror[i]) << i).sum();
        let begin = |part| surface.and_then(|s| s.slot(part)).map(Slot::begin);
        Some(ObjectBlock {
            #[allow(clippy::cast_precision_loss)] // at most 16384
            map: [
                map.columns as f32,
                map.rows as f32,
                f(1.0 / f64::from(map.rows)),
                map.scale,
            ],
            bounds: bounds(object, map, solver, surface),
            offset: [
                f(object.offset.extend),
                if beveled { f(object.offset.bevel) } else { 0.0 },
                f(object.offset.chamfer),
                #[allow(clippy::cast_precision_loss)] // at most 65536
                {
                    steps.max(1) as f32
                },
            ],
            axis: [f(x), f(y), f(1.0 / length), 0.0],
            albedo: [red, green, blue, 1.0],
            specular: [
                object.specular.strength,
                object.specular.shininess,
                f(growth.height()),
                f(growth.low),
            ],
            texturing: [
                f(look.repeat[0]),
                f(look.repeat[1]),
                f(look.bump),
                f(2.0 * profile_radius),
            ],
            cells: [across, up, high, mirrored],
            instances: [
                self.instances.start,
                self.instances.end - self.instances.start,
                derived.shadow_map,
                window,
            ],
            patches: begin(Part::Tables)
                .zip(surface)
                .map_or([0; 4], |(at, s)| s.tables().block(at)),
            parts: [
                begin(Part::Frusta).unwrap_or(0),
                object.material().bits(),
                begin(Part::Patches).unwrap_or(0),
                0,
            ],
        })
    }
}

/// Half of the box's side, then the radius, lowest `z` and highest `z` of the cylinder outside of
/// which nothing is solid.
#[allow(clippy::cast_possible_truncation)]
fn bounds(
    object: &Object,
    map: &MapFacts,
    solver: Solver,
    surface: Option<&OffsetSurface>,
) -> [f32; 4] {
    let texel = 1.0 / f64::from(map.rows);
    let grow = largest_width(&object.offset).max(0.0) + texel;
    // The map gives no values beyond its last column.
    let reach = if solver.reads_map() {
        f64::from(map.columns) * texel
    } else {
        f64::INFINITY
    };
    let radius = (map.bounds.r_max + grow)
        .min(farthest_corner(object) + texel)
        .min(reach);
    let patches = surface.filter(|_| solver.follows_tolerance());
    [
        object.profile.radius as f32,
        radius as f32 + patches.map_or(0.0, |s| s.slack() as f32),
        (map.bounds.z_min - grow).max(0.0) as f32,
        (map.bounds.z_max + grow).min(1.0) as f32,
    ]
}
