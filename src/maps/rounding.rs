//! Roundings of distances that never make a distance larger, and floats of 16 bits.

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
pub(super) fn round_down_half(v: f32) -> u16 {
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

/// The bits of the nearest 16-bit float (IEEE 754 binary16), ties to even; an infinity beyond the range.
pub(super) fn to_half(v: f32) -> u16 {
    let sign = (v.to_bits() >> 16) as u16 & 0x8000;
    let bits = v.to_bits() & 0x7fff_ffff;
    sign | match bits {
        0x7f80_0001.. => 0x7e00, // no number
        0x477f_f000.. => 0x7c00, // half way from the largest to the next power, or more
        0x3880_0000.. => {
            // Magnitudes from 2^-14: the exponent loses 112, the mantissa its last 13 bits.
            let odd = (bits >> 13) & 1;
            ((bits - 0x3800_0000 + 0xfff + odd) >> 13) as u16
        }
        _ => (f32::from_bits(bits) / TINY).round_ties_even() as u16,
    }
}

/// The value of the bits of a 16-bit float.
pub(super) fn from_half(half: u16) -> f32 {
    let bits = u32::from(half & 0x7fff);
    let v = match bits {
        0x7c00.. => f32::from_bits(0x7f80_0000 | (bits << 13)),
        0x0400.. => f32::from_bits((bits << 13) + 0x3800_0000),
        _ => bits as f32 * TINY,
    };
    if half & 0x8000 == 0 { v } else { -v }
}

/// The smallest 16-bit float above 0: 2^-24.
const TINY: f32 = f32::from_bits(0x3380_0000);

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

        /// No other 16-bit float is nearer, and the even one is used of two that are equally near.
        #[test]
        fn the_nearest_is_taken(v in prop_oneof![-2.0f32..2.0, -1e-6f32..1e-6, -65_519.0f32..65_519.0]) {
            let half = to_half(v);
            let error = (f64::from(from_half(half)) - f64::from(v)).abs();
            for other in [half.wrapping_add(1), half.wrapping_sub(1)] {
                let theirs = (f64::from(from_half(other)) - f64::from(v)).abs();
                if theirs.is_finite() {
                    prop_assert!(error < theirs || (error == theirs && half & 1 == 0));
                }
            }
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

    #[test]
    fn every_half_comes_back() {
        for bits in 0..=u16::MAX {
            let v = from_half(bits);
            assert_eq!(v.is_nan(), bits & 0x7fff > 0x7c00, "{bits:#x}");
            if !v.is_nan() {
                assert_eq!(to_half(v), bits);
            }
        }
        assert_eq!(from_half(0x3c00), 1.0);
        assert_eq!(from_half(0xc000), -2.0);
        assert_eq!(from_half(0x7bff), 65_504.0);
        assert_eq!(from_half(0x0001), 2f32.powi(-24));
        assert_eq!(to_half(f32::NAN) & 0x7fff, 0x7e00);
        assert_eq!((to_half(65_519.9), to_half(65_520.0)), (0x7bff, 0x7c00));
        assert_eq!((to_half(TINY * 0.5), to_half(TINY * 0.500_001)), (0, 1));
    }
}
