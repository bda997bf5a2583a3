//! Bodies of several meshes: what follows follows exactly, nothing is lost between levels, and steps keep their laws.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use souple_engine::levels::{Division, Filter, Followers, Kinematic, Levels};
use souple_engine::steppers::{Schedule, Staggered};
use souple_engine::{
    Configuration, Constraint, Declaration, Energy, Force, Kinematics, Mass, Model, Pair, Rows, Scratch,
    State, System, TangentWeights, UnknownKind, World,
};
use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_mesh::coarsen::{coarser, mean_edge};
use souple_mesh::fill::{Options, PARAMETERS};
use souple_mesh::implicit::SHAPES;
use souple_mesh::{Mesh, generate};
use souple_models::contact::shape::{Plane, Sphere};
use souple_models::contact::{ContactLaw, ContactPoint, Shape, ShapeContact};
use souple_models::loads::RigidMotion;
use souple_models::materials::{Material, TABLE};
use souple_models::multiresolution::{
    Choice, Coupling, Criterion, LevelsDescription, LevelsForce, Loops, Measure, PLACE_VARIABLES, Stiffness,
    Support,
};
use souple_solve::BlockMatrix;
use souple_table::{Value, Values};

fn material(name: &str, lame: [f64; 2]) -> Material {
    let [lambda, mu] = lame;
    // E = μ (3λ + 2μ)/(λ + μ), ν = λ/(2 (λ + μ))
    let values = Values::new()
        .with("youngs_modulus", Value::Number(mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu)))
        .with("poissons_ratio", Value::Number(0.5 * lambda / (lambda + mu)))
        .with("density", Value::Number(1000.0));
    let entry = TABLE.find(name).unwrap();
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

/// A cube of 10 cm, six tetrahedra to a cell.
fn cube(cells: f64) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([0.1; 3]))
        .with("cells", Value::Vector([cells; 3]))
        .with("element", Value::Text("tet4"));
    let mut mesh = generate("bar", values).unwrap();
    mesh.validate().unwrap();
    mesh
}

/// A ball and what fills it more coarsely: nothing is nested, and points of each mesh stick out of the others.
fn balls() -> Vec<Mesh> {
    let fine = ellipsoid([0.05; 3], 0.01);
    vec![coarser(&fine, 0.036).unwrap(), coarser(&fine, 0.018).unwrap(), fine]
}

fn ellipsoid(semi_axes: [f64; 3], size: f64) -> Mesh {
    let entry = SHAPES.find("ellipsoid").unwrap();
    let values = entry.values(Values::new().with("semi_axes", Value::Vector(semi_axes))).unwrap();
    let size = Values::new().with("size", Value::Number(size)).completed(PARAMETERS).unwrap();
    let options = Options::from_values(&size).unwrap();
    let mut mesh = options.fill_body(&(entry.build)(&values).unwrap()).unwrap().mesh;
    mesh.validate().unwrap();
    mesh
}

fn fixed(level: &str) -> Choice {
    Choice::Fixed(Formula::compile(level, &PLACE_VARIABLES).unwrap())
}

fn body(meshes: &[Mesh], coupling: Coupling, choice: Choice) -> LevelsForce {
    body_of(meshes, coupling, choice, Stiffness::Own)
}

fn body_of(meshes: &[Mesh], coupling: Coupling, choice: Choice, stiffness: Stiffness) -> LevelsForce {
    body_held(meshes, coupling, choice, stiffness, |_| false)
}

/// The same with its points held where that is so.
fn body_held(
    meshes: &[Mesh],
    coupling: Coupling,
    choice: Choice,
    stiffness: Stiffness,
    is_held: impl Fn(Vec3) -> bool,
) -> LevelsForce {
    let all: Vec<&Mesh> = meshes.iter().collect();
    let finest = meshes.last().unwrap();
    let places = [finest].into_iter().chain(&meshes[..meshes.len() - 1]).flat_map(|mesh| &mesh.points);
    let held = (0..).zip(places).filter(|(_, place)| is_held(**place)).map(|(point, _)| point).collect();
    LevelsForce::new(LevelsDescription {
        name: "body.material".to_owned(),
        meshes: &all,
        first_row: 0,
        materials: &[material("st_venant_kirchhoff", [20000.0, 7000.0])],
        material_of_cell: &vec![0; finest.cell_count()],
        coupling,
        loops: Loops::Activated,
        stiffness,
        choice,
        viscosity: 0.0,
        mass_damping: 0.0,
        budget: None,
        cuts: Vec::new(),
        supports: vec![Support { points: held, axes: [true; 3] }],
    })
    .unwrap()
}

/// A force with its memory, its scratch and rows at rest.
struct Alone {
    force: LevelsForce,
    memory: Vec<f64>,
    scratch: Scratch,
    rows: Rows,
}

const DIVISION: Division = Division::new(1e-3, 2);

impl Alone {
    fn new(force: LevelsForce) -> Self {
        let mut memory = vec![0.0; force.memory_len()];
        let scratch = force.new_scratch();
        let rest = force.hierarchy().rest.clone();
        let velocities = vec![Vec3::ZERO; rest.len()];
        let mut rows = Rows { positions: rest, velocities, time: 0.0 };
        let mut scratch = scratch;
        force.adapt(&DIVISION, &mut rows, &mut memory, &mut scratch);
        Self { force, memory, scratch, rows }
    }

    fn at(&self) -> souple_engine::Configuration<'_> {
        souple_engine::Configuration {
            positions: &self.rows.positions,
            velocities: &self.rows.velocities,
            time: 0.0,
            load: 1.0,
            memory: &self.memory,
            pairs: &[],
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        }
    }

    /// Moves active points, and what follows them.
    fn place(&mut self, map: impl Fn(Vec3) -> Vec3) {
        for row in self.force.active(&self.scratch).to_vec() {
            let row = row as usize;
            self.rows.positions[row] = map(self.force.hierarchy().rest[row]);
        }
        self.follow();
    }

    fn follow(&mut self) {
        let positions = &mut self.rows.positions;
        self.force.follow(Followers::All, Kinematic::Position, &self.scratch, positions);
    }

    fn energy(&mut self) -> f64 {
        let mut scratch = self.force.new_scratch();
        self.force.energy(&self.at(), &mut scratch).stored
    }
}

/// Patterns of levels, from all coarse to all fine, with sides, stripes and holes.
const PATTERNS: [&str; 6] =
    ["0", "2", "if(x < 0.03, 2, 0)", "if(x < 0.03, 2, 1)", "if(x*x + y*y + z*z < 0.001, 2, 0)", "1"];

/// V-32 (a): every affine motion of the active points is that of all points, border and extrapolated ones too.
#[test]
fn affine_motions_are_followed_exactly() {
    let map = |x: Vec3| {
        Mat3::from_columns(Vec3::new(1.1, 0.2, -0.1), Vec3::new(0.05, 0.9, 0.3), Vec3::new(0.0, -0.2, 1.2))
            * x
            + Vec3::new(0.3, -0.1, 0.2)
    };
    for meshes in [balls(), vec![cube(2.0), cube(4.0), cube(7.0)]] {
        for pattern in PATTERNS {
            let mut body = Alone::new(body(&meshes, Coupling::Transpose, fixed(pattern)));
            body.place(map);
            for (x, rest) in body.rows.positions.iter().zip(&body.force.hierarchy().rest) {
                // weights are solved to 1e-13, positions are of order one
                assert!((*x - map(*rest)).length() < 1e-12, "{pattern}: {:?}", *x - map(*rest));
            }
        }
    }
}

/// DEB-29, 30: who is active sees active points and such that follow active ones only; weights sum to one; the matter is
/// shared without a gap, so that a homogeneous strain has one energy whoever is at work.
#[test]
fn nothing_is_lost_between_levels() {
    let meshes = balls();
    let stretch = |x: Vec3| Vec3::new(1.1 * x.x, 0.95 * x.y + 0.1 * x.x, x.z);
    let mut energies = Vec::new();
    for pattern in PATTERNS {
        let mut body = Alone::new(body(&meshes, Coupling::Transpose, fixed(pattern)));
        let census = body.force.census(&body.memory, &body.scratch);
        assert!(census.active.iter().sum::<usize>() > 0);
        // the impulse of one newton second on each finest point comes to active points, whole
        let count = body.force.masses().len();
        let mut impulses = vec![Vec3::ZERO; body.rows.positions.len()];
        impulses[..count].fill(Vec3::X);
        body.force.give_back(Followers::All, &body.scratch, &mut impulses);
        let arrived: f64 = impulses.iter().map(|impulse| impulse.x).sum();
        assert!((arrived / count as f64 - 1.0).abs() < 1e-12, "{pattern}: {arrived}");
        let active = body.force.active(&body.scratch).to_vec();
        assert_eq!(active.len(), census.active.iter().sum::<usize>());
        let left = (0..impulses.len()).filter(|row| impulses[*row] != Vec3::ZERO);
        assert!(left.into_iter().all(|row| active.binary_search(&(row as u32)).is_ok()));
        body.place(stretch);
        energies.push(body.energy());
    }
    let first = energies[0];
    // sums of some thousand volumes in another order
    assert!(energies.iter().all(|energy| (energy / first - 1.0).abs() < 1e-12), "{energies:?}");
}

/// The force on active points is minus the slope of the energy, through ghosts; it has no sum and no moment.
#[test]
fn forces_are_slopes_of_the_energy() {
    let meshes = balls();
    for pattern in PATTERNS {
        let mut body = Alone::new(body(&meshes, Coupling::Transpose, fixed(pattern)));
        let bend = |x: Vec3| Vec3::new(x.x + 2.0 * x.y * x.y, x.y + 3.0 * x.x * x.z, 1.05 * x.z);
        body.place(bend);
        let mut force = vec![Vec3::ZERO; body.rows.positions.len()];
        let mut scratch = body.force.new_scratch();
        body.force.add_force(&body.at(), &mut scratch, &mut force);
        let largest = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        let sum: Vec3 = force.iter().copied().sum();
        let moment: Vec3 = body.rows.positions.iter().zip(&force).map(|(x, f)| x.cross(*f)).sum();
        let total: f64 = force.iter().map(|f| f.length()).sum();
        assert!(sum.length() < 1e-12 * total, "{pattern}: {sum:?}");
        assert!(moment.length() < 1e-12 * 0.05 * total, "{pattern}: {moment:?}");
        let active = body.force.active(&body.scratch).to_vec();
        let step = 1e-6;
        for row in active.iter().step_by(1 + active.len() / 7) {
            let row = *row as usize;
            for axis in Vec3::AXES {
                let mut energy_at = |side: f64| {
                    let kept = body.rows.positions[row];
                    body.rows.positions[row] = kept + axis * (side * step);
                    body.follow();
                    let energy = body.energy();
                    body.rows.positions[row] = kept;
                    energy
                };
                let slope = (energy_at(1.0) - energy_at(-1.0)) / (2.0 * step);
                body.follow();
                let error = (force[row].dot(axis) + slope).abs();
                // step² times a third derivative of order E h, and rounding of the energy over the step
                assert!(error < 1e-5 * largest, "{pattern}: row {row}: {error} of {largest}");
            }
        }
    }
}

fn world(force: LevelsForce, stepper: Staggered, period: f64, pins: impl Fn(Vec3) -> bool) -> World {
    world_with(force, Vec::new(), stepper, period, pins)
}

/// The same with forces from outside.
fn world_with(
    force: LevelsForce,
    outside: Vec<Box<dyn Force>>,
    stepper: Staggered,
    period: f64,
    pins: impl Fn(Vec3) -> bool,
) -> World {
    let mut kinematics = Kinematics::default();
    let rest = force.hierarchy().rest.clone();
    kinematics.add_unknowns(UnknownKind::Point, rest.len());
    let mut mass = Mass::new(rest.len());
    mass.diagonal[..force.masses().len()].copy_from_slice(force.masses());
    let pinned = (0..rest.len()).filter(|row| pins(rest[*row]));
    let constraints = pinned.map(|row| Constraint::pin(row as u32, rest[row])).collect();
    let system = System {
        name: "main".to_owned(),
        kinematics,
        mass,
        forces: std::iter::once(Box::new(force) as _).chain(outside).collect(),
        constraints,
        stepper: Box::new(stepper),
        steps_per_period: 1,
    };
    let state = State { systems: vec![system.initial_state(rest)], ..State::default() };
    Model { period, systems: vec![system], ..Model::default() }.start(state)
}

fn stepper(halvings: u32, filter: Filter) -> Staggered {
    Staggered { halvings, schedule: Schedule::Staggered, filter, velocity_jump: f64::INFINITY }
}

/// Sets velocities of all points, which followers share where they are linear.
fn set_velocities(world: &mut World, velocity: impl Fn(Vec3) -> Vec3) {
    let mut state = world.state().clone();
    let system = &mut state.systems[0];
    for (v, x) in system.v.iter_mut().zip(&system.q) {
        *v = velocity(*x);
    }
    world.resume(state).unwrap();
}

/// A free ball with all its levels at work keeps its momentum to rounding, also while points come and go; one way it
/// does not.
#[test]
fn the_transpose_keeps_momentum() {
    let criterion = Criterion { measure: Measure::Jump, refine: 0.08, coarsen: 0.02, settled: None };
    let velocity = |x: Vec3| Vec3::new(0.4 - 900.0 * x.z * x.y, 8.0 * x.x, 40.0 * x.x.abs());
    let drift = |coupling, choice| {
        let mut world = world(body(&balls(), coupling, choice), stepper(4, Filter::None), 4e-3, |_| false);
        set_velocities(&mut world, velocity);
        // fixed patterns come to be with the first step
        world.step().unwrap();
        let (start, mut most, mut counts) = (world.momentum().0, 0.0_f64, Vec::new());
        for _ in 0..60 {
            world.step().unwrap();
            most = most.max((world.momentum().0 - start).length() / start.length());
            let memory = &world.state().systems[0].memory;
            let census =
                world.model().systems[0].forces[0].levels().unwrap().census(memory, world.scratch(0, 0));
            counts.push(census.active);
        }
        (most, counts)
    };
    for choice in [fixed("if(x < 0, 2, if(y < 0, 1, 0))"), Choice::Adaptive(criterion)] {
        let (most, counts) = drift(Coupling::Transpose, choice.clone());
        assert!(most < 1e-10, "{most:e}");
        assert!(counts.iter().any(|active| active.iter().all(|count| *count > 0)), "{counts:?}");
    }
    let (one_way, _) = drift(Coupling::OneWay, fixed("if(x < 0, 2, if(y < 0, 1, 0))"));
    assert!(one_way > 1e-4, "{one_way:e}");
}

/// What a body's own loads have made by the date at which it is settled does not keep the finest mesh at work; what comes on top does, and when it
/// goes points are again who they were.
#[test]
fn own_loads_do_not_refine() {
    let twist = |strength: f64| {
        move |x: Vec3| {
            let (s, c) = (strength * x.z).sin_cos();
            Vec3::new(c * x.x - s * x.y, s * x.x + c * x.y, x.z)
        }
    };
    let criterion = Criterion { measure: Measure::Jump, refine: 0.05, coarsen: 0.0125, settled: Some(0.1) };
    let mut body = Alone::new(body(&balls(), Coupling::Transpose, Choice::Adaptive(criterion)));
    let mut counts = Vec::new();
    // the load grows until it is settled at 0.1 s, then something is added, and taken away
    for (time, strength) in [
        (0.0, 0.0),
        (0.05, 60.0),
        (0.1, 60.0),
        (0.2, 60.0),
        (0.3, 140.0),
        (0.4, 140.0),
        (0.5, 60.0),
        (0.6, 60.0),
    ] {
        body.place(twist(strength));
        body.rows.time = time;
        body.force.adapt(&DIVISION, &mut body.rows, &mut body.memory, &mut body.scratch);
        counts.push(body.force.census(&body.memory, &body.scratch).active);
    }
    assert_eq!(counts[1][..2], [0, 0], "{counts:?}");
    assert_eq!(counts[2][2], 0, "{counts:?}");
    assert!(counts[5][2] > 1000, "{counts:?}");
    assert_eq!(counts[6..], counts[2..4], "{counts:?}");
}

/// What is told of the active points is what is compared: nothing of a twist at which the body has settled.
#[test]
fn the_variation_is_told() {
    let criterion = Criterion { measure: Measure::Jump, refine: 1.0, coarsen: 0.1, settled: Some(0.1) };
    let mut body = Alone::new(body(&balls(), Coupling::Transpose, Choice::Adaptive(criterion)));
    let greatest = |body: &Alone| {
        let told = body.force.variation(&body.rows.positions, &body.memory, &body.scratch);
        assert_eq!(told.len(), body.force.census(&body.memory, &body.scratch).active_rows.len());
        told.into_iter().map(|(_, variation)| variation).fold(0.0, f64::max)
    };
    body.place(|x| Vec3::new(x.x + 3.0 * x.z * x.z, x.y, x.z));
    for (time, is_settled) in [(0.0, false), (0.1, true)] {
        body.rows.time = time;
        body.force.adapt(&DIVISION, &mut body.rows, &mut body.memory, &mut body.scratch);
        assert_eq!(greatest(&body) == 0.0, is_settled, "{time}");
    }
}

/// DEB-12, 32: a twist refines; when it has gone the coarsest points are alone again, without a ghost.
#[test]
fn points_come_and_go() {
    come_and_go(Measure::Jump);
    come_and_go(Measure::Laplacian);
}

fn come_and_go(measure: Measure) {
    let criterion = Criterion { measure, refine: 0.05, coarsen: 0.0125, settled: None };
    let force = body(&balls(), Coupling::Transpose, Choice::Adaptive(criterion));
    let mut body = Alone::new(force);
    let twist = |strength: f64| {
        move |x: Vec3| {
            let angle = strength * x.z;
            let (s, c) = angle.sin_cos();
            Vec3::new(c * x.x - s * x.y, s * x.x + c * x.y, x.z)
        }
    };
    let mut census = Vec::new();
    for strength in [0.0, 60.0, 60.0, 60.0, 60.0, 0.0, 0.0, 0.0, 0.0] {
        body.place(twist(strength));
        body.force.adapt(&DIVISION, &mut body.rows, &mut body.memory, &mut body.scratch);
        census.push(body.force.census(&body.memory, &body.scratch));
        assert_eq!(census.last(), Some(&body.force.census(&body.memory, &body.force.new_scratch())));
    }
    let (first, twisted, last) = (&census[0], &census[4], &census[8]);
    assert_eq!(first.active[1..], [0, 0]);
    assert!(twisted.active[2] > 100, "{:?}", twisted.active);
    assert_eq!(census[3], *twisted, "what is refined enough stays");
    assert_eq!(last, first);
    assert_eq!(last.ghosts, [0, 0, 0]);
    // a turn of the whole is no reason to refine
    body.place(|x| Vec3::new(-x.y, x.x, x.z));
    body.force.adapt(&DIVISION, &mut body.rows, &mut body.memory, &mut body.scratch);
    assert_eq!(body.force.census(&body.memory, &body.scratch), *first);
}

/// V-34: with its own stiffness taken implicitly a point bears twice the step of modified Euler and more. The limits follow
/// from the spectra of the cube's stiffness with and without its diagonal blocks.
#[test]
fn semi_implicit_points_bear_twice_the_step() {
    let limits = [
        (20_000.0, 2.0, 5.62e-3, 15.2e-3),
        (20_000.0, 4.0, 2.83e-3, 7.56e-3),
        (500_000.0, 2.0, 1.38e-3, 2.68e-3),
        (500_000.0, 4.0, 0.70e-3, 1.35e-3),
    ];
    for (lambda, cells, explicit, semi_implicit) in limits {
        let is_stable = |filter, period: f64| {
            let meshes = [cube(cells)];
            let all: Vec<&Mesh> = meshes.iter().collect();
            let force = LevelsForce::new(LevelsDescription {
                name: "cube.material".to_owned(),
                meshes: &all,
                first_row: 0,
                materials: &[material("linear", [lambda, 7000.0])],
                material_of_cell: &vec![0; meshes[0].cell_count()],
                coupling: Coupling::OneWay,
                loops: Loops::Activated,
                stiffness: Stiffness::Own,
                choice: fixed("0"),
                viscosity: 0.0,
                mass_damping: 0.0,
                budget: None,
                cuts: Vec::new(),
                supports: Vec::new(),
            });
            let mut world = world(force.unwrap(), stepper(0, filter), period, |x| x.x < 1e-9);
            set_velocities(&mut world, |x| Vec3::new(x.z * x.x, x.y * x.y - x.x, 3.0 * x.x + x.y) * 1e-3);
            let is_slow = |world: &World| world.rows(0).velocities.iter().all(|v| v.length() < 1.0);
            (0..600).all(|_| world.step().is_ok() && is_slow(&world))
        };
        assert!(is_stable(Filter::None, 0.98 * explicit), "{lambda} {cells}");
        assert!(!is_stable(Filter::None, 1.05 * explicit), "{lambda} {cells}");
        // nearly incompressible, a little less than twice
        if lambda < 1e5 {
            assert!(is_stable(Filter::SemiImplicit, 2.0 * explicit), "{cells}");
        }
        assert!(is_stable(Filter::SemiImplicit, 0.98 * semi_implicit), "{lambda} {cells}");
        assert!(!is_stable(Filter::SemiImplicit, 1.1 * semi_implicit), "{lambda} {cells}");
    }
}

/// A ball of levels whose steps may evaluate so many stresses.
fn budgeted(meshes: &[Mesh], criterion: Criterion, budget: Option<f64>) -> LevelsForce {
    let all: Vec<&Mesh> = meshes.iter().collect();
    LevelsForce::new(LevelsDescription {
        name: "ball.material".to_owned(),
        meshes: &all,
        first_row: 0,
        materials: &[material("st_venant_kirchhoff", [20000.0, 7000.0])],
        material_of_cell: &vec![0; meshes[2].cell_count()],
        coupling: Coupling::Transpose,
        loops: Loops::Activated,
        stiffness: Stiffness::Own,
        choice: Choice::Adaptive(criterion),
        viscosity: 0.0,
        mass_damping: 0.0,
        budget,
        cuts: Vec::new(),
        supports: Vec::new(),
    })
    .unwrap()
}

/// DEB-39: a budget is kept while the whole body asks for more, and nothing is refined above 95 % of it.
#[test]
fn budgets_are_kept() {
    let meshes = balls();
    let spent = |budget: Option<f64>| {
        let criterion = Criterion { measure: Measure::Jump, refine: 0.01, coarsen: 0.002, settled: None };
        let mut body = Alone::new(budgeted(&meshes, criterion, budget));
        for _ in 0..12 {
            body.place(|x| Vec3::new(x.x + 4.0 * x.y * x.z, x.y + 6.0 * x.x * x.x, x.z));
            body.force.adapt(&DIVISION, &mut body.rows, &mut body.memory, &mut body.scratch);
        }
        body.force.evaluations(&DIVISION, &body.scratch) as f64
    };
    let most = spent(None);
    for part in [0.3, 0.6] {
        let spent = spent(Some(part * most));
        assert!(spent <= part * most && spent > 0.3 * part * most, "{spent} of {}", part * most);
    }
}

/// What a look came to is kept for the next one on the same grounds, and changes nothing: a run that goes on from a snapshot knows nothing of it. While points
/// come, where a budget lets few come, where velocities ask for rates that it counts, where points stay and go.
#[test]
fn looks_follow_from_memory_alone() {
    let meshes = balls();
    let criterion = Criterion { measure: Measure::Jump, refine: 0.05, coarsen: 0.0125, settled: None };
    let strengths =
        [0.0, 20.0, 20.0, 60.0, 60.0, 60.0, 61.0, 62.0, 64.0, 70.0, 80.0, 60.0, 30.0, 30.0, 0.0, 0.0, 0.0];
    let asking = Division { velocity_jump: 0.05, ..DIVISION };
    for (budget, division) in
        [(None, DIVISION), (Some(3000.0), DIVISION), (None, asking), (Some(3000.0), asking)]
    {
        let looks = |forgets: bool| {
            let mut body = Alone::new(budgeted(&meshes, criterion, budget));
            let look = |strength: f64| {
                body.place(|x| {
                    let (s, c) = (strength * x.z).sin_cos();
                    Vec3::new(c * x.x - s * x.y, s * x.x + c * x.y, x.z)
                });
                if forgets {
                    body.scratch = body.force.new_scratch();
                }
                body.force.adapt(&division, &mut body.rows, &mut body.memory, &mut body.scratch);
                body.memory.clone()
            };
            strengths.map(look)
        };
        assert!(looks(true) == looks(false), "{budget:?}, {division:?}");
    }
}

/// What points are asked before a step is counted with it: each sample at work once.
#[test]
fn asking_first_is_counted() {
    let meshes = [cube(2.0), cube(4.0)];
    let force = body_of(&meshes, Coupling::Transpose, fixed("1"), Stiffness::Own);
    let mut body = Alone::new(force);
    let mut spent = |division: &Division| {
        body.force.adapt(division, &mut body.rows, &mut body.memory, &mut body.scratch);
        let workload = body.force.workload(division, &body.memory, &body.scratch);
        // what the scratch of the step knows is what is found anew
        assert_eq!(workload, body.force.workload(division, &body.memory, &body.force.new_scratch()));
        (body.force.evaluations(division, &body.scratch), workload)
    };
    let (plain, of_plain) = spent(&DIVISION);
    // so much that nothing changes by more
    let (asked, of_asked) = spent(&Division { velocity_jump: 1e9, ..DIVISION });
    let samples = 6 * 4_usize.pow(3);
    assert_eq!(asked, plain + samples);
    assert_eq!((of_plain.first, of_asked.first), (0, samples));
    assert_eq!(of_asked.of_rate, of_plain.of_rate);
}

/// Linear tetrahedra are too stiff by about the square of their size: the share of moduli that makes them yield as the finest falls
/// with it, and the finest keeps its own.
#[test]
fn coarse_meshes_yield_as_the_finest() {
    let meshes = [cube(2.0), cube(4.0), cube(8.0)];
    let force = body_of(&meshes, Coupling::Transpose, fixed("0"), Stiffness::AsFinest);
    let [coarse, middle, fine] = force.share_of_moduli()[..] else { unreachable!() };
    assert_eq!(fine, 1.0);
    // 1/C = 1/C₀ (1 + a h²), h in cells of the finest: a quarter of the size, four times as near
    assert!(0.3 < coarse && coarse < middle && middle < 1.0, "{coarse} {middle}");
    let a = |share: f64, h_sq: f64| (1.0 - share) / (share * h_sq - 1.0);
    // two cells across are far from the limit, which is approached from below
    assert!((0.5..1.0).contains(&(a(coarse, 16.0) / a(middle, 4.0))), "{coarse} {middle}");
}

/// Coarse points at the ends of an ellipsoid have next to no matter to hold them, and yield without end to what hangs on them: no level is made stiffer for
/// that, nor its steps any shorter than with the moduli of its own.
#[test]
fn coarse_meshes_are_never_stiffened() {
    for (semi_axes, size, ratio) in [([0.05, 0.03, 0.035], 0.01, 1.8), ([0.06, 0.03, 0.03], 0.009, 1.6_f64)] {
        let fine = ellipsoid(semi_axes, size);
        let coarse = |finer: i32| coarser(&fine, mean_edge(&fine) * ratio.powi(finer)).unwrap();
        let meshes = [coarse(2), coarse(1), fine.clone()];
        let of = |stiffness| body_of(&meshes, Coupling::Transpose, fixed("0"), stiffness);
        let (own, softened) = (of(Stiffness::Own), of(Stiffness::AsFinest));
        let shares = softened.share_of_moduli();
        assert!(shares.iter().all(|share| *share > 0.0 && *share <= 1.0), "{semi_axes:?} {shares:?}");
        let shortest = [&softened, &own].map(|force| force.shortest_interval(Filter::None));
        assert!(shortest[0] >= shortest[1], "{semi_axes:?} {shares:?}");
    }
}

/// Points of the finest mesh that are at work where the coarse one would be, were the body held nowhere.
fn fine_points(meshes: &[Mesh], is_held: impl Fn(Vec3) -> bool) -> Vec<Vec3> {
    let force = body_held(meshes, Coupling::Transpose, fixed("0"), Stiffness::Own, is_held);
    let finest = meshes.last().unwrap().points.len();
    let alone = Alone::new(force);
    let active = alone.force.active(&alone.scratch).iter().map(|row| *row as usize);
    active.filter(|row| *row < finest).map(|row| alone.force.hierarchy().rest[row]).collect()
}

/// A coarse mesh with one point, or none, where the finest has a patch would turn about it: finer points stay at work there, and there alone. One that has
/// the corners of a face holds it.
#[test]
fn supports_hold_at_every_level() {
    let meshes = [cube(2.0), cube(8.0)];
    let at_corner = |x: Vec3| x.x < 1e-9 && x.y < 0.03 && x.z < 0.03;
    let beside = |x: Vec3| x.x < 1e-9 && (0.01..0.04).contains(&x.y) && (0.01..0.04).contains(&x.z);
    for is_held in [&at_corner as &dyn Fn(Vec3) -> bool, &beside] {
        let fine = fine_points(&meshes, is_held);
        let held = meshes[1].points.iter().filter(|place| is_held(**place));
        assert!(held.clone().count() == 9 && held.clone().all(|place| fine.contains(place)));
        // no farther than the Voronoi cells of the corners of a coarse tetrahedron
        assert!(fine.iter().all(|x| x.to_array().into_iter().all(|x| x < 0.08)), "{fine:?}");
    }
    assert!(fine_points(&meshes, |x| x.x < 1e-9).is_empty());
    assert!(fine_points(&meshes, |_| false).is_empty());
}

/// A body that is held is compared as it is held: the share of a clamped cube's moduli is another than that of a free one, and still one that softens.
#[test]
fn clamped_meshes_yield_as_the_finest() {
    let meshes = [cube(2.0), cube(4.0), cube(8.0)];
    let of = |is_held: fn(Vec3) -> bool| {
        let force = body_held(&meshes, Coupling::Transpose, fixed("0"), Stiffness::AsHeld, is_held);
        force.share_of_moduli().to_vec()
    };
    let (clamped, free) = (of(|x| x.x < 1e-9), of(|_| false));
    assert!(0.3 < clamped[0] && clamped[0] < clamped[1] && clamped[1] < 1.0, "{clamped:?}");
    assert!(clamped[0] != free[0], "{clamped:?} {free:?}");
    // two points are a hinge: the loads of a body that is free say how it yields
    assert_eq!(of(|x| x.x < 1e-9 && x.y < 1e-9 && (x.z < 1e-9 || x.z > 0.0999)), free);
}

/// A contact that tells what it reaches, or says that it reaches everything; it counts how often it is asked.
struct Told {
    contact: ShapeContact,
    reaches_all: bool,
    asked: Arc<AtomicUsize>,
}

impl Force for Told {
    fn name(&self) -> &str {
        self.contact.name()
    }

    fn declaration(&self) -> Declaration {
        self.contact.declaration()
    }

    fn memory_len(&self) -> usize {
        self.contact.memory_len()
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        self.contact.initial_memory(memory);
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        self.contact.energy(at, scratch)
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.contact.add_force(at, scratch, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.contact.add_differential(at, weights, delta, scratch, out);
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.contact.visit_cliques(pairs, visit);
    }

    fn visit_reach(&self, at: &Configuration, slack: f64, visit: &mut dyn FnMut(u32)) {
        self.contact.visit_reach(at, if self.reaches_all { f64::INFINITY } else { slack }, visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.contact.add_blocks(at, weights, scratch, matrix);
    }

    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], pairs: &mut [Pair]) {
        self.contact.advance_memory(at, timestep, memory, pairs);
    }

    fn as_any(&self) -> &dyn std::any::Any {
        self
    }
}

/// A ball of three meshes slides onto a floor with friction, past a tool that it never meets: what is out of reach is left out of most ticks, and
/// the state has the same bits as if all had been asked in every tick (DEB-45, DEB-46).
#[test]
fn what_is_out_of_reach_changes_nothing() {
    let meshes = balls();
    let finest = meshes.last().unwrap();
    let run = |reaches_all: bool| {
        let asked = [0, 1].map(|_| Arc::new(AtomicUsize::new(0)));
        let shapes: [(&str, Box<dyn Shape>); 2] = [
            ("floor", Box::new(Plane { point: Vec3::X * -0.058, normal: Vec3::X })),
            ("tool", Box::new(Sphere::new(Vec3::Y * 0.2, 0.02))),
        ];
        let contact = |((name, shape), asked): ((&str, Box<dyn Shape>), &Arc<AtomicUsize>)| {
            let point = |row: &u32| {
                let start = finest.points[*row as usize];
                ContactPoint { row: *row, share: 1.0, start }
            };
            let points = finest.boundary_surface().mesh_points.iter().map(point).collect();
            let law = ContactLaw {
                stiffness: 50.0,
                damping: 0.0,
                friction: 0.4,
                tangential_stiffness: 50.0,
                thickness: 1e-3,
            };
            let contact = ShapeContact::new(name, points, shape, RigidMotion::default(), law).unwrap();
            Box::new(Told { contact, reaches_all, asked: asked.clone() }) as Box<dyn Force>
        };
        let outside = shapes.into_iter().zip(&asked).map(contact).collect();
        let force = body(&meshes, Coupling::Transpose, fixed(PATTERNS[2]));
        let mut world = world_with(force, outside, stepper(5, Filter::None), 5e-3, |_| false);
        set_velocities(&mut world, |_| Vec3::new(-0.1, 0.05, 0.0));
        let mut touched = false;
        for _ in 0..40 {
            world.step().unwrap();
            touched |=
                world.energy().by_force.iter().any(|(name, energy)| name == "floor" && energy.stored > 0.0);
        }
        assert!(touched);
        let asked = asked.map(|asked| asked.load(Ordering::Relaxed));
        (world.state().clone(), asked)
    };
    let (told, few) = run(false);
    let (all, many) = run(true);
    let bits = |state: &State| {
        let system = &state.systems[0];
        let vectors = system.q.iter().chain(&system.v).flat_map(|v| v.to_array());
        vectors.chain(system.memory.iter().copied()).map(f64::to_bits).collect::<Vec<_>>()
    };
    assert_eq!(bits(&told), bits(&all));
    // 32 ticks a period, of which the floor is out of reach before it is met, and the tool always
    assert_eq!(many, [40 * 32; 2]);
    assert!(few[0] < many[0] && few[1] == 0, "{few:?}");
}
