#![allow(clippy::unwrap_used)]
use super::*;
use crate::measure::row::tests::timed;
use crate::report::columns::tests::with_context;
use revmap::settings::Solver;
use revmap_figures::chart::style::{Marker, color};

fn item(stage: DrawStage, x: f64, y: f64, unresolved: bool) -> Item {
    Item {
        name: String::new(),
        style: Style::new(color::BLUE, Marker::DISK),
        joined: false,
        stage,
        point: Point {
            x,
            y,
            unresolved,
            ..Point::default()
        },
    }
}

/// All of compute is beaten by the fragment stage, and has a front nevertheless.
#[test]
fn each_stage_has_a_front_of_its_own() {
    use DrawStage::{Compute, Fragment};
    let items = [
        item(Fragment, 1.0, 1.0, false),
        item(Fragment, 2.0, 0.1, false),
        item(Fragment, 0.5, 0.01, true),
        item(Compute, 3.0, 3.0, false),
        item(Compute, 4.0, 5.0, false),
    ];
    let wanted = [
        (Fragment, vec![(1.0, 1.0), (2.0, 0.1)]),
        (Compute, vec![(3.0, 3.0)]),
    ];
    assert_eq!(fronts(&items), wanted);
    assert_eq!(fronts(&items[2..]), wanted[1..]);
}

/// A time that is not resolved is struck through and has no say in the law.
#[test]
fn charts_of_growth_mark_what_is_not_resolved() {
    let timed = |side: u32, passes: [f64; 3]| {
        timed(&passes).set(|s| *s = s.by(Solver::Exact).sized(side, side))
    };
    let mut rows = vec![
        timed(100, [1.0, 1.0, 1.0]),
        timed(200, [4.0, 4.0, 4.0]),
        timed(400, [16.0, 160.0, 16.0]),
    ];
    let exhibits = crate::report::exhibit::all(&[]).unwrap();
    let growth = exhibits.iter().find(|e| e.name == "growth-pixels").unwrap();
    let drawn = |rows: &[Row]| {
        with_context(rows, |context| {
            let all = context.rows;
            let figures = growth.chart[0].figures(context, all);
            let table = growth.table[0].shown(context, all).unwrap();
            (figures.unwrap().remove(0), table.records[0].clone())
        })
    };
    let told = |figure: &Figure| {
        let told = figure.words().iter().any(|w| w.0 == "not resolved");
        (told, figure.shapes().len())
    };
    let (figure, record) = drawn(&rows);
    // Three markers, one in the legend, and the one that explains the stroke.
    assert_eq!(told(&figure), (true, 5));
    assert_eq!(record[2..5], ["2 of 3", "1", "4"]);
    rows.pop();
    assert_eq!(told(&drawn(&rows).0), (false, 3));
}
