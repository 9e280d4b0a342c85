use super::*;
use std::collections::BTreeMap;

const ACROSS: u32 = 5;
const TILES: usize = 3 * ACROSS as usize;

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
    layers: 1,
    layer_of: &[0, 0],
    lists: &[false; 2],
    single: &[false; 2],
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
        let wanted = copy_tile(nearest, *place);
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

/// Two layers have copies in one tile. A layer lists its own copies in order, and one copy of
/// the two layers has a tile of its own.
#[test]
fn layers_share_tiles() {
    let tiles = tiles(90);
    let writer = TileWriter {
        layer_of: &[1, 0],
        lists: &[true, false],
        layers: 2,
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
