//! Which modules a search is compiled to. Build scripts include this file, so it depends on nothing.

/// Where a module traces rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pass {
    /// In fragments of shape boxes and of tiles.
    Fragment,
    /// In compute, through tiles of pixels, each of one copy.
    Tile,
    /// In compute, through tiles of pixels, each with a list of copies.
    Copies,
}

/// What a solid may have besides its shape; each holds what stands before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Features {
    /// One colour, one solid in its box, no shadows.
    Plain,
    /// Maps of colour and bumps.
    Textured,
    /// Replicas and shadows.
    Full,
}

/// What is stored of a hit.
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
    /// Where rays are traced.
    pub pass: Pass,
    /// What solids may have.
    pub features: Features,
    /// What is stored.
    pub output: Output,
    /// Whether it reads a table of its own, not the shape map.
    pub table: bool,
    /// Whether there is a bound on its steps.
    pub bounded: bool,
    /// Whether there may be a bevel.
    pub beveled: bool,
    /// Whether the map is the papers' texture of unsigned distances, 8 bits a channel.
    pub rgba8: bool,
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

    /// What it is compiled with.
    #[must_use]
    pub fn macros(&self) -> Vec<(&'static str, &'static str)> {
        let shaded = self.features == Features::Full;
        let set = [
            (self.table, "SEARCH_TABLE"),
            (self.table && self.bounded, "SEARCH_BOUNDED"),
            (self.rgba8, "RGBA8"),
            (self.features >= Features::Textured, "TEXTURED"),
            (shaded, "REPEATED"),
            (shaded, "SHADOWED"),
        ];
        let set = set.into_iter().filter(|(is_set, _)| *is_set);
        let beveled = if self.beveled { "1" } else { "0" };
        let mut all = vec![("SEARCH", "SEARCH_EXTERNAL"), ("BEVELED", beveled)];
        all.extend(set.map(|(_, name)| (name, "1")));
        if self.output == Output::Planes {
            all.push(("OUTPUT", "OUTPUT_PLANES"));
        }
        all
    }

    /// Its name, without the search's.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = format!("{:?}.{:?}.{:?}", self.pass, self.features, self.output);
        for (is, part) in [(self.beveled, ".beveled"), (self.rgba8, ".rgba8")] {
            name += if is { part } else { "" };
        }
        name.to_lowercase()
    }

    /// Whether it does the work of `wanted`, and more perhaps.
    #[must_use]
    pub fn serves(&self, wanted: &Self) -> bool {
        self.features >= wanted.features
            && self.beveled >= wanted.beveled
            && (self.pass, self.output) == (wanted.pass, wanted.output)
            && (self.table, self.rgba8) == (wanted.table, wanted.rgba8)
    }
}
