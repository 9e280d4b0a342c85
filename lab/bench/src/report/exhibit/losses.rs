//! Where the default search loses against meshes.

use crate::measure::ratios::between;
use crate::measure::row::Row;
use crate::plan::method::Method;
use crate::report::columns::{Cell, Context};
use revmap_figures::names::number;
use revmap_figures::stats::{Interval, Verdict};

/// A row of the default search, the fastest other way, and the ratio of their times.
pub(super) type Pair<'a> = (&'a Row, &'a Row, Interval);

/// The pair whose ratio is largest, of those that are resolved.
pub(super) fn worst<'a, 'b>(
    context: &Context,
    pairs: impl Iterator<Item = &'b Pair<'a>>,
) -> Option<&'b Pair<'a>>
where
    'a: 'b,
{
    let known = pairs.filter(|p| p.2.verdict(context.resolved) != Verdict::Unresolved);
    known.max_by(|a, b| a.2.value.total_cmp(&b.2.value))
}

/// The largest time of the default over that of the fastest mesh of the same picture, and the mesh's
/// name and error.
pub(super) fn to_meshes(context: &Context) -> Option<String> {
    let timed = |r: &Row| r.time().map_or(f64::INFINITY, |t| t.value);
    let rows = || context.rows.iter().copied();
    let mut all: Vec<Pair> = Vec::new();
    for row in rows().filter(|r| r.settings.method == Method::DEFAULT) {
        let same = |r: &&Row| r.settings.method.is_mesh() && r.picture() == row.picture();
        let fastest = rows()
            .filter(same)
            .min_by(|a, b| timed(a).total_cmp(&timed(b)));
        let time = fastest.and_then(|mesh| Some((row, mesh, between(row, mesh)?)));
        all.extend(time);
    }
    let Some((row, mesh, time)) = worst(context, all.iter()) else {
        let fastest = all.first()?.1.settings.method;
        return Some(format!(
            "No ratio to a mesh is resolved; the fastest is `{fastest}`."
        ));
    };
    let error = mesh.errors.view.map(|v| v.silhouette_max);
    Some(format!(
        "Against the fastest mesh of the picture it takes at most {} of the time: {} at {} in the {} stage, against `{}`{}.",
        Cell::Known(*time).shown(),
        row.scene,
        row.size(),
        row.settings.stage.name(),
        mesh.settings.method,
        error.map_or_else(String::new, |e| format!(
            ", whose silhouettes are within {} pixels",
            number(e, 2)
        )),
    ))
}
