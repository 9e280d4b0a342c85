//! Recording through the C interface in compute: what the Rust renderer draws.

use crate::host::{HostBuffer, Stage, barrier, open};
use crate::names::*;
use crate::recording::{OPTIONS, RANGE, add, camera, lend, scene};
use revmap_files::Picture;
use revmap_offscreen::Offscreen;

const PIXELS: usize = (OPTIONS.width * OPTIONS.height) as usize;

const BACKGROUND: [f32; 4] = [0.05, 0.2, 0.6, 0.5];

#[test]
fn compute_writes_what_rust_draws() {
    let host = open();
    let mut stage = Stage::new(&host, OPTIONS).unwrap();
    let (device, camera) = (lend(&host), camera());
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
    let words = HostBuffer::new(&host, 8 * PIXELS, usage).unwrap();
    let mut renderer = null_mut();
    // SAFETY: live values; the stage has waited for a slot before it is prepared; the words live
    // until it is idle.
    unsafe {
        ok! { revmap_renderer_create_compute(device, RevmapPlanes::Color as u32, null(), 2, &mut renderer); }
        add(renderer);
        let mut target = sized!(RevmapComputeTarget);
        target.words = words.raw;
        ok! { revmap_renderer_set_compute_target(renderer, &target); }
        for _ in 0..3 {
            let before = |cmd, slot: usize| {
                let (slot, w, h, [near, far]) = (slot as u32, OPTIONS.width, OPTIONS.height, RANGE);
                ok! { revmap_renderer_prepare_camera(renderer, cmd, slot, &camera, w, h, near, far); }
                let [r, g, b, a] = BACKGROUND;
                let half = 4 * PIXELS as u64;
                let (color, raw) = (revmap_color_word(r, g, b, a), &host.device);
                barrier(&host, cmd, &[]);
                raw.cmd_fill_buffer(cmd, words.raw, 0, half, 1f32.to_bits());
                raw.cmd_fill_buffer(cmd, words.raw, half, half, color);
                barrier(&host, cmd, &[]);
                let refused = revmap_renderer_record(renderer, cmd, slot);
                assert_eq!(refused, RevmapResult::Usage);
                ok! { revmap_renderer_record_compute(renderer, cmd, slot); }
                barrier(&host, cmd, &[]);
                Ok(())
            };
            stage
                .frame(DMat4::IDENTITY, Vec3::Z, &[], before, |_, _| Ok(()))
                .unwrap();
        }
        stage.wait().unwrap();
        let mut statistics = sized!(RevmapStatistics);
        ok! { revmap_renderer_statistics(renderer, &mut statistics); }
        assert_eq!((statistics.objects, statistics.drawn_by_hull), (2, 0));
        assert_eq!(statistics.drawn_by_tiles, 2);
        ok! {
            revmap_renderer_destroy(renderer);
            revmap_device_destroy(device);
        }
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
    let wanted = Picture::of(&offscreen.read().unwrap()).unwrap().rgba;
    let colors = &words.bytes()[4 * PIXELS..];
    assert!(colors == wanted.as_flattened(), "pixels differ");
    assert!(wanted.iter().filter(|p| p[3] == 255).count() > 3000);
}
