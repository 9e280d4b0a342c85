//! Rounding that never lets a stored distance exceed the true one.

use half::f16;

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

/// The largest 16-bit float that is not above `v`; what lies beyond the range becomes its largest or `-inf`.
#[must_use]
pub fn round_down_half(v: f32) -> f16 {
    let nearest = f16::from_f32(v);
    if nearest.to_f32() <= v || v.is_nan() {
        return nearest;
    }
    // The next lower value: one less in magnitude above zero, one more below.
    let bits = nearest.to_bits();
    f16::from_bits(match bits {
        0x0000 => 0x8001,
        0x8000.. => bits + 1,
        _ => bits - 1,
    })
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
            prop_assert!(half.to_f32() <= single);
            let above = f16::from_bits(match half.to_bits() {
                0x8000 => 0x0001,
                b @ 0x8001.. => b - 1,
                b => b + 1,
            });
            prop_assert!(above.to_f32() > single, "{half} for {single}, {above} would do");
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(round_down_half(f32::INFINITY), f16::INFINITY);
        assert_eq!(round_down_half(1e6), f16::MAX);
        assert_eq!(round_down_half(-1e6), f16::NEG_INFINITY);
        assert_eq!(round_down_half(0.0), f16::ZERO);
        assert_eq!(round_down_half(-1e-30), f16::from_bits(0x8001));
        assert_eq!(round_down_half(1e-30), f16::ZERO);
        assert!(round_down_half(f32::NAN).is_nan());
    }
}
