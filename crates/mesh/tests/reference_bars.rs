//! Elements, rules and generators together: tips of the reference bar against an independent code.
//!
//! Bar [0,1] x [0,0.1]² m of 10n x n x n cubes, clamped at x = 0, gravity 9.81 m/s² along -y, E = 1e7 Pa,
//! nu = 0.3, rho = 1000 kg/m³; GetFEM's mean displacement of the four corners of x = 1.

#![allow(non_snake_case)] // symbols of the mathematics

use souple_math::{Mat3, Vec3};
use souple_mesh::{ElementKind, Mesh, generate};
use souple_table::{Value, Values};

const YOUNGS_MODULUS: f64 = 1e7;
const POISSONS_RATIO: f64 = 0.3;
const WEIGHT: Vec3 = Vec3::new(0.0, -9.81 * 1000.0, 0.0);

fn bar(n: usize, element: &str) -> Mesh {
    let n = n as f64;
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.1, 0.1]))
        .with("cells", Value::Vector([10.0 * n, n, n]))
        .with("element", Value::Text(element));
    generate("bar", values).unwrap()
}

/// St. Venant–Kirchhoff: internal forces and their derivative at `displacements`, weights of the nodes.
struct Assembled {
    residual: Vec<f64>,
    stiffness: Vec<f64>,
}

fn assemble(mesh: &Mesh, u: &[Vec3], rule: impl Fn(ElementKind) -> &'static str) -> Assembled {
    let mu = YOUNGS_MODULUS / (2.0 * (1.0 + POISSONS_RATIO));
    let lambda = YOUNGS_MODULUS * POISSONS_RATIO / ((1.0 + POISSONS_RATIO) * (1.0 - 2.0 * POISSONS_RATIO));
    let size = 3 * mesh.points.len();
    let mut assembled = Assembled { residual: vec![0.0; size], stiffness: vec![0.0; size * size] };
    for cell in mesh.cells() {
        let positions: Vec<Vec3> = cell.nodes.iter().map(|node| mesh.points[*node as usize]).collect();
        for point in &cell.kind.rule(rule(cell.kind)).unwrap().points {
            let J = cell.kind.jacobian(&positions, point.position);
            let inverse = J.try_inverse().unwrap();
            let volume = point.weight * J.determinant();
            let shape = cell.kind.shape(point.position);
            let reference = cell.kind.shape_gradients(point.position);
            let gradients: Vec<Vec3> = reference.iter().map(|g| inverse.transpose() * *g).collect();
            let mut F = Mat3::IDENTITY;
            for (node, gradient) in cell.nodes.iter().zip(&gradients) {
                F += u[*node as usize].outer(*gradient);
            }
            let E = (F.transpose_mul(&F) - Mat3::IDENTITY) * 0.5;
            let S = (E * (2.0 * mu)).plus_diagonal(lambda * E.trace());
            for (a, &node_a) in cell.nodes.iter().enumerate() {
                let force = (F * S * gradients[a] - WEIGHT * shape[a]) * volume;
                for i in 0..3 {
                    assembled.residual[3 * node_a as usize + i] += force[i];
                }
                for (b, &node_b) in cell.nodes.iter().enumerate() {
                    for j in 0..3 {
                        let dF = Vec3::AXES[j].outer(gradients[b]);
                        let dE = F.transpose_mul(&dF).symmetric_part();
                        let dS = (dE * (2.0 * mu)).plus_diagonal(lambda * dE.trace());
                        let column = (dF * S + F * dS) * gradients[a] * volume;
                        for i in 0..3 {
                            let row = 3 * node_a as usize + i;
                            assembled.stiffness[row * size + 3 * node_b as usize + j] += column[i];
                        }
                    }
                }
            }
        }
    }
    assembled
}

/// Solves `A x = b` in place for a symmetric positive definite `A`, by Cholesky.
fn solve(matrix: &mut [f64], b: &mut [f64]) {
    let n = b.len();
    for i in 0..n {
        for j in 0..=i {
            let (row, other) = (&matrix[i * n..i * n + j], &matrix[j * n..j * n + j]);
            let sum = matrix[i * n + j] - row.iter().zip(other).map(|(x, y)| x * y).sum::<f64>();
            matrix[i * n + j] = if i == j { sum.sqrt() } else { sum / matrix[j * n + j] };
        }
    }
    for i in 0..n {
        let sum: f64 = (0..i).map(|j| matrix[i * n + j] * b[j]).sum();
        b[i] = (b[i] - sum) / matrix[i * n + i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|j| matrix[j * n + i] * b[j]).sum();
        b[i] = (b[i] - sum) / matrix[i * n + i];
    }
}

/// Mean displacement of the corners of x = 1 after `iterations` of Newton; one is linear elasticity.
fn tip(mesh: &Mesh, iterations: usize, rule: impl Fn(ElementKind) -> &'static str) -> Vec3 {
    let free: Vec<usize> = (0..mesh.points.len()).filter(|p| mesh.points[*p].x > 1e-9).collect();
    let mut u = vec![Vec3::ZERO; mesh.points.len()];
    let size = 3 * mesh.points.len();
    for _ in 0..iterations {
        let assembled = assemble(mesh, &u, &rule);
        let rows: Vec<usize> = free.iter().flat_map(|p| (0..3).map(move |i| 3 * p + i)).collect();
        let entry = |r: &usize, c: &usize| assembled.stiffness[r * size + c];
        let mut matrix: Vec<f64> = rows.iter().flat_map(|r| rows.iter().map(move |c| entry(r, c))).collect();
        let mut step: Vec<f64> = rows.iter().map(|r| -assembled.residual[*r]).collect();
        solve(&mut matrix, &mut step);
        for (row, value) in rows.iter().zip(step) {
            u[row / 3][row % 3] += value;
        }
    }
    let corner = |p: Vec3| p.x > 1.0 - 1e-9 && [p.y, p.z].iter().all(|c| *c < 1e-9 || *c > 0.1 - 1e-9);
    (0..u.len()).filter(|p| corner(mesh.points[*p])).map(|p| u[p]).sum::<Vec3>() * 0.25
}

/// Discrete static tips of GetFEM: (element, n, linear, St. Venant–Kirchhoff), components x, y, z.
type Row = (&'static str, usize, [f64; 3], [f64; 3]);
const REFERENCE: [Row; 7] = [
    (
        "tet4",
        1,
        [-7.025127913689493e-05, -0.03290207677906459, 0.008723304676360824],
        [-0.0007137325343208008, -0.03277386013744529, 0.008688106792023392],
    ),
    ("hex8", 1, [0.0, -0.09557806242618869, 0.0], [-0.005135165569123006, -0.09490604711694053, 0.0]),
    (
        "prism6",
        1,
        [0.0, -0.09023659182761375, 0.003941291827734476],
        [-0.004582081599337733, -0.08967544201630433, 0.0039043039555599754],
    ),
    ("pyramid5", 1, [0.0, -0.07844287526143434, 0.0], [-0.003459771093410126, -0.07808057204864713, 0.0]),
    ("hex8", 2, [0.0, -0.12876284033785645, 0.0], [-0.009271161179264974, -0.12714878683692987, 0.0]),
    (
        "prism6",
        2,
        [0.0, -0.12399541986398246, 0.0027905739096254433],
        [-0.008604348161792005, -0.12255805178958526, 0.002741012974807102],
    ),
    ("pyramid5", 2, [0.0, -0.11831295084396304, 0.0], [-0.007842495508530521, -0.11706704737443191, 0.0]),
];

fn assert_tip(measured: Vec3, expected: [f64; 3], tolerance: f64, what: &str) {
    let difference = (measured - Vec3::from_array(expected)).largest_component();
    assert!(difference <= tolerance * expected[1].abs(), "{what}: {measured:?}, expected {expected:?}");
}

/// Linear elasticity with the default rules is the reference's answer. The condition number of the clamped bar,
/// about (length/height)⁴ n⁴, times the rounding unit leaves nine digits.
#[test]
fn default_rules_integrate_linear_elasticity() {
    for (element, n, linear, _) in REFERENCE {
        let measured = tip(&bar(n, element), 1, |kind| kind.default_rule().name);
        assert_tip(measured, linear, 1e-9, &format!("{element} n = {n}"));
    }
}

/// St. Venant–Kirchhoff with the full rules is the reference's answer, whose Newton stopped at about 1e-10.
#[test]
fn full_rules_integrate_st_venant_kirchhoff() {
    for (element, n, _, stvk) in REFERENCE.into_iter().filter(|row| row.1 == 1) {
        let measured = tip(&bar(n, element), 8, |kind| kind.full_rule().name);
        assert_tip(measured, stvk, 1e-9, &format!("{element} n = {n}"));
    }
}

/// A mixed bar bends between the stiffest and the softest of its kinds.
#[test]
fn mixed_bar_is_between_its_kinds() {
    let deflection = |element: &str| -tip(&bar(1, element), 1, |kind| kind.default_rule().name).y;
    let mixed = deflection("mixed");
    assert!(deflection("tet4") < mixed && mixed < deflection("hex8"), "{mixed}");
}
