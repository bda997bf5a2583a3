//! Controls of networks: what they read, and where forces find what they say.

use std::ops::Range;

use souple_engine::{CONTROL_LEN, CommittedRows, Control, Force};
use souple_formal::{Condition, Formula};
use souple_math::Vec3;
use souple_models::network::{
    Actuator, BuildLink, DRIVEN_PARAMETERS, DrivenLaw, LinkKernel, Recipe, Span, Wiring,
};

use super::super::Draft;
use super::super::bodies::Placed;
use super::plan::{self, Plan};
use super::table::{self, NumberOfMass, StateSpace, Table};
use crate::diagnostic::Code;
use crate::keys::one_of;
use crate::reader::Chosen;
use crate::spec::Spec;
use crate::spec::control::{ControlSpec, Driven, Drives, INPUTS, InputSpec, STATES, VARIABLES};
use crate::spec::network::Network;

/// Numbers that all controls of a scene keep in State.
pub fn driven_len(spec: &Spec) -> usize {
    CONTROL_LEN
        * spec.bodies.iter().filter_map(|body| body.network.as_ref()).map(|n| n.controls.len()).sum::<usize>()
}

/// Where the numbers of a body's controls start.
fn first_driven(spec: &Spec, body: &Placed) -> usize {
    let before = spec.bodies.iter().take_while(|other| other.name != body.spec.name);
    CONTROL_LEN * before.filter_map(|body| body.network.as_ref()).map(|n| n.controls.len()).sum::<usize>()
}

/// Names of the parameters that controls drive of the law of links or crowds.
pub fn driven_parameters(network: &Network, of: &Driven<&str>) -> Vec<String> {
    let of_control = |control: &ControlSpec| match &control.drives {
        Some(Drives::Parameter { name, .. }) => Some(name.clone()),
        _ => None,
    };
    network.controls.iter().filter(|control| control.of.is(of)).filter_map(of_control).collect()
}

/// A law as controls drive it, of links or crowds.
pub fn driven(
    draft: &Draft,
    body: &Placed,
    network: &Network,
    of: Driven<&str>,
    (law, chosen): (Box<dyn LinkKernel>, Option<&Chosen<BuildLink>>),
    (timestep, span): (f64, Span),
) -> DrivenLaw {
    let Some(chosen) = chosen.filter(|_| network.controls.iter().any(|control| control.of.is(&of))) else {
        return law.into();
    };
    let recipe = Recipe { entry: chosen.entry, values: chosen.values.clone(), timestep, span };
    let wiring = wiring(draft, body, network, &of, &recipe.drivable(&*law));
    DrivenLaw::new(law, recipe, &wiring)
}

/// What controls drive of a law with these numbers.
fn wiring(draft: &Draft, body: &Placed, network: &Network, of: &Driven<&str>, drivable: &[String]) -> Wiring {
    let mut wiring = Wiring::default();
    let (first, noun, name) = (first_driven(draft.spec, body), of.noun(), of.name());
    for (index, control) in network.controls.iter().enumerate().filter(|(_, control)| control.of.is(of)) {
        let (slot, log) = (first + index * CONTROL_LEN, draft.log);
        let refuse =
            |message: String, expected: String| log.add(Code::Conflict, &control.site, message, expected);
        match &control.drives {
            Some(Drives::Connection { .. }) if wiring.gain.is_some() => {
                let message = format!("two controls connect the {noun} `{name}`");
                refuse(message, "one condition, joined with `and` or `or`".to_owned());
            }
            Some(Drives::Connection { .. }) => wiring.gain = Some(slot),
            Some(Drives::Parameter { name: parameter, .. }) => {
                if !drivable.contains(parameter) {
                    let message =
                        format!("the law of the {noun} `{name}` has no `{parameter}` that can be driven");
                    let known: Vec<&str> = drivable.iter().map(String::as_str).collect();
                    let expected = match &known[..] {
                        [] => "`connects`, which works on any law: this one has no numbers".to_owned(),
                        known => one_of(known),
                    };
                    refuse(message, expected);
                } else if wiring.parameters.iter().any(|(other, _)| other == parameter) {
                    refuse(
                        format!("two controls turn `{parameter}` of the {noun} `{name}`"),
                        "one".to_owned(),
                    );
                } else if wiring.parameters.len() == DRIVEN_PARAMETERS {
                    refuse(
                        format!("{} parameters are driven", DRIVEN_PARAMETERS + 1),
                        format!("at most {DRIVEN_PARAMETERS}"),
                    );
                } else {
                    wiring.parameters.push((parameter.clone(), slot));
                }
            }
            Some(Drives::Command(_) | Drives::Plan { .. } | Drives::Table { .. }) | None => {}
        }
    }
    wiring
}

/// A force for each actuator of a network that a control commands; what commands none or several is refused.
pub fn add_actuators(draft: &Draft, body: &Placed, network: &Network, forces: &mut Vec<Box<dyn Force>>) {
    let first = first_driven(draft.spec, body);
    for actuator in &network.actuators {
        let refuse = |code: Code, message: String, expected: &str| {
            draft.log.add(code, &actuator.site, message, expected);
        };
        let is_of = |control: &ControlSpec| control.of.is(&Driven::Actuator(actuator.name.as_str()));
        let mut commands = (0..network.controls.len()).filter(|index| is_of(&network.controls[*index]));
        let (Some(index), None) = (commands.next(), commands.next()) else {
            let message = format!("actuator `{}` is not commanded by one control", actuator.name);
            refuse(
                Code::Conflict,
                message,
                "a table under `controls` with its name as `actuator`, and no second one",
            );
            continue;
        };
        let masses = network.numbers_of(&actuator.of).filter(|numbers| !numbers.is_empty());
        let Some(masses) = masses.filter(|numbers| numbers.end as usize <= body.mesh.points.len()) else {
            let known: Vec<&str> = network.masses.iter().map(|group| group.name.as_str()).collect();
            let message = format!("there is no group of masses `{}`", actuator.of);
            refuse(Code::UnknownName, message, &one_of(&known));
            continue;
        };
        let base = body.rows.start as u32;
        forces.push(Box::new(Actuator::new(
            actuator_force(body, &actuator.name),
            base + masses.start..base + masses.end,
            actuator.direction,
            first + index * CONTROL_LEN,
        )));
    }
}

/// The name of the force of an actuator.
fn actuator_force(body: &Placed, name: &str) -> String {
    format!("{}.actuators.{name}", body.spec.name)
}

/// Gives the model its controls, and State the values that they start from.
pub fn add(draft: &mut Draft) {
    draft.state.driven = vec![0.0; driven_len(draft.spec)];
    let mut controls: Vec<Box<dyn Control>> = Vec::new();
    for body in &draft.bodies {
        let Some(network) = &body.spec.network else { continue };
        let first = first_driven(draft.spec, body);
        for (index, spec) in network.controls.iter().enumerate() {
            let driven = first + index * CONTROL_LEN;
            if let Some((control, start)) = control(draft, body, network, spec, driven) {
                draft.state.driven[driven] = start;
                controls.push(Box::new(control));
            }
        }
    }
    draft.model.controls = controls;
}

/// A control and the value that it starts from: what the scene says without it.
fn control(
    draft: &Draft,
    body: &Placed,
    network: &Network,
    spec: &ControlSpec,
    driven: usize,
) -> Option<(Written, f64)> {
    let laws: Vec<(String, &Option<Chosen<BuildLink>>)> = match &spec.of {
        Driven::Actuator(name) => (network.actuators.iter())
            .filter(|actuator| actuator.name == *name)
            .map(|_| (actuator_force(body, name), &None))
            .collect(),
        Driven::Links(name) => (body.links.iter().enumerate())
            .map(|(index, links)| (index, &network.links[links.table]))
            .filter(|(_, table)| !name.is_empty() && table.name == *name)
            .map(|(index, table)| (format!("{}.links[{index}]", body.spec.name), &table.law))
            .collect(),
        Driven::Crowds(name) => (network.crowds.iter().enumerate())
            .filter(|(_, crowd)| !name.is_empty() && crowd.name == *name)
            .map(|(index, crowd)| (crowd.force_name(&body.spec.name, index), &crowd.law))
            .collect(),
    };
    if laws.is_empty() {
        let (noun, name) = (spec.of.noun(), spec.of.name());
        let named = match &spec.of {
            Driven::Links(_) => network.links.iter().map(|table| table.name.as_str()).collect::<Vec<_>>(),
            Driven::Crowds(_) => network.crowds.iter().map(|crowd| crowd.name.as_str()).collect(),
            Driven::Actuator(_) => network.actuators.iter().map(|actuator| actuator.name.as_str()).collect(),
        };
        let known: Vec<&str> = named.into_iter().filter(|name| !name.is_empty()).collect();
        // what is not named at all is said where it is read
        if !name.is_empty() {
            draft.log.add(
                Code::UnknownName,
                &spec.site,
                format!("there are no {noun} `{name}`"),
                format!("the `name` of {noun}: {}", one_of(&known)),
            );
        }
        return None;
    }
    let inputs: Vec<Input> =
        spec.inputs.iter().filter_map(|input| Input::new(draft, body, network, input)).collect();
    let (rule, start) = match spec.drives.as_ref()? {
        Drives::Connection { holds, ramp } => (Rule::Connection { holds: holds.clone(), ramp: *ramp }, 1.0),
        Drives::Parameter { name, value } => {
            let law = laws[0].1.as_ref()?;
            let (entry, values) = (law.entry, law.values.clone());
            let recipe = Recipe { entry, values, timestep: 1.0, span: Span::Distance };
            // what is no number of the law is said where it is wired
            (Rule::Parameter(value.clone()), recipe.written(name).unwrap_or(0.0))
        }
        Drives::Command(value) => {
            (Rule::Command { value: value.clone(), largest: network.largest(spec.of.name()) }, 0.0)
        }
        Drives::Plan { file, site, feedback } => {
            let name = format!("{}.{}", body.spec.name, spec.name);
            let plan = plan::read(draft, body, (site, file), &name, *feedback)?;
            (Rule::Plan { plan, largest: network.largest(spec.of.name()) }, 0.0)
        }
        Drives::Table { file: None, .. } => (Rule::Parameter(Formula::constant(0.0)), 0.0),
        Drives::Table { file: Some((file, site)), lookup, .. } => {
            let space = StateSpace::of(draft, body, network, spec)?;
            let names: Vec<&str> = space.names().collect();
            let table = table::read(draft, (site, file), &space.control, (&names, *lookup))?;
            (Rule::Table { space, table, largest: network.largest(spec.of.name()) }, 0.0)
        }
    };
    let name = format!("{}.{}", body.spec.name, spec.name);
    let forces = laws.into_iter().map(|(force, _)| force).collect();
    let control = Written { name, system: body.system, forces, driven, rule, inputs };
    let first = control.first(start, &body.mesh.points, body.rows.start);
    if !first.is_finite() {
        let message = format!("control `{}` gives {first} at the start", spec.name);
        draft.log.add(Code::NotFinite, &spec.site, message, "a formula that is finite at the start");
    }
    Some((control, start))
}

/// A control as formulas.
struct Written {
    name: String,
    system: usize,
    forces: Vec<String>,
    driven: usize,
    rule: Rule,
    inputs: Vec<Input>,
}

enum Rule {
    Connection {
        holds: Condition,
        ramp: f64,
    },
    Parameter(Formula),
    /// Of an actuator, whose magnitude is at most `largest` [N].
    Command {
        value: Formula,
        largest: f64,
    },
    /// The same, of each period.
    Plan {
        plan: Plan,
        largest: f64,
    },
    /// The same, of each state.
    Table {
        space: StateSpace,
        table: Table,
        largest: f64,
    },
}

/// What a control reads of masses.
#[derive(Clone, Debug)]
pub struct Input {
    of: Range<usize>,
    to: Range<usize>,
    quantity: &'static str,
    component: usize,
}

impl Input {
    pub fn new(draft: &Draft, body: &Placed, network: &Network, spec: &InputSpec) -> Option<Self> {
        let rows = |name: &str| {
            let Some(numbers) = network.numbers_of(name) else {
                let known: Vec<&str> = network.masses.iter().map(|group| group.name.as_str()).collect();
                let message = format!("there is no group of masses `{name}`");
                draft.log.add(Code::UnknownName, &spec.site, message, one_of(&known));
                return None;
            };
            Some(body.rows.start + numbers.start as usize..body.rows.start + numbers.end as usize)
        };
        let to = if spec.to.is_empty() { 0..0 } else { rows(&spec.to)? };
        Some(Self {
            of: rows(&spec.of)?,
            to,
            quantity: spec.quantity,
            component: spec.component.unwrap_or(0),
        })
    }

    /// The place or the velocity of one mass along an axis, where it is that.
    pub fn number_of_mass(&self) -> Option<NumberOfMass> {
        let is_velocity = self.quantity == "velocity";
        let is_one = self.of.len() == 1 && (is_velocity || self.quantity == "position");
        is_one.then_some(NumberOfMass { row: self.of.start, component: self.component, is_velocity })
    }

    pub fn read(&self, positions: &[Vec3], velocities: &[Vec3]) -> f64 {
        match self.quantity {
            "velocity" => mean(velocities, &self.of)[self.component],
            "speed" => mean(velocities, &self.of).length(),
            "distance" => (mean(positions, &self.of) - mean(positions, &self.to)).length(),
            _ => mean(positions, &self.of)[self.component],
        }
    }
}

fn mean(values: &[Vec3], rows: &Range<usize>) -> Vec3 {
    values[rows.clone()].iter().copied().sum::<Vec3>() * (1.0 / rows.len().max(1) as f64)
}

impl Written {
    /// Its value at the start, of masses at rest at `points`, which are rows from `first` on.
    fn first(&self, before: f64, points: &[Vec3], first: usize) -> f64 {
        let rows: Vec<Vec3> = std::iter::repeat_n(Vec3::ZERO, first).chain(points.iter().copied()).collect();
        let still = vec![Vec3::ZERO; rows.len()];
        self.decide((0.0, 0.0), (&rows, &still), before)
    }

    fn decide(
        &self,
        (time, period): (f64, f64),
        (positions, velocities): (&[Vec3], &[Vec3]),
        before: f64,
    ) -> f64 {
        let mut values = [0.0; VARIABLES.len() + INPUTS];
        (values[0], values[1]) = (time, before);
        for (value, input) in values[VARIABLES.len()..].iter_mut().zip(&self.inputs) {
            *value = input.read(positions, velocities);
        }
        match &self.rule {
            Rule::Parameter(value) => value.evaluate(&values),
            Rule::Plan { plan, largest } => {
                // without a period at the start
                let number = if period > 0.0 { (time / period).round() as usize } else { 0 };
                plan.command(number, positions, velocities).clamp(-largest, *largest)
            }
            Rule::Table { space, table, largest } => {
                let mut state = [0.0; STATES];
                space.read(positions, velocities, &mut state);
                table.command(&state).clamp(-largest, *largest)
            }
            Rule::Command { value, largest } => value.evaluate(&values).clamp(-largest, *largest),
            Rule::Connection { holds, ramp } => {
                let to = f64::from(u8::from(holds.holds(&values)));
                let most = if *ramp > 0.0 { period / ramp } else { 1.0 };
                before + (to - before).clamp(-most, most)
            }
        }
    }
}

impl Control for Written {
    fn name(&self) -> &str {
        &self.name
    }

    fn system(&self) -> usize {
        self.system
    }

    fn forces(&self) -> &[String] {
        &self.forces
    }

    fn driven(&self) -> usize {
        self.driven
    }

    fn value(&self, time: f64, period: f64, rows: CommittedRows, before: f64) -> f64 {
        let rows = rows.of(self.system);
        self.decide((time, period), (&rows.positions, &rows.velocities), before)
    }
}
