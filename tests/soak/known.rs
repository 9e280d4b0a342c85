//! Faults of the library that the host avoids.

/// Name of a fault, and true once it is mended: the host then does what showed it.
pub const KNOWN: [(&str, bool); 8] = [
    // A slot that is prepared twice in one command buffer, with new textures in the first.
    ("prepared twice", true),
    // The copies of new textures are lost with a command buffer that is not submitted.
    ("never submitted", true),
    // `prepare` that fails loses copies of textures, and hides new objects.
    ("failed prepare", true),
    // A viewport that begins left of the picture or above it.
    ("viewport outside", true),
    // The second `record_compute` of a frame clears bins that the first may still read.
    ("recorded twice", true),
    // `prepare` compiles pipelines that `prewarm` has left out, or hides their content.
    ("prewarm", true),
    // `record_prewarm` binds sets of textures that no slot keeps.
    ("record prewarm", true),
    // Under shadows, the search of every object depends on facts of all objects. `remove` does not
    // find these facts again.
    ("removed under shadows", true),
];

/// Names of faults that are taken as mended in this run, separated by commas.
const VARIABLE: &str = "REVMAP_SOAK_MENDED";

/// Returns true if the host need not avoid a fault.
pub fn mended(name: &str) -> bool {
    let known = KNOWN.iter().find(|(known, _)| *known == name);
    let tried = std::env::var(VARIABLE).unwrap_or_default();
    known.expect("a name of KNOWN").1 || tried.split(',').any(|one| one == name)
}
