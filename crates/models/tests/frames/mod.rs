//! Bodies of frames: rigid motion (BOS-1), forces against energy and tangents against forces (BOS-2), frames on a line and
//! in a plane (BOS-3), mass; placements and weights that know the shape in `placement`.

#![allow(non_snake_case)] // symbols of the mathematics: F

mod placement;

use souple_engine::{Configuration, Force, Mass, TangentWeights};
use souple_math::{Mat3, Vec3, eigen_symmetric, exponential};
use souple_mesh::Mesh;
use souple_models::frames::{
    self, Carried, Frame, FramesAtRest, FramesDescription, FramesForce, HeldPoint, Hold, POINTS, Sample,
    Shape, TangentKind, WEIGHTS, Weights,
};
use souple_models::materials::{self, Material};
use souple_solve::{BlockMatrix, Pattern, PatternBuilder, dense};
use souple_table::{Value, Values};

fn bar(size: [f64; 3], cells: [f64; 3], element: &'static str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector(size))
        .with("cells", Value::Vector(cells))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

fn material(name: &str) -> Material {
    let entry = materials::TABLE.find(name).unwrap();
    let mut values = Values::new().with("density", Value::Number(900.0));
    for parameter in entry.parameters {
        let value = match parameter.name {
            "youngs_modulus" => 2e4,
            "poissons_ratio" => 0.35,
            "bulk_modulus" => 3e4,
            "c10" | "c01" => 2e3,
            _ => continue,
        };
        values.set(parameter.name, Value::Number(value));
    }
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

fn text_law() -> Material {
    let entry = materials::TABLE.find("hyperelastic").unwrap();
    let parameters = [("mu".to_owned(), "8 kPa".to_owned()), ("k".to_owned(), "20 kPa".to_owned())];
    let values = Values::new()
        .with("energy", Value::Text("mu/2*(I1_bar - 3) + k/2*(J - 1)^2"))
        .with("parameters", Value::Texts(&parameters))
        .with("density", Value::Number(900.0));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

/// Of small strain, and not linear.
fn small_text_law() -> Material {
    let entry = materials::TABLE.find("hyperelastic").unwrap();
    let parameters = [("mu".to_owned(), "8 kPa".to_owned()), ("lambda".to_owned(), "20 kPa".to_owned())];
    let values = Values::new()
        .with("energy", Value::Text("mu*tr(eps*eps) + lambda/2*tr(eps)^2 + mu*tr(eps*eps)^2"))
        .with("parameters", Value::Texts(&parameters))
        .with("density", Value::Number(900.0));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

/// A body of frames whose rows start at row 2.
struct Body {
    frames: Vec<Frame>,
    samples: Vec<Sample>,
    carried: Vec<Carried>,
    rows: Vec<u32>,
}

const FIRST: u32 = 2;

fn weights_of<'a>(name: &str, shape: &Shape<'a>) -> Box<dyn Weights + 'a> {
    let entry = WEIGHTS.find(name).unwrap();
    (entry.build)(&entry.values(Values::new()).unwrap(), shape).unwrap()
}

impl Body {
    fn new(mesh: &Mesh, frames: Vec<Frame>, weights: &str) -> Self {
        let stiffness = vec![1.0; mesh.cell_count()];
        let shape = Shape { frames: &frames, mesh, stiffness_of_cell: &stiffness };
        let weights = weights_of(weights, &shape);
        let entry = POINTS.find("cells").unwrap();
        let samples = (entry.build)(&entry.values(Values::new()).unwrap(), mesh, &vec![0; mesh.cell_count()]);
        let carried = samples
            .iter()
            .map(|sample| Carried::new(&frames, &weights.shares(sample.position), sample.position))
            .collect();
        let rows = (0..frames.len() as u32).map(|frame| FIRST + 4 * frame).collect();
        drop(weights);
        Self { samples, carried, rows, frames }
    }

    fn force(&self, mesh: &Mesh, materials: &[Material], tangent: TangentKind) -> FramesForce {
        let material_of_cell: Vec<u16> =
            (0..mesh.cell_count()).map(|cell| (cell * materials.len() / mesh.cell_count()) as u16).collect();
        FramesForce::new(FramesDescription {
            name: "body".into(),
            frames: &self.frames,
            row_of_frame: &self.rows,
            samples: &self.samples,
            carried: &self.carried,
            carried_cells: Vec::new(),
            cell_volumes: mesh.cell_volumes(),
            materials,
            material_of_cell: &material_of_cell,
            axes: &[],
            tangent,
        })
    }

    fn row_count(&self) -> usize {
        FIRST as usize + 4 * self.frames.len()
    }

    /// Rows of the frames moved by `x -> turn x + shift`.
    fn moved(&self, turn: &Mat3, shift: Vec3) -> Vec<Vec3> {
        let mut rows = vec![Vec3::ZERO; FIRST as usize];
        for frame in &self.frames {
            rows.push(*turn * frame.origin + shift);
            rows.extend(frame.axes.columns.map(|axis| *turn * axis));
        }
        rows
    }

    /// Rows bent, twisted and stretched by some percent.
    fn strained(&self) -> Vec<Vec3> {
        let mut rows = self.moved(&Mat3::IDENTITY, Vec3::ZERO);
        for (row, position) in rows.iter_mut().enumerate().skip(FIRST as usize) {
            let number = |k: f64| (row as f64 * 1.7 + k).sin();
            *position += Vec3::new(number(0.0), number(1.0), number(2.0)) * 0.03;
        }
        rows
    }
}

fn at(positions: &[Vec3]) -> Configuration<'_> {
    Configuration {
        positions,
        velocities: positions,
        time: 0.0,
        load: 1.0,
        memory: &[],
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

fn energy(force: &dyn Force, positions: &[Vec3]) -> f64 {
    force.energy(&at(positions), &mut force.new_scratch()).stored
}

fn force_of(force: &dyn Force, positions: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions), &mut force.new_scratch(), &mut out);
    out
}

fn differential(force: &dyn Force, positions: &[Vec3], delta: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    let weights = TangentWeights { position: 1.0, velocity: 0.0 };
    force.add_differential(&at(positions), weights, delta, &mut force.new_scratch(), &mut out);
    out
}

fn norm(vectors: &[Vec3]) -> f64 {
    vectors.iter().map(|v| v.length_sq()).sum::<f64>().sqrt()
}

fn line(count: usize) -> Vec<Frame> {
    let axes = exponential(Vec3::new(0.3, -0.2, 0.5));
    (0..count).map(|i| Frame { origin: Vec3::new(i as f64 / (count - 1) as f64, 0.1, 0.1), axes }).collect()
}

const SIZE: [f64; 3] = [1.0, 0.2, 0.2];

/// BOS-1: a rigid motion of all frames strains no sample, whatever the weights, the frames and their rest axes.
#[test]
fn rigid_motion_strains_nothing() {
    let mesh = bar(SIZE, [9.0, 2.0, 2.0], "tet4");
    for weights in WEIGHTS.names() {
        for frames in [line(5), line(2)] {
            let body = Body::new(&mesh, frames, weights);
            let turn = exponential(Vec3::new(1.0, -2.0, 0.7));
            let rows = body.moved(&turn, Vec3::new(3.0, 1.0, -2.0));
            for carried in &body.carried {
                let mut F = Mat3::ZERO;
                for (frame, gradients) in carried.frames.iter().zip(&carried.rows) {
                    let first = body.rows[*frame as usize] as usize;
                    for (row, (_, gradient)) in rows[first..].iter().zip(gradients) {
                        F += row.outer(*gradient);
                    }
                }
                let strain = F.transpose_mul(&F) - Mat3::IDENTITY;
                // positions of some metres times gradients of at most 1e2 /m: rounding of their sum
                assert!(strain.largest_entry() < 1e-12, "{weights}: {strain:?}");
            }
            let force = body.force(&mesh, &[material("neo_hookean")], TangentKind::Full);
            let largest = norm(&force_of(&force, &rows));
            let scale = norm(&force_of(&force, &body.strained()));
            assert!(largest < 1e-9 * scale, "{weights}: {largest} of {scale}");
        }
    }
}

/// Weights sum to one and their gradients to zero; gradients are the derivatives of the weights.
#[test]
fn weights_are_a_partition_of_unity() {
    let mesh = bar(SIZE, [10.0, 2.0, 2.0], "hex8");
    let frames = line(4);
    let stiffness: Vec<f64> =
        mesh.cell_centres().iter().map(|centre| if centre.x > 0.5 { 50.0 } else { 1.0 }).collect();
    let shape = Shape { frames: &frames, mesh: &mesh, stiffness_of_cell: &stiffness };
    for name in WEIGHTS.names() {
        let weights = weights_of(name, &shape);
        // inside cells, away from their faces, where harmonic weights have a kink
        for point in [Vec3::new(0.33, 0.07, 0.12), Vec3::new(0.87, 0.03, 0.15), Vec3::new(0.51, 0.13, 0.04)] {
            let shares = weights.shares(point);
            let sum: f64 = shares.iter().map(|share| share.weight).sum();
            let slope: Vec3 = shares.iter().map(|share| share.gradient).sum();
            // gradients of at most some hundred per metre cancel
            assert!((sum - 1.0).abs() < 1e-13 && slope.length() < 1e-11, "{name}: {sum} {slope:?}");
            let step = 1e-6;
            for share in &shares {
                for axis in 0..3 {
                    let shifted = |sign: f64| {
                        let mut moved = point;
                        moved[axis] += sign * step;
                        let there = weights.shares(moved);
                        there
                            .iter()
                            .find(|other| other.frame == share.frame)
                            .map_or(0.0, |other| other.weight)
                    };
                    let numeric = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
                    // third derivatives of some 1e4 /m³ times the step squared, rounding 1e-16 over the step
                    assert!((numeric - share.gradient[axis]).abs() < 1e-6, "{name}: {numeric} {share:?}");
                }
            }
        }
    }
}

/// BOS-2: forces are minus the gradient of the energy, and differentials and blocks their derivatives, for laws compiled
/// and written, and bodies of two materials.
#[test]
fn forces_are_gradients_and_tangents_their_derivatives() {
    let mesh = bar(SIZE, [6.0, 2.0, 2.0], "tet4");
    let laws = [
        vec![material("st_venant_kirchhoff")],
        vec![material("neo_hookean"), material("corotational")],
        vec![text_law(), material("neo_hookean")],
    ];
    for laws in laws {
        let body = Body::new(&mesh, line(4), "wendland");
        let force = body.force(&mesh, &laws, TangentKind::Full);
        let rows = body.strained();
        let delta: Vec<Vec3> =
            (0..rows.len()).map(|row| Vec3::new((row as f64).cos(), (2.0 * row as f64).sin(), 0.4)).collect();
        let shifted = |step: f64| -> Vec<Vec3> {
            rows.iter().zip(&delta).map(|(row, delta)| *row + *delta * step).collect()
        };
        let step = 1e-5;
        let slope = (energy(&force, &shifted(step)) - energy(&force, &shifted(-step))) / (2.0 * step);
        let work: f64 = force_of(&force, &rows).iter().zip(&delta).map(|(f, d)| f.dot(*d)).sum();
        // a third derivative of order one relative, times 1e-10; rounding 1e-16/1e-5 relative
        assert!((slope + work).abs() < 1e-6 * work.abs(), "{slope} {work}");
        let product = differential(&force, &rows, &delta);
        let (plus, minus) = (force_of(&force, &shifted(step)), force_of(&force, &shifted(-step)));
        let numeric: Vec<Vec3> = plus.iter().zip(&minus).map(|(p, m)| (*p - *m) / (2.0 * step)).collect();
        let apart: Vec<Vec3> = numeric.iter().zip(&product).map(|(n, p)| *n - *p).collect();
        assert!(norm(&apart) < 1e-6 * norm(&product), "{} of {}", norm(&apart), norm(&product));
        check_blocks(&force, &rows, &delta);
        check_blocks(&body.force(&mesh, &laws, TangentKind::Material), &rows, &delta);
    }
}

/// Shares are kept in single precision: the energy of a strained body is that of its points' own gradients to a millionth.
#[test]
fn energy_is_that_of_the_points() {
    let mesh = bar(SIZE, [9.0, 3.0, 3.0], "tet4");
    for weights in WEIGHTS.names() {
        let body = Body::new(&mesh, line(5), weights);
        let law = material("neo_hookean");
        let force = body.force(&mesh, std::slice::from_ref(&law), TangentKind::Full);
        let rows = body.strained();
        let density = |carried: &Carried| {
            let mut F = Mat3::ZERO;
            for (frame, gradients) in carried.frames.iter().zip(&carried.rows) {
                let first = body.rows[*frame as usize] as usize;
                for (row, (_, gradient)) in rows[first..].iter().zip(gradients) {
                    F += row.outer(*gradient);
                }
            }
            law.along(None).field(&F, 1.0).energy_density
        };
        let points = body.samples.iter().zip(&body.carried);
        let expected: f64 = points.map(|(sample, carried)| sample.volume * density(carried)).sum();
        let found = energy(&force, &rows);
        assert!((found / expected - 1.0).abs() < 1e-6, "{weights}: {found} and {expected}");
    }
}

/// Blocks times a displacement are the differential, to rounding; blocks are symmetric to the last bit.
fn check_blocks(force: &FramesForce, rows: &[Vec3], delta: &[Vec3]) {
    let mut cliques: Vec<Vec<u32>> = Vec::new();
    force.visit_cliques(&[], &mut |clique| cliques.push(clique.to_vec()));
    let pattern = Pattern::from_cliques(rows.len(), cliques.iter().map(Vec::as_slice)).unwrap();
    let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(pattern));
    let weights = TangentWeights { position: 1.0, velocity: 0.0 };
    force.add_blocks(&at(rows), weights, &mut force.new_scratch(), &mut matrix);
    assert_eq!(matrix.asymmetry(), 0.0);
    let mut product = vec![Vec3::ZERO; rows.len()];
    souple_solve::LinearOperator::apply(&matrix, delta, &mut product);
    let expected = differential(force, rows, delta);
    let apart: Vec<Vec3> = product.iter().zip(&expected).map(|(a, b)| *a - *b).collect();
    assert!(norm(&apart) < 1e-11 * norm(&expected), "{} of {}", norm(&apart), norm(&expected));
}

/// The tangent of the material alone is that of the whole at rest, and positive where compression makes that indefinite.
#[test]
fn material_tangents_stay_positive_under_compression() {
    let mesh = bar(SIZE, [8.0, 2.0, 2.0], "tet4");
    let body = Body::new(&mesh, line(5), "wendland");
    let rest = body.moved(&Mat3::IDENTITY, Vec3::ZERO);
    let laws = [material("st_venant_kirchhoff")];
    let [full, alone] = [TangentKind::Full, TangentKind::Material].map(|kind| body.force(&mesh, &laws, kind));
    let bend: Vec<Vec3> = (0..rest.len()).map(|row| Vec3::new(0.0, (row as f64).sin(), 0.0)).collect();
    let (a, b) = (differential(&full, &rest, &bend), differential(&alone, &rest, &bend));
    let apart: Vec<Vec3> = a.iter().zip(&b).map(|(a, b)| *a - *b).collect();
    assert!(norm(&apart) < 1e-12 * norm(&a));
    // shortened by a third along x: origins sideways in turn cost less than nothing
    let shrink = Mat3::from_diagonal(Vec3::new(0.6, 1.0, 1.0));
    let mut short = body.moved(&Mat3::IDENTITY, Vec3::ZERO);
    short.iter_mut().skip(FIRST as usize).for_each(|row| *row = shrink * *row);
    let sideways: Vec<Vec3> = (0..short.len())
        .map(|row| {
            let origin = row >= FIRST as usize && (row - FIRST as usize).is_multiple_of(4);
            if origin { Vec3::Y * if (row / 4).is_multiple_of(2) { 1.0 } else { -1.0 } } else { Vec3::ZERO }
        })
        .collect();
    let curvature = |force: &FramesForce| -> f64 {
        let change = differential(force, &short, &sideways);
        -change.iter().zip(&sideways).map(|(f, d)| f.dot(*d)).sum::<f64>()
    };
    assert!(curvature(&alone) > 0.0 && curvature(&full) < curvature(&alone));
}

/// Made definite sample by sample a tangent has no negative curvature where compression gives it some, and is the exact one, bit for bit,
/// where it has none.
#[test]
fn tangents_are_made_definite() {
    let mesh = bar(SIZE, [8.0, 2.0, 2.0], "tet4");
    let body = Body::new(&mesh, line(5), "wendland");
    let laws = [material("neo_hookean")];
    let force = body.force(&mesh, &laws, TangentKind::Full);
    let stiffness = |rows: &[Vec3], definite: bool| {
        let mut pattern = PatternBuilder::new(rows.len());
        force.visit_cliques(&[], &mut |clique| pattern.add_clique(clique).unwrap());
        let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(pattern.build().unwrap()));
        let weights = TangentWeights { position: -1.0, velocity: 0.0 };
        let scratch = &mut force.new_scratch();
        let turned = if definite {
            force.add_definite_blocks(&at(rows), weights, scratch, &mut matrix)
        } else {
            force.add_blocks(&at(rows), weights, scratch, &mut matrix);
            false
        };
        (turned, matrix.to_dense().concat())
    };
    let is_indefinite = |matrix: &[f64]| {
        let n = matrix.len().isqrt();
        dense::take_absolute(n, &mut matrix.to_vec(), &mut dense::Workspace::default())
    };
    let rest = body.moved(&Mat3::IDENTITY, Vec3::ZERO);
    assert_eq!(stiffness(&rest, true), (false, stiffness(&rest, false).1));
    let mut short = rest;
    let shrink = Mat3::from_diagonal(Vec3::new(0.6, 1.0, 1.0));
    short.iter_mut().skip(FIRST as usize).for_each(|row| *row = shrink * *row);
    let (exact, (turned, definite)) = (stiffness(&short, false).1, stiffness(&short, true));
    assert!(is_indefinite(&exact) && turned && !is_indefinite(&definite));
}

/// What the tangent of the material alone leaves out is `δF S`, with `S = λ tr(E) I + 2 μ E` of St. Venant–Kirchhoff, and nothing of a
/// law of small strain beside it, whose stress is no `F S`.
#[test]
fn material_tangents_leave_out_the_stress_alone() {
    let mesh = bar(SIZE, [8.0, 2.0, 2.0], "tet4");
    let body = Body::new(&mesh, line(4), "wendland");
    let laws = [material("st_venant_kirchhoff"), material("linear")];
    let [full, alone] = [TangentKind::Full, TangentKind::Material].map(|kind| body.force(&mesh, &laws, kind));
    let rows = body.strained();
    let delta: Vec<Vec3> =
        (0..rows.len()).map(|row| Vec3::new((row as f64).cos(), (2.0 * row as f64).sin(), 0.4)).collect();
    let gradient = |carried: &Carried, of: &[Vec3]| {
        let mut F = Mat3::ZERO;
        for (frame, gradients) in carried.frames.iter().zip(&carried.rows) {
            let first = body.rows[*frame as usize] as usize;
            for (row, (_, gradient)) in of[first..].iter().zip(gradients) {
                F += row.outer(*gradient);
            }
        }
        F
    };
    let moduli = laws[0].small_strain;
    let mut expected = vec![Vec3::ZERO; rows.len()];
    for (sample, carried) in body.samples.iter().zip(&body.carried) {
        // the first half of the cells, see `Body::force`
        if 2 * sample.cell as usize >= mesh.cell_count() {
            continue;
        }
        let (F, dF) = (gradient(carried, &rows), gradient(carried, &delta));
        let E = (F.transpose_mul(&F) - Mat3::IDENTITY) * 0.5;
        let S = Mat3::IDENTITY * (moduli.lambda * E.trace()) + E * (2.0 * moduli.mu);
        for (frame, gradients) in carried.frames.iter().zip(&carried.rows) {
            let first = body.rows[*frame as usize] as usize;
            for (force, (_, gradient)) in expected[first..].iter_mut().zip(gradients) {
                *force -= dF * (S * *gradient) * sample.volume;
            }
        }
    }
    let left_out: Vec<Vec3> = differential(&full, &rows, &delta)
        .iter()
        .zip(differential(&alone, &rows, &delta))
        .map(|(full, alone)| *full - alone)
        .collect();
    let apart: Vec<Vec3> = left_out.iter().zip(&expected).map(|(a, b)| *a - *b).collect();
    // shares are kept in single precision: a millionth
    assert!(norm(&apart) < 1e-5 * norm(&expected), "{} of {}", norm(&apart), norm(&expected));
    check_blocks(&alone, &rows, &delta);
    let small = [material("linear"), small_text_law()];
    let [full, alone] =
        [TangentKind::Full, TangentKind::Material].map(|kind| body.force(&mesh, &small, kind));
    assert_eq!(differential(&full, &rows, &delta), differential(&alone, &rows, &delta));
    check_blocks(&alone, &rows, &delta);
}

/// A spring without stiffness stores nothing and pulls at nothing; one with it stores `k/2 |S d|²`.
#[test]
fn springs_of_pins_store_what_they_pull() {
    let stored = |stiffness: f64| {
        let point = HeldPoint { row: 0, stiffness, start: Vec3::X, axes: [true, false, true], motion: None };
        let hold = Hold::new("pins", vec![point]);
        energy(&hold, &[Vec3::new(1.3, 5.0, -0.4)])
    };
    assert_eq!(stored(0.0), 0.0);
    // 0.3 along x, 0.4 along z: rounding
    assert!((stored(8.0) - 4.0 * 0.25).abs() < 1e-15);
}

/// Kinetic energy of rigid and affine motions is that of the points, for consistent and lumped mass alike; of any motion
/// for the consistent one.
#[test]
fn masses_have_the_energy_of_their_points() {
    let mesh = bar(SIZE, [8.0, 2.0, 2.0], "tet4");
    let body = Body::new(&mesh, line(5), "gaussian");
    let masses: Vec<f64> = body.samples.iter().map(|sample| 900.0 * sample.volume).collect();
    let mut consistent = Mass::new(body.row_count());
    frames::consistent_mass(&body.carried, &masses, &body.rows, &mut consistent);
    consistent.seal();
    let mut lumped = Mass::new(body.row_count());
    frames::lumped_mass(&body.frames, &body.samples, &body.carried, &masses, &body.rows, &mut lumped);
    lumped.seal();
    let of_points = |velocities: &[Vec3]| -> f64 {
        let of = |(carried, m): (&Carried, &f64)| {
            let v: Vec3 =
                carried.weights(&body.rows).map(|(row, weight)| velocities[row as usize] * weight).sum();
            0.5 * m * v.length_sq()
        };
        body.carried.iter().zip(&masses).map(of).sum()
    };
    let affine =
        Mat3::from_columns(Vec3::new(0.2, 1.0, 0.3), Vec3::new(-1.0, 0.1, 0.5), Vec3::new(0.4, -0.6, 0.2));
    let mut velocities = body.moved(&affine, Vec3::new(0.3, -0.2, 0.9));
    let expected = of_points(&velocities);
    for mass in [&consistent, &lumped] {
        assert!((mass.kinetic_energy(&velocities) - expected).abs() < 1e-12 * expected);
    }
    velocities = body.strained();
    let expected = of_points(&velocities);
    assert!((consistent.kinetic_energy(&velocities) - expected).abs() < 1e-12 * expected);
}

/// BOS-3: on a line of five frames and in a plane of twelve the moment matrix of moving least squares,
/// `Σ_i φ_i p p^T` with `p = (1, x, y, z)`, is singular, and the stiffness of frames is not: six motions that cost nothing,
/// as a body in space has, and no more.
#[test]
fn frames_on_a_line_and_in_a_plane_are_well_posed() {
    let grid = |nx: usize, ny: usize| -> Vec<Frame> {
        let at = |i: usize, j: usize| {
            Vec3::new(i as f64 / (nx - 1) as f64, 0.6 * j as f64 / (ny - 1) as f64, 0.02)
        };
        let frames = (0..nx * ny).map(|k| Frame { origin: at(k % nx, k / nx), axes: Mat3::IDENTITY });
        frames.collect()
    };
    let cases = [
        (bar(SIZE, [16.0, 3.0, 3.0], "tet4"), line(5)),
        (bar([1.0, 0.6, 0.04], [16.0, 10.0, 2.0], "tet4"), grid(4, 3)),
    ];
    for (mesh, frames) in cases {
        let count = frames.len();
        let middle = frames.iter().map(|frame| frame.origin).sum::<Vec3>() / count as f64;
        let moments: Mat3 = frames
            .iter()
            .map(|frame| (frame.origin - middle).outer(frame.origin - middle))
            .fold(Mat3::ZERO, |sum, part| sum + part);
        let values = eigen_symmetric(&moments).values.to_array();
        let (least, most) = values.iter().fold((f64::MAX, 0.0_f64), |(l, m), v| (l.min(v.abs()), m.max(*v)));
        assert!(least < 1e-15 * most, "moving least squares would have a condition of {:e}", most / least);
        let body = Body::new(&mesh, frames, "wendland");
        let force = body.force(&mesh, &[material("neo_hookean")], TangentKind::Full);
        let rest = body.moved(&Mat3::IDENTITY, Vec3::ZERO);
        // stiffness over shifts and turns of the frames
        let velocity = |frame: usize, motion: usize| {
            let mut rows = vec![Vec3::ZERO; rest.len()];
            let first = body.rows[frame] as usize;
            if motion < 3 {
                rows[first] = Vec3::AXES[motion];
            } else {
                let turn = Vec3::AXES[motion - 3] * 5.0;
                (1..4).for_each(|axis| rows[first + axis] = turn.cross(rest[first + axis]));
            }
            rows
        };
        let motions: Vec<Vec<Vec3>> = (0..6 * count).map(|index| velocity(index / 6, index % 6)).collect();
        let n = motions.len();
        let mut matrix = vec![0.0; n * n];
        for (column, motion) in motions.iter().enumerate() {
            let change = differential(&force, &rest, motion);
            for (row, other) in motions.iter().enumerate() {
                matrix[row * n + column] = -change.iter().zip(other).map(|(f, d)| f.dot(*d)).sum::<f64>();
            }
        }
        let mut values = eigenvalues(&mut matrix, n);
        values.sort_by(f64::total_cmp);
        let most = values[n - 1];
        assert!(values[5].abs() < 1e-10 * most, "six motions cost nothing: {:?}", &values[..8]);
        assert!(values[6] > 1e-6 * most, "all others do: {:?}", &values[..8]);
    }
}

/// Frames that points tell apart strain nothing unseen; of more than there are cells along the bar some motion strains between points alone, and
/// more frames at the same points are told of all the more; frames that are led do not move.
#[test]
fn motions_that_points_do_not_see_are_found() {
    let unseen = |cells: [f64; 3], element, frames: Vec<Frame>, is_affine: bool, led: &[u32]| {
        let mesh = bar(SIZE, cells, element);
        let body = Body::new(&mesh, frames, "wendland");
        let stiffness = vec![1.0; mesh.cell_count()];
        let shape = Shape { frames: &body.frames, mesh: &mesh, stiffness_of_cell: &stiffness };
        let weights = weights_of("wendland", &shape);
        let carried = |points: &[Vec3]| -> Vec<Carried> {
            points.iter().map(|point| Carried::new(&body.frames, &weights.shares(*point), *point)).collect()
        };
        let (points, centres) = (carried(&mesh.points), carried(&mesh.cell_centres()));
        let volumes = mesh.cell_volumes();
        let alike = vec![mesh.volume() / mesh.points.len() as f64; mesh.points.len()];
        let of_mesh = [(&centres[..], &volumes[..]), (&points[..], &alike[..])];
        let (frames, samples, carried) = (&body.frames, &body.samples, &body.carried);
        FramesAtRest { frames, is_affine, led, samples, carried, of_mesh }.unseen()
    };
    for is_affine in [false, true] {
        for element in ["tet4", "hex8"] {
            assert_eq!(
                unseen([16.0, 3.0, 3.0], element, line(5), is_affine, &[]),
                None,
                "{element} {is_affine}"
            );
        }
    }
    for count in [12, 16, 24, 32] {
        let found = unseen([7.0, 1.0, 1.0], "hex8", line(count), false, &[]);
        assert!(found.is_some_and(|unseen| unseen.times > 3.0), "{count}: {found:?}");
        let found = unseen([7.0, 1.0, 1.0], "hex8", line(count), true, &[]);
        assert!(found.is_some_and(|unseen| unseen.times > 3.0), "{count} affine: {found:?}");
    }
    let all: Vec<u32> = (0..12).collect();
    assert_eq!(unseen([7.0, 1.0, 1.0], "hex8", line(12), false, &all), None);
}

/// Eigenvalues of a symmetric matrix, by cyclic Jacobi.
fn eigenvalues(a: &mut [f64], n: usize) -> Vec<f64> {
    for _ in 0..12 {
        for p in 0..n {
            for q in p + 1..n {
                let off = a[p * n + q];
                if off == 0.0 {
                    continue;
                }
                let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * off);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let t = if theta == 0.0 { 1.0 } else { t };
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..n {
                    let (x, y) = (a[k * n + p], a[k * n + q]);
                    (a[k * n + p], a[k * n + q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (a[p * n + k], a[q * n + k]);
                    (a[p * n + k], a[q * n + k]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    (0..n).map(|i| a[i * n + i]).collect()
}
