//! What the names in a report stand for, in a sentence each: a reader of one page needs no other.

use super::measure::Measured;
use super::page::Page;
use super::plan::{PAPERS_LOOP, is_papers_loop};
use super::row::Row;
use crate::method::Method;
use revmap::settings::Solver;

/// What a search does.
#[must_use]
pub fn meaning(method: Method) -> &'static str {
    match method {
        Method::Search(Solver::Linear) => "equal steps along the ray, through the map of distances",
        Method::Search(Solver::Relief) => "equal steps, then halvings (relief mapping)",
        Method::Search(Solver::Secant) => "equal steps, then secants (interval mapping)",
        Method::Search(Solver::Circle) => {
            "the papers' circle tracing, steps as long as the map's distance, on this program's exact map"
        }
        Method::Search(Solver::Cone) => {
            "steps by a row of cones along the axis; for solids single-valued in height"
        }
        Method::Search(Solver::Relaxed) => {
            "the same with relaxed cones, which a step may leave inside the solid, and halvings back"
        }
        Method::Search(Solver::Live) => {
            "steps through the map that are safe to a texel under every offset, ending in a secant; for parameters that change from frame to frame"
        }
        Method::Search(Solver::Quadric) => {
            "no map: the outline as pieces of quadrics, solved exactly, found by a tree"
        }
        Method::Search(Solver::Hull) => {
            "the default: the same pieces, found by the rasteriser in the fragment stage and by tiles of pixels in the compute stage"
        }
        Method::Mesh { .. } => {
            "the mesh baseline: the same solid as triangles, so many segments around the axis by so many rings along the outline; fragment stage alone"
        }
    }
}

const PAPERS: &str = "circle tracing as the papers have it: 20 steps (25 and 10 halvings under a bevel) over the distances of a binary image in 8 bits";

/// The names that occur in these rows, each with its meaning, in the order in which reports list them.
#[must_use]
pub fn names(rows: &[Row]) -> Vec<(&'static str, String)> {
    let occurs = |of: &dyn Fn(&Row) -> bool| rows.iter().any(of);
    let mut all: Vec<(&'static str, String)> = Vec::new();
    for method in Method::ALL {
        if occurs(&|r| r.settings.method == method && !is_papers_loop(&r.settings)) {
            all.push((method.name(), meaning(method).to_owned()));
        }
    }
    let mesh = rows.iter().map(|r| r.settings.method).find(|s| s.is_mesh());
    all.extend(mesh.map(|mesh| ("mesh", meaning(mesh).to_owned())));
    if occurs(&|r| is_papers_loop(&r.settings)) {
        all.push((PAPERS_LOOP, PAPERS.to_owned()));
    }
    all
}

/// The chapter that explains them.
pub fn chapter(page: &mut Page, measured: &Measured) {
    page.chapter("What is compared");
    page.text(
        "Ways of finding the first point of a solid of revolution along each pixel's ray. In the fragment stage a fragment shader searches within each solid's box, in the compute stage \
         a compute shader does; pictures are the same but for rounding.",
    );
    page.facts(&names(&measured.rows));
}

#[cfg(test)]
mod tests {
    use super::super::plan::papers_loop;
    use super::super::row::tests::row;
    use super::super::view::tests::spindle;
    use super::*;

    #[test]
    fn every_name_that_occurs_is_explained_once() {
        let mut rows = Vec::new();
        for method in Method::ALL.into_iter().chain([
            Method::Mesh {
                segments: 16,
                rings: 32,
            },
            Method::Mesh {
                segments: 32,
                rings: 64,
            },
        ]) {
            let mut one = row(&[&[(None, 1.0)]]);
            one.settings.method = method;
            rows.push(one);
        }
        let mut papers = rows[0].clone();
        papers.settings = papers_loop(&spindle(), &papers.settings);
        rows.push(papers);
        let told = names(&rows);
        assert_eq!(told.len(), Method::ALL.len() + 2);
        for (i, (name, meaning)) in told.iter().enumerate() {
            assert!(meaning.len() > 20 && told[..i].iter().all(|t| t.0 != *name));
        }
        assert_eq!(names(&rows[..1]).len(), 1);
    }
}
