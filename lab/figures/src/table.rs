//! The table of all outputs: of files, of standard output and of pages.

use crate::names::wrapped;
use revmap::error::{Error, ErrorKind, Result};
use std::path::Path;

/// A table of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Records, each as long as the header.
    pub records: Vec<Vec<String>>,
}

/// The text of a cell without a value, in tables that are read by people.
pub const NO_VALUE: &str = "–";

/// The space between columns.
const GAP: usize = 2;

/// A column's name, and its text for what a record is of.
pub type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

impl Table {
    /// A table with these columns.
    pub fn new(
        header: impl IntoIterator<Item = impl Into<String>>,
        records: Vec<Vec<String>>,
    ) -> Self {
        Self {
            header: header.into_iter().map(Into::into).collect(),
            records,
        }
    }

    /// A record for each of these.
    pub fn of<T>(all: &[T], columns: &[Column<T>]) -> Self {
        let record = |one| columns.iter().map(|(_, text)| text(one)).collect();
        Self::new(
            columns.iter().map(|c| c.0),
            all.iter().map(record).collect(),
        )
    }

    /// The header, then the records.
    fn lines(&self) -> impl Iterator<Item = &Vec<String>> {
        std::iter::once(&self.header).chain(&self.records)
    }

    /// Its text as comma-separated values (RFC 4180), lines ended by a line feed.
    pub fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = self.lines().try_for_each(|line| writer.write_record(line));
        // Memory takes whatever is written, and records are as long as the header.
        let bytes = written.ok().and_then(|()| writer.into_inner().ok());
        String::from_utf8(bytes.unwrap_or_default()).unwrap_or_default()
    }

    /// The columns whose place `keep` takes.
    fn columns(&self, keep: impl Fn(usize) -> bool) -> Self {
        let kept = |line: &Vec<String>| -> Vec<String> {
            let fields = line.iter().enumerate().filter(|(column, _)| keep(*column));
            fields.map(|(_, field)| field.clone()).collect()
        };
        Self::new(kept(&self.header), self.records.iter().map(kept).collect())
    }

    /// The table for readers: without the columns that have no value in any record.
    pub fn filled(&self) -> Self {
        let has_value = |field: &String| !matches!(field.as_str(), "" | NO_VALUE);
        self.columns(|column| {
            let mut fields = self.records.iter().filter_map(|record| record.get(column));
            self.records.is_empty() || fields.any(has_value)
        })
    }

    /// The table without the columns of this heading.
    pub fn without(&self, heading: &str) -> Self {
        self.columns(|column| self.header[column] != heading)
    }

    /// The characters of each column's longest field.
    fn widths(&self) -> Vec<usize> {
        let width = |column: usize| {
            let fields = self.lines().filter_map(|line| line.get(column));
            fields.map(|f| f.chars().count()).max().unwrap_or(0)
        };
        (0..self.header.len()).map(width).collect()
    }

    /// Its text in aligned columns: the first to the left, numbers and the rest to the right.
    pub fn aligned(&self) -> String {
        let widths = self.widths();
        let pad = |(column, (field, &width)): (usize, (&String, &usize))| match column {
            0 => format!("{field:width$}"),
            _ => format!("{field:>width$}"),
        };
        let mut out = String::new();
        for line in self.lines() {
            let fields = line.iter().zip(&widths).enumerate();
            let padded: Vec<String> = fields.map(pad).collect();
            out += padded.join(&" ".repeat(GAP)).trim_end();
            out.push('\n');
        }
        out
    }

    /// Its text for readers, whose terminal is so many characters wide if it is one.
    ///
    /// A wider table has its first column and as many of the next as fit, then the names of the
    /// others, which are in `whole`.
    pub fn within(&self, width: Option<usize>, whole: &str) -> String {
        let table = self.filled();
        let width = width.unwrap_or(usize::MAX);
        let ends = table.widths().into_iter().scan(0, |end, column| {
            *end += column + GAP;
            Some(*end - GAP)
        });
        let fit = ends.take_while(|end| *end <= width).count().max(1);
        let Some(others) = table.header.get(fit..).filter(|others| !others.is_empty()) else {
            return table.aligned();
        };
        let out = table.columns(|column| column < fit).aligned();
        let others = others.join(", ");
        let note = format!("wider than the terminal; {whole} also has: {others}");
        let length = |line: &str| line.chars().count() as f64;
        let lines = wrapped(note.split(' '), width as f64, length);
        out + &lines.join("\n") + "\n"
    }

    /// Reads comma-separated values.
    ///
    /// # Errors
    /// [`ErrorKind::File`]: no header, a quote that is not closed, a record of another length than
    /// the header.
    pub fn parse(text: &str) -> Result<Self> {
        let fault = |message: String| {
            let message = format!("{message}; write the file again with `revmap bench`");
            Err(Error::new(ErrorKind::File, message))
        };
        if text.matches('"').count() % 2 == 1 {
            return fault("a quoted field has no end".into());
        }
        // Spreadsheets begin a file with a byte order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header = match reader.headers() {
            Ok(header) if !header.is_empty() => header.iter().map(str::to_owned).collect(),
            _ => return fault("is empty".into()),
        };
        let owned = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
        let records = reader.records().map(|record| record.map(owned));
        match records.collect() {
            Ok(records) => Ok(Self { header, records }),
            Err(e) => fault(e.to_string()),
        }
    }

    /// Reads a file of comma-separated values.
    pub fn load(file: &Path) -> Result<Self> {
        Self::parse(&text_of(file, A_RUN)?).map_err(|e| e.in_file(file))
    }

    /// The place of a column.
    pub fn column(&self, name: &str) -> Result<usize> {
        self.header.iter().position(|n| n == name).ok_or_else(|| {
            let message = format!("has no column `{name}`; write it again with `revmap bench`");
            Error::new(ErrorKind::File, message)
        })
    }
}

/// What to give in place of a run's file that cannot be read.
pub const A_RUN: &str = "give a folder that `revmap bench` wrote";

/// The text of a file; the remedy if it cannot be read.
pub fn text_of(file: &Path, remedy: &str) -> Result<String> {
    std::fs::read_to_string(file).map_err(|e| {
        let message = format!("cannot be read ({e}); {remedy}");
        Error::new(ErrorKind::File, message).in_file(file)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn table(header: &[&str], records: &[&[&str]]) -> Table {
        let owned = |record: &&[&str]| record.iter().map(ToString::to_string).collect();
        Table::new(header.iter().copied(), records.iter().map(owned).collect())
    }

    #[test]
    fn what_is_written_is_read_again() {
        let quoted: &[&str] = &["\"q\"", "l1\nl2", "a,b"];
        let records = [&["1", "", "x y"], quoted, &["", "", ""]];
        let written = table(&["a", "b,c", "d"], &records);
        let text = written.csv();
        let start = "a,\"b,c\",d\n1,,x y\n\"\"\"q\"\"\",";
        assert!(text.starts_with(start), "{text}");
        let windows = text.replace('\n', "\r\n").replace("l1\r\n", "l1\n");
        let marked = format!("\u{feff}{windows}");
        for text in [text, windows, marked] {
            assert_eq!(Table::parse(&text).unwrap(), written);
        }
        assert_eq!(written.column("d").unwrap(), 2);
        assert!(written.column("e").is_err());
    }

    #[test]
    fn columns_are_aligned() {
        let text = table(&["name", "ms"], &[&["a", "10.5"], &["long name", "1"]]).aligned();
        assert_eq!(text, "name         ms\na          10.5\nlong name     1\n");
    }

    #[test]
    fn columns_without_a_value_are_left_out() {
        let records: [&[&str]; 2] = [&["a", "–", "1", ""], &["b", "–", "", ""]];
        let own = table(&["name", "none", "some", "empty"], &records);
        assert_eq!(
            own.filled(),
            table(&["name", "some"], &[&["a", "1"], &["b", ""]])
        );
        assert_eq!(own.within(None, ""), "name  some\na        1\nb\n");
        assert_eq!(own.csv(), "name,none,some,empty\na,–,1,\nb,–,,\n");
    }

    #[test]
    fn a_terminal_has_the_columns_that_fit_and_the_names_of_the_others() {
        let records: [&[&str]; 2] = [&["exact", "0.5", "0 %"], &["live", "0.81", "0.01 %"]];
        let own = table(&["method", "ratio", "wrong"], &records);
        for width in [None, Some(21), Some(80)] {
            assert_eq!(own.within(width, ""), own.aligned());
        }
        let wanted = "method  ratio\nexact     0.5\nlive     0.81\n\
            wider than the\nterminal; x.html\nalso has: wrong\n";
        assert_eq!(own.within(Some(20), "x.html"), wanted);
    }

    #[test]
    fn damaged_tables_are_refused() {
        for (text, wanted) in [
            ("", "is empty"),
            ("a,b\n1\n", "1 field"),
            ("a,b\n1,2,3\n", "3 fields"),
            ("a,b\n1,\"2\n", "no end"),
        ] {
            let error = Table::parse(text).unwrap_err();
            assert!(error.to_string().contains(wanted), "{error}");
        }
        // The last line may lack its end.
        assert_eq!(Table::parse("a,b\n1,2").unwrap().records, [["1", "2"]]);
    }
}
