//! What it costs to come from each state of a grid to where it is to lead, and the level to begin with.
//!
//! Bellman's principle: `F(A) = min_u [c(A, u) + F(B)]`, where a shot under `u` leads from an entry `A` to `B` at a cost of `c`. A state from
//! which nothing leads to the target costs without end, and would spread through interpolation to all states around it; so what is iterated and
//! interpolated is worth, `W = e^(−F/T)`, of 1 in the target and of 0 out of the grid (Kružkov's transform; Bardi and Capuzzo-Dolcetta, Optimal
//! Control and Viscosity Solutions of Hamilton–Jacobi–Bellman Equations, 1997, section VI.3):
//!
//! `W(A) = max_u e^(−c(A, u)/T) Σᵢ wᵢ W(Bᵢ)`
//!
//! over the entries `Bᵢ` around `B`, whose weights `wᵢ`, linear along each axis, add up to one and are not negative. Iterations contract by
//! `e^(−c/T)` at least, and rise from nothing to the one solution. Weights act as probabilities: under the levels found a way comes to the
//! target with a chance of `P(A) = Σᵢ wᵢ P(Bᵢ)`, and where that is less than even, nothing is said to lead there.

use std::ops::Range;

use rayon::ThreadPool;
use rayon::prelude::*;
use souple_engine::Interruption;

/// Numbers of a state, at most.
pub(crate) const MOST_NUMBERS: usize = 4;
/// A state; numbers past those of the grid are nothing.
pub(crate) type Place = [f64; MOST_NUMBERS];

/// By how much worths that are the same are others: sums and exponentials of a way.
const ALIKE: f64 = 1e-12;
/// What of an axis a place may be beyond it: as far as an angle of half a turn is by rounding.
const ROUNDING: f64 = 1e-12;
/// Under which chance of coming to the target there is no way to it.
const EVEN: f64 = 0.5;

/// Entries at every combination of places along axes, the last running fastest.
pub(crate) struct Grid {
    /// Growing, two at least.
    pub axes: Vec<Vec<f64>>,
}

/// What a level that is held leads to from an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shot {
    /// [s]
    pub cost: f64,
    pub end: End,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    Target,
    /// Within the grid.
    At(Place),
    /// Beyond the grid, or where nothing can be stepped.
    Outside,
}

/// Shots from all entries under all levels.
pub(crate) struct Shots<'a> {
    pub grid: &'a Grid,
    /// Of each entry: whether it is in the target.
    pub is_target: &'a [bool],
    /// Entry by entry, level by level.
    pub shots: &'a [Shot],
    /// Of each level: what of several that are as good goes first, where it is less.
    pub efforts: &'a [f64],
}

/// What was found for each entry.
pub(crate) struct Values {
    /// `W`.
    worths: Vec<f64>,
    /// `P`.
    chances: Vec<f64>,
    /// `T` [s].
    scale: f64,
    /// Levels to begin with.
    pub levels: Vec<usize>,
    pub iterations: usize,
    pub is_converged: bool,
}

#[derive(Clone, Copy)]
struct Iterations {
    count: usize,
    is_converged: bool,
}

impl Grid {
    pub fn len(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    pub fn place(&self, mut entry: usize) -> Place {
        let mut place = [0.0; MOST_NUMBERS];
        for (number, axis) in place.iter_mut().zip(&self.axes).rev() {
            *number = axis[entry % axis.len()];
            entry /= axis.len();
        }
        place
    }

    /// Whether a place is within the grid, or beyond it by rounding alone.
    pub fn contains(&self, place: &Place) -> bool {
        self.axes.iter().zip(place).all(|(axis, number)| {
            let (low, high) = (axis[0], axis[axis.len() - 1]);
            let beyond = ROUNDING * (high - low);
            (low - beyond..=high + beyond).contains(number)
        })
    }

    /// The entries around a place within the grid, with their weights, which are above 0 and add up to 1.
    fn visit_corners(&self, place: &Place, visit: &mut dyn FnMut(usize, f64)) {
        let mut cells = [(0, 0.0); MOST_NUMBERS];
        for ((cell, axis), number) in cells.iter_mut().zip(&self.axes).zip(place) {
            let low = axis.partition_point(|at| at <= number).saturating_sub(1).min(axis.len() - 2);
            let share = (number - axis[low]) / (axis[low + 1] - axis[low]);
            *cell = (low, share.clamp(0.0, 1.0));
        }
        for corner in 0..1_usize << self.axes.len() {
            let (mut entry, mut weight) = (0, 1.0);
            for (at, (axis, (low, share))) in self.axes.iter().zip(cells).enumerate() {
                let is_upper = corner >> at & 1 == 1;
                weight *= if is_upper { share } else { 1.0 - share };
                entry = entry * axis.len() + low + usize::from(is_upper);
            }
            if weight > 0.0 {
                visit(entry, weight);
            }
        }
    }

    /// What values are at a place within the grid.
    pub fn interpolated(&self, values: &[f64], place: &Place) -> f64 {
        let mut sum = 0.0;
        self.visit_corners(place, &mut |entry, weight| sum += weight * values[entry]);
        sum
    }
}

impl Values {
    /// What the way from an entry to the target costs [s]; infinite where there is none.
    pub fn cost(&self, entry: usize) -> f64 {
        self.cost_of(self.worths[entry], self.chances[entry])
    }

    /// The same at a place within the grid.
    pub fn cost_at(&self, grid: &Grid, place: &Place) -> f64 {
        self.cost_of(grid.interpolated(&self.worths, place), grid.interpolated(&self.chances, place))
    }

    fn cost_of(&self, worth: f64, chance: f64) -> f64 {
        // that of the target is 1 but for rounding
        if chance >= EVEN { (-self.scale * worth.ln()).max(0.0) } else { f64::INFINITY }
    }
}

impl Shots<'_> {
    /// Worths of all entries, by at most so many iterations, until one changes none by more than `tolerance`, then chances. `None`: interrupted.
    pub fn values(
        &self,
        (tolerance, most): (f64, usize),
        pool: &ThreadPool,
        stop: &Interruption,
    ) -> Option<Values> {
        pool.install(|| {
            let scale = self.scale();
            let kept: Vec<f64> = self.shots.iter().map(|shot| (-shot.cost / scale).exp()).collect();
            let worth = |entry: usize, worths: &[f64]| self.best(entry, &kept, worths).0;
            let (worths, of_worths) = self.fixed_point((tolerance, most), &worth, stop)?;
            let whole = vec![1.0; kept.len()];
            let level = |entry: usize| {
                // within the target that which leads farthest into it, or least away
                let kept = if self.is_target[entry] { &whole } else { &kept };
                self.best(entry, kept, &worths).1
            };
            let levels: Vec<usize> = (0..worths.len()).into_par_iter().map(level).collect();
            let chance = |entry: usize, chances: &[f64]| self.left(&self.of(entry)[levels[entry]], chances);
            let (chances, of_chances) = self.fixed_point((tolerance, most), &chance, stop)?;
            Some(Values {
                worths,
                chances,
                scale,
                levels,
                iterations: of_worths.count,
                is_converged: of_worths.is_converged && of_chances.is_converged,
            })
        })
    }

    /// `T` [s]: as many shots as there are entries along the longest axis, which is about what a way across the grid costs. With a longer one
    /// chances to leave the grid weigh more than costs, with a shorter one worths far from the target are too small to tell.
    fn scale(&self) -> f64 {
        let mean = self.shots.iter().map(|shot| shot.cost).sum::<f64>() / self.shots.len() as f64;
        let longest = self.grid.axes.iter().map(Vec::len).max().unwrap_or(1);
        // shots that all end at once cost nothing, and lead nowhere
        if mean > 0.0 { mean * longest as f64 } else { 1.0 }
    }

    /// Iterates what each entry has, from nothing but 1 in the target.
    fn fixed_point(
        &self,
        (tolerance, most): (f64, usize),
        of: &(dyn Fn(usize, &[f64]) -> f64 + Sync),
        stop: &Interruption,
    ) -> Option<(Vec<f64>, Iterations)> {
        let mut values: Vec<f64> = self.is_target.iter().map(|is_target| f64::from(*is_target)).collect();
        let mut done = Iterations { count: 0, is_converged: false };
        while done.count < most && !done.is_converged {
            if stop.is_wished() {
                return None;
            }
            done.count += 1;
            let of = |entry: usize| if self.is_target[entry] { 1.0 } else { of(entry, &values) };
            let next: Vec<f64> = (0..values.len()).into_par_iter().map(of).collect();
            let changes = next.iter().zip(&values).map(|(to, from)| (to - from).abs());
            done.is_converged = changes.fold(0.0, f64::max) <= tolerance;
            values = next;
        }
        Some((values, done))
    }

    fn of(&self, entry: usize) -> &[Shot] {
        &self.shots[self.span(entry)]
    }

    fn span(&self, entry: usize) -> Range<usize> {
        let count = self.efforts.len();
        entry * count..(entry + 1) * count
    }

    /// What worths or chances are where a shot ends.
    fn left(&self, shot: &Shot, values: &[f64]) -> f64 {
        match shot.end {
            End::Target => 1.0,
            End::Outside => 0.0,
            End::At(place) => self.grid.interpolated(values, &place),
        }
    }

    /// The greatest worth of the levels at an entry, of which shots keep a share, and which it is; of several the one of the least effort, of
    /// such the first.
    fn best(&self, entry: usize, kept: &[f64], worths: &[f64]) -> (f64, usize) {
        let kept = &kept[self.span(entry)];
        let each = || self.of(entry).iter().zip(kept).map(|(shot, kept)| kept * self.left(shot, worths));
        let greatest = each().fold(0.0, f64::max);
        let as_good = each().enumerate().filter(|(_, worth)| *worth >= (1.0 - ALIKE) * greatest);
        let level = as_good.min_by(|(a, _), (b, _)| self.efforts[*a].total_cmp(&self.efforts[*b]));
        (greatest, level.map_or(0, |(level, _)| level))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(shots: &Shots, threads: usize) -> Values {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        shots.values((1e-12, 1000), &pool, &Interruption::default()).expect("not interrupted")
    }

    fn line(count: usize) -> Grid {
        Grid { axes: vec![(0..count).map(|at| at as f64).collect()] }
    }

    fn at(place: f64, cost: f64) -> Shot {
        Shot { cost, end: End::At([place, 0.0, 0.0, 0.0]) }
    }

    /// Places of entries, and weights around a place: those of linear functions along each axis.
    #[test]
    fn corners_interpolate() {
        let grid = Grid { axes: vec![vec![0.0, 1.0, 3.0], vec![-1.0, 1.0], vec![0.0, 0.5, 1.0]] };
        let of = |place: &Place| place[0] + 10.0 * place[1] + place[0] * place[2];
        let values: Vec<f64> = (0..grid.len()).map(|entry| of(&grid.place(entry))).collect();
        for place in [[0.5, 0.25, 0.75, 0.0], [3.0, 1.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0]] {
            // a few roundings of numbers up to 16
            assert!((grid.interpolated(&values, &place) - of(&place)).abs() < 1e-14, "{place:?}");
        }
        assert!(grid.contains(&[3.0, 1.0, 0.0, 0.0]) && !grid.contains(&[3.1, 1.0, 0.0, 0.0]));
        assert!(!grid.contains(&[f64::NAN, 1.0, 0.0, 0.0]));
        // the end of an axis but for rounding
        let end = [3.0 + 1e-15, 1.0, 0.0, 0.0];
        assert!(grid.contains(&end) && grid.interpolated(&values, &end) == of(&[3.0, 1.0, 0.0, 0.0]));
    }

    /// Steps of one entry and dear ones of two along a line: `V` is what the cheapest row of them costs, and ties go to the lesser effort.
    #[test]
    fn ways_are_the_cheapest() {
        let grid = line(6);
        let mut is_target = [false; 6];
        is_target[5] = true;
        let of = |entry: usize| {
            let place = entry as f64;
            let two = if entry < 4 { at(place + 2.0, 1.5) } else { Shot { cost: 1.5, end: End::Outside } };
            [at(place, 1.0), at((place + 1.0).min(5.0), 1.0), two, at((place + 1.0).min(5.0), 1.0)]
        };
        let shots: Vec<Shot> = (0..6).flat_map(of).collect();
        let shots =
            Shots { grid: &grid, is_target: &is_target, shots: &shots, efforts: &[0.0, 2.0, 3.0, 1.0] };
        let found = values(&shots, 2);
        for (entry, expected) in [4.0, 3.0, 2.5, 1.5, 1.0, 0.0].into_iter().enumerate() {
            // a few roundings of exponentials and of the logarithm
            assert!((found.cost(entry) - expected).abs() < 1e-13, "{entry}: {}", found.cost(entry));
        }
        // between entries worths are linear, and what the way costs follows from them
        let between = |share: f64| -found.scale * ((1.0 - share) * found.worths[4] + share).ln();
        assert!((found.cost_at(&grid, &[4.25, 0.0, 0.0, 0.0]) - between(0.25)).abs() < 1e-13);
        assert_eq!((found.levels[0], found.levels[3], found.levels[5], found.is_converged), (3, 2, 0, true));
        assert_eq!(found.levels[4], 3);
    }

    /// A shot that comes half to its own entry is repeated until it is out: `W = k (W + 1)/2` where shots keep `k`. What leads to itself alone, or
    /// out of the grid more often than not, leads nowhere; what seldom does leads to the target.
    #[test]
    fn what_leads_nowhere_is_told() {
        let grid = line(5);
        let is_target = [false, false, true, false, false];
        let outside = Shot { cost: 1.0, end: End::Outside };
        let of = |last: f64| {
            let shots = [at(0.0, 1.0), at(1.5, 1.0), at(2.0, 1.0), outside, at(last, 1.0)];
            values(&Shots { grid: &grid, is_target: &is_target, shots: &shots, efforts: &[0.0] }, 1)
        };
        let ways = |found: &Values| -> Vec<bool> { (0..5).map(|at| found.cost(at).is_finite()).collect() };
        let found = of(2.4);
        let kept = (-1.0 / found.scale).exp();
        assert!((found.worths[1] - kept / (2.0 - kept)).abs() < 1e-11, "{:?}", found.worths);
        assert_eq!(ways(&found), [false, true, true, false, true]);
        assert_eq!(ways(&of(2.6)), [false, true, true, false, false]);
    }

    /// Ways may go in rounds that no order of entries resolves: worths of both are found, alike at any number of threads.
    #[test]
    fn rounds_are_resolved() {
        let grid = line(4);
        let is_target = [true, false, false, true];
        let shots = [at(0.0, 1.0), at(1.75, 1.0), at(0.5, 1.0), at(3.0, 1.0)];
        let shots = Shots { grid: &grid, is_target: &is_target, shots: &shots, efforts: &[0.0] };
        let found = values(&shots, 1);
        // W₁ = k (W₁ + 3 W₂)/4, W₂ = k (1 + W₁)/2
        let kept = (-1.0 / found.scale).exp();
        let first = 3.0 * kept * kept / (8.0 - 2.0 * kept - 3.0 * kept * kept);
        assert!((found.worths[1] - first).abs() < 1e-11, "{:?}", found.worths);
        assert!((found.worths[2] - 0.5 * kept * (1.0 + first)).abs() < 1e-11, "{:?}", found.worths);
        let bits = |values: &Values| values.worths.iter().map(|worth| worth.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&found), bits(&values(&shots, 3)));
    }
}
