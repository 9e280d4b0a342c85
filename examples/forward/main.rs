//! A small forward renderer: one function lights its meshes and the revolved solids, by lamps in the
//! host's own descriptor set. No pass comes after.
//!
//! `cargo run --release --example forward -- out` writes `forward.png` into `out/`, and the same
//! picture with a mesh in place of the revolved ball, and without a ball. The solids' function is `shade.glsl`; `revmap
//! shading examples/forward/shade.glsl examples/forward/light.glsl -o examples/forward/shade.shading`
//! renews its bytes.
#![allow(unsafe_code)] // raw handles enter here: each use says what it promises

#[path = "../host/mod.rs"]
#[allow(clippy::duplicate_mod)] // in tests of several hosts
mod host;

use ash::vk;
use glam::{DQuat, DVec3, Vec3};
use host::set::UniformSet;
use host::{Fallible, Host, Mesh, MeshShaders, Options, Stage, lend, solids};
use revmap::gpu::{Device, Renderer};
use revmap::scene::{Material, Object, Placement};
use revmap::settings::{Planes, SearchSettings};
use revmap::shading::Shading;
use std::sync::Arc;

/// The bytes of `shade.glsl`, which belong to one version of the library.
pub const SHADING: &[u8] = include_bytes!("shade.shading");

const OPTIONS: Options = Options {
    reversed: true,
    ..Options::new(640, 400)
};
const EYE: DVec3 = DVec3::new(3.1, 0.9, 1.5);
const BALL: DVec3 = DVec3::new(0.55, 0.75, 0.3);
const BALL_RADIUS: f64 = 0.3;
const BALL_COLOR: Vec3 = Vec3::new(0.15, 0.3, 0.7);

#[allow(dead_code)] // a test calls `run`
fn main() -> Fallible<()> {
    let (folder, validate) = lend::arguments();
    let [mesh, none] = run(&folder, validate)?;
    println!("pixels that differ: {mesh} with a mesh in place of the ball, {none} without a ball");
    Ok(())
}

/// Draws the pictures into a folder. Returns how many pixels differ visibly if a mesh is in place of
/// the ball, and if nothing is.
pub fn run(folder: &str, validate: bool) -> Fallible<[usize; 2]> {
    let host = lend::open(folder, validate)?;
    // SAFETY: the host outlives the device.
    let device = unsafe { lend::lend(&host) }?;
    let lights = UniformSet::of(&host, &lights())?;
    let mut pictures = Vec::new();
    for name in ["forward", "forward-mesh", "forward-none"] {
        let mut renderer = renderer(&device, &lights)?;
        chessmen(&mut renderer)?;
        let mut meshes = vec![Mesh::floor(&host, 2.5, 0.0, Vec3::new(0.35, 0.33, 0.3))?];
        if name == "forward" {
            renderer.add(ball()?)?;
        } else if name == "forward-mesh" {
            let radius = BALL_RADIUS as f32;
            let ball = Mesh::sphere(&host, 128, BALL.as_vec3(), radius, BALL_COLOR)?;
            meshes.push(ball);
        }
        let pixels = picture(&host, &mut renderer, &meshes, &lights)?;
        host::write_png(folder, name, &OPTIONS, &pixels)?;
        pictures.push(pixels);
    }
    lend::check(&host)?;
    Ok([1, 2].map(|n| host::differing(&pictures[0], &pictures[n])))
}

/// A renderer that shades by the host's function.
fn renderer(device: &Device, lights: &UniformSet) -> Fallible<Renderer> {
    let output = lend::pass(&OPTIONS, &[host::COLOR], Planes::Color);
    let (search, slots) = (SearchSettings::default(), host::FRAMES);
    let shading = Arc::new(Shading::from_bytes(SHADING)?);
    // SAFETY: the layout has the binding that `light.glsl` declares, and outlives the renderer.
    Ok(unsafe { lend::shaded(device, output, &search, slots, &shading, lights.layout) }?)
}

/// Chessmen, and a row of pawns; every other pawn has rings.
fn chessmen(renderer: &mut Renderer) -> Fallible<()> {
    for (name, y, color, metalness) in [
        ("king", 0.0, [0.95, 0.75, 0.35], 1.0),
        ("rook", -0.8, [0.5, 0.12, 0.08], 0.0),
        ("pawn", -1.3, [0.15, 0.3, 0.25], 0.0),
    ] {
        let mut object = solids::chessman(name, color)?;
        object.material = Some(Material {
            roughness: 0.3,
            metalness,
        });
        object.placement.position.y = y;
        if name == "pawn" {
            let standing = |n: u32| Placement {
                position: DVec3::new(-1.0, 0.5 * f64::from(n) - 1.5, 0.0),
                rotation: DQuat::IDENTITY,
                scale: DVec3::splat(0.55),
            };
            object.instances = (0..7).map(standing).collect();
        }
        renderer.add(object)?;
    }
    Ok(())
}

/// The ball, with a material.
fn ball() -> Fallible<Object> {
    let mut object = solids::ball(BALL, BALL_RADIUS, BALL_COLOR)?;
    object.material = Some(Material {
        roughness: 0.4,
        metalness: 0.0,
    });
    Ok(object)
}

/// The values of `HostLights` in `light.glsl`.
fn lights() -> Vec<[f32; 4]> {
    let sun = Vec3::new(0.5, -0.4, 0.7).normalize();
    let lamps = [
        (Vec3::new(1.2, 0.1, 0.5), Vec3::new(1.6, 0.5, 0.15)),
        (Vec3::new(0.3, -1.6, 0.9), Vec3::new(0.3, 1.4, 0.4)),
        (Vec3::new(-0.6, 1.5, 0.6), Vec3::new(0.4, 0.5, 2.0)),
    ];
    let mut all = vec![EYE.as_vec3(), sun, Vec3::splat(2.2), Vec3::splat(0.12)];
    all.extend(lamps.map(|lamp| lamp.0));
    all.extend(lamps.map(|lamp| lamp.1));
    all.iter().map(|v| v.extend(1.0).to_array()).collect()
}

/// One frame: meshes, then solids, each with the host's set of lights.
fn picture(
    host: &Host,
    renderer: &mut Renderer,
    meshes: &[Mesh],
    lights: &UniformSet,
) -> Fallible<Vec<u8>> {
    let shaders = MeshShaders {
        vertex: include_bytes!("mesh.vert.spv"),
        fragment: include_bytes!("mesh.frag.spv"),
        sets: &[lights.layout],
    };
    let mut stage = Stage::with_shaders(host, OPTIONS, &shaders)?;
    let [view, projection] = host::view_and_projection(EYE, DVec3::new(0.0, 0.0, 0.35), &OPTIONS);
    let seen = lend::view([view, projection], &OPTIONS)?;
    let point = vk::PipelineBindPoint::GRAPHICS;
    let (cmd, slot) = stage.begin()?;
    // SAFETY: the stage has waited for the slot's last frame; `cmd` is recording outside of its pass;
    // the layout of meshes has the set at 0.
    let frame = unsafe {
        lights.bind(cmd, point, stage.meshes.layout, 0);
        renderer.prepare(cmd, slot, &seen)?
    };
    // SAFETY: the frame was prepared, and the pass is of the output's formats; the renderer's layout
    // has the set at 3.
    let solids = || unsafe {
        lights.bind(cmd, point, renderer.pipeline_layout()?, 3);
        Ok(renderer.record(cmd, &frame)?)
    };
    stage.draw(slot, (projection * view, Vec3::Z), meshes, solids)?;
    Ok(stage.read()?.0)
}
