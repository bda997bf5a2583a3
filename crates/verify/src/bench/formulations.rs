//! The formulations side by side: time of force and derivative, memory, and the error against the exact force.

use souple_mesh::ElementKind;

use super::laws::{ForceTimes, OfTable, Sampling, TABLE, bar, force_times, off};
use super::timing::{Held, Timed, scene};
use super::{Effort, Figure};

/// How often derived expressions must outrun the literal sums (EXP-20), by law.
const OVER_FOUR_LOOPS: [(&str, f64); 2] = [("st_venant_kirchhoff", 10.0), ("linear", 1.0)];

/// Which kinds of elements take less than which for a derivative product of derived expressions (EXP-26): tetrahedra by far the
/// least, then pyramids, boxes and prisms.
const BY_DERIVATIVE: [(&str, &str); 3] = [("tet4", "pyramid5"), ("pyramid5", "hex8"), ("hex8", "prism6")];

/// The same by derived code that is compiled, in that order, and by what runs without a compiler, which is no more than printed.
const BY_DERIVED: [(&str, Option<f64>); 2] = [("derived", Some(1.0)), ("grouped_constants", None)];

/// What is compared. `samples` is there for each law on each element, and is exact; the one with a shared stiffness is what bodies do where
/// nothing is said.
const FORMULATIONS: [&str; 8] = [
    "samples",
    TAKEN,
    "derived",
    "grouped_constants",
    "tensor_mass",
    "four_loops",
    "element_corotational",
    "mass_spring",
];
const TAKEN: &str = "shared_stiffness";

/// How far from the law by samples what is exact may be: some thousand roundings.
const EXACT: f64 = 1e-9;

/// Cells across the bar for about so many elements.
fn cells(kind: ElementKind, elements: f64) -> u32 {
    let (in_a_cube, across) = match kind.corners() {
        ElementKind::Tet4 | ElementKind::Pyramid5 => (6.0, 3.0),
        ElementKind::Prism6 => (2.0, 3.0),
        ElementKind::Tri3 => (2.0, 2.0),
        other => (1.0, f64::from(other.dimension() as u32)),
    };
    (elements / (10.0 * in_a_cube)).powf(1.0 / across).round() as u32
}

/// A law on an element by one formulation.
struct Measured {
    formulation: &'static str,
    element: &'static str,
    law: &'static str,
    times: ForceTimes,
}

impl Measured {
    /// Every formulation that takes the law on the element; elements of higher order by those of bodies alone: the others are of the
    /// literature on linear ones.
    fn of(kind: ElementKind, of_table: &OfTable, size: f64, effort: Effort) -> Result<Vec<Self>, String> {
        let (law, numbers, _) = *of_table;
        let settings = |across: u32, formulation: &str| {
            let mut settings = bar(kind.name(), across, law);
            // the law that the bar was made with gives way
            settings.pop();
            settings.push(format!("bodies.bar.material={{ name = \"{law}\", {numbers}, density = 1000 }}"));
            settings.push(format!("bodies.bar.formulation={{ name = \"{formulation}\" }}"));
            settings
        };
        // as many samples and nodes
        let across = cells(kind, if kind.is_linear() { size } else { 0.1 * size });
        let asked = if kind.is_linear() { &FORMULATIONS[..] } else { &FORMULATIONS[..3] };
        let mut measured = Vec::new();
        for &formulation in asked {
            // what takes the law by samples and not otherwise has no such formulation
            let is_there = formulation == FORMULATIONS[0]
                || scene("cantilever_dynamic", &settings(1, formulation)).is_ok();
            if is_there {
                let sampling = Sampling {
                    threads: 1,
                    samples: effort.choose(3, 11),
                    in_a_row: 1,
                    force: "bar.material",
                    beside: None,
                };
                let times = force_times(&settings(across, formulation), sampling)?;
                measured.push(Self { formulation, element: kind.name(), law, times });
            }
        }
        Ok(measured)
    }

    /// Of force and derivative, against the law by samples.
    fn errors(&self, exact: &Self) -> [f64; 2] {
        let Self { times, .. } = self;
        [off(&exact.times.forces, &times.forces), off(&exact.times.derivatives, &times.derivatives)]
    }
}

/// Figures of each law on each element by each formulation: elements a second, derivative products a second, bytes of an element;
/// of each pair how much faster what bodies take is than the fastest exact formulation beside it; then how much faster derived
/// expressions are than the literal sums of the tensor-mass method, and than the law by samples.
pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    let sizes = effort.choose(&[("10k", 1e4)][..], &[("10k", 1e4), ("100k", 1e5)]);
    for (size, elements) in sizes {
        let name = format!("{name}_{size}");
        let mut compared = Vec::new();
        for kind in ElementKind::ALL.iter().copied().filter(|kind| kind.dimension() > 1) {
            for of_table in &TABLE {
                let measured = Measured::of(kind, of_table, *elements, effort)?;
                figures.extend(of_pair(&name, &measured)?);
                let is_compared = |one: &Measured| COMPARED.contains(&one.formulation);
                compared.extend(measured.into_iter().filter(is_compared).filter(|one| {
                    kind.is_linear() && OVER_FOUR_LOOPS.iter().any(|(law, _)| *law == one.law)
                }));
            }
        }
        figures.extend(comparisons(&name, &compared)?);
    }
    Ok(figures)
}

/// What derived expressions are compared with, and they.
const COMPARED: [&str; 4] = ["samples", "derived", "grouped_constants", "four_loops"];

fn of_pair(name: &str, measured: &[Measured]) -> Result<Vec<Figure>, String> {
    let exact = measured.first().ok_or("the law by samples is measured")?;
    let mut figures = Vec::new();
    for one in measured {
        let [force, derivative] = one.errors(exact);
        let held = |error, what: &str| Held { error, error_of: what.to_owned(), baseline: None };
        let row = format!("{name}_{}_{}_{}", one.element, one.law, one.formulation);
        let (force, derivative) =
            (held(force, "force by samples"), held(derivative, "derivative by samples"));
        figures.push(one.times.force.elements_per_second(&format!("{row}_force"), &force));
        figures.push(one.times.derivative.elements_per_second(&format!("{row}_derivative"), &derivative));
    }
    let taken = measured.iter().find(|one| one.formulation == TAKEN).ok_or("bodies take every law")?;
    let seconds = |one: &Measured| least(&one.times.force) + least(&one.times.derivative);
    let others = measured.iter().filter(|one| one.formulation != TAKEN);
    let fastest = others
        .filter(|one| one.errors(exact).iter().all(|error| *error < EXACT))
        .min_by(|a, b| seconds(a).total_cmp(&seconds(b)))
        .ok_or("the law by samples is exact")?;
    let held = Held {
        error: f64::max(taken.errors(fastest)[0], taken.errors(fastest)[1]),
        error_of: format!(
            "forces and derivatives by {}, the fastest exact of the others",
            fastest.formulation
        ),
        baseline: None,
    };
    let row = format!("{name}_{}_{}_taken_over_{}", taken.element, taken.law, fastest.formulation);
    figures.push(taken.times.force.times_as_fast(&format!("{row}_force"), &fastest.times.force, &held));
    figures.push(taken.times.derivative.times_as_fast(
        &format!("{row}_derivative"),
        &fastest.times.derivative,
        &held,
    ));
    Ok(figures)
}

/// The least time, of the processor where it is known.
fn least(timed: &Timed) -> f64 {
    let times = if timed.processor.is_empty() { &timed.seconds } else { &timed.processor };
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

fn comparisons(name: &str, measured: &[Measured]) -> Result<Vec<Figure>, String> {
    let of = |formulation: &str, element: &str, law: &str| {
        let is_it = |one: &&Measured| (one.formulation, one.element, one.law) == (formulation, element, law);
        measured.iter().find(is_it).map(|one| &one.times).ok_or("it is among what is measured")
    };
    let mut figures = Vec::new();
    for (law, wanted) in OVER_FOUR_LOOPS {
        let derived = of("grouped_constants", "tet4", law)?;
        for (other, wanted) in [("four_loops", Some(wanted)), ("samples", None)] {
            let row = format!("{name}_tet4_{law}_over_{other}");
            figures.extend(ratios(&row, wanted, derived, of(other, "tet4", law)?));
        }
    }
    for (formulation, wanted) in BY_DERIVED {
        for (element, other) in BY_DERIVATIVE {
            let [first, second] = [element, other].map(|kind| of(formulation, kind, "st_venant_kirchhoff"));
            let row = format!("{name}_derivative_{formulation}_{element}_over_{other}");
            figures.push(per_element(&row, wanted, first?, second?));
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
