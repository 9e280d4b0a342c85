//! Cuts the shadow that a thing casts where it touches the table: a low lip about the foot, in the
//! ground's hue.

use crate::edge::{Halves, Sampler};
use crate::ground::{Backdrop, shade};

/// A lip is lower than this part of the thing's height.
const LOW: f64 = 0.04;
/// It protrudes by more than this many reduced pixels.
const PROTRUDES: f64 = 1.0;
/// Colours farther from the ground's hue are the thing's.
const HUE: f32 = 0.12;

/// A lip is shadow if more than this share of it has the ground's hue, and less than that of the thing.
const SHADOW: f64 = 0.7;
const THING: f64 = 0.2;

/// Lowers the radii of a lip to the side above it, if what protrudes has the hue of the ground and
/// the thing has not.
pub(crate) fn cut_shadow(halves: &mut Halves, sampler: &Sampler, backdrop: &Backdrop) {
    let radii = &halves.radii;
    let count = radii.len();
    let low = (LOW * count as f64) as usize;
    if low < 3 {
        return;
    }
    // The narrowest row above the largest rise.
    let (mut narrow, mut corner, mut rise) = (count - low, 0, PROTRUDES);
    for k in count - low..count {
        if radii[k] < radii[narrow] {
            narrow = k;
        }
        if radii[k] - radii[narrow] > rise {
            (corner, rise) = (narrow, radii[k] - radii[narrow]);
        }
    }
    if corner == 0 {
        return;
    }
    // The share of places in the hue of the ground, on both sides of the axis.
    let of_ground = |places: &[(usize, f64)]| {
        let is = |&(k, u): &(usize, f64)| {
            let across = halves.axis + halves.slope * k as f64 + u;
            let p = sampler.place([across, halves.top + halves.step * (k as f64 + 0.5)]);
            let (w, h) = (sampler.work.width, sampler.work.height);
            let [x, y] = [
                p[0].clamp(0.0, w as f64 - 1.0),
                p[1].clamp(0.0, h as f64 - 1.0),
            ];
            let i = y as usize * w + x as usize;
            shade(sampler.work, i, backdrop.lab[i]).1 < HUE
        };
        let both = places.iter().flat_map(|&(k, u)| [(k, u), (k, -u)]);
        let found = both.clone().filter(is).count();
        found as f64 / both.count().max(1) as f64
    };
    let limit = radii[corner];
    let lip: Vec<_> = (corner + 1..count)
        .filter(|&k| radii[k] > limit + PROTRUDES)
        .map(|k| (k, 0.5 * (radii[k] + limit) + 0.5))
        .collect();
    let body: Vec<_> = (corner - 2 * low..corner - low)
        .flat_map(|k| [(k, 0.5 * radii[k]), (k, 0.8 * radii[k])])
        .collect();
    if of_ground(&lip) > SHADOW && of_ground(&body) < THING {
        for r in &mut halves.radii[corner..] {
            *r = r.min(limit);
        }
    }
}
