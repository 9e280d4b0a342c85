//! The CPU's cost of preparing a frame. 1,000 objects stand still, move, or change their offsets,
//! under a camera that stands or moves. Up to a million copies of one object move, or some of them
//! come and go. `cargo bench --bench prepare`.
#![allow(unsafe_code, clippy::unwrap_used)]

use ash::vk;
use divan::Bencher;
use glam::DVec3;
use revmap::gpu::{Device, ObjectId, Output, PassFormats, PassKind, Renderer, View};
use revmap::maps::ColorMap;
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Offset, Placement};
use revmap::settings::{Planes, SearchSettings};
use std::sync::Arc;

const COUNT: usize = 1000;

fn main() {
    divan::main();
}

/// A crowd of spindles and vases on a device, and commands that are recorded and never submitted.
struct Crowd {
    renderer: Renderer,
    ids: Vec<ObjectId>,
    camera: Camera,
    frame: usize,
    cmd: vk::CommandBuffer,
    pool: vk::CommandPool,
    device: Device,
}

fn place(n: usize, frame: usize) -> Placement {
    let (x, y) = ((n % 40) as f64, (n / 40) as f64);
    let z = 0.1 * (0.1 * frame as f64 + n as f64).sin();
    Placement {
        position: DVec3::new(1.2 * x - 24.0, 1.2 * y - 15.0, z),
        ..Placement::default()
    }
}

impl Crowd {
    fn new() -> Self {
        let device = Device::open(None).unwrap();
        let begun = PassKind::Dynamic {
            color: vec![vk::Format::R8G8B8A8_SRGB],
            depth: vk::Format::D32_SFLOAT,
            stencil: vk::Format::UNDEFINED,
        };
        let output = Output::Pass(PassFormats::new(begun, Planes::Color));
        let search = SearchSettings::exact();
        let mut renderer = Renderer::new(&device, output, &search, 2).unwrap();
        let profiles = [
            &[[0.0, 0.0], [0.35, 0.2], [0.1, 0.5], [0.35, 0.8], [0.0, 1.0]][..],
            &[
                [0.0, 0.0],
                [0.3, 0.0],
                [0.4, 0.3],
                [0.15, 0.7],
                [0.25, 1.0],
                [0.0, 1.0],
            ][..],
        ]
        .map(|points| Arc::new(Profile::polygon(points, 0.5).unwrap()));
        let ids = (0..COUNT)
            .map(|n| {
                let mut object = Object::new("crowd", profiles[n % 2].clone());
                object.placement = place(n, 0);
                renderer.add(object).unwrap()
            })
            .collect();
        let raw = device.raw();
        // SAFETY: plain creations, destroyed in Drop.
        let (pool, cmd) = unsafe {
            let flags = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
            let info = vk::CommandPoolCreateInfo::default().flags(flags);
            let pool = raw.create_command_pool(&info, None).unwrap();
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            (pool, raw.allocate_command_buffers(&info).unwrap()[0])
        };
        let mut crowd = Self {
            renderer,
            ids,
            camera: Camera::new(DVec3::new(30.0, 5.0, 20.0), DVec3::ZERO),
            frame: 0,
            cmd,
            pool,
            device,
        };
        for _ in 0..4 {
            crowd.begin();
            crowd.prepare();
        }
        crowd
    }

    /// Begins another frame's commands.
    fn begin(&mut self) {
        self.frame += 1;
        let info = vk::CommandBufferBeginInfo::default();
        // SAFETY: the commands are never submitted.
        unsafe { self.device.raw().begin_command_buffer(self.cmd, &info) }.unwrap();
    }

    fn prepare(&mut self) {
        let view = View::from_camera(&self.camera, (1280, 720), [0.1, 200.0]).unwrap();
        // SAFETY: `cmd` is recording; no frame was ever submitted.
        let _ = unsafe { self.renderer.prepare(self.cmd, self.frame % 2, &view) }.unwrap();
    }
}

impl Drop for Crowd {
    fn drop(&mut self) {
        // SAFETY: the commands were never submitted.
        unsafe { self.device.raw().destroy_command_pool(self.pool, None) };
    }
}

fn frames(bencher: Bencher, mut change: impl FnMut(&mut Crowd)) {
    let mut crowd = Crowd::new();
    bencher.bench_local(|| {
        crowd.begin();
        change(&mut crowd);
        crowd.prepare();
    });
}

#[divan::bench]
fn still(bencher: Bencher) {
    frames(bencher, |_| {});
}

#[divan::bench]
fn all_move(bencher: Bencher) {
    frames(bencher, |crowd| {
        for (n, id) in crowd.ids.iter().enumerate() {
            let moved = crowd.renderer.set_placement(*id, place(n, crowd.frame));
            moved.unwrap();
        }
    });
}

#[divan::bench]
fn the_camera_moves(bencher: Bencher) {
    frames(bencher, |crowd| crowd.camera.eye.x += 1e-3);
}

/// One of many objects moves, each with a colour map of its own. Frames take linear time.
#[divan::bench(args = [500, 2000, 8000])]
fn one_of_many_looks_moves(bencher: Bencher, count: usize) {
    let mut crowd = Crowd::new();
    for id in crowd.ids.split_off(1) {
        crowd.renderer.remove(id).unwrap();
    }
    let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
    let profile = Arc::new(profile);
    for n in 0..count {
        let mut object = Object::new("look", profile.clone());
        let texel = [n as u8, (n >> 8) as u8, 0, 255];
        object.texturing.color_map =
            Some(Arc::new(ColorMap::from_texels(1, 1, vec![texel]).unwrap()));
        object.placement = place(n, 0);
        crowd.renderer.add(object).unwrap();
    }
    bencher.bench_local(|| {
        crowd.begin();
        let moved = place(0, crowd.frame);
        crowd.renderer.set_placement(crowd.ids[0], moved).unwrap();
        crowd.prepare();
    });
}

/// A field of copies, at a time.
fn field(count: usize, frame: usize) -> Vec<Placement> {
    let side = (count as f64).sqrt().ceil() as usize;
    let of = |n: usize| {
        let wave = 0.3 * (0.1 * frame as f64 + n as f64).sin();
        Placement {
            position: DVec3::new((n % side) as f64 + wave, (n / side) as f64, 0.1 * wave) * 0.3,
            scale: DVec3::splat(0.5),
            ..Placement::default()
        }
    };
    (0..count).map(of).collect()
}

impl Crowd {
    /// Copies of one object.
    fn of_copies(copies: Vec<Placement>) -> Self {
        let mut crowd = Self::new();
        for id in crowd.ids.split_off(1) {
            crowd.renderer.remove(id).unwrap();
        }
        crowd.place(copies);
        for _ in 0..4 {
            crowd.begin();
            crowd.prepare();
        }
        crowd
    }

    fn place(&mut self, copies: Vec<Placement>) {
        self.renderer.set_instances(self.ids[0], copies).unwrap();
    }
}

/// Frames in which the copies are those that `of` gives, which is not timed.
fn copies(bencher: Bencher, of: impl Fn(usize) -> Vec<Placement>) {
    let crowd = std::cell::RefCell::new(Crowd::of_copies(of(0)));
    bencher
        .with_inputs(|| {
            let mut crowd = crowd.borrow_mut();
            crowd.begin();
            of(crowd.frame)
        })
        .bench_local_values(|copies| {
            let mut crowd = crowd.borrow_mut();
            crowd.place(copies);
            crowd.prepare();
        });
}

#[divan::bench(args = [64, 10_000, 100_000, 1_000_000])]
fn the_camera_moves_over_copies(bencher: Bencher, count: usize) {
    let mut crowd = Crowd::of_copies(field(count, 0));
    bencher.bench_local(|| {
        crowd.begin();
        crowd.camera.eye.x += 1e-3;
        crowd.prepare();
    });
}

#[divan::bench(args = [10_000, 100_000, 1_000_000], sample_count = 10)]
fn all_copies_move(bencher: Bencher, count: usize) {
    copies(bencher, |frame| field(count, frame));
}

/// A thousand of the copies are gone in every other frame.
#[divan::bench(args = [10_000, 100_000])]
fn copies_come_and_go(bencher: Bencher, count: usize) {
    copies(bencher, |frame| field(count - 1000 * (frame % 2), 0));
}

#[divan::bench(sample_count = 20)]
fn all_offsets_change(bencher: Bencher) {
    frames(bencher, |crowd| {
        for (n, id) in crowd.ids.iter().enumerate() {
            let extend = 0.02 + 0.02 * (0.05 * crowd.frame as f64 + n as f64).sin();
            let offset = Offset {
                extend,
                ..Offset::default()
            };
            crowd.renderer.set_offset(*id, offset).unwrap();
        }
    });
}
