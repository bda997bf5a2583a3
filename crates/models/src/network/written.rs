//! Laws that a scene writes: evaluated link by link, with as much memory as they like up to a bound.

use std::fmt::Debug;

use souple_formal::{Formula, parse_quantity};
use souple_math::Vec3;

use super::kernel::{LinkKernel, Moving};
use super::law::{LinkError, Reach, Response};
use super::layout::{LANES, Part};

/// Most numbers that a written law remembers of a link.
pub const WRITTEN_MEMORY: usize = 16;

/// A law whose text is read when the scene is.
pub trait WrittenLaw: Debug + Send + Sync + 'static {
    /// At most [`WRITTEN_MEMORY`].
    fn memory_len(&self) -> usize;
    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]);
    fn is_conservative(&self) -> bool;
    /// `memory` becomes that of the next step.
    fn respond(&self, reach: &Reach, time: f64, memory: &mut [f64]) -> Response;
    /// `∂φ/∂D` and `∂φ/∂D^r` [N/m].
    fn slopes(&self, reach: &Reach, time: f64, memory: &[f64]) -> [f64; 2];
    /// See [`super::LinkLaw::stiffest`]; of a link of this rest length.
    fn stiffest(&self, rest: f64) -> f64;
}

/// [`LinkKernel`] of a written law.
#[derive(Debug)]
pub struct OneByOne<L>(pub L);

impl<L: WrittenLaw> OneByOne<L> {
    /// Calls `each(block, lane, force on the first end, response, memory of the next step)` for every link.
    fn for_each(
        &self,
        part: &Part,
        moving: Moving,
        memory: &[f64],
        mut each: impl FnMut(usize, usize, Vec3, Response, &[f64]),
    ) {
        let len = self.0.memory_len();
        let mut numbers = [0.0; WRITTEN_MEMORY];
        for slot in 0..part.links.len() {
            let (block, lane) = part.place(slot);
            let [a, b] = part.ends_of(slot).map(|row| row as usize);
            let d = moving.positions[a] - moving.positions[b];
            let e = d - (moving.velocities[a] - moving.velocities[b]) * moving.timestep;
            let reach = Reach { length: d.length(), before: e.length(), rest: part.rest(block)[lane] };
            for i in 0..len {
                numbers[i] = memory[(block * len + i) * LANES + lane];
            }
            let response = self.0.respond(&reach, moving.time, &mut numbers[..len]);
            let direction = d.try_normalised().or(e.try_normalised()).unwrap_or(Vec3::ZERO);
            each(block, lane, direction * response.push, response, &numbers[..len]);
        }
    }
}

impl<L: WrittenLaw> LinkKernel for OneByOne<L> {
    fn memory_len(&self) -> usize {
        self.0.memory_len()
    }

    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        self.0.begin(rest, length, memory);
    }

    fn is_conservative(&self) -> bool {
        self.0.is_conservative()
    }

    fn stiffest(&self, rest: f64) -> f64 {
        self.0.stiffest(rest)
    }

    fn add_forces(&self, part: &Part, moving: Moving, memory: &[f64], sums: &mut [Vec3]) {
        let first = part.first_row;
        let mut slot = 0;
        self.for_each(part, moving, memory, |_, _, force, _, _| {
            let [a, b] = part.ends_of(slot).map(|row| row as usize - first);
            sums[a] += force;
            sums[b] -= force;
            slot += 1;
        });
    }

    fn forces(&self, part: &Part, moving: Moving, memory: &[f64], out: &mut [Vec3]) {
        self.for_each(part, moving, memory, |block, lane, force, _, _| out[block * LANES + lane] = force);
    }

    fn advance(&self, part: &Part, moving: Moving, memory: &mut [f64]) -> f64 {
        let (len, before) = (self.0.memory_len(), memory.to_vec());
        let mut heat = 0.0;
        self.for_each(part, moving, &before, |block, lane, _, response, numbers| {
            heat += response.heat;
            for (i, number) in numbers.iter().enumerate() {
                memory[(block * len + i) * LANES + lane] = *number;
            }
        });
        heat
    }

    fn respond(&self, reach: &Reach, time: f64, memory: &[f64]) -> Response {
        let mut numbers = [0.0; WRITTEN_MEMORY];
        let len = self.0.memory_len();
        numbers[..len].copy_from_slice(&memory[..len]);
        self.0.respond(reach, time, &mut numbers[..len])
    }

    fn slopes(&self, reach: &Reach, time: f64, memory: &[f64]) -> [f64; 2] {
        self.0.slopes(reach, time, &memory[..self.0.memory_len()])
    }
}

/// Numbers under names, in SI units, that formulas may refer to.
pub fn constants(texts: &[(String, String)]) -> Result<(Vec<&str>, Vec<f64>), LinkError> {
    let mut values = Vec::with_capacity(texts.len());
    for (name, text) in texts {
        let place = || format!("parameters.{name}");
        let value = match parse_quantity(text) {
            Ok(quantity) => quantity.value,
            Err(_) => formula(&place(), text, &[])?.evaluate(&[]),
        };
        if !value.is_finite() {
            return Err(LinkError::Text {
                place: place(),
                what: format!("is {value}: give a finite number"),
            });
        }
        values.push(value);
    }
    Ok((texts.iter().map(|(name, _)| name.as_str()).collect(), values))
}

/// Reads a formula of `variables`.
pub fn formula(place: &str, text: &str, variables: &[&str]) -> Result<Formula, LinkError> {
    Formula::compile(text, variables).map_err(|error| LinkError::Formula { place: place.to_owned(), error })
}
