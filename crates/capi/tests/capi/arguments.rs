//! Wrong arguments give errors, and leave what was there as it was.

use crate::names::*;
use crate::{POINTS, device, object_of, spindle, zeros};
use std::mem::offset_of;

mod pictures;
mod renderers;

#[test]
fn profiles_and_textures() {
    let (at, mut profile) = (POINTS.as_ptr(), null_mut());
    let svg = b"<svg xmlns='http://www.w3.org/2000/svg' width='2' height='4'><path d='M0 0H2V3H0z'/></svg>";
    fail! {
        Usage, "null": revmap_profile_from_points(at, 3, 0.5, null_mut());
        Usage, "points is null": revmap_profile_from_points(null(), 3, 0.5, &mut profile);
        Usage, "memory": revmap_profile_from_points(at, usize::MAX, 0.5, &mut profile);
        Content, "3 points": revmap_profile_from_points(at, 2, 0.5, &mut profile);
        Usage, "9 is no RevmapAxis": revmap_profile_from_bytes(svg.as_ptr().cast(), svg.len(), 9, &mut profile);
        Usage, "path is null": revmap_profile_from_file(null(), 0, &mut profile);
        Usage, "UTF-8": revmap_profile_from_file(c"\xff".as_ptr(), 0, &mut profile);
        File, "missing.png: does not exist": revmap_profile_from_file(c"missing.png".as_ptr(), 0, &mut profile);
    }
    assert!(profile.is_null(), "a failure has written a handle");
    let axis = RevmapAxis::Left as u32;
    ok! { revmap_profile_from_bytes(svg.as_ptr().cast(), svg.len(), axis, &mut profile); }
    let mut radius = 0.0;
    ok! { revmap_profile_radius(profile, &mut radius); }
    assert_eq!(radius, 0.5);
    fail! {
        Usage, "null": revmap_profile_radius(profile, null_mut());
    }
    ok! {
        revmap_profile_destroy(profile);
        revmap_profile_destroy(null_mut());
    }
    fail! {
        Handle, "the profile was destroyed": revmap_profile_destroy(profile);
        Handle, "the profile was destroyed": revmap_profile_radius(profile, &mut radius);
        Handle, "the profile is null": revmap_profile_radius(null(), &mut radius);
    }

    let (mut colors, mut heights) = (null_mut(), null_mut());
    fail! {
        Usage, "null": revmap_color_map_from_texels(2, 2, null(), &mut colors);
        Content, "finite": revmap_height_map_from_heights(1, 1, &f32::NAN, 0, &mut heights);
        Usage, "RevmapSlopeFilter": revmap_height_map_from_heights(1, 1, &0.5, 2, &mut heights);
    }
    ok! { revmap_color_map_from_texels(1, 1, &[1, 2, 3, 4], &mut colors); }
    // A handle of another kind.
    fail! {
        Handle, "the height map": revmap_height_map_destroy(colors.cast());
    }
    ok! { revmap_color_map_destroy(colors); }
}

#[test]
fn structures_and_devices() {
    let mut scene: RevmapScene = zeros();
    fail! {
        Usage, "set its size to sizeof": revmap_scene_defaults(&mut scene);
    }
    scene.size = size_of::<RevmapScene>() as u32 + 8;
    fail! {
        Usage, "RevmapScene says that it has": revmap_scene_defaults(&mut scene);
        Usage, "RevmapScene is null": revmap_scene_defaults(null_mut());
    }
    let mut opened = null_mut();
    fail! {
        Usage, "no device is called": revmap_device_open(c"no such device".as_ptr(), 0, &mut opened);
        Usage, "null": revmap_device_open(null(), 0, null_mut());
    }

    let mut lent: RevmapHostDevice = zeros();
    fail! {
        Usage, "RevmapHostDevice says": revmap_device_borrow(&lent, &mut opened);
    }
    lent.size = size_of::<RevmapHostDevice>() as u32;
    fail! {
        Usage, "get_instance_proc_addr is null": revmap_device_borrow(&lent, &mut opened);
    }
    let mut needs = sized!(RevmapRequirements);
    let nothing = lent.get_instance_proc_addr;
    fail! {
        Usage, "get_instance_proc_addr is null": revmap_requirements(
            nothing, ash::vk::Instance::null(), lent.physical_device, &mut needs
        );
    }
    assert!(opened.is_null());

    let device = device();
    let mut info: RevmapDeviceInfo = zeros();
    fail! {
        Usage, "RevmapDeviceInfo": revmap_device_info(device, &mut info);
    }
    info.size = size_of::<RevmapDeviceInfo>() as u32;
    ok! { revmap_device_info(device, &mut info); }
    assert_eq!(info.validated, 1);
    assert_ne!(info.name[0], 0);
    let mut bytes = 0;
    ok! { revmap_device_pipeline_cache(device, null_mut(), &mut bytes); }
    let mut data = vec![0u8; bytes];
    fail! {
        Usage, "fit": revmap_device_pipeline_cache(device, data.as_mut_ptr().cast(), &mut 0);
    }
    let mut used = sized!(RevmapMemoryUse);
    ok! { revmap_device_memory_use(device, &mut used); }
    used.size = 0;
    fail! {
        Usage, "RevmapMemoryUse says": revmap_device_memory_use(device, &mut used);
        Handle, "the device is null": revmap_device_enable_debug_labels(null());
    }
    ok! {
        revmap_device_enable_debug_labels(device);
        revmap_device_pipeline_cache(device, data.as_mut_ptr().cast(), &mut bytes);
        revmap_device_add_pipeline_cache(device, data.as_ptr().cast(), bytes);
        revmap_device_check(device);
        revmap_device_destroy(device);
    }
    fail! {
        Handle, "the device was destroyed": revmap_device_check(device);
    }
}

/// One array holds structures of one size. Those of earlier headers are in `programs.rs`.
#[test]
fn arrays_hold_structures_of_one_size() {
    let device = device();
    let earlier = offset_of!(RevmapObjectInfo, has_material);
    let mut info = sized!(RevmapObjectInfo);
    let mut scene = defaults!(revmap_scene_defaults, RevmapScene);
    let picture = defaults!(revmap_picture_defaults, RevmapPicture);
    (info.size, info.has_material, info.roughness) = (earlier as u32, 7, 0.5);
    ok! { revmap_object_defaults(&mut info); }
    let kept = (info.size as usize, info.has_material, info.roughness);
    assert_eq!(kept, (earlier, 7, 0.5));
    info.profile = spindle();
    let mut both = [info; 2];
    both[0].size = size_of::<RevmapObjectInfo>() as u32;
    (scene.objects, scene.object_count) = (both.as_ptr(), 2);
    let mut offscreen = null_mut();
    fail! {
        Usage, "structure 1 of an array": revmap_offscreen_create(device, &picture, &scene, &mut offscreen);
    }
    info.size += 4;
    fail! {
        Usage, "set its size to sizeof": revmap_object_defaults(&mut info);
    }
    ok! { revmap_device_destroy(device); }
}
