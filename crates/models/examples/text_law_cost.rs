//! What a law as text costs beside the same law compiled ahead: parts of a step and complete steps, on one thread.
//! `cargo run --release -p souple-models --example text_law_cost`.

use souple_engine::linear::SolverSettings;
use souple_engine::steppers::{BackwardEuler, NewtonMode, SymplecticEuler};
use souple_engine::{
    Configuration, Constraint, Force, Kinematics, Mass, Model, State, Stepper, System, TangentWeights,
    UnknownKind,
};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::materials::{self, Material};
use souple_models::solids::{SolidDescription, SolidForce, lumped_mass};
use souple_solve::{BlockMatrix, PatternBuilder};
use souple_table::{Value, Values};

/// The law, as tensors, and entry by entry.
const NEO_HOOKEAN: [(&str, &str); 3] = [
    ("compiled", ""),
    ("tensor text", "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2"),
    (
        "scalar text",
        "mu/2*(F11^2 + F12^2 + F13^2 + F21^2 + F22^2 + F23^2 + F31^2 + F32^2 + F33^2 - 3) - mu*log(j) + lambda/2*log(j)^2",
    ),
];
const DETERMINANT: &str = "F11*(F22*F33 - F23*F32) - F12*(F21*F33 - F23*F31) + F13*(F21*F32 - F22*F31)";

fn material(energy: &str) -> Material {
    let values = Values::new().with("density", Value::Number(1000.0));
    let (mu, lambda) = (1e7 / 2.6, 3e6 / (1.3 * 0.4));
    if energy.is_empty() {
        let entry = materials::TABLE.find("neo_hookean").unwrap();
        let values =
            values.with("youngs_modulus", Value::Number(1e7)).with("poissons_ratio", Value::Number(0.3));
        return (entry.build)(&entry.values(values).unwrap()).unwrap();
    }
    let entry = materials::TABLE.find("hyperelastic").unwrap();
    let parameters = [("mu".to_owned(), format!("{mu} Pa")), ("lambda".to_owned(), format!("{lambda} Pa"))];
    let definitions = [("j".to_owned(), DETERMINANT.to_owned())];
    let values = values
        .with("energy", Value::Text(energy))
        .with("parameters", Value::Texts(&parameters))
        .with("definitions", Value::Texts(&definitions));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

fn mesh(n: usize, element: &str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.1, 0.1]))
        .with("cells", Value::Vector([10.0 * n as f64, n as f64, n as f64]))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

/// CPU seconds of this thread, where the system tells.
fn thread_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|number| number.parse::<f64>().ok()).map_or(f64::NAN, |ns| ns * 1e-9)
}

fn solid(mesh: &Mesh, energy: &str) -> SolidForce {
    SolidForce::new(&SolidDescription {
        name: "bar.material".into(),
        mesh,
        first_row: 0,
        materials: &[material(energy)],
        material_of_cell: &vec![0; mesh.cell_count()],
        axes: &[],
        quadrature: Default::default(),
        section: Default::default(),
    })
    .unwrap()
}

fn system(mesh: &Mesh, energy: &str, stepper: Box<dyn Stepper>) -> System {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
    let mut mass = Mass::new(mesh.points.len());
    lumped_mass(mesh, 0, &|_| 1000.0, &mut mass);
    mass.seal();
    let clamped = mesh.points.iter().enumerate().filter(|(_, point)| point.x == 0.0);
    let constraints = clamped.map(|(block, start)| Constraint::pin(block as u32, *start)).collect();
    let forces: Vec<Box<dyn Force>> = vec![Box::new(solid(mesh, energy))];
    System { name: "main".into(), kinematics, mass, forces, constraints, stepper, steps_per_period: 1 }
}

/// Least CPU seconds of several calls.
fn least(mut work: impl FnMut()) -> f64 {
    let measured = (0..15).map(|_| {
        let start = thread_seconds();
        work();
        thread_seconds() - start
    });
    measured.fold(f64::INFINITY, f64::min)
}

/// Forces, products, blocks, an explicit and an implicit step.
fn measure(mesh: &Mesh, energy: &str) -> [f64; 5] {
    let force = solid(mesh, energy);
    let x: Vec<Vec3> = mesh.points.iter().map(|p| *p + Vec3::Y * (-0.1 * p.x * p.x)).collect();
    let v = vec![Vec3::ZERO; x.len()];
    let at = Configuration {
        positions: &x,
        velocities: &v,
        time: 0.0,
        load: 1.0,
        memory: &[],
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    };
    let weights = TangentWeights { position: 1.0, velocity: 0.0 };
    let (mut scratch, mut out) = (force.new_scratch(), vec![Vec3::ZERO; x.len()]);
    let forces = least(|| force.add_force(&at, &mut scratch, &mut out));
    let products = least(|| force.add_differential(&at, weights, &x, &mut scratch, &mut out));
    let mut pattern = PatternBuilder::new(x.len());
    force.visit_cliques(&[], &mut |rows| pattern.add_clique(rows).unwrap());
    let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(pattern.build().unwrap()));
    let blocks = least(|| force.add_blocks(&at, weights, &mut scratch, &mut matrix));
    let step = |stepper: Box<dyn Stepper>, period: f64| {
        let system = system(mesh, energy, stepper);
        let state = State { systems: vec![system.initial_state(x.clone())], ..State::default() };
        let mut world = Model { period, systems: vec![system], ..Model::default() }.start(state);
        least(|| world.step().unwrap())
    };
    let explicit = step(Box::new(SymplecticEuler), 1e-7);
    let implicit =
        step(Box::new(BackwardEuler { newton: NewtonMode::One, solver: SolverSettings::default() }), 1e-3);
    [forces, products, blocks, explicit, implicit]
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        for (element, n) in [("tet4", 8), ("hex8", 8)] {
            let mesh = mesh(n, element);
            println!("{element}, {} cells: ms, and times as much as compiled ahead", mesh.cell_count());
            let mut compiled = [0.0; 5];
            for (how, energy) in NEO_HOOKEAN {
                let clock = std::time::Instant::now();
                let _ = material(energy);
                let seconds = clock.elapsed().as_secs_f64();
                let measured = measure(&mesh, energy);
                if energy.is_empty() {
                    compiled = measured;
                }
                print!("  {how:<12} built in {:.1} ms;", 1e3 * seconds);
                for (what, (time, of)) in ["forces", "products", "blocks", "explicit step", "implicit step"]
                    .iter()
                    .zip(measured.iter().zip(&compiled))
                {
                    print!("  {what} {:.3} ({:.2})", 1e3 * time, time / of);
                }
                println!();
            }
        }
    });
}
