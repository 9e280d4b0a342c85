//! The note on the machine that stands beside every result.

/// Place and time of a measurement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// The Vulkan device's name.
    pub device: String,
    /// Its kind: discrete, integrated, virtual, cpu.
    pub kind: String,
    /// Driver and version.
    pub driver: String,
    /// The processor's name.
    pub processor: String,
    /// Threads that the program may use.
    pub threads: usize,
    /// Memory, GB; empty where the system does not tell.
    pub memory: String,
    /// The operating system.
    pub system: String,
    /// Date and time of the start, UTC.
    pub date: String,
    /// This program, its version and commit.
    pub program: String,
    /// The command that makes the results again.
    pub command: String,
}

impl Machine {
    /// This machine, now. `version` is that of the program which measures.
    pub fn here(device: &str, kind: &str, driver: &str, version: &str, command: &str) -> Self {
        let read = |file: &str| std::fs::read_to_string(file).unwrap_or_default();
        let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let memory = field(&read("/proc/meminfo"), "MemTotal", ':')
            .and_then(|v| v.trim_end_matches(" kB").parse::<f64>().ok())
            .map(|kb| format!("{:.0} GB", kb / 1_048_576.0))
            .unwrap_or_default();
        let system = field(&read("/etc/os-release"), "PRETTY_NAME", '=')
            .unwrap_or_else(|| std::env::consts::OS.to_owned());
        let processor = field(&read("/proc/cpuinfo"), "model name", ':')
            .unwrap_or_else(|| std::env::consts::ARCH.to_owned());
        Self {
            device: device.to_owned(),
            kind: kind.to_owned(),
            driver: driver.to_owned(),
            processor,
            threads,
            memory,
            system,
            date: jiff::Timestamp::now()
                .strftime("%Y-%m-%d %H:%M UTC")
                .to_string(),
            program: format!("revmap {version}"),
            command: command.to_owned(),
        }
    }

    /// The note as `(what, which)`.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![
            ("device", format!("{} ({})", self.device, self.kind)),
            ("driver", self.driver.clone()),
            (
                "processor",
                format!("{}, {} threads", self.processor, self.threads),
            ),
            ("memory", self.memory.clone()),
            ("system", self.system.clone()),
            ("date", self.date.clone()),
            ("program", self.program.clone()),
            ("command", self.command.clone()),
        ];
        lines.retain(|(_, which)| !which.is_empty());
        lines
    }

    /// A name for a folder of results, after day, device and the driver's version:
    /// `2026-01-31-lavapipe-22.3.6`.
    pub fn folder(&self) -> String {
        let words: String = self
            .device
            .to_lowercase()
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' })
            .collect();
        let name: Vec<&str> = words.split_whitespace().take(3).collect();
        let name = if words.starts_with("llvmpipe") {
            "lavapipe".to_owned()
        } else {
            name.join("-")
        };
        let number = |word: &&str| {
            word.contains('.') && word.chars().all(|c| c.is_ascii_digit() || c == '.')
        };
        let version = self.driver.split([' ', '-']).find(number);
        let version = version.map(|v| format!("-{v}")).unwrap_or_default();
        format!(
            "{}-{name}{version}",
            self.date.split(' ').next().unwrap_or("undated")
        )
    }
}

/// The value of the first line that starts with `key`.
pub(super) fn field(text: &str, key: &str, sign: char) -> Option<String> {
    text.lines()
        .filter_map(|line| line.split_once(sign))
        .find(|(name, _)| name.trim() == key)
        .map(|(_, value)| value.trim().trim_matches('"').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_named_after_day_and_device() {
        let mut here = Machine::here(
            "llvmpipe (LLVM 15.0.6, 256 bits)",
            "cpu",
            "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)",
            "0.1.0",
            "revmap bench",
        );
        assert!(
            here.date.ends_with(" UTC") && here.date.len() == 20,
            "{}",
            here.date
        );
        here.date = "2026-01-31 10:00 UTC".into();
        assert_eq!(here.folder(), "2026-01-31-lavapipe-22.3.6");
        here.driver = "NVIDIA".into();
        here.device = "NVIDIA GeForce RTX 4090".into();
        assert_eq!(here.folder(), "2026-01-31-nvidia-geforce-rtx");
        assert!(here.lines().iter().all(|(_, which)| !which.is_empty()) && here.threads > 0);
    }

    #[test]
    fn fields_of_the_systems_files() {
        assert_eq!(
            field("a : b\nmodel name\t: X 3\n", "model name", ':').as_deref(),
            Some("X 3")
        );
        assert_eq!(
            field("NAME=\"u\"\nPRETTY_NAME=\"Deb 12\"", "PRETTY_NAME", '=').as_deref(),
            Some("Deb 12")
        );
        assert_eq!(field("", "x", '='), None);
    }
}
