//! SPIR-V words by module.

use super::catalogue::{Module, modules};
use super::generated::MODULES;
use crate::search::unpacked;

/// The module of [`modules`] that replaces this one: itself, or the least general one that can do
/// its work.
#[must_use]
pub fn catalogued(module: &Module) -> Option<Module> {
    let all = modules();
    module.covered_by(|m| all.contains(m))
}

/// The words of the module that replaces this one; `None` if no module can.
#[must_use]
pub fn words(module: &Module) -> Option<Vec<u32>> {
    let own = catalogued(module)?;
    let n = modules().iter().position(|m| *m == own)?;
    unpacked(MODULES.get(n)?)
}
