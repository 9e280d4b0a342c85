//! The textures that an object's shader samples: images of the host, colour and displacement maps,
//! each on the device once. The samplers and descriptor sets that bind them.

use crate::error::{Error, ErrorKind, Result, lock};
use crate::gpu::device::Shared;
use crate::gpu::memory::images::{Image, Uploads};
use crate::gpu::resources::shape_texture::{ArcTexture, MapFacts, MapKey, ShapeTexture};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::descriptors::{TEXTURE_SET, allocate};
use crate::maps::{Level, MapFormat};
use crate::profile::Profile;
use crate::scene::Texturing;
use crate::shader::HostLook;
use crate::shader::generated::MAX_SHADOW_MAPS;
use crate::solid::cache::Kept;
use ash::vk;
use std::any::Any;
use std::sync::{Arc, Mutex};

/// An image of the host, for [`Renderer::set_color_image`](crate::gpu::Renderer::set_color_image),
/// [`Renderer::set_slope_image`](crate::gpu::Renderer::set_slope_image) and
/// [`Renderer::set_height_image`](crate::gpu::Renderer::set_height_image). Clones are the same image.
/// Objects with the same image share draws.
#[derive(Clone, Debug)]
pub struct HostImage(Arc<(vk::ImageView, vk::Sampler)>);

impl HostImage {
    /// An image of a 2D view and a sampler.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for null handles.
    ///
    /// # Safety
    /// The call keeps the handles. Renderers bind them.
    ///
    /// The caller must ensure that
    /// * both are of the renderer's device, and stay valid while [`HostImage::is_held`] is true and
    ///   until commands that were recorded before have run;
    /// * the format is of floats or fractions, with linear filter if the sampler has one;
    /// * the image is in `SHADER_READ_ONLY_OPTIMAL` while recorded frames run, and its writes are
    ///   visible to the stage that draws.
    pub unsafe fn new(view: vk::ImageView, sampler: vk::Sampler) -> Result<Self> {
        if view == vk::ImageView::null() || sampler == vk::Sampler::null() {
            let message = "the image's view or sampler is null; give both";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        Ok(Self(Arc::new((view, sampler))))
    }

    /// True while another clone is alive: of the host, of an object, or of a slot. A slot holds the
    /// images of its last frame until it is prepared again.
    #[must_use]
    pub fn is_held(&self) -> bool {
        Arc::strong_count(&self.0) > 1
    }

    fn info(&self) -> vk::DescriptorImageInfo {
        sampled(self.0.0, self.0.1)
    }
}

/// The images of an object. An image replaces the object's own map.
#[derive(Clone, Debug, Default)]
pub(crate) struct ObjectImages {
    pub color: Option<HostImage>,
    /// Slopes, or the heights that they are differences of.
    pub relief: Option<HostImage>,
    pub heights: bool,
}

impl ObjectImages {
    pub fn look(&self) -> HostLook {
        HostLook {
            colors: self.color.is_some(),
            relief: self.relief.is_some(),
            heights: self.relief.is_some() && self.heights,
        }
    }
}

/// A colour or displacement map on the device. The map is kept because its address is the key.
struct Covering {
    _map: Arc<dyn Any + Send + Sync>,
    image: Arc<Image>,
}

/// The textures of one object or of many that look alike, and the descriptor set that binds them.
pub(crate) struct TextureSet {
    pub set: vk::DescriptorSet,
    color: Option<Arc<Covering>>,
    slopes: Option<Arc<Covering>>,
    bound: BoundTextures,
    pool: Arc<SetPool>,
}

/// The shape maps that shadows read, in the order of their numbers.
pub(crate) type ShadowMaps = Vec<Arc<ShapeTexture>>;

/// Addresses of the textures of a set, and the address mode of its surface textures.
type Key = ([usize; 5], bool);

/// All textures of a renderer. No other renderer has them: commands of two renderers may run in any
/// order, those of uploads, too.
pub(crate) struct Textures {
    /// By the address of the profile.
    shapes: Kept<(usize, MapKey), ShapeTexture>,
    /// By the address of the profile, columns and rows.
    arcs: Kept<(usize, u32, u32), ArcTexture>,
    coverings: Kept<usize, Covering>,
    sets: Kept<Key, TextureSet>,
    /// The texture that is bound if an object has none of a kind.
    blank: Arc<Image>,
    /// A set of blank textures, for pipelines that draw no pixel.
    pub blank_set: Option<Arc<TextureSet>>,
    pool: Arc<SetPool>,
    /// Copies to new images, which wait for commands.
    pub uploads: Uploads,
}

/// The textures that an object binds, besides its colour and displacement maps.
#[derive(Default)]
pub(crate) struct BoundTextures {
    pub images: ObjectImages,
    pub shape: Option<Arc<ShapeTexture>>,
    pub arc: Option<Arc<ArcTexture>>,
    pub shadows: Arc<ShadowMaps>,
}

impl Textures {
    pub fn new(device: &Arc<Shared>, format: MapFormat, host_shades: bool) -> Result<Self> {
        let mut uploads = Uploads::new(device);
        let texel = vk::Format::R32_SFLOAT;
        let mut all = Self {
            shapes: Kept::default(),
            arcs: Kept::default(),
            coverings: Kept::default(),
            sets: Kept::default(),
            blank: uploads.image("blank", texel, (1, 1), &[&[0; 4]])?,
            blank_set: None,
            pool: Arc::new(SetPool::new(device, format, host_shades)?),
            uploads,
        };
        all.blank_set = Some(all.set(&Texturing::default(), BoundTextures::default())?);
        Ok(all)
    }

    /// The shape map of a profile. A new map is baked, and its upload is queued.
    pub fn shape(&mut self, profile: &Arc<Profile>, key: MapKey) -> Result<Arc<ShapeTexture>> {
        let make = || ShapeTexture::bake(&mut self.uploads, profile, key);
        self.shapes.get((address(profile), key), make)
    }

    /// The lengths along the outline of a profile, for a map with these facts.
    pub fn arc(&mut self, profile: &Arc<Profile>, facts: &MapFacts) -> Result<Arc<ArcTexture>> {
        let make = || ArcTexture::new(&mut self.uploads, profile, facts);
        let key = (address(profile), facts.columns, facts.rows);
        self.arcs.get(key, make)
    }

    /// The set of an object of this look, shared by all objects that bind the same textures.
    pub fn set(&mut self, look: &Texturing, bound: BoundTextures) -> Result<Arc<TextureSet>> {
        let BoundTextures {
            images,
            shape,
            arc,
            shadows,
        } = &bound;
        let color_map = look.color_map.as_ref().filter(|_| images.color.is_none());
        let slope_map = look.displacement_map.as_ref();
        let slope_map = slope_map.filter(|_| images.relief.is_none());
        let image = |of: &Option<HostImage>| of.as_ref().map(|image| address(&image.0));
        let around = look.clamps();
        let addresses = [
            shape.as_ref().map(address),
            image(&images.color).or(color_map.map(address)),
            image(&images.relief).or(slope_map.map(address)),
            arc.as_ref().map(address),
            Some(address(shadows)),
        ];
        let key = (addresses.map(Option::unwrap_or_default), around);
        if let Some(known) = self.sets.known(&key) {
            return Ok(known);
        }
        let (coverings, uploads) = (&mut self.coverings, &mut self.uploads);
        let color = color_map.map(|map| {
            let format = vk::Format::R8G8B8A8_SRGB;
            covering(coverings, map, || {
                upload(uploads, "colour map", format, &map.levels)
            })
        });
        let color = color.transpose()?;
        let slopes = slope_map.map(|map| {
            let format = vk::Format::R16G16_SFLOAT;
            covering(coverings, map, || {
                upload(uploads, "displacement map", format, &map.encode()?)
            })
        });
        let slopes = slopes.transpose()?;
        let made = TextureSet {
            set: self.pool.take()?,
            color,
            slopes,
            bound,
            pool: self.pool.clone(),
        };
        self.write(&made, around);
        Ok(self.sets.keep(key, made))
    }

    /// Points a new set to its textures: four of the object, then the maps that shadows read.
    fn write(&self, made: &TextureSet, around: bool) {
        let [map, repeated, clamped] = self.pool.samplers;
        let surface = if around { clamped } else { repeated };
        let info = |image: &Image, sampler| sampled(image.view, sampler);
        let blank = info(&self.blank, map);
        let shape = |s: &Arc<ShapeTexture>| info(&s.texture, map);
        let look = |host: &Option<HostImage>, own: &Option<Arc<Covering>>| {
            let own = own.as_ref().map(|covering| info(&covering.image, surface));
            host.as_ref().map(HostImage::info).or(own).unwrap_or(blank)
        };
        let bound = &made.bound;
        let arc = |arc: &Arc<ArcTexture>| info(&arc.texture, map);
        let own = [
            bound.shape.as_ref().map_or(blank, shape),
            look(&bound.images.color, &made.color),
            look(&bound.images.relief, &made.slopes),
            bound.arc.as_ref().map_or(blank, arc),
        ];
        let shadows = bound.shadows.iter().map(shape);
        let shadows: Vec<_> = shadows
            .chain(std::iter::repeat(blank))
            .take(MAX_SHADOW_MAPS as usize)
            .collect();
        let shadows = (!self.pool.host_shades).then_some(shadows.as_slice());
        let writes: Vec<_> = (0u32..)
            .zip(own.chunks(1).chain(shadows))
            .map(|(binding, infos)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(made.set)
                    .dst_binding(binding)
                    .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                    .image_info(infos)
            })
            .collect();
        // SAFETY: the set is new, or all frames that used it are done.
        unsafe { self.pool.device.raw.update_descriptor_sets(&writes, &[]) };
    }

    /// Bytes of colour and displacement maps on the device.
    pub fn bytes(&self) -> u64 {
        self.coverings.living().map(|c| c.image.bytes()).sum()
    }
}

fn address<T>(of: &Arc<T>) -> usize {
    Arc::as_ptr(of) as usize
}

/// The image of a map; made now if it is not known.
fn covering<M: Send + Sync + 'static>(
    all: &mut Kept<usize, Covering>,
    map: &Arc<M>,
    upload: impl FnOnce() -> Result<Arc<Image>>,
) -> Result<Arc<Covering>> {
    all.get(address(map), || {
        Ok(Covering {
            _map: map.clone(),
            image: upload()?,
        })
    })
}

/// Makes an image of all levels of a map.
fn upload<T: bytemuck::Pod>(
    uploads: &mut Uploads,
    name: &str,
    format: vk::Format,
    levels: &[Level<T>],
) -> Result<Arc<Image>> {
    let size = levels.first().map_or((0, 0), |l| (l.width, l.height));
    let bytes = levels.iter().map(|l| bytemuck::cast_slice(&l.texels));
    uploads.image(name, format, size, &bytes.collect::<Vec<_>>())
}

/// The descriptor of an image that shaders sample.
fn sampled(view: vk::ImageView, sampler: vk::Sampler) -> vk::DescriptorImageInfo {
    vk::DescriptorImageInfo::default()
        .image_view(view)
        .sampler(sampler)
        .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
}

impl Drop for TextureSet {
    fn drop(&mut self) {
        if let Ok(mut state) = self.pool.state.lock() {
            state.free.push(self.set);
        }
    }
}

/// Samplers, and descriptor sets of textures. New pools are made as sets are needed, and returned
/// sets are used again.
struct SetPool {
    /// The sampler of maps; that of surface textures, which repeats around and along the axis; one
    /// that repeats only around, so that the poles' rows do not run into each other.
    samplers: [vk::Sampler; 3],
    /// True if sets have no maps for shadows: [`HOST_TEXTURES`](crate::gpu::vk::descriptors::HOST_TEXTURES).
    host_shades: bool,
    state: Mutex<Sets>,
    device: Arc<Shared>,
}

#[derive(Default)]
struct Sets {
    pools: Vec<vk::DescriptorPool>,
    free: Vec<vk::DescriptorSet>,
}

const SETS: u32 = 64;

impl SetPool {
    /// No sets yet, and samplers for maps of this format.
    fn new(device: &Arc<Shared>, format: MapFormat, host_shades: bool) -> Result<Self> {
        use vk::{Filter, SamplerAddressMode as Address};
        let mut pool = Self {
            samplers: [vk::Sampler::null(); 3],
            host_shades,
            state: Mutex::default(),
            device: device.clone(),
        };
        // Shaders gather and weigh texels themselves, but those of the papers' map.
        let filter = match format {
            MapFormat::Rgba8 => Filter::LINEAR,
            MapFormat::R16 | MapFormat::R32 => Filter::NEAREST,
        };
        let map = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(Address::CLAMP_TO_EDGE)
            .address_mode_v(Address::CLAMP_TO_EDGE);
        let mut repeated = vk::SamplerCreateInfo::default()
            .mag_filter(Filter::LINEAR)
            .min_filter(Filter::LINEAR)
            .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
            .max_lod(vk::LOD_CLAMP_NONE)
            .address_mode_u(Address::REPEAT)
            .address_mode_v(Address::REPEAT);
        if let Some(most) = device.chosen.anisotropy() {
            repeated = repeated
                .anisotropy_enable(true)
                .max_anisotropy(most.min(8.0));
        }
        let infos = [
            map,
            repeated,
            repeated.address_mode_v(Address::CLAMP_TO_EDGE),
        ];
        for (sampler, info) in pool.samplers.iter_mut().zip(infos) {
            // SAFETY: a plain creation, destroyed in Drop.
            *sampler = unsafe { device.raw.create_sampler(&info, None) }.call("vkCreateSampler")?;
        }
        Ok(pool)
    }

    fn take(&self) -> Result<vk::DescriptorSet> {
        let mut state = lock(&self.state)?;
        if state.free.is_empty() {
            let pipelines = &self.device.pipelines;
            let layouts = match self.host_shades {
                true => pipelines.host_layouts(),
                false => pipelines.set_layouts,
            };
            let (pool, sets) = allocate(&self.device.raw, &layouts, &[TEXTURE_SET], SETS)?;
            state.pools.push(pool);
            state.free = sets;
        }
        let none = || Error::new(ErrorKind::Other, "a pool of textures gave no set");
        state.free.pop().ok_or_else(none)
    }
}

impl Drop for SetPool {
    fn drop(&mut self) {
        let pools = self
            .state
            .get_mut()
            .map(|sets| std::mem::take(&mut sets.pools));
        // SAFETY: the renderer's frames are done, and no set is left; a pool frees its sets, and
        // null samplers may be destroyed.
        unsafe {
            for pool in pools.unwrap_or_default() {
                self.device.raw.destroy_descriptor_pool(pool, None);
            }
            for sampler in self.samplers {
                self.device.raw.destroy_sampler(sampler, None);
            }
        }
    }
}
