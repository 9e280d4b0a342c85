//! A turned thing of a known outline, drawn before a ground.

use revmap_photo::Photo;

pub const SIZE: [usize; 2] = [180, 240];

/// A baluster's radius at a height, both as parts of the thing's height.
pub fn radius(z: f64) -> f64 {
    let wave = 0.16 + 0.07 * (7.0 * z + 0.6).sin() + 0.03 * (16.0 * z).cos();
    if (0.0..=1.0).contains(&z) { wave } else { -1.0 }
}

pub type Color = [f64; 3];

/// A turned thing before a ground.
pub struct Scene {
    pub axis: f64,
    pub tilt: f64,
    pub color: Color,
    pub ground: Color,
    pub table: Option<Color>,
    /// Light at the left and at the right edge.
    pub light: [f64; 2],
    /// Offset of a shadow on the wall, and its darkness.
    pub shadow: Option<(f64, f64)>,
    pub noise: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            axis: 0.5,
            tilt: 0.0,
            color: [0.35, 0.25, 0.2],
            ground: [0.8, 0.78, 0.74],
            table: None,
            light: [1.0, 1.0],
            shadow: None,
            noise: 0.01,
        }
    }
}

/// The usual scene with a change.
pub fn changed(change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene::default();
    change(&mut scene);
    scene
}

impl Scene {
    /// Height of the thing, pixels.
    pub const TALL: f64 = 170.0;

    /// Place of a pixel: across the axis and along it, heights of the thing.
    pub fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let (s, c) = self.tilt.to_radians().sin_cos();
        let (x, y) = (x - self.axis * SIZE[0] as f64, 0.5 * SIZE[1] as f64 - y);
        [
            (c * x - s * y) / Self::TALL,
            (s * x + c * y) / Self::TALL + 0.5,
        ]
    }

    /// The picture; `more` changes the colour at a place.
    pub fn draw(&self, more: impl Fn([f64; 2], bool, Color) -> Color) -> Vec<[u8; 4]> {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24) - 0.5
        };
        let mut pixels = Vec::new();
        for i in 0..SIZE[0] * SIZE[1] {
            let (px, py) = ((i % SIZE[0]) as f64, (i / SIZE[0]) as f64);
            let mut sum = [0.0; 3];
            for k in 0..4 {
                let (x, y) = (
                    px + 0.25 + 0.5 * f64::from(k % 2),
                    py + 0.25 + 0.5 * f64::from(k / 2),
                );
                let [u, z] = self.place(x, y);
                let inside = u.abs() < radius(z);
                let behind = self.table.filter(|_| y > 0.8 * SIZE[1] as f64);
                let mut color = if inside {
                    self.color
                } else {
                    behind.unwrap_or(self.ground)
                };
                if inside {
                    let round = (1.0 - (u / radius(z)).powi(2)).sqrt();
                    color = color.map(|v| v * (0.7 + 0.3 * round));
                } else if let Some((offset, dark)) = self.shadow {
                    let deep = radius(z + 0.03) - (u - offset).abs();
                    color = color.map(|v| v * (1.0 - dark * (deep / 0.03).clamp(0.0, 1.0)));
                }
                color = more([u, z], inside, color);
                let across = x / SIZE[0] as f64;
                let light = self.light[0] * (1.0 - across) + self.light[1] * across;
                (0..3).for_each(|c| sum[c] += 0.25 * color[c] * light);
            }
            let noise = 2.0 * self.noise * random();
            let [r, g, b] = sum.map(|v| ((v + noise) * 255.0).round() as u8);
            pixels.push([r, g, b, 255]);
        }
        pixels
    }

    pub fn plain(&self) -> Vec<[u8; 4]> {
        self.draw(|_, _, color| color)
    }
}

pub fn photo(rgba: &[[u8; 4]]) -> Photo<'_> {
    Photo {
        width: SIZE[0] as u32,
        height: SIZE[1] as u32,
        rgba,
    }
}
