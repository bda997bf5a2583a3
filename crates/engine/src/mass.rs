//! Mass over rows: a number per row (lumped), and numbers per pair of rows (consistent).
//!
//! The kinetic energy is `½ Σ m_ab ẋ_a · ẋ_b` whatever the rows belong to; the mass of frames follows from
//! `Tᵀ M T`.

use souple_math::Vec3;

/// Symmetric mass over rows [kg].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mass {
    /// Per row.
    pub diagonal: Vec<f64>,
    /// `(a, b, m_ab)` with `a < b`, sorted, each pair once.
    pub couplings: Vec<(u32, u32, f64)>,
}

impl Mass {
    pub fn new(row_count: usize) -> Self {
        Self { diagonal: vec![0.0; row_count], couplings: Vec::new() }
    }

    /// Adds the couplings of elements; call [`Mass::seal`] when all are in.
    pub fn add(&mut self, a: u32, b: u32, mass: f64) {
        match a.cmp(&b) {
            std::cmp::Ordering::Equal => self.diagonal[a as usize] += mass,
            std::cmp::Ordering::Less => self.couplings.push((a, b, mass)),
            // the transposed entry comes with the other order
            std::cmp::Ordering::Greater => {}
        }
    }

    /// Sorts and sums couplings.
    pub fn seal(&mut self) {
        self.couplings.sort_by_key(|&(a, b, _)| (a, b));
        self.couplings.dedup_by(|later, earlier| {
            let same = (later.0, later.1) == (earlier.0, earlier.1);
            if same {
                earlier.2 += later.2;
            }
            same
        });
        // elements share most of their pairs
        self.couplings.shrink_to_fit();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        8 * self.diagonal.capacity() + size_of::<(u32, u32, f64)>() * self.couplings.capacity()
    }

    pub fn is_lumped(&self) -> bool {
        self.couplings.is_empty()
    }

    /// `out += M x`.
    pub fn add_product(&self, x: &[Vec3], out: &mut [Vec3]) {
        self.add_scaled_product(1.0, x, out);
    }

    /// `out += scale M x`.
    pub fn add_scaled_product(&self, scale: f64, x: &[Vec3], out: &mut [Vec3]) {
        for ((out, x), mass) in out.iter_mut().zip(x).zip(&self.diagonal) {
            *out += *x * (*mass * scale);
        }
        for &(a, b, mass) in &self.couplings {
            out[a as usize] += x[b as usize] * (mass * scale);
            out[b as usize] += x[a as usize] * (mass * scale);
        }
    }

    /// `½ ẋᵀ M ẋ` [J].
    pub fn kinetic_energy(&self, velocities: &[Vec3]) -> f64 {
        let lumped: f64 =
            self.diagonal.iter().zip(velocities).map(|(mass, v)| 0.5 * mass * v.length_sq()).sum();
        let coupled: f64 = self
            .couplings
            .iter()
            .map(|&(a, b, mass)| mass * velocities[a as usize].dot(velocities[b as usize]))
            .sum();
        lumped + coupled
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scale M x` is `scale` times `M x`, lumped and coupled parts alike: exactly so for powers of two.
    #[test]
    fn scaled_products_are_multiples() {
        let mass = Mass { diagonal: vec![2.0, 0.5], couplings: vec![(0, 1, 0.3)] };
        let x = [Vec3::new(1.0, -2.0, 0.7), Vec3::new(0.1, 0.2, 0.3)];
        let (mut once, mut scaled) = ([Vec3::ZERO; 2], [Vec3::ZERO; 2]);
        mass.add_product(&x, &mut once);
        mass.add_scaled_product(-4.0, &x, &mut scaled);
        assert_eq!(scaled, once.map(|force| force * -4.0));
        // vᵀ M v is twice the kinetic energy: a sum of products of order one
        let twice: f64 = once.iter().zip(&x).map(|(p, v)| p.dot(*v)).sum();
        assert!((twice - 2.0 * mass.kinetic_energy(&x)).abs() < 4.0 * f64::EPSILON * twice);
    }
}
