//! Random outlines with short edges, thin rims, slots and fins.

use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// A random outline: half a star, a ring, discs, any polygon, a body with slots or one with fins.
/// Some of its corners are cut off by edges of 0.0001 to 0.05. `kind` is 0 to 5; `random` gives
/// numbers from 0 to 1.
pub fn outline(kind: u64, random: &mut dyn FnMut() -> f64) -> Vec<[f64; 2]> {
    let mut within = |low: f64, high: f64| low + (high - low) * random();
    let n = within(3.0, 9.0) as usize;
    let turn = |k: usize, all: f64| DVec2::from_angle(all * k as f64 / n as f64);
    let mut points: Vec<DVec2> = match kind {
        0 => (0..=n)
            .map(|k| {
                let p = within(0.15, 0.48) * turn(k, PI).rotate(DVec2::NEG_Y);
                let r = if k == 0 || k == n { 0.0 } else { p.x };
                DVec2::new(r, 0.5 + p.y)
            })
            .collect(),
        1 => (0..n)
            .map(|k| DVec2::new(0.26, 0.5) + within(0.05, 0.22) * turn(k, TAU))
            .collect(),
        2 => {
            let mut points = vec![DVec2::new(0.0, 0.04)];
            for k in 0..n {
                let z = 0.04 + 0.9 * k as f64 / n as f64;
                points.push(DVec2::new(within(0.08, 0.46), z));
                points.push(DVec2::new(within(0.08, 0.46), z + 0.9 / n as f64));
            }
            points.push(DVec2::new(0.0, 0.94));
            points
        }
        3 => (0..n.min(6))
            .map(|_| DVec2::new(within(0.0, 0.48), within(0.02, 0.98)))
            .collect(),
        _ => {
            let (bore, tilt) = (within(-0.1, 0.1).max(0.0), within(-0.1, 0.1));
            let (r, low, high) = (within(0.3, 0.45), within(0.1, 0.3), within(0.6, 0.9));
            vec![
                DVec2::new(bore, low),
                DVec2::new(r, low + tilt),
                DVec2::new(r + tilt, high),
                DVec2::new(bore, high + tilt),
            ]
        }
    };
    for _ in 0..if kind >= 4 { 2 } else { 0 } {
        let k = within(0.0, points.len() as f64) as usize;
        let (a, b) = (points[k], points[(k + 1) % points.len()]);
        if a.x + b.x == 0.0 || a.distance(b) < 0.05 {
            continue;
        }
        // Slots go into the solid, fins out of it.
        let depth = within(0.01, 0.1) * if kind == 4 { 1.0 } else { -1.0 };
        let tip = depth * (b - a).perp().normalize() + within(-0.15, 0.15) * (b - a);
        let from = within(0.2, 0.8);
        let to = from + within(-7.0, -3.5).exp() / a.distance(b);
        let [p, q] = [from, to.min(0.95)].map(|part| a.lerp(b, part));
        let sharp = within(0.0, 1.0) < 0.4;
        let added = [p, p + tip, if sharp { p + tip } else { q + tip }, q];
        points.splice(k + 1..k + 1, added.map(|p| p.max(DVec2::ZERO)));
    }
    for _ in 0..if kind < 4 { 3 } else { 1 } {
        let count = points.len();
        let k = within(0.0, count as f64) as usize;
        let (before, here, next) = (
            points[(k + count - 1) % count],
            points[k],
            points[(k + 1) % count],
        );
        if here.x > 0.0 {
            let length = within(1e-4f64.ln(), 0.05f64.ln()).exp();
            let towards = |other: DVec2, part: f64| {
                let most = 0.4 * other.distance(here);
                here + (other - here).normalize_or_zero() * length.min(most) * part
            };
            let part = within(0.0, 1.0);
            points.splice(k..=k, [towards(before, part), towards(next, 1.0)]);
        }
    }
    points.into_iter().map(Into::into).collect()
}
