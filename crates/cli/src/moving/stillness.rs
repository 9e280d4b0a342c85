//! Films in which nothing is seen to move, and what would move.

use crate::studio::GROUND_NAME;
use crate::vary::Vary;
use revmap::scene::Scene;
use revmap_bench::report::pictures::reduced;
use revmap_files::Picture;

/// Pixels on a side of a block.
const SIDE: u32 = 8;
/// Means of a block that differ by more are seen to move, parts of 255. Rounding changes single
/// pixels of a silhouette, at most 1.2 in the mean of a block; the noise of soft shadows changes
/// 2.0 (llvmpipe).
const SEEN: u8 = 4;

/// A frame as means of blocks, each of red, green and blue times alpha, and alpha.
fn blocks(picture: &Picture) -> Picture {
    let mut own = picture.clone();
    for [red, green, blue, alpha] in &mut own.rgba {
        let times = |c: u8| (u16::from(c) * u16::from(*alpha) / 255) as u8;
        (*red, *green, *blue) = (times(*red), times(*green), times(*blue));
    }
    reduced(&own, SIDE)
}

fn alike(a: &Picture, b: &Picture) -> bool {
    let pairs = a.rgba.as_flattened().iter().zip(b.rgba.as_flattened());
    pairs.into_iter().all(|(a, b)| a.abs_diff(*b) <= SEEN)
}

/// Compares every frame of a film with the first.
#[derive(Default)]
pub struct Stillness {
    first: Option<Picture>,
    moves: bool,
}

impl Stillness {
    /// Takes the next frame.
    pub fn add(&mut self, picture: &Picture) {
        if self.moves {
            return;
        }
        let blocks = blocks(picture);
        match &self.first {
            Some(first) => self.moves = !alike(&blocks, first),
            None => self.first = Some(blocks),
        }
    }

    /// True if there are frames, and none is seen to differ from the first.
    pub fn stands_still(&self) -> bool {
        self.first.is_some() && !self.moves
    }
}

/// The warning about a film that stands still: its first scene, the degrees from one frame to the
/// next, the keys that vary, and whether the lights turn with the camera because of `--turntable`
/// alone.
pub fn remedy(scene: &Scene, step: f64, varied: &[Vary], turntable: bool) -> String {
    if step != 0.0 && step % 360.0 == 0.0 {
        return "--turn: every frame is whole turns after the one before, so all frames look alike; give less".to_owned();
    }
    let (mut why, mut remedies) = (String::new(), Vec::new());
    if step != 0.0 {
        why.push_str(": a solid of revolution looks the same from all sides");
        let mut objects = scene.objects.iter().filter(|o| o.name != GROUND_NAME);
        if objects.all(|o| o.texturing.color_map.is_none()) {
            remedies.push("a colour map (--set object.0.color_map=FILE)");
        }
        if turntable && !scene.lights.is_empty() {
            remedies.push("--turn without --turntable");
        }
    }
    match varied.first() {
        Some(vary) if step == 0.0 => {
            why = format!(": --vary {} changes nothing that is seen", vary.key);
            remedies.push("values farther apart, or another key");
        }
        _ => remedies.push("a shape that changes (--vary object.0.extend=0:0.05 --bounce)"),
    }
    format!(
        "all frames look alike{why}; give {}",
        remedies.join(", or ")
    )
}
