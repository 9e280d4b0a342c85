//! The shadow maps that follow the view: parts of the picture's depths, as parallel-split shadow maps
//! take them (Zhang et al. 2006), each with a map around what is seen of it.

use super::sight::{Ball, corners};
use glam::{DMat4, DVec3};
use revmap::scene::CameraFrame;

/// Side of a map, texels.
pub(super) const SIDE: u32 = 2048;
/// Most maps of a light.
pub(super) const CASCADES: usize = 3;
/// Most lights that cast shadows.
pub(super) const SHADOW_LIGHTS: usize = 2;

/// Weight of splits with equal ratios over splits with equal differences.
const RATIOS: f64 = 0.75;
/// A map has one more part for each such factor between the farthest and the nearest depth.
const PART: f64 = 2.0;
/// The nearest depth, parts of the farthest: of an eye inside a copy's ball.
const NEAREST: f64 = 1e-3;
/// What a map is larger than what it is fitted around.
const MARGIN: f64 = 1.02;

/// One map of a light.
#[derive(Clone, Debug)]
pub(super) struct Cascade {
    /// From the world to -1 to 1 across the map, and 0 near the light to 1.
    pub clip_from_world: DMat4,
    /// The depth of the camera at which the next map begins.
    pub end: f64,
    /// Width of a texel and length of the depths, world units.
    pub texel: f64,
    pub range: f64,
    /// The copies that may cast a shadow into it, by number.
    pub casters: Vec<usize>,
}

/// The maps of one light, for the picture of a camera.
pub(super) fn cascades(
    balls: &[Ball],
    camera: &CameraFrame,
    size: (u32, u32),
    towards: DVec3,
) -> Vec<Cascade> {
    let depth = |ball: &Ball| (ball.middle - camera.eye).dot(camera.forward);
    let seen = || balls.iter().filter(|ball| ball.seen);
    let farthest = seen().map(|b| depth(b) + b.radius).fold(0.0, f64::max);
    let nearest = seen().map(|b| depth(b) - b.radius).fold(farthest, f64::min);
    let nearest = nearest.max(NEAREST * farthest);
    if farthest <= 0.0 {
        return Vec::new();
    }
    let count = ((farthest / nearest).log(PART).ceil() as usize).clamp(1, CASCADES);
    let split = |k: usize| {
        let part = k as f64 / count as f64;
        let ratios = nearest * (farthest / nearest).powf(part);
        RATIOS * ratios + (1.0 - RATIOS) * (nearest + (farthest - nearest) * part)
    };
    let light = LightSpace::new(towards);
    let corners = corners(camera, size);
    let of_part = |k: usize| {
        let [begin, end] = [split(k), split(k + 1)];
        let within =
            |ball: &&Ball| depth(ball) + ball.radius >= begin && depth(ball) - ball.radius <= end;
        let of_balls = seen().filter(within).map(|ball| light.box_of(ball));
        let of_balls = of_balls.reduce(joined)?;
        let slice = [begin, end].map(|d| corners.map(|way| light.place(camera.eye + d * way)));
        let slice = slice
            .as_flattened()
            .iter()
            .map(|p| [*p, *p])
            .reduce(joined)?;
        let [low, high] = [of_balls[0].max(slice[0]), of_balls[1].min(slice[1])];
        if low.cmpgt(high).any() {
            return None;
        }
        Some(light.map(balls, [low, high], end))
    };
    (0..count).filter_map(of_part).collect()
}

fn joined([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> [DVec3; 2] {
    [a.min(c), b.max(d)]
}

/// Axes of which the last leads to the light.
struct LightSpace([DVec3; 3]);

impl LightSpace {
    fn new(towards: DVec3) -> Self {
        let (u, v) = towards.any_orthonormal_pair();
        Self([u, v, towards])
    }

    fn place(&self, p: DVec3) -> DVec3 {
        DVec3::from_array(self.0.map(|axis| axis.dot(p)))
    }

    fn box_of(&self, ball: &Ball) -> [DVec3; 2] {
        let middle = self.place(ball.middle);
        [middle - ball.radius, middle + ball.radius]
    }

    /// The map of what is seen between two corners.
    fn map(&self, balls: &[Ball], [low, high]: [DVec3; 2], end: f64) -> Cascade {
        let middle = 0.5 * (low + high);
        let half = 0.5 * MARGIN * (high - low);
        let casts = |ball: &Ball| {
            let [begin, end] = self.box_of(ball);
            let across = begin.cmple(middle + half) & end.cmpge(middle - half);
            across.x && across.y && end.z >= low.z
        };
        let casters: Vec<usize> = (0..balls.len()).filter(|&n| casts(&balls[n])).collect();
        let top = casters.iter().map(|&n| self.box_of(&balls[n])[1].z);
        let top = top.fold(high.z, f64::max);
        let range = MARGIN * (top - low.z);
        // x, y, and depth from the light, each a scaled coordinate plus a constant.
        let [u, v, w] = self.0;
        let rows = [u / half.x, v / half.y, -w / range];
        let constant = DVec3::new(-middle.x / half.x, -middle.y / half.y, top / range);
        let column = |k: usize| rows.map(|row| row[k]);
        let [x, y, z] = [0, 1, 2].map(|k| DVec3::from_array(column(k)).extend(0.0));
        Cascade {
            clip_from_world: DMat4::from_cols(x, y, z, constant.extend(1.0)),
            end,
            texel: 2.0 * half.x.max(half.y) / f64::from(SIDE),
            range,
            casters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use revmap::scene::Camera;

    /// Every seen point is in the map of its depth, and so is all that is between it and the light.
    #[test]
    fn maps_hold_what_is_seen_and_what_shades_it() {
        let size = (320, 240);
        let camera = Camera::new(DVec3::new(-9.0, -2.0, 2.0), DVec3::new(0.0, 0.0, 0.5));
        let camera = CameraFrame::new(&camera, size.0, size.1).unwrap_or_else(|e| panic!("{e}"));
        let part = |k: u32, step: f64| 12.0 * ((f64::from(k) * step).fract() - 0.5);
        let ball = |k| {
            let middle = DVec3::new(part(k, 0.754_877), part(k, 0.569_840), 0.5);
            let seen = true;
            Ball {
                middle,
                radius: 0.6,
                scale: 1.0,
                seen,
            }
        };
        let balls: Vec<Ball> = (0..200).map(ball).collect();
        let towards = DVec3::new(0.4, 0.6, 0.7).normalize();
        let all = cascades(&balls, &camera, size, towards);
        assert_eq!(all.len(), CASCADES);
        let mut seen = 0;
        for ball in &balls {
            let way = ball.middle - camera.eye;
            let depth = way.dot(camera.forward);
            let across = DVec2::new(way.dot(camera.right), way.dot(camera.up))
                / DVec2::new(camera.right.length_squared(), camera.up.length_squared());
            if depth < 1.0 || across.x.abs() > 159.0 * depth || across.y.abs() > 119.0 * depth {
                continue;
            }
            seen += 1;
            let map = all
                .iter()
                .find(|map| depth <= map.end)
                .unwrap_or_else(|| panic!("{depth}"));
            let at = |p: DVec3| map.clip_from_world.transform_point3(p);
            let p = at(ball.middle);
            assert!(
                p.x.abs() <= 1.0 && p.y.abs() <= 1.0 && (0.0..=1.0).contains(&p.z),
                "{p}"
            );
            for (n, other) in balls.iter().enumerate() {
                let way = other.middle - ball.middle;
                let along = way.dot(towards);
                if along > 0.0 && (way - along * towards).length() < other.radius {
                    assert!(map.casters.contains(&n) && at(other.middle).z >= 0.0);
                }
            }
        }
        assert!(seen > 20, "{seen}");
        let hidden: Vec<Ball> = balls.iter().map(|b| Ball { seen: false, ..*b }).collect();
        assert!(cascades(&hidden, &camera, size, towards).is_empty());
    }
}
