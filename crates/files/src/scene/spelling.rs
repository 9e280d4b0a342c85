//! How to write a value that is refused. Each hint is tried first: none is refused in turn.

use super::SceneFile;
use super::keys::decimal_comma;
use super::overrides::{self, with_plain_numbers};
use revmap::error::Error;
use toml::{Table, Value};

/// A scene in which a key is tried, without its object.
const SCENE: &str = "camera = {eye = [3, 3, 2], target = [0, 0, 0.5]}\n[[light]]\n[[object]]\n";
/// Numbers beyond every range, as a number and as a whole number.
const BEYOND: [&str; 2] = ["inf", "4294967295"];

/// The failure to read `root` with the spelling of the refused text that is read.
pub(super) fn hinted(mut error: Error, root: &Table) -> Error {
    let key = error.key.clone().unwrap_or_default();
    // The place within a list is no key.
    let is_key = !key.ends_with(|c: char| c.is_ascii_digit());
    let spelled = value(root, &key).filter(|_| is_key).and_then(unquoted);
    if let Some(spelled) = spelled.and_then(|texts| taken(&key, texts)) {
        error.message += &format!("; {spelled}");
    }
    error
}

/// How to write the value of a line below `[table]` that TOML does not take.
pub(super) fn of_line(line: &str, table: &str) -> Option<String> {
    let (key, value) = parted(line, table)?;
    if value.contains('"') && value.contains('\\') {
        return Some("write / in paths, or single quotes about them".to_owned());
    }
    let mut texts = spellings(value);
    texts.retain(|text| text != value);
    taken(&key, texts)
}

/// The range of the key of a line with a number that is too large for TOML.
pub(super) fn range(line: &str, table: &str) -> Option<String> {
    let (key, value) = parted(line, table)?;
    if let Some(spelled) = of_line(line, table) {
        return Some(spelled);
    }
    let is_bracket = |c: char| "[], ".contains(c);
    let is_number = |word: &str| word.parse::<f64>().is_ok_and(f64::is_finite);
    let is_large = |word: &str| {
        let digits = word.trim_start_matches(['+', '-']);
        digits.starts_with(|c: char| c.is_ascii_digit())
            && !(is_number(word) && (word.contains(['.', 'e', 'E']) || word.parse::<i64>().is_ok()))
    };
    let remedy = |beyond: &str| {
        let parts = value.split_inclusive(is_bracket).map(|part| {
            let word = part.trim_end_matches(is_bracket);
            let end = &part[word.len()..];
            if is_large(word) { beyond } else { word }.to_owned() + end
        });
        let refusal = refusal(&key, &parts.collect::<String>())?;
        let (_, remedy) = refusal.message.split_once("; ")?;
        Some(remedy.to_owned())
    };
    BEYOND.into_iter().find_map(remedy)
}

/// The path of a line's key, and its value.
fn parted<'l>(line: &'l str, table: &str) -> Option<(String, &'l str)> {
    let (key, value) = line.split_once('=')?;
    let value = value.split('#').next().unwrap_or(value);
    let path = format!("{table}.{}", key.trim());
    Some((path.trim_start_matches('.').to_owned(), value.trim()))
}

/// What a text may be meant as.
fn spellings(text: &str) -> Vec<String> {
    let of_comma = decimal_comma(text);
    let of_comma = of_comma.as_deref().map(|all| all.split(" or ").collect());
    let of_comma: Vec<&str> = of_comma.unwrap_or_default();
    match of_comma.is_empty() {
        true => with_plain_numbers(text).into_iter().collect(),
        false => of_comma.into_iter().map(str::to_owned).collect(),
    }
}

/// A text, or a list with texts, as what it may be meant without quotes.
fn unquoted(value: &Value) -> Option<Vec<String>> {
    match value {
        Value::String(text) => Some(spellings(text)),
        Value::Array(items) if items.iter().any(Value::is_str) => {
            let item = |item: &Value| match item.as_str() {
                Some(text) => spellings(text).first().cloned(),
                None => Some(item.to_string()),
            };
            let items = items.iter().map(item).collect::<Option<Vec<_>>>()?;
            Some(vec![format!("[{}]", items.join(", "))])
        }
        _ => None,
    }
}

/// The value at a path such as `object.0.bevel`.
fn value<'t>(root: &'t Table, path: &str) -> Option<&'t Value> {
    let mut steps = path.split('.');
    let first = root.get(steps.next()?)?;
    steps.try_fold(first, |value, step| match value {
        Value::Array(items) => items.get(step.parse::<usize>().ok()?),
        other => other.get(step),
    })
}

/// The texts that the key takes.
fn taken(key: &str, mut texts: Vec<String>) -> Option<String> {
    let is_toml = |text: &str| format!("value = {text}").parse::<Table>().is_ok();
    texts.retain(|text| is_toml(text) && refusal(key, text).is_none());
    (!texts.is_empty()).then(|| format!("write {}", texts.join(" or ")))
}

/// The refusal of a value at a path such as `light.2.radius` or `light.radius`.
fn refusal(path: &str, text: &str) -> Option<Error> {
    let (first, name) = match path.rsplit_once('.') {
        Some((table, name)) => (table.split('.').next().unwrap_or(table), name),
        None => ("", path),
    };
    let key = match first {
        "" => name.to_owned(),
        "camera" => format!("camera.{name}"),
        list => format!("{list}.0.{name}"),
    };
    let object = match name.starts_with("profile_") {
        true => "profile = \".\"", // a folder is refused after the other keys
        false => "polygon = [[0, 0], [0.5, 0], [0, 1]]",
    };
    let mut file = SceneFile::parse(&format!("{SCENE}{object}"), "").ok()?;
    let root = overrides::applied(&file.root, &[format!("{key}={text}")]);
    let scene = root.and_then(|root| file.reader.scene(&root));
    let error = scene.and_then(|scene| scene.check()).err();
    error.filter(|e| e.key.as_ref() == Some(&key) && !e.message.starts_with("unknown key"))
}

#[cfg(test)]
mod tests;
