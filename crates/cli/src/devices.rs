//! `revmap devices`: the Vulkan devices, and the features of each that the program would use.

use super::output;
use clap::Args;
use revmap::gpu::{self, DeviceReport};
use serde_json::{Map, json};

/// Lists the Vulkan devices, their drivers, and what of each the program would use
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap devices\n  \
    revmap devices --json | jq '.[] | select(.preferred).name'\n  \
    revmap render assets/scenes/pawn.toml -o pawn.png --device 0\n  \
    REVMAP_DEVICE=llvmpipe revmap render assets/scenes/pawn.toml -o pawn.png")]
pub struct Devices {
    /// A JSON list on standard output in place of text
    #[arg(long)]
    json: bool,
}

impl Devices {
    pub fn run(self) -> revmap::Result<()> {
        let devices = gpu::devices()?;
        if self.json {
            output::json(&devices.iter().map(as_json).collect());
            return Ok(());
        }
        for device in devices {
            let mark = if device.preferred {
                ", taken unless --device names another"
            } else {
                ""
            };
            output::result(&format!(
                "{}: {} ({}), Vulkan {}, driver {}{mark}",
                device.index, device.name, device.kind, device.api_version, device.driver
            ));
            let widths = device.uses.iter().map(|(what, _)| what.len());
            let widest = widths.max().unwrap_or(0);
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

fn as_json(device: &DeviceReport) -> serde_json::Value {
    let uses = device
        .uses
        .iter()
        .map(|(what, which)| (what.clone(), json!(which)));
    json!({
        "index": device.index,
        "name": device.name,
        "kind": device.kind,
        "vulkan": device.api_version,
        "driver": device.driver,
        "preferred": device.preferred,
        "uses": uses.collect::<Map<_, _>>(),
        "missing": device.missing,
    })
}
