//! A world seen from a frame that moves: what is at rest in the frame is pressed by its acceleration.
//!
//! Rows are places in the frame, `X = o + p + R (x - p)` in a world at rest, with the pivot `p`. A body that is carried along a
//! long way, shaken or spun keeps small displacements that way, and what holds it stays where it is.

use std::any::Any;

use souple_engine::tangent::add_block;
use souple_engine::{
    Configuration, Declaration, Energy, Force, Kinematics, Mass, Pair, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::RigidMotion;

/// A frame led through a world at rest.
#[derive(Clone, Debug)]
pub struct MovingFrame {
    motion: RigidMotion,
    /// Over what time accelerations are taken [s].
    resolution: f64,
}

/// How a frame moves at one time, in its own axes.
#[derive(Clone, Copy, Debug)]
struct Acceleration {
    /// Of the pivot [m/s²].
    linear: Vec3,
    /// `Ω` [rad/s]
    spin: Vec3,
    /// `Ω̇` [rad/s²]
    spin_rate: Vec3,
}

impl MovingFrame {
    /// Accelerations are differences of the motion's velocities, over a hundredth of the `timestep` [s]: of a motion that steps
    /// resolve, `ω h < 1`, they are off by `(ω h/100)⁴/30`; at the start, before which a motion may not be known, by
    /// `(ω h/100)⁴/5`.
    pub fn new(motion: RigidMotion, timestep: f64) -> Self {
        Self { motion, resolution: 0.01 * timestep }
    }

    fn turns(&self) -> bool {
        self.motion.rotation.is_some()
    }

    /// A direction of the world at rest in the frame's axes.
    pub fn direction_to_frame(&self, time: f64, world: Vec3) -> Vec3 {
        if self.turns() { self.motion.pose(time).direction_to_shape(world) } else { world }
    }

    fn acceleration(&self, time: f64) -> Acceleration {
        let pose = self.motion.pose(time);
        let at = |steps: f64| {
            let pose = self.motion.pose(time + steps * self.resolution);
            (pose.velocity, pose.angular_velocity)
        };
        // ẏ = (8 (y₊₁ - y₋₁) - (y₊₂ - y₋₂)) / 12 δ, or from y₀ on
        let (steps, weights) = if time < 2.0 * self.resolution {
            ([0.0, 1.0, 2.0, 3.0, 4.0], [-25.0, 48.0, -36.0, 16.0, -3.0])
        } else {
            ([-2.0, -1.0, 0.0, 1.0, 2.0], [1.0, -8.0, 0.0, 8.0, -1.0])
        };
        let velocities = steps.map(at);
        let rate = |of: fn((Vec3, Vec3)) -> Vec3| {
            let terms = velocities.into_iter().zip(weights).map(|(velocity, weight)| of(velocity) * weight);
            terms.sum::<Vec3>() * (1.0 / (12.0 * self.resolution))
        };
        Acceleration {
            linear: pose.direction_to_shape(rate(|(velocity, _)| velocity)),
            spin: pose.direction_to_shape(pose.angular_velocity),
            // Rᵀ ω̇ is Ω̇, since ω x ω is nothing
            spin_rate: pose.direction_to_shape(rate(|(_, spin)| spin)),
        }
    }
}

/// `f = -M (a + Ω̇ x r + 2 Ω x v + Ω x (Ω x r))`: linear acceleration, Euler's, Coriolis' and the centrifugal force.
///
/// Those of acceleration and the centrifugal one have an energy, `m a·r - m |Ω x r|²/2`; Coriolis' does no work. Where the spin
/// changes Euler's force does, which no energy accounts for.
///
/// Source: Goldstein, Poole & Safko 2002, §4.10; Landau & Lifshitz 1976, §39.
#[derive(Clone, Debug)]
pub struct FictitiousForce {
    name: String,
    frame: MovingFrame,
    mass: Mass,
    /// Weight of a translation in each row: what a place in the frame means to it.
    translations: Vec<f64>,
}

impl FictitiousForce {
    /// On the whole mass of a system, lumped or consistent.
    pub fn new(name: impl Into<String>, frame: MovingFrame, mass: &Mass, kinematics: &Kinematics) -> Self {
        let translations = (0..mass.diagonal.len()).map(|row| kinematics.translation_weight(row)).collect();
        Self { name: name.into(), frame, mass: mass.clone(), translations }
    }

    /// `q_b - t_b p`: a place relative to the pivot, as far as the row moves with a translation.
    fn arm(&self, row: usize, position: Vec3) -> Vec3 {
        position - self.frame.motion.pivot * self.translations[row]
    }
}

impl Acceleration {
    /// `Ω̇ x r + Ω x (Ω x r)` as a map of `r`.
    fn of_place(&self) -> Mat3 {
        self.spin_rate.cross_matrix() + self.centrifugal()
    }

    fn centrifugal(&self) -> Mat3 {
        let spin = self.spin.cross_matrix();
        spin * spin
    }

    /// `2 Ω x v` as a map of `v`.
    fn of_velocity(&self) -> Mat3 {
        self.spin.cross_matrix() * 2.0
    }
}

/// A vector for each row, of which the force or a change of it is `-M` times.
fn field(scratch: &mut Scratch) -> &mut Vec<Vec3> {
    scratch.downcast_mut().expect("the scratch of a fictitious force")
}

impl Force for FictitiousForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let turns = self.frame.turns();
        Declaration {
            conservative: !turns,
            velocity_terms: turns,
            symmetric_tangent: !turns,
            ..Declaration::LOAD
        }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(vec![Vec3::ZERO; self.translations.len()])
    }

    // E = Σ_ab m_ab (t_a a·r_b - (Ω x r_a)·(Ω x r_b)/2)
    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let acceleration = self.frame.acceleration(at.time);
        let field = field(scratch);
        for (row, (field, position)) in field.iter_mut().zip(at.positions).enumerate() {
            *field = acceleration.spin.cross(self.arm(row, *position));
        }
        let centrifugal = self.mass.kinetic_energy(field);
        let along = |row: usize| acceleration.linear.dot(self.arm(row, at.positions[row]));
        let own = |(row, mass): (usize, &f64)| mass * self.translations[row] * along(row);
        let shared = |&(a, b, mass): &(u32, u32, f64)| {
            let (a, b) = (a as usize, b as usize);
            mass * (self.translations[a] * along(b) + self.translations[b] * along(a))
        };
        let linear = self.mass.diagonal.iter().enumerate().map(own).sum::<f64>()
            + self.mass.couplings.iter().map(shared).sum::<f64>();
        Energy { stored: at.load * (linear - centrifugal), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let acceleration = self.frame.acceleration(at.time);
        let (of_place, of_velocity) = (acceleration.of_place(), acceleration.of_velocity());
        let field = field(scratch);
        for (row, field) in field.iter_mut().enumerate() {
            *field = acceleration.linear * self.translations[row]
                + of_place * self.arm(row, at.positions[row])
                + of_velocity * at.velocities[row];
        }
        self.mass.add_scaled_product(-at.load, field, out);
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if !self.frame.turns() {
            return;
        }
        let acceleration = self.frame.acceleration(at.time);
        let map = acceleration.of_place() * weights.position + acceleration.of_velocity() * weights.velocity;
        let field = field(scratch);
        for (field, delta) in field.iter_mut().zip(delta) {
            *field = map * *delta;
        }
        self.mass.add_scaled_product(-at.load, field, out);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        if self.frame.turns() {
            (0..self.mass.diagonal.len() as u32).for_each(|row| visit(&[row]));
            self.mass.couplings.iter().for_each(|&(a, b, _)| visit(&[a, b]));
        }
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let acceleration = self.frame.acceleration(at.time);
        let map = acceleration.of_place() * weights.position + acceleration.of_velocity() * weights.velocity;
        self.add_map(&(map * -at.load), matrix);
    }

    // Euler's and Coriolis' parts are skew
    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let map = self.frame.acceleration(at.time).centrifugal();
        self.add_map(&(map * (-at.load * weights.position)), matrix);
    }

    fn bytes(&self) -> usize {
        self.mass.bytes() + size_of_val(self.translations.as_slice())
    }

    fn scratch_bytes(&self, _scratch: &Scratch) -> usize {
        size_of::<Vec3>() * self.translations.len()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl FictitiousForce {
    /// `matrix += M map`.
    fn add_map(&self, map: &Mat3, matrix: &mut BlockMatrix) {
        if !self.frame.turns() {
            return;
        }
        for (row, mass) in self.mass.diagonal.iter().enumerate() {
            add_block(matrix, row, row, &(*map * *mass));
        }
        for &(a, b, mass) in &self.mass.couplings {
            let block = *map * mass;
            add_block(matrix, a as usize, b as usize, &block);
            add_block(matrix, b as usize, a as usize, &block);
        }
    }
}
