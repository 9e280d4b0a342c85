//! Numbered frames in a folder.

use crate::output::usage;
use revmap::error::{Error, ErrorKind, Result};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Frames in a folder, `frame-` and a number of four digits or more, in order.
pub fn frames_in(folder: &Path) -> Vec<PathBuf> {
    let is_frame = |path: &PathBuf| {
        let name = path.file_name().and_then(OsStr::to_str);
        let number = name.and_then(|n| n.strip_prefix("frame-")?.strip_suffix(".png"));
        number.is_some_and(|n| n.len() >= 4 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut frames: Vec<_> = paths.filter(is_frame).collect();
    frames.sort();
    frames
}

/// Makes the folder of frames. A folder with frames of an earlier run, `old`, is refused, unless
/// `overwrite`: then they are removed.
pub fn claim(folder: &Path, old: &[PathBuf], overwrite: bool) -> Result<()> {
    let fail = |message: String| Error::new(ErrorKind::File, message).in_file(folder);
    if !old.is_empty() && !overwrite {
        let message = format!(
            "holds {} frames of an earlier run; choose another folder, or give --overwrite to replace them",
            old.len()
        );
        return Err(usage("--output", message).in_file(folder));
    }
    std::fs::create_dir_all(folder)
        .map_err(|e| fail(format!("cannot be made ({e}); choose another folder")))?;
    let removed = old.iter().try_for_each(std::fs::remove_file);
    removed.map_err(|e| {
        fail(format!(
            "an earlier frame cannot be removed ({e}); choose another folder"
        ))
    })
}
