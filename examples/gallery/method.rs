//! The picture of the method, from the program's own numbers: profile, map of distances, a ray in
//! the half-plane with its steps over the outline in patches, and the solid with the same ray.

use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::maps::{BakeOptions, MapSource, ShapeMap};
use revmap::profile::{Outline, Profile};
use revmap::scene::{Camera, CameraFrame, Object, Offset, Scene};
use revmap::settings::{Planes, Settings};
use revmap::surface::{ContourSource, FitOptions, QuadricPatch, fit_patches};
use revmap_files::ProfileAxis;
use std::path::Path;

/// Pixels of one object unit in the half-planes.
const UNIT: f64 = 240.0;
/// A panel's size in pixels, and where `(r, z) = (0, 1)` is in it.
const PANEL: [u32; 2] = [184, 264];
const CORNER: DVec2 = DVec2::new(12.0, 12.0);
/// How far a panel shows the half-plane, object units.
const REACH: f64 = (PANEL[0] as f64 - CORNER.x) / UNIT;
const GAP: u32 = 12;
/// Rows above and below the panels, for their titles and what the colours are.
const TITLE: u32 = 32;
const LEGEND: u32 = 36;
const TITLES: [&str; 4] = [
    "1 profile",
    "2 map of distances",
    "3 ray and steps",
    "4 solid",
];
/// Distance between two lines of equal distance, object units.
const LEVEL: f64 = 0.05;
/// How much wider the patches of the picture may be off than those that are drawn: so that an eye
/// can tell them apart.
const COARSER: f64 = 256.0;
/// A sample so near the surface is the hit, object units.
const NEAR: f64 = 1e-3;

const PAPER: [f64; 3] = [1.0; 3];
const INK: [f64; 3] = [0.13, 0.15, 0.19];
const SOLID: [f64; 3] = [0.80, 0.72, 0.60];
const FAINT: [f64; 3] = [0.62, 0.66, 0.72];
const RAY: [f64; 3] = [0.85, 0.29, 0.0];
const STEP: [f64; 3] = [0.10, 0.42, 0.75];
/// Colours of patches, in turn.
const PATCHES: [[f64; 3]; 3] = [[0.0, 0.45, 0.35], [0.55, 0.15, 0.55], [0.0, 0.30, 0.65]];

/// The ray that is shown: it begins in the panels' right border.
const ORIGIN: DVec3 = DVec3::new(0.715, -0.205, 0.725);
const DIRECTION: DVec3 = DVec3::new(-1.0, 0.0, -0.50);

/// Draws the picture into `target`.
pub fn draw(device: &Device, root: &Path, target: &Path) -> Result<()> {
    let profile =
        revmap_files::profile(root.join("assets/profiles/pawn.svg"), ProfileAxis::Center)?;
    let options = BakeOptions {
        source: MapSource::EXACT,
        rows: 512,
        reach: REACH,
    };
    let map = ShapeMap::bake(&profile, &options)?;
    let outline = &profile.outline;
    let ray = Ray::through(&map);
    let panels = [
        profile_panel(outline),
        map_panel(&map, outline),
        ray_panel(outline, &patches(outline)?, &ray),
        solid_panel(device, profile.clone(), &ray)?,
    ];
    let width = GAP + panels.len() as u32 * (PANEL[0] + GAP);
    let height = TITLE + PANEL[1] + LEGEND;
    let mut sheet = RgbImage::from_pixel(width, height, Rgb([255; 3]));
    let mut words = String::new();
    for (place, panel) in panels.iter().enumerate() {
        let left = GAP + place as u32 * (PANEL[0] + GAP);
        words += &crate::words::word([left, TITLE - 10], 14, TITLES[place]);
        let (left, top) = (i64::from(left), i64::from(TITLE));
        image::imageops::overlay(&mut sheet, &panel.picture(), left, top);
    }
    words += &legend(height - 10);
    crate::words::over(&mut sheet, &words)?;
    crate::save(&sheet, target)?;
    println!("{}: {} steps", target.display(), ray.steps.len());
    Ok(())
}

/// What the colours are, in one line whose words stand on row `y`.
fn legend(y: u32) -> String {
    let css = |c: [f64; 3]| {
        let [r, g, b] = c.map(|v| (255.0 * v).round());
        format!("rgb({r},{g},{b})")
    };
    let middle = y - 4;
    let line = |x: u32, color| {
        let (end, color) = (x + 22, css(color));
        format!("<path d='M{x} {middle}H{end}' stroke='{color}' stroke-width='3'/>")
    };
    let dot = |x: u32, r: f64, color| {
        format!(
            "<circle cx='{x}' cy='{middle}' r='{r}' fill='{}'/>",
            css(color)
        )
    };
    let word = |x, text| crate::words::word([x, y], 12, text);
    let [green, violet, blue] = PATCHES;
    [
        line(GAP, RAY),
        dot(GAP + 22, 4.0, RAY),
        word(GAP + 34, "ray and hit"),
        dot(142, 3.0, STEP),
        word(152, "steps by the map's distances, each a circle"),
        line(452, green),
        line(474, violet),
        line(496, blue),
        word(526, "quadrics of the exact search"),
    ]
    .concat()
}

/// The outline in patches that an eye can tell apart.
fn patches(outline: &Outline) -> Result<Vec<QuadricPatch>> {
    let contour = ContourSource::new(outline)?.contour(&Offset::default())?;
    let tolerance = COARSER * FitOptions::default().tolerance;
    Ok(fit_patches(&contour, &FitOptions { tolerance }))
}

/// A ray, where it was sampled, and where it meets the solid.
struct Ray {
    /// Values of `t`, and the distance that was read there.
    steps: Vec<[f64; 2]>,
    hit: f64,
}

impl Ray {
    /// Steps by the distance read, as circle tracing takes them.
    fn through(map: &ShapeMap) -> Self {
        let (mut t, mut steps) = (0.0, Vec::new());
        loop {
            let p = flat(point(t));
            let d = map.distance_at(p.x, p.y);
            if d < NEAR || t > 2.0 {
                return Self { steps, hit: t };
            }
            steps.push([t, d]);
            t += d / DIRECTION.length();
        }
    }
}

fn point(t: f64) -> DVec3 {
    ORIGIN + t * DIRECTION
}

/// A point as the half-plane has it.
fn flat(p: DVec3) -> DVec2 {
    DVec2::new(p.truncate().length(), p.z)
}

fn profile_panel(outline: &Outline) -> Canvas {
    let mut canvas = Canvas::of_half_plane(|p| if outline.contains(p) { SOLID } else { PAPER });
    canvas.outline(outline);
    canvas.axis();
    canvas
}

fn map_panel(map: &ShapeMap, outline: &Outline) -> Canvas {
    let mut canvas = Canvas::of_half_plane(|p| {
        let d = map.distance_at(p.x, p.y);
        let deep = (d.abs() / 0.5).min(1.0);
        let [near, far] = if d < 0.0 {
            [[0.98, 0.90, 0.78], [0.72, 0.40, 0.10]]
        } else {
            [[0.93, 0.96, 1.0], [0.20, 0.40, 0.70]]
        };
        // Lines of equal distance, one pixel wide.
        let off = (d / LEVEL - (d / LEVEL).round()).abs() * LEVEL * UNIT;
        mix(mix(near, far, deep), INK, 0.45 * (1.0 - off).max(0.0))
    });
    canvas.outline(outline);
    canvas.axis();
    canvas
}

fn ray_panel(outline: &Outline, patches: &[QuadricPatch], ray: &Ray) -> Canvas {
    let inside = mix(PAPER, SOLID, 0.45);
    let mut canvas = Canvas::of_half_plane(|p| if outline.contains(p) { inside } else { PAPER });
    canvas.axis();
    for &[t, d] in &ray.steps {
        canvas.ring(at(flat(point(t))), d * UNIT, 1.0, mix(PAPER, STEP, 0.75));
    }
    for (patch, color) in patches.iter().zip(PATCHES.iter().cycle()) {
        let along = |k: u32| {
            let part = f64::from(k) / 16.0;
            let p = patch.start.lerp(patch.end, part);
            // On the quadric at this height; planes are level.
            let r = match patch.is_plane() {
                true => p.x,
                false => patch.square_at(p.y).max(0.0).sqrt(),
            };
            at(DVec2::new(r, p.y))
        };
        canvas.path((0..=16).map(along), 2.4, *color);
        canvas.disc(at(patch.start), 1.7, INK);
    }
    let curve = (0..=200).map(|k| at(flat(point(ray.hit * f64::from(k) / 200.0))));
    canvas.path(curve, 2.0, RAY);
    for &[t, _] in &ray.steps {
        canvas.disc(at(flat(point(t))), 2.4, STEP);
    }
    canvas.disc(at(flat(point(ray.hit))), 4.0, RAY);
    canvas
}

fn solid_panel(device: &Device, profile: Profile, ray: &Ray) -> Result<Canvas> {
    const RAYS: u32 = 3;
    let mut camera = Camera::new(DVec3::new(0.6, -3.4, 1.7), DVec3::new(0.17, 0.0, 0.47));
    camera.fov_y = 22.5;
    let frame = CameraFrame::new(&camera, PANEL[0], PANEL[1])?;
    let mut scene = Scene::new(camera);
    scene.background = [1.0; 4];
    scene.ambient = [0.3; 3];
    let mut object = Object::new("pawn", profile.into());
    object.color = [0.60, 0.42, 0.24];
    scene.objects.push(object);
    let settings = Settings {
        width: PANEL[0] * RAYS,
        height: PANEL[1] * RAYS,
        planes: Planes::All,
        ..Settings::default()
    };
    let drawn = revmap_offscreen::draw(device, &scene, &settings)?.frame;
    let mut canvas = Canvas::of(|x, y| mean(&drawn, [x, y].map(|v| v * RAYS), RAYS));
    let seen = |t: f64| {
        let from_eye = point(t) - frame.eye;
        let depth = from_eye.dot(frame.forward);
        let away = |way: DVec3| from_eye.dot(way) / (depth * way.length_squared());
        DVec2::from_array(frame.middle) + DVec2::new(away(frame.right), -away(frame.up))
    };
    // Its origin is nearer to the eye than the solid, and so is all of it.
    canvas.path([seen(0.0), seen(ray.hit)].into_iter(), 2.0, RAY);
    canvas.disc(seen(ray.hit), 4.0, RAY);
    Ok(canvas)
}

/// The mean of `side` x `side` pixels, as sRGB has it.
fn mean(frame: &Frame, [left, top]: [u32; 2], side: u32) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for k in 0..side * side {
        let (x, y) = (left + k % side, top + k / side);
        let pixel = frame.color[(y * frame.width + x) as usize];
        for (sum, value) in sum.iter_mut().zip(pixel) {
            *sum += f64::from(value) / f64::from(side * side);
        }
    }
    sum.map(revmap::frame::srgb_from_linear)
}

/// Where a point of the half-plane is in a panel, pixels.
fn at(p: DVec2) -> DVec2 {
    CORNER + DVec2::new(p.x, 1.0 - p.y) * UNIT
}

fn mix(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * part.clamp(0.0, 1.0))
}

/// A panel that shapes are painted on, by their distance to each pixel's middle.
struct Canvas(Vec<[f64; 3]>);

impl Canvas {
    fn of(color: impl Fn(u32, u32) -> [f64; 3]) -> Self {
        let [width, height] = PANEL;
        let pixels = (0..width * height).map(|k| color(k % width, k / width));
        Self(pixels.collect())
    }

    /// Means of 3 x 3 colours a pixel; what is left of the axis is paper.
    fn of_half_plane(color: impl Fn(DVec2) -> [f64; 3]) -> Self {
        Self::of(|x, y| {
            let mut sum = [0.0; 3];
            for k in 0..9u32 {
                let part = DVec2::new(f64::from(k % 3), f64::from(k / 3)) / 3.0 + 1.0 / 6.0;
                let p = (DVec2::new(f64::from(x), f64::from(y)) + part - CORNER) / UNIT;
                let found = match p.x < 0.0 {
                    true => PAPER,
                    false => color(DVec2::new(p.x, 1.0 - p.y)),
                };
                sum = [0, 1, 2].map(|k| sum[k] + found[k] / 9.0);
            }
            sum
        })
    }

    /// Paints all that is at most `reach` pixels off, by `distance` from a point.
    fn paint(&mut self, reach: f64, color: [f64; 3], distance: impl Fn(DVec2) -> f64) {
        for (k, pixel) in (0u32..).zip(&mut self.0) {
            let (x, y) = (k % PANEL[0], k / PANEL[0]);
            let d = distance(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
            *pixel = mix(*pixel, color, reach + 0.5 - d);
        }
    }

    fn disc(&mut self, middle: DVec2, radius: f64, color: [f64; 3]) {
        self.paint(radius, color, |p| p.distance(middle));
    }

    fn ring(&mut self, middle: DVec2, radius: f64, width: f64, color: [f64; 3]) {
        self.paint(0.5 * width, color, |p| (p.distance(middle) - radius).abs());
    }

    fn path(&mut self, points: impl Iterator<Item = DVec2>, width: f64, color: [f64; 3]) {
        let points: Vec<DVec2> = points.collect();
        self.paint(0.5 * width, color, |p| {
            let parts = points.windows(2).map(|ends| {
                let way = ends[1] - ends[0];
                let part = (p - ends[0]).dot(way) / way.length_squared().max(1e-12);
                p.distance(ends[0] + way * part.clamp(0.0, 1.0))
            });
            parts.fold(f64::INFINITY, f64::min)
        });
    }

    fn outline(&mut self, outline: &Outline) {
        for segment in outline.surface_segments() {
            self.path([at(segment.a), at(segment.b)].into_iter(), 1.6, INK);
        }
    }

    /// The axis of revolution, in dashes.
    fn axis(&mut self) {
        let [top, bottom] = [0.0, f64::from(PANEL[1])];
        for k in 0..((bottom - top) / 12.0) as u32 {
            let y = top + 12.0 * f64::from(k);
            let ends = [DVec2::new(CORNER.x, y), DVec2::new(CORNER.x, y + 7.0)];
            self.path(ends.into_iter(), 1.2, FAINT);
        }
    }

    fn picture(&self) -> RgbImage {
        RgbImage::from_fn(PANEL[0], PANEL[1], |x, y| {
            Rgb(self.0[(y * PANEL[0] + x) as usize].map(|v| (255.0 * v).round() as u8))
        })
    }
}
