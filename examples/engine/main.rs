//! A small engine that draws revolved solids beside its own meshes: its device, its pass, its depth
//! buffer, its matrices, two frames in flight, parameters that move in every frame.
//!
//! `cargo run --release --example engine -- out` writes the first frame, one in the middle and the
//! last as PNG files into `out/`.
#![allow(unsafe_code)] // raw handles enter here: each use says what it promises

#[path = "../host/mod.rs"]
mod host;

use glam::{DQuat, DVec3, Vec3};
use host::{Fallible, Mesh, Options, Stage, lend, solids};
use revmap::gpu;
use revmap::profile::Profile;
use revmap::scene::{Light, Lighting, Object, Offset, Placement, Shadow};
use revmap::settings::{Planes, SearchSettings};
use std::sync::Arc;

const COUNT: u32 = 120;

fn main() -> Fallible<()> {
    let (folder, validate) = lend::arguments();
    let host = lend::open(&folder, validate)?;
    // SAFETY: the host outlives the device.
    let device = unsafe { lend::lend(&host) }?;
    let options = Options {
        reversed: true,
        ..Options::new(960, 600)
    };
    let mut stage = Stage::new(&host, options)?;
    let middle = Vec3::new(0.25, 0.0, 0.45);
    let meshes = [
        Mesh::floor(&host, 2.5, 0.0, Vec3::new(0.35, 0.33, 0.3))?,
        Mesh::sphere(&host, 64, middle, 0.3, Vec3::new(0.2, 0.35, 0.6))?,
    ];
    let output = lend::pass(&options, &[host::COLOR], Planes::Color);
    let settings = SearchSettings::default();
    let mut renderer = gpu::Renderer::new(&device, output, &settings, host::FRAMES)?;
    let light = Light {
        direction: DVec3::new(-0.5, -0.4, -0.8),
        ..Light::default()
    };
    renderer.set_lighting(&Lighting {
        lights: vec![light],
        shadow: Shadow::Off,
        ..Lighting::default()
    })?;

    // Three patches in the middle: one stands in the host's sphere.
    let mut patches = Vec::new();
    for (name, y, color) in [
        ("pawn", 0.0, [0.75, 0.55, 0.3]),
        ("rook", -0.9, [0.6, 0.2, 0.15]),
        ("king", 0.9, [0.7, 0.7, 0.65]),
    ] {
        let mut object = solids::chessman(name, color)?;
        object.placement.position.y = y;
        patches.push(renderer.add(object)?);
    }
    // A row of small ones behind.
    let spindle = Profile::polygon(
        &[[0.0, 0.0], [0.35, 0.2], [0.1, 0.5], [0.35, 0.8], [0.0, 1.0]],
        0.4,
    )?;
    let mut row = Object::new("spindles", Arc::new(spindle));
    row.color = [0.25, 0.5, 0.35];
    row.instances = standing(0.0).into();
    let row = renderer.add(row)?;

    for frame in 0..COUNT {
        let phase = f64::from(frame) / f64::from(COUNT) * std::f64::consts::TAU;
        let wave = |by: f64| 0.5 - 0.5 * (phase + by).cos();
        for (n, id) in patches.iter().enumerate() {
            let by = n as f64;
            let offset = Offset {
                extend: 0.03 * wave(by),
                bevel: 0.15 * wave(2.0 * by),
                chamfer: 0.6,
            };
            renderer.set_offset(*id, offset)?;
        }
        renderer.set_instances(row, standing(phase))?;
        let eye = DVec3::new(3.2 * (0.3 * phase).cos(), 3.2 * (0.3 * phase).sin(), 1.5);
        let target = DVec3::new(0.0, 0.0, 0.4);
        let [view, projection] = host::view_and_projection(eye, target, &options);
        let seen = lend::view([view, projection], &options)?;
        let lit = (projection * view, -light.direction.as_vec3());
        lend::frame(&mut stage, &mut renderer, &seen, lit, &meshes)?;
        if [0, COUNT / 2, COUNT - 1].contains(&frame) {
            let (pixels, _) = stage.read()?;
            host::write_png(&folder, &format!("engine-{frame:03}"), &options, &pixels)?;
        }
    }
    println!(
        "{COUNT} frames: {} pipelines compiled, {} surfaces made",
        device.pipelines_compiled(),
        renderer.rebuild_count()
    );
    stage.wait()?;
    lend::check(&host)
}

/// A row of copies, turned by `phase`.
fn standing(phase: f64) -> Vec<Placement> {
    (0..9)
        .map(|n| Placement {
            position: DVec3::new(-1.1, 0.45 * f64::from(n) - 1.8, 0.0),
            rotation: DQuat::from_rotation_y(0.25 * (phase + f64::from(n)).sin()),
            scale: DVec3::splat(0.45),
        })
        .collect()
}
