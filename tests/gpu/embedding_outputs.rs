//! Outputs of a host other than a colour picture with depth: depth-only passes for its shadow maps,
//! and compute into its own buffer.
#![allow(unsafe_code)]

use crate::common::host::memory::{HostBuffer, HostImage};
use crate::common::host::{self, Host, borrow, dynamic, once, open, viewport};
use crate::common::{in_compute, next_frame, scene_of, shapes, sized};
use crate::embedding::{BACKGROUND, options, three, upright};
use ash::vk;
use glam::{DMat4, DVec3, DVec4};
use revmap::gpu::{
    ComputeTarget, DepthOrder, Device, DrawPath, Offscreen, Output, PassFormats, Renderer, View,
};
use revmap::scene::{Clip, Scene};
use revmap::settings::{Planes, SearchSettings, Settings};
use revmap_files::Picture;
use revmap_searches::CIRCLE;

pub fn barrier(host: &Host, cmd: vk::CommandBuffer) {
    let access = vk::AccessFlags::MEMORY_WRITE | vk::AccessFlags::MEMORY_READ;
    let barrier = [vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
        .dst_access_mask(access)];
    let (all, none) = (
        vk::PipelineStageFlags::ALL_COMMANDS,
        vk::DependencyFlags::empty(),
    );
    let device = &host.device;
    // SAFETY: `cmd` is recording outside of a pass.
    unsafe { device.cmd_pipeline_barrier(cmd, all, all, none, &barrier, &[], &[]) };
}

/// A view by these matrices, for the host's pictures.
fn seen(view: DMat4, projection: DMat4) -> View {
    View::from_matrices(view, projection, viewport(&options()), DepthOrder::Normal).unwrap()
}

/// A pass without colour attachments.
fn depth_pass(planes: Planes) -> Output {
    Output::Pass(PassFormats::new(dynamic(&[]), planes))
}

/// Depths of a scene, drawn into a host's shadow map.
fn depths(
    host: &Host,
    device: &Device,
    scene: &Scene,
    view: &View,
    settings: &SearchSettings,
    parallel: bool,
) -> Vec<f32> {
    let (width, height) = (options().width, options().height);
    let image = HostImage::new(host, &options(), host::DEPTH, 1).unwrap();
    let bytes = 4 * (width * height) as usize;
    let read = HostBuffer::new(host, bytes, vk::BufferUsageFlags::TRANSFER_DST).unwrap();
    let output = depth_pass(Planes::Depth { parallel });
    let mut renderer = Renderer::new(device, output, settings, 1).unwrap();
    for object in &scene.objects {
        renderer.add(object.clone()).unwrap();
    }
    let raw = &host.device;
    let area = vk::Rect2D::default().extent(options().extent());
    let to_layout = |cmd, from, to| {
        let change = [image.barrier(from, to)];
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let none = vk::DependencyFlags::empty();
        // SAFETY: `cmd` is recording outside of a pass.
        unsafe { raw.cmd_pipeline_barrier(cmd, all, all, none, &[], &[], &change) };
    };
    type Layout = vk::ImageLayout;
    once(host, |cmd| {
        // SAFETY: `cmd` is recording; nothing was submitted for the slot before; the pass has the
        // output's formats.
        unsafe {
            let frame = renderer.prepare(cmd, 0, view).unwrap();
            let by_hulls = renderer.draw_paths().iter().all(|p| *p == DrawPath::Cells);
            assert!(by_hulls || settings.proxy_min_pixels > 0, "not by hulls");
            to_layout(cmd, Layout::UNDEFINED, Layout::DEPTH_ATTACHMENT_OPTIMAL);
            let depth = vk::RenderingAttachmentInfo::default()
                .image_view(image.view)
                .image_layout(Layout::DEPTH_ATTACHMENT_OPTIMAL)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(vk::ClearValue {
                    depth_stencil: vk::ClearDepthStencilValue {
                        depth: 1.0,
                        stencil: 0,
                    },
                });
            let info = vk::RenderingInfo::default()
                .render_area(area)
                .layer_count(1)
                .depth_attachment(&depth);
            raw.cmd_begin_rendering(cmd, &info);
            let seen = vk::Viewport {
                width: width as f32,
                height: height as f32,
                max_depth: 1.0,
                ..Default::default()
            };
            raw.cmd_set_viewport(cmd, 0, &[seen]);
            raw.cmd_set_scissor(cmd, 0, &[area]);
            renderer.record(cmd, &frame).unwrap();
            raw.cmd_end_rendering(cmd);
            let to = Layout::TRANSFER_SRC_OPTIMAL;
            to_layout(cmd, Layout::DEPTH_ATTACHMENT_OPTIMAL, to);
            let copy = image.region(&options());
            raw.cmd_copy_image_to_buffer(cmd, image.raw, to, read.raw, &[copy]);
            barrier(host, cmd);
        }
    });
    bytemuck::pod_collect_to_vec(&read.bytes())
}

/// A light's view: a depth-only pass equals the depth of a colour picture bit for bit. Its depth
/// along parallel rays is the analytic depth.
#[test]
fn depth_alone_is_a_pictures_depth() {
    let host = open();
    let device = borrow(&host);
    let scene = three();
    let (eye, target) = (scene.camera.eye, scene.camera.target);
    let [view, projection] = host::view_and_projection(eye, target, &options());
    let light = seen(view, projection);
    let exact = SearchSettings::exact();
    let alone = depths(&host, &device, &scene, &light, &exact, false);
    let beside = crate::embedding::drawn(&host, &device, options(), &scene, &light).1;
    let hits = alone.iter().filter(|d| **d < 1.0).count();
    assert!(hits > 3000, "{hits}");
    assert!(alone == beside, "depths differ");

    let wide = 0.3;
    let one = scene_of(shapes::column_of(wide), eye);
    let from = DVec3::new(2.0, 1.0, 2.5);
    let view = host::view_and_projection(from, DVec3::new(0.0, 0.0, 0.5), &options())[0];
    let projection = parallel();
    let light = seen(view, projection);
    let found = depths(&host, &device, &one, &light, &exact, true);
    let back = (projection * view).inverse();
    let (width, height) = (options().width as usize, options().height as usize);
    let (mut hits, mut wrong, mut worst) = (0, 0, 0.0f64);
    for (n, &depth) in found.iter().enumerate() {
        let at = |size: usize, k: usize| 2.0 * (k as f64 + 0.5) / size as f64 - 1.0;
        let (x, y) = (at(width, n % width), at(height, n / width));
        let [near, far] = [0.0, 1.0].map(|z| back.project_point3(DVec3::new(x, y, z)));
        // `t` is the depth itself: 0 in the near plane, 1 in the far plane.
        let t = upright(near, far - near, wide);
        if t.is_finite() && depth < 1.0 {
            hits += 1;
            worst = worst.max((f64::from(depth) - t).abs());
        } else {
            wrong += usize::from(t.is_finite() != (depth < 1.0));
        }
    }
    println!("parallel: {hits} hits, {wrong} wrong, depth {worst:e}");
    assert!(hits > 3000 && wrong <= 2, "{hits} hits, {wrong} wrong");
    assert!(worst <= 2f64.powi(-20), "{worst:e}");
}

/// A bias shifts the depth of every hit, and nothing else.
#[test]
fn a_bias_shifts_depths() {
    let host = open();
    let device = borrow(&host);
    let scene = three();
    let (eye, target) = (scene.camera.eye, scene.camera.target);
    let [view, projection] = host::view_and_projection(eye, target, &options());
    let light = seen(view, projection);
    let exact = SearchSettings::exact();
    let [plain, shifted] = [light, light.with_depth_bias(1e-3)]
        .map(|light| depths(&host, &device, &scene, &light, &exact, false));
    let mut hits = 0;
    for (a, b) in plain.iter().zip(&shifted).filter(|(a, _)| **a < 1.0) {
        assert!((b - a - 1e-3).abs() < 2e-7, "{a} {b}");
        hits += 1;
    }
    assert!(hits > 3000, "{hits}");
}

/// A projection of parallel rays.
fn parallel() -> DMat4 {
    let (near, far) = (0.5, 6.0);
    DMat4::from_cols(
        DVec4::new(1.0 / 0.8, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -1.0 / 0.6, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -1.0 / (far - near), 0.0),
        DVec4::new(0.0, 0.0, -near / (far - near), 1.0),
    )
}

/// Depth-only passes over solids cut by their box give the same depth by hulls and sides as by
/// boxes.
#[test]
fn depth_alone_of_what_the_box_cuts() {
    let host = open();
    let device = borrow(&host);
    let by = |proxy_min_pixels| SearchSettings {
        proxy_min_pixels,
        ..SearchSettings::exact()
    };
    for (name, profile) in shapes::all() {
        for (extend, from) in [
            (0.12, DVec3::new(2.0, 1.0, 2.5)),
            (0.3, DVec3::new(-1.5, 2.5, 0.6)),
            (0.3, DVec3::new(2.8, 0.1, 0.5)),
        ] {
            let mut scene = scene_of(profile.clone(), from);
            let object = &mut scene.objects[0];
            object.clip = Clip::Box;
            object.offset.extend = extend;
            object.axis = [0.45, 0.5];
            let [view, projection] =
                host::view_and_projection(from, DVec3::new(0.0, 0.0, 0.5), &options());
            for (is_parallel, projection) in [(false, projection), (true, parallel())] {
                let light = seen(view, projection);
                let of = |least| depths(&host, &device, &scene, &light, &by(least), is_parallel);
                let (hulls, boxes) = (of(0), of(u32::MAX));
                let hits = boxes.iter().filter(|d| **d < 1.0).count();
                let pairs = || hulls.iter().zip(&boxes);
                let alone = pairs().filter(|(a, b)| (**a < 1.0) != (**b < 1.0)).count();
                let apart = pairs()
                    .filter(|(a, b)| **a < 1.0 && **b < 1.0 && (**a - **b).abs() > 1e-4)
                    .count();
                println!("{name} {extend} {is_parallel}: {alone} + {apart} of {hits}");
                assert!(
                    hits > 1000 && alone + apart <= 2,
                    "{name} with {extend} from {from}, parallel {is_parallel}: {alone} + {apart} of {hits}"
                );
            }
        }
    }
}

/// A buffer of two words a pixel as the target of compute.
pub fn target(words: &HostBuffer) -> ComputeTarget {
    ComputeTarget {
        words: words.raw,
        images: Vec::new(),
        depths: true,
    }
}

/// Compute into a host's buffer gives the off-screen picture in cleared pixels. Nearer values
/// already in the buffer are kept.
#[test]
fn compute_writes_to_a_hosts_buffer() {
    let host = open();
    let device = borrow(&host);
    let scene = three();
    let (width, height) = (options().width, options().height);
    let settings = Settings {
        planes: Planes::Color,
        ..in_compute(sized(width, height))
    };
    let mut offscreen = Offscreen::new(&device, &scene, &settings).unwrap();
    let wanted = Picture::of(&next_frame(&mut offscreen)).rgba;
    let pixels = (width * height) as usize;
    let nearer = 0x0102_0304u32;
    // The left half is empty; the right half already holds a nearer depth.
    let is_empty = |n: usize| n % (width as usize) < width as usize / 2;
    let mut words: Vec<u32> = (0..pixels)
        .map(|n| if is_empty(n) { 1f32.to_bits() } else { 0 })
        .collect();
    let background = ComputeTarget::color_word(BACKGROUND);
    words.extend((0..pixels).map(|n| if is_empty(n) { background } else { nearer }));
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let buffer = HostBuffer::of(&host, &words, usage).unwrap();
    let output = Output::Compute(Planes::Color);
    let mut renderer = Renderer::new(&device, output, &SearchSettings::exact(), 1).unwrap();
    renderer.set_lighting(&scene.lighting()).unwrap();
    for object in &scene.objects {
        renderer.add(object.clone()).unwrap();
    }
    // SAFETY: the buffer is of the host's device, has two words per pixel, and outlives the
    // renderer.
    unsafe { renderer.set_compute_target(target(&buffer)) }.unwrap();
    once(&host, |cmd| {
        // SAFETY: `cmd` is recording outside of a pass; nothing was submitted for the slot before.
        unsafe {
            let frame = renderer.prepare(cmd, 0, offscreen.view()).unwrap();
            renderer.record_compute(cmd, &frame).unwrap();
        }
        barrier(&host, cmd);
    });
    let found: Vec<u32> = bytemuck::pod_collect_to_vec(&buffer.bytes());
    let mut drawn = 0;
    for n in 0..pixels {
        let (depth, color) = (f32::from_bits(found[n]), found[pixels + n]);
        if is_empty(n) {
            assert_eq!(color.to_le_bytes(), wanted[n], "pixel {n}");
            drawn += usize::from(depth < 1.0);
        } else {
            assert_eq!((depth, color), (0.0, nearer), "pixel {n}");
        }
    }
    assert!(drawn > 2000, "{drawn}");
    drop((renderer, offscreen)); // before the buffer
}

/// A depth-only renderer refuses compute and searches without an exact depth.
#[test]
fn depth_alone_takes_exact_searches() {
    let device = crate::common::device();
    let planes = Planes::Depth { parallel: false };
    let circle = SearchSettings {
        solver: CIRCLE,
        ..SearchSettings::exact()
    };
    let refused = |output, settings: &SearchSettings| {
        let error = Renderer::new(device, output, settings, 1).err().unwrap();
        assert!(error.to_string().contains("depth alone"), "{error}");
    };
    refused(depth_pass(planes), &circle);
    refused(Output::Compute(planes), &SearchSettings::exact());
}
