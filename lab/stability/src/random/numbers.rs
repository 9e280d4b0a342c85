//! Random numbers, the same in every run.

use std::f64::consts::{PI, TAU};

#[path = "../../../../tests/common/random.rs"]
mod random;
pub(super) use random::Random;

pub(super) fn of(seed: u64) -> Random {
    Random(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x1234_5678_9abc_def1)
}

impl Random {
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
        self.between(low.ln(), high.ln()).exp()
    }

    pub fn direction(&mut self) -> [f64; 3] {
        let z = self.between(-1.0, 1.0);
        let angle = self.between(0.0, TAU);
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    }

    pub fn rotation(&mut self) -> [f64; 4] {
        let [x, y, z] = self.direction();
        let (s, c) = self.between(0.0, PI).sin_cos();
        [x * s, y * s, z * s, c]
    }
}
