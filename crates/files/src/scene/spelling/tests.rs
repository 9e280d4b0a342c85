//! Hints that propose a value are fed back: none is refused at the same key.

#![allow(clippy::unwrap_used)]
use super::super::keys::OBJECT;
use super::super::reader::{CAMERA, LIGHT};
use super::super::{SceneFile, warnings};
use revmap::error::Result;
use revmap::scene::Scene;

const EYE: &str = "eye = [2, 0, 0.5]\n";
const CONE: &str = "polygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\n";

/// A scene with a line in the table of its key.
fn text(table: &str, line: &str) -> String {
    let within = |name| if table == name { line } else { "" };
    let eye = if line.starts_with("eye") { "" } else { EYE };
    let target = "target = [0, 0, 0.5]\n";
    let target = if line.starts_with("target") {
        ""
    } else {
        target
    };
    let cone = match line {
        _ if line.starts_with("polygon") => "",
        _ if line.starts_with("profile") => "profile = \".\"\n",
        _ => CONE,
    };
    let [root, camera, light, object] = ["", "camera", "light", "object"].map(within);
    format!(
        "{root}\n[camera]\n{eye}{target}{camera}\n[[light]]\n{light}\n[[object]]\n{cone}{object}\n"
    )
}

fn read(text: &str, sets: &[String]) -> Result<Scene> {
    SceneFile::parse(text, "").and_then(|mut file| file.scene(sets))
}

/// Values that are refused for most keys.
const VALUES: &str = r#".5 5. -.5 +5. 07 -0,5 0,5 1,000 1e400 -1e400 1.e400 12345678901234567890
    -12345678901234567890 99999999999999999999999999999999999999999999 0x1ffffffffffffffffff 1,5e400 True FALSE
    "0,5" "1,000" ".5" "1" "1e400" "-0,5" "True" [.5,1,0] [1e400,3,2] [12345678901234567890,1,1] [1,.5] [1.e400,0,0,1]
    [True,False,True] ["0,5",1,1] ["1,000",1,2] [[0,.1],[.3,.1],[0,.9]] [[0,1e400],[.3,.1],[0,.9]] 1,000,000 1.5.2 1e12. 5e12.
    [-.5,-1,-1] [0,5] 0.1f inf nan"#;

/// Every key with every value: what is proposed is TOML, and of the type that the key takes in place
/// of a text.
#[test]
fn a_proposed_spelling_is_taken() {
    let tables = [("", "background ambient shadow"), ("camera", CAMERA)];
    let tables = tables
        .into_iter()
        .chain([("light", LIGHT), ("object", OBJECT)]);
    let mut proposed = 0;
    for (table, keys) in tables {
        for (key, value) in keys
            .split_whitespace()
            .flat_map(|key| VALUES.split_whitespace().map(move |value| (key, value)))
        {
            let line = format!("{key} = {value}");
            let Err(refusal) = read(&text(table, &line), &[]) else {
                continue;
            };
            let message = refusal.to_string();
            let strange = message.contains("i128") || message.contains("write inf");
            assert!(!strange, "{line}: {message}");
            let hints = message
                .split_once("; write ")
                .map_or("", |(_, hints)| hints);
            for hint in hints.split(" or ").filter(|hint| !hint.is_empty()) {
                proposed += 1;
                let again = read(&text(table, &format!("{key} = {hint}")), &[]);
                let words = match value.contains('"') {
                    true => "expected",
                    false => "is not TOML",
                };
                let again = again.map_or_else(|e| e.to_string(), |_| String::new());
                let refused = again.contains(words) && !again.contains("duplicate key");
                assert!(!refused, "{line}: {message}");
            }
        }
    }
    assert!(proposed > 80, "{proposed}");
}

/// Assignments, and the start of the proposal in their refusal.
const SETS: &str = "
camera.up=[0,0,0] => give |camera.up
camera.up=[-4,0,0] => as to |camera.up
camera.eye=[0,0,3] camera.up=[0,0,1] => as to |camera.up
camera.eye=[0,3,0.5] camera.up=[0,1,0] => as to |camera.up
camera.eye=[0,3,0.5] camera.up=[0,0,0] => give |camera.up
object.0.rotation=[0,0,0,0] => quaternion; |object.0.rotation
object.0.extend=0,5 => write |object.0.extend
object.0.map_rows=\"100\" => write |object.0.map_rows
";

#[test]
fn a_proposed_value_is_taken() {
    let scene = text("", "");
    for (sets, wanted) in SETS.lines().filter_map(|line| line.split_once(" => ")) {
        let sets: Vec<String> = sets.split(' ').map(str::to_owned).collect();
        let (before, key) = wanted.split_once('|').unwrap();
        let message = read(&scene, &sets).unwrap_err().to_string();
        let (_, hint) = message.split_once(before).expect(&message);
        let hint = hint.split(" is ").next().unwrap();
        let mended = [sets.as_slice(), &[format!("{key}={hint}")]].concat();
        assert!(read(&scene, &mended).is_ok(), "{message}");
    }
    let dark = scene.replace("[[light]]", "");
    let refusal = read(&dark, &["light.0.radius=1".to_owned()]).unwrap_err();
    let (_, hint) = refusal.message.split_once("or set ").unwrap();
    let hint = hint.strip_suffix(" first").unwrap();
    assert!(read(&dark, &[hint.to_owned()]).is_ok(), "{refusal}");
}

#[test]
fn a_proposed_field_of_view_is_wide_enough() {
    for fov in ["1e-300", "1e-9", "1e-4", "0.0349", "0.035", "0.7", "1.9999"] {
        let scene = read(&text("camera", &format!("fov_y = {fov}")), &[]).unwrap();
        let found = warnings(&scene, 80, 60);
        assert!(found.len() == 1 && found[0].len() < 100, "{found:?}");
        let digits = |c: char| !c.is_ascii_digit() && c != '.';
        let hint = found[0].rsplit(' ').next().unwrap().trim_matches(digits);
        let again = read(&text("camera", &format!("fov_y = {hint}")), &[]).unwrap();
        assert_eq!(warnings(&again, 80, 60), [""; 0], "{found:?}");
    }
}
