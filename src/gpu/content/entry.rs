//! A renderer's record of an object: its values, and the resources that are derived from them.

use crate::gpu::content::view_plan::PlannedObject;
use crate::gpu::resources::shape_texture::{ArcTexture, MapFacts, ShapeTexture};
use crate::gpu::resources::textures::{ObjectImages, TextureSet};
use crate::plan::levels::COPY_LEVELS;
use crate::scene::{Copies, GrownObject, Growth, Object, Placement};
use crate::settings::Solver;
use crate::shader::{ObjectBlock, Technique, is_beveled};
use crate::solid::cache::{OffsetContour, Solid};
use crate::solid::farthest_corner;
use crate::solid::offset_surface::{OffsetSurface, Part};
use std::ops::Range;
use std::sync::Arc;

/// One object.
pub(in crate::gpu) struct Entry {
    /// The values of the last refresh, which are drawn.
    pub values: Values,
    pub instances: Range<u32>,
    /// Views whose mask shares no bit with it do not show the object.
    pub mask: u32,
    /// The renderer's version at the last change.
    pub version: u64,
    /// The values of the last frame, for motion; `None` if they were the present ones, or if there
    /// was no last frame.
    pub last: Option<LastValues>,
}

/// Values of an object, and the resources that follow from them, whatever the view.
#[derive(Clone)]
pub(in crate::gpu) struct Values {
    pub object: Object,
    pub images: ObjectImages,
    /// The object that is drawn in its place, in a box that has grown with the offset.
    pub grown: Option<GrownObject>,
    /// What follows from the object alone; `None` before a refresh.
    pub boundary: Option<Boundary>,
    /// What follows from the object and from facts of all objects; `None` before a refresh, and if
    /// that failed.
    pub derived: Option<Derived>,
}

/// The boundary of an object, in the forms that searches read.
#[derive(Clone)]
pub(in crate::gpu) struct Boundary {
    /// Keeps the solid alive; the cache does not.
    pub solid: Arc<Solid>,
    /// The contour whose patches are searched, or would be if it closed; `None` for a search on the
    /// map or on a table of its own.
    pub contour: Option<Arc<OffsetContour>>,
    /// Surfaces by level, for levels that views needed. Empty for a search on the map.
    pub levels: Vec<(u8, Arc<OffsetSurface>)>,
    pub map: Option<Arc<ShapeTexture>>,
}

impl Boundary {
    /// True if the search on patches has no contour to search.
    pub fn fails(&self) -> bool {
        self.contour.as_ref().is_some_and(|c| c.get().is_err())
    }
}

/// The part of an object's resources that depends on other objects.
#[derive(Clone)]
pub(in crate::gpu) struct Derived {
    /// The search that draws the object; it may differ from the settings.
    pub solver: Solver,
    /// The bound on its steps, 1 if there is none.
    pub steps: u32,
    pub facts: MapFacts,
    pub arc: Option<Arc<ArcTexture>>,
    /// The number of the object's map among the maps that shadows read.
    pub shadow_map: u32,
    pub textures: Arc<TextureSet>,
    pub technique: Technique,
}

/// An object's values of the last frame.
pub(in crate::gpu) struct LastValues {
    placement: Placement,
    instances: Copies,
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

impl Values {
    /// The object in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        self.grown.as_ref().map_or(&self.object, |g| &g.object)
    }

    /// The growth of the box with the offset.
    pub fn growth(&self) -> Growth {
        self.grown.as_ref().map(|g| g.growth).unwrap_or_default()
    }

    /// Changes placements of the object, and of the one in a box that has grown. `set` gets the
    /// growth, too.
    pub fn place(&mut self, set: impl Fn(&mut Object, Option<Growth>)) {
        set(&mut self.object, None);
        if let Some(GrownObject { object, growth }) = &mut self.grown {
            set(object, Some(*growth));
        }
    }
}

impl Entry {
    pub fn new(object: Object, instances: Range<u32>, version: u64) -> Self {
        Self {
            values: Values {
                object,
                images: ObjectImages::default(),
                grown: None,
                boundary: None,
                derived: None,
            },
            instances,
            mask: u32::MAX,
            version,
            last: None,
        }
    }

    /// The object that is drawn, in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        self.values.drawn()
    }

    /// The resources that draw it; `None` before anything was derived.
    pub fn resources(&self) -> Option<(&Boundary, &Derived)> {
        (self.values.boundary.as_ref()).zip(self.values.derived.as_ref())
    }

    /// Half of the box's side, then the radius, lowest `z` and highest `z` of the cylinder outside
    /// of which nothing is solid.
    #[allow(clippy::cast_possible_truncation)]
    pub fn bounds(&self, derived: &Derived, surfaces: &[Arc<OffsetSurface>]) -> [f32; 4] {
        let (object, map, solver) = (self.drawn(), &derived.facts, derived.solver);
        let texel = 1.0 / f64::from(map.rows);
        let grow = object.offset.largest_width().max(0.0) + texel;
        // The map gives no values beyond its last column.
        let reach = if solver.reads_map() {
            f64::from(map.columns) * texel
        } else {
            f64::INFINITY
        };
        let radius = (map.bounds.r_max + grow)
            .min(farthest_corner(object) + texel)
            .min(reach);
        let patches = surfaces.iter().filter(|_| solver.follows_tolerance());
        [
            object.profile.radius as f32,
            (radius + patches.map(|s| s.slack()).fold(0.0, f64::max)) as f32,
            (map.bounds.z_min - grow).max(0.0) as f32,
            (map.bounds.z_max + grow).min(1.0) as f32,
        ]
    }

    /// The block that shaders read; `None` before anything was derived.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)] // at most 65536
    pub fn block(&self, planned: &PlannedObject) -> Option<ObjectBlock> {
        let (_, derived) = self.resources()?;
        let (object, map) = (self.drawn(), &derived.facts);
        let f = |v: f64| v as f32;
        let (look, offset) = (&object.texturing, &object.offset);
        let length = derived.arc.as_ref().map_or(1.0, |arc| arc.length);
        let [x, y] = object.axis_offset();
        let [red, green, blue] = object.color;
        // Textures find the profile's box in a box that has grown.
        let growth = self.values.growth();
        let profile_radius = object.profile.radius * growth.height() - growth.side;
        let [across, up, high] = object.repeat;
        let mirrored = (0..3).map(|i| u32::from(object.mirror[i]) << i).sum();
        let bevel = if is_beveled(object) {
            offset.bevel
        } else {
            0.0
        };
        let (strength, shininess) = (object.specular.strength, object.specular.shininess);
        let first = self.instances.start;
        let finest = planned.surfaces.first();
        let start = |part| finest.map_or(0, |s| s.start(part));
        let stored = finest.filter(|s| s.slot(Part::Tables).is_some());
        let [a, b, c] = stored.map_or([0; 3], |s| s.tables().facts);
        let mut levels = [0; COPY_LEVELS.len() - 1];
        for (to, surface) in levels.iter_mut().zip(planned.surfaces.iter().skip(1)) {
            *to = surface.start(Part::Tables);
        }
        Some(ObjectBlock {
            map: [
                map.columns as f32,
                map.rows as f32,
                f(1.0 / f64::from(map.rows)),
                map.scale,
            ],
            bounds: self.bounds(derived, &planned.surfaces),
            offset: [
                f(offset.extend),
                f(bevel),
                f(offset.chamfer),
                derived.steps as f32,
            ],
            axis: [f(x), f(y), f(1.0 / length), 0.0],
            albedo: [red, green, blue, 1.0],
            specular: [strength, shininess, f(growth.height()), f(growth.low)],
            texturing: [
                f(look.repeat[0]),
                f(look.repeat[1]),
                f(look.bump),
                f(2.0 * profile_radius),
            ],
            cells: [across, up, high, mirrored],
            instances: [
                first,
                self.instances.end - first,
                derived.shadow_map,
                planned.window(Part::Tables).start,
            ],
            patches: [start(Part::Tables), a, b, c],
            parts: [
                start(Part::Frusta),
                object.material().bits(),
                start(Part::Patches),
                planned.window(Part::Patches).start,
            ],
            levels,
        })
    }
}
