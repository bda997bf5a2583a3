//! Rules of quadrature on the reference cells: `∫ f dξ ≈ Σ weight f(ξ)`.
//!
//! Every rule has positive weights and points inside the cell. Its degree is the total degree of the
//! polynomials that it integrates exactly.

use souple_math::Vec3;

/// A point of a rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraturePoint {
    /// Reference coordinates `ξ`.
    pub position: Vec3,
    /// The weights of a rule add up to the volume of the reference cell.
    pub weight: f64,
}

/// A rule of quadrature on a reference cell.
#[derive(Clone, Debug)]
pub struct QuadratureRule {
    /// `gauss_` and the number of points.
    pub name: &'static str,
    /// Polynomials of this total degree are integrated exactly.
    pub degree: usize,
    pub points: Vec<QuadraturePoint>,
}

/// How an element declares a rule.
#[derive(Debug)]
pub struct RuleDefinition {
    pub(crate) name: &'static str,
    pub(crate) degree: usize,
    pub(crate) points: fn() -> Vec<QuadraturePoint>,
}

impl RuleDefinition {
    pub(crate) fn build(&self) -> QuadratureRule {
        QuadratureRule { name: self.name, degree: self.degree, points: (self.points)() }
    }
}

fn point(x: f64, y: f64, z: f64, weight: f64) -> QuadraturePoint {
    QuadraturePoint { position: Vec3::new(x, y, z), weight }
}

/// Gauss points and weights on `[-1, 1]` for the weight function `(1 - x)^alpha`, exact to degree `2 count - 1`.
///
/// Roots of the Jacobi polynomial `P_n^(α,0)` by Newton with deflation; the weights are
/// `2^(α+1) / ((1 - x²) P_n'(x)²)`.
pub(crate) fn gauss_jacobi(count: usize, alpha: u32) -> Vec<(f64, f64)> {
    let mut roots: Vec<f64> = Vec::with_capacity(count);
    for k in 0..count {
        let mut x = libm::cos(std::f64::consts::PI * (4 * k + 3) as f64 / (4 * count + 2) as f64);
        for _ in 0..100 {
            let (value, slope) = jacobi(count, f64::from(alpha), x);
            // Newton on P / Π (x - xᵢ), so that no root is found twice
            let deflation: f64 = roots.iter().map(|root| 1.0 / (x - root)).sum();
            let step = value / (slope - value * deflation);
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        roots.push(x);
    }
    roots.sort_by(f64::total_cmp);
    let weight = |x: f64| {
        let (_, slope) = jacobi(count, f64::from(alpha), x);
        f64::from(1u32 << (alpha + 1)) / ((1.0 - x * x) * slope * slope)
    };
    roots.into_iter().map(|x| (x, weight(x))).collect()
}

/// `P_n^(α,0)(x)` and its derivative, by the three-term recurrence.
fn jacobi(n: usize, alpha: f64, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = ((1.0, 0.0), (0.5 * (alpha + (alpha + 2.0) * x), 0.5 * (alpha + 2.0)));
    if n == 0 {
        return previous;
    }
    for k in 1..n {
        let k = k as f64;
        let s = 2.0 * k + alpha;
        // 2(k+1)(k+α+1)s P_{k+1} = (s+1)(s(s+2)x + α²) P_k - 2k(k+α)(s+2) P_{k-1}
        let a = 2.0 * (k + 1.0) * (k + alpha + 1.0) * s;
        let b = (s + 1.0) * (s * (s + 2.0) * x + alpha * alpha);
        let db = (s + 1.0) * s * (s + 2.0);
        let c = 2.0 * k * (k + alpha) * (s + 2.0);
        let next =
            ((b * current.0 - c * previous.0) / a, (db * current.0 + b * current.1 - c * previous.1) / a);
        (previous, current) = (current, next);
    }
    current
}

pub(crate) fn line(count: usize) -> Vec<QuadraturePoint> {
    gauss_jacobi(count, 0).into_iter().map(|(x, weight)| point(x, 0.0, 0.0, weight)).collect()
}

pub(crate) fn quadrilateral(count: usize) -> Vec<QuadraturePoint> {
    let line = gauss_jacobi(count, 0);
    let row = |&(y, wy): &(f64, f64)| {
        line.iter().map(move |&(x, wx)| point(x, y, 0.0, wx * wy)).collect::<Vec<_>>()
    };
    line.iter().flat_map(row).collect()
}

pub(crate) fn hexahedron(count: usize) -> Vec<QuadraturePoint> {
    let layer = quadrilateral(count);
    stacked(&layer, count)
}

pub(crate) fn prism(triangle_count: usize, line_count: usize) -> Vec<QuadraturePoint> {
    stacked(&triangle(triangle_count), line_count)
}

/// A plane rule times Gauss points along `ζ ∈ [-1, 1]`.
fn stacked(layer: &[QuadraturePoint], count: usize) -> Vec<QuadraturePoint> {
    let at = |z: f64, wz: f64| {
        layer.iter().map(move |p| point(p.position.x, p.position.y, z, p.weight * wz)).collect::<Vec<_>>()
    };
    gauss_jacobi(count, 0).into_iter().flat_map(|(z, wz)| at(z, wz)).collect()
}

/// Symmetric rules of 1, 3, 6, 16 (Dunavant) and 7 points (Radon).
pub(crate) fn triangle(count: usize) -> Vec<QuadraturePoint> {
    let third = 1.0 / 3.0;
    // the orbit (a, a), (1-2a, a), (a, 1-2a)
    let orbit = |a: f64, weight: f64| {
        let b = 1.0 - 2.0 * a;
        [point(a, a, 0.0, weight), point(b, a, 0.0, weight), point(a, b, 0.0, weight)]
    };
    match count {
        1 => vec![point(third, third, 0.0, 0.5)],
        3 => orbit(1.0 / 6.0, 1.0 / 6.0).to_vec(),
        6 => {
            let a = orbit(0.445_948_490_915_964_9, 0.5 * 0.223_381_589_678_011_47);
            let b = orbit(0.091_576_213_509_770_74, 0.5 * 0.109_951_743_655_321_87);
            [a, b].concat()
        }
        7 => {
            let root = 15.0_f64.sqrt();
            let a = orbit((6.0 + root) / 21.0, 0.5 * (155.0 + root) / 1200.0);
            let b = orbit((6.0 - root) / 21.0, 0.5 * (155.0 - root) / 1200.0);
            [&[point(third, third, 0.0, 0.5 * 0.225)][..], &a, &b].concat()
        }
        16 => {
            let a = orbit(0.459_292_588_292_723_1, 0.5 * 0.095_091_634_267_284_63);
            let b = orbit(0.170_569_307_751_760_2, 0.5 * 0.103_217_370_534_718_25);
            let c = orbit(0.050_547_228_317_030_98, 0.5 * 0.032_458_497_623_198_08);
            // the orbit of three different coordinates
            let (p, q, w) =
                (0.263_112_829_634_638_1, 0.008_394_777_409_957_605, 0.5 * 0.027_230_314_174_434_99);
            let r = 1.0 - p - q;
            let six = [(p, q), (q, p), (q, r), (r, q), (r, p), (p, r)].map(|(x, y)| point(x, y, 0.0, w));
            [&[point(third, third, 0.0, 0.5 * 0.144_315_607_677_787_17)][..], &a, &b, &c, &six].concat()
        }
        _ => unreachable!("triangles have rules of 1, 3, 6, 7 and 16 points"),
    }
}

/// Symmetric rules of 1, 4 and 14 points (Walkington), conical product of 8.
pub(crate) fn tetrahedron(count: usize) -> Vec<QuadraturePoint> {
    // the orbit of (a, a, a, 1-3a) in barycentric coordinates
    let corners = |a: f64, w: f64| {
        let b = 1.0 - 3.0 * a;
        [point(a, a, a, w), point(b, a, a, w), point(a, b, a, w), point(a, a, b, w)]
    };
    match count {
        1 => vec![point(0.25, 0.25, 0.25, 1.0 / 6.0)],
        4 => corners((5.0 - 5.0_f64.sqrt()) / 20.0, 1.0 / 24.0).to_vec(),
        8 => {
            // ξ = r(1-s)(1-t), η = s(1-t), ζ = t on the unit cube: the Jacobian is (1-s)(1-t)²
            let unit = |alpha: u32| {
                let scale = f64::from(1u32 << (alpha + 1));
                gauss_jacobi(2, alpha).into_iter().map(move |(x, w)| (0.5 * (x + 1.0), w / scale))
            };
            let mut points = Vec::with_capacity(8);
            for (t, wt) in unit(2) {
                for (s, ws) in unit(1) {
                    for (r, wr) in unit(0) {
                        points.push(point(r * (1.0 - s) * (1.0 - t), s * (1.0 - t), t, wr * ws * wt));
                    }
                }
            }
            points
        }
        14 => {
            let a = corners(0.310_885_919_263_300_6, 0.018_781_320_953_002_64);
            let b = corners(0.092_735_250_310_891_23, 0.012_248_840_519_393_66);
            // the orbit of (c, c, d, d), middles of edges
            let (c, w) = (0.045_503_704_125_649_65, 0.007_091_003_462_846_911);
            let d = 0.5 - c;
            let edges = [(c, c, d), (c, d, c), (d, c, c), (c, d, d), (d, c, d), (d, d, c)];
            let edges = edges.map(|(x, y, z)| point(x, y, z, w));
            [&a[..], &b, &edges].concat()
        }
        _ => unreachable!("tetrahedra have rules of 1, 4, 8 and 14 points"),
    }
}

/// Conical product: `ξ = r(1-ζ)`, `η = s(1-ζ)` with the Jacobian `(1-ζ)²` in the weight of Gauss–Jacobi points.
pub(crate) fn pyramid(base_count: usize, height_count: usize) -> Vec<QuadraturePoint> {
    let base = quadrilateral(base_count);
    let mut points = Vec::with_capacity(base.len() * height_count);
    for (x, weight) in gauss_jacobi(height_count, 2) {
        // ζ = (1+x)/2: (1-ζ)² dζ = (1-x)²/8 dx
        let z = 0.5 * (1.0 + x);
        let shrink = 1.0 - z;
        for p in &base {
            points.push(point(p.position.x * shrink, p.position.y * shrink, z, p.weight * weight / 8.0));
        }
    }
    points
}

/// Five points of equal weight, degree 2: four towards the corners of the base, one on the axis.
pub(crate) fn pyramid_five() -> Vec<QuadraturePoint> {
    // 4 h₁ + h₂ = 5/4 and 4 h₁² + h₂² = 1/2, from the moments ∫ζ = 1/3 and ∫ζ² = 2/15
    let low = (10.0 - 15.0_f64.sqrt()) / 40.0;
    let high = 1.25 - 4.0 * low;
    let weight = 4.0 / 15.0;
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let mut points: Vec<_> = corners.into_iter().map(|(x, y)| point(x, y, low, weight)).collect();
    points.push(point(0.0, 0.0, high, weight));
    points
}
