//! `revmap shaders` on Mesa's RADV, which compiles for RDNA2 without a GPU: what our shaders cost
//! there, held to docs/shaders-navi21.csv.

use crate::run::{Bench, lines};
use revmap_bench::report::table::Table;
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::OnceLock;

const RENEW: &str = "if it must grow, renew docs/shaders-navi21.csv and docs/shaders.md by the command that stands there";

/// Cells by column.
type Row = HashMap<String, String>;

/// The driver's manifest, where the loader looks for them. It belongs to the drivers that the tests
/// run on.
fn manifest() -> PathBuf {
    let home = PathBuf::from(std::env::var_os("HOME").unwrap_or_default());
    let folders = ["/etc", "/usr/local/etc", "/usr/local/share", "/usr/share"].map(PathBuf::from);
    let own = [".config", ".local/share"].map(|folder| home.join(folder));
    let folders = own.iter().chain(&folders);
    let entries = folders.filter_map(|f| std::fs::read_dir(f.join("vulkan/icd.d")).ok());
    let named = |path: &PathBuf| path.to_string_lossy().contains("/radeon_icd");
    let mut files = entries.flatten().map(|entry| entry.unwrap().path());
    let Some(found) = files.find(named) else {
        panic!("no radeon_icd*.json: install mesa-vulkan-drivers (scripts/setup does)")
    };
    found
}

fn rows(text: &str) -> Vec<Row> {
    let Table { header, records } = Table::parse(text).unwrap();
    let row = |record| header.iter().cloned().zip(record).collect();
    records.into_iter().map(row).collect()
}

fn compiled() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let output = Bench::new()
            .command("shaders --csv")
            .env("VK_DRIVER_FILES", manifest())
            .env("VK_ICD_FILENAMES", manifest())
            .env("RADV_FORCE_FAMILY", "navi21")
            .output()
            .unwrap();
        assert!(output.status.success(), "{:?}", lines(&output));
        rows(&String::from_utf8(output.stdout).unwrap())
    })
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap()
}

fn name(row: &Row) -> String {
    ["technique", "stage", "solver", "path", "module", "shader"]
        .map(|c| row[c].as_str())
        .join(", ")
}

/// Another version of the compiler allots registers otherwise: instructions alone are compared
/// then, and loosely.
#[test]
fn shaders_grow_by_a_tenth_at_most() {
    let kept = rows(include_str!("../../../../docs/shaders-navi21.csv"));
    let now = compiled();
    let all = "VGPRs,Spilled VGPRs,Spilled SGPRs,Scratch size,Code size,Instructions";
    let all: Vec<&str> = all.split(',').collect();
    let (columns, most) = match kept[0]["driver"] == now[0]["driver"] {
        true => (&all[..], 1.1),
        false => (&all[5..], 1.5),
    };
    let mut compared = 0;
    for row in now {
        // A shader without a row would grow unseen.
        // Vertices of small and of large tables share a module, and differ by a constant.
        let before: Vec<&Row> = kept.iter().filter(|k| name(k) == name(row)).collect();
        let name = name(row);
        assert!(!before.is_empty(), "{name} is not in the file: {RENEW}");
        compared += 1;
        for column in columns {
            let before = before.iter().map(|row| number(row, column));
            let (before, now) = (before.fold(0.0, f64::max), number(row, column));
            let fits = now <= most * before;
            assert!(fits, "{name}: {column} was {before}, is {now}; {RENEW}");
        }
    }
    let all = kept.len();
    assert!(
        2 * compared >= all,
        "{compared} of {all} rows are left; {RENEW}"
    );
}

#[test]
fn no_shader_spills_vectors_or_takes_scratch_memory() {
    for row in compiled() {
        let spilled = [number(row, "Spilled VGPRs"), number(row, "Scratch size")];
        assert_eq!(spilled, [0.0; 2], "{}", name(row));
    }
}

/// A bare solid is drawn by the least code: nothing of the other techniques is left in it.
#[test]
fn what_a_scene_does_not_use_costs_nothing() {
    let pixels = |row: &&Row| {
        // General forms serve lights that a technique may not have.
        row["shader"] != "vertex"
            && !row["path"].ends_with("general")
            && !["depth alone", "every plane"].contains(&row["technique"].as_str())
    };
    // One shader compares depths and one does not, or one tests a patch and one eight: the lesser is
    // compared with the lesser.
    let mut compared = 0;
    for column in ["Instructions", "VGPRs"] {
        let mut all = BTreeMap::<_, BTreeMap<_, Vec<f64>>>::new();
        for row in compiled().iter().filter(pixels) {
            let place = ["stage", "solver", "path"].map(|c| row[c].clone());
            let technique = row["technique"].clone();
            let forms = all.entry(place).or_default().entry(technique).or_default();
            forms.push(number(row, column));
            forms.sort_by(f64::total_cmp);
        }
        for (place, techniques) in &all {
            let Some(bare) = techniques.get("revolution") else {
                continue;
            };
            for (technique, forms) in techniques.iter().filter(|(t, _)| *t != "8-bit map") {
                for (bare, has) in bare.iter().zip(forms) {
                    compared += 1;
                    let what = format!("{column} of {place:?} are {bare}, with {technique} {has}");
                    assert!(*bare <= 1.02 * has + 8.0, "{what}");
                }
            }
        }
    }
    assert!(compared > 50, "{compared}");
}
