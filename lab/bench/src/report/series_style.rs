//! How ways of drawing are called and look, in every chart of every report.

use crate::measure::row::Row;
use crate::plan::method::{Edges, Method, MethodSettings};
use crate::plan::{RBM_BASELINE, is_rbm_baseline};
use revmap::maps::MapSource;
use revmap::search::Search;
use revmap::settings::{DrawStage, Solver, Tolerance};
use revmap_figures::chart::style::{Dash, Marker, Style, color};
use revmap_figures::chart::xy::Guide;
use revmap_files::{BINARY, COVERAGE};
use revmap_searches::folder::{self, Folder};

/// How a method looks in the fragment stage, meshes of every fineness alike. The default stands
/// out; searches of one family have one colour: equal steps, and cones.
fn search(method: Method) -> Style {
    let (color, marker, dash) = match method {
        Method::Search(Solver::Other(search)) => match search.name {
            "linear" => (color::GREY, Marker::LEFT, Dash::DOTS),
            "relief" => (color::GREY, Marker::RIGHT, Dash::SHORT),
            "secant" => (color::GREY, Marker::STAR, Dash::DASH_DOT),
            "circle" => (color::ORANGE, Marker::PLUS, Dash::DOTS),
            "cone" => (color::PURPLE, Marker::CROSS, Dash::SHORT),
            "relaxed" => (color::PURPLE, Marker::HEXAGRAM, Dash::DOTS),
            _ => of_folder(search),
        },
        Method::Search(Solver::Live) => (color::SKY, Marker::UP, Dash::DASH_DOT),
        Method::Search(Solver::Quadric) => (color::GREEN, Marker::DOWN, Dash::LONG),
        Method::Search(Solver::Exact) => (color::VERMILION, Marker::DISK, Dash::SOLID),
        Method::MeshWithin { .. } => (color::BLUE, Marker::HEXAGRAM, Dash::LONG),
        Method::Mesh { .. } => (color::BLUE, Marker::SQUARE, Dash::SOLID),
        Method::Floor => (color::BLACK, Marker::PLUS, Dash::SOLID),
    };
    Style {
        dash,
        heavy: method == Method::DEFAULT,
        ..Style::new(color, marker)
    }
}

/// The looks of searches of other people's folders, in the order in which they were loaded. The
/// first is solid: the Pareto front is dashed.
fn of_folder(search: &'static Search) -> (&'static str, Marker, Dash) {
    let own = folder::of(Solver::Other(search)).map(Folder::name);
    let all = folder::all();
    let place = all.iter().position(|f| Some(f.name()) == own);
    match place.unwrap_or(0) % 6 {
        0 => (color::PURPLE, Marker::DIAMOND, Dash::SOLID),
        1 => (color::BLUE, Marker::STAR, Dash::DASH_DOT),
        2 => (color::GREY, Marker::HEXAGRAM, Dash::SHORT),
        3 => (color::BLACK, Marker::SQUARE, Dash::DOTS),
        4 => (color::GREEN, Marker::RIGHT, Dash::SHORT),
        _ => (color::PURPLE, Marker::LEFT, Dash::DOTS),
    }
}

/// How a way of drawing looks: filled in the fragment stage, hollow in the compute stage.
pub fn style(s: &MethodSettings) -> Style {
    let mut look = match is_rbm_baseline(s) {
        true => Style::new(color::BLACK, Marker::DIAMOND),
        false => search(s.method),
    };
    look.filled = s.stage != DrawStage::Compute;
    look
}

/// The line of the floor's time: solid in the fragment stage, dotted in compute.
pub(crate) fn floor_line(s: &MethodSettings, time: f64) -> Guide {
    // Over every axis of errors.
    let points = vec![(time, 1e-12), (time, 1e12)];
    let mut line = Guide::dashed(&format!("floor, {}", s.stage.name()), points);
    line.dash = match s.stage {
        DrawStage::Compute => Dash::DOTS,
        DrawStage::Fragment => Dash::SOLID,
    };
    line
}

/// How a source of distances looks, in charts that compare sources.
pub fn of_source(source: MapSource) -> Style {
    match source {
        _ if source == BINARY => Style::new(color::BLACK, Marker::SQUARE),
        _ if source == COVERAGE => Style::new(color::BLUE, Marker::DISK),
        _ => Style::new(color::VERMILION, Marker::UP),
    }
}

/// Names and looks of the ways of drawing that one report holds; names as brief as tells them apart.
#[derive(Clone, Debug)]
pub struct SeriesStyles {
    /// True for what differs between the ways: steps, rows, source, format, tolerance.
    differs: [bool; 5],
    /// Each way's name and its look in the fragment stage.
    ways: Vec<(String, Style)>,
}

impl SeriesStyles {
    /// The styles of these ways. One search in several ways, by its steps or its maps, keeps its
    /// colour and takes the next marker that is free; meshes are alike.
    pub fn new<'a>(settings: impl IntoIterator<Item = &'a MethodSettings> + Clone) -> Self {
        // The RBM baseline, meshes and the floor have names of their own.
        let own = |s: &MethodSettings| s.method.is_mesh() || s.method == Method::Floor;
        let named = settings.clone().into_iter();
        let named = named.filter(|s| !own(s) && !is_baseline_of_any_rows(s));
        let named: Vec<&MethodSettings> = named.collect();
        let differs = |same: fn(&MethodSettings, &MethodSettings) -> bool| {
            named.windows(2).any(|pair| !same(pair[0], pair[1]))
        };
        let mut all = Self {
            differs: [
                differs(|a, b| a.max_steps == b.max_steps),
                differs(|a, b| a.map_rows == b.map_rows),
                differs(|a, b| a.map_source == b.map_source),
                differs(|a, b| a.map_format == b.map_format),
                differs(|a, b| a.tolerance == b.tolerance),
            ],
            ways: Vec::new(),
        };
        for s in settings {
            let way = all.way(s);
            if all.ways.iter().any(|(known, _)| *known == way) {
                continue;
            }
            let wanted = style(&s.in_stage(DrawStage::Fragment));
            let free = |marker: &Marker| {
                let taken = |k: &Style| (k.color, k.marker) == (wanted.color, *marker);
                !all.ways.iter().any(|(_, known)| taken(known))
            };
            let mut markers = std::iter::once(wanted.marker).chain(Marker::ALL);
            // Meshes differ by their names alone.
            let marker = markers.find(|m| s.method.is_mesh() || free(m));
            let marker = marker.unwrap_or(wanted.marker);
            all.ways.push((way, Style { marker, ..wanted }));
        }
        all
    }

    /// The styles of the ways in which rows were drawn.
    pub fn of(rows: &[&Row]) -> Self {
        Self::new(rows.iter().map(|r| &r.settings))
    }

    /// The search and what else tells a way from the others, without the stage.
    pub fn way(&self, s: &MethodSettings) -> String {
        let [steps, rows, source, format, tolerance] = self.differs;
        let rows = s.map_rows.filter(|_| rows);
        let rows = rows.map_or(String::new(), |n| format!(" {n} rows"));
        if is_baseline_of_any_rows(s) {
            return format!("{RBM_BASELINE}{rows}");
        }
        let mut name = s.method.to_string();
        if s.edges != Edges::OneRay {
            name += &format!(", {}", s.edges.name());
        }
        if s.method.is_mesh() {
            return name; // which has neither steps nor a map
        }
        // A search without a loop has no bound to tell.
        if steps && s.method.default_steps(false) > 1 {
            let steps = s.max_steps.unwrap_or_else(|| s.method.default_steps(false));
            name += &format!(" {steps} steps");
        }
        name += &rows;
        let maps = s.method.reads_map();
        if let (true, Some(source)) = (source && maps, s.map_source) {
            name += &format!(" {}", source.name);
        }
        if format && maps {
            name += &format!(" {}", s.map_format.name());
        }
        let exact = s.tolerance == Tolerance::EXACT;
        if tolerance && s.method.follows_tolerance() && !exact {
            name += &format!(" {} px", s.tolerance);
        }
        name
    }

    /// How a way looks.
    pub fn style(&self, s: &MethodSettings) -> Style {
        let way = self.way(s);
        let known = self.ways.iter().find(|(name, _)| *name == way);
        let mut own = style(s);
        own.marker = known.map_or(own.marker, |(_, look)| look.marker);
        own
    }
}

/// True if settings are those of the RBM baseline, whatever rows its map has.
fn is_baseline_of_any_rows(s: &MethodSettings) -> bool {
    is_rbm_baseline(&MethodSettings {
        map_rows: None,
        ..*s
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::rbm_baseline;
    use crate::plan::view::tests::spindle;
    use revmap::maps::MapFormat;
    use revmap_searches::CIRCLE;

    /// All that a chart can hold: every search, the RBM baseline, meshes of seven finenesses.
    fn all() -> Vec<MethodSettings> {
        let base = MethodSettings::default();
        let of = |method| MethodSettings { method, ..base };
        let meshes = [16, 64, 512].map(|n| Method::mesh(n, 2 * n).unwrap());
        let mut ways: Vec<MethodSettings> = Method::ALL.map(of).to_vec();
        ways.push(rbm_baseline(&spindle(), &base));
        ways.extend(meshes.map(of));
        ways
    }

    #[test]
    fn no_two_searches_share_a_marker_and_none_but_families_a_colour() {
        let ways = all();
        let searches = &ways[..=Method::ALL.len()];
        let family = |s: &MethodSettings| match s.method.name() {
            "linear" | "relief" | "secant" => "equal steps".to_owned(),
            "cone" | "relaxed" => "cones".to_owned(),
            name => format!("{name} {}", is_rbm_baseline(s)),
        };
        for (i, s) in searches.iter().enumerate() {
            for other in &searches[..i] {
                let alike = family(s) == family(other);
                let (a, b) = (style(s), style(other));
                assert_eq!(a.color == b.color, alike, "{a:?} {b:?}");
                assert!(a.marker != b.marker, "{a:?} {b:?}");
                assert!(!alike || a.dash != b.dash, "{a:?} {b:?}");
            }
            assert!(color::ALL.contains(&style(s).color));
            assert_eq!(style(s).heavy, s.method == Method::DEFAULT);
        }
        for (i, a) in ways.iter().enumerate() {
            for b in &ways[..i] {
                let meshes = a.method.is_mesh() && b.method.is_mesh();
                let (a, b) = (style(a), style(b));
                assert_eq!(meshes, (a.color, a.marker) == (b.color, b.marker), "{a:?}");
                // Guides are dashed as no search is.
                assert_ne!(a.dash, Dash::GUIDE);
            }
        }
        let sources = [BINARY, COVERAGE, MapSource::EXACT].map(of_source);
        assert!(sources[0].color != sources[1].color && sources[1].color != sources[2].color);
    }

    #[test]
    fn looks_are_the_same_in_every_report_and_both_stages() {
        let ways = all();
        let (whole, few) = (SeriesStyles::new(&ways), SeriesStyles::new(&ways[4..8]));
        for way in &ways[4..8] {
            assert_eq!(whole.style(way), few.style(way));
            let hollow = whole.style(&way.in_stage(DrawStage::Compute));
            assert!(
                style(way).filled
                    && hollow
                        == Style {
                            filled: false,
                            ..style(way)
                        }
            );
        }
    }

    #[test]
    fn one_search_in_several_ways_takes_several_markers() {
        let steps = |n| MethodSettings {
            max_steps: Some(n),
            ..MethodSettings::default().by(CIRCLE)
        };
        let ways: Vec<MethodSettings> = (1..=10).map(|k| steps(8 * k)).collect();
        let styles = SeriesStyles::new(&ways);
        let seen: Vec<Style> = ways.iter().map(|w| styles.style(w)).collect();
        for (i, a) in seen.iter().enumerate() {
            assert!(seen[..i].iter().all(|b| a.marker != b.marker));
            assert_eq!(a.color, color::ORANGE);
        }
    }

    #[test]
    fn names_tell_apart_and_say_no_more() {
        let circle = MethodSettings::default().by(CIRCLE);
        let bound = |n, source, map_format| MethodSettings {
            max_steps: Some(n),
            map_source: Some(source),
            map_format,
            ..circle
        };
        let ways = [
            bound(20, BINARY, MapFormat::R16),
            bound(48, MapSource::EXACT, MapFormat::Rgba8),
            rbm_baseline(&spindle(), &circle),
        ];
        let names = |ways: &[MethodSettings]| {
            let styles = SeriesStyles::new(ways);
            ways.iter().map(|w| styles.way(w)).collect::<Vec<_>>()
        };
        let wanted = ["circle 20 steps binary r16", "circle 48 steps exact rgba8"];
        assert_eq!(names(&ways), [&wanted[..], &[RBM_BASELINE]].concat());
        let plain = [circle, MethodSettings::default(), ways[2]];
        assert_eq!(names(&plain), ["circle", "exact", RBM_BASELINE]);
    }
}
