//! Shaders that are reloaded from their sources while the window is open. A thread watches the GLSL
//! files. After a change, the window's shaders are compiled in the background and used once all of
//! them compile. Until then the former shaders stay in use.
#![allow(unsafe_code)] // pipelines of other shaders

use super::search_reload::watched;
use super::shown::Shown;
use crate::output;
use eframe::egui::Context;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Device, ShaderSource};
use revmap_offscreen::Offscreen;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

/// The default folder to watch: that of the source tree.
pub const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders-glsl");
/// Its subfolders with sources, and the files' endings.
const PARTS: [&str; 4] = ["", "include/core", "include/search", "include/stage"];
const ENDINGS: [&str; 4] = ["vert", "frag", "comp", "glsl"];
/// The file whose numbers are also built into the Rust code.
const SHARED: &str = "include/core/variant.glsl";
const BUILT: &str = include_str!("../../../../shaders-glsl/include/core/variant.glsl");
/// Time between two checks of the files.
const PAUSE: Duration = Duration::from_secs(1);

/// The texts of a folder's files, by their paths in it.
#[derive(Clone)]
struct Sources {
    folder: PathBuf,
    texts: HashMap<String, String>,
}

pub struct Reload {
    changed: Receiver<Result<Sources>>,
    /// The latest change since the start of the current compilation.
    next: Option<Sources>,
    making: Option<JoinHandle<Result<Device>>>,
    /// True to make the compiling thread give up.
    given_up: Arc<AtomicBool>,
    context: Context,
    /// The reason why the last sources are not in use.
    pub problem: Option<String>,
}

impl Reload {
    /// Watches a folder, and wakes the window after a change.
    pub fn new(folder: &Path, context: Context) -> Self {
        let (folder, mut before) = (folder.to_owned(), None);
        let changed = watched(PAUSE, context.clone(), move || {
            let now = stamps(&folder);
            let is_new = before.as_ref() != Some(&now);
            before = Some(now);
            is_new.then(|| Sources::read(&folder))
        });
        Self {
            changed,
            next: None,
            making: None,
            given_up: Arc::default(),
            context,
            problem: None,
        }
    }

    /// Returns true while shaders are being compiled.
    pub fn is_busy(&self) -> bool {
        self.making.is_some()
    }

    /// The device with new shaders, if there are any. A window of this size then draws without
    /// compiling.
    pub fn take(&mut self, device: &Device, shown: &Shown, size: (u32, u32)) -> Option<Device> {
        while let Ok(sources) = self.changed.try_recv() {
            match sources {
                Ok(sources) => self.next = Some(sources),
                Err(error) => self.fail(error.to_string()),
            }
        }
        let mut made = None;
        if let Some(done) = self.making.take_if(|thread| thread.is_finished()) {
            match done.join() {
                Ok(Ok(new)) => {
                    output::note("the shaders compile: the window draws with them");
                    self.problem = None;
                    made = Some(new);
                }
                Ok(Err(error)) => self.fail(error.to_string()),
                Err(_) => self.fail("the compiling thread has died".into()),
            }
        }
        if self.making.is_none()
            && let Some(sources) = self.next.take()
        {
            match self.make(device, sources, shown.clone(), size) {
                Ok(thread) => self.making = Some(thread),
                Err(error) => self.fail(error.to_string()),
            }
        }
        made
    }

    /// Reports, in the window and on standard error, why sources are not in use.
    fn fail(&mut self, problem: String) {
        output::warn(&problem);
        self.problem = Some(problem);
    }

    /// Starts to compile the shaders of the shown scene.
    fn make(
        &self,
        device: &Device,
        sources: Sources,
        shown: Shown,
        size: (u32, u32),
    ) -> Result<JoinHandle<Result<Device>>> {
        let shaders = sources.compiled(self.given_up.clone())?;
        // SAFETY: the shaders are those of the source tree, as somebody works on them.
        let device = unsafe { device.with_shaders(shaders) }?;
        let context = self.context.clone();
        Ok(std::thread::spawn(move || {
            let settings = shown.settings(size);
            let made = Offscreen::new(&device, &shown.scene, &settings);
            let compiled = made.and_then(|mut made| made.prewarm());
            context.request_repaint();
            compiled.map(|()| device)
        }))
    }
}

impl Drop for Reload {
    /// The device must outlive the objects made on it.
    fn drop(&mut self) {
        self.given_up.store(true, Ordering::Relaxed);
        if let Some(thread) = self.making.take() {
            let _ = thread.join();
        }
    }
}

impl Sources {
    fn read(folder: &Path) -> Result<Self> {
        let mut texts = HashMap::new();
        for name in names(folder)? {
            let path = folder.join(&name);
            let text = std::fs::read_to_string(&path).map_err(|e| unreadable(&path, &e))?;
            texts.insert(name, text);
        }
        Ok(Self {
            folder: folder.to_owned(),
            texts,
        })
    }

    fn text(&self, name: &str) -> std::result::Result<(String, &str), String> {
        let path = self.folder.join(name).to_string_lossy().into_owned();
        match self.texts.get(name) {
            Some(text) => Ok((path, text)),
            None => Err(format!("{path}: there is no such file")),
        }
    }

    /// Compiles modules on demand, each once.
    fn compiled(self, given_up: Arc<AtomicBool>) -> Result<ShaderSource> {
        if self.texts.get(SHARED).map(String::as_str) != Some(BUILT) {
            let message = "holds numbers that the program was built with; build it anew";
            return Err(failed(message).in_file(self.folder.join(SHARED)));
        }
        let compiler = shaderc_link::Compiler::new().map_err(|e| failed(e.to_string()))?;
        let done: Mutex<HashMap<String, Vec<u32>>> = Mutex::default();
        Ok(Box::new(move |file, macros| {
            if given_up.load(Ordering::Relaxed) {
                return Err(failed("given up"));
            }
            let key = format!("{file} {macros:?}");
            let mut done = done.lock().map_err(|_| failed("the compiler has died"))?;
            if let Some(words) = done.get(&key) {
                return Ok(Some(words.clone()));
            }
            let (path, text) = self.text(file).map_err(failed)?;
            let include = |wanted: &str| {
                let (path, text) = self.text(&format!("include/{wanted}"))?;
                Ok((path, text.to_owned()))
            };
            let level = shaderc_link::OptimizationLevel::Performance;
            let made = shaderc_link::spirv(&compiler, (&path, text), macros, level, include);
            // Several lines, as the compiler gives them.
            let wrong = |e: shaderc_link::Error| Error {
                message: e.to_string(),
                ..failed("")
            };
            let words = made.map_err(wrong)?.as_binary().to_vec();
            done.insert(key, words.clone());
            Ok(Some(words))
        }))
    }
}

fn failed(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Other, message)
}

fn unreadable(path: &Path, error: &std::io::Error) -> Error {
    failed(format!("cannot be read ({error})")).in_file(path)
}

/// Names of a folder's sources, in order.
fn names(folder: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for part in PARTS {
        let within = folder.join(part);
        for entry in std::fs::read_dir(&within).map_err(|e| unreadable(&within, &e))? {
            let name = entry.map_err(|e| unreadable(&within, &e))?.file_name();
            let name = name.to_string_lossy();
            if ENDINGS.iter().any(|e| name.ends_with(&format!(".{e}"))) {
                let slash = if part.is_empty() { "" } else { "/" };
                names.push(format!("{part}{slash}{name}"));
            }
        }
    }
    names.sort();
    Ok(names)
}

/// Time and size of each file, which differ between two states of the files.
fn stamps(folder: &Path) -> Vec<(String, Option<(SystemTime, u64)>)> {
    let stamp = |name: String| {
        let file = std::fs::metadata(folder.join(&name));
        let stamp = file.and_then(|f| Ok((f.modified()?, f.len()))).ok();
        (name, stamp)
    };
    let names = names(folder).unwrap_or_default();
    names.into_iter().map(stamp).collect()
}

#[cfg(test)]
mod tests;
