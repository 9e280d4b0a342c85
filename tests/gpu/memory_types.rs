//! Memory types chosen for buffers and images on a device with six simulated types: test drivers
//! have only one. Non-coherent memory is never mapped, so nothing needs a flush.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{lent, open};
use crate::common::{eye, scene_of, shapes};
use ash::vk;
use revmap::gpu::{Device, HostDevice, MemoryUse, Offscreen};
use revmap::settings::{DrawStage, Planes, Settings};
use std::ffi::c_void;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::SeqCst};
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
/// The driver's type that replaces all of them.
static TRUE_TYPE: AtomicUsize = AtomicUsize::new(0);
static REAL: [AtomicUsize; 3] = [const { AtomicUsize::new(0) }; 3];

/// # Safety
/// `F` is the type of the function stored at `n`.
unsafe fn real<F: Copy>(n: usize) -> F {
    let pointer = REAL[n].load(SeqCst);
    // SAFETY: a pointer to a function.
    unsafe { std::mem::transmute_copy(&pointer) }
}

unsafe extern "system" fn types(
    _: vk::PhysicalDevice,
    out: *mut vk::PhysicalDeviceMemoryProperties,
) {
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
    all.memory_heaps[..2]
        .iter_mut()
        .for_each(|heap| heap.size = 1 << 30);
    // SAFETY: the caller's pointer.
    unsafe { *out = all };
}

unsafe extern "system" fn of_buffer(
    device: vk::Device,
    buffer: vk::Buffer,
    out: *mut vk::MemoryRequirements,
) {
    // SAFETY: the driver's own function, and the caller's pointer.
    unsafe {
        real::<vk::PFN_vkGetBufferMemoryRequirements>(0)(device, buffer, out);
        (*out).memory_type_bits = (1 << TYPES.len()) - 1;
    }
}

unsafe extern "system" fn of_image(
    device: vk::Device,
    image: vk::Image,
    out: *mut vk::MemoryRequirements,
) {
    // SAFETY: as above.
    unsafe {
        real::<vk::PFN_vkGetImageMemoryRequirements>(1)(device, image, out);
        (*out).memory_type_bits = (1 << TYPES.len()) - 1;
    }
}

unsafe extern "system" fn allocate(
    device: vk::Device,
    info: *const vk::MemoryAllocateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    out: *mut vk::DeviceMemory,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let mut info = *info;
        ALLOCATED[info.memory_type_index as usize].fetch_add(info.allocation_size, SeqCst);
        info.memory_type_index = TRUE_TYPE.load(SeqCst) as u32;
        real::<vk::PFN_vkAllocateMemory>(2)(device, &raw const info, callbacks, out)
    }
}

#[test]
fn each_use_gets_its_kind_of_memory_and_all_that_is_mapped_is_coherent() {
    let _alone = Layer::take();
    let host = open();
    // SAFETY: a plain query; each function below replaces the one of its name.
    let (instance, raw) = unsafe {
        let all = host
            .instance
            .get_physical_device_memory_properties(host.physical);
        let seen = Flags::HOST_VISIBLE | Flags::HOST_COHERENT;
        let found = all
            .memory_types
            .iter()
            .position(|t| t.property_flags.contains(seen));
        TRUE_TYPE.store(found.unwrap(), SeqCst);
        let entry = ash::Entry::load().unwrap();
        let get = entry.static_fn().get_instance_proc_addr;
        let handle = host.instance.handle();
        let instance = ash::Instance::load_with(
            |name| match name.to_bytes() {
                b"vkGetPhysicalDeviceMemoryProperties" => types as *const c_void,
                _ => get(handle, name.as_ptr()).map_or(0, |f| f as usize) as *const c_void,
            },
            handle,
        );
        let get = host.instance.fp_v1_0().get_device_proc_addr;
        let handle = host.device.handle();
        let raw = ash::Device::load_with(
            |name| {
                let real = get(handle, name.as_ptr()).map_or(0, |f| f as usize);
                let (n, planted) = match name.to_bytes() {
                    b"vkGetBufferMemoryRequirements" => (0, of_buffer as *const c_void),
                    b"vkGetImageMemoryRequirements" => (1, of_image as *const c_void),
                    b"vkAllocateMemory" => (2, allocate as *const c_void),
                    _ => return real as *const c_void,
                };
                REAL[n].store(real, SeqCst);
                planted
            },
            handle,
        );
        (instance, raw)
    };
    let planted = HostDevice {
        instance: &instance,
        device: &raw,
        ..lent(&host)
    };
    // SAFETY: the host's own handles; the device is dropped before the host.
    let device = unsafe { Device::borrow(&planted) }.unwrap();
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
