//! One solid of revolution: what is turned, what covers it, how far its surface stands off, where
//! it stands.

use super::{Clip, Cluster, Copies};
use crate::maps::{ColorMap, DisplacementMap, Projection};
use crate::profile::Profile;
use glam::{DQuat, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

/// One solid of revolution, once or as many copies.
#[derive(Clone, Debug)]
pub struct Object {
    /// What messages and pictures call it: the file name of its profile, or `polygon`.
    pub name: String,
    /// The profile's file, where it came from one.
    pub file: Option<PathBuf>,
    /// What is turned. Objects that share a profile share its maps.
    pub profile: Arc<Profile>,
    /// Rows of its shape map.
    pub map_rows: u32,
    /// Linear RGB; not used where [`Texturing::color_map`] is set.
    pub color: [f32; 3],
    /// Strength and exponent of the Blinn-Phong highlight.
    pub specular: Specular,
    /// What covers the surface.
    pub texturing: Texturing,
    /// Extension, bevel and chamfer.
    pub offset: Offset,
    /// Whether the shape box cuts what an offset adds.
    pub clip: Clip,
    /// `(Ox, Oy)`: where the axis stands in box texture coordinates.
    pub axis: [f64; 2],
    /// How many replicas the box holds along x, y, z: each is the whole solid, shrunk to its cell.
    /// At least 1 each.
    pub repeat: [u32; 3],
    /// Whether every second replica along x, y, z is reflected.
    pub mirror: [bool; 3],
    /// Where it stands.
    pub placement: Placement,
    /// Where its copies stand; empty: once, at `placement`. With copies, each row's placement is
    /// used instead.
    pub instances: Copies,
}

impl Object {
    /// Rows of a shape map unless an object says otherwise.
    pub const MAP_ROWS: u32 = 512;
    /// The colour of an object that names none, linear RGB.
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

    /// Whether it looks the same in its own space: all values but placement and instances are
    /// equal, what is shared is one.
    pub(crate) fn same_look(&self, other: &Self) -> bool {
        fn one<T>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
            match (a, b) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }
        }
        let (a, b) = (&self.texturing, &other.texturing);
        let look = (self.color, self.specular, self.offset, self.axis);
        let shape = (self.map_rows, self.repeat, self.mirror, self.clip);
        let covering = (a.bump, a.bump_form, a.projection, a.repeat);
        Arc::ptr_eq(&self.profile, &other.profile)
            && self.name == other.name
            && self.file == other.file
            && look == (other.color, other.specular, other.offset, other.axis)
            && shape == (other.map_rows, other.repeat, other.mirror, other.clip)
            && covering == (b.bump, b.bump_form, b.projection, b.repeat)
            && one(&a.color_map, &b.color_map)
            && one(&a.displacement_map, &b.displacement_map)
    }

    /// Whether all values are equal, what is shared being one.
    pub(crate) fn equals(&self, other: &Self) -> bool {
        self.placement == other.placement
            && self.same_look(other)
            && self.instances == other.instances
    }

    /// The least that `value` says of any of its copies, where `bound` is not more than what it
    /// says of a cluster's copies.
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

    /// Where its axis stands, object units from the middle of the box.
    #[must_use]
    pub fn axis_offset(&self) -> [f64; 2] {
        self.axis.map(|o| (2.0 * o - 1.0) * self.profile.radius)
    }

    /// Where every copy stands: the instances, or the one placement.
    #[must_use]
    pub fn placements(&self) -> &[Placement] {
        if self.instances.is_empty() {
            std::slice::from_ref(&self.placement)
        } else {
            &self.instances
        }
    }
}

/// Where an object's box stands in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Of the middle of the box's lower face.
    pub position: DVec3,
    /// Unit quaternion.
    pub rotation: DQuat,
    /// `S`: factors along the object's axes, each positive.
    pub scale: DVec3,
}

impl Default for Placement {
    /// At the origin, upright, one world unit high.
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        }
    }
}

/// The offset `w(z)` by which the surface `F = d - w = 0` stands off the profile, with the depth `u
/// = 1 - z`: `w = extend + bevel * min(u, chamfer)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// `e`, object units; negative insets.
    pub extend: f64,
    /// `b`, slope.
    pub bevel: f64,
    /// `c`, depth in `[0, 1]` to which the bevel reaches.
    pub chamfer: f64,
}

impl Default for Offset {
    /// The profile itself: `w = 0`. A bevel that is then set reaches all the way down.
    fn default() -> Self {
        Self {
            extend: 0.0,
            bevel: 0.0,
            chamfer: 1.0,
        }
    }
}

/// The highlight of Blinn-Phong shading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Weight of the highlight, linear.
    pub strength: f32,
    /// Its exponent.
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

/// What covers a surface, and how it is wrapped around.
#[derive(Clone, Debug)]
pub struct Texturing {
    /// Colours in place of [`Object::color`].
    pub color_map: Option<Arc<ColorMap>>,
    /// Slopes of a height map, for bump mapping.
    pub displacement_map: Option<Arc<DisplacementMap>>,
    /// `a`: the depth by which they are scaled.
    pub bump: f64,
    /// Which formula tilts the normal.
    pub bump_form: BumpForm,
    /// How texture coordinates follow from the surface's points.
    pub projection: Projection,
    /// How often the texture repeats along `xi` and `eta`.
    pub repeat: [f64; 2],
}

impl Default for Texturing {
    /// Bare, with cylindrical coordinates.
    fn default() -> Self {
        Self {
            color_map: None,
            displacement_map: None,
            bump: 1.0,
            bump_form: BumpForm::SurfaceGradient,
            projection: Projection::Cylindrical,
            repeat: [1.0; 2],
        }
    }
}

/// How a height map tilts the normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BumpForm {
    /// By the gradient along the surface, in which a groove is as deep near the axis as far from it
    /// (Mikkelsen 2010).
    #[default]
    SurfaceGradient,
    /// As printed in the papers on revolution mapping, without the factor `1 / (2 pi r)` of the
    /// azimuth.
    Papers,
}

impl BumpForm {
    /// Every form with the name that scene files give it.
    pub const NAMES: [(&'static str, Self); 2] = [
        ("surface-gradient", Self::SurfaceGradient),
        ("papers", Self::Papers),
    ];
}
