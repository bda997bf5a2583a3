//! Friction of particles against their neighbours: `f_i = k/Σm_j Σ m_j (v_j - v_i)`, as fluids of particles have it.
//!
//! Unlike Kelvin–Voigt's viscosity it is of no material: it damps turns of the whole body, and each resolution otherwise.
//! The filter is the source's: a friction that would speed a particle up, or turn its motion back within the step, is dropped.
//! It takes momentum away, and has no tangent; explicit steppers alone can use it. (Debunne 2000, 3 §3.2, eq. 3.9.)

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

/// What becomes of a friction that would speed a particle up or turn it back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionFilter {
    /// It acts.
    None,
    /// It is dropped, as seen over a step of this length [s].
    Drop { timestep: f64 },
}

/// [`Force`] of friction between neighbours.
pub struct NeighbourFriction {
    name: String,
    first_row: u32,
    /// `k` [N s/m].
    coefficient: f64,
    neighbours: Vec<Vec<u32>>,
    /// Of each point [kg].
    masses: Vec<f64>,
    filter: FrictionFilter,
}

impl NeighbourFriction {
    /// Of points on rows from `first_row`, with their neighbours and masses.
    pub fn new(
        name: String,
        first_row: usize,
        coefficient: f64,
        neighbours: Vec<Vec<u32>>,
        masses: Vec<f64>,
        filter: FrictionFilter,
    ) -> Self {
        Self { name, first_row: first_row as u32, coefficient, neighbours, masses, filter }
    }

    /// `k m_j/Σm` for each neighbour of a point.
    fn shares(&self, point: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let own = &self.neighbours[point];
        let total: f64 = own.iter().map(|other| self.masses[*other as usize]).sum();
        own.iter()
            .map(move |other| (*other as usize, self.coefficient * self.masses[*other as usize] / total))
    }

    fn force(&self, point: usize, velocities: &[Vec3]) -> Vec3 {
        let v = velocities[point];
        self.shares(point).map(|(other, share)| (velocities[other] - v) * share).sum()
    }

    fn filtered(&self, point: usize, velocities: &[Vec3]) -> Vec3 {
        let (force, v) = (self.force(point, velocities), velocities[point]);
        let FrictionFilter::Drop { timestep } = self.filter else { return force };
        let change = force * (timestep / self.masses[point]);
        // of what rests any change does
        let speeds_up = change.dot(v) >= 0.0;
        let turns_back = (v + change).dot(v) < 0.0;
        if speeds_up || turns_back { Vec3::ZERO } else { force }
    }
}

impl Force for NeighbourFriction {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration {
            conservative: false,
            velocity_terms: true,
            // k m_j/Σm is not k m_i/Σm
            symmetric_tangent: false,
            internal: false,
            changing_pattern: false,
        }
    }

    fn energy(&self, _: &Configuration, _: &mut Scratch) -> Energy {
        Energy::default()
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        let own = &at.velocities[self.first_row as usize..];
        for point in 0..self.masses.len() {
            out[self.first_row as usize + point] += self.filtered(point, own);
        }
    }

    fn add_differential(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        let own = &delta[self.first_row as usize..];
        for point in 0..self.masses.len() {
            out[self.first_row as usize + point] += self.force(point, own) * weights.velocity;
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        for (point, others) in (self.first_row..).zip(&self.neighbours) {
            others.iter().for_each(|other| visit(&[point, self.first_row + other]));
        }
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        let row = |point: usize| self.first_row as usize + point;
        for point in 0..self.masses.len() {
            for (other, share) in self.shares(point) {
                let block = Mat3::IDENTITY * (share * weights.velocity);
                add_block(matrix, row(point), row(other), &block);
                add_block(matrix, row(point), row(point), &-block);
            }
        }
    }

    fn bytes(&self) -> usize {
        8 * self.masses.len() + self.neighbours.iter().map(|own| 4 * own.len()).sum::<usize>()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Friction that is filtered never speeds a particle up, nor sets one in motion that rests, and never turns it back within a step.
    #[test]
    fn filtered_friction_only_brakes() {
        let neighbours = vec![vec![1, 2], vec![0], vec![0]];
        let masses = vec![0.1, 0.2, 0.3];
        let timestep = 0.1;
        let filter = FrictionFilter::Drop { timestep };
        let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin();
        for (trial, coefficient) in (0..200).flat_map(|trial| [(trial, 0.3), (trial, 3.0)]) {
            let mut v: Vec<Vec3> = (3 * trial..3 * trial + 3)
                .map(|i| Vec3::new(number(i, 0.1), number(i, 0.2), number(i, 0.3)))
                .collect();
            v[trial % 3] = v[trial % 3] * (trial % 2) as f64;
            let force = NeighbourFriction::new(
                "friction".to_owned(),
                0,
                coefficient,
                neighbours.clone(),
                masses.clone(),
                filter,
            );
            let at = Configuration {
                positions: &[Vec3::ZERO; 3],
                velocities: &v,
                time: 0.0,
                load: 1.0,
                memory: &[],
                pairs: &[],
                kept: souple_engine::KeptRef::default(),
                driven: &[],
                fields: &[],
            };
            let mut out = vec![Vec3::ZERO; 3];
            force.add_force(&at, &mut force.new_scratch(), &mut out);
            for ((f, v), mass) in out.iter().zip(&v).zip(&masses) {
                let next = *v + *f * (timestep / mass);
                assert!(f.dot(*v) <= 0.0 && next.dot(*v) >= 0.0, "{f:?} {v:?}");
                assert!(*v != Vec3::ZERO || *f == Vec3::ZERO, "{f:?}");
            }
        }
    }
}
