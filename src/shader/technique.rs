//! The technique: what an object, its search and an output demand of a pipeline.
//!
//! Parameters are data: no value of an offset, a light, a camera or a bound on steps makes another
//! technique. Textures, replicas, shadows and a bevel under a search on the map do.

use super::catalogue::{SearchCode, Stored};
use super::external::External;
use super::generated as g;
use crate::maps::{MapFormat, Projection};
use crate::scene::{BumpForm, Lighting, Object, Shadow, Texturing};
use crate::settings::{Planes, SearchSettings, Solver};

/// Properties of the objects that a shadow's ray may meet. The code of the object at which the ray
/// starts must handle them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowCasters {
    pub repeated: bool,
    pub beveled: bool,
}

/// What techniques depend on beside the object and its host.
#[derive(Clone, Copy)]
pub struct Demands<'a> {
    pub settings: &'a SearchSettings,
    pub planes: Planes,
    /// A function of the host shades. It reads texture coordinates, and no light of ours.
    pub host_shades: bool,
    pub lighting: &'a Lighting,
}

/// What a host brings to the look of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HostLook {
    pub colors: bool,
    /// Its image has the slopes or the heights.
    pub relief: bool,
    /// It has the heights.
    pub heights: bool,
}

/// What an object, its search and the output demand. Each technique and [`Kind`](super::Kind) has
/// one general pipeline, which is right for every view, light and number of objects. Each member selects code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Technique {
    pub search: SearchCode,
    /// The search of another crate, for [`SearchCode::External`].
    pub external: Option<External>,
    pub output: Stored,
    /// True if the box holds several replicas.
    pub replicas: bool,
    /// One of `SHADOW_*`.
    pub shadow: u32,
    /// True if surfaces reflect an environment.
    pub environment: bool,
    /// True if colours come from a map.
    pub color_map: bool,
    /// One of `BUMP_*`.
    pub bump: u32,
    /// One of `PROJECTION_*`.
    pub projection: u32,
    /// Searches on the map: true if there may be a bevel.
    pub beveled: bool,
    /// Searches on the map: true if that is the papers' texture of unsigned distances.
    pub rgba8: bool,
    /// Only depth: true if rays are parallel.
    pub parallel: bool,
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

impl Technique {
    /// The technique that makes lists of patches.
    pub const LISTS: Self = Self {
        search: SearchCode::None,
        external: None,
        output: Stored::Color,
        replicas: false,
        shadow: g::SHADOW_OFF,
        environment: false,
        color_map: false,
        bump: g::BUMP_OFF,
        projection: g::PROJECTION_CYLINDRICAL,
        beveled: false,
        rgba8: false,
        parallel: false,
    };

    /// The technique that draws `object` by the search `solver`, which is the search of the settings
    /// or a replacement for it.
    pub fn new(
        demands: &Demands,
        solver: Solver,
        object: &Object,
        casters: ShadowCasters,
        host: HostLook,
    ) -> Self {
        let (settings, lighting) = (demands.settings, demands.lighting);
        let (texturing, host_shades) = (&object.texturing, demands.host_shades);
        let casts = lighting.shadow != Shadow::Off;
        let replicas = object.repeat != [1; 3] || (casts && casters.repeated);
        let shadow = match lighting.shadow {
            Shadow::Off => g::SHADOW_OFF,
            Shadow::Hard => g::SHADOW_HARD,
            Shadow::Soft => g::SHADOW_SOFT,
        };
        let color_map = host.colors || texturing.color_map.is_some();
        let bump = bump_of(texturing, host);
        let textured = color_map || bump != g::BUMP_OFF;
        let (output, parallel) = match demands.planes {
            Planes::Color => (Stored::Color, false),
            Planes::All => (Stored::Planes, false),
            Planes::List(_) => (Stored::List, false),
            Planes::Depth { parallel } => (Stored::Depth, parallel),
        };
        let is_beveled = is_beveled(object);
        // The replacement for another search has only the general form.
        let replaces = solver == Solver::Live && settings.solver != Solver::Live;
        let may_bevel = replaces || is_beveled || (casts && casters.beveled);
        let of_map = |is: bool| solver.reads_map() && is;
        let technique = Self {
            search: match solver {
                Solver::Live => SearchCode::Live,
                Solver::Quadric | Solver::Exact => SearchCode::Quadric,
                Solver::Other(_) => SearchCode::External,
            },
            output,
            replicas,
            external: (solver.external())
                .map(|search| External::new(search, settings, is_beveled, casts)),
            beveled: of_map(may_bevel),
            rgba8: of_map(settings.map_format == MapFormat::Rgba8),
            parallel,
            ..Self::LISTS
        };
        if output == Stored::Depth {
            return technique;
        }
        Self {
            shadow,
            environment: lighting.environment.is_some() && !host_shades,
            color_map,
            bump,
            projection: match texturing.projection {
                // No code reads coordinates.
                _ if !textured && !host_shades && output != Stored::Planes => {
                    g::PROJECTION_CYLINDRICAL
                }
                Projection::Planar => g::PROJECTION_PLANAR,
                Projection::Cylindrical => g::PROJECTION_CYLINDRICAL,
                Projection::Spherical => g::PROJECTION_SPHERICAL,
                Projection::Arc => g::PROJECTION_ARC,
            },
            ..technique
        }
    }

    /// This technique and those that replace it when a bevel is added or removed.
    pub fn by_bevel(self) -> Vec<Self> {
        let beveled = !self.beveled;
        let twin = |external| Self {
            beveled,
            external,
            ..self
        };
        let mut all = vec![self];
        match self.external {
            Some(one) if one.reads_table() => {}
            None if self.search == SearchCode::Quadric => {}
            None => all.push(twin(None)),
            Some(one) => all.extend(one.by_bevel(beveled).map(|one| twin(Some(one)))),
        }
        all
    }

    /// True if it draws neither replicas nor shadows.
    pub const fn is_single(&self) -> bool {
        !self.replicas && self.shadow == g::SHADOW_OFF
    }

    /// True if the number of lights makes another pipeline.
    pub const fn is_lit(&self) -> bool {
        !matches!(self.output, Stored::Depth) && self.shadow == g::SHADOW_OFF
    }
}

/// True if an object's steps must allow for a bevel.
pub(crate) fn is_beveled(object: &Object) -> bool {
    object.offset.bevel != 0.0 && object.offset.chamfer > 0.0
}
