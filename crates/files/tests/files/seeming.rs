//! What a profile seems to be: one warning for each fault, the same for drawings and pictures.

use crate::holds;
use image::{GrayImage, Luma, Rgba, RgbaImage};
use revmap::profile::Profile;
use revmap_files::ProfileAxis::{self, Center, Left};
use revmap_files::profile_from_bytes;

const VASE: &str = "M50 8h8c0 14-6 18-6 26c0 12 20 16 20 34c0 14-8 22-14 24h-16c-6-2-14-10-14-24c0-18 20-22 20-34c0-8-6-12-6-26z";
const HALF: &str = "M50 8h8c0 14-6 18-6 26c0 12 20 16 20 34c0 14-8 22-14 24h-8z";
const OPEN_HALF: &str = "M50 8h8c0 14-6 18-6 26c0 12 20 16 20 34c0 14-8 22-14 24h-8";

/// A drawing of 100 x 100.
fn svg(body: &str) -> Vec<u8> {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>")
        .into_bytes()
}

fn path(d: &str, attributes: &str) -> Vec<u8> {
    svg(&format!("<path d='{d}' {attributes}/>"))
}

fn png(picture: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let picture = picture.into();
    picture.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
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

fn refusal(bytes: &[u8]) -> String {
    profile_from_bytes(bytes, Center).unwrap_err().to_string()
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

/// Wants the warning of a drawing and of its picture.
#[track_caller]
fn both_warned(drawing: &[u8], axis: ProfileAxis, words: &str) {
    warned(drawing, axis, words);
    warned(&pictured(drawing, 300), axis, words);
}

#[track_caller]
fn both_silent(drawing: &[u8], axis: ProfileAxis) {
    silent(drawing, axis);
    silent(&pictured(drawing, 300), axis);
}

#[test]
fn usual_forms_bring_no_warning() {
    both_silent(&path(VASE, ""), Center);
    both_silent(&path(HALF, "transform='translate(-50)'"), Left);
    // A tube and a torus beside the axis, a cup, a needle.
    both_silent(&svg("<circle cx='50' cy='50' r='20'/>"), Left);
    for (form, axis) in [
        ("M30 10h30v80h-30z", Left),
        ("M20 10h4v70h52v-70h4v80h-60z", Center),
        ("M0 5h1l40 80h-41z", Left),
        // A conical and a round hollow end on the axis.
        ("M0 40L30 10H40V90H0z", Left),
        ("M0 60A30 30 0 0 0 30 30V10H40V90H0z", Left),
    ] {
        both_silent(&path(form, ""), axis);
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

#[test]
fn outlines_in_place_of_shapes() {
    for width in ["0.4", "1", "3"] {
        let line = format!("fill='none' stroke='#000' stroke-width='{width}'");
        for form in [VASE, HALF, OPEN_HALF] {
            both_warned(&path(form, &line), Center, "fill the shape");
        }
        let moved = format!("{line} transform='translate(-50)'");
        for form in [HALF, OPEN_HALF] {
            both_warned(&path(form, &moved), Left, "fill the shape");
        }
    }
    let thick = "fill='none' stroke='#000' stroke-width='6'";
    both_warned(&path("M20 12H80V88H20z", thick), Center, "fill the shape");
    let light = "fill='#ddd' stroke='#000' stroke-width='1'";
    let lined = pictured(&path(VASE, light), 300);
    warned(&lined, Center, "fill the shape");
    let dashed = "fill='none' stroke='#000' stroke-width='1' stroke-dasharray='4 3'";
    both_warned(&path(VASE, dashed), Center, "fill the shape");
    let centre_line = "<path d='M50 2V98' stroke='#000' stroke-dasharray='6 2 1 2'/>";
    let half = format!("<path d='{OPEN_HALF}' fill='none' stroke='#000'/>{centre_line}");
    warned(&svg(&half), Center, "fill the shape");
}

#[test]
fn a_white_cut_out_with_a_black_line_is_an_outline() {
    let picture = RgbaImage::from_fn(200, 200, |x, y| {
        let from = (f64::from(x) - 100.3).hypot(f64::from(y) - 100.0);
        match from {
            ..70.0 => Rgba([255, 255, 255, 255]),
            70.0..73.0 => Rgba([0, 0, 0, 255]),
            _ => Rgba([0; 4]),
        }
    });
    let found = said(&png(picture), Center);
    holds(&found, "fill the shape");
    assert!(!found.contains("halves"), "{found}");
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

#[test]
fn a_seam_between_two_shapes() {
    let stacked = |gap: f64| {
        let from = 50.0 + gap;
        svg(&format!(
            "<path d='M0 10H25V50H0z'/><path d='M0 {from}H30V90H0z'/>"
        ))
    };
    for gap in [3e-4, 3e-2] {
        warned(&stacked(gap), Left, "are 0.0");
    }
    for gap in [0.0, -0.1, 2.0] {
        silent(&stacked(gap), Left);
    }
    let beside = svg("<path d='M0 10H25V50H0z'/><path d='M25.001 20H30V90H25.001z'/>");
    warned(&beside, Left, "are 0.00001");
}

#[test]
fn silhouettes_that_are_not_as_the_axis_wants() {
    let page = "<path d='M0 0H100V100H0z'/>";
    let light = svg(&format!("{page}<path fill='#fff' d='{VASE}'/>"));
    both_warned(&light, Center, "light solid on dark");
    both_warned(&path(VASE, ""), Left, "profile_axis = \"center\"");
    for degrees in [2, 5, -5] {
        let tilted = path(VASE, &format!("transform='rotate({degrees} 50 50)'"));
        both_warned(&tilted, Center, "tilted by ");
    }
    for side in [1, -1] {
        let turned = format!("transform='translate(50) scale({side} 1) translate(-50)'");
        let handle =
            "<path d='M68 55C90 50 90 84 66 82' fill='none' stroke='#000' stroke-width='4'/>";
        let jug = format!("<g {turned}><path d='{VASE}'/>{handle}</g>");
        both_warned(&svg(&jug), Center, "on one side alone");
    }
    let moved = path(VASE, "transform='translate(8)'");
    both_warned(&moved, Center, "profile_axis = 0.58");
}

#[test]
fn halves_and_lying_solids() {
    for (form, to, axis, words) in [
        (HALF, "translate(150) scale(-1 1)", Left, "mirror it"),
        (HALF, "translate(-20)", Center, "profile_axis = 0.3"),
        (VASE, "rotate(90 50 50)", Center, "on its side"),
    ] {
        both_warned(&path(form, &format!("transform='{to}'")), axis, words);
    }
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
    // In the middle of a page that is read from its left edge.
    both_warned(&half(&vase, 39, 1), Left, "set profile_axis = 0.39");
    let mirror = "mirror it, and set profile_axis = 0.39";
    both_warned(&half(&vase, 61, -1), Left, mirror);
    both_silent(&half(&vase, 20, 1), Left);
}

#[test]
fn a_half_on_its_side_is_to_be_turned() {
    let flat = |d: &str| {
        let head = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 40'>";
        format!("{head}<path d='{d}'/></svg>").into_bytes()
    };
    let spindle = "M10 40V30H40C50 30 50 15 70 15S90 32 120 32 140 22 160 22 185 34 190 36V40Z";
    let hanging = "M10 0V10H40C50 10 50 25 70 25S90 8 120 8 140 18 160 18 185 6 190 4V0Z";
    // Alike at both ends, it may be a dome, unless it ends at the border of the page.
    let barrel = "M20 40H180V30C170 15 120 10 100 10S30 15 20 30z";
    for (form, axis, edge) in [
        (spindle, Center, "lower"),
        (spindle, Left, "lower"),
        (hanging, Center, "upper"),
        (barrel, Center, "lower"),
    ] {
        let words = format!("straight {edge} edge is the axis; turn it upright");
        warned(&flat(form), axis, &words);
    }
    // A plate and domes are upright.
    let plate = "M0 40H180V34L60 30L30 20H0z";
    let dome = "M20 38H180C170 20 120 10 100 10S30 20 20 38z";
    let cropped = "M0 40H200C170 20 120 0 100 0S30 20 0 40z";
    for (upright, axis) in [(plate, Left), (dome, Center), (cropped, Center)] {
        silent(&flat(upright), axis);
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
fn a_solid_well_off_the_axis_is_given_its_axis() {
    let moved = |by: i32, attributes: &str| {
        path(VASE, &format!("transform='translate({by})' {attributes}"))
    };
    let line = "fill='none' stroke='#000' stroke-width='1'";
    for (by, axis) in [(25, "0.75"), (-18, "0.32")] {
        let words = format!("profile_axis = {axis},");
        both_warned(&moved(by, ""), Center, &words);
        both_warned(&moved(by, line), Center, &words);
    }
    let drawing = moved(-30, "");
    for bytes in [&drawing, &pictured(&drawing, 300)] {
        holds(refusal(bytes), "profile_axis = 0.2");
    }
    // A part of it is left of the page.
    holds(refusal(&moved(-36, "")), "profile_axis = 0.14,");
}

#[test]
fn a_drawing_that_the_page_cuts() {
    let moved = |x: i32, y: i32| path(VASE, &format!("transform='translate({x} {y})'"));
    warned(&moved(0, -20), Center, "cut by the top edge of the page");
    warned(&moved(0, 20), Center, "cut by the bottom edge of the page");
    for words in ["profile_axis = 0.86,", "cut by the right edge of the page"] {
        holds(said(&moved(36, 0), Center), words);
    }
    // A line along the edge, a solid up to the edge, and what lies beside the page are not cut.
    let edge = "<path d='M20 40H80V100H20z' stroke='#000' stroke-width='.8'/>";
    let beside =
        "<path d='M120 20h20v60h-20zM30-40h30v30h-30z'/><path d='M-9-9H200V200H-9z' fill='none'/>";
    silent(&svg(&format!("{edge}{beside}")), Center);
    let page = "<path d='M-50-50H150V150H-50z' fill='#fff'/>";
    silent(&svg(&format!("{page}{edge}")), Center);
}

#[test]
fn a_light_label_is_a_closed_hollow() {
    let below = |paint: &str| svg(&format!("<path d='{VASE}'/>{paint}"));
    let label = below("<path d='M36 56H64V72H36z' fill='#f5f0e0'/>");
    both_warned(&label, Center, "a closed hollow");
    let line = below("<path d='M38 54H62' stroke='#fff' stroke-width='.4'/>");
    silent(&line, Center);
}

#[test]
fn pale_paint_is_named() {
    let lined = path(VASE, "fill='#8fd0a0' stroke='#000' stroke-width='.5'");
    let words = "darkest fill is #8fd0a0, lighter than one half";
    warned(&lined, Center, words);
    for (attributes, words) in [
        ("fill='#8fd0a0'", "fill is #8fd0a0"),
        ("fill='none' stroke='#888'", "stroke is #888888"),
    ] {
        let refusal = refusal(&path(VASE, attributes));
        holds(&refusal, &format!("darkest {words}, lighter"));
        assert!(!refusal.contains("profile_axis"), "{refusal}");
    }
    holds(refusal(&path(VASE, "fill='#fff'")), "is empty");
}

#[test]
fn a_shaded_cut_out_is_named_alone() {
    let picture = RgbaImage::from_fn(200, 200, |x, y| {
        let shade = if x > 140 { 60 } else { 220 };
        match (x.abs_diff(100) < 30 + y / 8, y) {
            (true, 20..180) => Rgba([shade, shade, shade, 255]),
            _ => Rgba([0; 4]),
        }
    });
    warned(&png(picture), Center, "transparency has another form");
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
