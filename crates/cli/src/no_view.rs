//! `revmap view` in a program that was built without the window.

use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use std::ffi::OsString;

/// Shows a scene in a window; needs a build with the feature `viewer`
#[derive(Args)]
#[command(after_help = "How to get it:\n  \
    cargo install --path crates/cli --features viewer\n\n\
    Examples:\n  \
    revmap view assets/profiles/rook.svg\n  \
    revmap view assets/profiles/king.svg --studio --color steelblue\n  \
    revmap view assets/scenes/pawn.toml --stage compute --show steps")]
pub struct View {
    /// The scene and the options of a build with the window
    #[arg(
        value_name = "SCENE",
        trailing_var_arg = true,
        allow_hyphen_values = true
    )]
    arguments: Vec<OsString>,
}

impl View {
    /// Fails with the command that builds a program with the window.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`], always.
    pub fn run(self) -> Result<()> {
        let message = "view: this program was built without the window; \
                       get it with `cargo install --path crates/cli --features viewer`";
        Err(Error::new(ErrorKind::Usage, message))
    }
}
