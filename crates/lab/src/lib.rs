//! Measuring what [`revmap`] draws: how far a picture is from the truth, how long it takes, and
//! reports of both.
//!
//! | module | what it makes of what comes before |
//! |---|---|
//! | [`mod@compare`] | two frames: errors in numbers, FLIP, silhouettes, heat maps |
//! | [`method`] | what is measured: a search, or a mesh |
//! | `mesh` | the mesh baseline: the same solids as triangles (feature `mesh`) |
//! | `floor` | frames without a search: what is left of a frame's time (feature `mesh`) |
//! | `renderer` | one renderer for every method (feature `mesh`) |
//! | [`samples`] | several rays per pixel |
//! | `report` | views and ways to draw them: times beside errors, as tables, charts and one page (feature `report`) |
//! | `stability` | cases in which methods fail, and how each search fares (feature `report`) |

pub mod compare;
#[cfg(feature = "mesh")]
pub mod floor;
pub mod map_accuracy;
#[cfg(feature = "mesh")]
pub mod mesh;
pub mod method;
mod mosaic;
#[cfg(feature = "mesh")]
pub mod renderer;
#[cfg(feature = "report")]
pub mod report;
pub mod samples;
#[cfg(feature = "report")]
pub mod stability;
