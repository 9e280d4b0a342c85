//! Distribution of copies to tiles: those of one copy, queues, and pixels gathered from several tiles.

use super::bounds::SIDE;
use super::cover::{block, within};
use crate::shader::generated::{NO_PIXEL, QUAD_BITS, QUEUE_BLOCK, TILE_BITS, TILE_HALVES};
use crate::shader::{CopyTile, GatheredPixel, QueueBlock, QueueTile, QueuedCopy};
use std::ops::Range;

/// A copy in a tile.
#[derive(Clone, Copy)]
pub(super) struct TileCopy {
    pub batch: u32,
    /// Number of the instance.
    pub copy: u32,
    pub near: f32,
    /// Pixels of the tile that may show the copy, one bit each.
    pub pixels: u64,
}

/// The tiles of one layer in one band. Blocks and gathered tiles count from the band's first.
#[derive(Default)]
pub(super) struct BandTiles {
    /// Fragments: squares of one copy each.
    pub quads: Vec<CopyTile>,
    /// Compute: tiles of one copy each, with lists of patches here and without in `single`. No tile
    /// has two such copies.
    pub listed: Vec<CopyTile>,
    pub single: Vec<CopyTile>,
    pub queued: Vec<QueueTile>,
    /// Compute: tiles of which only these pixels are searched.
    pub gathered: Vec<QueueTile>,
    pub pixels: Vec<GatheredPixel>,
    pub blocks: Vec<QueueBlock>,
}

/// Pixels of a tile, and invocations of a work group.
pub(crate) const TILE_PIXELS: u32 = SIDE * SIDE;
/// Fragments: least copies of a tile for which it has a queue, without and with shadows; those of
/// other tiles are drawn as quads. Without shadows queues from 3 copies on take 1.13 of the time of
/// sparse fields on lavapipe 22; from 6 on, 10,000 copies take 0.86 and a million 0.57 of the time
/// of quads alone. With shadows a queue spares the shading of what is hidden: 11 solids take 0.61 of
/// the time with queues from 2 copies on, and 0.66 from 1 on.
pub(crate) const LEAST_QUEUE: [usize; 2] = [6, 2];
/// Least number of a tile's pixels for which a copy gets a tile of its own.
const SINGLE_PIXELS: u32 = 24;

/// Distributes the copies of a band.
pub(super) struct TileWriter<'a> {
    /// True for work groups, false for fragments.
    pub compute: bool,
    /// The layer of each batch.
    pub layer_of: &'a [u32],
    /// True if patches may be listed for a batch's tiles.
    pub lists: &'a [bool],
    /// True if a batch has one copy.
    pub single: &'a [bool],
    /// Fragments: for each layer, the least copies of a tile that has a queue.
    pub queues: &'a [usize],
    /// Pixels: left, top, right, bottom.
    pub picture: [u32; 4],
}

impl TileWriter<'_> {
    /// Distributes the copies of tiles, nearest first, and returns the tiles of each layer. A tile is
    /// given by its position, in tiles.
    pub fn write<Copies: Iterator<Item = TileCopy>>(
        &self,
        tiles: impl Iterator<Item = ([u32; 2], Copies)>,
    ) -> Vec<BandTiles> {
        let mut layers: Vec<BandTiles> = Vec::new();
        layers.resize_with(self.queues.len(), BandTiles::default);
        let mut left = Vec::new();
        for (place, copies) in tiles {
            left.clear();
            left.extend(copies);
            if self.compute
                && let Some(n) = self.single_of(&left)
            {
                let copy = left.remove(n);
                let layer = &mut layers[self.layer_of[copy.batch as usize] as usize];
                layer.add_single(&copy, place, self.lists[copy.batch as usize]);
            }
            while let Some(first) = left.first() {
                let number = self.layer_of[first.batch as usize];
                let is_of = |copy: &TileCopy| self.layer_of[copy.batch as usize] == number;
                let copies = left.iter().filter(|copy| is_of(copy));
                let layer = &mut layers[number as usize];
                let least = self.queues[number as usize];
                if !self.compute && copies.clone().take(least).count() < least {
                    let inside = within(place, self.picture);
                    copies.for_each(|copy| layer.add_quads(copy, place, inside));
                } else {
                    layer.add_queue(copies, place, self.compute);
                }
                left.retain(|copy| !is_of(copy));
            }
        }
        layers
    }

    /// Index of the tile's copy that gets a tile of its own.
    fn single_of(&self, copies: &[TileCopy]) -> Option<usize> {
        let is_large = |copy: &TileCopy| copy.pixels.count_ones() >= SINGLE_PIXELS;
        match copies {
            [copy] if is_large(copy) || self.single[copy.batch as usize] => Some(0),
            _ => (0..copies.len()).find(|&n| {
                // Copies that coincide need the same search: the first of equal depths stays.
                let alike = |other: &&TileCopy| other.near == copies[n].near;
                let lists = self.lists[copies[n].batch as usize] && is_large(&copies[n]);
                lists && copies.iter().filter(alike).count() == 1
            }),
        }
    }
}

/// A square of pixels of a copy. `corner` and `side`: pixels.
fn copy_tile(copy: &TileCopy, [x, y]: [u32; 2], side: u32) -> CopyTile {
    CopyTile {
        square: x | y << QUAD_BITS | side.ilog2() << (2 * QUAD_BITS),
        instance: copy.copy,
        near: copy.near,
        unused: 0,
    }
}

impl BandTiles {
    /// Adds a tile's only copy, or a copy with a tile of its own.
    fn add_single(&mut self, copy: &TileCopy, place: [u32; 2], lists: bool) {
        let tiles = if lists {
            &mut self.listed
        } else {
            &mut self.single
        };
        tiles.push(copy_tile(copy, place.map(|at| at * SIDE), SIDE));
    }

    /// Adds a tile with a queue. If `gathers`, and some pixels of the tile show no copy, its other
    /// pixels share work groups with those of other tiles.
    fn add_queue<'a>(
        &mut self,
        copies: impl Iterator<Item = &'a TileCopy>,
        [x, y]: [u32; 2],
        gathers: bool,
    ) {
        let mut tile = QueueTile {
            first: self.blocks.len() as u32,
            ..QueueTile::default()
        };
        let mut pixels = 0;
        for copy in copies {
            let slot = tile.count % QUEUE_BLOCK;
            if slot == 0 {
                self.blocks.push(QueueBlock::default());
            }
            if tile.count == 0 {
                tile.near = copy.near;
            }
            tile.count += 1;
            pixels |= copy.pixels;
            if let Some(block) = self.blocks.last_mut() {
                block.copies[slot as usize] = QueuedCopy {
                    instance: copy.copy,
                    near: copy.near,
                };
                each_bit(copy.pixels, |k| {
                    let at = k * QUEUE_BLOCK;
                    block.marks[at as usize / 32] |= 1 << (at % 32 + slot);
                });
            }
        }
        tile.place = x | y << TILE_BITS | halves_of(pixels) << TILE_HALVES;
        if !gathers || pixels == u64::MAX {
            self.queued.push(tile);
            return;
        }
        let number = self.gathered.len() as u32;
        self.gathered.push(tile);
        each_bit(pixels, |k| {
            let [x, y] = [x * SIDE + k % SIDE, y * SIDE + k / SIDE];
            self.pixels.push(GatheredPixel {
                position: x | y << 16,
                tile: number,
            });
        });
    }

    /// Adds the quads of a copy in a tile. `inside`: the tile's pixels that are in the picture.
    fn add_quads(&mut self, copy: &TileCopy, [x, y]: [u32; 2], inside: u64) {
        let add = &mut |[left, top, side]: [u32; 3]| {
            let corner = [x * SIDE + left, y * SIDE + top];
            self.quads.push(copy_tile(copy, corner, side));
        };
        cut([0, 0, SIDE], copy.pixels & inside, inside, add);
    }
}

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
    /// Fragments: quads of one copy each.
    pub quads: Range<u32>,
    /// Compute: tiles of one copy each, with lists of patches. In all layers, no two tiles that
    /// have a single copy share pixels. The tiles are drawn before tiles of several copies.
    pub listed: Range<u32>,
    /// Compute: tiles of one copy each, without lists of patches.
    pub single: Range<u32>,
    /// Tiles with queues of copies.
    pub queued: Range<u32>,
    /// Compute: pixels of other such tiles.
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
        let of_one = [&band.quads, &band.listed, &band.single].map(|of| size_of_val(&of[..]));
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
        (layer.quads, layer.listed) = (put(|of| &of.quads), put(|of| &of.listed));
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

/// Visits quads (x, y, side) within this one that hold these pixels and no pixel outside of the
/// picture. Drivers search blocks of 4 x 4 pixels as one. Smaller quads are therefore used only at
/// the picture's edges, and a whole tile only where no block would be empty.
fn cut([x, y, side]: [u32; 3], pixels: u64, inside: u64, visit: &mut impl FnMut([u32; 3])) {
    let bits = |[x, y, side]: [u32; 3]| block([x, y, x + side - 1, y + side - 1]);
    let whole = bits([x, y, side]);
    if pixels & whole == 0 {
        return;
    }
    let half = side / 2;
    let quarters =
        [[x, y], [x + half, y], [x, y + half], [x + half, y + half]].map(|[x, y]| [x, y, half]);
    let full = side < SIDE || quarters.iter().all(|q| pixels & bits(*q) != 0);
    if full && whole & !inside == 0 {
        visit([x, y, side]);
    } else {
        for quarter in quarters {
            cut(quarter, pixels, inside, visit);
        }
    }
}

/// Visits the bits that are set.
fn each_bit(mut bits: u64, mut visit: impl FnMut(u32)) {
    while bits != 0 {
        visit(bits.trailing_zeros());
        bits &= bits - 1;
    }
}

/// The halves of a tile in which pixels are, one bit each: left, right, top, bottom.
fn halves_of(pixels: u64) -> u32 {
    const LEFT: u64 = 0x0f0f_0f0f_0f0f_0f0f;
    let [left, top] = [LEFT, 0xffff_ffff];
    let halves = [left, !left, top, !top];
    (0..)
        .zip(halves)
        .map(|(k, half)| u32::from(pixels & half != 0) << k)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    const ACROSS: u32 = 5;
    const TILES: usize = 3 * ACROSS as usize;
    const PICTURE: [u32; 4] = [0, 0, 8 * ACROSS - 1, 23];

    /// Positions of tiles, and their copies, nearest first.
    type Tiles = Vec<([u32; 2], Vec<TileCopy>)>;
    /// The copies that are searched in each pixel.
    type Found = BTreeMap<(u32, u32), Vec<u32>>;

    /// So many copies of many sizes, from whole tiles to single pixels.
    fn tiles(count: u32) -> Tiles {
        let place = |tile| [tile % ACROSS, tile / ACROSS];
        let mut all: Tiles = (0..TILES as u32).map(|t| (place(t), Vec::new())).collect();
        let mut state = 7u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            state >> 16
        };
        for copy in 0..count {
            let few = next() & next() >> 7 & next() << 3;
            let (_, here) = &mut all[next() as usize % TILES];
            here.push(TileCopy {
                batch: copy % 2,
                copy,
                near: near(copy),
                pixels: if copy % 3 == 0 {
                    u64::MAX
                } else {
                    1 << (copy % 60) | few
                },
            });
        }
        all
    }

    /// The pixels of a tile.
    fn pixels_of([x, y]: [u32; 2], bits: u64) -> impl Iterator<Item = (u32, u32)> {
        let bits = (0..64).filter(move |k| bits >> k & 1 == 1);
        bits.map(move |k| (SIDE * x + k % SIDE, SIDE * y + k / SIDE))
    }

    /// The copies that each pixel may show.
    fn shown(tiles: &Tiles) -> Found {
        let mut all = Found::new();
        for (place, here) in tiles {
            for one in here {
                for pixel in pixels_of(*place, one.pixels) {
                    all.entry(pixel).or_default().push(one.copy);
                }
            }
        }
        all
    }

    /// The depth of a copy.
    fn near(copy: u32) -> f32 {
        100.0 + copy as f32
    }

    /// The copies of a tile's queue that a pixel may show.
    fn list(blocks: &[QueueBlock], tile: &QueueTile, bit: u32) -> Vec<u32> {
        let mut found = Vec::new();
        for k in 0..tile.count.next_multiple_of(QUEUE_BLOCK) {
            let block = &blocks[(tile.first + k / QUEUE_BLOCK) as usize];
            let (slot, at) = (k % QUEUE_BLOCK, bit * QUEUE_BLOCK);
            if block.marks[at as usize / 32] >> (at % 32 + slot) & 1 == 1 {
                let copy = block.copies[slot as usize];
                assert!(k < tile.count && copy.near == near(copy.instance));
                found.push(copy.instance);
            }
        }
        found
    }

    /// Two batches in one layer, with queues.
    const WRITER: TileWriter = TileWriter {
        compute: true,
        layer_of: &[0, 0],
        lists: &[false; 2],
        single: &[false; 2],
        queues: &[1],
        picture: PICTURE,
    };

    fn written(tiles: &Tiles, writer: &TileWriter) -> Vec<BandTiles> {
        writer.write(
            tiles
                .iter()
                .map(|(place, here)| (*place, here.iter().copied())),
        )
    }

    /// The lists that work groups search.
    fn visited(tiles: &BandTiles) -> Found {
        let mut found = BTreeMap::new();
        let corner = |tile: &QueueTile| {
            [tile.place, tile.place >> TILE_BITS].map(|at| (at & ((1 << TILE_BITS) - 1)) * SIDE)
        };
        let mut visit = |tile: &QueueTile, [x, y]: [u32; 2]| {
            let list = list(&tiles.blocks, tile, x % SIDE + y % SIDE * SIDE);
            assert!(found.insert((x, y), list).is_none());
        };
        for tile in &tiles.queued {
            let [x, y] = corner(tile);
            (0..TILE_PIXELS).for_each(|k| visit(tile, [x + k % SIDE, y + k / SIDE]));
        }
        for pixel in &tiles.pixels {
            let tile = &tiles.gathered[pixel.tile as usize];
            let at = [pixel.position & 0xffff, pixel.position >> 16];
            assert_eq!(at.map(|at| at / SIDE * SIDE), corner(tile));
            visit(tile, at);
        }
        found
    }

    #[test]
    fn gathered_pixels_list_what_they_show() {
        let tiles = tiles(90);
        let lists = &written(&tiles, &WRITER)[0];
        let found = visited(lists);
        // Each pixel searches the copies that it may show, in order.
        let shown = shown(&tiles);
        assert!(shown.iter().all(|(pixel, wanted)| found[pixel] == *wanted));
        assert_eq!(lists.listed.len() + lists.single.len(), 0);
    }

    #[test]
    fn a_large_copy_of_each_tile_has_a_tile_of_its_own() {
        let tiles = tiles(90);
        let lists = &[true; 2];
        let lists = &written(&tiles, &TileWriter { lists, ..WRITER })[0];
        let mut found = visited(lists);
        let mut singles = lists.listed.iter();
        for (place, here) in &tiles {
            let is_large = |one: &&TileCopy| one.pixels.count_ones() >= SINGLE_PIXELS;
            let Some(nearest) = here.iter().find(is_large) else {
                continue;
            };
            let wanted = copy_tile(nearest, place.map(|at| at * SIDE), SIDE);
            assert_eq!(singles.next(), Some(&wanted));
            for pixel in pixels_of(*place, nearest.pixels) {
                let list = found.entry(pixel).or_default();
                if let Err(at) = list.binary_search(&nearest.copy) {
                    list.insert(at, nearest.copy);
                }
            }
        }
        assert!(singles.next().is_none() && lists.listed.len() > TILES / 2);
        let shown = shown(&tiles);
        assert!(shown.iter().all(|(pixel, wanted)| found[pixel] == *wanted));
    }

    /// Quads of tiles with few copies, and queues of the others, hold what pixels show. Quads hold no
    /// pixel outside of the picture.
    #[test]
    fn fragments_have_quads_and_queues() {
        // The picture ends within tiles on all sides.
        let picture = [3, 2, 8 * ACROSS - 2, 20];
        let [left, top, right, bottom] = picture;
        let inside = |x: u32, y: u32| (left..=right).contains(&x) && (top..=bottom).contains(&y);
        for (queues, count) in [(6, 40), (2, 40), (6, 90), (usize::MAX, 90)] {
            let mut tiles = tiles(count);
            for (place, here) in &mut tiles {
                let inside = within(*place, picture);
                here.iter_mut().for_each(|one| one.pixels &= inside);
            }
            let writer = TileWriter {
                compute: false,
                lists: &[true; 2],
                queues: &[queues],
                picture,
                ..WRITER
            };
            let lists = &written(&tiles, &writer)[0];
            assert!(lists.listed.is_empty() && lists.single.is_empty());
            assert!(!lists.quads.is_empty() || count == 90);
            assert_eq!(lists.queued.is_empty(), queues == usize::MAX);
            assert!(lists.gathered.is_empty() && lists.pixels.is_empty());
            let mut found = visited(lists);
            for quad in &lists.quads {
                let (square, copy) = (quad.square, quad.instance);
                assert_eq!(quad.near, near(copy));
                let (mask, side) = ((1 << QUAD_BITS) - 1, 1 << (square >> (2 * QUAD_BITS)));
                let [x, y] = [square & mask, square >> QUAD_BITS & mask];
                for (x, y) in (y..y + side).flat_map(|y| (x..x + side).map(move |x| (x, y))) {
                    let list = found.entry((x, y)).or_default();
                    assert!(inside(x, y) && !list.contains(&copy), "{x} {y}");
                    list.push(copy);
                }
            }
            for ((x, y), wanted) in shown(&tiles) {
                assert!(inside(x, y) && wanted.iter().all(|copy| found[&(x, y)].contains(copy)));
            }
        }
    }

    /// Two layers have copies in one tile. A layer lists its own copies in order, and one copy of
    /// the two layers has a tile of its own.
    #[test]
    fn layers_share_tiles() {
        let tiles = tiles(90);
        let writer = TileWriter {
            layer_of: &[1, 0],
            lists: &[true, false],
            queues: &[1; 2],
            ..WRITER
        };
        let lists = written(&tiles, &writer);
        assert!(lists[0].listed.is_empty() && !lists[1].listed.is_empty());
        let mut found = Found::new();
        for (layer, lists) in (0u32..).zip(&lists) {
            for (pixel, list) in visited(lists) {
                assert!(list.is_sorted() && list.iter().all(|copy| 1 - copy % 2 == layer));
                found.entry(pixel).or_default().extend(list);
            }
            for tile in &lists.listed {
                let place = [tile.square, tile.square >> QUAD_BITS];
                let place = place.map(|at| (at & ((1 << QUAD_BITS) - 1)) / SIDE);
                for pixel in pixels_of(place, u64::MAX) {
                    found.entry(pixel).or_default().push(tile.instance);
                }
            }
        }
        for (pixel, wanted) in shown(&tiles) {
            assert!(wanted.iter().all(|copy| found[&pixel].contains(copy)));
        }
    }
}
