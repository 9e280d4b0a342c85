//! The meshes of a scene's objects: each made once, placed, in the order in which they are drawn.

use super::blocks::{InstanceBlock, ObjectBlock};
use super::cascades::{Cascade, SHADOW_LIGHTS, cascades};
use super::fineness::Fineness;
use super::sight::{Ball, Sight, eye_about_axis};
use super::tessellation::{Mesh, extent_of};
use glam::DVec3;
use revmap::error::{Error, ErrorKind, Result};
use revmap::maps::Projection;
use revmap::profile::Profile;
use revmap::scene::{CameraFrame, GrownProfiles, Growth, Object, Offset, Placement, Scene, Shadow};
use revmap::surface::{Contour, ContourSource};
use std::collections::BTreeMap;
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

/// The number of a copy's solid, the middle of its box from the axis, and its placement.
type Copy = (usize, [f64; 2], Placement);

/// Copies of one mesh in a shadow map.
pub(super) struct PlacedCaster {
    pub mesh: Arc<Mesh>,
    pub axis: [f64; 2],
    pub instances: Vec<InstanceBlock>,
}

/// A shadow map and what is drawn into it.
pub(super) type PlacedMap = (Cascade, Vec<PlacedCaster>);

/// What a frame draws.
pub(super) struct Placed {
    /// The nearest first.
    pub meshes: Vec<PlacedMesh>,
    /// Of each light, the nearest to the eye first; none without shadows.
    pub maps: Vec<Vec<PlacedMap>>,
}

/// Makes and keeps the meshes of a scene; objects of one profile and offset share them.
pub(super) struct SceneMeshes {
    fineness: Fineness,
    /// Of the picture, pixels.
    size: (u32, u32),
    sources: Vec<(Arc<Profile>, ContourSource)>,
    /// Profiles in boxes that have grown with offsets.
    grown: GrownProfiles,
    solids: Vec<Solid>,
    /// How many meshes were made so far.
    pub made_count: u64,
}

/// A profile under an offset, and its meshes.
struct Solid {
    profile: Arc<Profile>,
    offset: Offset,
    contour: Contour,
    /// Largest radius, least and largest `z` of the contour.
    extent: [f64; 3],
    levels: BTreeMap<i32, Arc<Mesh>>,
    used: bool,
}

impl Solid {
    /// The mesh of a level, made now and counted if it is new.
    fn level(&mut self, level: i32, fineness: Fineness, made_count: &mut u64) -> Arc<Mesh> {
        let new = || {
            *made_count += 1;
            Arc::new(fineness.mesh(&self.contour, level))
        };
        self.levels.entry(level).or_insert_with(new).clone()
    }
}

impl SceneMeshes {
    /// Meshes of this fineness, for pictures of this size.
    pub fn new(fineness: Fineness, size: (u32, u32)) -> Self {
        Self {
            fineness,
            size,
            sources: Vec::new(),
            grown: GrownProfiles::default(),
            solids: Vec::new(),
            made_count: 0,
        }
    }

    /// The meshes of a checked scene, the nearest first. Only those whose profile, offset or level
    /// is new are made. Meshes stay as long as an object has their profile and offset.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for what meshes do not draw, and for a profile without a contour.
    pub fn place(&mut self, scene: &Scene, camera: &CameraFrame) -> Result<Placed> {
        check_scene(scene)?;
        let shaded = scene.shadow != Shadow::Off;
        let mut balls = Vec::new();
        let mut copies_of = Vec::new();
        self.solids.iter_mut().for_each(|solid| solid.used = false);
        let sight = Sight::new(camera, self.size);
        let mut placed = Vec::new();
        for (number, object) in scene.objects.iter().enumerate() {
            let under = |key: &str| format!("object.{number}.{key}");
            let grown = self.grown.grown(object);
            let growth = Growth::of(object);
            let object = grown.as_ref().map_or(object, |g| &g.object);
            let number_of_solid = self.solid(object).map_err(|error| {
                let error = error.at_key(under("profile"));
                match &object.file {
                    Some(file) => error.in_file(file),
                    None => error,
                }
            })?;
            let (solid, fineness) = (&mut self.solids[number_of_solid], self.fineness);
            check_box(object, solid.extent[0]).map_err(|(key, error)| error.at_key(under(key)))?;
            let shape = (&solid.contour, &solid.extent);
            for (level, copies) in fineness.by_level(object, shape, &sight) {
                let mesh = solid.level(level, fineness, &mut self.made_count);
                placed.push(place(object, copies, &growth, mesh, camera));
            }
            if shaded {
                let all = object.placements();
                balls.extend(all.iter().map(|p| sight.ball(object, &solid.extent, p)));
                copies_of.extend(
                    all.iter()
                        .map(|p| (number_of_solid, object.axis_offset(), *p)),
                );
            }
        }
        let maps = if shaded {
            self.shadow_maps(scene, camera, (&balls, &copies_of))
        } else {
            Vec::new()
        };
        self.solids.retain(|solid| solid.used);
        let (sources, solids) = (&mut self.sources, &self.solids);
        sources.retain(|(known, _)| solids.iter().any(|s| Arc::ptr_eq(&s.profile, known)));
        placed.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        Ok(Placed {
            meshes: placed,
            maps,
        })
    }

    /// The shadow maps of each light, and the meshes in them.
    fn shadow_maps(
        &mut self,
        scene: &Scene,
        camera: &CameraFrame,
        (balls, copies): (&[Ball], &[Copy]),
    ) -> Vec<Vec<PlacedMap>> {
        let mut of_light = |towards| {
            let mut all = Vec::new();
            for map in cascades(balls, camera, self.size, towards) {
                let mut casters: BTreeMap<(usize, i32, [u64; 2]), PlacedCaster> = BTreeMap::new();
                for &n in &map.casters {
                    let (number, axis, placement) = &copies[n];
                    let (solid, fineness) = (&mut self.solids[*number], self.fineness);
                    // Silhouettes from the light keep the tolerance in texels.
                    let level = fineness.level(balls[n].scale / map.texel);
                    let mesh = solid.level(level, fineness, &mut self.made_count);
                    let new = || PlacedCaster {
                        mesh,
                        axis: *axis,
                        instances: Vec::new(),
                    };
                    let key = (*number, level, axis.map(f64::to_bits));
                    let caster = casters.entry(key).or_insert_with(new);
                    caster.instances.push(placement.into());
                }
                all.push((map, casters.into_values().collect()));
            }
            all
        };
        let lights = scene.lights.iter();
        lights
            .map(|light| of_light(-light.direction.normalize_or_zero()))
            .collect()
    }

    /// The place of an object's solid among all.
    fn solid(&mut self, object: &Object) -> Result<usize> {
        let same = |solid: &Solid| {
            Arc::ptr_eq(&solid.profile, &object.profile) && solid.offset == object.offset
        };
        if let Some(place) = self.solids.iter().position(same) {
            self.solids[place].used = true;
            return Ok(place);
        }
        let known = |(profile, _): &(Arc<Profile>, _)| Arc::ptr_eq(profile, &object.profile);
        if !self.sources.iter().any(known) {
            let source = ContourSource::new(&object.profile.outline)?;
            self.sources.insert(0, (object.profile.clone(), source));
        }
        let source = self.sources.iter().position(known).unwrap_or_default();
        let contour = self.sources[source].1.contour(&object.offset)?;
        self.solids.push(Solid {
            profile: object.profile.clone(),
            offset: object.offset,
            extent: extent_of(&contour),
            contour,
            levels: BTreeMap::new(),
            used: true,
        });
        Ok(self.solids.len() - 1)
    }
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
        .map(|p| eye_about_axis(object, p, camera.eye))
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
/// [`ErrorKind::Content`] with the scene's key, for shadows of more lights, replicas, maps of colours and heights,
/// and coordinates along the profile.
pub fn check_scene(scene: &Scene) -> Result<()> {
    if scene.shadow != Shadow::Off && scene.lights.len() > SHADOW_LIGHTS {
        let what = format!("has shadow maps for {SHADOW_LIGHTS} lights; give fewer lights");
        return Err(refused(&what).at_key("light"));
    }
    let mut objects = scene.objects.iter().enumerate();
    objects.try_for_each(|(number, object)| {
        check_object(object).map_err(|(key, e)| e.at_key(format!("object.{number}.{key}")))
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

/// Whether an eye may be inside, or so near that the near plane cuts: then backs are seen.
fn may_hold(mesh: &Mesh, eye: DVec3) -> bool {
    let [r_max, z_min, z_max] = mesh.extent;
    let margin = 0.01;
    eye.truncate().length() <= r_max + margin && (z_min - margin..=z_max + margin).contains(&eye.z)
}
