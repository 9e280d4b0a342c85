//! A solid of revolution as triangles: the contour under its offset, thinned to rings and turned in
//! equal steps. The mesh is as good as its number of quads allows, or as coarse as a tolerance allows:
//!
//! * Of so many rings, chords are as long as the least tolerance that keeps within the rings allowed. Errors are even
//!   along the meridian, and straight parts take no ring, because a frustum is exact there.
//! * Vertices are moved outwards by half of a chord's distance from its arc: around the axis by the
//!   factor `2 / (1 + cos(pi / n))`, along the meridian where it is smooth. This halves the errors.
//! * Normals are the contour's. Each chord has two, between which they turn as evenly as possible.
//!   Neighbours with nearly equal normals share vertices, others are creases. Only the part in the
//!   half-plane is stored: each pixel has its exact azimuth.
//! * Indices run in bands of `BAND` segments: a ring of a band is still in the vertex cache when
//!   the next one is drawn. Vertices are in the order of their first use.

use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use revmap::surface::Contour;
use revmap_tessellation::{Strand, Turned, strands_of, turned_within};
use std::f64::consts::{PI, TAU};

/// Segments that are drawn side by side from one end of the meridian to the other.
const BAND: u32 = 8;

/// The largest tolerance, parts of the largest radius: with more a small copy would vanish.
const LEAST_SHAPE: f64 = 0.25;

/// What the vertex shader is given.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Object units about the axis.
    pub position: [f32; 3],
    /// The outward normal in the half-plane, `(r, z)`; 32767 is 1.
    pub normal: [i16; 2],
}

/// A tessellated solid.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Its vertices.
    pub vertices: Vec<Vertex>,
    /// Triangles, counter-clockwise from outside. Bands follow each other counter-clockwise about
    /// the axis, each from the meridian's beginning to its end.
    pub indices: Vec<u32>,
    /// Steps around the axis.
    pub segments: u32,
    /// Steps along the meridian that were made.
    pub rings: u32,
    /// Largest radius, least and largest `z` of the contour.
    pub extent: [f64; 3],
}

impl Mesh {
    /// A contour in `segments` steps around and at most `rings` along, more if it has more corners.
    pub fn new(contour: &Contour, segments: u32, rings: u32) -> Self {
        Self::of_strands(contour, segments, &strands_of(contour, rings as usize))
    }

    /// A contour in as few steps as keep the solid within `tolerance`, object units, which is at
    /// most a quarter of the largest radius.
    pub fn within(contour: &Contour, tolerance: f64) -> Self {
        let widest = extent_of(contour)[0];
        let Turned { strands, segments } =
            turned_within(contour, tolerance.min(LEAST_SHAPE * widest));
        Self::of_strands(contour, segments, &strands)
    }

    fn of_strands(contour: &Contour, segments: u32, strands: &[Strand]) -> Self {
        let mut builder = Builder::new(segments);
        let sets: Vec<_> = strands.iter().map(|s| builder.vertices(s)).collect();
        for first in (0..segments).step_by(BAND as usize) {
            let band = first..segments.min(first + BAND);
            for pair in sets.iter().flatten() {
                builder.frustum(*pair, band.clone());
            }
        }
        let mut mesh = Self {
            vertices: builder.vertices,
            indices: builder.indices,
            segments,
            rings: sets.iter().map(|s| s.len() as u32).sum(),
            extent: extent_of(contour),
        };
        mesh.in_order_of_use();
        mesh
    }

    /// Renumbers vertices in the order in which indices first name them.
    fn in_order_of_use(&mut self) {
        let mut number = vec![u32::MAX; self.vertices.len()];
        let mut sorted = Vec::with_capacity(self.vertices.len());
        for index in &mut self.indices {
            let new = &mut number[*index as usize];
            if *new == u32::MAX {
                *new = sorted.len() as u32;
                sorted.push(self.vertices[*index as usize]);
            }
            *index = *new;
        }
        self.vertices = sorted;
    }

    /// The index of the band from which on what faces an eye at `azimuth` comes first.
    pub fn start(&self, azimuth: f64) -> u32 {
        let turns = ((azimuth - 0.5 * PI) / TAU).rem_euclid(1.0);
        let segment = (turns * f64::from(self.segments)) as u32;
        let per_segment = self.indices.len() as u32 / self.segments.max(1);
        segment.min(self.segments.saturating_sub(1)) / BAND * BAND * per_segment
    }
}

/// Largest radius, least and largest `z` of a contour.
pub(super) fn extent_of(contour: &Contour) -> [f64; 3] {
    let points = || contour.chains.iter().flat_map(|c| &c.points);
    [
        points().fold(0.0, |most, p| p.x.max(most)),
        points().fold(f64::INFINITY, |least, p| p.y.min(least)),
        points().fold(f64::NEG_INFINITY, |most, p| p.y.max(most)),
    ]
}

/// The vertices of one ring on one side of it: all around, or one on the axis.
#[derive(Clone, Copy)]
struct Set {
    first: u32,
    around: bool,
}

struct Builder {
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
    /// Unit vectors, times the factor that makes the polygon's error even.
    around: Vec<DVec2>,
}

impl Builder {
    fn new(segments: u32) -> Self {
        let n = f64::from(segments);
        let factor = 2.0 / (1.0 + (PI / n).cos());
        Self {
            vertices: Vec::new(),
            indices: Vec::new(),
            around: (0..segments)
                .map(|s| DVec2::from_angle(TAU * f64::from(s) / n) * factor)
                .collect(),
        }
    }

    /// Makes a strand's vertices; returns the sets of each of its frusta.
    fn vertices(&mut self, strand: &Strand) -> Vec<[Set; 2]> {
        let mut pairs = Vec::new();
        let mut leaving: Option<Set> = None;
        for ring in &strand.rings {
            let [before, after] = ring.normals;
            let arriving = self.set(ring.point, before);
            if let Some(from) = leaving {
                pairs.push([from, arriving]);
            }
            leaving = Some(if before == after {
                arriving
            } else {
                self.set(ring.point, after)
            });
        }
        // A smooth closed strand ends on its first vertices; `in_order_of_use` drops the others.
        let first = strand.rings.first();
        let smooth = first.is_some_and(|r| r.normals[0] == r.normals[1]);
        if let (true, [first, .., last]) = (strand.closed && smooth, pairs.as_mut_slice()) {
            last[1] = first[0];
        }
        pairs
    }

    fn set(&mut self, point: DVec2, normal: DVec2) -> Set {
        let set = Set {
            first: self.vertices.len() as u32,
            around: point.x > 0.0,
        };
        let short = |v: f64| (v * f64::from(i16::MAX)).round() as i16;
        let vertex = |direction: DVec2| Vertex {
            position: (direction * point.x).extend(point.y).as_vec3().to_array(),
            normal: [short(normal.x), short(normal.y)],
        };
        if set.around {
            let Self {
                vertices, around, ..
            } = self;
            vertices.extend(around.iter().map(|direction| vertex(*direction)));
        } else {
            self.vertices.push(vertex(DVec2::ZERO));
        }
        set
    }

    /// The quads between two rings, or the triangles where one of them is a point of the axis.
    fn frustum(&mut self, [from, to]: [Set; 2], band: std::ops::Range<u32>) {
        let n = self.around.len() as u32;
        let corner = |set: Set, s: u32| set.first + if set.around { s % n } else { 0 };
        for s in band {
            let (a, b) = (corner(from, s), corner(from, s + 1));
            let (c, d) = (corner(to, s + 1), corner(to, s));
            if from.around {
                self.indices.extend([a, b, c]);
            }
            if to.around {
                self.indices.extend([a, c, d]);
            }
        }
    }
}
