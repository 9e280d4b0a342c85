//! The SPIR-V of the mesh baseline is kept beside its GLSL, so that no build needs a compiler of
//! shaders. It was made from today's sources; where the same compiler is here, word for word.
//!
//! After a change to the GLSL:
//! `REVMAP_KEEP_SPIRV=1 cargo test -p revmap-lab --features shaderc mesh_shaders`.

use std::path::{Path, PathBuf};

const ENTRIES: [&str; 3] = ["mesh.vert", "mesh_color.frag", "mesh_planes.frag"];
const INCLUDES: [&str; 2] = ["mesh.glsl", "shade.glsl"];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders")
}

/// FNV-1a.
fn hash<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let step = |h: u64, b: &u8| (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3);
    let all = parts.into_iter().flatten();
    format!("{:#018x}", all.fold(0xcbf2_9ce4_8422_2325, step))
}

fn sources_hash() -> String {
    let texts = ENTRIES
        .iter()
        .chain(&INCLUDES)
        .map(|name| std::fs::read(folder().join(name)).unwrap())
        .collect::<Vec<_>>();
    hash(texts.iter().map(Vec::as_slice))
}

/// The hashes of the sources and of the compiler's probe.
fn kept_hashes() -> Vec<String> {
    let text = std::fs::read_to_string(folder().join("spirv/sources.fnv")).unwrap();
    text.lines().map(str::to_owned).collect()
}

#[cfg(not(feature = "shaderc"))]
#[test]
fn kept_spirv_was_made_from_these_sources() {
    assert_eq!(
        kept_hashes()[0],
        sources_hash(),
        "renew it as the first lines say"
    );
}

#[cfg(feature = "shaderc")]
mod compiled {
    use super::{ENTRIES, folder, hash, kept_hashes, sources_hash};

    /// Versions of shaderc that share a generator's number differ in what they make of this.
    const PROBE: &str = "#version 450
        layout(constant_id = 0) const uint N = 3u;
        layout(set = 0, binding = 0, std140) uniform B { mat4 m; vec4 v[8]; } b;
        layout(location = 0) out vec4 color;
        void main() {
            vec3 sum = vec3(0.0);
            for (uint n = 0u; n < N; ++n) {
                sum += dot(b.v[n], color) > 0.0 ? cross(sum, b.v[n].xyz) : vec3(0.0);
            }
            color = b.m * vec4(sum * inversesqrt(dot(sum, sum)), 1.0);
        }";

    fn compile(text: &str, name: &str) -> Vec<u8> {
        let include = |wanted: &str| {
            let content = std::fs::read_to_string(folder().join(wanted));
            let content = content.map_err(|e| format!("{wanted}: {e}"))?;
            Ok((wanted.to_owned(), content))
        };
        let compiler = shaderc_link::Compiler::new().unwrap();
        let level = shaderc_link::OptimizationLevel::Zero;
        let made = shaderc_link::spirv(&compiler, (name, text), &[], level, include);
        made.unwrap_or_else(|e| panic!("{e}"))
            .as_binary_u8()
            .to_vec()
    }

    #[test]
    fn kept_spirv_is_what_the_sources_give() {
        let probe = compile(PROBE, "probe.frag");
        let hashes = [sources_hash(), hash([probe.as_slice()])];
        let made = ENTRIES.map(|name| {
            let text = std::fs::read_to_string(folder().join(name)).unwrap();
            (
                folder().join(format!("spirv/{name}.spv")),
                compile(&text, name),
            )
        });
        if std::env::var_os("REVMAP_KEEP_SPIRV").is_some_and(|v| v == "1") {
            for (file, bytes) in &made {
                std::fs::write(file, bytes).unwrap();
            }
            let file = folder().join("spirv/sources.fnv");
            std::fs::write(file, format!("{}\n{}\n", hashes[0], hashes[1])).unwrap();
        }
        let kept = kept_hashes();
        assert_eq!(kept[0], hashes[0], "renew it as the first lines say");
        for (file, bytes) in made {
            let same = std::fs::read(&file).unwrap() == bytes;
            assert!(same || kept[1] != hashes[1], "{} differs", file.display());
        }
    }
}
