//! Formulas against answers by hand, rates against differences, absurd input against its limits.

use souple_formal::{Condition, Expression, FUNCTIONS, Formula, ParseError};
use souple_math::Dual;

fn number(text: &str) -> f64 {
    let formula = Formula::compile(text, &[]).unwrap_or_else(|error| panic!("{text}: {error}"));
    formula.evaluate(&[])
}

/// Precedence and grouping as in mathematics; powers group to the right and bind tighter than a sign.
#[test]
fn grouping() {
    let cases = [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("10 - 3 - 2", 5.0),
        ("24 / 4 / 2", 3.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-2 ^ 2", -4.0),
        ("(-2) ^ 2", 4.0),
        ("2 ^ -1", 0.5),
        ("2 ^ -1 ^ 2", 0.5),
        ("2 * -3", -6.0),
        ("- - 3", 3.0),
        ("+3 - +2", 1.0),
        (".5 + 2. + 1e-1 + 1E+1", 12.6),
        ("if(1 < 2 and not 3 < 2, 10, 20)", 10.0),
        ("if(1 > 2 or 2 >= 2 and 1 == 1, 10, 20)", 10.0),
        ("if(not (1 != 1) , 1, 0)", 1.0),
    ];
    for (text, expected) in cases {
        assert_eq!(number(text), expected, "{text}");
    }
}

/// Each function at a point where its value is known.
#[test]
fn functions_by_hand() {
    // libm is right to one unit in the last place, and so is the argument
    let near = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * b.abs().max(1.0);
    let cases = [
        ("sin(pi / 6)", 0.5),
        ("cos(pi / 3)", 0.5),
        ("tan(pi / 4)", 1.0),
        ("asin(1)", std::f64::consts::FRAC_PI_2),
        ("acos(-1)", std::f64::consts::PI),
        ("4 * atan(1)", std::f64::consts::PI),
        ("atan2(1, -1)", 0.75 * std::f64::consts::PI),
        ("sinh(ln(2))", 0.75),
        ("cosh(ln(2))", 1.25),
        ("tanh(ln(2))", 0.6),
        ("exp(1)", std::f64::consts::E),
        ("ln(e ^ 2.5)", 2.5),
        ("log(e ^ 2.5)", 2.5),
        ("log10(1000)", 3.0),
        ("sqrt(2) ^ 2", 2.0),
        ("cbrt(-27)", -3.0),
        ("abs(-3)", 3.0),
        ("sign(-3) + sign(0) + 10 * sign(5)", 9.0),
        ("min(3, 1, 2) + 10 * max(3, 1, 4, 2)", 41.0),
        ("floor(-1.5) + 10 * ceil(1.5)", 18.0),
        ("pow(2, 0.5) - sqrt(2)", 0.0),
        ("step(1, 0.5) + 10 * step(1, 1)", 10.0),
        ("smoothstep(2, 4, 2.5)", 0.15625),
        ("smoothstep(2, 2, 1) + 10 * smoothstep(2, 2, 2)", 10.0),
        ("clamp(5, 0, 1) + 10 * clamp(-5, 0, 1) + 100 * clamp(0.5, 0, 1)", 51.0),
        ("hypot(3, 4)", 5.0),
        ("2^10 + 2^-2 + (-3)^3 + 0^0", 1024.0 + 0.25 - 27.0 + 1.0),
        ("2^17 + 4^0.5", 131074.0),
    ];
    for (text, expected) in cases {
        assert!(near(number(text), expected), "{text} = {}, not {expected}", number(text));
    }
    for entry in FUNCTIONS.iter().filter(|entry| entry.name != "if") {
        assert!(cases.iter().any(|(text, _)| text.contains(&format!("{}(", entry.name))), "{}", entry.name);
    }
}

/// Where a function is not defined the result is not a number, and no function hides that.
#[test]
fn not_a_number_stays_visible() {
    for text in
        ["sqrt(-1)", "min(sqrt(-1), 1)", "max(1, 0/0)", "clamp(0/0, 0, 1)", "step(1, 0/0)", "sign(0/0)"]
    {
        assert!(number(text).is_nan(), "{text}");
    }
    assert_eq!(number("clamp(0, 2, 1)"), 1.0);
    assert!(!Condition::compile("x < 1 or x >= 1", &["x"]).unwrap().holds(&[f64::NAN]));
}

/// `if` chooses value and rate of one side, whatever the other side does there.
#[test]
fn choice_ignores_the_other_side() {
    let formula = Formula::compile("if(x > 0, 1 / x, 7 * x)", &["x"]).unwrap();
    assert_eq!(formula.evaluate(&[0.0]), 0.0);
    assert_eq!(formula.evaluate_dual(&[Dual::new(0.0, 1.0)]), Dual::new(0.0, 7.0));
    assert_eq!(formula.evaluate_dual(&[Dual::new(2.0, 1.0)]), Dual::new(0.5, -0.25));
}

/// Rates of dual evaluation equal central differences, for every function and operator.
#[test]
fn rates_equal_differences() {
    let texts = [
        "sin(x)",
        "cos(x)",
        "tan(x)",
        "asin(x)",
        "acos(x)",
        "atan(x)",
        "atan2(x, y)",
        "atan2(y, x)",
        "sinh(x)",
        "cosh(x)",
        "tanh(x)",
        "exp(x)",
        "ln(x)",
        "log(x)",
        "log10(x)",
        "sqrt(x)",
        "cbrt(x)",
        "abs(x - 1)",
        "sign(x)",
        "min(x, y, 3)",
        "max(x, y, -3)",
        "floor(x)",
        "ceil(x)",
        "pow(x, y)",
        "pow(y, x)",
        "x^3",
        "x^-2",
        "x^0",
        "x^17",
        "step(0.1, x)",
        "smoothstep(0, 2, x)",
        "smoothstep(x, 2, y)",
        "clamp(x, 0, 1)",
        "hypot(x, y)",
        "(x + y) * x - y / x + -x",
        "if(x < y, x^2, x^3)",
    ];
    let h = 1e-5;
    for text in texts {
        let formula = Formula::compile(text, &["x", "y"]).unwrap();
        for (x, y) in [(0.3, 0.7), (0.62, 1.9)] {
            // along (1, 0.5)
            let at = |s: f64| formula.evaluate(&[x + s, y + 0.5 * s]);
            let difference = (at(h) - at(-h)) / (2.0 * h);
            let dual = formula.evaluate_dual(&[Dual::new(x, 1.0), Dual::new(y, 0.5)]);
            assert_eq!(dual.value.to_bits(), formula.evaluate(&[x, y]).to_bits(), "{text}");
            // truncation h²/6 f''', largest for x^-2 with 24/0.3⁵ < 10⁴, and rounding ε |f| / h
            let tolerance = 1e4 / 6.0 * h * h + 4.0 * f64::EPSILON * (1.0 + dual.value.abs()) / h;
            assert!((dual.derivative - difference).abs() <= tolerance, "{text}: {dual:?}, {difference}");
        }
    }
    for entry in FUNCTIONS {
        assert!(texts.iter().any(|text| text.contains(&format!("{}(", entry.name))), "{}", entry.name);
    }
}

/// Points without a slope have the rate that is documented, and what stands still has none.
#[test]
fn rates_where_there_is_no_slope() {
    let rate = |text: &str, x: f64| {
        Formula::compile(text, &["x"]).unwrap().evaluate_dual(&[Dual::new(x, 1.0)]).derivative
    };
    assert_eq!(rate("abs(x)", 0.0), 0.0);
    assert_eq!(rate("hypot(x, 0)", 0.0), 0.0);
    assert_eq!(rate("sqrt(0 * x)", 1.0), 0.0);
    assert_eq!(rate("x ^ 2.5", 0.0), 0.0);
    // x^y ln x tends to 0 with x
    assert_eq!(rate("0 ^ (1 + x)", 1.0), 0.0);
    // x^0 is 1 everywhere
    let still = Formula::compile("x ^ y", &["x", "y"]).unwrap();
    assert_eq!(still.evaluate_dual(&[Dual::new(0.0, 1.0), Dual::constant(0.0)]), Dual::new(1.0, 0.0));
    assert_eq!(rate("(x - 3) ^ 2", 1.0), -4.0);
    assert_eq!(rate("smoothstep(2, 2, x)", 2.0), 0.0);
}

/// Values come in the order of the variables, used or not; a variable hides a constant of its name.
#[test]
fn variables() {
    let formula = Formula::compile("x - e * t", &["t", "unused", "x", "e"]).unwrap();
    assert_eq!(formula.evaluate(&[2.0, f64::NAN, 10.0, 3.0]), 4.0);
    assert!(formula.depends_on(0) && !formula.depends_on(1));
    assert_eq!(formula.to_string(), "x - e * t");
    // a name of a function may name a variable too: a call has its parenthesis
    assert_eq!(Formula::compile("step * step(0, 1)", &["step"]).unwrap().evaluate(&[5.0]), 5.0);
}

/// A vector is as many formulas under one text; the rate by a variable goes along.
#[test]
fn vectors() {
    let formulas: [Formula; 3] = Formula::compile_vector("[0, t^2, min(t, 1)]", &["t"]).unwrap();
    assert_eq!(formulas.each_ref().map(|formula| formula.evaluate(&[3.0])), [0.0, 9.0, 1.0]);
    assert_eq!(
        formulas.each_ref().map(|formula| formula.differentiate(&[3.0], 0).derivative),
        [0.0, 6.0, 0.0]
    );
    assert_eq!(formulas[2].text(), "min(t, 1)");
}

/// A region by a condition.
#[test]
fn conditions() {
    let region = Condition::compile("x < 0.1 and hypot(y, z) <= 0.02", &["x", "y", "z"]).unwrap();
    assert!(region.holds(&[0.0, 0.012, 0.016]));
    assert!(!region.holds(&[0.0, 0.02, 0.02]));
    assert!(!region.holds(&[0.1, 0.0, 0.0]));
}

/// A text that is no formula of this kind is told at the character.
#[test]
fn faults_point_at_the_character() {
    let cases = [
        ("1 + sim(x)", "sim"),
        ("1 + speeed", "speeed"),
        ("2 x", "x"),
        ("2e + 1", "e"),
        ("1 < x < 3", "<"),
        ("1 + (x > 0)", "x > 0"),
        ("if(x, 1, 2)", "x"),
        ("1 + [x, 1, 1]", "[x, 1, 1]"),
        ("1 + 2e400", "2e400"),
        ("1 + µ", "µ"),
    ];
    for (text, fault) in cases {
        let error = Formula::compile(text, &["x", "speed"]).expect_err(text);
        assert_eq!(error.span().of(text), fault, "{text}: {error}");
    }
}

/// Absurd input ends in a typed error within limits that are stated, and does not exhaust the stack.
#[test]
fn absurd_formulas_are_refused() {
    let error = |text: &str| Formula::compile(text, &["x"]).unwrap_err();
    assert!(matches!(error(&"(".repeat(10_000_000)), ParseError::TooLong { length: 10_000_000, .. }));
    for piece in ["(", "[", "-", "not ", "sin(", "2^", "1+(", "min(1,2,", "if(1<2,1,"] {
        let text = piece.repeat(1_000_000 / piece.len());
        assert!(matches!(error(&text), ParseError::TooDeep { .. }), "{piece}");
    }
    // what the parser lets through, the evaluator's stack holds
    for (piece, expected) in [("if(x>0,x,", 2.0), ("min(x,", 2.0), ("x-(", 0.0), ("clamp(0,0,", 0.0)] {
        let deepest = (0..2000).rev().find_map(|depth| {
            Formula::compile(&format!("{}x{}", piece.repeat(depth), ")".repeat(depth)), &["x"]).ok()
        });
        let value = deepest.unwrap().evaluate(&[2.0]);
        assert!(value == expected || value == 2.0, "{piece}: {value}");
    }
}

/// A sum of hundreds of thousands of terms is a deep tree, and yet read, printed, evaluated and dropped.
#[test]
fn long_sums_need_no_stack() {
    let terms = 400_000;
    let text = format!("x{}", "+x".repeat(terms - 1));
    assert_eq!(Formula::compile(&text, &["x"]).unwrap().evaluate(&[1.0]), terms as f64);
    let expression = Expression::parse(&text).unwrap();
    assert_eq!(expression.subtree(expression.root()).count(), 2 * terms - 1);
    assert_eq!(expression.to_string().len(), 4 * (terms - 1) + 1);

    let list = format!("max(0{})", ",x".repeat(10_000));
    assert_eq!(Formula::compile(&list, &["x"]).unwrap().evaluate(&[3.0]), 3.0);
}
