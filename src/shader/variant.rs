//! The variant: all inputs of a pipeline. It has two parts. The [`Technique`] is what an object, its
//! search and the output demand. The [`Speciality`] only makes the pipeline faster. The general
//! variant of a technique is right for everything that the technique draws, so a frame may take it
//! whenever a special one is not compiled.

use super::catalogue::{Entry, Module, Output, Search};
use super::external::External;
use super::generated as g;
use super::technique::Technique;
use std::ffi::CStr;

/// The geometry that a pipeline draws: a proxy (the first three), or tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Cells with their patches, rasterised.
    Cells,
    /// Cells that a side of the box may cut.
    CutCells,
    /// Shape boxes, rasterised; fragments walk the tree.
    Boxes,
    /// Quads of tiles, each of one copy, rasterised; fragments walk the tree.
    Quads,
    /// Tiles, rasterised; fragments search the copies in their queues.
    Tiles,
    /// Compute: lists of the patches that rays of tiles may meet.
    TileLists,
    /// Compute: tiles whose patches are listed; each pixel tests this many.
    TilePatches(u32),
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
            Self::CutCells => c"revmap cut cells",
            Self::Boxes => c"revmap boxes",
            Self::Quads => c"revmap quads of tiles",
            Self::Tiles => c"revmap tiles",
            Self::TileLists => c"revmap lists of patches",
            Self::TilePatches(_) => c"revmap tiles of listed patches",
            Self::TileTree => c"revmap tiles of one copy",
            Self::TileCopies => c"revmap tiles of several copies",
        }
    }

    /// True if it draws in compute.
    #[must_use]
    pub const fn is_compute(self) -> bool {
        matches!(
            self,
            Self::TilePatches(_) | Self::TileTree | Self::TileCopies
        )
    }

    /// Patches that each pixel tests; the longest list for other kinds.
    const fn list_length(self) -> u32 {
        match self {
            Self::TilePatches(length) => length,
            _ => g::LONGEST_LIST,
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
            Self::Cells | Self::CutCells => Entry::Cells,
            Self::Tiles => Entry::Tiles,
            Self::TileLists => Entry::TileLists,
            Self::TilePatches(_) => Entry::TilePatches,
            Self::TileTree => Entry::TileTree,
            Self::TileCopies => Entry::TileCopies,
        }
    }

    /// True if its invocations walk the tree of patches, or search a map.
    #[cfg(test)]
    pub const fn walks(self) -> bool {
        self.entry().searches()
    }
}

/// What makes a pipeline faster for some frames. Every value but that of [`Speciality::GENERAL`]
/// promises something of the draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Speciality {
    /// Upper limit of lights: 1, 2, or 3 for any number. Always 3 with shadows, whose lights share
    /// one loop.
    pub lights: u32,
    /// 1 if the draw has one object, and uniform buffers hold its block and the tables of all its
    /// levels; 2 if it has one copy, too.
    pub one_object: u32,
    /// 1 if the boxes of all objects cut nothing of them, and rays from the eye begin outside of them;
    /// 2 if that is true of no object.
    pub outside: u32,
    /// Compute stage: 0 if each pixel is drawn once, so no depth is compared or kept.
    pub depths: u32,
}

/// The names of the members of [`Speciality`], in order.
#[cfg(feature = "other-shaders")]
pub(crate) const SPECIALITIES: [&str; 4] = ["lights", "one-object", "outside", "depths"];

/// The value of [`Speciality::outside`] for draws without an object that is seen from outside.
const NOT_OUTSIDE: u32 = 2;

/// Lights of the form that is compiled beside the general one: a loop over more of them takes half of
/// a frame even if it has no turn.
pub const FEW_LIGHTS: u32 = 2;

/// The bit of [`Speciality::lights`] in a set.
const LIGHTS_BIT: u32 = 1;

impl Speciality {
    /// The members of a set, with bits in the order of the members; the others promise nothing.
    fn only(self, set: u32) -> Self {
        let general = Self::GENERAL;
        let of = |bit: u32, own: u32, general: u32| if set >> bit & 1 != 0 { own } else { general };
        Self {
            lights: of(0, self.lights, general.lights),
            one_object: of(1, self.one_object, general.one_object),
            outside: of(2, self.outside, general.outside),
            depths: of(3, self.depths, general.depths),
        }
    }

    /// Promises nothing.
    pub const GENERAL: Self = Self {
        lights: 3,
        one_object: 0,
        outside: 0,
        depths: 1,
    };
}

/// A technique and a speciality. A variant and a [`Kind`] are the key of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// What is demanded.
    pub technique: Technique,
    /// What is promised.
    pub speciality: Speciality,
}

impl Variant {
    /// The variant of a technique that promises nothing.
    #[must_use]
    pub const fn general(technique: Technique) -> Self {
        Self {
            technique,
            speciality: Speciality::GENERAL,
        }
    }

    /// This variant for objects of which [`FramePlan::outside`](crate::plan::FramePlan::outside) is
    /// this.
    #[must_use]
    pub const fn seen_from_outside(mut self, outside: bool) -> Self {
        self.speciality.outside = if outside { 1 } else { NOT_OUTSIDE };
        self
    }

    /// The form of this variant for pipelines of `kind`. Constants that the kind does not read, or
    /// that do not make it faster, have fixed values, so that equal pipelines have equal keys.
    #[must_use]
    pub fn of_kind(self, kind: Kind) -> Self {
        let Self {
            technique,
            speciality: own,
        } = self;
        let general = Speciality::GENERAL;
        let lists = kind.makes_lists();
        let lit = technique.is_lit() && !lists;
        let in_cells = kind == Kind::Cells;
        // Lavapipe 22 crashes in shadows if it treats the solid as constants.
        let one_object = !in_cells && (lists || technique.shadow == g::SHADOW_OFF);
        // Other techniques test where every ray begins. Cells need no test, and cut cells always.
        let cells = matches!(kind, Kind::Cells | Kind::CutCells);
        let patches = technique.search == Search::Quadric && technique.replicas == 0;
        let reads_outside = lists || (patches && !cells);
        let of = |reads: bool, value: u32, general: u32| if reads { value } else { general };
        Self {
            technique: if lists { Technique::LISTS } else { technique },
            speciality: Speciality {
                lights: of(lit, own.lights, general.lights),
                one_object: of(one_object, own.one_object, general.one_object),
                outside: of(reads_outside, own.outside, NOT_OUTSIDE),
                depths: of(kind.is_compute(), own.depths, general.depths),
            },
        }
    }

    /// The forms of pipelines that may draw what this variant draws, the fastest first: this one with
    /// specialities of a set, one for up to two lights if there are no more, and the general one.
    #[must_use]
    pub fn forms(self, kind: Kind, set: u32) -> [Self; 3] {
        let mut few_lights = self.speciality.only(set & LIGHTS_BIT);
        few_lights.lights = few_lights.lights.max(FEW_LIGHTS);
        let first = match set {
            LIGHTS_BIT => few_lights, // as after `Renderer::prewarm`
            _ => self.speciality.only(set),
        };
        let all = [first, few_lights, Speciality::GENERAL];
        all.map(|speciality| Self { speciality, ..self }.of_kind(kind))
    }

    /// The module of its vertices, before [`with_outputs_for`](super::with_outputs_for) its
    /// fragments; none in the compute stage.
    #[must_use]
    pub fn vertices(&self, kind: Kind) -> Option<Module> {
        let entry = match kind {
            Kind::Boxes => Entry::BoxVertex,
            Kind::Cells | Kind::CutCells => Entry::CellVertex,
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
        let (search, output) = (self.technique.search, self.technique.output);
        // Fragments write their colour as the only plane of a list.
        let listed = matches!(output, Output::Color) && !matches!(search, Search::External);
        Module {
            entry,
            search,
            output: if listed && !kind.is_compute() {
                Output::List
            } else {
                output
            },
        }
    }

    /// `(constant_id, value)` of every specialisation constant.
    #[must_use]
    pub fn constants(&self, kind: Kind) -> [(u32, u32); 16] {
        let (technique, speciality) = (&self.technique, &self.speciality);
        let (form, known_steps) = technique.external.map_or((0, 0), External::constants);
        [
            (g::REPLICAS_ID, technique.replicas),
            (g::SHADOW_ID, technique.shadow),
            (g::COLOR_MAP_ID, technique.color_map),
            (g::BUMP_ID, technique.bump),
            (g::PROJECTION_ID, technique.projection),
            (g::SEARCH_FORM_ID, form),
            (g::KNOWN_STEPS_ID, known_steps),
            (g::BEVELED_ID, technique.beveled),
            (g::RGBA8_ID, technique.rgba8),
            (g::ORTHO_ID, technique.parallel),
            (g::DEPTHS_ID, speciality.depths),
            (g::LIGHTS_ID, speciality.lights),
            (g::LIST_LENGTH_ID, kind.list_length()),
            (g::CUT_CELLS_ID, u32::from(kind == Kind::CutCells)),
            (g::OUTSIDE_ID, speciality.outside),
            (g::ONE_OBJECT_ID, speciality.one_object),
        ]
    }
}
