//! The order at which errors fall as runs get finer.

use crate::row::RunOfRow;

/// Runs of one scene, ever finer.
#[derive(Clone, Copy, Debug)]
pub struct Refinement {
    /// What gets smaller, with its unit: `step [s]`, `cell [m]`.
    pub size_of: &'static str,
    /// Coarse to fine: two at least, three for [`Limit::Richardson`], each finer by the same factor there.
    pub runs: &'static [Variant],
    pub limit: Limit,
}

/// One of the runs.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    pub size: f64,
    pub settings: &'static [&'static str],
}

/// What the values tend to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    Known(f64),
    /// Not known: of `u(h) = u₀ + C hᵖ` the differences of neighbours fall as `hᵖ` too, and the finest value corrected by the
    /// last of them stands for `u₀`.
    Richardson,
}

impl Refinement {
    /// The order `p` of `error = C hᵖ` between the two finest runs: coarser ones are further from where that holds, and
    /// a fit over all would draw their distance into the answer.
    ///
    /// # Errors
    /// Errors that have no order: one of them is nothing, or not finite.
    pub(crate) fn order_of(&self, runs: &[RunOfRow]) -> Result<f64, String> {
        let [.., coarse, fine] = runs else {
            return Err(format!("an order takes two runs, here {}", runs.len()));
        };
        let (coarse_error, fine_error, ratio) = match self.limit {
            Limit::Known(limit) => (
                (coarse.value - limit).abs(),
                (fine.value - limit).abs(),
                coarse.size.unwrap_or(f64::NAN) / fine.size.unwrap_or(f64::NAN),
            ),
            Limit::Richardson => {
                let [.., coarsest, _, _] = runs else {
                    return Err("an order without a known limit takes three runs".to_owned());
                };
                let before = coarsest.size.unwrap_or(f64::NAN) / coarse.size.unwrap_or(f64::NAN);
                let ratio = coarse.size.unwrap_or(f64::NAN) / fine.size.unwrap_or(f64::NAN);
                if (before / ratio - 1.0).abs() > 1e-9 {
                    return Err(format!("sizes must fall by one factor, but fall by {before} and {ratio}"));
                }
                ((coarsest.value - coarse.value).abs(), (coarse.value - fine.value).abs(), ratio)
            }
        };
        let order = (coarse_error / fine_error).ln() / ratio.ln();
        if order.is_finite() {
            Ok(order)
        } else {
            Err(format!(
                "errors of {coarse_error:e} and {fine_error:e} at sizes in the ratio {ratio} have no order"
            ))
        }
    }

    /// Fills in the distances from the limit.
    pub(crate) fn set_errors(&self, runs: &mut [RunOfRow]) {
        let limit = match self.limit {
            Limit::Known(limit) => Some(limit),
            Limit::Richardson => self.extrapolated(runs),
        };
        for run in runs {
            run.error = limit.map(|limit| (run.value - limit).abs());
        }
    }

    // u₀ = u₃ + (u₃ - u₂) / (rᵖ - 1),  rᵖ = (u₁ - u₂) / (u₂ - u₃)
    fn extrapolated(&self, runs: &[RunOfRow]) -> Option<f64> {
        let [.., first, second, third] = runs else { return None };
        let factor = (first.value - second.value) / (second.value - third.value);
        Some(third.value + (third.value - second.value) / (factor - 1.0)).filter(|limit| limit.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(values: &[(f64, f64)]) -> Vec<RunOfRow> {
        let run = |&(size, value): &(f64, f64)| RunOfRow {
            size: Some(size),
            value,
            error: None,
            command: String::new(),
        };
        values.iter().map(run).collect()
    }

    fn refinement(limit: Limit) -> Refinement {
        Refinement { size_of: "step [s]", runs: &[], limit }
    }

    /// `7 + 5 h³` has order 3, and errors of `5 h³`, whether its limit is known or not.
    #[test]
    fn a_power_has_its_order() {
        let values: Vec<(f64, f64)> = [0.4, 0.2, 0.1].map(|h: f64| (h, 7.0 + 5.0 * h.powi(3))).to_vec();
        for limit in [Limit::Known(7.0), Limit::Richardson] {
            let mut runs = runs(&values);
            let order = refinement(limit).order_of(&runs).unwrap();
            // differences of numbers near 7 that are at least 5e-3 apart: rounding of 7 ε / 5e-3
            assert!((order - 3.0).abs() < 1e-11, "{order}");
            refinement(limit).set_errors(&mut runs);
            assert!((runs[2].error.unwrap() - 5e-3).abs() < 1e-12, "{runs:?}");
        }
    }

    /// What has no order says so instead of passing for a number.
    #[test]
    fn no_order_of_nothing() {
        let exact = runs(&[(0.2, 7.0), (0.1, 7.0)]);
        assert!(refinement(Limit::Known(7.0)).order_of(&exact).unwrap_err().contains("have no order"));
        assert!(refinement(Limit::Richardson).order_of(&exact).unwrap_err().contains("three runs"));
        let uneven = runs(&[(0.4, 1.0), (0.2, 2.0), (0.05, 2.5)]);
        assert!(refinement(Limit::Richardson).order_of(&uneven).unwrap_err().contains("one factor"));
        assert!(refinement(Limit::Known(7.0)).order_of(&uneven[..1]).unwrap_err().contains("two runs"));
        let lost = runs(&[(0.2, f64::NAN), (0.1, 7.5)]);
        assert!(refinement(Limit::Known(7.0)).order_of(&lost).is_err());
    }
}
