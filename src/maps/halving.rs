//! Mip chains: each level is the area average of the next larger one, down to one texel.

/// Levels from the largest down to 1 x 1, each of half the size of the one before, rounded down.
///
/// A texel is the mean of the texels that it covers in the larger level, weighted by covered area
/// (the exact box filter). An odd size makes that slightly more than two texels across. Nothing
/// drifts from level to level.
pub(super) fn chain<const N: usize>(
    width: usize,
    height: usize,
    base: Vec<[f32; N]>,
) -> Vec<(usize, usize, Vec<[f32; N]>)> {
    let mut levels = vec![(width, height, base)];
    while let Some((w, h, texels)) = levels.last()
        && (*w > 1 || *h > 1)
    {
        let (half_w, half_h) = ((w / 2).max(1), (h / 2).max(1));
        let narrow = shrink(texels, *w, half_w, *h, 1, *w);
        let small = shrink(&narrow, *h, half_h, half_w, half_w, 1);
        levels.push((half_w, half_h, small));
    }
    levels
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
) -> Vec<[f32; N]> {
    let ratio = from as f64 / to as f64;
    let mut out = vec![[0.0; N]; lines * to];
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
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_kept_on_every_level() {
        for (w, h) in [(8, 8), (7, 5), (1, 6), (13, 1), (720, 361)] {
            let base: Vec<[f32; 2]> = (0..w * h)
                .map(|k| [(k % 11) as f32, ((k * k) % 7) as f32])
                .collect();
            let mean = |texels: &[[f32; 2]]| {
                let n = texels.len() as f64;
                texels.iter().fold([0.0; 2], |m, t| {
                    [m[0] + f64::from(t[0]) / n, m[1] + f64::from(t[1]) / n]
                })
            };
            let expected = mean(&base);
            let levels = chain(w, h, base);
            assert_eq!(levels.len(), w.max(h).ilog2() as usize + 1);
            for (lw, lh, texels) in &levels {
                assert_eq!(lw * lh, texels.len());
                let got = mean(texels);
                assert!((got[0] - expected[0]).abs() < 1e-4 && (got[1] - expected[1]).abs() < 1e-4);
            }
            assert_eq!(levels.last().map(|l| (l.0, l.1)), Some((1, 1)));
        }
    }

    #[test]
    fn texels_stay_in_their_place() {
        let base: Vec<[f32; 1]> = (0..16).map(|k| [if k == 6 { 16.0 } else { 0.0 }]).collect();
        let levels = chain(4, 4, base);
        assert_eq!(levels[1].2, [[0.0], [4.0], [0.0], [0.0]]);
        let odd: Vec<[f32; 1]> = [0.0, 0.0, 3.0].map(|v| [v]).to_vec();
        assert_eq!(chain(3, 1, odd)[1].2, [[1.0]]);
    }
}
