//! Every association of a law, an element with a rule of quadrature, and a cut: what the derivation can be asked for.

use souple_formal::element::Cut;
use souple_mesh::{ElementKind, QuadratureRule};

use crate::derive::{source_law_name, source_name};
use crate::materials::{WRITTEN_LAWS, WrittenLaw};

/// A law on an element under a rule, cut.
#[derive(Clone, Copy)]
pub struct Association {
    pub law: &'static WrittenLaw,
    pub kind: ElementKind,
    pub rule: &'static QuadratureRule,
    pub cut: Cut,
}

/// Every element with every rule; edges have no gradient in a plane or in space to derive a law on.
pub fn variants() -> impl Iterator<Item = (ElementKind, &'static QuadratureRule)> {
    let kinds = ElementKind::ALL.iter().copied().filter(|kind| kind.dimension() > 1);
    kinds.flat_map(|kind| kind.rules().iter().map(move |rule| (kind, rule)))
}

impl Association {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        WRITTEN_LAWS.iter().flat_map(|law| {
            variants()
                .flat_map(move |(kind, rule)| Cut::every().map(move |cut| Self { law, kind, rule, cut }))
        })
    }

    /// The source's name, with the rule where it is not the element's own: `HookeHexa8IDecoupageLG`.
    pub fn name(&self) -> String {
        let rule = if std::ptr::eq(self.rule, self.kind.default_rule()) { "" } else { self.rule.name };
        let separator = if rule.is_empty() { "" } else { "_" };
        format!("{}{}{separator}{rule}{}", source_law_name(self.law.name), source_name(self.kind), self.cut)
    }

    /// The command that derives it.
    pub fn command(&self) -> String {
        format!(
            "souple derive --law {} --element {} --rule {} --cut {}",
            self.law.name,
            self.kind,
            self.rule.name,
            self.cut.name()
        )
    }
}
