//! A plan says what a benchmark measures: which views, by which methods. It comes from a [`file`].

mod arrange;
mod cases;
mod entry;
mod framing;
mod overrides;
pub mod suite;
mod time_budget;
mod values;
pub mod view;
mod views;

pub use arrange::{army, flight_camera};
pub use cases::{Case, Plan, RBM_BASELINE, is_rbm_baseline, rbm_baseline, variant};
pub use entry::{Measure, Pick};
pub use overrides::{Lists, Overrides};
pub use revmap_figures::names;
pub use revmap_methods as method;
pub use time_budget::TimeBudget;
pub use views::{Form, Views};
