//! The pipelines that an object can come to need while its parameters move.

use super::generated as g;
use super::list::{Dispatch, Search};
use super::variant::{Kind, Variant};
use crate::settings::Solver;

impl Variant {
    /// Every pipeline that an object drawn by this variant may come to be drawn by when parameters,
    /// lights, camera or placements move; the one that it most likely is drawn by comes first.
    /// `copies`: whether it has several. `compute`: none in a pass; else whether there are several
    /// dispatches. `fallback`: what stands in where a contour does not close.
    #[must_use]
    pub fn reachable(
        self,
        solver: Solver,
        wraps: bool,
        copies: bool,
        compute: Option<bool>,
        fallback: Option<Self>,
    ) -> Vec<(Self, Kind)> {
        // The other form of searches that have two.
        let other = |search| match search {
            Search::Live => Some(Search::LiveBeveled),
            Search::LiveBeveled if solver == Solver::Live => Some(Search::Live),
            Search::Circle => Some(Search::CircleBeveled),
            Search::CircleBeveled => Some(Search::Circle),
            Search::CircleRgba8 => Some(Search::CircleBeveledRgba8),
            Search::CircleBeveledRgba8 => Some(Search::CircleRgba8),
            _ => None,
        };
        // Of the papers' loop with its own number of steps, and with another.
        let steps = |search| match search {
            Search::Circle | Search::CircleRgba8 => [0, solver.default_steps(false)].to_vec(),
            Search::CircleBeveled | Search::CircleBeveledRgba8 => {
                [0, solver.default_steps(true)].to_vec()
            }
            _ => vec![0],
        };
        let twin = other(self.search).into_iter().flat_map(|search| {
            steps(search).into_iter().map(move |papers_steps| Self {
                search,
                papers_steps,
                ..self
            })
        });
        let searched: Vec<Self> = std::iter::once(self).chain(twin).chain(fallback).collect();
        let on_map = |v: &Self| matches!(v.search, Search::Live | Search::LiveBeveled);
        let mut all = Vec::new();
        if let Some(several) = compute {
            for variant in searched {
                let held =
                    on_map(&variant) || (solver == Solver::Hull && variant.search.takes_beams());
                if wraps && held {
                    let several = several || copies;
                    all.push((Self::BEAM, Kind::Beam));
                    for cut in if on_map(&variant) {
                        [false].as_slice()
                    } else {
                        &[false, true]
                    } {
                        all.push((variant.tiled(*cut, several), Kind::Compute));
                        if !on_map(&variant) {
                            let lists = variant.listed(*cut, several);
                            all.extend(lists.into_iter().flatten());
                            all.push((Self::BEAM.cut_by_sides(*cut), Kind::List));
                        }
                    }
                }
                if copies
                    && solver == Solver::Hull
                    && variant.search.takes_beams()
                    && !on_map(&variant)
                {
                    // Bins of one copy have lists of patches, too.
                    all.push((Self::BEAM, Kind::ListCopies));
                    all.push((variant.dispatched(Dispatch::Bins, true), Kind::Compute));
                    all.extend(
                        variant
                            .of_bins(true)
                            .listed(false, true)
                            .into_iter()
                            .flatten(),
                    );
                }
                let dispatch = if copies {
                    Dispatch::Bins
                } else {
                    Dispatch::Rectangle
                };
                all.push((variant.dispatched(dispatch, several), Kind::Compute));
            }
        } else {
            if wraps && solver == Solver::Hull {
                let hull = self.with_tables(true);
                all.push((hull.cut_by_sides(false), Kind::Hull));
                all.push((hull.cut_by_sides(true), Kind::Hull));
                all.push((self, Kind::Sides));
                all.push((self.into_solid(), Kind::Sides));
            }
            for variant in searched {
                if wraps && on_map(&variant) {
                    all.push((variant, Kind::ConvexHull));
                }
                if copies && variant.takes_bins() {
                    all.extend([(variant, Kind::Spots), (variant, Kind::Bins)]);
                    all.extend(variant.in_spans().map(|v| (v, Kind::Spots)));
                }
                all.push((variant, Kind::Box));
            }
        }
        let mut all: Vec<_> = all
            .into_iter()
            .flat_map(|(v, kind)| match kind {
                Kind::Box | Kind::Spots | Kind::Bins | Kind::Compute if v.seen_from(true) != v => {
                    vec![(v.seen_from(true), kind), (v, kind)]
                }
                _ => vec![(v, kind)],
            })
            .collect();
        if self.shadow == g::SHADOW_OFF {
            let lit = all
                .iter()
                .filter(|(_, kind)| !matches!(kind, Kind::Beam | Kind::List | Kind::ListCopies));
            let more_lights = 1 - self.more_lights;
            let more: Vec<_> = lit
                .map(|&(v, kind)| (Self { more_lights, ..v }, kind))
                .collect();
            all.extend(more);
        }
        all
    }
}
