//! Device memory: a simulated device of 4 GiB, on which what does not fit is refused by kind, and
//! everything else goes on; surfaces and objects without end.
#![allow(unsafe_code)]

use crate::calls::{Layer, above, planted_device};
use crate::common::host::{Drawn, borrow_through, color_pass, open, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};
use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::SeqCst;

/// Bytes of the device.
const BYTES: u64 = 4 << 30;

/// Bytes of each live allocation, by its handle.
static LIVE: Mutex<Option<HashMap<vk::DeviceMemory, u64>>> = Mutex::new(None);
/// Allocations that did not fit.
static REFUSED: AtomicUsize = AtomicUsize::new(0);

fn live() -> u64 {
    let live = LIVE.lock().unwrap();
    live.iter().flat_map(|all| all.values()).sum()
}

above! { memory;
    "vkAllocateMemory" allocate: PFN_vkAllocateMemory(
        device: vk::Device, info: *const vk::MemoryAllocateInfo<'_>,
        callbacks: *const vk::AllocationCallbacks<'_>, out: *mut vk::DeviceMemory
    ) -> vk::Result, |real| {
        let bytes = (*info).allocation_size;
        if live() + bytes > BYTES {
            REFUSED.fetch_add(1, SeqCst);
            return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
        }
        let code = real(device, info, callbacks, out);
        if code == vk::Result::SUCCESS {
            let mut live = LIVE.lock().unwrap();
            live.get_or_insert_default().insert(*out, bytes);
        }
        code
    }
    "vkFreeMemory" free: PFN_vkFreeMemory(
        device: vk::Device, memory: vk::DeviceMemory, callbacks: *const vk::AllocationCallbacks<'_>
    ), |real| {
        LIVE.lock().unwrap().get_or_insert_default().remove(&memory);
        real(device, memory, callbacks);
    }
}

#[test]
fn what_does_not_fit_is_refused_and_the_rest_goes_on() {
    let _alone = Layer::take();
    let host = open();
    let raw = planted_device(&host.instance, &host.device, memory);
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let mut scene = three();
    let place = |n: u32| {
        let (x, y) = (f64::from(n / 300), f64::from(n % 300) - 150.0);
        scaled([-0.4 * x, -0.4 * y, 0.0], 0.4)
    };
    scene.objects[1].instances = (0..90_000).map(place).collect();
    let settings = sized(160, 120);
    let mut small = Offscreen::new(&device, &scene, &settings).unwrap();
    let before = next_frame(&mut small);
    let fits = live();
    assert!(
        (1..256 << 20).contains(&fits),
        "{fits} bytes for 90,000 copies"
    );
    assert_eq!(REFUSED.load(SeqCst), 0);

    // Colours of one sample, depths and colours of four: 2.25 GiB. A second such picture has no room.
    let large = Settings {
        width: 8192,
        height: 8192,
        stage: DrawStage::Fragment,
        planes: Planes::Color,
        ..settings
    };
    let options = OffscreenOptions::default().with(|o| o.samples = 4);
    let with = || Offscreen::with(&device, &scene, &large, options);
    let first = with().unwrap();
    let (used, full) = (device.memory_use(), live());
    assert!(full > (9 << 30) / 4, "{full}");
    let refused = with().err().unwrap();
    assert_eq!(refused.kind, ErrorKind::OutOfDeviceMemory, "{refused}");
    assert!(refused.to_string().contains("smaller"), "{refused}");
    assert_eq!(REFUSED.load(SeqCst), 1);
    assert_eq!((device.memory_use(), live()), (used, full));

    device.set_memory_budget(Some(used.total() + (1 << 20)));
    let small_settings = settings.with(|s| s.width = 800);
    let refused = Offscreen::new(&device, &scene, &small_settings)
        .err()
        .unwrap();
    assert!(refused.message.contains("memory budget"), "{refused}");
    assert_eq!(device.memory_use(), used);

    assert!(next_frame(&mut small).first_difference(&before).is_none());
    drop((small, first));
    assert_eq!(device.memory_use(), MemoryUse::default());
    drop(device);
    assert_eq!(live(), 0);
}

/// Device memory after two thousand frames equals that after a hundred, although every frame builds
/// surfaces.
#[test]
fn memory_stays_flat() {
    let (host, device) = opened();
    let options = options().with(|o| (o.width, o.height) = (32, 24));
    let camera = Camera::new(DVec3::new(1.0, 1.0, 3.0), DVec3::new(-3.0, -2.5, 0.0));
    let profile = Arc::new(shapes::sphere());
    let object = |x: f64| {
        let place = scaled([x, -2.5, 0.0], 0.4);
        Object::new("one", profile.clone()).with(|o| o.placement = place)
    };
    let scene = Scene::new(camera).with(|s| s.objects = vec![object(-3.0), object(-2.5)]);
    let by = (Output::Pass(color_pass()), &SearchSettings::exact());
    let mut few = Drawn::new(&host, &device, options, by, &scene);
    let taken = || {
        let allocator = device.allocator().unwrap();
        let report = allocator.lock().unwrap().generate_report();
        (report.total_allocated_bytes, report.total_capacity_bytes)
    };
    let mut early = None;
    for n in 0..2000u32 {
        let extend = 0.01 + 1e-6 * f64::from(n);
        let id = few.ids[n as usize % 2];
        few.renderer
            .set_offset(id, offset(extend, 0.0, 1.0))
            .unwrap();
        few.picture();
        if n == 100 {
            early = Some(taken());
        }
    }
    assert_eq!(early, Some(taken()));
    assert_eq!(few.renderer.rebuild_count(), 2001);
}

/// Twenty thousand objects use ten times the device memory of two thousand, and can be removed.
#[test]
fn objects_by_the_ten_thousand() {
    let (host, device) = opened();
    let profiles = [shapes::vase(), shapes::sphere(), shapes::glass()].map(Arc::new);
    let object = |n: u32| {
        let mut object = Object::new("one", profiles[n as usize % profiles.len()].clone());
        let (x, y) = (f64::from(n % 150), f64::from(n / 150));
        object.placement = placement([0.1 * x - 7.5, 0.1 * y - 6.5, 0.0], [0.0; 3], [0.1; 3]);
        object
    };
    let empty = scene_of(shapes::vase(), eye(25.0, 3.0)).with(|s| s.objects = Vec::new());
    let bytes = |count: u32| {
        let by = (Output::Compute(Planes::Color), &SearchSettings::exact());
        let mut drawn = Drawn::new(&host, &device, options(), by, &empty);
        let objects = (0..count).map(|n| drawn.renderer.add(object(n)).unwrap());
        let ids: Vec<_> = objects.collect();
        drawn.picture();
        let bytes = device.memory_use().total();
        for id in ids.iter().step_by(20) {
            drawn.renderer.remove(*id).unwrap();
        }
        assert_eq!(drawn.renderer.object_count(), ids.len() - ids.len() / 20);
        drawn.picture();
        bytes
    };
    let (few, many) = (bytes(2_000), bytes(20_000));
    println!("{few} and {many} bytes");
    assert!(many < 14 * few);
}
