//! `revmap mesh`: what it writes, says and refuses.

use crate::run::{Bench, lines};

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
    let (coarse, fine) = (count("--tolerance 0.01"), count("--tolerance 0.0001"));
    assert!(6 * coarse < fine, "{coarse} {fine}");
    // An eye 1.7 units from the box, and one at 17; rows make pixels smaller.
    let near = count("--pixels 0.5");
    let far = count("--pixels 0.5 --distance 17");
    assert!(2 * far < near, "{far} {near}");
    assert_eq!(near, count("--pixels 0.5 --rows 1080"));
    assert_eq!(near, count("--pixels 1 --rows 2160"));
    assert_eq!(
        near,
        count("--pixels 0.5 --set object.0.rotation=[0,0,1,0]")
    );
    assert!(near < count("--pixels 0.5 --set object.0.scale=[1,3,1]"));
    bench.refuses(
        2,
        "mesh scene.toml -o a.ply                              | a.ply | .glb, .obj, .stl
         mesh scene.toml -o a.glb --tolerance 0                | --tolerance | object units or more
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
    let said = lines(&output).join("\n");
    for word in ["a.mtl", "a.0.png", "object.0.height_map"] {
        assert!(said.contains(word), "{said}");
    }
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
