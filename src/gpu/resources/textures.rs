//! The textures that an object's shader samples: colour and displacement maps, each on the device
//! once. The sets that bind them.

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::memory::Image;
use crate::gpu::memory::images::Uploads;
use crate::gpu::resources::host_image::{HostImage, ObjectImages};
use crate::gpu::resources::shape_texture::{ArcTexture, ShapeTexture};
use crate::gpu::resources::texture_binding::{Sampler, SetPool, Wrap};
use crate::maps::{ColorMap, DisplacementMap, MapFormat, Projection};
use crate::scene::Texturing;
use crate::shader::generated::MAX_SHADOW_MAPS;
use crate::solid::kept::Kept;
use ash::vk;
use std::sync::Arc;

/// A colour or displacement map on the device. The map is kept because its address is the key.
struct Covering<M> {
    _map: Arc<M>,
    image: Arc<Image>,
}

/// The textures of one object or of many that look alike, and the descriptor set that binds them.
pub(crate) struct TextureSet {
    pub set: vk::DescriptorSet,
    color: Option<Arc<Covering<ColorMap>>>,
    slopes: Option<Arc<Covering<DisplacementMap>>>,
    images: ObjectImages,
    shape: Option<Arc<ShapeTexture>>,
    arc: Option<Arc<ArcTexture>>,
    shadows: Arc<ShadowMaps>,
    pool: Arc<SetPool>,
}

/// The shape maps that shadows read, in the order of their numbers.
#[derive(Default)]
pub(crate) struct ShadowMaps {
    pub maps: Vec<Arc<ShapeTexture>>,
}

/// Addresses of the textures of a set, and the address mode of its surface textures.
type Key = ([usize; 5], bool);

/// All textures of a renderer.
pub(crate) struct Textures {
    colors: Kept<usize, Covering<ColorMap>>,
    slopes: Kept<usize, Covering<DisplacementMap>>,
    sets: Kept<Key, TextureSet>,
    /// The texture that is bound if an object has none of a kind.
    blank: Arc<Image>,
    map_sampler: Sampler,
    /// First repeats around and along; second repeats around and clamps along.
    surface_samplers: [Sampler; 2],
    pool: Arc<SetPool>,
}

/// The textures that an object binds.
pub(crate) struct ObjectTextures<'a> {
    pub look: &'a Texturing,
    pub images: &'a ObjectImages,
    pub shape: Option<Arc<ShapeTexture>>,
    pub arc: Option<Arc<ArcTexture>>,
    pub shadows: &'a Arc<ShadowMaps>,
}

impl Textures {
    pub fn new(device: &Arc<Shared>, uploads: &mut Uploads, format: MapFormat) -> Result<Self> {
        let wrap = if format == MapFormat::Rgba8 {
            Wrap::MapLinear
        } else {
            Wrap::MapNearest
        };
        let texel = vk::Format::R32_SFLOAT;
        Ok(Self {
            colors: Kept::default(),
            slopes: Kept::default(),
            sets: Kept::default(),
            blank: uploads.image(device, "blank", texel, (1, 1), &[&[0; 4]])?,
            map_sampler: Sampler::new(device, wrap)?,
            surface_samplers: [
                Sampler::new(device, Wrap::SurfaceRepeated)?,
                Sampler::new(device, Wrap::SurfaceAround)?,
            ],
            pool: Arc::new(SetPool::new(device)),
        })
    }

    /// The set of an object, shared by all objects that bind the same textures.
    pub fn set(
        &mut self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        bound: ObjectTextures,
    ) -> Result<Arc<TextureSet>> {
        let ObjectTextures {
            look,
            images,
            shape,
            arc,
            shadows,
        } = bound;
        let color_map = look.color_map.as_ref().filter(|_| images.color.is_none());
        let slope_map = look.displacement_map.as_ref();
        let slope_map = slope_map.filter(|_| images.relief.is_none());
        let image = |of: &Option<HostImage>| of.as_ref().map(HostImage::address);
        let around =
            (look.repeat[1] - 1.0).abs() < f64::EPSILON && look.projection != Projection::Planar;
        let address = |of: Option<usize>| of.unwrap_or(0);
        let key = (
            [
                address(shape.as_ref().map(|s| Arc::as_ptr(s) as usize)),
                address(image(&images.color).or(color_map.map(|m| Arc::as_ptr(m) as usize))),
                address(image(&images.relief).or(slope_map.map(|m| Arc::as_ptr(m) as usize))),
                address(arc.as_ref().map(|a| Arc::as_ptr(a) as usize)),
                Arc::as_ptr(shadows) as usize,
            ],
            around,
        );
        if let Some(known) = self.sets.known(&key) {
            return Ok(known);
        }
        let color = match color_map {
            Some(map) => Some(self.color(device, uploads, map)?),
            None => None,
        };
        let slopes = match slope_map {
            Some(map) => Some(self.slopes(device, uploads, map)?),
            None => None,
        };
        let made = TextureSet {
            set: self.pool.take()?,
            color,
            slopes,
            images: images.clone(),
            shape,
            arc,
            shadows: shadows.clone(),
            pool: self.pool.clone(),
        };
        self.write(device, &made, around);
        let made = self.sets.keep(key, made);
        Ok(made)
    }

    fn color(
        &mut self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        map: &Arc<ColorMap>,
    ) -> Result<Arc<Covering<ColorMap>>> {
        covering(&mut self.colors, map, || {
            let levels: Vec<&[u8]> = map
                .levels
                .iter()
                .map(|l| bytemuck::cast_slice(&l.texels))
                .collect();
            let [w, h] = map.size();
            let format = vk::Format::R8G8B8A8_SRGB;
            uploads.image(device, "colour map", format, (w, h), &levels)
        })
    }

    fn slopes(
        &mut self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        map: &Arc<DisplacementMap>,
    ) -> Result<Arc<Covering<DisplacementMap>>> {
        covering(&mut self.slopes, map, || {
            let encoded = map.encode();
            let levels: Vec<&[u8]> = encoded
                .iter()
                .map(|l| bytemuck::cast_slice(&l.texels))
                .collect();
            let [w, h] = map.size();
            let format = vk::Format::R16G16_SFLOAT;
            uploads.image(device, "displacement map", format, (w, h), &levels)
        })
    }

    /// Points a new set to its textures: four of the object, then the maps that shadows read.
    fn write(&self, device: &Shared, made: &TextureSet, around: bool) {
        let info = |image: &Image, sampler: &Sampler| {
            vk::DescriptorImageInfo::default()
                .image_view(image.view)
                .sampler(sampler.raw)
                .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
        };
        let (map, surface) = (
            &self.map_sampler,
            &self.surface_samplers[usize::from(around)],
        );
        let blank = info(&self.blank, map);
        let shape = |s: &Arc<ShapeTexture>| info(&s.texture, map);
        let covering = |of: Option<&Image>, host: &Option<HostImage>| {
            let own = of.map(|image| info(image, surface));
            host.as_ref().map(HostImage::info).or(own).unwrap_or(blank)
        };
        let color = made.color.as_ref().map(|c| c.image.as_ref());
        let slopes = made.slopes.as_ref().map(|c| c.image.as_ref());
        let own = [
            made.shape.as_ref().map_or(blank, shape),
            covering(color, &made.images.color),
            covering(slopes, &made.images.relief),
            made.arc.as_ref().map_or(blank, |a| info(&a.texture, map)),
        ];
        let shadows: Vec<_> = made
            .shadows
            .maps
            .iter()
            .map(shape)
            .chain(std::iter::repeat(blank))
            .take(MAX_SHADOW_MAPS as usize)
            .collect();
        let writes: Vec<_> = (0u32..)
            .zip(own.chunks(1))
            .chain([(4, shadows.as_slice())])
            .map(|(binding, infos)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(made.set)
                    .dst_binding(binding)
                    .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                    .image_info(infos)
            })
            .collect();
        // SAFETY: the set is new, or all frames that used it are done.
        unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
    }

    /// Bytes of colour and displacement maps on the device.
    pub fn bytes(&self) -> u64 {
        let colors = self.colors.living().map(|c| c.image.bytes());
        let slopes = self.slopes.living().map(|c| c.image.bytes());
        colors.chain(slopes).sum()
    }
}

fn covering<M>(
    all: &mut Kept<usize, Covering<M>>,
    map: &Arc<M>,
    upload: impl FnOnce() -> Result<Arc<Image>>,
) -> Result<Arc<Covering<M>>> {
    all.get(Arc::as_ptr(map) as usize, || {
        Ok(Covering {
            _map: map.clone(),
            image: upload()?,
        })
    })
}

impl Drop for TextureSet {
    fn drop(&mut self) {
        self.pool.give_back(self.set);
    }
}
