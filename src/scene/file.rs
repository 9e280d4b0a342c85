//! Scenes from TOML files (feature `scene-file`).
//!
//! Paths are relative to the scene file. Unknown keys are errors. Every key but an object's
//! `profile` (or `polygon`) and the camera's `eye` and `target` has a default.
//!
//! | key | meaning | default |
//! |---|---|---|
//! | `background` | linear RGBA behind everything | `[0, 0, 0, 0]` |
//! | `ambient` | light from everywhere, linear RGB | `[0.1, 0.1, 0.1]` |
//! | `shadow` | `"off"`, `"hard"` or `"soft"` | `"off"` |
//! | `camera.eye`, `camera.target` | where the eye is and what it looks at, world units | |
//! | `camera.up` | which way is up | `[0, 0, 1]` |
//! | `camera.fov_y` | vertical field of view, degrees | `40` |
//! | `light.N.direction` | the way the light travels | `[-0.4, -0.6, -0.7]` |
//! | `light.N.color` | linear RGB | `[1, 1, 1]` |
//! | `light.N.radius` | angular radius of the light's disc for soft shadows, degrees, 0 to 60 | `2` |
//! | `object.N.profile` | an image or an SVG drawing, dark = solid | |
//! | `object.N.polygon` | in its place: `[[r, z], ...]`, object units, closed by itself | |
//! | `object.N.profile_axis` | `"left"`: half a profile; `"center"`: a silhouette | `"center"` |
//! | `object.N.profile_threshold` | pictures: grey level below which a pixel is solid, 0 black to 1 white | `0.5` |
//! | `object.N.profile_invert` | pictures: whether light is solid instead | `false` |
//! | `object.N.profile_smooth` | pictures: noise is blurred away by a Gaussian of this many texels (pixels of the picture); `"auto"`: as many as the noise needs, none for a clean picture | `0` |
//! | `object.N.radius` | `R` of the shape box, for polygons; images give it by their shape | `0.5`, or the largest `r` of the points if that is more |
//! | `object.N.map_rows` | rows of the shape map | `512` |
//! | `object.N.color` | linear RGB | `[0.8, 0.8, 0.8]` |
//! | `object.N.color_map` | an image in place of `color` | |
//! | `object.N.specular` | weight of the Blinn-Phong highlight | `0.25` |
//! | `object.N.shininess` | its exponent | `32` |
//! | `object.N.height_map` | an image of heights for bump mapping | |
//! | `object.N.bump` | `a`, the depth of the bumps | `1` |
//! | `object.N.bump_form` | `"surface-gradient"` or `"papers"` | `"surface-gradient"` |
//! | `object.N.projection` | `"planar"`, `"cylindrical"`, `"spherical"` or `"arc"` | from the profile's name (`vase.spherical.png`), else `"cylindrical"` |
//! | `object.N.texture_repeat` | repetitions along `xi`, `eta` | `[1, 1]` |
//! | `object.N.extend` | `e`, object units; negative insets | `0` |
//! | `object.N.bevel` | `b`, slope | `0` |
//! | `object.N.chamfer` | `c`, depth in `[0, 1]` to which the bevel reaches | `1` |
//! | `object.N.clip` | `"none"`: the shape box grows with the offset; `"box"`: the papers' fixed box cuts the solid; replicas are cut by their cells | `"none"` |
//! | `object.N.axis` | `(Ox, Oy)`, box texture coordinates | `[0.5, 0.5]` |
//! | `object.N.repeat` | cells of the box along x, y, z | `[1, 1, 1]` |
//! | `object.N.mirror` | whether every other cell is mirrored | `[false, false, false]` |
//! | `object.N.position` | of the middle of the box's lower face | `[0, 0, 0]` |
//! | `object.N.rotation` | quaternion x y z w, of any length but zero | `[0, 0, 0, 1]` |
//! | `object.N.scale` | `S` | `[1, 1, 1]` |
//! | `object.N.instances` | a CSV file of rows `x,y,z,qx,qy,qz,qw,sx,sy,sz`, one for each copy | |
//!
//! A scene without a `[[light]]` has the default light above and a weak one from the other side,
//! `direction = [0.9, 0.45, -0.2]`, `color = [0.25, 0.28, 0.33]`. `light = []` switches both off.

use super::instances;
use super::keys::Keys;
use super::values::{camera, light, offset, placement, specular};
use super::{BumpForm, Camera, Clip, Object, Scene, Shadow, Texturing, overrides};
use crate::error::{Error, ErrorKind, Result};
use crate::maps::{ColorMap, DisplacementMap, Projection};
use crate::profile::{Profile, ProfileAxis, ProfileOptions, Smooth};
use glam::DVec3;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::{Table, Value};

/// Keys of the whole file.
const SCENE: &[&str] = &[
    "background",
    "ambient",
    "shadow",
    "camera",
    "light",
    "object",
];
/// Keys of `[[object]]`.
const OBJECT: &[&str] = &[
    "profile",
    "polygon",
    "profile_axis",
    "profile_threshold",
    "profile_invert",
    "profile_smooth",
    "radius",
    "map_rows",
    "color",
    "color_map",
    "specular",
    "shininess",
    "height_map",
    "bump",
    "bump_form",
    "projection",
    "texture_repeat",
    "extend",
    "bevel",
    "chamfer",
    "clip",
    "axis",
    "repeat",
    "mirror",
    "position",
    "rotation",
    "scale",
    "instances",
];
/// `R` of a polygon's box unless the file gives another.
const RADIUS: f64 = 0.5;

/// Reads the scene `file` and all files that it names. Each of `sets` is `key=value` and replaces
/// the file's value: `object.0.bevel=0.4`, `camera.eye=[1, 2, 3]`, `object.1.profile=vase.svg`.
///
/// # Errors
/// [`ErrorKind::Content`] and [`ErrorKind::File`], with file and key; [`ErrorKind::Usage`] for a
/// malformed assignment, with its key or `sets`.
pub fn load(file: impl AsRef<Path>, sets: &[String]) -> Result<Scene> {
    SceneFile::open(file)?.scene(sets)
}

/// Reads a scene from `text`; paths in it are relative to `folder`. `sets` as in [`load`].
///
/// # Errors
/// The errors of [`load`]; faults of the text itself name no file.
pub fn parse(text: &str, folder: impl AsRef<Path>, sets: &[String]) -> Result<Scene> {
    SceneFile::parse(text, folder)?.scene(sets)
}

/// A scene file for scenes that differ in some keys: files that it names are read once and shared
/// by all scenes.
pub struct SceneFile {
    root: Table,
    file: Option<PathBuf>,
    reader: Reader,
}

impl SceneFile {
    /// Reads the text of `file`, a scene in TOML. A profile (SVG or a picture) gets a scene of its
    /// own: all of it, seen from in front and a little above. Noise of a picture is smoothed
    /// ([`Smooth::Auto`]).
    ///
    /// # Errors
    /// [`ErrorKind::File`] for a file that cannot be read; the errors of a profile.
    pub fn open(file: impl AsRef<Path>) -> Result<Self> {
        let file = file.as_ref();
        let folder = file.parent().unwrap_or(Path::new(""));
        let is_profile = |e: &str| ["svg", "svgz", "png", "jpg", "jpeg"].contains(&e);
        let ending = file.extension().map(|e| e.to_string_lossy().to_lowercase());
        if ending.is_some_and(|e| is_profile(&e)) {
            return Self::of_profile(file, folder);
        }
        let text = std::fs::read_to_string(file).map_err(|e| {
            Error::new(
                ErrorKind::File,
                format!("cannot be read ({e}); give a scene in TOML"),
            )
            .in_file(file)
        })?;
        let mut read = Self::parse(&text, folder).map_err(|e| e.in_file(file))?;
        read.file = Some(file.to_owned());
        Ok(read)
    }

    /// Reads `text`; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// [`ErrorKind::File`] for text that is not TOML.
    pub fn parse(text: &str, folder: impl AsRef<Path>) -> Result<Self> {
        Ok(Self {
            root: text.parse().map_err(|e| syntax(text, &e))?,
            file: None,
            reader: Reader::new(folder.as_ref()),
        })
    }

    fn of_profile(file: &Path, folder: &Path) -> Result<Self> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let mut reader = Reader::new(folder);
        let options = ProfileOptions {
            smooth: Smooth::Auto,
            ..ProfileOptions::default()
        };
        let profile = reader.load_profile(file, options)?;
        // The distance at which a sphere about the box fills the picture's height.
        let reach = profile.radius.hypot(0.5) * 1.05;
        let distance = reach / (0.5 * Camera::FOV_Y).to_radians().sin();
        let eye = DVec3::new(0.0, 0.0, 0.5) + distance * DVec3::new(0.9, 0.3, 0.32).normalize();
        let numbers = |v: DVec3| Value::Array(v.to_array().map(Value::Float).to_vec());
        let mut camera = Table::new();
        camera.insert("eye".into(), numbers(eye));
        camera.insert("target".into(), numbers(DVec3::new(0.0, 0.0, 0.5)));
        let mut object = Table::new();
        object.insert("profile".into(), Value::String(name.into_owned()));
        object.insert("profile_smooth".into(), Value::String("auto".into()));
        let mut root = Table::new();
        root.insert("camera".into(), Value::Table(camera));
        root.insert("object".into(), Value::Array(vec![Value::Table(object)]));
        Ok(Self {
            root,
            file: None,
            reader,
        })
    }

    /// Every file that was read for its scenes.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let reader = &self.reader;
        let profiles = reader.profiles.iter().map(|(file, ..)| file);
        profiles
            .chain(reader.color_maps.keys())
            .chain(reader.height_maps.keys())
            .chain(&reader.instances)
            .chain(&self.file)
            .map(PathBuf::as_path)
    }

    /// The scene, with each of `sets` (`key=value`, as in [`load`]) replacing the file's value.
    ///
    /// # Errors
    /// The errors of [`load`].
    pub fn scene(&mut self, sets: &[String]) -> Result<Scene> {
        let mut root = self.root.clone();
        let mut read = || {
            for assignment in sets {
                overrides::apply(&mut root, assignment)?;
            }
            let scene = self.reader.scene(&root)?;
            scene.check()?;
            Ok(scene)
        };
        read().map_err(|e: Error| match &self.file {
            Some(file) => e.in_file(file),
            None => e,
        })
    }

    /// The file's text with each of `sets` (`key=value`, as in [`load`]) replacing the file's
    /// value. Paths in the text are relative to the same folder; comments and the order of keys are
    /// lost.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a malformed assignment.
    pub fn text(&self, sets: &[String]) -> Result<String> {
        let mut root = self.root.clone();
        for assignment in sets {
            overrides::apply(&mut root, assignment)?;
        }
        let fault = |e| Error::new(ErrorKind::Other, format!("cannot be written as TOML: {e}"));
        toml::to_string(&root).map_err(fault)
    }
}

/// A fault of TOML's grammar, on one line.
fn syntax(text: &str, error: &toml::de::Error) -> Error {
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..start).unwrap_or("");
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    Error::new(ErrorKind::File, format!("is not TOML: {message}"))
        .at_key(format!("line {line}, column {column}"))
}

/// Files read so far: those named more than once are read once and shared.
struct Reader {
    folder: PathBuf,
    profiles: Vec<(PathBuf, ProfileOptions, Arc<Profile>)>,
    /// Polygon profiles with their points and radius.
    polygons: Vec<(Vec<[f64; 2]>, f64, Arc<Profile>)>,
    color_maps: HashMap<PathBuf, Arc<ColorMap>>,
    height_maps: HashMap<PathBuf, Arc<DisplacementMap>>,
    instances: Vec<PathBuf>,
}

impl Reader {
    fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            profiles: Vec::new(),
            polygons: Vec::new(),
            color_maps: HashMap::new(),
            height_maps: HashMap::new(),
            instances: Vec::new(),
        }
    }

    fn scene(&mut self, root: &Table) -> Result<Scene> {
        let keys = Keys::new(root, "", SCENE)?;
        let empty = Table::new();
        let mut scene = Scene::new(camera(keys.table("camera")?.unwrap_or(&empty))?);
        scene.background = keys.floats("background")?.unwrap_or(scene.background);
        scene.ambient = keys.floats("ambient")?.unwrap_or(scene.ambient);
        scene.shadow = keys.one_of("shadow", &Shadow::NAMES)?.unwrap_or_default();
        if keys.has("light") {
            let tables = keys.tables("light")?.into_iter().enumerate();
            scene.lights = tables
                .map(|(i, table)| light(table, i))
                .collect::<Result<_>>()?;
        }
        for (i, table) in keys.tables("object")?.into_iter().enumerate() {
            scene.objects.push(self.object(table, i)?);
        }
        if scene.objects.is_empty() {
            return Err(keys.fail(
                "object",
                "the scene is empty; add an [[object]] with a profile",
            ));
        }
        Ok(scene)
    }

    fn object(&mut self, table: &Table, index: usize) -> Result<Object> {
        let keys = Keys::new(table, format!("object.{index}"), OBJECT)?;
        let mut object = self.profile(&keys)?;
        object.map_rows = keys.count("map_rows")?.unwrap_or(object.map_rows);
        object.color = keys.floats("color")?.unwrap_or(object.color);
        object.specular = specular(&keys)?;
        object.texturing = self.texturing(&keys, object.file.as_deref())?;
        object.offset = offset(&keys)?;
        object.clip = keys.one_of("clip", &Clip::NAMES)?.unwrap_or_default();
        object.axis = keys.numbers("axis")?.unwrap_or(object.axis);
        object.repeat = keys.counts("repeat")?.unwrap_or(object.repeat);
        object.mirror = keys.flags("mirror")?.unwrap_or(object.mirror);
        object.placement = placement(&keys)?;
        if let Some(file) = keys.file("instances", &self.folder)? {
            object.instances = instances::load(&file)?.into();
            if !self.instances.contains(&file) {
                self.instances.push(file);
            }
        }
        Ok(object)
    }

    /// An object with its profile, and defaults otherwise.
    fn profile(&mut self, keys: &Keys) -> Result<Object> {
        let file = keys.file("profile", &self.folder)?;
        let polygon = keys.pairs("polygon")?;
        let plain = ProfileOptions::default();
        let options = ProfileOptions {
            axis: keys.one_of("profile_axis", &AXES)?.unwrap_or(plain.axis),
            threshold: keys.number("profile_threshold")?.unwrap_or(plain.threshold),
            invert: keys.flag("profile_invert")?.unwrap_or(plain.invert),
            smooth: match keys.number_or_auto("profile_smooth")? {
                Some(Some(pixels)) => Smooth::Pixels(pixels),
                Some(None) => Smooth::Auto,
                None => plain.smooth,
            },
        };
        let widths = polygon.iter().flatten().map(|[r, _]| *r);
        let widths = widths.filter(|r| r.is_finite());
        let radius = keys
            .number("radius")?
            .unwrap_or_else(|| widths.fold(RADIUS, f64::max));
        match (file, polygon) {
            (Some(file), None) => {
                let profile = self
                    .load_profile(&file, options)
                    .map_err(|e| below(keys, "profile", e))?;
                let name = file
                    .file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned();
                let mut object = Object::new(name, profile);
                object.file = Some(file);
                Ok(object)
            }
            (None, Some(points)) => {
                let same =
                    |known: &&(Vec<[f64; 2]>, f64, _)| known.0 == points && known.1 == radius;
                if let Some((_, _, profile)) = self.polygons.iter().find(same) {
                    return Ok(Object::new("polygon", profile.clone()));
                }
                let profile =
                    Profile::polygon(&points, radius).map_err(|e| below(keys, "polygon", e))?;
                let profile = Arc::new(profile);
                self.polygons.push((points, radius, profile.clone()));
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
    fn load_profile(&mut self, file: &Path, options: ProfileOptions) -> Result<Arc<Profile>> {
        let same = |known: &&(PathBuf, ProfileOptions, _)| known.0 == file && known.1 == options;
        if let Some((.., known)) = self.profiles.iter().find(same) {
            return Ok(known.clone());
        }
        let new = Arc::new(Profile::load(file, options).map_err(|e| e.in_file(file))?);
        self.profiles.push((file.to_owned(), options, new.clone()));
        Ok(new)
    }

    fn texturing(&mut self, keys: &Keys, profile: Option<&Path>) -> Result<Texturing> {
        let mut covering = Texturing::default();
        if let Some(file) = keys.file("color_map", &self.folder)? {
            let map = shared(&mut self.color_maps, &file, |f| ColorMap::load(f));
            covering.color_map = Some(map.map_err(|e| e.at_key(keys.place("color_map")))?);
        }
        if let Some(file) = keys.file("height_map", &self.folder)? {
            let map = shared(&mut self.height_maps, &file, |f| {
                DisplacementMap::from_image(f)
            });
            covering.displacement_map = Some(map.map_err(|e| e.at_key(keys.place("height_map")))?);
        }
        covering.bump = keys.number("bump")?.unwrap_or(covering.bump);
        covering.bump_form = keys
            .one_of("bump_form", &BumpForm::NAMES)?
            .unwrap_or_default();
        covering.projection = keys
            .one_of("projection", &Projection::ALL.map(|p| (p.name(), p)))?
            .or_else(|| profile.and_then(Projection::of_file))
            .unwrap_or_default();
        covering.repeat = keys.numbers("texture_repeat")?.unwrap_or(covering.repeat);
        Ok(covering)
    }
}

/// A fault with its own key, or else `key`, put below the object's.
fn below(keys: &Keys, key: &str, mut error: Error) -> Error {
    let own = error.key.take();
    error.at_key(keys.place(own.as_deref().unwrap_or(key)))
}

/// The content of `file`, read when it is first named.
fn shared<T>(
    known: &mut HashMap<PathBuf, Arc<T>>,
    file: &Path,
    read: impl Fn(&Path) -> Result<T>,
) -> Result<Arc<T>> {
    if let Some(value) = known.get(file) {
        return Ok(value.clone());
    }
    let value = Arc::new(read(file)?);
    known.insert(file.to_path_buf(), value.clone());
    Ok(value)
}

const AXES: [(&str, ProfileAxis); 2] =
    [("left", ProfileAxis::Left), ("center", ProfileAxis::Center)];

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
