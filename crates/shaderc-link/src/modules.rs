//! Packed SPIR-V for build scripts: each module of a list is compiled from GLSL with the feature
//! `shaderc`, and read from the folder of kept modules without it. With the variable
//! `REVMAP_KEEP_SPIRV=1` what is compiled is kept.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// What a step of a build script gives.
pub type Fallible<T> = Result<T, Box<dyn Error>>;

/// The ending of packed modules.
pub const ENDING: &str = "spv.z";

/// Does the work of a build script; each line of an error is one of cargo's.
pub fn run(work: impl FnOnce() -> Fallible<()>) {
    println!("cargo::rerun-if-changed=build.rs");
    if let Err(error) = work() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

/// One module.
pub struct Module {
    /// Its name, and that of its kept file.
    pub name: String,
    /// Its entry file.
    pub entry: &'static str,
    /// What it is compiled with.
    pub macros: Vec<(&'static str, &'static str)>,
    /// An included file, and the file that is read in its place.
    pub hook: Option<(&'static str, &'static str)>,
    /// Whether its words are optimised, which leaves out names.
    pub optimized: bool,
}

/// Modules, and where their GLSL is. Of two folders that hold a file the first is read.
pub struct Modules<'a> {
    /// Folders of entry files.
    pub entries: &'a [&'a str],
    /// Folders of included files.
    pub includes: &'a [&'a str],
    /// The folder of kept modules.
    pub kept: &'a str,
    /// The modules.
    pub all: Vec<Module>,
}

impl Modules<'_> {
    /// Writes the packed modules into the output folder, and returns Rust code for a file there: the
    /// modules, and hashes of `sources` and of the compiler.
    pub fn embed(&self, sources: &[PathBuf]) -> Fallible<String> {
        println!("cargo::rerun-if-env-changed=REVMAP_KEEP_SPIRV");
        println!("cargo::rerun-if-changed={}", self.kept);
        let mut hash = Fnv::default();
        for file in sources {
            println!("cargo::rerun-if-changed={}", file.display());
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            hash.add(name.as_bytes());
            hash.add_code(&fs::read_to_string(file)?);
        }
        let (hash, compiler) = (hash.0, compiler()?);
        if keeps() {
            fs::create_dir_all(self.kept)?;
            // Those that the list no longer has must not stay.
            for old in files_in(self.kept, &["spv", "z"])? {
                fs::remove_file(old)?;
            }
            let hashes = format!("{hash:#018x}\n{compiler:#018x}\n");
            fs::write(Path::new(self.kept).join("sources.fnv"), hashes)?;
        }
        let out = PathBuf::from(std::env::var("OUT_DIR")?);
        let mut list = String::new();
        for (module, bytes) in self.all.iter().zip(self.packed()?) {
            let file = format!("{}.{ENDING}", module.name);
            fs::write(out.join(&file), bytes)?;
            write!(list, "include_bytes!({file:?}), ")?;
        }
        let mut text = String::new();
        writeln!(
            text,
            "/// Each module, packed, in the order of the list.\npub(crate) static MODULES: &[&[u8]] = &[{list}];\n\n\
             /// FNV-1a of all sources without comments.\npub const SOURCES_HASH: u64 = {hash:#018x};\n\n\
             /// FNV-1a of what the compiler makes of a fixed probe: tells compilers apart; 0 where none was used.\n\
             pub const COMPILER_HASH: u64 = {compiler:#018x};\n"
        )?;
        Ok(text)
    }

    #[cfg(not(feature = "shaderc"))]
    fn packed(&self) -> Fallible<Vec<Vec<u8>>> {
        let kept = |module: &Module| {
            let path = Path::new(self.kept).join(format!("{}.{ENDING}", module.name));
            Ok(fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?)
        };
        self.all.iter().map(kept).collect()
    }

    #[cfg(feature = "shaderc")]
    fn packed(&self) -> Fallible<Vec<Vec<u8>>> {
        self.each(|module, words| {
            let bytes = packed(words);
            if keeps() {
                let path = Path::new(self.kept).join(format!("{}.{ENDING}", module.name));
                fs::write(path, &bytes).map_err(|e| e.to_string())?;
            }
            Ok(bytes)
        })
    }

    /// The words of every module.
    #[cfg(feature = "shaderc")]
    pub fn compiled(&self) -> Fallible<Vec<Vec<u32>>> {
        self.each(|_, words| Ok(words.to_vec()))
    }

    /// What `make` gives for the words of each module. Compiles on every core: modules are many.
    #[cfg(feature = "shaderc")]
    fn each<T: Send>(
        &self,
        make: impl Fn(&Module, &[u32]) -> Result<T, String> + Sync,
    ) -> Fallible<Vec<T>> {
        use std::sync::atomic::{AtomicUsize, Ordering};
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let next = AtomicUsize::new(0);
        let work = || {
            // One compiler keeps what it has read of the language.
            let compiler = crate::Compiler::new().map_err(|e| e.to_string())?;
            let numbers = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
            let modules = numbers.map_while(|n| Some((n, self.all.get(n)?)));
            let made = modules.map(|(n, module)| {
                let words = self.words(&compiler, module).map_err(|e| e.to_string());
                let made = words.and_then(|words| make(module, &words));
                (n, made.map_err(|e| format!("{}: {e}", module.name)))
            });
            Ok::<Vec<_>, String>(made.collect())
        };
        let mut done = std::thread::scope(|scope| -> Fallible<Vec<_>> {
            let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            let mut done = Vec::new();
            for thread in threads {
                let made = thread.join().map_err(|_| "a thread of the compiler died")?;
                done.extend(made?);
            }
            Ok(done)
        })?;
        done.sort_by_key(|(n, _)| *n);
        let in_order = done.into_iter().map(|(_, made)| made);
        Ok(in_order.collect::<Result<_, _>>()?)
    }

    #[cfg(feature = "shaderc")]
    fn words(&self, compiler: &crate::Compiler, module: &Module) -> Fallible<Vec<u32>> {
        let (path, text) = read(self.entries, module.entry)?;
        let include = |wanted: &str| match module.hook {
            Some((included, file)) if included == wanted => read(self.includes, file),
            _ => read(self.includes, wanted),
        };
        let level = if module.optimized {
            crate::OptimizationLevel::Performance
        } else {
            crate::OptimizationLevel::Zero
        };
        let made = crate::spirv(compiler, (&path, &text), &module.macros, level, include)?;
        Ok(made.as_binary().to_vec())
    }
}

/// Rust code of a list of names and texts: GLSL of the folder `root` for programs that compile. Names
/// are those in `#include`. The list is empty without the feature `shaderc`.
pub fn texts(root: &str, sources: &[PathBuf]) -> Fallible<String> {
    let mut files = String::new();
    for path in sources.iter().filter(|_| cfg!(feature = "shaderc")) {
        let (name, full) = (name_in_include(root, path)?, path.canonicalize()?);
        writeln!(files, "({name:?}, include_str!({full:?})),")?;
    }
    Ok(format!("&[{files}]"))
}

/// The name by which GLSL includes a file of the folder `root`: with `/` also on systems that write
/// another sign between folders.
fn name_in_include(root: &str, path: &Path) -> Fallible<String> {
    let name = path.strip_prefix(root)?;
    let name = name.strip_prefix("include").unwrap_or(name);
    let parts = name
        .components()
        .map(|part| part.as_os_str().to_string_lossy());
    Ok(parts.collect::<Vec<_>>().join("/"))
}

/// The files of a folder with one of these endings, in order.
pub fn files_in(folder: impl AsRef<Path>, endings: &[&str]) -> Fallible<Vec<PathBuf>> {
    let has_ending = |path: &PathBuf| {
        let ending = path.extension();
        ending.is_some_and(|e| endings.iter().any(|ending| e == *ending))
    };
    let mut files: Vec<_> = fs::read_dir(folder)?
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(has_ending)
        .collect();
    files.sort();
    Ok(files)
}

/// A file's path and text.
#[cfg(feature = "shaderc")]
fn read(folders: &[&str], wanted: &str) -> Result<(String, String), String> {
    let path = folders
        .iter()
        .map(|folder| Path::new(folder).join(wanted))
        .find(|path| path.exists())
        .ok_or_else(|| format!("{wanted}: there is no such file"))?;
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok((path.to_string_lossy().into_owned(), text))
}

fn keeps() -> bool {
    cfg!(feature = "shaderc") && std::env::var_os("REVMAP_KEEP_SPIRV").is_some_and(|v| v == "1")
}

/// Words as seven bits a byte, most of them being small; then deflated. The third word of each
/// instruction, mostly the id of a result, is its difference from that of the instruction before.
#[cfg(feature = "shaderc")]
fn packed(words: &[u32]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(2 * words.len());
    let mut small = words.to_vec();
    let (mut begin, mut last) = (5, 0); // behind the header of SPIR-V
    while let Some(count) = words.get(begin).map(|first| (first >> 16) as usize) {
        if let (3.., Some(word)) = (count, words.get(begin + 2)) {
            let change = word.wrapping_sub(last).cast_signed();
            small[begin + 2] = (change << 1 ^ change >> 31).cast_unsigned();
            last = *word;
        }
        begin += count.max(1);
    }
    for mut word in small {
        while word >= 128 {
            bytes.push((word & 127) as u8 | 128);
            word >>= 7;
        }
        bytes.push(word as u8);
    }
    miniz_oxide::deflate::compress_to_vec(&bytes, 9)
}

#[cfg(not(feature = "shaderc"))]
fn compiler() -> Fallible<u64> {
    Ok(0)
}

/// Versions of shaderc that share a generator word make other words of the same text; a probe with some of everything shows it.
#[cfg(feature = "shaderc")]
fn compiler() -> Fallible<u64> {
    const PROBE: &str = "#version 450
        struct S { vec4 a; uvec4 b; };
        layout(local_size_x = 8) in;
        layout(constant_id = 0) const uint K = 3u;
        layout(set = 0, binding = 0, std140) uniform U { S s; mat4 m; } u;
        layout(set = 0, binding = 1, std430) buffer B { uint w[]; };
        layout(set = 0, binding = 2) uniform sampler2D t[2];
        bool f(inout S s, vec3 v) { s.a = u.m * vec4(v, 1.0); return any(lessThan(v, s.a.xyz)) && K != 0u; }
        void main() {
            S s = u.s;
            for (uint i = 0u; i < K; ++i) {
                if (f(s, textureGather(t[i & 1u], s.a.xy).xyz)) { break; }
                s.b.x += findLSB(int(i)) > 0 ? 1u : w[i];
            }
            atomicAdd(w[gl_GlobalInvocationID.x], s.b.x);
        }";
    let compiler = crate::Compiler::new()?;
    let level = crate::OptimizationLevel::Zero;
    let none = |wanted: &str| Err(format!("{wanted}: the probe includes nothing"));
    let made = crate::spirv(&compiler, ("probe", PROBE), &[], level, none)?;
    Ok(Fnv::of([made.as_binary_u8()]))
}

/// FNV-1a, a hash of 64 bits.
pub struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    /// The hash of some parts, one after another.
    pub fn of<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> u64 {
        let mut hash = Self::default();
        parts.into_iter().for_each(|part| hash.add(part));
        hash.0
    }

    /// The hash of what was added.
    pub fn value(&self) -> u64 {
        self.0
    }

    /// Adds the lines of a source without comments, indents and empty lines.
    fn add_code(&mut self, text: &str) {
        for line in text.lines() {
            let code = line.split("//").next().unwrap_or_default().trim();
            if !code.is_empty() {
                self.add(code.as_bytes());
                self.add(b"\n");
            }
        }
    }

    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.0 = (self.0 ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn comments_do_not_change_the_hash_of_a_source() {
        let hash = |text: &str| {
            let mut hash = Fnv::default();
            hash.add_code(text);
            hash.value()
        };
        let plain = hash("float a;\n    float b;\n");
        assert_eq!(plain, hash("// Two.\n\nfloat a; // one\nfloat b;\n"));
        assert_ne!(plain, hash("float a;\nfloat c;\n"));
        assert_ne!(plain, hash("float a; float b;\n"));
    }

    #[test]
    fn names_of_includes_have_slashes_on_every_system() {
        const ROOT: &str = "../shaders";
        for (parts, wanted) in [
            (["include/core", "hit.glsl"], "core/hit.glsl"),
            (["include//stage", "tile.glsl"], "stage/tile.glsl"),
            ([".", "tree.frag"], "tree.frag"),
        ] {
            let mut path = PathBuf::from(ROOT);
            path.extend(parts);
            assert_eq!(name_in_include(ROOT, &path).unwrap(), wanted);
        }
        assert!(name_in_include(ROOT, Path::new("elsewhere/hit.glsl")).is_err());
    }
}
