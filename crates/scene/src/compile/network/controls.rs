//! Controls of networks: what they read, and where forces find what they say.

use std::ops::Range;

use souple_engine::{CONTROL_LEN, CommittedRows, Control};
use souple_formal::{Condition, Formula};
use souple_math::Vec3;
use souple_models::network::{LinkKernel, REGISTERS, Wiring};

use super::super::Draft;
use super::super::bodies::Placed;
use crate::diagnostic::Code;
use crate::keys::one_of;
use crate::spec::Spec;
use crate::spec::control::{ControlSpec, Drives, INPUTS, InputSpec, VARIABLES};
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

/// What controls drive of the links of a table of this name.
pub fn wiring(draft: &Draft, body: &Placed, network: &Network, name: &str, law: &dyn LinkKernel) -> Wiring {
    let mut wiring = Wiring::default();
    if name.is_empty() {
        return wiring;
    }
    let first = first_driven(draft.spec, body);
    let controls = network.controls.iter().enumerate().filter(|(_, control)| control.links == name);
    for (index, control) in controls {
        let (slot, log) = (first + index * CONTROL_LEN, draft.log);
        let refuse =
            |message: String, expected: String| log.add(Code::Conflict, &control.site, message, expected);
        match &control.drives {
            Some(Drives::Connection { .. }) if wiring.gain.is_some() => {
                let message = format!("two controls connect the links `{name}`");
                refuse(message, "one condition, joined with `and` or `or`".to_owned());
            }
            Some(Drives::Connection { .. }) => wiring.gain = Some(slot),
            Some(Drives::Parameter { name: parameter, .. }) => {
                let known = law.registers();
                match known.iter().position(|known| known == parameter) {
                    None => {
                        let message =
                            format!("the law of the links `{name}` has no `{parameter}` that can be driven");
                        let expected = match &known[..] {
                            [] => "`connects`, which works on any law, or a law whose numbers can be driven: `spring_damper`, `ball`, \
                                   or a `formula` with `parameters`"
                                .to_owned(),
                            known => one_of(known),
                        };
                        refuse(message, expected);
                    }
                    Some(register) if wiring.registers.iter().any(|(other, _)| *other == register) => {
                        refuse(
                            format!("two controls turn `{parameter}` of the links `{name}`"),
                            "one".to_owned(),
                        );
                    }
                    Some(_) if wiring.registers.len() == REGISTERS => {
                        refuse(
                            format!("{} parameters are driven", REGISTERS + 1),
                            format!("at most {REGISTERS}"),
                        );
                    }
                    Some(register) => wiring.registers.push((register, slot)),
                }
            }
            None => {}
        }
    }
    wiring
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
    let is_driven = |index: &usize| network.links[body.links[*index].table].name == spec.links;
    let tables: Vec<usize> = (0..body.links.len()).filter(is_driven).collect();
    if tables.is_empty() {
        let named = network.links.iter().map(|table| table.name.as_str()).filter(|name| !name.is_empty());
        let known: Vec<&str> = named.collect();
        let message = format!("there are no links `{}`", spec.links);
        draft.log.add(
            Code::UnknownName,
            &spec.site,
            message,
            format!("the `name` of links: {}", one_of(&known)),
        );
        return None;
    }
    let inputs: Vec<Input> =
        spec.inputs.iter().filter_map(|input| Input::new(draft, body, network, input)).collect();
    let (rule, start) = match spec.drives.as_ref()? {
        Drives::Connection { holds, ramp } => (Rule::Connection { holds: holds.clone(), ramp: *ramp }, 1.0),
        Drives::Parameter { name, value } => {
            let law = network.links[body.links[tables[0]].table].law.as_ref()?;
            let start = match law.values.get(name) {
                Some(souple_table::Value::Number(number)) => number,
                // a parameter of a written law: from the first value on
                _ => f64::NAN,
            };
            (Rule::Parameter(value.clone()), start)
        }
    };
    let name = format!("{}.{}", body.spec.name, spec.name);
    let forces = tables.iter().map(|index| format!("{}.links[{index}]", body.spec.name)).collect();
    let control = Written { name, system: body.system, forces, driven, rule, inputs };
    let start = if start.is_finite() { start } else { control.first(&body.mesh.points, body.rows.start) };
    if !start.is_finite() {
        let message = format!("control `{}` gives {start} at the start", spec.name);
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
    Connection { holds: Condition, ramp: f64 },
    Parameter(Formula),
}

struct Input {
    of: Range<usize>,
    to: Range<usize>,
    quantity: &'static str,
    component: usize,
}

impl Input {
    fn new(draft: &Draft, body: &Placed, network: &Network, spec: &InputSpec) -> Option<Self> {
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

    fn read(&self, positions: &[Vec3], velocities: &[Vec3]) -> f64 {
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
    fn first(&self, points: &[Vec3], first: usize) -> f64 {
        let rows: Vec<Vec3> = std::iter::repeat_n(Vec3::ZERO, first).chain(points.iter().copied()).collect();
        let still = vec![Vec3::ZERO; rows.len()];
        self.decide((0.0, 0.0), (&rows, &still), 0.0)
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
