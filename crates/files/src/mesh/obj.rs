//! Wavefront OBJ: text, with a file of materials and pictures of colour maps beside it.

use super::{Solid, placed, png_of, y_up};
use crate::{file_fault, write_atomically, write_bytes};
use glam::DVec3;
use revmap::error::Result;
use revmap::frame::srgb_from_linear;
use revmap::scene::Placement;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The largest exponent of a highlight that the format has.
const MOST_EXPONENT: f32 = 1000.0;

/// Rounding of texture coordinates.
const SLACK: f32 = 1e-5;

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
        let color = match solid.map_owner {
            Some(_) => [1.0; 3],
            None => object.color,
        };
        let [red, green, blue] = color.map(|v| shown(v.into()));
        let strength = shown(object.specular.strength.into());
        let exponent = object.specular.shininess.clamp(0.0, MOST_EXPONENT);
        let number = solid.number;
        let _ = writeln!(
            text,
            "newmtl object-{number}\nKd {red:.5} {green:.5} {blue:.5}\nKs {strength:.5} {strength:.5} {strength:.5}\nNs {exponent}"
        );
        if let Some(owner) = solid.map_owner {
            let file = map_file(path, owner);
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let _ = writeln!(text, "map_Kd {name}");
        }
    }
    text
}

/// A linear value as most readers take it: sRGB, 0 to 1.
fn shown(linear: f64) -> f64 {
    srgb_from_linear(linear.clamp(0.0, 1.0))
}

/// The texture coordinates `v` between which a colour map is drawn. Readers repeat it beyond its
/// ends, and many of them fail on the option that says otherwise (`-clamp`). A map that ends goes on
/// beyond as in the middle of its last row, where the triangles have a ring.
fn rows(solid: &Solid) -> [f32; 2] {
    let look = &solid.object.texturing;
    let map = look.color_map.as_ref().and_then(|map| map.levels.first());
    let mut all = solid.triangles.vertices.iter().map(|v| solid.uv(v)[1]);
    match map {
        Some(level) if look.clamps() && all.any(|v| !(-SLACK..=1.0 + SLACK).contains(&v)) => {
            let half = 0.5 / level.height as f32;
            [half, 1.0 - half]
        }
        _ => [f32::NEG_INFINITY, f32::INFINITY],
    }
}

/// Digits behind the point by which a coordinate is as exact as the vertices of a copy of this
/// scale, which have 32 bits.
fn decimals(copy: &Placement) -> usize {
    let finest = 1e-8 * copy.scale.abs().min_element();
    (-finest.log10()).ceil().clamp(0.0, 17.0) as usize
}

/// Writes all copies of an object. Faces that meet share places, and differ in normals or texture
/// coordinates where the surface has an edge or a seam. `before`: places and vertices so far.
fn object(out: &mut dyn Write, solid: &Solid, before: &mut [usize; 2]) -> std::io::Result<()> {
    let vertices = &solid.triangles.vertices;
    let rows = rows(solid);
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
        let digits = decimals(copy);
        for position in &firsts {
            let [x, y, z] = y_up(placed(*position, copy)).to_array();
            writeln!(out, "v {x:.digits$} {y:.digits$} {z:.digits$}")?;
        }
        for vertex in vertices {
            let normal = DVec3::from(vertex.normal.map(f64::from)) / copy.scale;
            let normal = y_up(copy.rotation.normalize() * normal).normalize_or_zero();
            let ([x, y, z], [u, v]) = (normal.as_vec3().to_array(), solid.uv(vertex));
            let v = v.clamp(rows[0], rows[1]);
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
