//! *How* a scene is drawn; *what* is drawn is the [`Scene`](crate::scene::Scene).

mod tolerance;

pub use tolerance::Tolerance;

use crate::error::{Error, ErrorKind, Result};
use crate::maps::{MapFormat, MapSource};
use crate::search::{Reads, Search, Steps};
use std::fmt;
use std::str::FromStr;

/// Where rays are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DrawStage {
    /// Shape boxes are rasterised; the fragment shader traces.
    Fragment,
    /// A compute shader traces the screen's tiles that boxes cover.
    Compute,
}

impl DrawStage {
    /// As options and results name them.
    pub const NAMES: [(&'static str, Self); 2] =
        [("fragment", Self::Fragment), ("compute", Self::Compute)];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, &self)
    }
}

/// The name of a value among these; the last, where it has several.
#[must_use]
pub fn name_of<T: PartialEq>(names: &[(&'static str, T)], value: &T) -> &'static str {
    let found = names.iter().rev().find(|(_, known)| known == value);
    found.map_or("unknown", |(name, _)| name)
}

/// How the first hit along a ray is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Solver {
    /// For parameters that change from frame to frame: steps that are safe to a texel under every
    /// offset, a last secant, no fixed count of steps; on the map alone.
    Live,
    /// The boundary as patches of quadrics under a tree of rows, solved exactly; rebuilt when
    /// parameters change.
    Quadric,
    /// The same patches, found by what the stage does best: the rasteriser finds them by proxies in
    /// the fragment stage, lists of tiles in compute. Objects without either are searched as by
    /// [`Quadric`](Self::Quadric). Scripts may call it `hull`.
    Exact,
    /// One of another crate.
    Other(&'static Search),
}

impl Solver {
    /// The library's own, in the order in which reports list them.
    pub const ALL: [Self; 3] = [Self::Live, Self::Quadric, Self::Exact];

    /// What is taken where none is named.
    pub const DEFAULT: Self = Self::Exact;

    /// Its name in options and results.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Live => "live",
            Self::Quadric => "quadric",
            Self::Exact => "exact",
            Self::Other(search) => search.name,
        }
    }

    /// The search of this name among `known`; `hull` is another name of `exact`.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] where none has it.
    pub fn named(name: &str, known: &[Self]) -> Result<Self> {
        let wanted = if name == "hull" { "exact" } else { name };
        let found = known.iter().find(|s| s.name() == wanted);
        found.copied().ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|s| s.name()).collect();
            let names = names.join(", ");
            let message = format!("{name:?} is no search; give one of {names}");
            Error::new(ErrorKind::Usage, message)
        })
    }

    /// Whether its tables are rows of its own, which not every solid has.
    #[must_use]
    pub const fn reads_own_table(self) -> bool {
        matches!(self, Self::Other(search) if matches!(search.reads, Reads::Table(_)))
    }

    /// The search of another crate that it is.
    pub(crate) const fn external(self) -> Option<&'static Search> {
        match self {
            Self::Other(search) => Some(search),
            _ => None,
        }
    }

    /// Whether it reads the shape map. The others search tables made from the boundary itself.
    #[must_use]
    pub const fn reads_map(self) -> bool {
        match self {
            Self::Live => true,
            Self::Quadric | Self::Exact => false,
            Self::Other(search) => matches!(search.reads, Reads::Map { .. }),
        }
    }

    /// Whether it searches patches, of which there are levels for every [`Tolerance`]. The others
    /// ignore it.
    #[must_use]
    pub const fn follows_tolerance(self) -> bool {
        matches!(self, Self::Quadric | Self::Exact)
    }

    /// The bound on its steps; `None` where it ends by itself, as patches do.
    #[must_use]
    pub const fn steps(self) -> Option<Steps> {
        match self {
            // More than any ray of a sound map takes.
            Self::Live => Some(Steps {
                default: 512,
                beveled: 512,
                most: Steps::MOST,
                may_run_out: true,
            }),
            Self::Quadric | Self::Exact => None,
            Self::Other(search) => search.steps,
        }
    }

    /// Whether a ray may use up the bound on steps before its search has come to an end.
    #[must_use]
    pub fn may_run_out(self) -> bool {
        self.steps().is_some_and(|steps| steps.may_run_out)
    }

    /// The bound on steps where none is given; 1 where there is none.
    #[must_use]
    pub fn default_steps(self, beveled: bool) -> u32 {
        self.steps().map_or(1, |steps| steps.of(beveled))
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The inverse of [`Display`](fmt::Display) for the library's own; [`Solver::named`] knows others.
///
/// ```
/// use revmap::settings::Solver;
/// assert_eq!("live".parse(), Ok(Solver::Live));
/// assert!("alive".parse::<Solver>().is_err());
/// ```
impl FromStr for Solver {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::named(text, &Self::ALL)
    }
}

/// Which planes of a frame are wanted; what is not wanted is neither computed nor stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Planes {
    /// Colour alone, 8-bit sRGB.
    Color,
    /// Depth alone, for shadow maps; `parallel`: along parallel rays, as a directional light sees.
    /// In a host's pass only.
    Depth {
        /// Whether views are parallel.
        parallel: bool,
    },
    /// Everything a [`Frame`](crate::frame::Frame) holds, in 32-bit floats.
    All,
}

/// How to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Where rays are traced.
    pub stage: DrawStage,
    /// The search.
    pub solver: Solver,
    /// Bound on the search's steps; `None` takes the solver's own.
    pub max_steps: Option<u32>,
    /// Rows of every shape map; `None` takes each object's own.
    pub map_rows: Option<u32>,
    /// Source of distances; `None`: exact.
    pub map_source: Option<MapSource>,
    /// Storage of distances.
    pub map_format: MapFormat,
    /// What to draw.
    pub planes: Planes,
    /// Least pixels of an object's box for each visible frustum of its cells at which the fragment
    /// stage draws the cells: triangles cost the same however small they are. Smaller objects are
    /// drawn by tiles. Software drivers multiply it by 2 or 11 for single solids. `u32::MAX`: no
    /// cells and no lists of patches.
    pub proxy_min_pixels: u32,
    /// Allowed error of silhouettes and depths.
    pub tolerance: Tolerance,
    /// Whether copies are left out that others are proven to hide. No pixel differs by more than a
    /// rounding; false is there to show it.
    pub occlusion_culling: bool,
    /// Whether silhouettes are smoothed in frames that are read back ([`crate::antialias`]). Else
    /// every colour is that of the ray through the pixel's middle. Embedded renderers do without.
    pub antialias: bool,
}

/// How rays find the surface: the part of [`Settings`] that an embedded renderer takes. Size, stage
/// and planes are its output's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// The search.
    pub solver: Solver,
    /// Bound on the search's steps; `None` takes the solver's own.
    pub max_steps: Option<u32>,
    /// Rows of every shape map; `None` takes each object's own.
    pub map_rows: Option<u32>,
    /// Source of distances; `None`: the most accurate for the profile.
    pub map_source: Option<MapSource>,
    /// Storage of distances.
    pub map_format: MapFormat,
    /// As [`Settings::proxy_min_pixels`].
    pub proxy_min_pixels: u32,
    /// As [`Settings::tolerance`].
    pub tolerance: Tolerance,
    /// As [`Settings::occlusion_culling`].
    pub occlusion_culling: bool,
}

impl From<&Settings> for SearchSettings {
    fn from(settings: &Settings) -> Self {
        Self {
            solver: settings.solver,
            max_steps: settings.max_steps,
            map_rows: settings.map_rows,
            map_source: settings.map_source,
            map_format: settings.map_format,
            proxy_min_pixels: settings.proxy_min_pixels,
            occlusion_culling: settings.occlusion_culling,
            tolerance: settings.tolerance,
        }
    }
}

/// The search as given; size, stage and planes as in the default.
impl From<&SearchSettings> for Settings {
    fn from(search: &SearchSettings) -> Self {
        Self {
            solver: search.solver,
            max_steps: search.max_steps,
            map_rows: search.map_rows,
            map_source: search.map_source,
            map_format: search.map_format,
            proxy_min_pixels: search.proxy_min_pixels,
            occlusion_culling: search.occlusion_culling,
            tolerance: search.tolerance,
            ..Self::default()
        }
    }
}

impl SearchSettings {
    /// Fails where the search cannot do what is asked of it.
    pub(crate) fn check(&self) -> Result<()> {
        let refused =
            |message: String, key: &str| Err(Error::new(ErrorKind::Usage, message).at_key(key));
        if let (Some(steps), Some(bound)) = (self.max_steps, self.solver.steps())
            && steps > bound.most
        {
            let (solver, most) = (self.solver, bound.most);
            return refused(
                format!("is {steps}; {solver} takes {most} at most"),
                "max_steps",
            );
        }
        match self.solver {
            Solver::Other(search)
                if self.map_format == MapFormat::Rgba8
                    && matches!(search.reads, Reads::Map { rgba8: false, .. }) =>
            {
                let solver = self.solver;
                refused(
                    format!("{solver} reads no maps in rgba8; take r16 or r32"),
                    "map_format",
                )
            }
            _ => Ok(()),
        }
    }

    /// The default with no tolerance, as measurements want it.
    #[must_use]
    pub fn exact() -> Self {
        Self::from(&Settings::exact())
    }
}

impl Settings {
    /// The default with no tolerance, as measurements want it.
    #[must_use]
    pub fn exact() -> Self {
        Self {
            tolerance: Tolerance::EXACT,
            ..Self::default()
        }
    }
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self::from(&Settings::default())
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 800,
            height: 600,
            stage: DrawStage::Fragment,
            solver: Solver::DEFAULT,
            max_steps: None,
            map_rows: None,
            map_source: None,
            map_format: MapFormat::R32,
            planes: Planes::All,
            proxy_min_pixels: 150,
            tolerance: Tolerance::DEFAULT,
            occlusion_culling: true,
            antialias: false,
        }
    }
}
