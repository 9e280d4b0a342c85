//! Random numbers, the same in every run.

use std::f64::consts::{PI, TAU};

/// Numbers by SplitMix64.
pub(super) struct Random(u64);

impl Random {
    /// The numbers of a seed.
    pub fn of(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x1234_5678_9abc_def1)
    }

    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// True once in so many times.
    pub fn once_in(&mut self, times: f64) -> bool {
        self.next() * times < 1.0
    }

    /// What `other` gives, once in so many times.
    pub fn maybe<T>(&mut self, times: f64, usual: T, other: impl FnOnce(&mut Self) -> T) -> T {
        if self.once_in(times) {
            other(self)
        } else {
            usual
        }
    }

    /// Evenly among the logarithms.
    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        (self.within(low.ln(), high.ln())).exp()
    }

    pub fn direction(&mut self) -> [f64; 3] {
        let z = self.within(-1.0, 1.0);
        let angle = self.within(0.0, TAU);
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    }

    pub fn rotation(&mut self) -> [f64; 4] {
        let [x, y, z] = self.direction();
        let (s, c) = self.within(0.0, PI).sin_cos();
        [x * s, y * s, z * s, c]
    }
}
