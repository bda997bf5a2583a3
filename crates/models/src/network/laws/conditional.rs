//! The conditional link in the words of its source: a spring and damper whose numbers change with a finite automaton.
//!
//! `F1 = -K L - Z dV` with `L = D - L0` and `dV = D - D^r`. At step `n` the transitions of the present state are looked at
//! on the variables of that step; the last one met wins, one at most is made, its entry dispositions are carried out, and
//! the force is that of the new state. `finite_state` does the same with formulas.

use std::cell::Cell;

use souple_engine::LinkState;
use souple_formal::{BinaryOperator, Formula};
use souple_math::Vec3;
use souple_table::{Parameter, Range, Value};

use crate::network::cases::{Questions, Truth};
use crate::network::law::{AsksFor, LinkEntry, LinkError, Making, Moment, Reach, Response};
use crate::network::written::{
    OneByOne, WrittenLaw, check_names, formula, formula_within, number_in, refuse_unnamed,
};

/// Numbers that a link remembers: the state, `K`, `Z`, `L0`, and `dV` of the step before.
const STATE: usize = 0;
const STIFFNESS: usize = 1;
const DAMPING: usize = 2;
const LENGTH: usize = 3;
const MOVED: usize = 4;
const MEMORY: usize = 5;

#[derive(Debug)]
struct Conditional {
    states: Vec<State>,
    stiffness: f64,
    /// `z/Te` [N/m].
    damping: f64,
    /// What `CDX` stands for, of `t`.
    external: Option<Formula>,
    asks: AsksFor,
    /// Whether a condition compares `dV` with that of the step before.
    watches_moved: bool,
}

#[derive(Debug, Default)]
struct State {
    entries: Vec<Disposition>,
    /// `LN`: elongation is nothing.
    without_elongation: bool,
    /// `VN`: velocity is nothing.
    without_velocity: bool,
    transitions: Vec<Transition>,
    /// `D` from which on nothing happens in this state: no force, and no condition that holds [m].
    idle_from: Option<f64>,
}

/// What happens on entry.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Disposition {
    /// `L0=D`
    RestHere,
    /// `CHK, k` [N/m]
    Stiffness(f64),
    /// `CHZ, z`, as `z/Te` [N/m]
    Damping(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Transition {
    condition: Condition,
    to: usize,
}

/// When a transition is made.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Condition {
    Grows(Variable),
    Shrinks(Variable),
    ChangesSign(Variable),
    Above(Variable, f64),
    Below(Variable, f64),
    /// `CDX`: an operator, or another part of the object.
    External,
    Always,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Variable {
    /// `D`
    Length,
    /// `L`
    Elongation,
    /// `dV`
    Moved,
    /// `X1` and `X2` on an axis, and their components in space.
    Place { end: u8, component: u8 },
}

/// Variables now and a step before.
#[derive(Clone, Copy, Debug)]
struct Watched {
    length: [f64; 2],
    elongation: [f64; 2],
    moved: [f64; 2],
    places: [[Vec3; 2]; 2],
}

impl Watched {
    fn of(reach: &Reach, moment: &Moment, memory: &[f64]) -> Self {
        let (now, before) = (reach.length, reach.before);
        Self {
            length: [now, before],
            elongation: [now - memory[LENGTH], before - memory[LENGTH]],
            moved: [now - before, memory[MOVED]],
            places: moment.places,
        }
    }

    fn value(&self, variable: Variable) -> [f64; 2] {
        match variable {
            Variable::Length => self.length,
            Variable::Elongation => self.elongation,
            Variable::Moved => self.moved,
            Variable::Place { end, component } => {
                self.places[usize::from(end)].map(|place| place[usize::from(component)])
            }
        }
    }
}

impl Conditional {
    fn holds(&self, condition: Condition, watched: &Watched, time: f64) -> bool {
        match condition {
            Condition::Grows(variable) => {
                let [now, before] = watched.value(variable);
                now > before
            }
            Condition::Shrinks(variable) => {
                let [now, before] = watched.value(variable);
                now < before
            }
            Condition::ChangesSign(variable) => {
                let [now, before] = watched.value(variable);
                // a sign that it had: from rest nothing has changed yet
                now * before < 0.0 || (now == 0.0 && before != 0.0)
            }
            Condition::Above(variable, bound) => watched.value(variable)[0] > bound,
            Condition::Below(variable, bound) => watched.value(variable)[0] < bound,
            Condition::External => self.external.as_ref().is_some_and(|cdx| cdx.evaluate(&[time]) > 0.0),
            Condition::Always => true,
        }
    }

    /// Makes the transition of a step.
    fn switch(&self, reach: &Reach, moment: &Moment, memory: &mut [f64]) -> &State {
        let state = &self.states[memory[STATE] as usize];
        let watched = Watched::of(reach, moment, memory);
        let met = |transition: &&Transition| self.holds(transition.condition, &watched, moment.time);
        let Some(Transition { to, .. }) = state.transitions.iter().rev().find(met) else { return state };
        memory[STATE] = *to as f64;
        let entered = &self.states[*to];
        for entry in &entered.entries {
            match entry {
                Disposition::RestHere => memory[LENGTH] = reach.length,
                Disposition::Stiffness(stiffness) => memory[STIFFNESS] = *stiffness,
                Disposition::Damping(damping) => memory[DAMPING] = *damping,
            }
        }
        entered
    }

    /// `-K` and `-Z` as they act.
    fn act(state: &State, memory: &[f64]) -> [f64; 2] {
        [
            if state.without_elongation { 0.0 } else { memory[STIFFNESS] },
            if state.without_velocity { 0.0 } else { memory[DAMPING] },
        ]
    }
}

impl WrittenLaw for Conditional {
    fn memory_len(&self) -> usize {
        MEMORY
    }

    fn begin(&self, rest: f64, _: f64, memory: &mut [f64]) {
        memory[..MEMORY].copy_from_slice(&[0.0, self.stiffness, self.damping, rest, 0.0]);
    }

    fn is_conservative(&self) -> bool {
        false
    }

    // what CHK and CHZ set from then on
    fn begins_with(&self) -> &[&'static str] {
        &["stiffness", "damping"]
    }

    fn asks_for(&self) -> AsksFor {
        self.asks
    }

    fn idle_from(&self, memory: &[f64]) -> Option<f64> {
        let state = &self.states[memory[STATE] as usize];
        let is_slack = Self::act(state, memory) == [0.0, 0.0] && !self.watches_moved;
        state.idle_from.filter(|_| is_slack)
    }

    fn state(&self, memory: &[f64]) -> LinkState {
        let state = &self.states[memory[STATE] as usize];
        let is_slack = Self::act(state, memory) == [0.0, 0.0];
        // without force and without a way out
        if is_slack && state.transitions.is_empty() {
            LinkState::Apart
        } else {
            LinkState::In(u8::try_from(memory[STATE] as usize).unwrap_or(u8::MAX))
        }
    }

    // φ = -K L - Z dV
    fn respond(&self, reach: &Reach, moment: &Moment, memory: &mut [f64]) -> Response {
        let state = self.switch(reach, moment, memory);
        let [stiffness, damping] = Self::act(state, memory);
        let (elongation, moved) = (reach.length - memory[LENGTH], reach.length - reach.before);
        memory[MOVED] = if self.watches_moved { moved } else { 0.0 };
        Response {
            push: -stiffness * elongation - damping * moved,
            stored: 0.5 * stiffness * elongation * elongation,
            heat: damping * moved * moved,
        }
    }

    fn slopes(&self, reach: &Reach, moment: &Moment, memory: &[f64]) -> [f64; 2] {
        let mut numbers = [0.0; MEMORY];
        numbers.copy_from_slice(&memory[..MEMORY]);
        let state = self.switch(reach, moment, &mut numbers);
        let [stiffness, damping] = Self::act(state, &numbers);
        [-stiffness - damping, damping]
    }

    // the stiffest and the most damped that any way through the states leads to
    fn stiffest(&self, _: f64) -> f64 {
        let entries = || self.states.iter().flat_map(|state| &state.entries);
        let of = |start: f64, number: fn(&Disposition) -> Option<f64>| {
            entries().filter_map(number).fold(start, f64::max)
        };
        let stiffness = of(self.stiffness, |entry| match entry {
            Disposition::Stiffness(stiffness) => Some(*stiffness),
            _ => None,
        });
        let damping = of(self.damping, |entry| match entry {
            Disposition::Damping(damping) => Some(*damping),
            _ => None,
        });
        stiffness + 2.0 * damping
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "conditional",
    summary: "a spring and damper whose numbers change with a finite automaton, in the words of its source: AUG, DIM, CHS, \
              SUP, INF, CDX; L0=D, CHK, CHZ; LN, VN",
    source: "Jimenez 1993, P2-I.3.3",
    parameters: &[
        Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "K at the start").or(Value::Number(0.0)),
        Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "z at the start").or(Value::Number(0.0)),
        Parameter::texts(
            "states",
            "what each state does, the first is that of the start: \"CHK, 100 N/m; INF, D, 1 mm -> other\"",
        ),
        Parameter::texts("parameters", "numbers that states may name").or(Value::Texts(&[])),
        Parameter::text("external", "CDX: a formula of t, met while it is above 0").or(Value::Text("")),
    ],
    build: |making| Ok(Box::new(OneByOne(read(making)?))),
};

fn refuse<T>(place: &str, what: impl Into<String>) -> Result<T, LinkError> {
    Err(LinkError::text(place, what))
}

fn read(making: &Making) -> Result<Conditional, LinkError> {
    let texts = making.values.texts("states");
    let names: Vec<&str> = texts.iter().map(|(name, _)| name.as_str()).collect();
    if names.is_empty() {
        return refuse("states", "is empty: a link is in one state at least");
    }
    let external = match making.values.text("external") {
        "" => None,
        text => Some(formula("external", text, &["t"])?),
    };
    let parameters = making.values.texts("parameters");
    let parameter_names: Vec<&str> = parameters.iter().map(|(name, _)| name.as_str()).collect();
    check_names("parameters", parameter_names.iter().copied(), &["D", "L", "dV"])?;
    let reader = Words {
        names: &names,
        parameters,
        are_named: parameters.iter().map(|_| Cell::new(false)).collect(),
        timestep: making.timestep,
        has_external: external.is_some(),
        asks: Cell::default(),
    };
    let mut states = Vec::new();
    for (name, text) in texts {
        states.push(reader.state(Said { place: &format!("states.{name}"), text })?);
    }
    refuse_unnamed(&parameter_names, "its states name", |at| reader.are_named[at].get())?;
    let compares_moved = |transition: &Transition| {
        use Condition::{ChangesSign, Grows, Shrinks};
        matches!(
            transition.condition,
            Grows(Variable::Moved) | Shrinks(Variable::Moved) | ChangesSign(Variable::Moved)
        )
    };
    let conditional = Conditional {
        watches_moved: states.iter().flat_map(|state: &State| &state.transitions).any(compares_moved),
        states,
        stiffness: making.values.number("stiffness"),
        damping: making.values.number("damping") / making.timestep,
        external,
        asks: reader.asks.get(),
    };
    check(&conditional, &names, making.least_length())?;
    Ok(conditional)
}

/// States that nothing leads to, and transitions that never fire.
fn check(link: &Conditional, names: &[&str], least_length: f64) -> Result<(), LinkError> {
    let mut reached = vec![false; names.len()];
    let mut to_look_at = vec![0];
    while let Some(state) = to_look_at.pop() {
        if std::mem::replace(&mut reached[state], true) {
            continue;
        }
        to_look_at.extend(link.states[state].transitions.iter().map(|transition| transition.to));
    }
    if let Some(lost) = reached.iter().position(|reached| !reached) {
        return refuse(
            &format!("states.{}", names[lost]),
            "is never entered: no transition leads there from the first",
        );
    }
    let low = |name: &str| if name == "D" { least_length } else { f64::NEG_INFINITY };
    let mut questions = Questions::new(&COMPARED, &[], low);
    for (state, name) in link.states.iter().zip(names) {
        let place = format!("states.{name}");
        let truths: Vec<Truth> =
            state.transitions.iter().map(|transition| truth(transition.condition, &mut questions)).collect();
        for (at, Transition { condition, to }) in state.transitions.iter().enumerate() {
            let later = &truths[at + 1..];
            if questions.can_hold(&truths[at], later) {
                continue;
            }
            let why = match condition {
                Condition::Below(Variable::Length, bound) if !questions.can_hold(&truths[at], &[]) => {
                    format!("`D` is a distance, which is not below {bound} m")
                }
                _ if later.contains(&Truth::Settled(true)) => {
                    "`ANY` after it is always met, and the last one met wins".to_owned()
                }
                _ => "one after it is met whenever this is, and the last one met wins".to_owned(),
            };
            let to = names[*to];
            return refuse(&place, format!("has a transition to `{to}` that never fires: {why}"));
        }
    }
    Ok(())
}

/// What conditions compare with numbers.
const COMPARED: [&str; 9] = ["D", "L", "dV", "X1.x", "X1.y", "X1.z", "X2.x", "X2.y", "X2.z"];

/// What a condition asks.
fn truth(condition: Condition, questions: &mut Questions) -> Truth {
    let compared = |variable, operator, number| {
        let variable = match variable {
            Variable::Length => 0,
            Variable::Elongation => 1,
            Variable::Moved => 2,
            Variable::Place { end, component } => 3 + 3 * usize::from(end) + usize::from(component),
        };
        Truth::Compared { variable, operator, number }
    };
    match condition {
        Condition::Above(variable, number) => compared(variable, BinaryOperator::Greater, number),
        Condition::Below(variable, number) => compared(variable, BinaryOperator::Less, number),
        Condition::Always => Truth::Settled(true),
        _ => questions.other(&format!("{condition:?}")),
    }
}

/// What is written of a state, and the keys that lead there.
#[derive(Clone, Copy)]
struct Said<'a> {
    place: &'a str,
    text: &'a str,
}

/// What words mean.
struct Words<'a> {
    names: &'a [&'a str],
    parameters: &'a [(String, String)],
    /// Whether states name each of them, as far as they are read.
    are_named: Vec<Cell<bool>>,
    timestep: f64,
    has_external: bool,
    /// What conditions have asked for so far.
    asks: Cell<AsksFor>,
}

impl Words<'_> {
    fn state(&self, said: Said) -> Result<State, LinkError> {
        let mut state = State::default();
        for words in said.text.split(';').map(str::trim).filter(|words| !words.is_empty()) {
            match words.split_once("->") {
                Some((condition, to)) => {
                    let to = to.trim();
                    let Some(to) = self.names.iter().position(|name| *name == to) else {
                        return refuse(
                            said.place,
                            format!("leads to the state `{to}`; there are {}", self.names.join(", ")),
                        );
                    };
                    let condition = self.condition(said, condition.trim())?;
                    state.transitions.push(Transition { condition, to });
                }
                None => self.disposition(said, words, &mut state)?,
            }
        }
        // nothing holds from the greatest bound on where all conditions ask for short links
        let bound = |transition: &Transition| match transition.condition {
            Condition::Below(Variable::Length, bound) => Some(bound),
            _ => None,
        };
        let bounds: Option<Vec<f64>> = state.transitions.iter().map(bound).collect();
        state.idle_from = bounds.map(|bounds| bounds.into_iter().fold(0.0, f64::max));
        Ok(state)
    }

    fn disposition(&self, said: Said, words: &str, state: &mut State) -> Result<(), LinkError> {
        let parts: Vec<&str> = words.split(',').map(str::trim).collect();
        match parts[..] {
            ["LN"] => state.without_elongation = true,
            ["VN"] => state.without_velocity = true,
            ["CHK", number] => {
                state.entries.push(Disposition::Stiffness(self.positive(said, words, number, "N/m")?));
            }
            ["CHZ", number] => {
                let damping = self.positive(said, words, number, "N s/m")? / self.timestep;
                state.entries.push(Disposition::Damping(damping));
            }
            [words] if words.replace(' ', "") == "L0=D" => state.entries.push(Disposition::RestHere),
            _ => {
                let what = format!(
                    "says `{words}`: write `L0=D`, `CHK, k`, `CHZ, z`, `LN`, `VN`, or a condition with `-> state`"
                );
                return refuse(said.place, what);
            }
        }
        Ok(())
    }

    fn condition(&self, said: Said, words: &str) -> Result<Condition, LinkError> {
        let parts: Vec<&str> = words.split(',').map(str::trim).collect();
        Ok(match parts[..] {
            ["AUG", variable] => Condition::Grows(self.variable(said.place, variable)?),
            ["DIM", variable] => Condition::Shrinks(self.variable(said.place, variable)?),
            ["CHS", variable] => Condition::ChangesSign(self.variable(said.place, variable)?),
            ["SUP", variable, bound] => Condition::Above(
                self.variable(said.place, variable)?,
                self.bound(said, words, variable, bound)?,
            ),
            ["INF", variable, bound] => Condition::Below(
                self.variable(said.place, variable)?,
                self.bound(said, words, variable, bound)?,
            ),
            ["CDX"] if self.has_external => Condition::External,
            ["CDX"] => {
                return refuse(
                    said.place,
                    "asks for `CDX`, and there is no `external`: the condition never holds",
                );
            }
            ["ANY"] => Condition::Always,
            _ => {
                let what = format!(
                    "has the condition `{words}`: write `AUG, var`, `DIM, var`, `CHS, var`, `SUP, var, number`, \
                     `INF, var, number`, `CDX` or `ANY`"
                );
                return refuse(said.place, what);
            }
        })
    }

    fn variable(&self, place: &str, name: &str) -> Result<Variable, LinkError> {
        match name {
            "D" => Ok(Variable::Length),
            "L" => Ok(Variable::Elongation),
            "dV" => Ok(Variable::Moved),
            _ => match self.place(name) {
                Some(variable) => Ok(variable),
                None => refuse(
                    place,
                    format!(
                        "asks for `{name}`; variables are D, L, dV and the places of the ends: X1 and X2 on an axis, X1.x to X2.z in space"
                    ),
                ),
            },
        }
    }

    /// A place of an end.
    fn place(&self, name: &str) -> Option<Variable> {
        let (end, rest) = match name.split_at_checked(2)? {
            ("X1", rest) => (0, rest),
            ("X2", rest) => (1, rest),
            _ => return None,
        };
        let component = ["", ".x", ".y", ".z"].iter().position(|known| *known == rest)?;
        let mut asks = self.asks.get();
        match component {
            0 => asks.place_on_axis = true,
            _ => asks.place_in_space = true,
        }
        self.asks.set(asks);
        Some(Variable::Place { end, component: component.saturating_sub(1) as u8 })
    }

    /// A bound of a variable; velocities are given in m/s, and are lengths of a step within.
    fn bound(&self, said: Said, words: &str, variable: &str, number: &str) -> Result<f64, LinkError> {
        let unit = if variable == "dV" { "m/s" } else { "m" };
        let number = self.number(said, words, number, unit)?;
        Ok(if variable == "dV" { number * self.timestep } else { number })
    }

    fn positive(&self, said: Said, words: &str, number: &str, unit: &str) -> Result<f64, LinkError> {
        let value = self.number(said, words, number, unit)?;
        if value < 0.0 {
            refuse(said.place, format!("says `{words}`: a number of at least 0"))
        } else {
            Ok(value)
        }
    }

    /// A number in SI units, a quantity of the kind of `unit` or the name of a parameter.
    fn number(&self, said: Said, words: &str, text: &str, unit: &str) -> Result<f64, LinkError> {
        let named = self.parameters.iter().zip(&self.are_named).find(|((name, _), _)| name == text);
        let named = named.map(|(parameter, is_named)| {
            is_named.set(true);
            parameter
        });
        let text = named.map_or(text, |(_, value)| value);
        let formula = || match named {
            Some((name, _)) => formula(&format!("parameters.{name}"), text, &[]),
            None => formula_within(said.place, said.text, text, &[]),
        };
        let value = match number_in(text, unit) {
            Some(Ok(value)) => value,
            Some(Err(problem)) => match named {
                Some((name, _)) => {
                    let what = format!("stands in `{words}` of `{}`: {problem}", said.place);
                    return refuse(&format!("parameters.{name}"), what);
                }
                None => return refuse(said.place, format!("says `{words}`: {problem}")),
            },
            None => formula()?.evaluate(&[]),
        };
        if value.is_finite() {
            Ok(value)
        } else {
            refuse(said.place, format!("says `{words}`: a finite number"))
        }
    }
}

#[cfg(test)]
mod tests {
    use souple_table::Values;

    use super::*;
    use crate::network::Span;

    const TE: f64 = 1e-3;

    fn link(states: &[(&str, &str)], more: Values) -> Result<Conditional, String> {
        let texts: Vec<(String, String)> =
            states.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
        let values =
            ENTRY.values(more.with("states", Value::Texts(&texts))).map_err(|error| error.to_string())?;
        read(&Making { values: &values, timestep: TE, span: Span::Distance, driven: &[] })
            .map_err(|error| error.to_string())
    }

    /// States and pushes along a course of lengths, the first of which is that of rest.
    fn course(link: &Conditional, lengths: &[f64]) -> (Vec<usize>, Vec<f64>) {
        let mut memory = [0.0; MEMORY];
        link.begin(lengths[0], lengths[0], &mut memory);
        let steps = lengths.iter().zip([&lengths[0]].into_iter().chain(lengths)).enumerate();
        steps
            .map(|(n, (now, before))| {
                let reach = Reach { length: *now, before: *before, rest: lengths[0] };
                let push = link.respond(&reach, &Moment::of(n as f64 * TE), &mut memory).push;
                (memory[STATE] as usize, push)
            })
            .unzip()
    }

    fn stiff(k: f64) -> Values {
        Values::new().with("stiffness", Value::Number(k))
    }

    /// The eight recipes of the source go through the states that their names promise.
    #[test]
    fn eight_recipes() {
        let states = |link: &Conditional, lengths: &[f64]| course(link, lengths).0;
        // a stop at 1: pushes inside only
        let stop = link(
            &[("away", "CHK, 0; CHZ, 0; INF, D, 1 -> in"), ("in", "L0=D; CHK, 100; SUP, D, 1 -> away")],
            Values::new(),
        )
        .unwrap();
        let (seen, pushes) = course(&stop, &[1.5, 1.2, 0.9, 0.8, 1.1]);
        assert_eq!(seen, [0, 0, 1, 1, 0]);
        assert!((pushes[3] - 10.0).abs() < 1e-12 && pushes[1] == 0.0 && pushes[4] == 0.0, "{pushes:?}");
        // fracture
        let torn =
            link(&[("whole", "SUP, L, 0.1 -> torn"), ("torn", "CHK, 0; CHZ, 0")], stiff(50.0)).unwrap();
        let (seen, pushes) = course(&torn, &[1.0, 1.05, 1.2, 1.0]);
        assert_eq!(seen, [0, 0, 1, 1]);
        assert!((pushes[1] + 50.0 * 0.05).abs() < 1e-12 && pushes[2..] == [0.0, 0.0]);
        // glue takes the length at which it met
        let glue =
            link(&[("free", "INF, D, 0.5 -> held"), ("held", "L0=D; CHK, 20")], Values::new()).unwrap();
        let (seen, pushes) = course(&glue, &[1.0, 0.6, 0.4, 0.7]);
        assert_eq!(seen, [0, 0, 1, 1]);
        assert!(pushes[2] == 0.0 && (pushes[3] + 20.0 * 0.3).abs() < 1e-12);
        // breaks and sticks again
        let again = link(
            &[("free", "CHK, 0; INF, D, 0.5 -> held"), ("held", "L0=D; CHK, 20; SUP, L, 0.2 -> free")],
            Values::new(),
        )
        .unwrap();
        assert_eq!(states(&again, &[1.0, 0.4, 0.5, 0.7, 0.6, 0.3]), [0, 1, 1, 0, 0, 1]);
        // a plectrum lets go, and takes hold when the string has swung through
        let plectrum = link(
            &[("held", "CHK, 30; SUP, L, 0.1 -> gone"), ("gone", "CHK, 0; CHS, L -> held")],
            stiff(30.0),
        )
        .unwrap();
        assert_eq!(states(&plectrum, &[1.0, 1.05, 1.2, 1.1, 0.9, 0.95]), [0, 0, 1, 1, 0, 0]);
        // plasticity by steps
        let steps =
            link(&[("firm", "SUP, L, 0.1 -> slip"), ("slip", "L0=D; ANY -> firm")], stiff(10.0)).unwrap();
        assert_eq!(states(&steps, &[1.0, 1.2, 1.25, 1.4, 1.4]), [0, 1, 0, 1, 0]);
        // a grip on command
        let grip = link(
            &[("open", "CHK, 0; CDX -> shut"), ("shut", "L0=D; CHK, 40")],
            Values::new().with("external", Value::Text("if(t > 1.5e-3, 1, 0)")),
        )
        .unwrap();
        assert_eq!(states(&grip, &[1.0, 1.0, 1.0, 1.1]), [0, 0, 1, 1]);
        // a damper that works one way
        let one_way = link(
            &[("brakes", "DIM, D -> free"), ("free", "VN; AUG, D -> brakes")],
            Values::new().with("damping", Value::Number(2.0)),
        )
        .unwrap();
        let (seen, pushes) = course(&one_way, &[1.0, 1.1, 1.0, 0.9, 1.0]);
        assert_eq!(seen, [0, 0, 1, 1, 0]);
        assert!(pushes[1] < 0.0 && pushes[2..4] == [0.0, 0.0] && pushes[4] < 0.0);
    }

    /// Of several conditions that hold, the last one written wins; velocities are given in m/s.
    #[test]
    fn last_condition_met_wins() {
        let both =
            link(&[("a", "SUP, D, 1 -> b; SUP, dV, 50 m/s -> c"), ("b", ""), ("c", "")], Values::new())
                .unwrap();
        assert_eq!(course(&both, &[0.9, 1.2]).0, [0, 2]);
        assert_eq!(course(&both, &[0.99, 1.02]).0, [0, 1]);
    }

    #[test]
    fn wrong_words_are_refused() {
        let refused = |states: &[(&str, &str)], words: &[&str]| {
            let message = link(states, Values::new()).expect_err("refused");
            for word in words {
                assert!(message.contains(word), "`{word}` is not in: {message}");
            }
        };
        refused(&[("a", "SUP, D, 1 -> b")], &["states.a", "leads to the state `b`", "there are a"]);
        refused(&[("a", "ANY -> b"), ("b", ""), ("c", "ANY -> a")], &["states.c", "never entered"]);
        refused(
            &[("a", "INF, D, 1 -> b; ANY -> a"), ("b", "")],
            &["to `b` that never fires", "`ANY` after it"],
        );
        refused(
            &[("a", "SUP, D, 2 -> b; SUP, D, 1 -> c"), ("b", ""), ("c", "")],
            &["to `b` that never fires"],
        );
        refused(&[("a", "CDX -> a")], &["no `external`", "never holds"]);
        refused(&[("a", "SUP, X3, 1 -> a")], &["`X3`", "X1.x to X2.z"]);
        refused(&[("a", "SUB, D, 1 -> a")], &["`SUB, D, 1`", "AUG, var"]);
        refused(&[("a", "CHK, -1")], &["`CHK, -1`", "at least 0"]);
        refused(&[("a", "CHK, k")], &["k"]);
        refused(&[("a", "L0=3")], &["`L0=3`", "L0=D"]);
        refused(&[], &["states"]);
    }

    /// Conditions know where ends are, and which way they came.
    #[test]
    fn places_are_known() {
        let gate =
            link(&[("shut", "SUP, X1.z, 2 -> open"), ("open", "CHK, 0; DIM, X2.x -> shut")], stiff(10.0))
                .unwrap();
        assert_eq!(gate.asks_for(), AsksFor { place_on_axis: false, place_in_space: true });
        let mut memory = [0.0; MEMORY];
        gate.begin(1.0, 1.0, &mut memory);
        let mut step = |height: f64, [now, before]: [f64; 2]| {
            let (first, second) = (Vec3::new(0.0, 0.0, height), [Vec3::X * now, Vec3::X * before]);
            let moment = Moment { time: 0.0, places: [[first; 2], second] };
            gate.respond(&Reach { length: 1.5, before: 1.5, rest: 1.0 }, &moment, &mut memory);
            memory[STATE]
        };
        assert_eq!([step(1.9, [0.0; 2]), step(2.1, [0.0; 2])], [0.0, 1.0]);
        assert_eq!([step(1.0, [0.2, 0.1]), step(1.0, [0.1, 0.2])], [1.0, 0.0]);
        let on_axis = link(&[("a", "SUP, X1, 1 -> a")], Values::new()).unwrap();
        assert!(on_axis.asks_for().place_on_axis && !on_axis.asks_for().place_in_space);
    }

    /// In a state that waits for its ends to meet nothing happens from the bound on.
    #[test]
    fn idle_states_are_known() {
        let stop = link(
            &[
                ("away", "CHK, 0; INF, D, 1 -> in; INF, D, 2 -> far"),
                ("in", "CHK, 100; SUP, D, 1 -> away"),
                ("far", ""),
            ],
            Values::new(),
        );
        // what is covered is refused
        assert!(stop.is_err());
        let stop = link(
            &[("away", "CHK, 0; INF, D, 1 -> in"), ("in", "L0=D; CHK, 100; SUP, D, 1 -> away")],
            Values::new(),
        )
        .unwrap();
        let mut memory = [0.0; MEMORY];
        stop.begin(1.5, 1.5, &mut memory);
        assert_eq!(stop.idle_from(&memory), Some(1.0));
        memory[STATE] = 1.0;
        memory[STIFFNESS] = 100.0;
        assert_eq!(stop.idle_from(&memory), None);
    }
}
