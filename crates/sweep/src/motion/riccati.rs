//! What is still to be paid from a period on, as a quadratic of the state, and the commands that make it the least.
//!
//! With `δ` the state and `v` the commands beside a motion, `δ' = A δ + B v`, and multipliers `ν` of keys that are to be met exactly, what
//! is left to pay is `W = ½ δᵀP δ + pᵀδ + νᵀ(Φ δ + φ) − ½ νᵀΨ ν + c`. It is the least under `v = −H⁻¹(R u + Bᵀp + BᵀP A δ + BᵀΦᵀν)` with
//! `H = R + BᵀP B` and `ν = Ψ⁻¹(Φ δ + φ)`, which leaves (Bryson and Ho, 1975, §5.3)
//! `P ← AᵀP A − LᵀH⁻¹L`, `p ← Aᵀp − LᵀH⁻¹g`, `Φ ← Φ(A − B H⁻¹L)`, `φ ← φ − ΦB H⁻¹g`, `Ψ ← Ψ + ΦB H⁻¹(ΦB)ᵀ`, `c ← c − ½ gᵀH⁻¹g`
//! with `L = BᵀP A` and `g = R u + Bᵀp`.

use crate::least_squares::{dot, solve};

/// Row after row.
pub(super) type Matrix = Vec<Vec<f64>>;

/// The square of the sine of the angle between what a key takes and what others take, below which it is not told from them.
const ALIKE: f64 = 1e-10;

/// What is left to pay; none of it at the end of a motion.
pub(super) struct Remainder {
    /// `P`, `p`
    quadratic: Matrix,
    linear: Vec<f64>,
    /// `c`
    constant: f64,
    keys: Vec<Key>,
    /// `Ψ`
    reach: Matrix,
}

/// A key to be met exactly: a row of `Φ`, and of `φ`.
struct Key {
    number: usize,
    gradient: Vec<f64>,
    miss: f64,
}

/// `v = change − gains δ`
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Law {
    pub change: Vec<f64>,
    /// A row for each command.
    pub gains: Matrix,
}

/// A period beside a motion: `A`, `B`, the commands `u` in it, and the diagonal `R`.
pub(super) struct Stage<'a> {
    pub of_state: &'a Matrix,
    pub of_commands: &'a Matrix,
    pub commands: &'a [f64],
    pub prices: &'a [f64],
}

impl Remainder {
    pub fn none(states: usize) -> Self {
        Self {
            quadratic: vec![vec![0.0; states]; states],
            linear: vec![0.0; states],
            constant: 0.0,
            keys: Vec::new(),
            reach: Vec::new(),
        }
    }

    /// `weight (miss + gradient · δ)²` less what it is without `δ`.
    pub fn add_cost(&mut self, weight: f64, gradient: &[f64], miss: f64) {
        for ((row, sum), a) in self.quadratic.iter_mut().zip(&mut self.linear).zip(gradient) {
            row.iter_mut().zip(gradient).for_each(|(entry, b)| *entry += 2.0 * weight * a * b);
            *sum += 2.0 * weight * miss * a;
        }
    }

    /// `miss + gradient · δ = 0`
    pub fn add_key(&mut self, number: usize, gradient: Vec<f64>, miss: f64) {
        self.keys.push(Key { number, gradient, miss });
        self.reach.iter_mut().for_each(|row| row.push(0.0));
        self.reach.push(vec![0.0; self.keys.len()]);
    }

    /// Goes a period back; `None` where that gives no finite numbers.
    pub fn step_back(&mut self, stage: &Stage) -> Option<Law> {
        let (a, b) = (stage.of_state, transposed(stage.of_commands));
        let count = stage.commands.len();
        // BᵀP, H, L, g
        let pushed: Matrix = b.iter().map(|column| times(&self.quadratic, column)).collect();
        let mut stiffness: Matrix =
            pushed.iter().map(|row| b.iter().map(|column| dot(row, column)).collect()).collect();
        stage.prices.iter().enumerate().for_each(|(index, price)| stiffness[index][index] += price);
        let of_state = transposed(a);
        let coupling: Matrix = pushed.iter().map(|row| times(&of_state, row)).collect();
        let slope: Vec<f64> = (0..count)
            .map(|index| stage.prices[index] * stage.commands[index] + dot(&b[index], &self.linear))
            .collect();
        // H⁻¹L column by column, H⁻¹g, and H⁻¹(ΦB)ᵀ by keys
        let free = transposed(
            &transposed(&coupling)
                .into_iter()
                .map(|column| solve(stiffness.clone(), column))
                .collect::<Option<Matrix>>()?,
        );
        let free_change = solve(stiffness.clone(), slope.clone())?;
        let reached: Matrix = self.keys.iter().map(|key| times(&b, &key.gradient)).collect();
        let answers: Matrix =
            reached.iter().map(|row| solve(stiffness.clone(), row.clone())).collect::<Option<_>>()?;
        self.pay(&of_state, &coupling, (&free, &free_change));
        self.constant -= 0.5 * dot(&slope, &free_change);
        for (row, answer) in self.reach.iter_mut().zip(&answers) {
            row.iter_mut().zip(&reached).for_each(|(entry, other)| *entry += dot(answer, other));
        }
        for (key, reached) in self.keys.iter_mut().zip(&reached) {
            key.miss -= dot(reached, &free_change);
            let mut gradient = times(&of_state, &key.gradient);
            for (pull, row) in reached.iter().zip(&free) {
                gradient.iter_mut().zip(row).for_each(|(entry, gain)| *entry -= pull * gain);
            }
            key.gradient = gradient;
        }
        self.law(free, &free_change, &answers)
    }

    /// `P ← AᵀP A − LᵀH⁻¹L`, `p ← Aᵀp − LᵀH⁻¹g`
    fn pay(&mut self, of_state: &Matrix, coupling: &Matrix, (free, free_change): (&Matrix, &[f64])) {
        let carried: Matrix = of_state.iter().map(|column| times(&self.quadratic, column)).collect();
        let columns = transposed(coupling);
        let answers = transposed(free);
        let count = of_state.len();
        for i in 0..count {
            for j in 0..=i {
                let entry = dot(&carried[i], &of_state[j]) - dot(&columns[i], &answers[j]);
                self.quadratic[i][j] = entry;
                self.quadratic[j][i] = entry;
            }
        }
        let linear = times(of_state, &self.linear);
        self.linear =
            linear.iter().zip(&columns).map(|(entry, column)| entry - dot(column, free_change)).collect();
    }

    /// What is done for keys on top of what costs ask for.
    fn law(&self, mut gains: Matrix, free_change: &[f64], answers: &Matrix) -> Option<Law> {
        let mut change: Vec<f64> = free_change.iter().map(|entry| -entry).collect();
        let met = self.met();
        let matrix: Matrix =
            met.iter().map(|row| met.iter().map(|column| self.reach[*row][*column]).collect()).collect();
        if met.is_empty() {
            return Some(Law { change, gains });
        }
        // H⁻¹(ΦB)ᵀ Ψ⁻¹, a row for each command
        for (index, (change, gains)) in change.iter_mut().zip(&mut gains).enumerate() {
            let right = met.iter().map(|key| answers[*key][index]).collect();
            for (share, key) in solve(matrix.clone(), right)?.iter().zip(&met) {
                let key = &self.keys[*key];
                *change -= share * key.miss;
                gains.iter_mut().zip(&key.gradient).for_each(|(gain, entry)| *gain += share * entry);
            }
        }
        Some(Law { change, gains })
    }

    /// Keys, as they stand here, that commands from now on meet each by itself: with few periods left it is not all of them.
    fn met(&self) -> Vec<usize> {
        let mut met: Vec<usize> = Vec::new();
        // of each: what of Ψ is left of it beside those before, by Cholesky
        let mut factors: Matrix = Vec::new();
        for key in 0..self.keys.len() {
            let mut row: Vec<f64> = Vec::new();
            for (other, factor) in met.iter().zip(&factors) {
                let known: f64 = row.iter().zip(factor).map(|(a, b)| a * b).sum();
                row.push((self.reach[key][*other] - known) / factor[row.len()]);
            }
            let left = self.reach[key][key] - dot(&row, &row);
            if left > ALIKE * self.reach[key][key] {
                row.push(left.sqrt());
                met.push(key);
                factors.push(row);
            }
        }
        met
    }

    /// The first key by its number that commands cannot meet by itself.
    pub fn unmet(&self) -> Option<usize> {
        let met = self.met();
        (0..self.keys.len()).filter(|key| !met.contains(key)).map(|key| self.keys[key].number).min()
    }

    /// From `δ = 0`: how much less is paid, and numbers of keys with their multipliers, what is paid for a unit of each.
    pub fn forecast(&self) -> Option<(f64, Vec<(usize, f64)>)> {
        let misses: Vec<f64> = self.keys.iter().map(|key| key.miss).collect();
        let multipliers = solve(self.reach.clone(), misses.clone())?;
        let less = -self.constant - 0.5 * dot(&multipliers, &misses);
        Some((less, self.keys.iter().map(|key| key.number).zip(multipliers).collect()))
    }
}

pub(super) fn times(matrix: &Matrix, vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

fn transposed(matrix: &Matrix) -> Matrix {
    let columns = matrix.first().map_or(0, Vec::len);
    (0..columns).map(|column| matrix.iter().map(|row| row[column]).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cart under a force that is constant for a period.
    fn cart(mass: f64, h: f64) -> (Matrix, Matrix) {
        (vec![vec![1.0, h], vec![0.0, 1.0]], vec![vec![0.5 * h * h / mass], vec![h / mass]])
    }

    fn laws(
        (a, b): &(Matrix, Matrix),
        periods: usize,
        price: f64,
        mut costs: impl FnMut(&mut Remainder),
        end: impl FnOnce(&mut Remainder),
    ) -> (Vec<Law>, Remainder) {
        let mut left = Remainder::none(2);
        end(&mut left);
        let stage = Stage { of_state: a, of_commands: b, commands: &[0.0], prices: &[price] };
        let mut laws = Vec::new();
        for _ in 0..periods {
            laws.push(left.step_back(&stage).unwrap());
            costs(&mut left);
        }
        laws.reverse();
        (laws, left)
    }

    /// Far from the end the gains are those of the algebraic Riccati equation, which of a cart tend to
    /// `[√(q/r), √(2 m √(q/r) + q_v/r)]` as periods get short, in their first power.
    #[test]
    fn gains_of_a_cart_tend_to_those_in_continuous_time() {
        let (mass, q, of_speed, r) = (2.0_f64, 400.0_f64, 30.0, 0.25);
        let exact = [(q / r).sqrt(), (2.0 * mass * (q / r).sqrt() + of_speed / r).sqrt()];
        let errors = [0.02, 0.01, 0.005].map(|h| {
            let costs = |left: &mut Remainder| {
                left.add_cost(q * h, &[1.0, 0.0], 0.0);
                left.add_cost(of_speed * h, &[0.0, 1.0], 0.0);
            };
            // poles at 3/s to 7/s: what the end does has fallen by e⁻³⁰ in both factors
            let (laws, _) = laws(&cart(mass, h), (10.0 / h) as usize, 2.0 * h * r, costs, |_| ());
            [0, 1].map(|index| laws[0].gains[0][index] / exact[index] - 1.0)
        });
        for index in [0, 1] {
            let [coarse, middle, fine] = errors.map(|error| error[index]);
            let extrapolated = ((coarse - middle) / (middle - fine)).log2();
            // first order: the next power, over halvings of a period of 0.14 of the time constant, shifts it by some of that
            assert!((extrapolated - 1.0).abs() < 0.14, "order {extrapolated} of {errors:?}");
            // what is left once the first power is taken off is of the second: h² ω², ω below 7/s
            assert!((2.0 * fine - middle).abs() < (0.01_f64 * 7.0).powi(2), "{errors:?}");
        }
    }

    /// Without costs of the state, exact keys at the end give the straight line of least effort, and gains from each period on those of the
    /// motion that is left: `u = −12 m/(h² M(M² − 1)) ((M − 1)/2) x − …` for a displaced cart with `M` periods to go.
    #[test]
    fn keys_are_met_with_the_least_effort() {
        let (mass, h, periods, distance) = (2.0, 0.02, 100, 1.0);
        let of = cart(mass, h);
        let end = |left: &mut Remainder| {
            left.add_key(0, vec![1.0, 0.0], -distance);
            left.add_key(1, vec![0.0, 1.0], 0.0);
        };
        let (laws, left) = laws(&of, periods, 2.0 * h, |_| (), end);
        assert_eq!(left.unmet(), None);
        let line = |count: f64, n: f64| {
            12.0 * mass / (h * h * count * (count * count - 1.0)) * ((count - 1.0) / 2.0 - n)
        };
        for (n, law) in laws.iter().enumerate().take(periods - 1) {
            let left = (periods - n) as f64;
            let scale = line(left, 0.0);
            // sums of a hundred roundings, and as many times as Ψ of a hundred periods is skew: 4 N² of a line
            assert!((law.gains[0][0] / scale - 1.0).abs() < 1e-11, "{n}: {law:?}, not {scale}");
        }
        // followed by the model: that of the whole way, and it arrives
        let (mut state, mut paid) = ([0.0, 0.0], 0.0);
        for (n, law) in laws.iter().enumerate() {
            let u = law.change[0] - dot(&law.gains[0], &state);
            assert!((u - line(periods as f64, n as f64)).abs() < 1e-9, "{n}: {u}");
            paid += h * u * u;
            state = [state[0] + h * state[1] + 0.5 * h * h * u / mass, state[1] + h * u / mass];
        }
        assert!((state[0] - distance).abs() < 1e-12 && state[1].abs() < 1e-12, "{state:?}");
        // what is paid is what was forecast: nothing was paid without commands
        let (less, multipliers) = left.forecast().unwrap();
        assert!((less / -paid - 1.0).abs() < 1e-9, "{less}, not {}", -paid);
        // dcost/dd = 2 cost/d
        assert!((multipliers[0].1.abs() / (2.0 * paid / distance) - 1.0).abs() < 1e-9, "{multipliers:?}");
    }

    /// A key that another says already is found, and so is one that no command reaches.
    #[test]
    fn keys_that_are_not_told_apart_are_found() {
        let of = cart(2.0, 0.02);
        for (gradient, is_unmet) in [(vec![0.0, 2.0], true), (vec![0.0, 0.0], true), (vec![1.0, 2.0], false)]
        {
            let end = |left: &mut Remainder| {
                left.add_key(0, vec![0.0, 1.0], 0.0);
                left.add_key(1, gradient, 0.0);
            };
            let (_, left) = laws(&of, 50, 0.04, |_| (), end);
            assert_eq!(left.unmet(), is_unmet.then_some(1));
        }
    }
}
