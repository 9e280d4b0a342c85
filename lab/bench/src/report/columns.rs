//! The one description of every column: name in files, heading, meaning, and the cell of a row.

use crate::measure::machine::Machine;
use crate::measure::ratios::{Over, above_floor, baseline_stage, between};
use crate::measure::row::{Clocks, Row};
use crate::plan::method::{Edges, Method};
use crate::plan::{Plan, RBM_BASELINE, is_rbm_baseline};
use crate::report::series_style::SeriesStyles;
use revmap::error::{Error, ErrorKind, Result};
use revmap::scene::{Offset, Shadow};
use revmap::settings::{Tolerance, name_of};
use revmap_compare::{PixelErrors, ViewErrors};
use revmap_figures::groups::grouped;
use revmap_figures::names::{count, number, percent, range};
use revmap_figures::stats::{self, Interval};
use revmap_figures::table::{NO_VALUE, Table};

/// The sources of cells beside their row.
pub struct Context<'a> {
    /// All rows.
    pub rows: &'a [&'a Row],
    /// The plan that was measured.
    pub plan: &'a Plan,
    /// Names and looks of the ways of drawing.
    pub styles: SeriesStyles,
    /// The Vulkan device.
    pub device: &'a str,
    /// Its driver.
    pub driver: &'a str,
    /// Half the width of an interval, relative, above which a figure is not resolved.
    pub resolved: f64,
}

/// Half the width of an interval, relative, above which a figure is not resolved where no plan
/// says.
pub(crate) const RESOLVED: f64 = 0.25;

/// A column.
pub struct Column {
    /// Its name in files and plans.
    pub name: &'static str,
    /// Its heading in tables and on axes, with its unit.
    pub heading: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
    /// Smaller values are drawn here, on logarithmic axes; 0 for none.
    pub floor: f64,
    /// The cell of a row.
    pub cell: fn(&Context, &Row) -> Cell,
}

/// Columns, one a line: name, heading, meaning, where charts begin, cell.
macro_rules! columns {
    ($($name:literal, $heading:literal, $meaning:literal $(, from $floor:literal)? => |$c:pat_param, $r:pat_param| $cell:expr;)*) => {
        &[$(Column {
            name: $name,
            heading: $heading,
            meaning: $meaning,
            floor: [$($floor,)? 0.0][0],
            cell: |$c, $r| $cell,
        },)*]
    };
}

/// How many columns `results.csv` has: the first of all.
pub const RESULTS: usize = 45;

/// How many of them every version writes, before all others.
pub const CONTRACT: usize = 31;

/// The time by the device's clock, where it has one that agrees with the wall clock.
fn gpu(row: &Row) -> Option<Interval> {
    row.time().filter(|_| row.clocks() == Clocks::Agree)
}

/// The cell of a search's own column; a mesh has none.
fn searched(row: &Row, cell: Cell) -> Cell {
    if row.settings.method.is_mesh() {
        Cell::Empty
    } else {
        cell
    }
}

fn offset(row: &Row, of: fn(&Offset) -> f64) -> Cell {
    Cell::number(row.offset.as_ref().map(of))
}

fn pixels(row: &Row, of: fn(&PixelErrors) -> Cell) -> Cell {
    row.pixel_errors.as_ref().map_or(Cell::Empty, of)
}

fn over(context: &Context, row: &Row, other: Over) -> Cell {
    context.known(ratio(context, row, other))
}

fn ratio(context: &Context, row: &Row, other: Over) -> Option<Interval> {
    between(row, other.of(context.rows, row)?)
}

/// An end of the interval of a row's time over that of the fragment stage.
fn stages_end(context: &Context, row: &Row, of: fn((f64, f64)) -> f64) -> Cell {
    let ends = ratio(context, row, Over::Fragment).and_then(|i| i.ends());
    Cell::number(ends.map(of))
}

/// A cell of the errors in pixels of the view; the floor has none.
fn view(row: &Row, of: fn(&ViewErrors) -> f64) -> Cell {
    let errors = row.surface().and_then(|errors| errors.view.as_ref());
    Cell::number(errors.map(of))
}

/// The host's time of a change and the time of the frame, ms.
fn whole(row: &Row) -> Option<f64> {
    Some(row.typical(|s| s.change_ms)? + row.time()?.value)
}

fn yes(yes: bool) -> &'static str {
    if yes { "yes" } else { "no" }
}

fn within(row: &Row) -> Cell {
    let most = row.settings.tolerance;
    let errors = row.pixel_errors.as_ref();
    let bounded = errors.filter(|_| most > Tolerance::EXACT);
    let held = bounded.map(|e| e.p999.max(e.contour_max) <= most.pixels());
    Cell::name(held.map(yes))
}

/// How edges are treated, by which method where it is not the default.
fn edges(row: &Row) -> String {
    let (method, edges) = (row.settings.method, row.settings.edges);
    match (method.is_mesh(), edges) {
        (true, Edges::OneRay) => method.to_string(),
        (true, _) => format!("{method}, {}", edges.name()),
        (false, Edges::Msaa) => format!("1 ray, {}", edges.name()),
        (false, _) => edges.name(),
    }
}

/// All columns, each once; those of `results.csv` first, in the order in which it has them.
pub static COLUMNS: &[Column] = columns! {
    "scene", "scene", "name of the view: the scene, with @ the elevation of the camera in degrees, with : a framing" => |_, r| Cell::text(&r.scene);
    "technique", "form", "offset of the surface: revolution (none), extended, beveled or chamfered" => |_, r| Cell::text(r.technique);
    "extend", "e", "extension of the offset, object units" => |_, r| offset(r, |o| o.extend);
    "bevel", "b", "slope of the offset" => |_, r| offset(r, |o| o.bevel);
    "chamfer", "c", "depth from 0 to 1 to which the slope reaches" => |_, r| offset(r, |o| o.chamfer);
    "stage", "stage", "shader stage in which rays are traced" => |_, r| Cell::text(r.settings.stage.name());
    "solver", "solver", "how the first hit along a ray is found; mesh:PIXELSpx is a mesh whose silhouettes keep so many pixels, mesh:SxR one of S segments around the axis and R rings along the outline" => |_, r| Cell::text(r.settings.method.to_string());
    "max_steps", "bound on steps", "bound on the steps of the search" => |_, r| searched(r, Cell::Count(r.max_steps().into()));
    "width", "width", "pixels across" => |_, r| Cell::Count(r.settings.width.into());
    "height", "height", "pixels down" => |_, r| Cell::Count(r.settings.height.into());
    "map_rows", "rows of the map", "rows of the shape map" => |_, r| Cell::count(r.map_rows.map(|n| n as usize));
    "map_source", "source", "origin of the map's distances" => |_, r| Cell::name(r.source.map(|s| s.name));
    "map_format", "format", "storage of the map's distances" => |_, r| searched(r, Cell::text(r.settings.map_format.name()));
    "objects", "solids", "solids in the scene, copies counted" => |_, r| Cell::count(r.solids);
    "gpu_ms_median", "device's time (ms)", "time of a frame by the device's timestamps, empty where it has none or they disagree with the wall clock" => |_, r| Cell::number(gpu(r).map(|t| t.value));
    "gpu_ms_p95", "device's time, p95 (ms)", "95th percentile of all timed frames" => |_, r| Cell::number(gpu(r).and_then(|_| stats::quantile(&r.gpu_ms(), 0.95)));
    "frame_ms_median", "wall clock (ms)", "wall clock from submission to completion, without reading back: geometric mean of the passes' medians" => |_, r| Cell::number(r.typical(|s| Some(s.frame_ms)));
    "fps", "frames / s by the wall clock", "1000 over frame_ms_median" => |_, r| Cell::number(r.typical(|s| Some(s.frame_ms)).map(|ms| 1e3 / ms));
    "steps_mean", "look-ups mean", "look-ups that the search made in a pixel: mean over the pixels with at least one" => |_, r| searched(r, Cell::Number(r.steps.mean));
    "steps_p99", "look-ups p99", "99th percentile of the look-ups" => |_, r| searched(r, Cell::Number(r.steps.p99));
    "steps_max", "look-ups max", "maximum of the look-ups" => |_, r| searched(r, Cell::Number(r.steps.max));
    "missed", "missed", "pixels in which the reference hits and the frame does not" => |_, r| Cell::count(r.errors.missed);
    "ghost", "ghosts", "pixels in which the frame hits and the reference does not" => |_, r| Cell::count(r.errors.ghost);
    "depth_rms_texels", "depth rms (h/512)", "error of the distance along the ray in pixels that both hit, in h/512, 1/512 of the solid's height: root mean square" => |_, r| Cell::number(r.errors.depth.map(|d| d.rms));
    "depth_p99_texels", "depth p99 (h/512)", "the same: 99th percentile; over several pictures the geometric mean", from 1e-4 => |_, r| Cell::number(r.errors.depth.map(|d| d.p99));
    "depth_max_texels", "depth max (h/512)", "the same: maximum" => |_, r| Cell::number(r.errors.depth.map(|d| d.max));
    "normal_rms_degrees", "normal rms (°)", "angle between the frame's normals and the reference's, degrees: root mean square", from 1e-3 => |_, r| Cell::number(r.errors.normal.map(|n| n.rms));
    "silhouette_hausdorff_px", "silhouette (px)", "Hausdorff distance of the silhouettes, pixels" => |_, r| Cell::Number(r.errors.silhouette_hausdorff);
    "flip", "FLIP", "mean of the difference metric FLIP over the picture, from 0 (equal) to 1", from 1e-6 => |_, r| Cell::number(r.errors.flip);
    "device", "device", "Vulkan device" => |c, _| Cell::text(c.device);
    "driver", "driver", "Vulkan driver" => |c, _| Cell::text(c.driver);
    "gpu_ms_low", "device's time, low (ms)", "lower end of its 95 % interval" => |_, r| Cell::number(gpu(r).and_then(|t| t.ends()).map(|e| e.0));
    "gpu_ms_high", "device's time, high (ms)", "upper end of its 95 % interval" => |_, r| Cell::number(gpu(r).and_then(|t| t.ends()).map(|e| e.1));
    "tolerance_px", "tolerance (pixels)", "allowed error in pixels: of silhouettes and depths, of searches on patches (0 is exact); of silhouettes, of meshes that follow the view" => |_, r| Cell::number(r.tolerance_px());
    "above_floor_ms", "above the floor (ms)", "time less that of the floor in the same picture and stage: what the search itself takes" => |c, r| Cell::number(above_floor(c.rows.iter().copied(), r));
    "resolved", "resolved", "whether the interval of the time is as narrow as the plan demands; figures that are not are left out of Pareto fronts" => |c, r| Cell::text(yes(r.resolved(c.resolved)));
    "time_over_fragment", "time / fragment stage", "time of the compute stage over that of the same method in the fragment stage, same picture" => |c, r| over(c, r, Over::Fragment);
    "time_over_fragment_low", "time / fragment stage, low", "lower end of its 95 % interval" => |c, r| stages_end(c, r, |e| e.0);
    "time_over_fragment_high", "time / fragment stage, high", "upper end of its 95 % interval" => |c, r| stages_end(c, r, |e| e.1);
    "shadow", "shadows", "shadows in the scene: off, hard or soft" => |_, r| Cell::text(name_of(&Shadow::NAMES, &r.shadow));
    "way", "edges", "how edges are treated: rays per pixel, smoothed silhouettes, or a pass of four samples (MSAA 4)" => |_, r| Cell::text(edges(r));
    "silhouette_p999_px", "silhouette p99.9 (px)", "distance of the silhouette from the true outline in pixels, 99.9th percentile over the pixels at the true outline and the wrong pixels: of a wrong pixel the distance of its centre from the outline, found by rays of the reference between the pixels' own; of a right pixel 0" => |_, r| view(r, |v| v.silhouette_p999);
    "silhouette_max_px", "silhouette max (px)", "the same: maximum" => |_, r| view(r, |v| v.silhouette_max);
    "depth_p99_px", "depth p99 (px)", "error of the distance along the ray over the size of a pixel there, 99th percentile over the pixels that both hit", from 1e-4 => |_, r| view(r, |v| v.depth_p99);
    "change_ms", "change (ms)", "in views whose offset moves: the host's time to take over a new offset and to record the frame, ms; not part of the other times" => |_, r| Cell::number(r.typical(|s| s.change_ms));
    "framing", "framing", "whole: the solid from head to foot; close: the field of view narrowed until the solid's box is a quarter larger than a picture of 4:3" => |_, r| Cell::text(r.framing.name());
    "value", "value", "parameter of the form, in plans that vary one" => |_, r| Cell::number(r.value);
    "method", "method", "the solver, and what else differs between the ways of drawing that are measured" => |c, r| Cell::text(c.styles.way(&r.settings));
    "size", "size", "pixels of the picture" => |_, r| Cell::text(r.size());
    "megapixels", "pixels (millions)", "pixels of the picture, millions" => |_, r| Cell::Number(f64::from(r.settings.width) * f64::from(r.settings.height) / 1e6);
    "hit_share", "pixels hit", "share of the picture's pixels in which the reference hits a solid" => |_, r| Cell::Share(r.covered());
    "time_ms", "time (ms)", "time of a frame by the device's timestamps, by the wall clock where the device has none: geometric mean of the passes' medians" => |_, r| r.time().map_or(Cell::text("clocks disagree"), |t| Cell::Number(t.value));
    "time_interval", "95 % interval", "ends of the interval that covers the value with 95 % confidence, Student's over the passes; not resolved: wider than the plan allows" => |c, r| r.time().map_or(Cell::Empty, |t| Cell::Text(c.ends(&t)));
    "time_low_ms", "time, low (ms)", "lower end of the 95 % interval of the time" => |_, r| Cell::number(r.time().and_then(|t| t.ends()).map(|e| e.0));
    "time_high_ms", "time, high (ms)", "upper end of the 95 % interval of the time" => |_, r| Cell::number(r.time().and_then(|t| t.ends()).map(|e| e.1));
    "rate", "frames / s", "1000 over the time" => |_, r| Cell::number(r.time().map(|t| 1e3 / t.value));
    "above_floor", "above the floor / RBM baseline", "time above the floor over the whole time of the RBM baseline (see time / RBM baseline)" => |c, r| {
        let baseline = Over::Baseline.of(c.rows, r).and_then(Row::time);
        Cell::number(above_floor(c.rows.iter().copied(), r).zip(baseline).map(|(above, t)| above / t.value))
    };
    "time_over_rbm_baseline", "time / RBM baseline", "time over that of the RBM baseline in the same picture: one for both stages, drawn in the fragment stage, or in the compute stage where only that was measured" => |c, r| over(c, r, Over::Baseline);
    "time_over_opponent", "time / mesh:0.25px", "time over that of the mesh whose silhouettes keep 0.25 pixels, in the same picture" => |c, r| over(c, r, Over::Opponent);
    "time_over_equal", "time / mesh of equal silhouettes", "time over that of the mesh whose silhouettes keep the same tolerance, in the same picture" => |c, r| over(c, r, Over::Equal);
    "frame_with_change_ms", "change and frame (ms)", "in views whose offset moves: the host's time of the change and the time of the frame" => |_, r| Cell::number(whole(r));
    "whole_over_opponent", "change and frame / mesh:0.25px", "change and frame over those of the mesh whose silhouettes keep 0.25 pixels" => |c, r| {
        let other = Over::Opponent.of(c.rows, r);
        Cell::number(other.and_then(|other| Some(whole(r)? / whole(other)?)))
    };
    "time_over_exact", "time / exact", "time over that of the exact picture in the same stage" => |c, r| over(c, r, Over::Exact);
    "time_over_1_ray", "time / 1 ray", "time over that of one ray per pixel in the same picture and stage" => |c, r| over(c, r, Over::Exact);
    "time_over_rival", "exact / fastest other", "time of the default search, exact, over that of the fastest other search in the same picture and stage whose depth errors are below a texel (99th percentile)" => |c, r| over(c, r, Over::Rival);
    "rival", "fastest other", "the fastest other search in the same picture and stage whose depth errors are below a texel" => |c, r| Cell::name(Over::Rival.of(c.rows, r).map(|o| o.settings.method.name()));
    "time_over_one_solid", "time / one solid", "time over that of one solid seen close, drawn in the same way; of the floor, over the solid that is searched" => |c, r| over(c, r, Over::One);
    "by_equal_pixels", "by equal pixels", "the same over the ratio of the pixels hit" => |c, r| {
        let one = Over::One.of(c.rows, r);
        Cell::number(one.and_then(|one| Some(between(r, one)?.value * one.covered() / r.covered())))
    };
    "rate_over_first", "rate / rate at the first value", "frames per second over those at the least value of the parameter" => |c, r| {
        let first = Over::First.of(c.rows, r);
        Cell::number(first.and_then(|first| Some(first.time()?.value / r.time()?.value)))
    };
    "exhausted", "out of steps", "pixels in which the search used up its bound on steps" => |_, r| Cell::count(r.settings.method.may_run_out().then_some(r.steps.exhausted));
    "memory_kb", "memory (kB)", "kilobytes on the device: shape maps and tables, or the mesh" => |_, r| Cell::Number(r.map_bytes as f64 / 1e3);
    "wrong_pixels", "wrong pixels", "missed and ghost pixels" => |_, r| Cell::count(r.surface().map(|e| e.missed + e.ghost));
    "wrong", "wrong pixels (share of pixels hit)", "missed and ghost pixels over the pixels hit", from 1e-6 => |_, r| Cell::Share(r.errors.wrong());
    "surface_p99_texels", "depth p99 (h/512)", "the same, not of the floor, which has no surface to err from", from 1e-4 => |_, r| Cell::number(r.surface().and_then(|e| e.depth).map(|d| d.p99));
    "flip_own", "FLIP, own", "FLIP against a picture of 64 rays by the same method: of a mesh without what its triangles change", from 1e-6 => |_, r| Cell::number(r.flip_own.or(r.errors.flip));
    "flip_over_1_ray", "FLIP / 1 ray", "FLIP over that of one ray per pixel in the same picture and stage" => |c, r| {
        let one = Over::Exact.of(c.rows, r).and_then(|one| one.errors.flip);
        Cell::number(r.errors.flip.zip(one).map(|(a, b)| a / b))
    };
    "error_p999_px", "error, 99.9th percentile (pixels)", "errors in pixels, 99.9th percentile: of the depth along the ray over the size of a pixel there; in a pixel on the wrong side of a contour (of a silhouette, or of one solid before another) how far the contour has moved" => |_, r| pixels(r, |e| Cell::Number(e.p999));
    "contour_max_px", "farthest contour (pixels)", "the farthest that a contour has moved, pixels" => |_, r| pixels(r, |e| Cell::Number(e.contour_max));
    "contour_pixels", "pixels beyond a contour", "pixels on the wrong side of a contour" => |_, r| pixels(r, |e| Cell::count(e.moved));
    "pixels_hit", "pixels compared", "pixels that hit in either picture" => |_, r| pixels(r, |e| Cell::count(e.pixels));
    "within", "within", "whether the 99.9th percentile and the farthest contour are below the tolerance" => |_, r| within(r);
};

/// The content of a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Nothing.
    Empty,
    /// Words.
    Text(String),
    /// A number that is a count.
    Count(u64),
    /// A number.
    Number(f64),
    /// A share, shown in percent.
    Share(f64),
    /// A value with its interval.
    Known(Interval),
    /// A value whose interval is wider than the plan allows.
    Unresolved(Interval),
}

impl Cell {
    /// Its text in files.
    pub fn csv(&self) -> String {
        match self {
            Self::Empty => String::new(),
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Number(value) | Self::Share(value) => number(*value, 6),
            Self::Known(interval) | Self::Unresolved(interval) => number(interval.value, 6),
        }
    }

    /// Its text in tables.
    pub fn shown(&self) -> String {
        match self {
            Self::Empty => NO_VALUE.to_owned(),
            Self::Number(value) => number(*value, 3),
            Self::Share(share) => percent(*share),
            Self::Known(i) => match i.ends() {
                Some(ends) => format!("{} ({})", number(i.value, 3), range(ends)),
                None => number(i.value, 3),
            },
            Self::Unresolved(i) => format!("{}, not resolved", Self::Known(*i).shown()),
            Self::Text(_) | Self::Count(_) => self.csv(),
        }
    }

    /// The interval of its value, if it has one.
    pub(crate) fn interval(&self) -> Option<Interval> {
        match self {
            Self::Known(interval) | Self::Unresolved(interval) => Some(*interval),
            _ => None,
        }
    }

    /// The value, if it is a number.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Empty | Self::Text(_) => None,
            Self::Count(count) => Some(*count as f64),
            Self::Number(value) | Self::Share(value) => Some(*value),
            Self::Known(interval) | Self::Unresolved(interval) => Some(interval.value),
        }
    }

    pub(crate) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    pub(crate) fn number(value: impl Into<Option<f64>>) -> Self {
        value.into().map_or(Self::Empty, Self::Number)
    }

    fn count(count: impl Into<Option<usize>>) -> Self {
        count.into().map_or(Self::Empty, |n| Self::Count(n as u64))
    }

    fn name(text: Option<&str>) -> Self {
        text.map_or(Self::Empty, Self::text)
    }
}

/// Names of the columns of `results.csv`.
pub fn results() -> impl Iterator<Item = &'static str> {
    COLUMNS[..RESULTS].iter().map(|c| c.name)
}

/// `results.csv`: one record a row.
pub fn results_table(rows: &[Row], plan: &Plan, machine: &Machine, resolved: f64) -> Result<Table> {
    let rows: Vec<&Row> = rows.iter().collect();
    let context = Context::new(&rows, plan, machine, resolved);
    context.file(&rows, &results().collect::<Vec<_>>())
}

/// The column of this name.
pub fn named(name: &str) -> Result<&'static Column> {
    COLUMNS.iter().find(|c| c.name == name).ok_or_else(|| {
        let all: Vec<&str> = COLUMNS.iter().map(|c| c.name).collect();
        let message = format!("{name:?} is no column; give one of {}", all.join(", "));
        Error::new(ErrorKind::Content, message)
    })
}

impl<'a> Context<'a> {
    /// The sources of these rows' cells.
    pub fn new(rows: &'a [&'a Row], plan: &'a Plan, machine: &'a Machine, resolved: f64) -> Self {
        Self {
            rows,
            plan,
            styles: SeriesStyles::of(rows),
            device: &machine.device,
            driver: &machine.driver,
            resolved,
        }
    }

    /// How many pictures a ratio is over, in words; nothing where the run has one picture.
    pub fn over_pictures(&self, pictures: usize) -> String {
        match grouped(self.rows, |r| r.picture()).len() {
            1 => String::new(),
            _ => format!(" over {}", count(pictures, "picture")),
        }
    }

    /// The cell of a value with its interval.
    pub(crate) fn known(&self, value: Option<Interval>) -> Cell {
        match value {
            Some(i) if i.relative() <= self.resolved => Cell::Known(i),
            Some(i) => Cell::Unresolved(i),
            None => Cell::Empty,
        }
    }

    /// The RBM baseline that all times are put over, with its stage.
    pub(crate) fn baseline(&self) -> String {
        let stage = baseline_stage(self.rows.iter().copied());
        format!("the RBM baseline in the {} stage", stage.name())
    }

    /// The ends of an interval, and whether it is as narrow as the plan demands.
    pub(crate) fn ends(&self, i: &Interval) -> String {
        let wide = i.relative() > self.resolved;
        let wide = if wide { ", not resolved" } else { "" };
        i.ends()
            .map_or("unknown".to_owned(), |ends| range(ends) + wide)
    }

    /// The method's name, or the RBM baseline's: what a chart calls its line.
    pub(crate) fn line(&self, settings: &crate::plan::method::MethodSettings) -> String {
        match settings.method {
            _ if is_rbm_baseline(settings) => RBM_BASELINE.to_owned(),
            Method::Mesh { .. } => "mesh, segments x rings".to_owned(),
            Method::MeshWithin { .. } => "mesh, silhouettes within pixels".to_owned(),
            method => method.to_string(),
        }
    }

    /// A file's table of these columns: a record a row.
    pub fn file(&self, rows: &[&Row], names: &[impl AsRef<str>]) -> Result<Table> {
        // A number in each cell: an interval is two columns.
        fn split(name: &str) -> Vec<&str> {
            match name {
                "time_interval" => vec!["time_low_ms", "time_high_ms", "resolved"],
                name => vec![name],
            }
        }
        let names: Vec<&str> = names.iter().flat_map(|n| split(n.as_ref())).collect();
        self.table(rows, &names, |c| c.name, Cell::csv)
    }

    /// A page's table of these columns.
    pub fn page(&self, rows: &[&Row], names: &[impl AsRef<str>]) -> Result<Table> {
        self.table(rows, names, |c| c.heading, Cell::shown)
    }

    fn table(
        &self,
        rows: &[&Row],
        names: &[impl AsRef<str>],
        head: fn(&Column) -> &'static str,
        write: fn(&Cell) -> String,
    ) -> Result<Table> {
        let named = names.iter().map(|n| named(n.as_ref()));
        let columns = named.collect::<Result<Vec<&Column>>>()?;
        let record = |row: &&Row| {
            let cells = columns.iter().map(|c| (c.cell)(self, row));
            cells.map(|cell| write(&cell)).collect()
        };
        let records = rows.iter().map(record).collect();
        Ok(Table::new(columns.iter().map(|c| head(c)), records))
    }
}

#[cfg(test)]
pub(crate) mod tests;
