//! Thin straight lines of a picture beside its solid.

use crate::profile::ProfileAxis;
use crate::profile::seeming::Silhouette;
use crate::profile::seeming::marks::{Mark, Marks, SOLID, THIN};
use glam::{DVec2, Vec2Swizzles as _};
use image::{GrayImage, Luma};
use imageproc::distance_transform::Norm;
use imageproc::morphology::open_mut;
use revmap::error::Result;
use revmap::host_memory;
use std::collections::BTreeMap;

/// Least length of a line, in heights of the picture.
const LONG: f64 = 0.05;
/// Least part of a line that is drawn: the rest are gaps of dashes, and what it crosses.
const DRAWN: f64 = 0.1;
/// Larger pictures are not searched.
const MOST_PIXELS: usize = 1 << 24;
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
    let mut all = lines(solid, width, most, least);
    let level = lines(&turned(solid, width).ok()?, height, most, least);
    all.extend(level.into_iter().map(|line| Mark {
        low: line.low.yx(),
        high: line.high.yx(),
        ..line
    }));
    if all.is_empty() {
        return None;
    }
    let thick = opened(solid, width, most);
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
        all,
        solid: [low, high],
        axis: axis_at,
        slack,
    };
    marks.all = annotation(&marks, axis != ProfileAxis::Left);
    let found = marks.warnings("picture", "erase it");
    let form = Silhouette::of_pixels(&thick, width, axis_at);
    (!found.is_empty()).then(|| found.into_iter().chain(form.axis_hint(axis)).collect())
}

/// The pixels with rows and columns exchanged.
fn turned(solid: &[bool], width: usize) -> Result<Vec<bool>> {
    let height = solid.len() / width.max(1);
    let pixels = (0..solid.len()).map(|i| solid[i % height * width + i / height]);
    host_memory::collected(pixels, "the pixels of a picture")
}

/// The runs of at most `most` solid pixels in rows that follow each other at one place, as upright
/// lines. `least`: of their length.
fn lines(solid: &[bool], width: usize, most: usize, least: f64) -> Vec<Mark> {
    let mut runs: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (row, pixels) in solid.chunks_exact(width.max(1)).enumerate() {
        let mut to = 0;
        for part in pixels.chunk_by(|a, b| a == b) {
            to += part.len();
            if part[0] && part.len() <= most {
                runs.entry([to - part.len(), to]).or_default().push(row);
            }
        }
    }
    let line = |([from, to], rows): ([usize; 2], Vec<usize>)| {
        let [first, last] = [*rows.first()?, *rows.last()? + 1];
        let is_long = (rows.len() as f64) >= least.max(DRAWN * (last - first) as f64);
        is_long.then(|| Mark {
            low: DVec2::new(from as f64, first as f64),
            high: DVec2::new(to as f64, last as f64),
            is_straight: true,
            has_dots: false,
            line: None,
        })
    };
    runs.into_iter().filter_map(line).collect()
}

/// The pixels that a solid square of more than `most` pixels covers.
fn opened(solid: &[bool], width: usize, most: usize) -> Vec<bool> {
    let [columns, rows] = [width, solid.len() / width.max(1)].map(|n| n as u32 + 2);
    // Beyond the picture is nothing solid.
    let place = |i: usize| ((i % width) as u32 + 1, (i / width) as u32 + 1);
    let mut wide = GrayImage::new(columns, rows);
    for (i, _) in solid.iter().enumerate().filter(|(_, is)| **is) {
        let (x, y) = place(i);
        wide.put_pixel(x, y, Luma([u8::MAX]));
    }
    open_mut(&mut wide, Norm::LInf, most.div_ceil(2) as u8);
    let is_left = |i| {
        let (x, y) = place(i);
        wide.get_pixel(x, y)[0] > 0
    };
    (0..solid.len()).map(is_left).collect()
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
