//! One winner where faces of several copies coincide: the first copy in the scene.
//!
//! Two copies compute the depth of a shared point with different roundings. A copy that shares
//! faces with an earlier one therefore **lags**: its depths are compared and written a little
//! farther away than they are, by more than these roundings. It is one tier farther than each such
//! copy before it. Nothing else of a hit changes. Other copies have no lag.
//!
//! Surfaces of revolution coincide over an area only if they are planes, or if their axes meet. So
//! two copies share faces if they overlap and have flats in one plane or axes that meet. The flats
//! of solids under an offset, of replicas and of solids that their box cuts are not found: these
//! copies share faces with all that they overlap.

use super::projector::Cylinder;
use super::view::View;
use crate::scene::{Object, Offset, Placement};
use crate::shader::InstanceBlock;
use glam::{DMat3, DVec2, DVec3, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// Most copies of a scene of which some may lag. Pairs are compared, so the time grows with the
/// square.
const MOST_COPIES: usize = 256;
/// The highest tier. Copies that would be above share it, and rounding decides between these.
const HIGHEST_TIER: u8 = 15;
/// Solids that overlap by less than this part of the smaller one only touch: no faces coincide
/// there that look the same way.
const TOUCHING: f64 = 1e-6;
/// Largest rounding of a 32-bit number, as a part of it.
const ROUNDING: f64 = f32::EPSILON as f64 / 2.0;
/// The lag of a tier, roundings. The first part is for depths, the second for rays: it grows with
/// the lengths that they are computed from, over the depth. Half of the first and half of the
/// second leave no pixel of the tests' scenes undecided; a quarter of the first does, behind a
/// ball.
const AT_MIDDLE: f64 = 8.0;
const BESIDE: f64 = 4.0;
const BUFFER: f64 = 0.25;
/// Planes and axes this near to each other, as a part of the larger solid, are one. It is also the
/// largest slope of a flat.
const TOGETHER: f64 = 1e-5;
/// The largest lag of a tier, as a part of the depth.
const MOST_LAG: f64 = 1e-5;

/// Heights of the flats of an object, in order, object units; `None` if they are not known.
pub(crate) type Flats = Option<Arc<[f64]>>;

pub(crate) fn flats(object: &Object) -> Flats {
    let (outline, side) = (&object.profile.outline, object.profile.radius);
    let bounds = outline.bounds()?;
    let beside = DVec2::from(object.axis_offset()).abs().max_element();
    let is_cut =
        bounds.r_max + beside > side * (1.0 + 1e-9) || bounds.z_min < 0.0 || bounds.z_max > 1.0;
    if is_cut || object.offset != Offset::default() || object.repeat != [1; 3] {
        return None;
    }
    let mut heights = Vec::new();
    for points in &outline.loops {
        let next = points.iter().cycle().skip(1);
        let sides = points.iter().zip(next).map(|(a, b)| (a, (*b - *a).abs()));
        let flat = sides.filter(|(_, way)| way.y <= TOGETHER * way.x && way.x > 0.0);
        heights.extend(flat.map(|(a, _)| a.y));
    }
    heights.sort_unstable_by(f64::total_cmp);
    heights.dedup();
    Some(heights.into())
}

/// A copy of a solid in the world.
pub(crate) struct Body {
    instance: u32,
    flats: Flats,
    /// The middle of the box's lower face, and the length of an object unit along the axis.
    floor: DVec3,
    height: f64,
    middle: DVec3,
    /// Two radii at right angles, and half of the length along the axis.
    ways: [DVec3; 3],
}

/// The place of a copy in the order of those that it shares faces with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rank {
    tier: u8,
    /// The largest radius of a ball around the copy or an earlier one before it, world units.
    size: f64,
}

/// The ranks of copies that lag, by the number of the instance.
#[derive(Debug, Default)]
pub(crate) struct Precedence(HashMap<u32, Rank>);

impl Body {
    pub fn new(instance: u32, placement: &Placement, solid: &Cylinder, flats: &Flats) -> Self {
        let turn = DMat3::from_quat(placement.rotation.normalize());
        let local = solid.axis.extend(0.5 * (solid.low + solid.high));
        let half = DVec3::new(solid.radius, solid.radius, 0.5 * (solid.high - solid.low));
        let size = half * placement.scale;
        Self {
            instance,
            flats: flats.clone(),
            floor: placement.position,
            height: placement.scale.z,
            middle: placement.position + turn * (placement.scale * local),
            ways: [
                turn.x_axis * size.x,
                turn.y_axis * size.y,
                turn.z_axis * size.z,
            ],
        }
    }

    /// Half of the extent along a direction.
    fn half(&self, along: DVec3) -> f64 {
        let [x, y, z] = self.ways.map(|way| way.dot(along));
        x.hypot(y) + z.abs()
    }

    fn size(&self) -> f64 {
        let [x, y, z] = self.ways.map(DVec3::length);
        x.max(y).hypot(z)
    }

    fn axis(&self) -> DVec3 {
        self.ways[2].normalize_or_zero()
    }

    /// True if faces of two copies that overlap may coincide.
    fn shares_faces(&self, other: &Self) -> bool {
        let (Some(flats), Some(others)) = (&self.flats, &other.flats) else {
            return true;
        };
        let (a, b) = (self.axis(), other.axis());
        let near = TOGETHER * self.size().max(other.size());
        let between = other.middle - self.middle;
        let normal = a.cross(b);
        if normal.length() > TOGETHER {
            return between.dot(normal).abs() <= near * normal.length();
        }
        if between.cross(a).length() <= near {
            return true;
        }
        // Heights in the other copy's units.
        let unit = other.height * a.dot(b).signum();
        let up = (self.floor - other.floor).dot(a);
        flats.iter().any(|flat| {
            let there = (up + self.height * flat) / unit;
            let [low, high] = [-1.0, 1.0].map(|sense| there + sense * near / other.height);
            let first = others.partition_point(|height| *height < low);
            others.get(first).is_some_and(|height| *height <= high)
        })
    }

    /// False if a plane is known to separate two copies: at right angles to an axis, to the line
    /// between the middles, or to the part of that line across an axis.
    fn overlaps(&self, other: &Self) -> bool {
        let between = other.middle - self.middle;
        let axes = [self, other].map(Self::axis);
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
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The ranks of `count` copies, in the order of the scene.
    pub fn new(count: usize, bodies: impl FnOnce() -> Vec<Body>) -> Self {
        let mut ranks = HashMap::new();
        if !(2..=MOST_COPIES).contains(&count) {
            return Self(ranks);
        }
        let bodies = bodies();
        let mut tiers = Vec::with_capacity(count);
        for body in &bodies {
            let (mut tier, mut size) = (0, body.size());
            for (earlier, at) in bodies.iter().zip(&tiers) {
                if body.overlaps(earlier) && body.shares_faces(earlier) {
                    tier = HIGHEST_TIER.min(at + 1).max(tier);
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
    pub fn lag(&self, instance: u32, copy: &InstanceBlock, view: &View) -> f32 {
        let Some(rank) = self.0.get(&instance) else {
            return 0.0;
        };
        let from_axis = Vec3::from(copy.origin) * Vec3::from(copy.scale);
        let reach = rank.size + f64::from(from_axis.length());
        let unit = match view.parallel {
            true => view.depth[1].abs().recip(),
            false => f64::from(copy.depth).max(0.0),
        };
        let tier = ROUNDING * (AT_MIDDLE + BESIDE * reach / unit);
        (f64::from(rank.tier) * tier.min(MOST_LAG)) as f32
    }
}

/// The change of a view's two terms of depth in clip space for a lag of 1.
///
/// The factor's is the lag as a part of the depth. The constant's covers the roundings of values in
/// the depth buffer, which do not shrink with the distance.
pub(crate) fn lag_depth(view: &View) -> [f64; 2] {
    let [_, sense] = view.order.near_and_sense();
    let [constant, factor] = view.clip_depth();
    let [min, max] = view.depth_range;
    let before = min / (max - min);
    if view.parallel {
        return [sense * (before + 1.0), factor];
    }
    [sense * BUFFER * (before + constant.abs()), -factor]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{DepthOrder, Viewport};
    use crate::profile::Profile;
    use crate::scene::Camera;
    use glam::{DMat4, DQuat, DVec4};

    fn at(position: [f64; 3]) -> Placement {
        Placement {
            position: position.into(),
            ..Placement::default()
        }
    }

    /// The tiers of copies, 0 for those that do not lag. The whole is turned, moved and scaled.
    fn tiers(copies: &[(Placement, Cylinder)]) -> Vec<u8> {
        let turns = [
            DQuat::IDENTITY,
            DQuat::from_scaled_axis(DVec3::new(0.3, -1.1, 0.7)),
        ];
        let [plain, turned] = turns.map(|turn| {
            let placed = |p: &Placement| Placement {
                position: turn * (1e3 * p.position) + DVec3::new(4e5, -3e4, 7.0),
                rotation: turn * p.rotation,
                scale: 1e3 * p.scale,
            };
            let body = |(n, (p, of)): (u32, &(Placement, Cylinder))| {
                Body::new(n, &placed(p), of, &Some([of.low, of.high].into()))
            };
            let bodies = || (0..).zip(copies).map(body).collect();
            let all = Precedence::new(copies.len(), bodies);
            let numbers = 0..copies.len() as u32;
            let tier = |n| all.0.get(&n).map_or(0, |rank| rank.tier);
            numbers.map(tier).collect::<Vec<_>>()
        });
        assert_eq!(plain, turned);
        plain
    }

    #[test]
    fn copies_lag_behind_those_that_they_share_faces_with() {
        let of = |x, solid| (at([x, 0.0, 0.0]), solid);
        let table = of(0.0, Cylinder::centred(5.0, 0.0, 1.0));
        let inlay = |x| of(x, Cylinder::centred(0.5, 0.9, 1.0));
        assert_eq!(
            tiers(&[table, inlay(0.0), inlay(2.0), inlay(2.3)]),
            [0, 1, 1, 2]
        );
        assert_eq!(
            tiers(&[inlay(0.0), inlay(2.0), inlay(2.3), table]),
            [0, 0, 1, 2]
        );
        assert_eq!(tiers(&[table, inlay(0.0), table]), [0, 1, 2]);
        assert_eq!(tiers(&[table]), [0]);
    }

    /// Copies beside each other, on top of each other, and crossed ones that are apart.
    #[test]
    fn copies_that_only_touch_do_not_lag() {
        let solid = Cylinder::centred(0.5, 0.0, 0.3);
        let pair = |b: Placement| tiers(&[(at([0.0; 3]), solid), (b, solid)]);
        assert_eq!(pair(at([0.6, 0.8, 0.0])), [0, 0]);
        assert_eq!(pair(at([0.59, 0.8, 0.0])), [0, 1]);
        assert_eq!(pair(at([0.1, 0.2, 0.3])), [0, 0]);
        assert_eq!(pair(at([0.1, 0.2, 0.3 - 2e-6])), [0, 1]);
        let wide = Placement {
            scale: DVec3::new(3.0, 1.0, 1.0),
            ..at([1.9, 0.0, 0.0])
        };
        assert_eq!(pair(wide), [0, 1]);
        let upright = Placement {
            rotation: DQuat::from_rotation_x(1.5),
            ..at([0.0, 0.95, 0.0])
        };
        assert_eq!(pair(upright), [0, 0]);
    }

    /// Flats in one plane and axes that meet count; flats of other heights or slopes do not.
    #[test]
    fn copies_that_overlap_may_share_no_face() {
        let table = (at([0.0; 3]), Cylinder::centred(5.0, 0.0, 1.0));
        let pair = |b: Placement| tiers(&[table, (b, Cylinder::centred(0.5, 0.5, 1.0))]);
        assert_eq!(pair(at([2.0, 0.0, 0.0])), [0, 1]);
        assert_eq!(pair(at([2.0, 0.0, 1e-5])), [0, 1]);
        assert_eq!(pair(at([2.0, 0.0, 1e-3])), [0, 0]);
        assert_eq!(pair(at([0.0, 0.0, 1e-3])), [0, 1]);
        let turned = |angle: f64, position: [f64; 3]| Placement {
            rotation: DQuat::from_rotation_x(angle),
            ..at(position)
        };
        assert_eq!(pair(turned(0.001, [2.0, 0.0, 0.0])), [0, 0]);
        assert_eq!(pair(turned(0.001, [0.0, 1.0, 0.0])), [0, 1]);
        // Upside down, with its lower flat in the plane of the table's top.
        assert_eq!(pair(turned(std::f64::consts::PI, [2.0, 0.0, 1.5])), [0, 1]);
        assert_eq!(pair(turned(std::f64::consts::PI, [2.0, 0.0, 1.4])), [0, 0]);
    }

    #[test]
    fn flats_are_found_or_not_known() {
        let points = [
            [0.0, 0.1],
            [0.4, 0.1],
            [0.4, 0.3],
            [0.2, 0.3],
            [0.1, 0.7],
            [0.0, 0.8],
        ];
        let profile = Profile::polygon(&points, 0.5).unwrap();
        let object = Object::new("a foot", profile.into());
        assert_eq!(flats(&object).unwrap()[..], [0.1, 0.3]);
        let changed = |change: fn(&mut Object)| {
            let mut object = object.clone();
            change(&mut object);
            flats(&object)
        };
        assert!(changed(|o| o.axis = [0.55, 0.5]).is_some());
        assert!(changed(|o| o.axis = [0.65, 0.5]).is_none());
        assert!(changed(|o| o.offset.extend = 0.01).is_none());
        assert!(changed(|o| o.repeat = [1, 2, 1]).is_none());
    }

    #[test]
    fn tiers_and_copies_are_limited() {
        let solid = Cylinder::centred(0.5, 0.0, 1.0);
        let row = |count: u32| (0..count).map(|n| (at([0.3 * f64::from(n), 0.0, 0.0]), solid));
        let found = tiers(&row(40).collect::<Vec<_>>());
        let wanted: Vec<u8> = (0..40).map(|n| n.min(HIGHEST_TIER)).collect();
        assert_eq!(found, wanted);
        let most = MOST_COPIES as u32;
        assert!(tiers(&row(most).collect::<Vec<_>>())[1] == 1);
        assert_eq!(
            tiers(&row(most + 1).collect::<Vec<_>>()),
            [0; MOST_COPIES + 1]
        );
    }

    /// Depths that lag are farther in each view, by a few roundings of the depth buffer at least
    /// and by a small part of the depth.
    #[test]
    fn lags_are_above_roundings_and_small() {
        let camera = Camera::new(DVec3::new(4.0, 0.0, 0.0), DVec3::ZERO);
        let near = View::from_camera(&camera, (320, 240), [0.05, 500.0]).unwrap();
        let viewport = Viewport {
            x: 0.0,
            y: 0.0,
            width: 320.0,
            height: 240.0,
        };
        let look = DMat4::from_translation(DVec3::new(-4.0, 0.0, 0.0));
        let host = |z: f64, w: f64, last, order| {
            let rows = [DVec4::Y, DVec4::NEG_Z, DVec4::new(-z, 0.0, 0.0, w), last];
            let lens = DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
            View::from_matrices(look, lens, viewport, order).unwrap()
        };
        let views = [
            near,
            near.with_depth_range([0.5, 1.0]).unwrap(),
            host(0.0, 0.1, -DVec4::X, DepthOrder::Reversed),
            host(0.01, 0.0, DVec4::W, DepthOrder::Normal),
            host(-0.01, 1.0, DVec4::W, DepthOrder::Reversed),
        ];
        let body = |n| Body::new(n, &at([0.0; 3]), &Cylinder::centred(0.5, 0.0, 1.0), &None);
        let all = Precedence::new(2, || vec![body(0), body(1)]);
        for view in views {
            let copy = InstanceBlock {
                depth: 4.0,
                scale: [1.0; 3],
                origin: [2.0, 1.5, 0.0],
                ..InstanceBlock::default()
            };
            assert_eq!(all.lag(0, &copy, &view), 0.0);
            let lag = f64::from(all.lag(1, &copy, &view));
            assert!(lag > 8.0 * ROUNDING && lag <= MOST_LAG, "{lag:e}");
            let [_, sense] = view.order.near_and_sense();
            let [a, b] = lag_depth(&view).map(|change| lag * change);
            for t in [3.0, 4.0, 30.0f64] {
                let lagging = View {
                    depth: [view.depth[0] + a, view.depth[1] + b],
                    ..view
                };
                let [plain, late] = [view, lagging].map(|view| view.depth_at(t));
                let rounding = f64::from((plain as f32).next_up() - plain as f32);
                assert!(sense * (late - plain) > 2.0 * rounding, "{view:?} {t}");
                let moved = view.t_at(late) - t;
                assert!(moved > 0.0 && moved < 3e-4 * t, "{view:?} {t}: {moved}");
            }
        }
    }
}
