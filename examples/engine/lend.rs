//! The host's device, opened with what revmap needs and lent to it.

use super::host::{Fallible, Host};
use revmap::gpu::{Device, HostDevice, Requirements};

/// Opens a device that has what revmap requires.
pub fn open(validate: bool) -> Fallible<Host> {
    Host::open(validate, |instance, physical| {
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(instance, physical) }?;
        Ok((needs.queue_family, needs.features))
    })
}

/// Lends the device of a host.
///
/// # Safety
/// The host outlives the device.
pub unsafe fn lend(host: &Host) -> Fallible<Device> {
    // SAFETY: all handles are the host's own, opened with these features; the rest as promised.
    let device = unsafe {
        Device::borrow(&HostDevice {
            instance: &host.instance,
            physical: host.physical,
            device: &host.device,
            queue_family: host.family,
            queue: None,
            features: host.features,
            allocator: None,
            pipeline_cache: None,
        })
    };
    Ok(device?)
}
