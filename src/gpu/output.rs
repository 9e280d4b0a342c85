//! What a renderer draws into: formats and conventions, told once.

use crate::settings::Planes;
use ash::vk;

/// Where a renderer's work ends up. Told once, when the renderer is made.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Output {
    /// Fragments, in a render pass or dynamic rendering that the host begins.
    Pass(PassFormats),
    /// Pixels that a compute shader traces, into a [`ComputeTarget`](super::ComputeTarget).
    Compute(Planes),
}

/// The pass in which fragments are drawn.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct PassFormats {
    /// How the host begins it.
    pub begun: PassKind,
    /// Samples of every attachment: 1, 2, 4 or 8. Rays go through pixel centres, whatever the
    /// number.
    pub samples: u32,
    /// Which end of the depth range is near.
    pub depth: DepthOrder,
    /// Which planes the fragment shader writes, one an attachment.
    pub planes: Planes,
}

/// How the host begins a pass.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum PassKind {
    /// As a subpass of a render pass. Passes that are compatible with it may be begun instead.
    RenderPass {
        /// The pass. It must live as long as the renderer.
        pass: vk::RenderPass,
        /// The subpass, which has the colour attachments of the planes and a depth attachment.
        subpass: u32,
    },
    /// By dynamic rendering (Vulkan 1.3 or `VK_KHR_dynamic_rendering`, enabled by the host).
    Dynamic {
        /// Formats of the colour attachments in order; none for depth alone.
        color: Vec<vk::Format>,
        /// Format of the depth attachment.
        depth: vk::Format,
        /// Format of the stencil attachment, `UNDEFINED` where there is none.
        stencil: vk::Format,
    },
}

/// Which end of the depth range is near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// 0 is near, fragments pass that are less.
    #[default]
    Normal,
    /// 1 is near, fragments pass that are greater.
    Reversed,
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

    /// Which end of the depth range is near.
    #[must_use]
    pub fn depth_order(&self) -> DepthOrder {
        match self {
            Self::Pass(pass) => pass.depth,
            Self::Compute(_) => DepthOrder::Normal,
        }
    }
}
