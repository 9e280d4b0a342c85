//! The Pareto front: what no other beats in both time and error.

/// The indices of the points `(time, error)` that no other point beats: none is at least as good in
/// both and better in one. In order of time; of equal points the first. Points that are no numbers
/// are on no front.
///
/// A slower point must bring the error below `gain` times that of the last point on the front: with
/// a gain below 1, noise in the last digit puts nothing on it.
#[must_use]
pub fn front(points: &[(f64, f64)], gain: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len())
        .filter(|&i| !points[i].0.is_nan() && !points[i].1.is_nan())
        .collect();
    order.sort_by(|&a, &b| {
        points[a]
            .0
            .total_cmp(&points[b].0)
            .then(points[a].1.total_cmp(&points[b].1))
    });
    let mut best = f64::INFINITY;
    let mut all = Vec::new();
    for i in order {
        if points[i].1 < gain * best {
            best = points[i].1;
            all.push(i);
        }
    }
    all
}

/// The gain in error that is worth a place on a chart's front.
pub const WORTH: f64 = 0.95;

/// The stairs that bound what no point of a front reaches, for points in order of `x`, `y` falling.
pub(crate) fn stairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut all = Vec::new();
    for (i, p) in points.iter().enumerate() {
        if i > 0 {
            all.push((p.0, points[i - 1].1));
        }
        all.push(*p);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beaten_is_not_on_the_front() {
        let points = [
            (2.0, 5.0),
            (1.0, 9.0),
            (3.0, 5.0),
            (3.0, 1.0),
            (2.0, 6.0),
            (f64::NAN, 0.0),
            (9.0, 1.0),
        ];
        assert_eq!(front(&points, 1.0), [1, 0, 3]);
        assert_eq!(front(&points, 0.5), [1, 3]);
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)], 1.0), [0]);
        assert!(front(&[], 1.0).is_empty());
    }

    #[test]
    fn no_point_of_the_front_is_beaten_and_every_other_is() {
        let mut seed = 5u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 40) as f64
        };
        let points: Vec<_> = (0..200).map(|_| (next(), next())).collect();
        let found = front(&points, 1.0);
        let beaten = |i: usize| {
            points
                .iter()
                .any(|q| q.0 <= points[i].0 && q.1 <= points[i].1 && *q != points[i])
        };
        for i in 0..points.len() {
            assert_eq!(found.contains(&i), !beaten(i), "{i}");
        }
    }

    #[test]
    fn stairs_go_along_before_they_go_down() {
        assert_eq!(
            stairs(&[(1.0, 3.0), (2.0, 1.0)]),
            [(1.0, 3.0), (2.0, 3.0), (2.0, 1.0)]
        );
    }
}
