//! Pictures beside the numbers: what was drawn, what each pixel cost, where it is wrong; and where
//! one ray per pixel is worst, enlarged, by every treatment of edges side by side.

use crate::measure::RenderedCase;
use crate::plan::is_rbm_baseline;
use crate::plan::method::{Edges, Method, MethodSettings};
use crate::report::folder::{make, png, write_bytes};
use crate::report::series_style::SeriesStyles;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::settings::DrawStage;
use revmap_compare::mosaic::{enlarged, painted, pixel, tiled, worst_part};
use revmap_compare::{EMPTY, Heat, PIXELS_PER_DEGREE, Scale, flip_map, heat_map};
use revmap_figures::names::{self, FileNames};
use revmap_files::Picture;
use std::path::{Path, PathBuf};

/// The heat map of steps.
pub const STEPS: Scale = Scale {
    low: 1.0,
    high: 128.0,
};
/// Pictures in a page are at most this wide.
const WIDEST: u32 = 420;
/// Heat maps of more views than this would bury the page.
const HEATED_VIEWS: usize = 3;
/// Beyond so many views, heat maps are of the first alone, and pictures are smaller.
const MANY_VIEWS: usize = 12;
/// Pictures of many views are at most this wide.
const NARROW: u32 = 200;

/// Collects pictures while a plan is measured, and writes each in full into a folder.
pub struct Album {
    folder: PathBuf,
    files: FileNames,
    styles: SeriesStyles,
    heat_maps: bool,
    stage: Option<DrawStage>,
    shown: Vec<usize>,
    /// Pictures made smaller for a page: the view's index, the picture and its caption.
    pub shots: Vec<(usize, (Picture, String))>,
}

impl Album {
    /// An album in `folder/pictures`, with heat maps or without.
    pub fn new(folder: &Path, styles: SeriesStyles, heat_maps: bool) -> Result<Self> {
        let folder = folder.join("pictures");
        make(&folder)?;
        Ok(Self {
            folder,
            files: FileNames::default(),
            styles,
            heat_maps,
            stage: None,
            shown: Vec::new(),
            shots: Vec::new(),
        })
    }

    /// Takes what is worth showing: each view once as it should look, then look-ups and errors of
    /// each way of drawing it at that size, from one stage.
    pub fn add(&mut self, seen: &RenderedCase) -> Result<()> {
        let settings = &seen.case.settings;
        let view = seen.case.view;
        let name = &seen.plan.views[view].name;
        let first = seen.plan.cases.iter().find(|c| c.view == view);
        if first.is_none_or(|c| c.picture() != seen.case.picture()) {
            return Ok(());
        }
        let many = seen.plan.views.len() > MANY_VIEWS;
        let stage = *self.stage.get_or_insert(settings.stage);
        if !self.shown.contains(&view) {
            self.shown.push(view);
            let widest = if many { NARROW } else { WIDEST };
            let caption = format!("{name}: the reference");
            self.keep((view, widest), name, &Picture::of(seen.truth)?, caption)?;
        }
        let place = self.shown.iter().position(|v| *v == view).unwrap_or(0);
        let heated = if many { 1 } else { HEATED_VIEWS };
        if settings.stage != stage || place >= heated || !(self.heat_maps && worth(settings)) {
            return Ok(());
        }
        let way = self.styles.way(settings);
        let mut keep = |kind: &str, picture: &Picture, of: &str| {
            let (file, caption) = (format!("{name}-{way}-{kind}"), format!("{way}: {of}"));
            self.keep((view, WIDEST), &file, picture, caption)
        };
        // A mesh makes no look-ups.
        if !settings.method.is_mesh() {
            keep("steps", &steps(seen.frame), "look-ups in each pixel")?;
        }
        let depth = heat_map(seen.truth, seen.frame, seen.options, Heat::Depth)?;
        keep("depth", &depth, "error of depth")
    }

    fn keep(
        &mut self,
        (view, widest): (usize, u32),
        name: &str,
        picture: &Picture,
        caption: String,
    ) -> Result<()> {
        let file = self.folder.join(self.files.add(name) + ".png");
        write_bytes(&file, &png(picture)?)?;
        let small = reduced(picture, picture.width.div_ceil(widest).max(1));
        self.shots.push((view, (small, caption)));
        Ok(())
    }
}

/// True if a way of drawing is worth a heat map: in a sweep only the usual ones.
fn worth(s: &MethodSettings) -> bool {
    let plain = s.map_rows.is_none()
        && s.map_source.is_none()
        && s.map_format == MethodSettings::default().map_format;
    let usual = plain && matches!(s.max_steps, None | Some(64));
    is_rbm_baseline(s) || (usual && s.method != Method::Floor)
}

/// The meaning of the colours of heat maps.
pub fn heat_key() -> String {
    format!(
        "Look-ups: dark blue is 1, pale yellow {} or more, each doubling an equal step of brightness; grey is where nothing was looked up. \
         Error of depth: dark blue is a thousandth of a texel of a 512-row map or less, pale yellow 10 texels or more, four decades between; cyan pixels \
         are missed, green ones ghosts, grey is where there is nothing to hit.",
        names::number(STEPS.high, 3)
    )
}

/// Look-ups as a heat map.
pub fn steps(frame: &Frame) -> Picture {
    let color = |&steps: &f32| {
        let [r, g, b] = match steps < 1.0 {
            true => EMPTY,
            false => STEPS.color(f64::from(steps)),
        };
        [r, g, b, 255]
    };
    Picture {
        width: frame.width,
        height: frame.height,
        rgba: frame.steps.iter().map(color).collect(),
    }
}

/// A picture with each square of `factor` pixels made one, by their mean.
pub fn reduced(picture: &Picture, factor: u32) -> Picture {
    let side = |length: u32| (length / factor).max(1) as usize;
    let size = [side(picture.width), side(picture.height)];
    let part = |k: usize| k * factor as usize..(k + 1) * factor as usize;
    painted(size, |x, y| {
        let places = part(y).flat_map(|j| part(x).map(move |i| (i, j)));
        let pixels = places.filter_map(|(i, j)| pixel(picture, i, j));
        let (mut sum, mut count) = ([0u32; 4], 0);
        for pixel in pixels {
            (0..4).for_each(|c| sum[c] += u32::from(pixel[c]));
            count += 1;
        }
        sum.map(|s| (s / count.max(1)) as u8)
    })
}

/// Pixels of an enlarged part either way, and how often each is repeated.
const PART: [usize; 2] = [40; 2];
const ENLARGED: usize = 7;

/// Collects the pictures of one view and stage, and writes their sheet when the next begins.
#[derive(Default)]
pub struct Sheets {
    folder: PathBuf,
    files: FileNames,
    of: Option<(usize, DrawStage)>,
    name: String,
    /// The part in which FLIP is largest with one ray per pixel.
    worst: [usize; 2],
    pictures: Vec<Picture>,
    truth: Option<Picture>,
}

impl Sheets {
    /// Sheets in a folder.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            ..Self::default()
        }
    }

    /// Takes a picture.
    pub fn add(&mut self, seen: &RenderedCase) -> Result<()> {
        let settings = &seen.case.settings;
        let of = Some((seen.case.view, settings.stage));
        if self.of != of {
            self.finish()?;
            let view = &seen.plan.views[seen.case.view].name;
            let name = format!("antialiasing-{view}-{}", settings.stage.name());
            self.name = self.files.add(&name) + ".png";
            self.of = of;
            self.truth = Some(Picture::of(seen.truth)?);
        }
        if settings.method == Method::DEFAULT && settings.edges == Edges::OneRay {
            let flip = flip_map(seen.truth, seen.frame, PIXELS_PER_DEGREE);
            let flip: Vec<f64> = flip.into_iter().map(f64::from).collect();
            let size = [seen.frame.width, seen.frame.height].map(|side| side as usize);
            self.worst = worst_part(&flip, size, PART, PART).1;
        }
        self.pictures.push(Picture::of(seen.frame)?);
        Ok(())
    }

    /// Writes the last sheet.
    pub fn finish(&mut self) -> Result<()> {
        let mut pictures = std::mem::take(&mut self.pictures);
        if pictures.is_empty() {
            return Ok(());
        }
        pictures.extend(self.truth.take());
        let part = |picture| enlarged(picture, self.worst, PART, ENLARGED, [0; 4]);
        let parts: Vec<Picture> = pictures.iter().map(part).collect();
        tiled(&parts, parts.len(), 0).write_png(self.folder.join(&self.name))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn more_look_ups_are_brighter_and_none_is_grey() {
        let mut frame = Frame::new(4, 1, [0.0; 4]).unwrap();
        frame.steps = vec![0.0, 1.0, 16.0, 500.0];
        let picture = steps(&frame);
        let bright = |k: usize| {
            let color = picture.rgba[k][..3].iter();
            color.map(|&v| u32::from(v)).sum::<u32>()
        };
        assert_eq!(picture.rgba[0], [40, 40, 40, 255]);
        assert!(bright(1) < bright(2) && bright(2) < bright(3));
        assert_eq!(picture.rgba[3][..3], STEPS.color(STEPS.high));
    }

    #[test]
    fn reduction_takes_the_mean() {
        let pixel = |v: u8| [v, 0, 255, 255];
        let values = [10, 20, 100, 100, 7, 30, 40, 100, 100, 7];
        let picture = Picture {
            width: 5,
            height: 2,
            rgba: values.map(pixel).to_vec(),
        };
        let small = reduced(&picture, 2);
        assert_eq!((small.width, small.height), (2, 1));
        assert_eq!(small.rgba, [pixel(25), pixel(100)]);
        assert_eq!(reduced(&picture, 1), picture);
        assert!(png(&picture).unwrap().starts_with(b"\x89PNG"));
    }
}
