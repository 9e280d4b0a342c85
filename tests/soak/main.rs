//! A random host: a seeded program that plays an engine with frames in flight, and compares its
//! frames with those of fresh renderers.
//!
//! ```sh
//! cargo test --test soak                          # 20 seconds, another seed each time
//! REVMAP_SOAK_SEED=7 cargo test --test soak       # begins with the episode of this seed
//! REVMAP_SOAK_SECONDS=3600 cargo test --test soak --release
//! REVMAP_SOAK_COMPARES=0 cargo test --test soak   # compares no pictures: only what is compiled, hidden or refused
//! ```
//!
//! A run is a sequence of **episodes**. An episode has a device of its own and a seed, which
//! decides everything that the host does. A failure prints the seed and the last actions.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, unsafe_code)]

#[path = "../gpu/calls.rs"]
#[allow(dead_code)]
mod calls;
#[path = "../common/random.rs"]
mod random;

mod actions;
mod check;
mod common;
mod episode;
mod frames;
mod kind;
mod log;
mod model;
mod player;
mod recording;
mod runner;
mod values;
mod views;
