//! Searches of folders: examples, and a folder to start from.

use crate::run::{Bench, holds, lines};
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Solver};
use revmap_bench::plan::method::MethodSettings;
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_compare::{CompareOptions, Comparison, compare};
use revmap_files::SceneFile;
use revmap_searches::{CIRCLE, LINEAR, SECANT, folder};
use std::path::PathBuf;
use std::process::Command;

mod faults;

/// A search that is right.
const TOML: &str = "name = 'mine'\nabout = 'a test'\nsource = 'none'\nlicence = 'MIT'\nreads = 'map'\n\
    bevels = true\ninside = true\n[steps]\ndefault = 64\n";
const HEAD: &str =
    "uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)\n";
const BODY: &str = "{
    for (int i = 1; i < most_steps() && f > 1e-4 && s <= m.s_end; ++i) {
        s += f * m.inverse_speed;
        f = side * field(point_rz(m, s));
        ++steps;
    }
    return s > m.s_end ? LEFT : f < 1e-3 ? FOUND : EXHAUSTED;
}";

/// The last line of the body.
const END: &str = "return s > m.s_end ? LEFT : f < 1e-3 ? FOUND : EXHAUSTED;";

/// A text with a change, `FROM => TO`. `; ` stands for a line break, `END` for the last line of the
/// body.
fn changed(text: &str, change: &str) -> String {
    let decoded = |part: &str| part.replace("; ", "\n").replace("END", END);
    let (from, to) = change.split_once(" =>").unwrap();
    let (from, to) = (decoded(from), decoded(to.strip_prefix(' ').unwrap_or(to)));
    assert!(text.contains(&from), "{from}");
    text.replacen(&from, &to, 1)
}

/// A folder with the search `mine` and a cache of its own.
fn own_search(toml: &str, glsl: &str) -> Bench {
    let mut own = Bench::new();
    for folder in ["mine", "cache"] {
        std::fs::create_dir(own.path(folder)).unwrap();
    }
    own.file("mine/search.toml", toml);
    own.file("mine/search.glsl", glsl);
    own.set("XDG_CACHE_HOME", own.path("cache").to_str().unwrap());
    limit(&mut own, "20");
    own
}

/// Sets the seconds of a frame.
fn limit(own: &mut Bench, seconds: &str) {
    own.set("REVMAP_TIME_LIMIT", seconds);
}

fn good() -> Bench {
    own_search(TOML, &format!("{HEAD}{BODY}"))
}

/// A good folder with another last line of its GLSL.
fn ending(line: &str) -> Bench {
    own_search(TOML, &format!("{HEAD}{}", BODY.replace(END, line)))
}

/// Standard error of a picture by this search.
#[track_caller]
fn renders(own: &Bench, solver: &str) -> Vec<String> {
    let render = "render scene.toml --size 96x72 -o a.png --solver";
    lines(&own.done(&format!("{render} {solver}")))
}

const RENDER: &str = "render scene.toml --size 96x72 -o b.png --solver";

fn repository(path: &str) -> String {
    format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"))
}

/// The vase of the repository with these keys set.
fn vase(sets: &[&str]) -> Scene {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let mut file = SceneFile::open(repository("assets/scenes/vase.toml")).unwrap();
    file.scene(&sets).unwrap()
}

/// Errors of a picture of the vase, in texels of 512 rows.
fn errors(truth: &Frame, frame: &Frame) -> Comparison {
    compare(truth, frame, &CompareOptions::of(1.0 / 512.0)).unwrap()
}

/// A search of a quadric for each ray.
fn quadric_search(body: &str) -> String {
    format!(
        "uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)\n{{{body}}}\n"
    )
}

/// The description of a search that reads something else, without steps.
fn reading(what: &str) -> String {
    TOML.replace("'map'", what)
        .replace("[steps]\ndefault = 64\n", "")
}

/// The vase by a search, under the validation layers.
fn drawn(device: &Device, solver: Solver, stage: DrawStage, sets: &[&str]) -> Frame {
    let settings = MethodSettings::default().sized(160, 120);
    let methods = MethodDevice::new(device.clone()).unwrap();
    let settings = settings.by(solver).in_stage(stage);
    let frame = methods.draw(&vase(sets), &settings).unwrap();
    folder::check_frame(solver, &frame).unwrap();
    frame
}

const STAGES: [DrawStage; 2] = [DrawStage::Fragment, DrawStage::Compute];

#[test]
fn examples_draw_a_vase_as_the_reference_does() {
    let device = Device::open_validated(None).unwrap();
    for (sets, stage) in [&[][..], &["object.0.bevel=0.2"]].into_iter().zip(STAGES) {
        let settings = MethodSettings::default().sized(160, 120);
        let truth = revmap_reference::draw(&vase(sets), &(&settings).into(), &|_, _| {}).unwrap();
        let names = "interval over-relaxed over-relaxed:planar=1:omega=0.9 segment";
        for name in names.split(' ') {
            let solver = folder::load(&repository(&format!("examples/searches/{name}"))).unwrap();
            let frame = drawn(&device, solver, stage, sets);
            let errors = errors(&truth, &frame);
            println!("{name}, {}: {errors:?}", stage.name());
            let wrong = errors.missed + errors.ghost;
            assert!(wrong < errors.hits / 100, "{name}: {errors:?}");
            assert!(errors.depth.unwrap().p99 < 1.0, "{name}: {errors:?}");
            assert_ne!(frame.steps.iter().sum::<f32>(), 0.0);
        }
    }
    device.check().unwrap();
}

/// The steps of docs/your-own-search.md, with its own GLSL.
#[test]
fn the_page_leads_to_a_search_that_is_right() {
    let page = std::fs::read_to_string(repository("docs/your-own-search.md")).unwrap();
    let blocks = page.split("```glsl\n").skip(1);
    let blocks: Vec<&str> = blocks.map(|b| b.split("```").next().unwrap()).collect();
    let bench = Bench::new();
    bench.done("searches new mine");
    let template = bench.text("mine/search.glsl");
    // The page shows what the program prints.
    let said = bench.said("searches ./mine");
    for line in said.lines().filter(|line| !line.starts_with("  drawn")) {
        assert!(page.contains(&format!("\n{line}\n")), "{line}");
    }
    for (from, to) in [
        ("factor * f", "omega * f"),
        ("++steps;", "++steps"),
        ("uint search", "float search"),
    ] {
        bench.file("mine/search.glsl", template.replace(from, to));
        let said = lines(&bench.run("searches ./mine"));
        let said = said[0].trim_start_matches("revmap: ");
        assert!(page.contains(said), "{said}");
    }
    bench.file("mine/search.glsl", &template);
    let head = template.split("{\n").next().unwrap();
    let (hasty, loop_of) = (blocks[0], blocks[1]);
    let [from, to] = ["    for (int i", "        s -= gap"].map(|text| hasty.find(text).unwrap());
    let right = format!("{}{loop_of}{}", &hasty[..from], &hasty[to..]);
    let tried = |body: Option<&str>, factor: &str| {
        if let Some(body) = body {
            bench.file("mine/search.glsl", format!("{head}{{\n{body}}}\n"));
        }
        let said = bench.said(&format!("searches ./mine:factor={factor}"));
        let line = said
            .lines()
            .find(|l| l.contains("fragment, a vase"))
            .unwrap();
        let number = |before: &str| -> f64 {
            let words = line.split(before).nth(1).unwrap().split_whitespace();
            words.take(1).collect::<String>().parse().unwrap()
        };
        (number("vase: "), number("depth within "))
    };
    let [first, long, hasty, right] = [
        (None, "1"),
        (None, "1.6"),
        (Some(hasty), "1.6"),
        (Some(&*right), "1.6"),
    ]
    .map(|(b, f)| tried(b, f));
    println!("{first:?} {long:?} {hasty:?} {right:?}");
    assert!(first.0 < 60.0 && first.1 < 0.5);
    assert!(long.0 > 1000.0 && long.1 > 100.0);
    assert!(hasty.0 < 60.0 && hasty.1 > 5.0);
    assert!(right.0 < 60.0 && right.1 < 0.5);
}

/// Searches on the library's patches, and on a picture of solid texels.
#[test]
fn patches_and_binary_maps_are_read() {
    let patches = own_search(
        &reading("'patches'").replace("'mine'", "'tree'"),
        &quadric_search("return search_quadric(m, side, s, steps, quadric);"),
    );
    let binary = own_search(
        &TOML
            .replace("'map'", "'binary map'")
            .replace("'mine'", "'halved'"),
        &format!(
            "{HEAD}{{
    float before = 0.0;
    bool found = false;
    for (int i = 1; i < 200 && !found; ++i) {{
        s = m.s_end * float(i) / 200.0;
        found = solid(point_rz(m, s)) == (side > 0.0);
        before = found ? before : s;
        ++steps;
    }}
    for (int i = 0; i < 8; ++i) {{
        float middle = 0.5 * (before + s);
        bool within = solid(point_rz(m, middle)) == (side > 0.0);
        before = within ? before : middle;
        s = within ? middle : s;
    }}
    return found ? FOUND : LEFT;
}}"
        ),
    );
    let device = Device::open_validated(None).unwrap();
    let load = |own: &Bench| folder::load(own.path("mine").to_str().unwrap()).unwrap();
    let [patches_of, binary_of] = [load(&patches), load(&binary)];
    for (stage, sets) in STAGES.into_iter().zip([&[][..], &["object.0.bevel=0.2"]]) {
        let truth = drawn(&device, Solver::Quadric, stage, sets);
        let [exact, near] = [patches_of, binary_of]
            .map(|solver| errors(&truth, &drawn(&device, solver, stage, sets)));
        println!("{exact:?}\n{near:?}");
        assert_eq!(exact.missed + exact.ghost, 0);
        assert!(exact.depth.unwrap().max < 0.1);
        assert!(near.missed + near.ghost < near.hits / 30, "{near:?}");
        assert!(near.depth.unwrap().p99 < 6.0, "{near:?}");
    }
    device.check().unwrap();
}

#[cfg(unix)]
#[test]
fn the_example_with_a_table_draws_its_solid() {
    let python = Command::new("python3").arg("--version").output();
    if !python.is_ok_and(|output| output.status.success()) {
        println!("no python3: not tested");
        return;
    }
    let bench = Bench::new();
    let solver = repository("examples/searches/frusta");
    let render = "render scene.toml --size 160x120 -o";
    bench.done(&format!("{render} a.exr --solver {solver}"));
    bench.done(&format!("{render} b.exr --stage reference"));
    let said = bench.said("compare b.exr a.exr --json");
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let number = |key: &str| said[key].as_f64().unwrap();
    let wrong = number("missed") + number("ghost");
    let near = number("depth_p99_texels") < 0.01;
    assert!(near && wrong < number("hits") / 100.0, "{said}");
}

/// A search that the program compiles is drawn as one that was compiled with it.
#[test]
fn a_copy_of_a_built_in_search_draws_the_same_bits() {
    let device = Device::open_validated(None).unwrap();
    for (name, own) in [("circle", CIRCLE), ("linear", LINEAR), ("secant", SECANT)] {
        let path = repository(&format!("lab/searches/published/{name}"));
        let copy = folder::load(&path).unwrap();
        assert_eq!(copy.name(), format!("{name} (folder)"));
        for (sets, stage) in [
            (&[][..], STAGES[0]),
            (&["object.0.bevel=0.2"], STAGES[1]),
            (&["shadow=\"hard\""], STAGES[0]),
        ] {
            let [a, b] = [copy, own].map(|solver| {
                let frame = drawn(&device, solver, stage, sets);
                (frame.distance, frame.color, frame.steps)
            });
            assert_eq!(a, b, "{name}");
        }
    }
    device.check().unwrap();
}

#[test]
fn a_new_folder_draws_and_is_listed() {
    let bench = Bench::new();
    let said = bench.said("searches new fresh");
    assert!(said.contains("--solver ./fresh"), "{said}");
    let words = [
        "fresh: ",
        "factor = 1.0",
        "fragment, a vase",
        "compute, a vase",
        "files ",
    ];
    holds(&bench.said("searches fresh"), &words);
    bench.done("render scene.toml --size 64x48 -o a.png --solver ./fresh:factor=0.8");
    bench.done("animate scene.toml --frames 2 --size 64x48 --solver fresh --stage compute");
    let words = [
        "exact: ",
        "circle: ",
        "reads       table",
        "Dummer",
        "lab/searches/published",
    ];
    holds(&bench.said("searches"), &words);
    bench.refuses(
        2,
        "searches new fresh  | fresh | exists
         searches new circle | circle | search of revmap
         searches new Fresh! | name",
    );
}

/// Words are kept by their content; a damaged file is made anew, a changed GLSL gets others.
#[test]
fn compiled_words_are_kept() {
    let own = good();
    let kept = || {
        let folder = own.path("cache/revmap/searches");
        let entries = std::fs::read_dir(folder).unwrap();
        let files = entries.map(|e| e.unwrap().path());
        let files = files.map(|f| (f.clone(), std::fs::read(f).unwrap()));
        let mut files: Vec<(PathBuf, Vec<u8>)> = files.collect();
        files.sort();
        files
    };
    renders(&own, "mine");
    let first = kept();
    assert!(!first.is_empty());
    std::fs::write(&first[0].0, b"damaged").unwrap();
    let picture = own.read("a.png");
    renders(&own, "mine");
    assert_eq!(kept(), first);
    assert_eq!(own.read("a.png"), picture);
    let glsl = format!("{HEAD}{}", BODY.replace("1e-4", "2e-4"));
    own.file("mine/search.glsl", glsl);
    renders(&own, "mine");
    assert_eq!(kept().len(), 2 * first.len());
}
