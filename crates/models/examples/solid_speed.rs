//! Speed of the force kernels on the reference bar: `cargo run --release --example solid_speed`.
use std::time::Instant;

use souple_engine::steppers::SymplecticEuler;
use souple_engine::{Force, Kinematics, Mass, Model, State, System, UnknownKind};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::materials;
use souple_models::solids::{SolidDescription, SolidForce, lumped_mass};
use souple_table::{Value, Values};

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

fn main() {
    for (element, law, n) in [
        ("tet4", "st_venant_kirchhoff", 12),
        ("tet4", "neo_hookean", 12),
        ("hex8", "st_venant_kirchhoff", 12),
        ("prism6", "st_venant_kirchhoff", 8),
        ("pyramid5", "st_venant_kirchhoff", 8),
    ] {
        let mesh = mesh(n, element);
        let entry = materials::TABLE.find(law).unwrap();
        let values = Values::new()
            .with("youngs_modulus", Value::Number(1e7))
            .with("poissons_ratio", Value::Number(0.3))
            .with("density", Value::Number(1000.0));
        let material = (entry.build)(&entry.values(values).unwrap()).unwrap();
        let cells = mesh.cell_count();
        let material_of_cell = vec![0; cells];
        let description = SolidDescription {
            name: "bar.material".into(),
            mesh: &mesh,
            first_row: 0,
            materials: &[material],
            material_of_cell: &material_of_cell,
            axes: &[],
            quadrature: Default::default(),
            section: Default::default(),
        };
        let force = SolidForce::new(&description).unwrap();
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
        let mut mass = Mass::new(mesh.points.len());
        lumped_mass(&mesh, 0, &|_| 1000.0, &mut mass);
        mass.seal();
        let bytes = force.bytes();
        let system = System {
            name: "main".into(),
            kinematics,
            mass,
            forces: vec![Box::new(force)],
            constraints: vec![],
            stepper: Box::new(SymplecticEuler),
            steps_per_period: 1,
        };
        let q = mesh.points.iter().map(|p| *p + Vec3::Y * (-0.1 * p.x * p.x)).collect();
        let state = State { systems: vec![system.initial_state(q)], ..State::default() };
        let mut world = Model { period: 1e-6, systems: vec![system], ..Model::default() }.start(state);
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut best = f64::INFINITY;
                // told at ticks of some milliseconds: only a long run is measured well
                let cpu = thread_seconds();
                for _ in 0..200 {
                    let clock = Instant::now();
                    for _ in 0..3 {
                        world.step().unwrap();
                    }
                    best = best.min(clock.elapsed().as_secs_f64() / 3.0);
                }
                std::thread::yield_now();
                let of_processor = (thread_seconds() - cpu) / 600.0;
                println!(
                    "{element} {law}: {threads} threads {:.1} M elements/s (own CPU time {:.1}), {} B/element",
                    cells as f64 / best * 1e-6,
                    cells as f64 / of_processor * 1e-6,
                    bytes / cells
                );
            });
        }
        println!("{:?}", world.stages());
    }
}
