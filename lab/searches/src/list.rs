// The list of SPIR-V modules. `build.rs` compiles this list, and searches look modules up in it; so
// it depends only on `SearchModule`.

use super::module::{Pass, SearchModule, StoredPlanes};

/// A module of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listed {
    /// The search's file in `published/`.
    pub hook: &'static str,
    pub module: SearchModule,
}

impl Listed {
    /// The module's name, for build scripts and tests.
    #[allow(dead_code)]
    pub fn name(&self) -> String {
        let search = self.hook.trim_end_matches("/search.glsl");
        format!("{search}.{}", self.module.name())
    }
}

pub fn modules() -> Vec<Listed> {
    let mut all = Vec::new();
    for pass in [Pass::Fragment, Pass::Compute] {
        for (hook, table, bounded) in [
            ("circle/search.glsl", false, true),
            ("linear/search.glsl", false, true),
            ("cone/search.glsl", true, false),
            ("relaxed/search.glsl", true, true),
        ] {
            for output in [StoredPlanes::Color, StoredPlanes::Planes] {
                let module = SearchModule {
                    pass,
                    output,
                    table,
                    bounded,
                };
                all.push(Listed { hook, module });
            }
        }
    }
    all
}
