//! Ways of drawing behind one [`renderer`]: a search of [`revmap`], the mesh baseline, or the
//! [`floor`].

pub mod floor;
pub mod renderer;

use revmap::error::{Error, ErrorKind, Result};
use revmap::maps::{MapFormat, MapSource};
use revmap::settings::{DrawStage, Planes, Settings, Solver, Tolerance};
use revmap_mesh::Fineness;
use revmap_searches::folder;
use std::fmt;
use std::str::FromStr;

/// How the surface is found in each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// A search along the pixel's ray.
    Search(Solver),
    /// Triangles, rasterised: the mesh baseline. In the fragment stage alone.
    Mesh {
        /// Steps around the axis.
        segments: u32,
        /// Most steps along the meridian; fewer where fewer follow it exactly.
        rings: u32,
    },
    /// Triangles that keep silhouettes within so many thousandths of a pixel: each copy by its size
    /// on the screen. Copies beside the picture are left out.
    MeshWithin {
        /// Thousandths of a pixel.
        milli: u32,
    },
    /// The default search's frame without the search: each pixel returns its first possible point.
    Floor,
}

impl Method {
    /// The mesh that the default is put against: silhouettes within the default's tolerance.
    pub const OPPONENT: Self = Self::MeshWithin { milli: 250 };

    /// Every search, in the order in which reports list them. Meshes are not among them.
    pub const ALL: [Self; revmap_searches::ALL.len()] = {
        let mut all = [Self::DEFAULT; revmap_searches::ALL.len()];
        let mut i = 0;
        while i < all.len() {
            all[i] = Self::Search(revmap_searches::ALL[i]);
            i += 1;
        }
        all
    };

    /// The method taken where none is named.
    pub const DEFAULT: Self = Self::Search(Solver::DEFAULT);

    /// Most quads of a mesh.
    pub const MOST_QUADS: u64 = 1 << 22;

    /// A mesh of so many segments around the axis and rings along the meridian.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] below 3 segments or 2 rings, or beyond [`Method::MOST_QUADS`].
    pub fn mesh(segments: u32, rings: u32) -> Result<Self> {
        let quads = u64::from(segments) * u64::from(rings);
        if segments < 3 || rings < 2 || quads > Self::MOST_QUADS {
            let most = Self::MOST_QUADS;
            let message = format!(
                "mesh:{segments}x{rings} has {quads} quads; give at least 3 segments and 2 rings, and at most {most} of both together"
            );
            return Err(Error::new(ErrorKind::Usage, message));
        }
        Ok(Self::Mesh { segments, rings })
    }

    /// A mesh that keeps silhouettes within so many pixels.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for what is no number of thousandths from 0.001 to 64.
    pub fn mesh_within(pixels: f64) -> Result<Self> {
        let milli = (1e3 * pixels).round();
        if !((1.0..=64e3).contains(&milli) && (milli - 1e3 * pixels).abs() < 1e-6) {
            let message = format!(
                "mesh:{pixels}px: give 0.001 to 64 pixels, with at most three digits behind the point"
            );
            return Err(Error::new(ErrorKind::Usage, message));
        }
        Ok(Self::MeshWithin {
            milli: milli as u32,
        })
    }

    /// The pixels that a mesh keeps silhouettes within, if it does.
    pub fn pixels(self) -> Option<f64> {
        match self {
            Self::MeshWithin { milli } => Some(f64::from(milli) / 1e3),
            Self::Search(_) | Self::Mesh { .. } | Self::Floor => None,
        }
    }

    /// The search; `None` of a mesh and of the floor.
    pub const fn solver(self) -> Option<Solver> {
        match self {
            Self::Search(solver) => Some(solver),
            Self::Mesh { .. } | Self::MeshWithin { .. } | Self::Floor => None,
        }
    }

    /// Whether it is a mesh.
    pub const fn is_mesh(self) -> bool {
        matches!(self, Self::Mesh { .. } | Self::MeshWithin { .. })
    }

    /// Most quads of one copy of a solid; 0 of a search, and of a mesh whose quads follow the view.
    pub const fn quads(self) -> u64 {
        match self {
            Self::Mesh { segments, rings } => segments as u64 * rings as u64,
            Self::Search(_) | Self::MeshWithin { .. } | Self::Floor => 0,
        }
    }

    /// Coarse meshes before fine ones of their kind.
    pub const fn order(self) -> u64 {
        match self {
            Self::MeshWithin { milli } => (u32::MAX - milli) as u64,
            other => other.quads(),
        }
    }

    /// Its name; of a mesh the first part of [`Display`](fmt::Display)'s `mesh:64x128`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Search(solver) => solver.name(),
            Self::Mesh { .. } | Self::MeshWithin { .. } => "mesh",
            Self::Floor => "floor",
        }
    }

    /// As [`Solver::reads_own_table`]; a mesh does not.
    pub const fn reads_own_table(self) -> bool {
        matches!(self, Self::Search(solver) if solver.reads_own_table())
    }

    /// As [`Solver::reads_map`]; a mesh is made from the boundary itself.
    pub const fn reads_map(self) -> bool {
        matches!(self, Self::Search(solver) if solver.reads_map())
    }

    /// As [`Solver::follows_tolerance`]; a mesh does not.
    pub const fn follows_tolerance(self) -> bool {
        match self {
            Self::Search(solver) => solver.follows_tolerance(),
            Self::Floor => Solver::DEFAULT.follows_tolerance(),
            Self::Mesh { .. } | Self::MeshWithin { .. } => false,
        }
    }

    /// As [`Solver::may_run_out`]; a mesh makes no steps.
    pub fn may_run_out(self) -> bool {
        matches!(self, Self::Search(solver) if solver.may_run_out())
    }

    /// As [`Solver::default_steps`]; 1 for a mesh, which has none to bound.
    pub fn default_steps(self, beveled: bool) -> u32 {
        self.solver().map_or(1, |s| s.default_steps(beveled))
    }
}

impl Default for Method {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl From<Solver> for Method {
    fn from(solver: Solver) -> Self {
        Self::Search(solver)
    }
}

impl PartialEq<Solver> for Method {
    fn eq(&self, other: &Solver) -> bool {
        self.solver() == Some(*other)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Search(solver) => solver.fmt(f),
            Self::Mesh { segments, rings } => write!(f, "mesh:{segments}x{rings}"),
            Self::MeshWithin { milli } => write!(f, "mesh:{}px", f64::from(*milli) / 1e3),
            Self::Floor => f.write_str("floor"),
        }
    }
}

/// The inverse of [`Display`](fmt::Display).
///
/// ```
/// use revmap_methods::Method;
/// assert_eq!("mesh:64x128".parse(), Method::mesh(64, 128));
/// assert!("mesh:64".parse::<Method>().is_err());
/// ```
impl FromStr for Method {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match revmap_searches::named(text) {
            Ok(solver) => return Ok(Self::Search(solver)),
            Err(error) if folder::is_named(text) => return Err(error),
            Err(_) => {}
        }
        if text == "floor" {
            return Ok(Self::Floor);
        }
        let fineness = text.strip_prefix("mesh:");
        let pixels = fineness.and_then(|rest| rest.strip_suffix("px")?.parse().ok());
        if let Some(pixels) = pixels {
            return Self::mesh_within(pixels);
        }
        let numbers = fineness
            .and_then(|rest| rest.split_once('x'))
            .and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        if let Some((segments, rings)) = numbers {
            return Self::mesh(segments, rings);
        }
        let known = revmap_searches::ALL.map(Solver::name).join(", ");
        let message = format!(
            "{text:?} is no search; give one of {known}, the folder of another, a mesh as mesh:0.25px or mesh:64x128, or floor"
        );
        Err(Error::new(ErrorKind::Usage, message))
    }
}

/// How the edges of a picture are treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// One ray through the middle of each pixel.
    OneRay,
    /// One ray, and silhouettes smoothed.
    Silhouettes,
    /// So many rays in each pixel, a power of two.
    Rays(u32),
    /// One ray, in a pass of four samples.
    Msaa,
}

impl Edges {
    /// Its name in plans and results.
    pub fn name(self) -> String {
        match self {
            Self::OneRay => "1 ray".to_owned(),
            Self::Silhouettes => "silhouettes".to_owned(),
            Self::Rays(count) => format!("{count} rays"),
            Self::Msaa => "MSAA 4".to_owned(),
        }
    }

    /// Samples of a pixel in one pass.
    pub fn samples(self) -> u32 {
        match self {
            Self::Msaa => 4,
            Self::OneRay | Self::Silhouettes | Self::Rays(_) => 1,
        }
    }
}

/// The inverse of [`Edges::name`].
impl FromStr for Edges {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let known = [Self::OneRay, Self::Silhouettes, Self::Msaa];
        let rays = [4, 16, 64].map(Self::Rays);
        let mut all = known.into_iter().chain(rays);
        all.find(|edges| edges.name() == text).ok_or_else(|| {
            let message = format!("{text:?} is no treatment of edges; give 1 ray, silhouettes, MSAA 4, 4 rays, 16 rays or 64 rays");
            Error::new(ErrorKind::Usage, message)
        })
    }
}

/// How a picture is drawn: [`Settings`] with any method in place of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodSettings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Where rays are traced; a mesh is rasterised in the fragment stage.
    pub stage: DrawStage,
    /// How the surface is found.
    pub method: Method,
    /// Bound on a search's steps; `None` takes the method's own.
    pub max_steps: Option<u32>,
    /// Rows of every shape map; `None` takes each object's own.
    pub map_rows: Option<u32>,
    /// Source of distances; `None` takes the most accurate for the profile.
    pub map_source: Option<MapSource>,
    /// Storage of distances.
    pub map_format: MapFormat,
    /// What to draw.
    pub planes: Planes,
    /// Allowed error of searches on patches.
    pub tolerance: Tolerance,
    /// How edges are treated.
    pub edges: Edges,
}

impl MethodSettings {
    /// The same by another method.
    pub fn by(mut self, method: impl Into<Method>) -> Self {
        self.method = method.into();
        self
    }

    /// The same in another stage.
    pub fn in_stage(mut self, stage: DrawStage) -> Self {
        self.stage = stage;
        self
    }

    /// The same with so many pixels across and down.
    pub fn sized(mut self, width: u32, height: u32) -> Self {
        (self.width, self.height) = (width, height);
        self
    }

    /// How fine the method's mesh is.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a search, for a mesh that [`Method::mesh`] refuses, and for the
    /// compute stage.
    pub fn mesh_fineness(&self) -> Result<Fineness> {
        let method = self.method;
        let refused = |why| Err(Error::new(ErrorKind::Usage, why).at_key("solver"));
        let fineness = match method {
            Method::Mesh { segments, rings } => {
                // Settings are plain values: the numbers may not have come through the check.
                Method::mesh(segments, rings)?;
                Fineness::Quads { segments, rings }
            }
            Method::MeshWithin { milli } => Fineness::Pixels(f64::from(milli) / 1e3),
            Method::Search(_) | Method::Floor => {
                return refused(format!("{method} is no mesh; give a mesh as mesh:0.25px"));
            }
        };
        if self.stage == DrawStage::Compute {
            return refused(format!(
                "{method} is rasterised, which a compute shader does not; give the stage fragment"
            ));
        }
        Ok(fineness)
    }

    /// The same with other planes.
    pub fn storing(mut self, planes: Planes) -> Self {
        self.planes = planes;
        self
    }
}

impl Default for MethodSettings {
    /// As [`Settings::exact`].
    fn default() -> Self {
        let settings = Settings::exact();
        Self {
            width: settings.width,
            height: settings.height,
            stage: settings.stage,
            method: Method::Search(settings.solver),
            max_steps: settings.max_steps,
            map_rows: settings.map_rows,
            map_source: settings.map_source,
            map_format: settings.map_format,
            planes: settings.planes,
            tolerance: settings.tolerance,
            edges: Edges::OneRay,
        }
    }
}

/// The renderer's settings: for a mesh and for the floor those of the default search.
impl From<&MethodSettings> for Settings {
    fn from(settings: &MethodSettings) -> Self {
        Self {
            width: settings.width,
            height: settings.height,
            stage: settings.stage,
            solver: settings.method.solver().unwrap_or(Solver::DEFAULT),
            max_steps: settings.max_steps,
            map_rows: settings.map_rows,
            map_source: settings.map_source,
            map_format: settings.map_format,
            planes: settings.planes,
            tolerance: settings.tolerance,
            antialias: settings.edges == Edges::Silhouettes,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn names_are_read_and_bounded() {
        for text in
            "mesh:3x2 mesh:0.25px mesh:64px mesh:0.001px floor mesh:64x128 mesh:2048x2048 quadric"
                .split(' ')
        {
            assert_eq!(text.parse::<Method>().unwrap().to_string(), text);
        }
        let bad = "mesh mesh: mesh:2x1 mesh:0x0 mesh:3x1 mesh:99999999x9 mesh:axb mesh:64 mesh:64x \
                   mesh:-3x9 mesh:64x128x2 mesh:2049x2048 MESH:64x128 magic \
                   mesh:levels mesh:px mesh:0px mesh:-1px mesh:0.0005px mesh:65px mesh:1e9px \
                   mesh:NaNpx mesh:infpx mesh:0.25";
        for bad in bad.split(' ').chain([""]) {
            let error = bad.parse::<Method>().unwrap_err();
            assert_eq!(error.kind, ErrorKind::Usage, "{bad}");
            assert!(!error.message.contains('\n'), "{error}");
        }
    }

    #[test]
    fn settings_keep_what_they_are_given() {
        let settings = MethodSettings {
            width: 7,
            method: Solver::Live.into(),
            ..MethodSettings::default()
        };
        let wanted = Settings {
            width: 7,
            solver: Solver::Live,
            ..Settings::exact()
        };
        assert_eq!(Settings::from(&settings), wanted);
        let solvers = Method::ALL.map(|m| m.solver().unwrap());
        assert_eq!(solvers, revmap_searches::ALL);
    }
}
