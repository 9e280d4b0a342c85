//! Mip chains: each level is the area average of the next larger one, down to one texel.

use crate::error::{Error, ErrorKind, Result};
use crate::host_memory;

/// What needs memory, in messages.
const TEXELS: &str = "the texels of a texture";

/// A level of a mip chain, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Level<T> {
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// `width * height` texels, row by row from the top.
    pub texels: Vec<T>,
}

impl<T> Level<T> {
    /// The same level with converted texels.
    pub(super) fn map<U>(&self, convert: impl Fn(&T) -> U) -> Result<Level<U>> {
        Ok(Level {
            width: self.width,
            height: self.height,
            texels: host_memory::collected(self.texels.iter().map(convert), TEXELS)?,
        })
    }
}

/// Texels across and down of the largest level.
pub(super) fn size<T>(levels: &[Level<T>]) -> [u32; 2] {
    levels.first().map_or([0, 0], |l| [l.width, l.height])
}

/// Refuses a list that does not hold one value for each texel.
pub(super) fn check_count(what: &str, count: usize, width: u32, height: u32) -> Result<()> {
    if count > 0 && count == width as usize * height as usize {
        return Ok(());
    }
    let message =
        format!("{count} {what} for {width} x {height} texels; give as many as there are texels");
    Err(Error::new(ErrorKind::Content, message))
}

/// Levels from the largest down to 1 x 1, each of half the size of the one before, rounded down.
///
/// A texel is the mean of the texels that it covers in the larger level, weighted by covered area
/// (the exact box filter). An odd size makes that slightly more than two texels across. Nothing
/// drifts from level to level.
pub(super) fn chain<const N: usize>(
    width: u32,
    height: u32,
    texels: Vec<[f32; N]>,
) -> Result<Vec<Level<[f32; N]>>> {
    let mut last = Level {
        width,
        height,
        texels,
    };
    let mut levels = Vec::new();
    while last.width > 1 || last.height > 1 {
        let [w, h] = [last.width, last.height].map(|n| n as usize);
        let (half_w, half_h) = ((w / 2).max(1), (h / 2).max(1));
        let narrow = shrink(&last.texels, w, half_w, h, 1, w)?;
        let next = Level {
            width: half_w as u32,
            height: half_h as u32,
            texels: shrink(&narrow, h, half_h, half_w, half_w, 1)?,
        };
        levels.push(std::mem::replace(&mut last, next));
    }
    levels.push(last);
    Ok(levels)
}

/// Averages `lines` lines of `from` texels to `to` each. A line's texels are `step` apart, and
/// lines `stride` apart; the result keeps that order.
fn shrink<const N: usize>(
    texels: &[[f32; N]],
    from: usize,
    to: usize,
    lines: usize,
    step: usize,
    stride: usize,
) -> Result<Vec<[f32; N]>> {
    let ratio = from as f64 / to as f64;
    let mut out = host_memory::filled(lines * to, [0.0; N], TEXELS)?;
    let out_stride = if step == 1 { to } else { stride };
    for k in 0..to {
        let (start, end) = (k as f64 * ratio, (k + 1) as f64 * ratio);
        for line in 0..lines {
            let mut sum = [0.0f64; N];
            for i in start as usize..(end.ceil() as usize).min(from) {
                let weight = end.min(i as f64 + 1.0) - start.max(i as f64);
                for (s, v) in sum.iter_mut().zip(texels[line * stride + i * step]) {
                    *s += weight * f64::from(v);
                }
            }
            out[line * out_stride + k * step] = sum.map(|s| (s / ratio) as f32);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_kept_on_every_level() {
        for (w, h) in [(8, 8), (7, 5), (1, 6), (13, 1), (720, 361)] {
            let base: Vec<[f32; 2]> = (0..u64::from(w * h))
                .map(|k| [(k % 11) as f32, ((k * k) % 7) as f32])
                .collect();
            let mean = |texels: &[[f32; 2]]| {
                let n = texels.len() as f64;
                texels.iter().fold([0.0; 2], |m, t| {
                    [m[0] + f64::from(t[0]) / n, m[1] + f64::from(t[1]) / n]
                })
            };
            let expected = mean(&base);
            let levels = chain(w, h, base).unwrap();
            assert_eq!(levels.len(), u32::max(w, h).ilog2() as usize + 1);
            for level in &levels {
                assert_eq!((level.width * level.height) as usize, level.texels.len());
                let got = mean(&level.texels);
                assert!((got[0] - expected[0]).abs() < 1e-4 && (got[1] - expected[1]).abs() < 1e-4);
            }
            assert_eq!(levels.last().map(|l| (l.width, l.height)), Some((1, 1)));
        }
    }

    #[test]
    fn texels_stay_in_their_place() {
        let base: Vec<[f32; 1]> = (0..16).map(|k| [if k == 6 { 16.0 } else { 0.0 }]).collect();
        let levels = chain(4, 4, base).unwrap();
        assert_eq!(levels[1].texels, [[0.0], [4.0], [0.0], [0.0]]);
        let odd: Vec<[f32; 1]> = [0.0, 0.0, 3.0].map(|v| [v]).to_vec();
        assert_eq!(chain(3, 1, odd).unwrap()[1].texels, [[1.0]]);
    }
}
