//! Checks a scene's values. Every message gives the key as in a scene file.

use super::{Camera, Light, Lighting, Material, Object, Offset, Placement, Scene};
use crate::error::{Error, ErrorKind, Result};
use glam::DVec3;
use std::ops::RangeInclusive;

/// Lengths beyond this leave too few digits to 32-bit floats.
const FAR: f64 = 1e9;
/// Factors of scale and texture repetition are between `1 / LARGE` and `LARGE`.
const LARGE: f64 = 1e6;
/// Largest difference between a rotation's length and 1.
const UNIT: f64 = 1e-6;
/// Range of rows of a shape map: one row has no slope, and textures have no more than the upper
/// limit.
const ROWS: RangeInclusive<u32> = 2..=16384;
/// Cells of a box along one axis.
const MAX_REPEAT: u32 = 1024;

impl Scene {
    /// Checks every value.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: the first value out of its range, with its key (`object.0.scale`)
    /// and what would be right.
    pub fn check(&self) -> Result<()> {
        color("background", &self.background)?;
        camera(&self.camera)?;
        lighting(&self.ambient, &self.lights)?;
        for (i, one) in self.objects.iter().enumerate() {
            object(one).map_err(|e| under("object", i, e))?;
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
        lighting(&self.ambient, &self.lights)
    }
}

impl Object {
    /// Checks every value.
    ///
    /// # Errors
    /// The errors of [`Scene::check`], with keys such as `scale`.
    pub fn check(&self) -> Result<()> {
        object(self)
    }
}

impl Offset {
    /// Checks every value.
    ///
    /// # Errors
    /// As [`Object::check`].
    pub fn check(&self) -> Result<()> {
        offset(*self)
    }
}

impl Placement {
    /// Checks every value.
    ///
    /// # Errors
    /// As [`Object::check`].
    pub fn check(&self) -> Result<()> {
        placement(self)
    }
}

fn lighting(ambient: &[f32], lights: &[Light]) -> Result<()> {
    color("ambient", ambient)?;
    for (i, one) in lights.iter().enumerate() {
        light(one).map_err(|e| under("light", i, e))?;
    }
    Ok(())
}

fn fail(key: &str, message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Content, message).at_key(key)
}

/// Puts `list.index.` before the key of `error`.
fn under(list: &str, index: usize, mut error: Error) -> Error {
    if let Some(key) = &mut error.key {
        *key = format!("{list}.{index}.{key}");
    }
    error
}

fn camera(camera: &Camera) -> Result<()> {
    length("camera.eye", camera.eye)?;
    length("camera.target", camera.target)?;
    length("camera.up", camera.up)?;
    let view = camera.target - camera.eye;
    // The limit is relative to their distance from the origin: far away, two points that differ in
    // the last digits have no direction.
    let size = camera.eye.length().max(camera.target.length());
    if view.length() <= 1e-12 * size || view == DVec3::ZERO {
        return Err(fail(
            "camera.target",
            "is where the eye is; look at some other point",
        ));
    }
    if camera.up == DVec3::ZERO {
        return Err(fail("camera.up", "has no length; [0, 0, 1] is usual"));
    }
    if camera.up.normalize().cross(view.normalize()).length() < 1e-9 {
        return Err(fail(
            "camera.up",
            "is parallel to the view; turn it, as to [0, 1, 0]",
        ));
    }
    if !(camera.fov_y > 0.0 && camera.fov_y < 180.0) {
        return Err(fail(
            "camera.fov_y",
            format!(
                "is {:?} degrees; give more than 0 and less than 180",
                camera.fov_y
            ),
        ));
    }
    camera
        .shift
        .iter()
        .try_for_each(|&pixels| number("camera.shift", pixels))
}

fn light(light: &Light) -> Result<()> {
    length("direction", light.direction)?;
    if light.direction == DVec3::ZERO {
        return Err(fail(
            "direction",
            "has no length; say which way the light travels",
        ));
    }
    color("color", &light.color)?;
    let most = Light::LARGEST_RADIUS;
    if !(light.radius >= 0.0 && light.radius <= most) {
        return Err(fail(
            "radius",
            format!("is {:?}; give degrees from 0 to {most}", light.radius),
        ));
    }
    Ok(())
}

fn object(object: &Object) -> Result<()> {
    let radius = object.profile.radius;
    if !(radius > 0.0 && radius <= LARGE) {
        return Err(fail(
            "radius",
            format!("is {radius:?}; give more than 0 and at most {LARGE:e}"),
        ));
    }
    if !ROWS.contains(&object.map_rows) {
        let message = format!(
            "is {}; give {} to {}",
            object.map_rows,
            ROWS.start(),
            ROWS.end()
        );
        return Err(fail("map_rows", message));
    }
    color("color", &object.color)?;
    let specular = object.specular;
    if !(specular.strength.is_finite() && specular.strength >= 0.0) {
        return Err(fail(
            "specular",
            format!("is {:?}; give 0 or more", specular.strength),
        ));
    }
    if !(specular.shininess > 0.0 && specular.shininess <= 1e4) {
        return Err(fail(
            "shininess",
            format!(
                "is {:?}; give more than 0 and at most 10000",
                specular.shininess
            ),
        ));
    }
    if let Some(material) = object.material {
        let Material {
            roughness,
            metalness,
        } = material;
        for (key, value) in [("roughness", roughness), ("metalness", metalness)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(fail(key, format!("is {value:?}; give 0 to 1")));
            }
        }
    }
    number("bump", object.texturing.bump)?;
    for factor in object.texturing.repeat {
        factor_in_range("texture_repeat", factor)?;
    }
    offset(object.offset)?;
    for at in object.axis {
        if !(0.0..=1.0).contains(&at) {
            return Err(fail(
                "axis",
                format!("has {at:?}; give box coordinates from 0 to 1"),
            ));
        }
    }
    for cells in object.repeat {
        if !(1..=MAX_REPEAT).contains(&cells) {
            return Err(fail(
                "repeat",
                format!("has {cells}; give 1 to {MAX_REPEAT}"),
            ));
        }
    }
    placement(&object.placement)?;
    object.instances.check(|copies| {
        let mut all = copies.iter().enumerate();
        all.try_for_each(|(i, copy)| placement(copy).map_err(|e| under("instances", i, e)))
    })
}

fn offset(offset: Offset) -> Result<()> {
    number("extend", offset.extend)?;
    if !(offset.bevel >= 0.0 && offset.bevel <= LARGE) {
        return Err(fail(
            "bevel",
            format!("is {:?}; give a slope from 0 to {LARGE:e}", offset.bevel),
        ));
    }
    if !(0.0..=1.0).contains(&offset.chamfer) {
        return Err(fail(
            "chamfer",
            format!("is {:?}; give a depth from 0 to 1", offset.chamfer),
        ));
    }
    Ok(())
}

fn placement(placement: &Placement) -> Result<()> {
    length("position", placement.position)?;
    let turn = placement.rotation.length();
    if !(1.0 - UNIT..=1.0 + UNIT).contains(&turn) {
        return Err(fail(
            "rotation",
            format!("is a quaternion of length {turn:?}; bring it to 1"),
        ));
    }
    placement
        .scale
        .to_array()
        .into_iter()
        .try_for_each(|factor| factor_in_range("scale", factor))
}

/// Colours and lights may be brighter than 1, never negative.
fn color(key: &str, channels: &[f32]) -> Result<()> {
    match channels.iter().find(|c| !(c.is_finite() && **c >= 0.0)) {
        Some(c) => Err(fail(
            key,
            format!("has {c:?}; give finite numbers that are not negative"),
        )),
        None => Ok(()),
    }
}

fn number(key: &str, value: f64) -> Result<()> {
    if value.abs() <= FAR {
        Ok(())
    } else {
        Err(fail(
            key,
            format!("is {value:?}; give a number within {FAR:e}"),
        ))
    }
}

fn length(key: &str, vector: DVec3) -> Result<()> {
    match vector
        .to_array()
        .into_iter()
        .find(|x| !(-FAR..=FAR).contains(x))
    {
        Some(x) => Err(fail(key, format!("has {x:?}; give numbers within {FAR:e}"))),
        None => Ok(()),
    }
}

fn factor_in_range(key: &str, factor: f64) -> Result<()> {
    if (LARGE.recip()..=LARGE).contains(&factor) {
        Ok(())
    } else {
        Err(fail(
            key,
            format!(
                "has {factor:?}; give numbers from {:e} to {LARGE:e}",
                LARGE.recip()
            ),
        ))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::profile::Profile;
    use glam::DQuat;
    use std::sync::Arc;

    fn scene() -> Scene {
        let points = [[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]];
        let profile = Arc::new(Profile::polygon(&points, 0.5).unwrap());
        let mut scene = Scene::new(Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::ZERO));
        scene.objects = vec![Object::new("a", profile.clone()), Object::new("b", profile)];
        scene
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
    fn cameras_that_see_nothing_are_refused() {
        refused("camera.eye", |s| s.camera.eye.x = f64::NAN);
        refused("camera.eye", |s| s.camera.eye.x = 1e300);
        refused("camera.target", |s| s.camera.target = s.camera.eye);
        refused("camera.target", |s| {
            s.camera.eye = DVec3::splat(1e8);
            s.camera.target = s.camera.eye + DVec3::X * 1e-7;
        });
        refused("camera.up", |s| s.camera.up = DVec3::ZERO);
        refused("camera.up", |s| {
            s.camera.up = 3.0 * (s.camera.eye - s.camera.target)
        });
        for fov in [0.0, 180.0, -40.0, f64::NAN, f64::INFINITY] {
            refused("camera.fov_y", |s| s.camera.fov_y = fov);
        }
    }

    #[test]
    fn light_and_colour_are_not_negative() {
        refused("background", |s| s.background[3] = -0.1);
        refused("ambient", |s| s.ambient[0] = f32::INFINITY);
        refused("light.0.direction", |s| s.lights[0].direction = DVec3::ZERO);
        refused("light.0.color", |s| s.lights[0].color[1] = f32::NAN);
        for radius in [-1.0, 61.0, f64::NAN, f64::INFINITY] {
            refused("light.0.radius", |s| s.lights[0].radius = radius);
        }
        refused("object.1.color", |s| s.objects[1].color[2] = -1.0);
        refused("object.0.specular", |s| {
            s.objects[0].specular.strength = -1.0
        });
        refused("object.0.shininess", |s| {
            s.objects[0].specular.shininess = 0.0
        });
    }

    #[test]
    fn shapes_stay_in_range() {
        for bad in [f64::NAN, f64::INFINITY, -0.1, 1e7] {
            refused("object.1.bevel", |s| s.objects[1].offset.bevel = bad);
        }
        for bad in [f64::NAN, 2.0, -0.1] {
            refused("object.1.chamfer", |s| s.objects[1].offset.chamfer = bad);
            refused("object.1.axis", |s| s.objects[1].axis[0] = bad);
        }
        refused("object.0.extend", |s| {
            s.objects[0].offset.extend = f64::NEG_INFINITY
        });
        refused("object.0.bump", |s| s.objects[0].texturing.bump = f64::NAN);
        refused("object.0.texture_repeat", |s| {
            s.objects[0].texturing.repeat[1] = 0.0
        });
        for bad in [0, 1025, u32::MAX] {
            refused("object.0.repeat", |s| s.objects[0].repeat[2] = bad);
        }
        for bad in [0, 1, 16385] {
            refused("object.0.map_rows", |s| s.objects[0].map_rows = bad);
        }
        refused("object.0.radius", |s| {
            let mut profile = (*s.objects[0].profile).clone();
            profile.radius = 0.0;
            s.objects[0].profile = Arc::new(profile);
        });
    }

    #[test]
    fn placements_are_placements() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
            refused("object.0.scale", |s| s.objects[0].placement.scale.y = bad);
        }
        refused("object.0.position", |s| {
            s.objects[0].placement.position.z = f64::NAN
        });
        refused("object.0.rotation", |s| {
            s.objects[0].placement.rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)
        });
        refused("object.0.rotation", |s| {
            s.objects[0].placement.rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, f64::NAN)
        });
        refused("object.1.instances.1.scale", |s| {
            s.objects[1].instances = vec![Placement::default(); 2].into();
            s.objects[1].instances[1].scale.x = 0.0;
        });
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
