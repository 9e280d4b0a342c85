//! Random choices.

use crate::random::Random;

pub struct Dice(Random);

impl Dice {
    pub fn new(seed: u64) -> Self {
        // The first numbers of near seeds are alike in no bit.
        Self(Random(seed.wrapping_mul(0xd134_2543_de82_ef95)))
    }

    /// A whole number from 0 to `end - 1`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.0.next() * end as f64) as usize
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.0.next() < probability
    }

    /// A number between two others.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next()
    }

    /// One of these.
    pub fn pick<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }

    /// The index of one of these weights.
    pub fn weighed(&mut self, weights: impl Iterator<Item = f64> + Clone) -> usize {
        let mut left = self.0.next() * weights.clone().sum::<f64>();
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
}
