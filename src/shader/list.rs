//! The list of SPIR-V modules: every entry file with every set of macros that some pipeline needs.
//! `build.rs` compiles this list, and pipelines look modules up in it; so it names GLSL macros, and
//! depends on nothing.

/// An entry file of `shaders-glsl/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entry {
    /// Corners of shape boxes.
    BoxVertex,
    /// Corners of convex hulls.
    ConvexHullVertex,
    /// Corners of the proxy hulls of a solid's patches.
    HullVertex,
    /// The same, clipped by the box's sides.
    CutHullVertex,
    /// Strips of a box's sides where they cut a proxy hull.
    SidesVertex,
    /// Squares of pixels of one copy.
    SpotsVertex,
    /// Squares of pixels of several copies.
    BinsVertex,
    /// Lists of tiles.
    Beam,
    /// Lists of tiles, each with a list of patches.
    List,
    /// The same of tiles of several instances.
    ListCopies,
    /// Fragments of shape boxes and convex hulls.
    Box,
    /// Fragments of shells.
    Hull,
    /// Fragments of bins, which search several copies.
    Bins,
    /// Pixels of the compute stage.
    Trace,
    /// Pixels of tiles whose patches are listed.
    Listed,
}

impl Entry {
    /// Its file.
    #[must_use]
    pub const fn file(self) -> &'static str {
        match self {
            Self::BoxVertex => "box.vert",
            Self::ConvexHullVertex => "convex_hull.vert",
            Self::HullVertex => "hull.vert",
            Self::CutHullVertex => "cut_hull.vert",
            Self::SidesVertex => "sides.vert",
            Self::SpotsVertex => "spots.vert",
            Self::BinsVertex => "bins.vert",
            Self::Beam => "beam.comp",
            Self::List => "list.comp",
            Self::ListCopies => "list_copies.comp",
            Self::Box => "box.frag",
            Self::Hull => "hull.frag",
            Self::Bins => "bins.frag",
            Self::Trace => "trace.comp",
            Self::Listed => "listed.comp",
        }
    }
}

/// The code that finds where rays meet a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Search {
    /// None: vertices, lists of tiles.
    None,
    /// The RBM baseline.
    Circle,
    /// The same where there may be a bevel.
    CircleBeveled,
    /// The RBM baseline on the papers' texture.
    CircleRgba8,
    /// The same where there may be a bevel.
    CircleBeveledRgba8,
    /// The search for live parameters.
    Live,
    /// The same with steps that allow for a bevel.
    LiveBeveled,
    /// That on the papers' texture.
    LiveRgba8,
    /// Equal steps.
    Linear,
    /// The same on the papers' texture.
    LinearRgba8,
    /// Patches of quadrics in a tree. Fragments of proxy hulls solve theirs without it, and shadows
    /// on them with it.
    Quadric,
    /// The same, in tables that do not fit into a uniform buffer.
    QuadricLarge,
    /// Rows of cones.
    Cone,
    /// The same, in a table that does not fit into a uniform buffer.
    ConeLarge,
    /// Rows of relaxed cones.
    Relaxed,
    /// The same, in a table that does not fit into a uniform buffer.
    RelaxedLarge,
}

impl Search {
    /// The search that does this one's work and more: with a bevel, of tables of any size. `live`
    /// and `quadric` stay what they are.
    #[must_use]
    pub const fn general(self) -> Self {
        match self {
            Self::Circle => Self::CircleBeveled,
            Self::CircleRgba8 => Self::CircleBeveledRgba8,
            Self::Cone => Self::ConeLarge,
            Self::Relaxed => Self::RelaxedLarge,
            other => other,
        }
    }

    /// The same search of tables that fit into a uniform buffer, or do not.
    #[must_use]
    pub const fn of_tables(self, fit: bool) -> Self {
        match (self, fit) {
            (Self::Quadric | Self::QuadricLarge, true) => Self::Quadric,
            (Self::Quadric | Self::QuadricLarge, false) => Self::QuadricLarge,
            (Self::Cone | Self::ConeLarge, true) => Self::Cone,
            (Self::Cone | Self::ConeLarge, false) => Self::ConeLarge,
            (Self::Relaxed | Self::RelaxedLarge, true) => Self::Relaxed,
            (Self::Relaxed | Self::RelaxedLarge, false) => Self::RelaxedLarge,
            (other, _) => other,
        }
    }

    /// Whether it is the search for live parameters on a map of signed distances, to which convex
    /// hulls belong.
    #[must_use]
    pub const fn is_live(self) -> bool {
        matches!(self, Self::Live | Self::LiveBeveled)
    }

    /// Whether [`Dispatch::Beams`] is for it, and fragments of bins.
    #[must_use]
    pub const fn takes_beams(self) -> bool {
        self.is_live() || matches!(self, Self::Quadric | Self::QuadricLarge)
    }
}

/// What a solid may have besides its shape; each holds what stands before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Features {
    /// One colour, one solid in its box, no shadows.
    Plain,
    /// Maps of colour and bumps.
    Textured,
    /// Replicas and shadows.
    Full,
}

/// What is stored of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
    /// Colour.
    Color,
    /// Every plane of a frame.
    Planes,
    /// Depth alone.
    Depth,
    /// Depth alone, along parallel rays.
    DepthOrtho,
}

/// How the compute stage goes through pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dispatch {
    /// The rectangle of one instance.
    Rectangle,
    /// Squares of the screen, each with a list of instances.
    Bins,
    /// Tiles of one instance that beams have listed.
    Beams,
    /// The same, each with the patches that its rays may meet.
    Lists,
}

/// One module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Module {
    /// The entry file.
    pub entry: Entry,
    /// Which search it holds.
    pub search: Search,
    /// What else.
    pub features: Features,
    /// What it stores.
    pub output: Output,
    /// Of the compute stage; of squares of one copy whether they are held to a span.
    pub dispatch: Dispatch,
}

impl Module {
    /// A module without choices.
    #[must_use]
    pub const fn plain(entry: Entry) -> Self {
        Self {
            entry,
            search: Search::None,
            features: Features::Plain,
            output: Output::Color,
            dispatch: Dispatch::Rectangle,
        }
    }

    /// The module of the list that does what this one would, with as little else as possible;
    /// `listed` says what is in the list.
    #[must_use]
    pub fn covered_by(self, listed: impl Fn(&Self) -> bool) -> Option<Self> {
        [Features::Plain, Features::Textured, Features::Full]
            .into_iter()
            .filter(|features| *features >= self.features)
            .flat_map(|features| {
                [self.search, self.search.general()].map(|search| Self {
                    search,
                    features,
                    ..self
                })
            })
            .find(listed)
    }

    /// The module of vertices `entry` that hand these fragments what they take, and nothing else.
    #[must_use]
    pub fn vertices(&self, entry: Entry) -> Self {
        use Search as S;
        let search = match self.search {
            _ if matches!(entry, Entry::HullVertex | Entry::CutHullVertex) => S::None,
            S::Quadric | S::QuadricLarge | S::Cone | S::ConeLarge => S::Quadric,
            S::Relaxed | S::RelaxedLarge => S::Relaxed,
            _ => S::Live,
        };
        let shaded = matches!(self.output, Output::Color | Output::Planes);
        Self {
            search,
            output: if shaded { Output::Color } else { Output::Depth },
            dispatch: if entry == Entry::SpotsVertex {
                self.dispatch
            } else {
                Dispatch::Rectangle
            },
            ..Self::plain(entry)
        }
    }

    /// The macros that the GLSL is compiled with; what is left out is 0 there. `build.rs` alone
    /// asks.
    #[must_use]
    #[allow(dead_code)]
    pub fn macros(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = match self.search {
            Search::None => vec![],
            Search::Circle => vec![("SEARCH", "SEARCH_CIRCLE")],
            Search::CircleBeveled => vec![("SEARCH", "SEARCH_CIRCLE"), ("BEVELED", "1")],
            Search::CircleRgba8 => vec![("SEARCH", "SEARCH_CIRCLE"), ("RGBA8", "1")],
            Search::CircleBeveledRgba8 => {
                vec![
                    ("SEARCH", "SEARCH_CIRCLE"),
                    ("BEVELED", "1"),
                    ("RGBA8", "1"),
                ]
            }
            Search::Live => vec![("SEARCH", "SEARCH_LIVE")],
            Search::LiveBeveled => vec![("SEARCH", "SEARCH_LIVE"), ("BEVELED", "1")],
            Search::LiveRgba8 => {
                vec![("SEARCH", "SEARCH_LIVE"), ("BEVELED", "1"), ("RGBA8", "1")]
            }
            Search::Linear => vec![("SEARCH", "SEARCH_LINEAR"), ("BEVELED", "1")],
            Search::LinearRgba8 => {
                vec![
                    ("SEARCH", "SEARCH_LINEAR"),
                    ("BEVELED", "1"),
                    ("RGBA8", "1"),
                ]
            }
            Search::Quadric => vec![("SEARCH", "SEARCH_QUADRIC"), ("OWN_TABLES", "1")],
            Search::QuadricLarge => vec![("SEARCH", "SEARCH_QUADRIC")],
            Search::Cone => vec![("SEARCH", "SEARCH_CONE"), ("OWN_TABLES", "1")],
            Search::ConeLarge => vec![("SEARCH", "SEARCH_CONE")],
            Search::Relaxed => vec![("SEARCH", "SEARCH_RELAXED"), ("OWN_TABLES", "1")],
            Search::RelaxedLarge => vec![("SEARCH", "SEARCH_RELAXED")],
        };
        if self.features >= Features::Textured {
            all.push(("TEXTURED", "1"));
        }
        if self.features == Features::Full {
            all.push(("REPEATED", "1"));
            if self.output <= Output::Planes {
                all.push(("SHADOWED", "1"));
            }
        }
        match self.output {
            Output::Color => {}
            Output::Planes => all.push(("OUTPUT", "OUTPUT_PLANES")),
            Output::Depth => all.push(("OUTPUT", "OUTPUT_DEPTH")),
            Output::DepthOrtho => all.extend([("OUTPUT", "OUTPUT_DEPTH"), ("ORTHO", "1")]),
        }
        match self.dispatch {
            Dispatch::Rectangle => {}
            Dispatch::Bins => all.push(("DISPATCH", "DISPATCH_BINS")),
            Dispatch::Beams => all.push(("DISPATCH", "DISPATCH_BEAMS")),
            Dispatch::Lists => all.push(("DISPATCH", "DISPATCH_LISTS")),
        }
        all
    }

    /// Its name: the entry file, then what tells it from others of that file.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = self.entry.file().to_owned();
        let mut add = |part: &dyn std::fmt::Debug| {
            name.push('.');
            name.push_str(&format!("{part:?}").to_lowercase());
        };
        if matches!(self.entry, Entry::Beam | Entry::List | Entry::ListCopies) {
            return name;
        }
        if self.search != Search::None {
            add(&self.search);
        }
        add(&self.features);
        add(&self.output);
        let is_told = matches!(self.entry, Entry::Box | Entry::SpotsVertex);
        if self.entry == Entry::Trace || (is_told && self.dispatch != Dispatch::Rectangle) {
            add(&self.dispatch);
        }
        name
    }
}

/// Searches that boxes and the compute stage are drawn by.
const SEARCHES: [Search; 15] = [
    Search::Circle,
    Search::CircleBeveled,
    Search::CircleRgba8,
    Search::CircleBeveledRgba8,
    Search::Live,
    Search::LiveBeveled,
    Search::LiveRgba8,
    Search::Linear,
    Search::LinearRgba8,
    Search::Quadric,
    Search::QuadricLarge,
    Search::Cone,
    Search::ConeLarge,
    Search::Relaxed,
    Search::RelaxedLarge,
];

/// Whether boxes and the compute stage have a module of these. Searches that are there to be
/// compared with, and rare cases, are drawn by more general modules where they are not drawn plain.
fn has(search: Search, features: Features, output: Output, dispatch: Dispatch) -> bool {
    use Search as S;
    let main = matches!(search, S::Live | S::LiveBeveled | S::Quadric);
    if dispatch == Dispatch::Beams && !search.takes_beams() {
        return false;
    }
    match (output, features) {
        (Output::Color, Features::Plain) => true,
        (Output::Color, Features::Textured) => main,
        (Output::Planes, Features::Plain) => main || matches!(search, S::Circle | S::CircleRgba8),
        (Output::Planes, Features::Textured) => false,
        (Output::Color | Output::Planes, Features::Full) => search == search.general(),
        (Output::Depth | Output::DepthOrtho, features) => {
            features != Features::Textured && (main || search == S::QuadricLarge)
        }
    }
}

/// Every module, in order.
#[must_use]
pub fn modules() -> Vec<Module> {
    use Output as O;
    let mut all = [Entry::Beam, Entry::List, Entry::ListCopies]
        .map(Module::plain)
        .to_vec();
    for output in [O::Color, O::Depth] {
        let vertex = |entry, search| Module {
            search,
            output,
            ..Module::plain(entry)
        };
        all.push(vertex(Entry::BoxVertex, Search::Live));
        all.push(vertex(Entry::BoxVertex, Search::Quadric));
        all.push(vertex(Entry::ConvexHullVertex, Search::Live));
        all.push(vertex(Entry::HullVertex, Search::None));
        all.push(vertex(Entry::CutHullVertex, Search::None));
        all.push(vertex(Entry::SidesVertex, Search::Quadric));
    }
    for search in [Search::Live, Search::Quadric] {
        all.extend([Entry::SpotsVertex, Entry::BinsVertex].map(|entry| Module {
            search,
            ..Module::plain(entry)
        }));
    }
    all.push(Module {
        search: Search::Quadric,
        dispatch: Dispatch::Beams,
        ..Module::plain(Entry::SpotsVertex)
    });
    all.push(Module {
        search: Search::Relaxed,
        ..Module::plain(Entry::BoxVertex)
    });
    for output in [O::Color, O::Planes, O::Depth, O::DepthOrtho] {
        let shaded = matches!(output, O::Color | O::Planes);
        for features in [Features::Plain, Features::Textured, Features::Full] {
            let fragment = |entry, search| Module {
                entry,
                search,
                features,
                output,
                dispatch: Dispatch::Rectangle,
            };
            for search in SEARCHES {
                if has(search, features, output, Dispatch::Rectangle) {
                    all.push(fragment(Entry::Box, search));
                }
                let is_planes = output == O::Planes && features != Features::Full;
                if shaded && search == Search::Quadric && !is_planes {
                    all.push(Module {
                        dispatch: Dispatch::Beams,
                        ..fragment(Entry::Box, search)
                    });
                }
                // Few squares show many copies: those of textured ones are drawn by the full module.
                if shaded
                    && search.takes_beams()
                    && features != Features::Textured
                    && has(search, features, output, Dispatch::Rectangle)
                {
                    all.push(fragment(Entry::Bins, search));
                }
                for dispatch in [Dispatch::Rectangle, Dispatch::Bins, Dispatch::Beams] {
                    if shaded && has(search, features, output, dispatch) {
                        all.push(Module {
                            dispatch,
                            ..fragment(Entry::Trace, search)
                        });
                    }
                }
                if shaded
                    && search == Search::Quadric
                    && has(search, features, output, Dispatch::Beams)
                {
                    all.push(Module {
                        dispatch: Dispatch::Lists,
                        ..fragment(Entry::Listed, search)
                    });
                }
            }
            if shaded || features == Features::Plain {
                all.push(fragment(Entry::Hull, Search::Quadric));
            }
        }
    }
    all
}
