//! Texts that are laws of the table: bodies run them as those.
//!
//! Looked for are the laws of two moduli that have a value for every `F`. Their energies are linear in the moduli, so that a text is such a law
//! where, multiplied out, it has the same number before every term as the text of the library with some moduli, however either is written.

use std::sync::{Arc, LazyLock};

use souple_formal::law::{Expanded, Expansion, LawParameter, LawText};

use super::{AnyLaw, Lame, Material, MaterialLaw, TextLaw, WRITTEN_LAWS};

/// The laws that are looked for.
const SOUGHT: [AnyLaw; 4] =
    [AnyLaw::Linear, AnyLaw::StVenantKirchhoff, AnyLaw::Corotational, AnyLaw::StableNeoHookean];

/// A law of the table multiplied out: what its energy has of `μ` and of `λ`.
type MultipliedOut = (AnyLaw, [Expanded; 2]);

/// All that are looked for, and what the variables of their expansions stand for.
static KNOWN: LazyLock<(Expansion, Vec<MultipliedOut>)> = LazyLock::new(|| {
    let mut expansion = Expansion::default();
    let known = SOUGHT.into_iter().filter_map(|law| Some((law, of_moduli(law, &mut expansion)?))).collect();
    (expansion, known)
});

/// A law of the table with its moduli.
type OfTable = (AnyLaw, Lame);

impl Material {
    /// The material with the law of the table that its text is, if it is one; else as it is.
    pub fn of_table(&self) -> Self {
        let MaterialLaw::Text(text) = &self.law else { return self.clone() };
        self.with_law(text.law_of_table())
    }

    /// The name of the law of the table that its text is, if it has one and that is one.
    pub fn text_runs_as(&self) -> Option<&'static str> {
        let MaterialLaw::Text(text) = &self.law else { return None };
        text.law_of_table().map(|(law, _)| law.entry().name)
    }

    fn with_law(&self, law: Option<OfTable>) -> Self {
        law.map_or_else(|| self.clone(), |(law, moduli)| Self::known(law, moduli, moduli, self.density))
    }

    /// [`Self::of_table`] of each; a text that several have is looked at once.
    pub(crate) fn all_of_table(materials: &[Self]) -> Vec<Self> {
        let mut last: Option<(&Arc<TextLaw>, Option<OfTable>)> = None;
        let mut of_table = |material: &'_ Self, text| {
            let law = match last {
                Some((known, law)) if Arc::ptr_eq(known, text) => law,
                _ => text.law_of_table(),
            };
            last = Some((text, law));
            material.with_law(law)
        };
        materials
            .iter()
            .map(|material| match &material.law {
                MaterialLaw::Text(text) => of_table(material, text),
                MaterialLaw::Known(_) => material.clone(),
            })
            .collect()
    }
}

impl TextLaw {
    fn law_of_table(&self) -> Option<OfTable> {
        let (expansion, known) = &*KNOWN;
        let energy = expansion.clone().of(self.text())?;
        known.iter().find_map(|(law, [of_mu, of_lambda])| {
            let [mu, lambda] = energy.as_sum_of([of_mu, of_lambda])?;
            Some((*law, Lame { mu, lambda }))
        })
    }
}

/// The energy of the library's text of a law for each modulus alone.
fn of_moduli(law: AnyLaw, expansion: &mut Expansion) -> Option<[Expanded; 2]> {
    let written = WRITTEN_LAWS.iter().find(|written| written.name == law.entry().name)?;
    let text = written.text().ok()?;
    let mut of_modulus = |modulus: &str| {
        let with_it = |(name, parameter): &(String, LawParameter)| {
            let value = if name == modulus { 1.0 } else { 0.0 };
            let parameter = match parameter {
                LawParameter::Number { dimension, .. } => {
                    LawParameter::Number { value, dimension: *dimension }
                }
                LawParameter::Direction(_) => *parameter,
            };
            (name.clone(), parameter)
        };
        expansion.of(&LawText { parameters: text.parameters.iter().map(with_it).collect(), ..text.clone() })
    };
    Some([of_modulus("mu")?, of_modulus("lambda")?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::law_text;

    /// A text, its parameters, and the law that it is with `μ` and `λ` [Pa].
    type Wording<'a> = (&'a str, &'a [(&'a str, &'a str)], AnyLaw, [f64; 2]);

    /// `λ` and `μ` of the texts [Pa].
    const MODULI: [(&str, &str); 2] = [("lambda", "20 kPa"), ("mu", "10 kPa")];

    fn material(energy: &str, parameters: &[(&str, &str)], definitions: &[(&str, &str)]) -> Material {
        let owned = |list: &[(&str, &str)]| -> Vec<(String, String)> {
            list.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
        };
        let text = law_text(energy, &owned(parameters), &owned(definitions)).unwrap();
        let text = TextLaw::known(text).unwrap();
        let small_strain = text.small_strain();
        Material { law: MaterialLaw::Text(text), parameters: [0.0; 8], small_strain, density: 1.0 }
    }

    fn law_of(energy: &str, definitions: &[(&str, &str)]) -> Option<AnyLaw> {
        match material(energy, &MODULI, definitions).of_table().law {
            MaterialLaw::Known(law) => Some(law),
            MaterialLaw::Text(_) => None,
        }
    }

    /// Texts in other words run as the law, with its moduli to rounding.
    #[test]
    fn moduli_are_found_in_any_wording() {
        const M: [(&str, &str); 2] = [("m", "5 MPa"), ("l", "8 MPa")];
        let (stable, corotational) = (AnyLaw::StableNeoHookean, AnyLaw::Corotational);
        // m = 4/3 μ, l = λ + 5/6 μ
        let of_m = [3.75e6, 8e6 - 5.0 / 6.0 * 3.75e6];
        let lame = [1e4, 2e4];
        let in_other_words: [Wording; 8] = [
            ("l/2*(J - 1)^2 - 3/4*m*(J - 1) + m/2*(I1 - 3 - log((I1 + 1)/4))", &M, stable, of_m),
            ("m/2*(I1 - 3) + l/2*(J - 1 - 3/4*m/l)^2 + m*log(2/sqrt(I1 + 1))", &M, stable, of_m),
            (
                "2/3*mu*(tr(C) - log(1 + tr(C))) + (lambda/2 + 5/12*mu)*(det(F)^2 - 2*J) - mu*J",
                &MODULI,
                stable,
                lame,
            ),
            (
                "lambda/2*(l1 + l2 + l3 - 3)^2 + mu*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2)",
                &MODULI,
                corotational,
                lame,
            ),
            (
                "mu*((l3 - 1)^2 + (l2 - 1)^2 + (l1 - 1)^2) + (3 - l3 - l2 - l1)^2*lambda/2",
                &MODULI,
                corotational,
                lame,
            ),
            ("mu*(I1 - 2*(l1 + l2 + l3)) + lambda/2*(l1 + l2 + l3 - 3)^2", &MODULI, corotational, lame),
            ("mu*tr(E*E) + tr(E)*tr(E)*lambda/2", &MODULI, AnyLaw::StVenantKirchhoff, lame),
            ("mu*dot(E, E)", &[("mu", "10 kPa")], AnyLaw::StVenantKirchhoff, [1e4, 0.0]),
        ];
        for (energy, parameters, law, [mu, lambda]) in in_other_words {
            let of_table = material(energy, parameters, &[]).of_table();
            assert_eq!(of_table.law, MaterialLaw::Known(law), "{energy}");
            let found = of_table.small_strain;
            let off = (found.mu - mu).abs().max((found.lambda - lambda).abs());
            assert!(off <= 1e-13 * (mu + lambda), "{energy}: {found:?}");
        }
    }

    /// What differs from a law by one number, one stretch or one power, or by a term however small, is another.
    #[test]
    fn near_misses_are_no_laws_of_the_table() {
        const STABLE: [(&str, &str); 2] = [("m", "4/3*mu"), ("l", "lambda + 5/6*mu")];
        for (energy, definitions) in [
            (
                "m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1) + 1e-20*mu*(I1 - 3)^2",
                &STABLE[..],
            ),
            ("mu*(I1 - 3 - 2*log((I1 + 2)/5)) + l/2*(J - 1)^2 - 6/5*mu*(J - 1)", &STABLE),
            (
                "mu*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + lambda/2*(l1 + l2 + l3 - 3)^2 + 1e-20*mu*(l1*l2*l3 - 1)^2",
                &[],
            ),
            ("mu*((l1 - 1)^4 + (l2 - 1)^4 + (l3 - 1)^4) + lambda/2*(l1 + l2 + l3 - 3)^2", &[]),
            ("mu*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + lambda/2*(l1*l2*l3 - 1)^2", &[]),
            (
                "mu*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + lambda/2*(l1 + l2 + l3 - 3)^2*(1 + 1e-9*(J - 1))",
                &[],
            ),
        ] {
            assert_eq!(law_of(energy, definitions), None, "{energy}");
        }
    }

    /// By tensors, by invariants and by entries, in other letters and with numbers in the place of letters.
    #[test]
    fn laws_are_seen_however_they_are_written() {
        let svk = Some(AnyLaw::StVenantKirchhoff);
        let entries: Vec<(String, String)> = (1..=3)
            .flat_map(|i| (1..=3).map(move |j| (i, j)))
            .map(|(i, j)| {
                let same = if i == j { " - 1" } else { "" };
                (format!("g{i}{j}"), format!("(F1{i}*F1{j} + F2{i}*F2{j} + F3{i}*F3{j}{same})/2"))
            })
            .collect();
        let entries: Vec<(&str, &str)> = entries.iter().map(|(a, b)| (&**a, &**b)).collect();
        let by_entries =
            "lambda/2*(g11 + g22 + g33)^2 + mu*(g11^2 + g22^2 + g33^2 + 2*g12^2 + 2*g13^2 + 2*g23^2)";
        for (energy, definitions, law) in [
            ("lambda/2*tr(E)^2 + mu*dot(E, E)", &[][..], svk),
            ("mu/4*dot(C - I, C - I) + lambda/8*(I1 - 3)^2", &[], svk),
            ("mu/4*(I1^2 - 2*I2 - 2*I1 + 3) + lambda/8*(I1 - 3)^2", &[], svk),
            (by_entries, &entries, svk),
            ("lambda/2*tr(eps)^2 + mu*dot(eps, eps)", &[], Some(AnyLaw::Linear)),
            (
                "m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1)",
                &[("m", "4/3*mu"), ("l", "lambda + 5/6*mu")],
                Some(AnyLaw::StableNeoHookean),
            ),
            (
                "mu*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + lambda/2*(l1 + l2 + l3 - 3)^2",
                &[],
                Some(AnyLaw::Corotational),
            ),
            // the same moduli at rest
            ("lambda/2*tr(E)^2 + mu*dot(E, E) + 1e-6*mu*tr(E)^3", &[], None),
            ("lambda/2*tr(E)^2 + mu*dot(E, E) + mu*max(tr(E) - 1e4, 0)^3", &[], None),
            // what acts at small strain alone, near collapse, or very far out
            ("lambda/2*tr(E)^2 + mu*dot(E, E) + 2e5*mu*dot(E, E)^2*exp(-2e4*dot(E, E))", &[], None),
            ("lambda/2*tr(E)^2 + mu*dot(E, E) + 1e-60*mu*tr(E)^20", &[], None),
            (
                "m/2*(I1 - 3 - log((I1 + 1)/4)) + l/2*(J - 1)^2 - 3/4*m*(J - 1) + mu*exp(-J^2*1e6)",
                &[("m", "4/3*mu"), ("l", "lambda + 5/6*mu")],
                None,
            ),
            ("mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2", &[], None),
            ("mu*(log(l1)^2 + log(l2)^2 + log(l3)^2) + lambda/2*log(l1*l2*l3)^2", &[], None),
            ("mu/2*(I1 - 3) - mu*(J - 1) + (lambda + mu)/2*(J - 1)^2", &[], None),
        ] {
            assert_eq!(law_of(energy, definitions), law, "{energy}");
        }
    }
}
