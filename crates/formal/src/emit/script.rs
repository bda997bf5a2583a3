//! The derivation as a program for the computer algebra system Maxima, step by step as in Faure 2014, §3.4.1: shape
//! functions, Jacobian, deformation, energy density, energy of the element, forces, differential, export.
//!
//! What the program here derives itself it also writes down in the language of another, so that both can be compared.

use std::fmt::Write as _;

use super::text::Text;
use super::{Binding, Style, Written, write};
use crate::Function;
use crate::element::{ElementData, RestMap};
use crate::graph::{Comparison, Expr, Node};
use crate::law::{EnergyLaw, LawParameter};

/// Expressions of a law as Maxima reads them.
#[derive(Clone, Copy, Debug, Default)]
struct Maxima;

/// Words of the language that could be names of a law, its settings among them, and those of the program.
const TAKEN: &[&str] = &[
    "and",
    "block",
    "constants",
    "cofactor_of",
    "deformation",
    "diff",
    "determinant",
    "do",
    "domain",
    "dot_of",
    "else",
    "elseif",
    "false",
    "float",
    "for",
    "from",
    "functions",
    "genmatrix",
    "grouped",
    "i",
    "if",
    "in",
    "invert",
    "j",
    "labels",
    "lambda",
    "linel",
    "matrix",
    "next",
    "not",
    "numer",
    "or",
    "outer_of",
    "props",
    "rules",
    "simp",
    "step",
    "stringout",
    "subst",
    "then",
    "thru",
    "trace_of",
    "true",
    "unless",
    "values",
    "while",
];

/// How names begin that the program gives to its steps.
const OWN: &[&str] = &["law_", "choose_", "part", "int", "dF", "dV"];

/// A name of a law in the program: where it could be another's there, with `law_` in front. No two names become the same.
pub fn maxima_name(name: &str) -> String {
    // shape functions, axes, displacements, constants and the steps begin with capital letters
    let is_upper = name.starts_with(|letter: char| letter.is_ascii_uppercase()) && name != "F";
    let is_own = OWN.iter().any(|own| name.starts_with(own));
    if is_upper || is_own || TAKEN.contains(&name) { format!("law_{name}") } else { name.to_owned() }
}

impl Style for Maxima {
    fn number(&self, value: f64) -> String {
        if value.fract() == 0.0 && value.abs() < 1e15 { format!("{value}") } else { format!("{value:e}") }
    }

    fn symbol(&self, name: &str) -> String {
        maxima_name(name)
    }

    fn times(&self) -> &'static str {
        "*"
    }

    fn quotient(&self, above: &Written, below: &Written) -> Written {
        Text.quotient(above, below)
    }

    fn power(&self, base: &Written, exponent: f64) -> Written {
        Text.power(base, exponent)
    }

    fn power_of(&self, base: &Written, exponent: &Written) -> Written {
        Text.power_of(base, exponent)
    }

    fn function(&self, function: Function, argument: &Written) -> Written {
        // the natural logarithm is `log` there
        if function == Function::Ln {
            return Written::atom(format!("log({})", argument.text));
        }
        Text.function(function, argument)
    }

    fn select(&self, (comparison, a, b): (Comparison, &str, &str), value: &str, otherwise: &str) -> Written {
        let choice = CHOICES.iter().find(|(known, ..)| *known == comparison).map_or("", |(_, name, _)| name);
        Written::atom(format!("{choice}({a} - ({b}), {value}, {otherwise})"))
    }

    fn tensor(&self, node: &Node, operands: &[Written]) -> Option<Written> {
        let call = |name: &str| {
            let arguments: Vec<&str> = operands.iter().map(|operand| operand.text.as_str()).collect();
            Written::atom(format!("{name}({})", arguments.join(", ")))
        };
        Some(match node {
            Node::Identity => Written::atom("ident(3)"),
            Node::Zero(_) => Written::atom("zeromatrix(3, 3)"),
            Node::Multiply(..) | Node::Apply(..) => {
                let factors: Vec<String> =
                    operands.iter().map(|operand| format!("({})", operand.text)).collect();
                Written::atom(format!("({})", factors.join(" . ")))
            }
            Node::Transpose(_) => call("transpose"),
            Node::Dot(..) => call("dot_of"),
            Node::Trace(_) => call("trace_of"),
            Node::Determinant(_) => call("determinant"),
            Node::Cofactor(_) => call("cofactor_of"),
            Node::Outer(..) => call("outer_of"),
            Node::Entry(_, index) if *index < 9 => Written {
                text: format!("({})[{}, {}]", operands[0].text, index % 3 + 1, index / 3 + 1),
                binding: Binding::Atom,
            },
            _ => return None,
        })
    }

    fn definition(&self, name: &str, value: &str) -> String {
        format!("{name}: {value}$")
    }

    fn part(&self, index: usize) -> String {
        // `t0` may be a parameter of the law, and this program is one name space
        format!("part{index}")
    }

    fn powers_are_products(&self) -> bool {
        false
    }
}

/// Choices by the sign of a number, which are functions here: Maxima differentiates no conditions. Their names, and their signs.
const CHOICES: [(Comparison, &str, &str); 3] = [
    (Comparison::Less, "choose_below", "<"),
    (Comparison::LessOrEqual, "choose_at_most", "<="),
    (Comparison::Equal, "choose_equal", "="),
];

/// What the energy may call that Maxima does not have by these names, and the list of what is constant: equal constants are one.
const HELPERS: &str = "constants: []$
grouped(c) := block([known: sublist(constants, lambda([entry], is(rhs(entry) = c)))],
  if numberp(c) then return(c),
  if known = [] then constants: endcons(concat(D, length(constants)) = c, constants),
  if known = [] then lhs(last(constants)) else lhs(first(known)))$
trace_of(a) := a[1, 1] + a[2, 2] + a[3, 3]$
dot_of(a, b) := block([s: 0], for i thru 3 do for j thru length(a[1]) do s: s + a[i, j]*b[i, j], s)$
cofactor_of(a) := transpose(adjoint(a))$
outer_of(a, b) := a . transpose(b)$
";

/// The program; `association` is the name of law, element and cut, uncut.
///
/// Laws in principal stretches: `None`. Roots of the characteristic polynomial could be written; of Ogden's law on a triangle the
/// second derivatives of what comes of them took Maxima half a minute and more than 5 MB, which nobody reads.
pub fn maxima(element: &ElementData, law: &EnergyLaw, association: &str) -> Option<String> {
    let terms = law.terms();
    let is_beyond = |expr: &Expr| matches!(law.graph.node(*expr), Node::Decompose(_) | Node::Pack(_));
    if law.graph.reachable(&terms).iter().any(is_beyond) {
        return None;
    }
    let mut text = format!("/* {association}: batch this file with Maxima */\n{HELPERS}");
    for (_, name, _) in CHOICES {
        let _ = writeln!(text, "gradef({name}(c, v, w), 0, {name}(c, 1, 0), {name}(c, 0, 1))$");
    }
    put_deformation(&mut text, element);
    put_energy(&mut text, law, &terms);
    put_integral(&mut text, element, terms.len());
    put_forces(&mut text, element, association);
    Some(text)
}

/// Letters of the axes of an element.
fn axes_of(element: &ElementData) -> &'static [&'static str] {
    &["x", "y", "z"][..element.dimension]
}

/// Steps 1 to 3: from shape functions to the gradient of displacements along `R0`, `R1`, `R2`, and what `F` is of it in space.
fn put_deformation(text: &mut String, element: &ElementData) {
    let axes = axes_of(element);
    let _ = writeln!(text, "\n/* 1. interpolation */");
    for (node, shape) in element.shapes.iter().enumerate() {
        let _ = writeln!(text, "L{node}: {}$", polynomial(shape));
    }
    let field = |letter: &str, axis: &str| {
        let terms: Vec<String> =
            (0..element.node_count).map(|node| format!("L{node}*{letter}{node}{axis}")).collect();
        terms.join(" + ")
    };
    for axis in axes {
        let _ = writeln!(text, "U{axis}: {}$", field("U", axis));
    }
    let _ = writeln!(text, "\n/* 2. Jacobian: rows are directions of derivatives */");
    for (k, axis) in axes.iter().enumerate() {
        let place = match element.map {
            RestMap::Nodes => field("P", axis),
            // the middle of the box, and half its length along the axis
            RestMap::Box { low, high } => {
                format!("(P{low}{axis} + P{high}{axis})/2 + R{k}*(P{high}{axis} - P{low}{axis})/2")
            }
        };
        let _ = writeln!(text, "T{axis}: {place}$");
    }
    let rows_of = |letter: &str| {
        let row = |k: usize| {
            let entries: Vec<String> =
                axes.iter().map(|axis| format!("diff({letter}{axis}, R{k})")).collect();
            format!("[{}]", entries.join(", "))
        };
        (0..axes.len()).map(row).collect::<Vec<_>>().join(", ")
    };
    let _ = writeln!(text, "JT: matrix({})$", rows_of("T"));
    let _ = writeln!(text, "\n/* 3. deformation gradient; in the plane nothing stretches across */");
    let _ = writeln!(text, "DU: matrix({})$", rows_of("U"));
    let _ = writeln!(
        text,
        "deformation(GradU) := genmatrix(lambda([i, j], (if i = j then 1 else 0) + (if i <= {0} and j <= {0} then GradU[j, i] else 0)), 3, 3)$",
        axes.len()
    );
}

/// Step 4: one function of `F` for each term of the law.
fn put_energy(text: &mut String, law: &EnergyLaw, terms: &[Expr]) {
    let _ = writeln!(text, "\n/* 4. energy density, term by term */");
    for (name, parameter) in &law.parameters {
        if let LawParameter::Direction([x, y, z]) = parameter {
            let name = Maxima.symbol(name);
            let _ = writeln!(text, "{name}: matrix([{x:e}], [{y:e}], [{z:e}])$");
        }
    }
    for (term, expr) in terms.iter().enumerate() {
        let (parts, roots) = write(&law.graph, &[*expr], &Maxima);
        let parts: Vec<&str> = parts.iter().map(|part| part.trim_end_matches('$')).collect();
        let names: Vec<&str> = parts.iter().filter_map(|part| part.split(':').next()).collect();
        let lines: Vec<&str> = parts.iter().copied().chain(roots.iter().map(String::as_str)).collect();
        let _ = writeln!(text, "W{term}(F) := block([{}],\n  {})$", names.join(", "), lines.join(",\n  "));
    }
}

/// Steps 5 and 6: the energy of the element, sample by sample, with names for what the rest shape alone decides.
///
/// Entries of the inverse map and weights are named before anything is differentiated: the derivatives, which know them by name,
/// are ten times shorter than with the quotients spelled out, and Maxima has them in seconds instead of minutes.
fn put_integral(text: &mut String, element: &ElementData, terms: usize) {
    let _ = writeln!(
        text,
        "\n/* 6. what holds no U or V is named D0, D1, ...; before 5, so that the energy knows it by name */"
    );
    for (q, sample) in element.samples.iter().enumerate() {
        let at: Vec<String> =
            (0..element.dimension).map(|k| format!("R{k} = {:e}", sample.position[k])).collect();
        let at = at.join(", ");
        let _ = writeln!(text, "JT_{q}: subst([{at}], JT)$");
        let _ = writeln!(text, "F_{q}: deformation(matrixmap(grouped, invert(JT_{q})) . subst([{at}], DU))$");
        let _ = writeln!(text, "dV_{q}: grouped({:e}*determinant(JT_{q}))$", sample.weight);
    }
    let _ = writeln!(text, "\n/* 5. energy of the element, by samples */");
    let mut addends = Vec::new();
    for q in 0..element.samples.len() {
        for term in 0..terms {
            let _ = writeln!(text, "intW{term}_{q}: W{term}(F_{q})*dV_{q}$");
            addends.push(format!("intW{term}_{q}"));
        }
    }
    let _ = writeln!(text, "WE: {}$", addends.join(" + "));
}

/// Steps 7 to 9: forces, their differential, and both as files.
fn put_forces(text: &mut String, element: &ElementData, association: &str) {
    let axes = axes_of(element);
    let unknowns: Vec<String> = (0..element.node_count)
        .flat_map(|node| axes.iter().map(move |axis| format!("{node}{axis}")))
        .collect();
    let _ = writeln!(text, "\n/* 7. forces */");
    for unknown in &unknowns {
        let _ = writeln!(text, "F{unknown}: -diff(WE, U{unknown})$");
    }
    let _ = writeln!(text, "\n/* 8. their differential along V */");
    for unknown in &unknowns {
        let terms: Vec<String> =
            unknowns.iter().map(|other| format!("diff(F{unknown}, U{other})*V{other}")).collect();
        let _ = writeln!(text, "dF{unknown}: {}$", terms.join(" + "));
    }
    let _ = writeln!(text, "\n/* 9. one file for each expression, and one for the constants */");
    let _ = writeln!(text, "stringout(\"ECR_{association}0.mac\", constants)$");
    for unknown in &unknowns {
        for prefix in ["F", "dF"] {
            let _ = writeln!(text, "stringout(\"{prefix}{association}0_{unknown}.mac\", {prefix}{unknown})$");
        }
    }
    let _ = writeln!(
        text,
        "\n/* for whoever puts numbers in, `mu: 1$ P0x: 0$ ... numbers()$ F0x: ev(F0x);` */\n\
         numbers() := for entry in constants do lhs(entry) :: ev(rhs(entry))$"
    );
    for (_, name, sign) in CHOICES {
        let _ = writeln!(text, "{name}(c, v, w) := if c {sign} 0 then v else w$");
    }
}

/// `Σ c R0^x R1^y R2^z / (1 - R2)^w`.
fn polynomial(shape: &[(f64, [u8; 4])]) -> String {
    let term = |(coefficient, powers): &(f64, [u8; 4])| {
        let bases = ["R0", "R1", "R2", "(1 - R2)"];
        let mut term = Maxima.number(*coefficient);
        for (place, (base, power)) in
            bases.iter().zip(powers).enumerate().filter(|(_, (_, power))| **power > 0)
        {
            let sign = if place == 3 { '/' } else { '*' };
            let exponent = if *power == 1 { String::new() } else { format!("^{power}") };
            let _ = write!(term, "{sign}{base}{exponent}");
        }
        format!("({term})")
    };
    shape.iter().map(term).collect::<Vec<_>>().join(" + ")
}
