//! Whatever is wrong with the files that the program is given: the exit code, one line that says
//! where, and no output file.

use crate::run::{Bench, CAMERA, CONE, holds, table};

/// The reference, which needs no Vulkan: what is wrong here is wrong before any device is looked
/// for.
const RENDER: &str = "render scene.toml -o out.png --stage reference --size 16x12";

/// The readers' own tests have the others (`crates/files`).
#[test]
fn scenes_with_slips() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("folder.png")).unwrap();
    bench.file("text.png", b"this is no picture");
    for row in table(
        r#"bevle = 1                 | object.0.bevle          | `bevel`
           repeat = [10000, 1, 1]    | object.0.repeat         | 10000
           polygon = [[0, 0], [0, 1]] | scene.toml
           profile = "missing.svg"   | object.0.profile        | missing.svg
           profile = "folder.png"    | object.0.profile        | folder.png
           profile = "text.png"      | object.0.profile        | text.png
           height_map = "none.png"   | object.0.height_map     | none.png"#,
    ) {
        let object = match row[0].starts_with('p') {
            true => "[[object]]\n",
            false => CONE,
        };
        bench.file("scene.toml", format!("{CAMERA}{object}{}\n", row[0]));
        bench.refused(RENDER, 1, &row[1..]);
    }
    bench.file("scene.toml", "[camera");
    bench.refused(RENDER, 1, &["scene.toml", "line 1", "TOML"]);
    bench.file("scene.toml", [0xff, 0xfe, 0x00]);
    bench.refused(RENDER, 1, &["scene.toml"]);
    bench.refuses(
        1,
        "render none.toml -o out.png --stage reference | none.toml
         render .         -o out.png --stage reference | .",
    );
}

#[test]
fn baking_what_is_no_profile() {
    let bench = Bench::new();
    bench.half("half.png");
    bench.grey("black.png", 20, 20, |_, _| 0);
    bench.refuses(
        1,
        "bake none.svg   -o map.png                       | none.svg   | does not exist
         bake black.png  -o map.png                       | black.png  | white
         bake scene.toml -o map.png                       | scene.toml | PNG
         bake half.png   -o no/map.png                    | no/map.png | does not exist
         bake half.png   -o map.png --height-map none.png | none.png   | height",
    );
    bench.refuses(
        2,
        "bake half.png -o map.bmp                          | map.bmp      | .png, .exr
         bake half.png -o half.png                         | half.png     | another file
         bake half.png -o map.png --map-rows 1             | --map-rows   | 1",
    );
}

#[test]
fn comparing_what_is_no_frame() {
    let bench = Bench::new();
    let render = "render scene.toml --stage reference -q -o";
    bench.done(&format!("{render} a.exr --size 16x12"));
    bench.done(&format!("{render} b.exr --size 16x13"));
    bench.done(&format!(
        "{render} c.exr --size 16x12 --set object.0.extend=0.05"
    ));
    let whole = bench.read("a.exr");
    bench.file("half.exr", &whole[..whole.len() / 2]);
    bench.refuses(
        1,
        "compare a.exr none.exr | none.exr | EXR
         compare a.exr half.exr | half.exr | EXR
         compare a.exr b.exr    | b.exr    | 16x13",
    );
    bench.refuses(
        2,
        "compare a.exr scene.toml            | scene.toml | .exr
         compare a.exr c.exr --heat heat.jpg | --heat     | .png
         compare a.exr c.exr --alike         | --alike    | PNG
         compare a.png a.png --heat heat.png | a.png      | .exr",
    );
    let same = bench.said("compare a.exr a.exr --exact --heat heat.png");
    holds(&same, &["equal in every channel"]);
    bench.has(&["heat.png"]);
    // A difference is a result, unless equality was asked for.
    let other = bench.said("compare a.exr c.exr");
    assert!(other.contains("differ, first in"));
    let (code, said) = bench.ended("compare a.exr c.exr --exact");
    assert_eq!((code, said.len()), (Some(1), 1));
}

/// A planted pixel is found; one step of a channel is none that counts.
#[test]
fn comparing_pictures() {
    let bench = Bench::new();
    let shade = |x: u32, y: u32| ((x + y) % 100) as u8;
    bench.grey("a.png", 20, 20, shade);
    bench.grey("near.png", 20, 20, |x, y| shade(x, y) + 1);
    bench.grey("far.png", 20, 20, |x, y| match (x / 2, y / 2) {
        (3, 3) => 200,
        _ => shade(x, y),
    });
    bench.grey("small.png", 20, 19, shade);
    bench.file("half.png", &bench.read("a.png")[..60]);
    for row in table(
        "a.png a.png --exact  | 0 | 0 of 1600 channels differ
         a.png near.png --alike | 0 | 1200 of 1600 | largest difference is 1
         a.png far.png        | 0 | 12 by more than 3 of 255; the largest difference is 188
         a.png far.png --alike | 1 | differ visibly
         a.png near.png --exact | 1 | the pictures differ;",
    ) {
        let command = format!("compare {}", row[0]);
        let output = bench.run(&command);
        let code = row[1].parse().unwrap();
        assert_eq!(output.status.code(), Some(code), "{command}");
        let said = [output.stdout, output.stderr].map(|s| String::from_utf8(s).unwrap());
        assert!(said[1].lines().count() == code as usize, "{said:?}");
        holds(&said[code as usize], &row[2..]);
    }
    bench.refuses(
        1,
        "compare a.png small.png | small.png | 20x19
         compare a.png half.png  | half.png  | damaged
         compare a.png none.png  | none.png  | cannot be read",
    );
}
