//! Faces of several copies in one plane: the copy that comes first in the scene is seen over all of
//! the part that they share, whatever draws them.
//!
//! Each copy is also drawn alone. Those pictures give the copies that share a point, and the look of
//! the first one. Pixels beside a contour are left out.

use crate::common::ways::STAGES;
use crate::common::{draw, drawn_by, eye, from_boxes, offset, placement, shapes};
use glam::{DQuat, DVec3};
use revmap::frame::Frame;
use revmap::maps::ColorMap;
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Placement, Scene, Shadow};
use revmap::settings::{DrawStage, Settings, Solver};
use std::sync::Arc;

const SIZE: (u32, u32) = (240, 180);
/// Two distances this near to each other, as a part of them, are those of one point.
const TOGETHER: f32 = 2e-5;

/// A plate of this radius between two heights.
fn plate(radius: f64, low: f64, high: f64) -> Arc<Profile> {
    let corners = [[0.0, low], [radius, low], [radius, high], [0.0, high]];
    Arc::new(Profile::polygon(&corners, 0.5).unwrap())
}

/// An object with one copy, of the color `n`.
fn object(n: usize, profile: Arc<Profile>, placement: Placement) -> Object {
    let mut object = Object::new(format!("object {n}"), profile);
    let part = |by: f64| ((n as f64 * by).fract() * 0.8 + 0.1) as f32;
    object.color = [part(0.618), part(0.414), part(0.732)];
    object.placement = placement;
    object
}

fn at(x: f64, y: f64, z: f64) -> Placement {
    placement([x, y, z], [0.0, 0.0, x + 2.0 * y], [1.0; 3])
}

fn scene(camera: DVec3, objects: Vec<Object>) -> Scene {
    let mut scene = Scene::new(Camera::new(camera, DVec3::new(0.0, 0.0, 0.3)));
    scene.lights.push(Default::default());
    scene.objects = objects;
    scene
}

/// A disc inlaid in a plate, in this order if `first` is 0, else in the other one.
fn inlay(first: usize) -> Scene {
    let both = [plate(0.5, 0.0, 0.5), plate(0.25, 0.2, 0.5)];
    let objects = [0, 1].map(|n| object(n, both[(n + first) % 2].clone(), at(0.0, 0.0, 0.0)));
    scene(DVec3::new(2.0, -1.4, 1.8), objects.into())
}

/// Copies of one object whose tops and bottoms are in two planes.
fn copies() -> Scene {
    let mut disc = object(0, plate(0.4, 0.1, 0.37), Placement::default());
    disc.instances = [[0.0, 0.0], [0.31, 0.17], [-0.2, 0.33], [0.11, -0.29], [0.5, 0.47]]
        .map(|[x, y]| at(x, y, 0.013))
        .into_iter()
        .collect();
    scene(eye(35.0, 2.4), vec![disc])
}

/// Plates of three objects, of different profiles and scales, with tops in one plane.
fn plates() -> Scene {
    let mut objects = vec![
        object(0, plate(0.45, 0.1, 0.4), at(0.0, 0.1, 0.0)),
        object(1, plate(0.3, 0.0, 0.7), at(0.3, 0.0, -0.3)),
        object(2, plate(0.5, 0.3, 0.35), at(0.1, -0.3, 0.05)),
    ];
    // Half as high, and as much higher.
    objects[1].placement.scale = DVec3::new(1.4, 1.1, 0.5);
    objects[1].placement.position.z = 0.4 - 0.35;
    scene(eye(40.0, 2.2), objects)
}

/// A scene that is turned, stretched and moved as a whole.
fn tilted(mut scene: Scene) -> Scene {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 0.3));
    let by = |p: &mut Placement| {
        p.position = turn * (1.7 * p.position) + DVec3::new(0.1, 0.2, 0.0);
        p.rotation = turn * p.rotation;
        p.scale *= 1.7;
    };
    for object in &mut scene.objects {
        by(&mut object.placement);
        object.instances.iter_mut().for_each(by);
    }
    scene.camera.eye *= 1.6;
    scene
}

/// The same picture from `times` as far.
fn from_afar(mut scene: Scene, times: f64) -> Scene {
    let camera = &mut scene.camera;
    camera.eye = camera.target + times * (camera.eye - camera.target);
    let half = 0.5 * camera.fov_y.to_radians();
    camera.fov_y = 2.0 * (half.tan() / times).atan().to_degrees();
    scene
}

/// The scene with one copy only.
fn alone(all: &Scene, object: usize, copy: usize) -> Scene {
    let mut one = all.clone();
    one.objects = vec![all.objects[object].clone()];
    one.objects[0].placement = all.objects[object].placements()[copy];
    one.objects[0].instances = Vec::new().into();
    one
}

/// A copy drawn alone.
struct Alone {
    frame: Frame,
}

impl Alone {
    fn all(scene: &Scene, settings: &Settings) -> Vec<Self> {
        let copies = scene.objects.iter().map(|o| o.placements().len());
        let each = copies.enumerate().flat_map(|(n, count)| (0..count).map(move |k| (n, k)));
        each.map(|(n, k)| Self {
            frame: draw(&alone(scene, n, k), settings),
        })
        .collect()
    }

    /// True if a pixel of a picture shows this copy, as far as its look tells.
    fn is_in(&self, frame: &Frame, pixel: usize) -> bool {
        let [a, b] = [&self.frame, frame].map(|f| (f.albedo[pixel], f.uv[pixel]));
        let turn = |d: f32| (d - d.round()).abs();
        let same_color = (0..3).all(|k| (a.0[k] - b.0[k]).abs() < 1e-3);
        same_color && (0..2).all(|k| turn(a.1[k] - b.1[k]) < 2e-3)
    }
}

/// The copies that share the nearest point of a pixel, as bits.
fn nearest(all: &[Alone], pixel: usize) -> u64 {
    let distance = |one: &Alone| one.frame.distance[pixel];
    let least = all.iter().map(distance).fold(f32::INFINITY, f32::min);
    let shares = |one: &Alone| distance(one) <= least * (1.0 + TOGETHER) && least.is_finite();
    (0..).zip(all).map(|(k, one)| u64::from(shares(one)) << k).sum()
}

/// Counts pixels of shared parts that tell two copies apart, and those among them that do not show the
/// first copy.
fn speckles(scene: &Scene, settings: &Settings) -> [usize; 2] {
    let frame = draw(scene, settings);
    let all = Alone::all(scene, settings);
    let (width, height) = (settings.width as usize, settings.height as usize);
    let sets: Vec<u64> = (0..width * height).map(|p| nearest(&all, p)).collect();
    let mut counts = [0; 2];
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let pixel = y * width + x;
            let set = sets[pixel];
            let around = |p: usize| (p - 1..=p + 1).all(|p| sets[p] == set);
            if set.count_ones() < 2 || ![pixel - width, pixel, pixel + width].into_iter().all(around) {
                continue;
            }
            let first = &all[set.trailing_zeros() as usize];
            let is_other = |k: usize| set >> k & 1 == 1 && !all[k].is_in(&first.frame, pixel);
            if (0..all.len()).any(is_other) {
                counts[0] += 1;
                counts[1] += usize::from(!first.is_in(&frame, pixel));
            }
        }
    }
    counts
}

/// Settings that draw by cells or lists, by boxes, and as chosen.
fn ways(settings: Settings) -> [(&'static str, Settings); 3] {
    let cells = Settings {
        proxy_min_pixels: 0,
        ..settings
    };
    [("cells", cells), ("boxes", from_boxes(settings)), ("chosen", settings)]
}

fn textured(mut scene: Scene) -> Scene {
    let texel = |k: u32| image::Rgb([(k * 90) as u8, 200, 40]);
    let picture = image::RgbImage::from_fn(2, 2, |x, y| texel(x + y));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("colors.png");
    picture.save(&path).unwrap();
    let map: Arc<ColorMap> = Arc::new(revmap_files::color_map(&path).unwrap());
    scene.objects[1].texturing.color_map = Some(map);
    scene
}

#[test]
fn sweep() {
    let mut repeated = plates();
    repeated.objects[0].repeat = [2, 2, 1];
    let mut extended = plates();
    extended.objects[0].offset = offset(0.02, 0.0, 1.0);
    extended.objects[0].placement.position.z -= 0.02;
    let mut shadowed = plates();
    shadowed.shadow = Shadow::Hard;
    let mut low = plates();
    low.camera.eye = DVec3::new(2.1, 0.4, 0.55);
    let mut lower = plates();
    lower.camera.eye = DVec3::new(2.1, 0.4, 0.42);
    let mut close = plates();
    close.camera.eye = DVec3::new(0.3, 0.1, 0.45);
    close.camera.target = DVec3::new(-0.1, 0.0, 0.4);
    let scenes = [
        ("inlay", inlay(0)),
        ("inlay, reversed", inlay(1)),
        ("copies", copies()),
        ("plates", plates()),
        ("repeated", repeated),
        ("extended", extended),
        ("low", low),
        ("lower", lower),
        ("close", close),
        ("shadowed", shadowed),
        ("textured", textured(plates())),
        ("tilted copies", tilted(copies())),
        ("tilted plates", tilted(plates())),
        ("far plates", from_afar(plates(), 100.0)),
        ("very far", from_afar(tilted(copies()), 3000.0)),
    ];
    for (name, scene) in scenes {
        for stage in STAGES {
            for (way, settings) in ways(drawn_by(SIZE, stage, Solver::Exact)) {
                println!("{name} {stage:?} {way}: {:?}", speckles(&scene, &settings));
            }
            let solvers = [Solver::Live, revmap_searches::CIRCLE, revmap_searches::SECANT];
            for solver in solvers.into_iter().filter(|_| std::env::var("MAPS").is_ok()) {
                let settings = drawn_by(SIZE, stage, solver);
                println!("{name} {stage:?} {solver}: {:?}", speckles(&scene, &settings));
            }
        }
    }
    let _ = (shapes::cone(), DrawStage::Compute);
}
