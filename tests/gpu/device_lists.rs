//! Tiles of crowds that the device lists show what the host's lists show.

use crate::common::ways::STAGES;
use crate::common::{device, next_frame, placement, scene_of, shapes, updated};
use crate::crowds::{VIEWS, army, assert_same_bits, by_tree, draw, seen};
use glam::DVec3;
use revmap::frame::Frame;
use revmap::maps::ColorMap;
use revmap::scene::Object;
use revmap::settings::{Settings, Solver, Tolerance};
use revmap_lab::compare::pixel_errors;
use revmap_offscreen::Offscreen;
use std::sync::Arc;

fn map() -> Arc<ColorMap> {
    let texel = |n: u32| [(n * 37 % 256) as u8, (n * 91 % 256) as u8, 120, 255];
    Arc::new(ColorMap::from_texels(16, 8, (0..128).map(texel).collect()).unwrap())
}

fn listed(settings: Settings) -> Settings {
    Settings {
        device_lists: true,
        ..settings
    }
}

/// Pictures are equal bit for bit, in either stage, with and without culling.
#[test]
fn the_device_lists_what_the_host_lists() {
    for (name, scene) in seen(&army(700)) {
        for stage in STAGES {
            let wanted = draw(&scene, &by_tree(stage, true));
            for cull in [true, false] {
                let found = draw(&scene, &listed(by_tree(stage, cull)));
                assert_same_bits(&found, &wanted, &format!("{name}: {stage:?}, {cull}"));
            }
        }
    }
    device().check().unwrap();
}

/// Each copy has a level of its own: the error stays below the tolerance, culling hides nothing of
/// a coarse copy, and the device chooses as the host does.
#[test]
fn copies_have_levels_of_their_own() {
    for (name, scene) in seen(&army(700)) {
        for stage in STAGES {
            let levelled = |cull| Settings {
                tolerance: Tolerance::DEFAULT,
                ..by_tree(stage, cull)
            };
            let exact = draw(&scene, &by_tree(stage, true));
            let found = draw(&scene, &levelled(true));
            let what = format!("{name}: {stage:?}");
            assert_same_bits(&draw(&scene, &levelled(false)), &found, &what);
            for cull in [true, false] {
                assert_same_bits(&draw(&scene, &listed(levelled(cull))), &found, &what);
            }
            let errors = pixel_errors(&scene, &exact, &found).unwrap();
            println!("{what}: {errors:?}");
            let tolerance = Tolerance::DEFAULT.pixels();
            assert!(errors.p999 <= tolerance && errors.contour_max <= tolerance / 16.0 + 0.01);
            assert_ne!(
                exact.distance, found.distance,
                "{what}: all copies are exact"
            );
        }
    }
    device().check().unwrap();
}

/// The only object is in uniform buffers, with the tables of all levels of its copies. Two objects
/// of one look are in storage buffers.
#[test]
fn levels_of_the_only_object_have_equal_bits() {
    let mut army = army(700);
    army.objects = vec![army.objects.swap_remove(1)];
    for (name, one) in seen(&army) {
        let mut two = one.clone();
        let (first, rest) = one.objects[0].instances.split_at(100);
        two.objects.push(one.objects[0].clone());
        two.objects[0].instances = first.to_vec().into();
        two.objects[1].instances = rest.to_vec().into();
        for stage in STAGES {
            let tree = Settings {
                tolerance: Tolerance::DEFAULT,
                ..by_tree(stage, true)
            };
            let lists = Settings {
                solver: Solver::Exact,
                proxy_min_pixels: 0,
                ..tree
            };
            for settings in [tree, lists] {
                let what = format!("{name}: {stage:?}, {:?}", settings.solver);
                assert_same_bits(&draw(&one, &settings), &draw(&two, &settings), &what);
            }
        }
    }
    device().check().unwrap();
}

/// Copies beside other solids, turned and scaled, off their axis and with a bump: two layers of
/// crowds, and objects that the host lists.
#[test]
fn crowds_stand_among_other_solids() {
    let mut scene = army(200);
    scene.objects[1].axis = [0.45, 0.52];
    scene.objects[2].texturing.color_map = Some(map());
    let mut large = Object::new("large", Arc::new(shapes::vase()));
    large.placement = placement([3.0, 3.0, 0.0], [0.2, 0.1, 0.0], [2.0, 1.5, 2.0]);
    scene.objects.push(large);
    (scene.camera.eye, scene.camera.target) = (VIEWS[1].1, VIEWS[1].2);
    for stage in STAGES {
        let offscreen = |settings: &Settings| {
            next_frame(&mut Offscreen::new(device(), &scene, settings).unwrap())
        };
        let settings = by_tree(stage, true);
        let (found, wanted) = (offscreen(&listed(settings)), offscreen(&settings));
        let bits = |d: &[f32]| d.iter().map(|d| d.to_bits()).collect::<Vec<_>>();
        assert!(bits(&found.distance) == bits(&wanted.distance), "{stage:?}");
        // Fragments with maps are compiled from other modules, which round in other places.
        let pairs = || found.color.iter().zip(&wanted.color);
        let apart = |(a, b): (&[f32; 4], &[f32; 4])| {
            (0..4).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max)
        };
        let most = pairs().map(apart).fold(0.0, f32::max);
        assert!(most < 1e-4, "{stage:?}: {most}");
    }
    device().check().unwrap();
}

/// The picture of a view does not depend on the frames before it.
#[test]
fn frames_before_change_nothing() {
    let mut scene = army(400);
    for stage in STAGES {
        let settings = listed(by_tree(stage, true));
        let mut offscreen = Offscreen::new(device(), &scene, &settings).unwrap();
        let mut first: Vec<Frame> = Vec::new();
        for n in [0, 1, 2, 3, 1, 0, 3, 2] {
            (scene.camera.eye, scene.camera.target) = (VIEWS[n].1, VIEWS[n].2);
            let frame = updated(&mut offscreen, &scene);
            match first.get(n) {
                Some(before) => assert_same_bits(&frame, before, VIEWS[n].0),
                None => first.push(frame),
            }
        }
    }
    device().check().unwrap();
}

/// Copies that move, come and go are shown where they are.
#[test]
fn copies_move_come_and_go() {
    let mut scene = army(100);
    (scene.camera.eye, scene.camera.target) = (VIEWS[1].1, VIEWS[1].2);
    for stage in STAGES {
        let settings = listed(by_tree(stage, true));
        let mut offscreen = Offscreen::new(device(), &scene, &settings).unwrap();
        offscreen.draw().unwrap();
        for count in [100, 300, 70] {
            let mut moved = army(count);
            moved.camera = scene.camera;
            for (n, copy) in moved.objects[0].instances.iter_mut().enumerate() {
                copy.position += DVec3::new(0.3, 0.1, 0.01 * n as f64);
            }
            let wanted = draw(&moved, &by_tree(stage, true));
            assert_same_bits(
                &updated(&mut offscreen, &moved),
                &wanted,
                &format!("{count}"),
            );
        }
    }
    device().check().unwrap();
}

/// Number of tiles of 8 x 8 pixels in which a pixel is hit.
fn tiles_with_hits(frame: &Frame) -> usize {
    let hits = (0..).zip(&frame.distance).filter(|(_, d)| d.is_finite());
    let tiles = hits.map(|(n, _): (u32, _)| (n % frame.width / 8, n / frame.width / 8));
    tiles.collect::<std::collections::BTreeSet<_>>().len()
}

/// More entries than there is room for: all copies are searched in every pixel.
#[test]
fn full_lists_lose_nothing() {
    let mut scene = scene_of(shapes::vase(), DVec3::new(12.0, 0.0, 1.0));
    scene.camera.target = DVec3::new(0.0, 0.0, 0.5);
    // The farthest first.
    let place = |n: u32| {
        let part = f64::from(n) / 400.0;
        let at = [7.0 * part, 0.5 * part - 0.25, 0.0];
        placement(at, [0.0; 3], [0.02, 4.0, 4.0])
    };
    scene.objects[0].instances = (0..400).map(place).collect();
    let mut other = Object::new("other", Arc::new(shapes::cone()));
    other.texturing.color_map = Some(map());
    other.instances = (0..80)
        .map(|n| placement([7.5, 0.01 * f64::from(n) + 0.4, 0.4], [0.0; 3], [0.3; 3]))
        .collect();
    scene.objects.push(other);
    for stage in STAGES {
        let small = |settings: Settings| Settings {
            width: 96,
            height: 64,
            ..settings
        };
        // Without culling, each copy is listed in all tiles that it covers.
        let mut least = scene.clone();
        least.objects.truncate(1);
        least.objects[0].instances = vec![place(0)].into();
        let entries = 400 * tiles_with_hits(&draw(&least, &small(by_tree(stage, true))));
        let room = 16 * 2 * (12 * 8) + 2 * 480;
        assert!(entries > room, "{stage:?}: {entries}: no list is full");
        let wanted = draw(&scene, &small(by_tree(stage, true)));
        let found = draw(&scene, &small(listed(by_tree(stage, false))));
        assert_same_bits(&found, &wanted, &format!("{stage:?}"));
    }
    device().check().unwrap();
}
