//! Wavefront OBJ: text, with a file of materials and pictures of colour maps beside it.

use super::{Solid, placed, png_of, y_up};
use crate::{file_fault, write_atomically, write_bytes};
use glam::DVec3;
use revmap::error::Result;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The picture of an object's colour map.
pub(super) fn map_file(path: &Path, number: usize) -> PathBuf {
    path.with_extension(format!("{number}.png"))
}

/// Writes the file `path` and all beside it.
pub(super) fn write(solids: &[Solid], path: &Path) -> Result<()> {
    for solid in solids {
        if let Some(map) = solid.new_map() {
            write_bytes(&map_file(path, solid.number), &png_of(map)?)?;
        }
    }
    let library = path.with_extension("mtl");
    write_bytes(&library, materials(solids, path).as_bytes())?;
    let failed = |e: std::io::Error| file_fault(format!("cannot be written ({e})"));
    write_atomically(path, |out| {
        let library = library.file_name().unwrap_or_default().to_string_lossy();
        writeln!(
            out,
            "# solids of revolution, made by revmap\nmtllib {library}"
        )
        .map_err(failed)?;
        let mut before = [0usize; 2];
        let mut all = solids.iter();
        all.try_for_each(|solid| object(out, solid, &mut before).map_err(failed))
    })
}

fn materials(solids: &[Solid], path: &Path) -> String {
    let mut text = String::new();
    for solid in solids {
        let object = solid.object;
        let [red, green, blue] = match solid.map_owner {
            Some(_) => [1.0; 3],
            None => object.color,
        };
        let (strength, exponent) = (object.specular.strength, object.specular.shininess);
        let number = solid.number;
        let _ = writeln!(
            text,
            "newmtl object-{number}\nKd {red} {green} {blue}\nKs {strength} {strength} {strength}\nNs {exponent}"
        );
        if let Some(owner) = solid.map_owner {
            let file = map_file(path, owner);
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let _ = writeln!(text, "map_Kd {name}");
        }
    }
    text
}

/// Writes all copies of an object. Faces that meet share places, and differ in normals or texture
/// coordinates where the surface has an edge or a seam. `before`: places and vertices so far.
fn object(out: &mut dyn Write, solid: &Solid, before: &mut [usize; 2]) -> std::io::Result<()> {
    let vertices = &solid.triangles.vertices;
    let (mut places, mut firsts, mut place_of) = (HashMap::new(), Vec::new(), Vec::new());
    for vertex in vertices {
        let bits = vertex.position.map(|v| (v + 0.0).to_bits());
        let place = *places.entry(bits).or_insert_with(|| {
            firsts.push(vertex.position);
            firsts.len()
        });
        place_of.push(place);
    }
    for (n, copy) in solid.object.placements().iter().enumerate() {
        writeln!(
            out,
            "o {}.{n}\nusemtl object-{}",
            solid.name().replace(' ', "-"),
            solid.number
        )?;
        for position in &firsts {
            let [x, y, z] = y_up(placed(*position, copy)).as_vec3().to_array();
            writeln!(out, "v {x} {y} {z}")?;
        }
        for vertex in vertices {
            let normal = DVec3::from(vertex.normal.map(f64::from)) / copy.scale;
            let normal = y_up(copy.rotation.normalize() * normal).normalize_or_zero();
            let ([x, y, z], [u, v]) = (normal.as_vec3().to_array(), solid.uv(vertex));
            writeln!(out, "vt {u} {}\nvn {x:.5} {y:.5} {z:.5}", 1.0 - v)?;
        }
        for triangle in solid.triangles.indices.chunks_exact(3) {
            let corner = |k: usize| {
                let vertex = triangle[k] as usize;
                let (place, own) = (before[0] + place_of[vertex], before[1] + vertex + 1);
                format!("{place}/{own}/{own}")
            };
            writeln!(out, "f {} {} {}", corner(0), corner(1), corner(2))?;
        }
        *before = [before[0] + firsts.len(), before[1] + vertices.len()];
    }
    Ok(())
}
