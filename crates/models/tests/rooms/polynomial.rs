//! Bodies of one polynomial (JIM-97, PA-20): forces are gradients and blocks their derivatives, rigid motions strain nothing, quadratic fields
//! are had exactly.

use souple_engine::{Configuration, Force, KeptRef, TangentWeights};
use souple_math::{Mat3, Vec3, exponential};
use souple_models::frames::{Sample, samples_of_cells};
use souple_models::materials::{self, Material};
use souple_models::reduced::{Degree, Polynomial, PolynomialDescription, PolynomialForce};
use souple_solve::{BlockMatrix, PatternBuilder};
use souple_table::{Value, Values};

const LAWS: [&str; 5] =
    ["linear", "corotational", "st_venant_kirchhoff", "neo_hookean", "stable_neo_hookean"];

fn material(law: &str) -> Material {
    let entry = materials::TABLE.find(law).expect("a law");
    let values = Values::new()
        .with("youngs_modulus", Value::Number(1e3))
        .with("poissons_ratio", Value::Number(0.3))
        .with("density", Value::Number(1000.0));
    (entry.build)(&entry.values(values).expect("numbers")).expect("a material")
}

/// Samples of two boxes side by side.
fn samples() -> Vec<Sample> {
    let values = Values::new()
        .with("size", Value::Vector([2.0, 1.0, 1.0]))
        .with("cells", Value::Vector([2.0, 1.0, 1.0]))
        .with("element", Value::Text("hex8"));
    samples_of_cells(&souple_mesh::generate("bar", values).expect("a bar"), Some(2))
}

fn polynomial(degree: Degree) -> Polynomial {
    Polynomial { degree, centre: Vec3::new(1.0, 0.5, 0.4), length: 1.3 }
}

fn force(degree: Degree, law: &str) -> PolynomialForce {
    PolynomialForce::new(&PolynomialDescription {
        name: "bar.material".into(),
        polynomial: polynomial(degree),
        first_row: 1,
        samples: &samples(),
        materials: &[material(law)],
        material_of_cell: &[0, 0],
        axes: &[],
    })
}

fn view(positions: &[Vec3]) -> Configuration<'_> {
    Configuration {
        positions,
        velocities: positions,
        time: 0.0,
        load: 1.0,
        memory: &[],
        pairs: &[],
        kept: KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

/// A row of another body, and those of the polynomial, moved by `by` a way that strains it.
fn rows(degree: Degree, by: f64) -> Vec<Vec3> {
    let number = |i: usize| (1.7 * i as f64 + 0.4).sin();
    let polynomial = polynomial(degree);
    let moved = polynomial.rest().enumerate().map(|(term, row)| {
        row + Vec3::new(number(3 * term), number(3 * term + 1), number(3 * term + 2)) * by
    });
    std::iter::once(Vec3::ZERO).chain(moved).collect()
}

/// Forces are minus the gradient of the energy, differentials their derivatives, and blocks have the same products.
#[test]
fn forces_of_polynomials_are_gradients() {
    for (degree, law) in
        [Degree::Affine, Degree::Quadratic].into_iter().flat_map(|degree| LAWS.map(|law| (degree, law)))
    {
        let force = force(degree, law);
        let mut scratch = force.new_scratch();
        let x = rows(degree, 0.1);
        let way: Vec<Vec3> = rows(degree, 1.3).iter().zip(&rows(degree, 0.0)).map(|(a, b)| *a - *b).collect();
        let at = |by: f64| -> Vec<Vec3> { x.iter().zip(&way).map(|(x, way)| *x + *way * by).collect() };
        let step = 1e-5;
        let mut energy = |by: f64| force.energy(&view(&at(by)), &mut scratch).stored;
        let slope = (energy(step) - energy(-step)) * (0.5 / step);
        let forces = |by: f64| {
            let mut out = vec![Vec3::ZERO; x.len()];
            force.add_force(&view(&at(by)), &mut force.new_scratch(), &mut out);
            out
        };
        let dot = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
        let power = -dot(&forces(0.0), &way);
        // step² times a third derivative of the size of the moduli, and rounding of an energy of a thousand over the step
        assert!((slope - power).abs() < 1e-6 * power.abs().max(1e3), "{law}: {slope} {power}");
        let mut exact = vec![Vec3::ZERO; x.len()];
        let weights = TangentWeights { position: 1.0, velocity: 0.0 };
        force.add_differential(&view(&x), weights, &way, &mut scratch, &mut exact);
        let size = dot(&exact, &exact).sqrt();
        let (plus, minus) = (forces(step), forces(-step));
        for ((plus, minus), exact) in plus.iter().zip(&minus).zip(&exact) {
            let numeric = (*plus - *minus) * (0.5 / step);
            assert!((numeric - *exact).length() < 1e-7 * size, "{law}: {numeric:?} {exact:?}");
        }
        let mut builder = PatternBuilder::new(x.len());
        force.visit_cliques(&[], &mut |rows| builder.add_clique(rows).expect("rows"));
        let mut matrix = BlockMatrix::zeros(builder.build().expect("a pattern").into());
        force.add_blocks(&view(&x), weights, &mut scratch, &mut matrix);
        let mut product = vec![Vec3::ZERO; x.len()];
        for (row, product) in product.iter_mut().enumerate().skip(1) {
            for slot in matrix.pattern().slots(row) {
                *product += matrix.values()[slot] * way[matrix.pattern().columns()[slot] as usize];
            }
        }
        for (product, exact) in product.iter().zip(&exact) {
            // sums of some thousand products
            assert!((*product - *exact).length() < 1e-12 * size, "{law}: {product:?} {exact:?}");
        }
        let mut definite = BlockMatrix::zeros(matrix.pattern().clone());
        let weights = TangentWeights { position: -1.0, velocity: 0.0 };
        let turned =
            force.add_definite_blocks(&view(&rows(degree, 0.0)), weights, &mut scratch, &mut definite);
        assert!(!turned, "{law}: nothing is negative at rest");
    }
}

/// A turned and shifted body stores nothing, under laws that know no rest orientation.
#[test]
fn rigid_motions_of_polynomials_strain_nothing() {
    let turn = exponential(Vec3::new(0.4, -1.1, 0.7));
    for (degree, law) in
        [Degree::Affine, Degree::Quadratic].into_iter().flat_map(|degree| LAWS.map(|law| (degree, law)))
    {
        if law == "linear" {
            continue;
        }
        let force = force(degree, law);
        let moved: Vec<Vec3> = rows(degree, 0.0).iter().map(|row| turn * *row).collect();
        let mut out = vec![Vec3::ZERO; moved.len()];
        force.add_force(&view(&moved), &mut force.new_scratch(), &mut out);
        // rounding of stresses of a thousand
        assert!(out.iter().all(|force| force.length() < 1e-11), "{law}: {out:?}");
    }
}

/// Every quadratic field is one of the rows, its gradient that of the field.
#[test]
fn quadratic_fields_are_exact() {
    let polynomial = polynomial(Degree::Quadratic);
    // c + A P + (P·B P) e
    let (turn, bend) =
        (exponential(Vec3::new(0.1, 0.2, -0.3)), Mat3::from_diagonal(Vec3::new(0.3, -0.2, 0.5)));
    let (offset, way) = (Vec3::new(0.1, -0.2, 0.3), Vec3::new(0.4, 0.5, -0.1));
    let field = |p: Vec3| offset + turn * p + way * p.dot(bend * p);
    let gradient = |p: Vec3| turn + way.outer(bend * p) * 2.0;
    // rows from ten places, by the differences that a quadratic has exactly
    let (c, l) = (polynomial.centre, polynomial.length);
    let at = |u: f64, v: f64, w: f64| field(c + Vec3::new(u, v, w) * l);
    let linear = |axis: Vec3| (at(axis.x, axis.y, axis.z) - at(-axis.x, -axis.y, -axis.z)) * 0.5;
    let square =
        |axis: Vec3| (at(axis.x, axis.y, axis.z) + at(-axis.x, -axis.y, -axis.z)) * 0.5 - at(0.0, 0.0, 0.0);
    let mixed = |u: f64, v: f64, w: f64| {
        let (a, b) = (Vec3::new(u, v, w), Vec3::AXES);
        let parts = (0..3).filter(|k| a[*k] != 0.0).map(|k| linear(b[k]) + square(b[k]));
        at(u, v, w) - at(0.0, 0.0, 0.0) - parts.sum::<Vec3>()
    };
    let [x, y, z] = Vec3::AXES;
    let rows = [
        at(0.0, 0.0, 0.0),
        linear(x),
        linear(y),
        linear(z),
        mixed(1.0, 1.0, 0.0),
        mixed(1.0, 0.0, 1.0),
        mixed(0.0, 1.0, 1.0),
        square(x),
        square(y),
        square(z),
    ];
    for sample in samples() {
        let place: Vec3 = rows.iter().zip(polynomial.terms(sample.position)).map(|(row, z)| *row * z).sum();
        let slope = rows
            .iter()
            .zip(polynomial.gradients(sample.position))
            .fold(Mat3::ZERO, |sum, (row, g)| sum + row.outer(g));
        // sums of ten products of order one
        assert!((place - field(sample.position)).length() < 1e-14);
        assert!((slope - gradient(sample.position)).largest_entry() < 1e-14);
    }
}
