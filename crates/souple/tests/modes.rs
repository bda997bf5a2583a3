//! Natural frequencies of the clamped bar against FEniCSx.

use std::process::Command;

/// The first ten frequencies of the reference bar, linear tetrahedra with consistent mass, n = 3 and 6: discrete
/// values of FEniCSx, of which eight digits are trusted.
#[test]
fn frequencies_of_the_clamped_bar() {
    let references = [
        (
            3,
            [
                1.8448100513457297,
                2.052718638365083,
                11.020226413563197,
                12.160117538675095,
                18.205614467846036,
            ],
        ),
        (
            6,
            [
                1.6749007844335804,
                1.7348438971072022,
                10.037517809785989,
                10.375942552685785,
                15.420460092780624,
            ],
        ),
    ];
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cantilever");
    for (n, expected) in references {
        let cells = format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n);
        let output = Command::new(env!("CARGO_BIN_EXE_souple"))
            .args(["modes", scene, "--json", "--count", "5", "--set", &cells])
            .args(["--set", "bodies.bar.material.name=\"linear\""])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let systems: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        for (mode, expected) in expected.iter().enumerate() {
            let hertz = systems[0]["hz"][mode].as_f64().unwrap();
            assert!(
                (hertz / expected - 1.0).abs() < 1e-8,
                "n = {n}, mode {mode}: {hertz} Hz for {expected} Hz"
            );
        }
    }
}
