//! Weights by distance within the shape: Shepard's over the way that matter leaves open, shorter through what is stiff.
//!
//! Where a frame is seen in a straight line the distance is that of space, and weights are those of `wendland`, as smooth as they
//! are. Round a corner and past the end of a slit the way bends at points of the mesh; so do borders between materials, within
//! which a length counts by `softest / stiffness`: stiff matter is small, and moves as one. Ways are found point by point from the
//! frame outward (Dijkstra 1959), each point keeping the last bend before it as the source that it is seen from, so that
//! distances grow no errors along straight parts (any-angle paths: Daniel, Nash, Koenig & Felner 2010).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use souple_math::{Mat3, Vec3};
use souple_mesh::{CellLocator, MAX_NODES, Mesh};
use souple_table::Values;

use super::FrameError;
use super::weights::{Kernel, SUPPORT, Shape, Share, Weights};

/// Where a way bends last, and how far that is from the frame.
#[derive(Clone, Copy, Debug)]
struct Source {
    place: Vec3,
    /// As far as that the way has been counted.
    offset: f64,
    /// How much a length counts from there on.
    cost: f64,
    /// A cell that it is in, from which it looks around.
    cell: u32,
}

/// What a frame is to a point of the mesh.
#[derive(Clone, Copy, Debug)]
struct Way {
    frame: u32,
    distance: f64,
    source: Source,
}

struct Geodesic<'a> {
    mesh: &'a Mesh,
    locator: CellLocator<'a>,
    costs: Vec<f64>,
    /// Of each point of the mesh, by ascending frame.
    ways: Vec<Vec<Way>>,
    /// How far each frame reaches, as ways count.
    supports: Vec<f64>,
}

pub fn build<'a>(values: &Values, shape: &Shape<'a>) -> Result<Box<dyn Weights + 'a>, FrameError> {
    let mesh = shape.mesh;
    let softest = shape.stiffness_of_cell.iter().copied().fold(f64::INFINITY, f64::min);
    let costs: Vec<f64> = shape.stiffness_of_cell.iter().map(|stiffness| softest / stiffness).collect();
    let ground = Ground::new(mesh, &costs);
    let locator = CellLocator::new(mesh);
    let carrier = |origin: Vec3| locator.carrier(origin).map_or(0, |location| location.cell);
    let cells: Vec<u32> = shape.frames.iter().map(|frame| carrier(frame.origin)).collect();
    let support = values.number("support");
    let (mut ways, mut supports) = (vec![Vec::new(); mesh.points.len()], Vec::new());
    for (index, frame) in shape.frames.iter().enumerate() {
        let others = cells.iter().enumerate().filter(|(other, _)| *other != index);
        let others: Vec<(u32, Vec3)> =
            others.map(|(other, cell)| (*cell, shape.frames[other].origin)).collect();
        let cell = cells[index];
        let start = Source { place: frame.origin, offset: 0.0, cost: costs[cell as usize], cell };
        let found = ground.ways_from(start, &others, support);
        let nearest =
            others.iter().filter_map(|(cell, place)| ground.distance(&found, *cell, *place).map(|d| d.0));
        let size = found.iter().flatten().map(|way| way.0).fold(0.0, f64::max);
        let spacing = nearest.reduce(f64::min).unwrap_or(size);
        supports.push(support * spacing);
        for (point, way) in found.into_iter().enumerate() {
            let (distance, source) = match way {
                Some(way) => way,
                None => continue,
            };
            ways[point].push(Way { frame: index as u32, distance, source });
        }
    }
    Ok(Box::new(Geodesic { mesh, locator, costs, ways, supports }))
}

/// The cells of a mesh for walks along straight lines.
struct Ground<'a> {
    mesh: &'a Mesh,
    costs: &'a [f64],
    /// Cells of each point.
    around: Vec<Vec<u32>>,
    centres: Vec<Vec3>,
    /// Of each cell the planes of its faces, normals outward, and the cell behind each.
    faces: Vec<Vec<(Vec3, f64, Option<u32>)>>,
}

/// Distance and source of each point that was reached.
type Found = Vec<Option<(f64, Source)>>;

/// Ends of lines of sight are drawn this part of the way to the middle of their cells, off the faces that they lie on.
const NUDGE: f64 = 1e-3;
/// A way counts as shorter by more than this part: rounding.
const SHORTER: f64 = 1e-9;

impl<'a> Ground<'a> {
    fn new(mesh: &'a Mesh, costs: &'a [f64]) -> Self {
        let mut around = vec![Vec::new(); mesh.points.len()];
        let centres = mesh.cell_centres();
        let mut sides = std::collections::BTreeMap::new();
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

    /// Ways from a source to the points around it, as far as weights of a support may ask.
    fn ways_from(&self, start: Source, others: &[(u32, Vec3)], support: f64) -> Found {
        let mut found: Found = vec![None; self.mesh.points.len()];
        let mut queue: BinaryHeap<Reverse<(u64, u32)>> = BinaryHeap::new();
        let nodes = |cell: u32| self.mesh.cell(cell).map_or(&[][..], |cell| cell.nodes);
        for &node in nodes(start.cell) {
            let distance = start.cost * (self.mesh.points[node as usize] - start.place).length();
            found[node as usize] = Some((distance, start));
            queue.push(Reverse((distance.to_bits(), node)));
        }
        let mut limit = f64::INFINITY;
        while let Some(Reverse((bits, node))) = queue.pop() {
            let distance = f64::from_bits(bits);
            if distance > limit {
                break;
            }
            let Some((known, source)) = found[node as usize] else { continue };
            if distance > known {
                continue;
            }
            if limit == f64::INFINITY {
                // the first other frame tells how far this one will reach; cells beyond must be known as a whole
                let to_other = |(cell, place): &(u32, Vec3)| {
                    let way = (self.mesh.points[node as usize] - *place).length();
                    nodes(*cell).contains(&node).then(|| distance + self.costs[*cell as usize] * way)
                };
                if let Some(spacing) = others.iter().filter_map(to_other).reduce(f64::min) {
                    limit = 1.5 * support * spacing;
                }
            }
            for &cell in &self.around[node as usize] {
                let cost = self.costs[cell as usize];
                for &next in nodes(cell) {
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

    /// How far a place in a cell is, and the gradient of that; `None` where a point of the cell was not reached.
    fn distance(&self, found: &Found, cell: u32, place: Vec3) -> Option<(f64, Vec3)> {
        let view = self.mesh.cell(cell)?;
        let ways: Option<Vec<(f64, Source)>> = view.nodes.iter().map(|node| found[*node as usize]).collect();
        let ways = ways?;
        // frames stand anywhere in their cells: the nearest point decides
        let cost = self.costs[cell as usize];
        let seen = |(distance, source): &(f64, Source), node: &u32| {
            if source.cost == cost {
                source.offset + cost * (place - source.place).length()
            } else {
                distance + cost * (place - self.mesh.points[*node as usize]).length()
            }
        };
        ways.iter()
            .zip(view.nodes)
            .map(|(way, node)| seen(way, node))
            .reduce(f64::min)
            .map(|d| (d, Vec3::ZERO))
    }
}

impl Weights for Geodesic<'_> {
    fn shares(&self, point: Vec3) -> Vec<Share> {
        let Some(location) = self.locator.carrier(point) else { return Vec::new() };
        let Some(cell) = self.mesh.cell(location.cell) else { return Vec::new() };
        let mut buffer = [Vec3::ZERO; MAX_NODES];
        let corners = self.mesh.positions_into(cell.nodes, &mut buffer);
        let inverse = cell.kind.jacobian(corners, location.reference).try_inverse().unwrap_or(Mat3::ZERO);
        let (values, slopes) =
            (cell.kind.shape(location.reference), cell.kind.shape_gradients(location.reference));
        let cost = self.costs[location.cell as usize];
        let (mut shares, mut sum, mut sum_gradient) = (Vec::new(), 0.0, Vec3::ZERO);
        'frames: for first in &self.ways[cell.nodes[0] as usize] {
            // Σ N_n d_n(P), with the distance that point n sees
            let (mut distance, mut gradient) = (0.0, Vec3::ZERO);
            for ((node, value), slope) in cell.nodes.iter().zip(values.iter()).zip(slopes.iter()) {
                let ways = &self.ways[*node as usize];
                let Ok(place) = ways.binary_search_by_key(&first.frame, |way| way.frame) else {
                    continue 'frames;
                };
                let Way { source, distance: at_node, .. } = &ways[place];
                let arm = point - source.place;
                let (seen, rate) = if source.cost == cost {
                    let length = arm.length();
                    let along = if length > 0.0 { arm * (cost / length) } else { Vec3::ZERO };
                    (source.offset + cost * length, along)
                } else {
                    (*at_node, Vec3::ZERO)
                };
                distance += value * seen;
                gradient += inverse.transpose_apply(*slope) * seen + rate * *value;
            }
            let support = self.supports[first.frame as usize];
            let u = distance.max(0.0) / support;
            let Some((value, slope_over_u)) = Kernel::Wendland.at(u) else { continue };
            let gradient = gradient * (slope_over_u * u / support);
            shares.push(Share { frame: first.frame, weight: value, gradient });
            sum += value;
            sum_gradient += gradient;
        }
        if sum <= 0.0 {
            return Vec::new();
        }
        for share in &mut shares {
            share.weight /= sum;
            share.gradient = (share.gradient - sum_gradient * share.weight) / sum;
        }
        shares
    }

    fn reach(&self, frame: usize) -> f64 {
        self.supports[frame]
    }
}

/// The parameter of these weights.
pub const PARAMETERS: &[souple_table::Parameter] = &[SUPPORT];
