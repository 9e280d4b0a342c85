//! Pictures that the window shows in place of the drawn scene: planes of an off-screen frame, and
//! errors against the reference.

use super::framing::Framing;
use super::legend::{Legend, grey, level};
use super::shown::{Inspected, Shown};
use egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};
use revmap::error::{self, Error, Result};
use revmap::frame::Frame;
use revmap::gpu::{Device, DrawPath, Offscreen};
use revmap::settings::{Planes, Settings};
use revmap_files::Picture;
use revmap_lab::compare::{CompareOptions, Heat, compare, heat_map};
use revmap_lab::report::pictures::steps;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use winit::event_loop::EventLoopProxy;

/// Side of a pixel of the error picture, in pixels of the window, since the reference takes seconds
/// for a whole window.
const COARSE: u32 = 2;

/// A reference frame that is drawn in the background.
struct Check {
    version: u64,
    drawn: Receiver<Result<Frame>>,
}

/// The pictures and the objects that draw them.
#[derive(Default)]
pub struct Inspector {
    offscreen: Option<(Settings, Offscreen)>,
    texture: Option<TextureHandle>,
    /// The version of the scene in the texture, with the plane and the settings.
    made: Option<(u64, Inspected, Settings)>,
    check: Option<Check>,
    /// The scale of the picture in the texture.
    pub legend: Option<Legend>,
    /// The picture's content in numbers.
    pub words: String,
    /// Device time of the last off-screen frame, milliseconds.
    pub device_ms: Option<f64>,
    /// The draw path of each object in the frame.
    pub draw_paths: Vec<DrawPath>,
}

impl Inspector {
    /// Returns true if the window shows a picture made here instead of its own pass.
    pub fn is_wanted(shown: &Shown) -> bool {
        shown.inspected != Inspected::Color
    }

    /// The picture of version `version` of the shown state and its framing, for a window. Returns
    /// `None` until the reference has been drawn.
    pub fn picture(
        &mut self,
        shown: &Shown,
        version: u64,
        framing: &Framing,
        device: &Device,
        context: &Context,
        wake: &EventLoopProxy<()>,
    ) -> Result<Option<&TextureHandle>> {
        let side = if shown.inspected == Inspected::Error {
            COARSE
        } else {
            1
        };
        let planes = match shown.inspected {
            Inspected::Color => Planes::Color,
            _ => Planes::All,
        };
        let size = framing.window;
        let settings = shown.settings((size.0.div_ceil(side), size.1.div_ceil(side)), planes);
        let wanted = (version, shown.inspected, settings);
        if self.made == Some(wanted) {
            return Ok(self.texture.as_ref());
        }
        let mut shown = shown.clone();
        shown.scene.camera = framing.camera(&shown.scene.camera, side);
        let shown = &shown;
        let reference = match shown.inspected {
            Inspected::Error => match self.reference(shown, version, &settings, wake)? {
                Some(frame) => Some(frame),
                None => {
                    self.words = "the reference is being drawn".into();
                    return Ok(None);
                }
            },
            _ => None,
        };
        let frame = self.draw(shown, settings, device)?;
        let (picture, legend) = match (shown.inspected, reference) {
            (_, Some(reference)) => (self.errors(&reference, &frame)?, Some(Legend::errors())),
            (Inspected::Depth, _) => (depth(&frame), Some(Legend::depth(span(&frame)))),
            (Inspected::Normals, _) => (normals(&frame), Some(Legend::normals())),
            (Inspected::Steps, _) => (steps(&frame), Some(Legend::steps())),
            _ => (Picture::of(&frame), None),
        };
        self.legend = legend;
        if shown.inspected != Inspected::Error {
            self.words.clear();
        }
        let image = ColorImage::new(
            [picture.width as usize, picture.height as usize],
            picture
                .rgba
                .iter()
                .map(|&[r, g, b, a]| Color32::from_rgba_unmultiplied(r, g, b, a))
                .collect(),
        );
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::NEAREST),
            none => *none = Some(context.load_texture("picture", image, TextureOptions::NEAREST)),
        }
        self.made = Some(wanted);
        Ok(self.texture.as_ref())
    }

    /// Drops frames that were drawn with other shaders.
    pub fn forget(&mut self) {
        (self.offscreen, self.made) = (None, None);
    }

    /// Draws a frame on the device, with the picture's settings.
    pub fn draw(&mut self, shown: &Shown, settings: Settings, device: &Device) -> Result<Frame> {
        let offscreen = match &mut self.offscreen {
            Some((made, offscreen)) if *made == settings => {
                offscreen.update(&shown.scene)?;
                offscreen
            }
            other => {
                *other = None;
                let made = Offscreen::new(device, &shown.scene, &settings)?;
                &mut other.insert((settings, made)).1
            }
        };
        self.device_ms = offscreen.draw()?.gpu_ms;
        self.draw_paths = offscreen.draw_paths();
        offscreen.read()
    }

    /// The reference's frame of this version, if it is finished; otherwise starts to draw it.
    fn reference(
        &mut self,
        shown: &Shown,
        version: u64,
        settings: &Settings,
        wake: &EventLoopProxy<()>,
    ) -> Result<Option<Frame>> {
        if let Some(check) = &self.check {
            let drawn = match check.drawn.try_recv() {
                Err(TryRecvError::Empty) => return Ok(None),
                Err(TryRecvError::Disconnected) => Err(Error::new(
                    error::ErrorKind::Other,
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
        let (scene, settings, wake) = (shown.scene.clone(), *settings, wake.clone());
        std::thread::spawn(move || {
            // A failed send is ignored: the window was closed meanwhile.
            let _ = done.send(revmap_reference::draw(&scene, &settings, &|_, _| {}));
            let _ = wake.send_event(());
        });
        self.check = Some(Check { version, drawn });
        Ok(None)
    }

    fn errors(&mut self, reference: &Frame, frame: &Frame) -> Result<Picture> {
        let options = CompareOptions::default();
        let found = compare(reference, frame, &options)?;
        let depth = found
            .depth
            .map_or("none".into(), |d| format!("{:.4}", d.p99));
        self.words = format!(
            "{} missed, {} ghost pixels of {}; depth p99 {depth} h/512; every {COARSE}nd pixel",
            found.missed,
            found.ghost,
            frame.pixels()
        );
        heat_map(reference, frame, &options, Heat::Depth)
    }
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
        assert_eq!(
            depth(&frame).rgba,
            [[255; 4], [40, 40, 40, 255], [0, 0, 0, 255]]
        );
        let colored = normals(&frame).rgba;
        assert_eq!(
            colored,
            [[255, 127, 127, 255], [127, 127, 0, 255], [0, 0, 0, 255]]
        );
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
        let values: Vec<_> = depth
            .ticks
            .iter()
            .map(|(_, value)| value.as_str())
            .collect();
        assert_eq!(values, ["2.000", "2.500", "3.000", "3.500", "4.000"]);
        let empty = Frame::new(5, 1, [0.0; 4]).unwrap();
        assert!(Legend::depth(span(&empty)).bar.is_none());
    }
}
