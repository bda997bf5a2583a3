//! The formulations side by side: time of force and derivative, memory, and the error against the exact force.

use super::laws::{ForceTimes, Sampling, bar, force_times, off};
use super::timing::Held;
use super::{Effort, Figure};

/// How often derived expressions must outrun the literal sums (EXP-20), by law.
const OVER_FOUR_LOOPS: [(&str, f64); 2] = [("st_venant_kirchhoff", 10.0), ("linear", 1.0)];

/// Which kinds of elements take less than which for a derivative product of derived expressions (EXP-26): tetrahedra by far the
/// least. Boxes and prisms are as many operations in tensors, so that either may be the faster: no more than printed.
const BY_DERIVATIVE: [(&str, &str, Option<f64>); 4] = [
    ("tet4", "pyramid5", Some(1.0)),
    ("pyramid5", "hex8", Some(1.0)),
    ("pyramid5", "prism6", Some(1.0)),
    ("hex8", "prism6", None),
];

/// Formulation, element, law.
type Variant = (&'static str, &'static str, &'static str);

/// What is compared; `samples` is there for each law on each element, and is exact.
const VARIANTS: &[Variant] = &[
    ("samples", "tet4", "st_venant_kirchhoff"),
    ("derived", "tet4", "st_venant_kirchhoff"),
    ("grouped_constants", "tet4", "st_venant_kirchhoff"),
    ("tensor_mass", "tet4", "st_venant_kirchhoff"),
    ("four_loops", "tet4", "st_venant_kirchhoff"),
    ("mass_spring", "tet4", "st_venant_kirchhoff"),
    ("samples", "tet4", "linear"),
    ("derived", "tet4", "linear"),
    ("grouped_constants", "tet4", "linear"),
    ("tensor_mass", "tet4", "linear"),
    ("four_loops", "tet4", "linear"),
    ("samples", "tet4", "corotational"),
    ("element_corotational", "tet4", "corotational"),
    ("samples", "hex8", "st_venant_kirchhoff"),
    ("derived", "hex8", "st_venant_kirchhoff"),
    ("grouped_constants", "hex8", "st_venant_kirchhoff"),
    ("samples", "hex8", "linear"),
    ("derived", "hex8", "linear"),
    ("shared_stiffness", "hex8", "linear"),
    ("grouped_constants", "hex8", "linear"),
    ("samples", "hex8", "corotational"),
    ("element_corotational", "hex8", "corotational"),
    ("samples", "prism6", "st_venant_kirchhoff"),
    ("derived", "prism6", "st_venant_kirchhoff"),
    ("grouped_constants", "prism6", "st_venant_kirchhoff"),
    ("samples", "prism6", "linear"),
    ("derived", "prism6", "linear"),
    ("shared_stiffness", "prism6", "linear"),
    ("samples", "pyramid5", "linear"),
    ("derived", "pyramid5", "linear"),
    ("shared_stiffness", "pyramid5", "linear"),
    ("samples", "pyramid5", "st_venant_kirchhoff"),
    ("derived", "pyramid5", "st_venant_kirchhoff"),
    ("grouped_constants", "pyramid5", "st_venant_kirchhoff"),
    ("samples", "tri3", "linear"),
    ("derived", "tri3", "linear"),
    ("samples", "tri3", "st_venant_kirchhoff"),
    ("derived", "tri3", "st_venant_kirchhoff"),
];

/// Elements of the reference bar: about 10,000, and about 100,000.
fn cells(element: &str, is_large: bool) -> u32 {
    match (element, is_large) {
        ("tet4", false) => 6,
        ("tet4", true) => 12,
        ("hex8", false) => 10,
        ("hex8", true) => 21,
        ("tri3", false) => 22,
        ("tri3", true) => 70,
        ("prism6", false) => 8,
        ("prism6", true) => 17,
        (_, false) => 6,
        (_, true) => 12,
    }
}

/// Figures of each formulation: elements a second, derivative products a second, bytes of an element; then how much faster
/// derived expressions are than the literal sums of the tensor-mass method, and than the law by samples.
pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    let sizes = effort.choose(&[("10k", false)][..], &[("10k", false), ("100k", true)]);
    for (size, is_large) in sizes {
        let mut measured: Vec<(&Variant, ForceTimes)> = Vec::new();
        for variant in VARIANTS {
            let (formulation, element, law) = variant;
            let mut settings = bar(element, cells(element, *is_large), law);
            settings.push(format!("bodies.bar.formulation={{ name = \"{formulation}\" }}"));
            let sampling = Sampling { threads: 1, samples: effort.choose(3, 11), in_a_row: 1, beside: None };
            measured.push((variant, force_times(&settings, sampling)?));
        }
        let of = |wanted: Variant| {
            measured.iter().find(|(variant, _)| **variant == wanted).map(|(_, times)| times)
        };
        for ((formulation, element, law), times) in &measured {
            let exact = of(("samples", element, law)).ok_or("the law by samples is measured too")?;
            let held = |error, what: &str| Held { error, error_of: what.to_owned(), baseline: None };
            let row = format!("{name}_{size}_{element}_{law}_{formulation}");
            let force = held(off(&exact.forces, &times.forces), "force by samples");
            let derivative = held(off(&exact.derivatives, &times.derivatives), "derivative by samples");
            figures.push(times.force.elements_per_second(&format!("{row}_force"), &force));
            figures.push(times.derivative.elements_per_second(&format!("{row}_derivative"), &derivative));
        }
        for (law, wanted) in OVER_FOUR_LOOPS {
            let derived = of(("grouped_constants", "tet4", law)).ok_or("it is among the variants")?;
            for (other, wanted) in [("four_loops", Some(wanted)), ("samples", None)] {
                let other_times = of((other, "tet4", law)).ok_or("it is among the variants")?;
                let row = format!("{name}_{size}_tet4_{law}_over_{other}");
                figures.extend(ratios(&row, wanted, derived, other_times));
            }
        }
        for (element, other, wanted) in BY_DERIVATIVE {
            let [first, second] =
                [element, other].map(|element| of(("grouped_constants", element, "st_venant_kirchhoff")));
            let (first, second) = first.zip(second).ok_or("both are among the variants")?;
            let row = format!("{name}_{size}_derivative_{element}_over_{other}");
            figures.push(per_element(&row, wanted, first, second));
        }
    }
    Ok(figures)
}

/// How many times as many derivative products of an element of the first kind there are in a second as of the other's.
fn per_element(name: &str, wanted: Option<f64>, first: &ForceTimes, second: &ForceTimes) -> Figure {
    let cells = |times: &ForceTimes| times.derivative.cells as f64;
    let held = Held {
        error: f64::max(first.derivative_error, second.derivative_error),
        error_of: "derivatives against differences of the force".to_owned(),
        baseline: wanted,
    };
    let in_one = |times: &ForceTimes| times.derivative.clone().in_parts(cells(times) as usize);
    in_one(first).times_as_fast(name, &in_one(second), &held)
}

/// How much less time the first takes than the second, for forces and for derivatives.
fn ratios(name: &str, wanted: Option<f64>, first: &ForceTimes, second: &ForceTimes) -> [Figure; 2] {
    let errors = [off(&second.forces, &first.forces), off(&second.derivatives, &first.derivatives)];
    let pairs =
        [("force", &first.force, &second.force), ("derivative", &first.derivative, &second.derivative)];
    [0, 1].map(|index| {
        let (what, first, second) = pairs[index];
        let held = Held { error: errors[index], error_of: format!("the other's {what}"), baseline: wanted };
        first.times_as_fast(&format!("{name}_{what}"), second, &held)
    })
}
