//! A picture of each real profile, inspected and stored. `REVMAP_BLESS=1 cargo test --test gpu
//! golden` stores new ones: inspect them before the commit. A missing picture fails.

use crate::common::{draw, sized};
use std::path::PathBuf;

/// The allowed difference of an 8-bit channel, and the share of all channels that may exceed it.
/// Drivers round differently, and a silhouette may fall to either side of a pixel's centre
/// (measured: llvmpipe 22.3.6 against SwiftShader).
const TOLERANCE: (u8, f64) = (3, 0.002);

#[test]
fn real_profiles_look_as_they_did() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let bless = std::env::var_os("REVMAP_BLESS").is_some_and(|v| v == "1");
    let mut failures = Vec::new();
    for name in ["pawn", "bishop", "king", "rook", "bottle"] {
        let scene = revmap_files::scene(root.join(format!("assets/scenes/{name}.toml"))).unwrap();
        let frame = draw(&scene, &sized(320, 240));
        let golden = root.join(format!("tests/golden/{name}.png"));
        if bless {
            std::fs::create_dir_all(golden.parent().unwrap()).unwrap();
            revmap_files::write_png(&frame, &golden).unwrap();
            continue;
        }
        let folder = tempfile::tempdir().unwrap();
        let drawn = folder.path().join("drawn.png");
        revmap_files::write_png(&frame, &drawn).unwrap();
        let open = |path: &PathBuf| {
            image::open(path)
                .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
                .into_rgba8()
                .into_raw()
        };
        let (kept, drawn) = (open(&golden), open(&drawn));
        assert_eq!(kept.len(), drawn.len(), "{name}");
        let far = |(a, b): &(&u8, &u8)| a.abs_diff(**b) > TOLERANCE.0;
        let off = kept.iter().zip(&drawn).filter(far).count();
        let what = format!("{name}: {off} of {} channels differ", kept.len());
        println!("{what}");
        if off as f64 / kept.len() as f64 > TOLERANCE.1 {
            failures.push(what);
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
