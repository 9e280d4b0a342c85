//! Reads SVG as browsers draw it, into plain painted paths.
//!
//! The reader walks the elements that show and follows references from there, so that nothing
//! hidden or unused is refused. Numbers stay in double precision. Properties that it does not know
//! are those without influence on the outline. Everything else is drawn, warned of, or refused
//! with its line and a remedy (`docs/drawings.md` has the list).

mod cascade;
mod clips;
mod color;
mod css;
mod custom;
mod encoding;
mod keywords;
mod markers;
mod motion;
mod notes;
mod paints;
mod placed;
mod properties;
mod reader;
mod reading;
mod references;
mod selector;
mod shapes;
mod strokes;
mod style;
mod transform;
mod tree;
mod value;
mod viewport;

pub(super) use encoding::{is_markup, is_narrow_markup};
pub(super) use tree::{Band, Clip, Drawing, Group, Node, Path, has_translucency};

pub use color::css_color;

use crate::content_fault;
use kurbo::{Rect, Shape};
use paints::premultiplied;
use reader::{Place, Reader, SVG};
use revmap::error::{Error, Result};
use revmap::profile::FillRule;
use style::Paint;

/// Most nodes of the XML.
const MOST_NODES: u32 = 4_000_000;

/// Reads a drawing from the bytes of its file.
pub(super) fn read(bytes: &[u8]) -> Result<Drawing> {
    let bytes = encoding::unpacked(bytes)?;
    let text = encoding::text(&bytes)?;
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        nodes_limit: MOST_NODES,
        ..Default::default()
    };
    let document =
        roxmltree::Document::parse_with_options(&text, options).map_err(|e| damaged(&e))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let name = root.tag_name().name();
        return Err(content_fault(format!(
            "the file has <{name}> at its root, not <svg>; save the drawing as SVG"
        )));
    }
    if let Some(other) = root.tag_name().namespace().filter(|n| *n != SVG) {
        return Err(content_fault(format!(
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

/// The failure of a file that cannot be parsed.
fn damaged(e: &dyn std::fmt::Display) -> Error {
    let text = e.to_string().replace('\n', " ");
    content_fault(format!(
        "the drawing is damaged ({text}); save it again as plain SVG"
    ))
}
