//! Parts of pictures side by side, enlarged: where one ray per pixel is worst, by every treatment of
//! edges.

use super::measure::RenderedCase;
use crate::compare::{PIXELS_PER_DEGREE, flip_map};
use crate::method::{Edges, Method};
use revmap::error::Result;
use revmap::frame::{Frame, write_png};
use revmap::settings::DrawStage;
use std::path::{Path, PathBuf};

/// Pixels of a part either way, and how often each is repeated.
const PART: usize = 40;
const ENLARGED: usize = 7;

/// Collects the pictures of one view and stage, and writes their sheet when the next begins.
pub struct Sheets {
    folder: PathBuf,
    of: Option<(usize, DrawStage)>,
    name: String,
    /// Each picture of one ray per pixel, in a part of which FLIP is largest.
    worst: Vec<f32>,
    width: usize,
    colors: Vec<Vec<[f32; 4]>>,
    truth: Vec<[f32; 4]>,
}

impl Sheets {
    /// Sheets in a folder.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            of: None,
            name: String::new(),
            worst: Vec::new(),
            width: 0,
            colors: Vec::new(),
            truth: Vec::new(),
        }
    }

    /// Takes a picture.
    pub fn add(&mut self, seen: &RenderedCase) -> Result<()> {
        let settings = &seen.case.settings;
        let of = Some((seen.case.view, settings.stage));
        if self.of != of {
            self.finish()?;
            let view = &seen.plan.views[seen.case.view].name;
            self.name = format!("antialiasing-{view}-{}.png", settings.stage.name());
            self.of = of;
            self.width = seen.frame.width as usize;
            self.truth.clone_from(&seen.truth.color);
        }
        if settings.method == Method::DEFAULT && settings.edges == Edges::OneRay {
            self.worst = flip_map(seen.truth, seen.frame, PIXELS_PER_DEGREE);
        }
        self.colors.push(seen.frame.color.clone());
        Ok(())
    }

    /// Writes the last sheet.
    pub fn finish(&mut self) -> Result<()> {
        let mut colors = std::mem::take(&mut self.colors);
        if colors.is_empty() {
            return Ok(());
        }
        colors.push(std::mem::take(&mut self.truth));
        let first = worst_part(&self.worst, self.width);
        let side = PART * ENLARGED;
        let mut frame = Frame::new((side * colors.len()) as u32, side as u32, [0.0; 4])?;
        for (k, color) in frame.color.iter_mut().enumerate() {
            let (x, y) = (k % (side * colors.len()), k / (side * colors.len()));
            let from = first + y / ENLARGED * self.width + x % side / ENLARGED;
            *color = colors[x / side].get(from).copied().unwrap_or_default();
        }
        write_png(&frame, self.folder.join(&self.name))
    }
}

/// The first pixel of the part of a map whose sum is largest.
fn worst_part(map: &[f32], width: usize) -> usize {
    let columns = (width / PART).max(1);
    let sum = |part: usize| {
        let first = part / columns * PART * width + part % columns * PART;
        let row = |y: usize| map.iter().skip(first + y * width).take(PART).sum::<f32>();
        (first, (0..PART).map(row).sum::<f32>())
    };
    let parts = columns * (map.len() / (width * PART).max(1));
    let worst = (0..parts).map(sum).max_by(|a, b| a.1.total_cmp(&b.1));
    worst.map_or(0, |w| w.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_part_is_found() {
        let mut map = vec![0.0; 120 * 80];
        map[50 * 120 + 95] = 1.0;
        assert_eq!(worst_part(&map, 120), 40 * 120 + 80);
        assert_eq!(worst_part(&[], 120), 0);
    }
}
