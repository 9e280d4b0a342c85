//! Rounding that never makes a stored distance exceed the true one.

use super::half::{from_half, to_half};

/// The largest 32-bit float that is not above `v`.
#[must_use]
pub fn round_down(v: f64) -> f32 {
    let nearest = v as f32;
    if f64::from(nearest) > v {
        nearest.next_down()
    } else {
        nearest
    }
}

/// The bits of the largest 16-bit float that is not above `v`. Values beyond the range become the
/// largest float or `-inf`.
#[must_use]
pub fn round_down_half(v: f32) -> u16 {
    let nearest = to_half(v);
    if from_half(nearest) <= v || v.is_nan() {
        return nearest;
    }
    // The next lower value: one less in magnitude above zero, one more below.
    match nearest {
        0x0000 => 0x8001,
        0x8000.. => nearest + 1,
        _ => nearest - 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn never_above_and_next_would_be(v in prop_oneof![-2.0f64..2.0, -1e-7f64..1e-7, -1e5f64..1e5]) {
            let single = round_down(v);
            prop_assert!(f64::from(single) <= v && f64::from(single.next_up()) > v);
            let half = round_down_half(single);
            prop_assert!(from_half(half) <= single);
            let above = from_half(match half {
                0x8000 => 0x0001,
                0x8001.. => half - 1,
                _ => half + 1,
            });
            prop_assert!(above > single, "{} for {single}, {above} would do", from_half(half));
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(round_down_half(f32::INFINITY), 0x7c00);
        assert_eq!(round_down_half(1e6), 0x7bff);
        assert_eq!(round_down_half(-1e6), 0xfc00);
        assert_eq!(round_down_half(0.0), 0);
        assert_eq!(round_down_half(-1e-30), 0x8001);
        assert_eq!(round_down_half(1e-30), 0);
        assert!(from_half(round_down_half(f32::NAN)).is_nan());
    }
}
