//! Replicas in a box give the same picture as the same number of single solids.

use crate::common::passing::count;
use crate::common::{draw, hits, placement, reference, scene_of, shapes, sized};
use glam::DVec3;
use revmap::frame::Frame;
use revmap::maps::MapFormat;
use revmap::profile::{Outline, Profile};
use revmap::scene::{Clip, Object, Placement, Scene};
use revmap::settings::{Settings, Solver};
use std::sync::Arc;

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

/// The profile turned upside down within its box.
fn flipped(profile: &Profile) -> Profile {
    let turn = |points: &Vec<glam::DVec2>| {
        // Reversing the order of points keeps the orientation of loops.
        let turned = points.iter().rev();
        turned.map(|p| glam::DVec2::new(p.x, 1.0 - p.y)).collect()
    };
    let loops = profile.outline.loops.iter().map(turn).collect();
    Profile::new(Outline { loops }, profile.radius)
}

/// The box's cells as separate objects: one object for each kind of reflection, one instance for
/// each cell.
fn singles(replicas: &Object) -> Vec<Object> {
    let n = COUNT.map(f64::from);
    let upright = replicas.profile.clone();
    let upturned = Arc::new(flipped(&upright));
    let radius = upright.radius;
    let mut objects = Vec::new();
    for kind in 0..8u32 {
        let reflected = [0, 1, 2].map(|k| kind >> k & 1 == 1);
        let profile = if reflected[2] { &upturned } else { &upright };
        let mut object = Object::new("single", profile.clone());
        object.offset = replicas.offset;
        object.texturing = replicas.texturing.clone();
        object.axis = [0, 1].map(|k| match reflected[k] {
            true => 1.0 - replicas.axis[k],
            false => replicas.axis[k],
        });
        for cell in 0..COUNT.iter().product::<u32>() {
            let [nx, ny, _] = COUNT;
            let at = [cell % nx, cell / nx % ny, cell / (nx * ny)];
            if (0..3).any(|k| (replicas.mirror[k] && at[k] % 2 == 1) != reflected[k]) {
                continue;
            }
            let at = at.map(f64::from);
            let own = DVec3::new(
                (2.0 * (at[0] + 0.5) / n[0] - 1.0) * radius,
                (2.0 * (at[1] + 0.5) / n[1] - 1.0) * radius,
                at[2] / n[2],
            );
            let outer = replicas.placement;
            object.instances.push(Placement {
                position: outer.position + outer.rotation * (outer.scale * own),
                rotation: outer.rotation,
                scale: outer.scale / DVec3::from_array(n),
            });
        }
        if !object.instances.is_empty() {
            objects.push(object);
        }
    }
    objects
}

/// Pixels that differ: by a hit, by more than a texel of depth, or by more than 2 degrees of
/// normal.
fn differences(a: &Frame, b: &Frame, texel: f64) -> [usize; 3] {
    let mut found = [0; 3];
    for i in 0..a.pixels() {
        if a.hits(i) != b.hits(i) {
            found[0] += 1;
            continue;
        }
        if !a.hits(i) {
            continue;
        }
        let normal = |f: &Frame| DVec3::from_array(f.normal[i].map(f64::from));
        if f64::from((a.distance[i] - b.distance[i]).abs()) > texel {
            found[1] += 1;
        } else if normal(a).dot(normal(b)) < 2f64.to_radians().cos() {
            found[2] += 1;
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
fn replicas_are_as_many_single_solids() {
    for (name, scene) in cases() {
        let mut alone = scene.clone();
        alone.objects = singles(&scene.objects[0]);
        // Each cell cuts its solid.
        alone.objects.iter_mut().for_each(|o| o.clip = Clip::Box);
        let copies: usize = alone.objects.iter().map(|o| o.instances.len()).sum();
        assert_eq!(copies, 18, "{name}");

        let texel = 1.0 / f64::from(ROWS);
        let truth = reference(&scene, &settings(Solver::DEFAULT));
        let hits = hits(&truth);
        assert!(hits > 4000, "{name}: {hits}");
        for solver in [Solver::Live, Solver::Quadric] {
            let together = draw(&scene, &settings(solver));
            let apart = draw(&alone, &settings(solver));
            // A cell is half or a third of the box.
            let found = differences(&together, &apart, texel / 3.0);
            let what = format!("{name}, {}: {hits} hits; differ: {found:?}", solver.name());
            println!("{what}");
            // The remaining differences come from rounding: neither picture is wrong by more than a
            // texel.
            assert!(found.iter().sum::<usize>() <= hits / 500, "{what}");
            if scene.objects[0].placement == Placement::default() {
                for (frame, which) in [(&together, "together"), (&apart, "apart")] {
                    let c = count(&scene, &truth, frame, texel);
                    println!("    {which}: {c:?}");
                    assert_eq!((c.passed, c.made_up), (0, 0), "{what}, {which}");
                }
            }
        }
    }
}

/// Each replica has the whole texture, like a single solid.
#[test]
fn textures_are_laid_on_each_replica() {
    let (_, scene) = cases().remove(0);
    let mut alone = scene.clone();
    alone.objects = singles(&scene.objects[0]);
    let [together, apart] = [&scene, &alone].map(|s| draw(s, &settings(Solver::DEFAULT)));
    let both: Vec<usize> = (0..together.pixels())
        .filter(|&i| together.hits(i) && apart.hits(i))
        .collect();
    let off = both.iter().filter(|&&i| {
        let [a, b] = [together.uv[i], apart.uv[i]];
        let round = (a[0] - b[0]).abs();
        round.min(1.0 - round) > 1e-3 || (a[1] - b[1]).abs() > 1e-3
    });
    let (off, all) = (off.count(), both.len());
    assert!(all > 4000 && off <= all / 500, "{off} of {all}");
    // The coordinates of a single solid in the whole box would run once from 0 to 1 over its
    // height.
    let low = both.iter().filter(|&&i| together.uv[i][1] < 0.3).count();
    let high = both.iter().filter(|&&i| together.uv[i][1] > 0.7).count();
    assert!(low > 500 && high > 500);
}
