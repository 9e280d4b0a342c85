//! Device trouble: no memory, a lost device, poorer devices, several renderers on one device, and
//! many in sequence.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{
    Canvas, Checked, Host, add, borrow, borrow_through, once, open, open_with, renderer_of, view_of,
};
use crate::common::prelude::*;
use crate::common::ways::apart;
use crate::embedding::{options, three};
use crate::memory_types::simulated;

pub fn settings(stage: DrawStage) -> Settings {
    Settings {
        width: 48,
        height: 32,
        stage,
        map_rows: Some(32),
        ..Settings::default()
    }
}

/// One solid searched by its surface and one by its map. The second scene has some changes.
fn scenes() -> [Scene; 2] {
    let before = scene_of(shapes::vase(), eye(25.0, 3.0));
    let mut after = before.clone();
    after.objects[0].offset.extend = 0.02;
    after.objects.extend(three().objects.drain(1..2));
    [before, after]
}

fn work(
    host: &Host,
    (instance, raw): &(ash::Instance, ash::Device),
    settings: &Settings,
) -> revmap::Result<()> {
    let device = borrow_through(host, instance, raw)?;
    let [before, after] = scenes();
    let mut drawn = Offscreen::new(&device, &before, settings)?;
    drawn.draw()?;
    drawn.read()?;
    drawn.update(&after)?;
    drawn.draw()?;
    drawn.read()?;
    Ok(())
}

/// The layer, and a host with the layer above its device.
fn layered() -> (Layer, Checked, ash::Device) {
    let (layer, host) = (Layer::take(), open());
    let raw = layer.device(&host.instance, &host.device);
    (layer, host, raw)
}

/// Each call that fails returns an error and leaks nothing. A device of several types of memory is
/// asked for another type if one is full or cannot be mapped, so such a failure may change nothing.
/// Returns how many changed nothing.
fn fail_each_call(
    layer: &Layer,
    host: &Host,
    of: &(ash::Instance, ash::Device),
    types: u32,
) -> usize {
    let memory = ["vkAllocateMemory", "vkMapMemory"];
    let mut unchanged = 0;
    for (stage, solver) in [
        (DrawStage::Fragment, Solver::Exact),
        (DrawStage::Compute, Solver::Live),
    ] {
        let settings = settings(stage).with(|s| s.solver = solver);
        layer.fail_at(usize::MAX);
        work(host, of, &settings).unwrap();
        let all = layer.made();
        assert!(all > 50, "{stage:?}: {all} calls");
        assert_eq!(layer.alive(), 0, "{stage:?}: left without any failure");
        let mut seen = std::collections::BTreeSet::new();
        for n in 0..all {
            layer.fail_at(n);
            let result = work(host, of, &settings);
            let failed = layer.failed().unwrap();
            if memory.contains(&failed) && types > 1 && result.is_ok() {
                assert_eq!(layer.alive(), 0, "{stage:?}, call {n}, left alive");
                unchanged += 1;
                continue;
            }
            let error = result.expect_err(failed);
            let kind = ErrorKind::OutOfDeviceMemory;
            assert_eq!(error.kind, kind, "{failed}: {error}");
            let message = error.to_string();
            // Errors of the allocator's own calls have its wording.
            let named = message.contains(failed) || message.contains("memory");
            let what = format!("{stage:?}, call {n}, {failed}: {message}");
            assert!(named, "{what}");
            assert_eq!(layer.alive(), 0, "{what}, left alive");
            seen.insert(failed);
        }
        println!("{stage:?}: {all} calls of {} kinds", seen.len());
        assert!(seen.len() > 15, "{seen:?}");
    }
    unchanged
}

#[test]
fn each_allocation_that_fails_is_an_error_and_leaks_nothing() {
    let (layer, host, raw) = layered();
    // SAFETY: a plain query of live handles.
    let memory = unsafe { (host.instance).get_physical_device_memory_properties(host.physical) };
    let of = (host.instance.clone(), raw);
    fail_each_call(&layer, &host, &of, memory.memory_type_count);
}

/// The same on a device with types of memory as GPUs have.
#[test]
fn another_type_of_memory_stands_in_for_a_full_one() {
    let (layer, host) = (Layer::take(), open());
    let of = simulated(&host, |name, real| layer.plant(name, real));
    assert!(fail_each_call(&layer, &host, &of, 6) > 2);
}

#[test]
fn a_lost_device_is_an_error_in_every_later_frame() {
    let (layer, host, raw) = layered();
    for told_by in ["vkQueueSubmit", "vkWaitForFences"] {
        for stage in [DrawStage::Fragment, DrawStage::Compute] {
            let device = borrow_through(&host, &host.instance, &raw).unwrap();
            let [before, after] = scenes();
            let mut drawn = Offscreen::new(&device, &before, &settings(stage)).unwrap();
            drawn.draw().unwrap();
            layer.lose(Some(told_by));
            let _ = drawn.update(&after);
            for told_by in [told_by, "vkQueueSubmit", "vkQueueSubmit"] {
                let error = drawn.draw().unwrap_err();
                let text = error.to_string();
                assert_eq!(error.kind, ErrorKind::DeviceLost, "{text}");
                let told = text.contains(told_by) && text.contains("the device was lost");
                assert!(told, "{text}");
                assert!(drawn.read().is_err());
            }
            drop((drawn, device));
            layer.lose(None);
            assert_eq!(layer.alive(), 0, "{told_by}, {stage:?}");
        }
    }
}

/// A wait that fails leaves the commands pending. The next frame waits for them, and so does the end.
#[test]
fn a_wait_that_fails_is_made_up_for() {
    let (layer, host, raw) = layered();
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let [scene, _] = scenes();
        let settings = settings(stage);
        let wanted = picture(&device, &scene, &settings);
        let mut drawn = Offscreen::new(&device, &scene, &settings).unwrap();
        for waits in [1, 2] {
            // The second one meets the wait before the next frame.
            layer.end_waits_early(waits);
            for _ in 0..waits {
                let error = drawn.draw().unwrap_err();
                assert!(error.to_string().contains("vkWaitForFences"), "{error}");
            }
            assert_same(&next_frame(&mut drawn), &wanted);
        }
        layer.end_waits_early(1);
        drawn.draw().unwrap_err();
        drop(drawn);
    }
    drop(device);
    assert_eq!(layer.alive(), 0);
}

pub fn picture(device: &Device, scene: &Scene, settings: &Settings) -> Frame {
    next_frame(&mut Offscreen::new(device, scene, settings).unwrap())
}

#[track_caller]
fn assert_same(a: &Frame, b: &Frame) {
    assert_eq!(a.first_difference(b), None);
}

/// The size of a subgroup chooses between lists of patches and the tree. Both find the same surface, and
/// nothing else depends on the size.
#[test]
fn subgroups_of_any_size_draw_the_same() {
    let (layer, host) = (Layer::take(), open());
    let scene = scene_of(shapes::vase(), eye(25.0, 0.9));
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let settings = Settings {
            width: 400,
            height: 300,
            // Lists on GPUs, too.
            proxy_min_pixels: 0,
            ..settings(stage)
        };
        let [small, wide @ ..] = [4, 16, 32, 64].map(|subgroup| {
            let device = layer.poorer(&host, |m| m.subgroup = subgroup).unwrap();
            picture(&device, &scene, &settings)
        });
        wide.iter().for_each(|frame| assert_same(frame, &wide[0]));
        let (hits, edges, far) = apart(&wide[0], &small);
        assert!(hits > 20_000, "{stage:?}: {hits} hits");
        assert!(
            edges <= 2 && far == 0,
            "{stage:?}: {edges} at edges, {far} far"
        );
        // The planted size reached the plan: other patches were tested.
        let other = wide[0].steps != small.steps;
        assert_eq!(other, stage == DrawStage::Compute, "{stage:?}");
    }
}

/// Colour in a pass needs no feature at all.
#[test]
fn colour_is_drawn_on_a_device_opened_without_features() {
    let _layer = Layer::take();
    let host = open_with(|_| vk::PhysicalDeviceFeatures::default());
    let bare = borrow(&host);
    let settings = settings(DrawStage::Fragment).with(|s| s.planes = Planes::Color);
    // The squares of a crowd are triangles on devices without points of several pixels.
    let mut crowd = three();
    for (number, object) in (0..).zip(&mut crowd.objects) {
        let base = object.placement;
        let of = |n: u32| {
            let by = [-0.4 * f64::from(n), 0.13 * f64::from((n + number) % 9), 0.0];
            let position = base.position + DVec3::from_array(by);
            Placement { position, ..base }
        };
        object.instances = (0..70).map(of).collect();
    }
    for scene in [&three(), &crowd] {
        let wanted = picture(device(), scene, &settings);
        assert_same(&picture(&bare, scene, &settings), &wanted);
    }
    device().check().unwrap();
}

/// Two threads, each with its own renderer on the same device.
#[test]
fn renderers_on_one_device_do_not_disturb_each_other() {
    let [one, other] = scenes();
    let cases = [(one, DrawStage::Fragment), (other, DrawStage::Compute)];
    let wanted = cases
        .each_ref()
        .map(|(scene, stage)| picture(device(), scene, &settings(*stage)));
    std::thread::scope(|scope| {
        for ((scene, stage), wanted) in cases.iter().zip(&wanted) {
            scope.spawn(move || {
                for _ in 0..4 {
                    let mut drawn = Offscreen::new(device(), scene, &settings(*stage)).unwrap();
                    for _ in 0..4 {
                        assert_same(&next_frame(&mut drawn), wanted);
                    }
                }
            });
        }
    });
    device().check().unwrap();
}

/// A thousand renderers in sequence on one device. No object made by a renderer outlives it.
#[test]
fn a_thousand_renderers_leave_nothing_behind() {
    let (layer, host, raw) = layered();
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let scenes = scenes();
    let mut alive = [0; 2];
    for cycle in 0..1000 {
        let stage = [DrawStage::Fragment, DrawStage::Compute][cycle % 2];
        let settings = settings(stage).with(|s| (s.width, s.height) = (8, 8));
        let mut drawn = Offscreen::new(&device, &scenes[cycle / 2 % 2], &settings).unwrap();
        // Each kind of picture at first, then some: objects made by a frame end with the renderer,
        // too.
        if cycle < 4 || cycle % 50 < 4 {
            drawn.draw().unwrap();
        }
        drop(drawn);
        if cycle == 3 || cycle == 999 {
            alive[usize::from(cycle == 999)] = layer.alive();
        }
    }
    // Made and not destroyed after 4 renderers and after 1000.
    assert_eq!(alive[0], alive[1]);
    drop(device);
    assert_eq!(layer.alive(), 0);
}

/// A preparation that fails leaves the frame before it valid, or that frame names the failure.
#[test]
fn a_failed_preparation_keeps_the_frame_before_it_or_is_named() {
    let (layer, host, raw) = layered();
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let [before, after] = scenes();
    let options = options();
    let view = view_of(&before, &options);
    let words = Canvas::words(&host, options);
    // Records a frame that is older than a second preparation, after a change. The n-th call fails.
    let record = |search: &SearchSettings, n: usize, change: &dyn Fn(&mut Renderer)| {
        let output = Output::Compute(Planes::Color);
        let mut renderer = renderer_of(&device, output, search, 1, &before);
        words.lend(&mut renderer, true);
        // SAFETY: the commands are recorded outside of a pass, and no frame is in flight.
        once(&host, |cmd| unsafe {
            let frame = renderer.prepare(cmd, 0, &view).unwrap();
            change(&mut renderer);
            layer.fail_at(n);
            let second = renderer.prepare(cmd, 0, &view);
            layer.fail_at(usize::MAX);
            (second.err(), renderer.record_compute(cmd, &frame).err())
        })
    };
    let search = SearchSettings::default();
    let grows = |renderer: &mut Renderer| {
        (0..100).for_each(|_| drop(add(renderer, &after)));
    };
    let mut refused = 0;
    while let (Some(_), refusal) = record(&search, refused, &grows) {
        let message = refusal.expect("its buffers are written").message;
        assert!(message.contains("preparation"), "call {refused}: {message}");
        refused += 1;
    }
    assert!(refused > 0);
    let (_, refusal) = record(&search, usize::MAX, &grows);
    assert!(refusal.unwrap().message.contains("prepared again"));
    // Content that cannot be drawn is found before anything is written.
    let by_map = SearchSettings {
        solver: Solver::Live,
        map_format: MapFormat::Rgba8,
        ..search
    };
    let shrinks = |renderer: &mut Renderer| {
        let mut object = before.objects[0].clone();
        object.offset.extend = -0.05;
        renderer.add(object).unwrap();
    };
    let (error, refusal) = record(&by_map, usize::MAX, &shrinks);
    assert!(error.unwrap().to_string().contains("rgba8") && refusal.is_none());
}
