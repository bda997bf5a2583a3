//! Polynomials multiplied out: what expressions that are written differently are compared by.

use std::collections::BTreeMap;

/// How many variables there may be.
pub(crate) const VARIABLES: usize = 16;

/// What rounding leaves of the numbers that were added up: dozens of operations, and constants that were computed before.
pub(crate) const ROUNDING: f64 = 1e-13;

/// The powers of the variables in a term.
pub(crate) type Powers = [u8; VARIABLES];

/// Powers of a term without variables.
pub(crate) const CONSTANT: Powers = [0; VARIABLES];

/// The number before a term.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Coefficient {
    pub value: f64,
    /// The sizes of all numbers that were added up to the value: its rounding is in proportion.
    pub size: f64,
}

impl Coefficient {
    fn of(value: f64) -> Self {
        Self { value, size: value.abs() }
    }

    fn is_rounding(self) -> bool {
        self.value.abs() <= ROUNDING * self.size
    }

    fn scaled(self, factor: f64) -> Self {
        Self { value: factor * self.value, size: factor.abs() * self.size }
    }
}

/// A sum of terms by their powers; those that cancelled stay, with their sizes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Polynomial {
    terms: BTreeMap<Powers, Coefficient>,
}

impl Polynomial {
    pub fn constant(value: f64) -> Self {
        let mut sum = Self::default();
        if value != 0.0 {
            sum.terms.insert(CONSTANT, Coefficient::of(value));
        }
        sum
    }

    pub fn variable(index: usize) -> Self {
        let mut powers = CONSTANT;
        powers[index] = 1;
        Self { terms: BTreeMap::from([(powers, Coefficient::of(1.0))]) }
    }

    pub fn terms(&self) -> impl Iterator<Item = (&Powers, &Coefficient)> {
        self.terms.iter()
    }

    /// The number before the term of these powers; zero of size zero where there is none.
    pub fn coefficient(&self, powers: &Powers) -> Coefficient {
        self.terms.get(powers).copied().unwrap_or_default()
    }

    /// The value, if no variable is in it.
    pub fn value(&self) -> Option<f64> {
        let is_constant = self.terms.keys().all(|powers| *powers == CONSTANT);
        is_constant.then(|| self.coefficient(&CONSTANT).value)
    }

    /// Whether it is above zero whatever the variables are: even powers before which no number is below zero, and a constant above.
    pub fn is_positive(&self) -> bool {
        self.coefficient(&CONSTANT).value > 0.0
            && self.terms.iter().all(|(powers, coefficient)| {
                coefficient.value >= 0.0 && powers.iter().all(|power| power % 2 == 0)
            })
    }

    /// Whether both are the same but for rounding.
    pub fn is_same(&self, other: &Self) -> bool {
        self.terms.keys().chain(other.terms.keys()).all(|powers| {
            let (a, b) = (self.coefficient(powers), other.coefficient(powers));
            (a.value - b.value).abs() <= ROUNDING * (a.size + b.size)
        })
    }

    /// Its first number that is not rounding of zero, and the polynomial over the size of that.
    pub fn split_leading(&self) -> Option<(f64, Self)> {
        let leading = self.terms.values().find(|coefficient| !coefficient.is_rounding())?.value;
        Some((leading, self.scaled(1.0 / leading.abs())))
    }

    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |(powers, coefficient): (&Powers, &Coefficient)| (*powers, coefficient.scaled(factor));
        Self { terms: self.terms.iter().map(scaled).collect() }
    }

    fn add_term(&mut self, powers: Powers, Coefficient { value, size }: Coefficient) {
        let sum = self.terms.entry(powers).or_default();
        sum.value += value;
        sum.size += size;
    }
}

/// Adds and multiplies; what it has left bounds the time that goes into it.
#[derive(Debug)]
pub(crate) struct Arithmetic {
    /// Terms that may still be made.
    left: usize,
}

impl Arithmetic {
    pub fn allowing(terms: usize) -> Self {
        Self { left: terms }
    }

    fn spend(&mut self, terms: usize) -> Option<()> {
        self.left = self.left.checked_sub(terms)?;
        Some(())
    }

    /// `None`: that would be too long.
    pub fn add(&mut self, mut a: Polynomial, b: &Polynomial) -> Option<Polynomial> {
        self.spend(b.terms.len())?;
        b.terms.iter().for_each(|(powers, coefficient)| a.add_term(*powers, *coefficient));
        Some(a)
    }

    /// `None`: that would be too long, or of too high a power.
    pub fn multiply(&mut self, a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
        self.spend(a.terms.len() * b.terms.len())?;
        let mut product = Polynomial::default();
        for (of_a, x) in &a.terms {
            for (of_b, y) in &b.terms {
                let mut powers = *of_a;
                for (power, more) in powers.iter_mut().zip(of_b) {
                    *power = power.checked_add(*more)?;
                }
                let both = Coefficient { value: x.value * y.value, size: x.size * y.size };
                product.add_term(powers, both);
            }
        }
        Some(product)
    }

    /// The whole power; `None` as for products.
    pub fn power(&mut self, base: &Polynomial, exponent: u8) -> Option<Polynomial> {
        (0..exponent).try_fold(Polynomial::constant(1.0), |product, _| self.multiply(&product, base))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(x + y)² - (x - y)² = 4xy`: what cancels keeps its size, and says no more than rounding.
    #[test]
    fn squares_are_multiplied_out() {
        let mut arithmetic = Arithmetic::allowing(100);
        let (x, y) = (Polynomial::variable(0), Polynomial::variable(1));
        let sum = arithmetic.add(x.clone(), &y).unwrap();
        let difference = arithmetic.add(x.clone(), &y.scaled(-1.0)).unwrap();
        let [sum, difference] = [sum, difference].map(|base| arithmetic.power(&base, 2).unwrap());
        assert!(!sum.is_positive() && difference.value().is_none());
        let left = arithmetic.add(sum, &difference.scaled(-1.0)).unwrap();
        let product = arithmetic.multiply(&x, &y).unwrap();
        assert!(left.is_same(&product.scaled(4.0)));
        assert!(!left.is_same(&product.scaled(4.0 + 1e-11)));
        assert_eq!(left.split_leading().map(|(leading, _)| leading), Some(4.0));
        let mut square = CONSTANT;
        square[0] = 2;
        assert_eq!(left.coefficient(&square), Coefficient { value: 0.0, size: 2.0 });
    }

    /// What would take too long is left, and powers that have no room.
    #[test]
    fn long_products_are_left() {
        let mut arithmetic = Arithmetic::allowing(50);
        let sum = (0..8).try_fold(Polynomial::constant(1.0), |sum, index| {
            arithmetic.add(sum, &Polynomial::variable(index))
        });
        let sum = sum.unwrap();
        assert_eq!(arithmetic.multiply(&sum, &sum), None);
        assert_eq!(
            Arithmetic::allowing(1000).power(&Polynomial::variable(3), 255).unwrap().terms().count(),
            1
        );
        let x = Polynomial::variable(3);
        let mut arithmetic = Arithmetic::allowing(1000);
        let most = arithmetic.power(&x, 255).unwrap();
        assert_eq!(arithmetic.multiply(&most, &x), None);
    }
}
