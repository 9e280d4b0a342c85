//! A frame of the window: a picture is acquired, drawn into, presented.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::barriers::{Use, change};
use super::frames::Frames;
use super::memory::Image;
use super::screenshot::Screenshot;
use super::swapchain::{Shown, Swapchain};
use super::vulkan::Vulkan;
use ash::vk;
use revmap::error::Result;
use revmap_files::Picture;
use std::rc::Rc;

pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// The window's pictures, a depth buffer, and the frames in flight.
pub struct Screen {
    /// `None` while there are no pictures.
    depth: Option<Image>,
    chain: Swapchain,
    pub frames: Frames,
    host: Rc<Vulkan>,
}

/// A frame that is being recorded.
#[derive(Clone, Copy)]
pub struct Recording {
    pub commands: vk::CommandBuffer,
    pub slot: usize,
    picture: usize,
}

/// The content of the window's picture before a pass.
pub enum Before {
    /// Every pixel has this colour.
    Cleared([f32; 4]),
    /// The picture holds a copy.
    Kept,
}

impl Screen {
    pub fn new(host: &Rc<Vulkan>, size: (u32, u32)) -> Result<Self> {
        let mut screen = Self {
            depth: None,
            chain: Swapchain::new(host)?,
            frames: Frames::new(host)?,
            host: host.clone(),
        };
        screen.resize(size)?;
        Ok(screen)
    }

    /// Makes pictures of another size.
    pub fn resize(&mut self, size: (u32, u32)) -> Result<()> {
        self.host.wait();
        self.depth = None;
        self.chain.resize(size)?;
        if !self.chain.images.is_empty() {
            let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
            let made = Image::new(&self.host, "depth buffer", DEPTH, self.extent(), usage);
            self.depth = Some(made?);
        }
        Ok(())
    }

    pub fn extent(&self) -> vk::Extent2D {
        self.chain.extent
    }

    pub fn format(&self) -> vk::Format {
        self.chain.format.format
    }

    /// Waits for a free slot and begins its commands. Returns `None` if the window has another size
    /// or its pictures are lost; the caller then calls [`Screen::resize`].
    pub fn begin(&mut self) -> Result<Option<Recording>> {
        let (slot, acquired) = self.frames.wait()?;
        let Some(picture) = self.chain.acquire(acquired)? else {
            return Ok(None);
        };
        let commands = self.frames.begin(slot)?;
        Ok(Some(Recording {
            commands,
            slot,
            picture,
        }))
    }

    /// The frame's picture.
    pub fn picture(&self, frame: Recording) -> vk::Image {
        self.chain.images[frame.picture].image
    }

    /// Begins the pass, with viewport and scissor set. The caller has changed a kept picture to be
    /// drawn into.
    pub fn begin_pass(&self, frame: Recording, before: Before) {
        use vk::ImageLayout as L;
        let (host, device) = (&*self.host, &self.host.device);
        let Shown { image, view, .. } = self.chain.images[frame.picture];
        let (load, [r, g, b, _]) = match before {
            Before::Cleared(color) => (vk::AttachmentLoadOp::CLEAR, color),
            Before::Kept => (vk::AttachmentLoadOp::LOAD, [0.0; 4]),
        };
        let attachment = |view, layout, load, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(view)
                .image_layout(layout)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let color = vk::ClearValue {
            color: vk::ClearColorValue {
                float32: [r, g, b, 1.0],
            },
        };
        let far = vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: 1.0,
                stencil: 0,
            },
        };
        let depth = self.depth.as_ref();
        let tested = depth.map_or(vk::ImageView::null(), |d| d.view);
        let colors = [attachment(view, L::COLOR_ATTACHMENT_OPTIMAL, load, color)];
        let clear = vk::AttachmentLoadOp::CLEAR;
        let depths = attachment(tested, L::DEPTH_ATTACHMENT_OPTIMAL, clear, far);
        let area = vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent: self.extent(),
        };
        let info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depths);
        let viewport = vk::Viewport {
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            max_depth: 1.0,
            ..Default::default()
        };
        let cmd = frame.commands;
        // SAFETY: `cmd` is recording outside of a pass; the images live as long as `self`.
        unsafe {
            if let Before::Cleared(_) = before {
                let shown = (image, vk::ImageAspectFlags::COLOR);
                change(host, cmd, shown, Use::COLOR.discarded(), Use::COLOR);
            }
            if let Some(depth) = depth {
                // The former frame may still use the depth buffer.
                let tested = (depth.raw, depth.aspect);
                change(host, cmd, tested, Use::DEPTH.discarded(), Use::DEPTH);
            }
            device.cmd_begin_rendering(cmd, &info);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Ends the pass, submits and presents; with `keep` the picture is also read. Returns true if
    /// the pictures still fit the window.
    pub fn finish(&mut self, frame: Recording, keep: bool) -> Result<(bool, Option<Picture>)> {
        use vk::PipelineStageFlags as S;
        let (host, cmd) = (&self.host, frame.commands);
        let Shown { image, drawn, .. } = self.chain.images[frame.picture];
        let shown = (image, vk::ImageAspectFlags::COLOR);
        // SAFETY: `cmd` is recording within the pass; what is recorded lives until the device is
        // done.
        let kept = unsafe {
            host.device.cmd_end_rendering(cmd);
            if keep {
                change(host, cmd, shown, Use::COLOR, Use::COPIED_FROM);
                let (extent, format) = (self.extent(), self.format());
                let kept = Screenshot::record(host, cmd, image, extent, format)?;
                change(host, cmd, shown, Use::COPIED_FROM, Use::PRESENTED);
                Some(kept)
            } else {
                change(host, cmd, shown, Use::COLOR, Use::PRESENTED);
                None
            }
        };
        // The first use of the picture is its pass, or the copy into it.
        let first = S::COLOR_ATTACHMENT_OUTPUT | S::TRANSFER;
        self.frames.submit(frame.slot, first, drawn)?;
        let fits = self.chain.present(frame.picture);
        let picture = match kept {
            Some(kept) => {
                self.frames.wait_for(frame.slot)?;
                Some(kept.picture())
            }
            None => None,
        };
        Ok((fits?, picture))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.host.wait();
    }
}
