//! Values of a plan's keys, as their files spell them.

use crate::plan::method::Edges;
use crate::plan::view::Framing;
use revmap::maps::{MapFormat, MapSource};
use revmap::scene::Shadow;
use revmap::settings::{DrawStage, Tolerance};
use serde::de::{Deserialize, DeserializeOwned, Deserializer, Error};

/// A value that a file spells as a word or a number.
pub(super) trait Spelled: Sized {
    /// The word or number.
    type Raw: DeserializeOwned;

    /// Reads it; else what is allowed.
    fn read(raw: Self::Raw) -> Result<Self, String>;
}

/// A list of such values.
pub(super) fn list<'de, D, T>(from: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Spelled,
{
    let raw = Vec::<T::Raw>::deserialize(from)?.into_iter();
    let read = |one| T::read(one).map_err(D::Error::custom);
    raw.map(read).collect()
}

/// Values that have a list of names.
macro_rules! named {
    ($($type:ty: $names:expr),*) => {$(impl Spelled for $type {
        type Raw = String;

        fn read(word: String) -> Result<Self, String> {
            let found = $names.iter().find(|(name, _)| *name == word);
            found.map(|(_, value)| *value).ok_or_else(|| {
                let all = $names.map(|n| n.0).join(", ");
                format!("{word:?} is not known; give one of {all}")
            })
        }
    })*};
}

named!(
    DrawStage: Self::NAMES,
    MapSource: revmap_files::MAP_SOURCES,
    MapFormat: Self::NAMES,
    Shadow: Self::NAMES,
    Framing: Self::NAMES
);

impl Spelled for Edges {
    type Raw = String;

    fn read(word: String) -> Result<Self, String> {
        word.parse().map_err(|e: revmap::error::Error| e.message)
    }
}

impl Spelled for Tolerance {
    type Raw = f64;

    fn read(pixels: f64) -> Result<Self, String> {
        Self::new(pixels).map_err(|e| e.message)
    }
}

/// A width and a height.
impl Spelled for (u32, u32) {
    type Raw = String;

    fn read(word: String) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|n| (1..=16384).contains(n));
        let sides = word.split_once('x');
        let sides = sides.and_then(|(w, h)| side(w).zip(side(h)));
        sides.ok_or_else(|| {
            format!("{word:?} is no size; give WIDTHxHEIGHT with sides from 1 to 16384 pixels, as 800x600")
        })
    }
}
