//! What is written can be read: text by the law language, code by its compilers.

use super::*;
use crate::law::{EnergyLaw, LawParameter, LawText};

fn law(energy: &str) -> EnergyLaw {
    let number = |name: &str, value| (name.to_owned(), LawParameter::Number { value, dimension: None });
    let parameters = vec![number("mu", 3.0), number("lambda", 5.0)];
    EnergyLaw::compile(&LawText { energy: energy.to_owned(), definitions: Vec::new(), parameters })
        .unwrap_or_else(|error| panic!("{}", error.explained(energy)))
}

/// The text of an energy, its parts put back in as definitions, is the same law.
#[test]
fn text_reads_back() {
    for energy in [
        "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2",
        "mu*dot(E, E) + lambda/2*tr(E)^2",
        "mu/2*(I1_bar - 3) + lambda*(exp((J - 1)^2) - 1) - if(J < 0.5, (J - 0.5)^3, 0)*mu",
        "mu*dot(dev(C), dev(C)) + lambda*(sqrt(I3) - 1)^2/(2 + cos(J))",
    ] {
        let first = law(energy);
        let (lines, roots) = write(&first.graph, &[first.energy], &Text);
        let definitions = lines
            .iter()
            .map(|line| line.split_once(" = ").unwrap())
            .map(|(name, text)| (name.to_owned(), text.to_owned()))
            .collect();
        let text = LawText { energy: roots[0].clone(), definitions, parameters: first.parameters.clone() };
        let second =
            EnergyLaw::compile(&text).unwrap_or_else(|error| panic!("{}", error.explained(&roots[0])));
        let deformation = souple_math::Mat3::from_columns(
            souple_math::Vec3::new(1.2, 0.1, -0.2),
            souple_math::Vec3::new(-0.15, 0.4, 0.3),
            souple_math::Vec3::new(0.05, -0.1, 1.1),
        );
        let (a, b) = (first.energy_at(&deformation), second.energy_at(&deformation));
        // the same operations, in an order of their own
        assert!((a - b).abs() <= 1e-13 * a.abs(), "{energy}: {a} {b}\n{}", roots[0]);
    }
}

#[test]
fn latex_of_the_neo_hookean_stress() {
    let law = law("mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2");
    let (lines, roots) = write(&law.graph, &[law.stress], &Latex);
    let all = format!("{} {}", lines.join(" "), roots[0]);
    for part in ["\\mu", "\\lambda", "\\operatorname{cof}", "\\ln", "\\operatorname{det}"] {
        assert!(all.contains(part), "{all}");
    }
    assert_eq!(all.matches('{').count(), all.matches('}').count());
}
