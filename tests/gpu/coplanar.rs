//! Faces of several copies in one plane: the copy that comes first in the scene is seen over all of
//! the part that they share, whatever draws them.
#![allow(unsafe_code)]

use crate::common::host::{self, opened};
use crate::common::prelude::*;
use crate::common::random::Random;
use crate::embedding::{self, options};
use crate::speckles::{Picture, speckles};
use revmap_searches::SECANT;

pub const SIZE: (u32, u32) = (240, 180);

/// A plate of this radius between two heights.
fn plate(radius: f64, low: f64, high: f64) -> Arc<Profile> {
    let corners = [[0.0, low], [radius, low], [radius, high], [0.0, high]];
    Arc::new(Profile::polygon(&corners, 0.5).unwrap())
}

/// An object with one copy, of the colour `n`.
fn object(n: usize, profile: Arc<Profile>, placement: Placement) -> Object {
    let mut object = Object::new(format!("object {n}"), profile);
    let part = |by: f64| ((n as f64 * by).fract() * 0.8 + 0.1) as f32;
    object.color = [part(0.618), part(0.414), part(0.732)];
    object.placement = placement;
    object
}

/// A copy at a place, turned about its axis.
fn at(x: f64, y: f64, z: f64) -> Placement {
    placement([x, y, z], [0.0, 0.0, x + 2.0 * y], [1.0; 3])
}

fn scene(eye: DVec3, objects: Vec<Object>) -> Scene {
    let mut scene = Scene::new(Camera::new(eye, DVec3::new(0.0, 0.0, 0.3)));
    scene.objects = objects;
    scene
}

/// A disc inlaid in a plate. `first`: 0 if the plate is the first object, 1 if the disc is.
pub fn inlay(first: usize) -> Scene {
    let both = [plate(0.5, 0.0, 0.5), plate(0.25, 0.2, 0.5)];
    let objects = [0, 1].map(|n| object(n, both[(n + first) % 2].clone(), at(0.0, 0.0, 0.0)));
    scene(DVec3::new(2.0, -1.4, 1.8), objects.into())
}

/// Copies of one object whose tops are in one plane.
fn copies() -> Scene {
    let mut disc = object(0, plate(0.4, 0.1, 0.37), Placement::default());
    let places = [
        [0.0, 0.0],
        [0.31, 0.17],
        [-0.2, 0.33],
        [0.11, -0.29],
        [0.5, 0.47],
    ];
    disc.instances = places.map(|[x, y]| at(x, y, 0.013)).into_iter().collect();
    scene(eye(35.0, 2.4), vec![disc])
}

/// Plates of three objects with tops in one plane.
fn plates() -> Scene {
    let mut objects = vec![
        object(0, plate(0.45, 0.1, 0.4), at(0.0, 0.1, 0.0)),
        object(1, plate(0.3, 0.0, 0.7), at(0.3, 0.0, 0.05)),
        object(2, plate(0.5, 0.3, 0.35), at(0.1, -0.3, 0.05)),
    ];
    objects[1].placement.scale = DVec3::new(1.4, 1.1, 0.5);
    scene(eye(40.0, 2.2), objects)
}

fn each_placement(scene: &mut Scene, by: impl Fn(&mut Placement)) {
    for object in &mut scene.objects {
        by(&mut object.placement);
        object.instances.iter_mut().for_each(&by);
    }
}

/// The plates, much wider, from this height above their tops.
fn wide_plates(height: f64, away: f64) -> Scene {
    let mut all = plates();
    let wide = DVec3::new(12.0, 12.0, 1.0);
    each_placement(&mut all, |p| {
        (p.position, p.scale) = (p.position * wide, p.scale * wide)
    });
    all.camera = Camera::new(
        DVec3::new(away, 0.3, 0.4 + height),
        DVec3::new(0.0, 0.0, 0.38),
    );
    all
}

/// The same picture of a scene that is turned, scaled and moved as a whole.
fn moved(mut scene: Scene, turn: DQuat, scale: f64, to: DVec3) -> Scene {
    let place = |p: DVec3| turn * (scale * p) + to;
    each_placement(&mut scene, |p| {
        p.position = place(p.position);
        p.rotation = turn * p.rotation;
        p.scale *= scale;
    });
    let camera = &mut scene.camera;
    (camera.eye, camera.target) = (place(camera.eye), place(camera.target));
    camera.up = turn * camera.up;
    scene
}

fn tilted(scene: Scene) -> Scene {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 0.3));
    moved(scene, turn, 1.7, DVec3::new(0.1, 0.2, 0.0))
}

/// The same picture from `times` as far.
fn from_afar(mut scene: Scene, times: f64) -> Scene {
    let camera = &mut scene.camera;
    camera.eye = camera.target + times * (camera.eye - camera.target);
    let half = 0.5 * camera.fov_y.to_radians();
    camera.fov_y = 2.0 * (half.tan() / times).atan().to_degrees();
    scene
}

/// A far scene with a ball close to the eye, so that most depths are near the end of their range.
fn behind_a_ball(mut scene: Scene) -> Scene {
    let forward = (scene.camera.target - scene.camera.eye).normalize();
    let mut ball = object(5, shapes::sphere().into(), Placement::default());
    ball.placement.position = scene.camera.eye + 0.3 * forward + DVec3::new(0.0, 0.0, 0.001);
    ball.placement.scale = DVec3::splat(0.001);
    scene.objects.push(ball);
    scene
}

/// Settings that draw by cells or lists of patches, by boxes, and by what is chosen.
fn ways(settings: Settings) -> [Settings; 3] {
    let cells = Settings {
        proxy_min_pixels: 0,
        ..settings
    };
    [cells, from_boxes(settings), settings]
}

#[test]
fn the_first_copy_is_seen_in_both_stages() {
    let at_eye = |eye: [f64; 3]| plates().with(|scene| scene.camera.eye = eye.into());
    let far_off = DVec3::new(1234.5, -3456.7, 98.7);
    // Objects of other pipelines and textures: the third has those of the first.
    let map = color_map(2, 2, |x, y| [90 * (x + y) as u8, 200, 40, 255]);
    let textured = plates().with(|s| s.objects[1].texturing.color_map = Some(map));
    let replicas = textured.clone().with(|s| s.objects[1].repeat = [2, 1, 1]);
    let scenes = [
        ("a plate before its inlay", inlay(0), 600),
        ("an inlay before its plate", inlay(1), 600),
        ("copies of one object", copies(), 4000),
        ("plates", plates(), 3000),
        ("textured", textured, 3000),
        ("textured replicas", replicas, 2300),
        (
            "replicas",
            plates().with(|s| s.objects[0].repeat = [2, 2, 1]),
            3000,
        ),
        (
            "an offset",
            plates().with(|scene| {
                scene.objects[0].offset = offset(0.02, 0.0, 1.0);
                scene.objects[0].placement.position.z -= 0.02;
            }),
            3000,
        ),
        ("shadows", plates().with(|s| s.shadow = Shadow::Hard), 3000),
        ("tilted copies", tilted(copies()), 4000),
        ("tilted plates", tilted(plates()), 3000),
        (
            "plates far off",
            moved(plates(), DQuat::IDENTITY, 1.0, far_off),
            3000,
        ),
        ("a low eye", at_eye([2.1, 0.4, 0.55]), 150),
        ("a near eye", at_eye([0.3, 0.1, 0.45]), 2000),
        (
            "a wide lens",
            at_eye([0.6, 0.4, 0.6]).with(|s| s.camera.fov_y = 120.0),
            1000,
        ),
        ("a far eye", from_afar(plates(), 100.0), 2500),
        ("a very far eye", from_afar(tilted(copies()), 3000.0), 2400),
        (
            "behind a ball",
            behind_a_ball(from_afar(plates(), 40.0)),
            2500,
        ),
        ("wide plates", wide_plates(1.0, 9.0), 10_000),
        ("wide plates along", wide_plates(0.1, 9.0), 500),
        ("above wide plates", wide_plates(0.03, 4.0), 20_000),
        (
            "above tilted wide plates",
            tilted(wide_plates(0.3, 4.0)),
            20_000,
        ),
    ];
    let exact = scenes.map(|(name, scene, least)| (name, Solver::Exact, scene, least));
    // Searches that end at a distance from the surface are left out.
    let others = [Solver::Live, Solver::Quadric, SECANT].into_iter();
    let others = others.flat_map(|solver| {
        let shadows = plates().with(|s| s.shadow = Shadow::Hard);
        [inlay(1), tilted(copies()), plates(), shadows]
            .map(|scene| ("another search", solver, scene, 500))
    });
    let mut failures = Vec::new();
    for (name, solver, scene, least) in exact.into_iter().chain(others) {
        for stage in STAGES {
            for (way, settings) in ways(drawn_by(SIZE, stage, solver)).into_iter().enumerate() {
                let [shared, wrong] = speckles(&scene, |scene| draw(scene, &settings).into());
                let what = format!("{name}, {stage:?}, {solver}, way {way}: {wrong} of {shared}");
                println!("{what}");
                // Pixels that tell copies apart.
                if wrong > 0 || shared < least {
                    failures.push(what);
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Pairs of copies, of which each tile shows several, at levels of their own.
#[test]
fn the_first_copy_is_seen_in_a_crowd() {
    let mut disc = object(0, plate(0.4, 0.1, 0.37), Placement::default());
    let places = (0..66).map(|n| {
        [
            f64::from(n / 6) - 5.3,
            f64::from(n / 2 % 3) - 1.0,
            f64::from(n % 2),
        ]
    });
    let place =
        |[x, y, second]: [f64; 3]| at(1.2 * x + 0.31 * second, 1.1 * y + 0.2 * second, 0.013);
    disc.instances = places.map(place).collect();
    let scene = scene(DVec3::new(0.5, -7.0, 6.0), vec![disc]);
    let mut failures = Vec::new();
    for stage in STAGES {
        for tolerance in [Tolerance::EXACT, Tolerance::DEFAULT] {
            let settings = Settings {
                tolerance,
                ..drawn_by(SIZE, stage, Solver::Exact)
            };
            let [shared, wrong] = speckles(&scene, |scene| draw(scene, &settings).into());
            let paths = revmap_offscreen::draw(device(), &scene, &settings)
                .unwrap()
                .draw_paths;
            let what = format!("{stage:?}, {tolerance:?}: {wrong} of {shared}");
            println!("{what}");
            assert_eq!(paths, [DrawPath::Walk], "{what}");
            if wrong > 0 || shared < 1000 {
                failures.push(what);
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Groups of plates at random places, seen from random ones.
#[test]
fn the_first_copy_is_seen_of_random_groups() {
    let mut random = Random::of(23);
    let mut failures = Vec::new();
    let mut shared = 0;
    for n in 0..40 {
        let high = random.between(0.2, 0.9);
        let plates = (0..4).map(|k| {
            let scale = [0.0; 3].map(|_| random.between(0.4, 2.0));
            let top = random.between(0.3, 1.0);
            let low = random.between(0.0, 0.9 * top);
            let [x, y] = [0.0; 2].map(|_| random.between(-0.4, 0.4));
            let place = placement([x, y, high - top * scale[2]], [0.0, 0.0, 9.0 * x], scale);
            object(k, plate(random.between(0.2, 0.5), low, top), place)
        });
        let plates = plates.collect();
        let away = random.between(1.2, 4.0);
        let mut scene = scene(eye(random.between(5.0, 85.0), away), plates);
        scene.camera.fov_y = random.between(20.0, 90.0);
        let turn = DVec3::from([0.0; 3].map(|_| random.between(-2.0, 2.0)));
        let to = DVec3::from([0.0; 3].map(|_| random.between(-30.0, 30.0)));
        let scene = moved(
            scene,
            DQuat::from_scaled_axis(turn),
            random.between(0.1, 10.0),
            to,
        );
        let scene = from_afar(scene, random.between(0.0, 4.0).exp());
        for stage in STAGES {
            let settings = drawn_by(SIZE, stage, Solver::Exact);
            let [of, wrong] = speckles(&scene, |scene| draw(scene, &settings).into());
            shared += of;
            if wrong > 0 {
                failures.push(format!("group {n}, {stage:?}: {wrong} of {of}"));
            }
        }
    }
    println!("{shared} pixels");
    assert!(
        failures.is_empty() && shared > 100_000,
        "{shared} {failures:#?}"
    );
}

/// The reference tells such points as shaders do.
#[test]
fn the_reference_sees_the_first_copy() {
    let settings = drawn_by(SIZE, STAGES[0], Solver::Exact);
    for scene in [inlay(1), tilted(copies()), tilted(plates())] {
        let [shared, wrong] = speckles(&scene, |scene| reference(scene, &settings).into());
        println!("{wrong} of {shared}");
        assert!(wrong == 0 && shared > 500, "{wrong} of {shared}");
    }
}

/// A host's views of both orders of depths, without a far plane and with one.
#[test]
fn a_host_sees_the_first_copy() {
    let (host, device) = opened();
    for scene in [inlay(0), tilted(plates()), copies(), wide_plates(1.0, 9.0)] {
        for reversed in [false, true] {
            let options = options().with(|o| o.reversed = reversed);
            let camera = &scene.camera;
            let both = host::view_and_projection(camera.eye, camera.target, &options);
            let view = host::view(both, &options).unwrap();
            let drawn = |scene: &Scene| {
                let (bytes, depths) = embedding::drawn(&host, &device, options, scene, &view);
                let far = if reversed { 0.0 } else { 1.0 };
                let distance = |depth: f32| match depth == far {
                    true => f32::INFINITY,
                    false => view.t_at(f64::from(depth)) as f32,
                };
                let look = |c: &[u8]| [c[0], c[1], c[2], 0, 0].map(|byte| f32::from(byte) / 512.0);
                Picture {
                    distances: depths.into_iter().map(distance).collect(),
                    looks: bytes.chunks_exact(4).map(look).collect(),
                }
            };
            let [shared, wrong] = speckles(&scene, drawn);
            println!("reversed {reversed}: {wrong} of {shared}");
            // Copies of one object look alike here.
            assert!(wrong == 0, "reversed {reversed}: {wrong} of {shared}");
            assert!(
                shared > 500 || scene.objects.len() == 1,
                "reversed {reversed}: {shared}"
            );
        }
    }
}
