//! Bending of surfaces of triangles: derivatives, rigid motion, constant curvature on crooked meshes, rigidities of laws.
#![allow(non_snake_case)]

use std::sync::Arc;

use souple_engine::{Configuration, Force, TangentWeights};
use souple_math::{Vec3, exponential};
use souple_mesh::{ElementKind, Mesh};
use souple_models::materials;
use souple_models::solids::{
    Bending, BendingDescription, BendingError, Plate, Rigidities, plane_axes, rigidity_of_law,
};
use souple_solve::{LinearOperator, PatternBuilder};
use souple_table::{Value, Values};

use crate::common;

const ISOTROPIC: Rigidities = Rigidities { along: 2.0, across: 2.0, coupling: 0.6, twist: 0.7 };
const GRAINED: Rigidities = Rigidities { along: 5.0, across: 1.0, coupling: 0.4, twist: 0.3 };

/// A sheet of 1 m by 0.8 m, its inner points moved at random by a share of the cells.
fn sheet(cells: [i64; 2], disorder: f64) -> Mesh {
    let values = Values::new()
        .with("length", Value::Number(1.0))
        .with("width", Value::Number(0.8))
        .with("cells_along", Value::Integer(cells[0]))
        .with("cells_across", Value::Integer(cells[1]))
        .with("disorder", Value::Number(disorder))
        .with("element", Value::Text("tri3"));
    souple_mesh::generate("sheet", values).unwrap()
}

/// A piece of a dome, with its own twist.
fn dome() -> Mesh {
    let mut mesh = sheet([4, 3], 0.2);
    for p in &mut mesh.points {
        p.z = 0.3 * p.x * p.x + 0.2 * p.y * p.y + 0.25 * p.x * p.y;
    }
    mesh
}

fn bending(mesh: &Mesh, rigidities: Rigidities, natural: Vec3, clamped: &[bool]) -> Bending {
    let plate = Plate { rigidity: rigidities.matrix(), first: Vec3::new(1.0, 0.3, 0.0), natural };
    let plates = vec![plate; mesh.cell_count()];
    Bending::new(&BendingDescription { name: "sheet".into(), mesh, first_row: 0, plates: &plates, clamped })
        .unwrap()
}

fn at(positions: &[Vec3]) -> Configuration<'_> {
    Configuration {
        positions,
        velocities: &[],
        time: 0.0,
        load: 1.0,
        memory: &[],
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

fn energy(force: &Bending, positions: &[Vec3]) -> f64 {
    force.energy(&at(positions), &mut force.new_scratch()).stored
}

fn forces(force: &Bending, positions: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions), &mut force.new_scratch(), &mut out);
    out
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

fn directions(count: usize, salt: f64) -> Vec<Vec3> {
    let number = |i: usize, axis: f64| ((i as f64 + salt + axis) * 12.9898).sin();
    (0..count).map(|i| Vec3::from_array([0.1, 0.2, 0.3].map(|axis| number(i, axis)))).collect()
}

fn moved(positions: &[Vec3], direction: &[Vec3], step: f64) -> Vec<Vec3> {
    positions.iter().zip(direction).map(|(x, d)| *x + *d * step).collect()
}

/// Shells that differ in all that one can: flat or curved, of two axes, with a curvature of their own, clamped.
fn shells() -> Vec<(&'static str, Mesh, Bending)> {
    let (flat, curved) = (sheet([4, 3], 0.2), dome());
    let none = vec![false; flat.points.len()];
    let left: Vec<bool> = flat.points.iter().map(|p| p.x < 1e-9).collect();
    let natural = Vec3::new(0.8, -0.3, 0.5);
    let made = [
        ("flat", bending(&flat, ISOTROPIC, Vec3::ZERO, &none)),
        ("curling", bending(&flat, GRAINED, natural, &none)),
        ("clamped", bending(&flat, GRAINED, Vec3::ZERO, &left)),
    ];
    let mut all: Vec<_> = made.into_iter().map(|(name, force)| (name, flat.clone(), force)).collect();
    for (name, clamped) in [("dome", &none), ("clamped dome", &left)] {
        let force = bending(&curved, GRAINED, Vec3::ZERO, clamped);
        all.push((name, curved.clone(), force));
    }
    all
}

/// Force is minus the slope of the energy, products are the slope of the force, symmetric, and blocks say the same.
#[test]
fn derivatives_are_exact() {
    for (name, mesh, force) in shells() {
        let x = moved(&mesh.points, &directions(mesh.points.len(), 3.0), 0.05);
        let direction = directions(x.len(), 0.0);
        // differences lose 1e-16 / step to rounding, and bend by step² over cells of 0.2 m
        let step = 1e-6;
        let f = forces(&force, &x);
        let [ahead, behind] = [step, -step].map(|step| moved(&x, &direction, step));
        let slope = (energy(&force, &ahead) - energy(&force, &behind)) / (2.0 * step);
        let scale = norm(&f) * norm(&direction);
        assert!((slope + dot(&f, &direction)).abs() <= 1e-8 * scale, "{name}: {slope}");

        let weights = TangentWeights { position: 1.0, velocity: 0.0 };
        let product = |direction: &[Vec3]| {
            let mut out = vec![Vec3::ZERO; x.len()];
            force.add_differential(&at(&x), weights, direction, &mut force.new_scratch(), &mut out);
            out
        };
        let exact = product(&direction);
        let (ahead, behind) = (forces(&force, &ahead), forces(&force, &behind));
        let gap: Vec<Vec3> = (0..x.len()).map(|i| exact[i] - (ahead[i] - behind[i]) * (0.5 / step)).collect();
        assert!(norm(&gap) <= 1e-7 * norm(&exact), "{name}: {:e}", norm(&gap) / norm(&exact));
        let other = directions(x.len(), 7.0);
        let (ab, ba) = (dot(&other, &exact), dot(&direction, &product(&other)));
        assert!((ab - ba).abs() <= 1e-12 * norm(&exact) * norm(&other), "{name}: {ab} {ba}");

        let mut builder = PatternBuilder::new(x.len());
        force.visit_cliques(&[], &mut |rows| builder.add_clique(rows).unwrap());
        let pattern = Arc::new(builder.build().unwrap());
        let blocks = |definite: bool| {
            let mut matrix = souple_solve::BlockMatrix::zeros(Arc::clone(&pattern));
            let mut scratch = force.new_scratch();
            if definite {
                assert!(force.add_definite_blocks(&at(&x), weights, &mut scratch, &mut matrix), "{name}");
            } else {
                force.add_blocks(&at(&x), weights, &mut scratch, &mut matrix);
            }
            let mut out = vec![Vec3::ZERO; x.len()];
            matrix.apply(&direction, &mut out);
            out
        };
        let gap: Vec<Vec3> = blocks(false).iter().zip(&exact).map(|(a, b)| *a - *b).collect();
        assert!(norm(&gap) <= 1e-12 * norm(&exact), "{name}: blocks differ by {:e}", norm(&gap));
        assert!(dot(&direction, &blocks(true)) < 0.0, "{name}: definite blocks curve down");
    }
}

/// Internal: forces and moments sum to zero however it is bent; at rest, moved and turned there are none. A clamp holds its slope in space.
#[test]
fn forces_balance_and_rigid_motion_is_free() {
    for (name, mesh, force) in shells() {
        let x = moved(&mesh.points, &directions(mesh.points.len(), 3.0), 0.05);
        let f = forces(&force, &x);
        let (sum, moment): (Vec3, Vec3) =
            (f.iter().copied().sum(), x.iter().zip(&f).map(|(x, f)| x.cross(*f)).sum());
        let Q = exponential(Vec3::new(0.7, -1.1, 0.4));
        let turned: Vec<Vec3> = mesh.points.iter().map(|p| Q * *p + Vec3::new(2.0, 1.0, -1.0)).collect();
        // some hundred terms, each rounded, of arms of a metre over heights of a tenth
        assert!(sum.length() <= 1e-12 * norm(&f), "{name}: a net force of {sum:?}");
        let is_clamped = name.contains("clamped");
        assert_eq!(force.declaration().internal, !is_clamped, "{name}");
        if is_clamped {
            assert!(moment.length() > 1e-3 * norm(&f), "{name}: the clamp gives no moment");
            continue;
        }
        assert!(moment.length() <= 1e-12 * norm(&f), "{name}: a net moment of {moment:?}");
        if name != "curling" {
            assert!(norm(&forces(&force, &mesh.points)) <= 1e-11 * norm(&f), "{name}: forces at rest");
            assert!(norm(&forces(&force, &turned)) <= 1e-11 * norm(&f), "{name}: forces in rigid motion");
        }
        let (before, after) = (energy(&force, &mesh.points), energy(&force, &turned));
        assert!((before - after).abs() <= 1e-11 * energy(&force, &x), "{name}: {before} {after}");
    }
}

/// A constant curvature on a crooked mesh (patch test): points away from the border feel nothing, for each of the three curvatures.
#[test]
fn constant_curvature_is_in_balance_on_crooked_meshes() {
    let mesh = sheet([12, 10], 0.2);
    let none = vec![false; mesh.points.len()];
    let force = bending(&mesh, GRAINED, Vec3::ZERO, &none);
    // a triangle hears of two rows of triangles around it, and a point of those that hear of it
    let depth = 3.6 / 12.0;
    let is_inner = |p: &Vec3| p.x.min(1.0 - p.x).min(p.y).min(0.8 - p.y) > depth;
    assert!(mesh.points.iter().filter(|p| is_inner(p)).count() > 5);
    for curvature in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        let height = |p: &Vec3| {
            0.5 * curvature[0] * p.x * p.x + 0.5 * curvature[1] * p.y * p.y + curvature[2] * p.x * p.y
        };
        // the largest on inner points across the plane and in it, as parts of the largest force
        let rest = |amplitude: f64| {
            let x: Vec<Vec3> = mesh.points.iter().map(|p| *p + Vec3::Z * (amplitude * height(p))).collect();
            let f = forces(&force, &x);
            let scale = f.iter().map(|f| f.length()).fold(0.0, f64::max);
            let inner = || mesh.points.iter().zip(&f).filter(|(p, _)| is_inner(p)).map(|(_, f)| f);
            let across = inner().map(|f| f.z.abs()).fold(0.0, f64::max);
            let within = inner().map(|f| f.x.hypot(f.y)).fold(0.0, f64::max);
            [across / scale, within / scale]
        };
        // turned over, forces across turn over and those in the plane stay: beside what is linear, the first are as the cube of the height
        // and the second, moments times slopes, as its square. Heights of 1e-4 are rounded to 1e-12 of themselves, and curvatures of cells of
        // a twelfth to some hundred times that
        let ([across, within], [less_across, less_within]) = (rest(1e-3), rest(1e-4));
        assert!(less_across <= 0.0101 * across + 1e-9, "{curvature:?}: {across:e} {less_across:e}");
        assert!(less_within <= 0.101 * within + 1e-9, "{curvature:?}: {within:e} {less_within:e}");
        assert!(across < 1e-3 && within < 1e-3, "{curvature:?}: {across:e} {within:e}");
    }
}

/// A strip that wants to be curved, bent to circles: least energy at its own radius, with the normals inside.
#[test]
fn natural_curvature_is_a_circle_towards_the_normals() {
    let mesh = sheet([24, 2], 0.0);
    let none = vec![false; mesh.points.len()];
    let plain = Rigidities { along: 2.0, across: 2.0, coupling: 0.0, twist: 1.0 };
    let wanted = 1.5;
    let plate = Plate { rigidity: plain.matrix(), first: Vec3::X, natural: Vec3::new(wanted, 0.0, 0.0) };
    let plates = vec![plate; mesh.cell_count()];
    let description = BendingDescription {
        name: "strip".into(),
        mesh: &mesh,
        first_row: 0,
        plates: &plates,
        clamped: &none,
    };
    let force = Bending::new(&description).unwrap();
    let bent = |curvature: f64| {
        let circle = |p: &Vec3| {
            let angle = curvature * p.x;
            Vec3::new(angle.sin() / curvature, p.y, (1.0 - angle.cos()) / curvature)
        };
        energy(&force, &mesh.points.iter().map(circle).collect::<Vec<_>>())
    };
    // chords of 1/24 m turn by κ/24 at edges: their angle is that of the circle, and the energy ½ D (κ - κ⁰)² A but for the last
    // column of triangles, which is free to be as it wants
    let area = 0.8;
    let flat = 0.5 * 2.0 * wanted * wanted * area;
    assert!(bent(wanted) < 1e-3 * flat, "{}", bent(wanted));
    for curvature in [0.5, 1.0, 2.0] {
        let expected = 0.5 * 2.0 * (curvature - wanted).powi(2) * area;
        let measured = bent(curvature);
        assert!((measured / expected - 1.0).abs() < 2.0 / 24.0, "{curvature}: {measured} {expected}");
    }
    assert!(bent(-wanted) > 3.0 * flat);
}

/// The law of a body gives `E h³ / 12 (1 - ν²)`, `ν` of it across and `(1 - ν)/2` in twist.
#[test]
fn rigidity_is_that_of_the_law() {
    let (young, poisson, thickness) = (2e6, 0.3, 0.02_f64);
    let D = young * thickness.powi(3) / (12.0 * (1.0 - poisson * poisson));
    let expected =
        Rigidities { along: D, across: D, coupling: poisson * D, twist: 0.5 * (1.0 - poisson) * D };
    let axes =
        plane_axes([Vec3::ZERO, Vec3::new(1.0, 1.0, 0.2), Vec3::new(-0.3, 1.0, 0.5)], Vec3::X).unwrap();
    for law in ["corotational", "st_venant_kirchhoff", "neo_hookean", "stable_neo_hookean"] {
        let material = common::material_of(materials::TABLE.find(law).unwrap(), young, poisson);
        let found = rigidity_of_law(&material.along(None), axes, thickness).unwrap();
        let gap = (found - expected.matrix()).largest_entry();
        assert!(gap <= 1e-9 * D, "{law}: {found:?}");
    }
}

/// What is no surface of triangles with two sides is refused by name.
#[test]
fn refuses_what_is_no_surface() {
    let plate = Plate { rigidity: ISOTROPIC.matrix(), first: Vec3::X, natural: Vec3::ZERO };
    let refused = |points: &[[f64; 2]], triangles: &[[u32; 3]]| {
        let points = points.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
        let mut block = souple_mesh::CellBlock::new(ElementKind::Tri3);
        triangles.iter().for_each(|nodes| block.nodes.extend(nodes));
        let mesh = Mesh { points, blocks: vec![block], ..Mesh::default() };
        let plates = vec![plate; triangles.len()];
        let description =
            BendingDescription { name: "x".into(), mesh: &mesh, first_row: 0, plates: &plates, clamped: &[] };
        Bending::new(&description).err()
    };
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.3, -1.0], [2.0, 2.0]];
    assert_eq!(refused(&corners, &[[0, 1, 2]]), Some(BendingError::Nowhere));
    assert_eq!(refused(&corners, &[[0, 1, 2], [1, 3, 2]]), None);
    assert_eq!(
        refused(&corners, &[[0, 1, 2], [2, 3, 1], [1, 2, 5]]),
        Some(BendingError::Branches { edge: [1, 2] })
    );
    assert_eq!(refused(&corners, &[[0, 1, 2], [0, 1, 4]]), Some(BendingError::Turned { edge: [0, 1] }));
    assert_eq!(refused(&corners, &[[0, 3, 5], [0, 1, 3]]), Some(BendingError::Flat { cell: 0 }));
    let quads = souple_mesh::generate(
        "sheet",
        Values::new()
            .with("length", Value::Number(1.0))
            .with("width", Value::Number(1.0))
            .with("cells_along", Value::Integer(1))
            .with("cells_across", Value::Integer(1))
            .with("element", Value::Text("quad4")),
    )
    .unwrap();
    let description =
        BendingDescription { name: "x".into(), mesh: &quads, first_row: 0, plates: &[plate], clamped: &[] };
    assert_eq!(
        Bending::new(&description).err(),
        Some(BendingError::Kind { cell: 0, kind: ElementKind::Quad4 })
    );
    assert!(ISOTROPIC.are_definite() && !Rigidities { coupling: 3.0, ..ISOTROPIC }.are_definite());
}
