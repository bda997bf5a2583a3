//! Bending of surfaces of triangles: derivatives, rigid motion, constant curvature on crooked meshes, rigidities of laws.
#![allow(non_snake_case)]

use std::sync::Arc;

use souple_engine::{Configuration, Force, Motion, TangentWeights};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::{ElementKind, Mesh};
use souple_models::loads::RigidMotion;
use souple_models::materials;
use souple_models::solids::{
    Bending, BendingDescription, BendingError, Clamp, Plate, Quadrature, Rigidities, Section,
    SolidDescription, border_edges, lies_across, plane_axes, rigidity_of_law,
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

fn solid(mesh: &Mesh) -> SolidDescription<'_> {
    SolidDescription {
        name: "sheet".into(),
        mesh,
        first_row: 0,
        materials: &[],
        material_of_cell: &[],
        axes: &[],
        quadrature: Quadrature::Default,
        section: Section::Membrane { thickness: 1.0 },
    }
}

fn plate(rigidities: Rigidities, natural: Vec3) -> Plate {
    let first = Vec3::new(1.0, 0.3, 0.0);
    Plate { rigidity: rigidities.matrix(), first, natural, viscosity: Mat3::ZERO }
}

fn made(mesh: &Mesh, plate: Plate, clamps: &[Clamp]) -> Bending {
    let plates = vec![plate; mesh.cell_count()];
    Bending::new(&solid(mesh), &BendingDescription { plates: &plates, clamps }).unwrap()
}

fn bending(mesh: &Mesh, rigidities: Rigidities, natural: Vec3, clamps: &[Clamp]) -> Bending {
    made(mesh, plate(rigidities, natural), clamps)
}

/// Edges of the border with both ends where `is_inside` says, as something leads them.
fn clamps(mesh: &Mesh, leader: Option<Arc<dyn Motion>>, is_inside: impl Fn(&Vec3) -> bool) -> Vec<Clamp> {
    let border = border_edges(mesh).unwrap();
    let is_clamped = |edge: &[u32; 2]| edge.iter().all(|point| is_inside(&mesh.points[*point as usize]));
    let edges = border.iter().map(|border| border.edge).filter(is_clamped);
    edges.map(|edge| Clamp { edge, leader: leader.clone() }).collect()
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

fn memory(force: &dyn Force) -> Vec<f64> {
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    memory
}

fn energy(force: &Bending, positions: &[Vec3]) -> f64 {
    force.energy(&at(positions, &[], &memory(force)), &mut force.new_scratch()).stored
}

fn forces(force: &dyn Force, positions: &[Vec3]) -> Vec<Vec3> {
    forces_moving(force, positions, &[])
}

fn forces_moving(force: &dyn Force, positions: &[Vec3], velocities: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions, velocities, &memory(force)), &mut force.new_scratch(), &mut out);
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
    let left = clamps(&flat, None, |p| p.x < 1e-9);
    let natural = Vec3::new(0.8, -0.3, 0.5);
    let made = [
        ("flat", bending(&flat, ISOTROPIC, Vec3::ZERO, &[])),
        ("curling", bending(&flat, GRAINED, natural, &[])),
        ("clamped", bending(&flat, GRAINED, Vec3::ZERO, &left)),
    ];
    let mut all: Vec<_> = made.into_iter().map(|(name, force)| (name, flat.clone(), force)).collect();
    let left = clamps(&curved, None, |p| p.x < 1e-9);
    for (name, clamped) in [("dome", &[][..]), ("clamped dome", &left)] {
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
            let memory = memory(&force);
            force.add_differential(
                &at(&x, &[], &memory),
                weights,
                direction,
                &mut force.new_scratch(),
                &mut out,
            );
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
            let (mut scratch, memory) = (force.new_scratch(), memory(&force));
            let at = at(&x, &[], &memory);
            if definite {
                assert!(force.add_definite_blocks(&at, weights, &mut scratch, &mut matrix), "{name}");
            } else {
                force.add_blocks(&at, weights, &mut scratch, &mut matrix);
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
    let force = bending(&mesh, GRAINED, Vec3::ZERO, &[]);
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
    let plain = Rigidities { along: 2.0, across: 2.0, coupling: 0.0, twist: 1.0 };
    let wanted = 1.5;
    let natural = Vec3::new(wanted, 0.0, 0.0);
    let force = made(&mesh, Plate { first: Vec3::X, ..plate(plain, natural) }, &[]);
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
    let plate = plate(ISOTROPIC, Vec3::ZERO);
    let refused = |points: &[[f64; 2]], triangles: &[[u32; 3]]| {
        let points = points.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
        let mut block = souple_mesh::CellBlock::new(ElementKind::Tri3);
        triangles.iter().for_each(|nodes| block.nodes.extend(nodes));
        let mesh = Mesh { points, blocks: vec![block], ..Mesh::default() };
        let plates = vec![plate; triangles.len()];
        Bending::new(&solid(&mesh), &BendingDescription { plates: &plates, clamps: &[] }).err()
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
    let refused = |mesh: &Mesh, clamps: &[Clamp]| {
        let plates = vec![plate; mesh.cell_count()];
        Bending::new(&solid(mesh), &BendingDescription { plates: &plates, clamps }).err()
    };
    assert_eq!(refused(&quads, &[]), Some(BendingError::Kind { cell: 0, kind: ElementKind::Quad4 }));
    assert!(border_edges(&quads).is_err());
    let mesh = sheet([2, 2], 0.0);
    let inside = |p: &Vec3| (p.x - 0.5).abs() < 0.1 && p.y < 0.5;
    let [a, b] = [0, 1].map(|index| (0..9).filter(|p| inside(&mesh.points[*p as usize])).nth(index).unwrap());
    let clamp = Clamp { edge: [b, a], leader: None };
    assert_eq!(refused(&mesh, &[clamp]), Some(BendingError::Inside { edge: [a, b] }));
    assert!(ISOTROPIC.are_definite() && !Rigidities { coupling: 3.0, ..ISOTROPIC }.are_definite());
}

/// A surface of the constant curvatures `κ` [1/m], of small slopes.
fn curved(mesh: &Mesh, [bending, across, twist]: [f64; 3]) -> Vec<Vec3> {
    let height = |p: &Vec3| 0.5 * bending * p.x * p.x + 0.5 * across * p.y * p.y + twist * p.x * p.y;
    mesh.points.iter().map(|p| *p + Vec3::Z * height(p)).collect()
}

/// A disc of crooked triangles that wants to be curved stores nothing where it is, up to its rim: the energy left there, of slopes of 1e-4
/// and of rounding, is nothing beside that of the flat one.
#[test]
fn natural_curvature_is_taken_up_to_free_rims() {
    // what of a crooked sheet is in a circle, its rim as crooked as it comes
    let whole = sheet([12, 10], 0.2);
    let is_inside = |node: &u32| (whole.points[*node as usize] - Vec3::new(0.5, 0.4, 0.0)).length() < 0.38;
    let mut block = souple_mesh::CellBlock::new(ElementKind::Tri3);
    for cell in whole.cells().filter(|cell| cell.nodes.iter().all(is_inside)) {
        block.nodes.extend(cell.nodes);
    }
    let disc = Mesh { points: whole.points.clone(), blocks: vec![block], ..Mesh::default() };
    for mesh in [disc, sheet([6, 5], 0.2)] {
        for rigidities in [ISOTROPIC, GRAINED] {
            for wanted in [[2e-4, 0.0, 0.0], [0.0, 2e-4, 0.0], [1e-4, -2e-4, 3e-4]] {
                let [bending, across, twist] = wanted;
                let natural = Vec3::new(bending, across, 2.0 * twist);
                let force = made(&mesh, Plate { first: Vec3::X, ..plate(rigidities, natural) }, &[]);
                let (flat, taken) = (energy(&force, &mesh.points), energy(&force, &curved(&mesh, wanted)));
                // curvatures are off by the square of slopes of 3e-4, and by rounding of 1e-16 m over 1e-7 m of height
                assert!(taken <= 1e-12 * flat, "{wanted:?}: {taken:e} of {flat:e}");
                // where nothing was told of its free edges, some cells of a hundred, it would be 1e-3
                assert!(energy(&force, &curved(&mesh, wanted.map(|of| 1.01 * of))) > 1e-5 * flat);
            }
        }
    }
}

/// A crease that was folded nearly shut, 3.0 rad, and gives way a little beyond: its angle goes on, and so does its energy.
#[test]
fn angles_go_on_beyond_half_a_turn() {
    let shut = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        vec![Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::new(-cosine, 0.0, sine)]
    };
    let mut block = souple_mesh::CellBlock::new(ElementKind::Tri3);
    block.nodes.extend([0, 2, 1, 1, 3, 0]);
    let crease = |angle: f64| Mesh { points: shut(angle), blocks: vec![block.clone()], ..Mesh::default() };
    for rest in [3.0, -3.0] {
        let mesh = crease(rest);
        let force = bending(&mesh, ISOTROPIC, Vec3::ZERO, &[]);
        let mut memory = memory(&force);
        assert!((memory[0] - rest).abs() < 1e-12, "{}", memory[0]);
        let stored = |memory: &[f64], angle: f64| {
            force.energy(&at(&shut(angle), &[], memory), &mut force.new_scratch()).stored
        };
        let of_square = stored(&memory, rest - 0.1 * rest.signum()) / 0.01;
        // by steps of a tenth, through half a turn and on to one and a half
        for step in 1..60 {
            let turned = 0.1 * f64::from(step);
            let x = shut(rest + turned * rest.signum());
            let measured = force.energy(&at(&x, &[], &memory), &mut force.new_scratch()).stored;
            assert!((measured - of_square * turned * turned).abs() <= 1e-9 * measured, "{rest} {turned}");
            force.advance_memory(&at(&x, &[], &memory.clone()), 1e-3, &mut memory, &mut []);
        }
    }
}

/// A clamp whose rim is led in a turn goes with it: a rigid turn of the whole stores nothing, and slopes of what it stores are those of the
/// plane as it stands.
#[test]
fn clamps_turn_with_what_leads_them() {
    #[derive(Debug)]
    struct Turning(Vec3);
    impl Motion for Turning {
        fn offset(&self, _start: Vec3, time: f64) -> Vec3 {
            self.0 * (0.3 + time)
        }
        fn velocity(&self, _start: Vec3, _time: f64) -> Vec3 {
            self.0
        }
    }
    let axis = Vec3::new(0.4, 1.0, -0.7);
    let rotation: Arc<dyn Motion> = Arc::new(Turning(axis));
    let leader: Arc<dyn Motion> =
        Arc::new(RigidMotion { rotation: Some(rotation), ..RigidMotion::default() });
    for mesh in [sheet([4, 3], 0.2), dome()] {
        let clamps = clamps(&mesh, Some(Arc::clone(&leader)), |p| p.x < 1e-9 || p.y < 1e-9);
        let viscous = Plate { viscosity: GRAINED.matrix(), ..plate(GRAINED, Vec3::ZERO) };
        let force = made(&mesh, viscous, &clamps);
        let damping = force.damping("damping".into()).unwrap();
        let turned: Vec<Vec3> = mesh.points.iter().map(|p| exponential(axis * 0.3) * *p).collect();
        let bent = energy(&force, &mesh.points);
        assert!(bent > 1e-3 && energy(&force, &turned) <= 1e-20 * bent, "{bent}");
        // and turns on without a force of damping
        let spin: Vec<Vec3> = turned.iter().map(|p| axis.cross(*p)).collect();
        let still = vec![Vec3::ZERO; turned.len()];
        let resisted = norm(&forces_moving(&damping, &turned, &still));
        let carried = norm(&forces_moving(&damping, &turned, &spin));
        assert!(resisted > 1e-3 && carried <= 1e-11 * resisted, "{carried:e} {resisted:e}");
    }
}

/// A constant rate of curvature has the moments of the viscosity: none in rigid motion, slopes of forces are exact, blocks say the same, and
/// the heat is the power of the forces.
#[test]
fn damping_is_of_the_rate_of_the_curvature() {
    let mesh = dome();
    let left = clamps(&mesh, None, |p| p.x < 1e-9);
    let viscosity = Rigidities::of_viscosity(3.0, 2.0).matrix();
    // 2 η h³/12 along, η h³/12 of twist
    assert_eq!(viscosity, Mat3::from_diagonal(Vec3::new(4.0, 4.0, 2.0)));
    for clamps in [&[][..], &left] {
        let plate = Plate { viscosity, ..plate(GRAINED, Vec3::new(0.2, 0.1, 0.3)) };
        let bending = made(&mesh, plate, clamps);
        let force = bending.damping("damping".into()).unwrap();
        assert!(
            made(&mesh, Plate { viscosity: Mat3::ZERO, ..plate }, clamps).damping(String::new()).is_none()
        );
        let x = moved(&mesh.points, &directions(mesh.points.len(), 3.0), 0.05);
        let (v, direction) = (directions(x.len(), 1.0), directions(x.len(), 0.0));
        let f = forces_moving(&force, &x, &v);
        let scale = norm(&f);
        if clamps.is_empty() {
            let rigid: Vec<Vec3> = x.iter().map(|p| Vec3::new(0.3, -1.0, 0.7).cross(*p) + Vec3::X).collect();
            assert!(norm(&forces_moving(&force, &x, &rigid)) <= 1e-12 * scale);
        }
        let step = 1e-6;
        for weights in [[1.0, 0.0], [0.0, 1.0], [0.7, -1.3]] {
            let [position, velocity] = weights;
            let weights = TangentWeights { position, velocity };
            let memory = memory(&force);
            let mut exact = vec![Vec3::ZERO; x.len()];
            force.add_differential(
                &at(&x, &v, &memory),
                weights,
                &direction,
                &mut force.new_scratch(),
                &mut exact,
            );
            let beside = |step: f64| {
                let (x, v) = (moved(&x, &direction, position * step), moved(&v, &direction, velocity * step));
                forces_moving(&force, &x, &v)
            };
            let (ahead, behind) = (beside(step), beside(-step));
            let gap: Vec<Vec3> =
                (0..x.len()).map(|i| exact[i] - (ahead[i] - behind[i]) * (0.5 / step)).collect();
            // as for the stiffness
            assert!(norm(&gap) <= 1e-7 * norm(&exact), "{weights:?}: {:e}", norm(&gap) / norm(&exact));
            let mut builder = PatternBuilder::new(x.len());
            force.visit_cliques(&[], &mut |rows| builder.add_clique(rows).unwrap());
            let mut matrix = souple_solve::BlockMatrix::zeros(Arc::new(builder.build().unwrap()));
            force.add_blocks(&at(&x, &v, &memory), weights, &mut force.new_scratch(), &mut matrix);
            let mut out = vec![Vec3::ZERO; x.len()];
            matrix.apply(&direction, &mut out);
            let gap: Vec<Vec3> = out.iter().zip(&exact).map(|(a, b)| *a - *b).collect();
            assert!(norm(&gap) <= 1e-12 * norm(&exact), "{weights:?}: blocks differ by {:e}", norm(&gap));
        }
        let mut heat = [0.0];
        force.advance_memory(&at(&x, &v, &[0.0]), 0.01, &mut heat, &mut []);
        assert!((heat[0] + 0.01 * dot(&f, &v)).abs() <= 1e-12 * heat[0], "{} {}", heat[0], dot(&f, &v));
    }
}

/// A direction straight across a triangle is none in its plane.
#[test]
fn directions_across_are_told() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.2, 1.0, 0.0)];
    assert!(lies_across(corners, Vec3::Z) && !lies_across(corners, Vec3::new(1e-3, 0.0, 1.0)));
    assert!(ISOTROPIC.are_isotropic() && !GRAINED.are_isotropic());
}
