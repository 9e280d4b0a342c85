//! Draws the pictures of docs/gallery.md into docs/pictures/: `scripts/gallery`, or `cargo run
//! --release --example gallery [NAME ...]`.
//!
//! Each scene of assets/gallery/ becomes one picture. Pixels are the mean light of 3 x 3 rays. The
//! line `# size WIDTHxHEIGHT`, with which a scene begins, says how large; each line `# beside
//! KEY=VALUE` adds the same scene once more to the right, with that key set. Lines `# word X Y TEXT`
//! are words in the picture. Three pictures have no scene: `maps`, and `method` and
//! `strip-drawing` of the README.
#![allow(clippy::expect_used)]

#[path = "gallery/method.rs"]
mod method;
#[path = "gallery/words.rs"]
mod words;

use image::{Rgb, RgbImage, RgbaImage, imageops};
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::settings::{Planes, Settings};
use revmap_files::{ProfileAxis, SceneFile, write_png};
use std::path::{Path, PathBuf};

/// Rays across a pixel.
const RAYS: u32 = 3;

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let takes = |name: &str| wanted.is_empty() || wanted.iter().any(|w| w == name);
    let pictures = root.join("docs/pictures");
    let device = Device::open(None)?;
    println!("on {}", device.report().name);
    for scene in scenes(&root.join("assets/gallery"))? {
        let name = scene.file_stem().unwrap_or_default().to_string_lossy();
        if takes(&name) {
            let target = pictures.join(format!("{name}.png"));
            let [shapes, textures] = draw(&device, &scene, &target)?.map(|b| b as f64 / 1e6);
            let target = target.display();
            println!(
                "{target}: shape maps {shapes:.2} MB, colour and displacement maps {textures:.2} MB"
            );
        }
    }
    if takes("maps") {
        maps(root, &pictures.join("maps.png"))?;
    }
    if takes("method") {
        method::draw(&device, root, &pictures.join("method.png"))?;
    }
    if takes("strip-drawing") {
        drawing(root, &pictures.join("strip-drawing.png"))?;
    }
    Ok(())
}

fn fault(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Usage, message)
}

/// Writes a picture.
fn save<P: image::PixelWithColorType<Subpixel = u8>>(
    picture: &image::ImageBuffer<P, Vec<u8>>,
    target: &Path,
) -> Result<()> {
    let saved = picture.save(target);
    saved.map_err(|e| fault(e.to_string()).in_file(target))
}

fn scenes(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)
        .map_err(|e| fault(format!("cannot be listed ({e})")).in_file(folder))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "toml"));
    files.sort();
    Ok(files)
}

/// Draws a scene, and what stands beside it; the bytes of its maps on the device.
fn draw(device: &Device, scene: &Path, target: &Path) -> Result<[u64; 2]> {
    let text = std::fs::read_to_string(scene)
        .map_err(|e| fault(format!("cannot be read ({e})")).in_file(scene))?;
    let line = |start: &'static str| text.lines().filter_map(move |l| l.strip_prefix(start));
    let size = line("# size ").next().and_then(|s| s.split_once('x'));
    let size = size.and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height): (u32, u32) =
        size.ok_or_else(|| fault("does not begin with `# size WIDTHxHEIGHT`").in_file(scene))?;
    let sets: Vec<Vec<String>> = std::iter::once(Vec::new())
        .chain(line("# beside ").map(|set| vec![set.to_owned()]))
        .collect();
    let across = width / sets.len() as u32;
    let mut picture = Frame::new(across * sets.len() as u32, height, [0.0; 4])?;
    let mut bytes = [0; 2];
    for (place, sets) in sets.iter().enumerate() {
        let scene = SceneFile::open(scene)?.scene(sets)?;
        let settings = Settings {
            width: across * RAYS,
            height: height * RAYS,
            planes: Planes::Color,
            ..Settings::default()
        };
        let drawn = revmap_offscreen::draw(device, &scene, &settings)?;
        bytes = drawn.map_bytes;
        shrink(&drawn.frame, &mut picture, place as u32 * across);
    }
    write_png(&picture, target)?;
    let words: String = line("# word ").filter_map(placed).collect();
    if !words.is_empty() {
        let picture = image::open(target).map_err(|e| fault(e.to_string()).in_file(target))?;
        let mut picture = picture.into_rgb8();
        words::over(&mut picture, &words)?;
        save(&picture, target)?;
    }
    Ok(bytes)
}

/// The element of a line `X Y TEXT`.
fn placed(line: &str) -> Option<String> {
    let mut parts = line.splitn(3, ' ');
    let mut number = || parts.next()?.parse().ok();
    let at = [number()?, number()?];
    Some(words::word(at, 15, parts.next()?))
}

/// The means of `RAYS` x `RAYS` pixels of `large` into `small`, from the column `left` on.
fn shrink(large: &Frame, small: &mut Frame, left: u32) {
    for y in 0..small.height {
        for x in 0..large.width / RAYS {
            let mut sum = [0.0f32; 4];
            for k in 0..RAYS * RAYS {
                let (i, j) = (x * RAYS + k % RAYS, y * RAYS + k / RAYS);
                let pixel = large.color[(j * large.width + i) as usize];
                for (s, v) in sum.iter_mut().zip(pixel) {
                    *s += v / (RAYS * RAYS) as f32;
                }
            }
            small.color[(y * small.width + left + x) as usize] = sum;
        }
    }
}

/// The drawing of a pawn as it is.
fn drawing(root: &Path, target: &Path) -> Result<()> {
    let file = root.join("assets/profiles/pawn.svg");
    let text = std::fs::read_to_string(&file)
        .map_err(|e| fault(format!("cannot be read ({e})")).in_file(&file))?;
    let mut picture = RgbImage::from_pixel(320, 320, Rgb([255; 3]));
    let drawn = text.find("<svg").map_or("", |at| &text[at..]);
    let middle = format!("<g transform='translate(54 34) scale(1.2)'>{drawn}</g>");
    words::over(&mut picture, &middle)?;
    save(&picture, target)
}

/// A shape map's channels and a displacement map's, each beside the whole, as the program's `bake`
/// writes them.
fn maps(root: &Path, target: &Path) -> Result<()> {
    const SIDE: u32 = 184;
    use revmap::maps::{BakeOptions, MapFormat, MapSource, ShapeMap, SlopeFilter};
    let drawing = root.join("assets/gallery/jewel.svg");
    let profile = revmap_files::profile(drawing, ProfileAxis::Left)?;
    let options = BakeOptions {
        source: MapSource::EXACT,
        rows: SIDE,
        reach: profile.radius,
    };
    let shape = ShapeMap::bake(&profile, &options)?.encode(MapFormat::Rgba8)?;
    let shape = RgbaImage::from_raw(shape.columns, shape.rows, shape.bytes);
    let shape = shape.expect("four bytes a texel");
    let brick = root.join("assets/heights/brick.png");
    let slopes = revmap_files::displacement_map(&brick, SlopeFilter::default())?;
    let level = &slopes.levels[1];
    let all = level.texels.iter().flatten();
    let largest = all.fold(0.0f32, |m, v| m.max(v.abs()));
    let slopes = RgbaImage::from_fn(level.width, level.height, |x, y| {
        let [du, dv] = level.texels[(y * level.width + x) as usize];
        let code = |v: f32| (127.5 + 127.5 * (v / largest)).round() as u8;
        image::Rgba([code(du), code(dv), 255, 255])
    });
    let slopes = imageops::resize(&slopes, SIDE, SIDE, imageops::FilterType::Triangle);
    let height = image::open(brick)
        .map_err(|e| fault(e.to_string()))?
        .resize_exact(SIDE, SIDE, imageops::FilterType::Triangle)
        .into_rgba8();

    // The whole's alpha is the form: what is solid is 255, drawn dark as in the profile.
    let channel = |of: &RgbaImage, c: usize| -> RgbaImage {
        RgbaImage::from_fn(of.width(), of.height(), |x, y| {
            let level = of.get_pixel(x, y).0[c];
            image::Rgba([level, level, level, 255])
        })
    };
    let opaque = |of: &RgbaImage| {
        let mut of = of.clone();
        of.pixels_mut().for_each(|p| p.0[3] = 255);
        of
    };
    let mut rows = [
        [3, 2, 0, 1].map(|c| channel(&shape, c)).to_vec(),
        vec![height],
    ];
    rows[0].push(opaque(&shape));
    rows[1].extend([channel(&slopes, 0), channel(&slopes, 1), slopes]);
    const GAP: u32 = 12;
    let across = |row: &[RgbaImage]| GAP + row.iter().map(|i| i.width() + GAP).sum::<u32>();
    let width = rows.iter().map(|r| across(r)).max().unwrap_or(GAP);
    let tall = GAP + rows.len() as u32 * (SIDE + GAP);
    let mut sheet = RgbaImage::from_pixel(width, tall, image::Rgba([255; 4]));
    for (place, row) in rows.iter().enumerate() {
        let mut left = (width - across(row)) / 2 + GAP;
        for picture in row {
            let top = GAP + place as u32 * (SIDE + GAP);
            imageops::overlay(&mut sheet, picture, i64::from(left), i64::from(top));
            left += picture.width() + GAP;
        }
    }
    save(&sheet, target)?;
    println!("{}", target.display());
    Ok(())
}
