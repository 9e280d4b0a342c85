//! A photograph's half profile.

use crate::choice::{Candidate, candidates};
use crate::cutout::Cutout;
use crate::edge::{Half, Halves, Sampler, halves};
use crate::foot::cut_shadow;
use crate::ground::{Backdrop, Ground, backdrops, shade};
use crate::mask::{Mask, largest, mask};
use crate::work::{Work, distance};
use crate::{Photo, above, frame};

/// A half profile, and how it was found. Lengths are heights of the picture.
#[derive(Clone, Debug)]
pub struct Reading {
    /// Radii of rows of equal height from the top to the bottom of the thing.
    pub radii: Vec<f64>,
    /// Height of the thing's top above the picture's lower edge.
    pub top: f64,
    /// Height of the thing's bottom above the picture's lower edge.
    pub bottom: f64,
    /// The outline over the picture, pixels, closed by itself.
    pub outline: Vec<[f64; 2]>,
    /// The axis at half the thing's height, as a part of the picture's width.
    pub axis: f64,
    /// Degrees by which the thing leans to the right.
    pub tilt: f64,
    /// The ground.
    pub ground: Ground,
    /// How the thing differs from the ground.
    pub tone: Tone,
    /// Parts that were left out.
    pub left_out: Vec<LeftOut>,
    /// The half in use.
    pub half: Half,
    /// The difference of both halves as a part of the width.
    pub differ: f64,
    /// The picture's left or right edge cuts the thing.
    pub cut: bool,
    /// Elevation of the camera, degrees, if foot and rim were cut at the middles of their ellipses.
    pub elevation: Option<f64>,
    /// What speaks for the outline, in `[0, 1]`: symmetry, edges and size.
    pub score: f64,
    /// Reasons for which the outline may be wrong; a sure reading has none.
    pub doubts: Vec<Doubt>,
}

/// How a thing differs from its ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Mostly darker.
    Darker,
    /// Mostly lighter.
    Lighter,
    /// Darker in one part and lighter in another.
    Both,
    /// As light, of another hue.
    Hue,
}

/// A part that was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// A frame round the picture.
    Frame,
    /// A shadow.
    Shadow,
    /// A part on one side of the axis.
    OneSide,
    /// So many other things.
    Things(usize),
}

/// A reason for which an outline may be wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// The thing may go on above or below the outline.
    Part,
    /// The picture's upper or lower edge cuts the thing.
    Cut(End),
    /// Thing and ground are nearly alike along this part of the outline.
    Faint(f64),
    /// The thing is wider on one side by what looks like a shadow.
    Shadow,
    /// The thing is not alike on both sides of the axis.
    Uneven(f64),
}

/// The upper or lower end of a thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The top.
    Upper,
    /// The bottom.
    Lower,
}

/// The reason why nothing was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing stands out from the ground.
    Nothing,
    /// Nothing is alike on both sides of an axis.
    NoSymmetry,
}

/// Less is found in textures. Things in a dark room with much noise have 0.27.
const LEAST_SCORE: f64 = 0.15;
/// A thing of less symmetry is none that was turned.
const LEAST_SYMMETRY: f64 = 0.75;
/// Things of less symmetry are doubtful.
const EVEN: f64 = 0.93;
/// The edge of a sure thing is faint along less of its border.
const FAINT: f64 = 0.06;
/// More than this part of the thing's area on one side, and a faint border, show that the symmetry
/// is by chance.
const ONE_SIDED: f64 = 0.2;
/// A thing is cut where the picture's edge has this part of its width.
const CUT: f64 = 0.1;
/// What is left out is told from this part of the thing's area on.
const TOLD: f64 = 0.03;

/// Reads the half profile of the thing in a photograph.
///
/// # Errors
/// If nothing differs from the ground, or nothing is alike on both sides of an axis.
pub fn read(photo: &Photo) -> Result<Reading, Fault> {
    let cutout = Cutout::of(photo);
    let (seen, cuts, added) = match &cutout {
        Some(cutout) => (cutout.photo(), [0; 4], f64::from(cutout.margin)),
        None => (*photo, frame::margins(photo), 0.0),
    };
    let work = Work::new(&seen, cuts).ok_or(Fault::Nothing)?;
    let (backdrops, found) = match cutout.is_some() {
        true => (Vec::new(), opaque(&work).into_iter().collect()),
        false => {
            let backdrops = backdrops(&work);
            let found = candidates(&work, &backdrops);
            (backdrops, found)
        }
    };
    let best = found
        .first()
        .filter(|c: &&Candidate| c.score > LEAST_SCORE)
        .ok_or(Fault::Nothing)?;
    let backdrop = backdrops.get(best.ground);
    let sides = backdrop.map_or(Sides::OPAQUE, |b| Sides::of(&work, b, best));
    let by_chance = best.faint >= FAINT && sides.one_sided[1] > ONE_SIDED;
    if best.symmetry < LEAST_SYMMETRY || by_chance {
        return Err(Fault::NoSymmetry);
    }
    let margin = [f64::from(cuts[0]), f64::from(cuts[1])];
    let sampler = Sampler {
        photo: &seen,
        work: &work,
        margin,
        angle: best.rows.angle,
    };
    let mut halves = halves(&sampler, best);
    let rows = halves.radii.len() as f64;
    let stands = halves.top + halves.step * rows < work.height as f64 - 1.5;
    let seen = above::seen_from(&halves.radii, halves.step).filter(|_| stands);
    if let Some(backdrop) = backdrop.filter(|_| seen.is_none()) {
        cut_shadow(&mut halves, &sampler, backdrop);
    }
    let elevation = seen.as_ref().map(|view| view.elevation);
    let ([from, to], widths) = match &seen {
        Some(view) => (view.ends, &view.radii),
        None => ([0.0, rows], &halves.radii),
    };
    let squeeze = elevation.map_or(1.0, |e| e.to_radians().cos());
    let count = (to - from).round().max(1.0) as usize;
    let row = |k: usize| from + (k as f64 + 0.5) * (to - from) / count as f64 - 0.5;
    let radii: Vec<f64> = (0..count).map(|k| above::at(widths, row(k))).collect();
    let place = |row: f64, u: f64| {
        let across = halves.axis + halves.slope * row + u;
        let p = sampler.place([across, halves.top + halves.step * (row + 0.5)]);
        [0, 1].map(|i| p[i] * work.scale + margin[i] - added)
    };
    let right = (0..count).map(|k| place(row(k), radii[k]));
    let left = (0..count).rev().map(|k| place(row(k), -radii[k]));
    let height = f64::from(photo.height);
    let from_top = margin[1] - added;
    let z = |row: f64| 1.0 - ((halves.top + halves.step * row) * work.scale + from_top) / height;
    Ok(Reading {
        outline: right.chain(left).collect(),
        axis: place(0.5 * (from + to), 0.0)[0] / f64::from(photo.width),
        radii: radii
            .iter()
            .map(|r| r * squeeze * work.scale / height)
            .collect(),
        top: z(from),
        bottom: z(to),
        tilt: best.rows.angle - (halves.slope / halves.step).atan().to_degrees(),
        ground: backdrop.map_or(Ground::Transparent, |b| b.ground),
        tone: sides.tone,
        left_out: left_out(best, cuts != [0; 4], &sides),
        half: halves.half,
        differ: halves.differ,
        cut: halves.cut,
        elevation,
        score: best.score,
        doubts: match found.iter().any(|other| other.continues(best)) {
            true => vec![Doubt::Part],
            false => doubts(best, &sides, &halves),
        },
    })
}

fn left_out(best: &Candidate, framed: bool, sides: &Sides) -> Vec<LeftOut> {
    let found = [
        framed.then_some(LeftOut::Frame),
        (sides.shadow >= TOLD).then_some(LeftOut::Shadow),
        (sides.one_sided[1] >= TOLD).then_some(LeftOut::OneSide),
        (best.parts_left_out > 0).then_some(LeftOut::Things(best.parts_left_out)),
    ];
    found.into_iter().flatten().collect()
}

fn doubts(best: &Candidate, sides: &Sides, halves: &Halves) -> Vec<Doubt> {
    let faint = (best.faint >= FAINT).then_some(Doubt::Faint(best.faint));
    let uneven = (best.symmetry < EVEN && !halves.cut).then_some(match sides.one_sided {
        [shadow, other] if shadow > other => Doubt::Shadow,
        _ => Doubt::Uneven(halves.differ),
    });
    let cut = cut_end(&best.mask).map(Doubt::Cut);
    faint.or(uneven).into_iter().chain(cut).collect()
}

/// The end that the picture's edge cuts.
fn cut_end(mask: &Mask) -> Option<End> {
    let (width, last) = (mask.width(), mask.height() - 1);
    let row = |y: u32| {
        (0..width)
            .filter(|x| mask.get_pixel(*x, y).0[0] > 0)
            .count() as f64
    };
    let widest = (0..=last).map(row).fold(1.0, f64::max);
    let is_cut = |y: u32| row(y) > CUT * widest;
    let ends = [(last, End::Lower), (0, End::Upper)];
    ends.into_iter()
        .find(|(y, _)| is_cut(*y))
        .map(|(_, end)| end)
}

/// What is on both sides of a mask's border. Areas are parts of the mask's own.
#[derive(Debug)]
struct Sides {
    tone: Tone,
    /// Shadow outside the mask.
    shadow: f64,
    /// What is on one side of the axis alone: in shadow, and other.
    one_sided: [f64; 2],
}

impl Sides {
    /// Nothing is beside an opaque part.
    const OPAQUE: Self = Self {
        tone: Tone::Hue,
        shadow: 0.0,
        one_sided: [0.0; 2],
    };

    fn of(work: &Work, backdrop: &Backdrop, best: &Candidate) -> Self {
        let (whole, both) = match &best.origin {
            Some(origin) => (origin.clone(), best.mask.clone()),
            None => (best.mask.clone(), best.mirrored(work)),
        };
        let (mut darker, mut lighter, mut area, mut shadow) = (0.0, 0.0, 0.0, 0.0);
        let mut one_sided = [0.0; 2];
        let solid = |mask: &Mask, i: usize| mask.as_raw()[i] > 0;
        for (i, ground) in backdrop.lab.iter().enumerate() {
            let color = work.color(i % work.width, i / work.width);
            let (light, tint) = shade(work, i, *ground);
            let in_shadow = light < 0.95 && tint < 0.12;
            let difference = color[0] - ground[0];
            if solid(&best.mask, i) {
                area += 1.0;
                darker += f64::from(u8::from(difference < -4.0));
                lighter += f64::from(u8::from(difference > 4.0));
            } else if in_shadow && distance(color, *ground) > 5.0 + 2.0 * work.noise {
                shadow += 1.0;
            }
            if solid(&whole, i) && !solid(&both, i) {
                one_sided[usize::from(!in_shadow)] += 1.0;
            }
        }
        let tone = match (darker > 0.25 * area, lighter > 0.25 * area) {
            (true, true) => Tone::Both,
            (true, false) => Tone::Darker,
            (false, true) => Tone::Lighter,
            (false, false) => Tone::Hue,
        };
        Self {
            tone,
            shadow: shadow / area,
            one_sided: one_sided.map(|v| v / area),
        }
    }
}

/// The opaque part, without a soft shadow.
fn opaque(work: &Work) -> Option<Candidate> {
    let alpha = &work.alpha;
    let part = |is: &dyn Fn(u8) -> bool| alpha.iter().filter(|a| is(**a)).count() as f64;
    let core = part(&|a| a > 128);
    let soft = part(&|a| (13..200).contains(&a)) > 0.05 * core;
    let least = if soft { 200 } else { 127 };
    let (mask, parts) = largest(&mask(work.width, work.height, |i| alpha[i] > least));
    Candidate::new(work, mask, 0, parts)
}
