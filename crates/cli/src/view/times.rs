//! The graph of frame times.

use eframe::egui::{Color32, Rect, Sense, Stroke, Ui, pos2, vec2};
use std::collections::VecDeque;

/// Number of frames in the graph.
const SHOWN: usize = 120;

/// The cost of a frame.
#[derive(Clone, Copy, Default)]
pub struct Cost {
    /// CPU time to apply changes and to record, milliseconds.
    pub prepare: f64,
    /// Device time, milliseconds.
    pub device: f64,
    /// CPU time to read the picture back and to paint the window, milliseconds.
    pub present: f64,
    /// Number of compiled pipelines.
    pub compiled: u64,
}

/// A part of a frame's cost: its name, colour and time.
type Part = (&'static str, Color32, fn(&Cost) -> f64);

const PARTS: [Part; 3] = [
    ("prepare", Color32::from_rgb(230, 160, 60), |c| c.prepare),
    ("device", Color32::from_rgb(90, 170, 230), |c| c.device),
    ("present", Color32::from_rgb(130, 200, 120), |c| c.present),
];

/// The last frames, or all frames if they are to be written.
#[derive(Default)]
pub struct Times {
    last: VecDeque<Cost>,
    pub kept: Option<Vec<Cost>>,
}

impl Times {
    pub fn push(&mut self, cost: Cost) {
        self.last.push_back(cost);
        if self.last.len() > SHOWN {
            self.last.pop_front();
        }
        if let Some(kept) = &mut self.kept {
            kept.push(cost);
        }
    }

    pub fn show(&self, ui: &mut Ui) {
        let most = self
            .last
            .iter()
            .map(|c| PARTS.iter().map(|p| p.2(c)).sum())
            .fold(1.0, f64::max);
        let (area, _) = ui.allocate_exact_size(vec2(ui.available_width(), 60.0), Sense::hover());
        let painter = ui.painter_at(area);
        painter.rect_filled(area, 2.0, Color32::from_black_alpha(120));
        let width = area.width() / SHOWN as f32;
        for (n, cost) in self.last.iter().enumerate() {
            let (left, mut low) = (area.left() + width * n as f32, area.bottom());
            for (_, color, part) in &PARTS {
                let high = low - area.height() * (part(cost) / most) as f32;
                let bar = Rect::from_two_pos(pos2(left, low), pos2(left + width, high));
                painter.rect_filled(bar, 0.0, *color);
                low = high;
            }
            if cost.compiled > 0 {
                let line = Stroke::new(1.0, Color32::RED);
                painter.vline(left, area.y_range(), line);
            }
        }
        let last = self.last.back().copied().unwrap_or_default();
        ui.horizontal_wrapped(|ui| {
            for (name, color, part) in PARTS {
                ui.colored_label(color, format!("{name} {:.1} ms", part(&last)));
            }
        });
        let compiled: u64 = self.last.iter().map(|c| c.compiled).sum();
        ui.label(format!(
            "graph up to {most:.1} ms; {compiled} pipelines compiled in it"
        ));
    }
}
