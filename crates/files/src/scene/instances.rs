//! Placements of copies from a CSV file: one row `x,y,z,qx,qy,qz,qw,sx,sy,sz` for each.

use crate::{content_fault, file_fault};
use glam::{DQuat, DVec3};
use revmap::error::Result;
use revmap::scene::Placement;
use std::path::Path;

/// Count of numbers in a row.
const COLUMNS: usize = 10;
/// More copies than this are treated as a mistake: their transforms would use hundreds of
/// megabytes.
const MAX_COPIES: usize = 1 << 20;

/// Reads placements. Empty lines, lines that begin with `#` and a heading line that begins with `x`
/// are skipped. Rotations are normalised to unit length. A byte order mark, as spreadsheets write
/// it, is skipped.
pub(super) fn load(file: &Path) -> Result<Vec<Placement>> {
    let text = std::fs::read_to_string(file)
        .map_err(|e| file_fault(format!("cannot be read ({e}); give a CSV file")).in_file(file))?;
    parse(&text).map_err(|e| e.in_file(file))
}

fn parse(text: &str) -> Result<Vec<Placement>> {
    let mut copies = Vec::new();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        let heading = copies.is_empty() && line.starts_with('x');
        if line.is_empty() || line.starts_with('#') || heading {
            continue;
        }
        let read = row(line).and_then(|copy| copy.check().map(|()| copy));
        copies.push(read.map_err(|mut e| {
            let column = e.key.take().map_or(String::new(), |key| format!(", {key}"));
            e.at_key(format!("line {}{column}", number + 1))
        })?);
        if copies.len() > MAX_COPIES {
            return Err(content_fault(format!(
                "holds more than {MAX_COPIES} copies, the most of one object; give the rest to another [[object]]"
            )));
        }
    }
    if copies.is_empty() {
        return Err(content_fault(
            "holds no copies; give rows of x,y,z,qx,qy,qz,qw,sx,sy,sz",
        ));
    }
    Ok(copies)
}

fn row(line: &str) -> Result<Placement> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let wrong_count = |count: String, remedy: &str| {
        content_fault(format!("has {count}{remedy}: x,y,z,qx,qy,qz,qw,sx,sy,sz"))
    };
    let mut values = [0.0; COLUMNS];
    for (slot, field) in values.iter_mut().zip(&fields) {
        let number = field.parse();
        *slot = number.map_err(|_| content_fault(format!("{field:?} is not a number")))?;
    }
    match fields.len() {
        COLUMNS => {}
        n @ ..COLUMNS => return Err(wrong_count(format!("{n} values"), "; give 10")),
        _ => return Err(wrong_count(format!("more than {COLUMNS} values"), "")),
    }
    let [x, y, z, qx, qy, qz, qw, sx, sy, sz] = values;
    Ok(Placement {
        position: DVec3::new(x, y, z),
        rotation: unit([qx, qy, qz, qw])?,
        scale: DVec3::new(sx, sy, sz),
    })
}

/// A quaternion normalised to unit length.
pub(super) fn unit(xyzw: [f64; 4]) -> Result<DQuat> {
    let rotation = DQuat::from_array(xyzw);
    let length = rotation.length();
    if length > 0.0 && length.is_finite() {
        Ok(rotation / length)
    } else {
        Err(content_fault(format!(
            "the rotation {xyzw:?} is no quaternion; [0, 0, 0, 1] is upright"
        )))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn rows_become_placements() {
        let copies =
            parse("x,y,z,qx,qy,qz,qw,sx,sy,sz\n# first\n1,2,3,0,0,0,2,1,1,1\n\n-1, 0, 0, 0,0,1,0, 2,3,4\n").unwrap();
        assert_eq!(copies.len(), 2);
        assert_eq!(copies[0].position, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(copies[0].rotation, DQuat::IDENTITY);
        assert_eq!(copies[1].rotation.to_array(), [0.0, 0.0, 1.0, 0.0]);
        assert_eq!(copies[1].scale, DVec3::new(2.0, 3.0, 4.0));
    }

    #[test]
    fn a_byte_order_mark_is_passed_over() {
        for heading in ["", "x,y,z,qx,qy,qz,qw,sx,sy,sz\r\n"] {
            let text = format!("\u{feff}{heading}1,2,3,0,0,0,1,1,1,1\r\n");
            assert_eq!(parse(&text).unwrap().len(), 1);
        }
    }

    #[test]
    fn faults_name_the_line() {
        for (text, wanted) in [
            ("", "holds no copies"),
            ("1,2,3", "line 1: has 3 values"),
            ("\n1,2,3,0,0,0,1,1,1,one", "line 2: \"one\" is not a number"),
            ("1,2,3,0,0,0,1,1,1,1,1", "line 1: has more than 10"),
            ("1,2,3,0,0,0,0,1,1,1", "line 1: the rotation"),
            ("1,2,3,0,nan,0,1,1,1,1", "line 1: the rotation"),
            ("\n1,2,3,0,0,0,1,1,0,1", "line 2, scale: has 0"),
            ("inf,2,3,0,0,0,1,1,1,1", "line 1, position: has inf"),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(message.contains(wanted), "{message}");
        }
    }
}
