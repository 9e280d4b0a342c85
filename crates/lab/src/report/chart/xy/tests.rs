use super::super::front::stairs;
use super::super::style::{Marker, PAPER, color};
use super::*;

fn crowded() -> XyChart {
    let series = |index: usize| Series {
        name: format!("a search of some length, number {index}"),
        style: Style {
            filled: index.is_multiple_of(2),
            heavy: index == 3,
            ..Style::new(color::ALL[index % color::ALL.len()], Marker::ALL[index])
        },
        points: (0..7)
            .map(|k| Point {
                x: 10.0 * 1.05f64.powi(k + index as i32),
                y: if k == 6 { 0.0 } else { 0.3f64.powi(k) },
                label: Some(format!("{k} steps")),
                unresolved: k == 2,
                ..Point::default()
            })
            .collect(),
        joined: true,
    };
    XyChart {
        title: "A title that is long enough to need more than one line, since it says a great deal about what is shown below".into(),
        x: Axis::log("time of a frame (ms)"),
        y: Axis::log("depth error, p99 (h/512)").from(1e-3),
        series: (0..9).map(series).collect(),
        guides: vec![Guide::dashed("Pareto front", stairs(&[(10.0, 1.0), (12.0, 0.1)]))],
    }
}

#[test]
fn no_words_cover_each_other_however_crowded() {
    assert_eq!(crowded().figure().faults(), Vec::<String>::new());
    for (low, high) in [(1e-9, 1e9), (0.999, 1.001), (21.0, 26.0), (3.0, 3.0)] {
        let mut chart = crowded();
        chart.series.truncate(1);
        chart.series[0].points = [low, high]
            .map(|v| Point {
                x: v,
                y: v,
                ..Point::default()
            })
            .to_vec();
        assert_eq!(
            chart.figure().faults(),
            Vec::<String>::new(),
            "{low} to {high}"
        );
    }
    // The check itself finds what is planted.
    let mut figure = crowded().figure();
    figure.marks.push(Mark::word(
        (20.0, 30.0),
        "planted",
        14.0,
        Anchor::Start,
        INK,
    ));
    figure.marks.push(Mark::word(
        (-20.0, 300.0),
        "outside",
        14.0,
        Anchor::Start,
        INK,
    ));
    assert!(figure.faults().len() >= 2);
}

#[test]
fn series_of_one_name_share_an_entry() {
    let mut chart = crowded();
    chart.series.truncate(3);
    for (k, series) in chart.series.iter_mut().enumerate() {
        series.name = ["hull", "hull", "live"][k].to_owned();
    }
    let keys: Vec<_> = chart
        .legend(|_| true)
        .into_iter()
        .map(|(n, k)| (n, k.len()))
        .collect();
    let wanted = [
        ("hull", 2),
        ("live", 1),
        ("Pareto front", 1),
        ("not resolved", 1),
    ];
    assert_eq!(keys, wanted.map(|(n, k)| (n.to_owned(), k)));
    assert_eq!(chart.figure().faults(), Vec::<String>::new());
}

#[test]
fn points_stand_where_their_values_are() {
    let mut chart = crowded();
    chart.series = vec![Series {
        name: String::new(),
        style: Style::new(color::BLUE, Marker::DISK),
        joined: false,
        points: vec![],
    }];
    chart.series[0].points = [(1.0, 1.0), (10.0, 0.1), (100.0, 0.01)]
        .map(|(x, y)| Point {
            x,
            y,
            ..Point::default()
        })
        .to_vec();
    chart.guides.clear();
    let centers: Vec<_> = chart
        .figure()
        .marks
        .iter()
        .filter_map(|m| match m {
            Mark::Shape { .. } => Some(m.bounds()),
            _ => None,
        })
        .map(|b| ((b[0] + b[2]) / 2.0, (b[1] + b[3]) / 2.0))
        .collect();
    assert_eq!(centers.len(), 3);
    // Equal ratios, equal ways; less error is further down.
    assert!((centers[1].0 * 2.0 - centers[0].0 - centers[2].0).abs() < 1e-6);
    assert!(centers[0].0 < centers[1].0 && centers[0].1 < centers[1].1);
}

#[test]
fn lines_are_cut_at_the_plot() {
    let plot = [0.0, 0.0, 10.0, 10.0];
    assert_eq!(
        clip(&[(-5.0, 5.0), (5.0, 5.0), (5.0, 20.0), (20.0, 20.0)], plot),
        [vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)]]
    );
    assert!(clip(&[(-5.0, -5.0), (-1.0, 20.0)], plot).is_empty());
}

/// Three series at one place: heavy and filled, hollow, filled.
fn piled() -> XyChart {
    let at = |style: Style| Series {
        name: String::new(),
        style,
        points: vec![Point {
            x: 2.0,
            y: 3.0,
            spread: Some((1.0, 4.0)),
            ..Point::default()
        }],
        joined: false,
    };
    let plain = Style::new(color::BLUE, Marker::DISK);
    let hollow = Style {
        filled: false,
        ..plain
    };
    let heavy = Style {
        heavy: true,
        ..plain
    };
    XyChart {
        title: "A pile".into(),
        x: Axis::log("x"),
        y: Axis::log("y"),
        series: vec![at(heavy), at(plain), at(hollow)],
        guides: vec![Guide::dashed("Pareto front", vec![(2.0, 3.0)])],
    }
}

#[test]
fn hollow_markers_hide_nothing_and_bars_lie_below() {
    let figure = piled().figure();
    let fills: Vec<&str> = (figure.marks.iter())
        .filter_map(|m| match m {
            Mark::Shape { fill, .. } => Some(*fill),
            _ => None,
        })
        .collect();
    assert_eq!(fills, [PAPER, color::BLUE, color::BLUE]);
    let sizes: Vec<f64> = (figure.marks.iter())
        .filter(|m| matches!(m, Mark::Shape { .. }))
        .map(|m| m.bounds()[2] - m.bounds()[0])
        .collect();
    assert!(
        sizes[1] > sizes[2],
        "the heavier of the filled ones lies below"
    );
    // A bar from 1 to 4 is twice as long to the left of 2 as to its right, in octaves as long.
    let bar = |m: &Mark| matches!(m, Mark::Line { color, .. } if *color == color::BLUE);
    let first_dot = figure
        .marks
        .iter()
        .position(|m| matches!(m, Mark::Shape { .. }));
    assert_eq!(figure.marks.iter().filter(|m| bar(m)).count(), 3);
    assert!(figure.marks.iter().rposition(bar) < first_dot);
}

#[test]
fn a_front_of_one_point_is_no_line_and_not_in_the_legend() {
    let words = |chart: &XyChart| {
        let figure = chart.figure();
        let said = figure.marks.into_iter().filter_map(|m| match m {
            Mark::Word { text, .. } => Some(text),
            _ => None,
        });
        said.collect::<Vec<_>>()
    };
    let mut chart = piled();
    assert!(!words(&chart).contains(&"Pareto front".to_owned()));
    chart.guides[0].points.push((2.5, 3.0));
    assert!(words(&chart).contains(&"Pareto front".to_owned()));
}

/// Every unresolved point is struck through, and the legend says what that means; without one,
/// nothing is.
#[test]
fn unresolved_points_are_struck_through() {
    let strokes = |chart: &XyChart| {
        let figure = chart.figure();
        assert_eq!(figure.faults(), Vec::<String>::new());
        let marks = figure.marks.iter();
        let told = |m: &&Mark| matches!(m, Mark::Word { text, .. } if text == "not resolved");
        let struck = |m: &&Mark| match m {
            Mark::Line { points, .. } => points[0].0 != points[1].0 && points[0].1 != points[1].1,
            _ => false,
        };
        let count = marks.clone().filter(struck).count();
        (count, marks.filter(told).count())
    };
    let mut chart = piled();
    assert_eq!(strokes(&chart), (0, 0));
    chart.series[1].points[0].unresolved = true;
    chart.series[0].points[0].rise = Some((2.0, 5.0));
    // One in the plot and one in the legend.
    assert_eq!(strokes(&chart), (2, 1));
}
