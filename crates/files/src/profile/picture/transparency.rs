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
