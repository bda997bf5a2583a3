//! How well shaped the triangles of a surface are.

use std::f64::consts::PI;

use crate::TriangleSurface;
use crate::surface::corner_angles;

/// Shape of one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleQuality {
    /// [m²]
    pub area: f64,
    /// Least angle [rad]: π/3 at best, 0 for a flat triangle.
    pub smallest_angle: f64,
    /// Greatest angle [rad].
    pub largest_angle: f64,
    /// `4 √3 A / Σ l²` with the area and the lengths of the sides: 1 for the regular triangle, 0 for a flat one.
    pub shape: f64,
}

impl TriangleSurface {
    /// Shapes of all triangles, in their order. One squeezed to a point has no angles: they count as flat.
    pub fn quality(&self) -> Vec<TriangleQuality> {
        (0..self.triangles.len() as u32)
            .map(|triangle| {
                let [a, b, c] = self.corners(triangle);
                let area = self.area_vector(triangle).length();
                let sides = (b - a).length_sq() + (c - b).length_sq() + (a - c).length_sq();
                if area == 0.0 {
                    return TriangleQuality { area, smallest_angle: 0.0, largest_angle: PI, shape: 0.0 };
                }
                let angles = corner_angles([a, b, c]);
                TriangleQuality {
                    area,
                    smallest_angle: angles.into_iter().fold(PI, f64::min),
                    largest_angle: angles.into_iter().fold(0.0, f64::max),
                    shape: 4.0 * 3.0_f64.sqrt() * area / sides,
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use souple_math::Vec3;

    /// The regular triangle is 1, the right isosceles one √3/2, a flat one 0.
    #[test]
    fn known_triangles() {
        let height = 0.75_f64.sqrt();
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, height, 0.0), Vec3::Y, Vec3::X * 2.0];
        let surface = TriangleSurface::new(points, vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]]).unwrap();
        let quality = surface.quality();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-15;
        assert!(close(quality[0].shape, 1.0) && close(quality[0].smallest_angle, PI / 3.0));
        assert!(close(quality[1].shape, height) && close(quality[1].largest_angle, PI / 2.0));
        assert!(close(quality[1].area, 0.5));
        assert_eq!((quality[2].shape, quality[2].smallest_angle), (0.0, 0.0));
    }
}
