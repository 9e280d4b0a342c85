//! Searches from other crates: the interface between a search and the renderer, and the compilation
//! of its GLSL.
//!
//! The library contains the fastest and most accurate searches. Others, for comparison, are in the
//! crate `revmap-searches` and use this interface. A [`Search`] is plain data and two functions:
//! one makes its table, if it reads one, the other returns its SPIR-V. Pass it as
//! [`Solver::Other`](crate::settings::Solver::Other) wherever a [`Solver`](crate::settings::Solver)
//! is expected. A search made at run time can be leaked; `revmap_searches::folder` does so with
//! searches that it reads from folders.
//!
//! # Its GLSL
//!
//! A search is one GLSL function, which the library's tracer calls for each ray.
//! `shaders-glsl/include/search/external.glsl` documents the contract of this function. A
//! [`SearchModule`] names the entry file and the macros; includes are read from
//! `shaders-glsl/include`, and `search/hook.glsl` is the file of the search.
//!
//! ```
//! use revmap::search::{Pass, SearchModule, StoredPlanes};
//! let module = SearchModule {
//!     pass: Pass::Fragment, output: StoredPlanes::Color, table: false, bounded: true,
//! };
//! assert_eq!(module.entry(), "tree.frag");
//! assert_eq!(module.macros(), [("SEARCH", "SEARCH_EXTERNAL"), ("REPEATED", "1")]);
//! ```

mod module;

pub use module::{Pass, SearchModule, StoredPlanes};

use crate::error::Result;
use crate::surface::Contour;
use std::fmt;
use std::hash::{Hash, Hasher};

/// A search of another crate. Two searches are equal if they are one value, in one place: a search
/// that was read again is another.
pub struct Search {
    /// Name in options and results.
    pub name: &'static str,
    /// Short description.
    pub about: &'static str,
    /// The publication.
    pub source: &'static str,
    /// The licence of its code.
    pub licence: &'static str,
    /// The data that it searches.
    pub reads: Reads,
    /// The bound on its steps; `None` if it always ends without one.
    pub steps: Option<Steps>,
    /// The value of the constant `SEARCH_FORM`, which distinguishes searches with common modules.
    pub form: u32,
    /// Its SPIR-V.
    pub words: Words,
}

/// The SPIR-V of a search's modules.
pub struct Words(&'static (dyn Fn(&SearchModule) -> Result<Vec<u32>> + Send + Sync));

impl Words {
    /// `words` returns a module.
    ///
    /// # Safety
    /// The result must be valid SPIR-V, compiled from [`SearchModule::entry`] of this version of
    /// the library with [`SearchModule::macros`]. Its hook must access memory only through the
    /// library's functions, and must terminate. Drivers check none of this.
    #[allow(unsafe_code)] // a promise; nothing unsafe is done here
    pub const unsafe fn new(
        words: &'static (dyn Fn(&SearchModule) -> Result<Vec<u32>> + Send + Sync),
    ) -> Self {
        Self(words)
    }

    pub(crate) fn of(&self, module: &SearchModule) -> Result<Vec<u32>> {
        (self.0)(module)
    }
}

/// Unpacks words that `build.rs` packed. The bytes are deflated. A byte holds seven bits of a word,
/// the lowest first; the eighth bit is set if more bytes follow. The third word of an instruction is
/// its difference `d` from that of the instruction before, stored as `2 d` or `-2 d - 1`.
#[must_use]
pub fn unpacked(packed: &[u8]) -> Option<Vec<u32>> {
    let bytes = miniz_oxide::inflate::decompress_to_vec(packed).ok()?;
    let mut words = Vec::with_capacity(bytes.len() / 2);
    let (mut word, mut shift) = (0u32, 0);
    for byte in bytes {
        word |= u32::from(byte & 127).checked_shl(shift)?;
        shift += 7;
        if byte & 128 == 0 {
            words.push(word);
            (word, shift) = (0, 0);
        }
    }
    let (mut begin, mut last) = (5, 0u32); // behind the header of SPIR-V
    while let Some(count) = words.get(begin).map(|first| (first >> 16) as usize) {
        if let (3.., Some(word)) = (count, words.get_mut(begin + 2)) {
            last = last.wrapping_add(*word >> 1 ^ (*word & 1).wrapping_neg());
            *word = last;
        }
        begin += count.max(1);
    }
    Some(words)
}

/// The data that a search reads.
pub enum Reads {
    /// The shape map.
    Map {
        /// True if it can read the papers' texture
        /// ([`MapFormat::Rgba8`](crate::maps::MapFormat::Rgba8)).
        rgba8: bool,
    },
    /// A table that the function makes from the solid with its offset, with the given number of
    /// rows. The function fails with [`ErrorKind::Content`](crate::error::ErrorKind::Content) if
    /// the search cannot draw the solid.
    Table(&'static (dyn Fn(&Contour, u32) -> Result<SearchTable> + Send + Sync)),
}

/// A bound on steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// The default bound.
    pub default: u32,
    /// The default bound for a solid with a bevel.
    pub beveled: u32,
    /// The largest allowed bound.
    pub most: u32,
    /// True if a ray may use up its steps before its search has come to an end. Equal steps reach
    /// the end with any number of steps.
    pub may_run_out: bool,
}

impl Steps {
    /// The largest bound of all searches.
    pub const MOST: u32 = 65536;

    /// The default bound for solids with or without a bevel.
    #[must_use]
    pub const fn of(self, beveled: bool) -> u32 {
        if beveled { self.beveled } else { self.default }
    }
}

/// A search's own table on the device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SearchTable {
    /// The results of `patch_vector(0)` and so on in GLSL, after `before` others.
    pub vectors: Vec<[u32; 4]>,
    /// Number of the vectors with negative numbers in GLSL, from -1 backwards.
    pub before: u32,
    /// The value of `object.patches.yzw` in GLSL.
    pub facts: [u32; 3],
}

impl PartialEq for Search {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Eq for Search {}

impl Hash for Search {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::ptr::hash(self, state);
    }
}

impl fmt::Debug for Search {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
