//! `revmap searches`: all searches, and folders for new ones.

use super::output;
use clap::{Args, Subcommand};
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::Solver;
use revmap_lab::report::glossary;
use revmap_searches::ALL;
use revmap_searches::folder::{self, Folder};
use revmap_searches::manifest::Manifest;
use std::path::{Path, PathBuf};

/// Lists all searches: what each reads, its steps, its parameters, where it comes from
///
/// With a folder: checks its search.toml, compiles its GLSL for both stages, and lists it.
#[derive(Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "Examples:\n  \
    revmap searches\n  \
    revmap searches new mine && revmap searches ./mine\n  \
    revmap render assets/scenes/vase.toml --solver ./mine -o vase.png"
)]
pub struct Searches {
    /// Folders of searches, with values of parameters as in ./mine:omega=1.2
    #[arg(value_name = "FOLDER")]
    folders: Vec<String>,
    #[command(subcommand)]
    command: Option<New>,
}

#[derive(Subcommand)]
enum New {
    /// Writes a folder to start from: a search that draws, with its description
    New {
        /// The folder; its last part names the search
        name: PathBuf,
    },
}

/// The files of a new folder.
const TEMPLATE: [(&str, &str); 2] = [
    ("search.toml", include_str!("searches/search.toml")),
    ("search.glsl", include_str!("searches/search.glsl")),
];

impl Searches {
    pub fn run(self) -> Result<()> {
        if let Some(New::New { name }) = &self.command {
            return new(name);
        }
        let mut solvers = Vec::new();
        for name in &self.folders {
            let folder = if folder::is_named(name) {
                name.clone()
            } else {
                format!("./{name}")
            };
            let solver = folder::load(&folder)?;
            folder::compile(solver)?;
            solvers.push(solver);
        }
        if solvers.is_empty() {
            solvers.extend(ALL.iter().rev());
        }
        for solver in solvers {
            describe(solver)
                .iter()
                .for_each(|line| output::result(line));
        }
        Ok(())
    }
}

/// The lines about a search.
fn describe(solver: Solver) -> Vec<String> {
    let folder = folder::of(solver);
    let published = folder::published(solver);
    let own = folder.map(|f| &f.manifest).or(published.as_ref());
    let reads = own.map_or(if solver.reads_map() { "map" } else { "patches" }, |m| {
        m.reads.name()
    });
    let mut lines = vec![format!("{solver}: {}", glossary::meaning(solver.into()))];
    let mut add = |key: &str, text: String| lines.push(format!("  {key:<11} {text}"));
    add("reads", reads.to_owned());
    if let Some(steps) = solver.steps() {
        let [default, beveled] = [false, true].map(|beveled| steps.of(beveled));
        let bevel = format!(", {beveled} with a bevel");
        let bevel = if beveled == default { "" } else { &bevel };
        add("steps", format!("{default}{bevel}; {} at most", steps.most));
    }
    if let Some(manifest) = own {
        add("draws", draws(manifest));
        for (name, p) in &manifest.parameters {
            let [low, high] = p.range;
            let value = folder
                .and_then(|f| f.values.get(name))
                .unwrap_or(&p.default);
            add(
                "parameter",
                format!("{name} = {value} ({low} to {high}): {}", p.about),
            );
        }
        add("source", manifest.source.clone());
        add("licence", manifest.licence.clone());
    }
    add("from", origin(folder, own.is_some()));
    lines
}

fn draws(manifest: &Manifest) -> String {
    let all = [
        (manifest.bevels, "bevels"),
        (manifest.unsigned, "maps of unsigned distances"),
        (manifest.inside, "eyes inside the solid"),
    ];
    let known = all.iter().filter(|(is, _)| *is).map(|(_, what)| *what);
    match known.collect::<Vec<_>>().join(", ") {
        none if none.is_empty() => "solids without a bevel, from outside".to_owned(),
        known => format!("also {known}"),
    }
}

fn origin(folder: Option<&Folder>, published: bool) -> String {
    match folder {
        Some(f) => format!("the folder {}, files {:016x}", f.path.display(), f.hash),
        None if published => "revmap, for comparison (crates/searches/published)".to_owned(),
        None => "revmap's own (docs/searches.md)".to_owned(),
    }
}

/// Writes a folder to start from.
fn new(path: &Path) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let error = |kind, message: String| Err(Error::new(kind, message).in_file(path));
    let files = TEMPLATE.map(|(file, text)| (file, text.replace("NAME", &name)));
    if let Err(message) = Manifest::parse(&files[0].1, false) {
        return error(ErrorKind::Usage, message);
    }
    if ALL.iter().any(|solver| solver.name() == name) {
        return error(
            ErrorKind::Usage,
            format!("{name} is a search of revmap; take another name"),
        );
    }
    if path.exists() {
        return error(
            ErrorKind::Usage,
            "exists already; take another name".to_owned(),
        );
    }
    if let Err(e) = std::fs::create_dir_all(path) {
        return error(
            ErrorKind::File,
            format!("cannot be made ({e}); choose another place"),
        );
    }
    for (file, text) in files {
        revmap_files::write_bytes(&path.join(file), text.as_bytes())?;
    }
    let shown = path.display();
    let shown = if path.components().count() > 1 {
        shown.to_string()
    } else {
        format!("./{shown}")
    };
    output::result(&format!(
        "{shown}: a search to start from; draw by it with --solver {shown}"
    ));
    Ok(())
}
