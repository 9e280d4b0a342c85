//! The values of a scene under the keys of scene files.

use super::digest;
use glam::DVec3;
use revmap::maps::{ColorMap, DisplacementMap};
use revmap::profile::{Profile, Raster};
use revmap::scene::{
    BumpForm, Camera, Clip, Environment, Light, Material, Object, Offset, Placement, Scene, Shadow,
    Specular, Texturing,
};
use revmap::settings::name_of;
use toml::{Table, Value};

/// A scene. This function and those below take their value apart by name, so that no member is
/// forgotten.
pub(super) fn scene(of: &Scene) -> Table {
    let Scene {
        background,
        ambient,
        environment,
        camera:
            Camera {
                eye,
                target,
                up,
                fov_y,
                shift,
                ray_width,
            },
        lights,
        shadow,
        objects,
    } = of;
    let camera = [
        ("eye", vector(*eye)),
        ("target", vector(*target)),
        ("up", vector(*up)),
        ("fov_y", real(*fov_y)),
        ("shift", list(shift.map(real))),
        ("ray_width", real(*ray_width)),
    ];
    let mut all = table([
        ("background", list(background.map(single))),
        ("ambient", list(ambient.map(single))),
        ("camera", table(camera).into()),
        ("light", tables(lights.iter().map(light))),
        ("shadow", name_of(&Shadow::NAMES, shadow).into()),
        ("object", tables(objects.iter().map(object))),
    ]);
    if let Some(Environment { up, down }) = environment {
        let sky = [("up", up), ("down", down)].map(|(key, color)| (key, list(color.map(single))));
        all.insert("environment".to_owned(), table(sky).into());
    }
    all
}

fn light(of: &Light) -> Table {
    let Light {
        direction,
        color,
        radius,
    } = of;
    table([
        ("direction", vector(*direction)),
        ("color", list(color.map(single))),
        ("radius", real(*radius)),
    ])
}

/// An object without the keys at their default.
fn object(of: &Object) -> Table {
    let plain = values(&Object::new("", of.profile.clone()));
    let mut own = values(of);
    own.retain(|key, value| plain.get(key) != Some(value));
    own.insert("profile".to_owned(), profile(&of.profile).into());
    own
}

fn values(of: &Object) -> Table {
    let Object {
        name: _,
        file: _,
        profile: _,
        map_rows,
        color,
        specular: Specular {
            strength,
            shininess,
        },
        material,
        texturing:
            Texturing {
                color_map,
                displacement_map,
                bump,
                bump_form,
                projection,
                repeat: texture_repeat,
                offset: texture_offset,
            },
        offset: Offset {
            extend,
            bevel,
            chamfer,
        },
        clip,
        axis,
        repeat,
        mirror,
        placement:
            Placement {
                position,
                rotation,
                scale,
            },
        instances,
    } = of;
    let mut all = table([
        ("map_rows", Value::from(*map_rows)),
        ("color", list(color.map(single))),
        ("specular", single(*strength)),
        ("shininess", single(*shininess)),
        ("bump", real(*bump)),
        ("bump_form", name_of(&BumpForm::NAMES, bump_form).into()),
        ("projection", projection.name().into()),
        ("texture_repeat", list(texture_repeat.map(real))),
        ("texture_offset", list(texture_offset.map(real))),
        ("extend", real(*extend)),
        ("bevel", real(*bevel)),
        ("chamfer", real(*chamfer)),
        ("clip", name_of(&Clip::NAMES, clip).into()),
        ("axis", list(axis.map(real))),
        ("repeat", list(repeat.map(Value::from))),
        ("mirror", list(mirror.map(Value::from))),
        ("position", vector(*position)),
        ("rotation", list(rotation.to_array().map(real))),
        ("scale", vector(*scale)),
    ]);
    let mut put = |key: &str, value: Value| {
        all.insert(key.to_owned(), value);
    };
    if let Some(Material {
        roughness,
        metalness,
    }) = material
    {
        put("roughness", single(*roughness));
        put("metalness", single(*metalness));
    }
    if let Some(map) = color_map {
        put("color_map", colors(map).into());
    }
    if let Some(map) = displacement_map {
        put("height_map", slopes(map).into());
    }
    if !instances.is_empty() {
        put("instances", copies(instances).into());
    }
    all
}

fn profile(of: &Profile) -> String {
    let Profile {
        outline,
        radius,
        raster,
        warnings: _,
        notes: _,
    } = of;
    let points = || outline.loops.iter().flatten();
    let ends = outline.loops.iter().map(|points| points.len() as f64);
    let numbers = points()
        .flat_map(|p| p.to_array())
        .chain(ends)
        .chain([*radius]);
    let pixels = raster.as_ref().map(|raster| {
        let Raster {
            columns,
            rows,
            coverage,
        } = raster;
        let size = [*columns, *rows].map(f64::from);
        size.into_iter()
            .chain(coverage.iter().map(|c| f64::from(*c)))
    });
    let numbers = numbers.chain(pixels.into_iter().flatten());
    counted(points().count(), "points", digest(numbers.flat_map(bytes)))
}

fn colors(of: &ColorMap) -> String {
    let texels = of.levels.iter().take(1).flat_map(|level| &level.texels);
    let digest = digest(texels.flatten().copied());
    format!("{} texels, {digest}", size(of.size()))
}

fn slopes(of: &DisplacementMap) -> String {
    let texels = of.levels.iter().take(1).flat_map(|level| &level.texels);
    let digest = digest(texels.flatten().flat_map(|slope| bytes(f64::from(*slope))));
    format!("{} texels, {digest}", size(of.size()))
}

fn size([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
}

fn copies(of: &[Placement]) -> String {
    let numbers = of.iter().flat_map(|placement| {
        let Placement {
            position,
            rotation,
            scale,
        } = placement;
        let vectors = position.to_array().into_iter().chain(scale.to_array());
        vectors.chain(rotation.to_array())
    });
    counted(of.len(), "copies", digest(numbers.flat_map(bytes)))
}

fn counted(count: usize, what: &str, digest: String) -> String {
    format!("{count} {what}, {digest}")
}

pub(super) fn table<const N: usize>(entries: [(&str, Value); N]) -> Table {
    Table::from_iter(entries.map(|(key, value)| (key.to_owned(), value)))
}

fn tables(all: impl Iterator<Item = Table>) -> Value {
    Value::Array(all.map(Value::Table).collect())
}

fn list<const N: usize>(values: [Value; N]) -> Value {
    Value::Array(values.to_vec())
}

fn vector(of: DVec3) -> Value {
    list(of.to_array().map(real))
}

/// A number with twelve digits: the functions of another system err in the last ones.
fn real(of: f64) -> Value {
    let near = if of.abs() < 1e-12 { 0.0 } else { of };
    Value::Float(format!("{near:.11e}").parse().unwrap_or(near))
}

/// A number of single precision, by its shortest text.
fn single(of: f32) -> Value {
    real(of.to_string().parse().unwrap_or_else(|_| of.into()))
}

/// The bytes of a number in steps of 2^-30, as above.
fn bytes(of: f64) -> [u8; 8] {
    ((of * f64::from(1 << 30)).round() as i64).to_le_bytes()
}
