//! The searches on the shape map.

use crate::modules::words;
use revmap::search::{Reads, Search, Steps};
use revmap::settings::Solver;

/// Equal steps along the ray.
pub const LINEAR: Solver = Solver::Other(&LINEAR_SEARCH);

/// Equal steps, then halvings: relief mapping.
pub const RELIEF: Solver = Solver::Other(&RELIEF_SEARCH);

/// Equal steps, then secants: interval mapping.
pub const SECANT: Solver = Solver::Other(&SECANT_SEARCH);

/// The papers' circle tracing: steps of the distance read from the map.
pub const CIRCLE: Solver = Solver::Other(&CIRCLE_SEARCH);

static LINEAR_SEARCH: Search = linear(
    "linear",
    "equal steps along the ray, through the map of distances",
    "F. Policarpo, M. M. Oliveira, J. L. D. Comba: Real-time relief mapping on arbitrary polygonal surfaces. I3D 2005",
    0,
);

static RELIEF_SEARCH: Search = linear(
    "relief",
    "equal steps, then halvings (relief mapping)",
    "F. Policarpo, M. M. Oliveira, J. L. D. Comba: Real-time relief mapping on arbitrary polygonal surfaces. I3D 2005",
    1,
);

static SECANT_SEARCH: Search = linear(
    "secant",
    "equal steps, then secants (interval mapping)",
    "E. Risser, M. Shah, S. Pattanaik: Interval mapping. University of Central Florida, 2006",
    2,
);

/// `form` has the values of `linear.glsl`.
const fn linear(
    name: &'static str,
    about: &'static str,
    source: &'static str,
    form: u32,
) -> Search {
    Search {
        name,
        about,
        source,
        licence: LICENCE,
        reads: Reads::Map {
            tells_bevels: false,
            rgba8: true,
        },
        steps: Some(Steps {
            default: 64,
            beveled: 64,
            most: Steps::MOST,
            may_run_out: false,
        }),
        form,
        words: words!("linear.glsl"),
    }
}

static CIRCLE_SEARCH: Search = Search {
    name: "circle",
    about: "circle tracing: steps as long as the map's distance, as the RBM baseline takes them, over exact distances in 32-bit floats in place of those of a binary image in 8 bits",
    source: "A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori, H. El Moubtahij: The extensions of revolution-bump mapping. \
             Journal of Graphic Engineering and Design 13 (1), 2022, 21-31. doi:10.24867/JGED-2022-1-021",
    licence: LICENCE,
    reads: Reads::Map {
        tells_bevels: true,
        rgba8: true,
    },
    // Steps before the halvings that a bevel adds.
    steps: Some(Steps {
        default: 20,
        beveled: 25,
        most: Steps::MOST,
        may_run_out: true,
    }),
    form: 0,
    words: words!("circle.glsl"),
};

pub(crate) const LICENCE: &str = env!("CARGO_PKG_LICENSE");
