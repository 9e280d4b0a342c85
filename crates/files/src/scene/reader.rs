//! Tables of a scene file into a scene, with all files that they name.

use super::keys::{Keys, OBJECT};
use super::polygon;
use super::{extent, instances};
use crate::pixels::is_picture;
use crate::profile::{gap_hints, outline_over, read_file};
use crate::{
    Picture, ProfileAxis, ProfileOptions, ProfileRead, Smooth, color_map, displacement_map,
    profile, profile_from_bytes, projection_of,
};
use glam::DQuat;
use revmap::error::{Error, Result};
use revmap::maps::{ColorMap, DisplacementMap, Projection, SlopeFilter};
use revmap::profile::Profile;
use revmap::scene::{
    BumpForm, Camera, Clip, Environment, Light, Material, Object, Offset, Placement, Scene, Shadow,
    Specular, Texturing,
};
use std::collections::HashMap;
use std::hash::Hash;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Table;

/// Keys of the whole file.
pub(super) const SCENE: &str = "background ambient environment shadow stand camera light object";
/// Keys of `[camera]`.
pub(super) const CAMERA: &str = "eye target up fov_y";
/// Keys of `environment`.
pub(super) const ENVIRONMENT: &str = "up down";
/// Keys of `[[light]]`.
pub(super) const LIGHT: &str = "direction color radius";
/// Keys that place one copy.
const PLACEMENT: [&str; 4] = ["position", "turn", "rotation", "scale"];
/// `R` of a polygon's box unless the file gives another.
const RADIUS: f64 = 0.5;

/// Most colours that transparent colour maps are kept over.
const MOST_COLORS: usize = 64;

/// Files read so far: those named more than once are read once and shared.
#[derive(Default)]
pub(super) struct Reader {
    folder: PathBuf,
    profiles: Vec<(PathBuf, ProfileOptions, Arc<Profile>)>,
    /// Polygon profiles by their points and radius as text.
    polygons: HashMap<String, Arc<Profile>>,
    color_maps: HashMap<PathBuf, Arc<ColorMap>>,
    /// Colour maps with transparent texels over the colours of objects, which are told by their bits.
    opaque_maps: HashMap<(PathBuf, [u32; 3]), Arc<ColorMap>>,
    height_maps: HashMap<PathBuf, Arc<DisplacementMap>>,
    instances: Vec<PathBuf>,
    /// The profile that stands in place of a scene.
    kept: Option<KeptProfile>,
}

/// A profile's file that was read already.
struct KeptProfile {
    /// The path by which the scene's table names it: UTF-8.
    named: PathBuf,
    file: PathBuf,
    bytes: Vec<u8>,
}

impl Reader {
    pub(super) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            ..Self::default()
        }
    }

    /// Keeps the content of the profile `file`, which the table calls `named`.
    pub(super) fn keep(&mut self, named: PathBuf, file: &Path, bytes: Vec<u8>) {
        let file = file.to_owned();
        self.kept = Some(KeptProfile { named, file, bytes });
    }

    /// The file of a profile whose name no table can hold.
    pub(super) fn unnamed(&self) -> Option<&Path> {
        let kept = self.kept.as_ref().filter(|kept| kept.named != kept.file)?;
        Some(&kept.file)
    }

    /// Returns true if a profile stands in place of the scene.
    pub(super) fn stands_for_scene(&self) -> bool {
        self.kept.is_some()
    }

    /// Returns true if a picture does.
    pub(super) fn stands_for_picture(&self) -> bool {
        let kept = self.kept.as_ref();
        kept.is_some_and(|kept| is_picture(&kept.bytes))
    }

    /// The first profile that is a picture, with its outline.
    pub(super) fn show_outline(&self) -> Result<Option<Picture>> {
        for (named, options, _) in &self.profiles {
            let bytes = match self.kept.as_ref().filter(|kept| kept.named == *named) {
                Some(kept) => kept.bytes.clone(),
                None => read_file(named).map_err(|e| e.in_file(named))?,
            };
            if is_picture(&bytes) {
                let shown = outline_over(&bytes, options);
                return shown.map(Some).map_err(|e| e.in_file(named));
            }
        }
        Ok(None)
    }

    /// Every file that was read.
    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let profiles = self.profiles.iter().map(|(named, ..)| {
            let kept = self.kept.as_ref().filter(|kept| kept.named == *named);
            kept.map_or(named, |kept| &kept.file)
        });
        profiles
            .chain(self.color_maps.keys())
            .chain(self.height_maps.keys())
            .chain(&self.instances)
    }

    pub(super) fn scene(&mut self, root: &Table) -> Result<Scene> {
        let keys = Keys::new(root, "", SCENE)?;
        let empty = Table::new();
        let mut scene = Scene::new(camera(keys.table("camera")?.unwrap_or(&empty))?);
        keys.set("background", &mut scene.background)?;
        keys.set("ambient", &mut scene.ambient)?;
        scene.environment = keys.table("environment")?.map(environment).transpose()?;
        keys.choose("shadow", &Shadow::NAMES, &mut scene.shadow)?;
        if let Some(tables) = keys.tables("light")? {
            let lights = tables.into_iter().enumerate();
            scene.lights = lights.map(light).collect::<Result<_>>()?;
        }
        let mut stand = false;
        keys.set("stand", &mut stand)?;
        let objects = keys.tables("object")?.unwrap_or_default();
        for (index, table) in objects.into_iter().enumerate() {
            scene.objects.push(self.object(table, index, stand)?);
        }
        if scene.objects.is_empty() {
            return Err(keys.fail(
                "object",
                "the scene is empty; add an [[object]] with a profile",
            ));
        }
        Ok(scene)
    }

    /// The object of a table; `stand` if the table does not say.
    fn object(&mut self, table: &Table, index: usize, mut stand: bool) -> Result<Object> {
        let keys = Keys::new(table, format!("object.{index}"), OBJECT)?;
        let mut object = self.profile(&keys)?;
        keys.set("map_rows", &mut object.map_rows)?;
        keys.color("color", &mut object.color)?;
        let Specular {
            strength,
            shininess,
        } = &mut object.specular;
        keys.set("specular", strength)?;
        keys.set("shininess", shininess)?;
        let (roughness, metalness) = (keys.get("roughness")?, keys.get("metalness")?);
        if roughness.is_some() || metalness.is_some() {
            let own = object.material();
            object.material = Some(Material {
                roughness: roughness.unwrap_or(own.roughness),
                metalness: metalness.unwrap_or(own.metalness),
            });
        }
        object.texturing = self.texturing(&keys, object.file.as_deref(), object.color)?;
        let Offset {
            extend,
            bevel,
            chamfer,
        } = &mut object.offset;
        keys.set("extend", extend)?;
        keys.set("bevel", bevel)?;
        keys.set("chamfer", chamfer)?;
        keys.choose("clip", &Clip::NAMES, &mut object.clip)?;
        keys.set("axis", &mut object.axis)?;
        keys.set("repeat", &mut object.repeat)?;
        keys.set("mirror", &mut object.mirror)?;
        object.placement = placement(&keys)?;
        if let Some(file) = keys.file("instances", &self.folder)? {
            if let Some(key) = PLACEMENT.into_iter().find(|key| table.contains_key(*key)) {
                return Err(keys.fail(
                    key,
                    "stands beside instances, whose rows place the copies; leave it out",
                ));
            }
            object.instances = instances::load(&file)?.into();
            if !self.instances.contains(&file) {
                self.instances.push(file);
            }
        }
        keys.set("stand", &mut stand)?;
        if stand {
            // Its values are checked first, so that a fault is named by its key.
            object.check().map_err(|e| below(&keys, "stand", e))?;
            extent::stand(&mut object);
        }
        Ok(object)
    }

    /// An object with its profile, and defaults otherwise.
    fn profile(&mut self, keys: &Keys) -> Result<Object> {
        let file = keys.file("profile", &self.folder)?;
        let polygon = keys.pairs("polygon")?;
        let mut options = ProfileOptions::default();
        let (axis, names) = (&mut options.axis, &ProfileAxis::NAMES);
        if keys
            .choose("profile_axis", &[ProfileAxis::BRITISH], axis)
            .is_err()
        {
            keys.choose_or_number("profile_axis", names, ProfileAxis::At, axis)?;
        }
        keys.choose("profile_read", &ProfileRead::NAMES, &mut options.read)?;
        keys.set("profile_threshold", &mut options.threshold)?;
        keys.set("profile_invert", &mut options.invert)?;
        options.smooth = match keys.number_or_auto("profile_smooth")? {
            Some(Some(pixels)) => Smooth::Pixels(pixels),
            Some(None) => Smooth::Auto,
            None => options.smooth,
        };
        keys.set("profile_min_stroke", &mut options.min_stroke)?;
        let of_option = |e| below(keys, "profile", e);
        options.check().map_err(of_option)?;
        let widths = polygon.iter().flatten().map(|[r, _]| *r);
        let mut radius = widths.filter(|r| r.is_finite()).fold(RADIUS, f64::max);
        keys.set("radius", &mut radius)?;
        match (file, polygon) {
            (Some(file), None) => {
                let profile = self
                    .load_profile(&file, options)
                    .map_err(|e| below(keys, "profile", e))?;
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                let mut object = Object::new(name, profile);
                object.file = Some(file);
                Ok(object)
            }
            (None, Some(points)) => {
                options
                    .for_polygon()
                    .map_err(|e| below(keys, "polygon", e))?;
                let key = format!("{points:?} {radius:?}");
                let profile = shared(&mut self.polygons, key, |_| {
                    let mut profile = Profile::polygon(&points, radius)?;
                    profile.warnings.extend(polygon::cut_off(&points, radius));
                    profile.warnings.extend(polygon::open_wall(&points));
                    profile.warnings.extend(gap_hints(&profile.outline));
                    Ok(profile)
                });
                let profile = profile.map_err(|e| below(keys, "polygon", e))?;
                Ok(Object::new("polygon", profile))
            }
            (None, None) => Err(keys.fail(
                "profile",
                "is missing; name an image or a drawing, or give a polygon",
            )),
            (Some(_), Some(_)) => {
                Err(keys.fail("polygon", "stands beside a profile; give one of the two"))
            }
        }
    }

    /// A file's profile, read once.
    pub(super) fn load_profile(
        &mut self,
        file: &Path,
        options: ProfileOptions,
    ) -> Result<Arc<Profile>> {
        let same = |known: &&(PathBuf, ProfileOptions, _)| known.0 == file && known.1 == options;
        if let Some((.., known)) = self.profiles.iter().find(same) {
            return Ok(known.clone());
        }
        let new = match self.kept.as_ref().filter(|kept| kept.named == file) {
            Some(kept) => {
                profile_from_bytes(&kept.bytes, options).map_err(|e| e.in_file(&kept.file))?
            }
            None => profile(file, options)?,
        };
        let new = Arc::new(new);
        self.profiles.push((file.to_owned(), options, new.clone()));
        Ok(new)
    }

    /// `color` shows where the colour map is transparent.
    fn texturing(
        &mut self,
        keys: &Keys,
        profile: Option<&Path>,
        color: [f32; 3],
    ) -> Result<Texturing> {
        let mut covering = Texturing {
            projection: profile.and_then(projection_of).unwrap_or_default(),
            ..Texturing::default()
        };
        if let Some(file) = keys.file("color_map", &self.folder)? {
            let at_key = |e: Error| e.at_key(keys.place("color_map"));
            let map = shared(&mut self.color_maps, file.clone(), |f| color_map(f));
            let map = map.map_err(at_key)?;
            covering.color_map = Some(match map.is_opaque() {
                true => map,
                false => {
                    // A colour that changes from frame to frame would fill the memory.
                    if self.opaque_maps.len() >= MOST_COLORS {
                        self.opaque_maps.clear();
                    }
                    let key = (file, color.map(f32::to_bits));
                    shared(&mut self.opaque_maps, key, |_| map.over(color)).map_err(at_key)?
                }
            });
        }
        if let Some(file) = keys.file("height_map", &self.folder)? {
            let read = |f: &PathBuf| displacement_map(f, SlopeFilter::default());
            let map = shared(&mut self.height_maps, file, read);
            covering.displacement_map = Some(map.map_err(|e| e.at_key(keys.place("height_map")))?);
        }
        keys.set("bump", &mut covering.bump)?;
        keys.choose("bump_form", &BumpForm::NAMES, &mut covering.bump_form)?;
        keys.choose("projection", &Projection::NAMES, &mut covering.projection)?;
        keys.set("texture_repeat", &mut covering.repeat)?;
        keys.set("texture_offset", &mut covering.offset)?;
        Ok(covering)
    }
}

fn camera(table: &Table) -> Result<Camera> {
    let keys = Keys::new(table, "camera", CAMERA)?;
    let needed = |key: &str| {
        let missing = || keys.fail(key, "is missing; give three numbers, as in [1.6, 0.3, 1.1]");
        keys.get(key)?.ok_or_else(missing)
    };
    let mut camera = Camera::new(needed("eye")?, needed("target")?);
    keys.set("up", &mut camera.up)?;
    keys.set("fov_y", &mut camera.fov_y)?;
    Ok(camera)
}

/// The side that is left out is black.
fn environment(table: &Table) -> Result<Environment> {
    let keys = Keys::new(table, "environment", ENVIRONMENT)?;
    let mut sky = Environment {
        up: [0.0; 3],
        down: [0.0; 3],
    };
    keys.color("up", &mut sky.up)?;
    keys.color("down", &mut sky.down)?;
    Ok(sky)
}

fn light((index, table): (usize, &Table)) -> Result<Light> {
    let keys = Keys::new(table, format!("light.{index}"), LIGHT)?;
    let mut light = Light::default();
    keys.set("direction", &mut light.direction)?;
    keys.color("color", &mut light.color)?;
    keys.set("radius", &mut light.radius)?;
    Ok(light)
}

fn placement(keys: &Keys) -> Result<Placement> {
    let mut placement = Placement::default();
    keys.set("position", &mut placement.position)?;
    keys.set("scale", &mut placement.scale)?;
    if let Some(xyzw) = keys.get("rotation")? {
        let unit = instances::unit(xyzw);
        placement.rotation = unit.map_err(|e| e.at_key(keys.place("rotation")))?;
    }
    let mut turn = 0.0f64;
    keys.set("turn", &mut turn)?;
    if !turn.is_finite() {
        return Err(keys.fail("turn", format!("is {turn:?}; give degrees")));
    }
    if turn != 0.0 {
        placement.rotation *= DQuat::from_rotation_z(turn.to_radians());
    }
    Ok(placement)
}

/// A fault with its own key, or else `key`, put below the object's.
fn below(keys: &Keys, key: &str, mut error: Error) -> Error {
    let own = error.key.take();
    error.at_key(keys.place(own.as_deref().unwrap_or(key)))
}

/// The value of `key`, made when it is first asked for.
fn shared<K: Eq + Hash, T>(
    known: &mut HashMap<K, Arc<T>>,
    key: K,
    make: impl FnOnce(&K) -> Result<T>,
) -> Result<Arc<T>> {
    if let Some(value) = known.get(&key) {
        return Ok(value.clone());
    }
    let value = Arc::new(make(&key)?);
    known.insert(key, value.clone());
    Ok(value)
}
