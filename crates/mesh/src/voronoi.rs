//! Voronoi cells of the points of a mesh, restricted to its tetrahedra or triangles.
//!
//! A point's cell is all that is nearer to it than to any other point. Where angles are obtuse it leaves the elements around
//! its point, and the body; here each element is cut by the planes half way between points, so that the cells of all
//! points fill the body and nothing else. (Debunne 2000, 4 §4.3; cut element by element, as the specification's 2.8.6 has it.)
//!
//! A triangle is cut as a prism on it, of which heights are divided out again: the planes half way between points of a plane
//! stand upright on it.

use std::collections::BTreeMap;

use souple_math::Vec3;

use crate::{ElementKind, Mesh};

/// Vertices this near to a plane, relative to the element, are on it.
const ON_PLANE: f64 = 1e-11;

/// What of the body belongs to which point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VoronoiCells {
    /// Of each point's cell [m³]; of triangles [m²].
    pub volumes: Vec<f64>,
    /// Pairs of points, ascending, with the area of what parts their cells [m²]; of triangles its length [m].
    pub facets: Vec<([u32; 2], f64)>,
    /// Boundaries of cells inside elements.
    pub walls: Vec<Wall>,
    /// What each element has of cells.
    pub parts: Vec<Part>,
}

/// What lies in one element of a point's cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    pub element: u32,
    pub point: u32,
    /// [m³]; of triangles [m²].
    pub volume: f64,
}

/// The boundary of a point's cell inside an element; what lies on the element's own faces is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    pub element: u32,
    pub point: u32,
    /// Sum of its area vectors, outward of the cell [m²]; of triangles of its lengths times normals [m].
    pub area: Vec3,
}

/// A convex part of an element, between itself and planes.
#[derive(Clone, Debug, Default)]
struct Polytope {
    faces: Vec<Facet>,
}

#[derive(Clone, Debug)]
struct Facet {
    /// Counterclockwise from outside.
    corners: Vec<Vec3>,
    /// The point beyond, where it lies half way to one.
    beyond: Option<u32>,
}

impl Facet {
    /// `½ Σ (a - o) × (b - o)`.
    fn area(&self) -> Vec3 {
        let origin = self.corners[0];
        let pairs = self.corners[1..].windows(2);
        pairs.map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum::<Vec3>() * 0.5
    }
}

impl Polytope {
    fn new(faces: Vec<Vec<Vec3>>) -> Self {
        Self { faces: faces.into_iter().map(|corners| Facet { corners, beyond: None }).collect() }
    }

    fn volume(&self) -> f64 {
        let Some(origin) = self.faces.first().map(|face| face.corners[0]) else { return 0.0 };
        self.faces.iter().map(|face| (face.corners[0] - origin).dot(face.area())).sum::<f64>() / 3.0
    }

    fn farthest_sq(&self, from: Vec3) -> f64 {
        let corners = self.faces.iter().flat_map(|face| &face.corners);
        corners.map(|corner| (*corner - from).length_sq()).fold(0.0, f64::max)
    }

    /// Leaves what is on the near side of the plane half way from `near` to `far`, which is point `number`.
    fn cut(&mut self, (own, near): (u32, Vec3), far: Vec3, number: u32, on_plane: f64) {
        let across = far - near;
        if across == Vec3::ZERO {
            if number < own {
                self.faces.clear();
            }
            return;
        }
        let normal = across * (1.0 / across.length());
        let middle = (near + far) * 0.5;
        let height = |x: Vec3| {
            let height = (x - middle).dot(normal);
            if height.abs() <= on_plane { 0.0 } else { height }
        };
        let heights = || self.faces.iter().flat_map(|face| &face.corners).map(|corner| height(*corner));
        if heights().all(|height| height <= 0.0) {
            // a face of the element may lie half way between two points
            let on_it = |face: &&mut Facet| face.corners.iter().all(|corner| height(*corner) == 0.0);
            for face in self.faces.iter_mut().filter(on_it) {
                face.beyond.get_or_insert(number);
            }
            return;
        }
        if heights().all(|height| height >= 0.0) {
            self.faces.clear();
            return;
        }
        let mut rim: Vec<Vec3> = Vec::new();
        self.faces.retain_mut(|face| {
            let mut kept = Vec::with_capacity(face.corners.len() + 1);
            for (at, a) in face.corners.iter().enumerate() {
                let b = face.corners[(at + 1) % face.corners.len()];
                let (from, to) = (height(*a), height(b));
                if from <= 0.0 {
                    kept.push(*a);
                }
                if from == 0.0 {
                    rim.push(*a);
                }
                if from * to < 0.0 {
                    // from the same end for both faces of an edge: the same point, to the last bit
                    let (low, high, at) = if from < 0.0 { (*a, b, from) } else { (b, *a, to) };
                    let other = if from < 0.0 { to } else { from };
                    let cut = low + (high - low) * (at / (at - other));
                    kept.push(cut);
                    rim.push(cut);
                }
            }
            face.corners = kept;
            let lies_on_it = face.corners.iter().all(|corner| height(*corner) == 0.0);
            face.corners.len() >= 3 && !lies_on_it
        });
        let rim = around(rim, normal, on_plane);
        if rim.len() >= 3 {
            self.faces.push(Facet { corners: rim, beyond: Some(number) });
        }
    }
}

/// The corners of a convex face in turn, counterclockwise about its normal.
fn around(mut corners: Vec<Vec3>, normal: Vec3, same: f64) -> Vec<Vec3> {
    let centre = corners.iter().copied().sum::<Vec3>() / corners.len().max(1) as f64;
    let x = normal.any_orthogonal();
    let y = normal.cross(x);
    let angle = |corner: &Vec3| libm::atan2((*corner - centre).dot(y), (*corner - centre).dot(x));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    corners.dedup_by(|a, b| (*a - *b).length() <= same);
    while corners.len() > 1 && (corners[0] - corners[corners.len() - 1]).length() <= same {
        corners.pop();
    }
    corners
}

/// Points by cubes of space, for those near to one of them.
struct Near<'a> {
    points: &'a [Vec3],
    edge: f64,
    of_cube: BTreeMap<[i64; 3], Vec<u32>>,
}

impl<'a> Near<'a> {
    fn new(points: &'a [Vec3], edge: f64) -> Self {
        let mut of_cube: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
        for (number, point) in (0..).zip(points) {
            of_cube.entry(Self::cube(*point, edge)).or_default().push(number);
        }
        Self { points, edge, of_cube }
    }

    fn cube(point: Vec3, edge: f64) -> [i64; 3] {
        point.to_array().map(|x| (x / edge).floor() as i64)
    }

    /// Squared distances and numbers of the points within `radius` of one, without itself, from near to far.
    fn within(&self, of: u32, radius: f64, found: &mut Vec<(f64, u32)>) {
        found.clear();
        let centre = self.points[of as usize];
        let reach = Vec3::new(radius, radius, radius);
        let (low, high) = (Self::cube(centre - reach, self.edge), Self::cube(centre + reach, self.edge));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for (_, numbers) in self.of_cube.range([x, y, low[2]]..=[x, y, high[2]]) {
                    for number in numbers.iter().filter(|number| **number != of) {
                        let distance_sq = (self.points[*number as usize] - centre).length_sq();
                        if distance_sq <= radius * radius {
                            found.push((distance_sq, *number));
                        }
                    }
                }
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
}

/// An element as what is cut, its size, and what heights are divided by.
fn element(mesh: &Mesh, kind: ElementKind, nodes: &[u32]) -> Option<(Polytope, f64, f64)> {
    let corner = |at: usize| mesh.points[nodes[at] as usize];
    let (a, b, c) = (corner(0), corner(1), corner(2));
    let size = (0..nodes.len()).map(|at| (corner(at) - a).length()).fold(0.0, f64::max);
    match kind {
        ElementKind::Tet4 => {
            let d = corner(3);
            let (b, c) = if (b - a).cross(c - a).dot(d - a) < 0.0 { (c, b) } else { (b, c) };
            let faces = vec![vec![a, c, b], vec![a, b, d], vec![b, c, d], vec![c, a, d]];
            Some((Polytope::new(faces), size, 1.0))
        }
        ElementKind::Tri3 => {
            let normal = (b - a).cross(c - a);
            let up = normal * (0.5 * size / normal.length());
            let [low, high] = [-up, up].map(|shift| [a + shift, b + shift, c + shift]);
            let sides = (0..3).map(|at| {
                let next = (at + 1) % 3;
                vec![low[at], low[next], high[next], high[at]]
            });
            let ends = [vec![low[2], low[1], low[0]], high.to_vec()];
            Some((Polytope::new(ends.into_iter().chain(sides).collect()), size, size))
        }
        _ => None,
    }
}

/// Whether all triangles lie in the plane of the first, but for rounding; of meshes without triangles it is so.
fn lies_in_a_plane(mesh: &Mesh) -> bool {
    let corners = |nodes: &[u32]| [0, 1, 2].map(|at: usize| mesh.points[nodes[at] as usize]);
    let Some(first) = mesh.cells().find(|cell| cell.kind == ElementKind::Tri3) else { return true };
    let [a, b, c] = corners(first.nodes);
    let Some(normal) = (b - a).cross(c - a).try_normalised() else { return false };
    let size = mesh.points.iter().map(|point| (*point - a).largest_component()).fold(0.0, f64::max);
    let triangles = mesh.cells().filter(|cell| cell.kind == ElementKind::Tri3);
    triangles.flat_map(|cell| corners(cell.nodes)).all(|x| (x - a).dot(normal).abs() <= ON_PLANE * size)
}

impl VoronoiCells {
    /// Of a mesh of linear tetrahedra, or of linear triangles in one plane; `None` of others. Of points at one place the first has the cell.
    pub fn of(mesh: &Mesh) -> Option<Self> {
        if !lies_in_a_plane(mesh) {
            return None;
        }
        let mut cells = Self { volumes: vec![0.0; mesh.points.len()], ..Self::default() };
        let mut facets: BTreeMap<[u32; 2], f64> = BTreeMap::new();
        let near = Near::new(&mesh.points, crate::coarsen::mean_edge(mesh).max(f64::MIN_POSITIVE));
        let mut neighbours = Vec::new();
        for (number, cell) in (0..).zip(mesh.cells()) {
            let (whole, size, height) = element(mesh, cell.kind, cell.nodes)?;
            // whose cells come in: those of the corners, and on from each to those beyond its walls
            let mut owners: Vec<u32> = cell.nodes.to_vec();
            let mut next = 0;
            while let Some(owner) = owners.get(next).copied() {
                next += 1;
                let place = mesh.points[owner as usize];
                let mut part = whole.clone();
                near.within(owner, 2.0 * part.farthest_sq(place).sqrt(), &mut neighbours);
                for (distance_sq, other) in &neighbours {
                    // what is farther than twice the farthest corner cuts nothing off
                    if part.faces.is_empty() || *distance_sq > 4.0 * part.farthest_sq(place) {
                        break;
                    }
                    part.cut((owner, place), mesh.points[*other as usize], *other, ON_PLANE * size);
                }
                let mut area = Vec3::ZERO;
                for face in &part.faces {
                    let Some(beyond) = face.beyond else { continue };
                    area += face.area() / height;
                    *facets.entry([owner, beyond]).or_insert(0.0) += face.area().length() / height;
                    if !owners.contains(&beyond) {
                        owners.push(beyond);
                    }
                }
                let volume = part.volume() / height;
                cells.volumes[owner as usize] += volume;
                if volume > 0.0 {
                    cells.parts.push(Part { element: number, point: owner, volume });
                }
                if area != Vec3::ZERO {
                    cells.walls.push(Wall { element: number, point: owner, area });
                }
            }
        }
        // seen from both sides; what one side alone sees lies on the surface of the body
        cells.facets = facets
            .iter()
            .filter(|([a, b], _)| a < b)
            .filter_map(|([a, b], area)| Some(([*a, *b], area.min(*facets.get(&[*b, *a])?))))
            .collect();
        Some(cells)
    }
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    fn cube(cells: f64) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector([1.0; 3]))
            .with("cells", Value::Vector([cells; 3]))
            .with("element", Value::Text("tet4"));
        crate::generate("box", values).unwrap()
    }

    /// A cube with its inner points moved, so that circumcentres leave their tetrahedra.
    fn crooked() -> Mesh {
        let mut mesh = cube(4.0);
        for p in &mut mesh.points {
            let inside = [p.x, p.y, p.z].iter().all(|x| *x > 0.01 && *x < 0.99);
            let s = *p * 9.0;
            if inside {
                *p += Vec3::new((7.0 * s.y + s.z).sin(), (5.0 * s.x).cos(), (3.0 * s.x - s.y).sin()) * 0.07;
            }
        }
        mesh
    }

    /// The cells fill the body; each part of it is the nearest point's, by sampling; the walls in an element close with the
    /// faces that are left out.
    #[test]
    fn cells_fill_the_body() {
        for mesh in [cube(3.0), crooked()] {
            let cells = VoronoiCells::of(&mesh).unwrap();
            // a few thousand parts, each rounded
            assert!((cells.volumes.iter().sum::<f64>() - mesh.volume()).abs() < 1e-12);
            // walls of all cells between the same two points are opposite
            let mut of_element: BTreeMap<u32, Vec3> = BTreeMap::new();
            for wall in &cells.walls {
                *of_element.entry(wall.element).or_default() += wall.area;
            }
            assert!(of_element.values().all(|sum| sum.length() < 1e-14), "{of_element:?}");
            let count = 40;
            let mut sampled = vec![0.0; mesh.points.len()];
            for number in 0..count * count * count {
                let at = |part: usize| ((part % count) as f64 + 0.5) / count as f64;
                let place = Vec3::new(at(number), at(number / count), at(number / count / count));
                let nearest = (0..mesh.points.len()).min_by(|a, b| {
                    let distance = |at: usize| (mesh.points[at] - place).length_sq();
                    distance(*a).total_cmp(&distance(*b))
                });
                sampled[nearest.unwrap()] += 1.0 / (count * count * count) as f64;
            }
            for (exact, sampled) in cells.volumes.iter().zip(&sampled) {
                // samples on the boundary of a cell of area 6 V^(2/3), each 1/64000
                let boundary = 6.0 * exact.powf(2.0 / 3.0) / count as f64;
                assert!((exact - sampled).abs() < 0.25 * boundary, "{exact} {sampled}");
            }
        }
    }

    /// V-15: of the cube of nine points the one in the middle has the truncated octahedron of half the volume, though its
    /// whole cell leaves the body nowhere and those of the corners do.
    #[test]
    fn nine_points() {
        let mut points: Vec<Vec3> = (0..8)
            .map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)))
            .collect();
        points.push(Vec3::new(0.5, 0.5, 0.5));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        let nodes = halves.flat_map(|[a, b, c]| [a, c, b, 8]).collect();
        let mesh = Mesh::new(points, ElementKind::Tet4, nodes);
        let cells = VoronoiCells::of(&mesh).unwrap();
        assert!((cells.volumes[8] - 0.5).abs() < 1e-14, "{}", cells.volumes[8]);
        for corner in &cells.volumes[..8] {
            assert!((corner - 0.0625).abs() < 1e-14, "{corner}");
        }
        // hexagons of the truncated octahedron, edge √2/4
        let hexagon = 1.5 * 3.0_f64.sqrt() / 8.0;
        let to_centre = cells.facets.iter().filter(|([_, to], _)| *to == 8);
        assert_eq!(to_centre.clone().count(), 8);
        to_centre.for_each(|(_, area)| assert!((area - hexagon).abs() < 1e-14, "{area}"));
    }

    /// V-16: in a corner tetrahedron of three edges `h` at right angles the corner's wall is `h²/8 (1, 1, 1)`, three quarters
    /// of `-V α = h²/6 (1, 1, 1)`.
    #[test]
    fn a_corner() {
        let points = vec![Vec3::ZERO, Vec3::AXES[0], Vec3::AXES[1], Vec3::AXES[2]];
        let mesh = Mesh::new(points, ElementKind::Tet4, vec![0, 1, 2, 3]);
        let cells = VoronoiCells::of(&mesh).unwrap();
        let wall = cells.walls.iter().find(|wall| wall.point == 0).unwrap();
        assert!((wall.area - Vec3::new(1.0, 1.0, 1.0) * 0.125).length() < 1e-15, "{:?}", wall.area);
    }

    /// Lengths of the walls of triangles are half the cotangents of the angles across, times the edge.
    #[test]
    fn triangles() {
        let points = vec![Vec3::ZERO, Vec3::new(1.0, 0.1, 0.0), Vec3::new(0.4, 0.9, 0.0)];
        let mesh = Mesh::new(points.clone(), ElementKind::Tri3, vec![0, 1, 2]);
        let cells = VoronoiCells::of(&mesh).unwrap();
        assert!((cells.volumes.iter().sum::<f64>() - 0.43).abs() < 1e-14);
        for ([a, b], length) in &cells.facets {
            let c = points[3 - *a as usize - *b as usize];
            let (p, q) = (points[*a as usize] - c, points[*b as usize] - c);
            let cotangent = p.dot(q) / p.cross(q).length();
            let expected = 0.5 * cotangent * (p - q).length();
            assert!((length - expected).abs() < 1e-14, "{length} {expected}");
        }
    }
}
