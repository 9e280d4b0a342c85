//! How much of the picture a view's solids take: whole, or close up. Seen whole, a solid leaves
//! most of the picture empty, and what a frame costs anyhow weighs much in its time.

use crate::plan::view::{Framing, View};
use glam::{DQuat, DVec3};
use revmap::scene::{Camera, Light};

/// Close up, the boxes' rectangle is so many times as wide or high as a picture of 4:3.
pub const OVERFILL: f64 = 1.25;

/// The part of the picture's height that the boxes fill when seen whole.
const FILLED: f64 = 0.9;
/// Width over height of the narrowest picture that is drawn.
const NARROWEST: f64 = 4.0 / 3.0;

impl View {
    /// Points a camera at the boxes from `elevation` degrees above the horizon so that they fill
    /// nine tenths of the picture's height, as the papers' pictures do, and lights them from the
    /// front and the side.
    pub fn framed(mut self, elevation: f64) -> Self {
        let corners = self.corners();
        let count = corners.len().max(1) as f64;
        let middle = corners.iter().sum::<DVec3>() / count;
        let reach = corners.iter().map(|c| (*c - middle).length());
        let away = 4.0 * reach.fold(0.0, f64::max).max(1e-3);
        let eye = middle + DVec3::new(0.93, -0.37, 0.0) * away;
        let mut camera = Camera::new(eye, middle);
        camera.up = DVec3::Z;
        self.scene.camera = camera;
        let name = self.name.clone();
        let mut view = self.at_elevation(elevation);
        view.name = name;
        let widest = view.extent().map_or(1.0, |[left, right, low, high]| {
            let across = right.abs().max(left.abs()) / NARROWEST;
            across.max(high.abs()).max(low.abs())
        });
        view.scene.camera.fov_y = 2.0 * (widest / FILLED).atan().to_degrees();
        let forward = (view.scene.camera.target - view.scene.camera.eye).normalize();
        let turned = |degrees: f64| {
            DQuat::from_rotation_z(degrees.to_radians())
                * DVec3::new(forward.x, forward.y, 0.0).normalize_or(DVec3::X)
        };
        let light = |direction, color| Light {
            direction,
            color,
            ..Light::default()
        };
        let front = light(turned(35.0) - DVec3::Z * 0.8, [0.95, 0.9, 0.8]);
        let side = light(turned(-60.0) - DVec3::Z * 0.3, [0.2, 0.24, 0.3]);
        view.scene.lights = vec![front, side];
        view
    }

    /// The view in a framing. Close up the eye stays, turns to the middle of all boxes and narrows
    /// its field of view, which is never made wider; the name gets `:close`. An eye between or
    /// within the boxes is close already: its field of view stays.
    pub fn in_framing(mut self, framing: Framing) -> Self {
        if framing == Framing::Whole {
            return self;
        }
        self.name = format!("{}:{}", self.name, framing.name());
        self.framing = framing;
        let before = self.scene.camera;
        let corners = self.corners();
        let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let all = corners.iter().copied();
        let high = all.fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = (low + high) / 2.0;
        if middle.is_finite() && middle.distance(before.eye) > 1e-9 {
            self.scene.camera.target = middle;
        }
        match self.extent() {
            Some([left, right, low, high]) => {
                let half = ((right - left) / NARROWEST).min(high - low) / 2.0;
                let narrow = 2.0 * (half / OVERFILL).atan().to_degrees();
                if narrow > 1e-3 {
                    self.scene.camera.fov_y = narrow.min(before.fov_y);
                }
            }
            None => self.scene.camera = before,
        }
        self
    }

    /// The rectangle around all boxes at depth 1: left, right, low, high from the middle of the
    /// picture. `None` where a corner is not in front of the eye, or there is none.
    fn extent(&self) -> Option<[f64; 4]> {
        let Camera {
            eye, target, up, ..
        } = self.scene.camera;
        let forward = (target - eye).try_normalize()?;
        let right = forward.cross(up).try_normalize()?;
        let above = right.cross(forward);
        let mut extent = None;
        for corner in self.corners() {
            let way = corner - eye;
            let depth = way.dot(forward);
            if depth <= 1e-9 {
                return None;
            }
            let (x, y) = (way.dot(right) / depth, way.dot(above) / depth);
            let [l, r, b, t] = extent.unwrap_or([x, x, y, y]);
            extent = Some([x.min(l), x.max(r), y.min(b), y.max(t)]);
        }
        extent
    }

    /// The corners of all boxes, in the world.
    fn corners(&self) -> Vec<DVec3> {
        let mut all = Vec::new();
        for object in &self.scene.objects {
            let r = object.profile.radius;
            let sides = [(-r, -r), (r, -r), (-r, r), (r, r)];
            let corners = [0.0, 1.0].map(|z| sides.map(|(x, y)| DVec3::new(x, y, z)));
            for p in object.placements() {
                let corners = corners.as_flattened().iter();
                all.extend(corners.map(|c| p.position + p.rotation * (p.scale * *c)));
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::view::tests::spindle;
    use revmap::scene::CameraFrame;

    /// How far the boxes reach, as parts of half the picture: the most, and the mean of both sides.
    fn reach(view: &View) -> [(f64, f64); 2] {
        let frame = CameraFrame::new(&view.scene.camera, 400, 300).unwrap();
        [(frame.right, 200.0), (frame.up, 150.0)].map(|(axis, half)| {
            let at = |c: &DVec3| {
                let way = *c - frame.eye;
                way.dot(axis) / way.dot(frame.forward) / axis.length_squared() / half
            };
            let places: Vec<f64> = view.corners().iter().map(at).collect();
            let low = places.iter().copied().fold(f64::INFINITY, f64::min);
            let high = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (high.max(-low), (high - low) / 2.0)
        })
    }

    #[test]
    fn framing_fills_the_picture_and_close_up_the_box_reaches_past_it() {
        for elevation in [0.0, 25.0, 60.0] {
            let whole = spindle().framed(elevation);
            let [across, up] = reach(&whole);
            assert!((across.0.max(up.0) - FILLED).abs() < 0.01, "{elevation}");
            let close = whole.clone().in_framing(Framing::Close);
            let [across, up] = reach(&close);
            assert!((across.1.min(up.1) - OVERFILL).abs() < 1e-6);
            assert!(close.scene.camera.fov_y < whole.scene.camera.fov_y);
            assert_eq!(
                (&*close.name, close.framing),
                ("spindle:close", Framing::Close)
            );
            let same = whole.clone().in_framing(Framing::Whole);
            assert_eq!((&*same.name, same.framing), ("spindle", Framing::Whole));
            assert_eq!(same.scene.camera.fov_y, whole.scene.camera.fov_y);
        }
    }

    #[test]
    fn a_scene_off_the_middle_is_turned_to_and_one_all_around_is_left() {
        let mut aside = spindle();
        aside.scene.camera.target = DVec3::new(0.0, 1.5, 0.5);
        let close = aside.in_framing(Framing::Close);
        assert!((close.scene.camera.target - DVec3::new(0.0, 0.0, 0.5)).length() < 1e-9);
        assert!(reach(&close)[1].1 > 1.2);
        let mut within = spindle();
        within.scene.camera.eye = DVec3::new(0.2, 0.0, 0.5);
        let fov = within.scene.camera.fov_y;
        let target = within.scene.camera.target;
        let close = within.in_framing(Framing::Close).scene.camera;
        assert_eq!((close.fov_y, close.target), (fov, target));
        // A solid that is near enough already is not moved away from.
        let mut near = spindle();
        near.scene.camera.fov_y = 5.0;
        assert_eq!(near.in_framing(Framing::Close).scene.camera.fov_y, 5.0);
        let mut empty = spindle();
        empty.scene.objects.clear();
        let camera = empty.in_framing(Framing::Close).scene.camera;
        assert_eq!(camera.fov_y, spindle().scene.camera.fov_y);
    }

    /// The purpose of framings: the share of pixels that hit.
    #[test]
    fn close_up_most_pixels_hit() {
        use crate::plan::method::MethodSettings;
        use crate::plan::suite::{Extent, views};
        use revmap_reference as reference;
        for (width, height) in [(80, 60), (136, 70)] {
            let settings = MethodSettings::default().sized(width, height);
            for view in views(&Extent::UPRIGHT, &[0.0, 25.0, 60.0]).unwrap() {
                let [whole, close] = [Framing::Whole, Framing::Close].map(|framing| {
                    let scene = view.clone().in_framing(framing).scene;
                    let frame = reference::draw(&scene, &(&settings).into(), &|_, _| {});
                    let distance = frame.unwrap().distance;
                    let hits = distance.iter().filter(|d| d.is_finite()).count();
                    hits as f64 / distance.len() as f64
                });
                eprintln!("{} {width}x{height}: {whole:.3} {close:.3}", view.name);
                assert!((0.3..0.9).contains(&close) && close > 1.5 * whole);
            }
        }
    }
}
