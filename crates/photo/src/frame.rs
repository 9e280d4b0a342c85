//! An even frame round the photo.

use crate::Photo;

/// A frame is at most this part of the lesser side wide.
const WIDEST: f64 = 0.09;

/// Pixels to leave out: left, top, right, bottom.
pub(crate) fn margins(photo: &Photo) -> [u32; 4] {
    let (w, h) = (photo.width, photo.height);
    let most = (WIDEST * f64::from(w.min(h))) as u32;
    let grey = |x: u32, y: u32| {
        let [r, g, b, _] = photo.rgba[y as usize * w as usize + x as usize];
        (f64::from(r) + f64::from(g) + f64::from(b)) / 3.0
    };
    let line = |side: usize, k: u32| -> (f64, f64) {
        let along = if matches!(side, 0 | 2) { h } else { w };
        let values = (0..along)
            .step_by((along as usize / 256).max(1))
            .map(|i| match side {
                0 => grey(k, i),
                1 => grey(i, k),
                2 => grey(w - 1 - k, i),
                _ => grey(i, h - 1 - k),
            });
        let values: Vec<f64> = values.collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64;
        (mean, variance.sqrt())
    };
    let shades = [0, 1, 2, 3].map(|side| line(side, 0).0);
    let widths = [0, 1, 2, 3].map(|side| {
        let even = |k: &u32| {
            let (mean, spread) = line(side, *k);
            spread < 9.0 && (mean - shades[side]).abs() < 12.0
        };
        (0..most).take_while(even).count() as u32
    });
    let spread = |v: [f64; 4]| {
        v.into_iter().fold(f64::MIN, f64::max) - v.into_iter().fold(f64::MAX, f64::min)
    };
    let framed = widths.iter().all(|k| (2..most).contains(k)) && spread(shades) < 15.0;
    match framed {
        true => widths.map(|k| k + 3),
        false => [0; 4],
    }
}
