//! Shortest ways within a shape, from a place to the points of its mesh.
//!
//! Where the place is seen in a straight line the way is that line. Round a corner and past the end of a slit it bends at points of
//! the mesh; so it does at borders between cells in which lengths count differently. Ways are found point by point from the place
//! outward (Dijkstra 1959), each point keeping the last bend before it as the source that it is seen from, so that distances grow no
//! errors along straight parts (any-angle paths: Daniel, Nash, Koenig & Felner 2010).

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use souple_math::Vec3;
use souple_mesh::Mesh;

/// Where a way bends last, and how far that is from its start.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    pub place: Vec3,
    /// As far as that the way has been counted.
    pub offset: f64,
    /// How much a length counts from there on.
    pub cost: f64,
    /// A cell that it is in, from which it looks around.
    cell: u32,
}

/// How far ways are followed; those of all points of the cell that they start in are found in any case.
pub enum Extent<'a> {
    /// As long as this, as lengths count [m].
    Way(f64),
    /// As far as weights may ask that reach `support` times as far as the first of some other places, of which the cells
    /// are given.
    Support { others: &'a [(u32, Vec3)], support: f64 },
}

/// The cells of a mesh for walks along straight lines.
pub struct Ground<'a> {
    mesh: &'a Mesh,
    /// Of each cell: how much a length counts in it.
    costs: Vec<f64>,
    /// Cells of each point.
    around: Vec<Vec<u32>>,
    centres: Vec<Vec3>,
    /// Of each cell the planes of its faces, normals outward, and the cell behind each.
    faces: Vec<Vec<(Vec3, f64, Option<u32>)>>,
}

/// Distance and source of each point that was reached.
pub type Found = Vec<Option<(f64, Source)>>;

/// Ends of lines of sight are drawn this part of the way to the middle of their cells, off the faces that they lie on.
const NUDGE: f64 = 1e-3;
/// A way counts as shorter by more than this part: rounding.
const SHORTER: f64 = 1e-9;

impl<'a> Ground<'a> {
    pub fn new(mesh: &'a Mesh, costs: Vec<f64>) -> Self {
        let mut around = vec![Vec::new(); mesh.points.len()];
        let centres = mesh.cell_centres();
        let mut sides = BTreeMap::new();
        for (index, cell) in mesh.cells().enumerate() {
            cell.nodes.iter().for_each(|node| around[*node as usize].push(index as u32));
            for face in 0..cell.kind.faces().len() {
                let mut corners: Vec<u32> = cell.face_corners(face).collect();
                corners.sort_unstable();
                sides.entry(corners).or_insert_with(Vec::new).push(index as u32);
            }
        }
        let planes = mesh.cells().enumerate().map(|(index, cell)| {
            let plane = |face: usize| {
                let corners: Vec<u32> = cell.face_corners(face).collect();
                let at = |corner: usize| mesh.points[corners[corner % corners.len()] as usize];
                let middle = (0..corners.len()).map(at).sum::<Vec3>() * (1.0 / corners.len() as f64);
                let area =
                    (0..corners.len()).map(|k| (at(k) - middle).cross(at(k + 1) - middle)).sum::<Vec3>();
                let mut key = corners;
                key.sort_unstable();
                let other = sides[&key].iter().copied().find(|other| *other != index as u32);
                let outward = if area.dot(middle - centres[index]) < 0.0 { -area } else { area };
                (outward, outward.dot(middle), other)
            };
            (0..cell.kind.faces().len()).map(plane).collect()
        });
        let faces = planes.collect();
        Self { mesh, costs, around, centres, faces }
    }

    /// How much a length counts in a cell.
    pub fn cost(&self, cell: u32) -> f64 {
        self.costs[cell as usize]
    }

    fn nodes(&self, cell: u32) -> &[u32] {
        self.mesh.cell(cell).map_or(&[], |cell| cell.nodes)
    }

    /// Whether a straight line from a place in a cell to a source stays in matter that counts alike.
    fn sees(&self, place: Vec3, cell: u32, source: &Source) -> bool {
        let drawn = |place: Vec3, cell: u32| place + (self.centres[cell as usize] - place) * NUDGE;
        let (from, to) = (drawn(place, cell), drawn(source.place, source.cell));
        let along = to - from;
        let (mut cell, mut passed) = (cell, 0.0_f64);
        for _ in 0..self.faces.len() {
            if cell == source.cell {
                return true;
            }
            if self.costs[cell as usize] != source.cost {
                return false;
            }
            let mut exit: Option<(f64, Option<u32>)> = None;
            for (normal, height, other) in &self.faces[cell as usize] {
                let speed = normal.dot(along);
                if speed > 0.0 {
                    let at = (height - normal.dot(from)) / speed;
                    if exit.is_none_or(|(first, _)| at < first) {
                        exit = Some((at, *other));
                    }
                }
            }
            let Some((at, other)) = exit else { return false };
            passed = passed.max(at);
            if passed >= 1.0 {
                return true;
            }
            let Some(other) = other else { return false };
            cell = other;
        }
        false
    }

    /// Ways from a place in a cell to the points around it.
    pub fn ways_from(&self, place: Vec3, cell: u32, extent: &Extent) -> Found {
        let start = Source { place, offset: 0.0, cost: self.cost(cell), cell };
        let mut found: Found = vec![None; self.mesh.points.len()];
        let mut queue: BinaryHeap<Reverse<(u64, u32)>> = BinaryHeap::new();
        for &node in self.nodes(cell) {
            let distance = start.cost * (self.mesh.points[node as usize] - place).length();
            found[node as usize] = Some((distance, start));
            queue.push(Reverse((distance.to_bits(), node)));
        }
        let mut limit = match extent {
            Extent::Way(length) => *length,
            Extent::Support { .. } => f64::INFINITY,
        };
        while let Some(Reverse((bits, node))) = queue.pop() {
            let distance = f64::from_bits(bits);
            if distance > limit {
                break;
            }
            let Some((known, source)) = found[node as usize] else { continue };
            if distance > known {
                continue;
            }
            if let Extent::Support { others, support } = extent
                && limit == f64::INFINITY
                && let Some(spacing) = self.first_of(others, node, distance)
            {
                // cells beyond must be known as a whole
                limit = 1.5 * support * spacing;
            }
            for &cell in &self.around[node as usize] {
                let cost = self.cost(cell);
                for &next in self.nodes(cell) {
                    let place = self.mesh.points[next as usize];
                    let best = found[next as usize].map_or(f64::INFINITY, |(best, _)| best * (1.0 - SHORTER));
                    let straight = source.offset + source.cost * (place - source.place).length();
                    let way = if source.cost == cost && straight < best && self.sees(place, cell, &source) {
                        Some((straight, source))
                    } else {
                        let bend = self.mesh.points[node as usize];
                        let bent = distance + cost * (place - bend).length();
                        (bent < best).then_some((bent, Source { place: bend, offset: distance, cost, cell }))
                    };
                    if let Some(way) = way {
                        found[next as usize] = Some(way);
                        queue.push(Reverse((way.0.to_bits(), next)));
                    }
                }
            }
        }
        found
    }

    /// How far the nearest is of those places whose cells have the point `node`, by way of that point.
    fn first_of(&self, places: &[(u32, Vec3)], node: u32, distance: f64) -> Option<f64> {
        let by_node = |(cell, place): &(u32, Vec3)| {
            let way = (self.mesh.points[node as usize] - *place).length();
            self.nodes(*cell).contains(&node).then(|| distance + self.cost(*cell) * way)
        };
        places.iter().filter_map(by_node).reduce(f64::min)
    }

    /// How far a place in a cell is; `None` where a point of the cell was not reached.
    pub fn distance(&self, found: &Found, cell: u32, place: Vec3) -> Option<f64> {
        let cost = self.cost(cell);
        let by_node = |node: &u32| {
            let (distance, source) = found[*node as usize]?;
            Some(if source.cost == cost {
                source.offset + cost * (place - source.place).length()
            } else {
                distance + cost * (place - self.mesh.points[*node as usize]).length()
            })
        };
        // the nearest point decides
        let by_nodes: Option<Vec<f64>> = self.nodes(cell).iter().map(by_node).collect();
        by_nodes?.into_iter().reduce(f64::min)
    }
}
