//! Laws as Rust over numbers side by side: what is compiled with the program in the place of a file written by hand.
//!
//! The instructions are those of a [tape](crate::tape), one a line, each on whole tensors; parameters vary from lane to lane. What
//! differentials at one `F` share is computed in `at`, as in laws that are written by hand.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Write;

use super::{Text, write};
use crate::Function;
use crate::graph::{Comparison, Expr, Graph, Shape};
use crate::law::{Block, EnergyLaw, Strain};
use crate::tape::Code;
use crate::tape::lower::{Lowered, Place, Request, Step, lower};

/// Of a line.
const WIDTH: usize = 110;

/// What stands about the functions of a law.
#[derive(Clone, Copy, Debug)]
pub struct Heading<'a> {
    /// Of the type.
    pub name: &'a str,
    pub summary: &'a str,
    /// The law as its author wrote it, a line each.
    pub written: &'a [String],
    /// A type of the program with the law's numbers as its fields; `None`: the file has one of its own.
    pub numbers: Option<&'a str>,
}

/// Why a law has no such source.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a law with {0} is not written as a kernel")]
pub struct NoKernel(String);

impl NoKernel {
    pub(super) fn of(what: &str) -> Self {
        Self(what.to_owned())
    }
}

/// Words that Rust keeps for itself.
const WORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop",
    "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static",
    "struct", "super", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual",
    "where", "while", "yield",
];

/// Whether the numbers of a law may be fields of a struct.
///
/// # Errors
/// One is called as a word of Rust.
pub(super) fn check_names(law: &EnergyLaw) -> Result<(), NoKernel> {
    let taken = law.parameters.iter().find(|(name, _)| WORDS.contains(&name.as_str()));
    taken.map_or(Ok(()), |(name, _)| Err(NoKernel(format!("a parameter called `{name}`, a word of Rust"))))
}

/// The file of a law: its numbers, and energy, stress and differential as functions of them.
///
/// # Errors
/// It is written in principal stretches, or with functions that lanes do not have.
pub fn kernel(law: &EnergyLaw, heading: &Heading) -> Result<String, NoKernel> {
    check_names(law)?;
    let Heading { name, summary, written, numbers } = *heading;
    let parameters: Vec<(&str, Shape)> =
        law.parameters.iter().map(|(name, parameter)| (name.as_str(), parameter.shape())).collect();
    let functions = Functions { law, parameters: &parameters };
    let [energy, stress] = [law.energy, law.stress].map(|output| functions.whole(output));
    let (energy, stress, split) = (energy?, stress?, functions.split()?);
    let mut bodies = vec![&energy, &stress, &split.at, &split.differential];
    bodies.extend(&split.block);
    let uses = |word: &str| bodies.iter().any(|body| body.contains(word)) || split.fields.contains(word);

    let mut out = String::new();
    let mut line = |text: &str| {
        out.push_str(text);
        out.push('\n');
    };
    line(&format!(
        "//! {summary}; derived from its text by `souple derive --emit kernel`, and not changed by hand."
    ));
    line("//!");
    line("//! ```text");
    for text in written.iter().flat_map(|text| text.lines()) {
        line(&format!("//! {text}"));
    }
    line("//! ```");
    line("");
    let vectors = if split.block.is_some()
        || uses("Vec3")
        || parameters.iter().any(|(_, shape)| *shape == Shape::Vector)
    {
        ", Vec3"
    } else {
        ""
    };
    line(&format!("use souple_math::{{Mat3, Real{vectors}}};"));
    line("");
    if uses("cofactor_differential(") {
        line("use crate::materials::invariants::cofactor_differential;");
    }
    match numbers {
        Some(numbers) => line(&format!("use crate::materials::{{{numbers} as Numbers, Law}};")),
        None => line("use crate::materials::{Law, Parameters};"),
    }
    line("");
    line("/// See the module.");
    line("#[derive(Clone, Copy, Debug)]");
    line(&format!("pub struct {name};"));
    line("");
    if numbers.is_none() {
        line("/// The law's numbers.");
        line("#[derive(Clone, Copy, Debug)]");
        line("pub struct Numbers<R> {");
        for (name, shape) in &parameters {
            let kind = if *shape == Shape::Vector { "Vec3<R>" } else { "R" };
            line(&format!("    pub {name}: {kind},"));
        }
        line("}");
        line("");
        line(&packing(&parameters));
    }
    let has_point = !split.fields.is_empty();
    if has_point {
        line("/// What differentials at one `F` share.");
        line("#[derive(Clone, Copy, Debug)]");
        line("pub struct Point<R> {");
        out.push_str(&split.fields);
        out.push_str("}\n\n");
    }
    let signature = |head: &str, body: &str| {
        // a name that nothing reads would be told by the compiler
        let reads = |word: &str| body.lines().any(|text| text.contains(word));
        let argument = |is_read: bool, name: &'static str| if is_read { name } else { "_" };
        let head = head.replace("$point", argument(reads("point."), "point"));
        let head = head.replace("$p", argument(reads("p."), "p"));
        let head = head.replace("$F", argument(!body.is_empty(), "F"));
        let end = if body.is_empty() { "}\n".to_owned() } else { format!("\n{body}    }}\n") };
        format!("    #[inline(always)]\n    fn {head}{end}")
    };
    let _ = writeln!(out, "impl Law for {name} {{");
    out.push_str("    type Parameters<R: Real> = Numbers<R>;\n");
    let point = if has_point { "Point<R>" } else { "()" };
    let _ = writeln!(out, "    type Point<R: Real> = {point};\n");
    if law.strain == Strain::Small {
        out.push_str("    const OBJECTIVE: bool = false;\n");
    }
    if law.is_linear() {
        out.push_str("    const LINEAR: bool = true;\n");
    }
    if law.strain == Strain::Small || law.is_linear() {
        out.push('\n');
    }
    let at = if has_point { "$F: &Mat3<R>) -> Point<R> {" } else { "_: &Mat3<R>) {" };
    let at = format!("at<R: Real>($p: &Numbers<R>, {at}");
    let differential = format!(
        "stress_differential<R: Real>($p: &Numbers<R>, $point: &{point}, dF: &Mat3<R>) -> Mat3<R> {{"
    );
    let of_block = format!(
        "tangent_block<R: Real>($p: &Numbers<R>, $point: &{point}, g_a: Vec3<R>, g_b: Vec3<R>) -> Mat3<R> {{"
    );
    let mut functions = vec![
        (&*at, &split.at),
        ("energy_density<R: Real>($p: &Numbers<R>, F: &Mat3<R>) -> R {", &energy),
        ("stress<R: Real>($p: &Numbers<R>, F: &Mat3<R>) -> Mat3<R> {", &stress),
        (&differential, &split.differential),
    ];
    if let Some(block) = &split.block {
        functions.push((&of_block, block));
    }
    let functions: Vec<String> = functions.iter().map(|(head, body)| signature(head, body)).collect();
    out.push_str(&functions.join("\n"));
    out.push_str("}\n");
    Ok(out)
}

/// `impl Parameters`.
pub(super) fn packing(parameters: &[(&str, Shape)]) -> String {
    let numbers = parameters.iter().flat_map(|(name, shape)| match shape {
        Shape::Vector => ["x", "y", "z"].map(|axis| format!("{name}.{axis}")).to_vec(),
        _ => vec![(*name).to_owned()],
    });
    let numbers: Vec<String> = numbers.collect();
    let mut out = String::from("impl<R: Copy> Parameters<R> for Numbers<R> {\n");
    let names: Vec<String> = numbers.iter().map(|name| format!("{name:?}")).collect();
    let _ = writeln!(out, "    const NAMES: &'static [&'static str] = &[{}];\n", names.join(", "));
    out.push_str("    #[inline(always)]\n    fn unpack(mut number: impl FnMut(usize) -> R) -> Self {\n");
    let mut next = 0;
    let fields = parameters.iter().map(|(name, shape)| {
        let first = next;
        next += shape.size();
        match shape {
            Shape::Vector => {
                format!("{name}: Vec3::new(number({first}), number({}), number({}))", first + 1, first + 2)
            }
            _ => format!("{name}: number({first})"),
        }
    });
    let fields: Vec<String> = fields.collect();
    let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
    out.push_str(&braced("        ", "Self", &fields));
    out.push_str("    }\n\n    #[inline(always)]\n    fn pack(self, mut put: impl FnMut(usize, R)) {\n");
    for (index, number) in numbers.iter().enumerate() {
        let _ = writeln!(out, "        put({index}, self.{number});");
    }
    out.push_str("    }\n}\n");
    out
}

struct Functions<'a> {
    law: &'a EnergyLaw,
    parameters: &'a [(&'a str, Shape)],
}

/// A differential in two parts.
struct Split {
    fields: String,
    at: String,
    differential: String,
    /// Where the law has one of its own.
    block: Option<String>,
}

impl Functions<'_> {
    fn lowered(&self, graph: &Graph, varying: &[Expr], outputs: &[Expr]) -> Lowered {
        let mut graph = graph.clone();
        let parameters = self.parameters.iter().map(|(name, shape)| graph.symbol(name, *shape));
        let first: Vec<Expr> = std::iter::once(self.law.deformation).chain(parameters).collect();
        let request = Request { graph: &graph, inputs: [&first, varying], definitions: &[], outputs };
        lower(&request, |symbol| unreachable!("`{}` is a parameter", symbol.name))
    }

    fn writer<'l>(&self, graph: &'l Graph, lowered: &'l Lowered) -> Writer<'l> {
        let mut texts = BTreeMap::from([(lowered.inputs[0][0].value, "F".to_owned())]);
        for (place, (name, _)) in lowered.inputs[0][1..].iter().zip(self.parameters) {
            texts.insert(place.value, format!("p.{name}"));
        }
        for (place, name) in lowered.inputs[1].iter().zip(["dF", "g_a", "g_b"]) {
            texts.insert(place.value, name.to_owned());
        }
        Writer::new(graph, lowered, texts)
    }

    /// The body of a function of `F` and the parameters.
    fn whole(&self, output: Expr) -> Result<String, NoKernel> {
        let graph = &self.law.graph;
        let lowered = self.lowered(graph, &[self.law.variation], &[output]);
        let mut writer = self.writer(graph, &lowered);
        let steps: Vec<&Step> = lowered.steps.iter().flatten().collect();
        let steps = needed(&steps, &lowered.outputs);
        let body = writer.body(&steps, &[])?;
        let result = writer.read(lowered.outputs[0], lowered.sizes[lowered.outputs[0].value]);
        Ok(finished(&body, &format!("        {result}\n"), &["F"]))
    }

    fn split(&self) -> Result<Split, NoKernel> {
        let Self { law, .. } = self;
        let block = law.block();
        let (graph, mut varying, mut outputs) = (&law.graph, vec![law.variation], vec![law.differential]);
        let graph = block.as_ref().map_or(graph, |Block { graph, gradients, stiffness }| {
            varying.extend(gradients);
            outputs.push(*stiffness);
            graph
        });
        let lowered = self.lowered(graph, &varying, &outputs);
        let mut writer = self.writer(graph, &lowered);
        let all: Vec<&Step> = lowered.steps.iter().flatten().collect();
        let all = needed(&all, &lowered.outputs);
        let first_out: HashSet<usize> = lowered.steps[0].iter().map(|step| step.out.value).collect();
        let (first, second): (Vec<&Step>, Vec<&Step>) =
            all.iter().partition(|step| first_out.contains(&step.out.value));
        // comparisons have no value of their own: who selects reads what is compared
        let compared: HashMap<usize, [Option<Place>; 5]> = lowered.steps[0]
            .iter()
            .filter(|step| matches!(step.code, Code::Compare(_)))
            .map(|step| (step.out.value, step.operands))
            .collect();
        let read_later =
            second.iter().flat_map(|step| step.operands.iter().flatten()).chain(&lowered.outputs);
        let mut kept: Vec<usize> = read_later
            .flat_map(|place| match compared.get(&place.value) {
                Some(operands) => operands.iter().flatten().map(|place| place.value).collect(),
                None => vec![place.value],
            })
            .filter(|value| first_out.contains(value) || *value == lowered.inputs[0][0].value)
            .collect();
        kept.sort_unstable();
        kept.dedup();
        let at = writer.body(&first, &kept)?;
        let names: Vec<(String, usize)> =
            kept.iter().map(|value| (writer.texts[value].clone(), lowered.sizes[*value])).collect();
        let type_of = |size: usize| match size {
            1 => "R",
            3 => "Vec3<R>",
            _ => "Mat3<R>",
        };
        let mut fields = String::new();
        for (name, size) in &names {
            let _ = writeln!(fields, "    {name}: {},", type_of(*size));
        }
        let list: Vec<&str> = names.iter().map(|(name, _)| name.as_str()).collect();
        let at = if list.is_empty() {
            String::new()
        } else {
            finished(&at, &braced("        ", "Point", &list), &["F"])
        };
        for (value, (name, _)) in kept.iter().zip(&names) {
            writer.texts.insert(*value, format!("point.{name}"));
        }
        let mut bodies = lowered.outputs.iter().zip(["dF.columns[0].x", "g_a.x"]).map(|(output, like)| {
            let body = writer.body(&needed(&second, &[*output]), &[])?;
            let result = writer.read(*output, lowered.sizes[output.value]);
            let by_value: &[&str] = if like.starts_with("dF") { &["dF"] } else { &[] };
            Ok(finished_like(&body, &format!("        {result}\n"), by_value, like))
        });
        let differential = bodies.next().transpose()?.unwrap_or_default();
        let block = bodies.next().transpose()?;
        Ok(Split { fields, at, differential, block })
    }
}

/// `Name { fields }` on one line where there is room, as rustfmt has it.
fn braced(indent: &str, name: &str, fields: &[&str]) -> String {
    let line = format!("{indent}{name} {{ {} }}\n", fields.join(", "));
    if line.len() <= WIDTH {
        return line;
    }
    let fields: String = fields.iter().map(|field| format!("{indent}    {field},\n")).collect();
    format!("{indent}{name} {{\n{fields}{indent}}}\n")
}

/// `text + number`.
fn plus(text: &str, number: f64) -> String {
    if number < 0.0 { format!("{text} - {:?}", -number) } else { format!("{text} + {number:?}") }
}

/// A body with its beginning: matrices by value, and a one to make constants beside.
pub(super) fn finished(body: &str, end: &str, matrices: &[&str]) -> String {
    let like =
        matrices.first().map_or_else(|| "volume".to_owned(), |matrix| format!("{matrix}.columns[0].x"));
    finished_like(body, end, matrices, &like)
}

/// The same with the number `like` to make constants beside.
fn finished_like(body: &str, end: &str, matrices: &[&str], like: &str) -> String {
    let mut begin = String::new();
    for matrix in matrices {
        let _ = writeln!(begin, "        let {matrix} = *{matrix};");
    }
    if body.contains("one.") || body.contains("one /") || end.contains("one.") {
        let _ = writeln!(begin, "        let one = {like}.one();");
    }
    // what was named last is what is returned
    let last = body.trim_end().rsplit_once('\n').map_or(("", body), |(before, last)| (before, last));
    let returned = last.1.trim_start().strip_prefix(&format!("let {} = ", end.trim()));
    match returned.and_then(|value| value.split(';').next()) {
        Some(value) if last.0.is_empty() => format!("{begin}        {value}\n"),
        Some(value) => format!("{begin}{}\n        {value}\n", last.0),
        None => begin + body + end,
    }
}

/// The steps without those whose results nothing reads.
pub(super) fn needed<'l>(steps: &[&'l Step], outputs: &[Place]) -> Vec<&'l Step> {
    let mut read: HashSet<usize> = outputs.iter().map(|place| place.value).collect();
    let mut kept: Vec<&Step> = Vec::new();
    for step in steps.iter().rev() {
        if read.contains(&step.out.value) {
            read.extend(step.operands.iter().flatten().map(|place| place.value));
            kept.push(step);
        }
    }
    kept.reverse();
    kept
}

/// Products `u vᵀ` among the steps that one step reads, which scales them, and of what they are; what is read later, by other
/// bodies, is none.
fn scaled_outers(steps: &[&Step], outputs: &[Place], read_later: &[usize]) -> HashMap<usize, [Place; 2]> {
    let mut reads: HashMap<usize, usize> = HashMap::new();
    for place in steps.iter().flat_map(|step| step.operands.iter().flatten()).chain(outputs) {
        *reads.entry(place.value).or_default() += 1;
    }
    for value in read_later {
        *reads.entry(*value).or_default() += 1;
    }
    let scaled = |step: &Step| match (step.code, step.operands) {
        (Code::Scale | Code::ScaleAdd, [_, Some(a), ..]) => vec![a],
        (Code::Combine, [s, Some(a), t, Some(b), _]) if s != t => vec![a, b],
        _ => Vec::new(),
    };
    let scaled: HashSet<usize> =
        steps.iter().flat_map(|step| scaled(step)).map(|place| place.value).collect();
    let of_outer = |step: &&Step| match (step.code, step.operands) {
        (Code::Outer, [Some(u), Some(v), ..]) => Some((step.out.value, [u, v])),
        _ => None,
    };
    let outers = steps.iter().filter_map(of_outer);
    outers.filter(|(value, _)| scaled.contains(value) && reads.get(value) == Some(&1)).collect()
}

pub(super) struct Writer<'l> {
    graph: &'l Graph,
    lowered: &'l Lowered,
    /// Names of values.
    texts: BTreeMap<usize, String>,
    /// Values that do not vary.
    numbers: BTreeMap<usize, Vec<f64>>,
    /// Expressions that values are of.
    meant: HashMap<usize, Expr>,
    /// Operands and kinds of comparisons, by their values.
    compared: HashMap<usize, (Comparison, Place, Place)>,
    /// Products `u vᵀ` that are scaled where they are used: three multiplications, where scaling the matrix takes nine.
    outers: HashMap<usize, [Place; 2]>,
    /// Entries of values that are put together.
    packed: HashMap<usize, Vec<Option<String>>>,
    /// Numbers, vectors and matrices named so far.
    counts: [usize; 3],
}

impl<'l> Writer<'l> {
    /// Of values that have names in `texts` already.
    pub fn new(graph: &'l Graph, lowered: &'l Lowered, texts: BTreeMap<usize, String>) -> Self {
        let mut numbers: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (place, value) in &lowered.constants {
            let entries = numbers.entry(place.value).or_insert_with(|| vec![0.0; lowered.sizes[place.value]]);
            entries[place.offset as usize] = *value;
        }
        let meant = lowered.places.iter().filter(|(_, place)| place.offset == 0);
        let meant = meant.map(|(expr, place)| (place.value, *expr)).collect();
        Self {
            graph,
            lowered,
            texts,
            numbers,
            meant,
            compared: HashMap::new(),
            outers: HashMap::new(),
            packed: HashMap::new(),
            counts: [0; 3],
        }
    }

    /// Lines of steps; values of `read_later` are read by other bodies too.
    pub fn body(&mut self, steps: &[&Step], read_later: &[usize]) -> Result<String, NoKernel> {
        let mut out = String::new();
        self.outers = scaled_outers(steps, &self.lowered.outputs, read_later);
        for step in steps {
            if self.outers.contains_key(&step.out.value) {
                continue;
            }
            if let Some(value) = self.value(step)? {
                let name = self.name(self.lowered.sizes[step.out.value]);
                let comment = self.meaning(step.out.value);
                let _ = writeln!(out, "        let {name} = {value};{comment}");
                self.texts.insert(step.out.value, name);
            }
        }
        Ok(out)
    }

    fn name(&mut self, size: usize) -> String {
        let (kind, letter) = match size {
            1 => (0, 's'),
            3 => (1, 'v'),
            _ => (2, 'M'),
        };
        self.counts[kind] += 1;
        format!("{letter}{}", self.counts[kind])
    }

    /// What a value is, where that is short.
    fn meaning(&self, value: usize) -> String {
        let Some(expr) = self.meant.get(&value) else { return String::new() };
        let (lines, roots) = write(self.graph, &[*expr], &Text);
        let is_short = lines.is_empty() && roots[0].len() <= 40;
        if is_short { format!(" // {}", roots[0]) } else { String::new() }
    }

    /// A number where it does not vary.
    fn fixed(&self, place: Place) -> Option<f64> {
        self.numbers.get(&place.value).map(|numbers| numbers[place.offset as usize])
    }

    /// `size` numbers from a place on.
    pub fn read(&self, place: Place, size: usize) -> String {
        if let Some(numbers) = self.numbers.get(&place.value) {
            let constant =
                |offset: usize| format!("one.splat({:?})", numbers[place.offset as usize + offset]);
            let vector = |first: usize| {
                format!("Vec3::new({}, {}, {})", constant(first), constant(first + 1), constant(first + 2))
            };
            return match size {
                1 if numbers[place.offset as usize] == 1.0 => "one".to_owned(),
                1 => constant(0),
                3 => vector(0),
                _ => format!("Mat3::from_columns({}, {}, {})", vector(0), vector(3), vector(6)),
            };
        }
        let name = &self.texts[&place.value];
        let (whole, offset) = (self.lowered.sizes[place.value], place.offset as usize);
        let axis = ["x", "y", "z"][offset % 3];
        match (whole, size) {
            (9, 1) => format!("{name}.columns[{}].{axis}", offset / 3),
            (9, 3) => format!("{name}.columns[{}]", offset / 3),
            (3, 1) => format!("{name}.{axis}"),
            _ => name.clone(),
        }
    }

    /// The right-hand side of a step; `None` where it gets no name.
    fn value(&mut self, step: &Step) -> Result<Option<String>, NoKernel> {
        let Step { code, entries, out, operands } = *step;
        let entries = usize::from(entries);
        let place = |operand: usize| operands[operand].unwrap_or(out);
        let number = |operand: usize| self.read(place(operand), 1);
        let tensor = |operand: usize| self.read(place(operand), entries);
        let matrix = |operand: usize| self.read(place(operand), 9);
        let vector = |operand: usize| self.read(place(operand), 3);
        // a constant stands on the right of what it multiplies
        let product = |a: usize, b: usize| match (self.fixed(place(a)), self.fixed(place(b))) {
            (Some(a), _) => format!("{} * {a:?}", number(b)),
            (_, Some(b)) => format!("{} * {b:?}", number(a)),
            _ => format!("{} * {}", number(a), number(b)),
        };
        let scaled = |factor: usize, of: usize| match (self.fixed(place(factor)), entries) {
            (fixed, 9) if self.outers.contains_key(&place(of).value) => {
                let [u, v] = self.outers[&place(of).value].map(|place| self.read(place, 3));
                let factor = fixed.map_or_else(|| number(factor), |factor| format!("{factor:?}"));
                format!("({u} * {factor}).outer({v})")
            }
            (Some(factor), _) => format!("{} * {factor:?}", tensor(of)),
            (None, 9) => format!("{}.scaled({})", tensor(of), number(factor)),
            (None, _) => format!("{} * {}", tensor(of), number(factor)),
        };
        let text = match code {
            Code::Copy => {
                let (whole, entry) = (self.lowered.sizes[out.value], number(0));
                let entries = self.packed.entry(out.value).or_insert_with(|| vec![None; whole]);
                entries[out.offset as usize] = Some(entry);
                let Some(all) = entries.iter().cloned().collect::<Option<Vec<String>>>() else {
                    return Ok(None);
                };
                let columns: Vec<String> =
                    all.chunks(3).map(|column| format!("Vec3::new({})", column.join(", "))).collect();
                if whole == 3 {
                    columns[0].clone()
                } else {
                    format!("Mat3::from_columns({})", columns.join(", "))
                }
            }
            Code::Add if entries == 1 => match (self.fixed(place(0)), self.fixed(place(1))) {
                (Some(a), _) => plus(&number(1), a),
                (_, Some(b)) => plus(&number(0), b),
                _ => format!("{} + {}", number(0), number(1)),
            },
            Code::Add => format!("{} + {}", tensor(0), tensor(1)),
            Code::Multiply => product(0, 1),
            Code::MultiplyAdd if self.fixed(place(0)).is_some() => {
                format!("{}.mul_add({}, {})", number(1), number(0), number(2))
            }
            Code::MultiplyAdd => format!("{}.mul_add({}, {})", number(0), number(1), number(2)),
            Code::Divide => format!("{} / {}", number(0), number(1)),
            Code::WholePower(exponent) => format!("super::whole_power({}, {exponent})", number(0)),
            Code::SquareRoot => format!("{}.sqrt()", number(0)),
            Code::Power | Code::PowerOfPositive => format!("super::power({}, {})", number(0), number(1)),
            Code::Call(Function::Ln) => format!("{}.ln()", number(0)),
            Code::Call(Function::Exp) => format!("{}.exp()", number(0)),
            Code::Call(Function::Abs) => format!("{}.abs()", number(0)),
            Code::Compare(comparison) => {
                self.compared.insert(out.value, (comparison, place(0), place(1)));
                return Ok(None);
            }
            Code::Select => {
                let Some((comparison, a, b)) = self.compared.get(&place(0).value).copied() else {
                    return Err(NoKernel("a truth that is no comparison".to_owned()));
                };
                let [a, b] = [a, b].map(|operand| self.read(operand, 1));
                match comparison {
                    Comparison::Less => format!("{a}.select_less({b}, {}, {})", number(1), number(2)),
                    Comparison::LessOrEqual => format!("{b}.select_less({a}, {}, {})", number(2), number(1)),
                    Comparison::Equal => return Err(NoKernel("`==`".to_owned())),
                }
            }
            Code::Scale => scaled(0, 1),
            Code::ScaleAdd => format!("{} + {}", scaled(0, 1), tensor(2)),
            Code::Combine if place(0) == place(2) && self.fixed(place(0)).is_none() => {
                let sum = format!("({} + {})", tensor(1), tensor(3));
                if entries == 9 {
                    format!("{sum}.scaled({})", number(0))
                } else {
                    format!("{sum} * {}", number(0))
                }
            }
            Code::Combine => format!("{} + {}", scaled(0, 1), scaled(2, 3)),
            Code::PlusDiagonal => format!("{}.plus_diagonal({})", matrix(0), number(1)),
            Code::Product => format!("{} * {}", matrix(0), matrix(1)),
            Code::TransposeProduct => format!("{}.transpose_mul(&{})", matrix(0), matrix(1)),
            Code::ProductTranspose => format!("{}.mul_transpose(&{})", matrix(0), matrix(1)),
            Code::Gram => format!("{}.gram()", matrix(0)),
            Code::Transpose => format!("{}.transpose()", matrix(0)),
            Code::Dot if entries == 9 => format!("{}.dot(&{})", matrix(0), matrix(1)),
            Code::Dot => format!("{}.dot({})", vector(0), vector(1)),
            Code::Trace => format!("{}.trace()", matrix(0)),
            Code::Determinant => format!("{}.determinant()", matrix(0)),
            Code::Cofactor => format!("{}.cofactor()", matrix(0)),
            Code::Cross => format!("cofactor_differential(&{}, &{})", matrix(0), matrix(1)),
            Code::Outer => format!("{}.outer({})", vector(0), vector(1)),
            Code::Apply => format!("{} * {}", matrix(0), vector(1)),
            Code::TransposeApply => format!("{}.transpose_apply({})", matrix(0), vector(1)),
            Code::Call(function) => return Err(NoKernel(format!("the function {function:?}"))),
            Code::Decompose | Code::Compose | Code::StretchRates | Code::ComposeDifferential => {
                return Err(NoKernel("principal stretches".to_owned()));
            }
        };
        Ok(Some(text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A product of vectors that one step scales is written where it is scaled, but not where another body reads it too.
    #[test]
    fn products_that_are_kept_have_names() {
        let place = |value| Place { value, offset: 0 };
        let step = |code, out, operands: [usize; 2]| {
            let [a, b] = operands.map(|value| Some(place(value)));
            Step { code, entries: 9, out: place(out), operands: [a, b, None, None, None] }
        };
        let steps = [step(Code::Outer, 2, [0, 1]), step(Code::Scale, 4, [3, 2])];
        let steps: Vec<&Step> = steps.iter().collect();
        let written = |read_later: &[usize]| scaled_outers(&steps, &[], read_later);
        assert_eq!(written(&[4]), HashMap::from([(2, [place(0), place(1)])]));
        assert!(written(&[2, 4]).is_empty());
    }
}
