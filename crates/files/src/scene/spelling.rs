//! How to write a value that is refused.

use super::overrides::with_plain_numbers;
use toml::{Table, Value};

/// How to write a text, or a list with texts, that is meant as a value which `is_taken`: words that
/// follow a refusal.
pub(super) fn unquoted(value: &Value, is_taken: impl Fn(&Value) -> bool) -> String {
    let texts = match value {
        Value::String(text) => spellings(text),
        Value::Array(items) => {
            let item = |item: &Value| match item.as_str() {
                Some(text) => spellings(text).into_iter().next(),
                None => Some(item.to_string()),
            };
            let items: Option<Vec<String>> = items.iter().map(item).collect();
            let list = items.map(|items| format!("[{}]", items.join(", ")));
            list.into_iter().collect()
        }
        _ => Vec::new(),
    };
    proposed(texts, is_taken).map_or(String::new(), |remedy| format!("; {remedy}"))
}

/// How to write the value of a line that TOML does not take.
pub(super) fn of_line(line: &str) -> Option<String> {
    let (_, value) = line.split_once('=')?;
    let value = value.split('#').next().unwrap_or(value).trim();
    if value.contains('"') && value.contains('\\') {
        return Some("write / in paths, or single quotes about them".to_owned());
    }
    let mut texts = spellings(value);
    texts.retain(|text| text != value);
    proposed(texts, |_| true)
}

/// A number that is written with a decimal comma, with a point in its place; `None` for other text.
///
/// ```
/// use revmap_files::scene::decimal_comma;
/// assert_eq!(decimal_comma("0,05").as_deref(), Some("0.05"));
/// assert_eq!(decimal_comma("1,2,3"), None);
/// assert_eq!(decimal_comma("1,000").as_deref(), Some("1.0 or 1000"));
/// ```
#[must_use]
pub fn decimal_comma(text: &str) -> Option<String> {
    let (whole, part) = text.split_once(',')?;
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let unsigned = whole.strip_prefix(['+', '-']).unwrap_or(whole);
    let is_number = digits(part) && (unsigned.is_empty() || digits(unsigned));
    let point = format!("{whole}.{part}").parse::<f64>().ok();
    let point = point.filter(|_| is_number)?;
    // A comma may stand between thousands, too.
    let thousands =
        part.len() == 3 && (1..=3).contains(&unsigned.len()) && !unsigned.starts_with('0');
    Some(match thousands {
        true => format!("{point:?} or {whole}{part}"),
        false => format!("{point}"),
    })
}

/// What a text may be meant as.
fn spellings(text: &str) -> Vec<String> {
    match decimal_comma(text) {
        Some(all) => all.split(" or ").map(str::to_owned).collect(),
        None => with_plain_numbers(text).into_iter().collect(),
    }
}

/// The texts that are TOML of a value which `is_taken`. Numbers that overflow are none of them.
fn proposed(mut texts: Vec<String>, is_taken: impl Fn(&Value) -> bool) -> Option<String> {
    texts.retain(|text| {
        let table = format!("value = {text}").parse::<Table>();
        table.is_ok_and(|table| !text.contains("inf") && is_taken(&table["value"]))
    });
    (!texts.is_empty()).then(|| format!("write {}", texts.join(" or ")))
}

#[cfg(test)]
mod tests;
