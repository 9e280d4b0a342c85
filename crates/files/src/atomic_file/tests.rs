#![allow(clippy::unwrap_used)]
use super::*;
use revmap::error::{Error, ErrorKind};
use tempfile::TempDir;

/// A folder with a file `a` of these bytes.
fn folder(old: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("a");
    fs::write(&target, old).unwrap();
    (folder, target)
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).unwrap();
    let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

#[test]
fn the_target_appears_whole_and_alone() {
    let (folder, target) = folder(b"old");
    write_bytes(&target, b"new").unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"new");
    let error = write_atomically(&target, |w| {
        w.write_all(&[7; 100_000]).unwrap();
        Err(Error::new(ErrorKind::Other, "half way"))
    });
    let message = error.unwrap_err().to_string();
    assert_eq!(message, format!("{}: half way", target.display()));
    assert_eq!(fs::read(&target).unwrap(), b"new");
    assert_eq!(names(&folder), ["a"]);
    write_bytes(&folder.path().join("x".repeat(255)), b"x").unwrap();
    assert_eq!(names(&folder).len(), 2);
}

#[test]
fn unwritable_targets_are_named() {
    let (folder, file) = folder(b"old");
    let mut permissions = fs::metadata(&file).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).unwrap();
    assert!(check_writable(&file).is_err());
    for (target, what) in [
        (folder.path().join("no/such/a.bin"), "folder does not exist"),
        (folder.path().to_path_buf(), "is a folder"),
        (folder.path().join("a/a.bin"), "not a folder"),
        (file.clone(), "is read-only"),
    ] {
        let error = write_bytes(&target, b"x").unwrap_err();
        assert_eq!(error.file.as_deref(), Some(target.as_path()));
        assert!(error.to_string().contains(what), "{error}");
    }
    assert_eq!(
        (names(&folder), fs::read(&file).unwrap()),
        (vec!["a".to_owned()], b"old".to_vec())
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_and_a_link_to_a_device_survives() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("a");
    std::os::unix::fs::symlink("/dev/full", &target).unwrap();
    let error = write_bytes(&target, b"x").unwrap_err();
    assert!(error.to_string().contains("the disk is full"), "{error}");
    assert_eq!(names(&folder), ["a"]);
    assert!(Path::new("/dev/full").exists());
}

#[cfg(unix)]
#[test]
fn links_are_followed_also_to_no_file_yet() {
    let (folder, real) = folder(b"old");
    fs::create_dir(folder.path().join("sub")).unwrap();
    let link = |to: &str, name: &str| {
        let link = folder.path().join(name);
        std::os::unix::fs::symlink(to, &link).unwrap();
        link
    };
    link("../new", "sub/second");
    for (link, real) in [
        (link("a", "link"), real),
        (link("sub/second", "first"), folder.path().join("new")),
    ] {
        write_bytes(&link, b"new").unwrap();
        assert_eq!(fs::read(real).unwrap(), b"new");
        assert!(link.is_symlink());
    }
    let circle = link("circle", "circle");
    assert_eq!(destination(&circle).file_name(), circle.file_name());
    assert!(write_bytes(&circle, b"x").is_err() && circle.is_symlink());
}

#[cfg(unix)]
#[test]
fn what_a_new_file_would_lose_is_kept() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
    let (folder, target) = folder(b"a longer text");
    let twin = folder.path().join("b");
    fs::hard_link(&target, &twin).unwrap();
    write_bytes(&target, b"new").unwrap();
    assert_eq!(fs::read(&twin).unwrap(), b"new");
    fs::remove_file(&twin).unwrap();
    for mode in [0o600, 0o640, 0o666] {
        fs::set_permissions(&target, PermissionsExt::from_mode(mode)).unwrap();
        write_bytes(&target, b"new").unwrap();
        assert_eq!(
            fs::metadata(&target).unwrap().permissions().mode() & 0o777,
            mode
        );
    }
    // Another owner, if the tests may give files away.
    if chown(&target, Some(12345), Some(54321)).is_ok() {
        write_bytes(&target, b"newer").unwrap();
        let meta = fs::metadata(&target).unwrap();
        assert_eq!((meta.uid(), meta.gid()), (12345, 54321));
        assert_eq!(fs::read(&target).unwrap(), b"newer");
    }
    assert_eq!(names(&folder), ["a"]);
}

#[test]
fn names_that_windows_takes_for_devices() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["nul.png", "NUL", "a/Com1.tar.exr", "lpt9 .png"] {
        assert!(is_of_device(Path::new(name)), "{name}");
    }
    for name in ["null.png", "com.png", "com10.png", "nul/a.png"] {
        assert!(!is_of_device(Path::new(name)), "{name}");
    }
    // Other systems have no such names.
    let written = write_bytes(&folder.path().join("nul.png"), b"x");
    assert_eq!(written.is_err(), cfg!(windows));
    let refusal = written.err().map_or(String::new(), |e| e.to_string());
    assert!(refusal.is_empty() || refusal.contains("is the name of a device"));
    assert_eq!(names(&folder).is_empty(), cfg!(windows));
}

/// Windows refuses to replace a file that a program has open without sharing it.
#[cfg(windows)]
#[test]
fn a_file_that_is_open_elsewhere_is_named() {
    use std::os::windows::fs::OpenOptionsExt;
    let (folder, target) = folder(b"old");
    let open = OpenOptions::new()
        .read(true)
        .share_mode(1)
        .open(&target)
        .unwrap();
    let error = write_bytes(&target, b"new").unwrap_err().to_string();
    assert!(
        error.contains("a: ") && (error.contains("open") || error.contains("used by")),
        "{error}"
    );
    drop(open);
    assert_eq!(fs::read(&target).unwrap(), b"old");
    assert_eq!(names(&folder), ["a"]);
}
