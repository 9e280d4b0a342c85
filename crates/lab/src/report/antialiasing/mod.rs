//! Anti-aliasing: how far pictures of one ray per pixel, of smoothed silhouettes, of several rays and
//! of meshes are from pictures of 64 rays, and what each costs.

mod drawers;

use super::folder::write_text;
use super::machine::Machine;
use super::names::number;
use super::page::Page;
use super::stats;
use super::suite::{Extent, views};
use super::table::Table;
use super::view::View;
use crate::compare::{PIXELS_PER_DEGREE, flip_map};
use crate::method::Method;
use crate::renderer::MethodDevice;
use drawers::Drawers;
use revmap::error::Result;
use revmap::frame::{Frame, write_png};
use revmap::settings::{DrawStage, Planes};
use std::path::Path;

/// Rays per pixel of the pictures that are compared with.
const TRUTH: u32 = 64;

/// How edges are treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// So many rays per pixel.
    Rays(u32),
    /// One ray, and silhouettes smoothed.
    Silhouettes,
    /// One ray, in a pass of four samples.
    Msaa,
    /// The mesh baseline, one sample.
    Mesh,
    /// The mesh baseline, four samples.
    MeshMsaa,
}

/// The mesh baseline.
const MESH: Method = Method::Mesh {
    segments: 128,
    rings: 256,
};

impl Way {
    /// What is compared, one ray first.
    pub const ALL: [Self; 7] = [
        Self::Rays(1),
        Self::Silhouettes,
        Self::Rays(4),
        Self::Rays(16),
        Self::Msaa,
        Self::Mesh,
        Self::MeshMsaa,
    ];

    /// Those of a stage: compute shaders do not rasterise.
    #[must_use]
    pub fn of(stage: DrawStage) -> &'static [Self] {
        match stage {
            DrawStage::Compute => &Self::ALL[..4],
            _ => &Self::ALL,
        }
    }

    fn name(self) -> String {
        match self {
            Self::Rays(1) => "1 ray".into(),
            Self::Rays(count) => format!("{count} rays"),
            Self::Silhouettes => "silhouettes".into(),
            Self::Msaa => "1 ray, MSAA 4".into(),
            Self::Mesh => MESH.to_string(),
            Self::MeshMsaa => format!("{MESH}, MSAA 4"),
        }
    }

    fn rays(self) -> u32 {
        match self {
            Self::Rays(count) => count,
            _ => 1,
        }
    }
}

/// One picture, in one way.
#[derive(Clone, Debug)]
pub struct Line {
    /// The solid.
    pub scene: String,
    /// Where rays are traced.
    pub stage: DrawStage,
    /// How edges are treated.
    pub way: Way,
    /// Mean FLIP against the picture of 64 rays.
    pub flip: f64,
    /// That against 64 rays of the same method: of a mesh without what its triangles change.
    pub own: f64,
    /// Milliseconds of drawing, and of reading beyond what one ray takes; median over the rounds.
    pub ms: f64,
    /// That over the time of one ray in the same round; median.
    pub ratio: f64,
}

/// A part of a picture, enlarged: by each of [`Way::of`] its stage, then by 64 rays.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The solid.
    pub scene: String,
    /// Where rays are traced.
    pub stage: DrawStage,
    /// The parts beside each other.
    pub frame: Frame,
}

/// Pixels of a sheet's part either way, and how often each is repeated.
const PART: usize = 40;
const ENLARGED: usize = 7;

impl Sheet {
    /// The part in which `flip`, of one ray, is largest.
    fn new(view: &View, stage: DrawStage, flip: &[f32], pictures: &[Frame]) -> Result<Self> {
        let width = pictures.first().map_or(0, |p| p.width as usize);
        let columns = (width / PART).max(1);
        let sum = |part: usize| {
            let first = part / columns * PART * width + part % columns * PART;
            let row = |y: usize| flip[first + y * width..][..PART].iter().sum::<f32>();
            (first, (0..PART).map(row).sum::<f32>())
        };
        let parts = columns * (flip.len() / (width * PART).max(1));
        let worst = (0..parts).map(sum).max_by(|a, b| a.1.total_cmp(&b.1));
        let first = worst.map_or(0, |w| w.0);
        let side = PART * ENLARGED;
        let mut frame = Frame::new((side * pictures.len()) as u32, side as u32, [0.0; 4])?;
        for (k, color) in frame.color.iter_mut().enumerate() {
            let (x, y) = (k % (side * pictures.len()), k / (side * pictures.len()));
            let from = first + y / ENLARGED * width + x % side / ENLARGED;
            *color = pictures[x / side].color[from];
        }
        Ok(Self {
            scene: view.name.clone(),
            stage,
            frame,
        })
    }
}

/// Draws and times the program's solids in every way, `rounds` times in turn; says to `progress`
/// how many of how many pictures are done.
///
/// # Errors
/// Of the device, and of the solids that the program carries.
pub fn measure(
    device: &MethodDevice,
    stages: &[DrawStage],
    extent: Extent,
    rounds: usize,
    progress: &dyn Fn(usize, usize),
) -> Result<(Vec<Line>, Vec<Sheet>)> {
    let views = views(extent, &[25.0])?;
    let (mut lines, mut sheets) = (Vec::new(), Vec::new());
    for (number, view) in views.iter().enumerate() {
        for (k, &stage) in stages.iter().enumerate() {
            progress(number * stages.len() + k, views.len() * stages.len());
            let (more, sheet) = one(device, view, stage, rounds)?;
            lines.extend(more);
            sheets.push(sheet);
        }
    }
    Ok((lines, sheets))
}

fn one(
    device: &MethodDevice,
    view: &View,
    stage: DrawStage,
    rounds: usize,
) -> Result<(Vec<Line>, Sheet)> {
    let mut pictures = Drawers::new(device, &view.scene, stage, Planes::All)?;
    let truth = pictures.rays(Way::Rays(1), TRUTH)?;
    let ways = Way::of(stage);
    let meshed = match ways.contains(&Way::Mesh) {
        true => Some(pictures.rays(Way::Mesh, TRUTH)?),
        false => None,
    };
    let mean = |map: &[f32]| map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len() as f64;
    let (mut drawn, mut flips, mut first) = (Vec::new(), Vec::new(), None);
    for &way in ways {
        let picture = pictures.picture(way)?;
        let map = flip_map(&truth, &picture, PIXELS_PER_DEGREE);
        let own = match (way, &meshed) {
            (Way::Mesh | Way::MeshMsaa, Some(truth)) => {
                mean(&flip_map(truth, &picture, PIXELS_PER_DEGREE))
            }
            _ => mean(&map),
        };
        flips.push([mean(&map), own]);
        first.get_or_insert(map);
        drawn.push(picture);
    }
    drawn.push(truth);
    let sheet = Sheet::new(view, stage, &first.unwrap_or_default(), &drawn)?;
    drop(drawn);
    let mut drawers = Drawers::new(device, &view.scene, stage, Planes::Color)?;
    for way in ways {
        drawers.time(*way)?;
    }
    let mut times = vec![Vec::with_capacity(rounds); ways.len()];
    for _ in 0..rounds {
        for (times, way) in times.iter_mut().zip(ways) {
            times.push(drawers.time(*way)?);
        }
    }
    let line = |k: usize| {
        let way = ways[k];
        // What a picture takes to be read is the same for all but what smoothing adds.
        let spent = |round: usize| match way {
            Way::Silhouettes => times[k][round][0] + times[k][round][1] - times[0][round][1],
            _ => times[k][round][0],
        };
        let all: Vec<f64> = (0..rounds).map(spent).collect();
        let ratios: Vec<f64> = (0..rounds).map(|r| all[r] / times[0][r][0]).collect();
        Line {
            scene: view.name.clone(),
            stage,
            way,
            flip: flips[k][0],
            own: flips[k][1],
            ms: stats::median(&all).unwrap_or(f64::NAN),
            ratio: stats::median(&ratios).unwrap_or(f64::NAN),
        }
    };
    Ok(((0..ways.len()).map(line).collect(), sheet))
}

/// FLIP over that of one ray in the same picture.
fn gain(lines: &[Line], line: &Line) -> f64 {
    let one = |l: &&Line| l.scene == line.scene && l.stage == line.stage && l.way == Way::Rays(1);
    lines
        .iter()
        .find(one)
        .map_or(f64::NAN, |l| line.flip / l.flip)
}

fn table(lines: &[Line]) -> Table {
    let header = [
        "scene",
        "stage",
        "way",
        "flip",
        "flip_own",
        "flip_over_1_ray",
        "time_ms",
        "time_over_1_ray",
    ];
    let record = |line: &Line| {
        vec![
            line.scene.clone(),
            line.stage.name().to_owned(),
            line.way.name(),
            number(line.flip, 3),
            number(line.own, 3),
            number(gain(lines, line), 3),
            number(line.ms, 3),
            number(line.ratio, 3),
        ]
    };
    Table::new(header, lines.iter().map(record).collect())
}

/// Geometric means over the pictures of a stage.
fn means(lines: &[Line]) -> Table {
    let mut records = Vec::new();
    for of in [DrawStage::Fragment, DrawStage::Compute] {
        for &way in Way::of(of) {
            let at: Vec<&Line> = lines
                .iter()
                .filter(|l| l.stage == of && l.way == way)
                .collect();
            let mean = |value: &dyn Fn(&Line) -> f64| {
                let values: Vec<f64> = at.iter().map(|l| value(l)).collect();
                let mean = stats::geometric(&values).map(|m| m.value);
                mean.map(|m| number(m, 3)).unwrap_or_default()
            };
            if !at.is_empty() {
                records.push(vec![
                    of.name().to_owned(),
                    way.name(),
                    mean(&|l| l.flip),
                    mean(&|l| l.own),
                    mean(&|l| gain(lines, l)),
                    mean(&|l| l.ratio),
                ]);
            }
        }
    }
    let header = [
        "stage",
        "way",
        "FLIP",
        "FLIP, own",
        "FLIP / 1 ray",
        "time / 1 ray",
    ];
    Table::new(header, records)
}

/// All tables as text.
#[must_use]
pub fn as_text(lines: &[Line]) -> String {
    table(lines).aligned() + "\nGeometric means over the pictures:\n" + &means(lines).aligned()
}

/// Writes `antialiasing.csv`, the sheets as pictures, and the page.
///
/// # Errors
/// When a file cannot be written.
pub fn write(
    folder: &Path,
    lines: &[Line],
    sheets: &[Sheet],
    rounds: usize,
    machine: &Machine,
) -> Result<()> {
    write_text(&folder.join("antialiasing.csv"), &table(lines).csv())?;
    for sheet in sheets {
        let name = format!("antialiasing-{}-{}.png", sheet.scene, sheet.stage.name());
        write_png(&sheet.frame, folder.join(name))?;
    }
    let mut page = Page::new("revmap: anti-aliasing");
    page.facts(&machine.lines());
    page.chapter("Geometric means over the pictures");
    page.text(&format!(
        "FLIP is the mean over all pixels, against a picture of {TRUTH} rays per pixel by the same \
         search, all in floats. Times are of pictures of colour alone and count from submission to \
         completion, medians of {rounds} rounds in which all ways are drawn in turn. MSAA 4 is a \
         pass of four samples per pixel that is resolved: of the search as in a host's pass, and \
         of the mesh baseline. A mesh shows smooth normals and no exact solid: FLIP, own compares \
         it with 64 rays of the mesh. Of smoothed silhouettes reading back counts, too, by what it \
         takes longer than of one ray: there they are smoothed. Several rays are as many pictures; \
         adding them up is not counted.",
    ));
    page.table(&means(lines), &[0, 1]);
    page.chapter("Every picture");
    page.text(
        "The pictures beside this page (antialiasing-SCENE-STAGE.png) show where one ray is worst, \
         enlarged, in the order of the rows, then by 64 rays.",
    );
    page.table(&table(lines), &[0, 1, 2]);
    write_text(&folder.join("report.html"), &page.html())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn planted_gains_are_told() {
        let line = |scene: &str, way, flip, ratio| Line {
            scene: scene.into(),
            stage: DrawStage::Compute,
            way,
            flip,
            own: flip,
            ms: 3.0,
            ratio,
        };
        let lines = [
            line("a", Way::Rays(1), 0.004, 1.0),
            line("a", Way::Silhouettes, 0.001, 1.2),
            line("b", Way::Rays(1), 0.0004, 1.0),
            line("b", Way::Silhouettes, 0.0004, 1.25),
        ];
        let found = table(&lines);
        let gain = found.column("flip_over_1_ray").unwrap();
        let told = |row: usize| found.records[row][gain].as_str();
        assert_eq!(
            [told(0), told(1), told(2), told(3)],
            ["1", "0.25", "1", "1"]
        );
        let means = means(&lines);
        assert_eq!(means.records.len(), 2);
        assert_eq!(
            means.records[1][1..],
            ["silhouettes", "0.000632", "0.000632", "0.5", "1.22"]
        );
    }
}
