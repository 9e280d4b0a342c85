//! Pictures beside the numbers: what was drawn, what each pixel cost, where it is wrong.

use super::folder::{make, png, write_bytes};
use super::measure::RenderedCase;
use super::names::{self, safe};
use super::plan::{Labels, is_rbm_baseline};
use crate::compare::{EMPTY, Heat, Scale, heat_map};
use crate::method::{Method, MethodSettings};
use revmap::error::Result;
use revmap::frame::{Frame, Picture};
use revmap::settings::DrawStage;
use std::path::{Path, PathBuf};

/// A picture made smaller for a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shot {
    /// Index of the view.
    pub view: usize,
    /// Its title.
    pub caption: String,
    /// A PNG file's bytes.
    pub small: Vec<u8>,
    /// Its width and height.
    pub size: (u32, u32),
}

/// The heat map of steps.
pub const STEPS: Scale = Scale {
    low: 1.0,
    high: 128.0,
};
/// Pictures in a page are at most this wide.
const WIDEST: u32 = 420;
/// Heat maps of more views than this would bury the page.
const HEATED_VIEWS: usize = 3;
/// Beyond so many views, heat maps are of the first alone, and each view has a smaller
/// picture.
const MANY_VIEWS: usize = 12;
/// Pictures of many views are at most this wide.
const NARROW: u32 = 200;

/// Collects pictures while a plan is measured, and writes each in full into a folder.
pub struct Album {
    folder: PathBuf,
    labels: Labels,
    heat_maps: bool,
    stage: Option<DrawStage>,
    shown: Vec<usize>,
    /// The pictures.
    pub shots: Vec<Shot>,
}

impl Album {
    /// An album in `folder/pictures`, with heat maps or without.
    pub fn new(folder: &Path, labels: Labels, heat_maps: bool) -> Result<Self> {
        let folder = folder.join("pictures");
        make(&folder)?;
        Ok(Self {
            folder,
            labels,
            heat_maps,
            stage: None,
            shown: Vec::new(),
            shots: Vec::new(),
        })
    }

    /// Takes what is worth showing of a picture: each view once as it should look, then each way of
    /// drawing it at that size, from one stage (the stages' pictures are alike): look-ups and
    /// errors.
    pub fn add(&mut self, seen: &RenderedCase) -> Result<()> {
        let settings = &seen.case.settings;
        let view = seen.case.view;
        let name = &seen.plan.views[view].name;
        let first = seen
            .plan
            .cases
            .iter()
            .find(|c| c.view == view)
            .map(|c| (c.settings.width, c.settings.height));
        if first != Some((settings.width, settings.height)) {
            return Ok(());
        }
        let stage = *self.stage.get_or_insert(settings.stage);
        if !self.shown.contains(&view) {
            self.shown.push(view);
            let widest = if seen.plan.views.len() > MANY_VIEWS {
                NARROW
            } else {
                WIDEST
            };
            let caption = format!("{name}: the reference");
            self.keep((view, widest), name, &Picture::of(seen.truth), caption)?;
        }
        let place = self.shown.iter().position(|v| *v == view).unwrap_or(0);
        let heated = if seen.plan.views.len() > MANY_VIEWS {
            1
        } else {
            HEATED_VIEWS
        };
        if settings.stage != stage || place >= heated || !(self.heat_maps && worth(settings)) {
            return Ok(());
        }
        let way = self.labels.way(settings);
        let file = format!("{name}-{way}");
        // A mesh makes no look-ups.
        if !settings.method.is_mesh() {
            self.keep(
                (view, WIDEST),
                &format!("{file}-steps"),
                &steps(seen.frame),
                format!("{way}: look-ups in each pixel"),
            )?;
        }
        let depth = heat_map(seen.truth, seen.frame, seen.options, Heat::Depth)?;
        self.keep(
            (view, WIDEST),
            &format!("{file}-depth"),
            &depth,
            format!("{way}: error of depth"),
        )
    }

    fn keep(
        &mut self,
        (view, widest): (usize, u32),
        name: &str,
        picture: &Picture,
        caption: String,
    ) -> Result<()> {
        write_bytes(
            &self.folder.join(format!("{}.png", safe(name))),
            &png(picture)?,
        )?;
        let small = reduced(picture, picture.width.div_ceil(widest).max(1));
        self.shots.push(Shot {
            view,
            caption,
            size: (small.width, small.height),
            small: png(&small)?,
        });
        Ok(())
    }
}

/// True if a way of drawing is worth a heat map: in a sweep only searches as they are drawn by
/// default, and at one middling bound on steps.
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
        let [r, g, b] = if steps < 1.0 {
            EMPTY
        } else {
            STEPS.color(f64::from(steps))
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
    let (width, height) = (
        (picture.width / factor).max(1),
        (picture.height / factor).max(1),
    );
    let mut rgba = Vec::with_capacity((width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0u32; 4];
            let mut count = 0;
            for j in y * factor..((y + 1) * factor).min(picture.height) {
                for i in x * factor..((x + 1) * factor).min(picture.width) {
                    let pixel = picture.rgba[(j * picture.width + i) as usize];
                    (0..4).for_each(|c| sum[c] += u32::from(pixel[c]));
                    count += 1;
                }
            }
            rgba.push(sum.map(|s| (s / count.max(1)) as u8));
        }
    }
    Picture {
        width,
        height,
        rgba,
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
            picture.rgba[k][..3]
                .iter()
                .map(|&v| u32::from(v))
                .sum::<u32>()
        };
        assert_eq!(picture.rgba[0], [40, 40, 40, 255]);
        assert!(bright(1) < bright(2) && bright(2) < bright(3));
        assert_eq!(picture.rgba[3][..3], STEPS.color(STEPS.high));
    }

    #[test]
    fn reduction_takes_the_mean() {
        let pixel = |v: u8| [v, 0, 255, 255];
        let picture = Picture {
            width: 5,
            height: 2,
            rgba: [10, 20, 100, 100, 7, 30, 40, 100, 100, 7]
                .map(pixel)
                .to_vec(),
        };
        let small = reduced(&picture, 2);
        assert_eq!((small.width, small.height), (2, 1));
        assert_eq!(small.rgba, [pixel(25), pixel(100)]);
        assert_eq!(reduced(&picture, 1), picture);
        assert!(png(&picture).unwrap().starts_with(b"\x89PNG"));
    }
}
