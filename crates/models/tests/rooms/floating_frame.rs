//! A floating frame with modes: masses between rows of modes, the tangent of an implicit step, and what free bodies keep (JIM-97, PA-19).

use souple_engine::implicit::NewtonSettings;
use souple_engine::linear::{Method, SolverSettings};
use souple_engine::steppers::{BackwardEuler, NewtonMode};
use souple_engine::{
    Configuration, Constraint, Edit, Force, KeptRef, Kinematics, Mass, Stepper, System, TangentWeights,
    UnknownKind, World,
};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::materials;
use souple_models::reduced::{Coupling, ModalBasis, ModalDamping, ModalStiffness};
use souple_models::solids::SolidDescription;
use souple_table::{Value, Values};

use super::{stepper, world};

/// Modes of the body below, one more than a block holds.
const MODES: usize = 4;
const EIGENVALUES: [f64; MODES] = [40.0, 90.0, 150.0, 400.0];

fn cube() -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([1.0; 3]))
        .with("cells", Value::Vector([1.0; 3]))
        .with("element", Value::Text("hex8"));
    souple_mesh::generate("box", values).expect("a box")
}

/// Corners of a cube about its middle, unlike in mass, with smooth shapes that are no modes of anything: no coupling is left out by chance.
fn basis(mesh: &Mesh) -> ModalBasis {
    let shape = |mode: usize| {
        let at = |x: &Vec3| {
            let m = mode as f64 + 1.0;
            Vec3::new((m * x.y + 0.3).sin(), (x.x * x.z - 0.4 * m).cos(), x.x - m * x.y * x.z) * 0.4
        };
        mesh.points.iter().map(at).collect()
    };
    let shapes = (0..MODES).map(shape).collect();
    ModalBasis::new(Vec3::new(0.5, 0.5, 0.5), &mesh.points, shapes, EIGENVALUES.to_vec())
}

fn masses() -> Mass {
    let mut mass = Mass::new(8);
    (0..8).for_each(|point| mass.add(point, point, 1.0 + 0.2 * f64::from(point)));
    mass.add(0, 7, 0.1);
    mass.seal();
    mass
}

/// A system of that body alone, free, and its configuration with its modes swung out.
fn body(stepper: Box<dyn Stepper>, damping: f64) -> (System, Vec<Vec3>) {
    let mesh = cube();
    let basis = basis(&mesh);
    let kind = UnknownKind::FloatingFrame { modes: MODES as u32 };
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(kind, 1);
    let mut mass = Mass::new(kinematics.row_count());
    basis.add_mass(&masses(), Coupling::All, 0, &mut mass);
    mass.seal();
    let entry = materials::TABLE.find("linear").expect("a law");
    let values = Values::new()
        .with("youngs_modulus", Value::Number(1e4))
        .with("poissons_ratio", Value::Number(0.3))
        .with("density", Value::Number(1000.0));
    let material = (entry.build)(&entry.values(values).expect("numbers")).expect("a material");
    let description = SolidDescription {
        name: "cube.material".into(),
        mesh: &mesh,
        first_row: kinematics.row_count(),
        materials: &[material],
        material_of_cell: &[0],
        axes: &[],
        quadrature: Default::default(),
        section: Default::default(),
    };
    let stiffness = ModalStiffness::new(&description, 0, &EIGENVALUES).expect("cells with volume");
    let mut forces: Vec<Box<dyn Force>> = vec![Box::new(stiffness)];
    if damping > 0.0 {
        forces.push(Box::new(ModalDamping::new("cube.damping".into(), 0, &EIGENVALUES, damping, 0.02)));
    }
    let idle = |part: usize| kind.idle_components(part);
    let constraints = (0..kind.block_count())
        .filter(|part| idle(*part).contains(&true))
        .map(|part| Constraint::partial(part as u32, Vec3::ZERO, idle(part).map(|idle| !idle)))
        .collect();
    let name = "main".into();
    let system = System { name, kinematics, mass, forces, constraints, stepper, steps_per_period: 1 };
    let mut q = vec![basis.centre];
    q.extend(Vec3::AXES);
    [0.3, -0.2, 0.1, 0.15].iter().for_each(|u| q.extend(Vec3::AXES.map(|axis| axis * *u)));
    (system, q)
}

/// Sends it off, tumbling.
fn thrown(of: (System, Vec<Vec3>), period: f64) -> World {
    let mut world = world(of, period);
    let velocities = [Vec3::new(0.2, 0.0, -0.1), Vec3::new(1.0, -2.0, 3.0), Vec3::new(0.5, -0.3, 0.2)];
    for (block, velocity) in (0..).zip(velocities) {
        world.edit(Edit::SetVelocity { system: 0, block, velocity }).expect("a block");
    }
    world
}

/// The kinetic energy over rows of the frame and its modes is that of the points, wherever they are.
#[test]
fn masses_between_rows_are_those_of_the_points() {
    let (system, q) = body(stepper("rk4"), 0.0);
    let (basis, of_points) = (basis(&cube()), masses());
    let v: Vec<Vec3> = (0..4).map(|i| Vec3::new(0.3 * f64::from(i), 1.0, -0.2)).collect();
    let mut rows = vec![Vec3::ZERO; system.kinematics.row_count()];
    system.kinematics.velocities_into(&q, &v, &mut rows);
    let velocity = |point| basis.weights(point).zip(&rows).map(|(weight, row)| *row * weight).sum();
    let velocities: Vec<Vec3> = (0..8).map(velocity).collect();
    let (of_rows, of_points) = (system.mass.kinetic_energy(&rows), of_points.kinetic_energy(&velocities));
    // sums of some hundred products
    assert!((of_rows - of_points).abs() < 1e-13 * of_points, "{of_rows} {of_points}");
}

/// Where the frame stays, the masses that count grow with the number of modes, and not with its square.
#[test]
fn masses_of_held_modes_grow_with_their_number() {
    let entries = |coupling| {
        let mut mass = Mass::new(4 + 3 * MODES);
        basis(&cube()).add_mass(&masses(), coupling, 0, &mut mass);
        mass.seal();
        mass.couplings.len()
    };
    // four rows of the frame with all, three rows of each mode with each other
    assert_eq!(entries(Coupling::OfOneMode), 6 + MODES * (12 + 3));
    assert_eq!(entries(Coupling::All), (4 + 3 * MODES) * (3 + 3 * MODES) / 2);
}

fn view<'a>(positions: &'a [Vec3], velocities: &'a [Vec3]) -> Configuration<'a> {
    Configuration {
        positions,
        velocities,
        time: 0.0,
        load: 1.0,
        memory: &[0.0],
        pairs: &[],
        kept: KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

/// The force of dampers is what its differential and its blocks say, along axes and modes alike.
#[test]
fn dampers_know_their_derivatives() {
    let damping = ModalDamping::new("damping".into(), 0, &EIGENVALUES, 0.01, 0.1);
    let number = |i: usize, phase: f64| (1.3 * i as f64 + phase).sin();
    let rows = |phase: f64| -> Vec<Vec3> {
        (0..16)
            .map(|i| Vec3::new(number(3 * i, phase), number(3 * i + 1, phase), number(3 * i + 2, phase)))
            .collect()
    };
    let (x, v, dx, dv) = (rows(0.1), rows(0.7), rows(1.9), rows(2.3));
    let mut scratch = damping.new_scratch();
    let step = 1e-5;
    let moved = |a: &[Vec3], b: &[Vec3], by: f64| -> Vec<Vec3> {
        a.iter().zip(b).map(|(a, b)| *a + *b * by).collect()
    };
    let mut force_at = |by: f64| {
        let (x, v) = (moved(&x, &dx, by), moved(&v, &dv, by));
        let mut out = vec![Vec3::ZERO; 16];
        damping.add_force(&view(&x, &v), &mut scratch, &mut out);
        out
    };
    let (plus, minus) = (force_at(step), force_at(-step));
    let (mut exact, mut scratch) = (vec![Vec3::ZERO; 16], damping.new_scratch());
    for (delta, weights) in [
        (&dx, TangentWeights { position: 1.0, velocity: 0.0 }),
        (&dv, TangentWeights { position: 0.0, velocity: 1.0 }),
    ] {
        damping.add_differential(&view(&x, &v), weights, delta, &mut scratch, &mut exact);
    }
    for ((plus, minus), exact) in plus.iter().zip(&minus).zip(&exact) {
        // a cubic: the square of the step times its third derivative, of order ten
        assert!(((*plus - *minus) * (0.5 / step) - *exact).length() < 1e-8);
    }
}

/// The whole matrix of a step, with what turning and swinging do to each other and with dampers, is the derivative of its residual: of
/// one Newton run each residual is at most a constant times the square of the last.
#[test]
fn residuals_of_floating_frames_square() {
    let residual_after = |iterations: u32| {
        let solver = SolverSettings { method: Method::Gmres, tolerance: 1e-14, ..SolverSettings::default() };
        let settings = NewtonSettings { tolerance: 1e-30, max_iterations: iterations };
        let stepper = Box::new(BackwardEuler { newton: NewtonMode::Full(settings), solver });
        let mut world = thrown(body(stepper, 0.01), 0.05);
        let error = world.step().expect_err("no residual is that small");
        let souple_engine::StepError::NewtonStalled { residual, .. } = error.error else { panic!("{error}") };
        residual
    };
    let last: Vec<f64> = (1..=4).map(residual_after).collect();
    // as in `frame_and_tets`
    let constant = last[2] / (last[1] * last[1]);
    assert!(last[3] <= 10.0 * constant * last[2] * last[2] + 1e-13, "{last:?}");
    assert!(last[1] < 0.1 && last[2] < 1e-3, "{last:?}");
}

/// A free body keeps momentum, angular momentum and energy to the second order of Runge and Kutta's steps of rotations: what drifts falls
/// by four when steps are halved. Its frame is not at its centre and its shapes are no modes, so that nothing is kept for another reason.
#[test]
fn free_bodies_keep_what_they_have() {
    let drift = |steps: usize| {
        let mut world = thrown(body(stepper("rk4"), 0.0), 0.1 / steps as f64);
        let kept = |world: &mut World| {
            world.with_system(0, |system, state, around, ws| {
                system.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
                let (linear, angular) = system.momentum(&ws.rows);
                let at = system.view(0, &ws.rows, state, around);
                let stored = system.forces[0].energy(&at, &mut ws.scratches[0]).stored;
                (linear, angular, system.kinetic_energy(&ws.rows) + stored)
            })
        };
        let before = kept(&mut world);
        (0..steps).for_each(|_| world.step().expect("a step"));
        let after = kept(&mut world);
        [
            (after.0 - before.0).length() / before.0.length(),
            (after.1 - before.1).length() / before.1.length(),
            (after.2 - before.2).abs() / before.2,
        ]
    };
    let (coarse, fine) = (drift(100), drift(200));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        let order = (coarse / fine).log2();
        assert!(*fine < 1e-4 && order > 1.8, "{coarse:.2e} {fine:.2e}: {order:.2}");
    }
}
