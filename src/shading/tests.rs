use super::*;
use crate::shader::words;

/// Bytes of modules of the library in place of a host's: they are SPIR-V, too.
fn some(stage: DrawStage) -> Shading {
    let made = Shading::empty(stage);
    for (module, own) in &made.modules {
        own.set(Ok(words(module).unwrap())).unwrap();
    }
    made
}

#[test]
fn bytes_come_back() {
    for (stage, count) in [(DrawStage::Fragment, 4), (DrawStage::Compute, 5)] {
        let made = some(stage);
        assert_eq!(made.modules.len(), count);
        let read = Shading::from_bytes(&made.to_bytes().unwrap()).unwrap();
        assert_eq!(read.stage(), stage);
        assert_eq!(read.bindings(), made.bindings());
        for (module, _) in &made.modules {
            assert!(read.words(module).unwrap() == made.words(module).unwrap());
        }
    }
}

/// Arrays count by their lengths: four textures of an object, and eight maps that shadows read. Set 0 has
/// views of four buffers.
#[test]
fn textures_of_a_set_are_counted() {
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let made = some(stage);
        assert_eq!([0, 1, 2, 3].map(|set| made.textures(set)), [4, 12, 0, 0]);
    }
}

#[test]
fn every_module_that_a_variant_needs_is_there() {
    let made = some(DrawStage::Fragment);
    assert!(made.words(&made.modules[0].0).is_ok());
    let compute = some(DrawStage::Compute).modules[0].0;
    let error = made.words(&compute).unwrap_err();
    assert!(error.message.contains("no shading is tile_"), "{error}");
}

#[test]
fn damaged_bytes_and_those_of_other_versions_are_refused() {
    let bytes = some(DrawStage::Compute).to_bytes().unwrap();
    let refused = |bytes: &[u8], why: &str| {
        let error = Shading::from_bytes(bytes).unwrap_err();
        assert_eq!(error.kind, ErrorKind::Content);
        assert!(error.message.contains(why), "{error}");
    };
    refused(&[], "damaged");
    refused(&bytes[..bytes.len() - 9], "damaged");
    let changed = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1;
        bytes
    };
    refused(&changed(0), "damaged");
    refused(&changed(9), "another version");
    refused(&changed(bytes.len() / 2), "damaged");
    refused(&changed(16), "damaged");
}

#[cfg(feature = "shaderc")]
mod compiled {
    use super::*;

    const PLAIN: &str = "vec4 host_shade(Surface s) { return vec4(s.base_color, 1.0); }\n";

    #[test]
    fn faults_have_the_line_of_the_hosts_text() {
        let late = format!("// a comment\n{PLAIN}float f() {{ return g(); }}\n");
        let twice = format!("struct Light {{ vec3 c; }};\n{PLAIN}");
        let kind = PLAIN.replace("vec4 host", "vec3 host");
        let parts = [
            ("a.glsl", "#include \"c.glsl\"\n"),
            ("c.glsl", "\nvoid h( {}\n"),
        ];
        let cases: [(&[(&str, &str)], &str); 9] = [
            (&[("a.glsl", &late)], "a.glsl:3: 'g' : no matching"),
            (&[("b.glsl", &twice)], "b.glsl:1: 'Light' : redef"),
            (&parts, "c.glsl:2: "),
            (&[("e.glsl", &kind)], "e.glsl:1: "),
            (
                &[("a.glsl", "float f() { return 1.0; }\n")],
                "a.glsl: does not define `vec4 host_shade(Surface",
            ),
            (&[("a.glsl", "#include \"none.glsl\"\n")], "a.glsl:1: "),
            (&[("a.glsl", "#include \"none.glsl\"\n")], "none.glsl"),
            (&[], "no files"),
            (&[("core/shade.glsl", PLAIN)], "rename"),
        ];
        for (files, wanted) in cases {
            let error = Shading::compile(DrawStage::Fragment, files).unwrap_err();
            let error = error.to_string();
            assert!(error.contains(wanted) && !error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn extensions_and_sets_of_the_host_are_taken() {
        let text = format!(
            "#extension GL_EXT_nonuniform_qualifier : require\n\
             layout(set = 3, binding = 7) uniform sampler2D host_maps[];\n\
             {}",
            PLAIN.replace(
                "vec4(s.base_color, 1.0)",
                "textureGrad(host_maps[nonuniformEXT(s.object)], s.uv, s.uv_right, s.uv_down)"
            )
        );
        for stage in [DrawStage::Fragment, DrawStage::Compute] {
            let made = Shading::compile(stage, &[("maps.glsl", &text)]).unwrap();
            assert!(made.bindings().contains(&(3, 7)), "{:?}", made.bindings());
        }
        let made = Shading::compile(DrawStage::Fragment, &[("a.glsl", PLAIN)]).unwrap();
        assert!(made.bindings().iter().all(|(set, _)| *set < 3));
    }
}
