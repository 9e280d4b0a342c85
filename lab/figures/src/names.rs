//! Numbers and names of files, as results have them.

use std::collections::HashSet;

/// A number with `digits` significant digits, without trailing zeros; `inf` and `nan` as such.
pub fn number(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        // Minus zero, too.
        return format!("{}", value + 0.0).to_lowercase();
    }
    let magnitude = value.abs().log10().floor() as i32;
    let decimals = digits as i32 - 1 - magnitude;
    // Far from 1 the usual notation would be a row of zeros.
    if !(-4..=12).contains(&magnitude) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    if decimals <= 0 {
        return format!("{value:.0}");
    }
    let text = format!("{value:.*}", decimals as usize);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A name that may be part of a file's name.
pub fn safe(name: &str) -> String {
    let safe = |c: char| c.is_alphanumeric() || "-_@.".contains(c);
    name.replace(|c| !safe(c), "-")
}

/// Names of the files of a folder. No two are the same, also where upper and lower case are.
#[derive(Debug, Default)]
pub struct FileNames(HashSet<String>);

impl FileNames {
    /// The name of one more file: `name` where that is free, else with a number behind it.
    pub fn add(&mut self, name: &str) -> String {
        let name = safe(name);
        let numbered = (2..).map(|n| format!("{name}-{n}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        let free = names.find(|name| self.0.insert(name.to_lowercase()));
        free.unwrap_or(name)
    }
}

/// `0.97 to 1.07`.
pub fn range((low, high): (f64, f64)) -> String {
    format!("{} to {}", number(low, 3), number(high, 3))
}

/// `1 picture`, `4 pictures`.
pub fn count(number: usize, what: &str) -> String {
    match number {
        1 => format!("1 {what}"),
        number => format!("{number} {what}s"),
    }
}

/// Words in lines no longer than `limit`, as `length` has it; a longer word has a line of its own.
pub fn wrapped<'a>(
    words: impl IntoIterator<Item = &'a str>,
    limit: f64,
    length: impl Fn(&str) -> f64,
) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(line) if length(&format!("{line} {word}")) <= limit => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A share of pixels in percent.
pub fn percent(share: f64) -> String {
    format!("{} %", number(100.0 * share, 3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_files_have_one_name() {
        let mut names = FileNames::default();
        let added = ["v 1", "v-1", "V 1", "a/b", "v-1-2"].map(|name| names.add(name));
        assert_eq!(added, ["v-1", "v-1-2", "V-1-3", "a-b", "v-1-2-2"]);
    }

    #[test]
    fn numbers_keep_their_digits() {
        for (value, digits, text) in [
            (0.0, 4, "0"),
            (12.345_678, 4, "12.35"),
            (1234.6, 3, "1235"),
            (0.012_300, 5, "0.0123"),
            (100.0, 3, "100"),
            (0.000_001_234_5, 3, "1.23e-6"),
            (-2.5, 3, "-2.5"),
            (f64::INFINITY, 3, "inf"),
            (99.99, 3, "100"),
        ] {
            assert_eq!(number(value, digits), text);
        }
    }
}
