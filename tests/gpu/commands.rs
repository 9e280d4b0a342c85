//! The commands of a frame are counted between the renderer and Vulkan. Their number follows the
//! pipelines and texture sets, whatever the number of objects and copies.

use crate::calls::{above, planted_device};
use crate::common::host::{HostBuffer, assert_silent, barrier, borrow_through, once, open};
use crate::common::prelude::*;
use std::ffi::c_void;
use std::sync::{Mutex, PoisonError};

/// Counts calls of commands and passes them on.
macro_rules! counted {
    ($($command:ident($driver:ident, $name:literal, $($parameter:ident: $of:ty),*);)*) => {
        /// Calls of each command in one frame.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        struct Counts {
            $($command: u32,)*
        }

        static COUNTS: Mutex<Option<Counts>> = Mutex::new(None);

        /// The counts since the last call.
        fn taken() -> Counts {
            COUNTS.lock().unwrap().take().unwrap_or_default()
        }

        above! { layer;
            $($name $command: $driver($($parameter: $of),*), |real| {
                COUNTS.lock().unwrap().get_or_insert_default().$command += 1;
                real($($parameter),*);
            })*
        }
    };
}

counted! {
    barriers(PFN_vkCmdPipelineBarrier, "vkCmdPipelineBarrier",
        cmd: vk::CommandBuffer, from: vk::PipelineStageFlags, to: vk::PipelineStageFlags,
        flags: vk::DependencyFlags, count: u32, memory: *const vk::MemoryBarrier,
        buffers: u32, of_buffers: *const vk::BufferMemoryBarrier,
        images: u32, of_images: *const vk::ImageMemoryBarrier);
    updates(PFN_vkCmdUpdateBuffer, "vkCmdUpdateBuffer",
        cmd: vk::CommandBuffer, buffer: vk::Buffer, at: u64, size: u64, data: *const c_void);
    fills(PFN_vkCmdFillBuffer, "vkCmdFillBuffer",
        cmd: vk::CommandBuffer, buffer: vk::Buffer, at: u64, size: u64, value: u32);
    copies(PFN_vkCmdCopyBuffer, "vkCmdCopyBuffer",
        cmd: vk::CommandBuffer, from: vk::Buffer, to: vk::Buffer, count: u32,
        regions: *const vk::BufferCopy);
    pipelines(PFN_vkCmdBindPipeline, "vkCmdBindPipeline",
        cmd: vk::CommandBuffer, point: vk::PipelineBindPoint, pipeline: vk::Pipeline);
    draws(PFN_vkCmdDraw, "vkCmdDraw",
        cmd: vk::CommandBuffer, vertices: u32, instances: u32, first: u32, first_instance: u32);
    indexed(PFN_vkCmdDrawIndexed, "vkCmdDrawIndexed",
        cmd: vk::CommandBuffer, indices: u32, instances: u32, first: u32, offset: i32,
        first_instance: u32);
    indirect(PFN_vkCmdDrawIndexedIndirect, "vkCmdDrawIndexedIndirect",
        cmd: vk::CommandBuffer, buffer: vk::Buffer, at: u64, count: u32, stride: u32);
    dispatches(PFN_vkCmdDispatch, "vkCmdDispatch",
        cmd: vk::CommandBuffer, x: u32, y: u32, z: u32);
    indirect_draws(PFN_vkCmdDrawIndirect, "vkCmdDrawIndirect",
        cmd: vk::CommandBuffer, buffer: vk::Buffer, at: u64, count: u32, stride: u32);
    indirect_dispatches(PFN_vkCmdDispatchIndirect, "vkCmdDispatchIndirect",
        cmd: vk::CommandBuffer, buffer: vk::Buffer, at: u64);
}

static ONE: Mutex<()> = Mutex::new(());

/// Upper bound on a frame's barriers: two of the off-screen target, two of copies that the device
/// places, and three of lists for tiles.
const MOST_BARRIERS: u32 = 7;

/// A square field seen from above. It has `objects` solids of one look but different sizes, and
/// `copies` of each.
fn field(objects: u32, copies: u32) -> Scene {
    let mut scene = scene_of(shapes::vase(), DVec3::new(9.0, 2.0, 9.0));
    scene.camera.target = DVec3::ZERO;
    let side = f64::from(objects * copies).sqrt().ceil() as u32;
    let place = |n: u32| {
        let at = |k: u32| 8.0 * (f64::from(k) + 0.5) / f64::from(side) - 4.0;
        scaled([at(n % side), at(n / side), 0.0], 4.0 / f64::from(side))
    };
    scene.objects = (0..objects)
        .map(|n| {
            let profile = shapes::column_of(0.3 + 0.1 * f64::from(n) / f64::from(objects));
            let mut object = Object::new(format!("solid {n}"), Arc::new(profile));
            if copies == 1 {
                object.placement = place(n);
            } else {
                let all: Vec<_> = (0..copies).map(|k| place(n * copies + k)).collect();
                object.instances = all.into();
            }
            object
        })
        .collect();
    scene
}

/// The commands of a frame whose camera has moved, and the number of pixels hit.
fn counts(device: &Device, scene: &Scene, stage: DrawStage) -> (Counts, usize) {
    let settings = Settings {
        width: 160,
        height: 120,
        stage,
        planes: Planes::Color,
        // Compute lists patches in pictures as small as these, too.
        proxy_min_pixels: match stage {
            DrawStage::Fragment => Settings::exact().proxy_min_pixels,
            DrawStage::Compute => 0,
        },
        tolerance: Tolerance::EXACT,
        ..Settings::default()
    };
    let mut scene = scene.clone();
    let mut drawn = Offscreen::new(device, &scene, &settings).unwrap();
    for _ in 0..2 {
        scene.camera.eye.x += 0.01;
        drawn.update(&scene).unwrap();
        drawn.draw().unwrap();
    }
    scene.camera.eye.x += 0.01;
    drawn.update(&scene).unwrap();
    taken();
    drawn.draw().unwrap();
    let counts = taken();
    let frame = drawn.read().unwrap();
    let shown = frame.color.iter().filter(|c| c[3] > 0.0).count();
    (counts, shown)
}

#[test]
fn commands_follow_pipelines() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let host = open();
    let raw = planted_device(&host.instance, &host.device, layer);
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let all = |c: &Counts| {
        let draws = c.draws + c.indexed + c.indirect + c.indirect_draws;
        c.barriers + c.fills + c.pipelines + draws + c.dispatches + c.indirect_dispatches
    };
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let of = |objects, copies| {
            let (counts, shown) = counts(&device, &field(objects, copies), stage);
            println!("{stage:?}, {objects} objects of {copies} copies: {counts:?}");
            assert!(shown > 1000, "{shown} pixels");
            assert!(counts.barriers <= MOST_BARRIERS, "{counts:?}");
            assert_eq!((counts.updates, counts.copies), (0, 0), "{counts:?}");
            counts
        };
        of(1, 1);
        // Both stages walk.
        let several = of(65, 1);
        for objects in [200, 1000] {
            assert_eq!(of(objects, 1), several);
        }
        let (some, many) = (of(1, 100), of(1, 10_000));
        assert!(all(&many) <= all(&some), "{some:?}, {many:?}");
        // One copy beyond the limit for proxies must not cause a jump in commands.
        let (below, above) = (of(1, 64), of(1, 65));
        let step = all(&below).abs_diff(all(&above));
        assert!(step <= 4, "{below:?}, {above:?}");
    }
    drop(device);
    assert_silent(&host);
}

/// An update recorded through the layer is counted and takes effect in the buffer.
#[test]
fn an_update_is_noticed() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let host = open();
    let raw = planted_device(&host.instance, &host.device, layer);
    let words = HostBuffer::of(&host, &[0u32; 4], vk::BufferUsageFlags::TRANSFER_DST).unwrap();
    taken();
    once(&host, |cmd| {
        // SAFETY: `cmd` is recording outside of a pass; the buffer outlives it.
        unsafe {
            raw.cmd_update_buffer(cmd, words.raw, 0, &7u32.to_le_bytes());
            barrier(&host, cmd, &[]);
        }
    });
    assert_eq!(taken().updates, 1);
    assert_eq!(words.bytes()[..4], 7u32.to_le_bytes());
    drop(words);
    assert_silent(&host);
}
