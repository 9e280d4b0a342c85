//! Runs of the program in a folder of their own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

pub const CAMERA: &str = "[camera]\neye = [2, 0, 0.5]\ntarget = [0, 0, 0.5]\n";
/// A drawing that is symmetric about its middle.
pub const SVG: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='20' height='40'><path d='M8,5h4v35h-4z'/></svg>";
pub const CONE: &str = "[[object]]\npolygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\n";

/// A folder with the files of one case, and runs of the program in it.
pub struct Bench {
    folder: TempDir,
    /// Variables of the environment.
    variables: BTreeMap<&'static str, String>,
}

impl Bench {
    pub fn new() -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
            variables: BTreeMap::new(),
        };
        bench.file("scene.toml", format!("{CAMERA}{CONE}"));
        bench
    }

    /// Sets a variable of the environment.
    pub fn set(&mut self, name: &'static str, value: impl Into<String>) {
        self.variables.insert(name, value.into());
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

    /// A picture of half a profile.
    pub fn half(&self, name: &str) {
        let solid = |x, y| x < 12 && y > 5;
        self.grey(name, 20, 40, |x, y| if solid(x, y) { 0 } else { 255 });
    }

    /// The program with a command line. Its word `@NAME` is a file of `assets/`.
    pub fn command(&self, arguments: &str) -> Command {
        let word = |word: &str| word.strip_prefix('@').map_or(word.to_owned(), asset);
        let mut command = Command::new(env!("CARGO_BIN_EXE_revmap"));
        command
            .args(arguments.split_whitespace().map(word))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .env_remove("RUST_BACKTRACE")
            .env_remove("REVMAP_DEVICE")
            .envs(&self.variables);
        command
    }

    /// The same command behind a launcher, which passes its own environment and folder on.
    pub fn launched(&self, launcher: &[&str], arguments: &str) -> Command {
        let program = self.command(arguments);
        let mut command = Command::new(launcher[0]);
        command.args(&launcher[1..]).arg(program.get_program());
        command.args(program.get_args()).current_dir(self.path(""));
        for (name, value) in program.get_envs() {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        command
    }

    /// The same command with HUP as the system has it, also where `nohup` runs the tests.
    pub fn heeding_signals(&self, arguments: &str) -> Command {
        self.launched(&["env", "--default-signal=HUP"], arguments)
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
        self.refused_by(&mut self.command(arguments), code, words);
    }

    /// Wants each line of a table refused: a command line, then words of the message.
    #[track_caller]
    pub fn refuses(&self, code: i32, lines: &str) {
        for row in table(lines) {
            self.refused(row[0], code, &row[1..]);
        }
    }

    #[track_caller]
    pub fn refused_by(&self, command: &mut Command, code: i32, words: &[&str]) {
        let before = self.names();
        let output = command.output().unwrap();
        let said = lines(&output);
        assert_eq!(output.status.code(), Some(code), "{said:?}");
        assert_eq!(said.len(), 1, "{said:?}");
        holds(&said[0], words);
        assert!(!said[0].contains("a bug of revmap"), "{said:?}");
        assert!(output.stdout.is_empty());
        assert_eq!(self.names(), before);
    }

    pub fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    #[track_caller]
    pub fn done(&self, arguments: &str) -> Output {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
        output
    }

    /// What a run that is done wrote to standard output.
    #[track_caller]
    pub fn said(&self, arguments: &str) -> String {
        String::from_utf8(self.done(arguments).stdout).unwrap()
    }

    /// Wants files in the folder.
    #[track_caller]
    pub fn has(&self, files: &[&str]) {
        for file in files {
            assert!(self.path(file).exists(), "{file}");
        }
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    pub fn picture(&self, name: &str) -> image::RgbaImage {
        image::open(self.path(name)).unwrap().into_rgba8()
    }

    /// Warnings of a run that is done.
    #[track_caller]
    pub fn warned(&self, arguments: &str) -> Vec<String> {
        let said = lines(&self.done(arguments)).into_iter();
        said.filter(|l| l.starts_with("warning: ")).collect()
    }

    /// Wants one warning with all of `words`.
    #[track_caller]
    pub fn warned_once(&self, arguments: &str, words: &[&str]) {
        let found = self.warned(arguments);
        assert_eq!(found.len(), 1, "{found:?}");
        holds(&found[0], words);
    }

    /// Exit code and lines on standard error of a run.
    pub fn ended(&self, arguments: &str) -> (Option<i32>, Vec<String>) {
        let output = self.run(arguments);
        (output.status.code(), lines(&output))
    }
}

/// A file of `assets/`.
pub fn asset(name: &str) -> String {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    assets.join(name).to_str().unwrap().to_owned()
}

/// The rows of a table: a line each, with `|` between cells.
pub fn table(lines: &str) -> impl Iterator<Item = Vec<&str>> {
    let cells = |line| str::split(line, '|').map(str::trim).collect();
    lines.trim().lines().map(cells)
}

/// Wants all of these words in a text.
#[track_caller]
pub fn holds(text: &str, words: &[&str]) {
    let missing = words.iter().find(|word| !text.contains(**word));
    assert_eq!(missing, None, "not in {text}");
}

/// What a run wrote to standard error.
pub fn lines(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stderr);
    text.lines().map(str::to_owned).collect()
}
