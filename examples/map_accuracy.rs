//! Prints how far shape maps of a disc are off, by source and resolution: `cargo run --release
//! --example map_accuracy`

use revmap::maps::{BakeOptions, MapFormat, MapSource, ShapeMap};
use revmap_compare::map_accuracy::{Disc, MapErrors};

fn main() -> Result<(), revmap::Error> {
    println!(
        "| rows | source | mean / rms / max error, texels | gradient rms / max, degrees | 8-bit channels rms / max |"
    );
    println!("|---|---|---|---|---|");
    for rows in [128, 512, 2048] {
        for source in [
            revmap_files::BINARY,
            revmap_files::COVERAGE,
            MapSource::EXACT,
        ] {
            row(rows, source.name, &Disc::default().errors(source, rows)?);
        }
        // What half floats leave of the exact distances.
        let disc = Disc::default();
        let options = BakeOptions::new(MapSource::EXACT, rows);
        let mut map = ShapeMap::bake(&disc.polygon(1 << 16)?, &options)?;
        map.distance = map.encode(MapFormat::R16)?.distances();
        row(rows, "exact, r16", &disc.measure(&map)?);
    }
    Ok(())
}

fn row(rows: u32, name: &str, e: &MapErrors) {
    println!(
        "| {rows} | {name} | {:+.4} / {:.4} / {:.4} | {:.2} / {:.2} | {:.2} / {:.2} |",
        e.mean,
        e.rms,
        e.max,
        e.gradient_rms,
        e.gradient_max,
        e.stored_gradient_rms,
        e.stored_gradient_max,
    );
}
