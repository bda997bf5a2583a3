//! When the surface of a body opens: what of it may touch from which date on.

use std::collections::BTreeMap;

use souple_mesh::{OpeningSurface, Span};

/// Shares of the points of a surface from a date on; points that are not on it then have none.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// [s]
    pub from: f64,
    /// As many as there are points.
    pub of_points: Vec<f64>,
}

/// The last of some shares in the order of their dates that have begun; `None` before the first.
pub(super) fn shares_at(later: &[Shares], time: f64) -> Option<&[f64]> {
    later.iter().rev().find(|shares| shares.from <= time).map(|shares| shares.of_points.as_slice())
}

/// Numbers of triangles, one after the other.
pub(super) type InTurn<'a> = &'a mut dyn Iterator<Item = usize>;

/// Which triangles are there, and which rows they have.
#[derive(Clone, Debug)]
pub(super) struct Openings {
    /// Of each triangle; empty where all stay.
    spans: Vec<Span>,
    /// When triangles come and go, ascending [s].
    dates: Vec<f64>,
    /// Rows of the corners that are there before the first date, then from each on, ascending.
    rows: Vec<Vec<u32>>,
}

impl Openings {
    /// `rows`: of the points of the surface.
    pub fn new(surface: &OpeningSurface, rows: &[u32]) -> Self {
        let dates = surface.dates();
        let rows_at = |time: f64| {
            let corners = surface.at(time).flat_map(|triangle| surface.surface.triangles[triangle]);
            let mut rows: Vec<u32> = corners.map(|point| rows[point as usize]).collect();
            rows.sort_unstable();
            rows.dedup();
            rows
        };
        let rows = [f64::NEG_INFINITY].iter().chain(&dates).map(|date| rows_at(*date)).collect();
        Self { spans: surface.spans.clone(), dates, rows }
    }

    /// How often it has opened by a time [s].
    pub fn by(&self, time: f64) -> usize {
        self.dates.partition_point(|date| *date <= time)
    }

    pub fn has(&self, triangle: usize, time: f64) -> bool {
        self.spans.get(triangle).is_none_or(|span| span.holds(time))
    }

    /// Rows of the corners that are there at a time [s].
    pub fn rows(&self, time: f64) -> &[u32] {
        &self.rows[self.by(time)]
    }

    /// Of each row the largest sum that it ever has of what the triangles of one time give to it.
    pub fn largest_sums(
        &self,
        triangle_count: usize,
        of: impl Fn(InTurn) -> Vec<(u32, f64)>,
    ) -> Vec<(u32, f64)> {
        if self.dates.is_empty() {
            return of(&mut (0..triangle_count));
        }
        let mut largest = BTreeMap::new();
        for time in [f64::NEG_INFINITY].iter().chain(&self.dates) {
            let mut sums = BTreeMap::new();
            let given = of(&mut (0..triangle_count).filter(|triangle| self.has(*triangle, *time)));
            given.into_iter().for_each(|(row, value)| *sums.entry(row).or_insert(0.0) += value);
            for (row, sum) in sums {
                let known = largest.entry(row).or_insert(sum);
                *known = f64::max(*known, sum);
            }
        }
        largest.into_iter().collect()
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        size_of::<Span>() * self.spans.capacity()
            + 8 * self.dates.capacity()
            + self.rows.iter().map(|rows| 4 * rows.capacity()).sum::<usize>()
    }
}
