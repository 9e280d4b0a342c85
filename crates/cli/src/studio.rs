//! `--studio`: a ground, lights, a background and a camera for what is drawn without a scene of its
//! own.

use glam::{DQuat, DVec3};
use revmap::error::Result;
use revmap::frame::srgb_from_linear;
use revmap::maps::{ColorMap, Projection};
use revmap::profile::Profile;
use revmap::scene::{Camera, Environment, Light, Object, Placement, Scene, Shadow};
use revmap_files::scene::Extent;
use std::sync::Arc;

/// Linear RGB of the ground under the objects, and of the background.
const GROUND: [f32; 3] = [0.70, 0.69, 0.67];
const BACKGROUND: [f32; 3] = [0.46, 0.46, 0.45];
/// The part of the light of the sky above that a white ground sends back.
const BOUNCE: f32 = 0.6;
/// The name of the ground's object.
pub const GROUND_NAME: &str = "ground of --studio";
/// Texels across the ground.
const TEXELS: u32 = 512;
/// The ground's radius, diagonals of the objects' box; and the part of it in which the ground's
/// colour turns into that of the background.
const RADIUS: f64 = 3.0;
const FADE: [f64; 2] = [0.15, 0.95];
/// Vertical field of view, degrees, of a camera that is chosen.
const FOV_Y: f64 = 26.0;
/// The part of the picture's height, or width, that the objects fill.
const FILLED: f64 = 0.8;

/// A studio. It is made once for all frames, which share its ground.
pub struct Studio {
    ground: Option<Object>,
    background: [f32; 4],
    /// The camera for the first frame, if it is not the scene's own.
    camera: Option<Camera>,
}

impl Studio {
    /// A studio with these linear colours: the ground's, and the background's with alpha. A ground
    /// that has no colour has the background's. There is none before a transparent background.
    pub fn new(ground: Option<[f32; 3]>, background: Option<[f32; 4]>) -> Result<Self> {
        let default = [BACKGROUND[0], BACKGROUND[1], BACKGROUND[2], 1.0];
        let behind = background.unwrap_or(default);
        let [r, g, b, alpha] = behind;
        let ground = ground.unwrap_or(match background {
            Some(_) => [r, g, b],
            None => GROUND,
        });
        let ground = match alpha < 1.0 {
            true => None,
            false => Some(disc(ground, [r, g, b])?),
        };
        Ok(Self {
            ground,
            background: behind,
            camera: None,
        })
    }

    /// Chooses a camera that looks the same way as that of the first scene, and in whose pictures
    /// of `aspect` (width over height) the objects of all `scenes` are within [`FILLED`] of both
    /// sides. Each scene is seen once the camera has turned about its target by an angle, radians.
    pub fn frame(&mut self, scenes: &[(Scene, f64)], aspect: f64) {
        let Some((first, _)) = scenes.first() else {
            return;
        };
        let [ahead, right, up] = directions(&first.camera);
        let sight = (first.camera.target - first.camera.eye).normalize_or(ahead);
        let above = right.cross(sight);
        let all: Vec<_> = scenes
            .iter()
            .map(|(s, angle)| (extents(s), *angle))
            .collect();
        let middle = |axis| 0.5 * (farthest(&all[0].0, axis) - farthest(&all[0].0, -axis));
        let middle = DVec3::from(DVec3::AXES.map(middle));
        let high = FILLED * (0.5 * FOV_Y).to_radians().tan();
        // A plane through the eye, with this slope to the sight, is beyond all objects if the eye's
        // coordinate along its normal is at least theirs.
        let beyond = |side: DVec3, slope: f64| {
            let normal = side - slope * sight;
            let reach = |(extents, angle): &(Vec<_>, f64)| {
                let normal = DQuat::from_axis_angle(up, *angle) * normal;
                farthest(extents, normal) - middle.dot(normal)
            };
            all.iter().map(reach).fold(f64::NEG_INFINITY, f64::max)
        };
        let wide = high * aspect;
        let [at_right, at_left] = [right, -right].map(|side| beyond(side, wide));
        let [at_top, at_bottom] = [above, -above].map(|side| beyond(side, high));
        // A turn is about a target in the middle.
        let aside = match scenes.iter().any(|(_, angle)| *angle != 0.0) {
            true => 0.0,
            false => 0.5 * (at_right - at_left),
        };
        let across = (at_right - aside).max(at_left + aside) / wide;
        let away = across.max((at_top + at_bottom) / (2.0 * high));
        let upwards = 0.5 * (at_top - at_bottom);
        let eye = middle + aside * right + upwards * above - away * sight;
        let along = sight.dot(ahead);
        let target = eye + sight * ((middle - eye).dot(ahead) / along);
        if eye.is_finite() && target.is_finite() && away > 0.0 {
            self.camera = Some(Camera {
                fov_y: FOV_Y,
                eye,
                target,
                ..first.camera
            });
        }
    }

    /// Gives the scene the camera that was chosen for all frames, if one was.
    pub fn place_camera(&self, scene: &mut Scene) {
        scene.camera = self.camera.unwrap_or(scene.camera);
    }

    /// Replaces lights, shadows and background of a scene, and puts a ground below its objects.
    /// The lights stay with the camera. The sky has what they lack to white above, and light of the
    /// ground's colour below. The ground reflects as much light as reaches it, so it has its own
    /// colour, and that of the background at its rim.
    pub fn furnish(&self, scene: &mut Scene) {
        let [ahead, right, up] = directions(&scene.camera);
        let light = |[x, y, z]: [f64; 3], color, radius| Light {
            direction: (x * right + y * ahead + z * up).normalize(),
            color,
            radius,
        };
        scene.lights = vec![
            // The key from the upper left, and the rim from behind.
            light([0.62, 0.5, -0.9], [0.76, 0.73, 0.68], 7.0),
            light([-0.85, -0.75, -0.3], [1.0; 3], 10.0),
        ];
        scene.shadow = Shadow::Soft;
        scene.background = self.background;
        let above = [0, 1, 2].map(|c| 1.0 - lit(&scene.lights, up, c));
        let below = self.ground.as_ref().map_or(GROUND, |ground| ground.color);
        let below = [0, 1, 2].map(|c| BOUNCE * below[c] * above[c]);
        let sky = sky_along(up, above, below);
        let level = sky.sky(up);
        scene.ambient = [0, 1, 2].map(|c| (above[c] - level[c] as f32).max(0.0));
        scene.environment = Some(sky);
        scene.objects.extend(self.ground_below(scene, up));
    }

    /// The ground below the lowest point of the objects. None where nothing is drawn, or where the
    /// eye is below it.
    fn ground_below(&self, scene: &Scene, up: DVec3) -> Option<Object> {
        let extents = extents(scene);
        let farthest = |axis: DVec3| farthest(&extents, axis);
        let high = DVec3::from(DVec3::AXES.map(farthest));
        let low = -DVec3::from(DVec3::AXES.map(|axis| farthest(-axis)));
        let lowest = -farthest(-up);
        let radius = RADIUS * (high - low).length();
        if !radius.is_finite() || radius == 0.0 || scene.camera.eye.dot(up) <= lowest {
            return None;
        }
        let mut ground = self.ground.clone()?;
        let scale = DVec3::new(radius, radius, 1e-3 * radius);
        let middle = 0.5 * (low + high);
        ground.placement = Placement {
            position: middle + up * (lowest - scale.z - middle.dot(up)),
            rotation: DQuat::from_rotation_arc(DVec3::Z, up),
            scale,
        };
        Some(ground)
    }
}

/// Horizontally ahead, right, and up.
fn directions(camera: &Camera) -> [DVec3; 3] {
    let up = camera.up.normalize_or(DVec3::Z);
    let sight = camera.target - camera.eye;
    let level = sight - up * sight.dot(up);
    let ahead = level.normalize_or(up.any_orthonormal_vector());
    [ahead, ahead.cross(up), up]
}

/// An environment that has two colours above and below where `up` is the world's. It has less of a
/// difference between them the more `up` is level.
fn sky_along(up: DVec3, above: [f32; 3], below: [f32; 3]) -> Environment {
    let part = 0.5 + 0.5 * up.z as f32;
    let mix = |part: f32| [0, 1, 2].map(|c| below[c] + part * (above[c] - below[c]));
    Environment {
        up: mix(part),
        down: mix(1.0 - part),
    }
}

/// The light that falls onto the ground, of channel `c`: all of the lights' discs are above it.
fn lit(lights: &[Light], up: DVec3, c: usize) -> f32 {
    let of_light = |light: &Light| {
        let height = 1.0 - light.radius.to_radians().cos();
        light.color[c] * (-light.direction.dot(up) * (1.0 - 0.5 * height)) as f32
    };
    lights.iter().map(of_light).sum()
}

/// A disc of radius 1 that has the color `inner` in its middle and `outer` at its rim.
fn disc(inner: [f32; 3], outer: [f32; 3]) -> Result<Object> {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut disc = Object::new(GROUND_NAME, Arc::new(Profile::polygon(&square, 1.0)?));
    disc.color = inner;
    disc.specular.strength = 0.0;
    if inner != outer {
        let code = |v: f32| (srgb_from_linear(f64::from(v)) * 255.0).round() as u8;
        let texel = |n: u32| {
            let at = |n: u32| (2.0 * f64::from(n) + 1.0) / f64::from(TEXELS) - 1.0;
            let away = at(n % TEXELS).hypot(at(n / TEXELS));
            let part = ((away - FADE[0]) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
            let part = (part * part * (3.0 - 2.0 * part)) as f32;
            let [r, g, b] = [0, 1, 2].map(|c| code(inner[c] + part * (outer[c] - inner[c])));
            [r, g, b, u8::MAX]
        };
        let texels = (0..TEXELS * TEXELS).map(texel).collect();
        let map = ColorMap::from_texels(TEXELS, TEXELS, texels)?;
        disc.texturing.color_map = Some(Arc::new(map));
        disc.texturing.projection = Projection::Planar;
    }
    Ok(disc)
}

fn extents(scene: &Scene) -> Vec<(&Object, Extent<'_>)> {
    let objects = scene.objects.iter();
    objects.map(|o| (o, Extent::of(o))).collect()
}

/// The largest coordinate of any copy along an axis.
fn farthest(extents: &[(&Object, Extent)], axis: DVec3) -> f64 {
    let copies = extents.iter().flat_map(|(object, extent)| {
        let places = object.placements().iter();
        places.map(move |place| extent.reach(place, axis))
    });
    copies.fold(f64::NEG_INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn scene(eye: DVec3, up: DVec3) -> Scene {
        let corners = [[0.0, 0.2], [0.4, 0.2], [0.1, 0.9], [0.0, 0.9]];
        let cone = Object::new("cone", Arc::new(Profile::polygon(&corners, 0.5).unwrap()));
        let mut scene = Scene::new(Camera {
            up,
            ..Camera::new(eye, DVec3::ZERO)
        });
        scene.objects = vec![cone];
        scene
    }

    /// The height of the ground's upper face along the camera's upward direction.
    fn level(mut scene: Scene) -> Option<f64> {
        Studio::new(None, None).unwrap().furnish(&mut scene);
        scene.check().unwrap();
        let ground = scene.objects.get(1)?;
        let place = &ground.placement;
        let top = place.position + place.rotation * (place.scale.z * DVec3::Z);
        Some(top.dot(scene.camera.up))
    }

    #[test]
    fn the_ground_is_below_the_lowest_point() {
        let eye = DVec3::new(4.0, 1.0, 3.0);
        for (up, wanted) in [(DVec3::Z, 0.2), (DVec3::Y, -0.4), (DVec3::X, -0.4)] {
            let found = level(scene(eye, up)).unwrap();
            assert!((found - wanted).abs() < 1e-9, "{up}: {found}");
        }
    }

    #[test]
    fn an_eye_below_sees_no_ground() {
        assert_eq!(level(scene(DVec3::new(4.0, 1.0, 0.1), DVec3::Z)), None);
        let mut nothing = scene(DVec3::X, DVec3::Z);
        nothing.objects.clear();
        Studio::new(None, None).unwrap().furnish(&mut nothing);
        assert!(nothing.objects.is_empty());
    }

    /// A plane that faces up reflects all light: it is seen in its own colour.
    #[test]
    fn the_ground_has_its_own_colour() {
        for up in [DVec3::Z, DVec3::Y, DVec3::new(0.6, 0.0, -0.8)] {
            let mut lit_scene = scene(DVec3::new(4.0, 1.0, 3.0), up);
            Studio::new(None, None).unwrap().furnish(&mut lit_scene);
            let sky = lit_scene.environment.unwrap();
            let [above, below] = [up, -up].map(|side| sky.sky(side));
            for c in 0..3 {
                let around = lit_scene.ambient[c] + above[c] as f32;
                let all = around + lit(&lit_scene.lights, up, c);
                assert!((all - 1.0).abs() < 1e-6 && around > 0.1, "{up} {c}: {all}");
                assert!(below[c] <= above[c], "{up} {c}: {below:?} {above:?}");
            }
        }
    }

    /// All sides of a lying thing that turns touch the frame at some angle, and none passes it.
    #[test]
    fn what_turns_stays_in_the_frame() {
        let mut lying = scene(DVec3::new(3.0, 1.0, 1.2), DVec3::Z);
        lying.objects[0].placement.rotation = DQuat::from_rotation_x(1.5);
        lying.objects[0].placement.position = DVec3::new(3.0, -2.0, 1.0);
        let angles = (0..24).map(|n| f64::from(n) * std::f64::consts::TAU / 24.0);
        let scenes: Vec<_> = angles.map(|angle| (lying.clone(), angle)).collect();
        let mut studio = Studio::new(None, None).unwrap();
        studio.frame(&scenes, 2.0);
        let camera = studio.camera.unwrap();
        let (mut widest, mut highest) = (0.0f64, 0.0f64);
        for (scene, angle) in &scenes {
            let about = DQuat::from_rotation_z(*angle);
            let eye = camera.target + about * (camera.eye - camera.target);
            let frame =
                revmap::scene::CameraFrame::new(&Camera { eye, ..camera }, 200, 100).unwrap();
            let (object, place) = (&scene.objects[0], &scene.objects[0].placement);
            for n in 0..360 {
                let turn = DQuat::from_rotation_z(f64::from(n).to_radians());
                for corner in object.profile.outline.loops[0].iter() {
                    let at = place.position
                        + place.rotation * (turn * DVec3::new(corner.x, 0.0, corner.y));
                    let away = at - eye;
                    let depth = away.dot(frame.forward);
                    let along = |axis: DVec3| away.dot(axis) / depth / axis.length_squared();
                    widest = widest.max(along(frame.right).abs() / 100.0);
                    highest = highest.max(along(frame.up).abs() / 50.0);
                }
            }
        }
        assert!(
            widest < FILLED + 1e-6 && highest < FILLED + 1e-6,
            "{widest} {highest}"
        );
        assert!(widest.max(highest) > FILLED - 0.02, "{widest} {highest}");
    }
}
