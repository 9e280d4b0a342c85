//! Figures as PDF, for papers: curves stay curves, letters are outlines, so that no font is asked
//! for. The title is left out; a paper's caption takes its place.

use super::letters::{Stroke, outline, width};
use super::style::Dash;
use super::{Figure, Mark};
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Finish, Pdf, Rect, Ref, TextStr};

/// Points of a CSS pixel.
const POINTS: f64 = 0.75;

/// A figure as a PDF of one page of its size.
#[must_use]
pub fn pdf(figure: &Figure) -> Vec<u8> {
    let (width, height) = (figure.width, figure.height - figure.top);
    let mut content = Content::new();
    // Pixels count downwards from the upper left corner, points upwards from the lower left one.
    let scale = POINTS as f32;
    let lowest = (figure.height * POINTS) as f32;
    content.transform([scale, 0.0, 0.0, -scale, 0.0, lowest]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    for mark in &figure.marks {
        if mark.bounds()[3] > figure.top {
            draw(&mut content, mark);
        }
    }
    let [catalog, pages, page, stream, info] = [1, 2, 3, 4, 5].map(Ref::new);
    let mut file = Pdf::new();
    file.catalog(catalog).pages(pages);
    file.document_info(info)
        .title(TextStr(&figure.title))
        .creator(TextStr("revmap"));
    file.pages(pages).kids([page]).count(1);
    let corner = |v: f64| (v * POINTS) as f32;
    let mut sheet = file.page(page);
    sheet.media_box(Rect::new(0.0, 0.0, corner(width), corner(height)));
    sheet.parent(pages).contents(stream).resources();
    sheet.finish();
    file.stream(stream, &content.finish());
    file.finish()
}

fn draw(content: &mut Content, mark: &Mark) {
    match mark {
        Mark::Shape {
            points,
            fill,
            stroke,
        } => {
            let [r, g, b] = rgb(fill);
            content.set_fill_rgb(r, g, b);
            if let Some((color, width)) = stroke {
                pen(content, color, *width, Dash::Solid);
            }
            path(content, points);
            content.close_path();
            match stroke {
                Some(_) => content.fill_nonzero_and_stroke(),
                None => content.fill_nonzero(),
            };
        }
        Mark::Line {
            points,
            color,
            width,
            dash,
        } => {
            pen(content, color, *width, *dash);
            path(content, points);
            content.stroke();
        }
        Mark::Word {
            at,
            text,
            size,
            anchor,
            color,
            upwards,
        } => {
            let back = anchor.back(width(text, *size));
            let place = |x: f64, y: f64| {
                let (x, y) = (x - back, y);
                let (x, y) = if *upwards { (y, -x) } else { (x, y) };
                ((at.0 + x) as f32, (at.1 + y) as f32)
            };
            let [r, g, b] = rgb(color);
            content.set_fill_rgb(r, g, b);
            letters(content, &outline(text, *size), place);
            content.fill_nonzero();
        }
    }
}

fn path(content: &mut Content, points: &[(f64, f64)]) {
    for (i, (x, y)) in points.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if i == 0 {
            content.move_to(x, y);
        } else {
            content.line_to(x, y);
        }
    }
}

/// PDF knows cubic curves alone.
fn letters(content: &mut Content, strokes: &[Stroke], place: impl Fn(f64, f64) -> (f32, f32)) {
    let mut pen = (0.0, 0.0);
    for stroke in strokes {
        match *stroke {
            Stroke::Move(x, y) => {
                let (px, py) = place(x, y);
                content.move_to(px, py);
                pen = (x, y);
            }
            Stroke::Line(x, y) => {
                let (px, py) = place(x, y);
                content.line_to(px, py);
                pen = (x, y);
            }
            Stroke::Curve(a, b, x, y) => {
                let towards = |from: f64, to: f64| from + 2.0 / 3.0 * (to - from);
                let first = place(towards(pen.0, a), towards(pen.1, b));
                let second = place(towards(x, a), towards(y, b));
                let end = place(x, y);
                content.cubic_to(first.0, first.1, second.0, second.1, end.0, end.1);
                pen = (x, y);
            }
            Stroke::Close => {
                content.close_path();
            }
        }
    }
}

fn pen(content: &mut Content, color: &str, width: f64, dash: Dash) {
    let [r, g, b] = rgb(color);
    content.set_stroke_rgb(r, g, b);
    content.set_line_width(width as f32);
    content.set_dash_pattern(dash.pattern().iter().copied(), 0.0);
}

/// `#rrggbb` as parts of 1.
fn rgb(color: &str) -> [f32; 3] {
    [1, 3, 5].map(|at| {
        let byte = color.get(at..at + 2).map(|h| u8::from_str_radix(h, 16));
        byte.map_or(0.0, |b| f32::from(b.unwrap_or(0)) / 255.0)
    })
}

#[cfg(test)]
mod tests {
    use super::super::Anchor;
    use super::super::style::INK;
    use super::*;

    #[test]
    fn what_lies_below_the_title_is_on_the_page() {
        let word = |y: f64, text: &str| Mark::Word {
            at: (10.0, y),
            text: text.into(),
            size: 10.0,
            anchor: Anchor::Start,
            color: INK,
            upwards: false,
        };
        let line = Mark::Line {
            points: vec![(10.0, 50.0), (90.0, 70.0)],
            color: "#ff0000",
            width: 2.0,
            dash: Dash::Guide,
        };
        let figure = Figure {
            width: 100.0,
            height: 80.0,
            top: 20.0,
            title: "A title".into(),
            marks: vec![word(12.0, "title"), word(40.0, "I"), line],
        };
        let file = String::from_utf8_lossy(&pdf(&figure)).into_owned();
        assert!(
            file.starts_with("%PDF-1.") && file.ends_with("%%EOF"),
            "{file}"
        );
        assert!(file.contains("/MediaBox [0 0 75 45]"), "{file}");
        assert!(
            file.contains("1 0 0 RG") && file.contains("[5 4] 0 d"),
            "{file}"
        );
        assert!(file.contains("10 50 m\n90 70 l\nS"), "{file}");
        // One letter of two stems and four serifs is one contour; the title's five letters are not
        // there.
        assert_eq!(file.matches("\nh\n").count(), 1, "{file}");
    }
}
