//! Outputs of a host other than a colour picture with depth: depth-only passes for its shadow maps,
//! and compute into its own buffer.
#![allow(unsafe_code)]

use crate::common::host::{self, Canvas, Drawn, Host, HostBuffer, barrier, dynamic, once, opened};
use crate::common::prelude::*;
use crate::embedding::{BACKGROUND, every_way, matrices, options, three, upright};
use revmap_files::Picture;

/// Scales of the tests' lenses of parallel rays.
pub const WIDE: [f64; 2] = [1.0 / 0.8, 1.0 / 0.6];

/// A shadow map of a light, with parallel rays or not.
pub fn depth_only(parallel: bool) -> PassFormats {
    PassFormats::new(dynamic(&[]), Planes::Depth { parallel })
}

/// The exact search, by cells of at least so many pixels.
pub fn by_proxies_of(proxy_min_pixels: u32) -> SearchSettings {
    SearchSettings::exact().with(|s| s.proxy_min_pixels = proxy_min_pixels)
}

/// Depths of a scene, drawn into a host's shadow map, and the draw paths of the objects.
pub fn depths(
    host: &Host,
    device: &Device,
    scene: &Scene,
    view: &View,
    settings: &SearchSettings,
    pass: &PassFormats,
) -> (Vec<f32>, Vec<DrawPath>) {
    let by = (Output::Pass(pass.clone()), settings);
    let mut drawn = Drawn::new(host, device, options(), by, scene).seen(view);
    (drawn.picture().1, drawn.renderer.draw_paths())
}

/// The depth of a light's view along parallel rays is the analytic depth.
#[test]
fn depth_along_parallel_rays_is_analytic() {
    let (host, device) = opened();
    let exact = SearchSettings::exact();
    let wide = 0.3;
    let one = scene_of(shapes::column_of(wide), three().camera.eye);
    let from = DVec3::new(2.0, 1.0, 2.5);
    let view = host::view_and_projection(from, DVec3::new(0.0, 0.0, 0.5), &options())[0];
    let projection = parallel();
    let light = host::view([view, projection], &options()).unwrap();
    let (found, _) = depths(&host, &device, &one, &light, &exact, &depth_only(true));
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

/// A depth-only pass has the bits of a colour pass of the same objects, search and lighting, by every
/// draw path: `EQUAL` draws every pixel after it.
#[test]
fn depth_alone_has_equal_bits_by_every_path() {
    let (host, device) = opened();
    let mut paths = HashSet::new();
    for (name, scene) in &every_way() {
        let light = host::view(matrices(scene), &options()).unwrap();
        for least in [0, u32::MAX] {
            let settings = by_proxies_of(least);
            let (alone, own) = depths(&host, &device, scene, &light, &settings, &depth_only(false));
            let (beside, _) = depths(
                &host,
                &device,
                scene,
                &light,
                &settings,
                &host::color_pass(),
            );
            let pairs = || alone.iter().zip(&beside);
            let hits = pairs().filter(|(d, _)| **d < 1.0).count();
            let apart = pairs().filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            println!("{name}, {least}: {apart} of {hits} by {own:?}");
            assert!(hits > 2000 && apart == 0, "{name}: {apart} of {hits}");
            paths.extend(own);
        }
    }
    let every = [DrawPath::Cells, DrawPath::Box];
    assert!(every.iter().all(|path| paths.contains(path)), "{paths:?}");
}

/// A projection of parallel rays.
pub fn parallel() -> DMat4 {
    host::lens(WIDE, true, false, [0.5, 6.0])
}

/// Compute into a host's buffer gives the off-screen picture in cleared pixels. Nearer values
/// already in the buffer are kept.
#[test]
fn compute_writes_to_a_hosts_buffer() {
    let (host, device) = opened();
    let scene = three();
    let (width, height) = (options().width, options().height);
    let settings = in_compute(sized(width, height)).with(|s| s.planes = Planes::Color);
    let mut offscreen = Offscreen::new(&device, &scene, &settings).unwrap();
    let wanted = Picture::of(&next_frame(&mut offscreen)).unwrap().rgba;
    let pixels = (width * height) as usize;
    let nearer = 0x0102_0304u32;
    // The left half is empty; the right half already holds a nearer depth.
    let is_empty = |n: usize| n % (width as usize) < width as usize / 2;
    let background = ComputeTarget::color_word(BACKGROUND);
    let word = |n: usize| match (n < pixels, is_empty(n % pixels)) {
        (true, true) => 1f32.to_bits(),
        (true, false) => 0,
        (false, true) => background,
        (false, false) => nearer,
    };
    let words: Vec<u32> = (0..2 * pixels).map(word).collect();
    let words = HostBuffer::of(&host, &words, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap();
    let words = Canvas::Words(words);
    let (output, exact) = (Output::Compute(Planes::Color), SearchSettings::exact());
    let mut renderer = host::renderer_of(&device, output, &exact, 1, &scene);
    words.lend(&mut renderer, true);
    once(&host, |cmd| {
        // SAFETY: `cmd` is recording outside of a pass; the buffer has two words per pixel.
        unsafe {
            let frame = renderer.prepare(cmd, 0, offscreen.view()).unwrap();
            renderer.record_compute(cmd, &frame).unwrap();
            barrier(&host, cmd, &[]);
        }
    });
    let found: Vec<u32> = bytemuck::pod_collect_to_vec(&words.planes()[0]);
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
}
