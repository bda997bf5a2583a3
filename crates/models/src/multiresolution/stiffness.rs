//! How much stiffer than the finest mesh of a body a coarser one is.
//!
//! Linear tetrahedra hold every affine deformation and are too stiff for all others, the more so the larger they are: a lobe
//! with two of them across resists bending with a multiple of its stiffness. What a body as a whole does is mostly what is
//! soft in it, so one number for each level brings its moduli down to those with which it yields as the finest mesh does.
//! The loads are those of the body's inertia: `M u` of fields `u` that are polynomials of the place and orthogonal in the masses.
//! A body that is free bears the eighteen quadratic ones, that are in balance by themselves. One that is compared as it is held bears those of all thirty
//! up to the second degree, its weight and what turns it among them, as most of what is too stiff may be where it is held. The compliance
//! `Σ f·K⁻¹f` does not depend on the axes chosen.

use std::sync::Arc;

use rayon::prelude::*;
use souple_math::{Mat3, Vec3};
use souple_solve::krylov::{ConjugateGradientWorkspace, Settings, conjugate_gradient};
use souple_solve::precondition::IncompleteCholesky;
use souple_solve::{BlockMatrix, Pattern, SolveError};

use super::links::{Hierarchy, Tet};
use super::matter::Matter;
use super::supports::Supports;
use crate::materials::Lame;

/// Monomials up to the second degree in the place.
const MONOMIALS: usize = 10;
/// Of these, up to the first.
const AFFINE: usize = 4;
/// Compliances are off by about the square of this, relatively.
const SOLVE: Settings = Settings { tolerance: 0.02, max_iterations: 1000 };

const ALL: Vec3 = Vec3::new(1.0, 1.0, 1.0);

/// A vector without what is along held axes.
fn free_part(v: Vec3, held: [bool; 3]) -> Vec3 {
    let [x, y, z] = std::array::from_fn(|axis| if held[axis] { 0.0 } else { v[axis] });
    Vec3::new(x, y, z)
}

/// Stiffness at rest of one level, on its points: `K_ij = Σ V ((λ g_i g_jᵀ) + μ (g_j g_iᵀ + g_i·g_j 1))`, where they are not held.
fn stiffness_of(
    hierarchy: &Hierarchy,
    matter: &Matter,
    level: usize,
    held: &[[bool; 3]],
) -> Result<BlockMatrix, SolveError> {
    let (points, tets) = (&hierarchy.levels[level], &hierarchy.tets_of_level[level]);
    let free = |row: u32| held.get(points.start + row as usize).map(|held| free_part(ALL, *held));
    let own = |corners: [u32; 4]| corners.map(|corner| corner - points.start as u32);
    let parts: Vec<(&Tet, Lame, f64)> = matter
        .slots
        .iter()
        .flatten()
        .filter(|sample| tets.contains(&(sample.tet as usize)))
        .map(|sample| {
            let moduli = matter.material(sample).small_strain;
            (&hierarchy.tets[sample.tet as usize], moduli, sample.volume)
        })
        .collect();
    let cliques: Vec<[u32; 4]> = parts.iter().map(|(tet, ..)| own(tet.corners)).collect();
    let pattern = Pattern::from_cliques(points.len(), cliques.iter().map(<[u32; 4]>::as_slice))?;
    let mut matrix = BlockMatrix::zeros(Arc::new(pattern));
    let mut bears = vec![false; points.len()];
    for (tet, moduli, volume) in parts {
        for (row, g) in own(tet.corners).into_iter().zip(tet.gradients) {
            bears[row as usize] = true;
            for (column, h) in own(tet.corners).into_iter().zip(tet.gradients) {
                let block = g.outer(h) * moduli.lambda + h.outer(g) * moduli.mu;
                let mut block = block.plus_diagonal(moduli.mu * g.dot(h)) * volume;
                if let (Some(left), Some(right)) = (free(row), free(column)) {
                    block = Mat3::from_diagonal(left) * block * Mat3::from_diagonal(right);
                }
                matrix.add(row as usize, column as usize, &block)?;
            }
        }
    }
    // a point on which nothing hangs bears no load either
    for (row, _) in bears.iter().enumerate().filter(|(_, bears)| !**bears) {
        matrix.add(row, row, &Mat3::IDENTITY)?;
    }
    let scale = matrix.mean_diagonal();
    for (row, held) in held.get(points.clone()).into_iter().flatten().enumerate() {
        let rest = ALL - free_part(ALL, *held);
        matrix.add(row, row, &(Mat3::from_diagonal(rest) * scale))?;
    }
    Ok(matrix)
}

/// Of each level: its compliance over that of the finest mesh, by which its moduli are to be multiplied for both to yield
/// alike; 1 for the finest, and at most: a coarser mesh is stiffer as it is.
pub fn shares_of_compliance(
    hierarchy: &Hierarchy,
    matter: &Matter,
    masses: &[f64],
    supports: Option<&Supports>,
) -> Vec<f64> {
    let mut shares = vec![1.0; hierarchy.level_count()];
    // a level that does not hold the body alone is compared as if nothing held it
    let is_held = |level: usize| supports.is_some_and(|supports| supports.is_fast && supports.holds[level]);
    let coarser = 0..hierarchy.finest();
    for with_supports in [true, false] {
        let held: &[[bool; 3]] = supports.filter(|_| with_supports).map_or(&[], |supports| &supports.held);
        if coarser.clone().all(|level| is_held(level) != with_supports) {
            continue;
        }
        let mut loads = loads(hierarchy, masses, with_supports);
        let finest = compliance(hierarchy, matter, hierarchy.finest(), held, &loads);
        for level in coarser.clone().rev() {
            hand_on(hierarchy, level, &mut loads);
            if is_held(level) != with_supports {
                continue;
            }
            let share = compliance(hierarchy, matter, level, held, &loads) / finest;
            // a body too small to bend has none; what hangs on next to no matter yields without end, and says nothing of the rest
            if share.is_finite() && share > 0.0 {
                shares[level] = share.min(1.0);
            }
        }
    }
    shares
}

/// Gives the loads of the next finer level to a level, by its links.
fn hand_on(hierarchy: &Hierarchy, level: usize, loads: &mut [Vec<Vec3>]) {
    for load in loads {
        for point in hierarchy.levels[level + 1].clone() {
            let (carrier, force) = (hierarchy.parent(point), std::mem::take(&mut load[point]));
            for (corner, weight) in carrier.corners.into_iter().zip(carrier.weights) {
                load[corner as usize] += force * weight;
            }
        }
    }
}

/// `Σ f·u` with `K u = f` on a level; not finite where its matrix is none that can be solved.
fn compliance(
    hierarchy: &Hierarchy,
    matter: &Matter,
    level: usize,
    held: &[[bool; 3]],
    loads: &[Vec<Vec3>],
) -> f64 {
    let points = hierarchy.levels[level].clone();
    let solved = || -> Result<f64, SolveError> {
        let matrix = stiffness_of(hierarchy, matter, level, held)?;
        // without a support it is definite but for rigid motions, of which balanced loads have no part
        let preconditioner = IncompleteCholesky::new(&matrix)?;
        let bears = |row: usize| matrix.pattern().row(row).len() > 1;
        let of = |load: &Vec<Vec3>| -> f64 {
            let mut workspace = ConjugateGradientWorkspace::default();
            // what nothing resists would yield without end
            let load = load[points.clone()].iter().enumerate();
            let free =
                |row: usize, f: Vec3| held.get(points.start + row).map_or(f, |held| free_part(f, *held));
            let f: Vec<Vec3> =
                load.map(|(row, f)| if bears(row) { free(row, *f) } else { Vec3::ZERO }).collect();
            let mut u = vec![Vec3::ZERO; points.len()];
            // where it stops short of its tolerance, the work of the best so far counts
            conjugate_gradient(&matrix, &preconditioner, &f, &mut u, &SOLVE, &mut workspace);
            f.iter().zip(&u).map(|(f, u)| f.dot(*u)).sum()
        };
        let works: Vec<f64> = loads.par_iter().map(of).collect();
        Ok(works.iter().sum())
    };
    solved().unwrap_or(f64::NAN)
}

/// `M u` of the quadratic fields, and of all below them where the body is held, on the finest points.
fn loads(hierarchy: &Hierarchy, masses: &[f64], is_held: bool) -> Vec<Vec<Vec3>> {
    let points = hierarchy.levels[hierarchy.finest()].clone();
    let monomials = orthonormal_monomials(&hierarchy.rest[points.clone()], masses);
    let load = |(monomial, axis): (&Vec<f64>, Vec3)| {
        let mut f = vec![Vec3::ZERO; hierarchy.point_count()];
        for ((f, value), mass) in f[points.clone()].iter_mut().zip(monomial).zip(masses) {
            *f = axis * (value * mass);
        }
        f
    };
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let first = if is_held { 0 } else { AFFINE };
    let borne = monomials.iter().filter(|(number, _)| *number >= first).map(|(_, values)| values);
    borne.flat_map(|monomial| axes.map(|axis| (monomial, axis))).map(load).collect()
}

/// What is left of a monomial beside those before it, of itself, below which it is none of its own: of points in two planes `z²` is a sum of `1` and
/// `z`, and what is left is rounding.
const OWN: f64 = 1e-6;

/// `1, x, y, z, x², …` at points, made orthonormal in the masses one after the other, by their numbers; without those that are sums of others there.
fn orthonormal_monomials(places: &[Vec3], masses: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let mass: f64 = masses.iter().sum();
    let centre = places.iter().zip(masses).map(|(x, m)| *x * *m).sum::<Vec3>() / mass;
    let size = places.iter().map(|x| (*x - centre).length()).fold(f64::MIN_POSITIVE, f64::max);
    let all = |x: &Vec3| {
        let [x, y, z] = ((*x - centre) / size).to_array();
        [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x]
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).zip(masses).map(|((a, b), mass)| mass * a * b).sum()
    };
    let mut made: Vec<(usize, Vec<f64>)> = Vec::new();
    for monomial in 0..MONOMIALS {
        let mut values: Vec<f64> = places.iter().map(|place| all(place)[monomial]).collect();
        let before = dot(&values, &values).sqrt();
        // the second time takes what rounding has left of the first
        for (_, other) in made.iter().chain(&made) {
            let share = dot(&values, other);
            values.iter_mut().zip(other).for_each(|(value, other)| *value -= share * other);
        }
        let norm = dot(&values, &values).sqrt();
        if norm > OWN * before {
            values.iter_mut().for_each(|value| *value /= norm);
            made.push((monomial, values));
        }
    }
    made
}
