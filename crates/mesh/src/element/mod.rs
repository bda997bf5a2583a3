//! What an element is: reference nodes, basis, faces, edges, rules of quadrature, linear and quadratic alike.
//!
//! Shape functions are not written by hand: an element states a basis `m₁ … mₙ` as long as its list of nodes, and
//! `N_a = Σ_m C_am m(ξ)` with `C = V⁻ᵀ`, `V_am = m(ξ_a)`, so that `N_a(ξ_b) = δ_ab`. Adding an element is data in a
//! file and one line here (`docs/how-to-add-an-element.md`): shape functions, the nodes of curved faces, the mirrored
//! order and the regular cell follow from it.
//!
//! Node orders are those of VTK: corners, then the middles of edges in the order of the edges, then those of faces and of the
//! cell where an element has such. What lies where is read from the coordinates ([`ElementKind::place`]). Gmsh agrees for the
//! linear elements. One quirk: VTK's documentation draws
//! the wedge with the normal of its first triangle pointing outward, Gmsh (and VTK's own parametric coordinates)
//! with that normal pointing to the second triangle. We take the latter; files of the other kind are repaired
//! by [`crate::Mesh::validate`] as inverted cells.

mod edge;
mod hexahedron;
mod prism;
mod pyramid;
mod quadrilateral;
mod tetrahedron;
mod triangle;
mod unstrained;

use std::fmt;
use std::sync::LazyLock;

use souple_math::{Mat3, Vec3};
use souple_table::{Entry, Table, UnknownName, nearest};

use crate::quadrature::{QuadratureRule, RuleDefinition};

/// Most nodes of any element.
pub const MAX_NODES: usize = 27;

/// `√3/2`, height of the regular triangle.
const SQRT_3_2: f64 = 0.866_025_403_784_438_6;
/// `√(2/3)`, height of the regular tetrahedron.
const SQRT_2_3: f64 = 0.816_496_580_927_726;

/// Writes the kinds, the table and what is derived from their data from one list of names, node counts and entries.
macro_rules! elements {
    ($($Kind:ident: $nodes:literal, $entry:path;)+) => {
        /// The kind of a cell or of a facet of a surface.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum ElementKind { $($Kind),+ }

        /// All elements, in the order of [`ElementKind`].
        pub static ELEMENTS: Table<&'static Element> =
            Table { kind: "element", entries: &[$(&$entry),+] };

        impl ElementKind {
            pub const ALL: &[Self] = &[$(Self::$Kind),+];

            pub const fn node_count(self) -> usize {
                match self { $(Self::$Kind => $nodes),+ }
            }
        }

        /// What follows from the data of each element, computed at first use.
        static DERIVED: [LazyLock<Derived>; ElementKind::ALL.len()] =
            [$(LazyLock::new(|| $entry.build.derive())),+];
    };
}

elements! {
    Edge2: 2, edge::EDGE2;
    Edge3: 3, edge::EDGE3;
    Tri3: 3, triangle::TRI3;
    Tri6: 6, triangle::TRI6;
    Quad4: 4, quadrilateral::QUAD4;
    Quad8: 8, quadrilateral::QUAD8;
    Quad9: 9, quadrilateral::QUAD9;
    Tet4: 4, tetrahedron::TET4;
    Tet10: 10, tetrahedron::TET10;
    Hex8: 8, hexahedron::HEX8;
    Hex20: 20, hexahedron::HEX20;
    Hex27: 27, hexahedron::HEX27;
    Prism6: 6, prism::PRISM6;
    Prism15: 15, prism::PRISM15;
    Pyramid5: 5, pyramid::PYRAMID5;
    Pyramid13: 13, pyramid::PYRAMID13;
}

/// `ξ^x η^y ζ^z / (1 - ζ)^w` for powers `[x, y, z, w]`; only pyramids have `w ≠ 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Monomial(pub [u8; 4]);

/// Where a node lies in its element: at a corner, or in the middle of a part of so many dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NodePlace {
    Corner,
    Edge,
    /// Of a volume a face, of a surface element itself.
    Face,
    Inside,
}

/// A face of a cell (a side of a plane one): its nodes in the order of its own element, normal outward by the
/// right-hand rule.
#[derive(Clone, Debug)]
pub struct Face {
    pub kind: ElementKind,
    pub nodes: Vec<u8>,
}

/// The data of one element.
#[derive(Debug)]
pub struct Element {
    pub kind: ElementKind,
    /// The linear element of the same corners.
    pub corners: ElementKind,
    /// Dimension of the reference cell: 1, 2 or 3.
    pub dimension: usize,
    /// Reference coordinates of the nodes: corners, then middles of edges in the order of these, of faces and of the cell, where it has
    /// such; zero beyond the dimension.
    pub nodes: &'static [[f64; 3]],
    /// Corners of the regular cell, all edges of length one: the best quality there is.
    pub regular: &'static [[f64; 3]],
    /// As many functions as nodes.
    pub basis: &'static [Monomial],
    /// Corners of each face, normal outward; none for edges.
    pub faces: &'static [&'static [u8]],
    /// Corners of each edge.
    pub edges: &'static [[u8; 2]],
    /// Order of the corners of the mirrored cell: turns an inverted cell into a good one.
    pub mirrored: &'static [u8],
    /// Volume (area, length) of the reference cell.
    pub measure: f64,
    /// By number of points.
    pub rules: &'static [RuleDefinition],
    /// Exact for the stiffness of linear elasticity on an affine cell.
    pub default_rule: &'static str,
    /// Exact for the energy of St. Venant–Kirchhoff (degree four in `F`) on an affine cell.
    pub full_rule: &'static str,
    /// Exact for products of two shape functions on an affine cell.
    pub mass_rule: &'static str,
    /// Smallest slack of the inequalities that define the reference cell: negative outside.
    pub slack: fn(Vec3) -> f64,
}

/// What follows from the data of an element.
#[derive(Debug)]
struct Derived {
    /// `C_am` by rows: coefficients of shape function `a`.
    coefficients: Vec<f64>,
    rules: Vec<QuadratureRule>,
    /// Of each node beyond the corners: the corners in whose middle it is.
    middles: Vec<Vec<u8>>,
    faces: Vec<Face>,
    /// [`Element::mirrored`] for all nodes.
    mirrored: Vec<u8>,
}

impl ElementKind {
    /// 1 for edges, 2 for surface elements, 3 for volumes.
    pub fn dimension(self) -> usize {
        self.element().dimension
    }

    pub fn element(self) -> &'static Element {
        ELEMENTS.entries[self as usize].build
    }

    pub fn name(self) -> &'static str {
        ELEMENTS.entries[self as usize].name
    }

    /// # Errors
    /// The name is unknown; the error holds the nearest one.
    pub fn from_name(name: &str) -> Result<Self, UnknownName> {
        ELEMENTS.find(name).map(|entry| entry.build.kind)
    }

    fn derived(self) -> &'static Derived {
        &DERIVED[self as usize]
    }

    /// Whether all nodes are corners: edges are straight then, and triangles flat.
    pub fn is_linear(self) -> bool {
        self.corners() == self
    }

    /// The linear element of the same corners.
    pub fn corners(self) -> Self {
        self.element().corners
    }

    pub fn corner_count(self) -> usize {
        self.corners().node_count()
    }

    /// Nodes at the least and at the greatest corner of the reference cell, where that is a box whose corners are all nodes there are:
    /// cells of one that lie along the axes of the world are mapped by three numbers.
    pub fn box_corners(self) -> Option<[usize; 2]> {
        let Element { dimension, nodes, .. } = self.element();
        let of_box = |node: &[f64; 3]| node[..*dimension].iter().all(|coordinate| coordinate.abs() == 1.0);
        let is_box = *dimension > 1 && nodes.len() == 1 << dimension && nodes.iter().all(of_box);
        let at = |corner: f64| {
            nodes.iter().position(|node| node[..*dimension].iter().all(|coordinate| *coordinate == corner))
        };
        is_box.then_some([at(-1.0)?, at(1.0)?])
    }

    /// Of each node beyond the corners, in their order: the corners of the part in whose middle it is.
    pub fn middles(self) -> &'static [Vec<u8>] {
        &self.derived().middles
    }

    /// Where a node lies.
    pub fn place(self, node: usize) -> NodePlace {
        let part = node.checked_sub(self.corner_count()).and_then(|middle| self.middles().get(middle));
        match part.map_or(1, Vec::len) {
            1 => NodePlace::Corner,
            2 => NodePlace::Edge,
            all if self.dimension() == 3 && all == self.corner_count() => NodePlace::Inside,
            _ => NodePlace::Face,
        }
    }

    /// Where the last of its nodes lies: in the middle of what it has nodes at most.
    pub fn last_place(self) -> NodePlace {
        self.place(self.node_count() - 1)
    }

    /// The element of the same corners with the most nodes of those that have none in the middle of more than `most`.
    pub fn with_middles(self, most: NodePlace) -> Self {
        let fits = |kind: &Self| kind.corners() == self.corners() && kind.last_place() <= most;
        let fitting = Self::ALL.iter().copied().filter(fits);
        fitting.max_by_key(|kind| kind.node_count()).unwrap_or(self.corners())
    }

    /// The nodes of an element by their places: corners, middles of edges, those of faces and of the cell.
    pub fn by_place<T>(self, nodes: &[T]) -> [&[T]; 3] {
        let beyond = self.middles().iter().filter(|part| part.len() == 2).count();
        let (corners, middles) = nodes.split_at(self.corner_count().min(nodes.len()));
        let (of_edges, others) = middles.split_at(beyond.min(middles.len()));
        [corners, of_edges, others]
    }

    /// Faces of volumes, sides of surface elements.
    pub fn faces(self) -> &'static [Face] {
        &self.derived().faces
    }

    /// Node order of the mirrored cell: turns an inverted cell into a good one.
    pub fn mirrored(self) -> &'static [u8] {
        &self.derived().mirrored
    }

    /// Nodes of the regular cell, all edges straight and of length one: the best quality there is.
    pub fn regular(self) -> Vec<Vec3> {
        let corners: Vec<Vec3> = self.element().regular.iter().map(|x| Vec3::from_array(*x)).collect();
        self.element()
            .nodes
            .iter()
            .map(|xi| self.corners().position(&corners, Vec3::from_array(*xi)))
            .collect()
    }

    pub fn edges(self) -> &'static [[u8; 2]] {
        self.element().edges
    }

    /// Values of the shape functions at `ξ`, one for each node.
    pub fn shape(self, xi: Vec3) -> NodeValues<f64> {
        self.element().shape(xi)
    }

    /// Gradients `∂N_a/∂ξ` at `ξ`, one for each node.
    pub fn shape_gradients(self, xi: Vec3) -> NodeValues<Vec3> {
        self.element().shape_gradients(xi)
    }

    /// Each node's shape function as coefficients of the powers of its monomials; what rounding leaves of a zero is left
    /// out.
    pub fn shape_polynomials(self) -> Vec<Vec<(f64, [u8; 4])>> {
        let basis = self.element().basis;
        let terms = |row: &[f64]| {
            let known = row.iter().zip(basis).filter(|(coefficient, _)| coefficient.abs() > 1e-12);
            known.map(|(coefficient, monomial)| (*coefficient, monomial.0)).collect()
        };
        self.derived().coefficients.chunks(basis.len()).map(terms).collect()
    }

    /// All rules of quadrature, by number of points.
    pub fn rules(self) -> &'static [QuadratureRule] {
        &self.derived().rules
    }

    /// The rule that integrates the stiffness of linear elasticity exactly on an affine cell: the usual choice.
    pub fn default_rule(self) -> &'static QuadratureRule {
        self.own_rule(self.element().default_rule)
    }

    /// The rule that integrates the energy of St. Venant–Kirchhoff exactly on an affine cell.
    pub fn full_rule(self) -> &'static QuadratureRule {
        self.own_rule(self.element().full_rule)
    }

    /// The rule that integrates the consistent mass exactly on an affine cell.
    pub fn mass_rule(self) -> &'static QuadratureRule {
        self.own_rule(self.element().mass_rule)
    }

    fn own_rule(self, name: &str) -> &'static QuadratureRule {
        self.rules().iter().find(|rule| rule.name == name).expect("an element names one of its own rules")
    }

    /// # Errors
    /// The element has no rule of that name; the error lists those it has.
    pub fn rule(self, name: &str) -> Result<&'static QuadratureRule, UnknownName> {
        let names = || self.rules().iter().map(|rule| rule.name);
        self.rules().iter().find(|rule| rule.name == name).ok_or_else(|| UnknownName {
            kind: "quadrature rule",
            name: name.to_owned(),
            nearest: nearest(name, names()).map(str::to_owned),
            known: names().map(str::to_owned).collect(),
        })
    }

    /// The rule with the fewest points that integrates polynomials of total degree `degree` exactly.
    pub fn rule_of_degree(self, degree: usize) -> Option<&'static QuadratureRule> {
        self.rules().iter().find(|rule| rule.degree >= degree)
    }

    /// `∂x/∂ξ` of a cell with its nodes at `positions`, column `i` is `∂x/∂ξᵢ`. For surface elements the third
    /// column is the unit normal, for edges the second and third are unit normals: the determinant is the change of
    /// area, of length.
    pub fn jacobian(self, positions: &[Vec3], xi: Vec3) -> Mat3 {
        let mut columns = [Vec3::ZERO; 3];
        for (position, gradient) in positions.iter().zip(self.shape_gradients(xi).iter()) {
            for axis in 0..3 {
                columns[axis] += *position * gradient[axis];
            }
        }
        match self.dimension() {
            1 => {
                // the axis that the edge is farthest from gives the first normal
                let t = columns[0].to_array().map(f64::abs);
                let axis = (0..3).min_by(|a, b| t[*a].total_cmp(&t[*b])).unwrap_or(0);
                columns[1] = columns[0].cross(Vec3::AXES[axis]).try_normalised().unwrap_or(Vec3::ZERO);
                columns[2] = columns[0].cross(columns[1]).try_normalised().unwrap_or(Vec3::ZERO);
            }
            2 => columns[2] = columns[0].cross(columns[1]).try_normalised().unwrap_or(Vec3::ZERO),
            _ => {}
        }
        Mat3 { columns }
    }

    /// `x(ξ) = Σ N_a(ξ) x_a`.
    pub fn position(self, positions: &[Vec3], xi: Vec3) -> Vec3 {
        positions.iter().zip(self.shape(xi).iter()).map(|(position, weight)| *position * *weight).sum()
    }
}

impl fmt::Display for ElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One value for each node of an element, without allocation; reads as a slice.
#[derive(Clone, Copy, Debug)]
pub struct NodeValues<T> {
    values: [T; MAX_NODES],
    len: usize,
}

impl<T> std::ops::Deref for NodeValues<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.values[..self.len]
    }
}

impl Element {
    // N_a = Σ_m C_am m(ξ)
    fn shape(&self, xi: Vec3) -> NodeValues<f64> {
        let coefficients = &self.kind.derived().coefficients;
        let mut shape = NodeValues { values: [0.0; MAX_NODES], len: self.nodes.len() };
        for (m, monomial) in self.basis.iter().enumerate() {
            let value = monomial.value(xi);
            for a in 0..shape.len {
                shape.values[a] += coefficients[a * shape.len + m] * value;
            }
        }
        shape
    }

    fn shape_gradients(&self, xi: Vec3) -> NodeValues<Vec3> {
        let coefficients = &self.kind.derived().coefficients;
        let mut shape = NodeValues { values: [Vec3::ZERO; MAX_NODES], len: self.nodes.len() };
        for (m, monomial) in self.basis.iter().enumerate() {
            let gradient = monomial.gradient(xi);
            for a in 0..shape.len {
                shape.values[a] += gradient * coefficients[a * shape.len + m];
            }
        }
        shape
    }

    fn derive(&self) -> Derived {
        let rules = self.rules.iter().map(|definition| definition.build()).collect();
        Derived {
            coefficients: inverse_transposed(&self.vandermonde(), self.nodes.len()),
            rules,
            middles: (self.corners.node_count()..self.nodes.len())
                .map(|node| self.part_around(node))
                .collect(),
            faces: self.faces.iter().map(|corners| self.face(corners)).collect(),
            mirrored: self.nodes_of(self.kind, self.mirrored).expect("the mirrored cell has the same nodes"),
        }
    }

    /// The corners in whose middle a node beyond them is: of an edge, of a face, or all.
    fn part_around(&self, node: usize) -> Vec<u8> {
        let at = |corner: &u8| Vec3::from_array(self.nodes[usize::from(*corner)]);
        let all: Vec<u8> = (0..self.corners.node_count() as u8).collect();
        let edges = self.edges.iter().map(|edge| edge.as_slice());
        let mut parts = edges.chain(self.faces.iter().copied()).chain([all.as_slice()]);
        let is_middle = |part: &&[u8]| {
            let middle = part.iter().map(at).sum::<Vec3>() / part.len() as f64;
            (middle - Vec3::from_array(self.nodes[node])).length() < 1e-9
        };
        parts.find(is_middle).expect("nodes are corners and middles of edges, of faces and of cells").to_vec()
    }

    /// The face of given corners: the element with the most nodes of which each is a node of this one.
    fn face(&self, corners: &[u8]) -> Face {
        let is_face = |kind: &&ElementKind| {
            let element = kind.element();
            element.dimension + 1 == self.dimension && element.corners.node_count() == corners.len()
        };
        let faces = ElementKind::ALL.iter().copied().filter(|kind| is_face(&kind));
        let fitting = faces.filter_map(|kind| Some(Face { kind, nodes: self.nodes_of(kind, corners)? }));
        fitting.max_by_key(|face| face.nodes.len()).expect("faces of elements are elements of the table")
    }

    /// The nodes of this element on which the nodes of `part` fall when its corners lie on `corners`; `None` where one of them
    /// falls on none.
    fn nodes_of(&self, part: ElementKind, corners: &[u8]) -> Option<Vec<u8>> {
        let node = |a: u8| Vec3::from_array(self.nodes[usize::from(a)]);
        let corners: Vec<Vec3> = corners.iter().map(|a| node(*a)).collect();
        let find = |xi: &[f64; 3]| {
            // the linear element of the corners may be this one, whose data are being derived: written out
            let place = part.corners().element().straight(&corners, Vec3::from_array(*xi));
            (0..self.nodes.len() as u8).find(|a| (node(*a) - place).length() < 1e-9)
        };
        part.element().nodes.iter().map(find).collect()
    }

    /// `Σ N_a(ξ) x_a` of a linear element.
    fn straight(&self, corners: &[Vec3], xi: Vec3) -> Vec3 {
        let coefficients = inverse_transposed(&self.vandermonde(), self.nodes.len());
        let values: Vec<f64> = self.basis.iter().map(|monomial| monomial.value(xi)).collect();
        let weight = |row: &[f64]| row.iter().zip(&values).map(|(c, value)| c * value).sum::<f64>();
        corners.iter().zip(coefficients.chunks(values.len())).map(|(x, row)| *x * weight(row)).sum()
    }

    /// `V_am = m(ξ_a)`, by rows.
    fn vandermonde(&self) -> Vec<f64> {
        let value = |node: &[f64; 3], m: &Monomial| m.value(Vec3::from_array(*node));
        self.nodes.iter().flat_map(|node| self.basis.iter().map(move |m| value(node, m))).collect()
    }
}

impl Monomial {
    pub fn value(self, xi: Vec3) -> f64 {
        let Self([x, y, z, w]) = self;
        power(xi.x, x) * power(xi.y, y) * power(xi.z, z) * inverse_height(xi, w)
    }

    /// `∂m/∂ξ`. At the apex of a pyramid, where it depends on the direction, the limit along the axis.
    pub fn gradient(self, xi: Vec3) -> Vec3 {
        let Self([x, y, z, w]) = self;
        let (px, py, pz) = (power(xi.x, x), power(xi.y, y), power(xi.z, z));
        let pw = inverse_height(xi, w);
        // ∂(1-ζ)^-w/∂ζ = w (1-ζ)^-(w+1)
        let dw = if w == 0 { 0.0 } else { f64::from(w) * inverse_height(xi, w + 1) };
        Vec3::new(
            slope(xi.x, x) * py * pz * pw,
            px * slope(xi.y, y) * pz * pw,
            px * py * (slope(xi.z, z) * pw + pz * dw),
        )
    }
}

fn power(base: f64, exponent: u8) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

fn slope(base: f64, exponent: u8) -> f64 {
    if exponent == 0 { 0.0 } else { f64::from(exponent) * power(base, exponent - 1) }
}

/// `(1-ζ)^-w`; zero at the apex, where it only multiplies functions that vanish there faster.
fn inverse_height(xi: Vec3, w: u8) -> f64 {
    let height = 1.0 - xi.z;
    if w == 0 {
        1.0
    } else if height == 0.0 {
        0.0
    } else {
        power(1.0 / height, w)
    }
}

/// `V⁻ᵀ` by Gauss–Jordan elimination with partial pivoting.
fn inverse_transposed(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut left = matrix.to_vec();
    let mut right = vec![0.0; n * n];
    for i in 0..n {
        right[i * n + i] = 1.0;
    }
    for column in 0..n {
        let pivot = (column..n)
            .max_by(|a, b| left[a * n + column].abs().total_cmp(&left[b * n + column].abs()))
            .expect("rows remain below the diagonal");
        assert!(left[pivot * n + column].abs() > 1e-9, "the basis of an element does not span its nodes");
        for j in 0..n {
            left.swap(pivot * n + j, column * n + j);
            right.swap(pivot * n + j, column * n + j);
        }
        let scale = 1.0 / left[column * n + column];
        for j in 0..n {
            left[column * n + j] *= scale;
            right[column * n + j] *= scale;
        }
        for row in (0..n).filter(|row| *row != column) {
            let factor = left[row * n + column];
            for j in 0..n {
                left[row * n + j] -= factor * left[column * n + j];
                right[row * n + j] -= factor * right[column * n + j];
            }
        }
    }
    (0..n * n).map(|index| right[(index % n) * n + index / n]).collect()
}

/// The corners, then the middle of each edge.
const fn with_middles<const C: usize, const E: usize, const N: usize>(
    corners: &[[f64; 3]; C],
    edges: &[[u8; 2]; E],
) -> [[f64; 3]; N] {
    assert!(N == C + E, "one node for each corner and each edge");
    let mut nodes = [[0.0; 3]; N];
    let mut a = 0;
    while a < N {
        let mut axis = 0;
        while axis < 3 {
            nodes[a][axis] = if a < C {
                corners[a][axis]
            } else {
                let [from, to] = edges[a - C];
                0.5 * (corners[from as usize][axis] + corners[to as usize][axis])
            };
            axis += 1;
        }
        a += 1;
    }
    nodes
}

/// The nodes of an element, and more.
const fn followed_by<const N: usize>(nodes: &[[f64; 3]], others: &[[f64; 3]]) -> [[f64; 3]; N] {
    assert!(N == nodes.len() + others.len(), "all of both");
    let mut all = [[0.0; 3]; N];
    let mut a = 0;
    while a < N {
        all[a] = if a < nodes.len() { nodes[a] } else { others[a - nodes.len()] };
        a += 1;
    }
    all
}

/// The entry of an element in the table.
type ElementEntry = Entry<&'static Element>;

#[cfg(test)]
mod tests;
