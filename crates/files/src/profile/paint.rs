//! Colours, and the list of paints that a drawing is.

use crate::pixels::luminance;
use revmap::profile::Region;

/// Premultiplied red, green, blue and alpha, in the drawing's own (sRGB) values.
pub(super) type Rgba = [f32; 4];

/// Returns true for a colour darker than one half over white.
pub(super) fn is_dark(color: Rgba) -> bool {
    let [r, g, b, _] = over_white(color);
    luminance([r, g, b]) < 0.5
}

pub(super) fn over_white(color: Rgba) -> Rgba {
    over(color, [1.0; 4])
}

/// `top` over `below`, both premultiplied (Porter & Duff 1984).
pub(super) fn over(top: Rgba, below: Rgba) -> Rgba {
    std::array::from_fn(|i| top[i] + below[i] * (1.0 - top[3]))
}

/// One step of painting.
#[derive(Debug)]
pub(super) enum Paint {
    /// A region with its darkest colour, and the lightest with its line for a gradient between.
    Region(Region, Rgba, Option<(Rgba, u32)>),
    /// Paints that are laid down by themselves, clipped and then shown with an opacity.
    Group {
        opacity: f32,
        clip: Option<Region>,
        paints: Vec<Paint>,
    },
}

/// The lines of the gradients whose colours differ, each with true if they are dark and light by
/// themselves, and false if only with translucent paint over them.
pub(super) fn gradients(paints: &[Paint]) -> Vec<(u32, bool)> {
    let mut lines: Vec<(u32, bool)> = Vec::new();
    for paint in paints {
        match paint {
            Paint::Region(_, darkest, Some((lightest, line))) => {
                let even = darkest[3] >= 1.0 && lightest[3] >= 1.0;
                let same = even && is_dark(*darkest) == is_dark(*lightest);
                lines.push((*line, !same));
            }
            Paint::Region(..) => {}
            Paint::Group { paints, .. } => lines.append(&mut gradients(paints)),
        }
    }
    lines.dedup();
    lines
}

/// The paints with the lightest colour of the gradients that `chosen` is true for.
pub(super) fn lightened(paints: &[Paint], chosen: &dyn Fn(u32) -> bool) -> Vec<Paint> {
    let lighter = |paint: &Paint| match paint {
        Paint::Region(region, color, lightest) => {
            let lightest = lightest.filter(|(_, line)| chosen(*line));
            let color = lightest.map_or(*color, |(color, _)| color);
            Paint::Region(region.clone(), color, None)
        }
        Paint::Group {
            opacity,
            clip,
            paints,
        } => Paint::Group {
            opacity: *opacity,
            clip: clip.clone(),
            paints: lightened(paints, chosen),
        },
    };
    paints.iter().map(lighter).collect()
}

/// Bounds of the colours of a gradient's stops: the darkest and, if that makes a difference, the
/// lightest. Over every ground, each stop is between the two.
pub(super) fn bounds(stops: &[Rgba]) -> Option<(Rgba, Option<Rgba>)> {
    let count = stops.len() as f32;
    let mean = std::array::from_fn(|k| stops.iter().map(|c| c[k] / count).sum());
    let over_black = |c: &Rgba| luminance([c[0], c[1], c[2]]);
    let over_white = |c: &Rgba| over_black(c) + 1.0 - c[3];
    let least = |value: &dyn Fn(&Rgba) -> f32| stops.iter().map(value).reduce(f32::min);
    let most = |value: &dyn Fn(&Rgba) -> f32| stops.iter().map(value).reduce(f32::max);
    let grey = |black: f32, white: f32| [black, black, black, 1.0 - (white - black)];
    let (low, low_white) = (least(&over_black)?, least(&over_white)?);
    let (high, high_white) = (most(&over_black)?, most(&over_white)?);
    if high - low < 1e-3 && high_white - low_white < 1e-3 {
        return Some((mean, None));
    }
    let opaque = stops.iter().all(|c| c[3] >= 1.0);
    if opaque && (high < 0.5 || low >= 0.5) {
        return Some((mean, Some(grey(high, high_white))));
    }
    Some((grey(low, low_white), Some(grey(high, high_white))))
}
