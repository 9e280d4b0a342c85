//! Axes: from values to places, and the values worth a tick.

use crate::names::number;

/// An axis as a chart asks for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its quantity and unit.
    pub label: String,
    /// True if equal ratios are equally far apart.
    pub log: bool,
    /// On logarithmic axes: what lies below is drawn here, zeros too, and the tick says so.
    pub floor: Option<f64>,
    /// Values that must be in sight.
    pub include: Vec<f64>,
    /// Places of ticks; empty: round values.
    pub ticks: Vec<f64>,
    /// Names of lines at 0, -1, -2 and so on, in place of values.
    pub names: Vec<String>,
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
            names: Vec::new(),
        }
    }

    /// An axis of named lines, without a label.
    pub fn names(names: Vec<String>) -> Self {
        Self {
            names,
            ..Self::linear("")
        }
    }

    /// An even axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            log: false,
            ..Self::log(label)
        }
    }

    /// With this value of [`Self::floor`].
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
    /// Fits an axis to values; those that have no place on it are left out.
    pub fn new(axis: &Axis, values: impl IntoIterator<Item = f64>) -> Self {
        if !axis.names.is_empty() {
            let ticks = axis.names.iter().enumerate();
            return Self {
                log: false,
                floor: None,
                low: 0.5 - axis.names.len() as f64,
                high: 0.5,
                ticks: ticks.map(|(k, name)| (-(k as f64), name.clone())).collect(),
            };
        }
        let floor = axis.floor.filter(|_| axis.log);
        let values = values.into_iter().chain(axis.include.iter().copied());
        let shown = values.map(|v| floor.map_or(v, |floor| v.max(floor)));
        let known = shown.filter(|v| v.is_finite() && (!axis.log || *v > 0.0));
        let ends = known.fold(None, |ends: Option<(f64, f64)>, v| {
            let (low, high) = ends.unwrap_or((v, v));
            Some((low.min(v), high.max(v)))
        });
        let mut scale = match (ends, axis.log) {
            (ends, true) => Self::logarithmic(floor, ends.unwrap_or((0.1, 10.0))),
            (ends, false) => Self::even(ends.unwrap_or((0.0, 1.0))),
        };
        if !axis.ticks.is_empty() {
            let inside = |p: f64| (0.0..=1.0).contains(&p);
            let shown = |v: &f64| scale.place(*v).is_some_and(inside);
            let ticks = axis.ticks.iter().copied().filter(shown);
            scale.ticks = ticks.map(|v| (v, word(v))).collect();
        }
        scale
    }

    fn logarithmic(floor: Option<f64>, (low, high): (f64, f64)) -> Self {
        // Room for the markers at the ends.
        let pad = (0.04 * (high / low).ln()).max(0.1);
        let (low, high) = (low * (-pad).exp(), high * pad.exp());
        let decades = (high / low).log10();
        let steps: &[f64] = match decades {
            2.2.. => &[1.0],
            1.1.. => &[1.0, 2.0, 5.0],
            0.5.. => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            _ => &[
                1.0, 1.1, 1.2, 1.3, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5,
                6.0, 7.0, 8.0, 9.0,
            ],
        };
        // Over many decades every second or third is enough.
        let stride = ((decades / 7.0).ceil() as i32).max(1);
        let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let powers = powers.filter(|decade| decade % stride == 0);
        let values = powers.flat_map(|d| steps.iter().map(move |step| step * 10f64.powi(d)));
        let above = |value: f64| floor.is_none_or(|f| value > f * 1.5);
        let shown = values.filter(|v| (low..=high).contains(v) && above(*v));
        let floors = floor.filter(|f| *f >= low).into_iter();
        let floors = floors.map(|f| (f, format!("≤ {}", word(f))));
        Self {
            log: true,
            floor,
            low,
            high,
            ticks: floors.chain(shown.map(|v| (v, word(v)))).collect(),
        }
    }

    fn even((low, high): (f64, f64)) -> Self {
        let one = low.abs().max(1.0);
        let span = if high > low { high - low } else { one };
        let rough = span / 5.0;
        let power = 10f64.powf(rough.log10().floor());
        let steps = [1.0, 2.0, 2.5, 5.0, 10.0].map(|s| s * power);
        let step = steps.into_iter().find(|s| *s >= rough).unwrap_or(rough);
        let first = (low / step + 1e-9).floor();
        let last = (high / step - 1e-9).ceil().max(first + 1.0);
        let values = (0..=(last - first) as i32).map(|k| (first + f64::from(k)) * step);
        Self {
            log: false,
            floor: None,
            low: first * step,
            high: last * step,
            ticks: values.map(|v| (v, number(v, 4))).collect(),
        }
    }

    /// The place of a value: 0 at the low end, 1 at the high one; `None` where it has none.
    pub fn place(&self, value: f64) -> Option<f64> {
        let value = self.floor.map_or(value, |floor| value.max(floor));
        let unit = |v: f64| if self.log { v.ln() } else { v };
        let [value, low, high] = [value, self.low, self.high].map(unit);
        let place = (value - low) / (high - low);
        place.is_finite().then_some(place)
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
        let raised = |c: char| match c.to_digit(10) {
            Some(digit) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize],
            None => '⁻',
        };
        let digits: String = exponent.to_string().chars().map(raised).collect();
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
        let said = words(&wide);
        assert!(said.contains(&"10⁻⁴") && said.len() <= 8, "{said:?}");
        let narrow = Scale::new(&Axis::log("x"), [21.0, 26.0]);
        let said = words(&narrow);
        assert!((3..9).contains(&said.len()), "{said:?}");
        let one = Scale::new(&Axis::log("x"), [7.0]);
        assert!(!one.ticks.is_empty() && (one.place(7.0).unwrap() - 0.5).abs() < 1e-9);
        for scale in [wide, narrow] {
            let places = scale.ticks.iter().map(|(v, _)| scale.place(*v).unwrap());
            assert!(places.into_iter().all(|p| (0.0..=1.0).contains(&p)));
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
        let scale = Scale::new(&Axis::linear("x").with(0.0), [0.93]);
        assert_eq!(words(&scale), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(words(&Scale::new(&Axis::linear("x"), []))[0], "0");
    }
}
