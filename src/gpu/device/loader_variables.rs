//! The environment variables by which Vulkan's loader finds drivers and layers: which of them is at
//! fault if it finds none.

use ash::{Entry, LoadingError};
use serde_json::Value;
use std::env::{split_paths, var_os};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

/// Lists of drivers' files and of folders with such files. The first one that is set hides the later
/// ones. The last one adds to the system's drivers, the others replace them.
const DRIVERS: [&str; 3] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"];
const DRIVER_FILTERS: [&str; 2] = ["VK_LOADER_DRIVERS_SELECT", "VK_LOADER_DRIVERS_DISABLE"];
/// Lists of folders and files of layers. The first one replaces the system's folders.
const LAYERS: [&str; 2] = ["VK_LAYER_PATH", "VK_ADD_LAYER_PATH"];
const REMEDY: &str = "correct or unset the variable";
const LAYER_FILTER: &str = "VK_LOADER_LAYERS_DISABLE";

/// The variable that keeps drivers from the loader, with the remedy; `None` if none is set that may.
pub(super) fn hidden_drivers() -> Option<String> {
    let drivers = DRIVERS.into_iter().find_map(set);
    let of_drivers = drivers.iter().find_map(|of| faults(of, true, driver_fault));
    // A damaged file of layers keeps the loader from drivers, a missing one does not.
    let mut layers = LAYERS.into_iter().filter_map(set);
    let found = of_drivers.or_else(|| layers.find_map(|of| faults(&of, false, json_fault)));
    found.or_else(|| {
        let replaces = |(name, _): &(&str, OsString)| *name != DRIVERS[2];
        let filters = DRIVER_FILTERS.into_iter().filter_map(set);
        let all = drivers.filter(replaces).into_iter().chain(filters);
        chosen("drivers", all, ", and none of them answers")
    })
}

/// The same for layers.
pub(super) fn hidden_layers() -> Option<String> {
    let mut layers = LAYERS.into_iter().filter_map(set);
    let found = layers.find_map(|of| faults(&of, true, json_fault));
    found.or_else(|| {
        let all = [LAYERS[0], LAYER_FILTER].into_iter().filter_map(set);
        chosen("layers", all, "")
    })
}

fn set(name: &'static str) -> Option<(&'static str, OsString)> {
    Some((name, var_os(name)?))
}

/// Names the variables that choose what the loader finds. `end`: of the sentence.
fn chosen(
    what: &str,
    all: impl Iterator<Item = (&'static str, OsString)>,
    end: &str,
) -> Option<String> {
    let named = all.map(|(name, value)| format!("{name}={}", value.display()));
    let named: Vec<_> = named.collect();
    let by = named.join(" and ");
    (!named.is_empty()).then(|| format!("the {what} are chosen by {by}{end}; {REMEDY}"))
}

/// The faults of the files that a variable lists, and the remedy. `missing`: true if a missing file
/// is a fault.
fn faults(
    (name, list): &(&str, OsString),
    missing: bool,
    fault: fn(&Path) -> Option<String>,
) -> Option<String> {
    let of_path = |path: PathBuf| match files_in(&path) {
        Ok(files) if !files.is_empty() => (files.into_iter())
            .filter_map(|file| fault(&file).map(|fault| (file, fault)))
            .collect(),
        _ if !missing => Vec::new(),
        Ok(_) => vec![(path, "has no .json file".to_owned())],
        Err(fault) => vec![(path, fault)],
    };
    let paths = split_paths(list).filter(|path| !path.as_os_str().is_empty());
    let all = paths.flat_map(of_path);
    let all = all.map(|(file, fault)| format!("{}, which {fault}", file.display()));
    let all: Vec<_> = all.collect();
    (!all.is_empty()).then(|| format!("{name} names {}; {REMEDY}", all.join(", and ")))
}

/// The file itself, or the files of a folder.
fn files_in(path: &Path) -> Result<Vec<PathBuf>, String> {
    if !path.is_dir() {
        return match path.exists() {
            true => Ok(vec![path.to_path_buf()]),
            false => Err("does not exist".to_owned()),
        };
    }
    let entries = fs::read_dir(path).map_err(|e| format!("cannot be read ({e})"))?;
    let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_json = |file: &PathBuf| file.extension() == Some(OsStr::new("json"));
    let mut files: Vec<_> = files.filter(is_json).collect();
    files.sort();
    Ok(files)
}

fn json_fault(file: &Path) -> Option<String> {
    json(file).err()
}

fn json(file: &Path) -> Result<Value, String> {
    let bytes = fs::read(file).map_err(|e| format!("cannot be read ({e})"))?;
    serde_json::from_slice(&bytes).map_err(|e| format!("is damaged: it is not JSON ({e})"))
}

fn driver_fault(file: &Path) -> Option<String> {
    let driver = match json(file) {
        Ok(driver) => driver,
        Err(fault) => return Some(fault),
    };
    let Some(library) = driver.pointer("/ICD/library_path").and_then(Value::as_str) else {
        return Some("names no driver: it has no ICD.library_path".to_owned());
    };
    // A bare name is looked up by the system, any other path begins at the file.
    let beside = Path::new(library).components().count() > 1;
    let path = match (file.parent(), beside) {
        (Some(folder), true) => folder.join(library),
        _ => PathBuf::from(library),
    };
    // SAFETY: the loader has tried to load the same library.
    match unsafe { Entry::load_from(path) } {
        Err(LoadingError::LibraryLoadFailure(e)) => {
            Some(format!("names a driver that does not load ({e})"))
        }
        // A driver need not have the function that ash looks for.
        Ok(_) | Err(LoadingError::MissingEntryPoint(_)) => None,
    }
}
