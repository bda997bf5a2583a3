//! Implicit steps of solids: traces of independent codes, bits, equilibrium, prescribed motion, indefinite tangents.

use std::sync::Arc;

use souple_engine::implicit::NewtonSettings;
use souple_engine::linear::{Method, SolverSettings};
use souple_engine::steppers::{BackwardEuler, Bdf2, Newmark, NewtonMode, QuasiStatic, StaticEquilibrium};
use souple_engine::{
    Constraint, Force, Kinematics, Mass, Model, Motion, State, StepReport, Stepper, System, UnknownKind,
    World,
};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::loads::{Gravity, MassDamping};
use souple_models::materials;
use souple_models::solids::{SolidDescription, SolidForce, lumped_mass};
use souple_table::{Value, Values};

/// A block of one material of 1000 kg/m³ and `ν = 0.3`, clamped at `x = 0`, under gravity.
struct Block {
    size: [f64; 3],
    cells: [f64; 3],
    element: &'static str,
    law: &'static str,
    youngs_modulus: f64,
    gravity: Vec3,
    /// Rate at which motion dies away in a medium at rest [1/s].
    damping: f64,
    /// How the clamped face is led.
    motion: Option<Arc<dyn Motion>>,
    /// Whether nothing is clamped.
    is_free: bool,
}

impl Block {
    /// The bar of the reference answers, n = 3.
    fn bar(law: &'static str) -> Self {
        Self {
            size: [1.0, 0.1, 0.1],
            cells: [30.0, 3.0, 3.0],
            element: "tet4",
            law,
            youngs_modulus: 1e7,
            gravity: Vec3::Y * -9.81,
            damping: 0.0,
            motion: None,
            is_free: false,
        }
    }

    /// The cube of 1 m³ and 100 kPa, of 10 × 10 × 10 hexahedra.
    fn cube(gravity: Vec3) -> Self {
        Self {
            size: [1.0; 3],
            cells: [10.0; 3],
            element: "hex8",
            law: "st_venant_kirchhoff",
            youngs_modulus: 1e5,
            gravity,
            damping: 0.0,
            motion: None,
            is_free: false,
        }
    }

    fn mesh(&self) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector(self.size))
            .with("cells", Value::Vector(self.cells))
            .with("element", Value::Text(self.element));
        souple_mesh::generate("bar", values).unwrap()
    }

    fn world(&self, stepper: Box<dyn Stepper>, period: f64) -> World {
        self.world_from(stepper, period, |point| (point, Vec3::ZERO))
    }

    /// With positions and velocities at the start by those at rest.
    fn world_from(
        &self,
        stepper: Box<dyn Stepper>,
        period: f64,
        start: impl Fn(Vec3) -> (Vec3, Vec3),
    ) -> World {
        let mesh = self.mesh();
        let entry = materials::TABLE.find(self.law).unwrap();
        let values = Values::new()
            .with("youngs_modulus", Value::Number(self.youngs_modulus))
            .with("poissons_ratio", Value::Number(0.3))
            .with("density", Value::Number(1000.0));
        let material = (entry.build)(&entry.values(values).unwrap()).unwrap();
        let description = SolidDescription {
            name: "block.material".into(),
            mesh: &mesh,
            first_row: 0,
            materials: &[material],
            material_of_cell: &vec![0; mesh.cell_count()],
            axes: &[],
            quadrature: Default::default(),
            section: Default::default(),
        };
        let solid = SolidForce::new(&description).unwrap();
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
        let mut mass = Mass::new(mesh.points.len());
        lumped_mass(&mesh, 0, &|_| 1000.0, &mut mass);
        mass.seal();
        let gravity = Gravity::new("gravity", self.gravity, &mass, &kinematics).unwrap();
        let clamped = mesh.points.iter().enumerate().filter(|(_, point)| !self.is_free && point.x == 0.0);
        let clamp = |(block, start): (usize, &Vec3)| Constraint {
            motion: self.motion.clone(),
            ..Constraint::pin(block as u32, *start)
        };
        let constraints = clamped.map(clamp).collect();
        let mut forces: Vec<Box<dyn Force>> = vec![Box::new(solid), Box::new(gravity)];
        if self.damping > 0.0 {
            forces.push(Box::new(MassDamping::new("damping", mass.clone(), self.damping).unwrap()));
        }
        let name = "main".into();
        let system = System { name, kinematics, mass, forces, constraints, stepper, steps_per_period: 1 };
        let started = mesh.points.iter().map(|point| start(*point));
        let (positions, velocities): (Vec<Vec3>, Vec<Vec3>) = started.unzip();
        let mut started = system.initial_state(positions);
        started.v = velocities;
        let state = State { systems: vec![started], ..State::default() };
        Model { period, systems: vec![system], ..Model::default() }.start(state)
    }

    /// Displacement of the far end: the mean of its corners [m].
    fn tip(&self, world: &World) -> Vec3 {
        let rest = self.mesh().points;
        let [x, y, z] = self.size;
        let is_corner = |p: &Vec3| p.x == x && (p.y == 0.0 || p.y == y) && (p.z == 0.0 || p.z == z);
        let q = &world.state().systems[0].q;
        let corners: Vec<usize> = (0..rest.len()).filter(|&i| is_corner(&rest[i])).collect();
        assert_eq!(corners.len(), 4);
        corners.iter().map(|&i| q[i] - rest[i]).sum::<Vec3>() / 4.0
    }
}

fn solver(tolerance: f64) -> SolverSettings {
    SolverSettings { tolerance, ..SolverSettings::default() }
}

fn full(tolerance: f64) -> NewtonMode {
    NewtonMode::Full(NewtonSettings { tolerance, max_iterations: 60 })
}

fn euler(newton: NewtonMode, solver: SolverSettings) -> Box<dyn Stepper> {
    Box::new(BackwardEuler { newton, solver })
}

fn statics(tolerance: f64) -> Box<dyn Stepper> {
    let newton = NewtonSettings { tolerance, max_iterations: 100 };
    Box::new(StaticEquilibrium { load_steps: 1, newton, solver: solver(1e-10) })
}

fn bits(world: &World) -> Vec<u64> {
    let state = &world.state().systems[0];
    state.q.iter().chain(&state.v).flat_map(|row| row.to_array()).map(f64::to_bits).collect()
}

/// Steps and the tips that an independent code has after them [m].
type Trace = [(usize, [f64; 3]); 7];

fn assert_trace(law: &'static str, newton: NewtonMode, solver: SolverSettings, trace: Trace, tolerance: f64) {
    let bar = Block::bar(law);
    let mut world = bar.world(euler(newton, solver), 0.01);
    let mut taken = 0;
    for (step, expected) in trace {
        while taken < step {
            world.step().unwrap();
            taken += 1;
        }
        let expected = Vec3::from_array(expected);
        let error = (bar.tip(&world) - expected).length() / expected.length();
        assert!(error < tolerance, "{law}, step {step}: {error:e}");
    }
}

const ONE_NEWTON: Trace = [
    (1, [-1.2297579937602695e-06, -0.0010452588188865027, -1.0259684048517978e-05]),
    (2, [-6.529403039023838e-06, -0.0033388432485782636, -4.2412079693189066e-05]),
    (5, [-0.00016804493615559787, -0.019327497147434956, -7.800447685808899e-05]),
    (10, [-0.0025002820279218917, -0.06758904669664875, 0.001328667912979985]),
    (20, [-0.01578131642940623, -0.16450240938013821, 0.011413633081487316]),
    (50, [-0.0007728914002128251, -0.03717578287554728, 0.0049759994376670546]),
    (100, [-0.002618133995235091, -0.06678504848952935, 0.013325133794871834]),
];

/// One linearised solve per step gives the trace of an independent code, whatever solver does it; linear solves
/// to 1e-10 leave errors of that size.
#[test]
fn one_linearised_solve_follows_the_trace() {
    for method in [Method::Auto, Method::Cg] {
        let solver = SolverSettings { method, ..solver(1e-10) };
        assert_trace("st_venant_kirchhoff", NewtonMode::One, solver, ONE_NEWTON, 1e-8);
    }
}

/// A free bar thrown upward with one end turned inside out, whose tangent is not definite there, goes on by one solve a step, and by Newton's method
/// where that climbs, without gaining energy, and keeps its momentum: inner forces and what is turned round of their tangents have none, and a step
/// that is held back all the same loses some.
#[test]
fn what_is_inside_out_flies_on() {
    let fall = -9.81;
    let bar = Block {
        size: [1.0, 0.25, 0.25],
        cells: [8.0, 2.0, 2.0],
        law: "stable_neo_hookean",
        youngs_modulus: 1e5,
        gravity: Vec3::Y * fall,
        is_free: true,
        ..Block::bar("")
    };
    let (thrown, period) = (Vec3::new(0.0, 4.0, 0.0), 0.01);
    let fold = |point: Vec3| (point - Vec3::X * (1.6 * (point.x - 0.75).max(0.0)), thrown);
    let mut world = bar.world_from(euler(NewtonMode::One, solver(1e-10)), period, fold);
    let start = world.energy().total();
    // of 1000 kg/m³
    let mass = 62.5;
    let (mut made_definite, mut velocity) = (0, thrown);
    for _ in 1..=30 {
        world.step().unwrap();
        made_definite += world.last_report().made_definite;
        let (before, now) = (velocity + Vec3::Y * (fall * period), world.momentum().0 / mass);
        // of forces of 3 kN one solve leaves 1e-10, and Newton's method, where it goes on, a thousandth, for a step
        let StepReport { gone_on, shortened, .. } = *world.last_report();
        let left = if gone_on > 0 { 1e-3 } else { 1e-10 } * 3e3 * period / mass + 1e-8;
        // all of it, or what is left where the step was halved
        let share = if shortened > 0 { now.dot(before) / before.dot(before) } else { 1.0 };
        assert!((now - before * share).length() < left && share < 1.0 + 1e-8, "{now:?} after {before:?}");
        velocity = now;
    }
    assert!(made_definite > 0);
    assert!(world.energy().total() < start);
}

/// Newton to 1e-10 of the largest force gives the traces of an independent code converged to 1e-12 N.
#[test]
fn newton_follows_the_traces() {
    let corotational = [
        (1, [-1.7842926049393363e-06, -0.0010452609380532823, -1.0262606365962423e-05]),
        (2, [-8.899073787231561e-06, -0.0033388196669676454, -4.242112355405561e-05]),
        (5, [-0.00019181629323514955, -0.019334411230396302, -7.801075078093988e-05]),
        (10, [-0.002564036545308735, -0.06781736422475466, 0.0013444016773091374]),
        (20, [-0.015904494782426698, -0.16575024108957917, 0.011524612510030884]),
        (50, [-0.0006976079771256156, -0.03543058678411102, 0.004709421039884008]),
        (100, [-0.0025036520331420974, -0.06549727082595913, 0.013273534140188174]),
    ];
    let st_venant_kirchhoff = [
        (1, [-1.8385464463982046e-06, -0.0010452671121474627, -1.026338864998038e-05]),
        (2, [-9.218937706115664e-06, -0.003338858609521423, -4.2423927579465627e-05]),
        (5, [-0.00019484927702808038, -0.01933472390331023, -7.794942553281914e-05]),
        (10, [-0.002588433779815095, -0.06781289404269727, 0.0013455783585723735]),
        (20, [-0.016038374326076996, -0.1656504618150783, 0.011538168152461808]),
        (50, [-0.0007036497519169811, -0.035402865146190225, 0.004677670519220911]),
        (100, [-0.0025184738453492557, -0.06539372349475858, 0.013190456656043004]),
    ];
    assert_trace("corotational", full(1e-10), solver(1e-8), corotational, 1e-6);
    assert_trace("st_venant_kirchhoff", full(1e-10), solver(1e-8), st_venant_kirchhoff, 1e-6);
}

/// Products element by element give what the assembled matrix gives: the same equation, solved to 1e-10.
#[test]
fn matrix_free_agrees_with_the_matrix() {
    let bar = Block::bar("st_venant_kirchhoff");
    let tip = |matrix_free| {
        let mut world =
            bar.world(euler(NewtonMode::One, SolverSettings { matrix_free, ..solver(1e-10) }), 0.01);
        for _ in 0..5 {
            world.step().unwrap();
        }
        bar.tip(&world)
    };
    let (with, without) = (tip(false), tip(true));
    assert!((with - without).length() < 1e-8 * with.length(), "{with:?} {without:?}");
}

/// The same bits for one thread and for several, soft and stiff, assembled and by products.
#[test]
fn same_bits_for_any_thread_count() {
    let run = |threads: usize, youngs_modulus: f64, matrix_free: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let cells = [40.0, 8.0, 8.0];
            let block = Block { cells, youngs_modulus, ..Block::bar("corotational") };
            let settings = SolverSettings { matrix_free, ..solver(1e-6) };
            let mut world = block.world(euler(NewtonMode::One, settings), 2e-3);
            for _ in 0..3 {
                world.step().unwrap();
            }
            bits(&world)
        })
    };
    for (youngs_modulus, matrix_free) in [(1e3, false), (1e5, false), (1e7, false), (1e4, true)] {
        let one = run(1, youngs_modulus, matrix_free);
        assert!(one == run(2, youngs_modulus, matrix_free), "{youngs_modulus} {matrix_free}");
        assert!(one == run(5, youngs_modulus, matrix_free), "{youngs_modulus} {matrix_free}");
    }
}

/// A run resumed from its state in a new world repeats the run bit for bit: the solver's orders and patches refer
/// to a configuration that the state keeps.
#[test]
fn a_resumed_run_repeats_the_run() {
    for newton in [NewtonMode::One, full(1e-8)] {
        let make = || {
            let bar = Block { cells: [40.0, 8.0, 8.0], ..Block::bar("st_venant_kirchhoff") };
            bar.world(euler(newton, solver(1e-6)), 0.01)
        };
        let mut run = make();
        for _ in 0..3 {
            run.step().unwrap();
        }
        let mut resumed = make();
        resumed.resume(run.state().clone()).unwrap();
        for world in [&mut run, &mut resumed] {
            for _ in 0..2 {
                world.step().unwrap();
            }
        }
        assert!(bits(&run) == bits(&resumed), "{newton:?}");
    }
}

/// The same from every one of the first steps on, with patches that follow the body.
#[test]
fn a_run_resumed_at_any_step_repeats_the_run() {
    let settings = SolverSettings { method: Method::Cg, preconditioner: "rigid_modes", ..solver(1e-6) };
    let make = || {
        let bar = Block { cells: [24.0, 4.0, 4.0], youngs_modulus: 1e5, ..Block::bar("corotational") };
        bar.world(euler(NewtonMode::One, settings.clone()), 0.02)
    };
    let mut run = make();
    let mut states = Vec::new();
    for _ in 0..12 {
        run.step().unwrap();
        states.push(run.state().clone());
    }
    for (step, state) in states[..11].iter().enumerate() {
        let mut resumed = make();
        resumed.resume(state.clone()).unwrap();
        resumed.step().unwrap();
        assert!(*resumed.state() == states[step + 1], "resumed after step {}", step + 1);
    }
}

/// Once in equilibrium a static world stays where it is, to the bit.
#[test]
fn equilibrium_does_not_drift() {
    for law in ["corotational", "st_venant_kirchhoff", "neo_hookean"] {
        let mut world = Block::bar(law).world(statics(1e-8), 1.0);
        world.step().unwrap();
        let reached = bits(&world);
        for _ in 0..3 {
            world.step().unwrap();
            assert_eq!(world.last_report().newton_iterations, 0, "{law}");
        }
        assert!(reached == bits(&world), "{law}");
    }
}

/// A lift and a pull, growing with time.
#[derive(Debug)]
struct Lead;

impl Motion for Lead {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        Vec3::new(-0.3, 0.2 + start.y, 0.1) * time
    }

    fn velocity(&self, start: Vec3, _: f64) -> Vec3 {
        Vec3::new(-0.3, 0.2 + start.y, 0.1)
    }
}

/// What is led arrives exactly where it is led, and the rest is in balance there.
#[test]
fn prescribed_motion_is_reached_exactly() {
    let (newton, settings) = (full(1e-9), solver(1e-8));
    let steppers: [Box<dyn Stepper>; 6] = [
        euler(newton, settings.clone()),
        euler(NewtonMode::One, settings.clone()),
        Box::new(Bdf2 { newton, solver: settings.clone() }),
        Box::new(Newmark { beta: 0.25, gamma: 0.5, newton, solver: settings.clone() }),
        statics(1e-8),
        Box::new(QuasiStatic {
            newton: NewtonSettings { tolerance: 1e-8, max_iterations: 100 },
            solver: settings,
        }),
    ];
    for stepper in steppers {
        let name = stepper.name();
        let bar = Block { motion: Some(Arc::new(Lead)), ..Block::bar("neo_hookean") };
        let mut world = bar.world(stepper, 0.1);
        for _ in 0..3 {
            world.step().unwrap();
        }
        let rest = bar.mesh().points;
        let time = world.time();
        let q = &world.state().systems[0].q;
        for (q, start) in q.iter().zip(&rest).filter(|(_, start)| start.x == 0.0) {
            let expected = *start + Lead.offset(*start, time);
            // q + (x - q) is x to half a unit of the last place of each
            assert!((*q - expected).length() <= 4.0 * f64::EPSILON, "{name}: {q:?} {expected:?}");
        }
        assert!(world.last_report().newton_residual <= 1e-8);
        assert!(q.iter().all(|q| q.is_finite()));
    }
}

/// Full Newton converges in every step of 0.1 and 0.5 s, and in statics in one, on the soft cube hanging, standing
/// and sagging. Hanging and standing it comes to rest as in statics: backward Euler damps what the step does not
/// resolve, so that after 20 s the motion is below 1e-6 of the size. Let go from the side it swings so far that this
/// law folds it for good (so do explicit steps of 0.2 ms), unless a medium brakes it at 12 per second.
#[test]
fn the_soft_cube_converges() {
    let down = Vec3::Y * -9.81;
    let cases =
        [(Vec3::X * 9.81, 0.0, true), (Vec3::X * -9.81, 0.0, true), (down, 0.0, false), (down, 3.0, false)];
    for (gravity, damping, comes_to_rest) in cases.into_iter().chain([(down, 12.0, true)]) {
        let cube = Block { damping, ..Block::cube(gravity) };
        let mut at_rest = cube.world(statics(1e-9), 1.0);
        at_rest.step().unwrap_or_else(|error| panic!("static, {gravity:?}: {error}"));
        for h in [0.1, 0.5] {
            let mut world = cube.world(euler(full(1e-9), solver(1e-8)), h);
            for step in 0..(20.0 / h) as usize {
                world
                    .step()
                    .unwrap_or_else(|error| panic!("h = {h}, step {step}, {gravity:?}, {damping}: {error}"));
            }
            let (reached, expected) = (cube.tip(&world), cube.tip(&at_rest));
            let gap = (reached - expected).length();
            assert!(!comes_to_rest || gap < 1e-6, "h = {h}, {damping}: {reached:?} instead of {expected:?}");
        }
    }
}

/// A column of St. Venant–Kirchhoff material pressed to 0.7 of its length, where its tangent is far from positive
/// definite: Newton finds a configuration in balance.
#[test]
fn compression_beyond_stability_converges() {
    #[derive(Debug)]
    struct Press;
    impl Motion for Press {
        fn offset(&self, _: Vec3, time: f64) -> Vec3 {
            Vec3::X * (0.3 * time.min(1.0))
        }
        fn velocity(&self, _: Vec3, time: f64) -> Vec3 {
            Vec3::X * if time < 1.0 { 0.3 } else { 0.0 }
        }
    }
    let bar = Block {
        size: [1.0, 0.2, 0.2],
        cells: [15.0, 3.0, 3.0],
        youngs_modulus: 1e5,
        gravity: Vec3::Y * -1e-3,
        motion: Some(Arc::new(Press)),
        ..Block::bar("st_venant_kirchhoff")
    };
    for method in [Method::Auto, Method::Cg, Method::Direct] {
        let settings = SolverSettings { method, ..solver(1e-8) };
        let mut world = bar.world(euler(full(1e-8), settings), 0.25);
        // the far end is held, so that the column is squeezed
        for (block, _) in bar.mesh().points.iter().enumerate().filter(|(_, point)| point.x == 1.0) {
            world.edit(souple_engine::Edit::Pin { system: 0, block: block as u32 }).unwrap();
        }
        for step in 0..12 {
            world.step().unwrap_or_else(|error| panic!("{method:?}, step {step}: {error}"));
            assert!(world.last_report().newton_residual <= 1e-8);
        }
    }
}
