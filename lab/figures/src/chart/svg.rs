//! Figures as SVG.

use super::letters::width;
use super::style::PAPER;
use super::{Anchor, Figure, Mark};
use maud::{Markup, html};

/// A figure as an `svg` element that scales with the width it is given.
pub fn svg(figure: &Figure) -> String {
    let (w, h) = (figure.width.ceil(), figure.height.ceil());
    let view = format!("0 0 {w} {h}");
    let figure = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(view) width=(w) height=(h) role="img" font-family="DejaVu Sans, Verdana, sans-serif" {
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
            let length = round(width(&word.text, word.size));
            let turn = word.upwards.then(|| format!("rotate(-90 {x} {y})"));
            html! {
                text x=(x) y=(y) font-size=(word.size) text-anchor=(anchor) textLength=(length) lengthAdjust="spacingAndGlyphs" fill=(word.color) transform=[turn] { (shown(&word.text)) }
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

#[cfg(test)]
mod tests {
    use super::super::style::{Dash, INK};
    use super::*;

    #[test]
    fn marks_appear_where_they_stand() {
        let square = vec![(10.0, 10.0), (20.0, 10.0), (20.0, 20.0)];
        let mut turned = Mark::word((30.0, 70.0), "a<\u{7}", 10.0, Anchor::End, INK);
        if let Mark::Word(word) = &mut turned {
            word.upwards = true;
        }
        let line = vec![(1.0, 2.004), (3.0, 4.0)];
        let figure = Figure {
            width: 99.5,
            height: 80.0,
            title: "A & B".into(),
            marks: vec![
                Mark::Shape(square, "#d55e00", ("#ffffff", 0.1)),
                Mark::Line(line, INK, 2.0, Dash::GUIDE),
                turned,
            ],
        };
        let text = svg(&figure);
        for part in [
            "viewBox=\"0 0 100 80\"",
            "<title>A &amp; B</title>",
            "d=\"M10 10L20 10L20 20Z\" fill=\"#d55e00\"",
            "d=\"M1 2L3 4\"",
            "stroke-dasharray=\"5 4\"",
            "x=\"30\" y=\"70\"",
            "text-anchor=\"end\" textLength=\"22.9\"",
            "transform=\"rotate(-90 30 70)\">a&lt;\u{fffd}</text>",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
