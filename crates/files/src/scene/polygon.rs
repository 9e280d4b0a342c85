//! Warnings about polygons: points that the shape box cuts off, and a wall that is not closed.

/// Points so far outside of the box are cut off by rounding alone.
const SLACK: f64 = 1e-6;

/// A warning about `[r, z]` points outside of `0 <= z <= 1` and `r <= radius`, with the numbers that
/// would bring all of them into the box.
pub(super) fn cut_off(points: &[[f64; 2]], radius: f64) -> Option<String> {
    let fold = |k: usize, pick: fn(f64, f64) -> f64, start: f64| {
        points.iter().map(|p| p[k]).fold(start, pick)
    };
    let widest = fold(0, f64::max, 0.0);
    let (low, high) = (
        fold(1, f64::min, f64::INFINITY),
        fold(1, f64::max, f64::NEG_INFINITY),
    );
    let tall = low < -SLACK || high > 1.0 + SLACK;
    // What is divided below is narrower, too.
    let factor = if tall { (high - low).max(1.0) } else { 1.0 };
    let wide = widest / factor > radius + SLACK;
    if !tall && !wide {
        return None;
    }
    let mut text = String::from("points outside of the shape box are cut off");
    if tall {
        let height = high - low;
        text += &format!("; z goes from {low} to {high}, the box from 0 to 1: ");
        let sign = if low < 0.0 { "+" } else { "-" };
        let moved = match low {
            0.0 => "z".to_owned(),
            _ => format!("(z {sign} {})", low.abs()),
        };
        text += &match height <= 1.0 {
            true => format!("give {moved} and position = [0, 0, {low}]"),
            false => format!(
                "give r / {height} and {moved} / {height}, with scale = [{height}, {height}, {height}] and position = [0, 0, {low}]"
            ),
        };
    }
    if wide {
        let widest = widest / factor;
        text += &format!("; r goes to {widest}, the box to {radius}: give radius = {widest}");
    }
    Some(text)
}

/// The line that closes a polygon goes aside by more than this part of its length: not a bore.
const ASIDE: f64 = 0.05;
/// This many times longer than all other lines, it is not meant.
const LONG: f64 = 3.0;

/// A warning about points along one side of a wall, whose ends are off the axis: the straight line
/// between the ends makes a conical hollow.
pub(super) fn open_wall(points: &[[f64; 2]]) -> Option<String> {
    let [[first, low], .., [last, high]] = *points else {
        return None;
    };
    let widest = points.iter().fold(0.0f64, |m, p| m.max(p[0]));
    let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let closing = length([first, low], [last, high]);
    let is_aside = first.min(last) > SLACK * widest && (last - first).abs() > ASIDE * closing;
    let steps = || points.windows(2);
    let one_way = (high - low).signum();
    // Three points are a section.
    let climbs = points.len() > 3 && steps().all(|p| (p[1][1] - p[0][1]) * one_way > 0.0);
    let longest = steps().map(|p| length(p[0], p[1])).fold(0.0, f64::max);
    (is_aside && (climbs || closing > LONG * longest)).then(|| {
        format!(
            "a straight line closes the polygon from [{last}, {high}] to [{first}, {low}], off the axis, and makes a conical hollow; add the points of the wall's other side, or [0, {high}] and [0, {low}] for a solid without a hollow"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::{cut_off, open_wall};

    #[test]
    fn points_beyond_the_box_are_told_how_to_fit() {
        for (points, words) in [
            (
                [[50.0, -10.0], [65.0, 6.0], [44.5, 88.0]],
                "give r / 98 and (z + 10) / 98, with scale = [98, 98, 98] and position = [0, 0, -10]; r goes to 0.66",
            ),
            (
                [[0.0, -0.5], [0.3, 0.5], [0.0, 0.5]],
                "give (z + 0.5) and position = [0, 0, -0.5]",
            ),
            (
                [[0.0, 2.0], [40.0, 2.0], [0.0, 2.5]],
                "give (z - 2) and position = [0, 0, 2]; r goes to 40, the box to 0.5: give radius = 40",
            ),
            (
                [[0.0, 0.0], [0.8, 0.0], [0.0, 1.0]],
                "cut off; r goes to 0.8, the box to 0.5: give radius = 0.8",
            ),
        ] {
            let said = cut_off(&points, 0.5).unwrap_or_default();
            assert!(said.contains(words), "{said}");
        }
        assert_eq!(cut_off(&[[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]], 0.5), None);
    }

    #[test]
    fn an_open_wall_is_named_and_closed_sections_are_not() {
        let wall: Vec<[f64; 2]> = (0..=20)
            .map(|k| f64::from(k) / 20.0)
            .map(|z| [0.3 + 0.2 * (3.0 * z).sin() + 0.1 * z, z])
            .collect();
        let lip = [&wall[..], &[[0.45, 0.98], [0.46, 0.95]]].concat();
        let down: Vec<_> = wall.iter().rev().copied().collect();
        let coarse = [[0.3, 0.0], [0.4, 0.5], [0.5, 0.9], [0.45, 1.0]];
        for open in [&wall[..], &lip, &down, &coarse] {
            let said = open_wall(open).unwrap_or_default();
            let ([_, low], [_, high]) = (open[0], open[open.len() - 1]);
            let mended = [open, &[[0.0, high], [0.0, low]]].concat();
            assert!(
                said.contains(&format!("or [0, {high}] and [0, {low}]")),
                "{said}"
            );
            assert_eq!(open_wall(&mended), None);
        }
        // The other side of the wall.
        let inside = down.iter().map(|[r, z]| [r - 0.02, *z]);
        let both: Vec<_> = wall.iter().copied().chain(inside).collect();
        assert_eq!(open_wall(&both), None);
        for closed in [
            // A washer, a tube with a conical bore, a bead with a bore, a ring of three corners, a cone.
            &[[0.3, 0.0], [0.4, 0.0], [0.4, 0.1], [0.3, 0.1]][..],
            &[[0.2, 0.0], [0.4, 0.0], [0.4, 1.0], [0.3, 1.0]],
            &[[0.1, 0.0], [0.3, 0.2], [0.4, 0.5], [0.3, 0.8], [0.1, 1.0]],
            &[[0.3, 0.4], [0.4, 0.4], [0.35, 0.5]],
            &[[0.0, 0.0], [0.4, 0.0], [0.3, 1.0]],
        ] {
            assert_eq!(open_wall(closed), None, "{closed:?}");
        }
        let again = [&coarse[..], &[coarse[0]]].concat();
        assert_eq!(open_wall(&again), None);
    }
}
