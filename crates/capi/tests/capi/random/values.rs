//! Random values of the C interface: mostly usual ones.

use super::{SIZE, WHOLE};
use crate::host::view_and_projection;
use crate::names::*;

#[path = "../../../../../tests/common/random.rs"]
mod numbers;
pub use numbers::Random;

const ODD: [f64; 10] = [
    0.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e300,
    -1e300,
    5e-324,
    1e20,
    -1.0,
];
const VIEWPORTS: [[f64; 4]; 7] = [
    [0.0, 48.0, 64.0, -48.0],
    [-50.0, -20.0, 128.0, 96.0],
    [60.0, 40.0, 64.0, 48.0],
    [500.0, 500.0, 64.0, 48.0],
    [0.0; 4],
    [1e9, 0.0, 1e9, 1e9],
    [0.0, 0.0, f64::NAN, 48.0],
];

impl Random {
    /// A number, mostly of a usual size.
    pub fn number(&mut self) -> f64 {
        match self.chance(0.03) {
            true => self.pick(&ODD),
            false => self.between(-1.0, 1.0),
        }
    }

    pub fn numbers<const N: usize>(&mut self) -> [f64; N] {
        [(); N].map(|()| self.number())
    }

    /// A number of an enumeration of so many, or a little beyond.
    pub fn one_of(&mut self, count: usize) -> u32 {
        match self.chance(0.04) {
            true => self.pick(&[count as u32, u32::MAX]),
            false => self.below(count) as u32,
        }
    }

    /// A structure's size, mostly the right one.
    pub fn size<T>(&mut self) -> u32 {
        let own = size_of::<T>();
        match self.chance(0.02) {
            true => self.pick(&[0, 4, own - 8, own + 8, own + 4, usize::MAX]) as u32,
            false => own as u32,
        }
    }

    /// One of these handles, or one that is none.
    pub fn handle<T>(&mut self, dead: &[usize], from: &[*mut T]) -> *mut T {
        if !from.is_empty() && !self.chance(0.06) {
            return self.pick(from);
        }
        std::ptr::without_provenance_mut(match self.below(3) {
            0 => 0,
            1 if !dead.is_empty() => self.pick(dead),
            _ => self.below(1 << 20),
        })
    }

    pub fn placement(&mut self) -> RevmapPlacement {
        let mut placement = RevmapPlacement {
            position: self.numbers(),
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [1.0; 3],
        };
        if self.chance(0.3) {
            let angle = 3.0 * self.number();
            placement.rotation = [0.0, angle.sin(), 0.0, angle.cos()];
        }
        if self.chance(0.2) {
            placement.scale = self.numbers().map(|n| n + 1.1);
        }
        placement
    }

    pub fn copies(&mut self) -> Vec<RevmapPlacement> {
        let count = self.pick(&[0, 0, 0, 1, 5, 70, 200]);
        (0..count).map(|_| self.placement()).collect()
    }

    pub fn offset(&mut self) -> RevmapOffset {
        RevmapOffset {
            extend: 0.2 * self.number(),
            bevel: 0.3 * self.number().abs(),
            chamfer: self.number().abs(),
        }
    }

    pub fn light(&mut self) -> RevmapLight {
        RevmapLight {
            direction: self.numbers(),
            color: [1.0; 3],
            radius: 30.0 * self.number() as f32,
        }
    }

    pub fn search(&mut self) -> RevmapSearch {
        let mut search = defaults!(revmap_search_defaults, RevmapSearch);
        if self.chance(0.3) {
            (search.solver, search.max_steps) = (self.one_of(10), self.one_of(50));
            (search.map_source, search.map_format) = (self.one_of(4), self.one_of(3));
            search.map_rows = self.pick(&[0, 16, 32, 1, 1 << 20]);
            search.tolerance = self.number().abs();
        }
        search.size = self.size::<RevmapSearch>();
        search
    }

    pub fn view(&mut self) -> RevmapView {
        let eye = DVec3::new(2.0, 2.0 * self.number(), 1.0 + self.number());
        let [view, projection] = view_and_projection(eye, DVec3::new(0.0, 0.0, 0.5), &SIZE);
        let mut made = sized!(RevmapView);
        (made.view, made.projection) = (view.to_cols_array(), projection.to_cols_array());
        made.viewport = WHOLE;
        if self.chance(0.4) {
            let n = self.number();
            made.viewport = self.pick(&VIEWPORTS);
            if self.chance(0.2) {
                made.viewport[self.below(4)] = 100.0 * n;
            }
        }
        for matrix in [&mut made.projection, &mut made.view] {
            if self.chance(0.05) {
                matrix[self.below(16)] = self.number();
            }
        }
        made.depth_order = if self.chance(0.1) { self.one_of(2) } else { 0 };
        if self.chance(0.2) {
            made.jitter = self.numbers();
        }
        if self.chance(0.1) {
            (made.depth_bias, made.layer) = (0.01 * self.number(), self.one_of(2));
        }
        made.mask = self.pick(&[0, 0, 1, 2, u32::MAX]);
        made.size = self.size::<RevmapView>();
        made
    }
}
