//! Changes made while a world runs: recorded commands between steps, so that replay repeats them.

use std::ops::Range;

use souple_math::Vec3;

use crate::constraint::Constraint;
use crate::detection::Detected;
use crate::force::{Force, ParameterError};
use crate::hand::{Grip, GripError, Hand, check_place, hand_name};
use crate::state::{State, SystemState};
use crate::system::System;
use crate::tool::Tool;
use crate::world::Model;

/// One change.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Sets a parameter of a force (see [`crate::Force::set_parameter`]).
    SetParameter { system: usize, force: String, parameter: String, value: f64 },
    /// Pins a velocity block where it is.
    Pin { system: usize, block: u32 },
    /// Pins a velocity block at a position [m] (of a point: blocks of frames are held as they are). What
    /// [`Edit::Pin`] comes to once it has been made: it means the same at any later state.
    PinAt { system: usize, block: u32, position: Vec3 },
    /// Frees a block from every constraint on it.
    Unpin { system: usize, block: u32 },
    /// Gives a velocity block a velocity [m/s or rad/s].
    SetVelocity { system: usize, block: u32, velocity: Vec3 },
    /// Adds a velocity to that of some velocity blocks [m/s or rad/s].
    Push { system: usize, blocks: Range<u32>, velocity: Vec3 },
    /// Takes hold of points (see [`Hand`]); a hand that held something lets go of it.
    Grab { system: usize, hand: u32, grip: Grip },
    /// Takes a tool (see [`Tool`]); a hand that held something lets go of it.
    Touch { system: usize, hand: u32, tool: Tool },
    /// Leads a hand, or the tool in it, to a place [m].
    MoveHand { system: usize, hand: u32, place: Vec3 },
    /// Leads the device of a hand of the scene to where it is at the end of the period, from where it started [m].
    Lead { system: usize, force: String, place: Vec3 },
    /// Lets go.
    Release { system: usize, hand: u32 },
}

/// An edit and the period before which it was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    pub period: u64,
    pub edit: Edit,
}

/// Why an edit was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    #[error("there is no system {system}; the world has {count}")]
    NoSystem { system: usize, count: usize },
    #[error("system `{system}` has no force `{force}`; it has: {}", .known.join(", "))]
    NoForce { system: String, force: String, known: Vec<String> },
    #[error("system `{system}` has no velocity block {block}; it has {count}")]
    NoBlock { system: String, block: u32, count: usize },
    #[error("a velocity of {velocity:?} is not finite")]
    NotFinite { velocity: [f64; 3] },
    #[error("a pin at {position:?} is not at a finite place")]
    PinNotFinite { position: [f64; 3] },
    #[error("hand {hand} holds nothing in system `{system}`; it must grab first")]
    NoHand { system: String, hand: u32 },
    #[error("`{stepper}` cannot step system `{system}` with this: {why}")]
    Refused { system: String, stepper: &'static str, why: String },
    #[error("a tool in hand {hand}: {why}")]
    Tool { hand: u32, why: String },
    #[error(transparent)]
    Grip(#[from] GripError),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

impl Edit {
    /// Whether forces, their tangents or constraints are others afterwards, and not only where things are or go.
    pub fn changes_forces(&self, model: &Model) -> bool {
        match self {
            Self::MoveHand { .. } | Self::Lead { .. } | Self::SetVelocity { .. } | Self::Push { .. } => false,
            Self::SetParameter { system, force, parameter, .. } => {
                let mut forces = model.systems.get(*system).into_iter().flat_map(|system| &system.forces);
                !forces.any(|one| one.name() == force && one.is_effort(parameter))
            }
            _ => true,
        }
    }

    fn system(&self) -> usize {
        match self {
            Self::SetParameter { system, .. }
            | Self::Pin { system, .. }
            | Self::PinAt { system, .. }
            | Self::Unpin { system, .. }
            | Self::SetVelocity { system, .. }
            | Self::Push { system, .. }
            | Self::Grab { system, .. }
            | Self::Touch { system, .. }
            | Self::MoveHand { system, .. }
            | Self::Lead { system, .. }
            | Self::Release { system, .. } => *system,
        }
    }

    /// The same edit said so that it does not depend on the state it is made at.
    pub(crate) fn resolved(self, model: &Model, state: &State) -> Self {
        let Self::Pin { system, block } = self else { return self };
        let place = || {
            let row = model.systems.get(system)?.kinematics.point_block_row(block)?;
            state.systems.get(system)?.q.get(row as usize).copied()
        };
        Self::PinAt { system, block, position: place().unwrap_or(Vec3::ZERO) }
    }

    pub(crate) fn apply(&self, model: &mut Model, state: &mut State) -> Result<(), EditError> {
        let changes_forces = self.changes_forces(model);
        let (index, count) = (self.system(), model.systems.len());
        let system = model.systems.get_mut(index).ok_or(EditError::NoSystem { system: index, count })?;
        let time = state.period as f64 * model.period;
        let state = &mut state.systems[index];
        let check_block = |block: u32| {
            let count = state.v.len();
            let error = EditError::NoBlock { system: system.name.clone(), block, count };
            if (block as usize) < count { Ok(()) } else { Err(error) }
        };
        match self {
            Self::SetParameter { force: name, parameter, value, .. } => {
                force_named(system, name)?.set_parameter(parameter, *value)?;
                // a thickness decides how far is looked
                if changes_forces {
                    state.detected = Detected::default();
                }
            }
            Self::Pin { block, .. } => {
                check_block(*block)?;
                let row = system.kinematics.point_block_row(*block);
                let start = row.map_or(Vec3::ZERO, |row| state.q[row as usize]);
                system.constraints.retain(|constraint| constraint.block != *block);
                system.constraints.push(Constraint::pin(*block, start));
                state.v[*block as usize] = Vec3::ZERO;
            }
            Self::PinAt { block, position, .. } => {
                check_block(*block)?;
                if !position.is_finite() {
                    return Err(EditError::PinNotFinite { position: position.to_array() });
                }
                system.constraints.retain(|constraint| constraint.block != *block);
                system.constraints.push(Constraint::pin(*block, *position));
                if let Some(row) = system.kinematics.point_block_row(*block) {
                    state.q[row as usize] = *position;
                }
                state.v[*block as usize] = Vec3::ZERO;
            }
            Self::Unpin { block, .. } => {
                check_block(*block)?;
                system.constraints.retain(|constraint| constraint.block != *block);
            }
            Self::SetVelocity { block, velocity, .. } => {
                check_block(*block)?;
                if !velocity.is_finite() {
                    return Err(EditError::NotFinite { velocity: velocity.to_array() });
                }
                state.v[*block as usize] = *velocity;
            }
            Self::Push { blocks, velocity, .. } => {
                check_block(blocks.end.saturating_sub(1))?;
                if !velocity.is_finite() {
                    return Err(EditError::NotFinite { velocity: velocity.to_array() });
                }
                let pushed = blocks.start.min(blocks.end) as usize..blocks.end as usize;
                state.v[pushed].iter_mut().for_each(|v| *v += *velocity);
                // what is held stays
                system.impose_constraints(&mut state.q, &mut state.v, time, 1.0);
            }
            Self::Grab { hand, grip, .. } => {
                grip.check(system.kinematics.row_count())?;
                take(system, state, *hand, Box::new(Hand::new(*hand, grip.clone())))?;
            }
            Self::Touch { hand, tool, .. } => {
                let why = |why| EditError::Tool { hand: *hand, why };
                tool.check(system.kinematics.row_count()).map_err(why)?;
                let toolbox = model.toolbox.as_ref().ok_or_else(|| why("this world has none".to_owned()))?;
                let force = toolbox.make(hand_name(*hand), tool).map_err(why)?;
                take(system, state, *hand, force)?;
            }
            Self::MoveHand { hand, place, .. } => {
                check_place("place", *place)?;
                let force = find_hand(system, *hand)?;
                system.forces[force].lead(*place);
            }
            Self::Lead { force, place, .. } => {
                check_place("place", *place)?;
                force_named(system, force)?.lead(*place);
            }
            Self::Release { hand, .. } => {
                let force = find_hand(system, *hand)?;
                release(system, state, force);
            }
        }
        Ok(())
    }
}

fn force_named<'s>(system: &'s mut System, name: &str) -> Result<&'s mut Box<dyn Force>, EditError> {
    let known = || system.forces.iter().map(|force| force.name().to_owned()).collect();
    let error = EditError::NoForce { system: system.name.clone(), force: name.to_owned(), known: known() };
    system.forces.iter_mut().find(|force| force.name() == name).ok_or(error)
}

/// Adds the force of a hand or tool. Hands come after all other forces: those keep their numbers, which pairs hold.
fn take(
    system: &mut System,
    state: &mut SystemState,
    hand: u32,
    force: Box<dyn Force>,
) -> Result<(), EditError> {
    let held = find_hand(system, hand).ok();
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    system.forces.push(force);
    if let Some(why) = system.stepper.refuses(system) {
        system.forces.pop();
        let (system, stepper) = (system.name.clone(), system.stepper.name());
        return Err(EditError::Refused { system, stepper, why });
    }
    state.memory.extend(memory);
    // of forces as they were
    state.detected = Detected::default();
    if let Some(held) = held {
        release(system, state, held);
    }
    Ok(())
}

/// Takes a force away, with its memory and its pairs.
fn release(system: &mut System, state: &mut SystemState, force: usize) {
    let range = system.memory_range(force);
    state.memory.drain(range);
    state.detected = Detected::default();
    system.forces.remove(force);
    let number = force as u64;
    state.pairs.retain(|pair| pair.force != number);
    // those after it have moved up
    state.pairs.iter_mut().filter(|pair| pair.force > number).for_each(|pair| pair.force -= 1);
}

/// The number of the force of a hand.
fn find_hand(system: &System, hand: u32) -> Result<usize, EditError> {
    let name = hand_name(hand);
    let found = system.forces.iter().rposition(|force| force.name() == name);
    found.ok_or_else(|| EditError::NoHand { system: system.name.clone(), hand })
}
