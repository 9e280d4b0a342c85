//! What tests that send rays one by one share: numbers by chance, and the solids that the rays are
//! sent at.

use super::shapes;
use revmap::profile::{Profile, ProfileAxis};

/// Numbers by SplitMix64.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Profiles by name: those of [`shapes`], and the drawings of chess pieces; by the environment
/// variable `ONLY` one of them.
pub fn profiles() -> Vec<(String, Profile)> {
    let mut all: Vec<(String, Profile)> = shapes::all()
        .into_iter()
        .map(|(name, p)| (name.to_string(), p))
        .collect();
    for name in ["bishop", "king", "pawn", "rook"] {
        let file = format!("{}/assets/profiles/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        all.push((
            name.into(),
            Profile::load(file, ProfileAxis::Center).unwrap(),
        ));
    }
    if let Ok(only) = std::env::var("ONLY") {
        all.retain(|(name, _)| *name == only);
    }
    all
}

/// How many rays are sent at each solid: by the environment variable `RAYS`, or so many.
pub fn count(usual: usize) -> usize {
    std::env::var("RAYS").map_or(usual, |n| n.parse().unwrap())
}
