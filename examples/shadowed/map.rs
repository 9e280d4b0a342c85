//! The sun's shadow map: a depth image, and the pass that draws meshes and solids into it along
//! parallel rays.

use super::host::memory::HostImage;
use super::host::{self, Fallible, Host, Mesh, MeshPipeline, MeshShaders, Options, attachments};
use ash::vk;
use glam::{DMat4, DVec3, DVec4, Vec3};
use revmap::gpu::{DepthOrder, View, Viewport};

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

const OPTIONS: Options = Options {
    width: SIZE,
    height: SIZE,
    dynamic: true,
    samples: 1,
    reversed: false,
};
/// The layout in which shaders read the map.
const READ: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;

/// A map that all frames in flight share: barriers keep their passes apart.
pub struct SunMap<'a> {
    image: HostImage<'a>,
    sampler: vk::Sampler,
    meshes: MeshPipeline<'a>,
    view: DMat4,
    projection: DMat4,
    host: &'a Host,
}

impl<'a> SunMap<'a> {
    /// A map for the unit direction towards the sun.
    pub fn new(host: &'a Host, towards: DVec3) -> Fallible<Self> {
        let sampled = vk::ImageUsageFlags::SAMPLED;
        let image = HostImage::with_usage(host, &OPTIONS, host::DEPTH, 1, sampled)?;
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
            image,
            sampler,
            meshes,
            view,
            projection,
            host,
        })
    }

    /// The solids' view of the map.
    pub fn view(&self) -> revmap::Result<View> {
        let viewport = Viewport {
            x: 0.0,
            y: 0.0,
            width: f64::from(SIZE),
            height: f64::from(SIZE),
        };
        let seen = View::from_matrices(self.view, self.projection, viewport, DepthOrder::Normal)?;
        Ok(seen.with_depth_bias(BIAS))
    }

    /// From the world to texture coordinates and depth.
    pub fn map_from_world(&self) -> DMat4 {
        let half = DVec3::new(0.5, 0.5, 0.0);
        let to_texture = DMat4::from_translation(half) * DMat4::from_scale(half + DVec3::Z);
        to_texture * self.projection * self.view
    }

    /// The map, as a set of the forward pass names it.
    pub fn described(&self) -> vk::DescriptorImageInfo {
        vk::DescriptorImageInfo::default()
            .image_view(self.image.view)
            .sampler(self.sampler)
            .image_layout(READ)
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
        use vk::AccessFlags as A;
        use vk::PipelineStageFlags as S;
        let device = &self.host.device;
        let tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
        let written = A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE;
        let (image, drawn) = (&self.image, self.image.drawn());
        let barrier = |from, to, change: vk::ImageMemoryBarrier<'_>| {
            let none = vk::DependencyFlags::empty();
            // SAFETY: `cmd` is recording outside of a pass.
            unsafe { device.cmd_pipeline_barrier(cmd, from, to, none, &[], &[], &[change]) };
        };
        // The frame before has read its map.
        let emptied = (image.barrier(vk::ImageLayout::UNDEFINED, drawn))
            .src_access_mask(A::empty())
            .dst_access_mask(written);
        barrier(S::FRAGMENT_SHADER, tests, emptied);
        let far = vk::ClearDepthStencilValue {
            depth: 1.0,
            stencil: 0,
        };
        let depth = vk::RenderingAttachmentInfo::default()
            .image_view(image.view)
            .image_layout(drawn)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(vk::ClearValue { depth_stencil: far });
        let info = vk::RenderingInfo::default()
            .render_area(vk::Rect2D::default().extent(OPTIONS.extent()))
            .layer_count(1)
            .depth_attachment(&depth);
        let clip = DMat4::from_translation(BIAS * DVec3::Z) * self.projection * self.view;
        // SAFETY: as the caller promised.
        unsafe {
            device.cmd_begin_rendering(cmd, &info);
            attachments::set_viewport(self.host, cmd, &OPTIONS);
            self.meshes.draw(cmd, clip, Vec3::Z, meshes);
            let drawn = solids();
            device.cmd_end_rendering(cmd);
            drawn?;
        }
        // The forward pass reads what was written.
        let read = (image.barrier(drawn, READ))
            .src_access_mask(A::DEPTH_STENCIL_ATTACHMENT_WRITE)
            .dst_access_mask(A::SHADER_READ);
        barrier(tests, S::FRAGMENT_SHADER, read);
        Ok(())
    }
}

impl Drop for SunMap<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe { self.host.device.destroy_sampler(self.sampler, None) };
    }
}
