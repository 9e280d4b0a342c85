//! Failures of the library as the program prints them: with its own options in place of keys and
//! methods, and with an exit code.

use super::output;
use super::progress::ended_by_signal;
use revmap::error::{Error, ErrorKind};
use revmap::gpu::DEVICE_VARIABLE;
use std::process::ExitCode;

/// Keys of the library that options set. The option of `sets` is `--set`.
const KEYS: [&str; 12] = [
    "device",
    "out",
    "profile_axis",
    "profile_invert",
    "profile_min_stroke",
    "profile_read",
    "profile_smooth",
    "profile_threshold",
    "sets",
    "size",
    "solver",
    "tolerance",
];

/// Prints the failure in one line, and returns the exit code: that of a signal which ended the run,
/// else that of the failure.
pub fn report(error: Error) -> ExitCode {
    let code = ended_by_signal().unwrap_or_else(|| exit_code(error.kind));
    output::complain(&text(error));
    ExitCode::from(code)
}

/// Exit codes: 2 wrong usage, 3 no usable device, 1 all others.
fn exit_code(kind: ErrorKind) -> u8 {
    match kind {
        ErrorKind::Usage => 2,
        ErrorKind::Unsupported => 3,
        _ => 1,
    }
}

fn text(mut error: Error) -> String {
    let kind = error.kind;
    // A scene's key that has the name of an option.
    let of_file = kind == ErrorKind::Content && error.file.is_some();
    let meant = error.key.as_deref().and_then(option).filter(|_| of_file);
    if let Some(option) = &meant {
        error.message += &format!("; it is the option {option} of the command line");
    }
    error.key = error.key.map(|key| match option(&key) {
        Some(option) if meant.is_none() => option,
        // A key of the scene that was set on the command line.
        None if kind == ErrorKind::Usage && !key.starts_with('-') && key != DEVICE_VARIABLE => {
            format!("--set {key}")
        }
        _ => key,
    });
    let named = error.key.as_ref().is_some_and(|key| key.starts_with('-'));
    format!("{error}{}", if named { "" } else { remedy(kind) })
}

/// The option that sets a key.
fn option(key: &str) -> Option<String> {
    let name = if key == "sets" { "set" } else { key };
    KEYS.contains(&key)
        .then(|| format!("--{}", name.replace('_', "-")))
}

/// A message about a profile with options in place of the keys of a scene file.
pub fn with_options(message: &str) -> String {
    let mut text = message.replace("profile_invert = true", "profile_invert");
    for key in KEYS.iter().filter(|key| key.starts_with("profile_")) {
        let option = option(key).unwrap_or_default();
        text = text.replace(&format!("{key} = "), &format!("{option} "));
        text = text.replace(key, &option);
    }
    text
}

/// The options that help with a kind of failure, if any.
fn remedy(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::DeviceLost => "; see --size, --max-steps",
        ErrorKind::OutOfDeviceMemory => "; see --size, --map-rows, --memory-budget",
        ErrorKind::TooLarge => "; see --size, --map-rows",
        _ => "",
    }
}

/// The exit code for invalid options or arguments.
const WRONG_USAGE: u8 = 2;

/// Prints help and version unchanged, and every fault as one line.
pub fn wrong_usage(error: &clap::Error) -> ExitCode {
    if matches!(
        error.kind(),
        clap::error::ErrorKind::DisplayHelp | clap::error::ErrorKind::DisplayVersion
    ) {
        output::keep_fault(error.print());
        return output::end();
    }
    if error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        output::complain("names no command; give render or another one that `revmap --help` lists");
    } else {
        let mut line = one_line(&error.to_string());
        let value = error.get(clap::error::ContextKind::InvalidValue);
        if let Some(clap::error::ContextValue::String(value)) = value
            && !line.contains("write it as")
            && let Some(point) = revmap_files::scene::decimal_comma(value)
        {
            // Whole numbers have no point.
            line += &match line.contains("invalid digit") {
                true => "; write a whole number".to_owned(),
                false => format!("; write {point}"),
            };
        }
        output::complain(&line);
    }
    ExitCode::from(WRONG_USAGE)
}

/// Clap's message without its usage and its line breaks.
fn one_line(message: &str) -> String {
    let body = message.split("\nUsage:").next().unwrap_or(message);
    let body = body.split("\nFor more information").next().unwrap_or(body);
    let parts = body.lines().map(str::trim).filter(|l| !l.is_empty());
    let line = parts.collect::<Vec<_>>().join(" ");
    let line = line.replace("error: ", "").replace(" tip: ", "; ");
    let usage = message.split("\nUsage: ").nth(1).unwrap_or("revmap");
    let command: Vec<&str> = usage
        .split_whitespace()
        .take_while(|word| word.starts_with(|c: char| c.is_ascii_lowercase()))
        .collect();
    format!("{line}; see `{} --help`", command.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_become_options_and_kinds_exit_codes() {
        const BEVEL: &str = "object.2.bevel";
        for (kind, key, code, wanted) in [
            (ErrorKind::Unsupported, "device", 3, "--device: no"),
            (ErrorKind::Usage, "sets", 2, "--set: no"),
            (ErrorKind::Usage, BEVEL, 2, "--set object.2.bevel: no"),
            (ErrorKind::Usage, "--stage", 2, "--stage: no"),
            (ErrorKind::Content, BEVEL, 1, "object.2.bevel: no"),
            (ErrorKind::TooLarge, "size", 1, "--size: no"),
        ] {
            assert_eq!(exit_code(kind), code);
            assert_eq!(text(Error::new(kind, "no").at_key(key)), wanted);
        }
        let of_file = Error::new(ErrorKind::Content, "unknown key").at_key("size");
        let wanted = "a: size: unknown key; it is the option --size of the command line";
        assert_eq!(text(of_file.in_file("a")), wanted);
        let lost = text(Error::new(ErrorKind::DeviceLost, "lost"));
        assert_eq!(lost, "lost; see --size, --max-steps");
    }

    #[test]
    fn keys_of_scenes_become_options() {
        let text = with_options(
            "set profile_axis = 0.1 and profile_invert = true, or profile_smooth; profile_min_stroke = 0.003",
        );
        assert_eq!(
            text,
            "set --profile-axis 0.1 and --profile-invert, or --profile-smooth; --profile-min-stroke 0.003"
        );
    }
}
