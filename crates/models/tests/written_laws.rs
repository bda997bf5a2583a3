//! Written laws against closed forms, and the counts of the source on its elements.

#![allow(non_snake_case)]

use souple_formal::element::{Axis, Cut};
use souple_formal::law::{EnergyLaw, LawParameter};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::ElementKind;
use souple_models::associations::Association;
use souple_models::derive::{
    MapKind, element_data, law_kernel, source_constant_count, source_law_name, source_name,
};
use souple_models::materials::{AnyLaw, DERIVED, WRITTEN_LAWS, WrittenLaw, is_parameter, law_text};
use souple_table::{Value, Values};

/// Principal stretches.
type Stretches = [f64; 3];

fn diagonal([a, b, c]: Stretches) -> Mat3 {
    Mat3::from_columns(Vec3::new(a, 0.0, 0.0), Vec3::new(0.0, b, 0.0), Vec3::new(0.0, 0.0, c))
}

/// `J σ_i = λ_i ∂Ψ/∂λ_i` of a decoupled law: the deviator of `λ̄_i ∂Ψ_iso/∂λ̄_i`, and `J U'(J)`.
fn decoupled(isochoric: [f64; 3], J: f64, volumetric: f64) -> [f64; 3] {
    let mean = isochoric.iter().sum::<f64>() / 3.0;
    isochoric.map(|part| part - mean + J * volumetric)
}

/// Kirchhoff stress `λ_i P_i` by hand.
fn by_hand(name: &str, p: &dyn Fn(&str) -> f64, s: Stretches) -> [f64; 3] {
    let J = s[0] * s[1] * s[2];
    let bar = s.map(|s| s * J.powf(-1.0 / 3.0));
    let squares = bar.map(|s| s * s);
    let I1_bar: f64 = squares.iter().sum();
    let bulk = |J: f64| p("k") * (J - 1.0);
    let green = s.map(|s| 0.5 * (s * s - 1.0));
    let trace: f64 = green.iter().sum();
    match name {
        "linear" | "corotational" => {
            let dilation: f64 = s.iter().sum::<f64>() - 3.0;
            s.map(|s| s * (p("lambda") * dilation + 2.0 * p("mu") * (s - 1.0)))
        }
        "st_venant_kirchhoff" => {
            std::array::from_fn(|i| s[i] * s[i] * (p("lambda") * trace + 2.0 * p("mu") * green[i]))
        }
        "neo_hookean" => s.map(|s| p("mu") * (s * s - 1.0) + p("lambda") * J.ln()),
        "stable_neo_hookean" => {
            let (m, l) = (p("mu") * 4.0 / 3.0, p("lambda") + p("mu") * 5.0 / 6.0);
            let I: f64 = s.iter().map(|s| s * s).sum();
            s.map(|s| m * s * s * (1.0 - 1.0 / (I + 1.0)) + (l * (J - 1.0) - 0.75 * m) * J)
        }
        "mooney_rivlin" => {
            // λ̄ ∂/∂λ̄ of Σλ̄² is 2λ̄², of Σλ̄⁻² is -2λ̄⁻²
            decoupled(squares.map(|q| 2.0 * p("c10") * q - 2.0 * p("c01") / q), J, bulk(J))
        }
        "yeoh" => {
            let x = I1_bar - 3.0;
            let slope = p("c1") + 2.0 * p("c2") * x + 3.0 * p("c3") * x * x;
            decoupled(squares.map(|q| 2.0 * slope * q), J, bulk(J))
        }
        "ogden" => {
            let part = |s: f64| p("mu1") * s.powf(p("a1")) + p("mu2") * s.powf(p("a2"));
            decoupled(bar.map(part), J, bulk(J))
        }
        "fung" => {
            let squares: f64 = green.iter().map(|e| e * e).sum();
            let factor = p("c") * p("b") * (p("b") * squares).exp();
            std::array::from_fn(|i| s[i] * s[i] * factor * green[i] + J * bulk(J))
        }
        "holzapfel_gasser_ogden" => {
            // both families have the squares of the same components, in the plane of the first two axes
            let length_sq = 0.8746f64.powi(2) + 0.4848f64.powi(2);
            let along = [0.8746f64.powi(2) / length_sq, 0.4848f64.powi(2) / length_sq, 0.0];
            let I4: f64 = along.iter().zip(squares).map(|(a, q)| a * q).sum();
            let e = (I4 - 1.0).max(0.0);
            let fibres = 2.0 * p("k1") * e * (p("k2") * e * e).exp();
            decoupled(std::array::from_fn(|i| squares[i] * (p("c") + 2.0 * fibres * along[i])), J, bulk(J))
        }
        other => panic!("no closed form of `{other}`"),
    }
}

/// A direction is a list of three numbers, which may be formulas, of any length; text is a value where it is one, and else a part
/// of an energy.
#[test]
fn values_and_directions() {
    let read =
        |text: &str| law_text("J", &[("a".to_owned(), text.to_owned())], &[]).map(|law| law.parameters[0].1);
    let Ok(LawParameter::Direction([x, y, z])) = read("[1, 0, sqrt(3)]") else { panic!() };
    // a square root, a square, a sum and a quotient
    assert!((x - 0.5).abs() < 1e-15 && y == 0.0 && (z - 0.75f64.sqrt()).abs() < 1e-15, "{x} {y} {z}");
    for text in ["1, 0, 0", "(1, 0, 0)", "1 0 0", "[1 0 0]", "[1, 0]", "[1 mm, 0, 0]"] {
        let error = read(text).unwrap_err();
        assert_eq!(error.path(), ["parameters", "a"]);
        let said = error.to_string();
        let words = (
            format!("`a`: `{text}` is no direction"),
            "three numbers in brackets are accepted, as in [1, 0, 0]",
        );
        assert!(said.starts_with(&words.0) && said.ends_with(words.1), "{said}");
    }
    for value in ["10 kPa", "-2.5", "12 %", "[0.6, 0.8, 0]", "10 kpa", "1e999", "1e-310 Pa"] {
        assert!(is_parameter(value), "{value}");
    }
    for part in [
        "4/3*mu",
        "I1_bar - 3",
        "max(I4(a) - 1, 0)",
        "(a + b)*max(a, b)",
        "4/3*mu)",
        "mu (J - 1)",
        "[a, b, 0]",
    ] {
        assert!(!is_parameter(part), "{part}");
    }
}

fn compiled(law: &WrittenLaw) -> EnergyLaw {
    let text = law.text().unwrap();
    EnergyLaw::compile(&text).unwrap_or_else(|error| panic!("{}: {}", law.name, error.explained(law.energy)))
}

/// Every written law against its closed form, in uniaxial and equibiaxial stretch with free lateral stretch found
/// by bisection, and in triaxial stretch.
#[test]
fn written_laws_are_the_closed_forms() {
    for law in WRITTEN_LAWS {
        let compiled = compiled(law);
        let p = |name: &str| match compiled.parameter(name) {
            Some(LawParameter::Number { value, .. }) => *value,
            other => panic!("{name}: {other:?}"),
        };
        let scale = compiled.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for stretch in [0.7, 0.95, 1.1, 1.35] {
            let uniaxial = |lateral: f64| [stretch, lateral, lateral];
            let equibiaxial = |lateral: f64| [stretch, stretch, lateral];
            for state in [&uniaxial as &dyn Fn(f64) -> Stretches, &equibiaxial] {
                // the free direction bears nothing; isotropic laws have the same stress in both free directions
                let (mut low, mut high) = (0.3, 3.0);
                for _ in 0..80 {
                    let middle = 0.5 * (low + high);
                    let stress = by_hand(law.name, &p, state(middle))[2];
                    if stress < 0.0 { low = middle } else { high = middle }
                }
                let s = state(low);
                let P = compiled.stress_at(&diagonal(s));
                let expected = by_hand(law.name, &p, s);
                for i in 0..3 {
                    let found = P.columns[i].to_array()[i] * s[i];
                    let error = (found - expected[i]).abs() / scale;
                    assert!(error < 1e-8, "{}: {s:?}: {found} {}", law.name, expected[i]);
                }
                let shear = (0..9).filter(|i| i % 4 != 0).map(|i| P.columns[i / 3].to_array()[i % 3].abs());
                assert!(shear.fold(0.0, f64::max) < 1e-8 * scale, "{}", law.name);
            }
        }
    }
}

/// Every law of the table is also written as text, and both are the same function: energy and stress.
#[test]
fn laws_of_the_table_are_the_texts() {
    let number = Value::Number;
    // 20 and 10 kPa of Lamé
    let isotropic = [("youngs_modulus", number(80e3 / 3.0)), ("poissons_ratio", number(1.0 / 3.0))];
    let mooney = [("c10", number(4e3)), ("c01", number(1e3))];
    let ogden = [("mu", Value::Numbers(&[6e3, -1e3])), ("alpha", Value::Numbers(&[1.8, -2.5]))];
    let yeoh = [("c1", number(5e3)), ("c2", number(-200.0)), ("c3", number(50.0))];
    for law in AnyLaw::ALL {
        let entry = law.entry();
        let text = compiled(WrittenLaw::find(entry.name).unwrap());
        let (own, has_bulk) = match entry.name {
            "mooney_rivlin" => (&mooney[..], true),
            "ogden" => (&ogden[..], true),
            "yeoh" => (&yeoh[..], true),
            _ => (&isotropic[..], false),
        };
        let mut values = Values::new().with("density", number(1e3));
        if has_bulk {
            values.set("bulk_modulus", number(100e3));
        }
        let values = own.iter().fold(values, |values, (name, value)| values.with(*name, *value));
        let material = (entry.build)(&entry.values(values).unwrap()).unwrap();
        let scale = text.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..50 {
            let mut vector = || Vec3::new(random(), random(), random());
            let noise = Mat3::from_columns(vector(), vector(), vector()) * 0.35;
            let F = exponential(vector() * 3.0) * (Mat3::IDENTITY + noise);
            if F.determinant() < 0.2 {
                continue;
            }
            let energies = (text.energy_at(&F), material.energy_density(&F));
            // some tens of operations; the stress is a difference of parts of the size of the bulk modulus
            let name = entry.name;
            assert!((energies.0 - energies.1).abs() <= 1e-12 * scale, "{name} {F:?}: {energies:?}");
            let error = (text.stress_at(&F) - material.stress(&F)).largest_entry();
            assert!(error <= 1e-12 * scale, "{name} {F:?}: {error:e}");
        }
    }
}

/// EXP-5: every element of surfaces and volumes under each of its rules, with every law and cut; each has a name of its own.
#[test]
fn every_association_is_listed_once() {
    let kinds = ElementKind::ALL.iter().filter(|kind| kind.dimension() > 1);
    let variants: usize = kinds.map(|kind| kind.rules().len()).sum();
    // the source counts 53, nine of them edges
    assert!(variants >= 44, "{variants}");
    let names: Vec<String> = Association::all().map(|association| association.name()).collect();
    // the source: 4240
    assert_eq!(names.len(), WRITTEN_LAWS.len() * variants * 16);
    assert!(names.len() >= 4240, "{}", names.len());
    let unique: std::collections::HashSet<&String> = names.iter().collect();
    assert_eq!(unique.len(), names.len());
    for expected in [
        "HookeTriangleDecoupageNon",
        "SaintVenantHexa8IDecoupageLN",
        "HookePrism6IDecoupageTout",
        "OgdenTetraDecoupageNon",
    ] {
        assert!(unique.contains(&expected.to_owned()), "{expected}");
    }
}

/// Moduli at rest that the literature gives: `2 (c10 + c01)`, `2 c1`, `Σ μ_p α_p / 2`, `c b / 2`.
#[test]
fn moduli_at_rest() {
    let shear = |name: &str| compiled(WrittenLaw::find(name).unwrap()).stiffness[9 * 3 + 3];
    for (name, expected) in [
        ("linear", 10e3),
        ("neo_hookean", 10e3),
        ("mooney_rivlin", 10e3),
        ("yeoh", 10e3),
        ("ogden", 0.5 * (6e3 * 1.8 + 1e3 * 2.5)),
        ("fung", 0.5 * 10e3 * 4.0),
    ] {
        assert!((shear(name) - expected).abs() < 1e-9 * expected, "{name}: {} {expected}", shear(name));
    }
}

/// Tables 3.4 to 3.7 of the source: at most its counts, and those that the theory of grouped constants gives when plain
/// numbers stay in the code: the inverse maps of all samples, and one factor for each term of the law and sample.
#[test]
fn grouped_constants_of_the_tables() {
    for (kind, map, expected) in [
        (ElementKind::Tri3, MapKind::General, 6),
        (ElementKind::Tet4, MapKind::General, 11),
        (ElementKind::Hex8, MapKind::Box, 5),
        (ElementKind::Prism6, MapKind::General, 66),
        (ElementKind::Pyramid5, MapKind::General, 55),
    ] {
        // as in the source: one sample in simplices, six in prisms, five in pyramids, eight in hexahedra
        let samples = match kind {
            ElementKind::Hex8 => 8,
            ElementKind::Prism6 => 6,
            ElementKind::Pyramid5 => 5,
            _ => 1,
        };
        let rule = kind.rules().iter().find(|rule| rule.points.len() == samples).unwrap();
        let element = element_data(kind, rule, map).unwrap();
        for name in ["linear", "st_venant_kirchhoff"] {
            let derived = element.derive(&compiled(WrittenLaw::find(name).unwrap()), Cut::NONE);
            let count = derived.energies[0].grouped.constants.len();
            assert_eq!(count, expected, "{kind} under {name}");
            assert!(count <= source_constant_count(kind, map).unwrap());
        }
        let whole = element
            .derive(&compiled(WrittenLaw::find("linear").unwrap()), Cut::of(&[Axis::Law, Axis::Gauss]));
        let cut: usize = whole.energies.iter().map(|fragment| fragment.grouped.constants.len()).sum();
        assert!(cut >= expected, "{kind}");
    }
}

/// Cut along the law, triangles and tetrahedra need the entries of their inverse map and one factor in each fragment.
#[test]
fn grouped_constants_of_terms() {
    for (kind, expected) in [(ElementKind::Tri3, 5), (ElementKind::Tet4, 10)] {
        let element = element_data(kind, &kind.rules()[0], MapKind::General).unwrap();
        let law = compiled(WrittenLaw::find("st_venant_kirchhoff").unwrap());
        let derived = element.derive(&law, Cut::of(&[Axis::Law]));
        let counts: Vec<usize> =
            derived.energies.iter().map(|fragment| fragment.grouped.constants.len()).collect();
        assert_eq!(counts, [expected, expected], "{kind}");
    }
}

/// EXP-3: a hexahedron of 27 samples under St. Venant–Kirchhoff, cut along all axes, has 54 fragments of forces and 1296 of
/// differentials, and they add up to what is not cut.
#[test]
fn all_fragments_of_the_largest_association_add_up() {
    let kind = ElementKind::Hex8;
    let rule = kind.rules().iter().find(|rule| rule.points.len() == 27).unwrap();
    let element = element_data(kind, rule, MapKind::Box).unwrap();
    let law = compiled(WrittenLaw::find("st_venant_kirchhoff").unwrap());
    let numbers = |name: &str| -> f64 {
        // names of the derivation's own have a mark
        let name = name.trim_start_matches('@');
        // a box along the axes, moved by waves; node and axis stand at the end of a name
        let node = name[1..name.len() - 1].parse().unwrap_or(0);
        let axis = ["x", "y", "z"].iter().position(|axis| name.ends_with(axis)).unwrap_or(0);
        let wave = |phase: f64| 0.1 * (2.0 * node as f64 + 3.0 * axis as f64 + phase).sin();
        match name.chars().next() {
            Some('P') => [1.0, 0.8, 1.3][axis] * kind.element().nodes[node][axis],
            Some('U') => wave(0.3),
            Some('V') => wave(1.7),
            _ if name == "lambda" => 5.0,
            _ => 3.0,
        }
    };
    let sums = |cut: Cut| -> ([usize; 2], [Vec<f64>; 2]) {
        let derived = element.derive(&law, cut);
        let lists = [&derived.forces, &derived.differentials];
        let sums = lists.map(|fragments| {
            let roots: Vec<_> = fragments.iter().flat_map(|fragment| fragment.raw.iter().copied()).collect();
            // leaked: a few hundred numbers for the length of a test
            let values = derived
                .graph
                .evaluate(&roots, |symbol| std::slice::from_ref(Box::leak(Box::new(numbers(&symbol.name)))));
            let mut sum = vec![0.0; fragments[0].raw.len()];
            for fragment in fragments {
                sum.iter_mut().zip(&fragment.raw).for_each(|(sum, expr)| *sum += values.scalar(*expr));
            }
            sum
        });
        (lists.map(Vec::len), sums)
    };
    let (counts, cut) = sums(Cut::of(&[Axis::Law, Axis::Gauss, Axis::Nodes, Axis::Dimension]));
    assert_eq!(counts, [54, 1296]);
    let (_, whole) = sums(Cut::NONE);
    for (cut, whole) in cut.iter().zip(&whole) {
        let scale = whole.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(cut.iter().zip(whole).all(|(a, b)| (a - b).abs() <= 1e-12 * scale), "{cut:?} {whole:?}");
    }
}

/// 27 samples of a hexahedron, two terms: 54 fragments of forces.
#[test]
fn fragments_of_the_largest_association() {
    let kind = ElementKind::Hex8;
    let rule = kind.rules().iter().find(|rule| rule.points.len() == 27).unwrap();
    let element = element_data(kind, rule, MapKind::Box).unwrap();
    let derived = element.derive(
        &compiled(WrittenLaw::find("st_venant_kirchhoff").unwrap()),
        Cut::of(&[Axis::Law, Axis::Gauss]),
    );
    assert_eq!((derived.forces.len(), derived.differentials.len()), (54, 54));
    assert_eq!(derived.name, "Hexa8IDecoupageLG");
}

#[test]
fn names_of_the_source() {
    assert_eq!(source_law_name("linear") + source_name(ElementKind::Hex8), "HookeHexa8I");
    assert_eq!(source_law_name("st_venant_kirchhoff"), "SaintVenant");
    assert_eq!(source_law_name("mooney_rivlin"), "MooneyRivlin");
    assert!(element_data(ElementKind::Tet4, ElementKind::Tet4.default_rule(), MapKind::Box).is_err());
}

/// The files of derived laws are what their texts say, but for how they are laid out.
#[test]
fn derived_laws_are_their_texts() {
    let packed =
        |text: &str| text.split_whitespace().collect::<String>().replace(",)", ")").replace(",}", "}");
    for (name, file) in DERIVED {
        let text = WrittenLaw::find(name).unwrap().text().unwrap();
        let law = EnergyLaw::compile(&text).unwrap();
        let derived = law_kernel(name, &text, &law).unwrap();
        assert!(packed(&derived) == packed(file), "{name}: `cargo xtask kernels`");
    }
}
