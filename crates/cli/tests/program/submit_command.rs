//! `revmap submit` and `revmap bench --gather` as they are run: files, privacy, refusals.

use crate::run::{Bench, holds, lines};
use revmap_bench::compare::submission::Submission;
use revmap_bench::report::table::Table;
use std::path::Path;

const QUICK: &str = "submit --quick --size 160x120 -q -o";

/// Words that belong to a person or a machine, and paths: a slash that begins a word.
fn personal(text: &str, words: &[&str]) -> Vec<String> {
    let edge = |c: char| c.is_whitespace() || "\"'(),".contains(c);
    let all = text.split(edge).filter(|word| !word.is_empty());
    let known = |word: &&str| words.iter().any(|known| known.trim() == *word);
    let path = |word: &&str| word.starts_with(['/', '~', '\\']);
    all.filter(|word| known(word) || path(word))
        .map(str::to_owned)
        .collect()
}

#[test]
fn a_file_has_nothing_personal_and_says_so() {
    let bench = Bench::new();
    let mut command = bench.command(&format!("{QUICK} mine.toml"));
    let home = bench.path("planted-home");
    command
        .envs([("USER", "planted-user"), ("LOGNAME", "planted-user")])
        .envs([("HOSTNAME", "planted-host")])
        .env("HOME", &home)
        .env("XDG_CACHE_HOME", &home);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
    let text = bench.text("mine.toml");
    let second = text.lines().nth(1).unwrap();
    holds(second, &["# Nothing personal is in this file"]);
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let own = ["planted-user", "planted-host", "mine.toml", host.as_str()];
    assert_eq!(personal(&text, &own), [""; 0]);
    // The check itself finds a planted name, and a planted path.
    let planted = text.replace("processor = \"", "processor = \"of planted-user ");
    assert_eq!(personal(&planted, &own), ["planted-user"]);
    let planted = text.replace("system = \"", "system = \"/home/x ");
    assert_eq!(personal(&planted, &own), ["/home/x"]);
}

#[test]
fn submissions_are_gathered() {
    let bench = Bench::new();
    let said = bench.said(&format!("{QUICK} a.toml"));
    bench.done(&format!("{QUICK} b.toml"));
    let [a, b] = ["a.toml", "b.toml"].map(|file| Submission::load(&bench.path(file)).unwrap());
    assert_eq!(a.plan, "submit --quick");
    // Two searches and the baseline in both stages, one mesh.
    assert_eq!(a.pictures.len(), 7);
    holds(&said, &["a.toml: ", "7 pictures"]);
    let size = |one: &Submission| (one.size.clone(), one.device.clone());
    assert_eq!(size(&a), size(&b));
    // One device draws one picture, whatever it takes.
    let colors = |one: &Submission| -> Vec<String> {
        one.pictures.iter().map(|p| p.colors.clone()).collect()
    };
    assert_eq!(colors(&a), colors(&b));
    assert!(colors(&a).iter().all(|sum| sum.len() == 16));
    // The baseline errs, and so its picture is another.
    let of = |method: &str| a.pictures.iter().find(|p| p.method == method).unwrap();
    assert_ne!(of("exact").colors, of("RBM baseline").colors);
    assert!(of("exact").wrong < of("RBM baseline").wrong);

    let said = bench.said("bench --gather a.toml b.toml --out c");
    let report = Path::new("c").join("report.html");
    holds(&said, &[&format!("{}: 2 submissions", report.display())]);
    // Both have one device's name, so they are numbered. A column without values is left out: that of
    // a submission whose clocks disagree, beside one with lines.
    let no_line = a.lines.is_empty() && b.lines.is_empty();
    for (number, one) in [("(1)", &a), ("(2)", &b)] {
        let has_column = no_line || !one.lines.is_empty();
        assert_eq!(said.contains(number), has_column, "{number}: {said}");
    }
    let table = Table::load(&bench.path("c/results.csv")).unwrap();
    assert_eq!(table.records.len(), a.lines.len() + b.lines.len());
    bench.has(&["c/report.html"]);
    // A chart needs clocks that agree, and frames this small are easily timed wrongly.
    let drawn = bench.path("c/charts/devices.svg").exists();
    assert_eq!(drawn, a.lines.len() + b.lines.len() > 2, "{said}");
    refusals(&bench);
}

fn refusals(bench: &Bench) {
    let text = bench.text("a.toml");
    bench.file("changed.toml", text.replacen("wrong = 0", "wrong = 1", 1));
    bench.file("later.toml", text.replacen("format = 1", "format = 9", 1));
    bench.file("half.toml", &text[..text.len() / 2]);
    std::fs::create_dir(bench.path("taken")).unwrap();
    bench.file("taken/results.csv", "");
    bench.refuses(
        1,
        "submit -o nowhere/a.toml              | nowhere | --output
         bench --gather none.toml              | none.toml: cannot be read | revmap submit
         bench --gather a.toml changed.toml    | changed.toml: was changed | again
         bench --gather later.toml             | later.toml: has format 9, this program reads 1
         bench --gather half.toml              | half.toml: is no whole submission
         bench --gather scene.toml             | scene.toml: is no whole submission",
    );
    bench.refuses(
        2,
        "submit                                | --output
         submit -o a.txt                       | a.txt | .toml
         submit -o a.toml --size 0x0           | --size
         submit -o a.toml --device 99          | 99
         bench --gather a.toml a.toml          | a.toml | same submission
         bench --gather a.toml --compare a b   | --gather
         bench --gather a.toml --out taken     | taken | --overwrite",
    );
    // What was refused has changed nothing.
    assert_eq!(bench.read("a.toml"), text.as_bytes());
}
