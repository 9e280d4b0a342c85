//! Solids that several hosts draw.

use super::Fallible;
use glam::{DVec3, Vec3};
use revmap::profile::Profile;
use revmap::scene::{Object, Placement};
use revmap_files::ProfileAxis;
use std::sync::Arc;

/// A chessman of the repository, at the origin.
pub fn chessman(name: &str, color: [f32; 3]) -> Fallible<Object> {
    let path = format!("{}/assets/profiles/{name}.svg", env!("CARGO_MANIFEST_DIR"));
    let profile = Arc::new(revmap_files::profile(path, ProfileAxis::Center)?);
    let mut object = Object::new(name, profile);
    object.color = color;
    Ok(object)
}

/// A ball, its outline half of a polygon of many corners.
pub fn ball(middle: DVec3, radius: f64, color: Vec3) -> Fallible<Object> {
    const CORNERS: u32 = 512;
    let corner = |n: u32| {
        let (sine, cosine) = (std::f64::consts::PI * f64::from(n) / f64::from(CORNERS)).sin_cos();
        [0.5 * sine, 0.5 - 0.5 * cosine]
    };
    let outline: Vec<_> = (0..=CORNERS).map(corner).collect();
    let mut object = Object::new("ball", Arc::new(Profile::polygon(&outline, 0.5)?));
    object.color = color.to_array();
    object.placement = Placement {
        position: middle - DVec3::Z * radius,
        scale: DVec3::splat(2.0 * radius),
        ..Placement::default()
    };
    Ok(object)
}
