//! Colours, and the list of paints that a drawing is.

use revmap::profile::Region;
pub(super) use revmap_drawing::Rgba;
use revmap_drawing::luminance;

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
