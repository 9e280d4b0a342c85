//! Draws the shape maps of profiles as pictures to look at: `cargo run --release --example
//! map_pictures -- OUT FILE...`
//!
//! Of each source: solid is dark, what is empty light, with a line every 16 texels of distance and
//! the zero line in red. Of the best source also the papers' texture, and the length along the
//! contour as grey.

use revmap::maps::{ArcLength, BakeOptions, MapSource, Projection, ShapeMap};
use revmap_files::{BINARY, COVERAGE, ProfileAxis, mark_projection};
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut files = std::env::args_os().skip(1).map(PathBuf::from);
    let out = files.next().ok_or("give a folder and profiles")?;
    std::fs::create_dir_all(&out)?;
    for file in files {
        let profile = revmap_files::profile(&file, ProfileAxis::Center)?;
        for source in [BINARY, COVERAGE, MapSource::EXACT] {
            let clock = std::time::Instant::now();
            let map = match ShapeMap::bake(&profile, &BakeOptions::new(source, 512)) {
                Ok(map) => map,
                Err(e) => {
                    println!("{}: {source:?}: {e}", file.display());
                    continue;
                }
            };
            let name = file.file_stem().unwrap_or_default().to_string_lossy();
            let to = out.join(format!("{name}.{source:?}.png").to_lowercase());
            let (time, file) = (clock.elapsed(), to.display());
            println!(
                "{file}: {time:.1?}, R = {:.4}, {:?}",
                map.radius, map.bounds
            );
            draw(&map, &to)?;
            if source == MapSource::EXACT {
                let file = out.join(&*name).with_extension("png");
                let file = mark_projection(file, Projection::Cylindrical);
                revmap_files::write_shape_map(&map, file)?;
                let table = ArcLength::new(&profile)?.table(map.columns, map.rows)?;
                let (columns, rows, texels) = (table.columns, table.rows, table.texels);
                type Lengths = image::ImageBuffer<image::Luma<u16>, Vec<u16>>;
                if let Some(picture) = Lengths::from_raw(columns, rows, texels) {
                    picture.save(out.join(format!("{name}.lengths.png")))?;
                }
            }
        }
    }
    Ok(())
}

fn draw(map: &ShapeMap, to: &Path) -> Result<(), image::ImageError> {
    let rows = map.rows as f32;
    let picture = image::RgbImage::from_fn(map.columns, map.rows, |i, j| {
        let texels = map.distance[(j * map.columns + i) as usize] * rows;
        let line = (texels / 16.0).fract().abs() < 1.0 / 16.0;
        let tone = (128.0 + texels.signum() * 60.0 + texels * 0.3).clamp(0.0, 255.0) as u8;
        image::Rgb(match (texels.abs() < 0.71, line) {
            (true, _) => [255, 0, 0],
            (false, true) => [tone / 2, tone / 2, tone],
            (false, false) => [tone; 3],
        })
    });
    picture.save(to)
}
