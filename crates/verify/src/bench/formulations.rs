//! The formulations side by side: time of force and derivative, memory, and the error against the exact force.

use super::laws::{bar, force_times, off};
use super::timing::Held;
use super::{Effort, Figure};

/// What is compared: formulation, element, law; `samples` comes first of each law on each element, and is exact.
const VARIANTS: &[(&str, &str, &str)] = &[
    ("samples", "tet4", "st_venant_kirchhoff"),
    ("grouped_constants", "tet4", "st_venant_kirchhoff"),
    ("tensor_mass", "tet4", "st_venant_kirchhoff"),
    ("four_loops", "tet4", "st_venant_kirchhoff"),
    ("mass_spring", "tet4", "st_venant_kirchhoff"),
    ("samples", "tet4", "linear"),
    ("grouped_constants", "tet4", "linear"),
    ("tensor_mass", "tet4", "linear"),
    ("four_loops", "tet4", "linear"),
    ("samples", "tet4", "corotational"),
    ("element_corotational", "tet4", "corotational"),
    ("samples", "hex8", "st_venant_kirchhoff"),
    ("grouped_constants", "hex8", "st_venant_kirchhoff"),
    ("samples", "hex8", "corotational"),
    ("element_corotational", "hex8", "corotational"),
    ("samples", "prism6", "st_venant_kirchhoff"),
    ("grouped_constants", "prism6", "st_venant_kirchhoff"),
    ("samples", "pyramid5", "st_venant_kirchhoff"),
    ("grouped_constants", "pyramid5", "st_venant_kirchhoff"),
];

/// Elements of the reference bar: about 10,000, and about 100,000.
fn cells(element: &str, is_large: bool) -> u32 {
    match (element, is_large) {
        ("tet4", false) => 6,
        ("tet4", true) => 12,
        ("hex8", false) => 10,
        ("hex8", true) => 21,
        ("prism6", false) => 8,
        ("prism6", true) => 17,
        (_, false) => 6,
        (_, true) => 12,
    }
}

/// One row of figures for each formulation: elements a second, derivative products a second, bytes of an element.
pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    let sizes = effort.choose(&[("10k", false)][..], &[("10k", false), ("100k", true)]);
    for (size, is_large) in sizes {
        let mut exact = None;
        for (formulation, element, law) in VARIANTS {
            let mut settings = bar(element, cells(element, *is_large), law);
            settings.push(format!("bodies.bar.formulation={{ name = \"{formulation}\" }}"));
            let times = force_times(&settings, 1, effort.choose(3, 11))?;
            if *formulation == "samples" {
                exact = Some((times.forces.clone(), times.derivatives.clone()));
            }
            let Some((forces, derivatives)) = &exact else {
                return Err("the exact force comes first".to_owned());
            };
            let of = |error, what: &str| Held { error, error_of: what.to_owned(), baseline: None };
            let row = format!("{name}_{size}_{element}_{law}_{formulation}");
            let force = of(off(forces, &times.forces), "force by samples");
            let derivative = of(off(derivatives, &times.derivatives), "derivative by samples");
            figures.push(times.force.elements_per_second(&format!("{row}_force"), &force));
            figures.push(times.derivative.elements_per_second(&format!("{row}_derivative"), &derivative));
        }
    }
    Ok(figures)
}
