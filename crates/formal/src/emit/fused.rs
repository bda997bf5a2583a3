//! A law on an element as Rust over numbers side by side: gradients from nodes, `F`, the law, forces to nodes, all samples written
//! out, with what depends on rest shape and material alone grouped.
//!
//! A column `∂x/∂ξ_k` at a sample is a sum over nodes that does not know the rest shape; samples where its numbers are the same share
//! it (a hexahedron of eight samples has twelve such columns and not twenty-four), nodes whose numbers are always opposite share their
//! difference, and equal numbers are multiplied once. Forces go back by the transpose, in the same sums.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

use super::boxes::Corners;
use super::kernel::{NoKernel, Writer, finished, needed, packing};
use super::{Text, write};
use crate::element::{Cut, ElementData, RestMap, WEIGHT, terms};
use crate::graph::{Expr, Graph, Node, Shape, Substitution};
use crate::law::{EnergyLaw, LawParameter};
use crate::tape::lower::{Request, lower};

/// What stands about the functions of a law on an element.
#[derive(Clone, Copy, Debug)]
pub struct ElementHeading<'a> {
    /// Of the type.
    pub name: &'a str,
    /// Of the element, as scenes have it.
    pub element: &'a str,
    pub summary: &'a str,
    /// The law as its author wrote it, a line each.
    pub written: &'a [String],
}

/// Numbers that differ by less are the same: a few roundings of shape gradients, which are of order one.
pub(super) const SAME: f64 = 1e-14;

/// `∂x/∂ξ_axis = Σ c_n x_n`, at one sample or several.
struct Column {
    axis: usize,
    coefficients: Vec<f64>,
}

/// Nodes that columns of one axis take with one number: the sum of some, less the sum of others.
struct Addend {
    axis: usize,
    plus: Vec<usize>,
    minus: Vec<usize>,
}

impl Addend {
    fn name(&self, letters: [char; 2]) -> String {
        let letter = letters[usize::from(self.minus.is_empty())];
        let joined = |nodes: &[usize]| nodes.iter().map(usize::to_string).collect::<Vec<_>>().join("_");
        // which nodes are taken away is part of the name: `x0 + x1 - x2` is not `x0 - x1 - x2`
        let less = if self.minus.is_empty() { "" } else { "m" };
        format!("{letter}{}{less}{}", joined(&self.plus), joined(&self.minus))
    }

    fn text(&self) -> String {
        if self.is_one() { format!("x[{}]", self.plus[0]) } else { self.name(['e', 'u']) }
    }

    fn is_one(&self) -> bool {
        self.plus.len() + self.minus.len() == 1
    }
}

/// The columns of an element, and what they are made of.
struct Fields<'a> {
    element: &'a ElementData,
    columns: Vec<Column>,
    /// Of each sample, its columns.
    of_sample: Vec<Vec<usize>>,
    addends: Vec<Addend>,
    /// Numbers that columns multiply with, without their signs, from large to small.
    numbers: Vec<f64>,
    /// Columns from modes of corners, in the place of sums over nodes.
    corners: Option<Corners>,
}

impl<'a> Fields<'a> {
    fn new(element: &'a ElementData) -> Self {
        if let Some(corners) = Corners::of(element) {
            let of_sample =
                element.samples.iter().map(|sample| Corners::of_sample(&sample.position).to_vec()).collect();
            let columns = (0..12).map(|index| Column { axis: index / 4, coefficients: Vec::new() }).collect();
            let (addends, numbers, corners) = (Vec::new(), Vec::new(), Some(corners));
            return Self { element, columns, of_sample, addends, numbers, corners };
        }
        let mut columns: Vec<Column> = Vec::new();
        let mut of_sample = Vec::new();
        for sample in &element.samples {
            let mut of_this = Vec::new();
            for axis in 0..element.dimension {
                let coefficients: Vec<f64> = sample.gradients.iter().map(|gradient| gradient[axis]).collect();
                let is_same = |column: &Column| {
                    let pairs = column.coefficients.iter().zip(&coefficients);
                    column.axis == axis && pairs.into_iter().all(|(a, b)| (a - b).abs() < SAME)
                };
                let next = columns.len();
                let place = columns.iter().position(is_same).unwrap_or(next);
                if place == next {
                    columns.push(Column { axis, coefficients });
                }
                of_this.push(place);
            }
            of_sample.push(of_this);
        }
        let (addends, numbers, corners) = (Vec::new(), Vec::new(), None);
        let mut fields = Self { element, columns, of_sample, addends, numbers, corners };
        fields.addends = (0..element.dimension).flat_map(|axis| fields.alike(axis)).collect();
        let mut numbers: Vec<f64> = fields
            .columns
            .iter()
            .flat_map(|column| &column.coefficients)
            .map(|number| number.abs())
            .collect();
        numbers.sort_by(|a, b| b.total_cmp(a));
        numbers.dedup_by(|a, b| (*a - *b).abs() < SAME);
        fields.numbers = numbers.into_iter().filter(|number| *number > SAME).collect();
        fields
    }

    fn along(&self, axis: usize) -> impl Iterator<Item = (usize, &Column)> {
        self.columns.iter().enumerate().filter(move |(_, column)| column.axis == axis)
    }

    /// Nodes of an axis, together where one has the other's numbers in every column, or these with the other sign.
    fn alike(&self, axis: usize) -> Vec<Addend> {
        let numbers = |node: usize| self.along(axis).map(move |(_, column)| column.coefficients[node]);
        let is_zero = |node: usize| numbers(node).all(|number| number.abs() < SAME);
        let is_times = |a: usize, b: usize, sign: f64| {
            numbers(a).zip(numbers(b)).all(|(a, b)| (a - sign * b).abs() < SAME)
        };
        let mut addends: Vec<Addend> = Vec::new();
        for node in (0..self.element.node_count).filter(|node| !is_zero(*node)) {
            let same = addends.iter().position(|addend| is_times(addend.plus[0], node, 1.0));
            let opposite = addends.iter().position(|addend| is_times(addend.plus[0], node, -1.0));
            match (same, opposite) {
                (Some(place), _) => addends[place].plus.push(node),
                (_, Some(place)) => addends[place].minus.push(node),
                _ => addends.push(Addend { axis, plus: vec![node], minus: Vec::new() }),
            }
        }
        for addend in &mut addends {
            if !addend.minus.is_empty() && numbers(addend.plus[0]).sum::<f64>() < 0.0 {
                std::mem::swap(&mut addend.plus, &mut addend.minus);
            }
        }
        addends
    }

    /// `Σ number · text`, equal numbers together.
    fn sum(&self, terms: &[(String, f64)]) -> String {
        let mut groups: Vec<(usize, Vec<&(String, f64)>)> = Vec::new();
        for (place, number) in self.numbers.iter().enumerate() {
            let of_number: Vec<&(String, f64)> =
                terms.iter().filter(|(_, own)| (own.abs() - number).abs() < SAME).collect();
            if !of_number.is_empty() {
                groups.push((place, of_number));
            }
        }
        let texts: Vec<(usize, String)> = groups
            .into_iter()
            .map(|(place, of_number)| {
                let signed = of_number.iter().map(|(text, own)| (text.clone(), *own > 0.0));
                (place, signed_sum(&signed.collect::<Vec<_>>()))
            })
            .collect();
        if let [(place, text)] = &texts[..] {
            let number = self.numbers[*place];
            let is_one = (number - 1.0).abs() < SAME;
            let is_name = text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_[]".contains(&byte));
            return match (is_one, is_name) {
                (true, _) => text.clone(),
                (false, true) => format!("{text} * C[{place}]"),
                (false, false) => format!("({text}) * C[{place}]"),
            };
        }
        let list: Vec<String> = texts.iter().map(|(place, text)| format!("({text}, C[{place}])")).collect();
        format!("weighted([{}])", list.join(", "))
    }

    /// The body of `columns`.
    fn of_nodes(&self) -> String {
        if let Some(corners) = &self.corners {
            return corners.columns();
        }
        let mut out = String::new();
        let mut known: Vec<String> = Vec::new();
        for addend in &self.addends {
            let text = addend.text();
            if !addend.is_one() && !known.contains(&text) {
                let signed = |nodes: &[usize], sign: bool| {
                    nodes.iter().map(|node| (format!("x[{node}]"), sign)).collect::<Vec<_>>()
                };
                let sum = signed_sum(&[signed(&addend.plus, true), signed(&addend.minus, false)].concat());
                let _ = writeln!(out, "    let {text} = {sum};");
                known.push(text);
            }
        }
        let columns = self.columns.iter().map(|column| {
            let of_axis = self.addends.iter().filter(|addend| addend.axis == column.axis);
            let terms: Vec<(String, f64)> =
                of_axis.map(|addend| (addend.text(), column.coefficients[addend.plus[0]])).collect();
            format!("        {},\n", self.sum(&terms))
        });
        let columns: String = columns.collect();
        let _ = write!(out, "    [\n{columns}    ]\n");
        out
    }

    /// The body of `to_nodes`.
    fn to_nodes(&self) -> String {
        if let Some(corners) = &self.corners {
            return corners.to_nodes();
        }
        let mut out = String::new();
        // nodes, by what is added and what is taken away
        let mut of_node: Vec<Vec<(String, bool)>> = vec![Vec::new(); self.element.node_count];
        for addend in &self.addends {
            let of_axis = self.along(addend.axis);
            let terms: Vec<(String, f64)> = of_axis
                .map(|(index, column)| (format!("s[{index}]"), column.coefficients[addend.plus[0]]))
                .collect();
            let sum = self.sum(&terms);
            let is_place = sum.starts_with("s[") && sum.ends_with(']') && sum.matches('[').count() == 1;
            let axis = ["_xi", "_eta", "_zeta"][addend.axis];
            let name = if is_place { sum.clone() } else { addend.name(['t', 't']) + axis };
            if !is_place {
                let _ = writeln!(out, "    let {name} = {sum};");
            }
            addend.plus.iter().for_each(|node| of_node[*node].push((name.clone(), false)));
            addend.minus.iter().for_each(|node| of_node[*node].push((name.clone(), true)));
        }
        let sums: String = of_node.iter().map(|terms| format!("        {},\n", signed_sum(terms))).collect();
        let _ = write!(out, "    [\n{sums}    ]\n");
        out
    }
}

/// `a + b - c`, with what is positive first.
fn signed_sum(terms: &[(String, bool)]) -> String {
    let (positive, negative): (Vec<_>, Vec<_>) = terms.iter().partition(|(_, is_positive)| *is_positive);
    let [positive, negative] =
        [positive, negative].map(|list| list.into_iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>());
    match (&positive[..], &negative[..]) {
        ([], [one]) => format!("-{one}"),
        ([], all) => format!("-({})", all.join(" + ")),
        (all, []) => all.join(" + "),
        (all, taken) => format!("{} - {}", all.join(" + "), taken.join(" - ")),
    }
}

/// The law with its volume, in grouped constants.
struct Weighted {
    graph: Graph,
    measure: Measure,
    /// `F` or `C`, and its differential.
    deformation: Expr,
    variation: Expr,
    weight: Expr,
    parameters: Vec<Expr>,
    /// Symbols, and what they stand for, earlier symbols among it.
    constants: Vec<(Expr, Expr)>,
    /// What each stands for by the numbers of the law alone.
    whole: Vec<Expr>,
    /// `ω Ψ`, `ω P`, `ω δP`; of a law of `C` with `S` and `δS` in their places.
    outputs: [Expr; 3],
}

/// What the functions of a law are functions of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Measure {
    /// `F`, to `P`.
    Gradient,
    /// `C = FᵀF`, to the second Piola stress: `P = F S`.
    Metric,
}

impl Measure {
    fn name(self) -> &'static str {
        match self {
            Self::Gradient => "F",
            Self::Metric => "C",
        }
    }

    fn stress(self) -> &'static str {
        match self {
            Self::Gradient => "P",
            Self::Metric => "S",
        }
    }
}

/// An energy of `C` alone, with `S = 2 ∂Ψ/∂C` and its differential.
struct OfMetric {
    metric: Expr,
    variation: Expr,
    outputs: [Expr; 3],
}

impl OfMetric {
    /// `None`: `energy` sees `F` otherwise than by the lengths and angles of what it makes of the axes.
    fn of(graph: &mut Graph, energy: Expr, deformation: Expr) -> Option<Self> {
        let [metric, variation] = ["C", "dC"].map(|name| graph.own_matrix(name));
        let transposed = graph.transpose(deformation);
        let (product, square) =
            (graph.multiply(transposed, deformation), graph.dot(deformation, deformation));
        let trace = graph.trace(metric);
        let energy = graph.substitute(energy, &HashMap::from([(product, metric), (square, trace)]));
        if graph.depends(&[energy], &[deformation])[energy.index()] {
            return None;
        }
        let half = graph.gradient(energy, metric);
        let stress = graph.times_each(2.0, half);
        let differential = graph.differential(stress, &HashMap::from([(metric, variation)]));
        // both are symmetric
        let symmetric = [metric, variation].map(|of| (graph.transpose(of), of));
        let outputs = [energy, stress, differential].map(|output| {
            let output = graph.substitute(output, &HashMap::from(symmetric));
            graph.factored(&[output])[0]
        });
        Some(Self { metric, variation, outputs })
    }
}

impl Weighted {
    /// `is_shared`: columns of `F` are shared by samples, so that laws of `C` are written as such.
    fn new(law: &EnergyLaw, is_shared: bool) -> Self {
        let mut graph = law.graph.clone();
        let term = terms(&mut graph, law, Cut::NONE).remove(0);
        let of_metric = if is_shared { OfMetric::of(&mut graph, term.energy, law.deformation) } else { None };
        let (measure, deformation, variation, roots) = match of_metric {
            Some(of) => (Measure::Metric, of.metric, of.variation, of.outputs),
            None => {
                let roots = [term.energy, term.stress, term.differential];
                (Measure::Gradient, law.deformation, law.variation, roots)
            }
        };
        let weight = graph.own_symbol(WEIGHT);
        let parameters: Vec<Expr> =
            law.parameters.iter().map(|(name, parameter)| graph.symbol(name, parameter.shape())).collect();
        let grouped = graph.group_constants(&roots, &[deformation, variation]);
        let grouped = graph.without_multiples(grouped);
        let mut known = Substitution::default();
        let mut whole = Vec::with_capacity(grouped.constants.len());
        for (symbol, definition) in &grouped.constants {
            let definition = graph.substituted(*definition, &mut known);
            known.replace(*symbol, definition, false);
            whole.push(definition);
        }
        let diagonal = multiples_of_one(&mut graph, &grouped.varying);
        let varying: Vec<Expr> =
            grouped.varying.iter().map(|expr| graph.substitute(*expr, &diagonal)).collect();
        let shared = graph.shared(&varying);
        let outputs = [shared[0], shared[1], shared[2]];
        Self {
            graph,
            measure,
            deformation,
            variation,
            weight,
            parameters,
            constants: grouped.constants,
            whole,
            outputs,
        }
    }

    /// The body of a function whose inputs have these names.
    fn body(
        &self,
        inputs: [&[(Expr, String)]; 2],
        outputs: &[Expr],
        matrices: &[&str],
        end: impl FnOnce(&[String]) -> String,
    ) -> Result<String, NoKernel> {
        let [first, varied] = inputs.map(|list| list.iter().map(|(expr, _)| *expr).collect::<Vec<Expr>>());
        let request = Request { graph: &self.graph, inputs: [&first, &varied], definitions: &[], outputs };
        let lowered = lower(&request, |symbol| unreachable!("`{}` is an input", symbol.name));
        let places = lowered.inputs.iter().flatten();
        let names = inputs.into_iter().flatten();
        let texts: BTreeMap<usize, String> =
            places.zip(names).map(|(place, (_, name))| (place.value, name.clone())).collect();
        let mut writer = Writer::new(&self.graph, &lowered, texts);
        let steps: Vec<_> = lowered.steps.iter().flatten().collect();
        let body = writer.body(&needed(&steps, &lowered.outputs), &[])?;
        let results: Vec<String> = lowered
            .outputs
            .iter()
            .zip(outputs)
            .map(|(place, output)| writer.read(*place, self.graph.shape(*output).size()))
            .collect();
        Ok(finished(&body, &end(&results), matrices))
    }

    /// `ω Ψ` and its derivatives from `F` or `C`, their differentials and the constants.
    fn function(&self, output: usize) -> Result<String, NoKernel> {
        let name = self.measure.name();
        let rate = format!("d{name}");
        let mut inputs = vec![(self.deformation, name.to_owned())];
        inputs
            .extend((0..).zip(&self.constants).map(|(index, (symbol, _))| (*symbol, format!("D.d{index}"))));
        let varied = [(self.variation, rate.clone())];
        let body = |outputs: &[Expr], matrices: &[&str]| {
            self.body([&inputs, &varied], outputs, matrices, |results| match results {
                [one] => format!("        {one}\n"),
                several => format!("        ({})\n", several.join(", ")),
            })
        };
        match (output, self.measure) {
            (2, Measure::Metric) => body(&self.outputs[1..], &[name, &rate]),
            (2, _) if self.is_linear() => body(&self.outputs[2..], &[&rate]),
            (2, _) => body(&self.outputs[2..], &[name, &rate]),
            _ => body(&self.outputs[output..=output], &[name]),
        }
    }

    /// Whether the differential is the same everywhere.
    fn is_linear(&self) -> bool {
        self.measure == Measure::Gradient
            && !self.graph.depends(&[self.outputs[2]], &[self.deformation])[self.outputs[2].index()]
    }

    /// The constants from the numbers of the law and the volume.
    fn grouping(&self, names: &[&str]) -> Result<String, NoKernel> {
        let plain = |text: String| text.replace(WEIGHT, "volume");
        let mut inputs = vec![(self.weight, "volume".to_owned())];
        inputs.extend(self.parameters.iter().zip(names).map(|(expr, name)| (*expr, format!("p.{name}"))));
        self.body([&inputs, &[]], &self.whole, &[], |results| {
            let fields: Vec<String> =
                results.iter().enumerate().map(|(index, text)| format!("d{index}: {text}")).collect();
            format!("        Self {{ {} }}\n", fields.join(", "))
        })
        .map(plain)
    }

    /// A constant as text.
    fn written(&self, constant: Expr) -> String {
        let (lines, roots) = write(&self.graph, &[constant], &Text);
        [lines, roots].concat().join("; ").replace(WEIGHT, "volume")
    }
}

/// Matrices of numbers that are a multiple of the identity, and that multiple.
fn multiples_of_one(graph: &mut Graph, roots: &[Expr]) -> HashMap<Expr, Expr> {
    let mut found = HashMap::new();
    for expr in graph.reachable(roots) {
        let Node::Pack(entries) = graph.node(expr).clone() else { continue };
        let numbers: Option<Vec<f64>> = entries.iter().map(|entry| graph.value(*entry)).collect();
        let Some(numbers) = numbers.filter(|numbers| numbers.len() == 9) else { continue };
        let is_multiple =
            |index: usize| numbers[index] == if index.is_multiple_of(4) { numbers[0] } else { 0.0 };
        if (0..9).all(is_multiple) {
            let (one, number) = (graph.identity(), graph.number(numbers[0]));
            found.insert(expr, graph.scale(number, one));
        }
    }
    found
}

/// The file of a law on an element: energy, forces and differential of its nodes as functions of their positions.
///
/// # Errors
/// The law is written in principal stretches, with directions, or with functions that lanes do not have.
pub fn element_kernel(
    element: &ElementData,
    law: &EnergyLaw,
    heading: &ElementHeading,
) -> Result<String, NoKernel> {
    if law.parameters.iter().any(|(_, parameter)| matches!(parameter, LawParameter::Direction(_))) {
        return Err(NoKernel::of("directions"));
    }
    super::kernel::check_names(law)?;
    let names: Vec<&str> = law.parameters.iter().map(|(name, _)| name.as_str()).collect();
    let fields = Fields::new(element);
    let weighted = Weighted::new(law, fields.corners.is_some());
    let functions = [0, 1, 2].map(|output| weighted.function(output));
    let [energy, stress, differential] = functions;
    let bodies = [energy?, stress?, differential?, weighted.grouping(&names)?];
    let file = File { element, fields, weighted, names, heading };
    Ok(file.text(&bodies))
}

struct File<'a> {
    element: &'a ElementData,
    fields: Fields<'a>,
    weighted: Weighted,
    names: Vec<&'a str>,
    heading: &'a ElementHeading<'a>,
}

impl File<'_> {
    fn text(&self, [energy, stress, differential, grouping]: &[String; 4]) -> String {
        let Self { element, fields, weighted, names, heading } = self;
        let (dimension, nodes, columns) = (element.dimension, element.node_count, fields.columns.len());
        let is_box = matches!(element.map, RestMap::Box { .. });
        let of_map = if is_box { dimension } else { dimension * dimension };
        let moduli = weighted.constants.len();
        let of_samples = if is_box { 1 } else { element.samples.len() };
        let mut out = String::new();
        let mut line = |text: &str| {
            out.push_str(text);
            out.push('\n');
        };
        let shape = if is_box { ", a box along the axes" } else { "" };
        line(&format!(
            "//! {}, on `{}`{shape}; derived from its text by `souple derive --emit kernel`, and not changed by hand.",
            heading.summary, heading.element
        ));
        line("//!\n//! ```text");
        heading.written.iter().for_each(|text| line(&format!("//! {}", text.replace('\n', " "))));
        line("//! ```");
        let what = if is_box { "the diagonal of `X = X_ξ⁻¹`" } else { "`X = X_ξ⁻¹`" };
        let each = if of_samples > 1 { format!(" at each of {of_samples} samples") } else { String::new() };
        line(&format!(
            "//!\n//! Grouped constants{each}: {what}, {of_map}, and moduli times the volume, {moduli}: {}.\n",
            of_map + moduli
        ));
        let is_linear = weighted.is_linear();
        let (measure, stress_name) = (weighted.measure.name(), weighted.measure.stress());
        let of_place = if is_linear { String::new() } else { format!(", {measure}: &Mat3<R>") };
        let made = match weighted.measure {
            Measure::Gradient => "Mat3<R>",
            Measure::Metric => "(Mat3<R>, Mat3<R>)",
        };
        let of_differential =
            format!("differential_of<R: Real>(D: &Constants<R>{of_place}, d{measure}: &Mat3<R>) -> {made}");
        let of_differential_is = match weighted.measure {
            Measure::Gradient => "`ω δP`.",
            Measure::Metric => "`ω S` and `ω δS`.",
        };
        let every = [energy, stress, differential, grouping];
        let uses = |word: &str| every.iter().any(|body| body.contains(word));
        line("use souple_math::{Mat3, Real, Vec3};\n");
        line("use crate::materials::Parameters;");
        if uses("cofactor_differential(") {
            line("use crate::materials::invariants::cofactor_differential;");
        }
        let sums = fields.of_nodes().contains("weighted(") || fields.to_nodes().contains("weighted(");
        if fields.corners.is_some() {
            let of_metric = match weighted.measure {
                Measure::Gradient => "",
                Measure::Metric => "add_across, add_scaled, ",
            };
            let metrics = if of_metric.is_empty() { "" } else { ", metric, metric_differential" };
            line(&format!(
                "use crate::solids::derived::boxes::{{{of_metric}along, bilinear, forces_of_modes{metrics}}};"
            ));
        }
        line(&format!(
            "use crate::solids::derived::{{DerivedElement, RestSamples{}}};\n",
            if sums { ", weighted" } else { "" }
        ));
        line(&format!("/// See the module.\n#[derive(Clone, Copy, Debug)]\npub struct {};\n", heading.name));
        line("/// The law's numbers.\n#[derive(Clone, Copy, Debug)]\npub struct Numbers<R> {");
        names.iter().for_each(|name| line(&format!("    pub {name}: R,")));
        line("}\n");
        let shapes: Vec<(&str, Shape)> = names.iter().map(|name| (*name, Shape::Scalar)).collect();
        line(&packing(&shapes));
        line(
            "/// Moduli times the volume of a sample.\n#[derive(Clone, Copy, Debug)]\nstruct Constants<R> {",
        );
        for (index, (_, definition)) in weighted.constants.iter().enumerate() {
            line(&format!("    /// `{}`\n    d{index}: R,", weighted.written(*definition)));
        }
        line("}\n\nimpl<R: Real> Constants<R> {\n    #[inline(always)]");
        line(&format!("    fn of(p: &Numbers<R>, volume: R) -> Self {{\n{grouping}    }}\n}}\n"));
        if fields.numbers.iter().any(|number| (number - 1.0).abs() > SAME) {
            line("/// Of `∂N/∂ξ` at the samples, without signs.");
            let numbers: Vec<String> = fields.numbers.iter().map(|number| format!("{number:?}")).collect();
            line(&format!("const C: [f64; {}] = [{}];\n", numbers.len(), numbers.join(", ")));
        }
        if let Some(corners) = &fields.corners {
            line(
                "/// Weights of what is constant, linear and bilinear in the other coordinates, at the samples.",
            );
            let weights: Vec<String> = corners.weights().iter().map(|weight| format!("{weight:?}")).collect();
            line(&format!("const MODES: [f64; 3] = [{}];\n", weights.join(", ")));
        }
        for (doc, head, body) in [
            ("`ω Ψ`.", &*format!("energy_of<R: Real>(D: &Constants<R>, {measure}: &Mat3<R>) -> R"), energy),
            (
                &*format!("`ω {stress_name}`."),
                &*format!("stress_of<R: Real>(D: &Constants<R>, {measure}: &Mat3<R>) -> Mat3<R>"),
                stress,
            ),
            (of_differential_is, &*of_differential, differential),
        ] {
            line(&format!("/// {doc}\n#[inline(always)]\nfn {head} {{\n{body}}}\n"));
        }
        let (of_what, of_stress, weights) = if fields.corners.is_some() {
            let of_what = "`∂x/∂X` at the samples, by axes, from modes of the corners: `dds` is the sum along ζ of differences along ξ and η, `m` and `p` are";
            (format!("{of_what}\n/// corners at -1 and at 1."), "`ω P`", ", K: &[[R; 3]; 3]")
        } else {
            let of_what = "`∂x/∂ξ` at the samples, by axes: columns that several of them share.";
            (of_what.to_owned(), "`ω P X_ξ⁻ᵀ`", "")
        };
        line(&format!(
            "/// {of_what}\n#[inline(always)]\nfn columns<R: Real>(x: &[Vec3<R>; {nodes}]{weights}) -> [Vec3<R>; {columns}] {{\n{}}}\n",
            fields.of_nodes()
        ));
        line(&format!(
            "/// Forces on nodes from {of_stress} by columns: minus the transpose of [`columns`].\n#[inline(always)]\nfn to_nodes<R: Real>(s: &[Vec3<R>; {columns}]{weights}) -> [Vec3<R>; {nodes}] {{\n{}}}\n",
            fields.to_nodes()
        ));
        self.gradients(&mut line);
        line(&format!("impl DerivedElement<{nodes}> for {} {{", heading.name));
        line(&format!(
            "    const SAMPLES: usize = {};\n    type Numbers<R: Real> = Numbers<R>;\n",
            element.samples.len()
        ));
        for output in 0..3 {
            line(&self.function(output));
        }
        out.truncate(out.trim_end().len());
        out.push_str("\n}\n");
        out
    }

    /// Functions between reference and rest shape.
    fn gradients(&self, line: &mut impl FnMut(&str)) {
        let dimension = self.element.dimension;
        if self.fields.corners.is_some() {
            return;
        }
        if matches!(self.element.map, RestMap::Box { .. }) {
            line("/// Columns times what the map of the box makes of their axes.\n#[inline(always)]");
            let columns = self.fields.columns.len();
            let scaled: String = (0..)
                .zip(&self.fields.columns)
                .map(|(index, column)| {
                    format!("c[{index}] * X.columns[{0}].{1}, ", column.axis, ["x", "y", "z"][column.axis])
                })
                .collect();
            line(&format!(
                "fn scaled<R: Real>(c: [Vec3<R>; {columns}], X: &Mat3<R>) -> [Vec3<R>; {columns}] {{\n    [{}]\n}}\n",
                scaled.trim_end_matches(", ")
            ));
            return;
        }
        if dimension == 3 {
            return;
        }
        line("/// `x_ξ X_ξ⁻¹` in the plane, with a third column.\n#[inline(always)]");
        line("fn in_plane<R: Real>([a, b]: [Vec3<R>; 2], X: &Mat3<R>, across: Vec3<R>) -> Mat3<R> {");
        line("    let [u, v, _] = X.columns;");
        line("    Mat3::from_columns(a * u.x + b * u.y, a * v.x + b * v.y, across)\n}\n");
        line("/// The columns of `P X_ξ⁻ᵀ` in the plane.\n#[inline(always)]");
        line("fn back<R: Real>(P: &Mat3<R>, X: &Mat3<R>) -> [Vec3<R>; 2] {");
        line("    let ([a, b, _], [u, v, _]) = (P.columns, X.columns);");
        line("    [a * u.x + b * v.x, a * u.y + b * v.y]\n}\n");
    }

    /// `F` from columns of a field; `is_rate` where it is a differential.
    fn gradient(&self, letter: &str, sample: usize, is_rate: bool) -> String {
        let columns: Vec<String> =
            self.fields.of_sample[sample].iter().map(|column| format!("{letter}[{column}]")).collect();
        let is_box = matches!(self.element.map, RestMap::Box { .. });
        if self.element.dimension == 2 {
            let of_z = if is_rate { "zero" } else { "one" };
            let across = format!("Vec3::new(zero, zero, {of_z})");
            return if is_box {
                format!("Mat3::from_columns({}, {across})", columns.join(", "))
            } else {
                format!("in_plane([{}], &X, {across})", columns.join(", "))
            };
        }
        let whole = format!("Mat3::from_columns({})", columns.join(", "));
        if is_box { whole } else { format!("{whole} * X") }
    }

    fn function(&self, output: usize) -> String {
        let Self { element, fields, weighted, .. } = self;
        let needs_place = output != 2 || !weighted.is_linear();
        let x = if needs_place { "x" } else { "_" };
        let (nodes, is_box) = (element.node_count, matches!(element.map, RestMap::Box { .. }));
        let head = match output {
            0 => format!(
                "fn energy<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; {nodes}], at: &impl RestSamples<R>) -> R"
            ),
            1 => format!(
                "fn forces<R: Real>(p: &Numbers<R>, x: &[Vec3<R>; {nodes}], at: &impl RestSamples<R>) -> [Vec3<R>; {nodes}]"
            ),
            _ => format!(
                "fn differential<R: Real>(p: &Numbers<R>, {x}: &[Vec3<R>; {nodes}], dx: &[Vec3<R>; {nodes}], at: &impl RestSamples<R>) -> [Vec3<R>; {nodes}]"
            ),
        };
        let mut out = format!("    #[inline(always)]\n    {head} {{\n");
        let mut line = |text: String| {
            let _ = writeln!(out, "        {text}");
        };
        let column_fields: &[(&str, &str)] = match (output, needs_place) {
            (2, true) => &[("c", "x"), ("dc", "dx")],
            (2, false) => &[("dc", "dx")],
            _ => &[("c", "x")],
        };
        if element.dimension == 2 {
            line(if needs_place {
                "let (zero, one) = (x[0].x.zero(), x[0].x.one());".to_owned()
            } else {
                "let zero = dx[0].x.zero();".to_owned()
            });
        }
        let first_weight = element.samples[0].weight;
        let is_even = element.samples.iter().all(|sample| (sample.weight - first_weight).abs() < SAME);
        if is_box {
            line("let (X, volume) = at.sample(0);".to_owned());
            if fields.corners.is_some() {
                line("let K = along(&X, MODES);".to_owned());
            }
            for (name, of) in column_fields {
                line(match fields.corners {
                    Some(_) => format!("let {name} = columns({of}, &K);"),
                    None => format!("let {name} = scaled(columns({of}), &X);"),
                });
            }
            if is_even {
                line("let D = Constants::of(p, volume);".to_owned());
            }
        } else {
            column_fields.iter().for_each(|(name, of)| line(format!("let {name} = columns({of});")));
        }
        if weighted.measure == Measure::Metric {
            self.of_metric(output).into_iter().for_each(line);
            out.push_str("    }\n");
            return out;
        }
        let mut energies = Vec::new();
        // what samples have given to each column
        let mut given: Vec<Vec<String>> = vec![Vec::new(); fields.columns.len()];
        let mut sums = vec![String::new(); fields.columns.len()];
        for (sample, of_sample) in fields.of_sample.iter().enumerate() {
            if !is_box {
                line(format!("let (X, volume) = at.sample({sample});"));
                line("let D = Constants::of(p, volume);".to_owned());
            } else if !is_even {
                let ratio = element.samples[sample].weight / first_weight;
                line(format!("let D = Constants::of(p, volume * {ratio:?});"));
            }
            if needs_place {
                line(format!("let F = {};", self.gradient("c", sample, false)));
            }
            if output == 0 {
                if element.samples.len() == 1 {
                    energies.push("energy_of(&D, &F)".to_owned());
                } else {
                    line(format!("let w{sample} = energy_of(&D, &F);"));
                    energies.push(format!("w{sample}"));
                }
                continue;
            }
            let stress = if output == 1 {
                "stress_of(&D, &F)".to_owned()
            } else {
                line(format!("let dF = {};", self.gradient("dc", sample, true)));
                let place = if needs_place { "&F, " } else { "" };
                format!("differential_of(&D, {place}&dF)")
            };
            let names: Vec<String> = (0..element.dimension).map(|axis| format!("h{sample}_{axis}")).collect();
            let list = names.join(", ");
            line(match (element.dimension, is_box) {
                (2, false) => format!("let [{list}] = back(&{stress}, &X);"),
                (2, true) => format!("let [{list}, _] = {stress}.columns;"),
                (_, false) => format!("let [{list}] = {stress}.mul_transpose(&X).columns;"),
                (_, true) => format!("let [{list}] = {stress}.columns;"),
            });
            for (name, column) in names.into_iter().zip(of_sample) {
                given[*column].push(name);
                let is_last = !fields.of_sample[sample + 1..].iter().any(|later| later.contains(column));
                if is_last && given[*column].len() > 1 {
                    line(format!("let s{column} = {};", given[*column].join(" + ")));
                    sums[*column] = format!("s{column}");
                } else if is_last {
                    sums[*column].clone_from(&given[*column][0]);
                }
            }
        }
        let list = sums.join(", ");
        line(match (output, is_box) {
            (0, _) => energies.join(" + "),
            (_, true) if fields.corners.is_some() => format!("to_nodes(&[{list}], &K)"),
            (_, true) => format!("to_nodes(&scaled([{list}], &X))"),
            (_, false) => format!("to_nodes(&[{list}])"),
        });
        out.push_str("    }\n");
        out
    }

    /// Samples of a law of `C`, one after the other: products of columns with themselves, and what diagonals of `S` make of a column, are
    /// shared by the samples that have it.
    fn of_metric(&self, output: usize) -> Vec<String> {
        let fields = &self.fields;
        let columns = 0..fields.columns.len();
        let mut lines = Vec::new();
        let products = |other: &str| {
            let products: Vec<String> =
                columns.clone().map(|column| format!("c[{column}].dot({other}[{column}])")).collect();
            products.join(", ")
        };
        lines.push(format!("let g = [{}];", products("c")));
        if output == 2 {
            lines.push(format!("let dg = [{}];", products("dc")));
        }
        if output > 0 {
            lines.push("let zero = c[0] * volume.zero();".to_owned());
        }
        let mut sums = vec!["zero".to_owned(); fields.columns.len()];
        // samples of each column, with its axis
        let mut had: Vec<Vec<usize>> = vec![Vec::new(); fields.columns.len()];
        for (sample, of_sample) in fields.of_sample.iter().enumerate() {
            let three = |name: &str| {
                let entries: Vec<String> =
                    of_sample.iter().map(|column| format!("{name}[{column}]")).collect();
                format!("[{}]", entries.join(", "))
            };
            let metric = format!("metric({}, {})", three("c"), three("g"));
            if output == 0 {
                lines.push(format!("let w{sample} = energy_of(&D, &{metric});"));
                continue;
            }
            let before: Vec<String> = of_sample.iter().map(|column| sums[*column].clone()).collect();
            let after: Vec<String> = of_sample.iter().map(|column| format!("s{column}")).collect();
            let (before, list) = (format!("[{}]", before.join(", ")), after.join(", "));
            if output == 1 {
                lines.push(format!("let S{sample} = stress_of(&D, &{metric});"));
                lines.push(format!("let [{list}] = add_across({before}, {}, &S{sample});", three("c")));
            } else {
                lines.push(format!("let (F, dF) = ({}, {});", three("c"), three("dc")));
                lines.push(format!("let C = metric(F, {});", three("g")));
                lines.push(format!("let dC = metric_differential(F, dF, {});", three("dg")));
                lines.push(format!("let (S{sample}, dS{sample}) = differential_of(&D, &C, &dC);"));
                let first = format!("add_across({before}, F, &dS{sample})");
                lines.push(format!("let [{list}] = add_across({first}, dF, &S{sample});"));
            }
            for (axis, (column, name)) in of_sample.iter().zip(after).enumerate() {
                sums[*column] = name.clone();
                had[*column].push(sample);
                if fields.of_sample[sample + 1..].iter().any(|later| later.contains(column)) {
                    continue;
                }
                let entries = |letter: &str| {
                    let entry = |sample: &usize| {
                        format!("{letter}{sample}.columns[{axis}].{}", ["x", "y", "z"][axis])
                    };
                    had[*column].iter().map(entry).collect::<Vec<_>>().join(" + ")
                };
                let own = if output == 1 {
                    format!("add_scaled({name}, c[{column}], {})", entries("S"))
                } else {
                    let of_rate = format!("add_scaled({name}, dc[{column}], {})", entries("S"));
                    format!("add_scaled({of_rate}, c[{column}], {})", entries("dS"))
                };
                lines.push(format!("let {name} = {own};"));
            }
        }
        lines.push(if output == 0 {
            let energies: Vec<String> =
                (0..fields.of_sample.len()).map(|sample| format!("w{sample}")).collect();
            energies.join(" + ")
        } else {
            format!("to_nodes(&[{}], &K)", sums.join(", "))
        });
        lines
    }
}
