//! Wrong arguments of off-screen pictures.

use super::*;

#[test]
fn off_screen_pictures() {
    let (device, profile) = (device(), spindle());
    let info = object_of(profile);
    let mut scene = defaults!(revmap_scene_defaults, RevmapScene);
    let mut picture = defaults!(revmap_picture_defaults, RevmapPicture);
    (picture.width, picture.height) = (64, 48);
    let mut offscreen = null_mut();
    scene.object_count = 1;
    fail! {
        Usage, "RevmapObjectInfo is null": revmap_offscreen_create(device, &picture, &scene, &mut offscreen);
    }
    scene.objects = &info;
    let deep = RevmapPicture {
        planes: RevmapPlanes::Depth as u32,
        ..picture
    };
    fail! {
        Usage, "depths and lists": revmap_offscreen_create(device, &deep, &scene, &mut offscreen);
    }
    ok! { revmap_offscreen_create(device, &picture, &scene, &mut offscreen); }
    let mut pixels = vec![[0u8; 4]; 64 * 48];
    let bytes = size_of_val(&pixels[..]);
    let at = pixels.as_mut_ptr().cast();
    fail! {
        Usage, "nothing is drawn yet": revmap_offscreen_read(offscreen, 0, at, bytes);
    }
    let mut times = sized!(RevmapTimes);
    ok! {
        revmap_offscreen_prewarm(offscreen);
        revmap_offscreen_draw(offscreen, &mut times);
    }
    assert!(times.frame_ms > 0.0);
    fail! {
        Usage, "give room for as many": revmap_offscreen_read(offscreen, 0, at, bytes - 1);
        Usage, "RevmapPlane": revmap_offscreen_read(offscreen, 8, at, bytes);
    }
    let distance = RevmapPlane::Distance as u32;
    fail! {
        Usage, "colours alone": revmap_offscreen_read(offscreen, distance, at, bytes);
        File, "/missing/a.png": revmap_offscreen_write_png(offscreen, c"/missing/a.png".as_ptr());
    }
    ok! { revmap_offscreen_read(offscreen, 0, at, bytes); }
    let hit = pixels.iter().filter(|p| p[3] == 255).count();
    assert!(hit > 100, "{hit}");

    // An update that fails leaves what was there.
    scene.camera.target = scene.camera.eye;
    fail! {
        Content, "camera.target": revmap_offscreen_update(offscreen, &scene);
    }
    ok! { revmap_offscreen_draw(offscreen, null_mut()); }
    let before = pixels.clone();
    ok! { revmap_offscreen_read(offscreen, 0, at, bytes); }
    assert_eq!(before, pixels);
    ok! { revmap_offscreen_destroy(offscreen); }
    fail! {
        Handle, "was destroyed": revmap_offscreen_draw(offscreen, null_mut());
    }

    // Every plane.
    picture.planes = RevmapPlanes::All as u32;
    picture.stage = RevmapStage::Compute as u32;
    scene.camera.target = [0.0, 0.0, 0.5];
    ok! {
        revmap_offscreen_create(device, &picture, &scene, &mut offscreen);
        revmap_offscreen_draw(offscreen, null_mut());
    }
    let read = |plane: RevmapPlane, floats: usize| {
        let mut all = vec![0f32; floats * pixels.len()];
        let bytes = size_of_val(&all[..]);
        ok! { revmap_offscreen_read(offscreen, plane as u32, all.as_mut_ptr().cast(), bytes); }
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
    ok! { revmap_offscreen_destroy(offscreen); }
    ok! {
        revmap_device_check(device);
        revmap_profile_destroy(profile);
        revmap_device_destroy(device);
    }
}
