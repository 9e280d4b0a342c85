//! One object as triangles: rings of its contour, turned in equal steps.

use super::meridian::{Ring, Strand, strands_within};
use glam::{DVec2, DVec3, FloatExt};
use revmap::error::{Error, ErrorKind, Result};
use revmap::maps::{ArcLength, Projection};
use revmap::scene::{GrownProfiles, Growth, Object};
use revmap::surface::ContourSource;
use std::f64::consts::{PI, TAU};

/// A vertex in the object's own units, before its placement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vertex {
    /// `(x, y, z)`: the box's lower face is `z = 0`, the axis points along `z`.
    pub position: [f32; 3],
    /// The outward unit normal.
    pub normal: [f32; 3],
    /// Texture coordinates `(xi, eta)` before the texture's repetition; `eta` grows upwards.
    pub uv: [f32; 2],
}

/// An object's solid under its offset as triangles, one copy of it, without its placement.
///
/// Vertices of one place have equal positions to the last bit. They are several where the normal
/// has a crease, on the seam of texture coordinates at the azimuth `-x`, and on the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Its vertices.
    pub vertices: Vec<Vertex>,
    /// Three for each triangle, counter-clockwise from outside.
    pub indices: Vec<u32>,
    /// The tolerance that they were made for, object units.
    pub tolerance: f64,
}

/// Most vertices of an object.
const MOST_VERTICES: usize = 50_000_000;
/// Chords are halved until texture coordinates between their ends are off by less, parts of the
/// texture.
const BEND: f64 = 1.0 / 1024.0;

impl Triangles {
    /// The least tolerance, object units: positions of 32 bits are exact to 6e-8.
    pub const FINEST: f64 = 1e-6;

    /// The triangles of `object`. No point of them is farther than `tolerance` from its surface,
    /// and no point of the surface is farther from them. Half of the tolerance is for the steps
    /// about the axis, and half for chords of the contour.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] with the key `tolerance` if it is below 1e-6 object units, not a number,
    /// or so fine that there would be more than 50,000,000 vertices. [`ErrorKind::Content`] with the
    /// object's key for replicas, for a solid that the sides of its box cut, for a solid of which
    /// the offset leaves nothing, and for an outline without a surface.
    pub fn new(object: &Object, tolerance: f64) -> Result<Self> {
        if tolerance.is_nan() || tolerance < Self::FINEST {
            let message = format!("is {tolerance}; give {} object units or more", Self::FINEST);
            return Err(Error::new(ErrorKind::Usage, message).at_key("tolerance"));
        }
        let refused = |key: &str, what: &str| Error::new(ErrorKind::Content, what).at_key(key);
        if object.repeat != [1; 3] {
            let what = "a mesh has no replicas; give [1, 1, 1], and instances for copies";
            return Err(refused("repeat", what));
        }
        let growth = Growth::of(object);
        let grown = GrownProfiles::default().grown(object);
        let boxed = grown.as_ref().map_or(object, |g| &g.object);
        let source = ContourSource::new(&boxed.profile.outline);
        let contour = source.and_then(|source| source.contour(&boxed.offset));
        let contour = contour.map_err(|e| e.at_key("profile"))?;
        let (scale, lift) = (growth.height(), growth.low);
        let mut strands = strands_within(&contour, 0.5 * tolerance / scale);
        for ring in strands.iter_mut().flat_map(|s| &mut s.rings) {
            ring.point = ring.point * scale - DVec2::new(0.0, lift);
        }
        let rings = || strands.iter().flat_map(|s| &s.rings);
        let widest = rings().fold(0.0, |most, ring| ring.point.x.max(most));
        if widest <= 0.0 {
            return Err(refused("extend", "leaves no solid; give more"));
        }
        let off = object.axis_offset();
        let half_side = boxed.profile.radius * scale;
        if widest + off[0].abs().max(off[1].abs()) > half_side + tolerance {
            let key = if off == [0.0; 2] { "radius" } else { "axis" };
            let what = "the sides of the box cut the solid, and a mesh is not cut; give a radius that holds it, and the axis [0.5, 0.5]";
            return Err(refused(key, what));
        }
        let texture = Texture::new(object)?;
        let steps = steps(widest, 0.5 * tolerance).max(texture.least_steps());
        let strands: Vec<Strand> = strands.iter().map(|s| texture.even(s)).collect();
        let count: usize = strands.iter().map(|s| s.rings.len()).sum();
        if count.saturating_mul(2 * (steps + 1)) > MOST_VERTICES {
            let message = format!("needs more than {MOST_VERTICES} vertices; give a larger one");
            return Err(Error::new(ErrorKind::Usage, message).at_key("tolerance"));
        }
        let mut builder = Builder::new(steps, off, texture);
        strands.iter().for_each(|strand| builder.strand(strand));
        builder.made.tolerance = tolerance;
        Ok(builder.made)
    }
}

/// Steps about the axis. A polygon whose corners are as far outside of a circle of radius `r` as
/// the middles of its sides are inside is off by `r tan^2(pi / 2n)`.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below 2^20
fn steps(radius: f64, tolerance: f64) -> usize {
    let half = (tolerance / radius).sqrt().atan();
    (0.5 * PI / half).ceil() as usize
}

/// Texture coordinates on an object's surface.
struct Texture<'a> {
    object: &'a Object,
    arc: Option<ArcLength>,
    /// `eta` in the middle of the colour map's last and first row, if the map ends there.
    ends: Option<[f64; 2]>,
}

impl<'a> Texture<'a> {
    fn new(object: &'a Object) -> Result<Self> {
        let lengths = object.texturing.projection == Projection::Arc;
        let arc = lengths.then(|| ArcLength::new(&object.profile));
        let arc = arc.transpose().map_err(|e| e.at_key("profile"))?;
        let look = &object.texturing;
        let map = look.color_map.as_ref().and_then(|map| map.levels.first());
        let map = map.filter(|_| look.clamps());
        let ends = map.map(|level| {
            let half = 0.5 / f64::from(level.height);
            [half, 1.0 - half].map(|eta| eta + look.offset[1])
        });
        Ok(Self { object, arc, ends })
    }

    /// Steps about the axis. `eta` of the projection `spherical` is off by up to 0.002 between 14.
    fn least_steps(&self) -> usize {
        match self.object.texturing.projection {
            Projection::Spherical => 14,
            _ => 6,
        }
    }

    /// `eta` at a point of the half-plane; that of the projection `planar` also depends on the
    /// azimuth.
    fn eta(&self, p: DVec2) -> f64 {
        match (self.object.texturing.projection, &self.arc) {
            (Projection::Spherical, _) => 1.0 - p.x.atan2(p.y - 0.5) / PI,
            (Projection::Arc, Some(arc)) => arc.eta(p.x, p.y),
            _ => p.y,
        }
    }

    /// A strand with further rings, between which `eta` is nearly linear, and where a colour map
    /// ends.
    fn even(&self, strand: &Strand) -> Strand {
        let mut rings = Vec::new();
        for pair in strand.rings.windows(2) {
            let mut first = pair[0];
            first.normals[0] = first.normals[1];
            let (mut last, mut part) = (pair[1], Vec::new());
            last.normals[1] = last.normals[0];
            self.divide(first, last, 14, &mut part);
            rings.push(pair[0]);
            rings.append(&mut part);
        }
        rings.extend(strand.rings.last());
        Strand {
            rings,
            closed: strand.closed,
        }
    }

    fn divide(&self, a: Ring, b: Ring, depth: u32, rings: &mut Vec<Ring>) {
        let eta = |part: f64| self.eta(a.point.lerp(b.point, part));
        let Some(part) = division(&eta, self.ends).filter(|_| depth > 0) else {
            return;
        };
        let normal = a.normals[1].lerp(b.normals[0], part);
        let ring = Ring {
            point: a.point.lerp(b.point, part),
            normals: [normal.normalize_or(a.normals[1]); 2],
        };
        self.divide(a, ring, depth - 1, rings);
        rings.push(ring);
        self.divide(ring, b, depth - 1, rings);
    }
}

/// Where to divide a chord with these coordinates from 0 to 1: where it passes one of `ends`, or in
/// the middle if it is not nearly linear. The middle alone may be right by symmetry.
fn division(eta: &dyn Fn(f64) -> f64, ends: Option<[f64; 2]>) -> Option<f64> {
    let [from, to] = [eta(1e-6), eta(1.0 - 1e-6)];
    let passed = |end: &f64| (from < *end) != (to < *end);
    if let Some(end) = ends.iter().flatten().find(|end| passed(end)) {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let is_before = (eta(middle) < *end) == (from < *end);
            *if is_before { &mut low } else { &mut high } = middle;
        }
        return Some(low).filter(|part| (1e-5..1.0 - 1e-5).contains(part));
    }
    let off = |k: u32| {
        let part = f64::from(k) / 8.0;
        (eta(part) - from.lerp(to, part)).abs()
    };
    (1..8).any(|k| off(k) >= BEND).then_some(0.5)
}

struct Builder<'a> {
    made: Triangles,
    /// Unit vectors from the azimuth `-x` once around; the last is the first.
    around: Vec<DVec2>,
    /// Makes the polygon's error even on both sides.
    factor: f64,
    /// Of the axis, object units.
    axis: DVec2,
    texture: Texture<'a>,
}

impl<'a> Builder<'a> {
    fn new(steps: usize, axis: [f64; 2], texture: Texture<'a>) -> Self {
        let direction = |s: usize| DVec2::from_angle(TAU * (s % steps) as f64 / steps as f64 - PI);
        Self {
            made: Triangles::default(),
            around: (0..=steps).map(direction).collect(),
            factor: 2.0 / (1.0 + (PI / steps as f64).cos()),
            axis: axis.into(),
            texture,
        }
    }

    /// Adds the frusta between the rings of a strand.
    fn strand(&mut self, strand: &Strand) {
        for (k, pair) in strand.rings.windows(2).enumerate() {
            let [from, to] = [pair[0], pair[1]];
            let ends = [(from, from.normals[1], to), (to, to.normals[0], from)];
            // A smooth ring's vertices serve both frusta, if its texture coordinate is the same.
            let shared = k > 0 && from.normals[0] == from.normals[1];
            let [a, b] = ends.map(|(ring, normal, other)| {
                let eta = self.texture.eta(ring.point.lerp(other.point, 1e-6));
                (ring.point, normal, eta)
            });
            let first = match shared.then(|| self.last_ring(a)).flatten() {
                Some(known) => known,
                None => self.ring(a),
            };
            let second = self.ring(b);
            self.frustum([first, second], [a.0.x > 0.0, b.0.x > 0.0]);
        }
    }

    /// The first vertex of the ring made last, if it is this one.
    fn last_ring(&self, (point, _, eta): (DVec2, DVec2, f64)) -> Option<u32> {
        let first = self.made.vertices.len().checked_sub(self.columns(point))?;
        let planar = self.texture.object.texturing.projection == Projection::Planar;
        let known = f64::from(self.made.vertices[first].uv[1]);
        (planar || (known - eta).abs() < BEND).then_some(first as u32)
    }

    /// Vertices of a ring: one for each direction, or on the axis one for each step.
    fn columns(&self, point: DVec2) -> usize {
        self.around.len() - usize::from(point.x <= 0.0)
    }

    /// Adds the vertices of a ring on one side of it; returns the first.
    fn ring(&mut self, (point, normal, eta): (DVec2, DVec2, f64)) -> u32 {
        let first = self.made.vertices.len() as u32;
        let steps = self.around.len() - 1;
        for s in 0..self.columns(point) {
            let direction = self.around[s];
            let mut facing = direction;
            let mut xi = s as f64 / steps as f64;
            if point.x <= 0.0 {
                // A vertex on the axis has the azimuth of the middle of its triangle.
                xi += 0.5 / steps as f64;
                facing = DVec2::from_angle(TAU * xi - PI);
            }
            let flat = direction * (point.x * self.factor);
            let uv = match self.texture.object.texturing.projection {
                Projection::Planar => {
                    let side = 2.0 * self.texture.object.profile.radius;
                    flat / side + DVec2::from(self.texture.object.axis)
                }
                _ => DVec2::new(xi, eta),
            };
            let normal = (facing * normal.x).extend(normal.y);
            self.made.vertices.push(Vertex {
                position: single((flat + self.axis).extend(point.y)),
                normal: single(normal),
                uv: uv.as_vec2().to_array(),
            });
        }
        first
    }

    /// The quads between two rings, or triangles where one of them is on the axis.
    fn frustum(&mut self, [from, to]: [u32; 2], [from_around, to_around]: [bool; 2]) {
        for s in 0..(self.around.len() - 1) as u32 {
            let [a, b] = [from + s, from + s + 1];
            let [c, d] = [to + s + 1, to + s];
            match [from_around, to_around] {
                [true, true] => self.made.indices.extend([a, b, c, a, c, d]),
                [true, false] => self.made.indices.extend([a, b, d]),
                [false, true] => self.made.indices.extend([a, c, d]),
                [false, false] => {}
            }
        }
    }
}

fn single(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}
