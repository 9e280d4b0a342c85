//! The solids that are measured when no scene is named, carried within the program.

use crate::plan::view::View;
use glam::DVec3;
use revmap::error::Result;
use revmap::scene::{Camera, Object, Scene};
use revmap_figures::names::number;
use revmap_files::ProfileAxis;
use std::sync::Arc;

/// Name, file and its content, colour: drawings, an image, and polygons in scenes.
type Source = (&'static str, &'static str, &'static [u8], [f32; 3]);

/// A solid of a file of the repository that the program carries.
macro_rules! solid {
    ($name:literal, $file:literal, $color:expr) => {
        (
            $name,
            $file,
            include_bytes!(concat!("../../../../assets/", $file)),
            $color,
        )
    };
}

/// The colour of chessmen.
const WOOD: [f32; 3] = [0.72, 0.52, 0.3];

const SOURCES: [Source; 11] = [
    solid!("vase", "scenes/vase.toml", [0.55, 0.16, 0.08]),
    solid!("pawn", "profiles/pawn.svg", WOOD),
    solid!("bottle", "profiles/bottle.png", [0.03, 0.3, 0.14]),
    solid!("goblet", "scenes/goblet.toml", [0.5, 0.5, 0.55]),
    solid!("rook", "profiles/rook.svg", WOOD),
    solid!("bishop", "profiles/bishop.svg", WOOD),
    solid!("king", "profiles/king.svg", WOOD),
    solid!("sphere", "scenes/sphere.toml", [0.2, 0.42, 0.75]),
    solid!("table", "scenes/table.toml", WOOD),
    solid!("plate", "scenes/plate.toml", [0.82, 0.84, 0.86]),
    solid!("record", "scenes/record.toml", [0.08, 0.08, 0.09]),
];

/// Which solids of the suite.
#[derive(Clone, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(try_from = "Names")]
pub enum Extent {
    /// So many of the first. The first three are a polygon with a cavity, a drawing, an image.
    First(usize),
    /// Those of these names.
    Named(Vec<String>),
}

impl Extent {
    /// The names of parts of the suite.
    pub const NAMES: [(&'static str, &'static Self); 4] = [
        ("one", &Self::First(1)),
        ("three", &Self::First(3)),
        ("upright", &Self::UPRIGHT),
        ("all", &Self::ALL),
    ];
    /// Every solid.
    pub const ALL: Self = Self::First(SOURCES.len());
    /// The solids that are not flat.
    pub const UPRIGHT: Self = Self::First(8);
}

/// The suite's solids in a plan: one word, or a list of names.
#[derive(serde::Deserialize)]
#[serde(untagged)]
enum Names {
    Word(String),
    List(Vec<String>),
}

impl TryFrom<Names> for Extent {
    type Error = String;

    fn try_from(names: Names) -> std::result::Result<Self, String> {
        let all = SOURCES.map(|s| s.0);
        match names {
            Names::Word(word) => {
                let known = Self::NAMES.iter().find(|(name, _)| *name == word);
                known.map(|(_, extent)| (*extent).clone()).ok_or_else(|| {
                    let names = Self::NAMES.map(|n| n.0).join(", ");
                    format!("{word:?} is not known; give {names} or a list of names")
                })
            }
            Names::List(list) => match list.iter().find(|n| !all.contains(&n.as_str())) {
                Some(name) => {
                    let all = all.join(", ");
                    Err(format!("{name:?} is no solid; give one of {all}"))
                }
                None => Ok(Self::Named(list)),
            },
        }
    }
}

/// The suite's views: each solid upright, filling nine tenths of the picture, from each of the
/// `elevations` (degrees above the horizon); with more than one, names end in `@elevation`.
pub fn views(extent: &Extent, elevations: &[f64]) -> Result<Vec<View>> {
    let wanted = |place: usize, name: &str| match extent {
        Extent::First(count) => place < *count,
        Extent::Named(names) => names.iter().any(|n| n == name),
    };
    let mut views = Vec::new();
    for (place, (name, file, bytes, color)) in SOURCES.into_iter().enumerate() {
        if !wanted(place, name) {
            continue;
        }
        let profile = match file.ends_with(".toml") {
            true => {
                let text = String::from_utf8_lossy(bytes);
                let mut scene = revmap_files::SceneFile::parse(&text, "")?.scene(&[])?;
                scene.objects.swap_remove(0).profile
            }
            false => Arc::new(revmap_files::profile_from_bytes(
                bytes,
                ProfileAxis::Center,
            )?),
        };
        let mut object = Object::new(name, profile);
        object.color = color;
        let mut scene = Scene::new(Camera::new(DVec3::X, DVec3::ZERO));
        scene.background = [0.035, 0.042, 0.055, 1.0];
        scene.ambient = [0.16, 0.17, 0.2];
        scene.objects.push(object);
        for &elevation in elevations {
            let mut view = View::new(name, scene.clone()).framed(elevation);
            if elevations.len() > 1 {
                view.name = format!("{name}@{}", number(elevation, 4));
            }
            views.push(view);
        }
    }
    Ok(views)
}
