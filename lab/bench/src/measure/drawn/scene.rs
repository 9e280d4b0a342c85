//! The values of a scene under the keys of scene files.

use super::{digest, keys};
use glam::{DQuat, DVec3};
use revmap::maps::{ColorMap, DisplacementMap};
use revmap::profile::{Profile, Raster};
use revmap::scene::{
    BumpForm, Camera, Clip, Environment, Light, Material, Object, Offset, Placement, Scene, Shadow,
    Specular, Texturing,
};
use revmap::settings::name_of;
use toml::{Table, Value};

/// Puts every member of a value into a table: its key, and how it is written; `_` leaves it out.
/// The value is taken apart by name, so that no member is forgotten.
macro_rules! put {
    ($all:ident, $of:expr => $type:ident { $($member:ident: $key:tt $($how:expr)?),* $(,)? }) => {
        let $type { $($member),* } = $of;
        $(put!(@ $all, $member, $key $($how)?);)*
    };
    (@ $all:ident, $member:ident, _) => { let _ = $member; };
    (@ $all:ident, $member:ident, $key:literal $how:expr) => {
        $all.insert($key.to_owned(), Value::from($how($member)));
    };
}

pub(super) fn scene(of: &Scene) -> Table {
    let mut all = Table::new();
    put!(all, of => Scene {
        background: "background" singles,
        ambient: "ambient" singles,
        environment: _,
        camera: "camera" of_camera,
        lights: "light" |lights: &Vec<Light>| lights.iter().map(light).collect::<Vec<_>>(),
        shadow: "shadow" |shadow| name_of(&Shadow::NAMES, shadow),
        objects: "object" |objects: &Vec<Object>| objects.iter().map(object).collect::<Vec<_>>(),
    });
    if let Some(sky) = environment {
        let mut own = Table::new();
        put!(own, sky => Environment { up: "up" singles, down: "down" singles });
        all.insert("environment".to_owned(), own.into());
    }
    all
}

/// Every value of a scene as `--set` takes it: `object.0.bevel=0.4`. The lights are one value.
pub fn assignments(of: &Scene) -> Vec<String> {
    let mut all = scene(of);
    let objects: Vec<Table> = of.objects.iter().map(values).collect();
    all.insert("object".to_owned(), objects.into());
    let lights = all.remove("light").map(|lights| format!("light={lights}"));
    let values = keys("", &all).into_iter();
    let values = values.map(|(key, value)| format!("{key}={value}"));
    values.chain(lights).collect()
}

fn of_camera(of: &Camera) -> Table {
    let mut all = Table::new();
    put!(all, of => Camera {
        eye: "eye" vector,
        target: "target" vector,
        up: "up" vector,
        fov_y: "fov_y" real,
        shift: "shift" reals,
        ray_width: "ray_width" real,
    });
    all
}

fn light(of: &Light) -> Table {
    let mut all = Table::new();
    put!(all, of => Light { direction: "direction" vector, color: "color" singles, radius: "radius" real });
    all
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
    let mut all = Table::new();
    put!(all, of => Object {
        name: _,
        file: _,
        profile: _,
        map_rows: "map_rows" |rows: &u32| *rows,
        color: "color" singles,
        specular: _,
        material: _,
        texturing: _,
        offset: _,
        clip: "clip" |clip| name_of(&Clip::NAMES, clip),
        axis: "axis" reals,
        repeat: "repeat" |repeat: &[u32; 3]| repeat.to_vec(),
        mirror: "mirror" |mirror: &[bool; 3]| mirror.to_vec(),
        placement: _,
        instances: _,
    });
    put!(all, specular => Specular { strength: "specular" single, shininess: "shininess" single });
    put!(all, texturing => Texturing {
        color_map: _,
        displacement_map: _,
        bump: "bump" real,
        bump_form: "bump_form" |form| name_of(&BumpForm::NAMES, form),
        projection: "projection" |projection: &revmap::maps::Projection| projection.name(),
        repeat: "texture_repeat" reals,
        offset: "texture_offset" reals,
    });
    let Object { offset, .. } = of;
    put!(all, offset => Offset { extend: "extend" real, bevel: "bevel" real, chamfer: "chamfer" real });
    put!(all, placement => Placement {
        position: "position" vector,
        rotation: "rotation" |turn: &DQuat| reals(&turn.to_array()),
        scale: "scale" vector,
    });
    if let Some(material) = material {
        put!(all, material => Material { roughness: "roughness" single, metalness: "metalness" single });
    }
    let mut put = |key: &str, text: Option<String>| {
        all.extend(text.map(|text| (key.to_owned(), Value::from(text))));
    };
    put("color_map", color_map.as_deref().map(colors));
    put("height_map", displacement_map.as_deref().map(slopes));
    put(
        "instances",
        (!instances.is_empty()).then(|| copies(instances)),
    );
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
    let mut numbers: Vec<f64> = points().flat_map(|p| p.to_array()).collect();
    numbers.extend(outline.loops.iter().map(|points| points.len() as f64));
    numbers.push(*radius);
    if let Some(Raster {
        columns,
        rows,
        coverage,
    }) = raster
    {
        numbers.extend([*columns, *rows].map(f64::from));
        numbers.extend(coverage.iter().map(|c| f64::from(*c)));
    }
    let digest = digest(numbers.into_iter().flat_map(bytes));
    format!("{} points, {digest}", points().count())
}

fn colors(of: &ColorMap) -> String {
    let texels = of.levels.iter().take(1).flat_map(|level| &level.texels);
    let ([width, height], digest) = (of.size(), digest(texels.flatten().copied()));
    format!("{width}x{height} texels, {digest}")
}

fn slopes(of: &DisplacementMap) -> String {
    let texels = of.levels.iter().take(1).flat_map(|level| &level.texels);
    let digest = digest(texels.flatten().flat_map(|slope| bytes(f64::from(*slope))));
    let [width, height] = of.size();
    format!("{width}x{height} texels, {digest}")
}

fn copies(of: &[Placement]) -> String {
    let numbers = of.iter().flat_map(|p| {
        let vectors = p.position.to_array().into_iter().chain(p.scale.to_array());
        vectors.chain(p.rotation.to_array())
    });
    let digest = digest(numbers.flat_map(bytes));
    format!("{} copies, {digest}", of.len())
}

fn singles<const N: usize>(values: &[f32; N]) -> Vec<Value> {
    values.iter().map(single).collect()
}

fn reals<const N: usize>(values: &[f64; N]) -> Vec<Value> {
    values.iter().map(real).collect()
}

fn vector(of: &DVec3) -> Vec<Value> {
    reals(&of.to_array())
}

/// A number with twelve digits: the functions of another system err in the last ones.
fn real(of: &f64) -> Value {
    let near = if of.abs() < 1e-12 { 0.0 } else { *of };
    Value::Float(format!("{near:.11e}").parse().unwrap_or(near))
}

/// A number of single precision, by its shortest text.
fn single(of: &f32) -> Value {
    real(&of.to_string().parse().unwrap_or_else(|_| f64::from(*of)))
}

/// The bytes of a number in steps of 2^-30, as above.
fn bytes(of: f64) -> [u8; 8] {
    ((of * f64::from(1 << 30)).round() as i64).to_le_bytes()
}
