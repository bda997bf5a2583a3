//! Forces add up: what a system does with several is the sum of what each does alone.

use souple_engine::{
    Configuration, Force, Kinematics, Mass, Model, State, System, TangentWeights, UnknownKind,
};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::loads::{Gravity, GroundSpring, GroundSprings};
use souple_models::materials::{self, Material};
use souple_models::solids::{
    Quadrature, RayleighDamping, Section, SolidDescription, SolidForce, Viscosity, lumped_mass,
};
use souple_table::{Value, Values};

use crate::common;

const FORCES: usize = 5;
/// [s]
const STEP: f64 = 1e-3;

fn mesh() -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.4, 0.3]))
        .with("cells", Value::Vector([3.0, 2.0, 1.0]))
        .with("element", Value::Text("hex8"));
    souple_mesh::generate("bar", values).unwrap()
}

fn lumped(mesh: &Mesh) -> Mass {
    let mut mass = Mass::new(mesh.points.len());
    lumped_mass(mesh, 0, &|_| 1000.0, &mut mass);
    mass.seal();
    mass
}

fn kinematics(mesh: &Mesh) -> Kinematics {
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
    kinematics
}

/// Elastic, viscous, damping and outer forces, by number.
fn force(number: usize, mesh: &Mesh) -> Box<dyn Force> {
    let law = materials::TABLE.find("neo_hookean").unwrap();
    let (material, of_cell): ([Material; 1], _) =
        ([common::material_of(law, 1e6, 0.3)], vec![0; mesh.cell_count()]);
    let description = SolidDescription {
        name: format!("force {number}"),
        mesh,
        first_row: 0,
        materials: &material,
        material_of_cell: &of_cell,
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Solid,
    };
    let down = Vec3::new(0.0, -9.81, 0.0);
    let spring = |point: usize| GroundSpring { row: point as u32, share: 1.0, anchor: mesh.points[point] };
    match number {
        0 => Box::new(SolidForce::new(&description).unwrap()),
        1 => Box::new(Viscosity::new(&description, 300.0).unwrap()),
        2 => Box::new(RayleighDamping::new(&description, 1e-3).unwrap()),
        3 => Box::new(Gravity::new("gravity", down, &lumped(mesh), &kinematics(mesh)).unwrap()),
        _ => {
            let springs = (0..mesh.points.len()).map(spring).collect();
            Box::new(GroundSprings::new("springs", springs, 2e3, 5.0).unwrap())
        }
    }
}

/// Bent, and in motion.
fn start(mesh: &Mesh) -> (Vec<Vec3>, Vec<Vec3>) {
    let bent = |p: &Vec3| *p + Vec3::new((7.0 * p.y).sin(), (5.0 * p.x).cos(), (3.0 * p.x).sin()) * 0.01;
    let moving = |p: &Vec3| Vec3::new(p.y - p.z, (4.0 * p.x).sin(), 0.3 + p.x * p.y);
    (mesh.points.iter().map(bent).collect(), mesh.points.iter().map(moving).collect())
}

/// Change of velocities in a step of a body with some of the forces [m/s].
fn change(numbers: &[usize], stepper: &str, mesh: &Mesh) -> Vec<Vec3> {
    let entry = souple_engine::steppers::TABLE.find(stepper).unwrap();
    let values = match stepper {
        "backward_euler" => {
            Values::new().with("newton", Value::Text("one")).with("solver", Value::Text("direct"))
        }
        _ => Values::new(),
    };
    let system = System {
        name: "main".into(),
        kinematics: kinematics(mesh),
        mass: lumped(mesh),
        forces: numbers.iter().map(|number| force(*number, mesh)).collect(),
        constraints: Vec::new(),
        stepper: (entry.build)(&entry.values(values).unwrap()),
        steps_per_period: 1,
    };
    let (q, v) = start(mesh);
    let mut state = system.initial_state(q);
    state.v.clone_from(&v);
    let state = State { systems: vec![state], ..State::default() };
    let mut world = Model { period: STEP, systems: vec![system], ..Model::default() }.start(state);
    world.step().unwrap();
    world.state().systems[0].v.iter().zip(&v).map(|(after, before)| *after - *before).collect()
}

fn largest(vectors: &[Vec3]) -> f64 {
    vectors.iter().map(|vector| vector.length()).fold(0.0, f64::max)
}

/// Forces: an explicit step under all of them changes velocities by the sum of what steps under each alone change.
#[test]
fn forces_add_up() {
    let mesh = mesh();
    let all = change(&[0, 1, 2, 3, 4], "explicit_euler", &mesh);
    let mut sum = vec![Vec3::ZERO; all.len()];
    for number in 0..FORCES {
        let alone = change(&[number], "explicit_euler", &mesh);
        assert!(largest(&alone) > 1e-3 * largest(&all), "force {number} does next to nothing");
        sum.iter_mut().zip(&alone).for_each(|(sum, part)| *sum += *part);
    }
    let gap: Vec<Vec3> = all.iter().zip(&sum).map(|(all, sum)| *all - *sum).collect();
    // velocities of about 1 m/s are rounded after every step
    assert!(largest(&gap) < 1e-14 * FORCES as f64 + 1e-13 * largest(&all), "{}", largest(&gap));
}

/// Differentials, with their factors: one linearised implicit step solves
/// `M Δv = h Σ f + Σ (h² ∂f/∂x (v + Δv) + h ∂f/∂v Δv)`, the sums taken here, force by force.
#[test]
fn differentials_add_up() {
    let mesh = mesh();
    let taken = change(&[0, 1, 2, 3, 4], "backward_euler", &mesh);
    let (q, v) = start(&mesh);
    let after: Vec<Vec3> = v.iter().zip(&taken).map(|(v, change)| *v + *change).collect();
    let mut right = vec![Vec3::ZERO; q.len()];
    for number in 0..FORCES {
        let (force, memory) = (force(number, &mesh), [0.0]);
        let at = Configuration {
            positions: &q,
            velocities: &v,
            time: 0.0,
            load: 1.0,
            memory: &memory[..force.memory_len()],
            pairs: &[],
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        };
        let mut out = vec![Vec3::ZERO; q.len()];
        let mut scratch = force.new_scratch();
        force.add_force(&at, &mut scratch, &mut out);
        let by_position = TangentWeights { position: STEP, velocity: 0.0 };
        force.add_differential(&at, by_position, &after, &mut scratch, &mut out);
        let by_velocity = TangentWeights { position: 0.0, velocity: 1.0 };
        force.add_differential(&at, by_velocity, &taken, &mut scratch, &mut out);
        right.iter_mut().zip(&out).for_each(|(sum, part)| *sum += *part * STEP);
    }
    let mut left = vec![Vec3::ZERO; q.len()];
    lumped(&mesh).add_product(&taken, &mut left);
    let gap: Vec<Vec3> = left.iter().zip(&right).map(|(left, right)| *left - *right).collect();
    // the direct solver's rounding, next to the largest impulse
    assert!(largest(&gap) < 1e-10 * largest(&left), "{} of {}", largest(&gap), largest(&left));
}
