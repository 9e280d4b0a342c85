//! Changes that are undone at once.

/// A change that continues over several frames, and is undone at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// A drag with a button held: of a slider, or of the camera.
    Held,
    /// Turns of the wheel, until another value changes.
    Wheel,
}
