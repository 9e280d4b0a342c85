//! A host's near plane cuts solids as it cuts meshes: rays begin in it.
#![allow(unsafe_code)]

use crate::common::host::{self, Drawn, Host, Options, opened};
use crate::common::prelude::*;
use crate::embedding::{every_way, options};
use crate::embedding_outputs::{WIDE, by_proxies_of, depth_only};
use rayon::prelude::*;
use revmap::cast::RayCaster;

/// The matrices of a scene's camera with this near plane, for reversed depths, without a far plane
/// where rays are not parallel, or for usual ones.
fn matrices(scene: &Scene, near: f64, options: &Options, parallel: bool) -> [DMat4; 2] {
    let look = host::look(scene.camera.eye, scene.camera.target, DVec3::Z);
    let endless = options.reversed && !parallel;
    let far = if endless { f64::INFINITY } else { 50.0 };
    let scales = if parallel {
        WIDE
    } else {
        host::scales(options)
    };
    let lens = host::lens(scales, parallel, options.reversed, [near, far]);
    [look, lens]
}

/// The depth along the view of what each pixel shows, by rays from the near plane.
fn wanted(scene: &Scene, [view, lens]: [DMat4; 2], near: f64, options: &Options) -> Vec<f64> {
    let objects = scene.objects.iter();
    let casters: Vec<_> = objects.map(|o| RayCaster::new(o).unwrap()).collect();
    let back = (lens * view).inverse();
    let forward = -view.transpose().z_axis.truncate();
    let (width, height) = (options.width, options.height);
    let at = |size: u32, k: u32| 2.0 * (f64::from(k) + 0.5) / f64::from(size) - 1.0;
    let first = if options.reversed { 1.0 } else { 0.0 };
    let pixel = |n: u32| {
        let (x, y) = (at(width, n % width), at(height, n / width));
        let [from, to] = [first, 0.5].map(|z| back.project_point3(DVec3::new(x, y, z)));
        let way = (to - from) / (to - from).dot(forward);
        let hits = casters.iter().filter_map(|caster| caster.cast(from, way));
        near + hits.map(|hit| hit.t).fold(f64::INFINITY, f64::min)
    };
    (0..width * height).into_par_iter().map(pixel).collect()
}

/// Depths of a scene in a pass of depths alone, in a pass of colours, and in compute.
fn depths(
    (host, device): (&Host, &Device),
    scene: &Scene,
    view: &View,
    settings: &SearchSettings,
    options: &Options,
    parallel: bool,
) -> Vec<(&'static str, Vec<f32>, Vec<DrawPath>)> {
    let of = |pass: PassFormats| Output::Pass(pass.with(|p| p.depth = host::order(options)));
    let is_live = settings.solver == Solver::Live;
    let all = [
        ("depth", of(depth_only(parallel)), !is_live),
        ("color", of(host::color_pass()), !parallel),
        (
            "compute",
            Output::Compute(Planes::Color),
            !parallel && !options.reversed,
        ),
    ];
    let taken = all.into_iter().filter(|(.., takes)| *takes);
    let drawn = taken.map(|(name, output, _)| {
        let drawn = Drawn::new(host, device, *options, (output, settings), scene);
        let mut drawn = drawn.seen(view);
        (name, drawn.picture().1, drawn.renderer.draw_paths())
    });
    drawn.collect()
}

/// What is before the near plane is not drawn, and what the plane cuts shows its inner side, by every
/// search, draw path and stage.
#[test]
fn the_near_plane_cuts_solids() {
    let (host, device) = opened();
    let planes_of = |name: &str| match name {
        "three" => vec![1.5, 2.95, 6.0],
        "one" => vec![3.05],
        "copies" => vec![2.6, 3.5],
        "cut by the box" => vec![3.1],
        "an eye within" => vec![0.01, 0.3],
        _ => vec![2.9],
    };
    let of = |solver| SearchSettings::exact().with(|s| s.solver = solver);
    let searches = [
        by_proxies_of(0),
        by_proxies_of(u32::MAX),
        of(Solver::Quadric),
        of(Solver::Live),
    ];
    let mut paths = HashSet::new();
    for (name, scene) in &every_way() {
        for (near, reversed, parallel) in planes_of(name).into_iter().flat_map(|near| {
            [(false, false), (true, false), (false, true)].map(|(r, p)| (near, r, p))
        }) {
            let options = options().with(|o| o.reversed = reversed);
            let both = matrices(scene, near, &options, parallel);
            let view = host::view(both, &options).unwrap();
            let truth = wanted(scene, both, near, &options);
            for settings in &searches {
                if parallel && settings.solver == Solver::Live {
                    continue;
                }
                let every = depths((&host, &device), scene, &view, settings, &options, parallel);
                for (pass, found, own) in every {
                    paths.extend(own);
                    let off = |(depth, t): (&f32, &f64)| {
                        let place =
                            view.t_at(f64::from(*depth)) + if parallel { near } else { 0.0 };
                        let empty = *depth == if reversed { 0.0 } else { 1.0 };
                        let far = (place - t).abs() > 4e-3;
                        if empty { t.is_finite() } else { far }
                    };
                    let wrong = found.iter().zip(&truth).filter(|pair| off(*pair)).count();
                    let hits = truth.iter().filter(|t| t.is_finite()).count();
                    let case = format!(
                        "{name}, near {near}, reversed {reversed}, parallel {parallel}, {}, {pass}",
                        settings.solver
                    );
                    println!("{case}: {wrong} of {hits}");
                    let most = if settings.solver == Solver::Live {
                        8
                    } else {
                        2
                    };
                    assert!(wrong <= most, "{case}: {wrong} of {hits}");
                }
            }
        }
    }
    let every = [DrawPath::Cells, DrawPath::Box, DrawPath::Walk];
    assert!(every.iter().all(|path| paths.contains(path)), "{paths:?}");
}
