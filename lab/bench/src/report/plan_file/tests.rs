#![allow(clippy::unwrap_used)]
use super::*;
use crate::plan::method::{Method, MethodSettings};
use crate::plan::view::Framing;
use crate::plan::view::tests::spindle;
use crate::plan::{Case, Lists, is_rbm_baseline, suite};
use revmap::maps::MapFormat;
use revmap::settings::{DrawStage, Solver};

const SOUND: &str = r#"about = "one"
title = "t"
show = ["ratios"]

[[views]]
name = "a"

[[measure]]
name = "m"
views = ["a"]
methods = ["exact"]
sizes = ["64x48"]
"#;

#[test]
fn every_plan_of_the_program_is_sound() {
    for (name, text) in embedded::ALL {
        for quick in [false, true] {
            let given = Overrides {
                quick,
                ..Overrides::default()
            };
            let mut file = embedded::plan(name).unwrap();
            file.views.retain(|v| v.copies.iter().all(|n| *n <= 10_000));
            file.apply(&given);
            for views in &mut file.views {
                views.copies.retain(|n| *n <= 100);
            }
            let plan = file.plan(&given).unwrap();
            assert!(!plan.cases.is_empty(), "{name}");
            for (i, view) in plan.views.iter().enumerate() {
                view.scene.check().unwrap();
                let mut others = plan.views[..i].iter();
                assert!(others.all(|v| v.name != view.name), "{}", view.name);
            }
            for (i, case) in plan.cases.iter().enumerate() {
                let same = |c: &Case| (c.view, c.settings) == (case.view, case.settings);
                assert!(!plan.cases[..i].iter().any(same), "{name}: twice");
            }
        }
        assert!(text.starts_with("about = "), "{name}");
    }
    let elevations = [0.0, 25.0, 60.0];
    let all = suite::views(&suite::Extent::ALL, &elevations).unwrap();
    assert_eq!((all.len(), all[1].name.as_str()), (33, "vase@25"));
}

/// Every column and entry that exhibits name is there; no exhibit is without a plan.
#[test]
fn every_exhibit_of_the_program_is_sound() {
    let plans = embedded::ALL.map(|(name, _)| embedded::plan(name).unwrap());
    let measures = plans.iter().flat_map(|p| &p.measure);
    let sweeps: Vec<&str> = measures.map(|m| m.name.as_str()).collect();
    for exhibit in exhibit::all(&[]).unwrap() {
        exhibit.check(&sweeps).unwrap();
        let shown = plans.iter().any(|p| p.show.contains(&exhibit.name));
        assert!(shown, "{}", exhibit.name);
    }
}

/// Each fault: what is replaced in a sound plan (`|` ends a line), by what, and parts of the message.
const FAULTS: &str = r#"
about = "one" => about = 1 => line 1, about & string
title = "t" => titel = "t" => line 2, titel & unknown field `titel`, expected one of `about`
title = "t"| => => line 1 & missing field `title`
title => title title => line 2 & expected
["exact"] => ["magic"] => line 11, methods & give one of linear
["exact"] => ["mesh:1x1"] => line 11, methods & at least 3 segments
["64x48"] => ["64"] => line 12, sizes & WIDTHxHEIGHT
["64x48"] => ["0x48"] => line 12, sizes & from 1 to 16384
sizes = ["64x48"] => stages = ["cpu"] => line 12, stages & give one of fragment, compute
sizes = ["64x48"] => map_sources = ["x"] => line 12, map_sources & binary, coverage, exact
sizes = ["64x48"] => map_formats = ["x"] => line 12, map_formats & rgba8, r16, r32
sizes = ["64x48"] => tolerances = [-1] => line 12, tolerances & tolerance
sizes = ["64x48"] => edges = ["2 rays"] => line 12, edges & 4 rays
sizes = ["64x48"] => size = ["64x48"] => line 12, size & unknown field `size`
name = "a" => name = "a"|solids = "some" => line 7, solids & one, three, upright, all
name = "a" => name = "a"|solids = ["ball"] => line 7, solids & give one of vase
name = "a" => name = "a"|framings = ["near"] => line 7, framings & whole, close
name = "a" => name = "a"|arrange = "ring" => line 7, arrange & `field`
["ratios"] => ["ratio"] => show & give one of stages, stages-by-size
views = ["a"] => views = ["b"] => views & the names of [[views]]; give one of a
[[measure]]|name = "m"|views = ["a"]|methods = ["exact"]|sizes = ["64x48"]| => measure = [] => measure
[[views]]|name = "a"| => [time]|minutes = 1|[[views]]|name = "a"| => line 6, minutes & `seconds`
[[views]] => [[exhibit]]|name = "e"|only = ["n"]|[[views]] => exhibit e & give one of m
[[views]] => [[exhibit]]|name = "e"|[[exhibit.table]]|columns = ["speed"]|[[views]] => exhibit e & no column; give one of scene
"#;

#[test]
fn faults_name_the_line_the_key_and_what_is_allowed() {
    for fault in FAULTS.trim().lines() {
        let parts: Vec<&str> = fault.split("=> ").collect();
        let [from, to] = [0, 1].map(|k: usize| parts[k].trim_end().replace('|', "\n"));
        let text = SOUND.replacen(&from, &to, 1);
        assert_ne!(text, SOUND, "{from}");
        let error = PlanFile::parse(&text).unwrap_err();
        let error = error.in_file("mine.toml").to_string();
        let one_line = error.starts_with("mine.toml: ") && !error.contains('\n');
        assert!(one_line, "{error}");
        for part in parts[2].split(" & ") {
            assert!(error.contains(part), "{part}: {error}");
        }
    }
    assert_eq!(FAULTS.trim().lines().count(), 24);
    PlanFile::parse(SOUND).unwrap();
    let error = PlanFile::load(Path::new("missing.toml")).unwrap_err();
    assert!(error.to_string().contains("cannot be read"));
}

fn cases(file: &mut PlanFile, given: &Overrides) -> Vec<MethodSettings> {
    file.apply(given);
    let cases = file.plan(given).unwrap().cases.into_iter();
    cases.map(|c| c.settings).collect()
}

#[test]
fn the_command_line_takes_the_place_of_lists() {
    let given = Overrides {
        scenes: vec![spindle()],
        methods: vec![Method::mesh(16, 32).unwrap(), Solver::Live.into()],
        lists: Lists {
            stages: vec![DrawStage::Fragment],
            sizes: vec![(32, 24), (16, 12)],
            ..Lists::default()
        },
        passes: Some(3),
        ..Overrides::default()
    };
    let mut file = embedded::plan("usual").unwrap();
    let all = cases(&mut file, &given);
    // Both named methods, the RBM baseline and the floor at both sizes; the plan's meshes are gone.
    let floors = usize::from(crate::plan::method::floor::is_available());
    assert_eq!(all.len(), 2 * (3 + floors));
    assert_eq!((file.time.passes, file.time.rounds), ((3, 3), (3, 20)));
    let fragment = |s: &MethodSettings| s.stage == DrawStage::Fragment;
    assert!(all.iter().all(|s| fragment(s) && s.width < 33));
    // Two framings of a scene from two elevations.
    let given = Overrides {
        elevations: vec![0.0, 30.0],
        framings: vec![Framing::Close, Framing::Whole],
        ..given
    };
    let mut file = embedded::plan("usual").unwrap();
    file.apply(&given);
    let plan = file.plan(&given).unwrap();
    let names: Vec<&str> = plan.views.iter().map(|v| v.name.as_str()).collect();
    let wanted = "spindle@0 spindle@0:close spindle@30 spindle@30:close";
    assert_eq!(names.join(" "), wanted);
}

#[test]
fn a_sweep_moves_one_axis_at_a_time() {
    let methods = ["circle", "quadric", "cone"].map(|m| m.parse::<Method>().unwrap());
    let given = Overrides {
        scenes: vec![spindle()],
        methods: methods.to_vec(),
        ..Overrides::default()
    };
    let mut file = embedded::plan("chart").unwrap();
    let all = cases(&mut file, &given);
    let of = |method: Method| {
        let own = |s: &&MethodSettings| s.method == method && !is_rbm_baseline(s);
        all.iter().filter(own).count()
    };
    // Steps in both stages, rows x sources and formats in one; rows of cones in both.
    assert_eq!(methods.map(of), [6 * 2 + 5 * 3 + 3, 2, 5 * 2]);
    // A list of bounds is combined with all others instead.
    let given = Overrides {
        lists: Lists {
            max_steps: vec![10, 20],
            map_formats: vec![MapFormat::R16, MapFormat::R32],
            ..Lists::default()
        },
        ..given
    };
    let mut file = embedded::plan("chart").unwrap();
    let all = cases(&mut file, &given);
    let count = |own: fn(&&MethodSettings) -> bool| all.iter().filter(own).count();
    assert_eq!(count(|s| s.max_steps == Some(10)), 2 * 2);
    assert_eq!(count(|s| s.method == Solver::Quadric), 2);
}

/// Every picture of the plan `sizes` has the default and its two rivals in both stages.
#[test]
fn the_default_has_its_rivals_in_every_picture() {
    let file = embedded::plan("sizes").unwrap();
    let plan = file.plan(&Overrides::default()).unwrap();
    assert_eq!((plan.views.len(), plan.cases.len()), (9, 9 * 5 * 3 * 2));
    for group in plan.groups() {
        let of = |k: &usize| plan.cases[*k].settings;
        let ways = group
            .iter()
            .map(|k| (of(k).method.to_string(), of(k).stage.name()));
        let mut ways: Vec<(String, &str)> = ways.collect();
        ways.sort();
        let methods = ["exact", "live", "quadric"];
        let both = |m: &str| ["compute", "fragment"].map(|stage| (m.to_owned(), stage));
        assert_eq!(ways, methods.map(both).concat());
    }
    let names: Vec<&str> = plan.views.iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names[..3], ["vase", "vase-hard", "vase-soft"]);
}

#[test]
fn the_command_line_limits_the_time() {
    let given = Overrides {
        max_seconds: Some(20.0),
        ..Overrides::default()
    };
    let mut file = embedded::plan("usual").unwrap();
    assert_eq!(file.time.limit().as_secs_f64(), 170.0);
    file.apply(&given);
    assert_eq!((file.time.seconds, file.time.limit), (20.0, Some(20.0)));
}

#[test]
fn meshes_grow_with_pixels_and_solids_alone() {
    let mut file = embedded::plan("scaling").unwrap();
    file.views.iter_mut().for_each(|v| v.copies.truncate(4));
    let given = Overrides::default();
    file.apply(&given);
    let plan = file.plan(&given).unwrap();
    for (method, copies) in [("mesh:16x32", 4), ("mesh:64x128", 4)] {
        let own = |c: &&Case| c.settings.method.to_string() == method;
        let of = || plan.cases.iter().filter(own);
        let plain = |s: MethodSettings| s.stage == DrawStage::Fragment && s.map_rows.is_none();
        assert!(of().all(|c| plain(c.settings)));
        assert_eq!(of().filter(|c| c.view == 0).count(), 5);
        assert_eq!(of().filter(|c| c.view > 0).count(), copies);
    }
    let rows = plan.sweeps.iter().position(|s| s == "rows").unwrap();
    let swept = plan.cases.iter().filter(|c| c.sweeps & (1 << rows) != 0);
    // Three searches and the RBM baseline in both stages.
    assert_eq!(swept.count(), 7 * 4 * 2);
}
