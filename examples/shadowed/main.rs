//! A small forward renderer with the shadow map of a sun: meshes and revolved solids cast shadows
//! on each other and on themselves. A second renderer draws the solids into the map.
//!
//! `cargo run --release --example shadowed -- out` writes `shadowed.png` into `out/`, and the same
//! picture with a mesh in place of the revolved ball, without shadows, and without the ball's. The
//! solids' function is `shade.glsl`; `revmap shading examples/shadowed/shade.glsl
//! examples/shadowed/sun.glsl -o examples/shadowed/shade.shading` renews its bytes.
#![allow(unsafe_code)] // raw handles enter here: each use says what it promises

#[path = "../host/mod.rs"]
#[allow(clippy::duplicate_mod)] // in tests of several hosts
mod host;
pub mod map;
pub mod scene;

use ash::vk;
use glam::{DMat4, Vec3, Vec4};
pub use host::differing;
use host::set::UniformSet;
use host::{Fallible, Host, MeshShaders, Options, Stage, lend};
use map::SunMap;
use revmap::gpu::{Device, ObjectId, PreparedFrame, Renderer, View};
use revmap::scene::Object;
use revmap::settings::{Planes, SearchSettings};
use revmap::shading::Shading;
use std::sync::Arc;

/// The bytes of `shade.glsl`, which belong to one version of the library.
pub const SHADING: &[u8] = include_bytes!("shade.shading");
/// Options of the picture.
pub const OPTIONS: Options = Options {
    reversed: true,
    ..Options::new(640, 400)
};
/// Frames in which the pawns move; the last is the picture.
pub const COUNT: u32 = 4;

/// What a picture draws.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Case {
    /// Everything, and all of it into the map.
    All,
    /// The same with a mesh in place of the ball.
    MeshBall,
    /// Nothing into the map.
    EmptyMap,
    /// The ball is left out of the map: a fault, which a test has to see.
    BallNotInMap,
}

#[allow(dead_code)] // a test calls `run`
fn main() -> Fallible<()> {
    let (folder, validate) = lend::arguments();
    let [all, mesh, empty, fault] = run(&folder, validate)?;
    let [mesh, empty, fault] = [mesh, empty, fault].map(|picture| differing(&all, &picture));
    println!("pixels that differ: {mesh} with a mesh in place of the ball");
    println!("{empty} without shadows, {fault} without the ball's");
    Ok(())
}

/// Draws a picture of each case into a folder, and returns them: sRGB, and the visible part of the
/// sun in alpha.
pub fn run(folder: &str, validate: bool) -> Fallible<[Vec<u8>; 4]> {
    let host = lend::open(folder, validate)?;
    // SAFETY: the host outlives the device.
    let device = unsafe { lend::lend(&host) }?;
    let mut pictures = Vec::new();
    for (name, case) in [
        ("shadowed", Case::All),
        ("shadowed-mesh", Case::MeshBall),
        ("shadowed-empty", Case::EmptyMap),
        ("shadowed-fault", Case::BallNotInMap),
    ] {
        let pixels = picture(&host, &device, case)?;
        let mut opaque = pixels.clone();
        opaque.chunks_mut(4).for_each(|pixel| pixel[3] = u8::MAX);
        host::write_png(folder, name, &OPTIONS, &opaque)?;
        pictures.push(pixels);
    }
    lend::check(&host)?;
    Ok(pictures.try_into().map_err(|_| "four pictures")?)
}

/// A renderer of solids for one of the passes, and the row that moves.
struct Solids {
    renderer: Renderer,
    row: ObjectId,
}

impl Solids {
    fn new(mut renderer: Renderer, objects: &[Object]) -> Fallible<Self> {
        let ids: Vec<_> = (objects.iter().cloned())
            .map(|object| renderer.add(object))
            .collect::<revmap::Result<_>>()?;
        let row = ids[0];
        Ok(Self { renderer, row })
    }

    /// Prepares a frame.
    ///
    /// # Safety
    /// Same as for [`Renderer::prepare`].
    unsafe fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        (frame, slot): (u32, usize),
        view: &View,
    ) -> revmap::Result<PreparedFrame> {
        self.renderer.set_instances(self.row, scene::row(frame))?;
        // SAFETY: as the caller promised.
        unsafe { self.renderer.prepare(cmd, slot, view) }
    }
}

/// Renderers of the map and of the picture.
fn renderers(device: &Device, set: &UniformSet, case: Case) -> Fallible<[Solids; 2]> {
    let (settings, mut objects) = (SearchSettings::default(), scene::objects(0)?);
    if case == Case::MeshBall {
        objects.pop();
    }
    let output = lend::pass(&OPTIONS, &[host::COLOR], Planes::Color);
    let (slots, shading) = (host::FRAMES, Arc::new(Shading::from_bytes(SHADING)?));
    // SAFETY: the layout has the bindings that `sun.glsl` declares, and outlives the renderer.
    let seen = unsafe { lend::shaded(device, output, &settings, slots, &shading, set.layout) }?;
    let seen = Solids::new(seen, &objects)?;
    let parallel = Planes::Depth { parallel: true };
    let output = lend::pass(&map::OPTIONS, &[], parallel);
    let casting = Renderer::new(device, output, &settings, host::FRAMES)?;
    if case == Case::BallNotInMap {
        objects.pop();
    }
    Ok([Solids::new(casting, &objects)?, seen])
}

/// The values of `HostSun` in `sun.glsl`.
fn sun(map: &SunMap) -> Vec<[f32; 4]> {
    let texel = Vec4::new(map::TEXEL as f32, 1.0 / map::SIZE as f32, 0.0, 0.0);
    let mut all = vec![
        scene::EYE.as_vec3().extend(1.0),
        scene::towards_sun().as_vec3().extend(0.0),
        Vec3::new(2.4, 2.2, 1.9).extend(1.0),
        Vec3::new(0.24, 0.28, 0.36).extend(1.0),
        texel,
    ];
    let map_from_world = map.map_from_world().as_mat4();
    all.extend((0..4).map(|n| map_from_world.col(n)));
    all.iter().map(Vec4::to_array).collect()
}

/// The matrices of the picture.
pub fn view_and_projection() -> [DMat4; 2] {
    host::view_and_projection(scene::EYE, scene::TARGET, &OPTIONS)
}

/// The last of some frames. Each draws the map, then meshes and solids that read it.
fn picture(host: &Host, device: &Device, case: Case) -> Fallible<Vec<u8>> {
    let map = SunMap::new(host, scene::towards_sun())?;
    let set = UniformSet::with_images(host, &sun(&map), &[map.described()?])?;
    let [mut casting, mut seen] = renderers(device, &set, case)?;
    let meshes = scene::meshes(host, case == Case::MeshBall)?;
    let shaders = MeshShaders {
        vertex: include_bytes!("../forward/mesh.vert.spv"),
        fragment: include_bytes!("mesh.frag.spv"),
        sets: &[set.layout],
    };
    let mut stage = Stage::with_shaders(host, OPTIONS, &shaders)?;
    let [view, projection] = view_and_projection();
    let from_eye = lend::view([view, projection], &OPTIONS)?;
    let from_sun = map.view()?;
    let point = vk::PipelineBindPoint::GRAPHICS;
    let casters = if case == Case::EmptyMap {
        &[]
    } else {
        &*meshes
    };
    for frame in 0..COUNT {
        let (cmd, slot) = stage.begin()?;
        // SAFETY: the stage has waited for the slot's last frame; `cmd` is recording outside of its
        // pass; the map's pass has the formats of its renderer; the layout of meshes has the set at 0.
        let prepared = unsafe {
            let cast = casting.prepare(cmd, (frame, slot), &from_sun)?;
            let prepared = seen.prepare(cmd, (frame, slot), &from_eye)?;
            map.draw(cmd, casters, || match case {
                Case::EmptyMap => Ok(()),
                _ => Ok(casting.renderer.record(cmd, &cast)?),
            })?;
            set.bind(cmd, point, stage.meshes.layout, 0);
            prepared
        };
        // SAFETY: the frame was prepared, and the pass is of the output's formats; the renderer's
        // layout has the set at 3.
        let solids = || unsafe {
            set.bind(cmd, point, seen.renderer.pipeline_layout()?, 3);
            Ok(seen.renderer.record(cmd, &prepared)?)
        };
        stage.draw(slot, (projection * view, Vec3::Z), &meshes, solids)?;
    }
    Ok(stage.read()?.0)
}
