//! Code of an element under a law: constants once, then forces and their differential at every step.

use super::stretches::{OF_RUST, OF_WGSL, with_functions};
use super::{Rust, Style, Wgsl, symbol, write};
use crate::element::Derived;
use crate::graph::{Expr, Grouped, Substitution};

/// Which language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementCode {
    Rust,
    Wgsl,
}

/// Code, and what it needs.
#[derive(Clone, Debug)]
pub struct Emitted {
    pub text: String,
    /// Grouped constants that forces and differential share.
    pub constant_count: usize,
}

/// `P0x` is `p[0][0]`, `D_3` is `d[3]`; other names of the derivation are as they are.
pub(super) fn indexed(name: &str) -> String {
    if let Some(index) =
        name.strip_prefix("D_").filter(|index| index.bytes().all(|byte| byte.is_ascii_digit()))
    {
        return format!("d[{index}]");
    }
    let letter = name.chars().next().filter(|letter| "PUV".contains(*letter));
    let axis = name.chars().last().and_then(|axis| "xyz".find(axis));
    match (letter, axis) {
        (Some(letter), Some(axis)) if name.len() >= 3 => {
            let node = &name[1..name.len() - 1];
            if node.bytes().all(|byte| byte.is_ascii_digit()) {
                return format!("{}[{node}][{axis}]", letter.to_ascii_lowercase());
            }
            name.to_owned()
        }
        _ => name.to_owned(),
    }
}

impl Derived {
    /// Three functions: grouped constants from rest positions and material constants; forces from displacements;
    /// the differential of forces along a variation.
    ///
    /// All fragments are summed: cutting is for counting here, a compiler is given one function each.
    pub fn emit(&mut self, code: ElementCode) -> Emitted {
        let width = self.forces[0].raw.len();
        let sums = |graph: &mut crate::graph::Graph, fragments: &[crate::element::ElementExpressions]| {
            (0..width)
                .map(|index| {
                    let addends: Vec<Expr> = fragments.iter().map(|fragment| fragment.raw[index]).collect();
                    graph.sum(&addends)
                })
                .collect::<Vec<Expr>>()
        };
        let (forces, differentials) =
            (sums(&mut self.graph, &self.forces), sums(&mut self.graph, &self.differentials));
        let variables: Vec<Expr> =
            self.symbols.displacements.iter().chain(&self.symbols.variations).flatten().copied().collect();
        // one set of constants for both functions
        let roots: Vec<Expr> = forces.into_iter().chain(differentials).collect();
        let Grouped { constants, varying } = self.graph.group_constants(&roots, &variables);
        // constants that hold earlier ones are written out: the function that makes them has no array of them yet
        let mut whole = Substitution::default();
        let mut definitions = Vec::with_capacity(constants.len());
        for (symbol, definition) in &constants {
            let definition = self.graph.substituted(*definition, &mut whole);
            whole.replace(*symbol, definition, false);
            definitions.push(definition);
        }
        let dimension = self.symbols.displacements[0].len();
        let style: &dyn Style = match code {
            ElementCode::Rust => &Rust,
            ElementCode::Wgsl => &Wgsl,
        };
        let shape = Signature {
            nodes: self.symbols.displacements.len(),
            dimension,
            constants: constants.len(),
            parameters: self.symbols.parameters.iter().map(|p| symbol(&self.graph, *p, style)).collect(),
        };
        let (forces, differentials) = varying.split_at(width);
        let bodies = [&definitions[..], &self.graph.shared(forces), &self.graph.shared(differentials)]
            .map(|roots| write(&self.graph, roots, style));
        let text = match code {
            ElementCode::Rust => with_functions(shape.rust(bodies), OF_RUST),
            ElementCode::Wgsl => with_functions(shape.wgsl(bodies), OF_WGSL),
        };
        Emitted { text, constant_count: constants.len() }
    }
}

struct Signature {
    nodes: usize,
    dimension: usize,
    constants: usize,
    parameters: Vec<String>,
}

/// Lines that define parts, and the results.
type Body = (Vec<String>, Vec<String>);

impl Signature {
    fn rust(&self, [constants, forces, differentials]: [Body; 3]) -> String {
        let Self { nodes, dimension, constants: count, parameters } = self;
        let vectors = format!("[[f64; {dimension}]; {nodes}]");
        let material: String = parameters.iter().map(|name| format!(", {name}: f64")).collect();
        let flat = |results: &[String]| -> String {
            let entries: Vec<String> = results.iter().map(|result| format!("        {result},\n")).collect();
            format!("    [\n{}    ]\n", entries.concat())
        };
        let nested = |results: &[String]| -> String {
            let of_node = |node: &[String]| format!("        [{}],\n", node.join(", "));
            format!("    [\n{}    ]\n", results.chunks(*dimension).map(of_node).collect::<String>())
        };
        let lines = |body: &Body| -> String { body.0.iter().map(|line| format!("    {line}\n")).collect() };
        // the differential of a linear force is the same at every displacement
        let is_linear = !differentials.0.iter().chain(&differentials.1).any(|line| line.contains("u["));
        let u = if is_linear { "_u" } else { "u" };
        format!(
            "/// What does not change while the element moves, from its rest positions and material.\n\
             pub fn constants(p: &{vectors}{material}) -> [f64; {count}] {{\n{}{}}}\n\n\
             /// Forces on the nodes [N] from their displacements.\n\
             pub fn forces(d: &[f64; {count}], u: &{vectors}) -> {vectors} {{\n{}{}}}\n\n\
             /// The differential of the forces along `v`.\n\
             pub fn force_differential(d: &[f64; {count}], {u}: &{vectors}, v: &{vectors}) -> {vectors} {{\n{}{}}}\n",
            lines(&constants),
            flat(&constants.1),
            lines(&forces),
            nested(&forces.1),
            lines(&differentials),
            nested(&differentials.1),
        )
    }

    fn wgsl(&self, [constants, forces, differentials]: [Body; 3]) -> String {
        let Self { nodes, dimension, constants: count, parameters } = self;
        let vectors = format!("array<vec{dimension}<f32>, {nodes}>");
        let numbers = format!("array<f32, {count}>");
        let material: String = parameters.iter().map(|name| format!(", {name}: f32")).collect();
        let flat = |results: &[String]| {
            format!("    return {numbers}(\n        {},\n    );\n", results.join(",\n        "))
        };
        let nested = |results: &[String]| {
            let of_node = |node: &[String]| format!("        vec{dimension}<f32>({}),\n", node.join(", "));
            format!(
                "    return {vectors}(\n{}    );\n",
                results.chunks(*dimension).map(of_node).collect::<String>()
            )
        };
        let lines = |body: &Body| -> String { body.0.iter().map(|line| format!("    {line}\n")).collect() };
        format!(
            "// What does not change while the element moves, from its rest positions and material.\n\
             fn constants(p: {vectors}{material}) -> {numbers} {{\n{}{}}}\n\n\
             // Forces on the nodes [N] from their displacements.\n\
             fn forces(d: {numbers}, u: {vectors}) -> {vectors} {{\n{}{}}}\n\n\
             // The differential of the forces along `v`.\n\
             fn force_differential(d: {numbers}, u: {vectors}, v: {vectors}) -> {vectors} {{\n{}{}}}\n",
            lines(&constants),
            flat(&constants.1),
            lines(&forces),
            nested(&forces.1),
            lines(&differentials),
            nested(&differentials.1),
        )
    }
}
