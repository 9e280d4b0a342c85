//! What a profile seems to be: one warning for each fault, the same for drawings and pictures.

use crate::{holds, png};
use image::{GrayImage, Luma, Rgba, RgbaImage};
use revmap::profile::Profile;
use revmap_files::ProfileAxis::{self, Center, Left};
use revmap_files::{ProfileOptions, ProfileRead, profile_from_bytes};

const CASES: &str = include_str!("seeming.txt");
const VASE: &str = "M50 8h8c0 14-6 18-6 26c0 12 20 16 20 34c0 14-8 22-14 24h-16c-6-2-14-10-14-24c0-18 20-22 20-34c0-8-6-12-6-26z";
const HALF: &str = "M50 8h8c0 14-6 18-6 26c0 12 20 16 20 34c0 14-8 22-14 24h-8z";
const OPEN: &str = "M50 8h8c0 14-6 18-6 26c0 12 20 16 20 34c0 14-8 22-14 24h-8";
const BOTTLE: &str = "M42 5H58V30L70 50V95H30V50L42 30z";
const WHOLE: &str = "M40 20H60L54 45L70 80H30L46 45z";

/// A drawing of 100 x 100.
fn svg(body: &str) -> Vec<u8> {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>")
        .into_bytes()
}

fn path(d: &str, attributes: &str) -> Vec<u8> {
    svg(&format!("<path d='{d}' {attributes}/>"))
}

/// A drawing as a picture of `side` pixels: the colours of its body, black on white otherwise.
pub fn pictured(bytes: &[u8], side: u32) -> Vec<u8> {
    let drawing = profile_from_bytes(bytes, Left).unwrap();
    let half = revmap_files::raster::pictured(&drawing, side, side, 64).unwrap();
    let coverage = half.raster.unwrap().coverage;
    png(GrayImage::from_fn(side, side, |x, y| {
        Luma([(255.0 * (1.0 - coverage[(y * side + x) as usize])).round() as u8])
    }))
}

fn read(bytes: &[u8], axis: ProfileAxis) -> Profile {
    profile_from_bytes(bytes, axis).unwrap()
}

/// What is said of a profile: its warnings, or why it is refused.
fn said(bytes: &[u8], axis: ProfileAxis) -> String {
    let read = profile_from_bytes(bytes, axis);
    read.map_or_else(|e| e.to_string(), |p| p.warnings.join("\n"))
}

#[track_caller]
fn silent(bytes: &[u8], axis: ProfileAxis) {
    assert_eq!(read(bytes, axis).warnings, [""; 0]);
}

#[track_caller]
fn warned(bytes: &[u8], axis: ProfileAxis, words: &str) {
    let found = read(bytes, axis).warnings;
    assert_eq!(found.len(), 1, "{words}: {found:?}");
    holds(&found[0], words);
}

#[track_caller]
fn both_silent(drawing: &[u8], axis: ProfileAxis) {
    silent(drawing, axis);
    silent(&pictured(drawing, 300), axis);
}

#[track_caller]
fn case_holds(case: &str) {
    let names = [VASE, HALF, OPEN, BOTTLE, WHOLE].into_iter();
    let names = ["$VASE", "$HALF", "$OPEN", "$BOTTLE", "$WHOLE"]
        .into_iter()
        .zip(names);
    let text = names.fold(case.to_owned(), |text, (name, data)| {
        text.replace(name, data)
    });
    let (text, words) = text.split_once(" ! ").unwrap_or((&text, ""));
    let [axis, of, body] = *text.splitn(3, ' ').collect::<Vec<_>>() else {
        panic!("{case}");
    };
    let axis = match axis {
        "C" => Center,
        "L" => Left,
        number => number.parse().unwrap(),
    };
    let drawing = match body.starts_with("<svg") {
        true => body.as_bytes().to_vec(),
        false => svg(body),
    };
    let picture = |side| pictured(&drawing, side);
    let all = match of {
        "picture" => vec![picture(300)],
        "both" | "said" => vec![drawing.clone(), picture(300)],
        "kept" => vec![picture(300), picture(800)],
        _ => vec![drawing],
    };
    for bytes in all {
        match of {
            "said" | "contains" => holds(said(&bytes, axis), words),
            "refused" => {
                let refusal = profile_from_bytes(&bytes, axis).unwrap_err().to_string();
                holds(&refusal, words);
                let of_axis = [&refusal, words].map(|text| text.contains("profile_axis"));
                assert!(of_axis[0] == of_axis[1] || words == "is empty", "{refusal}");
            }
            "kept" => assert!(!said(&bytes, axis).contains("erase it")),
            _ if words.is_empty() => silent(&bytes, axis),
            _ => warned(&bytes, axis, words),
        }
    }
}

/// A file in place of a scene is read as the advice says that it gives otherwise.
#[test]
fn advice_is_followed() {
    let auto = ProfileOptions {
        read: ProfileRead::Auto,
        ..ProfileOptions::default()
    };
    let [half, aside] = [(HALF, -50.0), (BOTTLE, 12.0)]
        .map(|(d, x)| move |paint: &str| path(d, &format!("transform='translate({x})' {paint}")));
    let pale = "fill='#b0b0ff'";
    let lined = "fill='#b0b0ff' stroke='#000'";
    let cases = [
        (path(VASE, ""), path(VASE, ""), Center, vec![]),
        (half(""), half(""), Left, vec!["half a profile", "\"left\""]),
        (
            aside(""),
            aside(""),
            ProfileAxis::At(0.62),
            vec!["beside the axis", "= 0.62"],
        ),
        (
            path(VASE, pale),
            path(VASE, ""),
            Center,
            vec!["#b0b0ff, lighter", "but white"],
        ),
        (
            path(VASE, lined),
            path(VASE, "stroke='#000'"),
            Center,
            vec!["#b0b0ff"],
        ),
        (half(pale), half(""), Left, vec!["#b0b0ff", "\"left\""]),
    ];
    for (given, same, axis, words) in cases {
        let mut files = vec![(given.clone(), same.clone())];
        if given == same {
            files.push((pictured(&given, 300), pictured(&same, 300)));
        }
        for (given, same) in files {
            let found = profile_from_bytes(&given, auto).unwrap();
            assert_eq!(found.outline, read(&same, axis).outline, "{words:?}");
            assert_eq!(found.warnings, [""; 0], "{words:?}");
            assert_eq!(found.notes.is_empty(), words.is_empty());
            words
                .iter()
                .for_each(|words| holds(found.notes.join("\n"), words));
        }
    }
}

#[test]
fn drawings_and_pictures_seem_what_they_are() {
    let cases = CASES
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    for case in cases {
        println!("{case}");
        case_holds(case);
    }
}

#[test]
fn the_repositorys_files_bring_no_warning() {
    let files = |folder: &str| {
        let entries = std::fs::read_dir(crate::asset(folder)).unwrap();
        entries.map(|entry| entry.unwrap().path())
    };
    let all = ["gallery", "scenes"].into_iter().flat_map(files);
    for file in all.filter(|file| file.extension() == Some("toml".as_ref())) {
        let scene = revmap_files::scene(&file).unwrap();
        let found = revmap_files::warnings(&scene, 80, 60);
        assert!(found.is_empty(), "{}: {found:?}", file.display());
    }
}

/// Half profiles on the left border, hollow ones.
#[test]
fn hollow_halves_on_the_left_border_name_their_axis() {
    for name in ["vase", "plate", "jewel"] {
        let bytes = std::fs::read(crate::asset("gallery").join(format!("{name}.svg"))).unwrap();
        warned(&bytes, Center, "profile_axis = \"left\"");
        silent(&bytes, Left);
    }
}

/// A picture of 200 x 200 pixels on transparency, of the shades that `shade` gives.
fn cut_out(shade: impl Fn(u32, u32) -> Option<u8>) -> Vec<u8> {
    png(RgbaImage::from_fn(200, 200, |x, y| {
        shade(x, y).map_or(Rgba([0; 4]), |v| Rgba([v, v, v, 255]))
    }))
}

#[test]
fn cut_outs_are_outlines_or_have_another_form() {
    let lined = cut_out(|x, y| {
        let from = (f64::from(x) - 100.3).hypot(f64::from(y) - 100.0);
        (from < 73.0).then_some(if from < 70.0 { 255 } else { 0 })
    });
    let found = said(&lined, Center);
    holds(&found, "fill the shape");
    assert!(!found.contains("halves"), "{found}");
    let vase = |x: u32, y: u32| x.abs_diff(100) < 30 + y / 8 && (20..180).contains(&y);
    let shaded = cut_out(|x, y| vase(x, y).then_some(if x > 140 { 60 } else { 220 }));
    warned(&shaded, Center, "transparency has another form");
    // A dark band, and how many percent of the rest are taken.
    let banded = |shade: u8| {
        cut_out(|x, y| vase(x, y).then_some(if (85..120).contains(&y) { 20 } else { shade }))
    };
    warned(&banded(250), Center, "form: only the dark 2");
    silent(&banded(30), Center);
    let light = ProfileOptions {
        invert: true,
        ..ProfileOptions::default()
    };
    let found = profile_from_bytes(&banded(250), light).unwrap().warnings;
    assert!(
        found.len() == 1 && found[0].contains("only the light 7"),
        "{found:?}"
    );
}

#[test]
fn a_gap_beside_the_axis() {
    let polygon = |gap: f64| {
        let points = [[gap, 0.1], [0.3, 0.1], [0.15, 0.4], [0.25, 0.9], [gap, 0.9]];
        format!(
            "[camera]\neye = [2, 0, 0.5]\ntarget = [0, 0, 0.5]\n[[object]]\npolygon = {points:?}"
        )
    };
    let of_polygon = |gap| {
        let scene = revmap_files::SceneFile::parse(&polygon(gap), "")
            .unwrap()
            .scene(&[]);
        scene.unwrap().objects[0].profile.clone()
    };
    let drawing = |gap: f64| {
        let x = 100.0 * gap;
        read(&path(&format!("M{x} 10H25L15 60L30 90H{x}z"), ""), Left)
    };
    for gap in [5e-7, 1e-6, 1e-5, 2e-5] {
        for profile in [&*of_polygon(gap), &drawing(gap)] {
            assert_eq!(profile.outline.bounds().unwrap().r_min, 0.0, "{gap}");
            assert_eq!(profile.outline.surface_segments().count(), 4, "{gap}");
            assert_eq!(profile.warnings, [""; 0]);
        }
    }
    for gap in [1e-4, 1e-3, 5e-3] {
        for profile in [&*of_polygon(gap), &drawing(gap)] {
            assert_eq!(profile.warnings.len(), 1);
            holds(&profile.warnings[0], &format!("{gap} "));
        }
    }
    assert_eq!(of_polygon(0.02).warnings, [""; 0]);
}

/// Half a vase, half a cup and half a bolt, on the right of `x = 0` or on the left.
#[test]
fn halves_about_any_axis_are_given_it() {
    let vase = HALF.replace("M50 8", "M0 8");
    let cup = "M0 90H14C18 80 22 40 30 12H26C18 40 15 70 11 78H0z";
    let bolt = "M0 10H18V25H8V90H0z";
    let half = |form: &str, at: i32, side: i32| {
        let to = format!("transform='translate({at}) scale({side} 1)'");
        path(form, &to)
    };
    for form in [&vase, cup, bolt] {
        for (at, axis) in [(0, "\"left\""), (10, "0.1"), (30, "0.3"), (62, "0.62")] {
            let words = format!("axis; set profile_axis = {axis}");
            for bytes in [half(form, at, 1), pictured(&half(form, at, 1), 300)] {
                holds(said(&bytes, Center), &words);
                // The axis that is named is right.
                silent(&bytes, axis.parse().unwrap_or(Left));
            }
        }
        for (at, axis) in [(100, "\"left\""), (90, "0.1"), (70, "0.3"), (38, "0.62")] {
            let words = format!("mirror it, and set profile_axis = {axis}");
            for bytes in [half(form, at, -1), pictured(&half(form, at, -1), 300)] {
                holds(said(&bytes, Center), &words);
            }
        }
        // Half of a page, and nothing else of it.
        both_silent(&half(form, 50, 1), Center);
    }
}

/// A ball of one grey on another.
fn ball(solid: u8, ground: u8, noise: u8) -> Vec<u8> {
    png(GrayImage::from_fn(128, 128, |x, y| {
        let within = (f64::from(x) - 63.5).hypot(f64::from(y) - 63.5) < 40.0;
        let hash = (x * 131 + y * 7919).wrapping_mul(2_654_435_761) >> 16;
        let grey = if within { solid } else { ground };
        Luma([grey.saturating_add((hash % (u32::from(noise) + 1)) as u8)])
    }))
}

#[test]
fn low_contrast() {
    warned(&ball(0, 120, 16), Center, "profile_threshold = 0.2");
    warned(&ball(250, 120, 16), Center, "profile_threshold = 0.7");
    warned(&ball(250, 120, 16), Center, "profile_invert = true");
    for (solid, ground) in [(0, 255), (90, 160), (118, 255), (0, 140), (60, 190)] {
        silent(&ball(solid, ground, 0), Center);
    }
}

#[test]
fn centre_is_center() {
    assert_eq!("centre".parse(), Ok(Center));
    let scene = |axis: &str| {
        let text = format!(
            "[camera]\neye = [2, 0, 0.5]\ntarget = [0, 0, 0.5]\n[[object]]\nprofile = \"king.svg\"\nprofile_axis = \"{axis}\""
        );
        let mut file = revmap_files::SceneFile::parse(&text, crate::asset("profiles")).unwrap();
        file.scene(&[]).map(|scene| scene.objects[0].profile.radius)
    };
    assert_eq!(scene("centre").unwrap(), scene("center").unwrap());
    let refusal = scene("middle").unwrap_err().to_string();
    assert!(!refusal.contains("centre"), "{refusal}");
}
