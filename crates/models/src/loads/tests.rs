//! Loads against their laws.

use std::sync::Arc;

use souple_engine::{
    Force, Grip, Hand, Kinematics, Mass, Motion, ParameterError, TangentWeights, UnknownKind,
};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_solve::{BlockMatrix, Pattern};

use super::battery::{Setting, assert_force, direction, dot, multiply, stepper, stepper_of, world};
use super::*;
use crate::solids::{Quadrature, Section, SolidDescription, Viscosity};

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
    Link::new(a, b, rest_length)
}

fn consistent_mass() -> Mass {
    let mut mass = Mass::new(5);
    mass.diagonal.copy_from_slice(&[1.0, 2.0, 0.5, 0.0, 3.0]);
    mass.couplings = vec![(0, 1, 0.3), (1, 4, 0.1)];
    mass
}

fn led(formula: &str) -> Option<Arc<dyn Motion>> {
    Some(Arc::new(FormulaVector::compile(formula).unwrap()))
}

fn pushed() -> RigidMotion {
    RigidMotion { translation: led("[0.3 * sin(t), t^2, 0]"), ..RigidMotion::default() }
}

fn turning() -> RigidMotion {
    let rotation = led("[t, 0.5 * t^2, sin(3 * t)]");
    RigidMotion { rotation, pivot: Vec3::new(0.1, 0.0, -0.4), ..pushed() }
}

/// Every load of this room, with and without what it has a choice of.
fn table() -> Vec<(&'static str, Box<dyn Force>)> {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 5);
    let mass = consistent_mass();
    let shares = vec![(1, 0.25), (3, 0.75)];
    let gravity = Gravity::new("gravity", Vec3::new(0.0, -9.81, 1.0), &mass, &kinematics).unwrap();
    let shaken = Formula::compile_vector("[sin(t), -9.81, t^2]", &TIME_VARIABLES).unwrap();
    let mut all: Vec<(&str, Box<dyn Force>)> = vec![
        ("gravity", Box::new(gravity)),
        ("varying gravity", Box::new(Gravity::varying("gravity", shaken, &mass, &kinematics))),
        ("mass damping", Box::new(MassDamping::new("damping", mass, 0.7).unwrap())),
        ("drag", Box::new(Drag::new("drag", shares.clone(), 2.0).unwrap())),
    ];
    for (name, motion) in [("pushed frame", pushed()), ("turning frame", turning())] {
        let frame = MovingFrame::new(motion, 0.01);
        all.push((name, Box::new(FictitiousForce::new("frame", frame, &consistent_mass(), &kinematics))));
    }
    let fields: [(&str, Arc<dyn ForceField>); 3] = [
        ("uniform load", Arc::new(UniformForce(Vec3::X))),
        ("load by time", Arc::new(FormulaVector::compile("[1, sin(t), -2]").unwrap())),
        ("load by place", Arc::new(FormulaVector::compile("[-y * t, x + z^2, 1 + x * y]").unwrap())),
    ];
    for (name, field) in fields {
        all.push((name, Box::new(PointLoad::new("load", shares.clone(), field).unwrap())));
    }
    for (is_damped, damping) in [(false, 0.0), (true, 3.0)] {
        let name = |plain, damped| if is_damped { damped } else { plain };
        let spring = |row, share| GroundSpring { row, share, anchor: Vec3::new(0.1, 0.2, 0.3) };
        let springs = vec![spring(0, 1.0), spring(3, 0.5)];
        all.push((
            name("ground springs", "damped ground springs"),
            Box::new(GroundSprings::new("ground", springs, 40.0, damping).unwrap()),
        ));
        all.push((
            name("hand", "damped hand"),
            Box::new(Hand::new(
                0,
                Grip { place: Vec3::Y, ..Grip::on(&[1, 4], &velocities(), 25.0, damping) },
            )),
        ));
        for (rest_length, plain, damped) in [
            (0.0, "attachment", "damped attachment"),
            (0.4, "stretched attachment", "damped stretched attachment"),
            (2.5, "pressed attachment", "damped pressed attachment"),
        ] {
            let links = Attachments::new("attachment", vec![link(rest_length)], 30.0, damping).unwrap();
            all.push((name(plain, damped), Box::new(links)));
        }
    }
    all
}

/// Force and energy, differential and blocks, symmetry, net force and heat of every load, as far as each declares them.
#[test]
fn battery_of_every_load() {
    for (name, force) in table() {
        println!("{name}");
        assert_in_motion(force.as_ref());
    }
}

/// Faces of a pyramid of five rows, nothing planar or regular about it: a quadrilateral below, four triangles above it.
fn pyramid() -> (Vec<PressedFace>, Vec<Vec3>) {
    let face = |rows: &[u32]| {
        let kind = if rows.len() == 3 { ElementKind::Tri3 } else { ElementKind::Quad4 };
        PressedFace::new(kind, rows).unwrap()
    };
    let faces =
        vec![face(&[0, 3, 2, 1]), face(&[0, 1, 4]), face(&[1, 2, 4]), face(&[2, 3, 4]), face(&[3, 0, 4])];
    let corners = [[0.0, 0.0, 0.1], [1.2, 0.1, 0.0], [1.0, 0.9, -0.2], [-0.1, 1.0, 0.0], [0.4, 0.5, 1.3]];
    (faces, corners.map(Vec3::from_array).to_vec())
}

/// Pressure that follows its faces: with an energy over a closed surface, without one over an open patch or where
/// it varies; tangents exact in each case.
#[test]
fn pressure_agrees_with_energy_and_derivatives() {
    let formula = |text: &str| Formula::compile(text, &VARIABLES).unwrap();
    let (closed, positions) = pyramid();
    for (faces, text, has_energy) in [
        (closed.clone(), "3", true),
        (closed.clone(), "2 + t", true),
        (closed.clone(), "1 + x * y - z", false),
        (closed[1..].to_vec(), "3", false),
    ] {
        let pressure = Pressure::new("pressure", faces, formula(text)).unwrap();
        assert_eq!(pressure.declaration().conservative, has_energy, "{text}");
        assert_force(&pressure, &Setting::new(&pressure, positions.clone(), velocities()));
    }
}

/// What stands in for an unsymmetric tangent is its symmetric part: `x·S y = (x·K y + y·K x)/2`, the same either way round.
#[test]
fn symmetric_blocks_are_the_symmetric_part() {
    let (faces, corners) = pyramid();
    let varying = Formula::compile("1 + x * y - z", &VARIABLES).unwrap();
    let field = FormulaVector::compile("[-y * t, x + z^2, 1 + x * y]").unwrap();
    let mesh = Mesh::new(corners.clone(), ElementKind::Pyramid5, vec![0, 1, 2, 3, 4]);
    let description = SolidDescription {
        name: "viscosity".to_owned(),
        mesh: &mesh,
        first_row: 0,
        materials: &[],
        material_of_cell: &[0],
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Solid,
    };
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 5);
    let frame = MovingFrame::new(turning(), 0.01);
    let forces: [Box<dyn Force>; 6] = [
        Box::new(FictitiousForce::new("frame", frame, &consistent_mass(), &kinematics)),
        Box::new(Viscosity::new(&description, 0.8).unwrap()),
        Box::new(Attachments::new("damped", vec![link(0.7)], 30.0, 4.0).unwrap()),
        Box::new(Pressure::new("open", faces[1..].to_vec(), Formula::constant(3.0)).unwrap()),
        Box::new(Pressure::new("varying", faces, varying).unwrap()),
        Box::new(PointLoad::new("by place", vec![(1, 0.25), (3, 0.75)], Arc::new(field)).unwrap()),
    ];
    for force in forces {
        assert!(!force.declaration().symmetric_tangent);
        let setting = Setting::new(force.as_ref(), corners.clone(), velocities());
        let pattern =
            Arc::new(Pattern::from_cliques(5, [[0, 1, 2, 3, 4]].iter().map(|all| &all[..])).unwrap());
        let weights = TangentWeights { position: -0.7, velocity: -2.0 };
        let mut scratch = force.new_scratch();
        let mut exact = BlockMatrix::zeros(pattern.clone());
        force.add_blocks(&setting.at(), weights, &mut scratch, &mut exact);
        let mut symmetric = BlockMatrix::zeros(pattern);
        force.add_symmetric_blocks(&setting.at(), weights, &mut scratch, &mut symmetric);
        let (x, y) = (direction(5, 0.1), direction(5, 0.9));
        let form = |matrix: &BlockMatrix, a: &[Vec3], b: &[Vec3]| dot(a, &multiply(matrix, b));
        let expected = 0.5 * (form(&exact, &x, &y) + form(&exact, &y, &x));
        for (a, b) in [(&x, &y), (&y, &x)] {
            // some hundred terms, each of the size of the largest entry
            let size = 1e-14 * exact.values().iter().map(|block| block.largest_entry()).fold(0.0, f64::max);
            let error = (form(&symmetric, a, b) - expected).abs();
            assert!(error <= size * 100.0, "{}: {error:e}", force.name());
        }
        assert!(
            (form(&exact, &x, &y) - form(&exact, &y, &x)).abs() > 1e-3 * expected.abs(),
            "{}",
            force.name()
        );
    }
}

/// The work against a constant pressure is `p ΔV`, and it neither pushes nor turns the body as a whole.
#[test]
fn pressure_works_by_volume() {
    let (faces, positions) = pyramid();
    let pressure = Pressure::new("pressure", faces, Formula::constant(4.0)).unwrap();
    let setting = Setting::new(&pressure, positions.clone(), velocities());
    let force = setting.force(&pressure);
    let net: Vec3 = force.iter().copied().sum();
    let torque: Vec3 = force.iter().zip(&positions).map(|(f, x)| x.cross(*f)).sum();
    // some tens of terms of the force's size
    assert!(net.length() < 1e-14 && torque.length() < 1e-14, "{net:?} {torque:?}");
    let grown = positions.iter().map(|x| *x * 1.1).collect();
    let grown = Setting::new(&pressure, grown, velocities());
    let work = grown.stored(&pressure) - setting.stored(&pressure);
    // 6 V of the pyramid's tetrahedra over the diagonal from 0 to 2, which the bilinear base halves exactly between
    // its two ways of being cut; the setting acts with a load of 0.75
    let volume = |a: usize, b: usize, c: usize, d: usize| {
        let [a, b, c, d] = [a, b, c, d].map(|corner: usize| positions[corner]);
        (b - a).cross(c - a).dot(d - a) / 6.0
    };
    let one_way = volume(0, 1, 2, 4) + volume(0, 2, 3, 4);
    let other_way = volume(0, 1, 3, 4) + volume(1, 2, 3, 4);
    let expected = 0.75 * 4.0 * 0.5 * (one_way + other_way) * (1.1_f64.powi(3) - 1.0);
    assert!((work / expected - 1.0).abs() < 1e-14, "{work} {expected}");
}

/// Surface elements of every kind are faces, and a flat one bears its area times the pressure.
#[test]
fn faces_of_every_kind_are_pressed() {
    for kind in ElementKind::ALL.iter().copied().filter(|kind| kind.dimension() == 2) {
        let positions = kind.regular();
        let rows: Vec<u32> = (0..).take(positions.len()).collect();
        let face = PressedFace::new(kind, &rows).unwrap();
        let pressure = Pressure::new("pressure", vec![face], Formula::constant(4.0)).unwrap();
        let setting = Setting::new(&pressure, positions.clone(), vec![Vec3::ZERO; positions.len()]);
        let net: Vec3 = setting.force(&pressure).into_iter().sum();
        let corners = &positions[..kind.corner_count()];
        let area = 0.5
            * (0..corners.len()).map(|at| corners[at].cross(corners[(at + 1) % corners.len()])).sum::<Vec3>();
        // the setting acts with a load of 0.75
        assert!((net + area * (0.75 * 4.0)).length() < 1e-14 * area.length(), "{}: {net:?}", kind.name());
    }
}

/// The weight is the sum of all entries of the mass matrix times `g`, consistent or lumped.
#[test]
fn total_weight() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 5);
    let gravity =
        Gravity::new("gravity", Vec3::new(0.0, -10.0, 0.0), &consistent_mass(), &kinematics).unwrap();
    assert!((gravity.total(0.0) - Vec3::new(0.0, -73.0, 0.0)).length() < 1e-13);
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
    let same = Link::new(Combination::row(0), Combination::row(1), 1.0);
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

/// What a point feels in a frame is what its path in the world at rest says: `f = m (ẍ - Rᵀ Ẍ)` for any path `x(t)` in the
/// frame and `X = o + R (x - p)` outside of it.
#[test]
fn frames_press_as_paths_bend() {
    let (motion, time) = (turning(), 0.3);
    let path = FormulaVector::compile("[0.4 * t^3 - 1, cos(2 * t), 0.5 + t^2]").unwrap();
    let in_frame = |time: f64| path.value(Vec3::ZERO, time);
    let outside = |time: f64| motion.pose(time).to_world(in_frame(time));
    // ÿ = (-y₊₂ + 16 y₊₁ - 30 y + 16 y₋₁ - y₋₂) / 12 s²
    let step = 1e-3;
    let second = |y: &dyn Fn(f64) -> Vec3| {
        let at = |steps: f64| y(time + steps * step);
        ((at(1.0) + at(-1.0)) * 16.0 - (at(2.0) + at(-2.0)) - at(0.0) * 30.0) * (1.0 / (12.0 * step * step))
    };
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 1);
    let mass = Mass { diagonal: vec![2.5], couplings: vec![] };
    let frame = FictitiousForce::new("frame", MovingFrame::new(motion.clone(), 0.01), &mass, &kinematics);
    let velocity = path.velocity(Vec3::ZERO, time);
    let setting = Setting::new(&frame, vec![in_frame(time)], vec![velocity]);
    assert_eq!(setting.time, time);
    // the setting acts with a load of 0.75
    let felt = setting.force(&frame)[0] * (1.0 / 0.75);
    let expected =
        (second(&in_frame) - motion.pose(time).direction_to_shape(second(&outside))) * mass.diagonal[0];
    // a turn at 3 rad/s whose rate swings at 3 rad/s, and the path: sixth derivatives are below 8⁶; error step⁴/90 of them, and
    // rounding of 60 ε/12 step²
    let bound = 8_f64.powi(6) * step.powi(4) / 90.0 + 5.0 * f64::EPSILON / step.powi(2);
    let error = (felt - expected).length();
    assert!(error < mass.diagonal[0] * bound, "{error:e}");
    assert!(expected.length() > 1.0);
}

/// A motion that is not known before the start presses from the start on: `x = t^2.5` by `-m 3.75 √t`.
#[test]
fn frames_begin_at_the_start() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 1);
    let mass = Mass { diagonal: vec![2.0], couplings: vec![] };
    let motion = RigidMotion { translation: led("[t^2.5, 0, 0]"), ..pushed() };
    let timestep = 0.01;
    let frame = FictitiousForce::new("frame", MovingFrame::new(motion, timestep), &mass, &kinematics);
    for time in [0.0, 0.5 * timestep, 1.0] {
        let at = Setting { time, ..Setting::new(&frame, vec![Vec3::ZERO], vec![Vec3::ZERO]) };
        let felt = at.force(&frame)[0].x / 0.75;
        let part = 0.01 * timestep;
        let reach = if time == 0.0 {
            // where 2.5 t^1.5 has no second derivative, the differences see its slope up to four hundredths of a step
            3.75 * (4.0 * part).sqrt()
        } else {
            // δ⁴/30 of its fifth derivative, 3.52 t^-3.5, and rounding
            part.powi(4) / 30.0 * 3.52 * (time - 2.0 * part).powf(-3.5) + 2.0 * f64::EPSILON * 2.5 / part
        };
        assert!(
            (felt + mass.diagonal[0] * 3.75 * time.sqrt()).abs() < mass.diagonal[0] * reach,
            "{time}: {felt}"
        );
    }
}

/// Gravity keeps its direction in the world at rest: a frame that turns by a right angle sees it turn back.
#[test]
fn gravity_seen_from_a_frame() {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 1);
    let mass = Mass { diagonal: vec![1.0], couplings: vec![] };
    let motion = RigidMotion { rotation: led("[0, 0, pi / 2 * t]"), ..pushed() };
    let gravity = Gravity::new("gravity", Vec3::new(0.0, -10.0, 0.0), &mass, &kinematics).unwrap();
    let seen = gravity.seen_from(MovingFrame::new(motion, 0.01)).total(1.0);
    assert!((seen - Vec3::new(-10.0, 0.0, 0.0)).length() < 1e-14, "{seen:?}");
}

/// The velocity of a motion is the derivative of its offset.
#[test]
fn motions_agree_with_their_velocities() {
    let offsets = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1.0, 0.0), Vec3::Z];
    let keys =
        |interpolation| KeyFrames::new(vec![0.0, 0.5, 0.7, 2.0], offsets.clone(), interpolation).unwrap();
    let carried = RigidMotion { rotation: led("[t, 0.5 * t^2, -0.2]"), ..turning() };
    let motions: [&dyn Motion; 4] = [
        &carried,
        &keys(Interpolation::Linear),
        &keys(Interpolation::Smooth),
        &FormulaVector::compile("[0.1 * sin(2 * pi * t), x * t^2, if(t > 1, 1, t)]").unwrap(),
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

/// What two keys hold is held, and a smooth motion stays between the keys around it.
#[test]
fn smooth_motions_do_not_overshoot() {
    let times = vec![0.0, 0.1, 0.5, 1.0, 1.3, 1.35];
    let heights = [0.0, 0.0, -0.03, -0.03, 0.01, 0.04];
    let offsets = heights.map(|z| Vec3::new(0.0, 1.0 - z, z)).to_vec();
    let keys = KeyFrames::new(times.clone(), offsets, Interpolation::Smooth).unwrap();
    for (stretch, ends) in times.windows(2).enumerate() {
        let (low, high) =
            (heights[stretch].min(heights[stretch + 1]), heights[stretch].max(heights[stretch + 1]));
        for part in 0..=100 {
            let time = ends[0] + (ends[1] - ends[0]) * f64::from(part) / 100.0;
            let [_, y, z] = keys.offset(Vec3::ZERO, time).to_array();
            // sums of a few terms below 1, each to half a unit of its last digit
            assert!((low - 1e-15..=high + 1e-15).contains(&z), "{z} at {time}");
            assert!((y - (1.0 - z)).abs() < 1e-15, "{y} and {z} at {time}");
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
    let shares = vec![(0, 1.0)];
    let mut drag = Drag::new("drag", shares, 1.0).unwrap();
    let Editable { name, value, .. } = drag.editable()[0].clone();
    assert_eq!(value, 1.0);
    drag.set_parameter(name, 2.0).unwrap();
    assert_eq!(drag.editable()[0].value, 2.0);
    assert!(matches!(drag.set_parameter(name, -1.0), Err(ParameterError::Unfit { .. })));
    assert!(matches!(drag.set_parameter("target", 1.0), Err(ParameterError::Unknown { .. })));
    let wrong = Gravity::new("gravity", Vec3::new(f64::NAN, 0.0, 0.0), &Mass::new(0), &Kinematics::default());
    assert!(wrong.is_err());
}
