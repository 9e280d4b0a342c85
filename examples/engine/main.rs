//! A small engine that draws revolved solids beside its own meshes: its device, its pass, its depth
//! buffer, its matrices, two frames in flight, parameters that move in every frame.
//!
//! `cargo run --release --example engine -- out` writes the first frame, one in the middle and the
//! last as PNG files into `out/`.
#![allow(unsafe_code)] // raw handles enter here: each use says what it promises

mod host;
mod lend;
mod solids;

use glam::{DQuat, DVec3, Vec3};
use host::{Fallible, Mesh, Options, Stage};
use revmap::gpu::{self, DepthOrder, Output, PassFormats, PassKind, View, Viewport};
use revmap::profile::Profile;
use revmap::scene::{Light, Lighting, Object, Offset, Placement, Shadow};
use revmap::settings::{Planes, SearchSettings};
use std::sync::Arc;

const COUNT: u32 = 120;

fn main() -> Fallible<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "out".to_owned());
    std::fs::create_dir_all(&folder)?;
    let validate = std::env::var_os(revmap::gpu::VALIDATION_VARIABLE).is_some();
    let host = lend::open(validate)?;
    // SAFETY: the host outlives the device.
    let device = unsafe { lend::lend(&host) }?;
    let options = Options {
        width: 960,
        height: 600,
        dynamic: true,
        samples: 1,
        reversed: true,
    };
    let mut stage = Stage::new(&host, options)?;
    let middle = Vec3::new(0.25, 0.0, 0.45);
    let meshes = [
        Mesh::floor(&host, 2.5, 0.0, Vec3::new(0.35, 0.33, 0.3))?,
        Mesh::sphere(&host, 64, middle, 0.3, Vec3::new(0.2, 0.35, 0.6))?,
    ];
    let begun = PassKind::Dynamic {
        color: vec![host::COLOR],
        depth: host::DEPTH,
        stencil: ash::vk::Format::UNDEFINED,
    };
    let output = Output::Pass(PassFormats {
        depth: DepthOrder::Reversed,
        ..PassFormats::new(begun, Planes::Color)
    });
    let mut renderer =
        gpu::Renderer::new(&device, output, &SearchSettings::default(), host::FRAMES)?;
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
        let viewport = Viewport {
            x: 0.0,
            y: 0.0,
            width: f64::from(options.width),
            height: f64::from(options.height),
        };
        let seen = View::from_matrices(view, projection, viewport, DepthOrder::Reversed)?;
        let towards_light = -light.direction.as_vec3();
        let renderer_cell = std::cell::RefCell::new(&mut renderer);
        stage.frame(
            projection * view,
            towards_light,
            &meshes,
            // SAFETY: the stage has waited for the slot's last frame; `cmd` is recording outside of
            // its pass.
            |cmd, slot| Ok(unsafe { renderer_cell.borrow_mut().prepare(cmd, slot, &seen) }?),
            // SAFETY: the frame was prepared, and the pass is of the output's formats.
            |cmd, frame| Ok(unsafe { renderer_cell.borrow().record(cmd, frame) }?),
        )?;
        if [0, COUNT / 2, COUNT - 1].contains(&frame) {
            let (pixels, _) = stage.read()?;
            let path = format!("{folder}/engine-{frame:03}.png");
            host::write_png(&path, &options, &pixels)?;
            println!("{path}");
        }
    }
    println!(
        "{COUNT} frames on {}: {} pipelines compiled, {} surfaces made",
        device.report().name,
        device.pipelines_compiled(),
        renderer.rebuild_count()
    );
    stage.wait()?;
    match host.take_messages().first() {
        Some(message) => Err(message.clone().into()),
        None => Ok(()),
    }
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
