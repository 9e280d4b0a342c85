//! SPIR-V words by module.

use super::catalogue::{Module, modules};
use super::generated::MODULES;
use crate::search::unpacked;

/// The words of a module; `None` if the catalogue does not have it.
pub fn words(module: &Module) -> Option<Vec<u32>> {
    let n = modules().iter().position(|m| m == module)?;
    unpacked(MODULES.get(n)?)
}
