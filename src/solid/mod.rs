//! A prepared solid: all that is made from one outline under an offset. No module here speaks
//! Vulkan.

pub(crate) mod kept;
pub(crate) mod offset_surface;
pub(crate) mod outline_cache;
pub(crate) mod proxy_hull;
pub(crate) mod reach;
pub(crate) mod table_slot;
pub(crate) mod tables;
