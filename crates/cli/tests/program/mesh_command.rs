//! `revmap mesh`: what it writes, says and refuses.

use crate::run::{Bench, CAMERA, CONE, holds, lines};

/// Triangles that a run says it wrote.
fn triangles(bench: &Bench, arguments: &str) -> usize {
    let said = bench.said(&format!("mesh {arguments}"));
    let count = said.split(": ").nth(1).and_then(|s| s.split(' ').next());
    count.unwrap().parse().unwrap()
}

#[test]
fn meshes_are_as_fine_as_they_are_seen() {
    let bench = Bench::new();
    let count = |options: &str| triangles(&bench, &format!("scene.toml -o a.stl {options}"));
    let said = bench.said("mesh scene.toml -o a.stl");
    assert!(said.contains(" of 1 solid, 1 copy, within "), "{said}");
    let (coarse, fine) = (count("--tolerance 0.01"), count("--tolerance 0.0001"));
    assert!(6 * coarse < fine, "{coarse} {fine}");
    // An eye 1.7 units from the box, and one at 17; rows make pixels smaller.
    let near = count("--pixels 0.5");
    let far = count("--pixels 0.5 --distance 17");
    assert!(2 * far < near, "{far} {near}");
    let turned = "--pixels 0.5 --set object.0.rotation=[0,0,1,0]";
    for same in ["--pixels 0.5 --rows 1080", "--pixels 1 --rows 2160", turned] {
        assert_eq!(near, count(same), "{same}");
    }
    assert!(near < count("--pixels 0.5 --set object.0.scale=[1,3,1]"));
    bench.refuses(
        2,
        "mesh scene.toml -o a.ply                              | a.ply | .glb, .obj, .stl
         mesh scene.toml -o a.glb --tolerance 0                | --tolerance | object units or more
         mesh scene.toml -o a.stl --tolerance nan              | --tolerance | is NaN
         mesh scene.toml -o a.stl --tolerance=-1               | --tolerance | is -1;
         mesh scene.toml -o a.glb --tolerance 1 --pixels 1     | --pixels
         mesh scene.toml -o a.glb --distance 2                 | --pixels
         mesh scene.toml -o a.glb --pixels -1                  | --pixels | above 0
         mesh scene.toml -o a.glb --pixels 1 --distance nan    | --distance | above 0
         mesh scene.toml -o a.glb --pixels 1e-9                | --pixels | object units or more
         mesh scene.toml -o a.glb --pixels 1 --set camera.eye=[0.3,0,0.5] | --distance | within its box",
    );
    bench.refuses(
        1,
        "mesh scene.toml -o a.glb --set object.0.repeat=[2,1,1] | scene.toml | object.0.repeat | instances
         mesh scene.toml -o none/a.glb                          | none/a.glb",
    );
}

#[test]
fn all_files_are_named_and_inputs_spared() {
    let bench = Bench::new();
    bench.half("map.png");
    bench.object("profile = \"map.png\"\nprofile_axis = \"left\"\ncolor_map = \"map.png\"\nheight_map = \"map.png\"\nbump = 0.1");
    let output = bench.done("mesh scene.toml -o a.obj");
    let words = ["a.mtl", "a.0.png", "object.0.height_map"];
    holds(&lines(&output).join("\n"), &words);
    bench.has(&["a.obj", "a.mtl", "a.0.png"]);
    bench.half("b.0.png");
    bench.object("profile = \"map.png\"\nprofile_axis = \"left\"\ncolor_map = \"b.0.png\"");
    bench.refused(
        "mesh scene.toml -o b.obj",
        2,
        &["b.0.png", "is read as well"],
    );
    assert_eq!(lines(&bench.done("mesh map.png -o c.stl --quiet")).len(), 0);
}

/// Copies of the first object and one beside it, far from the origin.
#[test]
fn far_objects_are_refused_as_stl_or_moved() {
    let bench = Bench::new();
    let scene = |name: &str, copies: &str, beside: &str| {
        bench.file(&format!("{name}.csv"), copies);
        let cone = format!("{CAMERA}{CONE}instances = \"{name}.csv\"\n");
        let beside =
            format!("[[object]]\npolygon = [[0, 0], [0.4, 0], [0, 1]]\nposition = {beside}\n");
        bench.file(&format!("{name}.toml"), cone + &beside);
    };
    let copies = "1e6,2e6,0,0,0,0,1,1,1,1\n1000002,2000000,0,0,0,0,1,1,1,1\n";
    scene("far", copies, "[1000000, 2000003, 1]");
    let words = [
        "object.0.position",
        "--at-origin",
        "up to coordinates of 1024",
    ];
    bench.refused("mesh far.toml -o a.stl", 1, &words);
    bench.done("mesh far.toml -o a.stl --at-origin");
    scene(
        "near",
        "0,0,0,0,0,0,1,1,1,1\n2,0,0,0,0,0,1,1,1,1\n",
        "[0, 3, 1]",
    );
    bench.done("mesh near.toml -o b.stl");
    assert!(bench.read("a.stl") == bench.read("b.stl"));
    // No option helps where copies are far from each other.
    let spread = "near.toml -o a.stl --set object.1.position=[1e6,0,0] --at-origin";
    let said = bench.ended(&format!("mesh {spread}")).1.join(" ");
    holds(&said, &["object.1.position"]);
    assert!(!said.contains("--at-origin"), "{said}");
    bench.done("mesh far.toml -o a.obj");
}

#[test]
fn what_a_material_cannot_hold_is_named() {
    let bench = Bench::new();
    let mesh = "mesh scene.toml -o a.obj --set object.0.color=[3,0.5,0]";
    let said = lines(&bench.done(mesh)).join("\n");
    holds(&said, &["object.0.color", "above 1"]);
    holds(&bench.text("a.mtl"), &["Kd 1.00000 0.73536 0.00000"]);
}

/// A light shape off the axis is a void, of any size.
#[test]
fn closed_hollows_are_named() {
    let bench = Bench::new();
    let said = |hole: &str| {
        let shapes = format!("<path d='M30 10H70V90H30z'/>{hole}");
        let svg =
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{shapes}</svg>");
        bench.file("a.svg", svg);
        lines(&bench.done("mesh a.svg -o a.stl")).join("\n")
    };
    let hole = said("<path d='M55 40h4v4h-4z' fill='#fff'/>");
    holds(&hole, &["object.0", "1 closed hollow,"]);
    assert!(!said("").contains("hollow"));
}
