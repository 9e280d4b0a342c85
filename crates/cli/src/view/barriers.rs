//! Uses of the window's images, and the barriers between them.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::vulkan::Vulkan;
use ash::vk;

/// The whole range of an image with one level.
pub fn range(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default()
        .aspect_mask(aspect)
        .level_count(1)
        .layer_count(1)
}

/// The whole range of an image with one level, for copies.
pub fn layers(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers::default()
        .aspect_mask(aspect)
        .layer_count(1)
}

/// A use of an image: its layout, the stages and accesses of the use.
#[derive(Clone, Copy)]
pub struct Use(vk::ImageLayout, vk::PipelineStageFlags, vk::AccessFlags);

impl Use {
    pub const COLOR: Self = Self(
        vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw(),
        ),
    );
    pub const DEPTH: Self = Self(
        vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL,
        vk::PipelineStageFlags::from_raw(
            vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
                | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
        ),
        vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
    );
    pub const COPIED_TO: Self = Self(
        vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        vk::PipelineStageFlags::TRANSFER,
        vk::AccessFlags::TRANSFER_WRITE,
    );
    pub const COPIED_FROM: Self = Self(
        vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        vk::PipelineStageFlags::TRANSFER,
        vk::AccessFlags::TRANSFER_READ,
    );
    pub const PRESENTED: Self = Self(
        vk::ImageLayout::PRESENT_SRC_KHR,
        vk::PipelineStageFlags::BOTTOM_OF_PIPE,
        vk::AccessFlags::empty(),
    );

    /// The same use with its content discarded: the next use may begin after this one.
    pub const fn discarded(self) -> Self {
        Self(vk::ImageLayout::UNDEFINED, self.1, self.2)
    }
}

/// Records the change of an image from one use to another.
///
/// # Safety
/// `cmd` is recording outside of a pass. The image lives until `cmd` has run, and is used as given.
pub unsafe fn change(
    host: &Vulkan,
    cmd: vk::CommandBuffer,
    (image, aspect): (vk::Image, vk::ImageAspectFlags),
    from: Use,
    to: Use,
) {
    let barrier = vk::ImageMemoryBarrier::default()
        .image(image)
        .subresource_range(range(aspect))
        .old_layout(from.0)
        .new_layout(to.0)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .src_access_mask(from.2)
        .dst_access_mask(to.2);
    let none = vk::DependencyFlags::empty();
    let device = &host.device;
    // SAFETY: as the caller promised.
    unsafe { device.cmd_pipeline_barrier(cmd, from.1, to.1, none, &[], &[], &[barrier]) };
}
