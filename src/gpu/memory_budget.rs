//! How much of the device's memory may be taken.

use crate::error::{Error, Result, Stage};
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes that buffers and images take, and the most that they may.
#[derive(Default)]
pub(crate) struct MemoryBudget {
    used: AtomicU64,
    /// 0: as much as the device has.
    limit: AtomicU64,
}

impl MemoryBudget {
    pub fn set(&self, bytes: Option<u64>) {
        // A budget of nothing is one byte: nothing fits.
        let limit = bytes.map_or(0, |b| b.max(1));
        self.limit.store(limit, Ordering::Relaxed);
    }

    pub fn used(&self) -> u64 {
        self.used.load(Ordering::Relaxed)
    }

    /// Takes so many bytes, if the budget has them.
    pub fn take(&self, name: &str, bytes: u64) -> Result<()> {
        let used = self.used.fetch_add(bytes, Ordering::Relaxed);
        let limit = self.limit.load(Ordering::Relaxed);
        if limit == 0 || used + bytes <= limit {
            return Ok(());
        }
        self.give(bytes);
        let mib = |bytes: u64| bytes as f64 / f64::from(1u32 << 20);
        let message = format!(
            "{name}: {:.2} MiB on top of {:.2} exceed the memory budget of {:.2} MiB; give more, or take a smaller picture, fewer objects or fewer map rows",
            mib(bytes),
            mib(used),
            mib(limit)
        );
        Err(Error::new(Stage::Draw, message))
    }

    /// Gives back what was taken.
    pub fn give(&self, bytes: u64) {
        self.used.fetch_sub(bytes, Ordering::Relaxed);
    }
}
