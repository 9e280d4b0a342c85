//! Objects of a renderer: added, changed, removed; images of a host as their textures.

use super::RevmapRenderer;
use crate::fault::{Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, handle, with};
use crate::object::{RevmapObjectInfo, placements};
use crate::pointers::{list, put, take};
use crate::rays::{self, RevmapRayCaster};
use crate::structures::read;
use crate::values::{RevmapOffset, RevmapPlacement};
use ash::vk;
use revmap::gpu::{HostImage, ObjectId, Renderer};
use std::sync::Arc;

/// An object of one renderer, which refuses those of others; never 0. The number refers to the same
/// object for all its values, and is never reused after its removal.
pub type RevmapObject = u64;

/// Calls `work` with a renderer and one of its objects.
fn with_object<R>(
    renderer: *const RevmapRenderer,
    object: RevmapObject,
    work: impl FnOnce(&mut Renderer, ObjectId) -> revmap::Result<R>,
) -> Outcome<R> {
    let id = ObjectId::from_bits(object);
    with(renderer, |r| Ok(work(&mut r.renderer, id)?))
}

/// Adds an object, which is drawn from the next prepared frame on.
///
/// Fails with REVMAP_RESULT_CONTENT for values out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_add(
    renderer: *mut RevmapRenderer,
    info: *const RevmapObjectInfo,
    object: *mut RevmapObject,
) -> RevmapResult {
    put(object, "object", || {
        let added = read(info)?.object()?;
        with(renderer, |r| Ok(r.renderer.add(added)?.to_bits()))
    })
}

/// Removes an object. Data that frames in flight read is kept until they are done.
///
/// Fails with REVMAP_RESULT_USAGE for an object that is not there, as do all functions that take
/// one.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_remove(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
) -> RevmapResult {
    enter(|| with_object(renderer, object, Renderer::remove))
}

/// Gives an object other values, all of them. Values that are equal cost nothing.
///
/// Fails with REVMAP_RESULT_CONTENT for values out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_set(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    info: *const RevmapObjectInfo,
) -> RevmapResult {
    enter(|| {
        let values = read(info)?.object()?;
        with_object(renderer, object, |r, id| r.set(id, values))
    })
}

/// Sets which views show an object: those whose mask shares a bit with this one. With 0 no view
/// shows it. A hidden object throws no shadow. New objects are in all masks.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_set_mask(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    mask: u32,
) -> RevmapResult {
    enter(|| with_object(renderer, object, |r, id| r.set_mask(id, mask)))
}

/// Returns the number of an object in REVMAP_ATTACHMENT_IDENTITY. No two objects of a renderer have
/// the same one at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_object_number(
    renderer: *const RevmapRenderer,
    object: RevmapObject,
    number: *mut u32,
) -> RevmapResult {
    put(number, "number", || {
        with_object(renderer, object, |r, id| r.object(id).map(|_| id.number()))
    })
}

/// Prepares an object for rays, with the values that it has now.
///
/// Fails like revmap_ray_caster_create().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_ray_caster(
    renderer: *const RevmapRenderer,
    object: RevmapObject,
    ray_caster: *mut *mut RevmapRayCaster,
) -> RevmapResult {
    create(ray_caster, || {
        let values = with_object(renderer, object, |r, id| r.object(id).cloned())?;
        rays::caster(&values)
    })
}

/// Moves the surface of an object: extension, bevel and chamfer.
///
/// Fails like revmap_renderer_set().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_set_offset(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    offset: *const RevmapOffset,
) -> RevmapResult {
    enter(|| {
        let offset = take(offset, "offset")?;
        with_object(renderer, object, |r, id| r.set_offset(id, offset.into()))
    })
}

/// Moves an object that is one copy.
///
/// Fails like revmap_renderer_set().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_set_placement(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    placement: *const RevmapPlacement,
) -> RevmapResult {
    enter(|| {
        let placement = take(placement, "placement")?;
        let placement = placement.into();
        with_object(renderer, object, |r, id| r.set_placement(id, placement))
    })
}

/// Gives an object other copies; with a count of 0 it is one, at its placement.
///
/// Fails like revmap_renderer_set().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_set_instances(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    instances: *const RevmapPlacement,
    count: usize,
) -> RevmapResult {
    enter(|| {
        let all = placements(list(instances, count, "instances")?);
        with_object(renderer, object, |r, id| r.set_instances(id, all))
    })
}

/// An image of the host for textures of objects. Objects with the same image share draws.
pub struct RevmapHostImage;
handle!(RevmapHostImage, "host image", Arc<HostImage>);

/// Makes an image of a 2D view and a sampler, both of the renderer's device. They stay valid while
/// revmap_host_image_is_held() gives 1, and until commands recorded before have run. The image is in
/// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL while recorded frames run, and its writes are visible to
/// the stage that draws.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_host_image_create(
    view: vk::ImageView,
    sampler: vk::Sampler,
    image: *mut *mut RevmapHostImage,
) -> RevmapResult {
    create(image, || Ok(HostImage::new(view, sampler)?))
}

/// Returns 1 if an object or a slot holds the image, else 0. A slot holds the images of its last frame
/// until it is prepared again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_host_image_is_held(
    image: *const RevmapHostImage,
    held: *mut u32,
) -> RevmapResult {
    put(held, "held", || {
        Ok(u32::from(RevmapHostImage::get(image)?.is_held()))
    })
}

/// Destroys the handle; null is none. Objects keep the image, and the handle can no longer say whether
/// it is held.
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
/// What is read counts as linear: give sRGB texels a view of an _SRGB format. Frames that were prepared
/// earlier keep their image.
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
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_set_height_image(
    renderer: *mut RevmapRenderer,
    object: RevmapObject,
    image: *const RevmapHostImage,
) -> RevmapResult {
    set(renderer, object, image, Renderer::set_height_image)
}
