//! `revmap devices`: the Vulkan devices and what the program would use of each.

use super::output;
use clap::Args;
use revmap::gpu;

/// Lists the Vulkan devices, their drivers, and what of each the program would use
#[derive(Args)]
pub struct Devices {}

impl Devices {
    pub fn run(self) -> revmap::Result<()> {
        for device in gpu::devices()? {
            output::result(&format!(
                "{}: {} ({}), Vulkan {}, driver {}",
                device.index, device.name, device.kind, device.api_version, device.driver
            ));
            let widest = device
                .uses
                .iter()
                .map(|(what, _)| what.len())
                .max()
                .unwrap_or(0);
            for (what, which) in &device.uses {
                output::result(&format!("   {what:widest$}  {which}"));
            }
            for lack in &device.missing {
                output::result(&format!("   missing: {lack}"));
            }
        }
        Ok(())
    }
}
