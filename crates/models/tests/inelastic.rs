//! Solids whose rest shape gives way: derivatives at a changed reference, relaxation, yielding, tearing.

#![allow(non_snake_case)] // symbols as in the source

use std::sync::Arc;

use souple_engine::{Configuration, Force, TangentWeights};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::Mesh;
use souple_models::materials::{self, Material, von_mises};
use souple_models::solids::{
    Amount, Fracture, InelasticForce, Inelasticity, Quadrature, Section, SolidDescription, SolidForce,
    Yielding,
};
use souple_solve::{BlockMatrix, LinearOperator, PatternBuilder};
use souple_table::{Value, Values};

use crate::common;

const YOUNG: f64 = 1e6;

fn bar(element: &str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([0.4, 0.2, 0.2]))
        .with("cells", Value::Vector([2.0, 1.0, 1.0]))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

fn material() -> Material {
    common::material_of(materials::TABLE.find("neo_hookean").unwrap(), YOUNG, 0.3)
}

fn with_description<T>(mesh: &Mesh, material: &Material, make: impl FnOnce(&SolidDescription) -> T) -> T {
    let of_cell = vec![0; mesh.cell_count()];
    make(&SolidDescription {
        name: "bar".into(),
        mesh,
        first_row: 0,
        materials: std::slice::from_ref(material),
        material_of_cell: &of_cell,
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Solid,
    })
}

fn force(mesh: &Mesh, rules: Inelasticity) -> InelasticForce {
    with_description(mesh, &material(), |description| InelasticForce::new(description, rules)).unwrap()
}

fn at<'a>(positions: &'a [Vec3], memory: &'a [f64]) -> Configuration<'a> {
    Configuration {
        positions,
        velocities: &[],
        time: 0.0,
        load: 1.0,
        memory,
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

fn memory(force: &InelasticForce) -> Vec<f64> {
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    memory
}

fn forces(force: &dyn Force, positions: &[Vec3], memory: &[f64]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions, memory), &mut force.new_scratch(), &mut out);
    out
}

fn energy(force: &dyn Force, positions: &[Vec3], memory: &[f64]) -> f64 {
    force.energy(&at(positions, memory), &mut force.new_scratch()).stored
}

fn dissipated(force: &dyn Force, positions: &[Vec3], memory: &[f64]) -> f64 {
    force.energy(&at(positions, memory), &mut force.new_scratch()).dissipated
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

fn moved(mesh: &Mesh, F: &Mat3) -> Vec<Vec3> {
    mesh.points.iter().map(|p| *F * *p).collect()
}

fn directions(count: usize) -> Vec<Vec3> {
    let number = |i: usize, axis: f64| ((i as f64 + axis) * 12.9898).sin();
    (0..count).map(|i| Vec3::from_array([0.1, 0.2, 0.3].map(|axis| number(i, axis)))).collect()
}

const YIELDING: Yielding = Yielding { stress: 5e3, hardening: 1e5, amount: Amount::Excess };

/// At rest in its reference it is the solid of its law; after it has yielded force is minus the slope of the energy, products and blocks
/// are slopes of the force, and forces and moments sum to zero, on every kind of linear volume element.
#[test]
fn changed_references_have_exact_derivatives() {
    for element in ["tet4", "hex8", "prism6", "pyramid5", "tet10"] {
        let mesh = bar(element);
        let force = force(&mesh, Inelasticity { yielding: Some(YIELDING), ..Inelasticity::default() });
        let step = |by: f64| -> Vec<Vec3> {
            mesh.points.iter().zip(directions(mesh.points.len())).map(|(p, d)| *p + d * by).collect()
        };
        let (x, mut memory) = (step(0.01), memory(&force));
        let elastic = with_description(&mesh, &material(), SolidForce::new).unwrap();
        let gap: Vec<Vec3> =
            forces(&force, &x, &memory).iter().zip(forces(&elastic, &x, &[])).map(|(a, b)| *a - b).collect();
        assert!(norm(&gap) <= 1e-11 * norm(&forces(&elastic, &x, &[])), "{element}: {:e}", norm(&gap));

        force.end_step(&x, 0.01, &mut memory);
        assert!(dissipated(&force, &x, &memory) > 0.0, "{element}: yielding gives off energy");
        let x = step(0.013);
        let direction = directions(x.len() + 5).split_off(5);
        let h = 1e-7;
        let shifted =
            |by: f64| -> Vec<Vec3> { x.iter().zip(&direction).map(|(x, d)| *x + *d * by).collect() };
        let f = forces(&force, &x, &memory);
        let slope =
            (energy(&force, &shifted(h), &memory) - energy(&force, &shifted(-h), &memory)) / (2.0 * h);
        // differences round by 1e-16 of the energy over the step, and bend by its square over cells of 0.1 m
        assert!(
            (slope + dot(&f, &direction)).abs() <= 1e-6 * norm(&f) * norm(&direction),
            "{element}: {slope}"
        );
        let weights = TangentWeights { position: 1.0, velocity: 0.0 };
        let mut product = vec![Vec3::ZERO; x.len()];
        force.add_differential(&at(&x, &memory), weights, &direction, &mut force.new_scratch(), &mut product);
        let (ahead, behind) = (forces(&force, &shifted(h), &memory), forces(&force, &shifted(-h), &memory));
        let gap: Vec<Vec3> = (0..x.len()).map(|i| product[i] - (ahead[i] - behind[i]) * (0.5 / h)).collect();
        assert!(norm(&gap) <= 1e-6 * norm(&product), "{element}: {:e}", norm(&gap) / norm(&product));
        let mut builder = PatternBuilder::new(x.len());
        force.visit_cliques(&[], &mut |rows| builder.add_clique(rows).unwrap());
        let mut matrix = BlockMatrix::zeros(Arc::new(builder.build().unwrap()));
        force.add_blocks(&at(&x, &memory), weights, &mut force.new_scratch(), &mut matrix);
        let mut by_blocks = vec![Vec3::ZERO; x.len()];
        matrix.apply(&direction, &mut by_blocks);
        let gap: Vec<Vec3> = by_blocks.iter().zip(&product).map(|(a, b)| *a - *b).collect();
        assert!(norm(&gap) <= 1e-12 * norm(&product), "{element}: blocks differ");
        let (sum, moment): (Vec3, Vec3) =
            (f.iter().copied().sum(), x.iter().zip(&f).map(|(x, f)| x.cross(*f)).sum());
        assert!(sum.length() <= 1e-12 * norm(&f) && moment.length() <= 1e-12 * norm(&f), "{element}");
    }
}

/// A held strain creeps by `exp(-t/z)` whatever the steps, also of a body that is turned meanwhile, and keeps its volume's part.
#[test]
fn strain_of_shape_creeps_exponentially() {
    let mesh = bar("tet4");
    let force = force(&mesh, Inelasticity { creep_time: Some(0.5), ..Inelasticity::default() });
    let stretch = 1e-4;
    let F = Mat3::from_diagonal(Vec3::new(1.0 + stretch, 1.0 - 0.5 * stretch, 1.0 - 0.5 * stretch));
    for (steps, length) in [(1, 0.3), (30, 0.01)] {
        let mut memory = memory(&force);
        for step in 0..steps {
            let turn = exponential(Vec3::new(0.3, 0.5, -0.2) * f64::from(step));
            force.end_step(&moved(&mesh, &(turn * F)), length, &mut memory);
        }
        let field = |memory: &[f64]| force.cell_field_at(0, &at(&moved(&mesh, &F), memory)).unwrap();
        let fresh = self::memory(&force);
        let ratio = field(&memory).von_mises / field(&fresh).von_mises;
        // strain of 1e-4 is nonlinear by as much
        assert!((ratio / (-0.3_f64 / 0.5).exp() - 1.0).abs() < 3.0 * stretch, "{ratio}");
    }
}

/// The equivalent stress is brought to the threshold, which grows with what has yielded; or all strain of shape goes over.
#[test]
fn yielding_returns_to_the_threshold() {
    let mesh = bar("hex8");
    let F = Mat3::from_diagonal(Vec3::new(1.05, 0.99, 0.98));
    let x = moved(&mesh, &F);
    for amount in [Amount::Excess, Amount::Whole] {
        let rule = Yielding { amount, ..YIELDING };
        let force = force(&mesh, Inelasticity { yielding: Some(rule), ..Inelasticity::default() });
        let mut memory = memory(&force);
        let advance = |memory: &mut Vec<f64>| {
            force.end_step(&x, 0.01, memory);
        };
        let stored = energy(&force, &x, &memory);
        advance(&mut memory);
        let field = force.cell_field_at(0, &at(&x, &memory)).unwrap();
        // a sample's last number is what has yielded there
        let yielded = memory[2 + 9];
        let threshold = if amount == Amount::Excess { rule.stress + rule.hardening * yielded } else { 0.0 };
        assert!((field.von_mises - threshold).abs() <= 1e-9 * YOUNG, "{amount:?}: {}", field.von_mises);
        assert!((von_mises(&field.cauchy) - field.von_mises).abs() <= 1e-12 * YOUNG);
        // what is stored no more has been given off
        let left = energy(&force, &x, &memory);
        assert!((stored - left - dissipated(&force, &x, &memory)).abs() <= 1e-12 * stored, "{amount:?}");
        let settled = memory.clone();
        advance(&mut memory);
        let change = settled.iter().zip(&memory).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(change < 1e-10, "{amount:?}: yields again by {change:e}");
    }
}

/// Cells of two materials and torn ones are neighbours: forces are minus the slope of the energy, which is asked for cell by cell, and the same
/// bits for any number of threads.
#[test]
fn neighbours_abreast_keep_their_own() {
    let values = Values::new()
        .with("size", Value::Vector([0.4, 0.2, 0.2]))
        .with("cells", Value::Vector([7.0, 3.0, 3.0]))
        .with("element", Value::Text("tet4"));
    let mesh = souple_mesh::generate("bar", values).unwrap();
    let stiff = common::material_of(materials::TABLE.find("neo_hookean").unwrap(), 3.0 * YOUNG, 0.4);
    // runs of eleven cells, which fill blocks of eight unevenly
    let of_cell: Vec<u16> = (0..mesh.cell_count()).map(|cell| (cell / 11 % 2) as u16).collect();
    let description = SolidDescription {
        name: "bar".into(),
        mesh: &mesh,
        first_row: 0,
        materials: &[material(), stiff],
        material_of_cell: &of_cell,
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Solid,
    };
    let fracture = Fracture { stress: f64::INFINITY, strain: 0.15, scatter: 0.5, seed: 1 };
    let rules = Inelasticity { creep_time: Some(0.1), fracture: Some(fracture), ..Inelasticity::default() };
    let force = InelasticForce::new(&description, rules).unwrap();
    let x: Vec<Vec3> =
        mesh.points.iter().zip(directions(mesh.points.len())).map(|(p, d)| *p + d * 0.01).collect();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut memory = memory(&force);
            force.end_step(&x, 0.01, &mut memory);
            (forces(&force, &x, &memory), memory)
        })
    };
    let (f, memory) = with(1);
    assert!(with(3) == (f.clone(), memory.clone()));
    let is_torn = |cell: &usize| force.cell_field_at(*cell, &at(&x, &memory)).unwrap().von_mises == 0.0;
    let torn = (0..mesh.cell_count()).filter(is_torn).count();
    assert!(torn > 10 && torn < mesh.cell_count() - 10, "{torn}");
    let (way, h) = (directions(x.len() + 5).split_off(5), 1e-7);
    let shifted = |by: f64| -> Vec<Vec3> { x.iter().zip(&way).map(|(x, d)| *x + *d * by).collect() };
    let slope = (energy(&force, &shifted(h), &memory) - energy(&force, &shifted(-h), &memory)) / (2.0 * h);
    // as for the elements one by one
    assert!((slope + dot(&f, &way)).abs() <= 1e-6 * norm(&f) * norm(&way), "{slope} {}", dot(&f, &way));
}

/// A cell tears at its limit, which is scattered by the seed alone, and pulls no more.
#[test]
fn cells_tear_at_their_limits() {
    let mesh = bar("hex8");
    let fracture = |scatter: f64, seed: u64| Fracture { stress: f64::INFINITY, strain: 0.05, scatter, seed };
    let tears = |fracture: Fracture, strain: f64| -> Vec<bool> {
        let force = force(&mesh, Inelasticity { fracture: Some(fracture), ..Inelasticity::default() });
        let mut memory = memory(&force);
        let x = moved(&mesh, &Mat3::from_diagonal(Vec3::new(1.0 + strain, 1.0, 1.0)));
        force.end_step(&x, 0.01, &mut memory);
        let pulls = |cell: usize| force.cell_field_at(cell, &at(&x, &memory)).unwrap().von_mises > 0.0;
        (0..2).map(|cell| !pulls(cell)).collect()
    };
    assert_eq!(tears(fracture(0.0, 1), 0.0499), [false; 2]);
    assert_eq!(tears(fracture(0.0, 1), 0.0501), [true; 2]);
    let bears = |seed: u64| -> Vec<usize> {
        let strains: Vec<f64> = (0..40).map(|i| 0.02 + 0.0015 * f64::from(i)).collect();
        (0..2)
            .map(|cell| strains.iter().filter(|strain| !tears(fracture(0.5, seed), **strain)[cell]).count())
            .collect()
    };
    let (one, other) = (bears(1), bears(2));
    assert_eq!(one, bears(1));
    assert_ne!(one, other);
    assert_ne!(one[0], one[1]);
}
