//! Implicit formulas of second order and quasi-statics: orders with everything at once, what they carry, what they refuse.

use std::sync::Arc;

use souple_engine::{
    Constraint, Force, Kinematics, Mass, Motion, State, StepError, System, UnknownKind, World,
};
use souple_math::Vec3;
use souple_models::loads::{
    Attachments, Combination, FormulaVector, GroundSpring, GroundSprings, Link, MassDamping, PointLoad,
};

use super::forces::PlasticLink;
use super::{points, stepper_with, world};

/// Led to and fro, from rest.
#[derive(Debug)]
struct Swing;

impl Motion for Swing {
    fn offset(&self, _: Vec3, time: f64) -> Vec3 {
        Vec3::X * (0.1 * (1.0 - (3.0 * time).cos()))
    }

    fn velocity(&self, _: Vec3, time: f64) -> Vec3 {
        Vec3::X * (0.3 * (3.0 * time).sin())
    }
}

const TIGHT: [(&str, f64); 2] = [("newton_tolerance", 1e-13), ("solver_tolerance", 1e-13)];

/// Two points on springs, one of them led, damped, drawn by a load in time, with a mass that couples them.
fn chain(stepper: Box<dyn souple_engine::Stepper>, coupling: f64, timestep: f64) -> World {
    let link = |a: Combination, b: Combination| Link::new(a, b, 0.9);
    let links =
        vec![link(Combination::row(0), Combination::row(1)), link(Combination::row(1), Combination::row(2))];
    let load = Arc::new(FormulaVector::compile("[0, 3 * sin(4 * t), 0.5 * t]").unwrap());
    let (mut system, q) =
        points(&[Vec3::ZERO, Vec3::X, Vec3::X * 2.0], &[0.4, 0.5, 0.6], Vec::new(), stepper);
    if coupling > 0.0 {
        system.mass.couplings = vec![(0, 1, coupling), (1, 2, coupling)];
    }
    system.forces = vec![
        Box::new(Attachments::new("net", links, 60.0, 0.3).unwrap()),
        Box::new(MassDamping::new("damping", system.mass.clone(), 0.4).unwrap()),
        Box::new(PointLoad::new("load", vec![(2, 1.0)], load).unwrap()),
    ];
    system.constraints = vec![Constraint { motion: Some(Arc::new(Swing)), ..Constraint::pin(0, q[0]) }];
    world((system, q), timestep)
}

/// Place and velocity of the free points after a second.
fn after_a_second(mut world: World, steps: u32) -> Vec<f64> {
    (0..steps).for_each(|_| world.step().unwrap());
    let state = &world.state().systems[0];
    state.q[1..].iter().chain(&state.v[1..]).flat_map(|row| row.to_array()).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// With links far from linear, damping, a load in time and a point that is led, whether its mass is coupled to the others'
/// or not: second order in places and velocities, solved to the end or once; and first order of backward Euler.
#[test]
fn formulas_keep_their_order_with_everything_at_once() {
    for coupling in [0.0, 0.1] {
        let limit =
            after_a_second(chain(stepper_with("bdf2", &TIGHT, "full"), coupling, 1.0 / 25600.0), 25600);
        for (name, newton, order) in [
            ("backward_euler", "full", 1.0),
            ("bdf2", "full", 2.0),
            ("newmark", "full", 2.0),
            ("bdf2", "one", 2.0),
            ("newmark", "one", 2.0),
        ] {
            let error = |steps: u32| {
                let stepper = stepper_with(name, &TIGHT, newton);
                distance(&after_a_second(chain(stepper, coupling, 1.0 / f64::from(steps)), steps), &limit)
            };
            let (coarse, fine) = (error(400), error(800));
            let measured = (coarse / fine).log2();
            // error = C hᵖ (1 + c h), and the limit is off by a thousandth of the fine error
            assert!((measured - order).abs() < 0.1, "{name} {newton}, {coupling} kg: order {measured}");
        }
    }
}

/// Explicit methods keep their order where a led point takes others along by its mass, and agree with implicit ones.
#[test]
fn explicit_methods_take_along_what_is_coupled_to_led_points() {
    let limit = after_a_second(chain(stepper_with("newmark", &TIGHT, "full"), 0.1, 1.0 / 25600.0), 25600);
    let mut finest = limit.clone();
    // the error `C hᵖ (1 + c h)` needs finer steps where it is large
    for (name, order, coarsest) in
        [("explicit_euler", 1.0, 3200), ("symplectic_euler", 1.0, 800), ("rk2", 2.0, 400), ("rk4", 4.0, 100)]
    {
        let after = |steps: u32| {
            let stepper = stepper_with(name, &[], "");
            after_a_second(chain(stepper, 0.1, 1.0 / f64::from(steps)), steps)
        };
        let [coarse, middle, fine] = [1, 2, 4].map(|finer| after(coarsest * finer));
        let measured = (distance(&coarse, &middle) / distance(&middle, &fine)).log2();
        assert!((measured - order).abs() < 0.1, "{name}: order {measured}");
        finest = fine;
    }
    // the limit of the second order has (1 s / 25600)² times derivatives of some 10³ left
    assert!(distance(&finest, &limit) < 1e-5, "{:e}", distance(&finest, &limit));
}

/// A frame of three different moments that tumbles freely: its angular momentum is kept to the first order of the step by
/// backward Euler, solved to the end or once.
#[test]
fn tumbling_frames_keep_their_momentum_to_first_order() {
    let drift = |newton: &str, steps: u32| {
        let stepper = stepper_with("backward_euler", &TIGHT, newton);
        let (mut system, _) = points(&[Vec3::ZERO], &[1.0], Vec::new(), stepper);
        system.kinematics = Kinematics::default();
        system.kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
        system.mass = Mass { diagonal: vec![1.0, 1.0, 2.0, 4.0], couplings: Vec::new() };
        let mut state = system.initial_state(vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
        state.v[1] = Vec3::new(1.0, 1.0, 1.0);
        let model = souple_engine::Model {
            period: 1.0 / f64::from(steps),
            systems: vec![system],
            ..Default::default()
        };
        let mut world = model.start(State { systems: vec![state], ..State::default() });
        let start = world.momentum().1;
        (0..steps).for_each(|_| world.step().unwrap());
        (world.momentum().1 - start).length() / start.length()
    };
    for newton in ["one", "full"] {
        let (coarse, fine) = (drift(newton, 100), drift(newton, 200));
        let order = (coarse / fine).log2();
        assert!((order - 1.0).abs() < 0.1 && fine < 0.02, "{newton}: {coarse:e} {fine:e}, order {order}");
    }
}

/// Average acceleration keeps the energy of an oscillation to the tolerance of the solver at any step, solved once or to the
/// end; the second backward differentiation formula loses it to the root of its recursion; `γ > ½` loses more.
#[test]
fn energies_of_an_oscillation() {
    let (mass, stiffness, timestep): (f64, f64, f64) = (0.5, 200.0, 0.04);
    let z = timestep * (stiffness / mass).sqrt();
    let lost = |name: &str, given: &[(&'static str, f64)], newton: &str| {
        let spring = GroundSpring { row: 0, share: 1.0, anchor: Vec3::ZERO };
        let spring = GroundSprings::new("spring", vec![spring], stiffness, 0.0).unwrap();
        let stepper = stepper_with(name, &[&TIGHT[..], given].concat(), newton);
        let mut world = world(points(&[Vec3::X * 0.1], &[mass], vec![Box::new(spring)], stepper), timestep);
        let energy = |world: &World| {
            let state = &world.state().systems[0];
            0.5 * mass * state.v[0].length_sq() + 0.5 * stiffness * state.q[0].length_sq()
        };
        let start = energy(&world);
        (0..200).for_each(|_| world.step().unwrap());
        let before = energy(&world);
        world.step().unwrap();
        (1.0 - energy(&world) / start, energy(&world) / before)
    };
    for newton in ["one", "full"] {
        let (newmark, _) = lost("newmark", &[], newton);
        // 1e-13 of the force, two hundred times
        assert!(newmark.abs() < 1e-10, "{newton}: {newmark:e}");
        let (_, bdf2) = lost("bdf2", &[], newton);
        // ρ = (2 + √(1 - 2 i z))/(3 + 2 i z): the root by modulus and half angle
        let (modulus, angle) = ((1.0 + 4.0 * z * z).powf(0.25), -0.5 * (2.0 * z).atan());
        let (re, im) = (2.0 + modulus * angle.cos(), modulus * angle.sin());
        let expected = (re * re + im * im) / (9.0 + 4.0 * z * z);
        assert!((bdf2 / expected - 1.0).abs() < 1e-9, "{newton}: {bdf2} for {expected}");
        let (dissipated, _) = lost("newmark", &[("gamma", 0.7), ("beta", 0.36)], newton);
        assert!(dissipated > 0.99, "{newton}: {dissipated}");
    }
}

/// A run resumed from its bytes at any step goes on bit for bit: what a formula carries lies in State; a history that no
/// formula leaves is refused.
#[test]
fn what_is_carried_is_in_the_snapshot() {
    for name in ["backward_euler", "bdf2", "newmark", "quasi_static"] {
        let make = || chain(stepper_with(name, &[], ""), 0.1, 0.01);
        let mut run = make();
        let mut states = vec![run.state().clone()];
        for _ in 0..6 {
            run.step().unwrap();
            states.push(run.state().clone());
        }
        for (step, state) in states[..6].iter().enumerate() {
            let mut resumed = make();
            resumed.resume(State::from_bytes(&state.to_bytes()).unwrap()).unwrap();
            resumed.step().unwrap();
            assert_eq!(resumed.state().hash(), states[step + 1].hash(), "{name} after step {step}");
        }
        let mut foreign = states[6].clone();
        foreign.systems[0].history.push(0.0);
        let refused = run.resume(foreign).unwrap_err().to_string();
        assert!(refused.contains("history") && refused.contains(name), "{refused}");
    }
}

/// Rigid frames are refused by formulas that add displacements of different steps, and an unstable pair of numbers too.
#[test]
fn what_cannot_be_stepped_is_refused_by_name() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
    let mut system = System {
        name: "main".into(),
        kinematics,
        mass: Mass::new(4),
        forces: Vec::new(),
        constraints: Vec::new(),
        stepper: stepper_with("bdf2", &[], ""),
        steps_per_period: 1,
    };
    for name in ["bdf2", "newmark"] {
        let refused = stepper_with(name, &[], "").refuses(&system).unwrap();
        assert!(refused.contains(name) && refused.contains("rigid frames"), "{refused}");
    }
    assert_eq!(stepper_with("backward_euler", &[], "").refuses(&system), None);
    system.kinematics = Kinematics::default();
    system.kinematics.add_unknowns(UnknownKind::AffineFrame, 1);
    assert_eq!(stepper_with("bdf2", &[], "").refuses(&system), None);
    let refused = stepper_with("newmark", &[("gamma", 0.7), ("beta", 0.3)], "").refuses(&system).unwrap();
    assert!(refused.contains("at least 0.35") && refused.contains("0.3"), "{refused}");
}

/// A link that bears 5 N, drawn by a load that grows by 10 N a second: equilibria are followed until the link yields, in
/// parts of a step where the whole has none, and the step that leads beyond is refused and changes nothing.
#[test]
fn a_path_of_equilibria_ends_where_there_are_none() {
    let pull = Arc::new(FormulaVector::compile("[10 * t, 0, 0]").unwrap());
    let forces: Vec<Box<dyn Force>> = vec![
        Box::new(PlasticLink { stiffness: 100.0, limit: 5.0 }),
        Box::new(PointLoad::new("load", vec![(0, 1.0)], pull).unwrap()),
    ];
    let (mut system, q) = points(&[Vec3::ZERO], &[1.0], forces, stepper_with("quasi_static", &[], ""));
    // along x only
    system.constraints = vec![Constraint::partial(0, Vec3::ZERO, [true, false, false])];
    let (period, strength) = (0.2, 0.5);
    let mut world = world((system, q), period);
    for step in 1..=2 {
        world.step().unwrap();
        let (x, expected) = (world.state().systems[0].q[0].x, 0.1 * period * f64::from(step));
        assert!((x - expected).abs() < 1e-8 * expected, "step {step}: {x} for {expected}");
    }
    let before = world.state().clone();
    let refused = world.step().unwrap_err();
    assert_eq!(*world.state(), before);
    let StepError::NoEquilibrium { from, parts, .. } = refused.error else { panic!("{refused}") };
    assert!(from <= strength && from > strength - period / 1000.0, "followed up to {from} s");
    assert!(parts < period / 1000.0, "{parts}");
}
