//! The visible result of paint laid over paint.
//!
//! A drawing is a list of paints, each a region and a colour. Within one tile of the plane, the
//! list is laid down as a layer of disjoint cells, each of one colour. The number of cells grows
//! with the square of the number of translucent borders that cross each other, so that a tile with
//! many borders is split in two until each part has few.

use super::layer::Layer;
use super::paint::{Paint, is_dark};
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
        let mut parts = Vec::new();
        for paint in paints {
            match paint {
                Paint::Region(region, color, _) => {
                    let Some(part) = self.part(region) else {
                        continue;
                    };
                    if color[3] >= 1.0 && self.is_covered_by(&part) {
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
                    let clip = match clip {
                        None => None,
                        Some(clip) => match self.part(clip) {
                            None => continue,
                            Some(part) if self.is_covered_by(&part) => None,
                            part => part,
                        },
                    };
                    let paints = self.clipped(paints);
                    if !paints.is_empty() {
                        parts.push(Paint::Group {
                            opacity: *opacity,
                            clip,
                            paints,
                        });
                    }
                }
            }
        }
        parts
    }

    /// Bounds of the luminance over white in the tile.
    fn lightness(self, paints: &[Paint]) -> [f32; 2] {
        let [mut least, mut most] = [1.0f32; 2];
        for paint in paints {
            let (low, high) = match paint {
                Paint::Region(region, color, _) => {
                    let [r, g, b, alpha] = *color;
                    let laid = |below: f32| luminance([r, g, b]) + (1.0 - alpha) * below;
                    let (low, high) = (laid(least), laid(most));
                    if self.is_covered_by(region) {
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

    /// Number of borders in the tile at which the colour changes.
    fn borders(self, paints: &[Paint]) -> usize {
        let mut last = None;
        let mut count = 0;
        for paint in paints {
            match paint {
                Paint::Region(region, color, _) => {
                    let merged = color[3] >= 1.0 && last == Some(*color);
                    count += usize::from(!merged && !self.is_covered_by(region));
                    last = Some(*color);
                }
                Paint::Group { clip, paints, .. } => {
                    count += self.borders(paints) + usize::from(clip.is_some());
                    last = None;
                }
            }
        }
        count
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
        let [least, most] = self.lightness(paints);
        if most < 0.5 {
            return Ok((vec![self.region()], false));
        }
        if least >= 0.5 {
            return Ok((Vec::new(), false));
        }
        let borders = self.borders(paints);
        let thin = (self.high - self.low).min_element() <= 0.0;
        if borders <= FEW || halvings == 0 || vain >= MOST_VAIN || thin {
            if borders > MOST_CROSSING {
                return Err(content_fault(format!(
                    "the drawing has {borders} borders of translucent or alternating shapes in one place; at most \
                     {MOST_CROSSING} can be resolved, make the shapes opaque"
                )));
            }
            let mut layer = Layer::new(self);
            layer.lay(paints);
            let cells = layer.into_cells().into_iter();
            let dark = cells.filter(|(color, _)| is_dark(*color));
            return Ok((dark.map(|(_, region)| region).collect(), false));
        }
        let half = |tile: Self| {
            let parts = tile.clipped(paints);
            let vain = match 10 * tile.borders(&parts) > 9 * borders {
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

    /// The boxes of shapes that mix with what is below them.
    fn boxes(self, paints: &[Paint], is_clear: bool, found: &mut Vec<[DVec2; 2]>) {
        for paint in paints {
            match paint {
                Paint::Region(region, color, _) if is_clear || color[3] < 1.0 => {
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
