//! `revmap shading`: bytes for hosts, and faults of GLSL with their line.

use crate::run::Bench;
use revmap::settings::DrawStage;
use revmap::shading::Shading;

const GLSL: &str = "#include \"lights.glsl\"\n\
                    vec4 host_shade(Surface s) { return vec4(light(s.base_color), 1.0); }\n";
const LIGHTS: &str = "vec3 light(vec3 color) { return 0.5 * color; }\n";

#[test]
fn bytes_of_a_shading_are_read_by_the_library() {
    let bench = Bench::new();
    bench.file("shade.glsl", GLSL);
    bench.file("lights.glsl", LIGHTS);
    bench.done("shading shade.glsl lights.glsl");
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let name = stage.name();
        let line = format!("shading shade.glsl lights.glsl -o {name}.shading --stage {name}");
        let said = bench.said(&line);
        assert!(said.starts_with(&format!("{name}.shading: ")), "{said}");
        let bytes = bench.read(&format!("{name}.shading"));
        assert_eq!(Shading::from_bytes(&bytes).unwrap().stage(), stage);
    }
}

#[test]
fn faults_are_one_line_with_the_place() {
    let bench = Bench::new();
    bench.file("shade.glsl", GLSL);
    bench.file(
        "lights.glsl",
        "\nvec3 light(vec3 color) { return colour; }\n",
    );
    bench.file("empty.glsl", "float f() { return 1.0; }\n");
    bench.refuses(
        1,
        "shading shade.glsl lights.glsl | lights.glsl:2 | colour
         shading shade.glsl             | shade.glsl:1  | lights.glsl
         shading empty.glsl             | empty.glsl    | host_shade
         shading none.glsl              | none.glsl     | cannot be read",
    );
    bench.refuses(
        2,
        "shading shade.glsl -o a.spv      | .shading
         shading shade.glsl --stage tiles | tiles",
    );
}
