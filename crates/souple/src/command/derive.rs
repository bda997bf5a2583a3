//! `souple derive`: a law on an element, derived step by step, counted, and written as code.

use std::fmt::Write as _;

use clap::ValueEnum;
use serde_json::{Value, json};
use souple_formal::element::{Axis, Cut, Derived, ElementExpressions};
use souple_formal::emit::{ElementCode, Latex, Style, Text, write};
use souple_formal::graph::{Expr, Operations};
use souple_formal::law::{EnergyLaw, LawProblem, LawText};
use souple_mesh::ElementKind;
use souple_models::derive::{MapKind, element_data, source_constant_count, source_law_name};
use souple_models::materials::{WRITTEN_LAWS, WrittenLaw, law_text};

use super::{End, Refusal, did_you_mean, print_json, print_line, print_note};

#[derive(clap::Args)]
pub struct Arguments {
    /// An energy density such as "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2", or the name of a law
    #[arg(long)]
    law: String,
    /// tri3, quad4, tet4, hex8, prism6 or pyramid5
    #[arg(long)]
    element: String,
    /// What is printed
    #[arg(long, value_enum, default_value_t = Emit::Stats)]
    emit: Emit,
    /// A material constant of a law given as text, such as mu="1 MPa" or a="[1, 0, 0]"; may be repeated
    #[arg(long = "parameter", value_name = "NAME=VALUE")]
    parameters: Vec<String>,
    /// A name for a part of the energy; may be repeated
    #[arg(long = "define", value_name = "NAME=TEXT")]
    definitions: Vec<String>,
    /// Rule of quadrature, such as gauss_8; the element's usual one where left out
    #[arg(long)]
    rule: Option<String>,
    /// How the rest shape is mapped; boxes need fewer constants
    #[arg(long, value_enum, default_value_t = Map::General)]
    map: Map,
    /// How expressions are cut: none, all, or letters of L (law), G (Gauss points), N (nodes), D (dimension)
    #[arg(long, default_value = "none")]
    cut: String,
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Emit {
    Stats,
    Rust,
    Wgsl,
    Latex,
}

#[derive(Clone, Copy, ValueEnum)]
enum Map {
    General,
    Box,
}

pub fn derive(arguments: &Arguments) -> Result<End, Refusal> {
    let clock = std::time::Instant::now();
    let (name, text) = law_of(arguments)?;
    let law = EnergyLaw::compile(&text).map_err(|error| {
        let definition = text.definitions.iter().find(|(name, _)| *name == error.part);
        let written = definition.map_or(text.energy.as_str(), |(_, text)| text.as_str());
        let expected = match &*error.problem {
            LawProblem::UnknownName { name, .. } => format!(
                "a hyperelastic law whose constants are given, as by `--parameter {name}=\"10 kPa\"` or `--define {name}=TEXT`"
            ),
            _ => "a hyperelastic law".to_owned(),
        };
        Refusal::request("law", text.energy.clone(), expected, error.explained(written))
    })?;
    let compiled_seconds = clock.elapsed().as_secs_f64();
    let kind = ElementKind::from_name(&arguments.element).map_err(|unknown| {
        let expected = format!("one of {}", unknown.known.join(", "));
        Refusal::request("unknown_element", &arguments.element, expected, unknown.to_string())
    })?;
    if kind.dimension() == 1 {
        let message = format!("{kind} has no gradient in a plane or in space to derive a law on");
        return Err(Refusal::request(
            "element",
            &arguments.element,
            "an element of surfaces or volumes",
            message,
        ));
    }
    let rule = match &arguments.rule {
        // the source integrates simplices with constant strain by one sample
        None if matches!(kind, ElementKind::Tri3) => &kind.rules()[0],
        None => kind.default_rule(),
        Some(name) => kind.rule(name).map_err(|unknown| {
            let expected = format!("one of {}", unknown.known.join(", "));
            Refusal::request("unknown_rule", name, expected, unknown.to_string())
        })?,
    };
    let map = match arguments.map {
        Map::General => MapKind::General,
        Map::Box => MapKind::Box,
    };
    let element = element_data(kind, rule, map)
        .map_err(|error| Refusal::request("map", "box", "general", error.to_string()))?;
    let cut = Cut::from_name(&arguments.cut).ok_or_else(|| {
        let message = format!("there is no cut `{}`", arguments.cut);
        Refusal::request("cut", &arguments.cut, "none, all, or letters of L, G, N, D", message)
    })?;
    let mut derived = element
        .derive(&law, cut)
        .map_err(|error| Refusal::request("law", &arguments.law, "a law of invariants", error.to_string()))?;
    // what is known of the laws of the table is on their pages
    for warning in law.warnings.iter().filter(|_| name == TEXT) {
        print_note(format_args!("warning: {warning}"));
    }
    let derived_seconds = clock.elapsed().as_secs_f64();
    let report = Report { law: &law, name: &name, kind, map, samples: rule.points.len() };
    match arguments.emit {
        Emit::Stats => {
            let seconds = [compiled_seconds, derived_seconds];
            if arguments.json {
                print_json(&report.to_json(&mut derived, seconds));
            } else {
                print_line(report.to_text(&mut derived, seconds).trim_end());
            }
        }
        Emit::Latex => emit_text(&report.latex(), "latex", arguments.json),
        Emit::Rust => emit_text(&derived.emit(ElementCode::Rust).text, "rust", arguments.json),
        Emit::Wgsl => emit_text(&derived.emit(ElementCode::Wgsl).text, "wgsl", arguments.json),
    }
    Ok(End::Done)
}

fn emit_text(text: &str, language: &str, as_json: bool) {
    if as_json {
        print_json(&json!({ "language": language, "text": text }));
    } else {
        print_line(text.trim_end());
    }
}

/// The name of a law that is given as text.
const TEXT: &str = "text";

/// The law of that name, or the text.
fn law_of(arguments: &Arguments) -> Result<(String, LawText), Refusal> {
    let pairs = |list: &[String]| -> Result<Vec<(String, String)>, Refusal> {
        list.iter()
            .map(|text| {
                let pair = text.split_once('=').ok_or_else(|| {
                    Refusal::request("parameter", text, "NAME=VALUE", format!("`{text}`: there is no `=`"))
                })?;
                Ok((pair.0.trim().to_owned(), pair.1.trim().to_owned()))
            })
            .collect()
    };
    let (parameters, definitions) = (pairs(&arguments.parameters)?, pairs(&arguments.definitions)?);
    if let Some(law) = WrittenLaw::find(&arguments.law) {
        let text = law.text().map_err(|error| Refusal::work("law", error.to_string()))?;
        return Ok((law.name.to_owned(), text));
    }
    let is_name = arguments.law.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if is_name && arguments.law.len() > 2 {
        let names: Vec<&str> = WRITTEN_LAWS.iter().map(|law| law.name).collect();
        let message = format!(
            "there is no law `{}`{}",
            arguments.law,
            did_you_mean(&arguments.law, names.iter().copied())
        );
        let expected =
            format!("an energy density, or a law that `souple list laws` prints: {}", names.join(", "));
        return Err(Refusal::request("unknown_law", &arguments.law, expected, message));
    }
    let text = law_text(&arguments.law, &parameters, &definitions)
        .map_err(|error| Refusal::request("parameter", "", "a quantity or direction", error.to_string()))?;
    Ok((TEXT.to_owned(), text))
}

struct Report<'a> {
    law: &'a EnergyLaw,
    name: &'a str,
    kind: ElementKind,
    map: MapKind,
    samples: usize,
}

/// Counts of fragments of one sort, summed.
struct Sums {
    fragments: usize,
    constants: usize,
    step: Operations,
    once: Operations,
}

fn sums(derived: &Derived, fragments: &[ElementExpressions]) -> Sums {
    let mut sums = Sums {
        fragments: fragments.len(),
        constants: 0,
        step: Operations::default(),
        once: Operations::default(),
    };
    for fragment in fragments {
        let (step, once) = fragment.operations(&derived.graph);
        sums.constants += fragment.grouped.constants.len();
        sums.step = sums.step + step;
        sums.once = sums.once + once;
    }
    sums
}

impl Report<'_> {
    /// Parts and result of an expression of the law, as text.
    fn written(&self, expr: Expr, style: &dyn Style) -> (Vec<String>, String) {
        let (parts, mut roots) = write(&self.law.graph, &[expr], style);
        (parts, roots.remove(0))
    }

    fn to_text(&self, derived: &mut Derived, [compiled, total]: [f64; 2]) -> String {
        let mut text = String::new();
        let steps = [
            ("energy", "Psi", self.law.energy),
            ("stress, dPsi/dF", "P", self.law.stress),
            ("its differential along dF", "dP", self.law.differential),
        ];
        for (what, symbol, expr) in steps {
            let (parts, result) = self.written(expr, &Text);
            let operations = self.law.graph.operations(&[expr], |_| false).total();
            let _ = writeln!(text, "{what} ({operations} operations)");
            for part in parts {
                let _ = writeln!(text, "    {part}");
            }
            let _ = writeln!(text, "  {symbol} = {result}\n");
        }
        let samples =
            if self.samples == 1 { "1 sample".to_owned() } else { format!("{} samples", self.samples) };
        let _ = writeln!(text, "on {}, {samples}, expressions cut: {}", self.kind, derived.cut.name());
        let _ = writeln!(text, "  F = I + U_xi X_xi^-1, f_n = -sum w det(X_xi) P X_xi^-T dN_n/dxi\n");
        let _ = writeln!(
            text,
            "  {:<14} {:>9} {:>9} {:>12} {:>12} {:>10}",
            "", "fragments", "constants", "ops per step", "ops at start", "functions"
        );
        for (what, fragments) in [
            ("energy", &derived.energies),
            ("forces", &derived.forces),
            ("differential", &derived.differentials),
        ] {
            let sums = sums(derived, fragments);
            let _ = writeln!(
                text,
                "  {what:<14} {:>9} {:>9} {:>12} {:>12} {:>10}",
                sums.fragments,
                sums.constants,
                sums.step.total(),
                sums.once.total(),
                sums.step.functions
            );
        }
        if let Some(source) = source_constant_count(self.kind, self.map).filter(|_| derived.cut == Cut::NONE)
        {
            let _ =
                writeln!(text, "\n  grouped constants of the energy in Faure 2014, tables 3.4-3.7: {source}");
        }
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

    fn to_json(&self, derived: &mut Derived, [compiled, total]: [f64; 2]) -> Value {
        let expression = |expr: Expr| {
            let (parts, result) = self.written(expr, &Text);
            let operations = self.law.graph.operations(&[expr], |_| false).total();
            json!({ "parts": parts, "result": result, "operations": operations })
        };
        let counted = |fragments: &[ElementExpressions]| {
            let sums = sums(derived, fragments);
            let by_fragment: Vec<usize> =
                fragments.iter().map(|fragment| fragment.grouped.constants.len()).collect();
            json!({
                "fragments": sums.fragments,
                "constants": sums.constants,
                "constants_by_fragment": by_fragment,
                "operations_per_step": sums.step.total(),
                "functions_per_step": sums.step.functions,
                "operations_at_start": sums.once.total(),
            })
        };
        let mut document = json!({
            "law": self.name,
            "element": self.kind.name(),
            "samples": self.samples,
            // as the source names such a pair
            "association": source_law_name(self.name) + &derived.name,
            "cut": derived.cut.name(),
            "cut_axes": Axis::ALL.iter().filter(|axis| derived.cut.has(**axis)).count(),
            "energy": expression(self.law.energy),
            "stress": expression(self.law.stress),
            "differential": expression(self.law.differential),
            "on_element": {
                "energy": counted(&derived.energies),
                "forces": counted(&derived.forces),
                "differential": counted(&derived.differentials),
            },
            "source_constants": source_constant_count(self.kind, self.map),
            "warnings": self.law.warnings,
            "seconds": { "law": compiled, "element": total - compiled },
        });
        document["code_bytes"] = json!({
            "rust": derived.emit(ElementCode::Rust).text.len(),
            "wgsl": derived.emit(ElementCode::Wgsl).text.len(),
        });
        document
    }

    fn latex(&self) -> String {
        let mut text = String::from("\\begin{align*}\n");
        for (symbol, expr) in
            [("\\Psi", self.law.energy), ("P", self.law.stress), ("\\delta P", self.law.differential)]
        {
            let (parts, result) = self.written(expr, &Latex);
            for part in parts {
                let _ = writeln!(text, "  {} \\\\", part.replacen(" = ", " &= ", 1));
            }
            let _ = writeln!(text, "  {symbol} &= {result} \\\\");
        }
        let _ = writeln!(text, "  F &= I + \\sum_n U_n\\otimes\\nabla_\\xi N_n\\,X_\\xi^{{-1}} \\\\");
        let _ = writeln!(
            text,
            "  f_n &= -\\sum_{{q=1}}^{{{}}} w_q\\det X_\\xi\\,P\\,X_\\xi^{{-T}}\\nabla_\\xi N_n",
            self.samples
        );
        text + "\\end{align*}\n"
    }
}
