//! Names of values in options, files and results.

/// The name of a value among these; the last, if it has several.
#[must_use]
pub fn name_of<T: PartialEq>(names: &[(&'static str, T)], value: &T) -> &'static str {
    let found = names.iter().rev().find(|(_, known)| known == value);
    found.map_or("unknown", |(name, _)| name)
}
