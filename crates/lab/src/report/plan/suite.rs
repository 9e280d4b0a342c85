//! The solids that are measured when no scene is named, carried within the program.

use crate::report::names::number;
use crate::report::view::View;
use glam::DVec3;
use revmap::error::Result;
use revmap::scene::{Camera, Object, Scene};
use revmap_files::ProfileAxis;
use std::sync::Arc;

/// The source of a solid.
enum Source {
    /// A drawing or an image, a whole silhouette.
    File(&'static [u8]),
    /// A scene file whose first object is a polygon.
    Scene(&'static str),
}

/// A file of the repository that the program carries.
macro_rules! asset {
    (text $file:literal) => {
        Source::Scene(include_str!(concat!(
            "../../../../../assets/scenes/",
            $file
        )))
    };
    ($file:literal) => {
        Source::File(include_bytes!(concat!(
            "../../../../../assets/profiles/",
            $file
        )))
    };
}

/// The colour of chessmen.
const WOOD: [f32; 3] = [0.72, 0.52, 0.3];

/// Name, source, colour of every solid: drawings, an image, polygons with cavities.
const SOURCES: [(&str, Source, [f32; 3]); 8] = [
    ("vase", asset!(text "vase.toml"), [0.55, 0.16, 0.08]),
    ("pawn", asset!("pawn.svg"), WOOD),
    ("bottle", asset!("bottle.png"), [0.03, 0.3, 0.14]),
    ("goblet", asset!(text "goblet.toml"), [0.5, 0.5, 0.55]),
    ("rook", asset!("rook.svg"), WOOD),
    ("bishop", asset!("bishop.svg"), WOOD),
    ("king", asset!("king.svg"), WOOD),
    ("sphere", asset!(text "sphere.toml"), [0.2, 0.42, 0.75]),
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
    /// Every solid.
    pub const ALL: Self = Self::First(SOURCES.len());
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
            Names::Word(word) => match word.as_str() {
                "one" => Ok(Self::First(1)),
                "three" => Ok(Self::First(3)),
                "all" => Ok(Self::ALL),
                _ => Err(format!(
                    "{word:?} is not known; give one, three, all or a list of names"
                )),
            },
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
    for (place, (name, source, color)) in SOURCES.into_iter().enumerate() {
        if !wanted(place, name) {
            continue;
        }
        let profile = match source {
            Source::File(bytes) => Arc::new(revmap_files::profile_from_bytes(
                bytes,
                ProfileAxis::Center,
            )?),
            Source::Scene(text) => {
                let mut scene = revmap_files::SceneFile::parse(text, "")?.scene(&[])?;
                scene.objects.swap_remove(0).profile
            }
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_suite_is_sound_and_named_once() {
        let all = views(&Extent::ALL, &[0.0, 25.0, 60.0]).unwrap();
        for (i, view) in all.iter().enumerate() {
            view.scene.check().unwrap();
            assert!(all[..i].iter().all(|v| v.name != view.name));
        }
        assert_eq!(views(&Extent::First(1), &[20.0]).unwrap().len(), 1);
        assert_eq!((all.len(), all[1].name.as_str()), (24, "vase@25"));
    }
}
