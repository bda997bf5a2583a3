//! What pins do to the points they hold.
//!
//! Newton's law of a held point, along the held directions: `M a = f + r`, so the reaction is `r = M a − f` with the
//! sum `f` of all other forces. It is the force of the pin *on the body*: under gravity a pinned body feels a reaction
//! that points up. What bones do is that on the points pinned to them, and on the frames that follow them, read likewise on origins and axes, whose forces `g_k` are
//! together a torque `Σ a_k × g_k` about the origin. The acceleration `a` of held points is that of their prescribed motion; a consistent mass couples
//! them to their free neighbours, whose accelerations follow from the same law. Where a stepper knows no inertia,
//! `r = −f`.

use souple_engine::inertia::row_accelerations_at;
use souple_engine::levels::Followers;
use souple_engine::{Configuration, Declaration, Surroundings, System, SystemState, SystemWorkspace, World};
use souple_math::{Mat3, Vec3};
use souple_models::frames::ROWS_OF_FRAME;

use super::{BonePart, Part};
use crate::spec::quantity::BoneQuantity;

/// Tolerance of the accelerations of free points, relative: far below what a probe is read to. A consistent mass is
/// as well conditioned as its elements are shaped, so this takes tens of iterations.
const TOLERANCE: f64 = 1e-12;
const MOST_ITERATIONS: usize = 500;

/// Reactions at the rows of a part, and of its coarser points; zero at those that nothing holds [N].
pub fn reactions(part: &Part, world: &mut World) -> Vec<Vec3> {
    let timestep = world.model().timestep(part.system);
    world.with_system(part.system, |system: &System, state, around, ws| {
        let balance = balance(system, state, around, ws, timestep, part.hangs);
        let reactions = of_pins(system, state, around, ws, &balance, part.hold.as_deref());
        part.held.iter().chain(&part.coarser).map(|row| reactions[*row as usize]).collect()
    })
}

/// What a bone does to the frames and the pinned points that follow it: the force [N], or the torque about a place [N m].
pub fn of_bone(quantity: BoneQuantity, part: &BonePart, world: &mut World) -> Vec3 {
    let timestep = world.model().timestep(part.system);
    world.with_system(part.system, |system: &System, state, around, ws| {
        let mut sum = Vec3::ZERO;
        let mut add = |force: Vec3, place: Vec3, torque: Vec3| {
            sum += match quantity {
                BoneQuantity::Force => force,
                BoneQuantity::Torque => (place - part.about).cross(force) + torque,
            };
        };
        if !part.frames.is_empty() {
            let balance = balance(system, state, around, ws, timestep, true);
            for row in &part.frames {
                let row = *row as usize;
                let x = &ws.rows.positions[row..row + ROWS_OF_FRAME];
                let (force, on_axes) = (balance[row], &balance[row + 1..row + ROWS_OF_FRAME]);
                add(force, x[0], x[1..].iter().zip(on_axes).map(|(axis, force)| axis.cross(*force)).sum());
            }
        }
        if !part.pinned.is_empty() {
            let balance = balance(system, state, around, ws, timestep, part.hangs);
            let reactions = of_pins(system, state, around, ws, &balance, part.hold.as_deref());
            for point in &part.pinned {
                let force = Mat3::from_diagonal(point.axes) * reactions[point.held as usize];
                add(force, ws.rows.positions[point.row as usize], Vec3::ZERO);
            }
        }
        sum
    })
}

/// Power that the world is given from outside [W]: by pins that lead points, by loads that have no energy, and by those whose energy
/// changes with time. What shapes that move and hands do is not in it.
pub fn power_from_outside(world: &mut World) -> f64 {
    let period = world.model().period;
    let of_system = |world: &mut World, index: usize| {
        let timestep = world.model().timestep(index);
        world.with_system(index, |system: &System, state, around, ws| {
            let joined = system.kinematics.row_count() > system.kinematics.free_row_count();
            let balance = balance(system, state, around, ws, timestep, joined);
            let mut forces = of_pins(system, state, around, ws, &balance, None);
            let mut power = 0.0;
            for (index, force) in system.forces.iter().enumerate() {
                let Declaration { conservative, internal, velocity_terms, .. } = force.declaration();
                // what a body remembers of itself stays as it is meanwhile; clamps that are led do work on it
                let remembers = force.memory_len() > 0 && !(conservative && force.acts_within());
                if internal || velocity_terms || remembers {
                    continue;
                }
                let (at, scratch) = (system.view(index, &ws.rows, state, around), &mut ws.scratches[index]);
                if conservative {
                    let mut stored = |time: f64| force.energy(&Configuration { time, ..at }, scratch).stored;
                    // there is nothing before the start: a formula may have no value there
                    let (from, to) = ((at.time - 0.5 * period).max(0.0), at.time + 0.5 * period);
                    power += (stored(to) - stored(from)) / (to - from);
                } else {
                    force.add_force(&at, scratch, &mut forces);
                }
            }
            power + forces.iter().zip(&ws.rows.velocities).map(|(f, v)| f.dot(*v)).sum::<f64>()
        })
    };
    (0..world.model().systems.len()).map(|index| of_system(world, index)).sum()
}

/// What pins do to each row [N]: `balance` along constraints, and the pull of the springs that hold points which frames carry.
fn of_pins(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &mut SystemWorkspace,
    balance: &[Vec3],
    hold: Option<&str>,
) -> Vec<Vec3> {
    let mut reactions = vec![Vec3::ZERO; balance.len()];
    for constraint in &system.constraints {
        if let Some(row) = system.kinematics.point_block_row(constraint.block) {
            reactions[row as usize] = constraint.constrained() * balance[row as usize];
        }
    }
    if let Some(index) = hold.and_then(|name| system.forces.iter().position(|force| force.name() == name)) {
        let at = system.view(index, &ws.rows, state, around);
        system.forces[index].add_force(&at, &mut ws.scratches[index], &mut reactions);
    }
    reactions
}

/// `r = M a − f` of all rows; with `joined`, of unknowns with what hangs on them.
fn balance(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &mut SystemWorkspace,
    timestep: f64,
    joined: bool,
) -> Vec<Vec3> {
    system.sum_row_forces(&ws.rows, state, around, &mut ws.scratches, &mut ws.row_force);
    // what acts on points that follow acts on those that they follow
    for (index, levels) in
        system.forces.iter().enumerate().filter_map(|(index, force)| Some((index, force.levels()?)))
    {
        levels.give_back(Followers::All, &ws.scratches[index], &mut ws.row_force);
    }
    let mut balance: Vec<Vec3> = ws.row_force.iter().map(|f| -*f).collect();
    if system.stepper.has_inertia() {
        let accelerations = if joined {
            accelerations_of_unknowns(system, around, state, ws, timestep)
        } else {
            accelerations(system, &ws.row_force, ws.rows.time, timestep)
        };
        system.mass.add_product(&accelerations, &mut balance);
    }
    if joined {
        // what hangs on a held point is held with it
        system.kinematics.return_forces(&mut balance);
    }
    balance
}

/// Accelerations of all rows: prescribed along held directions, free ones only where held ones need them.
fn accelerations(system: &System, force: &[Vec3], time: f64, timestep: f64) -> Vec<Vec3> {
    let mut a = vec![Vec3::ZERO; force.len()];
    for constraint in &system.constraints {
        if let Some(row) = system.kinematics.point_block_row(constraint.block) {
            a[row as usize] = constraint.constrained() * constraint.mean_acceleration(time, timestep);
        }
    }
    if !system.mass.is_lumped() {
        add_free_accelerations(system, force, &mut a);
    }
    a
}

/// The same where rows hang on unknowns: from the law of motion of the unknowns.
fn accelerations_of_unknowns(
    system: &System,
    around: &Surroundings,
    state: &SystemState,
    ws: &mut SystemWorkspace,
    timestep: f64,
) -> Vec<Vec3> {
    let when = (ws.rows.time, timestep);
    let mut rows = vec![Vec3::ZERO; system.kinematics.row_count()];
    // a mass that cannot be solved with was refused by the step before
    match row_accelerations_at(system, around, when, state, ws, &mut rows) {
        Ok(()) => rows,
        Err(_) => vec![Vec3::ZERO; system.kinematics.row_count()],
    }
}

/// Solves `M_ff a_f = f_f − M_fc a_c` by conjugate gradients, preconditioned by the diagonal.
fn add_free_accelerations(system: &System, force: &[Vec3], a: &mut [Vec3]) {
    let product = |x: &[Vec3]| {
        let mut out = vec![Vec3::ZERO; x.len()];
        system.mass.add_product(x, &mut out);
        system.project_free_rows(&mut out);
        out
    };
    let dot = |x: &[Vec3], y: &[Vec3]| x.iter().zip(y).map(|(x, y)| x.dot(*y)).sum::<f64>();
    let preconditioned = |r: &[Vec3]| -> Vec<Vec3> {
        r.iter().zip(&system.mass.diagonal).map(|(r, mass)| *r / *mass).collect()
    };
    let mut residual: Vec<Vec3> = force.iter().zip(product(a)).map(|(f, inertia)| *f - inertia).collect();
    system.project_free_rows(&mut residual);
    let mut z = preconditioned(&residual);
    let mut direction = z.clone();
    let mut rz = dot(&residual, &z);
    let enough = TOLERANCE * TOLERANCE * rz;
    for _ in 0..MOST_ITERATIONS {
        if rz.is_nan() || rz <= enough {
            break;
        }
        let image = product(&direction);
        let alpha = rz / dot(&direction, &image);
        for index in 0..a.len() {
            a[index] += direction[index] * alpha;
            residual[index] -= image[index] * alpha;
        }
        z = preconditioned(&residual);
        let next = dot(&residual, &z);
        let beta = next / rz;
        rz = next;
        for (d, z) in direction.iter_mut().zip(&z) {
            *d = *z + *d * beta;
        }
    }
}
