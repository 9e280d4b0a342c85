//! Files that the program keeps between runs, in the user's cache folder. Each begins with a
//! checksum, so a damaged file counts as absent. Failures to read or write are no failures: the
//! content is made again.

use shaderc_link::modules::Fnv;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder: `revmap` below `XDG_CACHE_HOME`, `LOCALAPPDATA` or `~/.cache`.
pub fn folder() -> Option<PathBuf> {
    let set = |name| std::env::var_os(name).filter(|v| !v.is_empty());
    let base = set("XDG_CACHE_HOME")
        .or_else(|| set("LOCALAPPDATA"))
        .map(PathBuf::from)
        .or_else(|| set("HOME").map(|home| PathBuf::from(home).join(".cache")))?;
    Some(base.join("revmap"))
}

/// The content of a file that [`write()`] wrote; `None` if it is absent or damaged.
pub fn read(file: &Path) -> Option<Vec<u8>> {
    let bytes = fs::read(file).ok()?;
    let (head, data) = bytes.split_first_chunk::<8>()?;
    (u64::from_le_bytes(*head) == Fnv::of([data])).then(|| data.to_vec())
}

/// Writes a file beside its place and renames it: one of two writers wins, and a reader never sees
/// half a file.
pub fn write(file: &Path, data: &[u8]) {
    let beside = file.with_extension(format!("{}.part", std::process::id()));
    let made = file.parent().map_or(Ok(()), fs::create_dir_all);
    let head = Fnv::of([data]).to_le_bytes();
    let written = made.and_then(|()| fs::write(&beside, [&head[..], data].concat()));
    if written.and_then(|()| fs::rename(&beside, file)).is_err() {
        let _ = fs::remove_file(&beside);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn damaged_files_count_as_absent() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a/b.words");
        assert_eq!(read(&file), None);
        write(&file, b"pipelines");
        assert_eq!(read(&file).as_deref(), Some(&b"pipelines"[..]));
        let mut bytes = fs::read(&file).unwrap();
        bytes[10] ^= 1;
        fs::write(&file, &bytes).unwrap();
        assert_eq!(read(&file), None);
        fs::write(&file, &bytes[..5]).unwrap();
        assert_eq!(read(&file), None);
        assert_eq!(fs::read_dir(folder.path().join("a")).unwrap().count(), 1);
    }
}
