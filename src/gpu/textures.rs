//! The textures of a scene on the device, each uploaded once however many objects share it.

use super::batch::{MapFacts, MapKey};
use super::commands::{Commands, upload_texture};
use super::descriptors::{Sampler, Wrap};
use super::device::Shared;
use super::memory::Image;
use crate::error::{Error, Result, Stage};
use crate::maps::envelope::Envelope;
use crate::maps::{
    ArcLength, BakeOptions, Bounds, ColorMap, DisplacementMap, MapFormat, Projection, ShapeMap,
};
use crate::scene::{Object, Scene, Shadow};
use crate::settings::Settings;
use crate::shader::generated::MAX_SHADOW_MAPS;
use ash::vk;
use std::sync::Arc;

/// One shape map, and the table of lengths where an object of that shape asks for it.
struct Shape {
    key: MapKey,
    facts: MapFacts,
    /// None where the search reads no map.
    image: Option<Image>,
    arc: Option<Image>,
}

pub(crate) struct Textures {
    shapes: Vec<Shape>,
    colors: Vec<(Arc<ColorMap>, Image)>,
    displacements: Vec<(Arc<DisplacementMap>, Image)>,
    /// Bound where an object has no texture of a kind.
    blank: Image,
    map_sampler: Sampler,
    /// Around and along repeated; around repeated and along clamped.
    surface_samplers: [Sampler; 2],
}

/// What a set of textures is made of.
pub(crate) type Bound = Vec<(vk::ImageView, vk::Sampler)>;

impl Textures {
    pub fn new(
        device: &Arc<Shared>,
        commands: &Commands,
        scene: &Scene,
        settings: &Settings,
    ) -> Result<Self> {
        let blank = upload_texture(
            device,
            commands,
            "blank",
            vk::Format::R32_SFLOAT,
            (1, 1),
            &[&[0; 4]],
        )?;
        let papers = settings.map_format == MapFormat::Rgba8;
        let mut all = Self {
            shapes: Vec::new(),
            colors: Vec::new(),
            displacements: Vec::new(),
            blank,
            map_sampler: Sampler::new(
                device,
                if papers {
                    Wrap::MapLinear
                } else {
                    Wrap::MapNearest
                },
            )?,
            surface_samplers: [
                Sampler::new(device, Wrap::SurfaceRepeated)?,
                Sampler::new(device, Wrap::SurfaceAround)?,
            ],
        };
        // Not every search needs a map; a soft shadow is measured in one.
        let mapped = settings.solver.reads_map() || scene.shadow == Shadow::Soft;
        for (number, object) in scene.objects.iter().enumerate() {
            all.add(device, commands, object, settings, mapped)
                .map_err(|e| {
                    let e = e.at_key(format!("object.{number}.profile"));
                    match &object.file {
                        Some(file) => e.in_file(file),
                        None => e,
                    }
                })?;
        }
        Ok(all)
    }

    fn add(
        &mut self,
        device: &Arc<Shared>,
        commands: &Commands,
        object: &Object,
        settings: &Settings,
        mapped: bool,
    ) -> Result<()> {
        let upload = |name: &str, format, size, levels: &[&[u8]]| {
            upload_texture(device, commands, name, format, size, levels)
        };
        let key = MapKey::new(object, settings);
        let place = match self.shapes.iter().position(|s| s.key == key) {
            Some(place) => place,
            None => {
                let (facts, image) = if mapped {
                    let (facts, image) = shape_map(device, commands, &key, settings.map_format)?;
                    (facts, Some(image))
                } else {
                    (unmapped(&key), None)
                };
                self.shapes.push(Shape {
                    key,
                    facts,
                    image,
                    arc: None,
                });
                self.shapes.len() - 1
            }
        };
        let shape = &mut self.shapes[place];
        if object.texturing.projection == Projection::Arc && shape.arc.is_none() {
            let lengths = ArcLength::new(&object.profile)?;
            let table = lengths.table(shape.facts.columns, shape.facts.rows);
            // 16-bit normalised textures are not everywhere; 32-bit floats are.
            let texels: Vec<f32> = table
                .texels
                .iter()
                .map(|t| f32::from(*t) / f32::from(u16::MAX))
                .collect();
            let size = (table.columns, table.rows);
            let bytes: &[u8] = bytemuck::cast_slice(&texels);
            shape.arc = Some(upload(
                "arc lengths",
                vk::Format::R32_SFLOAT,
                size,
                &[bytes],
            )?);
            shape.facts.arc_length = lengths.total();
        }
        if let Some(map) = &object.texturing.color_map
            && !self.colors.iter().any(|(known, _)| Arc::ptr_eq(known, map))
        {
            let levels: Vec<&[u8]> = map
                .levels
                .iter()
                .map(|l| bytemuck::cast_slice(&l.texels))
                .collect();
            let [w, h] = map.size();
            let image = upload("colour map", vk::Format::R8G8B8A8_SRGB, (w, h), &levels)?;
            self.colors.push((map.clone(), image));
        }
        if let Some(map) = &object.texturing.displacement_map
            && !self
                .displacements
                .iter()
                .any(|(known, _)| Arc::ptr_eq(known, map))
        {
            let encoded = map.encode();
            let levels: Vec<&[u8]> = encoded
                .iter()
                .map(|l| bytemuck::cast_slice(&l.texels))
                .collect();
            let [w, h] = map.size();
            let image = upload(
                "displacement map",
                vk::Format::R16G16_SFLOAT,
                (w, h),
                &levels,
            )?;
            self.displacements.push((map.clone(), image));
        }
        Ok(())
    }

    /// Makes an object's shape map where the search was to do without it.
    pub fn demand_map(
        &mut self,
        device: &Arc<Shared>,
        commands: &Commands,
        object: &Object,
        settings: &Settings,
    ) -> Result<()> {
        let (place, _) = self.shape(object, settings)?;
        let shape = &mut self.shapes[place];
        if shape.image.is_none() {
            let (facts, image) = shape_map(device, commands, &shape.key, settings.map_format)?;
            shape.facts = MapFacts {
                arc_length: shape.facts.arc_length,
                ..facts
            };
            shape.image = Some(image);
        }
        Ok(())
    }

    /// Which of the shape maps is `object`'s, and what it is.
    pub fn shape(&self, object: &Object, settings: &Settings) -> Result<(usize, MapFacts)> {
        let profile = &object.profile;
        self.shapes
            .iter()
            .position(|s| Arc::ptr_eq(&s.key.profile, profile) && s.key.fits(object, settings))
            .map(|place| (place, self.shapes[place].facts.clone()))
            .ok_or_else(|| {
                Error::new(
                    Stage::Draw,
                    format!(
                        "{} is not what the renderer was made with; make a new one",
                        object.name
                    ),
                )
            })
    }

    /// The textures of an object's batch, by binding.
    pub fn of(&self, object: &Object, shape: usize) -> Bound {
        let shape = &self.shapes[shape];
        let look = &object.texturing;
        let along = usize::from(
            (look.repeat[1] - 1.0).abs() < f64::EPSILON && look.projection != Projection::Planar,
        );
        let sampler = self.surface_samplers[along].raw;
        let blank = (self.blank.view, self.map_sampler.raw);
        let color = look.color_map.as_ref().and_then(|map| {
            let found = self
                .colors
                .iter()
                .find(|(known, _)| Arc::ptr_eq(known, map));
            found.map(|(_, image)| (image.view, sampler))
        });
        let slopes = look.displacement_map.as_ref().and_then(|map| {
            let found = self
                .displacements
                .iter()
                .find(|(known, _)| Arc::ptr_eq(known, map));
            found.map(|(_, image)| (image.view, sampler))
        });
        let arc = shape
            .arc
            .as_ref()
            .map(|image| (image.view, self.map_sampler.raw));
        let mut bound = vec![
            shape
                .image
                .as_ref()
                .map_or(blank, |i| (i.view, self.map_sampler.raw)),
            color.unwrap_or(blank),
            slopes.unwrap_or(blank),
            arc.unwrap_or(blank),
        ];
        let maps = self.shapes.iter().map(|s| {
            s.image
                .as_ref()
                .map_or(blank, |i| (i.view, self.map_sampler.raw))
        });
        bound.extend(
            maps.chain(std::iter::repeat(blank))
                .take(MAX_SHADOW_MAPS as usize),
        );
        bound
    }

    /// Fails where shadows need more maps at once than a shader is given.
    pub fn check_shadows(&self) -> Result<()> {
        let (count, most) = (self.shapes.len(), MAX_SHADOW_MAPS as usize);
        if count > most {
            return Err(Error::new(
                Stage::Scene,
                format!("shadows between {count} different shapes; at most {most} are drawn: share profiles, or set \"off\""),
            )
            .at_key("shadow"));
        }
        Ok(())
    }

    /// Bytes on the device: of shape maps, of colour and displacement maps.
    pub fn bytes(&self) -> [u64; 2] {
        let shapes = self.shapes.iter().map(|s| {
            [&s.image, &s.arc]
                .into_iter()
                .flatten()
                .map(Image::bytes)
                .sum::<u64>()
        });
        let colors = self.colors.iter().map(|(_, i)| i.bytes());
        let slopes = self.displacements.iter().map(|(_, i)| i.bytes());
        [shapes.sum(), colors.chain(slopes).sum()]
    }
}

fn shape_map(
    device: &Arc<Shared>,
    commands: &Commands,
    key: &MapKey,
    format: MapFormat,
) -> Result<(MapFacts, Image)> {
    let map = ShapeMap::bake(
        &key.profile,
        &BakeOptions {
            source: key.source,
            rows: key.rows,
            reach: key.reach,
        },
    )?;
    let encoded = map.encode(format);
    let vk_format = match format {
        MapFormat::Rgba8 => vk::Format::R8G8B8A8_UNORM,
        MapFormat::R16 => vk::Format::R16_SFLOAT,
        MapFormat::R32 => vk::Format::R32_SFLOAT,
    };
    let size = (encoded.columns, encoded.rows);
    let levels = [encoded.bytes.as_slice()];
    let image = upload_texture(device, commands, "shape map", vk_format, size, &levels)?;
    let facts = MapFacts {
        columns: encoded.columns,
        rows: encoded.rows,
        scale: encoded.scale,
        bounds: map.bounds,
        arc_length: 1.0,
        envelope: Envelope::of(&map).map(Arc::new),
    };
    Ok((facts, image))
}

/// The facts of a map that is not there: its size, were it baked, and what the solid occupies.
fn unmapped(key: &MapKey) -> MapFacts {
    let rows = f64::from(key.rows);
    MapFacts {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most some 10^4
        columns: (key.reach.max(key.profile.radius) * rows).ceil() as u32,
        rows: key.rows,
        scale: 1.0,
        // Of a solid that is not there nothing is clipped; nothing is met either.
        bounds: key.profile.outline.bounds().unwrap_or(Bounds {
            r_min: 0.0,
            r_max: key.profile.radius,
            z_min: 0.0,
            z_max: 1.0,
        }),
        arc_length: 1.0,
        envelope: None,
    }
}
