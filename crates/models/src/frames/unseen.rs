//! Motions of frames that integration points do not see.
//!
//! A point resists strain where it is, and nowhere else. Frames may move so that matter strains between points alone: such a motion costs
//! nothing. With `K = ∫ ε : ε` at rest, which sees what every law resists, taken at the integration points and again at the cells and points of
//! the mesh, the motion that is missed most is that of the greatest `θ` in `K_mesh φ = θ K_points φ`.

use std::collections::BTreeMap;

use souple_math::{Mat3, Vec3};
use souple_solve::modes::{Settings, lowest_modes};
use souple_solve::{BlockMatrix, Pattern};

use super::{Carried, Frame, ROWS_OF_FRAME, Sample};

/// `θ` beyond which a motion is not seen. The corners of a cell bend three times as much as the two points across it do, squared; a cubic does half
/// as much again, and where weights of frames bend within a cell, corners are alone with the most of it.
const UNSEEN: f64 = 10.0;
/// What is added to `K_points`, of each block of `K_mesh` on the diagonal: motions of the whole strain nothing anywhere, and then count as seen.
const ADDED: f64 = 1e-10;
/// Unknown motions up to which these are looked for: a factor takes less than a second there.
const MOST_UNKNOWNS: usize = 1500;
/// Strains at points for each motion of frames, in the mean, from which on none is taken to go unseen.
const PLENTY: usize = 12;
/// Strains for each motion below which more frames than are looked through are told of by count: points see neighbours' strains again, so that as
/// many strains as motions are not enough.
const FEW: usize = 3;
/// Strains of a point.
const STRAINS: usize = 6;

/// A motion that integration points do not see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unseen {
    /// The frame that moves most in it, where one was found.
    pub frame: Option<usize>,
    /// Root of the mean square of strain over that at integration points; infinite where these see nothing.
    pub times: f64,
}

/// The frames of a body at rest and what they have to say, at its integration points and at its mesh.
#[derive(Clone, Copy, Debug)]
pub struct FramesAtRest<'a> {
    pub frames: &'a [Frame],
    pub is_affine: bool,
    /// Those that something leads, by their numbers: they do not move by themselves.
    pub led: &'a [u32],
    pub samples: &'a [Sample],
    /// At samples.
    pub carried: &'a [Carried],
    /// At cells and at points of the mesh, and the volume that each stands for [m³].
    pub of_mesh: [(&'a [Carried], &'a [f64]); 2],
}

/// `K` of pairs of free frames, the lower number first, and places that each has a say at.
type Pairs = BTreeMap<(u32, u32), [[Mat3; ROWS_OF_FRAME]; ROWS_OF_FRAME]>;

impl FramesAtRest<'_> {
    /// The motion that points miss most, if they miss one.
    pub fn unseen(&self) -> Option<Unseen> {
        let free: Vec<u32> =
            (0..self.frames.len() as u32).filter(|frame| !self.led.contains(frame)).collect();
        let unknowns = 3 * self.blocks() * free.len();
        let strains = STRAINS * self.samples.len();
        // all frames together strain nothing where nothing leads any
        let rigid = if self.led.is_empty() { 6 } else { 0 };
        let told_by_count = Some(Unseen { frame: None, times: f64::INFINITY });
        match () {
            () if unknowns <= rigid => None,
            () if strains < unknowns - rigid => told_by_count,
            () if strains >= PLENTY * unknowns => None,
            () if unknowns > MOST_UNKNOWNS => told_by_count.filter(|_| strains < FEW * (unknowns - rigid)),
            () => self.most_missed(&free),
        }
    }

    fn most_missed(&self, free: &[u32]) -> Option<Unseen> {
        let volumes: Vec<f64> = self.samples.iter().map(|sample| sample.volume).collect();
        let at_points = self.strains_of_pairs(&[(self.carried, &volumes)]);
        let at_mesh = self.strains_of_pairs(&self.of_mesh);
        let blocks = self.blocks();
        let number: BTreeMap<u32, usize> =
            free.iter().enumerate().map(|(index, frame)| (*frame, index)).collect();
        let of = |frame: u32| number.get(&frame).map(|index| (blocks * index) as u32);
        let cliques: Vec<Vec<u32>> = at_points
            .keys()
            .chain(at_mesh.keys())
            .filter_map(|(a, b)| {
                let [a, b] = [of(*a)?, of(*b)?];
                Some((a..a + blocks as u32).chain(b..b + blocks as u32).collect())
            })
            .collect();
        let pattern = Pattern::from_cliques(blocks * free.len(), cliques.iter().map(Vec::as_slice)).ok()?;
        let pattern = std::sync::Arc::new(pattern);
        let assembled = |pairs: &Pairs| {
            let mut matrix = BlockMatrix::zeros(pattern.clone());
            for ((i, j), sums) in pairs {
                let (Some(a), Some(b)) = (of(*i), of(*j)) else { continue };
                for (row, line) in sums[..blocks].iter().enumerate() {
                    for (column, block) in line[..blocks].iter().enumerate() {
                        // blocks of the pattern that was made of these very pairs
                        let _ = matrix.add(a as usize + row, b as usize + column, block);
                        if i != j {
                            let _ = matrix.add(b as usize + column, a as usize + row, &block.transpose());
                        }
                    }
                }
            }
            matrix
        };
        let (mut seen, all) = (assembled(&at_points), assembled(&at_mesh));
        let scales: Vec<f64> =
            (0..pattern.block_count()).map(|block| ADDED * all.diagonal_block(block).trace()).collect();
        for (block, scale) in scales.iter().enumerate() {
            let _ = seen.add(block, block, &(Mat3::IDENTITY * *scale));
        }
        // 1/θ
        let settings = Settings { count: 1, tolerance: 1e-3, ..Settings::default() };
        let (times, shape) = match lowest_modes(&seen, &all, None, &settings) {
            Ok(modes) => (modes.eigenvalues[0].max(0.0).recip().sqrt(), modes.shapes.into_iter().next()),
            // no factor, and no end to what is strained for nothing
            Err(_) => (f64::INFINITY, None),
        };
        (times * times > UNSEEN).then(|| {
            let moved = |index: &usize| -> f64 {
                let of_frame = shape.iter().flat_map(|shape| &shape[index * blocks..(index + 1) * blocks]);
                of_frame.map(|v| v.length_sq()).sum()
            };
            let most = (0..free.len()).max_by(|a, b| moved(a).total_cmp(&moved(b)));
            Unseen { frame: most.filter(|_| shape.is_some()).map(|index| free[index] as usize), times }
        })
    }

    /// Velocity blocks of a frame: its origin's and its spin, or those of its axes.
    fn blocks(&self) -> usize {
        if self.is_affine { ROWS_OF_FRAME } else { 2 }
    }

    /// `Σ V Bᵀ B` over places, of each pair of frames.
    fn strains_of_pairs(&self, places: &[(&[Carried], &[f64])]) -> Pairs {
        let blocks = self.blocks();
        let mut sums = Pairs::new();
        let mut strains: Vec<[[[f64; STRAINS]; 3]; ROWS_OF_FRAME]> = Vec::new();
        for (carried, volume) in places.iter().flat_map(|(all, volumes)| all.iter().zip(*volumes)) {
            strains.clear();
            for (frame, rows) in carried.frames.iter().zip(&carried.rows) {
                let axes = &self.frames[*frame as usize].axes;
                strains.push(std::array::from_fn(|block| {
                    if block < blocks {
                        strains_of(axes, rows, block, self.is_affine)
                    } else {
                        Default::default()
                    }
                }));
            }
            for (a, (i, of_a)) in carried.frames.iter().zip(&strains).enumerate() {
                for (j, of_b) in carried.frames.iter().zip(&strains).skip(a) {
                    let sum = sums.entry((*i, *j)).or_insert([[Mat3::ZERO; ROWS_OF_FRAME]; ROWS_OF_FRAME]);
                    for (line, a) in sum[..blocks].iter_mut().zip(of_a) {
                        for (block, b) in line[..blocks].iter_mut().zip(of_b) {
                            *block += products(a, b) * *volume;
                        }
                    }
                }
            }
        }
        sums
    }
}

/// The strains of unit motions of a velocity block of a frame, component by component, as six numbers whose products are those of `ε`.
fn strains_of(
    axes: &Mat3,
    rows: &[(f64, Vec3); ROWS_OF_FRAME],
    block: usize,
    is_affine: bool,
) -> [[f64; STRAINS]; 3] {
    std::array::from_fn(|component| {
        let unit = Vec3::AXES[component];
        let gradient = if is_affine || block == 0 {
            unit.outer(rows[block].1)
        } else {
            // axes turn, ω × a
            let turned = axes.columns.iter().zip(&rows[1..]);
            turned.fold(Mat3::ZERO, |sum, (axis, (_, gradient))| sum + unit.cross(*axis).outer(*gradient))
        };
        let at = |i: usize, j: usize| 0.5 * (gradient.entry(i, j) + gradient.entry(j, i));
        let shear = std::f64::consts::SQRT_2;
        [at(0, 0), at(1, 1), at(2, 2), shear * at(0, 1), shear * at(1, 2), shear * at(2, 0)]
    })
}

fn products(a: &[[f64; STRAINS]; 3], b: &[[f64; STRAINS]; 3]) -> Mat3 {
    let dot = |x: &[f64; STRAINS], y: &[f64; STRAINS]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let column = |j: usize| Vec3::new(dot(&a[0], &b[j]), dot(&a[1], &b[j]), dot(&a[2], &b[j]));
    Mat3::from_columns(column(0), column(1), column(2))
}
