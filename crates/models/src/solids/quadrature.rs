//! Which rule of quadrature each kind of element of a body has.

use souple_mesh::{ElementKind, QuadratureRule};

/// Which rule of quadrature integrates the energy of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// Exact for linear elasticity on straight-sided elements; the cheapest that keeps full rank.
    #[default]
    Default,
    /// Exact for St. Venant–Kirchhoff energy too: more samples in hexahedra, prisms and pyramids.
    Full,
    /// Chosen for each kind: the number of its rule, by number of kind.
    Chosen([u8; ElementKind::ALL.len()]),
}

impl Quadrature {
    pub fn rule(self, kind: ElementKind) -> &'static QuadratureRule {
        // where shape functions are linear the strain is constant, and all rules are the one of a single point
        let is_linear = kind.element().basis.iter().all(|monomial| monomial.0.iter().sum::<u8>() <= 1);
        if is_linear {
            return kind.default_rule();
        }
        match self {
            Self::Default => kind.default_rule(),
            Self::Full => kind.full_rule(),
            Self::Chosen(numbers) => &kind.rules()[usize::from(numbers[kind as usize])],
        }
    }

    /// The same but for one kind, which takes `rule`, one of its own.
    #[must_use]
    pub fn with(self, kind: ElementKind, rule: &QuadratureRule) -> Self {
        let number_of = |kind: ElementKind, rule: &QuadratureRule| {
            let number = kind.rules().iter().position(|own| own.name == rule.name);
            number.unwrap_or_else(|| unreachable!("a rule of the kind's own")) as u8
        };
        let mut numbers = [0; ElementKind::ALL.len()];
        for (number, known) in numbers.iter_mut().zip(ElementKind::ALL) {
            *number = number_of(*known, self.rule(*known));
        }
        numbers[kind as usize] = number_of(kind, rule);
        Self::Chosen(numbers)
    }
}
