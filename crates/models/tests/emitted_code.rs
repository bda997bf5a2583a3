//! Emitted code does what the expressions say: Rust in double precision, WGSL in single, read and run by a reader of the few
//! forms that are emitted. Both are written from the same expressions (FAU-30).

use std::collections::HashMap;

use souple_formal::element::{Cut, Derived};
use souple_formal::emit::ElementCode;
use souple_formal::law::EnergyLaw;
use souple_mesh::ElementKind;
use souple_models::derive::{MapKind, element_data};
use souple_models::materials::WRITTEN_LAWS;

/// Numbers of a precision.
trait Precision: Copy {
    /// The nearest number of that precision.
    fn round(value: f64) -> f64;
}

#[derive(Clone, Copy)]
struct Double;
#[derive(Clone, Copy)]
struct Single;

impl Precision for Double {
    fn round(value: f64) -> f64 {
        value
    }
}

impl Precision for Single {
    fn round(value: f64) -> f64 {
        f64::from(value as f32)
    }
}

/// Runs the body of one function: `let` lines, then the results between the last brackets.
struct Reader<'a, P> {
    text: &'a [u8],
    at: usize,
    known: HashMap<String, f64>,
    precision: std::marker::PhantomData<P>,
}

impl<P: Precision> Reader<'_, P> {
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
                sum = P::round(sum + self.product());
            } else if self.take("-") {
                sum = P::round(sum - self.product());
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut product = self.factor();
        loop {
            if self.take("*") {
                product = P::round(product * self.factor());
            } else if self.take("/") {
                product = P::round(product / self.factor());
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
            let value = if self.take("if ") { self.branches() } else { self.sum() };
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
                b'_' | b'.' | b':' => {}
                _ if letter.is_ascii_alphanumeric() || is_sign => {}
                _ => break,
            }
            self.at += 1;
        }
        let word = std::str::from_utf8(&self.text[start..self.at]).unwrap().to_owned();
        if let Ok(number) = word.parse::<f64>() {
            return P::round(number);
        }
        if self.take("(") {
            return self.call(word.trim_start_matches("f64::"));
        }
        *self.known.get(&word).unwrap_or_else(|| panic!("`{word}` is not known"))
    }

    /// Rust: `a < b { value } else { otherwise }`.
    fn branches(&mut self) -> f64 {
        let holds = self.comparison();
        self.expect("{");
        let value = self.sum();
        self.expect("}");
        self.expect("else");
        self.expect("{");
        let otherwise = self.sum();
        self.expect("}");
        if holds { value } else { otherwise }
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
            "pow" | "powf" => {
                self.expect(",");
                first.powf(self.sum())
            }
            "sqrt" => first.sqrt(),
            "log" | "ln" => first.ln(),
            "exp" => first.exp(),
            "abs" => first.abs(),
            other => panic!("`{other}` is not among the functions of these laws"),
        };
        self.expect(")");
        P::round(value)
    }
}

/// The results of a function of emitted code for known inputs, which its parts join.
fn run<P: Precision>(code: &str, function: &str, known: &HashMap<String, f64>) -> Vec<f64> {
    let start = code.find(&format!("fn {function}(")).unwrap();
    let body = &code[start..];
    let body = &body[body.find("{\n").unwrap() + 1..body.find("\n}\n").unwrap()];
    let mut reader = Reader::<P> {
        text: body.as_bytes(),
        at: 0,
        known: known.iter().map(|(name, value)| (name.clone(), P::round(*value))).collect(),
        precision: std::marker::PhantomData,
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
    // what the results stand in: arrays of vectors, `[` and `]` in Rust, `array<…>(…)` in WGSL
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
            (None, b'[' | b']' | b')' | b',' | b';') => reader.at += 1,
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
        if let souple_formal::law::LawParameter::Number { value, .. } = parameter {
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

/// Constants, forces and differential as a program would call them one after the other.
fn answers<P: Precision>(code: &str, known: &HashMap<String, f64>) -> [Vec<f64>; 2] {
    let constants = run::<P>(code, "constants", known);
    let mut known = known.clone();
    known.extend(constants.into_iter().enumerate().map(|(index, value)| (format!("d[{index}]"), value)));
    ["forces", "force_differential"].map(|function| run::<P>(code, function, &known))
}

#[test]
fn emitted_code_computes_what_was_derived() {
    for law in WRITTEN_LAWS {
        let compiled = EnergyLaw::compile(&law.text().unwrap()).unwrap();
        for kind in [ElementKind::Tri3, ElementKind::Tet4, ElementKind::Pyramid5] {
            let element = element_data(kind, &kind.rules()[0], MapKind::General).unwrap();
            // laws of principal stretches have no formula of displacements
            let Ok(mut derived) = element.derive(&compiled, Cut::NONE) else { continue };
            let known = inputs(kind, &compiled);
            let exact = expected(&derived, &known);
            let rust = answers::<Double>(&derived.emit(ElementCode::Rust).text, &known);
            let wgsl = answers::<Single>(&derived.emit(ElementCode::Wgsl).text, &known);
            for ((exact, rust), wgsl) in exact.iter().zip(&rust).zip(&wgsl) {
                let name = format!("{} on {kind}", law.name);
                // some hundred operations in another order
                assert!(distance(rust, exact) <= 1e-12, "{name}: {:e}", distance(rust, exact));
                // and in single precision, where strains are differences: 6e-8 over a strain of a tenth, a hundred times
                assert!(distance(wgsl, exact) <= 1e-4, "{name} in WGSL: {:e}", distance(wgsl, exact));
            }
        }
    }
}
