//! Searches of folders: a `search.toml` and one GLSL file, read and compiled at run time.
//!
//! A search is named by the path of its folder, with values of its parameters if they are not the
//! default: `my-search`, `my-search:omega=1.2:limit=3`.

mod compile;
mod faults;
mod program;
#[cfg(feature = "shaderc")]
mod returns;

pub use compile::{compile, is_available};
pub use faults::{check_frame, check_scene};

use crate::manifest::{self, Data, Manifest, Number};
use crate::{ALL, watchdog};
use revmap::error::{Error, ErrorKind, Result};
use revmap::search::{Reads, Search, SearchTable, Steps, Words};
use revmap::settings::Solver;
use shaderc_link::modules::Fnv;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A search of a folder.
#[derive(Clone, Debug)]
pub struct Folder {
    /// The name by which it was loaded.
    pub spec: String,
    /// The folder, as it was named.
    pub path: PathBuf,
    /// Its description.
    pub manifest: Manifest,
    /// The values of its parameters.
    pub values: BTreeMap<String, Number>,
    /// FNV-1a of the names and contents of its files.
    pub hash: u64,
    /// Its GLSL files: name in `#include`, path, text. The first has the function.
    sources: Vec<(String, PathBuf, String)>,
}

/// Every search that was loaded, and its folder.
static LOADED: Mutex<Vec<(&'static Search, &'static Folder)>> = Mutex::new(Vec::new());

fn loaded() -> MutexGuard<'static, Vec<(&'static Search, &'static Folder)>> {
    LOADED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// True if a solver's name is the path of a folder: it has a separator, or such a folder is there.
pub fn is_named(name: &str) -> bool {
    name.contains(['/', '\\']) || split(name).0.join(manifest::FILE).exists()
}

/// The search of a folder, named as the [module](self) says. The same name returns the same search.
///
/// # Errors
/// [`ErrorKind::File`] for a file that cannot be read, [`ErrorKind::Content`] for a fault of
/// `search.toml`, [`ErrorKind::Usage`] for values of parameters.
pub fn load(name: &str) -> Result<Solver> {
    let known = |(search, folder): &(_, &Folder)| (folder.spec == name).then_some(*search);
    let known = loaded().iter().rev().find_map(known);
    known.map_or_else(|| reload(name), |search| Ok(Solver::Other(search)))
}

/// The search of a folder as its files are now.
pub fn reload(name: &str) -> Result<Solver> {
    let folder: &'static Folder = Box::leak(Box::new(Folder::read(name)?));
    let twin = |other: &&Folder| other.name() == folder.name() && other.path != folder.path;
    if let Some(other) = all().into_iter().find(twin) {
        let other = other.path.display();
        let message = format!("name: is that of {other} too; give each folder a name of its own");
        let file = folder.path.join(manifest::FILE);
        return Err(Error::new(ErrorKind::Content, message).in_file(file));
    }
    let search: &'static Search = Box::leak(Box::new(folder.search()));
    loaded().push((search, folder));
    Ok(Solver::Other(search))
}

/// The folder of a search; `None` for searches of crates.
pub fn of(solver: Solver) -> Option<&'static Folder> {
    let Solver::Other(search) = solver else {
        return None;
    };
    let own = |(known, folder): &(&Search, _)| (*known == search).then_some(*folder);
    loaded().iter().find_map(own)
}

/// The name of a folder's search; `None` for a search that no folder holds.
pub fn name_of(solver: Solver) -> Option<String> {
    of(solver).map(Folder::name)
}

/// The search that was loaded last.
pub fn latest() -> Option<Solver> {
    loaded().last().map(|(search, _)| Solver::Other(search))
}

/// The folders of all searches that were loaded.
pub fn all() -> Vec<&'static Folder> {
    loaded().iter().map(|(_, folder)| *folder).collect()
}

/// The description of a search of this crate.
pub fn published(solver: Solver) -> Option<Manifest> {
    let all = crate::published::PUBLISHED;
    let (_, text) = all.iter().find(|(known, _)| *known == solver)?;
    Manifest::parse(text, true).ok()
}

/// The folder and the parameters of a name.
fn split(name: &str) -> (PathBuf, Vec<(&str, &str)>) {
    let mut parts: Vec<&str> = name.split(':').collect();
    let mut values = Vec::new();
    while let [_, .., last] = parts[..]
        && let Some(pair) = last.split_once('=')
    {
        values.insert(0, pair);
        parts.pop();
    }
    (PathBuf::from(parts.join(":")), values)
}

impl Folder {
    fn read(name: &str) -> Result<Self> {
        let (path, given) = split(name);
        let file = path.join(manifest::FILE);
        let text = read(
            &file,
            "a search is a folder with a search.toml; `revmap searches new NAME` writes one",
        )?;
        let content = |message: String| Error::new(ErrorKind::Content, message).in_file(&file);
        let manifest = Manifest::parse(&text, false).map_err(content)?;
        let mut values: BTreeMap<String, Number> = manifest
            .parameters
            .iter()
            .map(|(name, parameter)| (name.clone(), parameter.default))
            .collect();
        for (key, value) in given {
            let usage = |message| Err(Error::new(ErrorKind::Usage, message).in_file(&file));
            let Some(parameter) = manifest.parameters.get(key) else {
                let known: Vec<&str> = values.keys().map(String::as_str).collect();
                let known = match known.is_empty() {
                    true => "it has none".to_owned(),
                    false => format!("give one of {}", known.join(", ")),
                };
                return usage(format!(
                    "{key:?} is no parameter of {}; {known}",
                    manifest.name
                ));
            };
            match parameter.value(key, value) {
                Ok(value) => values.insert(key.to_owned(), value),
                Err(message) => return usage(message),
            };
        }
        let sources = sources(&path, &manifest.glsl).map_err(|e| match e.file {
            Some(_) => e,
            None => e.in_file(&file),
        })?;
        let mut hash = Fnv::default();
        hash.add(text.as_bytes());
        for (name, _, text) in &sources {
            hash.add(name.as_bytes());
            hash.add(text.as_bytes());
        }
        for word in manifest.table.iter().flat_map(|table| &table.program) {
            hash.add(word.as_bytes());
            hash.add(&std::fs::read(path.join(word)).unwrap_or_default());
        }
        let hash = hash.value();
        Ok(Self {
            spec: name.to_owned(),
            path,
            manifest,
            values,
            hash,
            sources,
        })
    }

    /// The name in options and results, with the parameters that are not the default.
    pub fn name(&self) -> String {
        let mut name = self.manifest.name.clone();
        if ALL.iter().any(|solver| solver.name() == name) {
            name += " (folder)"; // a copy of a known one
        }
        let default = |key: &String| self.manifest.parameters.get(key).map(|p| p.default);
        for (key, value) in &self.values {
            if default(key) != Some(*value) {
                name += &format!(":{key}={value}");
            }
        }
        name
    }

    /// The origin of the search as reports state it: folder, hash, publication, licence.
    pub fn origin(&self) -> String {
        let Manifest {
            source, licence, ..
        } = &self.manifest;
        let (path, hash) = (self.path.display(), self.hash);
        format!("not revmap's own: folder {path}, files {hash:016x}; {source}; licence {licence}")
    }

    /// The files that the search is read from.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let own = std::iter::once(self.path.join(manifest::FILE));
        own.chain(self.sources.iter().map(|(_, path, _)| path.clone()))
    }

    /// The GLSL file that has the function.
    fn glsl(&self) -> &Path {
        self.sources.first().map_or(&self.path, |(_, path, _)| path)
    }

    /// The search for the library. It lives as long as the program.
    fn search(&'static self) -> Search {
        let own = &self.manifest;
        let words = Box::leak(Box::new(move |module: &_| {
            watchdog::check(&self.name())?;
            compile::words(self, module)
        }));
        let table: &'static (dyn Fn(&_, u32) -> Result<SearchTable> + Send + Sync) = match own.reads
        {
            Data::Patches => &|contour, _| Ok(SearchTable::of_patches(contour)),
            _ => Box::leak(Box::new(move |contour: &_, rows| {
                program::table(self, contour, rows)
            })),
        };
        // SAFETY: the words are compiled from the library's entry files, with its macros. The
        // person who names a folder runs its GLSL, as any program of theirs: drivers bound memory
        // accesses as far as they do, and the watchdog reports what does not end.
        #[allow(unsafe_code)]
        let words = unsafe { Words::new(words) };
        Search {
            name: self.name().leak(),
            about: own.about.clone().leak(),
            source: own.source.clone().leak(),
            licence: own.licence.clone().leak(),
            reads: match own.reads.is_map() {
                true => Reads::Map {
                    rgba8: own.unsigned,
                },
                false => Reads::Table(table),
            },
            steps: own.steps.map(|s| Steps {
                default: s.default,
                beveled: s.beveled.unwrap_or(s.default),
                most: s.most,
                may_run_out: s.may_run_out,
            }),
            form: own.form,
            words,
        }
    }
}

fn read(file: &Path, remedy: &str) -> Result<String> {
    std::fs::read_to_string(file).map_err(|e| {
        let message = format!("cannot be read ({e}); {remedy}");
        Error::new(ErrorKind::File, message).in_file(file)
    })
}

/// The GLSL files of a folder: the one of this name, and those that it includes. A file is in the
/// folder, or beside it; all others are the library's.
fn sources(folder: &Path, glsl: &str) -> Result<Vec<(String, PathBuf, String)>> {
    let mut all: Vec<(String, PathBuf, String)> = Vec::new();
    let mut wanted = vec![glsl.to_owned()];
    while let Some(name) = wanted.pop() {
        if all.iter().any(|(known, ..)| *known == name) {
            continue;
        }
        let places = [folder.join(&name), folder.join("..").join(&name)];
        let Some(path) = places.into_iter().find(|path| path.is_file()) else {
            if all.is_empty() {
                let message = format!("{name:?} is not in the folder; name a file of it");
                return Err(Error::new(ErrorKind::File, message).at_key("glsl"));
            }
            continue; // the compiler finds it, or names the line that includes it
        };
        let text = read(&path, "it must be a text in UTF-8")?;
        wanted.extend(text.lines().filter_map(included).map(str::to_owned));
        all.push((name, path, text));
    }
    Ok(all)
}

/// The name in a line `#include "name"`.
fn included(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix('#')?.trim_start();
    let rest = rest.strip_prefix("include")?.trim_start();
    rest.strip_prefix('"')?.split('"').next()
}
