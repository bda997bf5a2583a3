//! Products with the mass of frames, which couples all four rows of a frame with all four of another.
//!
//! Entry by entry ([`Mass`]) such a product waits for indices; in tiles of four by four it is done at the speed of the
//! processor's registers.

use pulp::{Arch, Simd, WithSimd};
use souple_math::Vec3;

use crate::kinematics::Kinematics;
use crate::mass::Mass;

/// Rows of a frame.
const ROWS: usize = 4;

/// A vector as a register likes it.
type Row = [f64; 4];

/// A mass matrix with the couplings of frames in tiles.
#[derive(Debug, Default)]
pub struct FrameMass {
    /// By the first row of the first frame, then of the second.
    tiles: Vec<Tile>,
    /// What is not between rows of two frames.
    rest: Mass,
    free_rows: usize,
    rows: Vec<Row>,
    products: Vec<Row>,
}

/// Entries between the rows of two frames, or of one with itself.
#[derive(Clone, Copy, Debug)]
struct Tile {
    /// First rows of the frames, `first <= second`.
    first: u32,
    second: u32,
    masses: [[f64; ROWS]; ROWS],
}

impl FrameMass {
    pub fn new(mass: &Mass, kinematics: &Kinematics) -> Self {
        let mut frame_of_row = vec![None; mass.diagonal.len()];
        let mut row = 0;
        for (kind, _) in kinematics.unknowns() {
            // of modes too few are alike to be worth tiles
            if kind.row_count() == ROWS {
                frame_of_row[row..row + ROWS].fill(Some(row as u32));
            }
            row += kind.row_count();
        }
        let mut rest = Mass { diagonal: mass.diagonal.clone(), couplings: Vec::new() };
        let mut tiles = std::collections::BTreeMap::new();
        let mut add = |[first, second]: [u32; 2], at: [u32; 2], mass: f64| {
            let tile = tiles.entry([first, second]).or_insert([[0.0; ROWS]; ROWS]);
            tile[(at[0] - first) as usize][(at[1] - second) as usize] += mass;
        };
        for (row, frame) in frame_of_row.iter().enumerate() {
            if let Some(frame) = *frame {
                add([frame; 2], [row as u32; 2], mass.diagonal[row]);
                rest.diagonal[row] = 0.0;
            }
        }
        // a < b, so that the frame of a does not come after that of b
        for &(a, b, mass) in &mass.couplings {
            match (frame_of_row[a as usize], frame_of_row[b as usize]) {
                (Some(first), Some(second)) => {
                    add([first, second], [a, b], mass);
                    if first == second {
                        add([first, second], [b, a], mass);
                    }
                }
                _ => rest.couplings.push((a, b, mass)),
            }
        }
        let tiles =
            tiles.into_iter().map(|([first, second], masses)| Tile { first, second, masses }).collect();
        let free_rows = kinematics.free_row_count();
        Self { tiles, rest, free_rows, rows: Vec::new(), products: Vec::new() }
    }

    /// `out += scale M x`.
    pub fn add_scaled_product(&mut self, scale: f64, x: &[Vec3], out: &mut [Vec3]) {
        self.rest.add_scaled_product(scale, x, out);
        if self.tiles.is_empty() {
            return;
        }
        self.multiply(x);
        for (out, product) in out.iter_mut().zip(&self.products) {
            *out += Vec3::new(product[0], product[1], product[2]) * scale;
        }
    }

    /// `½ ẋᵀ M ẋ` [J].
    pub fn kinetic_energy(&mut self, velocities: &[Vec3]) -> f64 {
        let rest = self.rest.kinetic_energy(velocities);
        self.multiply(velocities);
        let products = self.products.iter().zip(velocities);
        rest + 0.5 * products.map(|(p, v)| p[0] * v.x + p[1] * v.y + p[2] * v.z).sum::<f64>()
    }

    /// `products = M x` of what is in tiles.
    fn multiply(&mut self, x: &[Vec3]) {
        let Self { tiles, rows, products, free_rows, .. } = self;
        rows.clear();
        rows.extend(x[..*free_rows].iter().map(|x| [x.x, x.y, x.z, 0.0]));
        products.clear();
        products.resize(*free_rows, [0.0; 4]);
        Arch::new().dispatch(Products { tiles, rows, products });
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of::<Tile>() * self.tiles.capacity()
            + self.rest.bytes()
            + size_of::<Row>() * (self.rows.capacity() + self.products.capacity())
    }
}

struct Products<'a> {
    tiles: &'a [Tile],
    rows: &'a [Row],
    products: &'a mut [Row],
}

impl WithSimd for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { tiles, rows, products } = self;
        for Tile { first, second, masses } in tiles {
            let (first, second) = (*first as usize, *second as usize);
            let of_second: [Row; ROWS] = std::array::from_fn(|b| rows[second + b]);
            let mut sums: [Row; ROWS] = std::array::from_fn(|a| products[first + a]);
            for a in 0..ROWS {
                for b in 0..ROWS {
                    for i in 0..4 {
                        sums[a][i] += masses[a][b] * of_second[b][i];
                    }
                }
            }
            products[first..first + ROWS].copy_from_slice(&sums);
            if first == second {
                continue;
            }
            let of_first: [Row; ROWS] = std::array::from_fn(|a| rows[first + a]);
            let mut sums: [Row; ROWS] = std::array::from_fn(|b| products[second + b]);
            for b in 0..ROWS {
                for a in 0..ROWS {
                    for i in 0..4 {
                        sums[b][i] += masses[a][b] * of_first[a][i];
                    }
                }
            }
            products[second..second + ROWS].copy_from_slice(&sums);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::UnknownKind;

    /// Tiles and what is left over are the matrix that they are made of, with a point between the frames and a derived row behind.
    #[test]
    fn tiles_are_the_mass() {
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::RigidFrame, 2);
        kinematics.add_unknowns(UnknownKind::Point, 1);
        kinematics.add_unknowns(UnknownKind::AffineFrame, 1);
        let rows = 14;
        let number = |i: usize| (0.7 * i as f64 + 0.3).sin();
        let mut mass = Mass::new(rows);
        for a in 0..rows as u32 {
            for b in 0..rows as u32 {
                mass.add(a, b, number((a.min(b) * 14 + a.max(b)) as usize));
            }
        }
        mass.seal();
        let x: Vec<Vec3> =
            (0..rows).map(|i| Vec3::new(number(i), number(2 * i + 1), number(5 * i))).collect();
        let (mut expected, mut out) = (vec![Vec3::X; rows], vec![Vec3::X; rows]);
        mass.add_scaled_product(0.3, &x, &mut expected);
        let mut tiled = FrameMass::new(&mass, &kinematics);
        assert_eq!((tiled.tiles.len(), tiled.rest.couplings.len()), (6, 13 + 12));
        tiled.add_scaled_product(0.3, &x, &mut out);
        for (out, expected) in out.iter().zip(&expected) {
            // sums of 14 products of order one
            assert!((*out - *expected).length() < 1e-14);
        }
        assert!((tiled.kinetic_energy(&x) - mass.kinetic_energy(&x)).abs() < 1e-13);
    }
}
