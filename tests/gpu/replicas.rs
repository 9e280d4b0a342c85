//! Replicas in a box, compared with the reference, whose replicas are single solids
//! (`lab/reference/src/tests/crowds.rs`).

use crate::common::passing::count;
use crate::common::prelude::*;

const COUNT: [u32; 3] = [3, 3, 2];
const ROWS: u32 = 512;

fn settings(solver: Solver) -> Settings {
    Settings {
        map_rows: Some(ROWS),
        map_format: MapFormat::R32,
        solver,
        ..sized(200, 150)
    }
}

/// Pixels that differ: by a hit, by more than a texel of depth, by more than 2 degrees of normal, or
/// by the place in the texture.
fn differences(a: &Frame, b: &Frame, texel: f64) -> [usize; 4] {
    let mut found = [0; 4];
    for i in 0..a.pixels() {
        if a.hits(i) != b.hits(i) {
            found[0] += 1;
            continue;
        }
        if !a.hits(i) {
            continue;
        }
        let normal = |f: &Frame| DVec3::from_array(f.normal[i].map(f64::from));
        let round = (a.uv[i][0] - b.uv[i][0]).abs();
        if f64::from((a.distance[i] - b.distance[i]).abs()) > texel {
            found[1] += 1;
        } else if normal(a).dot(normal(b)) < 2f64.to_radians().cos() {
            found[2] += 1;
        } else if round.min(1.0 - round) > 1e-2 || (a.uv[i][1] - b.uv[i][1]).abs() > 1e-2 {
            found[3] += 1;
        }
    }
    found
}

fn cases() -> Vec<(&'static str, Scene)> {
    let case = |profile, eye: DVec3, change: &dyn Fn(&mut Object)| {
        let mut scene: Scene = scene_of(profile, eye);
        let object = &mut scene.objects[0];
        object.repeat = COUNT;
        change(object);
        scene
    };
    let mirrored = |o: &mut Object| o.mirror = [true; 3];
    let [oblique, within] = [[1.35, 0.8, 1.25], [0.17, 0.16, 0.5]].map(DVec3::from_array);
    vec![
        ("plain", case(shapes::vase(), oblique, &|_| {})),
        ("mirrored", case(shapes::vase(), oblique, &mirrored)),
        (
            "mirrored, axis off the middle, cut by their cells",
            case(shapes::torus(), DVec3::new(-1.2, 0.9, -0.4), &|o| {
                o.mirror = [true, true, false];
                o.axis = [0.3, 0.62];
            }),
        ),
        (
            "mirrored in z alone, extended",
            case(shapes::cone(), DVec3::new(0.3, -1.7, 0.9), &|o| {
                o.mirror = [false, false, true];
                o.axis = [0.45, 0.5];
                o.offset.extend = 0.05;
            }),
        ),
        (
            "beveled, turned and stretched",
            case(shapes::jewel(), DVec3::new(1.4, -1.4, 1.5), &|o| {
                o.offset.bevel = 0.2;
                o.placement = placement([0.1, 0.0, 0.0], [0.2, -0.1, 0.4], [1.1, 0.8, 1.2]);
            }),
        ),
        ("between them", case(shapes::sphere(), within, &mirrored)),
    ]
}

#[test]
fn replicas_are_those_of_the_reference() {
    for (name, scene) in cases() {
        let texel = 1.0 / f64::from(ROWS);
        let truth = reference(&scene, &settings(Solver::DEFAULT));
        let hits = hits(&truth);
        assert!(hits > 4000, "{name}: {hits}");
        for solver in [Solver::Live, Solver::Quadric] {
            let frame = draw(&scene, &settings(solver));
            let found = differences(&truth, &frame, texel);
            let what = format!("{name}, {}: {hits} hits; differ: {found:?}", solver.name());
            println!("{what}");
            // `live` rounds edges within a texel.
            let most = match solver {
                Solver::Live => [hits / 200, hits / 100, hits / 12, hits / 100],
                _ => [hits / 500; 4],
            };
            assert!(
                found.iter().zip(most).all(|(found, most)| *found <= most),
                "{what}"
            );
            if scene.objects[0].placement == Placement::default() {
                let c = count(&scene, &truth, &frame, texel);
                assert_eq!((c.passed, c.made_up), (0, 0), "{what}");
            }
        }
        // A texture on the whole box would run once from 0 to 1 over its height.
        let rows = |range: std::ops::Range<f32>| {
            let within = |i: &usize| truth.hits(*i) && range.contains(&truth.uv[*i][1]);
            (0..truth.pixels()).filter(within).count()
        };
        let [low, high] = [rows(0.0..0.3), rows(0.7..1.0)];
        assert!(name != "plain" || low > 500 && high > 500);
    }
}
