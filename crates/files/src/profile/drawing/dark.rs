//! The visible result of paint laid over paint.
//!
//! A drawing is a list of paints, each a region and a colour. A tile of the plane is cut at the
//! borders of its paints, the top one first, until a part is dark or light whatever is below. The
//! number of parts grows with the square of the number of translucent borders that cross each other,
//! so that a tile with many borders is split in two until each part has few.

use super::paint::{Paint, color, is_dark, keep_side, top_border};
use super::tile::{Tile, overlap};
use crate::content_fault;
use glam::DVec2;
use revmap::error::Result;
use revmap::profile::{Outline, Region};
use revmap_drawing::luminance;

/// A tile with at most this many changes of colour is laid down at once.
const FEW: usize = 8;
/// Tiles are halved this many times at most.
const MOST_HALVINGS: usize = 24;
/// Halvings without fewer borders, after which a tile is laid down as it is.
const MOST_VAIN: usize = 8;
/// Most borders that cross in one place, such as lines through one point.
const MOST_CROSSING: usize = 400;

/// Most pairs of translucent shapes whose boxes overlap: some seconds.
const MOST_PAIRS: usize = 100_000;

impl Tile {
    fn clipped(self, paints: &[Paint]) -> Vec<Paint> {
        // Of a region or clip that has a part in the tile; that part is `None` if it is all of it.
        let part = |region: &Option<Region>| match region {
            None => Some(None),
            Some(region) => {
                let part = self.part(region)?;
                Some((!self.is_covered_by(&part)).then_some(part))
            }
        };
        let mut parts: Vec<Paint> = Vec::new();
        for paint in paints {
            match paint {
                Paint::Region(region, color, _) => {
                    let Some(part) = part(region) else { continue };
                    if color[3] >= 1.0 && part.is_none() {
                        // Opaque paint hides everything below it.
                        parts.clear();
                    }
                    parts.push(Paint::Region(part, *color, None));
                }
                Paint::Group {
                    opacity,
                    clip,
                    paints,
                } => {
                    let (opacity, paints) = (*opacity, self.clipped(paints));
                    parts.extend(part(clip).filter(|_| !paints.is_empty()).map(|clip| {
                        Paint::Group {
                            opacity,
                            clip,
                            paints,
                        }
                    }));
                }
            }
        }
        merged(&parts)
    }

    /// Bounds of the luminance over white.
    fn lightness(paints: &[Paint]) -> [f32; 2] {
        let [mut least, mut most] = [1.0f32; 2];
        for paint in paints {
            let (low, high) = match paint {
                Paint::Region(region, color, _) => {
                    let [r, g, b, alpha] = *color;
                    let laid = |below: f32| luminance([r, g, b]) + (1.0 - alpha) * below;
                    let (low, high) = (laid(least), laid(most));
                    if region.is_none() {
                        (least, most) = (low, high);
                        continue;
                    }
                    (low, high)
                }
                Paint::Group { opacity, .. } => {
                    let clear = 1.0 - opacity;
                    (clear * least, opacity + clear * most)
                }
            };
            (least, most) = (least.min(low), most.max(high));
        }
        // Rounding must not decide.
        [least - 1e-5, most + 1e-5]
    }

    /// Number of borders.
    fn borders(paints: &[Paint]) -> usize {
        let of = |paint: &Paint| match paint {
            Paint::Region(region, ..) => usize::from(region.is_some()),
            Paint::Group { clip, paints, .. } => {
                Self::borders(paints) + usize::from(clip.is_some())
            }
        };
        paints.iter().map(of).sum()
    }

    /// The dark regions in the tile, which may abut. The second value is true if it was split.
    ///
    /// # Errors
    /// If many borders cross in one place.
    fn dark_parts(
        self,
        paints: &[Paint],
        halvings: usize,
        vain: usize,
    ) -> Result<(Vec<Region>, bool)> {
        let [least, most] = Self::lightness(paints);
        if most < 0.5 {
            return Ok((vec![self.region()], false));
        }
        if least >= 0.5 {
            return Ok((Vec::new(), false));
        }
        let borders = Self::borders(paints);
        let thin = (self.high - self.low).min_element() <= 0.0;
        if borders <= FEW || halvings == 0 || vain >= MOST_VAIN || thin {
            if borders > MOST_CROSSING {
                return Err(content_fault(format!(
                    "the drawing has {borders} borders of translucent or alternating shapes in one place; at most \
                     {MOST_CROSSING} can be resolved, make the shapes opaque"
                )));
            }
            let mut parts = Vec::new();
            self.cut(self.region(), paints.to_vec(), &mut parts);
            return Ok((parts, false));
        }
        let half = |tile: Self| {
            let parts = tile.clipped(paints);
            let vain = match 10 * Self::borders(&parts) > 9 * borders {
                true => vain + 1,
                false => 0,
            };
            let (parts, _) = tile.dark_parts(&parts, halvings - 1, vain)?;
            Ok(parts)
        };
        let [a, b] = self.halves();
        let (a, b) = rayon::join(|| half(a), || half(b));
        let mut parts: Vec<Region> = a?;
        parts.append(&mut b?);
        Ok((parts, true))
    }

    /// Adds the dark parts of a region, which is cut at the borders of the paints.
    fn cut(self, region: Region, paints: Vec<Paint>, dark: &mut Vec<Region>) {
        let [least, most] = Self::lightness(&paints);
        if region.is_empty() || least >= 0.5 {
            return;
        }
        let Some(border) = top_border(&paints).filter(|_| most >= 0.5) else {
            dark.extend((most < 0.5 || is_dark(color(&paints))).then_some(region));
            return;
        };
        let is_beside = !overlap(region.extent(self.grid), border.extent(self.grid));
        for inside in [true, false] {
            let mut own = paints.clone();
            keep_side(&mut own, inside);
            // Nothing is cut for what is light.
            if (is_beside && inside) || Self::lightness(&own)[0] >= 0.5 {
                continue;
            }
            let part = match inside {
                true => region.intersection(border),
                false if is_beside => region.clone(),
                false => region.difference(border),
            };
            self.cut(part, own, dark);
        }
    }

    /// The boxes of shapes that mix with what is below them.
    fn boxes(self, paints: &[Paint], is_clear: bool, found: &mut Vec<[DVec2; 2]>) {
        for paint in paints {
            match paint {
                Paint::Region(Some(region), color, _) if is_clear || color[3] < 1.0 => {
                    found.extend(region.extent(self.grid));
                }
                Paint::Region(..) => {}
                Paint::Group {
                    opacity, paints, ..
                } => self.boxes(paints, is_clear || *opacity < 1.0, found),
            }
        }
    }

    /// # Errors
    /// If many translucent shapes overlap each other.
    fn check_pairs(self, paints: &[Paint]) -> Result<()> {
        let mut boxes = Vec::new();
        self.boxes(paints, false, &mut boxes);
        boxes.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        let (mut pairs, mut tries) = (0, 0);
        for (i, &a) in boxes.iter().enumerate() {
            let near = &boxes[i + 1..];
            let near = &near[..near.partition_point(|b| b[0].x < a[1].x)];
            tries += near.len();
            pairs += near.iter().filter(|b| overlap(Some(a), Some(**b))).count();
            if pairs > MOST_PAIRS || tries > 2000 * MOST_PAIRS {
                return Err(content_fault(format!(
                    "the drawing has {} translucent shapes of which more than {MOST_PAIRS} pairs may overlap; \
                     make them opaque",
                    boxes.len()
                )));
            }
        }
        Ok(())
    }

    /// The dark region of the tile.
    ///
    /// # Errors
    /// If many borders cross in one place, or many translucent shapes overlap.
    pub fn dark(self, paints: &[Paint]) -> Result<Region> {
        self.check_pairs(paints)?;
        let (parts, split) = self.dark_parts(&self.clipped(paints), MOST_HALVINGS, 0)?;
        let merged = Region::merged(parts);
        Ok(match split {
            true => self.without_seams(&merged),
            false => merged,
        })
    }

    /// Removes the points that the borders of tiles left on straight lines.
    fn without_seams(self, region: &Region) -> Region {
        let slack = 4.0 * self.grid.step();
        let Outline { mut loops } = region.outline(self.grid);
        for points in &mut loops {
            let mut kept: Vec<DVec2> = Vec::with_capacity(points.len());
            for (i, &p) in points.iter().enumerate() {
                let (Some(&before), next) = (kept.last(), points[(i + 1) % points.len()]) else {
                    kept.push(p);
                    continue;
                };
                let along = next - before;
                let away = along.perp_dot(p - before).abs();
                let between = along.dot(p - before) >= 0.0 && along.dot(next - p) >= 0.0;
                if !(between && away <= slack * along.length()) {
                    kept.push(p);
                }
            }
            *points = kept;
        }
        Region::enclosed(self.grid, &loops, revmap::profile::FillRule::NonZero)
    }
}

/// Paints of which those of one opaque colour that follow each other are one: merging many shapes at
/// once costs far less than one after the other.
fn merged(paints: &[Paint]) -> Vec<Paint> {
    let opaque = |paint: &Paint| match paint {
        Paint::Region(Some(_), color, _) if color[3] >= 1.0 => Some(*color),
        _ => None,
    };
    let region = |paint: &Paint| match paint {
        Paint::Region(region, ..) => region.clone(),
        Paint::Group { .. } => None,
    };
    let runs = paints.chunk_by(|a, b| opaque(a).is_some() && opaque(a) == opaque(b));
    let joined = runs.flat_map(|run| match opaque(&run[0]).filter(|_| run.len() > 1) {
        Some(color) => {
            let all: Vec<Region> = run.iter().filter_map(region).collect();
            vec![Paint::Region(Some(Region::merged(all)), color, None)]
        }
        None => run.to_vec(),
    });
    joined.collect()
}
