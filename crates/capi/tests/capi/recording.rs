//! Recording through the C interface into a render pass: what the Rust renderer draws.

use crate::host::{Host, Options, Stage, borrow, frame, open, renderer};
use crate::names::*;

pub const OPTIONS: Options = Options {
    width: 240,
    height: 180,
    dynamic: false,
    samples: 1,
    reversed: false,
};
pub const POINTS: [[f64; 2]; 5] = [[0.0, 0.0], [0.35, 0.2], [0.1, 0.5], [0.35, 0.8], [0.0, 1.0]];
pub const EYE: [f64; 3] = [2.0, 0.5, 1.5];
pub const BESIDE: [f64; 3] = [0.1, 0.6, -0.2];
pub const RANGE: [f64; 2] = [0.1, 10.0];

pub fn lend(host: &Host) -> *mut RevmapDevice {
    lend_with(host, vk::Queue::null())
}

/// The same for pictures without a host, which submit by themselves.
pub fn lend_with_queue(host: &Host) -> *mut RevmapDevice {
    lend_with(host, host.queue)
}

fn lend_with(host: &Host, queue: vk::Queue) -> *mut RevmapDevice {
    let mut device = null_mut();
    // SAFETY: the host's own handles; every test destroys all that it makes before the host goes.
    unsafe {
        let entry = ash::Entry::load().unwrap();
        let lent = RevmapHostDevice {
            size: size_of::<RevmapHostDevice>() as u32,
            queue_family: host.family,
            get_instance_proc_addr: GetInstanceProcAddr(Some(
                entry.static_fn().get_instance_proc_addr,
            )),
            instance: host.instance.handle(),
            physical_device: host.physical,
            device: host.device.handle(),
            queue,
            features: &host.features,
            pipeline_cache: vk::PipelineCache::null(),
        };
        ok! { revmap_device_borrow(&lent, &mut device); }
    }
    device
}

/// Two spindles; the second is moved, and back again.
pub fn add(renderer: *mut RevmapRenderer) {
    // SAFETY: live values.
    unsafe {
        let (mut profile, mut object) = (null_mut(), 0);
        ok! { revmap_profile_from_points(POINTS.as_ptr(), POINTS.len(), 0.4, &mut profile); }
        let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
        info.profile = profile;
        ok! {
            revmap_renderer_add(renderer, &info, &mut object);
            revmap_renderer_add(renderer, &info, &mut object);
        }
        let placement = RevmapPlacement {
            position: BESIDE,
            ..info.placement
        };
        let offset = RevmapOffset {
            extend: 0.02,
            ..info.offset
        };
        ok! {
            revmap_renderer_set_instances(renderer, object, &placement, 1);
            revmap_renderer_set_instances(renderer, object, null(), 0);
            revmap_renderer_set_placement(renderer, object, &placement);
            revmap_renderer_set_offset(renderer, object, &offset);
            revmap_profile_destroy(profile);
        }
    }
}

pub fn scene() -> Scene {
    let profile = Arc::new(Profile::polygon(&POINTS, 0.4).unwrap());
    let mut scene = Scene::new(Camera::new(EYE.into(), DVec3::new(0.0, 0.0, 0.5)));
    scene.objects = vec![
        Object::new("object", profile.clone()),
        Object::new("object", profile),
    ];
    scene.objects[1].placement = Placement {
        position: BESIDE.into(),
        ..Placement::default()
    };
    scene.objects[1].offset.extend = 0.02;
    scene
}

pub fn camera() -> RevmapCamera {
    RevmapCamera {
        eye: EYE,
        ..defaults!(revmap_camera_defaults, RevmapCamera)
    }
}

/// The stage's render pass.
pub fn render_pass(stage: &Stage) -> RevmapPass {
    RevmapPass {
        kind: RevmapPassKind::RenderPass as u32,
        samples: 1,
        render_pass: stage.into.pass,
        ..sized!(RevmapPass)
    }
}

/// What the Rust renderer records into the stage's pass.
fn drawn(host: &Host, stage: &mut Stage) -> Vec<u8> {
    let device = borrow(host);
    let mut renderer = renderer(&device, stage, &SearchSettings::default(), 2);
    let scene = scene();
    for object in &scene.objects {
        renderer.add(object.clone()).unwrap();
    }
    let view = View::from_camera(&scene.camera, (OPTIONS.width, OPTIONS.height), RANGE).unwrap();
    frame(stage, &mut renderer, &view, DMat4::IDENTITY, &[]);
    stage.read().unwrap().0
}

/// A renderer that hides compiles nothing while it prepares. What it leaves out appears once it is
/// compiled, as Rust draws it.
#[test]
fn a_render_pass_shows_what_rust_draws_once_it_is_compiled() {
    let host = open();
    let mut stage = Stage::new(&host, OPTIONS).unwrap();
    let wanted = drawn(&host, &mut stage);
    let (device, camera) = (lend(&host), camera());
    let (mut renderer, mut prewarm) = (null_mut(), null_mut());
    let mut used = sized!(RevmapMemoryUse);
    // SAFETY: live values; the stage has waited for a slot before it is prepared, and its pass is
    // the renderer's.
    unsafe {
        let pass = render_pass(&stage);
        ok! {
            revmap_renderer_create(device, &pass, null(), 2, &mut renderer);
            revmap_renderer_hide_until_compiled(renderer, 1);
        }
        add(renderer);
        let compiled = || {
            let mut info = sized!(RevmapDeviceInfo);
            ok! { revmap_device_info(device, &mut info); }
            info.pipelines_compiled
        };
        let mut shown = |warms: bool| {
            let mut statistics = sized!(RevmapFrameStatistics);
            let prepare = |cmd, slot: usize| {
                let (slot, w, h, [near, far]) = (slot as u32, OPTIONS.width, OPTIONS.height, RANGE);
                ok! {
                    revmap_renderer_prepare_camera(renderer, cmd, slot, &camera, w, h, near, far);
                    revmap_renderer_frame_statistics(renderer, slot, &mut statistics);
                }
                Ok(slot)
            };
            let record = |cmd, &slot: &u32| {
                if warms {
                    ok! { revmap_renderer_record_prewarm(renderer, cmd, slot); }
                } else {
                    ok! { revmap_renderer_record(renderer, cmd, slot); }
                }
                let refused = revmap_renderer_record_compute(renderer, cmd, slot);
                assert_eq!(refused, RevmapResult::Usage);
                let mut after = sized!(RevmapFrameStatistics);
                ok! { revmap_renderer_frame_statistics(renderer, slot, &mut after); }
                let is_time = |ms: f64| (1e-6..6e4).contains(&ms);
                assert!(is_time(after.prepare_ms), "{after:?}");
                // A prewarming is no recording.
                assert!(if warms {
                    after.record_ms == 0.0
                } else {
                    is_time(after.record_ms)
                });
                Ok(())
            };
            let drawn = stage.frame(DMat4::IDENTITY, Vec3::Z, &[], prepare, record);
            drawn.unwrap();
            (stage.read().unwrap().0, statistics)
        };
        let is_empty = |picture: &[u8]| picture.chunks_exact(4).all(|p| p == &picture[..4]);
        let before = compiled();
        let (picture, statistics) = shown(false);
        assert!(is_empty(&picture), "drawn");
        assert!(
            statistics.hidden > 0 && statistics.draws == 0,
            "{statistics:?}"
        );
        assert_eq!(compiled(), before);
        ok! {
            revmap_renderer_prewarm(renderer, &mut prewarm);
            revmap_prewarm_compile(prewarm);
            revmap_prewarm_destroy(prewarm);
        }
        let ready = compiled();
        assert!(ready > before);
        assert!(is_empty(&shown(true).0), "draws of no pixel have drawn");
        for _ in 0..2 {
            let (picture, statistics) = shown(false);
            assert!(picture == wanted, "pixels differ");
            assert_eq!((statistics.hidden, statistics.objects), (0, 2));
            assert_eq!(statistics.record_ms, 0.0, "not recorded yet");
            assert!(statistics.draws > 0 && statistics.slot_bytes > 0);
        }
        let solid = wanted.chunks_exact(4).filter(|p| *p != &wanted[..4]);
        assert!(solid.count() > 3000);
        assert_eq!(compiled(), ready, "a frame has compiled");
        let (_, statistics) = shown(false);
        ok! { revmap_device_memory_use(device, &mut used); }
        assert!(
            used.device + used.visible >= statistics.slot_bytes,
            "{used:?}"
        );
        let mut unprepared = sized!(RevmapFrameStatistics);
        let refused = revmap_renderer_frame_statistics(renderer, 2, &mut unprepared);
        assert_eq!(refused, RevmapResult::Usage);
        ok! {
            revmap_renderer_destroy(renderer);
            revmap_device_memory_use(device, &mut used);
        }
        let left = used.device + used.visible + used.host;
        assert!(left < statistics.slot_bytes, "{used:?}");
        ok! { revmap_device_destroy(device); }
    }
}
