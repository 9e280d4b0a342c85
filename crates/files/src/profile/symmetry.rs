//! Warnings about a picture whose solid is beside the axis, tilted, or uneven. Others name half a
//! profile that is read as a whole one, and the reverse.

use super::{ProfileAxis, hints};

/// Fewer rows than this show no form.
const LEAST_ROWS: usize = 8;
/// Fewer solid pixels side by side are noise.
const RUN: usize = 3;
/// The part of the rows that an edge must follow to be straight.
const MOST: f64 = 0.8;
/// Distances below this part of the solid's half width are left over from drawing and scanning.
const SLACK: f64 = 0.02;
/// Halves that differ by less than this part of the width are alike.
const ALIKE: f64 = 0.05;

/// The ends of a picture's solid, pixels.
struct Rows {
    /// Row, left end and right end of the solid, of each row that has some.
    spans: Vec<[f64; 3]>,
    width: f64,
}

/// Compares the solid pixels, `width` to a row, with `axis`, which is `axis_at` pixels from the left
/// edge.
pub(super) fn hint(
    solid: &[bool],
    width: usize,
    axis_at: f64,
    axis: ProfileAxis,
) -> Option<String> {
    let rows = Rows::of(solid, width);
    if rows.spans.len() < LEAST_ROWS {
        return None;
    }
    match axis {
        ProfileAxis::Left => rows.whole_as_half(),
        ProfileAxis::Center | ProfileAxis::At(_) => rows
            .half_as_whole(axis_at)
            .or_else(|| rows.beside_the_axis(axis_at)),
    }
}

/// What the rows of a drawing say of half a profile that is read as a whole one. The reverse says
/// nothing: rings and tubes are drawn beside an axis at the left edge.
/// Lengths are parts of the height; the rows count from the axis, which is `left` from the left
/// edge.
pub(super) fn hint_of_rows(
    rows: &[hints::Row],
    left: f64,
    width: f64,
    axis: ProfileAxis,
) -> Option<String> {
    let scale = rows.len() as f64;
    let at = |r: f64| scale * (r + left);
    let span = |(row, spans): (usize, &hints::Row)| {
        let (first, last) = (spans.first()?, spans.last()?);
        Some([row as f64, at(first[0]), at(last[1])])
    };
    let rows = Rows {
        spans: rows.iter().enumerate().filter_map(span).collect(),
        width: scale * width,
    };
    if rows.spans.len() < LEAST_ROWS {
        return None;
    }
    let whole = axis != ProfileAxis::Left;
    let found = whole.then(|| rows.half_as_whole(at(0.0))).flatten();
    found.map(|text| text.replace("the picture", "the drawing"))
}

impl Rows {
    fn of(solid: &[bool], width: usize) -> Self {
        let rows = solid.chunks_exact(width.max(1)).enumerate();
        let span = |(row, line): (usize, &[bool])| {
            let mut runs = line.windows(RUN).enumerate();
            let is_run = |(_, run): &(usize, &[bool])| run.iter().all(|s| *s);
            let (first, _) = runs.find(is_run)?;
            let last = runs.rfind(is_run).map_or(first, |(last, _)| last);
            Some([row as f64, first as f64, (last + RUN) as f64])
        };
        Self {
            spans: rows.filter_map(span).collect(),
            width: width as f64,
        }
    }

    fn median(&self, value: impl Fn(&[f64; 3]) -> f64) -> f64 {
        median(self.spans.iter().map(value).collect())
    }

    /// The half width of the widest rows.
    fn half_width(&self) -> f64 {
        let halves = self
            .spans
            .iter()
            .map(|[_, left, right]| 0.5 * (right - left));
        halves.fold(0.0, f64::max)
    }

    /// A length that cannot be told from none.
    fn slack(&self) -> f64 {
        (SLACK * self.half_width()).max(1.0)
    }

    /// Returns true if an end is at its median in most rows.
    fn is_straight(&self, end: impl Fn(&[f64; 3]) -> f64) -> bool {
        let at = self.median(&end);
        let near = self
            .spans
            .iter()
            .filter(|span| (end(span) - at).abs() <= 1.0);
        near.count() as f64 >= MOST * self.spans.len() as f64
    }

    /// A straight end on one side and a form on the other are half a profile.
    fn half_as_whole(&self, axis_at: f64) -> Option<String> {
        let (left, right) = (|s: &[f64; 3]| s[1], |s: &[f64; 3]| s[2]);
        let [at, end] = [self.median(left), self.median(right)];
        match (self.is_straight(left), self.is_straight(right)) {
            (true, false) if (at - axis_at).abs() > self.slack() => {
                let axis = match at {
                    ..=1.0 => "\"left\"".to_owned(),
                    _ => fraction(at / self.width),
                };
                Some(format!(
                    "the picture looks like half a profile, whose straight left edge is the axis; set profile_axis = {axis}"
                ))
            }
            (false, true) if (end - axis_at).abs() > self.slack() => Some(
                "the picture looks like half a profile, whose straight right edge is the axis; mirror it, and set profile_axis = \"left\""
                    .to_owned(),
            ),
            _ => None,
        }
    }

    /// A solid about the middle of the picture that leaves the left edge free is a whole one.
    fn whole_as_half(&self) -> Option<String> {
        let line = self.middle_line();
        let is_free = self.spans.iter().all(|[_, left, _]| *left > 1.0);
        let is_central = (line.middle - 0.5 * self.width).abs() <= self.slack();
        let is_even = line.residual <= self.slack() && line.drift.abs() <= self.slack();
        let is_tube = self.is_straight(|s| s[1]);
        (is_free && is_central && is_even && !is_tube).then(|| {
            "the picture looks like a whole silhouette, its axis in the middle; set profile_axis = \"center\" if it is"
                .to_owned()
        })
    }

    /// The middle of the rows is beside the axis, or tilted, or nothing is even about it.
    fn beside_the_axis(&self, axis_at: f64) -> Option<String> {
        let line = self.middle_line();
        if line.residual <= self.slack() {
            if line.drift.abs() > (1.5 * self.slack()).max(2.0) {
                let height = self.spans.len() as f64;
                let angle = (line.drift / height).atan().to_degrees().abs();
                return Some(format!(
                    "the solid looks tilted by {angle:.1} degrees; turn the picture upright"
                ));
            }
            let aside = (line.middle - axis_at).abs();
            return (aside > self.slack()).then(|| {
                format!(
                    "the middle of the solid is {aside:.1} pixels beside the axis; set profile_axis = {}, or crop the picture",
                    fraction(line.middle / self.width)
                )
            });
        }
        let apart = |[_, left, right]: &[f64; 3]| (right + left - 2.0 * axis_at).abs();
        let apart: f64 = self.spans.iter().map(apart).sum();
        let wide: f64 = self.spans.iter().map(|[_, left, right]| right - left).sum();
        let part = apart / wide.max(1.0);
        (part > ALIKE).then(|| {
            format!(
                "the halves of the solid differ by {:.0} % of its width, and the right one is taken; set profile_axis, or remove what is on one side alone",
                100.0 * part
            )
        })
    }

    /// The line that the middles of most rows follow: medians, since handles and shadows bring rows
    /// of their own.
    fn middle_line(&self) -> MiddleLine {
        let middle = |s: &[f64; 3]| 0.5 * (s[1] + s[2]);
        let third = self.spans.len() / 3;
        let of = |spans: &[[f64; 3]], value: &dyn Fn(&[f64; 3]) -> f64| {
            median(spans.iter().map(value).collect())
        };
        let (top, bottom) = (
            &self.spans[..third],
            &self.spans[self.spans.len() - third..],
        );
        let rise = of(bottom, &middle) - of(top, &middle);
        let run = of(bottom, &|s| s[0]) - of(top, &|s| s[0]);
        let slope = rise / run.max(1.0);
        let straightened = |s: &[f64; 3]| middle(s) - slope * s[0];
        let at = self.median(straightened);
        MiddleLine {
            middle: at + slope * self.median(|s| s[0]),
            drift: slope * self.spans.len() as f64,
            residual: self.median(|s| (straightened(s) - at).abs()),
        }
    }
}

/// A line through the middles of the rows, pixels.
struct MiddleLine {
    /// Its place half way down.
    middle: f64,
    /// Its way aside from the first row to the last.
    drift: f64,
    /// The median distance of a middle from it.
    residual: f64,
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// A part of the width in three digits.
fn fraction(value: f64) -> String {
    format!("{}", (1e3 * value).round() / 1e3)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{png_bytes, profile_from_bytes};
    use image::{GrayImage, Luma};

    /// The half width of a bottle at a depth from 0 to 1.
    fn bottle(depth: f64) -> f64 {
        match depth {
            0.05..0.3 => 0.08,
            0.3..0.5 => 0.08 + 0.6 * (depth - 0.3),
            0.5..0.95 => 0.2,
            _ => -1.0,
        }
    }

    /// Warnings about a picture of 200 x 200 pixels, solid where `form` says so.
    fn warnings(axis: ProfileAxis, form: impl Fn(f64, f64) -> bool) -> Vec<String> {
        let at = |k: u32| (f64::from(k) + 0.5) / 200.0;
        let shade = |x, y| Luma([if form(at(x), at(y)) { 30 } else { 240 }]);
        let bytes = png_bytes(GrayImage::from_fn(200, 200, shade));
        profile_from_bytes(&bytes, axis).unwrap().warnings
    }

    #[track_caller]
    fn warned(axis: ProfileAxis, words: &str, form: impl Fn(f64, f64) -> bool) {
        let found = warnings(axis, form);
        assert!(found.len() == 1 && found[0].contains(words), "{found:?}");
    }

    #[test]
    fn a_solid_about_the_axis_is_as_it_should_be() {
        let none = [""; 0];
        let whole = |x: f64, y: f64| (x - 0.5).abs() < bottle(y);
        assert_eq!(warnings(ProfileAxis::Center, whole), none);
        assert_eq!(warnings(ProfileAxis::Left, |x, y| x < bottle(y)), none);
        // Half a pixel and a column of pixels beside it is what cropping leaves.
        assert_eq!(
            warnings(ProfileAxis::Center, |x, y| whole(x + 0.004, y)),
            none
        );
        // A hollow cup, a solid whose sides the picture cuts, a tube.
        let cup = |x: f64, y: f64| {
            (0.15..0.2).contains(&(x - 0.5).abs()) && y > 0.2 || whole(x, y) && y > 0.9
        };
        assert_eq!(warnings(ProfileAxis::Center, cup), none);
        assert_eq!(warnings(ProfileAxis::Center, |_, y| y > 0.4), none);
        let tube = |x: f64, y: f64| (0.3..0.7).contains(&x) && (0.1..0.9).contains(&y);
        assert_eq!(warnings(ProfileAxis::Left, tube), none);
    }

    #[test]
    fn a_solid_beside_the_axis_is_named_and_put_right() {
        for middle in [0.62, 0.47, 0.485] {
            let form = |x: f64, y: f64| (x - middle).abs() < bottle(y);
            warned(
                ProfileAxis::Center,
                &format!("profile_axis = {middle}"),
                form,
            );
            assert_eq!(warnings(ProfileAxis::At(middle), form), [""; 0]);
        }
    }

    #[test]
    fn tilted_pictures_and_uneven_halves_are_named() {
        // The shoulders of a tilted bottle take half a degree from the larger angle.
        for (degrees, words) in [
            (-6.0f64, "tilted by 5."),
            (1.5, "tilted by 1."),
            (3.0, "tilted by "),
        ] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            warned(ProfileAxis::Center, words, |x, y| {
                let (x, y) = (x - 0.5, y - 0.5);
                (x * cos - y * sin).abs() < bottle(x * sin + y * cos + 0.5)
            });
        }
        warned(ProfileAxis::Center, "halves of the solid differ", |x, y| {
            let side = if x < 0.5 {
                bottle(y)
            } else {
                0.3 - 0.5 * bottle(y)
            };
            bottle(y) > 0.0 && (x - 0.5).abs() < side
        });
    }

    #[test]
    fn half_and_whole_profiles_are_told_apart() {
        let center = ProfileAxis::Center;
        warned(center, "profile_axis = \"left\"", |x, y| {
            x < 4.0 * bottle(y)
        });
        warned(center, "profile_axis = 0.1", |x, y| {
            (0.1..0.1 + 3.0 * bottle(y)).contains(&x)
        });
        warned(center, "mirror it", |x, y| 1.0 - x < 4.0 * bottle(y));
        warned(ProfileAxis::Left, "profile_axis = \"center\"", |x, y| {
            (x - 0.5).abs() < bottle(y)
        });
    }
}
