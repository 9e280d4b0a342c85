//! The choice between Wayland and X11: a Wayland display that nothing serves does not hide X11.

use eframe::EventLoopBuilderHook;

/// The variable that names the Wayland display.
const WAYLAND: &str = "WAYLAND_DISPLAY";

/// Why no window can be opened, and the remedy. Of winit's causes the place in its source is cut.
pub fn refusal(cause: &str) -> String {
    let place = cause.split_once(" at ").zip(cause.split_once(".rs:"));
    let cause = place.map_or(cause.to_owned(), |((fault, _), (_, why))| {
        let why = why.split_once(": ").map_or(why, |(_, why)| why);
        format!("{fault}: {why}")
    });
    let remedy = match is_set(WAYLAND) {
        true => "unset WAYLAND_DISPLAY, or set it and DISPLAY to screens that are there",
        false => "set DISPLAY or WAYLAND_DISPLAY",
    };
    format!("no screen ({cause}); {remedy}")
}

/// A choice of X11, if a Wayland display is named that no program serves, and an X11 display too.
#[cfg(target_os = "linux")]
pub fn event_loop() -> Option<EventLoopBuilderHook> {
    use winit::platform::x11::EventLoopBuilderExtX11;
    let stale = is_set(WAYLAND) && !is_set("WAYLAND_SOCKET") && !answers();
    let x11 = |builder: &mut winit::event_loop::EventLoopBuilder<eframe::UserEvent>| {
        builder.with_x11();
    };
    (stale && is_set("DISPLAY")).then(|| -> EventLoopBuilderHook { Box::new(x11) })
}

#[cfg(not(target_os = "linux"))]
pub fn event_loop() -> Option<EventLoopBuilderHook> {
    None
}

fn is_set(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| !value.is_empty())
}

/// Returns true if a program listens on the Wayland display's socket.
#[cfg(target_os = "linux")]
fn answers() -> bool {
    let folder = std::path::PathBuf::from(std::env::var_os("XDG_RUNTIME_DIR").unwrap_or_default());
    // A name that is an absolute path stays as it is.
    let socket = folder.join(std::env::var_os(WAYLAND).unwrap_or_default());
    std::os::unix::net::UnixStream::connect(socket).is_ok()
}
