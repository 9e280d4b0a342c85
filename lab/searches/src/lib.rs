//! Published searches for comparison with those of [`revmap`], and searches of other people's
//! folders.
//!
//! A search is a **folder** with a `search.toml`, which describes it, and a GLSL file with one
//! function. The searches of this crate are the folders of `published/`, compiled when the crate is
//! built. Every other folder is read by [`folder::load`] and compiled at run time (feature
//! `shaderc`). `docs/your-own-search.md` explains both files.
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

pub mod cache;
pub mod cones;
pub mod folder;
mod list;
pub mod manifest;
mod modules;
mod published;
pub mod watchdog;

pub use published::{CIRCLE, CONE, LINEAR, RELAXED, RELIEF, SECANT};

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

/// The search of this name, or of the folder at this path ([`folder::load`]).
///
/// # Errors
/// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage) if there is none; those of
/// [`folder::load`].
pub fn named(name: &str) -> Result<Solver> {
    match Solver::named(name, &ALL) {
        Err(_) if folder::is_named(name) => folder::load(name),
        found => found,
    }
}

#[cfg(test)]
mod tests;
