//! Loads against their laws.

use std::sync::Arc;

use souple_engine::{Force, Kinematics, Mass, Motion, ParameterError, UnknownKind};
use souple_math::Vec3;

use super::battery::{Setting, assert_force, stepper, stepper_of, world};
use super::*;

fn positions() -> Vec<Vec3> {
    (0..5).map(|i| Vec3::new(0.3 * i as f64, 0.1 + (i as f64).sin(), (1.7 * i as f64).cos())).collect()
}

fn velocities() -> Vec<Vec3> {
    (0..5).map(|i| Vec3::new((2.0 * i as f64).cos(), 0.4 * i as f64, -0.3)).collect()
}

fn assert_in_motion(force: &dyn Force) {
    assert_force(force, &Setting::new(force, positions(), velocities()));
}

/// A link between a point of three rows and one of two, which share a row.
fn link(rest_length: f64) -> Link {
    let a = Combination::new(vec![(0, 0.2), (1, 0.5), (2, 0.3)]).unwrap();
    let b = Combination::new(vec![(4, 0.75), (2, 0.25)]).unwrap();
    Link { a, b, rest_length }
}

fn consistent_mass() -> Mass {
    let mut mass = Mass::new(5);
    mass.diagonal.copy_from_slice(&[1.0, 2.0, 0.5, 0.0, 3.0]);
    mass.couplings = vec![(0, 1, 0.3), (1, 4, 0.1)];
    mass
}

#[test]
fn forces_agree_with_energies_and_derivatives() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 5);
    let mass = consistent_mass();
    assert_in_motion(&Gravity::new("gravity", Vec3::new(0.0, -9.81, 1.0), &mass, &kinematics).unwrap());
    assert_in_motion(&MassDamping::new("damping", mass, 0.7).unwrap());
    let shares = vec![(1, 0.25), (3, 0.75)];
    assert_in_motion(&Drag::new("drag", shares.clone(), 2.0).unwrap());
    for text in ["[1, sin(t), -2]", "[-y * t, x + z^2, 1 + x * y]"] {
        let field = Arc::new(FormulaVector::compile(text).unwrap());
        assert_in_motion(&PointLoad::new("load", shares.clone(), field).unwrap());
    }
    assert_in_motion(&PointLoad::new("load", shares, Arc::new(UniformForce(Vec3::X))).unwrap());
    for damping in [0.0, 3.0] {
        let spring = |row, share| GroundSpring { row, share, anchor: Vec3::new(0.1, 0.2, 0.3) };
        let springs = vec![spring(0, 1.0), spring(3, 0.5)];
        assert_in_motion(&GroundSprings::new("ground", springs, 40.0, damping).unwrap());
        assert_in_motion(&Grab::new("grab", link(0.0).a, Vec3::Y, 25.0, damping).unwrap());
        for rest_length in [0.0, 0.4, 2.5] {
            let links = vec![link(rest_length)];
            assert_in_motion(&Attachments::new("attachment", links, 30.0, damping).unwrap());
        }
    }
}

/// The weight is the sum of all entries of the mass matrix times `g`, consistent or lumped.
#[test]
fn total_weight() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 5);
    let gravity =
        Gravity::new("gravity", Vec3::new(0.0, -10.0, 0.0), &consistent_mass(), &kinematics).unwrap();
    assert!((gravity.total() - Vec3::new(0.0, -73.0, 0.0)).length() < 1e-13);
}

/// A frame falls as a whole: its axes get no weight but what its mass couples to the origin.
#[test]
fn gravity_leaves_axes_alone() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
    let mut mass = Mass::new(4);
    mass.diagonal.copy_from_slice(&[2.0, 0.5, 0.5, 0.5]);
    let gravity = Gravity::new("gravity", Vec3::new(0.0, 0.0, -1.0), &mass, &kinematics).unwrap();
    let setting = Setting::new(&gravity, vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z], vec![Vec3::ZERO; 4]);
    // the setting acts with a load of 0.75
    assert_eq!(setting.force(&gravity), [Vec3::new(0.0, 0.0, -1.5), Vec3::ZERO, Vec3::ZERO, Vec3::ZERO]);
}

/// A link of a rest length that has shrunk to a point gives no force, and nothing that is not finite.
#[test]
fn a_link_without_a_direction() {
    let same = Link { a: Combination::row(0), b: Combination::row(1), rest_length: 1.0 };
    let links = Attachments::new("attachment", vec![same], 10.0, 1.0).unwrap();
    let setting = Setting::new(&links, vec![Vec3::X; 2], vec![Vec3::Y, Vec3::ZERO]);
    assert_eq!(setting.force(&links), [Vec3::ZERO; 2]);
}

/// `v = v₀ exp(-α t)`, and what the mass loses is what the damping says it took.
#[test]
fn mass_damping_decays_exponentially() {
    let (rate, period, steps) = (2.0, 1e-4, 5000);
    let mass = Mass { diagonal: vec![3.0], couplings: vec![] };
    let damping = MassDamping::new("damping", mass, rate).unwrap();
    let mut world = world(
        &[Vec3::ZERO],
        &[Vec3::X],
        &[3.0],
        vec![Box::new(damping)],
        stepper("symplectic_euler"),
        period,
    );
    (0..steps).for_each(|_| world.step().unwrap());
    let expected = (-rate * period * f64::from(steps)).exp();
    // Euler: (1 - αh)^n = exp(-αt) (1 - α² h t / 2), then order (α² h t)²
    let relative = world.state().systems[0].v[0].x / expected - 1.0;
    let first_order = 0.5 * rate * rate * period * (period * f64::from(steps));
    assert!(
        (relative + first_order).abs() < 2.0 * first_order * first_order + rate * period * first_order,
        "{relative}"
    );
    let energy = world.energy();
    let lost = 1.5 - energy.kinetic;
    // the account takes the power at the start of a step: first order, αh relative
    assert!((energy.by_force[0].1.dissipated - lost).abs() < rate * period * lost);
}

/// A ball hangs on a ground spring at `m g / k` below its anchor.
#[test]
fn a_spring_carries_a_weight() {
    let (mass, stiffness) = (0.5, 100.0);
    let spring = GroundSpring { row: 0, share: 1.0, anchor: Vec3::ZERO };
    let ground = GroundSprings::new("ground", vec![spring], stiffness, 14.0).unwrap();
    let weight = PointLoad::new("weight", vec![(0, mass)], Arc::new(UniformForce(Vec3::Y * -9.81))).unwrap();
    let forces: Vec<Box<dyn Force>> = vec![Box::new(ground), Box::new(weight)];
    // all is linear: one solve a step is exact
    let mut world =
        world(&[Vec3::ZERO], &[Vec3::ZERO], &[mass], forces, stepper_of("backward_euler", "one"), 0.05);
    (0..400).for_each(|_| world.step().unwrap());
    let sag = world.state().systems[0].q[0].y;
    // the linear solver stops at 1e-10 of its right-hand side, which shrinks with the motion
    assert!((sag + mass * 9.81 / stiffness).abs() < 1e-8, "{sag}");
}

/// The velocity of a motion is the derivative of its offset.
#[test]
fn motions_agree_with_their_velocities() {
    let offsets = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1.0, 0.0), Vec3::Z];
    let keys =
        |interpolation| KeyFrames::new(vec![0.0, 0.5, 0.7, 2.0], offsets.clone(), interpolation).unwrap();
    let motions: [&dyn Motion; 4] = [
        &keys(Interpolation::Linear),
        &keys(Interpolation::Smooth),
        &FormulaVector::compile("[0.1 * sin(2 * pi * t), x * t^2, if(t > 1, 1, t)]").unwrap(),
        &TimeFunction::new(|start: Vec3, t: f64| (start * t, start)),
    ];
    let (start, step) = (Vec3::new(0.2, 0.3, 0.4), 1e-6);
    for motion in motions {
        for time in [-0.3, 0.1, 0.45, 0.6, 0.9, 1.9, 2.5] {
            let numeric =
                (motion.offset(start, time + step) - motion.offset(start, time - step)) * (0.5 / step);
            // third derivatives are of order 250 (1/0.2³, (2π)³): error 250 step², rounding 1e-16/step
            let error = (numeric - motion.velocity(start, time)).length();
            assert!(error < 2e-9, "{motion:?} at {time}: {error}");
        }
    }
}

/// Keys are met exactly; a smooth motion has no jump of velocity at them.
#[test]
fn key_frames_pass_through_their_keys() {
    let (times, offsets) = (vec![0.0, 0.5, 0.7], vec![Vec3::Y, Vec3::X, Vec3::Z]);
    for interpolation in [Interpolation::Linear, Interpolation::Smooth] {
        let keys = KeyFrames::new(times.clone(), offsets.clone(), interpolation).unwrap();
        for (time, offset) in times.iter().zip(&offsets) {
            assert!((keys.offset(Vec3::ZERO, *time) - *offset).length() < 1e-15);
            let jump = keys.velocity(Vec3::ZERO, *time) - keys.velocity(Vec3::ZERO, time - 1e-12);
            assert!(interpolation == Interpolation::Linear || jump.length() < 1e-9, "{jump:?}");
        }
    }
}

#[test]
fn bad_numbers_are_named() {
    let error = KeyFrames::new(vec![0.0, 0.0], vec![Vec3::ZERO; 2], Interpolation::Linear).unwrap_err();
    assert_eq!(error.to_string(), "`times[1]` is 0, but must be later than the time before it");
    let error = KeyFrames::new(vec![0.0], vec![], Interpolation::Linear).unwrap_err();
    assert_eq!(error.to_string(), "`offsets` has 0 entries, but there are 1 of times; give as many");
    let error = Drag::new("drag", vec![(0, -1.0)], 1.0).unwrap_err();
    assert_eq!(error.to_string(), "`rows[0].share` is -1, but must be a finite number of at least 0");
    assert!(matches!(Combination::new(vec![]), Err(LoadError::Empty { field: "rows", .. })));
    let mut grab = Grab::new("grab", Combination::row(0), Vec3::ZERO, 1.0, 0.0).unwrap();
    grab.set_parameter("target_x", 2.0).unwrap();
    assert_eq!(grab.target(), Vec3::new(2.0, 0.0, 0.0));
    assert!(matches!(grab.set_parameter("stiffness", -1.0), Err(ParameterError::Unfit { .. })));
    assert!(matches!(grab.set_parameter("target", 1.0), Err(ParameterError::Unknown { .. })));
    let wrong = Gravity::new("gravity", Vec3::new(f64::NAN, 0.0, 0.0), &Mass::new(0), &Kinematics::default());
    assert!(wrong.is_err());
}
