//! The variant: everything a pipeline is made for, so that it holds one search and nothing that it
//! does not use.
//!
//! What a parameter moves is data: no value of an offset, a light, a camera or a bound on steps
//! makes another variant. What is left depends on an object's technique, and [`Variant::reachable`]
//! lists all that can follow from it.

use super::generated as g;
use super::list::{Dispatch, Entry, Features, Module, Output, Search};
use crate::maps::{MapFormat, Projection};
use crate::scene::{BumpForm, Lighting, Object, Shadow};
use crate::settings::{Planes, SearchSettings, Solver};

/// Lengths of lists of patches; longer ones are searched by the tree.
pub const LIST_LENGTHS: [u32; g::LIST_LENGTHS as usize] =
    [g::SHORT_LIST, g::MIDDLE_LIST, g::LONG_LIST, g::LONGEST_LIST];

/// What a pipeline draws with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Shape boxes, rasterised.
    Box,
    /// Hulls of patches, rasterised.
    Hull,
    /// Sides of shape boxes where they cut such hulls, in which fragments search as in boxes.
    Sides,
    /// Convex hulls, in which fragments search as in boxes.
    ConvexHull,
    /// Pixels of the compute stage.
    Compute,
    /// Squares of pixels of one copy each, rasterised; fragments search as in boxes.
    Spots,
    /// Squares of pixels of several copies, rasterised; fragments search those listed.
    Bins,
    /// The list of tiles that beams choose.
    Beam,
    /// The same, and the patches that their rays may meet.
    List,
    /// The patches that rays of bins of one copy may meet.
    ListCopies,
    /// Pixels of tiles whose patches are listed.
    Listed,
}

/// What a shadow's ray may meet, which the code of the object that it left must do for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Met {
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
    /// Of the compute stage.
    pub dispatch: Dispatch,
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
    /// One of `REFINEMENT_*`.
    pub refinement: u32,
    /// 0 where nothing was drawn before, of the compute stage.
    pub depth_test: u32,
    /// 0 where nothing will be drawn after, of the compute stage.
    pub depth_keep: u32,
    /// 1 where there may be more than two lights.
    pub more_lights: u32,
    /// Patches that each pixel tests, of those that are listed for its tile; else 0.
    pub list_length: u32,
    /// 1 where tiles are bins of one copy, each of any of a batch's instances.
    pub alone: u32,
    /// Bound of the papers' loop where it is their own, as the baseline must not lose by an option
    /// that it does not take; else 0, and the bound is data.
    pub papers_steps: u32,
    /// 1 where the box cuts nothing of the solid, and the eye is outside of it, as that of hulls and
    /// tiles always is.
    pub outside: u32,
    /// Which part of a solid that its box cuts: one of `CUT_*`.
    pub cut: u32,
}

impl Variant {
    /// The list of tiles.
    pub const BEAM: Self = Self {
        search: Search::None,
        features: Features::Plain,
        output: Output::Color,
        dispatch: Dispatch::Rectangle,
        cells: 0,
        shadow: g::SHADOW_OFF,
        color_map: 0,
        bump: g::BUMP_OFF,
        projection: g::PROJECTION_CYLINDRICAL,
        refinement: g::REFINEMENT_NONE,
        depth_test: 1,
        depth_keep: 1,
        more_lights: 0,
        list_length: 0,
        alone: 0,
        papers_steps: 0,
        outside: 0,
        cut: g::CUT_ANY,
    };

    /// The variant that draws `object` by the search `solver`, which is that of the settings or
    /// stands in for it. Tables are taken to fit into a uniform buffer; in compute the object is
    /// the only one and has one copy.
    #[must_use]
    pub fn new(
        settings: &SearchSettings,
        planes: Planes,
        solver: Solver,
        lighting: &Lighting,
        object: &Object,
        met: Met,
    ) -> Self {
        let texturing = &object.texturing;
        let casts = lighting.shadow != Shadow::Off;
        let cells = u32::from(object.repeat != [1; 3] || (casts && met.repeated));
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
            search: search(
                settings,
                solver,
                is_beveled(object) || (casts && met.beveled),
            ),
            features,
            output,
            dispatch: Dispatch::Rectangle,
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
            refinement: match solver {
                Solver::Relief => g::REFINEMENT_HALVINGS,
                Solver::Secant => g::REFINEMENT_SECANTS,
                _ => g::REFINEMENT_NONE,
            },
            depth_test: 1,
            depth_keep: 1,
            // With shadows all are in one loop.
            more_lights: u32::from(lighting.lights.len() > 2 && !casts),
            list_length: 0,
            alone: 0,
            papers_steps: {
                let own = solver.default_steps(is_beveled(object));
                let papers = solver == Solver::Circle && settings.max_steps.unwrap_or(own) == own;
                // A shadow's ray takes the steps of what it meets.
                if papers && !casts { own } else { 0 }
            },
            outside: 0,
            cut: g::CUT_ANY,
        };
        match planes {
            Planes::Depth { parallel } => shaded.depth_only(parallel),
            _ => shaded,
        }
    }

    /// The same in compute: how pixels are gone through, and whether depths are compared, as there
    /// are several dispatches.
    #[must_use]
    pub fn dispatched(self, dispatch: Dispatch, several: bool) -> Self {
        Self {
            dispatch,
            depth_test: u32::from(several),
            depth_keep: u32::from(several),
            ..self
        }
    }

    /// The same where depths are read afterwards, though nothing is drawn that would compare them.
    #[must_use]
    pub fn keeping(self, keeps: bool) -> Self {
        Self {
            depth_keep: self.depth_keep | u32::from(keeps),
            ..self
        }
    }

    /// The same in compute, of the tiles that beams choose; `cut`: the box's sides cut the solid.
    #[must_use]
    pub fn tiled(self, cut: bool, several: bool) -> Self {
        if cut && !self.search.is_live() {
            let tiled = self.dispatched(Dispatch::Rectangle, several);
            Self {
                cut: g::CUT_TILES,
                ..tiled.seen_from(false)
            }
        } else {
            self.seen_from(false).dispatched(Dispatch::Beams, several)
        }
    }

    /// The same of squares of one copy whose rays are held to a span before they are searched; none
    /// of other searches.
    #[must_use]
    pub fn in_spans(self) -> Option<Self> {
        let spans = self.search == Search::Quadric && self.cells == 0;
        spans.then(|| self.tiled(false, true))
    }

    /// The same of lists of tiles: of those whose patches are listed, by the length of lists, and,
    /// where there is a cut, of those whose rays enter box and solid at once.
    #[must_use]
    pub fn listed(
        self,
        cut: bool,
        several: bool,
    ) -> [Option<(Self, Kind)>; g::TILE_LISTS as usize] {
        let of = |list_length| Self {
            search: Search::Quadric,
            list_length,
            cut: g::CUT_ANY,
            ..self.dispatched(Dispatch::Lists, several).cut_by_sides(cut)
        };
        let solid = self.tiled(true, several).into_solid();
        std::array::from_fn(|list| match LIST_LENGTHS.get(list) {
            Some(length) => Some((of(*length), Kind::Listed)),
            None => cut.then_some((solid, Kind::Compute)),
        })
    }

    /// The same where tiles are bins of one copy, or are not: to be asked for its lists of tiles.
    #[must_use]
    pub fn of_bins(self, bins: bool) -> Self {
        Self {
            alone: u32::from(bins),
            ..self
        }
    }

    /// The same where the search's tables fit into a uniform buffer, or do not; those that read none
    /// take the first.
    #[must_use]
    pub fn with_tables(self, fit: bool) -> Self {
        Self {
            search: self.search.of_tables(fit || self.cut == g::CUT_SOLID),
            ..self
        }
    }

    /// The same as a use of it draws tables that fit into a uniform buffer, or do not; none where it
    /// draws no such tables.
    #[must_use]
    pub fn with_tables_of(self, kind: Kind, fit: bool) -> Option<Self> {
        match kind {
            // These read none of the tree.
            Kind::Hull | Kind::Listed => Some(self.with_tables(true)),
            Kind::Spots if self.dispatch == Dispatch::Beams && !fit => None,
            _ => Some(self.with_tables(fit)),
        }
    }

    /// The same where the eye is outside of the solid, of which the box cuts nothing, or not; one
    /// where that makes no difference.
    #[must_use]
    pub fn seen_from(self, outside: bool) -> Self {
        let searched = matches!(self.search, Search::Quadric | Search::QuadricLarge)
            && matches!(self.dispatch, Dispatch::Rectangle | Dispatch::Bins);
        Self {
            outside: u32::from(outside && searched && self.cells == 0 && self.cut == g::CUT_ANY),
            ..self
        }
    }

    /// The same of a proxy hull, or of tiles, where the box's sides cut the solid or do not.
    #[must_use]
    pub fn cut_by_sides(self, cut: bool) -> Self {
        Self {
            outside: u32::from(!cut),
            ..self
        }
    }

    /// The same of sides of the box, or of tiles, where rays enter box and solid at once: none reads
    /// tables.
    #[must_use]
    pub fn into_solid(self) -> Self {
        let solid = Self {
            cut: g::CUT_SOLID,
            ..self
        };
        solid.with_tables(true)
    }

    /// Whether it draws a hull or tiles of a solid that the box's sides cut.
    #[must_use]
    pub fn is_cut(&self, kind: Kind) -> bool {
        match kind {
            Kind::Sides => true,
            Kind::Hull | Kind::List | Kind::Listed => self.outside == 0,
            Kind::Compute => self.cut != g::CUT_ANY,
            Kind::Box
            | Kind::ConvexHull
            | Kind::Spots
            | Kind::Bins
            | Kind::Beam
            | Kind::ListCopies => false,
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
            dispatch: Dispatch::Rectangle,
            refinement: self.refinement,
            search: self.search,
            ..Self::BEAM
        }
    }

    /// Whether fragments of bins have this search, and what is stored.
    #[must_use]
    pub const fn takes_bins(&self) -> bool {
        self.search.takes_beams() && matches!(self.output, Output::Color | Output::Planes)
    }

    /// The module of the vertices that it is drawn with; none of the compute stage.
    #[must_use]
    pub fn vertices(&self, kind: Kind) -> Option<Module> {
        let entry = match kind {
            Kind::Box => Entry::BoxVertex,
            Kind::Hull if self.outside == 0 => Entry::CutHullVertex,
            Kind::Hull => Entry::HullVertex,
            Kind::Sides => Entry::SidesVertex,
            Kind::Spots => Entry::SpotsVertex,
            Kind::Bins => Entry::BinsVertex,
            Kind::ConvexHull => Entry::ConvexHullVertex,
            Kind::Compute | Kind::Beam | Kind::List | Kind::ListCopies | Kind::Listed => {
                return None;
            }
        };
        Some(self.module(kind).vertices(entry))
    }

    /// The module of its fragments, or of its compute invocations.
    #[must_use]
    pub const fn module(&self, kind: Kind) -> Module {
        let entry = match kind {
            Kind::Beam => return Module::plain(Entry::Beam),
            Kind::List => return Module::plain(Entry::List),
            Kind::ListCopies => return Module::plain(Entry::ListCopies),
            Kind::Box | Kind::ConvexHull | Kind::Sides | Kind::Spots => Entry::Box,
            Kind::Hull => Entry::Hull,
            Kind::Bins => Entry::Bins,
            Kind::Compute => Entry::Trace,
            Kind::Listed => Entry::Listed,
        };
        Module {
            entry,
            search: self.search,
            features: self.features,
            output: self.output,
            dispatch: self.dispatch,
        }
    }

    /// `(constant_id, value)` of every specialisation constant.
    #[must_use]
    pub fn constants(&self) -> [(u32, u32); 14] {
        [
            (g::CELLS_ID, self.cells),
            (g::SHADOW_ID, self.shadow),
            (g::COLOR_MAP_ID, self.color_map),
            (g::BUMP_ID, self.bump),
            (g::PROJECTION_ID, self.projection),
            (g::REFINEMENT_ID, self.refinement),
            (g::DEPTH_TEST_ID, self.depth_test),
            (g::DEPTH_KEEP_ID, self.depth_keep),
            (g::MORE_LIGHTS_ID, self.more_lights),
            (g::LIST_LENGTH_ID, self.list_length),
            (g::ALONE_ID, self.alone),
            (g::PAPERS_STEPS_ID, self.papers_steps),
            (g::OUTSIDE_ID, self.outside),
            (g::CUT_ID, self.cut),
        ]
    }
}

/// The code of a search.
fn search(settings: &SearchSettings, solver: Solver, beveled: bool) -> Search {
    let papers = settings.map_format == MapFormat::Rgba8;
    match solver {
        Solver::Circle => match (papers, beveled) {
            (true, true) => Search::CircleBeveledRgba8,
            (true, false) => Search::CircleRgba8,
            (false, true) => Search::CircleBeveled,
            (false, false) => Search::Circle,
        },
        Solver::Live if papers => Search::LiveRgba8,
        // Where it stands in for another search there is one form of it, the general one.
        Solver::Live if beveled || settings.solver != Solver::Live => Search::LiveBeveled,
        Solver::Live => Search::Live,
        Solver::Linear | Solver::Relief | Solver::Secant if papers => Search::LinearRgba8,
        Solver::Linear | Solver::Relief | Solver::Secant => Search::Linear,
        Solver::Quadric | Solver::Hull => Search::Quadric,
        Solver::Cone => Search::Cone,
        Solver::Relaxed => Search::Relaxed,
    }
}

/// Whether an object's steps must allow for a bevel.
pub(crate) fn is_beveled(object: &Object) -> bool {
    object.offset.bevel != 0.0 && object.offset.chamfer > 0.0
}
