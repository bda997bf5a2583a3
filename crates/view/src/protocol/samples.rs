//! The message that carries what was measured, and the store it comes from.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Kind, header, put_u32};

/// The last samples of all that is plotted.
#[derive(Default)]
pub struct Samples {
    scene: u32,
    columns: usize,
    /// Number of the first row kept; rows are counted over all scenes.
    first: u64,
    /// Row after row.
    numbers: VecDeque<f64>,
}

/// Rows kept: a page that joins late sees as much of the past.
const ROWS_MAX: usize = 4096;

impl Samples {
    /// Begins anew, with rows of `columns` numbers.
    pub fn begin(&mut self, scene: u32, columns: usize) {
        self.first = self.end();
        self.numbers.clear();
        (self.scene, self.columns) = (scene, columns);
    }

    fn end(&self) -> u64 {
        self.first + self.numbers.len().checked_div(self.columns).unwrap_or(0) as u64
    }

    /// Adds a row of as many numbers as there are columns.
    pub fn push(&mut self, row: &[f64]) {
        debug_assert_eq!(row.len(), self.columns);
        if self.numbers.len() >= ROWS_MAX * self.columns {
            self.numbers.drain(..self.columns);
            self.first += 1;
        }
        self.numbers.extend(row);
    }

    /// The rows from `next` on, as a message; `None` if there are none. `next` becomes the row after them.
    pub fn since(&self, next: &mut u64) -> Option<Arc<[u8]>> {
        let from = (*next).max(self.first);
        let count = self.end().checked_sub(from).filter(|count| *count > 0)?;
        *next = self.end();
        let mut bytes = header(Kind::Samples, self.columns as u16, self.scene);
        put_u32(&mut bytes, count as usize);
        // numbers of eight bytes begin at multiples of eight
        put_u32(&mut bytes, 0);
        let skipped = (from - self.first) as usize * self.columns;
        self.numbers.range(skipped..).for_each(|number| bytes.extend(number.to_le_bytes()));
        Some(bytes.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(message: &[u8]) -> Vec<f64> {
        message[16..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
    }

    /// Everybody gets every row once, as far back as rows are kept, also over a change of scene.
    #[test]
    fn rows_come_once() {
        let mut samples = Samples::default();
        let (mut early, mut late) = (0, 0);
        assert!(samples.since(&mut early).is_none());
        samples.begin(1, 2);
        samples.push(&[0.0, 1.0]);
        assert_eq!(rows(&samples.since(&mut early).unwrap()), [0.0, 1.0]);
        assert!(samples.since(&mut early).is_none());
        for row in 1..=ROWS_MAX {
            samples.push(&[row as f64, 1.0]);
        }
        assert_eq!(rows(&samples.since(&mut late).unwrap())[0], 1.0);
        samples.begin(2, 1);
        assert!(samples.since(&mut late).is_none());
        samples.push(&[7.0]);
        assert_eq!(rows(&samples.since(&mut late).unwrap()), [7.0]);
        assert_eq!(rows(&samples.since(&mut early).unwrap()), [7.0]);
    }
}
