//! Thin straight lines of a picture beside its solid.

use super::ProfileAxis;
use super::form::Silhouette;
use super::marks::{Mark, Marks, SOLID, THIN};
use glam::DVec2;
use revmap::error::Result;
use revmap::host_memory;
use std::collections::HashMap;

/// Least length of a line, in heights of the picture.
const LONG: f64 = 0.05;
/// Least part of a line that is drawn: the rest are gaps of dashes, and what it crosses.
const DRAWN: f64 = 0.1;
/// Larger pictures are not searched.
const MOST_PIXELS: usize = 1 << 24;
/// What needs memory, in messages.
const PIXELS: &str = "the pixels of a picture";
/// Least thickness that shows a solid, pixels.
const LEAST: f64 = 2.0;

/// Warnings about frames, centre lines and dimensions, and about the place of the solid without them.
/// `None` if the picture has none. `axis_at`: from the left edge, pixels.
pub(super) fn warnings(
    solid: &[bool],
    width: usize,
    axis_at: f64,
    axis: ProfileAxis,
) -> Option<Vec<String>> {
    if solid.len() > MOST_PIXELS {
        return None;
    }
    let height = solid.len() / width.max(1);
    let most = (THIN * height as f64).max(LEAST) as usize;
    let least = LONG * height as f64;
    let upright = lines(&runs(solid, width, true, most), least, true);
    let level = lines(&runs(solid, width, false, most), least, false);
    if upright.is_empty() && level.is_empty() {
        return None;
    }
    let thick = opened(solid, width, most + 1).ok()?;
    let area = thick.iter().filter(|is| **is).count() as f64;
    if area < SOLID * (height as f64).powi(2) {
        return None;
    }
    let places = thick.iter().enumerate().filter(|(_, is)| **is);
    let places = places.map(|(i, _)| DVec2::new((i % width) as f64, (i / width) as f64));
    let (low, high) = places.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p + 1.0))
    });
    let slack = most as f64;
    let mut marks = Marks {
        all: [upright, level].concat(),
        solid: [low, high],
        axis: axis_at,
        slack,
    };
    marks.all = annotation(&marks, axis != ProfileAxis::Left);
    let found = marks.warnings("picture", "erase it");
    let form = Silhouette::of_pixels(&thick, width, axis_at);
    (!found.is_empty()).then(|| found.into_iter().chain(form.axis_hint(axis)).collect())
}

/// Solid runs of at most `most` pixels across lines: of rows for upright lines, of columns for level
/// ones. From where to where they go, and in which row or column they are.
fn runs(
    solid: &[bool],
    width: usize,
    upright: bool,
    most: usize,
) -> HashMap<[usize; 2], Vec<usize>> {
    let height = solid.len() / width.max(1);
    let (across, along) = if upright {
        (width, height)
    } else {
        (height, width)
    };
    let mut found: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
    let mut starts = vec![None; along];
    for i in 0..=across {
        for (j, start) in starts.iter_mut().enumerate() {
            let at = if upright {
                j * width + i
            } else {
                i * width + j
            };
            match (i < across && solid[at], *start) {
                (true, None) => *start = Some(i),
                (false, Some(from)) => {
                    *start = None;
                    if i - from <= most {
                        found.entry([from, i]).or_default().push(j);
                    }
                }
                _ => {}
            }
        }
    }
    found
}

/// The runs that follow each other at one place, as lines.
fn lines(runs: &HashMap<[usize; 2], Vec<usize>>, least: f64, upright: bool) -> Vec<Mark> {
    let line = |([from, to], places): (&[usize; 2], &Vec<usize>)| {
        let [first, last] = [*places.first()?, *places.last()? + 1];
        let is_long = (places.len() as f64) >= least.max(DRAWN * (last - first) as f64);
        let turned = |across: usize, along: usize| {
            let p = DVec2::new(across as f64, along as f64);
            if upright { p } else { DVec2::new(p.y, p.x) }
        };
        is_long.then(|| Mark {
            low: turned(*from, first),
            high: turned(*to, last),
            is_straight: true,
            has_dots: false,
            line: None,
        })
    };
    let mut found: Vec<Mark> = runs.iter().filter_map(line).collect();
    found.sort_by(|a, b| {
        a.low
            .x
            .total_cmp(&b.low.x)
            .then(a.low.y.total_cmp(&b.low.y))
    });
    found
}

/// The pixels that a solid square of `side` pixels covers.
fn opened(solid: &[bool], width: usize, side: usize) -> Result<Vec<bool>> {
    let mut mask = host_memory::collected(solid.iter().copied(), PIXELS)?;
    for (upright, erodes) in [(false, true), (true, true), (false, false), (true, false)] {
        let height = mask.len() / width.max(1);
        let [lines, length] = if upright {
            [width, height]
        } else {
            [height, width]
        };
        let mut counts = vec![0; lines];
        for i in 0..length {
            for (j, count) in counts.iter_mut().enumerate() {
                // Squares shrink to their last pixel, and grow back from there.
                let i = if erodes { i } else { length - 1 - i };
                let at = if upright {
                    i * width + j
                } else {
                    j * width + i
                };
                if erodes {
                    *count = if mask[at] { *count + 1 } else { 0 };
                    mask[at] = *count >= side;
                } else {
                    *count = if mask[at] {
                        side
                    } else {
                        *count - usize::from(*count > 0)
                    };
                    mask[at] = *count > 0;
                }
            }
        }
    }
    Ok(mask)
}

/// The lines that are no part of a solid: a frame, centre lines that leave the solid at both ends,
/// and lines beside it that end at two others. These go beyond, or are on one side alone.
fn annotation(marks: &Marks, is_whole: bool) -> Vec<Mark> {
    let slack = marks.slack;
    let middle = |mark: &Mark| 0.5 * (mark.low + mark.high);
    let has_mirror_image = |mark: &Mark| {
        let mirrored = 2.0 * marks.axis - middle(mark).x;
        marks
            .all
            .iter()
            .any(|m| (middle(m).x - mirrored).abs() <= slack)
    };
    let is_single = |mark: &Mark| is_whole && !has_mirror_image(mark);
    let is_centre_line = |mark: &Mark| {
        let is_upright = mark.high.x - mark.low.x <= slack;
        is_upright && marks.passes(mark) && (marks.is_on_axis(mark) || is_single(mark))
    };
    let is_dimension = |mark: &Mark, axis: usize| {
        let along = 1 - axis;
        let at = middle(mark)[axis];
        let side = match at {
            _ if mark.high[axis] - mark.low[axis] > slack => return false,
            _ if at > marks.solid[1][axis] + slack => 1.0,
            _ if at < marks.solid[0][axis] - slack => -1.0,
            _ => return false,
        };
        let is_end = |other: &&Mark| {
            let z = middle(other)[along];
            other.high[along] - other.low[along] <= slack
                && (other.low[axis] - slack..=other.high[axis] + slack).contains(&at)
                && (mark.low[along] - slack..=mark.high[along] + slack).contains(&z)
        };
        let beyond = |end: &Mark| (side * (end.low[axis] - at)).max(side * (end.high[axis] - at));
        let ends: Vec<&Mark> = marks.all.iter().filter(is_end).collect();
        let is_crossed = ends.iter().any(|end| beyond(end) > slack);
        ends.len() >= 2 && (is_crossed || (axis == 0 && is_single(mark)))
    };
    let is_meant = |mark: &&Mark| {
        let is_beside = is_dimension(mark, 0) || is_dimension(mark, 1);
        marks.is_frame(mark) || is_centre_line(mark) || is_beside
    };
    marks.all.iter().filter(is_meant).cloned().collect()
}
