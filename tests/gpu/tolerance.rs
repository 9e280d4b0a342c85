//! Levels of surfaces: errors stay below the tolerance, and pictures depend only on the view.

use crate::common::prelude::*;
use revmap_compare::pixel_errors;

fn settings(stage: DrawStage, pixels: f64) -> Settings {
    Settings {
        tolerance: Tolerance::new(pixels).unwrap(),
        ..drawn_by((320, 240), stage, Solver::DEFAULT)
    }
}

fn levels(offscreen: &Offscreen) -> Vec<Option<u32>> {
    offscreen
        .renderer()
        .object_costs()
        .iter()
        .map(|c| c.level)
        .collect()
}

/// Solids of all sizes on the screen, from the side and from above.
#[test]
fn errors_stay_below_the_tolerance() {
    let mut failures = Vec::new();
    for (name, profile) in [
        ("vase", shapes::vase()),
        ("glass", shapes::glass()),
        ("torus", shapes::torus()),
    ] {
        for (elevation, distance) in [(10.0, 2.2), (50.0, 2.2), (25.0, 6.0), (25.0, 30.0)] {
            let scene = scene_of(profile.clone(), eye(elevation, distance));
            let truth = reference(&scene, &settings(DrawStage::Fragment, 0.0));
            for stage in STAGES {
                for pixels in [0.05, 0.25, 2.0] {
                    let settings = settings(stage, pixels);
                    let mut offscreen = Offscreen::new(device(), &scene, &settings).unwrap();
                    let frame = next_frame(&mut offscreen);
                    let found = pixel_errors(&scene, &truth, &frame).unwrap();
                    let cost = offscreen.renderer().object_costs()[0];
                    let most = cost.error_pixels.unwrap();
                    let what = format!(
                        "{name} from {distance} at {elevation}, {stage:?}, {pixels}: {cost:?}, {found:?}"
                    );
                    println!("{what}");
                    // A silhouette moves by no more than the proven bound plus rounding.
                    let right = found.p999 <= pixels && found.contour_max <= most + 0.01;
                    if !right || cost.level == Some(0) && pixels == 2.0 {
                        failures.push(what);
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A camera that moves away and back gives the same bits, and nothing is made twice.
#[test]
fn a_picture_follows_from_the_view_alone() {
    for stage in STAGES {
        let settings = settings(stage, 0.25);
        let near = scene_of(shapes::vase(), eye(25.0, 2.2));
        let far = Scene {
            camera: scene_of(shapes::vase(), eye(25.0, 20.0)).camera,
            ..near.clone()
        };
        let mut offscreen = Offscreen::new(device(), &near, &settings).unwrap();
        let mut drawn = |scene: &Scene| {
            let frame = updated(&mut offscreen, scene);
            let level = levels(&offscreen)[0].unwrap();
            (frame, level, offscreen.renderer().rebuild_count())
        };
        let (first, fine, made) = drawn(&near);
        // The exact surface is not made where it is not drawn.
        assert_eq!(made, 1);
        let (away, coarse, _) = drawn(&far);
        assert!(coarse > fine, "{fine} near, {coarse} far");
        let (again, level, made) = drawn(&near);
        assert!(again == first && level == fine && made == 2);
        assert_eq!(drawn(&far).2, 2);
        let fresh = draw(&far, &settings);
        assert!(away == fresh, "another picture of a first frame");
    }
}

/// A tolerance of 0 uses no coarser level, and coarser levels have fewer patches.
#[test]
fn no_tolerance_is_the_exact_level() {
    let scene = scene_of(shapes::vase(), eye(25.0, 20.0));
    let of = |pixels| {
        let settings = settings(DrawStage::Fragment, pixels);
        let offscreen = Offscreen::new(device(), &scene, &settings).unwrap();
        offscreen.renderer().object_costs()[0]
    };
    let all = [0.0, 0.05, 0.25, 2.0].map(of);
    assert_eq!(all[0].level, Some(0));
    for pair in all.windows(2) {
        assert!(pair[0].level < pair[1].level && pair[0].patches > pair[1].patches);
        assert!(pair[0].error_pixels < pair[1].error_pixels);
    }
    const { assert!(INSTANCE_BYTES <= 96) };
    assert_eq!(all[0].instance_bytes, INSTANCE_BYTES);
}

/// A shadow may fall nearer to the eye than its caster, so all objects use the level of the
/// nearest.
#[test]
fn shadows_share_the_finest_level() {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 2.2));
    scene.objects.push(scene.objects[0].clone());
    scene.objects[1].placement = placement([-40.0, -16.0, 0.0], [0.0; 3], [1.0; 3]);
    let settings = settings(DrawStage::Fragment, 0.25);
    let mut offscreen = Offscreen::new(device(), &scene, &settings).unwrap();
    let apart = levels(&offscreen);
    assert!(apart[0] < apart[1], "{apart:?}");
    scene.shadow = Shadow::Hard;
    offscreen.update(&scene).unwrap();
    offscreen.draw().unwrap();
    assert_eq!(levels(&offscreen), [apart[0]; 2]);
    device().check().unwrap();
}
