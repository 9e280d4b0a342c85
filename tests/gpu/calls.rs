//! A test layer between the renderer and Vulkan. It can make calls of a borrowed device fail, and
//! can report a poorer physical device than the real one. The renderer is unaware of it.

use crate::common::host::{Host, borrow_through};
use ash::vk;
use revmap::gpu::Device;
use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicI64, AtomicUsize, Ordering};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

#[path = "least_limits.rs"]
mod least_limits;
use least_limits::least_limits;

/// One machine word: a handle, a pointer or a number. Each wrapped function takes at most six.
/// Every 64-bit calling convention passes them in the same places whatever their type (on Windows
/// from the fifth on the stack, in order).
type Word = usize;
type Wrapped = unsafe extern "system" fn(Word, Word, Word, Word, Word, Word) -> vk::Result;

/// The calls that may fail.
const CALLS: [&CStr; 26] = [
    c"vkAllocateMemory",
    c"vkBindBufferMemory",
    c"vkBindImageMemory",
    c"vkMapMemory",
    c"vkCreateBuffer",
    c"vkCreateImage",
    c"vkCreateImageView",
    c"vkCreateSampler",
    c"vkCreateDescriptorSetLayout",
    c"vkCreateDescriptorPool",
    c"vkAllocateDescriptorSets",
    c"vkCreatePipelineLayout",
    c"vkCreatePipelineCache",
    c"vkCreateShaderModule",
    c"vkCreateGraphicsPipelines",
    c"vkCreateComputePipelines",
    c"vkCreateRenderPass",
    c"vkCreateFramebuffer",
    c"vkCreateCommandPool",
    c"vkAllocateCommandBuffers",
    c"vkBeginCommandBuffer",
    c"vkEndCommandBuffer",
    c"vkCreateFence",
    c"vkCreateQueryPool",
    c"vkQueueSubmit",
    c"vkWaitForFences",
];
/// Failures from this index on are not allocation failures.
const SUBMIT: usize = 24;
const WAIT: usize = 25;

/// The calls that destroy the objects made by [`CALLS`], one for each.
const ENDS: [&CStr; 15] = [
    c"vkFreeMemory",
    c"vkDestroyBuffer",
    c"vkDestroyImage",
    c"vkDestroyImageView",
    c"vkDestroySampler",
    c"vkDestroyDescriptorSetLayout",
    c"vkDestroyDescriptorPool",
    c"vkDestroyPipelineLayout",
    c"vkDestroyPipelineCache",
    c"vkDestroyShaderModule",
    c"vkDestroyPipeline",
    c"vkDestroyRenderPass",
    c"vkDestroyFramebuffer",
    c"vkDestroyCommandPool",
    c"vkDestroyFence",
];

static REAL: [AtomicUsize; CALLS.len()] = [const { AtomicUsize::new(0) }; CALLS.len()];
static REAL_ENDS: [AtomicUsize; ENDS.len()] = [const { AtomicUsize::new(0) }; ENDS.len()];
static MADE: AtomicUsize = AtomicUsize::new(0);
static FAILS_AT: AtomicUsize = AtomicUsize::new(usize::MAX);
static FAILED: AtomicUsize = AtomicUsize::new(usize::MAX);
static LOST: AtomicUsize = AtomicUsize::new(usize::MAX);
/// Waits for fences that are to end before the work does.
static EARLY: AtomicUsize = AtomicUsize::new(0);
static ALIVE: AtomicI64 = AtomicI64::new(0);
static ONE: Mutex<()> = Mutex::new(());

/// Returns true if a successful call `n` makes an object that one of [`ENDS`] destroys.
fn makes(n: usize) -> bool {
    let name = CALLS[n].to_str().unwrap();
    let alone = ["vkCreateQueryPool"].contains(&name);
    name == "vkAllocateMemory" || (name.starts_with("vkCreate") && !alone)
}

unsafe extern "system" fn call<const N: usize>(
    a: Word,
    b: Word,
    c: Word,
    d: Word,
    e: Word,
    f: Word,
) -> vk::Result {
    if N < SUBMIT && MADE.fetch_add(1, Ordering::SeqCst) == FAILS_AT.load(Ordering::SeqCst) {
        FAILED.store(N, Ordering::SeqCst);
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    }
    let early = |n: usize| n.checked_sub(1);
    if N == WAIT
        && EARLY
            .fetch_update(Ordering::SeqCst, Ordering::SeqCst, early)
            .is_ok()
    {
        return vk::Result::TIMEOUT;
    }
    let lost = LOST.load(Ordering::SeqCst) == N;
    if lost && N != WAIT {
        return vk::Result::ERROR_DEVICE_LOST;
    }
    // SAFETY: the pointer is the driver's for this call; words beyond its parameters are not read.
    let result = unsafe {
        let real: Wrapped = std::mem::transmute(REAL[N].load(Ordering::SeqCst));
        real(a, b, c, d, e, f)
    };
    if result == vk::Result::SUCCESS && makes(N) {
        ALIVE.fetch_add(1, Ordering::SeqCst);
    }
    if lost {
        // The work is complete, as after a true loss, and later submissions fail.
        LOST.store(SUBMIT, Ordering::SeqCst);
        return vk::Result::ERROR_DEVICE_LOST;
    }
    result
}

unsafe extern "system" fn end<const N: usize>(device: Word, handle: Word, callbacks: Word) {
    if handle != 0 {
        ALIVE.fetch_sub(1, Ordering::SeqCst);
    }
    type End = unsafe extern "system" fn(Word, Word, Word);
    // SAFETY: the pointer is the driver's for this call.
    unsafe {
        let real: End = std::mem::transmute(REAL_ENDS[N].load(Ordering::SeqCst));
        real(device, handle, callbacks);
    }
}

macro_rules! each {
    ($function:ident: $($n:literal)*) => { [$($function::<$n> as *const c_void),*] };
}

/// Exclusive use of this layer by one test. Dropping it ends all failures.
pub struct Layer {
    _one: MutexGuard<'static, ()>,
}

impl Drop for Layer {
    fn drop(&mut self) {
        self.fail_at(usize::MAX);
        self.lose(None);
        self.end_waits_early(0);
        *MASK.lock().unwrap() = Mask::default();
    }
}

impl Layer {
    pub fn take() -> Self {
        let one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        ALIVE.store(0, Ordering::SeqCst);
        Self { _one: one }
    }

    /// The device with this layer above it.
    pub fn device(&self, instance: &ash::Instance, device: &ash::Device) -> ash::Device {
        planted_device(instance, device, |name, real| self.plant(name, real))
    }

    /// This layer's function above `real`, if it has one of this name.
    pub fn plant(&self, name: &CStr, real: usize) -> Option<*const c_void> {
        let calls =
            each!(call: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25);
        let ends = each!(end: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14);
        if let Some(n) = CALLS.iter().position(|known| *known == name) {
            REAL[n].store(real, Ordering::SeqCst);
            return Some(calls[n]);
        }
        let n = ENDS.iter().position(|known| *known == name)?;
        REAL_ENDS[n].store(real, Ordering::SeqCst);
        Some(ends[n])
    }

    /// Makes the `n`-th call from now on fail, counting calls that allocate or create something.
    pub fn fail_at(&self, n: usize) {
        MADE.store(0, Ordering::SeqCst);
        FAILED.store(usize::MAX, Ordering::SeqCst);
        FAILS_AT.store(n, Ordering::SeqCst);
    }

    /// The number of such calls since then.
    pub fn made(&self) -> usize {
        MADE.load(Ordering::SeqCst)
    }

    /// The call that was made to fail.
    pub fn failed(&self) -> Option<&'static str> {
        let call = CALLS.get(FAILED.load(Ordering::SeqCst));
        call.map(|name| name.to_str().unwrap())
    }

    /// Loses the device from now on; the call `told_by` reports the loss.
    pub fn lose(&self, told_by: Option<&str>) {
        let told = |name: &&CStr| name.to_str().ok() == told_by;
        let n = CALLS.iter().position(told).unwrap_or(usize::MAX);
        LOST.store(n, Ordering::SeqCst);
    }

    /// Makes so many waits for fences return before the work is done.
    pub fn end_waits_early(&self, waits: usize) {
        EARLY.store(waits, Ordering::SeqCst);
    }

    /// The number of objects made and not destroyed, except query pools.
    pub fn alive(&self) -> i64 {
        ALIVE.load(Ordering::SeqCst)
    }

    /// The instance, with the query results of a poorer device.
    pub fn instance(
        &self,
        entry: &ash::Entry,
        instance: &ash::Instance,
        mask: Mask,
    ) -> ash::Instance {
        *MASK.lock().unwrap() = mask;
        planted_instance(entry, instance, queries)
    }

    /// The host's device, with less than it has.
    pub fn poorer(&self, host: &Host, change: impl FnOnce(&mut Mask)) -> revmap::Result<Device> {
        let mut mask = Mask::default();
        change(&mut mask);
        let instance = self.instance(&host.entry, &host.instance, mask);
        borrow_through(host, &instance, &host.device)
    }
}

/// A device whose functions `plant` may replace: it gets their names and the driver's own. Those in
/// their place have their parameters and results.
pub fn planted_device(
    instance: &ash::Instance,
    device: &ash::Device,
    plant: impl Fn(&CStr, usize) -> Option<*const c_void>,
) -> ash::Device {
    let (get, handle) = (instance.fp_v1_0().get_device_proc_addr, device.handle());
    // SAFETY: plain queries of a live device.
    let real = |name: &CStr| unsafe { get(handle, name.as_ptr()) }.map_or(0, |f| f as usize);
    let load = |name: &CStr| plant(name, real(name)).unwrap_or(real(name) as *const c_void);
    // SAFETY: the functions are the driver's, or like them.
    unsafe { ash::Device::load_with(load, handle) }
}

/// The same for an instance.
pub fn planted_instance(
    entry: &ash::Entry,
    instance: &ash::Instance,
    plant: impl Fn(&CStr, usize) -> Option<*const c_void>,
) -> ash::Instance {
    let (get, handle) = (entry.static_fn().get_instance_proc_addr, instance.handle());
    // SAFETY: as for devices.
    let real = |name: &CStr| unsafe { get(handle, name.as_ptr()) }.map_or(0, |f| f as usize);
    let load = |name: &CStr| plant(name, real(name)).unwrap_or(real(name) as *const c_void);
    // SAFETY: as for devices.
    unsafe { ash::Instance::load_with(load, handle) }
}

/// Changes of what a physical device reports.
#[derive(Clone, Copy, Default)]
pub struct Mask {
    /// The least limits of Vulkan 1.2, with a change.
    pub limits: Option<fn(&mut vk::PhysicalDeviceLimits)>,
    pub properties: Option<fn(&mut vk::PhysicalDeviceProperties)>,
    pub features: Option<fn(&mut vk::PhysicalDeviceFeatures)>,
    pub families: Option<fn(&mut vk::QueueFamilyProperties)>,
    /// True if a pixel has one sample at most.
    pub one_sample: bool,
    /// A format without any use.
    pub format: Option<vk::Format>,
    /// Another number of invocations in a subgroup; 0 keeps the device's own.
    pub subgroup: u32,
}

static MASK: LazyLock<Mutex<Mask>> = LazyLock::new(Mutex::default);

/// Functions above the driver's own. Each body has the driver's function; `$plant` puts all above
/// those of their names.
macro_rules! above {
    ($plant:ident; $($called:literal $name:ident: $driver:ident($($arg:ident: $of:ty),* $(,)?) $(-> $result:ty)?, |$real:ident| $body:block)*) => {
        $(
            mod $name {
                pub static REAL: std::sync::atomic::AtomicUsize = std::sync::atomic::AtomicUsize::new(0);
            }

            unsafe extern "system" fn $name($($arg: $of),*) $(-> $result)? {
                let kept = $name::REAL.load(std::sync::atomic::Ordering::SeqCst);
                // SAFETY: the driver's own function, and the caller's pointers.
                unsafe {
                    let $real = std::mem::transmute::<usize, vk::$driver>(kept);
                    $body
                }
            }
        )*

        /// The function above `real`, if there is one of this name.
        fn $plant(name: &std::ffi::CStr, real: usize) -> Option<*const std::ffi::c_void> {
            match name.to_str() {
                $(Ok($called) => {
                    $name::REAL.store(real, std::sync::atomic::Ordering::SeqCst);
                    Some($name as *const std::ffi::c_void)
                })*
                _ => None,
            }
        }
    };
}
#[allow(unused_imports)] // each crate of tests takes what it needs
pub(crate) use above;

/// The mask in force.
fn mask() -> Mask {
    *MASK.lock().unwrap()
}

above! { queries;
    "vkGetPhysicalDeviceProperties" properties: PFN_vkGetPhysicalDeviceProperties(
        physical: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceProperties
    ), |real| {
        real(physical, out);
        let (mask, out) = (mask(), &mut *out);
        if let Some(change) = mask.limits {
            out.limits = least_limits();
            change(&mut out.limits);
        }
        if mask.one_sample {
            out.limits.framebuffer_color_sample_counts = vk::SampleCountFlags::TYPE_1;
        }
        if let Some(change) = mask.properties {
            change(out);
        }
    }
    "vkGetPhysicalDeviceProperties2" properties2: PFN_vkGetPhysicalDeviceProperties2(
        physical: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceProperties2<'_>
    ), |real| {
        real(physical, out);
        let mask = mask();
        let mut next = (*out).p_next.cast::<vk::BaseOutStructure<'_>>();
        while let Some(one) = next.as_mut() {
            if mask.subgroup > 0 && one.s_type == vk::StructureType::PHYSICAL_DEVICE_SUBGROUP_PROPERTIES {
                let properties = next.cast::<vk::PhysicalDeviceSubgroupProperties<'_>>();
                (*properties).subgroup_size = mask.subgroup;
            }
            next = one.p_next;
        }
    }
    "vkGetPhysicalDeviceFeatures" features: PFN_vkGetPhysicalDeviceFeatures(
        physical: vk::PhysicalDevice, out: *mut vk::PhysicalDeviceFeatures
    ), |real| {
        real(physical, out);
        if let Some(change) = mask().features {
            change(&mut *out);
        }
    }
    "vkGetPhysicalDeviceQueueFamilyProperties" families: PFN_vkGetPhysicalDeviceQueueFamilyProperties(
        physical: vk::PhysicalDevice, count: *mut u32, out: *mut vk::QueueFamilyProperties
    ), |real| {
        real(physical, count, out);
        // `out` has room for `count`, or is null.
        if let Some(change) = mask().families && !out.is_null() {
            (0..*count as usize).for_each(|n| change(&mut *out.add(n)));
        }
    }
    "vkGetPhysicalDeviceFormatProperties" formats: PFN_vkGetPhysicalDeviceFormatProperties(
        physical: vk::PhysicalDevice, format: vk::Format, out: *mut vk::FormatProperties
    ), |real| {
        real(physical, format, out);
        if mask().format == Some(format) {
            *out = vk::FormatProperties::default();
        }
    }
    "vkGetPhysicalDeviceImageFormatProperties" image_formats: PFN_vkGetPhysicalDeviceImageFormatProperties(
        physical: vk::PhysicalDevice, format: vk::Format, kind: vk::ImageType, tiling: vk::ImageTiling,
        usage: vk::ImageUsageFlags, flags: vk::ImageCreateFlags, out: *mut vk::ImageFormatProperties
    ) -> vk::Result, |real| {
        let said = real(physical, format, kind, tiling, usage, flags, out);
        if mask().one_sample {
            (*out).sample_counts = vk::SampleCountFlags::TYPE_1;
        }
        said
    }
}
