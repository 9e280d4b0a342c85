//! Random objects and lights, from a palette of shared data.

use crate::common::host::{Host, Texture};
use crate::common::shapes;
use crate::random::Random;
use ash::vk;
use glam::{DQuat, DVec3, EulerRot};
use revmap::gpu::HostImage;
use revmap::maps::{ColorMap, DisplacementMap, Projection, SlopeFilter};
use revmap::profile::Profile;
use revmap::scene::{
    BumpForm, Clip, Copies, Environment, Light, Lighting, Material, Object, Offset, Placement,
    Shadow,
};
use std::sync::Arc;

/// Data that the objects of an episode share, and the techniques of the episode.
pub struct Palette<'a> {
    profiles: Vec<Arc<Profile>>,
    colors: Vec<Arc<ColorMap>>,
    slopes: Vec<Arc<DisplacementMap>>,
    /// Images of colours, of slopes and of heights, two each.
    pub images: [[HostImage; 2]; 3],
    pub textured: bool,
    offsets: bool,
    cut: bool,
    replicas: bool,
    pub shadows: bool,
    /// The images' textures, as long as they are held or commands may read them.
    textures: Vec<Kept<'a>>,
    host: &'a Host,
}

/// A texture and its image.
struct Kept<'a> {
    _texture: Texture<'a>,
    image: HostImage,
    /// Frames since nothing else holds the image.
    unheld: usize,
}

/// Side of textures, texels.
const SIDE: u32 = 8;

fn color_texels(seed: u32) -> Vec<[u8; 4]> {
    let texel = |n: u32| {
        let (x, y) = (n % SIDE, n / SIDE);
        [(30 * x) as u8, (30 * y) as u8, (90 * seed % 256) as u8, 255]
    };
    (0..SIDE * SIDE).map(texel).collect()
}

fn heights(seed: u32) -> Vec<f32> {
    let height = |n| ((n * (29 + 2 * seed)) % 64) as f32 / 64.0;
    (0..SIDE * SIDE).map(height).collect()
}

fn color_map(seed: u32) -> Arc<ColorMap> {
    Arc::new(ColorMap::from_texels(SIDE, SIDE, color_texels(seed)).unwrap())
}

fn slope_map(seed: u32) -> Arc<DisplacementMap> {
    let filter = SlopeFilter::Scharr;
    let map = DisplacementMap::from_heights(SIDE, SIDE, &heights(seed), filter);
    Arc::new(map.unwrap())
}

/// A texture of colours (0), slopes (1) or heights (2).
fn kept(host: &Host, kind: u32, seed: u32) -> Kept<'_> {
    use vk::Format as F;
    let (format, texels) = match kind {
        0 => (F::R8G8B8A8_SRGB, color_texels(seed)),
        1 => {
            let slopes = slope_map(seed).encode().unwrap();
            (
                F::R16G16_SFLOAT,
                bytemuck::pod_collect_to_vec(&slopes[0].texels),
            )
        }
        _ => (F::R32_SFLOAT, bytemuck::pod_collect_to_vec(&heights(seed))),
    };
    let texture = Texture::new(host, format, &texels);
    let image = texture.image();
    Kept {
        _texture: texture,
        image,
        unheld: 0,
    }
}

/// An outline of some corners, from the axis to the axis.
fn profile(dice: &mut Random) -> Profile {
    if dice.chance(0.1) {
        // One that has no contour.
        return shapes::crossing();
    }
    let count = 3 + dice.below(10);
    let mut points = vec![[0.0, 0.05]];
    for n in 0..count {
        let z = 0.05 + 0.9 * n as f64 / (count - 1) as f64;
        points.push([dice.between(0.05, 0.42), z]);
    }
    points.push([0.0, 0.95]);
    Profile::polygon(&points, 0.5).unwrap()
}

impl<'a> Palette<'a> {
    pub fn new(host: &'a Host, dice: &mut Random) -> Self {
        let mut profiles = shapes::all();
        let profiles = (0..4).map(|_| profiles.remove(dice.below(profiles.len())).1);
        let textures: Vec<_> = (0..6).map(|n| kept(host, n / 2, 3 + n % 2)).collect();
        let image = |n: usize| textures[n].image.clone();
        Self {
            profiles: profiles.map(Arc::new).collect(),
            colors: (0..3).map(color_map).collect(),
            slopes: (0..2).map(slope_map).collect(),
            images: [0, 2, 4].map(|n| [image(n), image(n + 1)]),
            textured: dice.chance(0.7),
            offsets: dice.chance(0.7),
            cut: dice.chance(0.3),
            replicas: dice.chance(0.3),
            shadows: dice.chance(0.4),
            textures,
            host,
        }
    }

    /// Replaces an image. The old one is destroyed when nothing holds it.
    pub fn change_images(&mut self, dice: &mut Random) {
        let (kind, seed) = (dice.below(3), dice.below(250));
        let new = kept(self.host, kind as u32, seed as u32);
        self.images[kind][dice.below(2)] = new.image.clone();
        self.textures.push(new);
    }

    /// Replaces a profile by one that no object has.
    pub fn change_profile(&mut self, dice: &mut Random) {
        let profile = Arc::new(profile(dice));
        let n = dice.below(self.profiles.len());
        self.profiles[n] = profile;
    }

    /// Destroys the textures that were not held for so many frames.
    pub fn free_unheld(&mut self, frames: usize) {
        for kept in &mut self.textures {
            kept.unheld = if kept.image.is_held() {
                0
            } else {
                kept.unheld + 1
            };
        }
        self.textures.retain(|kept| kept.unheld <= frames);
    }

    /// An object with one copy or several.
    pub fn object(&self, dice: &mut Random) -> Object {
        let mut object = Object::new("one", dice.pick(&self.profiles));
        object.placement = placement(dice);
        self.change_look(dice, &mut object);
        if dice.chance(0.25) {
            object.instances = copies(dice);
        }
        object
    }

    /// Changes some values of an object other than its copies.
    pub fn change_look(&self, dice: &mut Random, object: &mut Object) {
        if dice.chance(0.2) {
            object.profile = dice.pick(&self.profiles);
        }
        if dice.chance(0.6) {
            object.color = [0; 3].map(|_| dice.between(0.0, 1.0) as f32);
        }
        if dice.chance(0.2) {
            object.specular.shininess = dice.pick(&[4.0, 80.0]);
            let (roughness, metalness) = (dice.between(0.0, 1.0) as f32, 1.0);
            object.material = dice.chance(0.5).then_some(Material {
                roughness,
                metalness,
            });
        }
        if self.offsets && dice.chance(0.4) {
            object.offset = self.offset(dice);
        }
        if self.cut && dice.chance(0.4) {
            object.clip = dice.pick(&[Clip::None, Clip::Box]);
            object.axis = dice.pick(&[[0.5; 2], [0.45, 0.5]]);
        }
        if self.replicas && dice.chance(0.4) {
            object.repeat = dice.pick(&[[1; 3], [1; 3], [2, 2, 1], [1, 1, 3]]);
            object.mirror = dice.pick(&[[false; 3], [true, false, true]]);
        }
        if self.textured && dice.chance(0.5) {
            self.change_textures(dice, object);
        }
    }

    fn change_textures(&self, dice: &mut Random, object: &mut Object) {
        let look = &mut object.texturing;
        look.color_map = match dice.below(4) {
            0 => None,
            // A map that no object has.
            1 => Some(color_map(dice.below(250) as u32)),
            _ => Some(dice.pick(&self.colors)),
        };
        look.displacement_map = dice.chance(0.4).then(|| dice.pick(&self.slopes));
        look.bump = dice.pick(&[0.02, 0.05]);
        look.bump_form = dice.pick(&[BumpForm::SurfaceGradient, BumpForm::Papers]);
        look.projection = dice.pick(&Projection::NAMES.map(|(_, projection)| projection));
        look.repeat = dice.pick(&[[1.0; 2], [2.0, 1.0], [1.0, 3.0]]);
        look.offset = dice.pick(&[[0.0; 2], [0.0; 2], [0.3, 0.0], [-1.6, 0.4]]);
    }

    pub fn offset(&self, dice: &mut Random) -> Offset {
        Offset {
            extend: dice.pick(&[0.0, 0.0, -0.01, 0.01, 0.03, 0.2]),
            bevel: dice.pick(&[0.0, 0.0, 0.08]),
            chamfer: dice.pick(&[1.0, 0.4]),
        }
    }

    pub fn lighting(&self, dice: &mut Random) -> Lighting {
        let light = |dice: &mut Random| Light {
            direction: DVec3::new(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), -0.6),
            color: [0.4; 3],
            radius: dice.pick(&[2.0, 20.0]),
        };
        let count = dice.pick(&[0, 1, 2, 2, 3, 5]);
        Lighting {
            ambient: [0.1 + 0.1 * dice.below(3) as f32; 3],
            environment: dice.chance(0.3).then(|| Environment {
                up: [0.5, 0.7, dice.between(0.2, 1.1) as f32],
                down: [0.3, 0.2, 0.1],
            }),
            lights: (0..count).map(|_| light(dice)).collect(),
            shadow: match self.shadows {
                true => dice.pick(&[Shadow::Off, Shadow::Off, Shadow::Hard, Shadow::Soft]),
                false => Shadow::Off,
            },
        }
    }
}

/// A placement near the origin.
pub fn placement(dice: &mut Random) -> Placement {
    let mut turn = || dice.between(-3.0, 3.0);
    let turns = [turn(), turn(), turn()];
    let rotation = match dice.chance(0.5) {
        true => DQuat::IDENTITY,
        false => DQuat::from_euler(EulerRot::XYZ, turns[0], turns[1], turns[2]),
    };
    let scale = dice.between(0.2, 1.3);
    let stretched = DVec3::new(1.0, 0.8, 1.4) * scale;
    Placement {
        position: DVec3::new(
            dice.between(-1.5, 1.5),
            dice.between(-1.5, 1.5),
            dice.between(-1.0, 0.5),
        ),
        rotation,
        scale: dice.pick(&[DVec3::splat(scale), DVec3::splat(scale), stretched]),
    }
}

/// Copies around the limits at which draw paths change; 0 is one copy at the placement.
pub fn copies(dice: &mut Random) -> Copies {
    let count = dice.pick(&[0, 0, 1, 2, 2, 5, 63, 64, 65, 66, 130, 400, 700]);
    many(dice, count)
}

pub fn many(dice: &mut Random, count: usize) -> Copies {
    let size = 2.0 / (count as f64).cbrt().max(1.0);
    let one = |_| {
        let mut one = placement(dice);
        one.scale *= size.min(1.0);
        one
    };
    (0..count).map(one).collect()
}
