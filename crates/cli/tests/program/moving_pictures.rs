//! `revmap animate`: moving pictures, read again, and how things move in them.

use crate::run::{Bench, CAMERA, CONE, SVG, holds, lines, table};
use std::fs::File;
use std::io::BufReader;

const SMALL: &str = "animate scene.toml --size 48x36 --frames 6";

/// Frames in RGBA, and when each ends, milliseconds.
type Read = Vec<(u32, Vec<u8>)>;

fn read_gif(bench: &Bench, name: &str) -> (Read, gif::Repeat) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let file = File::open(bench.path(name)).unwrap();
    let mut decoder = options.read_info(file).unwrap();
    let (mut frames, mut canvas, mut end) = (Vec::new(), Vec::new(), 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!((frame.width, frame.height), (48, 36));
        canvas.resize(frame.buffer.len(), 0);
        for (old, new) in canvas.chunks_exact_mut(4).zip(frame.buffer.chunks_exact(4)) {
            if new[3] != 0 {
                old.copy_from_slice(new);
            }
        }
        end += 10 * u32::from(frame.delay);
        frames.push((end, canvas.clone()));
    }
    (frames, decoder.repeat())
}

fn read_webp(bench: &Bench, name: &str) -> Read {
    let bytes = bench.read(name);
    let decoder = webp_animation::Decoder::new(&bytes).unwrap();
    assert_eq!(decoder.dimensions(), (48, 36));
    let frame = |f: webp_animation::Frame| (f.timestamp() as u32, f.data().to_vec());
    decoder.into_iter().map(frame).collect()
}

fn read_apng(bench: &Bench, name: &str) -> (Read, png::AnimationControl) {
    let file = BufReader::new(File::open(bench.path(name)).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    let mut end = 0.0;
    let frame = |_| {
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let shown = reader.info().frame_control().unwrap();
        end += 1e3 * f64::from(shown.delay_num) / f64::from(shown.delay_den);
        (end as u32, bytes)
    };
    ((0..control.num_frames).map(frame).collect(), control)
}

#[test]
fn moving_pictures_show_the_frames_of_a_folder() {
    let bench = Bench::new();
    let animate = |options: &str| {
        bench.done(&format!("{SMALL} --vary object.0.extend=0:0.1 {options}"));
    };
    let opaque = "--set background=[0.2,0.3,0.4,1]";
    animate(&format!("-o folder --samples adaptive {opaque}"));
    let folder: Vec<Vec<u8>> = (0..6)
        .map(|n| {
            bench
                .picture(&format!("folder/frame-000{n}.png"))
                .into_raw()
        })
        .collect();
    animate(&format!("-o a.gif --fps 7 --loops 3 {opaque}"));
    animate(&format!("-o a.webp --fps 7 --quality 100 {opaque}"));
    animate(&format!("-o lossy.webp --fps 7 {opaque}"));
    animate(&format!("-o a.apng --fps 7 --loops 3 {opaque}"));

    let (apng, control) = read_apng(&bench, "a.apng");
    assert_eq!((apng.len(), control.num_plays), (6, 3));
    for ((end, frame), wanted) in apng.iter().zip(&folder) {
        let colors = wanted.chunks_exact(4).flat_map(|p| &p[..3]);
        assert!(frame.iter().eq(colors), "{end}");
    }
    assert_eq!(apng[5].0, 857);
    let webp = read_webp(&bench, "a.webp");
    assert!(webp.iter().map(|(_, f)| f).eq(&folder));
    assert_eq!(webp[5].0, 857);
    let (gif, repeat) = read_gif(&bench, "a.gif");
    let twice = gif::Repeat::Finite(2);
    assert_eq!((gif.len(), gif[5].0, repeat), (6, 860, twice));
    let mean = |read: &[(u32, Vec<u8>)]| {
        let frames = read.iter().zip(&folder);
        let pairs = frames.flat_map(|((_, a), b)| a.iter().zip(b));
        let off: u32 = pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
        f64::from(off) / (6 * 48 * 36 * 4) as f64
    };
    let (lossy, gif) = (mean(&read_webp(&bench, "lossy.webp")), mean(&gif));
    assert!(lossy > 0.0 && lossy < 2.0 && gif < 1.0, "{lossy} {gif}");
    animate(&format!("-o once.gif --loops 1 {opaque}"));
    animate(&format!("-o ever.gif {opaque}"));
    assert_eq!(read_gif(&bench, "once.gif").1, gif::Repeat::Finite(0));
    assert_eq!(read_gif(&bench, "ever.gif").1, gif::Repeat::Infinite);
}

#[test]
fn a_film_that_stands_still_is_named_with_what_moves() {
    let bench = Bench::new();
    bench.grey("rings.png", 8, 8, |_, y| 30 * y as u8);
    bench.grey("sides.png", 8, 8, |x, _| 30 * x as u8);
    bench.file("a.svg", SVG);
    bench.file(
        "aside.toml",
        format!("{CAMERA}{CONE}position = [0.2, 0, 0]\n"),
    );
    let film = "animate --size 64x48 --frames 6 --overwrite --background white";
    let remedies = ["color_map", "--bounce", "without --turntable"];
    for row in table(
        "scene.toml --turntable                | color_map | --bounce | without --turntable
         a.svg --turn 360 --turntable          | color_map | --bounce | without --turntable
         a.svg --turn 360 --turntable --studio | color_map | --bounce
         a.svg --turn 360 --studio             | color_map | --bounce
         a.svg --turn 360 --turntable --set object.0.color_map=rings.png | --bounce | without --turntable
         a.svg --turn 2160                     | whole turns
         a.svg --vary object.0.chamfer=0.1:0.9 | object.0.chamfer",
    ) {
        let (arguments, words) = (row[0], &row[1..]);
        for output in ["a.gif", "a.webp", "a.apng", "frames"] {
            let found = bench.warned(&format!("{film} {arguments} -o {output}"));
            assert_eq!(found.len(), 1, "{arguments} {output}: {found:?}");
            for word in remedies.iter().chain(words) {
                let wanted = words.contains(word);
                assert_eq!(found[0].contains(word), wanted, "{word}: {found:?}");
            }
        }
    }
    for row in table(
        "scene.toml --turn 360 --turntable --set object.0.color_map=sides.png
         scene.toml --turn 360
         scene.toml --turn 360 --turntable --vary object.0.extend=0:0.02
         scene.toml --turn 360 --turntable --vary object.0.extend=0:0.02 --studio
         aside.toml --turn 360 --turntable
         aside.toml --turn 360 --turntable --studio
         scene.toml --vary object.0.extend=0:0.02",
    ) {
        for output in ["a.webp", "frames"] {
            let found = bench.warned(&format!("{film} {} -o {output}", row[0]));
            assert!(found.is_empty(), "{row:?}: {found:?}");
        }
    }
}

/// The last line is for who asked for the film; what it cost is said with `--verbose`.
#[test]
fn the_end_says_frames_length_and_size() {
    let bench = Bench::new();
    let opaque = "--set background=[1,1,1,1]";
    let said = |options: &str| bench.said(&format!("{SMALL} {opaque} {options}"));
    let there = "--vary object.0.extend=0:0.1 --bounce --fps 10";
    for (options, wanted) in [
        ("--turn 360", "6 frames, 0.2 s a turn, "),
        ("--turn 90 --fps 2", "6 frames, 3.0 s, "),
        (there, "6 frames, 0.6 s there and back, "),
    ] {
        let line = said(&format!("{options} -o a.webp"));
        let rest = line.strip_prefix(wanted).expect(&line);
        let (size, file) = rest.trim_end().split_once(": ").unwrap();
        assert_eq!(file, "a.webp");
        let bytes = bench.read("a.webp").len() as f64;
        let told: f64 = match size.split_once(' ').unwrap() {
            (n, "KB") => 1e3 * n.parse::<f64>().unwrap(),
            (n, _) => n.parse().unwrap(),
        };
        assert!((told - bytes).abs() <= 500.0, "{size} for {bytes}");
    }
    assert_eq!(said("--turn 90 -o f"), "6 frames: f\n");
    assert!(said("--turn 90").contains("6 frames, median "));
    let costs = |options: &str| {
        let output = bench.done(&format!("{SMALL} {opaque} --turn 90 -o a.webp {options}"));
        let tells =
            |l: &String| l.contains("pipelines compiled: ") && l.contains("surfaces made: ");
        lines(&output).iter().any(tells)
    };
    assert!(costs("--verbose") && !costs(""));
}

/// The light of the studio stays with the camera, so no half of a turn is dark.
#[test]
fn a_turn_in_the_studio_is_evenly_bright() {
    let bench = Bench::new();
    let film = "--size 64x48 --frames 6 --studio --overwrite --set object.0.color=[0.8,0.05,0.05]";
    for turn in ["--turn 360", "--turn 360 --turntable"] {
        bench.done(&format!("animate scene.toml {turn} {film} -o frames"));
        let mean = |n: u32| {
            let picture = bench.picture(&format!("frames/frame-000{n}.png"));
            let solid = picture.pixels().filter(|p| p.0[0] / 2 > p.0[1]);
            let red: Vec<u32> = solid.map(|p| u32::from(p.0[0])).collect();
            assert!(red.len() > 200, "{}", red.len());
            f64::from(red.iter().sum::<u32>()) / red.len() as f64
        };
        let means: Vec<f64> = (0..6).map(mean).collect();
        let bright = means.iter().fold(0.0, |most: f64, m| most.max(*m));
        let even = means.iter().all(|m| *m > 0.97 * bright);
        assert!(even, "{turn}: {means:?}");
    }
}

/// Browsers show a frame of 10 ms or less for 100 ms.
#[test]
fn the_fastest_rate_has_no_frame_of_ten_milliseconds() {
    let bench = Bench::new();
    let turn = "animate scene.toml --size 48x36 --frames 100 --turn 90 --set background=[1,1,1,1]";
    bench.done(&format!("{turn} --fps 50 -o a.gif"));
    bench.done(&format!("{turn} --fps 90 -o a.webp --quality 100"));
    bench.done(&format!("{turn} --fps 90 -o a.apng"));
    let all = [
        read_gif(&bench, "a.gif").0,
        read_webp(&bench, "a.webp"),
        read_apng(&bench, "a.apng").0,
    ];
    for frames in all {
        let mut start = 0;
        for (end, _) in frames {
            assert!(end - start > 10, "{start} to {end} ms");
            start = end;
        }
    }
}

#[test]
fn edges_stay_soft_or_get_a_ground() {
    let bench = Bench::new();
    let said = lines(&bench.done(&format!("{SMALL} --turn 90 -o a.gif"))).join("\n");
    holds(&said, &["background", "white"]);
    let (gif, _) = read_gif(&bench, "a.gif");
    let corner = |frame: &[u8]| frame[..4].to_vec();
    assert_eq!(corner(&gif[3].1), [255, 255, 255, 255]);
    let said = lines(&bench.done(&format!("{SMALL} --turn 90 -o a.webp --quality 100"))).join("\n");
    assert!(!said.contains("white"), "{said}");
    bench.done(&format!("{SMALL} --turn 90 -o a.apng"));
    let all = [read_webp(&bench, "a.webp"), read_apng(&bench, "a.apng").0];
    for frame in all.map(|mut read| read.remove(3).1) {
        assert_eq!(corner(&frame), [0, 0, 0, 0]);
        let soft = frame.chunks_exact(4).filter(|p| !matches!(p[3], 0 | 255));
        assert!(soft.count() > 20);
    }
}

#[test]
fn sweeps_go_there_and_back_while_the_scene_turns() {
    let bench = Bench::new();
    let frames = |options: &str| -> Vec<Vec<u8>> {
        let light = "light=[{direction=[-1,0.5,-1]}]";
        bench.done(&format!("{SMALL} -o f --overwrite --set {light} {options}"));
        let frame = |n| bench.read(&format!("f/frame-000{n}.png"));
        (0..6).map(frame).collect()
    };
    let sweep = "--vary object.0.extend=0:0.1";
    let [there, back] = [frames(sweep), frames(&format!("{sweep} --bounce"))];
    assert_eq!(back[0], there[0]);
    // Half of the way up, and down again; the highest is the fourth.
    assert_eq!((&back[1], &back[2]), (&back[5], &back[4]));
    assert_eq!(back[3], there[5]);
    assert!(back[1] != back[2] && back[2] != back[3]);
    // A solid on the table's axis looks the same from all sides, if its light does.
    let table = frames("--turn 360 --turntable");
    assert!(table.iter().all(|frame| *frame == table[0]));
    let camera = frames("--turn 360");
    assert!(camera.iter().skip(1).all(|frame| *frame != camera[0]));
    let both = frames(&format!("--turn 360 {sweep} --bounce"));
    assert!(both[0] == camera[0] && both[1] != both[5] && both[2] != camera[2]);
    let swing = frames("--turn 90 --bounce");
    assert!(swing[1] == swing[5] && swing[1] != swing[0] && swing[3] != swing[2]);
}

#[test]
fn what_does_not_move_is_refused_first() {
    let bench = Bench::new();
    bench.refuses(
        2,
        "animate scene.toml --frames 2 -o a.mp4                   | --output | .gif, .webp, .apng
         animate scene.toml --frames 2 -o a --fps 10               | --fps | .webp
         animate scene.toml --frames 2 --loops 2                   | --loops | .webp
         animate scene.toml --frames 2 -o a.gif --fps 60           | --fps | 50
         animate scene.toml --frames 2 -o a.webp --fps 91          | --fps | 90 | a tenth of a second
         animate scene.toml --frames 2 -o a.apng --fps 100         | --fps | 90 | a tenth of a second
         animate scene.toml --frames 2 -o a.gif --quality 60       | --quality | .webp
         animate scene.toml --frames 2 -o a.webp --size 16384x2    | --size | 16383
         animate scene.toml --frames 280 -o a.apng                 | --frames | 134400000 pixels | 134217728",
    );
    let none = "animate scene.toml --frames 2 -o none/a.gif";
    bench.refused(none, 1, &["none/a.gif", "--output"]);
}
