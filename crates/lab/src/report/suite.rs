//! The solids that are measured when no scene is named: carried within the program, so that it
//! needs no files.

use super::view::View;
use glam::DVec3;
use revmap::error::{Error, ErrorKind, Result};
use revmap::maps::ColorMap;
use revmap::profile::{Profile, ProfileAxis};
use revmap::scene::{Camera, Object, Offset, Scene};
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

/// What a technique makes of a plain solid's view.
type Change = fn(&mut View) -> Result<()>;

/// The techniques of [`techniques`]: names that end their views' names, and what they change.
const TECHNIQUES: [(&str, Change); 5] = [
    ("revolution", |_| Ok(())),
    ("extended", |view| offset(view, 0.06, 0.0, 1.0)),
    ("beveled", |view| offset(view, 0.0, 0.25, 1.0)),
    ("chamfered", |view| offset(view, 0.0, 0.8, 0.2)),
    (TEXTURED, |view| {
        let texels = (0..64 * 64u32).map(|k| match (k / 8 + k / 512) % 2 {
            0 => [190, 150, 90, 255],
            _ => [90, 40, 20, 255],
        });
        let map = Arc::new(ColorMap::from_texels(64, 64, texels.collect())?);
        for object in &mut view.scene.objects {
            object.texturing.color_map = Some(map.clone());
        }
        Ok(())
    }),
];

/// The technique that no offset tells.
const TEXTURED: &str = "textured";

fn offset(view: &mut View, extend: f64, bevel: f64, chamfer: f64) -> Result<()> {
    for object in &mut view.scene.objects {
        object.offset = Offset {
            extend,
            bevel,
            chamfer,
        };
    }
    Ok(())
}

/// Each view by every technique: plain, extended by 0.06, beveled by 0.25, beveled by 0.8 and
/// chamfered to 0.2, and under a chequered colour map. Names end in the technique's.
///
/// # Errors
/// Of the colour map.
pub fn techniques(views: &[View]) -> Result<Vec<View>> {
    let mut all = Vec::new();
    for view in views {
        for (name, change) in TECHNIQUES {
            let mut view = view.clone();
            change(&mut view)?;
            view.name = format!("{}-{name}", view.name);
            all.push(view);
        }
    }
    Ok(all)
}

/// What ends the names of views whose box cuts the solid.
pub(super) const CUT: &str = "-box";

/// The technique that a row of `results.csv` shows: what its view is named after, else that of its
/// offset; whether the box cuts it.
pub(super) fn technique_of(scene: &str, technique: &str) -> String {
    let scene = scene.trim_end_matches(":close");
    if scene.ends_with(TEXTURED) {
        TEXTURED.to_owned()
    } else if scene.ends_with(CUT) {
        format!("{technique}, cut by the box")
    } else {
        technique.to_owned()
    }
}

/// Where a technique stands among all; one that is not among them stands last.
pub(super) fn place_of(technique: &str) -> usize {
    let known = TECHNIQUES
        .iter()
        .position(|(name, _)| technique.starts_with(name));
    known.unwrap_or(TECHNIQUES.len())
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
                ErrorKind::Other,
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
        let each = techniques(&all[..2]).unwrap();
        assert_eq!((each.len(), each[1].name.as_str()), (10, "vase@0-extended"));
        for view in each {
            view.scene.check().unwrap();
            let told = technique_of(&view.name, view.technique().name());
            assert!(view.name.ends_with(&told), "{} is {told}", view.name);
        }
        assert_eq!(views(Extent::One, &[20.0]).unwrap().len(), 1);
        assert_eq!((all.len(), all[1].name.as_str()), (24, "vase@25"));
    }
}
