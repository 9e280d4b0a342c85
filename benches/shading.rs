//! The cost of a host's function of shading. A round draws a frame by each function: the library's,
//! a copy of it, a constant, and that of `examples/forward`. The bench prints milliseconds and the
//! ratio to the library's. `cargo bench --features shaderc --bench shading`.
#![allow(unsafe_code, clippy::unwrap_used)]

mod rounds;

use ash::vk;
use revmap::gpu::{Device, HostShading, Output, PassFormats, Renderer};
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, SearchSettings};
use revmap::shading::Shading;
use rounds::host::{
    Attachments, HostBuffer, UniformSet, add, barrier, borrow, dynamic, once, open_unchecked,
    target,
};
use rounds::{Case, OPTIONS, bishop, compare};
use std::sync::Arc;

const COPY: &str = include_str!("../tests/common/copy.glsl");
const PLAIN: &str = "vec4 host_shade(Surface s) { return vec4(s.base_color, 1.0); }\n";
const FORWARD: &str = include_str!("../examples/forward/shade.glsl");
const LIGHT: &str = include_str!("../examples/forward/light.glsl");

/// What all frames of a stage draw into.
enum Into<'a> {
    Pass(Attachments<'a>),
    Compute(HostBuffer<'a>),
}

fn made(
    device: &Device,
    stage: DrawStage,
    scene: &Scene,
    (name, text): (&str, Option<&str>),
    set: &UniformSet,
) -> Case {
    let output = match stage {
        DrawStage::Fragment => {
            let begun = dynamic(&[vk::Format::R8G8B8A8_SRGB]);
            Output::Pass(PassFormats::new(begun, Planes::Color))
        }
        DrawStage::Compute => Output::Compute(Planes::Color),
    };
    let exact = SearchSettings::exact();
    let mut renderer = match text {
        None => Renderer::new(device, output, &exact, 1),
        Some(text) => {
            let files = [("shade.glsl", text), ("light.glsl", LIGHT)];
            let host = HostShading {
                shading: Arc::new(Shading::compile(stage, &files).unwrap()),
                set_layout: set.layout,
            };
            // SAFETY: the layout has the binding that the texts read, and outlives the renderer.
            unsafe { Renderer::with_shading(device, output, &exact, 1, &host) }
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
        let into = match stage {
            DrawStage::Fragment => {
                let formats = [(vk::Format::R8G8B8A8_SRGB, 4)];
                Into::Pass(Attachments::new(&host, OPTIONS, &formats).unwrap())
            }
            DrawStage::Compute => {
                type Usage = vk::BufferUsageFlags;
                let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
                let bytes = 8 * (OPTIONS.width * OPTIONS.height) as usize;
                Into::Compute(HostBuffer::new(&host, bytes, usage).unwrap())
            }
        };
        let lights = format!("k < {}", scene.lighting().lights.len());
        let copy = COPY.replace("k < 3", &lights);
        let texts = [
            ("the library's", None),
            ("a copy of it", Some(copy.as_str())),
            ("base colour alone", Some(PLAIN)),
            ("sun and three lamps (GGX), examples/forward", Some(FORWARD)),
        ];
        let mut cases = texts.map(|text| made(&device, stage, &scene, text, &set));
        if let Into::Compute(words) = &into {
            for (_, renderer) in &mut cases {
                // SAFETY: the buffer has two words per pixel, and outlives the renderers.
                unsafe { renderer.set_compute_target(target(words)) }.unwrap();
            }
        }
        let prefix = format!("{:8} ", stage.name());
        compare(&prefix, &mut cases, |n, (_, renderer)| {
            once(&host, |cmd| {
                // SAFETY: `cmd` is recording; the frame before is done; the target is the output's;
                // the set is of the renderer's layout, or is not read.
                unsafe {
                    let frame = renderer.prepare(cmd, 0, &view).unwrap();
                    let layout = renderer.pipeline_layout().unwrap();
                    let bind = |point| {
                        if n > 0 {
                            set.bind(cmd, point, layout, 3);
                        }
                    };
                    match &into {
                        Into::Pass(into) => {
                            bind(vk::PipelineBindPoint::GRAPHICS);
                            let record = || renderer.record(cmd, &frame).unwrap();
                            into.draw(cmd, &[vk::ClearColorValue::default()], false, record);
                        }
                        Into::Compute(words) => {
                            let half = 4 * u64::from(OPTIONS.width * OPTIONS.height);
                            let (raw, far) = (&host.device, 1f32.to_bits());
                            raw.cmd_fill_buffer(cmd, words.raw, 0, half, far);
                            barrier(&host, cmd, &[]);
                            bind(vk::PipelineBindPoint::COMPUTE);
                            renderer.record_compute(cmd, &frame).unwrap();
                        }
                    }
                }
            });
        });
    }
}
