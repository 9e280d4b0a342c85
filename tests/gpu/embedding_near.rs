//! A host's near plane cuts solids as it cuts meshes: rays begin in it.
#![allow(unsafe_code)]

use crate::common::host::{Host, Options, opened, order, viewport};
use crate::common::prelude::*;
use crate::embedding::{every_way, first_frame, options};
use crate::embedding_outputs::{by_proxies_of, depth_only};
use rayon::prelude::*;
use revmap::cast::RayCaster;

/// The matrices of a scene's camera with this near plane, for reversed depths without a far plane, or
/// for usual ones.
fn matrices(scene: &Scene, near: f64, options: &Options, parallel: bool) -> [DMat4; 2] {
    let [view, mut lens] =
        host::view_and_projection(scene.camera.eye, scene.camera.target, options);
    let far = 50.0;
    let (z, w) = match (parallel, options.reversed) {
        (true, true) => (1.0 / (far - near), far / (far - near)),
        (true, false) => (-1.0 / (far - near), -near / (far - near)),
        (false, true) => (0.0, near),
        (false, false) => (far / (near - far), near * far / (near - far)),
    };
    (lens.z_axis.z, lens.w_axis.z) = (z, w);
    if parallel {
        let wide = DVec4::new(1.0 / 0.8, -1.0 / 0.6, 1.0, 1.0);
        lens = DMat4::from_cols(
            DVec4::X * wide.x,
            DVec4::Y * wide.y,
            DVec4::Z * z,
            DVec4::new(0.0, 0.0, w, 1.0),
        );
    }
    [view, lens]
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

/// Depths of a scene in a pass of colours, in a pass of depths alone, and in compute.
fn depths(
    (host, device): (&Host, &Device),
    scene: &Scene,
    view: &View,
    settings: &SearchSettings,
    options: &Options,
    parallel: bool,
) -> Vec<(&'static str, Vec<f32>, Vec<DrawPath>)> {
    let alone = depth_only(parallel).with(|p| p.depth = order(options));
    let color = host::color_pass().with(|p| p.depth = order(options));
    let mut passes = vec![("depth", alone, &[][..])];
    if !parallel {
        passes.push(("color", color, &[(host::COLOR, 4)]));
    }
    if settings.solver == Solver::Live && !parallel {
        passes.remove(0);
    }
    let mut all = Vec::new();
    for (name, pass, formats) in passes {
        let mut renderer = host::renderer_of(device, Output::Pass(pass), settings, 1, scene);
        let drawn = (&mut renderer, view);
        let (_, depths) = first_frame(host, *options, Some(formats), drawn, None);
        all.push((name, depths, renderer.draw_paths()));
    }
    if !parallel && !options.reversed {
        let output = Output::Compute(Planes::Color);
        let mut renderer = host::renderer_of(device, output, settings, 1, scene);
        let (_, depths) = first_frame(host, *options, None, (&mut renderer, view), None);
        all.push(("compute", depths, renderer.draw_paths()));
    }
    all
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
            let [look, lens] = both;
            let view = View::from_matrices(look, lens, viewport(&options), order(&options));
            let view = view.unwrap();
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
    let every = [DrawPath::Cells, DrawPath::Box, DrawPath::Tiles];
    assert!(every.iter().all(|path| paths.contains(path)), "{paths:?}");
}
