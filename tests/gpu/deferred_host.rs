//! The host of `examples/deferred`: its own G-buffer, light and temporal anti-aliasing.

#[path = "../../examples/deferred/main.rs"]
mod deferred;

/// With motion vectors the picture is much nearer to the mean of 64 frames; validation is silent.
#[test]
fn motion_vectors_prevent_ghosts() {
    let folder = tempfile::tempdir().unwrap();
    let [with, without] = deferred::run(folder.path().to_str().unwrap(), true).unwrap();
    println!("FLIP {with:.4} with motion vectors, {without:.4} without");
    assert!(with < 0.02 && with < 0.6 * without, "{with}, {without}");
}
