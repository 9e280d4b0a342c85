//! The note on the machine that stands beside every result.

use crate::measure::surroundings;
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

/// Place and time of a measurement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// The Vulkan device's name.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Date and time of the start, UTC.
    pub date: String,
    /// The note as `(what, which)`, without what the system does not tell.
    pub lines: Vec<(&'static str, String)>,
}

impl Machine {
    /// This machine, now. `kind` is the device's: discrete, integrated, virtual, cpu. `version` is
    /// that of the program which measures, `command` the one that makes the results again.
    pub fn here(device: &str, kind: &str, driver: &str, version: &str, command: &str) -> Self {
        let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let (processor, memory) = hardware();
        let system = System::long_os_version().unwrap_or_else(|_| std::env::consts::OS.to_owned());
        let date = jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M UTC");
        let date = date.to_string();
        let mut lines = vec![
            ("device", format!("{device} ({kind})")),
            ("driver", driver.to_owned()),
            ("processor", format!("{processor}, {threads} threads")),
            ("memory", memory.unwrap_or_default()),
            ("system", system),
            ("date", date.clone()),
            ("program", format!("revmap {version}")),
            ("command", command.to_owned()),
        ];
        lines.extend(surroundings::here());
        let others = revmap_searches::folder::all().into_iter();
        lines.extend(others.map(|f| ("search", format!("{}: {}", f.name(), f.origin()))));
        lines.retain(|(_, which)| !which.is_empty());
        Self {
            device: device.to_owned(),
            driver: driver.to_owned(),
            date,
            lines,
        }
    }

    /// A folder's name after day, device and the driver's version: `2026-01-31-lavapipe-22.3.6`.
    pub fn folder(&self) -> String {
        let day = self.date.split(' ').next().unwrap_or("undated");
        let name = label(&self.device, &self.driver).replace(' ', "-");
        format!("{day}-{name}")
    }
}

/// The processor's name, or its architecture where the system does not tell; and the memory's size.
fn hardware() -> (String, Option<String>) {
    let wanted = RefreshKind::nothing()
        .with_cpu(CpuRefreshKind::nothing())
        .with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(wanted).ok();
    let brand = system.as_ref().and_then(|s| s.cpus().first());
    let brand = brand.map_or("", |cpu| cpu.brand().trim());
    let processor = match brand {
        "" => std::env::consts::ARCH,
        brand => brand,
    };
    let bytes = system.as_ref().map(|s| s.total_memory());
    let bytes = bytes.filter(|bytes| *bytes > 0);
    let memory = bytes.map(|bytes| format!("{:.0} GB", bytes as f64 / f64::from(1 << 30)));
    (processor.to_owned(), memory)
}

/// A short name of a device and its driver's version: `lavapipe 22.3.6`.
pub fn label(device: &str, driver: &str) -> String {
    let device = device.to_lowercase();
    let words = device.split(|c: char| !c.is_ascii_alphanumeric());
    let name: Vec<&str> = words.filter(|w| !w.is_empty()).take(3).collect();
    let name = match device.starts_with("llvmpipe") {
        true => "lavapipe".to_owned(),
        false => name.join(" "),
    };
    let digit = |c: char| c.is_ascii_digit() || c == '.';
    let number = |word: &&str| word.contains('.') && word.chars().all(digit);
    let version = driver.split([' ', '-']).find(number);
    version.map_or(name.clone(), |v| format!("{name} {v}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_named_after_day_and_device() {
        let device = "llvmpipe (LLVM 15.0.6, 256 bits)";
        let driver = "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)";
        let mut here = Machine::here(device, "cpu", driver, "0.1.0", "revmap bench");
        let date = &here.date;
        assert!(date.ends_with(" UTC") && date.len() == 20, "{date}");
        here.date = "2026-01-31 10:00 UTC".into();
        assert_eq!(here.folder(), "2026-01-31-lavapipe-22.3.6");
        here.driver = "NVIDIA".into();
        here.device = "NVIDIA GeForce RTX 4090".into();
        assert_eq!(here.folder(), "2026-01-31-nvidia-geforce-rtx");
        assert!(here.lines.iter().all(|(_, which)| !which.is_empty()));
    }
}
