//! The surroundings of a run that change its times: variables that drivers read, allowed processors,
//! niceness, and the clock's governor.

use crate::measure::drawn::changes;
use std::collections::BTreeMap;

/// Starts of the names of variables that Vulkan's loader and layers, Mesa's and other drivers read.
const PREFIXES: &str = "ANV_ DRAW_ DRI_ ENABLE_ GALLIUM_ GALLIVM_ INTEL_DEBUG LD_ LIBGL LP_ MALLOC_ MANGOHUD MESA_ NIR_ \
    NVK_ RADEON_ RADV_ RAYON_NUM_THREADS REVMAP_SPECIALITIES ST_ TU_ VK_ ZINK_ __GL_ __NV_";

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
    let field_of = |n| {
        fields
            .split_whitespace()
            .nth(n)
            .unwrap_or_default()
            .to_owned()
    };
    let policy = field_of(38).parse::<usize>().ok();
    let policy = policy.and_then(|n| POLICIES.get(n)).copied();
    let boost = match cpu("intel_pstate/no_turbo").as_str() {
        "1" => "0".to_owned(),
        "0" => "1".to_owned(),
        _ => cpu("cpufreq/boost"),
    };
    let values = [
        allowed.unwrap_or_default(),
        field_of(16),
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
        let counts = PREFIXES.split(' ').any(|prefix| name.starts_with(prefix));
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
            found.insert(name.to_owned(), format!("{value:?}"));
        } else if WORDS.contains(&word) {
            found.insert(word.to_owned(), format!("{value:?}"));
        }
    }
    found
}

/// What differs, as [`changes`] has it; nothing if a note is of an earlier version.
pub(crate) fn differences(
    old: &BTreeMap<String, String>,
    new: &BTreeMap<String, String>,
) -> Vec<String> {
    if old.is_empty() || new.is_empty() {
        return Vec::new();
    }
    let both = |name: &str| old.contains_key(name) && new.contains_key(name);
    // The first only says that there is no variable; notes of earlier versions lack the second.
    let counts = |name: &str| name != VARIABLE && (name != "scheduling" || both(name));
    let of = |run: &BTreeMap<String, String>| {
        let all = run.clone().into_iter();
        all.filter(|(name, _)| counts(name)).collect()
    };
    changes(&of(old), &of(new))
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
        let found = variables(all.into_iter()).join(" ");
        let wanted = "GALLIVM_PERF=a b LD_LIBRARY_PATH=/opt/mesa LP_NUM_THREADS=1";
        assert_eq!(found, wanted);
        assert_eq!(variables([].into_iter()), [NONE]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_process_has_processors_and_a_niceness() {
        let lines = here();
        let is = |word: &str, right: &dyn Fn(&str) -> bool| {
            let right = lines.iter().any(|(w, value)| *w == word && right(value));
            assert!(right, "{word}: {lines:?}");
        };
        let nice = |n: i32| (-20..20).contains(&n);
        is("niceness", &|n| n.parse().is_ok_and(nice));
        is("scheduling", &|p| POLICIES.contains(&p));
        is("processors", &|p| !p.is_empty());
        is(VARIABLE, &|_| true);
    }

    #[test]
    fn differences_are_named() {
        let note = |more: &str| of_note(&format!("device: card\nniceness: 0\n{more}"));
        let plain = note("variable: none\n");
        let other = note("variable: LP_NUM_THREADS=1\n");
        assert_eq!(differences(&plain, &plain), [""; 0]);
        let found = differences(&plain, &other);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0], "LP_NUM_THREADS (old not set, new \"1\")");
        let found = differences(&note("scheduling: other\n"), &note("scheduling: batch\n"));
        assert!(found[0].starts_with("scheduling"), "{found:?}");
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
