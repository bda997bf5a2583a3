//! What `souple derive` tells: the steps of the derivation, counts of operations and grouped constants, sizes of the code.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde_json::{Value, json};
use souple_formal::element::{Axis, Cut, Derived, ElementData, ElementExpressions};
use souple_formal::emit::{ElementCode, Latex, write};
use souple_formal::graph::Operations;
use souple_formal::law::EnergyLaw;
use souple_mesh::ElementKind;
use souple_models::derive::{
    MapKind, four_loop_operations, source_constant_count, source_fragment_counts, source_law_name,
};
use souple_table::counted;

use crate::command::law_steps::Step;

/// What is told of a derivation.
pub struct Report<'a> {
    pub law: &'a EnergyLaw,
    pub name: &'a str,
    pub element: &'a ElementData,
    pub kind: ElementKind,
    pub map: MapKind,
    /// As bodies run them, in tensors: forces and differential.
    steps: [Operations; 2],
    /// Constants of an element that those read, and all that it stores, those of the energy too.
    constants: [usize; 2],
    /// Operands of the differential written out that is derived in physical coordinates; of boxes.
    direct: Option<f64>,
}

/// Counts of fragments of one sort, summed.
struct Sums {
    fragments: usize,
    constants: usize,
    step: Operations,
    once: Operations,
    /// Operands per step where no part has a name: what the source's texts are as long as.
    written_out: f64,
}

fn sums(derived: &Derived, fragments: &[ElementExpressions]) -> Sums {
    let mut sums = Sums {
        fragments: fragments.len(),
        constants: 0,
        step: Operations::default(),
        once: Operations::default(),
        written_out: 0.0,
    };
    for fragment in fragments {
        let (step, once) = fragment.operations(&derived.graph);
        sums.constants += fragment.grouped.constants.len();
        sums.step = sums.step + step;
        sums.once = sums.once + once;
        sums.written_out += derived.graph.operands_written_out(&fragment.grouped.varying, |_| false);
    }
    sums
}

/// Grouped constants of each fragment.
fn constants_of(fragments: &[ElementExpressions]) -> Vec<usize> {
    fragments.iter().map(|fragment| fragment.grouped.constants.len()).collect()
}

fn listed(counts: &[usize]) -> String {
    let total: usize = counts.iter().sum();
    let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
    if counts.len() == 1 { counts.join("") } else { format!("{} ({total} in all)", counts.join(" ")) }
}

/// A shape function as text.
fn polynomial(shape: &[(f64, [u8; 4])]) -> String {
    let mut text = String::new();
    for (coefficient, powers) in shape {
        let sign = match (coefficient.is_sign_negative(), text.is_empty()) {
            (true, true) => "-",
            (true, false) => " - ",
            (false, true) => "",
            (false, false) => " + ",
        };
        text += sign;
        let above: Vec<String> =
            ["xi", "eta", "zeta"].iter().zip(powers).filter(|(_, power)| **power > 0).map(power_of).collect();
        let size = coefficient.abs();
        if size != 1.0 || above.is_empty() {
            let _ = write!(text, "{}", (size * 1e12).round() / 1e12);
            text += if above.is_empty() { "" } else { " " };
        }
        text += &above.join(" ");
        if powers[3] > 0 {
            let _ = write!(text, "/{}", power_of((&"(1 - zeta)", &powers[3])));
        }
    }
    text
}

fn power_of((base, power): (&&str, &u8)) -> String {
    if *power == 1 { (*base).to_owned() } else { format!("{base}^{power}") }
}

impl<'a> Report<'a> {
    pub fn new(
        law: &'a EnergyLaw,
        name: &'a str,
        element: &'a ElementData,
        kind: ElementKind,
        map: MapKind,
    ) -> Self {
        let derived = element.steps(law, Cut::NONE);
        let steps =
            [&derived.forces[0], &derived.differentials[0]].map(|step| step.operations(&derived.graph));
        let direct = element.derive_directly(law).map(|direct| direct.operands());
        let places = derived.constant_places();
        let of_steps: BTreeSet<&usize> =
            places.forces.iter().chain(&places.differentials).flatten().collect();
        let constants = [of_steps.len(), places.count];
        Self { law, name, element, kind, map, steps, constants, direct }
    }

    /// Operations and constants in tensors.
    fn in_tensors(&self) -> String {
        let [forces, differential] = self.steps.map(|operations| operations.total());
        let [of_steps, all] = self.constants;
        format!(
            "  in tensors: forces {forces}, differential {differential} operations with {of_steps} constants; {all} with those of the energy\n"
        )
    }

    /// What is counted beside the source: the same by tensors, by four loops, and without a reference element.
    fn comparisons(&self, derived: &Derived) -> String {
        let [forces, differential] = self.steps.map(|operations| operations.total());
        let mut text = format!("\n{}", self.in_tensors());
        if let Some([of_forces, of_differential]) = four_loop_operations(self.kind, self.name) {
            let _ = writeln!(
                text,
                "    by four loops over the nodes:  forces {of_forces}, differential {of_differential}: {:.1} and {:.1} times as many",
                of_forces as f64 / forces as f64,
                of_differential as f64 / differential as f64
            );
        }
        if let Some(direct) = self.direct {
            let ours =
                derived.differentials.iter().map(|fragment| fragment.operands(&derived.graph)).sum::<f64>();
            let _ = writeln!(
                text,
                "  operands of the differential with its constants: {ours}; derived in physical coordinates {direct}: {:.1} times as many",
                direct / ours
            );
        }
        text
    }

    /// The source's counts for such a cut.
    fn source_constants(&self, cut: Cut) -> Option<Vec<usize>> {
        let of_table = || source_fragment_counts(self.kind, self.map, self.name).map(<[usize]>::to_vec);
        match (cut.has(Axis::Law), cut.has(Axis::Gauss)) {
            (false, false) => source_constant_count(self.kind, self.map).map(|count| vec![count]),
            // constant strain has one sample
            (true, gauss) if gauss || self.element.samples.len() == 1 => {
                of_table().filter(|_| self.kind != ElementKind::Hex8)
            }
            (false, true) => of_table().filter(|_| self.kind == ElementKind::Hex8),
            _ => None,
        }
    }

    /// Law and element, and what both make of each other in tensors.
    fn derivation(&self, cut: Cut) -> String {
        let mut text = String::new();
        for step in Step::all(self.law) {
            let _ = writeln!(text, "{}", step.to_text());
        }
        let samples = counted(self.element.samples.len() as u64, "sample");
        let _ = writeln!(text, "on {}, {samples}, expressions cut: {}", self.kind, cut.name());
        for (node, shape) in self.element.shapes.iter().enumerate() {
            let _ = writeln!(text, "  N_{node} = {}", polynomial(shape));
        }
        text + "  F = I + U_xi X_xi^-1, f_n = -sum w det(X_xi) P X_xi^-T dN_n/dxi\n\n"
    }

    pub fn to_text(&self, derived: &mut Derived, [compiled, total]: [f64; 2]) -> String {
        let mut text = self.derivation(derived.cut);
        let _ = writeln!(
            text,
            "  {:<14} {:>9} {:>9} {:>12} {:>12} {:>10} {:>12}",
            "", "fragments", "constants", "ops per step", "ops at start", "functions", "written out"
        );
        for (what, fragments) in [
            ("energy", &derived.energies),
            ("forces", &derived.forces),
            ("differential", &derived.differentials),
        ] {
            let sums = sums(derived, fragments);
            let _ = writeln!(
                text,
                "  {what:<14} {:>9} {:>9} {:>12} {:>12} {:>10} {:>12.4e}",
                sums.fragments,
                sums.constants,
                sums.step.total(),
                sums.once.total(),
                sums.step.functions,
                sums.written_out
            );
        }
        let _ = writeln!(
            text,
            "\n  grouped constants of the energy by fragment: {}",
            listed(&constants_of(&derived.energies))
        );
        if let Some(source) = self.source_constants(derived.cut) {
            let _ = writeln!(text, "    in Faure 2014, tables 3.4-3.7:            {}", listed(&source));
        }
        text += &self.comparisons(derived);
        let (rust, wgsl) = (derived.emit(ElementCode::Rust), derived.emit(ElementCode::Wgsl));
        let _ = writeln!(text, "\n  code: Rust {} bytes, WGSL {} bytes", rust.text.len(), wgsl.text.len());
        let _ = writeln!(
            text,
            "  law compiled in {:.1} ms, element derived in {:.1} ms",
            1e3 * compiled,
            1e3 * (total - compiled)
        );
        text
    }

    pub fn to_json(&self, derived: &mut Derived, [compiled, total]: [f64; 2]) -> Value {
        let counted = |fragments: &[ElementExpressions]| {
            let sums = sums(derived, fragments);
            json!({
                "fragments": sums.fragments,
                "constants": sums.constants,
                "constants_by_fragment": constants_of(fragments),
                "operations_per_step": sums.step.total(),
                "functions_per_step": sums.step.functions,
                "operations_at_start": sums.once.total(),
                "operands_written_out": sums.written_out,
            })
        };
        let [energy, stress, differential] = Step::all(self.law);
        let mut document = json!({
            "law": self.name,
            "element": self.kind.name(),
            "samples": self.element.samples.len(),
            "shape_functions": self.element.shapes.iter().map(|shape| polynomial(shape)).collect::<Vec<_>>(),
            // as the source names such a pair
            "association": source_law_name(self.name) + &derived.name,
            "cut": derived.cut.name(),
            "cut_axes": Axis::ALL.iter().filter(|axis| derived.cut.has(**axis)).count(),
            "energy": energy.to_json(),
            "stress": stress.to_json(),
            "differential": differential.to_json(),
            "on_element": {
                "energy": counted(&derived.energies),
                "forces": counted(&derived.forces),
                "differential": counted(&derived.differentials),
            },
            "in_tensors": {
                "forces": self.steps[0].total(),
                "differential": self.steps[1].total(),
                "constants": self.constants[0],
                "constants_with_energy": self.constants[1],
                "four_loops": four_loop_operations(self.kind, self.name),
            },
            "operands_in_physical_coordinates": self.direct,
            "source_constants": source_constant_count(self.kind, self.map),
            "source_constants_by_fragment": self.source_constants(derived.cut),
            "warnings": self.law.warnings,
            "seconds": { "law": compiled, "element": total - compiled },
        });
        document["code_bytes"] = json!({
            "rust": derived.emit(ElementCode::Rust).text.len(),
            "wgsl": derived.emit(ElementCode::Wgsl).text.len(),
        });
        document
    }

    pub fn latex(&self) -> String {
        let mut text = String::from("\\begin{align*}\n");
        for (symbol, expr) in
            [("\\Psi", self.law.energy), ("P", self.law.stress), ("\\delta P", self.law.differential)]
        {
            let (parts, roots) = write(&self.law.graph, &[expr], &Latex);
            for part in parts {
                let _ = writeln!(text, "  {} \\\\", part.replacen(" = ", " &= ", 1));
            }
            let _ = writeln!(text, "  {symbol} &= {} \\\\", roots[0]);
        }
        let _ = writeln!(text, "  F &= I + \\sum_n U_n\\otimes\\nabla_\\xi N_n\\,X_\\xi^{{-1}} \\\\");
        let _ = writeln!(
            text,
            "  f_n &= -\\sum_{{q=1}}^{{{}}} w_q\\det X_\\xi\\,P\\,X_\\xi^{{-T}}\\nabla_\\xi N_n",
            self.element.samples.len()
        );
        text + "\\end{align*}\n"
    }
}
