//! Wrong usage, reported in one line.

use super::output;
use clap::error::ErrorKind;
use std::process::ExitCode;

/// The exit code for invalid options or arguments.
const WRONG_USAGE: u8 = 2;

/// Prints help and version unchanged, and every fault as one line.
pub fn report(error: &clap::Error) -> ExitCode {
    if matches!(
        error.kind(),
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion
    ) {
        // A reader that closes the pipe early, such as `head`, causes no failure.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        output::complain("names no command; give render or another one that `revmap --help` lists");
    } else {
        output::complain(&one_line(&error.to_string()));
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
    fn a_fault_of_clap_is_one_line() {
        let text = "error: unexpected argument '--siez' found\n\n  tip: a similar argument exists: '--size'\n\n\
                    Usage: revmap render <SCENE>\n\nFor more information, try '--help'.\n";
        assert_eq!(
            one_line(text),
            "unexpected argument '--siez' found; a similar argument exists: '--size'; see `revmap render --help`"
        );
        let text = "error: the following required arguments were not provided:\n  --output <FILE>\n\nUsage: revmap bake [OPTIONS]\n";
        assert_eq!(
            one_line(text),
            "the following required arguments were not provided: --output <FILE>; see `revmap bake --help`"
        );
    }
}
