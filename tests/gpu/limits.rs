//! The largest valid offsets, and offsets larger than a renderer's maps: the box or the map cuts
//! the solid, never with a hole.

use crate::common::passing::count;
use crate::common::prelude::*;

fn settings() -> Settings {
    sized(160, 120).with(|s| (s.map_rows, s.map_format) = (Some(256), MapFormat::R32))
}

fn with(scene: &Scene, extend: f64, bevel: f64, chamfer: f64) -> Scene {
    let mut scene = scene.clone();
    scene.objects[0].offset = offset(extend, bevel, chamfer);
    scene
}

/// Maps reach as far as an offset needs, and the box cuts the solid beyond its faces.
#[test]
fn what_reaches_beyond_its_box_is_cut_and_closed() {
    for (name, profile) in [("sphere", shapes::sphere()), ("discs", shapes::discs())] {
        let plain = scene_of(profile, eye(25.0, 2.2));
        for (extend, bevel, chamfer) in [
            (0.15, 0.0, 1.0),
            (0.4, 0.0, 1.0),
            (30.0, 0.0, 1.0),
            (0.0, 2.0, 1.0),
            (-0.2, 50.0, 0.5),
            (-0.3, 1.0, 0.0),
        ] {
            let mut scene = with(&plain, extend, bevel, chamfer);
            scene.objects[0].clip = Clip::Box;
            let truth = reference(&scene, &settings());
            let frame = draw(&scene, &settings());
            assert_sound(&frame, name);
            let found = count(&scene, &truth, &frame, 1.0 / 256.0);
            println!("{name}, e {extend}, b {bevel}, c {chamfer}: {found:?}");
            assert!(found.hits > 1000 || extend < -0.25, "{name}: {found:?}");
            let through = found.passed + found.made_up;
            assert_eq!(through, 0, "{name}, {extend}, {bevel}");
            // Silhouettes of large faces: rounding changes only a few pixels.
            let few = found.missed + found.ghost <= 5 + found.hits / 500;
            assert!(few, "{name}: {found:?}");
        }
    }
}

/// An offset beyond the range of a baked map causes a wider map to be baked: only the box cuts the
/// solid, in every search.
#[test]
fn beyond_its_map_a_solid_gets_a_wider_one() {
    let plain = scene_of(shapes::sphere(), eye(25.0, 2.2));
    let wide = with(&plain, 0.8, 0.0, 1.0);
    let wanted = reference(&wide, &settings());
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        for solver in [Solver::Live, CIRCLE, Solver::Quadric] {
            let settings = settings().with(|s| (s.stage, s.solver) = (stage, solver));
            let mut renderer = Offscreen::new(device(), &plain, &settings).unwrap();
            let frame = updated(&mut renderer, &wide);
            assert_sound(&frame, "beyond the map");
            let (pixels, hits) = (0..frame.pixels(), hits(&wanted));
            let other = |&i: &usize| frame.hits(i) != wanted.hits(i);
            let differ = pixels.clone().filter(other).count();
            let both = pixels.filter(|&i| frame.hits(i) && wanted.hits(i));
            let far = |&i: &usize| (frame.distance[i] - wanted.distance[i]).abs() > 0.02;
            let off = both.filter(far).count();
            let what = format!("{stage:?}, {solver}: of {hits} {differ} differ, {off} elsewhere");
            println!("{what}");
            assert!(hits > 3000 && differ <= 20 && off <= 20, "{what}");
        }
    }
    device().check().unwrap();
}
