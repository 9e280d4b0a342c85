//! Searches that other crates bring: what the renderer asks of one, and how its GLSL is compiled.
//!
//! The library holds the searches that draw best; those that exist to be compared with are in the
//! crate `revmap-searches`, through this interface. A [`Search`] is plain data and two functions: one
//! makes its table, if it reads one, the other gives its SPIR-V. It takes part wherever a
//! [`Solver`](crate::settings::Solver) is named, as [`Solver::Other`](crate::settings::Solver::Other).
//! One that is made at run time can be leaked.
//!
//! # Its GLSL
//!
//! A search is one function, which the library's tracer calls for each ray. Its contract is written
//! down in `shaders-glsl/include/search/external.glsl`. A [`SearchModule`] names the entry file and
//! the macros; includes are read from `shaders-glsl/include`, and `search/hook.glsl` is the file of
//! the search.
//!
//! ```
//! use revmap::search::{Pass, Features, Output, SearchModule};
//! let module = SearchModule {
//!     pass: Pass::Fragment, features: Features::Plain, output: Output::Color,
//!     table: false, bounded: true, beveled: false, rgba8: false,
//! };
//! assert_eq!(module.entry(), "tree.frag");
//! assert_eq!(module.macros(), [("SEARCH", "SEARCH_EXTERNAL"), ("BEVELED", "0")]);
//! ```

mod module;

pub use crate::shader::unpacked;
pub use module::{Features, Output, Pass, SearchModule};

use crate::error::Result;
use crate::surface::Contour;
use std::fmt;
use std::hash::{Hash, Hasher};

/// A search of another crate. Two of one name are the same search.
pub struct Search {
    /// Its name in options and results.
    pub name: &'static str,
    /// What it does, in a few words.
    pub about: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// The licence of its code.
    pub licence: &'static str,
    /// What it searches.
    pub reads: Reads,
    /// The bound on its steps; `None` where it ends by itself.
    pub steps: Option<Steps>,
    /// The value of the constant `SEARCH_FORM`, which tells searches apart that share their modules.
    pub form: u32,
    /// Its SPIR-V.
    pub words: Words,
}

/// The SPIR-V of a search's modules.
pub struct Words(&'static (dyn Fn(&SearchModule) -> Result<Vec<u32>> + Send + Sync));

impl Words {
    /// What `words` gives: a module, or another that [serves](SearchModule::serves) as well.
    ///
    /// # Safety
    /// It must be valid SPIR-V, compiled from [`SearchModule::entry`] of this version of the library
    /// with [`SearchModule::macros`], and its hook must touch no memory but by the library's functions
    /// and come to an end: drivers check none of that.
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

/// What a search reads.
pub enum Reads {
    /// The shape map.
    Map {
        /// Whether solids without a bevel have modules of their own. Else all are compiled with
        /// [`SearchModule::beveled`].
        tells_bevels: bool,
        /// Whether it can read the papers' texture
        /// ([`MapFormat::Rgba8`](crate::maps::MapFormat::Rgba8)).
        rgba8: bool,
    },
    /// A table that this makes of the solid under its offset, in so many rows. It fails with
    /// [`ErrorKind::Content`](crate::error::ErrorKind::Content) where the search cannot draw the solid.
    Table(&'static (dyn Fn(&Contour, u32) -> Result<SearchTable> + Send + Sync)),
}

/// A bound on steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// What is taken where none is given.
    pub default: u32,
    /// The same for a solid with a bevel.
    pub beveled: u32,
    /// The largest that may be given.
    pub most: u32,
    /// Whether a ray may use up its steps before its search has come to an end. Equal steps reach the
    /// end whatever their number.
    pub may_run_out: bool,
}

impl Steps {
    /// The largest bound that any search takes.
    pub const MOST: u32 = 65536;

    /// What is taken where none is given.
    #[must_use]
    pub const fn of(self, beveled: bool) -> u32 {
        if beveled { self.beveled } else { self.default }
    }
}

/// A search's own table on the device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SearchTable {
    /// What `patch_vector(0)` and so on give in GLSL.
    pub vectors: Vec<[u32; 4]>,
    /// What GLSL reads as `solid.patches.yzw`.
    pub facts: [u32; 3],
}

impl PartialEq for Search {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Search {}

impl Hash for Search {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

impl fmt::Debug for Search {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
