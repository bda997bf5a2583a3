//! Finite-state links: a law for each state, conditions that lead from one to the other, numbers that are remembered.
//!
//! At step `n` the transitions out of the present state are looked at in the order they are written; the last one whose
//! condition holds wins. What is entered may set remembered numbers; then the force is that of the new state, whose own numbers
//! may move on by a step: regimes and the switch between them, each with memory or without (specification §2.8.5).

use souple_engine::LinkState;
use souple_formal::{Condition, Formula};
use souple_math::Dual;
use souple_table::{Parameter, Value};

use crate::network::cases::{Questions, Truth};
use crate::network::law::{LinkEntry, LinkError, Making, Moment, Reach, Response};
use crate::network::measures::{ENERGY, FORCE, LENGTH, Measures, POWER, TIME, VELOCITY};
use crate::network::written::{
    ARGUMENTS, Arguments, OneByOne, WRITTEN_MEMORY, WrittenLaw, check_names, constants, formula,
    formula_within, refuse_unnamed,
};

/// What formulas and conditions may refer to, before what is remembered and the parameters of the scene.
const VARIABLES: [&str; 5] = ["D", "D_before", "V", "t", "Te"];

#[derive(Debug)]
struct FiniteState {
    states: Vec<State>,
    /// What each remembered number is at the start; `L0` is the first.
    starts: Vec<Formula>,
    constants: Vec<f64>,
    timestep: f64,
}

#[derive(Debug)]
struct State {
    push: Formula,
    /// Conditions and the states they lead to.
    transitions: Vec<(Condition, usize)>,
    /// Remembered numbers that are set on entry.
    settings: Vec<(usize, Formula)>,
    /// And in every step, after the force.
    updates: Vec<(usize, Formula)>,
    /// Stored [J].
    energy: Option<Formula>,
    /// Given off [W].
    loss: Option<Formula>,
    /// `D` from which on nothing happens in this state: no push, and no condition that holds [m].
    idle_from: Option<f64>,
}

impl State {
    /// Never any force.
    fn is_slack(&self) -> bool {
        let is_constant = !(0..self.push.variables().len()).any(|variable| self.push.depends_on(variable));
        let moves_on = !self.updates.is_empty() || self.energy.is_some() || self.loss.is_some();
        is_constant && self.push.evaluate(&[0.0; ARGUMENTS]) == 0.0 && !moves_on
    }

    /// Whether anything that it says names a variable.
    fn depends_on(&self, position: usize) -> bool {
        let set = self.settings.iter().chain(&self.updates).map(|(_, formula)| formula);
        let mut formulas = set.chain([&self.push]).chain(&self.energy).chain(&self.loss);
        formulas.any(|formula| formula.depends_on(position))
            || self.transitions.iter().any(|(condition, _)| condition.depends_on(position))
    }

    /// Without force, for good.
    fn is_end(&self) -> bool {
        self.transitions.is_empty() && self.is_slack()
    }
}

/// Place of the state among the numbers of a link; remembered numbers follow.
const STATE: usize = 0;

impl FiniteState {
    /// Values of variables, remembered numbers and parameters.
    fn arguments(&self, reach: &Reach, time: f64, memory: &[f64]) -> Arguments<f64> {
        let speed = (reach.length - reach.before) / self.timestep;
        let own = [reach.length, reach.before, speed, time, self.timestep];
        let rest = memory[1..].iter().chain(&self.constants).copied();
        Arguments::new(0.0, own.into_iter().chain(rest))
    }

    /// What a link stores that remembers this [J].
    fn stored(&self, reach: &Reach, time: f64, memory: &[f64]) -> f64 {
        let energy = &self.states[memory[STATE] as usize].energy;
        energy.as_ref().map_or(0.0, |energy| energy.evaluate(self.arguments(reach, time, memory).as_slice()))
    }

    /// Makes the transition of a step.
    fn switch(&self, reach: &Reach, time: f64, memory: &mut [f64]) -> &State {
        let state = &self.states[memory[STATE] as usize];
        let arguments = self.arguments(reach, time, memory);
        let Some((_, next)) =
            state.transitions.iter().rev().find(|(condition, _)| condition.holds(arguments.as_slice()))
        else {
            return state;
        };
        let entered = &self.states[*next];
        memory[STATE] = *next as f64;
        for (number, formula) in &entered.settings {
            memory[1 + number] = formula.evaluate(arguments.as_slice());
        }
        entered
    }
}

impl WrittenLaw for FiniteState {
    fn memory_len(&self) -> usize {
        1 + self.starts.len()
    }

    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        memory.fill(0.0);
        memory[1] = rest;
        let reach = Reach { length, before: length, rest };
        for (number, start) in self.starts.iter().enumerate().skip(1) {
            memory[1 + number] = start.evaluate(self.arguments(&reach, 0.0, memory).as_slice());
        }
    }

    fn is_conservative(&self) -> bool {
        false
    }

    // a state without force that nothing leads out of is the end
    fn state(&self, memory: &[f64]) -> LinkState {
        let number = memory[STATE] as usize;
        if self.states[number].is_end() {
            LinkState::Apart
        } else {
            LinkState::In(u8::try_from(number).unwrap_or(u8::MAX))
        }
    }

    fn idle_from(&self, memory: &[f64]) -> Option<f64> {
        self.states[memory[STATE] as usize].idle_from
    }

    fn respond(&self, reach: &Reach, moment: &Moment, memory: &mut [f64]) -> Response {
        let mut before = [0.0; WRITTEN_MEMORY];
        before[..memory.len()].copy_from_slice(memory);
        let before = &before[..memory.len()];
        let state = self.switch(reach, moment.time, memory);
        let arguments = self.arguments(reach, moment.time, memory);
        let of = |formula: &Formula| formula.evaluate(arguments.as_slice());
        let stored = state.energy.as_ref().map_or(0.0, of);
        // what a switch leaves less in store is given off
        let lost = if memory[STATE] != before[STATE] {
            self.stored(reach, moment.time, before) - stored
        } else {
            0.0
        };
        for (number, formula) in &state.updates {
            memory[1 + number] = of(formula);
        }
        Response {
            push: of(&state.push),
            stored,
            heat: lost + state.loss.as_ref().map_or(0.0, |loss| of(loss) * self.timestep),
        }
    }

    fn slopes(&self, reach: &Reach, moment: &Moment, memory: &[f64]) -> [f64; 2] {
        let mut numbers = [0.0; WRITTEN_MEMORY];
        numbers[..memory.len()].copy_from_slice(memory);
        let memory = &mut numbers[..memory.len()];
        let state = self.switch(reach, moment.time, memory);
        let values = self.arguments(reach, moment.time, memory);
        [(1.0, 0.0), (0.0, 1.0)].map(|(now, before)| {
            let constants = values.as_slice().iter().map(|value| Dual::constant(*value));
            let mut duals = Arguments::new(Dual::constant(0.0), constants);
            let own = duals.as_mut_slice();
            own[0].derivative = now;
            own[1].derivative = before;
            own[2].derivative = (now - before) / self.timestep;
            state.push.evaluate_dual(own).derivative
        })
    }

    // of the stiffest state, as links are at the start
    fn stiffest(&self, rest: f64) -> f64 {
        let mut memory = vec![0.0; self.memory_len()];
        self.begin(rest, rest, &mut memory);
        let of = |(index, state): (usize, &State)| {
            memory[STATE] = index as f64;
            let values = self.arguments(&Reach { length: rest, before: rest, rest }, 0.0, &memory);
            let slope = |by| state.push.differentiate(values.as_slice(), by).derivative;
            // H(-1) = -∂φ/∂D + ∂φ/∂D^r, with V = (D - D^r)/Te
            (slope(1) - slope(0) - 2.0 * slope(2) / self.timestep).max(0.0)
        };
        self.states.iter().enumerate().map(of).fold(0.0, f64::max)
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "finite_state",
    summary: "a law for each of several states, with conditions that lead from one to another and memory: collisions, \
              glue, plectra, grips, whatever switches",
    source: "Jimenez 1993, P2-I.3.3, P2-II.5",
    parameters: &[
        Parameter::texts(
            "states",
            "the push [N] in each state, of D, D_before, V, t, the step Te, L0 and the names below; the first is that of the start",
        ),
        Parameter::texts(
            "transitions",
            "conditions under \"a -> b\"; of those that hold the last written wins",
        )
        .or(Value::Texts(&[])),
        Parameter::texts("entries", "what a state sets when it is entered: \"L0 = D; k = 0\"")
            .or(Value::Texts(&[])),
        Parameter::texts(
            "updates",
            "what a state sets in every step, from what was before: \"x = x + Te * V / 2\"",
        )
        .or(Value::Texts(&[])),
        Parameter::texts(
            "energies",
            "stored in a state [J], for the account; what a transition leaves less of it is given off",
        )
        .or(Value::Texts(&[])),
        Parameter::texts("losses", "given off in a state [W], for the account; nothing where left out")
            .or(Value::Texts(&[])),
        Parameter::texts(
            "memory",
            "numbers that are remembered, with what they are at the start; L0 is always one",
        )
        .or(Value::Texts(&[])),
        Parameter::texts("parameters", "numbers that do not change, unless a control drives them")
            .or(Value::Texts(&[])),
    ],
    build: |making| Ok(Box::new(OneByOne(read(making)?))),
};

fn text(place: impl Into<String>, what: impl Into<String>) -> LinkError {
    LinkError::text(place, what)
}

fn read(making: &Making) -> Result<FiniteState, LinkError> {
    let texts = |name| making.values.texts(name);
    let own = || texts("memory").iter().map(|(name, _)| name.as_str());
    let known: Vec<&str> = VARIABLES.into_iter().chain(["L0"]).collect();
    check_names("memory", own(), &known)?;
    let remembered: Vec<&str> = ["L0"].into_iter().chain(own()).collect();
    let known: Vec<&str> = VARIABLES.into_iter().chain(remembered.iter().copied()).collect();
    let (names, constants) = constants(texts("parameters"), VARIABLES.len() + WRITTEN_MEMORY, &known)?;
    if 1 + remembered.len() > WRITTEN_MEMORY {
        return Err(text(
            "memory",
            format!("holds {} numbers; at most {}", remembered.len() - 1, WRITTEN_MEMORY - 2),
        ));
    }
    let variables: Vec<&str> =
        VARIABLES.into_iter().chain(remembered.iter().copied()).chain(names.iter().copied()).collect();
    check_measures(making)?;
    let mut states = Vec::new();
    let state_names: Vec<&str> = texts("states").iter().map(|(name, _)| name.as_str()).collect();
    for (name, push) in texts("states") {
        let push = formula(&format!("states.{name}"), push, &variables)?;
        states.push(State {
            push,
            transitions: Vec::new(),
            settings: Vec::new(),
            updates: Vec::new(),
            energy: None,
            loss: None,
            idle_from: None,
        });
    }
    if states.is_empty() {
        return Err(text("states", "is empty: a link is in one state at least"));
    }
    let find = |place: &str, name: &str| {
        state_names.iter().position(|known| *known == name).ok_or_else(|| {
            text(place, format!("names the state `{name}`; there are {}", state_names.join(", ")))
        })
    };
    let mut is_entered = vec![false; states.len()];
    is_entered[0] = true;
    for (arrow, condition) in texts("transitions") {
        let place = format!("transitions.\"{arrow}\"");
        let (from, to) = arrow
            .split_once("->")
            .ok_or_else(|| text(&place, "is no transition: write \"a -> b\" for from a to b"))?;
        let (from, to) = (find(&place, from.trim())?, find(&place, to.trim())?);
        let condition = Condition::compile(condition, &variables).map_err(|error| LinkError::Formula {
            place: place.clone(),
            begin: 0,
            error: Box::new(error),
        })?;
        is_entered[to] |= from != to;
        states[from].transitions.push((condition, to));
    }
    if let Some(state) = is_entered.iter().position(|entered| !entered) {
        let name = state_names[state];
        return Err(text(format!("states.{name}"), "is never entered: no transition leads there"));
    }
    for (key, is_entry) in [("entries", true), ("updates", false)] {
        for (name, settings) in texts(key) {
            let place = format!("{key}.{name}");
            let state = &mut states[find(&place, name)?];
            let own = if is_entry { &mut state.settings } else { &mut state.updates };
            own.extend(assignments(&place, settings, &remembered, &variables)?);
        }
    }
    for (key, is_energy) in [("energies", true), ("losses", false)] {
        for (name, said) in texts(key) {
            let place = format!("{key}.{name}");
            let (state, formula) = (find(&place, name)?, formula(&place, said, &variables)?);
            let own = &mut states[state];
            *(if is_energy { &mut own.energy } else { &mut own.loss }) = Some(formula);
        }
    }
    let unknowns = VARIABLES.len() + remembered.len();
    for (state, name) in states.iter_mut().zip(&state_names) {
        let place = format!("states.{name}");
        check_that_all_fire(state, &place, &state_names, &variables, &constants, making)?;
        if state.is_slack() {
            let bound = |(condition, _): &(Condition, usize)| {
                bound_below(condition, &variables, &constants, unknowns)
            };
            let bounds: Option<Vec<f64>> = state.transitions.iter().map(bound).collect();
            state.idle_from = bounds.map(|bounds| bounds.into_iter().fold(0.0, f64::max));
        }
    }
    let mut starts = vec![formula("L0", "L0", &variables)?];
    for (name, start) in texts("memory") {
        starts.push(formula(&format!("memory.{name}"), start, &variables)?);
    }
    refuse_unnamed(&names, "its formulas name", |at| {
        let position = unknowns + at;
        starts.iter().any(|start| start.depends_on(position))
            || states.iter().any(|state| state.depends_on(position))
    })?;
    Ok(FiniteState { states, starts, constants, timestep: making.timestep })
}

/// Refuses parameters whose units are not those of their places; what is remembered may have any, but for `L0`.
fn check_measures(making: &Making) -> Result<(), LinkError> {
    let texts = |name| making.values.texts(name);
    let of_variables =
        [("D", LENGTH), ("D_before", LENGTH), ("V", VELOCITY), ("t", TIME), ("Te", TIME), ("L0", LENGTH)];
    let measures = Measures::new(&of_variables, texts("parameters"));
    for (key, wanted) in
        [("states", Some(FORCE)), ("transitions", None), ("energies", Some(ENERGY)), ("losses", Some(POWER))]
    {
        for (name, said) in texts(key) {
            let place = match key {
                "transitions" => format!("{key}.\"{name}\""),
                _ => format!("{key}.{name}"),
            };
            measures.check(&place, said, wanted)?;
        }
    }
    for key in ["entries", "updates"] {
        for (name, settings) in texts(key) {
            for (number, value) in settings.split(';').filter_map(|setting| setting.split_once('=')) {
                let wanted = (number.trim() == "L0").then_some(LENGTH);
                measures.check_within(&format!("{key}.{name}"), settings, value.trim(), wanted)?;
            }
        }
    }
    Ok(())
}

/// What a text like `L0 = D; k = 0` sets of what is remembered.
fn assignments(
    place: &str,
    settings: &str,
    remembered: &[&str],
    variables: &[&str],
) -> Result<Vec<(usize, Formula)>, LinkError> {
    let each = settings.split(';').map(str::trim).filter(|setting| !setting.is_empty());
    each.map(|setting| {
        let (number, value) = setting
            .split_once('=')
            .ok_or_else(|| text(place, format!("says `{setting}`: write \"L0 = D; k = 0\"")))?;
        let number = remembered.iter().position(|known| *known == number.trim()).ok_or_else(|| {
            text(place, format!("sets `{}`; remembered are {}", number.trim(), remembered.join(", ")))
        })?;
        Ok((number, formula_within(place, settings, value.trim(), variables)?))
    })
    .collect()
}

/// Arguments of which only the parameters are known.
fn known(constants: &[f64], unknowns: usize) -> Arguments<f64> {
    Arguments::new(0.0, std::iter::repeat_n(0.0, unknowns).chain(constants.iter().copied()))
}

/// The number that a condition `D < number` asks lengths to stay below.
fn bound_below(condition: &Condition, variables: &[&str], constants: &[f64], unknowns: usize) -> Option<f64> {
    let (left, right) = condition.text().split_once('<')?;
    let bound = Formula::compile(right.trim_start_matches('='), variables).ok()?;
    let is_known = !(0..unknowns).any(|variable| bound.depends_on(variable));
    // one that holds at the bound itself holds below all that is beyond
    (left.trim() == "D" && is_known).then(|| bound.evaluate(known(constants, unknowns).as_slice()))
}

/// Conditions that can never hold, and those that later ones always outdo.
fn check_that_all_fire(
    state: &State,
    place: &str,
    names: &[&str],
    variables: &[&str],
    constants: &[f64],
    making: &Making,
) -> Result<(), LinkError> {
    let least_length = making.least_length();
    // what a control drives may be anything
    let is_driven = |name: &str| making.driven.iter().any(|driven| driven == name);
    let (unknowns, parameters) = variables.split_at(variables.len() - constants.len());
    if making.driven.iter().any(|name| !parameters.contains(&name.as_str())) {
        // a control that is misspelt is refused where it is written, and what it was to drive is not known
        return Ok(());
    }
    let known = || parameters.iter().zip(constants).filter(|(name, _)| !is_driven(name));
    let variables: Vec<&str> = unknowns
        .iter()
        .chain(parameters.iter().filter(|name| is_driven(name)))
        .chain(known().map(|(name, _)| name))
        .copied()
        .collect();
    let constants: Vec<f64> = known().map(|(_, number)| *number).collect();
    let low = |name: &str| match name {
        "D" | "D_before" => least_length,
        "t" | "Te" => 0.0,
        _ => f64::NEG_INFINITY,
    };
    let mut questions = Questions::new(&variables, &constants, low);
    let truths: Vec<Truth> =
        state.transitions.iter().map(|(condition, _)| questions.read(condition.text())).collect();
    for (at, (condition, to)) in state.transitions.iter().enumerate() {
        let (said, later) = (condition.text(), &truths[at + 1..]);
        if questions.can_hold(&truths[at], later) {
            continue;
        }
        let why = if !questions.can_hold(&truths[at], &[]) {
            let mut without_lengths = Questions::new(&variables, &constants, |_| f64::NEG_INFINITY);
            let alone = without_lengths.read(said);
            let is_distance = least_length == 0.0 && without_lengths.can_hold(&alone, &[]);
            let hint = if is_distance { ", and distances in space are not below 0" } else { "" };
            format!("`{said}` does not hold, whatever happens{hint}")
        } else if let Some(one) = (at + 1..truths.len())
            .find(|one| !questions.can_hold(&truths[at], std::slice::from_ref(&truths[*one])))
        {
            let later = state.transitions[one].0.text();
            format!("`{later}` after it holds whenever it does, and the last that holds wins")
        } else {
            "one of those after it holds whenever it does, and the last that holds wins".to_owned()
        };
        return Err(text(place, format!("has a transition to `{}` that never fires: {why}", names[*to])));
    }
    Ok(())
}
