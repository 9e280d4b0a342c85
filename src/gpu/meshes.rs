//! Meshes on the device, made anew whenever an offset moves; and in which order their instances and triangles are drawn.

use super::commands::{Commands, upload_buffer};
use super::contours::Contours;
use super::device::Shared;
use super::memory::Buffer;
use crate::error::{Error, Result, Stage};
use crate::mesh::Mesh;
use crate::scene::{CameraFrame, Object, Offset, Placement, Scene, Shadow};
use crate::settings::{DrawStage, Settings, Solver};
use ash::vk;
use glam::DVec3;
use std::sync::Arc;

/// The meshes of a scene's objects, in order; objects of one profile and offset share one.
pub(crate) struct Meshes {
    made: Vec<Option<Drawable>>,
    /// Objects in the order in which they are drawn, the nearest first.
    order: Vec<usize>,
    depths: Vec<f64>,
    segments: u32,
    rings: u32,
    /// Contours that were cut.
    cuts: u64,
    device: Arc<Shared>,
}

struct Drawable {
    shared: Arc<Uploaded>,
    /// The index that is drawn first; then on to the end, then from the beginning.
    start: u32,
}

/// A mesh that an object is to be drawn with, made, but not necessarily on the device.
pub(crate) struct Planned {
    profile: usize,
    offset: Offset,
    mesh: Arc<Mesh>,
    there: Option<Arc<Uploaded>>,
}

struct Uploaded {
    profile: usize,
    offset: Offset,
    mesh: Arc<Mesh>,
    count: u32,
    kind: vk::IndexType,
    vertices: Buffer,
    indices: Buffer,
}

impl Meshes {
    /// None where the settings ask for a search.
    ///
    /// # Errors
    /// [`Stage::Usage`] for a mesh in the compute stage.
    pub fn new(device: &Arc<Shared>, scene: &Scene, settings: &Settings) -> Result<Option<Self>> {
        let Solver::Mesh { segments, rings } = settings.solver else {
            return Ok(None);
        };
        if settings.stage == DrawStage::Compute {
            return Err(Error::new(
                Stage::Usage,
                format!(
                    "{} is rasterised, which a compute shader does not; give the stage fragment",
                    settings.solver
                ),
            )
            .at_key("--solver"));
        }
        // Settings are plain values: the numbers may not have come through the check.
        Solver::mesh(segments, rings)?;
        let count = scene.objects.len();
        Ok(Some(Self {
            made: (0..count).map(|_| None).collect(),
            order: (0..count).collect(),
            depths: vec![0.0; count],
            segments,
            rings,
            cuts: 0,
            device: device.clone(),
        }))
    }

    /// Makes the meshes whose offset has moved; nothing that is drawn is changed.
    ///
    /// # Errors
    /// [`Stage::Scene`] for what meshes do not draw.
    pub fn plan(&mut self, scene: &Scene, contours: &Contours) -> Result<Vec<Planned>> {
        if scene.shadow != Shadow::Off {
            return Err(refused("casts no shadows; set \"off\"").at_key("shadow"));
        }
        let mut all: Vec<Planned> = Vec::new();
        for (number, object) in scene.objects.iter().enumerate() {
            let key = |key: &str| format!("object.{number}.{key}");
            if object.repeat != [1; 3] {
                return Err(
                    refused("draws one cell; give [1, 1, 1], and instances").at_key(key("repeat"))
                );
            }
            let contour = contours.get(object)?;
            let (profile, offset) = (contour.key(), object.offset);
            let mut made = self.made.iter().flatten().map(|d| &d.shared);
            let there = made.find(|u| u.profile == profile && u.offset == offset);
            let mut before = all.iter();
            let mesh = match (
                there,
                before.find(|p| p.profile == profile && p.offset == offset),
            ) {
                (Some(there), _) => there.mesh.clone(),
                (None, Some(before)) => before.mesh.clone(),
                (None, None) => {
                    let contour = contour.contour(&offset)?;
                    self.cuts += 1;
                    Arc::new(Mesh::new(&contour, self.segments, self.rings))
                }
            };
            check_box(object, mesh.extent[0]).map_err(|(k, e)| e.at_key(key(k)))?;
            all.push(Planned {
                profile,
                offset,
                mesh,
                there: there.cloned(),
            });
        }
        Ok(all)
    }

    /// Gives object `number` its mesh. Returns its placements, the nearest first, and whether both sides of its triangles must be
    /// drawn.
    pub fn update(
        &mut self,
        number: usize,
        object: &Object,
        planned: &Planned,
        camera: &CameraFrame,
        commands: &Commands,
    ) -> Result<(Vec<Placement>, bool)> {
        let same = |u: &Uploaded| u.profile == planned.profile && u.offset == planned.offset;
        let mut made = self.made.iter().flatten().map(|d| &d.shared);
        let there = planned.there.as_ref().or_else(|| made.find(|u| same(u)));
        let shared = match there {
            Some(there) => there.clone(),
            None => Arc::new(self.upload(planned, commands)?),
        };
        let mut placements = object.placements().to_vec();
        let depth = |p: &Placement| (p.position - camera.eye).dot(camera.forward);
        placements.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
        let eyes: Vec<DVec3> = placements
            .iter()
            .map(|p| eye_in(object, p, camera))
            .collect();
        let azimuth = eyes.first().map_or(0.0, |e| e.y.atan2(e.x));
        let both_sides = eyes.iter().any(|eye| may_hold(&shared.mesh, *eye));
        // Of many instances all would have to be gone through twice.
        let start = if placements.len() == 1 {
            shared.mesh.start(azimuth)
        } else {
            0
        };
        self.depths[number] = placements.first().map_or(f64::INFINITY, depth);
        self.made[number] = Some(Drawable { shared, start });
        let depths = &self.depths;
        self.order.sort_by(|a, b| depths[*a].total_cmp(&depths[*b]));
        Ok((placements, both_sides))
    }

    fn upload(&self, planned: &Planned, commands: &Commands) -> Result<Uploaded> {
        let mesh = &planned.mesh;
        let upload =
            |name, usage, bytes: &[u8]| upload_buffer(&self.device, commands, name, usage, bytes);
        let vertices = upload(
            "vertices",
            vk::BufferUsageFlags::VERTEX_BUFFER,
            bytemuck::cast_slice(&mesh.vertices),
        )?;
        let short: Option<Vec<u16>> = mesh.indices.iter().map(|i| (*i).try_into().ok()).collect();
        let (kind, bytes): (_, &[u8]) = match &short {
            Some(short) => (vk::IndexType::UINT16, bytemuck::cast_slice(short)),
            None => (vk::IndexType::UINT32, bytemuck::cast_slice(&mesh.indices)),
        };
        let indices = upload("indices", vk::BufferUsageFlags::INDEX_BUFFER, bytes)?;
        Ok(Uploaded {
            profile: planned.profile,
            offset: planned.offset,
            count: u32::try_from(mesh.indices.len()).unwrap_or(0),
            kind,
            mesh: mesh.clone(),
            vertices,
            indices,
        })
    }

    /// How many contours have been cut.
    pub fn cuts(&self) -> u64 {
        self.cuts
    }

    /// Objects in the order in which to draw them.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Bytes of vertices and indices.
    pub fn bytes(&self) -> u64 {
        let mut seen: Vec<*const Uploaded> = Vec::new();
        let mut sum = 0;
        for drawable in self.made.iter().flatten() {
            if !seen.contains(&Arc::as_ptr(&drawable.shared)) {
                seen.push(Arc::as_ptr(&drawable.shared));
                sum += drawable.shared.vertices.bytes + drawable.shared.indices.bytes;
            }
        }
        sum
    }

    /// Draws object `number`'s instances, within a render pass; pipeline and sets are bound.
    pub fn draw(&self, cmd: vk::CommandBuffer, number: usize, instances: &std::ops::Range<u32>) {
        let Some(drawable) = &self.made[number] else {
            return;
        };
        let mesh = &drawable.shared;
        let raw = &self.device.raw;
        let count = instances.end - instances.start;
        // SAFETY: `cmd` is recording within a render pass; the buffers live as long as `self` and hold the indices drawn.
        unsafe {
            raw.cmd_bind_vertex_buffers(cmd, 0, &[mesh.vertices.raw], &[0]);
            raw.cmd_bind_index_buffer(cmd, mesh.indices.raw, 0, mesh.kind);
            for part in [drawable.start..mesh.count, 0..drawable.start] {
                let length = part.end - part.start;
                if length > 0 {
                    raw.cmd_draw_indexed(cmd, length, count, part.start, 0, instances.start);
                }
            }
        }
    }
}

fn refused(what: &str) -> Error {
    Error::new(Stage::Scene, format!("a mesh {what}, or take a search"))
}

/// A mesh is not cut by the sides of its box: it has to stay within. `widest` is the contour's largest radius.
fn check_box(object: &Object, widest: f64) -> std::result::Result<(), (&'static str, Error)> {
    let radius = object.profile.radius;
    let off = object.axis.map(|o| ((2.0 * o - 1.0) * radius).abs());
    if widest + off[0].max(off[1]) <= radius * (1.0 + 1e-9) {
        return Ok(());
    }
    let (key, what) = if off != [0.0; 2] {
        (
            "axis",
            "is not cut by its box, past which the axis moves it; give [0.5, 0.5]",
        )
    } else if object.offset.extend > 0.0 {
        (
            "extend",
            "is not cut by its box, past which it reaches; give less",
        )
    } else if object.offset.bevel > 0.0 {
        (
            "bevel",
            "is not cut by its box, past which it reaches; give less",
        )
    } else {
        (
            "radius",
            "is not cut by its box, past which it reaches; give more",
        )
    };
    Err((key, refused(what)))
}

/// The eye in object space, about the axis.
fn eye_in(object: &Object, placement: &Placement, camera: &CameraFrame) -> DVec3 {
    let radius = object.profile.radius;
    let [x, y] = object.axis.map(|o| (2.0 * o - 1.0) * radius);
    let local = placement.rotation.normalize().conjugate() * (camera.eye - placement.position);
    local / placement.scale - DVec3::new(x, y, 0.0)
}

/// Whether an eye may be inside, or so near that the near plane cuts the mesh: then its back is seen.
fn may_hold(mesh: &Mesh, eye: DVec3) -> bool {
    let [r_max, z_min, z_max] = mesh.extent;
    let margin = 0.01;
    eye.truncate().length() <= r_max + margin && (z_min - margin..=z_max + margin).contains(&eye.z)
}
