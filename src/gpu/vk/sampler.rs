//! Samplers.

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::vk::call::Call;
use ash::vk;
use std::sync::Arc;

/// A sampler that clamps to the edge.
pub(crate) struct Sampler {
    pub raw: vk::Sampler,
    device: Arc<Shared>,
}

/// The filter and the address modes of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wrap {
    /// A map whose texels shaders gather and weigh themselves.
    MapNearest,
    /// The papers' map, filtered by the sampler.
    MapLinear,
    /// A surface's texture, repeated both ways.
    SurfaceRepeated,
    /// Repeated only around the axis: the poles' rows do not run into each other.
    SurfaceAround,
}

impl Sampler {
    pub fn new(device: &Arc<Shared>, wrap: Wrap) -> Result<Self> {
        use vk::SamplerAddressMode as Address;
        let surface = matches!(wrap, Wrap::SurfaceRepeated | Wrap::SurfaceAround);
        let filter = if wrap == Wrap::MapNearest {
            vk::Filter::NEAREST
        } else {
            vk::Filter::LINEAR
        };
        let (around, along) = match wrap {
            Wrap::MapNearest | Wrap::MapLinear => (Address::CLAMP_TO_EDGE, Address::CLAMP_TO_EDGE),
            Wrap::SurfaceRepeated => (Address::REPEAT, Address::REPEAT),
            Wrap::SurfaceAround => (Address::REPEAT, Address::CLAMP_TO_EDGE),
        };
        let mut info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(around)
            .address_mode_v(along)
            .address_mode_w(Address::CLAMP_TO_EDGE);
        if surface {
            info = info
                .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
                .max_lod(vk::LOD_CLAMP_NONE);
            if let Some(most) = device.anisotropy {
                info = info.anisotropy_enable(true).max_anisotropy(most.min(8.0));
            }
        }
        // SAFETY: a plain creation, destroyed in Drop.
        let raw = unsafe { device.raw.create_sampler(&info, None) }.call("vkCreateSampler")?;
        Ok(Self {
            raw,
            device: device.clone(),
        })
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for.
        unsafe { self.device.raw.destroy_sampler(self.raw, None) };
    }
}
