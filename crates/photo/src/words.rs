//! Readings in words.

use crate::{Doubt, End, Fault, Ground, Half, LeftOut, Reading, Tone};
use std::fmt::{Display, Formatter, Result};

impl Display for Reading {
    /// One sentence: what was taken.
    fn fmt(&self, f: &mut Formatter) -> Result {
        let tone = match self.tone {
            Tone::Darker => "dark on a lighter ground",
            Tone::Lighter => "light on a darker ground",
            Tone::Both => "in part darker, in part lighter than the ground",
            Tone::Hue => "told from the ground by its hue",
        };
        let ground = match self.ground {
            Ground::Rows => "taken row by row from both sides",
            Ground::Smooth => "fitted to all borders",
            Ground::OneSide => "taken from one side",
            Ground::Transparent => "",
        };
        match self.ground {
            Ground::Transparent => f.write_str("read as a photograph: the opaque part")?,
            _ => write!(f, "read as a photograph: {tone}, which is {ground}")?,
        }
        write!(f, "; axis at {:.2} of the width", self.axis)?;
        if self.tilt.abs() >= 0.3 {
            let way = if self.tilt > 0.0 { "right" } else { "left" };
            write!(
                f,
                "; turned upright from a tilt of {:.1} degrees to the {way}",
                self.tilt.abs()
            )?;
        }
        let parts: Vec<String> = self.left_out.iter().map(ToString::to_string).collect();
        if !parts.is_empty() {
            write!(f, "; left out: {}", parts.join(", "))?;
        }
        let half = match self.half {
            Half::Both => "",
            Half::Left => "left",
            Half::Right => "right",
        };
        match (self.half, self.cut) {
            (Half::Both, _) => {}
            (_, true) => write!(
                f,
                "; the {half} half is used, since the edge of the picture cuts the other one"
            )?,
            (_, false) => write!(
                f,
                "; the halves differ by {:.0} %, and the lesser one, mostly the {half} one, is used",
                100.0 * self.differ
            )?,
        }
        if let Some(elevation) = self.elevation {
            write!(
                f,
                "; seen from {elevation:.0} degrees above, foot and rim are cut at the middles of their ellipses"
            )?;
        }
        Ok(())
    }
}

impl Display for LeftOut {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Frame => f.write_str("the frame"),
            Self::Shadow => f.write_str("the shadow"),
            Self::OneSide => f.write_str("a part on one side, as a handle is"),
            Self::Things(1) => f.write_str("another thing"),
            Self::Things(count) => write!(f, "{count} other things"),
        }
    }
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Faint(part) => write!(
                f,
                "the edge is faint along {:.0} % of the outline: thing and ground have too little contrast; take the photograph before another ground",
                100.0 * part
            ),
            Self::Part => f.write_str(
                "the thing may go on above or below the outline, where the ground is nearly alike, as at a table's edge; look at it with --show-outline, and take the photograph before another ground",
            ),
            Self::Cut(end) => {
                let end = match end {
                    End::Upper => "upper",
                    End::Lower => "lower",
                };
                write!(
                    f,
                    "the {end} edge of the picture cuts the thing, and the solid ends there; look at it with --show-outline"
                )
            }
            Self::Shadow => f.write_str(
                "the outline may hold a shadow; look at it with --show-outline, and move the thing away from the wall",
            ),
            Self::Uneven(part) => write!(
                f,
                "the halves of the thing differ by {:.0} % of its width; only things that were turned are alike on both sides",
                100.0 * part
            ),
        }
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut Formatter) -> Result {
        f.write_str(match self {
            Self::Nothing => "no thing is found in the photograph: nothing stands out from the ground; give more contrast, or set profile_read = \"threshold\"",
            Self::NoSymmetry => "the thing in the photograph has no axis of symmetry: nothing is alike on both sides of one; photograph a turned thing from the side, or set profile_read = \"threshold\"",
        })
    }
}
