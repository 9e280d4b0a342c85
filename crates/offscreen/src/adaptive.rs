//! Adaptive supersampling: more rays in the pixels whose colours they change.
//!
//! 1. A pixel is opened if its colour differs from that of a pixel beside it.
//! 2. Open pixels get the first 4 points of a Sobol sequence, then 16, then 64. A pixel is closed when
//!    the range of its colours is small for their number. After 4 points the range is that of the
//!    pixels beside it, too: all four may miss an edge.
//! 3. Pixels beside one whose points differ are opened, too: what is thinner than a pixel may show in
//!    one alone.
//!
//! The compute stage traces the extra rays, and leaves out closed pixels.

use crate::commands::Times;
use crate::offscreen::Offscreen;
use crate::read_back::Linear;
use crate::samples::{add, point, weighted};
use revmap::error::Result;
use revmap::frame::{Frame, srgb_from_linear};
use revmap::gpu::Device;
use revmap::host_memory;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, Settings};

/// Points of a pixel after each round.
const ROUNDS: [u32; 3] = [4, 16, 64];
/// Levels of 255 by which colours of neighbours differ where a pixel is opened.
const EDGE: f32 = 4.0;
/// Levels of 255 that the range of a closed pixel's colours over their number may have, after each
/// round. The error of the mean of even points is of that order.
const ERROR: [f32; 2] = [1.0, 2.0];
/// Most rounds in which pixels beside others are opened.
const GROWTH: u32 = 8;

/// Draws more rays where pixels need them.
pub struct Adaptive {
    offscreen: Offscreen,
    linear: Linear,
}

/// What adaptive rays did.
#[derive(Clone, Debug, Default)]
pub struct Refined {
    /// Extra rays of each pixel: 0, 4, 16 or 64.
    pub rays: Vec<u8>,
    /// Times of all extra rays.
    pub times: Times,
}

impl Refined {
    /// Mean number of extra rays of a pixel.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.rays.iter().map(|rays| f64::from(*rays)).sum::<f64>() / self.rays.len().max(1) as f64
    }

    /// A picture of the rays: black pixels have one, white ones 65.
    #[must_use]
    pub fn picture(&self, of: &Frame) -> Frame {
        let mut picture = of.clone();
        for (color, rays) in picture.color.iter_mut().zip(&self.rays) {
            let grey = f32::from(*rays).sqrt() / 8.0;
            *color = [grey, grey, grey, 1.0];
        }
        picture
    }
}

/// The rays of a pixel so far.
#[derive(Clone, Copy)]
struct Pixel {
    /// Sum of linear colours, weighted by alpha.
    sum: [f32; 4],
    least: [u8; 4],
    most: [u8; 4],
}

const NO_RAYS: Pixel = Pixel {
    sum: [0.0; 4],
    least: [255; 4],
    most: [0; 4],
};

impl Pixel {
    fn add(&mut self, rgba: [u8; 4], linear: &Linear) {
        add(&mut self.sum, linear.color(&rgba));
        *self = self.joined([rgba; 2]);
    }

    /// This with the range of others: their least and largest channels.
    fn joined(mut self, [least, most]: [[u8; 4]; 2]) -> Self {
        for c in 0..4 {
            self.least[c] = self.least[c].min(least[c]);
            self.most[c] = self.most[c].max(most[c]);
        }
        self
    }

    /// The largest range of a channel, levels.
    fn range(&self) -> f32 {
        let ranges = self.most.iter().zip(self.least);
        ranges
            .map(|(most, least)| f32::from(most.saturating_sub(least)))
            .fold(0.0, f32::max)
    }
}

impl Adaptive {
    /// Makes all ready for the extra rays of a scene: memory of the frame's size, and pipelines of the compute stage.
    ///
    /// # Errors
    /// As [`Offscreen::new`].
    pub fn new(device: &Device, scene: &Scene, settings: &Settings) -> Result<Self> {
        let settings = Settings {
            stage: DrawStage::Compute,
            planes: Planes::Color,
            antialias: false,
            ..*settings
        };
        let mut offscreen = Offscreen::new(device, scene, &settings)?;
        offscreen.warm = true;
        Ok(Self {
            offscreen,
            linear: Linear::new(),
        })
    }

    /// Replaces colours of a frame of one ray per pixel by the means of more, where these differ. Other channels stay
    /// those of the middle ray.
    ///
    /// # Errors
    /// As [`Offscreen::update`] and [`Offscreen::draw`].
    pub fn refine(&mut self, scene: &Scene, frame: &mut Frame) -> Result<Refined> {
        let width = frame.width as usize;
        let mut pixels = host_memory::filled(frame.pixels(), NO_RAYS, "the sums of samples")?;
        let mut refined = Refined {
            rays: vec![0; frame.pixels()],
            times: Times::default(),
        };
        let mut shifted = scene.clone();
        shifted.camera.ray_width = f64::from(ROUNDS[2]).sqrt().recip();
        let mut open = edges(frame);
        let mut first = 0;
        for (round, end) in ROUNDS.into_iter().enumerate() {
            let error = ERROR.get(round).copied().unwrap_or(f32::INFINITY);
            let mut all = Vec::new();
            // Pixels that the first round opens have its rays before the next round.
            for _ in 0..GROWTH {
                let to = (&mut pixels[..], &mut refined);
                self.add((scene, &mut shifted), first..end, &open, to)?;
                let differing = open.iter().filter(|at| pixels[**at].range() > EDGE);
                let beside = differing.flat_map(|at| beside(*at, width, pixels.len()));
                let mut new: Vec<usize> = beside.filter(|at| refined.rays[*at] == 0).collect();
                new.sort_unstable();
                new.dedup();
                all.append(&mut open);
                if round > 0 || new.is_empty() {
                    break;
                }
                open = new;
            }
            let around = |at: usize| {
                let all = beside(at, width, pixels.len())
                    .filter(|other| round == 0 && refined.rays[*other] > 0);
                all.map(|other| &pixels[other])
                    .fold(pixels[at], |sum, p| sum.joined([p.least, p.most]))
                    .range()
            };
            all.retain(|at| around(*at) > error * end as f32);
            open = all;
            first = end;
        }
        for ((color, pixel), rays) in frame.color.iter_mut().zip(&pixels).zip(&refined.rays) {
            if *rays > 0 {
                *color = weighted(pixel.sum, u32::from(*rays));
            }
        }
        Ok(refined)
    }

    /// Adds rays through some points of open pixels.
    fn add(
        &mut self,
        (scene, shifted): (&Scene, &mut Scene),
        points: std::ops::Range<u32>,
        open: &[usize],
        (pixels, refined): (&mut [Pixel], &mut Refined),
    ) -> Result<()> {
        if open.is_empty() {
            return Ok(());
        }
        let mut mask = vec![false; pixels.len()];
        for at in open {
            mask[*at] = true;
        }
        self.offscreen.open(Some(&mask))?;
        let end = points.end;
        for i in points {
            let [x, y] = point(i, ROUNDS[2]);
            shifted.camera.shift = [scene.camera.shift[0] + x, scene.camera.shift[1] + y];
            self.offscreen.update(shifted)?;
            refined.times.add(self.offscreen.draw()?);
            let colors = self.offscreen.rgba()?;
            for &at in open {
                pixels[at].add(colors[at], &self.linear);
            }
        }
        for &at in open {
            refined.rays[at] = end as u8;
        }
        Ok(())
    }
}

/// Pixels whose colour differs from that of one beside them, in order.
fn edges(frame: &Frame) -> Vec<usize> {
    let level = |value: f32| 255.0 * srgb_from_linear(f64::from(value.clamp(0.0, 1.0))) as f32;
    let levels = |[r, g, b, a]: [f32; 4]| [level(r), level(g), level(b), 255.0 * a];
    let colors: Vec<[f32; 4]> = frame.color.iter().map(|color| levels(*color)).collect();
    let (width, count) = (frame.width as usize, colors.len());
    let differs = |a: usize, b: usize| (0..4).any(|c| (colors[a][c] - colors[b][c]).abs() > EDGE);
    (0..count)
        .filter(|at| beside(*at, width, count).any(|other| differs(*at, other)))
        .collect()
}

/// The pixels around one of a picture of `count`.
fn beside(at: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (at % width, at / width);
    let rows = y.saturating_sub(1)..(y + 2).min(count / width);
    rows.flat_map(move |row| {
        (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| row * width + x)
    })
    .filter(move |other| *other != at)
}
