//! Wrong arguments give errors, and leave what was there as it was.

use revmap_capi::device::*;
use revmap_capi::enums::*;
use revmap_capi::fault::*;
use revmap_capi::object::*;
use revmap_capi::offscreen::*;
use revmap_capi::profile::*;
use revmap_capi::renderer::frame::*;
use revmap_capi::renderer::prewarm::*;
use revmap_capi::renderer::*;
use revmap_capi::texture::*;
use revmap_capi::values::*;
use std::ffi::CStr;
use std::mem::zeroed;
use std::ptr::{null, null_mut};

type Is = RevmapResult;

fn text() -> String {
    // SAFETY: it lasts until this thread's next failure.
    let text = unsafe { CStr::from_ptr(revmap_last_error_text()) };
    text.to_string_lossy().into_owned()
}

#[track_caller]
fn ok(result: RevmapResult) {
    assert_eq!(result, Is::Ok, "{}", text());
}

/// The call fails so, and its text says this.
#[track_caller]
fn fails(result: RevmapResult, wanted: RevmapResult, part: &str) {
    assert_eq!(result, wanted, "{}", text());
    assert_eq!(revmap_last_error(), wanted);
    assert!(
        text().contains(part) && !text().contains('\n'),
        "{}",
        text()
    );
}

macro_rules! defaults {
    ($function:ident, $name:ident) => {{
        // SAFETY: plain numbers and null pointers.
        let mut value: $name = unsafe { zeroed() };
        value.size = size_of::<$name>() as u32;
        // SAFETY: a live structure.
        ok(unsafe { $function(&mut value) });
        value
    }};
}

fn spindle() -> *mut RevmapProfile {
    let points = [[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]];
    let mut profile = null_mut();
    // SAFETY: live points.
    ok(unsafe { revmap_profile_from_points(points.as_ptr(), 3, 0.5, &mut profile) });
    profile
}

fn device() -> *mut RevmapDevice {
    let mut device = null_mut();
    // SAFETY: a null choice is allowed.
    ok(unsafe { revmap_device_open(null(), 1, &mut device) });
    device
}

#[test]
fn profiles_and_textures() {
    let points = [[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]];
    let (at, mut profile) = (points.as_ptr(), null_mut());
    let svg = b"<svg xmlns='http://www.w3.org/2000/svg' width='2' height='4'><path d='M0 0H2V3H0z'/></svg>";
    // SAFETY: live values, or null.
    unsafe {
        fails(
            revmap_profile_from_points(at, 3, 0.5, null_mut()),
            Is::Usage,
            "null",
        );
        fails(
            revmap_profile_from_points(null(), 3, 0.5, &mut profile),
            Is::Usage,
            "points is null",
        );
        fails(
            revmap_profile_from_points(at, usize::MAX, 0.5, &mut profile),
            Is::Usage,
            "memory",
        );
        fails(
            revmap_profile_from_points(at, 2, 0.5, &mut profile),
            Is::Profile,
            "3 points",
        );
        fails(
            revmap_profile_from_points(at, 3, f64::NAN, &mut profile),
            Is::Profile,
            "radius",
        );
        fails(
            revmap_profile_from_bytes(svg.as_ptr().cast(), svg.len(), 9, &mut profile),
            Is::Usage,
            "9 is no RevmapAxis",
        );
        fails(
            revmap_profile_from_bytes(null(), 0, 0, &mut profile),
            Is::Profile,
            "",
        );
        fails(
            revmap_profile_from_file(null(), 0, &mut profile),
            Is::Usage,
            "path is null",
        );
        fails(
            revmap_profile_from_file(c"\xff".as_ptr(), 0, &mut profile),
            Is::Usage,
            "UTF-8",
        );
        fails(
            revmap_profile_from_file(c"missing.png".as_ptr(), 0, &mut profile),
            Is::Profile,
            "missing.png: does not exist",
        );
        assert!(profile.is_null(), "a failure has written a handle");
        let axis = RevmapAxis::Left as u32;
        ok(revmap_profile_from_bytes(
            svg.as_ptr().cast(),
            svg.len(),
            axis,
            &mut profile,
        ));
        let mut radius = 0.0;
        ok(revmap_profile_radius(profile, &mut radius));
        assert_eq!(radius, 0.5);
        fails(
            revmap_profile_radius(profile, null_mut()),
            Is::Usage,
            "null",
        );
        ok(revmap_profile_destroy(profile));
        ok(revmap_profile_destroy(null_mut()));
        fails(
            revmap_profile_destroy(profile),
            Is::Handle,
            "the profile was destroyed",
        );
        fails(
            revmap_profile_radius(profile, &mut radius),
            Is::Handle,
            "the profile was destroyed",
        );
        fails(
            revmap_profile_radius(null(), &mut radius),
            Is::Handle,
            "the profile is null",
        );

        let (mut colors, mut heights) = (null_mut(), null_mut());
        fails(
            revmap_color_map_from_texels(2, 2, null(), &mut colors),
            Is::Usage,
            "null",
        );
        fails(
            revmap_color_map_from_texels(0, 2, null(), &mut colors),
            Is::Map,
            "texels",
        );
        fails(
            revmap_height_map_from_heights(1, 1, &f32::NAN, 0, &mut heights),
            Is::Map,
            "finite",
        );
        fails(
            revmap_height_map_from_heights(1, 1, &0.5, 2, &mut heights),
            Is::Usage,
            "RevmapSlopeFilter",
        );
        fails(
            revmap_color_map_from_file(c"/".as_ptr(), &mut colors),
            Is::Map,
            "",
        );
        ok(revmap_color_map_from_texels(
            1,
            1,
            &[1, 2, 3, 4],
            &mut colors,
        ));
        // A handle of another kind.
        fails(
            revmap_height_map_destroy(colors.cast()),
            Is::Handle,
            "the height map",
        );
        ok(revmap_color_map_destroy(colors));
    }
}

#[test]
fn structures_and_devices() {
    // SAFETY: live values, or null; plain numbers.
    unsafe {
        let mut scene: RevmapScene = zeroed();
        fails(
            revmap_scene_defaults(&mut scene),
            Is::Usage,
            "set its size to sizeof",
        );
        scene.size = size_of::<RevmapScene>() as u32 + 8;
        fails(
            revmap_scene_defaults(&mut scene),
            Is::Usage,
            "RevmapScene says that it has",
        );
        fails(
            revmap_scene_defaults(null_mut()),
            Is::Usage,
            "RevmapScene is null",
        );
        let mut opened = null_mut();
        fails(
            revmap_device_open(c"no such device".as_ptr(), 0, &mut opened),
            Is::Usage,
            "no device is called",
        );
        fails(revmap_device_open(null(), 0, null_mut()), Is::Usage, "null");

        let mut lent: RevmapHostDevice = zeroed();
        fails(
            revmap_device_borrow(&lent, &mut opened),
            Is::Usage,
            "RevmapHostDevice says",
        );
        lent.size = size_of::<RevmapHostDevice>() as u32;
        fails(
            revmap_device_borrow(&lent, &mut opened),
            Is::Usage,
            "get_instance_proc_addr is null",
        );
        let mut needs: RevmapRequirements = zeroed();
        needs.size = size_of::<RevmapRequirements>() as u32;
        let nothing = lent.get_instance_proc_addr;
        fails(
            revmap_requirements(
                nothing,
                ash::vk::Instance::null(),
                lent.physical_device,
                &mut needs,
            ),
            Is::Usage,
            "get_instance_proc_addr is null",
        );
        assert!(opened.is_null());

        let device = device();
        let mut info: RevmapDeviceInfo = zeroed();
        fails(
            revmap_device_info(device, &mut info),
            Is::Usage,
            "RevmapDeviceInfo",
        );
        info.size = size_of::<RevmapDeviceInfo>() as u32;
        ok(revmap_device_info(device, &mut info));
        assert_eq!(info.validated, 1);
        assert!(!CStr::from_ptr(info.name.as_ptr()).is_empty());
        let mut bytes = 0;
        ok(revmap_device_pipeline_cache(device, null_mut(), &mut bytes));
        let mut data = vec![0u8; bytes];
        fails(
            revmap_device_pipeline_cache(device, data.as_mut_ptr().cast(), &mut 0),
            Is::Usage,
            "fit",
        );
        ok(revmap_device_pipeline_cache(
            device,
            data.as_mut_ptr().cast(),
            &mut bytes,
        ));
        ok(revmap_device_add_pipeline_cache(
            device,
            data.as_ptr().cast(),
            bytes,
        ));
        ok(revmap_device_check(device));
        ok(revmap_device_destroy(device));
        fails(
            revmap_device_check(device),
            Is::Handle,
            "the device was destroyed",
        );
    }
}

#[test]
fn renderers_and_objects() {
    let (device, profile) = (device(), spindle());
    let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
    let mut search = defaults!(revmap_search_defaults, RevmapSearch);
    let (mut renderer, mut object) = (null_mut(), 0);
    // SAFETY: live values, or null; no command buffer is recorded into.
    unsafe {
        let mut pass: RevmapPass = zeroed();
        pass.size = size_of::<RevmapPass>() as u32;
        pass.samples = 1;
        pass.depth_format = ash::vk::Format::D32_SFLOAT;
        pass.color_format_count = 1;
        let mut make = |pass: &RevmapPass, frames| {
            revmap_renderer_create(device, pass, null(), frames, &mut renderer)
        };
        fails(make(&pass, 2), Is::Usage, "color formats is null");
        let color = ash::vk::Format::R8G8B8A8_SRGB;
        pass.color_formats = &color;
        fails(make(&pass, 0), Is::Usage, "frames in flight");
        fails(
            make(&RevmapPass { samples: 3, ..pass }, 2),
            Is::Usage,
            "3 samples",
        );
        fails(
            make(&RevmapPass { kind: 7, ..pass }, 2),
            Is::Usage,
            "7 is no RevmapPassKind",
        );
        fails(
            make(&RevmapPass { kind: 1, ..pass }, 2),
            Is::Usage,
            "VkRenderPass is null",
        );
        ok(make(&pass, 2));
        search.solver = 99;
        let mut other = null_mut();
        fails(
            revmap_renderer_create_compute(device, 0, &search, 2, &mut other),
            Is::Usage,
            "RevmapSolver",
        );
        ok(revmap_renderer_create_compute(
            device,
            0,
            null(),
            2,
            &mut other,
        ));

        fails(
            revmap_renderer_add(renderer, &info, &mut object),
            Is::Handle,
            "the profile is null",
        );
        info.profile = profile;
        info.placement.scale = [0.0; 3];
        fails(
            revmap_renderer_add(renderer, &info, &mut object),
            Is::Scene,
            "scale",
        );
        info.placement.scale = [1.0; 3];
        info.instance_count = 3;
        fails(
            revmap_renderer_add(renderer, &info, &mut object),
            Is::Usage,
            "instances is null",
        );
        info.instance_count = 0;
        assert_eq!(object, 0, "a failure has written an object");
        ok(revmap_renderer_add(renderer, &info, &mut object));
        let moved = RevmapOffset {
            extend: 0.01,
            bevel: 0.0,
            chamfer: 1.0,
        };
        ok(revmap_renderer_set_offset(renderer, object, &moved));
        fails(
            revmap_renderer_set_offset(renderer, object, null()),
            Is::Usage,
            "null",
        );
        fails(
            revmap_renderer_set_offset(
                renderer,
                object,
                &RevmapOffset {
                    extend: f64::NAN,
                    ..moved
                },
            ),
            Is::Scene,
            "extend",
        );
        for unknown in [0, object + 1, u64::MAX] {
            fails(
                revmap_renderer_set_offset(renderer, unknown, &moved),
                Is::Usage,
                "object",
            );
            fails(
                revmap_renderer_remove(renderer, unknown),
                Is::Usage,
                "object",
            );
        }
        fails(
            revmap_renderer_set_instances(renderer, object, null(), 2),
            Is::Usage,
            "null",
        );

        // Nothing was prepared.
        let none = ash::vk::CommandBuffer::null();
        let some = <ash::vk::CommandBuffer as ash::vk::Handle>::from_raw(16);
        fails(
            revmap_renderer_record(renderer, none, 0),
            Is::Usage,
            "VkCommandBuffer is null",
        );
        for slot in [0, 2, u32::MAX] {
            fails(
                revmap_renderer_record(renderer, some, slot),
                Is::Usage,
                "not prepared",
            );
            fails(
                revmap_renderer_record_compute(renderer, some, slot),
                Is::Usage,
                "not prepared",
            );
        }
        let mut view: RevmapView = zeroed();
        fails(
            revmap_renderer_prepare(renderer, some, 0, &view),
            Is::Usage,
            "RevmapView",
        );
        view.size = size_of::<RevmapView>() as u32;
        fails(
            revmap_renderer_prepare(renderer, some, 0, &view),
            Is::Scene,
            "view",
        );
        let mut target: RevmapComputeTarget = zeroed();
        target.size = size_of::<RevmapComputeTarget>() as u32;
        fails(
            revmap_renderer_set_compute_target(other, &target),
            Is::Usage,
            "VkBuffer",
        );
        target.words = <ash::vk::Buffer as ash::vk::Handle>::from_raw(16);
        fails(
            revmap_renderer_set_compute_target(renderer, &target),
            Is::Usage,
            "draws in a pass",
        );
        fails(
            revmap_renderer_note(renderer, 0, &mut null()),
            Is::Usage,
            "no note 0",
        );

        let mut prewarm = null_mut();
        ok(revmap_renderer_prewarm(renderer, &mut prewarm));
        let mut count = 0;
        ok(revmap_prewarm_count(prewarm, &mut count));
        assert!(count > 0);
        ok(revmap_prewarm_destroy(prewarm));
        fails(
            revmap_prewarm_compile(prewarm),
            Is::Handle,
            "the prewarm was destroyed",
        );

        // The profile and the device are kept by what uses them.
        ok(revmap_profile_destroy(profile));
        ok(revmap_device_destroy(device));
        fails(
            revmap_renderer_set(renderer, object, &info),
            Is::Handle,
            "the profile was destroyed",
        );
        ok(revmap_renderer_remove(renderer, object));
        fails(
            revmap_renderer_remove(renderer, object),
            Is::Usage,
            "removed",
        );
        ok(revmap_renderer_destroy(renderer));
        fails(
            revmap_renderer_remove(renderer, object),
            Is::Handle,
            "the renderer was destroyed",
        );
        ok(revmap_renderer_destroy(other));
    }
}

#[test]
fn off_screen_pictures() {
    let (device, profile) = (device(), spindle());
    let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
    info.profile = profile;
    let mut scene = defaults!(revmap_scene_defaults, RevmapScene);
    let mut picture = defaults!(revmap_picture_defaults, RevmapPicture);
    (picture.width, picture.height) = (64, 48);
    let mut offscreen = null_mut();
    // SAFETY: live values, or null.
    unsafe {
        scene.object_count = 1;
        fails(
            revmap_offscreen_create(device, &picture, &scene, &mut offscreen),
            Is::Usage,
            "RevmapObjectInfo is null",
        );
        scene.objects = &info;
        let deep = RevmapPicture {
            planes: RevmapPlanes::Depth as u32,
            ..picture
        };
        fails(
            revmap_offscreen_create(device, &deep, &scene, &mut offscreen),
            Is::Usage,
            "depth alone",
        );
        let empty = RevmapPicture {
            width: 0,
            ..picture
        };
        fails(
            revmap_offscreen_create(device, &empty, &scene, &mut offscreen),
            Is::Frame,
            "pixels",
        );
        ok(revmap_offscreen_create(
            device,
            &picture,
            &scene,
            &mut offscreen,
        ));
        let mut pixels = vec![[0u8; 4]; 64 * 48];
        let bytes = size_of_val(&pixels[..]);
        let at = pixels.as_mut_ptr().cast();
        fails(
            revmap_offscreen_read(offscreen, 0, at, bytes),
            Is::Usage,
            "nothing is drawn yet",
        );
        let mut times: RevmapTimes = zeroed();
        times.size = size_of::<RevmapTimes>() as u32;
        ok(revmap_offscreen_prewarm(offscreen));
        ok(revmap_offscreen_draw(offscreen, &mut times));
        assert!(times.frame_ms > 0.0);
        fails(
            revmap_offscreen_read(offscreen, 0, at, bytes - 1),
            Is::Usage,
            "give room for as many",
        );
        fails(
            revmap_offscreen_read(offscreen, 0, null_mut(), bytes),
            Is::Usage,
            "give room",
        );
        fails(
            revmap_offscreen_read(offscreen, 8, at, bytes),
            Is::Usage,
            "RevmapPlane",
        );
        let distance = RevmapPlane::Distance as u32;
        fails(
            revmap_offscreen_read(offscreen, distance, at, bytes),
            Is::Usage,
            "colours alone",
        );
        fails(
            revmap_offscreen_write_png(offscreen, c"/missing/a.png".as_ptr()),
            Is::Frame,
            "/missing/a.png",
        );
        ok(revmap_offscreen_read(offscreen, 0, at, bytes));
        let hit = pixels.iter().filter(|p| p[3] == 255).count();
        assert!(hit > 100, "{hit}");

        // An update that fails leaves what was there.
        scene.camera.target = scene.camera.eye;
        fails(
            revmap_offscreen_update(offscreen, &scene),
            Is::Scene,
            "camera.target",
        );
        ok(revmap_offscreen_draw(offscreen, null_mut()));
        let before = pixels.clone();
        ok(revmap_offscreen_read(offscreen, 0, at, bytes));
        assert_eq!(before, pixels);
        ok(revmap_offscreen_destroy(offscreen));
        fails(
            revmap_offscreen_draw(offscreen, null_mut()),
            Is::Handle,
            "was destroyed",
        );

        // Every plane, of both stages.
        for stage in [RevmapStage::Fragment, RevmapStage::Compute] {
            picture.planes = RevmapPlanes::All as u32;
            picture.stage = stage as u32;
            scene.camera.target = [0.0, 0.0, 0.5];
            ok(revmap_offscreen_create(
                device,
                &picture,
                &scene,
                &mut offscreen,
            ));
            ok(revmap_offscreen_draw(offscreen, null_mut()));
            let read = |plane: RevmapPlane, floats: usize| {
                let mut all = vec![0f32; floats * pixels.len()];
                let bytes = size_of_val(&all[..]);
                ok(revmap_offscreen_read(
                    offscreen,
                    plane as u32,
                    all.as_mut_ptr().cast(),
                    bytes,
                ));
                all
            };
            let distances = read(RevmapPlane::Distance, 1);
            assert_eq!(distances.iter().filter(|d| d.is_finite()).count(), hit);
            let normals = read(RevmapPlane::Normal, 3);
            for (n, distance) in normals.chunks_exact(3).zip(&distances) {
                let length = n.iter().map(|c| c * c).sum::<f32>();
                assert!(length == 0.0 || (length - 1.0).abs() < 1e-5);
                assert_eq!(length > 0.0, distance.is_finite());
            }
            assert_eq!(read(RevmapPlane::ShadingNormal, 3), normals);
            assert!(read(RevmapPlane::Albedo, 3).contains(&info.color[0]));
            assert!(read(RevmapPlane::Uv, 2).iter().any(|v| *v > 0.5));
            assert!(read(RevmapPlane::Color, 4).iter().any(|v| *v > 0.0));
            read(RevmapPlane::Steps, 1);
            ok(revmap_offscreen_destroy(offscreen));
        }
        ok(revmap_device_check(device));
        ok(revmap_profile_destroy(profile));
        ok(revmap_device_destroy(device));
    }
}

/// Threads that use one renderer at once are refused or served; none is harmed, and what was
/// accepted counts.
#[test]
fn threads_at_once_are_refused_or_served() {
    let (device, profile) = (device(), spindle());
    let mut renderer = null_mut();
    // SAFETY: live values.
    ok(unsafe { revmap_renderer_create_compute(device, 0, null(), 1, &mut renderer) });
    let (shared, of) = (renderer.addr(), profile.addr());
    let work = || {
        let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
        info.profile = std::ptr::without_provenance(of);
        let add = || {
            let mut object = 0;
            // SAFETY: live values; the handle is a number.
            unsafe {
                revmap_renderer_add(std::ptr::without_provenance_mut(shared), &info, &mut object)
            }
        };
        (0..500).map(|_| add()).collect::<Vec<_>>()
    };
    let results: Vec<RevmapResult> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(work)).collect();
        threads
            .into_iter()
            .flat_map(|t| t.join().unwrap())
            .collect()
    });
    let added = results.iter().filter(|r| **r == Is::Ok).count();
    assert!(results.iter().all(|r| [Is::Ok, Is::Busy].contains(r)));
    // SAFETY: plain numbers, live values.
    unsafe {
        let mut statistics: RevmapStatistics = zeroed();
        statistics.size = size_of::<RevmapStatistics>() as u32;
        ok(revmap_renderer_statistics(renderer, &mut statistics));
        assert_eq!(statistics.objects as usize, added);
    }
    ok(revmap_renderer_destroy(renderer));
    ok(revmap_profile_destroy(profile));
    ok(revmap_device_destroy(device));
}
