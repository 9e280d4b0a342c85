//! A solid of revolution: profile, texturing, offset of the surface, and placements.

use super::{Cluster, Copies, Placement};
use crate::maps::{ColorMap, DisplacementMap, Projection};
use crate::profile::Profile;
use crate::surface::Offset;
use std::path::PathBuf;
use std::sync::Arc;

/// A solid of revolution, drawn once or as many copies. Members are keys of a scene file.
#[derive(Clone, Debug)]
pub struct Object {
    /// Name in messages and pictures: the file name of the profile, or `polygon`.
    pub name: String,
    /// The profile's file, if it was read from one.
    pub file: Option<PathBuf>,
    /// The profile that is turned about the axis. Objects that share a profile share its maps.
    pub profile: Arc<Profile>,
    /// Rows of its shape map.
    pub map_rows: u32,
    /// Linear RGB; unused if [`Texturing::color_map`] is set.
    pub color: [f32; 3],
    /// Strength and exponent of the Blinn-Phong highlight.
    pub specular: Specular,
    /// Roughness and metalness, for hosts that shade by themselves. `None` gives the roughness that
    /// fits the highlight's exponent, and no metal.
    pub material: Option<Material>,
    /// Textures of the surface.
    pub texturing: Texturing,
    /// Extension, bevel and chamfer.
    pub offset: Offset,
    /// The clip mode for the part that an offset adds beyond the shape box.
    pub clip: Clip,
    /// `(Ox, Oy)`: position of the axis in box texture coordinates.
    pub axis: [f64; 2],
    /// Number of replicas in the box along x, y, z: each is the whole solid, shrunk to its cell. At
    /// least 1 each.
    pub repeat: [u32; 3],
    /// True along x, y, z to reflect every second replica.
    pub mirror: [bool; 3],
    /// Position, rotation and scale of the object.
    pub placement: Placement,
    /// Placements of copies; empty for a single solid at `placement`. If there are copies, their
    /// placements replace `placement`.
    pub instances: Copies,
}

impl Object {
    /// Default number of rows of a shape map.
    pub const MAP_ROWS: u32 = 512;
    /// The default colour of an object, linear RGB.
    pub const COLOR: [f32; 3] = [0.8; 3];

    /// `profile` turned about its axis, with every other value at its default: light grey, plain,
    /// at the origin.
    #[must_use]
    pub fn new(name: impl Into<String>, profile: Arc<Profile>) -> Self {
        Self {
            name: name.into(),
            file: None,
            profile,
            map_rows: Self::MAP_ROWS,
            color: Self::COLOR,
            specular: Specular::default(),
            material: None,
            texturing: Texturing::default(),
            offset: Offset::default(),
            clip: Clip::default(),
            axis: [0.5; 2],
            repeat: [1; 3],
            mirror: [false; 3],
            placement: Placement::default(),
            instances: Copies::default(),
        }
    }

    /// Returns true if both look the same in their own space: all values except placement and
    /// instances are equal, and shared data is identical.
    pub(crate) fn same_look(&self, other: &Self) -> bool {
        let shared = |of: &Self| {
            let look = &of.texturing;
            let color = look.color_map.as_ref().map(Arc::as_ptr);
            let slopes = look.displacement_map.as_ref().map(Arc::as_ptr);
            (Arc::as_ptr(&of.profile), color, slopes)
        };
        let values = |of: &Self| {
            let look = &of.texturing;
            (
                (of.color, of.specular, of.material, of.offset, of.axis),
                (of.map_rows, of.repeat, of.mirror, of.clip),
                (look.bump, look.bump_form, look.projection),
                (look.repeat, look.offset),
            )
        };
        let named = (&self.name, &self.file) == (&other.name, &other.file);
        named && shared(self) == shared(other) && values(self) == values(other)
    }

    /// The least `value` of any of its copies. `bound` must not exceed the `value` of any copy in a
    /// cluster.
    pub(crate) fn least_of_copies(
        &self,
        bound: impl Fn(&Cluster) -> f64,
        value: impl Fn(&Placement) -> f64,
    ) -> f64 {
        if self.instances.is_empty() {
            return value(&self.placement);
        }
        self.instances.clusters().least(bound, value)
    }

    /// Its material, or the one that fits its highlight: a microfacet distribution of width
    /// sqrt(2 / (exponent + 2)) is as wide (Walter et al. 2007, *Microfacet models for refraction
    /// through rough surfaces*).
    #[must_use]
    pub fn material(&self) -> Material {
        self.material.unwrap_or(Material {
            roughness: (2.0 / (self.specular.shininess.max(0.0) + 2.0)).powf(0.25),
            metalness: 0.0,
        })
    }

    /// Position of the axis, object units from the middle of the box.
    #[must_use]
    pub fn axis_offset(&self) -> [f64; 2] {
        self.axis.map(|o| (2.0 * o - 1.0) * self.profile.radius)
    }

    /// Largest radius of a solid that cells draw, over half the side of its box.
    pub(crate) const WIDEST: f64 = 1.5;

    /// Upper limit on the distance of the surface from its axis, before the box cuts it.
    pub(crate) fn widest(&self) -> f64 {
        self.profile.outline.bounds().map_or(0.0, |b| b.r_max) + self.offset.largest_width()
    }

    /// The placements of all copies: the instances, or the one placement.
    #[must_use]
    pub fn placements(&self) -> &[Placement] {
        if self.instances.is_empty() {
            std::slice::from_ref(&self.placement)
        } else {
            &self.instances
        }
    }
}

impl PartialEq for Object {
    /// Returns true if all values are equal and shared data is identical.
    fn eq(&self, other: &Self) -> bool {
        self.placement == other.placement
            && self.same_look(other)
            && self.instances == other.instances
    }
}

/// The part of a solid that the shape box cuts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Clip {
    /// The box cuts nothing that an offset adds: it grows with the offset. Cells still cut
    /// replicas.
    #[default]
    None,
    /// The box cuts everything outside `[-R, R]^2 x [0, 1]`, as in the papers.
    Box,
}

impl Clip {
    /// Every value with its name in scene files.
    pub const NAMES: [(&'static str, Self); 2] = [("none", Self::None), ("box", Self::Box)];
}

/// The highlight of Blinn-Phong shading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Weight of the highlight, linear.
    pub strength: f32,
    /// Exponent of the highlight.
    pub shininess: f32,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            strength: 0.25,
            shininess: 32.0,
        }
    }
}

/// Properties of a surface for hosts that shade by themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The square root of the width of the microfacet distribution, as in glTF: 0 (a mirror) to 1.
    pub roughness: f32,
    /// 0 or 1, or between them.
    pub metalness: f32,
}

impl Material {
    /// Two numbers of 16 bits, as `unpackUnorm2x16` reads them.
    pub(crate) fn bits(self) -> u32 {
        let part = |v: f32| (v.clamp(0.0, 1.0) * 65535.0).round() as u32;
        part(self.roughness) | part(self.metalness) << 16
    }
}

/// The textures of a surface, and their projection onto it.
#[derive(Clone, Debug)]
pub struct Texturing {
    /// Colours in place of [`Object::color`].
    pub color_map: Option<Arc<ColorMap>>,
    /// Slopes of a height map, for bump mapping.
    pub displacement_map: Option<Arc<DisplacementMap>>,
    /// `a`: the depth that scales the slopes.
    pub bump: f64,
    /// The formula that tilts the normal.
    pub bump_form: BumpForm,
    /// The projection that gives the texture coordinates of surface points.
    pub projection: Projection,
    /// Repetitions of the texture along `xi` and `eta`.
    pub repeat: [f64; 2],
    /// By how much of itself the texture is moved along rising `xi`, counter-clockwise from above,
    /// and rising `eta`.
    pub offset: [f64; 2],
}

impl Texturing {
    /// Returns true if textures end along `eta`, and their edge goes on beyond. Otherwise they
    /// repeat.
    #[must_use]
    pub fn clamps(&self) -> bool {
        (self.repeat[1] - 1.0).abs() < f64::EPSILON && self.projection != Projection::Planar
    }
}

impl Default for Texturing {
    /// No textures, with cylindrical coordinates.
    fn default() -> Self {
        Self {
            color_map: None,
            displacement_map: None,
            bump: 1.0,
            bump_form: BumpForm::SurfaceGradient,
            projection: Projection::Cylindrical,
            repeat: [1.0; 2],
            offset: [0.0; 2],
        }
    }
}

/// The formula by which a height map tilts the normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BumpForm {
    /// Gradient along the surface: a groove is equally deep near the axis and far from it
    /// (Mikkelsen 2010).
    #[default]
    SurfaceGradient,
    /// The formula as printed in the papers on revolution mapping, without the factor
    /// `1 / (2 pi r)` of the azimuth.
    Papers,
}

impl BumpForm {
    /// Every form with its name in scene files.
    pub const NAMES: [(&'static str, Self); 2] = [
        ("surface-gradient", Self::SurfaceGradient),
        ("papers", Self::Papers),
    ];
}
