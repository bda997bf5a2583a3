//! Laws against closed forms, derivatives against differences, and what bad laws are told.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3, exponential};

use super::*;
use crate::Span;

const PRESSURE: Option<Dimension> = Some(Dimension::new(1, -1, -2));

fn number(name: &str, value: f64, dimension: Option<Dimension>) -> (String, LawParameter) {
    (name.to_owned(), LawParameter::Number { value, dimension })
}

/// A law with moduli `mu`, `lambda` … in pascals.
fn text(energy: &str, moduli: &[(&str, f64)]) -> LawText {
    let parameters = moduli.iter().map(|(name, value)| number(name, *value, PRESSURE)).collect();
    LawText { energy: energy.to_owned(), definitions: Vec::new(), parameters }
}

fn law(energy: &str, moduli: &[(&str, f64)]) -> EnergyLaw {
    EnergyLaw::compile(&text(energy, moduli)).unwrap_or_else(|error| panic!("{}", error.explained(energy)))
}

fn samples() -> Vec<Mat3> {
    let base =
        Mat3::from_columns(Vec3::new(1.2, 0.1, -0.2), Vec3::new(-0.15, 0.9, 0.3), Vec3::new(0.05, -0.1, 1.1));
    vec![base, exponential(Vec3::new(0.7, -0.4, 1.0)) * base, Mat3::identity(1.0) * 1.1, Mat3::identity(1.0)]
}

/// Laws of every kind of term, with the same moduli.
fn laws() -> Vec<EnergyLaw> {
    let moduli = [("mu", 3.0), ("lambda", 5.0), ("c1", 0.4)];
    let mut all: Vec<EnergyLaw> = [
        "mu*dot(eps, eps) + lambda/2*tr(eps)^2",
        "mu*dot(E, E) + lambda/2*tr(E)^2 + 0*c1",
        "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2",
        "mu/2*(I1_bar - 3) + c1*(I2_bar - 3) + lambda/2*(J - 1)^2",
        "mu/2*(I1_bar - 3) + c1*(I1_bar - 3)^2 + lambda/2*(J - 1)^2",
        "mu*(l1^2.5 + l2^2.5 + l3^2.5 - 3) - 2.5*mu*ln(J) + lambda/2*(J - 1)^2",
        "mu*(exp(dot(E, E)) - 1) + lambda*tr(inv(C) - I)^2 + c1*dot(dev(E), dev(E)) + c1*det(E)",
        "mu*(F11^2 + F21^2 + F31^2 + F12^2 + F22^2 + F32^2 + F13^2 + F23^2 + F33^2 - 3)/2 - mu*ln(J) + lambda*(C11 + C22 - 2)^2",
    ]
    .iter()
    .map(|energy| law(energy, &moduli))
    .collect();
    let mut fibres =
        text("mu/2*(I1 - 3) - mu*ln(J) + lambda*max(I4(a) - 1, 0)^3 + c1*(I5(a) - I4(a))^2", &moduli);
    fibres.parameters.push(("a".into(), LawParameter::Direction([0.6, 0.8, 0.0])));
    all.push(EnergyLaw::compile(&fibres).unwrap());
    all
}

/// The table of conversions of the source: what a text writes with differences, quotients and powers is a commutative
/// expression, the same in whatever order it was written. Equal ones cancel as they are read, node for node.
#[test]
fn texts_convert_to_commutative_expressions() {
    let difference = |first: &str, second: &str| {
        let [first, second] =
            [first, second].map(|text| text.replace('a', "F11").replace('b', "F12").replace('c', "F13"));
        let read = super::read::read(&text(&format!("mu*(({first}) - ({second}))"), &[("mu", 2.0)]));
        let read = read.unwrap_or_else(|error| panic!("{error:?}"));
        read.graph.value(read.energy)
    };
    for (written, converted) in [
        ("a - (b + c)", "-(b + c) + a"),
        ("(a + b)/(a - b)", "(-b + a)^(-1)*(b + a)"),
        ("2*(a + b)^2", "(b + a)^2*2"),
        ("(a - b*(b + a)^2)/(a + b)^2", "(a + b)^(-2)*(-((a + b)^2*b) + a)"),
    ] {
        assert_eq!(difference(written, converted), Some(0.0), "{written} and {converted}");
    }
    assert_eq!(difference("a - (b + c)", "a - (b - c)"), None);
}

/// `P = ∂Ψ/∂F` and `δP = ∂P/∂F : δF` against central differences, also with equal stretches.
#[test]
fn derivatives_are_differences() {
    let dF =
        Mat3::from_columns(Vec3::new(0.3, -0.2, 0.5), Vec3::new(0.1, 0.7, -0.4), Vec3::new(-0.6, 0.2, 0.1));
    let h = 1e-5;
    for law in laws() {
        for F in samples() {
            let (plus, minus) = (F + dF * h, F - dF * h);
            let slope = (law.energy_at(&plus) - law.energy_at(&minus)) / (2.0 * h);
            let power = law.stress_at(&F).dot(&dF);
            // h² of third derivatives of order ten, and 1e-16 Ψ/h
            assert!((slope - power).abs() < 1e-8, "{slope} {power}");
            let numeric = (law.stress_at(&plus) - law.stress_at(&minus)) * (0.5 / h);
            let difference = (numeric - law.differential_at(&F, &dF)).largest_entry();
            // a fibre that just begins to bear has a third derivative that jumps by 100 there
            let tolerance =
                if law.parameter("a").is_some() && F == Mat3::identity(1.0) { 2e-3 } else { 3e-8 };
            assert!(difference < tolerance, "{difference:e}");
        }
    }
}

#[test]
fn neo_hookean_is_the_textbooks() {
    let (mu, lambda) = (3.0, 5.0);
    let law = law("mu/2*(I1-3) - mu*log(J) + lambda/2*log(J)^2", &[("mu", mu), ("lambda", lambda)]);
    for F in samples() {
        let J = F.determinant();
        // P = μ F + (λ ln J - μ) F⁻ᵀ
        let P = F * mu + F.cofactor() * ((lambda * J.ln() - mu) / J);
        assert!((law.stress_at(&F) - P).largest_entry() < 1e-14 * 30.0);
    }
    assert!(law.warnings.iter().any(|warning| warning.contains("inverted")), "{:?}", law.warnings);
    // the derived stress is as short as by hand: cofactor, determinant, two matrices
    let count = law.graph.reachable(&[law.stress]).len();
    assert!(count <= 16, "{count} expressions");
}

/// What is written with entries becomes the same expressions as what is written with tensors.
#[test]
fn small_strain_moduli() {
    let law = law("mu*dot(E, E) + lambda/2*tr(E)^2", &[("mu", 3.0), ("lambda", 5.0)]);
    assert!((law.stiffness[0] - 11.0).abs() < 1e-14 && (law.stiffness[4] - 5.0).abs() < 1e-14);
    assert!((law.stiffness[9 + 1] - 3.0).abs() < 1e-14 && (law.stiffness[9 + 3] - 3.0).abs() < 1e-14);
}

#[track_caller]
fn refused(text: &LawText) -> LawError {
    match EnergyLaw::compile(text) {
        Ok(_) => panic!("accepted: {}", text.energy),
        Err(error) => error,
    }
}

/// The message and the characters that are marked.
#[test]
fn bad_laws_are_told_where_and_why() {
    let cases: &[(&str, &str, &str)] = &[
        ("mu/2*(I1 - 3", "", "wanted"),
        ("mu/2*(I1 - 3) + nu", "nu", "there is no `nu`; there are the parameters"),
        ("mu/2*(I1bar - 3)", "I1bar", "did you mean `I1_bar`"),
        ("MU/2*(I1 - 3)", "MU", "did you mean `mu`"),
        ("mu/2*(I1 - 3) - mu*lnn(J)", "lnn", "did you mean `ln`"),
        ("mu/2*(I1 - 3) + J - 1", "J", "pure number"),
        ("I1 - 3", "I1 - 3", "energy per volume"),
        ("mu*E", "mu*E", "a number, the energy density"),
        ("mu*E + mu", "mu", "3x3 tensor"),
        ("mu*exp(mu)", "mu", "pure number"),
        ("mu*(I1 - 3)", "mu*(I1 - 3)", "the stress is"),
        ("mu*F12^2", "F12", "a rotation changes"),
        ("mu*abs(J - 1)", "abs(J - 1)", "corner"),
        ("mu*sqrt(I1 - 3)", "sqrt(I1 - 3)", "corner"),
        ("mu*max(J - 1, 0)", "max(J - 1, 0)", "corner"),
        ("if(J > 1, mu*(J - 1)^2, mu) + mu*dot(E, E)", "if(J > 1, mu*(J - 1)^2, mu)", "corner"),
        ("mu/(J - 1)", "mu/(J - 1)", "division by zero"),
        ("mu*ln(J - 1)", "ln(J - 1)", "ln of 0"),
        ("mu*(l1 - 1)^2", "l1", "order of the principal stretches"),
        ("mu*(I1_bar - 3)^2.5 + mu*(J - 1)^2", "(I1_bar - 3)^2.5", "that is not whole"),
        ("mu*3", "", "does not change"),
        ("mu*(J - 1)^2*(2/(3 - 3))", "3 - 3", "a divisor other than zero"),
        ("mu*(C*[1, 0])", "[1, 0]", "three numbers"),
        ("mu*tr(J)", "J", "3x3 tensor"),
        (
            "mu*I4(C)",
            "C",
            "this is a 3x3 tensor, where a direction, a vector such as a parameter `a = [1, 0, 0]`,",
        ),
        ("mu*(I4(mu) - 1)^2", "mu", "this is a number, where a direction, a vector such as a parameter"),
        ("mu*(I5(fibre) - 1)^2", "fibre", "is given among the parameters, as `fibre = [1, 0, 0]`"),
        ("mu*dot(C)", "dot(C)", "dot(A, B)"),
        ("mu*J > mu", "mu*J > mu", "truth value"),
        ("mu*(E:E)", ":", "`A:B` is written `dot(A, B)`"),
        ("mu*tr(E')", "'", "`A'` is written `transpose(A)`"),
        ("mu*(tr(F^T*F) - 3)", "^T", "`A^T` is written `transpose(A)`"),
        ("W = mu*(I1 - 3)", "=", "is written `c*(J - 1)^2`"),
        ("mu*tr(Fᵀ*F)", "ᵀ", "`Aᵀ` is written `transpose(A)`"),
        ("mu (J - 1)^2", "mu", "a `*` is missing, as in `mu * (…)`"),
        ("mu*J (J - 1)", "J", "a `*` is missing, as in `J * (…)`"),
        ("mu*F12(J - 1)", "F12", "a `*` is missing, as in `F12 * (…)`"),
        ("mu/2 (I1 - 3)", "(", "(is a `*` missing?)"),
        ("mu*(J-1)(J-1)", "(", "(is a `*` missing?)"),
        ("mu J", "J", "(is a `*` missing?)"),
        ("kappa (J - 1)", "kappa", "for a product write `kappa * (…)`"),
    ];
    for (energy, marked, message) in cases {
        let error = refused(&text(energy, &[("mu", 2.0)]));
        let said = error.to_string();
        assert!(said.contains(message), "{energy}: {said}");
        let place = error.span.map_or("", |span| span.of(energy));
        assert!(marked.is_empty() || place == *marked, "{energy}: marked `{place}`: {said}");
        assert_eq!(error.part, "energy");
    }
}

/// A law that resists nothing is none, whether a number makes it so, its terms, or all but the rounding of them.
#[test]
fn laws_of_zero_are_refused() {
    let zero = |energy: &str, mu: f64| {
        let error = refused(&text(energy, &[("mu", mu), ("K", 0.0), ("k", 0.0)]));
        let said = error.problem.to_string();
        assert!(
            said.starts_with("no deformation that was tried, small or large, makes a stress: "),
            "{energy}: {said}"
        );
        assert!(said.ends_with("; a body of this law would resist nothing"), "{energy}: {said}");
        (error.span.map_or("", |span| span.of(energy)).to_owned(), said)
    };
    for energy in
        ["mu/2*(I1 - 3) - mu*log(J)", "mu*(J - 1)^2 + 0*K", "mu*dot(eps, eps)", "mu*(exp(1e6*(J - 1)^2) - 1)"]
    {
        let (marked, said) = zero(energy, 0.0);
        assert!(energy.starts_with(&marked) && marked.len() > 10, "{energy}: {marked}");
        let told = if energy.contains('K') {
            "the parameters `mu`, `K` are zero"
        } else {
            "the parameter `mu` is zero"
        };
        assert!(said.contains(told), "{said}");
    }
    for (energy, marked) in [
        ("mu*(tr(C) - I1)", "tr(C) - I1"),
        ("mu*(det(C) - J^2)*(I1 - 3)", "det(C) - J^2"),
        ("mu*(dot(inv(C), C) - 3)", "mu*(dot(inv(C), C) - 3)"),
        ("mu*(l1*l2*l3 - J)*(I1 - 3)", "mu*(l1*l2*l3 - J)*(I1 - 3)"),
        ("mu*(dot(inv(C), C) - 3)^2", "mu*(dot(inv(C), C) - 3)^2"),
        ("mu*(J - J)*tr(E)", "J - J"),
        ("0*mu*(J - 1)^2", "0"),
    ] {
        let (place, said) = zero(energy, 3e3);
        assert!(said.contains("its terms cancel, or are multiplied by zero"), "{said}");
        assert_eq!(place, marked);
    }
    // what begins far from rest, is tiny, huge or flat at rest resists
    let far = [
        ("mu*max(I1 - 40, 0)^2", 1.0),
        ("mu*dot(E, E)", 1e-200),
        ("mu*dot(E, E)", 1e200),
        ("mu*(exp(1e8*(J - 1)^2) - 1)", 1.0),
        ("min(mu*dot(E, E), 1e30*mu)", 1e-3),
        ("mu*(J - 1)^8", 1.0),
    ];
    far.iter().for_each(|(energy, mu)| drop(law(energy, &[("mu", *mu)])));
}

/// What is wrong in units is the term that is no energy density, whichever stands first, with the parameters in it.
#[test]
fn units_are_told_with_their_term_and_parameters() {
    let dimension = |mass, length, time| Some(Dimension::new(mass, length, time));
    let told = |energy: &str, definitions: &[(&str, &str)]| {
        let mut text = text(energy, &[("mu", 2.0)]);
        text.parameters.extend([
            number("K", 3.0, dimension(0, 1, 0)),
            number("b", 4.0, None),
            number("share", 0.5, Some(Dimension::PURE)),
        ]);
        text.definitions =
            definitions.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
        let error = refused(&text);
        let of_part =
            definitions.iter().find(|(name, _)| *name == error.part).map_or(energy, |(_, text)| text);
        let place = error.span.map_or("", |span| span.of(of_part));
        (error.part.clone(), place.to_owned(), error.problem.to_string())
    };
    let density = "where an energy per volume is wanted, which is a pressure [kg/(m s²)]";
    for (energy, marked, message) in [
        (
            "mu/2*(I1 - 3) + K*(J - 1)^2",
            "K*(J - 1)^2",
            format!("`K*(J - 1)^2` is a length [m], {density}; the parameter in it, `K`, is a length [m]"),
        ),
        // what stands first is no measure
        (
            "K*(J - 1)^2 - mu*ln(J)",
            "K*(J - 1)^2",
            format!("`K*(J - 1)^2` is a length [m], {density}; the parameter in it, `K`, is a length [m]"),
        ),
        (
            "b*(J - 1) - -(K*J + mu*K*J)",
            "K*J",
            format!("`K*J` is a length [m], {density}; the parameter in it, `K`, is a length [m]"),
        ),
        (
            "b*(J - 1) + share*(J - 1)^2",
            "share*(J - 1)^2",
            format!("`share*(J - 1)^2` is a pure number, {density}; the parameter in it, `share`, is a pure number"),
        ),
        (
            "mu*J + mu*K*exp(b*J)",
            "mu*K*exp(b*J)",
            format!(
                "`mu*K*exp(b*J)` is a stiffness or surface tension [kg/s²], {density}; of the parameters in it `mu` is a \
                 pressure [kg/(m s²)], `K` is a length [m], `b` is given without unit"
            ),
        ),
        ("I1 - 3", "I1 - 3", format!("`I1 - 3` is a pure number, {density}; no parameter is in it")),
        (
            "mu*((I1 - 3) + K*(J - 1))",
            "K*(J - 1)",
            "`K*(J - 1)` is a length [m], where a pure number is wanted, as `I1 - 3` beside it is; the parameter in it, \
             `K`, is a length [m]"
                .to_owned(),
        ),
        (
            "mu*exp(K*J)",
            "K*J",
            "`K*J` is a length [m], where a pure number is wanted; the parameter in it, `K`, is a length [m]".to_owned(),
        ),
    ] {
        assert_eq!(told(energy, &[]), ("energy".to_owned(), marked.to_owned(), message));
    }
    // by way of definitions, and in one
    let (part, marked, message) = told("mu*(J - 1)^2 + W", &[("W", "L*(J - 1)"), ("L", "2*K")]);
    assert_eq!((part.as_str(), marked.as_str()), ("energy", "W"));
    assert!(message.ends_with("the parameter in it, `K`, is a length [m]"), "{message}");
    let (part, marked, message) = told("mu*W", &[("W", "(J - 1)^2 + K*J")]);
    assert_eq!((part.as_str(), marked.as_str()), ("W", "K*J"));
    assert!(message.contains("where a pure number is wanted, as `(J - 1)^2` beside it is"), "{message}");
}

#[test]
fn bad_parts_are_told() {
    let mut cyclic = text("mu*a", &[("mu", 1.0)]);
    cyclic.definitions =
        [("a", "b + 1"), ("b", "2*c"), ("c", "a^2")].map(|(n, t)| (n.to_owned(), t.to_owned())).to_vec();
    let error = refused(&cyclic);
    assert_eq!(
        *error.problem,
        LawProblem::Recursion { cycle: ["a", "b", "c", "a"].map(str::to_owned).to_vec() }
    );
    assert_eq!((error.part.as_str(), error.span), ("c", Some(Span::new(0, 1))));
    for (name, wanted) in
        [("J", "ratio of volumes"), ("C12", "entry (1, 2)"), ("sin", "sine"), ("2a", "no name")]
    {
        let error = refused(&text("mu*(J-1)^2", &[("mu", 1.0), (name, 1.0)]));
        assert!(error.to_string().contains(wanted), "{error}");
    }
    assert!(refused(&text("mu*(J-1)^2", &[("mu", 1.0), ("mu", 2.0)])).to_string().contains("twice"));
    assert!(refused(&text("mu*(J-1)^2", &[("mu", f64::NAN)])).to_string().contains("finite"));
}

/// Small strain knows small turns only: what they change is refused as large ones are elsewhere, whatever definitions beside
/// the energy say.
#[test]
fn small_strain_is_no_excuse() {
    let told = |energy: &str| refused(&text(energy, &[("mu", 1.0)])).to_string();
    assert!(told("mu*dot(eps, eps) + mu*eps11*F23").contains("a rotation changes"));
    let mut unused = text("mu*(I1 - 3 - 2*ln(J)) + mu*(F11 - 1)^2", &[("mu", 1.0)]);
    unused.definitions.push(("e".to_owned(), "tr(eps)".to_owned()));
    assert!(refused(&unused).to_string().contains("a rotation changes"));
    // the volume sees turns in higher orders only
    law("mu*dot(eps, eps) + mu*(J - 1)^2", &[("mu", 1.0)]);
}

/// What changes where the volume is that of rest is not called a matter of rotation.
#[test]
fn volumes_are_not_rotations() {
    law("mu*(I1_bar - 3)*if(J > 1, 1, 2) + mu*(J - 1)^2", &[("mu", 1.0)]);
}

/// The source's worked example as text: `D_0` is the bracket, wherever and in whatever order it stands, and `D_1` holds it.
#[test]
fn constants_of_a_formula() {
    let variables = ["U0x", "U0y"].map(str::to_owned);
    let (graph, grouped) = group_constants("(P1x - P1y)*U0x + U0y*p0*(-P1y + P1x)", &variables).unwrap();
    let written = |roots: &[Expr]| crate::emit::write(&graph, roots, &crate::emit::Text).1;
    let constants: Vec<Expr> = grouped.constants.iter().map(|(_, definition)| *definition).collect();
    assert_eq!(written(&constants), ["P1x_ - P1y_", "p0*D_0"]);
    assert_eq!(written(&grouped.varying), ["U0x_*D_0 + U0y_*D_1"]);
    let error = group_constants("a +* b", &[]).unwrap_err();
    assert_eq!(error.span, Some(Span::new(3, 4)));
    let error = group_constants("Alpha*x + b", &["x", "alpha"].map(str::to_owned)).unwrap_err();
    let said =
        "`alpha` is said to vary, but is not in the formula (did you mean `Alpha`?); in it are Alpha, x, b";
    assert_eq!((error.part.as_str(), error.problem.to_string().as_str()), ("varying", said));
}

/// Laws that are flat at rest are laws.
#[test]
fn flat_laws_are_objective() {
    law("mu*(J - 1)^4", &[("mu", 1e6)]);
    law("mu*min(J - 1, 1 - J, 0)^2", &[("mu", 1e6)]);
    let error = refused(&text("mu*(J - 1)^4 + mu*F12^4", &[("mu", 1e6)]));
    assert!(error.to_string().contains("a rotation changes"), "{error}");
}

/// Products of products are gone into once: eight powers of powers are read as fast as one, or refused as too large.
#[test]
fn towers_of_powers_are_answered() {
    let tower = |levels: usize| (0..levels).fold("C".to_owned(), |inner, _| format!("({inner})^8"));
    for energy in [
        format!("mu*tr({})", tower(8)),
        format!("mu*det({}) - mu", tower(8)),
        format!("mu*tr(inv({}))", tower(8)),
        format!("mu*dot([1, 0, 0], {}*[1, 0, 0])", tower(8)),
    ] {
        // none of them is at rest without stress
        refused(&text(&energy, &[("mu", 1.0)]));
    }
    let mut chain = text("mu*tr(A30)", &[("mu", 1.0)]);
    for level in 1..=30 {
        let below = if level == 1 { "C".to_owned() } else { format!("A{}", level - 1) };
        chain.definitions.push((format!("A{level}"), format!("{below}*{below}")));
    }
    refused(&chain);
}

/// Sums that each hold the one before twice are gone into once: a chain of them has as many ways down as two to its length.
#[test]
fn chains_of_sums_are_answered() {
    for link in ["J*A + I1*transpose(A)", "J*A + I1*(A + F)", "J*transpose(A) + I1*(A + transpose(A))"] {
        for energy in ["mu*tr(A60)", "mu*A60_12", "mu*dot(A60, A60)", "mu*dot([1, 0, 0], A60*[1, 0, 0])"] {
            let energy = energy.replace("A60_12", "dot([1, 0, 0], A60*[0, 1, 0])");
            let mut chain = text(&energy, &[("mu", 1.0)]);
            chain.definitions.push(("A0".to_owned(), "F + E".to_owned()));
            for level in 1..=60 {
                let below = link.replace('A', &format!("A{}", level - 1));
                chain.definitions.push((format!("A{level}"), below));
            }
            // none of them is at rest without stress
            refused(&chain);
        }
    }
}

/// Ten megabytes, deep nesting and long products are answered at once.
#[test]
fn monstrous_laws_are_refused() {
    for energy in [
        "mu*(J-1)^2 + ".repeat(800_000) + "0",
        "(".repeat(100_000) + "mu",
        (0..5000).map(|i| format!("(J + {i})*")).collect::<String>() + "mu",
        "mu*9^9^9^9^9*(J - 1)^2".to_owned(),
    ] {
        let error = refused(&text(&energy, &[("mu", 1.0)]));
        assert!(error.to_string().len() < 400, "{}", error.to_string().len());
    }
}

/// Below the bounds on what is written derivatives may still grow with the third power, or with the number of invariants.
#[test]
fn derivatives_without_end_are_refused() {
    let factors: String = (0..900).map(|i| format!("(J + {i})*")).collect();
    let directions = (0..300).map(|i| format!("I4([1, {i}, 2])*")).collect::<String>();
    for energy in [factors + "mu", directions + "mu"] {
        let error = refused(&text(&energy, &[("mu", 1.0)]));
        assert!(matches!(*error.problem, LawProblem::LongDerivatives { .. }), "{error}");
        assert!(error.span.is_some_and(|span| span.end - span.start > 100));
    }
}

#[test]
fn doubts_are_said() {
    let doubt = |energy: &str| law(energy, &[("mu", 1.0), ("k", 1.0)]).warnings.join("; ");
    assert!(doubt("mu*dot(dev(E), dev(E)) + 0*k").contains("change of volume"));
    assert!(doubt("k*(J - 1)^2").contains("`mu` is used nowhere"));
    assert!(doubt("k*(J - 1)^2 + 0*mu").contains("shear"));
    assert!(doubt("mu*dot(E, E) - 2*k*tr(E)^2").contains("negative"));
    assert!(doubt("mu*dot(eps, eps) + k*tr(eps)^2").contains("eps"));
    assert!(doubt("mu*dot(E, E) + k*tr(E)^2").contains("inside out"));
}

/// Where the energy has no value the stress that is run has none, though its formula goes on; a branch that is not taken ends
/// nothing, and laws whose stress ends by itself stay as they are.
#[test]
fn stress_ends_where_the_energy_does() {
    let moduli = [("mu", 3.0)];
    let inverted = Mat3::from_diagonal(Vec3::new(-0.5, 1.1, 0.9));
    for (energy, ends) in [
        ("mu/2*(I1 - 3) - mu*log(J)", true),
        ("mu/2*(I1 - 3) - mu/2*log(J^2)", false),
        ("mu/2*(I1 - 3) - mu*if(J < 0.1, J, log(J))", false),
        ("mu*dot(E, E)", false),
    ] {
        let Ok(mut law) = EnergyLaw::compile(&text(energy, &moduli)) else { panic!("{energy} is no law") };
        let guarded = law.guarded_stress();
        let at = |F: &Mat3| law.evaluate(&[guarded], F, &Mat3::ZERO).matrix(guarded);
        for F in samples() {
            assert_eq!(at(&F), law.stress_at(&F), "{energy}");
        }
        assert!(law.stress_at(&inverted).is_finite(), "{energy}");
        assert_eq!(at(&inverted).is_finite(), !ends, "{energy}");
    }
    let mut law = law("mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2", &[("mu", 3.0), ("lambda", 5.0)]);
    assert_eq!(law.guarded_stress(), law.stress);
}

/// Energies that jump are told, with the place; pieces that meet are not.
#[test]
fn jumps_are_told() {
    let warned = |energy: &str| {
        let law = EnergyLaw::compile(&text(energy, &[("mu", 2.0)])).expect(energy);
        law.warnings.iter().find(|warning| warning.contains("jumps by")).cloned()
    };
    for (energy, said) in [
        // so near rest and so small that no look sees it
        (
            "mu*dot(E, E) + if(J > 1.001, 1e-6*mu, 0)",
            "the energy jumps by 2.000e-6 J/m³ where a cube is pulled along x to 1.0010",
        ),
        ("mu*dot(E, E) + mu*max(J - 1.2, 0)", "the stress jumps by"),
        ("mu*dot(E, E) + mu*(clamp(J, 0.9, 1.1) - 1)^2", "the stress jumps by"),
        ("mu*dot(E, E) + mu*step(1.02, J)", "by 2.000e0 J/m³ where a cube is pulled along x to 1.0200"),
        ("mu*dot(E, E)*if(J < 1.3, 1, 2)", "pulled along x to 1.3000"),
        ("mu*dot(E, E)*(1 + floor(J))", "jumps by"),
    ] {
        let warning = warned(energy).unwrap_or_else(|| panic!("{energy}"));
        assert!(warning.contains(said), "{energy}: {warning}");
    }
    for energy in [
        "mu*dot(E, E) + mu*max(J - 1.2, 0)^2",
        "mu*dot(E, E)*if(J < 1.3, 1, 1)",
        "mu*dot(E, E) + mu*abs(J - 1)^3",
        "mu*dot(E, E)",
    ] {
        assert_eq!(warned(energy), None, "{energy}");
    }
}

/// Stiffness that is one thing when a cube begins to swell and another when it begins to shrink is told, and only that.
#[test]
fn jumps_of_the_stiffness_at_rest_are_told() {
    let warned = |energy: &str| {
        let law = EnergyLaw::compile(&text(energy, &[("mu", 2.0)])).expect(energy);
        law.warnings.iter().find(|warning| warning.contains("stiffness at rest jumps")).cloned()
    };
    // 1/2 |F - I|² of swelling is 3/2, along which J grows by 3: k (J - 1)² bends by 2·9 k / 3
    let warning = warned("mu*dot(E, E) + 5*mu*max(J - 1, 0)^2").unwrap_or_default();
    assert!(warning.contains("from 4.000e0 to 6.400e1 Pa where a cube begins to be swollen"), "{warning}");
    assert!(warned("mu*dot(E, E) + mu*max(I4([1, 0, 0]) - 1, 0)^2").is_some());
    for energy in
        ["mu*dot(E, E) + mu*abs(J - 1)^2", "mu*dot(E, E) + 1e4*mu*(J - 1)^3", "mu*(exp(1e4*dot(E, E)) - 1)"]
    {
        assert_eq!(warned(energy), None, "{energy}");
    }
}

/// `|x|²` is `x²`, whose stiffness does not end where `x` is zero, however it is hidden.
#[test]
fn even_powers_of_sizes_are_smooth() {
    let plain = law("mu*dot(E, E) + k*(J - 1)^2", &[("mu", 2.0), ("k", 30.0)]);
    for energy in [
        "mu*dot(E, E) + k*abs(J - 1)^2",
        "mu*dot(E, E) + k*abs(J - 1)*abs(J - 1)",
        "mu*dot(E, E) + k*log(cosh(sqrt(2)*abs(J - 1)))",
    ] {
        let even = law(energy, &[("mu", 2.0), ("k", 30.0)]);
        for (a, b) in even.stiffness.iter().zip(plain.stiffness.iter()) {
            assert!((a - b).abs() < 1e-12 * 60.0, "{energy}: {a} {b}");
        }
    }
}

/// Laws that end are told where.
#[test]
fn ends_are_told() {
    let warned = |energy: &str| {
        let law = EnergyLaw::compile(&text(energy, &[("mu", 2.0)])).expect(energy);
        law.warnings.iter().find(|warning| warning.contains("no finite value beyond")).cloned()
    };
    for (energy, said) in [
        ("mu*dot(E, E) + mu*asin(J - 1)^2", "pulled along x to 2.0000"),
        // E_xx = (s² - 1)/2 = 1
        ("-mu*log(1 - dot(E, E))", "pulled along x to 1.7321"),
        ("mu*dot(E, E) - mu*log(J - 0.5) + 2*mu*J", "pulled along x to 0.5"),
    ] {
        assert!(
            warned(energy).is_some_and(|warning| warning.contains(said)),
            "{energy}: {:?}",
            warned(energy)
        );
    }
    assert_eq!(warned("mu*dot(E, E)"), None);
}

/// Directions that are written out count as of length one, as those among the parameters do.
#[test]
fn directions_of_any_length_are_one() {
    let F = Mat3::from_columns(Vec3::new(1.2, 0.1, 0.0), Vec3::new(0.0, 0.9, 0.2), Vec3::new(0.3, 0.0, 1.1));
    let energies = ["[1, 0, 0]", "[1/2, 0, 0]", "[7, 0, 0]", "2*[0.5, 0, 0]"].map(|direction| {
        let energy = format!("mu*(I4({direction}) - 1)^2 + mu*(I5({direction}) - 1)^2");
        EnergyLaw::compile(&text(&energy, &[("mu", 2.0)])).expect(direction).energy_at(&F)
    });
    for energy in energies {
        assert!((energy - energies[0]).abs() < 1e-14 * energies[0].abs(), "{energies:?}");
    }
}

/// A law that turns change far from rest alone is refused; one that makes much of roundings there is not.
#[test]
fn turns_are_tried_far_from_rest() {
    let far = "mu/2*(I1 - 3 - 2*log(J)) + mu*max(I1 - 5, 0)^2*(F11 - 1)^2";
    assert!(matches!(*refused(&text(far, &[("mu", 2.0)])).problem, LawProblem::NotObjective { .. }));
    for b in ["50", "200", "1000"] {
        let energy = format!("mu*(I1_bar - 3)*exp({b}*(J - 1)^2) + mu*(J - 1)^2");
        let read = EnergyLaw::compile(&text(&energy, &[("mu", 2.0)]));
        assert!(read.is_ok(), "{b}: {:?}", read.err());
    }
}

/// Poles, and jumps in shear and far out, are told as jumps of a stretch are.
#[test]
fn poles_and_jumps_in_shear_are_told() {
    let warned = |energy: &str| law(energy, &[("mu", 2.0)]).warnings.join("; ");
    for (energy, said) in [
        (
            "mu*dot(E, E) + mu*(J - 1)^2/(1.3 - J)",
            "the energy has a pole where a cube is pulled along x to 1.3000",
        ),
        (
            "mu*dot(E, E) + mu*(J - 1)^2*tan(J)",
            "the energy has a pole where a cube is pulled along x to 1.5708",
        ),
        (
            "mu*dot(E, E) + if(abs(C12) > 0.1, mu, 0)",
            "the energy jumps by 2.000e0 J/m³ where a cube is sheared by",
        ),
        ("mu*dot(E, E) + if(I1_bar > 8, mu, 0)", "the energy jumps by"),
        (
            "mu/2*(I1_bar - 3) + mu*(J - 1)^2 - mu*log(1 - (I1_bar - 3)/15)",
            "no finite value beyond a cube that is pulled along x to 8.5",
        ),
    ] {
        let told = warned(energy);
        assert!(told.contains(said), "{energy}: {told}");
    }
    // an exponential overflows far beyond what it is made for
    assert!(!warned("mu*(exp(dot(E, E)) - 1)").contains("no finite value"));
}

/// What takes a deformation is no function of numbers.
#[test]
fn formulas_of_numbers_have_no_deformation() {
    let error = group_constants("I4([1, 0, 0]) + F*x", &["x".to_owned()]).expect_err("a deformation");
    assert!(error.to_string().contains("there is no function `I4`"), "{error}");
}

/// The stiffness between two nodes is the differential along `u ⊗ b` times `a`, for laws of tensors, and no law of stretches has one.
#[test]
fn blocks_are_differentials_along_a_gradient() {
    let moduli = [("p", 3.0), ("q", 7.0)];
    for energy in [
        "p/2*tr(eps)^2 + q*dot(eps, eps)",
        "p/2*tr(E)^2 + q*dot(E, E)",
        "q/2*(I1 - 3) - q*log(J) + p/2*log(J)^2",
        "p*(I1_bar - 3) + q*(I2_bar - 3) + p/2*(J - 1)^2",
        "q/2*(exp(3*dot(E, E)) - 1) + p/2*tr(E)^2",
        "p/2*(max(I1 - 3, 0))^2 + q/2*(J - 1)^2 + q*(I1_bar - 3)",
    ] {
        let law = law(energy, &moduli);
        let Block { graph, gradients: [a, b], stiffness } = law.block().unwrap();
        let (g_a, g_b) = ([0.3, -0.7, 1.1], [-0.4, 0.9, 0.2]);
        let F = [1.1, 0.1, -0.2, 0.05, 0.9, 0.15, 0.2, -0.1, 1.2];
        let value = |graph: &Graph, root: Expr, dF: [f64; 9]| -> Vec<f64> {
            let held = [
                ("F", F.to_vec()),
                ("dF", dF.to_vec()),
                ("p", vec![3.0]),
                ("q", vec![7.0]),
                ("@g_a", g_a.to_vec()),
                ("@g_b", g_b.to_vec()),
            ];
            let held: std::collections::HashMap<&str, Vec<f64>> = held.into_iter().collect();
            let all = graph.reachable(&[root]);
            graph.evaluate(&all, |symbol| &held[symbol.name.as_str()]).of(root).to_vec()
        };
        assert!(graph.symbol_of(a).is_some() && graph.symbol_of(b).is_some());
        let K = value(&graph, stiffness, [0.0; 9]);
        for axis in 0..3 {
            // u is an axis: δF = u ⊗ b has one row
            let dF = std::array::from_fn(|i| if i % 3 == axis { g_b[i / 3] } else { 0.0 });
            let dP = value(&law.graph, law.differential, dF);
            for row in 0..3 {
                let expected: f64 = (0..3).map(|column| dP[3 * column + row] * g_a[column]).sum();
                let found = K[3 * axis + row];
                assert!(
                    (found - expected).abs() < 1e-12 * (1.0 + expected.abs()),
                    "{energy}: {found} {expected}"
                );
            }
        }
    }
    assert!(law("q*(l1^2 + l2^2 + l3^2 - 3) - q*log(J^2)", &moduli).block().is_none());
}
