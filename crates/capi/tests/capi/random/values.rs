//! Values of the random host: mostly usual ones, and structures of which some words are spoilt.

use super::{Random, SIZE, WHOLE};
use crate::host::view_and_projection;
use crate::names::*;
use std::mem::offset_of;

const VIEWPORTS: [[f64; 4]; 7] = [
    [0.0, 48.0, 64.0, -48.0],
    [-50.0, -20.0, 128.0, 96.0],
    [60.0, 40.0, 64.0, 48.0],
    [500.0, 500.0, 64.0, 48.0],
    [0.0; 4],
    [1e9, 0.0, 1e9, 1e9],
    [0.0, 0.0, f64::NAN, 48.0],
];
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

impl Random {
    /// A number of an enumeration of so many, or a little beyond.
    pub fn one_of(&mut self, count: usize) -> u32 {
        match self.chance(0.04) {
            true => self.pick(&[count as u32, u32::MAX]),
            false => self.below(count) as u32,
        }
    }

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

    /// Gives some words of plain numbers other values: a double, a float or an integer. The bytes
    /// of `kept` stay.
    pub fn spoil<T: Copy>(&mut self, value: &mut T, kept: &[[usize; 2]]) {
        for _ in 0..self.pick(&[0, 0, 0, 1, 2, 4]) {
            let at = 4 * self.below(size_of::<T>() / 4);
            let bytes = match self.below(4) {
                0 | 1 => self.number().to_ne_bytes().to_vec(),
                2 => (self.number() as f32).to_ne_bytes().to_vec(),
                _ => self.pick(&[0u32, 1, 2, 3, 9]).to_ne_bytes().to_vec(),
            };
            // Doubles start at multiples of eight bytes.
            let at = at / bytes.len() * bytes.len();
            let end = at + bytes.len();
            let is_kept = kept.iter().any(|k| at < k[1] && k[0] < end);
            if end <= size_of::<T>() && !is_kept {
                let to = (&raw mut *value).cast::<u8>();
                // SAFETY: within the value, of which any bits are numbers.
                unsafe {
                    to.add(at)
                        .copy_from_nonoverlapping(bytes.as_ptr(), bytes.len())
                };
            }
        }
    }

    /// A spoilt structure that begins with its size, mostly the right one. The second gives room to
    /// larger sizes.
    pub fn spoilt<T: Copy>(&mut self, mut value: T, kept: &[[usize; 2]]) -> [T; 2] {
        let own = size_of::<T>();
        let size = match self.chance(0.02) {
            true => self.pick(&[0, 4, own - 8, own + 8, own + 4, usize::MAX]),
            false => own,
        };
        self.spoil(&mut value, kept);
        // SAFETY: the structure begins with its size.
        unsafe { (&raw mut value).cast::<u32>().write(size as u32) };
        [value; 2]
    }

    pub fn placement(&mut self) -> RevmapPlacement {
        let mut placement = RevmapPlacement {
            position: self.numbers(),
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [1.0; 3],
        };
        if self.chance(0.3) {
            let angle = self.between(-3.0, 3.0);
            placement.rotation = [0.0, angle.sin(), 0.0, angle.cos()];
        }
        if self.chance(0.05) {
            self.spoil(&mut placement, &[]);
        }
        placement
    }

    pub fn view(&mut self) -> [RevmapView; 2] {
        let eye = DVec3::new(2.0, 2.0 * self.number(), 1.0 + self.number());
        let matrices = view_and_projection(eye, DVec3::new(0.0, 0.0, 0.5), &SIZE);
        let [view, projection] = matrices.map(|matrix| matrix.to_cols_array());
        let made = RevmapView {
            view,
            projection,
            viewport: match self.chance(0.4) {
                true => self.pick(&VIEWPORTS),
                false => WHOLE,
            },
            mask: self.pick(&[0, 0, 1, 2, u32::MAX]),
            ..sized!(RevmapView)
        };
        self.spoilt(made, &kept!(RevmapView: last..jitter))
    }
}
