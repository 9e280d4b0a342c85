//! The default against meshes of equal silhouettes: at which tolerance the two take the same time.

use crate::measure::ratios::{Over, Ratio, over};
use crate::measure::row::Row;
use crate::plan::method::Method;
use crate::report::columns::Context;
use revmap_figures::groups::grouped;
use revmap_figures::names::number;

/// A sentence for each stage of the default: its time over the mesh's at each tolerance, and where
/// the two cross.
pub(super) fn answers(context: &Context, rows: &[&Row]) -> Vec<String> {
    let mut ratios = over(rows.iter().copied(), Over::Equal);
    ratios.retain(|r| r.settings.method == Method::DEFAULT);
    let stages = grouped(ratios, |r| r.settings.stage).into_iter();
    let sentence = |(stage, all): (revmap::settings::DrawStage, Vec<Ratio>)| {
        let at = |r: &Ratio| Some((r.pairs.first()?.0.tolerance_px()?, r.time));
        let mut points: Vec<_> = all.iter().filter_map(at).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let told = points.iter().map(|(pixels, time)| {
            let open = ["", " (not resolved)"][usize::from(time.relative() > context.resolved)];
            format!("{}{open} at {pixels} pixels", number(time.value, 3))
        });
        let told = told.collect::<Vec<_>>().join(", ");
        let known = points.iter().filter(|p| p.1.relative() <= context.resolved);
        let known: Vec<(f64, f64)> = known.map(|(x, time)| (*x, time.value)).collect();
        let pictures = all.iter().map(|r| r.pairs.len()).max().unwrap_or(0);
        format!(
            "{} stage: the default takes this part of the time of the mesh of equal silhouettes{}: {told}. {}",
            stage.name(),
            context.over_pictures(pictures),
            verdict(&known)
        )
    };
    stages.map(sentence).collect()
}

/// Where a ratio that is known at some tolerances crosses 1.
fn verdict(points: &[(f64, f64)]) -> String {
    let crosses = |pair: &&[(f64, f64)]| (pair[0].1 < 1.0) != (pair[1].1 < 1.0);
    let crossing = |pair: &[(f64, f64)]| {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        // Times change with a power of the tolerance.
        let part = -y0.ln() / (y1.ln() - y0.ln());
        number((x0.ln() + part * (x1.ln() - x0.ln())).exp(), 2)
    };
    let found: Vec<String> = points.windows(2).filter(crosses).map(crossing).collect();
    match (points, found.as_slice()) {
        ([], _) => "No ratio is resolved.".to_owned(),
        ([first, ..], []) if first.1 < 1.0 => "The default is faster at each of them.".to_owned(),
        (_, []) => "The mesh is faster at each of them.".to_owned(),
        (_, found) => format!("They take the same time at {} pixels.", found.join(" and ")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::row::tests::timed;
    use crate::plan::method::MethodSettings;
    use crate::report::columns::tests::with_context;
    use revmap::settings::Tolerance;

    /// The default takes 2 ms at any tolerance, meshes take less the more they may err: 4 ms at 0.1
    /// pixels, 1 ms at 1.6. They meet at 0.4, halfway of the factor.
    #[test]
    fn a_planted_crossing_is_found() {
        let mut rows = Vec::new();
        for (pixels, ms) in [(0.1, 4.0), (1.6, 1.0)] {
            let mesh = Method::mesh_within(pixels).unwrap();
            for (method, ms) in [(Method::DEFAULT, 2.0), (mesh, ms)] {
                let mut row = timed(&[ms, 1.001 * ms]);
                row.settings = MethodSettings::default().by(method);
                if method == Method::DEFAULT {
                    row.settings.tolerance = Tolerance::new(pixels).unwrap();
                }
                rows.push(row);
            }
        }
        let told = with_context(&rows, |context| answers(context, context.rows));
        let wanted = "fragment stage: the default takes this part of the time of the mesh of equal silhouettes: 0.5 at 0.1 pixels, 2 at 1.6 pixels. They take the same time at 0.4 pixels.";
        assert_eq!(told, [wanted]);
        assert_eq!(
            verdict(&[(0.1, 1.2), (0.2, 1.3)]),
            "The mesh is faster at each of them."
        );
        assert_eq!(
            verdict(&[(0.1, 0.2)]),
            "The default is faster at each of them."
        );
    }
}
