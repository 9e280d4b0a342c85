//! The Pareto front: what no other beats in both time and error.

/// The indices of the points `(time, error)` that no other beats, in order of time; of equal points
/// the first. A slower point must bring the error below `gain` times that of the last one: with a
/// gain below 1, noise in the last digit puts nothing on the front.
pub fn front(points: &[(f64, f64)], gain: f64) -> Vec<usize> {
    let known = |i: &usize| !points[*i].0.is_nan() && !points[*i].1.is_nan();
    let mut order: Vec<usize> = (0..points.len()).filter(known).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (points[a], points[b]);
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].1 < gain * best;
        best = if better { points[i].1 } else { best };
        better
    });
    order
}

/// The gain in error that is worth a place on a chart's front.
pub const WORTH: f64 = 0.95;

/// The stairs that bound what no point of a front reaches, for points in order of `x`, `y` falling.
pub fn stairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let steps = points.windows(2).flat_map(|w| [(w[1].0, w[0].1), w[1]]);
    points.iter().take(1).copied().chain(steps).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beaten_is_not_on_the_front() {
        let times = [2.0, 1.0, 3.0, 3.0, 2.0, f64::NAN, 9.0];
        let errors = [5.0, 9.0, 5.0, 1.0, 6.0, 0.0, 1.0];
        let points: Vec<(f64, f64)> = times.into_iter().zip(errors).collect();
        assert_eq!(front(&points, 1.0), [1, 0, 3]);
        assert_eq!(front(&points, 0.5), [1, 3]);
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)], 1.0), [0]);
        assert!(front(&[], 1.0).is_empty());
    }

    #[test]
    fn no_point_of_the_front_is_beaten_and_every_other_is() {
        let point = |i: u32| (f64::from(i * 7919 % 211), f64::from(i * 6133 % 223));
        let points: Vec<(f64, f64)> = (0..200).map(point).collect();
        let found = front(&points, 1.0);
        let beats = |q: &(f64, f64), p: (f64, f64)| q.0 <= p.0 && q.1 <= p.1 && *q != p;
        for (i, p) in points.iter().enumerate() {
            let beaten = points.iter().any(|q| beats(q, *p));
            assert_eq!(found.contains(&i), !beaten, "{i}");
        }
        // Stairs go along before they go down.
        let wanted = [(1.0, 3.0), (2.0, 3.0), (2.0, 1.0)];
        assert_eq!(stairs(&[wanted[0], wanted[2]]), wanted);
    }
}
