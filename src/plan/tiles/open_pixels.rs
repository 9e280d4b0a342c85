//! The pixels of a picture that are drawn.

use super::bounds::SIDE;

/// Pixels of a picture that the compute stage draws; others may be left out. A set of bits for each
/// tile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenPixels {
    /// Tiles across.
    across: u32,
    tiles: Vec<u64>,
}

impl OpenPixels {
    /// The pixels of a picture of this width, row 0 on top.
    #[must_use]
    pub fn new(width: u32, pixels: &[bool]) -> Self {
        let across = width.div_ceil(SIDE);
        let rows = pixels.len().div_ceil(width.max(1) as usize);
        let mut tiles = vec![0; across as usize * rows.div_ceil(SIDE as usize)];
        for (row, y) in pixels.chunks(width.max(1) as usize).zip(0u32..) {
            for (_, x) in row.iter().zip(0u32..).filter(|(open, _)| **open) {
                let tile = y / SIDE * across + x / SIDE;
                tiles[tile as usize] |= 1 << (y % SIDE * SIDE + x % SIDE);
            }
        }
        Self { across, tiles }
    }

    /// Those of a tile, one bit each.
    pub(super) fn of(&self, [x, y]: [u32; 2]) -> u64 {
        let at = y * self.across + x;
        self.tiles.get(at as usize).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_is_a_bit_of_its_tile() {
        let (width, height) = (21, 10);
        let is_open = |x: u32, y: u32| (x * 7 + y * 5).is_multiple_of(3);
        let pixels: Vec<bool> = (0..height)
            .flat_map(|y| (0..width).map(move |x| is_open(x, y)))
            .collect();
        let open = OpenPixels::new(width, &pixels);
        for y in 0..2 * SIDE {
            for x in 0..3 * SIDE {
                let bit = open.of([x / SIDE, y / SIDE]) >> (y % SIDE * SIDE + x % SIDE) & 1;
                assert_eq!(
                    bit == 1,
                    x < width && y < height && is_open(x, y),
                    "{x} {y}"
                );
            }
        }
        assert_eq!(open.of([0, 2]), 0);
    }
}
