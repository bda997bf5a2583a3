//! Formulas, conditions, quantities, units and laws with faults put in by machine: an answer or an error, never a panic.
//!
//! `SOUPLE_MUTATION_SECONDS=600 cargo test -p souple-formal mutations` goes on for ten minutes.

#[path = "../../../fuzz/src/law.rs"]
mod law;
#[path = "../../../fuzz/src/mutator.rs"]
mod mutator;

use mutator::{Mutator, guard, repeat};
use souple_formal::law::{LAW_FUNCTIONS, QUANTITIES};
use souple_formal::{CONSTANTS, Condition, FUNCTIONS, Formula, parse_quantity, parse_unit, quantity_in};

const SEEDS: [&str; 12] = [
    "100 * sin(2 * pi * t) + 0 * x",
    "[0, -10 * exp(-t), max(x, y)^2]",
    "x > 0.5 and (y < z or not (t >= 1))",
    "sqrt(x^2 + y^2) - abs(z) / (1 + t)",
    "-2^-x * 3e-4",
    "if(x < 1, x, 1)",
    "10 kPa",
    "-9.81 m/s^2",
    "30 deg",
    "1.5e-3 kg m^2/s",
    "5 N/mm",
    "1 1/s",
];

const VARIABLES: &[&str] = &["x", "y", "z", "t"];

#[test]
fn mutated_formulas_are_read_or_refused() {
    let seeds: Vec<Vec<u8>> = SEEDS.iter().map(|seed| seed.as_bytes().to_vec()).collect();
    let names =
        FUNCTIONS.iter().map(|function| function.name).chain(CONSTANTS.iter().map(|constant| constant.0));
    let words: Vec<Vec<u8>> = names.map(|name| name.as_bytes().to_vec()).collect();
    let mut read = 0;
    let cases = repeat(20_000, |seed| {
        let content = Mutator::new(seed, words.clone()).mutated(&seeds);
        let Ok(text) = std::str::from_utf8(&content) else { return };
        guard(seed, &content, 2.0, || {
            if let Ok(formula) = Formula::compile(text, VARIABLES) {
                read += 1;
                let _ = formula.evaluate(&[0.1, 0.2, -0.3, 0.4]);
                (0..VARIABLES.len()).for_each(|by| {
                    let _ = formula.differentiate(&[0.1, 0.2, -0.3, 0.4], by);
                });
            }
            let _ = Formula::compile_vector::<3>(text, VARIABLES);
            if let Ok(condition) = Condition::compile(text, VARIABLES) {
                let _ = condition.holds(&[0.1, 0.2, -0.3, 0.4]);
            }
            let _ = (parse_quantity(text), parse_unit(text), quantity_in(text, "Pa"));
        });
    });
    println!("{read} of {cases} mutated texts are formulas");
    assert!(read > cases / 20, "{read} of {cases}");
}

/// Laws are derived, tried and compiled, whatever is left of them; where they are refused, at a place that is theirs.
#[test]
fn mutated_laws_are_derived_or_refused() {
    let seeds: Vec<Vec<u8>> = law::LAW_SEEDS.iter().map(|seed| seed.as_bytes().to_vec()).collect();
    let words = QUANTITIES.iter().chain(LAW_FUNCTIONS).map(|word| word.name);
    let names =
        words.chain(FUNCTIONS.iter().map(|function| function.name)).chain(["energy", "mu", "a1", "k"]);
    let words: Vec<Vec<u8>> = names.map(|name| name.as_bytes().to_vec()).collect();
    let mut read = 0;
    let cases = repeat(4000, |seed| {
        let content = Mutator::new(seed, words.clone()).mutated(&seeds);
        let Ok(text) = std::str::from_utf8(&content) else { return };
        // a law that is derived on one core that others use too takes some hundredths of a second
        guard(seed, &content, 5.0, || read += usize::from(law::try_law(text)));
    });
    println!("{read} of {cases} mutated texts are laws");
    assert!(read > cases as usize / 50, "{read} of {cases}");
}
