//! Masks: thresholds, parts and holes.

use image::{GrayImage, Luma, imageops};
use imageproc::contrast::otsu_level;
use imageproc::distance_transform::Norm;
use imageproc::morphology::{close, open};
use imageproc::region_labelling::{Connectivity, connected_components};

/// 255 in the thing, 0 elsewhere.
pub(crate) type Mask = GrayImage;

const SOLID: Luma<u8> = Luma([255]);
const EMPTY: Luma<u8> = Luma([0]);
/// Pixels of blank border beside a mask while holes are closed.
const BORDER: u32 = 6;

pub(crate) fn mask(width: usize, height: usize, is: impl Fn(usize) -> bool) -> Mask {
    let at = |x: u32, y: u32| is(y as usize * width + x as usize);
    let value = |x, y| if at(x, y) { SOLID } else { EMPTY };
    Mask::from_fn(width as u32, height as u32, value)
}

pub(crate) fn count(mask: &Mask) -> usize {
    mask.as_raw().iter().filter(|v| **v > 0).count()
}

/// Intersection over union.
pub(crate) fn likeness(a: &Mask, b: &Mask) -> f64 {
    let (mut both, mut either) = (0usize, 0usize);
    for (a, b) in a.as_raw().iter().zip(b.as_raw()) {
        both += usize::from(a & b > 0);
        either += usize::from(a | b > 0);
    }
    both as f64 / either.max(1) as f64
}

/// Otsu's threshold of distances.
pub(crate) fn otsu(distances: &[f32], width: usize) -> f32 {
    let mut sorted = distances.to_vec();
    let at = sorted.len() - 1 - sorted.len() / 500;
    let top = sorted
        .select_nth_unstable_by(at, f32::total_cmp)
        .1
        .max(1e-6);
    let levels = distances
        .iter()
        .map(|d| (d / top * 255.0).clamp(0.0, 255.0) as u8);
    let rows = (distances.len() / width) as u32;
    let image = GrayImage::from_raw(width as u32, rows, levels.collect());
    image.map_or(top, |image| f32::from(otsu_level(&image)) / 255.0 * top)
}

/// The thing of a mask: specks and cracks removed, the largest part taken, holes filled.
pub(crate) fn cleaned(rough: &Mask) -> (Mask, usize) {
    let (w, h) = rough.dimensions();
    let mut wide = Mask::new(w + 2 * BORDER, h + 2 * BORDER);
    let opened = open(rough, Norm::L1, 1);
    imageops::replace(&mut wide, &opened, BORDER.into(), BORDER.into());
    let closed = close(&wide, Norm::L1, 3);
    largest(&imageops::crop_imm(&closed, BORDER, BORDER, w, h).to_image())
}

#[derive(Clone)]
struct Part {
    area: f64,
    low: [f64; 2],
    high: [f64; 2],
    sum: f64,
}

impl Part {
    fn width(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    fn middle(&self) -> f64 {
        0.5 * (self.high[0] + self.low[0])
    }

    fn mean(&self) -> f64 {
        self.sum / self.area
    }
}

/// The largest part and those above and below it on its axis, holes filled; and how many large
/// parts were left out.
pub(crate) fn largest(mask: &Mask) -> (Mask, usize) {
    let labels = connected_components(mask, Connectivity::Eight, EMPTY);
    let (w, h) = (f64::from(mask.width()), f64::from(mask.height()));
    let mut parts: Vec<Part> = Vec::new();
    for (x, y, label) in labels.enumerate_pixels() {
        let Some(index) = (label.0[0] as usize).checked_sub(1) else {
            continue;
        };
        if parts.len() <= index {
            let none = Part {
                area: 0.0,
                low: [f64::MAX; 2],
                high: [0.0; 2],
                sum: 0.0,
            };
            parts.resize(index + 1, none);
        }
        let part = &mut parts[index];
        let (x, y) = (f64::from(x), f64::from(y));
        part.area += 1.0;
        part.sum += x;
        part.low = [part.low[0].min(x), part.low[1].min(y)];
        part.high = [part.high[0].max(x + 1.0), part.high[1].max(y + 1.0)];
    }
    let weight = |p: &Part| p.area * (1.0 - 0.3 * (p.mean() / w - 0.5).abs());
    let heaviest = |a: &&Part, b: &&Part| weight(a).total_cmp(&weight(b));
    let Some(main) = parts.iter().max_by(heaviest).cloned() else {
        return (mask.clone(), 0);
    };
    let with = |p: &Part| {
        p.area > 0.01 * main.area
            && (p.middle() - main.middle()).abs() < 0.03 * w
            && (p.mean() - main.mean()).abs() < 0.03 * w
            && (0.12..2.5).contains(&(p.width() / main.width()))
    };
    let taken: Vec<bool> = parts
        .iter()
        .map(|p| p.low == main.low && p.high == main.high || with(p))
        .collect();
    let aside = |(p, taken): (&Part, &bool)| {
        !taken
            && p.area > 0.06 * main.area
            && p.low[0] > 1.0
            && p.high[0] < w - 1.0
            && p.low[1] > 1.0
            && p.high[1] < h - 1.0
    };
    let left_out = parts.iter().zip(&taken).filter(|p| aside(*p)).count();
    let is_taken = |label: u32| label > 0 && taken[label as usize - 1];
    let raw = labels.as_raw();
    let mut mask = self::mask(mask.width() as usize, mask.height() as usize, |i| {
        is_taken(raw[i])
    });
    if taken.iter().filter(|t| **t).count() > 1 {
        join_rows(&mut mask);
    }
    fill(&mut mask);
    (mask, left_out)
}

/// Fills empty rows between parts, from the rows above and below.
fn join_rows(mask: &mut Mask) {
    let (w, h) = mask.dimensions();
    let ends = |y: u32| -> Option<[u32; 2]> {
        let solid = |x: &u32| mask.get_pixel(*x, y).0[0] > 0;
        Some([(0..w).find(solid)?, (0..w).rev().find(solid)?])
    };
    let rows: Vec<_> = (0..h).map(ends).collect();
    let mut above = None;
    for (y, row) in rows.iter().enumerate() {
        if row.is_some() {
            above = Some(y);
            continue;
        }
        let below = (y..rows.len()).find(|k| rows[*k].is_some());
        let (Some(a), Some(b)) = (above, below) else {
            continue;
        };
        let (Some(p), Some(q)) = (rows[a], rows[b]) else {
            continue;
        };
        let t = (y - a) as f64 / (b - a) as f64;
        let [from, to] = [0, 1].map(|i| (f64::from(p[i]) * (1.0 - t) + f64::from(q[i]) * t) as u32);
        (from..=to).for_each(|x| mask.put_pixel(x, y as u32, SOLID));
    }
}

fn fill(mask: &mut Mask) {
    let (w, h) = mask.dimensions();
    let mut wide = Mask::new(w + 2, h + 2);
    imageops::replace(&mut wide, mask, 1, 1);
    let labels = connected_components(&wide, Connectivity::Four, SOLID);
    let outside = labels.get_pixel(0, 0).0;
    for (x, y, pixel) in mask.enumerate_pixels_mut() {
        if labels.get_pixel(x + 1, y + 1).0 != outside {
            *pixel = SOLID;
        }
    }
}

/// The part of a mask that its mirror image has, too. `mirror`: the mirror image of a pixel's centre.
pub(crate) fn shared(mask: &Mask, mirror: impl Fn([f64; 2]) -> [f64; 2]) -> Mask {
    let (w, h) = mask.dimensions();
    let is = |x: u32, y: u32| mask.get_pixel(x, y).0[0] > 0;
    let mirrored = |x: u32, y: u32| {
        let [x, y] = mirror([f64::from(x) + 0.5, f64::from(y) + 0.5]).map(f64::floor);
        x >= 0.0 && y >= 0.0 && x < f64::from(w) && y < f64::from(h) && is(x as u32, y as u32)
    };
    let both = self::mask(w as usize, h as usize, |i| {
        let (x, y) = (i as u32 % w, i as u32 / w);
        is(x, y) && mirrored(x, y)
    });
    largest(&open(&both, Norm::L1, 1)).0
}
