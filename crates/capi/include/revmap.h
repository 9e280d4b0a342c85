/*
 * revmap: solids of revolution, drawn on Vulkan from flat profiles, without a mesh.
 *
 * Made from the sources in crates/capi/src: change those.
 *
 * Results. Every function that can fail returns a RevmapResult. revmap_last_error_text() says why the
 * last one of the calling thread failed. A function that fails leaves what its pointers point to as it
 * was. No function lets an exception or a panic out.
 *
 * Structures. Most begin with their size, which the caller sets before anything else, also of those
 * that a function fills in: `RevmapScene scene = {.size = sizeof scene}; revmap_scene_defaults(&scene);`
 * A structure of the size that an earlier release had is taken: members added since count as zero. One
 * of a later release is taken if all that this library does not know is zero. Nested structures have
 * sizes of their own, which the functions named *_defaults set. All structures of an array have one
 * size. Structures without a size never change. Members named padding are neither read nor used later.
 * Pointers within structures are followed during a call and not kept.
 *
 * Handles. Each is destroyed once, by the function of its name, in any order; the library keeps
 * what other handles still need. A handle that is null, destroyed or of another kind is refused
 * with REVMAP_RESULT_HANDLE.
 *
 * Threads. Functions may be called from any thread, but only one thread at a time uses a RevmapRenderer
 * or a RevmapOffscreen. A second one is refused with REVMAP_RESULT_BUSY: nothing is harmed.
 */

#ifndef REVMAP_H
#define REVMAP_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

/// Number of this interface. The number grows when a function or a field is removed or changes its
/// meaning.
#define REVMAP_ABI 1

/// The result of a function: success, or the kind of its failure. A failure changes only what the
/// failing function's documentation says, and leaves a text for revmap_last_error_text().
enum RevmapResult
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Done.
    REVMAP_RESULT_OK = 0,
    /// Invalid arguments: a null pointer, a wrong size, an unknown number, a call out of order.
    REVMAP_RESULT_USAGE = 1,
    /// A value of a scene, profile or map that cannot be drawn; the text begins with its name.
    REVMAP_RESULT_CONTENT = 2,
    /// A file that cannot be read or written; the text begins with its name.
    REVMAP_RESULT_FILE = 3,
    /// No Vulkan device, or one that lacks a feature, a format or an extension.
    REVMAP_RESULT_UNSUPPORTED = 4,
    /// More pixels, texels, copies or tables than the device or the library takes.
    REVMAP_RESULT_TOO_LARGE = 5,
    /// The host's memory is full.
    REVMAP_RESULT_OUT_OF_HOST_MEMORY = 6,
    /// The device's memory, or its budget, is full.
    REVMAP_RESULT_OUT_OF_DEVICE_MEMORY = 7,
    /// The device was lost: destroy all that was made on it, and open it again.
    REVMAP_RESULT_DEVICE_LOST = 8,
    /// A fault of the driver, or messages of the validation layers.
    REVMAP_RESULT_OTHER = 9,
    /// A handle that is null, destroyed or of another kind.
    REVMAP_RESULT_HANDLE = 10,
    /// A handle that another thread uses at this moment.
    REVMAP_RESULT_BUSY = 11,
    /// A fault of the library. The handles of the call can only be destroyed.
    REVMAP_RESULT_INTERNAL = 12,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapResult RevmapResult;
#else
typedef int32_t RevmapResult;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The part of a picture or a drawing that is the half-plane to be turned.
enum RevmapAxis
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// The axis is the middle: the picture is a whole silhouette, and its right half is used.
    REVMAP_AXIS_CENTER = 0,
    /// The axis is the left edge: the picture is a half profile.
    REVMAP_AXIS_LEFT = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapAxis RevmapAxis;
#else
typedef uint32_t RevmapAxis;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The search for the first hit along a ray. Linear, relief, secant, circle, cone and relaxed are
/// for comparison: a library that is built without the feature `searches` refuses them with
/// REVMAP_RESULT_UNSUPPORTED.
enum RevmapSolver
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// The default of this version: REVMAP_SOLVER_EXACT.
    REVMAP_SOLVER_DEFAULT = 0,
    /// Equal steps along the ray.
    REVMAP_SOLVER_LINEAR = 1,
    /// Equal steps, then halvings: relief mapping.
    REVMAP_SOLVER_RELIEF = 2,
    /// Equal steps, then secants: interval mapping.
    REVMAP_SOLVER_SECANT = 3,
    /// Circle tracing with 20 steps, as published.
    REVMAP_SOLVER_CIRCLE = 4,
    /// Safe steps on the map only, under every offset; rebuilds nothing when an offset changes.
    REVMAP_SOLVER_LIVE = 5,
    /// Cone step mapping, for profiles that are single-valued in z.
    REVMAP_SOLVER_CONE = 6,
    /// Relaxed cone step mapping.
    REVMAP_SOLVER_RELAXED = 7,
    /// The boundary as pieces of quadrics, solved exactly.
    REVMAP_SOLVER_QUADRIC = 8,
    /// The pieces of REVMAP_SOLVER_QUADRIC, found by the rasteriser or by tiles of pixels.
    REVMAP_SOLVER_EXACT = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapSolver RevmapSolver;
#else
typedef uint32_t RevmapSolver;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The source of the distances of a shape map.
enum RevmapMapSource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// The most accurate for the profile.
    REVMAP_MAP_SOURCE_DEFAULT = 0,
    /// Distance to the nearest solid pixel's centre of a binary image.
    REVMAP_MAP_SOURCE_BINARY = 1,
    /// Distance to the outline traced from 8 bits of coverage.
    REVMAP_MAP_SOURCE_COVERAGE = 2,
    /// Exact distance to the outline.
    REVMAP_MAP_SOURCE_EXACT = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapMapSource RevmapMapSource;
#else
typedef uint32_t RevmapMapSource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The format of the distances of a shape map on the device.
enum RevmapMapFormat
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Signed distance as a 32-bit float.
    REVMAP_MAP_FORMAT_R32 = 0,
    /// Signed distance as a 16-bit float.
    REVMAP_MAP_FORMAT_R16 = 1,
    /// Gradient, distance and form, 8 bits each.
    REVMAP_MAP_FORMAT_RGBA8 = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapMapFormat RevmapMapFormat;
#else
typedef uint32_t RevmapMapFormat;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The planes of a picture to draw.
enum RevmapPlanes
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Colour only. A pass gets linear RGBA, which the attachment's format encodes: give a view of an
    /// _SRGB format. An attachment of a _UNORM format holds linear values, and a float format keeps
    /// values above 1. Compute and pictures without a host have 8-bit sRGB.
    REVMAP_PLANES_COLOR = 0,
    /// Every plane of RevmapPlane, in 32-bit floats.
    REVMAP_PLANES_ALL = 1,
    /// Depth only, for shadow maps, in a host's pass.
    REVMAP_PLANES_DEPTH = 2,
    /// Depth only, along parallel rays.
    REVMAP_PLANES_DEPTH_PARALLEL = 3,
    /// The attachments of a RevmapPass, as for a G-buffer. In a host's pass, by
    /// REVMAP_SOLVER_EXACT, REVMAP_SOLVER_QUADRIC and REVMAP_SOLVER_LIVE.
    REVMAP_PLANES_LIST = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapPlanes RevmapPlanes;
#else
typedef uint32_t RevmapPlanes;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// A plane that revmap_offscreen_read() returns. Row 0 is on top.
enum RevmapPlane
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// 4 bytes a pixel: sRGB, alpha linear.
    REVMAP_PLANE_SRGB8 = 0,
    /// 4 floats a pixel: linear colour, not multiplied by alpha.
    REVMAP_PLANE_COLOR = 1,
    /// 1 float a pixel: distance from the eye along the ray, world units; infinite without a hit.
    REVMAP_PLANE_DISTANCE = 2,
    /// 3 floats a pixel: unit world normal, without bump.
    REVMAP_PLANE_NORMAL = 3,
    /// 3 floats a pixel: the normal that was shaded.
    REVMAP_PLANE_SHADING_NORMAL = 4,
    /// 3 floats a pixel: colour of the surface before light, linear.
    REVMAP_PLANE_ALBEDO = 5,
    /// 2 floats a pixel: texture coordinates before the texture's repetition and offset.
    REVMAP_PLANE_UV = 6,
    /// 1 float a pixel: look-ups that the search made.
    REVMAP_PLANE_STEPS = 7,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapPlane RevmapPlane;
#else
typedef uint32_t RevmapPlane;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The values of one colour attachment of REVMAP_PLANES_LIST. Channels that it does not name are 0,
/// and alpha is 1.
enum RevmapAttachment
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// The shaded colour, linear RGBA. A float format keeps values above 1.
    REVMAP_ATTACHMENT_COLOR = 0,
    /// The colour of the surface before light, linear RGB.
    REVMAP_ATTACHMENT_BASE_COLOR = 1,
    /// The unit normal in the world, with bumps, facing the eye: x, y, z. Signed or float formats.
    REVMAP_ATTACHMENT_NORMAL = 2,
    /// The same normal as a point of an octahedron that is unfolded to the square -1 to 1: two
    /// channels. Signed or float formats.
    REVMAP_ATTACHMENT_OCTAHEDRAL_NORMAL = 3,
    /// Roughness and metalness of the object, 0 to 1: two channels.
    REVMAP_ATTACHMENT_MATERIAL = 4,
    /// Motion: the position in the picture in the last frame minus the present one, pixels, y
    /// downwards, without jitter: two channels. Float formats. RevmapView holds the last view,
    /// revmap_renderer_end_frame() keeps the last placements.
    REVMAP_ATTACHMENT_MOTION = 5,
    /// The number of the object, as revmap_renderer_object_number() gives it, and the number of the
    /// copy: two channels of VK_FORMAT_R32G32_UINT or VK_FORMAT_R32G32B32A32_UINT. The clear value
    /// should be one that no object has, such as UINT32_MAX.
    REVMAP_ATTACHMENT_IDENTITY = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapAttachment RevmapAttachment;
#else
typedef uint32_t RevmapAttachment;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The near end of the depth range.
enum RevmapDepthOrder
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// 0 is near, fragments pass that are less.
    REVMAP_DEPTH_ORDER_NORMAL = 0,
    /// 1 is near, fragments pass that are greater.
    REVMAP_DEPTH_ORDER_REVERSED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapDepthOrder RevmapDepthOrder;
#else
typedef uint32_t RevmapDepthOrder;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The depth test of a pass: fragments pass that are so, compared with the depth attachment, in
/// either depth order. After a depth prepass of the same objects and view give
/// REVMAP_DEPTH_COMPARE_EQUAL or REVMAP_DEPTH_COMPARE_NEARER_OR_EQUAL.
enum RevmapDepthCompare
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Nearer.
    REVMAP_DEPTH_COMPARE_NEARER = 0,
    /// Nearer, or as near.
    REVMAP_DEPTH_COMPARE_NEARER_OR_EQUAL = 1,
    /// As near.
    REVMAP_DEPTH_COMPARE_EQUAL = 2,
    /// Farther.
    REVMAP_DEPTH_COMPARE_FARTHER = 3,
    /// Farther, or as near.
    REVMAP_DEPTH_COMPARE_FARTHER_OR_EQUAL = 4,
    /// Nearer or farther.
    REVMAP_DEPTH_COMPARE_NOT_EQUAL = 5,
    /// All fragments pass.
    REVMAP_DEPTH_COMPARE_ALWAYS = 6,
    /// No fragment passes.
    REVMAP_DEPTH_COMPARE_NEVER = 7,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapDepthCompare RevmapDepthCompare;
#else
typedef uint32_t RevmapDepthCompare;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The command by which a host begins its pass.
enum RevmapPassKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// By vkCmdBeginRendering.
    REVMAP_PASS_KIND_DYNAMIC = 0,
    /// By vkCmdBeginRenderPass.
    REVMAP_PASS_KIND_RENDER_PASS = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapPassKind RevmapPassKind;
#else
typedef uint32_t RevmapPassKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The stage that traces rays.
enum RevmapStage
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// In fragment shaders.
    REVMAP_STAGE_FRAGMENT = 0,
    /// In compute shaders.
    REVMAP_STAGE_COMPUTE = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapStage RevmapStage;
#else
typedef uint32_t RevmapStage;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The projection that gives the texture coordinates of surface points.
enum RevmapProjection
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Azimuth and height.
    REVMAP_PROJECTION_CYLINDRICAL = 0,
    /// x and y of the box, seen from above.
    REVMAP_PROJECTION_PLANAR = 1,
    /// Azimuth and polar angle about the middle of the box.
    REVMAP_PROJECTION_SPHERICAL = 2,
    /// Azimuth and length along the profile.
    REVMAP_PROJECTION_ARC = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapProjection RevmapProjection;
#else
typedef uint32_t RevmapProjection;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The formula by which a height map tilts the normal.
enum RevmapBumpForm
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Gradient along the surface.
    REVMAP_BUMP_FORM_SURFACE_GRADIENT = 0,
    /// The published formula, without the factor of the azimuth.
    REVMAP_BUMP_FORM_PAPERS = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapBumpForm RevmapBumpForm;
#else
typedef uint32_t RevmapBumpForm;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// The filter that computes slopes from heights.
enum RevmapSlopeFilter
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// Scharr's.
    REVMAP_SLOPE_FILTER_SCHARR = 0,
    /// Difference of the two neighbours.
    REVMAP_SLOPE_FILTER_CENTRAL = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapSlopeFilter RevmapSlopeFilter;
#else
typedef uint32_t RevmapSlopeFilter;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// Shadows, by tracing from the surface towards each light.
enum RevmapShadow
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /// No shadows; nothing is traced.
    REVMAP_SHADOW_OFF = 0,
    /// Lit or not.
    REVMAP_SHADOW_HARD = 1,
    /// With a penumbra.
    REVMAP_SHADOW_SOFT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum RevmapShadow RevmapShadow;
#else
typedef uint32_t RevmapShadow;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/// A texture of colours.
typedef struct RevmapColorMap RevmapColorMap;

/// A Vulkan device, opened by the library or borrowed from a host. Objects made on it keep the
/// parts of it that they need.
typedef struct RevmapDevice RevmapDevice;

/// The slopes of a height map, for bump mapping.
typedef struct RevmapHeightMap RevmapHeightMap;

/// An image of the host for textures of objects. Objects with the same image share draws.
typedef struct RevmapHostImage RevmapHostImage;

/// A scene on a device and a picture that it is drawn into.
typedef struct RevmapOffscreen RevmapOffscreen;

/// Pipelines that a renderer may come to need.
typedef struct RevmapPrewarm RevmapPrewarm;

/// A profile: the solid region of the half-plane (r, z) that is turned about the axis r = 0.
/// Objects keep what they use of it.
typedef struct RevmapProfile RevmapProfile;

/// An object prepared for rays on the CPU, in double precision: for picking and physics. It keeps
/// the values that the object had.
typedef struct RevmapRayCaster RevmapRayCaster;

/// Objects on a device, drawn into the host's targets, with several frames in flight, which use
/// slots in turn. The renderer must not be destroyed before the frames that it recorded are done.
typedef struct RevmapRenderer RevmapRenderer;

/// A host's function of shading for one stage, as SPIR-V. docs/embedding.md has its signature.
typedef struct RevmapShading RevmapShading;

/// Requirements for a device that a host lends. No device extension is needed.
typedef struct RevmapRequirements {
    /// sizeof(RevmapRequirements).
    uint32_t size;
    /// Least Vulkan version of the instance and the device, as VK_MAKE_API_VERSION.
    uint32_t api_version;
    /// The first queue family with graphics and compute.
    uint32_t queue_family;
    /// Features to enable; more may be. A host that draws REVMAP_PLANES_COLOR in a pass, without
    /// RevmapPass.sample_rays, needs none of them.
    VkPhysicalDeviceFeatures features;
} RevmapRequirements;

/// A host's device.
typedef struct RevmapHostDevice {
    /// sizeof(RevmapHostDevice).
    uint32_t size;
    /// The family of the queues to which recorded commands are submitted.
    uint32_t queue_family;
    /// The host's vkGetInstanceProcAddr, through which all functions are found.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    /// The instance.
    VkInstance instance;
    /// The physical device.
    VkPhysicalDevice physical_device;
    /// The device, of Vulkan 1.2 or later.
    VkDevice device;
    /// A queue for RevmapOffscreen, which submits by itself; renderers need none. May be null.
    VkQueue queue;
    /// The features that the device was opened with; null: none.
    const VkPhysicalDeviceFeatures *features;
    /// A pipeline cache of the host's; may be null. Several threads may compile with it at once: it
    /// must be made without VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT, and nothing may
    /// merge other caches into it while pipelines are compiled.
    VkPipelineCache pipeline_cache;
} RevmapHostDevice;

/// Properties of a device.
typedef struct RevmapDeviceInfo {
    /// sizeof(RevmapDeviceInfo).
    uint32_t size;
    /// 1 if the library has opened it with the validation layers, else 0.
    uint32_t validated;
    /// Number of pipelines compiled on it so far.
    uint64_t pipelines_compiled;
    /// Name of the device, UTF-8, ended by 0.
    char name[256];
    /// Driver's name and version, UTF-8, ended by 0.
    char driver[256];
} RevmapDeviceInfo;

/// Bytes that all buffers and images on a device take, by kind of memory.
typedef struct RevmapMemoryUse {
    /// sizeof(RevmapMemoryUse).
    uint32_t size;
    /// 0.
    uint32_t padding;
    /// Device memory that the host cannot map: data that only the device touches.
    uint64_t device;
    /// Device memory that the host can map: data that changes every frame, if there is such memory.
    /// Integrated and software devices have no other.
    uint64_t visible;
    /// Host memory: data that is copied to the device once or read back, and data that changes
    /// every frame if the host can map no device memory.
    uint64_t host;
} RevmapMemoryUse;

/// Distance of the surface from the profile: extend + bevel * min(1 - z, chamfer), object units.
typedef struct RevmapOffset {
    /// Object units; negative insets.
    double extend;
    /// Slope.
    double bevel;
    /// Depth in [0, 1] below the top to which the bevel reaches. The default is 1.
    double chamfer;
} RevmapOffset;

/// Placement of a solid's box. With a scale of (1, 1, 1) the box is one world unit high.
typedef struct RevmapPlacement {
    /// Position of the middle of the box's lower face, world units.
    double position[3];
    /// Unit quaternion: x, y, z, w.
    double rotation[4];
    /// Factors along the object's axes, each positive.
    double scale[3];
} RevmapPlacement;

/// A solid of revolution, drawn once or as many copies. Defaults: revmap_object_defaults().
typedef struct RevmapObjectInfo {
    /// sizeof(RevmapObjectInfo).
    uint32_t size;
    /// Rows of its shape map.
    uint32_t map_rows;
    /// The profile that is turned about the axis. Objects that share a profile share its maps.
    const struct RevmapProfile *profile;
    /// Name in messages, UTF-8; may be null.
    const char *name;
    /// Colours in place of color; may be null.
    const struct RevmapColorMap *color_map;
    /// Heights for bump mapping; may be null.
    const struct RevmapHeightMap *height_map;
    /// Linear RGB.
    float color[3];
    /// Weight of the Blinn-Phong highlight, linear.
    float specular_strength;
    /// Exponent of the highlight.
    float specular_shininess;
    /// A RevmapProjection.
    uint32_t projection;
    /// A RevmapBumpForm.
    uint32_t bump_form;
    /// Not read.
    uint32_t padding;
    /// Depth by which the slopes of height_map are scaled.
    double bump;
    /// Repetitions of textures around and along the solid.
    double texture_repeat[2];
    /// Extension, bevel and chamfer.
    struct RevmapOffset offset;
    /// Position of the axis in the box, each in [0, 1]; the middle is (0.5, 0.5).
    double axis[2];
    /// Number of replicas in the box along x, y, z; at least 1 each.
    uint32_t repeat[3];
    /// 1 to reflect every second replica along x, y, z, else 0.
    uint32_t mirror[3];
    /// A RevmapClip.
    uint32_t clip;
    /// Not read.
    uint32_t padding_2;
    /// Placement of a solid without instances.
    struct RevmapPlacement placement;
    /// Placements of its copies; read during the call; null if there are none.
    const struct RevmapPlacement *instances;
    /// Number of copies; 0: one, at placement.
    size_t instance_count;
    /// 1: roughness and metalness count. 0: the roughness is the one that fits
    /// specular_shininess, and there is no metal.
    uint32_t has_material;
    /// For REVMAP_ATTACHMENT_MATERIAL: 0 (a mirror) to 1.
    float roughness;
    /// For REVMAP_ATTACHMENT_MATERIAL: 0 or 1, or between them.
    float metalness;
    /// Not read.
    uint32_t padding_end;
    /// By how much of themselves textures are moved around the solid, counter-clockwise from above,
    /// and upwards.
    double texture_offset[2];
} RevmapObjectInfo;

/// Settings of the search. Defaults: revmap_search_defaults().
typedef struct RevmapSearch {
    /// sizeof(RevmapSearch).
    uint32_t size;
    /// A RevmapSolver.
    uint32_t solver;
    /// Bound on the search's steps; 0 uses the solver's default.
    uint32_t max_steps;
    /// Rows of every shape map; 0 uses each object's own value.
    uint32_t map_rows;
    /// A RevmapMapSource.
    uint32_t map_source;
    /// A RevmapMapFormat.
    uint32_t map_format;
    /// Least pixels of an object's box for each visible frustum of its cells at which cells are
    /// drawn; below it the box is. It also limits lists of patches in compute, which GPUs make for
    /// solids far wider than high alone. 0: cells and lists in pictures of any size; UINT32_MAX:
    /// neither.
    uint32_t proxy_min_pixels;
    /// Not read.
    uint32_t padding;
    /// Allowed error of silhouettes and depths in pixels of the view, 0 to 64; 0 is exact. Searches
    /// on patches use it.
    double tolerance;
} RevmapSearch;

/// Settings of a picture. Defaults: revmap_picture_defaults().
typedef struct RevmapPicture {
    /// sizeof(RevmapPicture).
    uint32_t size;
    /// Pixels across.
    uint32_t width;
    /// Pixels down.
    uint32_t height;
    /// A RevmapStage.
    uint32_t stage;
    /// REVMAP_PLANES_COLOR or REVMAP_PLANES_ALL.
    uint32_t planes;
    /// Not read.
    uint32_t padding;
    /// Settings of the search.
    struct RevmapSearch search;
} RevmapPicture;

/// A pinhole camera. Defaults: revmap_camera_defaults().
typedef struct RevmapCamera {
    /// sizeof(RevmapCamera).
    uint32_t size;
    /// Not read.
    uint32_t padding;
    /// World units.
    double eye[3];
    /// The point that the camera looks at, world units.
    double target[3];
    /// The upward direction.
    double up[3];
    /// Vertical field of view, degrees, between 0 and 180.
    double fov_y;
} RevmapCamera;

/// A light from afar.
typedef struct RevmapLight {
    /// The way the light of its centre travels; any length but zero.
    double direction[3];
    /// Linear RGB.
    float color[3];
    /// Angular radius of its disc, degrees, 0 to 60. Only soft shadows use it.
    float radius;
} RevmapLight;

/// Lights and shadows of all objects. Defaults: revmap_lighting_defaults().
typedef struct RevmapLighting {
    /// sizeof(RevmapLighting).
    uint32_t size;
    /// A RevmapShadow.
    uint32_t shadow;
    /// Light that comes from everywhere, linear RGB.
    float ambient[3];
    /// Number of lights.
    uint32_t light_count;
    /// The lights; read during the call.
    const struct RevmapLight *lights;
    /// Colour of the environment straight up, along +z, linear RGB. Surfaces reflect it, more at
    /// their rim. Both colours 0: there is none.
    float environment_up[3];
    /// Its colour straight down.
    float environment_down[3];
} RevmapLighting;

/// What is drawn. Defaults: revmap_scene_defaults().
typedef struct RevmapScene {
    /// sizeof(RevmapScene).
    uint32_t size;
    /// Linear RGBA behind everything.
    float background[4];
    /// Not read.
    uint32_t padding;
    /// The eye.
    struct RevmapCamera camera;
    /// Lights and shadows.
    struct RevmapLighting lighting;
    /// The objects, all of one size; read during the call.
    const struct RevmapObjectInfo *objects;
    /// Number of objects.
    size_t object_count;
} RevmapScene;

/// What a picture cost.
typedef struct RevmapTimes {
    /// sizeof(RevmapTimes).
    uint32_t size;
    /// 0.
    uint32_t padding;
    /// CPU time to apply changes and to record, milliseconds.
    double prepare_ms;
    /// Milliseconds between timestamps of the device around the work; negative if it has no
    /// timestamps.
    double gpu_ms;
    /// Milliseconds from submission to completion by the clock.
    double frame_ms;
} RevmapTimes;

/// A ray.
typedef struct RevmapRay {
    /// World units.
    double origin[3];
    /// The direction; any length but zero.
    double direction[3];
} RevmapRay;

/// The first point of a ray on the boundary of an object.
typedef struct RevmapRayHit {
    /// The point is origin + t * direction; infinite without a hit.
    double t;
    /// Unit outward normal in the world, without bumps; zero without a hit.
    double normal[3];
    /// Number of the copy; 0 without copies.
    uint32_t copy;
    /// 1 if the ray starts in the solid and leaves it here, else 0.
    uint32_t leaves;
} RevmapRayHit;

/// The least box around an object, along the axes of the world.
typedef struct RevmapBounds {
    /// Least x, y, z, world units.
    double low[3];
    /// Largest x, y, z, world units. Less than low if nothing of the object is left.
    double high[3];
} RevmapBounds;

/// The pass in which fragments are drawn.
typedef struct RevmapPass {
    /// sizeof(RevmapPass).
    uint32_t size;
    /// A RevmapPassKind.
    uint32_t kind;
    /// Samples of every attachment: 1, 2, 4 or 8. Rays go through pixel centres with any number,
    /// unless sample_rays says otherwise.
    uint32_t samples;
    /// A RevmapDepthOrder.
    uint32_t depth_order;
    /// A RevmapPlanes: what the fragment shader writes, one plane an attachment.
    uint32_t planes;
    /// For a render pass: the subpass, which has a depth attachment.
    uint32_t subpass;
    /// For a render pass: the pass. The pass must live as long as the renderer. Passes that are
    /// compatible with it may be begun instead.
    VkRenderPass render_pass;
    /// For dynamic rendering: formats of the colour attachments; read during the call. Colours are
    /// linear, and the format encodes them: see REVMAP_PLANES_COLOR.
    const VkFormat *color_formats;
    /// For dynamic rendering: number of the colour attachments.
    uint32_t color_format_count;
    /// For dynamic rendering: format of the depth attachment.
    VkFormat depth_format;
    /// For dynamic rendering: format of the stencil attachment; VK_FORMAT_UNDEFINED if there is
    /// none.
    VkFormat stencil_format;
    /// Not read.
    uint32_t padding;
    /// For REVMAP_PLANES_LIST: a RevmapAttachment for each colour attachment, in order, none twice;
    /// read during the call.
    const uint32_t *attachments;
    /// For REVMAP_PLANES_LIST: number of attachments.
    uint32_t attachment_count;
    /// 1 for a ray through each sample, so that silhouettes are smooth; a pixel costs as many rays,
    /// and the device needs the feature sampleRateShading. 0 for one ray through the pixel's
    /// centre, which all samples share.
    uint32_t sample_rays;
    /// A RevmapDepthCompare.
    uint32_t depth_compare;
    /// 1 to leave the depth attachment as it is, 0 to write depths.
    uint32_t depth_read_only;
    /// 1 or 0. A pass draws one view, and its view mask is 0: begin a pass for each view, and prepare
    /// each view in a slot of its own.
    uint32_t views;
    /// For REVMAP_PLANES_DEPTH and REVMAP_PLANES_DEPTH_PARALLEL: depths move away from the eye by
    /// this times the slope, the larger change of depth from a pixel to the next. 0 for no bias.
    float slope_bias;
    /// The most that slope_bias moves a depth, units of the depth buffer; above 0 with a slope_bias.
    float slope_bias_limit;
    /// Not read.
    uint32_t padding_end;
} RevmapPass;

/// The target of compute shaders, and of fragments of REVMAP_PLANES_ALL besides their attachments.
typedef struct RevmapComputeTarget {
    /// sizeof(RevmapComputeTarget).
    uint32_t size;
    /// Number of images: 4 for REVMAP_PLANES_ALL in compute, else 0.
    uint32_t image_count;
    /// A storage buffer of two 32-bit words a pixel, row by row from the top: the depths of all
    /// pixels, as bits of floats; then a second word of each, which is the colour, packed as
    /// R8G8B8A8_SRGB, for REVMAP_PLANES_COLOR, else a count of look-ups. The host clears it before
    /// a frame, depths to 1.0 and colours to its background, or fills in what is already drawn.
    VkBuffer words;
    /// Storage images of all planes, R32G32B32A32_SFLOAT in the layout GENERAL; read during the
    /// call.
    const VkImageView *images;
} RevmapComputeTarget;

/// A host's view. Vectors are columns, matrices are stored column by column, clip space is Vulkan's
/// (0 <= z <= w). A projection whose depth runs against depth_order is refused. The near plane cuts
/// solids as it cuts meshes.
typedef struct RevmapView {
    /// sizeof(RevmapView).
    uint32_t size;
    /// A RevmapDepthOrder: the one of the renderer's output.
    uint32_t depth_order;
    /// Matrix from world to view space.
    double view[16];
    /// Matrix from view to clip space.
    double projection[16];
    /// Viewport in pixels: x, y, width, height. A negative height turns it upside down, as in
    /// Vulkan 1.1.
    double viewport[4];
    /// The view of the last frame, for REVMAP_ATTACHMENT_MOTION; its viewport may differ. Null:
    /// only objects move. Read during the call; its own last is not read.
    const struct RevmapView *last;
    /// Shift of the picture by the jitter that projection contains, pixels: x to the right, y
    /// downwards. Motion leaves it out.
    double jitter[2];
    /// Shift of all depths, in units of the depth buffer, for shadow maps: positive is farther in
    /// REVMAP_DEPTH_ORDER_NORMAL and nearer in REVMAP_DEPTH_ORDER_REVERSED.
    double depth_bias;
    /// The view shows the objects whose mask shares a bit with this one; 0: objects of any mask
    /// but 0. See revmap_renderer_set_mask().
    uint32_t mask;
    /// 0: a pass has one view. See RevmapPass.views.
    uint32_t layer;
    /// minDepth and maxDepth of the host's VkViewport, which do not reach depths that a shader
    /// writes by themselves: 0 <= minDepth < maxDepth <= 1. Both 0: 0 to 1.
    double depth_range[2];
    /// Width of the part of a pixel that a ray stands for, pixels: 1 / sqrt(n) if the colours of n
    /// frames with jitter are averaged. Textures are as sharp as that. 0: 1.
    double ray_width;
} RevmapView;

/// An object of one renderer, which refuses those of others; never 0. The number refers to the same
/// object for all its values, and is never reused after its removal.
typedef uint64_t RevmapObject;

/// Contents and work of a renderer.
typedef struct RevmapStatistics {
    /// sizeof(RevmapStatistics).
    uint32_t size;
    /// Objects.
    uint32_t objects;
    /// Surfaces made so far: one for each profile under each offset that no object had in the frame
    /// before.
    uint64_t surfaces_made;
    /// Bytes of shape maps with their tables of lengths, on the device.
    uint64_t shape_map_bytes;
    /// Bytes of colour and height maps, on the device.
    uint64_t texture_bytes;
    /// Objects that the last prepared frame does not draw at all.
    uint32_t drawn_not;
    /// Number of objects drawn by their boxes.
    uint32_t drawn_by_box;
    /// Number of objects drawn by hulls.
    uint32_t drawn_by_hull;
    /// Number of objects drawn by rays that walk to copies: all of them in compute.
    uint32_t drawn_by_tiles;
    /// Notes that revmap_renderer_note() gives.
    uint32_t notes;
    /// 0.
    uint32_t padding;
} RevmapStatistics;

/// What the frame that was prepared for a slot records.
typedef struct RevmapFrameStatistics {
    /// sizeof(RevmapFrameStatistics).
    uint32_t size;
    /// Objects of which a part may show.
    uint32_t objects;
    /// Draws, those of one indirect command counted one by one.
    uint32_t draws;
    /// Dispatches.
    uint32_t dispatches;
    /// Draws and dispatches that are left out, because their pipelines are not compiled; see
    /// revmap_renderer_hide_until_compiled().
    uint32_t hidden;
    /// Tiles of fragments, and work groups of dispatches whose number the host knows.
    uint32_t tiles;
    /// Bytes of the slot's buffers.
    uint64_t slot_bytes;
    /// CPU time of the preparation, milliseconds of the clock.
    double prepare_ms;
    /// CPU time of the last recording of the frame, milliseconds; 0 before.
    double record_ms;
} RevmapFrameStatistics;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/// Version of the library, such as "0.1.0".
const char *revmap_version(void);

/// REVMAP_ABI of the library, to be compared with that of the header.
uint32_t revmap_abi(void);

/// Returns the requirements for a physical device that a host lends. The size of requirements must
/// be set.
///
/// Fails with REVMAP_RESULT_UNSUPPORTED for a device that lacks something; the text says what is
/// missing.
RevmapResult revmap_requirements(PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                 VkInstance instance,
                                 VkPhysicalDevice physical_device,
                                 struct RevmapRequirements *requirements);

/// Opens a device of the library's own. choice is its index or a part of its name; null takes the
/// environment's REVMAP_DEVICE, else the first of discrete, integrated, virtual and CPU devices.
/// validate, if not 0, switches the validation layers on, as does REVMAP_VALIDATION=1 in the
/// environment.
///
/// Fails with REVMAP_RESULT_UNSUPPORTED if no device meets the requirements.
RevmapResult revmap_device_open(const char *choice,
                                uint32_t validate,
                                struct RevmapDevice **device);

/// Borrows a host's device. All handles belong together. The handles must stay valid until this
/// handle and everything made with it are destroyed, and the device is idle.
///
/// Fails with REVMAP_RESULT_UNSUPPORTED for a device that lacks something.
RevmapResult revmap_device_borrow(const struct RevmapHostDevice *host,
                                  struct RevmapDevice **device);

/// Returns the properties of a device. The size of info must be set.
RevmapResult revmap_device_info(const struct RevmapDevice *device, struct RevmapDeviceInfo *info);

/// Fails with REVMAP_RESULT_OTHER if the validation layers have reported a message since the last
/// call. A borrowed device's host has its own messenger, and this function always succeeds.
RevmapResult revmap_device_check(const struct RevmapDevice *device);

/// Labels the commands and names the buffers of all renderers of a device from now on, for
/// debuggers of frames. The host's instance was made with VK_EXT_debug_utils.
RevmapResult revmap_device_enable_debug_labels(const struct RevmapDevice *device);

/// Returns the memory that all buffers and images on a device take. The size of memory must be set.
RevmapResult revmap_device_memory_use(const struct RevmapDevice *device,
                                      struct RevmapMemoryUse *memory);

/// Adds compiled pipelines that revmap_device_pipeline_cache() gave in another process. Data of
/// another device or driver is ignored. Damaged and other bytes are refused, and so are all for a
/// device that was borrowed with a pipeline cache.
RevmapResult revmap_device_add_pipeline_cache(const struct RevmapDevice *device,
                                              const void *bytes,
                                              size_t count);

/// Returns the driver's compiled pipelines, behind a mark and a hash. With null bytes, count becomes their number. Otherwise
/// count is the room in bytes, which must be large enough, and becomes the number of bytes written.
/// The number grows as pipelines are compiled.
RevmapResult revmap_device_pipeline_cache(const struct RevmapDevice *device,
                                          void *bytes,
                                          size_t *count);

/// Destroys a device; null is none. Objects made with it stay usable.
RevmapResult revmap_device_destroy(struct RevmapDevice *device);

/// The kind of this thread's last failure; REVMAP_RESULT_OK if there was none.
RevmapResult revmap_last_error(void);

/// The reason of this thread's last failure: one line of UTF-8 with the cause and the remedy. Empty
/// if none has failed. The text lasts until the next failure on this thread, or the thread's end.
const char *revmap_last_error_text(void);

/// Fills in an object without a profile: light grey, plain, at the origin, one world unit high. The
/// size must be set.
RevmapResult revmap_object_defaults(struct RevmapObjectInfo *object);

/// Fills in 800x600 pixels, REVMAP_STAGE_FRAGMENT, REVMAP_PLANES_COLOR and the default search. The
/// size must be set.
RevmapResult revmap_picture_defaults(struct RevmapPicture *picture);

/// Fills in a scene without objects before transparent black, with the default camera and lights.
/// The size must be set.
RevmapResult revmap_scene_defaults(struct RevmapScene *scene);

/// Takes a scene onto a device, with a picture to draw it into. A borrowed device must have a
/// queue, which nobody else uses while a picture is drawn or read.
RevmapResult revmap_offscreen_create(const struct RevmapDevice *device,
                                     const struct RevmapPicture *picture,
                                     const struct RevmapScene *scene,
                                     struct RevmapOffscreen **offscreen);

/// Updates the picture to another scene. The cost depends on the differences from the former scene.
/// If it fails, the former scene can still be drawn.
RevmapResult revmap_offscreen_update(struct RevmapOffscreen *offscreen,
                                     const struct RevmapScene *scene);

/// Compiles every pipeline that updates can come to need, as long as no object's technique changes.
RevmapResult revmap_offscreen_prewarm(struct RevmapOffscreen *offscreen);

/// Draws the picture and waits for it. times may be null; else its size must be set.
RevmapResult revmap_offscreen_draw(struct RevmapOffscreen *offscreen, struct RevmapTimes *times);

/// Reads a plane of the picture that was drawn last: width * height pixels, row by row from the
/// top. plane is a RevmapPlane; REVMAP_PLANES_COLOR has REVMAP_PLANE_SRGB8 and REVMAP_PLANE_COLOR.
/// count is the number of bytes, which must be exact.
RevmapResult revmap_offscreen_read(struct RevmapOffscreen *offscreen,
                                   uint32_t plane,
                                   void *bytes,
                                   size_t count);

/// Writes the picture that was drawn last as a PNG file of 8-bit sRGB with alpha. The path is
/// UTF-8.
RevmapResult revmap_offscreen_write_png(struct RevmapOffscreen *offscreen, const char *path);

/// Destroys a picture; null is none.
RevmapResult revmap_offscreen_destroy(struct RevmapOffscreen *offscreen);

/// Makes a profile from a closed polygon: count points, each r and z in object units. The box
/// reaches from z = 0 to z = 1 and to the given radius.
///
/// Fails with REVMAP_RESULT_CONTENT for fewer than 3 points, a point with r < 0, no area, or
/// numbers that are not finite.
RevmapResult revmap_profile_from_points(const double (*points)[2],
                                        size_t count,
                                        double radius,
                                        struct RevmapProfile **profile);

/// Makes a profile from the content of an SVG, PNG or JPEG file, told apart by what is in it.
/// Everything darker than one half over white is solid; the picture's height is one object unit.
/// axis is a RevmapAxis.
///
/// Fails with REVMAP_RESULT_FILE if that is not possible, and with REVMAP_RESULT_CONTENT if there
/// is nothing to turn.
RevmapResult revmap_profile_from_bytes(const void *bytes,
                                       size_t count,
                                       uint32_t axis,
                                       struct RevmapProfile **profile);

/// Makes a profile from a file, as revmap_profile_from_bytes() does from its content. The path is
/// UTF-8.
RevmapResult revmap_profile_from_file(const char *path,
                                      uint32_t axis,
                                      struct RevmapProfile **profile);

/// Returns the radius of the profile's box, object units.
RevmapResult revmap_profile_radius(const struct RevmapProfile *profile, double *radius);

/// Destroys a profile; null is none. Objects that were made from it stay as they are.
RevmapResult revmap_profile_destroy(struct RevmapProfile *profile);

/// Prepares an object for rays, without a device.
///
/// Fails with REVMAP_RESULT_CONTENT for values out of range, or if the contour under the offset does
/// not close. If nothing of the solid is left, rays hit nothing.
RevmapResult revmap_ray_caster_create(const struct RevmapObjectInfo *object,
                                      struct RevmapRayCaster **ray_caster);

/// Finds the first hit of each ray at t >= 0: the surface that is drawn, without bumps. A ray that
/// starts in a copy hits the point where it leaves that copy. A ray with a number that is not
/// finite, or without a direction, hits nothing. Both arrays have count elements.
RevmapResult revmap_ray_caster_cast(const struct RevmapRayCaster *ray_caster,
                                    const struct RevmapRay *rays,
                                    size_t count,
                                    struct RevmapRayHit *hits);

/// Returns the least box around the object, all of its copies.
RevmapResult revmap_ray_caster_bounds(const struct RevmapRayCaster *ray_caster,
                                      struct RevmapBounds *bounds);

/// Destroys a ray caster; null is none.
RevmapResult revmap_ray_caster_destroy(struct RevmapRayCaster *ray_caster);

/// Makes a renderer without objects that draws fragments in a host's pass. A null search is the
/// default one. frames is the number of slots, 1 to 64: frames in flight times views.
RevmapResult revmap_renderer_create(const struct RevmapDevice *device,
                                    const struct RevmapPass *pass,
                                    const struct RevmapSearch *search,
                                    uint32_t frames,
                                    struct RevmapRenderer **renderer);

/// Makes a renderer without objects that traces in compute shaders, into a RevmapComputeTarget.
/// planes is a RevmapPlanes. A null search is the default one. frames is the number of slots, 1 to
/// 64: frames in flight times views.
RevmapResult revmap_renderer_create_compute(const struct RevmapDevice *device,
                                            uint32_t planes,
                                            const struct RevmapSearch *search,
                                            uint32_t frames,
                                            struct RevmapRenderer **renderer);

/// Makes a renderer as revmap_renderer_create() does, with a host's function that shades in place of
/// the library's. The function takes no lights of revmap_renderer_set_lighting(). set_layout is the
/// layout of descriptor set 3, for fragments; null if the function reads none. The layout has every
/// binding that the function reads, and lives as long as the renderer.
///
/// Whenever the renderer records, a set of the layout is bound at number 3 with
/// revmap_renderer_pipeline_layout().
///
/// Fails with REVMAP_RESULT_USAGE for a shading of the other stage, for a pass without colour, and for
/// a function that reads set 3 if the layout is null.
RevmapResult revmap_renderer_create_with_shading(const struct RevmapDevice *device,
                                                 const struct RevmapPass *pass,
                                                 const struct RevmapShading *shading,
                                                 VkDescriptorSetLayout set_layout,
                                                 const struct RevmapSearch *search,
                                                 uint32_t frames,
                                                 struct RevmapRenderer **renderer);

/// Makes a renderer as revmap_renderer_create_compute() does, with a host's function that shades as in
/// revmap_renderer_create_with_shading(). planes must be REVMAP_PLANES_COLOR; set_layout is for
/// compute.
RevmapResult revmap_renderer_create_compute_with_shading(const struct RevmapDevice *device,
                                                         uint32_t planes,
                                                         const struct RevmapShading *shading,
                                                         VkDescriptorSetLayout set_layout,
                                                         const struct RevmapSearch *search,
                                                         uint32_t frames,
                                                         struct RevmapRenderer **renderer);

/// Returns the layout of all pipelines of a renderer, with which a host binds its set 3. The layout
/// lives as long as the renderer.
RevmapResult revmap_renderer_pipeline_layout(struct RevmapRenderer *renderer,
                                             VkPipelineLayout *layout);

/// Sets lights and shadows for all objects.
RevmapResult revmap_renderer_set_lighting(struct RevmapRenderer *renderer,
                                          const struct RevmapLighting *lighting);

/// Sets the target of compute, from the next prepared frame on. The handles are of the renderer's
/// device, large enough for every view's viewport, which begins at 0. The handles live until
/// another target is set and the frames recorded before are done.
///
/// Fails with REVMAP_RESULT_USAGE if the renderer's shaders write to no such target.
RevmapResult revmap_renderer_set_compute_target(struct RevmapRenderer *renderer,
                                                const struct RevmapComputeTarget *target);

/// With hides not 0, revmap_renderer_prepare() compiles no pipeline: draws that need one that is
/// not compiled are left out, until revmap_prewarm_compile() has made it on another thread.
/// RevmapFrameStatistics counts what is left out. A new renderer compiles what it needs.
RevmapResult revmap_renderer_hide_until_compiled(struct RevmapRenderer *renderer, uint32_t hides);

/// Returns the second word of a pixel of a linear colour, for REVMAP_PLANES_COLOR: the clear value
/// of a RevmapComputeTarget's colours.
uint32_t revmap_color_word(float red, float green, float blue, float alpha);

/// Destroys a renderer; null is none. The frames that it recorded must be done.
RevmapResult revmap_renderer_destroy(struct RevmapRenderer *renderer);

/// Prepares the frame of a slot: applies the values that were set, writes those that changed,
/// records copies of new textures. The host calls it in every frame before
/// revmap_renderer_record(). This function neither submits nor waits.
///
/// The frame may be recorded once, several times or never, and its commands may be dropped: copies of
/// a texture are recorded in every prepared frame until one of these frames has run. A call that
/// fails records nothing, and the values that were set stay set: the next call tries them again.
///
/// The command buffer is recording, outside of a pass, for a queue of the device's family. Commands
/// of revmap_renderer_record() and revmap_renderer_record_compute() for earlier frames of this slot
/// have run, or are never submitted; those of earlier calls of this function may also be in
/// command_buffer. Command buffers of prepared frames are submitted to one queue, in the order of
/// this call.
///
/// Fails with REVMAP_RESULT_CONTENT for an object that cannot be drawn, until it is set right or
/// removed. The text begins with the object's number.
RevmapResult revmap_renderer_prepare(struct RevmapRenderer *renderer,
                                     VkCommandBuffer command_buffer,
                                     uint32_t slot,
                                     const struct RevmapView *view);

/// Ends a frame of all views: the motion of the next frame is that from the present values. The
/// host calls it before the next frame's changes. Objects that were added since the last call begin
/// without motion. Renderers without REVMAP_ATTACHMENT_MOTION need no call.
RevmapResult revmap_renderer_end_frame(struct RevmapRenderer *renderer);

/// Prepares the frame like revmap_renderer_prepare(), seen by a camera in pictures of width *
/// height pixels. Depth is 0 at near and 1 at far, both along the view, and near cuts solids. The
/// output's depth order is REVMAP_DEPTH_ORDER_NORMAL.
RevmapResult revmap_renderer_prepare_camera(struct RevmapRenderer *renderer,
                                            VkCommandBuffer command_buffer,
                                            uint32_t slot,
                                            const struct RevmapCamera *camera,
                                            uint32_t width,
                                            uint32_t height,
                                            double near,
                                            double far);

/// Records the draws of the frame that was prepared for a slot. The function binds pipelines,
/// descriptor sets 0 to 2 and an index buffer. It sets neither viewport nor scissor, which are
/// dynamic.
///
/// The command buffer is recording, within a pass that is compatible with the output, with the
/// view's viewport and a scissor set. The renderer lives, and the slot is not prepared again, until
/// the commands have run.
///
/// Fails with REVMAP_RESULT_USAGE, and records nothing, if the slot is not prepared. Values set
/// since then are not drawn yet.
RevmapResult revmap_renderer_record(struct RevmapRenderer *renderer,
                                    VkCommandBuffer command_buffer,
                                    uint32_t slot);

/// Records the dispatches of the frame that was prepared for a slot, into a target that was
/// cleared. The function records barriers between its own dispatches, none before its first and
/// none after its last write.
///
/// The command buffer is recording, outside of a pass; writes to the target before are made
/// available to compute shaders. The renderer lives, and the slot is not prepared again, until the
/// commands have run.
///
/// Fails like revmap_renderer_record().
RevmapResult revmap_renderer_record_compute(struct RevmapRenderer *renderer,
                                            VkCommandBuffer command_buffer,
                                            uint32_t slot);

/// Lists the general form of every pipeline that the objects may need. Once these are compiled,
/// revmap_renderer_prepare() compiles and hides nothing while parameters, lights, masks, placements,
/// the view, and the numbers of objects and copies change. Other techniques make others necessary:
/// textures where there were none, replicas, shadows. Nothing is compiled yet.
RevmapResult revmap_renderer_prewarm(struct RevmapRenderer *renderer,
                                     struct RevmapPrewarm **prewarm);

/// Lists the pipelines that would draw the frames of all slots faster. Once they are compiled, the next
/// revmap_renderer_prepare() takes them. The list is empty once nothing is faster.
RevmapResult revmap_renderer_special_forms(struct RevmapRenderer *renderer,
                                           struct RevmapPrewarm **prewarm);

/// Compiles those that are not compiled yet. Another thread may use the renderer meanwhile, or
/// destroy it.
RevmapResult revmap_prewarm_compile(const struct RevmapPrewarm *prewarm);

/// Returns the number of pipelines, compiled or not.
RevmapResult revmap_prewarm_count(const struct RevmapPrewarm *prewarm, size_t *count);

/// Destroys the list; null is none. Compiled pipelines stay.
RevmapResult revmap_prewarm_destroy(struct RevmapPrewarm *prewarm);

/// Records draws of no pixel, or dispatches of no group, with every pipeline of
/// revmap_renderer_prewarm(): some drivers compile shaders at the first draw, and do it when these
/// commands run. In a pass it sets the scissor, too, to nothing.
///
/// The slot is prepared; the caller meets the conditions of revmap_renderer_record() or
/// revmap_renderer_record_compute().
RevmapResult revmap_renderer_record_prewarm(struct RevmapRenderer *renderer,
                                            VkCommandBuffer command_buffer,
                                            uint32_t slot);

/// Adds an object, which is drawn from the next prepared frame on.
///
/// Fails with REVMAP_RESULT_CONTENT for values out of range.
RevmapResult revmap_renderer_add(struct RevmapRenderer *renderer,
                                 const struct RevmapObjectInfo *info,
                                 RevmapObject *object);

/// Removes an object. Data that frames in flight read is kept until they are done.
///
/// Fails with REVMAP_RESULT_USAGE for an object that is not there, as do all functions that take
/// one.
RevmapResult revmap_renderer_remove(struct RevmapRenderer *renderer, RevmapObject object);

/// Gives an object other values, all of them. Values that are equal cost nothing.
///
/// Fails with REVMAP_RESULT_CONTENT for values out of range.
RevmapResult revmap_renderer_set(struct RevmapRenderer *renderer,
                                 RevmapObject object,
                                 const struct RevmapObjectInfo *info);

/// Sets which views show an object: those whose mask shares a bit with this one. With 0 no view
/// shows it. A hidden object throws no shadow. New objects are in all masks.
RevmapResult revmap_renderer_set_mask(struct RevmapRenderer *renderer,
                                      RevmapObject object,
                                      uint32_t mask);

/// Returns the number of an object in REVMAP_ATTACHMENT_IDENTITY. No two objects of a renderer have
/// the same one at a time.
RevmapResult revmap_renderer_object_number(const struct RevmapRenderer *renderer,
                                           RevmapObject object,
                                           uint32_t *number);

/// Prepares an object for rays, with the values that it has now.
///
/// Fails like revmap_ray_caster_create().
RevmapResult revmap_renderer_ray_caster(const struct RevmapRenderer *renderer,
                                        RevmapObject object,
                                        struct RevmapRayCaster **ray_caster);

/// Moves the surface of an object: extension, bevel and chamfer.
///
/// Fails like revmap_renderer_set().
RevmapResult revmap_renderer_set_offset(struct RevmapRenderer *renderer,
                                        RevmapObject object,
                                        const struct RevmapOffset *offset);

/// Moves an object that is one copy.
///
/// Fails like revmap_renderer_set().
RevmapResult revmap_renderer_set_placement(struct RevmapRenderer *renderer,
                                           RevmapObject object,
                                           const struct RevmapPlacement *placement);

/// Gives an object other copies; with a count of 0 it is one, at its placement.
///
/// Fails like revmap_renderer_set().
RevmapResult revmap_renderer_set_instances(struct RevmapRenderer *renderer,
                                           RevmapObject object,
                                           const struct RevmapPlacement *instances,
                                           size_t count);

/// Makes an image of a 2D view and a sampler, both of the renderer's device. They stay valid while
/// revmap_host_image_is_held() gives 1, and until commands recorded before have run. The image is in
/// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL while recorded frames run, and its writes are visible to
/// the stage that draws.
RevmapResult revmap_host_image_create(VkImageView view,
                                      VkSampler sampler,
                                      struct RevmapHostImage **image);

/// Returns 1 if an object or a slot holds the image, else 0. A slot holds the images of its last frame
/// until it is prepared again.
RevmapResult revmap_host_image_is_held(const struct RevmapHostImage *image,
                                       uint32_t *held);

/// Destroys the handle; null is none. Objects keep the image, and the handle can no longer say whether
/// it is held.
RevmapResult revmap_host_image_destroy(struct RevmapHostImage *image);

/// Sets an image as the colours of an object, in place of its color_map; null for that map again.
/// What is read counts as linear: give sRGB texels a view of an _SRGB format. Frames that were prepared
/// earlier keep their image.
RevmapResult revmap_renderer_set_color_image(struct RevmapRenderer *renderer,
                                             RevmapObject object,
                                             const struct RevmapHostImage *image);

/// Sets an image as the slopes of an object, in place of its height_map; null for that map again. The
/// first two channels are the slopes of heights over texture coordinates: to the right over the whole
/// width, upwards over the whole height. It replaces an image of heights.
RevmapResult revmap_renderer_set_slope_image(struct RevmapRenderer *renderer,
                                             RevmapObject object,
                                             const struct RevmapHostImage *image);

/// Same as revmap_renderer_set_slope_image, for an image whose first channel is heights, 0 to 1. Each
/// pixel reads it four times: an image of slopes is faster. It replaces an image of slopes.
RevmapResult revmap_renderer_set_height_image(struct RevmapRenderer *renderer,
                                              RevmapObject object,
                                              const struct RevmapHostImage *image);

/// Returns the contents and work of a renderer. The size of statistics must be set.
RevmapResult revmap_renderer_statistics(const struct RevmapRenderer *renderer,
                                        struct RevmapStatistics *statistics);

/// Returns what the frame that was prepared for a slot records. The size of statistics must be set.
///
/// Fails with REVMAP_RESULT_USAGE if the slot is not prepared.
RevmapResult revmap_renderer_frame_statistics(const struct RevmapRenderer *renderer,
                                              uint32_t slot,
                                              struct RevmapFrameStatistics *statistics);

/// Returns a note: a deviation from the settings, and its reason. The text lasts as long as the
/// renderer.
RevmapResult revmap_renderer_note(const struct RevmapRenderer *renderer,
                                  uint32_t number,
                                  const char **note);

/// Reads a shading that the program `revmap shading` or revmap_shading_bytes() has written.
///
/// Fails with REVMAP_RESULT_CONTENT for bytes of another version of the library, and for damaged
/// bytes.
RevmapResult revmap_shading_from_bytes(const void *bytes,
                                       size_t count,
                                       struct RevmapShading **shading);

/// Compiles GLSL: count files, each with a name and a text in UTF-8. The first defines the function,
/// the others are those that it includes, by their names in #include. stage is a RevmapStage.
///
/// Fails with REVMAP_RESULT_CONTENT for GLSL that does not compile, with file, line and message; with
/// REVMAP_RESULT_USAGE if the library was built without the feature `shaderc`.
RevmapResult revmap_shading_compile(uint32_t stage,
                                    const char *const *names,
                                    const char *const *texts,
                                    size_t count,
                                    struct RevmapShading **shading);

/// Returns a shading's bytes for revmap_shading_from_bytes() of the same version of the library. With
/// null bytes, count becomes their number. Otherwise count is the room in bytes, which must be large
/// enough, and becomes the number of bytes written.
RevmapResult revmap_shading_bytes(const struct RevmapShading *shading,
                                  void *bytes,
                                  size_t *count);

/// Destroys a shading; null is none. Renderers that use it stay as they are.
RevmapResult revmap_shading_destroy(struct RevmapShading *shading);

/// Makes a colour map from a PNG or JPEG file. The path is UTF-8.
///
/// Fails with REVMAP_RESULT_FILE if it cannot be read.
RevmapResult revmap_color_map_from_file(const char *path, struct RevmapColorMap **color_map);

/// Makes a colour map from width * height sRGB texels with straight alpha, 4 bytes each, row by row
/// from the top.
RevmapResult revmap_color_map_from_texels(uint32_t width,
                                          uint32_t height,
                                          const uint8_t (*texels)[4],
                                          struct RevmapColorMap **color_map);

/// Destroys a colour map; null is none. Objects that use it stay as they are.
RevmapResult revmap_color_map_destroy(struct RevmapColorMap *color_map);

/// Makes a height map from a PNG or JPEG file, whose luminance is the height. The path is UTF-8;
/// filter is a RevmapSlopeFilter.
///
/// Fails with REVMAP_RESULT_FILE if it cannot be read.
RevmapResult revmap_height_map_from_file(const char *path,
                                         uint32_t filter,
                                         struct RevmapHeightMap **height_map);

/// Makes a height map from width * height heights in [0, 1], row by row from the top; filter is a
/// RevmapSlopeFilter.
RevmapResult revmap_height_map_from_heights(uint32_t width,
                                            uint32_t height,
                                            const float *heights,
                                            uint32_t filter,
                                            struct RevmapHeightMap **height_map);

/// Destroys a height map; null is none. Objects that use it stay as they are.
RevmapResult revmap_height_map_destroy(struct RevmapHeightMap *height_map);

/// Fills in a little ambient light, REVMAP_SHADOW_OFF, and one white light from above, which lasts
/// as long as the program. The size must be set.
RevmapResult revmap_lighting_defaults(struct RevmapLighting *lighting);

/// Fills in a camera at (2, 0, 0.5) that looks at (0, 0, 0.5), z up, 40 degrees. The size must be
/// set.
RevmapResult revmap_camera_defaults(struct RevmapCamera *camera);

/// Fills in the default search. The size must be set.
RevmapResult revmap_search_defaults(struct RevmapSearch *search);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* REVMAP_H */

/* An earlier name. */
#define REVMAP_SOLVER_HULL REVMAP_SOLVER_EXACT
