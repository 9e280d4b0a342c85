//! The sun's shadow map: a depth image, and the pass that draws meshes and solids into it along
//! parallel rays.

use super::host::memory::{HostImage, barrier};
use super::host::{
    self, Attachments, Fallible, Host, Mesh, MeshPipeline, MeshShaders, Options, lend,
};
use ash::vk;
use glam::{DMat4, DVec3, DVec4, Vec3};
use revmap::gpu::View;

/// The map is square, of so many texels a side.
pub const SIZE: u32 = 2048;
/// Half a side in the world. It reaches all that casts a shadow; what is beyond is in the sun.
const HALF: f64 = 2.1;
/// The map's middle is so far from its near plane, and its far plane from the middle.
const DISTANCE: f64 = 6.0;
/// A texel's side in the world.
pub const TEXEL: f64 = 2.0 * HALF / SIZE as f64;
/// Depths in the map are farther than the surface by half a texel's side, for what is not flat.
const BIAS: f64 = 0.5 * TEXEL / (2.0 * DISTANCE);

/// Options of its pass.
pub const OPTIONS: Options = Options::new(SIZE, SIZE);
/// The layout in which shaders read the map.
const READ: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;

/// A map that all frames in flight share: barriers keep their passes apart.
pub struct SunMap<'a> {
    into: Attachments<'a>,
    sampler: vk::Sampler,
    meshes: MeshPipeline<'a>,
    view: DMat4,
    projection: DMat4,
    host: &'a Host,
}

impl<'a> SunMap<'a> {
    /// A map for the unit direction towards the sun.
    pub fn new(host: &'a Host, towards: DVec3) -> Fallible<Self> {
        let into = Attachments::new(host, OPTIONS, &[])?;
        let (shaders, no_pass) = (MeshShaders::default(), vk::RenderPass::null());
        let meshes = MeshPipeline::new(host, &shaders, &OPTIONS, no_pass, &[])?;
        // SAFETY: plain query and creation; the sampler is destroyed in Drop.
        let sampler = unsafe {
            let known =
                (host.instance).get_physical_device_format_properties(host.physical, host::DEPTH);
            let linear = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
            let filter = match known.optimal_tiling_features.contains(linear) {
                true => vk::Filter::LINEAR,
                false => vk::Filter::NEAREST,
            };
            let edge = vk::SamplerAddressMode::CLAMP_TO_BORDER;
            let info = vk::SamplerCreateInfo::default()
                .min_filter(filter)
                .mag_filter(filter)
                .address_mode_u(edge)
                .address_mode_v(edge)
                .border_color(vk::BorderColor::FLOAT_OPAQUE_WHITE)
                .compare_enable(true)
                .compare_op(vk::CompareOp::LESS_OR_EQUAL);
            host.device.create_sampler(&info, None)?
        };
        let [view, _] = host::view_and_projection(DISTANCE * towards, DVec3::ZERO, &OPTIONS);
        // Parallel rays along the view's -z; Vulkan's y is downwards.
        let scale = DVec4::new(1.0 / HALF, -1.0 / HALF, -0.5 / DISTANCE, 1.0);
        let projection = DMat4::from_diagonal(scale);
        Ok(Self {
            into,
            sampler,
            meshes,
            view,
            projection,
            host,
        })
    }

    /// The solids' view of the map.
    pub fn view(&self) -> revmap::Result<View> {
        let seen = lend::view([self.view, self.projection], &OPTIONS)?;
        Ok(seen.with_depth_bias(BIAS))
    }

    /// From the world to texture coordinates and depth.
    pub fn map_from_world(&self) -> DMat4 {
        let half = DVec3::new(0.5, 0.5, 0.0);
        let to_texture = DMat4::from_translation(half) * DMat4::from_scale(half + DVec3::Z);
        to_texture * self.projection * self.view
    }

    /// The depths of the pass.
    fn image(&self) -> Fallible<&HostImage<'a>> {
        Ok(self.into.images().last().ok_or("no depth")?)
    }

    /// The map, as a set of the forward pass names it.
    pub fn described(&self) -> Fallible<vk::DescriptorImageInfo> {
        let described = vk::DescriptorImageInfo::default()
            .image_view(self.image()?.view)
            .sampler(self.sampler);
        Ok(described.image_layout(READ))
    }

    /// Records the pass, and the barriers before and after it.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; `solids` records draws of the map's formats.
    pub unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        meshes: &[Mesh<'_>],
        solids: impl FnOnce() -> Fallible<()>,
    ) -> Fallible<()> {
        let clip = DMat4::from_translation(BIAS * DVec3::Z) * self.projection * self.view;
        let image = self.image()?;
        // SAFETY: as the caller promised.
        unsafe {
            self.into.draw(cmd, &[], false, || {
                self.meshes.draw(cmd, clip, Vec3::Z, meshes);
                solids()
            })?;
            // The forward pass reads what was written.
            barrier(self.host, cmd, &[image.barrier(image.drawn(), READ)]);
        }
        Ok(())
    }
}

impl Drop for SunMap<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe { self.host.device.destroy_sampler(self.sampler, None) };
    }
}
