//! Device resources of a scene: blocks that shaders read, maps and textures, tables in one buffer.

pub(crate) mod geometry;
pub(crate) mod shape_texture;
pub(crate) mod textures;
