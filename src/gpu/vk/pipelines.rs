//! Pipelines, one per variant, use and output. All renderers of a device share them; each pipeline
//! is compiled once and kept.

mod cache;
mod compile;

use crate::error::{Result, lock, usage};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::descriptors;
use crate::gpu::vk::output::{HostShading, Output, PassFormats, PassKind};
use crate::shader::Pushed;
use crate::shader::generated::{FETCHED_CELLS_ID, LARGE_POINTS_ID, OWN_VECTORS_ID, TEXELS_ID};
use crate::shader::{Kind, Speciality, Variant};
use crate::shading::Shading;
use ash::vk;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

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
    /// True if shaders read vectors at places that differ between invocations through views of
    /// buffers.
    pub texels: bool,
    /// True if shaders may index arrays of textures by numbers that vary; otherwise they switch over
    /// constants, which takes 1.3 of the code of shadows on RDNA2. No constant of theirs.
    pub indexes_textures: bool,
}

impl DeviceConstants {
    /// `(constant_id, value)`.
    pub fn values(self) -> [(u32, u32); 4] {
        [
            (OWN_VECTORS_ID, self.own_vectors),
            (LARGE_POINTS_ID, u32::from(self.large_points)),
            (FETCHED_CELLS_ID, u32::from(self.fetched_cells)),
            (TEXELS_ID, u32::from(self.texels)),
        ]
    }
}

/// Set layouts, the pipeline layout, and the pipelines made so far. Members are all inputs of a
/// compilation that a device has.
pub(crate) struct Pipelines {
    pub set_layouts: [vk::DescriptorSetLayout; 3],
    host_textures: vk::DescriptorSetLayout,
    pub layout: vk::PipelineLayout,
    /// Shared while pipelines are compiled, exclusive while another cache is merged into it.
    cache: RwLock<vk::PipelineCache>,
    /// True if this value made `cache` and destroys it.
    owns_cache: bool,
    made: Made,
    pub compiled: AtomicU64,
    owners: AtomicU64,
    pub flags: vk::PipelineCreateFlags,
    constants: DeviceConstants,
    pub specialities: u32,
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

type Made = Arc<Mutex<HashMap<Key, vk::Pipeline>>>;

/// The renderer that pipelines are for: its output, and the host's shading in them. The pipelines
/// that are its own live as long as it. Its users keep the device alive.
pub(crate) struct Owner {
    /// 0 if all renderers may share the pipelines.
    number: u64,
    output: Output,
    pub shading: Option<BoundShading>,
    made: Made,
    raw: ash::Device,
}

impl Drop for Owner {
    fn drop(&mut self) {
        let Some(mut made) = self.made.lock().ok().filter(|_| self.number != 0) else {
            return;
        };
        let mine = made.extract_if(|(.., number), _| *number == self.number);
        for (_, pipeline) in mine {
            // SAFETY: the renderer is gone, and its frames are done.
            unsafe { self.raw.destroy_pipeline(pipeline, None) };
        }
    }
}

pub(crate) struct BoundShading {
    pub shading: Arc<Shading>,
    pub layout: vk::PipelineLayout,
    raw: ash::Device,
}

impl BoundShading {
    /// `sets`: layouts of the library's sets.
    fn new(
        raw: &ash::Device,
        host: &HostShading,
        sets: &[vk::DescriptorSetLayout],
    ) -> Result<Self> {
        let own = Some(host.set_layout).filter(|own| *own != vk::DescriptorSetLayout::null());
        let sets: Vec<_> = sets.iter().copied().chain(own).collect();
        Ok(Self {
            shading: host.shading.clone(),
            layout: layout(raw, &sets)?,
            raw: raw.clone(),
        })
    }
}

impl Drop for BoundShading {
    fn drop(&mut self) {
        // SAFETY: the renderer's frames are done, and its pipelines need no layout any more.
        unsafe { self.raw.destroy_pipeline_layout(self.layout, None) };
    }
}

/// The owner's number, which also determines the shading, is last.
type Key = (Variant, Kind, Output, u64);

impl Pipelines {
    /// Makes the layouts, without pipelines. `cache` is a host's, if it gives one.
    pub fn new(
        raw: ash::Device,
        cache: Option<vk::PipelineCache>,
        constants: DeviceConstants,
    ) -> Result<Self> {
        let mut all = Self {
            set_layouts: [vk::DescriptorSetLayout::null(); 3],
            host_textures: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            cache: cache.unwrap_or_default().into(),
            owns_cache: cache.is_none(),
            made: Made::default(),
            compiled: AtomicU64::new(0),
            owners: AtomicU64::new(0),
            flags: vk::PipelineCreateFlags::empty(),
            constants,
            specialities: specialities()?,
            #[cfg(feature = "other-shaders")]
            source: None,
            raw,
        };
        let raw = &all.raw;
        for (set, layout) in all.set_layouts.iter_mut().enumerate() {
            *layout = descriptors::layout(raw, descriptors::SETS[set])?;
        }
        all.host_textures = descriptors::layout(raw, descriptors::HOST_TEXTURES)?;
        all.layout = layout(raw, &all.set_layouts)?;
        if all.owns_cache {
            let empty = vk::PipelineCacheCreateInfo::default();
            // SAFETY: a plain creation, destroyed in Drop.
            let made = unsafe { raw.create_pipeline_cache(&empty, None) };
            all.cache = made.call("vkCreatePipelineCache")?.into();
        }
        Ok(all)
    }

    /// The layouts of the library's sets under a host's shading.
    pub fn host_layouts(&self) -> [vk::DescriptorSetLayout; 3] {
        let mut all = self.set_layouts;
        all[descriptors::TEXTURE_SET] = self.host_textures;
        all
    }

    /// Returns the pipeline of `variant` and `kind` for an owner, compiled now if it is new.
    pub fn get(&self, variant: Variant, kind: Kind, owner: &Owner) -> Result<vk::Pipeline> {
        if let Some(known) = self.known(variant, kind, owner)? {
            return Ok(known);
        }
        // Compilation holds no lock, so that others can compile meanwhile.
        let made = self.compile(&variant, kind, owner)?;
        let key = (variant, kind, owner.output.clone(), owner.number);
        let mut all = lock(&self.made)?;
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
        owner: &Owner,
    ) -> Result<Option<vk::Pipeline>> {
        let key = (variant, kind, owner.output.clone(), owner.number);
        Ok(lock(&self.made)?.get(&key).copied())
    }

    /// Returns the owner of a renderer's pipelines. The pipelines of a host's render pass or shading
    /// are the renderer's own: the host may destroy its pass once the renderer and its prewarms are
    /// gone, and make another of the same handle. All others are shared.
    pub fn owner(&self, output: &Output, host: Option<&HostShading>) -> Result<Owner> {
        let of_host = matches!(
            output,
            Output::Pass(PassFormats {
                begun: PassKind::RenderPass { .. },
                ..
            })
        );
        let bound = |host| BoundShading::new(&self.raw, host, &self.host_layouts());
        let number = || self.owners.fetch_add(1, Ordering::Relaxed) + 1;
        Ok(Owner {
            number: (of_host || host.is_some()).then(number).unwrap_or_default(),
            output: output.clone(),
            shading: host.map(bound).transpose()?,
            made: self.made.clone(),
            raw: self.raw.clone(),
        })
    }
}

/// The specialities that frames may use: all, or those that the environment names for measurements.
fn specialities() -> Result<u32> {
    const VARIABLE: &str = "REVMAP_SPECIALITIES";
    let set = std::env::var(VARIABLE).ok();
    let Some(names) = set.filter(|_| cfg!(feature = "other-shaders")) else {
        return Ok(u32::MAX);
    };
    let known = Speciality::MEMBERS.map(|(name, _)| name);
    let mut names = names.split(',').filter(|name| !name.is_empty());
    names.try_fold(0, |set, name| {
        let Some(bit) = known.iter().position(|known| *known == name) else {
            let known = known.join(", ");
            let message = format!("there is no speciality {name}; there are {known}");
            return usage(VARIABLE, message);
        };
        Ok(set | 1 << bit)
    })
}

/// Makes a pipeline layout of these sets, with the library's push constants. The caller destroys it.
fn layout(raw: &ash::Device, sets: &[vk::DescriptorSetLayout]) -> Result<vk::PipelineLayout> {
    let pushed = [vk::PushConstantRange::default()
        .stage_flags(vk::ShaderStageFlags::COMPUTE)
        .size(size_of::<Pushed>() as u32)];
    let info = vk::PipelineLayoutCreateInfo::default()
        .set_layouts(sets)
        .push_constant_ranges(&pushed);
    // SAFETY: a plain creation.
    unsafe { raw.create_pipeline_layout(&info, None) }.call("vkCreatePipelineLayout")
}

impl Drop for Pipelines {
    fn drop(&mut self) {
        let made = self.made.lock().map(|mut made| std::mem::take(&mut *made));
        let cache = self.cache.get_mut().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the device's last user is gone; null handles may be destroyed.
        unsafe {
            for pipeline in made.unwrap_or_default().into_values() {
                self.raw.destroy_pipeline(pipeline, None);
            }
            if self.owns_cache {
                self.raw.destroy_pipeline_cache(*cache, None);
            }
            self.raw.destroy_pipeline_layout(self.layout, None);
            self.raw
                .destroy_descriptor_set_layout(self.host_textures, None);
            for layout in self.set_layouts {
                self.raw.destroy_descriptor_set_layout(layout, None);
            }
        }
    }
}
