//! Files that are written completely or not at all: the data goes into a file beside the target,
//! which is then renamed to the target's name. A few targets keep their place.

use crate::file_fault;
use revmap::error::Result;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};
use std::time::Duration;

/// Files that are being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the files that [`write_atomically`] has begun, for a program that ends at once after this
/// call: a thread that begins or ends a file from now on waits for that end.
pub fn remove_unfinished() {
    /// The longest wait, in milliseconds. The thread that calls this may hold the lock itself, when
    /// memory ends while it begins a file.
    const LONGEST_WAIT: u32 = 500;
    for _ in 0..LONGEST_WAIT {
        let parts = match UNFINISHED.try_lock() {
            Ok(parts) => parts,
            Err(TryLockError::Poisoned(parts)) => parts.into_inner(),
            Err(TryLockError::WouldBlock) => {
                std::thread::sleep(Duration::from_millis(1));
                continue;
            }
        };
        for part in parts.iter() {
            let _ = fs::remove_file(part);
        }
        // Otherwise the next file would be begun between this loop and the end of the program.
        return std::mem::forget(parts);
    }
}

/// What is written: bytes in order, some at earlier places.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Writes a file by `fill`.
///
/// The bytes go into a new file in the target's folder, are flushed to the disk, and only then get
/// the target's name. A reader never sees half a file, and a failure leaves the old content. The
/// permissions of a file that is replaced are kept. A symbolic link is followed, also if it leads to
/// no file yet.
///
/// Some targets would lose more than their content if they were replaced. They keep their place and
/// get the bytes once all of them are in memory: devices and pipes, files with several names (hard
/// links), files of another owner, files in a folder that takes no new ones, and files on which
/// another file system is mounted.
///
/// # Errors
/// The errors of `fill`; [`ErrorKind::File`](revmap::error::ErrorKind::File) if the file cannot be
/// made or written (folder missing, no permission, read-only, full disk). Both errors name the file.
pub fn write_atomically(
    target: &Path,
    fill: impl FnOnce(&mut dyn Sink) -> Result<()>,
) -> Result<()> {
    let failed = |e| file_fault(reason("cannot be written", &e)).in_file(target);
    match place(target).map_err(|e| e.in_file(target))? {
        Place::Kept(real) => {
            let mut bytes = Cursor::new(Vec::new());
            fill(&mut bytes).map_err(|e| e.in_file(target))?;
            overwrite(&real, &bytes.into_inner()).map_err(failed)
        }
        Place::New(part, real) => {
            let mut writer = BufWriter::new(part.file.try_clone().map_err(failed)?);
            fill(&mut writer).map_err(|e| e.in_file(target))?;
            writer.flush().map_err(failed)?;
            finish(&part, &real).map_err(failed)
        }
    }
}

/// Checks that [`write_atomically`] can write `target`, which stays as it is.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File), without the file's name.
pub fn check_writable(target: &Path) -> Result<()> {
    place(target).map(drop)
}

/// Where the bytes of a file go first.
enum Place {
    /// Into the file itself.
    Kept(PathBuf),
    /// Into a file beside it, which then gets its name.
    New(Part, PathBuf),
}

fn place(target: &Path) -> Result<Place> {
    let failed = |e| file_fault(reason("cannot be written", &e));
    if cfg!(windows) && is_of_device(target) {
        return Err(file_fault(
            "is the name of a device on Windows; name another file",
        ));
    }
    let real = destination(target);
    let old = match fs::metadata(target) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => None,
        old => Some(old.map_err(failed)?),
    };
    match &old {
        Some(old) if old.is_dir() => {
            return Err(file_fault("is a folder; give the name of a file"));
        }
        // Pipes would wait for a reader here.
        Some(old) if !old.is_file() => return Ok(Place::Kept(real)),
        Some(old) if old.permissions().readonly() => {
            let message = "is read-only; allow writing to it or name another file";
            return Err(file_fault(message));
        }
        Some(_) => drop(OpenOptions::new().write(true).open(&real).map_err(failed)?),
        None if real.file_name().is_none() => {
            return Err(file_fault("is not the name of a file"));
        }
        None => {}
    }
    match (Part::create(&real), old) {
        (Ok(part), Some(old)) if loses(&old, &part.file).map_err(failed)? => Ok(Place::Kept(real)),
        (Ok(part), _) => Ok(Place::New(part, real)),
        (Err(e), Some(_)) if e.kind() == io::ErrorKind::PermissionDenied => Ok(Place::Kept(real)),
        // Windows finds no folder there.
        (Err(e), _)
            if e.kind() == io::ErrorKind::NotFound && real.ancestors().any(Path::is_file) =>
        {
            let error = io::ErrorKind::NotADirectory.into();
            Err(file_fault(reason("cannot be created", &error)))
        }
        (Err(e), _) => Err(file_fault(reason("cannot be created", &e))),
    }
}

/// Returns true if Windows takes a file's name for a device, whatever its ending and folder.
fn is_of_device(target: &Path) -> bool {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let name = name.split('.').next().unwrap_or_default().trim_end();
    let name = name.to_ascii_lowercase();
    let numbered = |port: &str| {
        let number = name.strip_prefix(port).unwrap_or_default();
        matches!(number.as_bytes(), [b'1'..=b'9'])
    };
    ["con", "prn", "aux", "nul"].contains(&&*name) || numbered("com") || numbered("lpt")
}

/// Returns true if `new` in place of `old` would have another owner, or leave other names behind.
#[cfg(unix)]
fn loses(old: &fs::Metadata, new: &File) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let new = new.metadata()?;
    Ok(old.nlink() > 1 || (old.uid(), old.gid()) != (new.uid(), new.gid()))
}

#[cfg(not(unix))]
fn loses(_: &fs::Metadata, _: &File) -> io::Result<bool> {
    Ok(false)
}

/// Puts these bytes in place of a file's content. Pipes and devices have no length to cut and may
/// have no disk to reach.
fn overwrite(real: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().write(true).open(real)?;
    let plain = file.metadata()?.is_file();
    if plain {
        file.set_len(0)?;
    }
    file.write_all(bytes)?;
    if plain { file.sync_all() } else { Ok(()) }
}

/// Gives a finished file the permissions and the name of `real`.
fn finish(part: &Part, real: &Path) -> io::Result<()> {
    if let Ok(old) = fs::metadata(real) {
        // Some file systems have no permissions.
        let _ = part.file.set_permissions(old.permissions());
    }
    // A full disk may be reported only here.
    part.file.sync_all()?;
    replace(&part.path, real)
}

/// Gives the finished `part` the name of `real`. A file on which another is mounted, as containers
/// do, keeps its place and gets the content.
fn replace(part: &Path, real: &Path) -> io::Result<()> {
    match fs::rename(part, real) {
        Err(e) if e.kind() == io::ErrorKind::ResourceBusy => {
            let mut file = OpenOptions::new().write(true).truncate(true).open(real)?;
            io::copy(&mut File::open(part)?, &mut file)?;
            file.sync_all()
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
        let failed = |e| file_fault(reason("cannot be written", &e));
        writer.write_all(bytes).map_err(failed)
    })
}

/// A file that is being written. It is removed when dropped, unless it has got its name.
struct Part {
    file: File,
    path: PathBuf,
}

impl Part {
    /// A new file in the folder of `target`, with a name that no other writer uses.
    fn create(target: &Path) -> io::Result<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        // Long names leave no room for the ending.
        let stem: String = name.chars().take(48).collect();
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path =
                target.with_file_name(format!(".{stem}.{}-{count}.part", std::process::id()));
            let mut parts = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
            let mut options = OpenOptions::new();
            match options.write(true).read(true).create_new(true).open(&path) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
                Err(e) => return Err(e),
                Ok(file) => {
                    parts.push(path.clone());
                    return Ok(Self { file, path });
                }
            }
        }
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        // Best effort: an earlier failure is the one to report.
        let _ = fs::remove_file(&self.path);
        let mut parts = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        parts.retain(|other| *other != self.path);
    }
}

/// What failed, the system's reason, and a remedy if that is plain.
fn reason(what: &str, error: &io::Error) -> String {
    /// Windows' number of an error that has no kind: another program has the file open.
    const SHARING_VIOLATION: i32 = 32;
    let is_shared = error.raw_os_error() == Some(SHARING_VIOLATION);
    let why = match error.kind() {
        io::ErrorKind::NotFound => "its folder does not exist; make it first".into(),
        // Windows says so, too, of a file that another program has open.
        kind if cfg!(windows) && (is_shared || kind == io::ErrorKind::PermissionDenied) => {
            "no permission, or another program has it open; choose another folder or close it there"
                .into()
        }
        io::ErrorKind::PermissionDenied => "no permission; choose another folder".into(),
        io::ErrorKind::StorageFull => {
            "the disk is full; free some space or choose another folder".into()
        }
        io::ErrorKind::NotADirectory => "part of its path is not a folder".into(),
        _ => error.to_string(),
    };
    format!("{what}: {why}")
}

#[cfg(test)]
mod tests;
