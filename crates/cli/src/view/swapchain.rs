//! The window's pictures.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::memory::view;
use super::vulkan::{Vulkan, vulkan};
use ash::{khr, vk};
use revmap::error::{Error, ErrorKind, Result};
use std::rc::Rc;

/// One picture.
#[derive(Clone, Copy)]
pub struct Shown {
    pub image: vk::Image,
    pub view: vk::ImageView,
    /// Presenting waits for this semaphore.
    pub drawn: vk::Semaphore,
}

pub struct Swapchain {
    functions: khr::swapchain::Device,
    chain: vk::SwapchainKHR,
    pub images: Vec<Shown>,
    pub extent: vk::Extent2D,
    pub format: vk::SurfaceFormatKHR,
    host: Rc<Vulkan>,
}

impl Swapchain {
    /// Uses of pictures: drawn into, copied to by the compute stage, copied from by screenshots.
    const USAGE: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
        vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw()
            | vk::ImageUsageFlags::TRANSFER_DST.as_raw()
            | vk::ImageUsageFlags::TRANSFER_SRC.as_raw(),
    );

    /// A swapchain without pictures: [`Swapchain::resize`] makes them.
    pub fn new(host: &Rc<Vulkan>) -> Result<Self> {
        // SAFETY: a plain query.
        let formats = unsafe {
            host.surfaces
                .get_physical_device_surface_formats(host.physical, host.surface)
        };
        let formats = vulkan(formats, "vkGetPhysicalDeviceSurfaceFormatsKHR")?;
        let srgb = |f: &&vk::SurfaceFormatKHR| {
            [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB].contains(&f.format)
        };
        let none = || {
            Error::new(
                ErrorKind::Unsupported,
                "the window takes no sRGB pictures of 8 bits",
            )
        };
        Ok(Self {
            functions: khr::swapchain::Device::new(&host.instance, &host.device),
            chain: vk::SwapchainKHR::null(),
            images: Vec::new(),
            extent: vk::Extent2D::default(),
            format: *formats.iter().find(srgb).ok_or_else(none)?,
            host: host.clone(),
        })
    }

    /// Makes pictures of the window's size, or none if the window has no pixels. The device must be
    /// idle.
    pub fn resize(&mut self, (width, height): (u32, u32)) -> Result<()> {
        let host = self.host.clone();
        // SAFETY: the device is idle; the old chain is retired by the new one, and destroyed.
        unsafe {
            let can = self.capabilities()?;
            if !can.supported_usage_flags.contains(Self::USAGE) {
                let message = "the window's pictures cannot be copied; choose another device";
                return Err(Error::new(ErrorKind::Unsupported, message));
            }
            let (low, high) = (can.min_image_extent, can.max_image_extent);
            self.extent = if can.current_extent.width == u32::MAX {
                vk::Extent2D {
                    width: width.clamp(low.width, high.width),
                    height: height.clamp(low.height, high.height),
                }
            } else {
                can.current_extent
            };
            if self.extent.width == 0 || self.extent.height == 0 {
                self.destroy();
                return Ok(());
            }
            let most = match can.max_image_count {
                0 => u32::MAX,
                most => most,
            };
            let info = vk::SwapchainCreateInfoKHR::default()
                .surface(host.surface)
                .min_image_count((can.min_image_count + 1).min(most))
                .image_format(self.format.format)
                .image_color_space(self.format.color_space)
                .image_extent(self.extent)
                .image_array_layers(1)
                .image_usage(Self::USAGE)
                .pre_transform(can.current_transform)
                .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
                .present_mode(vk::PresentModeKHR::FIFO)
                .clipped(true)
                .old_swapchain(self.chain);
            let chain = self.functions.create_swapchain(&info, None);
            let chain = vulkan(chain, "vkCreateSwapchainKHR")?;
            self.destroy();
            self.chain = chain;
            let images = self.functions.get_swapchain_images(chain);
            for image in vulkan(images, "vkGetSwapchainImagesKHR")? {
                let drawn = vk::SemaphoreCreateInfo::default();
                let drawn = host.device.create_semaphore(&drawn, None);
                let drawn = vulkan(drawn, "vkCreateSemaphore")?;
                let color = vk::ImageAspectFlags::COLOR;
                let view = view(&host, image, self.format.format, color);
                self.images.push(Shown {
                    image,
                    view: *view.as_ref().unwrap_or(&vk::ImageView::null()),
                    drawn,
                });
                view?;
            }
            Ok(())
        }
    }

    /// The number of the next picture, which may be drawn into when `acquired` is signalled.
    /// Returns `None` if the window has another size; `acquired` is then unchanged.
    pub fn acquire(&mut self, acquired: vk::Semaphore) -> Result<Option<usize>> {
        if self.images.is_empty() {
            return Ok(None);
        }
        let none = vk::Fence::null();
        let functions = &self.functions;
        // SAFETY: a live chain, and a semaphore that nothing waits for.
        match unsafe { functions.acquire_next_image(self.chain, u64::MAX, acquired, none) } {
            Ok((image, _)) => Ok(Some(image as usize)),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(None),
            Err(code) => vulkan(Err(code), "vkAcquireNextImageKHR"),
        }
    }

    /// Presents a picture when it is drawn. Returns true if the chain still fits the window.
    pub fn present(&mut self, image: usize) -> Result<bool> {
        let (chains, indices) = ([self.chain], [image as u32]);
        let drawn = [self.images[image].drawn];
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&drawn)
            .swapchains(&chains)
            .image_indices(&indices);
        // SAFETY: the picture was acquired, and what signals its semaphore was submitted.
        match unsafe { self.functions.queue_present(self.host.queue, &info) } {
            // Some systems report a picture of the right size as suboptimal; a new one would be
            // suboptimal too.
            Ok(suboptimal) => Ok(!suboptimal || self.fits()?),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(false),
            Err(code) => vulkan(Err(code), "vkQueuePresentKHR"),
        }
    }

    /// Returns true if the window has the pictures' size.
    fn fits(&self) -> Result<bool> {
        let current = self.capabilities()?.current_extent;
        Ok(current.width == u32::MAX || current == self.extent)
    }

    fn capabilities(&self) -> Result<vk::SurfaceCapabilitiesKHR> {
        let Vulkan {
            surfaces,
            physical,
            surface,
            ..
        } = &*self.host;
        // SAFETY: a plain query.
        let can = unsafe { surfaces.get_physical_device_surface_capabilities(*physical, *surface) };
        vulkan(can, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR")
    }

    fn destroy(&mut self) {
        // SAFETY: the device is idle; null handles may be destroyed.
        unsafe {
            for shown in self.images.drain(..) {
                self.host.device.destroy_image_view(shown.view, None);
                self.host.device.destroy_semaphore(shown.drawn, None);
            }
            self.functions.destroy_swapchain(self.chain, None);
        }
        self.chain = vk::SwapchainKHR::null();
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        self.host.wait();
        self.destroy();
    }
}
