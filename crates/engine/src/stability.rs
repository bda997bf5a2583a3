//! The longest stable step of explicit methods: from the highest frequency of the linearised system.

use souple_math::Vec3;

use crate::force::TangentWeights;
use crate::inertia::solve_mass;
use crate::levels::Filter;
use crate::state::SystemState;
use crate::steppers::Stability;
use crate::system::{Surroundings, System, SystemWorkspace};

/// What the highest frequency allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Highest angular frequency of `M⁻¹ K` [rad/s], from below; of bodies with levels, with the points that are at work in this state.
    pub highest_frequency: f64,
    /// Highest rate of damping, of `M⁻¹ B` [1/s], from below.
    pub highest_damping: f64,
    /// The longest stable step of the system's stepper [s]; infinite where any step is stable. Of one that divides its steps for the points
    /// of bodies with levels, the longest that its shortest interval may be.
    pub longest_step: f64,
    /// The force that has the most to say in what the longest step is of, the fastest oscillation or the strongest damping, by its number.
    pub stiffest: Option<usize>,
}

/// Growth of the fastest oscillation that is borne of methods without a stable step [1/s].
const GROWTH: f64 = 0.1;

/// Iterations of the power method: the Rayleigh quotient of a mesh's spectrum is then within a few percent.
const ITERATIONS: usize = 40;

/// Of the longest step, what is told of it: the frequency that it is of is approached from below.
pub const MARGIN: f64 = 0.95;

/// Highest frequency and rate of damping at the placed state, by the power method on `M⁻¹ K` and `M⁻¹ B` over the unknowns,
/// whatever carries the rows. What may touch later counts as if all of it touched at once, by
/// [`crate::Force::touching_stiffness`]; how it would damp then does not.
///
/// Which points of bodies with levels are at work changes: their own bound is one for all of them,
/// [`crate::levels::Levels::shortest_interval`], and what acts on them from outside is looked at as they are.
///
/// A random-like but fixed start vector; the Rayleigh quotient approaches the highest frequency from below,
/// so the step it allows is taken with a margin of 5 %.
pub fn forecast(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &mut SystemWorkspace,
) -> Forecast {
    let stiffness = TangentWeights { position: -1.0, velocity: 0.0 };
    let damping = TangentWeights { position: 0.0, velocity: -1.0 };
    let (highest, of_stiffness) = highest_eigenvalue(system, state, around, ws, stiffness);
    let highest_frequency = highest.sqrt();
    let is_damped = system.forces.iter().any(|force| force.declaration().velocity_terms);
    let (highest_damping, of_damping) =
        if is_damped { highest_eigenvalue(system, state, around, ws, damping) } else { (0.0, None) };
    let longest = match system.stepper.stability() {
        Stability::Unconditional => f64::INFINITY,
        Stability::Limited(limit) => MARGIN * longest_step(highest_frequency / limit, highest_damping),
        // growth exp(factor ω^(power + 1) h^power t): a tenth a second, and what is damped still falls, h γ < 2
        Stability::Growing { factor, power } => {
            let slow = (GROWTH / (factor * highest_frequency.powi(power + 1))).powf(1.0 / f64::from(power));
            slow.min(MARGIN * longest_step(0.0, highest_damping))
        }
    };
    // of the equation of the longest step, the greater term
    let is_of_damping = match system.stepper.stability() {
        Stability::Unconditional => false,
        Stability::Limited(limit) => {
            0.5 * longest * highest_damping > (longest * highest_frequency / limit).powi(2)
        }
        Stability::Growing { .. } => 0.5 * longest * highest_damping > 0.5,
    };
    let stiffest = if is_of_damping { of_damping } else { of_stiffness };
    let (longest_step, stiffest) = match shortest_of_levels(system) {
        Some((needed, body)) if needed <= longest => (needed, Some(body)),
        _ => (longest, stiffest),
    };
    Forecast { highest_frequency, highest_damping, longest_step, stiffest }
}

/// The shortest interval that the points of a body with levels need [s], and the number of its force.
fn shortest_of_levels(system: &System) -> Option<(f64, usize)> {
    let filter = system.stepper.ticks(1.0).map_or(Filter::None, |(division, _)| division.filter);
    let bodies = system.forces.iter().enumerate();
    let needed = bodies.filter_map(|(index, force)| Some((force.levels()?.shortest_interval(filter), index)));
    needed.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The step at which `(h ω / limit)² + h γ / 2 = 1`: exact for symplectic Euler, whose force sees the velocity
/// of the start, and on the safe side of the Runge–Kutta method's region.
fn longest_step(frequency: f64, damping: f64) -> f64 {
    // h = 2 / (γ/2 + √(γ²/4 + 4 ω²)), without cancellation where ω is small
    let half = 0.5 * damping;
    2.0 / (half + (half * half + 4.0 * frequency * frequency).sqrt())
}

/// Highest eigenvalue of `(TᵀMT)⁻¹ Tᵀ (weights · tangent) T` by the power method over velocity blocks, and the force with the greatest
/// part in it.
fn highest_eigenvalue(
    system: &System,
    state: &SystemState,
    around: &Surroundings,
    ws: &mut SystemWorkspace,
    weights: TangentWeights,
) -> (f64, Option<usize>) {
    let kinematics = &system.kinematics;
    let touching: Vec<_> = system
        .forces
        .iter()
        .map(|force| if weights.position == 0.0 { None } else { force.touching_stiffness() })
        .collect();
    let blocks = kinematics.block_count();
    let mut direction: Vec<Vec3> = (0..blocks).map(start_vector).collect();
    let mut accelerations = vec![Vec3::ZERO; blocks];
    let mut moved = vec![Vec3::ZERO; kinematics.row_count()];
    let mut eigenvalue = 0.0;
    let add_product =
        |index: usize, moved: &[Vec3], ws: &mut SystemWorkspace, product: &mut [Vec3]| match &touching[index]
        {
            Some(stiffness) => stiffness
                .iter()
                .map(|&(row, k)| (row as usize, k))
                .for_each(|(row, k)| product[row] += moved[row] * (-weights.position * k)),
            None => {
                let at = system.view(index, &ws.rows, state, around);
                system.forces[index].add_differential(&at, weights, moved, &mut ws.scratches[index], product);
            }
        };
    for _ in 0..ITERATIONS {
        system.project_free(&mut direction);
        kinematics.velocities_into(&state.q, &direction, &mut moved);
        // Rayleigh quotient (δ·K δ) / (δ·M δ)
        let mut product = std::mem::take(&mut ws.row_force);
        product.fill(Vec3::ZERO);
        (0..system.forces.len()).for_each(|index| add_product(index, &moved, ws, &mut product));
        let tangent: f64 = moved.iter().zip(&product).map(|(d, k)| d.dot(*k)).sum();
        let mass = 2.0 * system.mass.kinetic_energy(&moved);
        ws.row_force = product;
        if !(tangent > 0.0 && mass > 0.0) {
            break;
        }
        eigenvalue = f64::max(eigenvalue, tangent / mass);
        // δ <- M⁻¹ K δ, normalised
        if solve_mass(system, &state.q, ws, &mut accelerations).is_err() {
            break;
        }
        let largest = accelerations.iter().map(|a| a.largest_component()).fold(0.0, f64::max);
        if largest == 0.0 || !largest.is_finite() {
            break;
        }
        direction.iter_mut().zip(&accelerations).for_each(|(d, a)| *d = *a * (1.0 / largest));
    }
    let mut product = std::mem::take(&mut ws.row_force);
    let mut part = |index: usize| -> f64 {
        product.fill(Vec3::ZERO);
        add_product(index, &moved, ws, &mut product);
        moved.iter().zip(&product).map(|(d, k)| d.dot(*k)).sum()
    };
    let parts: Vec<f64> = (0..system.forces.len()).map(&mut part).collect();
    ws.row_force = product;
    let stiffest = (0..parts.len()).filter(|index| parts[*index] > 0.0);
    (eigenvalue, stiffest.max_by(|a, b| parts[*a].total_cmp(&parts[*b])))
}

/// A fixed vector without symmetry: components from a multiplicative hash of the index.
fn start_vector(index: usize) -> Vec3 {
    let number = |salt: u64| {
        let mixed = (index as u64 * 3 + salt + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    Vec3::new(number(0), number(1), number(2))
}

#[cfg(test)]
mod tests {
    use super::longest_step;

    /// Undamped `h = 1/ω` (of the scaled frequency), over-damped `h = 2/γ`, and the equation in between.
    #[test]
    fn the_longest_step_solves_its_equation() {
        assert_eq!(longest_step(4.0, 0.0), 0.25);
        assert_eq!(longest_step(0.0, 8.0), 0.25);
        assert_eq!(longest_step(0.0, 0.0), f64::INFINITY);
        let (frequency, damping) = (3.0, 5.0);
        let step = longest_step(frequency, damping);
        assert!(((step * frequency).powi(2) + 0.5 * step * damping - 1.0).abs() < 1e-14);
    }
}
