//! Checks a scene's values. Every message gives the key as in a scene file.

use super::{CameraFrame, Copies, Environment, Light, Lighting, Object, Offset, Placement, Scene};
use crate::error::{Error, Result, content};
use glam::DVec3;
use std::fmt::{Debug, Display};
use std::ops::{Bound, RangeBounds};

/// Lengths beyond this leave too few digits to 32-bit floats.
const FAR: f64 = 1e9;
/// Largest offset of a texture, in textures: four digits behind the point are left in single precision.
const MOST_TEXTURES: f64 = 1000.0;
/// Factors of scale and texture repetition are between `1 / LARGE` and `LARGE`.
const LARGE: f64 = 1e6;
/// Largest difference between a rotation's length and 1.
const UNIT: f64 = 1e-6;
/// Most rows of a shape map: textures have no more.
const MOST_ROWS: u32 = 16384;
/// Cells of a box along one axis.
const MAX_REPEAT: u32 = 1024;

impl Scene {
    /// Checks every value.
    ///
    /// # Errors
    /// [`ErrorKind::Content`](crate::error::ErrorKind::Content): the first value out of its range,
    /// with its key (`object.0.scale`) and what would be right.
    pub fn check(&self) -> Result<()> {
        color("background", &self.background)?;
        self.check_camera()?;
        self.lighting().check()?;
        under("object", &self.objects, Object::check)
    }

    fn check_camera(&self) -> Result<()> {
        let camera = &self.camera;
        length("camera.eye", camera.eye)?;
        length("camera.target", camera.target)?;
        length("camera.up", camera.up)?;
        number("camera.shift", &camera.shift)?;
        let view = camera.target - camera.eye;
        // The limit is relative to their distance from the origin: far away, two points that differ
        // in the last digits have no direction.
        let size = camera.eye.length().max(camera.target.length());
        if view.length() <= 1e-12 * size {
            return content(
                "camera.target",
                "is where the eye is; look at some other point",
            );
        }
        // An axis that is never parallel to the view.
        let upright = match view.z.abs() > 0.9 * view.length() {
            true => "[0, 1, 0]",
            false => "[0, 0, 1]",
        };
        if camera.up.try_normalize().is_none() {
            return content("camera.up", format!("has no length; give {upright}"));
        }
        CameraFrame::new(camera, 1, 1)?;
        if camera.up.normalize().cross(view.normalize()).length() < 1e-9 {
            return content(
                "camera.up",
                format!("is parallel to the view; turn it, as to {upright}"),
            );
        }
        Ok(())
    }
}

impl Lighting {
    /// Checks every value.
    ///
    /// # Errors
    /// As [`Scene::check`].
    pub fn check(&self) -> Result<()> {
        color("ambient", &self.ambient)?;
        if let Some(Environment { up, down }) = &self.environment {
            color("environment.up", up)?;
            color("environment.down", down)?;
        }
        under("light", &self.lights, |light| {
            length("direction", light.direction)?;
            if light.direction == DVec3::ZERO {
                return content(
                    "direction",
                    "has no length; say which way the light travels",
                );
            }
            color("color", &light.color)?;
            let most = Light::LARGEST_RADIUS;
            let give = || format!("degrees from 0 to {most}");
            within("radius", &[light.radius], 0.0..=most, give)
        })
    }
}

impl Object {
    /// Checks every value.
    ///
    /// # Errors
    /// The errors of [`Scene::check`], with keys such as `scale`.
    pub fn check(&self) -> Result<()> {
        let most = |most: f64| (Bound::Excluded(0.0), Bound::Included(most));
        let to_most = |most: f64| move || format!("more than 0 and at most {most}");
        within(
            "radius",
            &[self.profile.radius],
            most(LARGE),
            to_most(LARGE),
        )?;
        let (rows, specular) = ([self.map_rows], self.specular);
        // One row has no slope.
        let give = || format!("2 to {MOST_ROWS}");
        within("map_rows", &rows, 2..=MOST_ROWS, give)?;
        color("color", &self.color)?;
        let (strength, shininess) = ([specular.strength], [f64::from(specular.shininess)]);
        within("specular", &strength, 0.0..=f32::MAX, || "0 or more")?;
        within("shininess", &shininess, most(1e4), to_most(1e4))?;
        if let Some(material) = self.material {
            within("roughness", &[material.roughness], 0.0..=1.0, || "0 to 1")?;
            within("metalness", &[material.metalness], 0.0..=1.0, || "0 to 1")?;
        }
        number("bump", &[self.texturing.bump])?;
        factors("texture_repeat", &self.texturing.repeat)?;
        let offset = -MOST_TEXTURES..=MOST_TEXTURES;
        let give = || format!("-{MOST_TEXTURES} to {MOST_TEXTURES}");
        within("texture_offset", &self.texturing.offset, offset, give)?;
        self.offset.check()?;
        within(
            "axis",
            &self.axis,
            0.0..=1.0,
            || "box coordinates from 0 to 1",
        )?;
        let cells = || format!("1 to {MAX_REPEAT}");
        within("repeat", &self.repeat, 1..=MAX_REPEAT, cells)?;
        self.placement.check()?;
        self.instances.check()
    }
}

impl Copies {
    /// Checks every value, unless all were found valid before.
    pub(crate) fn check(&self) -> Result<()> {
        self.unless_checked(|copies| under("instances", copies, Placement::check))
    }
}

impl Offset {
    /// Checks every value.
    ///
    /// # Errors
    /// As [`Object::check`].
    pub fn check(&self) -> Result<()> {
        number("extend", &[self.extend])?;
        let slope = || format!("a slope from 0 to {LARGE:e}");
        within("bevel", &[self.bevel], 0.0..=LARGE, slope)?;
        within(
            "chamfer",
            &[self.chamfer],
            0.0..=1.0,
            || "a depth from 0 to 1",
        )
    }
}

impl Placement {
    /// Checks every value.
    ///
    /// # Errors
    /// As [`Object::check`].
    pub fn check(&self) -> Result<()> {
        length("position", self.position)?;
        let turn = self.rotation.length();
        if !(1.0 - UNIT..=1.0 + UNIT).contains(&turn) {
            let message = format!("is a quaternion of length {turn:?}; bring it to 1");
            return content("rotation", message);
        }
        factors("scale", &self.scale.to_array())
    }
}

/// Checks all values of a list, and puts `list.index.` before the key of an error.
fn under<T>(list: &str, all: &[T], check: impl Fn(&T) -> Result<()>) -> Result<()> {
    let mut all = all.iter().enumerate();
    all.try_for_each(|(index, one)| {
        check(one).map_err(|error| Error {
            key: error.key.map(|key| format!("{list}.{index}.{key}")),
            ..error
        })
    })
}

/// Checks that values are in a range. `give` says what is.
fn within<T: PartialOrd + Debug, S: Display>(
    key: &str,
    values: &[T],
    range: impl RangeBounds<T>,
    give: impl FnOnce() -> S,
) -> Result<()> {
    let Some(value) = values.iter().find(|value| !range.contains(*value)) else {
        return Ok(());
    };
    let verb = if values.len() == 1 { "is" } else { "has" };
    content(key, format!("{verb} {value:?}; give {}", give()))
}

/// Colours and lights may be brighter than 1, never negative.
fn color(key: &str, channels: &[f32]) -> Result<()> {
    let give = || "finite numbers that are not negative";
    within(key, channels, 0.0..=f32::MAX, give)
}

fn number(key: &str, values: &[f64]) -> Result<()> {
    within(key, values, -FAR..=FAR, || {
        format!("numbers within {FAR:e}")
    })
}

fn length(key: &str, vector: DVec3) -> Result<()> {
    number(key, &vector.to_array())
}

fn factors(key: &str, values: &[f64]) -> Result<()> {
    let least = LARGE.recip();
    let give = || format!("numbers from {least:e} to {LARGE:e}");
    within(key, values, least..=LARGE, give)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;
    use crate::profile::Profile;
    use crate::scene::Camera;
    use glam::DQuat;
    use std::sync::Arc;

    fn scene() -> Scene {
        let points = [[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]];
        let profile = Arc::new(Profile::polygon(&points, 0.5).unwrap());
        let mut scene = Scene::new(Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::ZERO));
        scene.objects = vec![Object::new("a", profile.clone()), Object::new("b", profile)];
        scene
    }

    fn sky(scene: &mut Scene) -> &mut Environment {
        let (up, down) = ([1.0; 3], [0.0; 3]);
        scene.environment.insert(Environment { up, down })
    }

    /// Spoils one value and expects an error with its key.
    #[track_caller]
    fn refused(key: &str, spoil: impl Fn(&mut Scene)) {
        let mut scene = scene();
        scene.check().unwrap();
        spoil(&mut scene);
        let error = scene.check().unwrap_err();
        assert_eq!(
            (error.kind, error.key.as_deref()),
            (ErrorKind::Content, Some(key)),
            "{error}"
        );
    }

    #[test]
    fn values_out_of_range_are_refused() {
        type Case = (&'static str, fn(&mut Scene));
        let cases: [Case; 22] = [
            ("camera.eye", |s| s.camera.eye.x = f64::NAN),
            ("camera.eye", |s| s.camera.eye.x = 1e300),
            ("camera.target", |s| s.camera.target = s.camera.eye),
            ("camera.target", |s| {
                s.camera.eye = DVec3::splat(1e8);
                s.camera.target = s.camera.eye + DVec3::X * 1e-7;
            }),
            ("camera.up", |s| s.camera.up = DVec3::ZERO),
            ("camera.up", |s| {
                s.camera.up = 3.0 * (s.camera.eye - s.camera.target);
            }),
            ("background", |s| s.background[3] = -0.1),
            ("ambient", |s| s.ambient[0] = f32::INFINITY),
            ("environment.up", |s| sky(s).up[1] = -0.5),
            ("environment.down", |s| sky(s).down[2] = f32::NAN),
            ("light.0.direction", |s| s.lights[0].direction = DVec3::ZERO),
            ("light.0.color", |s| s.lights[0].color[1] = f32::NAN),
            ("object.1.color", |s| s.objects[1].color[2] = -1.0),
            ("object.0.specular", |s| {
                s.objects[0].specular.strength = -1.0
            }),
            ("object.0.shininess", |s| {
                s.objects[0].specular.shininess = 0.0
            }),
            ("object.0.extend", |s| s.objects[0].offset.extend = -1e300),
            ("object.0.bump", |s| s.objects[0].texturing.bump = f64::NAN),
            ("object.0.texture_repeat", |s| {
                s.objects[0].texturing.repeat[1] = 0.0;
            }),
            ("object.0.texture_offset", |s| {
                s.objects[0].texturing.offset[0] = -1001.0;
            }),
            ("object.0.radius", |s| {
                Arc::make_mut(&mut s.objects[0].profile).radius = 0.0;
            }),
            ("object.0.position", |s| {
                s.objects[0].placement.position.z = f64::NAN;
            }),
            ("object.1.instances.1.scale", |s| {
                s.objects[1].instances = vec![Placement::default(); 2].into();
                s.objects[1].instances[1].scale.x = 0.0;
            }),
        ];
        for (key, spoil) in cases {
            refused(key, spoil);
        }
        for fov in [0.0, 180.0, -40.0, f64::NAN, f64::INFINITY] {
            refused("camera.fov_y", |s| s.camera.fov_y = fov);
        }
        for radius in [-1.0, 61.0, f64::NAN, f64::INFINITY] {
            refused("light.0.radius", |s| s.lights[0].radius = radius);
        }
        for bad in [f64::NAN, f64::INFINITY, -0.1, 1e7] {
            refused("object.1.bevel", |s| s.objects[1].offset.bevel = bad);
        }
        for bad in [f64::NAN, 2.0, -0.1] {
            refused("object.1.chamfer", |s| s.objects[1].offset.chamfer = bad);
            refused("object.1.axis", |s| s.objects[1].axis[0] = bad);
        }
        for bad in [0, 1025, u32::MAX] {
            refused("object.0.repeat", |s| s.objects[0].repeat[2] = bad);
        }
        for bad in [0, 1, 16385] {
            refused("object.0.map_rows", |s| s.objects[0].map_rows = bad);
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
            refused("object.0.scale", |s| s.objects[0].placement.scale.y = bad);
        }
        for w in [0.0, f64::NAN] {
            let rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, w);
            refused("object.0.rotation", |s| {
                s.objects[0].placement.rotation = rotation
            });
        }
    }

    #[test]
    fn the_ends_of_the_ranges_are_good() {
        let mut scene = scene();
        scene.camera.fov_y = 179.9;
        scene.lights.clear();
        let object = &mut scene.objects[0];
        object.offset.chamfer = 0.0;
        object.offset.extend = -0.5;
        object.repeat = [1, 1024, 1];
        object.map_rows = 16384;
        object.axis = [0.0, 1.0];
        object.color = [4.0, 0.0, 1.0];
        scene.check().unwrap();
    }
}
