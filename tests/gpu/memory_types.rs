//! Memory types chosen for buffers and images on a device with six simulated types: test drivers
//! have only one. Non-coherent memory is never mapped, so nothing needs a flush.
#![allow(unsafe_code)]

use crate::calls::{Layer, above, planted_device, planted_instance};
use crate::common::host::{Host, borrow_through, open};
use crate::common::prelude::*;
use std::ffi::{CStr, c_void};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::atomic::{AtomicU64, AtomicUsize};
use vk::MemoryPropertyFlags as Flags;

/// Host-visible types without coherence come before every coherent type that fits.
const TYPES: [Flags; 6] = {
    let (local, seen) = (Flags::DEVICE_LOCAL.as_raw(), Flags::HOST_VISIBLE.as_raw());
    let (coherent, cached) = (Flags::HOST_COHERENT.as_raw(), Flags::HOST_CACHED.as_raw());
    [
        Flags::from_raw(seen | cached),
        Flags::from_raw(local),
        Flags::from_raw(local | seen),
        Flags::from_raw(seen | coherent),
        Flags::from_raw(local | seen | coherent),
        Flags::from_raw(seen | coherent | cached),
    ]
};

/// Bytes allocated of each type.
static ALLOCATED: [AtomicU64; TYPES.len()] = [const { AtomicU64::new(0) }; TYPES.len()];
/// The driver's types behind the simulated ones: one that is device-local, for images too, and one
/// that the host sees.
static TRUE_TYPES: [AtomicUsize; 2] = [const { AtomicUsize::new(0) }; 2];

/// Memory of any type.
const ANY: u32 = (1 << TYPES.len()) - 1;

above! { types;
    "vkGetPhysicalDeviceMemoryProperties" properties: PFN_vkGetPhysicalDeviceMemoryProperties(
        _physical: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceMemoryProperties
    ), |_real| {
        let mut all = vk::PhysicalDeviceMemoryProperties {
            memory_type_count: TYPES.len() as u32,
            memory_heap_count: 2,
            ..Default::default()
        };
        for (to, flags) in all.memory_types.iter_mut().zip(TYPES) {
            to.property_flags = flags;
            to.heap_index = u32::from(!flags.contains(Flags::DEVICE_LOCAL));
        }
        all.memory_heaps[0].flags = vk::MemoryHeapFlags::DEVICE_LOCAL;
        all.memory_heaps[..2].iter_mut().for_each(|heap| heap.size = 1 << 30);
        *out = all;
    }
}

above! { memory;
    "vkGetBufferMemoryRequirements" of_buffer: PFN_vkGetBufferMemoryRequirements(
        device: vk::Device, buffer: vk::Buffer, out: *mut vk::MemoryRequirements
    ), |real| {
        real(device, buffer, out);
        (*out).memory_type_bits = ANY;
    }
    "vkGetImageMemoryRequirements" of_image: PFN_vkGetImageMemoryRequirements(
        device: vk::Device, image: vk::Image, out: *mut vk::MemoryRequirements
    ), |real| {
        real(device, image, out);
        (*out).memory_type_bits = ANY;
    }
    "vkAllocateMemory" allocate: PFN_vkAllocateMemory(
        device: vk::Device, info: *const vk::MemoryAllocateInfo<'_>,
        callbacks: *const vk::AllocationCallbacks<'_>, out: *mut vk::DeviceMemory
    ) -> vk::Result, |real| {
        let mut info = *info;
        ALLOCATED[info.memory_type_index as usize].fetch_add(info.allocation_size, SeqCst);
        let seen = TYPES[info.memory_type_index as usize].contains(Flags::HOST_VISIBLE);
        info.memory_type_index = TRUE_TYPES[usize::from(seen)].load(SeqCst) as u32;
        real(device, &raw const info, callbacks, out)
    }
}

/// The host's instance and device with these types of memory. `above` may plant a function of a name
/// above the one given.
pub fn simulated(
    host: &Host,
    above: impl Fn(&CStr, usize) -> Option<*const c_void>,
) -> (ash::Instance, ash::Device) {
    let seen = Flags::HOST_VISIBLE | Flags::HOST_COHERENT;
    // SAFETY: a plain query of live handles.
    let all = unsafe { (host.instance).get_physical_device_memory_properties(host.physical) };
    for (to, flags) in TRUE_TYPES.iter().zip([Flags::DEVICE_LOCAL, seen]) {
        let mut all = all.memory_types_as_slice().iter();
        let found = all.position(|t| t.property_flags.contains(flags));
        to.store(found.unwrap(), SeqCst);
    }
    let instance = planted_instance(&host.entry, &host.instance, types);
    let raw = planted_device(&host.instance, &host.device, |name, real| {
        let planted = memory(name, real);
        above(name, planted.map_or(real, |own| own as usize)).or(planted)
    });
    (instance, raw)
}

#[test]
fn each_use_gets_its_kind_of_memory_and_all_that_is_mapped_is_coherent() {
    let _alone = Layer::take();
    let host = open();
    let (instance, raw) = simulated(&host, |_, _| None);
    for bytes in &ALLOCATED {
        bytes.store(0, SeqCst);
    }
    let device = borrow_through(&host, &instance, &raw).unwrap();
    assert_eq!(device.memory_use(), MemoryUse::default());
    let scene = scene_of(shapes::vase(), eye(25.0, 3.0));
    let settings = Settings {
        width: 64,
        height: 48,
        stage: DrawStage::Compute,
        planes: Planes::All,
        ..Settings::default()
    };
    let mut drawn = Offscreen::new(&device, &scene, &settings).unwrap();
    drawn.draw().unwrap();
    let before = device.memory_use();
    drawn.read().unwrap();
    let after = device.memory_use();
    // Images and pixel words; blocks, instances and tables; staging; readback.
    let pixels = 64 * 48;
    assert!(before.device >= (4 * 16 + 8) * pixels, "{before:?}");
    assert!(before.visible > 0 && before.host > 0, "{before:?}");
    let read = after.host - before.host;
    assert!(read >= (4 * 16 + 4) * pixels, "{before:?}, {after:?}");
    assert_eq!(after.device, before.device);
    assert_eq!(after.visible, before.visible);
    let bytes = ALLOCATED.each_ref().map(|bytes| bytes.load(SeqCst));
    let used = [false, true, false, true, true, true];
    assert_eq!(bytes.map(|b| b > 0), used, "{bytes:?}");
    drop(drawn);
    assert_eq!(device.memory_use(), MemoryUse::default());
}
