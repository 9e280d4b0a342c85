//! The device memory in use, and its limit.

use crate::error::{Error, ErrorKind, Result};
use ash::vk::MemoryPropertyFlags as Flags;

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

    /// The bytes of the heap with these flags.
    pub(in crate::gpu) fn heap(&mut self, flags: Flags) -> &mut u64 {
        if !flags.contains(Flags::DEVICE_LOCAL) {
            &mut self.host
        } else if flags.contains(Flags::HOST_VISIBLE) {
            &mut self.visible
        } else {
            &mut self.device
        }
    }
}

#[derive(Default)]
pub(crate) struct MemoryBudget {
    pub used: MemoryUse,
    /// `None` allows as much as the device has.
    pub limit: Option<u64>,
}

impl MemoryBudget {
    /// Allocates this many bytes by `make`, if the budget has them. `make` returns the result and
    /// the flags of its memory.
    pub fn take<T>(
        &mut self,
        name: &str,
        bytes: u64,
        make: impl FnOnce() -> Result<(T, Flags)>,
    ) -> Result<T> {
        let used = self.used.total();
        if let Some(limit) = self.limit.filter(|limit| used + bytes > *limit) {
            let [bytes, used, limit] =
                [bytes, used, limit].map(|bytes| bytes as f64 / f64::from(1u32 << 20));
            let message = format!(
                "{name}: {bytes:.2} MiB on top of {used:.2} exceed the memory budget of {limit:.2} MiB; give more, or take a smaller picture, fewer objects or fewer map rows"
            );
            return Err(Error::new(ErrorKind::OutOfDeviceMemory, message));
        }
        let (made, flags) = make()?;
        *self.used.heap(flags) += bytes;
        Ok(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_counts_in_its_heap() {
        let (mut budget, seen) = (MemoryBudget::default(), Flags::HOST_VISIBLE);
        let kinds = [
            Flags::DEVICE_LOCAL,
            Flags::DEVICE_LOCAL | seen,
            seen | Flags::HOST_COHERENT,
        ];
        for (bytes, flags) in (1..).zip(kinds) {
            budget.take("a", bytes, || Ok(((), flags))).unwrap();
        }
        let all = MemoryUse {
            device: 1,
            visible: 2,
            host: 3,
        };
        assert_eq!((budget.used, all.total()), (all, 6));
        budget.limit = Some(7);
        let full = budget.take("a", 2, || Ok(((), seen))).unwrap_err();
        assert_eq!(full.kind, ErrorKind::OutOfDeviceMemory);
        // A failed allocation is not counted, either.
        let failed = || Err::<((), Flags), _>(Error::new(ErrorKind::DeviceLost, "planted"));
        budget.take("a", 1, failed).unwrap_err();
        assert_eq!(budget.used, all);
        budget.take("a", 1, || Ok(((), seen))).unwrap();
    }
}
