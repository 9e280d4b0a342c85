//! The parts that all tests share which a random host takes.

#[path = "../common/host.rs"]
pub mod host;
#[path = "../common/shapes.rs"]
#[allow(dead_code)]
pub mod shapes;
