//! Recording through the C interface, into a render pass and in compute: what the Rust renderer
//! draws.

use crate::host::{COLOR, Canvas, Drawn, Host, Options, Picture, borrow, open, view_of};
use crate::names::*;
use crate::{POINTS, RADIUS, object_of, spindle};

pub const OPTIONS: Options = Options::new(240, 180);
pub const EYE: [f64; 3] = [2.0, 0.5, 1.5];
pub const BESIDE: [f64; 3] = [0.1, 0.6, -0.2];
const MATERIAL: Material = Material {
    roughness: 0.75,
    metalness: 1.0,
};

pub fn lend(host: &Host) -> *mut RevmapDevice {
    lend_with(host, vk::Queue::null())
}

/// The same with a queue, for pictures without a host, which submit by themselves.
pub fn lend_with(host: &Host, queue: vk::Queue) -> *mut RevmapDevice {
    let mut device = null_mut();
    let lent = RevmapHostDevice {
        size: size_of::<RevmapHostDevice>() as u32,
        queue_family: host.family,
        get_instance_proc_addr: GetInstanceProcAddr(Some(
            host.entry.static_fn().get_instance_proc_addr,
        )),
        instance: host.instance.handle(),
        physical_device: host.physical,
        device: host.device.handle(),
        queue,
        features: &host.features,
        pipeline_cache: vk::PipelineCache::null(),
    };
    ok! { revmap_device_borrow(&lent, &mut device); }
    device
}

/// Two spindles, the second with a material; it is moved, and back again.
pub fn add(renderer: *mut RevmapRenderer) -> [RevmapObject; 2] {
    let (profile, mut objects) = (spindle(), [0; 2]);
    let mut info = object_of(profile);
    ok! { revmap_renderer_add(renderer, &info, &mut objects[0]); }
    info.has_material = 1;
    (info.roughness, info.metalness) = (MATERIAL.roughness, MATERIAL.metalness);
    ok! { revmap_renderer_add(renderer, &info, &mut objects[1]); }
    let object = objects[1];
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
    objects
}

/// The same scene in Rust.
pub fn scene() -> Scene {
    let profile = Arc::new(Profile::polygon(&POINTS, RADIUS).unwrap());
    let mut scene = Scene::new(Camera::new(EYE.into(), DVec3::new(0.0, 0.0, 0.5)));
    let first = Object::new("object", profile);
    let mut second = first.clone();
    second.placement.position = BESIDE.into();
    second.offset.extend = 0.02;
    second.material = Some(MATERIAL);
    scene.objects = vec![first, second];
    scene
}

/// A render pass, or words of compute.
pub fn canvas(host: &Host, compute: bool) -> Canvas<'_> {
    let in_render_pass = Options {
        dynamic: false,
        ..OPTIONS
    };
    match compute {
        true => Canvas::words(host, OPTIONS),
        false => Canvas::pass(host, in_render_pass, &[COLOR]),
    }
}

/// The output of a Rust renderer.
pub fn output(canvas: &Canvas) -> Output {
    let Canvas::Pass(into) = canvas else {
        return Output::Compute(Planes::Color);
    };
    let begun = PassKind::RenderPass {
        // SAFETY: the canvas outlives the renderer.
        pass: unsafe { HostPass::new(into.pass) },
        subpass: 0,
    };
    Output::Pass(PassFormats::new(begun, Planes::Color))
}

/// The scene by a Rust renderer.
pub fn in_rust<'a>(host: &'a Host, mut renderer: Renderer, canvas: Canvas<'a>) -> Drawn<'a> {
    let scene = scene();
    canvas.lend(&mut renderer, true);
    Drawn {
        ids: crate::host::add(&mut renderer, &scene),
        view: view_of(&scene, &OPTIONS),
        renderer,
        canvas,
        host,
    }
}

/// The render pass of a canvas.
pub fn render_pass(canvas: &Canvas) -> RevmapPass {
    let Canvas::Pass(into) = canvas else {
        panic!("words have no pass");
    };
    RevmapPass {
        kind: RevmapPassKind::RenderPass as u32,
        samples: 1,
        render_pass: into.pass,
        ..sized!(RevmapPass)
    }
}

/// A renderer of two slots.
fn create(device: *mut RevmapDevice, canvas: &Canvas) -> *mut RevmapRenderer {
    let mut renderer = null_mut();
    match canvas {
        Canvas::Pass(_) => {
            let pass = render_pass(canvas);
            ok! { revmap_renderer_create(device, &pass, null(), 2, &mut renderer); }
        }
        Canvas::Words(words) => {
            let mut target = sized!(RevmapComputeTarget);
            target.words = words.raw;
            let color = RevmapPlanes::Color as u32;
            ok! {
                revmap_renderer_create_compute(device, color, null(), 2, &mut renderer);
                revmap_renderer_set_compute_target(renderer, &target);
            }
        }
    }
    renderer
}

/// Prepares a slot for the scene's camera, and draws what `record` records.
pub fn draw(
    host: &Host,
    canvas: &Canvas,
    renderer: *mut RevmapRenderer,
    slot: u32,
    record: impl FnOnce(vk::CommandBuffer),
) -> Picture {
    let camera = RevmapCamera {
        eye: EYE,
        ..defaults!(revmap_camera_defaults, RevmapCamera)
    };
    let prepare = |cmd| {
        let (w, h) = (OPTIONS.width, OPTIONS.height);
        ok! { revmap_renderer_prepare_camera(renderer, cmd, slot, &camera, w, h, 0.1, 50.0); }
    };
    canvas.draw(host, prepare, |cmd, ()| record(cmd))
}

/// A renderer that hides compiles nothing while it prepares. What it leaves out appears once it is
/// compiled, as Rust draws it.
#[test]
fn frames_show_what_rust_draws_once_they_are_compiled() {
    let host = open();
    let [red, green, blue, alpha] = [0.05, 0.2, 0.6, 0.5];
    let word = ComputeTarget::color_word([red, green, blue, alpha]);
    assert_eq!(revmap_color_word(red, green, blue, alpha), word);
    for compute in [false, true] {
        check(&host, compute);
    }
}

fn check(host: &Host, compute: bool) {
    let device = borrow(host);
    let own = canvas(host, compute);
    let made = Renderer::new(&device, output(&own), &SearchSettings::default(), 2).unwrap();
    let wanted = in_rust(host, made, own).picture();
    let (device, canvas) = (lend(host), canvas(host, compute));
    let renderer = create(device, &canvas);
    let mut prewarm = null_mut();
    type Record = unsafe extern "C" fn(*mut RevmapRenderer, vk::CommandBuffer, u32) -> RevmapResult;
    let both: [Record; 2] = [revmap_renderer_record, revmap_renderer_record_compute];
    let [own, other] = [usize::from(compute), usize::from(!compute)].map(|n| both[n]);
    ok! { revmap_renderer_hide_until_compiled(renderer, 1); }
    add(renderer);
    let compiled = || {
        let mut info = sized!(RevmapDeviceInfo);
        ok! { revmap_device_info(device, &mut info); }
        info.pipelines_compiled
    };
    let statistics = |slot| {
        let mut statistics = sized!(RevmapFrameStatistics);
        ok! { revmap_renderer_frame_statistics(renderer, slot, &mut statistics); }
        statistics
    };
    let shown = |slot: u32, warms: bool| {
        let mut before = sized!(RevmapFrameStatistics);
        let picture = draw(host, &canvas, renderer, slot, |cmd| {
            before = statistics(slot);
            if warms {
                ok! { revmap_renderer_record_prewarm(renderer, cmd, slot); }
            } else {
                ok! { own(renderer, cmd, slot); }
            }
            fail! { Usage, "this renderer": other(renderer, cmd, slot); }
            let after = statistics(slot);
            let is_time = |ms: f64| (1e-6..6e4).contains(&ms);
            assert!(is_time(after.prepare_ms), "{after:?}");
            // A prewarming is no recording.
            let recorded = is_time(after.record_ms);
            assert!(recorded != warms && (recorded || after.record_ms == 0.0));
        });
        (picture.0, before)
    };
    let is_empty = |picture: &[u8]| picture.chunks_exact(4).all(|p| p == &picture[..4]);
    let before = compiled();
    let (picture, first) = shown(0, false);
    assert!(is_empty(&picture), "drawn");
    let work = |s: &RevmapFrameStatistics| s.draws + s.dispatches;
    assert!(first.hidden > 0 && first.draws == 0, "{first:?}");
    assert_eq!(compiled(), before);
    ok! {
        revmap_renderer_prewarm(renderer, &mut prewarm);
        revmap_prewarm_compile(prewarm);
        revmap_prewarm_destroy(prewarm);
    }
    let ready = compiled();
    assert!(ready > before);
    assert!(is_empty(&shown(1, true).0), "draws of no pixel have drawn");
    for slot in [0, 1] {
        let (picture, statistics) = shown(slot, false);
        assert!(picture == wanted.0, "pixels differ");
        assert_eq!((statistics.hidden, statistics.objects), (0, 2));
        assert_eq!(statistics.record_ms, 0.0, "not recorded yet");
        assert!(work(&statistics) > 0 && statistics.slot_bytes > 0);
    }
    let solid = wanted.0.chunks_exact(4).filter(|p| *p != &wanted.0[..4]);
    assert!(solid.count() > 3000);
    assert_eq!(compiled(), ready, "a frame has compiled");
    let mut all = sized!(RevmapStatistics);
    ok! { revmap_renderer_statistics(renderer, &mut all); }
    assert_eq!(all.objects, 2);
    assert!(!compute || (all.drawn_by_hull, all.drawn_by_tiles) == (0, 2));
    let (slot_bytes, mut used) = (statistics(0).slot_bytes, sized!(RevmapMemoryUse));
    ok! { revmap_device_memory_use(device, &mut used); }
    assert!(used.device + used.visible >= slot_bytes, "{used:?}");
    let mut unprepared = sized!(RevmapFrameStatistics);
    fail! {
        Usage, "not prepared": revmap_renderer_frame_statistics(renderer, 2, &mut unprepared);
    }
    ok! {
        revmap_renderer_destroy(renderer);
        revmap_device_memory_use(device, &mut used);
    }
    let left = used.device + used.visible + used.host;
    assert!(left < slot_bytes, "{used:?}");
    ok! { revmap_device_destroy(device); }
}
