//! What tests that send rays one by one share: the solids that the rays are sent at.

pub use super::random::Random;
use super::shapes;
use revmap::profile::{Profile, ProfileAxis};

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
