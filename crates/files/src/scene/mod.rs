//! Scenes from TOML files.
//!
//! Paths are relative to the scene file. Unknown keys are errors. Every key but an object's
//! `profile` (or `polygon`) and the camera's `eye` and `target` has a default.
//! `docs/scene-files.md` of the repository lists every key with its type, range and default.

mod extent;
mod instances;
mod keys;
mod nearest;
mod overrides;
mod polygon;
mod reader;
mod spelling;
mod warnings;

pub use extent::Extent;
pub use spelling::decimal_comma;
pub use warnings::{blank, warnings};

use crate::pixels::foreign;
use crate::profile::is_profile;
use crate::{Picture, ProfileAxis, ProfileOptions, ending, file_fault, read_bytes};
use glam::DVec3;
use reader::Reader;
use revmap::error::{Error, ErrorKind, Result};
use revmap::scene::{Camera, Clip, MOST_GROWTH, Scene};
use revmap_drawing::decoded;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Reads the scene `file` and all files that it names. [`SceneFile`] also replaces values.
///
/// # Errors
/// The errors of [`SceneFile::open`] and [`SceneFile::scene`].
pub fn scene(file: impl AsRef<Path>) -> Result<Scene> {
    SceneFile::open(file)?.scene(&[])
}

/// A scene file for scenes that differ in some keys: files that it names are read once and shared
/// by all scenes.
pub struct SceneFile {
    root: Table,
    file: Option<PathBuf>,
    /// True for a profile in place of a scene, until a camera is chosen.
    chooses_camera: bool,
    reader: Reader,
}

impl SceneFile {
    /// Reads the text of `file`, a scene in TOML. A profile (SVG or a picture, by its content) gets
    /// a scene of its own: all of it, seen from in front and a little above. Noise of a picture is
    /// smoothed ([`Smooth::Auto`](crate::Smooth::Auto)). The file is read once, so it may be a pipe.
    ///
    /// # Errors
    /// [`ErrorKind::File`] for a file that cannot be read; the errors of a profile.
    pub fn open(file: impl AsRef<Path>) -> Result<Self> {
        let file = file.as_ref();
        let folder = file.parent().unwrap_or(Path::new(""));
        let bytes = read_bytes(file).map_err(|e| {
            file_fault(format!(
                "cannot be read ({e}); {}",
                keys::path_hint(&file.to_string_lossy()).map_or(
                    "give a scene in TOML, or a profile".to_owned(),
                    |hint| format!("it {hint}")
                )
            ))
            .in_file(file)
        })?;
        if is_profile(&bytes) {
            return Ok(Self::of_profile(file, folder, bytes));
        }
        let no_text = || {
            let other = "is neither a scene in TOML (UTF-8) nor a PNG, JPEG or SVG; convert it";
            file_fault(foreign(&bytes).unwrap_or_else(|| other.to_owned()))
        };
        let text = decoded(&bytes).ok_or_else(no_text);
        match text.and_then(|text| Self::parse(&text, folder)) {
            Ok(scene) if !scene.root.is_empty() || !is_named_profile(file) => Ok(Self {
                file: Some(file.to_owned()),
                ..scene
            }),
            // The reader of profiles says what is wrong with a file that is named as one.
            _ if is_named_profile(file) => Ok(Self::of_profile(file, folder, bytes)),
            other => other.map_err(|e| e.in_file(file)),
        }
    }

    /// Reads `text`; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// [`ErrorKind::File`] for text that is not TOML.
    pub fn parse(text: &str, folder: impl AsRef<Path>) -> Result<Self> {
        Ok(Self {
            root: text.parse().map_err(|e| syntax(text, &e))?,
            file: None,
            chooses_camera: false,
            reader: Reader::new(folder.as_ref()),
        })
    }

    fn of_profile(file: &Path, folder: &Path, bytes: Vec<u8>) -> Self {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let mut reader = Reader::new(folder);
        // A name that is no text cannot be written in TOML; the bytes are found by this one.
        reader.keep(folder.join(&*name), file, bytes);
        let object = table([
            ("profile", name.into_owned().into()),
            ("profile_read", "auto".into()),
            ("profile_smooth", "auto".into()),
        ]);
        let camera = camera(DVec3::X, DVec3::ZERO);
        let root = table([("camera", camera.into()), ("object", vec![object].into())]);
        Self {
            root,
            file: None,
            chooses_camera: true,
            reader,
        }
    }

    /// Chooses the camera of a profile in place of a scene: it sees all of the object that `sets`
    /// make.
    fn choose_camera(&mut self, sets: &[String]) -> Result<()> {
        let of_object = |set: &&String| set.trim_start().starts_with("object.");
        let sets: Vec<String> = sets.iter().filter(of_object).cloned().collect();
        let scene = self.read(&sets)?;
        let Some(object) = scene.objects.first() else {
            return Ok(());
        };
        let offset = &object.offset;
        let wider = offset.extend + offset.bevel * offset.chamfer.min(1.0);
        let wider = if object.clip == Clip::None {
            wider.clamp(0.0, MOST_GROWTH)
        } else {
            0.0
        };
        // The distance at which a sphere about the box fills the picture's height.
        let reach = (object.profile.radius + wider).hypot(0.5 + wider) * 1.05;
        let distance = reach / (0.5 * Camera::FOV_Y).to_radians().sin();
        let target = DVec3::new(0.0, 0.0, 0.5);
        let eye = target + distance * DVec3::new(0.9, 0.3, 0.32).normalize();
        let camera = camera(eye, target);
        self.root.insert("camera".to_owned(), camera.into());
        self.chooses_camera = false;
        Ok(())
    }

    /// Returns true if a profile stands in place of the scene and none of `sets` is of the camera:
    /// its camera is then chosen.
    #[must_use]
    pub fn chooses_camera(&self, sets: &[String]) -> bool {
        let of_camera = |set: &String| set.trim_start().starts_with("camera");
        self.reader.stands_for_scene() && !sets.iter().any(of_camera)
    }

    /// The number of objects that the file has.
    #[must_use]
    pub fn objects(&self) -> usize {
        let objects = self.root.get("object").and_then(Value::as_array);
        objects.map_or(0, Vec::len)
    }

    /// Every file that was read for its scenes.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.reader.files().chain(&self.file).map(PathBuf::as_path)
    }

    /// The scene. Each of `sets` is `key=value` and replaces the file's value:
    /// `object.0.bevel=0.4`, `camera.eye=[1, 2, 3]`, `object.1.profile=vase.svg`.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] and [`ErrorKind::File`], with file and key; [`ErrorKind::Usage`] for
    /// a malformed assignment, with its key or `sets`.
    pub fn scene(&mut self, sets: &[String]) -> Result<Scene> {
        let mut read = || {
            if self.chooses_camera {
                self.choose_camera(sets)?;
            }
            self.read(sets)
        };
        read().map_err(|e: Error| match &self.file {
            Some(file) => e.in_file(file),
            None => e,
        })
    }

    /// The file's tables with `sets`. A profile in place of a scene is read by its own way, unless a
    /// key of another is set: of a picture any of [`ProfileOptions::OF_THRESHOLD`], of a drawing the
    /// usual axis.
    fn applied(&self, sets: &[String]) -> Result<Table> {
        let mut root = overrides::applied(&self.root, sets)?;
        let objects = root.get_mut("object").and_then(Value::as_array_mut);
        if let Some(Value::Table(object)) = objects.and_then(|o| o.first_mut())
            && self.reader.stands_for_scene()
            && match self.reader.stands_for_picture() {
                true => ProfileOptions::OF_THRESHOLD
                    .iter()
                    .any(|key| object.contains_key(*key)),
                false => {
                    let axis = object.get("profile_axis").and_then(Value::as_str);
                    axis.is_some_and(|axis| axis.parse() == Ok(ProfileAxis::Center))
                }
            }
            && !sets.iter().any(|set| set.contains("profile_read"))
        {
            object.remove("profile_read");
        }
        Ok(root)
    }

    /// The first picture that is a profile, with the outline that was read from it drawn over it.
    /// `None` for a scene without such a picture.
    ///
    /// # Errors
    /// The errors of reading it.
    pub fn show_outline(&self) -> Result<Option<Picture>> {
        self.reader.show_outline()
    }

    fn read(&mut self, sets: &[String]) -> Result<Scene> {
        let root = self.applied(sets)?;
        let scene = self.reader.scene(&root)?;
        scene.check()?;
        Ok(scene)
    }

    /// The file's text with each of `sets` (as in [`SceneFile::scene`]) replacing the file's value.
    /// Paths in the text are relative to the same folder; comments and the order of keys are lost. A
    /// profile in place of a scene has the camera that [`SceneFile::scene`] chose.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a malformed assignment; [`ErrorKind::File`] for a profile whose file
    /// name is no text.
    pub fn text(&self, sets: &[String]) -> Result<String> {
        if let Some(file) = self.reader.unnamed() {
            let message = "the name is not UTF-8, as TOML needs it; rename the file";
            return Err(file_fault(message).in_file(file));
        }
        let fault = |e| Error::new(ErrorKind::Other, format!("cannot be written as TOML: {e}"));
        toml::to_string(&self.applied(sets)?).map_err(fault)
    }
}

fn table<const N: usize>(entries: [(&str, Value); N]) -> Table {
    Table::from_iter(entries.map(|(key, value)| (key.to_owned(), value)))
}

fn camera(eye: DVec3, target: DVec3) -> Table {
    table([("eye", eye), ("target", target)].map(|(key, at)| (key, at.to_array().to_vec().into())))
}

/// Returns true for a name that ends as those of profiles do.
fn is_named_profile(file: &Path) -> bool {
    ["svg", "svgz", "gz", "png", "jpg", "jpeg", "jfif"].contains(&ending(file).as_str())
}

/// A fault of TOML's grammar, on one line.
fn syntax(text: &str, error: &toml::de::Error) -> Error {
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..start).unwrap_or("");
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let spanned = error.span().and_then(|span| text.get(span)).unwrap_or("");
    let duplicate = (message == "duplicate key").then(|| format!(" `{}`", spanned.trim()));
    let whole = text.lines().nth(line - 1).unwrap_or("");
    // What the parser says of numbers beyond its types.
    let is_large = ["overflowed", "too large", "as i128"].map(|words| message.contains(words));
    let (message, other) = match is_large.contains(&true) {
        true => (
            "a number is too large",
            Some("give a smaller one".to_owned()),
        ),
        false => (&*message, None),
    };
    let remedy = spelling::of_line(whole).or(other);
    let remedy = remedy.map_or(String::new(), |remedy| format!("; {remedy}"));
    let message = match not_toml(text) {
        Some(what) => what.to_owned(),
        None => format!(
            "is not TOML: {message}{}{remedy}",
            duplicate.unwrap_or_default()
        ),
    };
    file_fault(message).at_key(format!("line {line}, column {column}"))
}

/// What a text is that cannot be meant as TOML.
fn not_toml(text: &str) -> Option<&'static str> {
    let bare_cr = |text: &str| text.replace("\r\n", "").contains('\r');
    if text.contains('\0') {
        Some(
            "holds zero bytes, as no scene in TOML does; save it in UTF-8, or give a PNG, JPEG or SVG",
        )
    } else if bare_cr(text) {
        Some("has line ends of CR alone, which TOML does not know; save it with LF or CR LF")
    } else if !text.contains('=') && !text.contains('[') {
        Some("is neither a scene in TOML, of lines `key = value`, nor a PNG, JPEG or SVG")
    } else {
        None
    }
}

#[cfg(test)]
mod tests;
