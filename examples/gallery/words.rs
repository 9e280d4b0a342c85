//! Words and marks over a picture, drawn from an SVG with the charts' font.

use image::{Rgb, RgbImage};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use revmap::error::Result;

const FONT: &[u8] = include_bytes!("../../assets/fonts/DejaVuSans-subset.ttf");

/// A word from its lower left corner on, for [`over`].
pub fn word([x, y]: [u32; 2], size: u32, text: &str) -> String {
    format!(
        "<text x='{x}' y='{y}' font-size='{size}' font-family='revmap DejaVu Sans, DejaVu Sans' fill='#212630'>{text}</text>"
    )
}

/// Draws the elements of an SVG over a picture, whose pixels are their units.
pub fn over(picture: &mut RgbImage, elements: &str) -> Result<()> {
    let (width, height) = picture.dimensions();
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}'>{elements}</svg>"
    );
    let mut options = Options::default();
    options.fontdb_mut().load_font_data(FONT.to_vec());
    let tree = Tree::from_str(&text, &options).map_err(|e| crate::fault(e.to_string()))?;
    let mut map = Pixmap::new(width, height).ok_or_else(|| crate::fault("has no pixels"))?;
    resvg::render(&tree, Transform::identity(), &mut map.as_mut());
    for (under, over) in picture.pixels_mut().zip(map.pixels()) {
        let behind = 255 - u32::from(over.alpha());
        let parts = [over.red(), over.green(), over.blue()];
        // Premultiplied, so a sum is at most 255.
        *under = Rgb([0, 1, 2].map(|k| parts[k] + (u32::from(under.0[k]) * behind / 255) as u8));
    }
    Ok(())
}
