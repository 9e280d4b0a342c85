//! Compiles shaders of the repository's examples:
//! `cargo run -p shaderc-link --features shaderc --example compile -- examples/deferred/*.comp`
//! writes `FILE.spv` beside each. Includes are read from the file's folder.

use shaderc_link::{Compiler, OptimizationLevel, spirv};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let compiler = Compiler::new()?;
    for file in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&file)?;
        let folder = Path::new(&file).parent().unwrap_or(Path::new("."));
        let include = |name: &str| {
            let path = folder.join(name);
            let text = std::fs::read_to_string(&path).map_err(|e| e.to_string())?;
            Ok((path.to_string_lossy().into_owned(), text))
        };
        let level = OptimizationLevel::Performance;
        let made = spirv(&compiler, (&file, &text), &[], level, include)?;
        std::fs::write(format!("{file}.spv"), made.as_binary_u8())?;
    }
    Ok(())
}
