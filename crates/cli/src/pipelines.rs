//! Compiled pipelines kept between runs: one file per driver in the user's cache folder. Errors
//! with this file are not failures: pipelines are compiled again.

use revmap::error::Result;
use revmap::gpu::Device;
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
    let file = folder().map(|folder| folder.join(format!("{name}.pipelines")));
    let data = file.as_ref().and_then(|file| std::fs::read(file).ok());
    if let Some(data) = data.as_deref().and_then(whole) {
        // The driver ignores data that is not its own.
        let _ = device.add_pipeline_cache(data);
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
        let old = std::fs::read(file).ok();
        if old.as_deref().and_then(whole) == Some(&data) {
            return;
        }
        // Written beside the file, then renamed: one of two writers wins, and a reader never sees
        // half a file.
        let beside = file.with_extension(format!("{}", std::process::id()));
        let made = file.parent().map(std::fs::create_dir_all);
        let written = std::fs::write(&beside, [&sum(&data).to_le_bytes()[..], &data].concat());
        if made.is_some_and(|m| m.is_err())
            || written.is_err()
            || std::fs::rename(&beside, file).is_err()
        {
            let _ = std::fs::remove_file(&beside);
        }
    }
}

/// The data of a file whose checksum is right.
fn whole(bytes: &[u8]) -> Option<&[u8]> {
    let (head, data) = bytes.split_first_chunk::<8>()?;
    (u64::from_le_bytes(*head) == sum(data)).then_some(data)
}

/// FNV-1a.
fn sum(data: &[u8]) -> u64 {
    data.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn folder() -> Option<PathBuf> {
    let set = |name| std::env::var_os(name).filter(|v| !v.is_empty());
    let base = set("XDG_CACHE_HOME")
        .or_else(|| set("LOCALAPPDATA"))
        .map(PathBuf::from)
        .or_else(|| set("HOME").map(|home| PathBuf::from(home).join(".cache")))?;
    Some(base.join("revmap"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damaged_files_are_passed_over() {
        let data = b"pipelines".to_vec();
        let mut file = [&sum(&data).to_le_bytes()[..], &data].concat();
        assert_eq!(whole(&file), Some(&data[..]));
        file[10] ^= 1;
        assert_eq!(whole(&file), None);
        assert_eq!(whole(&file[..5]), None);
    }
}
