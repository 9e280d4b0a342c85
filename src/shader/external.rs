//! Searches of other crates, as part of a variant.

use super::catalogue::{self, Module};
use crate::error::{Error, ErrorKind, Result};
use crate::maps::MapFormat;
use crate::search::{Features, Output, Pass, Reads, Search, SearchModule};
use crate::settings::SearchSettings;

/// A search and its form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct External {
    /// The search.
    pub search: &'static Search,
    beveled: bool,
    rgba8: bool,
    /// The bound on steps if that bound is the default; else 0, and the bound is data. A
    /// compiled-in default keeps comparisons fair: a search is not slowed by an unused option.
    known_steps: u32,
}

impl External {
    /// The form for an object. `beveled`: the object has a bevel. `met`: rays of shadows may meet a
    /// bevel. `casts`: there are shadows, whose rays take the steps of the objects that they meet.
    pub fn new(
        search: &'static Search,
        settings: &SearchSettings,
        beveled: bool,
        met: bool,
        casts: bool,
    ) -> Self {
        let (form, rgba8) = match search.reads {
            Reads::Map { tells_bevels, .. } => (
                !tells_bevels || beveled || met,
                settings.map_format == MapFormat::Rgba8,
            ),
            Reads::Table(_) => (false, false),
        };
        let own = default_steps(search, beveled);
        let is_own = settings.max_steps.is_none_or(|steps| steps == own);
        Self {
            search,
            beveled: form,
            rgba8,
            known_steps: if is_own && !casts { own } else { 0 },
        }
    }

    /// True if the search reads a table of its own.
    pub const fn reads_table(self) -> bool {
        matches!(self.search.reads, Reads::Table(_))
    }

    /// The forms that replace this one when a bevel is added or removed.
    pub fn others(self) -> Vec<Self> {
        let distinct = matches!(
            self.search.reads,
            Reads::Map {
                tells_bevels: true,
                ..
            }
        );
        if !distinct {
            return Vec::new();
        }
        let beveled = !self.beveled;
        let known = [0, default_steps(self.search, beveled)];
        let other = |known_steps| Self {
            beveled,
            known_steps,
            ..self
        };
        known.map(other).to_vec()
    }

    /// The search whose vertices pass the inputs of this search's fragments.
    pub const fn vertices(self) -> catalogue::Search {
        match (&self.search.reads, &self.search.steps) {
            (Reads::Map { .. }, _) => catalogue::Search::Live,
            (Reads::Table(_), None) => catalogue::Search::Quadric,
            (Reads::Table(_), Some(_)) => catalogue::Search::External,
        }
    }

    /// `(SEARCH_FORM, KNOWN_STEPS)`.
    pub const fn constants(self) -> (u32, u32) {
        (self.search.form, self.known_steps)
    }

    /// The search's own description of `module`; none if the search has no such module.
    pub fn module(self, module: &Module) -> Option<SearchModule> {
        let pass = match module.entry {
            catalogue::Entry::Tree => Pass::Fragment,
            catalogue::Entry::TileTree => Pass::Tile,
            catalogue::Entry::TileCopies => Pass::Copies,
            _ => return None,
        };
        let output = match module.output {
            catalogue::Output::Color => Output::Color,
            catalogue::Output::Planes => Output::Planes,
            catalogue::Output::List | catalogue::Output::Depth | catalogue::Output::DepthOrtho => {
                return None;
            }
        };
        Some(SearchModule {
            pass,
            features: match module.features {
                catalogue::Features::Plain => Features::Plain,
                catalogue::Features::Textured => Features::Textured,
                catalogue::Features::Full => Features::Full,
            },
            output,
            table: self.reads_table(),
            bounded: self.search.steps.is_some(),
            beveled: self.beveled,
            rgba8: self.rgba8,
        })
    }

    /// The name of `module`.
    pub fn name(self, module: &Module) -> String {
        let own = self.module(module).map(|own| own.name());
        format!("{}.{}", self.search.name, own.unwrap_or_default())
    }

    /// The SPIR-V of `module`.
    pub fn words(self, module: &Module) -> Result<Vec<u32>> {
        let none = || {
            Error::new(
                ErrorKind::Other,
                format!("no shader is {}", self.name(module)),
            )
        };
        self.search.words.of(&self.module(module).ok_or_else(none)?)
    }
}

fn default_steps(search: &Search, beveled: bool) -> u32 {
    search.steps.map_or(0, |steps| steps.of(beveled))
}
