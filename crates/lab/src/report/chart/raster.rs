//! Figures as pixels, letters drawn from their outlines: the same on every machine, whatever fonts
//! it has.

use super::letters::{Stroke, outline, width};
use super::style::Dash;
use super::{Anchor, Figure, Mark};
use revmap::error::{Error, Result, Stage};
use revmap::frame::Picture;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke as Pen,
    StrokeDash, Transform,
};

/// A figure at `scale` pixels per CSS pixel, on white.
///
/// # Errors
/// [`Stage::Report`] when the figure has no size, or one too large for a picture.
pub fn raster(figure: &Figure, scale: f32) -> Result<Picture> {
    let side = |v: f64| (v.ceil() * f64::from(scale)).clamp(0.0, 32_768.0) as u32;
    let (w, h) = (side(figure.width), side(figure.height));
    let mut map = Pixmap::new(w, h).ok_or_else(|| {
        Error::new(
            Stage::Report,
            format!("a chart of {w}x{h} pixels cannot be drawn; make it smaller"),
        )
    })?;
    map.fill(Color::WHITE);
    let view = Transform::from_scale(scale, scale);
    for mark in &figure.marks {
        match mark {
            Mark::Shape {
                points,
                fill,
                stroke,
            } => {
                if let Some(path) = polygon(points, true) {
                    map.fill_path(&path, &paint(fill), FillRule::Winding, view, None);
                    if let Some((color, width)) = stroke {
                        map.stroke_path(
                            &path,
                            &paint(color),
                            &pen(*width, Dash::Solid),
                            view,
                            None,
                        );
                    }
                }
            }
            Mark::Line {
                points,
                color,
                width,
                dash,
            } => {
                if let Some(path) = polygon(points, false) {
                    map.stroke_path(&path, &paint(color), &pen(*width, *dash), view, None);
                }
            }
            Mark::Word {
                at,
                text,
                size,
                anchor,
                color,
                upwards,
            } => {
                let back = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => 0.5,
                    Anchor::End => 1.0,
                } * width(text, *size);
                if let Some(path) = letters(text, *size) {
                    let place = Transform::from_translate(at.0 as f32, at.1 as f32);
                    let turn = Transform::from_rotate(if *upwards { -90.0 } else { 0.0 });
                    let start = Transform::from_translate(-back as f32, 0.0);
                    let all = start.post_concat(turn).post_concat(place).post_concat(view);
                    map.fill_path(&path, &paint(color), FillRule::Winding, all, None);
                }
            }
        }
    }
    // The paper is opaque, so nothing is premultiplied by less than 1.
    let rgba = map
        .pixels()
        .iter()
        .map(|p| [p.red(), p.green(), p.blue(), 255])
        .collect();
    Ok(Picture {
        width: w,
        height: h,
        rgba,
    })
}

fn polygon(points: &[(f64, f64)], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (i, (x, y)) in points.iter().enumerate() {
        if i == 0 {
            path.move_to(*x as f32, *y as f32);
        } else {
            path.line_to(*x as f32, *y as f32);
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn letters(text: &str, size: f64) -> Option<Path> {
    let mut path = PathBuilder::new();
    for stroke in outline(text, size) {
        match stroke {
            Stroke::Move(x, y) => path.move_to(x as f32, y as f32),
            Stroke::Line(x, y) => path.line_to(x as f32, y as f32),
            Stroke::Curve(a, b, x, y) => path.quad_to(a as f32, b as f32, x as f32, y as f32),
            Stroke::Close => path.close(),
        }
    }
    path.finish()
}

fn pen(width: f64, dash: Dash) -> Pen {
    Pen {
        width: width as f32,
        line_cap: LineCap::Butt,
        line_join: LineJoin::Round,
        // None where there are no lengths.
        dash: StrokeDash::new(dash.pattern().to_vec(), 0.0),
        ..Pen::default()
    }
}

fn paint(color: &str) -> Paint<'static> {
    let part = |at: usize| {
        color
            .get(at..at + 2)
            .and_then(|h| u8::from_str_radix(h, 16).ok())
            .unwrap_or(0)
    };
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    paint.set_color_rgba8(part(1), part(3), part(5), 255);
    paint
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::style::{INK, PAPER};
    use super::*;

    #[test]
    fn words_and_shapes_appear_where_they_stand() {
        let square = vec![(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)];
        let word = |at, upwards| Mark::Word {
            at,
            text: "HHHH".into(),
            size: 10.0,
            anchor: Anchor::Start,
            color: INK,
            upwards,
        };
        let figure = Figure {
            width: 100.0,
            height: 80.0,
            top: 0.0,
            title: String::new(),
            marks: vec![
                Mark::Shape {
                    points: square,
                    fill: "#d55e00",
                    stroke: None,
                },
                word((50.0, 20.0), false),
                word((30.0, 70.0), true),
            ],
        };
        let picture = raster(&figure, 2.0).unwrap();
        assert_eq!((picture.width, picture.height), (200, 160));
        let at = |x: u32, y: u32| picture.rgba[(y * 200 + x) as usize];
        assert_eq!((at(30, 30), at(2, 2)), ([0xd5, 0x5e, 0, 255], [255; 4]));
        for mark in &figure.marks[1..] {
            let b = mark.bounds();
            let ink = |b: [f64; 4]| {
                let mut dark = 0;
                for y in (b[1] * 2.0) as u32..(b[3] * 2.0) as u32 {
                    for x in (b[0] * 2.0) as u32..(b[2] * 2.0) as u32 {
                        dark += u32::from(at(x, y)[0] < 128);
                    }
                }
                dark
            };
            assert!(ink(b) > 60, "{b:?}: {}", ink(b));
            // Nothing of it stands beside its box.
            assert_eq!(ink([b[0], b[3] + 1.0, b[2], b[3] + 6.0]), 0);
        }
        assert!(
            raster(
                &Figure {
                    width: 0.0,
                    ..figure
                },
                1.0
            )
            .is_err()
        );
        assert_eq!(PAPER, "#ffffff");
    }
}
