//! A plan says what a benchmark measures and shows. Plans are TOML files ([`PlanFile`]); those
//! of the program's own are embedded in it ([`embedded`]).

mod arrange;
mod cases;
pub mod embedded;
mod entry;
mod file;
mod overrides;
pub mod suite;
mod time_budget;
mod values;
mod views;

pub use arrange::{army, flight_camera};
pub(crate) use cases::grouped;
pub use cases::{Case, Plan, RBM_BASELINE, is_rbm_baseline, rbm_baseline, variant};
pub use entry::{Measure, Pick};
pub use file::{Flight, PlanFile};
pub use overrides::{Lists, Overrides};
pub use time_budget::TimeBudget;
pub use views::{Form, Views};
