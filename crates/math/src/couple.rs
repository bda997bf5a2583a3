//! Forces that make a moment and no sum.

use crate::{Mat3, Vec3, eigen_symmetric};

/// Arms about an axis, as a share of the extent of all points, below which the moment about it is let go: there the forces
/// would be more than twenty times those of as great a moment across.
const LEAST_ARM: f64 = 0.05;

/// The centre `x̄` of points and the rate `ω` with which forces `ω × (x − x̄)` on them have a moment; their sum is nothing.
///
/// Points near a line bear little of a moment about it, and on the line none: that part is left out, the part across the
/// line is kept. Points in one place bear none.
pub fn couple(points: impl Iterator<Item = Vec3> + Clone, moment: Vec3) -> (Vec3, Vec3) {
    let (sum, count) = points.clone().fold((Vec3::ZERO, 0.0_f64), |(sum, count), x| (sum + x, count + 1.0));
    let centre = sum * (1.0 / count.max(1.0));
    // J = Σ |a|² I − a aᵀ
    let (spread, extent) = points.fold((Mat3::ZERO, 0.0), |(spread, extent), x| {
        let arm = x - centre;
        (spread + Mat3::IDENTITY * arm.length_sq() - arm.outer(arm), extent + arm.length_sq())
    });
    // a sum is known to a rounding for each of its terms: arms as short are none
    let rounding = count * f64::EPSILON * centre.length();
    if extent <= count * rounding * rounding {
        return (centre, Vec3::ZERO);
    }
    // below the least that is borne 1/J goes back to zero, so that points that come to a line feel no blow
    let least = LEAST_ARM * LEAST_ARM * extent;
    let inverse =
        |inertia: f64| if inertia > least { 1.0 / inertia } else { inertia.max(0.0) / (least * least) };
    // ω = J⁺ M
    let axes = eigen_symmetric(&spread);
    let parts = axes.vectors.columns.iter().zip(axes.values.to_array());
    let rate = parts.map(|(axis, inertia)| *axis * (inverse(inertia) * axis.dot(moment))).sum();
    (centre, rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOMENT: Vec3 = Vec3::new(0.3, -1.2, 0.7);

    /// The sum of a couple's forces, their moment about a place, and the greatest of them.
    fn made(points: &[Vec3], about: Vec3) -> (Vec3, Vec3, f64) {
        let (centre, rate) = couple(points.iter().copied(), MOMENT);
        let forces = points.iter().map(|x| (*x - about, rate.cross(*x - centre)));
        forces.fold((Vec3::ZERO, Vec3::ZERO, 0.0), |(sum, moment, most), (arm, force)| {
            (sum + force, moment + arm.cross(force), most.max(force.length()))
        })
    }

    /// The forces of a couple add up to nothing and have the moment asked for about any place.
    #[test]
    fn couples_have_their_moment() {
        let place = |k: f64| Vec3::new((1.3 * k).sin(), (2.1 * k).cos(), (0.7 * k * k).sin());
        let points: Vec<Vec3> = (0..40).map(|k| place(k.into())).collect();
        for about in [Vec3::ZERO, Vec3::new(5.0, -2.0, 1.0)] {
            let (sum, moment, _) = made(&points, about);
            // roundings of forty numbers of order one, with arms of five
            assert!(sum.length() < 1e-13 && (moment - MOMENT).length() < 1e-12, "{sum:?} {moment:?}");
        }
    }

    /// Of points on a line, along an axis or not, two or many, the moment across it is kept and that about it left out.
    #[test]
    fn points_on_a_line_bear_what_is_across_it() {
        for line in [Vec3::X, Vec3::new(1.0, 2.0, -3.0), Vec3::new(0.1, 0.7, 0.3)] {
            let axis = line / line.length();
            let across = MOMENT - axis * axis.dot(MOMENT);
            for count in [2, 3, 7] {
                let points: Vec<Vec3> =
                    (0..count).map(|k| Vec3::new(0.3, 0.1, -0.2) + line * f64::from(k)).collect();
                let (sum, moment, most) = made(&points, Vec3::ZERO);
                assert!(sum.length() < 1e-14 && (moment - across).length() < 1e-13, "{sum:?} {moment:?}");
                // |a| M/Σa², of which the longest arm is one of two or more
                let half = 0.5 * f64::from(count - 1) * line.length();
                assert!(most <= 1.001 * MOMENT.length() / (2.0 * half), "{most}");
            }
        }
    }

    /// However near to a line points are, the forces stay below those of arms of the least length, and what is across stays.
    #[test]
    fn points_near_a_line_bear_no_more_than_they_can() {
        let (axis, side) =
            (Vec3::new(1.0, 1.0, 1.0) / 3.0_f64.sqrt(), Vec3::new(1.0, -1.0, 0.0) / 2.0_f64.sqrt());
        for off in [1e-16, 1e-12, 1e-6, 1e-3, 0.03, 0.1, 0.3] {
            let place = |k: i32| axis * f64::from(k) + side * if k % 2 == 0 { off } else { -off };
            let points: Vec<Vec3> = (-3..=3).map(place).collect();
            let (sum, moment, most) = made(&points, Vec3::ZERO);
            let extent: f64 = points.iter().map(|p| p.length_sq()).sum::<f64>().sqrt();
            assert!(sum.length() < 1e-13, "{off}: {sum:?}");
            // forces as great as Σ f² = ω J ω allows, with the least J
            assert!(most < MOMENT.length() / (LEAST_ARM * extent), "{off}: {most}");
            // the part about the line that is made is between none and all of it; the axes of what bears turn by `off`
            let missing = MOMENT - moment;
            let about = missing.dot(axis) / MOMENT.dot(axis);
            assert!((-1e-12..1.0 + 1e-12).contains(&about), "{off}: {about}");
            assert!((missing - axis * missing.dot(axis)).length() < off + 1e-12, "{off}: {missing:?}");
        }
    }

    /// Points in one place bear nothing, also where their centre is rounded.
    #[test]
    fn points_in_one_place_bear_nothing() {
        for count in [0, 1, 2, 3, 7] {
            let points = vec![Vec3::new(0.1, 0.7, 1e3); count];
            assert_eq!(couple(points.into_iter(), MOMENT).1, Vec3::ZERO);
        }
    }
}
