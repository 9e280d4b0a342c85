//! Judges pictures of faces in one plane. Each copy is also drawn alone: those pictures give the
//! copies that share a point, and the look of the first one. Pixels beside a contour are left out.

use crate::common::change::Change;
use crate::common::{draw, drawn_by};
use crate::coplanar::{SIZE, inlay};
use revmap::frame::Frame;
use revmap::scene::{Object, Scene};
use revmap::settings::{DrawStage, Solver};

/// Distances of one point differ by less than this: a part of them, and world units.
const TOGETHER: [f32; 2] = [2e-7, 1e-4];

/// A picture: what the ray of each pixel meets.
pub struct Picture {
    /// Infinite without a hit.
    pub distances: Vec<f32>,
    /// Equal for equal looks; differences by whole numbers do not count.
    pub looks: Vec<[f32; 5]>,
}

impl From<Frame> for Picture {
    /// The look is colour and texture coordinates.
    fn from(frame: Frame) -> Self {
        let looks = frame.albedo.iter().zip(&frame.uv);
        Self {
            looks: looks
                .map(|([r, g, b], [u, v])| [*r, *g, *b, *u, *v])
                .collect(),
            distances: frame.distance,
        }
    }
}

impl Picture {
    /// True if both show the same at a pixel, as far as the look tells. Texture coordinates of 0
    /// and 1 are the same.
    fn shows(&self, other: &Self, pixel: usize) -> bool {
        let pairs = self.looks[pixel].iter().zip(&other.looks[pixel]);
        let apart = pairs.map(|(a, b)| a - b);
        apart.map(|d| (d - d.round()).abs()).all(|d| d < 2e-3)
    }
}

/// The scene with one copy only, for each copy.
fn alone(all: &Scene) -> Vec<Scene> {
    let of = |object: &Object| {
        let copies = object.placements().iter().map(|placement| Object {
            placement: *placement,
            instances: Vec::new().into(),
            ..object.clone()
        });
        copies.collect::<Vec<_>>()
    };
    let with = |object: Object| all.clone().with(|one| one.objects = vec![object]);
    all.objects.iter().flat_map(of).map(with).collect()
}

/// The copies that share the nearest point of a pixel, as bits.
fn nearest(all: &[Picture], pixel: usize) -> u128 {
    let distance = |one: &Picture| one.distances[pixel];
    let least = all.iter().map(distance).fold(f32::INFINITY, f32::min);
    let most = least * (1.0 + TOGETHER[0]) + TOGETHER[1];
    let shares = |one: &Picture| distance(one) <= most && least.is_finite();
    (0..)
        .zip(all)
        .map(|(k, one)| u128::from(shares(one)) << k)
        .sum()
}

/// The pixels of shared parts that tell two copies apart, and how many of them do not show the
/// first copy.
pub fn speckles(scene: &Scene, drawn: impl Fn(&Scene) -> Picture) -> [usize; 2] {
    let picture = drawn(scene);
    let all: Vec<Picture> = alone(scene).iter().map(drawn).collect();
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let sets: Vec<u128> = (0..width * height).map(|p| nearest(&all, p)).collect();
    let is_inside = |p: usize| {
        let (x, y) = (p % width, p / width);
        let inner = (1..width - 1).contains(&x) && (1..height - 1).contains(&y);
        let row = |p: usize| sets[p - 1..=p + 1].iter().all(|set| *set == sets[p]);
        inner
            && [p - width, p, p + width]
                .into_iter()
                .all(|q| sets[q] == sets[p] && row(q))
    };
    let shared = (0..width * height).filter(|p| sets[*p].count_ones() > 1 && is_inside(*p));
    let mut counts = [0; 2];
    for pixel in shared {
        let first = &all[sets[pixel].trailing_zeros() as usize];
        let differs = |k: usize| sets[pixel] >> k & 1 == 1 && !all[k].shows(first, pixel);
        if (0..all.len()).any(differs) {
            counts[0] += 1;
            counts[1] += usize::from(!picture.shows(first, pixel));
        }
    }
    counts
}

/// Pixels that show the second copy are counted.
#[test]
fn a_wrong_copy_is_counted() {
    let settings = drawn_by(SIZE, DrawStage::Fragment, Solver::Exact);
    let last_first = |scene: &Scene| scene.clone().with(|one| one.objects.reverse());
    let drawn = |scene: &Scene| draw(&last_first(scene), &settings).into();
    let [shared, wrong] = speckles(&inlay(0), drawn);
    assert!(shared == wrong && shared > 600, "{wrong} of {shared}");
}
