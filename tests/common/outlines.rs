//! Random outlines with short edges, thin rims, slots and fins.

use super::random::Random;
use glam::DVec2;

/// A random outline: a polygon of [`Random::polygon`] (0, 1, 3), cones on top of each other (2), or
/// a body with slots (4) or with fins (5). Some of its corners are cut off by edges of 0.0001 to
/// 0.05.
pub fn outline(kind: u64, random: &mut Random) -> Vec<[f64; 2]> {
    let count = random.between(3.0, 9.0) as usize;
    let mut points: Vec<DVec2> = match kind {
        // Discs without cylinders.
        2 => {
            let mut points = vec![DVec2::new(0.0, 0.04)];
            for k in 0..count {
                let z = 0.04 + 0.9 * k as f64 / count as f64;
                points.push(DVec2::new(random.between(0.08, 0.46), z));
                points.push(DVec2::new(
                    random.between(0.08, 0.46),
                    z + 0.9 / count as f64,
                ));
            }
            points.push(DVec2::new(0.0, 0.94));
            points
        }
        0..=3 => {
            let points = random.polygon(kind, count).into_iter();
            points.map(DVec2::from).collect()
        }
        _ => {
            let (bore, tilt) = (
                random.between(-0.1, 0.1).max(0.0),
                random.between(-0.1, 0.1),
            );
            let (r, low, high) = (
                random.between(0.3, 0.45),
                random.between(0.1, 0.3),
                random.between(0.6, 0.9),
            );
            vec![
                DVec2::new(bore, low),
                DVec2::new(r, low + tilt),
                DVec2::new(r + tilt, high),
                DVec2::new(bore, high + tilt),
            ]
        }
    };
    for _ in 0..if kind >= 4 { 2 } else { 0 } {
        let k = random.below(points.len());
        let (a, b) = (points[k], points[(k + 1) % points.len()]);
        if a.x + b.x == 0.0 || a.distance(b) < 0.05 {
            continue;
        }
        // Slots go into the solid, fins out of it.
        let depth = random.between(0.01, 0.1) * if kind == 4 { 1.0 } else { -1.0 };
        let tip = depth * (b - a).perp().normalize() + random.between(-0.15, 0.15) * (b - a);
        let from = random.between(0.2, 0.8);
        let to = from + random.between(-7.0, -3.5).exp() / a.distance(b);
        let [p, q] = [from, to.min(0.95)].map(|part| a.lerp(b, part));
        let sharp = random.chance(0.4);
        let added = [p, p + tip, if sharp { p + tip } else { q + tip }, q];
        points.splice(k + 1..k + 1, added.map(|p| p.max(DVec2::ZERO)));
    }
    for _ in 0..if kind < 4 { 3 } else { 1 } {
        let count = points.len();
        let k = random.below(count);
        let (before, here, next) = (
            points[(k + count - 1) % count],
            points[k],
            points[(k + 1) % count],
        );
        if here.x > 0.0 {
            let length = random.between(1e-4f64.ln(), 0.05f64.ln()).exp();
            let towards = |other: DVec2, part: f64| {
                let most = 0.4 * other.distance(here);
                here + (other - here).normalize_or_zero() * length.min(most) * part
            };
            let part = random.between(0.0, 1.0);
            points.splice(k..=k, [towards(before, part), towards(next, 1.0)]);
        }
    }
    points.into_iter().map(Into::into).collect()
}
