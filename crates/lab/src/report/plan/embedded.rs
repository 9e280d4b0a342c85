//! The plans that the program carries.

use super::PlanFile;
use revmap::error::{Error, ErrorKind, Result};

/// Names and files of the plans, in the order in which they are listed.
pub const ALL: [(&str, &str); 13] = [
    ("usual", include_str!("../plans/usual.toml")),
    ("quick", include_str!("../plans/quick.toml")),
    ("full", include_str!("../plans/full.toml")),
    ("techniques", include_str!("../plans/techniques.toml")),
    (
        "techniques-tables",
        include_str!("../plans/techniques-tables.toml"),
    ),
    ("tables", include_str!("../plans/tables.toml")),
    ("scaling", include_str!("../plans/scaling.toml")),
    ("budget", include_str!("../plans/budget.toml")),
    ("sizes", include_str!("../plans/sizes.toml")),
    ("crowds", include_str!("../plans/crowds.toml")),
    ("antialiasing", include_str!("../plans/antialiasing.toml")),
    ("chart", include_str!("../plans/chart.toml")),
    ("chart-full", include_str!("../plans/chart-full.toml")),
];

/// The file of a plan.
///
/// # Errors
/// [`ErrorKind::Usage`] where there is none of this name.
pub fn text(name: &str) -> Result<&'static str> {
    let found = ALL.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| *text).ok_or_else(|| {
        let names = ALL.map(|(name, _)| name).join(", ");
        let message = format!("{name:?} is no plan of the program; give one of {names}");
        Error::new(ErrorKind::Usage, message)
    })
}

/// A plan of the program.
///
/// # Errors
/// See [`text`].
pub fn plan(name: &str) -> Result<PlanFile> {
    PlanFile::parse(text(name)?).map_err(|e| e.in_file(format!("{name}.toml")))
}

/// Each plan's name and what it measures.
///
/// # Errors
/// See [`plan`].
pub fn list() -> Result<Vec<(&'static str, String)>> {
    let one = |(name, _): &(&'static str, &str)| Ok((*name, plan(name)?.about));
    ALL.iter().map(one).collect()
}
