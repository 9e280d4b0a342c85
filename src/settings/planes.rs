//! The values that are stored of a hit.

use crate::error::{Result, usage};

/// The requested planes of a frame; others are neither computed nor stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Planes {
    /// Colour only. A pass gets linear RGBA, which the attachment's format encodes: give a view of an
    /// `_SRGB` format. An attachment of a `_UNORM` format holds linear values, and a float format keeps
    /// values above 1. Compute and pictures without a host have 8-bit sRGB.
    Color,
    /// Depth only, for shadow maps. In a host's pass only.
    Depth {
        /// True for depth along parallel rays, as for a directional light.
        parallel: bool,
    },
    /// Everything a [`Frame`](crate::frame::Frame) holds, in 32-bit floats.
    All,
    /// The planes of a list, one per attachment, as for a G-buffer. In a host's pass only, by the
    /// searches `exact`, `quadric` and `live`.
    List(PlaneList),
}

/// The values of one attachment. Channels that it does not name are 0, and alpha is 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Plane {
    /// The shaded colour, linear RGBA, in formats as for [`Planes::Color`].
    Color,
    /// The colour of the surface before light, linear RGB, in formats as for [`Planes::Color`].
    BaseColor,
    /// The unit normal in the world, with bumps, facing the eye: x, y, z. Signed or float formats.
    Normal,
    /// The same normal as a point of an octahedron that is unfolded to the square -1 to 1 (Meyer et
    /// al. 2010, *On floating-point normal vectors*): two channels. Signed or float formats.
    OctahedralNormal,
    /// Roughness and metalness of the object ([`Material`](crate::scene::Material)), 0 to 1: two
    /// channels.
    Material,
    /// Motion: the position in the picture in the last frame minus the present one, pixels, y
    /// downwards, without jitter: two channels, float formats.
    /// [`View::with_last`](crate::gpu::View::with_last) gives the last view,
    /// [`Renderer::end_frame`](crate::gpu::Renderer::end_frame) keeps the last placements. Copies take
    /// twice the memory, so half as many fit.
    Motion,
    /// [`ObjectId::number`](crate::gpu::ObjectId::number) and the number of the copy: two channels
    /// of unsigned integers of 32 bits. Clear them to a value that no object has, such as
    /// `u32::MAX`.
    Identity,
}

/// Different planes, in the order of their attachments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PlaneList {
    count: usize,
    planes: [Plane; Plane::COUNT],
}

impl Plane {
    /// The number of planes.
    pub(crate) const COUNT: usize = 7;

    /// The location of its variable in `stage/outputs.glsl`.
    pub(crate) const fn location(self) -> u32 {
        self as u32
    }
}

impl PlaneList {
    /// The list of these planes.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`](crate::error::ErrorKind::Usage) if a plane is there twice.
    pub fn new(planes: &[Plane]) -> Result<Self> {
        let twice = (1..planes.len()).any(|n| planes[..n].contains(&planes[n]));
        let mut list = [Plane::Color; Plane::COUNT];
        let Some(to) = list.get_mut(..planes.len()).filter(|_| !twice) else {
            return usage("planes", "a plane is there twice; give each one once");
        };
        to.copy_from_slice(planes);
        Ok(Self {
            count: planes.len(),
            planes: list,
        })
    }

    /// The planes.
    #[must_use]
    pub fn planes(&self) -> &[Plane] {
        &self.planes[..self.count]
    }

    /// True if the list has this plane.
    #[must_use]
    pub fn has(&self, plane: Plane) -> bool {
        self.planes().contains(&plane)
    }
}

impl Planes {
    /// The number of colour attachments of a pass that draws them.
    #[must_use]
    pub fn attachments(&self) -> usize {
        match self {
            Self::Color => 1,
            Self::Depth { .. } => 0,
            Self::All => 4,
            Self::List(list) => list.count,
        }
    }

    /// True if motion is drawn.
    pub(crate) fn has_motion(&self) -> bool {
        matches!(self, Self::List(list) if list.has(Plane::Motion))
    }
}
