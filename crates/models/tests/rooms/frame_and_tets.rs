//! (a) A rigid frame carries one face of a tetrahedral block; both are unknowns of one backward Euler step.

use souple_engine::implicit::NewtonSettings;
use souple_engine::linear::{Method, SolverSettings};
use souple_engine::steppers::{BackwardEuler, NewtonMode};
use souple_engine::{DerivedRow, Feedback, Kinematics, Mass, System, UnknownKind};
use souple_math::{Vec3, exponential};
use souple_mesh::{ElementKind, Mesh};
use souple_models::materials;
use souple_models::solids::{SolidDescription, SolidForce};
use souple_table::{Value, Values};

use super::forces::Push;
use super::world;

/// One cube of five tetrahedra: corners 0..4 (x = 0) are free points, 4..8 (x = 1) ride on the frame.
fn cube() -> Mesh {
    let corner = |i: usize| Vec3::new((i / 4) as f64, (i / 2 % 2) as f64, (i % 2) as f64);
    let points = (0..8).map(corner).collect();
    let nodes = vec![0, 4, 2, 1, 6, 2, 4, 7, 5, 4, 1, 7, 3, 1, 2, 7, 1, 4, 2, 7];
    let mut mesh = Mesh::new(points, ElementKind::Tet4, nodes);
    mesh.validate().unwrap();
    mesh
}

/// Rows: 4 free points, 4 rows of the frame, 4 corners hung on the frame: `x = origin + Σ l_k axis_k`.
fn system(tolerance: f64) -> (System, Vec<Vec3>) {
    let mesh = cube();
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 4);
    kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
    let origin = Vec3::new(1.2, 0.5, 0.5);
    for corner in &mesh.points[4..] {
        let local = *corner - origin;
        let parents = vec![(4, 1.0), (5, local.x), (6, local.y), (7, local.z)];
        kinematics.add_derived_row(DerivedRow { parents, feedback: Feedback::Transpose }).unwrap();
    }
    // the body's points are rows 0..4 and 8..12: two meshes' worth of rows for one body, renumbered
    let renumbered = |node: u32| if node < 4 { node } else { node + 4 };
    let mut points = mesh.points[..4].to_vec();
    points.extend([origin; 4]);
    points.extend_from_slice(&mesh.points[4..]);
    let nodes = mesh.blocks[0].nodes.iter().map(|node| renumbered(*node)).collect();
    let rest = Mesh::new(points, ElementKind::Tet4, nodes);
    let entry = materials::TABLE.find("neo_hookean").unwrap();
    let values = Values::new()
        .with("youngs_modulus", Value::Number(1e4))
        .with("poissons_ratio", Value::Number(0.3))
        .with("density", Value::Number(1000.0));
    let material = (entry.build)(&entry.values(values).unwrap()).unwrap();
    let description = SolidDescription {
        name: "cube".into(),
        mesh: &rest,
        first_row: 0,
        materials: &[material],
        material_of_cell: &[0; 5],
        axes: &[],
        quadrature: Default::default(),
        section: Default::default(),
    };
    let force = SolidForce::new(&description).unwrap();
    let mut mass = Mass::new(kinematics.row_count());
    for row in [0, 1, 2, 3, 8, 9, 10, 11] {
        mass.diagonal[row] = 1.0;
    }
    mass.diagonal[4] = 2.0;
    let solver = SolverSettings { method: Method::Gmres, tolerance: 1e-13, ..SolverSettings::default() };
    let newton = NewtonMode::Full(NewtonSettings { tolerance, max_iterations: 20 });
    let push = Push { row: 9, force: Vec3::new(0.0, 300.0, 200.0) };
    let stepper = Box::new(BackwardEuler { newton, solver });
    let forces: Vec<Box<dyn souple_engine::Force>> = vec![Box::new(force), Box::new(push)];
    let name = "main".into();
    let system = System { name, kinematics, mass, forces, constraints: vec![], stepper, steps_per_period: 1 };
    let mut q = mesh.points[..4].to_vec();
    q.push(origin);
    q.extend(Vec3::AXES);
    (system, q)
}

/// Near the solution the number of right digits doubles: the error after each Newton iteration is bounded by
/// a constant times the square of the one before.
#[test]
fn newton_is_quadratic_for_a_rigid_frame_with_tetrahedra() {
    // looser and looser tolerances stop the same iteration earlier and earlier
    let solution = |tolerance: f64| {
        let (system, q) = system(tolerance);
        let mut world = world((system, q), 0.05);
        // start spinning, so that the bias of the frame's inertia takes part
        world
            .edit(souple_engine::Edit::SetVelocity {
                system: 0,
                block: 5,
                velocity: Vec3::new(1.0, -2.0, 3.0),
            })
            .unwrap();
        for _ in 0..3 {
            world.step().unwrap();
        }
        (world.state().systems[0].q.clone(), *world.last_report())
    };
    let (converged, report) = solution(1e-12);
    assert!(report.newton_iterations <= 6, "{report:?}");
    let frame = souple_math::Mat3::from_columns(converged[5], converged[6], converged[7]);
    let error = frame.transpose_mul(&frame) - souple_math::Mat3::IDENTITY;
    assert!(error.largest_entry() < 1e-14, "the frame stays a rotation");
    assert!((frame - exponential(Vec3::ZERO)).largest_entry() > 0.05, "the frame has turned");
}

/// The whole matrix of the step, geometric terms and turning inertia included, is the derivative of its
/// residual: shown by the residuals of one Newton run, each at most a constant times the square of the last.
#[test]
fn residuals_square() {
    let mut last = Vec::new();
    for iterations in 1..=4 {
        let (mut system, q) = system(1e-12);
        let solver = SolverSettings { method: Method::Gmres, tolerance: 1e-14, ..SolverSettings::default() };
        let settings = NewtonSettings { tolerance: 1e-30, max_iterations: iterations };
        system.stepper = Box::new(BackwardEuler { newton: NewtonMode::Full(settings), solver });
        let mut world = world((system, q), 0.05);
        world
            .edit(souple_engine::Edit::SetVelocity {
                system: 0,
                block: 5,
                velocity: Vec3::new(1.0, -2.0, 3.0),
            })
            .unwrap();
        let error = world.step().unwrap_err();
        let souple_engine::StepError::NewtonStalled { residual, .. } = error.error else { panic!("{error}") };
        last.push(residual);
    }
    // e₄ ≤ C e₃² and e₃ ≤ C e₂² with one constant, which the first, far from the solution, does not know; linear
    // solves as exact as the square of the residual have their part in it, and rounding ends it at 1e-13
    let constant = last[2] / (last[1] * last[1]);
    assert!(last[3] <= 10.0 * constant * last[2] * last[2] + 1e-13, "{last:?}");
    assert!(last[1] < 0.1 && last[2] < 1e-3, "{last:?}");
}
