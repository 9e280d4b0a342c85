//! Random files, and valid files with random faults: every reader accepts them or refuses them with
//! an error that names the file. None panics. Accepted files are used: profiles are baked.

use proptest::prelude::*;
use revmap::error::Error;
use revmap::maps::{BakeOptions, MapSource, ShapeMap, SlopeFilter};
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::Settings;
use revmap_files::{ProfileAxis, read_exr, write_exr, write_shape_map};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// A random change of a file; positions are fractions of its length.
#[derive(Clone, Debug)]
enum Fault {
    Byte(f64, u8),
    Bit(f64, u8),
    Cut(f64, usize),
    Repeat(f64, usize),
    Word(f64, &'static str),
    End(f64),
}

/// Words that are difficult for parsers.
const WORDS: &str = "1e9 1e-9 1e38 % px em url(#a) url(#e0) none inherit var(--a) <use href='#a'/> id='a' <g> </g> \
                     opacity='.5' transform='matrix(1e9,0,0,1e-9,0,0)' transform='scale(0)' clip-path='url(#c)' \
                     stroke-dasharray='1e-9' stroke-width='1e9' d='M0 0A1 1e9 0 1 1 5 5' A0 C viewBox='0 0 1e9 1' \
                     marker-mid='url(#m)' vector-effect='non-scaling-stroke' :nth-child(-n) @media ; fill='#fff' \
                     stroke='#000' nan inf -inf 1e308 -1e-320 1e999 0 -1 4294967296 18446744073709551616 \" ' [ ]] { \
                     = , \u{0} \u{feff} é ../../x";

fn faults() -> impl Strategy<Value = Vec<Fault>> {
    let words: Vec<&str> = WORDS.split(' ').chain(["\n"]).collect();
    let fault = prop_oneof![
        (0.0..1.0, any::<u8>()).prop_map(|(at, to)| Fault::Byte(at, to)),
        (0.0..1.0, 0u8..8).prop_map(|(at, bit)| Fault::Bit(at, bit)),
        (0.0..1.0, 1usize..40).prop_map(|(at, n)| Fault::Cut(at, n)),
        (0.0..1.0, 1usize..40).prop_map(|(at, n)| Fault::Repeat(at, n)),
        (0.0..1.0, prop::sample::select(words)).prop_map(|(at, word)| Fault::Word(at, word)),
        (0.0..1.0).prop_map(Fault::End),
    ];
    prop::collection::vec(fault, 1..6)
}

fn damaged(sound: &[u8], faults: &[Fault]) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for fault in faults {
        let length = bytes.len();
        let place = |at: f64| ((at * length as f64) as usize).min(length.saturating_sub(1));
        let range = |at: f64, n: usize| place(at)..(place(at) + n).min(length);
        match *fault {
            _ if bytes.is_empty() => {}
            Fault::Byte(at, to) => bytes[place(at)] = to,
            Fault::Bit(at, bit) => bytes[place(at)] ^= 1 << bit,
            Fault::Cut(at, n) => drop(bytes.drain(range(at, n))),
            Fault::Repeat(at, n) => {
                let part = bytes[range(at, n)].to_vec();
                bytes.splice(place(at)..place(at), part);
            }
            Fault::Word(at, word) => {
                // Replaces the text between two separators, such as a number.
                let begin = place(at);
                let stays = |b: &u8| b.is_ascii_alphanumeric() || b"+-._".contains(b);
                let end = begin + bytes[begin..].iter().take_while(|b| stays(b)).count();
                bytes.splice(begin..end, word.bytes());
            }
            Fault::End(at) => bytes.truncate(place(at)),
        }
    }
    bytes
}

/// Small valid files of each kind, in a folder of their own.
static SOUND: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let ball = |x, y| (x as i32 - 9).pow(2) * 3 + (y as i32 - 13).pow(2) < 130;
    let grey = |x, y| image::Luma([if ball(x, y) { 20u8 } else { 230 }]);
    let picture = image::ImageBuffer::from_fn(18, 26, grey);
    picture.save(at("grey.png")).unwrap();
    let color = |x, y| image::Rgba([x as u8 * 30, y as u8 * 40, 90, 200]);
    let picture = image::ImageBuffer::from_fn(7, 5, color);
    picture.save(at("colours.png")).unwrap();
    let height = |x, y| image::Luma([(x * y * 900) as u16]);
    let picture = image::ImageBuffer::from_fn(9, 9, height);
    picture.save(at("heights.png")).unwrap();
    image::GrayImage::from_fn(24, 16, |x, _| image::Luma([x as u8 * 10]))
        .save(at("grey.jpg"))
        .unwrap();
    for name in ["progressive.jpg", "restarts.jpg"] {
        let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
        std::fs::copy(inputs.join(name), at(name)).unwrap();
    }
    std::fs::write(at("vase.svg"), SVG).unwrap();
    std::fs::write(at("copies.csv"), CSV).unwrap();
    std::fs::write(at("scene.toml"), TOML).unwrap();
    let triangle = [[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]];
    let profile = Arc::new(Profile::polygon(&triangle, 0.5).unwrap());
    let map = ShapeMap::bake(&profile, &options(&profile)).unwrap();
    write_shape_map(&map, at("map.png")).unwrap();
    write_shape_map(&map, at("map.exr")).unwrap();
    let mut scene = Scene::new(Camera::new([2.0, 0.0, 0.5].into(), [0.0, 0.0, 0.5].into()));
    scene.objects.push(Object::new("cone", profile));
    let settings = Settings {
        width: 5,
        height: 4,
        ..Settings::default()
    };
    let frame = revmap_reference::draw(&scene, &settings, &|_, _| {}).unwrap();
    write_exr(&frame, at("frame.exr")).unwrap();
    folder
});

static DRAWINGS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(crate::drawings::seeds);

const SVG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 60" width="40" height="60">
<defs><linearGradient id="g"><stop offset="0" stop-color="#000"/></linearGradient></defs>
<g transform="translate(1 2) rotate(3)"><path d="M10 55 C 2 40 18 30 14 5 L 26 5 A 20 25 0 0 1 30 55 Z" fill="url(#g)"/></g>
<circle cx="20" cy="20" r="6" fill="white"/><rect x="5" y="50" width="30" height="5" stroke="black" stroke-width="1.5"/>
<polyline points="3,3 9,9 3,12" stroke="#123" fill="none" stroke-dasharray="2 1"/></svg>"##;
const CSV: &str =
    "x,y,z,qx,qy,qz,qw,sx,sy,sz\n0,0,0,0,0,0,1,1,1,1\n# two\n1.5,-2,0.25,0,0,0.7,0.7,2,1e-1,3\n";
const TOML: &str = r#"background = [0.1, 0.2, 0.3, 1.0]
shadow = "soft"
[camera]
eye = [1.6, 0.3, 1.1]
target = [0.0, 0.0, 0.5]
fov_y = 40.0
[[light]]
direction = [-0.4, -0.6, -0.7]
[[object]]
profile = "grey.png"
profile_axis = "left"
profile_smooth = 0.7
color_map = "colours.png"
height_map = "heights.png"
map_rows = 32
extend = 0.02
bevel = 0.1
chamfer = 0.4
repeat = [2, 1, 3]
mirror = [true, false, true]
instances = "copies.csv"
[[object]]
polygon = [[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]]
radius = 0.5
rotation = [0.0, 0.0, 0.1, 1.0]
scale = [1.0, 2.0, 3.0]
clip = "box"
"#;

fn options(profile: &Profile) -> BakeOptions {
    BakeOptions {
        source: MapSource::EXACT,
        rows: 12,
        reach: profile.radius,
    }
}

fn read_profile(file: &Path) -> Result<(), Error> {
    let profile = revmap_files::profile(file, ProfileAxis::Center)?;
    // Slender boxes are refused here, without a file name.
    let _ = ShapeMap::bake(&profile, &options(&profile));
    Ok(())
}

fn read_scene(file: &Path) -> Result<(), Error> {
    let _ = revmap_files::warnings(&revmap_files::scene(file)?, 80, 60);
    Ok(())
}

type Reader = fn(&Path) -> Result<(), Error>;

const READ_MAP: Reader = |file| revmap_files::shape_map(file).map(drop);
const READ_COLOURS: Reader = |file| revmap_files::color_map(file).map(drop);
const READ_HEIGHTS: Reader =
    |file| revmap_files::displacement_map(file, SlopeFilter::default()).map(drop);
const READ_FRAME: Reader = |file| read_exr(file).map(drop);

/// No file of a few kilobytes takes longer to read.
const MOST_TIME: Duration = Duration::from_secs(10);

/// Each valid file with its reader.
const READERS: [(&str, Reader); 14] = [
    ("vase.svg", read_profile),
    ("grey.png", read_profile),
    ("grey.jpg", read_profile),
    ("scene.toml", read_scene),
    ("copies.csv", read_scene),
    ("map.png", READ_MAP),
    ("map.exr", READ_MAP),
    ("colours.png", READ_COLOURS),
    ("grey.jpg", READ_COLOURS),
    ("heights.png", READ_HEIGHTS),
    ("frame.exr", READ_FRAME),
    ("vase.svg", read_scene),
    ("progressive.jpg", read_profile),
    ("restarts.jpg", READ_HEIGHTS),
];

/// Reads `bytes` in place of a valid file, beside the files that it may name.
fn read(name: &str, reader: Reader, bytes: &[u8]) -> Result<(), Error> {
    let folder = tempfile::tempdir().unwrap();
    if name.ends_with("toml") || name.ends_with("csv") {
        let beside = "grey.png colours.png heights.png copies.csv scene.toml";
        for other in beside.split(' ') {
            std::fs::copy(SOUND.path().join(other), folder.path().join(other)).unwrap();
        }
    }
    let file = folder.path().join(name);
    std::fs::write(&file, bytes).unwrap();
    // Copies are read by the scene that names them.
    let scene = folder.path().join("scene.toml");
    let asked = if name == "copies.csv" { scene } else { file };
    let begin = Instant::now();
    let outcome = reader(&asked);
    assert!(begin.elapsed() < MOST_TIME, "{name}: {:?}", begin.elapsed());
    outcome.inspect_err(|error| {
        let within = |named: &PathBuf| named.starts_with(folder.path());
        let named = error.file.as_ref().is_some_and(within);
        assert!(named, "{name}: no file is named: {error}");
        assert!(!error.message.contains('\n'), "{name}: {error}");
    })
}

#[test]
fn sound_files_are_read() {
    for (name, reader) in READERS {
        let bytes = std::fs::read(SOUND.path().join(name)).unwrap();
        read(name, reader, &bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

/// Files that would use up all memory are refused by the size in their header.
#[test]
fn promises_that_no_file_keeps_are_refused() {
    let refused = |name, reader: Reader, bytes: &[u8], words: &str| {
        let error = read(name, reader, bytes).unwrap_err().to_string();
        assert!(error.contains(words), "{name}: {error}");
    };
    let far = SVG.replace("C 2 40", "C 2e30 40");
    refused("vase.svg", read_profile, far.as_bytes(), "times its height");
    let dashed = SVG.replace("2 1\"", "1e-9 1e-9\"");
    refused("vase.svg", read_profile, dashed.as_bytes(), "dashes");
    for (name, reader) in [("frame.exr", READ_FRAME), ("map.exr", READ_MAP)] {
        let mut bytes = std::fs::read(SOUND.path().join(name)).unwrap();
        let window = b"dataWindow\0box2i\0\x10\0\0\0";
        let found = bytes.windows(window.len()).position(|w| w == window);
        let at = found.unwrap() + window.len();
        for (side, last) in [(8, 15_999i32), (12, 7_999)] {
            bytes[at + side..at + side + 4].copy_from_slice(&last.to_le_bytes());
        }
        refused(name, reader, &bytes, "cannot hold the 16000 x 8000 pixels");
        bytes[at + 8..at + 12].copy_from_slice(&1_000_000i32.to_le_bytes());
        refused(name, reader, &bytes, "16384 x 16384 is the most");
    }
}

/// A PNG whose header promises more pixels than any picture has is refused without decoding.
#[test]
fn large_pictures_are_refused_by_their_header() {
    let mut png = std::fs::read(SOUND.path().join("grey.png")).unwrap();
    png[16..20].copy_from_slice(&20_000u32.to_be_bytes());
    png[20..24].copy_from_slice(&20_000u32.to_be_bytes());
    let sum = crc(&png[12..29]).to_be_bytes();
    png[29..33].copy_from_slice(&sum);
    let error = read("grey.png", read_profile, &png).unwrap_err();
    assert!(error.message.contains("20000 x 20000"), "{error}");
}

/// Each chunk gets a valid checksum, so that faults pass the decoder's first check.
fn damaged_png(sound: &[u8], chunk: usize, faults: &[Fault]) -> Vec<u8> {
    let (signature, mut rest) = sound.split_at(8);
    let mut bytes = signature.to_vec();
    let mut number = 0;
    while let Some((head, tail)) = rest.split_at_checked(8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let mut data = tail[..length].to_vec();
        if number == chunk {
            data = damaged(&data, faults);
        }
        bytes.extend((data.len() as u32).to_be_bytes());
        bytes.extend(&head[4..]);
        bytes.extend(&data);
        bytes.extend(crc(&[&head[4..], &data].concat()).to_be_bytes());
        rest = &tail[length + 4..];
        number += 1;
    }
    bytes
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |s, _| {
            (s >> 1) ^ if s & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn files_with_faults_are_read_or_refused(which in 0..READERS.len(), faults in faults()) {
        let (name, reader) = READERS[which];
        let sound = std::fs::read(SOUND.path().join(name)).unwrap();
        let _ = read(name, reader, &damaged(&sound, &faults));
    }

    #[test]
    fn drawings_with_faults_are_drawn_or_refused(which in 0usize..1 << 16, faults in faults()) {
        let bytes = damaged(&DRAWINGS[which % DRAWINGS.len()], &faults);
        let begin = Instant::now();
        let axis = [ProfileAxis::Left, ProfileAxis::Center][which % 2];
        let _ = revmap_files::profile_from_bytes(&bytes, axis);
        prop_assert!(begin.elapsed() < 6 * MOST_TIME, "{}", String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn pictures_with_faults_within_are_read_or_refused(
        which in prop::sample::select(vec![1usize, 5, 7, 9]), chunk in 0usize..3, faults in faults(),
    ) {
        let (name, reader) = READERS[which];
        let sound = std::fs::read(SOUND.path().join(name)).unwrap();
        let _ = read(name, reader, &damaged_png(&sound, chunk, &faults));
    }

    #[test]
    fn noise_is_refused(
        which in 0..READERS.len(),
        start in prop::sample::select(vec![&b""[..], b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"v/1\x01", b"<svg", b"\x1f\x8b\x08"]),
        noise in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let (name, reader) = READERS[which];
        let taken = read(name, reader, &[start, &noise].concat());
        prop_assert!(taken.is_err() || name.ends_with("toml") || name.ends_with("csv"), "{name}");
    }
}
