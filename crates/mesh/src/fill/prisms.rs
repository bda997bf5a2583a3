//! Prisms between two hexahedra that meet in a notch.
//!
//! The hexahedra inside a shape end in steps. A cube that lies in such a step, with hexahedra on two sides that share an edge, is
//! half filled by a prism on both; the pyramid on the prism's free side, which is the diagonal plane, has its apex in the cube's
//! centre. The centre lies in that plane, so it is moved to the middle of the cube's other half before the surface is looked
//! at. The tetrahedra around it stay what they are but at the prism's ends: of the four there, those on the prism's two edges
//! give way to one on its triangle and one on the diagonal, which see the centre across. Prisms in a row share these triangles.

use std::collections::BTreeMap;

use souple_math::Vec3;

use super::hexes::{Filling, OpenFace};
use super::lattice::{Lattice, Leaf, Place, Side};
use super::stencil::Stencils;
use crate::ElementKind;
use crate::implicit::Shape;

/// How far the centre moves from the diagonal plane towards the edge across, relative to that distance: to the middle of half a
/// cube.
const TOWARDS_EDGE: f64 = 1.0 / 3.0;

/// Notches by the number of the first smallest cube of their leaf.
pub(super) type Notches = BTreeMap<usize, Notch>;

/// A cube of which half is a prism.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Notch {
    pub leaf: Leaf,
    /// Of the edge between the two hexahedra.
    axis: usize,
    /// On which side of the cube that edge is, along the next axis and the one after: 0 or 1.
    side: [u32; 2],
}

/// The points of a notch in numbers. Of a triangle, the second is on the edge between the two hexahedra.
pub(super) struct Points {
    pub ends: [[u32; 3]; 2],
    pub centre: u32,
}

impl Notch {
    fn all_of(leaf: Leaf) -> impl Iterator<Item = Self> {
        (0..12_u32).map(move |k| Self { leaf, axis: (k / 4) as usize, side: [k % 2, k / 2 % 2] })
    }

    fn other_axes(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// The prism's triangle on the lower or upper side of the cube.
    fn triangle(&self, end: u32) -> [Place; 3] {
        let [u, v] = self.side;
        [[1 - u, v], [u, v], [u, 1 - v]].map(|sides| {
            let mut place = self.leaf.low;
            place[self.axis] += end * self.leaf.edge;
            for (axis, side) in self.other_axes().into_iter().zip(sides) {
                place[axis] += side * self.leaf.edge;
            }
            place
        })
    }

    /// Of the prism's corners.
    pub fn places(&self) -> impl Iterator<Item = Place> {
        [self.triangle(0), self.triangle(1)].into_iter().flatten()
    }

    /// What lies across a face of the cube.
    fn role(&self, step: [i64; 3]) -> Role {
        if step[self.axis] != 0 {
            return Role::End;
        }
        let towards = |(axis, side): (usize, u32)| step[axis] == 2 * i64::from(side) - 1;
        if self.other_axes().into_iter().zip(self.side).any(towards) { Role::Hexahedron } else { Role::Free }
    }

    /// Where the centre goes.
    pub fn moved_centre(&self, lattice: &Lattice) -> Vec3 {
        let from = lattice.position(self.leaf.centre());
        from + (lattice.position(self.edge_beyond()) - from) * TOWARDS_EDGE
    }

    /// The middle of the edge that the prism leaves out.
    fn edge_beyond(&self) -> Place {
        let mut place = self.leaf.centre();
        for (axis, side) in self.other_axes().into_iter().zip(self.side) {
            place[axis] = self.leaf.low[axis] + (1 - side) * self.leaf.edge;
        }
        place
    }

    /// Corners of the prism, positively oriented.
    pub fn prism(&self, points: &Points) -> [u32; 6] {
        let [[a, b, c], [d, e, f]] = points.ends;
        if self.is_mirrored() { [a, c, b, d, f, e] } else { [a, b, c, d, e, f] }
    }

    /// The side of the prism that faces the rest of its cube.
    pub fn diagonal_face(&self, points: &Points) -> OpenFace {
        let [[a, _, c], [d, _, f]] = points.ends;
        let face = if self.is_mirrored() { [a, c, f, d] } else { [a, d, f, c] };
        OpenFace { face, apex: Some(points.centre), is_quarter: false }
    }

    /// Whether the triangles run backwards, seen along the axis.
    fn is_mirrored(&self) -> bool {
        self.side[0] == self.side[1]
    }

    pub fn is_on_hexahedron(&self, step: [i64; 3]) -> bool {
        self.role(step) == Role::Hexahedron
    }

    /// Whether the prisms of two cubes beside each other, both in direction of their axes, share a triangle.
    fn continues(&self, other: &Self) -> bool {
        (self.axis, self.side) == (other.axis, other.side)
    }
}

#[derive(PartialEq, Eq)]
enum Role {
    Hexahedron,
    End,
    Free,
}

/// The steps across the faces of a cube.
fn steps() -> impl Iterator<Item = [i64; 3]> {
    (0..6).map(|k| {
        let mut step = [0; 3];
        step[k / 2] = if k % 2 == 0 { -1 } else { 1 };
        step
    })
}

impl Filling<'_> {
    /// All cubes that may be notches beside each other.
    pub fn find_notches(&self, shape: &dyn Shape) -> Notches {
        let mut found = Notches::new();
        for leaf in self.lattice.leaves() {
            let keeps_its_side = |notch: &Notch| {
                let Some(centre) = self.centre(&leaf) else { return false };
                let value = shape.value(notch.moved_centre(self.lattice));
                // tetrahedra with no corner inside are not in the background
                !value.is_nan() && (value >= 0.0 || self.background.values[centre as usize] < 0.0)
            };
            let notch = Notch::all_of(leaf).find(|notch| self.suits(notch, &found) && keeps_its_side(notch));
            found.extend(notch.map(|notch| (self.index(&leaf), notch)));
        }
        found
    }

    /// The notches of this filling of which all cells are good.
    pub fn fit_notches(&self) -> Notches {
        let by_centre = self.notches_by_centre();
        let mut fit: Notches = self.notches.clone();
        fit.retain(|_, notch| self.suits(notch, self.notches) && self.is_good_notch(notch));
        for tet in &self.background.tets {
            let mut around = tet.iter().filter_map(|node| by_centre.get(node)).peekable();
            if around.peek().is_some() && !self.gives_way(tet) && !self.is_good_part(*tet) {
                around.for_each(|index| {
                    fit.remove(index);
                });
            }
        }
        fit
    }

    fn notches_by_centre(&self) -> BTreeMap<u32, usize> {
        let by_centre = |(index, notch): (&usize, &Notch)| Some((self.centre(&notch.leaf)?, *index));
        self.notches.iter().filter_map(by_centre).collect()
    }

    /// Whether a cube lies in a step of the hexahedra and nothing around it stands against a prism in it.
    fn suits(&self, notch: &Notch, others: &Notches) -> bool {
        let leaf = &notch.leaf;
        if self.is_hex[self.index(leaf)] {
            return false;
        }
        let fits_across = |step: [i64; 3]| {
            let Some(across) = self.lattice.across(leaf, step).filter(|across| across.level == leaf.level)
            else {
                return false;
            };
            let index = self.index(&across);
            let other = others.get(&index);
            match notch.role(step) {
                Role::Hexahedron => self.is_hex[index],
                Role::End => {
                    !self.is_hex[index]
                        && self.centre(&across).is_some()
                        && other.is_none_or(|other| notch.continues(other))
                }
                Role::Free => other.is_none_or(|other| other.role(step) != Role::End),
            }
        };
        steps().all(fits_across)
            && self.is_plain(leaf)
            && self
                .points_of(notch)
                .is_some_and(|points| points.ends.iter().flatten().all(|p| self.side(*p) != Side::Outside))
    }

    pub fn points_of(&self, notch: &Notch) -> Option<Points> {
        self.corners(&notch.leaf)?;
        let number = |place: Place| self.numbers.get(&place).copied();
        let end = |end: u32| -> Option<[u32; 3]> {
            let [a, b, c] = notch.triangle(end).map(number);
            Some([a?, b?, c?])
        };
        Some(Points { ends: [end(0)?, end(1)?], centre: self.centre(&notch.leaf)? })
    }

    /// The lattice's tetrahedra beyond the triangles of a prism, instead of those that give way, positively oriented.
    pub fn beyond_ends(&self, notch: &Notch, points: &Points) -> Vec<[u32; 4]> {
        let mut tets = Vec::with_capacity(4);
        for (end, [a, b, c]) in points.ends.into_iter().enumerate() {
            let mut step = [0; 3];
            step[notch.axis] = 2 * end as i64 - 1;
            let Some(across) = self.lattice.across(&notch.leaf, step) else { continue };
            let Some(centre) = self.centre(&across) else { continue };
            let is_shared = self.notches.contains_key(&self.index(&across));
            // the triangle's normal points along the axis or against it
            let [a, c] = if (end == 1) == notch.is_mirrored() { [c, a] } else { [a, c] };
            // written once of two prisms in a row: by the lower one
            if !is_shared || end == 1 {
                tets.push([a, c, points.centre, centre]);
            }
            if !is_shared {
                tets.push([a, b, c, centre]);
            }
        }
        tets
    }

    /// Whether a tetrahedron of the lattice is replaced at a prism's end, or inside of it: it has the notch's centre and
    /// a point of the edge between the hexahedra.
    pub fn gives_way(&self, tet: &[u32; 4]) -> bool {
        tet.iter().any(|node| {
            self.inner_edges.get(node).is_some_and(|edge| edge.iter().any(|end| tet.contains(end)))
        })
    }

    /// The edge between the hexahedra of each notch, by the notch's centre.
    pub fn edges_of_notches(&self) -> BTreeMap<u32, [u32; 2]> {
        let edge = |notch: &Notch| {
            let Points { ends, centre } = self.points_of(notch)?;
            Some((centre, ends.map(|[_, b, _]| b)))
        };
        self.notches.values().filter_map(edge).collect()
    }

    fn is_good_notch(&self, notch: &Notch) -> bool {
        let Some(points) = self.points_of(notch) else { return false };
        let OpenFace { face, apex, .. } = notch.diagonal_face(&points);
        self.is_fit(ElementKind::Prism6, &notch.prism(&points))
            && self.is_good(face, apex)
            && self.beyond_ends(notch, &points).into_iter().all(|tet| self.is_good_part(tet))
    }

    /// Whether what is inside of a lattice tetrahedron is well shaped: nothing is proven of those around a moved centre.
    fn is_good_part(&self, tet: [u32; 4]) -> bool {
        let mut parts = Stencils::new(self.background, self.warped);
        parts.fill(tet);
        // the parts of a tetrahedron that is inside out would be turned around
        self.jacobian(ElementKind::Tet4, &tet) > 0.0 && parts.tets.iter().all(|tet| self.is_fit_cut(tet))
    }
}
