//! Drawings: pictures of two greys, which are no photographs.

use crate::Photo;

/// Levels of 255 that a pixel may be from one of the two greys, and its channels from each other.
const NEAR: i32 = 20;
/// Part of the pixels that may be neither near a grey nor on an edge between both.
const FEW: f64 = 0.01;
/// Pixels that are looked at.
const MOST: f64 = 1e6;

/// Returns true if the picture has no colour, and if at least 99 % of its pixels over white are near
/// two greys, or have pixels near both greys beside them.
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
    let at = |x: usize, y: usize| {
        let grey = grey(photo.rgba[y * w + x]).0;
        [(grey - first).abs() <= NEAR, (grey - second).abs() <= NEAR]
    };
    let on_edge = |x: usize, y: usize| {
        let mut both = [false; 2];
        for y in y.saturating_sub(1)..(y + 2).min(h) {
            for x in x.saturating_sub(1)..(x + 2).min(w) {
                let near = at(x, y);
                both = [both[0] | near[0], both[1] | near[1]];
            }
        }
        both == [true; 2]
    };
    let strange = places().filter(|&(x, y)| at(x, y) == [false; 2] && !on_edge(x, y));
    strange.count() as f64 <= most
}
