//! Searches of other crates, as part of a variant.

use super::catalogue::{self, Module};
use crate::error::{Error, ErrorKind, Result};
use crate::search::{Pass, Reads, Search, SearchModule, StoredPlanes};
use crate::settings::SearchSettings;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct External {
    pub search: &'static Search,
    /// The bound on steps if that bound is the default; else 0, and the bound is data. A
    /// compiled-in default keeps comparisons fair: a search is not slowed by an unused option.
    known_steps: u32,
}

impl External {
    /// The form for an object. `beveled`: the object has a bevel. `casts`: there are shadows, whose
    /// rays take the steps of the objects that they meet.
    pub fn new(
        search: &'static Search,
        settings: &SearchSettings,
        beveled: bool,
        casts: bool,
    ) -> Self {
        let own = default_steps(search, beveled);
        let is_own = settings.max_steps.is_none_or(|steps| steps == own);
        Self {
            search,
            known_steps: if is_own && !casts { own } else { 0 },
        }
    }

    pub const fn reads_table(self) -> bool {
        matches!(self.search.reads, Reads::Table(_))
    }

    /// The same search with and without the default steps of objects with or without a bevel.
    pub fn by_bevel(self, beveled: bool) -> [Self; 2] {
        [0, default_steps(self.search, beveled)].map(|known_steps| Self {
            known_steps,
            ..self
        })
    }

    /// `(SEARCH_FORM, KNOWN_STEPS)`.
    pub const fn constants(self) -> (u32, u32) {
        (self.search.form, self.known_steps)
    }

    /// The search's own description of `module`; none if the search has no such module.
    pub fn module(self, module: &Module) -> Option<SearchModule> {
        let pass = match module.entry {
            catalogue::Entry::Tree => Pass::Fragment,
            catalogue::Entry::WalkTiles | catalogue::Entry::WalkReplicas => Pass::Compute,
            _ => return None,
        };
        let output = match module.output {
            catalogue::Stored::Color => StoredPlanes::Color,
            catalogue::Stored::Planes => StoredPlanes::Planes,
            catalogue::Stored::List | catalogue::Stored::Depth => return None,
        };
        Some(SearchModule {
            pass,
            output,
            table: self.reads_table(),
            bounded: self.search.steps.is_some(),
        })
    }

    pub fn name(self, module: &Module) -> String {
        let own = self.module(module).map(|own| own.name());
        format!("{}.{}", self.search.name, own.unwrap_or_default())
    }

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
