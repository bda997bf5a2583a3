//! Emitted functions of the principal stretches: what is run of them is what the law gives at the samples, where stretches differ,
//! where some of them coincide or nearly do, at rest, and in inverted cells.
//!
//! Of WGSL what is validated is also run, in single precision: it reads as Rust where vectors and matrices are given by a prelude,
//! but for the words of variables, lists and structures.

use souple_formal::law::LawText;
use souple_math::{Mat3, exponential};

use super::*;

/// How nodes are moved: `U diag(s) Vᵀ` of where they rest.
#[derive(Clone, Copy)]
struct Placement {
    name: &'static str,
    stretches: [f64; 3],
}

const PLACEMENTS: &[Placement] = &[
    Placement { name: "at rest", stretches: [1.0, 1.0, 1.0] },
    Placement { name: "three alike", stretches: [1.2, 1.2, 1.2] },
    Placement { name: "two alike", stretches: [1.1, 0.8, 1.1] },
    Placement { name: "two nearly alike", stretches: [1.1, 1.1 * (1.0 + 1e-7), 0.9] },
    Placement { name: "two a little apart", stretches: [0.9, 1.1 * (1.0 + 3e-5), 1.1] },
    Placement { name: "none alike", stretches: [1.3, 0.7, 1.05] },
];

/// Of laws that have a value there.
const INVERTED: Placement = Placement { name: "inverted", stretches: [1.2, 0.9, -0.7] };

/// Laws by name, and one as text, whose terms are no powers.
fn laws() -> Vec<(&'static str, EnergyLaw)> {
    let number = |value| LawParameter::Number { value, dimension: None };
    let hencky = LawText {
        energy: "mu*(log(l1)^2 + log(l2)^2 + log(l3)^2) + lambda/2*log(J)^2".to_owned(),
        definitions: Vec::new(),
        parameters: vec![("mu".to_owned(), number(1e4)), ("lambda".to_owned(), number(2e4))],
    };
    let of_table = ["ogden", "corotational"].map(|name| {
        let law = WRITTEN_LAWS.iter().find(|law| law.name == name).unwrap();
        (name, law.text().unwrap())
    });
    let all = of_table.into_iter().chain([("hencky", hencky)]);
    all.map(|(name, text)| (name, EnergyLaw::compile(&text).unwrap())).collect()
}

/// Every law on a triangle, a tetrahedron and a pyramid in every placement, with what its law gives at the samples.
fn placed() -> Vec<Case> {
    let mut cases = Vec::new();
    for (law, compiled) in laws() {
        for kind in [ElementKind::Tri3, ElementKind::Tet4, ElementKind::Pyramid5] {
            let element = element_data(kind, &kind.rules()[0], MapKind::General).unwrap();
            let derived = element.derive(&compiled, Cut::NONE);
            let inverted = (law == "corotational" && element.dimension == 3).then_some(&INVERTED);
            for placement in PLACEMENTS.iter().chain(inverted) {
                let mut known = inputs(kind, &compiled);
                place(&mut known, &element, placement);
                let exact = by_samples(&element, &compiled, &known);
                let name = format!("{law} on {kind}, {}", placement.name);
                cases.push(Case { name, element: element.clone(), derived: derived.clone(), known, exact });
            }
        }
    }
    cases
}

/// In the plane the third stretch is one, and the first two of the placement are taken.
fn place(known: &mut HashMap<String, f64>, element: &ElementData, placement: &Placement) {
    let [a, b, c] = placement.stretches;
    let (turn, along) = if element.dimension == 2 {
        (Vec3::new(0.0, 0.0, 0.4), Vec3::new(0.0, 0.0, 0.9))
    } else {
        (Vec3::new(0.3, -0.2, 0.4), Vec3::new(-0.5, 0.1, 0.9))
    };
    let third = if element.dimension == 2 { 1.0 } else { c };
    let stretch = Mat3::from_columns(Vec3::AXES[0] * a, Vec3::AXES[1] * b, Vec3::AXES[2] * third);
    let along = exponential(along);
    let F = exponential(turn) * (along * stretch).mul_transpose(&along);
    for node in 0..element.node_count {
        let axes = 0..element.dimension;
        let mut rest = [0.0; 3];
        axes.clone().for_each(|axis| rest[axis] = known[&format!("p[{node}][{axis}]")]);
        let moved = F * vector(rest) - vector(rest);
        for axis in axes {
            known.insert(format!("u[{node}][{axis}]"), moved[axis]);
        }
    }
}

/// Forces at rest are none: both are measured by the size of both, of a displacement of a tenth.
fn worst(numbers: [&[f64]; 2], exact: &[Vec<f64>; 2]) -> f64 {
    let norm = |list: &mut dyn Iterator<Item = f64>| list.map(|x| x * x).sum::<f64>().sqrt();
    let size = norm(&mut exact.iter().flatten().copied());
    let off = |(numbers, exact): (&[f64], &Vec<f64>)| {
        assert_eq!(numbers.len(), exact.len());
        norm(&mut numbers.iter().zip(exact).map(|(a, b)| a - b)) / size
    };
    numbers.into_iter().zip(exact).map(off).fold(0.0, |worst, off| if off <= worst { worst } else { off })
}

/// Compiles a program that prints forces and differential of every case, and holds them against the exact ones.
fn compiled_and_compared(name: &str, program: &str, cases: &[Case], allowed: f64) {
    let folder = folder(name);
    let (source, binary) = (folder.join("main.rs"), folder.join("main"));
    std::fs::write(&source, program).unwrap();
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let flags = ["--edition", "2024", "-D", "warnings", "-A", "dead_code", "-o"];
    output(Command::new(compiler).args(flags).arg(&binary).arg(&source));
    let printed = output(&mut Command::new(&binary));
    let lines: Vec<Vec<f64>> = printed
        .lines()
        .map(|line| line.trim_matches(['[', ']']).split(", ").map(|number| number.parse().unwrap()).collect())
        .collect();
    assert_eq!(lines.len(), 2 * cases.len());
    for (case, lines) in cases.iter().zip(lines.chunks(2)) {
        let off = worst([&lines[0], &lines[1]], &case.exact);
        assert!(off <= allowed, "{}: {off:e}", case.name);
    }
}

#[test]
fn rust_is_right_where_stretches_coincide() {
    let mut cases = placed();
    let program = rust_program(&mut cases);
    // a quotient of differences of 3e-5 loses 1e-16/3e-5, some ten times
    compiled_and_compared("stretches_rust", &program, &cases, 1e-10);
}

/// WGSL as Rust.
fn translated(code: &str) -> String {
    let mut text = String::new();
    let mut rest = code;
    // `array<T, 3>` is `[T; 3]`, and a list of them stands in brackets
    while let Some(start) = rest.find("array<") {
        text += &rest[..start];
        rest = &rest[start + "array<".len()..];
        let comma = rest.find(", ").unwrap();
        let end = comma + rest[comma..].find('>').unwrap();
        if rest[end + 1..].starts_with('(') {
            text += "[";
            rest = &rest[end + 2..];
        } else {
            let _ = write!(text, "[{}; {}]", &rest[..comma], &rest[comma + 2..end]);
            rest = &rest[end + 1..];
        }
    }
    text += rest;
    let words = [
        ("\n    );", "\n    ];"),
        ("vec2<f32>(", "vec2("),
        ("vec3<f32>(", "vec3("),
        ("mat3x3<f32>(", "mat3x3("),
        ("var ", "let mut "),
        ("struct ", "#[derive(Clone, Copy)]\npub struct "),
        ("\nfn ", "\npub fn "),
    ];
    words.into_iter().fold(text, |text, (from, to)| text.replace(from, to))
}

#[test]
fn wgsl_is_right_where_stretches_coincide() {
    let mut cases = placed();
    let prelude = include_str!("wgsl_prelude.txt");
    let (allow, prelude) = prelude.split_once('\n').unwrap();
    let (mut modules, mut calls) = (String::new(), String::new());
    for (index, case) in cases.iter_mut().enumerate() {
        let code = case.derived.emit(ElementCode::Wgsl).text;
        let vectors = |letter: char| {
            let of_node = |node: usize| {
                let number = |axis: usize| format!("{:?}", case.known[&format!("{letter}[{node}][{axis}]")]);
                let numbers: Vec<String> = (0..case.element.dimension).map(number).collect();
                format!("case{index}::vec{}({})", numbers.len(), numbers.join(", "))
            };
            format!("[{}]", (0..case.element.node_count).map(of_node).collect::<Vec<_>>().join(", "))
        };
        let material = arguments(&code.replace(": f32", ": f64"), case);
        let code = translated(&code);
        let _ = writeln!(modules, "mod case{index} {{\n{prelude}{code}\n}}");
        let (p, u, v) = (vectors('p'), vectors('u'), vectors('v'));
        let axes = ["x", "y", "z"].map(|axis| format!("f64::from(f.{axis})"));
        let flat = format!("flat_map(|f| [{}])", axes[..case.element.dimension].join(", "));
        let _ = writeln!(calls, "    let d = case{index}::constants({p}{material});");
        for call in [format!("forces(d, {u})"), format!("force_differential(d, {u}, {v})")] {
            let _ = writeln!(calls, "    print(case{index}::{call}.into_iter().{flat}.collect());");
        }
    }
    let print = "fn print(numbers: Vec<f64>) { println!(\"{numbers:?}\"); }";
    let program = format!("{allow}\n{modules}\nfn main() {{\n{calls}}}\n{print}\n");
    // 6e-8 over strains of a tenth, a hundred times
    compiled_and_compared("stretches_wgsl", &program, &cases, 1e-4);
}
