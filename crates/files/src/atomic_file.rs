//! Files that are written completely or not at all: the data goes into a file beside the target,
//! which is then renamed to the target's name.

use crate::file_fault;
use revmap::error::Result;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

/// Files that are being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the files that [`write_atomically`] has begun: for a program that ends within a call.
pub fn remove_unfinished() {
    // Without the lock a file is being begun or ended at this moment.
    for part in UNFINISHED.try_lock().iter().flat_map(|parts| parts.iter()) {
        let _ = fs::remove_file(part);
    }
}

/// Writes a file by `fill`, which gets a buffered writer that can seek.
///
/// The bytes go into a new file in the target's folder, are flushed to the disk, and only then get
/// the target's name. A reader never sees half a file, and a failure leaves the old content. The
/// permissions of a file that is replaced are kept. A symbolic link is followed, also if it leads to
/// no file yet. Two kinds of targets cannot be replaced and are written directly: devices and pipes,
/// and files on which another file system is mounted.
///
/// # Errors
/// The errors of `fill`; [`ErrorKind::File`](revmap::error::ErrorKind::File) if the file cannot be
/// made or written (folder missing, no permission, full disk). Both errors name the file.
pub fn write_atomically(
    target: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<()>,
) -> Result<()> {
    let failed =
        |what: &str, e: &io::Error| file_fault(format!("{what}: {}", reason(e))).in_file(target);
    let real = destination(target);
    let old = fs::metadata(&real).ok();
    match &old {
        Some(meta) if meta.is_dir() => {
            return Err(file_fault("is a folder; give the name of a file").in_file(target));
        }
        Some(meta) if !meta.is_file() => {
            let file = OpenOptions::new()
                .write(true)
                .open(&real)
                .map_err(|e| failed("cannot be written", &e))?;
            let mut writer = BufWriter::new(file);
            fill(&mut writer).map_err(|e| e.in_file(target))?;
            return writer.flush().map_err(|e| failed("cannot be written", &e));
        }
        _ => {}
    }
    if real.file_name().is_none() {
        return Err(file_fault("is not the name of a file").in_file(target));
    }
    let (file, part) = create_part(&real).map_err(|e| failed("cannot be created", &e))?;
    let unfinished = |change: &dyn Fn(&mut Vec<PathBuf>)| {
        change(&mut UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner));
    };
    unfinished(&|parts| parts.push(part.clone()));
    let mut writer = BufWriter::new(file);
    let written = fill(&mut writer)
        .map_err(|e| e.in_file(target))
        .and_then(|()| {
            let file = writer
                .into_inner()
                .map_err(|e| failed("cannot be written", e.error()))?;
            if let Some(old) = &old {
                // Some file systems have no permissions.
                let _ = file.set_permissions(old.permissions());
            }
            // A full disk may be reported only here.
            file.sync_all().map_err(|e| failed("cannot be written", &e))
        })
        .and_then(|()| replace(&part, &real).map_err(|e| failed("cannot be replaced", &e)));
    if written.is_err() {
        // Best effort: the first failure is the one to report.
        let _ = fs::remove_file(&part);
    }
    unfinished(&|parts| parts.retain(|other| *other != part));
    written
}

/// Gives the finished `part` the name of `real`. A file on which another is mounted, as containers
/// do, keeps its place and gets the content.
fn replace(part: &Path, real: &Path) -> io::Result<()> {
    match fs::rename(part, real) {
        Err(e) if e.kind() == io::ErrorKind::ResourceBusy => {
            let mut file = OpenOptions::new().write(true).truncate(true).open(real)?;
            io::copy(&mut File::open(part)?, &mut file)?;
            file.sync_all()?;
            fs::remove_file(part)
        }
        other => other,
    }
}

/// The file that is written under the name `target`: symbolic links are followed, also those that
/// lead to no file yet.
#[must_use]
pub fn destination(target: &Path) -> PathBuf {
    /// Systems follow about so many links.
    const MOST_LINKS: usize = 40;
    let mut real = target.to_path_buf();
    for _ in 0..MOST_LINKS {
        match (real.canonicalize(), real.read_link()) {
            (Ok(file), _) => return file,
            // A relative link starts at its own folder.
            (_, Ok(link)) => real = real.parent().unwrap_or(Path::new("")).join(link),
            (Err(_), Err(_)) => break,
        }
    }
    let parent = real
        .parent()
        .map(|parent| match parent.as_os_str().is_empty() {
            true => Path::new("."),
            false => parent,
        });
    match (parent.and_then(|p| p.canonicalize().ok()), real.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => real,
    }
}

/// Writes these bytes by [`write_atomically`].
///
/// # Errors
/// The errors of [`write_atomically`].
pub fn write_bytes(target: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(target, |writer| {
        let failed = |e| file_fault(format!("cannot be written: {}", reason(&e)));
        writer.write_all(bytes).map_err(failed)
    })
}

/// A new file in the folder of `target`, with a name that no other writer uses.
fn create_part(target: &Path) -> io::Result<(File, PathBuf)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        // Long names leave no room for the ending.
        let stem: String = name.chars().take(48).collect();
        let part = target.with_file_name(format!(".{stem}.{}-{count}.part", std::process::id()));
        match OpenOptions::new()
            .write(true)
            .read(true)
            .create_new(true)
            .open(&part)
        {
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            other => return other.map(|file| (file, part)),
        }
    }
}

/// The system's reason, with a remedy if that is plain.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "its folder does not exist; make it first".into(),
        io::ErrorKind::PermissionDenied => "no permission; choose another folder".into(),
        io::ErrorKind::StorageFull => {
            "the disk is full; free some space or choose another folder".into()
        }
        io::ErrorKind::NotADirectory => "part of its path is not a folder".into(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap::error::{Error, ErrorKind};

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn the_target_appears_whole_and_alone() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.bin");
        write_bytes(&target, b"one").unwrap();
        write_bytes(&target, b"two").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn a_failure_keeps_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.bin");
        write_bytes(&target, b"old").unwrap();
        let error = write_atomically(&target, |w| {
            w.write_all(&[7; 100_000]).unwrap();
            Err(Error::new(ErrorKind::Other, "half way"))
        })
        .unwrap_err();
        assert_eq!(error.to_string(), format!("{}: half way", target.display()));
        assert_eq!(fs::read(&target).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn unwritable_targets_are_named() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("file"), b"").unwrap();
        for (target, what) in [
            (folder.path().join("no/such/a.bin"), "folder does not exist"),
            (folder.path().to_path_buf(), "is a folder"),
            (folder.path().join("file/a.bin"), "not a folder"),
        ] {
            let error = write_bytes(&target, b"x").unwrap_err();
            assert_eq!(error.file.as_deref(), Some(target.as_path()));
            assert!(error.to_string().contains(what), "{error}");
        }
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_reported_and_a_link_to_a_device_survives() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.bin");
        std::os::unix::fs::symlink("/dev/full", &target).unwrap();
        let error = write_bytes(&target, b"x").unwrap_err();
        assert!(error.to_string().contains("the disk is full"), "{error}");
        assert_eq!(names(folder.path()), ["a.bin"]);
        assert!(Path::new("/dev/full").exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        fs::write(&real, b"old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_bytes(&link, b"new").unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_no_file_yet_is_followed() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        let link = |to: &str, name: &str| {
            let link = folder.path().join(name);
            std::os::unix::fs::symlink(to, &link).unwrap();
            link
        };
        link("../real", "sub/second");
        let first = link("sub/second", "first");
        write_bytes(&first, b"new").unwrap();
        assert_eq!(fs::read(folder.path().join("real")).unwrap(), b"new");
        assert!(fs::symlink_metadata(&first).unwrap().is_symlink());
        let circle = link("circle", "circle");
        assert_eq!(destination(&circle).file_name(), circle.file_name());
    }

    #[cfg(unix)]
    #[test]
    fn the_permissions_of_a_file_are_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.bin");
        write_bytes(&target, b"old").unwrap();
        for mode in [0o600, 0o640, 0o666] {
            fs::set_permissions(&target, PermissionsExt::from_mode(mode)).unwrap();
            write_bytes(&target, b"new").unwrap();
            assert_eq!(
                fs::metadata(&target).unwrap().permissions().mode() & 0o777,
                mode
            );
        }
    }

    #[test]
    fn very_long_names_work() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("x".repeat(255));
        write_bytes(&target, b"x").unwrap();
        assert_eq!(names(folder.path()).len(), 1);
    }
}
