//! Triangles of the cells that the surface runs through, and what is measured of them.

use std::sync::LazyLock;

use souple_math::Vec3;
use souple_mesh::Sets;

use crate::cases::{CASES, edge_place};
use crate::crossings::Crossings;
use crate::grid::{EDGE, Found, Grid, Halo, Lattice, NODES, Neighbours, block_of, neighbour, wide};
use crate::marks::{ALL, FIRST_X, FIRST_Y, Layers, Marks, NONE, along_x, along_y, bits};

/// A closed surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    /// [m]
    pub points: Vec<Vec3>,
    /// Counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Nodes along an edge of a block with those that its cells end at.
const CELLS: usize = EDGE + 1;

/// Place of a node's edge along an axis in [`Numbers`].
const fn slot(axis: usize, x: usize, y: usize, z: usize) -> usize {
    x + CELLS * (y + CELLS * (z + CELLS * axis))
}

/// Numbers of the crossings at the cells of a block; where an edge is not cut, anything.
struct Numbers([u32; 3 * CELLS * CELLS * CELLS]);

impl Numbers {
    /// Reads those of a block and of the blocks above it.
    fn read(&mut self, neighbours: &Neighbours, crossings: &Crossings, block: usize) {
        for side in 0..8 {
            let steps = [side & 1, side >> 1 & 1, side >> 2];
            let number = neighbour(steps[0] as i32, steps[1] as i32, steps[2] as i32);
            let Found::Kept(index) = neighbours.of(block, number) else { continue };
            let index = index as usize;
            // of a block further on only the nodes at this one
            let nodes =
                (if steps[0] == 1 { FIRST_X } else { !0 }) & (if steps[1] == 1 { FIRST_Y } else { !0 });
            let layers = if steps[2] == 1 { 1 } else { EDGE };
            // and edges that run along this one
            for axis in (0..3).filter(|axis| steps[*axis] == 0) {
                for z in 0..layers {
                    for bit in bits(crossings.cut(index)[axis][z] & nodes) {
                        let (x, y) = (bit % EDGE + EDGE * steps[0], bit / EDGE + EDGE * steps[1]);
                        self.0[slot(axis, x, y, z + EDGE * steps[2])] = crossings.number(index, axis, z, bit);
                    }
                }
            }
        }
    }
}

/// The triangles of a pattern of signs, as slots from that of their cell's node.
#[derive(Clone, Copy, Default)]
struct Corners {
    count: u8,
    /// Five at most.
    triangles: [[u16; 3]; 5],
}

static CORNERS: LazyLock<[Corners; 256]> = LazyLock::new(|| {
    std::array::from_fn(|signs| {
        let mut corners = Corners { count: CASES[signs].triangles.len() as u8, ..Corners::default() };
        for (triangle, edges) in corners.triangles.iter_mut().zip(&CASES[signs].triangles) {
            *triangle = edges.map(|edge| {
                let (axis, corner) = edge_place(edge.into());
                slot(axis, corner & 1, corner >> 1 & 1, corner >> 2) as u16
            });
        }
        corners
    })
});

/// Triangles of all cells whose corners differ in sign, in place of those in the list.
///
/// Cells belong to the block of their lowest node. Where that block is not kept no cell is cut: a node next to it that
/// is within the band, or of the other sign, would have woken it.
pub fn polygonise(
    neighbours: &Neighbours,
    marks: &[Marks],
    crossings: &Crossings,
    triangles: &mut Vec<[u32; 3]>,
) {
    let all_corners = &*CORNERS;
    let mut numbers = Numbers([0; 3 * CELLS * CELLS * CELLS]);
    triangles.clear();
    for block in 0..marks.len() {
        // signs in the eight blocks from here upward, by their bits x + 2y + 4z
        let blocks: [&Layers; 8] = std::array::from_fn(|corner| {
            let number = (1 + (corner & 1)) + 3 * (1 + (corner >> 1 & 1)) + 9 * (1 + (corner >> 2));
            match neighbours.of(block, number) {
                Found::Kept(index) => &marks[index as usize].inside,
                Found::Inside => &ALL,
                Found::Outside => &NONE,
            }
        });
        // of a layer, of its next nodes along x, along y, along both
        let four = |up: usize, z: usize| {
            let [own, x, y, xy] = [0, 1, 2, 3].map(|corner| blocks[up + corner][z]);
            let (next_x, next_y) = (along_x(own, x), along_y(own, y));
            [own, next_x, next_y, along_x(next_y, along_y(x, xy))]
        };
        let mut is_read = false;
        let mut below = four(0, 0);
        for z in 0..EDGE {
            let above = if z + 1 < EDGE { four(0, z + 1) } else { four(4, 0) };
            let any = below.iter().chain(&above).fold(0, |word, layer| word | layer);
            let all = below.iter().chain(&above).fold(!0, |word, layer| word & layer);
            if any & !all != 0 && !is_read {
                numbers.read(neighbours, crossings, block);
                is_read = true;
            }
            for bit in bits(any & !all) {
                let mut signs = 0;
                for corner in 0..4 {
                    signs |=
                        (below[corner] >> bit & 1) << corner | (above[corner] >> bit & 1) << (corner + 4);
                }
                let corners = &all_corners[signs as usize];
                let numbers = &numbers.0[slot(0, bit % EDGE, bit / EDGE, z)..];
                let cut = &corners.triangles[..usize::from(corners.count)];
                triangles.extend(cut.iter().map(|slots| slots.map(|slot| numbers[usize::from(slot)])));
            }
            below = above;
        }
    }
}

/// Outward unit normals at the crossings, from gradients of the grid's values at the ends of their edges.
pub fn normals(
    grid: Grid,
    neighbours: &Neighbours,
    crossings: &Crossings,
    lattice: &Lattice,
    out: &mut Vec<Vec3>,
) {
    out.clear();
    let mut halo = Halo::filled(0.0);
    let gradient = |halo: &Halo<f64>, node: usize| {
        let f = &halo.0;
        let slope = |stride: usize| f[node + stride] - f[node - stride];
        Vec3::new(slope(1), slope(wide(0, 1, 0)), slope(wide(0, 0, 1)))
    };
    for block in 0..grid.keys.len() {
        let cut = crossings.cut(block);
        if *cut == [[0; EDGE]; 3] {
            continue;
        }
        halo.read(&grid.around(neighbours, block), f64::from);
        let corner = block_of(grid.keys[block]).map(|c| c * EDGE as i64);
        for axis in 0..3 {
            for z in 0..EDGE {
                for bit in bits(cut[axis][z]) {
                    let (x, y) = (bit % EDGE, bit / EDGE);
                    let at = gradient(&halo, wide(x + 1, y + 1, z + 1));
                    let mut next = [x, y, z];
                    next[axis] += 1;
                    let beyond = if next[axis] < EDGE {
                        gradient(&halo, wide(next[0] + 1, next[1] + 1, next[2] + 1))
                    } else {
                        gradient_at(grid, [0, 1, 2].map(|i| corner[i] + next[i] as i64))
                    };
                    let point = lattice.to_voxels(crossings.points[out.len()]);
                    let t = point[axis] - (corner[axis] + [x, y, z][axis] as i64) as f64;
                    let normal = -(at + (beyond - at) * t);
                    out.push(normal.try_normalised().unwrap_or(Vec3::Z));
                }
            }
        }
    }
}

fn gradient_at(grid: Grid, node: [i64; 3]) -> Vec3 {
    let slope = |axis: usize| {
        let step = |by: i64| {
            let mut other = node;
            other[axis] += by;
            grid.node(other)
        };
        step(1) - step(-1)
    };
    Vec3::new(slope(0), slope(1), slope(2))
}

/// Numbers of a closed surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// [m²]
    pub area: f64,
    /// Enclosed [m³].
    pub volume: f64,
    /// V − E + F.
    pub euler: i64,
    pub components: u64,
}

/// A surface that is not what a skin must be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Torn {
    #[error("the surface is open or turns over at point {point}")]
    Link { point: u32 },
    #[error("point {point} of the surface joins two sheets")]
    Pinched { point: u32 },
}

/// Scratch of [`Audit::check`].
#[derive(Clone, Debug, Default)]
pub struct Audit {
    /// Where each point's fan begins.
    starts: Vec<u32>,
    /// For each triangle at a point the edge opposite to it.
    fans: Vec<[u32; 2]>,
    /// Of each point, from 1: alike only where they are joined.
    labels: Vec<u32>,
    /// Labels that are of one component; that of points that have none is alone.
    joined: Sets,
}

/// A third of the area vectors of the triangles around each point, in place of what stands in `out`.
pub fn area_vectors(points: &[Vec3], triangles: &[[u32; 3]], out: &mut Vec<Vec3>) {
    out.clear();
    out.resize(points.len(), Vec3::ZERO);
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| points[corner as usize]);
        let third = (b - a).cross(c - a) * (1.0 / 6.0);
        corners.iter().for_each(|corner| out[*corner as usize] += third);
    }
}

/// Area and volume.
pub fn area_and_volume(points: &[Vec3], triangles: &[[u32; 3]]) -> (f64, f64) {
    // about a point of the surface: volumes of far skins lose no digits
    let about = points.first().copied().unwrap_or(Vec3::ZERO);
    let (mut area, mut volume) = (0.0, 0.0);
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| points[corner as usize] - about);
        let normal = (b - a).cross(c - a);
        area += normal.length();
        volume += normal.dot(a);
    }
    (0.5 * area, volume / 6.0)
}

impl Audit {
    /// Euler characteristic and components, where each point has one closed fan of triangles that agree in their
    /// orientation: so the surface is a closed, oriented manifold.
    ///
    /// # Errors
    /// The point where it is not.
    pub fn check(&mut self, point_count: usize, triangles: &[[u32; 3]]) -> Result<(i64, u64), Torn> {
        self.starts.clear();
        self.starts.resize(point_count + 1, 0);
        for corner in triangles.as_flattened() {
            self.starts[*corner as usize + 1] += 1;
        }
        for point in 0..point_count {
            self.starts[point + 1] += self.starts[point];
        }
        self.fans.resize(3 * triangles.len(), [0; 2]);
        self.labels.clear();
        self.labels.resize(point_count, 0);
        self.joined.clear();
        self.joined.add();
        for corners in triangles {
            let [a, b, c] = *corners;
            for (point, edge) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                // starts move to the next point's while filling, and back below
                let at = &mut self.starts[point as usize];
                self.fans[*at as usize] = edge;
                *at += 1;
            }
            self.label(corners);
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        for point in 0..point_count {
            let fan = &mut self.fans[self.starts[point] as usize..self.starts[point + 1] as usize];
            check_fan(point as u32, fan)?;
        }
        let components = self.joined.count() - 1;
        let euler = point_count as i64 - triangles.len() as i64 / 2;
        Ok((euler, components as u64))
    }

    /// Gives the corners of a triangle the label of those that have one, and joins labels where they have several.
    fn label(&mut self, corners: &[u32; 3]) {
        let own = corners.map(|point| self.labels[point as usize]);
        let mut label = own[0].max(own[1]).max(own[2]);
        if label == 0 {
            label = self.joined.add();
        } else if own.iter().fold(false, |differ, own| differ | ((*own != 0) & (*own != label))) {
            for own in own.into_iter().filter(|own| *own != 0) {
                self.joined.join(label, own);
            }
            label = self.joined.of(label);
        }
        corners.iter().for_each(|point| self.labels[*point as usize] = label);
    }

    pub fn bytes(&self) -> usize {
        4 * (self.starts.capacity() + self.labels.capacity()) + self.joined.bytes() + 8 * self.fans.capacity()
    }
}

/// Checks that the triangles of a point close around it once: each edge opposite to it begins where another ends, and one
/// after the other they come to all.
fn check_fan(at: u32, fan: &mut [[u32; 2]]) -> Result<(), Torn> {
    if fan.len() < 3 {
        return Err(Torn::Link { point: at });
    }
    // neighbours by the last bits of their numbers, which are seldom alike
    let mut places = [0_u8; 64];
    let mut seen = 0_u64;
    for (place, edge) in fan.iter().enumerate() {
        places[(edge[0] % 64) as usize] = place as u8;
        seen |= 1 << (edge[0] % 64);
    }
    if seen.count_ones() as usize != fan.len() {
        return check_fan_by_search(at, fan);
    }
    let (first, mut end) = (fan[0][0], fan[0][1]);
    for _ in 1..fan.len() {
        let next = fan[usize::from(places[(end % 64) as usize])];
        if next[0] != end {
            return Err(Torn::Link { point: at });
        }
        if end == first {
            return Err(Torn::Pinched { point: at });
        }
        end = next[1];
    }
    if end == first { Ok(()) } else { Err(Torn::Link { point: at }) }
}

/// The same, each edge compared with each.
fn check_fan_by_search(at: u32, fan: &mut [[u32; 2]]) -> Result<(), Torn> {
    for k in 1..fan.len() {
        let end = fan[k - 1][1];
        let Some(next) = (k..fan.len()).find(|next| fan[*next][0] == end) else {
            return Err(if end == fan[0][0] {
                Torn::Pinched { point: at }
            } else {
                Torn::Link { point: at }
            });
        };
        fan.swap(k, next);
    }
    if fan[fan.len() - 1][1] != fan[0][0] {
        return Err(Torn::Link { point: at });
    }
    if fan.iter().enumerate().any(|(k, edge)| fan[..k].iter().any(|other| other[0] == edge[0])) {
        return Err(Torn::Pinched { point: at });
    }
    Ok(())
}

/// Whether no node of a grid is inside.
pub fn is_empty(grid: Grid) -> bool {
    grid.values.len() < NODES || grid.values.iter().all(|value| *value <= 0.0)
}

#[cfg(test)]
mod tests;
