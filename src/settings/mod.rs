//! Settings define *how* a scene is drawn; the [`Scene`](crate::scene::Scene) defines *what* is
//! drawn.

mod planes;

pub use crate::names::name_of;
pub use planes::{Plane, PlaneList, Planes};

use crate::error::{Error, ErrorKind, Result, usage};
use crate::maps::{MapFormat, MapSource};
use crate::search::{Reads, Search, Steps};
use std::fmt;
use std::str::FromStr;

/// The stage in which rays are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DrawStage {
    /// Boxes, cells of surfaces or tiles of the picture are rasterised; the fragment shader traces.
    Fragment,
    /// A compute shader traces the screen's tiles that may show a solid.
    Compute,
}

impl DrawStage {
    /// The names in options and results.
    pub const NAMES: [(&'static str, Self); 2] =
        [("fragment", Self::Fragment), ("compute", Self::Compute)];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, &self)
    }
}

/// The search for the first hit along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Solver {
    /// For parameters that change from frame to frame. It reads only the map, with steps that are
    /// safe to a texel under every offset, a final secant, and no fixed number of steps.
    Live,
    /// The boundary as patches of quadrics under a tree of rows, solved exactly; rebuilt when
    /// parameters change.
    Quadric,
    /// The patches of [`Quadric`](Self::Quadric), found by the fastest method of each stage: proxies
    /// for the rasteriser in the fragment stage, few patches for each tile in compute, and walks
    /// through a hierarchy of copies in both. Objects without these are searched as by
    /// [`Quadric`](Self::Quadric). Scripts may use the name `hull`.
    Exact,
    /// A search of another crate.
    Other(&'static Search),
}

impl Solver {
    /// The library's searches, in the order of reports.
    pub const ALL: [Self; 3] = [Self::Live, Self::Quadric, Self::Exact];

    /// The default search.
    pub const DEFAULT: Self = Self::Exact;

    /// Name in options and results.
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
    /// [`ErrorKind::Usage`] if none has this name.
    pub fn named(name: &str, known: &[Self]) -> Result<Self> {
        let wanted = if name == "hull" { "exact" } else { name };
        let found = known.iter().find(|s| s.name() == wanted);
        found.copied().ok_or_else(|| {
            let names = known.iter().map(|s| s.name());
            let names = names.collect::<Vec<_>>().join(", ");
            let message = format!("{name:?} is no search; give one of {names}");
            Error::new(ErrorKind::Usage, message)
        })
    }

    /// Returns true if its tables are rows of its own, which some solids lack.
    #[must_use]
    pub const fn reads_own_table(self) -> bool {
        matches!(self, Self::Other(search) if matches!(search.reads, Reads::Table(_)))
    }

    /// The search of another crate, for [`Other`](Self::Other).
    pub(crate) const fn external(self) -> Option<&'static Search> {
        match self {
            Self::Other(search) => Some(search),
            _ => None,
        }
    }

    /// Returns true if it reads the shape map. The other searches read tables made from the
    /// boundary itself.
    #[must_use]
    pub const fn reads_map(self) -> bool {
        match self {
            Self::Live => true,
            Self::Quadric | Self::Exact => false,
            Self::Other(search) => matches!(search.reads, Reads::Map { .. }),
        }
    }

    /// Returns true if it searches patches, which have levels for every [`Tolerance`]. The other
    /// searches ignore the tolerance.
    #[must_use]
    pub const fn follows_tolerance(self) -> bool {
        matches!(self, Self::Quadric | Self::Exact)
    }

    /// The bound on its steps; `None` if it always ends without one, as patches do.
    #[must_use]
    pub const fn steps(self) -> Option<Steps> {
        match self {
            // This is more than any ray of a valid map needs.
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

    /// Returns true if a ray may use up the bound on steps before its search has come to an end.
    #[must_use]
    pub fn may_run_out(self) -> bool {
        self.steps().is_some_and(|steps| steps.may_run_out)
    }

    /// The default bound on steps; 1 if there is none.
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

/// The inverse of [`Display`](fmt::Display) for the library's searches; [`Solver::named`] also
/// finds others.
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

/// Allowed error of silhouettes and depths, in pixels of the drawn view.
///
/// Surfaces are fitted at several **levels**, each with a proven bound on its distance from the
/// exact surface. An object uses the coarsest level whose bound, seen at the object's nearest
/// point, is at most a sixteenth of the tolerance. A silhouette therefore moves by at most a
/// sixteenth of the tolerance. The depth error along the ray is larger at grazing rays. The factor
/// of 16 keeps 99.9 % of the pixels within the tolerance (measured).
///
/// Searches on patches ([`Solver::Exact`], [`Solver::Quadric`]) use it; all others ignore it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Tolerance(f64);

impl Tolerance {
    /// No error beyond that of the finest level.
    pub const EXACT: Self = Self(0.0);
    /// A quarter of a pixel.
    pub const DEFAULT: Self = Self(0.25);
    /// The largest, pixels.
    pub const MOST: f64 = 64.0;

    /// A tolerance in pixels, 0 to [`Tolerance::MOST`]; 0 is [`Tolerance::EXACT`].
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for any other number.
    pub fn new(pixels: f64) -> Result<Self> {
        if (0.0..=Self::MOST).contains(&pixels) {
            // Adding 0.0 turns -0.0 into 0.0.
            return Ok(Self(pixels + 0.0));
        }
        let most = Self::MOST;
        let message = format!("{pixels} is no tolerance in pixels; give 0 to {most}, 0 for exact");
        usage("tolerance", message)
    }

    /// The tolerance in pixels.
    #[must_use]
    pub const fn pixels(self) -> f64 {
        self.0
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The inverse of [`Display`](fmt::Display).
///
/// ```
/// use revmap::settings::Tolerance;
/// assert_eq!("0.25".parse(), Ok(Tolerance::DEFAULT));
/// assert!("-1".parse::<Tolerance>().is_err() && "nan".parse::<Tolerance>().is_err());
/// ```
impl FromStr for Tolerance {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match text.parse() {
            Ok(pixels) => Self::new(pixels),
            Err(_) => usage(
                "tolerance",
                format!("{text:?} is no number of pixels; give 0.25, or 0 for exact"),
            ),
        }
    }
}

/// Settings of a drawing. Members are options of the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The stage in which rays are traced.
    pub stage: DrawStage,
    /// The search.
    pub solver: Solver,
    /// Bound on the search's steps; `None` uses the solver's default.
    pub max_steps: Option<u32>,
    /// Rows of every shape map; `None` uses each object's own value.
    pub map_rows: Option<u32>,
    /// Source of distances; `None` is exact.
    pub map_source: Option<MapSource>,
    /// Storage of distances.
    pub map_format: MapFormat,
    /// The planes to draw.
    pub planes: Planes,
    /// Minimum number of pixels of an object's box, for each visible frustum of its cells, at which
    /// the fragment stage draws the cells. Triangles cost the same at any size. Smaller objects are
    /// drawn by boxes. Software drivers multiply this number by 2 to 11. Compute lists patches for
    /// up to 64 copies that have twice this number of pixels for each patch of a mean object; GPUs do
    /// so only for solids whose radius is more than 32 times their height, and cull the patches of a
    /// lone solid of any size. 0 always draws cells and lists; `u32::MAX` disables cells, lists of
    /// patches and culling.
    pub proxy_min_pixels: u32,
    /// Allowed error of silhouettes and depths.
    pub tolerance: Tolerance,
    /// True to smooth silhouettes in frames that the crate `revmap-offscreen` reads back. Otherwise
    /// every colour is that of the ray through the pixel's middle. Embedded renderers do not
    /// smooth.
    pub antialias: bool,
}

/// Settings of the search: the part of [`Settings`] that an embedded renderer uses. Size, stage and
/// planes are those of its output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// The search.
    pub solver: Solver,
    /// Bound on the search's steps; `None` uses the solver's default.
    pub max_steps: Option<u32>,
    /// Rows of every shape map; `None` uses each object's own value.
    pub map_rows: Option<u32>,
    /// Source of distances; `None` is the most accurate for the profile.
    pub map_source: Option<MapSource>,
    /// Storage of distances.
    pub map_format: MapFormat,
    /// Same as [`Settings::proxy_min_pixels`].
    pub proxy_min_pixels: u32,
    /// Same as [`Settings::tolerance`].
    pub tolerance: Tolerance,
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
            tolerance: settings.tolerance,
        }
    }
}

/// The given search; size, stage and planes as in the default.
impl From<&SearchSettings> for Settings {
    fn from(search: &SearchSettings) -> Self {
        Self {
            solver: search.solver,
            max_steps: search.max_steps,
            map_rows: search.map_rows,
            map_source: search.map_source,
            map_format: search.map_format,
            proxy_min_pixels: search.proxy_min_pixels,
            tolerance: search.tolerance,
            ..Self::default()
        }
    }
}

impl SearchSettings {
    /// True if cells and lists of patches may replace the tree.
    pub(crate) fn takes_patches(&self) -> bool {
        self.solver == Solver::Exact && self.proxy_min_pixels != u32::MAX
    }

    /// Fails if the search does not support these settings.
    pub(crate) fn check(&self) -> Result<()> {
        let solver = self.solver;
        let most = solver.steps().map_or(u32::MAX, |steps| steps.most);
        if let Some(steps) = self.max_steps.filter(|steps| *steps > most) {
            let message = format!("is {steps}; {solver} takes {most} at most");
            return usage("max_steps", message);
        }
        let reads = solver.external().map(|search| &search.reads);
        let refuses = matches!(reads, Some(Reads::Map { rgba8: false, .. }));
        if refuses && self.map_format == MapFormat::Rgba8 {
            let message = format!("{solver} reads no maps in rgba8; take r16 or r32");
            return usage("map_format", message);
        }
        Ok(())
    }

    /// The default with zero tolerance, for measurements.
    #[must_use]
    pub fn exact() -> Self {
        Self::from(&Settings::exact())
    }
}

impl Settings {
    /// The default with zero tolerance, for measurements.
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
            antialias: false,
        }
    }
}
