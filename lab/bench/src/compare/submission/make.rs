//! A submission from a run.

use super::{Described, FORMAT, Line, OnePicture, OneShader, Pictures, Submission, figure, short};
use crate::measure::Measured;
use crate::measure::drawn::Drawn;
use crate::measure::machine::Machine;
use crate::measure::ratios::{Over, mean_ms, over};
use crate::measure::row::{Clocks, Row};
use crate::plan::Plan;
use crate::plan::view::Framing;
use crate::report::columns::Context;
use crate::report::exhibit::cell;
use revmap::error::Result;
use revmap::gpu::DeviceReport;

/// The submission of a run on the device of `report`. `plan_name` names the plan, `resolved` is the
/// plan's own.
pub fn make(
    (plan_name, plan): (&str, &Plan),
    measured: &Measured,
    (machine, report): (&Machine, &DeviceReport),
    pictures: &Pictures,
    shaders: Vec<OneShader>,
) -> Result<Submission> {
    let timed = timed(&measured.rows, report.kind);
    let rows: Vec<&Row> = timed.iter().collect();
    let context = Context::new(&rows, plan, machine, f64::INFINITY);
    let mut lines = Vec::new();
    let framings = [Framing::Whole, Framing::Close];
    let parts = framings.map(|f| {
        (
            f.name(),
            rows.iter().copied().filter(move |r| r.framing == f),
        )
    });
    let parts = parts.map(|(name, rows)| (name, rows.collect::<Vec<_>>()));
    lines.extend(lines_of("all", &context, &rows)?);
    if parts.iter().all(|(_, rows)| !rows.is_empty()) {
        for (name, rows) in &parts {
            lines.extend(lines_of(name, &context, rows)?);
        }
    }
    let told = |what: &str| {
        let found = machine.lines.iter().find(|(name, _)| *name == what);
        found.map(|(_, which)| which.clone()).unwrap_or_default()
    };
    let picture = |row: &Row| OnePicture {
        scene: row.scene.clone(),
        method: context.styles.way(&row.settings),
        stage: row.settings.stage.name().to_owned(),
        gpu_ms: row.typical(|s| s.gpu_ms).map(short),
        frame_ms: row.typical(|s| Some(s.frame_ms)).map_or(f64::NAN, short),
        wrong: row.surface().map_or(0, |e| e.missed + e.ghost),
        depth_p99: row.surface().and_then(|e| e.depth).map(|d| short(d.p99)),
        colors: pictures.of(row.view, &row.settings),
    };
    Ok(Submission {
        format: FORMAT,
        program: told("program"),
        plan: plan_name.to_owned(),
        date: machine.date.chars().take("2026-01-31".len()).collect(),
        clock: clock(&measured.rows, report.kind).to_owned(),
        drawn: Drawn::of(plan).digests(),
        size: rows.first().map(|r| r.size()).unwrap_or_default(),
        device: Described {
            name: report.name.clone(),
            kind: report.kind.to_owned(),
            driver: report.driver.clone(),
            vulkan: report.api_version.clone(),
            processor: told("processor"),
            system: told("system"),
        },
        lines,
        pictures: measured.rows.iter().map(picture).collect(),
        shaders,
    })
}

/// The clock by which lines are timed.
fn clock(rows: &[Row], kind: &str) -> &'static str {
    match (rows.iter().all(|r| r.clocks() == Clocks::Wall), kind) {
        (true, _) => "wall",
        (false, "cpu") => "device, where the wall clock agrees",
        (false, _) => "device",
    }
}

/// The rows as they are timed for lines. A frame of a GPU may be as short as its submission, which the
/// wall clock holds too. There the device's clock counts alone. A software device's clock counts
/// only where the wall clock agrees: such clocks were wrong before.
fn timed(rows: &[Row], kind: &str) -> Vec<Row> {
    let mut rows = rows.to_vec();
    if kind != "cpu" {
        let samples = rows
            .iter_mut()
            .flat_map(|row| row.passes.iter_mut().flatten());
        samples.for_each(|s| s.frame_ms = s.ms());
    }
    rows
}

/// The lines of the main table over some rows.
fn lines_of(part: &str, context: &Context, rows: &[&Row]) -> Result<Vec<Line>> {
    let mut lines = Vec::new();
    for ratio in over(rows.iter().copied(), Over::Baseline) {
        let own: Vec<&Row> = ratio.pairs.iter().map(|(row, _)| *row).collect();
        let Some(time) = mean_ms(&own) else { continue };
        let value = |name: &str| -> Result<Option<f64>> {
            let cell = cell(context, rows, (Over::Baseline, &ratio), name)?;
            Ok(cell.value().map(short))
        };
        lines.push(Line {
            part: part.to_owned(),
            method: context.styles.way(&ratio.settings),
            stage: ratio.settings.stage.name().to_owned(),
            pictures: ratio.pairs.len(),
            time_ms: figure(time),
            ratio: figure(ratio.time),
            wrong: value("total wrong")?,
            depth_p99: value("mean depth_p99_texels")?,
            worst_depth_p99: value("worst depth_p99_texels")?,
        });
    }
    Ok(lines)
}
