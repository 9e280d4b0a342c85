//! A warning about points of a polygon that the shape box cuts off.

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
    let (tall, wide) = (low < -SLACK || high > 1.0 + SLACK, widest > radius + SLACK);
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
        text += &format!("; r goes to {widest}, the box to {radius}: give radius = {widest}");
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::cut_off;

    #[test]
    fn points_that_are_cut_off_are_named_with_what_would_fit() {
        for (points, radius, words) in [
            (
                [[50.0, -10.0], [65.0, 6.0], [44.5, 88.0]],
                65.0,
                "z goes from -10 to 88, the box from 0 to 1: give r / 98 and (z + 10) / 98, with scale = [98, 98, 98] and position = [0, 0, -10]",
            ),
            (
                [[0.0, -0.5], [0.3, 0.5], [0.0, 0.5]],
                0.5,
                "give (z + 0.5) and position = [0, 0, -0.5]",
            ),
            (
                [[0.0, 0.0], [20.0, 0.0], [0.0, 40.0]],
                20.0,
                "give r / 40 and z / 40, with scale = [40, 40, 40]",
            ),
            (
                [[0.0, 2.0], [0.4, 2.0], [0.0, 2.5]],
                0.5,
                "give (z - 2) and position = [0, 0, 2]",
            ),
            (
                [[0.0, 0.0], [0.8, 0.0], [0.0, 1.0]],
                0.5,
                "r goes to 0.8, the box to 0.5: give radius = 0.8",
            ),
        ] {
            let text = cut_off(&points, radius).unwrap_or_default();
            assert!(text.contains(words), "{text}");
        }
        let within = [[0.0, 0.0], [0.5 + 1e-9, -1e-9], [0.0, 1.0]];
        assert_eq!(cut_off(&within, 0.5), None);
    }
}
