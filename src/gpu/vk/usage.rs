//! The usage table: the stages, accesses and image layout of each use of a resource. A barrier is
//! named by the use before it and the use after it.

use ash::vk;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Usage {
    /// Sampled, or copied into, by earlier commands; contents no longer matter.
    Discarded,
    /// Copied or cleared into.
    TransferWrite,
    Sampled,
    /// Written, and perhaps read, by compute shaders.
    ComputeWrite,
    /// Read by compute shaders and as the groups of an indirect dispatch.
    TileRead,
    ShaderRead,
    /// Read by the host, after the commands have run.
    HostRead,
}

impl Usage {
    pub fn stages(self) -> vk::PipelineStageFlags {
        use vk::PipelineStageFlags as S;
        match self {
            Self::Discarded => S::FRAGMENT_SHADER | S::COMPUTE_SHADER | S::TRANSFER,
            Self::TransferWrite => S::TRANSFER,
            Self::ShaderRead => S::VERTEX_SHADER | S::FRAGMENT_SHADER | S::COMPUTE_SHADER,
            Self::HostRead => S::HOST,
            Self::Sampled => S::FRAGMENT_SHADER | S::COMPUTE_SHADER,
            Self::ComputeWrite => S::COMPUTE_SHADER,
            Self::TileRead => S::COMPUTE_SHADER | S::DRAW_INDIRECT,
        }
    }

    pub fn access(self) -> vk::AccessFlags {
        use vk::AccessFlags as A;
        match self {
            Self::Discarded | Self::TransferWrite => A::TRANSFER_WRITE,
            Self::HostRead => A::HOST_READ,
            Self::Sampled | Self::ShaderRead => A::SHADER_READ,
            Self::ComputeWrite => A::SHADER_READ | A::SHADER_WRITE,
            Self::TileRead => A::SHADER_READ | A::INDIRECT_COMMAND_READ,
        }
    }

    pub fn layout(self) -> vk::ImageLayout {
        use vk::ImageLayout as L;
        match self {
            Self::Discarded => L::UNDEFINED,
            Self::TransferWrite => L::TRANSFER_DST_OPTIMAL,
            Self::Sampled => L::SHADER_READ_ONLY_OPTIMAL,
            _ => L::GENERAL,
        }
    }
}

pub(crate) fn wait(
    raw: &ash::Device,
    cmd: vk::CommandBuffer,
    (from, to): (Usage, Usage),
    buffers: &[vk::BufferMemoryBarrier],
    images: &[vk::ImageMemoryBarrier],
) {
    let none = vk::DependencyFlags::empty();
    // SAFETY: `cmd` is recording, outside of a render pass; buffers and images live until it has
    // run.
    unsafe {
        raw.cmd_pipeline_barrier(cmd, from.stages(), to.stages(), none, &[], buffers, images);
    }
}
