//! What looks unintended is said in one line each, and changes no exit code.

use crate::run::{Bench, CAMERA, SVG, holds, lines, table};

const RENDER: &str = "render scene.toml -o out.png --size 32x24";

#[test]
fn scenes_that_look_unintended() {
    let bench = Bench::new();
    assert_eq!(bench.warned(RENDER), [""; 0]);
    for row in table(
        "object.0.color=[200,100,0]      | object.0.color
         camera.target=[9,0,0.5]         | nothing is in view
         object.0.scale=[1e-6,1e-6,1e-6] | object.0 is 0.00 pixels large",
    ) {
        let set = row[0];
        let arguments = format!("{RENDER} --set {set}");
        bench.warned_once(&arguments, &row[1..]);
        assert!(lines(&bench.done(&format!("{arguments} --quiet"))).is_empty());
    }
}

/// A drawing with a margin hovers over a table until it stands; so do its copies.
#[test]
fn what_hovers_stands_by_a_key() {
    let bench = Bench::new();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M30 5H70V97H30z'/></svg>";
    bench.file("a.svg", svg);
    bench.file(
        "two.csv",
        "0.5,0,0,0,0,0,1,1,1,1\n-0.5,0,0,0.1,0,0,0.995,1,1,2\n",
    );
    let table = "[[object]]\npolygon = [[0,0],[2,0],[2,1],[0,1]]\nposition = [0,0,-0.1]\nscale = [1,1,0.1]\n";
    for copies in ["", "instances = \"two.csv\"\n"] {
        let thing = format!("[[object]]\nprofile = \"a.svg\"\n{copies}");
        let scene = |first: &str, own: &str| {
            bench.file("scene.toml", format!("{first}{CAMERA}{table}{thing}{own}"));
            bench.warned(RENDER)
        };
        let found = scene("", "");
        assert_eq!(found.len(), 1, "{found:?}");
        holds(&found[0], &["object.1.stand = true"]);
        assert_eq!(scene("", "stand = true\n"), [""; 0]);
        assert_eq!(scene("stand = true\n", ""), [""; 0]);
        assert_eq!(scene("stand = true\n", "stand = false\n").len(), 1);
    }
}

/// A picture without a hit is named, though the geometry says that there is something.
#[test]
fn pictures_that_show_nothing() {
    let bench = Bench::new();
    bench.file("a.svg", SVG);
    let render = "render a.svg -o out.png --size 32x24";
    let background = "--set background=[0.2,0.3,0.4,1]";
    for set in ["-0.0499", "-0.0499 --stage reference"] {
        for more in ["", background] {
            let arguments = format!("{render} --set object.0.extend={set} {more}");
            bench.warned_once(&arguments, &["extend"]);
        }
    }
    let small = "--size 32x24 --set object.0.scale=[1e-6,1e-6,1e-6]";
    for output in ["", " -o t"] {
        let animate = format!("animate scene.toml --frames 2 --turn 90 {small}{output}");
        bench.warned_once(&animate, &["frames are empty", "0.00 pixels large"]);
    }
    let still = "animate scene.toml --frames 2 --size 32x24";
    bench.warned_once(still, &["nothing moves, so all frames are equal"]);
    bench.warned_once(&format!("{still} --turn 0"), &["--turn or --vary"]);
}

/// Fins of 1 % of the height merge within 2 % of it.
#[test]
fn a_coarse_outline_says_what_it_changed() {
    let bench = Bench::new();
    let fins: String = (5..95)
        .step_by(2)
        .map(|y| format!("M20 {y}H80v1H20z"))
        .collect();
    let path = format!("<path d='M40 5H60V95H40Z{fins}'/>");
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>";
    bench.file("fins.svg", format!("{svg}{path}</svg>"));
    let profile = "profile fins.svg -o clean.svg";
    assert_eq!(bench.warned(profile), [""; 0]);
    let words = ["--tolerance: ", " % of the solid's area changed"];
    bench.warned_once(&format!("{profile} --tolerance 0.02"), &words);
    let words = ["--tolerance: is 1, which leaves no shape"];
    bench.refused("profile fins.svg -o a.svg --tolerance 1", 2, &words);
}

#[test]
fn options_that_are_passed_over() {
    let bench = Bench::new();
    for row in table(
        "--max-steps 9                             | --max-steps: --solver exact
         --solver quadric --map-rows 64            | --map-rows
         --solver mesh:8x8 --map-format r16        | --map-format
         --stage reference --solver live           | --solver: --stage reference
         --solver live --max-steps 99 --map-rows 64 --map-source exact --map-format r16
         --solver cone --map-rows 64",
    ) {
        let found = bench.warned(&format!("{RENDER} {}", row[0]));
        assert_eq!(found.len(), row.len() - 1, "{found:?}");
        holds(&found.concat(), &row[1..]);
    }
    let animate = "animate scene.toml --frames 1 --size 32x24 --samples 4";
    bench.warned_once(animate, &["--samples"]);
}

#[test]
fn pictures_that_look_unintended_and_the_keys_that_mend_them() {
    let bench = Bench::new();
    let ball = |x: u32, y: u32| (f64::from(x) - 31.5).hypot(f64::from(y) - 31.5) < 20.0;
    bench.grey("light.png", 64, 64, |x, y| if ball(x, y) { 255 } else { 0 });
    let words = ["object.0.profile: ", "profile_invert = true"];
    bench.warned_once("render light.png -o out.png --size 32x24", &words);
    let mended = "render light.png -o out.png --size 32x24 --set object.0.profile_invert=true";
    assert_eq!(bench.warned(mended), [""; 0]);

    let bake = "bake light.png -o map.png --map-rows 64";
    bench.warned_once(bake, &["--profile-invert if light"]);
    bench.done(&format!("{bake} --profile-invert"));
    let bake = "bake light.png -o map2.png --profile-threshold 2";
    bench.refused(bake, 1, &["light.png", "--profile-threshold"]);
}
