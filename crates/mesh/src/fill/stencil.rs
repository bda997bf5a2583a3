//! What is left of a lattice tetrahedron inside the surface, in tetrahedra.
//!
//! With corners inside, on and outside the surface, the part inside is the whole tetrahedron, a smaller one, a
//! pyramid on a quadrilateral or a prism. Quadrilaterals on faces between lattice tetrahedra are cut in the same
//! way from both sides by a rule that looks at the face alone: the diagonal ends in the cut of the long edge where
//! there is one; else (both cut edges short, the third one long) it starts at the corner inside that is greater
//! than the corner outside in an even number of coordinates. This makes the prisms those for which the bounds on
//! angles are proven (Labelle & Shewchuk 2007, Figure 6).

use std::cmp::Ordering;

use super::lattice::{Background, Place, Side};
use super::warp::{Cut, Warped, axes_apart};

/// Writes what is inside as tetrahedra.
pub(super) struct Stencils<'a> {
    background: &'a Background,
    sides: &'a [Side],
    cuts: &'a [Cut],
    pub tets: Vec<[u32; 4]>,
}

impl<'a> Stencils<'a> {
    pub fn new(background: &'a Background, warped: &'a Warped) -> Self {
        Self { background, sides: &warped.sides, cuts: &warped.cuts, tets: Vec::new() }
    }

    /// Number of the point where the edge is cut; cuts follow the lattice points.
    pub fn cut(&self, a: u32, b: u32) -> u32 {
        let ends = [a.min(b), a.max(b)];
        match self.cuts.binary_search_by_key(&ends, |cut| cut.ends) {
            Ok(index) => (self.background.points.len() + index) as u32,
            Err(_) => unreachable!("an edge from inside to outside was not looked at"),
        }
    }

    pub fn position(&self, node: u32) -> souple_math::Vec3 {
        let node = node as usize;
        let count = self.background.points.len();
        if node < count { self.background.points[node] } else { self.cuts[node - count].position }
    }

    fn push(&mut self, mut nodes: [u32; 4]) {
        let [a, b, c, d] = nodes.map(|node| self.position(node));
        if (b - a).dot((c - a).cross(d - a)) < 0.0 {
            nodes.swap(2, 3);
        }
        self.tets.push(nodes);
    }

    /// The part inside of one lattice tetrahedron.
    pub fn fill(&mut self, tet: [u32; 4]) {
        let sides = self.sides;
        let of = |side: Side| tet.iter().copied().filter(|node| sides[*node as usize] == side).collect();
        let [inside, on, outside]: [Vec<u32>; 3] = [Side::Inside, Side::On, Side::Outside].map(of);
        match (&inside[..], &on[..], &outside[..]) {
            ([], _, _) => {}
            (_, _, []) => self.push(tet),
            ([p], _, _) => {
                let mut nodes = [*p; 4];
                let others = on.iter().copied().chain(outside.iter().map(|node| self.cut(*p, *node)));
                nodes[1..].iter_mut().zip(others).for_each(|(slot, node)| *slot = node);
                self.push(nodes);
            }
            ([p, q], [apex], [r]) => {
                let (at_p, at_q) = (self.cut(*p, *r), self.cut(*q, *r));
                // a pyramid is two tetrahedra on the halves of its base
                let halves = if self.diagonal_starts_at_first(*p, *q, *r) {
                    [[*p, *q, at_q], [*p, at_q, at_p]]
                } else {
                    [[*p, *q, at_p], [*q, at_q, at_p]]
                };
                halves.into_iter().for_each(|[a, b, c]| self.push([a, b, c, *apex]));
            }
            ([p, q], _, [r, s]) => {
                let low = [*p, self.cut(*p, *r), self.cut(*p, *s)];
                let high = [*q, self.cut(*q, *r), self.cut(*q, *s)];
                let [r_up, s_up] = [*r, *s].map(|out| self.diagonal_starts_at_first(*p, *q, out));
                let order = match (r_up, s_up) {
                    (true, true) => [0, 1, 2],
                    (true, false) => [2, 0, 1],
                    (false, true) => [1, 0, 2],
                    (false, false) => [1, 2, 0],
                };
                self.prism(low, high, order);
            }
            ([p, q, s], _, [r]) => {
                let low = [*p, *q, *s];
                let high = low.map(|node| self.cut(node, *r));
                let mut order = [0, 1, 2];
                // a total order: with two kinds of edges, diagonals never run around a prism
                order.sort_by(|i, j| match self.diagonal_starts_at_first(low[*i], low[*j], *r) {
                    _ if i == j => Ordering::Equal,
                    true => Ordering::Less,
                    false => Ordering::Greater,
                });
                self.prism(low, high, order);
            }
            _ => unreachable!("a tetrahedron has four corners"),
        }
    }

    /// A prism between two triangles, in three tetrahedra; the diagonal of each side starts below at the edge that
    /// comes first in the order and ends above at the other.
    fn prism(&mut self, low: [u32; 3], high: [u32; 3], [i, j, k]: [usize; 3]) {
        self.push([low[i], low[j], low[k], high[k]]);
        self.push([low[i], low[j], high[j], high[k]]);
        self.push([low[i], high[i], high[j], high[k]]);
    }

    /// Of the quadrilateral `p, q` (inside) and the cuts of their edges to `r` (outside): whether its diagonal runs
    /// from `p` to the cut of `qr`, and not from `q` to the cut of `pr`.
    pub fn diagonal_starts_at_first(&self, p: u32, q: u32, r: u32) -> bool {
        let rank = |node: u32| {
            let [node_place, r] = [node, r].map(|node| self.background.places[node as usize]);
            (Rank::of(node_place, r), node)
        };
        rank(p) < rank(q)
    }
}

/// In what order diagonals of the quadrilaterals below a corner outside start at corners inside: by their edges alone, so that
/// diagonals never run around a prism, also between cubes of two sizes. On a face of the uniform lattice this is the rule
/// above: two short edges are one of either kind, since their ends inside differ in one coordinate.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    ShortEven,
    ShortOdd,
    /// Half a diagonal of a face, between cubes of two sizes.
    Halved,
    Long,
}

impl Rank {
    /// Of the edge from a corner inside to one outside.
    fn of(inside: Place, outside: Place) -> Self {
        match axes_apart(inside, outside) {
            1 => Self::Long,
            2 => Self::Halved,
            _ if is_even(inside, outside) => Self::ShortEven,
            _ => Self::ShortOdd,
        }
    }
}

/// Whether a point is greater than another in an even number of coordinates.
fn is_even(p: Place, r: Place) -> bool {
    (0..3).filter(|axis| p[*axis] > r[*axis]).count() % 2 == 0
}
