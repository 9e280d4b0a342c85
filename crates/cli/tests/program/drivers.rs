//! Variables of Vulkan's loader that name no driver are named by the message.

use super::run::Bench;
use std::process::Command;

const RENDER: &str = "render scene.toml -o out.png --size 16x12";
/// Every variable that the loader reads for drivers and layers.
const VARIABLES: [&str; 8] = [
    "VK_DRIVER_FILES",
    "VK_ICD_FILENAMES",
    "VK_ADD_DRIVER_FILES",
    "VK_LOADER_DRIVERS_SELECT",
    "VK_LOADER_DRIVERS_DISABLE",
    "VK_LAYER_PATH",
    "VK_ADD_LAYER_PATH",
    "VK_LOADER_LAYERS_DISABLE",
];

/// The program with these variables alone.
fn with(bench: &Bench, arguments: &str, set: &[(&str, &str)]) -> Command {
    let mut command = bench.command(arguments);
    for name in VARIABLES {
        command.env_remove(name);
    }
    command.envs(set.iter().copied());
    command
}

#[test]
fn variables_without_a_driver_are_named() {
    let bench = Bench::new();
    let driver = |name: &str, library: &str| {
        let text = format!("{{\"ICD\": {{{library}}}, \"file_format_version\": \"1.0.0\"}}");
        bench.file(name, text);
    };
    bench.file("damaged.json", "{\"ICD\": {\"library_path\": ");
    bench.file("text.json", "a driver");
    bench.file("empty.json", "");
    driver("bare.json", "");
    driver("gone.json", "\"library_path\": \"./libgone.so\"");
    driver("unknown.json", "\"library_path\": \"libvulkan_unknown.so\"");
    for folder in ["nothing", "several"] {
        std::fs::create_dir(bench.path(folder)).unwrap();
    }
    bench.file("several/damaged.json", "{");
    let not_json = "which is damaged: it is not JSON";
    let of_list = [
        (
            "/nonexistent.json",
            "/nonexistent.json, which does not exist",
        ),
        ("", "=, and none of them answers"),
        ("damaged.json", not_json),
        ("text.json", not_json),
        ("empty.json", not_json),
        ("bare.json", "bare.json, which names no driver"),
        ("gone.json", "libgone.so"),
        ("unknown.json", "libvulkan_unknown.so"),
        ("nothing", "nothing, which has no .json file"),
        ("several", "several/damaged.json, which is damaged"),
        ("/nonexistent.json:gone.json", "exist, and gone.json, which"),
    ];
    for name in &VARIABLES[..2] {
        for (value, words) in of_list {
            let words = [name, words, "correct or unset the variable"];
            bench.refused_by(&mut with(&bench, RENDER, &[(name, value)]), 3, &words);
        }
    }
    let damaged = [
        ("VK_ADD_DRIVER_FILES", "text.json"),
        ("VK_ADD_DRIVER_FILES", "gone.json:several"),
        ("VK_LAYER_PATH", "text.json"),
        ("VK_ADD_LAYER_PATH", "several"),
    ];
    let hidden = [
        ("VK_LOADER_DRIVERS_SELECT", "nothing*"),
        ("VK_LOADER_DRIVERS_DISABLE", "*"),
    ];
    let no_layers = ("VK_LAYER_PATH", "/none");
    let both = [
        ("VK_DRIVER_FILES", "/none.json"),
        ("VK_ICD_FILENAMES", "text.json"),
    ];
    let refused = |arguments, set: &[_], words: &[&str]| {
        bench.refused_by(&mut with(&bench, arguments, set), 3, words);
    };
    // A missing folder of layers hides no driver.
    let words = "chosen by VK_LOADER_DRIVERS_SELECT";
    refused(RENDER, &[no_layers, hidden[0]], &[words]);
    // Of two lists the loader reads the first.
    refused("devices", &both, &["VK_DRIVER_FILES names /none.json"]);
    // A damaged file among others keeps the loader from all drivers.
    for set in damaged {
        refused(RENDER, &[set], &[set.0, not_json]);
    }
    for set in hidden {
        let words = format!("{}={}", set.0, set.1);
        refused(RENDER, &[set], &[&words, "none of them answers"]);
    }
}

#[test]
fn variables_that_hide_the_layers_are_named() {
    let bench = Bench::new();
    let chosen = "the layers are chosen by";
    for (name, value, words) in [
        (
            "VK_LAYER_PATH",
            "/nonexistent",
            "/nonexistent, which does not exist",
        ),
        ("VK_LAYER_PATH", "", &format!("{chosen} VK_LAYER_PATH=")),
        (
            "VK_LOADER_LAYERS_DISABLE",
            "*",
            &format!("{chosen} VK_LOADER_LAYERS_DISABLE=*"),
        ),
    ] {
        let set = [(name, value), ("REVMAP_VALIDATION", "1")];
        let words = [name, words, "unset the variable"];
        bench.refused_by(&mut with(&bench, RENDER, &set), 3, &words);
    }
}
