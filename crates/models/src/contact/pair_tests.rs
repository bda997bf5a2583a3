//! The search of pairs: what comes far within a step is found, what a file says is checked.

use souple_engine::{Force, SnapshotError, State, World};
use souple_math::Vec3;

use super::tests::{LAW, read, springs_within, two_cubes};
use super::*;
use crate::loads::battery::{stepper, world};
use crate::loads::{Attachments, GroundSpring, GroundSprings};

/// How far pairs of [`two_cubes`] reach.
const REACH: f64 = 0.3;

fn touches(world: &mut World) -> usize {
    read(world, |contact, at| contact.touches(at).len())
}

/// The upper of two cubes, on its way down to the lower one over more than the reach. Without friction: long steps that
/// slide have no potential to minimise, and may stall whatever is found.
fn falling(name: &str, speed: f64, period: f64) -> World {
    let law = ContactLaw { stiffness: 2e3, friction: 0.0, damping: 0.0, thickness: 0.0, ..LAW };
    let (positions, contact) = two_cubes(law, 1.0 + 1.5 * REACH, Vec3::ZERO);
    let half = positions.len() / 2;
    let bodies = Attachments::new("bodies", springs_within(&positions, half), 200.0, 0.0).unwrap();
    let velocities: Vec<Vec3> =
        (0..2 * half).map(|row| if row < half { Vec3::ZERO } else { Vec3::Y * -speed }).collect();
    let forces: Vec<Box<dyn Force>> = vec![Box::new(contact), Box::new(bodies)];
    world(&positions, &velocities, &vec![0.05; 2 * half], forces, stepper(name), period)
}

/// One implicit step over a gap wider than the reach ends in touch, not inside: pairs are found again where Newton's
/// method led, and the step is solved on with them. Momentum stays, and a second run gives the same bits.
#[test]
fn a_long_implicit_step_does_not_tunnel() {
    let (speed, period) = (1.0, 2.0 * REACH);
    let run = || {
        let mut world = falling("backward_euler", speed, period);
        assert!(world.state().systems[0].pairs.is_empty());
        let (momentum, _) = world.momentum();
        world.step().unwrap();
        // unbalanced forces of 1e-8 of those at work, some 100 N, for a step
        assert!((world.momentum().0 - momentum).length() < 1e-8 * 100.0 * period);
        world
    };
    let mut world = run();
    assert!(touches(&mut world) > 0, "the cube went through");
    let deepest = read(&mut world, |contact, at| {
        contact.touches(at).iter().map(|touch| touch.penetration).fold(0.0, f64::max)
    });
    // freely it would have come half the reach deep
    assert!(deepest < 0.25 * REACH, "{deepest}");
    assert_eq!(world.state().hash(), run().state().hash());
}

/// The same for explicit steps whose force is felt after a drift longer than half the reach.
#[test]
fn a_long_drift_finds_what_it_meets() {
    // half a step of Störmer–Verlet, and the stages of Runge–Kutta, end 0.15 inside
    for (name, period) in [("verlet", 4.0 * REACH), ("rk4", 2.0 * REACH)] {
        let mut world = falling(name, 1.0, period);
        world.step().unwrap();
        let lower = world.state().systems[0].v[0];
        assert!(lower.length() > 0.0, "{name}: the lower cube felt nothing");
    }
}

/// Equilibrium across a gap wider than the reach: the load of soft springs is carried by the contact.
#[test]
fn statics_across_a_gap_find_the_contact() {
    let law = ContactLaw { friction: 0.0, damping: 0.0, thickness: 0.0, stiffness: 2e3, ..LAW };
    let (positions, contact) = two_cubes(law, 1.0 + 1.5 * REACH, Vec3::ZERO);
    let half = positions.len() / 2;
    let hold = |rows: std::ops::Range<usize>, down: f64| -> Vec<GroundSpring> {
        let anchor = |row: usize| positions[row] - Vec3::Y * down;
        rows.map(|row| GroundSpring { row: row as u32, share: 1.0, anchor: anchor(row) }).collect()
    };
    // to a third of the reach inside, if nothing were there
    let (stiffness, down) = (10.0, 1.5 * REACH + REACH / 3.0);
    let forces: Vec<Box<dyn Force>> = vec![
        Box::new(contact),
        Box::new(Attachments::new("bodies", springs_within(&positions, half), 1e3, 0.0).unwrap()),
        Box::new(GroundSprings::new("low", hold(0..half, 0.0), 1e4, 0.0).unwrap()),
        Box::new(GroundSprings::new("high", hold(half..2 * half, down), stiffness, 0.0).unwrap()),
    ];
    let still = vec![Vec3::ZERO; 2 * half];
    let mut world = world(&positions, &still, &vec![1.0; 2 * half], forces, stepper("static"), 1.0);
    world.step().unwrap();
    let (normal, _) = read(&mut world, |contact, at| contact.total(at));
    let q = &world.state().systems[0].q;
    let pulled: Vec3 =
        (half..2 * half).map(|row| (positions[row] - Vec3::Y * down - q[row]) * stiffness).sum();
    // the second body bears the opposite of `normal`; what is left is Newton's 1e-8 of the forces at work
    assert!(normal.y < -1.0 && (pulled - normal).length() < 1e-6 * normal.length(), "{pulled:?} {normal:?}");
}

/// A point deep inside, far beyond the reach, still makes a pair.
#[test]
fn points_inside_touch_at_any_depth() {
    let (mut positions, contact) = two_cubes(ContactLaw { thickness: 0.0, ..LAW }, 3.0, Vec3::ZERO);
    let half = positions.len() / 2;
    positions[half] = Vec3::new(0.5, 0.55, 0.5);
    let bodies = Attachments::new("bodies", springs_within(&positions, half), 1.0, 0.0).unwrap();
    let still = vec![Vec3::ZERO; 2 * half];
    let forces: Vec<Box<dyn Force>> = vec![Box::new(contact), Box::new(bodies)];
    let stepper = stepper("symplectic_euler");
    let mut world = world(&positions, &still, &vec![1.0; 2 * half], forces, stepper, 1e-6);
    world.step().unwrap();
    let pairs = &world.state().systems[0].pairs;
    assert!(pairs.iter().any(|pair| pair.a == half as u64), "{pairs:?}");
}

/// States that the model cannot step are refused by name, and the world stays where it was.
#[test]
fn foreign_states_are_refused() {
    let mut world = falling("backward_euler", 1.0, 0.5);
    world.step().unwrap();
    let good = world.state().clone();
    assert!(!good.systems[0].pairs.is_empty());
    type Spoil = fn(&mut State);
    let spoils: [(&str, Spoil); 9] = [
        ("systems[0].pairs[0]", |state| state.systems[0].pairs[0].b = 1 << 40),
        ("systems[0].pairs", |state| state.systems[0].pairs.last_mut().unwrap().a = u64::MAX),
        ("systems[0].pairs[1]", |state| state.systems[0].pairs[0].force = 1),
        ("systems[0].pairs", |state| state.systems[0].pairs.last_mut().unwrap().force = 9),
        ("systems[0].pairs[1]", |state| state.systems[0].pairs[1] = state.systems[0].pairs[0]),
        ("systems[0].pairs[0]", |state| state.systems[0].pairs[0].memory[2] = f64::NAN),
        ("systems[0].q[3]", |state| state.systems[0].q[3].y = f64::INFINITY),
        ("systems[0].history", |state| state.systems[0].history.truncate(4)),
        ("random generators", |state| state.generators.push(7)),
    ];
    for (name, spoil) in spoils {
        let mut state = good.clone();
        spoil(&mut state);
        let error = world.resume(state).unwrap_err();
        assert!(error.to_string().contains(name), "{name}: {error}");
        assert_eq!(world.state(), &good, "{name}");
    }
    let counts: [(&str, Spoil); 4] = [
        ("free rows in system 0", |state| state.systems[0].q.truncate(5)),
        ("velocity blocks in system 0", |state| state.systems[0].v.push(Vec3::ZERO)),
        ("numbers of memory in system 0", |state| state.systems[0].memory.clear()),
        ("systems", |state| state.systems.clear()),
    ];
    for (what, spoil) in counts {
        let mut state = good.clone();
        spoil(&mut state);
        let error = world.resume(state).unwrap_err();
        assert!(matches!(&error, SnapshotError::OtherModel { what: found, .. } if found == what), "{error}");
    }
    world.resume(good).unwrap();
    world.step().unwrap();
}
