//! FLIP: how different two pictures look when one flips from one to the other.
//!
//! After Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, *FLIP: A Difference
//! Evaluator for Alternating Images*, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020 (the LDR
//! form), written from the article. The bindings to its authors' program take colours in 8 bits,
//! which hide small errors; a test holds this code to that program's figures.

use glam::{DMat3, DVec3};
use rayon::prelude::*;
use revmap::frame::Frame;
use std::f64::consts::PI;

/// FLIP of every pixel, 0 to 1, row 0 on top.
///
/// Colours are laid over black, clamped to `[0, 1]` (what a PNG would keep, without its rounding)
/// and seen at `pixels_per_degree`. The frames must be of one size; else the list is empty.
pub fn flip_map(reference: &Frame, frame: &Frame, pixels_per_degree: f64) -> Vec<f32> {
    Eye::on(reference, pixels_per_degree).flip(frame)
}

/// An eye on a reference, which it takes in once for any number of frames.
pub(super) struct Eye {
    colors: Colors,
    sight: Sight,
    size: (usize, usize),
    reference: Vec<Seen>,
}

impl Eye {
    pub(super) fn on(reference: &Frame, pixels_per_degree: f64) -> Self {
        let (colors, sight) = (Colors::new(), Sight::new(pixels_per_degree));
        let size = (reference.width as usize, reference.height as usize);
        let reference = sight.look(&colors, &reference.color, size);
        Self {
            colors,
            sight,
            size,
            reference,
        }
    }

    /// FLIP of every pixel; empty where the frame has another size.
    pub(super) fn flip(&self, frame: &Frame) -> Vec<f32> {
        if self.size != (frame.width as usize, frame.height as usize) {
            return Vec::new();
        }
        let frame = self.sight.look(&self.colors, &frame.color, self.size);
        let most = self.colors.most_different();
        let seen = self.reference.par_iter().zip(frame);
        let flip = seen.map(|(a, b)| {
            let color = redistribute(hyab(a.lab, b.lab).powf(COLOR_EXPONENT), most);
            let feature = (a.edge - b.edge).abs().max((a.point - b.point).abs());
            let feature = (feature / std::f64::consts::SQRT_2).powf(FEATURE_EXPONENT);
            color.powf(1.0 - feature) as f32
        });
        flip.collect()
    }
}

/// The mean of FLIP over a picture, of a map from [`flip_map`]; 0 of an empty one.
pub fn mean_flip(map: &[f32]) -> f64 {
    map.iter().map(|&v| f64::from(v)).sum::<f64>() / map.len().max(1) as f64
}

const COLOR_EXPONENT: f64 = 0.7;
const FEATURE_EXPONENT: f64 = 0.5;

/// A pixel as the eye takes it in.
struct Seen {
    /// CIELAB after the Hunt effect, filtered by contrast sensitivity.
    lab: DVec3,
    /// Strength of edges and of points in the brightness.
    edge: f64,
    point: f64,
}

/// Linear sRGB, XYZ and what lies beyond.
struct Colors {
    xyz_from_rgb: DMat3,
    rgb_from_xyz: DMat3,
    white: DVec3,
}

impl Colors {
    fn new() -> Self {
        // The matrix of the sRGB primaries and D65, as exact fractions.
        let rows = [
            DVec3::new(10_135_552.0, 8_788_810.0, 4_435_075.0) / 24_577_794.0,
            DVec3::new(2_613_072.0, 8_788_810.0, 887_015.0) / 12_288_897.0,
            DVec3::new(1_425_312.0, 8_788_810.0, 70_074_185.0) / 73_733_382.0,
        ];
        let xyz_from_rgb = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
        Self {
            xyz_from_rgb,
            rgb_from_xyz: xyz_from_rgb.inverse(),
            white: xyz_from_rgb * DVec3::ONE,
        }
    }

    /// A linear opponent space: brightness, red-green, blue-yellow.
    fn opponent(&self, rgb: DVec3) -> DVec3 {
        let q = self.xyz_from_rgb * rgb / self.white;
        DVec3::new(116.0 * q.y - 16.0, 500.0 * (q.x - q.y), 200.0 * (q.y - q.z))
    }

    fn rgb_of_opponent(&self, c: DVec3) -> DVec3 {
        let y = (c.x + 16.0) / 116.0;
        self.rgb_from_xyz * (DVec3::new(y + c.y / 500.0, y, y - c.z / 200.0) * self.white)
    }

    /// CIELAB, its chroma weighed by lightness (Hunt: colours fade in the dark).
    fn hunt_lab(&self, rgb: DVec3) -> DVec3 {
        let bend = 6.0f64 / 29.0;
        let f = |q: f64| match q > bend.powi(3) {
            true => q.cbrt(),
            false => q / (3.0 * bend * bend) + 4.0 / 29.0,
        };
        let DVec3 { x, y, z } = (self.xyz_from_rgb * rgb / self.white).map(f);
        let lightness = 116.0 * y - 16.0;
        let chroma = 0.01 * lightness;
        let [a, b] = [500.0 * (x - y), 200.0 * (y - z)];
        DVec3::new(lightness, chroma * a, chroma * b)
    }

    /// The largest colour difference of the gamut, green against blue.
    fn most_different(&self) -> f64 {
        hyab(self.hunt_lab(DVec3::Y), self.hunt_lab(DVec3::Z)).powf(COLOR_EXPONENT)
    }
}

/// The distance of Abasi and others (2020): city block in lightness, Euclidean in chroma.
fn hyab(a: DVec3, b: DVec3) -> f64 {
    (a.x - b.x).abs() + (a.y - b.y).hypot(a.z - b.z)
}

/// Small differences take the larger part of the scale.
fn redistribute(difference: f64, most: f64) -> f64 {
    let (knee, share) = (0.4 * most, 0.95);
    if difference < knee {
        difference * share / knee
    } else {
        share + (difference - knee) / (most - knee) * (1.0 - share)
    }
}

/// The filters of one viewing distance, as rows of weights from `-radius` to `radius`.
struct Sight {
    /// Per opponent channel: sums of separable Gaussians, `(weight, row)`, whose whole sums to 1.
    contrast: [Vec<(f64, Vec<f64>)>; 3],
    gauss: Vec<f64>,
    edge: Vec<f64>,
    point: Vec<f64>,
}

impl Sight {
    fn new(ppd: f64) -> Self {
        let row = |radius: f64, f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            let n = radius as i64;
            (-n..=n).map(|x| f(x as f64)).collect()
        };
        // Contrast sensitivity: `a sqrt(pi / b) exp(-pi^2 x^2 / b)`, x in degrees.
        let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * ppd).ceil();
        let contrast = [
            vec![(1.0, 0.0047)],
            vec![(1.0, 0.0053)],
            vec![(34.1, 0.04), (13.5, 0.025)],
        ]
        .map(|sum| {
            let parts = sum.into_iter().map(|(a, b): (f64, f64)| {
                let line = row(radius, &|x| (-(PI * x / ppd).powi(2) / b).exp());
                (a * (PI / b).sqrt(), line)
            });
            let mut parts: Vec<(f64, Vec<f64>)> = parts.collect();
            let whole = |(w, line): &(f64, Vec<f64>)| w * line.iter().sum::<f64>().powi(2);
            let total: f64 = parts.iter().map(whole).sum();
            parts.iter_mut().for_each(|(w, _)| *w /= total);
            parts
        });
        // Edges and points: derivatives of a Gaussian as wide as what the eye takes for an edge.
        let sigma = 0.5 * 0.082 * ppd;
        let radius = (3.0 * sigma).ceil();
        let bell = |x: f64| (-x * x / (2.0 * sigma * sigma)).exp();
        let gauss = row(radius, &bell);
        let across: f64 = gauss.iter().sum();
        let balanced = |mut line: Vec<f64>| {
            // Positive and negative weights sum to 1 and -1, over the whole square.
            let up: f64 = across * line.iter().filter(|w| **w > 0.0).sum::<f64>();
            let down: f64 = -across * line.iter().filter(|w| **w < 0.0).sum::<f64>();
            line.iter_mut()
                .for_each(|w| *w /= if *w > 0.0 { up } else { down });
            line
        };
        let edge = balanced(row(radius, &|x| -x * bell(x)));
        let point = balanced(row(radius, &|x| (x * x / (sigma * sigma) - 1.0) * bell(x)));
        Self {
            contrast,
            gauss,
            edge,
            point,
        }
    }

    fn look(&self, colors: &Colors, rgba: &[[f32; 4]], size: (usize, usize)) -> Vec<Seen> {
        let opponent = rgba.par_iter().map(|&c| colors.opponent(over_black(c)));
        let opponent: Vec<DVec3> = opponent.collect();
        let plane = |c: usize| opponent.iter().map(|v| v[c]).collect();
        let planes: [Vec<f64>; 3] = std::array::from_fn(plane);
        let filtered: [Vec<f64>; 3] = std::array::from_fn(|c| {
            let mut sum = vec![0.0; planes[c].len()];
            for (weight, line) in &self.contrast[c] {
                let part = separable(&planes[c], size, line, line);
                sum.iter_mut().zip(part).for_each(|(s, p)| *s += weight * p);
            }
            sum
        });
        let brightness: Vec<f64> = planes[0].iter().map(|y| (y + 16.0) / 116.0).collect();
        let strength = |line: &[f64]| -> Vec<f64> {
            let x = separable(&brightness, size, line, &self.gauss);
            let y = separable(&brightness, size, &self.gauss, line);
            x.into_iter().zip(y).map(|(x, y)| x.hypot(y)).collect()
        };
        let (edge, point) = (strength(&self.edge), strength(&self.point));
        let seen = |k: usize| {
            let c = DVec3::new(filtered[0][k], filtered[1][k], filtered[2][k]);
            let rgb = colors.rgb_of_opponent(c).clamp(DVec3::ZERO, DVec3::ONE);
            Seen {
                lab: colors.hunt_lab(rgb),
                edge: edge[k],
                point: point[k],
            }
        };
        (0..rgba.len()).into_par_iter().map(seen).collect()
    }
}

fn over_black([r, g, b, a]: [f32; 4]) -> DVec3 {
    // No number is black.
    let cut = |v: f32| f64::from(v.max(0.0)).min(1.0);
    DVec3::new(cut(r), cut(g), cut(b)) * cut(a)
}

/// Filters along rows, then along columns; beyond the picture its border goes on.
fn separable(plane: &[f64], (w, h): (usize, usize), along_x: &[f64], along_y: &[f64]) -> Vec<f64> {
    let (rx, ry) = (along_x.len() / 2, along_y.len() / 2);
    let add = |out: &mut [f64], weight: f64, line: &[f64]| {
        let pairs = out.iter_mut().zip(line);
        pairs.for_each(|(v, l)| *v += weight * l);
    };
    let mut rows = vec![0.0; plane.len()];
    let lines = rows.par_chunks_mut(w).zip(plane.par_chunks(w));
    lines.for_each(|(out, line)| {
        // The line with its border going on, so that each weight meets all of it at once.
        let inside = |x: usize| line[x.saturating_sub(rx).min(w - 1)];
        let wide: Vec<f64> = (0..w + 2 * rx).map(inside).collect();
        for (weight, moved) in along_x.iter().zip(wide.windows(w)) {
            add(out, *weight, moved);
        }
    });
    let mut out = vec![0.0; plane.len()];
    out.par_chunks_mut(w).enumerate().for_each(|(y, line)| {
        for (k, weight) in along_y.iter().enumerate() {
            let from = (y + k).saturating_sub(ry).min(h - 1) * w;
            add(line, *weight, &rows[from..from + w]);
        }
    });
    out
}

#[cfg(test)]
mod tests;
