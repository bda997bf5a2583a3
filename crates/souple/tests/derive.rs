//! `souple derive`: what can be derived is listed, and written as counts, files and programs.

use crate::common::{Folder, souple};

/// EXP-2, tables 3.4 to 3.7: the counts of the source stand beside ours, cut and whole, and ours are no more.
#[test]
fn counts_stand_beside_those_of_the_source() {
    for (law, element, more, expected) in [
        ("linear", "tri3", &["--cut", "LG"][..], &[5, 7][..]),
        ("st_venant_kirchhoff", "tet4", &["--cut", "LG"], &[10, 10]),
        ("linear", "tet4", &[], &[11]),
        ("linear", "prism6", &[], &[77]),
        ("linear", "pyramid5", &["--rule", "gauss_5"], &[71]),
        ("linear", "hex8", &["--map", "box"], &[40]),
        ("linear", "hex8", &["--map", "box", "--cut", "G"], &[8, 13, 13, 12, 12, 13, 13, 8]),
        ("st_venant_kirchhoff", "prism6", &["--cut", "LG"], &[16; 12]),
    ] {
        let call = ["derive", "--law", law, "--element", element, "--json"];
        let document = souple(call.iter().chain(more)).ends(0).json();
        assert_eq!(document["source_constants_by_fragment"], serde_json::json!(expected), "{law} {element}");
        let ours = document["on_element"]["energy"]["constants_by_fragment"].as_array().expect("counts");
        assert_eq!(ours.len(), expected.len(), "{law} {element} {more:?}");
        for (ours, source) in ours.iter().zip(expected) {
            assert!(
                ours.as_u64().is_some_and(|ours| ours <= *source),
                "{law} {element} {more:?}: {ours} {source}"
            );
        }
    }
}

/// The counts that the theory tells are those that are printed: written out and in tensors.
#[test]
fn counts_are_those_of_the_theory() {
    let theory = include_str!("../../../docs/theory.md");
    let with_commas = |count: u64| match count {
        1000.. => format!("{},{:03}", count / 1000, count % 1000),
        _ => count.to_string(),
    };
    let counts = |law: &str, element: &str, more: &[&str]| {
        let call = ["derive", "--law", law, "--element", element, "--json"];
        let document = souple(call.iter().chain(more)).ends(0).json();
        let of = |value: &serde_json::Value| value.as_u64().map(with_commas).expect("a count");
        let (whole, tensors) = (&document["on_element"], &document["in_tensors"]);
        let written = |quantity: &str| of(&whole[quantity]["operations_per_step"]);
        let constants = of(&tensors["constants"]);
        [
            written("forces"),
            written("differential"),
            of(&tensors["forces"]),
            of(&tensors["differential"]),
            constants,
        ]
    };
    let law = "st_venant_kirchhoff";
    let tet = counts(law, "tet4", &[]);
    let others = [
        counts(law, "pyramid5", &["--rule", "gauss_5"]),
        counts(law, "hex8", &["--map", "box"]),
        counts(law, "prism6", &[]),
    ];
    let of = |index: usize| others.each_ref().map(|counts| counts[index].clone());
    let [pyramid, hex, prism] = of(1);
    let [pyramid_run, hex_run, prism_run] = of(3);
    for sentence in [
        format!(
            "takes {} operations on a tetrahedron, {pyramid} on a pyramid of five samples, {hex} on a box of eight and {prism} on a prism of six",
            tet[1]
        ),
        format!("these are {}, {pyramid_run}, {hex_run} and {prism_run}", tet[3]),
        format!("forces of a tetrahedron take {} operations written out and {} in tensors", tet[0], tet[2]),
    ] {
        let words = theory.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&sentence), "{sentence}");
    }
    // nine of the map, and λ and μ with the weight
    assert_eq!(tet[4], "11");
}

/// One file for the constants of each fragment and one for each node and axis, with the source's names; the fragments of the
/// differential are cut along nodes and directions too.
#[test]
fn expressions_are_written_as_files() {
    let folder = Folder::new("derive");
    let out = folder.at("out");
    let call = ["derive", "--law", "linear", "--element", "tri3", "--cut", "LN", "--out", &out];
    souple(call).ends(0);
    let files = folder.files();
    // two terms: two fragments of forces, and six of differentials, each with its constants and six expressions
    assert_eq!(files.len(), 8 * 7, "{files:?}");
    for name in
        ["FHookeTriangleDecoupageLN0_0x", "dFHookeTriangleDecoupageLN5_2y", "ECR_dFHookeTriangleDecoupageLN4"]
    {
        let text = std::fs::read_to_string(folder.path().join(format!("out/{name}.txt"))).expect("a file");
        assert_eq!(text.contains("D_0 = "), name.starts_with("ECR"), "{text}");
    }
    let force =
        std::fs::read_to_string(folder.path().join("out/FHookeTriangleDecoupageLN0_0x.txt")).expect("a file");
    // what is constant is not in what is left for every step
    assert!(
        force.contains("U0x") && force.contains("D_") && !force.contains('P') && !force.contains("mu"),
        "{force}"
    );
}

/// EXP-5: every association is listed, with the command that derives it; one of each law is derived so.
#[test]
fn associations_are_listed_and_can_be_derived() {
    let list = souple(["derive", "--list", "--element", "tri6", "--json"]).ends(0).json();
    let list = list.as_array().expect("a list");
    assert!(list.len() >= 16 * 2 * 8, "{}", list.len());
    let mut laws: Vec<&str> = Vec::new();
    for association in list {
        let law = association["law"].as_str().expect("a law");
        if laws.contains(&law) {
            continue;
        }
        laws.push(law);
        let command = association["command"].as_str().expect("a command");
        let answer = souple(command.split(' ').skip(1));
        assert_eq!(answer.status, Some(0), "{answer:#?}");
    }
    assert!(laws.len() >= 8, "{laws:?}");
}

/// The nine steps of the source as a program, from data alone: of quadratic elements, boxes and laws of the user too.
#[test]
fn the_derivation_is_written_as_a_program() {
    for (law, element, more) in [
        ("linear", "tri3", &[][..]),
        ("st_venant_kirchhoff", "hex8", &["--map", "box"]),
        ("neo_hookean", "tet10", &[]),
        ("ogden", "tet4", &[]),
        ("m/2*(I1 - 3) - m*log(J) + m*(J - 1)^2", "quad4", &["--parameter", "m=1 kPa"]),
    ] {
        let call = ["derive", "--law", law, "--element", element, "--emit", "maxima"];
        let program = souple(call.iter().chain(more)).ends(0).stdout;
        for step in 1..=9 {
            assert!(program.contains(&format!("/* {step}. ")), "{law} on {element}: step {step}");
        }
        // each statement ends where it should
        let open = program.matches('(').count();
        assert_eq!(open, program.matches(')').count(), "{law} on {element}");
    }
}

/// Laws in principal stretches are told, counted and written as all others, with the functions behind them that they call.
#[test]
fn laws_of_stretches_are_written_too() {
    for law in ["ogden", "corotational", "m*(log(l1)^2 + log(l2)^2 + log(l3)^2); m = 1 kPa"] {
        let call = ["derive", "--law", law, "--element", "tet4"];
        let told = souple(call).ends(0).stdout;
        for part in ["stress, dPsi/dF", "in tensors: forces", "grouped constants", "code: Rust"] {
            assert!(told.contains(part), "{told}");
        }
        for language in ["rust", "wgsl"] {
            let code = souple(call.iter().chain(&["--emit", language])).ends(0).stdout;
            for part in ["fn constants(", "fn forces(", "fn force_differential(", "fn decompose(matrix"] {
                assert!(code.contains(part), "{code}");
            }
        }
    }
}

/// The text of a law, as it is listed and described, is read as it stands and is the law of that name.
#[test]
fn laws_are_read_as_they_are_printed() {
    let derived = |law: &str| {
        let told = souple(["derive", "--law", law, "--element", "tet4"]).ends(0).stdout;
        let end = told.find("\non tet4").expect("the element");
        told[..end].to_owned()
    };
    let list = souple(["list", "laws"]).ends(0).stdout;
    for law in souple(["list", "laws", "--json"]).ends(0).json().as_array().expect("laws") {
        let (name, text) = (law["name"].as_str().expect("a name"), law["text"].as_str().expect("a text"));
        assert!(
            list.lines().any(|line| line.starts_with(name) && line.ends_with(&format!(": {text}"))),
            "{list}"
        );
        let page = souple(["describe", name]).ends(0).stdout;
        assert!(page.contains(&format!("\n  as text: {text}\n")), "{page}");
        assert_eq!(derived(text), derived(name), "{name}");
    }
    // numbers by themselves, in quotes, and beside the text
    let whole = derived("c*x; x = (J - 1)^2; c = 2 kPa");
    assert_eq!(derived("c*x; c = \"2 kPa\"; x = (J - 1)^2;"), whole);
    let apart = ["--define", "x=(J - 1)^2", "--parameter", "c=2 kPa"];
    let call = ["derive", "--law", "c*x", "--element", "tet4"];
    assert!(souple(call.iter().chain(&apart)).ends(0).stdout.starts_with(&whole));
}

/// A formula is grouped as text and as LaTeX, with the parts that its constants share.
#[test]
fn formulas_are_grouped() {
    let formula = "sin(a + b + c)*(a + b + c)*x + p*y";
    let call = ["derive", "--group", formula, "--varying", "x", "--varying", "y"];
    let told = souple(call).ends(0).stdout;
    assert_eq!(told, "t0 = a + b + c\nD_0 = t0*sin(t0)\nD_1 = p\nx*D_0 + y*D_1\n");
    let latex = souple(call.iter().chain(&["--emit", "latex"])).ends(0).stdout;
    for line in ["t_{0} = a + b + c\n", "D_{0} = t_{0}\\,\\sin\\left(t_{0}\\right)\n"] {
        assert!(latex.contains(line), "{latex}");
    }
    let document = souple(call.iter().chain(&["--json"])).ends(0).json();
    assert_eq!(document["parts"], serde_json::json!(["t0 = a + b + c"]));
    assert_eq!(document["constants"]["D_0"], "t0*sin(t0)");
}

/// `describe` prints energy, stress and tangent of every law, and of every element its nodes, corners, edges, faces and rules.
#[test]
fn laws_and_elements_are_described() {
    for law in souple(["list", "laws", "--json"]).ends(0).json().as_array().expect("laws") {
        let name = law["name"].as_str().expect("a name");
        let page = souple(["describe", name]).ends(0).stdout;
        for expression in ["  Psi = ", "  P = ", "  dP = "] {
            assert!(page.contains(expression), "{name}: {page}");
        }
    }
    let page = souple(["describe", "pyramid5"]).ends(0).stdout;
    assert!(page.contains("gauss_5 (degree 2)"), "{page}");
    let page = souple(["describe", "tri6"]).ends(0).stdout;
    for set in [
        "dimension 2; nodes in the reference cell: 0 (0, 0), 1 (1, 0), 2 (0, 1), 3 (0.5, 0), 4 (0.5, 0.5), 5 (0, 0.5)",
        "corners: 0 to 2; edges between corners: 0 1, 1 2, 2 0",
        "sides, outward: edge3 of 0 1 3, edge3 of 1 2 4, edge3 of 2 0 5",
    ] {
        assert!(page.contains(set), "{page}");
    }
}

/// Options that would change nothing, numbers out of range, and arguments that are no text are answered as wrong requests.
#[test]
fn what_would_change_nothing_is_refused() {
    for call in [
        &["derive", "--check", "--emit", "rust"][..],
        &["derive", "--check", "--out", "somewhere"],
        &["derive", "--check", "--cut", "all"],
        &["derive", "--list", "--emit", "rust"],
        &["derive", "--check", "--law", "linear", "--element", "tri3", "--step", "0"],
        &["derive", "--check", "--law", "linear", "--element", "tri3", "--step", "nan"],
        &["derive", "--check", "--law", "linear", "--element", "tri3", "--fault", "inf"],
    ] {
        souple(call).ends(2);
    }
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        let no_text = std::ffi::OsStr::from_bytes(b"c\xff");
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_souple"));
        let ended =
            command.args(["derive", "--element", "tet4", "--law"]).arg(no_text).output().expect("run");
        assert_eq!(ended.status.code(), Some(2), "{ended:?}");
        assert!(!String::from_utf8_lossy(&ended.stderr).contains("panicked"), "{ended:?}");
    }
}
