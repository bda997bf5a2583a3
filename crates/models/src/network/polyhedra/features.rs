//! Corners, edges and faces of bodies, and what lies beside each.

use std::ops::Range;

use souple_math::Vec3;

/// A body among others.
#[derive(Clone, Debug)]
pub enum Polyhedron {
    /// Triangles between rows, counterclockwise seen from outside.
    Faces(Vec<[u32; 3]>),
    /// Rows that are the centres of balls of a radius [m].
    Balls(Vec<u32>, f64),
}

impl Polyhedron {
    fn triangles(&self) -> &[[u32; 3]] {
        match self {
            Self::Faces(triangles) => triangles,
            Self::Balls(..) => &[],
        }
    }

    /// Ascending, each once.
    fn rows(&self) -> Vec<u32> {
        let mut rows = match self {
            Self::Faces(triangles) => triangles.as_flattened().to_vec(),
            Self::Balls(rows, _) => rows.clone(),
        };
        rows.sort_unstable();
        rows.dedup();
        rows
    }

    fn radius(&self) -> f64 {
        match self {
            Self::Faces(_) => 0.0,
            Self::Balls(_, radius) => *radius,
        }
    }
}

/// A mass that others may touch.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    pub row: u32,
    /// Among the neighbours of all corners, those that edges lead to.
    pub neighbours: Range<usize>,
}

/// What is between two triangles, or bounds one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    /// The third mass of the triangle in which it leads from the first end to the second, and of that in which it leads back.
    pub beside: [Option<u32>; 2],
}

/// What of the lists is a body's.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub corners: Range<usize>,
    pub faces: Range<usize>,
    pub edges: Range<usize>,
    pub radius: f64,
    /// Of its shortest edge at rest, or the radius [m].
    pub size: f64,
}

/// All bodies of a force.
#[derive(Debug, Default)]
pub(super) struct Features {
    pub corners: Vec<Corner>,
    pub neighbours: Vec<u32>,
    pub faces: Vec<[u32; 3]>,
    pub edges: Vec<Edge>,
    pub bodies: Vec<Body>,
    /// Pairs of bodies that share corners, ascending.
    joined: Vec<[u32; 2]>,
}

impl Features {
    /// Of bodies that rest at positions of rows.
    pub fn new(bodies: &[Polyhedron], positions: &[Vec3]) -> Self {
        let mut features = Self::default();
        bodies.iter().for_each(|body| features.add(body, positions));
        features.join();
        features
    }

    fn add(&mut self, body: &Polyhedron, positions: &[Vec3]) {
        let (corners, faces, edges) = (self.corners.len(), self.faces.len(), self.edges.len());
        self.faces.extend(body.triangles());
        self.edges.extend(edges_of(body.triangles()));
        let own = &self.edges[edges..];
        let mut ways: Vec<[u32; 2]> =
            own.iter().flat_map(|Edge { ends: [a, b], .. }| [[*a, *b], [*b, *a]]).collect();
        ways.sort_unstable();
        for row in body.rows() {
            let first = self.neighbours.len();
            let begin = ways.partition_point(|[from, _]| *from < row);
            let of_row = ways[begin..].iter().take_while(|[from, _]| *from == row);
            self.neighbours.extend(of_row.map(|[_, to]| *to));
            self.corners.push(Corner { row, neighbours: first..self.neighbours.len() });
        }
        let length = |edge: &Edge| {
            let [a, b] = edge.ends.map(|end| positions[end as usize]);
            (b - a).length()
        };
        let size = match own {
            [] => body.radius(),
            edges => edges.iter().map(length).fold(f64::INFINITY, f64::min),
        };
        self.bodies.push(Body {
            corners: corners..self.corners.len(),
            faces: faces..self.faces.len(),
            edges: edges..self.edges.len(),
            radius: body.radius(),
            size,
        });
    }

    /// Looks which bodies share corners.
    fn join(&mut self) {
        let mut owners: Vec<[u32; 2]> = Vec::new();
        for (body, features) in self.bodies.iter().enumerate() {
            owners.extend(self.corners[features.corners.clone()].iter().map(|it| [it.row, body as u32]));
        }
        owners.sort_unstable();
        for shared in owners.chunk_by(|a, b| a[0] == b[0]) {
            for (place, [_, one]) in shared.iter().enumerate() {
                self.joined.extend(shared[place + 1..].iter().map(|[_, other]| [*one, *other]));
            }
        }
        self.joined.sort_unstable();
        self.joined.dedup();
    }

    /// Whether two bodies, in ascending order, share corners.
    fn are_joined(&self, one: usize, other: usize) -> bool {
        self.joined.binary_search(&[one as u32, other as u32]).is_ok()
    }

    /// Whether two bodies, in ascending order, meet at all: one of them has faces, and they share no corners.
    pub fn may_meet(&self, [one, other]: [usize; 2]) -> bool {
        let has_faces = |body: usize| !self.bodies[body].faces.is_empty();
        (has_faces(one) || has_faces(other)) && !self.are_joined(one, other)
    }

    /// The body of a corner, an edge or a face.
    pub fn body_of(&self, place: usize, list: impl Fn(&Body) -> &Range<usize>) -> usize {
        self.bodies.partition_point(|body| list(body).end <= place)
    }

    pub fn neighbours_of(&self, corner: usize) -> impl Iterator<Item = usize> + '_ {
        self.neighbours[self.corners[corner].neighbours.clone()].iter().map(|row| *row as usize)
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.corners.as_slice())
            + size_of_val(self.neighbours.as_slice())
            + size_of_val(self.faces.as_slice())
            + size_of_val(self.edges.as_slice())
            + size_of_val(self.bodies.as_slice())
            + size_of_val(self.joined.as_slice())
    }
}

/// Each side of triangles once, in ascending order of its ends.
fn edges_of(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let mut sides: Vec<([u32; 2], usize, u32)> = Vec::with_capacity(3 * triangles.len());
    for [a, b, c] in triangles.iter().copied() {
        for (from, to, beside) in [(a, b, c), (b, c, a), (c, a, b)] {
            let leads_back = usize::from(from > to);
            sides.push(([from.min(to), from.max(to)], leads_back, beside));
        }
    }
    sides.sort_unstable();
    let edge = |same: &[([u32; 2], usize, u32)]| {
        let mut edge = Edge { ends: same[0].0, beside: [None; 2] };
        same.iter().for_each(|(_, side, beside)| edge.beside[*side] = Some(*beside));
        edge
    };
    sides.chunk_by(|one, other| one.0 == other.0).map(edge).collect()
}
