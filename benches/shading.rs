//! The cost of a host's function of shading. A round draws a frame by each function: the library's,
//! a copy of it, a constant, and that of `examples/forward`. The bench prints milliseconds and the
//! ratio to the library's. `cargo bench --features shaderc --bench shading`.
#![allow(unsafe_code, clippy::unwrap_used)]

mod rounds;

use ash::vk;
use revmap::gpu::{Device, Output, Renderer};
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, SearchSettings};
use revmap::shading::Shading;
use rounds::host::{Canvas, UniformSet, add, borrow, color_pass, once, open_unchecked, shaded};
use rounds::{Case, OPTIONS, bishop, compare};
use std::sync::Arc;

const COPY: &str = include_str!("../tests/common/copy.glsl");
const PLAIN: &str = "vec4 host_shade(Surface s) { return vec4(s.base_color, 1.0); }\n";
const FORWARD: &str = include_str!("../examples/forward/shade.glsl");
const LIGHT: &str = include_str!("../examples/forward/light.glsl");

fn output(stage: DrawStage) -> Output {
    match stage {
        DrawStage::Fragment => Output::Pass(color_pass()),
        DrawStage::Compute => Output::Compute(Planes::Color),
    }
}

fn made(
    device: &Device,
    stage: DrawStage,
    scene: &Scene,
    (name, text): (&str, Option<&str>),
    set: &UniformSet,
) -> Case {
    let output = output(stage);
    let exact = SearchSettings::exact();
    let mut renderer = match text {
        None => Renderer::new(device, output, &exact, 1),
        Some(text) => {
            let files = [("shade.glsl", text), ("light.glsl", LIGHT)];
            let shading = Arc::new(Shading::compile(stage, &files).unwrap());
            // SAFETY: the layout has the binding that the texts read, and outlives the renderer.
            unsafe { shaded(device, output, &exact, 1, &shading, set.layout) }
        }
    }
    .unwrap();
    add(&mut renderer, scene);
    (name.to_owned(), renderer)
}

fn main() {
    let host = open_unchecked();
    let device = borrow(&host);
    let (scene, view) = bishop();
    let set = UniformSet::of(&host, &[[0.5f32; 4]; 10]).unwrap();
    println!("{}, 800x600", device.report().name);
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let canvas = Canvas::new(&host, OPTIONS, &output(stage));
        let lights = format!("k < {}", scene.lighting().lights.len());
        let copy = COPY.replace("k < 3", &lights);
        let texts = [
            ("the library's", None),
            ("a copy of it", Some(copy.as_str())),
            ("base colour alone", Some(PLAIN)),
            ("sun and three lamps (GGX), examples/forward", Some(FORWARD)),
        ];
        let mut cases = texts.map(|text| made(&device, stage, &scene, text, &set));
        cases
            .iter_mut()
            .for_each(|case| canvas.lend(&mut case.1, true));
        let prefix = format!("{:8} ", stage.name());
        compare(&prefix, &mut cases, |n, (_, renderer)| {
            once(&host, |cmd| {
                // SAFETY: `cmd` is recording; the frame before is done; the target is the output's;
                // the set is of the renderer's layout, or is not read.
                unsafe {
                    let frame = renderer.prepare(cmd, 0, &view).unwrap();
                    let layout = renderer.pipeline_layout().unwrap();
                    let (point, record) = match stage {
                        DrawStage::Fragment => (vk::PipelineBindPoint::GRAPHICS, true),
                        DrawStage::Compute => (vk::PipelineBindPoint::COMPUTE, false),
                    };
                    canvas.record(cmd, || {
                        if n > 0 {
                            set.bind(cmd, point, layout, 3);
                        }
                        match record {
                            true => renderer.record(cmd, &frame).unwrap(),
                            false => renderer.record_compute(cmd, &frame).unwrap(),
                        }
                    });
                }
            });
        });
    }
}
