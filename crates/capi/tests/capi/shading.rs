//! A host's shading and images through the C interface: what the Rust renderer draws.

use crate::host::{Host, Stage, Texture, UniformSet, borrow, open};
use crate::names::*;
use crate::recording::{OPTIONS, POINTS, RANGE, camera, lend, render_pass, scene};
use revmap::shading::Shading;
use std::cell::RefCell;

const BYTES: &[u8] = include_bytes!("../../../../examples/forward/shade.shading");
const GRAPHICS: vk::PipelineBindPoint = vk::PipelineBindPoint::GRAPHICS;

/// The lights of `examples/forward`: a sun, a sky, no lamps.
fn lights(host: &Host) -> UniformSet<'_> {
    let mut all = vec![[0.1f32; 4]; 10];
    all[1] = [0.6, 0.0, 0.8, 0.0];
    all[2] = [2.0; 4];
    UniformSet::of(host, &all).unwrap()
}

/// What the Rust renderer draws with the shading and the image.
fn drawn(host: &Host, stage: &mut Stage, set: &UniformSet, image: &HostImage) -> Vec<u8> {
    let device = borrow(host);
    let begun = PassKind::RenderPass {
        // SAFETY: the stage outlives the renderer.
        pass: unsafe { HostPass::new(stage.into.pass) },
        subpass: 0,
    };
    let output = Output::Pass(PassFormats::new(begun, Planes::Color));
    let by = HostShading {
        shading: Arc::new(Shading::from_bytes(BYTES).unwrap()),
        set_layout: set.layout,
    };
    let search = SearchSettings::default();
    // SAFETY: the layout has what the function reads, and outlives the renderer.
    let made = unsafe { Renderer::with_shading(&device, output, &search, 2, &by) };
    let mut renderer = made.unwrap();
    let scene = scene();
    let id = renderer.add(scene.objects[0].clone()).unwrap();
    renderer.set_color_image(id, Some(image.clone())).unwrap();
    let view = View::from_camera(&scene.camera, (OPTIONS.width, OPTIONS.height), RANGE).unwrap();
    let renderer = RefCell::new(&mut renderer);
    let drawn = stage.frame(
        DMat4::IDENTITY,
        Vec3::Z,
        &[],
        // SAFETY: the stage has waited for the slot; `cmd` is recording outside of its pass.
        |cmd, slot| Ok(unsafe { renderer.borrow_mut().prepare(cmd, slot, &view) }?),
        // SAFETY: the frame was prepared, and the renderer's layout has the set.
        |cmd, frame| unsafe {
            set.bind(cmd, GRAPHICS, renderer.borrow().pipeline_layout()?, 3);
            Ok(renderer.borrow().record(cmd, frame)?)
        },
    );
    drawn.unwrap();
    stage.read().unwrap().0
}

#[test]
fn a_hosts_shading_and_image_are_drawn_as_in_rust() {
    let host = open();
    let mut stage = Stage::new(&host, OPTIONS).unwrap();
    let set = lights(&host);
    let texture = Texture::new(&host, vk::Format::R8G8B8A8_UNORM, &[[230, 77, 26, 255]; 16]);
    let image = texture.image();
    let wanted = drawn(&host, &mut stage, &set, &image);
    let (device, camera) = (lend(&host), camera());
    // SAFETY: live values; the stage has waited for a slot before it is prepared, and its pass is
    // the renderer's.
    unsafe {
        let pass = render_pass(&stage);
        let (mut renderer, mut shading, mut image) = (null_mut(), null_mut(), null_mut());
        let (mut profile, mut object) = (null_mut(), 0);
        let bytes = BYTES.as_ptr().cast();
        ok! {
            revmap_shading_from_bytes(bytes, BYTES.len(), &mut shading);
            revmap_renderer_create_with_shading(device, &pass, shading, set.layout, null(), 2, &mut renderer);
            revmap_shading_destroy(shading);
            revmap_profile_from_points(POINTS.as_ptr(), POINTS.len(), 0.4, &mut profile);
            revmap_host_image_create(texture.memory.view, texture.sampler, &mut image);
        }
        let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
        info.profile = profile;
        ok! {
            revmap_renderer_add(renderer, &info, &mut object);
            revmap_profile_destroy(profile);
            revmap_renderer_set_color_image(renderer, object, image);
        }
        let mut layout = vk::PipelineLayout::null();
        ok! { revmap_renderer_pipeline_layout(renderer, &mut layout); }
        let draw = |stage: &mut Stage| {
            let prepare = |cmd, slot: usize| {
                let (w, h, [near, far]) = (OPTIONS.width, OPTIONS.height, RANGE);
                ok! { revmap_renderer_prepare_camera(renderer, cmd, slot as u32, &camera, w, h, near, far); }
                Ok(slot)
            };
            let record = |cmd, &slot: &usize| {
                set.bind(cmd, GRAPHICS, layout, 3);
                ok! { revmap_renderer_record(renderer, cmd, slot as u32); }
                Ok(())
            };
            let drawn = stage.frame(DMat4::IDENTITY, Vec3::Z, &[], prepare, record);
            drawn.unwrap();
            stage.read().unwrap().0
        };
        let held = || {
            let mut held = 7;
            ok! { revmap_host_image_is_held(image, &mut held); }
            held
        };
        assert!(draw(&mut stage) == wanted, "pixels differ");
        let solid = wanted.chunks_exact(4).filter(|p| *p != &wanted[..4]);
        assert!(solid.count() > 1500);
        assert_eq!(held(), 1);
        ok! { revmap_renderer_set_color_image(renderer, object, null()); }
        assert!(draw(&mut stage) != wanted, "the image is still shown");
        assert_eq!(held(), 1, "the other slot holds it");
        draw(&mut stage);
        assert_eq!(held(), 0);
        ok! {
            revmap_renderer_set_slope_image(renderer, object, image);
            revmap_renderer_set_height_image(renderer, object, image);
            revmap_host_image_destroy(image);
            revmap_renderer_destroy(renderer);
            revmap_device_destroy(device);
        }
    }
}

#[test]
fn wrong_shadings_and_images_are_refused() {
    let host = open();
    let device = lend(&host);
    let (mut shading, mut renderer, mut image) = (null_mut(), null_mut(), null_mut());
    // SAFETY: live values, or null.
    unsafe {
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
            Usage, "needs compute": revmap_renderer_create_compute_with_shading(device, planes, shading, nothing, null(), 1, &mut renderer);
            Handle, "null": revmap_renderer_create_with_shading(device, &pass, null(), nothing, null(), 1, &mut renderer);
            Handle, "host image": revmap_renderer_set_color_image(null_mut(), 1, shading.cast());
        }
        ok! {
            revmap_shading_destroy(shading);
            revmap_device_destroy(device);
        }
    }
}

/// GLSL is compiled where the library has a compiler; elsewhere the text says what to do.
#[test]
fn glsl_is_compiled_or_refused() {
    let (names, texts) = (
        [c"a.glsl".as_ptr()],
        [c"vec4 host_shade(Surface s) { return x; }".as_ptr()],
    );
    let mut shading = null_mut();
    let stage = RevmapStage::Fragment as u32;
    // SAFETY: live values.
    let (result, text) = unsafe {
        let made = revmap_shading_compile(stage, names.as_ptr(), texts.as_ptr(), 1, &mut shading);
        (made, crate::text())
    };
    let (wanted, part) = match cfg!(feature = "shaderc") {
        true => (RevmapResult::Content, "a.glsl:1: 'x'"),
        false => (RevmapResult::Usage, "revmap shading"),
    };
    assert_eq!(result, wanted, "{text}");
    assert!(text.contains(part), "{text}");
    #[cfg(feature = "shaderc")]
    // SAFETY: live values.
    unsafe {
        let right = [c"vec4 host_shade(Surface s) { return vec4(s.uv, 0.0, 1.0); }".as_ptr()];
        ok! {
            revmap_shading_compile(stage, names.as_ptr(), right.as_ptr(), 1, &mut shading);
            revmap_shading_destroy(shading);
        }
    }
}
