//! The search for live parameters where something tells its rays where to begin: convex hulls in the fragment stage, beams in compute. They
//! draw what the same search draws from the box's sides.

use crate::common::ways::{BOXED, STAGES, WRAPPED, Ways, apart, draw_by};
use crate::common::{draw, eye, placement, scene_of, shapes};
use glam::DVec3;
use revmap::frame::Frame;
use revmap::gpu::DrawPath;
use revmap::maps::MapFormat;
use revmap::profile::Profile;
use revmap::scene::{Offset, Scene, Shadow};
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_lab::compare::{CompareOptions, compare};

fn settings(stage: DrawStage, hull_from: u32) -> Settings {
    Settings {
        width: 320,
        height: 240,
        solver: Solver::Live,
        stage,
        hull_from,
        ..Settings::default()
    }
}

/// Share of the pixels hit, beyond 2, that may differ: rays that begin elsewhere take other steps, of which each may pass a chord of a
/// texel. Measured on lavapipe 22.3.6, over all views of this file: 2 pixels (`REVMAP_MEASURE=1` prints each view's).
const TOLERATED: f64 = 0.0002;

/// Angle between normals, degrees, 99th percentile. Measured: 0.04 at most, on the glass that is thinned.
const NORMALS: f64 = 0.1;

/// How many pixels two frames differ in, of how many that are hit.
fn differing(boxes: &Frame, frame: &Frame) -> (usize, usize) {
    let (hits, edge, far) = apart(boxes, frame);
    (edge + far, hits)
}

#[track_caller]
fn assert_same(name: &str, scene: &Scene, ways: Ways) {
    let boxes = draw(scene, &settings(DrawStage::Fragment, u32::MAX));
    for stage in STAGES {
        let frame = draw_by(name, scene, &settings(stage, 0), ways);
        let (differ, hits) = differing(&boxes, &frame);
        assert!(hits > 500, "{name}: only {hits} pixels are hit");
        let compared = compare(&boxes, &frame, &CompareOptions::default()).unwrap();
        let normal = compared.normal.unwrap();
        if std::env::var_os("REVMAP_MEASURE").is_some() {
            println!("{name}, {stage:?}: {differ} of {hits}, normals {normal:?}");
        }
        assert!(
            differ as f64 <= TOLERATED * hits as f64 + 2.0,
            "{name}, {stage:?}: {differ} of {hits} pixels differ"
        );
        assert!(
            normal.p99 < NORMALS,
            "{name}, {stage:?}: normals {normal:?}"
        );
    }
}

/// Cavities and undercuts lie in the convex hull and are searched as ever.
#[test]
fn every_shape_from_all_sides() {
    for (name, profile) in shapes::all() {
        for elevation in [-50.0, 0.0, 25.0, 89.5] {
            let scene = scene_of(profile.clone(), eye(elevation, 2.2));
            assert_same(&format!("{name} at {elevation}"), &scene, WRAPPED);
        }
    }
}

/// Offsets grow the hull, and may grow the solid past its box, which then cuts it.
#[test]
fn offsets_in_motion() {
    for (name, profile) in shapes::all() {
        for (extend, bevel, chamfer) in [
            (-0.02, 0.0, 1.0),
            (0.03, 0.0, 1.0),
            (0.2, 0.0, 1.0),
            (0.01, 0.2, 0.4),
        ] {
            let mut scene = scene_of(profile.clone(), eye(20.0, 2.3));
            scene.objects[0].offset = Offset {
                extend,
                bevel,
                chamfer,
            };
            let name = format!("{name} with {extend} {bevel} {chamfer}");
            assert_same(&name, &scene, WRAPPED);
        }
    }
}

/// What box and search do as before: a solid cut by its box; turned and flattened ones; copies that pass through one another; coarse
/// maps, whose texels are as large as their solid's parts; shadows, whose rays begin on the solid.
#[test]
fn all_that_the_box_draws() {
    let mut all: Vec<(&str, Scene, Ways)> = Vec::new();
    let mut cut = scene_of(shapes::vase(), eye(25.0, 2.4));
    cut.objects[0].axis = [0.8, 0.5];
    all.push(("cut by its box", cut, WRAPPED));
    let mut flat = scene_of(shapes::jewel(), eye(35.0, 2.6));
    flat.objects[0].placement = placement([0.1, 0.2, 0.3], [0.7, -0.4, 1.1], [1.5, 0.5, 0.8]);
    all.push(("flattened", flat, WRAPPED));
    let mut copies = scene_of(shapes::torus(), eye(35.0, 2.6));
    copies.objects[0].instances = (0..3)
        .map(|k| {
            let turn = 2.1 * f64::from(k);
            let place = [0.25 * turn.cos(), 0.25 * turn.sin(), 0.1 * turn];
            placement(place, [0.3 * turn, 0.2, turn], [1.0; 3])
        })
        .collect();
    all.push(("copies", copies, WRAPPED));
    let mut coarse = scene_of(shapes::glass(), eye(25.0, 2.4));
    coarse.objects[0].map_rows = 24;
    all.push(("coarse", coarse, WRAPPED));
    for (name, shadow) in [
        ("hard shadows", Shadow::Hard),
        ("soft shadows", Shadow::Soft),
    ] {
        let mut lit = scene_of(shapes::vase(), eye(40.0, 2.4));
        lit.shadow = shadow;
        all.push((name, lit, WRAPPED));
    }
    // Grown through the box's ceiling, which is seen at two degrees: on lavapipe right without the hull's margin, too.
    let drum = Profile::polygon(&[[0.0, 0.1], [0.3, 0.1], [0.3, 0.9], [0.0, 0.9]], 0.5).unwrap();
    let mut ceiling = scene_of(drum, eye(15.0, 2.2));
    ceiling.objects[0].offset.extend = 0.15;
    all.push(("cut by the ceiling", ceiling.clone(), WRAPPED));
    ceiling.camera.eye.z = 1.08;
    all.push(("along the ceiling", ceiling, WRAPPED));
    // What grows into the box from outside is in no texel.
    let points = [[0.0, -0.5], [0.4, -0.5], [0.4, -0.05], [0.0, -0.05]];
    let mut below = scene_of(Profile::polygon(&points, 0.5).unwrap(), eye(25.0, 2.2));
    below.objects[0].offset.extend = 0.15;
    all.push(("from below its box", below, BOXED));
    let mut replicas = scene_of(shapes::vase(), eye(25.0, 2.4));
    replicas.objects[0].repeat = [2, 2, 2];
    all.push(("replicas", replicas, BOXED));
    for (name, scene, ways) in all {
        assert_same(name, &scene, ways);
    }
}

/// Eyes in the hull are the box's affair; beams take them all.
#[test]
fn eyes_anywhere() {
    const BEAMED: Ways<'static> = [&[DrawPath::Box], &[DrawPath::Beams]];
    for (name, profile) in [
        ("sphere", shapes::sphere()),
        ("glass", shapes::glass()),
        ("torus", shapes::torus()),
    ] {
        for (place, at) in [
            ("the middle", DVec3::new(0.02, 0.01, 0.5)),
            ("the axis", DVec3::new(0.0, 0.0, 0.9)),
            ("the box's edge", DVec3::new(0.47, 0.46, 0.5)),
        ] {
            let mut scene = scene_of(profile.clone(), at);
            scene.camera.target = DVec3::new(-0.3, 0.1, 0.45);
            let ways = if place == "the box's edge" {
                WRAPPED
            } else {
                BEAMED
            };
            assert_same(&format!("{name} from {place}"), &scene, ways);
        }
    }
}

/// From afar roundings of `t` are as large as texels.
#[test]
fn from_afar() {
    for distance in [20.0, 400.0] {
        let mut scene = scene_of(shapes::vase(), eye(30.0, distance));
        scene.camera.fov_y = 2.0 * (0.6f64 / distance).atan().to_degrees();
        assert_same(&format!("{distance} away"), &scene, WRAPPED);
    }
}

/// Eight bits bound nothing, and settings may ask for boxes.
#[test]
fn where_there_is_none() {
    let scene = scene_of(shapes::sphere(), eye(25.0, 2.2));
    for stage in STAGES {
        let papers = Settings {
            map_format: MapFormat::Rgba8,
            ..settings(stage, 0)
        };
        draw_by("8 bits", &scene, &papers, BOXED);
        draw_by("boxes", &scene, &settings(stage, u32::MAX), BOXED);
        let default = Settings {
            solver: Solver::Hull,
            ..settings(stage, u32::MAX)
        };
        draw_by("boxes by default", &scene, &default, BOXED);
    }
    let profile = Profile::polygon(&[[0.0, 0.4], [0.3, 0.5], [0.0, 0.6]], 0.5).unwrap();
    let small = scene_of(profile, eye(25.0, 40.0));
    let small_enough = settings(DrawStage::Fragment, Settings::default().hull_from);
    draw_by("small", &small, &small_enough, BOXED);
}

/// The comparison notices rays that begin a twentieth of the solid's height too late.
#[test]
fn a_hull_that_is_too_small_is_noticed() {
    let scene = scene_of(shapes::sphere(), eye(25.0, 2.2));
    let boxes = draw(&scene, &settings(DrawStage::Fragment, u32::MAX));
    let mut smaller = scene.clone();
    smaller.objects[0].offset.extend = -0.05;
    let frame = draw_by(
        "smaller",
        &smaller,
        &settings(DrawStage::Fragment, 0),
        WRAPPED,
    );
    let (differ, hits) = differing(&boxes, &frame);
    assert!(differ as f64 > 0.5 * hits as f64, "{differ} of {hits}");
}
