//! The content of a picture: camera, lights, objects. Scenes are plain values, checked once by
//! [`Scene::check`]. The crate `revmap-files` reads them from files.
//!
//! A scene needs no file. An engine fills the same values:
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use revmap::profile::Profile;
//! use revmap::scene::{Camera, Object, Scene};
//! use std::sync::Arc;
//!
//! // A double cone of height 1 and radius 0.4: the half-plane's points (r, z), closed along the axis.
//! let points = [[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]];
//! let profile = Arc::new(Profile::polygon(&points, 0.5)?);
//!
//! let mut spindle = Object::new("spindle", profile);
//! spindle.color = [0.8, 0.3, 0.1];
//! spindle.offset.extend = 0.02;
//! spindle.placement.position = DVec3::new(0.0, 0.0, -0.5);
//!
//! let mut scene = Scene::new(Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::ZERO));
//! scene.objects.push(spindle);
//! scene.check()?;
//! # Ok::<(), revmap::Error>(())
//! ```

mod camera;
mod check;
mod clusters;
mod copies;
mod growth;
mod object;

pub use crate::surface::Offset;
pub use camera::CameraFrame;
pub(crate) use clusters::{Cluster, ends};
pub use copies::Copies;
#[doc(hidden)]
pub use growth::{GrownObject, GrownProfiles, Growth, MOST_GROWTH};
pub use object::{BumpForm, Clip, Material, Object, Specular, Texturing};

use glam::{DQuat, DVec3};

/// A whole scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Background colour, linear RGBA.
    pub background: [f32; 4],
    /// Light that comes from everywhere, linear RGB.
    pub ambient: [f32; 3],
    /// The sky that surfaces reflect, if there is one.
    pub environment: Option<Environment>,
    /// The eye.
    pub camera: Camera,
    /// Directional lights.
    pub lights: Vec<Light>,
    /// Shadows of objects on each other and on themselves.
    pub shadow: Shadow,
    /// The solids.
    pub objects: Vec<Object>,
}

impl Scene {
    /// An empty scene: transparent black background, a little ambient light, [`Light::pair`], no
    /// shadows.
    #[must_use]
    pub fn new(camera: Camera) -> Self {
        Self {
            background: [0.0; 4],
            ambient: Self::AMBIENT,
            environment: None,
            camera,
            lights: Light::pair().to_vec(),
            shadow: Shadow::Off,
            objects: Vec::new(),
        }
    }

    /// The scene's lights and shadows.
    #[must_use]
    pub fn lighting(&self) -> Lighting {
        Lighting {
            ambient: self.ambient,
            environment: self.environment,
            lights: self.lights.clone(),
            shadow: self.shadow,
        }
    }

    /// The default ambient light of a scene: enough to show shapes that face away from the light.
    pub const AMBIENT: [f32; 3] = [0.1; 3];
}

/// A pinhole camera. The ray of pixel `(i, j)` of a `w x h` picture passes its centre; row 0 is on
/// top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye, world units.
    pub eye: DVec3,
    /// The point that the camera looks at, world units.
    pub target: DVec3,
    /// The upward direction.
    pub up: DVec3,
    /// Vertical field of view, degrees, between 0 and 180.
    pub fov_y: f64,
    /// The point of the pixel that each ray passes, in pixels right of and below the centre. The
    /// average of pictures with several shifts is free of jagged edges.
    pub shift: [f64; 2],
    /// Width of the part of a pixel that a ray stands for, pixels: 1, or `1 / sqrt(n)` for the average
    /// of `n` pictures. Textures are as sharp as that.
    pub ray_width: f64,
}

impl Camera {
    /// The default vertical field of view, degrees.
    pub const FOV_Y: f64 = 40.0;

    /// A camera at `eye` that looks at `target`, `+z` up, with a vertical field of view of
    /// [`Camera::FOV_Y`].
    #[must_use]
    pub fn new(eye: DVec3, target: DVec3) -> Self {
        Self {
            eye,
            target,
            up: DVec3::Z,
            fov_y: Self::FOV_Y,
            shift: [0.0; 2],
            ray_width: 1.0,
        }
    }
}

/// The placement of an object's box in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Position of the middle of the box's lower face, world units.
    pub position: DVec3,
    /// Unit quaternion.
    pub rotation: DQuat,
    /// `S`: factors along the object's axes, each positive.
    pub scale: DVec3,
}

impl Default for Placement {
    /// Upright at the origin, one world unit high.
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        }
    }
}

/// A light from afar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The direction in which the light of its centre travels; any length but zero.
    pub direction: DVec3,
    /// Linear RGB.
    pub color: [f32; 3],
    /// Angular radius of its disc, degrees, 0 to 60. Only soft shadows use it.
    pub radius: f64,
}

impl Light {
    /// Angular radius if none is given, degrees.
    pub const RADIUS: f64 = 2.0;
    /// Largest angular radius, degrees.
    pub const LARGEST_RADIUS: f64 = 60.0;

    /// The default light, and a weak one from behind and from the other side. Together they leave
    /// no side of a solid flat.
    #[must_use]
    pub fn pair() -> [Self; 2] {
        let fill = Self {
            direction: DVec3::new(0.9, 0.45, -0.2),
            color: [0.25, 0.28, 0.33],
            ..Self::default()
        };
        [Self::default(), fill]
    }

    /// `1 - cos` of the angular radius: the height of the cap of directions from which light comes.
    #[must_use]
    pub fn cap(&self) -> f64 {
        // Without cancellation for small discs.
        2.0 * (0.5 * self.radius.to_radians()).sin().powi(2)
    }
}

impl Default for Light {
    /// White light from above, in front and to one side.
    fn default() -> Self {
        Self {
            direction: DVec3::new(-0.4, -0.6, -0.7),
            color: [1.0; 3],
            radius: Self::RADIUS,
        }
    }
}

/// A sky of two colours around the scene, linear RGB. Its colour in direction `d`, a unit vector, is
/// `sky(d) = mix(down, up, 0.5 + 0.5 d.z)`. Nothing hides it.
///
/// A surface adds `albedo sky(n) + specular mix(f, albedo, metalness) sky(mix(r, n, roughness))` to its
/// colour. `n` is the normal, and `r` the direction in which the surface reflects the ray from the
/// eye. `f = 0.04 + 0.96 (1 - n.v)^5`, with `v` towards the eye, is the part that glass or a glaze
/// reflects (Schlick 1994): more at the rim, so that the albedo keeps its colour elsewhere.
/// `specular` is [`Specular::strength`]; the others are of [`Object::material`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// The colour straight up, along `+z`.
    pub up: [f32; 3],
    /// The colour straight down.
    pub down: [f32; 3],
}

impl Environment {
    /// The colour in a direction of length 1, or the mean over several such directions for theirs.
    #[must_use]
    pub fn sky(&self, direction: DVec3) -> [f64; 3] {
        let part = 0.5 + 0.5 * direction.z;
        std::array::from_fn(|c| {
            let [up, down] = [self.up[c], self.down[c]].map(f64::from);
            down + part * (up - down)
        })
    }
}

/// The lights and shadows of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Light that comes from everywhere, linear RGB.
    pub ambient: [f32; 3],
    /// The sky that surfaces reflect, if there is one. A function of the host shades without it.
    pub environment: Option<Environment>,
    /// Directional lights.
    pub lights: Vec<Light>,
    /// Shadows of objects on each other and on themselves.
    pub shadow: Shadow,
}

impl Default for Lighting {
    /// A little ambient light, no environment, [`Light::pair`], no shadows.
    fn default() -> Self {
        Self {
            ambient: Scene::AMBIENT,
            environment: None,
            lights: Light::pair().to_vec(),
            shadow: Shadow::Off,
        }
    }
}

/// Shadows, by tracing from the surface towards each light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shadow {
    /// No shadows; nothing is traced.
    #[default]
    Off,
    /// Hard shadows: each point is lit or not.
    Hard,
    /// Soft shadows: each point is lit by the part of the light's disc that it sees. Rays to points
    /// of the disc estimate that part.
    Soft,
}

impl Shadow {
    /// Every form with its name in scene files.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("off", Self::Off),
        ("hard", Self::Hard),
        ("soft", Self::Soft),
    ];
}
