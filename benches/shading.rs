//! The cost of a host's function of shading. A round draws a frame by each function: the library's,
//! a copy of it, a constant, and that of `examples/forward`. The bench prints milliseconds and the
//! ratio to the library's. `cargo bench --features shaderc --bench shading`.
#![allow(unsafe_code, clippy::unwrap_used)]

#[path = "../tests/common/host.rs"]
#[allow(unused_imports)]
mod host;

use ash::vk;
use glam::DVec3;
use host::attachments::Attachments;
use host::memory::HostBuffer;
use host::set::UniformSet;
use host::{Host, Options, borrow, dynamic, open_unchecked};
use revmap::gpu::{ComputeTarget, Device, HostShading, Output, PassFormats, Renderer, View};
use revmap::scene::{Camera, Scene};
use revmap::settings::{DrawStage, Planes, SearchSettings};
use revmap::shading::Shading;
use std::sync::Arc;
use std::time::Instant;

const OPTIONS: Options = Options {
    width: 800,
    height: 600,
    dynamic: true,
    samples: 1,
    reversed: false,
};
const ROUNDS: usize = 41;
const COPY: &str = include_str!("../tests/common/copy.glsl");
const PLAIN: &str = "vec4 host_shade(Surface s) { return vec4(s.base_color, 1.0); }\n";
const FORWARD: &str = include_str!("../examples/forward/shade.glsl");
const LIGHT: &str = include_str!("../examples/forward/light.glsl");

/// A renderer and the milliseconds of its frames.
struct Case {
    name: &'static str,
    renderer: Renderer,
    times: Vec<f64>,
}

/// What all frames of a stage draw into.
enum Into<'a> {
    Pass(Attachments<'a>),
    Compute(HostBuffer<'a>),
}

fn made(
    device: &Device,
    stage: DrawStage,
    scene: &Scene,
    (name, text): (&'static str, Option<&str>),
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
    renderer.set_lighting(&scene.lighting()).unwrap();
    for object in &scene.objects {
        renderer.add(object.clone()).unwrap();
    }
    Case {
        name,
        renderer,
        times: Vec::new(),
    }
}

impl Case {
    fn frame(&mut self, host: &Host, view: &View, into: &Into, set: &UniformSet) {
        let begin = Instant::now();
        host::once(host, |cmd| {
            // SAFETY: `cmd` is recording; the frame before is done; the target is the output's; the
            // set is of the renderer's layout, or is not read.
            unsafe {
                let frame = self.renderer.prepare(cmd, 0, view).unwrap();
                let layout = self.renderer.pipeline_layout().unwrap();
                let bind = |point| {
                    if self.name != "the library's" {
                        set.bind(cmd, point, layout, 3);
                    }
                };
                match into {
                    Into::Pass(into) => {
                        bind(vk::PipelineBindPoint::GRAPHICS);
                        let record = || self.renderer.record(cmd, &frame).unwrap();
                        into.draw(cmd, &[vk::ClearColorValue::default()], false, record);
                    }
                    Into::Compute(words) => {
                        let half = 4 * u64::from(OPTIONS.width * OPTIONS.height);
                        let raw = &host.device;
                        raw.cmd_fill_buffer(cmd, words.raw, 0, half, 1f32.to_bits());
                        let written = [vk::MemoryBarrier::default()
                            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                            .dst_access_mask(vk::AccessFlags::SHADER_READ)];
                        let all = vk::PipelineStageFlags::ALL_COMMANDS;
                        let none = vk::DependencyFlags::empty();
                        raw.cmd_pipeline_barrier(cmd, all, all, none, &written, &[], &[]);
                        bind(vk::PipelineBindPoint::COMPUTE);
                        self.renderer.record_compute(cmd, &frame).unwrap();
                    }
                }
            }
        });
        self.times.push(1e3 * begin.elapsed().as_secs_f64());
    }
}

fn main() {
    let host = open_unchecked();
    let device = borrow(&host);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/bishop.toml");
    let mut scene = revmap_files::scene(path).unwrap();
    scene.camera = Camera::new(DVec3::new(1.6, 0.5, 1.0), DVec3::new(0.0, 0.0, 0.5));
    let size = (OPTIONS.width, OPTIONS.height);
    let view = View::from_camera(&scene.camera, size, [0.1, 50.0]).unwrap();
    let set = UniformSet::of(&host, &[[0.5f32; 4]; 10]).unwrap();
    println!("{}, 800x600, {ROUNDS} rounds", device.report().name);
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let into = match stage {
            DrawStage::Fragment => {
                let formats = [(vk::Format::R8G8B8A8_SRGB, 4)];
                Into::Pass(Attachments::new(&host, OPTIONS, &formats).unwrap())
            }
            DrawStage::Compute => {
                type Usage = vk::BufferUsageFlags;
                let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
                let bytes = 8 * (size.0 * size.1) as usize;
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
            for case in &mut cases {
                let target = ComputeTarget {
                    words: words.raw,
                    images: Vec::new(),
                    depths: true,
                };
                // SAFETY: the buffer has two words per pixel, and outlives the renderers.
                unsafe { case.renderer.set_compute_target(target) }.unwrap();
            }
        }
        for _ in 0..ROUNDS {
            let frame = |case: &mut Case| case.frame(&host, &view, &into, &set);
            cases.iter_mut().for_each(frame);
        }
        report(stage, &cases);
    }
}

/// Medians of times, and of ratios to the first case.
fn report(stage: DrawStage, cases: &[Case]) {
    let median = |mut all: Vec<f64>| {
        all.sort_unstable_by(f64::total_cmp);
        all[all.len() / 2]
    };
    for case in cases {
        let times = &case.times[1..];
        let ratios = times.iter().zip(&cases[0].times[1..]).map(|(a, b)| a / b);
        let (ratio, time) = (median(ratios.collect()), median(times.to_vec()));
        println!("{:8} {time:6.2} ms {ratio:5.2} {}", stage.name(), case.name);
    }
}
