//! Speed of implicit steps of clamped bars under gravity, with what they had to do and how far they are from the
//! traces of independent codes: `cargo run --release --example implicit_beam [case …]`.

use std::time::Instant;

use souple_engine::implicit::NewtonSettings;
use souple_engine::linear::{Method, SolverSettings};
use souple_engine::steppers::{BackwardEuler, NewtonMode, StaticEquilibrium};
use souple_engine::{Constraint, Force, Kinematics, Mass, Model, State, Stepper, System, UnknownKind, World};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::loads::Gravity;
use souple_models::materials;
use souple_models::solids::{SolidDescription, SolidForce, lumped_mass};
use souple_table::{Value, Values};

/// A bar clamped at `x = 0`.
#[derive(Clone, Copy)]
struct Bar {
    size: [f64; 3],
    cells: [usize; 3],
    youngs_modulus: f64,
    density: f64,
    law: &'static str,
}

impl Bar {
    /// The bar of the reference answers, `10 n × n × n` cubes.
    fn reference(n: usize, law: &'static str) -> Self {
        Self { size: [1.0, 0.1, 0.1], cells: [10 * n, n, n], youngs_modulus: 1e7, density: 1000.0, law }
    }

    /// 5 kg of something soft.
    fn soft(cells: [usize; 3], law: &'static str) -> Self {
        Self { size: [1.0, 0.25, 0.25], cells, youngs_modulus: 3e4, density: 5.0 / 0.0625, law }
    }

    fn mesh(&self) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector(self.size))
            .with("cells", Value::Vector(self.cells.map(|count| count as f64)))
            .with("element", Value::Text("tet4"));
        souple_mesh::generate("bar", values).unwrap()
    }

    fn world(&self, stepper: Box<dyn Stepper>, period: f64) -> World {
        let mesh = self.mesh();
        let entry = materials::TABLE.find(self.law).unwrap();
        let values = Values::new()
            .with("youngs_modulus", Value::Number(self.youngs_modulus))
            .with("poissons_ratio", Value::Number(0.3))
            .with("density", Value::Number(self.density));
        let material = (entry.build)(&entry.values(values).unwrap()).unwrap();
        let description = SolidDescription {
            name: "bar.material".into(),
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
        lumped_mass(&mesh, 0, &|_| self.density, &mut mass);
        mass.seal();
        let gravity = Gravity::new("gravity", Vec3::Y * -9.81, &mass, &kinematics).unwrap();
        let clamped = mesh.points.iter().enumerate().filter(|(_, point)| point.x == 0.0);
        let constraints = clamped.map(|(block, start)| Constraint::pin(block as u32, *start)).collect();
        let forces: Vec<Box<dyn Force>> = vec![Box::new(solid), Box::new(gravity)];
        let name = "main".into();
        let system = System { name, kinematics, mass, forces, constraints, stepper, steps_per_period: 1 };
        let state = State { systems: vec![system.initial_state(mesh.points)], ..State::default() };
        Model { period, systems: vec![system], ..Model::default() }.start(state)
    }
}

/// Displacement of the end: the mean of its corners [m].
fn tip(world: &World, bar: &Bar) -> Vec3 {
    let rest = bar.mesh().points;
    let [x, y, z] = bar.size;
    let is_corner = |p: &Vec3| p.x == x && (p.y == 0.0 || p.y == y) && (p.z == 0.0 || p.z == z);
    let q = &world.state().systems[0].q;
    let corners: Vec<usize> = (0..rest.len()).filter(|&i| is_corner(&rest[i])).collect();
    corners.iter().map(|&i| q[i] - rest[i]).sum::<Vec3>() / corners.len() as f64
}

fn one_solve(solver: SolverSettings) -> Box<dyn Stepper> {
    Box::new(BackwardEuler { newton: NewtonMode::One, solver })
}

fn solver(tolerance: f64) -> SolverSettings {
    SolverSettings { tolerance, ..SolverSettings::default() }
}

fn load_average() -> String {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').next().unwrap_or("?").to_owned()
}

/// Memory of this process held at most [bytes].
fn peak_memory() -> usize {
    memory("VmHWM")
}

/// A line of what the system says of this process's memory [bytes].
fn memory(name: &str) -> usize {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with(name)).unwrap_or_default().to_owned();
    line.split_whitespace().nth(1).and_then(|kib| kib.parse::<usize>().ok()).unwrap_or(0) * 1024
}

/// By how much the process grows for a bar of 104k tetrahedra that steps without a stored matrix.
fn matrix_free_memory() {
    let bar = Bar::reference(12, "st_venant_kirchhoff");
    let cells = 6 * bar.cells.iter().product::<usize>();
    let before = memory("VmRSS");
    let grown = |name: &str| (memory(name) - before) / cells;
    let settings = SolverSettings { matrix_free: true, ..solver(1e-3) };
    let mut world = with_threads(1, || bar.world(one_solve(settings), 0.01));
    println!(
        "made: {} B/tet counted, {} grown, {} at the peak",
        world.bytes() / cells,
        grown("VmRSS"),
        grown("VmHWM")
    );
    with_threads(1, || (0..3).for_each(|_| world.step().unwrap()));
    println!(
        "stepped: {} B/tet counted, {} grown, {} at the peak; {} B/tet before",
        world.bytes() / cells,
        grown("VmRSS"),
        grown("VmHWM"),
        before / cells
    );
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn time_steps(name: &str, bar: Bar, threads: usize, period: f64, steps: usize, solver: SolverSettings) {
    with_threads(threads, || {
        let mut world = bar.world(one_solve(solver), period);
        let mut times = Vec::new();
        let (mut iterations, mut residual) = (0, 0.0_f64);
        // the first steps set structures up
        for _ in 0..3 {
            world.step().unwrap();
        }
        let before = world.stages();
        for _ in 0..steps {
            let clock = Instant::now();
            world.step().unwrap();
            times.push(clock.elapsed().as_secs_f64() * 1e3);
            iterations += world.last_report().linear_iterations;
            residual = residual.max(world.last_report().linear_residual);
        }
        times.sort_by(f64::total_cmp);
        let stages = world.stages();
        let stage = |now: f64, before: f64| (now - before) / steps as f64 * 1e3;
        println!(
            "{name:>16} {:<20} {threads} threads: {:8.2} ms/step (least {:.2}; mean forces {:.2}, assembly {:.2}, \
             solve {:.2}), {:.1} iterations, residual {residual:.1e}, {} B/tet, load {}",
            bar.law,
            times[steps / 2],
            times[0],
            stage(stages.forces, before.forces),
            stage(stages.assembly, before.assembly),
            stage(stages.solve, before.solve),
            iterations as f64 / steps as f64,
            world.bytes() / bar.mesh().cell_count(),
            load_average(),
        );
    });
}

/// A step and the tip that an independent code has after it [m].
type Row = (usize, [f64; 3]);

/// Tips after steps of 10 ms, n = 3.
const TRACES: [(&str, NewtonMode, [Row; 3]); 3] = [
    (
        "st_venant_kirchhoff",
        NewtonMode::One,
        [
            (1, [-1.2297579937602695e-06, -0.0010452588188865027, -1.0259684048517978e-05]),
            (20, [-0.01578131642940623, -0.16450240938013821, 0.011413633081487316]),
            (100, [-0.002618133995235091, -0.06678504848952935, 0.013325133794871834]),
        ],
    ),
    (
        "st_venant_kirchhoff",
        CONVERGED,
        [
            (1, [-1.8385464463982046e-06, -0.0010452671121474627, -1.026338864998038e-05]),
            (20, [-0.016038374326076996, -0.1656504618150783, 0.011538168152461808]),
            (100, [-0.0025184738453492557, -0.06539372349475858, 0.013190456656043004]),
        ],
    ),
    (
        "corotational",
        CONVERGED,
        [
            (1, [-1.7842926049393363e-06, -0.0010452609380532823, -1.0262606365962423e-05]),
            (20, [-0.015904494782426698, -0.16575024108957917, 0.011524612510030884]),
            (100, [-0.0025036520331420974, -0.06549727082595913, 0.013273534140188174]),
        ],
    ),
];
const CONVERGED: NewtonMode = NewtonMode::Full(NewtonSettings { tolerance: 1e-11, max_iterations: 50 });

fn traces() {
    for (law, newton, rows) in TRACES {
        let bar = Bar::reference(3, law);
        let mut world = bar.world(Box::new(BackwardEuler { newton, solver: solver(1e-11) }), 0.01);
        let mut taken = 0;
        for (step, expected) in rows {
            while taken < step {
                world.step().unwrap();
                taken += 1;
            }
            let expected = Vec3::from_array(expected);
            let error = (tip(&world, &bar) - expected).length() / expected.length();
            println!("trace {law} {newton:?} step {step}: relative error {error:.1e}");
        }
    }
}

fn statics(matrix_free: bool) {
    let bar = Bar::reference(12, "st_venant_kirchhoff");
    let newton = NewtonSettings { tolerance: 1e-8, max_iterations: 100 };
    let solver = SolverSettings { matrix_free, max_iterations: 100_000, ..SolverSettings::default() };
    let clock = Instant::now();
    let mut world = bar.world(Box::new(StaticEquilibrium { load_steps: 1, newton, solver }), 1.0);
    let outcome = world.step();
    let cells = bar.mesh().cell_count();
    println!(
        "static n = 12, matrix_free = {matrix_free}: {:.2} s, {outcome:?}, {:?}, tip {:?}, {:?}, {} B/tet held, {} B/tet \
         at the peak of the process, load {}",
        clock.elapsed().as_secs_f64(),
        world.last_report(),
        tip(&world, &bar),
        world.stages(),
        world.bytes() / cells,
        peak_memory() / cells,
        load_average(),
    );
}

fn main() {
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    let wants = |name: &str| chosen.is_empty() || chosen.iter().any(|chosen| chosen == name);
    if wants("matrix_free_memory") {
        matrix_free_memory();
    }
    if wants("traces") {
        traces();
    }
    for law in ["corotational", "st_venant_kirchhoff"] {
        for (name, n, threads, steps) in
            [("n3", 3, 1, 100), ("n6", 6, 1, 60), ("n6", 6, 2, 60), ("n12", 12, 1, 10), ("n12", 12, 2, 10)]
        {
            if wants(name) {
                time_steps(name, Bar::reference(n, law), threads, 0.01, steps, solver(1e-6));
            }
        }
    }
    for law in ["corotational", "neo_hookean"] {
        for (name, cells, threads) in
            [("24k", [40, 10, 10], 1), ("24k", [40, 10, 10], 2), ("5k", [20, 7, 7], 1), ("5k", [20, 7, 7], 2)]
        {
            if wants(name) {
                time_steps(name, Bar::soft(cells, law), threads, 2e-3, 100, solver(1e-6));
            }
        }
    }
    // where the choice of a preconditioner turns
    if wants("preconditioners") {
        for preconditioner in ["block_jacobi", "incomplete_cholesky", "rigid_modes", "auto"] {
            for (name, cells) in [("24k", [40, 10, 10]), ("5k", [20, 7, 7])] {
                let method = Method::Cg;
                let settings = SolverSettings { preconditioner, method, ..solver(1e-6) };
                println!("{preconditioner}");
                time_steps(name, Bar::soft(cells, "neo_hookean"), 2, 2e-3, 50, settings);
            }
        }
    }
    if wants("static") {
        with_threads(2, || statics(false));
    }
    if wants("static_matrix_free") {
        with_threads(2, || statics(true));
    }
}
