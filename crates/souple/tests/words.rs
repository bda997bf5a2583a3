//! What the program says: to people in sentences, of wrong requests where they are and what would be right.

use crate::common::{self, CUBE, Folder, souple, souple_in};

/// Meshes are told in sentences; JSON is for those who ask for it.
#[test]
fn meshes_are_told_in_sentences() {
    let folder = Folder::new("sentences");
    let mesh = folder.at("box.msh");
    let told =
        souple(["mesh", "generate", "box", &mesh, "size=1,1,1", "cells=2,2,2", "element=tet4"]).ends(0);
    assert!(told.stdout.contains("box.msh: 27 points, ") && told.stdout.contains(" tet4"), "{told:#?}");
    assert!(!told.stdout.contains(['{', '[', '"']), "{told:#?}");
    // formats of surfaces hold the boundary: 6 sides of 2 x 2 squares of two triangles
    for file in ["box.stl", "box.glb"] {
        let told = souple(["mesh", "convert", &mesh, &folder.at(file)]).ends(0);
        assert!(told.stdout.contains("48 facets") && told.stdout.contains("area"), "{told:#?}");
        assert!(told.stdout.contains("does not keep"), "{told:#?}");
        let told = souple(["mesh", "quality", &mesh, "--json"]).ends(0).json();
        assert_eq!(told["volume"].as_f64().map(|volume| (volume * 1e9).round()), Some(1e9));
    }
}

/// The call that derives a text.
fn derived(text: &str) -> [&str; 5] {
    ["derive", "--law", text, "--element", "tet4"]
}

/// The call that groups a formula.
fn grouped<'a>(formula: &'a str, more: &[&'a str; 2]) -> [&'a str; 5] {
    ["derive", "--group", formula, more[0], more[1]]
}

/// Every wrong word of a command is answered with what would be right.
#[test]
fn wrong_words_are_answered() {
    let folder = Folder::new("words");
    let scene = folder.write("cube.toml", CUBE);
    let text = folder.write("notes.xyz", "nothing");
    let cases: &[(&[&str], &[&str])] = &[
        (&["modes", &scene, "--near", "-3"], &["`--near` is -3 Hz", "at least 0 Hz"]),
        (&["run", &scene, "--steps", "-1"], &["--steps", "a whole number of at least 0"]),
        (&["run", &scene, "--hash-every", "0"], &["--hash-every", "a whole number of at least 1"]),
        (&["describe", ""], &["no name is given"]),
        (&["mesh", "fill", "ellipsoid", "out.msh", "conut=100"], &["did you mean `count`?"]),
        (&["mesh", "quality", &text], &["one of msh"]),
        (
            &["derive", "--law", "m/2*(I1-3)", "--element", "tet4"],
            &["    m/2*(I1-3)\n    ^", "--parameter m="],
        ),
        (&["derive", "--law", "neo_hokean", "--element", "tet4"], &["did you mean `neo_hookean`?"]),
        // laws as text: the term, the sign, the direction, the number that is to blame, with its place
        (
            &derived("mu/2*(I1 - 3) + K*(J - 1)^2; mu = 1 kPa; K = 3 m"),
            &[
                "    mu/2*(I1 - 3) + K*(J - 1)^2\n                    ^^^^^^^^^^^\n",
                "`K*(J - 1)^2` is a length [m]",
                "the parameter in it, `K`, is a length [m]",
            ],
        ),
        (&derived("mu*(E:E); mu = 1 kPa"), &["    mu*(E:E)\n         ^\n", "`A:B` is written `dot(A, B)`"]),
        (
            &derived("mu (J - 1)^2; mu = 1 kPa"),
            &["    mu (J - 1)^2\n    ^^\n", "a `*` is missing, as in `mu * (…)`"],
        ),
        (
            &derived("mu*(J - 1)^2; mu = 0 kPa"),
            &["    mu*(J - 1)^2\n    ^^^^^^^^^^^^\n", "the parameter `mu` is zero"],
        ),
        (&derived("c*(J - 1)^2; c = 10 kpa"), &["`c`: there is no unit `kpa` (did you mean `kPa`?)"]),
        (&derived("c*(J - 1)^2; d = 4/3*c); c = 1"), &["    4/3*c)\n         ^\n"]),
        (&derived("c*(J - 1)^2; c"), &["`c`: there is no `=`"]),
        (
            &derived("c*(I4(a) - 1)^2; c = 1 kPa"),
            &[
                "    c*(I4(a) - 1)^2\n          ^\n",
                "as by `--parameter a=\"[1, 0, 0]\"`",
                "among the parameters, as `a = [",
            ],
        ),
        (
            &derived("c*(I4(a) - 1)^2; c = 1 kPa; a = 2"),
            &["          ^\n", "a direction, a vector such as a parameter"],
        ),
        (
            &grouped("a*x", &["--varying", "X"]),
            &["`X` is said to vary", "did you mean `x`?", "in it are a, x"],
        ),
        (
            &grouped("a*x", &["--emit", "rust"]),
            &["a formula is grouped as text, or as LaTeX", "`--emit latex`"],
        ),
        (&grouped("a*x", &["--cut", "L"]), &["'--group <FORMULA>' cannot be used with '--cut <CUT>'"]),
    ];
    for (call, words) in cases {
        let answer = souple_in(folder.path(), *call).ends(2);
        assert!(words.iter().all(|word| answer.stderr.contains(word)), "{words:?}: {answer:#?}");
    }
    // of one letter every other one is a single edit away
    let unlike = souple(derived("mu*(J - 1)^2 + k*J; mu = 1 kPa")).ends(2);
    assert!(
        unlike.stderr.contains("there is no `k`; there are") && !unlike.stderr.contains("did you mean"),
        "{unlike:#?}"
    );
    for direction in ["1, 0, 0", "(1, 0, 0)", "[1, 0]", "[x, 0, 0]"] {
        let parameter = format!("a={direction}");
        let call = derived("c*(I4(a) - 1)^2; c = 1 kPa");
        let answer = souple(call.iter().copied().chain(["--parameter", &parameter])).ends(2);
        let told = format!("`a`: `{direction}` is no direction");
        assert!(answer.stderr.contains(&told) && answer.stderr.contains("as in [1, 0, 0]"), "{answer:#?}");
    }
    let unreadable = souple(["mesh", "quality", &text]).ends(2);
    assert!(!unreadable.stderr.contains("glb"), "glTF is only written: {unreadable:#?}");
}

/// What a setting made wrong is shown in the setting.
#[test]
fn settings_are_to_blame_for_what_they_make() {
    let folder = Folder::new("blame");
    let scene = folder.write("cube.toml", CUBE);
    for (setting, words) in [
        ("bodies.cube.translate=[1e200, 0, 0]", "lost in the rounding of its positions"),
        ("bodies.cube.mesh.cells=[0, 1, 1]", "three whole numbers of at least 1"),
        ("bodies.cube.mesh.cells=[1000000, 1000000, 1]", "expected fewer cells"),
        ("bodies.cube.material.youngs_modulus=1e300", "is the unit right?"),
        ("world.gravity=[\"1/0\", 0, 0]", "finite"),
        ("parameters.stiffness=3", "the scene has none"),
    ] {
        let answer = souple(["check", &scene, "--set", setting]).ends(2);
        assert!(answer.stderr.starts_with("--set:1:") && answer.stderr.contains(words), "{answer:#?}");
    }
    // an energy is read together with its constants
    let scene_of_text = common::scenes().join("rubber_as_text").display().to_string();
    for setting in ["bodies.block.material.parameters.k=0 Pa", "bodies.block.material.definitions.x=J + 3"] {
        let answer = souple(["check", &scene_of_text, "--set", setting]).ends(2);
        assert!(answer.stderr.contains(&format!("= with --set {setting}")), "{answer:#?}");
    }
    // what is found behind the reading is shown where the scene has the whole, with the setting
    let scene_of_levels = common::scenes().join("octree_cube").display().to_string();
    let setting = "bodies.cube.octree.fixed=\"99\"";
    let answer = souple(["check", &scene_of_levels, "--set", setting]).ends(2);
    assert!(answer.stderr.contains(&format!("= with --set {setting}")), "{answer:#?}");
    let answer = souple(["check", &scene, "--set", "world.period=1e-300"]).ends(2);
    assert!(answer.stderr.contains("periods of 1e-300 s"), "{answer:#?}");
}

/// Help and version in every manner; a scene without a title is called as its file; quiet checks say what is wrong.
#[test]
fn small_courtesies() {
    assert!(souple(["help"]).ends(0).stdout.contains("render"));
    assert_eq!(souple(["--version", "--json"]).ends(0).json()["version"], env!("CARGO_PKG_VERSION"));
    let folder = Folder::new("courtesies");
    let untitled: String =
        CUBE.lines().filter(|line| !line.starts_with("title")).map(|l| format!("{l}\n")).collect();
    let scene = folder.write("falling.toml", untitled);
    assert!(souple(["check", &scene]).ends(0).stdout.starts_with("falling: valid"));
    assert_eq!(souple(["check", &scene, "--quiet"]).ends(0).stdout, "");
    let same = ["compare", &folder.at("a.vtu"), &folder.at("a.vtu")];
    souple(["mesh", "generate", "box", &folder.at("a.vtu"), "size=1,1,1", "cells=1,1,1"]).ends(0);
    assert!(!souple(same).ends(0).stdout.contains("-0"));
}

/// A law as text is described with its moduli at small strain, both ways: λ = 20 kPa and μ = 10 kPa are
/// `E = μ(3λ + 2μ)/(λ + μ) = 80/3 kPa` and `ν = λ/2(λ + μ) = 1/3`.
#[test]
fn laws_are_described_with_their_moduli() {
    let told = souple(["describe", "st_venant_kirchhoff"]).ends(0);
    let line = "at small strain: lambda = 20000 Pa, mu = 10000 Pa; E = 26667 Pa, nu = 0.333333";
    assert!(told.stdout.contains(line), "{told:#?}");
    let pages = souple(["describe", "neo_hookean", "--json"]).ends(0).json();
    let law = pages.as_array().and_then(|pages| pages.iter().find(|page| page["kind"] == "law"));
    let law = law.expect("the law");
    for key in ["energy", "stress", "differential", "stiffness"] {
        assert!(!law[key].is_null(), "`{key}` is not in {law}");
    }
    let moduli = &law["small_strain"];
    let number = |key: &str| moduli[key].as_f64().expect("a number");
    // the tangent at rest is derived by machine, in doubles
    assert!((number("youngs_modulus") / (80e3 / 3.0) - 1.0).abs() < 1e-12, "{moduli}");
    assert!((number("poissons_ratio") - 1.0 / 3.0).abs() < 1e-12, "{moduli}");
}

/// Laws that `derive` knows can be listed and described; their names are those of this program.
#[test]
fn laws_are_listed() {
    for law in souple(["list", "laws", "--json"]).ends(0).json().as_array().expect("laws") {
        let name = law["name"].as_str().expect("a name");
        souple(["describe", name]).ends(0);
        let derived = souple(["derive", "--law", name, "--element", "tet4"]);
        assert_eq!(derived.status, Some(0), "{derived:#?}");
        assert!(
            !derived.stderr.contains("inverted") && !derived.stdout.contains("Decoupage"),
            "{derived:#?}"
        );
    }
}
