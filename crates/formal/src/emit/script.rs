//! The derivation as a program for the computer algebra system Maxima, step by step as in Faure 2014, §3.4.1: shape
//! functions, Jacobian, deformation, energy density, integration, grouped constants, forces, differential, export.
//!
//! What the program here derives itself it also writes down in the language of another, so that both can be compared.
//!
//! Where the source differentiates an energy spelled out in displacements, `F` and the stress have names at every sample here,
//! and forces follow by the chain rule, `f_n = -Σ_q ω_q P_q : ∂F_q/∂U_n`: second derivatives then take kilobytes in the place of
//! megabytes. Principal stretches `s` and the vectors of `F = Σ s_k u_k v_kᵀ` have names and slopes too,
//!
//! `∂s_k = u_k·∂F v_k`, `∂u_k = Σ_{l≠k} (s_k u_l·∂F v_k + s_l u_k·∂F v_l)/(s_k² - s_l²) u_l`, and `v_k` alike with `s_k`, `s_l` in
//! each other's places, for stretches that differ (Papadopoulo & Lourakis 2000).

use std::fmt::Write as _;

use super::text::Text;
use super::{Binding, Style, Written, write};
use crate::Function;
use crate::element::{ElementData, RestMap};
use crate::graph::{Comparison, Expr, Node, STRETCHES};
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
    "displacements",
    "determinant",
    "do",
    "domain",
    "dot_of",
    "else",
    "elseif",
    "entry",
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
    "k",
    "l",
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
    "steps",
    "stretches",
    "stringout",
    "subst",
    "then",
    "thru",
    "trace_of",
    "true",
    "unless",
    "values",
    "variations",
    "while",
];

/// How names begin that the program gives to its steps.
const OWN: &[&str] = &["law_", "choose_", "part", "int", "dF", "dS", "dV", "decomposition"];

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
            // of the deformation gradient alone: the one that the energy is a function of
            Node::Decompose(_) => Written::atom("stretches".to_owned()),
            Node::Pack(list) => {
                let entry = |i: usize| operands[i].text.as_str();
                let row = |i: usize| match list.len() {
                    3 => format!("[{}]", entry(i)),
                    _ => format!("[{}, {}, {}]", entry(i), entry(i + 3), entry(i + 6)),
                };
                Written::atom(format!("matrix({}, {}, {})", row(0), row(1), row(2)))
            }
            Node::Entry(_, index) if *index >= STRETCHES => {
                Written::atom(format!("{}[{}]", operands[0].text, index - STRETCHES + 1))
            }
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

/// Stretches and their vectors, by the names that they have at a sample, and their slopes along the entries of `F` there. Numbers come
/// from the characteristic polynomial: `v` from the largest column of the cofactors of `FᵀF - s²`, `u = F v / s`; where two are equal these
/// have no value, and neither have the slopes, which the program says.
const DECOMPOSITION: &str = "stretch(k, q) := concat(Stretch, k, \"_\", q)$
vector(letter, k, q) := genmatrix(lambda([i, j], concat(letter, i, k, \"_\", q)), 3, 1)$
declare_stretches(q, F) := for k thru 3 do for i thru 3 do for j thru 3 do if not numberp(F[i, j]) then block(
  [uk: vector(Left, k, q), vk: vector(Right, k, q), du: zeromatrix(3, 1), dv: zeromatrix(3, 1)],
  apply('gradef, [stretch(k, q), F[i, j], uk[i, 1]*vk[j, 1]]),
  for l thru 3 do if l # k then block(
    [ul: vector(Left, l, q), vl: vector(Right, l, q), sk: stretch(k, q), sl: stretch(l, q)],
    du: du + (sk*ul[i, 1]*vk[j, 1] + sl*uk[i, 1]*vl[j, 1])/(sk^2 - sl^2)*ul,
    dv: dv + (sl*ul[i, 1]*vk[j, 1] + sk*uk[i, 1]*vl[j, 1])/(sk^2 - sl^2)*vl),
  for a thru 3 do (
    apply('gradef, [uk[a, 1], F[i, j], du[a, 1]]),
    apply('gradef, [vk[a, 1], F[i, j], dv[a, 1]])))$
decomposed(q, F) := block([C: transpose(F) . F, mean, off, radius, angle, square, N, column, most, w],
  if determinant(F) <= 0 then error(\"sample\", q, \"is flat or inside out: its stretches are not these roots\"),
  mean: trace_of(C)/3, off: C - mean*ident(3), radius: sqrt(dot_of(off, off)/6),
  if float(radius) < 1e-7*float(mean) then error(\"all stretches of sample\", q, \"are equal: slopes of their vectors have no value\"),
  if float(1 - abs(determinant(off)/(2*radius^3))) < 1e-12 then
    error(\"two stretches of sample\", q, \"are equal: slopes of their vectors have no value\"),
  angle: acos(max(-1, min(1, determinant(off)/(2*radius^3))))/3,
  for k thru 3 do (
    square: float(mean + 2*radius*cos(angle + 2*%pi*(k - 1)/3)), N: adjoint(C - square*ident(3)), most: 0,
    for j thru 3 do (w: col(N, j), if dot_of(w, w) > most then (column: w, most: dot_of(w, w))),
    stretch(k, q) :: sqrt(square), w: column/sqrt(most),
    for i thru 3 do vector(Right, k, q)[i, 1] :: w[i, 1],
    w: F . w/sqrt(square),
    for i thru 3 do vector(Left, k, q)[i, 1] :: w[i, 1]),
  done)$
";

/// The program; `association` is the name of law, element and cut, uncut.
pub fn maxima(element: &ElementData, law: &EnergyLaw, association: &str) -> String {
    let terms = law.terms();
    let mut text = format!("/* {association}: batch this file with Maxima */\n{HELPERS}");
    if law.uses_stretches() {
        text += "/* of principal stretches: for numbers at which they differ; at equal ones, as at rest, take numbers beside them */\n";
        text += DECOMPOSITION;
    }
    for (_, name, _) in CHOICES {
        let _ = writeln!(text, "gradef({name}(c, v, w), 0, {name}(c, 1, 0), {name}(c, 0, 1))$");
    }
    put_deformation(&mut text, element);
    put_energy(&mut text, law, &terms);
    put_samples(&mut text, element, law, terms.len());
    put_forces(&mut text, element, association);
    text
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
        let _ = writeln!(
            text,
            "W{term}(F, stretches) := block([{}],\n  {})$",
            names.join(", "),
            lines.join(",\n  ")
        );
    }
}

/// Steps 5 and 6: what the rest shape alone decides, and the energy of the element, sample by sample, in the entries of `F` there.
fn put_samples(text: &mut String, element: &ElementData, law: &EnergyLaw, terms: usize) {
    let _ = writeln!(
        text,
        "\n/* 6. what holds no U or V is named D0, D1, ...; before 5, which knows it by name */"
    );
    for (q, sample) in element.samples.iter().enumerate() {
        let at: Vec<String> =
            (0..element.dimension).map(|k| format!("R{k} = {:e}", sample.position[k])).collect();
        let at = at.join(", ");
        let _ = writeln!(text, "JT_{q}: subst([{at}], JT)$");
        let _ =
            writeln!(text, "FU_{q}: deformation(matrixmap(grouped, invert(JT_{q})) . subst([{at}], DU))$");
        let _ = writeln!(text, "dV_{q}: grouped({:e}*determinant(JT_{q}))$", sample.weight);
    }
    let _ = writeln!(
        text,
        "\n/* 5. energy of the element, by samples; entries of F that move are named F11_0, ..., and what they are is kept in steps */\n\
         steps: []$\n\
         named(letter, q, FU, value) := genmatrix(lambda([i, j], if numberp(FU[i, j]) then value[i, j] else block(\n  \
         [name: concat(letter, i, j, \"_\", q)], steps: endcons(name = value[i, j], steps), name)), 3, 3)$"
    );
    let mut addends = Vec::new();
    for q in 0..element.samples.len() {
        let _ = writeln!(text, "F_{q}: named(F, {q}, FU_{q}, FU_{q})$");
        let stretches = if law.uses_stretches() {
            let _ = writeln!(text, "declare_stretches({q}, F_{q})$");
            let step = format!("decomposition_{q} = funmake(decomposed, [{q}, F_{q}])");
            let _ = writeln!(text, "steps: endcons({step}, steps)$");
            format!("[stretch(1, {q}), stretch(2, {q}), stretch(3, {q})]")
        } else {
            "[]".to_owned()
        };
        for term in 0..terms {
            let _ = writeln!(text, "intW{term}_{q}: W{term}(F_{q}, {stretches})*dV_{q}$");
            addends.push(format!("intW{term}_{q}"));
        }
    }
    let _ = writeln!(text, "WE: {}$", addends.join(" + "));
}

/// Steps 7 to 9: forces, their differential, and both as files.
fn put_forces(text: &mut String, element: &ElementData, association: &str) {
    let axes = axes_of(element);
    let samples = element.samples.len();
    let unknowns: Vec<String> = (0..element.node_count)
        .flat_map(|node| axes.iter().map(move |axis| format!("{node}{axis}")))
        .collect();
    let list = |letter: &str| {
        let names: Vec<String> = unknowns.iter().map(|unknown| format!("{letter}{unknown}")).collect();
        names.join(", ")
    };
    // Σ over samples of the entries' products with their slopes
    let by_chain = |letter: &str, unknown: &str| {
        let terms: Vec<String> =
            (0..samples).map(|q| format!("dot_of({letter}_{q}, diff(FU_{q}, U{unknown}))")).collect();
        format!("-({})", terms.join(" + "))
    };
    let _ = writeln!(
        text,
        "\n/* 7. stress times volume at the samples, S = dWE/dF, and forces by the chain rule */\n\
         slopes(F) := genmatrix(lambda([i, j], if numberp(F[i, j]) then 0 else diff(WE, F[i, j])), 3, 3)$"
    );
    for q in 0..samples {
        let _ = writeln!(text, "P_{q}: slopes(F_{q})$\nS_{q}: named(S, {q}, FU_{q}, P_{q})$");
    }
    for unknown in &unknowns {
        let _ = writeln!(text, "F{unknown}: {}$", by_chain("S", unknown));
    }
    let _ = writeln!(
        text,
        "\n/* 8. their differential along V */\n\
         displacements: [{}]$\nvariations: [{}]$\n\
         varied(a) := genmatrix(lambda([i, j], sum(diff(a[i, j], displacements[n])*variations[n], n, 1, {})), 3, 3)$\n\
         along(a, F, dF) := genmatrix(lambda([i, j], block([sum: 0], for k thru 3 do for l thru 3 do\n  \
         if not numberp(F[k, l]) then sum: sum + diff(a[i, j], F[k, l])*dF[k, l], sum)), 3, 3)$",
        list("U"),
        list("V"),
        unknowns.len()
    );
    for q in 0..samples {
        let _ = writeln!(text, "dF_{q}: named(dF, {q}, FU_{q}, varied(FU_{q}))$");
        let _ = writeln!(text, "dS_{q}: named(dS, {q}, FU_{q}, along(P_{q}, F_{q}, dF_{q}))$");
    }
    for unknown in &unknowns {
        let _ = writeln!(text, "dF{unknown}: {}$", by_chain("dS", unknown));
    }
    let _ = writeln!(
        text,
        "\n/* 9. one file for each expression, one for the constants, and one for the steps between */\n\
         stringout(\"ECR_{association}0.mac\", constants)$\nstringout(\"steps_{association}0.mac\", steps)$"
    );
    for unknown in &unknowns {
        for prefix in ["F", "dF"] {
            let _ = writeln!(text, "stringout(\"{prefix}{association}0_{unknown}.mac\", {prefix}{unknown})$");
        }
    }
    let _ = writeln!(
        text,
        "\n/* for whoever puts numbers in, `mu: 1$ P0x: 0$ ... numbers()$ F0x: ev(F0x);` */\n\
         numbers() := for entry in append(constants, steps) do lhs(entry) :: ev(rhs(entry))$"
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
