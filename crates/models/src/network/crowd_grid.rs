//! Balls by the cell of a grid they are in: what is near is in the cells around.

use std::ops::Range;

use souple_engine::make_room;
use souple_math::Vec3;

/// Cells for each ball that are worth a table of all of them; fewer balls than that in a wide space are found by bisection.
const CELLS_OF_BALL: u64 = 8;

/// Balls sorted by cell, x before y before z, those of one cell by their rows: a run of cells along z is a run of balls.
#[derive(Default)]
pub struct Grid {
    /// Of a cell, which is the range [m].
    size: f64,
    rows: Vec<u32>,
    table: Table,
    /// `(cell, row)` in this order, where cells are too many for a table.
    cells: Vec<([i32; 3], u32)>,
}

/// Where the balls of a cell are among all.
#[derive(Default)]
struct Table {
    low: [i32; 3],
    counts: [u64; 3],
    /// First ball of each cell, and the end; empty where cells are too many.
    starts: Vec<u32>,
}

impl Table {
    /// `None` outside.
    fn index(&self, cell: [i32; 3]) -> Option<usize> {
        let at: [u64; 3] = std::array::from_fn(|i| (i64::from(cell[i]) - i64::from(self.low[i])) as u64);
        let is_in = (0..3).all(|i| at[i] < self.counts[i]);
        is_in.then(|| ((at[0] * self.counts[1] + at[1]) * self.counts[2] + at[2]) as usize)
    }
}

impl Grid {
    /// Takes the balls of some rows; nothing is allocated where there are no more than before.
    pub fn sort(&mut self, rows: Range<u32>, positions: &[Vec3], range: f64) {
        self.size = range;
        let cell = |row: u32| cell(positions[row as usize], range);
        let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
        for row in rows.clone() {
            let cell = cell(row);
            low = std::array::from_fn(|i| low[i].min(cell[i]));
            high = std::array::from_fn(|i| high[i].max(cell[i]));
        }
        let count = rows.len();
        let counts: [u64; 3] =
            std::array::from_fn(|i| (i64::from(high[i]) - i64::from(low[i])).max(0) as u64 + 1);
        let most = CELLS_OF_BALL * count as u64 + 64;
        let total = counts.iter().try_fold(1_u64, |product, count| product.checked_mul(*count));
        self.table.starts.clear();
        self.cells.clear();
        self.rows.clear();
        match total.filter(|total| *total <= most && count > 0) {
            Some(total) => {
                (self.table.low, self.table.counts) = (low, counts);
                self.count(total as usize, rows, cell);
            }
            None => {
                self.cells.extend(rows.map(|row| (cell(row), row)));
                self.cells.sort_unstable();
                self.rows.extend(self.cells.iter().map(|(_, row)| *row));
            }
        }
    }

    /// Sorts by counting.
    fn count(&mut self, total: usize, rows: Range<u32>, cell: impl Fn(u32) -> [i32; 3]) {
        let table = &mut self.table;
        let more = (total + 1).saturating_sub(table.starts.len());
        make_room(&mut table.starts, more);
        table.starts.resize(total + 1, 0);
        let index =
            |table: &Table, row: u32| table.index(cell(row)).unwrap_or_else(|| unreachable!("within"));
        for row in rows.clone() {
            let at = index(table, row);
            table.starts[at + 1] += 1;
        }
        for at in 0..total {
            table.starts[at + 1] += table.starts[at];
        }
        // each start moves on to the next while its cell fills, and back at the end
        self.rows.resize(rows.len(), 0);
        for row in rows {
            let at = index(table, row);
            self.rows[table.starts[at] as usize] = row;
            table.starts[at] += 1;
        }
        table.starts.copy_within(0..total, 1);
        table.starts[0] = 0;
    }

    /// Balls in the cell and in those below and above.
    fn run(&self, [x, y, z]: [i32; 3]) -> Range<usize> {
        let (below, above) = (z.saturating_sub(1), z.saturating_add(1));
        if self.table.starts.is_empty() {
            let from = self.cells.partition_point(|(cell, _)| *cell < [x, y, below]);
            let to = self.cells[from..].partition_point(|(cell, _)| *cell <= [x, y, above]);
            return from..from + to;
        }
        let Table { low, counts, starts } = &self.table;
        let top = i64::from(low[2]) + counts[2] as i64 - 1;
        let (below, above) = (below.max(low[2]), i64::from(above).min(top) as i32);
        match (self.table.index([x, y, below]), self.table.index([x, y, above])) {
            (Some(from), Some(to)) if from <= to => starts[from] as usize..starts[to + 1] as usize,
            _ => 0..0,
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.rows.capacity() + self.table.starts.capacity())
            + size_of::<([i32; 3], u32)>() * self.cells.capacity()
    }

    /// Visits the balls that are nearer than the range, of the positions that were sorted.
    pub fn visit_near(&self, place: Vec3, positions: &[Vec3], mut visit: impl FnMut(u32)) {
        let [i, j, k] = cell(place, self.size);
        let range_sq = self.size * self.size;
        for (di, dj) in (0..9).map(|n| (n % 3 - 1, n / 3 - 1)) {
            // there are no cells beyond the whole numbers
            let (Some(i), Some(j)) = (i.checked_add(di), j.checked_add(dj)) else { continue };
            for row in &self.rows[self.run([i, j, k])] {
                if (positions[*row as usize] - place).length_sq() < range_sq {
                    visit(*row);
                }
            }
        }
    }
}

fn cell(place: Vec3, size: f64) -> [i32; 3] {
    place.to_array().map(|x| (x / size).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Close together, far apart and at the ends of the whole numbers: those within the range, all of them, once.
    #[test]
    fn near_balls_are_found_however_wide_they_lie() {
        let number = |i: usize, salt: f64| ((i as f64 * 12.9898 + salt).sin() * 43_758.545_3).fract().abs();
        for width in [3.0, 300.0, 1e12] {
            let places: Vec<Vec3> =
                (0..200).map(|i| Vec3::new(number(i, 0.1), number(i, 1.7), number(i, 3.3)) * width).collect();
            let mut grid = Grid::default();
            // sorted twice: nothing is left of the first
            grid.sort(0..100, &places, 0.7);
            grid.sort(20..200, &places, 1.0);
            for place in &places {
                let mut found = Vec::new();
                grid.visit_near(*place, &places, |row| found.push(row));
                found.sort_unstable();
                let near = |row: &u32| (places[*row as usize] - *place).length_sq() < 1.0;
                let expected: Vec<u32> = (20..200).filter(near).collect();
                assert_eq!(found, expected, "width {width}");
            }
        }
    }
}
