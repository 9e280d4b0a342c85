//! The outer ends of a silhouette's rows, and the line that their middles follow.

/// The solid parts of one row, `[from, to]` in ascending order, pixels from the left edge.
pub(super) type Row = Vec<[f64; 2]>;

/// Halves that differ by less than this part of the solid's width are alike.
pub(super) const ALIKE: f64 = 0.05;
/// Distances below this part of the solid's half width are left over from drawing and scanning.
const SLACK: f64 = 0.02;
/// The part of the rows that an edge must follow to be straight.
const MOST: f64 = 0.8;
/// The part of the rows that an edge must follow to be the axis of a hollow half, and how many times
/// more rows it must follow than the other edge; then the same on the page's left border.
const LONG: [f64; 2] = [0.1, 2.0];
const LONG_AT_BORDER: [f64; 2] = [0.05, 1.0];
/// Bands of rows whose halves are compared.
const BANDS: usize = 16;
/// Columns that are looked at.
const COLUMNS: usize = 256;

/// A straight edge of a silhouette, at a place across the rows.
#[derive(Clone, Copy)]
pub(super) enum Edge {
    Left(f64),
    Right(f64),
}

/// The outer ends of the rows.
pub(super) struct Ends {
    /// Place of the row from the top, left end and right end, of each row with some solid.
    pub rows: Vec<[f64; 3]>,
    pub step: f64,
}

impl Ends {
    /// The ends of rows that are `step` pixels apart.
    pub fn of(rows: &[Row], step: f64) -> Self {
        let ends =
            |(i, row): (usize, &Row)| Some([i as f64 * step, row.first()?[0], row.last()?[1]]);
        Self {
            rows: rows.iter().enumerate().filter_map(ends).collect(),
            step,
        }
    }

    /// The ends of columns as those of rows: place from the left, upper and lower end.
    pub fn of_columns(rows: &[Row], step: f64) -> Self {
        let [low, high] = Self::of(rows, step).reach();
        let across = (high - low) / COLUMNS as f64;
        let column = |i: usize| {
            let x = low + across * (i as f64 + 0.5);
            let has = |row: &Row| row.iter().any(|[from, to]| *from <= x && x < *to);
            let [first, last] = [rows.iter().position(has)?, rows.iter().rposition(has)?];
            Some([x - low, first as f64 * step, (last + 1) as f64 * step])
        };
        Self {
            rows: (0..COLUMNS).filter_map(column).collect(),
            step: across,
        }
    }

    /// The outermost ends.
    pub fn reach(&self) -> [f64; 2] {
        let reach = |[low, high]: [f64; 2], row: &[f64; 3]| [low.min(row[1]), high.max(row[2])];
        self.rows.iter().fold([f64::INFINITY, 0.0], reach)
    }

    /// The only straight edge, which is the axis of half a profile.
    pub fn edge(&self) -> Option<Edge> {
        let straight = [Self::left, Self::right].map(|end| self.is_straight(end));
        match straight {
            [true, false] => Some(Edge::Left(self.median(Self::left))),
            [false, true] => Some(Edge::Right(self.median(Self::right))),
            _ => None,
        }
    }

    /// The outermost edge that far more rows follow than the other: the axis of a hollow half.
    pub fn long_edge(&self) -> Option<Edge> {
        let [low, high] = self.reach();
        let at_left = match low.abs() <= 1.0 {
            true => LONG_AT_BORDER,
            false => LONG,
        };
        let share = |is: &dyn Fn(&[f64; 3]) -> bool| {
            self.rows.iter().filter(|row| is(row)).count() as f64 / self.rows.len() as f64
        };
        let left = share(&|row| row[1] <= low + 1.0);
        let right = share(&|row| row[2] >= high - 1.0);
        let is_long =
            |[some, more]: [f64; 2], one: f64, other: f64| one >= some && one >= more * other;
        match (is_long(at_left, left, right), is_long(LONG, right, left)) {
            (true, _) => Some(Edge::Left(low)),
            (_, true) => Some(Edge::Right(high)),
            _ => None,
        }
    }

    pub fn left(row: &[f64; 3]) -> f64 {
        row[1]
    }

    pub fn right(row: &[f64; 3]) -> f64 {
        row[2]
    }

    pub fn height(&self) -> f64 {
        self.step * self.rows.len() as f64
    }

    pub fn median(&self, value: impl Fn(&[f64; 3]) -> f64) -> f64 {
        median(self.rows.iter().map(value).collect())
    }

    /// A length that cannot be told from none: a part of the half width of the widest row.
    pub fn slack(&self) -> f64 {
        let halves = self
            .rows
            .iter()
            .map(|[_, left, right]| 0.5 * (right - left));
        (SLACK * halves.fold(0.0, f64::max)).max(1.0)
    }

    /// Returns true if an end is at its median in most rows.
    pub fn is_straight(&self, end: impl Fn(&[f64; 3]) -> f64) -> bool {
        let at = self.median(&end);
        let near = self.rows.iter().filter(|row| (end(row) - at).abs() <= 1.0);
        near.count() as f64 >= MOST * self.rows.len() as f64
    }

    /// The part of the width that has no mirror image about `axis`. Within a band of rows, noise
    /// evens out.
    pub fn one_sided(&self, axis: impl Fn(f64) -> f64) -> f64 {
        let bands = self.rows.chunks(self.rows.len().div_ceil(BANDS));
        let beside = |rows: &[[f64; 3]]| {
            let aside = rows
                .iter()
                .map(|[row, left, right]| right + left - 2.0 * axis(*row));
            let width: f64 = rows.iter().map(|[_, left, right]| right - left).sum();
            (rows.len() as f64 * median(aside.collect()))
                .abs()
                .min(width)
        };
        bands.map(beside).sum::<f64>() / self.area()
    }

    fn area(&self) -> f64 {
        let widths = self.rows.iter().map(|[_, left, right]| right - left);
        widths.sum::<f64>().max(1.0)
    }

    /// Advice for a solid whose upper and lower half are alike.
    pub fn or_turn_it(&self) -> &'static str {
        let pairs = self.rows.iter().zip(self.rows.iter().rev());
        let apart = pairs.map(|(a, b)| 0.5 * ((a[1] - b[1]).abs() + (a[2] - b[2]).abs()));
        match apart.sum::<f64>() / self.area() {
            ..ALIKE => "; if the solid lies on its side, turn it upright",
            _ => "",
        }
    }

    /// The line that the middles of most rows follow: medians, since handles and shadows bring rows
    /// of their own.
    pub fn middle_line(&self) -> MiddleLine {
        let middle = |s: &[f64; 3]| 0.5 * (s[1] + s[2]);
        let third = self.rows.len() / 3;
        let of = |rows: &[[f64; 3]], value: &dyn Fn(&[f64; 3]) -> f64| {
            median(rows.iter().map(value).collect())
        };
        let (top, bottom) = (&self.rows[..third], &self.rows[self.rows.len() - third..]);
        let rise = of(bottom, &middle) - of(top, &middle);
        let run = of(bottom, &|s| s[0]) - of(top, &|s| s[0]);
        let slope = rise / run.max(1.0);
        let straightened = |s: &[f64; 3]| middle(s) - slope * s[0];
        let from = self.median(straightened);
        MiddleLine {
            from,
            slope,
            middle: from + slope * self.median(|s| s[0]),
            drift: slope * self.height(),
            residual: self.median(|s| (straightened(s) - from).abs()),
        }
    }
}

/// A line through the middles of the rows, pixels.
pub(super) struct MiddleLine {
    /// Its place at the top of the page.
    from: f64,
    slope: f64,
    /// Its place half way down.
    pub middle: f64,
    /// Its way aside from the first row to the last.
    pub drift: f64,
    /// The median distance of a middle from it.
    pub residual: f64,
}

impl MiddleLine {
    pub fn at(&self, row: f64) -> f64 {
        self.from + self.slope * row
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
