//! Faults of folders' searches that only a frame or a scene shows.

use super::compile::{NO_NUMBER, WRONG_VALUE};
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::scene::Scene;
use revmap::settings::Solver;

/// Checks a frame with every plane, as [`Planes::All`](revmap::settings::Planes::All) draws it.
///
/// # Errors
/// [`ErrorKind::Content`] if a search returned a value that is none of its interface, or a hit that
/// is no number.
pub fn check_frame(solver: Solver, frame: &Frame) -> Result<()> {
    let Some(folder) = super::of(solver) else {
        return Ok(());
    };
    let count = |least: u32, most: u32| {
        let within = |steps: &&f32| (least as f32..most as f32).contains(*steps);
        frame.steps.iter().filter(within).count()
    };
    let message = match [count(WRONG_VALUE, u32::MAX), count(NO_NUMBER, WRONG_VALUE)] {
        [0, 0] => return Ok(()),
        [0, numbers] => format!(
            "the search returned a hit that is no number (NaN or infinite) in {numbers} pixels; look for a division by zero or a root of a negative number"
        ),
        [values, _] => format!(
            "the search returned a wrong value in {values} pixels; return FOUND, LEFT, NEARLY or EXHAUSTED"
        ),
    };
    Err(Error::new(ErrorKind::Content, message).in_file(folder.glsl()))
}

/// Checks that a search draws the solids of a scene.
///
/// # Errors
/// [`ErrorKind::Content`] for a bevel, if the search draws none.
pub fn check_scene(solver: Solver, scene: &Scene) -> Result<()> {
    let refuses = super::of(solver).is_some_and(|folder| !folder.manifest.bevels);
    let beveled = |o: &&revmap::scene::Object| o.offset.bevel != 0.0 && o.offset.chamfer > 0.0;
    match scene.objects.iter().find(beveled) {
        Some(object) if refuses => {
            let message = format!(
                "{} has a bevel, which {solver} does not draw (bevels = false in its search.toml)",
                object.name
            );
            Err(Error::new(ErrorKind::Content, message))
        }
        _ => Ok(()),
    }
}
