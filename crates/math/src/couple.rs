//! Forces that make a moment and no sum.

use crate::{Mat3, Vec3};

/// The centre `x̄` of points and the rate `ω` with which forces `ω × (x − x̄)` on them have a moment; their sum is nothing.
///
/// Points on a line bear no moment about it: the rate is zero there.
pub fn couple(points: impl Iterator<Item = Vec3> + Clone, moment: Vec3) -> (Vec3, Vec3) {
    let (sum, count) = points.clone().fold((Vec3::ZERO, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    let centre = sum * (1.0 / count);
    // J = Σ |a|² I − a aᵀ
    let spread = points.fold(Mat3::ZERO, |spread, x| {
        let arm = x - centre;
        spread + Mat3::IDENTITY * arm.length_sq() - arm.outer(arm)
    });
    (centre, spread.try_inverse().map_or(Vec3::ZERO, |inverse| inverse * moment))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The forces of a couple add up to nothing and have the moment asked for about any place; on a line there are none.
    #[test]
    fn couples_have_their_moment() {
        let point = |k: i32| f64::from(k);
        let points =
            (0..40).map(point).map(|k| Vec3::new((1.3 * k).sin(), (2.1 * k).cos(), (0.7 * k * k).sin()));
        let moment = Vec3::new(0.3, -1.2, 0.7);
        let (centre, rate) = couple(points.clone(), moment);
        for about in [Vec3::ZERO, Vec3::new(5.0, -2.0, 1.0)] {
            let forces = points.clone().map(|x| (x - about, rate.cross(x - centre)));
            let (sum, made) = forces.fold((Vec3::ZERO, Vec3::ZERO), |(sum, made), (arm, force)| {
                (sum + force, made + arm.cross(force))
            });
            // roundings of forty numbers of order one, with arms of five
            assert!(sum.length() < 1e-13 && (made - moment).length() < 1e-12, "{sum:?} {made:?}");
        }
        assert_eq!(couple((0..5).map(|k| Vec3::X * f64::from(k)), moment).1, Vec3::ZERO);
    }
}
