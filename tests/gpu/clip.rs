//! Boxes that grow with the offset (`clip = "none"`), compared with the reference, which only moves
//! the box's faces; and boxes that cut (`clip = "box"`).

use crate::common::prelude::*;

fn settings(stage: DrawStage, solver: Solver) -> Settings {
    drawn_by((200, 150), stage, solver)
}

fn with(profile: Profile, [extend, bevel, chamfer]: [f64; 3]) -> Scene {
    let mut scene = scene_of(profile, eye(20.0, 3.4));
    scene.objects[0].offset = offset(extend, bevel, chamfer);
    // Turned, stretched and moved: the grown box must keep the solid in place.
    scene.objects[0].placement = placement([0.1, -0.2, 0.05], [0.3, -0.2, 0.7], [1.1, 0.8, 0.9]);
    scene
}

/// Every search finds the whole solid.
#[test]
fn searches_agree_with_the_reference() {
    let mut failures = Vec::new();
    for (name, profile) in [("vase", shapes::vase()), ("column", shapes::column())] {
        for offset in [
            [0.15, 0.0, 1.0],
            [0.0, 0.25, 1.0],
            [0.05, 0.8, 0.2],
            [3.0, 0.1, 0.5],
        ] {
            let scene = with(profile.clone(), offset);
            let truth = reference(&scene, &settings(DrawStage::Fragment, Solver::Exact));
            for (stage, solver) in [
                (DrawStage::Fragment, Solver::Exact),
                (DrawStage::Compute, Solver::Exact),
                (DrawStage::Fragment, Solver::Quadric),
                (DrawStage::Compute, Solver::Live),
            ] {
                let c = errors(&truth, &draw(&scene, &settings(stage, solver)), 512);
                let what = format!("{name} {offset:?} {solver} {stage:?}: {c}");
                println!("{what}");
                // The exact searches use the bounds for boxes that cut; `live` has its own.
                let (most, p99) = match solver {
                    Solver::Live => (c.hits / 500, 0.5),
                    _ => (2, 0.02),
                };
                if c.missed + c.ghost > most || c.depth.unwrap().p99 > p99 {
                    failures.push(what);
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// A growing box grows by at least the offset, in steps, and not
/// at all if the offset solid stays within.
#[test]
fn boxes_grow_by_what_offsets_need() {
    let rod = [[0.0, 0.0], [0.3, 0.0], [0.3, 1.0], [0.0, 1.0]];
    let rod = Profile::polygon(&rod, 0.3).unwrap();
    let mut object = Object::new("rod", rod.into());
    let bounds = object.profile.outline.bounds().unwrap();
    assert_eq!((bounds.z_min, bounds.z_max), (0.0, 1.0));
    let growth = |object: &Object| Growth::of(object);
    assert!(growth(&object).is_none());
    object.offset.extend = -0.02;
    assert!(growth(&object).is_none());
    object.offset.extend = 0.03;
    let grown = growth(&object);
    assert!((0.03..=0.1).contains(&grown.low), "{grown:?}");
    assert_eq!(grown.low, grown.high);
    object.offset.extend = 0.031;
    assert_eq!(growth(&object), grown);
    object.clip = Clip::Box;
    assert!(growth(&object).is_none());
    object.clip = Clip::None;
    object.repeat = [2, 1, 1];
    assert!(growth(&object).is_none());
    object.repeat = [1; 3];
    // The growth is a whole number of a picture's pixels.
    let raster = Raster {
        columns: 5,
        rows: 11,
        coverage: vec![1.0; 55],
    };
    object.profile = revmap_files::trace(raster).unwrap().into();
    let grown = growth(&object);
    assert!((grown.high * 11.0).fract() < 1e-9, "{grown:?}");
    assert!(grown.side >= 0.031);
}
