//! Properties of the parser and the evaluator over random formulas and random texts.

use proptest::prelude::*;
use souple_formal::{Condition, Expression, FUNCTIONS, Formula, FunctionEntry};
use souple_math::Dual;

const VARIABLES: [&str; 3] = ["x", "y_1", "z"];
const ARITHMETIC: [&str; 5] = ["+", "-", "*", "/", "^"];
const COMPARISONS: [&str; 6] = ["<", "<=", ">", ">=", "==", "!="];

fn call(entry: &FunctionEntry, mut arguments: Vec<String>) -> String {
    while !entry.arguments.accepts(arguments.len()) {
        arguments.pop();
    }
    format!("{}({})", entry.name, arguments.join(","))
}

/// Formulas of any kinds mixed, most operands in parentheses: syntax knows no kinds.
fn any_formula() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        prop::num::f64::NORMAL.prop_map(|number| format!("{:e}", number.abs())),
        (0i32..100).prop_map(|number| (f64::from(number) / 8.0).to_string()),
        prop::sample::select(vec!["pi", "e", "x", "y_1", "z"]).prop_map(str::to_owned),
    ];
    leaf.prop_recursive(7, 60, 4, |inner| {
        let operators = [&ARITHMETIC[..], &COMPARISONS, &["and", "or"]].concat();
        let functions = prop::sample::select(FUNCTIONS.iter().collect::<Vec<_>>());
        prop_oneof![
            inner.clone().prop_map(|operand| format!("-({operand})")),
            inner.clone().prop_map(|operand| format!("not ({operand})")),
            (prop::sample::select(operators), inner.clone(), inner.clone())
                .prop_map(|(operator, left, right)| format!("({left}) {operator} ({right})")),
            (prop::sample::select(ARITHMETIC.to_vec()), inner.clone(), inner.clone())
                .prop_map(|(operator, left, right)| format!("-({left}) {operator} -({right})")),
            (functions, prop::collection::vec(inner.clone(), 4)).prop_map(|(entry, list)| call(entry, list)),
            prop::collection::vec(inner, 1..4).prop_map(|list| format!("[{}]", list.join(","))),
        ]
    })
}

/// Formulas that yield a number.
fn number_formula() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        (0i32..17).prop_map(|number| (f64::from(number) / 4.0).to_string()),
        prop::sample::select(VARIABLES.to_vec()).prop_map(str::to_owned),
    ];
    leaf.prop_recursive(6, 40, 3, |inner| {
        let functions = FUNCTIONS.iter().filter(|entry| entry.name != "if").collect::<Vec<_>>();
        prop_oneof![
            inner.clone().prop_map(|operand| format!("-({operand})")),
            (prop::sample::select(ARITHMETIC.to_vec()), inner.clone(), inner.clone())
                .prop_map(|(operator, left, right)| format!("({left}) {operator} ({right})")),
            (prop::sample::select(COMPARISONS.to_vec()), prop::array::uniform4(inner.clone()))
                .prop_map(|(operator, [a, b, c, d])| format!("if(({a}) {operator} ({b}), {c}, {d})")),
            (prop::sample::select(functions), prop::collection::vec(inner, 4))
                .prop_map(|(entry, list)| call(entry, list)),
        ]
    })
}

/// Formulas of operations that are exactly rounded, each as text and as a function of its own making.
#[derive(Clone, Debug)]
enum Tree {
    Number(f64),
    Variable(usize),
    Negate(Box<Tree>),
    Square(Box<Tree>),
    Arithmetic(char, Box<[Tree; 2]>),
    One(&'static str, Box<Tree>),
    Extreme(&'static str, Vec<Tree>),
    Clamp(Box<[Tree; 3]>),
    Choice(&'static str, Box<[Tree; 4]>),
}

impl Tree {
    /// With no parentheses but those that mathematics asks for: how strongly it binds is its second part.
    fn text(&self) -> (String, u8) {
        let at_least = |tree: &Tree, strength: u8| match tree.text() {
            (text, own) if own >= strength => text,
            (text, _) => format!("({text})"),
        };
        let plain = |tree: &Tree| tree.text().0;
        match self {
            Self::Number(number) => (number.to_string(), 9),
            Self::Variable(index) => (VARIABLES[*index].to_owned(), 9),
            Self::Negate(operand) => (format!("-{}", at_least(operand, 3)), 3),
            Self::Square(operand) => (format!("{}^2", at_least(operand, 9)), 4),
            Self::Arithmetic(operator @ ('+' | '-'), operands) => {
                (format!("{}{operator}{}", at_least(&operands[0], 1), at_least(&operands[1], 2)), 1)
            }
            Self::Arithmetic(operator, operands) => {
                (format!("{}{operator}{}", at_least(&operands[0], 2), at_least(&operands[1], 3)), 2)
            }
            Self::One(name, operand) => (format!("{name}({})", plain(operand)), 9),
            Self::Extreme(name, list) => {
                (format!("{name}({})", list.iter().map(plain).collect::<Vec<_>>().join(",")), 9)
            }
            Self::Clamp(list) => {
                (format!("clamp({},{},{})", plain(&list[0]), plain(&list[1]), plain(&list[2])), 9)
            }
            Self::Choice(comparison, list) => {
                let [a, b, if_true, if_false] = list.each_ref().map(plain);
                (format!("if({a} {comparison} {b},{if_true},{if_false})"), 9)
            }
        }
    }

    fn value(&self, variables: &[f64; 3]) -> f64 {
        let of = |tree: &Tree| tree.value(variables);
        let extreme = |a: f64, b: f64, first: bool| if a.is_nan() || first { a } else { b };
        let (least, greatest) = (|a, b| extreme(a, b, a < b), |a, b| extreme(a, b, a > b));
        match self {
            Self::Number(number) => *number,
            Self::Variable(index) => variables[*index],
            Self::Negate(operand) => -of(operand),
            Self::Square(operand) => of(operand) * of(operand),
            Self::Arithmetic(operator, operands) => {
                let (a, b) = (of(&operands[0]), of(&operands[1]));
                match operator {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    _ => a / b,
                }
            }
            Self::One(name, operand) => match *name {
                "abs" => of(operand).abs(),
                "sqrt" => of(operand).sqrt(),
                "floor" => of(operand).floor(),
                _ => of(operand).ceil(),
            },
            Self::Extreme("min", list) => list.iter().map(of).reduce(least).unwrap(),
            Self::Extreme(_, list) => list.iter().map(of).reduce(greatest).unwrap(),
            Self::Clamp(list) => least(greatest(of(&list[0]), of(&list[1])), of(&list[2])),
            Self::Choice(comparison, list) => {
                let [a, b, if_true, if_false] = list.each_ref().map(of);
                let holds = match *comparison {
                    "<" => a < b,
                    "<=" => a <= b,
                    ">" => a > b,
                    ">=" => a >= b,
                    "==" => a == b,
                    _ => a != b,
                };
                if holds { if_true } else { if_false }
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0i32..17).prop_map(|number| Tree::Number(f64::from(number) / 4.0)),
        (0usize..3).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(6, 40, 4, |inner| {
        let boxed = inner.clone().prop_map(Box::new);
        let pair = prop::array::uniform2(inner.clone()).prop_map(Box::new);
        let operators = prop::sample::select(vec!['+', '-', '*', '/']);
        prop_oneof![
            1 => boxed.clone().prop_map(Tree::Negate),
            1 => boxed.clone().prop_map(Tree::Square),
            4 => (operators, pair).prop_map(|(operator, operands)| Tree::Arithmetic(operator, operands)),
            1 => (prop::sample::select(vec!["abs", "sqrt", "floor", "ceil"]), boxed)
                .prop_map(|(name, operand)| Tree::One(name, operand)),
            1 => (prop::sample::select(vec!["min", "max"]), prop::collection::vec(inner.clone(), 2..5))
                .prop_map(|(name, list)| Tree::Extreme(name, list)),
            1 => prop::array::uniform3(inner.clone()).prop_map(|list| Tree::Clamp(Box::new(list))),
            1 => (prop::sample::select(COMPARISONS.to_vec()), prop::array::uniform4(inner))
                .prop_map(|(comparison, list)| Tree::Choice(comparison, Box::new(list))),
        ]
    })
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// The formula, or the failure of a case that names text and error.
fn compiled(text: &str, variables: &[&str]) -> Result<Formula, TestCaseError> {
    Formula::compile(text, variables).map_err(|error| TestCaseError::fail(format!("{text}: {error}")))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    /// A printed formula reads back as the same tree.
    #[test]
    fn printing_and_reading_are_inverse(text in any_formula()) {
        let expression = Expression::parse(&text).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let printed = expression.to_string();
        let again = Expression::parse(&printed).map_err(|error| TestCaseError::fail(format!("{printed}: {error}")))?;
        prop_assert_eq!(&again, &expression, "{}", printed);
    }

    /// A printed formula computes the same bits, and so does the value of a dual number.
    #[test]
    fn all_evaluations_agree(text in number_formula(), values in prop::array::uniform3(-12i32..13)) {
        let values = values.map(|value| f64::from(value) / 4.0);
        let formula = Formula::compile(&text, &VARIABLES).unwrap();
        let plain = formula.evaluate(&values);
        let printed = Expression::parse(&text).unwrap().to_string();
        prop_assert!(same(Formula::compile(&printed, &VARIABLES).unwrap().evaluate(&values), plain), "{}", printed);
        let dual = formula.evaluate_dual(&values.map(|value| Dual::new(value, 1.0)));
        prop_assert!(same(plain, dual.value), "{}: {} and {:?}", printed, plain, dual);
    }

    /// Where every operation is exactly rounded, the compiled program has the bits of a walk over the tree that
    /// the text was written from: grouping, order of operands, choices and constant parts are right.
    #[test]
    fn an_independent_evaluator_agrees(tree in tree(), values in prop::array::uniform3(-12i32..13)) {
        let values = values.map(|value| f64::from(value) / 4.0);
        let (text, _) = tree.text();
        let formula = compiled(&text, &VARIABLES)?;
        prop_assert!(same(formula.evaluate(&values), tree.value(&values)), "{}", text);
        // the same with the variables' values written in: all is computed when compiled
        let [x, y, z] = values.map(|value| format!("({value})"));
        let written = text.replace("y_1", &y).replace('z', &z);
        let written = written.replace("max", "MAX").replace('x', &x).replace("MAX", "max");
        let known = compiled(&written, &[])?;
        prop_assert!(same(known.evaluate(&[]), tree.value(&values)), "{}", written);
    }

    /// Whatever the text, the answer is a formula or an error whose span lies in the text.
    #[test]
    fn any_text_is_answered(text in ".{0,60}") {
        check_total(&text)?;
    }

    /// The same for bytes that are repaired into text.
    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
        check_total(&String::from_utf8_lossy(&bytes))?;
    }

    /// The same for texts made of the language's own pieces.
    #[test]
    fn any_mixture_is_answered(
        pieces in prop::collection::vec(
            prop::sample::select(vec![
                "1", ".5", "1e", "e", "pi", "x", "y_1", "z", "+", "-", "*", "/", "^", "<", "<=", "==", "!=", "!", "(",
                ")", "[", "]", ",", " and ", " or ", " not ", "if(", "sin(", "min(", "clamp(", "sin", " ", "²",
                "\u{0}", "\n",
            ]),
            0..40,
        )
    ) {
        check_total(&pieces.concat())?;
    }
}

fn check_total(text: &str) -> Result<(), TestCaseError> {
    let errors = [
        Formula::compile(text, &VARIABLES).map(|formula| formula.evaluate(&[1.0, 2.0, 3.0])).err(),
        Condition::compile(text, &VARIABLES).map(|condition| condition.holds(&[1.0, 2.0, 3.0])).err(),
        Formula::compile_vector::<3>(text, &VARIABLES).map(drop).err(),
    ];
    for error in errors.into_iter().flatten() {
        let span = error.span();
        prop_assert!(text.get(span.start..span.end).is_some(), "{text:?}: {error:?}");
        prop_assert!(span.underline(text).contains('^'));
    }
    Ok(())
}
