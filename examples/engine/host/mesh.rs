//! Meshes: a floor and a sphere.

use super::memory::HostBuffer;
use super::{Fallible, Host};
use ash::vk;
use glam::{Vec3, Vec4};

/// Triangles of the host's own.
pub struct Mesh<'a> {
    pub vertices: HostBuffer<'a>,
    pub count: u32,
    pub offset_scale: Vec4,
    pub color: Vec3,
}

impl<'a> Mesh<'a> {
    /// A square floor at `z`, of half side `half`.
    pub fn floor(host: &'a Host, half: f32, z: f32, color: Vec3) -> Fallible<Self> {
        let corner = |x: f32, y: f32| [[x, y, 0.0], [0.0, 0.0, 1.0]];
        let [a, c] = [corner(-1.0, -1.0), corner(1.0, 1.0)];
        let vertices = [a, corner(1.0, -1.0), c, a, c, corner(-1.0, 1.0)];
        Self::of(host, &vertices, Vec4::new(0.0, 0.0, z, half), color)
    }

    /// A sphere of `2 n` segments and `n` rings.
    pub fn sphere(
        host: &'a Host,
        n: u32,
        middle: Vec3,
        radius: f32,
        color: Vec3,
    ) -> Fallible<Self> {
        let point = |i: u32, j: u32| {
            let angle = |k: u32| (std::f32::consts::PI * k as f32 / n as f32).sin_cos();
            let ((ring, z), (y, x)) = (angle(j), angle(i));
            [[ring * x, ring * y, z]; 2]
        };
        let mut vertices = Vec::new();
        for j in 0..n {
            for i in 0..2 * n {
                let (a, c) = (point(i, j), point(i + 1, j + 1));
                vertices.extend([a, point(i, j + 1), c, a, c, point(i + 1, j)]);
            }
        }
        Self::of(host, &vertices, middle.extend(radius), color)
    }

    fn of(
        host: &'a Host,
        vertices: &[[[f32; 3]; 2]],
        offset_scale: Vec4,
        color: Vec3,
    ) -> Fallible<Self> {
        Ok(Self {
            count: vertices.len() as u32,
            vertices: HostBuffer::of(host, vertices, vk::BufferUsageFlags::VERTEX_BUFFER)?,
            offset_scale,
            color,
        })
    }
}
