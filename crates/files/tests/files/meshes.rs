//! Meshes as files, read again.

use revmap::error::ErrorKind;
use revmap::scene::Scene;
use revmap_files::{MESH_ENDINGS, SceneFile, mesh_files, write_meshes};
use revmap_tessellation::Triangles;
use serde_json::Value;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

const TOLERANCE: f64 = 2e-3;
/// Two copies, one of them turned and stretched, and a textured ball.
const SCENE: &str = r#"
[camera]
eye = [2, 0, 0]
target = [0, 0, 0]
[[object]]
polygon = [[0, 0], [0.3, 0], [0, 1]]
color = [0.5, 0.25, 3.0]
roughness = 0.4
instances = "copies.csv"
[[object]]
polygon = [[0, 0.1], [0.4, 0.5], [0, 0.9]]
color_map = "map.png"
texture_repeat = [2, 1]
texture_offset = [0.25, 0.125]
position = [3, 0, 0]
[[object]]
polygon = [[0.2, 0.1], [0.4, 0.5], [0.2, 0.9]]
color_map = "map.png"
position = [3, 0, 2]
"#;
const COPIES: &str = "x,y,z,qx,qy,qz,qw,sx,sy,sz\n0,0,0,0,0,0,1,1,1,1\n0,5,1,1,0,0,0,1,2,1\n";

fn scene(folder: &Path) -> (Scene, Vec<Triangles>) {
    std::fs::write(folder.join("copies.csv"), COPIES).unwrap();
    let map = image::RgbImage::from_fn(4, 2, |x, y| image::Rgb([60 * x as u8, 200 * y as u8, 9]));
    map.save(folder.join("map.png")).unwrap();
    let scene = SceneFile::parse(SCENE, folder).unwrap().scene(&[]).unwrap();
    let meshes = scene
        .objects
        .iter()
        .map(|o| Triangles::new(o, TOLERANCE).unwrap());
    let meshes = meshes.collect();
    (scene, meshes)
}

fn written(name: &str) -> (tempfile::TempDir, PathBuf, Scene, Vec<Triangles>) {
    let folder = tempfile::tempdir().unwrap();
    let (scene, meshes) = scene(folder.path());
    let path = folder.path().join(name);
    write_meshes(&scene, &meshes, &path).unwrap();
    (folder, path, scene, meshes)
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn float(bytes: &[u8], at: usize) -> f64 {
    f64::from(f32::from_bits(word(bytes, at)))
}

/// The document and the buffer of a file.
fn glb(path: &Path) -> (Value, Vec<u8>) {
    let bytes = std::fs::read(path).unwrap();
    let head = (&bytes[..4], word(&bytes, 4), word(&bytes, 8) as usize);
    assert_eq!(head, (b"glTF".as_slice(), 2, bytes.len()));
    let text = 20 + word(&bytes, 12) as usize;
    let document = serde_json::from_slice(&bytes[20..text]).unwrap();
    (document, bytes[text + 8..].to_vec())
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[test]
fn stl_holds_every_copy_and_the_volume() {
    let (_folder, path, _, meshes) = written("a.stl");
    let bytes = std::fs::read(path).unwrap();
    let count = word(&bytes, 80) as usize;
    let own: Vec<usize> = meshes.iter().map(|m| m.indices.len() / 3).collect();
    assert_eq!(count, 2 * own[0] + own[1] + own[2]);
    assert_eq!(bytes.len(), 84 + 50 * count);
    assert!(!bytes.starts_with(b"solid"), "as text does");
    let corner =
        |t: usize, k: usize| [0, 1, 2].map(|n| float(&bytes, 96 + 50 * t + 12 * k + 4 * n));
    let volume = |from: usize, to: usize| -> f64 {
        let of = |t| determinant([0, 1, 2].map(|k| corner(t, k))) / 6.0;
        (from..to).map(of).sum()
    };
    let cone = std::f64::consts::PI * 0.09 / 3.0;
    assert!((volume(0, own[0]) - cone).abs() < 2e-3);
    // The second is half a turn about x, above and stretched.
    assert!((volume(own[0], 2 * own[0]) - 2.0 * cone).abs() < 4e-3);
    let high = (own[0]..2 * own[0])
        .map(|t| corner(t, 0)[2])
        .fold(f64::MIN, f64::max);
    assert_eq!(high, 1.0);
}

#[test]
fn obj_shares_places_and_stands_upright() {
    let (folder, path, _, _) = written("a.obj");
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |line: &str| -> Vec<f64> {
        line.split(' ')
            .skip(1)
            .map(|n| n.parse().unwrap())
            .collect()
    };
    let of = |kind: &str| -> Vec<Vec<f64>> {
        text.lines()
            .filter(|l| l.starts_with(kind))
            .map(numbers)
            .collect()
    };
    let (places, normals, coordinates) = (of("v "), of("vn "), of("vt "));
    // The cone's height runs along y, and the copies are along -z.
    assert!(
        places
            .iter()
            .any(|p| p[0].abs() < 1e-6 && p[1] == 1.0 && p[2].abs() < 1e-6)
    );
    assert!(places.iter().any(|p| (p[2] + 5.0).abs() < 1e-6));
    // Twice around, less a quarter.
    let has = |k: usize, wanted: f64| coordinates.iter().any(|c| (c[k] - wanted).abs() < 1e-6);
    assert!(has(0, 1.75) && has(1, 0.25) && has(1, 0.75));
    assert!(
        normals
            .iter()
            .all(|n| (n[0].hypot(n[1]).hypot(n[2]) - 1.0).abs() < 1e-4)
    );
    let mut edges: HashMap<(usize, usize), i32> = HashMap::new();
    let mut clamped = 0;
    let mut object = "";
    for line in text.lines() {
        object = line.strip_prefix("o ").unwrap_or(object);
        let Some(face) = line.strip_prefix("f ") else {
            continue;
        };
        let corner: Vec<Vec<usize>> = face
            .split(' ')
            .map(|c| c.split('/').map(|n| n.parse().unwrap()).collect())
            .collect();
        // The map of two rows ends in the middle of each, and is moved up by an eighth.
        let mean = |of: &dyn Fn(usize) -> f64| (0..3).map(of).sum::<f64>() / 3.0;
        let found = mean(&|k| coordinates[corner[k][1] - 1][1]);
        let moved = mean(&|k| places[corner[k][0] - 1][1]) - 0.125;
        if object.starts_with("1-") {
            assert!(
                (found - moved.clamp(0.25, 0.75)).abs() < 1e-5,
                "{found} {moved}"
            );
            clamped += usize::from(moved < 0.25);
        }
        for k in 0..3 {
            let (a, b) = (corner[k][0], corner[(k + 1) % 3][0]);
            *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            // The face is seen from where its normals point.
            let ([p, q, r], n) = (
                [0, 1, 2].map(|k| &places[corner[k][0] - 1]),
                &normals[corner[k][2] - 1],
            );
            let [u, v] = [q, r].map(|o| [0, 1, 2].map(|i| o[i] - p[i]));
            assert!(determinant([u, v, [n[0], n[1], n[2]]]) > 0.0);
        }
    }
    assert!(clamped > 20);
    assert!(edges.len() > 300 && edges.values().all(|n| *n == 0));
    let names = |ending| folder.path().join(format!("a.{ending}"));
    let materials = std::fs::read_to_string(names("mtl")).unwrap();
    assert!(
        materials.contains("Kd 0.73536 0.53710 1.00000")
            && materials.contains("Ks 0.53710 0.53710 0.53710\nNs 32")
            && materials.matches("map_Kd a.1.png").count() == 2
    );
    let map = image::open(names("1.png")).unwrap().to_rgb8();
    assert_eq!(
        (map.dimensions(), map.get_pixel(3, 1).0),
        ((4, 2), [180, 200, 9])
    );
}

#[test]
fn glb_has_nodes_materials_and_one_picture() {
    let (_folder, path, _, meshes) = written("a.glb");
    let (document, buffer) = glb(&path);
    let buffer = buffer.as_slice();
    assert_eq!(document["buffers"][0]["byteLength"], buffer.len());
    // Four copies below one that turns z up to y up.
    let nodes = document["nodes"].as_array().unwrap();
    assert_eq!(nodes.len(), 5);
    assert_eq!(nodes[4]["children"].as_array().unwrap().len(), 4);
    let up =
        glam::DQuat::from_slice(&[0, 1, 2, 3].map(|k| nodes[4]["rotation"][k].as_f64().unwrap()));
    assert!((up * glam::DVec3::Z).distance(glam::DVec3::Y) < 1e-12);
    assert_eq!(
        (&nodes[0]["mesh"], &nodes[1]["mesh"], &nodes[2]["mesh"]),
        (&0.into(), &0.into(), &1.into())
    );
    assert_eq!(nodes[1]["scale"][1], 2.0);
    assert_eq!(nodes[1]["translation"][1], 5.0);
    assert_eq!(document["images"].as_array().unwrap().len(), 1);
    let look = &document["materials"][0]["pbrMetallicRoughness"];
    assert_eq!(
        (&look["baseColorFactor"][0], &look["baseColorFactor"][2]),
        (&0.5.into(), &1.0.into())
    );
    assert!((look["roughnessFactor"].as_f64().unwrap() - 0.4).abs() < 1e-6);
    for (number, mesh) in meshes.iter().enumerate() {
        let primitive = &document["meshes"][number]["primitives"][0];
        let accessor = |key: &Value| &document["accessors"][key.as_u64().unwrap() as usize];
        let view = |a: &Value| &document["bufferViews"][a["bufferView"].as_u64().unwrap() as usize];
        let position = accessor(&primitive["attributes"]["POSITION"]);
        let start = view(position)["byteOffset"].as_u64().unwrap() as usize;
        assert_eq!(position["count"], mesh.vertices.len());
        for (k, vertex) in mesh.vertices.iter().enumerate() {
            for axis in 0..3 {
                let v = float(buffer, start + 32 * k + 4 * axis);
                assert_eq!(v, f64::from(vertex.position[axis]));
                let [low, high] = ["min", "max"].map(|m| position[m][axis].as_f64().unwrap());
                assert!((low..=high).contains(&v));
            }
        }
        let indices = accessor(&primitive["indices"]);
        let start = view(indices)["byteOffset"].as_u64().unwrap() as usize;
        assert_eq!(indices["count"], mesh.indices.len());
        assert!((0..mesh.indices.len()).all(|k| word(buffer, start + 4 * k) == mesh.indices[k]));
    }
}

#[test]
fn what_cannot_be_written_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let (mut scene, meshes) = scene(folder.path());
    let refused = |scene: &Scene, meshes: &[Triangles], name: &str| {
        let error = write_meshes(scene, meshes, folder.path().join(name)).unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
        error.kind
    };
    assert_eq!(refused(&scene, &meshes, "a.ply"), ErrorKind::Usage);
    assert_eq!(refused(&scene, &meshes[1..], "a.glb"), ErrorKind::Content);
    assert_eq!(refused(&scene, &meshes, "none/a.stl"), ErrorKind::File);
    assert_eq!(mesh_files(&scene, Path::new("a.obj")).len(), 3);
    assert_eq!(mesh_files(&scene, Path::new("a.glb")).len(), 1);
    scene.objects[0].instances = vec![scene.objects[0].placement; 1 << 20].into();
    for ending in MESH_ENDINGS {
        assert_eq!(
            refused(&scene, &meshes, &format!("a.{ending}")),
            ErrorKind::Content
        );
    }
    let written = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(written, 2, "the scene's own files");
}
