//! Hexahedra inside, tetrahedra at the surface, prisms and pyramids between.
//!
//! Cubes of the octree with all corners inside or on the surface, and no point of smaller cubes on their edges, become
//! hexahedra. On each of their faces towards a cube that does not, of the same size or twice as large, stands a
//! pyramid with its apex in that cube's centre, whose sides are those of the lattice's tetrahedra: the mesh is
//! conforming. A pyramid with its apex outside is cut off like the tetrahedra beside it, and what is left is cut into
//! cells around its middle. Cubes of which a cell would be too flat, because corners have moved onto the surface, are
//! filled with tetrahedra after all, and so are those at points where what comes out would hang together by a point or an edge
//! alone. Where the hexahedra end in a step, a prism lies in it (`prisms`).

use std::collections::{BTreeMap, HashMap, HashSet};

use souple_math::Vec3;

use super::lattice::{Background, Lattice, Leaf, Place, Side};
use super::prisms::Notches;
use super::stencil::Stencils;
use super::warp::{self, Warped};
use crate::implicit::Shape;
use crate::quality::scaled_jacobian;
use crate::{CellBlock, ElementKind, Mesh};

/// Least scaled Jacobian of hexahedra, prisms and pyramids, and of the tetrahedra in cut-off pyramids and beside prisms.
const LEAST_JACOBIAN: f64 = 0.15;
const LEAST_JACOBIAN_CUT: f64 = 0.04;

/// Corners of a cube in the order of a hexahedron.
const CORNERS: [[u32; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// Faces of a hexahedron, around the outward normal, with the step to the cube across.
const FACES: [([usize; 4], [i64; 3]); 6] = [
    ([0, 3, 2, 1], [0, 0, -1]),
    ([4, 5, 6, 7], [0, 0, 1]),
    ([0, 1, 5, 4], [0, -1, 0]),
    ([2, 3, 7, 6], [0, 1, 0]),
    ([1, 2, 6, 5], [1, 0, 0]),
    ([0, 4, 7, 3], [-1, 0, 0]),
];

/// Cells between a face of a hexahedron and the tetrahedra beyond it.
#[derive(Default)]
struct Transition {
    pyramids: Vec<[u32; 5]>,
    tets: Vec<[u32; 4]>,
    /// A new point in the middle, which has the number that follows all others.
    middle: Option<Vec3>,
}

/// A face of a hexahedron, its normal to the centre of the leaf across, which is none.
pub(super) struct OpenFace {
    pub face: [u32; 4],
    /// `None` where the centre is no point of the lattice.
    pub apex: Option<u32>,
    /// The leaf across is larger.
    pub is_quarter: bool,
}

pub(super) struct Filling<'a> {
    pub lattice: &'a Lattice,
    pub background: &'a Background,
    pub warped: &'a Warped,
    stencils: Stencils<'a>,
    pub numbers: &'a HashMap<Place, u32>,
    /// By the first smallest cube of each leaf.
    pub is_hex: Vec<bool>,
    /// Cubes that hold a prism.
    pub notches: &'a Notches,
    /// Of each notch by its centre, the edge that its prism shares with two hexahedra.
    pub inner_edges: BTreeMap<u32, [u32; 2]>,
    /// Points beyond those of lattice and cuts.
    middles: Vec<Vec3>,
}

/// The mesh of a shape on a lattice.
pub(super) fn hex_dominant(lattice: &Lattice, shape: &dyn Shape) -> Mesh {
    let background = lattice.background();
    let numbers: HashMap<Place, u32> =
        background.places.iter().enumerate().map(|(number, place)| (*place, number as u32)).collect();
    let mut notches = Notches::new();
    let mut is_first = true;
    // points at which tetrahedra alone are a manifold, and hexahedra were none
    let mut without_hexes: HashSet<u32> = HashSet::new();
    // the surface cuts other edges where a centre has moved, and cells around it may be bad after all: such a notch is left out,
    // and the surface is looked at again
    loop {
        let mut background = background.clone();
        for notch in notches.values() {
            let Some(centre) = numbers.get(&notch.leaf.centre()) else { continue };
            let moved = notch.moved_centre(lattice);
            background.points[*centre as usize] = moved;
            background.values[*centre as usize] = shape.value(moved);
        }
        let warped = warp::warp(&mut background, shape);
        let mut filling = Filling::new(lattice, &background, &warped, &numbers, &notches);
        filling.choose(&without_hexes);
        let fit = if is_first { filling.find_notches(shape) } else { filling.fit_notches() };
        is_first = false;
        if fit.len() < notches.len() || notches.is_empty() && !fit.is_empty() {
            notches = fit;
            continue;
        }
        let mesh = filling.mesh();
        let known = without_hexes.len();
        let boundary = mesh.boundary_surface();
        for point in boundary.pinched_points() {
            match (boundary.mesh_points[point as usize] as usize).checked_sub(background.points.len()) {
                None => without_hexes.extend([boundary.mesh_points[point as usize]]),
                Some(cut) => without_hexes.extend(warped.cuts.get(cut).iter().flat_map(|cut| cut.ends)),
            }
        }
        if without_hexes.len() == known {
            return mesh;
        }
        let is_without =
            |place: Place| numbers.get(&place).is_some_and(|point| without_hexes.contains(point));
        notches.retain(|_, notch| !notch.places().any(is_without));
    }
}

impl<'a> Filling<'a> {
    fn new(
        lattice: &'a Lattice,
        background: &'a Background,
        warped: &'a Warped,
        numbers: &'a HashMap<Place, u32>,
        notches: &'a Notches,
    ) -> Self {
        let mut filling = Self {
            lattice,
            background,
            warped,
            stencils: Stencils::new(background, warped),
            numbers,
            is_hex: vec![false; lattice.counts.iter().product()],
            notches,
            inner_edges: BTreeMap::new(),
            middles: Vec::new(),
        };
        filling.inner_edges = filling.edges_of_notches();
        filling
    }

    pub fn corners(&self, leaf: &Leaf) -> Option<[u32; 8]> {
        let mut corners = [0; 8];
        for (slot, corner) in corners.iter_mut().zip(CORNERS) {
            let place = [0, 1, 2].map(|axis| leaf.low[axis] + leaf.edge * corner[axis]);
            *slot = *self.numbers.get(&place)?;
        }
        Some(corners)
    }

    pub fn centre(&self, leaf: &Leaf) -> Option<u32> {
        self.numbers.get(&leaf.centre()).copied()
    }

    pub fn index(&self, leaf: &Leaf) -> usize {
        self.lattice.cube(leaf.low.map(|c| (c / 2) as usize))
    }

    /// Whether no smaller cube has a point on an edge of the leaf.
    pub fn is_plain(&self, leaf: &Leaf) -> bool {
        let corner = |c: usize| [0, 1, 2].map(|axis| leaf.low[axis] + leaf.edge * CORNERS[c][axis]);
        let halved = |[a, b]: [usize; 2]| self.lattice.is_halved(corner(a), corner(b), leaf.level);
        let around = (0..4).flat_map(|i| [[i, (i + 1) % 4], [4 + i, 4 + (i + 1) % 4], [i, i + 4]]);
        leaf.level == 0 || !around.into_iter().any(halved)
    }

    pub fn side(&self, node: u32) -> Side {
        self.warped.sides[node as usize]
    }

    fn position(&self, node: u32) -> Vec3 {
        let known = self.background.points.len() + self.warped.cuts.len();
        match (node as usize).checked_sub(known) {
            Some(middle) => self.middles[middle],
            None => self.stencils.position(node),
        }
    }

    pub fn jacobian(&self, kind: ElementKind, nodes: &[u32]) -> f64 {
        let positions: Vec<Vec3> = nodes.iter().map(|node| self.position(*node)).collect();
        scaled_jacobian(kind, &positions)
    }

    pub fn is_fit(&self, kind: ElementKind, nodes: &[u32]) -> bool {
        self.jacobian(kind, nodes) > LEAST_JACOBIAN
    }

    pub fn is_fit_cut(&self, tet: &[u32; 4]) -> bool {
        self.jacobian(ElementKind::Tet4, tet) > LEAST_JACOBIAN_CUT
    }

    /// Decides which cubes are hexahedra: all that can be, less those with a bad cell on one of their faces, until
    /// there are none. Deciding against a cube may put a pyramid on its neighbours, so it is looked at these again.
    fn choose(&mut self, without_hexes: &HashSet<u32>) {
        for leaf in self.lattice.leaves() {
            let (Some(corners), Some(centre)) = (self.corners(&leaf), self.centre(&leaf)) else { continue };
            let is_inside = corners.iter().all(|node| self.side(*node) != Side::Outside)
                && self.side(centre) == Side::Inside
                && (without_hexes.is_empty() || !self.touches(&leaf, &corners, without_hexes));
            let is_hex = is_inside && self.is_fit(ElementKind::Hex8, &corners) && self.is_plain(&leaf);
            let index = self.index(&leaf);
            self.is_hex[index] = is_hex;
        }
        loop {
            let bad: Vec<usize> = self
                .hexes()
                .filter(|(leaf, corners)| {
                    self.open_faces(leaf, *corners).any(|open| !self.is_good(open.face, open.apex))
                })
                .map(|(leaf, _)| self.index(&leaf))
                .collect();
            if bad.is_empty() {
                return;
            }
            bad.into_iter().for_each(|cube| self.is_hex[cube] = false);
        }
    }

    /// Whether a hexahedron, or the apex of a pyramid on it, is among points.
    fn touches(&self, leaf: &Leaf, corners: &[u32; 8], points: &HashSet<u32>) -> bool {
        let across = FACES.iter().filter_map(|(_, step)| self.lattice.across(leaf, *step));
        let apices = across.filter_map(|across| self.centre(&across));
        corners.iter().copied().chain(apices).any(|node| points.contains(&node))
    }

    fn hexes(&self) -> impl Iterator<Item = (Leaf, [u32; 8])> {
        self.lattice
            .leaves()
            .filter(|leaf| self.is_hex[self.index(leaf)])
            .filter_map(|leaf| Some((leaf, self.corners(&leaf)?)))
    }

    /// Faces of a hexahedron towards leaves that are none and hold no prism on it, with the centres of these.
    fn open_faces(&self, leaf: &Leaf, corners: [u32; 8]) -> impl Iterator<Item = OpenFace> {
        let leaf = *leaf;
        FACES.into_iter().filter_map(move |(face, step)| {
            let across = self.lattice.across(&leaf, step)?;
            let index = self.index(&across);
            let back = step.map(|s| -s);
            let is_closed = self.is_hex[index]
                || self.notches.get(&index).is_some_and(|notch| notch.is_on_hexahedron(back));
            (!is_closed).then(|| OpenFace {
                face: face.map(|corner| corners[corner]),
                apex: self.centre(&across),
                is_quarter: across.level > leaf.level,
            })
        })
    }

    pub fn is_good(&self, face: [u32; 4], apex: Option<u32>) -> bool {
        let Some(apex) = apex else { return false };
        let Transition { pyramids, tets, middle } = self.transition(face, apex);
        let next = (self.background.points.len() + self.warped.cuts.len() + self.middles.len()) as u32;
        let position = |node: &u32| match middle {
            Some(middle) if *node == next => middle,
            _ => self.position(*node),
        };
        let jacobian = |kind: ElementKind, nodes: &[u32]| {
            scaled_jacobian(kind, &nodes.iter().map(position).collect::<Vec<_>>())
        };
        let least = if middle.is_some() { LEAST_JACOBIAN_CUT } else { LEAST_JACOBIAN };
        pyramids.iter().all(|nodes| jacobian(ElementKind::Pyramid5, nodes) > least)
            && tets.iter().all(|nodes| jacobian(ElementKind::Tet4, nodes) > least)
    }

    /// The cells on a face, whose normal points to the apex.
    fn transition(&self, face: [u32; 4], apex: u32) -> Transition {
        let mut transition = Transition::default();
        let inside = face.iter().filter(|node| self.side(**node) == Side::Inside).count();
        if self.side(apex) != Side::Outside {
            if inside > 0 || self.side(apex) == Side::Inside {
                transition.pyramids.push([face[0], face[1], face[2], face[3], apex]);
            }
            return transition;
        }
        // edges from corners inside to the apex are cut; corners on the surface are their own cuts
        let top = face.map(|node| match self.side(node) {
            Side::Inside => self.stencils.cut(node, apex),
            _ => node,
        });
        match inside {
            0 => {}
            1 => {
                let lifted =
                    top.iter().zip(&face).find(|(cut, node)| cut != node).map_or(apex, |(cut, _)| *cut);
                transition.pyramids.push([face[0], face[1], face[2], face[3], lifted]);
            }
            _ => {
                let mut nodes: Vec<u32> = face.iter().chain(&top).copied().collect();
                nodes.sort_unstable();
                nodes.dedup();
                let sum: Vec3 = nodes.iter().map(|node| self.position(*node)).sum();
                transition.middle = Some(sum / nodes.len() as f64);
                let known = self.background.points.len() + self.warped.cuts.len() + self.middles.len();
                let middle = known as u32;
                transition.pyramids.push([face[0], face[1], face[2], face[3], middle]);
                for triangle in self.sides(face, top, apex).into_iter().chain(top_triangles(top)) {
                    let [a, b, c] = triangle;
                    transition.tets.push([a, c, b, middle]);
                }
            }
        }
        transition
    }

    /// Triangles of the sides of a cut-off pyramid, outward.
    fn sides(&self, face: [u32; 4], top: [u32; 4], apex: u32) -> Vec<[u32; 3]> {
        let mut triangles = Vec::with_capacity(8);
        for i in 0..4 {
            let j = (i + 1) % 4;
            let (a, b, above_a, above_b) = (face[i], face[j], top[i], top[j]);
            match (a != above_a, b != above_b) {
                (true, true) if self.stencils.diagonal_starts_at_first(a, b, apex) => {
                    triangles.extend([[a, b, above_b], [a, above_b, above_a]]);
                }
                (true, true) => triangles.extend([[a, b, above_a], [b, above_b, above_a]]),
                (true, false) => triangles.push([a, b, above_a]),
                (false, true) => triangles.push([a, b, above_b]),
                (false, false) => {}
            }
        }
        triangles
    }

    fn mesh(mut self) -> Mesh {
        let mut hexes = CellBlock::new(ElementKind::Hex8);
        let mut prisms = CellBlock::new(ElementKind::Prism6);
        let mut pyramids = CellBlock::new(ElementKind::Pyramid5);
        let mut transitions = CellBlock::new(ElementKind::Tet4);
        // what hexahedra and pyramids stand for: tetrahedra around centres, and those of larger cubes on small faces
        let mut is_hex_centre = vec![false; self.background.points.len()];
        let mut on_quarters = HashSet::new();
        let mut open = Vec::new();
        for (leaf, corners) in self.hexes() {
            hexes.nodes.extend(corners);
            if let Some(centre) = self.centre(&leaf) {
                is_hex_centre[centre as usize] = true;
            }
            open.extend(self.open_faces(&leaf, corners));
        }
        let mut beyond_prisms = Vec::new();
        for notch in self.notches.values() {
            let Some(points) = self.points_of(notch) else { continue };
            prisms.nodes.extend(notch.prism(&points));
            open.push(notch.diagonal_face(&points));
            beyond_prisms.extend(self.beyond_ends(notch, &points));
        }
        for OpenFace { face, apex, is_quarter } in open {
            let Some(apex) = apex else { continue };
            let transition = self.transition(face, apex);
            pyramids.nodes.extend(transition.pyramids.as_flattened());
            transitions.nodes.extend(transition.tets.as_flattened());
            self.middles.extend(transition.middle);
            if is_quarter {
                on_quarters.extend((0..4).map(|left_out| {
                    let mut tet = face;
                    tet[left_out] = apex;
                    tet.sort_unstable();
                    tet
                }));
            }
        }
        let stands_for = |tet: &[u32; 4]| {
            let mut sorted = *tet;
            sorted.sort_unstable();
            tet.iter().any(|node| is_hex_centre[*node as usize])
                || on_quarters.contains(&sorted)
                || self.gives_way(tet)
        };
        let left = self.background.tets.iter().filter(|tet| !stands_for(tet));
        let mut stencils = Stencils::new(self.background, self.warped);
        left.chain(&beyond_prisms).for_each(|tet| stencils.fill(*tet));
        let mut tets = CellBlock { kind: ElementKind::Tet4, nodes: stencils.tets.into_flattened() };
        tets.nodes.extend(transitions.nodes);
        let cuts = self.warped.cuts.iter().map(|cut| cut.position);
        let points = self.background.points.iter().copied().chain(cuts).chain(self.middles).collect();
        let blocks = [hexes, prisms, pyramids, tets].into_iter().filter(|block| !block.is_empty()).collect();
        Mesh { points, blocks, ..Mesh::default() }
    }
}

/// The end of a cut-off pyramid, outward.
fn top_triangles([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}
