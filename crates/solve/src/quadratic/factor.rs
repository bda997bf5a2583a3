//! Dense symmetric systems, of which some rows may say what others do.

use super::{NoLeast, dot};

/// A pivot below this share of what the row's own entry was belongs to a row that others say already.
const PIVOT: f64 = 1e-15;

/// A Cholesky factor by rows; a row that others say already is left out.
pub(super) struct Factor {
    rows: Vec<Vec<f64>>,
}

impl Factor {
    /// # Errors
    /// It was interrupted.
    pub fn of(
        count: usize,
        entry: impl Fn(usize, usize) -> f64,
        is_wished: &dyn Fn() -> bool,
    ) -> Result<Self, NoLeast> {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(count);
        for i in 0..count {
            if is_wished() {
                return Err(NoLeast::Interrupted);
            }
            let mut row: Vec<f64> = (0..=i).map(|j| entry(i, j)).collect();
            let own = row[i];
            for (j, of) in rows.iter().enumerate() {
                row[j] = (row[j] - dot(&row[..j], &of[..j])) / of[j];
            }
            let pivot = row[i] - dot(&row[..i], &row[..i]);
            row[i] = if pivot > PIVOT * own { pivot.sqrt() } else { f64::INFINITY };
            rows.push(row);
        }
        Ok(Self { rows })
    }

    pub fn solve(&self, right: &mut [f64]) {
        for (i, row) in self.rows.iter().enumerate() {
            right[i] = (right[i] - dot(&row[..i], &right[..i])) / row[i];
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            let solved = right[i] / row[i];
            right[i] = solved;
            right.iter_mut().zip(&row[..i]).for_each(|(right, entry)| *right -= entry * solved);
        }
    }
}
