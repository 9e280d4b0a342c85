//! The variant: all inputs of a pipeline. It has two parts. The [`Technique`] is what an object, its
//! search and the output demand. The [`Speciality`] only makes the pipeline faster. The general
//! variant of a technique is right for everything that the technique draws, so a frame may take it
//! whenever a special one is not compiled.

use super::catalogue::{Entry, Module, SearchCode, Stored};
use super::external::External;
use super::generated as g;
use super::technique::Technique;
use std::ffi::CStr;

/// The geometry that a pipeline draws: a proxy (the first three), tiles with few patches, or a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Cells with their patches, rasterised.
    Cells,
    /// Cells that a side of the box may cut.
    CutCells,
    /// Shape boxes, rasterised; fragments walk the tree.
    Boxes,
    /// Compute: lists of the patches that rays of tiles may meet.
    TileLists,
    /// Compute: tiles whose patches are listed; each pixel tests this many.
    TilePatches(u32),
    /// Compute: squares of the picture, whose work groups cull the patches of a solid of one copy.
    CulledTiles,
    /// Compute: places of copies in a view.
    Place,
    /// Compute: lists of the first copies of a walk that rays of tiles may meet.
    WalkLists,
    /// Tiles of the picture, rasterised; fragments walk a hierarchy of copies.
    Walk,
    /// Compute: tiles of the picture, or chosen pixels, which walk a hierarchy of copies.
    WalkTiles,
}

impl Kind {
    pub const fn label(self) -> &'static CStr {
        match self {
            Self::Cells => c"revmap cells",
            Self::CutCells => c"revmap cut cells",
            Self::Boxes => c"revmap boxes",
            Self::TileLists => c"revmap lists of patches",
            Self::TilePatches(_) => c"revmap tiles of listed patches",
            Self::CulledTiles => c"revmap tiles that cull patches",
            Self::Place => c"revmap places of copies",
            Self::WalkLists => c"revmap lists of copies",
            Self::Walk => c"revmap walk",
            Self::WalkTiles => c"revmap walk of tiles",
        }
    }

    pub const fn draws_in_compute(self) -> bool {
        matches!(
            self,
            Self::TilePatches(_) | Self::CulledTiles | Self::WalkTiles
        )
    }

    /// The entry file of its fragments, or of its compute invocations.
    const fn entry(self) -> Entry {
        match self {
            Self::Boxes => Entry::Tree,
            Self::Cells | Self::CutCells => Entry::Cells,
            Self::TileLists => Entry::TileLists,
            Self::TilePatches(_) => Entry::TilePatches,
            Self::CulledTiles => Entry::CulledTiles,
            Self::Place => Entry::Place,
            Self::WalkLists => Entry::WalkLists,
            Self::Walk => Entry::Walk,
            Self::WalkTiles => Entry::WalkTiles,
        }
    }
}

/// Upper limit of lights: the value of `LIGHTS`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Lights {
    One = 1,
    /// The form that is compiled beside the general one.
    Two,
    /// A loop over more lights, which takes half of a frame even if it has no turn.
    #[default]
    Any,
}

impl Lights {
    pub const fn of(count: usize) -> Self {
        match count {
            0 | 1 => Self::One,
            2 => Self::Two,
            _ => Self::Any,
        }
    }
}

/// What a draw or dispatch holds: the value of `ONE_OBJECT`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Drawn {
    Objects,
    /// One object. Uniform buffers hold its block and the tables of all its levels.
    OneObject,
    OneCopy,
}

/// The objects of a draw whose boxes cut nothing of them, and outside of which rays from the eye begin:
/// the value of `OUTSIDE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Outside {
    Some,
    All,
    None,
}

/// What makes a pipeline faster for some frames. Every value but that of [`Speciality::GENERAL`]
/// promises something of the draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Speciality {
    /// Any number with shadows, whose lights share one loop.
    pub lights: Lights,
    pub drawn: Drawn,
    pub outside: Outside,
    /// Compute stage: false if each pixel is drawn once, so no depth is compared or kept.
    pub depths: bool,
    /// Cells: true if each has one patch.
    pub single: bool,
}

/// The name of a member, and a function that copies it from another value.
type Member = (&'static str, fn(&mut Speciality, Speciality));

/// The bit of [`Speciality::lights`] in a set.
const LIGHTS_BIT: u32 = 1;

impl Speciality {
    /// The members of a set, with bits in the order of the members; the others promise nothing.
    fn only(self, set: u32) -> Self {
        let mut only = Self::GENERAL;
        for (bit, (_, member)) in Self::MEMBERS.iter().enumerate() {
            if set >> bit & 1 != 0 {
                member(&mut only, self);
            }
        }
        only
    }

    /// In order.
    pub(crate) const MEMBERS: [Member; 5] = [
        ("lights", |to, from| to.lights = from.lights),
        ("one-object", |to, from| to.drawn = from.drawn),
        ("outside", |to, from| to.outside = from.outside),
        ("depths", |to, from| to.depths = from.depths),
        ("single-cells", |to, from| to.single = from.single),
    ];

    pub const GENERAL: Self = Self {
        lights: Lights::Any,
        drawn: Drawn::Objects,
        outside: Outside::Some,
        depths: true,
        single: false,
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
    pub const fn general(technique: Technique) -> Self {
        Self {
            technique,
            speciality: Speciality::GENERAL,
        }
    }

    /// This variant for objects of which [`FramePlan::outside`](crate::plan::FramePlan::outside) is
    /// this.
    pub const fn seen_from_outside(mut self, outside: bool) -> Self {
        self.speciality.outside = if outside { Outside::All } else { Outside::None };
        self
    }

    /// The form of this variant for pipelines of `kind`. Constants that the kind does not read, or
    /// that do not make it faster, have fixed values, so that equal pipelines have equal keys.
    pub fn of_kind(self, kind: Kind) -> Self {
        let technique = self.technique;
        let mut speciality = self.speciality;
        let lists = kind.entry().makes_lists();
        if lists || !technique.is_lit() {
            speciality.lights = Lights::Any;
        }
        // Lavapipe 22 crashes in shadows if it treats the solid as constants.
        let shadows = !lists && technique.shadow != g::SHADOW_OFF;
        if kind == Kind::Cells || shadows {
            speciality.drawn = Drawn::Objects;
        }
        // Other techniques test where every ray begins. Cells need no test, and cut cells always.
        let cells = matches!(kind, Kind::Cells | Kind::CutCells);
        let patches = technique.search == SearchCode::Quadric && !technique.replicas;
        if !lists && (cells || !patches) {
            speciality.outside = Outside::None;
        }
        if matches!(kind, Kind::Place | Kind::WalkLists) {
            speciality = Speciality::GENERAL;
        }
        speciality.depths |= !kind.draws_in_compute();
        speciality.single &= cells;
        Self {
            technique: if lists { Technique::LISTS } else { technique },
            speciality,
        }
    }

    /// The forms of pipelines that may draw what this variant draws, the fastest first: this one with
    /// specialities of a set, one for up to two lights if there are no more, and the general one.
    pub fn forms(self, kind: Kind, set: u32) -> [Self; 3] {
        let mut few_lights = self.speciality.only(set & LIGHTS_BIT);
        few_lights.lights = few_lights.lights.max(Lights::Two);
        let first = match set {
            LIGHTS_BIT => few_lights, // as after `Renderer::prewarm`
            _ => self.speciality.only(set),
        };
        let all = [first, few_lights, Speciality::GENERAL];
        all.map(|speciality| Self { speciality, ..self }.of_kind(kind))
    }

    /// The module of its vertices, before [`with_outputs_for`](super::with_outputs_for) its
    /// fragments; none in the compute stage.
    pub fn vertices(&self, kind: Kind) -> Option<Module> {
        let entry = match kind {
            Kind::Boxes => Entry::BoxVertex,
            Kind::Cells | Kind::CutCells => Entry::CellVertex,
            Kind::Walk => Entry::WalkVertex,
            _ => return None,
        };
        Some(Module::plain(entry))
    }

    /// The module of its fragments, or of its compute invocations.
    pub const fn module(&self, kind: Kind) -> Module {
        let (search, output) = (self.technique.search, self.technique.output);
        let repeats_patches = self.technique.replicas && matches!(search, SearchCode::Quadric);
        let entry = match kind.entry() {
            // Without the code of replicas walks take 64 registers in place of 72 on RDNA2.
            Entry::WalkTiles if repeats_patches => Entry::WalkReplicas,
            entry => entry,
        };
        if entry.makes_lists() {
            return Module::plain(entry);
        }
        // Fragments write their colour as the only plane of a list.
        let listed = matches!(output, Stored::Color) && !matches!(search, SearchCode::External);
        Module {
            entry,
            search,
            output: if listed && !kind.draws_in_compute() {
                Stored::List
            } else {
                output
            },
        }
    }

    /// `(constant_id, value)` of every specialisation constant.
    pub fn constants(&self, kind: Kind) -> [(u32, u32); 18] {
        let (technique, speciality) = (&self.technique, &self.speciality);
        let (form, known_steps) = technique.external.map_or((0, 0), External::constants);
        let list_length = match kind {
            Kind::TilePatches(length) => length,
            _ => g::LONGEST_LIST,
        };
        [
            (g::REPLICAS_ID, technique.replicas.into()),
            (g::SHADOW_ID, technique.shadow),
            (g::ENVIRONMENT_ID, technique.environment.into()),
            (g::COLOR_MAP_ID, technique.color_map.into()),
            (g::BUMP_ID, technique.bump),
            (g::PROJECTION_ID, technique.projection),
            (g::SEARCH_FORM_ID, form),
            (g::KNOWN_STEPS_ID, known_steps),
            (g::BEVELED_ID, technique.beveled.into()),
            (g::RGBA8_ID, technique.rgba8.into()),
            (g::ORTHO_ID, technique.parallel.into()),
            (g::DEPTHS_ID, speciality.depths.into()),
            (g::LIGHTS_ID, speciality.lights as u32),
            (g::LIST_LENGTH_ID, list_length),
            (g::CUT_CELLS_ID, u32::from(kind == Kind::CutCells)),
            (g::OUTSIDE_ID, speciality.outside as u32),
            (g::ONE_OBJECT_ID, speciality.drawn as u32),
            (g::SINGLE_CELLS_ID, speciality.single.into()),
        ]
    }
}
