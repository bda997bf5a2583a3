//! Points that go over the middle of what they touch: a penalty pushes them out on the other side.

use souple_math::Vec3;

use super::Shape;

/// A way of a point over the middle of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// How thick the wall is there, across [m].
    pub width: f64,
    /// Unit normal of the side that it came from.
    pub normal: Vec3,
}

/// Halvings of a way to where its nearest side is another.
const HALVINGS: usize = 40;
/// Steps of the walk out of a wall, each as long as it surely stays inside.
const STEPS: usize = 64;

/// Whether a point that went straight `from` a place of the shape `to` another [m] came nearer to the opposite side within it, or out there.
///
/// Two things with room between them are not passed: there the nearest side changes outside.
pub fn passage(shape: &dyn Shape, from: Vec3, to: Vec3) -> Option<Passage> {
    // what comes out of a wall in one go is no farther from it than it went; within, distances are negative
    let reach = (to - from).length();
    let end = shape.nearest(to, reach)?;
    let start = shape.nearest(from, reach)?;
    // in a hollow crease two sides push towards each other, and what is thrown from one to the other goes over no middle
    let is_over = start.normal.dot(to - from) < 0.0 && end.normal.dot(to - from) > 0.0;
    if !is_over || start.normal.dot(end.normal) >= 0.0 {
        return None;
    }
    let (mut near, mut far) = (from, to);
    for _ in 0..HALVINGS {
        let middle = (near + far) * 0.5;
        let is_before = shape.nearest(middle, f64::INFINITY)?.normal.dot(start.normal) > 0.0;
        *(if is_before { &mut near } else { &mut far }) = middle;
    }
    let inside = shape.nearest(near, f64::INFINITY)?.distance;
    let width = depth(shape, near, start.normal)? + depth(shape, near, -start.normal)?;
    (inside < 0.0).then_some(Passage { width, normal: start.normal })
}

/// How far it is out of the shape along a direction [m]; `None` where it has no end.
fn depth(shape: &dyn Shape, from: Vec3, direction: Vec3) -> Option<f64> {
    let mut walked = 0.0;
    for _ in 0..STEPS {
        let distance = shape.nearest(from + direction * walked, f64::INFINITY)?.distance;
        walked -= distance.min(0.0);
        if distance >= -1e-6 * walked {
            return Some(walked);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use souple_math::Mat3;

    use super::*;
    use souple_mesh::TriangleSurface;

    use crate::contact::shape::{ClosedSurface, Cuboid, Plane, Sphere};

    fn at(x: f64) -> Vec3 {
        Vec3::new(x, 0.1, -0.2)
    }

    /// A wall of 0.1 m about x = 1 is passed where its middle is, in one way through it and by ways within it; no way that turns back is one.
    #[test]
    fn walls_are_passed_over_their_middle() {
        let size = Vec3::new(0.05, 0.5, 0.5);
        let wall = Cuboid { centre: Vec3::X, half_size: size, axes: Mat3::IDENTITY };
        for (from, to) in [(0.8, 1.2), (0.94, 1.01), (0.99, 1.001), (0.999, 1.06), (-3.0, 7.0)] {
            let found = passage(&wall, at(from), at(to)).expect("a way through");
            assert!((found.width - 0.1).abs() < 1e-9, "{from} to {to}: {}", found.width);
            assert_eq!(found.normal, -Vec3::X);
            assert_eq!(passage(&wall, at(to), at(from)).map(|found| found.normal), Some(Vec3::X));
        }
        for (from, to) in [(0.8, 0.9), (0.9, 0.99), (0.99, 0.96), (1.01, 1.2), (1.2, 1.3), (1.0, 1.0)] {
            assert_eq!(passage(&wall, at(from), at(to)), None, "{from} to {to}");
        }
        // past it
        assert_eq!(passage(&wall, Vec3::new(0.8, 0.6, 0.0), Vec3::new(1.2, 0.6, 0.0)), None);
    }

    /// In a groove a mass that is thrown from one side to the other goes over no middle: the nearest side is another there, and pushes back.
    #[test]
    fn grooves_throw_back() {
        // a block with a groove along y, whose bottom is at z = -0.45, and which reaches down to -1
        let section = [(0.0, -0.45), (-1.0, 0.5), (-1.0, -1.0), (1.0, -1.0), (1.0, 0.5)];
        let points = [-1.0, 1.0].into_iter().flat_map(|y| section.map(|(x, z)| Vec3::new(x, y, z))).collect();
        let sides = (0..5_u32).flat_map(|at| {
            let next = (at + 1) % 5;
            [[at, next, next + 5], [at, next + 5, at + 5]]
        });
        let caps = (1..4_u32).flat_map(|at| [[0, at + 1, at], [5, at + 5, at + 6]]);
        let triangles = sides.chain(caps).collect();
        let surface = TriangleSurface { points, triangles, mesh_points: Vec::new(), cells: Vec::new() };
        let block = ClosedSurface::new(surface).unwrap();
        assert!(block.nearest(Vec3::Z * -0.9, 1.0).unwrap().distance < -0.09);
        let (left, right) = (Vec3::new(-0.1, 0.0, -0.5), Vec3::new(0.1, 0.0, -0.5));
        let normal = |place: Vec3| block.nearest(place, f64::INFINITY).unwrap().normal;
        assert!(normal(left).dot(normal(right)) < 0.1, "{:?} {:?}", normal(left), normal(right));
        assert_eq!(passage(&block, left, right), None);
        assert_eq!(passage(&block, right, left), None);
    }

    /// A ball is as thick as it is across the side that the point came from; what has no other side is not passed.
    #[test]
    fn balls_are_passed_and_grounds_are_not() {
        let ball = Sphere::new(Vec3::X, 0.3);
        let found = passage(&ball, Vec3::new(0.5, 0.0, 0.0), Vec3::new(1.5, 0.0, 0.0)).unwrap();
        assert!((found.width - 0.6).abs() < 1e-6, "{}", found.width);
        let ground = Plane { point: Vec3::ZERO, normal: Vec3::Z };
        assert_eq!(passage(&ground, Vec3::Z, -Vec3::Z), None);
    }
}
