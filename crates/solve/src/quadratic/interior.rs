//! The interior-point method: steps towards where conditions of a least hold, within all bounds.

use super::factor::Factor;
use super::{Least, NoLeast, Row, Scaled, dot};

/// Iterations at most; twenty to forty are usual.
const MOST_ITERATIONS: usize = 200;
/// Where conditions of a least are missed by so much of the size of the answer, iterations end.
const TOLERANCE: f64 = 1e-11;
/// Iterations without coming nearer before they end.
const PATIENCE: usize = 40;
/// Share of the way to the nearest bound that a step goes.
const SHORT: f64 = 0.995;

/// The least, as nearly as rounding lets these steps come to it.
pub(super) fn least(scaled: &Scaled, is_wished: &dyn Fn() -> bool) -> Result<Least, NoLeast> {
    let mut point = Point::start(scaled);
    let (mut best, mut since): (Option<Least>, usize) = (None, 0);
    for _ in 0..MOST_ITERATIONS {
        let values = point.variables[..scaled.gradient.len()].iter().map(|variable| variable.value);
        let (values, multipliers): (Vec<f64>, _) = (values.collect(), point.multipliers.clone());
        let residual = scaled.residual(&values, &multipliers);
        since += 1;
        if best.as_ref().is_none_or(|best| residual < best.residual) {
            (best, since) = (Some(Least { values, multipliers, residual }), 0);
        }
        // where rounding is all that is left it comes no nearer
        if residual <= TOLERANCE || since > PATIENCE || !point.step(scaled, is_wished)? {
            break;
        }
    }
    best.filter(|best| best.residual.is_finite()).ok_or(NoLeast::Unsolved)
}

/// A variable within bounds, with what is paid at each of them.
#[derive(Clone, Copy)]
struct Variable {
    value: f64,
    curvature: f64,
    gradient: f64,
    bounds: [f64; 2],
    /// Multipliers of its bounds, 0 of those that there are none.
    paid: [f64; 2],
}

impl Variable {
    /// Within bounds, with `paid` times the distance from each being one.
    fn start(near: f64, curvature: f64, gradient: f64, bounds: [f64; 2]) -> Self {
        let [low, high] = bounds;
        let aside = (0.25 * (high - low)).min(0.1);
        let value = near.min(high - aside).max(low + aside);
        let mut variable = Self { value, curvature, gradient, bounds, paid: [0.0; 2] };
        for (side, room) in variable.room().into_iter().enumerate() {
            variable.paid[side] = if room.is_finite() { 1.0 / room } else { 0.0 };
        }
        variable
    }

    /// How far it is from each bound.
    fn room(&self) -> [f64; 2] {
        [self.value - self.bounds[0], self.bounds[1] - self.value]
    }

    /// `h + Σ paid/room`
    fn stiffness(&self) -> f64 {
        let [low, high] = self.room();
        self.curvature + self.paid[0] / low + self.paid[1] / high
    }
}

/// Variables `x`, then `p` and `q` of each row, then `r` of each row whose band has a width, and multipliers of rows.
struct Point {
    variables: Vec<Variable>,
    multipliers: Vec<f64>,
    /// Of each row, where its `r` is.
    within: Vec<Option<usize>>,
}

/// Where what is left within the band of a row begins.
fn within_band(row: &Row, values: &[f64]) -> f64 {
    match row.band {
        [low, high] if low < high => Variable::start(dot(&row.slopes, values), 0.0, 0.0, row.band).value,
        [value, _] => value,
    }
}

/// What a step changes: variables, multipliers of rows, and what is paid at bounds.
struct Step {
    values: Vec<f64>,
    multipliers: Vec<f64>,
    paid: Vec<[f64; 2]>,
}

impl Point {
    fn start(scaled: &Scaled) -> Self {
        let of = scaled.gradient.iter().zip(&scaled.bounds);
        let mut variables: Vec<Variable> =
            of.map(|(c, bounds)| Variable::start(-c, 1.0, *c, *bounds)).collect();
        let values: Vec<f64> = variables.iter().map(|variable| variable.value).collect();
        // rows that hold from the start, with room of the size of the answer: iterations that go to and fro between dear rows are short
        let off: Vec<f64> =
            scaled.rows.iter().map(|row| within_band(row, &values) - dot(&row.slopes, &values)).collect();
        for sign in [1.0, -1.0] {
            variables.extend(scaled.rows.iter().zip(&off).map(|(row, off)| Variable {
                value: (sign * off).max(0.0) + 1.0,
                curvature: 0.0,
                gradient: row.price,
                bounds: [0.0, f64::INFINITY],
                paid: [row.price, 0.0],
            }));
        }
        let mut within = Vec::with_capacity(scaled.rows.len());
        for row in &scaled.rows {
            let is_wide = row.band[0] < row.band[1];
            within.push(is_wide.then_some(variables.len()));
            if is_wide {
                variables.push(Variable::start(within_band(row, &values), 0.0, 0.0, row.band));
            }
        }
        Self { variables, multipliers: vec![0.0; scaled.rows.len()], within }
    }

    /// `A v`: what is left of a row.
    fn left(&self, scaled: &Scaled, values: &[f64]) -> Vec<f64> {
        let (n, m) = (scaled.gradient.len(), scaled.rows.len());
        let of = scaled.rows.iter().enumerate().map(|(i, row)| {
            let within = self.within[i].map_or(0.0, |at| values[at]);
            dot(&row.slopes, &values[..n]) + values[n + i] - values[n + m + i] - within
        });
        of.collect()
    }

    /// `Aᵀ y`
    fn spread(&self, scaled: &Scaled, multipliers: &[f64]) -> Vec<f64> {
        let mut spread = vec![0.0; scaled.gradient.len()];
        for (row, multiplier) in scaled.rows.iter().zip(multipliers) {
            spread.iter_mut().zip(&row.slopes).for_each(|(sum, slope)| *sum += multiplier * slope);
        }
        spread.extend(multipliers);
        spread.extend(multipliers.iter().map(|multiplier| -multiplier));
        let wide = multipliers.iter().zip(&self.within).filter(|(_, within)| within.is_some());
        spread.extend(wide.map(|(multiplier, _)| -multiplier));
        spread
    }

    /// What is missing of the gradient, `Aᵀ y + z − h v − c`, and of rows, `b − A v`.
    fn misses(&self, scaled: &Scaled) -> [Vec<f64>; 2] {
        let spread = self.spread(scaled, &self.multipliers);
        let gradient = self
            .variables
            .iter()
            .zip(spread)
            .map(|(it, spread)| spread + it.paid[0] - it.paid[1] - it.curvature * it.value - it.gradient);
        let values: Vec<f64> = self.variables.iter().map(|variable| variable.value).collect();
        let rows = self.left(scaled, &values).into_iter().zip(&scaled.rows).zip(&self.within);
        let rows =
            rows.map(|((left, row), within)| if within.is_some() { -left } else { row.band[0] - left });
        [gradient.collect(), rows.collect()]
    }

    /// Mean of what is paid times how far it is to the bound.
    fn gap(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0_usize);
        for variable in &self.variables {
            for (paid, room) in
                variable.paid.into_iter().zip(variable.room()).filter(|(_, room)| room.is_finite())
            {
                sum += paid * room;
                count += 1;
            }
        }
        sum / count.max(1) as f64
    }

    /// Predictor, corrector, and as far as bounds let it; `false` where it gets nowhere.
    fn step(&mut self, scaled: &Scaled, is_wished: &dyn Fn() -> bool) -> Result<bool, NoLeast> {
        let misses = self.misses(scaled);
        let gap = self.gap();
        let inverse: Vec<f64> = self.variables.iter().map(|variable| 1.0 / variable.stiffness()).collect();
        let factor = self.factor(scaled, &inverse, is_wished)?;
        let none = vec![[0.0; 2]; self.variables.len()];
        let predicted = self.change(scaled, &misses, &factor, &inverse, &none);
        let centre = (self.gap_after(&predicted, self.share(&predicted)) / gap).powi(3) * gap;
        // σ μ − Δv Δz
        let aims = predicted.values.iter().zip(&predicted.paid);
        let aims: Vec<[f64; 2]> =
            aims.map(|(by, paid)| [centre - by * paid[0], centre + by * paid[1]]).collect();
        let mut corrected = self.change(scaled, &misses, &factor, &inverse, &aims);
        if self.gap_after(&corrected, SHORT * self.share(&corrected)) > 0.9 * gap {
            // what is of the second order may lead in circles: straight towards half the gap
            corrected = self.change(scaled, &misses, &factor, &inverse, &vec![[0.5 * gap; 2]; inverse.len()]);
        }
        let share = (SHORT * self.share(&corrected)).min(1.0);
        let is_finite =
            corrected.values.iter().chain(&corrected.multipliers).all(|number| number.is_finite());
        if !is_finite || share < 1e-12 {
            return Ok(false);
        }
        for (variable, (by, paid)) in
            self.variables.iter_mut().zip(corrected.values.iter().zip(&corrected.paid))
        {
            variable.value += share * by;
            variable.paid = [0, 1].map(|side| variable.paid[side] + share * paid[side]);
        }
        self.multipliers
            .iter_mut()
            .zip(&corrected.multipliers)
            .for_each(|(multiplier, by)| *multiplier += share * by);
        Ok(true)
    }

    /// `A D⁻¹ Aᵀ`
    fn factor(
        &self,
        scaled: &Scaled,
        inverse: &[f64],
        is_wished: &dyn Fn() -> bool,
    ) -> Result<Factor, NoLeast> {
        let (n, m) = (scaled.gradient.len(), scaled.rows.len());
        let soft = |row: &Row| -> Vec<f64> {
            row.slopes.iter().zip(inverse).map(|(slope, inverse)| slope * inverse).collect()
        };
        let soft: Vec<Vec<f64>> = scaled.rows.iter().map(soft).collect();
        let entry = |i: usize, j: usize| {
            let own = if i == j {
                inverse[n + i] + inverse[n + m + i] + self.within[i].map_or(0.0, |at| inverse[at])
            } else {
                0.0
            };
            dot(&soft[i], &scaled.rows[j].slopes) + own
        };
        Factor::of(m, entry, is_wished)
    }

    /// `D Δv − Aᵀ Δy = f`, `A Δv = b − A v`, with `paid · room = aim` in the end.
    fn change(
        &self,
        scaled: &Scaled,
        misses: &[Vec<f64>; 2],
        factor: &Factor,
        inverse: &[f64],
        aims: &[[f64; 2]],
    ) -> Step {
        // what is to be added to paid · room
        let wanted: Vec<[f64; 2]> = self
            .variables
            .iter()
            .zip(aims)
            .map(|(variable, aim)| {
                let room = variable.room();
                [0, 1].map(|side| {
                    if room[side].is_finite() { aim[side] - variable.paid[side] * room[side] } else { 0.0 }
                })
            })
            .collect();
        let forces: Vec<f64> = self
            .variables
            .iter()
            .zip(&wanted)
            .zip(&misses[0])
            .map(|((variable, wanted), miss)| {
                let [low, high] = variable.room();
                miss + wanted[0] / low - wanted[1] / high
            })
            .collect();
        let moved: Vec<f64> = forces.iter().zip(inverse).map(|(force, inverse)| force * inverse).collect();
        let mut multipliers: Vec<f64> =
            self.left(scaled, &moved).iter().zip(&misses[1]).map(|(left, miss)| miss - left).collect();
        factor.solve(&mut multipliers);
        let spread = self.spread(scaled, &multipliers);
        let values: Vec<f64> = forces
            .iter()
            .zip(&spread)
            .zip(inverse)
            .map(|((force, spread), inverse)| (force + spread) * inverse)
            .collect();
        let paid = self.variables.iter().zip(&wanted).zip(&values).map(|((variable, wanted), by)| {
            let [low, high] = variable.room();
            [(wanted[0] - variable.paid[0] * by) / low, (wanted[1] + variable.paid[1] * by) / high]
        });
        Step { paid: paid.collect(), values, multipliers }
    }

    /// How much of a step goes to the first bound.
    fn share(&self, step: &Step) -> f64 {
        let mut share = 1.0 / SHORT;
        for (variable, (by, paid)) in self.variables.iter().zip(step.values.iter().zip(&step.paid)) {
            let [low, high] = variable.room();
            for (room, by) in
                [(low, *by), (high, -by), (variable.paid[0], paid[0]), (variable.paid[1], paid[1])]
            {
                if by < 0.0 {
                    share = f64::min(share, room / -by);
                }
            }
        }
        share
    }

    fn gap_after(&self, step: &Step, share: f64) -> f64 {
        let share = share.min(1.0);
        let (mut sum, mut count) = (0.0, 0_usize);
        for (variable, (by, paid)) in self.variables.iter().zip(step.values.iter().zip(&step.paid)) {
            let room = variable.room();
            for (side, by) in [*by, -by].into_iter().enumerate().filter(|(side, _)| room[*side].is_finite()) {
                sum += (room[side] + share * by) * (variable.paid[side] + share * paid[side]);
                count += 1;
            }
        }
        sum / count.max(1) as f64
    }
}
