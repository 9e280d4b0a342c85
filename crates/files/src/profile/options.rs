//! Options for reading a picture: the grey level that is solid and the amount of noise that is
//! blurred away. Also warnings about a picture that looks unintended.

use super::noise::{ROUGH, Smooth};
use crate::content_fault;
use crate::trace::roughness;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::profile::{Outline, Raster, loop_area};

/// The part of the picture that is the half-plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ProfileAxis {
    /// The axis is the left edge: the picture is a half profile.
    Left,
    /// The axis is the middle: the picture is a whole silhouette, and its right half is used.
    #[default]
    Center,
    /// The axis is at this fraction of the width, from 0 (left) to below 1, and the part right of it
    /// is used. In a picture it moves to the nearest edge or middle of a column of pixels.
    At(f64),
}

impl ProfileAxis {
    /// A name that is read and not listed.
    pub(crate) const BRITISH: (&'static str, Self) = ("centre", Self::Center);
    /// The values with a name in options and scene files; a number is [`ProfileAxis::At`].
    pub const NAMES: [(&'static str, Self); 2] = [("left", Self::Left), ("center", Self::Center)];

    /// The axis as a fraction of the width.
    #[must_use]
    pub fn fraction(self) -> f64 {
        match self {
            Self::Left => 0.0,
            Self::Center => 0.5,
            Self::At(fraction) => fraction,
        }
    }
}

impl std::str::FromStr for ProfileAxis {
    type Err = String;

    /// A name or a number, as in scene files.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let mut names = Self::NAMES.iter().chain([&Self::BRITISH]);
        let named = names.find(|(name, _)| *name == text);
        match (named, text.parse()) {
            (Some((_, axis)), _) => Ok(*axis),
            (None, Ok(fraction)) => Ok(Self::At(fraction)),
            _ => Err("give left, center, or a fraction of the width such as 0.62".to_owned()),
        }
    }
}

/// The way in which the solid of a picture is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProfileRead {
    /// By a grey level, about an axis that is given.
    #[default]
    Threshold,
    /// Ground, thing, axis and tilt of a photograph are found. A picture without colour of which
    /// 99 % are near two greys is a drawing, and read by a grey level of one half. In drawings the
    /// middle is the axis, unless half a profile or a solid beside the middle has another, and pale
    /// paint is solid if nothing is dark. [`Profile::notes`](revmap::profile::Profile::notes) say so.
    Auto,
}

impl ProfileRead {
    /// The names in options and scene files.
    pub const NAMES: [(&'static str, Self); 2] =
        [("threshold", Self::Threshold), ("auto", Self::Auto)];
}

/// Options for reading a profile from a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileOptions {
    /// The part of the picture that is the half-plane.
    pub axis: ProfileAxis,
    /// The way in which the solid is found. [`ProfileRead::Auto`] takes no threshold or inversion, and
    /// of pictures no axis.
    pub read: ProfileRead,
    /// Grey level in `(0, 1)` below which a pixel is solid, 0 black and 1 white, in the picture's
    /// own (sRGB) values. For pictures only.
    pub threshold: f64,
    /// Light is solid instead of dark, over black: transparent pixels stay empty. For pictures
    /// only.
    pub invert: bool,
    /// Gaussian blur that removes noise before the outline is traced. For pictures only.
    pub smooth: Smooth,
    /// Strokes thinner than this part of the height are left out, such as dimensions, centre lines
    /// and the frame of a sheet. For drawings only.
    pub min_stroke: f64,
}

impl Default for ProfileOptions {
    fn default() -> Self {
        Self {
            axis: ProfileAxis::default(),
            read: ProfileRead::default(),
            threshold: 0.5,
            invert: false,
            smooth: Smooth::default(),
            min_stroke: 0.0,
        }
    }
}

impl From<ProfileAxis> for ProfileOptions {
    fn from(axis: ProfileAxis) -> Self {
        Self {
            axis,
            ..Self::default()
        }
    }
}

impl ProfileOptions {
    /// Keys that [`ProfileRead::Threshold`] alone takes.
    pub(crate) const OF_THRESHOLD: [&'static str; 3] =
        ["profile_axis", "profile_threshold", "profile_invert"];
    const NOT_AUTO: &str =
        "counts for profile_read = \"threshold\" alone; leave one of the two out";
    /// The largest standard deviation of the blur, pixels.
    pub const MOST_SMOOTH: f64 = 100.0;

    /// Checks every value.
    ///
    /// # Errors
    /// [`ErrorKind::Content`](revmap::error::ErrorKind::Content), with the key as in a scene file.
    pub fn check(&self) -> Result<()> {
        let wrong = |key: &str, message: String| Err(content_fault(message).at_key(key));
        let fraction = self.axis.fraction();
        if !(0.0..1.0).contains(&fraction) {
            let message =
                format!("is {fraction:?}; give a fraction of the width, 0 or more and below 1");
            return wrong("profile_axis", message);
        }
        if !(self.threshold > 0.0 && self.threshold < 1.0) {
            let message = format!("is {:?}; give a grey level between 0 and 1", self.threshold);
            return wrong("profile_threshold", message);
        }
        if self.read == ProfileRead::Auto {
            self.refuse(&["profile_threshold", "profile_invert"], Self::NOT_AUTO)?;
        }
        if let Smooth::Pixels(pixels) = self.smooth
            && !(0.0..=Self::MOST_SMOOTH).contains(&pixels)
        {
            let most = Self::MOST_SMOOTH;
            let message = format!("is {pixels:?}; give pixels from 0 to {most}, or \"auto\"");
            return wrong("profile_smooth", message);
        }
        if !(0.0..1.0).contains(&self.min_stroke) {
            let message = format!(
                "is {:?}; give a part of the height, 0 or more and below 1",
                self.min_stroke
            );
            return wrong("profile_min_stroke", message);
        }
        Ok(())
    }

    /// Refuses options that apply only to pictures. [`Smooth::Auto`] is accepted, since a drawing has
    /// no noise.
    pub(super) fn for_drawing(&self) -> Result<()> {
        let keys = ["profile_threshold", "profile_invert", "profile_smooth"];
        let keys = &keys[..3 - usize::from(self.smooth == Smooth::Auto)];
        self.refuse(
            keys,
            "counts for pictures alone; leave it out for a drawing",
        )
    }

    /// Refuses options that apply only to drawings.
    pub(super) fn for_picture(&self) -> Result<()> {
        let message = "counts for drawings alone; leave it out for a picture";
        self.refuse(&["profile_min_stroke"], message)?;
        match self.read {
            ProfileRead::Auto => self.refuse(&["profile_axis"], Self::NOT_AUTO),
            ProfileRead::Threshold => Ok(()),
        }
    }

    /// Refuses every option: a polygon has no file.
    pub(crate) fn for_polygon(&self) -> Result<()> {
        let message = "counts for files alone; leave it out for a polygon";
        self.refuse(&self.given().map(|(key, _)| key), message)
    }

    /// Every key, and whether its value differs from the default.
    fn given(&self) -> [(&'static str, bool); 6] {
        let plain = Self::default();
        [
            ("profile_axis", self.axis != plain.axis),
            ("profile_read", self.read != plain.read),
            ("profile_threshold", self.threshold != plain.threshold),
            ("profile_invert", self.invert),
            ("profile_smooth", self.smooth != plain.smooth),
            ("profile_min_stroke", self.min_stroke != plain.min_stroke),
        ]
    }

    /// Refuses the first of these keys that is given.
    fn refuse(&self, keys: &[&str], message: &str) -> Result<()> {
        let is_given = |(key, is): &(&str, bool)| *is && keys.contains(key);
        match self.given().iter().find(|given| is_given(given)) {
            Some((key, _)) => Err(content_fault(message).at_key(*key)),
            None => Ok(()),
        }
    }

    /// The darkness above which a pixel is solid; with `invert`, the lightness.
    pub(super) fn edge(&self) -> f32 {
        match self.invert {
            true => self.threshold as f32,
            false => 1.0 - self.threshold as f32,
        }
    }

    /// The darkness of a picture's half-plane as coverage, with the threshold at one half and noise
    /// blurred away. `split`: the axis is the middle of column 0.
    pub(super) fn apply(&self, mut raster: Raster, split: bool) -> Result<Raster> {
        let edge = self.edge();
        let (below, above) = (0.5 / edge, 0.5 / (1.0 - edge));
        raster.coverage.par_iter_mut().for_each(|c| {
            if edge != 0.5 {
                *c = if *c < edge {
                    *c * below
                } else {
                    1.0 - (1.0 - *c) * above
                };
            }
        });
        self.smooth.apply(&mut raster, split)?;
        Ok(raster)
    }
}

/// Loops smaller than this many pixels are specks.
const SPECK: f64 = 9.0;
/// This many specks are noise.
const NOISE: usize = 8;

/// Features of a picture and its outline that look unintended: one sentence each, with the key that
/// changes it. `split`: the axis is the middle of column 0. `reversed`: the solid looks light.
/// `of_form` looks at the solid as a whole, where the picture shows it clearly.
pub(super) fn warnings(
    raster: &Raster,
    split: bool,
    outline: &Outline,
    options: &ProfileOptions,
    reversed: bool,
    of_form: impl FnOnce(&Outline) -> Vec<String>,
) -> Vec<String> {
    let mut found = Vec::new();
    if reversed {
        found.push(
            "the picture looks like a light solid on dark ground; set profile_invert = true if light is solid"
                .to_owned(),
        );
    }
    let pixel = f64::from(raster.rows).powi(-2);
    let specks = outline
        .loops
        .iter()
        .filter(|l| loop_area(l).abs() < SPECK * pixel);
    let specks = specks.count();
    let noisy = specks >= NOISE;
    if !noisy && !reversed {
        found.extend(of_form(outline));
    }
    if noisy {
        found.push(format!(
            "the picture is noisy: {specks} specks of less than {SPECK} pixels; profile_smooth = 2 blurs them away"
        ));
    } else if options.smooth != Smooth::Auto {
        let rough = roughness(raster, split);
        if rough >= ROUGH {
            found.push(format!(
                "the outline is rough ({rough:.3} texels rms, by noise or compression); set profile_smooth = \"auto\""
            ));
        }
    }
    found
}

/// Shades that are told apart.
const SHADES: usize = 256;
/// The threshold must be this part of the contrast away from both shades.
const MARGIN: f64 = 0.05;

/// A warning if the threshold does not part the picture's two main shades. `dark` has what counts as
/// darkness, `width` values to a row.
pub(super) fn contrast(dark: &[f32], width: usize, options: &ProfileOptions) -> Option<String> {
    let [low, high] = main_shades(dark)?;
    let (edge, margin) = (f64::from(options.edge()), MARGIN * (high - low));
    if (low + margin..=high - margin).contains(&edge) {
        return None;
    }
    let middle = 0.5 * (low + high);
    let threshold = if options.invert { middle } else { 1.0 - middle };
    let border = dark
        .iter()
        .take(width)
        .chain(dark.iter().skip(width - 1).step_by(width));
    let on_dark = border
        .map(|d| if f64::from(*d) > middle { 1 } else { -1 })
        .sum::<i64>()
        > 0;
    let invert = match on_dark && !options.invert {
        true => " and profile_invert = true",
        false => "",
    };
    Some(format!(
        "the picture has low contrast: solid and ground are both {} than the threshold; set profile_threshold = {threshold:.2}{invert}",
        if (edge < middle) == options.invert {
            "lighter"
        } else {
            "darker"
        }
    ))
}

/// The two shades into which the values fall, by the largest variance between them (N. Otsu, *A
/// threshold selection method from gray-level histograms*, 1979).
fn main_shades(values: &[f32]) -> Option<[f64; 2]> {
    let mut counts = [0.0f64; SHADES];
    for value in values {
        counts[(value.clamp(0.0, 1.0) * (SHADES - 1) as f32).round() as usize] += 1.0;
    }
    let shade = |k: usize| k as f64 / (SHADES - 1) as f64;
    let sum: f64 = counts.iter().enumerate().map(|(k, n)| n * shade(k)).sum();
    let (mut count, mut below, mut best) = (0.0, 0.0, (0.0, None));
    for (k, n) in counts.iter().enumerate() {
        (count, below) = (count + n, below + n * shade(k));
        let rest = values.len() as f64 - count;
        let shades = [below / count.max(1.0), (sum - below) / rest.max(1.0)];
        let between = count * rest * (shades[1] - shades[0]).powi(2);
        if between > best.0 {
            best = (between, Some(shades));
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{png_bytes, profile_from_bytes};
    use image::{GrayImage, Luma};
    use revmap::profile::Profile;

    const SIDE: u32 = 96;

    /// The result of reading a ball of one grey on another, with options that differ from the
    /// default.
    fn read(solid: u8, ground: u8, change: impl Fn(&mut ProfileOptions)) -> Result<Profile> {
        let picture = GrayImage::from_fn(SIDE, SIDE, |x, y| {
            let from = |v: u32| f64::from(v) + 0.5 - 0.5 * f64::from(SIDE);
            Luma([if from(x).hypot(from(y)) < 30.0 {
                solid
            } else {
                ground
            }])
        });
        let mut options = ProfileOptions::default();
        change(&mut options);
        profile_from_bytes(&png_bytes(picture), options)
    }

    /// Asserts that the outline is the ball's, to within `tolerance` pixels, without a warning.
    #[track_caller]
    fn assert_ball(profile: &Profile, tolerance: f64) {
        assert!(profile.warnings.is_empty(), "{:?}", profile.warnings);
        assert_eq!(profile.outline.loops.len(), 1);
        for s in profile.outline.surface_segments() {
            let radius = (s.a - glam::DVec2::new(0.0, 0.5)).length() * f64::from(SIDE);
            assert!((radius - 30.0).abs() < tolerance, "{radius}");
        }
    }

    #[test]
    fn the_threshold_parts_greys() {
        assert_ball(&read(0, 255, |_| {}).unwrap(), 0.6);
        assert_ball(&read(255, 0, |o| o.invert = true).unwrap(), 0.6);
        // Grey 150 on ground of grey 220 is all light by default.
        assert!(read(150, 220, |_| {}).is_err());
        assert_ball(&read(150, 220, |o| o.threshold = 0.7).unwrap(), 0.6);
        // With `invert`, light is everything above the threshold.
        let inverted = read(220, 150, |o| (o.threshold, o.invert) = (0.7, true));
        assert_ball(&inverted.unwrap(), 0.6);
    }

    #[test]
    fn a_blur_is_even_about_the_axis() {
        let profile = read(0, 255, |o| o.smooth = Smooth::Pixels(3.0)).unwrap();
        assert_ball(&profile, 0.8);
        // Mirrored at the axis, the ball's poles stay level: the second derivative moves the edge
        // alike all round.
        let poles = profile.outline.bounds().unwrap();
        assert!((poles.z_max - 0.5 - (0.5 - poles.z_min)).abs() < 1e-6);
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for value in [-3.0, 101.0, f64::NAN] {
            type Change<'a> = &'a dyn Fn(&mut ProfileOptions);
            let cases: [(_, Change); 3] = [
                ("profile_threshold", &|o| o.threshold = value),
                ("profile_axis", &|o| o.axis = ProfileAxis::At(value)),
                ("profile_smooth", &|o| o.smooth = Smooth::Pixels(value)),
            ];
            for (key, change) in cases {
                let error = read(0, 255, change).unwrap_err();
                assert_eq!(error.key.as_deref(), Some(key));
            }
        }
        let error = read(0, 255, |o| (o.read, o.invert) = (ProfileRead::Auto, true)).unwrap_err();
        assert_eq!(error.key.as_deref(), Some("profile_invert"));
        for edge in [0.0, 1.0] {
            assert!(read(0, 255, |o| o.threshold = edge).is_err());
        }
        assert!(read(0, 255, |o| o.axis = ProfileAxis::At(1.0)).is_err());
    }
}
