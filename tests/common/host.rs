//! The host of `examples/host` for tests, opened with the validation layers and lent to the library.
#![allow(unsafe_code, missing_docs, dead_code, clippy::unwrap_used)] // each crate of tests takes what it needs

#[path = "canvas.rs"]
pub mod canvas;
#[path = "../../examples/host/mod.rs"]
mod engine;

use ash::vk;
#[allow(unused_imports)] // each crate of tests takes what it needs
pub use canvas::{Canvas, Drawn, Picture};
#[allow(unused_imports)]
pub use engine::{lend::*, memory::*, set::UniformSet, *};
use glam::{DMat4, Vec3};
use revmap::gpu::{
    ComputeTarget, DepthOrder, Device, HostDevice, HostPass, ObjectId, Output, PassFormats,
    PassKind, PreparedFrame, Renderer, Requirements, View,
};
use revmap::scene::Scene;
use revmap::settings::{Planes, SearchSettings};
use std::sync::OnceLock;

/// A host that fails its test if the layers have reported a message by its end.
pub struct Checked(Host);

impl std::ops::Deref for Checked {
    type Target = Host;

    fn deref(&self) -> &Host {
        &self.0
    }
}

impl Drop for Checked {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            assert_silent(self);
        }
    }
}

#[track_caller]
pub fn assert_silent(host: &Host) {
    let messages = host.take_messages();
    assert!(messages.is_empty(), "{messages:?}");
}

/// A host with everything that the library requires.
pub fn open() -> Checked {
    open_with(|features| features)
}

/// A host without validation, for measurements.
pub fn open_unchecked() -> Host {
    engine::lend::open(".", false).unwrap()
}

/// Holds an instance, and so the driver, until the process ends. NVIDIA's driver 580 fails to load
/// after some dozens of times.
fn keep_driver() {
    static KEPT: OnceLock<(ash::Entry, ash::Instance)> = OnceLock::new();
    KEPT.get_or_init(|| {
        // SAFETY: the loader is sound, and outlives the instance.
        let entry = unsafe { ash::Entry::load() }.unwrap();
        // SAFETY: an instance without layers or extensions.
        let instance = unsafe { entry.create_instance(&Default::default(), None) }.unwrap();
        (entry, instance)
    });
}

/// A host with some of the features that the library requires.
pub fn open_with(
    some: impl Fn(vk::PhysicalDeviceFeatures) -> vk::PhysicalDeviceFeatures,
) -> Checked {
    keep_driver();
    let host = Host::open(true, |instance, physical| {
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(instance, physical) }?;
        Ok((needs.queue_family, some(needs.features)))
    });
    Checked(host.unwrap())
}

/// The host's device and queue, to be borrowed.
pub fn lent(host: &Host) -> HostDevice<'_> {
    HostDevice {
        queue: Some(host.queue),
        ..engine::lend::lent(host)
    }
}

/// A host, and its device as one of its own: other tests compile on theirs.
pub fn opened() -> (Checked, Device) {
    let host = open();
    let device = borrow(&host);
    (host, device)
}

pub fn borrow(host: &Host) -> Device {
    // SAFETY: the host's own handles; each test drops the device before the host.
    unsafe { Device::borrow(&lent(host)) }.unwrap()
}

/// The same through layers of a test above the instance and the device.
pub fn borrow_through(
    host: &Host,
    instance: &ash::Instance,
    device: &ash::Device,
) -> revmap::Result<Device> {
    let planted = HostDevice {
        instance,
        device,
        ..lent(host)
    };
    // SAFETY: as in `borrow`; the layers have the functions of the host's own.
    unsafe { Device::borrow(&planted) }
}

/// A pass of colours and depth by dynamic rendering.
pub fn color_pass() -> PassFormats {
    PassFormats::new(dynamic(&[COLOR]), Planes::Color)
}

/// Adds lights and objects of a scene.
pub fn add(renderer: &mut Renderer, scene: &Scene) -> Vec<ObjectId> {
    renderer.set_lighting(&scene.lighting()).unwrap();
    let objects = scene.objects.iter();
    objects.map(|o| renderer.add(o.clone()).unwrap()).collect()
}

/// A renderer of a scene, with its own number of slots.
pub fn renderer_of(
    device: &Device,
    output: Output,
    search: &SearchSettings,
    slots: usize,
    scene: &Scene,
) -> Renderer {
    let mut renderer = Renderer::new(device, output, search, slots).unwrap();
    add(&mut renderer, scene);
    renderer
}

/// The view of a scene's camera.
pub fn view_of(scene: &Scene, options: &Options) -> View {
    View::from_camera(&scene.camera, (options.width, options.height), [0.1, 50.0]).unwrap()
}

/// A renderer without objects for the stage's pass.
pub fn renderer(device: &Device, stage: &Stage, search: &SearchSettings, slots: usize) -> Renderer {
    let begun = match stage.options.dynamic {
        true => dynamic(&[COLOR]),
        false => PassKind::RenderPass {
            // SAFETY: tests drop renderers and prewarms before their stage.
            pass: unsafe { HostPass::new(stage.into.pass) },
            subpass: 0,
        },
    };
    let output = Output::Pass(PassFormats {
        samples: stage.options.samples,
        depth: order(&stage.options),
        ..PassFormats::new(begun, Planes::Color)
    });
    Renderer::new(device, output, search, slots).unwrap()
}

/// Draws one frame of the host.
pub fn frame(
    stage: &mut Stage,
    renderer: &mut Renderer,
    view: &View,
    clip: DMat4,
    meshes: &[Mesh],
) {
    engine::lend::frame(stage, renderer, view, (clip, Vec3::Z), meshes).unwrap();
}

/// A texture of one level, and a sampler that repeats around the axis, as the library's does.
pub struct Texture<'a> {
    pub sampler: vk::Sampler,
    pub memory: HostImage<'a>,
    host: &'a Host,
}

impl<'a> Texture<'a> {
    /// A square texture.
    pub fn new(host: &'a Host, format: vk::Format, texels: &[[u8; 4]]) -> Self {
        let side = texels.len().isqrt() as u32;
        let size = Options::new(side, side);
        type Usage = vk::ImageUsageFlags;
        let usage = Usage::SAMPLED | Usage::TRANSFER_DST;
        let memory = HostImage::new(host, &size, format, 1, usage).unwrap();
        let from = HostBuffer::of(host, texels, vk::BufferUsageFlags::TRANSFER_SRC).unwrap();
        let to = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let read = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        once(host, |cmd| {
            // SAFETY: `cmd` is recording; the buffer outlives the submission.
            unsafe {
                barrier(host, cmd, &[memory.barrier(vk::ImageLayout::UNDEFINED, to)]);
                let region = [memory.region(&size)];
                (host.device).cmd_copy_buffer_to_image(cmd, from.raw, memory.raw, to, &region);
                barrier(host, cmd, &[memory.barrier(to, read)]);
            }
        });
        let info = vk::SamplerCreateInfo::default()
            .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .mag_filter(vk::Filter::LINEAR)
            .min_filter(vk::Filter::LINEAR);
        // SAFETY: a plain creation, destroyed in Drop.
        let sampler = unsafe { host.device.create_sampler(&info, None) }.unwrap();
        Self {
            sampler,
            memory,
            host,
        }
    }

    pub fn image(&self) -> revmap::gpu::HostImage {
        // SAFETY: tests drop textures after renderers, or when they are held no more.
        unsafe { revmap::gpu::HostImage::new(self.memory.view, self.sampler) }.unwrap()
    }
}

impl Drop for Texture<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe { self.host.device.destroy_sampler(self.sampler, None) };
    }
}

/// Records commands, submits them and waits.
pub fn once<T>(host: &Host, record: impl FnOnce(vk::CommandBuffer) -> T) -> T {
    commands(host, true, record).unwrap()
}

/// Records commands and drops them.
pub fn never<T>(host: &Host, record: impl FnOnce(vk::CommandBuffer) -> T) -> T {
    commands(host, false, record).unwrap()
}
