//! Self-contained values of a scene file: cameras, lights, offsets, placements.

use super::instances::unit;
use super::keys::Keys;
use super::{Camera, Light, Offset, Placement, Specular};
use crate::error::Result;
use glam::DVec3;
use toml::Table;

/// Keys of `[camera]`.
pub(super) const CAMERA: &[&str] = &["eye", "target", "up", "fov_y"];
/// Keys of `[[light]]`.
pub(super) const LIGHT: &[&str] = &["direction", "color", "radius"];

pub(super) fn camera(table: &Table) -> Result<Camera> {
    let keys = Keys::new(table, "camera", CAMERA)?;
    let point =
        |key: &str| -> Result<Option<DVec3>> { Ok(keys.numbers(key)?.map(DVec3::from_array)) };
    let needed = |key: &str| -> Result<DVec3> {
        point(key)?
            .ok_or_else(|| keys.fail(key, "is missing; give three numbers, as in [1.6, 0.3, 1.1]"))
    };
    let plain = Camera::new(needed("eye")?, needed("target")?);
    Ok(Camera {
        up: point("up")?.unwrap_or(plain.up),
        fov_y: keys.number("fov_y")?.unwrap_or(plain.fov_y),
        ..plain
    })
}

pub(super) fn light(table: &Table, index: usize) -> Result<Light> {
    let keys = Keys::new(table, format!("light.{index}"), LIGHT)?;
    let plain = Light::default();
    Ok(Light {
        direction: keys
            .numbers("direction")?
            .map_or(plain.direction, DVec3::from_array),
        color: keys.floats("color")?.unwrap_or(plain.color),
        radius: keys.number("radius")?.unwrap_or(plain.radius),
    })
}

pub(super) fn specular(keys: &Keys) -> Result<Specular> {
    let plain = Specular::default();
    Ok(Specular {
        strength: keys
            .number("specular")?
            .map_or(plain.strength, |x| x as f32),
        shininess: keys
            .number("shininess")?
            .map_or(plain.shininess, |x| x as f32),
    })
}

pub(super) fn offset(keys: &Keys) -> Result<Offset> {
    let plain = Offset::default();
    Ok(Offset {
        extend: keys.number("extend")?.unwrap_or(plain.extend),
        bevel: keys.number("bevel")?.unwrap_or(plain.bevel),
        chamfer: keys.number("chamfer")?.unwrap_or(plain.chamfer),
    })
}

pub(super) fn placement(keys: &Keys) -> Result<Placement> {
    let plain = Placement::default();
    Ok(Placement {
        position: keys
            .numbers("position")?
            .map_or(plain.position, DVec3::from_array),
        rotation: match keys.numbers("rotation")? {
            Some(xyzw) => unit(xyzw).map_err(|e| e.at_key(keys.place("rotation")))?,
            None => plain.rotation,
        },
        scale: keys
            .numbers("scale")?
            .map_or(plain.scale, DVec3::from_array),
    })
}
