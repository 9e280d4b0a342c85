//! Published searches for comparison with those of [`revmap`].
//!
//! Every search has a [`Search`] of plain data, its GLSL in `shaders/`, and a [`Solver`]:
//!
//! | search | reads | source |
//! |---|---|---|
//! | [`LINEAR`], [`RELIEF`], [`SECANT`] | the map, by equal steps, then halvings or secants | Policarpo et al. 2005, Risser et al. 2006 |
//! | [`CIRCLE`] | the map, by steps of the distance read | Ragragui et al. 2018, 2022 |
//! | [`CONE`], [`RELAXED`] | rows of cones along the axis ([`cones`]) | Dummer 2006, Policarpo and Oliveira 2007 |
//!
//! ```
//! use revmap_searches::{ALL, CIRCLE, named};
//! assert_eq!(named("circle"), Ok(CIRCLE));
//! assert_eq!(ALL.len(), 9); // with the library's own three
//! ```

pub mod cones;
mod list;
mod map;
mod modules;

pub use cones::{CONE, RELAXED};
pub use map::{CIRCLE, LINEAR, RELIEF, SECANT};

use revmap::error::Result;
use revmap::search as module;
use revmap::settings::Solver;

#[cfg(doc)]
use revmap::search::Search;

/// Every search, in the order of reports, with the library's own last.
pub const ALL: [Solver; 9] = [
    LINEAR,
    RELIEF,
    SECANT,
    CIRCLE,
    CONE,
    RELAXED,
    Solver::ALL[0],
    Solver::ALL[1],
    Solver::ALL[2],
];

/// The search of this name.
///
/// # Errors
/// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage) if there is none.
pub fn named(name: &str) -> Result<Solver> {
    Solver::named(name, &ALL)
}

#[cfg(test)]
mod tests;
