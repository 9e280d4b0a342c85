//! Times in proportion to those of other rows: which way is faster, and how sure that is.

use crate::measure::row::{Row, Sample};
use crate::plan::method::{Edges, Method, MethodSettings};
use crate::plan::{is_rbm_baseline, variant};
use revmap::settings::{DrawStage, Tolerance};
use revmap_figures::groups::grouped;
use revmap_figures::stats::{self, Interval};

/// The row that others are put in proportion to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Over {
    /// The RBM baseline in the same picture, of [`baseline_stage`]: one time for both stages.
    Baseline,
    /// The default search in the same picture and stage: exact, one ray per pixel.
    #[serde(alias = "1-ray")]
    Exact,
    /// The plan's first view drawn in the same way; of the floor, the default search.
    One,
    /// The least value of the form's parameter drawn in the same way.
    First,
    /// A mesh of the same picture in the fragment stage.
    Mesh,
    /// [`Method::OPPONENT`] of the same picture: the mesh that keeps silhouettes within 0.25 pixels.
    Opponent,
    /// The mesh of the same picture that keeps silhouettes within the row's own tolerance.
    Equal,
    /// The same way in the fragment stage. Only rows in the compute stage have one.
    Fragment,
    /// The fastest other search in the same picture and stage whose depth errors are below a texel
    /// (99th percentile). Only exact rows of the default search have one.
    Rival,
}

impl Over {
    /// The other row of a row. Of meshes the coarsest that errs no more in depth.
    pub fn of<'a>(self, rows: &[&'a Row], row: &Row) -> Option<&'a Row> {
        let rows = || rows.iter().copied();
        let same = |r: &Row| r.picture() == row.picture();
        let stage = |r: &Row| same(r) && r.settings.stage == row.settings.stage;
        let find = |wanted: &dyn Fn(&Row) -> bool| rows().find(|r| wanted(r) && r.time().is_some());
        match self {
            Self::Baseline => {
                let common = baseline_stage(rows());
                find(&|r| same(r) && is_rbm_baseline(&r.settings) && r.settings.stage == common)
            }
            Self::Exact => find(&|r| is_exact_default(r) && stage(r)),
            Self::One => {
                let mut like = row.settings;
                let floor = like.method == Method::Floor;
                like.method = if floor { Method::DEFAULT } else { like.method };
                find(&|r| r.view == 0 && row.view > 0 && r.settings == like)
            }
            Self::First => {
                let same = |r: &&Row| r.settings == row.settings && r.sweeps == row.sweeps;
                let valued = rows().filter(same).filter_map(|r| Some((r, r.value?)));
                valued.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(r, _)| r)
            }
            Self::Mesh => mesh_row(rows(), row, None),
            Self::Opponent => find(&|r| same(r) && is_plain(r, Method::OPPONENT)),
            Self::Equal => {
                let search = !row.settings.method.is_mesh();
                let tolerance = row.tolerance_px().filter(|t| search && *t > 0.0)?;
                let mesh = Method::mesh_within(tolerance).ok()?;
                find(&|r| same(r) && is_plain(r, mesh))
            }
            Self::Fragment => {
                let compute = row.settings.stage == DrawStage::Compute;
                let mut like = row.settings;
                like.stage = DrawStage::Fragment;
                find(&|r| compute && r.view == row.view && r.settings == like)
            }
            Self::Rival => {
                let search = |m: Method| m != Method::DEFAULT && m != Method::Floor && !m.is_mesh();
                let near = |r: &Row| r.errors.depth.is_some_and(|d| d.p99 <= 1.0);
                let own = |r: &&Row| search(r.settings.method) && stage(r) && near(r);
                let own = rows().filter(own);
                let timed = own.filter_map(|r| Some((r, r.time()?.value)));
                let fastest = timed.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(r, _)| r);
                fastest.filter(|_| is_exact_default(row))
            }
        }
    }
}

/// The stage of the one RBM baseline that all times of a run are put over: fragment, or compute in
/// a run that drew no baseline in the fragment stage.
pub fn baseline_stage<'a>(rows: impl IntoIterator<Item = &'a Row>) -> DrawStage {
    let baselines = rows.into_iter().filter(|r| is_rbm_baseline(&r.settings));
    let stages: Vec<DrawStage> = baselines.map(|r| r.settings.stage).collect();
    match stages.contains(&DrawStage::Compute) && !stages.contains(&DrawStage::Fragment) {
        true => DrawStage::Compute,
        false => DrawStage::Fragment,
    }
}

/// True for a method with one ray per pixel.
fn is_plain(row: &Row, method: Method) -> bool {
    (row.settings.method, row.settings.edges) == (method, Edges::OneRay)
}

/// True for the default search without tolerance, one ray per pixel.
fn is_exact_default(row: &Row) -> bool {
    let s = &row.settings;
    s.method == Method::DEFAULT && (s.tolerance, s.edges) == (Tolerance::EXACT, Edges::OneRay)
}

/// The row of a mesh that shows the same picture: of this one, or of the coarsest that errs no
/// more.
fn mesh_row<'a>(
    rows: impl Iterator<Item = &'a Row>,
    row: &Row,
    mesh: Option<Method>,
) -> Option<&'a Row> {
    let meshes = rows.filter(|r| r.settings.method.is_mesh() && r.picture() == row.picture());
    let own = meshes.filter(|r| match mesh {
        Some(mesh) => r.settings.method == mesh,
        None => errs_no_more(r, row),
    });
    let timed = own.filter(|r| r.time().is_some());
    timed.min_by_key(|r| (r.map_bytes, r.settings.method.quads()))
}

/// A way of drawing over other rows: all pictures of which both have a usable row.
#[derive(Clone, Debug)]
pub struct Ratio<'a> {
    /// The way, without its size.
    pub settings: MethodSettings,
    /// The mesh that it is put over; `None`: in each picture the coarsest that errs no more.
    pub mesh: Option<Method>,
    /// Time over the other's: the geometric mean over views and sizes, with its 95 % interval.
    pub time: Interval,
    /// The least and the greatest ratio of a single view and size.
    pub range: (f64, f64),
    /// Each row and the other one.
    pub pairs: Vec<(&'a Row, &'a Row)>,
}

impl Ratio<'_> {
    /// Missed and ghost pixels over the pixels hit, all pictures together.
    pub fn wrong(&self) -> f64 {
        let sum = |f: fn(&Row) -> usize| self.pairs.iter().map(|(a, _)| f(a)).sum::<usize>() as f64;
        sum(|r| r.errors.missed + r.errors.ghost) / sum(|r| r.errors.hits).max(1.0)
    }

    /// In how many pictures the other row errs no more in depth: there equals are compared.
    pub fn no_worse(&self) -> usize {
        let exact = |(row, other): &&(&Row, &Row)| errs_no_more(other, row);
        self.pairs.iter().filter(exact).count()
    }
}

/// Every way's ratio, those of the fragment stage first; over meshes those of the default
/// search alone, for each mesh and then for the coarsest that errs no more. Rows whose clocks
/// disagree count for nothing, and neither do pictures of which the other has no usable row.
pub fn over<'a>(rows: impl IntoIterator<Item = &'a Row>, over: Over) -> Vec<Ratio<'a>> {
    let rows: Vec<&Row> = rows.into_iter().collect();
    // The ways in the order in which they first appear, those of the fragment stage first.
    let mut ways = grouped(rows.iter().copied(), |r| variant(&r.settings));
    ways.sort_by_key(|(way, _)| way.stage == DrawStage::Compute);
    if over != Over::Mesh {
        let other = |row: &Row| over.of(&rows, row);
        let ways = ways.iter();
        let all = ways.filter_map(|(way, own)| of_way(way, own, None, other));
        return all.collect();
    }
    let meshes = ways.iter().map(|w| w.0.method).filter(|m| m.is_mesh());
    let mut rivals: Vec<Option<Method>> = meshes.map(Some).collect();
    if !rivals.is_empty() {
        rivals.push(None);
    }
    let ours = ways.iter().filter(|w| w.0.method == Method::DEFAULT);
    let pairs = ours.flat_map(|way| rivals.iter().map(move |mesh| (way, *mesh)));
    let ratios = pairs.filter_map(|((way, own), mesh)| {
        of_way(way, own, mesh, |row| {
            mesh_row(rows.iter().copied(), row, mesh)
        })
    });
    ratios.collect()
}

/// The geometric mean of the times of rows, ms, with its interval over the passes that all have.
pub fn mean_ms(rows: &[&Row]) -> Option<Interval> {
    let logs = |r: &&Row| r.pass_medians().into_iter().map(f64::ln).collect();
    stats::over_pictures(&rows.iter().map(logs).collect::<Vec<_>>())
}

/// True if the depth error of a row (99th percentile) is no more than that of another.
fn errs_no_more(row: &Row, other: &Row) -> bool {
    let p99 = |r: &Row| r.errors.depth.map(|d| d.p99);
    p99(row).zip(p99(other)).is_some_and(|(a, b)| a <= b)
}

/// A way over the row that `other` gives for each of its rows.
fn of_way<'a>(
    way: &MethodSettings,
    own: &[&'a Row],
    mesh: Option<Method>,
    other: impl Fn(&Row) -> Option<&'a Row>,
) -> Option<Ratio<'a>> {
    let own = own.iter().copied().filter(|r| r.time().is_some());
    let pairs: Vec<(&Row, &Row)> = own.filter_map(|row| Some((row, other(row)?))).collect();
    let passes = pairs.first()?.0.passes.len();
    let in_pass = |pass: usize| -> Vec<f64> {
        let logs = pairs.iter().filter_map(|(a, b)| paired(a, b, pass));
        logs.collect()
    };
    // A pass that was ended early holds fewer pictures and would compare others.
    let whole = |logs: &Vec<f64>| logs.len() == pairs.len();
    let all: Vec<Vec<f64>> = (0..passes).map(in_pass).filter(whole).collect();
    let of_picture = |k: usize| all.iter().map(|logs| logs[k]).collect();
    let logs: Vec<Vec<f64>> = (0..pairs.len()).map(of_picture).collect();
    let time = stats::over_pictures(&logs)?;
    let mean = |logs: &Vec<f64>| (logs.iter().sum::<f64>() / logs.len() as f64).exp();
    Some(Ratio {
        settings: *way,
        mesh,
        time,
        range: (logs.iter().map(mean)).fold((f64::INFINITY, 0.0), |(l, h), v| (l.min(v), h.max(v))),
        pairs,
    })
}

/// The time of a row above the floor of its picture and stage, ms: the floor at its tolerance, if
/// that was measured, else the exact one. `None` where the floor is not known, and of the floor
/// itself.
pub fn above_floor<'a>(rows: impl IntoIterator<Item = &'a Row>, row: &Row) -> Option<f64> {
    let key = |r: &Row| (r.picture(), r.settings.stage);
    let of_this = |r: &&Row| r.settings.method == Method::Floor && key(r) == key(row);
    let floors = rows.into_iter().filter(of_this);
    // The first of the least: that of the same tolerance, or the first of all.
    let floor = floors.min_by_key(|r| r.settings.tolerance != row.settings.tolerance)?;
    let above = row.time()?.value - floor.time()?.value;
    (row.settings.method != Method::Floor).then_some(above)
}

/// The time of `a` over that of `b`, drawn in turn; `None` where a clock cannot be trusted.
pub fn between(a: &Row, b: &Row) -> Option<Interval> {
    a.time().and(b.time())?;
    let passes = a.passes.len().min(b.passes.len());
    let logs = (0..passes).filter_map(|pass| paired(a, b, pass));
    stats::over_pictures(&[logs.collect()])
}

/// Logarithm of the median ratio of samples that were taken in the same round.
fn paired(a: &Row, b: &Row, pass: usize) -> Option<f64> {
    let (a, b) = (a.passes.get(pass)?, b.passes.get(pass)?);
    stats::log_ratio(a.iter().map(Sample::ms), b.iter().map(Sample::ms))
}

#[cfg(test)]
mod tests;
