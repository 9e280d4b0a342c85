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

/// One step of painting. A region or a clip that is `None` is everything.
#[derive(Clone, Debug)]
pub(super) enum Paint {
    /// A region with its darkest colour, and the lightest with its line for a gradient between.
    Region(Option<Region>, Rgba, Option<(Rgba, u32)>),
    /// Paints that are laid down by themselves, clipped and then shown with an opacity.
    Group {
        opacity: f32,
        clip: Option<Region>,
        paints: Vec<Paint>,
    },
}

/// The colour of paints without borders, the lowest first.
pub(super) fn color(paints: &[Paint]) -> Rgba {
    paints.iter().fold([0.0; 4], |below, paint| match paint {
        Paint::Region(_, own, _) => over(*own, below),
        Paint::Group {
            opacity, paints, ..
        } => over(color(paints).map(|v| v * opacity), below),
    })
}

/// The border that is painted last: that of a region or of a clip.
pub(super) fn top_border(paints: &[Paint]) -> Option<&Region> {
    paints.iter().rev().find_map(|paint| match paint {
        Paint::Region(region, ..) => region.as_ref(),
        Paint::Group { clip, paints, .. } => clip.as_ref().or_else(|| top_border(paints)),
    })
}

/// Keeps what paints are on one side of their [`top_border`]. Returns false if they have none.
pub(super) fn keep_side(paints: &mut Vec<Paint>, inside: bool) -> bool {
    for k in (0..paints.len()).rev() {
        let (border, hides) = match &mut paints[k] {
            Paint::Region(region, color, _) => (region, color[3] >= 1.0),
            Paint::Group { clip, paints, .. } => match clip {
                None if keep_side(paints, inside) => return true,
                clip => (clip, false),
            },
        };
        match (border.take().is_some(), inside) {
            (false, _) => continue,
            // Opaque paint hides everything below it.
            (true, true) if hides => drop(paints.drain(..k)),
            (true, true) => {}
            (true, false) => drop(paints.remove(k)),
        }
        return true;
    }
    false
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
