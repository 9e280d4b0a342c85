//! Shaders that follow their sources while the window is open. The GLSL files are watched; when one
//! has changed, what the window draws with is compiled in the background, and taken when all of it
//! compiles. What is drawn with stays otherwise.

use super::scene_renderer::SceneRenderer;
use super::shown::Shown;
use super::vulkan::Vulkan;
use crate::output;
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Device, ShaderSource};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};
use winit::event_loop::EventLoopProxy;

/// The folder that is watched where none is named: that of the source tree.
pub const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders-glsl");
/// Folders in it that hold sources, and the files' endings.
const PARTS: [&str; 4] = ["", "include/core", "include/search", "include/stage"];
const ENDINGS: [&str; 4] = ["vert", "frag", "comp", "glsl"];
/// Numbers that Rust knows, too.
const SHARED: &str = "include/core/variant.glsl";
const BUILT: &str = include_str!("../../../../shaders-glsl/include/core/variant.glsl");
/// How often files are looked at.
const PAUSE: Duration = Duration::from_secs(1);

/// The texts of a folder's files, by their paths in it.
#[derive(Clone)]
struct Sources {
    folder: PathBuf,
    texts: HashMap<String, String>,
}

/// A device and a renderer on it with shaders of their own.
type Made = (Device, SceneRenderer);

pub struct Reload {
    changed: Receiver<Result<Sources>>,
    /// What has changed since what is being compiled.
    next: Option<Sources>,
    making: Option<JoinHandle<Result<Made>>>,
    /// Tells the compiling thread that nobody waits for it.
    given_up: Arc<AtomicBool>,
    wake: EventLoopProxy<()>,
    /// Why the last sources are not drawn with.
    pub problem: Option<String>,
}

impl Reload {
    /// Watches a folder, and calls the window when it has something.
    pub fn new(folder: &Path, wake: EventLoopProxy<()>) -> Self {
        let (send, changed) = channel();
        let (folder, call) = (folder.to_owned(), wake.clone());
        std::thread::spawn(move || {
            let mut before = None;
            loop {
                let now = stamps(&folder);
                if before.as_ref() != Some(&now) {
                    before = Some(now);
                    let sources = Sources::read(&folder);
                    if send.send(sources).is_err() || call.send_event(()).is_err() {
                        return; // the window is closed
                    }
                }
                std::thread::sleep(PAUSE);
            }
        });
        Self {
            changed,
            next: None,
            making: None,
            given_up: Arc::default(),
            wake,
            problem: None,
        }
    }

    /// Whether shaders are being compiled.
    pub fn is_busy(&self) -> bool {
        self.making.is_some()
    }

    /// What the window is to draw with from now on, if that is new. `format` is that of its
    /// pictures.
    pub fn take(&mut self, host: &Vulkan, format: vk::Format, shown: &Shown) -> Option<Made> {
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
            match self.make(host, sources, format, shown.clone()) {
                Ok(thread) => self.making = Some(thread),
                Err(error) => self.fail(error.to_string()),
            }
        }
        made
    }

    /// Says why sources are not drawn with, in the window and on standard error.
    fn fail(&mut self, problem: String) {
        output::warn(&problem);
        self.problem = Some(problem);
    }

    /// Begins to compile what is shown.
    fn make(
        &self,
        host: &Vulkan,
        sources: Sources,
        format: vk::Format,
        shown: Shown,
    ) -> Result<JoinHandle<Result<Made>>> {
        let device = host.lend(Some(sources.compiled(self.given_up.clone())?))?;
        let wake = self.wake.clone();
        Ok(std::thread::spawn(move || {
            let make = || {
                let by = (shown.stage, shown.search);
                let mut drawn = SceneRenderer::new(&device, format, by)?;
                drawn.set(&shown.scene)?;
                drawn.renderer.prewarm()?.compile()?;
                Ok(drawn)
            };
            let made = make();
            // A window that was closed meanwhile wants nothing any more.
            let _ = wake.send_event(());
            made.map(|drawn| (device, drawn))
        }))
    }
}

impl Drop for Reload {
    /// The device must outlive what is made on it.
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

    /// Compiles modules as they are asked for, each once.
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
            let name = entry
                .map_err(|e| unreadable(&within, &e))?
                .file_name()
                .to_string_lossy()
                .into_owned();
            if ENDINGS.iter().any(|e| name.ends_with(&format!(".{e}"))) {
                let slash = if part.is_empty() { "" } else { "/" };
                names.push(format!("{part}{slash}{name}"));
            }
        }
    }
    names.sort();
    Ok(names)
}

/// What tells one state of the files from another.
fn stamps(folder: &Path) -> Vec<(String, Option<(SystemTime, u64)>)> {
    let stamp = |name: String| {
        let file = std::fs::metadata(folder.join(&name));
        let stamp = file.and_then(|f| Ok((f.modified()?, f.len()))).ok();
        (name, stamp)
    };
    names(folder)
        .unwrap_or_default()
        .into_iter()
        .map(stamp)
        .collect()
}

#[cfg(test)]
mod tests;
