//! Retries after a failed `prepare`: no texture and no object is lost. The random host
//! (`tests/soak`) limits memory, drops frames, prepares slots twice in one command buffer and
//! records frames twice.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{self, Drawn, Host, borrow_through, never, once, open, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};

/// The three solids, with a colour map and a displacement map on the first.
fn textured() -> Scene {
    let mut scene = three();
    let object = &mut scene.objects[0];
    let number = |x: u32, y: u32| 16 * y + x;
    let color = |n: u32| [(37 * n) as u8, 255 - (91 * n) as u8, 40, 255];
    let height = |x, y| (number(x, y) * 29 % 64) as f32 / 64.0;
    object.texturing.color_map = Some(color_map(16, 16, |x, y| color(number(x, y))));
    object.texturing.displacement_map = Some(slope_map(16, height));
    object.texturing.bump = 0.02;
    scene
}

/// A renderer of colours in a stage.
pub fn by<'a>(
    host: &'a Host,
    device: &Device,
    stage: DrawStage,
    scene: &Scene,
    search: &SearchSettings,
) -> Drawn<'a> {
    let output = match stage {
        DrawStage::Compute => Output::Compute(Planes::Color),
        DrawStage::Fragment => Output::Pass(host::color_pass()),
    };
    Drawn::new(host, device, options(), (output, search), scene)
}

/// The same by the maps of objects, which are textures too.
fn by_maps<'a>(host: &'a Host, device: &Device, stage: DrawStage, scene: &Scene) -> Drawn<'a> {
    let search = SearchSettings {
        solver: Solver::Live,
        map_rows: Some(64),
        ..SearchSettings::exact()
    };
    by(host, device, stage, scene, &search)
}

/// The number of pixels that differ, of four bytes each.
pub fn differ(a: &[u8], b: &[u8]) -> usize {
    let pairs = a.chunks_exact(4).zip(b.chunks_exact(4));
    pairs.filter(|(a, b)| a != b).count()
}

/// Each Vulkan call that fails in the first `prepare` is an error; the retry draws everything. The
/// commands of the failed call are dropped or submitted.
#[test]
fn a_retry_after_a_failed_call_draws_everything() {
    let (layer, host) = (Layer::take(), open());
    let raw = layer.device(&host.instance, &host.device);
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let scene = textured();
    for stage in STAGES {
        let wanted = by_maps(&host, &device, stage, &scene).picture().0;
        let mut failures = 0;
        for n in 0.. {
            let mut drawn = by_maps(&host, &device, stage, &scene);
            let mut failed = false;
            let fail = |cmd| {
                layer.fail_at(n);
                failed = drawn.record(cmd, (0, 0), None).is_err();
                layer.fail_at(usize::MAX);
            };
            match n % 2 {
                0 => never(&host, fail),
                _ => once(&host, fail),
            }
            // A `set` with equal values changes nothing.
            let object = drawn.renderer.object(drawn.ids[0]).unwrap().clone();
            drawn.renderer.set(drawn.ids[0], object).unwrap();
            for slot in [0, 1] {
                once(&host, |cmd| drawn.record(cmd, (slot, 1), None).map(drop)).unwrap();
                let pixels = differ(&drawn.canvas.read().0, &wanted);
                assert_eq!(pixels, 0, "{stage:?}, call {n}, slot {slot}");
            }
            if !failed {
                break;
            }
            failures += 1;
        }
        assert!(failures > 8, "{stage:?}: {failures}");
    }
}

/// An object that cannot be drawn is named in each frame until it is mended or removed; the others
/// are drawn then, without being set again.
#[test]
fn one_wrong_object_hides_no_other() {
    let (host, device) = opened();
    let search = SearchSettings {
        solver: Solver::Live,
        map_format: MapFormat::Rgba8,
        ..SearchSettings::exact()
    };
    let mut scene = three();
    scene.objects[2].offset.extend = 0.01;
    let right = scene.objects[1].clone();
    let wrong = right.clone().with(|o| o.offset.extend = -0.02);
    scene.objects[1] = wrong.clone();
    let mut drawn = by(&host, &device, DrawStage::Compute, &scene, &search);
    let shown = |drawn: &mut Drawn| {
        let frame = once(&host, |cmd| drawn.record(cmd, (0, 0), None));
        frame.map(|frame| frame.statistics().objects)
    };
    for _ in 0..2 {
        let error = shown(&mut drawn).unwrap_err();
        assert!(error.to_string().contains("object.1.extend"), "{error}");
    }
    drawn.renderer.set(drawn.ids[1], right).unwrap();
    assert_eq!(shown(&mut drawn).unwrap(), 3);
    let last = drawn.renderer.add(wrong).unwrap();
    let good = drawn.renderer.add(scene.objects[0].clone()).unwrap();
    assert!(shown(&mut drawn).is_err());
    drawn.renderer.remove(last).unwrap();
    assert_eq!(shown(&mut drawn).unwrap(), 4);
    assert!(drawn.renderer.object(good).is_ok());
}
