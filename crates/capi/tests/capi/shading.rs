//! A host's shading and images through the C interface: what the Rust renderer draws.

use crate::host::{self, Host, Texture, UniformSet, borrow, open};
use crate::names::*;
use crate::recording::{canvas, draw, in_rust, lend, output, render_pass};
use crate::{object_of, spindle};
use revmap::shading::Shading;
use std::ffi::CStr;

const BYTES: &[u8] = include_bytes!("../../../../examples/forward/shade.shading");

/// The lights of `examples/forward`: a sun, a sky, no lamps.
fn lights(host: &Host) -> UniformSet<'_> {
    let mut all = vec![[0.1f32; 4]; 10];
    all[1] = [0.6, 0.0, 0.8, 0.0];
    all[2] = [2.0; 4];
    UniformSet::of(host, &all).unwrap()
}

#[test]
fn a_hosts_shading_and_image_are_drawn_as_in_rust() {
    let host = open();
    let set = lights(&host);
    let texture = Texture::new(&host, vk::Format::R8G8B8A8_UNORM, &[[230, 77, 26, 255]; 16]);
    let (own, by) = (borrow(&host), canvas(&host, false));
    let shading = Arc::new(Shading::from_bytes(BYTES).unwrap());
    let search = SearchSettings::default();
    // SAFETY: the layout has what the function reads, and outlives the renderer.
    let made = unsafe { host::shaded(&own, output(&by), &search, 2, &shading, set.layout) };
    let mut rust = in_rust(&host, made.unwrap(), by);
    rust.renderer.remove(rust.ids[1]).unwrap();
    let image = texture.image();
    rust.renderer
        .set_color_image(rust.ids[0], Some(image))
        .unwrap();
    let (wanted, _) = rust.picture_by(Some(&set));
    drop(rust);
    let (device, canvas) = (lend(&host), canvas(&host, false));
    let pass = render_pass(&canvas);
    let (mut renderer, mut shading, mut image) = (null_mut(), null_mut(), null_mut());
    let (profile, mut object) = (spindle(), 0);
    let bytes = BYTES.as_ptr().cast();
    ok! {
        revmap_shading_from_bytes(bytes, BYTES.len(), &mut shading);
        revmap_renderer_create_with_shading(device, &pass, shading, set.layout, null(), 2, &mut renderer);
        revmap_shading_destroy(shading);
        revmap_host_image_create(texture.memory.view, texture.sampler, &mut image);
    }
    let info = object_of(profile);
    ok! {
        revmap_renderer_add(renderer, &info, &mut object);
        revmap_profile_destroy(profile);
        revmap_renderer_set_color_image(renderer, object, image);
    }
    let mut layout = vk::PipelineLayout::null();
    ok! { revmap_renderer_pipeline_layout(renderer, &mut layout); }
    let drawn = |slot: u32| {
        let record = |cmd| {
            // SAFETY: `cmd` is recording, and the renderer's layout has the set.
            unsafe { set.bind(cmd, vk::PipelineBindPoint::GRAPHICS, layout, 3) };
            ok! { revmap_renderer_record(renderer, cmd, slot); }
        };
        draw(&host, &canvas, renderer, slot, record).0
    };
    let held = || {
        let mut held = 7;
        ok! { revmap_host_image_is_held(image, &mut held); }
        held
    };
    assert!(drawn(0) == wanted, "pixels differ");
    let solid = wanted.chunks_exact(4).filter(|p| *p != &wanted[..4]);
    assert!(solid.count() > 1500);
    assert_eq!(held(), 1);
    ok! { revmap_renderer_set_color_image(renderer, object, null()); }
    assert!(drawn(1) != wanted, "the image is still shown");
    assert_eq!(held(), 1, "the other slot holds it");
    drawn(0);
    assert_eq!(held(), 0);
    ok! {
        revmap_renderer_set_slope_image(renderer, object, image);
        revmap_renderer_set_height_image(renderer, object, image);
        revmap_host_image_destroy(image);
        revmap_renderer_destroy(renderer);
        revmap_device_destroy(device);
    }
}

#[test]
fn wrong_shadings_and_images_are_refused() {
    let host = open();
    let device = lend(&host);
    let (mut shading, mut renderer, mut image) = (null_mut(), null_mut(), null_mut());
    let old = [&BYTES[..8], &[0; 8], &BYTES[16..]].concat();
    let (nothing, sampler) = (vk::DescriptorSetLayout::null(), vk::Sampler::null());
    fail! {
        Content, "another version": revmap_shading_from_bytes(old.as_ptr().cast(), old.len(), &mut shading);
        Content, "damaged": revmap_shading_from_bytes(BYTES.as_ptr().cast(), 900, &mut shading);
        Usage, "null": revmap_shading_from_bytes(null(), 900, &mut shading);
        Usage, "null": revmap_host_image_create(vk::ImageView::null(), sampler, &mut image);
    }
    ok! { revmap_shading_from_bytes(BYTES.as_ptr().cast(), BYTES.len(), &mut shading); }
    let mut count = 0;
    ok! { revmap_shading_bytes(shading, null_mut(), &mut count); }
    let mut room = vec![0u8; count];
    ok! { revmap_shading_bytes(shading, room.as_mut_ptr().cast(), &mut count); }
    assert!(room == BYTES);
    count -= 1;
    let planes = RevmapPlanes::Color as u32;
    let pass = sized!(RevmapPass);
    fail! {
        Usage, "do not fit": revmap_shading_bytes(shading, room.as_mut_ptr().cast(), &mut count);
        Usage, "needs compute": revmap_renderer_create_compute_with_shading(
            device, planes, shading, nothing, null(), 1, &mut renderer
        );
        Handle, "null": revmap_renderer_create_with_shading(device, &pass, null(), nothing, null(), 1, &mut renderer);
        Handle, "host image": revmap_renderer_set_color_image(null_mut(), 1, shading.cast());
    }
    ok! {
        revmap_shading_destroy(shading);
        revmap_device_destroy(device);
    }
}

/// GLSL is compiled where the library has a compiler; elsewhere the text says what to do.
#[test]
fn glsl_is_compiled_or_refused() {
    let (names, mut shading) = ([c"a.glsl".as_ptr()], null_mut());
    let mut compile = |text: &CStr| {
        let (stage, texts) = (RevmapStage::Fragment as u32, [text.as_ptr()]);
        // SAFETY: live values.
        unsafe { revmap_shading_compile(stage, names.as_ptr(), texts.as_ptr(), 1, &mut shading) }
    };
    let wrong = c"vec4 host_shade(Surface s) { return x; }";
    if cfg!(feature = "shaderc") {
        fail! { Content, "a.glsl:1: 'x'": compile(wrong); }
        ok! {
            compile(c"vec4 host_shade(Surface s) { return vec4(s.uv, 0.0, 1.0); }");
            revmap_shading_destroy(shading);
        }
    } else {
        fail! { Usage, "revmap shading": compile(wrong); }
    }
}
