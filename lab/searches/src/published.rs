//! The searches of this crate, which `build.rs` reads from the folders of `published/`.

use crate::modules::{embedded, found};
use revmap::search::{Reads, Search, Steps};
use revmap::settings::Solver;

include!(concat!(env!("OUT_DIR"), "/published.rs"));
