//! The forecast of the longest stable step, against frequencies that are known and against steps that blow up.

use souple_engine::coupling::{CouplingSpring, DRIVEN_LEN};
use souple_engine::stability::{Forecast, forecast};
use souple_engine::{DerivedRow, Feedback, Force, Kinematics, Mass, Model, State, UnknownKind, World};
use souple_math::Vec3;
use souple_models::contact::{ContactLaw, ContactPoint, ShapeContact, shape::Plane};
use souple_models::loads::{
    Attachments, Combination, Gravity, GroundSpring, GroundSprings, Link, RigidMotion,
};

use super::{points, stepper, world};

const STIFFNESS: f64 = 800.0;

fn forecast_of(world: &mut World) -> Forecast {
    world.with_system(0, forecast)
}

fn ground(positions: &[Vec3]) -> ShapeContact {
    let points = positions.iter().enumerate();
    let points = points.map(|(row, start)| ContactPoint { row: row as u32, share: 1.0, start: *start });
    let law = ContactLaw {
        stiffness: STIFFNESS,
        damping: 0.0,
        friction: 0.3,
        // alike in all directions: the bound on what touches is then exact
        tangential_stiffness: STIFFNESS,
        thickness: 0.0,
    };
    let plane = Box::new(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    ShapeContact::new("ground", points.collect(), plane, RigidMotion::default(), law).unwrap()
}

/// Springs to the ground `√(k/m)`, attachments `√(k (1/m + 1/M))`, the fast end of a coupling, and a contact that does
/// not touch yet, `√(k/m)`: each is in the forecast.
#[test]
fn every_spring_is_in_the_forecast() {
    let positions = [Vec3::Y * 3.0, Vec3::new(1.0, 3.0, 0.0)];
    let spring = GroundSpring { row: 1, share: 1.0, anchor: Vec3::ZERO };
    let link = Link::new(Combination::row(0), Combination::row(1), 1.0);
    let coupling = CouplingSpring {
        name: "tie".into(),
        fast_system: 0,
        fast_row: 1,
        slow_system: 1,
        slow_row: 0,
        stiffness: STIFFNESS,
        damping: 0.0,
        driven: 0,
    };
    let rows: [(&str, Box<dyn Force>, f64); 4] = [
        (
            "ground spring",
            Box::new(GroundSprings::new("k", vec![spring], STIFFNESS, 0.0).unwrap()),
            1.0 / 0.5,
        ),
        (
            "attachment",
            Box::new(Attachments::new("k", vec![link], STIFFNESS, 0.0).unwrap()),
            1.0 / 0.5 + 1.0 / 2.0,
        ),
        ("coupling", coupling.fast_end(), 1.0 / 0.5),
        ("contact", Box::new(ground(&positions)), 1.0 / 0.5),
    ];
    for (name, force, inverse_mass) in rows {
        let (system, q) = points(&positions, &[2.0, 0.5], vec![force], stepper("symplectic_euler"));
        let state = State {
            systems: vec![system.initial_state(q)],
            driven: vec![0.0; DRIVEN_LEN],
            ..State::default()
        };
        let mut world = Model { period: 1e-3, systems: vec![system], ..Model::default() }.start(state);
        let expected = (STIFFNESS * inverse_mass).sqrt();
        let found = forecast_of(&mut world).highest_frequency;
        // a few modes far apart: forty iterations converge to rounding
        assert!((found / expected - 1.0).abs() < 1e-9, "{name}: {found} {expected}");
    }
}

/// A spring on a row that hangs half on each of two masses: `k/4 (δ₁ + δ₂)²` over `m (δ₁² + δ₂²)`, `ω = √(k/(2 m))`; one on
/// a row that carries a rigid frame's arm `r` turns it too, `k (1/m + r²/I)`; and masses that are coupled count as such.
#[test]
fn what_hangs_on_rows_is_in_the_forecast() {
    let spring = |row: u32, anchor: Vec3| -> Box<dyn Force> {
        let springs = vec![GroundSpring { row, share: 1.0, anchor }];
        Box::new(GroundSprings::new("k", springs, STIFFNESS, 0.0).unwrap())
    };
    let of = |system: souple_engine::System, q: Vec<Vec3>| {
        let state = State { systems: vec![system.initial_state(q)], ..State::default() };
        let model = Model { period: 1e-3, systems: vec![system], ..Model::default() };
        forecast_of(&mut model.start(state)).highest_frequency
    };
    let (mut system, q) = points(
        &[Vec3::ZERO, Vec3::X],
        &[0.5, 0.5],
        vec![spring(2, Vec3::X * 0.5)],
        stepper("symplectic_euler"),
    );
    let parents = vec![(0, 0.5), (1, 0.5)];
    system.kinematics.add_derived_row(DerivedRow { parents, feedback: Feedback::Transpose }).unwrap();
    system.mass.diagonal.push(0.0);
    let found = of(system, q);
    assert!((found / (STIFFNESS / (2.0 * 0.5)).sqrt() - 1.0).abs() < 1e-9, "hanging: {found}");

    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
    let arm = 0.3;
    let parents = vec![(0, 1.0), (1, arm)];
    kinematics.add_derived_row(DerivedRow { parents, feedback: Feedback::Transpose }).unwrap();
    let (mut system, _) =
        points(&[Vec3::ZERO], &[1.0], vec![spring(4, Vec3::X * arm)], stepper("symplectic_euler"));
    system.kinematics = kinematics;
    // m at the origin, m_a on each axis: I = 2 m_a about each
    system.mass = Mass { diagonal: vec![2.0, 0.02, 0.02, 0.02, 0.0], couplings: Vec::new() };
    let found = of(system, vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
    let expected = (STIFFNESS * (1.0 / 2.0 + arm * arm / 0.04)).sqrt();
    assert!((found / expected - 1.0).abs() < 1e-9, "frame: {found} {expected}");

    let (mut system, q) =
        points(&[Vec3::ZERO, Vec3::X], &[0.5, 0.5], vec![spring(0, Vec3::ZERO)], stepper("symplectic_euler"));
    system.mass.couplings = vec![(0, 1, 0.25)];
    // the inverse of [[½, ¼], [¼, ½]] begins with 8/3
    let (found, expected) = (of(system, q), (STIFFNESS * 8.0 / 3.0).sqrt());
    assert!((found / expected - 1.0).abs() < 1e-9, "consistent: {found} {expected}");
}

/// A net of springs that its weight presses on the ground, a nanometre off its balance: with steps of the forecast it stays
/// there, with steps a tenth longer it leaves exponentially. The forecast takes 5 % off, and the power method comes from
/// below by a few percent at most.
#[test]
fn blow_up_is_where_it_is_forecast() {
    const SIDE: u32 = 5;
    let (mass, weight) = (0.01, 4.0);
    // where each point presses with its weight
    let sunk = -weight / STIFFNESS;
    let positions: Vec<Vec3> = (0..SIDE * SIDE)
        .map(|i| Vec3::new(0.1 * f64::from(i % SIDE), sunk, 0.1 * f64::from(i / SIDE)))
        .collect();
    let net = || {
        let mut links = Vec::new();
        for (a, x) in positions.iter().enumerate() {
            for (b, y) in positions[..a].iter().enumerate().filter(|(_, y)| (**y - *x).length() < 0.15) {
                let (a, b) = (Combination::row(a as u32), Combination::row(b as u32));
                links.push(Link::new(a, b, (*x - *y).length()));
            }
        }
        links
    };
    let start = |timestep: f64| {
        let masses = vec![mass; positions.len()];
        let (mut system, q) = points(&positions, &masses, vec![], stepper("symplectic_euler"));
        let gravity = Vec3::Y * (-weight / mass);
        let gravity = Gravity::new("gravity", gravity, &system.mass, &system.kinematics).unwrap();
        system.forces = vec![
            Box::new(Attachments::new("net", net(), 300.0, 0.0).unwrap()),
            Box::new(ground(&positions)),
            Box::new(gravity),
        ];
        world((system, q), timestep)
    };
    let longest = forecast_of(&mut start(1e-5)).longest_step;
    let farthest = |timestep: f64| {
        let mut world = start(timestep);
        let mut state = world.state().clone();
        for (i, q) in state.systems[0].q.iter_mut().enumerate() {
            *q += Vec3::new((i as f64).sin(), (2.0 * i as f64).sin(), (3.0 * i as f64).sin()) * 1e-9;
        }
        world.resume(state).unwrap();
        let mut farthest: f64 = 0.0;
        for _ in 0..1000 {
            world.step().unwrap();
            let q = &world.state().systems[0].q;
            farthest = q.iter().zip(&positions).map(|(q, x)| (*q - *x).length()).fold(farthest, f64::max);
        }
        farthest
    };
    // stable modes swing to 1/√(1 - (hω/2)²) = 3.2 of their start at 95 % of the limit, 75 of them at most at once
    let (calm, wild) = (farthest(longest), farthest(1.1 * longest));
    assert!(calm < 3.2 * 75.0 * 1e-9, "{calm} m from balance with the forecast step");
    assert!(wild > 1e-4, "{wild} m from balance with a step a tenth longer");
}

/// Methods without a stable step are forecast the one at which an oscillation grows by a tenth a second: at that step it
/// does, and damping bounds the step too.
#[test]
fn growth_is_what_is_forecast() {
    let (mass, omega): (f64, f64) = (0.5, 20.0);
    let oscillator = |name: &str, damping: f64, timestep: f64| {
        let spring = GroundSpring { row: 0, share: 1.0, anchor: Vec3::ZERO };
        let spring = GroundSprings::new("spring", vec![spring], mass * omega * omega, damping).unwrap();
        let system = points(&[Vec3::X], &[mass], vec![Box::new(spring)], stepper(name));
        world(system, timestep)
    };
    for name in ["explicit_euler", "rk2"] {
        let longest = forecast_of(&mut oscillator(name, 0.0, 1e-4)).longest_step;
        let mut world = oscillator(name, 0.0, longest);
        let before = world.energy().total();
        let steps = (1.0 / longest).round();
        (0..steps as u32).for_each(|_| world.step().unwrap());
        // energy is the square of the amplitude
        let growth = 0.5 * (world.energy().total() / before).ln() / (steps * longest);
        // ln(1 + x) = x to the part x/2, the growth of a step
        assert!((growth / 0.1 - 1.0).abs() < 0.01, "{name}: {growth} a second at {longest} s");
        // γ = c/m, h γ < 2 less 5 %
        let damped = forecast_of(&mut oscillator(name, 1e4 * mass, 1e-4)).longest_step;
        assert!((damped / (0.95 * 2.0 / 1e4) - 1.0).abs() < 1e-6, "{name}: {damped}");
    }
}
