//! The tetrahedra of a lattice, level by level of its octree.

use super::lattice::{Background, Lattice, Leaf, Place, Side};
use crate::element::ElementKind;

/// Gives numbers to lattice points as they are met.
struct Numbering<'a> {
    lattice: &'a Lattice,
    corners: Vec<u32>,
    centres: Vec<u32>,
    background: Background,
}

impl Leaf {
    pub fn centre(&self) -> Place {
        self.low.map(|c| c + self.edge / 2)
    }

    /// Corners of the face across `axis` on the lower or upper side, in order around it.
    fn face(&self, axis: usize, upper: u32) -> [Place; 4] {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
            let mut corner = self.low;
            corner[axis] += upper * self.edge;
            corner[u] += a * self.edge;
            corner[v] += b * self.edge;
            corner
        })
    }
}

pub(super) fn middle(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|axis| u32::midpoint(a[axis], b[axis]))
}

impl Lattice {
    /// The tetrahedra with a corner inside.
    pub fn background(&self) -> Background {
        let [nx, ny, nz] = self.counts;
        let mut numbering = Numbering {
            lattice: self,
            corners: vec![u32::MAX; (nx + 1) * (ny + 1) * (nz + 1)],
            centres: vec![u32::MAX; nx * ny * nz],
            background: Background {
                places: Vec::new(),
                points: Vec::new(),
                values: Vec::new(),
                tets: Vec::new(),
            },
        };
        for leaf in self.leaves() {
            for axis in 0..3 {
                for upper in 0..2 {
                    numbering.face(leaf, axis, upper);
                }
            }
        }
        numbering.background
    }

    /// Level of the leaf that holds the smallest cube at a corner, in the octant of the signs; none beyond the border.
    fn level_at(&self, corner: Place, octant: [i64; 3]) -> Option<u8> {
        let cube = corner.map(|c| (c / 2) as usize);
        let step = octant.map(|sign| if sign < 0 { -1 } else { 0 });
        // the corner on the upper border belongs to no cube of its own
        let inside = (0..3).all(|axis| (cube[axis] as i64 + step[axis]) < self.counts[axis] as i64);
        if !inside || (0..3).any(|axis| cube[axis] as i64 + step[axis] < 0) {
            return None;
        }
        Some(self.levels[self.cube([0, 1, 2].map(|axis| (cube[axis] as i64 + step[axis]) as usize))])
    }

    /// Whether a leaf around the edge is smaller than it is long, so that its middle is a lattice point.
    pub fn is_halved(&self, a: Place, b: Place, level: u8) -> bool {
        let centre = middle(a, b);
        level > 0
            && (0..8).any(|octant| {
                let signs = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { -1 } else { 1 });
                self.level_at(centre, signs).is_some_and(|other| other < level)
            })
    }
}

impl Numbering<'_> {
    /// The tetrahedra on one face of a leaf, on both sides of it where the leaves are of one size.
    fn face(&mut self, leaf: Leaf, axis: usize, upper: u32) {
        let corners = leaf.face(axis, upper);
        // the leaf across, looked at beside the first corner of the face
        let mut signs = [1; 3];
        signs[axis] = if upper == 1 { 1 } else { -1 };
        let Some(across) = self.lattice.level_at(corners[0], signs) else { return };
        let centre = leaf.centre();
        let middle_of_face = middle(corners[0], corners[2]);
        for side in 0..4 {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            if across == leaf.level {
                if upper == 0 {
                    continue;
                }
                let mut other = centre;
                other[axis] += leaf.edge;
                if self.lattice.is_halved(a, b, leaf.level) {
                    let m = middle(a, b);
                    self.tet([a, m, centre, other]);
                    self.tet([m, b, centre, other]);
                } else {
                    self.tet([a, b, centre, other]);
                }
            } else if across < leaf.level {
                let m = middle(a, b);
                self.tet([a, m, middle_of_face, centre]);
                self.tet([m, b, middle_of_face, centre]);
            }
        }
        if across > leaf.level {
            // the diagonal ends in the middle of the coarse face: an odd multiple of this leaf's edge both ways
            let is_middle = |p: Place| {
                [(axis + 1) % 3, (axis + 2) % 3].iter().all(|u| !(p[*u] / leaf.edge).is_multiple_of(2))
            };
            let turn = usize::from(is_middle(corners[1]) || is_middle(corners[3]));
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| corners[(i + turn) % 4]);
            self.tet([a, b, c, centre]);
            self.tet([a, c, d, centre]);
        }
    }

    fn tet(&mut self, places: [Place; 4]) {
        if places.iter().all(|place| Side::of(self.lattice.value(*place)) != Side::Inside) {
            return;
        }
        let mut nodes = places.map(|place| self.number(place));
        let [a, b, c, d] = places.map(|place| place.map(i64::from));
        let [u, v, w] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        let volume = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0]);
        if volume < 0 {
            nodes.swap(2, 3);
        }
        debug_assert!(volume != 0, "a lattice tetrahedron is a {} with volume", ElementKind::Tet4);
        self.background.tets.push(nodes);
    }

    fn number(&mut self, place: Place) -> u32 {
        let index = place.map(|c| (c / 2) as usize);
        let [nx, ny, _] = self.lattice.counts;
        let slot = if place[0].is_multiple_of(2) {
            &mut self.corners[index[0] + (nx + 1) * (index[1] + (ny + 1) * index[2])]
        } else {
            &mut self.centres[index[0] + nx * (index[1] + ny * index[2])]
        };
        if *slot == u32::MAX {
            *slot = self.background.points.len() as u32;
            self.background.places.push(place);
            self.background.points.push(self.lattice.position(place));
            self.background.values.push(self.lattice.value(place));
        }
        *slot
    }
}
