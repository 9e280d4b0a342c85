//! What the names in a report stand for, in a sentence each: a reader of one page needs no other.

use super::measure::Measured;
use super::page::Page;
use super::plan::{RBM_BASELINE, is_rbm_baseline};
use super::row::Row;
use crate::method::Method;
use revmap::settings::Solver;

/// What a search does.
#[must_use]
pub fn meaning(method: Method) -> &'static str {
    match method {
        Method::Search(Solver::Other(search)) => search.about,
        Method::Search(Solver::Live) => {
            "steps through the map that are safe to a texel under every offset, ending in a secant; for parameters that change from frame to frame"
        }
        Method::Search(Solver::Quadric) => {
            "no map: the outline as quadric patches, solved exactly, found by a tree"
        }
        Method::Search(Solver::Exact) => {
            "the default: quadric patches of the outline, found by the rasteriser in the fragment stage and by tiles of pixels in the compute stage"
        }
        Method::MeshLevels => {
            "the mesh baseline with levels of detail: 16 x 32, 32 x 64 or 64 x 128 by the height of each copy on the screen (to 40, to 160 pixels, above); copies beside the picture are left out"
        }
        Method::Floor => {
            "the default's frame without a search: each pixel returns its first possible point (the hull's own fragment, the ray's entry into the solid's bounding cylinder), with the same vertices, tiles, lists of copies, depth, shading and store. It is an estimate of the least time of a search, not a proven bound: it shades some pixels beside the solid, and asks only the nearest copies"
        }
        Method::Mesh { .. } => {
            "the mesh baseline: the same solid as triangles, so many segments around the axis by so many rings along the outline; fragment stage alone"
        }
    }
}

const PAPERS: &str = "revolution-bump mapping as it was published: circle tracing of 20 steps (25 and 10 halvings under a bevel) over the distances of a binary image in 8 bits";

/// Where the RBM baseline was published.
const SOURCES: [&str; 4] = [
    "A. Halli, A. Saaidi, K. Satori, H. Tairi: Extrusion and revolution mapping. ACM Transactions on Graphics 29 (5), 2010, 1-14. doi:10.1145/1857907.1857908",
    "A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori: Revolution mapping with bump mapping support. Graphical Models 100, 2018, 1-11. doi:10.1016/j.gmod.2018.09.001",
    "A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori, H. El Moubtahij: The extensions of revolution-bump mapping. Journal of Graphic Engineering and Design 13 (1), 2022, 21-31. doi:10.24867/JGED-2022-1-021",
    "A. Ragragui, A. Ouazzani Chahdi, A. Arbah, H. El Moubtahij, A. Halli, K. Satori: Revolution-bump mapping with texture function adjustment according to the geometry of the revolved object. Journal of Graphic Engineering and Design, 2025",
];

/// What the columns of tables and of results.csv mean.
const COLUMNS: [(&str, &str); 42] = [
    (
        "scene, picture",
        "name of the view: the scene, with @ the elevation of the camera in degrees, with : a framing",
    ),
    (
        "framing",
        "whole: the solid from head to foot; close: the field of view narrowed until the solid's box is a quarter larger than a picture of 4:3",
    ),
    (
        "form, technique",
        "offset of the surface: revolution (none), extended, beveled or chamfered",
    ),
    (
        "extend, bevel, chamfer",
        "parameters of the offset: object units, slope, depth from 0 to 1",
    ),
    (
        "method, solver",
        "how the first hit along a ray is found; mesh:SxR is a mesh of S segments around the axis and R rings along the outline",
    ),
    ("stage", "shader stage in which rays are traced"),
    ("size, width, height", "pixels of the picture"),
    ("solids, objects", "solids in the scene, copies counted"),
    (
        "pixels hit",
        "share of the picture's pixels in which the reference hits a solid",
    ),
    ("max_steps", "bound on the steps of the search"),
    (
        "map_rows, map_source, map_format",
        "rows of the shape map; where its distances come from; how they are stored",
    ),
    (
        "tolerance_px",
        "allowed error of silhouettes and depths in pixels, of searches on patches; 0 is exact",
    ),
    (
        "time (ms), gpu_ms_median",
        "time of a frame by the device's timestamps, by the wall clock where the device has none (gpu_ms_median is empty then): geometric mean of the passes' medians",
    ),
    (
        "95 % interval, gpu_ms_low, gpu_ms_high",
        "ends of the interval that covers the value with 95 % confidence, Student's over the passes",
    ),
    (
        "gpu_ms_p95",
        "95th percentile of all timed frames, milliseconds",
    ),
    (
        "frame_ms_median",
        "wall clock from submission to completion, without reading back, milliseconds: geometric mean of the passes' medians",
    ),
    (
        "above the floor (ms), above_floor_ms",
        "time less that of the floor in the same picture and stage, milliseconds: what the search itself takes",
    ),
    (
        "above the floor / RBM baseline",
        "time above the floor over the whole time of the RBM baseline in the same picture and stage: mean over the pictures",
    ),
    (
        "frames / s, fps",
        "frames per second: in tables 1000 over the time, in results.csv 1000 over frame_ms_median",
    ),
    (
        "look-ups mean, look-ups p99, look-ups max, steps_mean, steps_p99, steps_max",
        "look-ups that the search made in a pixel: mean, 99th percentile and maximum over the pixels with at least one",
    ),
    (
        "out of steps",
        "pixels in which the search used up its bound on steps",
    ),
    (
        "memory (kB)",
        "kilobytes on the device: shape maps and tables, or the mesh",
    ),
    (
        "missed",
        "pixels in which the reference hits and the frame does not",
    ),
    (
        "ghosts, ghost",
        "pixels in which the frame hits and the reference does not",
    ),
    (
        "wrong pixels, worst wrong pixels",
        "missed and ghost pixels over the pixels hit: of all pictures together; of the worst",
    ),
    (
        "depth rms (h/512), depth p99 (h/512), depth max (h/512), depth_rms_texels, depth_p99_texels, depth_max_texels",
        "error of the distance along the ray in pixels that both hit, in h/512, 1/512 of the solid's height: root mean square, 99th percentile, maximum; over several pictures the geometric mean",
    ),
    (
        "worst depth p99 (h/512)",
        "the 99th percentile of the worst picture",
    ),
    ("mesh depth p99 (h/512)", "the same of the mesh"),
    (
        "normal rms (°), worst normal rms (°), normal_rms_degrees",
        "angle between the frame's normals and the reference's, degrees: root mean square, of one picture or of the worst",
    ),
    (
        "silhouette (px), silhouette_hausdorff_px",
        "Hausdorff distance of the silhouettes, pixels",
    ),
    (
        "FLIP, flip",
        "mean of the difference metric FLIP over the picture, from 0 (equal) to 1",
    ),
    (
        "time / RBM baseline",
        "time over that of the RBM baseline in the same picture and stage: geometric mean over the pictures",
    ),
    (
        "method / mesh, time / mesh",
        "default search over the mesh; its time over that of the mesh in the same picture: geometric mean",
    ),
    (
        "range over pictures",
        "least and greatest ratio of a single picture",
    ),
    ("pictures", "number of pictures of which both were measured"),
    (
        "mesh at least as accurate",
        "number of pictures in which the mesh's depth error (99th percentile) is at most that of the search",
    ),
    (
        "on the front of",
        "number of pictures in which no method is better in both time and depth error",
    ),
    (
        "time at the least (ms), time at the most (ms)",
        "time of a frame at the least and at the most of what grows",
    ),
    (
        "exponent (95 % interval), exponent of the last step",
        "k in time = factor x quantity ^ k, fitted over all steps; over the last one alone",
    ),
    (
        "last rate / first, trend",
        "rate at the table's last value over that at its first; whether it rises, falls, or neither with 95 % confidence",
    ),
    (
        "row, reason",
        "number of the record in results.csv; why it is excluded",
    ),
    ("device, driver", "Vulkan device and driver"),
];

/// The names that occur in these rows, each with its meaning, in the order in which reports list
/// them.
#[must_use]
pub fn names(rows: &[Row]) -> Vec<(&'static str, String)> {
    let occurs = |of: &dyn Fn(&Row) -> bool| rows.iter().any(of);
    let mut all: Vec<(&'static str, String)> = Vec::new();
    for method in Method::ALL {
        if occurs(&|r| r.settings.method == method && !is_rbm_baseline(&r.settings)) {
            all.push((method.name(), meaning(method).to_owned()));
        }
    }
    let mesh = rows.iter().map(|r| r.settings.method).find(|s| s.is_mesh());
    all.extend(mesh.map(|mesh| ("mesh", meaning(mesh).to_owned())));
    if occurs(&|r| r.settings.method == Method::Floor) {
        all.push((Method::Floor.name(), meaning(Method::Floor).to_owned()));
    }
    if occurs(&|r| is_rbm_baseline(&r.settings)) {
        all.push((RBM_BASELINE, PAPERS.to_owned()));
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
    if measured.rows.iter().any(|r| is_rbm_baseline(&r.settings)) {
        page.text("The RBM baseline is revolution mapping, and its extensions, as published in:");
        SOURCES.iter().for_each(|source| page.text(source));
    }
}

/// The chapter that says what every column means, in tables and in results.csv.
pub fn columns(page: &mut Page) {
    page.chapter("Columns");
    // Names of one meaning stand in a row, those after the first with a reference to it.
    let mut facts = Vec::new();
    for (names, meaning) in COLUMNS {
        let mut names = names.split(", ");
        let Some(first) = names.next() else { continue };
        facts.push((first, meaning.to_owned()));
        facts.extend(names.map(|name| (name, format!("see {first}"))));
    }
    page.facts(&facts);
}

#[cfg(test)]
mod tests {
    use super::super::plan::rbm_baseline;
    use super::super::row::tests::row as one_row;
    use super::super::view::tests::spindle;
    use super::super::{chapters, curves, picture_groups, row, scaling, text};
    use super::*;

    #[test]
    fn every_column_is_defined_once() {
        let tables: [&[&str]; 9] = [
            &row::COLUMNS,
            &text::RATIOS,
            &text::AGAINST_MESHES,
            &chapters::TIMES,
            &chapters::ERRORS,
            &chapters::EXCLUDED,
            &picture_groups::PICTURES,
            &curves::FRONTS,
            &scaling::HEADER,
        ];
        let defined: Vec<&str> = COLUMNS
            .iter()
            .flat_map(|(names, _)| names.split(", "))
            .collect();
        for (i, name) in defined.iter().enumerate() {
            assert!(!defined[..i].contains(name), "{name}");
        }
        for column in tables.concat() {
            assert!(defined.contains(&column), "{column}");
        }
    }

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
            let mut one = one_row(&[&[(None, 1.0)]]);
            one.settings.method = method;
            rows.push(one);
        }
        let mut papers = rows[0].clone();
        papers.settings = rbm_baseline(&spindle(), &papers.settings);
        rows.push(papers);
        let told = names(&rows);
        assert_eq!(told.len(), Method::ALL.len() + 2);
        for (i, (name, meaning)) in told.iter().enumerate() {
            assert!(meaning.len() > 20 && told[..i].iter().all(|t| t.0 != *name));
        }
        assert_eq!(names(&rows[..1]).len(), 1);
    }
}
