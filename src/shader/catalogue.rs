//! The catalogue of SPIR-V modules: every entry file with every set of macros that some pipeline needs.
//! `build.rs` compiles them, and pipelines find modules in it. The file therefore names GLSL
//! macros and has no dependencies.

/// An entry file of `shaders-glsl/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entry {
    /// Corners of shape boxes.
    BoxVertex,
    /// Corners of cells.
    CellVertex,
    /// Quads of tiles.
    QuadVertex,
    /// Corners of tiles.
    TileVertex,
    /// Fragments of cells.
    Cells,
    /// Fragments of tiles.
    Tiles,
    /// Records of the copies of crowds.
    CrowdCopies,
    /// Copies of crowds in tiles.
    CrowdTiles,
    /// Copies of crowds in order, and their records.
    CrowdOrder,
    /// Fragments of boxes and quads, which walk the tree.
    Tree,
    /// Lists of the patches that rays of tiles may meet.
    TileLists,
    /// Pixels of tiles whose patches are listed.
    TilePatches,
    /// Pixels of tiles of one copy, which walk the tree.
    TileTree,
    /// Pixels of tiles of several copies.
    TileCopies,
}

impl Entry {
    /// The name of its file.
    #[must_use]
    pub const fn file(self) -> &'static str {
        match self {
            Self::BoxVertex => "proxy_boxes.vert",
            Self::CellVertex => "proxy_cells.vert",
            Self::QuadVertex => "tile_quads.vert",
            Self::TileVertex => "tiles.vert",
            Self::Cells => "cells.frag",
            Self::Tiles => "tiles.frag",
            Self::CrowdCopies => "crowd_copies.comp",
            Self::CrowdTiles => "crowd_tiles.comp",
            Self::CrowdOrder => "crowd_order.comp",
            Self::Tree => "tree.frag",
            Self::TileLists => "tile_lists.comp",
            Self::TilePatches => "tile_patches.comp",
            Self::TileTree => "tile_tree.comp",
            Self::TileCopies => "tile_copies.comp",
        }
    }

    /// True if it lists what other entries draw.
    #[must_use]
    pub const fn makes_lists(self) -> bool {
        matches!(
            self,
            Self::TileLists | Self::CrowdCopies | Self::CrowdTiles | Self::CrowdOrder
        )
    }

    /// True if its invocations shade hits. Build scripts do not call this.
    #[must_use]
    #[allow(dead_code)]
    pub const fn shades(self) -> bool {
        matches!(self, Self::Cells | Self::TilePatches) || self.searches()
    }

    /// True if its invocations search with code that another crate may provide. Build scripts do
    /// not call this.
    #[must_use]
    #[allow(dead_code)]
    pub const fn searches(self) -> bool {
        matches!(
            self,
            Self::Tree | Self::Tiles | Self::TileTree | Self::TileCopies
        )
    }
}

/// The code that finds where rays meet a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Search {
    /// No search: vertices, lists of patches.
    None,
    /// A search of another crate, which has its own modules. Only the vertices for a search with a
    /// table and a bound on steps are in the catalogue.
    External,
    /// The search for live parameters.
    Live,
    /// The search for live parameters, on the papers' texture.
    LiveRgba8,
    /// Patches of quadrics in a tree. Fragments of cells solve their patches without the tree;
    /// shadows on them use the tree.
    Quadric,
}

/// Features of a solid other than its shape; each includes the ones before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Features {
    /// One colour, one solid in its box, no shadows.
    Plain,
    /// Maps of colour and bumps.
    Textured,
    /// Replicas and shadows.
    Full,
}

/// The stored values of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
    /// Only colour.
    Color,
    /// Every plane of a frame.
    Planes,
    /// The planes of a host's list.
    List,
    /// Only depth.
    Depth,
    /// Only depth, along parallel rays.
    DepthOrtho,
}

/// One module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Module {
    /// The entry file.
    pub entry: Entry,
    /// The search that it contains.
    pub search: Search,
    /// The other features.
    pub features: Features,
    /// The values that it stores.
    pub output: Output,
}

impl Module {
    /// A module without options.
    #[must_use]
    pub const fn plain(entry: Entry) -> Self {
        Self {
            entry,
            search: Search::None,
            features: Features::Plain,
            output: Output::Color,
        }
    }

    /// The least general module that can replace this one, of those for which `is_there` is true.
    #[must_use]
    pub fn covered_by(self, is_there: impl Fn(&Self) -> bool) -> Option<Self> {
        [Features::Plain, Features::Textured, Features::Full]
            .into_iter()
            .filter(|features| *features >= self.features)
            .map(|features| Self { features, ..self })
            .find(is_there)
    }

    /// The module of vertices `entry` that pass exactly the inputs of these fragments.
    #[must_use]
    pub fn vertices(&self, entry: Entry) -> Self {
        use Search as S;
        let search = match self.search {
            _ if matches!(entry, Entry::CellVertex | Entry::TileVertex) => S::None,
            S::Quadric => S::Quadric,
            S::External => S::External,
            _ => S::Live,
        };
        let shaded = self.output <= Output::List;
        Self {
            search,
            output: if shaded { Output::Color } else { Output::Depth },
            ..Self::plain(entry)
        }
    }

    /// The macros for compiling the GLSL; missing ones are 0. Only `build.rs` calls this.
    #[must_use]
    #[allow(dead_code)]
    pub fn macros(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = match self.search {
            Search::None => vec![],
            Search::External => vec![
                ("SEARCH", "SEARCH_EXTERNAL"),
                ("SEARCH_TABLE", "1"),
                ("SEARCH_BOUNDED", "1"),
            ],
            Search::Live => vec![("SEARCH", "SEARCH_LIVE")],
            Search::LiveRgba8 => vec![("SEARCH", "SEARCH_LIVE"), ("RGBA8", "1")],
            Search::Quadric => vec![("SEARCH", "SEARCH_QUADRIC")],
        };
        if self.features >= Features::Textured {
            all.push(("TEXTURED", "1"));
        }
        if self.features == Features::Full {
            all.push(("REPEATED", "1"));
            if self.output <= Output::List {
                all.push(("SHADOWED", "1"));
            }
        }
        match self.output {
            Output::Color => {}
            Output::Planes => all.push(("OUTPUT", "OUTPUT_PLANES")),
            Output::List => all.push(("OUTPUT", "OUTPUT_LIST")),
            Output::Depth => all.push(("OUTPUT", "OUTPUT_DEPTH")),
            Output::DepthOrtho => all.extend([("OUTPUT", "OUTPUT_DEPTH"), ("ORTHO", "1")]),
        }
        all
    }

    /// The name: the entry file, then the options that distinguish it from other modules of that
    /// file.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = self.entry.file().to_owned();
        let add = |name: &mut String, part: &dyn std::fmt::Debug| {
            name.push('.');
            name.push_str(&format!("{part:?}").to_lowercase());
        };
        if self.search != Search::None {
            add(&mut name, &self.search);
        }
        if !self.entry.makes_lists() {
            add(&mut name, &self.features);
            add(&mut name, &self.output);
        }
        name
    }
}

/// Searches that the fragment and compute stages have.
const SEARCHES: [Search; 3] = [Search::Live, Search::LiveRgba8, Search::Quadric];

/// True if a search has a module with these features and this output. More general modules draw
/// rare cases that are not plain.
fn has(search: Search, features: Features, output: Output) -> bool {
    let main = matches!(search, Search::Live | Search::Quadric);
    match (output, features) {
        (Output::Color, Features::Plain) => true,
        (Output::Color, Features::Textured) | (Output::Planes, Features::Plain) => main,
        (Output::Planes, Features::Textured) | (Output::List, Features::Plain) => false,
        (Output::List, _) => main,
        (Output::Color | Output::Planes, Features::Full) => true,
        (Output::Depth | Output::DepthOrtho, features) => main && features != Features::Textured,
    }
}

/// The modules of a stage in which a host's function may shade: colour alone, or planes of a list. All
/// have texture coordinates, and none has shadows. Build scripts do not call this.
#[must_use]
#[allow(dead_code)]
pub fn shading_modules(compute: bool) -> Vec<Module> {
    let in_pass = |entry| matches!(entry, Entry::Tree | Entry::Cells | Entry::Tiles);
    let mut all = modules();
    all.retain(|m| {
        m.entry.shades()
            && in_pass(m.entry) != compute
            && m.search != Search::LiveRgba8
            && m.features >= Features::Textured
            && matches!(m.output, Output::Color | Output::List)
    });
    all
}

/// The macros with which one of these modules is compiled.
#[must_use]
#[allow(dead_code)]
pub fn shading_macros(module: &Module) -> Vec<(&'static str, &'static str)> {
    let mut all = module.macros();
    all.retain(|(name, _)| *name != "SHADOWED");
    all.push(("HOST_SHADING", "1"));
    all
}

/// Every module, in order.
#[must_use]
pub fn modules() -> Vec<Module> {
    use Output as O;
    let lists = [
        Entry::TileLists,
        Entry::CrowdCopies,
        Entry::CrowdTiles,
        Entry::CrowdOrder,
    ];
    let mut all = lists.map(Module::plain).to_vec();
    for output in [O::Color, O::Depth] {
        let mut vertex = |entry, search| {
            all.push(Module {
                search,
                output,
                ..Module::plain(entry)
            });
        };
        vertex(Entry::CellVertex, Search::None);
        for search in [Search::Live, Search::Quadric] {
            vertex(Entry::BoxVertex, search);
            if output == O::Color {
                vertex(Entry::QuadVertex, search);
            }
        }
        if output == O::Color {
            vertex(Entry::BoxVertex, Search::External);
            vertex(Entry::QuadVertex, Search::External);
            vertex(Entry::TileVertex, Search::None);
        }
    }
    for output in [O::Color, O::Planes, O::List, O::Depth, O::DepthOrtho] {
        let shaded = output <= O::List;
        let compute = output <= O::Planes;
        for features in [Features::Plain, Features::Textured, Features::Full] {
            let mut add = |entry, search| {
                all.push(Module {
                    entry,
                    search,
                    features,
                    output,
                });
            };
            // Shadows and replicas walk the tree.
            let on_patches = output == O::Planes || features != Features::Full;
            for search in SEARCHES.into_iter().filter(|s| has(*s, features, output)) {
                add(Entry::Tree, search);
                if compute {
                    add(Entry::TileTree, search);
                    add(Entry::TileCopies, search);
                }
                if compute && on_patches && search == Search::Quadric {
                    add(Entry::TilePatches, search);
                }
            }
            // Queues of replicas, and under shadows, are left to quads.
            let textured = features == Features::Textured;
            let plain = features == Features::Plain && output != O::List;
            if shaded && (plain || textured) {
                add(Entry::Tiles, Search::Quadric);
            }
            let shown = (shaded && on_patches) || features == Features::Plain;
            if has(Search::Quadric, features, output) && shown {
                add(Entry::Cells, Search::Quadric);
            }
        }
    }
    all
}
