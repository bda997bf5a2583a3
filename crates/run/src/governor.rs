//! Bodies with levels do less while a world is late, and more again when it is not (Debunne 2000, 5 §5.2).
//!
//! What the clock decides is an edit, so that a recording replays without a clock.

use souple_engine::{Edit, Model};

use crate::Session;

/// Load above which bodies with levels may do less, and below which they may do more again.
pub const FULL: f64 = 0.95;
const EASY: f64 = 0.75;
/// How much less and more that is, at once.
const LESS: f64 = 0.9;
const MORE: f64 = 1.02;
/// The least share of its budget that a body is left: a world that is late for another reason finds back within some hundred periods.
const LEAST: f64 = 0.01;

/// A budget that the clock rules.
struct Budget {
    system: usize,
    force: String,
    parameter: &'static str,
    /// As the scene says.
    most: f64,
    now: f64,
}

/// Rules the budgets of all bodies of a world that have one.
pub struct Governor {
    budgets: Vec<Budget>,
}

impl Governor {
    /// Of a model with the budgets that its scene says.
    pub fn new(model: &Model) -> Self {
        let mut budgets = Vec::new();
        for (system, of) in model.systems.iter().enumerate() {
            for force in &of.forces {
                let efforts = force.editable().into_iter().filter(|editable| force.is_effort(editable.name));
                budgets.extend(efforts.map(|budget| Budget {
                    system,
                    force: force.name().to_owned(),
                    parameter: budget.name,
                    most: budget.value,
                    now: budget.value,
                }));
            }
        }
        Self { budgets }
    }

    /// The same, where the world's budgets are others already.
    #[must_use]
    pub fn at(mut self, model: &Model) -> Self {
        for (budget, now) in self.budgets.iter_mut().zip(Self::new(model).budgets) {
            budget.now = now.now;
        }
        self
    }

    /// Sets budgets after a period that took `load` of the time that there is for one; how many that were.
    pub fn after(&mut self, session: &mut Session, load: f64) -> u64 {
        let mut set = 0;
        for budget in &mut self.budgets {
            let value = ruled(budget.now, budget.most, load);
            if value == budget.now {
                continue;
            }
            let (system, force) = (budget.system, budget.force.clone());
            let edit = Edit::SetParameter { system, force, parameter: budget.parameter.to_owned(), value };
            if session.edit(edit).is_ok() {
                budget.now = value;
                set += 1;
            }
        }
        set
    }
}

/// The budget after a period with a load, where it may be `most`.
pub fn ruled(budget: f64, most: f64, load: f64) -> f64 {
    match load {
        load if load > FULL => (budget * LESS).max(most * LEAST),
        load if load < EASY => (budget * MORE).min(most),
        _ => budget,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A world that was late for long has its whole budget back within 235 periods: `0.01 * 1.02^233 > 1`.
    #[test]
    fn budgets_come_back() {
        let most = 5e5;
        let late = (0..1000).fold(most, |budget, _| ruled(budget, most, 2.0));
        assert!((late / most - LEAST).abs() < 1e-12);
        let back = (0..235).fold(late, |budget, _| ruled(budget, most, 0.1));
        assert_eq!(back, most);
        assert_eq!(ruled(most, most, 0.9), most);
    }
}
