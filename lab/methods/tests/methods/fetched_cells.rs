//! Cells whose fragments fetch their patches, as on a GPU, drawn by a software driver.

use crate::scenes::{eye, scene_of};
use crate::shapes;
use revmap::gpu::{Device, DrawPath};
use revmap::scene::Clip;
use revmap::settings::{Planes, Settings, Solver};
use revmap_offscreen::Offscreen;
use shaderc_link::{Compiler, OptimizationLevel, spirv};

const GLSL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders-glsl");
const PASSED: &str = "layout(constant_id = 18) const uint FETCHED_CELLS = 0u;";
/// No pipeline sets this constant, so it keeps its value.
const FETCHED: &str = "layout(constant_id = 118) const uint FETCHED_CELLS = 1u;";

fn text(path: &str) -> (String, String) {
    let path = format!("{GLSL}/{path}");
    let text = std::fs::read_to_string(&path).unwrap();
    (path, text)
}

/// The library's module in which the constant has the value of a GPU.
fn fetching(file: &str, macros: &[(&str, &str)]) -> revmap::error::Result<Option<Vec<u32>>> {
    let include = |wanted: &str| {
        let (path, text) = text(&format!("include/{wanted}"));
        assert!(!wanted.ends_with("variant.glsl") || text.contains(PASSED));
        Ok((path, text.replace(PASSED, FETCHED)))
    };
    let (path, entry) = text(file);
    let compiler = Compiler::new().unwrap();
    let level = OptimizationLevel::Performance;
    let made = spirv(&compiler, (&path, &entry), macros, level, include).unwrap();
    Ok(Some(made.as_binary().to_vec()))
}

/// Both ways draw the same bits, of whole solids and of those that their box cuts.
#[test]
fn fetched_cells_are_passed_cells() {
    let passed = Device::open_validated(None).unwrap();
    // SAFETY: the modules are the library's own.
    #[allow(unsafe_code)]
    let fetched = unsafe { passed.with_shaders(Box::new(fetching)) }.unwrap();
    let whole = scene_of(shapes::vase(), eye(25.0, 2.6));
    let mut cut = whole.clone();
    cut.objects[0].clip = Clip::Box;
    cut.objects[0].offset.extend = 0.2;
    let settings = Settings {
        solver: Solver::Exact,
        planes: Planes::All,
        width: 200,
        height: 150,
        proxy_min_pixels: 0,
        ..Settings::exact()
    };
    for scene in [&whole, &cut] {
        let [a, b] = [&passed, &fetched].map(|device| {
            let mut renderer = Offscreen::new(device, scene, &settings).unwrap();
            renderer.draw().unwrap();
            assert_eq!(renderer.renderer().draw_paths(), [DrawPath::Cells]);
            renderer.read().unwrap()
        });
        assert!((0..a.pixels()).filter(|&k| a.hits(k)).count() > 2000);
        assert_eq!(a.first_difference(&b), None);
    }
    passed.check().unwrap();
}
