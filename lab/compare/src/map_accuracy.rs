//! Errors of a map against a disc whose exact distances are known.

use glam::DVec2;
use revmap::error::Result;
use revmap::maps::{BakeOptions, MapFormat, MapSource, ShapeMap};
use revmap::profile::Profile;
use revmap_files::BINARY;

/// Errors of a shape map against exact distances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapErrors {
    /// Mean of stored minus true distance, texels.
    pub mean: f64,
    /// Root mean square of that difference, texels.
    pub rms: f64,
    /// Largest magnitude of that difference, texels.
    pub max: f64,
    /// Angle between the true gradient and the derivative of the bilinear cell, which the shaders
    /// use. Root mean square over points within one texel of the surface, degrees.
    pub gradient_rms: f64,
    /// The largest such angle, degrees.
    pub gradient_max: f64,
    /// Root mean square of that angle for the gradient channels of the papers' 8-bit texture,
    /// filtered bilinearly, degrees.
    pub stored_gradient_rms: f64,
    /// The largest such angle, degrees.
    pub stored_gradient_max: f64,
}

/// A disc that is not aligned with any symmetry of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre `(r, z)`, object units.
    pub center: DVec2,
    /// Radius, object units.
    pub radius: f64,
}

impl Default for Disc {
    fn default() -> Self {
        Self {
            center: DVec2::new(0.503_1, 0.497_7),
            radius: 0.371_3,
        }
    }
}

impl Disc {
    /// The disc as a polygon of `corners` corners and of the same area, in a box of radius 1.
    pub fn polygon(&self, corners: u32) -> Result<Profile> {
        let step = std::f64::consts::TAU / f64::from(corners);
        let radius = self.radius * (step / step.sin()).sqrt();
        let points: Vec<[f64; 2]> = (0..corners)
            .map(|k| (self.center + DVec2::from_angle(step * f64::from(k)) * radius).to_array())
            .collect();
        Profile::polygon(&points, 1.0)
    }

    /// Signed distance of a point, object units.
    pub fn distance(&self, p: DVec2) -> f64 {
        p.distance(self.center) - self.radius
    }

    /// Bakes the disc from a source and measures the map's errors.
    pub fn errors(&self, source: MapSource, rows: u32) -> Result<MapErrors> {
        let map = ShapeMap::bake(&self.polygon(1 << 16)?, &BakeOptions::new(source, rows))?;
        self.measure(&map)
    }

    /// Errors of a map of this disc. A binary map is measured outside only: the papers store no
    /// distances inside.
    pub fn measure(&self, map: &ShapeMap) -> Result<MapErrors> {
        let side = f64::from(map.rows);
        let mut distance = Vec::new();
        for (k, &stored) in map.distance.iter().enumerate() {
            let (i, j) = (k % map.columns as usize, k / map.columns as usize);
            let p = DVec2::new(i as f64 + 0.5, side - (j as f64 + 0.5)) / side;
            if map.source != BINARY || !map.form[k] {
                distance.push((f64::from(stored) - self.distance(p)) * side);
            }
        }
        let stored = map.encode(MapFormat::Rgba8)?.bytes;
        let (mut cell, mut channels) = (Vec::new(), Vec::new());
        const AROUND: u32 = 20_000;
        for k in 0..AROUND {
            // A spiral covers every direction and every depth within a texel of the surface.
            let along = DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(AROUND));
            let depth = (f64::from(k) * 0.618_033_988_749_895).fract() * 2.0 - 1.0;
            let p = self.center + along * (self.radius + depth / side);
            cell.push(angle(DVec2::from(map.gradient_at(p.x, p.y)), along));
            channels.push(angle(filtered_channels(map, &stored, p), along));
        }
        let [mean, rms, max] = summary(&distance);
        let [_, gradient_rms, gradient_max] = summary(&cell);
        let [_, stored_gradient_rms, stored_gradient_max] = summary(&channels);
        Ok(MapErrors {
            mean,
            rms,
            max,
            gradient_rms,
            gradient_max,
            stored_gradient_rms,
            stored_gradient_max,
        })
    }
}

/// Channels R and G of the papers' texture, filtered bilinearly as a sampler does.
fn filtered_channels(map: &ShapeMap, texels: &[u8], p: DVec2) -> DVec2 {
    let side = f64::from(map.rows);
    let (u, v) = (p.x * side - 0.5, (1.0 - p.y) * side - 0.5);
    let mut sum = DVec2::ZERO;
    for (i, j) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let (x, y) = (u.floor() + i, v.floor() + j);
        let weight = (1.0 - (u - x).abs()) * (1.0 - (v - y).abs());
        let x = x.clamp(0.0, f64::from(map.columns - 1)) as usize;
        let y = y.clamp(0.0, f64::from(map.rows - 1)) as usize;
        let texel = &texels[(y * map.columns as usize + x) * 4..];
        let unpack = |b: u8| f64::from(b) / 255.0 * 2.0 - 1.0;
        sum += weight * DVec2::new(unpack(texel[0]), unpack(texel[1]));
    }
    sum
}

/// Angle between two directions, degrees.
fn angle(a: DVec2, b: DVec2) -> f64 {
    a.perp_dot(b).atan2(a.dot(b)).abs().to_degrees()
}

/// Mean, root mean square, and largest magnitude.
fn summary(values: &[f64]) -> [f64; 3] {
    let count = values.len().max(1) as f64;
    let mean = |value: fn(&f64) -> f64| values.iter().map(value).sum::<f64>() / count;
    let most = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    [mean(|v| *v), mean(|v| v * v).sqrt(), most]
}
