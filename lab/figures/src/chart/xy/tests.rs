use super::super::front::stairs;
use super::super::style::{Marker, PAPER, color};
use super::*;

fn one(style: Style, point: Point) -> Series {
    Series {
        name: String::new(),
        style,
        points: vec![point],
        joined: false,
    }
}

fn crowded() -> XyChart {
    let point = |index: usize, k: i32| Point {
        x: 10.0 * 1.05f64.powi(k + index as i32),
        y: if k == 6 { 0.0 } else { 0.3f64.powi(k) },
        label: Some(format!("{k} steps")),
        unresolved: k == 2,
        ..Point::default()
    };
    let series = |index: usize| Series {
        name: format!("a search of some length, number {index}"),
        style: Style {
            filled: index.is_multiple_of(2),
            heavy: index == 3,
            ..Style::numbered(index)
        },
        points: (0..7).map(|k| point(index, k)).collect(),
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
    assert_eq!(crowded().figure().faults(), [""; 0]);
    for (low, high) in [(1e-9, 1e9), (0.999, 1.001), (21.0, 26.0), (3.0, 3.0)] {
        let mut chart = crowded();
        chart.series.truncate(1);
        chart.series[0].points = [low, high].map(|v| Point::at(v, v)).to_vec();
        assert_eq!(chart.figure().faults(), [""; 0], "{low} to {high}");
    }
    // The check itself finds what is planted.
    let mut figure = crowded().figure();
    let word = |at, text| Mark::word(at, text, 14.0, Anchor::Start, INK);
    figure.marks.push(word((20.0, 30.0), "planted"));
    figure.marks.push(word((-20.0, 300.0), "outside"));
    assert!(figure.faults().len() >= 2);
}

#[test]
fn series_of_one_name_share_an_entry() {
    let mut chart = crowded();
    chart.series.truncate(3);
    for (k, series) in chart.series.iter_mut().enumerate() {
        series.name = ["hull", "hull", "live"][k].to_owned();
    }
    let legend = chart.legend(|_| true).into_iter();
    let keys: Vec<_> = legend.map(|(n, k)| (n, k.len())).collect();
    let wanted = [
        ("hull", 2),
        ("live", 1),
        ("Pareto front", 1),
        ("not resolved", 1),
    ];
    assert_eq!(keys, wanted.map(|(n, k)| (n.to_owned(), k)));
    assert_eq!(chart.figure().faults(), [""; 0]);
}

#[test]
fn points_stand_where_their_values_are() {
    let mut chart = crowded();
    let points = [(1.0, 1.0), (10.0, 0.1), (100.0, 0.01)];
    let series = points.map(|(x, y)| one(Style::numbered(1), Point::at(x, y)));
    chart.series = series.to_vec();
    chart.guides.clear();
    let center = |b: Bounds| ((b[0] + b[2]) / 2.0, (b[1] + b[3]) / 2.0);
    let dots = chart.figure().shapes().into_iter();
    let centers: Vec<_> = dots.map(center).collect();
    assert_eq!(centers.len(), 3);
    // Equal ratios, equal ways; less error is further down.
    assert!((centers[1].0 * 2.0 - centers[0].0 - centers[2].0).abs() < 1e-6);
    assert!(centers[0].0 < centers[1].0 && centers[0].1 < centers[1].1);
}

#[test]
fn lines_are_cut_at_the_plot() {
    let plot = [0.0, 0.0, 10.0, 10.0];
    let line = [(-5.0, 5.0), (5.0, 5.0), (5.0, 20.0), (20.0, 20.0)];
    assert_eq!(clip(&line, plot), [[(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)]]);
    assert!(clip(&[(-5.0, -5.0), (-1.0, 20.0)], plot).is_empty());
}

/// Three series at one place: heavy and filled, hollow, filled.
fn piled() -> XyChart {
    let series = |(heavy, filled)| {
        let style = Style::new(color::BLUE, Marker::DISK);
        let point = Point {
            spread: Some((1.0, 4.0)),
            ..Point::at(2.0, 3.0)
        };
        one(
            Style {
                heavy,
                filled,
                ..style
            },
            point,
        )
    };
    let looks = [(true, true), (false, true), (false, false)];
    XyChart {
        title: "A pile".into(),
        x: Axis::log("x"),
        y: Axis::log("y"),
        series: looks.map(series).to_vec(),
        guides: vec![Guide::dashed("Pareto front", vec![(2.0, 3.0)])],
    }
}

#[test]
fn hollow_markers_hide_nothing_and_bars_lie_below() {
    let figure = piled().figure();
    let fills = figure.marks.iter().filter_map(|m| match m {
        Mark::Shape(_, fill, _) => Some(*fill),
        _ => None,
    });
    let fills: Vec<&str> = fills.collect();
    assert_eq!(fills, [PAPER, color::BLUE, color::BLUE]);
    let sizes: Vec<f64> = figure.shapes().iter().map(|b| b[2] - b[0]).collect();
    // The heavier of the filled ones lies below.
    assert!(sizes[1] > sizes[2]);
    // A bar from 1 to 4 is twice as long to the left of 2 as to its right, in octaves as long.
    let bar = |m: &Mark| matches!(m, Mark::Line(_, color, ..) if *color == color::BLUE);
    let dot = |m: &Mark| matches!(m, Mark::Shape(..));
    let mut marks = figure.marks.iter();
    assert_eq!(marks.clone().filter(|m| bar(m)).count(), 3);
    assert!(marks.clone().rposition(bar) < marks.position(dot));
}

/// Every unresolved point is struck through, and the legend says what that means.
#[test]
fn unresolved_points_are_struck_through() {
    let strokes = |chart: &XyChart| {
        let figure = chart.figure();
        assert_eq!(figure.faults(), [""; 0]);
        let words = figure.words();
        let told = words.iter().filter(|w| w.0 == "not resolved").count();
        let struck = |m: &&Mark| match m {
            Mark::Line(p, ..) => p[0].0 != p[1].0 && p[0].1 != p[1].1,
            _ => false,
        };
        (figure.marks.iter().filter(struck).count(), told)
    };
    let mut chart = piled();
    assert_eq!(strokes(&chart), (0, 0));
    // A front of one point is no line and not in the legend.
    let front = |chart: &XyChart| chart.figure().words().iter().any(|w| w.0 == "Pareto front");
    assert!(!front(&chart));
    chart.guides[0].points.push((2.5, 3.0));
    assert!(front(&chart));
    chart.guides.clear();
    chart.series[1].points[0].unresolved = true;
    chart.series[0].points[0].rise = Some((2.0, 5.0));
    // One in the plot and one in the legend.
    assert_eq!(strokes(&chart), (2, 1));
}
