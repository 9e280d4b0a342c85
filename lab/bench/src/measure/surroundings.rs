//! The surroundings of a run that change its times: variables that drivers read, allowed processors,
//! niceness, and the clock's governor.

use std::collections::BTreeMap;

/// Starts of the names of variables that Vulkan's loader and layers, Mesa's and other drivers read.
const PREFIXES: [&str; 25] = [
    "ANV_",
    "DRAW_",
    "DRI_",
    "ENABLE_",
    "GALLIUM_",
    "GALLIVM_",
    "INTEL_DEBUG",
    "LD_",
    "LIBGL",
    "LP_",
    "MALLOC_",
    "MANGOHUD",
    "MESA_",
    "NIR_",
    "NVK_",
    "RADEON_",
    "RADV_",
    "RAYON_NUM_THREADS",
    "REVMAP_SPECIALITIES",
    "ST_",
    "TU_",
    "VK_",
    "ZINK_",
    "__GL_",
    "__NV_",
];

/// The word for a variable in the note on the machine; each has a line of its own.
const VARIABLE: &str = "variable";
/// Says that no variable is set.
const NONE: &str = "none";

/// The other words, in the order of the note.
const WORDS: [&str; 5] = ["processors", "niceness", "scheduling", "governor", "boost"];
/// Names of the scheduling policies of Linux, by number.
const POLICIES: [&str; 7] = ["other", "fifo", "rr", "batch", "", "idle", "deadline"];

/// The surroundings of this process as lines of the note.
pub(crate) fn here() -> Vec<(&'static str, String)> {
    let read = |file: &str| std::fs::read_to_string(file).unwrap_or_default();
    let cpu = |file: &str| {
        let text = read(&format!("/sys/devices/system/cpu/{file}"));
        text.trim().to_owned()
    };
    let allowed = field(&read("/proc/self/status"), "Cpus_allowed_list");
    // Fields are counted from behind the program's name, which may hold blanks.
    let stat = read("/proc/self/stat");
    let fields = stat.rsplit(')').next().unwrap_or_default();
    let niceness = fields.split_whitespace().nth(16).unwrap_or_default();
    let policy = fields
        .split_whitespace()
        .nth(38)
        .and_then(|n| n.parse::<usize>().ok());
    let policy = policy.and_then(|n| POLICIES.get(n)).copied();
    let boost = match cpu("intel_pstate/no_turbo").as_str() {
        "1" => "0".to_owned(),
        "0" => "1".to_owned(),
        _ => cpu("cpufreq/boost"),
    };
    let values = [
        allowed.unwrap_or_default(),
        niceness.to_owned(),
        policy.unwrap_or_default().to_owned(),
        cpu("cpu0/cpufreq/scaling_governor"),
        boost,
    ];
    let mut lines: Vec<_> = WORDS.into_iter().zip(values).collect();
    let variables = variables(std::env::vars_os());
    lines.extend(variables.into_iter().map(|text| (VARIABLE, text)));
    lines
}

/// The variables among `all` that change times, as `NAME=VALUE`; a word for none.
fn variables(all: impl Iterator<Item = (std::ffi::OsString, std::ffi::OsString)>) -> Vec<String> {
    let home = std::env::var("HOME").unwrap_or_default();
    let text = |(name, value): (std::ffi::OsString, std::ffi::OsString)| {
        let name = name.to_string_lossy().into_owned();
        let counts = PREFIXES.iter().any(|prefix| name.starts_with(prefix));
        let mut value = value.to_string_lossy().replace(char::is_control, " ");
        // The note goes into public folders, and a home folder has a person's name.
        if home.len() > 1 {
            value = value.replace(&home, "~");
        }
        counts.then(|| format!("{name}={value}"))
    };
    let mut found: Vec<String> = all.filter_map(text).collect();
    found.sort();
    if found.is_empty() {
        found.push(NONE.to_owned());
    }
    found
}

/// The surroundings in a note; empty for a note of an earlier version.
pub(crate) fn of_note(note: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for (word, value) in note.lines().filter_map(|line| line.split_once(": ")) {
        if word == VARIABLE {
            let (name, value) = value.split_once('=').unwrap_or((VARIABLE, value));
            found.insert(name.to_owned(), value.to_owned());
        } else if WORDS.contains(&word) {
            found.insert(word.to_owned(), value.to_owned());
        }
    }
    found
}

/// A warning for each name that differs; none if a note is of an earlier version.
pub(crate) fn differences(
    old: &BTreeMap<String, String>,
    new: &BTreeMap<String, String>,
) -> Vec<String> {
    if old.is_empty() || new.is_empty() {
        return Vec::new();
    }
    let mut names: Vec<&String> = old.keys().chain(new.keys()).collect();
    names.sort();
    names.dedup();
    // This entry only says that there is no variable.
    names.retain(|name| *name != VARIABLE);
    // Notes of earlier versions lack this word.
    let both = |name: &str| old.contains_key(name) && new.contains_key(name);
    names.retain(|name| *name != "scheduling" || both(name));
    let value = |run: &BTreeMap<String, String>, name: &String| {
        run.get(name)
            .map_or("not set".to_owned(), |v| format!("{v:?}"))
    };
    let differs = |name: &&String| old.get(*name) != new.get(*name);
    let warning = |name: &String| {
        format!(
            "the runs differ in {name}: old {}, new {}; times depend on it",
            value(old, name),
            value(new, name)
        )
    };
    names.into_iter().filter(differs).map(warning).collect()
}

/// The value of the first line `key: value` of this key.
pub(crate) fn field(text: &str, key: &str) -> Option<String> {
    let mut fields = text.lines().filter_map(|line| line.split_once(':'));
    let found = fields.find(|(name, _)| name.trim() == key);
    found.map(|(_, value)| value.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_that_drivers_read_are_noted() {
        let all = [
            ("PATH", "/bin"),
            ("LD_LIBRARY_PATH", "/opt/mesa"),
            ("LP_NUM_THREADS", "1"),
            ("GALLIVM_PERF", "a\nb"),
        ];
        let all = all.map(|(name, value)| (name.into(), value.into()));
        let found = variables(all.into_iter());
        assert_eq!(
            found,
            [
                "GALLIVM_PERF=a b",
                "LD_LIBRARY_PATH=/opt/mesa",
                "LP_NUM_THREADS=1"
            ]
        );
        assert_eq!(variables([].into_iter()), [NONE]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_process_has_processors_and_a_niceness() {
        let lines = here();
        let value = |word| {
            lines
                .iter()
                .find(|(w, _)| *w == word)
                .map(|(_, v)| v.clone())
        };
        let niceness = value("niceness").and_then(|n| n.parse::<i32>().ok());
        assert!(
            niceness.is_some_and(|n| (-20..20).contains(&n)),
            "{lines:?}"
        );
        assert!(
            value("scheduling").is_some_and(|p| POLICIES.contains(&p.as_str())),
            "{lines:?}"
        );
        assert!(value("processors").is_some_and(|p| !p.is_empty()));
        assert!(value(VARIABLE).is_some());
    }

    #[test]
    fn differences_are_named() {
        let note = |more: &str| of_note(&format!("device: card\nniceness: 0\n{more}"));
        let plain = note("variable: none\n");
        let other = note("variable: LP_NUM_THREADS=1\n");
        assert_eq!(differences(&plain, &plain), [""; 0]);
        let found = differences(&plain, &other);
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("the runs differ in LP_NUM_THREADS: old not set, new \"1\""));
        let found = differences(&note("scheduling: other\n"), &note("scheduling: batch\n"));
        assert!(found[0].contains("differ in scheduling"), "{found:?}");
        // A run of an earlier version says nothing.
        assert_eq!(differences(&of_note("device: card\n"), &other), [""; 0]);
    }

    #[test]
    fn fields_of_the_systems_files() {
        let allowed = field("a : b\nCpus allowed\t: 0-1\n", "Cpus allowed");
        assert_eq!(allowed.as_deref(), Some("0-1"));
        assert_eq!(field("", "x"), None);
    }
}
