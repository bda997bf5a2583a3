//! Derived laws, alone and on elements, as files of Rust.

use souple_formal::emit::{
    ElementHeading, Heading, NoKernel, element_kernel as write_element, kernel as write_law,
};
use souple_formal::law::{EnergyLaw, LawText};
use souple_mesh::{ElementKind, QuadratureRule};

use super::{MapKind, element_data};
use crate::materials::{WrittenLaw, lines_of};

/// A law as a file of [`crate::materials`].
///
/// # Errors
/// It is written in principal stretches, or with functions that lanes do not have.
pub fn law_kernel(name: &str, text: &LawText, law: &EnergyLaw) -> Result<String, NoKernel> {
    let (type_name, lines) = (type_name(name), lines_of(text));
    let heading = Heading {
        name: &type_name,
        summary: summary(name),
        written: &lines,
        numbers: has_lame_moduli(law).then_some("Lame"),
    };
    write_law(&law.continued(), &heading)
}

/// A law on an element, with every sample of a rule written out, as a file of [`crate::solids`].
///
/// # Errors
/// As for a law alone; or it names directions.
///
/// # Panics
/// If the element can be no box and is to be one.
pub fn element_kernel(
    name: &str,
    text: &LawText,
    law: &EnergyLaw,
    kind: ElementKind,
    (rule, map): (&QuadratureRule, MapKind),
) -> Result<String, NoKernel> {
    let data = element_data(kind, rule, map)
        .unwrap_or_else(|error| unreachable!("what can be no box is refused before: {error}"));
    let place = if map == MapKind::Box { "_box" } else { "" };
    let type_name = type_name(&format!("{name}_{kind}{place}"));
    let heading = ElementHeading {
        name: &type_name,
        element: kind.name(),
        summary: summary(name),
        written: &lines_of(text),
    };
    write_element(&data, &law.continued(), &heading)
}

/// Whether its numbers are called as Lamé's, for which there is a type; whatever they mean, it has fields for them.
fn has_lame_moduli(law: &EnergyLaw) -> bool {
    let mut names: Vec<&str> = law.parameters.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    names == ["lambda", "mu"]
}

fn summary(name: &str) -> &str {
    WrittenLaw::find(name).map_or("A law", |law| law.summary)
}

/// `holzapfel_gasser_ogden` as `HolzapfelGasserOgden`.
fn type_name(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    };
    name.split('_').map(capital).collect()
}
