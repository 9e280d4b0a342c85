//! Common code of tests that trace single rays: the solids as their targets.

pub use super::random::Random;
use super::shapes;
use revmap::profile::Profile;
use revmap_files::ProfileAxis;

/// Profiles by name: those of [`shapes`], and the drawings of chess pieces. The environment
/// variable `ONLY` selects one of them.
pub fn profiles() -> Vec<(String, Profile)> {
    let mut all: Vec<(String, Profile)> = Vec::new();
    all.extend(shapes::all().into_iter().map(|(name, p)| (name.into(), p)));
    for name in ["bishop", "king", "pawn", "rook"] {
        let file = format!("{}/assets/profiles/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        let profile = revmap_files::profile(file, ProfileAxis::Center).unwrap();
        all.push((name.into(), profile));
    }
    if let Ok(only) = std::env::var("ONLY") {
        all.retain(|(name, _)| *name == only);
    }
    all
}

/// Number of rays for each solid: the environment variable `RAYS`, or else `usual`.
pub fn count(usual: usize) -> usize {
    std::env::var("RAYS").map_or(usual, |n| n.parse().unwrap())
}
