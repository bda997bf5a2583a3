//! `souple derive`: a law on an element, derived step by step, counted, and written as code.

mod files;
mod report;
mod tried;

use std::path::PathBuf;

use clap::ValueEnum;
use serde_json::json;
use souple_formal::Span;
use souple_formal::element::Cut;
use souple_formal::emit::{ElementCode, Latex, Style, Text, maxima, symbol, write};
use souple_formal::graph::{Expr, Shape};
use souple_formal::law::{EnergyLaw, LawProblem, LawText, group_constants};
use souple_mesh::ElementKind;
use souple_models::associations::Association;
use souple_models::derive::{MapKind, element_data, source_law_name};
use souple_models::materials::{MaterialError, WRITTEN_LAWS, WrittenLaw, is_parameter, law_text};

use super::{End, Refusal, did_you_mean, print_json, print_line, print_note};
use report::Report;

#[derive(clap::Args)]
pub struct Arguments {
    /// An energy density such as "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2", also with its constants and the names of its
    /// parts behind it, as in "c*x + k*(J - 1)^2; x = I1_bar - 3; c = 5 kPa; k = 0.1 MPa"; or the name of a law
    // an energy may begin with a minus
    #[arg(long, required_unless_present_any = ["list", "check", "group"], allow_hyphen_values = true)]
    law: Option<String>,
    /// An element of surfaces or volumes, such as tri3, hex8 or tet10
    #[arg(long)]
    element: Option<String>,
    /// Lists what can be derived: every law on every element under every rule, in every cut
    // what would change nothing is refused, here and below
    #[arg(long, conflicts_with_all = ["check", "emit", "out", "parameters", "definitions", "map", "cut"])]
    list: bool,
    /// Tries the derived expressions, of every law on every element under every rule where none is named: forces against
    /// energies, differentials against forces, symmetry, rigid motion, sums, and the law at the samples
    #[arg(long, conflicts_with_all = ["emit", "out", "parameters", "definitions", "map", "cut"])]
    check: bool,
    /// Step of the differences that expressions are tried with, of a cell of size one
    #[arg(long, requires = "check")]
    step: Option<f64>,
    /// A fault that the trial must see: this share of their size is added to the first force and the first differential
    #[arg(long, requires = "check")]
    fault: Option<f64>,
    /// Groups the constants of a formula, such as "(a - b)*x + p*(a - b)*y", in the place of a law on an element
    // what is about laws and elements would change nothing
    #[arg(
        long,
        value_name = "FORMULA",
        allow_hyphen_values = true,
        conflicts_with_all = ["law", "element", "list", "check", "out", "parameters", "definitions", "rule", "map", "cut"]
    )]
    group: Option<String>,
    /// A name that varies in the formula; may be repeated
    #[arg(long, value_name = "NAME", requires = "group")]
    varying: Vec<String>,
    /// What is printed
    #[arg(long, value_enum, default_value_t = Emit::Stats)]
    emit: Emit,
    /// Writes the expressions of every fragment there, one file for each node and axis
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// A material constant of a law given as text, such as mu="1 MPa", or a direction such as a="[1, 0, 0]" for fibres; may be
    /// repeated
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

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Emit {
    Stats,
    Rust,
    Wgsl,
    Latex,
    Maxima,
    /// Rust over numbers side by side, a file of the program's own: of a law alone, or on an element with all its samples
    Kernel,
}

#[derive(Clone, Copy, ValueEnum)]
enum Map {
    General,
    Box,
}

pub fn derive(arguments: &Arguments) -> Result<End, Refusal> {
    if arguments.list {
        return Ok(list(arguments));
    }
    if arguments.check {
        return tried::check(arguments);
    }
    if let Some(formula) = &arguments.group {
        return group(formula, arguments);
    }
    let clock = std::time::Instant::now();
    let (wanted, element_name) = (arguments.law.as_deref(), arguments.element.as_deref());
    let (wanted, element_name) = (wanted.unwrap_or_default(), element_name.unwrap_or_default());
    let (name, text) = law_of(wanted, arguments)?;
    let law = EnergyLaw::compile(&text).map_err(|error| {
        let definition = text.definitions.iter().find(|(name, _)| *name == error.part);
        let written = definition.map_or(text.energy.as_str(), |(_, text)| text.as_str());
        let expected = match &*error.problem {
            LawProblem::UnknownName { name, shape, nearest: None, .. } => {
                let example = if *shape == Shape::Vector { "[1, 0, 0]" } else { "10 kPa" };
                format!(
                    "a hyperelastic law whose constants are given, as by `--parameter {name}=\"{example}\"` or `--define {name}=TEXT`"
                )
            }
            LawProblem::StressAtRest { .. } | LawProblem::NoValueAtRest { .. } | LawProblem::CornerAtRest => {
                "an energy per volume whose stress is zero at rest, such as those of `souple list laws`".to_owned()
            }
            _ => "a law as text, such as those of `souple list laws`".to_owned(),
        };
        let value = error.span.map_or(written, |span| span.of(written));
        Refusal::request("law", value, expected, error.explained(written)).within(&error, written)
    })?;
    let compiled_seconds = clock.elapsed().as_secs_f64();
    if arguments.emit == Emit::Kernel && arguments.element.is_none() {
        return emit_kernel(&name, &text, &law, arguments);
    }
    if arguments.element.is_none() {
        let message = "a law is derived on an element; of itself it is only written as a kernel".to_owned();
        return Err(Refusal::request("element", "", "`--element NAME`, or `--emit kernel`", message));
    }
    let kind = ElementKind::from_name(element_name).map_err(|unknown| {
        let expected = format!("one of {}", unknown.known.join(", "));
        Refusal::request("unknown_element", element_name, expected, unknown.to_string())
    })?;
    if kind.dimension() == 1 {
        let message = format!("{kind} has no gradient in a plane or in space to derive a law on");
        return Err(Refusal::request("element", element_name, "an element of surfaces or volumes", message));
    }
    let rule = match &arguments.rule {
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
    let element = element_data(kind, rule, map).map_err(|error| {
        Refusal::request("map", "box", "`--map general`, or `--element hex8` or `quad4`", error.to_string())
    })?;
    let cut = Cut::from_name(&arguments.cut).ok_or_else(|| {
        let message = format!("there is no cut `{}`", arguments.cut);
        Refusal::request("cut", &arguments.cut, "none, all, or letters of L, G, N, D", message)
    })?;
    // what is known of the laws of the table is on their pages
    for warning in law.warnings.iter().filter(|_| name == TEXT) {
        print_note(format_args!("warning: {warning}"));
    }
    let is_code = matches!(arguments.emit, Emit::Rust | Emit::Wgsl | Emit::Maxima | Emit::Kernel);
    if is_code && arguments.out.is_none() && cut != Cut::NONE {
        let message = "emitted code holds the whole sum, whatever expressions are cut into".to_owned();
        return Err(Refusal::request(
            "cut",
            &arguments.cut,
            "`--out`, which writes the fragments, or no `--cut`",
            message,
        ));
    }
    let association = format!("{}{}{cut}", source_law_name(&name), element.name);
    // another system derives it: nothing has to be derived here
    if arguments.emit == Emit::Maxima && arguments.out.is_none() {
        emit_text(&maxima(&element, &law, &association), "maxima", arguments.json);
        return Ok(End::Done);
    }
    if let (Emit::Kernel, Some(folder)) = (arguments.emit, &arguments.out) {
        let message = "a kernel has no fragments: it is one text, on standard output".to_owned();
        return Err(Refusal::request("out", folder.display().to_string(), "no `--out`", message));
    }
    if arguments.emit == Emit::Kernel {
        let written = souple_models::derive::element_kernel(&name, &text, &law, kind, (rule, map));
        let source = written.map_err(|error| {
            Refusal::request("law", &name, "a law of invariants without directions", error.to_string())
        })?;
        emit_text(&source, "rust", arguments.json);
        return Ok(End::Done);
    }
    let mut derived = element.derive(&law, cut);
    let derived_seconds = clock.elapsed().as_secs_f64();
    if let Some(folder) = &arguments.out {
        std::fs::create_dir_all(folder)
            .map_err(|error| Refusal::work("write", format!("{}: {error}", folder.display())))?;
        files::write(folder, &derived, &association)
            .map_err(|error| Refusal::work("write", error.to_string()))?;
    }
    let report = Report::new(&law, &name, &element, kind, map);
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
        Emit::Maxima => emit_text(&maxima(&element, &law, &association), "maxima", arguments.json),
        // its expressions are the files
        Emit::Kernel => {}
    }
    Ok(End::Done)
}

/// A law as a file of the table of laws.
fn emit_kernel(name: &str, text: &LawText, law: &EnergyLaw, arguments: &Arguments) -> Result<End, Refusal> {
    let source = souple_models::derive::law_kernel(name, text, law)
        .map_err(|error| Refusal::request("law", name, "a law of invariants", error.to_string()))?;
    emit_text(&source, "rust", arguments.json);
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

/// Prints a formula with its constants taken out.
fn group(formula: &str, arguments: &Arguments) -> Result<End, Refusal> {
    let style: &dyn Style = match arguments.emit {
        Emit::Stats => &Text,
        Emit::Latex => &Latex,
        Emit::Rust | Emit::Wgsl | Emit::Maxima | Emit::Kernel => {
            let message = "code is written of a law on an element; a formula is grouped as text, or as LaTeX";
            let asked = arguments.emit.to_possible_value().map(|value| value.get_name().to_owned());
            let expected = "`--group` without `--emit`, or with `--emit latex`";
            return Err(Refusal::request("emit", asked.unwrap_or_default(), expected, message));
        }
    };
    let (graph, grouped) = group_constants(formula, &arguments.varying).map_err(|error| {
        Refusal::request("formula", formula, "a formula of numbers", error.explained(formula))
            .within(&error, formula)
    })?;
    let (symbols, definitions): (Vec<Expr>, Vec<Expr>) = grouped.constants.iter().copied().unzip();
    let roots: Vec<Expr> = definitions.into_iter().chain(grouped.varying).collect();
    let (parts, mut written) = write(&graph, &roots, style);
    let varying = written.split_off(symbols.len()).concat();
    let names = symbols.iter().map(|constant| symbol(&graph, *constant, style));
    if arguments.json {
        let constants: serde_json::Map<String, serde_json::Value> =
            names.zip(written.into_iter().map(Into::into)).collect();
        print_json(&json!({ "parts": parts, "constants": constants, "varying": varying }));
    } else {
        parts.iter().for_each(print_line);
        names.zip(&written).for_each(|(name, text)| print_line(style.definition(&name, text)));
        print_line(varying);
    }
    Ok(End::Done)
}

/// Prints the associations of the law and the element, where they are named.
fn list(arguments: &Arguments) -> End {
    let is_wanted = |association: &Association| {
        arguments.law.as_deref().is_none_or(|law| law == association.law.name)
            && arguments.element.as_deref().is_none_or(|element| element == association.kind.name())
    };
    let wanted = Association::all().filter(is_wanted);
    if arguments.json {
        let entry = |association: Association| {
            json!({
                "name": association.name(),
                "law": association.law.name,
                "element": association.kind.name(),
                "rule": association.rule.name,
                "cut": association.cut.name(),
                "command": association.command(),
            })
        };
        print_json(&wanted.map(entry).collect::<Vec<_>>().into());
    } else {
        wanted.for_each(|association| {
            print_line(format_args!("{:46} {}", association.name(), association.command()));
        });
    }
    End::Done
}

/// The law of that name, or the text.
fn law_of(wanted: &str, arguments: &Arguments) -> Result<(String, LawText), Refusal> {
    let pair = |text: &str| -> Result<(String, String), Refusal> {
        let (name, value) = text.split_once('=').ok_or_else(|| {
            Refusal::request("parameter", text, "NAME=VALUE", format!("`{text}`: there is no `=`"))
        })?;
        Ok((name.trim().to_owned(), value.trim().trim_matches('"').to_owned()))
    };
    let pairs = |list: &[String]| list.iter().map(|text| pair(text)).collect::<Result<Vec<_>, _>>();
    let (mut parameters, mut definitions) = (pairs(&arguments.parameters)?, pairs(&arguments.definitions)?);
    if let Some(law) = WrittenLaw::find(wanted) {
        if let Some((given, _)) = parameters.iter().chain(&definitions).next() {
            let message = format!("`{wanted}` has its own numbers; `{given}` would change nothing");
            let expected = format!("a law as text, such as \"{}\"", law.written());
            return Err(Refusal::request("parameter", given, expected, message));
        }
        let text = law.text().map_err(|error| Refusal::work("law", error.to_string()))?;
        return Ok((law.name.to_owned(), text));
    }
    let is_name = wanted.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if is_name && wanted.len() > 2 {
        let names: Vec<&str> = WRITTEN_LAWS.iter().map(|law| law.name).collect();
        let message = format!("there is no law `{}`{}", wanted, did_you_mean(wanted, names.iter().copied()));
        let expected =
            format!("an energy density, or a law that `souple list laws` prints: {}", names.join(", "));
        return Err(Refusal::request("unknown_law", wanted, expected, message));
    }
    let mut parts = wanted.split(';');
    let energy = parts.next().unwrap_or_default().trim();
    for part in parts.map(str::trim).filter(|part| !part.is_empty()) {
        let named = pair(part)?;
        if is_parameter(&named.1) { parameters.push(named) } else { definitions.push(named) }
    }
    let text = law_text(energy, &parameters, &definitions).map_err(|error| {
        let told = error.all().map(|error| fault_of_parameter(error, &parameters));
        let told: Vec<String> = told.collect();
        let expected = "a quantity such as \"10 kPa\", or a direction such as \"[1, 0, 0]\"";
        Refusal::request("parameter", "", expected, told.join("\n"))
    })?;
    Ok((TEXT.to_owned(), text))
}

/// What is wrong with a parameter, with its text and carets under the place.
fn fault_of_parameter(error: &MaterialError, parameters: &[(String, String)]) -> String {
    let text = error.path().last().and_then(|name| parameters.iter().find(|(known, _)| known == name));
    let Some(((name, text), span)) = text.zip(error.span()) else { return error.to_string() };
    let written = format!("{name} = {text}");
    let before = written.len() - text.len();
    let place = Span::new(span.start + before, span.end + before).underline(&written);
    let lines: Vec<String> = place.lines().map(|line| format!("    {line}")).collect();
    format!("{error}\n{}", lines.join("\n"))
}
