//! A failure as the naked eye sees it: the part of a picture that differs most, enlarged.

use revmap_compare::mosaic::{enlarged, painted, pixel, tiled, worst_part};
use revmap_files::Picture;

/// The part that is shown, pixels.
const PART: [usize; 2] = [40, 30];
/// How many pixels a pixel of the part takes across.
const ZOOM: usize = 4;
/// By how much a channel of 255 must differ to be seen.
const SEEN: u8 = 24;
/// What is drawn on where nothing is hit, and between panels.
const GROUND: [u8; 4] = [44, 44, 50, 255];
const FRAME: [u8; 4] = [255, 220, 0, 255];
/// Pixels between panels.
const GAP: usize = 4;

/// Where in a picture most is seen to be wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spot {
    /// How much: differences that can be seen (above 24 of 255), summed.
    pub seen: f64,
    /// The part's first column and row.
    pub corner: [usize; 2],
}

impl Spot {
    /// The part in which two pictures of one size differ most.
    pub fn worst(drawn: &Picture, truth: &Picture) -> Self {
        let pairs = drawn.rgba.iter().zip(&truth.rgba);
        let off = pairs.map(|(a, b)| {
            let (a, b) = (on_ground(*a), on_ground(*b));
            let most = (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
            if most > SEEN { f64::from(most) } else { 0.0 }
        });
        let off: Vec<f64> = off.collect();
        let size = [truth.width, truth.height].map(|side| side as usize);
        // Parts that overlap by four fifths.
        let (seen, corner) = worst_part(&off, size, PART, PART.map(|side| side / 5));
        Self { seen, corner }
    }

    /// The picture with the part framed; the part as drawn, as it should be, and the difference.
    pub fn strip(&self, drawn: &Picture, truth: &Picture, heat: &Picture) -> Picture {
        let part = |picture: &Picture| {
            let mut part = enlarged(picture, self.corner, PART, ZOOM, GROUND);
            let pixels = part.rgba.iter_mut();
            pixels.for_each(|color| *color = on_ground(*color));
            part
        };
        let panels = [self.whole(drawn), part(drawn), part(truth), part(heat)];
        tiled(&panels, panels.len(), GAP)
    }

    fn whole(&self, drawn: &Picture) -> Picture {
        let panel = PART.map(|side| side * ZOOM);
        // As many pixels of the picture for one of the panel as it takes to hold it.
        let steps = |all: u32, panel: usize| f64::from(all) / panel as f64;
        let step = steps(drawn.width, panel[0]).max(steps(drawn.height, panel[1]));
        let on = |v: usize, from: usize, part: usize| {
            let (low, high) = (from as f64, (from + part) as f64);
            let (a, b) = (v as f64, v as f64 + step.max(1.0));
            (
                a >= low && a < high,
                a <= low && low < b || a < high && high <= b,
            )
        };
        painted(panel, |x, y| {
            let [i, j] = [x, y].map(|v| (v as f64 * step) as usize);
            let across = on(i, self.corner[0], PART[0]);
            let down = on(j, self.corner[1], PART[1]);
            if across.1 && down.0 || down.1 && across.0 {
                return FRAME;
            }
            pixel(drawn, i, j).map_or(GROUND, on_ground)
        })
    }
}

/// A colour over the ground.
fn on_ground(color: [u8; 4]) -> [u8; 4] {
    match color {
        [_, _, _, 0] => GROUND,
        [r, g, b, _] => [r, g, b, 255],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_part_is_framed_and_shown() {
        let truth = painted([160, 120], |_, _| [100, 100, 100, 255]);
        // Too little to be seen at the first pixel; nothing is hit at three.
        let drawn = painted([160, 120], |x, y| match (x, y) {
            (0, 0) => [110, 100, 100, 255],
            (100, 70) | (102, 71) | (104, 72) => [0; 4],
            _ => [100, 100, 100, 255],
        });
        let spot = Spot::worst(&drawn, &truth);
        let [x, y] = [102 - spot.corner[0], 71 - spot.corner[1]];
        assert!(spot.seen > 0.0 && (2..PART[0] - 2).contains(&x) && (1..PART[1] - 1).contains(&y));
        let strip = spot.strip(&drawn, &truth, &truth);
        assert_eq!((strip.width, strip.height), (652, 120));
        let at = |panel: usize| pixel(&strip, 164 * panel + ZOOM * x, ZOOM * y);
        assert_eq!((at(1), at(2)), (Some(GROUND), Some([100, 100, 100, 255])));
        assert!(strip.rgba.contains(&FRAME));
        assert_eq!(Spot::worst(&truth, &truth).seen, 0.0);
    }
}
