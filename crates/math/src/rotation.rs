//! Rotations: the exponential map, its inverse, and the repair of rounding.

use crate::{Mat3, Vec3};

/// `exp([θ]×)`: the rotation by `|θ|` radians about `θ` (Rodrigues).
pub fn exponential(theta: Vec3) -> Mat3 {
    let angle_sq = theta.length_sq();
    // sin(a)/a and (1 - cos a)/a²; the series is exact to rounding below the switch (error a⁶/5040)
    let (a, b) = if angle_sq < 1e-5 {
        (1.0 - angle_sq / 6.0 * (1.0 - angle_sq / 20.0), 0.5 - angle_sq / 24.0 * (1.0 - angle_sq / 30.0))
    } else {
        let angle = angle_sq.sqrt();
        (libm::sin(angle) / angle, (1.0 - libm::cos(angle)) / angle_sq)
    };
    let skew = theta.cross_matrix();
    Mat3::IDENTITY + skew * a + (skew * skew) * b
}

/// The rotation vector `θ`, `|θ| ≤ π`, with `exp([θ]×) = R`.
pub fn logarithm(rotation: &Mat3) -> Vec3 {
    let axial = rotation.axial_vector(); // sin(a) n
    let sine = axial.length();
    let cosine = 0.5 * (rotation.trace() - 1.0);
    let angle = libm::atan2(sine, cosine);
    if sine > 1e-6 {
        return axial * (angle / sine);
    }
    if cosine > 0.0 {
        return axial;
    }
    // close to π the axial part vanishes: R ≈ 2 n nᵀ - I, so the largest column of R + I points along n
    let doubled = rotation.symmetric_part().plus_diagonal(1.0);
    let largest = doubled.columns.into_iter().max_by(|a, b| a.length_sq().total_cmp(&b.length_sq()));
    let axis = largest.and_then(Vec3::try_normalised).unwrap_or(Vec3::X);
    let signed = if axis.dot(axial) < 0.0 { -axis } else { axis };
    signed * angle
}

/// The nearest rotation to a matrix that is one but for rounding: one step of Newton's iteration for
/// the polar decomposition, `R (3 I - Rᵀ R) / 2`, exact to second order in the error.
pub fn orthonormalised(rotation: &Mat3) -> Mat3 {
    let gram = rotation.transpose_mul(rotation);
    *rotation * (gram * -0.5).plus_diagonal(1.5)
}

/// A component below this part of a direction is rounding.
const NOTHING: f64 = 1e-9;

/// The rotation whose first axis is along `x` and whose second one lies on the side of `y`, any across `x` where that has no part
/// there; `None` where `x` has no direction.
pub fn axes_along(x: Vec3, y: Vec3) -> Option<Mat3> {
    let first = x.try_normalised()?;
    let across = y - first * first.dot(y);
    let has_part = across.length() > NOTHING * y.length();
    let second = if has_part { across.try_normalised()? } else { first.any_orthogonal() };
    Some(Mat3::from_columns(first, second, first.cross(second)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Axes are a rotation, along the one and on the side of the other; without a side any.
    #[test]
    fn axes_are_a_rotation() {
        let (x, y) = (Vec3::new(0.3, -2.0, 0.7), Vec3::new(1.0, 1.0, 1.0));
        for side in [y, Vec3::ZERO, x * -2.0] {
            let axes = axes_along(x, side).unwrap();
            assert!((axes.transpose_mul(&axes) - Mat3::IDENTITY).largest_entry() < 1e-15);
            assert!((axes.determinant() - 1.0).abs() < 1e-15);
            assert!((axes.columns[0] * x.length() - x).length() < 1e-15);
        }
        let axes = axes_along(x, y).unwrap();
        assert!(axes.columns[1].dot(y) > 0.0 && axes.columns[2].dot(y).abs() < 1e-15);
        assert_eq!(axes_along(Vec3::ZERO, y), None);
        assert_eq!(axes_along(Vec3::new(f64::NAN, 0.0, 0.0), y), None);
    }

    /// `log(exp(θ)) = θ` for every angle below π, small ones and almost π included.
    #[test]
    fn logarithm_inverts_exponential() {
        let direction = Vec3::new(0.36, -0.48, 0.8);
        for angle in [0.0, 1e-12, 1e-7, 1e-3, 0.5, 2.0, 3.0, 3.13, std::f64::consts::PI - 1e-9] {
            let theta = direction * angle;
            let back = logarithm(&exponential(theta));
            // near π the angle is carried by a sine of size π - a: half the digits are left in the axis
            let tolerance = if angle > 3.1 { 1e-7 } else { 4e-15 * (1.0 + angle) };
            assert!((back - theta).length() <= tolerance, "{angle}: {back:?} for {theta:?}");
        }
    }

    /// Ten thousand increments leave an orthonormal matrix.
    #[test]
    fn increments_stay_rotations() {
        let mut rotation = Mat3::IDENTITY;
        for i in 0..10_000 {
            let theta = Vec3::new(0.01, 0.02 * (i % 7) as f64, -0.03);
            rotation = orthonormalised(&(exponential(theta) * rotation));
        }
        let error = rotation.transpose_mul(&rotation) - Mat3::IDENTITY;
        assert!(error.largest_entry() < 1e-15 * 8.0);
    }
}
