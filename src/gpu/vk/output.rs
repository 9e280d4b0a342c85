//! The output of a renderer, set once: formats and conventions, the memory that compute writes to,
//! and a host's function of shading.

use crate::error::{Error, ErrorKind, Result, usage};
use crate::frame::srgb_from_linear;
use crate::gpu::vk::descriptors::{EVERY, HOST_TEXTURES, SETS, count};
use crate::maps::MapFormat;
use crate::plan::DepthOrder;
use crate::settings::{DrawStage, Plane, Planes, SearchSettings};
use crate::shader::generated::{EXHAUSTED_BIT, SLOPE_BIAS_ID, SLOPE_BIAS_LIMIT_ID};
use crate::shading::Shading;
use ash::vk;
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

/// The destination of a renderer's work, fixed when the renderer is made.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Output {
    /// Fragments, in a render pass or dynamic rendering that the host begins.
    Pass(PassFormats),
    /// Pixels that a compute shader traces and writes to a [`ComputeTarget`](crate::gpu::ComputeTarget).
    Compute(Planes),
}

/// The pass in which fragments are drawn. A pass draws one view: its view mask is 0. A host with
/// several views begins a pass for each, and prepares each view in a slot of its own.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct PassFormats {
    /// Kind of pass: a render pass or dynamic rendering.
    pub begun: PassKind,
    /// Samples of every attachment: 1, 2, 4 or 8.
    pub samples: u32,
    /// True for a ray through each sample, so that silhouettes are smooth and every sample of a
    /// pixel is right; a pixel costs as many rays. Needs the feature `sampleRateShading`. False for
    /// one ray through the pixel's centre, which all samples share.
    pub sample_rays: bool,
    /// The end of the depth range that is near.
    pub depth: DepthOrder,
    /// The depth test of every draw.
    pub depth_test: DepthTest,
    /// The bias for slopes of [`Planes::Depth`]; none for other planes.
    pub slope_bias: SlopeBias,
    /// The planes that the fragment shader writes, one per attachment. Colours are linear, and the
    /// attachment's format encodes them ([`Planes::Color`]).
    pub planes: Planes,
}

impl PassFormats {
    /// A pass of one sample, with normal depths that are tested and written.
    #[must_use]
    pub fn new(begun: PassKind, planes: Planes) -> Self {
        Self {
            begun,
            samples: 1,
            sample_rays: false,
            depth: DepthOrder::Normal,
            depth_test: DepthTest::default(),
            slope_bias: SlopeBias::default(),
            planes,
        }
    }
}

/// A bias of depths for the slope of the surface, for shadow maps. The bias of a rasteriser does not
/// reach depths that a shader writes.
///
/// It moves the depth of each hit away from the eye, in either [`DepthOrder`]. Its slope is that of
/// the tangent plane: the larger of the changes of depth from a pixel to the next in x and in y,
/// units of the depth buffer. [`View::with_depth_bias`](crate::plan::View::with_depth_bias) adds a
/// constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SlopeBias {
    factor: u32,
    limit: u32,
}

impl SlopeBias {
    /// A bias of `factor` times the slope, and at most `limit` units of the depth buffer. At
    /// silhouettes slopes have no limit. `factor`: at least half of the filter's width in texels.
    ///
    /// # Errors
    /// [`Usage`](crate::error::ErrorKind::Usage) if a number is negative or not finite, and for a
    /// limit of 0 with a factor.
    pub fn new(factor: f32, limit: f32) -> Result<Self> {
        for (key, value) in [("factor", factor), ("limit", limit)] {
            if !(value.is_finite() && value >= 0.0) {
                let message = format!("{value}; give a finite number that is not negative");
                return usage(key, message);
            }
        }
        if factor > 0.0 && limit == 0.0 {
            return usage(
                "limit",
                "0 leaves no bias; give the most that a depth may move",
            );
        }
        // The sum turns -0 into 0, so that equal biases have equal bits.
        let [factor, limit] = [factor, limit].map(|value| (value + 0.0).to_bits());
        Ok(Self { factor, limit })
    }

    /// True if no depth is moved.
    #[must_use]
    pub fn is_none(self) -> bool {
        self.factor == 0
    }
}

/// The depth test of a pass's draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DepthTest {
    /// The comparison of a fragment's depth with the attachment's; `None` keeps the nearer one.
    ///
    /// After a prepass give `EQUAL`, or `LESS_OR_EQUAL` (`GREATER_OR_EQUAL` in reversed depth). Depths
    /// of two passes are equal if their renderers have the same search, lighting and objects, in
    /// whatever planes they draw. If two patches are hit at equal depth, `EQUAL` keeps the colour of
    /// the last one.
    pub compare: Option<vk::CompareOp>,
    /// True if depths are written.
    pub write: bool,
}

impl Default for DepthTest {
    fn default() -> Self {
        Self {
            compare: None,
            write: true,
        }
    }
}

/// A host's render pass, which pipelines are made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HostPass(vk::RenderPass);

impl HostPass {
    /// A render pass of the host.
    ///
    /// # Safety
    /// The value keeps the handle; renderers and their [`Prewarm`](crate::gpu::Prewarm)s make
    /// pipelines with it.
    ///
    /// The caller must ensure that
    /// * the pass is null, which is refused, or of the device of every renderer that is made with this
    ///   value;
    /// * the view mask of the subpass that is drawn in is 0;
    /// * it lives until each of these renderers and all their prewarms are dropped.
    #[must_use]
    pub const unsafe fn new(pass: vk::RenderPass) -> Self {
        Self(pass)
    }

    /// The handle.
    #[must_use]
    pub const fn raw(self) -> vk::RenderPass {
        self.0
    }
}

/// Kind of pass that the host begins.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum PassKind {
    /// A subpass of a render pass. The host may begin any compatible pass instead.
    RenderPass {
        /// The pass.
        pass: HostPass,
        /// The subpass, which has the colour attachments of the planes and a depth attachment.
        subpass: u32,
    },
    /// A render pass of one view and one subpass, without input attachments and dependencies, known
    /// by its formats. Renderers of one device share the pipelines for equal formats, as with dynamic
    /// rendering; those for a given pass are a renderer's own.
    SingleSubpass {
        /// Formats of the colour attachments in order; empty if only depth is drawn.
        color: Vec<vk::Format>,
        /// Format of the depth attachment.
        depth: vk::Format,
    },
    /// Dynamic rendering (Vulkan 1.3 or `VK_KHR_dynamic_rendering`, enabled by the host), with a view
    /// mask of 0.
    Dynamic {
        /// Formats of the colour attachments in order; empty if only depth is drawn.
        color: Vec<vk::Format>,
        /// Format of the depth attachment.
        depth: vk::Format,
        /// Format of the stencil attachment; `UNDEFINED` if there is none.
        stencil: vk::Format,
    },
}

impl Output {
    /// The planes that are drawn.
    #[must_use]
    pub fn planes(&self) -> Planes {
        match self {
            Self::Pass(pass) => pass.planes,
            Self::Compute(planes) => *planes,
        }
    }

    fn pass(&self) -> Option<&PassFormats> {
        match self {
            Self::Pass(pass) => Some(pass),
            Self::Compute(_) => None,
        }
    }

    /// Largest distance of a ray from its pixel's centre, pixels.
    pub(crate) fn ray_spread(&self) -> f64 {
        let spreads = self.pass().is_some_and(|pass| pass.sample_rays);
        if spreads { FRAC_1_SQRT_2 } else { 0.0 }
    }

    /// Width of the part of a pixel that a ray stands for, pixels.
    pub(crate) fn ray_width(&self) -> f64 {
        let rays = self.pass().filter(|pass| pass.sample_rays);
        rays.map_or(1.0, |pass| f64::from(pass.samples).sqrt().recip())
    }

    /// `(constant_id, value)` of the specialisation constants of a pass.
    pub(crate) fn constants(&self) -> [(u32, u32); 2] {
        let bias = self.pass().map(|pass| pass.slope_bias).unwrap_or_default();
        [
            (SLOPE_BIAS_ID, bias.factor),
            (SLOPE_BIAS_LIMIT_ID, bias.limit),
        ]
    }

    /// The end of the depth range that is near.
    #[must_use]
    pub fn depth_order(&self) -> DepthOrder {
        self.pass().map_or(DepthOrder::Normal, |pass| pass.depth)
    }
}

/// Memory that compute shaders write to. Fragment shaders that draw all planes write to it besides
/// their attachments. It is as large as the view's viewport; pixels of the viewport beyond that, of
/// one that does not begin at 0, are not drawn.
#[derive(Clone, Debug)]
pub struct ComputeTarget {
    /// A storage buffer of two 32-bit words per pixel, row by row from the top. The first half
    /// holds the depths of all pixels, as bits of floats. The second half holds a second word of
    /// each pixel. This word is the colour, packed as `R8G8B8A8_SRGB`, if only colour is drawn,
    /// else a count of look-ups with the bit [`ComputeTarget::EXHAUSTED`]. Before a frame the host
    /// clears depths to 1.0 and second words to its background or 0, or fills in what is already
    /// drawn.
    pub words: vk::Buffer,
    /// Storage images of all planes, `R32G32B32A32_SFLOAT` in the layout `GENERAL`. Empty if only
    /// colour is drawn, or if fragments draw.
    pub images: Vec<vk::ImageView>,
    /// True if depths count: compute compares with the depths in the buffer, and writes its own. If
    /// false, the depths may hold anything. Shaders then read and write them only to distinguish
    /// copies ([`PreparedFrame::reads_depths`](crate::gpu::PreparedFrame::reads_depths)).
    pub depths: bool,
}

impl ComputeTarget {
    /// The bit of a pixel's count of look-ups which says that one of its rays ran out of steps.
    pub const EXHAUSTED: u32 = EXHAUSTED_BIT;

    /// The second word of a pixel of this linear colour, if only colour is drawn: the same sRGB word
    /// as `pack_srgb` of `stores.glsl` gives.
    #[must_use]
    pub fn color_word(linear: [f32; 4]) -> u32 {
        let byte = |v: f64| (v.clamp(0.0, 1.0) * 255.0).round() as u32;
        let [r, g, b] = [0, 1, 2].map(|i| byte(srgb_from_linear(f64::from(linear[i]))));
        r | g << 8 | b << 16 | byte(f64::from(linear[3])) << 24
    }
}

/// The number of the host's descriptor set.
pub(crate) const HOST_SET: u32 = SETS.len() as u32;

/// A host's function of shading, and the layout of the descriptor set that the function reads.
#[derive(Clone, Debug)]
pub struct HostShading {
    /// The function.
    pub shading: Arc<Shading>,
    /// The layout of set 3, for the stage of the shading; null if the function reads no set. Its
    /// descriptors count beside the library's under the device's limits: the library has 4
    /// combined image samplers in each stage beside them.
    pub set_layout: vk::DescriptorSetLayout,
}

impl HostShading {
    /// Returns an error for an output or a search that the function does not shade, and for a function
    /// that does not fit the sets.
    pub(crate) fn check(
        &self,
        output: &Output,
        settings: &SearchSettings,
        limits: &vk::PhysicalDeviceLimits,
    ) -> Result<()> {
        let (stage, name) = match output {
            Output::Pass(_) => (DrawStage::Fragment, "a pass"),
            Output::Compute(_) => (DrawStage::Compute, "a compute target"),
        };
        if self.shading.stage() != stage {
            let (own, stage) = (self.shading.stage().name(), stage.name());
            let message = format!("is of the stage {own}, and {name} needs {stage}; compile it so");
            return usage("shading", message);
        }
        let has_color = match output.planes() {
            Planes::Color => true,
            Planes::List(list) => list.has(Plane::Color),
            Planes::All | Planes::Depth { .. } => false,
        };
        if !has_color {
            let message =
                "a host's function shades colour, or a list with colour; give one of them";
            return usage("planes", message);
        }
        if settings.solver.external().is_some() || settings.map_format == MapFormat::Rgba8 {
            let message = "a host's function shades hits of exact, quadric or live, with maps in r16 or r32; give one of them";
            return usage("solver", message);
        }
        for (set, binding) in self.shading.bindings() {
            let known = SETS.get(set as usize).map(|own| binding < own.len() as u32);
            if set > HOST_SET || known == Some(false) {
                let message = format!("reads set {set}, binding {binding}; declare data in set 3");
                return usage("shading", message);
            }
            if set == HOST_SET && self.set_layout == vk::DescriptorSetLayout::null() {
                let message = "is null, and the shading reads set 3; give one";
                return usage("set_layout", message);
            }
        }
        let textures = HOST_TEXTURES.len() as u32 + self.shading.textures(HOST_SET);
        let views = count(&[vk::DescriptorType::UNIFORM_TEXEL_BUFFER], EVERY);
        let samplers = limits.max_per_stage_descriptor_samplers;
        let images = limits.max_per_stage_descriptor_sampled_images;
        for (name, needed, has) in [
            ("maxPerStageDescriptorSamplers", textures, samplers),
            (
                "maxPerStageDescriptorSampledImages",
                textures + views,
                images,
            ),
        ] {
            if needed > has {
                let message =
                    format!("reads textures; the device lacks {name} of {needed} (it has {has})");
                return Err(Error::new(ErrorKind::Unsupported, message).at_key("shading"));
            }
        }
        Ok(())
    }
}
