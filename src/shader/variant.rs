//! The variant: everything a pipeline is made for, so that it holds one search and nothing that it
//! does not use.
//!
//! What a parameter moves is data: no value of an offset, a light, a camera or a bound on steps
//! makes another variant. What is left depends on an object's technique, and
//! [`Conditions::reachable`](crate::plan::Conditions::reachable) lists all that can follow from it.

use super::external::External;
use super::generated as g;
use super::list::{Entry, Features, Module, Output, Search};
use crate::maps::{MapFormat, Projection};
use crate::scene::{BumpForm, Lighting, Object, Shadow};
use crate::settings::{Planes, SearchSettings, Solver};

/// What a pipeline draws: a proxy (the first two), or tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Cells with their patches, rasterised; clipped by the box's sides where these cut the solid.
    Cells,
    /// Shape boxes and strips of their sides, rasterised; fragments walk the tree.
    Boxes,
    /// Tiles of one copy each, rasterised; fragments walk the tree.
    Quads,
    /// Compute: lists of the patches that rays of tiles may meet.
    TileLists,
    /// Compute: tiles whose patches are listed.
    TilePatches,
    /// Compute: tiles of one copy, which walk the tree.
    TileTree,
    /// Compute: tiles of several copies.
    TileCopies,
}

impl Kind {
    /// Whether invocations of it walk the tree of patches, or search a map.
    #[must_use]
    pub const fn walks(self) -> bool {
        matches!(
            self,
            Self::Boxes | Self::Quads | Self::TileTree | Self::TileCopies
        )
    }
}

/// What a shadow's ray may meet, which the code of the object that it left must do for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowCasters {
    /// An object with replicas.
    pub repeated: bool,
    /// One with a bevel.
    pub beveled: bool,
}

/// A module, and the values of its specialisation constants; with a [`Kind`] the key of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Which search finds hits.
    pub search: Search,
    /// What a solid may have besides its shape.
    pub features: Features,
    /// What is stored.
    pub output: Output,
    /// 1 where the box holds several replicas.
    pub cells: u32,
    /// One of `SHADOW_*`.
    pub shadow: u32,
    /// 1 where colours come from a map.
    pub color_map: u32,
    /// One of `BUMP_*`.
    pub bump: u32,
    /// One of `PROJECTION_*`.
    pub projection: u32,
    /// The search of another crate, of [`Search::External`].
    pub external: Option<External>,
    /// 0 where nothing was drawn before, of the compute stage.
    pub depth_test: u32,
    /// 0 where nothing will be drawn after, of the compute stage.
    pub depth_keep: u32,
    /// Most lights: 1, 2, or any number, 3. With shadows, whose lights share one loop: 3.
    pub lights: u32,
    /// Patches that each pixel of a listed tile tests; of tiles that walk the tree 1. 0: tiles come
    /// from no list.
    pub list_length: u32,
    /// 1 where the box cuts nothing of the solid and the eye is outside of it; of cells and listed
    /// patches, whose eye always is: where the box cuts nothing.
    pub outside: u32,
    /// 1 where all solids have one table, which a uniform buffer holds.
    pub own_tables: u32,
    /// 1 where there is one solid, which a uniform buffer holds.
    pub one_solid: u32,
    /// 1 where there may be a bevel, of the search for live parameters.
    pub beveled: u32,
}

impl Variant {
    /// Lists of patches.
    pub const LISTS: Self = Self {
        search: Search::None,
        features: Features::Plain,
        output: Output::Color,
        cells: 0,
        shadow: g::SHADOW_OFF,
        color_map: 0,
        bump: g::BUMP_OFF,
        projection: g::PROJECTION_CYLINDRICAL,
        external: None,
        depth_test: 1,
        depth_keep: 1,
        lights: 3,
        list_length: 0,
        outside: 0,
        own_tables: 0,
        one_solid: 0,
        beveled: 0,
    };

    /// The variant that draws `object` by the search `solver`, which is that of the settings or
    /// stands in for it.
    #[must_use]
    pub fn new(
        settings: &SearchSettings,
        planes: Planes,
        solver: Solver,
        lighting: &Lighting,
        object: &Object,
        casters: ShadowCasters,
    ) -> Self {
        let texturing = &object.texturing;
        let casts = lighting.shadow != Shadow::Off;
        let cells = u32::from(object.repeat != [1; 3] || (casts && casters.repeated));
        let shadow = match lighting.shadow {
            Shadow::Off => g::SHADOW_OFF,
            Shadow::Hard => g::SHADOW_HARD,
            Shadow::Soft => g::SHADOW_SOFT,
        };
        let color_map = u32::from(texturing.color_map.is_some());
        let bump = match texturing.bump_form {
            _ if texturing.displacement_map.is_none() => g::BUMP_OFF,
            BumpForm::SurfaceGradient => g::BUMP_SURFACE_GRADIENT,
            BumpForm::Papers => g::BUMP_PAPERS,
        };
        let textured = color_map != 0 || bump != g::BUMP_OFF;
        let features = if cells != 0 || shadow != g::SHADOW_OFF {
            Features::Full
        } else if textured {
            Features::Textured
        } else {
            Features::Plain
        };
        let output = match planes {
            Planes::Color | Planes::Depth { .. } => Output::Color,
            Planes::All => Output::Planes,
        };
        let shaded = Self {
            search: search(settings, solver),
            features,
            output,
            cells,
            shadow,
            color_map,
            bump,
            projection: match texturing.projection {
                // Nothing reads coordinates.
                _ if !textured && output == Output::Color => g::PROJECTION_CYLINDRICAL,
                Projection::Planar => g::PROJECTION_PLANAR,
                Projection::Cylindrical => g::PROJECTION_CYLINDRICAL,
                Projection::Spherical => g::PROJECTION_SPHERICAL,
                Projection::Arc => g::PROJECTION_ARC,
            },
            external: match solver {
                Solver::Other(search) => {
                    let met = casts && casters.beveled;
                    let beveled = is_beveled(object);
                    Some(External::new(search, settings, beveled, met, casts))
                }
                _ => None,
            },
            depth_test: 1,
            depth_keep: 1,
            lights: if casts {
                3
            } else {
                lighting.lights.len().clamp(1, 3) as u32
            },
            list_length: 0,
            outside: 0,
            own_tables: 0,
            one_solid: 0,
            // Where it stands in for another search there is one form of it, the general one.
            beveled: u32::from(
                solver == Solver::Live
                    && (settings.solver != Solver::Live
                        || is_beveled(object)
                        || (casts && casters.beveled)),
            ),
        };
        match planes {
            Planes::Depth { parallel } => shaded.depth_only(parallel),
            _ => shaded,
        }
    }

    /// This variant and those that it becomes when a bevel comes or goes.
    #[must_use]
    pub fn forms(self) -> Vec<Self> {
        let live = matches!(self.search, Search::Live | Search::LiveRgba8);
        let twin = live.then_some(Self {
            beveled: 1 - self.beveled,
            ..self
        });
        let external = self.external.map(External::others).unwrap_or_default();
        let external = external.into_iter().map(|external| Self {
            external: Some(external),
            ..self
        });
        std::iter::once(self).chain(twin).chain(external).collect()
    }

    /// Whether its search walks tables.
    fn reads_tables(&self) -> bool {
        self.search == Search::Quadric || self.external.is_some_and(External::reads_table)
    }

    /// Whether colours are stored, not depths alone.
    #[must_use]
    pub const fn is_shaded(&self) -> bool {
        matches!(self.output, Output::Color | Output::Planes)
    }

    /// The form of this variant that pipelines of `kind` have: constants that the kind does not read
    /// are those of [`Variant::LISTS`], so that equal pipelines have equal keys.
    #[must_use]
    pub fn of_kind(self, kind: Kind) -> Self {
        let walks = kind.walks();
        let on_patches = matches!(kind, Kind::Cells | Kind::TilePatches);
        let of = |reads: bool, value: u32| if reads { value } else { 0 };
        let compute = matches!(kind, Kind::TilePatches | Kind::TileTree | Kind::TileCopies);
        let lists = Self {
            outside: self.outside,
            own_tables: self.own_tables,
            one_solid: self.one_solid,
            ..Self::LISTS
        };
        if kind == Kind::TileLists {
            return lists;
        }
        let tables = (walks && self.reads_tables()) || kind == Kind::TilePatches;
        let tested = self.search == Search::Quadric && self.cells == 0;
        Self {
            outside: of(on_patches || (walks && tested), self.outside),
            own_tables: of(tables, self.own_tables),
            // Lavapipe 22 crashes over shadows where it takes the solid for constants.
            one_solid: of(self.shadow == g::SHADOW_OFF, self.one_solid),
            list_length: match kind {
                Kind::TilePatches => self.list_length,
                Kind::TileTree => self.list_length.min(1),
                _ => 0,
            },
            depth_test: if compute { self.depth_test } else { 1 },
            depth_keep: if compute { self.depth_keep } else { 1 },
            ..self
        }
    }

    /// Depth alone, as a shadow map wants it; `ortho`: along parallel rays. Of boxes and hulls.
    #[must_use]
    fn depth_only(self, ortho: bool) -> Self {
        Self {
            features: if self.cells == 0 {
                Features::Plain
            } else {
                Features::Full
            },
            output: if ortho {
                Output::DepthOrtho
            } else {
                Output::Depth
            },
            cells: self.cells,
            external: self.external,
            beveled: self.beveled,
            search: self.search,
            ..Self::LISTS
        }
    }

    /// The module of the vertices that it is drawn with; none of the compute stage.
    #[must_use]
    pub fn vertices(&self, kind: Kind) -> Option<Module> {
        let entry = match kind {
            Kind::Boxes => Entry::BoxVertex,
            Kind::Cells if self.outside == 0 => Entry::ClippedCellVertex,
            Kind::Cells => Entry::CellVertex,
            Kind::Quads => Entry::QuadVertex,
            Kind::TileLists | Kind::TilePatches | Kind::TileTree | Kind::TileCopies => {
                return None;
            }
        };
        let module = self.module(kind);
        let search = self.external.map_or(module.search, External::vertices);
        Some(Module { search, ..module }.vertices(entry))
    }

    /// The module of its fragments, or of its compute invocations.
    #[must_use]
    pub const fn module(&self, kind: Kind) -> Module {
        let entry = match kind {
            Kind::TileLists => return Module::plain(Entry::TileLists),
            Kind::Boxes | Kind::Quads => Entry::Tree,
            Kind::Cells => Entry::Cells,
            Kind::TilePatches => Entry::TilePatches,
            Kind::TileTree => Entry::TileTree,
            Kind::TileCopies => Entry::TileCopies,
        };
        Module {
            entry,
            search: self.search,
            features: self.features,
            output: self.output,
        }
    }

    /// `(constant_id, value)` of every specialisation constant.
    #[must_use]
    pub fn constants(&self) -> [(u32, u32); 15] {
        let (form, known_steps) = self.external.map_or((0, 0), External::constants);
        [
            (g::REPLICAS_ID, self.cells),
            (g::SHADOW_ID, self.shadow),
            (g::COLOR_MAP_ID, self.color_map),
            (g::BUMP_ID, self.bump),
            (g::PROJECTION_ID, self.projection),
            (g::SEARCH_FORM_ID, form),
            (g::DEPTH_TEST_ID, self.depth_test),
            (g::DEPTH_KEEP_ID, self.depth_keep),
            (g::LIGHTS_ID, self.lights),
            (g::LIST_LENGTH_ID, self.list_length),
            (g::KNOWN_STEPS_ID, known_steps),
            (g::OUTSIDE_ID, self.outside),
            (g::OWN_TABLES_ID, self.own_tables),
            (g::ONE_SOLID_ID, self.one_solid),
            (g::MAY_BEVEL_ID, self.beveled),
        ]
    }
}

/// The code of a search.
fn search(settings: &SearchSettings, solver: Solver) -> Search {
    match solver {
        Solver::Live if settings.map_format == MapFormat::Rgba8 => Search::LiveRgba8,
        Solver::Live => Search::Live,
        Solver::Quadric | Solver::Exact => Search::Quadric,
        Solver::Other(_) => Search::External,
    }
}

/// Whether an object's steps must allow for a bevel.
pub(crate) fn is_beveled(object: &Object) -> bool {
    object.offset.bevel != 0.0 && object.offset.chamfer > 0.0
}
