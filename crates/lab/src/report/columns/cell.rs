//! Cells of tables.

use crate::report::names::{number, percent, range};
use crate::report::stats::Interval;

/// The content of a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Nothing.
    Empty,
    /// Words.
    Text(String),
    /// A number that is a count.
    Count(u64),
    /// A number.
    Number(f64),
    /// A share, shown in percent.
    Share(f64),
    /// A value with its interval.
    Known(Interval),
    /// A value whose interval is wider than the plan allows.
    Unresolved(Interval),
}

impl Cell {
    /// Its text in files.
    pub fn csv(&self) -> String {
        match self {
            Self::Empty => String::new(),
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Number(value) | Self::Share(value) => number(*value, 6),
            Self::Known(interval) | Self::Unresolved(interval) => number(interval.value, 6),
        }
    }

    /// Its text in tables.
    pub fn shown(&self) -> String {
        match self {
            Self::Empty => "–".to_owned(),
            Self::Number(value) => number(*value, 3),
            Self::Share(share) => percent(*share),
            Self::Known(i) => match i.ends() {
                Some(ends) => format!("{} ({})", number(i.value, 3), range(ends)),
                None => number(i.value, 3),
            },
            Self::Unresolved(i) => format!("{}, not resolved", Self::Known(*i).shown()),
            Self::Text(_) | Self::Count(_) => self.csv(),
        }
    }

    /// The interval of its value, if it has one.
    pub(in crate::report) fn interval(&self) -> Option<Interval> {
        match self {
            Self::Known(interval) | Self::Unresolved(interval) => Some(*interval),
            _ => None,
        }
    }

    /// The value, if it is a number.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Empty | Self::Text(_) => None,
            Self::Count(count) => Some(*count as f64),
            Self::Number(value) | Self::Share(value) => Some(*value),
            Self::Known(interval) | Self::Unresolved(interval) => Some(interval.value),
        }
    }

    pub(in crate::report) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    pub(in crate::report) fn number(value: impl Into<Option<f64>>) -> Self {
        value.into().map_or(Self::Empty, Self::Number)
    }

    pub(super) fn count(count: impl Into<Option<usize>>) -> Self {
        count.into().map_or(Self::Empty, |n| Self::Count(n as u64))
    }

    pub(super) fn name(text: Option<&str>) -> Self {
        text.map_or(Self::Empty, Self::text)
    }
}
