//! Contours as they were last cut, and envelopes as they were last grown: kept while an object uses them, shared by objects of one profile
//! and offset.

use super::contours::ProfileContour;
use super::hulls::Shell;
use super::tables::Packed;
use crate::error::Result;
use crate::maps::envelope::Envelope;
use crate::pieces::{Cones, Piece, cut};
use crate::scene::Offset;
use crate::shader::generated::PIECE_ROWS;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

/// One contour or envelope under one offset, and what is made of it when first wanted.
pub(crate) struct Cut {
    made: Made,
    /// Largest radius, least and largest `z`; of pieces alone.
    extent: [f64; 3],
    tables: OnceLock<Packed>,
    shell: OnceLock<Shell>,
}

enum Made {
    Pieces(Vec<Piece>),
    Cones(Cones),
    Envelope(Envelope),
}

impl Cut {
    fn pieces_of(contour: &ProfileContour, offset: &Offset) -> Result<Self> {
        let pieces = cut(&contour.contour(offset)?, &contour.options);
        let extent = pieces
            .iter()
            .fold([0.0f64, f64::INFINITY, f64::NEG_INFINITY], |m, p| {
                [m[0].max(p.r[1]), m[1].min(p.z[0]), m[2].max(p.z[1])]
            });
        Ok(Self::new(Made::Pieces(pieces), extent))
    }

    fn cones_of(
        contour: &ProfileContour,
        offset: &Offset,
        rows: u32,
        relaxed: bool,
    ) -> Result<Self> {
        let contour = contour.contour(offset)?;
        let make = if relaxed { Cones::relaxed } else { Cones::new };
        let cones = make(&contour, rows)?;
        Ok(Self::new(Made::Cones(cones), [0.0; 3]))
    }

    fn new(made: Made, extent: [f64; 3]) -> Self {
        Self {
            made,
            extent,
            tables: OnceLock::new(),
            shell: OnceLock::new(),
        }
    }

    /// What the search walks.
    pub fn tables(&self) -> &Packed {
        self.tables.get_or_init(|| match &self.made {
            Made::Pieces(pieces) => Packed::pieces(pieces),
            Made::Cones(cones) => Packed::cones(cones),
            Made::Envelope(envelope) => Packed::envelope(envelope),
        })
    }

    /// What the rasteriser draws; of cones nothing.
    pub fn shell(&self) -> &Shell {
        self.shell.get_or_init(|| match &self.made {
            Made::Pieces(pieces) => Shell::new(pieces),
            Made::Cones(_) => Shell::new(&[]),
            Made::Envelope(envelope) => Shell::convex(envelope),
        })
    }

    /// Whether it is the boundary itself; an envelope only says where the solid may be, and rays are searched as in the box.
    pub fn is_boundary(&self) -> bool {
        !matches!(self.made, Made::Envelope(_))
    }

    /// Largest radius of the pieces, least and largest `z`; of pieces alone.
    pub fn extent(&self) -> [f64; 3] {
        self.extent
    }
}

/// What a cut depends on. That of one renderer are all for one search.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    profile: usize,
    /// Bits of extension, bevel and chamfer.
    offset: [u64; 3],
    rows: u32,
}

impl Key {
    fn new(contour: &ProfileContour, offset: &Offset, rows: u32) -> Self {
        Self {
            profile: contour.key(),
            // Of both zeros one.
            offset: [offset.extend, offset.bevel, offset.chamfer].map(|v| (v + 0.0).to_bits()),
            rows,
        }
    }
}

struct Kept {
    /// Of a contour that does not close the reason, so that it is not tried in every frame.
    cut: Result<Arc<Cut>>,
    used: bool,
}

/// The cuts of a renderer.
#[derive(Default)]
pub(crate) struct Cuts {
    kept: HashMap<Key, Kept>,
    /// By the envelope, and the bits of what it is grown by; and whether it was used.
    grown: HashMap<(usize, u64), (Arc<Cut>, bool)>,
    done: u64,
}

impl Cuts {
    /// The pieces of a contour under an offset.
    ///
    /// # Errors
    /// Where it does not close.
    pub fn pieces(&mut self, contour: &ProfileContour, offset: &Offset) -> Result<Arc<Cut>> {
        let key = Key::new(contour, offset, PIECE_ROWS);
        self.cut(key, || Cut::pieces_of(contour, offset))
    }

    /// A row of so many cones around a contour under an offset; of one renderer all are relaxed or none.
    ///
    /// # Errors
    /// Where it does not close, or is not single-valued.
    pub fn cones(
        &mut self,
        contour: &ProfileContour,
        offset: &Offset,
        rows: u32,
        relaxed: bool,
    ) -> Result<Arc<Cut>> {
        let key = Key::new(contour, offset, rows);
        self.cut(key, || Cut::cones_of(contour, offset, rows, relaxed))
    }

    /// An envelope, which must live as long as this, grown by so much. No contour is cut for it, and none counted.
    pub fn grown(&mut self, envelope: &Arc<Envelope>, by: f64) -> Arc<Cut> {
        let key = (Arc::as_ptr(envelope) as usize, by.to_bits());
        let grown = self.grown.entry(key).or_insert_with(|| {
            let made = Made::Envelope(envelope.grown(by));
            (Arc::new(Cut::new(made, [0.0; 3])), true)
        });
        grown.1 = true;
        grown.0.clone()
    }

    fn cut(&mut self, key: Key, make: impl FnOnce() -> Result<Cut>) -> Result<Arc<Cut>> {
        let done = &mut self.done;
        let kept = self.kept.entry(key).or_insert_with(|| {
            *done += 1;
            Kept {
                cut: make().map(Arc::new),
                used: true,
            }
        });
        kept.used = true;
        kept.cut.clone()
    }

    /// Forgets what was not asked for since the last call.
    pub fn forget_unused(&mut self) {
        self.kept
            .retain(|_, kept| std::mem::replace(&mut kept.used, false));
        self.grown
            .retain(|_, (_, used)| std::mem::replace(used, false));
    }

    /// How many have been made.
    pub fn done(&self) -> u64 {
        self.done
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::contours::Contours;
    use super::super::parts::{Of, Parts};
    use super::*;
    use crate::profile::Profile;
    use crate::scene::{Camera, Object, Scene};
    use crate::settings::Settings;
    use glam::DVec3;

    #[test]
    fn equal_offsets_share_tables_and_hull_until_they_are_forgotten() {
        let points = [[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]];
        let profile = Arc::new(Profile::polygon(&points, 0.5).unwrap());
        let mut scene = Scene::new(Camera::new(DVec3::X, DVec3::ZERO));
        scene.objects.push(Object::new("cone", profile));
        let contours = Contours::of(&scene, &Settings::default()).unwrap();
        let contour = contours.get(&scene.objects[0]).unwrap();
        let offset = |extend| Offset {
            extend,
            ..Offset::default()
        };
        let mut cuts = Cuts::default();
        let first = cuts.pieces(contour, &offset(0.0)).unwrap();
        let second = cuts.pieces(contour, &offset(-0.0)).unwrap();
        assert!(Arc::ptr_eq(&first, &second));
        assert!(std::ptr::eq(first.tables(), second.tables()));
        assert!(std::ptr::eq(first.shell(), second.shell()));
        let other = cuts.pieces(contour, &offset(0.01)).unwrap();
        assert!(!Arc::ptr_eq(&first, &other));
        assert!(cuts.cones(contour, &offset(0.0), 64, false).is_ok());
        assert_eq!(cuts.done(), 3);

        let place = |cut| {
            let mut parts = Parts::default();
            let begin = parts.place(cut, Of::Tables, 4);
            assert_eq!(parts.place(cut, Of::Tables, 4), begin);
            assert!(parts.place(cut, Of::Bands, 1) > begin);
            parts
        };
        assert!(place(&first).same(&place(&second)));
        assert!(!place(&first).same(&place(&other)));

        let envelope = Arc::new(Envelope {
            radii: vec![0.2; 64],
        });
        let grown = cuts.grown(&envelope, 0.01);
        assert!(Arc::ptr_eq(&grown, &cuts.grown(&envelope, 0.01)));
        assert!(!Arc::ptr_eq(&grown, &cuts.grown(&envelope, 0.02)));
        assert_eq!((cuts.done(), cuts.grown.len()), (3, 2), "none is counted");

        cuts.forget_unused();
        cuts.pieces(contour, &offset(0.01)).unwrap();
        cuts.grown(&envelope, 0.02);
        cuts.forget_unused();
        assert_eq!(cuts.grown.len(), 1);
        assert_eq!((cuts.done(), cuts.kept.len()), (3, 1));
        cuts.pieces(contour, &offset(0.0)).unwrap();
        assert_eq!(cuts.done(), 4);
    }
}
