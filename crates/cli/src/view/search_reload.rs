//! The search of a folder, read and compiled again on a thread when one of its files changes.

use eframe::egui::Context;
use revmap::error::Result;
use revmap::settings::Solver;
use revmap_searches::folder;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, SystemTime};

/// Time between two checks of the files.
const PAUSE: Duration = Duration::from_millis(500);

/// Watches the folder of a search; `None` for searches of crates. The receiver gets the search after
/// each change, or what is wrong with it, and the window wakes.
pub fn watch(solver: Solver, context: Context) -> Option<Receiver<Result<Solver>>> {
    let mut folder = folder::of(solver)?;
    let mut before = stamps(folder);
    let (send, changed) = channel();
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(PAUSE);
            let now = stamps(folder);
            if now == before {
                continue;
            }
            before = now;
            let made = folder::reload(&folder.spec);
            let made = made.and_then(|solver| folder::compile(solver).map(|()| solver));
            if let Some(new) = made.as_ref().ok().and_then(|solver| folder::of(*solver)) {
                folder = new;
                before = stamps(folder); // it may include other files
            }
            if send.send(made).is_err() {
                return; // the window is closed
            }
            context.request_repaint();
        }
    });
    Some(changed)
}

/// The times of the folder's files.
fn stamps(folder: &folder::Folder) -> Vec<Option<SystemTime>> {
    let time = |file| std::fs::metadata(file).and_then(|m| m.modified()).ok();
    folder.files().map(time).collect()
}
