//! `key=value`: values put into a scene's tables before they are read.

use super::nearest::nearest;
use revmap::error::{Error, ErrorKind, Result};
use toml::{Table, Value};

/// `root` with each of `sets` written into it by [`apply`].
pub(super) fn applied(root: &Table, sets: &[String]) -> Result<Table> {
    let mut root = root.clone();
    sets.iter().try_for_each(|set| apply(&mut root, set))?;
    Ok(root)
}

/// Writes `assignment`, `path.to.key=value`, into `root`: `object.0.bevel=0.4`, `camera.eye.2=1.5`.
/// The value is read as TOML, or else as text. Missing tables on the path are made; list entries
/// must exist.
fn apply(root: &mut Table, assignment: &str) -> Result<()> {
    let (path, value) = assignment.split_once('=').ok_or_else(|| {
        Error::new(
            ErrorKind::Usage,
            format!("{assignment:?} assigns nothing; write key=value, as in object.0.bevel=0.4"),
        )
        .at_key("sets")
    })?;
    let path = path.trim();
    let steps: Vec<&str> = path.split('.').map(str::trim).collect();
    let fail = |message: String| Error::new(ErrorKind::Usage, message).at_key(path);
    if steps.iter().any(|step| step.is_empty()) {
        return Err(fail(
            "a part of the key is empty; write it as in object.0.bevel".to_owned(),
        ));
    }
    put(root, &steps, parse(value.trim())).map_err(fail)
}

/// Writes a value at the end of the path `steps`, which begins in `table`.
fn put(table: &mut Table, steps: &[&str], value: Value) -> std::result::Result<(), String> {
    let [step, below @ ..] = steps else {
        return Ok(());
    };
    let numbered = below.first().is_some_and(|b| b.parse::<usize>().is_ok());
    if numbered && !table.contains_key(*step) {
        return Err(match ["light", "object"].contains(step) {
            true => format!(
                "the scene has no [[{step}]] to change; add one to the file, or set {step}=[{{}}] first"
            ),
            false => match nearest(step, &["light", "object"]) {
                Some(friend) => format!("is of no list; did you mean `{friend}`?"),
                None => format!("the scene has no `{step}` to change; set the whole list first"),
            },
        });
    }
    if below.is_empty() {
        table.insert((*step).to_owned(), value);
        return Ok(());
    }
    let entry = table.entry(*step);
    match (entry.or_insert_with(|| Table::new().into()), below) {
        (Value::Table(inner), _) => put(inner, below, value),
        (Value::Array(items), [last]) => {
            let (count, tables) = (items.len(), items.iter().any(Value::is_table));
            let index = last.parse::<usize>().ok();
            let message = match (index, tables) {
                (Some(i), true) if i < count => {
                    format!("is a table; name a key of it, as in {step}.{i}.KEY")
                }
                (Some(_), _) => format!("is not there: `{step}` has {count}, counted from 0"),
                (None, true) => format!("`{step}` is a list; say which: {step}.0.{last}"),
                (None, false) => format!("`{step}` is a list; say which: {step}.0"),
            };
            let item = index.and_then(|i| items.get_mut(i));
            *item.filter(|item| !item.is_table()).ok_or(message)? = value;
            Ok(())
        }
        (Value::Array(items), [index, below @ ..]) => {
            let count = items.len();
            let item = index.parse().ok().and_then(|i: usize| items.get_mut(i));
            let inner = item.and_then(Value::as_table_mut).ok_or_else(|| {
                format!("there is no {step}.{index}: the scene has {count}, counted from 0")
            })?;
            put(inner, below, value)
        }
        _ => Err(format!("`{step}` is a value, which has no keys below it")),
    }
}

/// The parsed value if it is TOML, or TOML but for the spelling of its numbers; otherwise the text
/// itself.
fn parse(text: &str) -> Value {
    let read = |text: &str| {
        let table = format!("value = {text}").parse::<Table>().ok();
        let table = table.filter(|table| table.len() == 1); // a line break would bring further keys
        table.and_then(|mut table| table.remove("value"))
    };
    read(text)
        .or_else(|| read(&with_plain_numbers(text)?))
        .unwrap_or_else(|| Value::String(text.to_owned()))
}

/// The text with every number spelled as TOML has it: `.5`, `5.`, `007` become `0.5`, `5.0`, `7`, and
/// `True` becomes `true`. `None` for text with quotes, in which no number is meant.
pub(super) fn with_plain_numbers(text: &str) -> Option<String> {
    let separates = |c: char| "[],".contains(c) || c.is_whitespace();
    let word = |part: &str| {
        let (word, end) = match part.strip_suffix(separates) {
            Some(word) => (word, &part[word.len()..]),
            None => (part, ""),
        };
        plain_number(word).unwrap_or_else(|| word.to_owned()) + end
    };
    let parts = (!text.contains(['"', '\''])).then(|| text.split_inclusive(separates));
    parts.map(|parts| parts.map(word).collect())
}

/// A decimal number, true or false as TOML spells it.
fn plain_number(word: &str) -> Option<String> {
    if ["true", "false"].contains(&word.to_ascii_lowercase().as_str()) {
        return Some(word.to_ascii_lowercase());
    }
    let unsigned = word.strip_prefix(['+', '-']).unwrap_or(word);
    if !unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return None; // a word, such as inf
    }
    match unsigned.bytes().all(|b| b.is_ascii_digit()) {
        true if word.parse::<i64>().is_ok() => word.parse::<i64>().ok().map(|n| n.to_string()),
        _ => word.parse::<f64>().ok().map(|x| format!("{x:?}")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn scene() -> Table {
        let text = "[camera]\nfov_y = 40\n[[object]]\nbevel = 0\n[[object]]\nbevel = 1";
        text.parse().unwrap()
    }

    #[test]
    fn values_are_toml_or_text() {
        // What is written, and how TOML spells it.
        let spelled = "0.4|0.4 .05|0.05 -.05|-0.05 +5|5 5.|5.0 07|7 -007.50|-7.5 1.e3|1000.0 True|true 7|7 \
            [.5,+.5,05]|[0.5,0.5,5] [[.5,0],[1.,1]]|[[0.5,0],[1.0,1]] true|true [1,2]|[1,2] \"ab\"|\"ab\"";
        for (text, wanted) in spelled.split(' ').filter_map(|case| case.split_once('|')) {
            let wanted: Table = format!("value = {wanted}").parse().unwrap();
            assert_eq!(parse(text), wanted["value"], "{text}");
        }
        for text in [
            "07.png",
            "./.5",
            "1 .5",
            "pawn.svg",
            "0,4",
            "1\nother = 2",
            "",
        ] {
            assert_eq!(parse(text), Value::String(text.into()));
        }
    }

    #[test]
    fn keys_are_found_in_lists_and_made_in_tables() {
        let mut root = scene();
        let sets = "object.1.bevel=0.5|camera.eye = [1, 2, 3]|camera.eye.2 = 4.5|background=[0,0,0,1]|new.key=x=y";
        sets.split('|')
            .for_each(|set| apply(&mut root, set).unwrap());
        let wanted = "camera = {fov_y = 40, eye = [1, 2, 4.5]}\nobject = [{bevel = 0}, {bevel = 0.5}]\n\
             background = [0, 0, 0, 1]\nnew = {key = \"x=y\"}";
        assert_eq!(root, wanted.parse().unwrap());
        let refused = apply(&mut root, "camera.eye.3=1").unwrap_err().to_string();
        assert!(
            refused.ends_with("`eye` has 3, counted from 0"),
            "{refused}"
        );
    }

    const WRONG: &str = r#"
bevel => sets: "bevel" assigns nothing
object.2.bevel=1 => object.2.bevel: there is no object.2: the scene has 2
object.bevel=1 => object.bevel: `object` is a list; say which: object.0.bevel
object.0=1 => object.0: is a table; name a key of it
objects.0.bevel=1 => did you mean `object`?
camera.up.2=1 => no `up` to change; set the whole list first
light.0.radius=1 => no [[light]] to change; add one
camera.fov_y.x=1 => camera.fov_y.x: `fov_y` is a value
camera..x=1 => a part of the key is empty
=1 => a part of the key is empty"#;

    #[test]
    fn wrong_paths_are_usage_errors() {
        for (assignment, wanted) in WRONG.lines().filter_map(|line| line.split_once(" => ")) {
            let error = apply(&mut scene(), assignment).unwrap_err();
            assert_eq!(error.kind, ErrorKind::Usage);
            assert!(error.to_string().contains(wanted), "{error}");
        }
    }
}
