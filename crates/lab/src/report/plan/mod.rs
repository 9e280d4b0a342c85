//! A plan says what a benchmark measures and shows. Plans are TOML files ([`PlanFile`]); those
//! of the program's own are embedded in it ([`embedded`]).

mod arrange;
mod cases;
pub mod embedded;
mod file;
mod labels;
mod overrides;
pub mod suite;
mod time_budget;
mod values;
mod views;

pub use arrange::{army, distant, flight_camera};
pub(in crate::report) use cases::grouped;
pub use cases::{Case, Plan, Truth, is_rbm_baseline, plain, rbm_baseline, variant};
pub use file::{Flight, Measure, Pick, PlanFile};
pub use labels::{Labels, RBM_BASELINE};
pub use overrides::{Lists, Overrides};
pub use time_budget::TimeBudget;
pub use views::{Form, Views};
