//! Colour maps and height maps.

use crate::enums;
use crate::fault::{RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::pointers::{list, text};
use revmap::maps::{ColorMap, DisplacementMap};
use std::ffi::c_char;
use std::sync::Arc;

/// A texture of colours.
pub struct RevmapColorMap;
handle!(RevmapColorMap, "color map", Arc<ColorMap>);

/// The slopes of a height map, for bump mapping.
pub struct RevmapHeightMap;
handle!(RevmapHeightMap, "height map", Arc<DisplacementMap>);

/// Makes a colour map from a PNG or JPEG file. The path is UTF-8.
///
/// Fails with REVMAP_RESULT_FILE if it cannot be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_color_map_from_file(
    path: *const c_char,
    color_map: *mut *mut RevmapColorMap,
) -> RevmapResult {
    create(color_map, || {
        Ok(revmap_files::color_map(text(path, "path")?)?)
    })
}

/// Makes a colour map from width * height sRGB texels with straight alpha, 4 bytes each, row by row
/// from the top.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_color_map_from_texels(
    width: u32,
    height: u32,
    texels: *const [u8; 4],
    color_map: *mut *mut RevmapColorMap,
) -> RevmapResult {
    create(color_map, || {
        let texels = list(texels, width as usize * height as usize, "texels")?;
        Ok(ColorMap::from_texels(width, height, texels.to_vec())?)
    })
}

/// Destroys a colour map; null is none. Objects that use it stay as they are.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_color_map_destroy(color_map: *mut RevmapColorMap) -> RevmapResult {
    enter(|| RevmapColorMap::destroy(color_map))
}

/// Makes a height map from a PNG or JPEG file, whose luminance is the height. The path is UTF-8;
/// filter is a RevmapSlopeFilter.
///
/// Fails with REVMAP_RESULT_FILE if it cannot be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_height_map_from_file(
    path: *const c_char,
    filter: u32,
    height_map: *mut *mut RevmapHeightMap,
) -> RevmapResult {
    create(height_map, || {
        let filter = enums::slope_filter(filter)?;
        Ok(revmap_files::displacement_map(text(path, "path")?, filter)?)
    })
}

/// Makes a height map from width * height heights in [0, 1], row by row from the top; filter is a
/// RevmapSlopeFilter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_height_map_from_heights(
    width: u32,
    height: u32,
    heights: *const f32,
    filter: u32,
    height_map: *mut *mut RevmapHeightMap,
) -> RevmapResult {
    create(height_map, || {
        let heights = list(heights, width as usize * height as usize, "heights")?;
        let filter = enums::slope_filter(filter)?;
        Ok(DisplacementMap::from_heights(
            width, height, heights, filter,
        )?)
    })
}

/// Destroys a height map; null is none. Objects that use it stay as they are.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_height_map_destroy(height_map: *mut RevmapHeightMap) -> RevmapResult {
    enter(|| RevmapHeightMap::destroy(height_map))
}
