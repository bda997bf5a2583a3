//! From the graph to instructions on values.

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

use super::Code;
use crate::graph::{Evaluation, Expr, Graph, Node, Shape, Symbol};

/// Whole powers up to this one are multiplied out; beyond, one transcendental function is cheaper and rounds less.
const MOST_MULTIPLIED: f64 = 64.0;

/// A number, or the first of several, within a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Place {
    pub value: usize,
    pub offset: u32,
}

/// An instruction before its values have registers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub code: Code,
    pub entries: u8,
    pub out: Place,
    pub operands: [Option<Place>; 5],
}

/// What the values of a tape hold.
pub(crate) struct Lowered {
    /// Numbers of each value.
    pub sizes: Vec<usize>,
    /// Steps that need `F` only, then the others.
    pub steps: [Vec<Step>; 2],
    pub constants: Vec<(Place, f64)>,
    /// Of the inputs that come first, and of those that vary at the same first ones.
    pub inputs: [Vec<Place>; 2],
    pub outputs: Vec<Place>,
    /// Where expressions are.
    pub places: HashMap<Expr, Place>,
}

/// What a tape is made of.
pub(crate) struct Request<'a> {
    pub graph: &'a Graph,
    /// Symbols that vary from lane to lane: those that come first, and those that vary at the same first ones.
    pub inputs: [&'a [Expr]; 2],
    /// Symbols that stand for expressions; later ones may use earlier ones.
    pub definitions: &'a [(Expr, Expr)],
    pub outputs: &'a [Expr],
}

struct Lowering<'a> {
    graph: &'a Graph,
    /// Values of what does not vary.
    uniform: Evaluation,
    varies: Vec<bool>,
    needs_variation: Vec<bool>,
    uses: HashMap<Expr, usize>,
    reachable: HashSet<Expr>,
    places: HashMap<Expr, Place>,
    numbers: HashMap<u64, Place>,
    /// Products of two numbers at hand.
    multiplied: HashMap<(Place, Place), Place>,
    /// Per value: which list of steps it comes from; the first where it comes from none.
    part_of: Vec<usize>,
    out: Lowered,
    /// Which list of steps is written to.
    part: usize,
}

/// `numbers` gives those of symbols that are no inputs.
pub(crate) fn lower<'n>(request: &Request, numbers: impl Fn(&Symbol) -> &'n [f64]) -> Lowered {
    let Request { graph, inputs, definitions, outputs } = *request;
    let roots: Vec<Expr> = definitions.iter().map(|(_, of)| *of).chain(outputs.iter().copied()).collect();
    let variables: Vec<Expr> = inputs
        .iter()
        .copied()
        .flatten()
        .copied()
        .chain(definitions.iter().map(|(symbol, _)| *symbol))
        .collect();
    let varies = graph.depends(&roots, &variables);
    let reachable = graph.reachable(&roots);
    let fixed: Vec<Expr> = reachable.iter().copied().filter(|expr| !varies[expr.index()]).collect();
    let mut uses: HashMap<Expr, usize> = HashMap::new();
    for operand in reachable.iter().flat_map(|expr| graph.node(*expr).operands()).chain(roots.iter().copied())
    {
        *uses.entry(operand).or_insert(0) += 1;
    }
    // a symbol that stands for what needs the variation needs it too
    let mut varied = inputs[1].to_vec();
    for (symbol, definition) in definitions {
        if graph.depends(&[*definition], &varied)[definition.index()] {
            varied.push(*symbol);
        }
    }
    let mut lowering = Lowering {
        graph,
        uniform: graph.evaluate(&fixed, numbers),
        needs_variation: graph.depends(&roots, &varied),
        varies,
        uses,
        reachable: reachable.into_iter().collect(),
        places: HashMap::new(),
        numbers: HashMap::new(),
        multiplied: HashMap::new(),
        part_of: Vec::new(),
        out: Lowered {
            sizes: Vec::new(),
            steps: [Vec::new(), Vec::new()],
            constants: Vec::new(),
            inputs: [Vec::new(), Vec::new()],
            outputs: Vec::new(),
            places: HashMap::new(),
        },
        part: 0,
    };
    for (part, inputs) in inputs.into_iter().enumerate() {
        for input in inputs {
            lowering.part = part;
            let place = lowering.new_value(graph.shape(*input).size());
            lowering.places.insert(*input, place);
            lowering.out.inputs[part].push(place);
        }
    }
    lowering.part = 0;
    for (symbol, definition) in definitions {
        let place = lowering.place(*definition);
        lowering.places.insert(*symbol, place);
    }
    for output in outputs {
        let place = lowering.place(*output);
        lowering.out.outputs.push(place);
    }
    Lowered { places: lowering.places, ..lowering.out }
}

impl Lowering<'_> {
    fn new_value(&mut self, size: usize) -> Place {
        self.out.sizes.push(size);
        self.part_of.push(self.part);
        Place { value: self.out.sizes.len() - 1, offset: 0 }
    }

    fn number(&mut self, value: f64) -> Place {
        if let Some(place) = self.numbers.get(&value.to_bits()) {
            return *place;
        }
        let place = self.new_value(1);
        self.part_of[place.value] = 0;
        self.out.constants.push((place, value));
        self.numbers.insert(value.to_bits(), place);
        place
    }

    /// The number of an expression that does not vary.
    fn fixed_number(&self, expr: Expr) -> Option<f64> {
        (!self.varies[expr.index()] && self.graph.shape(expr) == Shape::Scalar)
            .then(|| self.uniform.scalar(expr))
    }

    fn emit(&mut self, code: Code, entries: usize, size: usize, operands: &[Place]) -> Place {
        let out = self.new_value(size);
        self.emit_to(code, entries, out, operands);
        out
    }

    fn emit_to(&mut self, code: Code, entries: usize, out: Place, operands: &[Place]) {
        let mut all = [None; 5];
        for (slot, operand) in all.iter_mut().zip(operands) {
            *slot = Some(*operand);
        }
        let step = Step { code, entries: entries as u8, out, operands: all };
        self.out.steps[self.part].push(step);
    }

    /// Where the numbers of an expression are, computed if they are not yet.
    fn place(&mut self, expr: Expr) -> Place {
        if let Some(place) = self.places.get(&expr) {
            return *place;
        }
        let place = if self.varies[expr.index()] {
            let outer = self.part;
            self.part = usize::from(self.needs_variation[expr.index()]);
            let place = self.compute(expr);
            self.part = outer;
            place
        } else if let Some(value) = self.fixed_number(expr) {
            self.number(value)
        } else {
            let numbers = self.uniform.of(expr).to_vec();
            let place = self.new_value(numbers.len());
            self.part_of[place.value] = 0;
            for (offset, value) in numbers.into_iter().enumerate() {
                self.out.constants.push((Place { offset: offset as u32, ..place }, value));
            }
            place
        };
        self.places.insert(expr, place);
        place
    }

    fn compute(&mut self, expr: Expr) -> Place {
        let len = self.graph.shape(expr).size();
        match self.graph.node(expr).clone() {
            Node::Number(_) | Node::Symbol(_) | Node::Zero(_) | Node::Identity => {
                unreachable!("symbols have their places, and the others do not vary")
            }
            Node::Sum(terms) if len == 1 => self.sum(&terms),
            Node::Sum(terms) => self.tensor_sum(&terms, len),
            Node::Product(_) => {
                let (a, b, divides) = self.product(expr);
                if divides { self.emit(Code::Divide, 1, 1, &[a, b]) } else { self.multiply_two(a, b) }
            }
            Node::Power(base, exponent) => self.power(base, exponent),
            Node::Function(function, a) => {
                let a = self.place(a);
                self.emit(Code::Call(function), 1, 1, &[a])
            }
            Node::Compare(comparison, a, b) => self.emit_of(Code::Compare(comparison), 1, 1, &[a, b]),
            Node::Select(a, b, c) => self.emit_of(Code::Select, 1, 1, &[a, b, c]),
            Node::Scale(factor, tensor) => self.emit_of(Code::Scale, len, len, &[factor, tensor]),
            Node::Multiply(a, b) => self.multiply(a, b),
            Node::Apply(matrix, vector) => match *self.graph.node(matrix) {
                Node::Transpose(inner) => self.emit_of(Code::TransposeApply, 3, 3, &[inner, vector]),
                _ => self.emit_of(Code::Apply, 3, 3, &[matrix, vector]),
            },
            Node::Transpose(a) => self.emit_of(Code::Transpose, 9, 9, &[a]),
            Node::Dot(a, b) => match self.product_of_transpose(a, b) {
                // A:B is the trace of Aᵀ B, where that is wanted anyway
                Some(product) => self.emit_of(Code::Trace, 9, 1, &[product]),
                None => self.emit_of(Code::Dot, self.graph.shape(a).size(), 1, &[a, b]),
            },
            Node::Trace(a) => self.emit_of(Code::Trace, 9, 1, &[a]),
            Node::Determinant(a) => {
                // the first columns of A and cof A give the determinant, where the cofactor is wanted anyway
                let cofactor =
                    self.reachable.iter().copied().find(|expr| *self.graph.node(*expr) == Node::Cofactor(a));
                match cofactor {
                    Some(cofactor) => self.emit_of(Code::Dot, 3, 1, &[a, cofactor]),
                    None => self.emit_of(Code::Determinant, 9, 1, &[a]),
                }
            }
            Node::Cofactor(a) => self.emit_of(Code::Cofactor, 9, 9, &[a]),
            Node::Cross(a, b) => self.emit_of(Code::Cross, 9, 9, &[a, b]),
            Node::Outer(a, b) => self.emit_of(Code::Outer, 9, 9, &[a, b]),
            Node::Entry(tensor, index) => {
                let place = self.place(tensor);
                Place { offset: place.offset + u32::from(index), ..place }
            }
            Node::Pack(entries) => {
                let places: Vec<Place> = entries.iter().map(|entry| self.place(*entry)).collect();
                let out = self.new_value(len);
                for (offset, place) in places.into_iter().enumerate() {
                    self.emit_to(Code::Copy, 1, Place { offset: offset as u32, ..out }, &[place]);
                }
                out
            }
            Node::Decompose(a) => self.emit_of(Code::Decompose, 21, 21, &[a]),
            Node::Compose(d, g) => self.emit_of(Code::Compose, 9, 9, &[d, g]),
            Node::StretchRates(d, a) => self.emit_of(Code::StretchRates, 3, 3, &[d, a]),
            Node::ComposeDifferential(list) => self.emit_of(Code::ComposeDifferential, 9, 9, &list[..]),
        }
    }

    fn emit_of(&mut self, code: Code, entries: usize, size: usize, operands: &[Expr]) -> Place {
        let places: Vec<Place> = operands.iter().map(|operand| self.place(*operand)).collect();
        self.emit(code, entries, size, &places)
    }

    fn multiply(&mut self, a: Expr, b: Expr) -> Place {
        match (self.graph.node(a).clone(), self.graph.node(b).clone()) {
            (Node::Transpose(inner), _) if inner == b => self.emit_of(Code::Gram, 9, 9, &[b]),
            (Node::Transpose(inner), _) => match self.transposed(inner, b) {
                Some(place) => self.emit(Code::Transpose, 9, 9, &[place]),
                None => self.emit_of(Code::TransposeProduct, 9, 9, &[inner, b]),
            },
            (_, Node::Transpose(inner)) => self.emit_of(Code::ProductTranspose, 9, 9, &[a, inner]),
            _ => self.emit_of(Code::Product, 9, 9, &[a, b]),
        }
    }

    /// `Aᵀ B` or `Bᵀ A`, if it is among what is computed.
    fn product_of_transpose(&self, a: Expr, b: Expr) -> Option<Expr> {
        if self.graph.shape(a) != Shape::Matrix {
            return None;
        }
        let of_transpose = |expr: Expr| match *self.graph.node(expr) {
            Node::Multiply(left, right) => match *self.graph.node(left) {
                Node::Transpose(inner) => Some((inner, right)),
                _ => None,
            },
            _ => None,
        };
        // of several the same one every time, whatever order sets have
        let wanted = |expr: &Expr| of_transpose(*expr).is_some_and(|pair| pair == (a, b) || pair == (b, a));
        self.reachable.iter().copied().filter(wanted).min_by_key(|expr| expr.index())
    }

    /// Where `Bᵀ A` is, of which `Aᵀ B` is the transpose, if it is computed already.
    fn transposed(&self, a: Expr, b: Expr) -> Option<Place> {
        let is_transposed = |expr: &Expr| match *self.graph.node(*expr) {
            Node::Multiply(left, right) => right == a && *self.graph.node(left) == Node::Transpose(b),
            _ => false,
        };
        let found = self.reachable.iter().copied().find(is_transposed)?;
        self.places.get(&found).copied()
    }

    /// The two operands of the last operation of a product, and whether it divides.
    fn product(&mut self, expr: Expr) -> (Place, Place, bool) {
        let Node::Product(factors) = self.graph.node(expr).clone() else { unreachable!("a product") };
        let mut constant = 1.0;
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for factor in factors {
            if let Some(value) = self.fixed_number(factor) {
                constant *= value;
                continue;
            }
            match *self.graph.node(factor) {
                // a quotient costs one division, a power of -1 and a product both
                Node::Power(base, exponent) if self.fixed_number(exponent) == Some(-1.0) => {
                    below.push(self.place(base));
                }
                _ => above.push(self.place(factor)),
            }
        }
        // moduli of one unit leave a single factor, and a product has two
        if constant != 1.0 || above.is_empty() || above.len() + below.len() < 2 {
            above.insert(0, self.number(constant));
        }
        // what varies last is multiplied last
        above.sort_by_key(|factor| self.part_of[factor.value]);
        let is_late = |factor: &Place| self.part_of[factor.value] > 0;
        let late = above.iter().position(is_late).unwrap_or(above.len());
        if self.part > 0 && late < above.len() && !below.is_empty() && !below.iter().any(is_late) {
            // one division for all variations
            let varying = above.split_off(late);
            let quotient = self.in_first_part(|lowering| {
                let first =
                    if above.is_empty() { lowering.number(1.0) } else { lowering.multiply_all(&above) };
                let below = lowering.multiply_all(&below);
                lowering.emit(Code::Divide, 1, 1, &[first, below])
            });
            return (quotient, self.multiply_all(&varying), false);
        }
        if below.is_empty() {
            let last = above.pop().unwrap_or_else(|| unreachable!("a product has two factors"));
            let first = self.multiply_all(&above);
            return (first, last, false);
        }
        (self.multiply_all(&above), self.multiply_all(&below), true)
    }

    /// What is emitted to the steps that need no variation.
    fn in_first_part(&mut self, emit: impl FnOnce(&mut Self) -> Place) -> Place {
        let outer = std::mem::replace(&mut self.part, 0);
        let place = emit(self);
        self.part = outer;
        place
    }

    /// The product of factors of which those that vary last stand last.
    fn multiply_all(&mut self, factors: &[Place]) -> Place {
        let mut product = factors[0];
        for factor in &factors[1..] {
            product = self.multiply_two(product, *factor);
        }
        product
    }

    fn multiply_two(&mut self, a: Place, b: Place) -> Place {
        let key = if (a.value, a.offset) <= (b.value, b.offset) { (a, b) } else { (b, a) };
        if let Some(known) = self.multiplied.get(&key) {
            return *known;
        }
        let multiply = |lowering: &mut Self| lowering.emit(Code::Multiply, 1, 1, &[a, b]);
        let needs_no_variation = self.part_of[a.value] == 0 && self.part_of[b.value] == 0;
        let place = if needs_no_variation { self.in_first_part(multiply) } else { multiply(self) };
        self.multiplied.insert(key, place);
        place
    }

    fn sum(&mut self, terms: &[Expr]) -> Place {
        let mut constant = 0.0;
        let mut sum: Option<Place> = None;
        let mut fused = Vec::new();
        for term in terms {
            if let Some(value) = self.fixed_number(*term) {
                constant += value;
                continue;
            }
            let alone = self.uses.get(term) == Some(&1) && !self.places.contains_key(term);
            if alone
                && matches!(self.graph.node(*term), Node::Product(_))
                && usize::from(self.needs_variation[term.index()]) == self.part
            {
                match self.product(*term) {
                    (a, b, false) => fused.push((a, b)),
                    (a, b, true) => {
                        let quotient = self.emit(Code::Divide, 1, 1, &[a, b]);
                        sum = Some(self.plus(sum, quotient));
                    }
                }
            } else {
                let place = self.place(*term);
                sum = Some(self.plus(sum, place));
            }
        }
        if constant != 0.0 {
            let constant = self.number(constant);
            sum = Some(self.plus(sum, constant));
        }
        for (a, b) in fused {
            sum = Some(match sum {
                Some(sum) => self.emit(Code::MultiplyAdd, 1, 1, &[a, b, sum]),
                None => self.emit(Code::Multiply, 1, 1, &[a, b]),
            });
        }
        sum.unwrap_or_else(|| unreachable!("a sum that varies has a term that does"))
    }

    fn plus(&mut self, sum: Option<Place>, term: Place) -> Place {
        match sum {
            Some(sum) => self.emit(Code::Add, 1, 1, &[sum, term]),
            None => term,
        }
    }

    fn tensor_sum(&mut self, terms: &[Expr], len: usize) -> Place {
        let identity = |expr: Expr| *self.graph.node(expr) == Node::Identity;
        let (mut scaled, mut plain, mut diagonal) = (Vec::new(), Vec::new(), Vec::new());
        for term in terms {
            match *self.graph.node(*term) {
                Node::Identity => diagonal.push(None),
                Node::Scale(factor, tensor) if identity(tensor) => diagonal.push(Some(factor)),
                Node::Scale(factor, tensor)
                    if self.varies[term.index()]
                        && self.uses.get(term) == Some(&1)
                        && usize::from(self.needs_variation[term.index()]) == self.part
                        && !self.places.contains_key(term) =>
                {
                    scaled.push((factor, tensor));
                }
                _ => plain.push(*term),
            }
        }
        let mut sum: Option<Place> = None;
        for term in plain {
            let place = self.place(term);
            sum = Some(match sum {
                Some(sum) => self.emit(Code::Add, len, len, &[sum, place]),
                None => place,
            });
        }
        let mut scaled: Vec<(Place, Place)> =
            scaled.into_iter().map(|(factor, tensor)| (self.place(factor), self.place(tensor))).collect();
        if sum.is_none() && scaled.len() >= 2 {
            let ((s, a), (t, b)) = (scaled.remove(0), scaled.remove(0));
            sum = Some(self.emit(Code::Combine, len, len, &[s, a, t, b]));
        }
        for (factor, tensor) in scaled {
            sum = Some(match sum {
                Some(sum) => self.emit(Code::ScaleAdd, len, len, &[factor, tensor, sum]),
                None => self.emit(Code::Scale, len, len, &[factor, tensor]),
            });
        }
        for factor in diagonal {
            let factor = match factor {
                Some(factor) => self.place(factor),
                None => self.number(1.0),
            };
            let before = match sum {
                Some(sum) => sum,
                None => unreachable!("multiples of the identity are one term"),
            };
            sum = Some(self.emit(Code::PlusDiagonal, 9, 9, &[before, factor]));
        }
        sum.unwrap_or_else(|| unreachable!("a sum has terms"))
    }

    fn power(&mut self, base: Expr, exponent: Expr) -> Place {
        let Some(value) = self.fixed_number(exponent) else {
            return self.emit_of(Code::Power, 1, 1, &[base, exponent]);
        };
        let at = self.place(base);
        if value.fract() == 0.0 && value.abs() <= MOST_MULTIPLIED {
            let power = self.whole_power(at, value.abs() as u8);
            return if value < 0.0 { self.reciprocal(power) } else { power };
        }
        // (b^e)ⁿ of a power that is wanted anyway costs no transcendental function of its own
        if let Some((root, times)) = self.root_of(base, value) {
            let root = self.place(root);
            return self.whole_power(root, times);
        }
        // powers of one base that differ by whole exponents cost one transcendental function: that of the exponent nearest to
        // zero, and from there away from it, so that zero to the power of a half is not zero over zero
        match self.nearest_to_zero(base, value) {
            Some((nearest, start)) => {
                let start = self.place(start);
                let power = self.whole_power(at, (value - nearest).abs().round() as u8);
                let code = if value < 0.0 { Code::Divide } else { Code::Multiply };
                self.emit(code, 1, 1, &[start, power])
            }
            None => self.transcendental_power(at, value),
        }
    }

    /// A power of `base` among what is computed whose exponent is a small whole part of `value`, and which part: the least exponent.
    fn root_of(&self, base: Expr, value: f64) -> Option<(Expr, u8)> {
        let part = |expr: &Expr| match *self.graph.node(*expr) {
            Node::Power(other, exponent) if other == base => {
                let exponent = self.graph.value(exponent).filter(|exponent| exponent.fract() != 0.0)?;
                let times = value / exponent;
                let is_whole = (times - times.round()).abs() <= f64::EPSILON * times.abs();
                (is_whole && (2.0..=4.0).contains(&times.round())).then_some((*expr, times.round() as u8))
            }
            _ => None,
        };
        // of several the same one every time, whatever order sets have
        self.reachable.iter().filter_map(part).max_by_key(|(root, times)| (*times, Reverse(*root)))
    }

    /// Of the powers of `base` among what is computed whose exponents differ from `value` by a small whole number and have its sign, the
    /// one nearest to zero, where it is nearer than `value`.
    fn nearest_to_zero(&self, base: Expr, value: f64) -> Option<(f64, Expr)> {
        let of_base = |expr: &Expr| match *self.graph.node(*expr) {
            Node::Power(other, exponent) if other == base => Some((self.graph.value(exponent)?, *expr)),
            _ => None,
        };
        let is_near = |(exponent, _): &(f64, Expr)| {
            let further = value - exponent;
            // thirds are rounded: `-4/3 - -7/3` is not quite one
            let is_whole = (further - further.round()).abs() <= 2.0 * f64::EPSILON * value.abs();
            let times = further.round();
            is_whole && (1.0..=4.0).contains(&times.abs()) && times * value > 0.0 && exponent / value > 0.0
        };
        let near = self.reachable.iter().filter_map(of_base).filter(is_near);
        near.min_by(|(a, first), (b, second)| a.abs().total_cmp(&b.abs()).then(first.cmp(second)))
    }

    fn transcendental_power(&mut self, at: Place, value: f64) -> Place {
        if value.abs() == 0.5 {
            let root = self.emit(Code::SquareRoot, 1, 1, &[at]);
            return if value < 0.0 { self.reciprocal(root) } else { root };
        }
        let exponent = self.number(value);
        // not whole: of a base below zero there is none
        self.emit(
            if value.fract() == 0.0 { Code::Power } else { Code::PowerOfPositive },
            1,
            1,
            &[at, exponent],
        )
    }

    fn whole_power(&mut self, base: Place, exponent: u8) -> Place {
        match exponent {
            1 => base,
            2 => self.emit(Code::Multiply, 1, 1, &[base, base]),
            _ => self.emit(Code::WholePower(exponent), 1, 1, &[base]),
        }
    }

    fn reciprocal(&mut self, place: Place) -> Place {
        let one = self.number(1.0);
        self.emit(Code::Divide, 1, 1, &[one, place])
    }
}
