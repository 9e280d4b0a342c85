//! Images of a host as textures of objects.

use crate::error::{Error, ErrorKind, Result};
use ash::vk;
use std::sync::Arc;

/// An image of the host, for [`Renderer::set_color_image`](crate::gpu::Renderer::set_color_image),
/// [`Renderer::set_slope_image`](crate::gpu::Renderer::set_slope_image) and
/// [`Renderer::set_height_image`](crate::gpu::Renderer::set_height_image). Clones are the same image.
/// Objects with the same image share draws.
#[derive(Clone, Debug)]
pub struct HostImage(Arc<Handles>);

#[derive(Debug)]
struct Handles {
    view: vk::ImageView,
    sampler: vk::Sampler,
}

impl HostImage {
    /// An image of a 2D view and a sampler.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for null handles.
    ///
    /// # Safety
    /// The call keeps the handles. Renderers bind them.
    ///
    /// The caller must ensure that
    /// * both are of the renderer's device, and stay valid while [`HostImage::is_held`] is true and
    ///   until commands that were recorded before have run;
    /// * the format is of floats or fractions, with linear filter if the sampler has one;
    /// * the image is in `SHADER_READ_ONLY_OPTIMAL` while recorded frames run, and its writes are
    ///   visible to the stage that draws.
    pub unsafe fn new(view: vk::ImageView, sampler: vk::Sampler) -> Result<Self> {
        if view == vk::ImageView::null() || sampler == vk::Sampler::null() {
            let message = "the image's view or sampler is null; give both";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        Ok(Self(Arc::new(Handles { view, sampler })))
    }

    /// True while another clone is alive: of the host, of an object, or of a slot. A slot holds the
    /// images of its last frame until it is prepared again.
    #[must_use]
    pub fn is_held(&self) -> bool {
        Arc::strong_count(&self.0) > 1
    }

    /// The address by which sets of textures are shared.
    pub(crate) fn address(&self) -> usize {
        Arc::as_ptr(&self.0) as usize
    }

    pub(crate) fn info(&self) -> vk::DescriptorImageInfo {
        vk::DescriptorImageInfo::default()
            .image_view(self.0.view)
            .sampler(self.0.sampler)
            .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
    }
}

/// The images of an object. An image replaces the object's own map.
#[derive(Clone, Debug, Default)]
pub(crate) struct ObjectImages {
    pub color: Option<HostImage>,
    /// Slopes, or the heights that they are differences of.
    pub relief: Option<HostImage>,
    /// True if `relief` holds heights.
    pub heights: bool,
}
