//! Triangles of the cells that the surface runs through, and what is measured of them.

use souple_math::Vec3;

use crate::cases::{CASES, edge_place};
use crate::crossings::{Crossings, along_x, along_y, bits};
use crate::grid::{EDGE, Found, Grid, Halo, Lattice, NODES, Neighbours, block_of, node_of, wide};

/// A closed surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    /// [m]
    pub points: Vec<Vec3>,
    /// Counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// What a cell's crossing is called: step to the block of its edge's lower node, and the edge there.
#[derive(Clone, Copy, Default)]
struct EdgePlace {
    axis: usize,
    /// Steps from the cell's node.
    x: usize,
    y: usize,
    z: usize,
}

/// Triangles of all cells whose corners differ in sign, appended to an empty list.
///
/// Cells belong to the block of their lowest node. Where that block is not kept no cell is cut: a node next to it that
/// is within the band, or of the other sign, would have woken it.
pub fn polygonise(grid: Grid, neighbours: &Neighbours, crossings: &Crossings, triangles: &mut Vec<[u32; 3]>) {
    let places: [EdgePlace; 12] = std::array::from_fn(|edge| {
        let (axis, corner) = edge_place(edge);
        EdgePlace { axis, x: corner & 1, y: corner >> 1 & 1, z: corner >> 2 }
    });
    triangles.clear();
    for block in 0..grid.keys.len() {
        // the eight blocks from here upward, by their bits x + 2y + 4z
        let blocks: [Found; 8] = std::array::from_fn(|corner| {
            neighbours.of(block, (1 + (corner & 1)) + 3 * (1 + (corner >> 1 & 1)) + 9 * (1 + (corner >> 2)))
        });
        let layer = |corner: usize, z: usize| match blocks[corner] {
            Found::Kept(index) => crossings.inside(index as usize)[z],
            Found::Inside => !0,
            Found::Outside => 0,
        };
        // of a layer, of its next nodes along x, along y, along both
        let four = |up: usize, z: usize| {
            let (own, x, y, xy) = (layer(up, z), layer(up + 1, z), layer(up + 2, z), layer(up + 3, z));
            let (next_x, next_y) = (along_x(own, x), along_y(own, y));
            [own, next_x, next_y, along_x(next_y, along_y(x, xy))]
        };
        let mut below = four(0, 0);
        for z in 0..EDGE {
            let above = if z + 1 < EDGE { four(0, z + 1) } else { four(4, 0) };
            let any = below.iter().chain(&above).fold(0, |word, layer| word | layer);
            let all = below.iter().chain(&above).fold(!0, |word, layer| word & layer);
            for bit in bits(any & !all) {
                let mut signs = 0;
                for corner in 0..4 {
                    signs |=
                        (below[corner] >> bit & 1) << corner | (above[corner] >> bit & 1) << (corner + 4);
                }
                let case = &CASES[signs as usize];
                let (x, y) = (bit % EDGE, bit / EDGE);
                let mut numbers = [0; 12];
                let mut left = case.edges;
                while left != 0 {
                    let edge = left.trailing_zeros() as usize;
                    left &= left - 1;
                    let place = places[edge];
                    let (x, y, z) = (x + place.x, y + place.y, z + place.z);
                    let at = x / EDGE + 2 * (y / EDGE) + 4 * (z / EDGE);
                    if let Found::Kept(index) = blocks[at] {
                        let bit = node_of(x % EDGE, y % EDGE, 0);
                        numbers[edge] = crossings.number(index as usize, place.axis, z % EDGE, bit);
                    }
                }
                triangles.extend(case.triangles.iter().map(|edges| edges.map(|edge| numbers[edge as usize])));
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
    let mut halo = Halo::ZERO;
    let gradient = |halo: &Halo, node: usize| {
        let f = &halo.0;
        let slope = |stride: usize| f[node + stride] - f[node - stride];
        Vec3::new(slope(1), slope(wide(0, 1, 0)), slope(wide(0, 0, 1)))
    };
    for block in 0..grid.keys.len() {
        let cut = crossings.cut(block);
        if *cut == [[0; EDGE]; 3] {
            continue;
        }
        halo.read(grid, neighbours, block);
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
    parents: Vec<u32>,
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
        self.fans.clear();
        self.fans.resize(3 * triangles.len(), [0; 2]);
        for [a, b, c] in triangles {
            for (point, edge) in [(a, [*b, *c]), (b, [*c, *a]), (c, [*a, *b])] {
                // starts move to the next point's while filling, and back below
                let at = &mut self.starts[*point as usize];
                self.fans[*at as usize] = edge;
                *at += 1;
            }
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.parents.clear();
        self.parents.extend(0..point_count as u32);
        for point in 0..point_count {
            let fan = &mut self.fans[self.starts[point] as usize..self.starts[point + 1] as usize];
            let at = point as u32;
            // each edge begins where the one before ends, and the last ends where the first begins
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
            match fan {
                [] => return Err(Torn::Link { point: at }),
                [first, .., last] if last[1] == first[0] && fan.len() > 2 => {}
                _ => return Err(Torn::Link { point: at }),
            }
            if fan.iter().enumerate().any(|(k, edge)| fan[..k].iter().any(|other| other[0] == edge[0])) {
                return Err(Torn::Pinched { point: at });
            }
            let first = fan[0][0];
            join(&mut self.parents, at, first);
        }
        for [a, b, _] in triangles {
            join(&mut self.parents, *a, *b);
        }
        let components = (0..point_count as u32).filter(|p| self.parents[*p as usize] == *p).count() as u64;
        let euler = point_count as i64 - triangles.len() as i64 / 2;
        Ok((euler, components))
    }

    pub fn bytes(&self) -> usize {
        4 * (self.starts.capacity() + self.parents.capacity()) + 8 * self.fans.capacity()
    }
}

fn root(parents: &mut [u32], mut point: u32) -> u32 {
    while parents[point as usize] != point {
        let above = parents[parents[point as usize] as usize];
        parents[point as usize] = above;
        point = above;
    }
    point
}

fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    let (low, high) = (a.min(b), a.max(b));
    parents[high as usize] = low;
}

/// Whether a grid has a node that is inside.
pub fn is_empty(grid: Grid) -> bool {
    grid.values.len() < NODES || grid.values.iter().all(|value| *value <= 0.0)
}

#[cfg(test)]
mod tests;
