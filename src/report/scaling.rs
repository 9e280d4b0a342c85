//! How time grows: with pixels, with solids, with rows of the map; each with the exponent of a power law.

use super::chapters;
use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::folder::{keep_figure, write_text};
use super::looks::Looks;
use super::machine::Machine;
use super::measure::Measured;
use super::names::{number, stage};
use super::page::Page;
use super::plan::{Plan, papers_loop, variant};
use super::row::Row;
use super::stats::{self, Interval, PowerLaw};
use super::suite::{self, Extent};
use super::sweep::has_rows;
use super::text;
use super::view::View;
use crate::error::{Error, Result, Stage};
use crate::scene::Placement;
use crate::settings::{DrawStage, Settings, Solver};
use glam::DVec3;
use std::path::Path;

/// What is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Pixels of the picture.
    Pixels,
    /// Copies of a solid.
    Solids,
    /// Rows of the shape map.
    Rows,
}

impl Quantity {
    /// All.
    pub const ALL: [Self; 3] = [Self::Pixels, Self::Solids, Self::Rows];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels",
            Self::Solids => "solids",
            Self::Rows => "rows of the map",
        }
    }

    /// What stays the same while it grows.
    fn setting(self) -> &'static str {
        match self {
            Self::Pixels => {
                "One solid that fills nine tenths of the picture's height, in pictures of growing size."
            }
            Self::Solids => {
                "A square field of copies at 800x600, seen from above so that the field always fills the picture: the pixels covered stay about the same while the copies grow smaller \
                 and more. Meshes keep their tessellation, and are drawn as long as all copies together have at most 8 million quads."
            }
            Self::Rows => {
                "One solid at 800x600, its map of more and more rows; searches that read no map are not in it."
            }
        }
    }
}

/// Sizes of pictures.
const SIZES: [(u32, u32); 5] = [
    (320, 240),
    (640, 480),
    (1280, 720),
    (1920, 1080),
    (3840, 2160),
];
/// Numbers of copies.
const COPIES: [u32; 5] = [1, 10, 100, 1000, 10_000];
/// Rows of maps.
const ROWS: [u32; 7] = [64, 128, 256, 512, 1024, 2048, 4096];
/// Meshes measured where none is named: one for solids that fill the picture, one for solids of some ten pixels.
pub const MESHES: [(u32, u32); 2] = [(16, 32), (64, 128)];
/// Most quads of all copies of a mesh: beyond, a frame takes many seconds.
const MOST_QUADS: u64 = 1 << 23;
/// The size at which solids and rows grow.
const STILL: (u32, u32) = (800, 600);

/// How many sizes, numbers and rows are taken: the first so many of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ranges {
    /// Of the sizes.
    pub sizes: usize,
    /// Of the numbers of copies.
    pub copies: usize,
    /// Of the rows.
    pub rows: usize,
}

impl Ranges {
    /// All.
    pub const ALL: Self = Self {
        sizes: SIZES.len(),
        copies: COPIES.len(),
        rows: ROWS.len(),
    };
    /// A look.
    pub const QUICK: Self = Self {
        sizes: 3,
        copies: 3,
        rows: 4,
    };
}

/// The plan: every stage and search over each of the quantities, the papers' loop among them.
///
/// # Errors
/// Of the solid that the program carries.
pub fn plan(stages: &[DrawStage], solvers: &[Solver], ranges: Ranges) -> Result<Plan> {
    let one = suite::views(Extent::One, &[25.0])?
        .into_iter()
        .next()
        .ok_or_else(|| {
            Error::new(
                Stage::Report,
                "the program carries no solid; build it with the feature `scene-file`",
            )
        })?;
    let copies = &COPIES[..ranges.copies.min(COPIES.len())];
    let mut views = vec![one.clone()];
    views.extend(copies.iter().map(|&n| field(&one, n)));
    let mut plan = Plan {
        views,
        cases: Vec::new(),
        mixed: false,
    };
    for &stage in stages {
        let base = Settings {
            stage,
            planes: crate::settings::Planes::Color,
            ..Settings::default()
        };
        let mut ways: Vec<Settings> = solvers
            .iter()
            .map(|&solver| Settings { solver, ..base })
            .collect();
        ways.push(papers_loop(&one, &base));
        let sized = |s: &Settings, (width, height): (u32, u32)| Settings {
            width,
            height,
            ..*s
        };
        // A mesh is not drawn by compute, and has no map.
        ways.retain(|w| !w.solver.is_mesh() || stage == DrawStage::Fragment);
        for way in &ways {
            for &size in SIZES.iter().take(ranges.sizes) {
                plan.add(0, sized(way, size));
            }
            for &rows in ROWS.iter().take(ranges.rows) {
                if !(way.solver.reads_map() || has_rows(way.solver)) {
                    continue;
                }
                plan.add(
                    0,
                    Settings {
                        map_rows: Some(rows),
                        ..sized(way, STILL)
                    },
                );
            }
            for (view, &count) in copies.iter().enumerate() {
                if way.solver.quads() * u64::from(count) <= MOST_QUADS {
                    plan.add(view + 1, sized(way, STILL));
                }
            }
        }
    }
    Ok(plan)
}

/// `count` copies on a square field one unit wide, seen whole.
fn field(one: &View, count: u32) -> View {
    let mut view = one.clone();
    let side = f64::from(count).sqrt().ceil();
    for object in &mut view.scene.objects {
        let scale = 1.0 / (2.0 * object.profile.radius * side);
        let place = |k: u32| {
            let (x, y) = (f64::from(k) % side, (f64::from(k) / side).floor());
            Placement {
                position: DVec3::new((x + 0.5) / side, (y + 0.5) / side, 0.0),
                scale: DVec3::splat(scale),
                ..Placement::default()
            }
        };
        object.instances = (0..count).map(place).collect();
    }
    view.name = format!("{}-x{count}", one.name);
    view.framed(50.0)
}

/// The value of a quantity in a row, if the row is part of that sweep.
#[must_use]
pub fn value(row: &Row, quantity: Quantity) -> Option<f64> {
    let s = &row.settings;
    let plain = row.view == 0 && s.map_rows.is_none();
    match quantity {
        Quantity::Pixels => plain.then(|| f64::from(s.width) * f64::from(s.height)),
        Quantity::Solids => (row.view > 0).then_some(row.solids as f64),
        Quantity::Rows => s.map_rows.map(f64::from),
    }
}

/// A way of drawing over a quantity.
#[derive(Clone, Debug)]
pub struct Growth {
    /// The way, without what is varied.
    pub way: Settings,
    /// `(quantity, ms)`, growing.
    pub points: Vec<(f64, f64)>,
    /// The medians of each pass, point by point.
    passes: Vec<Vec<f64>>,
    /// The law through all points; `None` of fewer than two.
    pub law: Option<PowerLaw>,
    /// Its exponent: the mean of the passes' own, with Student's interval over the passes. It tells how sure the exponent is, not how well a
    /// power law fits.
    pub exponent: Option<Interval>,
    /// The exponent between the last two points: what it comes to when fixed costs no longer count.
    pub last: Option<f64>,
}

/// Every way's growth with a quantity.
#[must_use]
pub fn growth(rows: &[Row], quantity: Quantity) -> Vec<Growth> {
    let mut all: Vec<Growth> = Vec::new();
    for row in rows {
        let (Some(x), Some(time)) = (value(row, quantity), row.time()) else {
            continue;
        };
        let way = Settings {
            map_rows: None,
            ..variant(&row.settings)
        };
        let index = all.iter().position(|g| g.way == way).unwrap_or_else(|| {
            all.push(Growth {
                way,
                points: Vec::new(),
                passes: Vec::new(),
                law: None,
                exponent: None,
                last: None,
            });
            all.len() - 1
        });
        let place = all[index].points.partition_point(|p| p.0 < x);
        all[index].points.insert(place, (x, time.value));
        all[index].passes.insert(place, row.pass_medians());
    }
    for one in &mut all {
        one.law = PowerLaw::fit(&one.points);
        let count = one.passes.iter().map(Vec::len).min().unwrap_or(0);
        let of_pass = |pass: usize| {
            let points: Vec<_> = one
                .points
                .iter()
                .zip(&one.passes)
                .map(|(p, times)| (p.0, times[pass]))
                .collect();
            PowerLaw::fit(&points).map(|law| law.exponent.value)
        };
        one.exponent = stats::mean(&(0..count).filter_map(of_pass).collect::<Vec<_>>());
        one.last = match one.points.as_slice() {
            [.., (x0, y0), (x1, y1)] => Some((y1 / y0).ln() / (x1 / x0).ln()),
            _ => None,
        };
    }
    all
}

fn records(all: &[Growth], looks: &Looks) -> Vec<Vec<String>> {
    let record = |g: &Growth| {
        let ends = |k: Option<&(f64, f64)>| k.map(|p| number(p.1, 3)).unwrap_or_default();
        vec![
            looks.way(&g.way),
            stage(g.way.stage).to_owned(),
            ends(g.points.first()),
            ends(g.points.last()),
            g.exponent
                .map(|e| text::interval(&e, 2))
                .unwrap_or_else(|| "–".into()),
            g.last.map(|e| number(e, 2)).unwrap_or_else(|| "–".into()),
        ]
    };
    all.iter().map(record).collect()
}

const HEADER: [&str; 6] = [
    "search",
    "stage",
    "ms, first",
    "ms, last",
    "exponent (95 % interval)",
    "exponent of the last step",
];

/// The exponents as text.
#[must_use]
pub fn as_text(rows: &[Row]) -> String {
    let looks = looks(rows);
    let mut out = String::new();
    for quantity in Quantity::ALL {
        let all = growth(rows, quantity);
        if all.is_empty() {
            continue;
        }
        out += &format!(
            "Time with {}: time = factor x {} ^ exponent\n",
            quantity.name(),
            quantity.name()
        );
        out += &text::table(
            &[
                vec![HEADER.map(str::to_owned).to_vec()],
                records(&all, &looks),
            ]
            .concat(),
        );
        out.push('\n');
    }
    out
}

fn looks(rows: &[Row]) -> Looks {
    let ways: Vec<Settings> = rows
        .iter()
        .map(|r| Settings {
            map_rows: None,
            ..variant(&r.settings)
        })
        .collect();
    Looks::new(&ways)
}

fn chart(all: &[Growth], quantity: Quantity, looks: &Looks) -> Figure {
    let (unit, label) = match quantity {
        Quantity::Pixels => (1e6, "pixels (millions)"),
        Quantity::Solids => (1.0, "solids (number)"),
        Quantity::Rows => (1.0, "rows of the map (number)"),
    };
    let series = all
        .iter()
        .map(|g| Series {
            name: looks.way(&g.way),
            style: looks.style(&g.way),
            points: g
                .points
                .iter()
                .map(|&(x, y)| Point {
                    x: x / unit,
                    y,
                    label: None,
                })
                .collect(),
            joined: false,
        })
        .collect();
    let guides = all
        .iter()
        .filter_map(|g| {
            let law = g.law?;
            let ends = [g.points.first()?, g.points.last()?];
            Some(Guide {
                name: String::new(),
                points: ends.map(|p| (p.0 / unit, law.at(p.0))).to_vec(),
                color: looks.style(&g.way).color,
                dash: looks.style(&g.way).dash,
                width: looks.style(&g.way).line(),
            })
        })
        .collect();
    let ticks = match quantity {
        Quantity::Rows => all.iter().flat_map(|g| &g.points).map(|p| p.0).collect(),
        Quantity::Pixels | Quantity::Solids => Vec::new(),
    };
    XyChart {
        title: format!("Time of a frame with {}", quantity.name()),
        x: Axis::log(label).at(ticks),
        y: Axis::log("time of a frame (ms)"),
        series,
        guides,
    }
    .figure()
}

/// Writes the page of growth.
///
/// # Errors
/// When a file cannot be written.
pub fn write(folder: &Path, plan: &Plan, measured: &Measured, machine: &Machine) -> Result<()> {
    let rows = &measured.rows;
    let looks = looks(rows);
    let mut page = Page::new("revmap: how time grows");
    chapters::begin(&mut page, machine, measured);
    for quantity in Quantity::ALL {
        let all = growth(rows, quantity);
        if all.is_empty() {
            continue;
        }
        page.chapter(&format!("With {}", quantity.name()));
        page.text(quantity.setting());
        let figure = chart(&all, quantity, &looks);
        keep_figure(
            folder,
            &format!("scaling-{}", quantity.name().replace(' ', "-")),
            &figure,
        )?;
        page.figure(
            &figure,
            "Markers are measured times, filled in the fragment stage and hollow in the compute stage; lines are the power laws fitted to them, thinner in the compute stage.",
        );
        page.table(&HEADER, &records(&all, &looks), &[0, 1]);
    }
    page.chapter("All rows");
    // Here the rows of maps tell rows apart.
    let ways: Vec<Settings> = rows.iter().map(|r| variant(&r.settings)).collect();
    chapters::row_table(&mut page, rows, &Looks::new(&ways));
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

#[cfg(all(test, feature = "scene-file"))]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::row::tests::row;
    use super::*;

    #[test]
    fn a_field_holds_its_copies_side_by_side() {
        let plan = plan(&[DrawStage::Compute], &[Solver::Circle], Ranges::ALL).unwrap();
        for (view, count) in plan.views[1..].iter().zip(COPIES) {
            view.scene.check().unwrap();
            assert_eq!(view.solids(), count as usize);
            let all = view.scene.objects[0].placements();
            let width = 2.0 * view.scene.objects[0].profile.radius * all[0].scale.x;
            for (k, a) in all.iter().enumerate().take(40) {
                assert!(
                    all[..k]
                        .iter()
                        .all(|b| (a.position - b.position).abs().max_element() > width * 0.999)
                );
            }
            assert!(
                all.iter()
                    .all(|p| p.position.max_element() <= 1.0 - width / 2.0 + 1e-9)
            );
        }
    }

    #[test]
    fn meshes_grow_with_pixels_and_solids_alone() {
        let solvers = MESHES.map(|(segments, rings)| Solver::Mesh { segments, rings });
        let stages = [DrawStage::Fragment, DrawStage::Compute];
        let plan = plan(&stages, &solvers, Ranges::ALL).unwrap();
        let of = |solver| {
            plan.cases
                .iter()
                .filter(move |c| c.settings.solver == solver)
        };
        for (solver, copies) in solvers.into_iter().zip([5, 4]) {
            assert!(of(solver).all(|c| c.settings.stage == DrawStage::Fragment));
            assert!(of(solver).all(|c| c.settings.map_rows.is_none()));
            assert_eq!(of(solver).filter(|c| c.view == 0).count(), SIZES.len());
            assert_eq!(of(solver).filter(|c| c.view > 0).count(), copies);
        }
    }

    #[test]
    fn planted_exponents_are_found() {
        let mut rows = Vec::new();
        for (w, h) in [(100, 100), (200, 200), (400, 400), (800, 800)] {
            let ms = 2.0 * (f64::from(w * h)).powf(0.9);
            let mut r = row(&[&[(None, ms)], &[(None, ms)]]);
            (r.settings.width, r.settings.height) = (w, h);
            rows.push(r);
        }
        let found = growth(&rows, Quantity::Pixels);
        assert_eq!(found.len(), 1);
        assert!(
            (found[0].law.unwrap().exponent.value - 0.9).abs() < 1e-9
                && (found[0].last.unwrap() - 0.9).abs() < 1e-9
        );
        assert!(
            growth(&rows, Quantity::Solids).is_empty() && growth(&rows, Quantity::Rows).is_empty()
        );
    }
}
