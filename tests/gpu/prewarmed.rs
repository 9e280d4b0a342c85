//! Pipelines compiled beforehand: no frame compiles and no object is hidden, whatever changes but a
//! technique. General and special forms draw the same bits.
#![allow(unsafe_code)]

use crate::common::host::{Drawn, Host, borrow, never, open, opened, view_of};
use crate::common::prelude::*;
use crate::common::random::Random;
use crate::embedding::{hundred, options, three};
use crate::unsubmitted::{by, differ};

/// A renderer of which every general pipeline is compiled.
struct Warm<'a> {
    drawn: Drawn<'a>,
    device: &'a Device,
    compiled: u64,
    name: String,
}

impl<'a> Warm<'a> {
    fn new(
        host: &'a Host,
        device: &'a Device,
        (stage, search): (DrawStage, &SearchSettings),
        scene: &Scene,
    ) -> Self {
        let mut drawn = by(host, device, stage, scene, search);
        drawn.renderer.prewarm().unwrap().compile().unwrap();
        drawn.renderer.hide_until_compiled(true);
        Self {
            compiled: device.pipelines_compiled(),
            name: format!("{stage:?}, {}", search.solver),
            drawn,
            device,
        }
    }

    /// Prepares a frame, which must compile nothing and hide nothing. Returns its statistics.
    #[track_caller]
    fn frame(&mut self, what: &str) -> FrameStatistics {
        let found = prepared(&mut self.drawn);
        assert_eq!(found.hidden, 0, "{}: {what}", self.name);
        let compiled = self.device.pipelines_compiled();
        assert_eq!(compiled, self.compiled, "{}: {what}", self.name);
        found
    }

    /// Makes objects, lights and the view those of a scene with as many objects.
    #[track_caller]
    fn update(&mut self, scene: &Scene, what: &str) -> FrameStatistics {
        let renderer = &mut self.drawn.renderer;
        renderer.set_lighting(&scene.lighting()).unwrap();
        for (id, object) in self.drawn.ids.iter().zip(&scene.objects) {
            renderer.set(*id, object.clone()).unwrap();
        }
        self.drawn.view = view_of(scene, &options());
        self.frame(what)
    }
}

/// Statistics of a frame that is prepared and dropped.
fn prepared(drawn: &mut Drawn) -> FrameStatistics {
    let frame = never(drawn.host, |cmd| drawn.record(cmd, (0, 0), None));
    frame.unwrap().statistics()
}

fn exact() -> SearchSettings {
    SearchSettings::exact()
}

fn vase() -> Scene {
    let mut scene = three();
    scene.objects.truncate(1);
    scene
}

/// Parameters, lights and the eye move.
#[test]
fn no_parameter_compiles_a_pipeline() {
    type Move = (&'static str, fn(&mut Scene));
    let moves: [Move; 12] = [
        ("extend", |s| s.objects[0].offset.extend = 0.01),
        ("extend more", |s| s.objects[0].offset.extend = 0.02),
        ("bevel", |s| s.objects[0].offset.bevel = 0.05),
        ("chamfer", |s| s.objects[0].offset.chamfer = 0.4),
        ("no bevel", |s| s.objects[0].offset.bevel = 0.0),
        ("two lights", |s| s.lights.push(s.lights[0])),
        ("five lights", |s| s.lights = vec![s.lights[0]; 5]),
        ("no light", |s| s.lights.clear()),
        ("far", |s| s.camera.eye *= 9.0),
        ("the eye in the solid", |s| {
            s.camera.eye = DVec3::new(0.05, 0.0, 0.5);
        }),
        ("a contour that does not close", |s| {
            s.objects[0].profile = Arc::new(shapes::crossing());
        }),
        ("many copies", |s| {
            let at = |n: u32| placement([-f64::from(n), 0.3, 0.0], [0.0; 3], [1.0; 3]);
            s.objects[0].instances = (0..70).map(at).collect();
        }),
    ];
    let (host, device) = opened();
    for stage in STAGES {
        for solver in [Solver::Exact, Solver::Quadric, Solver::Live, CIRCLE] {
            let mut scene = vase();
            scene.lights = vec![Light::default()];
            let search = SearchSettings { solver, ..exact() };
            let mut warm = Warm::new(&host, &device, (stage, &search), &scene);
            for (name, change) in moves {
                change(&mut scene);
                warm.update(&scene, name);
            }
        }
    }
}

/// Tables above the largest uniform buffer, seen from afar by a small level, then near by the exact
/// one, with one copy and with many.
#[test]
fn large_tables_compile_nothing() {
    let groove = |n: u32| [0.3 + 0.002 * f64::from(n % 2), f64::from(n) / 1700.0];
    let mut points = vec![[0.0, 0.0]];
    points.extend((0..=1700).map(groove));
    points.push([0.0, 1.0]);
    let screw = Arc::new(Profile::polygon(&points, 0.5).unwrap());
    let (host, device) = opened();
    for stage in STAGES {
        let mut scene = vase();
        scene.objects = vec![Object::new("screw", screw.clone())];
        let near = scene.camera.eye;
        scene.camera.eye = near * 500.0;
        let search = exact().with(|s| s.tolerance = Tolerance::DEFAULT);
        let mut warm = Warm::new(&host, &device, (stage, &search), &scene);
        warm.frame("far");
        scene.camera.eye = near * 0.5;
        warm.update(&scene, "near");
        let costs = warm.drawn.renderer.object_costs();
        assert!(costs[0].table_bytes > 65_536, "{costs:?}");
        let at = |n: u32| placement([-f64::from(n), 0.3, 0.0], [0.0; 3], [1.0; 3]);
        scene.objects[0].instances = (0..70).map(at).collect();
        warm.update(&scene, "copies");
    }
}

/// Scenes in which special forms differ from general ones: one object and several, one light and
/// none, copies, textures, cut and whole, inside and outside.
fn scenes() -> Vec<(&'static str, Scene)> {
    let mut cut = vase();
    cut.objects[0].clip = Clip::Box;
    cut.objects[0].offset.extend = 0.15;
    let mut inside = vase();
    inside.camera.eye = DVec3::new(0.05, 0.0, 0.5);
    let mut dark = three();
    dark.lights.clear();
    let mut glass = vase();
    glass.objects = vec![Object::new("glass", shapes::glass().into())];
    let mut shadowed = three();
    shadowed.shadow = Shadow::Hard;
    vec![
        ("one", vase()),
        ("three", three()),
        ("hundred", hundred()),
        ("cut", cut),
        ("inside", inside),
        ("dark", dark),
        ("glass", glass),
        ("shadowed", shadowed),
    ]
}

#[test]
fn general_and_special_forms_draw_the_same_bits() {
    let host = open();
    let (mut worst, mut taken) = (0, 0);
    for (name, scene) in scenes() {
        for stage in STAGES {
            for least in [0, 150] {
                let search = exact().with(|s| s.proxy_min_pixels = least);
                let device = borrow(&host); // without pipelines
                let mut drawn = by(&host, &device, stage, &scene, &search);
                // Pipelines for three lights are general.
                let mut lighting = scene.lighting();
                lighting.lights = vec![Light::pair()[0]; 3];
                drawn.renderer.set_lighting(&lighting).unwrap();
                drawn.renderer.prewarm().unwrap().compile().unwrap();
                drawn.renderer.set_lighting(&scene.lighting()).unwrap();
                let general = drawn.picture().0;
                drawn.renderer.prewarm().unwrap().compile().unwrap();
                worst = worst.max(differ(&general, &drawn.picture().0));
                let special = drawn.renderer.special_forms();
                taken += special.len();
                special.compile().unwrap();
                let found = drawn.picture().0;
                assert!(
                    drawn.renderer.special_forms().is_empty(),
                    "{name}, {stage:?}"
                );
                let pixels = differ(&general, &found);
                println!("{name}, {stage:?}, {least}: {pixels} pixels differ");
                worst = worst.max(pixels);
            }
        }
    }
    assert!(worst == 0 && taken > 0, "{worst}, {taken}");
}

/// A renderer that hides shows an object as soon as its general form is compiled.
#[test]
fn special_forms_are_taken_when_they_are_compiled() {
    let (host, device) = opened();
    let scene = vase();
    let mut drawn = by(&host, &device, DrawStage::Fragment, &scene, &exact());
    drawn.renderer.hide_until_compiled(true);
    assert!(prepared(&mut drawn).hidden > 0);
    // A renderer that hides no more compiles what it had hidden.
    let mut shown = by(&host, &device, DrawStage::Compute, &scene, &exact());
    shown.renderer.hide_until_compiled(true);
    assert!(prepared(&mut shown).hidden > 0);
    shown.renderer.hide_until_compiled(false);
    assert_eq!(prepared(&mut shown).hidden, 0);
    // The special form alone is enough, too.
    let special = drawn.renderer.special_forms();
    std::thread::scope(|scope| scope.spawn(|| special.compile()).join().unwrap()).unwrap();
    assert_eq!(prepared(&mut drawn).hidden, 0);
    assert!(drawn.renderer.special_forms().is_empty());
    drawn.renderer.prewarm().unwrap().compile().unwrap();
    assert_eq!(prepared(&mut drawn).hidden, 0);
}

/// A random change of the objects, lights or view, but of no technique.
fn change(warm: &mut Warm, solid: &Object, random: &mut Random) {
    let (ids, renderer) = (&mut warm.drawn.ids, &mut warm.drawn.renderer);
    let n = random.below(ids.len());
    let id = ids[n];
    let place = |n: usize| placement([-0.9 * n as f64, 0.3, 0.0], [0.0; 3], [1.0; 3]);
    let done = match random.below(8) {
        0 if ids.len() < 5 => renderer.add(solid.clone()).map(|new| ids.push(new)),
        1 if ids.len() > 1 => renderer.remove(ids.remove(n)),
        2 => renderer.set_mask(id, random.pick(&[0, 1, 3, u32::MAX])),
        3 => {
            let (extend, bevel) = random.pick(&[(0.0, 0.0), (0.3, 0.0), (-0.02, 0.1), (0.05, 0.2)]);
            renderer.set_offset(id, offset(extend, bevel, 1.0))
        }
        4 => {
            let count = random.pick(&[0, 2, 9, 70]);
            renderer.set_instances(id, (0..count).map(place).collect::<Vec<_>>())
        }
        5 => {
            let lights = vec![Light::pair()[0]; random.below(5)];
            renderer.set_lighting(&Lighting::default().with(|l| l.lights = lights))
        }
        6 => {
            let clip = random.pick(&[Clip::None, Clip::Box]);
            let object = renderer.object(id).unwrap().clone();
            renderer.set(id, Object { clip, ..object })
        }
        _ => {
            let mut scene = three();
            scene.camera.eye *= random.pick(&[1.0, 0.02, 0.4, 6.0, 300.0]);
            let mask = random.pick(&[1, 2, u32::MAX]);
            warm.drawn.view = view_of(&scene, &options()).with_mask(mask);
            Ok(())
        }
    };
    done.unwrap();
}

/// `REVMAP_FRAMES=50000` prepares as many frames of each stage.
#[test]
fn random_changes_compile_nothing_and_hide_nothing() {
    let frames = std::env::var("REVMAP_FRAMES").map_or(300, |n| n.parse().unwrap());
    let (host, device) = opened();
    let mut random = Random(7);
    for stage in STAGES {
        let solid = vase().objects.remove(0);
        let mut warm = Warm::new(&host, &device, (stage, &exact()), &vase());
        let mut shown = 0;
        for frame in 0..frames {
            for _ in 0..=random.below(3) {
                change(&mut warm, &solid, &mut random);
            }
            shown += warm.frame(&format!("frame {frame}")).objects;
        }
        assert!(
            shown as usize > frames,
            "{shown} objects in {frames} frames"
        );
    }
}
