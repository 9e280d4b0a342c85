//! Values that several functions take: places, offsets, lights, cameras, views, searches.

use crate::enums::{self, RevmapShadow};
use crate::fault::{Fault, Outcome, RevmapResult, enter};
use crate::pointers::list;
use crate::structures::{described, fill, read, sized};
use glam::{DMat4, DQuat, DVec3};
use revmap::gpu::{View, Viewport};
use revmap::scene::{Camera, Environment, Light, Lighting, Offset, Placement};
use revmap::settings::{SearchSettings, Tolerance};
use std::sync::LazyLock;

/// Placement of a solid's box. With a scale of (1, 1, 1) the box is one world unit high.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapPlacement {
    /// Position of the middle of the box's lower face, world units.
    pub position: [f64; 3],
    /// Unit quaternion: x, y, z, w.
    pub rotation: [f64; 4],
    /// Factors along the object's axes, each positive.
    pub scale: [f64; 3],
}

/// Distance of the surface from the profile: extend + bevel * min(1 - z, chamfer), object units.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapOffset {
    /// Object units; negative insets.
    pub extend: f64,
    /// Slope.
    pub bevel: f64,
    /// Depth in [0, 1] below the top to which the bevel reaches. The default is 1.
    pub chamfer: f64,
}

/// A light from afar.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapLight {
    /// The way the light of its centre travels; any length but zero.
    pub direction: [f64; 3],
    /// Linear RGB.
    pub color: [f32; 3],
    /// Angular radius of its disc, degrees, 0 to 60. Only soft shadows use it.
    pub radius: f32,
}

/// Lights and shadows of all objects. Defaults: revmap_lighting_defaults().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapLighting {
    /// sizeof(RevmapLighting).
    pub size: u32,
    /// A RevmapShadow.
    pub shadow: u32,
    /// Light that comes from everywhere, linear RGB.
    pub ambient: [f32; 3],
    /// Number of lights.
    pub light_count: u32,
    /// The lights; read during the call.
    pub lights: *const RevmapLight,
    /// Colour of the environment straight up, along +z, linear RGB. Surfaces reflect it, more at
    /// their rim. Both colours 0: there is none.
    pub environment_up: [f32; 3],
    /// Its colour straight down.
    pub environment_down: [f32; 3],
}

/// A pinhole camera. Defaults: revmap_camera_defaults().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapCamera {
    /// sizeof(RevmapCamera).
    pub size: u32,
    /// Not read.
    pub padding: u32,
    /// World units.
    pub eye: [f64; 3],
    /// The point that the camera looks at, world units.
    pub target: [f64; 3],
    /// The upward direction.
    pub up: [f64; 3],
    /// Vertical field of view, degrees, between 0 and 180.
    pub fov_y: f64,
}

/// A host's view. Vectors are columns, matrices are stored column by column, clip space is Vulkan's
/// (0 <= z <= w). A projection whose depth runs against depth_order is refused. The near plane cuts
/// solids as it cuts meshes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapView {
    /// sizeof(RevmapView).
    pub size: u32,
    /// A RevmapDepthOrder: the one of the renderer's output.
    pub depth_order: u32,
    /// Matrix from world to view space.
    pub view: [f64; 16],
    /// Matrix from view to clip space.
    pub projection: [f64; 16],
    /// Viewport in pixels: x, y, width, height. A negative height turns it upside down, as in
    /// Vulkan 1.1.
    pub viewport: [f64; 4],
    /// The view of the last frame, for REVMAP_ATTACHMENT_MOTION; its viewport may differ. Null:
    /// only objects move. Read during the call; its own last is not read.
    pub last: *const RevmapView,
    /// Shift of the picture by the jitter that projection contains, pixels: x to the right, y
    /// downwards. Motion leaves it out.
    pub jitter: [f64; 2],
    /// Shift of all depths, in units of the depth buffer, for shadow maps: positive is farther in
    /// REVMAP_DEPTH_ORDER_NORMAL and nearer in REVMAP_DEPTH_ORDER_REVERSED.
    pub depth_bias: f64,
    /// The view shows the objects whose mask shares a bit with this one; 0: objects of any mask
    /// but 0. See revmap_renderer_set_mask().
    pub mask: u32,
    /// 0: a pass has one view. See RevmapPass.views.
    pub layer: u32,
    /// minDepth and maxDepth of the host's VkViewport, which do not reach depths that a shader
    /// writes by themselves: 0 <= minDepth < maxDepth <= 1. Both 0: 0 to 1.
    pub depth_range: [f64; 2],
    /// Width of the part of a pixel that a ray stands for, pixels: 1 / sqrt(n) if the colours of n
    /// frames with jitter are averaged. Textures are as sharp as that. 0: 1.
    pub ray_width: f64,
}

/// Settings of the search. Defaults: revmap_search_defaults().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapSearch {
    /// sizeof(RevmapSearch).
    pub size: u32,
    /// A RevmapSolver.
    pub solver: u32,
    /// Bound on the search's steps; 0 uses the solver's default.
    pub max_steps: u32,
    /// Rows of every shape map; 0 uses each object's own value.
    pub map_rows: u32,
    /// A RevmapMapSource.
    pub map_source: u32,
    /// A RevmapMapFormat.
    pub map_format: u32,
    /// Least pixels of an object's box for each visible frustum of its cells at which cells are
    /// drawn; below it the box is. It also limits lists of patches in compute, which GPUs make for
    /// solids far wider than high alone. 0: cells and lists in pictures of any size; UINT32_MAX:
    /// neither.
    pub proxy_min_pixels: u32,
    /// Not read.
    pub padding: u32,
    /// Allowed error of silhouettes and depths in pixels of the view, 0 to 64; 0 is exact. Searches
    /// on patches use it.
    pub tolerance: f64,
}

described! {
    RevmapLighting {
        0 => [size, shadow, ambient, light_count, lights]
        5 => [environment_up, environment_down]
    }
    RevmapCamera { 0 => [size, padding, eye, target, up, fov_y] }
    RevmapView {
        0 => [size, depth_order, view, projection, viewport]
        1 => [last, jitter, depth_bias, mask, layer]
        2 => [depth_range]
        3 => [ray_width]
    }
    RevmapSearch {
        0 => [
            size, solver, max_steps, map_rows, map_source, map_format, proxy_min_pixels, padding,
            tolerance,
        ]
    }
}

/// The placement at the origin, upright, one world unit high.
pub(crate) const UPRIGHT: RevmapPlacement = RevmapPlacement {
    position: [0.0; 3],
    rotation: [0.0, 0.0, 0.0, 1.0],
    scale: [1.0; 3],
};

impl From<RevmapPlacement> for Placement {
    fn from(from: RevmapPlacement) -> Self {
        Self {
            position: from.position.into(),
            rotation: DQuat::from_array(from.rotation),
            scale: from.scale.into(),
        }
    }
}

impl From<RevmapOffset> for Offset {
    fn from(from: RevmapOffset) -> Self {
        Self {
            extend: from.extend,
            bevel: from.bevel,
            chamfer: from.chamfer,
        }
    }
}

impl RevmapLighting {
    pub(crate) fn defaults() -> Self {
        static LIGHTS: LazyLock<[RevmapLight; 2]> = LazyLock::new(|| {
            Light::pair().map(|light| RevmapLight {
                direction: light.direction.to_array(),
                color: light.color,
                #[allow(clippy::cast_possible_truncation)]
                radius: light.radius as f32,
            })
        });
        let lighting = Lighting::default();
        Self {
            shadow: RevmapShadow::Off as u32,
            ambient: lighting.ambient,
            light_count: 2,
            lights: LIGHTS.as_ptr(),
            ..sized()
        }
    }

    pub(crate) unsafe fn lighting(&self) -> Outcome<Lighting> {
        let lights = list(self.lights, self.light_count as usize, "lights")?;
        let light = |light: &RevmapLight| Light {
            direction: light.direction.into(),
            color: light.color,
            radius: light.radius.into(),
        };
        let (up, down) = (self.environment_up, self.environment_down);
        Ok(Lighting {
            ambient: self.ambient,
            environment: ([up, down] != [[0.0; 3]; 2]).then_some(Environment { up, down }),
            lights: lights.iter().map(light).collect(),
            shadow: enums::shadow(self.shadow)?,
        })
    }
}

impl RevmapCamera {
    pub(crate) fn defaults() -> Self {
        let from = Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 0.5));
        Self {
            eye: from.eye.to_array(),
            target: from.target.to_array(),
            up: from.up.to_array(),
            fov_y: from.fov_y,
            ..sized()
        }
    }

    pub(crate) fn camera(&self) -> Camera {
        Camera {
            up: self.up.into(),
            fov_y: self.fov_y,
            ..Camera::new(self.eye.into(), self.target.into())
        }
    }
}

impl RevmapView {
    pub(crate) unsafe fn view(&self) -> Outcome<View> {
        let view = self.without_last()?;
        if self.last.is_null() {
            return Ok(view);
        }
        let last = read(self.last)?;
        Ok(view.with_last(&last.without_last()?))
    }

    fn without_last(&self) -> Outcome<View> {
        if self.layer > 0 {
            let message = format!(
                "view: layer {} of a pass; give 0, and begin a pass for each view",
                self.layer
            );
            return Err(Fault::new(RevmapResult::Usage, message));
        }
        let numbers = [self.depth_bias, self.ray_width].into_iter();
        if !numbers.chain(self.jitter).all(f64::is_finite) || self.ray_width < 0.0 {
            let message =
                "view: give finite numbers as jitter and depth_bias, and a ray_width of 0 or more";
            return Err(Fault::new(RevmapResult::Content, message));
        }
        let [x, y, width, height] = self.viewport;
        let viewport = Viewport {
            x,
            y,
            width,
            height,
        };
        let [view, projection] =
            [self.view, self.projection].map(|columns| DMat4::from_cols_array(&columns));
        let order = enums::depth_order(self.depth_order)?;
        let made = View::from_matrices(view, projection, viewport, order)?;
        let mask = match self.mask {
            0 => u32::MAX,
            mask => mask,
        };
        let made = made.with_mask(mask);
        let made = made.with_jitter(self.jitter);
        let made = made.with_depth_bias(self.depth_bias);
        let made = match self.ray_width {
            0.0 => made,
            width => made.with_ray_width(width),
        };
        match self.depth_range {
            [0.0, 0.0] => Ok(made),
            range => Ok(made.with_depth_range(range)?),
        }
    }
}

impl RevmapSearch {
    pub(crate) fn settings(&self) -> Outcome<SearchSettings> {
        let given = |number| (number != 0).then_some(number);
        Ok(SearchSettings {
            solver: enums::solver(self.solver)?,
            max_steps: given(self.max_steps),
            map_rows: given(self.map_rows),
            map_source: enums::map_source(self.map_source)?,
            map_format: enums::map_format(self.map_format)?,
            proxy_min_pixels: self.proxy_min_pixels,
            tolerance: Tolerance::new(self.tolerance)?,
        })
    }

    pub(crate) fn defaults() -> Self {
        Self {
            proxy_min_pixels: SearchSettings::default().proxy_min_pixels,
            tolerance: Tolerance::DEFAULT.pixels(),
            ..sized()
        }
    }
}

/// Fills in a little ambient light, REVMAP_SHADOW_OFF, and one white light from above, which lasts
/// as long as the program. The size must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_lighting_defaults(lighting: *mut RevmapLighting) -> RevmapResult {
    enter(|| fill(lighting, RevmapLighting::defaults()))
}

/// Fills in a camera at (2, 0, 0.5) that looks at (0, 0, 0.5), z up, 40 degrees. The size must be
/// set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_camera_defaults(camera: *mut RevmapCamera) -> RevmapResult {
    enter(|| fill(camera, RevmapCamera::defaults()))
}

/// Fills in the default search. The size must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_search_defaults(search: *mut RevmapSearch) -> RevmapResult {
    enter(|| fill(search, RevmapSearch::defaults()))
}

/// A null search is the default one.
pub(crate) unsafe fn search(from: *const RevmapSearch) -> Outcome<SearchSettings> {
    if from.is_null() {
        return Ok(SearchSettings::default());
    }
    read(from)?.settings()
}
