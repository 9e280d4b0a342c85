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
        let square = [
            (-1.0, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (-1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
        ];
        let vertices: Vec<[[f32; 3]; 2]> = square.map(|(x, y)| corner(x, y)).to_vec();
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
            let (theta, phi) = (
                std::f32::consts::PI * j as f32 / n as f32,
                std::f32::consts::PI * i as f32 / n as f32,
            );
            let p = Vec3::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            );
            [p.to_array(), p.to_array()]
        };
        let mut vertices = Vec::new();
        for j in 0..n {
            for i in 0..2 * n {
                let [a, b, c, d] = [
                    point(i, j),
                    point(i, j + 1),
                    point(i + 1, j + 1),
                    point(i + 1, j),
                ];
                vertices.extend([a, b, c, a, c, d]);
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
