//! Compiled pipelines kept between runs: one file per driver in the user's cache folder. Errors
//! with this file are not failures: pipelines are compiled again.

use revmap::error::Result;
use revmap::gpu::Device;
use revmap_searches::cache;
use std::path::PathBuf;

/// The file of a device's pipelines.
pub struct Kept {
    file: Option<PathBuf>,
}

/// Opens a device, with the pipelines of earlier runs.
pub fn open(choice: Option<&str>) -> Result<(Device, Kept)> {
    let device = Device::open(choice)?;
    let report = device.report();
    let name: String = format!("{} {}", report.name, report.driver)
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    let file = cache::folder().map(|folder| folder.join(format!("{name}.pipelines")));
    if let Some(data) = file.as_deref().and_then(cache::read) {
        // The driver ignores data that is not its own.
        let _ = device.add_pipeline_cache(&data);
    }
    Ok((device, Kept { file }))
}

impl Kept {
    /// Stores the compiled pipelines, if there are any.
    pub fn save(&self, device: &Device) {
        let Some(file) = self
            .file
            .as_ref()
            .filter(|_| device.pipelines_compiled() > 0)
        else {
            return;
        };
        let Ok(data) = device.pipeline_cache_data() else {
            return;
        };
        if cache::read(file).as_deref() != Some(&data) {
            cache::write(file, &data);
        }
    }
}
