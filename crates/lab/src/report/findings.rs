//! What a reader wants first: the sentences at the top of a report.

use super::columns::Context;
use super::exhibit::{Question, count};
use super::page::Page;
use super::ratios::{Over, Ratio, over};
use super::row::Row;
use crate::method::Method;

/// Adds the answers that a reader wants first.
pub(super) fn findings(page: &mut Page, context: &Context) {
    let rows = context.rows;
    let all: Vec<&Row> = rows.iter().collect();
    for answer in Question::Stages.answers(context, &all) {
        page.lead(answer);
    }
    let plain = |r: &Ratio| r.settings.method == Method::DEFAULT;
    for (reference, name) in [
        (Over::Baseline, context.baseline()),
        (
            Over::Mesh,
            "the coarsest mesh that is at least as accurate".to_owned(),
        ),
    ] {
        let all = over(rows, reference);
        let own = all.iter().filter(|r| plain(r) && r.mesh.is_none());
        let own: Vec<_> = own
            .map(|r| {
                let time = context.known(Some(r.time)).shown();
                let way = context.styles.way(&r.settings);
                format!(
                    "{way}, {} stage: {time} over {}",
                    r.settings.stage.name(),
                    count(r.pairs.len(), "picture")
                )
            })
            .collect();
        if !own.is_empty() {
            page.lead(format!(
                "The default takes this part of the time of {name} (95 % interval): {}.",
                own.join("; ")
            ));
        }
    }
}

/// How many times are not resolved, if any is not.
pub(super) fn unresolved(context: &Context) -> Option<String> {
    let wide = |r: &&Row| r.time().is_some() && !r.resolved(context.resolved);
    let number = context.rows.iter().filter(wide).count();
    (number > 0).then(|| {
        format!(
            "{number} of {} are not resolved: their 95 % intervals reach more than {:.0} % to either side. They are marked, and are on no front and in no verdict. Measure longer on a quiet machine (--passes, --max-seconds).",
            count(context.rows.len(), "time"),
            100.0 * context.resolved
        )
    })
}
