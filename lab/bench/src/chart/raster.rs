//! Figures as pixels, drawn from their SVG with the charts' own font, the same on every machine.

use super::Figure;
use super::letters::FONT;
use super::svg::svg;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use revmap::error::{Error, ErrorKind, Result};
use revmap_files::Picture;

/// A figure at `scale` pixels per CSS pixel, on white.
///
/// # Errors
/// [`ErrorKind::TooLarge`] when the figure has no size, or one too large for a picture.
pub(crate) fn raster(figure: &Figure, scale: f32) -> Result<Picture> {
    let side = |v: f64| (v.ceil() * f64::from(scale)).clamp(0.0, 32_768.0) as u32;
    let (width, height) = (side(figure.width), side(figure.height));
    let refuse = |why: &str| {
        let message = format!("a chart of {width}x{height} pixels cannot be drawn; {why}");
        Error::new(ErrorKind::TooLarge, message)
    };
    let mut map = Pixmap::new(width, height).ok_or_else(|| refuse("make it smaller"))?;
    let mut options = Options::default();
    options.fontdb_mut().load_font_data(FONT.to_vec());
    let tree = Tree::from_str(&svg(figure), &options).map_err(|e| refuse(&e.to_string()))?;
    let transform = Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut map.as_mut());
    // The paper is opaque, so nothing is premultiplied by less than 1.
    let pixels = map.pixels().iter();
    let rgba = pixels.map(|p| [p.red(), p.green(), p.blue(), 255]);
    Ok(Picture {
        width,
        height,
        rgba: rgba.collect(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::style::INK;
    use super::super::{Anchor, Mark};
    use super::*;

    #[test]
    fn words_and_shapes_appear_where_they_stand() {
        let square = vec![(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)];
        let square = Mark::Shape(square, "#d55e00", ("#d55e00", 0.1));
        let word = |at| Mark::word(at, "HHHH", 10.0, Anchor::Start, INK);
        let mut turned = word((30.0, 70.0));
        if let Mark::Word(word) = &mut turned {
            word.upwards = true;
        }
        let mut figure = Figure {
            width: 100.0,
            height: 80.0,
            top: 0.0,
            title: String::new(),
            marks: vec![square, word((50.0, 20.0)), turned],
        };
        let picture = raster(&figure, 2.0).unwrap();
        assert_eq!((picture.width, picture.height), (200, 160));
        let at = |x: u32, y: u32| picture.rgba[(y * 200 + x) as usize];
        assert_eq!((at(30, 30), at(2, 2)), ([0xd5, 0x5e, 0, 255], [255; 4]));
        for mark in &figure.marks[1..] {
            let b = mark.bounds();
            let ink = |b: [f64; 4]| {
                let [left, top, right, bottom] = b.map(|v| (v * 2.0) as u32);
                let pixels = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
                pixels.filter(|&(x, y)| at(x, y)[0] < 128).count()
            };
            assert!(ink(b) > 60, "{b:?}: {}", ink(b));
            // Nothing of it stands beside its box.
            assert_eq!(ink([b[0], b[3] + 1.0, b[2], b[3] + 6.0]), 0);
        }
        figure.width = 0.0;
        assert!(raster(&figure, 1.0).is_err());
    }
}
