//! Words and scales over the picture.

use super::keys::KEYS;
use super::legend::{Bar, Legend};
use eframe::egui::{
    self, Align2, Area, Color32, Context, Frame, Grid, Id, Order, Rect, RichText, Sense, TextStyle,
    Ui, Vec2, pos2, vec2,
};

/// Uses of the pointer, and their effect.
const POINTER: [[&str; 2]; 4] = [
    ["drag", "turn the camera about its target"],
    ["right drag", "shift camera and target"],
    ["wheel", "go nearer or farther"],
    ["drop a file", "show another scene, drawing or silhouette"],
];
/// The scale's bar, points.
const BAR: Vec2 = vec2(18.0, 220.0);
/// Distance from the edges of the free part, points.
const MARGIN: f32 = 12.0;

/// A dark box at a corner of the free part of the window, that lets the pointer through.
fn corner(context: &Context, name: &str, free: Rect, at: Align2, add: impl FnOnce(&mut Ui)) {
    Area::new(Id::new(name))
        .order(Order::Foreground)
        .interactable(false)
        .pivot(at)
        .fixed_pos(at.pos_in_rect(&free.shrink(MARGIN)))
        .constrain(false)
        .show(context, |ui| {
            let fill = Color32::from_gray(24);
            let frame = Frame::new().fill(fill).inner_margin(8).corner_radius(4);
            frame.show(ui, |ui| {
                ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                ui.visuals_mut().override_text_color = Some(Color32::from_gray(230));
                add(ui);
            });
        });
}

/// Shows the lines that are not empty at the lower left.
pub fn lines(context: &Context, free: Rect, lines: &[&str]) {
    let mut lines = lines.iter().filter(|line| !line.is_empty()).peekable();
    if lines.peek().is_some() {
        corner(context, "lines", free, Align2::LEFT_BOTTOM, |ui| {
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Wrap);
            ui.set_max_width((free.width() - 4.0 * MARGIN).max(80.0));
            lines.for_each(|line| {
                ui.label(*line);
            });
        });
    }
}

/// Shows all keys and uses of the pointer in the middle.
pub fn help(context: &Context, free: Rect) {
    corner(context, "help", free, Align2::CENTER_CENTER, |ui| {
        Grid::new("keys").spacing([16.0, 4.0]).show(ui, |ui| {
            let row = |ui: &mut Ui, [name, effect]: [&str; 2]| {
                ui.label(RichText::new(name).monospace());
                ui.label(effect);
                ui.end_row();
            };
            KEYS.iter().for_each(|(.., help)| row(ui, *help));
            row(ui, ["", ""]);
            POINTER.into_iter().for_each(|one| row(ui, one));
        });
    });
}

/// Shows the scale of a picture at the upper right.
pub fn legend(context: &Context, free: Rect, legend: &Legend) {
    corner(context, "legend", free, Align2::RIGHT_TOP, |ui| {
        ui.label(legend.title);
        if let Some(one) = &legend.bar {
            bar(ui, one);
        }
        for ([r, g, b], meaning) in &legend.keys {
            ui.horizontal(|ui| {
                let (area, _) = ui.allocate_exact_size(vec2(BAR.x, 12.0), Sense::hover());
                let color = Color32::from_rgb(*r, *g, *b);
                ui.painter().rect_filled(area, 0.0, color);
                ui.label(*meaning);
            });
        }
    });
}

/// The bar, its largest value on top, and its numbers.
fn bar(ui: &mut Ui, bar: &Bar) {
    let font = TextStyle::Body.resolve(ui.style());
    let space = vec2(BAR.x + 64.0, BAR.y + font.size);
    let (area, _) = ui.allocate_exact_size(space, Sense::hover());
    let corner = area.min + vec2(0.0, font.size * 0.5);
    let painter = ui.painter();
    let rows = BAR.y as u32;
    for row in 0..rows {
        let [r, g, b] = (bar.color)(1.0 - (f64::from(row) + 0.5) / f64::from(rows));
        let top = pos2(corner.x, corner.y + row as f32);
        let strip = Rect::from_min_size(top, vec2(BAR.x, 1.0));
        painter.rect_filled(strip, 0.0, Color32::from_rgb(r, g, b));
    }
    let light = Color32::from_gray(230);
    for (place, value) in &bar.ticks {
        let at = corner + vec2(BAR.x, BAR.y * (1.0 - *place as f32));
        painter.hline(at.x..=at.x + 5.0, at.y, (1.0, light));
        let at = at + vec2(9.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, value, font.clone(), light);
    }
}
