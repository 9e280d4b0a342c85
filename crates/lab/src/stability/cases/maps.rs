//! Maps: rows, bits, sources, budgets; and the pictures that cover solids.

use super::{MIDDLE, SPINDLE, ball, case, eye};
use crate::stability::case::{Case, Known, Step, Text};
use revmap::maps::MapFormat;
use revmap_files::Picture;

pub(super) fn cases() -> Vec<Case> {
    vec![budgets(), rows(), bits(), binary(), projections()]
}

/// A picture whose colour changes slowly and without a jump, but differs from place to place: a
/// texel more or less does not show, a coarser level does.
pub(super) fn waves() -> Picture {
    let (width, height) = (128u32, 64u32);
    let wave = |place: u32, all: u32, turns: f64| {
        let angle = std::f64::consts::TAU * turns * (f64::from(place) + 0.5) / f64::from(all);
        (160.0 + 90.0 * angle.sin()) as u8
    };
    let pixel = |k: u32| {
        let (x, y) = (k % width, k / width);
        [
            wave(x, width, 1.0),
            wave(y, height, 0.5),
            wave(x, width, 2.0),
            255,
        ]
    };
    Picture {
        width,
        height,
        rgba: (0..width * height).map(pixel).collect(),
    }
}

fn spindle() -> String {
    Text::seen(eye(15.0, 1.9), MIDDLE)
        .solid(&SPINDLE, "")
        .done()
}

fn budgets() -> Case {
    Case {
        steps: [1u32, 2, 5, 10, 20, 100, 1000]
            .into_iter()
            .map(|n| Step {
                max_steps: Some(n),
                ..Step::new(f64::from(n), spindle())
            })
            .collect(),
        ..case(
            "budget",
            "steps that a search may take",
            "A search that runs out of steps is neither at a hit nor past the solid.",
            "A search without steps has no budget.",
        )
    }
}

fn rows() -> Case {
    Case {
        steps: [2u32, 8, 32, 128, 512, 2048]
            .into_iter()
            .map(|n| Step {
                map_rows: Some(n),
                ..Step::new(f64::from(n), spindle())
            })
            .collect(),
        ..case(
            "map-rows",
            "rows of the shape map",
            "A map resolves its texel: edges are rounded and features below it are lost.",
            "The boundary itself is solved: no map.",
        )
    }
}

fn bits() -> Case {
    let formats = [
        (8.0, MapFormat::Rgba8),
        (16.0, MapFormat::R16),
        (32.0, MapFormat::R32),
    ];
    Case {
        steps: formats
            .into_iter()
            .map(|(bits, map_format)| Step {
                map_format,
                ..Step::new(bits, spindle())
            })
            .collect(),
        ..case(
            "map-bits",
            "bits of a stored distance",
            "A distance in 8 bits is a 255th of the largest: near the surface most of them are zero.",
            "As for map-rows.",
        )
    }
}

fn binary() -> Case {
    Case {
        steps: super::shapes::PICTURE_ROWS
            .into_iter()
            .map(|rows| {
                let keys = format!("profile = \"ball-{rows}.png\"\nprofile_axis = \"left\"");
                Step {
                    map_source: Some(revmap_files::BINARY),
                    ..Step::new(
                        f64::from(rows),
                        Text::seen(eye(15.0, 1.9), MIDDLE).object(&keys).done(),
                    )
                }
            })
            .collect(),
        ..case(
            "binary-picture",
            "rows of a picture without grey; maps from its pixels",
            "Distances to the nearest solid pixel are off by up to a texel, and their gradients by up to 45 degrees.",
            "The picture is traced to a smooth outline, which is solved.",
        )
    }
}

fn projections() -> Case {
    let names = ["planar", "cylindrical", "spherical", "arc"];
    Case {
        steps: names
            .into_iter()
            .zip([0.0, 1.0, 2.0, 3.0])
            .map(|(name, n)| {
                let keys =
                    format!("color_map = \"waves.png\"\nprojection = \"{name}\"\nspecular = 0.0");
                // The seam is at azimuth 180 degrees, a pole above.
                let text = Text::seen([-1.2, 0.1, 1.6], MIDDLE).solid(&ball(0.4), &keys);
                Step::new(n, text.done()).sized(320, 240)
            })
            .collect(),
        known: vec![Known {
            stage: None,
            values: [2.0, 3.0],
            reason: "within three pixels of a pole all of the map's columns meet in a pixel: the device takes their mean, the reference one of them",
        }],
        ..case(
            "seam-and-poles",
            "projection of a colour map: 0 planar, 1 cylindrical, 2 spherical, 3 along the profile",
            "The azimuth jumps at the seam and has no derivative at a pole: a sampler takes its coarsest level there, a line of wrong \
             colour.",
            "Derivatives come from formulas, not from neighbouring pixels.",
        )
    }
}
