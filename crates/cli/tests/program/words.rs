//! What the program says to people, shells and programs.

use crate::run::{Bench, holds};
use serde_json::Value;

const COMMANDS: &str = "render animate mesh profile bake bench chart stability submit shaders devices compare view completions man";

/// Every example is a command line that the program takes.
#[test]
fn every_help_has_examples() {
    let bench = Bench::new();
    // Without the window there is nothing to try.
    let tried = |command: &&str| *command != "view" || cfg!(feature = "viewer");
    for command in COMMANDS.split(' ').filter(tried) {
        let help = bench.said(&format!("{command} --help"));
        let examples = help.split("Examples:\n").nth(1).unwrap();
        let lines = examples.lines().map(str::trim);
        let lines: Vec<_> = lines.filter(|l| !l.is_empty()).collect();
        assert!(lines.len() >= 2, "{command}: {lines:?}");
        holds(examples, &[&format!("revmap {command}")]);
        for line in lines {
            // With `--help` behind its options, each is read as far as it is sound.
            let words = line.split("revmap ").nth(1).unwrap();
            let words = words.split(['|', '>']).next().unwrap();
            bench.done(&format!("{} --help", words.trim()));
        }
    }
}

#[test]
fn shells_and_man_know_every_command() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = bench.said(&format!("completions {shell}"));
        for command in COMMANDS.split(' ') {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    holds(&bench.said("man"), &[".TH revmap", "render"]);
    bench.done("man -o pages");
    for command in COMMANDS.split(' ') {
        holds(
            &bench.text(&format!("pages/revmap-{command}.1")),
            &["Examples"],
        );
    }
}

#[test]
fn programs_get_json() {
    let bench = Bench::new();
    let json = |arguments: &str| -> Value { serde_json::from_str(&bench.said(arguments)).unwrap() };
    let devices = json("devices --json");
    let all = devices.as_array().unwrap();
    let preferred: Vec<_> = all.iter().filter(|d| d["preferred"] == true).collect();
    assert_eq!(preferred.len(), 1, "{devices}");
    let listed = bench.said("devices");
    let marked = listed.lines().filter(|l| l.contains("taken unless"));
    let marked: Vec<_> = marked.collect();
    assert_eq!(marked.len(), 1, "{listed}");
    holds(marked[0], &[preferred[0]["name"].as_str().unwrap()]);

    let drawn = json("render scene.toml -o a.exr --size 32x24 --json --solver live");
    assert_eq!(drawn["device"]["name"], preferred[0]["name"]);
    assert_eq!(
        (&drawn["width"], &drawn["solver"]),
        (&32.into(), &"live".into())
    );
    assert!(drawn["hits"].as_u64().unwrap() > 50 && drawn["steps_mean"].as_f64().unwrap() >= 1.0);
    assert!(drawn["map_bytes"].as_u64().unwrap() > 1000 && drawn["gpu_ms"].as_f64().unwrap() > 0.0);
    assert_eq!(drawn["warnings"], serde_json::json!([]));

    let truth = json("render scene.toml -o truth.exr --size 32x24 --json --stage reference");
    assert!(truth["device"].is_null() && truth["solver"].is_null());
    let found = json("compare truth.exr a.exr --json");
    assert_eq!(found["hits"], truth["hits"]);
    assert!(found["depth_p99_texels"].as_f64().unwrap() < 0.5 && found["flip"].is_f64());
    let said = bench.said("compare truth.exr a.exr");
    let units = [
        "texels of 0.001953 world units",
        "h/512 (height h = 1 world unit)",
    ];
    holds(&said, &units);
    assert!(found["first_difference"].is_string());
    let same = json("compare a.exr a.exr --json");
    assert!(same["first_difference"].is_null());
}
