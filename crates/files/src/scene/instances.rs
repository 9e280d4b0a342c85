//! Placements of copies from a CSV file: one row `x,y,z,qx,qy,qz,qw,sx,sy,sz` for each, or columns in
//! the order of a heading.

use crate::{content_fault, file_fault, read_bytes};
use glam::{DQuat, DVec3};
use revmap::error::Result;
use revmap::host_memory;
use revmap::scene::Placement;
use revmap_drawing::decoded;
use std::path::Path;

/// Count of numbers in a row.
const COLUMNS: usize = 10;
/// The columns' names, in the order of a file without a heading.
const NAMES: [&str; COLUMNS] = ["x", "y", "z", "qx", "qy", "qz", "qw", "sx", "sy", "sz"];
/// The columns in words.
const ALL: &str = "x,y,z,qx,qy,qz,qw,sx,sy,sz";
/// More copies than this are treated as a mistake: their transforms would use hundreds of
/// megabytes.
const MAX_COPIES: usize = 1 << 20;

/// Reads placements. Empty lines and lines that begin with `#` are skipped. A first line that is no
/// row of numbers is a heading: its names say which column is which. A comment before the first row
/// is a heading too if it lists names of columns ([`listed`]). Text behind a `#` in a row is a
/// comment. Rotations are normalised to unit length. A byte order mark, as
/// spreadsheets write it, is skipped.
pub(super) fn load(file: &Path) -> Result<Vec<Placement>> {
    let bytes = read_bytes(file)
        .map_err(|e| file_fault(format!("cannot be read ({e}); give a CSV file")).in_file(file))?;
    let no_text = || file_fault("is no text in UTF-8; save it as CSV in UTF-8");
    decoded(&bytes)
        .ok_or_else(no_text)
        .and_then(|text| parse(&text))
        .map_err(|e| e.in_file(file))
}

fn parse(text: &str) -> Result<Vec<Placement>> {
    let mut copies = Vec::new();
    let mut order: Option<[usize; COLUMNS]> = None;
    for (number, line) in lines(text).enumerate() {
        let line = line.trim();
        let at_line = |mut e: revmap::error::Error| {
            let column = e.key.take().map_or(String::new(), |key| format!(", {key}"));
            e.at_key(format!("line {}{column}", number + 1))
        };
        let may_be_heading = copies.is_empty() && order.is_none();
        if let Some(comment) = line.strip_prefix('#') {
            if let Some(names) = listed(comment).filter(|_| may_be_heading) {
                order = Some(heading(&names).map_err(at_line)?);
            }
            continue;
        }
        let line = line.split('#').next().unwrap_or(line).trim_end();
        if line.is_empty() {
            continue;
        }
        if line.contains(';') || !line.contains(',') {
            let message = format!(
                "holds no values with commas between them; write points in numbers, and {ALL}"
            );
            return Err(at_line(content_fault(message)));
        }
        if may_be_heading && is_heading(line) {
            let names: Vec<_> = fields(line).collect();
            order = Some(heading(&names).map_err(at_line)?);
            continue;
        }
        let read = row(line, order.as_ref()).and_then(|copy| copy.check().map(|()| copy));
        let read = read.map_err(at_line)?;
        host_memory::push(&mut copies, read, "the copies of an object")?;
        if copies.len() > MAX_COPIES {
            return Err(content_fault(format!(
                "holds more than {MAX_COPIES} copies, the most of one object; give the rest to another [[object]]"
            )));
        }
    }
    if copies.is_empty() {
        return Err(content_fault(format!(
            "holds no copies; give rows of {ALL}"
        )));
    }
    Ok(copies)
}

/// The lines of a text that ends them by LF, CR LF or CR.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let lines = text.split('\n');
    lines.flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

/// The words of a comment from its first name of a column to its last, if it lists columns: it holds
/// names alone, or four or more different ones.
fn listed(comment: &str) -> Option<Vec<&str>> {
    let words = comment.split(|c: char| !c.is_alphanumeric() && c != '_');
    let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
    let first = words.iter().position(|word| is_name(word))?;
    let last = words.iter().rposition(|word| is_name(word))?;
    let held = |name: &&&str| words.iter().any(|word| name.eq_ignore_ascii_case(word));
    let (count, alone) = (
        NAMES.iter().filter(held).count(),
        words.iter().all(|w| is_name(w)),
    );
    (count >= 4 || alone && count > 1).then(|| words[first..=last].to_vec())
}

fn is_name(word: &str) -> bool {
    NAMES.iter().any(|name| name.eq_ignore_ascii_case(word))
}

/// The fields of a line, without the quotes that some programs put about names.
fn fields(line: &str) -> impl Iterator<Item = &str> {
    fn bare(field: &str) -> &str {
        let field = field.trim();
        let inner = field.strip_prefix('"').and_then(|f| f.strip_suffix('"'));
        inner.unwrap_or(field).trim()
    }
    line.split(',').map(bare)
}

/// Returns true for a line with the name of a column, or of words alone.
fn is_heading(line: &str) -> bool {
    let is_word = |field: &str| field.parse::<f64>().is_err();
    fields(line).all(is_word) || fields(line).any(is_name)
}

/// The column of each of [`NAMES`].
fn heading(fields: &[&str]) -> Result<[usize; COLUMNS]> {
    let found = |name: &str| fields.iter().position(|f| f.eq_ignore_ascii_case(name));
    let columns: Vec<usize> = NAMES.iter().filter_map(|name| found(name)).collect();
    let missing = || {
        let names = NAMES.iter().filter(|name| found(name).is_none());
        names.copied().collect::<Vec<_>>().join(", ")
    };
    let mut numbered = fields.iter().enumerate();
    let stranger = numbered.find(|(column, _)| !columns.contains(column));
    match (columns.as_slice().try_into(), stranger) {
        (Ok(columns), None) => Ok(columns),
        (_, Some((_, field))) => Err(content_fault(format!(
            "the heading has a column {field:?} that is not known or stands there twice; the columns are {ALL}"
        ))),
        (Err(_), None) => Err(content_fault(format!(
            "the heading lacks {}; the columns are {ALL}",
            missing()
        ))),
    }
}

/// A row, whose columns have the usual order or the one given.
fn row(line: &str, order: Option<&[usize; COLUMNS]>) -> Result<Placement> {
    let wrong_count =
        |count: String, remedy: &str| content_fault(format!("has {count}{remedy}: {ALL}"));
    let mut read = [0.0; COLUMNS];
    for (slot, field) in read.iter_mut().zip(fields(line)) {
        let number = field.parse();
        *slot = number.map_err(|_| content_fault(format!("{field:?} is not a number")))?;
    }
    match fields(line).count() {
        COLUMNS => {}
        n @ ..COLUMNS => return Err(wrong_count(format!("{n} values"), "; give 10")),
        _ => return Err(wrong_count(format!("more than {COLUMNS} values"), "")),
    }
    let [x, y, z, qx, qy, qz, qw, sx, sy, sz] = match order {
        Some(order) => order.map(|column| read[column]),
        None => read,
    };
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
    fn a_heading_names_the_columns() {
        let first = |text: &str| parse(text).unwrap()[0];
        let wanted = first("1,2,3,0.1,0.2,0.3,0.9,4,5,6");
        assert_eq!(wanted.position, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(wanted.scale, DVec3::new(4.0, 5.0, 6.0));
        assert!((wanted.rotation.length() - 1.0).abs() < 1e-15 && wanted.rotation.w > 0.9);
        for text in [
            "x,y,z,qw,qx,qy,qz,sx,sy,sz\n1,2,3,0.9,0.1,0.2,0.3,4,5,6",
            "qw,qx,qy,qz,X,Z,Y,SX,SY,SZ\n0.9,0.1,0.2,0.3,1,3,2,4,5,6",
            "# a comment\n\n\"sz\", \"sy\",sx,qw,qz,qy,qx,z,y,x\n6,5,4,0.9,0.3,0.2,0.1,3,2,1",
            "# z,y,x,qx,qy,qz,qw,sx,sy,sz\n3,2,1,0.1,0.2,0.3,0.9,4,5,6",
            "# x,y,z of the copies\n1,2,3,0.1,0.2,0.3,0.9,4,5,6",
            "#x y z qw qx qy qz sx sy sz\n1,2,3,0.9,0.1,0.2,0.3,4,5,6",
            "# columns: x,y,z,qw,qx,qy,qz,sx,sy,sz\n1,2,3,0.9,0.1,0.2,0.3,4,5,6",
            "## a row is x,y,z,qw,qx,qy,qz,sx,sy,sz of a copy\n1,2,3,0.9,0.1,0.2,0.3,4,5,6",
            "x,y,z,qw,qx,qy,qz,sx,sy,sz\r1,2,3,0.9,0.1,0.2,0.3,4,5,6\r",
            "1,2,3,0.1,0.2,0.3,0.9,4,5,6 # the first",
        ] {
            assert_eq!(first(text), wanted, "{text}");
        }
    }

    #[test]
    fn byte_order_marks_are_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        for heading in ["", "x,y,z,qx,qy,qz,qw,sx,sy,sz\r\n"] {
            let text = format!("\u{feff}{heading}1,2,3,0,0,0,1,1,1,1\r\n");
            let wide = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            for bytes in [text.into_bytes(), wide] {
                std::fs::write(&file, bytes).unwrap();
                assert_eq!(load(&file).unwrap().len(), 1);
            }
        }
        std::fs::write(&file, [0xff, 0xff]).unwrap();
        assert!(load(&file).unwrap_err().to_string().contains("UTF-8"));
    }

    /// Texts, their lines parted by `/`, and words of their refusal.
    const FAULTS: &str = r#"
 => holds no copies
1,2,3 => line 1: has 3 values
/1,2,3,0,0,0,1,1,1,one => line 2: "one" is not a number
1,2,3,0,0,0,1,1,1,1,1 => line 1: has more than 10
1,2,3,0,0,0,0,1,1,1 => line 1: the rotation
1,2,3,0,nan,0,1,1,1,1 => line 1: the rotation
/1,2,3,0,0,0,1,1,0,1 => line 2, scale: has 0
inf,2,3,0,0,0,1,1,1,1 => line 1, position: has inf
x,y,z,qx,qy,qz,qw,sx,sy/ => line 1: the heading lacks sz
x,y,z/ => lacks qx, qy, qz, qw, sx, sy, sz
x,y,z,qx,qy,qz,w,sx,sy,sz => a column "w"
tx,ty,tz,qx,qy,qz,qw,sx,sy,sz => a column "tx"
,x,y,z,qx,qy,qz,qw,sx,sy,sz => a column ""
x,x,y,z,qx,qy,qz,qw,sx,sy,sz => a column "x"
id,pos_x/1,2 => a column "id"
#x,y,z,w,qx,qy,qz,sx,sy,sz => line 1: the heading has a column "w"
#x,y,z,qw,qx,qy,qz => line 1: the heading lacks sx, sy, sz
# qw,qx => line 1: the heading lacks x, y, z
x;y;z;qx/ => line 1: holds no values with commas
0,5;1;0;0;0;0;1;1;1;1 => write points in numbers
1 2 3 0 0 0 1 1 1 1 => line 1: holds no values with commas"#;

    #[test]
    fn faults_name_the_line() {
        for (text, wanted) in FAULTS.lines().filter_map(|line| line.split_once(" => ")) {
            let message = parse(&text.replace('/', "\n")).unwrap_err().to_string();
            assert!(message.contains(wanted), "{message}");
        }
    }
}
