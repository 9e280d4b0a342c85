//! The tiles of all bands as one buffer, with the ranges of each layer.

use super::tile_writer::{BandTiles, TILE_PIXELS};
use crate::shader::generated::NO_PIXEL;
use crate::shader::{CopyTile, GatheredPixel, QueueBlock, QueueTile};
use std::ops::Range;

/// Tiles of all layers, and their data in the buffer that shaders read (`tiles.glsl`).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LayeredTiles {
    pub words: Vec<u32>,
    pub layers: Vec<LayerTiles>,
}

/// The tiles of objects that share a pipeline and a set of textures. Ranges count tiles, or gathered
/// pixels, from the buffer's start.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LayerTiles {
    /// Tiles of one copy each, with lists of patches. In all layers, no two tiles that
    /// have a single copy share pixels. The tiles are drawn before tiles of several copies.
    pub listed: Range<u32>,
    /// Tiles of one copy each, without lists of patches.
    pub single: Range<u32>,
    /// Tiles with queues of copies.
    pub queued: Range<u32>,
    /// Pixels of other such tiles.
    pub gathered: Range<u32>,
}

impl LayerTiles {
    /// Turns tiles with lists of patches into tiles without. The two ranges are neighbours.
    pub fn unlist(&mut self) {
        self.single.start = self.listed.start;
        self.listed.end = self.listed.start;
    }
}

/// Joins the tiles of all bands: an empty block, blocks of queues, tiles, gathered pixels.
pub(super) fn join(bands: &[Vec<BandTiles>], layers: usize) -> LayeredTiles {
    let all = || (0..layers).flat_map(|n| bands.iter().map(move |band| &band[n]));
    let bytes = |band: &BandTiles| {
        let of_one = [&band.listed, &band.single].map(|of| size_of_val(&of[..]));
        let queues = [&band.queued, &band.gathered].map(|of| size_of_val(&of[..]));
        let others = [size_of_val(&band.blocks[..]), size_of_val(&band.pixels[..])];
        of_one
            .into_iter()
            .chain(queues)
            .chain(others)
            .sum::<usize>()
    };
    let padding = layers * size_of::<[GatheredPixel; TILE_PIXELS as usize]>();
    let bytes = size_of::<QueueBlock>() + all().map(bytes).sum::<usize>() + padding;
    let mut words: Vec<u32> = Vec::with_capacity(bytes / 4);
    words.resize(size_of::<QueueBlock>() / 4, 0);
    // The first block of each band, and its first gathered tile.
    let mut begins = Vec::with_capacity(bands.len() * layers);
    for band in all() {
        let block = words.len() / (size_of::<QueueBlock>() / 4);
        begins.push([block as u32, 0]);
        words.extend_from_slice(bytemuck::cast_slice(&band.blocks));
    }
    let number = |words: &Vec<u32>| (words.len() / (size_of::<CopyTile>() / 4)) as u32;
    let queue = |tile: &QueueTile, block: u32| QueueTile {
        first: tile.first + block,
        ..*tile
    };
    let mut made = vec![LayerTiles::default(); layers];
    for (n, layer) in made.iter_mut().enumerate() {
        let of_layer = || bands.iter().map(|band| &band[n]);
        let mut put = |of: for<'b> fn(&'b BandTiles) -> &'b [CopyTile]| {
            let first = number(&words);
            of_layer().for_each(|band| words.extend_from_slice(bytemuck::cast_slice(of(band))));
            first..number(&words)
        };
        layer.listed = put(|of| &of.listed);
        layer.single = put(|of| &of.single);
        let begins = &mut begins[n * bands.len()..][..bands.len()];
        let first = number(&words);
        for (band, [block, _]) in of_layer().zip(&*begins) {
            for tile in &band.queued {
                words.extend(bytemuck::cast::<_, [u32; 4]>(queue(tile, *block)));
            }
        }
        layer.queued = first..number(&words);
        for (band, [block, tiles]) in of_layer().zip(begins) {
            *tiles = number(&words);
            for tile in &band.gathered {
                words.extend(bytemuck::cast::<_, [u32; 4]>(queue(tile, *block)));
            }
        }
    }
    for (n, layer) in made.iter_mut().enumerate() {
        let first = words.len() as u32 / 2;
        let mut last = 0;
        for (band, [_, tiles]) in bands.iter().zip(&begins[n * bands.len()..]) {
            last = *tiles;
            let pixels = band[n].pixels.iter();
            words.extend(pixels.flat_map(|pixel| [pixel.position, pixel.tile + tiles]));
        }
        let end = first + (words.len() as u32 / 2 - first).next_multiple_of(TILE_PIXELS);
        while (words.len() as u32) < 2 * end {
            words.extend([NO_PIXEL, last]);
        }
        layer.gathered = first..end;
    }
    LayeredTiles {
        words,
        layers: made,
    }
}
