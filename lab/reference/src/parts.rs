//! The copies of a scene, in a tree so that thousands of them add little cost to a ray.

use super::Ray;
use super::solid::Solid;
use super::tree::{Bounds, Tree};
use glam::DMat3;
use revmap::scene::Placement;
use std::sync::Arc;

/// A copy of an object.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub object: usize,
    pub instance: usize,
    pub solid: Arc<Solid>,
    pub placement: Placement,
}

#[derive(Debug)]
pub(super) struct Parts {
    pub list: Vec<Part>,
    tree: Tree,
}

impl Part {
    /// A ray in the object's own space; `t` has the same meaning.
    pub fn local(&self, ray: Ray) -> Ray {
        let back = self.placement.rotation.conjugate();
        Ray {
            origin: back * (ray.origin - self.placement.position) / self.placement.scale,
            direction: back * ray.direction / self.placement.scale,
        }
    }

    /// The shape box's bounds in the world, slightly enlarged.
    fn bounds(&self) -> Bounds {
        let Placement {
            position,
            rotation,
            scale,
        } = self.placement;
        let [low, high] = self.solid.faces();
        let size = 0.5 * (high - low) * scale;
        let middle = position + rotation * (0.5 * (low + high) * scale);
        let turn = DMat3::from_quat(rotation).abs();
        let half = turn * size * (1.0 + 1e-6) + middle.abs() * 1e-12;
        Bounds {
            min: middle - half,
            max: middle + half,
        }
    }
}

impl Parts {
    pub fn new(mut list: Vec<Part>) -> Self {
        let tree = Tree::new(&mut list, 1, Part::bounds);
        Self { list, tree }
    }

    /// Calls `visit` for every part whose box the ray may enter before `nearest`; `visit` returns
    /// the new nearest `t`.
    pub fn along(&self, ray: Ray, mut visit: impl FnMut(&Part) -> f64) {
        let inverse = ray.direction.recip();
        let enter = |bounds: &Bounds| {
            let a = (bounds.min - ray.origin) * inverse;
            let b = (bounds.max - ray.origin) * inverse;
            let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
            for axis in 0..3 {
                // A ray within the plane of a wall gives 0 times infinity. This sets no bound: `max`
                // and `min` ignore a NaN.
                enter = enter.max(a[axis].min(b[axis]));
                leave = leave.min(a[axis].max(b[axis]));
            }
            if enter <= leave { enter } else { f64::INFINITY }
        };
        (self.tree).search(f64::INFINITY, enter, |part| visit(&self.list[part]));
    }
}
