//! Solids of one surface joined: what is in any of its parts.
//!
//! Normals tell the inside of each part by itself; where parts overlap, what lies in several would count as outside beside
//! a wall of one in another, and distances would be those to walls that are inside. Joined, the distance is the least of all.

use souple_math::Vec3;

use super::{Shape, around};
use crate::repair::{components, crossings};
use crate::{BoundingBox, MeshError, SignedDistance, TriangleSurface};

/// The least of the signed distances to closed surfaces that may overlap; hollows belong to the part around them.
///
/// Parts that touch in a face and do not overlap keep a wall of zeros between them.
pub struct JoinedSolids {
    parts: Vec<Joined>,
    /// Of each triangle.
    part_of: Vec<u32>,
}

struct Joined {
    distance: SignedDistance,
    /// Points of the whole surface.
    points: Vec<u32>,
    /// Where they are, while they are moved.
    positions: Vec<Vec3>,
    bounds: BoundingBox,
}

const EVERYWHERE: BoundingBox = BoundingBox { low: BoundingBox::EMPTY.high, high: BoundingBox::EMPTY.low };

impl JoinedSolids {
    /// # Errors
    /// A part is not closed, or has a triangle without area; a part that faces inward crosses another, or itself.
    pub fn new(surface: &TriangleSurface) -> Result<Self, MeshError> {
        let (shell_of, count) = components(surface);
        let mut triangles: Vec<Vec<[u32; 3]>> = vec![Vec::new(); count];
        for (corners, shell) in surface.triangles.iter().zip(&shell_of) {
            triangles[*shell as usize].push(*corners);
        }
        let shells = triangles.iter().map(|triangles| Joined::new(surface, triangles));
        let shells: Vec<(Joined, f64)> = shells.collect::<Result<_, _>>()?;
        // a surface that faces inward as a whole is inside out
        let sense = shells.iter().map(|(_, volume)| volume).sum::<f64>().signum();
        let outward = |shell: usize| shells[shell].1 * sense > 0.0;
        let crosses_hollow =
            |pair: &[u32; 2]| pair.iter().any(|triangle| !outward(shell_of[*triangle as usize] as usize));
        // of a hollow that crosses something some points are in it and some are not
        if !(0..count).all(outward)
            && let Some(crossing) = crossings(surface, usize::MAX).pairs.into_iter().find(crosses_hollow)
        {
            return Err(MeshError::CrossedHollow { crossing });
        }
        let mut holders: Vec<Vec<usize>> = Vec::new();
        holders.extend((0..count).filter(|shell| outward(*shell)).map(|shell| vec![shell]));
        for hollow in (0..count).filter(|shell| !outward(*shell)) {
            let place = shells[hollow].0.positions[0];
            let holds = |holder: &&mut Vec<usize>| shells[holder[0]].0.distance.distance(place) < 0.0;
            let size = |holder: &&mut Vec<usize>| shells[holder[0]].1.abs();
            let around = holders.iter_mut().filter(holds).min_by(|a, b| size(a).total_cmp(&size(b)));
            match around {
                Some(holder) => holder.push(hollow),
                // nothing is around it: it is inside out by itself
                None => holders.push(vec![hollow]),
            }
        }
        let mut holder_of = vec![0; count];
        for (holder, shells) in holders.iter().enumerate() {
            shells.iter().for_each(|shell| holder_of[*shell] = holder as u32);
        }
        let mut shells: Vec<Option<Joined>> = shells.into_iter().map(|(shell, _)| Some(shell)).collect();
        let joined = |held: &Vec<usize>| match (&held[..], shells[held[0]].take()) {
            ([_], Some(alone)) => Ok(alone),
            _ => {
                let own: Vec<[u32; 3]> = held.iter().flat_map(|shell| triangles[*shell].clone()).collect();
                Ok(Joined::new(surface, &own)?.0)
            }
        };
        let parts = holders.iter().map(joined).collect::<Result<_, MeshError>>()?;
        let part_of = shell_of.iter().map(|shell| holder_of[*shell as usize]).collect();
        Ok(Self { parts, part_of })
    }

    /// Whether triangles of the surface that pass through each other are of different solids, as far as that could be looked at: of
    /// one that crosses itself normals do not tell the inside.
    pub fn separates(&self, surface: &TriangleSurface) -> bool {
        let found = crossings(surface, usize::MAX);
        let is_between = |[a, b]: &[u32; 2]| self.part_of[*a as usize] != self.part_of[*b as usize];
        !found.is_cut_off && found.pairs.iter().all(is_between)
    }

    /// How many solids are joined.
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// New positions of the points of the same surface; no allocation.
    pub fn move_points(&mut self, positions: &[Vec3]) {
        for Joined { distance, points, positions: own, bounds } in &mut self.parts {
            own.iter_mut().zip(points).for_each(|(own, point)| *own = positions[*point as usize]);
            distance.move_points(own);
            // what is nowhere is looked at from everywhere, and told to be so
            let is_known = own.iter().all(|point| point.is_finite());
            *bounds = if is_known { BoundingBox::of(own.iter().copied()) } else { EVERYWHERE };
        }
    }

    /// Negative inside [m]; NaN where there is no closest point. Outside it is exact; inside it is the depth in one of the parts,
    /// which falls short of that in all of them where the nearest wall is within another part.
    pub fn distance(&self, point: Vec3) -> f64 {
        let mut least = f64::INFINITY;
        for part in &self.parts {
            // outside of its box a part is at least as far as the box
            let farther_sq = part.bounds.distance_sq(point);
            if farther_sq > 0.0 && farther_sq.sqrt() > least {
                continue;
            }
            let distance = part.distance.distance(point);
            if distance.is_nan() {
                return f64::NAN;
            }
            least = least.min(distance);
        }
        least
    }
}

impl Joined {
    /// Some triangles of a surface, and the volume that they enclose.
    fn new(surface: &TriangleSurface, triangles: &[[u32; 3]]) -> Result<(Self, f64), MeshError> {
        let mut points: Vec<u32> = triangles.as_flattened().to_vec();
        points.sort_unstable();
        points.dedup();
        let number = |point: &u32| points.partition_point(|other| other < point) as u32;
        let triangles = triangles.iter().map(|corners| corners.each_ref().map(number)).collect();
        let positions: Vec<Vec3> = points.iter().map(|point| surface.points[*point as usize]).collect();
        let own = TriangleSurface { points: positions.clone(), triangles, ..TriangleSurface::default() };
        let (volume, bounds) = (own.enclosed_volume(), own.bounds());
        Ok((Self { distance: SignedDistance::new(own)?, points, positions, bounds }, volume))
    }
}

impl Shape for JoinedSolids {
    fn value(&self, point: Vec3) -> f64 {
        self.distance(point)
    }

    fn range(&self, within: BoundingBox) -> Option<[f64; 2]> {
        Some(around(self.distance(within.centre()), 0.5 * within.diagonal()))
    }

    fn bounds(&self) -> BoundingBox {
        let bounds = self.parts.iter().map(|part| part.bounds);
        bounds.fold(BoundingBox::EMPTY, BoundingBox::union)
    }
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    /// Balls of 8 cubes across, by centre and radius; a radius below zero makes a hollow.
    fn balls(of: &[(f64, f64)]) -> TriangleSurface {
        let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(8));
        let ball = crate::generate("sphere", values).unwrap().boundary_surface();
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for (centre, radius) in of {
            let first = points.len() as u32;
            points.extend(ball.points.iter().map(|p| *p * radius.abs() + Vec3::X * *centre));
            let turned = |[a, b, c]: [u32; 3]| if *radius < 0.0 { [a, c, b] } else { [a, b, c] };
            triangles.extend(ball.triangles.iter().map(|corners| turned(corners.map(|c| c + first))));
        }
        TriangleSurface { points, triangles, ..TriangleSurface::default() }
    }

    /// The distance to balls that overlap is the least of those to each by itself, wherever they are moved; a wall of one in
    /// another is not felt.
    #[test]
    fn balls_that_overlap_are_one() {
        let surface = balls(&[(0.0, 1.0), (1.2, 0.8)]);
        let mut joined = JoinedSolids::new(&surface).unwrap();
        assert_eq!(joined.part_count(), 2);
        let alone = [(0.0, 1.0), (1.2, 0.8)].map(|ball| SignedDistance::new(balls(&[ball])).unwrap());
        for shift in [0.0, 3.0] {
            let moved: Vec<Vec3> = surface.points.iter().map(|p| *p + Vec3::Y * shift).collect();
            joined.move_points(&moved);
            for k in 0..=60 {
                let p = Vec3::new(-1.5 + 0.07 * f64::from(k), 0.11, -0.08);
                let exact = alone.iter().map(|ball| ball.distance(p)).fold(f64::INFINITY, f64::min);
                let distance = joined.distance(p + Vec3::Y * shift);
                // roundings of numbers of order one
                assert!((distance - exact).abs() < 1e-14, "{p:?}: {distance} of {exact}");
            }
        }
    }

    /// A hollow stays one, also where another solid is near; a surface inside out as a whole is turned.
    #[test]
    fn hollows_stay_hollow() {
        let surface = balls(&[(0.0, 1.0), (0.0, -0.5), (3.0, 1.0)]);
        let mut inverted = surface.clone();
        inverted.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        for surface in [surface, inverted] {
            let joined = JoinedSolids::new(&surface).unwrap();
            assert_eq!(joined.part_count(), 2);
            let at = |x: f64| joined.distance(Vec3::new(x, 0.01, 0.02));
            assert!(at(0.0) > 0.4 && at(0.75) < -0.15 && at(1.5) > 0.4 && at(3.0) < -0.9);
        }
        // what fills a hollow joins the solid around it
        let filled = JoinedSolids::new(&balls(&[(0.0, 1.0), (0.0, -0.5), (0.0, 0.6)])).unwrap();
        assert!(filled.distance(Vec3::X * 0.01) < -0.5);
    }

    /// Whatever point of it comes first: what a hollow is in is not told by one of its points where it crosses a wall.
    #[test]
    fn hollows_that_cross_are_refused() {
        for of in [[(0.0, 1.0), (1.0, -0.5)], [(1.0, -0.5), (0.0, 1.0)]] {
            let crossed = balls(&of);
            for first in 0..2 {
                let mut turned = crossed.clone();
                turned.triangles.rotate_left(first * crossed.triangles.len() / 2);
                let refused = JoinedSolids::new(&turned).err().map(|error| error.to_string());
                assert!(refused.is_some_and(|text| text.contains("faces inward")));
            }
        }
    }

    /// Parts that only touch are not joined: between two cubes there is nothing to both sides of the face, and zero on it.
    #[test]
    fn parts_that_touch_keep_a_wall() {
        let cube = |first: u32, at: f64| {
            let corner = |k: u32| Vec3::new(at + f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
            let faces: [[u32; 4]; 6] =
                [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            let halves = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
            let points: Vec<Vec3> = (0..8).map(corner).collect();
            (points, halves.map(|corners| corners.map(|c| c + first)).collect::<Vec<_>>())
        };
        let at = |second: f64, x: f64| {
            let ((mut points, mut triangles), (more, others)) = (cube(0, 0.0), cube(8, second));
            points.extend(more);
            triangles.extend(others);
            let surface = TriangleSurface { points, triangles, ..TriangleSurface::default() };
            JoinedSolids::new(&surface).unwrap().distance(Vec3::new(x, 0.45, 0.52))
        };
        assert_eq!([0.75, 1.0, 1.25].map(|x| at(1.0, x)), [-0.25, 0.0, -0.25]);
        // where they overlap the wall is gone, as deep as half of what they share
        assert!((at(0.75, 0.875) + 0.125).abs() < 1e-15);
    }
}
