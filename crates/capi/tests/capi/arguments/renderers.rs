//! Wrong arguments of renderers and their objects; threads that use one at once.

use super::*;

#[test]
fn renderers_and_objects() {
    let (device, profile) = (device(), spindle());
    let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
    let mut search = defaults!(revmap_search_defaults, RevmapSearch);
    let (mut renderer, mut object) = (null_mut(), 0);
    let mut pass = sized!(RevmapPass);
    pass.samples = 1;
    pass.depth_format = vk::Format::D32_SFLOAT;
    pass.color_format_count = 1;
    let mut make = |pass: &RevmapPass, frames| {
        // SAFETY: live values.
        unsafe { revmap_renderer_create(device, pass, null(), frames, &mut renderer) }
    };
    fail! {
        Usage, "color formats is null": make(&pass, 2);
    }
    let color = vk::Format::R8G8B8A8_SRGB;
    pass.color_formats = &color;
    fail! {
        Usage, "frames in flight": make(&pass, 0);
        Usage, "3 samples": make(&RevmapPass { samples: 3, ..pass }, 2);
        Usage, "7 is no RevmapPassKind": make(&RevmapPass { kind: 7, ..pass }, 2);
        Usage, "views: 2 in one pass": make(&RevmapPass { views: 2, ..pass }, 2);
        Usage, "8 is no RevmapDepthCompare": make(&RevmapPass { depth_compare: 8, ..pass }, 2);
        Usage, "slope_bias": make(&RevmapPass { slope_bias: 1.0, slope_bias_limit: 1.0, ..pass }, 2);
        Usage, "pass is null": make(&RevmapPass { kind: 1, ..pass }, 2);
    }
    let listed = RevmapPass {
        planes: RevmapPlanes::List as u32,
        attachment_count: 1,
        ..pass
    };
    fail! {
        Usage, "attachments is null": make(&listed, 2);
        Usage, "7 is no RevmapAttachment": make(&RevmapPass { attachments: &7, ..listed }, 2);
    }
    ok! { make(&pass, 2); }
    search.solver = 99;
    let mut other = null_mut();
    fail! {
        Usage, "planes": revmap_renderer_create_compute(device, 4, null(), 2, &mut other);
        Usage, "RevmapSolver": revmap_renderer_create_compute(device, 0, &search, 2, &mut other);
    }
    if cfg!(not(feature = "searches")) {
        search.solver = RevmapSolver::Circle as u32;
        fail! {
            Unsupported, "`searches`": revmap_renderer_create_compute(device, 0, &search, 2, &mut other);
        }
    }
    ok! { revmap_renderer_create_compute(device, 0, null(), 2, &mut other); }

    fail! {
        Handle, "the profile is null": revmap_renderer_add(renderer, &info, &mut object);
    }
    info.profile = profile;
    info.placement.scale = [0.0; 3];
    fail! {
        Content, "scale": revmap_renderer_add(renderer, &info, &mut object);
    }
    info.placement.scale = [1.0; 3];
    info.instance_count = 3;
    fail! {
        Usage, "instances is null": revmap_renderer_add(renderer, &info, &mut object);
    }
    info.instance_count = 0;
    assert_eq!(object, 0, "a failure has written an object");
    ok! { revmap_renderer_add(renderer, &info, &mut object); }
    let moved = RevmapOffset {
        extend: 0.01,
        bevel: 0.0,
        chamfer: 1.0,
    };
    ok! { revmap_renderer_set_offset(renderer, object, &moved); }
    info.name = c"spindle".as_ptr();
    info.instance_count = 0;
    ok! { revmap_renderer_set(renderer, object, &info); }
    let wrong = RevmapOffset {
        bevel: -1.0,
        ..moved
    };
    let flat = RevmapPlacement {
        scale: [0.0; 3],
        ..info.placement
    };
    fail! {
        Usage, "null": revmap_renderer_set_offset(renderer, object, null());
        Content, "object.0.bevel: is -1.0": revmap_renderer_set_offset(renderer, object, &wrong);
        Content, "(object \"spindle\")": revmap_renderer_set_offset(renderer, object, &wrong);
        Content, "object.0.scale": revmap_renderer_set_placement(renderer, object, &flat);
        Content, "object.0.instances.0.scale": revmap_renderer_set_instances(renderer, object, &flat, 1);
        Usage, "the object 18446744073709551615 was removed": revmap_renderer_remove(renderer, u64::MAX);
    }
    let (mut number, mut caster) = (0, null_mut());
    fail! {
        Usage, "number is null": revmap_renderer_object_number(renderer, object, null_mut());
        Usage, "another renderer": revmap_renderer_object_number(other, object, &mut number);
        Usage, "another renderer": revmap_renderer_ray_caster(other, object, &mut caster);
        Handle, "the renderer is null": revmap_renderer_end_frame(null_mut());
        Usage, "null": revmap_renderer_set_instances(renderer, object, null(), 2);
    }

    // Nothing was prepared.
    let none = vk::CommandBuffer::null();
    let some = <vk::CommandBuffer as vk::Handle>::from_raw(16);
    fail! {
        Usage, "VkCommandBuffer is null": revmap_renderer_record(renderer, none, 0);
    }
    let mut frame = sized!(RevmapFrameStatistics);
    for slot in [0, u32::MAX] {
        fail! {
            Usage, "not prepared": revmap_renderer_frame_statistics(renderer, slot, &mut frame);
            Usage, "not prepared": revmap_renderer_record(renderer, some, slot);
        }
    }
    let mut view: RevmapView = zeros();
    fail! {
        Usage, "RevmapView": revmap_renderer_prepare(renderer, some, 0, &view);
    }
    view.size = size_of::<RevmapView>() as u32;
    fail! {
        Content, "view": revmap_renderer_prepare(renderer, some, 0, &view);
    }
    // Depth falls from 1 at 0.1 to -1 at 100.
    let (near, far) = (0.1, 100.0);
    for axis in 0..4 {
        view.view[5 * axis] = 1.0;
    }
    (view.projection[0], view.projection[5]) = (1.0, -1.0);
    view.projection[10] = (far + near) / (far - near);
    (view.projection[11], view.projection[14]) = (-1.0, 2.0 * far * near / (far - near));
    view.viewport = [0.0, 0.0, 64.0, 48.0];
    fail! {
        Content, "give a projection for this depth order": revmap_renderer_prepare(renderer, some, 0, &view);
    }
    let mut target = sized!(RevmapComputeTarget);
    fail! {
        Usage, "words": revmap_renderer_set_compute_target(other, &target);
    }
    target.words = <vk::Buffer as vk::Handle>::from_raw(16);
    fail! {
        Usage, "only attachments": revmap_renderer_set_compute_target(renderer, &target);
        Usage, "no note 0": revmap_renderer_note(renderer, 0, &mut null());
    }

    let mut prewarm = null_mut();
    ok! { revmap_renderer_prewarm(renderer, &mut prewarm); }
    let mut count = 0;
    ok! { revmap_prewarm_count(prewarm, &mut count); }
    assert!(count > 0);
    ok! { revmap_prewarm_destroy(prewarm); }
    fail! {
        Handle, "the prewarm was destroyed": revmap_prewarm_compile(prewarm);
    }

    // The profile and the device are kept by what uses them.
    ok! {
        revmap_profile_destroy(profile);
        revmap_device_destroy(device);
    }
    fail! {
        Handle, "the profile was destroyed": revmap_renderer_set(renderer, object, &info);
    }
    ok! { revmap_renderer_remove(renderer, object); }
    fail! {
        Usage, "removed": revmap_renderer_remove(renderer, object);
    }
    ok! { revmap_renderer_destroy(renderer); }
    fail! {
        Handle, "the renderer was destroyed": revmap_renderer_remove(renderer, object);
    }
    ok! { revmap_renderer_destroy(other); }
}

/// Threads that use one renderer at once are refused or served; none is harmed, and what was
/// accepted counts.
#[test]
fn threads_at_once_are_refused_or_served() {
    let (device, profile) = (device(), spindle());
    let mut renderer = null_mut();
    ok! { revmap_renderer_create_compute(device, 0, null(), 1, &mut renderer); }
    let (shared, of) = (renderer.addr(), profile.addr());
    let work = || {
        let info = object_of(std::ptr::without_provenance_mut(of));
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
    let added = results.iter().filter(|r| **r == RevmapResult::Ok).count();
    let served = [RevmapResult::Ok, RevmapResult::Busy];
    assert!(results.iter().all(|r| served.contains(r)));
    let mut statistics = sized!(RevmapStatistics);
    ok! { revmap_renderer_statistics(renderer, &mut statistics); }
    assert_eq!(statistics.objects as usize, added);
    ok! {
        revmap_renderer_destroy(renderer);
        revmap_profile_destroy(profile);
        revmap_device_destroy(device);
    }
}
