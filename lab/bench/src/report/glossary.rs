//! The meanings of methods' names in a report, a sentence each.

use crate::measure::Measured;
use crate::measure::row::Row;
use crate::plan::method::Method;
use crate::plan::{RBM_BASELINE, is_rbm_baseline};
use revmap::settings::Solver;
use revmap_figures::page::Page;
use revmap_searches::folder;

/// The meaning of a method's name.
pub fn meaning(method: Method) -> &'static str {
    match method {
        Method::Search(Solver::Other(search)) => search.about,
        Method::Search(Solver::Live) => LIVE,
        Method::Search(Solver::Quadric) => QUADRIC,
        Method::Search(Solver::Exact) => EXACT,
        Method::MeshWithin { .. } => MESH_WITHIN,
        Method::Mesh { .. } => MESH,
        Method::Floor => FLOOR,
    }
}

const LIVE: &str = "steps through the map that are safe to a texel under every offset, ending in a secant; for parameters that change from frame to frame";
const QUADRIC: &str = "no map: the outline as quadric patches, solved exactly, found by a tree";
const EXACT: &str = "the default: quadric patches of the outline, found by the rasteriser in the fragment stage and by tiles of pixels in the compute stage";
const MESH_WITHIN: &str = "the mesh that follows the view: triangles whose silhouettes keep so many pixels, segments and rings for each copy by its size on the screen, in levels of a factor of 1.4; copies beside the picture are left out, the nearest are drawn first. Only silhouettes keep the tolerance: depths and normals err by more. Beyond 65,536 pixels for a solid's height meshes grow no finer";
const MESH: &str = "a mesh of one fineness: the same solid as triangles, so many segments around the axis by so many rings along the outline; fragment stage alone";
const FLOOR: &str = "the default's frame without a search: each pixel returns its first possible point (the hull's own fragment, the ray's entry into the solid's bounding cylinder), with the same vertices, tiles, lists of copies, depth, shading and store. It is an estimate of the least time of a search, not a proven bound: it shades some pixels beside the solid, and reads only the nearest copies";
const PAPERS: &str = "revolution-bump mapping as it was published: circle tracing of 20 steps (25 and 10 halvings under a bevel) over the distances of a binary image in 8 bits";

/// The publications of the RBM baseline.
const SOURCES: [&str; 4] = [
    "A. Halli, A. Saaidi, K. Satori, H. Tairi: Extrusion and revolution mapping. ACM Transactions on Graphics 29 (5), 2010, 1-14. doi:10.1145/1857907.1857908",
    "A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori: Revolution mapping with bump mapping support. Graphical Models 100, 2018, 1-11. doi:10.1016/j.gmod.2018.09.001",
    "A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori, H. El Moubtahij: The extensions of revolution-bump mapping. Journal of Graphic Engineering and Design 13 (1), 2022, 21-31. doi:10.24867/JGED-2022-1-021",
    "A. Ragragui, A. Ouazzani Chahdi, A. Arbah, H. El Moubtahij, A. Halli, K. Satori: Revolution-bump mapping with texture function adjustment according to the geometry of the revolved object. Journal of Graphic Engineering and Design, 2025",
];

/// The names that occur in these rows, each with its meaning, in the reports' order.
pub fn names(rows: &[Row]) -> Vec<(&'static str, String)> {
    let term = |row: &Row| -> (usize, &'static str, String) {
        let method = row.settings.method;
        let place = Method::ALL.iter().position(|m| *m == method);
        let about = meaning(method).to_owned();
        let folder = method.solver().and_then(folder::of);
        match method {
            _ if is_rbm_baseline(&row.settings) => (usize::MAX, RBM_BASELINE, PAPERS.to_owned()),
            Method::Floor => (usize::MAX - 1, method.name(), about),
            Method::Mesh { .. } => (usize::MAX - 2, "mesh:SEGMENTSxRINGS", about),
            Method::MeshWithin { .. } => (usize::MAX - 3, "mesh:PIXELSpx", about),
            Method::Search(_) => {
                let origin = folder.map(|folder| format!(" ({})", folder.origin()));
                let place = place.unwrap_or(Method::ALL.len());
                (place, method.name(), about + &origin.unwrap_or_default())
            }
        }
    };
    let mut all: Vec<_> = rows.iter().map(term).collect();
    all.sort();
    all.dedup();
    all.into_iter()
        .map(|(_, name, about)| (name, about))
        .collect()
}

/// The chapter that explains them.
pub fn chapter(page: &mut Page, measured: &Measured) {
    page.chapter("What is compared");
    page.text(
        "Ways of finding the first point of a solid of revolution along each pixel's ray. In the fragment stage a fragment shader searches within each solid's box, in the compute stage \
         a compute shader does; pictures are the same but for rounding.",
    );
    page.facts(&names(&measured.rows));
    if measured.rows.iter().any(|r| is_rbm_baseline(&r.settings)) {
        page.text("The RBM baseline is revolution mapping, and its extensions, as published in:");
        SOURCES.iter().for_each(|source| page.text(source));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::row::tests::{papers, timed};

    #[test]
    fn every_name_that_occurs_is_explained_once() {
        let fixed = [16, 32].map(|n| Method::mesh(n, 2 * n).unwrap());
        let within = [0.1, 2.0].map(|pixels| Method::mesh_within(pixels).unwrap());
        let row = |method| timed(&[1.0]).set(|s| s.method = method);
        let methods = Method::ALL.into_iter().chain(fixed).chain(within);
        let mut rows: Vec<Row> = methods.map(row).collect();
        rows.push(papers(rows[0].clone()));
        let named = names(&rows);
        assert_eq!(named.len(), Method::ALL.len() + 3);
        for (i, (name, meaning)) in named.iter().enumerate() {
            assert!(meaning.len() > 20 && named[..i].iter().all(|t| t.0 != *name));
        }
        assert_eq!(names(&rows[..1]).len(), 1);
    }
}
