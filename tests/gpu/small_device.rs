//! A simulated device of 4 GiB: what does not fit is refused by kind, and everything else goes on.
#![allow(unsafe_code)]

use crate::calls::{Layer, above, planted_device};
use crate::common::host::{borrow_through, open};
use crate::common::prelude::*;
use crate::embedding::three;
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

    assert!(next_frame(&mut small).first_difference(&before).is_none());
    drop((small, first));
    assert_eq!(device.memory_use(), MemoryUse::default());
    drop(device);
    assert_eq!(live(), 0);
}
