//! Images of a host as textures of objects.

use super::RevmapRenderer;
use super::objects::{RevmapObject, with_object};
use crate::fault::{RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::pointers::put;
use ash::vk;
use revmap::gpu::{HostImage, ObjectId, Renderer};
use std::sync::Arc;

/// An image of the host for textures of objects. Objects with the same image share draws.
pub struct RevmapHostImage;
handle!(RevmapHostImage, "host image", Arc<HostImage>);

/// Makes an image of a 2D view and a sampler, both of the renderer's device. They stay valid while
/// revmap_host_image_is_held() gives 1, and until commands recorded before have run. The image is in
/// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL while recorded frames run, and its writes are visible to
/// the stage that draws.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_host_image_create(
    view: vk::ImageView,
    sampler: vk::Sampler,
    image: *mut *mut RevmapHostImage,
) -> RevmapResult {
    // SAFETY: the caller's pointer and handles.
    unsafe { create(image, || Ok(Arc::new(HostImage::new(view, sampler)?))) }
}

/// Returns 1 if an object or a slot holds the image, else 0. A slot holds the images of its last frame
/// until it is prepared again.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_host_image_is_held(
    image: *const RevmapHostImage,
    held: *mut u32,
) -> RevmapResult {
    // SAFETY: the caller's pointer.
    enter(|| unsafe {
        put(held, "held", || {
            Ok(u32::from(RevmapHostImage::get(image)?.is_held()))
        })
    })
}

/// Destroys the handle; null is none. Objects keep the image, and the handle can no longer say whether
/// it is held.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_host_image_destroy(image: *mut RevmapHostImage) -> RevmapResult {
    enter(|| RevmapHostImage::destroy(image))
}

/// Sets an image of an object by a function of the renderer; null for none.
fn set(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    image: *const RevmapHostImage,
    set: fn(&mut Renderer, ObjectId, Option<HostImage>) -> revmap::Result<()>,
) -> RevmapResult {
    enter(|| {
        let image = RevmapHostImage::get_optional(image)?.map(|image| HostImage::clone(&image));
        with_object(renderer, object, |r, id| set(r, id, image))
    })
}

/// Sets an image as the colours of an object, in place of its color_map; null for that map again.
/// Frames that were prepared earlier keep their image.
///
/// Thread: one at a time for a renderer.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_set_color_image(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    image: *const RevmapHostImage,
) -> RevmapResult {
    set(renderer, object, image, Renderer::set_color_image)
}

/// Sets an image as the slopes of an object, in place of its height_map; null for that map again. The
/// first two channels are the slopes of heights over texture coordinates: to the right over the whole
/// width, upwards over the whole height. It replaces an image of heights.
///
/// Thread: one at a time for a renderer.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_set_slope_image(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    image: *const RevmapHostImage,
) -> RevmapResult {
    set(renderer, object, image, Renderer::set_slope_image)
}

/// Same as revmap_renderer_set_slope_image, for an image whose first channel is heights, 0 to 1. Each
/// pixel reads it four times: an image of slopes is faster. It replaces an image of slopes.
///
/// Thread: one at a time for a renderer.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_set_height_image(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    image: *const RevmapHostImage,
) -> RevmapResult {
    set(renderer, object, image, Renderer::set_height_image)
}
