//! Pictures made of pictures: tiles side by side, a part enlarged, and which part is the worst.

use revmap_files::Picture;

/// A picture of these sides, pixel by pixel.
pub fn painted([width, height]: [usize; 2], pixel: impl Fn(usize, usize) -> [u8; 4]) -> Picture {
    let rgba = (0..width * height).map(|k| pixel(k % width, k / width));
    Picture {
        width: width as u32,
        height: height as u32,
        rgba: rgba.collect(),
    }
}

/// The pixel at a column and a row, if it is within the picture.
pub fn pixel(picture: &Picture, x: usize, y: usize) -> Option<[u8; 4]> {
    let within = x < picture.width as usize && y < picture.height as usize;
    within.then(|| picture.rgba[y * picture.width as usize + x])
}

/// Pictures of one size in so many columns, with white gaps between these.
pub fn tiled(tiles: &[Picture], columns: usize, gap: usize) -> Picture {
    let sides = tiles.first().map_or([1; 2], |t| [t.width, t.height]);
    let [w, h] = sides.map(|side| side as usize);
    let size = [columns * (w + gap) - gap, tiles.len().div_ceil(columns) * h];
    painted(size, |x, y| {
        let tile = tiles.get(y / h * columns + x / (w + gap));
        let own = tile.and_then(|tile| pixel(tile, x % (w + gap), y % h));
        own.unwrap_or([255; 4])
    })
}

/// A part of a picture, each pixel as `zoom` pixels across and down; `beyond` is past its borders.
pub fn enlarged(
    picture: &Picture,
    [left, top]: [usize; 2],
    part: [usize; 2],
    zoom: usize,
    beyond: [u8; 4],
) -> Picture {
    painted(part.map(|side| side * zoom), |x, y| {
        pixel(picture, left + x / zoom, top + y / zoom).unwrap_or(beyond)
    })
}

/// The part of a map of this size whose sum is largest, and that sum: its first column and row. The
/// middle where nothing is above 0. Parts begin every `step` pixels.
pub fn worst_part(
    map: &[f64],
    size: [usize; 2],
    part: [usize; 2],
    step: [usize; 2],
) -> (f64, [usize; 2]) {
    let rooms = [0, 1].map(|k: usize| size[k].saturating_sub(part[k]));
    let places = |k: usize| (0..=rooms[k]).step_by(step[k]);
    let sum = |[x, y]: [usize; 2]| -> f64 {
        let rows = y..(y + part[1]).min(size[1]);
        let row = |j: usize| map.iter().skip(j * size[0] + x).take(part[0].min(size[0]));
        rows.flat_map(row).sum()
    };
    let parts = places(1).flat_map(|y| places(0).map(move |x| [x, y]));
    let middle = (0.0, rooms.map(|room| room / 2));
    parts.fold(middle, |worst, corner| match sum(corner) {
        sum if sum > worst.0 => (sum, corner),
        _ => worst,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_stand_side_by_side_and_parts_are_enlarged() {
        let tile = |shade: usize| painted([3, 2], move |x, y| [shade as u8, x as u8, y as u8, 255]);
        let all = tiled(&[tile(0), tile(1), tile(2)], 2, 1);
        assert_eq!((all.width, all.height), (7, 4));
        assert_eq!(pixel(&all, 5, 1), Some([1, 1, 1, 255]));
        assert_eq!(pixel(&all, 2, 3), Some([2, 2, 1, 255]));
        for (x, y) in [(3, 0), (4, 2)] {
            assert_eq!(pixel(&all, x, y), Some([255; 4]));
        }
        let large = enlarged(&tile(0), [1, 1], [3, 2], 2, [9; 4]);
        assert_eq!((large.width, large.height), (6, 4));
        assert_eq!(pixel(&large, 3, 1), Some([0, 2, 1, 255]));
        assert_eq!(
            (pixel(&large, 4, 1), pixel(&large, 0, 2)),
            (Some([9; 4]), Some([9; 4]))
        );
    }

    #[test]
    fn the_worst_part_is_found() {
        let mut map = vec![0.0; 120 * 80];
        let worst = |map: &[f64]| worst_part(map, [120, 80], [40, 40], [40, 40]);
        assert_eq!(worst(&map), (0.0, [40, 20]));
        map[50 * 120 + 95] = 1.0;
        assert_eq!(worst(&map), (1.0, [80, 40]));
        assert_eq!(worst_part(&[], [0, 0], [40, 40], [8, 8]), (0.0, [0, 0]));
    }
}
