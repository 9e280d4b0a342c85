//! A camera above the thing: foot and rim are ellipses, which are cut at their middles.

/// Rows in which ellipses are fitted.
const ROWS: usize = 480;
/// Less is not told from a rounded foot, degrees.
const LEAST: f64 = 10.5;
/// A rounder and narrower foot is a tip, as that of a light bulb. Part of the largest half width.
const LEAST_FOOT: f64 = 0.25;

/// Half of an ellipse at the end of an outline: half axes, and the row of its middle.
struct Arc {
    across: f64,
    down: f64,
    middle: f64,
}

impl Arc {
    /// The widest arc with which the half widths begin.
    fn of(radii: &[f64]) -> Option<Self> {
        let mut widest = 0.0f64;
        let rising: Vec<f64> = radii[..radii.len() * 9 / 20]
            .iter()
            .map(|r| {
                widest = widest.max(*r);
                widest
            })
            .collect();
        let mut best = None;
        for k in 0..90 {
            let across = widest * (0.1 + 0.9 * f64::from(k) / 89.0);
            if across < 6.0 {
                continue;
            }
            let samples: Vec<[f64; 2]> = (0..50)
                .map(|i| {
                    let x = 0.98 * f64::from(i) / 49.0;
                    let row = rising.partition_point(|r| *r < x * across) as f64;
                    [(1.0 - x * x).sqrt(), row]
                })
                .collect();
            let mean = |of: &dyn Fn(&[f64; 2]) -> f64| samples.iter().map(of).sum::<f64>() / 50.0;
            let (g, y) = (mean(&|s| s[0]), mean(&|s| s[1]));
            let down = -mean(&|s| (s[0] - g) * (s[1] - y)) / mean(&|s| (s[0] - g).powi(2));
            let middle = y + down * g;
            let rms = mean(&|s| (middle - down * s[0] - s[1]).powi(2)).sqrt();
            if rms < 0.45 + 0.006 * across && down > 0.6 {
                best = Some(Self {
                    across,
                    down,
                    middle,
                });
            }
        }
        best
    }

    /// The elevation of the camera, degrees.
    fn elevation(&self, most: f64) -> Option<f64> {
        let ratio = self.down / self.across;
        (ratio < most).then(|| ratio.asin().to_degrees())
    }
}

/// A view from above.
pub(crate) struct View {
    /// Rows of the middles of the rim and of the foot.
    pub ends: [f64; 2],
    /// Elevation of the camera above the middle of the thing, degrees.
    pub elevation: f64,
    /// Half widths as from the side: of the largest circles that hide nothing of the ground.
    pub radii: Vec<f64>,
}

/// The thing as from the side, if the camera is clearly above it. `step` is the height of a row.
pub(crate) fn seen_from(radii: &[f64], step: f64) -> Option<View> {
    let scale = radii.len() as f64 / ROWS as f64;
    let widths: Vec<f64> = (0..ROWS)
        .map(|k| at(radii, (k as f64 + 0.5) * scale - 0.5) / (step * scale))
        .collect();
    let upward: Vec<f64> = widths.iter().rev().copied().collect();
    let (foot, rim) = (Arc::of(&upward), Arc::of(&widths));
    let widest = widths.iter().copied().fold(0.0, f64::max);
    let wide = foot.as_ref().filter(|a| a.across > LEAST_FOOT * widest);
    let mut low = wide.and_then(|a| a.elevation(0.72));
    let high = rim.as_ref().filter(|a| a.across > 0.1 * ROWS as f64);
    let high = high.and_then(|a| a.elevation(0.5));
    if let Some(high) = high.filter(|high| *high > 14.0) {
        low = Some(low.map_or(high + 5.0, |low| low.min(high + 9.0)));
    }
    let low = low.filter(|low| *low >= LEAST)?;
    let from = match (&rim, high) {
        (Some(rim), Some(high)) if high > 4.0 => Some(rim.middle * scale),
        _ => None,
    };
    let lift = foot.map_or(0.0, |foot| foot.across * low.to_radians().sin());
    let elevation = high.map_or(low - 4.0, |high| 0.5 * (low + high));
    let ends = [from.unwrap_or(0.0), (ROWS as f64 - lift) * scale];
    let rim = high.unwrap_or(2.0 * elevation - low).max(0.0);
    let tilt = |row: f64| {
        let t = ((row - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0);
        (rim + t * (low - rim)).to_radians().sin()
    };
    let inner = |row: usize| inscribed(radii, step, row, tilt(row as f64));
    let inner: Vec<f64> = (0..radii.len()).map(inner).collect();
    // The far half of a small rim: circles grow as fast as an ellipse of its flatness lets them.
    let steep = 0.6 * step / tilt(0.0).max(0.02);
    let far = inner
        .windows(5)
        .take_while(|w| w[4] - w[0] > 4.0 * steep)
        .count();
    Some(View {
        ends: [from.unwrap_or(far as f64), ends[1]],
        elevation,
        radii: inner,
    })
}

/// The radius of the largest circle about a row's middle that is within the half widths where it is
/// seen as an ellipse of this flatness.
fn inscribed(radii: &[f64], step: f64, row: usize, flatness: f64) -> f64 {
    let fits = |r: f64| {
        (-8..=8).all(|k| {
            let t = f64::from(k) / 9.0;
            let place = row as f64 + t * r * flatness / step;
            let inside = (-0.5..radii.len() as f64 - 0.5).contains(&place);
            inside && at(radii, place) >= r * (1.0 - t * t).sqrt() * 0.99
        })
    };
    let (mut low, mut high) = (0.0, radii[row]);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        match fits(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// The value at a place between rows.
pub(crate) fn at(rows: &[f64], place: f64) -> f64 {
    let place = place.clamp(0.0, (rows.len().max(1) - 1) as f64);
    let i = place as usize;
    let next = rows[(i + 1).min(rows.len() - 1)];
    rows[i] + (next - rows[i]) * (place - i as f64)
}
