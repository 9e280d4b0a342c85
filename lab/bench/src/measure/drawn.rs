//! `drawn.toml`: what a run drew. Two runs are compared where they drew the same.
//!
//! A view's scene has the keys of scene files, without those at their default. A profile, a map and
//! a list of copies is its count and a digest of its content.

mod scene;

pub use scene::assignments;

use crate::plan::Plan;
use crate::plan::view::View;
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::names::count;
use scene::scene;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use toml::{Table, Value};

/// The file in the folder of a run.
pub(crate) const FILE: &str = "drawn.toml";
/// The file's first lines.
const HEAD: &str = "\
# What this run drew. `revmap bench --compare` compares views whose scenes are equal. `scene` has the keys
# of scene files, without those at their default; `file` is the scene file with what --set changed.
";
/// Keys of a scene that a message names.
const NAMED: usize = 3;
/// Characters of a value in a message.
const SHOWN: usize = 40;

/// What a run drew.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// Settings of all rows that `results.csv` does not hold.
    settings: Table,
    /// The views, in the order of the plan.
    #[serde(default)]
    view: Vec<DrawnView>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct DrawnView {
    name: String,
    /// A digest of `scene`.
    digest: String,
    scene: Table,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<Table>,
}

impl Drawn {
    /// What a plan draws.
    pub fn of(plan: &Plan) -> Self {
        let settings = [
            ("mixed", plan.mixed.into()),
            ("truth_rays", Value::from(plan.truth_rays)),
            ("wall_clock", plan.wall_clock.into()),
        ];
        let view = |view: &View| {
            let scene = scene(&view.scene);
            DrawnView {
                name: view.name.clone(),
                digest: digest(format!("{:?}", keys("", &scene)).bytes()),
                scene,
                file: view.file.as_deref().cloned(),
            }
        };
        Self {
            settings: Table::from_iter(settings.map(|(key, value)| (key.to_owned(), value))),
            view: plan.views.iter().map(view).collect(),
        }
    }

    /// The file's text.
    pub(crate) fn text(&self) -> Result<String> {
        let text = toml::to_string(self).map_err(|e| {
            let message = format!("{FILE} cannot be written ({e}); report this");
            Error::new(ErrorKind::Other, message)
        })?;
        Ok(format!("{HEAD}\n{text}"))
    }

    /// Reads the file in the folder of a run; `None` if a run of an earlier version wrote none.
    pub(crate) fn load(folder: &Path) -> Result<Option<Self>> {
        let file = folder.join(FILE);
        let text = match std::fs::read_to_string(&file) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|e| e.to_string()),
        };
        let read = text.and_then(|text| toml::from_str(&text).map_err(|e| e.message().to_owned()));
        read.map(Some).map_err(|e| {
            let message = format!("cannot be read ({e}); measure again");
            Error::new(ErrorKind::File, message).in_file(file)
        })
    }

    /// The digest of each view by its name.
    pub(crate) fn digests(&self) -> BTreeMap<String, String> {
        let views = self.view.iter();
        views.map(|v| (v.name.clone(), v.digest.clone())).collect()
    }

    /// The settings that differ, as [`changes`] has them.
    pub(crate) fn other_settings(&self, new: &Self) -> Vec<String> {
        changes(&keys("", &self.settings), &keys("", &new.settings))
    }

    /// The views that two runs have under one name, and whose scenes differ: each with its changes.
    pub(crate) fn other_scenes(&self, new: &Self) -> BTreeMap<&str, Vec<String>> {
        let names: BTreeSet<&str> = self.view.iter().map(|v| v.name.as_str()).collect();
        let changed = |name| (name, changes(&self.keys_of(name), &new.keys_of(name)));
        let is_known = |name: &&str| new.view.iter().any(|v| v.name == *name);
        let both = names.into_iter().filter(is_known).map(changed);
        both.filter(|(_, changes)| !changes.is_empty()).collect()
    }

    /// The keys of the views of a name, of which a plan may have several.
    fn keys_of(&self, name: &str) -> BTreeMap<String, String> {
        let views = self.view.iter().filter(|v| v.name == name).enumerate();
        let all = views.flat_map(|(number, view)| match number {
            0 => keys("", &view.scene),
            more => keys(&format!("{}.", more + 1), &view.scene),
        });
        all.collect()
    }
}

/// A sentence on views whose scenes differ, with the keys of the first; none if there are none.
pub(crate) fn told(others: &BTreeMap<&str, Vec<String>>) -> Option<String> {
    let (first, changes) = others.first_key_value()?;
    let more = |others: usize, what: &str| match others {
        0 => String::new(),
        others => format!(" and {}", count(others, what)),
    };
    let named: Vec<&str> = changes.iter().take(NAMED).map(String::as_str).collect();
    let views = more(others.len() - 1, "other view");
    let keys = more(changes.len() - named.len(), "other key");
    let named = named.join(", ");
    Some(format!("different scenes as {first}{views}: {named}{keys}"))
}

/// The values that differ: `camera.eye (old [1, 2, 3], new [1, 2, 4])`.
pub(crate) fn changes(
    old: &BTreeMap<String, String>,
    new: &BTreeMap<String, String>,
) -> Vec<String> {
    let names: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let differs = |name: &&String| old.get(*name) != new.get(*name);
    let shown = |of: &BTreeMap<String, String>, name: &String| match of.get(name) {
        Some(value) if value.chars().count() > SHOWN => {
            format!("{}...", value.chars().take(SHOWN).collect::<String>())
        }
        Some(value) => value.clone(),
        None => "not set".to_owned(),
    };
    let change = |name: &String| {
        let [old, new] = [old, new].map(|of| shown(of, name));
        format!("{name} (old {old}, new {new})")
    };
    names.into_iter().filter(differs).map(change).collect()
}

/// The values of a table and of those below it, by their whole keys: `object.0.bevel`.
fn keys(above: &str, table: &Table) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    for (key, value) in table {
        let key = format!("{above}{key}");
        match value {
            Value::Table(below) => all.extend(keys(&format!("{key}."), below)),
            Value::Array(list) if list.iter().any(Value::is_table) => {
                let tables = list.iter().filter_map(Value::as_table).enumerate();
                all.extend(tables.flat_map(|(k, below)| keys(&format!("{key}.{k}."), below)));
            }
            value => {
                all.insert(key, value.to_string());
            }
        }
    }
    all
}

/// A digest in hexadecimal.
fn digest(bytes: impl Iterator<Item = u8>) -> String {
    format!("{:016x}", fnv1a_64(bytes))
}

/// FNV-1a of 64 bits (Fowler, Noll, Vo).
pub(crate) fn fnv1a_64(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests;
