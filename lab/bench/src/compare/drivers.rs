//! One table of several runs: a row for each technique and stage, a column for each driver.

use super::run::Run;
use super::scenes::{self, Scenes};
use crate::measure::stats;
use crate::plan::method::Method;
use crate::plan::names::{number, percent};
use revmap::error::{Error, ErrorKind, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// Techniques in the order of the table's rows.
const TECHNIQUES: [&str; 5] = ["revolution", "extended", "beveled", "chamfered", TEXTURED];
/// The technique that no offset shows.
const TEXTURED: &str = "textured";

/// The technique of a record: its view's, else its offset's; whether the box cuts it.
fn technique_of(scene: &str, technique: &str) -> String {
    let scene = scene.trim_end_matches(":close");
    if scene.ends_with(TEXTURED) {
        TEXTURED.to_owned()
    } else if scene.ends_with("-box") {
        format!("{technique}, cut by the box")
    } else {
        technique.to_owned()
    }
}

/// The place of a technique's row; one that is not known is last.
fn place_of(technique: &str) -> usize {
    let known = TECHNIQUES.iter().position(|t| technique.starts_with(t));
    known.unwrap_or(TECHNIQUES.len())
}

/// The figures of a cell.
#[derive(Default)]
struct Cell {
    /// Times over the RBM baseline's, by picture.
    times: Vec<f64>,
    /// Depth errors above 0, h/512.
    depths: Vec<f64>,
    wrong: f64,
    pixels: f64,
}

impl Cell {
    /// `0.45 (0.30 to 0.62); 0.008; 0.001 %`.
    fn text(&self) -> String {
        if self.times.is_empty() {
            return "–".to_owned();
        }
        let mean = |values: &[f64]| stats::geometric(values).map_or(f64::NAN, |i| i.value);
        let low = self.times.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.times.iter().copied().fold(0.0, f64::max);
        let depth = match self.depths.as_slice() {
            [] => "–".to_owned(),
            some => number(mean(some), 2),
        };
        let [time, low, high] = [mean(&self.times), low, high].map(|v| number(v, 2));
        let wrong = percent(self.wrong / self.pixels.max(1.0));
        format!("**{time}** ({low} to {high}); {depth}; {wrong}")
    }
}

/// The default search in every run, as a Markdown table: its time over that of the RBM baseline in
/// the same picture and stage (geometric mean, and the range over pictures), its depth error (99th
/// percentile in h/512, geometric mean), and its wrong pixels over those of the picture. Behind it a
/// warning about runs that do not say what they drew.
///
/// # Errors
/// Those of reading a run; [`ErrorKind::Content`] if two runs drew different scenes under one name.
pub fn markdown(folders: &[impl AsRef<Path>]) -> Result<(String, Option<String>)> {
    let runs = folders.iter().map(|folder| Run::load(folder.as_ref()));
    let runs = runs.collect::<Result<Vec<Run>>>()?;
    let warning = check(&runs, folders)?;
    // The key: the technique's place, its name and tolerance, and true for compute.
    let mut rows: BTreeMap<(usize, String, bool), Vec<Cell>> = BTreeMap::new();
    let mut drivers = Vec::new();
    for (column, run) in runs.iter().enumerate() {
        drivers.push(run.machine()[1].1.to_owned());
        for (row, record) in run.results.records.iter().enumerate() {
            let at = |name: &str| run.at(record, name);
            let ratio = run.over_baseline(row, at("stage"));
            let time = ratio.and_then(|passes| stats::geometric(&passes));
            let (true, Some(time)) = (at("solver") == Method::DEFAULT.name(), time) else {
                continue;
            };
            let technique = technique_of(at("scene"), at("technique"));
            let mut name = technique.clone();
            if !matches!(at("tolerance_px"), "" | "0") {
                name += &format!(", tolerance {} pixels", at("tolerance_px"));
            }
            let key = (place_of(&technique), name, at("stage") == "compute");
            let none = || folders.iter().map(|_| Cell::default()).collect();
            let cell = &mut rows.entry(key).or_insert_with(none)[column];
            let value = |name: &str| at(name).parse::<f64>().unwrap_or(0.0);
            cell.times.push(time.value);
            cell.wrong += value("missed") + value("ghost");
            cell.pixels += value("width") * value("height");
            let depth = value("depth_p99_texels");
            cell.depths.extend((depth > 0.0).then_some(depth));
        }
    }
    let mut out = format!("| technique | stage | {} |\n", drivers.join(" | "));
    out += &format!("|---|---|{}\n", "---|".repeat(drivers.len()));
    for ((_, name, compute), cells) in rows {
        let stage = if compute { "compute" } else { "fragment" };
        let cells: Vec<String> = cells.iter().map(Cell::text).collect();
        out += &format!("| {name} | {stage} | {} |\n", cells.join(" | "));
    }
    Ok((out, warning))
}

/// Refuses runs of different scenes; a warning names those that do not say what they drew.
fn check(runs: &[Run], folders: &[impl AsRef<Path>]) -> Result<Option<String>> {
    let all = || runs.iter().zip(folders);
    for (number, (new, folder)) in all().enumerate() {
        for (old, other) in all().take(number) {
            if let Some(told) = Scenes::of(old, new).told {
                let other = other.as_ref().display();
                let message =
                    format!("drew {told}, old being {other}; give runs of the same scenes");
                return Err(Error::new(ErrorKind::Content, message).in_file(folder.as_ref()));
            }
        }
    }
    let silent = all().filter(|(run, _)| run.drawn.is_none());
    let silent: Vec<String> = silent
        .map(|(_, folder)| folder.as_ref().display().to_string())
        .collect();
    Ok((!silent.is_empty()).then(|| scenes::unknown(&silent.join(", "))))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::tests::folder_of;
    use super::*;
    use crate::measure::drawn::{self, Drawn};
    use crate::measure::row::Row;
    use crate::measure::row::tests::{papers, timed};
    use crate::plan::Plan;
    use crate::plan::view::tests::spindle;
    use revmap::settings::DrawStage;

    /// A run of one driver: the default takes `ms`, the RBM baseline 20.
    fn run(driver: &str, ms: &[(&str, DrawStage, f64)]) -> tempfile::TempDir {
        let mut rows: Vec<Row> = Vec::new();
        for &(scene, stage, ms) in ms {
            let mut ours = timed(&[ms, ms]);
            ours.scene = scene.to_owned();
            ours.settings.stage = stage;
            ours.settings.method = Method::DEFAULT;
            ours.errors.missed = 48;
            let mut papers = papers(ours.clone());
            papers.passes = timed(&[20.0, 20.0]).passes;
            rows.extend([ours, papers]);
        }
        folder_of(&rows, "device", driver)
    }

    #[test]
    fn each_driver_has_a_column_and_each_technique_a_row() {
        let (fragment, compute) = (DrawStage::Fragment, DrawStage::Compute);
        let first = run(
            "one 1.2",
            &[
                ("vase-revolution", fragment, 5.0),
                ("pawn-revolution:close", fragment, 20.0),
                ("vase-textured", compute, 8.0),
                ("vase-e0.25-box", compute, 30.0),
            ],
        );
        let second = run("two", &[("vase-revolution", fragment, 40.0)]);
        let wanted = "\
| technique | stage | one 1.2 | two |
|---|---|---|---|
| revolution | fragment | **0.5** (0.25 to 1); –; 0.01 % | **2** (2 to 2); –; 0.01 % |
| revolution, cut by the box | compute | **1.5** (1.5 to 1.5); –; 0.01 % | – |
| textured | compute | **0.4** (0.4 to 0.4); –; 0.01 % | – |
";
        let (text, warning) = markdown(&[first.path(), second.path()]).unwrap();
        assert_eq!(text, wanted);
        assert!(warning.unwrap().starts_with("no drawn.toml in "));
        assert!(markdown(&[first.path().join("none")]).is_err());
    }

    #[test]
    fn runs_of_different_scenes_are_refused() {
        let vase = [("vase", DrawStage::Fragment, 5.0)];
        let runs = ["one", "two", "three"].map(|driver| run(driver, &vase));
        for (run, eye) in runs.iter().zip([2.0, 2.0, 2.5]) {
            let mut view = spindle();
            view.scene.camera.eye.x = eye;
            let text = Drawn::of(&Plan::new(vec![view])).text().unwrap();
            std::fs::write(run.path().join(drawn::FILE), text).unwrap();
        }
        let [one, two, three] = runs.each_ref().map(|run| run.path());
        assert_eq!(markdown(&[one, two]).unwrap().1, None);
        let error = markdown(&[one, two, three]).unwrap_err();
        assert_eq!(error.file.as_deref(), Some(three));
        let wanted = "drew different scenes as spindle: camera.eye (old [2.0, ";
        assert!(error.message.starts_with(wanted), "{error}");
    }
}
