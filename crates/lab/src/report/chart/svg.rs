//! Figures as SVG.

use super::letters::FAMILY;
use super::{Anchor, Figure, Mark};
use std::fmt::Write;

/// Text with XML's signs escaped.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // XML knows no control characters but these.
            c if c.is_control() && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A figure as an `svg` element that scales with the width it is given.
#[must_use]
pub fn svg(figure: &Figure) -> String {
    let (w, h) = (figure.width.ceil(), figure.height.ceil());
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" \
         font-family=\"'{FAMILY}', 'DejaVu Sans', Verdana, sans-serif\"><title>{}</title><rect width=\"{w}\" height=\"{h}\" \
         fill=\"#ffffff\"/>\n",
        escape(&figure.title)
    );
    for mark in &figure.marks {
        // Writing to a string cannot fail.
        let _ = match mark {
            Mark::Shape {
                points,
                fill,
                stroke,
            } => {
                let outline = stroke
                    .map(|(color, width)| format!(" stroke=\"{color}\" stroke-width=\"{width}\""))
                    .unwrap_or_default();
                writeln!(
                    out,
                    "<path d=\"{}Z\" fill=\"{fill}\"{outline}/>",
                    path(points)
                )
            }
            Mark::Line {
                points,
                color,
                width,
                dash,
            } => {
                let lengths: Vec<String> = dash.pattern().iter().map(f32::to_string).collect();
                let dash = if lengths.is_empty() {
                    String::new()
                } else {
                    format!(" stroke-dasharray=\"{}\"", lengths.join(" "))
                };
                writeln!(
                    out,
                    "<path d=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dash}/>",
                    path(points)
                )
            }
            Mark::Word {
                at,
                text,
                size,
                anchor,
                color,
                upwards,
            } => {
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                let (x, y) = (round(at.0), round(at.1));
                let turn = if *upwards {
                    format!(" transform=\"rotate(-90 {x} {y})\"")
                } else {
                    String::new()
                };
                writeln!(
                    out,
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{color}\"{turn}>{}</text>",
                    escape(text)
                )
            }
        };
    }
    out.push_str("</svg>\n");
    out
}

fn path(points: &[(f64, f64)]) -> String {
    let mut out = String::new();
    for (i, (x, y)) in points.iter().enumerate() {
        let _ = write!(
            out,
            "{}{} {}",
            if i == 0 { 'M' } else { 'L' },
            round(*x),
            round(*y)
        );
    }
    out
}

/// A hundredth of a pixel is enough.
fn round(v: f64) -> f64 {
    (v * 100.0).round() / 100.0
}
