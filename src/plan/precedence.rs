//! One winner where faces of several copies coincide: the first copy in the scene.
//!
//! Two copies compute the depth of a shared point with different roundings. A copy that may share faces
//! with an earlier one therefore **lags**: its depths are compared and written a little farther away
//! than they are, by more than these roundings. It is one tier farther than each such copy before it.
//! Nothing else of a hit changes. A copy that overlaps none has no lag.

use super::tiles::Cylinder;
use super::view::View;
use crate::scene::Placement;
use crate::shader::InstanceBlock;
use glam::{DMat3, DVec3, Vec3};
use std::collections::HashMap;

/// Most copies of a scene of which some may lag. Pairs are compared, so the time grows with the square.
const MOST_COPIES: usize = 256;
/// The highest tier. Copies that would be above share it, and rounding decides between these.
const MOST_TIERS: u8 = 15;
/// Solids that overlap by less than this part of the smaller one only touch: no faces coincide there
/// that look the same way.
const TOUCHING: f64 = 1e-6;
/// The largest lag of a tier, as a part of the depth.
const MOST_LAG: f64 = 1e-5;

/// A copy of a solid in the world.
pub(crate) struct Body {
    instance: u32,
    middle: DVec3,
    /// Two radii at right angles, and half of the length along the axis.
    ways: [DVec3; 3],
}

/// The place of a copy in the order of those that it overlaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rank {
    tier: u8,
    /// The largest radius of a ball around the copy or an earlier one that it overlaps, world units.
    size: f64,
}

/// The ranks of copies that lag, by the number of the instance.
#[derive(Debug, Default)]
pub(crate) struct Precedence(HashMap<u32, Rank>);

impl Body {
    /// The copy of a solid at a placement.
    pub fn new(instance: u32, placement: &Placement, solid: &Cylinder) -> Self {
        let turn = DMat3::from_quat(placement.rotation.normalize());
        let local = solid.axis.extend(0.5 * (solid.low + solid.high));
        let half = DVec3::new(solid.radius, solid.radius, 0.5 * (solid.high - solid.low));
        let size = half * placement.scale;
        Self {
            instance,
            middle: placement.position + turn * (placement.scale * local),
            ways: [turn.x_axis * size.x, turn.y_axis * size.y, turn.z_axis * size.z],
        }
    }

    /// Half of the extent along a direction.
    fn half(&self, along: DVec3) -> f64 {
        let [x, y, z] = self.ways.map(|way| way.dot(along));
        x.hypot(y) + z.abs()
    }

    /// The radius of a ball around it.
    fn size(&self) -> f64 {
        let [x, y, z] = self.ways.map(DVec3::length);
        x.max(y).hypot(z)
    }

    /// False if a plane is known to separate two copies: at right angles to an axis, to the line
    /// between the middles, or to the part of that line across an axis.
    fn overlaps(&self, other: &Self) -> bool {
        let between = other.middle - self.middle;
        let axes = [self, other].map(|body| body.ways[2].normalize_or_zero());
        let across = axes.map(|axis| between - between.dot(axis) * axis);
        let apart = |along: DVec3| {
            let [a, b] = [self, other].map(|body| body.half(along));
            between.dot(along).abs() > a + b - TOUCHING * a.min(b)
        };
        let ways = [between, axes[0], axes[1], across[0], across[1]];
        !ways.into_iter().any(apart)
    }
}

impl Precedence {
    /// The ranks of `count` copies, in the order of the scene.
    pub fn new(count: usize, bodies: impl FnOnce() -> Vec<Body>) -> Self {
        let mut ranks = HashMap::new();
        if count < 2 || count > MOST_COPIES {
            return Self(ranks);
        }
        let bodies = bodies();
        let mut tiers = Vec::with_capacity(count);
        for body in &bodies {
            let (mut tier, mut size) = (0, body.size());
            for (earlier, at) in bodies.iter().zip(&tiers) {
                if body.overlaps(earlier) {
                    tier = MOST_TIERS.min(at + 1).max(tier);
                    size = earlier.size().max(size);
                }
            }
            tiers.push(tier);
            if tier > 0 {
                ranks.insert(body.instance, Rank { tier, size });
            }
        }
        Self(ranks)
    }

    /// The lag of an instance in a view, as a part of its depths; in a parallel view, of the depth
    /// range.
    #[allow(clippy::cast_possible_truncation)]
    pub fn lag(&self, instance: u32, copy: &InstanceBlock, view: &View) -> f32 {
        let Some(rank) = self.0.get(&instance) else {
            return 0.0;
        };
        let k = |name: &str, d: f64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(d);
        // From the middle to the ray of the first pixel.
        let reach = (Vec3::from(copy.origin) * Vec3::from(copy.scale)).length();
        let scale = if view.parallel { 1.0 / view.depth[1].abs() } else { f64::from(copy.depth) };
        let off = (rank.size + f64::from(reach)) / scale;
        let off = if off >= 0.0 { off } else { f64::INFINITY };
        let ulp = f64::from(f32::EPSILON) / 2.0;
        (f64::from(rank.tier) * (ulp * (k("K1", 4.0) + k("K2", 4.0) * off)).min(k("K3", MOST_LAG))) as f32
    }
}

/// The change of a view's two terms of depth in clip space for a lag of 1.
///
/// The factor's is the lag as a part of the depth. The constant's covers the roundings of the
/// depth buffer's values, which do not shrink with the distance.
pub(crate) fn lag_depth(view: &View) -> [f64; 2] {
    let [_, sense] = view.order.near_and_sense();
    let [constant, factor] = view.clip_depth();
    let [min, max] = view.depth_range;
    if view.parallel {
        return [sense, factor];
    }
    let k = |name: &str, d: f64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(d);
    let rounded = constant.abs() + min / (max - min);
    [sense * rounded * k("K4", 0.25), -factor]
}
