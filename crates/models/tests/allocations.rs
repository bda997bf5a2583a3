//! A step allocates nothing once its buffers are there: counted by the allocator itself, on one thread.
//!
//! Solved by conjugate gradients and BiCGSTAB with block Jacobi, which are all ours. Not counted: sparse factors, whose
//! library allocates as it likes, and steps in which what touches changes, which make the matrix anew.

use std::alloc::{GlobalAlloc, Layout, System as Heap};
use std::cell::Cell;
use std::sync::Arc;

use souple_engine::coupling::{CouplingSpring, DRIVEN_LEN};
use souple_engine::levels::{Division, Levels};
use souple_engine::{
    Constraint, Detection, Force, ImpactLaw, Kinematics, Mass, Model, Rows, State, Stepper, System,
    UnknownKind, World,
};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::contact::{
    ContactLaw, ContactPoint, ContactSurface, SHAPES, ShapeContact, SurfaceContact,
};
use souple_models::loads::{
    Attachments, Combination, Drag, FormulaVector, Gravity, GroundSpring, GroundSprings, Link, MassDamping,
    PointLoad, RigidMotion,
};
use souple_models::marks::{BleedingLaw, Kept, MarkedSurface, MarkingLaw, Marks, Sides, Tool};
use souple_models::materials::{self, Material};
use souple_models::multiresolution::{
    Choice, Coupling, LevelsDescription, LevelsForce, Loops, PLACE_VARIABLES, Stiffness,
};
use souple_models::network::relations::{Guide, Relation};
use souple_models::network::{Parting, RigidBalls, RigidBallsDescription, Sense, Sided, SidedConstraints};
use souple_models::solids::{
    RayleighDamping, SolidDescription, SolidForce, Viscosity, consistent_mass, lumped_mass,
};
use souple_table::{Value, Values};

/// Counts what the thread at hand asks of the heap.
struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: all is passed on to the system's allocator; the count is a thread's own number without a destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller's promises are passed on
        unsafe { Heap.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above
        unsafe { Heap.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as above
        unsafe { Heap.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of `steps` steps after `warm_up` ones, on one thread.
fn allocations(make: impl FnOnce() -> World + Send, warm_up: u32, steps: u32) -> u64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut world = make();
        (0..warm_up).for_each(|step| world.step().unwrap_or_else(|error| panic!("step {step}: {error}")));
        let before = COUNT.get();
        (0..steps).for_each(|step| world.step().unwrap_or_else(|error| panic!("step {step}: {error}")));
        COUNT.get() - before
    })
}

fn stepper(name: &str, given: &[(&'static str, Value<'_>)]) -> Box<dyn Stepper> {
    let entry = souple_engine::steppers::TABLE.find(name).unwrap();
    let values = given.iter().fold(Values::new(), |values, (name, value)| values.with(*name, *value));
    (entry.build)(&entry.values(values).unwrap())
}

fn mesh(cells: [f64; 3], element: &'static str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([0.6, 0.3, 0.3]))
        .with("cells", Value::Vector(cells))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

fn rubber() -> Material {
    let entry = materials::TABLE.find("neo_hookean").unwrap();
    let values = Values::new()
        .with("youngs_modulus", Value::Number(2e4))
        .with("poissons_ratio", Value::Number(0.3))
        .with("density", Value::Number(1000.0));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

/// Which mass rows have.
#[derive(Clone, Copy, PartialEq)]
enum Inertia {
    Lumped,
    Consistent,
}

/// A block of rubber, clamped at `x = 0`, with everything that may act on it.
struct Block {
    element: &'static str,
    inertia: Inertia,
    /// Damping by rates of strain makes the tangent general.
    viscosity: f64,
}

impl Block {
    fn system(&self, stepper: Box<dyn Stepper>) -> (System, Vec<Vec3>) {
        let mesh = mesh([6.0, 3.0, 3.0], self.element);
        let materials = [rubber()];
        let material_of_cell = vec![0; mesh.cell_count()];
        let description = |name: &str| SolidDescription {
            name: name.into(),
            mesh: &mesh,
            first_row: 0,
            materials: &materials,
            material_of_cell: &material_of_cell,
            axes: &[],
            quadrature: Default::default(),
            section: Default::default(),
        };
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
        let mut mass = Mass::new(mesh.points.len());
        match self.inertia {
            Inertia::Lumped => lumped_mass(&mesh, 0, &|_| 1000.0, &mut mass),
            Inertia::Consistent => consistent_mass(&mesh, 0, &|_| 1000.0, &mut mass),
        }
        mass.seal();
        let last = mesh.points.len() as u32 - 1;
        let end = mesh.points[last as usize];
        let load = Arc::new(FormulaVector::compile("[1, sin(t), -2]").unwrap());
        let tie = Link::new(Combination::row(last), Combination::row(last - 1), 0.05);
        let spring = GroundSpring { row: last, share: 1.0, anchor: end };
        let mut forces: Vec<Box<dyn Force>> = vec![
            Box::new(SolidForce::new(&description("solid")).unwrap()),
            Box::new(RayleighDamping::new(&description("rayleigh"), 1e-3).unwrap()),
            Box::new(Gravity::new("gravity", Vec3::Y * -9.81, &mass, &kinematics).unwrap()),
            Box::new(MassDamping::new("damping", mass.clone(), 0.5).unwrap()),
            Box::new(Drag::new("drag", vec![(last, 1.0)], 0.1).unwrap()),
            Box::new(PointLoad::new("load", vec![(last, 0.1)], load).unwrap()),
            Box::new(GroundSprings::new("ground", vec![spring], 5.0, 0.0).unwrap()),
            Box::new(Attachments::new("tie", vec![tie], 5.0, 0.0).unwrap()),
        ];
        if self.viscosity > 0.0 {
            forces.push(Box::new(Viscosity::new(&description("viscosity"), self.viscosity).unwrap()));
        }
        let clamped = mesh.points.iter().enumerate().filter(|(_, point)| point.x == 0.0);
        let constraints = clamped.map(|(row, start)| Constraint::pin(row as u32, *start)).collect();
        let system = System {
            name: "main".into(),
            kinematics,
            mass,
            forces,
            constraints,
            stepper,
            steps_per_period: 1,
        };
        (system, mesh.points)
    }

    fn world(&self, stepper: Box<dyn Stepper>, period: f64) -> World {
        start(self.system(stepper), period)
    }
}

fn start((system, q): (System, Vec<Vec3>), period: f64) -> World {
    let state = State { systems: vec![system.initial_state(q)], ..State::default() };
    Model { period, systems: vec![system], ..Model::default() }.start(state)
}

const PLAIN: Block = Block { element: "tet4", inertia: Inertia::Lumped, viscosity: 0.0 };

/// Explicit steps: lumped mass, several elements and dampings.
#[test]
fn explicit_steps() {
    for name in ["explicit_euler", "symplectic_euler", "verlet", "rk2", "rk4"] {
        for element in ["tet4", "mixed"] {
            let block = Block { element, viscosity: 5.0, ..PLAIN };
            let count = allocations(|| block.world(stepper(name, &[]), 1e-4), 3, 20);
            assert_eq!(count, 0, "{name} on {element}");
        }
    }
}

/// A consistent mass is solved with every step.
#[test]
fn explicit_steps_with_a_consistent_mass() {
    let block = Block { inertia: Inertia::Consistent, ..PLAIN };
    assert_eq!(allocations(|| block.world(stepper("symplectic_euler", &[]), 1e-4), 3, 10), 0);
}

/// Balls that have fallen onto a floor, and onto each other.
#[test]
fn steps_of_rigid_balls() {
    let make = || {
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, 12);
        let mut mass = Mass::new(12);
        mass.diagonal.fill(0.1);
        let gravity = Gravity::new("gravity", Vec3::Y * -9.81, &mass, &kinematics).unwrap();
        let law = ImpactLaw { restitution: 0.3, friction: 0.4 };
        let floor = |row: u32| -> Box<dyn Relation> {
            Box::new(Guide::plane(row, Vec3::ZERO, Vec3::new(0.05, 1.0, 0.02)).unwrap())
        };
        let sided = Sided { sense: Sense::AtLeast, radius: 0.05, law };
        let floor = SidedConstraints::new("floor", (0..12).map(floor).collect(), sided);
        let balls = RigidBalls::new(RigidBallsDescription {
            name: "balls".into(),
            first: 0..12,
            second: 0..12,
            diameter: 0.1,
            law,
            held: Vec::new(),
            timestep: 2e-3,
            detection: Detection::EveryStep,
        });
        let system = System {
            name: "main".into(),
            kinematics,
            mass,
            forces: vec![Box::new(gravity), Box::new(Parting(floor)), Box::new(Parting(balls))],
            constraints: Vec::new(),
            stepper: stepper("t_simulation", &[]),
            steps_per_period: 1,
        };
        let place = |i: u32| Vec3::new(0.11 * f64::from(i % 3), 0.06 + 0.105 * f64::from(i / 3), 0.0);
        start((system, (0..12).map(place).collect()), 2e-3)
    };
    // they collide, and those that were listed first have come apart
    assert_eq!(allocations(make, 400, 100), 0);
}

/// A frame that turns has inertia of its own.
#[test]
fn explicit_steps_of_a_rigid_frame() {
    let make = || {
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::RigidFrame, 1);
        let mut mass = Mass::new(4);
        mass.diagonal.copy_from_slice(&[2.0, 0.5, 0.4, 0.3]);
        let gravity = Gravity::new("gravity", Vec3::Y, &mass, &kinematics).unwrap();
        let system = System {
            name: "main".into(),
            kinematics,
            mass,
            forces: vec![Box::new(gravity)],
            constraints: vec![],
            stepper: stepper("rk4", &[]),
            steps_per_period: 1,
        };
        let mut state = system.initial_state(vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
        state.v[1] = Vec3::new(0.3, 2.0, -1.0);
        let state = State { systems: vec![state], ..State::default() };
        Model { period: 1e-3, systems: vec![system], ..Model::default() }.start(state)
    };
    assert_eq!(allocations(make, 3, 20), 0);
}

/// Implicit steps with a stored matrix and without, solved by conjugate gradients.
#[test]
fn implicit_steps() {
    let text = |value| Value::Text(value);
    let krylov = [("solver", text("cg")), ("preconditioner", text("block_jacobi"))];
    for newton in ["one", "full"] {
        for matrix_free in [false, true] {
            let given =
                [&krylov[..], &[("newton", text(newton)), ("matrix_free", Value::Boolean(matrix_free))]]
                    .concat();
            for name in ["backward_euler", "bdf2", "newmark"] {
                let make = || PLAIN.world(stepper(name, &given), 5e-3);
                let count = allocations(make, 3, 5);
                assert_eq!(count, 0, "{name}, newton = {newton}, matrix_free = {matrix_free}");
            }
        }
    }
}

/// Equilibrium under a load that changes from step to step; with dampers on the way there.
#[test]
fn static_steps() {
    let given = [("solver", Value::Text("cg")), ("preconditioner", Value::Text("block_jacobi"))];
    let creeping = || PLAIN.world(stepper("quasi_static", &given), 0.1);
    assert_eq!(allocations(creeping, 3, 5), 0);
    let make = || {
        let (mut system, q) = PLAIN.system(stepper("static", &given));
        // dampers have no place in statics
        system.forces.retain(|force| !force.declaration().velocity_terms);
        start((system, q), 0.1)
    };
    assert_eq!(allocations(make, 3, 5), 0);
}

/// What points of levels are asked before a step.
#[test]
fn velocities_are_asked() {
    let mut mesh = mesh([4.0, 3.0, 3.0], "tet4");
    mesh.validate().unwrap();
    let force = LevelsForce::new(LevelsDescription {
        name: "body.material".to_owned(),
        meshes: &[&mesh],
        first_row: 0,
        materials: &[rubber()],
        material_of_cell: &vec![0; mesh.cell_count()],
        coupling: Coupling::Transpose,
        loops: Loops::Activated,
        stiffness: Stiffness::Own,
        choice: Choice::Fixed(Formula::compile("0", &PLACE_VARIABLES).unwrap()),
        viscosity: 0.0,
        mass_damping: 0.0,
        budget: None,
        cuts: Vec::new(),
        supports: Vec::new(),
    })
    .unwrap();
    let division = Division { velocity_jump: 1.0, ..Division::new(1e-3, 3) };
    let positions = mesh.points.iter().map(|x| *x * 1.1).collect();
    let mut rows = Rows { positions, velocities: vec![Vec3::ZERO; mesh.points.len()], time: 0.0 };
    let (mut memory, mut scratch) = (vec![0.0; force.memory_len()], force.new_scratch());
    for _ in 0..2 {
        force.adapt(&division, &mut rows, &mut memory, &mut scratch);
    }
    let before = COUNT.get();
    force.adapt(&division, &mut rows, &mut memory, &mut scratch);
    assert_eq!(COUNT.get(), before);
}

const LAW: ContactLaw = ContactLaw {
    stiffness: 200.0,
    damping: 0.2,
    friction: 0.4,
    tangential_stiffness: 100.0,
    thickness: 0.01,
};

/// A block pressed on a closed surface, which marks it, and two blocks on each other.
fn pressed(stepper: Box<dyn Stepper>, period: f64) -> World {
    let (system, low) = PLAIN.system(stepper);
    let mesh = mesh([6.0, 3.0, 3.0], "tet4");
    let surface = mesh.boundary_surface();
    let count = low.len();
    let above: Vec<Vec3> = low.iter().map(|point| *point + Vec3::new(0.03, 0.3, 0.02)).collect();
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, 2 * count);
    let mut mass = Mass::new(2 * count);
    mass.diagonal.fill(0.2);
    let side = |first: u32| {
        let mut moved = surface.clone();
        let from = if first == 0 { &low } else { &above };
        moved.points = surface.mesh_points.iter().map(|point| from[*point as usize]).collect();
        let rows: Vec<u32> = surface.mesh_points.iter().map(|point| first + point).collect();
        ContactSurface { surface: moved.into(), shares: vec![1.0; rows.len()], rows, later: Vec::new() }
    };
    let held = |first: u32| {
        // nodes of a body hold together by springs to where they stand
        let from = if first == 0 { &low } else { &above };
        from.iter()
            .enumerate()
            .map(|(i, anchor)| GroundSpring { row: first + i as u32, share: 1.0, anchor: *anchor })
            .collect::<Vec<_>>()
    };
    let points = low
        .iter()
        .enumerate()
        .filter(|(_, point)| point.y == 0.0)
        .map(|(row, start)| ContactPoint { row: row as u32, share: 1.0, start: *start })
        .collect();
    let source = |_: &str| {
        let values = Values::new()
            .with("size", Value::Vector([2.0; 3]))
            .with("cells", Value::Vector([2.0; 3]))
            .with("element", Value::Text("tet4"));
        let mut box_surface = souple_mesh::generate("box", values).unwrap().boundary_surface();
        box_surface.points.iter_mut().for_each(|point| *point -= Vec3::new(1.0, 2.0, 1.0));
        Ok(box_surface)
    };
    let entry = SHAPES.find("closed_surface").unwrap();
    let values = entry.values(Values::new().with("surface", Value::Text("ground"))).unwrap();
    let ground = (entry.build)(&values, &source).unwrap();
    let forces: Vec<Box<dyn Force>> = vec![
        Box::new(GroundSprings::new("low", held(0), 20.0, 0.5).unwrap()),
        Box::new(GroundSprings::new("high", held(count as u32), 20.0, 0.5).unwrap()),
        Box::new(Gravity::new("gravity", Vec3::Y * -2.0, &mass, &kinematics).unwrap()),
        Box::new(ShapeContact::new("ground", points, ground, RigidMotion::default(), LAW).unwrap()),
        Box::new(SurfaceContact::new("pair", side(0), side(count as u32), LAW, 0.1).unwrap()),
    ];
    let system = System { kinematics, mass, forces, constraints: vec![], ..system };
    let bleeding = BleedingLaw {
        pressure: 1.0,
        rate: 1e-4,
        clotting_time: 10.0,
        drying_time: 10.0,
        viscosity: 3.5e-3,
        clinging: 1e-5,
    };
    let law = MarkingLaw {
        whitening_pressure: 1e6,
        whitening_time: 0.1,
        refill_time: 0.5,
        burn_dose: 1e3,
        bleeding: Some(bleeding),
    };
    let opening = surface.clone().into();
    let marked = MarkedSurface {
        place: [0, 0],
        surface: &opening,
        point_count: count,
        sides: Sides::Outer,
        tools: vec![Tool { contact: "ground".into(), heat: 1.0, tears_at: None }],
        gashes: Vec::new(),
    };
    let marks = Marks::new("marks".into(), law, marked);
    let fields = vec![marks.start()];
    let state =
        State { systems: vec![system.initial_state([low, above].concat())], fields, ..State::default() };
    let kept = Box::new(Kept(Arc::new(marks)));
    Model { period, systems: vec![system], fields: vec![kept], ..Model::default() }.start(state)
}

/// Pairs of a contact are searched, merged and felt every step; their lists have grown before.
#[test]
fn steps_in_contact() {
    let solver = [
        ("solver", Value::Text("bicgstab")),
        ("preconditioner", Value::Text("block_jacobi")),
        ("newton", Value::Text("full")),
    ];
    let symplectic = || pressed(stepper("symplectic_euler", &[]), 1e-3);
    assert_eq!(allocations(symplectic, 300, 50), 0, "explicit");
    let euler = || pressed(stepper("backward_euler", &solver), 1e-2);
    assert_eq!(allocations(euler, 60, 5), 0, "implicit");
    // it damps less, and until what touches stays the same the matrix takes other forms
    let bdf2 = || pressed(stepper("bdf2", &solver), 1e-2);
    assert_eq!(allocations(bdf2, 400, 5), 0, "implicit, second order");
}

/// Two systems of different steps exchange impulses every period.
#[test]
fn coupled_steps() {
    let make = || {
        let (mut fast, fast_q) = PLAIN.system(stepper("symplectic_euler", &[]));
        let (mut slow, slow_q) = PLAIN.system(stepper("verlet", &[]));
        let end = fast_q.len() as u32 - 1;
        let spring = CouplingSpring {
            name: "tie".into(),
            fast_system: 0,
            fast_row: end,
            slow_system: 1,
            slow_row: end,
            stiffness: 2.0,
            damping: 0.1,
            driven: 0,
        };
        fast.forces.push(spring.fast_end());
        slow.forces.push(spring.slow_end());
        fast.steps_per_period = 5;
        let systems = vec![fast.initial_state(fast_q), slow.initial_state(slow_q)];
        let state = State { systems, driven: vec![0.0; DRIVEN_LEN], ..State::default() };
        Model { period: 2e-4, systems: vec![fast, slow], couplings: vec![spring], ..Model::default() }
            .start(state)
    };
    assert_eq!(allocations(make, 3, 10), 0);
}
