//! What pushes on a shape that rows bear: the opposite comes to these rows a step later, with its momentum and its moment.
//!
//! Forces are shared among the rows around a touch, which are not where it is. What that changes of their moment, and what
//! rows move in a step, is made good by the forces of a rotation of all rows.

use souple_engine::Configuration;
use souple_math::{Vec3, couple};

use super::Shape;

/// A force on a point of a body, in the world.
pub struct Push {
    pub force: Vec3,
    pub at: Vec3,
    /// The same place as the shape knows it.
    pub in_shape: Vec3,
}

/// Numbers of memory: the moment of all that is borne about the origin [N m], and the force on each bearer [N].
pub fn memory_len(shape: &dyn Shape) -> usize {
    let bearers = shape.bearers().len();
    if bearers == 0 { 0 } else { 3 + 3 * bearers }
}

/// The opposite of pushes, in place of what stands in `memory`.
pub fn collect(
    shape: &dyn Shape,
    at: &Configuration,
    pushes: impl Iterator<Item = Push>,
    memory: &mut [f64],
) {
    memory.fill(0.0);
    let Some((moment, forces)) = memory.split_at_mut_checked(3) else { return };
    let subtract = |from: &mut [f64], vector: Vec3| {
        from.iter_mut().zip(vector.to_array()).for_each(|(sum, part)| *sum -= part);
    };
    for Push { force, at: place, in_shape } in pushes {
        subtract(moment, place.cross(force));
        shape.visit_shares(at, in_shape, &mut |bearer, share| {
            subtract(&mut forces[3 * bearer..][..3], force * share);
        });
    }
}

/// Adds what is borne to the rows that bear it.
pub fn add(shape: &dyn Shape, memory: &[f64], positions: &[Vec3], out: &mut [Vec3]) {
    if memory.iter().all(|number| *number == 0.0) {
        return;
    }
    let (moment, forces) = memory.split_at(3);
    let vector = |numbers: &[f64]| Vec3::new(numbers[0], numbers[1], numbers[2]);
    let rows = shape.bearers().iter().map(|row| *row as usize);
    let borne = rows.clone().zip(forces.chunks_exact(3).map(vector));
    let given: Vec3 = borne.clone().map(|(row, force)| positions[row].cross(force)).sum();
    let (centre, rate) = couple(rows.map(|row| positions[row]), vector(moment) - given);
    for (row, force) in borne {
        out[row] += force + rate.cross(positions[row] - centre);
    }
}
