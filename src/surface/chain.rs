//! Segments of a boundary, in any order, joined end to start into whole curves.

use glam::DVec2;

/// A curve of the boundary with the solid on its left: closed, or from the axis to the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chain {
    /// Points `(r, z)` of the curve, object units. The points include the corners of the surface. A
    /// closed chain does not repeat its first point.
    pub points: Vec<DVec2>,
    /// True if the last point joins the first. Otherwise both ends are on the axis.
    pub closed: bool,
}

/// Ends at a smaller distance from each other are one point.
pub(super) const JOINT: f64 = 1e-8;

/// Directed parts, each of at least two points.
#[derive(Debug, Default)]
pub(super) struct Segments {
    points: Vec<DVec2>,
    /// `starts[k]..starts[k + 1]` are the points of part `k`.
    starts: Vec<u32>,
}

impl Segments {
    /// Begins a part; its points follow by [`Segments::point`].
    pub fn begin(&mut self) {
        self.starts.push(self.points.len() as u32);
    }

    /// Makes room for this many points.
    pub fn reserve(&mut self, count: usize) {
        self.points.reserve(count);
    }

    pub fn point(&mut self, p: DVec2) {
        self.points.push(p);
    }

    /// Adds a straight part.
    pub fn line(&mut self, a: DVec2, b: DVec2) {
        self.begin();
        self.points.extend([a, b]);
    }

    pub fn len(&self) -> usize {
        self.starts.len()
    }

    fn part(&self, k: usize) -> &[DVec2] {
        let end = self
            .starts
            .get(k + 1)
            .map_or(self.points.len(), |&e| e as usize);
        &self.points[self.starts[k] as usize..end]
    }

    /// First and last point of part `k`.
    pub fn ends(&self, k: usize) -> [DVec2; 2] {
        let part = self.part(k);
        [part[0], part[part.len() - 1]]
    }

    /// Joins all parts; `None` if some part has no successor or no predecessor.
    ///
    /// Several parts may leave one point, if loops touch. Any choice closes the chains then,
    /// because as many parts leave a point as reach it.
    pub fn join(&self) -> Option<Vec<Chain>> {
        let mut order: Vec<u32> = (0..self.len() as u32).collect();
        let start = |k: u32| self.points[self.starts[k as usize] as usize];
        order.sort_unstable_by(|&j, &k| start(j).x.total_cmp(&start(k).x).then(j.cmp(&k)));
        let mut used = vec![false; self.len()];
        let mut chains = Vec::new();
        // Parts that begin on the axis come first. No walk that begins elsewhere can then run into
        // their middle.
        for on_axis in [true, false] {
            for &first in &order {
                let begins_on_axis = start(first).x <= JOINT;
                if used[first as usize] || begins_on_axis != on_axis {
                    continue;
                }
                let chain = self.walk(first, on_axis, &order, &mut used)?;
                if chain.points.len() > usize::from(chain.closed) + 1 {
                    chains.push(chain);
                }
            }
        }
        Some(chains)
    }

    fn walk(&self, first: u32, on_axis: bool, order: &[u32], used: &mut [bool]) -> Option<Chain> {
        let mut chain = Chain {
            points: Vec::new(),
            closed: !on_axis,
        };
        let begin = self.ends(first as usize)[0];
        let mut k = first;
        loop {
            used[k as usize] = true;
            let part = self.part(k as usize);
            chain.points.reserve(part.len());
            for &p in part {
                let repeated = chain
                    .points
                    .last()
                    .is_some_and(|q: &DVec2| q.distance_squared(p) < JOINT * JOINT);
                if !repeated {
                    chain.points.push(p);
                }
            }
            let end = self.ends(k as usize)[1];
            if on_axis && end.x <= JOINT {
                return Some(chain);
            }
            match self.successor(k, end, order, used) {
                Some(next) => k = next,
                None if !on_axis && end.distance(begin) < JOINT => {
                    let last = chain.points.len().saturating_sub(1);
                    if chain.points[last].distance(begin) < JOINT {
                        chain.points.pop();
                    }
                    return Some(chain);
                }
                None => return None,
            }
        }
    }

    /// An unused part that starts at `p`: the part made next if it starts there, else the nearest.
    fn successor(&self, k: u32, p: DVec2, order: &[u32], used: &[bool]) -> Option<u32> {
        let start = |k: u32| self.points[self.starts[k as usize] as usize];
        let fits = |k: u32| !used[k as usize] && start(k).distance_squared(p) < JOINT * JOINT;
        if k as usize + 1 < self.len() && fits(k + 1) {
            return Some(k + 1);
        }
        let from = order.partition_point(|&k| start(k).x < p.x - JOINT);
        order[from..]
            .iter()
            .copied()
            .take_while(|&k| start(k).x <= p.x + JOINT)
            .filter(|&k| fits(k))
            .min_by(|&j, &k| {
                start(j)
                    .distance_squared(p)
                    .total_cmp(&start(k).distance_squared(p))
            })
    }
}
