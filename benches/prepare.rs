//! The CPU's cost of preparing a frame. 1,000 objects stand still, move, or change their offsets,
//! under a camera that stands or moves. Up to a million copies of one object move, or some of them
//! come and go. `cargo bench --bench prepare`.
#![allow(unsafe_code, clippy::unwrap_used)]

#[path = "../tests/common/host.rs"]
#[allow(unused_imports)]
mod host;

use ash::vk;
use divan::Bencher;
use glam::DVec3;
use host::{Commands, Host, borrow, color_pass, open_unchecked};
use revmap::gpu::{ObjectId, Output, Renderer, View};
use revmap::maps::ColorMap;
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Offset, Placement};
use revmap::settings::SearchSettings;
use std::sync::{Arc, LazyLock};

const COUNT: usize = 1000;
static HOST: LazyLock<Host> = LazyLock::new(open_unchecked);

fn main() {
    divan::main();
}

/// A crowd of spindles and vases, and commands that are recorded and never submitted.
struct Crowd {
    renderer: Renderer,
    ids: Vec<ObjectId>,
    camera: Camera,
    frame: usize,
    commands: Commands<'static>,
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
        let (output, search) = (Output::Pass(color_pass()), SearchSettings::exact());
        let mut renderer = Renderer::new(&borrow(&HOST), output, &search, 2).unwrap();
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
        let commands = Commands::new(&HOST, vk::CommandBufferLevel::PRIMARY, 1).unwrap();
        let mut crowd = Self {
            renderer,
            ids,
            camera: Camera::new(DVec3::new(30.0, 5.0, 20.0), DVec3::ZERO),
            frame: 0,
            commands,
        };
        crowd.settle();
        crowd
    }

    /// The first object alone.
    fn of_one() -> Self {
        let mut crowd = Self::new();
        for id in crowd.ids.split_off(1) {
            crowd.renderer.remove(id).unwrap();
        }
        crowd
    }

    /// Prepares frames until all slots hold what they draw.
    fn settle(&mut self) {
        for _ in 0..4 {
            self.begin();
            self.prepare();
        }
    }

    /// Begins another frame's commands.
    fn begin(&mut self) {
        self.frame += 1;
        let info = vk::CommandBufferBeginInfo::default();
        // SAFETY: the commands are never submitted.
        unsafe { (HOST.device).begin_command_buffer(self.commands.raw[0], &info) }.unwrap();
    }

    fn prepare(&mut self) {
        let view = View::from_camera(&self.camera, (1280, 720), [0.1, 200.0]).unwrap();
        let cmd = self.commands.raw[0];
        // SAFETY: `cmd` is recording; no frame was ever submitted.
        let _ = unsafe { self.renderer.prepare(cmd, self.frame % 2, &view) }.unwrap();
    }
}

fn frames(bencher: Bencher, mut crowd: Crowd, mut change: impl FnMut(&mut Crowd)) {
    bencher.bench_local(|| {
        crowd.begin();
        change(&mut crowd);
        crowd.prepare();
    });
}

#[divan::bench]
fn still(bencher: Bencher) {
    frames(bencher, Crowd::new(), |_| {});
}

#[divan::bench]
fn all_move(bencher: Bencher) {
    frames(bencher, Crowd::new(), |crowd| {
        for (n, id) in crowd.ids.iter().enumerate() {
            let moved = crowd.renderer.set_placement(*id, place(n, crowd.frame));
            moved.unwrap();
        }
    });
}

#[divan::bench]
fn the_camera_moves(bencher: Bencher) {
    frames(bencher, Crowd::new(), |crowd| crowd.camera.eye.x += 1e-3);
}

/// One of many objects moves, each with a colour map of its own. Frames take linear time.
#[divan::bench(args = [500, 2000, 8000])]
fn one_of_many_looks_moves(bencher: Bencher, count: usize) {
    let mut crowd = Crowd::of_one();
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
    frames(bencher, crowd, |crowd| {
        let moved = place(0, crowd.frame);
        crowd.renderer.set_placement(crowd.ids[0], moved).unwrap();
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
        let mut crowd = Self::of_one();
        crowd.place(copies);
        crowd.settle();
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
    let crowd = Crowd::of_copies(field(count, 0));
    frames(bencher, crowd, |crowd| crowd.camera.eye.x += 1e-3);
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
    frames(bencher, Crowd::new(), |crowd| {
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
