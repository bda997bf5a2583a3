//! Which points are at work: what follows from the set of points that finer ones have replaced.
//!
//! That set is all that evolves; everything here is derived from it. A point of a finer mesh is *present* where a
//! coarser one was subdivided; present points that are not subdivided themselves are *active*. Everything that an
//! active point must see, and is not active, is a *ghost*. What nobody needs any more is nothing by itself: there is no
//! list of ghosts to clean.

use super::links::{Carrier, Hierarchy};

/// What a point does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It moves by itself.
    Active,
    /// Finer points took its place; it follows them.
    Subdivided,
    /// Coarser points are at work around it; it follows them.
    Absent,
}

/// The roles of all points, and the tetrahedra that are at work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Roles {
    pub of_point: Vec<Role>,
    /// Tetrahedra with an active corner.
    pub is_live: Vec<bool>,
}

impl Roles {
    /// From the points that are to be subdivided; of points that are not present that means nothing.
    pub fn derive(&mut self, hierarchy: &Hierarchy, is_subdivided: impl Fn(usize) -> bool) {
        self.of_point.clear();
        self.of_point.resize(hierarchy.point_count(), Role::Absent);
        self.of_point[hierarchy.levels[0].clone()].fill(Role::Active);
        for points in &hierarchy.levels[..hierarchy.finest()] {
            for point in points.clone() {
                if self.of_point[point] == Role::Active && is_subdivided(point) {
                    self.of_point[point] = Role::Subdivided;
                    for successor in hierarchy.successors.get(point) {
                        self.of_point[*successor as usize] = Role::Active;
                    }
                }
            }
        }
        self.is_live.clear();
        let is_active = |corner: &u32| self.of_point[*corner as usize] == Role::Active;
        self.is_live.extend(hierarchy.tets.iter().map(|tet| tet.corners.iter().any(is_active)));
    }

    /// How fine each point is: 0 where coarser ones are in its place, 1 where it is at work, 2 where finer ones are.
    pub fn fineness(&self) -> impl Iterator<Item = u8> + '_ {
        self.of_point.iter().map(|role| match role {
            Role::Absent => 0,
            Role::Active => 1,
            Role::Subdivided => 2,
        })
    }

    pub fn is_active(&self, point: usize) -> bool {
        self.of_point[point] == Role::Active
    }

    /// What a point that is not active follows.
    pub fn feed<'a>(&self, hierarchy: &'a Hierarchy, point: usize) -> Option<&'a Carrier> {
        match self.of_point[point] {
            Role::Active => None,
            Role::Subdivided => Some(hierarchy.child_tet(point)),
            Role::Absent => Some(hierarchy.parent(point)),
        }
    }

    /// All points that follow, each after those that feed it but where they feed each other: subdivided ones from fine to coarse, then
    /// absent ones from coarse to fine.
    pub fn relay(&self, hierarchy: &Hierarchy, order: &mut Vec<u32>) {
        order.clear();
        let of = |role: Role, points: &std::ops::Range<usize>| {
            points
                .clone()
                .filter(move |point| self.of_point[*point] == role)
                .map(|point| point as u32)
                .collect::<Vec<_>>()
        };
        order.extend(hierarchy.levels.iter().rev().flat_map(|points| of(Role::Subdivided, points)));
        order.extend(hierarchy.levels.iter().flat_map(|points| of(Role::Absent, points)));
    }

    /// The ghosts: followers that active points see in their own mesh, and those by which these are fed.
    pub fn ghosts(&self, hierarchy: &Hierarchy) -> Vec<bool> {
        let mut is_ghost = vec![false; hierarchy.point_count()];
        let mut waiting: Vec<usize> = Vec::new();
        let mut mark = |point: u32, waiting: &mut Vec<usize>| {
            let point = point as usize;
            if !self.is_active(point) && !is_ghost[point] {
                is_ghost[point] = true;
                waiting.push(point);
            }
        };
        for (tet, _) in hierarchy.tets.iter().zip(&self.is_live).filter(|(_, is_live)| **is_live) {
            tet.corners.iter().for_each(|corner| mark(*corner, &mut waiting));
        }
        while let Some(point) = waiting.pop() {
            let feed = self.feed(hierarchy, point).into_iter();
            feed.flat_map(|carrier| carrier.corners).for_each(|corner| mark(corner, &mut waiting));
        }
        is_ghost
    }
}

/// Of each point that follows: the active points that it comes to in the end, with its weights.
#[derive(Clone, Debug, Default)]
pub struct Following {
    /// The most that the sizes of a point's weights sum up to; those of an active point are one.
    pub leverage: f64,
    /// Where the entries of each point are.
    ranges: Vec<(u32, u32)>,
    entries: Vec<(u32, f64)>,
    /// Weights while they are summed.
    sums: Vec<f64>,
    summed: Vec<u32>,
}

/// A point whose entries are not made yet.
const UNKNOWN: (u32, u32) = (u32::MAX, u32::MAX);
/// A point whose entries are being made.
const UNDER_WAY: (u32, u32) = (u32::MAX, 0);

impl Following {
    /// Follows each point's feeding tetrahedra until all are active: from absent points to coarser ones until one is
    /// present, from subdivided points to finer ones, which are present. So it ends; where loops are let be it is broken off.
    pub fn compose(&mut self, hierarchy: &Hierarchy, roles: &Roles) {
        let count = hierarchy.point_count();
        self.entries.clear();
        self.ranges.clear();
        self.ranges.resize(count, UNKNOWN);
        self.sums.clear();
        self.sums.resize(count, 0.0);
        for point in 0..count {
            self.compose_point(hierarchy, roles, point);
        }
        let sizes = |point| self.of(point).iter().map(|(_, weight)| weight.abs()).sum::<f64>();
        self.leverage = (0..count).map(sizes).fold(1.0, f64::max);
    }

    fn compose_point(&mut self, hierarchy: &Hierarchy, roles: &Roles, point: usize) {
        let Some(carrier) = roles.feed(hierarchy, point) else { return };
        if self.ranges[point] != UNKNOWN {
            return;
        }
        self.ranges[point] = UNDER_WAY;
        for corner in carrier.corners {
            self.compose_point(hierarchy, roles, corner as usize);
        }
        let mut leads_back = false;
        for (corner, weight) in carrier.corners.into_iter().zip(carrier.weights) {
            if roles.is_active(corner as usize) {
                self.add(corner, weight);
            } else if self.ranges[corner as usize] == UNDER_WAY {
                leads_back = true;
            } else {
                let (start, end) = self.ranges[corner as usize];
                for entry in start..end {
                    let (leader, share) = self.entries[entry as usize];
                    self.add(leader, share * weight);
                }
            }
        }
        // in the order of numbers, so that sums do not depend on the way
        self.summed.sort_unstable();
        if leads_back {
            self.share_out();
        }
        let start = self.entries.len() as u32;
        for leader in self.summed.drain(..) {
            let weight = std::mem::take(&mut self.sums[leader as usize]);
            // a corner with no say, up to rounding
            if weight.abs() > NOTHING {
                self.entries.push((leader, weight));
            }
        }
        self.ranges[point] = (start, self.entries.len() as u32);
    }

    /// What would lead back to where it came from is shared out among the rest: weights of sum one.
    fn share_out(&mut self) {
        self.summed.dedup();
        let sum: f64 = self.summed.iter().map(|leader| self.sums[*leader as usize]).sum();
        if sum.abs() > NOTHING {
            self.summed.iter().for_each(|leader| self.sums[*leader as usize] /= sum);
        }
    }

    fn add(&mut self, leader: u32, weight: f64) {
        let sum = &mut self.sums[leader as usize];
        // an exact zero is taken for a leader not met before; twice in the list it adds nothing the second time
        if *sum == 0.0 {
            self.summed.push(leader);
        }
        *sum += weight;
    }

    /// What a follower follows; nothing for an active point.
    pub fn of(&self, point: usize) -> &[(u32, f64)] {
        match self.ranges[point] {
            UNKNOWN | UNDER_WAY => &[],
            (start, end) => &self.entries[start as usize..end as usize],
        }
    }

    pub fn bytes(&self) -> usize {
        8 * (self.ranges.capacity() + self.sums.capacity())
            + 16 * self.entries.capacity()
            + 4 * self.summed.capacity()
    }
}

/// Weights below this are rounding of zeros: barycentric weights of points on faces and corners.
const NOTHING: f64 = 1e-13;
