//! Device trouble: no memory, a lost device, poorer devices, several renderers on one device, and
//! many in sequence.
#![allow(unsafe_code)]

use crate::calls::{Layer, Mask};
use crate::common::host::{Host, lent, open};
use crate::common::{device, eye, scene_of, shapes};
use crate::embedding::{assert_silent, three};
use ash::vk;
use glam::DVec3;
use revmap::error::ErrorKind;
use revmap::frame::Frame;
use revmap::gpu::{Device, DrawPath, HostDevice, Offscreen, Requirements};
use revmap::scene::{Placement, Scene, Shadow};
use revmap::settings::{DrawStage, Planes, Settings, Solver};

fn settings(stage: DrawStage) -> Settings {
    Settings {
        width: 48,
        height: 32,
        stage,
        map_rows: Some(32),
        ..Settings::default()
    }
}

/// The host's device, through the layer.
fn borrow(host: &Host, raw: &ash::Device, instance: &ash::Instance) -> revmap::Result<Device> {
    // SAFETY: the host's own handles; each test drops the device before the host.
    unsafe {
        Device::borrow(&HostDevice {
            instance,
            device: raw,
            ..lent(host)
        })
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

fn work(host: &Host, raw: &ash::Device, settings: &Settings) -> revmap::Result<()> {
    let device = borrow(host, raw, &host.instance)?;
    let [before, after] = scenes();
    let mut drawn = Offscreen::new(&device, &before, settings)?;
    drawn.draw()?;
    drawn.read()?;
    drawn.update(&after)?;
    drawn.draw()?;
    drawn.read()?;
    Ok(())
}

#[test]
fn each_allocation_that_fails_is_an_error_and_leaks_nothing() {
    let layer = Layer::take();
    let host = open();
    let raw = layer.device(&host.instance, &host.device);
    for (stage, solver) in [
        (DrawStage::Fragment, Solver::Exact),
        (DrawStage::Compute, Solver::Live),
    ] {
        let settings = Settings {
            solver,
            ..settings(stage)
        };
        layer.fail_at(usize::MAX);
        work(&host, &raw, &settings).unwrap();
        let all = layer.made();
        assert!(all > 50, "{stage:?}: {all} calls");
        assert_eq!(
            layer.alive(),
            0,
            "{stage:?}: left alive without any failure"
        );
        let mut seen = std::collections::BTreeSet::new();
        for n in 0..all {
            layer.fail_at(n);
            let result = work(&host, &raw, &settings);
            let failed = layer.failed().unwrap();
            let error = result.expect_err(failed);
            assert_eq!(
                error.kind,
                ErrorKind::OutOfDeviceMemory,
                "{failed}: {error}"
            );
            let message = error.to_string();
            // Errors of the allocator's own calls have its wording.
            let named = message.contains(failed) || message.contains("memory");
            assert!(named, "{stage:?}, call {n}, {failed}: {message}");
            assert_eq!(
                layer.alive(),
                0,
                "{stage:?}, call {n}, {failed}: left alive"
            );
            seen.insert(failed);
        }
        println!("{stage:?}: {all} calls of {} kinds", seen.len());
        assert!(seen.len() > 15, "{seen:?}");
    }
    assert_silent(&host);
}

/// A renderer works again after a failed update, once memory is available and an update succeeds.
#[test]
fn a_renderer_survives_a_failed_update() {
    let layer = Layer::take();
    let host = open();
    let raw = layer.device(&host.instance, &host.device);
    let device = borrow(&host, &raw, &host.instance).unwrap();
    let settings = settings(DrawStage::Fragment);
    let [before, after] = scenes();
    let wanted = picture(&device, &after, &settings);
    let mut drawn = Offscreen::new(&device, &before, &settings).unwrap();
    drawn.draw().unwrap();
    let mut failures = 0;
    for n in 0.. {
        drawn.update(&before).unwrap();
        drawn.draw().unwrap();
        layer.fail_at(n);
        let failed = drawn.update(&after).and_then(|()| drawn.draw()).is_err();
        layer.fail_at(usize::MAX);
        if !failed {
            break;
        }
        failures += 1;
    }
    assert!(failures > 0);
    drawn.update(&after).unwrap();
    drawn.draw().unwrap();
    assert_same(&drawn.read().unwrap(), &wanted);
    drop((drawn, device));
    assert_eq!(layer.alive(), 0);
    assert_silent(&host);
}

#[test]
fn a_lost_device_is_an_error_in_every_later_frame() {
    let layer = Layer::take();
    let host = open();
    let raw = layer.device(&host.instance, &host.device);
    for told_by in ["vkQueueSubmit", "vkWaitForFences"] {
        for stage in [DrawStage::Fragment, DrawStage::Compute] {
            let device = borrow(&host, &raw, &host.instance).unwrap();
            let [before, after] = scenes();
            let mut drawn = Offscreen::new(&device, &before, &settings(stage)).unwrap();
            drawn.draw().unwrap();
            layer.lose(Some(told_by));
            let _ = drawn.update(&after);
            for told_by in [told_by, "vkQueueSubmit", "vkQueueSubmit"] {
                let error = drawn.draw().unwrap_err();
                let text = error.to_string();
                assert_eq!(error.kind, ErrorKind::DeviceLost, "{text}");
                assert!(
                    text.contains(told_by) && text.contains("the device was lost"),
                    "{text}"
                );
                assert!(drawn.read().is_err());
            }
            drop((drawn, device));
            layer.lose(None);
            assert_eq!(layer.alive(), 0, "{told_by}, {stage:?}");
        }
    }
    assert_silent(&host);
}

/// A loss detected by the allocator is reported as a lost device, not as lack of memory.
#[test]
fn a_device_that_is_lost_while_memory_is_allocated_is_lost() {
    let layer = Layer::take();
    let host = open();
    let raw = layer.device(&host.instance, &host.device);
    let device = borrow(&host, &raw, &host.instance).unwrap();
    layer.lose(Some("vkAllocateMemory"));
    let settings = settings(DrawStage::Fragment);
    let Err(error) = Offscreen::new(&device, &scenes()[0], &settings) else {
        panic!("made on a lost device");
    };
    assert_eq!(error.kind, ErrorKind::DeviceLost, "{error}");
    assert!(error.to_string().contains("the device was lost"), "{error}");
    drop(device);
    layer.lose(None);
    assert_eq!(layer.alive(), 0);
    assert_silent(&host);
}

fn picture(device: &Device, scene: &Scene, settings: &Settings) -> Frame {
    let mut drawn = Offscreen::new(device, scene, settings).unwrap();
    drawn.draw().unwrap();
    drawn.read().unwrap()
}

#[track_caller]
fn assert_same(a: &Frame, b: &Frame) {
    assert_eq!(a.pixels(), b.pixels());
    let bits = |frame: &Frame, i| frame.pixel(i).map(f32::to_bits);
    let differ = (0..a.pixels())
        .filter(|&i| bits(a, i) != bits(b, i))
        .count();
    assert_eq!(differ, 0, "pixels differ");
}

/// A device without a required feature is refused, and the error names the feature.
#[test]
fn a_device_without_what_is_needed_is_refused() {
    let layer = Layer::take();
    let host = open();
    // SAFETY: the system's loader, as in the host.
    let entry = unsafe { ash::Entry::load() }.unwrap();
    let formats = [
        (vk::Format::R16_SFLOAT, "sampled 16-bit float images"),
        (vk::Format::R32_SFLOAT, "sampled 32-bit float images"),
        (
            vk::Format::R32G32B32A32_SFLOAT,
            "render targets and storage images",
        ),
        (vk::Format::D32_SFLOAT, "a 32-bit float depth buffer"),
    ];
    let mut masks = formats
        .map(|(format, name)| {
            let format = Some(format);
            (
                Mask {
                    format,
                    ..Mask::default()
                },
                name,
            )
        })
        .to_vec();
    masks.push((
        Mask {
            version: true,
            ..Mask::default()
        },
        "Vulkan 1.2",
    ));
    masks.push((
        Mask {
            stores: true,
            ..Mask::default()
        },
        "fragmentStoresAndAtomics",
    ));
    masks.push((
        Mask {
            compute: true,
            ..Mask::default()
        },
        "a queue for graphics and compute",
    ));
    for (mask, lack) in masks {
        let instance = layer.instance(&entry, &host.instance, mask);
        let Err(error) = borrow(&host, &host.device, &instance) else {
            panic!("taken without {lack}");
        };
        assert_eq!(error.kind, ErrorKind::Unsupported, "{error}");
        assert!(
            error.to_string().contains(&format!("lacks {lack}")),
            "{error}"
        );
    }
    assert_silent(&host);
}

/// The report on hulls matches the drawing: no hulls on devices with coarse sub-pixel precision.
#[test]
fn the_report_and_the_features_asked_for_agree() {
    let layer = Layer::take();
    let host = open();
    // SAFETY: as above.
    let entry = unsafe { ash::Entry::load() }.unwrap();
    for sub_pixels in [false, true] {
        let mask = Mask {
            sub_pixels,
            ..Mask::default()
        };
        let instance = layer.instance(&entry, &host.instance, mask);
        let device = borrow(&host, &host.device, &instance).unwrap();
        let mut uses = device.report().uses.iter();
        let hulls = uses.find(|(what, _)| what.starts_with("hulls")).unwrap();
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(&instance, host.physical) }.unwrap();
        let clips = needs.features.shader_clip_distance == vk::TRUE;
        assert_eq!(hulls.1, if clips { "yes" } else { "no" });
        assert!(!(clips && sub_pixels));
    }
    assert_silent(&host);
}

/// A device without optional features draws the same picture.
#[test]
fn a_device_without_what_is_optional_draws_the_same() {
    let layer = Layer::take();
    let host = open();
    // SAFETY: as above.
    let entry = unsafe { ash::Entry::load() }.unwrap();
    let mut scene = three();
    scene.shadow = Shadow::Hard;
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let settings = Settings {
            width: 160,
            height: 120,
            ..settings(stage)
        };
        let whole = borrow(&host, &host.device, &host.instance).unwrap();
        let wanted = picture(&whole, &scene, &settings);
        for mask in [
            Mask {
                anisotropy: true,
                ..Mask::default()
            },
            Mask {
                timestamps: true,
                ..Mask::default()
            },
            Mask {
                varyings: true,
                ..Mask::default()
            },
        ] {
            let instance = layer.instance(&entry, &host.instance, mask);
            let poorer = borrow(&host, &host.device, &instance).unwrap();
            let mut drawn = Offscreen::new(&poorer, &scene, &settings).unwrap();
            let times = drawn.draw().unwrap();
            assert_eq!(times.gpu_ms.is_none(), mask.timestamps);
            if mask.varyings && stage == DrawStage::Fragment {
                // Cells need more varyings, so tiles are drawn; the visible solids are the same.
                let paths = drawn.draw_paths();
                assert!(
                    paths.iter().all(|path| *path == DrawPath::Tiles),
                    "{paths:?}"
                );
                let frame = drawn.read().unwrap();
                let differ = |&i: &usize| frame.hits(i) != wanted.hits(i);
                let differ = (0..frame.pixels()).filter(differ).count();
                assert!(differ <= 2, "{differ} pixels hit in one of them");
            } else {
                assert_same(&drawn.read().unwrap(), &wanted);
            }
        }
    }
    assert_silent(&host);
}

/// Colour in a pass needs no feature at all.
#[test]
fn colour_is_drawn_on_a_device_opened_without_features() {
    let _layer = Layer::take();
    let host = Host::open(true, |instance, physical| {
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(instance, physical) }?;
        Ok((needs.queue_family, vk::PhysicalDeviceFeatures::default()))
    })
    .unwrap();
    let bare = borrow(&host, &host.device, &host.instance).unwrap();
    let settings = Settings {
        planes: Planes::Color,
        ..settings(DrawStage::Fragment)
    };
    // The squares of a crowd are triangles on devices without points of several pixels.
    let mut crowd = three();
    for (number, object) in (0..).zip(&mut crowd.objects) {
        let base = object.placement;
        let of = |n: u32| Placement {
            position: base.position
                + DVec3::new(-0.4 * f64::from(n), 0.13 * f64::from((n + number) % 9), 0.0),
            ..base
        };
        object.instances = (0..70).map(of).collect();
    }
    for scene in [&three(), &crowd] {
        assert_same(
            &picture(&bare, scene, &settings),
            &picture(device(), scene, &settings),
        );
    }
    drop(bare);
    assert_silent(&host);
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
                        drawn.draw().unwrap();
                        assert_same(&drawn.read().unwrap(), wanted);
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
    let layer = Layer::take();
    let host = open();
    let raw = layer.device(&host.instance, &host.device);
    let device = borrow(&host, &raw, &host.instance).unwrap();
    let scenes = scenes();
    let mut alive = [0; 2];
    for cycle in 0..1000 {
        let stage = [DrawStage::Fragment, DrawStage::Compute][cycle % 2];
        let settings = Settings {
            width: 8,
            height: 8,
            ..settings(stage)
        };
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
    assert_eq!(
        alive[0], alive[1],
        "made and not destroyed after 4 renderers and after 1000"
    );
    drop(device);
    assert_eq!(layer.alive(), 0);
    assert_silent(&host);
}
