//! What the ground may be, and how far every pixel is from it.

use crate::work::{Color, Work, distance, linear_of, median};
use nalgebra::{Matrix6, Vector6};
use rayon::prelude::*;

/// The model of a ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Every row between the colours of its two ends: a table's edge vanishes.
    Rows,
    /// A quadratic in both directions, fitted to the border: uneven light.
    Smooth,
    /// Every row has the colour of its left or right end: the thing is cut by the other one.
    OneSide,
    /// The picture is transparent there.
    Transparent,
}

/// The colours of a ground, row by row.
pub(crate) struct Backdrop {
    pub ground: Ground,
    pub lab: Vec<Color>,
}

pub(crate) fn backdrops(work: &Work) -> Vec<Backdrop> {
    let (w, h) = (work.width, work.height);
    let strip = (w / 50).max(3);
    let side = |from: usize| -> Vec<Color> {
        let row = |y: usize| median_color((from..from + strip).map(|x| work.color(x, y)));
        let rows: Vec<Color> = (0..h).map(row).collect();
        let near = |y: usize| median_color((y.saturating_sub(3)..(y + 4).min(h)).map(|k| rows[k]));
        (0..h).map(near).collect()
    };
    let (left, right) = (side(0), side(w - strip));
    let of = |ground, at: &dyn Fn(usize, usize) -> Color| Backdrop {
        ground,
        lab: (0..h * w).map(|i| at(i % w, i / w)).collect(),
    };
    let between = |x: usize, y: usize| {
        let t = x as f32 / (w - 1) as f32;
        std::array::from_fn(|i| left[y][i] * (1.0 - t) + right[y][i] * t)
    };
    let mut found = vec![of(Ground::Rows, &between)];
    let fit = quadratic(work);
    let fitted = |x: usize, y: usize| {
        let terms = terms(x, y, work);
        std::array::from_fn(|i| terms.dot(&fit[i]) as f32)
    };
    found.push(of(Ground::Smooth, &fitted));
    let apart = (0..h).filter(|&y| distance(left[y], right[y]) > 15.0);
    if apart.count() * 10 > h {
        found.push(of(Ground::OneSide, &|_, y| left[y]));
        found.push(of(Ground::OneSide, &|_, y| right[y]));
    }
    found
}

pub(crate) fn median_color(colors: impl Iterator<Item = Color> + Clone) -> Color {
    std::array::from_fn(|i| median(&mut colors.clone().map(|c| c[i]).collect::<Vec<_>>()))
}

fn terms(x: usize, y: usize, work: &Work) -> Vector6<f64> {
    let x = 2.0 * x as f64 / work.width as f64 - 1.0;
    let y = 2.0 * y as f64 / work.height as f64 - 1.0;
    Vector6::new(1.0, x, y, x * x, x * y, y * y)
}

/// Coefficients of a quadratic for each channel. Pixels of the border that are far from it count
/// less (iterated least squares with Cauchy's weights).
fn quadratic(work: &Work) -> [Vector6<f64>; 3] {
    let (w, h) = (work.width, work.height);
    let rim = (w / 20).max(3);
    let inner =
        |x: usize, y: usize| (rim..w - rim).contains(&x) && (rim.min(h / 2)..h).contains(&y);
    let places = (0..w * h).map(|i| (i % w, i / w));
    let places = places.filter(|&(x, y)| !inner(x, y)).step_by(5);
    let sample = |(x, y)| (terms(x, y, work), work.color(x, y));
    let samples: Vec<_> = places.map(sample).collect();
    let mut weights = vec![1.0f64; samples.len()];
    let mut fit = [Vector6::zeros(); 3];
    for _ in 0..10 {
        let mut matrix = Matrix6::identity() * 1e-6;
        let mut sides = [Vector6::zeros(); 3];
        for ((terms, color), weight) in samples.iter().zip(&weights) {
            matrix += terms * terms.transpose() * *weight;
            for i in 0..3 {
                sides[i] += terms * (f64::from(color[i]) * weight);
            }
        }
        let Some(factors) = matrix.cholesky() else {
            return fit;
        };
        fit = sides.map(|side| factors.solve(&side));
        let away = |(terms, color): &(Vector6<f64>, Color)| {
            distance(*color, std::array::from_fn(|i| terms.dot(&fit[i]) as f32))
        };
        let away: Vec<f32> = samples.iter().map(away).collect();
        let spread = 3.0 * median(&mut away.clone()) + 2e-3;
        let weight = |e: &f32| 1.0 / (1.0 + f64::from(e / spread).powi(2)).powi(2);
        weights = away.iter().map(weight).collect();
    }
    fit
}

/// The light of a pixel over that of a ground, and how far its hue is from the ground's.
pub(crate) fn shade(work: &Work, i: usize, ground: Color) -> (f32, f32) {
    let (x, y) = ((i % work.width) as u32, (i / work.width) as u32);
    let (own, lit) = (work.linear.get_pixel(x, y).0, linear_of(ground));
    let ratio: Color =
        std::array::from_fn(|k| ((own[k] + 2e-3) / (lit[k] + 2e-3)).clamp(1e-3, 20.0));
    let light = (ratio[0] + ratio[1] + ratio[2]) / 3.0;
    (light, distance(ratio.map(|v| (v / light).ln()), [0.0; 3]))
}

/// Distances of all pixels from a ground, by what counts as a difference: all; colour, with little
/// lightness; all, without what is darker than the ground in its hue, and soft; all, without what is
/// a little darker than the ground in its hue.
pub(crate) fn distances(work: &Work, backdrop: &Backdrop) -> [Vec<f32>; 4] {
    let ramp = |v: f32, from: f32, width: f32| ((v - from) / width).clamp(0.0, 1.0);
    let at = |i: usize| -> [f32; 4] {
        let (x, y) = ((i % work.width) as u32, (i / work.width) as u32);
        let (color, ground) = (work.lab.get_pixel(x, y).0, backdrop.lab[i]);
        let all = distance(color, ground);
        let hue = distance(
            [0.3 * color[0], color[1], color[2]],
            [0.3 * ground[0], ground[1], ground[2]],
        );
        let (light, tint) = shade(work, i, ground);
        let smooth = work.gradient[i] < 4.0 + 2.0 * work.noise;
        let shadow =
            ramp(1.02 - light, 0.0, 0.03) * ramp(light, 0.12, 0.05) * ramp(0.16 - tint, 0.0, 0.05);
        let shadow = if smooth { shadow } else { 0.0 };
        let soft =
            ramp(1.03 - light, 0.0, 0.03) * ramp(light, 0.45, 0.1) * ramp(0.12 - tint, 0.0, 0.04);
        [all, hue, all * (1.0 - shadow), all * (1.0 - soft)]
    };
    let pixels = (0..work.width * work.height).into_par_iter();
    let all: Vec<[f32; 4]> = pixels.map(at).collect();
    std::array::from_fn(|k| all.iter().map(|d| d[k]).collect())
}
