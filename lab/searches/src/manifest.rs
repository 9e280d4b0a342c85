//! `search.toml`, the description of a search in a folder. The build script reads the searches of
//! this crate with this file, so it depends on nothing of the crate.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;

/// The name of the file.
pub const FILE: &str = "search.toml";

/// The content of a `search.toml`. `docs/your-own-search.md` explains the keys.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Name in options and results.
    pub name: String,
    /// Short description.
    pub about: String,
    /// The publication.
    pub source: String,
    /// The licence of its code.
    pub licence: String,
    /// The data that it searches.
    pub reads: Data,
    /// The GLSL file with its function. Files are found in the folder, then beside it.
    #[serde(default = "glsl")]
    pub glsl: String,
    /// True if it draws solids with a bevel. Otherwise they are refused.
    #[serde(default)]
    pub bevels: bool,
    /// True if it draws from the papers' map of unsigned distances (`rgba8`) too.
    #[serde(default)]
    pub unsigned: bool,
    /// True if it draws for an eye within the solid. Otherwise such rays hit nothing.
    #[serde(default)]
    pub inside: bool,
    /// The bound on its steps. A search on a map must have one.
    pub steps: Option<Bound>,
    /// Constants of its GLSL that a user may set.
    #[serde(default)]
    pub parameters: BTreeMap<String, Parameter>,
    /// The maker of its own table.
    pub table: Option<Table>,
    /// The value of `SEARCH_FORM` in GLSL, for searches that share their modules.
    #[serde(default)]
    pub form: u32,
}

fn glsl() -> String {
    "search.glsl".to_owned()
}

/// The data that a search reads.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Data {
    /// The shape map of distances.
    #[serde(rename = "map")]
    Map,
    /// The shape map as a binary picture: solid or not.
    #[serde(rename = "binary map")]
    BinaryMap,
    /// The library's patches of quadrics, rows and tree.
    #[serde(rename = "patches")]
    Patches,
    /// A table of its own.
    #[serde(rename = "table")]
    Table,
}

impl Data {
    /// Its name in the file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::BinaryMap => "binary map",
            Self::Patches => "patches",
            Self::Table => "table",
        }
    }

    /// True if it is the shape map.
    pub const fn is_map(self) -> bool {
        matches!(self, Self::Map | Self::BinaryMap)
    }
}

/// A bound on steps.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// The default bound.
    pub default: u32,
    /// The default bound for a solid with a bevel.
    pub beveled: Option<u32>,
    /// The largest allowed bound.
    #[serde(default = "most")]
    pub most: u32,
    /// True if a ray may use up its steps before its search has come to an end.
    #[serde(default = "yes")]
    pub may_run_out: bool,
}

/// The largest bound of all searches, as in the library.
fn most() -> u32 {
    65536
}

fn yes() -> bool {
    true
}

/// A constant of the GLSL that a user may set.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Its meaning, with its unit.
    pub about: String,
    /// The value if none is given. A whole number makes an `int`, another a `float`.
    pub default: Number,
    /// The least and the largest value.
    pub range: [Number; 2],
}

/// A number of either kind.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Number {
    /// A whole number.
    Int(i32),
    /// Another.
    Float(f32),
}

impl Number {
    fn value(self) -> f64 {
        match self {
            Self::Int(n) => n.into(),
            Self::Float(x) => x.into(),
        }
    }
}

/// As in GLSL.
impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(n) => write!(f, "{n}"),
            Self::Float(x) => write!(f, "{x:?}"),
        }
    }
}

/// The maker of a table.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    /// A program and its arguments; files of the folder are found by name.
    pub program: Vec<String>,
    /// The path of a function of this crate, for searches of this crate.
    pub rust: String,
}

impl Parameter {
    /// A value from its text.
    pub fn value(&self, name: &str, text: &str) -> Result<Number, String> {
        let (kind, value) = match self.default {
            Number::Int(_) => ("a whole number", text.parse().map(Number::Int).ok()),
            Number::Float(_) => ("a number", text.parse().map(Number::Float).ok()),
        };
        let [low, high] = self.range;
        value.filter(|v| self.allows(*v)).ok_or_else(|| {
            format!(
                "{name} is {text:?}; give {kind} from {low} to {high}: {}",
                self.about
            )
        })
    }

    fn check(&self, name: &str) -> Result<(), String> {
        let kind = std::mem::discriminant(&self.default);
        let fault = if !is_word(name, "_") {
            "is no name; give small letters, digits and underscores".to_owned()
        } else if (self.range.iter()).any(|n| std::mem::discriminant(n) != kind) {
            "default and range are of two kinds; write all with a point, or all without".to_owned()
        } else if !self.allows(self.default) {
            let (default, [low, high]) = (self.default, self.range);
            format!("the default {default} is outside the range {low} to {high}")
        } else {
            return Ok(());
        };
        Err(format!("parameters.{name}: {fault}"))
    }

    fn allows(&self, value: Number) -> bool {
        (self.range[0].value()..=self.range[1].value()).contains(&value.value())
    }
}

impl Manifest {
    /// Reads the text of a `search.toml`. `own`: it is a search of this crate.
    ///
    /// # Errors
    /// A sentence that names the line or the key, and the remedy.
    pub fn parse(text: &str, own: bool) -> Result<Self, String> {
        let manifest: Self = toml::from_str(text).map_err(|e| {
            let start = e.span().map_or(0, |span| span.start);
            let line = text.get(..start).unwrap_or("").matches('\n').count() + 1;
            let message: Vec<&str> = e.message().split_whitespace().collect();
            format!("line {line}: {}", message.join(" "))
        })?;
        manifest.check(own)?;
        Ok(manifest)
    }

    /// The first fault of the values.
    fn check(&self, own: bool) -> Result<(), String> {
        let is_named = is_word(&self.name, "-") && self.name.len() <= 32;
        let is_empty = |text: &str| text.trim().is_empty();
        let (reads, is_map) = (self.reads.name(), self.reads.is_map());
        let bound = self.steps.map_or([1, 1], |s| [s.default, s.most]);
        let [default, largest] = bound;
        let table = self.table.as_ref();
        let refuse = |is: bool, message: &str| match is {
            true => Err(message.to_owned()),
            false => Ok(()),
        };
        let name = &self.name;
        let message =
            format!("name: {name:?} is no name; give at most 32 small letters, digits and hyphens");
        refuse(!is_named, &message)?;
        refuse(
            is_empty(&self.about),
            "about: is empty; the report shows it",
        )?;
        let message = "source: is empty; the report shows it";
        refuse(is_empty(&self.source), message)?;
        let message =
            "steps: is missing; a search on a map has a bound, as in [steps] default = 64";
        refuse(is_map && self.steps.is_none(), message)?;
        let message = format!(
            "steps: default is {default} and most {largest}; give 1 or more by default, most at least as many and at most {}",
            most()
        );
        let wrong = default == 0 || default > largest || largest > most();
        refuse(wrong, &message)?;
        let message = "table: is missing; name a program, as in [table] program = [\"python3\", \"table.py\"]";
        refuse(table.is_none() && self.reads == Data::Table, message)?;
        let message =
            format!("table: reads is {reads:?}, which needs no program; write reads = \"table\"");
        refuse(table.is_some() && self.reads != Data::Table, &message)?;
        let message = "table.rust: is for searches of revmap's own crates; name a program";
        refuse(!own && table.is_some_and(|t| !t.rust.is_empty()), message)?;
        let nothing = table.is_some_and(|t| t.rust.is_empty() && t.program.is_empty());
        refuse(nothing, "table.program: is empty; name a program")?;
        let message = "unsigned: is for searches on a map";
        refuse(self.unsigned && !is_map, message)?;
        let mut parameters = self.parameters.iter();
        parameters.try_for_each(|(name, parameter)| parameter.check(name))
    }
}

/// True if a text has small letters, digits and characters of `also`, and begins with a letter.
fn is_word(text: &str, also: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || also.contains(c);
    text.starts_with(|c: char| c.is_ascii_lowercase()) && text.chars().all(plain)
}
