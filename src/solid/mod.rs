//! A prepared solid: all data made from one outline under an offset. No module here records Vulkan
//! commands.

pub(crate) mod kept;
pub(crate) mod offset_surface;
pub(crate) mod outline_cache;
pub(crate) mod proxy_hull;
pub(crate) mod reach;
pub(crate) mod table_slot;
pub(crate) mod tables;
