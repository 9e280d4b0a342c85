//! `revmap completions` and `revmap man`: completions for shells and manual pages.

use super::output;
use clap::{Args, Command};
use clap_complete::Shell;
use revmap::error::{Error, ErrorKind, Result};
use std::io::Write;
use std::path::PathBuf;

/// Prints what a shell completes command lines with
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap completions bash > ~/.local/share/bash-completion/completions/revmap\n  \
    revmap completions zsh > ~/.zfunc/_revmap\n  \
    revmap completions fish > ~/.config/fish/completions/revmap.fish")]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub fn run(self, mut program: Command) -> Result<()> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut program, "revmap", &mut script);
        print(&script);
        Ok(())
    }
}

/// Prints the manual page, or writes those of all commands into a folder
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap man | man -l -\n  \
    revmap man -o ~/.local/share/man/man1")]
pub struct Man {
    /// The folder that revmap.1, revmap-render.1 and so on go into; it is made if it is not there
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
}

impl Man {
    pub fn run(self, program: Command) -> Result<()> {
        let Some(folder) = self.output else {
            let mut page = Vec::new();
            let rendered = clap_mangen::Man::new(program).render(&mut page);
            rendered.map_err(|e| Error::new(ErrorKind::File, format!("no manual page: {e}")))?;
            print(&page);
            return Ok(());
        };
        std::fs::create_dir_all(&folder)
            .and_then(|()| clap_mangen::generate_to(program, &folder))
            .map_err(|e| {
                let message = format!("cannot be written ({e}); choose another folder");
                Error::new(ErrorKind::File, message).in_file(&folder)
            })?;
        output::result(&format!(
            "{}: revmap.1 and a page of each command",
            folder.display()
        ));
        Ok(())
    }
}

fn print(text: &[u8]) {
    output::keep_fault(std::io::stdout().write_all(text));
}
