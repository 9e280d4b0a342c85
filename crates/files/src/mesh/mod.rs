//! Writes the solids of a scene as meshes: glTF (`.glb`), Wavefront (`.obj`) and STL.
//!
//! | format | axis of the solids | copies | colours, texture coordinates |
//! |---|---|---|---|
//! | `.glb` | turned to `y`, as glTF has it | one node for each, of one mesh | yes, colour maps within the file |
//! | `.obj` | turned to `y`, as programs that read it expect | written out | yes, in a `.mtl` beside it, and a `.png` for each colour map |
//! | `.stl` | `z`, as printers have it | written out | no |

mod glb;
mod obj;
mod stl;

pub use stl::stl_rounding;

use crate::{content_fault, ending, write_bytes};
use glam::DVec3;
use revmap::error::{Error, ErrorKind, Result};
use revmap::maps::ColorMap;
use revmap::scene::{Object, Placement, Scene};
use revmap_tessellation::{Triangles, Vertex};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Endings of the formats.
pub const MESH_ENDINGS: [&str; 3] = ["glb", "obj", "stl"];

/// Most triangles of a file that writes copies out.
const MOST_TRIANGLES: usize = 50_000_000;
/// Most copies of all objects: each is a node of some 150 bytes.
const MOST_COPIES: usize = 1_000_000;

/// One object of a scene with its triangles.
struct Solid<'a> {
    number: usize,
    object: &'a Object,
    triangles: &'a Triangles,
    /// The first object with the same colour map.
    map_owner: Option<usize>,
}

/// Every file that [`write_meshes`] writes for a scene and a name: the named one first.
#[must_use]
pub fn mesh_files(scene: &Scene, path: &Path) -> Vec<PathBuf> {
    let mut files = vec![path.to_owned()];
    if ending(path) == "obj" {
        files.push(path.with_extension("mtl"));
        let first = |number: &usize| map_owner(scene, *number) == Some(*number);
        let owners = (0..scene.objects.len()).filter(first);
        files.extend(owners.map(|number| obj::map_file(path, number)));
    }
    files
}

/// Writes the solids of a scene, of which `meshes` has one for each object
/// ([`Triangles::new`]), in the format that the name's ending says.
///
/// # Errors
/// [`ErrorKind::Usage`] for another ending. [`ErrorKind::Content`] if there is not one mesh for each
/// object, if a file would hold more than 50,000,000 triangles, 1,000,000 copies or 4 GiB, or if the
/// coordinates of an `.stl` would be rounded by more than a seventh of the triangles' tolerance
/// ([`stl_rounding`]), with the key of the position.
/// [`ErrorKind::File`] if a file cannot be written. All name the file.
pub fn write_meshes(scene: &Scene, meshes: &[Triangles], path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    written(scene, meshes, path).map_err(|e| match e.file {
        Some(_) => e,
        None => e.in_file(path),
    })
}

fn written(scene: &Scene, meshes: &[Triangles], path: &Path) -> Result<()> {
    if meshes.len() != scene.objects.len() {
        return Err(content_fault("give one mesh for each object of the scene"));
    }
    let solids = scene.objects.iter().zip(meshes).enumerate();
    let solids: Vec<Solid> = solids
        .map(|(number, (object, triangles))| Solid {
            number,
            object,
            triangles,
            map_owner: map_owner(scene, number),
        })
        .collect();
    let copies = |s: &Solid| s.object.placements().len();
    if solids.iter().map(copies).sum::<usize>() > MOST_COPIES {
        return Err(content_fault(format!(
            "would hold more than {MOST_COPIES} copies; take fewer"
        )));
    }
    let format = ending(path);
    let out = solids
        .iter()
        .map(|s| s.triangles.indices.len() / 3 * copies(s));
    if format != "glb" && out.sum::<usize>() > MOST_TRIANGLES {
        return Err(content_fault(format!(
            "would hold more than {MOST_TRIANGLES} triangles, as every copy is written out; give a larger tolerance, or write .glb"
        )));
    }
    match format.as_str() {
        "glb" => write_bytes(path, &glb::bytes(&solids)?),
        "stl" => {
            solids.iter().try_for_each(stl::check)?;
            write_bytes(path, &stl::bytes(&solids))
        }
        "obj" => obj::write(&solids, path),
        _ => {
            let message = format!("ends in none of .{}; name it so", MESH_ENDINGS.join(", ."));
            Err(Error::new(ErrorKind::Usage, message))
        }
    }
}

/// The first object that has the colour map of object `number`.
fn map_owner(scene: &Scene, number: usize) -> Option<usize> {
    let map = |object: &Object| object.texturing.color_map.as_ref().map(Arc::as_ptr);
    let wanted = map(&scene.objects[number])?;
    scene.objects.iter().position(|o| map(o) == Some(wanted))
}

impl Solid<'_> {
    /// A name for programs that list objects.
    fn name(&self) -> String {
        format!("{} {}", self.number, self.object.name)
    }

    /// Texture coordinates as files have them: repeated and moved, `v` from the top down.
    fn uv(&self, vertex: &Vertex) -> [f32; 2] {
        let look = &self.object.texturing;
        let ([across, along], [around, up]) = (look.repeat, look.offset);
        let [xi, eta] = vertex.uv.map(f64::from);
        [
            xi * across - around.rem_euclid(1.0),
            (1.0 - eta) * along + up,
        ]
        .map(|v| v as f32)
    }

    /// Its colour map, unless an object before it has the same.
    fn new_map(&self) -> Option<&ColorMap> {
        let map = self.object.texturing.color_map.as_deref();
        map.filter(|_| self.map_owner == Some(self.number))
    }
}

/// The full size of a colour map as a PNG.
fn png_of(map: &ColorMap) -> Result<Vec<u8>> {
    let level = map.levels.first();
    let level = level.ok_or_else(|| content_fault("a colour map has no texels; give another"))?;
    let mut bytes = Vec::new();
    let picture = crate::Picture {
        width: level.width,
        height: level.height,
        rgba: level.texels.clone(),
    };
    picture.encode_png(&mut bytes)?;
    Ok(bytes)
}

/// A point of an object where a copy of it is, in the world.
fn placed(p: [f32; 3], copy: &Placement) -> DVec3 {
    let p = DVec3::from(p.map(f64::from));
    copy.position + copy.rotation.normalize() * (p * copy.scale)
}

/// The world's `z` turned to `y`.
fn y_up(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, -p.y)
}
