//! Comma-separated values (RFC 4180), as far as results need them: one header, one record a line.

use revmap::error::{Error, Result, Stage};
use std::path::Path;

/// A table of text, read or to be written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Records, each as long as the header.
    pub records: Vec<Vec<String>>,
}

impl Table {
    /// An empty table with these columns.
    #[must_use]
    pub fn new(header: &[&str]) -> Self {
        Self {
            header: header.iter().map(ToString::to_string).collect(),
            records: Vec::new(),
        }
    }

    /// Its text, lines ended by a line feed. Fields with commas, quotes or line breaks are quoted.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = String::new();
        for record in std::iter::once(&self.header).chain(&self.records) {
            for (i, field) in record.iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                if field.contains([',', '"', '\n', '\r']) {
                    out.push('"');
                    out.push_str(&field.replace('"', "\"\""));
                    out.push('"');
                } else {
                    out.push_str(field);
                }
            }
            out.push('\n');
        }
        out
    }

    /// Reads a table.
    ///
    /// # Errors
    /// [`Stage::Report`]: no header, a quote that is not closed, a record of another length than the header.
    pub fn parse(text: &str) -> Result<Self> {
        let fault = |message: String| Error::new(Stage::Report, message);
        // Spreadsheets begin a file with a byte order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = records(text).ok_or_else(|| {
            fault("a quoted field has no end; write the file again with `revmap bench`".into())
        })?;
        if lines.is_empty() {
            return Err(fault("is empty; write it again with `revmap bench`".into()));
        }
        let header = lines.remove(0);
        for (i, record) in lines.iter().enumerate() {
            if record.len() != header.len() {
                return Err(fault(format!(
                    "record {} has {} fields, the header {}; write the file again with `revmap bench`",
                    i + 1,
                    record.len(),
                    header.len()
                )));
            }
        }
        Ok(Self {
            header,
            records: lines,
        })
    }

    /// Reads a table from a file.
    ///
    /// # Errors
    /// As [`Table::parse`], with the file; and when it cannot be read.
    pub fn load(file: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(file).map_err(|e| {
            Error::new(
                Stage::Report,
                format!("cannot be read ({e}); give a folder that `revmap bench` wrote"),
            )
            .in_file(file)
        })?;
        Self::parse(&text).map_err(|e| e.in_file(file))
    }

    /// The place of a column.
    ///
    /// # Errors
    /// [`Stage::Report`] when there is none of this name.
    pub fn column(&self, name: &str) -> Result<usize> {
        self.header.iter().position(|n| n == name).ok_or_else(|| {
            Error::new(
                Stage::Report,
                format!("has no column `{name}`; write it again with `revmap bench`"),
            )
        })
    }
}

/// All records of a text, the header among them; `None` when a quote is left open.
fn records(text: &str) -> Option<Vec<Vec<String>>> {
    let mut all = Vec::new();
    let mut record = Vec::new();
    let mut field = String::new();
    let mut quoted = false;
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                field.push('"');
            }
            '"' if quoted || field.is_empty() => quoted = !quoted,
            ',' if !quoted => record.push(std::mem::take(&mut field)),
            '\r' if !quoted && letters.peek() == Some(&'\n') => {}
            '\n' if !quoted => {
                record.push(std::mem::take(&mut field));
                all.push(std::mem::take(&mut record));
            }
            other => field.push(other),
        }
    }
    if quoted {
        return None;
    }
    if !(field.is_empty() && record.is_empty()) {
        record.push(field);
        all.push(record);
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let mut table = Table::new(&["a", "b,c", "d"]);
        for record in [["1", "", "x y"], ["\"q\"", "l1\nl2", "a,b"], ["", "", ""]] {
            table
                .records
                .push(record.iter().map(ToString::to_string).collect());
        }
        assert_eq!(Table::parse(&table.text()).unwrap(), table);
        let windows = table.text().replace('\n', "\r\n").replace("l1\r\n", "l1\n");
        assert_eq!(Table::parse(&windows).unwrap(), table);
        assert_eq!(Table::parse(&format!("\u{feff}{windows}")).unwrap(), table);
        assert_eq!(table.column("d").unwrap(), 2);
        assert!(table.column("e").is_err());
    }

    #[test]
    fn damaged_tables_are_refused() {
        for (text, wanted) in [
            ("", "is empty"),
            ("a,b\n1\n", "record 1 has 1 fields"),
            ("a,b\n1,2,3\n", "record 1 has 3 fields"),
            ("a,b\n1,\"2\n", "no end"),
        ] {
            let error = Table::parse(text).unwrap_err();
            assert!(error.to_string().contains(wanted), "{error}");
        }
        // The last line may lack its end.
        assert_eq!(
            Table::parse("a,b\n1,2").unwrap().records,
            [["1".to_owned(), "2".to_owned()]]
        );
    }
}
