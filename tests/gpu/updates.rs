//! A renderer from update to update: what fails leaves nothing half done, and nothing is made again that has not changed.

use crate::common::{device, draw, eye, placement, scene_of, shapes};
use revmap::error::Stage;
use revmap::frame::Frame;
use revmap::gpu::{Renderer, Way};
use revmap::maps::MapSource;
use revmap::profile::{Profile, Shape};
use revmap::scene::{Object, Scene, Shadow};
use revmap::settings::{DrawStage, Settings, Solver};

const STAGES: [DrawStage; 2] = [DrawStage::Fragment, DrawStage::Compute];

fn settings(stage: DrawStage) -> Settings {
    Settings {
        width: 160,
        height: 120,
        hull_from: 0, // however small
        stage,
        ..Settings::default()
    }
}

fn drawn(renderer: &mut Renderer) -> Frame {
    renderer.draw().unwrap();
    renderer.read().unwrap()
}

fn vase() -> Scene {
    scene_of(shapes::vase(), eye(25.0, 2.2))
}

/// What is refused before anything is touched: the frame before is drawn on, to the last bit.
#[test]
fn what_is_refused_changes_nothing() {
    let mesh = Solver::mesh(32, 64).unwrap();
    type Case = (&'static str, Solver, fn(&mut Scene));
    let cases: [Case; 6] = [
        ("instances", Solver::Hull, |s| {
            s.objects[0].instances = vec![placement([0.0; 3], [0.0; 3], [1.0; 3]); 3];
        }),
        ("objects", Solver::Hull, |s| {
            s.objects.push(s.objects[0].clone());
        }),
        ("up", Solver::Hull, |s| {
            s.camera.up = s.camera.target - s.camera.eye;
        }),
        ("lights", Solver::Hull, |s| {
            s.lights = vec![s.lights[0]; 9];
        }),
        ("not what the renderer", Solver::Hull, |s| {
            s.objects[0].profile = shapes::glass().into();
        }),
        ("box", mesh, |s| s.objects[0].offset.extend = 0.3),
    ];
    for stage in STAGES {
        for (word, solver, spoil) in cases {
            if solver.is_mesh() && stage == DrawStage::Compute {
                continue;
            }
            let settings = Settings {
                solver,
                ..settings(stage)
            };
            let scene = vase();
            let mut renderer = Renderer::new(device(), &scene, &settings).unwrap();
            let before = drawn(&mut renderer);
            let mut spoilt = scene.clone();
            spoilt.background = [1.0; 4];
            spoilt.camera.eye.x += 0.3;
            spoil(&mut spoilt);
            let error = renderer.update(&spoilt).unwrap_err().to_string();
            assert!(error.contains(word), "{word}: {error}");
            let after = drawn(&mut renderer);
            assert_eq!(before.first_difference(&after), None, "{word}");
        }
    }
    device().check().unwrap();
}

/// A soft shadow wants a map; an exact one is not to be had of a picture, which shows only when it is baked.
#[test]
fn what_fails_half_way_is_not_drawn() {
    let vase = shapes::vase();
    let Shape::Outline(outline) = &vase.shape else {
        unreachable!()
    };
    let picture = Profile {
        shape: Shape::Raster(outline.rasterize(128, 256)),
        radius: 0.5,
    };
    for stage in STAGES {
        let settings = Settings {
            map_source: Some(MapSource::Exact),
            ..settings(stage)
        };
        let mut scene = scene_of(picture.clone(), eye(25.0, 2.2));
        let mut renderer = Renderer::new(device(), &scene, &settings).unwrap();
        renderer.draw().unwrap();
        scene.shadow = Shadow::Soft;
        let error = renderer.update(&scene).unwrap_err();
        assert_eq!(error.stage, Stage::Map, "{error}");
        let refused = [renderer.draw().err(), renderer.read().err()];
        for error in refused.map(Option::unwrap) {
            assert_eq!(error.stage, Stage::Draw);
            assert!(error.message.contains("update"), "{error}");
        }
        // And again, until one succeeds.
        renderer.update(&scene).unwrap_err();
        renderer.draw().unwrap_err();
        scene.shadow = Shadow::Off;
        scene.objects[0].offset.extend = 0.02;
        renderer.update(&scene).unwrap();
        let mended = drawn(&mut renderer);
        let fresh = draw(&scene, &settings);
        assert_eq!(fresh.first_difference(&mended), None);
        assert!((0..fresh.pixels()).any(|i| fresh.hits(i)));
    }
    device().check().unwrap();
}

/// A vase, the same again, and a sphere, side by side.
fn three() -> Scene {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 4.0));
    let twin = scene.objects[0].clone();
    let ball = Object::new("ball", shapes::sphere().into());
    scene.objects.extend([twin, ball]);
    for (object, y) in scene.objects.iter_mut().zip([-0.9, 0.0, 0.9]) {
        object.placement.position.y = y;
    }
    scene
}

/// Contours are cut for what has changed, once for each profile and offset; and what is kept is drawn like what is new.
#[test]
fn only_what_has_changed_is_cut() {
    let mesh = Solver::mesh(24, 48).unwrap();
    for (solver, stage) in [
        (Solver::Hull, DrawStage::Fragment),
        (Solver::Hull, DrawStage::Compute),
        (Solver::Quadric, DrawStage::Fragment),
        (Solver::Cone, DrawStage::Fragment),
        (mesh, DrawStage::Fragment),
        (Solver::Live, DrawStage::Fragment),
    ] {
        let settings = Settings {
            solver,
            ..settings(stage)
        };
        let mut scene = three();
        let mut renderer = Renderer::new(device(), &scene, &settings).unwrap();
        let mut updated = |scene: &Scene, cuts: u64, what: &str| {
            renderer.update(scene).unwrap();
            let cuts = if solver.reads_map() { 0 } else { cuts };
            assert_eq!(renderer.cuts(), cuts, "{solver}, {stage:?}: {what}");
            let way = match (solver, stage) {
                (Solver::Hull | Solver::Live, DrawStage::Fragment) => Way::Hull,
                (Solver::Hull, _) => Way::Beams,
                (Solver::Mesh { .. }, _) => Way::Mesh,
                _ => Way::Box,
            };
            assert_eq!(renderer.ways(), [way; 3], "{solver}: {what}");
            let fresh = draw(scene, &settings);
            let kept = drawn(&mut renderer);
            assert_eq!(fresh.first_difference(&kept), None, "{solver}: {what}");
        };
        updated(&scene, 2, "two profiles");
        scene.camera.eye.x += 0.2;
        updated(&scene, 2, "the camera");
        scene.objects[1].placement.position.z = 0.1;
        scene.lights.clear();
        updated(&scene, 2, "a placement and lights");
        scene.objects[1].offset.extend = 0.02;
        updated(&scene, 3, "one offset");
        scene.camera.eye.x += 0.2;
        updated(&scene, 3, "the camera again");
        scene.objects[1].offset.extend = 0.0;
        updated(&scene, 3, "as its twin");
        scene.objects[1].offset.extend = 0.02;
        updated(&scene, 4, "what was forgotten");
        scene.objects[2].offset.extend = 0.02;
        updated(&scene, 5, "the other profile");
        // Each takes the other's place.
        scene.objects.swap(1, 2);
        updated(&scene, 5, "their order");
        // What is not seen is left to the rasteriser, and not traced.
        for object in &mut scene.objects {
            object.placement.position.x += 100.0;
        }
        renderer.update(&scene).unwrap();
        let none = [Way::Nothing; 3];
        assert_eq!(renderer.ways() == none, stage == DrawStage::Compute);
        let frame = drawn(&mut renderer);
        assert!((0..frame.pixels()).all(|i| !frame.hits(i)));
    }
    device().check().unwrap();
}
