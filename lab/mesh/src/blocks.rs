//! What the CPU tells the GPU: the layouts of `shaders/mesh.glsl`.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use revmap::gpu::View;
use revmap::scene::{CameraFrame, Growth, Lighting, Object, Placement};

/// Most lights; a renderer takes no more.
pub(super) const MAX_LIGHTS: usize = 8;

/// `Light`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct LightBlock {
    towards: [f32; 4],
    color: [f32; 4],
}

/// `FrameBlock`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct FrameBlock {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    dir_00: [f32; 4],
    dir_x: [f32; 4],
    dir_y: [f32; 4],
    ambient: [f32; 4],
    lights: [LightBlock; MAX_LIGHTS],
    sky: [[f32; 4]; 2],
}

impl FrameBlock {
    /// `camera` is the one that `view` was made from.
    pub fn new(view: &View, camera: &CameraFrame, lighting: &Lighting) -> Self {
        let mut lights = [LightBlock::default(); MAX_LIGHTS];
        for (block, light) in lights.iter_mut().zip(&lighting.lights) {
            let towards = -light.direction.normalize_or_zero().as_vec3();
            let cosine = 1.0 - light.cap();
            let spread = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine.max(1e-3);
            block.towards = towards.extend(spread as f32).to_array();
            block.color = [light.color[0], light.color[1], light.color[2], 0.0];
        }
        let vector = |v: DVec3| v.as_vec3().extend(0.0).to_array();
        let [red, green, blue] = lighting.ambient;
        let sky = lighting.environment.map(|sky| [sky.up, sky.down]);
        let sky = sky.unwrap_or_default();
        Self {
            clip_from_world: view.clip_from_world().as_mat4().to_cols_array_2d(),
            eye: vector(view.eye()),
            dir_00: vector(camera.pixel(0, 0)),
            dir_x: vector(camera.right),
            dir_y: vector(-camera.up),
            ambient: [red, green, blue, 0.0],
            lights,
            sky: sky.map(|[r, g, b]| [r, g, b, 0.0]),
        }
    }
}

/// `Instance`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct InstanceBlock {
    position_sx: [f32; 4],
    rotation: [f32; 4],
    scale_yz: [f32; 4],
}

impl From<&Placement> for InstanceBlock {
    fn from(placement: &Placement) -> Self {
        let scale = placement.scale.as_vec3();
        Self {
            position_sx: placement.position.as_vec3().extend(scale.x).to_array(),
            rotation: placement.rotation.normalize().as_quat().to_array(),
            scale_yz: [scale.y, scale.z, 0.0, 0.0],
        }
    }
}

/// `ObjectBlock`: 96 of the 128 bytes that every device pushes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct ObjectBlock {
    axis: [f32; 4],
    albedo: [f32; 4],
    specular: [f32; 4],
    single: InstanceBlock,
}

impl ObjectBlock {
    /// `first` is the instance of an object that has one.
    pub fn new(object: &Object, growth: &Growth, first: Option<&InstanceBlock>) -> Self {
        let [x, y] = object.axis_offset();
        let [red, green, blue] = object.color;
        let material = object.material();
        #[allow(clippy::cast_possible_truncation)]
        let [x, y] = [x as f32, y as f32];
        Self {
            axis: [x, y, material.roughness, material.metalness],
            albedo: [red, green, blue, object.specular.strength],
            #[allow(clippy::cast_possible_truncation)]
            specular: [
                object.specular.shininess,
                growth.height() as f32,
                growth.low as f32,
                (2.0 * (object.profile.radius * growth.height() - growth.side)) as f32,
            ],
            single: first.copied().unwrap_or_default(),
        }
    }
}

/// `CasterBlock`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct CasterBlock {
    pub clip_from_world: [[f32; 4]; 4],
    pub axis: [f32; 4],
}

/// `ShadowMap`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct MapBlock {
    pub atlas_from_world: [[f32; 4]; 4],
    pub square: [f32; 4],
    pub facts: [f32; 4],
    pub per_unit: [f32; 4],
}
