//! The variant: all inputs of a pipeline, so that the pipeline contains one search and no unused
//! code.
//!
//! Parameters are data: no value of an offset, a light, a camera or a bound on steps makes another
//! variant. The rest depends on an object's technique, and
//! [`Conditions::reachable`](crate::plan::Conditions::reachable) lists all variants that can follow
//! from it.

use super::catalogue::{Entry, Module, Output, Search};
use super::external::External;
use super::generated as g;
use crate::maps::{MapFormat, Projection};
use crate::scene::{BumpForm, Lighting, Object, Shadow, Texturing};
use crate::settings::{Planes, SearchSettings, Solver};
use std::ffi::CStr;

/// The geometry that a pipeline draws: a proxy (the first two), or tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Cells with their patches, rasterised.
    Cells,
    /// Shape boxes, rasterised; fragments walk the tree.
    Boxes,
    /// Quads of tiles, each of one copy, rasterised; fragments walk the tree.
    Quads,
    /// Tiles, rasterised; fragments search the copies in their queues.
    Tiles,
    /// Compute: lists of the patches that rays of tiles may meet.
    TileLists,
    /// Compute: tiles whose patches are listed.
    TilePatches,
    /// Compute: tiles of one copy, which walk the tree.
    TileTree,
    /// Compute: tiles and pixels with queues of copies.
    TileCopies,
}

impl Kind {
    /// Its name in lists of commands.
    #[must_use]
    pub const fn label(self) -> &'static CStr {
        match self {
            Self::Cells => c"revmap cells",
            Self::Boxes => c"revmap boxes",
            Self::Quads => c"revmap quads of tiles",
            Self::Tiles => c"revmap tiles",
            Self::TileLists => c"revmap lists of patches",
            Self::TilePatches => c"revmap tiles of listed patches",
            Self::TileTree => c"revmap tiles of one copy",
            Self::TileCopies => c"revmap tiles of several copies",
        }
    }

    /// True if it lists what other kinds draw.
    #[must_use]
    pub const fn makes_lists(self) -> bool {
        self.entry().makes_lists()
    }

    /// The entry file of its fragments, or of its compute invocations.
    const fn entry(self) -> Entry {
        match self {
            Self::Boxes | Self::Quads => Entry::Tree,
            Self::Cells => Entry::Cells,
            Self::Tiles => Entry::Tiles,
            Self::TileLists => Entry::TileLists,
            Self::TilePatches => Entry::TilePatches,
            Self::TileTree => Entry::TileTree,
            Self::TileCopies => Entry::TileCopies,
        }
    }

    /// True if its invocations walk the tree of patches, or search a map.
    #[must_use]
    pub const fn walks(self) -> bool {
        self.entry().searches()
    }
}

/// Properties of the objects that a shadow's ray may meet. The code of the object at which the ray
/// starts must handle them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowCasters {
    /// An object with replicas.
    pub repeated: bool,
    /// An object with a bevel.
    pub beveled: bool,
}

/// What a host brings to the look of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HostLook {
    /// Its function shades. The function reads texture coordinates, and no light of ours.
    pub shading: bool,
    /// Its image has the colours.
    pub colors: bool,
    /// Its image has the slopes or the heights.
    pub relief: bool,
    /// It has the heights.
    pub heights: bool,
}

/// A module and the values of its specialisation constants. A variant and a [`Kind`] are the key of
/// a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// The search that finds hits.
    pub search: Search,
    /// The stored values of a hit.
    pub output: Output,
    /// 1 if the box holds several replicas.
    pub cells: u32,
    /// One of `SHADOW_*`.
    pub shadow: u32,
    /// 1 if colours come from a map.
    pub color_map: u32,
    /// One of `BUMP_*`.
    pub bump: u32,
    /// One of `PROJECTION_*`.
    pub projection: u32,
    /// The search of another crate, for [`Search::External`].
    pub external: Option<External>,
    /// Compute stage: 0 if each pixel is drawn once, so no depth is compared or kept.
    pub depths: u32,
    /// Upper limit of lights: 1, 2, or 3 for any number. Always 3 with shadows, whose lights share
    /// one loop.
    pub lights: u32,
    /// Patches that each pixel of a listed tile tests.
    pub list_length: u32,
    /// 1 if the box cuts nothing of the solid, or of these cells, and rays from the eye begin outside.
    pub outside: u32,
    /// 1 if the draw has one object, and a uniform buffer holds its tables, those of all levels.
    pub own_tables: u32,
    /// 1 if there is one object, and a uniform buffer holds it.
    pub one_object: u32,
    /// 1 if there is one instance of it. Compute stage.
    pub one_instance: u32,
    /// Searches on the map: 1 if there may be a bevel.
    pub beveled: u32,
    /// Searches on the map: 1 if that is the papers' texture of unsigned distances.
    pub rgba8: u32,
    /// Only depth: 1 if rays are parallel.
    pub ortho: u32,
}

/// The form of an object's bumps, `BUMP_*`.
fn bump_of(texturing: &Texturing, host: HostLook) -> u32 {
    let form = match texturing.bump_form {
        BumpForm::SurfaceGradient => g::BUMP_SURFACE_GRADIENT,
        BumpForm::Papers => g::BUMP_PAPERS,
    };
    match (host.relief, host.heights) {
        (false, _) if texturing.displacement_map.is_none() => g::BUMP_OFF,
        (_, true) => form | g::BUMP_HEIGHTS,
        _ => form,
    }
}

impl Variant {
    /// The variant that makes lists of patches.
    pub const LISTS: Self = Self {
        search: Search::None,
        output: Output::Color,
        cells: 0,
        shadow: g::SHADOW_OFF,
        color_map: 0,
        bump: g::BUMP_OFF,
        projection: g::PROJECTION_CYLINDRICAL,
        external: None,
        depths: 1,
        lights: 3,
        list_length: 0,
        outside: 0,
        own_tables: 0,
        one_object: 0,
        one_instance: 0,
        beveled: 0,
        rgba8: 0,
        ortho: 0,
    };

    /// The variant that draws `object` by the search `solver`, which is the search of the settings
    /// or a replacement for it.
    #[must_use]
    pub fn new(
        settings: &SearchSettings,
        planes: Planes,
        solver: Solver,
        lighting: &Lighting,
        object: &Object,
        casters: ShadowCasters,
        host: HostLook,
    ) -> Self {
        let texturing = &object.texturing;
        let casts = lighting.shadow != Shadow::Off;
        let cells = u32::from(object.repeat != [1; 3] || (casts && casters.repeated));
        let shadow = match lighting.shadow {
            Shadow::Off => g::SHADOW_OFF,
            Shadow::Hard => g::SHADOW_HARD,
            Shadow::Soft => g::SHADOW_SOFT,
        };
        let color_map = u32::from(host.colors || texturing.color_map.is_some());
        let bump = bump_of(texturing, host);
        let textured = color_map != 0 || bump != g::BUMP_OFF;
        let (output, ortho) = match planes {
            Planes::Color => (Output::Color, false),
            Planes::All => (Output::Planes, false),
            Planes::List(_) => (Output::List, false),
            Planes::Depth { parallel } => (Output::Depth, parallel),
        };
        let is_beveled = is_beveled(object);
        // The replacement for another search has only the general form.
        let replaces = solver == Solver::Live && settings.solver != Solver::Live;
        let may_bevel = replaces || is_beveled || (casts && casters.beveled);
        let of_map = |is: bool| u32::from(solver.reads_map() && is);
        let variant = Self {
            search: match solver {
                Solver::Live => Search::Live,
                Solver::Quadric | Solver::Exact => Search::Quadric,
                Solver::Other(_) => Search::External,
            },
            output,
            cells,
            external: (solver.external())
                .map(|search| External::new(search, settings, is_beveled, casts)),
            beveled: of_map(may_bevel),
            rgba8: of_map(settings.map_format == MapFormat::Rgba8),
            ortho: u32::from(ortho),
            ..Self::LISTS
        };
        if output == Output::Depth {
            return variant;
        }
        Self {
            shadow,
            color_map,
            bump,
            projection: match texturing.projection {
                // No code reads coordinates.
                _ if !textured && !host.shading && output != Output::Planes => {
                    g::PROJECTION_CYLINDRICAL
                }
                Projection::Planar => g::PROJECTION_PLANAR,
                Projection::Cylindrical => g::PROJECTION_CYLINDRICAL,
                Projection::Spherical => g::PROJECTION_SPHERICAL,
                Projection::Arc => g::PROJECTION_ARC,
            },
            lights: if casts {
                3
            } else if host.shading {
                1
            } else {
                lighting.lights.len().clamp(1, 3) as u32
            },
            ..variant
        }
    }

    /// This variant and the variants that replace it when a bevel is added or removed.
    #[must_use]
    pub fn forms(self) -> Vec<Self> {
        let beveled = 1 - self.beveled;
        let twin = |external| Self {
            beveled,
            external,
            ..self
        };
        let mut all = vec![self];
        match self.external {
            _ if self.reads_tables() => {}
            None => all.push(twin(None)),
            Some(one) => all.extend(one.forms(beveled != 0).map(|one| twin(Some(one)))),
        }
        all
    }

    /// True if it draws neither replicas nor shadows.
    pub const fn is_single(&self) -> bool {
        self.cells == 0 && self.shadow == g::SHADOW_OFF
    }

    /// True if its search walks tables.
    fn reads_tables(&self) -> bool {
        self.search == Search::Quadric || self.external.is_some_and(External::reads_table)
    }

    /// True if colours are stored, not only depths.
    #[must_use]
    pub const fn is_shaded(&self) -> bool {
        !matches!(self.output, Output::Depth)
    }

    /// The form of this variant for pipelines of `kind`. Constants that the kind does not read have
    /// the values of [`Variant::LISTS`], so that equal pipelines have equal keys.
    #[must_use]
    pub fn of_kind(self, kind: Kind) -> Self {
        let walks = kind.walks();
        let on_patches = matches!(kind, Kind::Cells | Kind::TilePatches);
        let of = |reads: bool, value: u32| if reads { value } else { 0 };
        let of_copy = matches!(kind, Kind::TilePatches | Kind::TileTree);
        let compute = of_copy || kind == Kind::TileCopies;
        let lists = Self {
            outside: self.outside,
            own_tables: self.own_tables,
            one_object: self.one_object,
            one_instance: self.one_instance & self.one_object,
            ..Self::LISTS
        };
        if kind.makes_lists() {
            return match kind {
                Kind::TileLists => lists,
                _ => Self::LISTS,
            };
        }
        let tables = (walks && self.reads_tables()) || kind == Kind::TilePatches;
        let tested = self.search == Search::Quadric && self.cells == 0;
        let one_object = of(self.shadow == g::SHADOW_OFF, self.one_object);
        Self {
            outside: of(on_patches || (walks && tested), self.outside),
            own_tables: of(tables, self.own_tables),
            // Lavapipe 22 crashes in shadows if it treats the solid as constants.
            one_object,
            one_instance: of(of_copy, self.one_instance & one_object),
            list_length: of(kind == Kind::TilePatches, self.list_length),
            depths: if compute { self.depths } else { 1 },
            ..self
        }
    }

    /// The module of its vertices, before [`with_outputs_for`](super::with_outputs_for) its
    /// fragments; none in the compute stage.
    #[must_use]
    pub fn vertices(&self, kind: Kind) -> Option<Module> {
        let entry = match kind {
            Kind::Boxes => Entry::BoxVertex,
            Kind::Cells => Entry::CellVertex,
            Kind::Quads => Entry::QuadVertex,
            Kind::Tiles => Entry::TileVertex,
            _ => return None,
        };
        Some(Module::plain(entry))
    }

    /// The module of its fragments, or of its compute invocations.
    #[must_use]
    pub const fn module(&self, kind: Kind) -> Module {
        let entry = kind.entry();
        if entry.makes_lists() {
            return Module::plain(entry);
        }
        Module {
            entry,
            search: self.search,
            output: self.output,
        }
    }

    /// `(constant_id, value)` of every specialisation constant.
    #[must_use]
    pub fn constants(&self) -> [(u32, u32); 17] {
        let (form, known_steps) = self.external.map_or((0, 0), External::constants);
        [
            (g::REPLICAS_ID, self.cells),
            (g::SHADOW_ID, self.shadow),
            (g::COLOR_MAP_ID, self.color_map),
            (g::BUMP_ID, self.bump),
            (g::PROJECTION_ID, self.projection),
            (g::SEARCH_FORM_ID, form),
            (g::DEPTHS_ID, self.depths),
            (g::LIGHTS_ID, self.lights),
            (g::LIST_LENGTH_ID, self.list_length),
            (g::KNOWN_STEPS_ID, known_steps),
            (g::OUTSIDE_ID, self.outside),
            (g::OWN_TABLES_ID, self.own_tables),
            (g::ONE_OBJECT_ID, self.one_object),
            (g::ONE_INSTANCE_ID, self.one_instance),
            (g::BEVELED_ID, self.beveled),
            (g::RGBA8_ID, self.rgba8),
            (g::ORTHO_ID, self.ortho),
        ]
    }
}

/// True if an object's steps must allow for a bevel.
pub(crate) fn is_beveled(object: &Object) -> bool {
    object.offset.bevel != 0.0 && object.offset.chamfer > 0.0
}
