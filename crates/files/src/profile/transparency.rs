//! A warning about a picture whose transparency has another form than its darkness.

/// The part of a picture from which its transparency is meant to show something.
const LEAST: f64 = 0.05;

/// Compares the solid pixels with the opaque ones. Both lists have a value for each pixel.
pub(super) fn hint(solid: &[bool], opaque: &[bool], invert: bool) -> Option<String> {
    let count = |list: &mut dyn Iterator<Item = bool>| list.filter(|v| *v).count() as f64;
    let shown = count(&mut opaque.iter().copied());
    let taken = count(&mut solid.iter().zip(opaque).map(|(s, o)| *s && *o));
    let clear = 1.0 - shown / opaque.len().max(1) as f64;
    let left_out = (shown - taken) / shown.max(1.0);
    let (solid, other, paint) = match invert {
        true => ("light", "dark", "light"),
        false => ("dark", "light", "dark"),
    };
    (clear >= LEAST && left_out >= LEAST).then(|| {
        format!(
            "transparency has another form: only the {solid} {:.0} % of the opaque part is solid, the {other} rest is left out; paint all of it {paint} if it is solid",
            100.0 * (1.0 - left_out)
        )
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::{ProfileOptions, png_bytes, profile_from_bytes};
    use image::{Rgba, RgbaImage};

    /// Warnings about a vase of this shade, with a dark band, on transparency.
    fn warnings(shade: u8, invert: bool) -> Vec<String> {
        let picture = RgbaImage::from_fn(96, 96, |x, y| match (x.abs_diff(48) < 20 + y / 8, y) {
            (true, 40..56) => Rgba([20, 20, 20, 255]),
            (true, 8..88) => Rgba([shade, shade, shade, 255]),
            _ => Rgba([0; 4]),
        });
        let options = ProfileOptions {
            invert,
            ..ProfileOptions::default()
        };
        profile_from_bytes(&png_bytes(picture), options)
            .unwrap()
            .warnings
    }

    #[test]
    fn a_cut_out_of_which_a_part_is_taken_is_named() {
        let found = warnings(250, false);
        assert!(
            found.len() == 1
                && found[0].starts_with("transparency has another form: only the dark 2"),
            "{found:?}"
        );
        let found = warnings(250, true);
        assert!(
            found.len() == 1 && found[0].contains("only the light 8"),
            "{found:?}"
        );
        assert_eq!(warnings(30, false), [""; 0]);
    }
}
