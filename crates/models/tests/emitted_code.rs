//! Emitted code does what the expressions say: Rust as its compiler makes it, WGSL as its validator and a reader of the few forms
//! that are emitted take it, in single precision, and programs for Maxima where `SOUPLE_MAXIMA` names it. All are written from
//! the same expressions (FAU-16, FAU-30).
#![allow(non_snake_case)]

mod stretches;

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

use souple_formal::element::{Cut, Derived, ElementData};
use souple_formal::emit::{ElementCode, maxima, maxima_name};
use souple_formal::law::{EnergyLaw, LawParameter};
use souple_math::{Mat3, Vec3};
use souple_mesh::ElementKind;
use souple_models::derive::{MapKind, element_data};
use souple_models::materials::WRITTEN_LAWS;

/// The nearest number in single precision.
fn round(value: f64) -> f64 {
    f64::from(value as f32)
}

/// Runs the body of one function of WGSL: `let` lines, then the results between the last brackets.
struct Reader<'a> {
    text: &'a [u8],
    at: usize,
    known: HashMap<String, f64>,
}

impl Reader<'_> {
    fn skip_blanks(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    fn take(&mut self, token: &str) -> bool {
        self.skip_blanks();
        let found = self.text[self.at..].starts_with(token.as_bytes());
        self.at += if found { token.len() } else { 0 };
        found
    }

    fn expect(&mut self, token: &str) {
        let here = String::from_utf8_lossy(&self.text[self.at..(self.at + 60).min(self.text.len())]);
        assert!(self.take(token), "`{token}` was expected at `{here}`");
    }

    fn sum(&mut self) -> f64 {
        let mut sum = self.product();
        loop {
            if self.take("+") {
                sum = round(sum + self.product());
            } else if self.take("-") {
                sum = round(sum - self.product());
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut product = self.factor();
        loop {
            if self.take("*") {
                product = round(product * self.factor());
            } else if self.take("/") {
                product = round(product / self.factor());
            } else {
                return product;
            }
        }
    }

    fn factor(&mut self) -> f64 {
        if self.take("-") {
            return -self.factor();
        }
        if self.take("(") {
            let value = self.sum();
            self.expect(")");
            return value;
        }
        self.skip_blanks();
        let start = self.at;
        let mut open = 0;
        while let Some(letter) = self.text.get(self.at) {
            // the sign of an exponent; a bracket that was not opened here closes what is around
            let is_sign = b"+-".contains(letter)
                && self.text[start].is_ascii_digit()
                && self.at > start
                && self.text[self.at - 1] == b'e';
            match letter {
                b'[' => open += 1,
                b']' if open > 0 => open -= 1,
                b'_' | b'.' => {}
                _ if letter.is_ascii_alphanumeric() || is_sign => {}
                _ => break,
            }
            self.at += 1;
        }
        let word = std::str::from_utf8(&self.text[start..self.at]).unwrap().to_owned();
        if let Ok(number) = word.parse::<f64>() {
            return round(number);
        }
        if self.take("(") {
            return self.call(&word);
        }
        *self.known.get(&word).unwrap_or_else(|| panic!("`{word}` is not known"))
    }

    fn comparison(&mut self) -> bool {
        let a = self.sum();
        let sign = ["<=", "==", "<"].into_iter().find(|sign| self.take(sign)).expect("a comparison");
        let b = self.sum();
        match sign {
            "<=" => a <= b,
            "==" => a == b,
            _ => a < b,
        }
    }

    fn call(&mut self, name: &str) -> f64 {
        let first = self.sum();
        let value = match name {
            // WGSL: select(otherwise, value, condition)
            "select" => {
                self.expect(",");
                let value = self.sum();
                self.expect(",");
                if self.comparison() { value } else { first }
            }
            "pow" => {
                self.expect(",");
                first.powf(self.sum())
            }
            "sqrt" => first.sqrt(),
            "log" => first.ln(),
            "exp" => first.exp(),
            "abs" => first.abs(),
            other => panic!("`{other}` is not among the functions of these laws"),
        };
        self.expect(")");
        round(value)
    }
}

/// The results of a function of emitted code for known inputs, which its parts join.
fn run(code: &str, function: &str, known: &HashMap<String, f64>) -> Vec<f64> {
    let start = code.find(&format!("fn {function}(")).unwrap();
    let body = &code[start..];
    let body = &body[body.find("{\n").unwrap() + 1..body.find("\n}\n").unwrap()];
    let mut reader = Reader {
        text: body.as_bytes(),
        at: 0,
        known: known.iter().map(|(name, value)| (name.clone(), round(*value))).collect(),
    };
    while reader.take("let ") {
        reader.skip_blanks();
        let start = reader.at;
        while reader.text[reader.at] != b' ' {
            reader.at += 1;
        }
        let name = body[start..reader.at].to_owned();
        reader.expect("=");
        let value = reader.sum();
        reader.expect(";");
        reader.known.insert(name, value);
    }
    // what the results stand in: `array<…>(…)` of vectors
    let mut results = Vec::new();
    loop {
        reader.skip_blanks();
        let rest = &body[reader.at..];
        if rest.is_empty() {
            return results;
        }
        let opening =
            ["return array", "vec2<f32>(", "vec3<f32>("].into_iter().find(|word| rest.starts_with(word));
        match (opening, rest.as_bytes()[0]) {
            (Some("return array"), _) => reader.at += rest.find('(').unwrap() + 1,
            (Some(word), _) => reader.at += word.len(),
            (None, b')' | b',' | b';') => reader.at += 1,
            _ => results.push(reader.sum()),
        }
    }
}

/// Rest positions, displacements, variations by the names of emitted code.
fn inputs(kind: ElementKind, law: &EnergyLaw) -> HashMap<String, f64> {
    let mut known = HashMap::new();
    for (node, rest) in kind.element().nodes.iter().enumerate() {
        for (axis, rest) in rest.iter().enumerate() {
            let wave = |phase: f64| 0.1 * (2.0 * node as f64 + 3.0 * axis as f64 + phase).sin();
            known.insert(format!("p[{node}][{axis}]"), rest + 0.5 * wave(0.7));
            known.insert(format!("u[{node}][{axis}]"), wave(0.3));
            known.insert(format!("v[{node}][{axis}]"), wave(1.7));
        }
    }
    for (name, parameter) in &law.parameters {
        if let LawParameter::Number { value, .. } = parameter {
            known.insert(name.clone(), *value);
        }
    }
    known
}

/// Forces and differentials as the graph has them.
fn expected(derived: &Derived, known: &HashMap<String, f64>) -> [Vec<f64>; 2] {
    let place = |name: &str| {
        let letter = name.chars().next().filter(|letter| "PUV".contains(*letter));
        let axis = name.chars().last().and_then(|axis| "xyz".find(axis));
        match (letter, axis, name.get(1..name.len() - 1)) {
            (Some(letter), Some(axis), Some(node)) if node.bytes().all(|byte| byte.is_ascii_digit()) => {
                format!("{}[{node}][{axis}]", letter.to_ascii_lowercase())
            }
            _ => name.to_owned(),
        }
    };
    let numbers: HashMap<String, [f64; 1]> =
        known.iter().map(|(name, value)| (name.clone(), [*value])).collect();
    [&derived.forces, &derived.differentials].map(|fragments| {
        let values = derived
            .graph
            .evaluate(&fragments[0].raw, |symbol| &numbers[&place(symbol.name.trim_start_matches('@'))]);
        fragments[0].raw.iter().map(|expr| values.scalar(*expr)).collect()
    })
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let norm = |list: &mut dyn Iterator<Item = f64>| list.map(|x| x * x).sum::<f64>().sqrt();
    norm(&mut a.iter().zip(b).map(|(a, b)| a - b)) / norm(&mut b.iter().copied())
}

/// Constants, forces and differential of WGSL as a program would call them one after the other.
fn answers(code: &str, known: &HashMap<String, f64>) -> [Vec<f64>; 2] {
    let constants = run(code, "constants", known);
    let mut known = known.clone();
    known.extend(constants.into_iter().enumerate().map(|(index, value)| (format!("d[{index}]"), value)));
    ["forces", "force_differential"].map(|function| run(code, function, &known))
}

/// A law on an element.
struct Case {
    name: String,
    element: ElementData,
    derived: Derived,
    known: HashMap<String, f64>,
    exact: [Vec<f64>; 2],
}

/// Every law on three kinds of elements.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for law in WRITTEN_LAWS {
        for kind in [ElementKind::Tri3, ElementKind::Tet4, ElementKind::Pyramid5] {
            let compiled = EnergyLaw::compile(&law.text().unwrap()).unwrap();
            let element = element_data(kind, &kind.rules()[0], MapKind::General).unwrap();
            let derived = element.derive(&compiled, Cut::NONE);
            let known = inputs(kind, &compiled);
            let exact = expected(&derived, &known);
            cases.push(Case { name: format!("{} on {kind}", law.name), element, derived, known, exact });
        }
    }
    assert!(cases.len() >= 27);
    cases
}

/// A folder for the files of one test; it goes with the target folder.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a command to its end; what it prints.
fn output(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}{}", String::from_utf8_lossy(&output.stdout));
    String::from_utf8(output.stdout).unwrap()
}

/// What is known of the nodes, as an array of Rust.
fn array(letter: char, case: &Case) -> String {
    let axes = case.element.dimension;
    let number = |node: usize, axis: usize| format!("{:?}", case.known[&format!("{letter}[{node}][{axis}]")]);
    let of_node =
        |node| format!("[{}]", (0..axes).map(|axis| number(node, axis)).collect::<Vec<_>>().join(", "));
    format!("[{}]", (0..case.element.node_count).map(of_node).collect::<Vec<_>>().join(", "))
}

/// Material constants in the order of the function that takes them.
fn arguments(code: &str, case: &Case) -> String {
    let signature = &code[code.find("fn constants(").unwrap()..];
    let list = &signature[..signature.find(") ->").unwrap()];
    let names = list.split(", ").filter_map(|argument| argument.strip_suffix(": f64"));
    names.map(|name| format!(", {:?}", case.known[name])).collect()
}

/// A program that prints the forces and the differential of each case, by the Rust that is written for it.
fn rust_program(cases: &mut [Case]) -> String {
    let (mut modules, mut calls) = (String::new(), String::new());
    for (index, case) in cases.iter_mut().enumerate() {
        let code = case.derived.emit(ElementCode::Rust).text;
        let (p, u, v) = (array('p', case), array('u', case), array('v', case));
        let _ = writeln!(modules, "mod case{index} {{\n{code}}}");
        let _ = writeln!(calls, "    let d = case{index}::constants(&{p}{});", arguments(&code, case));
        let _ = writeln!(calls, "    print(case{index}::forces(&d, &{u}).as_flattened());");
        let _ = writeln!(calls, "    print(case{index}::force_differential(&d, &{u}, &{v}).as_flattened());");
    }
    let print = "fn print(numbers: &[f64]) { println!(\"{numbers:?}\"); }";
    format!("{modules}\nfn main() {{\n{calls}}}\n{print}\n")
}

#[test]
fn rust_computes_what_was_derived() {
    let mut cases = cases();
    let text = rust_program(&mut cases);
    let folder = folder("emitted_rust");
    let (source, program) = (folder.join("main.rs"), folder.join("main"));
    std::fs::write(&source, text).unwrap();
    // whoever pastes it does not want to be told of parentheses and unused arguments either
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let flags = ["--edition", "2024", "-D", "warnings", "-A", "dead_code", "-o"];
    output(Command::new(compiler).args(flags).arg(&program).arg(&source));
    let printed = output(&mut Command::new(&program));
    let mut lines = printed.lines();
    for case in &cases {
        for exact in &case.exact {
            let line = lines.next().unwrap().trim_matches(['[', ']']);
            let numbers: Vec<f64> = line.split(", ").map(|number| number.parse().unwrap()).collect();
            // some hundred operations in another order
            let off = distance(&numbers, exact);
            assert!(off <= 1e-12, "{}: {off:e}", case.name);
        }
    }
}

/// EXP-4: what is emitted is compiled as it is, without a cut by hand: for a triangle under Hooke's law as soon as an empty file, for a
/// box of eight points under St. Venant-Kirchhoff's, the largest that the source lists, within its ten minutes.
#[test]
fn emitted_code_is_compiled_soon() {
    let folder = folder("compiled_soon");
    let compiler = || std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let seconds = |name: &str, code: &str| {
        let source = folder.join(format!("{name}.rs"));
        std::fs::write(&source, code).unwrap();
        let clock = Instant::now();
        let flags = ["--edition", "2024", "--crate-type", "lib", "-O", "-A", "dead_code", "--out-dir"];
        output(Command::new(compiler()).args(flags).arg(&folder).arg(&source));
        clock.elapsed().as_secs_f64()
    };
    let code = |law: &str, kind: ElementKind| {
        let law = WRITTEN_LAWS.iter().find(|known| known.name == law).unwrap();
        let compiled = EnergyLaw::compile(&law.text().unwrap()).unwrap();
        let element = element_data(kind, kind.default_rule(), MapKind::General).unwrap();
        element.derive(&compiled, Cut::NONE).emit(ElementCode::Rust).text
    };
    let small = code("linear", ElementKind::Tri3);
    // the machine is shared: the soonest of three, and a second of starting the compiler
    let soonest = |name: &str, code: &str| (0..3).map(|_| seconds(name, code)).fold(f64::INFINITY, f64::min);
    let (empty, triangle) = (soonest("empty", "pub fn nothing() {}\n"), soonest("triangle", &small));
    assert!(triangle < 2.0 * empty + 1.0, "{triangle} s, an empty file {empty} s");
    let large = code("st_venant_kirchhoff", ElementKind::Hex8);
    assert!(large.len() > 20 * small.len(), "{} and {} bytes", large.len(), small.len());
    let took = seconds("box", &large);
    assert!(took < 600.0, "{took} s");
}

#[test]
fn wgsl_computes_what_was_derived() {
    for mut case in cases() {
        let code = case.derived.emit(ElementCode::Wgsl).text;
        let module = naga::front::wgsl::parse_str(&code)
            .unwrap_or_else(|error| panic!("{}: {}", case.name, error.emit_to_string(&code)));
        let (flags, capabilities) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
        naga::valid::Validator::new(flags, capabilities)
            .validate(&module)
            .unwrap_or_else(|error| panic!("{}: {}", case.name, error.emit_to_string(&code)));
        // functions of stretches are more than expressions: a compiler reads those
        if code.contains("decompose(") {
            continue;
        }
        for (single, exact) in answers(&code, &case.known).iter().zip(&case.exact) {
            // strains are differences: 6e-8 over a strain of a tenth, a hundred times
            let off = distance(single, exact);
            assert!(off <= 1e-4, "{}: {off:e}", case.name);
        }
    }
}

/// Numbers for the names of a program for Maxima: `u[2][1]` is `U2y` there.
fn assignments(known: &HashMap<String, f64>) -> String {
    let entries = known.iter().map(|(name, value)| {
        let place = name.strip_suffix(']').and_then(|name| name.split_once('['));
        let Some((letter, indices)) = place else { return format!("{}: {value:e}$\n", maxima_name(name)) };
        let (node, axis) = indices.split_once("][").unwrap();
        let axis = ["x", "y", "z"][axis.parse::<usize>().unwrap()];
        format!("{}{node}{axis}: {value:e}$\n", letter.to_uppercase())
    });
    entries.collect()
}

fn vector([x, y, z]: [f64; 3]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Forces and differentials of an element by its law at the samples, from where its nodes are.
fn by_samples(element: &ElementData, law: &EnergyLaw, known: &HashMap<String, f64>) -> [Vec<f64>; 2] {
    let dimension = element.dimension;
    let field = |letter: char, gradients: &[[f64; 3]]| {
        let mut field = Mat3::ZERO;
        for (node, gradient) in gradients.iter().enumerate() {
            for axis in 0..dimension {
                let value = known[&format!("{letter}[{node}][{axis}]")];
                field += Vec3::AXES[axis].outer(vector(*gradient)) * value;
            }
        }
        field
    };
    let entries = |matrix: &Mat3| -> Vec<f64> { matrix.columns.iter().flat_map(|c| c.to_array()).collect() };
    let mut sums = [vec![0.0; element.node_count * dimension], vec![0.0; element.node_count * dimension]];
    for sample in &element.samples {
        let mut map = field('p', &sample.gradients);
        if dimension == 2 {
            map.columns[2] = Vec3::AXES[2];
        }
        let (inverse, volume) = (map.try_inverse().unwrap(), map.determinant() * sample.weight);
        let F = field('u', &sample.gradients) * inverse + Mat3::IDENTITY;
        let dF = field('v', &sample.gradients) * inverse;
        let mut numbers: HashMap<String, Vec<f64>> =
            HashMap::from([("F".to_owned(), entries(&F)), ("dF".to_owned(), entries(&dF))]);
        for (name, parameter) in &law.parameters {
            let values = match parameter {
                LawParameter::Number { value, .. } => vec![*value],
                LawParameter::Direction(direction) => direction.to_vec(),
            };
            numbers.insert(name.clone(), values);
        }
        let roots = [law.stress, law.differential];
        let values = law.graph.evaluate(&roots, |symbol| &numbers[&symbol.name]);
        for (sums, root) in sums.iter_mut().zip(roots) {
            let H = values.matrix(root).mul_transpose(&inverse) * -volume;
            for (sums, gradient) in sums.chunks_exact_mut(dimension).zip(&sample.gradients) {
                let force = H * vector(*gradient);
                sums.iter_mut().zip(force.to_array()).for_each(|(sum, force)| *sum += force);
            }
        }
    }
    sums
}

/// The derivation of another system, from the same data, ends at the same forces and differentials: of every law, those of
/// principal stretches included, on triangles, tetrahedra and pyramids.
#[test]
fn maxima_derives_the_same() {
    let Some(program) = std::env::var_os("SOUPLE_MAXIMA") else { return };
    let folder = folder("emitted_maxima");
    for law in WRITTEN_LAWS {
        let compiled = EnergyLaw::compile(&law.text().unwrap()).unwrap();
        for kind in [ElementKind::Tri3, ElementKind::Tet4, ElementKind::Pyramid5] {
            let name = format!("{} on {kind}", law.name);
            let element = element_data(kind, &kind.rules()[0], MapKind::General).unwrap();
            let known = inputs(kind, &compiled);
            let exact = by_samples(&element, &compiled, &known);
            let axes = &["x", "y", "z"][..element.dimension];
            let of_node = |node| axes.iter().map(move |axis| format!("{node}{axis}"));
            let names: Vec<String> = (0..element.node_count).flat_map(of_node).collect();
            let mut script = maxima(&element, &compiled, "Case");
            let _ = writeln!(script, "{}numbers()$", assignments(&known));
            for letters in ["F", "dF"] {
                for name in &names {
                    let _ = writeln!(script, "print(\"number\", float(ev({letters}{name})))$");
                }
            }
            std::fs::write(folder.join("case.mac"), script).unwrap();
            let load = ["--very-quiet", "-r", "load(\"case.mac\")$ quit()$"];
            let printed = output(Command::new(&program).args(load).current_dir(&folder));
            let numbers: Vec<f64> = printed
                .lines()
                .filter_map(|line| line.trim().strip_prefix("number ")?.replace(' ', "").parse().ok())
                .collect();
            assert_eq!(numbers.len(), 2 * names.len(), "{name}: {printed}");
            // sixteen digits are printed of operations in an order of its own; its stretches are roots of a polynomial, whose
            // differences of a tenth lose three
            let allowed = if compiled.uses_stretches() { 1e-9 } else { 1e-12 };
            for (numbers, exact) in numbers.chunks(names.len()).zip(&exact) {
                let off = distance(numbers, exact);
                assert!(off <= allowed, "{name}: {off:e}");
            }
        }
    }
}
