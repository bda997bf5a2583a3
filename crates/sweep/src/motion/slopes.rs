//! Slopes of what is measured by states and commands: central differences of the step about a motion.

use std::ops::Range;

use souple_engine::State;

use super::course::{Course, Measured, Trajectory};
use crate::SweepError;

/// Coordinates of a scene that is planned for, positions and velocities, at most: a period is stepped twice for each.
const MOST_COORDINATES: usize = 600;
/// Central differences of a length `ε^(1/3)` of a scale have errors of `ε^(2/3)`.
pub(super) const DIFFERENCE: f64 = 6e-6;
/// What moves less than this share of what moves most beside it is taken to move as much: differences of less would tell rounding.
const STILL: f64 = 1e-3;

/// A number of the state that evolves.
#[derive(Clone, Copy)]
pub(crate) struct Coordinate {
    system: usize,
    point: usize,
    component: usize,
    is_velocity: bool,
}

impl Coordinate {
    pub fn is_velocity(self) -> bool {
        self.is_velocity
    }

    pub fn system(self) -> usize {
        self.system
    }

    pub fn point(self) -> usize {
        self.point
    }

    pub fn component(self) -> usize {
        self.component
    }

    pub fn of(self, state: &State) -> f64 {
        let system = &state.systems[self.system];
        let block = if self.is_velocity { system.v[self.point] } else { system.q[self.point] };
        block[self.component]
    }

    pub fn moved(self, state: &State, by: f64) -> State {
        let mut state = state.clone();
        let system = &mut state.systems[self.system];
        let block = if self.is_velocity { &mut system.v[self.point] } else { &mut system.q[self.point] };
        block[self.component] += by;
        state
    }
}

impl std::fmt::Display for Coordinate {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let of = if self.is_velocity { "velocity" } else { "position" };
        write!(f, "the {} of the {of} of point {}", ["x", "y", "z"][self.component], self.point)
    }
}

/// Steps of differences.
pub(super) struct Differences {
    /// Of each coordinate.
    pub coordinates: Vec<f64>,
    /// [N]
    pub command: f64,
}

impl Course {
    /// In proportion to what moves: each unknown by what its own place and velocity span over the motion, in their own units, what stands still
    /// by what moves most in its system, and where nothing moves yet by how far that reaches.
    pub fn differences(&self, now: &Trajectory) -> Differences {
        let horizon = self.periods as f64 * self.world.model().period;
        let mut scales: Vec<f64> =
            self.coordinates.iter().map(|coordinate| span(*coordinate, &now.states)).collect();
        let mut size: f64 = 0.0;
        for system in 0..self.start.systems.len() {
            let of = |is_velocity: bool| {
                let is_of = move |it: &Coordinate| it.system == system && it.is_velocity == is_velocity;
                self.coordinates.iter().enumerate().filter(move |(_, it)| is_of(it)).map(|(at, _)| at)
            };
            let greatest = |is_velocity: bool| of(is_velocity).map(|at| scales[at]).fold(0.0, f64::max);
            let of_places =
                Some(greatest(false)).filter(|span| *span > 0.0).unwrap_or_else(|| self.reach(system));
            let of_speeds = greatest(true).max(of_places / horizon);
            size = size.max(of_places);
            for (is_velocity, most) in [(false, of_places), (true, of_speeds)] {
                let places: Vec<usize> = of(is_velocity).collect();
                // the three components of an unknown
                for block in places.chunks(3) {
                    let own = block.iter().map(|at| scales[*at]).fold(0.0, f64::max);
                    let own = if own < STILL * most { most } else { own };
                    block.iter().for_each(|at| scales[*at] = own);
                }
            }
        }
        let mass: f64 = self.world.model().systems.iter().flat_map(|system| &system.mass.diagonal).sum();
        let command = now.commands.iter().fold(mass * size / horizon.powi(2), |most, it| most.max(it.abs()));
        Differences {
            coordinates: scales.iter().map(|scale| DIFFERENCE * scale).collect(),
            command: DIFFERENCE * command,
        }
    }

    /// How far the unknowns of a system are apart at the start; one of their unit where it has one alone.
    fn reach(&self, system: usize) -> f64 {
        let places = &self.start.systems[system].q;
        let along = |component: usize| {
            let values = || places.iter().map(move |place| place[component]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        Some((0..3).map(along).fold(0.0, f64::max)).filter(|reach| *reach > 0.0).unwrap_or(1.0)
    }

    /// `dy/dX`, by coordinates.
    pub fn gradient(
        &mut self,
        measured: &Measured,
        state: &State,
        steps: &[f64],
    ) -> Result<Vec<f64>, SweepError> {
        let mut gradient = Vec::with_capacity(self.coordinates.len());
        for (coordinate, by) in self.coordinates.clone().iter().zip(steps) {
            let ahead = self.measure(measured, &coordinate.moved(state, *by))?;
            let behind = self.measure(measured, &coordinate.moved(state, -by))?;
            gradient.push((ahead - behind) / (2.0 * by));
        }
        Ok(gradient)
    }

    /// `∂y_k/∂u` by the commands of some periods, a row for each key; nothing of keys that are not after the first of them.
    pub fn sensitivities(
        &mut self,
        now: &Trajectory,
        window: &Range<usize>,
    ) -> Result<Vec<Vec<f64>>, SweepError> {
        let differences = self.differences(now);
        let (count, all) = (self.controls.len(), self.coordinates.clone());
        let mut rows: Vec<Vec<f64>> = self.keys.iter().map(|_| Vec::new()).collect();
        // of keys that are not before the period: dy/dX at its end
        let mut gradients: Vec<(usize, Vec<f64>)> = Vec::new();
        for period in (window.start..self.periods).rev() {
            for (key, measured) in self.keys_at(period + 1) {
                let gradient = self.gradient(&measured, &now.states[period + 1], &differences.coordinates)?;
                rows[key] = vec![0.0; window.len() * count];
                gradients.push((key, gradient));
            }
            if gradients.is_empty() {
                continue;
            }
            let (state, commands) =
                (&now.states[period], &now.commands[period * count..(period + 1) * count]);
            // Bᵀλ
            for index in (0..count).filter(|_| window.contains(&period)) {
                let by = differences.command;
                let mut beside = |by: f64| {
                    let mut commands = commands.to_vec();
                    commands[index] += by;
                    self.step(state.clone(), &commands)
                };
                let (ahead, behind) = (beside(by)?, beside(-by)?);
                for (key, gradient) in &gradients {
                    rows[*key][(period - window.start) * count + index] =
                        slope(&all, gradient, (&ahead, &behind), by);
                }
            }
            if period == window.start {
                break;
            }
            // Aᵀλ
            let mut earlier: Vec<Vec<f64>> =
                gradients.iter().map(|_| Vec::with_capacity(all.len())).collect();
            for (coordinate, by) in all.iter().zip(&differences.coordinates) {
                let ahead = self.step(coordinate.moved(state, *by), commands)?;
                let behind = self.step(coordinate.moved(state, -by), commands)?;
                for ((_, gradient), earlier) in gradients.iter().zip(&mut earlier) {
                    earlier.push(slope(&all, gradient, (&ahead, &behind), *by));
                }
            }
            gradients.iter_mut().zip(earlier).for_each(|((_, gradient), earlier)| *gradient = earlier);
        }
        Ok(rows)
    }
}

/// From the least to the greatest of a number over a motion.
pub(super) fn span(coordinate: Coordinate, states: &[State]) -> f64 {
    let values = || states.iter().map(|state| coordinate.of(state));
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

/// `λ · (X₊ − X₋)/2ε`
fn slope(all: &[Coordinate], gradient: &[f64], (ahead, behind): (&State, &State), by: f64) -> f64 {
    let change = |coordinate: &Coordinate| coordinate.of(ahead) - coordinate.of(behind);
    all.iter().zip(gradient).map(|(coordinate, gradient)| gradient * change(coordinate)).sum::<f64>()
        / (2.0 * by)
}

pub(crate) fn coordinates(state: &State) -> Result<Vec<Coordinate>, SweepError> {
    let mut all = Vec::new();
    for (index, system) in state.systems.iter().enumerate() {
        if system.q.len() != system.v.len() {
            let expected = "a scene of points, without rigid frames";
            return Err(SweepError::value("scene", "of frames that turn", expected));
        }
        for point in 0..system.q.len() {
            for component in 0..3 {
                let coordinate = |is_velocity| Coordinate { system: index, point, component, is_velocity };
                all.extend([false, true].map(coordinate));
            }
        }
    }
    if all.len() > MOST_COORDINATES {
        let found = format!("of {} coordinates", all.len());
        let expected = format!(
            "at most {MOST_COORDINATES}: positions and velocities of {} points",
            MOST_COORDINATES / 6
        );
        return Err(SweepError::value("scene", found, expected));
    }
    Ok(all)
}
