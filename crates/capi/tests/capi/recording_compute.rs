//! Recording through the C interface in compute: what the Rust renderer draws.

use crate::host::{Host, Stage, open};
use crate::recording::{OPTIONS, RANGE, add, camera, lend, ok, scene};
use ash::vk;
use glam::{DMat4, Vec3};
use revmap::gpu::{Device, Offscreen};
use revmap::settings::{DrawStage, Planes, Settings};
use revmap_capi::device::*;
use revmap_capi::enums::*;
use revmap_capi::fault::*;
use revmap_capi::renderer::frame::*;
use revmap_capi::renderer::statistics::*;
use revmap_capi::renderer::*;
use revmap_files::Picture;
use std::mem::zeroed;
use std::ptr::{null, null_mut};

/// Words for compute, which the host maps.
struct Words<'a> {
    raw: vk::Buffer,
    memory: vk::DeviceMemory,
    host: &'a Host,
}

const PIXELS: usize = (OPTIONS.width * OPTIONS.height) as usize;

impl<'a> Words<'a> {
    fn new(host: &'a Host) -> Self {
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let info = vk::BufferCreateInfo::default()
                .size(8 * PIXELS as u64)
                .usage(vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST);
            let raw = host.device.create_buffer(&info, None).unwrap();
            let needs = host.device.get_buffer_memory_requirements(raw);
            let mapped =
                vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let memory = host.memory(needs, mapped).unwrap();
            host.device.bind_buffer_memory(raw, memory, 0).unwrap();
            Self { raw, memory, host }
        }
    }

    /// Clears depths and colours, for compute shaders.
    fn clear(&self, cmd: vk::CommandBuffer, color: u32) {
        let device = &self.host.device;
        let (half, bytes) = (4 * PIXELS as u64, vk::WHOLE_SIZE);
        let barrier = |from, to| {
            vk::MemoryBarrier::default()
                .src_access_mask(from)
                .dst_access_mask(to)
        };
        let (compute, copy) = (
            vk::PipelineStageFlags::COMPUTE_SHADER,
            vk::PipelineStageFlags::TRANSFER,
        );
        let shader = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
        let (none, write) = (
            vk::DependencyFlags::empty(),
            vk::AccessFlags::TRANSFER_WRITE,
        );
        // SAFETY: `cmd` is recording outside of a pass.
        unsafe {
            device.cmd_pipeline_barrier(
                cmd,
                compute,
                copy,
                none,
                &[barrier(shader, write)],
                &[],
                &[],
            );
            device.cmd_fill_buffer(cmd, self.raw, 0, half, 1f32.to_bits());
            device.cmd_fill_buffer(cmd, self.raw, half, bytes, color);
            device.cmd_pipeline_barrier(
                cmd,
                copy,
                compute,
                none,
                &[barrier(write, shader)],
                &[],
                &[],
            );
        }
    }

    /// Makes what compute wrote visible to the host.
    fn finish(&self, cmd: vk::CommandBuffer) {
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        let (compute, host) = (
            vk::PipelineStageFlags::COMPUTE_SHADER,
            vk::PipelineStageFlags::HOST,
        );
        let none = vk::DependencyFlags::empty();
        // SAFETY: `cmd` is recording outside of a pass.
        unsafe {
            self.host
                .device
                .cmd_pipeline_barrier(cmd, compute, host, none, &[barrier], &[], &[])
        };
    }

    fn colors(&self) -> Vec<[u8; 4]> {
        let flags = vk::MemoryMapFlags::empty();
        // SAFETY: the device is done; the mapping holds all words.
        unsafe {
            let at = self
                .host
                .device
                .map_memory(self.memory, 0, vk::WHOLE_SIZE, flags)
                .unwrap();
            let words = std::slice::from_raw_parts(at.cast::<[u8; 4]>(), 2 * PIXELS);
            let colors = words[PIXELS..].to_vec();
            self.host.device.unmap_memory(self.memory);
            colors
        }
    }
}

impl Drop for Words<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe {
            self.host.device.destroy_buffer(self.raw, None);
            self.host.device.free_memory(self.memory, None);
        }
    }
}

const BACKGROUND: [f32; 4] = [0.05, 0.2, 0.6, 0.5];

#[test]
fn compute_writes_what_rust_draws() {
    let host = open();
    let mut stage = Stage::new(&host, OPTIONS).unwrap();
    let (device, camera, words) = (lend(&host), camera(), Words::new(&host));
    let mut renderer = null_mut();
    // SAFETY: live values; the stage has waited for a slot before it is prepared; the words live
    // until it is idle.
    unsafe {
        ok(revmap_renderer_create_compute(
            device,
            RevmapPlanes::Color as u32,
            null(),
            2,
            &mut renderer,
        ));
        add(renderer);
        let mut target: RevmapComputeTarget = zeroed();
        target.size = size_of::<RevmapComputeTarget>() as u32;
        target.words = words.raw;
        ok(revmap_renderer_set_compute_target(renderer, &target));
        for _ in 0..3 {
            let before = |cmd, slot: usize| {
                let (slot, w, h, [near, far]) = (slot as u32, OPTIONS.width, OPTIONS.height, RANGE);
                ok(revmap_renderer_prepare_camera(
                    renderer, cmd, slot, &camera, w, h, near, far,
                ));
                let [r, g, b, a] = BACKGROUND;
                words.clear(cmd, revmap_color_word(r, g, b, a));
                assert_eq!(
                    revmap_renderer_record(renderer, cmd, slot),
                    RevmapResult::Usage
                );
                ok(revmap_renderer_record_compute(renderer, cmd, slot));
                words.finish(cmd);
                Ok(())
            };
            stage
                .frame(DMat4::IDENTITY, Vec3::Z, &[], before, |_, _| Ok(()))
                .unwrap();
        }
        stage.wait().unwrap();
        let mut statistics: RevmapStatistics = zeroed();
        statistics.size = size_of::<RevmapStatistics>() as u32;
        ok(revmap_renderer_statistics(renderer, &mut statistics));
        assert_eq!((statistics.objects, statistics.drawn_by_hull), (2, 0));
        let drawn = statistics.drawn_by_tiles;
        assert_eq!(drawn, 2);
        ok(revmap_renderer_destroy(renderer));
        ok(revmap_device_destroy(device));
    }
    let settings = Settings {
        width: OPTIONS.width,
        height: OPTIONS.height,
        stage: DrawStage::Compute,
        planes: Planes::Color,
        ..Settings::default()
    };
    let own = Device::open_validated(None).unwrap();
    let mut scene = scene();
    scene.background = BACKGROUND;
    let mut offscreen = Offscreen::new(&own, &scene, &settings).unwrap();
    offscreen.draw().unwrap();
    let wanted = Picture::of(&offscreen.read().unwrap()).rgba;
    assert!(words.colors() == wanted, "pixels differ");
    assert!(wanted.iter().filter(|p| p[3] == 255).count() > 3000);
    drop((stage, words));
    let messages = host.take_messages();
    assert!(messages.is_empty(), "{messages:?}");
}
