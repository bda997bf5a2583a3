//! The lowest eigenpairs of `K φ = ω² M φ`.
//!
//! Block Krylov iteration on `(K − σ M)⁻¹ M` with Rayleigh–Ritz and restarts (Bathe 1996, §11.6, with a longer
//! subspace): multiple eigenvalues, such as the bending modes of a square bar, are found together.

use souple_math::Vec3;

use crate::direct::Factor;
use crate::mass_basis::{MassBasis, combination, length_of};
use crate::{BlockMatrix, DirectSolver, LinearOperator, SolveError, dense, reduce};

/// Blocks of the subspace between restarts.
const DEPTH: usize = 4;

/// What is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How many eigenpairs.
    pub count: usize,
    /// `σ` [1/s²]: eigenpairs nearest to it are found. Bodies that are free to move have a singular `K` and
    /// need a small negative one.
    pub shift: f64,
    /// Wanted `‖φ − (ω² − σ) (K − σ M)⁻¹ M φ‖ / ‖φ‖`, in the norm of `M`.
    pub tolerance: f64,
    /// Restarts allowed.
    pub max_restarts: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { count: 6, shift: 0.0, tolerance: 1e-10, max_restarts: 200 }
    }
}

/// Eigenpairs, the nearest to the shift first.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// `ω²` [1/s²].
    pub eigenvalues: Vec<f64>,
    /// `φ`, with `φ · M φ = 1`; the largest component is positive.
    pub shapes: Vec<Vec<Vec3>>,
    /// Relative residual of each pair, as in [`Settings::tolerance`].
    pub residuals: Vec<f64>,
    pub restarts: usize,
}

/// Computes eigenpairs of a symmetric stiffness and a positive mass of the same pattern.
///
/// Directions without mass or held by [`BlockMatrix::constrain`] should be given a mass of zero: they then
/// take no part.
///
/// # Errors
/// More pairs asked for than there are unknowns with mass, a matrix that cannot be factorised at this shift, or
/// no convergence.
pub fn lowest_modes(
    stiffness: &BlockMatrix,
    mass: &BlockMatrix,
    coordinates: Option<&[Vec3]>,
    settings: &Settings,
) -> Result<Modes, SolveError> {
    let count = stiffness.block_count();
    let mut shifted = stiffness.clone();
    shifted.add_scaled(-settings.shift, mass)?;
    let mut solver = DirectSolver::analyse_for(Factor::Ldlt, stiffness.pattern(), coordinates)?;
    solver.factorize(&shifted)?;

    // a direction whose own mass is zero has none to share
    let has_mass = |row: usize| (0..3).filter(move |axis| mass.diagonal_block(row).entry(*axis, *axis) > 0.0);
    let available = (0..count).map(|row| has_mass(row).count()).sum();
    let too_many = SolveError::TooManyModes { wanted: settings.count, available };
    if settings.count > available {
        return Err(too_many);
    }
    let width = (settings.count + 4).min(available);
    let mut space = Subspace::new(&solver, mass, count);
    let mut block: Vec<Vec<Vec3>> = (0..width).map(|seed| start_vector(count, seed)).collect();
    let mut worst = f64::INFINITY;
    for restarts in 0..=settings.max_restarts {
        space.clear();
        for depth in 0..DEPTH {
            // the first block filters the start through the inverse once, so that it lies in its range
            let next = if depth == 0 { std::mem::take(&mut block) } else { space.last_images(width) };
            if space.extend(next, available)? == 0 {
                break;
            }
        }
        if space.len() < settings.count {
            return Err(too_many);
        }
        let pairs = space.ritz(width)?;
        // by total order: what is not a number is the worst
        worst =
            pairs.iter().take(settings.count).map(|pair| pair.residual).max_by(f64::total_cmp).unwrap_or(0.0);
        if worst <= settings.tolerance {
            let pairs = &pairs[..settings.count];
            return Ok(Modes {
                eigenvalues: pairs.iter().map(|pair| settings.shift + 1.0 / pair.theta).collect(),
                shapes: pairs.iter().map(|pair| with_positive_peak(pair.shape.clone())).collect(),
                residuals: pairs.iter().map(|pair| pair.residual).collect(),
                restarts,
            });
        }
        block = pairs.into_iter().map(|pair| pair.image).collect();
    }
    Err(SolveError::NotConverged {
        method: "the eigenvalue iteration",
        iterations: settings.max_restarts,
        relative_residual: worst,
        tolerance: settings.tolerance,
        stop: crate::krylov::Stop::IterationLimit,
    })
}

/// An `M`-orthonormal basis `V` with its images `W = (K − σM)⁻¹ M V`.
struct Subspace<'a> {
    solver: &'a DirectSolver,
    mass: &'a BlockMatrix,
    basis: MassBasis<'a>,
    images: Vec<Vec<Vec3>>,
    block_count: usize,
}

/// A Ritz pair `(θ, φ)` of the inverse operator.
struct Ritz {
    theta: f64,
    shape: Vec<Vec3>,
    /// `(K − σM)⁻¹ M φ`.
    image: Vec<Vec3>,
    residual: f64,
}

impl<'a> Subspace<'a> {
    fn new(solver: &'a DirectSolver, mass: &'a BlockMatrix, block_count: usize) -> Self {
        Self { solver, mass, basis: MassBasis::new(mass), images: Vec::new(), block_count }
    }

    fn clear(&mut self) {
        self.basis.clear();
        self.images.clear();
    }

    fn len(&self) -> usize {
        self.basis.len()
    }

    fn last_images(&self, width: usize) -> Vec<Vec<Vec3>> {
        self.images[self.images.len().saturating_sub(width)..].to_vec()
    }

    /// Adds what is new in `vectors`; returns how many were.
    fn extend(&mut self, vectors: Vec<Vec<Vec3>>, largest: usize) -> Result<usize, SolveError> {
        let before = self.len();
        for v in vectors {
            if self.len() == largest {
                break;
            }
            if self.basis.add(v) {
                let mut image = self.basis.weighted[self.len() - 1].clone();
                self.solver.solve(&mut image)?;
                self.images.push(image);
            }
        }
        Ok(self.len() - before)
    }

    /// The `width` pairs of largest `|θ|`.
    fn ritz(&self, width: usize) -> Result<Vec<Ritz>, SolveError> {
        let n = self.len();
        // T = Vᵀ M (K − σM)⁻¹ M V
        let mut projected = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let entry = 0.5
                    * (reduce::dot(&self.basis.weighted[i], &self.images[j])
                        + reduce::dot(&self.basis.weighted[j], &self.images[i]));
                (projected[n * i + j], projected[n * j + i]) = (entry, entry);
            }
        }
        let mut vectors = vec![0.0; n * n];
        dense::eigen(n, &mut projected, &mut vectors);
        let mut order: Vec<usize> = (0..n).collect();
        let theta = |i: usize| projected[n * i + i];
        order.sort_by(|&a, &b| theta(b).abs().total_cmp(&theta(a).abs()).then(a.cmp(&b)));
        let pair = |&i: &usize| {
            let weights = &vectors[n * i..n * i + n];
            let [shape, image] = [&self.basis.vectors, &self.images]
                .map(|family| combination(family, weights, self.block_count));
            // φ − W/θ in the norm of M
            let mut difference = shape.clone();
            reduce::add_scaled(&mut difference, -1.0 / theta(i), &image);
            let mut weighted = vec![Vec3::ZERO; self.block_count];
            self.mass.apply(&difference, &mut weighted);
            let residual = length_of(reduce::dot(&difference, &weighted));
            Ritz { theta: theta(i), shape, image, residual }
        };
        Ok(order.iter().take(width).map(pair).collect())
    }
}

/// A fixed vector without symmetry, different for each seed: the fractional parts of multiples of irrationals.
fn start_vector(count: usize, seed: usize) -> Vec<Vec3> {
    let entry =
        |k: usize| ((k + 1) as f64 * (2.0 + seed as f64 + 0.1).sqrt() * 0.618_033_988_749_895).fract() - 0.5;
    (0..count).map(|i| Vec3::new(entry(3 * i), entry(3 * i + 1), entry(3 * i + 2))).collect()
}

/// The sign in which the largest component is positive.
pub(crate) fn with_positive_peak(mut shape: Vec<Vec3>) -> Vec<Vec3> {
    let components = shape.iter().flat_map(|entry| entry.to_array());
    let peak = components.fold(0.0_f64, |peak, entry| if entry.abs() > peak.abs() { entry } else { peak });
    if peak < 0.0 {
        shape.iter_mut().for_each(|entry| *entry = -*entry);
    }
    shape
}
