//! Bodies of two laws against bodies whose cells have these laws from the start, and what switching does.
#![allow(non_snake_case)]

use std::sync::Arc;

use souple_engine::{Configuration, Force, TangentWeights};
use souple_math::Vec3;
use souple_mesh::Mesh;
use souple_models::materials::{self, Material};
use souple_models::solids::{
    Adaptation, AdaptiveForce, Criterion, Quadrature, Section, SolidDescription, SolidForce,
};
use souple_solve::{BlockMatrix, LinearOperator, PatternBuilder};
use souple_table::{Value, Values};

use crate::common;

fn bar(element: &str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.4, 0.3]))
        .with("cells", Value::Vector([8.0, 3.0, 3.0]))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

fn laws() -> [Material; 2] {
    ["linear", "neo_hookean"].map(|law| common::material_of(materials::TABLE.find(law).unwrap(), 1e7, 0.3))
}

fn describe<'a>(mesh: &'a Mesh, materials: &'a [Material], of_cell: &'a [u16]) -> SolidDescription<'a> {
    SolidDescription {
        name: "bar".into(),
        mesh,
        first_row: 0,
        materials,
        material_of_cell: of_cell,
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Solid,
    }
}

fn adaptive(mesh: &Mesh, thresholds: &[(Criterion, f64)], back: f64) -> AdaptiveForce {
    adaptive_section(mesh, Section::Solid, thresholds, back)
}

fn adaptive_section(
    mesh: &Mesh,
    section: Section,
    thresholds: &[(Criterion, f64)],
    back: f64,
) -> AdaptiveForce {
    let of_cell = vec![0; mesh.cell_count()];
    let laws = laws();
    let adaptation = Adaptation { thresholds: thresholds.to_vec(), back };
    let description = SolidDescription { section, ..describe(mesh, &laws[..1], &of_cell) };
    AdaptiveForce::new(&description, &laws[1..], adaptation).unwrap()
}

fn sheet(element: &str) -> Mesh {
    let values = Values::new()
        .with("length", Value::Number(1.0))
        .with("width", Value::Number(0.4))
        .with("cells_along", Value::Integer(12))
        .with("cells_across", Value::Integer(5))
        .with("element", Value::Text(element));
    souple_mesh::generate("sheet", values).unwrap()
}

/// Surface elements in every section that they may be of.
fn sheets() -> impl Iterator<Item = (Mesh, Section)> {
    let thickness = 0.02;
    let sections = [
        Section::PlaneStrain { thickness },
        Section::PlaneStress { thickness },
        Section::Membrane { thickness },
    ];
    let elements = ["tri3", "quad4", "tri6", "quad9", "mixed"];
    sections.into_iter().flat_map(move |section| elements.map(|element| (sheet(element), section)))
}

/// Bent in their plane, membranes out of it too.
fn bent_section(mesh: &Mesh, section: Section) -> Vec<Vec3> {
    let out = if section.is_plane() { 0.0 } else { 1.0 };
    bent(mesh).iter().zip(&mesh.points).map(|(x, p)| Vec3::new(x.x, x.y, p.z + out * (x.z - p.z))).collect()
}

fn at<'a>(positions: &'a [Vec3], velocities: &'a [Vec3], memory: &'a [f64]) -> Configuration<'a> {
    Configuration {
        positions,
        velocities,
        time: 0.0,
        load: 1.0,
        memory,
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

fn bent(mesh: &Mesh) -> Vec<Vec3> {
    let wave = |p: Vec3| Vec3::new((7.0 * p.y).sin(), (5.0 * p.x + p.z).cos(), (3.0 * p.x - 2.0 * p.y).sin());
    mesh.points.iter().map(|p| *p + wave(*p) * 0.02).collect()
}

/// Energy, force, and tangent product with a fixed direction, element by element and by blocks.
fn answers(force: &dyn Force, x: &[Vec3], memory: &[f64]) -> (f64, [Vec<Vec3>; 3]) {
    let (mut scratch, v) = (force.new_scratch(), vec![Vec3::ZERO; x.len()]);
    let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin();
    let delta: Vec<Vec3> =
        (0..x.len()).map(|i| Vec3::new(number(i, 0.1), number(i, 0.2), number(i, 0.3))).collect();
    let weights = TangentWeights { position: 2.0, velocity: 0.0 };
    let at = at(x, &v, memory);
    let mut out = [(); 3].map(|()| vec![Vec3::ZERO; x.len()]);
    force.add_force(&at, &mut scratch, &mut out[0]);
    force.add_differential(&at, weights, &delta, &mut scratch, &mut out[1]);
    let mut pattern = PatternBuilder::new(x.len());
    force.visit_cliques(&[], &mut |rows| pattern.add_clique(rows).unwrap());
    let mut matrix = BlockMatrix::zeros(Arc::new(pattern.build().unwrap()));
    force.add_blocks(&at, weights, &mut scratch, &mut matrix);
    matrix.apply(&delta, &mut out[2]);
    (force.energy(&at, &mut scratch).stored, out)
}

/// Parts of several materials, each with a law of its own that takes over: as a body with these materials, whichever cells have which
/// law, and cells of linear laws by the stiffness of their shape.
#[test]
fn materials_adapt_each_to_its_own() {
    let of = |law: &str, modulus: f64| common::material_of(materials::TABLE.find(law).unwrap(), modulus, 0.3);
    let firsts = [of("linear", 1e7), of("linear", 2e7), of("neo_hookean", 1e7)];
    let seconds = [of("neo_hookean", 1e7), of("st_venant_kirchhoff", 2e7), of("linear", 3e7)];
    let all: Vec<Material> = firsts.iter().chain(&seconds).cloned().collect();
    for element in ["tet4", "hex8", "mixed"] {
        let mesh = bar(element);
        let (x, count) = (bent(&mesh), mesh.cell_count());
        let part: Vec<u16> = (0..count).map(|cell| (cell * 3 / count) as u16).collect();
        let adaptation = Adaptation { thresholds: vec![(Criterion::Length, 0.1)], back: 0.5 };
        let force = AdaptiveForce::new(&describe(&mesh, &firsts, &part), &seconds, adaptation).unwrap();
        for is_second in [|_| false, |_| true, |cell: usize| (cell * 7).is_multiple_of(3)] {
            let of_cell: Vec<u16> =
                part.iter().enumerate().map(|(cell, part)| part + 3 * u16::from(is_second(cell))).collect();
            let mut memory: Vec<f64> = (0..count).map(|cell| f64::from(u8::from(is_second(cell)))).collect();
            memory.extend([0.0, 0.0]);
            let fixed = SolidForce::new(&describe(&mesh, &all, &of_cell)).unwrap();
            let (energy, expected) = answers(&fixed, &x, &[]);
            let (found_energy, found) = answers(&force, &x, &memory);
            assert!(
                (found_energy - energy).abs() <= 1e-12 * energy,
                "{element}: {found_energy} for {energy}"
            );
            for (found, expected) in found.iter().zip(&expected) {
                let largest = expected.iter().map(|f| f.length()).fold(0.0, f64::max);
                let off = found.iter().zip(expected).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
                assert!(off <= 1e-12 * largest, "{element}: {off} of {largest}");
            }
            // what a switch of a cell takes is the difference of its own two laws
            let before = answers(&force, &x, &memory).0;
            force.end_step(&x, 0.01, &mut memory);
            let after = answers(&force, &x, &memory).0;
            assert!((before - after - memory[count]).abs() <= 1e-12 * before, "{element}");
        }
    }
}

/// Whatever cells have which law, forces, energies and tangents are those of a body with these materials.
#[test]
fn cells_have_the_law_that_memory_says() {
    let bars = ["tet4", "hex8", "prism6", "mixed"].map(|element| (bar(element), Section::Solid));
    for (mesh, section) in bars.into_iter().chain(sheets()) {
        let count = mesh.cell_count();
        let force = adaptive_section(&mesh, section, &[(Criterion::Length, 0.1)], 0.5);
        let x = if section == Section::Solid { bent(&mesh) } else { bent_section(&mesh, section) };
        let element = format!("{} in {section:?}", mesh.blocks[0].kind);
        let patterns: [(&str, &dyn Fn(usize) -> bool); 4] = [
            ("none", &|_| false),
            ("all", &|_| true),
            ("half", &|cell| cell < count / 2),
            ("scattered", &|cell| cell * 7 % 3 == 0),
        ];
        for (name, is_second) in patterns {
            let of_cell: Vec<u16> = (0..count).map(|cell| u16::from(is_second(cell))).collect();
            let mut memory: Vec<f64> = of_cell.iter().map(|law| f64::from(*law)).collect();
            memory.extend([0.0, 0.0]);
            let laws = laws();
            let description = SolidDescription { section, ..describe(&mesh, &laws, &of_cell) };
            let fixed = SolidForce::new(&description).unwrap();
            let (energy, expected) = answers(&fixed, &x, &[]);
            let (found_energy, found) = answers(&force, &x, &memory);
            // sums of the same terms in another order
            assert!((energy - found_energy).abs() <= 1e-12 * energy, "{element}, {name}");
            for (expected, found) in expected.iter().zip(&found) {
                let off: f64 = expected.iter().zip(found).map(|(a, b)| (*a - *b).length_sq()).sum();
                let scale: f64 = expected.iter().map(|a| a.length_sq()).sum();
                assert!(off.sqrt() <= 1e-12 * scale.sqrt(), "{element}, {name}: {:e}", (off / scale).sqrt());
            }
        }
    }
}

/// Cells over a threshold take the second law, those below the fraction return, and what a switch takes is in the memory:
/// stored and dissipated energy together stay as they were.
#[test]
fn switches_follow_criteria_and_account_for_energy() {
    let mesh = bar("hex8");
    let count = mesh.cell_count();
    let force = adaptive(&mesh, &[(Criterion::Length, 0.05), (Criterion::Volume, 0.04)], 0.5);
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    let (v, mut scratch) = (vec![Vec3::ZERO; mesh.points.len()], force.new_scratch());
    // stretched more and more along the bar: by x/5, at most a fifth
    let x: Vec<Vec3> = mesh.points.iter().map(|p| *p + Vec3::new(0.1 * p.x * p.x, 0.0, 0.0)).collect();
    let total = |memory: &[f64], scratch: &mut _| {
        let energy = force.energy(&at(&x, &v, memory), scratch);
        energy.stored + energy.dissipated
    };
    let before = total(&memory, &mut scratch);
    let mut next = memory.clone();
    force.end_step(&x, 0.01, &mut next);
    memory.clone_from(&next);
    let after = total(&memory, &mut scratch);
    assert!((before - after).abs() <= 1e-12 * before, "{before} {after}");
    for (cell, law) in memory[..count].iter().enumerate() {
        let nodes = mesh.cell(cell as u32).unwrap().nodes;
        let ends = nodes.iter().map(|node| mesh.points[*node as usize].x);
        let (low, high) =
            (ends.clone().fold(f64::INFINITY, f64::min), ends.fold(f64::NEG_INFINITY, f64::max));
        // (0.1 high² - 0.1 low²) / (high - low), of length and volume alike
        let stretch = 0.1 * (high + low);
        assert_eq!(*law, f64::from(u8::from(stretch > 0.04)), "cell {cell} stretched by {stretch}");
    }
    assert!(memory[count + 1] > 0.0 && memory[count] != 0.0);
    // back to a strain between half the threshold and the threshold: nothing returns; at rest all do
    let switched = memory[..count].iter().sum::<f64>();
    let held: Vec<Vec3> = mesh.points.iter().map(|p| *p + Vec3::new(0.03 * p.x, 0.0, 0.0)).collect();
    force.end_step(&held, 0.01, &mut memory);
    assert_eq!(memory[..count].iter().sum::<f64>(), switched);
    force.end_step(&mesh.points, 0.01, &mut memory);
    assert_eq!(memory[..count].iter().sum::<f64>(), 0.0);
}

/// The lower a threshold the more cells are over it, by every criterion.
#[test]
fn lower_thresholds_switch_more() {
    let mesh = bar("tet4");
    let x = bent(&mesh);
    for (criterion, unit) in [
        (Criterion::Length, 1.0),
        (Criterion::Volume, 1.0),
        (Criterion::Shape, 1.0),
        // some newtons: stresses of 1e5 Pa on faces of 1e-2 m²
        (Criterion::Force, 1e4),
    ] {
        let switched = |threshold: f64| {
            let force = adaptive(&mesh, &[(criterion, threshold * unit)], 0.0);
            let mut memory = vec![0.0; force.memory_len()];
            force.end_step(&x, 0.01, &mut memory);
            memory[..mesh.cell_count()].iter().sum::<f64>()
        };
        let counts = [1e-9, 0.015, 0.03, 0.06, 10.0].map(switched);
        assert!(counts.is_sorted_by(|a, b| a >= b), "{criterion:?}: {counts:?}");
        assert!(counts[0] > counts[3] && counts[4] == 0.0, "{criterion:?}: {counts:?}");
    }
}

/// Surface elements switch by every criterion as volumes do: the lower a threshold the more of them; those switch whose excess, asked cell by
/// cell, is above one; and what a switch takes is in the memory.
#[test]
fn surface_elements_switch_by_every_criterion() {
    for (mesh, section) in sheets() {
        let (x, v) = (bent_section(&mesh, section), vec![Vec3::ZERO; mesh.points.len()]);
        let count = mesh.cell_count();
        for criterion in [Criterion::Length, Criterion::Volume, Criterion::Shape, Criterion::Force] {
            let name = format!("{criterion:?} of {} in {section:?}", mesh.blocks[0].kind);
            let excesses = |threshold: f64| -> Vec<f64> {
                let force = adaptive_section(&mesh, section, &[(criterion, threshold)], 0.0);
                let memory = vec![0.0; force.memory_len()];
                (0..count).map(|cell| force.adapted(cell, &at(&x, &v, &memory)).unwrap().excess).collect()
            };
            let of_unit = excesses(1.0);
            let mut sorted = of_unit.clone();
            sorted.sort_by(f64::total_cmp);
            // a triangle that gets rounder has none by its shape
            let upper = 3 * count / 4;
            assert!(sorted[0] >= 0.0 && sorted[upper - 1] > 0.0 && sorted[count - 1].is_finite(), "{name}");
            // between two neighbours
            let threshold = 0.5 * (sorted[upper - 1] + sorted[upper]);
            let force = adaptive_section(&mesh, section, &[(criterion, threshold)], 0.0);
            let mut memory = vec![0.0; force.memory_len()];
            let mut scratch = force.new_scratch();
            let mut total = |memory: &[f64]| {
                let energy = force.energy(&at(&x, &v, memory), &mut scratch);
                energy.stored + energy.dissipated
            };
            let before = total(&memory);
            force.end_step(&x, 0.01, &mut memory);
            assert!((total(&memory) - before).abs() < 1e-12 * before, "{name}");
            for (cell, excess) in of_unit.iter().enumerate() {
                // cells of one shape may lie on the threshold together
                if (excess / threshold - 1.0).abs() > 1e-9 {
                    assert_eq!(memory[cell] != 0.0, *excess > threshold, "{name}: {cell} by {excess}");
                }
            }
        }
    }
}

/// In a plane a mirrored sheet, whose sides, areas and angles are those at rest, is turned inside out: every element takes the second law
/// whatever the threshold. A membrane that lies on its other side takes none.
#[test]
fn inverted_plane_elements_switch() {
    for (mesh, section) in sheets() {
        let force = adaptive_section(&mesh, section, &[(Criterion::Volume, 100.0)], 0.0);
        let mut memory = vec![0.0; force.memory_len()];
        let mirrored: Vec<Vec3> = mesh.points.iter().map(|p| Vec3::new(-p.x, p.y, p.z)).collect();
        let v = vec![Vec3::ZERO; mesh.points.len()];
        let excess = force.adapted(0, &at(&mirrored, &v, &memory)).unwrap().excess;
        force.end_step(&mirrored, 0.01, &mut memory);
        let switched = memory[..mesh.cell_count()].iter().filter(|law| **law != 0.0).count();
        if matches!(section, Section::Membrane { .. }) {
            assert!(excess < 1e-12 && switched == 0, "{section:?}");
        } else {
            assert!(excess == f64::INFINITY && switched == mesh.cell_count(), "{section:?}: {excess}");
        }
    }
}
