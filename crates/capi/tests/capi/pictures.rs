//! The programs' pictures are those of the Rust renderer, bit for bit.

use crate::host::{self, Options, Stage};
use crate::names::*;
use crate::programs::{SANITIZED, STRICT, compile, folder, prefix, root, run, validated};
use revmap_files::{Picture, ProfileAxis};
use std::path::Path;
use std::process::Command;

const OPTIONS: Options = Options {
    reversed: true,
    ..Options::new(640, 480)
};

/// The objects of `examples/c/engine.c` in its last frame.
fn objects() -> [Object; 2] {
    let of = |points: &[[f64; 2]]| Arc::new(Profile::polygon(points, 0.4).unwrap());
    let goblet = [
        [0.0, 0.0],
        [0.3, 0.0],
        [0.06, 0.12],
        [0.06, 0.45],
        [0.35, 0.7],
        [0.3, 1.0],
        [0.0, 0.6],
    ];
    let mut goblet = Object::new("object", of(&goblet));
    goblet.color = [0.75, 0.55, 0.3];
    goblet.offset = Offset {
        extend: 0.004 * 7.0,
        ..Offset::default()
    };
    let spindle = [[0.0, 0.0], [0.35, 0.2], [0.1, 0.5], [0.35, 0.8], [0.0, 1.0]];
    let mut spindles = Object::new("object", of(&spindle));
    spindles.color = [0.25, 0.5, 0.35];
    spindles.instances = (0..5)
        .map(|n| Placement {
            position: DVec3::new(-0.75, 0.5 * f64::from(n) - 1.0, 0.25 * f64::from(n % 2)),
            scale: DVec3::splat(0.5),
            ..Placement::default()
        })
        .collect();
    [goblet, spindles]
}

/// The view of `examples/c/engine.c`.
fn view() -> View {
    #[rustfmt::skip]
    let [view, projection] = [
        [0.0, -0.28, 0.96, 0.0,  1.0, 0.0, 0.0, 0.0,  0.0, 0.96, 0.28, 0.0,  0.0, -0.48, -3.24, 1.0],
        [2.0625, 0.0, 0.0, 0.0,  0.0, -2.75, 0.0, 0.0,  0.0, 0.0, 0.0, -1.0,  0.0, 0.0, 0.1, 0.0],
    ]
    .map(|columns| DMat4::from_cols_array(&columns));
    let viewport = host::viewport(&OPTIONS);
    View::from_matrices(view, projection, viewport, DepthOrder::Reversed).unwrap()
}

/// What the Rust renderer draws of them: RGB.
fn drawn() -> Vec<u8> {
    let host = host::open();
    let device = host::borrow(&host);
    let mut stage = Stage::new(&host, OPTIONS).unwrap();
    let search = SearchSettings::default();
    let mut renderer = host::renderer(&device, &stage, &search, host::FRAMES);
    for object in objects() {
        renderer.add(object).unwrap();
    }
    host::frame(&mut stage, &mut renderer, &view(), DMat4::IDENTITY, &[]);
    let (rgba, _) = stage.read().unwrap();
    rgba.chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect()
}

/// The pixels of a PPM file.
fn ppm(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).unwrap();
    let head = format!("P6\n{} {}\n255\n", OPTIONS.width, OPTIONS.height);
    bytes.strip_prefix(head.as_bytes()).unwrap().to_vec()
}

#[test]
fn the_engine_in_c_draws_what_rust_draws() {
    let folder = folder();
    let program = folder.path().join("engine");
    let sources = ["engine.c", "host.c"].map(|name| root().join("examples/c").join(name));
    compile("c99", &SANITIZED, &sources, &program);
    let [alone, both] = ["alone", "both"].map(|what| {
        let path = folder.path().join(what);
        println!("{}", run(validated(&program).arg(&path).arg(what)));
        ppm(&path)
    });
    let wanted = drawn();
    let differ = (0..wanted.len()).filter(|&n| alone[n] != wanted[n]).count();
    assert_eq!((alone.len(), differ), (wanted.len(), 0));
    // The solids are there, and the triangle is, before some of them and behind others.
    let background = &wanted[..3];
    let shown = |all: &[u8]| all.chunks_exact(3).filter(|p| *p != background).count();
    let (ours, triangles) = (shown(&alone), shown(&both));
    let pairs = alone.chunks_exact(3).zip(both.chunks_exact(3));
    let behind = pairs.filter(|(a, b)| *a != background && a != b).count();
    println!("{ours} pixels of solids, {triangles} with the triangle, {behind} behind it");
    assert!(ours > 30_000 && triangles > ours + 10_000 && behind > 500);
}

#[test]
fn the_picture_in_cpp_is_what_rust_draws() {
    let folder = folder();
    let build = folder.path().join("build");
    let flags = STRICT.join(" ");
    run(Command::new("cmake")
        .args([Path::new("-S"), &root().join("examples/c")])
        .args([Path::new("-B"), &build])
        .arg(format!("-DCMAKE_PREFIX_PATH={}", prefix().display()))
        .arg(format!("-DCMAKE_C_FLAGS={flags}"))
        .arg(format!("-DCMAKE_CXX_FLAGS={flags}")));
    run(Command::new("cmake").arg("--build").arg(&build));
    let drawing = root().join("assets/profiles/pawn.svg");
    let png = folder.path().join("pawn.png");
    let said = run(validated(&build.join("picture")).args([&drawing, &png]));
    println!("{said}");
    // The engine, which CMake has linked with the shared library.
    run(validated(&build.join("engine")).arg(folder.path().join("engine.ppm")));

    let profile = revmap_files::profile(&drawing, ProfileAxis::Center).unwrap();
    let mut object = Object::new("object", Arc::new(profile));
    object.color[2] = 0.4;
    object.offset.extend = -0.02;
    let mut scene = Scene::new(Camera::new(
        DVec3::new(2.0, 0.0, 1.25),
        DVec3::new(0.0, 0.0, 0.5),
    ));
    scene.objects.push(object);
    let settings = Settings {
        width: 480,
        height: 360,
        planes: Planes::Color,
        ..Settings::default()
    };
    let device = Device::open_validated(None).unwrap();
    let wanted = Picture::of(
        &revmap_offscreen::draw(&device, &scene, &settings)
            .unwrap()
            .frame,
    )
    .unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&png).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut found = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut found).unwrap();
    assert!(found == wanted.rgba.concat(), "pixels differ");
    assert!(wanted.rgba.iter().filter(|p| p[3] == 255).count() > 10_000);

    // A failure is a line that names the file, and no picture.
    let out = validated(&build.join("picture"))
        .args(["missing.svg", "none.png"])
        .output()
        .unwrap();
    assert!(!out.status.success());
    assert!(String::from_utf8_lossy(&out.stderr).starts_with("missing.svg: does not exist"));
}
