//! Turns lines on the screen into parts of pixels: the pixels that a line cuts, and the area of
//! each beyond it.

use super::lines::{FLATNESS, Point};
use super::meridian::TOLERANCE;
use glam::{DVec2, Vec2Swizzles};

/// A pixel whose colour is mixed from nearby pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Blend {
    /// Sort key: the pixel's number, then how small its part is that shows something else than its
    /// middle does. The first of a pixel's blends has the largest such part.
    key: u64,
    /// Pixel numbers and weights: beyond the line, at it, and one further in.
    pub sources: [(u32, f32); 3],
}

impl Blend {
    /// Number of the pixel.
    pub fn pixel(&self) -> u32 {
        (self.key >> 32) as u32
    }

    /// Keeps for each pixel the blend with the largest part, in the pixels' order.
    pub fn leave_one_a_pixel(blends: &mut Vec<Self>) {
        blends.sort_unstable_by_key(|blend| blend.key);
        blends.dedup_by_key(|blend| blend.pixel());
    }
}

/// Area of a pixel on its middle's side of a line, in `[0, 1]`. The line passes the middle at
/// `distance` pixels, measured along one axis. It climbs by `slope` along the other one, at most 1
/// either way.
#[must_use]
pub fn coverage(distance: f64, slope: f64) -> f64 {
    let (x, m) = (distance.abs(), slope.abs().min(1.0));
    // Up to this distance the line leaves the pixel through the two sides that it cuts at right
    // angles.
    let whole = 0.5 * (1.0 - m);
    let beyond = 0.5 * (1.0 + m) - x;
    if x <= whole {
        0.5 + x
    } else if beyond > 0.0 {
        1.0 - beyond * beyond / (2.0 * m)
    } else {
        1.0
    }
}

/// Pixels by which the depth must change one pixel beside a silhouette before colours from further
/// in are used: about twice the root of the radius. Rounder surfaces are visible in too few pixels.
const ROUND: f64 = 2.0;
/// Pixels by which a line may pass on the wrong side of a pixel's middle: the tolerance of patches
/// from the boundary plus that of chords from the curve.
const UNSURE: f64 = TOLERANCE + FLATNESS;
/// Copies larger than this many pixels to either side count as visible without a search.
const SMALL: f64 = 64.0;

/// The picture that lines are drawn into.
pub(super) struct Screen<'a, D> {
    pub width: u32,
    pub height: u32,
    /// Depth along the view of each pixel; infinite for the background.
    pub depth: &'a D,
    /// A pixel's size at depth 1.
    pub pixel_size: f64,
}

impl<D: Fn(usize) -> f64> Screen<'_, D> {
    /// Returns true if some pixel may show anything around a point of the screen within `size` of
    /// its depth. Large copies return true without a search.
    pub fn may_show(&self, at: DVec2, depth: f64, size: f64) -> bool {
        if depth <= 2.0 * size {
            return true;
        }
        // A sphere appears elongated away from the middle of the picture.
        let off = at - 0.5 * DVec2::new(f64::from(self.width), f64::from(self.height));
        let stretch = 1.0 + (off * self.pixel_size).length_squared();
        let half = 1.2 * stretch * size / ((depth - size) * self.pixel_size) + 1.5;
        let [low, high] = [at - half, at + half];
        let most = DVec2::new(f64::from(self.width), f64::from(self.height));
        if low.cmpge(most).any() || high.cmple(DVec2::ZERO).any() {
            return false;
        }
        if half > SMALL {
            return true;
        }
        let [low, high] = [low, high].map(|p| p.clamp(DVec2::ZERO, most).as_uvec2());
        (low.y..high.y).any(|y| {
            let mut row = low.x..high.x;
            row.any(|x| {
                let shown = (self.depth)((y * self.width + x) as usize);
                (shown - depth).abs() <= 1.5 * size
            })
        })
    }

    /// Appends the blends of the pixels on both sides of a line, if they show the line's solid.
    pub fn line(&self, a: &Point, b: &Point, blends: &mut Vec<Blend>) {
        let way = b.at - a.at;
        let steep = way.y.abs() > way.x.abs();
        // First coordinate along the longer side, second across.
        let turned = |p: DVec2| if steep { p.yx() } else { p };
        let (a, b) = if turned(way).x < 0.0 { (b, a) } else { (a, b) };
        let (from, to) = (turned(a.at), turned(b.at));
        let sides = [[self.width, self.height], [self.height, self.width]];
        let [length, width] = sides[usize::from(steep)];
        // Pixels whose middle is between the ends: two joined lines cover each pixel once.
        let first = (from.x - 0.5).ceil().max(0.0);
        let last = (to.x - 0.5).ceil().min(f64::from(length));
        if first >= last {
            return;
        }
        let slope = (to.y - from.y) / (to.x - from.x);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the picture
        for along in first as u32..last as u32 {
            let beside = f64::from(along) + 0.5 - from.x;
            let across = from.y + slope * beside - 0.5;
            if !(0.0..f64::from(width) - 1.0).contains(&across) {
                continue;
            }
            let number = |across: u32| {
                let [x, y] = [[along, across], [across, along]][usize::from(steep)];
                y * self.width + x
            };
            let (mut low, mut rest) = (across as u32, across.fract());
            let s = beside / (to.x - from.x);
            let depth = 1.0 / (a.depth.recip() * (1.0 - s) + b.depth.recip() * s);
            let (bend, pixel_size) = (a.reach + (b.reach - a.reach) * s, self.pixel_size * depth);
            let reach = bend + 2.0 * pixel_size;
            // The line and the ray may disagree on the side of a pixel middle close to the line.
            let shows = |across: u32| (self.depth)(number(across) as usize) - depth <= reach;
            let divides = |low: u32| low + 1 < width && shows(low) != shows(low + 1);
            if rest.min(1.0 - rest) < UNSURE && !divides(low) {
                if rest < 0.5 && low > 0 && divides(low - 1) {
                    (low, rest) = (low - 1, 1.0);
                } else if rest > 0.5 && divides(low + 1) {
                    (low, rest) = (low + 1, 0.0);
                }
            }
            let pair = [number(low), number(low + 1)];
            let depths = pair.map(|pixel| (self.depth)(pixel as usize));
            let apart = (depths[0].min(depths[1]) - depth).abs();
            if apart > reach || apart.is_nan() {
                continue;
            }
            // The pixel that shows the solid, the distance of its middle from the line, the pixel
            // beyond the line, and the one further in.
            let (own, inside, other, further) = if depths[0] < depths[1] {
                (pair[0], rest, pair[1], low.checked_sub(1))
            } else {
                (pair[1], 1.0 - rest, pair[0], Some(low + 2))
            };
            let further = further.filter(|across| *across < width).map(number);
            let further = further.filter(|pixel| {
                let apart = ((self.depth)(*pixel as usize) - depth).abs();
                a.curved && bend > ROUND * pixel_size && apart <= 2.0 * reach
            });
            for (pixel, beyond) in [(own, inside), (other, 1.0 - inside)] {
                let covered = coverage(beyond, slope);
                if covered >= 1.0 {
                    continue;
                }
                let covered = if pixel == own { covered } else { 1.0 - covered };
                let change = further.map_or(0.0, |_| curved(inside, covered));
                let weights = [1.0 - covered, covered * (1.0 - change), covered * change];
                let pixels = [other, own, further.unwrap_or(own)];
                let part = if pixel == own { 1.0 - covered } else { covered } as f32;
                blends.push(Blend {
                    // The bits of non-negative floats are in the floats' order.
                    key: u64::from(pixel) << 32 | u64::from(!part.to_bits()),
                    sources: std::array::from_fn(|k| (pixels[k], weights[k] as f32)),
                });
            }
        }
    }
}

/// Weight of a strip's colour between the colour at `inside` (0) and that one pixel further in (1).
/// The strip extends from the silhouette `strip` pixels into the solid.
///
/// Near a silhouette the normal turns as the square root of the distance, and colours follow.
fn curved(inside: f64, strip: f64) -> f64 {
    let middle = 2.0 / 3.0 * strip.sqrt();
    (middle - inside.sqrt()) / ((inside + 1.0).sqrt() - inside.sqrt())
}
