//! `--studio`: a ground, soft lights and a background for what is drawn without a scene of its own.

use glam::{DQuat, DVec2, DVec3};
use revmap::error::Result;
use revmap::profile::Profile;
use revmap::scene::{Clip, Light, Object, Offset, Placement, Scene, Shadow};
use std::f64::consts::SQRT_2;
use std::sync::Arc;

/// Albedo of the ground, linear.
const GROUND: f32 = 0.62;
const AMBIENT: [f32; 3] = [0.34, 0.35, 0.37];

/// Replaces lights, shadows and background of a scene, and puts a ground below its objects. The
/// light comes from the upper left of the camera. The background has the colour of the lit ground,
/// so the ground has no visible end.
pub fn furnish(scene: &mut Scene) -> Result<()> {
    let up = scene.camera.up.normalize_or(DVec3::Z);
    let sight = scene.camera.target - scene.camera.eye;
    let level = sight - up * sight.dot(up);
    let ahead = level.normalize_or(up.any_orthonormal_vector());
    let right = ahead.cross(up);
    scene.ambient = AMBIENT;
    scene.shadow = Shadow::Soft;
    scene.lights = vec![
        Light {
            direction: (0.5 * ahead + 0.62 * right - 0.9 * up).normalize(),
            color: [0.80, 0.77, 0.72],
            radius: 7.0,
        },
        Light {
            direction: (0.4 * ahead - 0.9 * right - 0.35 * up).normalize(),
            color: [0.13, 0.15, 0.19],
            radius: 20.0,
        },
    ];
    let [r, g, b] = [0, 1, 2].map(|c| GROUND * lit(scene, up, c));
    scene.background = [r, g, b, 1.0];
    if let Some(ground) = ground(scene, up)? {
        scene.objects.push(ground);
    }
    Ok(())
}

/// The light that the ground reflects, of channel `c`: all of the lights' discs are above it.
fn lit(scene: &Scene, up: DVec3, c: usize) -> f32 {
    let of_light = |light: &Light| {
        let height = 1.0 - light.radius.to_radians().cos();
        light.color[c] * (-light.direction.dot(up) * (1.0 - 0.5 * height)) as f32
    };
    scene.ambient[c] + scene.lights.iter().map(of_light).sum::<f32>()
}

/// A disc below the lowest point of the objects, as wide as their shadows need. None where nothing
/// is drawn, or where the eye is below it.
fn ground(scene: &Scene, up: DVec3) -> Result<Option<Object>> {
    let all: Vec<Points> = scene.objects.iter().map(Points::of).collect();
    let farthest = |axis: DVec3| {
        let of_all = all.iter().map(|points| points.farthest(axis));
        of_all.fold(f64::NEG_INFINITY, f64::max)
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let high = DVec3::from(axes.map(farthest));
    let low = -DVec3::from(axes.map(|axis| farthest(-axis)));
    let lowest = -farthest(-up);
    let radius = 3.0 * (high - low).length();
    if !radius.is_finite() || radius == 0.0 || scene.camera.eye.dot(up) <= lowest {
        return Ok(None);
    }
    let disc = Profile::polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 1.0)?;
    let mut ground = Object::new("ground", Arc::new(disc));
    ground.color = [GROUND; 3];
    ground.specular.strength = 0.0;
    let scale = DVec3::new(radius, radius, 0.01 * radius);
    let middle = 0.5 * (low + high);
    ground.placement = Placement {
        position: middle + up * (lowest - scale.z - middle.dot(up)),
        rotation: DQuat::from_rotation_arc(DVec3::Z, up),
        scale,
    };
    Ok(Some(ground))
}

/// The points that enclose an object.
struct Points<'a> {
    object: &'a Object,
    /// Radius and height, and how far the offset moves the surface there, object units.
    points: Vec<(DVec2, f64)>,
}

impl<'a> Points<'a> {
    fn of(object: &'a Object) -> Self {
        let corner = DVec2::new(object.profile.radius * SQRT_2, 1.0);
        let Offset {
            extend,
            bevel,
            chamfer,
        } = object.offset;
        let moved = |p: DVec2| extend + bevel * chamfer.min((1.0 - p.y).max(0.0));
        let cut = object.clip == Clip::Box && moved(DVec2::ZERO) > 0.0;
        let points = if cut || object.repeat != [1; 3] {
            // The box itself.
            vec![(DVec2::new(corner.x, 0.0), 0.0), (corner, 0.0)]
        } else {
            let segments = object.profile.outline.segments();
            let point = |p: DVec2| (p.clamp(DVec2::ZERO, corner), moved(p));
            segments.map(|segment| point(segment.a)).collect()
        };
        Self { object, points }
    }

    /// The largest coordinate of a solid's points along `axis`, of all copies.
    fn farthest(&self, axis: DVec3) -> f64 {
        let of_copy = |place: &Placement| {
            let v = place.rotation.conjugate() * axis * place.scale;
            let along = DVec2::new(v.x.hypot(v.y), v.z);
            let reach = |(p, moved): &(DVec2, f64)| p.dot(along) + moved * v.length();
            let reach = self.points.iter().map(reach);
            place.position.dot(axis) + reach.fold(f64::NEG_INFINITY, f64::max)
        };
        let copies = self.object.placements().iter().map(of_copy);
        copies.fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap::scene::Camera;

    fn scene(eye: DVec3, up: DVec3) -> Scene {
        let corners = [[0.0, 0.2], [0.4, 0.2], [0.1, 0.9], [0.0, 0.9]];
        let mut cone = Object::new("cone", Arc::new(Profile::polygon(&corners, 0.5).unwrap()));
        cone.placement.scale = DVec3::new(1.0, 1.0, 2.0);
        let mut scene = Scene::new(Camera {
            up,
            ..Camera::new(eye, DVec3::ZERO)
        });
        scene.objects = vec![cone];
        scene
    }

    /// The height of the ground's upper face along the camera's upward direction.
    fn level(mut scene: Scene) -> Option<f64> {
        furnish(&mut scene).unwrap();
        let ground = scene.objects.get(1)?;
        let place = &ground.placement;
        let top = place.position + place.rotation * (place.scale.z * DVec3::Z);
        Some(top.dot(scene.camera.up))
    }

    #[test]
    fn the_ground_is_below_the_lowest_point() {
        let eye = DVec3::new(4.0, 1.0, 3.0);
        let upright = level(scene(eye, DVec3::Z)).unwrap();
        assert!((upright - 0.4).abs() < 1e-12, "{upright}");
        let aside = level(scene(eye, DVec3::Y)).unwrap();
        assert!((aside + 0.4).abs() < 1e-12, "{aside}");
        let mut lying = scene(eye, DVec3::Z);
        let about = DQuat::from_rotation_x(1.0);
        lying.objects[0].placement.rotation = about;
        let rim = about * DVec3::new(0.0, -0.4, 0.4);
        assert!((level(lying).unwrap() - rim.z).abs() < 1e-12);
        // A bevel of 0.1 moves the foot, at a height of 0.2, by 0.08. The scale along z is 2.
        let mut beveled = scene(eye, DVec3::Z);
        beveled.objects[0].offset.bevel = 0.1;
        assert!((level(beveled.clone()).unwrap() - 0.24).abs() < 1e-12);
        beveled.objects[0].clip = Clip::Box;
        assert!(level(beveled).unwrap().abs() < 1e-12);
        let mut replicas = scene(eye, DVec3::Z);
        replicas.objects[0].repeat = [1, 1, 3];
        assert!(level(replicas).unwrap().abs() < 1e-12);
    }

    #[test]
    fn an_eye_below_sees_no_ground() {
        assert_eq!(level(scene(DVec3::new(4.0, 1.0, 0.3), DVec3::Z)), None);
        let mut nothing = scene(DVec3::X, DVec3::Z);
        nothing.objects.clear();
        furnish(&mut nothing).unwrap();
        assert!(nothing.objects.is_empty());
    }
}
