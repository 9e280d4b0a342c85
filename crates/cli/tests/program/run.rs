//! Runs of the program in a folder of their own.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Output};
use tempfile::TempDir;

pub const CAMERA: &str = "[camera]\neye = [2, 0, 0.5]\ntarget = [0, 0, 0.5]\n";
pub const CONE: &str = "[[object]]\npolygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\n";

/// A folder with the files of one case, and runs of the program in it.
pub struct Bench {
    folder: TempDir,
}

impl Bench {
    pub fn new() -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        bench.file("scene.toml", format!("{CAMERA}{CONE}"));
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// A scene of one object with the given lines.
    pub fn object(&self, lines: &str) {
        self.file("scene.toml", format!("{CAMERA}[[object]]\n{lines}\n"));
    }

    pub fn grey(&self, name: &str, width: u32, height: u32, shade: impl Fn(u32, u32) -> u8) {
        image::GrayImage::from_fn(width, height, |x, y| image::Luma([shade(x, y)]))
            .save(self.path(name))
            .unwrap();
    }

    pub fn command<I: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = I>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_revmap"));
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .env_remove("RUST_BACKTRACE")
            .env_remove("REVMAP_DEVICE");
        command
    }

    /// Names of all that lies in the folder.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Runs and wants `code`, exactly one line on standard error with all of `words`, nothing on
    /// standard output, and no file made.
    #[track_caller]
    pub fn refused(&self, arguments: &str, code: i32, words: &[&str]) {
        self.refused_by(&mut self.command(arguments.split(' ')), code, words);
    }

    #[track_caller]
    pub fn refused_by(&self, command: &mut Command, code: i32, words: &[&str]) {
        let before = self.names();
        let output = command.output().unwrap();
        let said = lines(&output);
        assert_eq!(output.status.code(), Some(code), "{said:?}");
        assert_eq!(said.len(), 1, "{said:?}");
        for word in words {
            assert!(said[0].contains(word), "no {word:?} in {:?}", said[0]);
        }
        assert!(!said[0].contains("a bug of revmap"), "{said:?}");
        assert!(output.stdout.is_empty());
        assert_eq!(self.names(), before);
    }

    #[track_caller]
    pub fn done(&self, arguments: &str) -> Output {
        let output = self.command(arguments.split(' ')).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
        output
    }
}

/// What a run wrote to standard error.
pub fn lines(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stderr);
    text.lines().map(str::to_owned).collect()
}
