//! The exact Euclidean distance transform of a binary grid, in linear time.
//!
//! The result for each cell is the squared distance between its centre and the nearest centre of
//! the other value. Distances along rows are counted. Distances down columns are the lower envelope
//! of parabolas (Felzenszwalb & Huttenlocher 2012; Meijster, Roerdink & Hesselink 2000), computed
//! in integers without a division. One pass gives both signs. Within a run of equal cells of a
//! column, nothing beyond the run's two ends can be nearest, because the other value begins there
//! at distance 0.
//!
//! Cells of value `false` continue beyond the grid's right, upper and lower borders. Nothing beyond
//! its left border counts: there is the axis.

use rayon::prelude::*;
use revmap::error::Result;
use revmap::host_memory;

/// The result for a grid without any cell of the other value.
pub(super) const NONE: u32 = u32::MAX;

/// What needs memory, in messages.
const MAP: &str = "the distances of a map";

/// Columns processed together: one cache line of distances per row.
const STRIP: usize = 16;

/// The squared distance, in cells, from the centre of each cell of `form` (row by row, `columns` to
/// the row) to the centre of the nearest cell of the other value. [`NONE`] if no such cell exists.
///
/// The result is exact for grids up to 32768 cells on a side. Any number of threads gives the same
/// result. An incomplete last row is left out.
pub(super) fn squared_to_other(form: &[bool], columns: usize) -> Result<Vec<u32>> {
    if columns == 0 {
        return Ok(Vec::new());
    }
    let rows = form.len() / columns;
    let mut along_rows = host_memory::filled(rows * columns, NONE, MAP)?;
    along_rows
        .par_chunks_mut(columns)
        .zip(form.par_chunks(columns))
        .for_each(|(out, line)| count_along_row(line, out));
    let strips: Result<Vec<Vec<u32>>> = (0..columns.div_ceil(STRIP))
        .into_par_iter()
        .map(|s| {
            let from = s * STRIP;
            let width = STRIP.min(columns - from);
            let mut strip = host_memory::reserved(rows * STRIP, MAP)?;
            for line in along_rows.chunks_exact(columns) {
                strip.extend_from_slice(&line[from..from + width]);
            }
            let mut envelope = Envelope::default();
            for column in 0..width {
                let solid = |row: usize| form[row * columns + from + column];
                envelope.transform_column(&mut strip, column, width, rows, solid);
            }
            Ok(strip)
        })
        .collect();
    let strips = strips?;
    along_rows
        .par_chunks_mut(columns)
        .enumerate()
        .for_each(|(row, out)| {
            for (piece, strip) in out.chunks_mut(STRIP).zip(&strips) {
                piece.copy_from_slice(&strip[row * piece.len()..][..piece.len()]);
            }
        });
    Ok(along_rows)
}

/// Distance along the row to the nearest cell of the other value; [`NONE`] if the row has none.
fn count_along_row(line: &[bool], out: &mut [u32]) {
    let mut start = 0;
    while start < line.len() {
        let value = line[start];
        let length = line[start..].iter().take_while(|&&v| v == value).count();
        let end = start + length;
        for (k, distance) in out[start..end].iter_mut().enumerate() {
            let left = if start > 0 { k + 1 } else { usize::MAX };
            let meets_right = end < line.len() || value;
            let right = if meets_right { length - k } else { usize::MAX };
            *distance = u32::try_from(left.min(right)).unwrap_or(NONE);
        }
        start = end;
    }
}

/// A stack of parabolas `height + (y - at)^2`, each the lowest somewhere between its neighbours.
#[derive(Default)]
struct Envelope {
    at: Vec<i64>,
    height: Vec<i64>,
}

impl Envelope {
    /// Turns one column of row distances into squared distances, run by run of equal cells.
    fn transform_column(
        &mut self,
        strip: &mut [u32],
        column: usize,
        width: usize,
        rows: usize,
        solid: impl Fn(usize) -> bool,
    ) {
        let mut start = 0;
        while start < rows {
            let value = solid(start);
            let mut end = start + 1;
            while end < rows && solid(end) == value {
                end += 1;
            }
            self.at.clear();
            self.height.clear();
            if start > 0 || value {
                self.push(start as i64 - 1, 0);
            }
            for row in start..end {
                let d = strip[row * width + column];
                if d != NONE {
                    self.push(row as i64, i64::from(d) * i64::from(d));
                }
            }
            if end < rows || value {
                self.push(end as i64, 0);
            }
            self.lowest(start, end, |row, lowest| {
                strip[row * width + column] = lowest;
            });
            start = end;
        }
    }

    /// Adds a parabola right of all others, and drops those that are now nowhere the lowest.
    fn push(&mut self, at: i64, height: i64) {
        while let [.., a0, a1] = self.at[..] {
            let [.., h0, h1] = self.height[..] else { break };
            // Twice the positions at which neighbours cross, as fractions. The middle one is
            // nowhere the lowest if it crosses the new one no later than the one before.
            let (n0, d0) = (h1 + a1 * a1 - h0 - a0 * a0, a1 - a0);
            let (n1, d1) = (height + at * at - h1 - a1 * a1, at - a1);
            if n1 * d0 > n0 * d1 {
                break;
            }
            self.at.pop();
            self.height.pop();
        }
        self.at.push(at);
        self.height.push(height);
    }

    /// The lowest value at each row of the run, in order.
    fn lowest(&self, start: usize, end: usize, mut put: impl FnMut(usize, u32)) {
        let mut parabolas = self.at.iter().zip(&self.height);
        let Some((mut at, mut height)) = parabolas.next() else {
            return;
        };
        let mut next = parabolas.next();
        for row in start..end {
            let y = row as i64;
            let mut lowest = height + (y - at) * (y - at);
            while let Some((a, h)) = next {
                let other = h + (y - a) * (y - a);
                if other > lowest {
                    break;
                }
                (at, height, lowest) = (a, h, other);
                next = parabolas.next();
            }
            put(row, u32::try_from(lowest).unwrap_or(NONE));
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn brute_force(form: &[bool], columns: usize) -> Vec<u32> {
        let rows = form.len() / columns;
        let value = |x: i64, y: i64| {
            let inside = (0..columns as i64).contains(&x) && (0..rows as i64).contains(&y);
            if inside {
                Some(form[y as usize * columns + x as usize])
            } else if x < 0 {
                None // corners beyond the left border count as little as the border
            } else {
                Some(false)
            }
        };
        (0..form.len())
            .map(|k| {
                let (x, y) = ((k % columns) as i64, (k / columns) as i64);
                let mut best = u64::from(NONE);
                for v in -1..=rows as i64 {
                    for u in -1..=columns as i64 {
                        if value(u, v).is_some_and(|o| o != form[k]) {
                            best = best.min(((u - x).pow(2) + (v - y).pow(2)) as u64);
                        }
                    }
                }
                best as u32
            })
            .collect()
    }

    proptest! {
        #[test]
        fn equals_brute_force(
            columns in 1usize..24,
            density in 0.0f64..1.0,
            noise in prop::collection::vec(0.0f64..1.0, 1..400),
        ) {
            let rows = noise.len().div_ceil(columns);
            let form: Vec<bool> =
                (0..rows * columns).map(|k| noise[k % noise.len()] < density * density).collect();
            prop_assert_eq!(squared_to_other(&form, columns).unwrap(), brute_force(&form, columns));
        }
    }

    #[test]
    fn one_value_alone_meets_the_borders() {
        assert_eq!(squared_to_other(&[false; 12], 4).unwrap(), [NONE; 12]);
        assert!(squared_to_other(&[], 4).unwrap().is_empty());
        let solid = squared_to_other(&[true; 9], 3).unwrap();
        assert_eq!(solid, [1, 1, 1, 4, 4, 1, 1, 1, 1]);
    }

    #[test]
    fn long_distances_are_exact() {
        let columns = 30_000;
        let mut form = vec![false; columns * 3];
        form[0] = true;
        let d = squared_to_other(&form, columns).unwrap();
        assert_eq!(d[columns * 3 - 1], 29_999 * 29_999 + 4);
    }
}
