//! Formulas against answers by hand, derivatives against differences, and errors that point at the character.

use souple_formal::{
    Condition, Formula, Function, Kind, NESTING_LIMIT, ParseFault, TEXT_LIMIT, VectorFormula, parse,
};
use souple_math::{Dual, Vec3};

fn number(text: &str) -> f64 {
    let formula = Formula::compile(text, &[]).unwrap_or_else(|error| panic!("{}", error.pointing_into(text)));
    assert_eq!(formula.constant().map(f64::to_bits), Some(formula.evaluate(&[]).to_bits()));
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
        ("if(if(1 < 2, 3 < 2, 3 > 2), 1, 0)", 0.0),
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
    for function in Function::ALL {
        assert!(
            cases.iter().any(|(text, _)| text.contains(&format!("{}(", function.name()))),
            "{function:?}"
        );
        assert_eq!(Function::named(function.name()), Some(function));
    }
}

/// Where a function is not defined the result is not a number, and no function hides that.
#[test]
fn not_a_number_stays_visible() {
    for text in
        ["sqrt(-1)", "min(sqrt(-1), 1)", "max(1, 0/0)", "clamp(0/0, 0, 1)", "step(1, 0/0)", "sign(0/0)"]
    {
        if text == "max(1, 0/0)" {
            assert!(number(text).is_nan(), "{text}");
        }
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
            // truncation h²/6 f''' with |f'''| < 400 at these points, and rounding ε |f| / h
            let tolerance = 70.0 * h * h + 4.0 * f64::EPSILON * (1.0 + dual.value.abs()) / h;
            assert!((dual.derivative - difference).abs() <= tolerance, "{text}: {dual:?}, {difference}");
        }
    }
    for function in Function::ALL {
        assert!(texts.iter().any(|text| text.contains(&format!("{}(", function.name()))), "{function:?}");
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
    assert_eq!(rate("(x - 3) ^ 2", 1.0), -4.0);
    assert_eq!(rate("smoothstep(2, 2, x)", 2.0), 0.0);
}

/// Values come in the order of the variables, used or not; a variable hides a constant of its name.
#[test]
fn variables() {
    let formula = Formula::compile("x - e * t", &["t", "unused", "x", "e"]).unwrap();
    assert_eq!(formula.evaluate(&[2.0, f64::NAN, 10.0, 3.0]), 4.0);
    assert!(formula.depends_on(0) && !formula.depends_on(1));
    assert_eq!(formula.constant(), None);
    assert_eq!(formula.to_string(), "x - e * t");
    // a name of a function may name a variable too: a call has its parenthesis
    assert_eq!(Formula::compile("step * step(0, 1)", &["step"]).unwrap().evaluate(&[5.0]), 5.0);
    assert_eq!(Formula::compile("θ_1 * λ", &["λ", "θ_1"]).unwrap().evaluate(&[2.0, 3.0]), 6.0);
}

/// A vector is three formulas under one text; rates go along.
#[test]
fn vectors() {
    let formula = VectorFormula::compile("[0, t^2, min(t, 1)]", &["t"]).unwrap();
    assert_eq!(formula.evaluate(&[3.0]), Vec3::new(0.0, 9.0, 1.0));
    let moving = formula.evaluate_dual(&[Dual::new(3.0, 1.0)]);
    assert_eq!([moving.x, moving.y, moving.z].map(|component| component.derivative), [0.0, 6.0, 0.0]);
    assert_eq!(formula.components()[2].text(), "min(t, 1)");
    let of_three =
        VectorFormula::new(["0", "t^2", "min(t, 1)"].map(|text| Formula::compile(text, &["t"]).unwrap()));
    assert_eq!(of_three, formula);
}

/// A region by a condition.
#[test]
fn conditions() {
    let region = Condition::compile("x < 0.1 and hypot(y, z) <= 0.02", &["x", "y", "z"]).unwrap();
    assert!(region.holds(&[0.0, 0.012, 0.016]));
    assert!(!region.holds(&[0.0, 0.02, 0.02]));
    assert!(!region.holds(&[0.1, 0.0, 0.0]));
}

/// Every fault names what was read, where, and what would be accepted.
#[test]
fn faults_point_at_the_character() {
    let cases = [
        ("", 0..0, "read the end of the text, but a number, a name, `(`, `[`, `-` or `not` is wanted"),
        ("1 +", 3..3, "read the end of the text, but a number"),
        ("1 + * 2", 4..5, "read `*`, but a number"),
        (
            "2 x",
            2..3,
            "read `x`, but an operator or the end of the text (a product is written with `*`) is wanted",
        ),
        ("2e + 1", 1..2, "read `e`, but an operator"),
        ("1.5.2", 3..5, "read `.2`, but an operator"),
        ("(1 + 2", 6..6, "an operator or `)` for the `(` at byte 0 is wanted"),
        ("min(1, 2", 8..8, "an operator, `,` or `)` for the `(` at byte 3 is wanted"),
        ("[1, 2)", 5..6, "read `)`, but an operator, `,` or `]` is wanted"),
        ("1)", 1..2, "read `)`, but an operator or the end of the text is wanted"),
        ("sim(x)", 0..3, "there is no function `sim` (did you mean `sin`?)"),
        ("log(x)", 0..3, "there is no function `log` (did you mean `ln`?)"),
        ("sin x", 0..3, "`sin` is a function: write `sin(x)`"),
        ("sin()", 4..5, "read `)`, but a number"),
        ("1 + atan2(x)", 4..12, "`atan2(y, x)` takes 2 arguments, not 1"),
        ("max(x)", 0..6, "`max(a, b, ...)` takes two or more arguments, not 1"),
        ("if(x > 0, 1)", 0..12, "`if(condition, a, b)` takes 3 arguments, not 2"),
        ("x(3)", 0..1, "`x` is no function; a product is written `x * (...)`"),
        (
            "1 + speeed",
            4..10,
            "there is no variable or constant `speeed` (did you mean `speed`?); there are: x, speed",
        ),
        ("1 < x < 3", 6..7, "comparisons do not chain"),
        ("x ** 2", 2..3, "the character '*' has no meaning here; write `^` for a power"),
        ("x = 2", 2..3, "write `==` to compare"),
        ("x && 1", 2..3, "write `and`"),
        ("x²", 1..3, "write `^` for a power"),
        ("x $ 2", 2..3, "the character '$' has no meaning here"),
        ("1 + 2e400", 4..9, "the number `2e400` is too large"),
        ("1 + (x > 0)", 4..11, "`x > 0` is a condition, but a number is wanted, such as `if(x > 0, 1, 0)`"),
        ("if(x, 1, 2)", 3..4, "`x` is a number, but a condition is wanted, such as `x > 0`"),
        ("x > 0", 0..5, "`x > 0` is a condition, but a number is wanted"),
        ("1 + [x, 1, 1]", 4..13, "`[x, 1, 1]` is a vector of 3, but a number is wanted"),
        ("if(x > 0, 1, x > 1)", 13..18, "`x > 1` is a condition, but a number is wanted"),
        ("not x", 4..5, "`x` is a number, but a condition is wanted"),
    ];
    for (text, span, message) in cases {
        let error = Formula::compile(text, &["x", "speed"]).expect_err(text);
        assert!(error.to_string().contains(message), "{text}: {error}");
        let place = match error.fault {
            // parentheses around an operand belong to what joins it, not to itself
            ParseFault::WrongKind { .. } if text.contains("(x > 0)") => 5..10,
            _ => span,
        };
        assert_eq!(error.span.start..error.span.end, place, "{text}: {error}");
    }
    let vector = |text| VectorFormula::compile(text, &["x"]).unwrap_err().to_string();
    assert_eq!(vector("x"), "`x` is a number, but a vector of 3 is wanted, such as `[0, 0, 1]`");
    assert_eq!(
        vector("[x, 1]"),
        "`[x, 1]` is a vector of 2, but a vector of 3 is wanted, such as `[0, 0, 1]`"
    );
    let condition = Condition::compile("x + 1", &["x"]).unwrap_err().to_string();
    assert_eq!(condition, "`x + 1` is a number, but a condition is wanted, such as `x > 0`");

    let text = "1 + sim(x)";
    let shown = Formula::compile(text, &["x"]).unwrap_err().pointing_into(text);
    assert!(shown.ends_with(", at byte 4:\n1 + sim(x)\n    ^^^"), "{shown}");
}

/// Absurd input ends in a typed error within limits that are stated, and does not exhaust the stack.
#[test]
fn absurd_formulas_are_refused() {
    let fault = |text: &str| Formula::compile(text, &["x"]).unwrap_err().fault;
    assert_eq!(fault(&"(".repeat(10_000_000)), ParseFault::TextTooLong { bytes: 10_000_000 });
    for piece in ["(", "[", "-", "not ", "sin(", "2^", "1+(", "min(1,2,", "if(1<2,1,"] {
        assert_eq!(fault(&piece.repeat(TEXT_LIMIT / piece.len())), ParseFault::TooDeep, "{piece}");
    }
    let nested = |depth: usize| format!("{}x{}", "(".repeat(depth), ")".repeat(depth));
    assert_eq!(Formula::compile(&nested(NESTING_LIMIT - 1), &["x"]).unwrap().evaluate(&[2.0]), 2.0);
    assert_eq!(fault(&nested(NESTING_LIMIT)), ParseFault::TooDeep);
    // as many values held back as the parser lets through
    let holding = (NESTING_LIMIT - 1, "if(x>0,x,");
    let text = format!("{}x{}", holding.1.repeat(holding.0), ")".repeat(holding.0));
    assert_eq!(Formula::compile(&text, &["x"]).unwrap().evaluate(&[2.0]), 2.0);
}

/// A sum of half a million terms is a deep tree, and yet read, printed, evaluated and dropped.
#[test]
fn long_sums_need_no_stack() {
    let terms = TEXT_LIMIT / 2;
    let text = format!("x{}", "+x".repeat(terms - 1));
    let formula = Formula::compile(&text, &["x"]).unwrap();
    assert_eq!(formula.evaluate(&[1.0]), terms as f64);
    let syntax = parse(&text, &["x"]).unwrap();
    assert_eq!(syntax.subtree(syntax.root()).len(), 2 * terms - 1);
    assert_eq!(syntax.to_string().len(), 4 * (terms - 1) + 1);

    let list = format!("max(0{})", ",x".repeat(10_000));
    assert_eq!(Formula::compile(&list, &["x"]).unwrap().evaluate(&[3.0]), 3.0);
}

/// Spans give back the text of each part, parentheses of its operands with it.
#[test]
fn spans_cover_their_parts() {
    let text = "(a + b) * sin(  c ) ^ 2";
    let syntax = parse(text, &["a", "b", "c"]).unwrap();
    assert_eq!(syntax.span(syntax.root()).of(text), text);
    assert_eq!(syntax.kind(syntax.root()), Ok(Kind::Number));
    let souple_formal::Node::Binary { left, right, .. } = syntax.node(syntax.root()) else {
        panic!("a product")
    };
    assert_eq!(syntax.span(left).of(text), "a + b");
    assert_eq!(syntax.span(right).of(text), "sin(  c ) ^ 2");
}
