//! `revmap chart`: speed against accuracy.

use super::bench::{self, Scale};
use super::lists::Lists;
use clap::Args;
use revmap::error::Result;
use revmap_lab::report::plan::embedded;

/// Charts speed against accuracy: every search over its budget and its maps
///
/// Steps, rows, sources and formats of maps are swept one at a time; where one of their lists is
/// given, every combination of the lists is measured instead.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap chart --quick --out out/chart\n  \
    revmap chart assets/scenes/vase.toml --solver circle,live --max-steps 10,20,40,80")]
pub struct Chart {
    #[command(flatten)]
    lists: Lists,
    #[command(flatten)]
    scale: Scale,
}

impl Chart {
    pub fn run(self) -> Result<()> {
        let full = self.scale.full;
        let name = if full { "chart-full" } else { "chart" };
        bench::run(embedded::plan(name)?, &self.lists, self.scale.quick)
    }
}
