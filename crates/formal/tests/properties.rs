//! Properties of the parser and the evaluator over random trees and random texts.

use proptest::prelude::*;
use souple_formal::{
    BinaryOperator, Condition, Constant, Formula, Function, Syntax, SyntaxBuilder, VectorFormula, parse,
};
use souple_math::Dual;

const VARIABLES: [&str; 3] = ["x", "y_1", "λ"];

/// A tree as it is easily made at random.
#[derive(Clone, Debug)]
enum Tree {
    Number(f64),
    Constant(Constant),
    Variable(u32),
    Negate(Box<Tree>),
    Not(Box<Tree>),
    Binary(BinaryOperator, Box<Tree>, Box<Tree>),
    Select(Box<[Tree; 3]>),
    Call(Function, Vec<Tree>),
    Vector(Vec<Tree>),
}

impl Tree {
    fn build(&self, builder: &mut SyntaxBuilder) {
        let build_all = |trees: &[Tree], builder: &mut SyntaxBuilder| {
            trees.iter().for_each(|tree| tree.build(builder));
        };
        match self {
            Self::Number(value) => builder.number(*value),
            Self::Constant(constant) => builder.constant(*constant),
            Self::Variable(index) => builder.variable(*index),
            Self::Negate(operand) => {
                operand.build(builder);
                builder.negate()
            }
            Self::Not(operand) => {
                operand.build(builder);
                builder.not()
            }
            Self::Binary(operator, left, right) => {
                left.build(builder);
                right.build(builder);
                builder.binary(*operator)
            }
            Self::Select(operands) => {
                build_all(&operands[..], builder);
                builder.select()
            }
            Self::Call(function, arguments) => {
                build_all(arguments, builder);
                builder.call(*function, arguments.len())
            }
            Self::Vector(components) => {
                build_all(components, builder);
                builder.vector(components.len())
            }
        };
    }

    fn syntax(&self) -> Syntax {
        let mut builder = SyntaxBuilder::new(&VARIABLES);
        self.build(&mut builder);
        builder.finish()
    }
}

/// Trees of any kinds mixed: printing and reading know no kinds.
fn any_tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        prop::num::f64::NORMAL.prop_map(Tree::Number),
        (-100i32..100).prop_map(|number| Tree::Number(f64::from(number) / 8.0)),
        prop::sample::select(Constant::ALL.to_vec()).prop_map(Tree::Constant),
        (0u32..3).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(7, 60, 4, |inner| {
        let boxed = inner.clone().prop_map(Box::new);
        let operators = prop::sample::select(BinaryOperator::ALL.to_vec());
        let functions = prop::sample::select(Function::ALL.to_vec());
        prop_oneof![
            boxed.clone().prop_map(Tree::Negate),
            boxed.clone().prop_map(Tree::Not),
            (operators, boxed.clone(), boxed)
                .prop_map(|(operator, left, right)| Tree::Binary(operator, left, right)),
            prop::array::uniform3(inner.clone()).prop_map(|operands| Tree::Select(Box::new(operands))),
            (functions, prop::collection::vec(inner.clone(), 4)).prop_map(|(function, mut arguments)| {
                while !function.accepts(arguments.len()) {
                    arguments.pop();
                }
                Tree::Call(function, arguments)
            }),
            prop::collection::vec(inner, 1..4).prop_map(Tree::Vector),
        ]
    })
}

/// Trees that yield a number.
fn number_tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (-16i32..17).prop_map(|number| Tree::Number(f64::from(number) / 4.0)),
        (0u32..3).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(6, 40, 3, |inner| {
        let boxed = inner.clone().prop_map(Box::new);
        let arithmetic = prop::sample::select(BinaryOperator::ALL[8..].to_vec());
        let comparison = prop::sample::select(BinaryOperator::ALL[2..8].to_vec());
        let functions = prop::sample::select(Function::ALL.to_vec());
        prop_oneof![
            boxed.clone().prop_map(Tree::Negate),
            (arithmetic, boxed.clone(), boxed.clone())
                .prop_map(|(operator, a, b)| Tree::Binary(operator, a, b)),
            (comparison, boxed.clone(), boxed.clone(), inner.clone(), inner.clone()).prop_map(
                |(operator, a, b, if_true, if_false)| {
                    Tree::Select(Box::new([Tree::Binary(operator, a, b), if_true, if_false]))
                }
            ),
            (functions, prop::collection::vec(inner, 4)).prop_map(|(function, mut arguments)| {
                while !function.accepts(arguments.len()) {
                    arguments.pop();
                }
                Tree::Call(function, arguments)
            }),
        ]
    })
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// A printed tree reads back as the same tree.
    #[test]
    fn printing_and_reading_are_inverse(tree in any_tree()) {
        let syntax = tree.syntax();
        let text = syntax.to_string();
        let again = parse(&text, &VARIABLES).map_err(|error| TestCaseError::fail(error.pointing_into(&text)))?;
        prop_assert_eq!(&again, &syntax, "{}", text);
        // and each subtree lies where its span says
        for (at, node) in again.nodes().iter().enumerate() {
            prop_assert!(at > 0 || matches!(node,
                souple_formal::Node::Number(_) | souple_formal::Node::Constant(_) | souple_formal::Node::Variable(_)));
        }
    }

    /// Text and tree compile to the same program; the value of a dual is the plain value, to the bit; the same
    /// formula with its variables written in as numbers is computed at compile time to the same bits.
    #[test]
    fn all_evaluations_agree(tree in number_tree(), values in prop::array::uniform3(-12i32..13)) {
        let values = values.map(|value| f64::from(value) / 4.0);
        let syntax = tree.syntax();
        let from_tree = Formula::from_syntax(&syntax).unwrap();
        let from_text = Formula::compile(&syntax.to_string(), &VARIABLES).unwrap();
        prop_assert_eq!(&from_tree, &from_text);
        let plain = from_tree.evaluate(&values);
        let dual = from_tree.evaluate_dual(&values.map(|value| Dual::new(value, 1.0)));
        prop_assert!(same(plain, dual.value), "{}: {} and {:?}", syntax, plain, dual);
        let still = from_tree.evaluate_dual(&values.map(Dual::constant));
        prop_assert!(same(plain, still.value));
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
                "1", ".5", "1e", "e", "pi", "x", "y_1", "λ", "+", "-", "*", "/", "^", "<", "<=", "==", "!=", "!", "(",
                ")", "[", "]", ",", " and ", " or ", " not ", "if(", "sin(", "min(", "clamp(", "sin", " ", "²", "\u{0}",
                "\n",
            ]),
            0..40,
        )
    ) {
        check_total(&pieces.concat())?;
    }
}

fn check_total(text: &str) -> Result<(), TestCaseError> {
    let errors = [
        Formula::compile(text, &VARIABLES).map(|formula| drop(formula.evaluate(&[1.0, 2.0, 3.0]))).err(),
        Condition::compile(text, &VARIABLES).map(|condition| drop(condition.holds(&[1.0, 2.0, 3.0]))).err(),
        VectorFormula::compile(text, &VARIABLES).map(|vector| drop(vector.evaluate(&[1.0, 2.0, 3.0]))).err(),
    ];
    for error in errors.into_iter().flatten() {
        prop_assert!(text.get(error.span.start..error.span.end).is_some(), "{text:?}: {error:?}");
        prop_assert!(error.pointing_into(text).contains('^'));
    }
    Ok(())
}
