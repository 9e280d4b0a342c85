//! Buffers and images with their memory.

pub(crate) mod buffers;
pub(crate) mod images;

use crate::error::{Result, lock};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::allocation_error;
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

pub use buffers::Buffer;
pub use images::{Image, ImageKind};

fn allocate(
    device: &Shared,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
    linear: bool,
) -> Result<Allocation> {
    let bytes = requirements.size;
    // The lock is held so that allocations on other threads count.
    lock(&device.budget)?.take(name, bytes, || {
        let made = lock(&device.allocator)?.allocate(&AllocationCreateDesc {
            name,
            requirements,
            location,
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        let made = made.map_err(|e| allocation_error(name, bytes, &e))?;
        let flags = made.memory_properties();
        Ok((made, flags))
    })
}

/// Moves an allocation to its owner, which frees it, before anything else can fail.
fn bound(owner: &mut Option<Allocation>, allocation: Allocation) -> (vk::DeviceMemory, u64) {
    // SAFETY: the handle is used only to bind the resource that owns the allocation.
    let binding = (unsafe { allocation.memory() }, allocation.offset());
    *owner = Some(allocation);
    binding
}

fn free(device: &Shared, allocation: Option<Allocation>) {
    let Some(allocation) = allocation else {
        return;
    };
    if let Ok(mut budget) = device.budget.lock() {
        *budget.used.heap(allocation.memory_properties()) -= allocation.size();
    }
    if let Ok(mut allocator) = device.allocator.lock() {
        // An error here can only be reported, and no caller is left to receive it.
        let _ = allocator.free(allocation);
    }
}
