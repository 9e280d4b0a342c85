//! Where a drawn frame is wrong, as pictures.

use super::{
    CompareOptions, PIXELS_PER_DEGREE, check, depth_error, flip, normal_error, silhouette,
};
use crate::mosaic::tiled;
use revmap::Result;
use revmap::frame::{Frame, pixel_count};
use revmap_files::Picture;

/// What a heat map shows. Missed pixels are cyan, ghosts green, what is empty in both frames grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heat {
    /// Missed and ghost pixels alone; what both hit is a lighter grey.
    Wrong,
    /// Depth error, from dark blue at 0.001 texel to pale yellow at 10 texels, a decade a step.
    Depth,
    /// Angle between the normals, from dark blue at 0.01 degrees to pale yellow at 100 degrees.
    Normal,
    /// The pixels of both silhouettes, by their distance to the other's: from 0 to 8 pixels.
    Silhouette,
    /// FLIP, from 0 to 1, on every pixel.
    Flip,
}

impl Heat {
    /// All kinds, in the order of [`heat_sheet`].
    pub const ALL: [Self; 5] = [
        Self::Wrong,
        Self::Depth,
        Self::Normal,
        Self::Silhouette,
        Self::Flip,
    ];
}

/// A logarithmic scale of colours: dark blue at `low` and below, pale yellow at `high` and above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The value of the darkest colour, above 0.
    pub low: f64,
    /// The value of the brightest.
    pub high: f64,
}

impl Scale {
    /// Depth errors, texels.
    pub const DEPTH: Self = Self {
        low: 1e-3,
        high: 10.0,
    };
    /// Angles between normals, degrees.
    pub const NORMAL: Self = Self {
        low: 1e-2,
        high: 100.0,
    };

    /// The place of a value on the scale: 0 at `low`, 1 at `high`.
    pub fn place(self, value: f64) -> f64 {
        (value.max(self.low) / self.low).log2() / (self.high / self.low).log2()
    }

    /// The colour of a value.
    pub fn color(self, value: f64) -> [u8; 3] {
        ramp(self.place(value))
    }
}

/// The colour of a pixel without a value.
pub const EMPTY: [u8; 3] = [40; 3];
const BOTH: [u8; 3] = [110; 3];
/// The colour of a missed pixel.
pub const MISSED: [u8; 3] = [0, 255, 255];
/// The colour of a ghost.
pub const GHOST: [u8; 3] = [0, 255, 0];

/// A picture of one kind of error.
pub fn heat_map(
    reference: &Frame,
    frame: &Frame,
    options: &CompareOptions,
    kind: Heat,
) -> Result<Picture> {
    check(reference, frame, options)?;
    let depth = |k| depth_error(reference, frame, k, options.texel);
    let paint: Box<dyn Fn(usize) -> [u8; 3]> = match kind {
        Heat::Wrong => Box::new(|_| BOTH),
        Heat::Depth => Box::new(|k| Scale::DEPTH.color(depth(k))),
        Heat::Normal => Box::new(|k| Scale::NORMAL.color(normal_error(reference, frame, k))),
        Heat::Silhouette => Box::new(rims(reference, frame)),
        Heat::Flip => {
            let map = flip::flip_map(reference, frame, PIXELS_PER_DEGREE);
            Box::new(move |k| ramp(f64::from(map[k])))
        }
    };
    // These two show what they have on pixels that only one frame hits as well.
    let everywhere = matches!(kind, Heat::Flip | Heat::Silhouette);
    let rgba = (0..reference.pixels())
        .map(|k| {
            let [r, g, b] = match (reference.hits(k), frame.hits(k)) {
                _ if everywhere => paint(k),
                (true, true) => paint(k),
                (true, false) => MISSED,
                (false, true) => GHOST,
                (false, false) => EMPTY,
            };
            [r, g, b, 255]
        })
        .collect();
    Ok(Picture {
        width: reference.width,
        height: reference.height,
        rgba,
    })
}

/// All kinds on one sheet: wrong, depth, normal above; silhouette, FLIP and the drawn frame itself
/// below.
///
/// # Errors
/// Those of [`compare`](super::compare()), and [`ErrorKind::TooLarge`](revmap::error::ErrorKind)
/// when the sheet, six times the frame, is too large for a picture.
pub fn heat_sheet(reference: &Frame, frame: &Frame, options: &CompareOptions) -> Result<Picture> {
    check(reference, frame, options)?;
    pixel_count(
        frame.width.saturating_mul(3),
        frame.height.saturating_mul(2),
    )?;
    let maps = Heat::ALL.map(|kind| heat_map(reference, frame, options, kind));
    let mut tiles: Vec<Picture> = maps.into_iter().collect::<Result<_>>()?;
    tiles.push(Picture::of(frame)?);
    Ok(tiled(&tiles, 3, 0))
}

/// Colours of the silhouettes' pixels, by the way to the other silhouette.
fn rims(reference: &Frame, frame: &Frame) -> impl Fn(usize) -> [u8; 3] {
    let [a, b] = [reference, frame].map(silhouette::silhouette);
    let width = reference.width as usize;
    let hit = |k| reference.hits(k) || frame.hits(k);
    let ground = |k| if hit(k) { BOTH } else { EMPTY };
    let mut colors: Vec<[u8; 3]> = (0..a.len()).map(ground).collect();
    let both = (0..a.len()).filter(|&k| a[k] && b[k]).map(|k| (k, 0.0));
    let apart = [
        silhouette::ways(&a, &b, width),
        silhouette::ways(&b, &a, width),
    ];
    for (k, way) in apart.concat().into_iter().chain(both) {
        colors[k] = ramp(way / 8.0);
    }
    move |k| colors[k]
}

/// Dark blue, purple, red, orange, pale yellow: brightness grows evenly.
pub fn ramp(place: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 5] = [
        [12.0, 10.0, 70.0],
        [96.0, 20.0, 140.0],
        [205.0, 55.0, 90.0],
        [250.0, 150.0, 40.0],
        [255.0, 250.0, 175.0],
    ];
    // What is no number is as wrong as can be.
    let place = if place.is_nan() {
        1.0
    } else {
        place.clamp(0.0, 1.0)
    } * 4.0;
    let low = (place as usize).min(3);
    let share = place - low as f64;
    std::array::from_fn(|c| {
        (STOPS[low][c] + share * (STOPS[low + 1][c] - STOPS[low][c])).round() as u8
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Left half: hit at distance 2, facing the viewer; right half: nothing.
    fn base() -> Frame {
        let mut frame = Frame::new(40, 20, [0.0; 4]).unwrap();
        for k in (0..frame.pixels()).filter(|k| k % 40 < 20) {
            frame.color[k] = [0.5, 0.5, 0.5, 1.0];
            frame.distance[k] = 2.0;
            frame.normal[k] = [0.0, 0.0, 1.0];
        }
        frame
    }

    fn brightness(c: [u8; 3]) -> u32 {
        c.iter().map(|&v| u32::from(v)).sum()
    }

    fn at(kind: Heat, change: impl Fn(&mut Frame), x: usize, y: usize) -> [u8; 3] {
        let mut frame = base();
        change(&mut frame);
        let options = CompareOptions::of(0.01);
        let map = heat_map(&base(), &frame, &options, kind).unwrap();
        let [r, g, b, a] = map.rgba[y * 40 + x];
        assert_eq!((map.width, map.height, a), (40, 20, 255));
        [r, g, b]
    }

    #[test]
    fn planted_errors_have_their_colours() {
        let miss = |f: &mut Frame| f.distance[5 * 40 + 3] = f32::INFINITY;
        let ghost = |f: &mut Frame| f.distance[5 * 40 + 33] = 1.0;
        for kind in [Heat::Wrong, Heat::Depth, Heat::Normal] {
            assert_eq!(at(kind, miss, 3, 5), MISSED);
            assert_eq!(at(kind, ghost, 33, 5), GHOST);
            assert_eq!(at(kind, ghost, 32, 5), EMPTY);
        }
        // 10 texels reach the top of the scale, 0.1 texel its middle.
        assert_eq!(at(Heat::Depth, |f| f.distance[43] = 2.1, 3, 1), ramp(1.0));
        assert_eq!(at(Heat::Depth, |f| f.distance[43] = 2.001, 3, 1), ramp(0.5));
        assert_eq!(at(Heat::Depth, |_| {}, 3, 1), ramp(0.0));
        let (s, c) = 1f32.to_radians().sin_cos();
        let tilt = |f: &mut Frame| f.normal[43] = [s, 0.0, c];
        let none = |f: &mut Frame| f.normal[43] = [f32::NAN; 3];
        assert_eq!(at(Heat::Normal, tilt, 3, 1), ramp(0.5));
        assert_eq!(at(Heat::Normal, none, 3, 1), ramp(1.0));
        // A ghost four pixels from the edge is its own silhouette.
        let spot = |f: &mut Frame| f.distance[10 * 40 + 23] = 1.0;
        assert_eq!(at(Heat::Silhouette, spot, 23, 10), ramp(0.5));
        assert_eq!(at(Heat::Silhouette, spot, 19, 10), ramp(0.0));
        let blot = |f: &mut Frame| f.color[43] = [0.0, 1.0, 0.0, 1.0];
        let [near, far] = [(3, 1), (15, 15)].map(|(x, y)| brightness(at(Heat::Flip, blot, x, y)));
        assert!(near > far + 100);
    }

    #[test]
    fn the_ramp_grows_brighter() {
        let at = |k: u32| brightness(ramp(f64::from(k) / 100.0));
        assert!((0..100).all(|k| at(k) < at(k + 1)));
        assert_eq!((ramp(-1.0), ramp(7.0)), (ramp(0.0), ramp(1.0)));
    }

    #[test]
    fn a_sheet_holds_all_kinds_and_the_frame() {
        let mut frame = base();
        frame.distance[0] = 2.5;
        let options = CompareOptions::default();
        let sheet = heat_sheet(&base(), &frame, &options).unwrap();
        assert_eq!((sheet.width, sheet.height), (120, 40));
        for (tile, kind) in Heat::ALL.into_iter().enumerate() {
            let map = heat_map(&base(), &frame, &options, kind).unwrap();
            let first = tile / 3 * 20 * 120 + tile % 3 * 40;
            assert_eq!(sheet.rgba[first..first + 40], map.rgba[..40], "{kind:?}");
        }
        assert_eq!(sheet.rgba[20 * 120 + 80], [188, 188, 188, 255]);
        assert!(heat_sheet(&base(), &Frame::new(1, 1, [0.0; 4]).unwrap(), &options).is_err());
    }
}
