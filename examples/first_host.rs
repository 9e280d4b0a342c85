//! A first host: a pawn into a buffer, by the host's own command buffer and submission.
#![allow(unsafe_code)]
use ash::vk;
use glam::DVec3;
use gpu_allocator::MemoryLocation;
use revmap::gpu::{ComputeTarget, Device, Output, Renderer, View, vulkan_error};
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::{Planes, SearchSettings};
use revmap_files::ProfileAxis;

const SIZE: (u32, u32) = (640, 480);

/// Draws one frame; a host that shows frames goes through the second half for each.
pub fn frame() -> revmap::Result<Vec<[u8; 4]>> {
    let device = Device::open(None)?; // An engine lends its own: Device::borrow
    let settings = SearchSettings::default();
    let mut renderer = Renderer::new(&device, Output::Compute(Planes::Color), &settings, 1)?;
    let profile = revmap_files::profile("assets/profiles/pawn.svg", ProfileAxis::Center)?;
    renderer.add(Object::new("pawn", profile.into()))?;
    // Two words a pixel: depths, then colours. An engine lends images, or has a pass.
    let (pixels, usage) = (
        u64::from(SIZE.0 * SIZE.1),
        vk::BufferUsageFlags::STORAGE_BUFFER,
    );
    let mut words = device.buffer("words", 8 * pixels, usage, MemoryLocation::GpuToCpu)?;
    words.mapped()?.fill(0xff); // a white background
    let target = ComputeTarget {
        words: words.raw,
        images: Vec::new(),
        depths: false,
    };
    // SAFETY: the buffer outlives the renderer's frames, and has the size of the view.
    unsafe { renderer.set_compute_target(target) }?;
    let raw = device.raw();
    let failed = |code| vulkan_error("a call of the host", code);
    let info = vk::CommandPoolCreateInfo::default().queue_family_index(device.queue_family());
    // SAFETY: handles are live, and the commands are waited for before anything is dropped.
    unsafe {
        let pool = raw.create_command_pool(&info, None).map_err(failed)?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool);
        let cmd = raw
            .allocate_command_buffers(&info.command_buffer_count(1))
            .map_err(failed)?[0];
        // Each frame: prepare outside of a pass, record inside one, or where dispatches may be.
        let scene = Scene::new(Camera::new(
            DVec3::new(1.6, 0.3, 1.1),
            DVec3::new(0.0, 0.0, 0.5),
        ));
        let view = View::of_scene(&scene, SIZE)?;
        raw.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())
            .map_err(failed)?;
        let frame = renderer.prepare(cmd, 0, &view)?;
        renderer.record_compute(cmd, &frame)?;
        let written = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        let (from, to) = (
            vk::PipelineStageFlags::COMPUTE_SHADER,
            vk::PipelineStageFlags::HOST,
        );
        let none = vk::DependencyFlags::empty();
        raw.cmd_pipeline_barrier(cmd, from, to, none, &[written], &[], &[]);
        raw.end_command_buffer(cmd).map_err(failed)?;
        let (queue, cmds) = (raw.get_device_queue(device.queue_family(), 0), [cmd]);
        let submits = [vk::SubmitInfo::default().command_buffers(&cmds)];
        raw.queue_submit(queue, &submits, vk::Fence::null())
            .map_err(failed)?;
        raw.queue_wait_idle(queue).map_err(failed)?;
        raw.destroy_command_pool(pool, None);
    }
    let colors = &words.mapped()?[4 * pixels as usize..];
    Ok(colors.as_chunks().0.to_vec()) // sRGB with alpha
}

fn main() -> revmap::Result<()> {
    let (width, height) = SIZE;
    let rgba = frame()?;
    revmap_files::Picture {
        width,
        height,
        rgba,
    }
    .write_png("pawn.png")
}
