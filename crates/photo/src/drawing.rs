//! Drawings: pictures of two greys, which are no photographs.

use crate::Photo;

/// Levels of 255 that a pixel may be from one of the two greys, and its channels from each other.
const NEAR: i32 = 20;
/// Levels that the mean of 5 x 5 pixels near one grey may be from it: noise is averaged away, and
/// light that changes is not.
const EVEN: i32 = 7;
/// Part of the pixels that may be neither near a grey nor on an edge between both.
const FEW: f64 = 0.01;
/// Pixels that are looked at.
const MOST: f64 = 3e5;

/// Returns true if the picture has no colour, and if at least 99 % of its pixels over white are near
/// two even greys, or have pixels near both greys beside them.
#[must_use]
pub fn is_drawing(photo: &Photo) -> bool {
    let (w, h) = (photo.width as usize, photo.height as usize);
    let over =
        |[r, g, b, a]: [u8; 4]| [r, g, b].map(|v| 255 - (255 - i32::from(v)) * i32::from(a) / 255);
    let mut counts = [0u32; 256];
    let mut colored = 0;
    let grey = |p: [u8; 4]| {
        let [r, g, b] = over(p);
        let range = r.max(g).max(b) - r.min(g).min(b);
        ((r + g + b) / 3, range > NEAR)
    };
    let step = (photo.rgba.len() as f64 / MOST).sqrt().ceil() as usize;
    let places = || {
        (0..h)
            .step_by(step)
            .flat_map(|y| (0..w).step_by(step).map(move |x| (x, y)))
    };
    let most = FEW * places().count() as f64;
    for (x, y) in places() {
        let (grey, is_colored) = grey(photo.rgba[y * w + x]);
        counts[grey.clamp(0, 255) as usize] += 1;
        colored += u32::from(is_colored);
    }
    if f64::from(colored) > most {
        return false;
    }
    // The two greys: the peaks of the counts in a window.
    let near = |k: i32| -> u32 {
        let window = (k - NEAR / 2).max(0)..=(k + NEAR / 2).min(255);
        window.map(|i| counts[i as usize]).sum()
    };
    let peak = |other: Option<i32>| {
        let far = (0..256).filter(|k| other.is_none_or(|o| (k - o).abs() > 2 * NEAR));
        far.max_by_key(|k| near(*k))
    };
    let first = peak(None);
    let (Some(first), Some(second)) = (first, peak(first)) else {
        return false;
    };
    // The mean of what is near a peak is less moved by noise.
    let shades = [first, second].map(|peak| {
        let near = (peak - NEAR).max(0)..=(peak + NEAR).min(255);
        let count: u32 = near.clone().map(|k| counts[k as usize]).sum();
        let sum: u32 = near.map(|k| k as u32 * counts[k as usize]).sum();
        (sum / count.max(1)) as i32
    });
    let strange = places().filter(|&(x, y)| {
        let near = |y: usize, most: usize| y.saturating_sub(2)..(y + 3).min(most);
        let around = near(y, h).flat_map(|j| near(x, w).map(move |i| (i, j)));
        let (mut next, mut own, mut mean) = ([0, 0], [false; 2], [0, 0]);
        for (i, j) in around {
            let grey = grey(photo.rgba[j * w + i]).0;
            let is = shades.map(|shade| (grey - shade).abs() <= NEAR);
            let beside = i.abs_diff(x) <= 1 && j.abs_diff(y) <= 1;
            (0..2).for_each(|k| next[k] += usize::from(is[k] && beside));
            (0..2).for_each(|k| mean[k] += if is[k] { grey } else { i32::MIN / 64 });
            if (i, j) == (x, y) {
                own = is;
            }
        }
        let count = (near(x, w).len() * near(y, h).len()) as i32;
        let on_edge = next[0] > 0 && next[1] > 0;
        let uneven = |k: usize| mean[k] > 0 && (mean[k] / count - shades[k]).abs() > EVEN;
        own == [false; 2] && !on_edge || uneven(0) || uneven(1)
    });
    strange.count() as f64 <= most
}
