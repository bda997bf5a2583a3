//! Tetrahedra split into smaller ones, all of a mesh at once: in eight, or along longest edges.

use std::collections::{BTreeMap, BTreeSet};

use souple_math::Vec3;

use crate::{CellBlock, ElementKind, Group, MAX_CELLS, Mesh, MeshError};

/// How tetrahedra are split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplitBy {
    /// In eight, by the middles of all edges: four at the corners, of the shape of the whole, and four around the shortest diagonal of
    /// the octahedron between them (S. Zhang, Successive subdivisions of tetrahedra, Houston Journal of Mathematics 21, 1995).
    Regular,
    /// In two at the middle of the longest edge, once each tetrahedron around that edge has none that is longer; those which are not are
    /// split before (M.-C. Rivara, New longest-edge algorithms for the refinement of triangulations, 1997).
    LongestEdge,
}

/// Pairs of corners of a tetrahedron, in the order in which middles of its edges are named below.
const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
const TRIANGLE_EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// The octahedron between the middles of edges: the ends of each diagonal, and the four others around it, so that ends, one of these and
/// the next have the orientation of the whole.
const DIAGONALS: [([usize; 2], [usize; 4]); 3] =
    [([0, 5], [1, 2, 4, 3]), ([1, 4], [2, 0, 3, 5]), ([2, 3], [0, 1, 5, 4])];

/// Of each simplex of a mesh its parts, by their corners.
type PartsOfEach<const N: usize> = Vec<Vec<[u32; N]>>;

impl Mesh {
    /// The mesh with each of its tetrahedra split once at least, conforming where this one is. Points keep their numbers, and new ones
    /// follow, each of the groups that hold both ends of the edge which it is the middle of. Parts of a cell follow each other in its
    /// place, and are of its groups; so do those of facets.
    ///
    /// # Errors
    /// [`MeshError::NotSplit`] where a cell is no tet4 or a facet no tri3; [`MeshError::TooManyCells`].
    pub fn split(&self, by: SplitBy) -> Result<Self, MeshError> {
        let cells = simplices::<4>(&self.blocks, ElementKind::Tet4, "cells")?;
        let facets = simplices::<3>(&self.facet_blocks, ElementKind::Tri3, "facets")?;
        let most = match by {
            SplitBy::Regular => 8,
            SplitBy::LongestEdge => 2,
        } * cells.len() as u64;
        if most > MAX_CELLS {
            return Err(MeshError::TooManyCells { requested: most as f64, limit: MAX_CELLS });
        }
        let mut middles = Middles { points: self.points.clone(), of: BTreeMap::new() };
        let (cells, facets) = match by {
            SplitBy::Regular => {
                let facets = facets.iter().map(|facet| middles.quarters(facet).to_vec()).collect();
                (cells.iter().map(|cell| middles.eighths(cell).to_vec()).collect(), facets)
            }
            SplitBy::LongestEdge => middles.bisected(cells, facets),
        };
        Ok(self.with_parts(middles, cells, facets))
    }

    /// Parts of cells and facets in the places of the whole ones.
    fn with_parts(&self, middles: Middles, cells: PartsOfEach<4>, facets: PartsOfEach<3>) -> Self {
        let mut groups = self.groups.clone();
        for group in groups.values_mut() {
            *group = Group {
                points: middles.joined(&group.points),
                cells: parts_of(&group.cells, &cells),
                facets: parts_of(&group.facets, &facets),
            };
        }
        Self {
            points: middles.points,
            blocks: vec![block(ElementKind::Tet4, cells)],
            facet_blocks: if facets.is_empty() { Vec::new() } else { vec![block(ElementKind::Tri3, facets)] },
            groups,
        }
    }
}

/// The nodes of cells of one kind; others are refused.
fn simplices<const N: usize>(
    blocks: &[CellBlock],
    kind: ElementKind,
    list: &'static str,
) -> Result<Vec<[u32; N]>, MeshError> {
    if let Some(other) = blocks.iter().find(|block| block.kind != kind && !block.is_empty()) {
        return Err(MeshError::NotSplit { list, kind: other.kind, expected: kind });
    }
    let nodes = blocks.iter().flat_map(CellBlock::cells);
    Ok(nodes.map(|nodes| std::array::from_fn(|place| nodes[place])).collect())
}

fn block<const N: usize>(kind: ElementKind, parts: PartsOfEach<N>) -> CellBlock {
    CellBlock { kind, nodes: parts.into_iter().flatten().flatten().collect() }
}

/// The numbers of the parts of some, ascending where those are.
fn parts_of<const N: usize>(wholes: &[u32], parts: &[Vec<[u32; N]>]) -> Vec<u32> {
    let mut first = vec![0];
    for parts in parts {
        first.push(first[first.len() - 1] + parts.len() as u32);
    }
    wholes.iter().flat_map(|whole| first[*whole as usize]..first[*whole as usize + 1]).collect()
}

/// The points of a mesh, and those in the middles of its edges as they are made.
struct Middles {
    points: Vec<Vec3>,
    /// By the ends of an edge, the lower number first.
    of: BTreeMap<[u32; 2], u32>,
}

impl Middles {
    fn point(&mut self, [a, b]: [u32; 2]) -> u32 {
        let points = &mut self.points;
        *self.of.entry(edge(a, b)).or_insert_with(|| {
            points.push((points[a as usize] + points[b as usize]) * 0.5);
            points.len() as u32 - 1
        })
    }

    /// Squared [m²].
    fn length_sq(&self, [a, b]: [u32; 2]) -> f64 {
        (self.points[a as usize] - self.points[b as usize]).length_sq()
    }

    fn eighths(&mut self, corners: &[u32; 4]) -> [[u32; 4]; 8] {
        let middle = TET_EDGES.map(|ends| self.point(ends.map(|corner| corners[corner])));
        let length = |ends: [usize; 2]| self.length_sq(ends.map(|end| middle[end]));
        let mut shortest = 0;
        for place in 1..DIAGONALS.len() {
            if length(DIAGONALS[place].0) < length(DIAGONALS[shortest].0) {
                shortest = place;
            }
        }
        let ([from, to], around) = DIAGONALS[shortest];
        let [a, b, c, d] = *corners;
        let [ab, ac, ad, bc, bd, cd] = middle;
        let inner = |place: usize| {
            [from, to, around[place], around[(place + 1) % around.len()]].map(|point| middle[point])
        };
        [
            [a, ab, ac, ad],
            [ab, b, bc, bd],
            [ac, bc, c, cd],
            [ad, bd, cd, d],
            inner(0),
            inner(1),
            inner(2),
            inner(3),
        ]
    }

    fn quarters(&mut self, corners: &[u32; 3]) -> [[u32; 3]; 4] {
        let [a, b, c] = *corners;
        let [ab, bc, ca] = TRIANGLE_EDGES.map(|ends| self.point(ends.map(|corner| corners[corner])));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    }

    /// Parts of each cell and each facet, when the longest edge of each cell is halved. An edge waits for the longer ones of the cells
    /// around it; of two of one length, that of the higher numbers counts as longer.
    fn bisected(&mut self, cells: Vec<[u32; 4]>, facets: Vec<[u32; 3]>) -> (PartsOfEach<4>, PartsOfEach<3>) {
        let (mut cells, mut facets) = (Parts::of(cells), Parts::of(facets));
        let longest = |middles: &Self, cell: &[u32; 4]| {
            let lengths = TET_EDGES.map(|[a, b]| {
                let edge = edge(cell[a], cell[b]);
                // numbers which are not negative are in the order of their bits
                (middles.length_sq(edge).to_bits(), edge)
            });
            lengths.into_iter().fold(lengths[0], Ord::max)
        };
        let mut waiting: BTreeSet<(u64, [u32; 2])> =
            cells.nodes.iter().map(|cell| longest(self, cell)).collect();
        while let Some(edge) = waiting.last().copied() {
            let around = cells.around(edge.1);
            let longer: Vec<(u64, [u32; 2])> =
                around.iter().map(|cell| longest(self, &cells.nodes[*cell as usize])).collect();
            if longer.iter().any(|other| *other > edge) {
                waiting.extend(longer);
                continue;
            }
            waiting.remove(&edge);
            let middle = self.point(edge.1);
            cells.bisect(edge.1, middle);
            facets.bisect(edge.1, middle);
        }
        (cells.by_whole(), facets.by_whole())
    }

    /// The points of a group, and the middles between them, in the order in which those were made.
    fn joined(&self, points: &[u32]) -> Vec<u32> {
        let mut made: Vec<(u32, [u32; 2])> = self.of.iter().map(|(ends, middle)| (*middle, *ends)).collect();
        made.sort_unstable();
        let mut joined = points.to_vec();
        for (middle, ends) in made {
            // middles are halved in their turn: all are in ascending order
            if ends.iter().all(|end| joined.binary_search(end).is_ok()) {
                joined.push(middle);
            }
        }
        joined
    }
}

/// The ends of an edge, the lower number first.
fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Simplices of `N` corners that are halved edge by edge.
struct Parts<const N: usize> {
    nodes: Vec<[u32; N]>,
    /// Which each is a part of.
    whole: Vec<u32>,
    /// Those around each edge.
    around: BTreeMap<[u32; 2], Vec<u32>>,
}

impl<const N: usize> Parts<N> {
    fn of(wholes: Vec<[u32; N]>) -> Self {
        let mut parts = Self { nodes: Vec::new(), whole: Vec::new(), around: BTreeMap::new() };
        for (whole, nodes) in wholes.into_iter().enumerate() {
            parts.add(nodes, whole as u32);
        }
        parts
    }

    fn add(&mut self, nodes: [u32; N], whole: u32) {
        let number = self.nodes.len() as u32;
        edges(&nodes).for_each(|edge| self.around.entry(edge).or_default().push(number));
        self.nodes.push(nodes);
        self.whole.push(whole);
    }

    fn around(&self, edge: [u32; 2]) -> &[u32] {
        self.around.get(&edge).map_or(&[], Vec::as_slice)
    }

    /// Halves all around an edge: one half stays in the place of the whole.
    fn bisect(&mut self, [a, b]: [u32; 2], middle: u32) {
        for number in self.around.remove(&[a, b]).unwrap_or_default() {
            let nodes = self.nodes[number as usize];
            let with = |end: u32| nodes.map(|node| if node == end { middle } else { node });
            for edge in edges(&nodes).filter(|edge| edge.contains(&b)) {
                if let Some(around) = self.around.get_mut(&edge) {
                    around.retain(|other| *other != number);
                }
            }
            self.nodes[number as usize] = with(b);
            for edge in edges(&with(b)).filter(|edge| edge.contains(&middle)) {
                self.around.entry(edge).or_default().push(number);
            }
            self.add(with(a), self.whole[number as usize]);
        }
    }

    /// The parts of each.
    fn by_whole(self) -> PartsOfEach<N> {
        let count = self.whole.iter().map(|whole| *whole as usize + 1).max().unwrap_or(0);
        let mut parts = vec![Vec::new(); count];
        for (nodes, whole) in self.nodes.into_iter().zip(self.whole) {
            parts[whole as usize].push(nodes);
        }
        parts
    }
}

/// All pairs of corners.
fn edges<const N: usize>(nodes: &[u32; N]) -> impl Iterator<Item = [u32; 2]> + '_ {
    (0..N).flat_map(move |to| (0..to).map(move |from| edge(nodes[from], nodes[to])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cell;
    use souple_table::{Value, Values};

    /// Boxes of six tetrahedra, no two sides alike.
    fn block() -> Mesh {
        let mut values = Values::new();
        values.set("size", Value::Vector([0.12, 0.1, 0.08]));
        values.set("cells", Value::Vector([2.0, 2.0, 2.0]));
        values.set("element", Value::Text("tet4"));
        crate::generate("box", values).unwrap()
    }

    fn worst(mesh: &Mesh) -> f64 {
        mesh.quality().iter().map(|cell| cell.scaled_jacobian).fold(f64::INFINITY, f64::min)
    }

    /// Of a regular tetrahedron the parts around the diagonal have a least scaled Jacobian of 1/√2, and its halves one of 1/√3.
    #[test]
    fn parts_of_a_regular_tetrahedron() {
        let whole = Mesh::new(ElementKind::Tet4.regular(), ElementKind::Tet4, vec![0, 1, 2, 3]);
        for (by, count, expected) in
            [(SplitBy::Regular, 8, 0.5_f64.sqrt()), (SplitBy::LongestEdge, 2, 3_f64.sqrt().recip())]
        {
            let parts = whole.split(by).unwrap();
            assert_eq!(parts.cell_count(), count);
            assert!((worst(&parts) - expected).abs() < 1e-14, "{by:?}: {}", worst(&parts));
        }
    }

    /// Splits conform, fill the same volume with positive cells, and keep the surface.
    #[test]
    fn splits_conform_and_fill_the_whole() {
        for by in [SplitBy::Regular, SplitBy::LongestEdge] {
            let mut mesh = block();
            let (volume, area) = (mesh.volume(), mesh.boundary_surface().area());
            for times in 1..=4 {
                let parts = mesh.split(by).unwrap();
                assert!(parts.cell_count() >= 2 * mesh.cell_count());
                mesh = parts;
                mesh.faces().conforming().unwrap();
                assert!(mesh.conformity().problems(&mesh).is_empty(), "{by:?} {times}");
                assert!(mesh.validate().unwrap().messages().is_empty(), "{by:?} {times}");
                assert!((mesh.volume() - volume).abs() < 1e-12 * volume);
                assert!((mesh.boundary_surface().area() - area).abs() < 1e-12 * area);
                if by == SplitBy::Regular && times == 2 {
                    break;
                }
            }
        }
    }

    fn sorted(nodes: &[u32]) -> Vec<u32> {
        let mut nodes = nodes.to_vec();
        nodes.sort_unstable();
        nodes
    }

    /// Faces of cells at the lowest z, by their nodes.
    fn floor_of(mesh: &Mesh) -> Vec<Vec<u32>> {
        let is_low = |node: &&u32| mesh.points[**node as usize].z < 1e-9;
        let low = |cell: Cell<'_>| sorted(&cell.nodes.iter().filter(is_low).copied().collect::<Vec<_>>());
        let mut faces: Vec<Vec<u32>> = mesh.cells().map(low).filter(|nodes| nodes.len() == 3).collect();
        faces.sort();
        faces
    }

    /// Groups hold the parts of what they held: points of a face stay those of the face, parts of a cell its volume.
    #[test]
    fn groups_hold_parts() {
        for by in [SplitBy::Regular, SplitBy::LongestEdge] {
            let mut mesh = block();
            let first: Vec<u32> = (0..6).collect();
            let volume: f64 = mesh.cells().take(6).map(|cell| mesh.cell_volume(cell)).sum();
            mesh.groups.insert("box".to_owned(), Group { cells: first, ..Group::default() });
            let floor = floor_of(&mesh);
            floor.iter().for_each(|nodes| mesh.push_facet(ElementKind::Tri3, nodes));
            let facets = (0..floor.len() as u32).collect();
            mesh.groups.insert("floor".to_owned(), Group { facets, ..Group::default() });
            let parts = mesh.split(by).unwrap().split(by).unwrap();
            let held = &parts.groups["box"].cells;
            let sum: f64 = parts
                .cells()
                .enumerate()
                .filter(|(n, _)| held.contains(&(*n as u32)))
                .map(|(_, c)| parts.cell_volume(c))
                .sum();
            assert!((sum - volume).abs() < 1e-15, "{by:?}: {sum} {volume}");
            let on_face: Vec<u32> = (0..parts.points.len() as u32)
                .filter(|point| parts.points[*point as usize].x < 1e-9)
                .collect();
            assert_eq!(parts.groups["x_min"].points, on_face);
            // facets are faces of cells still
            let mut facets: Vec<Vec<u32>> = parts.facets().map(|facet| sorted(facet.nodes)).collect();
            facets.sort();
            assert_eq!(facets, floor_of(&parts), "{by:?}");
            assert_eq!(parts.groups["floor"].facets.len(), facets.len());
        }
    }

    /// Other cells are refused by name.
    #[test]
    fn other_cells_are_refused() {
        let mesh = Mesh::new(ElementKind::Hex8.regular(), ElementKind::Hex8, (0..8).collect());
        let error = mesh.split(SplitBy::Regular).unwrap_err();
        assert_eq!(error.to_string(), "cells has a block of hex8, which is not split; expected tet4 only");
    }
}
