//! The solids that are measured when no scene is named: carried within the program, so that it
//! needs no files.

use super::view::View;
use glam::DVec3;
use revmap::error::{Error, Result, Stage};
use revmap::profile::{Profile, ProfileAxis};
use revmap::scene::{Camera, Object, Scene};
use std::sync::Arc;

/// What a solid is turned from.
enum Source {
    /// A drawing or an image, a whole silhouette.
    File(&'static [u8]),
    /// A scene file whose first object is a polygon.
    Scene(&'static str),
}

/// Name, source, colour of every solid of the suite; drawings, an image, and polygons with
/// cavities.
fn sources() -> Vec<(&'static str, Source, [f32; 3])> {
    vec![
        (
            "vase",
            Source::Scene(include_str!("../../../../assets/scenes/vase.toml")),
            [0.55, 0.16, 0.08],
        ),
        (
            "pawn",
            Source::File(include_bytes!("../../../../assets/profiles/pawn.svg")),
            [0.72, 0.52, 0.3],
        ),
        (
            "bottle",
            Source::File(include_bytes!("../../../../assets/profiles/bottle.png")),
            [0.03, 0.3, 0.14],
        ),
        (
            "goblet",
            Source::Scene(include_str!("../../../../assets/scenes/goblet.toml")),
            [0.5, 0.5, 0.55],
        ),
        (
            "rook",
            Source::File(include_bytes!("../../../../assets/profiles/rook.svg")),
            [0.72, 0.52, 0.3],
        ),
        (
            "bishop",
            Source::File(include_bytes!("../../../../assets/profiles/bishop.svg")),
            [0.72, 0.52, 0.3],
        ),
        (
            "king",
            Source::File(include_bytes!("../../../../assets/profiles/king.svg")),
            [0.72, 0.52, 0.3],
        ),
        (
            "sphere",
            Source::Scene(include_str!("../../../../assets/scenes/sphere.toml")),
            [0.2, 0.42, 0.75],
        ),
    ]
}

/// How much of the suite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// One solid.
    One,
    /// Three: a polygon with a cavity, a drawing, an image.
    Three,
    /// All.
    All,
}

/// The suite's views: each solid upright, filling nine tenths of the picture, from each of the
/// `elevations` (degrees above the horizon); with more than one, names end in `@elevation`.
///
/// # Errors
/// Of reading the profiles that the program carries.
pub fn views(extent: Extent, elevations: &[f64]) -> Result<Vec<View>> {
    let take = match extent {
        Extent::One => 1,
        Extent::Three => 3,
        Extent::All => usize::MAX,
    };
    let mut views = Vec::new();
    for (name, source, color) in sources().into_iter().take(take) {
        let profile = match source {
            Source::File(bytes) => Arc::new(Profile::from_bytes(bytes, ProfileAxis::Center)?),
            Source::Scene(text) => match revmap::scene::file::parse(text, "", &[])?
                .objects
                .into_iter()
                .next()
            {
                Some(object) => object.profile,
                None => continue,
            },
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
                view.name = format!("{name}@{}", super::names::number(elevation, 4));
            }
            views.push(view);
        }
    }
    Ok(views)
}

/// The first of the suite, for what is measured on one solid alone.
///
/// # Errors
/// Of reading its profile.
pub(super) fn one() -> Result<View> {
    views(Extent::One, &[25.0])?
        .into_iter()
        .next()
        .ok_or_else(|| {
            Error::new(
                Stage::Report,
                "the program carries no solid; build it with the feature `scene-file`",
            )
        })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_suite_is_sound_and_named_once() {
        let all = views(Extent::All, &[0.0, 25.0, 60.0]).unwrap();
        for (i, view) in all.iter().enumerate() {
            view.scene.check().unwrap();
            assert!(all[..i].iter().all(|v| v.name != view.name));
        }
        assert_eq!(views(Extent::One, &[20.0]).unwrap().len(), 1);
        assert_eq!((all.len(), all[1].name.as_str()), (24, "vase@25"));
    }
}
