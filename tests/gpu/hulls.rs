//! Rays that begin elsewhere than at the box, or search only a part of a solid: cells in the
//! fragment stage, tiles in compute. They give the picture that the same search gives from the
//! box's sides, both in the cases that they draw and in those that they leave to the box.

use crate::common::prelude::*;
use crate::common::ways::{WALKED, WRAPPED, Ways, apart, draw_by};
use revmap_compare::Spread;

/// A search with its hulls and beams, and the equivalent search from the box.
pub struct Search {
    pub solver: Solver,
    from_box: Solver,
    /// Share of the pixels hit, beyond 2, that may differ.
    tolerated: f64,
    /// The bounded statistic of the angles between normals, and its bound in degrees.
    normals: (fn(&Spread) -> f64, f64),
}

/// The default: hulls of the exact boundary. Silhouettes of grazing rays may differ, and the normal
/// of either face is right at a crease.
///
/// Measured on lavapipe 22.3.6, over all views of this file and of `proxy_hulls.rs`: 1 pixel, of
/// 38,661 of the torus from its rim; normals 0.98 degrees rms on the many creases of the discs from
/// below (fragments), 0.54 elsewhere. The bound on pixels allows for other devices' rounding.
pub const EXACT: Search = Search {
    solver: Solver::Exact,
    from_box: Solver::Quadric,
    tolerated: 0.0005,
    normals: (|spread| spread.rms, 1.0),
};

/// The search for live parameters, in tiles. Rays that begin elsewhere take other steps, and each
/// step may pass a chord of a texel.
///
/// Measured on lavapipe 22.3.6, over all views of this file: 2 pixels (`REVMAP_MEASURE=1` prints
/// each view's); normals 0.04 degrees (p99) at most, on the thinned glass.
const LIVE: Search = Search {
    solver: Solver::Live,
    from_box: Solver::Live,
    tolerated: 0.0002,
    normals: (|spread| spread.p99, 0.1),
};

/// Settings that use proxies for solids of any size.
pub fn settings(solver: Solver, stage: DrawStage) -> Settings {
    drawn_by((320, 240), stage, solver).with(|s| s.proxy_min_pixels = 0)
}

impl Search {
    /// Compares both stages with the box.
    #[track_caller]
    pub fn assert_same(&self, name: &str, scene: &Scene, ways: Ways) {
        // A map has no cells.
        let ways = match self.solver {
            Solver::Exact => ways,
            _ => WALKED,
        };
        let from_box = from_boxes(settings(self.from_box, DrawStage::Fragment));
        let boxes = draw(scene, &from_box);
        for stage in STAGES {
            let frame = draw_by(name, scene, &settings(self.solver, stage), ways);
            let (hits, edge, far) = apart(&boxes, &frame);
            let name = format!("{name}, {}, {stage:?}", self.solver);
            assert!(hits > 500, "{name}: only {hits} pixels are hit");
            let spread = errors(&boxes, &frame, 512).normal.unwrap();
            if std::env::var_os("REVMAP_MEASURE").is_some() {
                println!("{name}: {edge} + {far} of {hits}, normals {spread:?}");
            }
            assert!(
                (edge + far) as f64 <= self.tolerated * hits as f64 + 2.0,
                "{name}: of {hits} pixels {edge} are hit by one alone, {far} seen elsewhere"
            );
            let (of, most) = self.normals;
            assert!(of(&spread) < most, "{name}: normals {spread:?}");
        }
    }
}

/// Undercuts, cavities, a torus, ridges: from below, level, above, and from straight above into
/// openings.
#[test]
fn every_shape_from_all_sides() {
    for (name, profile) in shapes::all() {
        for elevation in [-50.0, 0.0, 25.0, 60.0, 89.5] {
            let scene = scene_of(profile.clone(), eye(elevation, 2.2));
            for search in [EXACT, LIVE] {
                search.assert_same(&format!("{name} at {elevation}"), &scene, WRAPPED);
            }
        }
    }
}

/// A slider: the offset changes from frame to frame. It grows the hull, and may grow the solid past
/// its box, which then cuts it.
#[test]
fn offsets_in_motion() {
    let both = [(-0.02, 0.0, 1.0), (0.03, 0.0, 1.0), (0.01, 0.2, 0.4)];
    for (search, own) in [(EXACT, (0.0, 0.12, 1.0)), (LIVE, (0.2, 0.0, 1.0))] {
        for (name, profile) in shapes::all() {
            for (extend, bevel, chamfer) in both.into_iter().chain([own]) {
                let mut scene = scene_of(profile.clone(), eye(20.0, 2.3));
                scene.objects[0].offset = offset(extend, bevel, chamfer);
                // The bevel moves a cone's foot out, past a box that cuts.
                if (name, bevel) == ("cone", 0.12) {
                    scene.objects[0].clip = Clip::Box;
                }
                let name = format!("{name} with {extend} {bevel} {chamfer}");
                search.assert_same(&name, &scene, WRAPPED);
            }
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
                EXACT.assert_same(&name, &scene, ways);
            }
        }
    }
}

/// The same for flat boxes, viewed along a side. One of the 1,474 pixels of the ridged column hits a
/// crease, where the normals of both faces are right and 103 degrees apart, so their 99th percentile
/// is bounded.
#[test]
fn what_a_flat_box_cuts_along_its_side() {
    let search = EXACT.with(|s| s.normals = (|spread| spread.p99, 0.1));
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
            search.assert_same(&name, &scene, WRAPPED);
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
        for (search, place, at) in [
            (EXACT, "the middle", DVec3::new(0.02, 0.01, 0.5)),
            (LIVE, "the middle", DVec3::new(0.02, 0.01, 0.5)),
            (EXACT, "the axis", DVec3::new(0.0, 0.0, 0.9)),
            (LIVE, "the axis", DVec3::new(0.0, 0.0, 0.9)),
            (EXACT, "close to the surface", DVec3::new(0.505, 0.0, 0.5)),
            (EXACT, "the rim", DVec3::new(0.3, 0.2, 0.98)),
            (LIVE, "the box's edge", DVec3::new(0.47, 0.46, 0.5)),
        ] {
            let mut scene = scene_of(profile.clone(), at);
            scene.camera.target = DVec3::new(-0.3, 0.1, 0.45);
            let ways = match (search.solver, name, place) {
                (_, _, "close to the surface" | "the rim" | "the box's edge") => WRAPPED,
                (Solver::Exact, "torus", "the axis") => WRAPPED,
                _ => WALKED,
            };
            search.assert_same(&format!("{name} from {place}"), &scene, ways);
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
        EXACT.assert_same(&format!("discs from {distance}"), &scene, WRAPPED);
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

/// Cases left to the box and the search: a solid cut by its box; turned and flattened solids;
/// intersecting copies; coarse maps with texels as large as the solid's parts; shadows, whose rays
/// begin on the solid.
#[test]
fn all_that_the_box_draws() {
    let mut cut = scene_of(shapes::vase(), eye(25.0, 2.4));
    cut.objects[0].axis = [0.8, 0.5];
    let mut replicas = scene_of(shapes::vase(), eye(25.0, 2.4));
    replicas.objects[0].repeat = [2, 2, 2];
    EXACT.assert_same("cut by its box", &cut, WRAPPED);
    EXACT.assert_same("replicas", &replicas, WALKED);
    let mut all: Vec<(&str, Scene, Ways)> = Vec::new();
    all.push(("cut by its box", cut, WRAPPED));
    all.push(("replicas", replicas, WALKED));
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
        all.push((name, lit, WALKED));
    }
    // An offset beyond the box's ceiling, seen at two degrees. Lavapipe draws it right even without
    // the hull's margin.
    let drum = Profile::polygon(&[[0.0, 0.1], [0.3, 0.1], [0.3, 0.9], [0.0, 0.9]], 0.5).unwrap();
    let mut ceiling = scene_of(drum, eye(15.0, 2.2));
    ceiling.objects[0].offset.extend = 0.15;
    all.push(("cut by the ceiling", ceiling.clone(), WRAPPED));
    ceiling.camera.eye.z = 1.08;
    all.push(("along the ceiling", ceiling, WRAPPED));
    // Texels hold nothing of a solid that grows into the box from outside.
    let points = [[0.0, -0.5], [0.4, -0.5], [0.4, -0.05], [0.0, -0.05]];
    let mut below = scene_of(Profile::polygon(&points, 0.5).unwrap(), eye(25.0, 2.2));
    below.objects[0].offset.extend = 0.15;
    all.push(("from below its box", below, WALKED));
    for (name, scene, ways) in all {
        LIVE.assert_same(name, &scene, ways);
    }
}

/// Rounding of `t` from afar is as large as a texel.
#[test]
fn from_afar() {
    for distance in [20.0, 400.0] {
        let mut scene = scene_of(shapes::vase(), eye(30.0, distance));
        scene.camera.fov_y = 2.0 * (0.6f64 / distance).atan().to_degrees();
        LIVE.assert_same(&format!("{distance} away"), &scene, WRAPPED);
    }
}

/// Eight-bit maps give no bounds, and settings may select boxes.
#[test]
fn where_there_is_none() {
    let scene = scene_of(shapes::sphere(), eye(25.0, 2.2));
    for stage in STAGES {
        let papers = settings(Solver::Live, stage).with(|s| s.map_format = MapFormat::Rgba8);
        draw_by("8 bits", &scene, &papers, WALKED);
        for solver in [Solver::Live, Solver::Exact] {
            let boxes = from_boxes(settings(solver, stage));
            draw_by("boxes", &scene, &boxes, WALKED);
        }
    }
    let profile = Profile::polygon(&[[0.0, 0.4], [0.3, 0.5], [0.0, 0.6]], 0.5).unwrap();
    let small = scene_of(profile, eye(25.0, 40.0));
    let small_enough = Settings {
        proxy_min_pixels: Settings::exact().proxy_min_pixels,
        ..settings(Solver::Live, DrawStage::Fragment)
    };
    draw_by("small", &small, &small_enough, WALKED);
}

/// The comparison detects a solid that is a fiftieth larger, and rays that begin a twentieth of the
/// solid's height too late.
#[test]
fn a_wrong_solid_is_noticed() {
    let scene = scene_of(shapes::sphere(), eye(25.0, 2.2));
    for (search, extend) in [(EXACT, 0.01), (LIVE, -0.05)] {
        let mut other = scene.clone();
        other.objects[0].offset.extend = extend;
        let from_box = from_boxes(settings(search.from_box, DrawStage::Fragment));
        let hull = settings(search.solver, DrawStage::Fragment);
        let ways = match search.solver {
            Solver::Exact => WRAPPED,
            _ => WALKED,
        };
        let frame = draw_by("another", &other, &hull, ways);
        let (hits, edge, far) = apart(&draw(&scene, &from_box), &frame);
        assert!(edge + far > hits / 2, "{edge} + {far} of {hits}");
    }
}
