//! Levels of a surface: the same boundary fitted at tolerances that double from level to level.
//! Level 0, the finest, is exact. The level of an object depends only on the view, so a picture
//! does not depend on earlier frames.

use super::projector::{Cylinder, Projector};
use super::view::View;
use crate::scene::{Cluster, Object, Placement};
use crate::settings::Tolerance;
use crate::shader::InstanceBlock;
use crate::surface::FitOptions;
use glam::DVec3;
use std::f64::consts::SQRT_2;

/// The coarsest level: patches within a 36th of the height.
pub(crate) const COARSEST: u8 = 12;

/// Pixels of tolerance for one pixel that the surface moves. A ray that meets the surface at an
/// angle with the cosine `c` is off by `1 / c` times that movement. Over eight solids, the 99.9th
/// percentile of this factor is 7 to 15.
const GRAZING: f64 = 16.0;

/// Levels among which each copy of an object with many copies has its own. A step of three levels
/// about halves the number of patches.
pub(crate) const COPY_LEVELS: [u8; 5] = [0, 3, 6, 9, COARSEST];

/// The choice of a level for each copy of an object in a view.
#[derive(Clone, Debug, Default)]
pub(crate) struct CopyLevels {
    /// A copy may take level `n + 1` if the depth of its box's middle is at least `limits[n]` times
    /// its largest scale.
    pub limits: [f32; COPY_LEVELS.len() - 1],
    /// Upper bound on the shift of a silhouette by levels after the finest, pixels.
    pub error: f64,
}

/// Tolerance of an object's level over that of a copy's. Many copies have errors near their bound; with
/// one level for all, only the nearest copy has.
const COPIES: f64 = 1.25;

impl CopyLevels {
    /// `height`: height of the box in units of the profile's.
    pub fn new(object: &Object, height: f64, view: &View, tolerance: Tolerance) -> Self {
        let reach = (object.profile.radius * SQRT_2).hypot(0.5);
        let pixels = stretch(view) / (pixel_of(view) * height);
        let error = tolerance.pixels() / (COPIES * GRAZING);
        let limit = |level: u8| ((reach + bound(level) * pixels / error) * (1.0 + 1e-6)) as f32;
        Self {
            limits: std::array::from_fn(|n| limit(COPY_LEVELS[n + 1])),
            error,
        }
    }

    /// Index of a copy's level. `depth`: depth of its box's middle; `scale`: its largest scale.
    pub fn of(&self, depth: f32, scale: f32) -> usize {
        let passes = |limit: &&f32| depth >= scale * **limit;
        self.limits.iter().filter(passes).count()
    }

    /// The same, from a copy's block.
    pub fn of_block(&self, copy: &InstanceBlock) -> usize {
        let [x, y, z] = copy.scale;
        self.of(copy.depth, x.max(y).max(z))
    }
}

/// Largest distance of a level's surface from the finest one on the screen, pixels.
pub(crate) fn allowed(tolerance: Tolerance) -> f64 {
    tolerance.pixels() / GRAZING
}

/// Largest distance between the patches of a level and the exact contour, in units of the profile's
/// height.
pub(crate) fn bound(level: u8) -> f64 {
    FitOptions::default().tolerance * f64::from(1u32 << level)
}

/// The coarsest level that `tolerance` allows. `pixels`: length of one object unit on the screen
/// where the object is nearest.
pub(crate) fn coarsest(tolerance: Tolerance, pixels: f64) -> u8 {
    (1..=COARSEST)
        .take_while(|&level| bound(level) * pixels <= allowed(tolerance))
        .last()
        .unwrap_or(0)
}

/// The most pixels that one unit of an object covers, over the copies in front of the eye. Infinite
/// if a copy may reach the eye. `height`: height of the box in units of the profile's. `all`:
/// includes copies outside of the picture, whose shadows may be in it.
pub(crate) fn pixels_per_unit(object: &Object, height: f64, view: &View, all: bool) -> f64 {
    stretch(view) / (pixel_of(view) * height * least_depth(object, view, all))
}

/// The pixels that a length across the ray covers, over those that it covers in the middle of the
/// picture: the largest ratio.
fn stretch(view: &View) -> f64 {
    if view.parallel {
        return 1.0;
    }
    (view.corner_rays())
        .map(|ray| ray.length() / ray.dot(view.forward))
        .into_iter()
        .fold(1.0, f64::max)
}

/// A pixel's shorter side at unit depth.
fn pixel_of(view: &View) -> f64 {
    view.dir_x.length().min(view.dir_y.length())
}

/// The least depth of an object's copies at their boxes' nearest points, each over the copy's largest
/// scale; infinite if none shows. An object unit covers the most pixels on that copy. `all`: as in
/// [`pixels_per_unit`].
fn least_depth(object: &Object, view: &View, all: bool) -> f64 {
    let radius = object.profile.radius;
    let shape = Cylinder::centred(radius * SQRT_2, 0.0, 1.0);
    // No ray leaves its pixel.
    let projector = (!all && !view.parallel).then(|| Projector::new(view, 1.0, 0.0));
    let over_scale = |scale: DVec3, [nearest, farthest]: [f64; 2]| {
        let depth = if farthest <= 0.0 {
            f64::INFINITY
        } else if view.parallel {
            1.0
        } else {
            // A copy that the near plane cuts is nearest at that plane.
            nearest.max(view.near)
        };
        depth / scale.max_element()
    };
    let of_cluster = |cluster: &Cluster| {
        let around = cluster.around(view.eye, [shape.radius, 1.0]);
        over_scale(cluster.most_scale, around.along(view.forward)) * (1.0 - 1e-6)
    };
    let of_copy = |copy: &Placement| {
        let seen = |projector: &Projector| projector.bounds(copy, &shape).is_some();
        if !projector.as_ref().is_none_or(seen) {
            return f64::INFINITY;
        }
        let forward = copy.rotation.conjugate() * view.forward * copy.scale;
        let middle = (copy.position - view.eye).dot(view.forward) + 0.5 * forward.z;
        let reach = forward.abs().dot(DVec3::new(radius, radius, 0.5));
        over_scale(copy.scale, [middle - reach, middle + reach])
    };
    object.least_of_copies(of_cluster, of_copy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Profile;
    use crate::scene::Camera;
    use std::sync::Arc;

    fn at(distance: f64) -> (Object, View) {
        let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
        let mut object = Object::new("spindle", Arc::new(profile));
        object.placement.position.z = -0.5;
        let camera = Camera::new(DVec3::new(distance, 0.0, 0.0), DVec3::ZERO);
        let view = View::from_camera(&camera, (800, 600), [0.01, 1e4]).unwrap();
        (object, view)
    }

    #[test]
    fn pixels_of_a_unit_are_those_of_its_nearest_point() {
        for distance in [2.0, 20.0, 200.0] {
            let (object, view) = at(distance);
            let found = pixels_per_unit(&object, 1.0, &view, false);
            // Any two near points on the box, one unit apart, are seen nearer to each other.
            let p = |y: f64, z: f64| view.project(DVec3::new(0.5, y, z)).0;
            for (a, b) in [(p(0.5, 0.0), p(-0.5, 0.0)), (p(0.0, 0.5), p(0.0, -0.5))] {
                assert!((b - a).length() <= found && (b - a).length() > 0.8 * found);
            }
        }
        let (mut object, view) = at(20.0);
        let one = pixels_per_unit(&object, 1.0, &view, false);
        object.placement.scale = DVec3::new(1.0, 3.0, 1.0);
        assert!((pixels_per_unit(&object, 1.0, &view, false) / one - 3.0).abs() < 1e-9);
        assert!((pixels_per_unit(&object, 2.0, &view, false) / one - 1.5).abs() < 1e-9);
        object.placement.position.x = 100.0;
        assert_eq!(
            pixels_per_unit(&object, 1.0, &view, true),
            0.0,
            "behind the eye"
        );
        // Outside of the picture; then across the eye's plane, but below the picture.
        for beside in [DVec3::new(0.0, 40.0, 0.0), DVec3::new(20.0, 0.0, -9.0)] {
            object.placement.position = beside;
            assert!(pixels_per_unit(&object, 1.0, &view, true) > 0.0);
            assert_eq!(pixels_per_unit(&object, 1.0, &view, false), 0.0, "{beside}");
        }
    }

    /// A copy's level keeps its bound, and a level that is three steps coarser would not, but for
    /// the reach of its box.
    #[test]
    fn levels_of_copies_keep_the_bound() {
        let (mut object, view) = at(20.0);
        let tolerance = Tolerance::DEFAULT;
        let allowed = tolerance.pixels() / GRAZING / COPIES;
        let mut used = [0; COPY_LEVELS.len()];
        for n in 0..400 {
            let part = f64::from(n) / 400.0;
            let scale = DVec3::new(1.0, 1.0 + part, 0.3 + f64::from(n % 5));
            object.placement.scale = scale;
            object.placement.position = -DVec3::X * 1e4 * part.powi(4);
            object.instances = vec![object.placement; 2].into();
            let levels = CopyLevels::new(&object, 1.0, &view, tolerance);
            let middle = object.placement.position + DVec3::new(0.0, 0.0, 0.5 * scale.z);
            let depth = (middle - view.eye).dot(view.forward);
            let found = levels.of(depth as f32, scale.max_element() as f32);
            let pixels = pixels_per_unit(&object, 1.0, &view, true);
            let error = |level: u8| bound(level) * pixels;
            assert!(
                found == 0 || error(COPY_LEVELS[found]) <= allowed,
                "{n}: {found}"
            );
            let next = COPY_LEVELS.get(found + 1);
            let nearest = depth - scale.max_element() * 0.9;
            let coarser = next.map(|next| error(*next) * depth / nearest);
            assert!(
                coarser.is_none_or(|error| error > allowed),
                "{n}: {found} {coarser:?}"
            );
            used[found] += 1;
        }
        assert!(used.iter().filter(|n| **n > 0).count() >= 4, "{used:?}");
    }

    #[test]
    fn the_bound_of_a_level_stays_below_what_is_allowed() {
        for tolerance in [0.05, 0.25, 2.0] {
            let tolerance = Tolerance::new(tolerance).unwrap();
            for pixels in [0.1, 1.0, 10.0, 100.0, 1000.0] {
                let level = coarsest(tolerance, pixels);
                let error = |level| bound(level) * pixels * GRAZING;
                assert!(level == 0 || error(level) <= tolerance.pixels());
                assert!(level == COARSEST || error(level + 1) > tolerance.pixels());
            }
        }
        assert_eq!(coarsest(Tolerance::EXACT, 1e-9), 0);
        assert_eq!(coarsest(Tolerance::DEFAULT, f64::INFINITY), 0);
    }
}
