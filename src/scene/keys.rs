//! A table of a scene file: only known keys, each read as its required type. Every message has the
//! key's full path.

use crate::error::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A table whose keys are all known.
pub(super) struct Keys<'a> {
    table: &'a Table,
    path: String,
    known: &'static [&'static str],
}

impl<'a> Keys<'a> {
    /// Checks the keys of `table`, whose path is `path` (`""`: the whole file).
    ///
    /// # Errors
    /// The first key that is not in `known`, with the nearest known key.
    pub(super) fn new(
        table: &'a Table,
        path: impl Into<String>,
        known: &'static [&'static str],
    ) -> Result<Self> {
        let keys = Self {
            table,
            path: path.into(),
            known,
        };
        match table.keys().find(|key| !known.contains(&key.as_str())) {
            None => Ok(keys),
            Some(stranger) => Err(keys.fail(stranger, unknown(stranger, known))),
        }
    }

    /// The full path of `key`.
    pub(super) fn place(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    /// A failure at `key`.
    pub(super) fn fail(&self, key: &str, message: impl Into<String>) -> Error {
        Error::new(ErrorKind::Content, message).at_key(self.place(key))
    }

    fn get(&self, key: &str) -> Option<&'a Value> {
        debug_assert!(self.known.contains(&key), "{key} is read but not known");
        self.table.get(key)
    }

    fn wrong(&self, key: &str, wanted: &str, found: &Value) -> Error {
        self.fail(key, format!("expected {wanted}, found {}", describe(found)))
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>> {
        self.get(key)
            .map(|v| as_number(v).ok_or_else(|| self.wrong(key, "a number", v)))
            .transpose()
    }

    /// A number; `Some(None)` for the word `"auto"`.
    pub(super) fn number_or_auto(&self, key: &str) -> Result<Option<Option<f64>>> {
        match self.get(key) {
            Some(Value::String(word)) if word == "auto" => Ok(Some(None)),
            Some(v) => match as_number(v) {
                Some(number) => Ok(Some(Some(number))),
                None => Err(self.wrong(key, "a number or \"auto\"", v)),
            },
            None => Ok(None),
        }
    }

    pub(super) fn count(&self, key: &str) -> Result<Option<u32>> {
        self.get(key)
            .map(|v| {
                as_count(v).ok_or_else(|| self.wrong(key, "a whole number that is not negative", v))
            })
            .transpose()
    }

    pub(super) fn text(&self, key: &str) -> Result<Option<&'a str>> {
        self.get(key)
            .map(|v| {
                v.as_str()
                    .ok_or_else(|| self.wrong(key, "text in quotes", v))
            })
            .transpose()
    }

    /// A file name, relative to `folder`.
    pub(super) fn file(&self, key: &str, folder: &Path) -> Result<Option<PathBuf>> {
        match self.text(key)? {
            Some("") => Err(self.fail(
                key,
                "the file name is empty; name a file or leave the key out",
            )),
            Some(name) => Ok(Some(folder.join(name))),
            None => Ok(None),
        }
    }

    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>> {
        self.get(key)
            .map(|v| {
                v.as_bool()
                    .ok_or_else(|| self.wrong(key, "true or false", v))
            })
            .transpose()
    }

    /// The value of a name in `names`.
    pub(super) fn one_of<T: Copy>(&self, key: &str, names: &[(&str, T)]) -> Result<Option<T>> {
        let Some(text) = self.text(key)? else {
            return Ok(None);
        };
        match names.iter().find(|(name, _)| *name == text) {
            Some(&(_, value)) => Ok(Some(value)),
            None => {
                let all: Vec<_> = names.iter().map(|(name, _)| format!("{name:?}")).collect();
                Err(self.fail(
                    key,
                    format!("{text:?} is not known; give one of {}", all.join(", ")),
                ))
            }
        }
    }

    /// `N` values of one type.
    fn array<T: Copy + Default, const N: usize>(
        &self,
        key: &str,
        what: &str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Result<Option<[T; N]>> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let wanted = format!("{N} {what} in brackets");
        let items = value
            .as_array()
            .ok_or_else(|| self.wrong(key, &wanted, value))?;
        if items.len() != N {
            return Err(self.fail(
                key,
                format!("expected {wanted}, found {} values", items.len()),
            ));
        }
        let mut out = [T::default(); N];
        for (slot, item) in out.iter_mut().zip(items) {
            *slot = read(item).ok_or_else(|| self.wrong(key, &wanted, item))?;
        }
        Ok(Some(out))
    }

    pub(super) fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>> {
        self.array(key, "numbers", as_number)
    }

    /// Numbers for the GPU. Numbers that overflow become infinite, and the scene's check refuses
    /// them.
    pub(super) fn floats<const N: usize>(&self, key: &str) -> Result<Option<[f32; N]>> {
        self.array(key, "numbers", |v| as_number(v).map(|x| x as f32))
    }

    pub(super) fn counts<const N: usize>(&self, key: &str) -> Result<Option<[u32; N]>> {
        self.array(key, "whole numbers that are not negative", as_count)
    }

    pub(super) fn flags<const N: usize>(&self, key: &str) -> Result<Option<[bool; N]>> {
        self.array(key, "of true or false", Value::as_bool)
    }

    /// A list of pairs of numbers, of any length.
    pub(super) fn pairs(&self, key: &str) -> Result<Option<Vec<[f64; 2]>>> {
        const WANTED: &str = "a list of [r, z] pairs of numbers";
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let items = value
            .as_array()
            .ok_or_else(|| self.wrong(key, WANTED, value))?;
        let pair = |(i, item): (usize, &Value)| {
            match item.as_array().map(Vec::as_slice) {
                Some([a, b]) => as_number(a).zip(as_number(b)).map(|(a, b)| [a, b]),
                _ => None,
            }
            .ok_or_else(|| {
                let place = format!("{key}.{i}");
                self.fail(
                    &place,
                    format!(
                        "expected a pair of numbers [r, z], found {}",
                        describe(item)
                    ),
                )
            })
        };
        items
            .iter()
            .enumerate()
            .map(pair)
            .collect::<Result<_>>()
            .map(Some)
    }

    /// A table below this one.
    pub(super) fn table(&self, key: &str) -> Result<Option<&'a Table>> {
        self.get(key)
            .map(|v| {
                v.as_table()
                    .ok_or_else(|| self.wrong(key, &format!("a table [{key}]"), v))
            })
            .transpose()
    }

    /// A list of tables below this one.
    pub(super) fn tables(&self, key: &str) -> Result<Vec<&'a Table>> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let wanted = format!("tables, each begun by [[{key}]]");
        let items = value
            .as_array()
            .ok_or_else(|| self.wrong(key, &wanted, value))?;
        items
            .iter()
            .map(|item| {
                item.as_table()
                    .ok_or_else(|| self.wrong(key, &wanted, item))
            })
            .collect()
    }
}

fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(x) => Some(*x),
        Value::Integer(i) => Some(*i as f64),
        _ => None,
    }
}

fn as_count(value: &Value) -> Option<u32> {
    value.as_integer().and_then(|i| u32::try_from(i).ok())
}

/// A value as messages show it: its type, and the value itself if it is short.
fn describe(value: &Value) -> String {
    match value {
        Value::String(s) if s.chars().count() <= 40 => format!("the text {s:?}"),
        Value::String(_) => "a long text".to_owned(),
        Value::Integer(i) => format!("{i}"),
        Value::Float(x) => format!("{x:?}"),
        Value::Boolean(b) => format!("{b}"),
        Value::Datetime(d) => format!("the date {d}"),
        Value::Array(a) => format!("a list of {} values", a.len()),
        Value::Table(_) => "a table".to_owned(),
    }
}

/// The message for an unknown key.
pub(super) fn unknown(stranger: &str, known: &[&str]) -> String {
    match nearest(stranger, known) {
        Some(friend) => format!("unknown key; did you mean `{friend}`?"),
        None => format!("unknown key; known here: {}", known.join(", ")),
    }
}

/// The name closest to `word`, if it is close enough to be a spelling of it.
fn nearest<'k>(word: &str, names: &[&'k str]) -> Option<&'k str> {
    let word = word.to_lowercase().replace('-', "_");
    let allowed = (word.chars().count() / 3).clamp(1, 3);
    names
        .iter()
        .map(|name| (strsim::osa_distance(&word, name), *name))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const KNOWN: &[&str] = &[
        "bevel", "chamfer", "map_rows", "repeat", "mirror", "name", "points",
    ];

    fn read(text: &str) -> Table {
        text.parse().unwrap()
    }

    #[test]
    fn a_slip_is_met_with_the_nearest_key_and_nonsense_with_all() {
        assert_eq!(nearest("bevle", KNOWN), Some("bevel"));
        assert_eq!(nearest("map-rows", KNOWN), Some("map_rows"));
        assert_eq!(nearest("Chamfer", KNOWN), Some("chamfer"));
        assert_eq!(nearest("xyzzy", KNOWN), None);
        let table = read("bevle = 1");
        let message = Keys::new(&table, "object.0", KNOWN)
            .err()
            .unwrap()
            .to_string();
        assert_eq!(
            message,
            "object.0.bevle: unknown key; did you mean `bevel`?"
        );
        let table = read("xyzzy = 1");
        let message = Keys::new(&table, "", KNOWN).err().unwrap().to_string();
        assert!(
            message.starts_with("xyzzy: unknown key; known here: bevel, chamfer"),
            "{message}"
        );
    }

    #[test]
    fn wrong_types_say_what_was_found() {
        let table = read(
            "bevel = \"much\"\nmap_rows = -1\nrepeat = [1, 2]\nmirror = [true, 1, false]\nname = 3\npoints = [[1, 2], [3]]",
        );
        let keys = Keys::new(&table, "object.2", KNOWN).unwrap();
        let cases = [
            (
                keys.number("bevel").err(),
                "object.2.bevel: expected a number, found the text \"much\"",
            ),
            (
                keys.count("map_rows").err(),
                "object.2.map_rows: expected a whole number that is not negative, found -1",
            ),
            (
                keys.counts::<3>("repeat").err(),
                "object.2.repeat: expected 3 whole numbers that are not negative in brackets, found 2 values",
            ),
            (
                keys.flags::<3>("mirror").err(),
                "object.2.mirror: expected 3 of true or false in brackets, found 1",
            ),
            (
                keys.text("name").err(),
                "object.2.name: expected text in quotes, found 3",
            ),
            (
                keys.pairs("points").err(),
                "object.2.points.1: expected a pair of numbers [r, z], found a list of 1 values",
            ),
        ];
        for (found, wanted) in cases {
            assert_eq!(found.unwrap().to_string(), wanted);
        }
    }

    #[test]
    fn whole_numbers_serve_as_numbers() {
        let table = read("bevel = 2\nrepeat = [1, 2.5, 3]");
        let keys = Keys::new(&table, "", KNOWN).unwrap();
        assert_eq!(keys.number("bevel").unwrap(), Some(2.0));
        assert_eq!(keys.numbers::<3>("repeat").unwrap(), Some([1.0, 2.5, 3.0]));
        assert_eq!(keys.number("chamfer").unwrap(), None);
    }
}
