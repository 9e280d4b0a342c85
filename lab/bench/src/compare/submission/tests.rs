#![allow(clippy::unwrap_used)]
use super::*;
use crate::measure::Measured;
use crate::measure::machine::Machine;
use crate::measure::ratios::{Over, over};
use crate::measure::row::Row;
use crate::measure::row::tests::{papers, row};
use crate::plan::Plan;
use crate::plan::method::Method;
use crate::plan::view::tests::spindle;
use crate::report::columns::tests::with_context;
use revmap::gpu::DeviceReport;
use std::time::Duration;

/// The default search in 5 ms by the device's clock, the RBM baseline in 10 ms. The wall clock
/// reads `wait` ms more.
fn rows(wait: f64) -> Vec<Row> {
    let of = |ms: f64| {
        let pass = [(Some(ms), ms + wait), (Some(1.02 * ms), 1.02 * ms + wait)];
        row(&[&pass, &pass, &pass])
    };
    let mut ours = of(5.0);
    ours.settings.method = Method::DEFAULT;
    (ours.errors.hits, ours.errors.missed) = (1000, 3);
    vec![ours, papers(of(10.0))]
}

fn made(device: &str, kind: &'static str, wait: f64) -> Submission {
    let measured = Measured {
        rows: rows(wait),
        left_out: Vec::new(),
        interrupted: false,
        took: Duration::ZERO,
    };
    let report = DeviceReport {
        index: 0,
        name: device.to_owned(),
        kind,
        driver: "driver 1.2".to_owned(),
        api_version: "1.3.0".to_owned(),
        uses: Vec::new(),
        missing: Vec::new(),
        preferred: true,
    };
    let machine = Machine::here(device, kind, &report.driver, "0.1.0", "revmap submit");
    let shader = OneShader {
        solver: "exact".to_owned(),
        stage: "compute".to_owned(),
        path: "tiles".to_owned(),
        shader: "compute".to_owned(),
        subgroup_size: 64,
        statistics: [("VGPRs".to_owned(), 48.0), ("Code size".to_owned(), 9e3)].into(),
    };
    let plan = ("submit", &Plan::new(vec![spindle()]));
    let (of, pictures) = ((&machine, &report), Pictures::default());
    make(plan, &measured, of, &pictures, vec![shader]).unwrap()
}

fn file(folder: &tempfile::TempDir, name: &str, one: &Submission) -> std::path::PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, one.text().unwrap()).unwrap();
    path
}

#[test]
fn the_lines_are_the_tables() {
    let one = made("card", "cpu", 0.1);
    assert_eq!(one.lines.len(), 2);
    let ours = &one.lines[0];
    assert_eq!((&*ours.method, &*ours.stage), ("exact", "fragment"));
    assert!((ours.time_ms[0] - 5.05).abs() < 1e-9 && (ours.ratio[0] - 0.5).abs() < 1e-9);
    assert_eq!((ours.wrong, ours.pictures), (Some(0.003), 1));
    with_context(&rows(0.1), |context| {
        let ratios = over(context.rows.iter().copied(), Over::Baseline);
        assert_eq!(figure(ratios[0].time), ours.ratio);
    });
    assert_eq!(one.pictures.len(), 2);
    assert_eq!(one.pictures[0].gpu_ms, Some(5.05));
    assert_eq!(one.pictures[0].wrong, 3);
}

/// A GPU's frame may be as short as its submission. A software device's clock needs the other one.
#[test]
fn a_gpus_own_clock_counts_alone() {
    let gpu = made("card", "discrete", 8.0);
    assert_eq!((gpu.clock.as_str(), gpu.lines.len()), ("device", 2));
    assert!((gpu.lines[0].ratio[0] - 0.5).abs() < 1e-9);
    // Both clocks stay in the file.
    assert_eq!(gpu.pictures[0].gpu_ms, Some(5.05));
    assert!((gpu.pictures[0].frame_ms - 13.05).abs() < 1e-9);
    let software = made("card", "cpu", 8.0);
    assert!(software.lines.is_empty() && software.pictures.len() == 2);
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let one = made("a \"card\", 5 W", "cpu", 0.1);
    let text = one.text().unwrap();
    assert!(text.starts_with(HEAD));
    let (windows, ended) = (text.replace('\n', "\r\n"), format!("{text}\n\n"));
    for text in [&text, &windows, &ended] {
        assert_eq!(Submission::parse(text).unwrap(), one);
    }
    let lines = text.lines().filter(|l| l.starts_with("  { ")).count();
    let all = one.lines.len() + one.pictures.len() + one.shaders.len();
    assert_eq!(lines, all);
}

/// A planted change of every kind is found and named.
#[test]
fn files_that_cannot_count_are_refused() {
    let text = made("card", "cpu", 0.1).text().unwrap();
    let signed = |text: &str| {
        let end = text.rfind(SUM).unwrap();
        let sum = fnv1a_64(text[..end].bytes());
        format!("{}{SUM}\"{sum:016x}\"\n", &text[..end])
    };
    for (from, to, wanted) in [
        ("wrong = 0.003", "wrong = 0.001", "was changed"),
        ("checksum = \"", "checksum = \"0", "was changed"),
        ("checksum = ", "sum = ", "last line"),
        ("format = 1", "format = 2", "has format 2, this program"),
        ("format = 1", "version = 1", "has format none"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        let error = Submission::parse(&changed).unwrap_err();
        assert_eq!(error.kind, ErrorKind::File);
        assert!(error.to_string().contains(wanted), "{error}");
    }
    for (from, to, wanted) in [
        ("plan = ", "host = \"x\"\nplan = ", "unknown field `host`"),
        ("date = ", "day = ", "unknown field `day`"),
        ("device = {", "device = ", "damaged"),
    ] {
        let error = Submission::parse(&signed(&text.replacen(from, to, 1))).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
        assert!(!error.to_string().contains('\n'), "{error}");
    }
    for part in [&text[..text.len() / 2], "", "x"] {
        assert!(Submission::parse(part).is_err());
    }
}

#[test]
fn devices_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let mut second = made("card", "cpu", 0.1);
    second.lines[0].ratio = [0.7, 0.6, 0.8];
    second.pictures[0].colors = "ff".to_owned();
    let files = [
        file(&folder, "a.toml", &made("card", "cpu", 0.1)),
        file(&folder, "b.toml", &second),
        file(&folder, "c.toml", &made("other", "discrete", 0.1)),
    ];
    let all = gather::load(&files).unwrap();
    let labels: Vec<&str> = all.iter().map(|one| one.label.as_str()).collect();
    assert_eq!(labels, ["card 1.2 (1)", "card 1.2 (2)", "other 1.2"]);
    assert_eq!(gather::warnings(&all), [""; 0]);
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let said = gather::write(&all, &out, None).unwrap();
    assert!(said.contains("0.7 (0.6 to 0.8)"), "{said}");
    let table = revmap_figures::table::Table::load(&out.join("results.csv")).unwrap();
    assert_eq!(table.records.len(), 6);
    assert_eq!(table.records[2][0], "card 1.2 (2)");
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    for wanted in ["2 of 2", "1 of 2", "VGPRs", "On other 1.2", "a.toml"] {
        assert!(page.contains(wanted), "{wanted}");
    }
    assert!(out.join("charts/devices.svg").exists());

    let twice = gather::load(&[files[0].clone(), files[0].clone()]);
    let error = twice.err().unwrap();
    assert_eq!(error.kind, ErrorKind::Usage);
    let wanted = "same submission as a.toml";
    assert!(error.to_string().contains(wanted), "{error}");

    // Submissions of other programs may have another suite: it is told, and so is a file that does
    // not say what it drew.
    let mut other = made("other", "cpu", 0.1);
    other.drawn.insert("spindle".to_owned(), "1".to_owned());
    other.drawn.insert("vase".to_owned(), "2".to_owned());
    let mut older = made("older", "cpu", 0.1);
    older.drawn.clear();
    let files = [
        files[0].clone(),
        file(&folder, "d.toml", &other),
        file(&folder, "e.toml", &older),
    ];
    let told = gather::warnings(&gather::load(&files).unwrap());
    let wanted = [
        "a.toml and d.toml drew different scenes as spindle: ",
        "no digests of scenes in e.toml",
    ];
    let starts = told
        .iter()
        .zip(wanted)
        .all(|(told, wanted)| told.starts_with(wanted));
    assert!(
        told.len() == 2 && starts && !told[0].contains("vase"),
        "{told:?}"
    );
}
