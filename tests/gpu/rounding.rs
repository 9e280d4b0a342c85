//! Devices that round in other ways than software drivers: products and sums contracted, no denormals,
//! filter weights of 8 bits. The shaders are edited on their way to the driver.
#![allow(unsafe_code)]

use crate::calls::{Layer, above, planted_device};
use crate::common::host::{borrow_through, open_with};
use crate::common::passing::count;
use crate::common::prelude::*;
use crate::spirv::{Arithmetic, edited};
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::SeqCst;

static HOW: Mutex<Option<Arithmetic>> = Mutex::new(None);
static EDITS: AtomicUsize = AtomicUsize::new(0);

above! { edits;
    "vkCreateShaderModule" create: PFN_vkCreateShaderModule(
        device: vk::Device, info: *const vk::ShaderModuleCreateInfo<'_>,
        callbacks: *const vk::AllocationCallbacks<'_>, out: *mut vk::ShaderModule
    ) -> vk::Result, |real| {
        let Some(how) = *HOW.lock().unwrap() else {
            return real(device, info, callbacks, out);
        };
        let words = std::slice::from_raw_parts((*info).p_code, (*info).code_size / 4);
        let (words, edits) = edited(words, how);
        EDITS.fetch_add(edits, SeqCst);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        real(device, &raw const info, callbacks, out)
    }
}

/// A device that computes in some way, and the number of edited operations.
struct Edited {
    frame: Frame,
    edits: usize,
}

/// Draws a scene on a device that computes in some way.
fn drawn(scene: &Scene, settings: &Settings, how: Option<Arithmetic>) -> Edited {
    let host = open_with(|features| features.with(|p| p.shader_float64 = vk::TRUE));
    let raw = planted_device(&host.instance, &host.device, edits);
    *HOW.lock().unwrap() = how;
    EDITS.store(0, SeqCst);
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let drawn = revmap_offscreen::draw(&device, scene, settings);
    let frame = drawn.unwrap().frame;
    *HOW.lock().unwrap() = None;
    Edited {
        frame,
        edits: EDITS.load(SeqCst),
    }
}

/// A solid with the eye close by, and a beveled one with a cavity.
fn scenes() -> [(&'static str, Scene); 2] {
    let mut bevel = scene_of(shapes::glass(), eye(30.0, 1.9));
    bevel.objects[0].offset = offset(0.01, 0.3, 1.0);
    [
        ("torus", scene_of(shapes::torus(), eye(35.0, 0.9))),
        ("glass", bevel),
    ]
}

const ROWS: u32 = 256;

fn settings(stage: DrawStage, solver: Solver) -> Settings {
    sized(240, 180).with(|s| (s.map_rows, s.solver, s.stage) = (Some(ROWS), solver, stage))
}

/// Faults that no rounding explains. Pixels: the ray goes more than a texel into the solid before the hit,
/// or the hit is more than a texel off the surface, or only one picture has a hit, beyond the few of
/// `live` that docs/stability.md counts. Depths: the 99th percentile of the patches' errors over a tenth
/// of a texel of 512 rows, 0 if it is within.
fn faults(scene: &Scene, truth: &Frame, frame: &Frame, solver: Solver) -> (usize, f32) {
    let live = solver == Solver::Live;
    let texel = 1.0 / f64::from(if live { ROWS } else { 512 });
    let found = count(scene, truth, frame, texel);
    let few = if live { found.hits / 200 } else { 0 };
    let pixels = found.passed + found.made_up + (found.missed + found.ghost).saturating_sub(few);
    let pairs = truth.distance.iter().zip(&frame.distance);
    let mut errors: Vec<f32> = pairs.map(|(a, b)| (a - b).abs()).collect();
    errors.retain(|error| error.is_finite());
    errors.sort_unstable_by(f32::total_cmp);
    let p99 = errors[errors.len() * 99 / 100] / (0.1 / 512.0);
    (pixels, if live || p99 <= 1.0 { 0.0 } else { p99 })
}

/// The errors of a picture do not depend on the roundings that GPUs choose. A picture of coarse
/// products, which the test plants, has many more.
#[test]
fn pictures_do_not_depend_on_how_sums_and_products_round() {
    let _alone = Layer::take();
    let ways = [Arithmetic::Fused, Arithmetic::Flushed];
    // Both stages have the same searches: each scene is drawn in one of them.
    for ((name, scene), stage) in scenes().into_iter().zip(STAGES) {
        let truth = reference(&scene, &settings(DrawStage::Fragment, Solver::Exact));
        for solver in [Solver::Exact, Solver::Quadric, Solver::Live] {
            let settings = settings(stage, solver);
            let of = |how| {
                let drawn = drawn(&scene, &settings, Some(how));
                let (pixels, p99) = faults(&scene, &truth, &drawn.frame, solver);
                let what = format!("{name}, {stage:?}, {solver:?}, {how:?}: {pixels}, {p99}");
                println!("{what}");
                assert!(drawn.edits > 20, "{what}: {} edits", drawn.edits);
                (pixels, p99, what)
            };
            for how in ways {
                let (pixels, p99, what) = of(how);
                assert!(pixels <= 2 && p99 == 0.0, "{what}");
            }
            if solver != Solver::Live {
                let (pixels, p99, what) = of(Arithmetic::Coarse);
                assert!(pixels > 10 && p99 > 2.0, "{what} of a planted fault");
            }
        }
    }
}

/// No driver may contract a sum with a product, neither the library's nor those of another search.
#[test]
fn drivers_may_contract_nothing() {
    let _alone = Layer::take();
    let [(_, scene), _] = scenes();
    for stage in STAGES {
        for solver in [Solver::Exact, Solver::Live, CIRCLE] {
            let of = |how| drawn(&scene, &settings(stage, solver), Some(how)).edits;
            assert_eq!(of(Arithmetic::Permitted), 0, "{stage:?}, {solver:?}");
            assert!(of(Arithmetic::Fused) > 20);
        }
    }
}

/// Samplers of many GPUs have 256 places between two texels. The library's searches weight texels by
/// themselves, and gather them where such a sampler selects the same ones. A sampler that rounds to
/// whole texels is planted: it selects others. The published format is filtered by the sampler.
#[test]
fn coarse_samplers_change_no_search_of_the_library() {
    let _alone = Layer::take();
    let [(_, scene), _] = scenes();
    for stage in STAGES {
        for solver in Solver::ALL {
            let settings = settings(stage, solver);
            let of = |how| drawn(&scene, &settings, how);
            let (wanted, coarse) = (of(None).frame, of(Some(Arithmetic::Sampled(256.0))));
            let difference = wanted.first_difference(&coarse.frame);
            assert!(
                difference.is_none(),
                "{stage:?}, {solver:?}: {difference:?}"
            );
            if solver == Solver::Live {
                assert!(coarse.edits > 0, "{stage:?}: no look-up was edited");
                let planted = of(Some(Arithmetic::Sampled(1.0))).frame;
                assert!(wanted.first_difference(&planted).is_some());
            }
        }
        let settings = settings(stage, CIRCLE).with(|s| s.map_format = MapFormat::Rgba8);
        let [fine, coarse] =
            [1024.0, 4.0].map(|parts| drawn(&scene, &settings, Some(Arithmetic::Sampled(parts))));
        assert!(coarse.edits > 0 && fine.frame.first_difference(&coarse.frame).is_some());
    }
}
