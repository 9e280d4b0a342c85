//! Figures as SVG.

use super::letters::FAMILY;
use super::style::PAPER;
use super::{Anchor, Figure, Mark};
use maud::{Markup, html};

/// A figure as an `svg` element that scales with the width it is given.
pub(crate) fn svg(figure: &Figure) -> String {
    let (w, h) = (figure.width.ceil(), figure.height.ceil());
    let view = format!("0 0 {w} {h}");
    let font = format!("'{FAMILY}', 'DejaVu Sans', Verdana, sans-serif");
    let figure = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(view) width=(w) height=(h) role="img" font-family=(font) {
            title { (shown(&figure.title)) }
            rect width=(w) height=(h) fill=(PAPER) {}
            @for mark in &figure.marks { "\n" (element(mark)) }
        }
    };
    figure.into_string() + "\n"
}

fn element(mark: &Mark) -> Markup {
    match mark {
        Mark::Shape(points, fill, stroke) => html! {
            path d=(path(points) + "Z") fill=(fill) stroke=(stroke.0) stroke-width=(stroke.1) {}
        },
        Mark::Line(points, color, width, dash) => {
            let lengths: Vec<String> = dash.0.iter().map(f32::to_string).collect();
            let dashes = (!lengths.is_empty()).then(|| lengths.join(" "));
            html! {
                path d=(path(points)) fill="none" stroke=(color) stroke-width=(width) stroke-linejoin="round" stroke-dasharray=[dashes] {}
            }
        }
        Mark::Word(word) => {
            let anchor = match word.anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let (x, y) = (round(word.at.0), round(word.at.1));
            let turn = word.upwards.then(|| format!("rotate(-90 {x} {y})"));
            html! {
                text x=(x) y=(y) font-size=(word.size) text-anchor=(anchor) fill=(word.color) transform=[turn] { (shown(&word.text)) }
            }
        }
    }
}

/// XML has no control characters.
fn shown(text: &str) -> String {
    text.replace(char::is_control, "\u{fffd}")
}

fn path(points: &[(f64, f64)]) -> String {
    let point = |(i, (x, y)): (usize, &(f64, f64))| {
        let letter = if i == 0 { 'M' } else { 'L' };
        format!("{letter}{} {}", round(*x), round(*y))
    };
    points.iter().enumerate().map(point).collect()
}

/// A hundredth of a pixel is enough.
fn round(v: f64) -> f64 {
    (v * 100.0).round() / 100.0
}
