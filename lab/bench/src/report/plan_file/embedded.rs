//! The plans that the program carries.

use super::PlanFile;
use revmap::error::{Error, ErrorKind, Result};

macro_rules! plans {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!("../../plans/", $name, ".toml")))),*]
    };
}

/// Names and files of the plans, in the order in which they are listed.
pub const ALL: [(&str, &str); 16] = plans! {
    "usual" "quick" "full" "techniques" "techniques-tables" "tables" "scaling" "budget" "sizes"
    "tolerances" "crowds" "offsets" "antialiasing" "chart" "chart-full" "submit"
};

/// The file of a plan.
pub fn text(name: &str) -> Result<&'static str> {
    let found = ALL.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| *text).ok_or_else(|| {
        let names = ALL.map(|(name, _)| name).join(", ");
        let message = format!("{name:?} is no plan of the program; give one of {names}");
        Error::new(ErrorKind::Usage, message)
    })
}

/// A plan of the program.
pub fn plan(name: &str) -> Result<PlanFile> {
    PlanFile::parse(text(name)?).map_err(|e| e.in_file(format!("{name}.toml")))
}

/// Each plan's name and what it measures.
pub fn list() -> Result<Vec<(&'static str, String)>> {
    let one = |(name, _): &(&'static str, &str)| Ok((*name, plan(name)?.about));
    ALL.iter().map(one).collect()
}
