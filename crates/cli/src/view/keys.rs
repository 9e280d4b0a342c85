//! The keys of the window: one table of what they do and of what the help says.

use super::shown::Inspected;
use eframe::egui::{Event, Key};
use revmap::settings::DrawStage;

/// The effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Help,
    Panel,
    Show(Inspected),
    Stage(DrawStage),
    ResetCamera,
    Screenshot,
    Undo,
    /// Closes the help, or the window.
    Close,
}

/// Keys with one effect, and in the help their names and their effect.
type Binding = (&'static [Key], Action, [&'static str; 2]);

/// All keys, in the order of the help.
pub const KEYS: [Binding; 13] = {
    use Action::*;
    use Inspected::*;
    use Key::{C, Escape, F, F1, H, Num1, Num2, Num3, Num4, Num5, P, Questionmark, R, Tab, Z};
    let [fragment, compute] = [Stage(DrawStage::Fragment), Stage(DrawStage::Compute)];
    let error = "depth error against the reference (takes seconds)";
    let save = "save the picture as PNG beside the scene";
    let help = ["H or ?", "show or hide this help"];
    [
        (&[H, Questionmark, F1], Help, help),
        (&[Tab], Panel, ["Tab", "show or hide the panel"]),
        (&[Num1], Show(Color), ["1", "lit colours"]),
        (&[Num2], Show(Depth), ["2", "depth"]),
        (&[Num3], Show(Normals), ["3", "normals"]),
        (&[Num4], Show(Steps), ["4", "steps of each pixel's search"]),
        (&[Num5], Show(Error), ["5", error]),
        (&[F], fragment, ["F", "trace in the fragment stage"]),
        (&[C], compute, ["C", "trace in the compute stage"]),
        (&[R], ResetCamera, ["R", "reset the camera"]),
        (&[P], Screenshot, ["P", save]),
        (&[Z], Undo, ["Ctrl+Z", "undo"]),
        (&[Escape], Close, ["Esc", "close this help, or quit"]),
    ]
};

/// Takes the keys of the table out of the events, and returns the effects of those pressed.
pub fn take(events: &mut Vec<Event>) -> Vec<Action> {
    let mut actions = Vec::new();
    events.retain(|event| {
        let Event::Key {
            key,
            pressed,
            repeat,
            modifiers,
            ..
        } = event
        else {
            return true;
        };
        // Undo alone is held with Ctrl (or Cmd).
        let held = modifiers.command || modifiers.ctrl;
        let fits =
            |(keys, action, _): &&Binding| keys.contains(key) && (*action == Action::Undo) == held;
        let bound = KEYS.iter().find(fits).filter(|_| !modifiers.alt);
        if let Some((_, action, _)) = bound.filter(|_| *pressed && !repeat) {
            actions.push(*action);
        }
        bound.is_none()
    });
    actions
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Modifiers;

    fn event(key: Key, modifiers: Modifiers, pressed: bool, repeat: bool) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat,
            modifiers,
        }
    }

    #[test]
    fn each_key_has_one_effect_and_a_line_of_help() {
        let all: Vec<_> = KEYS.iter().flat_map(|(keys, ..)| *keys).collect();
        for (n, key) in all.iter().enumerate() {
            assert!(!all[..n].contains(key), "{key:?}");
        }
        for (_, inspected) in Inspected::NAMES {
            let shows = |(_, action, _): &&Binding| *action == Action::Show(inspected);
            assert_eq!(KEYS.iter().filter(shows).count(), 1, "{inspected:?}");
        }
        let told = |(.., help): &Binding| help.iter().all(|h| !h.is_empty());
        assert!(KEYS.iter().all(told));
    }

    #[test]
    fn pressed_keys_act_once_and_are_taken() {
        let (none, ctrl) = (Modifiers::NONE, Modifiers::COMMAND);
        let mut events = vec![
            event(Key::Tab, none, true, false),
            event(Key::Tab, none, true, true),
            event(Key::Tab, none, false, false),
            event(Key::Questionmark, Modifiers::SHIFT, true, false),
            event(Key::Z, none, true, false),
            event(Key::Z, ctrl, true, false),
            event(Key::R, ctrl, true, false),
            event(Key::A, none, true, false),
        ];
        let taken = take(&mut events);
        assert_eq!(taken, [Action::Panel, Action::Help, Action::Undo]);
        // Keys without an effect are left to the controls.
        let left = |e: &Event| match e {
            Event::Key { key, .. } => Some(*key),
            _ => None,
        };
        let left: Vec<_> = events.iter().filter_map(left).collect();
        assert_eq!(left, [Key::Z, Key::R, Key::A]);
    }
}
