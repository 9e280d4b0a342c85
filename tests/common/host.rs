//! The host of `examples/engine` for tests, opened with the validation layers and lent to the
//! library.
#![allow(unsafe_code, missing_docs, clippy::unwrap_used)]

#[path = "../../examples/engine/host/mod.rs"]
#[allow(dead_code, unused_imports)]
mod engine;

#[allow(unused_imports)] // each crate of tests takes what it needs
pub use engine::*;
use revmap::gpu::{HostDevice, Requirements};

/// A host with everything that the library requires.
pub fn open() -> Host {
    Host::open(true, |instance, physical| {
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(instance, physical) }?;
        Ok((needs.queue_family, needs.features))
    })
    .unwrap()
}

/// The host's device and queue, to be borrowed.
pub fn lent(host: &Host) -> HostDevice<'_> {
    HostDevice {
        instance: &host.instance,
        physical: host.physical,
        device: &host.device,
        queue_family: host.family,
        queue: Some(host.queue),
        features: host.features,
        allocator: None,
        pipeline_cache: None,
    }
}
