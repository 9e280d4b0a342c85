//! A renderer from update to update: a failed update leaves nothing half done, and unchanged parts
//! are not made again.

use crate::common::prelude::*;
use revmap_searches::CONE;

fn settings(stage: DrawStage) -> Settings {
    Settings {
        proxy_min_pixels: 0, // a proxy for solids of any size
        ..drawn_by((160, 120), stage, Solver::DEFAULT)
    }
}

fn vase() -> Scene {
    scene_of(shapes::vase(), eye(25.0, 2.2))
}

/// A change refused before any work leaves the previous frame, to the last bit.
#[test]
fn what_is_refused_changes_nothing() {
    type Case = (&'static str, Solver, fn(&mut Scene));
    let cases: [Case; 6] = [
        ("up", Solver::Exact, |s| {
            s.camera.up = s.camera.target - s.camera.eye;
        }),
        ("lights", Solver::Exact, |s| {
            s.lights = vec![s.lights[0]; 9];
        }),
        ("NaN", Solver::Exact, |s| {
            s.objects.push(s.objects[0].clone());
            s.objects[1].offset.extend = f64::NAN;
        }),
        ("bevel", Solver::Exact, |s| {
            s.objects[0].offset.bevel = f64::INFINITY
        }),
        ("repeat", Solver::Exact, |s| {
            s.objects[0].repeat = [10_000, 1, 1]
        }),
        // Two more instances, all without cones.
        ("single-valued", CONE, |s| {
            s.objects[0].instances = vec![placement([0.0; 3], [0.0; 3], [1.0; 3]); 3].into();
            s.objects[0].profile = shapes::glass().into();
            s.objects.push(s.objects[0].clone());
        }),
    ];
    for stage in STAGES {
        for (word, solver, spoil) in cases {
            let settings = settings(stage).with(|s| s.solver = solver);
            let scene = vase();
            let mut renderer = Offscreen::new(device(), &scene, &settings).unwrap();
            let before = next_frame(&mut renderer);
            let mut spoilt = scene.clone();
            spoilt.background = [1.0; 4];
            spoilt.camera.eye.x += 0.3;
            spoil(&mut spoilt);
            let error = renderer.update(&spoilt).unwrap_err().to_string();
            assert!(error.contains(word), "{word}: {error}");
            let after = next_frame(&mut renderer);
            assert_eq!(before.first_difference(&after), None, "{word}");
        }
    }
    device().check().unwrap();
}

/// A binary map of a solid thinner than a texel is empty, which is detected only when it is baked.
/// The renderer continues to draw the previous frame.
#[test]
fn a_map_that_cannot_be_baked_changes_nothing() {
    let thin = Profile::polygon(&[[0.3, 0.5], [0.301, 0.5], [0.3, 0.501]], 0.5).unwrap();
    for stage in STAGES {
        let settings = Settings {
            map_source: Some(revmap_files::BINARY),
            solver: Solver::Live,
            ..settings(stage)
        };
        let mut scene = vase();
        let mut renderer = Offscreen::new(device(), &scene, &settings).unwrap();
        let before = next_frame(&mut renderer);
        scene.objects[0].profile = thin.clone().into();
        let error = renderer.update(&scene).unwrap_err();
        assert_eq!(error.kind, ErrorKind::Content, "{error}");
        let after = next_frame(&mut renderer);
        assert_eq!(before.first_difference(&after), None);
        scene.objects[0].profile = shapes::glass().into();
        let mended = updated(&mut renderer, &scene);
        let fresh = draw(&scene, &settings);
        assert_eq!(fresh.first_difference(&mended), None);
        assert!((0..fresh.pixels()).any(|i| fresh.hits(i)));
    }
    device().check().unwrap();
}

/// A vase, a second equal vase, and a sphere, side by side.
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

/// Contours are cut only for changes, once for each profile and offset. Kept parts are drawn like
/// new ones.
#[test]
fn only_what_has_changed_is_cut() {
    for (solver, stage) in [
        (Solver::Exact, DrawStage::Fragment),
        (Solver::Exact, DrawStage::Compute),
        (Solver::Quadric, DrawStage::Fragment),
        (CONE, DrawStage::Fragment),
        (Solver::Live, DrawStage::Fragment),
    ] {
        let settings = settings(stage).with(|s| s.solver = solver);
        let mut scene = three();
        let mut renderer = Offscreen::new(device(), &scene, &settings).unwrap();
        let mut check = |scene: &Scene, cuts: u64, what: &str| {
            renderer.update(scene).unwrap();
            let cuts = if solver.reads_map() { 0 } else { cuts };
            let found = renderer.renderer().rebuild_count();
            assert_eq!(found, cuts, "{solver}, {stage:?}: {what}");
            let way = match (solver, stage) {
                (Solver::Exact, DrawStage::Fragment) => DrawPath::Cells,
                (_, DrawStage::Fragment) => DrawPath::Box,
                (_, DrawStage::Compute) => DrawPath::Walk,
            };
            assert_eq!(
                renderer.renderer().draw_paths(),
                [way; 3],
                "{solver}: {what}"
            );
            let fresh = draw(scene, &settings);
            let kept = next_frame(&mut renderer);
            assert_eq!(fresh.first_difference(&kept), None, "{solver}: {what}");
        };
        check(&scene, 2, "two profiles");
        scene.camera.eye.x += 0.2;
        check(&scene, 2, "the camera");
        scene.objects[1].placement.position.z = 0.1;
        scene.lights.clear();
        check(&scene, 2, "a placement and lights");
        scene.objects[1].offset.extend = 0.02;
        check(&scene, 3, "one offset");
        scene.camera.eye.x += 0.2;
        check(&scene, 3, "the camera again");
        scene.objects[1].offset.extend = 0.0;
        check(&scene, 3, "as its twin");
        check(&scene, 3, "until frames in flight are done");
        scene.objects[1].offset.extend = 0.02;
        check(&scene, 4, "what was forgotten");
        scene.objects[2].offset.extend = 0.02;
        check(&scene, 5, "the other profile");
        // The two objects exchange places.
        scene.objects.swap(1, 2);
        check(&scene, 5, "their order");
        // Solids out of view are left to the rasteriser, or have no rectangle of tiles.
        for object in &mut scene.objects {
            object.placement.position.x += 100.0;
        }
        renderer.update(&scene).unwrap();
        let frame = next_frame(&mut renderer);
        assert!((0..frame.pixels()).all(|i| !frame.hits(i)));
    }
    device().check().unwrap();
}
