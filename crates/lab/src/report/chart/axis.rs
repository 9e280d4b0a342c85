//! Axes: from values to places, and the values worth a tick.

use super::super::names::number;

/// An axis as a chart asks for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its quantity and unit.
    pub label: String,
    /// True if equal ratios are equally far apart.
    pub log: bool,
    /// On logarithmic axes: what lies below is drawn here, and the tick says so. Errors of zero
    /// have a place this way.
    pub floor: Option<f64>,
    /// Values that must be in sight.
    pub include: Vec<f64>,
    /// Places of ticks; empty: round values.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            log: true,
            floor: None,
            include: Vec::new(),
            ticks: Vec::new(),
        }
    }

    /// An even axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            log: false,
            ..Self::log(label)
        }
    }

    /// With a floor.
    pub fn from(mut self, floor: f64) -> Self {
        self.floor = Some(floor);
        self
    }

    /// With ticks at these values, and only there.
    pub fn at(mut self, ticks: impl IntoIterator<Item = f64>) -> Self {
        self.ticks.extend(ticks);
        self.ticks.sort_by(f64::total_cmp);
        self.ticks.dedup();
        self
    }

    /// With a value that must be in sight.
    pub fn with(mut self, value: f64) -> Self {
        self.include.push(value);
        self
    }
}

/// An axis laid out over its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    log: bool,
    floor: Option<f64>,
    low: f64,
    high: f64,
    /// Values with a line and a word.
    pub ticks: Vec<(f64, String)>,
}

impl Scale {
    /// Fits an axis to values; those that have no place on it (not finite; on a logarithmic axis
    /// not positive and no floor) are left out.
    pub fn new(axis: &Axis, values: impl IntoIterator<Item = f64>) -> Self {
        let shown = |v: f64| match axis.floor {
            Some(floor) if axis.log => v.max(floor),
            _ => v,
        };
        let values: Vec<f64> = values
            .into_iter()
            .chain(axis.include.iter().copied())
            .map(shown)
            .filter(|v| v.is_finite() && (!axis.log || *v > 0.0))
            .collect();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = match (low <= high, axis.log) {
            (false, true) => (0.1, 10.0),
            (false, false) => (0.0, 1.0),
            (true, _) => (low, high),
        };
        let mut scale = if axis.log {
            Self::logarithmic(axis.floor, low, high)
        } else {
            Self::even(low, high)
        };
        if !axis.ticks.is_empty() {
            let inside = axis
                .ticks
                .iter()
                .filter(|v| scale.place(**v).is_some_and(|p| (0.0..=1.0).contains(&p)));
            scale.ticks = inside.map(|v| (*v, word(*v))).collect();
        }
        scale
    }

    fn logarithmic(floor: Option<f64>, low: f64, high: f64) -> Self {
        // Room for the markers at the ends.
        let pad = (0.04 * (high / low).ln()).max(0.1);
        let (low, high) = (low * (-pad).exp(), high * pad.exp());
        let decades = (high / low).log10();
        let steps: &[f64] = if decades > 2.2 {
            &[1.0]
        } else if decades > 1.1 {
            &[1.0, 2.0, 5.0]
        } else if decades > 0.5 {
            &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]
        } else {
            &[
                1.0, 1.1, 1.2, 1.3, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5,
                6.0, 7.0, 8.0, 9.0,
            ]
        };
        // Over many decades every second or third is enough.
        let stride = ((decades / 7.0).ceil() as i32).max(1);
        let mut ticks = Vec::new();
        for decade in low.log10().floor() as i32..=high.log10().ceil() as i32 {
            if decade.rem_euclid(stride) != 0 {
                continue;
            }
            for step in steps {
                let value = step * 10f64.powi(decade);
                if (low..=high).contains(&value) && floor.is_none_or(|f| value > f * 1.5) {
                    ticks.push((value, word(value)));
                }
            }
        }
        if let Some(floor) = floor.filter(|f| *f >= low) {
            ticks.insert(0, (floor, format!("≤ {}", word(floor))));
        }
        Self {
            log: true,
            floor,
            low,
            high,
            ticks,
        }
    }

    fn even(low: f64, high: f64) -> Self {
        let span = if high > low {
            high - low
        } else {
            low.abs().max(1.0)
        };
        let rough = span / 5.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 2.5, 5.0, 10.0]
            .map(|s| s * power)
            .into_iter()
            .find(|s| *s >= rough)
            .unwrap_or(rough);
        let first = (low / step + 1e-9).floor();
        let last = (high / step - 1e-9).ceil().max(first + 1.0);
        let ticks = (0..=(last - first) as i32)
            .map(|k| (first + f64::from(k)) * step)
            .map(|v| (v, number(v, 4)))
            .collect();
        Self {
            log: false,
            floor: None,
            low: first * step,
            high: last * step,
            ticks,
        }
    }

    /// The place of a value: 0 at the low end, 1 at the high one. `None` where it has no place on
    /// this axis.
    pub fn place(&self, value: f64) -> Option<f64> {
        if !self.log {
            return value
                .is_finite()
                .then(|| (value - self.low) / (self.high - self.low));
        }
        let value = match self.floor {
            Some(floor) => value.max(floor),
            None => value,
        };
        (value > 0.0 && value.is_finite())
            .then(|| (value / self.low).ln() / (self.high / self.low).ln())
    }
}

/// A tick's word: plain between a thousandth and 99,999, else a power of ten.
fn word(value: f64) -> String {
    if value <= 0.0 {
        return number(value, 3);
    }
    let exponent = value.log10().round() as i32;
    let exact = (value / 10f64.powi(exponent) - 1.0).abs() < 1e-9;
    if exact && !(-3..=4).contains(&exponent) {
        let digits: String = exponent
            .to_string()
            .chars()
            .map(|c| match c {
                '-' => '⁻',
                '0' => '⁰',
                '1' => '¹',
                '2' => '²',
                '3' => '³',
                d => char::from_u32(0x2070 + u32::from(d) - u32::from('0')).unwrap_or(d),
            })
            .collect();
        return format!("10{digits}");
    }
    number(value, 4)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn words(scale: &Scale) -> Vec<&str> {
        scale.ticks.iter().map(|(_, w)| w.as_str()).collect()
    }

    #[test]
    fn logarithmic_ticks() {
        let wide = Scale::new(&Axis::log("x"), [2e-5, 3e4]);
        assert!(
            words(&wide).contains(&"10⁻⁴") && words(&wide).len() <= 8,
            "{:?}",
            words(&wide)
        );
        let narrow = Scale::new(&Axis::log("x"), [21.0, 26.0]);
        assert!(
            (3..9).contains(&words(&narrow).len()),
            "{:?}",
            words(&narrow)
        );
        let one = Scale::new(&Axis::log("x"), [7.0]);
        assert!(!one.ticks.is_empty() && (one.place(7.0).unwrap() - 0.5).abs() < 1e-9);
        for scale in [wide, narrow] {
            assert!(
                scale
                    .ticks
                    .iter()
                    .all(|(v, _)| (0.0..=1.0).contains(&scale.place(*v).unwrap()))
            );
        }
    }

    #[test]
    fn zeros_stand_on_the_floor() {
        let scale = Scale::new(&Axis::log("x").from(1e-4), [0.0, 3.0]);
        assert_eq!(words(&scale)[0], "≤ 10⁻⁴");
        assert_eq!(scale.place(0.0), scale.place(1e-4));
        assert!(scale.place(0.0).unwrap() > 0.0);
        // Without zeros there is no such tick.
        assert!(!words(&Scale::new(&Axis::log("x").from(1e-4), [0.5, 3.0]))[0].starts_with('≤'));
        assert_eq!(Scale::new(&Axis::log("x"), [1.0]).place(0.0), None);
    }

    #[test]
    fn even_ticks() {
        assert_eq!(
            words(&Scale::new(&Axis::linear("x").with(0.0), [0.93])),
            ["0", "0.2", "0.4", "0.6", "0.8", "1"]
        );
        assert_eq!(
            words(&Scale::new(&Axis::linear("x"), [])).first(),
            Some(&"0")
        );
    }
}
