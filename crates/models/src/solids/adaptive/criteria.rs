//! When an element needs another law: how far edges, volume, shape and forces of an element are from rest.
//!
//! Lengths, volumes and shapes count by what they have changed since rest, so that a criterion is zero there whatever the
//! element (Faure 2014, §6.4.2–6.4.3, eq. 6.2 and 6.3 with the norm outside the sum).

#![allow(non_snake_case)]

use souple_math::{Mat3, Real, Vec3};
use souple_mesh::{ElementKind, MAX_NODES, QuadratureRule};

/// A criterion of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// `R_L`: the greatest change of length of an edge, relative.
    Length,
    /// `R_A`: the change of volume, of a surface element that of area, relative. Under small strain it tells rotation: `tan²θ`. What is
    /// turned inside out is over any threshold; a membrane has no inside.
    Volume,
    /// `R_F`: the greatest growth of the shape factor of a triangle of three corners of a face, of a surface element its own, circumradius
    /// over twice the inradius, relative.
    Shape,
    /// `R_S`: the mean over the volume, of a surface element over the area, of the field of nodal forces of the element [N].
    Force,
}

/// An element as it stands and as it rests.
pub struct Element<'a> {
    pub kind: ElementKind,
    pub rule: &'a QuadratureRule,
    /// Of a volume one, of a surface element its thickness [m].
    pub thickness: f64,
    /// In a plane of constant z, where areas have a sign: that of the element at rest is positive.
    pub is_plane: bool,
    pub rest: &'a [Vec3],
    pub now: &'a [Vec3],
}

/// The corners of the faces of a volume, of a surface element all of its own.
pub fn faces(kind: ElementKind) -> impl Iterator<Item = &'static [u8]> {
    const ALL: &[u8] = &[0, 1, 2, 3];
    let is_surface = kind.dimension() == 2;
    let own = is_surface.then(|| &ALL[..kind.corner_count().min(ALL.len())]);
    let of_volume = if is_surface { &[][..] } else { kind.faces() };
    own.into_iter().chain(of_volume.iter().map(|face| &face.nodes[..face.kind.corner_count()]))
}

impl Element<'_> {
    /// A criterion; `stress` gives the first Piola–Kirchhoff stress of a deformation gradient, of a surface element of one that knows
    /// nothing across.
    pub fn measure(&self, criterion: Criterion, stress: impl Fn(&Mat3) -> Mat3) -> f64 {
        match criterion {
            Criterion::Length => self.length(),
            Criterion::Volume => change_of_volume(self.volume(self.now) / self.volume(self.rest)),
            Criterion::Shape => self.shape(),
            Criterion::Force => self.mean_force(stress),
        }
    }

    fn length(&self) -> f64 {
        let change = |[a, b]: &[u8; 2]| {
            let length = |x: &[Vec3]| (x[usize::from(*a)] - x[usize::from(*b)]).length();
            (length(self.now) / length(self.rest) - 1.0).abs()
        };
        self.kind.edges().iter().map(change).fold(0.0, f64::max)
    }

    fn volume(&self, x: &[Vec3]) -> f64 {
        let of_point = |xi: Vec3| {
            let now = self.kind.jacobian(x, xi);
            // the third column is the normal: the determinant is an area
            let is_over =
                self.is_plane && now.columns[2].dot(self.kind.jacobian(self.rest, xi).columns[2]) < 0.0;
            if is_over { -now.determinant() } else { now.determinant() }
        };
        self.rule.points.iter().map(|point| point.weight * of_point(point.position)).sum()
    }

    fn shape(&self) -> f64 {
        let mut most: f64 = 0.0;
        for corners in faces(self.kind) {
            for at in 0..corners.len() {
                let three = [0, 1, 2].map(|i| usize::from(corners[(at + i) % corners.len()]));
                let growth =
                    shape_factor(three.map(|n| self.now[n])) / shape_factor(three.map(|n| self.rest[n]));
                most = most.max(growth - 1.0);
            }
        }
        most
    }

    // 1/V(t) Σ w det J |Σ N_a f_a|
    fn mean_force(&self, stress: impl Fn(&Mat3) -> Mat3) -> f64 {
        let mut forces = [Vec3::ZERO; MAX_NODES];
        self.at_samples(|F, inverse, volume, xi| {
            let H = stress(&F).mul_transpose(&inverse) * volume;
            for (force, gradient) in forces.iter_mut().zip(self.kind.shape_gradients(xi).iter()) {
                *force -= H * *gradient;
            }
        });
        // one sample would not see the field of a tetrahedron, whose forces add up to nothing at its centre
        let mut sum = 0.0;
        for point in &self.kind.mass_rule().points {
            let volume = self.kind.jacobian(self.rest, point.position).determinant() * point.weight;
            let shape = self.kind.shape(point.position);
            let field: Vec3 = shape.iter().zip(&forces).map(|(N, f)| *f * *N).sum();
            sum += volume * field.length();
        }
        // an element that is inverted is over any threshold, as one without volume is
        sum / self.volume(self.now).max(0.0)
    }

    /// Calls `visit(F, X_ξ⁻¹, volume, ξ)` at every sample; of a surface element `F` is zero across.
    pub fn at_samples(&self, mut visit: impl FnMut(Mat3, Mat3, f64, Vec3)) {
        for point in &self.rule.points {
            let jacobian = self.kind.jacobian(self.rest, point.position);
            // cells without volume were refused when the body was made
            let Some(inverse) = jacobian.try_inverse() else { continue };
            let mut now = self.kind.jacobian(self.now, point.position);
            now.columns[self.kind.dimension()..].fill(Vec3::ZERO);
            let volume = jacobian.determinant() * point.weight * self.thickness;
            visit(now * inverse, inverse, volume, point.position);
        }
    }
}

/// `|V/V₀ - 1|`, without bound where the element is turned inside out.
fn change_of_volume(ratio: f64) -> f64 {
    if ratio <= 0.0 { f64::INFINITY } else { (ratio - 1.0).abs() }
}

/// `abc / (8 (s - a)(s - b)(s - c))` with `s` half the circumference: 1 of an equilateral triangle, without bound as it gets flat.
#[inline(always)]
pub fn shape_factor<R: Real>([x, y, z]: [Vec3<R>; 3]) -> R {
    let (a, b, c) = ((y - x).length(), (z - y).length(), (x - z).length());
    let s = (a + b + c) * 0.5;
    // of corners on a line rounding may say less than nothing
    a * b * c / (((s - a) * (s - b) * (s - c)).max(s.zero()) * 8.0)
}

#[cfg(test)]
mod tests {
    use souple_math::exponential;

    use super::*;

    fn of(kind: ElementKind, F: &Mat3, criterion: Criterion) -> f64 {
        let rest = kind.regular();
        let now: Vec<Vec3> = rest.iter().map(|x| *F * *x).collect();
        let thickness = if kind.dimension() == 2 { 0.01 } else { 1.0 };
        let is_plane = kind.dimension() == 2 && F.columns[2] == Vec3::AXES[2];
        let element =
            Element { kind, rule: kind.default_rule(), thickness, is_plane, rest: &rest, now: &now };
        // Hooke's law with μ = 1, λ = 0
        element.measure(criterion, |F| (*F + F.transpose()).plus_diagonal(-2.0))
    }

    const KINDS: [ElementKind; 4] =
        [ElementKind::Tet4, ElementKind::Hex8, ElementKind::Prism6, ElementKind::Pyramid5];

    /// A stretch by a tenth along all axes changes lengths by a tenth, volumes by 0.331, shapes not at all; rest and rotation
    /// nothing.
    #[test]
    fn stretch_and_rotation() {
        use Criterion::{Length, Shape, Volume};
        let turn = exponential(Vec3::new(0.3, -1.0, 0.5));
        for kind in KINDS {
            // a dozen roundings, magnified by small angles of faces
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
            let stretched = turn * 1.1;
            assert!(near(of(kind, &stretched, Length), 0.1), "{kind}");
            assert!(near(of(kind, &stretched, Volume), 0.331), "{kind}");
            assert!(near(of(kind, &stretched, Shape), 0.0), "{kind}");
            assert!([Length, Volume, Shape].iter().all(|criterion| near(of(kind, &turn, *criterion), 0.0)));
        }
    }

    /// What small strain makes of a turn by `θ`, `u' = tan θ` across, is seen as `tan²θ` of volume: 5° are 0.77 %.
    #[test]
    fn turns_under_small_strain_inflate() {
        let t = 5.0_f64.to_radians().tan();
        let F = Mat3::from_rows([[1.0, -t, 0.0], [t, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        for kind in KINDS {
            assert!((of(kind, &F, Criterion::Volume) - t * t).abs() < 1e-12, "{kind}");
        }
    }

    /// One of an equilateral triangle; of a right angle with legs 3 and 4, circumradius 2.5 over twice the inradius 1.
    #[test]
    fn shape_factors() {
        let height = 0.75_f64.sqrt();
        let equilateral = [Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.5, height, 0.0)];
        assert!((shape_factor(equilateral) - 1.0).abs() < 1e-14);
        let right = [Vec3::ZERO, Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
        assert!((shape_factor(right) - 1.25).abs() < 1e-14);
    }

    /// A uniform stress `P` along x on a unit cube pulls each of its faces with `P/4` at every corner: the field of these
    /// forces goes from `-P/4` to `P/4` along x, and its mean size over eight samples is `P/4 / √3`.
    #[test]
    fn force_of_a_uniform_field() {
        let F = Mat3::from_diagonal(Vec3::new(1.01, 1.0, 1.0));
        let found = of(ElementKind::Hex8, &F, Criterion::Force);
        // P = 2 μ 0.01, and the volume has grown
        let expected = 0.02 / 4.0 / 3.0_f64.sqrt() / 1.01;
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }

    /// A sheet that is stretched by a tenth both ways and turned out of its plane has a fifth more area, and rounder triangles nowhere; pulled
    /// along one side its triangles get longer.
    #[test]
    fn surface_elements() {
        use Criterion::{Length, Shape, Volume};
        let turn = exponential(Vec3::new(0.3, -1.0, 0.5));
        for kind in [ElementKind::Tri3, ElementKind::Quad4, ElementKind::Tri6, ElementKind::Quad9] {
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
            let stretched = turn * 1.1;
            assert!(near(of(kind, &stretched, Length), 0.1), "{kind}");
            assert!(near(of(kind, &stretched, Volume), 0.21), "{kind}");
            assert!(near(of(kind, &stretched, Shape), 0.0), "{kind}");
            assert!([Length, Volume, Shape].iter().all(|criterion| near(of(kind, &turn, *criterion), 0.0)));
            let pulled = Mat3::from_diagonal(Vec3::new(1.5, 1.0, 1.0));
            assert!(near(of(kind, &pulled, Volume), 0.5) && of(kind, &pulled, Shape) > 0.05, "{kind}");
        }
    }

    /// A mirrored element has the area, the edges and the angles of the one at rest; in a plane it is turned inside out, as a mirrored volume is.
    #[test]
    fn inverted_elements_are_over_any_threshold() {
        let mirrored = Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0));
        let surfaces = [ElementKind::Tri3, ElementKind::Quad4, ElementKind::Tri6, ElementKind::Quad9];
        for kind in surfaces.into_iter().chain(KINDS) {
            assert_eq!(of(kind, &mirrored, Criterion::Volume), f64::INFINITY, "{kind}");
            assert!(of(kind, &mirrored, Criterion::Length) < 1e-12, "{kind}");
        }
        // of a sheet in space it is the other side
        let turned_over = Mat3::from_diagonal(Vec3::new(-1.0, 1.0, -1.0));
        for kind in surfaces {
            assert!(of(kind, &turned_over, Criterion::Volume) < 1e-12, "{kind}");
        }
    }
}
