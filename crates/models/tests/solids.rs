//! The battery for every law on every element, and the discrete answers of independent solvers.
#![allow(non_snake_case)]

use std::sync::Arc;

use souple_engine::implicit::NewtonSettings;
use souple_engine::linear::SolverSettings;
use souple_engine::steppers::StaticEquilibrium;
use souple_engine::{
    Configuration, Constraint, Force, Kinematics, Mass, Model, Scratch, State, System, TangentWeights,
    UnknownKind,
};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::{ElementKind, Mesh, NodePlace, QuadratureRule};
use souple_models::materials::{self, AnyLaw, Material};
use souple_models::solids::{
    Quadrature, RayleighDamping, Section, SolidDescription, SolidForce, Viscosity, consistent_mass,
    lumped_mass, uniform_mass,
};
use souple_solve::dense::{self, take_absolute};
use souple_solve::{BlockMatrix, LinearOperator, PatternBuilder};
use souple_table::{Value, Values};

use crate::common;

const ELEMENTS: [&str; 11] = [
    "tet4",
    "hex8",
    "prism6",
    "pyramid5",
    "mixed",
    "tet10",
    "hex20",
    "hex27",
    "prism15",
    "pyramid13",
    "mixed_quadratic",
];

fn bar(size: [f64; 3], cells: [f64; 3], element: &str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector(size))
        .with("cells", Value::Vector(cells))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

fn material(law: &str) -> Material {
    common::material_of(materials::TABLE.find(law).unwrap(), 1e7, 0.3)
}

/// A law as text.
fn text(energy: &str) -> Material {
    let entry = materials::TABLE.find("hyperelastic").unwrap();
    let (mu, lambda) = (1e7 / 2.6, 3e6 / (1.3 * 0.4));
    let parameters = [
        ("mu".to_owned(), format!("{mu} Pa")),
        ("lambda".to_owned(), format!("{lambda} Pa")),
        ("a".to_owned(), "[1, 2, -1]".to_owned()),
    ];
    let values = Values::new()
        .with("energy", Value::Text(energy))
        .with("parameters", Value::Texts(&parameters))
        .with("density", Value::Number(1000.0));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

/// The compiled laws as text, and others: one for every kind of instruction.
const TEXTS: [(&str, &str); 6] = [
    ("linear", "mu*dot(eps, eps) + lambda/2*tr(eps)^2"),
    ("st_venant_kirchhoff", "mu*dot(E, E) + lambda/2*tr(E)^2"),
    ("neo_hookean", "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2"),
    ("ogden", "mu/2*(l1^3 + l2^3 + l3^3 - 3) - 1.5*mu*ln(J) + lambda/2*(J - 1)^2"),
    ("isochoric", "mu/2*(I1_bar - 3) + mu/5*(I2_bar - 3) + mu*(I1_bar - 3)^2 + lambda/2*(J - 1)^2"),
    ("fibres", "mu/2*(I1 - 3) - mu*ln(J) + lambda/2*ln(J)^2 + mu/4*(exp(2*max(I4(a) - 1, 0)^2) - 1)"),
];

/// Every material of the battery with its name.
fn all_materials() -> Vec<(String, Material)> {
    let known = AnyLaw::ALL.iter().map(|law| (law.entry().name.to_owned(), material(law.entry().name)));
    known.chain(TEXTS.map(|(name, energy)| (format!("{name} as text"), text(energy)))).collect()
}

fn describe<'a>(mesh: &'a Mesh, materials: &'a [Material], of_cell: &'a [u16]) -> SolidDescription<'a> {
    let quadrature = Quadrature::Default;
    SolidDescription {
        name: "bar".into(),
        mesh,
        first_row: 0,
        materials,
        material_of_cell: of_cell,
        axes: &[],
        quadrature,
        section: Section::Solid,
    }
}

fn at<'a>(positions: &'a [Vec3], velocities: &'a [Vec3]) -> Configuration<'a> {
    Configuration {
        positions,
        velocities,
        time: 0.0,
        load: 1.0,
        memory: &[],
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

/// A small smooth deformation without symmetry.
fn bent(mesh: &Mesh) -> Vec<Vec3> {
    let wave =
        |p: &Vec3| Vec3::new((7.0 * p.y).sin(), (5.0 * p.x + p.z).cos(), (3.0 * p.x - 2.0 * p.y).sin());
    mesh.points.iter().map(|p| *p + wave(p) * 0.02).collect()
}

fn directions(count: usize) -> Vec<Vec3> {
    let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin();
    (0..count).map(|i| Vec3::new(number(i, 0.1), number(i, 0.2), number(i, 0.3))).collect()
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

fn force_at(force: &dyn Force, scratch: &mut Scratch, positions: &[Vec3], velocities: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions, velocities), scratch, &mut out);
    out
}

/// The derivative battery of one force, at `(x, v)`: tangent products against central differences of the
/// force, blocks against products.
fn check_tangent(name: &str, force: &dyn Force, x: &[Vec3], v: &[Vec3]) {
    let mut scratch = force.new_scratch();
    let direction = directions(x.len());
    let step = 1e-7;
    let moved = |base: &[Vec3], sign: f64| -> Vec<Vec3> {
        base.iter().zip(&direction).map(|(x, d)| *x + *d * (sign * step)).collect()
    };
    for (a, b) in [(1.0, 0.0), (0.0, 1.0)] {
        let weights = TangentWeights { position: a, velocity: b };
        let mut product = vec![Vec3::ZERO; x.len()];
        force.add_differential(&at(x, v), weights, &direction, &mut scratch, &mut product);
        let shifted = |sign: f64, scratch: &mut Scratch| {
            if a == 1.0 {
                force_at(force, scratch, &moved(x, sign), v)
            } else {
                force_at(force, scratch, x, &moved(v, sign))
            }
        };
        let (plus, minus) = (shifted(1.0, &mut scratch), shifted(-1.0, &mut scratch));
        let numeric: Vec<Vec3> = plus.iter().zip(&minus).map(|(p, m)| (*p - *m) * (0.5 / step)).collect();
        let difference: Vec<Vec3> = product.iter().zip(&numeric).map(|(p, n)| *p - *n).collect();
        // differences: step² times the third derivative, and rounding of forces 1e-16 |f| / step
        let scale = norm(&product).max(1e-9 * norm(&plus) / step);
        assert!(norm(&difference) <= 2e-6 * scale + 1e-300, "{name}: {} of {scale}", norm(&difference));
        let mut pattern = PatternBuilder::new(x.len());
        force.visit_cliques(&[], &mut |rows| pattern.add_clique(rows).unwrap());
        let mut matrix = BlockMatrix::zeros(Arc::new(pattern.build().unwrap()));
        force.add_blocks(&at(x, v), weights, &mut scratch, &mut matrix);
        let mut by_matrix = vec![Vec3::ZERO; x.len()];
        matrix.apply(&direction, &mut by_matrix);
        let difference: Vec<Vec3> = product.iter().zip(&by_matrix).map(|(p, n)| *p - *n).collect();
        assert!(norm(&difference) <= 1e-12 * norm(&product) + 1e-300, "{name}: blocks differ from products");
        if force.declaration().symmetric_tangent {
            let asymmetry = matrix.asymmetry();
            assert!(asymmetry <= 1e-12 * matrix.mean_diagonal().abs(), "{name}: asymmetry {asymmetry}");
        }
    }
}

/// For every law on every element under every rule: force = -∂E/∂x, tangent = ∂f/∂x, blocks = products, symmetry, zero
/// at rest, no force in rigid motion and no net force or torque where the law is objective.
#[test]
fn battery_of_every_law_on_every_element() {
    ELEMENTS[..5].iter().for_each(|element| check_battery(element));
}

/// The same for quadratic elements.
#[test]
fn battery_of_every_law_on_every_quadratic_element() {
    ELEMENTS[5..].iter().for_each(|element| check_battery(element));
}

/// Every rule of every kind of a mesh, the other kinds keeping their own.
fn rules_of(mesh: &Mesh) -> impl Iterator<Item = (String, Quadrature)> {
    let rules = |kind: ElementKind| {
        let name = move |rule: &QuadratureRule| format!("{kind} by {}", rule.name);
        kind.rules().iter().map(move |rule| (name(rule), Quadrature::Default.with(kind, rule)))
    };
    mesh.blocks.iter().flat_map(move |block| rules(block.kind))
}

fn check_battery(element: &str) {
    let mesh = bar([1.0, 0.4, 0.3], [4.0, 2.0, 1.0], element);
    for (law, material) in all_materials() {
        for (rule, quadrature) in rules_of(&mesh) {
            check_law(&format!("{law} on {rule}"), &mesh, &material, quadrature);
        }
    }
}

fn check_law(name: &str, mesh: &Mesh, material: &Material, quadrature: Quadrature) {
    let (materials, of_cell) = ([material.clone()], vec![0; mesh.cell_count()]);
    let force = SolidForce::new(&SolidDescription { quadrature, ..describe(mesh, &materials, &of_cell) });
    let force = force.unwrap();
    let mut scratch = force.new_scratch();
    let (x, v) = (bent(mesh), vec![Vec3::ZERO; mesh.points.len()]);
    check_tangent(name, &force, &x, &v);
    // force = -dE/dx along a direction
    let f = force_at(&force, &mut scratch, &x, &v);
    let (direction, step) = (directions(x.len()), 1e-6);
    let energy = |sign: f64, scratch: &mut Scratch| {
        let moved: Vec<Vec3> = x.iter().zip(&direction).map(|(x, d)| *x + *d * (sign * step)).collect();
        force.energy(&at(&moved, &v), scratch).stored
    };
    let slope = (energy(1.0, &mut scratch) - energy(-1.0, &mut scratch)) / (2.0 * step);
    let power = dot(&f, &direction);
    let scale = norm(&f) * norm(&direction);
    assert!((slope + power).abs() <= 1e-7 * scale, "{name}: {slope} {power}");
    // rest
    let rest = force_at(&force, &mut scratch, &mesh.points, &v);
    assert!(norm(&rest) <= 1e-12 * norm(&f), "{name}: {} N at rest", norm(&rest));
    // rigid motion and net force
    if force.declaration().internal {
        let Q = exponential(Vec3::new(1.0, -2.0, 0.7));
        let turned: Vec<Vec3> = mesh.points.iter().map(|p| Q * *p + Vec3::new(3.0, 1.0, -2.0)).collect();
        let rigid = force_at(&force, &mut scratch, &turned, &v);
        // positions of size 4 m carry rounding of 4e-16 m, strains of 1e-14 in cells of 0.1 m
        assert!(norm(&rigid) <= 1e-9 * norm(&f), "{name}: {} N in rigid motion", norm(&rigid));
        let net: Vec3 = f.iter().copied().sum();
        let torque: Vec3 = x.iter().zip(&f).map(|(x, f)| x.cross(*f)).sum();
        assert!(net.length() <= 1e-11 * norm(&f) && torque.length() <= 1e-11 * norm(&f), "{name}");
    }
}

/// Tangents made definite: those of cells at rest to the last bit, and no negative eigenvalue where all cells are turned
/// inside out, which the exact tangents of most laws have there.
#[test]
fn definite_tangents_have_no_negative_eigenvalue() {
    let weights = TangentWeights { position: -1.0, velocity: 0.0 };
    for element in ["tet4", "hex8", "mixed", "tet10"] {
        let mesh = bar([1.0, 0.25, 0.25], [4.0, 1.0, 1.0], element);
        let count = mesh.points.len();
        let inside_out: Vec<Vec3> = mesh.points.iter().map(|p| Vec3::new(p.x, p.y, -0.7 * p.z)).collect();
        let mut indefinite = Vec::new();
        for (law, material) in all_materials() {
            let force = SolidForce::new(&describe(&mesh, &[material], &vec![0; mesh.cell_count()])).unwrap();
            let mut scratch = force.new_scratch();
            let mut pattern = PatternBuilder::new(count);
            force.visit_cliques(&[], &mut |rows| pattern.add_clique(rows).unwrap());
            let pattern = Arc::new(pattern.build().unwrap());
            let mut matrix = |x: &[Vec3], is_definite: bool| {
                let mut matrix = BlockMatrix::zeros(pattern.clone());
                let (v, scratch) = (vec![Vec3::ZERO; count], &mut scratch);
                if is_definite {
                    force.add_definite_blocks(&at(x, &v), weights, scratch, &mut matrix);
                } else {
                    force.add_blocks(&at(x, &v), weights, scratch, &mut matrix);
                }
                matrix
            };
            let [exact, definite] = [false, true].map(|is_definite| matrix(&mesh.points, is_definite));
            assert_eq!(exact.values(), definite.values(), "{law} on {element} at rest");
            let [exact, definite] = [false, true].map(|is_definite| matrix(&inside_out, is_definite));
            let is_indefinite = |matrix: &BlockMatrix| {
                take_absolute(3 * count, &mut dense(matrix), &mut dense::Workspace::default())
            };
            assert!(!is_indefinite(&definite), "{law} on {element}");
            indefinite.push(is_indefinite(&exact));
        }
        assert!(indefinite.contains(&true), "{element}");
    }
}

/// By rows.
fn dense(matrix: &BlockMatrix) -> Vec<f64> {
    let n = 3 * matrix.pattern().block_count();
    let mut out = vec![0.0; n * n];
    for row in 0..matrix.pattern().block_count() {
        for slot in matrix.pattern().slots(row) {
            let column = matrix.pattern().columns()[slot] as usize;
            for (j, entries) in matrix.values()[slot].columns.iter().enumerate() {
                for (i, entry) in entries.to_array().into_iter().enumerate() {
                    out[n * (3 * row + i) + 3 * column + j] = entry;
                }
            }
        }
    }
    out
}

/// Laws as text give the forces, energies and tangents of the same laws compiled ahead, whatever the rule of quadrature.
#[test]
fn texts_agree_with_compiled_laws() {
    for (law, energy) in &TEXTS[..3] {
        for element in ELEMENTS {
            for quadrature in [Quadrature::Default, Quadrature::Full] {
                let mesh = bar([1.0, 0.4, 0.3], [4.0, 3.0, 2.0], element);
                let of_cell = vec![0; mesh.cell_count()];
                let (x, v) = (bent(&mesh), vec![Vec3::ZERO; mesh.points.len()]);
                let results = [material(law), text(energy)].map(|material| {
                    let description = SolidDescription {
                        quadrature,
                        section: Section::Solid,
                        ..describe(&mesh, std::slice::from_ref(&material), &of_cell)
                    };
                    // where bodies choose, some of these texts are run as the laws that they are
                    let force = SolidForce::of_samples(&description).unwrap();
                    let mut scratch = force.new_scratch();
                    let mut product = vec![Vec3::ZERO; x.len()];
                    let weights = TangentWeights { position: 2.0, velocity: 0.0 };
                    force.add_differential(
                        &at(&x, &v),
                        weights,
                        &directions(x.len()),
                        &mut scratch,
                        &mut product,
                    );
                    let energy = force.energy(&at(&x, &v), &mut scratch).stored;
                    (force_at(&force, &mut scratch, &x, &v), product, energy)
                });
                let [(f, df, energy), (text_f, text_df, text_energy)] = results;
                for (compiled, text) in [(f, text_f), (df, text_df)] {
                    let difference: Vec<Vec3> = compiled.iter().zip(&text).map(|(a, b)| *a - *b).collect();
                    // roundings of some tens of operations in another order, and of cancelling stresses
                    assert!(norm(&difference) <= 1e-12 * norm(&compiled), "{law} on {element}");
                }
                assert!((energy - text_energy).abs() <= 1e-12 * energy, "{law} on {element}");
            }
        }
    }
}

/// Kelvin–Voigt stress has no force in rigid rotation, dissipates otherwise, and its tangents are exact;
/// Rayleigh damping is linear and symmetric.
#[test]
fn damping_forces() {
    for element in ELEMENTS {
        let mesh = bar([1.0, 0.4, 0.3], [4.0, 2.0, 2.0], element);
        let (materials, of_cell) = ([material("neo_hookean")], vec![0; mesh.cell_count()]);
        let (x, v) = (bent(&mesh), directions(mesh.points.len()));
        let viscosity = Viscosity::new(&describe(&mesh, &materials, &of_cell), 50.0).unwrap();
        let rayleigh = RayleighDamping::new(&describe(&mesh, &materials, &of_cell), 0.01).unwrap();
        for (name, force) in [("viscosity", &viscosity as &dyn Force), ("rayleigh", &rayleigh)] {
            check_tangent(&format!("{name} on {element}"), force, &x, &v);
            let power = dot(&force_at(force, &mut force.new_scratch(), &x, &v), &v);
            assert!(power < 0.0, "{name} on {element} gives {power} W");
            // the heat of a step is the power taken
            let mut memory = [0.0];
            force.advance_memory(&at(&x, &v), 0.5, &mut memory, &mut []);
            assert!(
                (memory[0] + 0.5 * power).abs() < 1e-12 * memory[0],
                "{name} on {element}: {memory:?} {power}"
            );
        }
        let omega = Vec3::new(0.3, 2.0, -1.0);
        let spin: Vec<Vec3> = x.iter().map(|x| omega.cross(*x)).collect();
        let rigid = norm(&force_at(&viscosity, &mut viscosity.new_scratch(), &x, &spin));
        let free = norm(&force_at(&viscosity, &mut viscosity.new_scratch(), &x, &v));
        assert!(rigid <= 1e-12 * free, "{element}: {rigid} N in rigid rotation");
    }
}

/// A clamped bar that swings while `damping` takes its energy: what is missing at the end from kinetic energy, stored
/// energy and heat, and the heat, relative to the energy at the start.
fn unaccounted(
    damping: &dyn Fn(&SolidDescription) -> Box<dyn Force>,
    stepper: &str,
    steps: u32,
) -> (f64, f64) {
    let mesh = bar([1.0, 0.4, 0.3], [4.0, 2.0, 2.0], "tet4");
    let (materials, of_cell) = ([material("neo_hookean")], vec![0; mesh.cell_count()]);
    let description = describe(&mesh, &materials, &of_cell);
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
    let mut mass = Mass::new(mesh.points.len());
    lumped_mass(&mesh, 0, &|_| 1000.0, &mut mass);
    mass.seal();
    let clamped = |(i, p): (usize, &Vec3)| (p.x < 1e-9).then(|| Constraint::pin(i as u32, *p));
    let entry = souple_engine::steppers::TABLE.find(stepper).unwrap();
    let system = System {
        name: "main".into(),
        kinematics,
        mass,
        forces: vec![Box::new(SolidForce::new(&description).unwrap()), damping(&description)],
        constraints: mesh.points.iter().enumerate().filter_map(clamped).collect(),
        stepper: (entry.build)(&entry.values(Values::new()).unwrap()),
        steps_per_period: 1,
    };
    let mut start = system.initial_state(mesh.points.clone());
    for (v, p) in start.v.iter_mut().zip(&mesh.points) {
        *v = Vec3::Y * (2.0 * p.x * p.x);
    }
    let state = State { systems: vec![start], ..State::default() };
    let model = Model { period: 0.04 / f64::from(steps), systems: vec![system], ..Model::default() };
    let mut world = model.start(state);
    let before = world.energy().total();
    (0..steps).for_each(|_| world.step().unwrap());
    let after = world.energy();
    let heat = after.by_force[1].1.dissipated;
    ((before - after.total() - heat) / before, heat / before)
}

/// Energy at the start is energy at the end and heat, for strain-rate and stiffness damping alike, to the first order of
/// the step: halved steps halve what is missing.
#[test]
fn damped_oscillations_account_for_their_energy() {
    let viscosity = |d: &SolidDescription| -> Box<dyn Force> { Box::new(Viscosity::new(d, 1e4).unwrap()) };
    let rayleigh =
        |d: &SolidDescription| -> Box<dyn Force> { Box::new(RayleighDamping::new(d, 2e-3).unwrap()) };
    type Make<'a> = &'a dyn Fn(&SolidDescription) -> Box<dyn Force>;
    for (name, damping) in [("viscosity", &viscosity as Make), ("rayleigh", &rayleigh)] {
        for (stepper, steps) in [
            ("symplectic_euler", 400),
            ("rk2", 400),
            ("rk4", 400),
            ("backward_euler", 40),
            ("bdf2", 40),
            ("newmark", 40),
        ] {
            let (coarse, _) = unaccounted(damping, stepper, steps);
            let (fine, heat) = unaccounted(damping, stepper, 2 * steps);
            // long backward Euler steps take as much by themselves
            assert!(heat > 0.1, "{name}, {stepper}: {heat} of the energy became heat");
            assert!(coarse.abs() < 0.3, "{name}, {stepper}: {coarse} of the energy is missing");
            // c h + d h²: the second term is a few percent of the first here
            let ratio = fine / coarse;
            assert!((0.35..0.65).contains(&ratio), "{name}, {stepper}: {coarse} {fine}");
        }
    }
}

/// Mass of every element: the total is ρ V, lumped and consistent, and a rigid translation has ½ M v². Lumped masses are
/// positive, at the corners of quadratic elements too.
#[test]
fn masses_add_up() {
    for element in ELEMENTS {
        let mesh = bar([1.0, 0.4, 0.3], [4.0, 2.0, 2.0], element);
        let expected = 1000.0 * 0.12;
        for make in [lumped_mass, consistent_mass, uniform_mass] {
            let mut mass = Mass::new(mesh.points.len());
            make(&mesh, 0, &|_| 1000.0, &mut mass);
            mass.seal();
            let energy = mass.kinetic_energy(&vec![Vec3::new(0.0, 2.0, 0.0); mesh.points.len()]);
            assert!((energy - 0.5 * expected * 4.0).abs() <= 1e-12 * energy, "{element}: {energy}");
            assert!(mass.diagonal.iter().all(|m| *m > 0.0), "{element}");
        }
        let mut mass = Mass::new(mesh.points.len());
        uniform_mass(&mesh, 0, &|_| 1000.0, &mut mass);
        assert!(mass.diagonal.iter().all(|m| *m == mass.diagonal[0]), "{element}");
    }
}

/// A clamped bar of the reference in equilibrium under gravity: the mean of its four end corners.
fn cantilever_tip(n: usize, element: &str, law: &str, quadrature: Quadrature) -> Vec3 {
    let mesh = bar([1.0, 0.1, 0.1], [10.0 * n as f64, n as f64, n as f64], element);
    let (materials, of_cell) = ([material(law)], vec![0; mesh.cell_count()]);
    let force =
        SolidForce::new(&SolidDescription { quadrature, ..describe(&mesh, &materials, &of_cell) }).unwrap();
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
    let mut mass = Mass::new(mesh.points.len());
    consistent_mass(&mesh, 0, &|_| 1000.0, &mut mass);
    mass.seal();
    let clamped = |(i, p): (usize, &Vec3)| (p.x < 1e-9).then(|| Constraint::pin(i as u32, *p));
    let constraints = mesh.points.iter().enumerate().filter_map(clamped).collect();
    let solver = SolverSettings { tolerance: 1e-12, ..SolverSettings::default() };
    let newton = NewtonSettings { tolerance: 1e-11, max_iterations: 50 };
    let weight = Weight::of(&mass);
    let system = System {
        name: "main".into(),
        kinematics,
        mass,
        forces: vec![Box::new(force), Box::new(weight)],
        constraints,
        stepper: Box::new(StaticEquilibrium { load_steps: 1, newton, solver }),
        steps_per_period: 1,
    };
    let state = State { systems: vec![system.initial_state(mesh.points.clone())], ..State::default() };
    let mut world = Model { period: 1.0, systems: vec![system], ..Model::default() }.start(state);
    world.step().unwrap();
    let corners = mesh.points.iter().zip(&world.state().systems[0].q).filter(|(p, _)| {
        (p.x - 1.0).abs() < 1e-9 && [p.y, p.z].iter().all(|c| c.abs() < 1e-9 || (c - 0.1).abs() < 1e-9)
    });
    let moved: Vec<Vec3> = corners.map(|(p, q)| *q - *p).collect();
    assert_eq!(moved.len(), 4);
    moved.into_iter().sum::<Vec3>() * 0.25
}

/// Constant weight `ρ g ∫N_a dV` along -y.
struct Weight(Vec<f64>);

impl Weight {
    fn of(mass: &Mass) -> Self {
        let mut rows = mass.diagonal.clone();
        for &(a, b, m) in &mass.couplings {
            rows[a as usize] += m;
            rows[b as usize] += m;
        }
        Self(rows)
    }
}

impl Force for Weight {
    fn name(&self) -> &str {
        "weight"
    }
    fn declaration(&self) -> souple_engine::Declaration {
        souple_engine::Declaration::LOAD
    }
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> souple_engine::Energy {
        let stored = self.0.iter().zip(at.positions).map(|(m, x)| 9.81 * m * x.y).sum();
        souple_engine::Energy { stored, dissipated: 0.0 }
    }
    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        out.iter_mut().zip(&self.0).for_each(|(f, m)| f.y -= 9.81 * m * at.load);
    }
    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }
    fn visit_cliques(&self, _: &[souple_engine::Pair], _: &mut dyn FnMut(&[u32])) {}
    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}
    fn as_any(&self) -> &dyn std::any::Any {
        self
    }
}

/// The discrete tips of independent codes: tet4 (FEniCSx and an own code agree to ten digits) to 1e-7, the
/// other elements (GetFEM) to 1e-6 relative.
#[test]
fn discrete_cantilevers_of_independent_codes() {
    let rows: &[(usize, &str, &str, f64, f64)] = &[
        (3, "tet4", "linear", -0.10141496361829683, 1e-7),
        (3, "tet4", "st_venant_kirchhoff", -0.10051244029848287, 1e-7),
        (3, "tet4", "neo_hookean", -0.10067003081654274, 1e-7),
        (3, "tet4", "corotational", -0.10060500259432772, 1e-7),
        (1, "hex8", "linear", -0.09557806242618869, 1e-6),
        (1, "hex8", "st_venant_kirchhoff", -0.09490604711694053, 1e-6),
        (2, "hex8", "linear", -0.12876284033785645, 1e-6),
    ];
    for &(n, element, law, expected, tolerance) in rows {
        let quadrature = if element == "tet4" { Quadrature::Default } else { Quadrature::Full };
        let tip = cantilever_tip(n, element, law, quadrature);
        assert!(
            (tip.y / expected - 1.0).abs() < tolerance,
            "{element} {law} n = {n}: {} for {expected}",
            tip.y
        );
    }
}

/// A small smooth shift of the points inside the unit cube.
fn distort(points: &mut [Vec3], amount: f64) {
    for p in points.iter_mut().filter(|p| !on_cube(p)) {
        let s = *p;
        let shift = Vec3::new(
            (7.0 * s.x + 3.0 * s.y + s.z).sin(),
            (2.0 * s.x - 5.0 * s.y + 4.0 * s.z).sin(),
            (s.x + s.y - 6.0 * s.z).sin(),
        );
        *p += shift * amount;
    }
}

fn on_cube(p: &Vec3) -> bool {
    p.to_array().iter().any(|c| c.abs() < 1e-9 || (c - 1.0).abs() < 1e-9)
}

/// An affine motion of the boundary is met inside by the very affine motion, whatever the mesh (patch test): with
/// straight edges under the default rules, with curved ones under the full rules, which integrate the gradients of
/// curved cells exactly.
#[test]
fn patch_test_is_exact() {
    let F = Mat3::from_rows([[1.1, 0.05, -0.02], [0.03, 0.95, 0.04], [-0.01, 0.02, 1.08]]);
    let linear = ["tet4", "hex8", "prism6", "pyramid5", "mixed"];
    let of_linear = linear.map(|element| (element, NodePlace::Corner, false));
    // with nodes in faces and inside too, where there is such an element
    let raised =
        linear.map(|element| (element, NodePlace::Edge)).into_iter().chain([("hex8", NodePlace::Inside)]);
    let raised = raised.flat_map(|(element, most)| [(element, most, false), (element, most, true)]);
    for law in AnyLaw::ALL {
        for (element, most, is_curved) in of_linear.into_iter().chain(raised.clone()) {
            let is_quadratic = most > NodePlace::Corner;
            // four cubes along x: `mixed` takes no fewer
            let cells = if is_quadratic { [4.0, 2.0, 2.0] } else { [4.0, 4.0, 4.0] };
            let mut mesh = bar([1.0, 1.0, 1.0], cells, element);
            distort(&mut mesh.points, 0.02);
            if is_quadratic {
                mesh = mesh.raised(most, |[a, b]| (a + b) * 0.5);
            }
            if is_curved {
                distort(&mut mesh.points, 0.01);
            }
            let quadrature = if is_curved { Quadrature::Full } else { Quadrature::Default };
            let element = mesh.blocks[0].kind.name();
            let boundary = on_cube;
            let (materials, of_cell) = ([material(law.entry().name)], vec![0; mesh.cell_count()]);
            let description = SolidDescription { quadrature, ..describe(&mesh, &materials, &of_cell) };
            let force = SolidForce::new(&description).unwrap();
            let mut kinematics = Kinematics::default();
            kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
            let held = |(i, p): (usize, &Vec3)| boundary(p).then(|| Constraint::pin(i as u32, F * *p));
            let solver = SolverSettings { tolerance: 1e-13, ..SolverSettings::default() };
            let newton = NewtonSettings { tolerance: 1e-13, max_iterations: 50 };
            let system = System {
                name: "main".into(),
                kinematics,
                mass: Mass::new(mesh.points.len()),
                forces: vec![Box::new(force)],
                constraints: mesh.points.iter().enumerate().filter_map(held).collect(),
                stepper: Box::new(StaticEquilibrium { load_steps: 1, newton, solver }),
                steps_per_period: 1,
            };
            let state =
                State { systems: vec![system.initial_state(mesh.points.clone())], ..State::default() };
            let mut world = Model { period: 1.0, systems: vec![system], ..Model::default() }.start(state);
            world.step().unwrap();
            let reached = &world.state().systems[0].q;
            let error =
                mesh.points.iter().zip(reached).map(|(p, q)| (F * *p - *q).length()).fold(0.0, f64::max);
            assert!(error < 1e-10, "{} on {element}: {error:e}", law.entry().name);
        }
    }
}

/// `∇φ` of the harmonic `φ = 0.05 eˣ cos 0.6y cos 0.8z`: a displacement in equilibrium without loads under the linear law.
fn harmonic(p: Vec3) -> Vec3 {
    let (e, (s6, c6), (s8, c8)) = (0.05 * p.x.exp(), (0.6 * p.y).sin_cos(), (0.8 * p.z).sin_cos());
    Vec3::new(e * c6 * c8, -0.6 * e * s6 * c8, -0.8 * e * c6 * s8)
}

/// `√∫|u_h - u|² dV` on the unit cube of `n` cubes each way, its surface led by [`harmonic`].
fn distance_from_harmonic(element: &str, n: f64) -> f64 {
    let mesh = bar([1.0; 3], [n; 3], element);
    let (materials, of_cell) = ([material("linear")], vec![0; mesh.cell_count()]);
    let force = SolidForce::new(&describe(&mesh, &materials, &of_cell)).unwrap();
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, mesh.points.len());
    let held = |(i, p): (usize, &Vec3)| on_cube(p).then(|| Constraint::pin(i as u32, *p + harmonic(*p)));
    let solver = SolverSettings { tolerance: 1e-12, ..SolverSettings::default() };
    let newton = NewtonSettings { tolerance: 1e-11, max_iterations: 20 };
    let system = System {
        name: "main".into(),
        kinematics,
        mass: Mass::new(mesh.points.len()),
        forces: vec![Box::new(force)],
        constraints: mesh.points.iter().enumerate().filter_map(held).collect(),
        stepper: Box::new(StaticEquilibrium { load_steps: 1, newton, solver }),
        steps_per_period: 1,
    };
    let state = State { systems: vec![system.initial_state(mesh.points.clone())], ..State::default() };
    let mut world = Model { period: 1.0, systems: vec![system], ..Model::default() }.start(state);
    world.step().unwrap();
    let reached = &world.state().systems[0].q;
    let mut sum = 0.0;
    for cell in mesh.cells() {
        let [rest, now] =
            [&mesh.points, reached].map(|x| cell.nodes.iter().map(|n| x[*n as usize]).collect::<Vec<_>>());
        for point in &cell.kind.full_rule().points {
            let X = cell.kind.position(&rest, point.position);
            let gap = cell.kind.position(&now, point.position) - X - harmonic(X);
            sum += gap.length_sq() * point.weight * cell.kind.jacobian(&rest, point.position).determinant();
        }
    }
    sum.sqrt()
}

/// Displacements converge in the mean square at the second order on linear elements and at the third on quadratic ones.
#[test]
fn displacements_converge_at_the_order_of_the_element() {
    for (elements, order) in [
        (&["tet4", "hex8", "prism6", "pyramid5"][..], 2.0),
        (&["tet10", "hex20", "hex27", "prism15", "pyramid13"][..], 3.0),
    ] {
        for element in elements {
            let [coarse, fine] = [2.0, 4.0].map(|n| distance_from_harmonic(element, n));
            let measured = (coarse / fine).log2();
            // the next power is no more than the first on the coarse mesh: log₂ (1 + 1/2) / (1 + 1/4)
            assert!((measured - order).abs() < 0.27, "{element}: {measured}, {coarse:e} {fine:e}");
        }
    }
}

/// Of a law that is stiffer along one axis Rayleigh damping is stiffer along it too: `-b K₀ v` with its own stiffness at rest.
#[test]
fn rayleigh_damping_is_of_the_law_at_rest() {
    for element in ["tet4", "hex8"] {
        let mesh = bar([1.0, 0.4, 0.3], [4.0, 2.0, 2.0], element);
        let of_cell = vec![0; mesh.cell_count()];
        let materials = [text("mu*dot(E, E) + lambda/2*(J - 1)^2 + 5*mu*(I4(a) - 1)^2")];
        let description = describe(&mesh, &materials, &of_cell);
        let solid = SolidForce::new(&description).unwrap();
        let damping = RayleighDamping::new(&description, 0.01).unwrap();
        let v = directions(mesh.points.len());
        let mut of_rest = vec![Vec3::ZERO; v.len()];
        let weights = TangentWeights { position: 0.01, velocity: 0.0 };
        let rest = at(&mesh.points, &v);
        solid.add_differential(&rest, weights, &v, &mut solid.new_scratch(), &mut of_rest);
        // wherever the body is
        let damped = force_at(&damping, &mut damping.new_scratch(), &bent(&mesh), &v);
        let difference: Vec<Vec3> = damped.iter().zip(&of_rest).map(|(a, b)| *a - *b).collect();
        assert!(
            norm(&difference) <= 1e-12 * norm(&of_rest),
            "{element}: {}",
            norm(&difference) / norm(&of_rest)
        );
    }
}
