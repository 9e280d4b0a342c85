//! How far a drawn frame is from the reference, in numbers and as pictures.

mod flip;
mod heat;
pub mod map_accuracy;
pub mod mosaic;
mod outline;
mod pixels;
mod silhouette;

pub use flip::{flip_map, mean_flip};
pub use heat::{EMPTY, GHOST, Heat, MISSED, Scale, heat_map, heat_sheet, ramp};
pub use outline::{ViewErrors, around};
pub use pixels::{PixelErrors, pixel_errors};
pub use silhouette::silhouette_hausdorff;

use outline::TruePicture;
use rayon::prelude::*;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::scene::Scene;

/// Pixels per degree of FLIP's authors: 3840 pixels on 0.7 m, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * std::f64::consts::PI / 180.0;

/// What the comparison must know beyond the two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareOptions {
    /// World length of one texel of the shape map, the unit of depth errors: `1 / rows` times the
    /// smallest factor of the object's scale. Default: 1/512.
    pub texel: f64,
    /// True if FLIP at [`PIXELS_PER_DEGREE`] is wanted, which takes longer than all the rest.
    /// Default: true.
    pub flip: bool,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self {
            texel: 1.0 / 512.0,
            flip: true,
        }
    }
}

impl CompareOptions {
    /// With this world length of a texel.
    pub fn of(texel: f64) -> Self {
        Self {
            texel,
            ..Self::default()
        }
    }
}

/// Root mean square, 99th percentile (nearest rank) and maximum of a set of errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Root of the mean square.
    pub rms: f64,
    /// The smallest error that 99 % of all do not exceed.
    pub p99: f64,
    /// The largest.
    pub max: f64,
}

/// The outcome of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Pixels of the picture.
    pub pixels: usize,
    /// Pixels in which the reference hits.
    pub hits: usize,
    /// Pixels in which the reference hits and the frame does not.
    pub missed: usize,
    /// Pixels in which the frame hits and the reference does not.
    pub ghost: usize,
    /// Error of the distance along the ray, in texels; `None` when no pixel hits in both.
    pub depth: Option<Spread>,
    /// World length of a texel, from [`CompareOptions`].
    pub texel: f64,
    /// Angle between the normals `N`, degrees; `None` when no pixel hits in both.
    pub normal: Option<Spread>,
    /// Hausdorff distance of the silhouettes in pixels; `+inf` when only one frame hits anything.
    pub silhouette_hausdorff: f64,
    /// Mean of FLIP over the picture, 0 (equal) to 1; `None` where it was not wanted.
    pub flip: Option<f64>,
    /// Errors in pixels of the view; `None` where the scene was not given.
    pub view: Option<ViewErrors>,
}

impl Comparison {
    /// Missed and ghost pixels as a part of the reference's hits (of 1 where it has none).
    pub fn wrong(&self) -> f64 {
        (self.missed + self.ghost) as f64 / self.hits.max(1) as f64
    }

    /// Error of the distance along the ray in h/512, h being the height of an unscaled solid.
    pub fn depth_h512(&self) -> Option<Spread> {
        let unit = 512.0 * self.texel;
        self.depth.map(|d| Spread {
            rms: d.rms * unit,
            p99: d.p99 * unit,
            max: d.max * unit,
        })
    }
}

impl std::fmt::Display for Comparison {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let spread = |s: Option<Spread>, unit: &str| match s {
            Some(s) => format!(
                "rms {:.6}  p99 {:.6}  max {:.6} {unit}",
                s.rms, s.p99, s.max
            ),
            None => "no pixel hits in both".into(),
        };
        writeln!(f, "hits        {} of {} pixels", self.hits, self.pixels)?;
        writeln!(f, "missed      {}", self.missed)?;
        writeln!(f, "ghost       {}", self.ghost)?;
        let texels = format!("texels of {:.6} world units", self.texel);
        writeln!(f, "depth       {}", spread(self.depth, &texels))?;
        let heights = "h/512 (height h = 1 world unit)";
        writeln!(f, "            {}", spread(self.depth_h512(), heights))?;
        writeln!(f, "normal      {}", spread(self.normal, "degrees"))?;
        let apart = self.silhouette_hausdorff;
        writeln!(f, "silhouette  {apart:.3} pixels (Hausdorff)")?;
        if let Some(view) = self.view {
            let [p999, max] = [view.silhouette_p999, view.silhouette_max];
            let depth = view.depth_p99;
            writeln!(
                f,
                "            p99.9 {p999:.4}  max {max:.4} pixels from the true outline"
            )?;
            writeln!(f, "depth       p99 {depth:.4} pixels of the view")?;
        }
        match self.flip {
            Some(flip) => write!(f, "flip        {flip:.6}"),
            None => write!(f, "flip        not computed"),
        }
    }
}

/// Compares a drawn frame with the reference.
///
/// Depth and normals are compared where both frames hit. A distance that is not finite is no hit; a
/// normal that is none (zero, NaN) is 180 degrees off. FLIP and the silhouettes are described at
/// [`flip_map`] and [`silhouette_hausdorff`].
///
/// ```
/// use revmap::frame::Frame;
/// use revmap_compare::{CompareOptions, compare};
/// let mut reference = Frame::new(8, 8, [0.0; 4])?;
/// let mut drawn = reference.clone();
/// reference.distance[20] = 2.0;
/// (drawn.distance[20], drawn.distance[21]) = (2.5, 2.5);
/// let options = CompareOptions { texel: 0.25, ..CompareOptions::default() };
/// let found = compare(&reference, &drawn, &options)?;
/// assert_eq!((found.missed, found.ghost), (0, 1));
/// assert_eq!(found.depth.map(|d| d.max), Some(2.0));
/// assert_eq!(found.silhouette_hausdorff, 1.0);
/// # Ok::<(), revmap::Error>(())
/// ```
///
/// # Errors
/// [`ErrorKind::Content`] when the frames differ in size; [`ErrorKind::Usage`] when the texel is
/// not a positive number.
pub fn compare(reference: &Frame, frame: &Frame, options: &CompareOptions) -> Result<Comparison> {
    check(reference, frame, options)?;
    Reference::new(reference, options)?.compare(frame)
}

/// A reference that several frames are compared with: what FLIP needs of it is found once.
pub struct Reference<'a> {
    frame: &'a Frame,
    options: CompareOptions,
    eye: Option<flip::Eye>,
    picture: Option<TruePicture>,
}

impl<'a> Reference<'a> {
    /// Makes ready to compare with `frame`.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] when the texel is not a positive number.
    pub fn new(frame: &'a Frame, options: &CompareOptions) -> Result<Self> {
        check(frame, frame, options)?;
        Ok(Self {
            frame,
            options: *options,
            eye: (options.flip).then(|| flip::Eye::on(frame, PIXELS_PER_DEGREE)),
            picture: None,
        })
    }

    /// The same, with errors in pixels of the view of `scene`, which the frame shows by one ray per
    /// pixel.
    pub fn of_scene(mut self, scene: &Scene) -> Result<Self> {
        let (width, height) = (self.frame.width, self.frame.height);
        self.picture = Some(TruePicture::new(scene, width, height)?);
        Ok(self)
    }

    /// Compares a drawn frame, as [`compare`] does.
    pub fn compare(&self, frame: &Frame) -> Result<Comparison> {
        let (reference, texel) = (self.frame, self.options.texel);
        check(reference, frame, &self.options)?;
        let pixels = 0..reference.pixels();
        let count = |of: [bool; 2]| {
            let is = |k: &usize| [reference.hits(*k), frame.hits(*k)] == of;
            pixels.clone().into_par_iter().filter(is).count()
        };
        let (missed, ghost) = (count([true, false]), count([false, true]));
        let depth = |k| depth_error(reference, frame, k, texel);
        Ok(Comparison {
            pixels: pixels.len(),
            hits: count([true, true]) + missed,
            missed,
            ghost,
            depth: spread(reference, frame, depth),
            texel,
            normal: spread(reference, frame, |k| normal_error(reference, frame, k)),
            silhouette_hausdorff: silhouette::silhouette_hausdorff(reference, frame),
            flip: (self.eye.as_ref()).map(|eye| mean_flip(&eye.flip(frame))),
            view: (self.picture.as_ref()).map(|picture| picture.errors(reference, frame)),
        })
    }
}

/// What every comparison needs: one size, and a texel that has one.
pub(crate) fn check(reference: &Frame, frame: &Frame, options: &CompareOptions) -> Result<()> {
    let wrong = |kind, message: String| Err(Error::new(kind, message));
    if (reference.width, reference.height) != (frame.width, frame.height) {
        let message = format!(
            "the frames differ in size ({}x{} and {}x{}); draw them at one size",
            reference.width, reference.height, frame.width, frame.height
        );
        return wrong(ErrorKind::Content, message);
    }
    let texel = options.texel;
    if !(texel.is_finite() && texel > 0.0) {
        let message = format!("texel is {texel}; give a positive number");
        return wrong(ErrorKind::Usage, message);
    }
    Ok(())
}

/// Error of the distance along the ray in texels, for a pixel that hits in both.
pub(crate) fn depth_error(reference: &Frame, frame: &Frame, k: usize, texel: f64) -> f64 {
    (f64::from(frame.distance[k]) - f64::from(reference.distance[k])).abs() / texel
}

/// Angle between the normals in degrees, for a pixel that hits in both.
pub(crate) fn normal_error(reference: &Frame, frame: &Frame, k: usize) -> f64 {
    let [a, b] = [reference, frame].map(|f| glam::DVec3::from(f.normal[k].map(f64::from)));
    // Unlike the arc cosine this keeps all digits near 0.
    let angle = a.cross(b).length().atan2(a.dot(b)).to_degrees();
    if a.length_squared() * b.length_squared() > 0.0 {
        angle
    } else {
        180.0
    }
}

fn spread(
    reference: &Frame,
    frame: &Frame,
    error: impl Fn(usize) -> f64 + Sync + Send,
) -> Option<Spread> {
    let mut errors: Vec<f64> = (0..reference.pixels())
        .into_par_iter()
        .filter(|&k| reference.hits(k) && frame.hits(k))
        .map(error)
        .collect();
    // In order, so that the sum has the same bits on any number of threads.
    errors.par_sort_unstable_by(f64::total_cmp);
    let max = *errors.last()?;
    let square: f64 = errors.iter().map(|e| e * e).sum();
    let rank = (errors.len() * 99).div_ceil(100);
    Some(Spread {
        rms: (square / errors.len() as f64).sqrt(),
        p99: errors[rank - 1],
        max,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A disc of radius 30 in a picture of 100 x 80, facing the viewer.
    fn disc() -> Frame {
        let mut frame = Frame::new(100, 80, [0.0; 4]).unwrap();
        for k in 0..frame.pixels() {
            let (x, y) = ((k % 100) as f32 - 49.5, (k / 100) as f32 - 39.5);
            if x * x + y * y < 900.0 {
                hit(&mut frame, k);
            }
        }
        frame
    }

    fn hit(frame: &mut Frame, k: usize) {
        frame.color[k] = [0.5, 0.4, 0.3, 1.0];
        frame.distance[k] = 2.0;
        frame.normal[k] = [0.0, 0.0, 1.0];
    }

    fn erase(frame: &mut Frame, k: usize) {
        let mut empty = [0.0; 17];
        empty[4] = f32::INFINITY;
        frame.set_pixel(k, empty);
    }

    fn against(change: impl FnOnce(&mut Frame, &[usize])) -> Comparison {
        let base = disc();
        let solid: Vec<usize> = (0..base.pixels()).filter(|&k| base.hits(k)).collect();
        let mut other = base.clone();
        change(&mut other, &solid);
        let options = CompareOptions::of(0.01);
        compare(&base, &other, &options).unwrap()
    }

    #[test]
    fn equal_frames_have_no_errors() {
        let c = against(|_, _| {});
        assert_eq!(
            (c.missed, c.ghost, c.silhouette_hausdorff, c.flip, c.wrong()),
            (0, 0, 0.0, Some(0.0), 0.0)
        );
        let none = Some(Spread {
            rms: 0.0,
            p99: 0.0,
            max: 0.0,
        });
        assert_eq!((c.depth, c.normal), (none, none));
        assert!((c.hits as f64 - 900.0 * std::f64::consts::PI).abs() < 30.0);
    }

    #[test]
    fn planted_missed_and_ghost_pixels_are_counted() {
        let c = against(|f, solid| {
            solid[100..117].iter().for_each(|&k| erase(f, k));
            (0..5).for_each(|k| hit(f, k));
            // Not a number is no hit either.
            f.distance[solid[500]] = f32::NAN;
        });
        assert_eq!((c.missed, c.ghost), (18, 5));
        assert!((c.wrong() - 23.0 / c.hits as f64).abs() < 1e-15);
    }

    #[test]
    fn planted_depth_errors_are_measured() {
        // 0.25 world units are 25 texels, on every pixel: all three figures.
        let c = against(|f, solid| solid.iter().for_each(|&k| f.distance[k] += 0.25));
        let d = c.depth.unwrap();
        let is_planted = |e: &f64| (e - 25.0).abs() < 1e-9;
        assert!([d.rms, d.p99, d.max].iter().all(is_planted), "{d:?}");
        // The same in h/512: 0.25 units are 128 of them.
        let h512 = c.depth_h512().unwrap();
        assert!((h512.p99 - 128.0).abs() < 1e-9, "{h512:?}");
        let text = c.to_string();
        let depth: Vec<&str> = text.lines().skip(3).take(2).collect();
        let ends = [
            ("p99 25.000000", "texels of 0.010000 world units"),
            ("p99 128.000000", "h/512 (height h = 1 world unit)"),
        ];
        for (line, (p99, unit)) in depth.iter().zip(ends) {
            assert!(line.contains(p99) && line.ends_with(unit), "{text}");
        }
        // On exactly 1 % of the pixels: the percentile does not see it, on one more it does.
        for (extra, p99) in [(0, 0.0), (1, 25.0)] {
            let c = against(|f, solid| {
                let n = solid.len() / 100 + extra;
                solid[..n].iter().for_each(|&k| f.distance[k] -= 0.25);
            });
            let d = c.depth.unwrap();
            assert!((d.p99 - p99).abs() < 1e-9 && is_planted(&d.max), "{d:?}");
            assert!((d.rms - 2.5).abs() < 0.1, "{d:?}");
        }
    }

    #[test]
    fn planted_turns_of_normals_are_measured() {
        for degrees in [1e-3f64, 0.5, 3.0, 90.0, 180.0] {
            let c = against(|f, solid| {
                let (s, c) = degrees.to_radians().sin_cos();
                let turned = [s as f32, 0.0, c as f32];
                solid.iter().for_each(|&k| f.normal[k] = turned);
            });
            let n = c.normal.unwrap();
            let is_planted = |e: &f64| (e / degrees - 1.0).abs() < 1e-4;
            assert!(
                [n.rms, n.p99, n.max].iter().all(is_planted),
                "{degrees}: {n:?}"
            );
        }
        let broken = against(|f, solid| {
            (f.normal[solid[0]], f.normal[solid[1]]) = ([0.0; 3], [f32::NAN; 3])
        });
        assert_eq!(broken.normal.unwrap().max, 180.0);
        assert!(broken.normal.unwrap().rms.is_finite());
    }

    #[test]
    fn frames_that_share_no_hit_have_no_spread() {
        let empty = Frame::new(100, 80, [0.0; 4]).unwrap();
        let c = compare(&disc(), &empty, &CompareOptions::default()).unwrap();
        assert_eq!((c.depth, c.normal, c.missed), (None, None, c.hits));
        assert_eq!(c.silhouette_hausdorff, f64::INFINITY);
        assert!(c.to_string().contains("no pixel hits in both"));
    }

    #[test]
    fn unequal_sizes_and_odd_options_are_refused() {
        let small = Frame::new(10, 80, [0.0; 4]).unwrap();
        let error = compare(&disc(), &small, &CompareOptions::default()).unwrap_err();
        assert!(error.to_string().contains("100x80 and 10x80"), "{error}");
        for texel in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let options = CompareOptions {
                texel,
                ..CompareOptions::default()
            };
            assert!(compare(&disc(), &disc(), &options).is_err());
        }
    }
}
