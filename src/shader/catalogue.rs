//! The catalogue of SPIR-V modules: every entry file with every set of macros that some pipeline needs.
//! `build.rs` compiles them, and pipelines find modules in it. The file therefore names GLSL
//! macros and depends on nothing.

/// An entry file of `shaders-glsl/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entry {
    /// Corners of shape boxes.
    BoxVertex,
    /// Corners of cells.
    CellVertex,
    /// Fragments of cells.
    Cells,
    /// Fragments of boxes, which walk the tree.
    Tree,
    /// Lists of the patches that rays of tiles may meet.
    TileLists,
    /// Pixels of tiles whose patches are listed.
    TilePatches,
    /// Pixels of a solid of one copy, whose work groups cull its patches.
    CulledTiles,
    /// Places of copies in a view.
    Place,
    /// Lists of the first copies that rays of tiles may meet.
    WalkLists,
    /// Tiles of the picture, each with the first copies of a walk.
    WalkVertex,
    /// Fragments that walk a hierarchy of copies.
    Walk,
    /// Pixels that walk a hierarchy of copies.
    WalkTiles,
    /// The same of copies that may hold replicas, for patches. Searches on maps have one module for
    /// both.
    WalkReplicas,
}

impl Entry {
    /// The name of its file.
    #[must_use]
    pub const fn file(self) -> &'static str {
        match self {
            Self::BoxVertex => "proxy_boxes.vert",
            Self::CellVertex => "proxy_cells.vert",
            Self::Cells => "cells.frag",
            Self::Tree => "tree.frag",
            Self::TileLists => "tile_lists.comp",
            Self::TilePatches => "tile_patches.comp",
            Self::CulledTiles => "culled_tiles.comp",
            Self::Place => "place.comp",
            Self::WalkLists => "walk_lists.comp",
            Self::WalkVertex => "walk.vert",
            Self::Walk => "walk.frag",
            Self::WalkTiles | Self::WalkReplicas => "walk.comp",
        }
    }

    /// True if it makes what other entries draw from.
    #[must_use]
    pub const fn makes_lists(self) -> bool {
        matches!(self, Self::TileLists | Self::WalkLists | Self::Place)
    }

    /// True if its invocations shade hits. Build scripts do not call this.
    #[must_use]
    #[allow(dead_code)]
    pub const fn shades(self) -> bool {
        let patches = matches!(self, Self::Cells | Self::TilePatches | Self::CulledTiles);
        patches || self.searches()
    }

    /// True if its invocations search with code that another crate may provide. Build scripts do
    /// not call this.
    #[must_use]
    #[allow(dead_code)]
    pub const fn searches(self) -> bool {
        matches!(
            self,
            Self::Tree | Self::Walk | Self::WalkTiles | Self::WalkReplicas
        )
    }
}

/// The code that finds where rays meet a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SearchCode {
    /// No search: vertices, lists of patches.
    None,
    /// A search of another crate, which has its own modules.
    External,
    /// The search for live parameters.
    Live,
    /// Patches of quadrics in a tree. Fragments of cells solve their patches without the tree;
    /// rays that pass a side of the box use the tree.
    Quadric,
}

/// The stored values of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stored {
    /// Only colour, in compute and by searches of other crates.
    Color,
    /// Every plane of a frame.
    Planes,
    /// The planes of a list. In fragments also colour alone.
    List,
    /// Only depth.
    Depth,
}

/// One module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Module {
    /// The entry file.
    pub entry: Entry,
    /// The search that it contains.
    pub search: SearchCode,
    /// The values that it stores.
    pub output: Stored,
}

impl Module {
    /// A module without options.
    #[must_use]
    pub const fn plain(entry: Entry) -> Self {
        Self {
            entry,
            search: SearchCode::None,
            output: Stored::Color,
        }
    }

    /// The macros for compiling the GLSL; missing ones are 0. Only `build.rs` calls this.
    #[must_use]
    #[allow(dead_code)]
    pub fn macros(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = match self.search {
            SearchCode::None | SearchCode::External => vec![],
            SearchCode::Live => vec![("SEARCH", "SEARCH_LIVE")],
            SearchCode::Quadric => vec![("SEARCH", "SEARCH_QUADRIC")],
        };
        if self.entry == Entry::WalkReplicas || self.search == SearchCode::Live {
            all.push(("REPEATED", "1"));
        }
        match self.output {
            Stored::Color => {}
            Stored::Planes => all.push(("OUTPUT", "OUTPUT_PLANES")),
            Stored::List => all.push(("OUTPUT", "OUTPUT_LIST")),
            Stored::Depth => all.push(("OUTPUT", "OUTPUT_DEPTH")),
        }
        all
    }

    /// The name: the entry file, then the options that distinguish it from other modules of that
    /// file.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = self.entry.file().to_owned();
        if self.entry == Entry::WalkReplicas {
            name.push_str(".replicas");
        }
        let add = |name: &mut String, part: &dyn std::fmt::Debug| {
            name.push('.');
            name.push_str(&format!("{part:?}").to_lowercase());
        };
        if self.search != SearchCode::None {
            add(&mut name, &self.search);
            add(&mut name, &self.output);
        }
        name
    }
}

/// The modules of a stage in which a host's function may shade: colour alone, or planes of a list.
/// Build scripts do not call this.
#[must_use]
#[allow(dead_code)]
pub fn shading_modules(compute: bool) -> Vec<Module> {
    let in_pass = |entry: Entry| entry.file().ends_with(".frag");
    let mut all = modules();
    all.retain(|m| {
        m.entry.shades()
            && in_pass(m.entry) != compute
            && matches!(m.output, Stored::Color | Stored::List)
    });
    all
}

/// The macros with which one of these modules is compiled.
#[must_use]
#[allow(dead_code)]
pub fn shading_macros(module: &Module) -> Vec<(&'static str, &'static str)> {
    let mut all = module.macros();
    all.push(("HOST_SHADING", "1"));
    all
}

/// Every module, in order.
#[must_use]
pub fn modules() -> Vec<Module> {
    use Stored::{Color, Depth, List, Planes};
    let plain = [
        Entry::TileLists,
        Entry::Place,
        Entry::WalkLists,
        Entry::BoxVertex,
        Entry::CellVertex,
        Entry::WalkVertex,
    ];
    let mut all = plain.map(Module::plain).to_vec();
    let both: &[SearchCode] = &[SearchCode::Live, SearchCode::Quadric];
    let patches: &[SearchCode] = &[SearchCode::Quadric];
    let rows: [(Entry, &[SearchCode], &[Stored]); 7] = [
        (Entry::Tree, both, &[Planes, List, Depth]),
        (Entry::TilePatches, patches, &[Color, Planes]),
        (Entry::CulledTiles, patches, &[Color, Planes]),
        (Entry::Cells, patches, &[Planes, List, Depth]),
        (Entry::Walk, patches, &[Planes, List, Depth]),
        (Entry::WalkTiles, both, &[Color, Planes]),
        (Entry::WalkReplicas, patches, &[Color, Planes]),
    ];
    for (entry, searches, outputs) in rows {
        for (&search, &output) in searches
            .iter()
            .flat_map(|s| outputs.iter().map(move |o| (s, o)))
        {
            all.push(Module {
                entry,
                search,
                output,
            });
        }
    }
    all
}
