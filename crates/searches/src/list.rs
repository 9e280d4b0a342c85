// The list of SPIR-V modules. `build.rs` compiles this list, and searches look modules up in it; so
// it depends only on `SearchModule`.

use super::module::{Features, Output, Pass, SearchModule};

/// A module of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listed {
    /// The search's file in `published/`.
    pub hook: &'static str,
    /// The module.
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

/// Every module. For each search, special modules come before the general ones that can replace
/// them.
///
/// Colour without textures, replicas and shadows has modules of its own, since most comparisons
/// measure it. The RBM baseline has them in each of its forms. The full modules draw everything
/// else.
pub fn modules() -> Vec<Listed> {
    let mut all = Vec::new();
    for pass in [Pass::Fragment, Pass::Tile, Pass::Copies] {
        let map = SearchModule {
            pass,
            features: Features::Plain,
            output: Output::Color,
            table: false,
            bounded: true,
            beveled: true,
            rgba8: false,
        };
        for rgba8 in [false, true] {
            let plain = SearchModule { rgba8, ..map };
            let unbeveled = SearchModule {
                beveled: false,
                ..plain
            };
            all.push(listed("circle/search.glsl", unbeveled));
            for hook in ["circle/search.glsl", "linear/search.glsl"] {
                all.push(listed(hook, plain));
                all.extend(full(plain).map(|full| listed(hook, full)));
            }
        }
        for (hook, bounded) in [("cone/search.glsl", false), ("relaxed/search.glsl", true)] {
            let plain = SearchModule {
                table: true,
                bounded,
                beveled: false,
                ..map
            };
            all.push(listed(hook, plain));
            all.extend(full(plain).map(|full| listed(hook, full)));
        }
    }
    all
}

fn listed(hook: &'static str, module: SearchModule) -> Listed {
    Listed { hook, module }
}

fn full(plain: SearchModule) -> [SearchModule; 2] {
    [Output::Color, Output::Planes].map(|output| SearchModule {
        features: Features::Full,
        output,
        ..plain
    })
}
