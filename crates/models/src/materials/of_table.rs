//! Texts that are laws of the table: bodies run them as those.
//!
//! Looked for are the laws of two moduli that have a value for every `F`. `linear` and `st_venant_kirchhoff` are polynomials of degree four at most
//! in the nine entries of `F`, of which there are 715: a text that is one too, as its instructions tell, is the law with its own moduli
//! at rest where both have the same energy at [`POINTS`] deformations, however it is written. The others are that where the text of the library gives
//! the same instructions with the same numbers.

use std::sync::Arc;

use souple_formal::law::LawParameter;
use souple_math::{Mat3, Vec3};

use super::{AnyLaw, Lame, Material, MaterialLaw, TextLaw, WRITTEN_LAWS};

/// Laws that are polynomials, with their degrees.
const POLYNOMIALS: [(AnyLaw, u32); 2] = [(AnyLaw::Linear, 2), (AnyLaw::StVenantKirchhoff, 4)];
/// Laws that are not, with the powers that they grow by.
const OTHERS: [(AnyLaw, u32); 2] = [(AnyLaw::Corotational, 2), (AnyLaw::StableNeoHookean, 6)];
const POINTS: u32 = 768;
/// Points that show what is worth compiling for comparison.
const FEW: u32 = 16;
/// Of entries of `F - I`, in turn: terms of every degree are the greatest somewhere.
const SIZES: [f64; 4] = [0.1, 0.5, 2.0, 20.0];
/// Of the largest terms: an energy is a hundred operations, and moduli come of sums of a hundred of the second derivatives.
const ROUNDING: f64 = 1e-13;

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
        match self.energy().degree() {
            Some(degree) if degree <= 4 => {
                let moduli = self.small_strain();
                let is_same =
                    |(law, degree): &(AnyLaw, u32)| self.has_energy_of((*law, moduli), *degree, POINTS);
                POLYNOMIALS.iter().find(|candidate| is_same(candidate)).map(|(law, _)| (*law, moduli))
            }
            // neither these laws nor the others
            Some(_) => None,
            None => self.other_of_table(),
        }
    }

    fn has_energy_of(&self, (law, moduli): OfTable, degree: u32, points: u32) -> bool {
        let known = Material::known(law, moduli, moduli, 1.0);
        let modulus = 2.0 * moduli.mu.abs() + moduli.lambda.abs();
        (0..points).all(|point| {
            let F = deformation(point);
            let largest = modulus * (1.0 + F.dot(&F)).sqrt().powi(degree as i32);
            (self.energy_at(&F) - known.energy_density(&F)).abs() <= ROUNDING * largest
        })
    }

    fn other_of_table(&self) -> Option<OfTable> {
        let [(_, LawParameter::Number { value: a, .. }), (_, LawParameter::Number { value: b, .. })] =
            self.text().parameters[..]
        else {
            return None;
        };
        let all = OTHERS.into_iter().flat_map(|law| [[a, b], [b, a]].map(|numbers| (law, numbers)));
        all.filter_map(|((law, degree), [lambda, mu])| {
            let moduli = Lame { mu, lambda };
            // few are looked at more closely
            if !self.has_energy_of((law, moduli), degree, FEW) {
                return None;
            }
            let written = WRITTEN_LAWS.iter().find(|written| written.name == law.entry().name)?;
            let mut text = written.text().ok()?;
            for (name, parameter) in &mut text.parameters {
                let LawParameter::Number { value, .. } = parameter else { return None };
                *value = if name == "mu" { mu } else { lambda };
            }
            let known = Self::compile(text).ok()?;
            known.is_same_program(self).then_some((law, moduli))
        })
        .next()
    }
}

/// One of many in general position: the multiples of nine irrational numbers, without their whole parts.
fn deformation(point: u32) -> Mat3 {
    let size = SIZES[point as usize % SIZES.len()];
    let entry = |prime: f64| size * (2.0 * (f64::from(point + 1) * prime.sqrt()).fract() - 1.0);
    let column = |primes: [f64; 3]| Vec3::new(entry(primes[0]), entry(primes[1]), entry(primes[2]));
    let columns = [[2.0, 3.0, 5.0], [7.0, 11.0, 13.0], [17.0, 19.0, 23.0]].map(column);
    Mat3::IDENTITY + Mat3 { columns }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::law_text;

    fn law_of(energy: &str, definitions: &[(&str, &str)]) -> Option<AnyLaw> {
        let owned = |list: &[(&str, &str)]| -> Vec<(String, String)> {
            list.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
        };
        let parameters = owned(&[("lambda", "20 kPa"), ("mu", "10 kPa")]);
        let text = law_text(energy, &parameters, &owned(definitions)).unwrap();
        let text = TextLaw::known(text).unwrap();
        let small_strain = text.small_strain();
        let material =
            Material { law: MaterialLaw::Text(text), parameters: [0.0; 8], small_strain, density: 1.0 };
        match material.of_table().law {
            MaterialLaw::Known(law) => Some(law),
            MaterialLaw::Text(_) => None,
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
