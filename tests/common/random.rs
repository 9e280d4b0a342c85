//! Random numbers and choices, the same in every run.
#![allow(dead_code)] // each crate of tests takes what it needs

/// Numbers by SplitMix64.
pub struct Random(pub u64);

impl Random {
    /// The numbers of a seed, unlike those of the next seed.
    pub fn of(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95))
    }

    /// A number from 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A whole number from 0 to `end - 1`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() * end as f64) as usize
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.next() < probability
    }

    /// A number between two others.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// One of these.
    pub fn pick<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }

    /// The index of one of these weights.
    pub fn weighed(&mut self, weights: impl Iterator<Item = f64> + Clone) -> usize {
        let mut left = self.next() * weights.clone().sum::<f64>();
        let mut last = 0;
        for (n, weight) in weights.enumerate() {
            last = n;
            left -= weight;
            if left < 0.0 {
                break;
            }
        }
        last
    }
    /// Corners of a polygon by its kind: half a star with both ends on the axis (0), a star off the
    /// axis, which is a ring (1), discs, cones and cylinders on top of each other (2), or any,
    /// whose edges may cross (3).
    pub fn polygon(&mut self, kind: u64, count: usize) -> Vec<[f64; 2]> {
        let last = count as f64;
        match kind {
            0 => (0..=count)
                .map(|k| on_half_turn(k, count, self.between(0.15, 0.48)))
                .collect(),
            1 => (0..count)
                .map(|k| {
                    let angle = std::f64::consts::TAU * k as f64 / last;
                    let radius = self.between(0.05, 0.22);
                    [0.26 + radius * angle.cos(), 0.5 + radius * angle.sin()]
                })
                .collect(),
            2 => {
                let mut points = vec![[0.0, 0.04]];
                for k in 0..count {
                    let z = 0.04 + 0.9 * k as f64 / last;
                    let (low, high) = (self.between(0.08, 0.46), self.between(0.08, 0.46));
                    points.push([low, z]);
                    points.push([if self.chance(0.5) { low } else { high }, z + 0.9 / last]);
                }
                points.push([0.0, 0.94]);
                points
            }
            _ => (0..count.min(6))
                .map(|_| [self.between(0.0, 0.48), self.between(0.02, 0.98)])
                .collect(),
        }
    }
}

/// Point `k` of `count` and one more on a half turn about the middle of the box, `radius` away.
pub fn on_half_turn(k: usize, count: usize, radius: f64) -> [f64; 2] {
    let (sin, cos) = (std::f64::consts::PI * (k as f64 / count as f64 - 0.5)).sin_cos();
    let r = if k.is_multiple_of(count) {
        0.0
    } else {
        radius * cos
    };
    [r, 0.5 + radius * sin]
}
