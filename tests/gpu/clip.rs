//! Boxes that grow with the offset (`clip = "none"`), compared with the reference, which only moves
//! the box's faces; and boxes that cut (`clip = "box"`).

use crate::common::ways::STAGES;
use crate::common::{
    device, draw, drawn_by, errors, eye, hits, offset, placement, reference, scene_of, shapes,
    updated,
};
use glam::DVec3;
use revmap::profile::{Profile, Raster};
use revmap::scene::{Clip, Growth, Object, Scene};
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_offscreen::Offscreen;

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

/// An extended sphere is a larger sphere, and all of it is visible.
#[test]
fn an_extended_sphere_is_whole() {
    let scene = with(shapes::sphere(), [0.15, 0.0, 1.0]);
    let own = &scene.objects[0].placement;
    let bounds = scene.objects[0].profile.outline.bounds().unwrap();
    let (radius, middle) = (bounds.r_max + 0.15, 0.5 * (bounds.z_min + bounds.z_max));
    for stage in STAGES {
        let frame = draw(&scene, &settings(stage, Solver::Exact));
        let camera = &scene.camera;
        let rays = revmap::scene::CameraFrame::new(camera, 200, 150).unwrap();
        let (mut hits, mut wrong, mut worst) = (0, 0, 0.0f64);
        for n in 0..200 * 150 {
            let v = rays.pixel(n % 200, n / 200);
            let back = own.rotation.conjugate();
            let o = back * (camera.eye - own.position) / own.scale - DVec3::new(0.0, 0.0, middle);
            let d = back * v / own.scale;
            let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - radius * radius);
            let under = b * b - a * c;
            let found = f64::from(frame.distance[n as usize]);
            if under > 0.0 && found.is_finite() {
                hits += 1;
                let t = (-b - under.sqrt()) / a;
                worst = worst.max((t * v.length() - found).abs() * under.sqrt().min(1.0));
            } else if (under > 0.0) != found.is_finite() {
                wrong += 1;
            }
        }
        println!("{stage:?}: {hits} hits, {wrong} wrong, depth {worst:e}");
        assert!(hits > 2000 && wrong <= 2, "{stage:?}: {wrong} of {hits}");
        assert!(worst < 2e-4, "{worst:e}");
    }
}

/// Every search finds the whole solid, in both stages.
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
            for solver in [Solver::Exact, Solver::Quadric, Solver::Live] {
                for stage in STAGES {
                    let c = errors(&truth, &draw(&scene, &settings(stage, solver)), 512);
                    let what = format!(
                        "{name} {offset:?} {solver} {stage:?}: {} wrong of {}, depth p99 {:.4}",
                        c.missed + c.ghost,
                        c.hits,
                        c.depth.unwrap().p99
                    );
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
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Texture coordinates are those of the profile's box.
#[test]
fn textures_stay_where_they_are() {
    use revmap::maps::Projection;
    for (_, projection) in Projection::NAMES {
        let mut scene = with(shapes::vase(), [0.1, 0.05, 0.5]);
        scene.objects[0].texturing.projection = projection;
        let truth = reference(&scene, &settings(DrawStage::Fragment, Solver::Exact));
        for stage in STAGES {
            let frame = draw(&scene, &settings(stage, Solver::Exact));
            let mut off: Vec<f64> = (truth.uv.iter().zip(&frame.uv))
                .zip(truth.distance.iter().zip(&frame.distance))
                .filter(|(_, (a, b))| a.is_finite() && b.is_finite())
                .map(|((a, b), _)| {
                    let turn = |d: f32| f64::from((d - d.round()).abs());
                    turn(a[0] - b[0]).max(turn(a[1] - b[1]))
                })
                .collect();
            off.sort_by(f64::total_cmp);
            let p99 = off[off.len() * 99 / 100];
            println!("{projection:?} {stage:?}: {p99:e} of {}", off.len());
            // Lengths along the outline come from a table of texels.
            let arc = projection == Projection::Arc;
            let most = if arc { 5e-3 } else { 1e-4 };
            assert!(p99 < most, "{projection:?} {stage:?}: {p99}");
        }
    }
}

/// A clipping box cuts at its faces. A growing box grows by at least the offset, in steps, and not
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

    let mut scene = with(shapes::column(), [0.15, 0.0, 1.0]);
    scene.objects[0].clip = Clip::Box;
    let truth = reference(&scene, &settings(DrawStage::Fragment, Solver::Exact));
    let cut = draw(&scene, &settings(DrawStage::Fragment, Solver::Exact));
    scene.objects[0].clip = Clip::None;
    let whole = draw(&scene, &settings(DrawStage::Fragment, Solver::Exact));
    let c = errors(&truth, &cut, 512);
    assert!(c.missed + c.ghost <= 2);
    assert!(hits(&whole) as f64 > 1.1 * hits(&cut) as f64);
}

/// Changes of offset, placement and copies give the picture of a new renderer.
#[test]
fn growing_follows_every_change() {
    let settings = settings(DrawStage::Fragment, Solver::Exact);
    let mut scene = with(shapes::vase(), [0.0, 0.0, 1.0]);
    let mut renderer = Offscreen::new(device(), &scene, &settings).unwrap();
    let copy = placement([0.5, 0.4, 0.1], [0.0; 3], [0.5; 3]);
    type Change<'a> = &'a dyn Fn(&mut Object);
    let changes: [Change; 7] = [
        &|o| o.offset.extend = 0.02,
        &|o| o.offset.extend = 0.12,
        &|o| o.placement.position.x += 0.2,
        &|o| o.instances = vec![o.placement, copy].into(),
        &|o| o.instances[0].position.y += 0.1,
        &|o| o.clip = Clip::Box,
        &|o| {
            o.clip = Clip::None;
            o.instances.clear();
            o.offset.extend = 0.0;
        },
    ];
    for (n, change) in changes.into_iter().enumerate() {
        change(&mut scene.objects[0]);
        let found = updated(&mut renderer, &scene);
        assert!(found == draw(&scene, &settings), "change {n}");
    }
    device().check().unwrap();
}
