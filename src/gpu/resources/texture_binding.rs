//! The binding of textures: samplers, and the descriptor sets that are handed out.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::Call;
use crate::gpu::vk::descriptors::{TEXTURE_SET, allocate};
use ash::vk;
use std::sync::{Arc, Mutex};

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
            if let Some(most) = device.chosen.anisotropy() {
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

/// Descriptor sets of textures. New pools are made as sets are needed, and returned sets are used
/// again.
pub(crate) struct SetPool {
    state: Mutex<Sets>,
    device: Arc<Shared>,
}

#[derive(Default)]
struct Sets {
    pools: Vec<vk::DescriptorPool>,
    free: Vec<vk::DescriptorSet>,
}

/// Number of sets in one pool.
const SETS: u32 = 64;

impl SetPool {
    pub fn new(device: &Arc<Shared>) -> Self {
        Self {
            state: Mutex::default(),
            device: device.clone(),
        }
    }

    pub fn take(&self) -> Result<vk::DescriptorSet> {
        let mut state = self
            .state
            .lock()
            .map_err(|_| Error::new(ErrorKind::Other, "the pool of textures is poisoned"))?;
        if let Some(set) = state.free.pop() {
            return Ok(set);
        }
        let layouts = &self.device.pipelines()?.set_layouts;
        let (pool, sets) = allocate(&self.device.raw, layouts, &[TEXTURE_SET], SETS)?;
        state.pools.push(pool);
        state.free = sets;
        state
            .free
            .pop()
            .ok_or_else(|| Error::new(ErrorKind::Other, "a pool of textures gave no set"))
    }

    pub fn give_back(&self, set: vk::DescriptorSet) {
        if let Ok(mut state) = self.state.lock() {
            state.free.push(set);
        }
    }
}

impl Drop for SetPool {
    fn drop(&mut self) {
        let Ok(state) = self.state.get_mut() else {
            return;
        };
        for pool in state.pools.drain(..) {
            // SAFETY: the renderer's frames are done; the pool frees its sets.
            unsafe { self.device.raw.destroy_descriptor_pool(pool, None) };
        }
    }
}
