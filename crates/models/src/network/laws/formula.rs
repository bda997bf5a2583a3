//! A law as a formula: whatever a scene writes.

use std::sync::Arc;

use souple_formal::Formula;
use souple_math::Dual;
use souple_table::{Parameter, Value};

use crate::network::law::{LinkEntry, LinkError, Moment, Reach, Response};
use crate::network::measures::{ENERGY, FORCE, LENGTH, Measures, TIME, VELOCITY};
use crate::network::written::{Arguments, OneByOne, WrittenLaw, constants, formula, refuse_unnamed};

/// What formulas of links may refer to, before the parameters of the scene.
const VARIABLES: [&str; 5] = ["D", "D_before", "V", "L0", "t"];

/// `φ` as a formula, or an energy whose negative slope it is.
#[derive(Clone, Debug)]
struct Written {
    formula: Arc<Formula>,
    kind: Kind,
    /// Values of the parameters, in place: a law that is driven is copied in every step.
    constants: Arguments<f64>,
    timestep: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Push,
    Energy,
}

impl Written {
    /// Values of the variables and their rates with `D` and `D_before`.
    fn arguments(&self, reach: &Reach, time: f64, [now, before]: [f64; 2]) -> Arguments<Dual> {
        let (length, past) = (Dual::new(reach.length, now), Dual::new(reach.before, before));
        let speed = (length - past) * (1.0 / self.timestep);
        let variables = [length, past, speed, Dual::constant(reach.rest), Dual::constant(time)];
        let constants = self.constants.as_slice().iter().map(|value| Dual::constant(*value));
        Arguments::new(Dual::constant(0.0), variables.into_iter().chain(constants))
    }

    fn push(&self, reach: &Reach, time: f64) -> f64 {
        match self.kind {
            Kind::Push => self.formula.evaluate_dual(self.arguments(reach, time, [0.0; 2]).as_slice()).value,
            Kind::Energy => {
                -self.formula.evaluate_dual(self.arguments(reach, time, [1.0, 0.0]).as_slice()).derivative
            }
        }
    }
}

impl WrittenLaw for Written {
    fn memory_len(&self) -> usize {
        0
    }

    fn begin(&self, _: f64, _: f64, _: &mut [f64]) {}

    fn is_conservative(&self) -> bool {
        self.kind == Kind::Energy
    }

    fn respond(&self, reach: &Reach, moment: &Moment, _: &mut [f64]) -> Response {
        let stored = match self.kind {
            Kind::Push => 0.0,
            Kind::Energy => {
                self.formula.evaluate_dual(self.arguments(reach, moment.time, [0.0; 2]).as_slice()).value
            }
        };
        Response { push: self.push(reach, moment.time), stored, heat: 0.0 }
    }

    fn slopes(&self, reach: &Reach, moment: &Moment, _: &[f64]) -> [f64; 2] {
        match self.kind {
            Kind::Push => [[1.0, 0.0], [0.0, 1.0]].map(|rates| {
                self.formula.evaluate_dual(self.arguments(reach, moment.time, rates).as_slice()).derivative
            }),
            Kind::Energy => {
                // formulas carry one rate: the second comes by a central difference of the first
                let step = f64::EPSILON.cbrt() * reach.length.abs().max(f64::MIN_POSITIVE);
                let at = |length| self.push(&Reach { length, ..*reach }, moment.time);
                [(at(reach.length + step) - at(reach.length - step)) / (2.0 * step), 0.0]
            }
        }
    }

    fn registers(&self) -> Vec<&str> {
        self.formula.variables()[VARIABLES.len()..].iter().map(String::as_str).collect()
    }

    fn with_register(&self, register: usize, value: f64) -> Option<Self> {
        let mut law = self.clone();
        *law.constants.as_mut_slice().get_mut(register)? = value;
        Some(law)
    }

    fn stiffest(&self, rest: f64) -> f64 {
        let [now, before] = self.slopes(&Reach { length: rest, before: rest, rest }, &Moment::of(0.0), &[]);
        (before - now).max(0.0)
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "formula",
    summary: "a law of your own: the push as a formula of D, D_before, V, L0 and t, or an energy of D, L0 and t",
    source: "Jimenez 1993, P2-I.4.2: ad hoc modules",
    parameters: &[
        Parameter::text("push", "φ [N], positive when it pushes the ends apart; this or `energy`")
            .or(Value::Text("")),
        Parameter::text("energy", "stored [J]; the push is minus its slope").or(Value::Text("")),
        Parameter::texts("parameters", "numbers that the formula names").or(Value::Texts(&[])),
    ],
    build: |making| {
        let (names, constants) = constants(making.values.texts("parameters"), VARIABLES.len(), &VARIABLES)?;
        let (push, energy) = (making.values.text("push"), making.values.text("energy"));
        let (kind, place, text) = match (push.is_empty(), energy.is_empty()) {
            (false, true) => (Kind::Push, "push", push),
            (true, false) => (Kind::Energy, "energy", energy),
            _ => {
                let what = "stands for one formula: write it, or `energy`, and not both".to_owned();
                return Err(LinkError::text("push", what));
            }
        };
        let variables: Vec<&str> = VARIABLES.into_iter().chain(names.iter().copied()).collect();
        let formula = formula(place, text, &variables)?;
        let measures = [("D", LENGTH), ("D_before", LENGTH), ("V", VELOCITY), ("L0", LENGTH), ("t", TIME)];
        let wanted = if kind == Kind::Push { FORCE } else { ENERGY };
        Measures::new(&measures, making.values.texts("parameters")).check(place, text, Some(wanted))?;
        refuse_unnamed(&names, &format!("`{place}` names"), |at| formula.depends_on(VARIABLES.len() + at))?;
        if kind == Kind::Energy && (formula.depends_on(1) || formula.depends_on(2)) {
            let what =
                "depends on D_before or V: an energy is of D alone, dampers belong to a `push`".to_owned();
            return Err(LinkError::text("energy", what));
        }
        let (formula, constants) = (Arc::new(formula), Arguments::new(0.0, constants));
        Ok(Box::new(OneByOne(Written { formula, kind, constants, timestep: making.timestep })))
    },
};
