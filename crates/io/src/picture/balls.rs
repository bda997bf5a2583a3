//! Points with a size as balls: grains, masses that keep others off. They are drawn as the spheres that they are, sample by
//! sample, so that few are round however large they stand in a picture, and a million take no more than their places.

use souple_math::Vec3;

use super::mesh_surface::Cut;
use super::surface::Surface;

/// A ball of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// [m]
    pub centre: Vec3,
    /// [m]
    pub radius: f64,
}

impl Ball {
    pub(super) fn is_finite(&self) -> bool {
        self.centre.is_finite() && self.radius.is_finite()
    }

    /// The outermost places along three axes of unit length [m].
    pub(super) fn extremes(&self, axes: [Vec3; 3]) -> impl Iterator<Item = Vec3> + use<> {
        let Self { centre, radius } = *self;
        axes.into_iter().flat_map(move |axis| [centre - axis * radius, centre + axis * radius])
    }

    /// Where a ray from `eye` meets it first, in lengths of the ray, and the unit normal there.
    pub(super) fn met_by(&self, eye: Vec3, ray: Vec3) -> Option<(f64, Vec3)> {
        let to = self.centre - eye;
        let square = ray.length_sq();
        // where the ray is nearest to the centre: differences of large squares would leave little of a far, small ball
        let nearest = ray.dot(to) / square;
        let off = ray * nearest - to;
        let half = self.radius * self.radius - off.length_sq();
        if half.is_nan() || half < 0.0 {
            return None;
        }
        let along = nearest - (half / square).sqrt();
        let normal = (ray * along - to).try_normalised()?;
        Some((along, normal))
    }
}

impl Surface {
    /// A ball about each point with a radius above zero [m], and the numbers of these points; of a cut, those whose middle it
    /// leaves.
    pub fn of_balls(positions: &[Vec3], radii: &[f64], cut: Option<Cut>) -> (Self, Vec<u32>) {
        let is_left = |x: Vec3| cut.is_none_or(|cut| (x - cut.point).dot(cut.normal) <= 0.0);
        let is_drawn = |point: &u32| radii[*point as usize] > 0.0 && is_left(positions[*point as usize]);
        let from: Vec<u32> = (0..positions.len() as u32).filter(is_drawn).collect();
        let ball = |point: &u32| Ball { centre: positions[*point as usize], radius: radii[*point as usize] };
        (Self { balls: from.iter().map(ball).collect(), ..Self::default() }, from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ray meets a ball on its sphere, from the side it comes from, and passes one beside it; far away too.
    #[test]
    fn rays_meet_balls() {
        for far in [5.0, 1e4] {
            let ball = Ball { centre: Vec3::new(0.0, 0.0, far), radius: 0.5 };
            let at = |x: f64| ball.met_by(Vec3::ZERO, Vec3::new(x / far, 0.0, 1.0));
            let (along, normal) = at(0.0).expect("straight ahead");
            // rounding of lengths of that size
            assert!(
                (along - (far - 0.5)).abs() < 4.0 * f64::EPSILON * far && (normal + Vec3::Z).length() < 1e-11
            );
            let (along, normal) = at(0.3).expect("within the radius");
            let place = Vec3::new(0.3 / far, 0.0, 1.0) * along;
            assert!(((place - ball.centre).length() - 0.5).abs() < 1e-11 && normal.z < 0.0);
            assert!(at(0.51).is_none());
        }
        assert!(Ball { centre: Vec3::X * f64::NAN, radius: 1.0 }.met_by(Vec3::ZERO, Vec3::Z).is_none());
    }

    #[test]
    fn balls_stand_where_points_are() {
        let positions = [Vec3::ZERO, Vec3::X * 5.0, Vec3::X * 9.0];
        let (of, from) = Surface::of_balls(&positions, &[1.0, 0.0, 0.5], None);
        assert_eq!(from, [0, 2]);
        assert_eq!(of.balls, [(0, 1.0), (2, 0.5)].map(|(i, radius)| Ball { centre: positions[i], radius }));
        let cut = Cut { point: Vec3::X * 3.0, normal: Vec3::X };
        let (left, from) = Surface::of_balls(&positions, &[1.0, 1.0, 1.0], Some(cut));
        assert_eq!((left.balls.len(), from), (1, vec![0]));
    }
}
