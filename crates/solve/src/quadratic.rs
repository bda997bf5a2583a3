//! Convex quadratic programs with a diagonal Hessian, bounds, and rows that are within bands at a price.
//!
//! `min ½ Σ h x² + c·x + Σ ρ d(g·x, [a, b])` over `l ≤ x ≤ u`, where `d` is how far a number is out of a band. Where `ρ` is above what rows are
//! worth they are met wherever they can be, and missed by the least `Σ ρ d` elsewhere, so that there always is an answer.
//!
//! Mehrotra's primal-dual interior-point method (1992). A row is `g·x + p − q − r = 0` with what it is short of and above, `p, q ≥ 0`, and
//! what is left within the band, `a ≤ r ≤ b`, so that all but one block of its equations is diagonal: each step solves `G D⁻¹ Gᵀ + E`, of
//! as many rows as there are bands. From which bounds and bands hold at its end follows the answer to rounding, by one more such system.

mod factor;
mod interior;
#[cfg(test)]
mod tests;

use self::factor::Factor;

/// `min ½ Σ h x² + c·x + Σ ρ d(g·x, [a, b])` over `l ≤ x ≤ u`.
#[derive(Clone, Debug, Default)]
pub struct QuadraticProgram {
    /// `h`, above 0.
    pub curvature: Vec<f64>,
    /// `c`
    pub gradient: Vec<f64>,
    /// `l` and `u`, with `l < u`; infinite where there is none.
    pub bounds: Vec<[f64; 2]>,
    pub rows: Vec<Row>,
}

/// Conditions of a least that are missed by more of the size of the answer are not met: a thousand times what rounding leaves of the worst.
const UNSOLVED: f64 = 1e-5;

/// `d(g·x, [a, b])` at a price.
#[derive(Clone, Debug)]
pub struct Row {
    /// `g`
    pub slopes: Vec<f64>,
    /// `a ≤ b`; infinite on a side that is open.
    pub band: [f64; 2],
    /// `ρ`, above 0.
    pub price: f64,
}

/// Why there is no least.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoLeast {
    /// Numbers are not finite, or so unlike that no step comes near it.
    Unsolved,
    Interrupted,
}

/// The least of a program.
#[derive(Clone, Debug)]
pub struct Least {
    /// `x`
    pub values: Vec<f64>,
    /// Of each row `μ` in `h x + c = Σ μ g + …` of bounds: above 0 where it is held from below, below 0 from above, `|μ| ≤ ρ`.
    pub multipliers: Vec<f64>,
    /// By how much it misses the conditions of a least, of the size of the answer.
    pub residual: f64,
}

impl QuadraticProgram {
    /// The least, looked for until `is_wished` says to stop, which is asked for each row of each system.
    ///
    /// # Errors
    /// It cannot be solved, or was interrupted.
    pub fn solve(&self, is_wished: &dyn Fn() -> bool) -> Result<Least, NoLeast> {
        let scaled = Scaled::of(self).ok_or(NoLeast::Unsolved)?;
        let mut least = interior::least(&scaled, is_wished)?;
        // twice: what the first exchanges of bounds shows what the second has to
        for _ in 0..2 {
            match scaled.polished(&least, is_wished)? {
                Some(better) if better.residual <= least.residual => least = better,
                _ => break,
            }
        }
        if least.residual > UNSOLVED {
            return Err(NoLeast::Unsolved);
        }
        let values = least.values.iter().zip(&scaled.sizes).map(|(value, size)| value * size);
        let values = values.zip(&self.bounds).map(|(value, [low, high])| value.clamp(*low, *high));
        let multipliers = least.multipliers.iter().zip(&scaled.prices);
        Ok(Least {
            values: values.collect(),
            multipliers: multipliers.map(|(multiplier, unit)| multiplier * unit).collect(),
            residual: least.residual,
        })
    }
}

/// A program in units of its own: `h = 1`, rows of length one, and an answer of the order of one.
struct Scaled {
    gradient: Vec<f64>,
    bounds: Vec<[f64; 2]>,
    rows: Vec<Row>,
    /// `x` for one of each variable.
    sizes: Vec<f64>,
    /// `μ` for one of each multiplier.
    prices: Vec<f64>,
}

impl Scaled {
    fn of(program: &QuadraticProgram) -> Option<Self> {
        let roots: Vec<f64> = program.curvature.iter().map(|h| h.sqrt()).collect();
        let mut rows: Vec<Row> = Vec::with_capacity(program.rows.len());
        let mut lengths = Vec::with_capacity(program.rows.len());
        for row in &program.rows {
            let slopes: Vec<f64> = row.slopes.iter().zip(&roots).map(|(slope, root)| slope / root).collect();
            let length = dot(&slopes, &slopes).sqrt();
            // a row of nothing is missed by what it is
            let length = if length == 0.0 { 1.0 } else { length };
            rows.push(Row {
                slopes: slopes.iter().map(|slope| slope / length).collect(),
                band: row.band.map(|side| side / length),
                price: row.price * length,
            });
            lengths.push(length);
        }
        let gradient: Vec<f64> = program.gradient.iter().zip(&roots).map(|(c, root)| c / root).collect();
        let bounds = program.bounds.iter().zip(&roots);
        let bounds: Vec<[f64; 2]> = bounds.map(|(bounds, root)| bounds.map(|bound| bound * root)).collect();
        let free: Vec<f64> =
            gradient.iter().zip(&bounds).map(|(c, [low, high])| (-c).clamp(*low, *high)).collect();
        let missed =
            rows.iter().map(|row| beyond(dot(&row.slopes, &free), row.band).abs()).fold(0.0, f64::max);
        let size = missed.max(dot(&free, &free).sqrt());
        let size = if size > 0.0 { size } else { 1.0 };
        let is_finite = size.is_finite()
            && gradient.iter().all(|c| c.is_finite())
            && rows.iter().all(|row| {
                row.price.is_finite()
                    && row.slopes.iter().all(|g| g.is_finite())
                    && !row.band.iter().any(|side| side.is_nan())
            })
            && bounds.iter().all(|[low, high]| low < high);
        is_finite.then(|| Self {
            gradient: gradient.iter().map(|c| c / size).collect(),
            bounds: bounds.iter().map(|bounds| bounds.map(|bound| bound / size)).collect(),
            rows: rows
                .into_iter()
                .map(|row| Row { band: row.band.map(|side| side / size), price: row.price / size, ..row })
                .collect(),
            sizes: roots.iter().map(|root| size / root).collect(),
            prices: lengths.iter().map(|length| size / length).collect(),
        })
    }

    /// By how much conditions of a least are missed: what a step down the gradient within bounds would change, what a row is short of while a
    /// share of its price is not paid, and what is paid for one that is not short.
    fn residual(&self, values: &[f64], multipliers: &[f64]) -> f64 {
        let drawn = self.drawn(multipliers);
        let stationary = values.iter().zip(&drawn).zip(&self.bounds);
        let worst = stationary
            .map(|((value, drawn), [low, high])| (value - drawn.clamp(*low, *high)).abs())
            .fold(0.0, f64::max);
        let of_rows = self.rows.iter().zip(multipliers).map(|(row, multiplier)| {
            let reached = dot(&row.slopes, values);
            let side = |short: f64, paid: f64| {
                if short > 0.0 {
                    short.min((1.0 - paid / row.price).max(0.0))
                } else {
                    (-short).min(paid.max(0.0))
                }
            };
            side(row.band[0] - reached, *multiplier).max(side(reached - row.band[1], -multiplier))
        });
        of_rows.fold(worst, f64::max)
    }

    /// `Gᵀ μ − c`, where variables are without bounds.
    fn drawn(&self, multipliers: &[f64]) -> Vec<f64> {
        let mut drawn: Vec<f64> = self.gradient.iter().map(|c| -c).collect();
        for (row, multiplier) in
            self.rows.iter().zip(multipliers).filter(|(_, multiplier)| **multiplier != 0.0)
        {
            drawn.iter_mut().zip(&row.slopes).for_each(|(drawn, slope)| *drawn += multiplier * slope);
        }
        drawn
    }

    /// The answer where the same bounds and bands hold, to rounding: `x = clamp(Gᵀμ − c)`, with what holds told by `x` and `μ`.
    fn polished(&self, near: &Least, is_wished: &dyn Fn() -> bool) -> Result<Option<Least>, NoLeast> {
        let drawn = self.drawn(&near.multipliers);
        let is_free: Vec<bool> =
            drawn.iter().zip(&self.bounds).map(|(drawn, [low, high])| low < drawn && drawn < high).collect();
        let held = drawn.iter().zip(&self.bounds);
        let mut values: Vec<f64> = held.map(|(drawn, [low, high])| drawn.clamp(*low, *high)).collect();
        // rows that hold, with the side that they hold at; others have no multiplier, or the whole price
        let mut multipliers = Vec::with_capacity(self.rows.len());
        let mut holding: Vec<(usize, f64)> = Vec::new();
        for (at, (row, multiplier)) in self.rows.iter().zip(&near.multipliers).enumerate() {
            let reached = dot(&row.slopes, &near.values);
            let [low, high] = row.band;
            let side = if *multiplier >= 0.0 { low } else { high };
            let is_whole = row.price - multiplier.abs() < beyond(reached, row.band).abs();
            let is_none = low < high && multiplier.abs() < (reached - side).abs();
            if is_whole {
                multipliers.push(multiplier.signum() * row.price);
            } else {
                multipliers.push(0.0);
                if !is_none {
                    holding.push((at, side));
                }
            }
        }
        let free = |row: &Row| -> Vec<f64> {
            row.slopes
                .iter()
                .zip(&is_free)
                .map(|(slope, is_free)| if *is_free { *slope } else { 0.0 })
                .collect()
        };
        let of_free: Vec<Vec<f64>> = holding.iter().map(|(at, _)| free(&self.rows[*at])).collect();
        let base = self.drawn(&multipliers);
        let set = |values: &mut Vec<f64>, drawn: &[f64]| {
            for ((value, drawn), _) in
                values.iter_mut().zip(drawn).zip(&is_free).filter(|(_, is_free)| **is_free)
            {
                *value = *drawn;
            }
        };
        set(&mut values, &base);
        let factor = Factor::of(of_free.len(), |i, j| dot(&of_free[i], &of_free[j]), is_wished)?;
        // again and again: each leaves what rounding of the one before has left
        for _ in 0..3 {
            let short = holding.iter().map(|(at, side)| side - dot(&self.rows[*at].slopes, &values));
            let mut change: Vec<f64> = short.collect();
            factor.solve(&mut change);
            for ((at, _), change) in holding.iter().zip(&change) {
                multipliers[*at] += change;
            }
            let drawn = self.drawn(&multipliers);
            set(&mut values, &drawn);
        }
        let is_finite = values.iter().chain(&multipliers).all(|number| number.is_finite());
        Ok(is_finite.then(|| Least { residual: self.residual(&values, &multipliers), values, multipliers }))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// How far a number is out of a band, below 0 where it is short of it.
pub fn beyond(number: f64, [low, high]: [f64; 2]) -> f64 {
    (number - low).min(0.0) + (number - high).max(0.0)
}
