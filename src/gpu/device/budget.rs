//! The device memory in use, and its limit.

use crate::error::{Error, ErrorKind, Result};
use ash::vk::MemoryPropertyFlags as Flags;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Bytes that all buffers and images on a device take, by kind of heap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryUse {
    /// Device memory that the host cannot map: data that only the device touches.
    pub device: u64,
    /// Device memory that the host can map: data that changes every frame, if there is such memory.
    /// Integrated and software devices have no other.
    pub visible: u64,
    /// Host memory: data that is copied to the device once or read back. Data that changes every
    /// frame is also here if the host can map no device memory.
    pub host: u64,
}

impl MemoryUse {
    /// Bytes of all heaps.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.device + self.visible + self.host
    }
}

/// Bytes that buffers and images take, and the limit on them.
#[derive(Default)]
pub(crate) struct MemoryBudget {
    /// Bytes in use, including allocations in progress.
    used: AtomicU64,
    /// 0 allows as much as the device has.
    limit: AtomicU64,
    /// Bytes in use by heap, in the order of [`MemoryUse`].
    by_heap: [AtomicU64; 3],
}

impl MemoryBudget {
    pub fn set(&self, bytes: Option<u64>) {
        // A budget of zero is stored as one byte: nothing fits.
        self.limit.store(bytes.map_or(0, |b| b.max(1)), Relaxed);
    }

    pub fn memory_use(&self) -> MemoryUse {
        let [device, visible, host] = [0, 1, 2].map(|heap| self.by_heap[heap].load(Relaxed));
        MemoryUse {
            device,
            visible,
            host,
        }
    }

    /// Allocates this many bytes by `make`, if the budget has them. `make` returns the result and
    /// the flags of its memory.
    pub fn take<T>(
        &self,
        name: &str,
        bytes: u64,
        make: impl FnOnce() -> Result<(T, Flags)>,
    ) -> Result<T> {
        let used = self.used.fetch_add(bytes, Relaxed);
        let limit = self.limit.load(Relaxed);
        let made = if limit == 0 || used + bytes <= limit {
            make()
        } else {
            let mib = |bytes: u64| bytes as f64 / f64::from(1u32 << 20);
            let message = format!(
                "{name}: {:.2} MiB on top of {:.2} exceed the memory budget of {:.2} MiB; give more, or take a smaller picture, fewer objects or fewer map rows",
                mib(bytes),
                mib(used),
                mib(limit)
            );
            Err(Error::new(ErrorKind::OutOfDeviceMemory, message))
        };
        match made {
            Ok((made, flags)) => {
                self.by_heap[heap(flags)].fetch_add(bytes, Relaxed);
                Ok(made)
            }
            Err(error) => {
                self.used.fetch_sub(bytes, Relaxed);
                Err(error)
            }
        }
    }

    /// Returns bytes to the budget.
    pub fn give(&self, bytes: u64, flags: Flags) {
        self.used.fetch_sub(bytes, Relaxed);
        self.by_heap[heap(flags)].fetch_sub(bytes, Relaxed);
    }
}

/// The index of a kind of heap in [`MemoryUse`].
fn heap(flags: Flags) -> usize {
    if !flags.contains(Flags::DEVICE_LOCAL) {
        2
    } else {
        usize::from(flags.contains(Flags::HOST_VISIBLE))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_taken_counts_in_its_heap_until_it_is_given_back() {
        let (budget, seen) = (MemoryBudget::default(), Flags::HOST_VISIBLE);
        let kinds = [
            Flags::DEVICE_LOCAL,
            Flags::DEVICE_LOCAL | seen,
            seen | Flags::HOST_COHERENT,
        ];
        let all = MemoryUse {
            device: 1,
            visible: 2,
            host: 3,
        };
        for (bytes, flags) in (1..).zip(kinds) {
            budget.take("a", bytes, || Ok(((), flags))).unwrap();
        }
        assert_eq!((budget.memory_use(), all.total()), (all, 6));
        budget.set(Some(7));
        let full = budget.take("a", 2, || Ok(((), seen))).unwrap_err();
        assert_eq!(full.kind, ErrorKind::OutOfDeviceMemory);
        // A failed allocation is not counted, either.
        let failed = || Err::<((), Flags), _>(Error::new(ErrorKind::DeviceLost, "planted"));
        budget.take("a", 1, failed).unwrap_err();
        assert_eq!(budget.memory_use(), all);
        for (bytes, flags) in (1..).zip(kinds) {
            budget.give(bytes, flags);
        }
        assert_eq!(budget.memory_use(), MemoryUse::default());
        budget.take("a", 7, || Ok(((), seen))).unwrap();
    }
}
