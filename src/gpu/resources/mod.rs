//! Device resources of a scene: blocks that shaders read, maps and textures, tables in one buffer.

pub(crate) mod arena;
pub(crate) mod block;
pub(crate) mod blocks;
pub(crate) mod geometry;
pub(crate) mod map_key;
pub(crate) mod shape_texture;
pub(crate) mod solid_cache;
pub(crate) mod textures;
