//! The meshes of a scene's objects: each made once, placed, in the order in which they are drawn.

use super::blocks::{InstanceBlock, ObjectBlock};
use super::tessellation::Mesh;
use glam::DVec3;
use revmap::error::{Error, ErrorKind, Result};
use revmap::maps::Projection;
use revmap::profile::Profile;
use revmap::scene::{CameraFrame, GrownProfiles, Growth, Object, Offset, Placement, Scene, Shadow};
use revmap::surface::ContourSource;
use std::sync::Arc;

/// An object's mesh and what is drawn of it.
pub(super) struct PlacedMesh {
    pub mesh: Arc<Mesh>,
    pub block: ObjectBlock,
    /// The nearest first.
    pub instances: Vec<InstanceBlock>,
    pub projection: Projection,
    /// Whether an eye may see the back of a triangle.
    pub both_sides: bool,
    /// The index that is drawn first; then on to the end, then from the beginning.
    pub start: u32,
    /// Depth of the nearest instance, along the view.
    depth: f64,
}

/// Makes and keeps the meshes of a scene; objects of one profile and offset share one.
pub(super) struct SceneMeshes {
    /// Segments, rings, least height on the screen in pixels; from the coarsest to the finest.
    levels: Vec<(u32, u32, f64)>,
    /// Of the picture, pixels.
    size: (u32, u32),
    sources: Vec<(Arc<Profile>, ContourSource)>,
    /// Profiles in boxes that have grown with offsets.
    grown: GrownProfiles,
    made: Vec<Made>,
    /// How many meshes were made so far.
    pub made_count: u64,
}

#[derive(Clone)]
struct Made {
    profile: Arc<Profile>,
    offset: Offset,
    level: usize,
    mesh: Arc<Mesh>,
}

impl SceneMeshes {
    /// Meshes of so many segments and at most so many rings, by the height of a copy.
    pub fn new(levels: Vec<(u32, u32, f64)>, size: (u32, u32)) -> Self {
        Self {
            levels,
            size,
            sources: Vec::new(),
            grown: GrownProfiles::default(),
            made: Vec::new(),
            made_count: 0,
        }
    }

    /// The meshes of a checked scene, the nearest first. Only those whose profile or offset is new
    /// are made.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for what meshes do not draw, and for a profile without a contour.
    pub fn place(&mut self, scene: &Scene, camera: &CameraFrame) -> Result<Vec<PlacedMesh>> {
        check_scene(scene)?;
        let mut used = Vec::new();
        let mut placed = Vec::new();
        for (number, object) in scene.objects.iter().enumerate() {
            let under = |key: &str| format!("object.{number}.{key}");
            let grown = self.grown.grown(object);
            let growth = Growth::of(object);
            let object = grown.as_ref().map_or(object, |g| &g.object);
            for (level, copies) in self.by_level(object, camera).into_iter().enumerate() {
                let made = self.make(object, level).map_err(|error| {
                    let error = error.at_key(under("profile"));
                    match &object.file {
                        Some(file) => error.in_file(file),
                        None => error,
                    }
                })?;
                check_box(object, made.mesh.extent[0])
                    .map_err(|(key, error)| error.at_key(under(key)))?;
                if !copies.is_empty() {
                    placed.push(place(object, copies, &growth, made.mesh.clone(), camera));
                }
                used.push(made);
            }
        }
        self.sources
            .retain(|(profile, _)| used.iter().any(|u| Arc::ptr_eq(&u.profile, profile)));
        self.made = used;
        placed.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        Ok(placed)
    }

    /// Copies of an object by level. With several levels, those beside the picture are left out.
    fn by_level(&self, object: &Object, camera: &CameraFrame) -> Vec<Vec<Placement>> {
        let mut all = vec![Vec::new(); self.levels.len()];
        if let [one] = all.as_mut_slice() {
            *one = object.placements().to_vec();
            return all;
        }
        for copy in object.placements() {
            if let Some(height) = pixels_high(object, copy, camera, self.size) {
                let fine = |&(_, _, least): &(u32, u32, f64)| height >= least;
                let level = self.levels.iter().rposition(fine).unwrap_or(0);
                all[level].push(*copy);
            }
        }
        all
    }

    fn make(&mut self, object: &Object, level: usize) -> Result<Made> {
        let same = |made: &&Made| {
            Arc::ptr_eq(&made.profile, &object.profile)
                && made.offset == object.offset
                && made.level == level
        };
        if let Some(made) = self.made.iter().find(same) {
            return Ok(made.clone());
        }
        let known = |(profile, _): &(Arc<Profile>, _)| Arc::ptr_eq(profile, &object.profile);
        if !self.sources.iter().any(known) {
            let source = ContourSource::new(&object.profile.outline)?;
            self.sources.insert(0, (object.profile.clone(), source));
        }
        let place = self.sources.iter().position(known).unwrap_or_default();
        let contour = self.sources[place].1.contour(&object.offset)?;
        let (segments, rings, _) = self.levels[level];
        let made = Made {
            profile: object.profile.clone(),
            offset: object.offset,
            level,
            mesh: Arc::new(Mesh::new(&contour, segments, rings)),
        };
        self.made.push(made.clone());
        self.made_count += 1;
        Ok(made)
    }
}

/// The height of a copy's sphere in pixels; none beside the picture or behind the eye.
fn pixels_high(
    object: &Object,
    copy: &Placement,
    camera: &CameraFrame,
    size: (u32, u32),
) -> Option<f64> {
    let half = DVec3::new(object.profile.radius, object.profile.radius, 0.5) * copy.scale;
    let (radius, height) = (half.length(), copy.scale.max_element());
    let middle = copy.position + copy.rotation * DVec3::new(0.0, 0.0, 0.5 * copy.scale.z);
    let way = middle - camera.eye;
    let depth = way.dot(camera.forward);
    if depth < -radius {
        return None;
    }
    let pixel = camera.right.length();
    if depth <= 2.0 * radius {
        return Some(f64::INFINITY);
    }
    // A sphere off the middle of the picture is seen stretched.
    let around = 1.5 * radius / ((depth - radius) * pixel);
    let x = way.dot(camera.right) / (depth * pixel * pixel) + camera.middle[0];
    let y = camera.middle[1] - way.dot(camera.up) / (depth * pixel * pixel);
    let within = |at: f64, size: u32| at + around > 0.0 && at - around < f64::from(size);
    (within(x, size.0) && within(y, size.1)).then(|| height / ((depth - radius) * pixel))
}

fn place(
    object: &Object,
    mut placements: Vec<Placement>,
    growth: &Growth,
    mesh: Arc<Mesh>,
    camera: &CameraFrame,
) -> PlacedMesh {
    let depth = |p: &Placement| (p.position - camera.eye).dot(camera.forward);
    placements.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    let eyes: Vec<DVec3> = (placements.iter())
        .map(|p| eye_about_axis(object, p, camera))
        .collect();
    let instances: Vec<InstanceBlock> = placements.iter().map(InstanceBlock::from).collect();
    // Of several instances, all would be drawn in two halves.
    let start = match eyes.as_slice() {
        [eye] => mesh.start(eye.y.atan2(eye.x)),
        _ => 0,
    };
    PlacedMesh {
        block: ObjectBlock::new(object, growth, instances.first()),
        instances,
        projection: object.texturing.projection,
        both_sides: eyes.iter().any(|eye| may_hold(&mesh, *eye)),
        start,
        depth: placements.first().map_or(f64::INFINITY, depth),
        mesh,
    }
}

/// An error at a key of the object.
type KeyError = (&'static str, Error);

fn refused(what: &str) -> Error {
    Error::new(
        ErrorKind::Content,
        format!("a mesh {what}, or take a search"),
    )
}

/// Refuses a scene that meshes do not draw, by its content alone: a mesh that leaves its box is found
/// when it is made.
///
/// # Errors
/// [`ErrorKind::Content`] with the scene's key, for shadows, replicas, maps of colours and heights,
/// and coordinates along the profile.
pub fn check_scene(scene: &Scene) -> Result<()> {
    if scene.shadow != Shadow::Off {
        return Err(refused("casts no shadows; set \"off\"").at_key("shadow"));
    }
    scene
        .objects
        .iter()
        .enumerate()
        .try_for_each(|(number, object)| {
            let fail = |(key, error): KeyError| error.at_key(format!("object.{number}.{key}"));
            check_object(object).map_err(fail)
        })
}

/// Refuses what the baseline does not draw.
fn check_object(object: &Object) -> std::result::Result<(), KeyError> {
    let texturing = &object.texturing;
    let bumps = texturing.displacement_map.is_some() && texturing.bump != 0.0;
    let arc = texturing.projection == Projection::Arc;
    let (key, what) = if object.repeat != [1; 3] {
        ("repeat", "draws one cell; give [1, 1, 1], and instances")
    } else if texturing.color_map.is_some() {
        ("color_map", "draws no colour map; give a color")
    } else if bumps {
        ("height_map", "draws no height map; leave it out")
    } else if arc {
        (
            "projection",
            "has no coordinates along the profile; give \"cylindrical\"",
        )
    } else {
        return Ok(());
    };
    Err((key, refused(what)))
}

/// Refuses a mesh that leaves its box, which does not cut it. `widest`: the largest radius.
fn check_box(object: &Object, widest: f64) -> std::result::Result<(), KeyError> {
    let radius = object.profile.radius;
    let off = object.axis_offset().map(f64::abs);
    if widest + off[0].max(off[1]) <= radius * (1.0 + 1e-9) {
        return Ok(());
    }
    let (key, what) = if off != [0.0; 2] {
        ("axis", "the axis moves it; give [0.5, 0.5]")
    } else if object.offset.extend > 0.0 {
        ("extend", "it reaches; give less")
    } else if object.offset.bevel > 0.0 {
        ("bevel", "it reaches; give less")
    } else {
        ("radius", "it reaches; give more")
    };
    let what = format!("is not cut by its box, past which {what}");
    Err((key, refused(&what)))
}

/// The eye in object space, about the axis.
fn eye_about_axis(object: &Object, placement: &Placement, camera: &CameraFrame) -> DVec3 {
    let [x, y] = object.axis_offset();
    let back = placement.rotation.normalize().conjugate();
    back * (camera.eye - placement.position) / placement.scale - DVec3::new(x, y, 0.0)
}

/// Whether an eye may be inside, or so near that the near plane cuts: then backs are seen.
fn may_hold(mesh: &Mesh, eye: DVec3) -> bool {
    let [r_max, z_min, z_max] = mesh.extent;
    let margin = 0.01;
    eye.truncate().length() <= r_max + margin && (z_min - margin..=z_max + margin).contains(&eye.z)
}
