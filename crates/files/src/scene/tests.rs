//! Tests of the reader of scene files.

#![allow(clippy::unwrap_used)]
use super::keys::OBJECT;
use super::reader::{CAMERA, ENVIRONMENT, LIGHT};
use super::*;
use glam::DQuat;
use revmap::maps::Projection;
use revmap::scene::{
    BumpForm, Environment, Light, Material, Offset, Placement, Shadow, Specular, Texturing,
};
use std::sync::Arc;

const CAMERA_LINES: &str = "[camera]\neye = [2, 0, 0.5]\ntarget = [0, 0, 0.5]\n";
const CONE: &str = "[[object]]\npolygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\n";

fn parse(text: &str, folder: impl AsRef<Path>, sets: &[String]) -> Result<Scene> {
    SceneFile::parse(text, folder)?.scene(sets)
}

/// A scene of one cone, with further lines.
fn cone(lines: &str) -> Result<Scene> {
    parse(&format!("{CAMERA_LINES}{CONE}{lines}"), "", &[])
}

#[track_caller]
fn fault(result: Result<Scene>, wanted: &str) {
    let message = result.err().unwrap().to_string();
    assert!(message.contains(wanted), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
}

/// A half profile, dark below a light top, and a texture, in a folder of their own.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let half = image::GrayImage::from_fn(8, 16, |x, y| {
        image::Luma([if x < 6 && y > 4 { 0 } else { 255 }])
    });
    half.save(folder.path().join("half.spherical.png")).unwrap();
    image::RgbImage::from_pixel(4, 2, image::Rgb([9, 8, 7]))
        .save(folder.path().join("t.png"))
        .unwrap();
    std::fs::write(
        folder.path().join("copies.csv"),
        "0,0,0,0,0,0,1,1,1,1\n1,0,0,0,0,0,1,1,1,2\n",
    )
    .unwrap();
    folder
}

/// A table of values, each with the one that it must equal.
macro_rules! equal {
    ($($found:expr => $wanted:expr;)*) => {$(assert_eq!($found, $wanted, stringify!($found));)*};
}

#[test]
fn what_is_not_said_has_the_documented_default() {
    let scene = cone("").unwrap();
    let object = &scene.objects[0];
    #[rustfmt::skip]
    let Texturing { bump, bump_form, projection, repeat, .. } = object.texturing;
    equal! {
        scene.background => [0.0; 4];
        scene.camera.up => DVec3::Z;
        scene.camera.fov_y => 40.0;
        scene.lights => Light::pair();
        scene.shadow => Shadow::Off;
        scene.environment => None;
        object.name => "polygon";
        object.profile.radius => 0.5;
        object.map_rows => 512;
        object.color => [0.8; 3];
        object.offset => Offset { extend: 0.0, bevel: 0.0, chamfer: 1.0 };
        object.axis => [0.5; 2];
        object.repeat => [1; 3];
        object.mirror => [false; 3];
        object.placement => Placement::default();
        projection => Projection::Cylindrical;
        bump_form => BumpForm::SurfaceGradient;
        (bump, repeat) => (1.0, [1.0; 2]);
    }
}

#[test]
fn every_key_arrives() {
    let folder = folder();
    let text = r#"
background = [0.1, 0.2, 0.3, 1]
ambient = [0.5, 0.6, 0.7]
shadow = "soft"
environment = { up = [0.5, 2, 1], down = [1, 0, 0] }
[camera]
eye = [1.6, 0.3, 1.1]
target = [0.0, 0.0, 0.5]
up = [0, 1, 0]
fov_y = 25.5
[[light]]
direction = [1, 2, -3]
radius = 3.5
color = [2, 1, 0.5]
[[light]]
[[object]]
profile = "half.spherical.png"
profile_axis = "left"
map_rows = 64
color = [0.1, 0.2, 0.3]
color_map = "t.png"
specular = 0.75
shininess = 9
roughness = 0.25
height_map = "t.png"
bump = 0.02
bump_form = "papers"
texture_repeat = [3, 2]
texture_offset = [0.25, -0.5]
extend = -0.01
bevel = 0.25
chamfer = 0.5
axis = [0.25, 0.75]
repeat = [1, 2, 3]
mirror = [true, false, true]
position = [1, 2, 3]
rotation = [0, 0, 2, 0]
scale = [1, 2, 0.5]
[[object]]
profile = "half.spherical.png"
instances = "copies.csv"
"#;
    let scene = parse(text, folder.path(), &[]).unwrap();
    let light = Light {
        direction: DVec3::new(1.0, 2.0, -3.0),
        color: [2.0, 1.0, 0.5],
        radius: 3.5,
    };
    let object = &scene.objects[0];
    #[rustfmt::skip]
    let Texturing { bump, bump_form, projection, repeat, .. } = object.texturing;
    let color = object.texturing.color_map.as_ref().unwrap();
    let slopes = object.texturing.displacement_map.as_ref().unwrap();
    equal! {
        scene.background => [0.1, 0.2, 0.3, 1.0];
        scene.ambient => [0.5, 0.6, 0.7];
        scene.shadow => Shadow::Soft;
        scene.environment => Some(Environment { up: [0.5, 2.0, 1.0], down: [1.0, 0.0, 0.0] });
        scene.camera.eye => DVec3::new(1.6, 0.3, 1.1);
        scene.camera.up => DVec3::Y;
        scene.camera.fov_y => 25.5;
        scene.lights => [light, Light::default()];
        object.name => "half.spherical.png";
        object.file => Some(folder.path().join("half.spherical.png"));
        object.profile.radius => 0.5;
        object.map_rows => 64;
        object.color => [0.1, 0.2, 0.3];
        object.specular => Specular { strength: 0.75, shininess: 9.0 };
        object.material => Some(Material { roughness: 0.25, metalness: 0.0 });
        color.levels[0].texels[0] => [9, 8, 7, 255];
        slopes.size() => [4, 2];
        (bump, bump_form) => (0.02, BumpForm::Papers);
        (projection, repeat) => (Projection::Spherical, [3.0, 2.0]);
        object.texturing.offset => [0.25, -0.5];
        object.offset => Offset { extend: -0.01, bevel: 0.25, chamfer: 0.5 };
        object.axis => [0.25, 0.75];
        object.repeat => [1, 2, 3];
        object.mirror => [true, false, true];
        object.placement.position => DVec3::new(1.0, 2.0, 3.0);
        object.placement.rotation => DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0);
        object.placement.scale => DVec3::new(1.0, 2.0, 0.5);
        scene.objects[1].instances.len() => 2;
        scene.objects[1].instances[1].scale.z => 2.0;
        scene.objects[1].placements().len() => 2;
    }
}

#[test]
fn objects_of_one_file_and_axis_share_their_profile() {
    let folder = folder();
    let object = |axis: &str| {
        format!("[[object]]\nprofile = \"half.spherical.png\"\nprofile_axis = \"{axis}\"\n")
    };
    let text = [
        CAMERA_LINES.to_owned(),
        object("left"),
        object("left"),
        object("center"),
    ]
    .concat();
    let scene = parse(&text, folder.path(), &[]).unwrap();
    let [a, b, c] = [0, 1, 2].map(|i| &scene.objects[i].profile);
    assert!(Arc::ptr_eq(a, b));
    assert!(!Arc::ptr_eq(a, c));
    assert_eq!((a.radius, c.radius), (0.5, 0.25));
    // A projection that is named goes before that of the file's name.
    let text = format!(
        "light = []\n{CAMERA_LINES}{}projection = \"arc\"",
        object("left")
    );
    let scene = parse(&text, folder.path(), &[]).unwrap();
    assert_eq!(scene.objects[0].texturing.projection, Projection::Arc);
    assert!(scene.lights.is_empty());
}

/// A polygon that is wider than the usual box gets a box of its own width. A radius that is given
/// stays, and the box cuts the polygon.
#[test]
fn a_wide_polygon_gets_a_wide_box() {
    let radius = |polygon: &str, given: &str| {
        let text = format!("{CAMERA_LINES}[[object]]\npolygon = {polygon}\n{given}");
        let scene = parse(&text, std::path::Path::new("."), &[]).unwrap();
        scene.objects[0].profile.radius
    };
    let wide = "[[0, 0], [1, 0], [1, 1], [0, 1]]";
    assert_eq!(radius(wide, ""), 1.0);
    assert_eq!(radius(wide, "radius = 0.5"), 0.5);
    assert_eq!(radius("[[0, 0], [0.3, 0], [0, 1]]", ""), 0.5);
}

#[test]
fn sets_come_before_what_the_file_says() {
    let sets = [
        "object.0.bevel=0.4",
        "camera.fov_y=20",
        "shadow=hard",
        "background=[1, 1, 1, 1]",
    ];
    let text = format!("{CAMERA_LINES}{CONE}bevel = 1\n");
    let scene = parse(&text, "", &sets.map(String::from)).unwrap();
    equal! {
        scene.objects[0].offset.bevel => 0.4;
        scene.camera.fov_y => 20.0;
        scene.shadow => Shadow::Hard;
        scene.background => [1.0; 4];
    }
    for (set, wanted) in [
        (
            "object.0.bevle=0.4",
            "object.0.bevle: unknown key; did you mean `bevel`?",
        ),
        ("object.0.bevel=-1", "object.0.bevel: is -1.0"),
    ] {
        fault(parse(&text, "", &[set.to_owned()]), wanted);
    }
}

/// Lines below a cone, parted by `|`, and words of their refusal.
const SLIPS: &str = r##"
bevle = 1                           => object.0.bevle: unknown key; did you mean `bevel`?
bevel = "1"                         => object.0.bevel: expected a number
scale = [1, 0, 1]                   => object.0.scale: has 0.0
scale = 2                           => object.0.scale: expected 3 numbers in brackets, found 2
color = "greenish"                  => object.0.color: expected 3 numbers, or an opaque colour such as "orange"
rotation = [0, 0, 0, 0]             => object.0.rotation:
repeat = [1, 0, 1]                  => object.0.repeat: has 0
chamfer = 2                         => object.0.chamfer: is 2.0
extend = nan                        => object.0.extend: is NaN
radius = 0                          => object.0.radius: 0 is no radius
projection = "mercator"             => object.0.projection: "mercator" is not known; give one of "planar"
profile = "x.svg"                   => object.0.polygon: stands beside a profile
color_map = "none.png"              => none.png: object.0.color_map: the colour map cannot be read
instances = "none.csv"              => none.csv: cannot be read
[[object]]                          => object.1.profile: is missing
extend = .1                         => line 6, column 10: is not TOML:
extend = .1                         => ; write 0.1
extend = 5. # wide                  => ; write 5.0
map_rows = 07                       => ; write 7
extend = 0,5                        => ; write 0.5
bevel = 1,000                       => ; write 1.0 or 1000
color = [.5, 1., 0]                 => ; write [0.5, 1.0, 0]
profile_invert = True               => ; write true
color_map = "C:\maps\a.png"         => ; write / in paths, or single quotes
color_map = "C:\new.png"            => write / in paths, or single quotes
color_map = "~/a.png"               => object.0.color_map: "~/a.png" is not there, and ~
color_map = "https://a.b/c.png"     => is an address; download
color_map = "-"                     => /dev/stdin
[[light]] | colour = [1, 1, 1]      => light.0.colour: unknown key; did you mean `color`?
[[object]] | profile = "none.svg" | profile_axis = "0.5" => "center", or a number without quotes
profile_axis = "left"               => object.0.profile_axis: counts for files
profile_read = "auto"               => object.0.profile_read: counts for files
profile_threshold = 0.3             => object.0.profile_threshold: counts for files
profile_invert = true               => object.0.profile_invert: counts for files
profile_smooth = 2                  => object.0.profile_smooth: counts for files
profile_smooth = "auto"             => object.0.profile_smooth: counts for files
map-rows = 1                        => object.0.map-rows: unknown key; did you mean `map_rows`?
Chamfer = 1                         => object.0.Chamfer: unknown key; did you mean `chamfer`?
xyzzy = 1                           => object.0.xyzzy: unknown key; known here: profile, polygon,
bevel = "much"                      => object.0.bevel: expected a number, found the text "much"
map_rows = -1                       => map_rows: expected a whole number that is not negative, found -1
repeat = [1, 2]                     => repeat: expected 3 whole numbers that are not negative in brackets, found 2 values
mirror = [true, 1, false]           => mirror: expected 3 of true or false in brackets, found 1
color_map = 3                       => object.0.color_map: expected text in quotes, found 3
[[object]] | polygon = [[1, 2], [3]] => polygon.1: expected a pair of numbers [r, z], found a list of 1 values
[environment] | up = "bluish"       => environment.up: expected 3 numbers, or
[environment] | up = [1, 1]         => environment.up: expected 3 numbers
[environment] | down = [0, -1, 0]   => environment.down: has -1.0
[environment] | upp = [1, 1, 1]     => environment.upp: unknown key; did you mean `up`?
[[environment]]                     => environment: expected a table
instances = "a" | position = [1, 1, 1] => object.0.position: stands beside instances
instances = "a" | turn = 60         => object.0.turn: stands beside instances
instances = "a" | rotation = [0, 0, 0, 1] => object.0.rotation: stands beside instances
instances = "a" | scale = [1, 1, 1] => object.0.scale: stands beside instances
turn = "a"                          => object.0.turn: expected a number
color = "ff8000"                    => object.0.color: expected 3
color = "#ff80"                     => object.0.color: expected 3
color = "#ff80zz"                   => object.0.color: expected 3
color = "#ff80é"                    => object.0.color: expected 3
color = "reddish"                   => object.0.color: expected 3
color = "#+f8000"                   => object.0.color: expected 3
"##;

#[test]
fn slips_are_named_with_their_full_key() {
    for (line, wanted) in SLIPS.lines().filter_map(|line| line.split_once(" => ")) {
        fault(cone(&line.replace('|', "\n")), wanted);
    }
    let scene = format!("{CAMERA_LINES}{CONE}");
    let wide: String = scene.chars().flat_map(|c| [c, '\0']).collect();
    for (text, wanted) in [
        (CONE, "camera.eye: is missing"),
        (CAMERA_LINES, "object: the scene is empty"),
        ("camera = 3", "camera: expected a table [camera], found 3"),
        (
            "object = 3\n[camera]\neye=[1,0,0]\ntarget=[0,0,0]",
            "object: expected tables",
        ),
        ("[camera]\neye = [1, 2\nfov_y = 1", "line 3"),
        (
            "[camera]\nup = 1\nup = 2",
            "line 3, column 1: is not TOML: duplicate key `up`",
        ),
        (&scene.replace('\n', "\r"), "line ends of CR alone"),
        (&wide, "holds zero bytes"),
        ("1,2,3\n4,5,6\n", "is neither a scene in TOML"),
    ] {
        fault(parse(text, "", &[]), wanted);
    }
}

#[test]
fn a_value_that_moves_the_chosen_camera_is_named_by_its_own_key() {
    let folder = folder();
    let file = folder.path().join("half.spherical.png");
    let set = |value: &str| {
        let set = format!("object.0.extend={value}");
        SceneFile::open(&file).unwrap().scene(&[set])
    };
    fault(set("inf"), "object.0.extend: is inf");
    fault(set("1e400"), "object.0.extend: is inf");
    assert!(set("1e8").is_ok());
}

#[test]
fn the_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    fault(scene(&file), "s.toml: cannot be read");
    let missing = format!("{CAMERA_LINES}[[object]]\nprofile = \"none.png\"");
    for (text, wanted) in [
        (
            "bakground = 1",
            "s.toml: bakground: unknown key; did you mean `background`?",
        ),
        (
            "extend = 1",
            "write it below [[object]], or set object.0.extend",
        ),
        (&missing, "none.png: object.0.profile:"),
    ] {
        std::fs::write(&file, text).unwrap();
        fault(scene(&file), wanted);
    }
    fault(scene(folder.path()), "cannot be read");
}

/// The tables of the document name every key.
#[test]
fn every_key_is_documented() {
    let source = include_str!("../../../../docs/scene-files.md");
    let documented = |key: &str| source.lines().any(|l| l.starts_with(&format!("| `{key}`")));
    for (table, keys) in [
        ("object.N.", OBJECT),
        ("camera.", CAMERA),
        ("light.N.", LIGHT),
        ("environment.", ENVIRONMENT),
    ] {
        for key in keys.split_whitespace() {
            assert!(documented(&format!("{table}{key}")), "{key}");
        }
    }
    for key in ["background", "ambient", "environment", "shadow"] {
        assert!(documented(key), "{key}");
    }
}

#[test]
fn turns_come_before_rotations_and_colours_may_be_texts() {
    let at = |lines: &str| cone(lines).unwrap().objects[0].placement.rotation;
    let turned = at("turn = 90") * glam::DVec3::X;
    assert!(turned.distance(glam::DVec3::Y) < 1e-12);
    // Half a turn about x after it.
    let turned = at("rotation = [1, 0, 0, 0]\nturn = 90") * glam::DVec3::X;
    assert!(turned.distance(glam::DVec3::NEG_Y) < 1e-12);
    let scene = cone("color = \"#Ff8000\"\n[[light]]\ncolor = \"#000033\"").unwrap();
    let [red, green, blue] = scene.objects[0].color;
    assert!(red == 1.0 && (green - 0.215_861).abs() < 1e-6 && blue == 0.0);
    assert!((scene.lights[0].color[2] - 0.033_105).abs() < 1e-6);
    let text = format!("environment.up = \"#ff0000\"\n{CAMERA_LINES}{CONE}");
    let (up, down) = ([1.0, 0.0, 0.0], [0.0; 3]);
    let sky = parse(&text, "", &[]).unwrap().environment;
    assert_eq!(sky, Some(Environment { up, down }));
    let [named, digits] = ["steelblue", "#4682b4"].map(|c| cone(&format!("color = \"{c}\"")));
    assert_eq!(
        named.unwrap().objects[0].color,
        digits.unwrap().objects[0].color
    );
}
