//! Solids whose volume is kept: derivatives, what multipliers do, the same bits for any number of threads.

#![allow(non_snake_case)] // symbols as in the source

use std::sync::Arc;

use souple_engine::{Configuration, Force, TangentWeights};
use souple_math::{Vec3, exponential};
use souple_mesh::Mesh;
use souple_models::materials;
use souple_models::solids::{
    Incompressibility, Incompressible, Multipliers, Pressures, Quadrature, Section, SolidDescription,
    SolidForce,
};
use souple_solve::{BlockMatrix, LinearOperator, PatternBuilder};
use souple_table::{Value, Values};

use crate::common;

const YOUNG: f64 = 1e6;
const PENALTY: f64 = 7e6;
const SOLVED: Multipliers = Multipliers::Solved { tolerance: 1e-6 };

fn bar(element: &str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([0.4, 0.2, 0.2]))
        .with("cells", Value::Vector([2.0, 1.0, 1.0]))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

fn elastic(mesh: &Mesh) -> SolidForce {
    let material = common::material_of(materials::TABLE.find("neo_hookean").unwrap(), YOUNG, 0.3);
    let of_cell = vec![0; mesh.cell_count()];
    SolidForce::new(&SolidDescription {
        name: "bar".into(),
        mesh,
        first_row: 0,
        materials: std::slice::from_ref(&material),
        material_of_cell: &of_cell,
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Solid,
    })
    .unwrap()
}

fn kept(mesh: &Mesh, pressures: Pressures, multipliers: Multipliers) -> Incompressible {
    let rules = Incompressibility { penalty: PENALTY, multipliers, pressures };
    Incompressible::new(Box::new(elastic(mesh)), mesh, 0, rules)
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

/// Multipliers of up to a tenth of Young's modulus.
fn memory(force: &Incompressible) -> Vec<f64> {
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    (0..force.volume_count()).for_each(|k| memory[1 + k] = 0.1 * YOUNG * (k as f64 * 1.7).sin());
    memory
}

fn forces(force: &dyn Force, positions: &[Vec3], memory: &[f64]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions, memory), &mut force.new_scratch(), &mut out);
    out
}

fn stored(force: &dyn Force, positions: &[Vec3], memory: &[f64]) -> f64 {
    force.energy(&at(positions, memory), &mut force.new_scratch()).stored
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

fn directions(count: usize) -> Vec<Vec3> {
    let number = |i: usize, axis: f64| ((i as f64 + axis) * 12.9898).sin();
    (0..count).map(|i| Vec3::from_array([0.1, 0.2, 0.3].map(|axis| number(i, axis)))).collect()
}

fn moved(points: &[Vec3], way: &[Vec3], by: f64) -> Vec<Vec3> {
    points.iter().zip(way).map(|(p, d)| *p + *d * by).collect()
}

const ALL: [(&str, Pressures); 8] = [
    ("tet4", Pressures::ByElement),
    ("tet4", Pressures::Cells),
    ("hex8", Pressures::ByElement),
    ("hex8", Pressures::Points),
    ("prism6", Pressures::ByElement),
    ("pyramid5", Pressures::Points),
    ("tet10", Pressures::ByElement),
    ("hex20", Pressures::ByElement),
];

/// Force is minus the slope of the energy at held multipliers, products and blocks are slopes of the force, blocks are symmetric, and
/// forces and moments sum to zero.
#[test]
fn kept_volumes_have_exact_derivatives() {
    for (element, pressures) in ALL {
        let mesh = bar(element);
        let force = kept(&mesh, pressures, SOLVED);
        let memory = memory(&force);
        let x = moved(&mesh.points, &directions(mesh.points.len()), 0.01);
        let way = directions(x.len() + 5).split_off(5);
        let h = 1e-7;
        let f = forces(&force, &x, &memory);
        let [ahead, behind] = [h, -h].map(|by| moved(&x, &way, by));
        let slope = (stored(&force, &ahead, &memory) - stored(&force, &behind, &memory)) / (2.0 * h);
        // differences round by 1e-16 of the energy over the step, and bend by its square over cells of 0.1 m
        assert!((slope + dot(&f, &way)).abs() <= 1e-6 * norm(&f) * norm(&way), "{element}: {slope}");
        let weights = TangentWeights { position: 1.0, velocity: 0.0 };
        let mut product = vec![Vec3::ZERO; x.len()];
        force.add_differential(&at(&x, &memory), weights, &way, &mut force.new_scratch(), &mut product);
        let (ahead, behind) = (forces(&force, &ahead, &memory), forces(&force, &behind, &memory));
        let gap: Vec<Vec3> = (0..x.len()).map(|i| product[i] - (ahead[i] - behind[i]) * (0.5 / h)).collect();
        assert!(norm(&gap) <= 1e-6 * norm(&product), "{element}: {:e}", norm(&gap) / norm(&product));
        let mut builder = PatternBuilder::new(x.len());
        force.visit_cliques(&[], &mut |rows| builder.add_clique(rows).unwrap());
        let mut matrix = BlockMatrix::zeros(Arc::new(builder.build().unwrap()));
        force.add_blocks(&at(&x, &memory), weights, &mut force.new_scratch(), &mut matrix);
        let mut by_blocks = vec![Vec3::ZERO; x.len()];
        matrix.apply(&way, &mut by_blocks);
        let gap: Vec<Vec3> = by_blocks.iter().zip(&product).map(|(a, b)| *a - *b).collect();
        assert!(norm(&gap) <= 1e-12 * norm(&product), "{element}: blocks differ");
        let other = directions(x.len() + 9).split_off(9);
        let mut turned = vec![Vec3::ZERO; x.len()];
        matrix.apply(&other, &mut turned);
        let asymmetry = (dot(&other, &by_blocks) - dot(&way, &turned)).abs();
        assert!(asymmetry <= 1e-12 * norm(&product) * norm(&other), "{element}: {asymmetry:e}");
        let (sum, moment): (Vec3, Vec3) =
            (f.iter().copied().sum(), x.iter().zip(&f).map(|(x, f)| x.cross(*f)).sum());
        assert!(sum.length() <= 1e-12 * norm(&f) && moment.length() <= 1e-12 * norm(&f), "{element}");
    }
}

/// A matrix that is made definite has no negative curvature, whatever multipliers are.
#[test]
fn definite_blocks_are() {
    let mesh = bar("tet4");
    let force = kept(&mesh, Pressures::ByElement, SOLVED);
    let memory: Vec<f64> = memory(&force).iter().map(|multiplier| 3e3 * multiplier).collect();
    let x = moved(&mesh.points, &directions(mesh.points.len()), 0.02);
    let mut builder = PatternBuilder::new(x.len());
    force.visit_cliques(&[], &mut |rows| builder.add_clique(rows).unwrap());
    let pattern = Arc::new(builder.build().unwrap());
    let least = |definite: bool| {
        let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern));
        let weights = TangentWeights { position: -1.0, velocity: 0.0 };
        let (view, scratch) = (at(&x, &memory), &mut force.new_scratch());
        match definite {
            true => assert!(force.add_definite_blocks(&view, weights, scratch, &mut matrix)),
            false => force.add_blocks(&view, weights, scratch, &mut matrix),
        }
        let curvature = |seed: usize| {
            let way = directions(x.len() + seed).split_off(seed);
            let mut product = vec![Vec3::ZERO; x.len()];
            matrix.apply(&way, &mut product);
            dot(&way, &product) / dot(&way, &way)
        };
        (0..200).map(curvature).fold(f64::INFINITY, f64::min)
    };
    assert!(least(false) < 0.0);
    assert!(least(true) > 0.0);
}

/// Kept volumes are those of rest however the body is turned, and the mean stress of a cell is what the penalty and the multiplier pull with.
#[test]
fn mean_stress_is_that_of_volumes() {
    for (element, pressures) in ALL {
        let mesh = bar(element);
        let (force, plain) = (kept(&mesh, pressures, SOLVED), elastic(&mesh));
        let mut memory = vec![0.0; force.memory_len()];
        force.initial_memory(&mut memory);
        let turn = exponential(Vec3::new(0.3, -0.5, 0.2));
        let x: Vec<Vec3> = mesh.points.iter().map(|p| turn * *p).collect();
        // rounding of positions, by the penalty, over areas of 0.02 m²
        assert!(norm(&forces(&force, &x, &memory)) < 1e-10 * PENALTY, "{element}");
        let growth = 1.03_f64;
        let x: Vec<Vec3> = x.iter().map(|x| *x * growth).collect();
        memory[1..].fill(2e4);
        let (field, of_law) =
            (force.cell_field_at(1, &at(&x, &memory)).unwrap(), plain.cell_field(1, &x).unwrap());
        let pull = 2e4 + PENALTY * (growth.powi(3) - 1.0);
        let added = (field.cauchy.trace() - of_law.cauchy.trace()) / 3.0;
        assert!((added - pull).abs() < 1e-9 * pull, "{element}: {added} {pull}");
        // P = σ cof F
        let cofactor = turn * (growth * growth);
        let gap = (field.stress - of_law.stress - cofactor * pull).largest_entry();
        assert!(gap < 1e-9 * pull, "{element}: {gap:e}");
    }
}

/// Multipliers take over what the penalty bears, and say how far off the worst volume was; not where all are near enough.
#[test]
fn multipliers_move_on_by_the_penalty() {
    let mesh = bar("hex8");
    let force = kept(&mesh, Pressures::ByElement, SOLVED);
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    let x: Vec<Vec3> = mesh.points.iter().map(|p| Vec3::new(1.1 * p.x, p.y, p.z)).collect();
    let unmet = force.augment(&x, &mut memory).unwrap();
    assert!((unmet.off - 0.1).abs() < 1e-12 && unmet.wanted == 1e-6, "{unmet:?}");
    memory[1..][..2]
        .iter()
        .for_each(|multiplier| assert!((multiplier / (0.1 * PENALTY) - 1.0).abs() < 1e-12));
    let before = memory.clone();
    let near: Vec<Vec3> = mesh.points.iter().map(|p| Vec3::new((1.0 + 5e-7) * p.x, p.y, p.z)).collect();
    assert_eq!(force.augment(&near, &mut memory), None);
    assert_eq!(before, memory);
}

/// What solved multipliers store as they move on is booked: along a path on which volumes grow evenly the mean of the forces at both ends does
/// the very work that energy and books tell, to rounding, however far multipliers moved.
#[test]
fn solved_multipliers_are_booked() {
    let mesh = bar("hex8");
    let (force, plain) = (kept(&mesh, Pressures::ByElement, SOLVED), elastic(&mesh));
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    let stretched = |by: f64| -> Vec<Vec3> {
        mesh.points.iter().map(|p| Vec3::new((1.0 + by) * p.x, p.y, p.z)).collect()
    };
    let (x, y) = (stretched(0.02), stretched(-0.01));
    let of_volumes = |x: &[Vec3], memory: &[f64]| {
        let energy = force.energy(&at(x, memory), &mut force.new_scratch());
        energy.stored + energy.dissipated - stored(&plain, x, &[])
    };
    let pulls = |x: &[Vec3], memory: &[f64]| -> Vec<Vec3> {
        forces(&force, x, memory).iter().zip(forces(&plain, x, &[])).map(|(all, law)| *all - law).collect()
    };
    force.augment(&x, &mut memory).unwrap();
    force.end_step(&x, 0.01, &mut memory);
    let (before, pulled) = (of_volumes(&x, &memory), pulls(&x, &memory));
    (0..3).for_each(|_| assert!(force.augment(&y, &mut memory).is_some()));
    force.end_step(&y, 0.01, &mut memory);
    let (after, way) = (of_volumes(&y, &memory), moved(&y, &x, -1.0));
    let work = 0.5 * (dot(&pulled, &way) + dot(&pulls(&y, &memory), &way));
    // the law's own energy, of 1 MPa, is taken out of sums that it is a part of
    assert!((after - before + work).abs() < 1e-12 * YOUNG * 0.016, "{before} {after} {work}");
    assert!(work.abs() > 1e-3 * PENALTY * 0.016 * 0.03, "{work}");
}

/// Relaxed multipliers grow by `c g h/τ` where a step ends, and what that stores is booked.
#[test]
fn relaxed_multipliers_are_booked() {
    let mesh = bar("tet4");
    let force = kept(&mesh, Pressures::ByElement, Multipliers::Relaxed { time: 0.2 });
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    let x = moved(&mesh.points, &directions(mesh.points.len()), 0.01);
    let total = |memory: &[f64]| {
        let energy = force.energy(&at(&x, memory), &mut force.new_scratch());
        energy.stored + energy.dissipated
    };
    let before = total(&memory);
    assert!(force.ends_steps() && !force.end_step(&x, 0.01, &mut memory));
    assert!(memory[1..].iter().any(|multiplier| multiplier.abs() > 1e-3 * PENALTY * 0.05));
    assert!((total(&memory) - before).abs() < 1e-12 * before, "{} {before}", total(&memory));
    assert_eq!(force.augment(&x, &mut memory), None);
}

/// The same bits for any number of threads.
#[test]
fn threads_share_volumes() {
    let values = Values::new()
        .with("size", Value::Vector([0.4, 0.4, 0.4]))
        .with("cells", Value::Vector([9.0; 3]))
        .with("element", Value::Text("tet4"));
    let mesh = souple_mesh::generate("bar", values).unwrap();
    let force = kept(&mesh, Pressures::ByElement, Multipliers::Relaxed { time: 0.2 });
    let x = moved(&mesh.points, &directions(mesh.points.len()), 0.002);
    let all = || {
        let mut memory = memory(&force);
        let (f, e) = (forces(&force, &x, &memory), stored(&force, &x, &memory));
        force.end_step(&x, 0.01, &mut memory);
        (f, e, memory)
    };
    let with =
        |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(all);
    assert!(with(1) == with(3));
}
