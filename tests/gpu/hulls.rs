//! Hulls: cells in the fragment stage, lists of patches in compute, the default. They give the picture
//! that the tree of patches gives from the box's sides, both in the cases that they draw and in those
//! that they leave to the box. Searches on maps have none: `agreement.rs` compares their stages.

use crate::common::prelude::*;
use crate::common::ways::{WALKED, WRAPPED, Ways, apart, draw_by};
use revmap_compare::Spread;

/// Share of the pixels hit, beyond 2, that may differ: silhouettes of grazing rays.
///
/// Measured on lavapipe 22.3.6, over all views of this file: 1 pixel, of 38,661 of the torus from its
/// rim (`REVMAP_MEASURE=1` prints each view's). The bound allows for other devices' rounding.
const TOLERATED: f64 = 0.0005;

/// Settings that use proxies for solids of any size.
fn settings(solver: Solver, stage: DrawStage) -> Settings {
    drawn_by((320, 240), stage, solver).with(|s| s.proxy_min_pixels = 0)
}

/// The tree of patches from the box.
fn from_box() -> Settings {
    from_boxes(settings(Solver::Quadric, DrawStage::Fragment))
}

/// Compares both stages with the box. The normal of either face is right at a crease: 0.98 degrees rms
/// on the many creases of the discs from below (fragments), 0.54 elsewhere.
#[track_caller]
fn assert_same(name: &str, scene: &Scene, ways: Ways) {
    assert_near(name, scene, ways, (|spread| spread.rms, 1.0));
}

/// The same with a bounded statistic of the angles between normals, and its bound in degrees.
#[track_caller]
fn assert_near(name: &str, scene: &Scene, ways: Ways, normals: (fn(&Spread) -> f64, f64)) {
    let boxes = draw(scene, &from_box());
    for stage in STAGES {
        let frame = draw_by(name, scene, &settings(Solver::Exact, stage), ways);
        let (hits, edge, far) = apart(&boxes, &frame);
        assert!(hits > 500, "{name}, {stage:?}: only {hits} pixels are hit");
        let spread = errors(&boxes, &frame, 512).normal.unwrap();
        if std::env::var_os("REVMAP_MEASURE").is_some() {
            println!("{name}, {stage:?}: {edge} + {far} of {hits}, normals {spread:?}");
        }
        assert!(
            (edge + far) as f64 <= TOLERATED * hits as f64 + 2.0,
            "{name}, {stage:?}: of {hits} pixels {edge} are hit by one alone, {far} seen elsewhere"
        );
        let (of, most) = normals;
        assert!(of(&spread) < most, "{name}: normals {spread:?}");
    }
}

/// Undercuts, cavities, a torus, ridges: from below, level, above, and from straight above into
/// openings.
#[test]
fn every_shape_from_all_sides() {
    for (name, profile) in shapes::all() {
        for elevation in [-50.0, 0.0, 25.0, 60.0, 89.5] {
            let scene = scene_of(profile.clone(), eye(elevation, 2.2));
            assert_same(&format!("{name} at {elevation}"), &scene, WRAPPED);
        }
    }
}

/// A slider: the offset changes from frame to frame. It grows the hull, and may grow the solid past
/// its box, which then cuts it.
#[test]
fn offsets_in_motion() {
    for (name, profile) in shapes::all() {
        for (extend, bevel, chamfer) in [
            (-0.02, 0.0, 1.0),
            (0.03, 0.0, 1.0),
            (0.01, 0.2, 0.4),
            (0.0, 0.12, 1.0),
        ] {
            let mut scene = scene_of(profile.clone(), eye(20.0, 2.3));
            scene.objects[0].offset = offset(extend, bevel, chamfer);
            // The bevel moves a cone's foot out, past a box that cuts.
            if (name, bevel) == ("cone", 0.12) {
                scene.objects[0].clip = Clip::Box;
            }
            let name = format!("{name} with {extend} {bevel} {chamfer}");
            assert_same(&name, &scene, WRAPPED);
        }
    }
}

/// Solids cut by the sides of a turned and stretched box, with the axis in the box's middle or not.
/// Fragments of cells before a side draw the cut there; the box is drawn if the solid fills it.
#[test]
fn what_the_box_cuts() {
    // Each shape is cut in four ways, each way is seen from two of four sides.
    const SIDES: [f64; 4] = [-50.0, 0.0, 30.0, 89.5];
    for (n, (name, profile)) in shapes::all().into_iter().enumerate() {
        for (k, (extend, axis)) in [
            (0.0, [0.3, 0.62]),
            (0.12, [0.5, 0.5]),
            (0.25, [0.4, 0.5]),
            (0.5, [0.45, 0.55]),
        ]
        .into_iter()
        .enumerate()
        {
            let fills = profile.outline.bounds().unwrap().r_max + extend > 1.5 * profile.radius;
            let ways = if fills { WALKED } else { WRAPPED };
            for elevation in [SIDES[(n + k) % 4], SIDES[(n + k + 2) % 4]] {
                let mut scene = scene_of(profile.clone(), eye(elevation, 2.8));
                let object = &mut scene.objects[0];
                object.clip = Clip::Box;
                object.offset.extend = extend;
                object.axis = axis;
                object.placement = placement([0.1, -0.2, 0.05], [0.3, -0.2, 0.7], [1.1, 0.8, 0.9]);
                let name = format!("{name} with {extend} at {axis:?} from {elevation}");
                assert_same(&name, &scene, ways);
            }
        }
    }
}

/// The same for flat boxes, viewed along a side. One of the 1,474 pixels of the ridged column hits a
/// crease, where the normals of both faces are right and 103 degrees apart, so their 99th percentile
/// is bounded.
#[test]
fn what_a_flat_box_cuts_along_its_side() {
    for (name, profile) in shapes::all() {
        for (elevation, azimuth) in [(0.0, 0.52), (3.0, 0.02), (5.0, 0.8)] {
            let far = eye(elevation, 2.8);
            let mut scene = scene_of(profile.clone(), far);
            let out = far.truncate().length();
            let flat = glam::DVec2::from_angle(azimuth) * out;
            scene.camera.eye = flat.extend(far.z);
            let object = &mut scene.objects[0];
            object.clip = Clip::Box;
            object.offset.extend = 0.15;
            object.axis = [0.35, 0.5];
            object.placement = placement([0.0, 0.0, 0.3], [0.0; 3], [1.0, 1.0, 0.06]);
            let name = format!("{name} from {elevation}, {azimuth}");
            assert_near(&name, &scene, WRAPPED, (|spread| spread.p99, 0.1));
        }
    }
}

/// Eyes in the hull, in a cavity, in the solid, on the axis; near planes that cut it. An eye close
/// to a solid but outside all its shells counts as outside.
#[test]
fn eyes_anywhere() {
    for (name, profile) in [
        ("sphere", shapes::sphere()),
        ("glass", shapes::glass()),
        ("torus", shapes::torus()),
    ] {
        for (place, at) in [
            ("the middle", DVec3::new(0.02, 0.01, 0.5)),
            ("the axis", DVec3::new(0.0, 0.0, 0.9)),
            ("close to the surface", DVec3::new(0.505, 0.0, 0.5)),
            ("the rim", DVec3::new(0.3, 0.2, 0.98)),
        ] {
            let mut scene = scene_of(profile.clone(), at);
            scene.camera.target = DVec3::new(-0.3, 0.1, 0.45);
            let ways = match (name, place) {
                (_, "close to the surface" | "the rim") | ("torus", "the axis") => WRAPPED,
                _ => WALKED,
            };
            assert_same(&format!("{name} from {place}"), &scene, ways);
        }
    }
}

/// Distances from near to far, in compute: the rays of a tile may hit few patches, many, or more
/// than the longest list holds, which needs the tree walk. Pixels count tested patches as steps: a
/// list's length, or the patches visited in the tree.
#[test]
fn lists_of_every_length() {
    let lengths = [8.0, 16.0, 32.0, 48.0];
    let mut counted = [0usize; 5];
    for distance in [1.6, 2.4, 5.0, 8.0] {
        let scene = scene_of(shapes::discs(), eye(25.0, distance));
        assert_same(&format!("discs from {distance}"), &scene, WRAPPED);
        let settings = settings(Solver::Exact, DrawStage::Compute);
        let frame = draw_by("discs", &scene, &settings, WRAPPED);
        for (steps, _) in frame
            .steps
            .iter()
            .zip(&frame.distance)
            .filter(|(_, t)| t.is_finite())
        {
            let length = lengths.iter().position(|l| l == steps);
            counted[length.unwrap_or(4)] += 1;
        }
    }
    // Devices that run few invocations together walk the tree everywhere.
    let walked_alone = counted[..4].iter().sum::<usize>() < counted[4];
    let narrow = device().report().name.contains("SwiftShader");
    assert!(
        narrow && walked_alone || counted.iter().all(|&n| n > 0),
        "{counted:?}"
    );
}

/// A solid cut by its box, and replicas, which are left to the box.
#[test]
fn what_the_box_draws() {
    let mut cut = scene_of(shapes::vase(), eye(25.0, 2.4));
    cut.objects[0].axis = [0.8, 0.5];
    assert_same("cut by its box", &cut, WRAPPED);
    let mut replicas = scene_of(shapes::vase(), eye(25.0, 2.4));
    replicas.objects[0].repeat = [2, 2, 2];
    assert_same("replicas", &replicas, WALKED);
}

/// Maps give no bounds, and settings may select boxes; so may the size of a solid.
#[test]
fn where_there_is_none() {
    let scene = scene_of(shapes::sphere(), eye(25.0, 2.2));
    for stage in STAGES {
        let live = settings(Solver::Live, stage);
        let papers = live.with(|s| s.map_format = MapFormat::Rgba8);
        let boxes = from_boxes(settings(Solver::Exact, stage));
        for settings in [live, papers, boxes] {
            draw_by("boxes", &scene, &settings, WALKED);
        }
    }
    let profile = Profile::polygon(&[[0.0, 0.4], [0.3, 0.5], [0.0, 0.6]], 0.5).unwrap();
    let small = scene_of(profile, eye(25.0, 40.0));
    let small_enough = settings(Solver::Exact, DrawStage::Fragment)
        .with(|s| s.proxy_min_pixels = Settings::exact().proxy_min_pixels);
    draw_by("small", &small, &small_enough, WALKED);
}

/// The comparison detects a solid that is a fiftieth larger.
#[test]
fn a_wrong_solid_is_noticed() {
    let scene = scene_of(shapes::sphere(), eye(25.0, 2.2));
    let mut other = scene.clone();
    other.objects[0].offset.extend = 0.01;
    let hull = settings(Solver::Exact, DrawStage::Fragment);
    let frame = draw_by("another", &other, &hull, WRAPPED);
    let (hits, edge, far) = apart(&draw(&scene, &from_box()), &frame);
    assert!(edge + far > hits / 2, "{edge} + {far} of {hits}");
}

/// Several intersecting objects, some copied, in one depth buffer: hulls beside boxes.
#[test]
fn a_crowd_in_one_depth_buffer() {
    let mut crowd = circle_of_shapes(shapes::all());
    let mut ways = [Vec::new(), Vec::new()];
    for (n, object) in crowd.objects.iter_mut().enumerate() {
        let turn = n as f64 * 0.8;
        if n % 3 == 1 {
            let copy = placement([0.3, 0.2, 0.2], [turn, 0.0, 0.4], [0.5, 0.5, 0.9]);
            object.instances = vec![object.placement, copy].into();
        }
        // Copies too small for tiles of their own.
        if n == 4 {
            object.instances = (0..7)
                .map(|k| {
                    let turn = 0.9 * f64::from(k);
                    let at = [0.7 * turn.cos(), 0.7 * turn.sin(), 0.5];
                    placement(at, [0.0; 3], [0.1; 3])
                })
                .collect();
        }
        if n % 3 == 2 {
            object.repeat = [2, 1, 1];
        }
        ways[0].push([DrawPath::Cells, DrawPath::Cells, DrawPath::Box][n % 3]);
        ways[1].push(DrawPath::Walk);
    }
    assert_same("crowd", &crowd, ways.each_ref().map(Vec::as_slice));
}

/// Copies of a scene's only object hide one another, too. Rays walk to
/// more than 64.
#[test]
fn copies_of_a_lone_object() {
    let copies = |count: usize, size: f64| {
        let mut scene = scene_of(shapes::torus(), eye(35.0, 2.6));
        scene.objects[0].instances = (0..count)
            .map(|k| {
                let turn = 2.1 * k as f64;
                let place = [0.25 * turn.cos(), 0.25 * turn.sin(), 0.15 * turn % 0.5];
                placement(place, [0.3 * turn, 0.2, turn], [size; 3])
            })
            .collect();
        scene
    };
    let few = copies(3, 1.0);
    assert_same("three", &few, WRAPPED);
    assert_same("64", &copies(64, 0.7), WRAPPED);
    let crowd: [&[DrawPath]; 2] = [&[DrawPath::Walk], &[DrawPath::Walk]];
    assert_same("65", &copies(65, 0.7), crowd);
    let mut beside = few.clone();
    beside.objects[0].instances[0].position = DVec3::new(-3.7, 9.3, 0.0);
    assert_same("one beside the picture", &beside, WRAPPED);
}

/// A sliver of a solid, with almost nothing for a hull to wrap, and a plate of 1000:1.
#[test]
fn slivers() {
    let sliver = Profile::polygon(&[[0.0, 0.5], [0.45, 0.501], [0.0, 0.502]], 0.5).unwrap();
    let scene = scene_of(sliver, eye(35.0, 2.0));
    assert_same("sliver", &scene, WRAPPED);
    let width = 1000.0;
    let mut plate = scene_of(shapes::vase(), DVec3::new(1.5, 0.6, 0.6) * width);
    plate.objects[0].placement.scale = DVec3::new(width, width, 1.0);
    assert_same("plate", &plate, WRAPPED);
}

/// Level faces in the box's own faces, from afar and flattened: the start of a ray is least precise
/// here. Measured: at most 1 wrong pixel. A tree walk without slack for this misses 423 of 36,056
/// pixels; a hull without hits below the floor misses 276 of 15,044.
#[test]
fn faces_of_the_box_itself() {
    for (distance, flat) in [(5.0, 1.0), (100.0, 1.0), (20.0, 0.05), (100.0, 0.05)] {
        let mut scene = scene_of(shapes::column_of(0.4), eye(45.0, distance));
        scene.camera.fov_y = 2.0 * (0.6f64 / distance).atan().to_degrees();
        scene.camera.target = DVec3::new(0.0, 0.0, 0.5 * flat);
        scene.objects[0].placement.scale = DVec3::new(1.0, 1.0, flat);
        let truth = reference(&scene, &settings(Solver::Quadric, DrawStage::Fragment));
        for (solver, stage) in [
            (Solver::Quadric, DrawStage::Fragment),
            (Solver::Exact, DrawStage::Fragment),
            (Solver::Exact, DrawStage::Compute),
        ] {
            let settings = settings(solver, stage);
            let name = format!("{distance} away, scale {flat}: {solver}");
            let ways = match solver {
                Solver::Exact => WRAPPED,
                _ => WALKED,
            };
            let frame = draw_by(&name, &scene, &settings, ways);
            let found = errors(&truth, &frame, 512);
            let wrong = found.missed + found.ghost;
            assert!(found.hits > 5000, "only {} pixels are hit", found.hits);
            assert!(wrong <= found.hits / 500, "{name}, {stage:?}: {found}");
        }
    }
}
