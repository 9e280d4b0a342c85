//! An entry of a plan's `measure`: ways of drawing, as every combination of its lists.

use super::values::{Spelled, list};
use crate::plan::method::{Edges, Method};
use revmap::error::Error;
use revmap::maps::{MapFormat, MapSource};
use revmap::settings::{DrawStage, Tolerance};

/// Ways of drawing: every combination of the lists. Lists have defaults.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Measure {
    /// Its name, by which charts and tables choose its rows.
    pub name: String,
    /// Names of the views that it draws; empty: all.
    pub views: Vec<String>,
    /// The stages in which rays are traced.
    #[serde(deserialize_with = "list")]
    pub stages: Vec<DrawStage>,
    /// How the surface is found.
    #[serde(deserialize_with = "list")]
    pub methods: Vec<Pick>,
    /// Widths and heights, pixels.
    #[serde(deserialize_with = "list")]
    pub sizes: Vec<(u32, u32)>,
    /// Bounds on steps.
    pub max_steps: Vec<u32>,
    /// Rows of shape maps.
    pub map_rows: Vec<u32>,
    /// Sources of distances.
    #[serde(deserialize_with = "list")]
    pub map_sources: Vec<MapSource>,
    /// Formats of the maps.
    #[serde(deserialize_with = "list")]
    pub map_formats: Vec<MapFormat>,
    /// Allowed errors in pixels, of methods that follow one.
    #[serde(deserialize_with = "list")]
    pub tolerances: Vec<Tolerance>,
    /// How edges are treated.
    #[serde(deserialize_with = "list")]
    pub edges: Vec<Edges>,
    /// True if methods that read neither a map nor a table are left out.
    pub readers_only: bool,
}

impl Default for Measure {
    fn default() -> Self {
        Self {
            name: String::new(),
            views: Vec::new(),
            stages: vec![DrawStage::Fragment, DrawStage::Compute],
            methods: vec![Pick::Method(Method::DEFAULT)],
            sizes: vec![(800, 600)],
            max_steps: Vec::new(),
            map_rows: Vec::new(),
            map_sources: Vec::new(),
            map_formats: vec![MapFormat::R32],
            tolerances: vec![Tolerance::EXACT],
            edges: vec![Edges::OneRay],
            readers_only: false,
        }
    }
}

/// An entry of a list of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pick {
    /// One method.
    Method(Method),
    /// The RBM baseline.
    Baseline,
    /// All searches of a kind.
    Kind(Kind),
}

/// Kinds of searches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Every search.
    All,
    /// The default; where others are named, if it is among them.
    OnlyDefault,
    /// Those with a bound on their steps, without a table of their own.
    Bounded,
    /// Those without a bound and without a table.
    Unbounded,
    /// Those with a table of their own, whose rows are their bound.
    Tables,
    /// `circle` and `live`; where others are named, those of them that read maps.
    Maps,
}

impl Kind {
    const NAMES: [(&'static str, Self); 6] = [
        ("all", Self::All),
        ("only-default", Self::OnlyDefault),
        ("bounded", Self::Bounded),
        ("unbounded", Self::Unbounded),
        ("tables", Self::Tables),
        ("maps", Self::Maps),
    ];

    /// The methods of this kind among these.
    fn of(self, all: &[Method]) -> Vec<Method> {
        let usual = ["circle", "live"];
        let named = all.iter().any(|m| usual.contains(&m.name()));
        let own = |m: &Method| {
            let bounded = m.default_steps(false) > 1;
            match self {
                Self::All => true,
                Self::OnlyDefault => *m == Method::DEFAULT,
                Self::Bounded => bounded && !m.reads_own_table(),
                Self::Unbounded => !bounded && !m.reads_own_table(),
                Self::Tables => m.reads_own_table(),
                Self::Maps => m.reads_map() && (!named || usual.contains(&m.name())),
            }
        };
        all.iter().copied().filter(own).collect()
    }
}

impl Spelled for Pick {
    type Raw = String;

    fn read(word: String) -> Result<Self, String> {
        let kind = Kind::NAMES.iter().find(|(name, _)| *name == word);
        match (&*word, kind) {
            ("baseline", _) => Ok(Self::Baseline),
            ("default", _) => Ok(Self::Method(Method::DEFAULT)),
            (_, Some((_, kind))) => Ok(Self::Kind(*kind)),
            _ => word.parse().map(Self::Method).map_err(|e: Error| {
                let others =
                    "baseline, default, only-default, all, bounded, unbounded, tables or maps";
                format!("{}; or {others}", e.message)
            }),
        }
    }
}

impl Measure {
    /// The methods, with `named` ones in place of the list's own. `None`: the RBM baseline.
    pub fn methods(&self, named: &[Method]) -> Vec<Option<Method>> {
        let none = named.is_empty();
        let searches = if none { &Method::ALL[..] } else { named };
        let (mut all, mut replaced) = (Vec::new(), false);
        for pick in &self.methods {
            match pick {
                Pick::Baseline => all.push(None),
                Pick::Kind(kind) => all.extend(kind.of(searches).into_iter().map(Some)),
                Pick::Method(Method::Floor) => all.push(Some(Method::Floor)),
                Pick::Method(own) if none => all.push(Some(*own)),
                // Meshes by themselves are not replaced by searches.
                Pick::Method(own) if !own.is_mesh() => replaced = true,
                Pick::Method(_) => {}
            }
        }
        if replaced {
            all.splice(0..0, named.iter().map(|m| Some(*m)));
        }
        all
    }
}
