//! Reads SVG drawings as browsers draw them, into plain painted paths.
//!
//! [`read`] walks the elements that show and follows references from there, so that nothing hidden
//! or unused is refused. Styles, selectors and transforms of CSS are applied. Numbers stay in
//! double precision. Properties that it does not know are those without influence on an outline.
//! Everything else is drawn, warned of, or refused with its line and a remedy (`docs/drawings.md`
//! of the repository has the list).
//!
//! ```
//! let text = "<svg viewBox='0 0 4 8'><g opacity='.5'><rect width='2' height='3'/></g></svg>";
//! let drawing = revmap_drawing::read(text.as_bytes())?;
//! assert_eq!(drawing.size, (4.0, 8.0));
//! assert!(drawing.has_translucency() && drawing.warnings.is_empty());
//!
//! let text = "<svg viewBox='0 0 4 8'><text>a</text></svg>";
//! let fault = revmap_drawing::read(text.as_bytes()).unwrap_err();
//! assert!(fault.to_string().starts_with("the drawing uses <text> (line 1)"));
//! # Ok::<(), revmap_drawing::Fault>(())
//! ```

mod css;
mod element;
mod encoding;
mod notes;
mod reader;
mod style;
mod tree;
mod value;

pub use encoding::{decoded, is_markup};
pub use notes::{Fault, Result};
pub use tree::{Band, Clip, ClipShape, Drawing, FillRule, Group, Node, Path};
pub use value::color::{Rgba, css_color, luminance};

use element::SVG;
use kurbo::{Rect, Shape};
use reader::{Place, Reader, viewport};
use value::color::premultiplied;
use value::paint::Paint;

/// The largest ratio of the sides of the page, and of the width of a stroke to the page.
const EXTENT: f64 = 1e4;

/// Most nodes of the XML.
const MOST_NODES: u32 = 4_000_000;

/// Reads a drawing from the bytes of its file, which may be compressed by gzip.
///
/// # Errors
/// What is damaged, or shows and has no outline here.
pub fn read(bytes: &[u8]) -> Result<Drawing> {
    let bytes = encoding::unpacked(bytes)?;
    let text = encoding::text(&bytes)?;
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        nodes_limit: MOST_NODES,
        ..Default::default()
    };
    let document =
        roxmltree::Document::parse_with_options(&text, options).map_err(|e| Fault::damaged(&e))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let name = root.tag_name().name();
        return Err(Fault::new(format!(
            "the file has <{name}> at its root, not <svg>; save the drawing as SVG"
        )));
    }
    if let Some(other) = root.tag_name().namespace().filter(|n| *n != SVG) {
        return Err(Fault::new(format!(
            "the drawing has the namespace \"{other}\"; write xmlns=\"{SVG}\""
        )));
    }
    let mut reader = Reader::new(&document);
    let style = reader.style_of(root)?;
    let inner = viewport::view_box(root, &mut reader.notes);
    let size = viewport::page(&style, inner)?;
    let (fit, viewport) = viewport::fitted(root, inner, size);
    let content = match style.own.display && style.own.opacity > 0.0 {
        true => reader.children(root, &style, Place::within(viewport))?,
        false => Vec::new(),
    };
    let children = vec![Node::Group(Group::moved(fit, content))];
    let mut content = reader.wrap(root, &style, Place::within(size), children)?;
    tree::prune(&mut content);
    if let Paint::Color(color) = style.resolved(&style.own.background) {
        let color = premultiplied(*color, 1.0);
        let page = Rect::new(0.0, 0.0, size.0, size.1);
        let path = Path::plain(page.to_path(0.1), FillRule::NonZero);
        content.insert(0, Node::Path(Path { color, ..path }));
    }
    Ok(Drawing {
        size,
        to_user: fit.inverse(),
        content,
        warnings: reader.notes.into_warnings(),
    })
}
