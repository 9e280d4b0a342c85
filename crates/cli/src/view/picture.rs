//! The picture that the window shows: the lit scene, a plane of its frame, or errors against the
//! reference. All are off-screen frames.

use super::framing::Framing;
use super::legend::{Legend, grey, level};
use super::shown::{Inspected, Shown};
use super::times::Cost;
use eframe::egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::gpu::{Device, DrawPath};
use revmap::settings::Settings;
use revmap_bench::report::pictures::steps;
use revmap_compare::mosaic::{self, pixel};
use revmap_compare::{CompareOptions, Heat, compare, heat_map};
use revmap_files::Picture;
use revmap_offscreen::{Offscreen, Times};
use revmap_searches::folder;
use revmap_searches::watchdog::watched;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;

/// Side of a pixel of the error picture, in pixels of the window, since the reference takes seconds
/// for a whole window.
const COARSE: u32 = 2;

/// A reference frame that is drawn in the background.
struct Check {
    version: u64,
    drawn: Receiver<Result<Frame>>,
}

/// The picture and the objects that draw it.
pub struct Painter {
    device: Device,
    /// Pipelines that the device had compiled before the last frame.
    compiled: u64,
    offscreen: Option<(Settings, Offscreen)>,
    texture: Option<TextureHandle>,
    /// The version of the shown state in the picture; `None` while it is outdated.
    made: Option<u64>,
    check: Option<Check>,
    picture: Option<Picture>,
    /// The scale of the picture.
    pub legend: Option<Legend>,
    /// The picture's content in numbers.
    pub words: String,
    /// The draw path of each object in the frame.
    pub draw_paths: Vec<DrawPath>,
}

impl Painter {
    /// Opens the device, and compiles what the shown state needs in a window of this size.
    pub fn open(choice: Option<&str>, shown: &Shown, size: (u32, u32)) -> Result<Self> {
        let mut painter = Self {
            device: Device::open(choice)?,
            compiled: 0,
            offscreen: None,
            texture: None,
            made: None,
            check: None,
            picture: None,
            legend: None,
            words: String::new(),
            draw_paths: Vec::new(),
        };
        painter.draw(&shown.furnished(), shown.settings(size))?;
        painter.compiled = painter.device.pipelines_compiled();
        Ok(painter)
    }

    /// The device of the pictures.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The texture with the picture; `None` while the picture is outdated.
    pub fn texture(&self) -> Option<TextureId> {
        self.made.and(self.texture.as_ref()).map(TextureHandle::id)
    }

    /// The picture in the free part of the window; `None` while it is outdated.
    pub fn picture(&self) -> Option<&Picture> {
        self.made.and(self.picture.as_ref())
    }

    /// Draws version `version` of the shown state and its framing, unless the picture has it.
    /// Returns the frame's cost. Waits for no reference: the context repaints when it is drawn.
    pub fn update(
        &mut self,
        shown: &Shown,
        version: u64,
        framing: &Framing,
        context: &Context,
    ) -> Result<Option<Cost>> {
        if self.made == Some(version) {
            return Ok(None);
        }
        self.made = None;
        let start = Instant::now();
        let side = match shown.inspected {
            Inspected::Error => COARSE,
            _ => 1,
        };
        let (width, height) = framing.free();
        let settings = shown.settings((width.div_ceil(side), height.div_ceil(side)));
        let mut framed = shown.furnished();
        framed.scene.camera = framing.camera(&shown.scene.camera);
        framed.scene.background[3] = 1.0;
        let reference = match shown.inspected {
            Inspected::Error => match self.reference(&framed, version, &settings, context)? {
                Some(frame) => Some(frame),
                None => {
                    self.words = "the reference is being drawn".into();
                    return Ok(None);
                }
            },
            _ => None,
        };
        self.words.clear();
        let (offscreen, times) = self.draw(&framed, settings)?;
        let (picture, legend) = if shown.inspected == Inspected::Color {
            (colors(offscreen, &settings)?, None)
        } else {
            let frame = offscreen.read()?;
            let (picture, legend) = match (shown.inspected, reference) {
                (_, Some(reference)) => (self.errors(&reference, &frame)?, Legend::errors()),
                (Inspected::Depth, _) => (depth(&frame), Legend::depth(span(&frame))),
                (Inspected::Normals, _) => (normals(&frame), Legend::normals()),
                _ => (steps(&frame), Legend::steps()),
            };
            (picture, Some(legend))
        };
        let picture = match side as usize {
            1 => picture,
            side => {
                let near = |x, y| pixel(&picture, x / side, y / side).unwrap_or_default();
                mosaic::painted([width as usize, height as usize], near)
            }
        };
        let image = ColorImage::from_rgba_premultiplied(
            [picture.width as usize, picture.height as usize],
            picture.rgba.as_flattened(),
        );
        let texture = self.texture.get_or_insert_with(|| {
            context.load_texture("picture", ColorImage::default(), TextureOptions::NEAREST)
        });
        texture.set(image, TextureOptions::NEAREST);
        (self.picture, self.legend) = (Some(picture), legend);
        self.made = Some(version);
        let all = start.elapsed().as_secs_f64() * 1e3;
        let compiled = self.device.pipelines_compiled();
        let before = std::mem::replace(&mut self.compiled, compiled);
        Ok(Some(Cost {
            prepare: times.prepare_ms,
            device: times.gpu_ms.unwrap_or(times.frame_ms),
            present: all - times.prepare_ms - times.frame_ms,
            compiled: compiled - before,
        }))
    }

    /// Draws a frame of a furnished state with these settings, to be read.
    pub fn draw(&mut self, shown: &Shown, settings: Settings) -> Result<(&mut Offscreen, Times)> {
        let fits = |(made, _): &(Settings, Offscreen)| *made == settings;
        let mut offscreen = match self.offscreen.take().filter(fits) {
            Some((_, mut offscreen)) => {
                offscreen.update(&shown.scene)?;
                offscreen
            }
            None => {
                let mut made = Offscreen::new(&self.device, &shown.scene, &settings)?;
                made.prewarm()?;
                made
            }
        };
        let times = watched(folder::name_of(settings.solver), || offscreen.draw())?;
        self.draw_paths = offscreen.renderer().draw_paths();
        let (_, offscreen) = self.offscreen.insert((settings, offscreen));
        Ok((offscreen, times))
    }

    /// The reference's frame of this version, if it is finished; otherwise starts to draw it.
    fn reference(
        &mut self,
        shown: &Shown,
        version: u64,
        settings: &Settings,
        context: &Context,
    ) -> Result<Option<Frame>> {
        if let Some(check) = &self.check {
            let drawn = match check.drawn.try_recv() {
                Err(TryRecvError::Empty) => return Ok(None),
                Err(TryRecvError::Disconnected) => Err(Error::new(
                    ErrorKind::Other,
                    "the reference's thread has died; change the view to try again",
                )),
                Ok(drawn) => drawn,
            };
            let current = check.version == version;
            self.check = None;
            if current {
                return drawn.map(Some);
            }
        }
        let (done, drawn) = channel();
        let (scene, settings, context) = (shown.scene.clone(), *settings, context.clone());
        std::thread::spawn(move || {
            // A failed send is ignored: the window was closed meanwhile.
            let _ = done.send(revmap_reference::draw(&scene, &settings, &|_, _| {}));
            context.request_repaint();
        });
        self.check = Some(Check { version, drawn });
        Ok(None)
    }

    fn errors(&mut self, reference: &Frame, frame: &Frame) -> Result<Picture> {
        let options = CompareOptions::default();
        let found = compare(reference, frame, &options)?;
        let depth = found.depth.map(|d| format!("{:.4}", d.p99));
        let depth = depth.unwrap_or("none".into());
        let (missed, ghost, all) = (found.missed, found.ghost, frame.pixels());
        self.words = format!(
            "{missed} missed, {ghost} ghost pixels of {all}; depth p99 {depth} h/512; every {COARSE}nd pixel"
        );
        heat_map(reference, frame, &options, Heat::Depth)
    }
}

/// The colours of a frame with these settings.
pub fn colors(offscreen: &mut Offscreen, settings: &Settings) -> Result<Picture> {
    Ok(Picture {
        width: settings.width,
        height: settings.height,
        rgba: offscreen.rgba()?,
    })
}

/// Distances of the nearest and the farthest hit; reversed without a hit.
fn span(frame: &Frame) -> [f32; 2] {
    let hits = || frame.distance.iter().copied().filter(|d| d.is_finite());
    [
        hits().fold(f32::INFINITY, f32::min),
        hits().fold(0.0, f32::max),
    ]
}

/// A grey level for each pixel's distance, between the nearest and the farthest hit.
fn depth(frame: &Frame) -> Picture {
    let [near, far] = span(frame);
    let length = (far - near).max(f32::MIN_POSITIVE);
    painted(frame, |k| grey((frame.distance[k] - near) / length))
}

fn normals(frame: &Frame) -> Picture {
    painted(frame, |k| frame.normal[k].map(level))
}

/// Pixels with a hit in their colour, the others black.
fn painted(frame: &Frame, color: impl Fn(usize) -> [u8; 3]) -> Picture {
    let pixel = |k: usize| {
        let [r, g, b] = if frame.hits(k) { color(k) } else { [0; 3] };
        [r, g, b, 255]
    };
    Picture {
        width: frame.width,
        height: frame.height,
        rgba: (0..frame.pixels()).map(pixel).collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn near_is_bright_and_normals_are_colours() {
        let mut frame = Frame::new(3, 1, [0.0; 4]).unwrap();
        frame.distance = vec![1.0, 3.0, f32::INFINITY];
        frame.normal = vec![[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0; 3]];
        let greys = [[255; 4], [40, 40, 40, 255], [0, 0, 0, 255]];
        assert_eq!(depth(&frame).rgba, greys);
        let colors = [[255, 127, 127, 255], [127, 127, 0, 255], [0, 0, 0, 255]];
        assert_eq!(normals(&frame).rgba, colors);
    }

    /// Each tick of a scale has the colour of a pixel with its value.
    #[test]
    fn scales_have_the_colours_of_the_pictures() {
        let mut frame = Frame::new(5, 1, [0.0; 4]).unwrap();
        frame.steps = vec![1.0, 4.0, 16.0, 64.0, 128.0];
        let mut truth = frame.clone();
        (truth.distance, frame.distance) = (vec![2.0; 5], vec![2.0; 5]);
        for (drawn, texels) in frame.distance.iter_mut().zip([0.0, 0.01, 0.1, 1.0, 10.0]) {
            *drawn += texels / 512.0;
        }
        let options = CompareOptions::default();
        let errors = heat_map(&truth, &frame, &options, Heat::Depth).unwrap();
        let mut deep = frame.clone();
        deep.distance = vec![2.0, 2.5, 3.0, 3.5, 4.0];
        for (picture, legend) in [
            (steps(&frame), Legend::steps()),
            (errors, Legend::errors()),
            (depth(&deep), Legend::depth(span(&deep))),
        ] {
            let bar = legend.bar.unwrap();
            assert_eq!(bar.ticks.len(), 5);
            for ((place, value), pixel) in bar.ticks.iter().zip(picture.rgba) {
                let color = (bar.color)(*place);
                // Distances are rounded to floats.
                let near = color.iter().zip(pixel).all(|(a, b)| a.abs_diff(b) <= 1);
                assert!(near, "{} {value}: {color:?}, {pixel:?}", legend.title);
            }
        }
        let depth = Legend::depth(span(&deep)).bar.unwrap();
        let values: Vec<_> = depth.ticks.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(values, ["2.000", "2.500", "3.000", "3.500", "4.000"]);
        let empty = Frame::new(5, 1, [0.0; 4]).unwrap();
        assert!(Legend::depth(span(&empty)).bar.is_none());
    }
}
