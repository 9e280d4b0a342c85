//! Cut-outs: pictures whose transparency is the ground. Their colours tell nothing of the outline.

use crate::Photo;

/// Alpha of what counts as clear. Less comes from compression.
const CLEAR: u8 = 12;
/// A cut-out has at least this part of its pixels clear: fewer are rounded corners of a picture.
const LEAST_CLEAR: f64 = 0.04;
/// Margin on each side, as a part of the greater side.
const MARGIN: f64 = 0.12;

/// A picture of alpha alone: the thing is black on white.
pub(crate) struct Cutout {
    pub width: u32,
    pub height: u32,
    pub rgba: Vec<[u8; 4]>,
    /// Clear pixels that were added on each side. A thing may fill the picture up to its edges.
    pub margin: u32,
}

impl Cutout {
    /// `None` for a picture that is not transparent around a thing.
    pub fn of(photo: &Photo) -> Option<Self> {
        let mut seen: Vec<u8> = photo.rgba.iter().map(|p| p[3]).collect();
        seen.retain(|a| *a > CLEAR);
        let clear = photo.rgba.len() - seen.len();
        if (clear as f64) < LEAST_CLEAR * photo.rgba.len() as f64 || seen.is_empty() {
            return None;
        }
        // Glass is nowhere opaque: what a quarter of the thing reaches counts as opaque.
        let quarter = 3 * seen.len() / 4;
        let opaque = u32::from(*seen.select_nth_unstable(quarter).1);
        let margin = (MARGIN * f64::from(photo.width.max(photo.height))).ceil() as u32;
        let (width, height) = (photo.width + 2 * margin, photo.height + 2 * margin);
        let mut rgba = vec![[255, 255, 255, 0]; width as usize * height as usize];
        for (y, row) in photo.rgba.chunks_exact(photo.width as usize).enumerate() {
            let start = (y + margin as usize) * width as usize + margin as usize;
            for (to, from) in rgba[start..].iter_mut().zip(row) {
                let alpha = (255 * u32::from(from[3]) / opaque).min(255) as u8;
                let grey = 255 - alpha;
                *to = [grey, grey, grey, alpha];
            }
        }
        Some(Self {
            width,
            height,
            rgba,
            margin,
        })
    }

    pub fn photo(&self) -> Photo<'_> {
        Photo {
            width: self.width,
            height: self.height,
            rgba: &self.rgba,
        }
    }
}
