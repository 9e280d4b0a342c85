//! A table of a scene file: only known keys, each read as its required type. Every message has the
//! key's full path.

use super::nearest::nearest;
use super::spelling::unquoted;
use crate::{content_fault, css_color};
use glam::DVec3;
use revmap::error::{Error, Result};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A table whose keys are all known.
pub(super) struct Keys<'a> {
    table: &'a Table,
    path: String,
}

/// A type of values.
pub(super) trait Entry: Sized {
    /// The type in words.
    fn wanted() -> String;
    /// The value, or in words what stands in its place.
    fn read(value: &Value) -> std::result::Result<Self, String>;
}

/// A type of values that lists hold, too.
trait Item: Entry + Copy + Default {
    /// Several values in words.
    const SEVERAL: &'static str;
    fn item(value: &Value) -> Option<Self>;
}

macro_rules! items {
    ($($item:ty: $one:literal, $several:literal, $read:expr;)*) => {$(
        impl Item for $item {
            const SEVERAL: &'static str = $several;

            fn item(value: &Value) -> Option<Self> {
                $read(value)
            }
        }

        impl Entry for $item {
            fn wanted() -> String {
                $one.to_owned()
            }

            fn read(value: &Value) -> std::result::Result<Self, String> {
                Self::item(value).ok_or_else(|| describe(value))
            }
        }
    )*};
}
items! {
    f64: "a number", "numbers", number;
    // Numbers that overflow become infinite, or the largest: the scene's check refuses them.
    f32: "a number", "numbers", |v| number(v).map(|x| x as Self);
    u32: "a whole number that is not negative", "whole numbers that are not negative",
        |v: &Value| v.as_integer().filter(|i| *i >= 0).map(|i| Self::try_from(i).unwrap_or(Self::MAX));
    bool: "true or false", "of true or false", Value::as_bool;
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(x) => Some(*x),
        Value::Integer(i) => Some(*i as f64),
        _ => None,
    }
}

impl<T: Item, const N: usize> Entry for [T; N] {
    fn wanted() -> String {
        format!("{N} {} in brackets", T::SEVERAL)
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        let items = value.as_array().ok_or_else(|| describe(value))?;
        if items.len() != N {
            return Err(format!("{} values", items.len()));
        }
        let mut out = [T::default(); N];
        for (slot, item) in out.iter_mut().zip(items) {
            *slot = T::item(item).ok_or_else(|| describe(item))?;
        }
        Ok(out)
    }
}

impl Entry for DVec3 {
    fn wanted() -> String {
        <[f64; 3]>::wanted()
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        <[f64; 3]>::read(value).map(Self::from_array)
    }
}

impl<'a> Keys<'a> {
    /// Checks the keys of `table`, whose path is `path` (`""`: the whole file).
    ///
    /// # Errors
    /// The first key that is not in `known`, a list of words, with the nearest known key.
    pub(super) fn new(table: &'a Table, path: impl Into<String>, known: &str) -> Result<Self> {
        let path = path.into();
        let keys = Self { table, path };
        let known: Vec<&str> = known.split_whitespace().collect();
        match table.keys().find(|key| !known.contains(&key.as_str())) {
            None => Ok(keys),
            Some(stranger) if keys.path.is_empty() && is_of_object(stranger) => {
                let message =
                    format!("unknown key; write it below [[object]], or set object.0.{stranger}");
                Err(keys.fail(stranger, message))
            }
            Some(stranger) => Err(keys.fail(stranger, unknown(stranger, &known))),
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
        content_fault(message).at_key(self.place(key))
    }

    fn wrong(&self, key: &str, wanted: &str, found: &str) -> Error {
        self.fail(key, format!("expected {wanted}, found {found}"))
    }

    /// The value of `key`, turned by `read`; an error names what is `wanted`.
    fn read<T>(
        &self,
        key: &str,
        wanted: &str,
        read: impl Fn(&'a Value) -> Option<T>,
    ) -> Result<Option<T>> {
        let value = |v| read(v).ok_or_else(|| self.wrong(key, wanted, &describe(v)));
        self.table.get(key).map(value).transpose()
    }

    /// The value of `key`, if the table has it.
    pub(super) fn get<T: Entry>(&self, key: &str) -> Result<Option<T>> {
        let read = |v| {
            T::read(v).map_err(|found| {
                let spelled = unquoted(v, |v| T::read(v).is_ok());
                self.wrong(key, &T::wanted(), &(found + &spelled))
            })
        };
        self.table.get(key).map(read).transpose()
    }

    /// Replaces `slot` by the value of `key`, if the table has it.
    pub(super) fn set<T: Entry>(&self, key: &str, slot: &mut T) -> Result<()> {
        if let Some(value) = self.get(key)? {
            *slot = value;
        }
        Ok(())
    }

    /// A number; `Some(None)` for the word `"auto"`.
    pub(super) fn number_or_auto(&self, key: &str) -> Result<Option<Option<f64>>> {
        self.read(key, "a number or \"auto\"", |value| match value {
            Value::String(word) if word == "auto" => Some(None),
            other => number(other).map(Some),
        })
    }

    /// Replaces `slot` with the colour of the key: three linear numbers, or an opaque colour of CSS.
    pub(super) fn color(&self, key: &str, slot: &mut [f32; 3]) -> Result<()> {
        let Some(text) = self.table.get(key).and_then(Value::as_str) else {
            return self.set(key, slot);
        };
        let Some([red, green, blue, 1.0]) = css_color(text) else {
            let wanted = "3 numbers, or an opaque colour such as \"orange\" or \"#e0a030\"";
            return Err(self.wrong(key, wanted, &format!("the text {text:?}")));
        };
        *slot = [red, green, blue];
        Ok(())
    }

    fn text(&self, key: &str) -> Result<Option<&'a str>> {
        self.read(key, "text in quotes", Value::as_str)
    }

    /// A file name, relative to `folder`.
    pub(super) fn file(&self, key: &str, folder: &Path) -> Result<Option<PathBuf>> {
        match self.text(key)? {
            Some("") => Err(self.fail(
                key,
                "the file name is empty; name a file or leave the key out",
            )),
            Some(name) => match path_hint(name).filter(|_| !folder.join(name).exists()) {
                Some(hint) => Err(self.fail(key, format!("{name:?} {hint}"))),
                None => Ok(Some(folder.join(name))),
            },
            None => Ok(None),
        }
    }

    /// Replaces `slot` by the value of the name in `names` that the table gives, if it does.
    pub(super) fn choose<T: Copy>(
        &self,
        key: &str,
        names: &[(&str, T)],
        slot: &mut T,
    ) -> Result<()> {
        let Some(text) = self.text(key)? else {
            return Ok(());
        };
        let Some((_, value)) = names.iter().find(|(name, _)| *name == text) else {
            let all: Vec<_> = names.iter().map(|(name, _)| format!("{name:?}")).collect();
            let message = format!("{text:?} is not known; give one of {}", all.join(", "));
            return Err(self.fail(key, message));
        };
        *slot = *value;
        Ok(())
    }

    /// Replaces `slot` by the value of a name, as [`choose`](Self::choose) does, or by what `make`
    /// makes of a number.
    pub(super) fn choose_or_number<T: Copy>(
        &self,
        key: &str,
        names: &[(&str, T)],
        make: impl Fn(f64) -> T,
        slot: &mut T,
    ) -> Result<()> {
        if let Some(value) = self.table.get(key).and_then(number) {
            *slot = make(value);
            return Ok(());
        }
        self.choose(key, names, slot).map_err(|mut e| {
            e.message += ", or a number without quotes";
            e
        })
    }

    /// A list of pairs of numbers, of any length.
    pub(super) fn pairs(&self, key: &str) -> Result<Option<Vec<[f64; 2]>>> {
        let items = self.read(key, "a list of [r, z] pairs of numbers", Value::as_array)?;
        let pair = |(i, item): (usize, &Value)| {
            let wanted = "a pair of numbers [r, z]";
            let place = format!("{key}.{i}");
            <[f64; 2]>::read(item).map_err(|_| self.wrong(&place, wanted, &describe(item)))
        };
        let pairs = items.map(|items| items.iter().enumerate().map(pair).collect());
        pairs.transpose()
    }

    /// A table below this one.
    pub(super) fn table(&self, key: &str) -> Result<Option<&'a Table>> {
        self.read(key, &format!("a table [{key}]"), Value::as_table)
    }

    /// A list of tables below this one.
    pub(super) fn tables(&self, key: &str) -> Result<Option<Vec<&'a Table>>> {
        let wanted = format!("tables, each begun by [[{key}]]");
        let Some(items) = self.read(key, &wanted, Value::as_array)? else {
            return Ok(None);
        };
        let table = |item: &'a Value| {
            let table = item.as_table();
            table.ok_or_else(|| self.wrong(key, &wanted, &describe(item)))
        };
        items.iter().map(table).collect::<Result<_>>().map(Some)
    }
}

/// What is meant by a file name that is no path, and what to write for it.
pub(super) fn path_hint(name: &str) -> Option<&'static str> {
    if name == "-" {
        return Some("is no file; write /dev/stdin for standard input");
    }
    if name.starts_with('~') {
        return Some("is not there, and ~ stands for no folder here; write the whole path");
    }
    if name.contains("://") {
        return Some("is an address; download the file and name it");
    }
    let escaped = name.contains(char::is_control);
    escaped
        .then_some("holds what TOML makes of a \\; write / in paths, or single quotes about them")
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

/// Keys of `[[object]]`.
pub(super) const OBJECT: &str = "profile polygon profile_axis profile_read profile_threshold profile_invert \
    profile_smooth profile_min_stroke radius map_rows color color_map specular shininess roughness \
    metalness height_map bump bump_form \
    projection texture_repeat texture_offset extend bevel chamfer clip axis repeat mirror position \
    turn rotation scale instances stand";

fn is_of_object(key: &str) -> bool {
    OBJECT.split_whitespace().any(|known| known == key)
}

/// The message for an unknown key.
fn unknown(stranger: &str, known: &[&str]) -> String {
    match nearest(stranger, known) {
        Some(friend) => format!("unknown key; did you mean `{friend}`?"),
        None => format!("unknown key; known here: {}", known.join(", ")),
    }
}
