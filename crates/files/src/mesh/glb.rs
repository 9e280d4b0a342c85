//! Binary glTF 2.0: one mesh for each object, one node for each copy.

use super::{Solid, png_of};
use crate::content_fault;
use glam::Vec3;
use revmap::error::Result;
use revmap::scene::Placement;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::f64::consts::FRAC_1_SQRT_2;

/// Numbers of the format.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const REPEAT: u32 = 10497;
const CLAMP_TO_EDGE: u32 = 33071;
/// Bytes of a vertex: place, normal, texture coordinates.
const STRIDE: usize = 32;

/// The bytes of a file.
pub(super) fn bytes(solids: &[Solid]) -> Result<Vec<u8>> {
    let mut file = File::default();
    for solid in solids {
        file.add(solid)?;
    }
    file.packed()
}

/// The lists of a document, and its buffer.
#[derive(Default)]
struct File {
    buffer: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
    /// The image of the colour map that an object is the first to have.
    image_of: HashMap<usize, usize>,
    nodes: Vec<Value>,
}

impl File {
    fn add(&mut self, solid: &Solid) -> Result<()> {
        let mesh = solid.triangles;
        let start = self.buffer.len();
        for vertex in &mesh.vertices {
            let numbers = vertex.position.iter().chain(&vertex.normal);
            let numbers = numbers.copied().chain(solid.uv(vertex));
            self.buffer.extend(numbers.flat_map(f32::to_le_bytes));
        }
        let vertices = self.view(start, json!({"byteStride": STRIDE, "target": ARRAY_BUFFER}));
        let start = self.buffer.len();
        self.buffer
            .extend(mesh.indices.iter().flat_map(|k| k.to_le_bytes()));
        let indices = self.view(start, json!({"target": ELEMENT_ARRAY_BUFFER}));
        let places = || mesh.vertices.iter().map(|v| Vec3::from(v.position));
        let low = places().fold(Vec3::INFINITY, Vec3::min).to_array();
        let high = places().fold(Vec3::NEG_INFINITY, Vec3::max).to_array();
        let count = mesh.vertices.len();
        let part = |offset: u32, kind: &str| json!({"bufferView": vertices, "byteOffset": offset, "componentType": FLOAT, "count": count, "type": kind});
        let mut position = part(0, "VEC3");
        (position["min"], position["max"]) = (json!(low), json!(high));
        let first = self.accessors.len();
        self.accessors
            .extend([position, part(12, "VEC3"), part(24, "VEC2")]);
        self.accessors.push(json!({"bufferView": indices, "componentType": UNSIGNED_INT, "count": mesh.indices.len(), "type": "SCALAR"}));
        let material = self.material(solid)?;
        let attributes = json!({"POSITION": first, "NORMAL": first + 1, "TEXCOORD_0": first + 2});
        self.meshes.push(json!({"name": solid.name(), "primitives": [{"attributes": attributes, "indices": first + 3, "material": material}]}));
        let placements = solid.object.placements().iter();
        self.nodes
            .extend(placements.map(|copy| node(&solid.name(), solid.number, copy)));
        Ok(())
    }

    /// The number of a new view of the buffer from `start` to its end, which is padded.
    fn view(&mut self, start: usize, mut view: Value) -> usize {
        view["buffer"] = json!(0);
        view["byteOffset"] = json!(start);
        view["byteLength"] = json!(self.buffer.len() - start);
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    fn material(&mut self, solid: &Solid) -> Result<usize> {
        let own = solid.object.material();
        let [red, green, blue] = solid.object.color.map(|v| v.clamp(0.0, 1.0));
        let mut look = json!({"metallicFactor": own.metalness, "roughnessFactor": own.roughness});
        if let Some(owner) = solid.map_owner {
            if let Some(map) = solid.new_map() {
                let start = self.buffer.len();
                self.buffer.extend(png_of(map)?);
                let view = self.view(start, json!({}));
                self.image_of.insert(owner, self.images.len());
                self.images
                    .push(json!({"bufferView": view, "mimeType": "image/png"}));
            }
            let number = self.textures.len();
            let image = self.image_of.get(&owner);
            self.textures.push(
                json!({"source": image, "sampler": usize::from(solid.object.texturing.clamps())}),
            );
            look["baseColorTexture"] = json!({"index": number});
        } else {
            look["baseColorFactor"] = json!([red, green, blue, 1.0]);
        }
        self.materials
            .push(json!({"name": solid.name(), "pbrMetallicRoughness": look}));
        Ok(self.materials.len() - 1)
    }

    /// The header, the document and the buffer.
    fn packed(mut self) -> Result<Vec<u8>> {
        let children: Vec<usize> = (0..self.nodes.len()).collect();
        let root = children.len();
        // The scene's z is turned to y.
        let up = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
        self.nodes
            .push(json!({"name": "z up", "rotation": up, "children": children}));
        let mut document = json!({
            "asset": {"version": "2.0", "generator": "revmap"},
            "scene": 0,
            "scenes": [{"nodes": [root]}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.buffer.len()}],
        });
        if !self.images.is_empty() {
            document["images"] = json!(self.images);
            document["textures"] = json!(self.textures);
            let wraps = [REPEAT, CLAMP_TO_EDGE];
            document["samplers"] = wraps
                .map(|wrap| json!({"wrapS": REPEAT, "wrapT": wrap}))
                .into();
        }
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let size = |n: usize| {
            let small = u32::try_from(n).ok();
            small
                .ok_or_else(|| content_fault("would be larger than 4 GiB; give a larger tolerance"))
        };
        let all = size(28 + text.len() + self.buffer.len())?;
        let mut bytes = Vec::with_capacity(all as usize);
        bytes.extend(b"glTF");
        for word in [2, all, size(text.len())?] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(text);
        bytes.extend(size(self.buffer.len())?.to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(self.buffer);
        Ok(bytes)
    }
}

fn node(name: &str, mesh: usize, copy: &Placement) -> Value {
    json!({
        "name": name,
        "mesh": mesh,
        "translation": copy.position.to_array(),
        "rotation": copy.rotation.normalize().to_array(),
        "scale": copy.scale.to_array(),
    })
}
