//! The header's enumerations and the library's values for their numbers. Structures hold these
//! numbers as `uint32_t`, since C may write any number.

use crate::fault::{Fault, Outcome, RevmapResult};
use ash::vk::CompareOp;
use revmap::gpu::DepthOrder;
use revmap::maps::{MapFormat, MapSource, Projection, SlopeFilter};
use revmap::scene::{BumpForm, Clip, Shadow};
use revmap::settings::{DrawStage, Plane, PlaneList, Planes, Solver};
use revmap_files::ProfileAxis;

/// The part of a picture or a drawing that is the half-plane to be turned.
#[repr(u32)]
pub enum RevmapAxis {
    /// The axis is the middle: the picture is a whole silhouette, and its right half is used.
    Center = 0,
    /// The axis is the left edge: the picture is a half profile.
    Left = 1,
}

/// The search for the first hit along a ray. Linear, relief, secant, circle, cone and relaxed are
/// for comparison: a library that is built without the feature `searches` refuses them with
/// REVMAP_RESULT_UNSUPPORTED.
#[repr(u32)]
pub enum RevmapSolver {
    /// The default of this version: REVMAP_SOLVER_EXACT.
    Default = 0,
    /// Equal steps along the ray.
    Linear = 1,
    /// Equal steps, then halvings: relief mapping.
    Relief = 2,
    /// Equal steps, then secants: interval mapping.
    Secant = 3,
    /// Circle tracing with 20 steps, as published.
    Circle = 4,
    /// Safe steps on the map only, under every offset; rebuilds nothing when an offset changes.
    Live = 5,
    /// Cone step mapping, for profiles that are single-valued in z.
    Cone = 6,
    /// Relaxed cone step mapping.
    Relaxed = 7,
    /// The boundary as pieces of quadrics, solved exactly.
    Quadric = 8,
    /// The pieces of REVMAP_SOLVER_QUADRIC, found by the rasteriser or by tiles of pixels.
    Exact = 9,
}

/// The source of the distances of a shape map.
#[repr(u32)]
pub enum RevmapMapSource {
    /// The most accurate for the profile.
    Default = 0,
    /// Distance to the nearest solid pixel's centre of a binary image.
    Binary = 1,
    /// Distance to the outline traced from 8 bits of coverage.
    Coverage = 2,
    /// Exact distance to the outline.
    Exact = 3,
}

/// The format of the distances of a shape map on the device.
#[repr(u32)]
pub enum RevmapMapFormat {
    /// Signed distance as a 32-bit float.
    R32 = 0,
    /// Signed distance as a 16-bit float.
    R16 = 1,
    /// Gradient, distance and form, 8 bits each.
    Rgba8 = 2,
}

/// The planes of a picture to draw.
#[repr(u32)]
pub enum RevmapPlanes {
    /// Colour only. A pass gets linear RGBA, which the attachment's format encodes: give a view of an
    /// _SRGB format. An attachment of a _UNORM format holds linear values, and a float format keeps
    /// values above 1. Compute and pictures without a host have 8-bit sRGB.
    Color = 0,
    /// Every plane of RevmapPlane, in 32-bit floats.
    All = 1,
    /// Depth only, for shadow maps, in a host's pass.
    Depth = 2,
    /// Depth only, along parallel rays.
    DepthParallel = 3,
    /// The attachments of a RevmapPass, as for a G-buffer. In a host's pass, by
    /// REVMAP_SOLVER_EXACT, REVMAP_SOLVER_QUADRIC and REVMAP_SOLVER_LIVE.
    List = 4,
}

/// The values of one colour attachment of REVMAP_PLANES_LIST. Channels that it does not name are 0,
/// and alpha is 1.
#[repr(u32)]
pub enum RevmapAttachment {
    /// The shaded colour, linear RGBA. A float format keeps values above 1.
    Color = 0,
    /// The colour of the surface before light, linear RGB.
    BaseColor = 1,
    /// The unit normal in the world, with bumps, facing the eye: x, y, z. Signed or float formats.
    Normal = 2,
    /// The same normal as a point of an octahedron that is unfolded to the square -1 to 1: two
    /// channels. Signed or float formats.
    OctahedralNormal = 3,
    /// Roughness and metalness of the object, 0 to 1: two channels.
    Material = 4,
    /// Motion: the position in the picture in the last frame minus the present one, pixels, y
    /// downwards, without jitter: two channels. Float formats. RevmapView holds the last view,
    /// revmap_renderer_end_frame() keeps the last placements.
    Motion = 5,
    /// The number of the object, as revmap_renderer_object_number() gives it, and the number of the
    /// copy: two channels of VK_FORMAT_R32G32_UINT or VK_FORMAT_R32G32B32A32_UINT. The clear value
    /// should be one that no object has, such as UINT32_MAX.
    Identity = 6,
}

/// A plane that revmap_offscreen_read() returns. Row 0 is on top.
#[repr(u32)]
pub enum RevmapPlane {
    /// 4 bytes a pixel: sRGB, alpha linear.
    Srgb8 = 0,
    /// 4 floats a pixel: linear colour, not multiplied by alpha.
    Color = 1,
    /// 1 float a pixel: distance from the eye along the ray, world units; infinite without a hit.
    Distance = 2,
    /// 3 floats a pixel: unit world normal, without bump.
    Normal = 3,
    /// 3 floats a pixel: the normal that was shaded.
    ShadingNormal = 4,
    /// 3 floats a pixel: colour of the surface before light, linear.
    Albedo = 5,
    /// 2 floats a pixel: texture coordinates before the texture's repetition and offset.
    Uv = 6,
    /// 1 float a pixel: look-ups that the search made.
    Steps = 7,
}

/// The near end of the depth range.
#[repr(u32)]
pub enum RevmapDepthOrder {
    /// 0 is near, fragments pass that are less.
    Normal = 0,
    /// 1 is near, fragments pass that are greater.
    Reversed = 1,
}

/// The depth test of a pass: fragments pass that are so, compared with the depth attachment, in
/// either depth order. After a depth prepass of the same objects and view give
/// REVMAP_DEPTH_COMPARE_EQUAL or REVMAP_DEPTH_COMPARE_NEARER_OR_EQUAL.
#[repr(u32)]
pub enum RevmapDepthCompare {
    /// Nearer.
    Nearer = 0,
    /// Nearer, or as near.
    NearerOrEqual = 1,
    /// As near.
    Equal = 2,
    /// Farther.
    Farther = 3,
    /// Farther, or as near.
    FartherOrEqual = 4,
    /// Nearer or farther.
    NotEqual = 5,
    /// All fragments pass.
    Always = 6,
    /// No fragment passes.
    Never = 7,
}

/// The command by which a host begins its pass.
#[repr(u32)]
pub enum RevmapPassKind {
    /// By vkCmdBeginRendering.
    Dynamic = 0,
    /// By vkCmdBeginRenderPass.
    RenderPass = 1,
}

/// The stage that traces rays.
#[repr(u32)]
pub enum RevmapStage {
    /// In fragment shaders.
    Fragment = 0,
    /// In compute shaders.
    Compute = 1,
}

/// The projection that gives the texture coordinates of surface points.
#[repr(u32)]
pub enum RevmapProjection {
    /// Azimuth and height.
    Cylindrical = 0,
    /// x and y of the box, seen from above.
    Planar = 1,
    /// Azimuth and polar angle about the middle of the box.
    Spherical = 2,
    /// Azimuth and length along the profile.
    Arc = 3,
}

/// The formula by which a height map tilts the normal.
#[repr(u32)]
pub enum RevmapBumpForm {
    /// Gradient along the surface.
    SurfaceGradient = 0,
    /// The published formula, without the factor of the azimuth.
    Papers = 1,
}

/// The part of a solid that the shape box cuts.
#[repr(u32)]
pub enum RevmapClip {
    /// The box cuts nothing that an offset adds: it grows with the offset.
    None = 0,
    /// The box cuts everything outside the profile's box, as in the papers.
    Box = 1,
}

/// The filter that computes slopes from heights.
#[repr(u32)]
pub enum RevmapSlopeFilter {
    /// Scharr's.
    Scharr = 0,
    /// Difference of the two neighbours.
    Central = 1,
}

/// Shadows, by tracing from the surface towards each light.
#[repr(u32)]
pub enum RevmapShadow {
    /// No shadows; nothing is traced.
    Off = 0,
    /// Lit or not.
    Hard = 1,
    /// With a penumbra.
    Soft = 2,
}

/// Functions from the numbers of an enumeration to the library's values, or to those of the same
/// names.
macro_rules! numbers {
    ($($function:ident: $from:ident => $to:ident [$($name:ident)*])*) => {
        numbers! { $($function: $from => $to { $($name => $to::$name),* })* }
    };
    ($($function:ident: $from:ident => $to:ty { $($name:ident => $value:expr),* $(,)? })*) => {
        $(pub(crate) fn $function(number: u32) -> Outcome<$to> {
            let all = [$(($from::$name as u32, $value)),*];
            let found = all.into_iter().find(|(n, _)| *n == number);
            let unknown = || Fault::usage(format!("{number} is no {}", stringify!($from)));
            found.map(|(_, value)| value).ok_or_else(unknown)
        })*
    };
}

/// A search for comparison; `None` without the feature `searches`.
macro_rules! published {
    ($name:ident) => {{
        #[cfg(feature = "searches")]
        let search = Some(revmap_searches::$name);
        #[cfg(not(feature = "searches"))]
        let search = None;
        search
    }};
}

pub(crate) fn solver(number: u32) -> Outcome<Solver> {
    built_solver(number)?.ok_or_else(|| {
        let text =
            format!("solver {number}: this library was built without the feature `searches`");
        Fault::new(RevmapResult::Unsupported, text)
    })
}

numbers! {
    built_solver: RevmapSolver => Option<Solver> {
        Default => Some(Solver::DEFAULT), Linear => published!(LINEAR),
        Relief => published!(RELIEF), Secant => published!(SECANT), Circle => published!(CIRCLE),
        Live => Some(Solver::Live), Cone => published!(CONE), Relaxed => published!(RELAXED),
        Quadric => Some(Solver::Quadric), Exact => Some(Solver::Exact),
    }
    map_source: RevmapMapSource => Option<MapSource> {
        Default => None, Binary => Some(revmap_files::BINARY), Coverage => Some(revmap_files::COVERAGE),
        Exact => Some(MapSource::EXACT),
    }
    planes: RevmapPlanes => Planes {
        Color => Planes::Color, All => Planes::All, Depth => Planes::Depth { parallel: false },
        DepthParallel => Planes::Depth { parallel: true }, List => Planes::List(PlaneList::new(&[])?),
    }
    depth_compare: RevmapDepthCompare => [CompareOp; 2] {
        Nearer => [CompareOp::LESS, CompareOp::GREATER],
        NearerOrEqual => [CompareOp::LESS_OR_EQUAL, CompareOp::GREATER_OR_EQUAL],
        Equal => [CompareOp::EQUAL; 2],
        Farther => [CompareOp::GREATER, CompareOp::LESS],
        FartherOrEqual => [CompareOp::GREATER_OR_EQUAL, CompareOp::LESS_OR_EQUAL],
        NotEqual => [CompareOp::NOT_EQUAL; 2], Always => [CompareOp::ALWAYS; 2],
        Never => [CompareOp::NEVER; 2],
    }
}

numbers! {
    axis: RevmapAxis => ProfileAxis [Center Left]
    map_format: RevmapMapFormat => MapFormat [R32 R16 Rgba8]
    plane: RevmapPlane => RevmapPlane [Srgb8 Color Distance Normal ShadingNormal Albedo Uv Steps]
    attachment: RevmapAttachment => Plane [
        Color BaseColor Normal OctahedralNormal Material Motion Identity
    ]
    depth_order: RevmapDepthOrder => DepthOrder [Normal Reversed]
    pass_kind: RevmapPassKind => RevmapPassKind [Dynamic RenderPass]
    stage: RevmapStage => DrawStage [Fragment Compute]
    projection: RevmapProjection => Projection [Cylindrical Planar Spherical Arc]
    bump_form: RevmapBumpForm => BumpForm [SurfaceGradient Papers]
    clip: RevmapClip => Clip [None Box]
    slope_filter: RevmapSlopeFilter => SlopeFilter [Scharr Central]
    shadow: RevmapShadow => Shadow [Off Hard Soft]
}
