//! Values of a plan's keys, as their files spell them.

use crate::report::view::Framing;
use revmap::error::Error;
use revmap::maps::{MapFormat, MapSource};
use revmap::scene::Shadow;
use revmap::settings::{DrawStage, Tolerance};
use serde::de::{Deserialize, Deserializer, Error as _};

pub(super) fn parsed<'de, D, T>(from: D) -> std::result::Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: std::str::FromStr<Err = Error>,
{
    let words = Vec::<String>::deserialize(from)?;
    let all = words
        .iter()
        .map(|w| w.parse().map_err(|e: Error| D::Error::custom(e.message)));
    all.collect()
}

fn named<'de, D, T>(from: D, names: &[(&str, T)]) -> std::result::Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Copy,
{
    let find = |word: String| {
        let found = names.iter().find(|(name, _)| *name == word);
        found.map(|(_, value)| *value).ok_or_else(|| {
            let all: Vec<&str> = names.iter().map(|n| n.0).collect();
            D::Error::custom(format!(
                "{word:?} is not known; give one of {}",
                all.join(", ")
            ))
        })
    };
    Vec::<String>::deserialize(from)?
        .into_iter()
        .map(find)
        .collect()
}

pub(super) fn stages<'de, D: Deserializer<'de>>(
    from: D,
) -> std::result::Result<Vec<DrawStage>, D::Error> {
    named(from, &DrawStage::NAMES)
}

pub(super) fn sources<'de, D: Deserializer<'de>>(
    from: D,
) -> std::result::Result<Vec<MapSource>, D::Error> {
    named(from, &revmap_files::MAP_SOURCES)
}

pub(super) fn formats<'de, D: Deserializer<'de>>(
    from: D,
) -> std::result::Result<Vec<MapFormat>, D::Error> {
    named(from, &MapFormat::NAMES)
}

pub(super) fn shadows<'de, D: Deserializer<'de>>(
    from: D,
) -> std::result::Result<Vec<Shadow>, D::Error> {
    named(from, &Shadow::NAMES)
}

pub(super) fn framings<'de, D>(from: D) -> std::result::Result<Vec<Framing>, D::Error>
where
    D: Deserializer<'de>,
{
    named(from, &Framing::ALL.map(|f| (f.name(), f)))
}

pub(super) fn tolerances<'de, D: Deserializer<'de>>(
    from: D,
) -> std::result::Result<Vec<Tolerance>, D::Error> {
    let pixels = Vec::<f64>::deserialize(from)?.into_iter();
    let read = |p| Tolerance::new(p).map_err(|e| D::Error::custom(e.message));
    pixels.map(read).collect()
}

pub(super) fn sizes<'de, D: Deserializer<'de>>(
    from: D,
) -> std::result::Result<Vec<(u32, u32)>, D::Error> {
    let side = |text: &str| text.parse().ok().filter(|n| (1..=16384).contains(n));
    let read = |word: String| {
        let sides = word.split_once('x').map(|(w, h)| (side(w), side(h)));
        match sides {
            Some((Some(width), Some(height))) => Ok((width, height)),
            _ => Err(D::Error::custom(format!(
                "{word:?} is no size; give WIDTHxHEIGHT with sides from 1 to 16384 pixels, as 800x600"
            ))),
        }
    };
    Vec::<String>::deserialize(from)?
        .into_iter()
        .map(read)
        .collect()
}
