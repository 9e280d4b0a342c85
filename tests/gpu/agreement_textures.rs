//! Fragment and compute pictures are equal bit for bit with all textures, bumps and offsets.

use crate::common::{assert_sound, draw, eye, placement, scene_of, shapes};
use glam::DVec3;
use revmap::maps::{ColorMap, DisplacementMap, MapFormat, Projection, SlopeFilter};
use revmap::scene::{BumpForm, Object, Offset, Scene, Shadow, Texturing};
use revmap::settings::{DrawStage, Planes, Settings, Solver};
use revmap_searches::CIRCLE;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("assets")
        .join(name)
}

struct Maps {
    earth: Arc<ColorMap>,
    bricks: Arc<DisplacementMap>,
}

fn maps() -> Maps {
    Maps {
        earth: Arc::new(revmap_files::color_map(asset("colors/natural-earth.png")).unwrap()),
        bricks: Arc::new(
            revmap_files::displacement_map(asset("heights/brick.png"), SlopeFilter::default())
                .unwrap(),
        ),
    }
}

fn covered(maps: &Maps, projection: Projection, bump_form: BumpForm) -> Texturing {
    Texturing {
        color_map: Some(maps.earth.clone()),
        displacement_map: Some(maps.bricks.clone()),
        bump: 0.02,
        bump_form,
        projection,
        repeat: [2.0, 1.0],
    }
}

const CHAMFERED: Offset = Offset {
    extend: -0.02,
    bevel: 0.7,
    chamfer: 0.15,
};

fn scenes() -> Vec<(String, Scene)> {
    let maps = maps();
    let mut all = Vec::new();
    let forms = [BumpForm::SurfaceGradient, BumpForm::Papers];
    for (n, (_, projection)) in Projection::NAMES.into_iter().enumerate() {
        let mut scene = scene_of(shapes::vase(), eye(20.0 + 15.0 * n as f64, 1.7));
        let object = &mut scene.objects[0];
        object.texturing = covered(&maps, projection, forms[n % 2]);
        object.offset = CHAMFERED;
        object.placement = placement([0.05, 0.0, 0.1], [0.3, -0.2, 0.4], [1.1, 0.8, 0.9]);
        all.push((format!("{projection:?}"), scene));
    }
    for (name, offset) in [
        ("extended", [0.04, 0.0, 1.0]),
        ("inset", [-0.01, 0.0, 1.0]),
        ("beveled", [0.01, 0.3, 1.0]),
    ] {
        let mut scene = scene_of(shapes::glass(), eye(30.0, 1.9));
        let [extend, bevel, chamfer] = offset;
        scene.objects[0].offset = Offset {
            extend,
            bevel,
            chamfer,
        };
        scene.objects[0].texturing = covered(&maps, Projection::Arc, BumpForm::SurfaceGradient);
        all.push((name.into(), scene));
    }
    for mirror in [false, true] {
        let mut scene = scene_of(shapes::jewel(), eye(25.0, 1.8));
        let object = &mut scene.objects[0];
        object.repeat = [3, 2, 2];
        object.mirror = [mirror; 3];
        object.axis = [0.4, 0.55];
        object.texturing = covered(&maps, Projection::Cylindrical, BumpForm::SurfaceGradient);
        all.push((format!("replicas, mirrored: {mirror}"), scene));
    }
    for shadow in [Shadow::Hard, Shadow::Soft] {
        let mut scene = scene_of(shapes::torus(), DVec3::new(1.9, 1.1, 1.6));
        scene.shadow = shadow;
        scene.objects[0].texturing =
            covered(&maps, Projection::Spherical, BumpForm::SurfaceGradient);
        scene.objects[0].texturing.bump = 0.005;
        let mut table = Object::new("table", Arc::new(shapes::cone()));
        table.placement = placement([0.0, 0.0, -0.3], [0.0; 3], [2.5, 2.5, 0.6]);
        let mut several = Object::new("several", Arc::new(shapes::discs()));
        several.repeat = [2, 2, 1];
        several.placement = placement([-0.5, 0.7, 0.1], [0.5, 0.3, 0.0], [0.8; 3]);
        several.offset.extend = 0.005;
        scene.objects.extend([table, several]);
        all.push((format!("{shadow:?} shadows"), scene));
    }
    all
}

#[test]
fn fragment_and_compute_agree_bit_for_bit() {
    let formats = [MapFormat::R16, MapFormat::R32, MapFormat::Rgba8];
    for (n, (name, scene)) in scenes().into_iter().enumerate() {
        let inset = scene.objects[0].offset.extend < 0.0; // the papers' format cannot hold this
        let settings = Settings {
            width: 200,
            height: 151,
            map_rows: Some(256),
            solver: [Solver::Live, CIRCLE, Solver::Quadric][n % 3],
            map_format: if inset {
                MapFormat::R16
            } else {
                formats[(n + n / 3) % 3]
            },
            // Cells and lists of patches change where rays start; culled tiles count no steps.
            proxy_min_pixels: u32::MAX,
            occlusion_culling: false,
            ..Settings::exact()
        };
        let compute = Settings {
            stage: DrawStage::Compute,
            ..settings
        };
        let fragment = draw(&scene, &settings);
        assert_sound(&fragment, &name);
        let hits = (0..fragment.pixels()).filter(|&i| fragment.hits(i)).count();
        assert!(hits > 1500, "{name}: only {hits} pixels are hit");
        let tilted =
            (0..fragment.pixels()).filter(|&i| fragment.normal[i] != fragment.shading_normal[i]);
        let tilted = tilted.count();
        println!("{name}: {hits} hits, {tilted} with bumps");
        assert!(tilted > 300, "{name}: no bumps are seen");
        if let Some(difference) = fragment.first_difference(&draw(&scene, &compute)) {
            panic!("{name}: {difference}");
        }
        // Colour only: 8 bits, encoded separately by each stage.
        let color = |stage| {
            draw(
                &scene,
                &Settings {
                    stage,
                    planes: Planes::Color,
                    ..settings
                },
            )
            .color
        };
        let (a, b) = (color(DrawStage::Fragment), color(DrawStage::Compute));
        let most = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| {
            let code = |v: f32| revmap::frame::srgb_from_linear(f64::from(v)) * 255.0;
            (code(*a) - code(*b)).abs()
        });
        let most = most.fold(0.0, f64::max);
        assert!(most < 1.01, "{name}: colours differ by {most} of 255");
    }
}
