//! A failure as the naked eye sees it: the part of a picture that differs most, enlarged.

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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spot {
    /// How much: differences that can be seen (above 24 of 255), summed.
    pub seen: u64,
    /// The part's first column and row.
    pub corner: [usize; 2],
}

impl Spot {
    /// The part in which two pictures of one size differ most.
    #[must_use]
    pub fn worst(drawn: &Picture, truth: &Picture) -> Self {
        let (width, height) = (truth.width as usize, truth.height as usize);
        let off: Vec<u64> = (0..width * height)
            .map(|k| {
                let (a, b) = (on_ground(drawn, k), on_ground(truth, k));
                let most = (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
                if most > SEEN { u64::from(most) } else { 0 }
            })
            .collect();
        // Parts that overlap by four fifths.
        let corners = |all: usize, part: usize| (0..=all.saturating_sub(part)).step_by(part / 5);
        let rows = corners(height, PART[1]);
        let parts = rows.flat_map(|y| corners(width, PART[0]).map(move |x| [x, y]));
        let [x, y] =
            [(width, PART[0]), (height, PART[1])].map(|(all, part)| all.saturating_sub(part) / 2);
        let middle = Self {
            seen: 0,
            corner: [x, y],
        };
        parts.fold(middle, |worst, [x, y]| {
            let row = |j: usize| off[j * width + x..].iter().take(PART[0].min(width - x));
            let seen = (y..(y + PART[1]).min(height)).flat_map(row).sum();
            let corner = [x, y];
            if seen > worst.seen {
                Self { seen, corner }
            } else {
                worst
            }
        })
    }

    /// The whole picture with the part framed, and the part as drawn, as the reference has it, and
    /// where the two differ, side by side.
    #[must_use]
    pub fn strip(&self, drawn: &Picture, truth: &Picture, heat: &Picture) -> Picture {
        let panel = [PART[0] * ZOOM, PART[1] * ZOOM];
        let size = [4 * panel[0] + 3 * GAP, panel[1]];
        let pixel = |k: usize| {
            let (x, y) = (k % size[0], k / size[0]);
            let (number, x) = (x / (panel[0] + GAP), x % (panel[0] + GAP));
            if x >= panel[0] {
                return [255; 4];
            }
            let [left, top] = self.corner;
            match number {
                0 => self.whole(drawn, x, y, panel),
                n => at([drawn, truth, heat][n - 1], left + x / ZOOM, top + y / ZOOM),
            }
        };
        Picture {
            width: size[0] as u32,
            height: size[1] as u32,
            rgba: (0..size[0] * size[1]).map(pixel).collect(),
        }
    }

    fn whole(&self, drawn: &Picture, x: usize, y: usize, panel: [usize; 2]) -> [u8; 4] {
        // As many pixels of the picture for one of the panel as it takes to hold it.
        let steps = |all: u32, panel: usize| all as f64 / panel as f64;
        let step = steps(drawn.width, panel[0]).max(steps(drawn.height, panel[1]));
        let [i, j] = [x, y].map(|v| (v as f64 * step) as usize);
        let on = |v: usize, from: usize, part: usize| {
            let (low, high) = (from as f64, (from + part) as f64);
            let (a, b) = (v as f64, v as f64 + step.max(1.0));
            (
                a >= low && a < high,
                a <= low && low < b || a < high && high <= b,
            )
        };
        let across = on(i, self.corner[0], PART[0]);
        let down = on(j, self.corner[1], PART[1]);
        if across.1 && down.0 || down.1 && across.0 {
            return FRAME;
        }
        at(drawn, i, j)
    }
}

/// The colour of pixel `k` over the ground.
fn on_ground(picture: &Picture, k: usize) -> [u8; 4] {
    match picture.rgba[k] {
        [_, _, _, 0] => GROUND,
        [r, g, b, _] => [r, g, b, 255],
    }
}

fn at(picture: &Picture, x: usize, y: usize) -> [u8; 4] {
    if x >= picture.width as usize || y >= picture.height as usize {
        return GROUND;
    }
    on_ground(picture, y * picture.width as usize + x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use revmap_files::Picture;

    #[test]
    fn the_worst_part_is_framed_and_shown() {
        let truth = Picture {
            width: 160,
            height: 120,
            rgba: vec![[100, 100, 100, 255]; 160 * 120],
        };
        let mut drawn = truth.clone();
        for (x, y) in [(100, 70), (102, 71), (104, 72)] {
            drawn.rgba[y * 160 + x] = [0, 0, 0, 0];
        }
        // Too little to be seen.
        drawn.rgba[0] = [110, 100, 100, 255];
        let spot = Spot::worst(&drawn, &truth);
        assert!(spot.seen > 0);
        let within = |v: usize, from: usize, part: usize| v >= from && v < from + part;
        assert!(within(100, spot.corner[0], PART[0]) && within(104, spot.corner[0], PART[0]));
        assert!(within(70, spot.corner[1], PART[1]) && within(72, spot.corner[1], PART[1]));
        let strip = spot.strip(&drawn, &truth, &truth);
        assert_eq!((strip.width, strip.height), (652, 120));
        let place = |x: usize, y: usize| {
            let (x, y) = (ZOOM * (x - spot.corner[0]), ZOOM * (y - spot.corner[1]));
            y * 652 + 164 + x
        };
        assert_eq!(strip.rgba[place(102, 71)], GROUND);
        assert_eq!(strip.rgba[place(102, 71) + 164], [100, 100, 100, 255]);
        assert!(strip.rgba.contains(&FRAME));
        assert_eq!(Spot::worst(&truth, &truth).seen, 0);
    }
}
