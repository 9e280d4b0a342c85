//! A frame: planned for a view, prepared in a slot, recorded into a target, read back.

pub(crate) mod output;
pub(crate) mod prepare;
pub(crate) mod read_back;
pub(crate) mod record;
pub(crate) mod slot;
pub(crate) mod srgb;
pub(crate) mod target;
