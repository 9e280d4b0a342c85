//! Short names of ways of drawing.

use super::cases::is_rbm_baseline;
use crate::method::{Edges, Method, MethodSettings};

/// The RBM baseline's name in reports.
pub const RBM_BASELINE: &str = "RBM baseline";

/// Names ways of drawing as briefly as tells them apart.
#[derive(Clone, Debug)]
pub struct Labels {
    steps: bool,
    rows: bool,
    source: bool,
    format: bool,
    tolerance: bool,
}

impl Labels {
    /// Labels for these ways; the RBM baseline, meshes and the floor have their own names and do not count.
    pub fn new<'a>(ways: impl IntoIterator<Item = &'a MethodSettings>) -> Self {
        let own = |s: &MethodSettings| s.method.is_mesh() || s.method == Method::Floor;
        let counts = |s: &&MethodSettings| !is_baseline_of_any_rows(s) && !own(s);
        let ways: Vec<_> = ways.into_iter().filter(counts).collect();
        fn differs<T: PartialEq>(
            ways: &[&MethodSettings],
            of: impl Fn(&MethodSettings) -> T,
        ) -> bool {
            ways.windows(2).any(|w| of(w[0]) != of(w[1]))
        }
        Self {
            steps: differs(&ways, |s| s.max_steps),
            rows: differs(&ways, |s| s.map_rows),
            source: differs(&ways, |s| s.map_source),
            format: differs(&ways, |s| s.map_format),
            tolerance: differs(&ways, |s| s.tolerance),
        }
    }

    /// The search and what else tells this way from the others, without the stage.
    pub fn way(&self, s: &MethodSettings) -> String {
        if is_baseline_of_any_rows(s) {
            let rows = s.map_rows.filter(|_| self.rows);
            return rows.map_or(RBM_BASELINE.to_owned(), |n| {
                format!("{RBM_BASELINE} {n} rows")
            });
        }
        let mut name = s.method.to_string();
        if s.edges != Edges::OneRay {
            name += &format!(", {}", s.edges.name());
        }
        if s.method.is_mesh() {
            return name; // which has neither steps nor a map
        }
        // A search without a loop has no bound to tell.
        if self.steps && s.method.default_steps(false) > 1 {
            let steps = s.max_steps.unwrap_or_else(|| s.method.default_steps(false));
            name += &format!(" {steps} steps");
        }
        if let (true, Some(rows)) = (self.rows, s.map_rows) {
            name += &format!(" {rows} rows");
        }
        let maps = s.method.reads_map();
        if let (true, Some(source)) = (self.source && maps, s.map_source) {
            name += &format!(" {}", source.name);
        }
        if self.format && maps {
            name += &format!(" {}", s.map_format.name());
        }
        if self.tolerance && s.method.follows_tolerance() {
            name += &format!(" {} px", s.tolerance);
        }
        name
    }
}

/// True if settings are those of the RBM baseline, whatever rows its map has.
fn is_baseline_of_any_rows(s: &MethodSettings) -> bool {
    is_rbm_baseline(&MethodSettings {
        map_rows: None,
        ..*s
    })
}
