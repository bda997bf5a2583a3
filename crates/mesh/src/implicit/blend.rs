//! Solids made of few primitives, joined and cut with rounded seams.
//!
//! Values are near the signed distance: exact for spheres, capsules and tori, to first order for ellipsoids (the
//! function over the length of its gradient, Taubin 1991). The smooth minimum of `a` and `b` with radius `k` is
//! `min(a, b) - h² k/4` with `h = max(0, 1 - |a - b|/k)`, once continuously differentiable.

use souple_math::{Mat3, Vec3};

use super::{Shape, around};
use crate::BoundingBox;

/// A tree of primitives.
#[derive(Clone, Debug)]
pub enum Solid {
    /// Semi-axes along the columns of a rotation [m].
    Ellipsoid { centre: Vec3, semi_axes: Vec3, axes: Mat3 },
    /// Ball of a radius that goes linearly from one end to the other, swept along a segment [m].
    Capsule { ends: [Vec3; 2], radii: [f64; 2] },
    /// Ring around an axis through its centre [m].
    Torus { centre: Vec3, axis: Vec3, ring: f64, tube: f64 },
    /// Where `(x - point) · normal < 0`.
    HalfSpace { point: Vec3, normal: Vec3 },
    /// All parts, seams rounded with a radius [m].
    Union { parts: Vec<Solid>, radius: f64 },
    /// The first without the second, the new edge rounded with a radius [m].
    Difference { from: Box<Solid>, cut: Box<Solid>, radius: f64 },
    /// What is in both, the new edge rounded with a radius [m].
    Intersection { first: Box<Solid>, second: Box<Solid>, radius: f64 },
    /// Moved outward by a distance, inward where it is negative [m].
    Offset { solid: Box<Solid>, distance: f64 },
    /// What is not in a solid.
    Complement(Box<Solid>),
}

impl Solid {
    pub fn sphere(centre: Vec3, radius: f64) -> Self {
        Self::Capsule { ends: [centre, centre], radii: [radius, radius] }
    }

    /// Semi-axes along x, y, z.
    pub fn ellipsoid(centre: Vec3, semi_axes: Vec3) -> Self {
        Self::Ellipsoid { centre, semi_axes, axes: Mat3::IDENTITY }
    }

    /// An ellipsoid turned about its centre by an axis times an angle [rad].
    pub fn turned_ellipsoid(centre: Vec3, semi_axes: Vec3, rotation: Vec3) -> Self {
        Self::Ellipsoid { centre, semi_axes, axes: souple_math::exponential(rotation) }
    }

    pub fn capsule(from: Vec3, to: Vec3, radii: [f64; 2]) -> Self {
        Self::Capsule { ends: [from, to], radii }
    }

    #[must_use]
    pub fn without(self, cut: Solid, radius: f64) -> Self {
        Self::Difference { from: Box::new(self), cut: Box::new(cut), radius }
    }

    #[must_use]
    pub fn and(self, other: Solid, radius: f64) -> Self {
        Self::Intersection { first: Box::new(self), second: Box::new(other), radius }
    }

    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let all = |solid: &Self| Box::new(solid.scaled(factor));
        match self {
            Self::Ellipsoid { centre, semi_axes, axes } => {
                Self::Ellipsoid { centre: *centre * factor, semi_axes: *semi_axes * factor, axes: *axes }
            }
            Self::Capsule { ends, radii } => Self::Capsule {
                ends: ends.map(|end| end * factor),
                radii: radii.map(|radius| radius * factor),
            },
            Self::Torus { centre, axis, ring, tube } => Self::Torus {
                centre: *centre * factor,
                axis: *axis,
                ring: ring * factor,
                tube: tube * factor,
            },
            Self::HalfSpace { point, normal } => Self::HalfSpace { point: *point * factor, normal: *normal },
            Self::Union { parts, radius } => Self::Union {
                parts: parts.iter().map(|part| part.scaled(factor)).collect(),
                radius: radius * factor,
            },
            Self::Difference { from, cut, radius } => {
                Self::Difference { from: all(from), cut: all(cut), radius: radius * factor }
            }
            Self::Intersection { first, second, radius } => {
                Self::Intersection { first: all(first), second: all(second), radius: radius * factor }
            }
            Self::Offset { solid, distance } => {
                Self::Offset { solid: all(solid), distance: distance * factor }
            }
            Self::Complement(solid) => Self::Complement(all(solid)),
        }
    }
}

/// `min(a, b)`, rounded where they are closer than `k`.
fn smooth_minimum(a: f64, b: f64, k: f64) -> f64 {
    if k <= 0.0 {
        return a.min(b);
    }
    let h = (1.0 - (a - b).abs() / k).max(0.0);
    a.min(b) - 0.25 * k * h * h
}

fn smooth_maximum(a: f64, b: f64, k: f64) -> f64 {
    -smooth_minimum(-a, -b, k)
}

impl Shape for Solid {
    fn value(&self, point: Vec3) -> f64 {
        match self {
            Self::Ellipsoid { centre, semi_axes, axes } => {
                let local = axes.transpose() * (point - *centre);
                let divided = |p: Vec3| Vec3::new(p.x / semi_axes.x, p.y / semi_axes.y, p.z / semi_axes.z);
                let unit = divided(local);
                let (radius, slope) = (unit.length(), divided(unit).length());
                // |∇r| = |local/semi_axes²| / r; at the centre the shortest semi-axis is the distance
                let shortest = semi_axes.x.min(semi_axes.y).min(semi_axes.z);
                if slope > 0.0 {
                    (radius - 1.0) * (radius / slope).min(semi_axes.largest_component())
                } else {
                    -shortest
                }
            }
            Self::Capsule { ends: [from, to], radii } => {
                let along = *to - *from;
                let length_sq = along.length_sq();
                let t = if length_sq > 0.0 {
                    ((point - *from).dot(along) / length_sq).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                (point - (*from + along * t)).length() - (radii[0] + (radii[1] - radii[0]) * t)
            }
            Self::Torus { centre, axis, ring, tube } => {
                let local = point - *centre;
                let height = local.dot(*axis);
                let across = (local - *axis * height).length() - ring;
                (across * across + height * height).sqrt() - tube
            }
            Self::HalfSpace { point: origin, normal } => (point - *origin).dot(*normal),
            Self::Union { parts, radius } => parts
                .iter()
                .map(|part| part.value(point))
                .reduce(|a, b| smooth_minimum(a, b, *radius))
                .unwrap_or(f64::INFINITY),
            Self::Difference { from, cut, radius } => {
                smooth_maximum(from.value(point), -cut.value(point), *radius)
            }
            Self::Intersection { first, second, radius } => {
                smooth_maximum(first.value(point), second.value(point), *radius)
            }
            Self::Offset { solid, distance } => solid.value(point) - distance,
            Self::Complement(solid) => -solid.value(point),
        }
    }

    fn range(&self, within: BoundingBox) -> Option<[f64; 2]> {
        let (centre, reach) = (within.centre(), 0.5 * within.diagonal());
        Some(match self {
            // (r − 1) s, where s is between the shortest semi-axis and the longest
            Self::Ellipsoid { centre: middle, semi_axes, axes } => {
                let shortest = semi_axes.x.min(semi_axes.y).min(semi_axes.z);
                let longest = semi_axes.largest_component();
                let local = axes.transpose() * (centre - *middle);
                let radius =
                    Vec3::new(local.x / semi_axes.x, local.y / semi_axes.y, local.z / semi_axes.z).length();
                let [near, far] = around(radius, reach / shortest).map(|radius| radius.max(0.0) - 1.0);
                [
                    near * if near < 0.0 { longest } else { shortest },
                    far * if far < 0.0 { shortest } else { longest },
                ]
            }
            // a distance less a radius that changes along the way
            Self::Capsule { ends, radii } => {
                let length = (ends[1] - ends[0]).length();
                let taper = if length > 0.0 { (radii[1] - radii[0]).abs() / length } else { 0.0 };
                around(self.value(centre), reach * (1.0 + taper))
            }
            Self::Torus { .. } | Self::HalfSpace { .. } => around(self.value(centre), reach),
            // rounded minima and maxima grow with each of what they are of
            Self::Union { parts, radius } => {
                let mut all = [f64::INFINITY; 2];
                for part in parts {
                    let own = part.range(within)?;
                    all = [0, 1].map(|end| {
                        if all[end].is_finite() {
                            smooth_minimum(all[end], own[end], *radius)
                        } else {
                            own[end]
                        }
                    });
                }
                all
            }
            Self::Difference { from, cut, radius } => {
                let (from, [low, high]) = (from.range(within)?, cut.range(within)?);
                [smooth_maximum(from[0], -high, *radius), smooth_maximum(from[1], -low, *radius)]
            }
            Self::Intersection { first, second, radius } => {
                let (first, second) = (first.range(within)?, second.range(within)?);
                [0, 1].map(|end| smooth_maximum(first[end], second[end], *radius))
            }
            Self::Offset { solid, distance } => solid.range(within)?.map(|value| value - distance),
            Self::Complement(solid) => {
                let [low, high] = solid.range(within)?;
                [-high, -low]
            }
        })
    }

    fn bounds(&self) -> BoundingBox {
        let everything = BoundingBox {
            low: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
            high: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        };
        match self {
            Self::Ellipsoid { centre, semi_axes, axes } => {
                // the extent along an axis is the length of that row of axes times semi-axes
                let extent = |row: usize| {
                    let row = axes.transpose() * Vec3::AXES[row];
                    Vec3::new(row.x * semi_axes.x, row.y * semi_axes.y, row.z * semi_axes.z).length()
                };
                let half = Vec3::new(extent(0), extent(1), extent(2));
                BoundingBox { low: *centre - half, high: *centre + half }
            }
            Self::Capsule { ends, radii } => {
                let ball = |end: usize| BoundingBox::of([ends[end]]).grown(radii[end].max(0.0));
                ball(0).union(ball(1))
            }
            Self::Torus { centre, axis, ring, tube } => {
                let extent = |a: f64| ring * (1.0 - a * a).max(0.0).sqrt() + tube;
                let half = Vec3::from_array(axis.to_array().map(extent));
                BoundingBox { low: *centre - half, high: *centre + half }
            }
            Self::HalfSpace { .. } | Self::Complement(_) => everything,
            // a seam bulges by a quarter of its radius for each part that joins
            Self::Union { parts, radius } => parts
                .iter()
                .map(Shape::bounds)
                .fold(BoundingBox::EMPTY, BoundingBox::union)
                .grown(0.25 * radius * parts.len().saturating_sub(1) as f64),
            Self::Difference { from, .. } => from.bounds(),
            Self::Intersection { first, second, .. } => {
                let (a, b) = (first.bounds(), second.bounds());
                BoundingBox { low: a.low.max_components(b.low), high: a.high.min_components(b.high) }
            }
            Self::Offset { solid, distance } => solid.bounds().grown(*distance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values are distances for spheres, capsules and tori, and to first order for ellipsoids.
    #[test]
    fn values_are_distances() {
        let capsule = Solid::capsule(Vec3::ZERO, Vec3::X, [0.2, 0.2]);
        assert!((capsule.value(Vec3::new(0.5, 0.5, 0.0)) - 0.3).abs() < 1e-15);
        assert!((capsule.value(Vec3::new(1.4, 0.3, 0.0)) - 0.3).abs() < 1e-15);
        let torus = Solid::Torus { centre: Vec3::ZERO, axis: Vec3::Z, ring: 1.0, tube: 0.25 };
        assert!((torus.value(Vec3::new(0.0, 1.0, 0.5)) - 0.25).abs() < 1e-15);
        let ellipsoid = Solid::ellipsoid(Vec3::ZERO, Vec3::new(3.0, 2.0, 1.0));
        for step in [1e-3, 1e-4] {
            // the error falls with the square of the distance; curvatures here are at most 3
            let value = ellipsoid.value(Vec3::new(3.0 + step, 0.0, 0.0));
            assert!((value - step).abs() < 3.0 * step * step, "{value}");
        }
        assert_eq!(ellipsoid.value(Vec3::ZERO), -1.0);
    }

    /// A rounded seam fills at most a quarter of its radius, and only near it.
    #[test]
    fn seams() {
        assert_eq!(smooth_minimum(1.0, 1.0, 0.4), 0.9);
        assert_eq!(smooth_minimum(1.0, 1.5, 0.4), 1.0);
        assert_eq!(smooth_minimum(1.0, 1.0, 0.0), 1.0);
        assert_eq!(smooth_maximum(1.0, 1.0, 0.4), 1.1);
    }

    /// Within boxes of any size and place values lie in the range that is told.
    #[test]
    fn values_are_in_their_range() {
        let torus = Solid::Torus { centre: Vec3::ZERO, axis: Vec3::Z, ring: 1.0, tube: 0.25 };
        let tilted = Solid::turned_ellipsoid(Vec3::X, Vec3::new(0.9, 0.4, 0.2), Vec3::new(0.3, 0.5, -0.7));
        let capsule = Solid::capsule(Vec3::ZERO, Vec3::new(0.4, 0.1, 0.3), [0.4, 0.2]);
        let parts = vec![torus, capsule, Solid::Offset { solid: Box::new(tilted), distance: 0.05 }];
        let solid = Solid::Union { parts, radius: 0.2 }.without(Solid::sphere(Vec3::Y * 0.8, 0.5), 0.1);
        let cut = Solid::Complement(Box::new(Solid::HalfSpace { point: Vec3::Z * -0.1, normal: Vec3::Z }));
        let solid = solid.and(cut, 0.05);
        let at = |i: usize, n: usize| Vec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
        for index in 0..6_usize.pow(3) {
            for size in [0.01, 0.3, 1.1] {
                let low = at(index, 6) * 0.6 - Vec3::new(1.8, 1.7, 1.6);
                let within = BoundingBox { low, high: low + Vec3::new(1.0, 0.7, 1.3) * size };
                let [least, most] = solid.range(within).unwrap();
                for place in 0..5_usize.pow(3) {
                    let share = at(place, 5) * 0.25;
                    let p = low + Vec3::new(share.x, 0.7 * share.y, 1.3 * share.z) * size;
                    let value = solid.value(p);
                    // roundings of numbers of order one
                    assert!(
                        least - 1e-14 <= value && value <= most + 1e-14,
                        "{p:?}: {value} of {least} to {most}"
                    );
                }
            }
        }
    }

    /// Nothing inside is beyond the bounds, and scaling scales values.
    #[test]
    fn bounds_hold_everything() {
        let tilted = Solid::turned_ellipsoid(Vec3::X, Vec3::new(0.5, 0.2, 0.1), Vec3::new(0.3, 0.5, -0.7));
        let torus =
            Solid::Torus { centre: Vec3::ZERO, axis: Vec3::new(1.0, 2.0, 2.0) / 3.0, ring: 1.0, tube: 0.25 };
        let solid = Solid::Union { parts: vec![tilted, torus], radius: 0.2 };
        let bounds = solid.bounds();
        let at = |i: usize| -2.0 + 0.11 * i as f64;
        for index in 0..37_usize.pow(3) {
            let p = Vec3::new(at(index % 37), at(index / 37 % 37), at(index / 37 / 37));
            assert!(solid.value(p) > 0.0 || bounds.contains(p), "{p:?}");
            let scaled = solid.scaled(0.5).value(p * 0.5);
            assert!((scaled - 0.5 * solid.value(p)).abs() < 1e-14);
        }
    }
}
