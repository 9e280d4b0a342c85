//! Pipelines, one per variant, use and output. All renderers of a device share them; each pipeline
//! is compiled once and kept.

mod compile;

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::descriptors;
use crate::gpu::vk::output::{Output, PassFormats, PassKind};
use crate::gpu::vk::shading::{BoundShading, HostShading};
use crate::shader::Pushed;
use crate::shader::generated::{FETCHED_CELLS_ID, LARGE_POINTS_ID, OWN_VECTORS_ID};
use crate::shader::{Kind, Variant};
use ash::vk;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

/// Specialisation constants that are the same for all pipelines of a device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeviceConstants {
    /// The number of vectors of one solid's tables that its uniform buffers hold.
    pub own_vectors: u32,
    /// True if squares of pixels are drawn as points.
    pub large_points: bool,
    /// True if fragments fetch the patches of their cell. Otherwise vertices pass them: 112 registers
    /// on RDNA2 in place of 48. Software drivers would read storage buffers lane by lane.
    pub fetched_cells: bool,
}

impl DeviceConstants {
    /// `(constant_id, value)`.
    pub fn values(self) -> [(u32, u32); 3] {
        [
            (OWN_VECTORS_ID, self.own_vectors),
            (LARGE_POINTS_ID, u32::from(self.large_points)),
            (FETCHED_CELLS_ID, u32::from(self.fetched_cells)),
        ]
    }
}

/// Set layouts, the pipeline layout, and the pipelines made so far.
pub(crate) struct Pipelines {
    /// The layouts of [`descriptors::SETS`].
    pub set_layouts: [vk::DescriptorSetLayout; 3],
    pub layout: vk::PipelineLayout,
    cache: vk::PipelineCache,
    /// True if this value made `cache` and destroys it.
    owns_cache: bool,
    made: Mutex<HashMap<Key, vk::Pipeline>>,
    compiled: AtomicU64,
    owners: AtomicU64,
    flags: vk::PipelineCreateFlags,
    /// The device's constants, the same for every pipeline.
    constants: DeviceConstants,
    /// The source of modules that replace the embedded ones.
    #[cfg(feature = "other-shaders")]
    pub source: Option<ShaderSource>,
    raw: ash::Device,
}

/// Returns the SPIR-V words of an entry file of `shaders-glsl/`, compiled with these macros. `None`
/// selects the words that the library holds.
#[cfg(feature = "other-shaders")]
pub type ShaderSource =
    Box<dyn Fn(&str, &[(&str, &str)]) -> Result<Option<Vec<u32>>> + Send + Sync>;

/// The renderer that pipelines are for, and the host's shading in them.
#[derive(Clone, Default)]
pub(crate) struct Owner {
    /// 0 if all renderers may share the pipelines.
    number: u64,
    pub shading: Option<Arc<BoundShading>>,
}

#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    variant: Variant,
    kind: Kind,
    output: Output,
    /// [`Owner::number`]; it also determines the shading.
    owner: u64,
}

impl Pipelines {
    /// Makes the layouts, without pipelines. `cache` is a host's, if it gives one.
    pub fn new(
        raw: ash::Device,
        cache: Option<vk::PipelineCache>,
        constants: DeviceConstants,
    ) -> Result<Self> {
        let mut all = Self {
            set_layouts: [vk::DescriptorSetLayout::null(); 3],
            layout: vk::PipelineLayout::null(),
            cache: cache.unwrap_or_default(),
            owns_cache: cache.is_none(),
            made: Mutex::default(),
            compiled: AtomicU64::new(0),
            owners: AtomicU64::new(0),
            flags: vk::PipelineCreateFlags::empty(),
            constants,
            #[cfg(feature = "other-shaders")]
            source: None,
            raw,
        };
        let raw = &all.raw;
        for (set, layout) in all.set_layouts.iter_mut().enumerate() {
            *layout = descriptors::layout(raw, set)?;
        }
        let pushed = [pushed()];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&all.set_layouts)
            .push_constant_ranges(&pushed);
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            all.layout = raw
                .create_pipeline_layout(&info, None)
                .call("vkCreatePipelineLayout")?;
            if all.owns_cache {
                let empty = vk::PipelineCacheCreateInfo::default();
                all.cache = raw
                    .create_pipeline_cache(&empty, None)
                    .call("vkCreatePipelineCache")?;
            }
        }
        Ok(all)
    }

    /// Makes the driver keep its compiler's statistics of everything compiled from now on.
    #[cfg(feature = "other-shaders")]
    pub fn capturing_statistics(mut self) -> Self {
        self.flags |= vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;
        self
    }

    /// Returns the pipeline of `variant` and `kind` for `output`, compiled now if it is new.
    /// [`Pipelines::owner`] returns `owner`.
    pub fn get(
        &self,
        variant: Variant,
        kind: Kind,
        output: &Output,
        owner: &Owner,
    ) -> Result<vk::Pipeline> {
        if let Some(made) = self.known(variant, kind, output, owner)? {
            return Ok(made);
        }
        // Compilation holds no lock, so that others can compile meanwhile.
        let made = self.compile(&variant, kind, output, owner.shading.as_deref())?;
        let key = Key {
            variant,
            kind,
            output: output.clone(),
            owner: owner.number,
        };
        let mut all = self.made()?;
        if let Some(before) = all.get(&key) {
            // SAFETY: nothing else has seen the new pipeline.
            unsafe { self.raw.destroy_pipeline(made, None) };
            return Ok(*before);
        }
        all.insert(key, made);
        self.compiled.fetch_add(1, Ordering::Relaxed);
        Ok(made)
    }

    /// Returns the same pipeline as [`Pipelines::get`] if it is compiled.
    pub fn known(
        &self,
        variant: Variant,
        kind: Kind,
        output: &Output,
        owner: &Owner,
    ) -> Result<Option<vk::Pipeline>> {
        let key = Key {
            variant,
            kind,
            output: output.clone(),
            owner: owner.number,
        };
        Ok(self.made()?.get(&key).copied())
    }

    /// Returns the owner of a renderer's pipelines. The pipelines of a host's render pass or shading
    /// are the renderer's own: the host may destroy its pass once the renderer is gone, and make
    /// another of the same handle. All others are shared.
    pub fn owner(&self, output: &Output, host: Option<&HostShading>) -> Result<Owner> {
        let of_host = matches!(
            output,
            Output::Pass(PassFormats {
                begun: PassKind::RenderPass { .. },
                ..
            })
        );
        let bound = |host| BoundShading::new(&self.raw, host, &self.set_layouts, pushed());
        let number = || self.owners.fetch_add(1, Ordering::Relaxed) + 1;
        Ok(Owner {
            number: (of_host || host.is_some()).then(number).unwrap_or_default(),
            shading: host.map(bound).transpose()?.map(Arc::new),
        })
    }

    /// Destroys all pipelines of `owner`, whose frames are done.
    pub fn forget(&self, owner: &Owner) {
        let owner = owner.number;
        if owner == 0 {
            return;
        }
        if let Ok(mut made) = self.made.lock() {
            made.retain(|key, pipeline| {
                if key.owner == owner {
                    // SAFETY: the frames that used the pipeline are done.
                    unsafe { self.raw.destroy_pipeline(*pipeline, None) };
                }
                key.owner != owner
            });
        }
    }

    /// The number of pipelines that were compiled.
    pub fn compiled(&self) -> u64 {
        self.compiled.load(Ordering::Relaxed)
    }

    /// Adds data that [`Pipelines::cache_data`] returned at another time.
    pub fn add_cache(&self, data: &[u8]) -> Result<()> {
        let with = vk::PipelineCacheCreateInfo::default().initial_data(data);
        // SAFETY: drivers read the data's header and ignore data of other drivers; the second cache
        // is gone again.
        unsafe {
            let other = self
                .raw
                .create_pipeline_cache(&with, None)
                .call("vkCreatePipelineCache")?;
            let merged = self.raw.merge_pipeline_caches(self.cache, &[other]);
            self.raw.destroy_pipeline_cache(other, None);
            merged.call("vkMergePipelineCaches")
        }
    }

    /// The driver's data to keep for another process.
    pub fn cache_data(&self) -> Result<Vec<u8>> {
        // SAFETY: the cache is live.
        unsafe { self.raw.get_pipeline_cache_data(self.cache) }.call("vkGetPipelineCacheData")
    }

    fn made(&self) -> Result<MutexGuard<'_, HashMap<Key, vk::Pipeline>>> {
        self.made
            .lock()
            .map_err(|_| Error::new(ErrorKind::Other, "the pipelines' lock is poisoned"))
    }
}

/// The range of push constants in every layout.
fn pushed() -> vk::PushConstantRange {
    vk::PushConstantRange::default()
        .stage_flags(vk::ShaderStageFlags::COMPUTE)
        .size(size_of::<Pushed>() as u32)
}

impl Drop for Pipelines {
    fn drop(&mut self) {
        let made = self.made.get_mut().map(std::mem::take).unwrap_or_default();
        // SAFETY: the device's last user is gone; null handles may be destroyed.
        unsafe {
            for pipeline in made.into_values() {
                self.raw.destroy_pipeline(pipeline, None);
            }
            if self.owns_cache {
                self.raw.destroy_pipeline_cache(self.cache, None);
            }
            self.raw.destroy_pipeline_layout(self.layout, None);
            for layout in self.set_layouts {
                self.raw.destroy_descriptor_set_layout(layout, None);
            }
        }
    }
}
