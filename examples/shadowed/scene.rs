//! The scene: chessmen, a row of pawns that moves, a ball, and meshes among them.

use super::host::{Fallible, Host, Mesh, solids};
use glam::{DQuat, DVec3, Vec3};
use revmap::scene::{Object, Offset, Placement};

/// The eye.
pub const EYE: DVec3 = DVec3::new(2.6, 0.6, 1.9);
/// The point that it looks at.
pub const TARGET: DVec3 = DVec3::new(0.0, 0.0, 0.25);
/// The middle of the ball.
pub const BALL: DVec3 = DVec3::new(0.4, 0.76, 0.3);
/// Its radius.
pub const BALL_RADIUS: f64 = 0.3;
const BALL_COLOR: Vec3 = Vec3::new(0.15, 0.3, 0.7);
/// Spheres that are meshes in every picture: their middle and radius. The second floats.
pub const SPHERES: [(DVec3, f64); 2] = [
    (DVec3::new(-0.24, -0.72, 0.22), 0.22),
    (DVec3::new(1.12, -0.23, 0.79), 0.1),
];
const SPHERE_COLORS: [Vec3; 2] = [Vec3::new(0.6, 0.6, 0.55), Vec3::new(0.9, 0.35, 0.05)];

/// Unit direction to the sun.
pub fn towards_sun() -> DVec3 {
    DVec3::new(0.4, -0.75, 0.55).normalize()
}

/// The solids of a frame: pawns, king, rook, ball.
pub fn objects(frame: u32) -> Fallible<Vec<Object>> {
    let mut pawns = solids::chessman("pawn", [0.15, 0.3, 0.25])?;
    pawns.instances = row(frame).into();
    let mut king = solids::chessman("king", [0.8, 0.55, 0.2])?;
    king.placement.position = DVec3::new(0.1, -1.38, 0.0);
    let mut rook = solids::chessman("rook", [0.5, 0.12, 0.08])?;
    rook.placement.position = DVec3::new(0.8, 0.03, 0.0);
    rook.placement.scale = DVec3::splat(0.8);
    rook.offset = Offset {
        extend: 0.0,
        bevel: 0.08,
        chamfer: 0.4,
    };
    let ball = solids::ball(BALL, BALL_RADIUS, BALL_COLOR)?;
    Ok(vec![pawns, king, rook, ball])
}

/// Pawns in a row, each in the shadow of the one before. They advance from frame to frame.
pub fn row(frame: u32) -> Vec<Placement> {
    let along = DVec3::new(-0.12, 0.42, 0.0);
    let placed = |n: u32| Placement {
        position: DVec3::new(-0.6, -1.3, 0.0) + along * (f64::from(n) + 0.05 * f64::from(frame)),
        rotation: DQuat::IDENTITY,
        scale: DVec3::splat(0.55),
    };
    (0..7).map(placed).collect()
}

/// The host's meshes; `ball`: one in place of the solid.
pub fn meshes(host: &Host, ball: bool) -> Fallible<Vec<Mesh<'_>>> {
    let sphere = |(middle, radius): (DVec3, f64), color| {
        Mesh::sphere(host, 128, middle.as_vec3(), radius as f32, color)
    };
    let mut all = vec![Mesh::floor(host, 2.5, 0.0, Vec3::new(0.35, 0.33, 0.3))?];
    for (of, color) in SPHERES.into_iter().zip(SPHERE_COLORS) {
        all.push(sphere(of, color)?);
    }
    if ball {
        all.push(sphere((BALL, BALL_RADIUS), BALL_COLOR)?);
    }
    Ok(all)
}
