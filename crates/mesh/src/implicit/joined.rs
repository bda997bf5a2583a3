//! Solids of one surface joined: what is in any of its parts.
//!
//! Normals tell the inside of each part by itself; where parts overlap, what lies in several would count as outside beside
//! a wall of one in another, and distances would be those to walls that are inside. Joined, the distance is the least of all.

use souple_math::Vec3;

use super::{Shape, around};
use crate::repair::{components, crossings};
use crate::{BoundingBox, MeshError, SignedDistance, TriangleSurface};

/// The least of the signed distances to closed surfaces that may overlap; hollows belong to the part around them.
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
}

impl JoinedSolids {
    /// # Errors
    /// A part is not closed, or has a triangle without area.
    pub fn new(surface: &TriangleSurface) -> Result<Self, MeshError> {
        let (part_of, count) = components(surface);
        let of_parts = |parts: &[usize]| {
            let is_in = |(_, part): &(&[u32; 3], &u32)| parts.contains(&(**part as usize));
            let own = surface.triangles.iter().zip(&part_of).filter(is_in).map(|(corners, _)| *corners);
            own.collect::<Vec<[u32; 3]>>()
        };
        let shells = (0..count).map(|part| Joined::new(surface, &of_parts(&[part])));
        let shells: Vec<(Joined, f64)> = shells.collect::<Result<_, _>>()?;
        // a surface that faces inward as a whole is inside out
        let sense = shells.iter().map(|(_, volume)| volume).sum::<f64>().signum();
        let mut holders: Vec<Vec<usize>> = Vec::new();
        let outward = |part: usize| shells[part].1 * sense > 0.0;
        holders.extend((0..count).filter(|part| outward(*part)).map(|part| vec![part]));
        for hollow in (0..count).filter(|part| !outward(*part)) {
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
        let parts = holders.iter().map(|parts| Ok(Joined::new(surface, &of_parts(parts))?.0));
        let parts = parts.collect::<Result<_, MeshError>>()?;
        let holder = |part: &u32| holders.iter().position(|parts| parts.contains(&(*part as usize)));
        let part_of = part_of.iter().map(|part| holder(part).unwrap_or_default() as u32).collect();
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
        for Joined { distance, points, positions: own } in &mut self.parts {
            own.iter_mut().zip(points).for_each(|(own, point)| *own = positions[*point as usize]);
            distance.move_points(own);
        }
    }

    /// Negative inside [m]; NaN where there is no closest point. Outside and where one part alone is around it is exact, elsewhere
    /// it falls short of the distance to what is seen from outside.
    pub fn distance(&self, point: Vec3) -> f64 {
        let mut least = f64::INFINITY;
        for part in &self.parts {
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
        let volume = own.enclosed_volume();
        Ok((Self { distance: SignedDistance::new(own)?, points, positions }, volume))
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
        let bounds = self.parts.iter().map(|part| part.distance.surface().bounds());
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

    /// The distance to balls that overlap is the least of theirs, to the chords of their triangles, wherever they are moved; a
    /// wall of one in another is not felt.
    #[test]
    fn balls_that_overlap_are_one() {
        let surface = balls(&[(0.0, 1.0), (1.2, 0.8)]);
        let mut joined = JoinedSolids::new(&surface).unwrap();
        assert_eq!(joined.part_count(), 2);
        for shift in [0.0, 3.0] {
            let moved: Vec<Vec3> = surface.points.iter().map(|p| *p + Vec3::Y * shift).collect();
            joined.move_points(&moved);
            for k in 0..=60 {
                let p = Vec3::new(-1.5 + 0.07 * f64::from(k), 0.11, -0.08);
                let exact = (p.length() - 1.0).min((p - Vec3::X * 1.2).length() - 0.8);
                let distance = joined.distance(p + Vec3::Y * shift);
                // chords of a ball of eight cubes across
                assert!((distance - exact).abs() < 0.05, "{p:?}: {distance} of {exact}");
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
}
