//! The host of `examples/engine` for tests, opened with the validation layers and lent to the
//! library.
#![allow(unsafe_code, missing_docs, dead_code, clippy::unwrap_used)] // each crate of tests takes what it needs

#[path = "../../examples/engine/host/mod.rs"]
#[allow(dead_code, unused_imports)]
mod engine;

use ash::vk;
#[allow(unused_imports)] // each crate of tests takes what it needs
pub use engine::*;
use glam::{DMat4, Vec3};
use revmap::gpu::{
    DepthOrder, Device, HostDevice, Output, PassFormats, PassKind, Renderer, Requirements, View,
    Viewport,
};
use revmap::settings::{Planes, SearchSettings};
use std::cell::RefCell;

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
    Host::open(false, |instance, physical| {
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(instance, physical) }?;
        Ok((needs.queue_family, needs.features))
    })
    .unwrap()
}

/// A host with some of the features that the library requires.
pub fn open_with(
    some: impl Fn(vk::PhysicalDeviceFeatures) -> vk::PhysicalDeviceFeatures,
) -> Checked {
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
        instance: &host.instance,
        physical: host.physical,
        device: &host.device,
        queue_family: host.family,
        queue: Some(host.queue),
        features: host.features,
        allocator: None,
        pipeline_cache: None,
    }
}

pub fn borrow(host: &Host) -> Device {
    // SAFETY: the host's own handles; each test drops the device before the host.
    unsafe { Device::borrow(&lent(host)) }.unwrap()
}

pub fn order(options: &Options) -> DepthOrder {
    match options.reversed {
        true => DepthOrder::Reversed,
        false => DepthOrder::Normal,
    }
}

pub fn viewport(options: &Options) -> Viewport {
    Viewport {
        x: 0.0,
        y: 0.0,
        width: f64::from(options.width),
        height: f64::from(options.height),
    }
}

/// A pass by dynamic rendering, of these colours and a depth.
pub fn dynamic(color: &[vk::Format]) -> PassKind {
    PassKind::Dynamic {
        color: color.to_vec(),
        depth: DEPTH,
        stencil: vk::Format::UNDEFINED,
    }
}

/// A renderer without objects for the stage's pass.
pub fn renderer(device: &Device, stage: &Stage, search: &SearchSettings, slots: usize) -> Renderer {
    let begun = match stage.options.dynamic {
        true => dynamic(&[COLOR]),
        false => PassKind::RenderPass {
            pass: stage.pass,
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
    let renderer = RefCell::new(renderer);
    stage
        .frame(
            clip,
            Vec3::Z,
            meshes,
            // SAFETY: the stage has waited for the slot; `cmd` is recording outside of its pass.
            |cmd, slot| Ok(unsafe { renderer.borrow_mut().prepare(cmd, slot, view) }?),
            // SAFETY: the frame was prepared, the pass has the output's formats.
            |cmd, frame| Ok(unsafe { renderer.borrow().record(cmd, frame) }?),
        )
        .unwrap();
}

/// Records commands, submits them and waits.
pub fn once(host: &Host, record: impl FnOnce(vk::CommandBuffer)) {
    let device = &host.device;
    // SAFETY: everything is created here, waited for, then destroyed.
    unsafe {
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(host.family);
        let pool = device.create_command_pool(&pool, None).unwrap();
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .command_buffer_count(1);
        let cmd = device.allocate_command_buffers(&info).unwrap()[0];
        device
            .begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())
            .unwrap();
        record(cmd);
        device.end_command_buffer(cmd).unwrap();
        let all = [cmd];
        let submit = vk::SubmitInfo::default().command_buffers(&all);
        device
            .queue_submit(host.queue, &[submit], vk::Fence::null())
            .unwrap();
        device.queue_wait_idle(host.queue).unwrap();
        device.destroy_command_pool(pool, None);
    }
}
