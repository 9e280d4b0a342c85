//! Comparison of a frame with that of a fresh renderer.

use crate::common::host::{Host, once};
use crate::kind::Kind;
use crate::log::{Finding, found};
use crate::model::Model;
use crate::recording::Recording;
use crate::views::Seen;
use revmap::gpu::{Device, DrawPath, Renderer};
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// A frame that was drawn, and all that it shows.
pub struct Drawn {
    pub kind: Rc<Kind>,
    pub model: Model,
    pub seen: Seen,
    /// True if compute compares depths.
    pub depths: bool,
    pub paths: Vec<DrawPath>,
    /// The bytes of each plane.
    pub planes: Vec<Vec<u8>>,
    pub name: String,
}

/// An error of the comparison, planted to test that it fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    None,
    /// The fresh renderer has the object's last colour.
    Color,
    /// It has no textures.
    Texture,
    /// It lacks an object.
    Object,
    /// Its second copy is at the place of the first.
    Copy,
}

/// What a comparison counted.
pub struct Same {
    /// Pixels that show a solid.
    pub hits: usize,
    /// True if some object took another draw path.
    pub other_path: bool,
}

impl Fault {
    /// Changes what the fresh renderer gets.
    fn spoil(self, model: &mut Model) {
        match self {
            Self::None => {}
            Self::Color => {
                for thing in &mut model.things {
                    thing.object.color = [0.5, 0.0, 0.5];
                }
            }
            Self::Texture => {
                for thing in &mut model.things {
                    thing.color = None;
                    thing.object.texturing.color_map = None;
                }
            }
            Self::Object => drop(model.things.pop()),
            Self::Copy => {
                for thing in &mut model.things {
                    if thing.object.instances.len() > 1 {
                        thing.object.instances[1] = thing.object.instances[0];
                    }
                }
            }
        }
    }
}

/// What a new renderer drew.
struct Fresh {
    planes: Vec<Vec<u8>>,
    paths: Vec<DrawPath>,
}

/// Draws what a frame shows by a new renderer, and compares.
pub fn check(host: &Host, device: &Device, drawn: &Drawn, fault: Fault) -> Result<Same, Finding> {
    let mut model = drawn.model.clone();
    fault.spoil(&mut model);
    let new = fresh(host, device, drawn, &model)?;
    let (mut hits, mut wrong, mut text) = (0, BTreeSet::new(), String::new());
    let kind = &drawn.kind;
    let planes = drawn.planes.iter().zip(&new.planes);
    for (n, (shown, wanted)) in planes.enumerate() {
        // Compute has depths, which may hold anything if they do not count, then colours.
        let (bytes, skipped) = match kind.compute {
            true => (4, if drawn.depths { 0 } else { kind.pixels() }),
            false => (wanted.len() / kind.pixels(), 0),
        };
        let pairs = || shown.chunks(bytes).zip(wanted.chunks(bytes)).enumerate();
        // If the first pixel shows a solid, this counts the background.
        hits = pairs().filter(|(_, (_, b))| *b != &wanted[..bytes]).count();
        let differ = pairs().skip(skipped).filter(|(_, (a, b))| a != b);
        for (count, (pixel, (a, b))) in differ.enumerate() {
            let pixel = pixel % kind.pixels();
            wrong.insert(pixel);
            if count == 0 {
                let (x, y) = (pixel % kind.width(), pixel / kind.width());
                text += &format!(" plane {n} at ({x}, {y}): {a:?}, fresh {b:?};");
            }
        }
    }
    let same = Same {
        hits,
        other_path: drawn.paths != new.paths,
    };
    if wrong.is_empty() {
        return Ok(same);
    }
    found(format!(
        "{}: {} pixels differ from a fresh renderer's:{text} drawn by {}; \
         fresh {}; {} objects, {} copies, view {} of {kind:?}",
        drawn.name,
        wrong.len(),
        summary(&drawn.paths),
        summary(&new.paths),
        drawn.model.things.len(),
        drawn.model.copies(),
        drawn.seen.name,
    ))
}

fn fresh(host: &Host, device: &Device, drawn: &Drawn, model: &Model) -> Result<Fresh, Finding> {
    let kind = &drawn.kind;
    let null = ash::vk::RenderPass::null();
    let mut renderer = Renderer::new(device, kind.output(null), &kind.search, 1)?;
    let ids = model.add_to(&mut renderer)?;
    let canvas = kind.canvas(host);
    canvas.lend(&mut renderer, drawn.depths);
    once(host, |cmd| {
        // SAFETY: `cmd` is recording; no frame of this renderer is in flight; all that the commands
        // read outlives them.
        unsafe {
            let frame = renderer.prepare(cmd, 0, &drawn.seen.view)?;
            let recording = Recording {
                renderer: &renderer,
                frame: &frame,
                times: 1,
                warms: false,
                refused: Vec::new(),
            };
            recording.draw(host, cmd, &canvas, &drawn.seen)
        }
    })?;
    let mut planes = canvas.planes();
    if let Some(n) = kind.identity() {
        let new: Vec<_> = ids.iter().map(|id| id.number()).collect();
        renumber(&mut planes[n], &new, &drawn.model.numbers());
    }
    let paths = renderer.draw_paths();
    Ok(Fresh { planes, paths })
}

/// Changes the numbers of objects in a picture of identities.
fn renumber(bytes: &mut [u8], from: &[u32], to: &[u32]) {
    let numbers: HashMap<u32, u32> = from.iter().copied().zip(to.iter().copied()).collect();
    for pixel in bytes.as_chunks_mut::<8>().0 {
        let (number, _) = pixel.split_first_chunk_mut::<4>().unwrap();
        let known = numbers.get(&u32::from_le_bytes(*number));
        *number = known.map_or(*number, |n| n.to_le_bytes());
    }
}

/// The number of objects of each draw path.
fn summary(paths: &[DrawPath]) -> String {
    let mut counts: Vec<(DrawPath, usize)> = Vec::new();
    for path in paths {
        match counts.iter_mut().find(|(known, _)| known == path) {
            Some((_, count)) => *count += 1,
            None => counts.push((*path, 1)),
        }
    }
    format!("{counts:?}")
}
