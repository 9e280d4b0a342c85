//! Medians, intervals that are honest about few samples, geometric means, power laws.
//!
//! Times on one machine drift and come in bouts: an interval from neighbouring samples would be too
//! narrow. Samples are taken in several *passes* with everything built anew; the median of a pass
//! is one observation, and intervals are Student's over these (the method of batch means).

/// A value with the interval that covers it with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end; `+inf` above a single observation, which says nothing about spread.
    pub high: f64,
}

/// What the ratio of two times says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The whole interval is below 1.
    Faster,
    /// The whole interval is above 1.
    Slower,
    /// The interval holds 1: no difference is resolved.
    Even,
    /// The interval is wider than allowed.
    Unresolved,
}

impl Verdict {
    /// What it says, in the words for the two sides of 1.
    pub fn word<'a>(self, faster: &'a str, slower: &'a str) -> &'a str {
        match self {
            Self::Faster => faster,
            Self::Slower => slower,
            Self::Even => "no difference resolved",
            Self::Unresolved => "not resolved",
        }
    }
}

impl Interval {
    /// A value and the ends of its interval.
    pub const fn new(value: f64, low: f64, high: f64) -> Self {
        Self { value, low, high }
    }

    /// Half the width, relative to the value.
    pub fn relative(&self) -> f64 {
        (self.high - self.low) / (2.0 * self.value)
    }

    /// What the ratio of two times says; `resolved`: half the width, relative, that is allowed.
    pub fn verdict(&self, resolved: f64) -> Verdict {
        match (self.relative() <= resolved, self.low, self.high) {
            (false, ..) => Verdict::Unresolved,
            (_, _, high) if high < 1.0 => Verdict::Faster,
            (_, low, _) if low > 1.0 => Verdict::Slower,
            _ => Verdict::Even,
        }
    }

    /// Its ends, where they are known.
    pub fn ends(&self) -> Option<(f64, f64)> {
        self.high.is_finite().then_some((self.low, self.high))
    }
}

/// The value below which the share `q` of all lie (nearest rank); `None` of nothing.
pub fn quantile(values: &[f64], q: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let rank = (q * sorted.len() as f64).ceil().max(1.0) as usize;
    sorted.get(rank.min(sorted.len()).checked_sub(1)?).copied()
}

/// The middle value, or the mean of the two in the middle; `None` of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match sorted.len() % 2 {
        1 => sorted.get(half).copied(),
        _ => Some((sorted.get(half.checked_sub(1)?)? + sorted.get(half)?) / 2.0),
    }
}

/// The standard deviation of values; 0 below two.
pub fn deviation(values: &[f64]) -> f64 {
    mean_and_error(values).map_or(0.0, |(_, error)| error * (values.len() as f64).sqrt())
}

/// Mean and standard deviation of the mean; `None` below two values.
fn mean_and_error(values: &[f64]) -> Option<(f64, f64)> {
    if values.len() < 2 {
        return None;
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Some((mean, (variance / n).sqrt()))
}

/// The geometric mean of positive observations with Student's interval of their logarithms. One
/// observation has an interval that excludes nothing; `None` of nothing, or of what is not
/// positive.
pub fn geometric(observations: &[f64]) -> Option<Interval> {
    if !observations.iter().all(|v| *v > 0.0 && v.is_finite()) {
        return None;
    }
    let logs: Vec<f64> = observations.iter().map(|v| v.ln()).collect();
    let Interval { value, low, high } = mean(&logs)?;
    Some(Interval::new(value.exp(), low.exp(), high.exp()))
}

/// The logarithm of the median ratio of times that were taken in the same rounds.
pub fn log_ratio(
    a: impl IntoIterator<Item = f64>,
    b: impl IntoIterator<Item = f64>,
) -> Option<f64> {
    let logs: Vec<f64> = a.into_iter().zip(b).map(|(a, b)| (a / b).ln()).collect();
    median(&logs).filter(|v| v.is_finite())
}

/// The geometric mean over pictures, with its interval over the passes that all have. `logs`: of
/// each picture the logarithms of its passes.
pub fn over_pictures(logs: &[Vec<f64>]) -> Option<Interval> {
    geometric(&pass_means(logs))
}

/// The same of each pass.
pub fn pass_means(logs: &[Vec<f64>]) -> Vec<f64> {
    let passes = logs.iter().map(Vec::len).min().unwrap_or(0);
    let in_pass = |pass: usize| logs.iter().map(|l| l[pass]).sum::<f64>() / logs.len() as f64;
    (0..passes).map(|p| in_pass(p).exp()).collect()
}

/// The mean with Student's interval, which excludes nothing for one value; `None` of nothing.
pub fn mean(observations: &[f64]) -> Option<Interval> {
    let Some((value, error)) = mean_and_error(observations) else {
        let alone = |&value| Interval::new(value, f64::NEG_INFINITY, f64::INFINITY);
        return observations.first().map(alone);
    };
    let reach = student(observations.len() as f64 - 1.0) * error;
    Some(Interval::new(value, value - reach, value + reach))
}

/// The ratio `a / b` of geometric means of independent observations, with Welch's interval.
pub fn ratio(a: &[f64], b: &[f64]) -> Option<Interval> {
    let value = geometric(a)?.value / geometric(b)?.value;
    let error = |v: &[f64]| mean_and_error(&v.iter().map(|x| x.ln()).collect::<Vec<_>>());
    let (Some((_, ea)), Some((_, eb))) = (error(a), error(b)) else {
        return Some(Interval::new(value, 0.0, f64::INFINITY));
    };
    let (va, vb) = (ea * ea, eb * eb);
    let degrees = if va + vb > 0.0 {
        (va + vb).powi(2) / (va * va / (a.len() as f64 - 1.0) + vb * vb / (b.len() as f64 - 1.0))
    } else {
        1e9
    };
    let reach = (student(degrees) * (va + vb).sqrt()).exp();
    Some(Interval::new(value, value / reach, value * reach))
}

/// The factor on the standard error that gives a two-sided 95 % interval with `degrees` of freedom
/// (Student's t).
///
/// Between the tabled degrees it is interpolated in `1 / degrees`, within 0.5 %.
pub fn student(degrees: f64) -> f64 {
    const DEGREES: [f64; 13] = [
        1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 15.0, 30.0, 120.0, 1e12,
    ];
    const FACTORS: [f64; 13] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.228, 2.131, 2.042, 1.980, 1.960,
    ];
    let degrees = degrees.clamp(1.0, 1e12);
    let above = DEGREES.partition_point(|d| *d < degrees);
    let above = above.clamp(1, DEGREES.len() - 1);
    let [(d0, t0), (d1, t1)] = [above - 1, above].map(|k| (DEGREES[k], FACTORS[k]));
    let share = (1.0 / d0 - 1.0 / degrees) / (1.0 / d0 - 1.0 / d1);
    t0 + share * (t1 - t0)
}

/// `y = factor * x ^ exponent`, fitted to logarithms by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The power.
    pub exponent: f64,
    /// `y` at `x = 1`.
    pub factor: f64,
}

impl PowerLaw {
    /// Fits positive points; `None` below two different `x`.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let positive = points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0);
        let logs: Vec<(f64, f64)> = positive.map(|(x, y)| (x.ln(), y.ln())).collect();
        let n = logs.len() as f64;
        let mx = logs.iter().map(|l| l.0).sum::<f64>() / n;
        let my = logs.iter().map(|l| l.1).sum::<f64>() / n;
        let sxx: f64 = logs.iter().map(|(x, _)| (x - mx).powi(2)).sum();
        let sxy: f64 = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
        let exponent = sxy / sxx;
        (sxx > 1e-12).then(|| Self {
            exponent,
            factor: (my - exponent * mx).exp(),
        })
    }

    /// `y` at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn ranks_and_medians() {
        let v = [5.0, 1.0, 3.0, 2.0];
        assert_eq!(median(&v), Some(2.5));
        assert_eq!(median(&v[..3]), Some(3.0));
        assert_eq!((median(&[]), quantile(&[], 0.5)), (None, None));
        let ranks = [0.0, 0.75, 0.76].map(|q| quantile(&v, q));
        assert_eq!(ranks, [Some(1.0), Some(3.0), Some(5.0)]);
        let hundred: Vec<f64> = (1..=100).map(f64::from).collect();
        assert_eq!(quantile(&hundred, 0.95), Some(95.0));
    }

    #[test]
    fn the_interval_of_known_observations() {
        // Logarithms -0.1, 0, 0.1: mean 0, standard error 0.1 / sqrt 3, two degrees of freedom.
        let i = geometric(&[(-0.1f64).exp(), 1.0, 0.1f64.exp()]).unwrap();
        let reach = 4.303 * 0.1 / 3f64.sqrt();
        assert!((i.value - 1.0).abs() < 1e-12);
        assert!((i.low.ln() + reach).abs() < 1e-9 && (i.high.ln() - reach).abs() < 1e-9);
        let m = mean(&[1.0, 2.0, 3.0]).unwrap();
        assert!((m.value - 2.0).abs() < 1e-12 && (m.high - 2.0 - 4.303 / 3f64.sqrt()).abs() < 1e-9);
        let one = geometric(&[2.0]).unwrap();
        assert_eq!((one.value, one.high), (2.0, f64::INFINITY));
        for none in [&[][..], &[1.0, 0.0], &[1.0, f64::NAN]] {
            assert_eq!(geometric(none), None);
        }
    }

    /// 95 % intervals cover the truth in 95 % of many trials, not in 80 and not in 100.
    #[test]
    fn intervals_cover_as_often_as_they_say() {
        let mut random = crate::random::Random(7);
        let mut gauss = || {
            let (a, b) = (random.next().max(1e-300), random.next());
            (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
        };
        let (mut single, mut double) = (0, 0);
        for _ in 0..4000 {
            let a: Vec<f64> = (0..4).map(|_| (0.2 * gauss()).exp() * 3.0).collect();
            let b: Vec<f64> = (0..4).map(|_| (0.05 * gauss()).exp()).collect();
            let i = geometric(&a).unwrap();
            single += usize::from(i.low <= 3.0 && 3.0 <= i.high);
            let r = ratio(&a, &b).unwrap();
            double += usize::from(r.low <= 3.0 && 3.0 <= r.high);
        }
        assert!((3740..3860).contains(&single), "{single} of 4000");
        assert!((3720..3900).contains(&double), "{double} of 4000");
    }

    #[test]
    fn students_factor_between_the_tabled() {
        let degrees = [1.0, 9.0, 12.0, 20.0, 60.0, 1e15];
        let tabled = [12.706, 2.262, 2.179, 2.086, 2.000, 1.960];
        for (degrees, t) in degrees.into_iter().zip(tabled) {
            let found = student(degrees);
            assert!((found / t - 1.0).abs() < 5e-3, "{degrees}: {found}");
        }
    }

    #[test]
    fn a_power_law_is_found() {
        let points = [1.0, 4.0, 16.0, 64.0].map(|x: f64| (x, 3.0 * x.powf(0.75)));
        let law = PowerLaw::fit(&points).unwrap();
        assert!((law.exponent - 0.75).abs() < 1e-12 && (law.factor - 3.0).abs() < 1e-12);
        assert!((law.at(4.0) - points[1].1).abs() < 1e-9);
        for none in [&points[..1], &[(2.0, 1.0), (2.0, 3.0)], &[]] {
            assert!(PowerLaw::fit(none).is_none());
        }
    }
}
