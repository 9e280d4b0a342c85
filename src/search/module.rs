//! The modules of a search. Build scripts include this file, so it depends on nothing.

/// The stage and geometry by which a module traces rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pass {
    /// Fragments of shape boxes.
    Fragment,
    /// Compute, by walks of a hierarchy of copies.
    Compute,
}

/// The stored data of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StoredPlanes {
    /// Colour.
    Color,
    /// Every plane of a frame.
    Planes,
}

/// One module of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SearchModule {
    /// The stage and geometry by which rays are traced.
    pub pass: Pass,
    /// The stored data.
    pub output: StoredPlanes,
    /// True if it reads a table of its own instead of the shape map.
    pub table: bool,
    /// True if there is a bound on its steps.
    pub bounded: bool,
}

impl SearchModule {
    /// The entry file in `shaders-glsl`.
    #[must_use]
    pub const fn entry(&self) -> &'static str {
        match self.pass {
            Pass::Fragment => "tree.frag",
            Pass::Compute => "walk.comp",
        }
    }

    /// The macros for its compilation.
    #[must_use]
    pub fn macros(&self) -> Vec<(&'static str, &'static str)> {
        let set = [
            (self.table, "SEARCH_TABLE"),
            (self.table && self.bounded, "SEARCH_BOUNDED"),
        ];
        let set = set.into_iter().filter(|(is_set, _)| *is_set);
        let mut all = vec![("SEARCH", "SEARCH_EXTERNAL"), ("REPEATED", "1")];
        all.extend(set.map(|(_, name)| (name, "1")));
        if self.output == StoredPlanes::Planes {
            all.push(("OUTPUT", "OUTPUT_PLANES"));
        }
        all
    }

    /// The module's name, without the search's.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{:?}.{:?}", self.pass, self.output).to_lowercase()
    }
}
