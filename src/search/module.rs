//! The modules of a search. Build scripts include this file, so it depends on nothing.

/// The stage and geometry by which a module traces rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pass {
    /// Fragments of shape boxes and of tiles.
    Fragment,
    /// Compute, through tiles of pixels, each of one copy.
    Tile,
    /// Compute, through tiles of pixels, each with a list of copies.
    Copies,
}

/// The features of a solid besides its shape; each value includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Features {
    /// Only one colour, one solid in its box, no shadows.
    Plain,
    /// Maps of colour and bumps.
    Textured,
    /// Replicas and shadows.
    Full,
}

/// The stored data of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
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
    /// The supported features of solids.
    pub features: Features,
    /// The stored data.
    pub output: Output,
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
            Pass::Tile => "tile_tree.comp",
            Pass::Copies => "tile_copies.comp",
        }
    }

    /// The macros for its compilation.
    #[must_use]
    pub fn macros(&self) -> Vec<(&'static str, &'static str)> {
        let shaded = self.features == Features::Full;
        let set = [
            (self.table, "SEARCH_TABLE"),
            (self.table && self.bounded, "SEARCH_BOUNDED"),
            (self.features >= Features::Textured, "TEXTURED"),
            (shaded, "REPEATED"),
            (shaded, "SHADOWED"),
        ];
        let set = set.into_iter().filter(|(is_set, _)| *is_set);
        let mut all = vec![("SEARCH", "SEARCH_EXTERNAL")];
        all.extend(set.map(|(_, name)| (name, "1")));
        if self.output == Output::Planes {
            all.push(("OUTPUT", "OUTPUT_PLANES"));
        }
        all
    }

    /// The module's name, without the search's.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{:?}.{:?}.{:?}", self.pass, self.features, self.output).to_lowercase()
    }

    /// Returns true if this module can replace `wanted`: it does at least the same work.
    #[must_use]
    pub fn serves(&self, wanted: &Self) -> bool {
        self.features >= wanted.features
            && (self.pass, self.output, self.table) == (wanted.pass, wanted.output, wanted.table)
    }
}
