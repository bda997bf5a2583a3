//! Laws as texts of lines, for the fuzz target and for the ordinary tests of `souple-formal`.

use souple_formal::law::{EnergyLaw, LawParameter, LawText};
use souple_formal::parse_quantity;
use souple_formal::tape::{Part, Tape};
use souple_math::{Mat3, Vec3};

/// What mutations start from: a law of each kind of word that there is.
pub const LAW_SEEDS: &[&str] = &[
    "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2",
    "lambda: 20 kPa\nmu: 10 kPa\nenergy: lambda/2*tr(E)^2 + mu*dot(E, E)",
    "lambda: 20 kPa\nmu: 10 kPa\nenergy: lambda/2*tr(eps)^2 + mu*dot(eps, eps)",
    "c10: 4 kPa\nc01: 1 kPa\nk: 100 kPa\nenergy: c10*(I1_bar - 3) + c01*(I2_bar - 3) + k/2*(J - 1)^2",
    "mu: 6 kPa\na: 1.8\nk: 0.1 MPa\ns1: J^(-1/3)*l1\ns2: J^(-1/3)*l2\ns3: J^(-1/3)*l3\n\
     energy: mu/a*(s1^a + s2^a + s3^a - 3) + k/2*(J - 1)^2",
    "c: 3 kPa\nk1: 2 kPa\nk2: 0.84\na1: 0.8746 0.4848 0\ne1: max(J^(-2/3)*I4(a1) - 1, 0)\n\
     energy: c/2*(I1_bar - 3) + k1/(2*k2)*(exp(k2*e1^2) - 1) + c*I5(a1)*0 + 30*c*(J - 1)^2",
    "m: 1 Pa\nx: if(J > 1 and J < 2, (J - 1)^2, -clamp(1 - J, 0, 9)^3)\n\
     energy: m*x + m*dot(sym(inv(C)) - I, dev(cof(F)*transpose(F)))^2 + m*det(E) + m*C12^2 + m*dot([1, 0, 0], B*[0, 1, 0])^2",
];

/// Lines `name: text`. That of `energy` is the energy; a quantity is a parameter, three numbers a direction, anything else a
/// definition. A text without `energy:` is an energy as a whole.
pub fn law_of_lines(content: &str) -> LawText {
    let mut law = LawText::default();
    if !content.contains("energy:") {
        law.energy = content.to_owned();
        return law;
    }
    for line in content.lines() {
        let Some((name, text)) = line.split_once(':') else { continue };
        let (name, text) = (name.trim().to_owned(), text.trim());
        let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
        match (parse_quantity(text), numbers.as_slice()) {
            _ if name == "energy" => text.clone_into(&mut law.energy),
            (_, [x, y, z]) => law.parameters.push((name, LawParameter::Direction([*x, *y, *z]))),
            (Ok(quantity), _) => {
                let dimension = Some(quantity.dimension).filter(|_| text.contains(' '));
                law.parameters.push((name, LawParameter::Number { value: quantity.value, dimension }));
            }
            _ => law.definitions.push((name, text.to_owned())),
        }
    }
    law
}

/// Compiles and runs a law; whether it is one.
///
/// # Panics
/// If an error does not point into the text, a law is not at rest where there is no strain, or its tape gives another energy than its
/// graph.
pub fn try_law(content: &str) -> bool {
    let text = law_of_lines(content);
    let law = match EnergyLaw::compile(&text) {
        Ok(law) => law,
        Err(error) => {
            let definition = text.definitions.iter().find(|(name, _)| *name == error.part);
            let part = definition.map_or(text.energy.as_str(), |(_, definition)| definition.as_str());
            if let Some(span) = error.span {
                assert!(part.get(span.start..span.end).is_some(), "{error:?} beside {part:?}");
            }
            let _ = error.explained(part);
            return false;
        }
    };
    let rest = Mat3::identity(1.0);
    assert!(law.stress_at(&rest).is_finite() && law.stiffness.iter().all(|number| number.is_finite()));
    let columns = [[1.1, 0.1, -0.05], [-0.2, 0.95, 0.1], [0.03, -0.1, 1.2]].map(Vec3::from_array);
    let [a, b, c] = columns;
    let strained = Mat3::from_columns(a, b, c);
    let outputs = [law.energy, law.stress, law.differential];
    let values = law.evaluate(&outputs, &strained, &rest);
    let tape = Tape::compile(&law, &outputs);
    let mut memory = vec![0.0; tape.memory_len()];
    tape.prepare(&mut memory);
    for entry in 0..9 {
        memory[tape.deformation(entry)] = strained.columns[entry / 3].to_array()[entry % 3];
        memory[tape.variation(entry)] = rest.columns[entry / 3].to_array()[entry % 3];
    }
    tape.run_here(Part::Deformation, 1, &mut memory);
    tape.run_here(Part::Variation, 1, &mut memory);
    for (index, output) in outputs.iter().enumerate() {
        let expected = values.of(*output);
        let scale = expected.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
        // what cancels, or is beyond what numbers hold, is not compared
        if scale.is_finite() && scale > 1e-6 * law.energy_at(&strained).abs() {
            for (entry, expected) in expected.iter().enumerate() {
                let found = memory[tape.output(index, entry)];
                assert!((found - expected).abs() <= 1e-6 * scale, "{content}: {found} for {expected}");
            }
        }
    }
    true
}
