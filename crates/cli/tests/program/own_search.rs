//! Searches of folders: examples, a folder to start from, and ways to write a bad one. A bad search
//! is named with what is wrong in it, and costs a run nothing but its own rows.

use crate::run::{Bench, lines, table};
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Solver};
use revmap_bench::plan::method::MethodSettings;
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_compare::{CompareOptions, compare};
use revmap_files::SceneFile;
use revmap_searches::{CIRCLE, LINEAR, SECANT, folder};
use std::path::PathBuf;
use std::process::{Command, Output};

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

/// A folder `mine` in a folder of its own, with a cache of its own.
struct Own {
    bench: Bench,
    cache: tempfile::TempDir,
    /// Seconds of a frame.
    limit: &'static str,
}

impl Own {
    fn new(toml: &str, glsl: &str) -> Self {
        let bench = Bench::new();
        std::fs::create_dir(bench.path("mine")).unwrap();
        bench.file("mine/search.toml", toml);
        bench.file("mine/search.glsl", glsl);
        let cache = tempfile::tempdir().unwrap();
        let limit = "20";
        Self {
            bench,
            cache,
            limit,
        }
    }

    fn good() -> Self {
        Self::new(TOML, &format!("{HEAD}{BODY}"))
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = self.bench.command(arguments);
        command.env("XDG_CACHE_HOME", self.cache.path());
        command.env("REVMAP_TIME_LIMIT", self.limit);
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Wants one line on standard error, with all of `words`.
    #[track_caller]
    fn refused(&self, arguments: &str, code: i32, words: &[&str]) {
        self.bench
            .refused_by(&mut self.command(arguments), code, words);
    }

    #[track_caller]
    fn renders(&self, solver: &str) -> Vec<String> {
        let output = self.run(&format!(
            "render scene.toml --size 96x72 -o a.png --solver {solver}"
        ));
        let said = lines(&output);
        assert_eq!(output.status.code(), Some(0), "{said:?}");
        said
    }
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
        for name in [
            "interval",
            "over-relaxed",
            "over-relaxed:planar=1:omega=0.9",
            "segment",
        ] {
            let solver = folder::load(&repository(&format!("examples/searches/{name}"))).unwrap();
            let frame = drawn(&device, solver, stage, sets);
            let errors = compare(&truth, &frame, &CompareOptions::of(1.0 / 512.0)).unwrap();
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
    let blocks: Vec<&str> = page
        .split("```glsl\n")
        .skip(1)
        .map(|b| b.split("```").next().unwrap())
        .collect();
    let bench = Bench::new();
    bench.done("searches new mine");
    let template = String::from_utf8(bench.read("mine/search.glsl")).unwrap();
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
        let said = lines(&bench.command("searches ./mine").output().unwrap());
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
            .unwrap()
            .to_owned();
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
    let patches = TOML
        .replace("'map'", "'patches'")
        .replace("[steps]\ndefault = 64\n", "");
    let patches = Own::new(
        &patches.replace("'mine'", "'tree'"),
        "uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
{
    return search_quadric(m, side, vec2(-1e30, 1e30), s, steps, quadric);
}",
    );
    let binary = Own::new(
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
    let load = |own: &Own| folder::load(own.bench.path("mine").to_str().unwrap()).unwrap();
    let [patches_of, binary_of] = [load(&patches), load(&binary)];
    for (stage, sets) in STAGES.into_iter().zip([&[][..], &["object.0.bevel=0.2"]]) {
        let truth = drawn(&device, Solver::Quadric, stage, sets);
        let errors = |solver| {
            let frame = drawn(&device, solver, stage, sets);
            compare(&truth, &frame, &CompareOptions::of(1.0 / 512.0)).unwrap()
        };
        let [exact, near] = [errors(patches_of), errors(binary_of)];
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
    bench.done(&format!(
        "render scene.toml --size 160x120 -o a.exr --solver {solver}"
    ));
    bench.done("render scene.toml --size 160x120 -o b.exr --stage reference");
    let said = bench.said("compare b.exr a.exr --json");
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let number = |key: &str| said[key].as_f64().unwrap();
    let wrong = number("missed") + number("ghost");
    assert!(
        wrong < number("hits") / 100.0 && number("depth_p99_texels") < 0.01,
        "{said}"
    );
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
            let [a, b] = [copy, own].map(|solver| drawn(&device, solver, stage, sets));
            assert_eq!(
                (a.distance, a.color, a.steps),
                (b.distance, b.color, b.steps),
                "{name}"
            );
        }
    }
    device.check().unwrap();
}

#[test]
fn a_new_folder_draws_and_is_listed() {
    let bench = Bench::new();
    let said = bench.said("searches new fresh");
    assert!(said.contains("--solver ./fresh"), "{said}");
    let said = bench.said("searches fresh");
    for word in [
        "fresh: ",
        "factor = 1.0",
        "fragment, a vase",
        "compute, a vase",
        "files ",
    ] {
        assert!(said.contains(word), "no {word}: {said}");
    }
    bench.done("render scene.toml --size 64x48 -o a.png --solver ./fresh:factor=0.8");
    bench.done("animate scene.toml --frames 2 --size 64x48 --solver fresh --stage compute");
    let all = bench.said("searches");
    for word in [
        "exact: ",
        "circle: ",
        "reads       table",
        "Dummer",
        "lab/searches/published",
    ] {
        assert!(all.contains(word), "no {word}: {all}");
    }
    bench.refuses(
        2,
        "searches new fresh  | fresh | exists
         searches new circle | circle | search of revmap
         searches new Fresh! | name",
    );
}

/// Faults of `search.toml`, of names, and of values of parameters: nothing is drawn.
#[test]
fn faults_of_descriptions_name_the_file_and_the_remedy() {
    let parameters = "[parameters.omega]\nabout = 'x'\ndefault = 1.5\nrange = [1.0, 2.0]\n";
    let whole = format!("{TOML}{parameters}");
    for row in table(
        "'map' => 'mapp'                       | line 5 | mapp | binary map
         'map' => 'map                         | line 5
         bevels = true => bevels = 1; bevel = 2 | line 7 | bevel
         inside => insight                     | line 7 | insight
         name = 'mine' =>                      | name
         'mine' => 'My search'                 | name | small letters
         'a test' => ' '                       | about | empty
         [steps]; default = 64 =>              | steps | missing
         default = 64 => default = 0           | steps | 1 or more
         'map' => 'table'                      | table | missing | program
         64 => 64; [table]; program = ['a']    | table | reads =
         [steps] => glsl = 'other.glsl'; [steps] | glsl | other.glsl
         1.5 => 3.5                            | parameters.omega | outside
         1.5 => 1                              | parameters.omega | two kinds",
    ) {
        let own = Own::new(&changed(&whole, row[0]), &format!("{HEAD}{BODY}"));
        let words = [&["mine/search.toml"], &row[1..]].concat();
        own.refused(&format!("{RENDER} mine"), 2, &words);
    }
    let own = Own::new(&format!("{TOML}{parameters}"), &format!("{HEAD}{BODY}"));
    own.renders("mine:omega=1.9");
    let tries = "mine:omga=1.2  | omga   | give one of omega
                 mine:omega=2.5 | 1.0 to 2.0
                 mine:omega=x   | a number
                 ./none         | none/search.toml | searches new
                 none           | possible values";
    for row in table(tries) {
        own.refused(&format!("{RENDER} {}", row[0]), 2, &row[1..]);
    }
    std::fs::remove_file(own.bench.path("mine/search.glsl")).unwrap();
    own.refused(
        &format!("{RENDER} mine"),
        2,
        &["glsl", "search.glsl", "not in the folder"],
    );
}

/// Errors of GLSL name the line of the person's own file.
#[test]
fn errors_of_glsl_name_file_and_line() {
    for (n, row) in table(
        "++steps; => s += omega;      | mine/search.glsl:6: | omega | undeclared
         ++steps; => ++steps          | mine/search.glsl:7: | syntax
         uint search => #include \"none.glsl\"; uint search | mine/search.glsl:1: | none.glsl
         uint search => #include \"own.glsl\"; uint search  | mine/own.glsl:2: | syntax
         uint search => uint find     | mine/search.glsl | does not define | uint search(Meridian m
         float pixel, =>              | mine/search.glsl | does not define
         uint search => ; float search | mine/search.glsl:2: search returns float | uint search(Meridian m
         END =>                       | mine/search.glsl:1: | does not return a value
         END => if (s > m.s_end) { return LEFT;} | mine/search.glsl | `search` can end without a return",
    )
    .enumerate()
    {
        let glsl = changed(&format!("{HEAD}{BODY}"), row[0]);
        // The text that is compiled differs.
        let inside = ["inside = true", "inside = false"][n % 2];
        let own = Own::new(&TOML.replace("inside = true", inside), &glsl);
        own.bench.file("mine/own.glsl", "\nvec5 x;\n");
        own.refused(&format!("{RENDER} mine"), 1, &row[1..]);
    }
    // Every way through these functions returns.
    for end in [
        "if (s > m.s_end) { return LEFT; } else { return f < 1e-3 ? FOUND : EXHAUSTED; }",
        "for (;;) { if (s > m.s_end) { return LEFT; } return f < 1e-3 ? FOUND : EXHAUSTED; }",
        "switch (int(s > m.s_end)) { case 1: return LEFT; default: return f < 1e-3 ? FOUND : EXHAUSTED; }",
    ] {
        Own::new(TOML, &format!("{HEAD}{}", BODY.replace(END, end))).renders("mine");
    }
    // A table of which the eye may be inside.
    let toml = TOML
        .replace("'map'", "'table'")
        .replace("[steps]\ndefault = 64\n", "[table]\nprogram = ['true']\n");
    let own = Own::new(
        &toml,
        "uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
{
    quadric = vec4(1.0);
    return LEFT;
}\n",
    );
    own.refused(
        "searches ./mine",
        1,
        &[
            "mine/search.glsl: search.toml says inside = true",
            "`bool starts_in_table(Meridian m)`",
            "inside = false",
        ],
    );
}

/// What the picture of `searches` shows is a warning there, and in a run that tries the folder.
#[test]
fn a_search_that_hits_nothing_or_passes_its_limit_is_named() {
    let none = Own::new(
        TOML,
        &format!("{HEAD}{}", BODY.replace(END, "return LEFT;")),
    );
    let said = lines(&none.run("searches ./mine"));
    let warned = "warning: mine hits nothing in the test picture of the fragment stage";
    assert!(said.iter().any(|l| l.starts_with(warned)), "{said:?}");
    let all = none.run("searches ./mine ./mine");
    let text = String::from_utf8(all.stdout).unwrap();
    assert!(!text.contains("NaN") && !text.contains("-0"), "{text}");
    assert!(text.contains("hits nothing"), "{text}");
    // A folder is described once.
    assert_eq!(text.matches("  licence ").count(), 1, "{text}");
    let bench =
        "bench scene.toml --size 64x48 --quick --passes 2 --rounds 1 --solver mine,circle -o out";
    let said = lines(&none.run(bench));
    assert!(said.iter().any(|l| l.starts_with(warned)), "{said:?}");

    let body = BODY.replace("i < most_steps() && f > 1e-4", "i < 400");
    let long = Own::new(TOML, &format!("{HEAD}{body}"));
    let said = lines(&long.run("searches ./mine"));
    let warned =
        "look-ups for a pixel in the compute stage, but most_steps() is 64: bound the loop";
    assert!(said.iter().any(|l| l.contains(warned)), "{said:?}");
    assert!(lines(&Own::good().run("searches ./mine")).is_empty());
}

#[test]
fn the_limit_of_a_frame_is_a_number_of_seconds() {
    let mut own = Own::good();
    own.limit = "7.5";
    own.renders("mine");
    own.limit = "abc";
    own.refused(
        &format!("{RENDER} mine"),
        2,
        &["REVMAP_TIME_LIMIT is \"abc\"", "seconds"],
    );
}

/// What only a picture shows: `render` warns, a bench leaves the search out.
#[test]
fn wrong_values_are_counted() {
    for (line, word) in [
        (
            "s = sqrt(-1.0 - s * s); return FOUND;",
            "no number (NaN or infinite) in",
        ),
        (
            "s = 1.0 / (s - s); return FOUND;",
            "no number (NaN or infinite) in",
        ),
        ("return s > m.s_end ? LEFT : 7u;", "wrong value in"),
    ] {
        let own = Own::new(TOML, &format!("{HEAD}{}", BODY.replace(END, line)));
        let said = own.renders("mine");
        let mut warnings = said
            .iter()
            .filter(|l| l.contains("warning: mine/search.glsl"));
        assert!(warnings.any(|l| l.contains(word)), "{said:?}");
    }
    // A solid that the search does not draw.
    let own = Own::new(
        &TOML.replace("bevels = true", "bevels = false"),
        &format!("{HEAD}{BODY}"),
    );
    own.renders("mine");
    own.refused(
        &format!("{RENDER} mine --set object.0.bevel=0.2"),
        1,
        &["bevel", "mine", "bevels = false"],
    );
}

/// A search that does not end is ended, and the others of its run are measured.
#[test]
fn an_endless_search_ends_no_run() {
    // Lavapipe ends all loops of a shader after 65536 turns, which take seconds if they are long.
    let endless = |when: &str| {
        let turn = (0..8).fold("f".to_owned(), |s, _| format!("field(point_rz(m, {s}))"));
        let turns = format!("while ({when}) {{ f = min(f, {turn}); }}");
        format!(
            "{HEAD}{}",
            BODY.replacen('{', &format!("{{\n    {turns}"), 1)
        )
    };
    let mut own = Own::new(TOML, &endless("f > -9.0"));
    own.limit = "2";
    own.refused(
        "render scene.toml --size 640x480 -o b.png --solver mine",
        1,
        &["a frame by mine took more than 2 seconds", "most_steps()"],
    );
    let scene = "scene.toml --size 640x480 --quick";
    left_out(&own, scene, "took more than 2 seconds");
    // Endless for one scene of the run alone: the test picture does not show it.
    let mut own = Own::new(TOML, &endless("f > -9.0 && shape.extend > 0.0"));
    own.limit = "2";
    own.bench
        .object("polygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\nextend = 0.01");
    left_out(&own, scene, "begins again without mine");
}

/// A run by `mine` and `circle` has the rows of `circle`, and says why those of `mine` are missing.
#[track_caller]
fn left_out(own: &Own, what: &str, why: &str) {
    let output = own.run(&format!(
        "bench {what} --solver mine,circle --passes 2 --rounds 1 -o out"
    ));
    let said = lines(&output);
    println!("{}", said.join("\n"));
    assert_eq!(output.status.code(), Some(0), "{said:?}");
    assert!(said.iter().any(|l| l.contains(why)), "{said:?}");
    assert!(
        said.iter()
            .any(|l| l.contains("warning: mine was left out")),
        "{said:?}"
    );
    let read = |file: &str| String::from_utf8(own.bench.read(file)).unwrap();
    assert!(
        read("out/results.csv").contains(",circle,") && !read("out/results.csv").contains(",mine,")
    );
    assert!(read("out/excluded.csv").contains("mine"));
}

#[test]
fn a_run_measures_the_others_and_names_the_origin() {
    let own = Own::new(
        TOML,
        &format!("{HEAD}{}", BODY.replace("f > 1e-4", "nothing")),
    );
    left_out(
        &own,
        "scene.toml --size 64x48 --quick",
        "mine/search.glsl:3:",
    );
    let table = own.run("stability cone-tip --quick --solver mine,circle,exact -o s");
    let said = lines(&table).join("\n");
    assert!(
        said.contains("mine failed: ") && said.contains("mine/search.glsl:3:"),
        "{said}"
    );
    // One that works stands in both reports with its origin.
    let own = Own::good();
    let output = own.run(
        "bench scene.toml --size 64x48 --quick --solver ./mine,circle --passes 2 --rounds 1 -o out",
    );
    assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
    own.run("stability cone-tip --quick --solver ./mine,exact -o s");
    let read = |file: &str| String::from_utf8(own.bench.read(file)).unwrap();
    assert!(read("out/results.csv").contains(",mine,"));
    for file in ["out/report.html", "out/machine.txt", "s/report.html"] {
        assert!(
            read(file).contains("not revmap's own: folder ./mine, files "),
            "{file}"
        );
    }
    // As a plan names it.
    let plan = "about = 'x'\ntitle = 'x'\nviews = [{ name = 'one', solids = ['vase'] }]\n\
        measure = [{ methods = ['./mine', 'circle'], sizes = ['64x48'] }]\nshow = []\n";
    own.bench.file("plan.toml", plan);
    let output = own.run("bench --plan plan.toml --passes 2 --rounds 1 -o p");
    assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
    assert!(read("p/results.csv").contains(",mine,"));
}

/// Tables of a program, good and bad.
#[cfg(unix)]
#[test]
fn programs_make_tables_within_limits() {
    use std::os::unix::fs::PermissionsExt;
    let toml = TOML
        .replace("'map'", "'table'")
        .replace("inside = true\n", "")
        .replace("[steps]\ndefault = 64\n", "");
    let toml = format!("{toml}[table]\nprogram = ['table.sh', 'word']\n");
    // A cylinder whose radius the table holds.
    let glsl =
        "uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
{
    float r = table_vector(table_length() - 1u).w;
    ++steps;
    quadric = vec4(1.0, 0.0, 0.0, 0.0);
    float root = m.b * m.b - m.a * (m.c - r * r);
    s = (-m.b - sqrt(max(root, 0.0))) / m.a;
    return root > 0.0 && s > 0.0 && s < m.s_end ? FOUND : LEFT;
}\n";
    let mut own = Own::new(&toml, glsl);
    let file: PathBuf = own.bench.path("mine/table.sh");
    let program = |text: &str| {
        std::fs::write(&file, format!("#!/bin/sh\n{text}\n")).unwrap();
        std::fs::set_permissions(&file, PermissionsExt::from_mode(0o755)).unwrap();
    };
    program("cat > input.json; test $1 = word && echo '0 0 0 0, 1e-1 2 3 0.2'");
    own.renders("./mine");
    own.limit = "2";
    let input = String::from_utf8(own.bench.read("mine/input.json")).unwrap();
    assert!(
        input.starts_with("{\"rows\": 512") && input.contains("\"chains\": [[["),
        "{input}"
    );
    for (text, words) in [
        (
            "echo 'no outline' >&2; exit 3",
            &["`table.sh word` failed", "exit status: 3", "no outline"][..],
        ),
        ("sleep 60", &["took more than 2 seconds"]),
        ("echo 1 2 three 4", &["\"three\"", "number 3"]),
        ("echo 1 2 nan 4", &["\"nan\"", "finite"]),
        ("echo 1 2 3", &["wrote 3 numbers", "four"]),
        ("true", &["wrote 0 numbers"]),
        ("yes 1 2 3 4", &["took more than 2 seconds|wrote more than"]),
    ] {
        program(text);
        let output = own.run(&format!("{RENDER} mine"));
        let said = lines(&output);
        assert_eq!((output.status.code(), said.len()), (Some(1), 1), "{said:?}");
        println!("{}", said[0]);
        for word in words {
            assert!(
                word.split('|').any(|word| said[0].contains(word)),
                "no {word:?} in {said:?}"
            );
        }
    }
    std::fs::remove_file(own.bench.path("mine/table.sh")).unwrap();
    own.refused(
        &format!("{RENDER} mine"),
        1,
        &["`table.sh word` cannot be started"],
    );
}

/// Words are kept by their content; a damaged file is made anew, a changed GLSL gets others.
#[test]
fn compiled_words_are_kept() {
    let own = Own::good();
    let kept = || {
        let folder = own.cache.path().join("revmap/searches");
        let files = std::fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().path());
        let mut files: Vec<(PathBuf, Vec<u8>)> = files
            .map(|f| (f.clone(), std::fs::read(f).unwrap()))
            .collect();
        files.sort();
        files
    };
    own.renders("mine");
    let first = kept();
    assert!(!first.is_empty());
    std::fs::write(&first[0].0, b"damaged").unwrap();
    let picture = own.bench.read("a.png");
    own.renders("mine");
    assert_eq!(kept(), first);
    assert_eq!(own.bench.read("a.png"), picture);
    own.bench.file(
        "mine/search.glsl",
        format!("{HEAD}{}", BODY.replace("1e-4", "2e-4")),
    );
    own.renders("mine");
    assert_eq!(kept().len(), 2 * first.len());
}
