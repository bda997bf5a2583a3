//! How well frames bend and turn: the reference bar by every kind of weights, kind and number of frames and points.

use super::timing::scene;
use super::{Effort, Figure, value_of};

/// Tip of the reference bar in equilibrium under its weight, St. Venant-Kirchhoff [m]; FEniCSx, quadratic hexahedra, fitted limit.
const TIP: f64 = -0.144_982_917_950_976_7;
/// Its first natural frequency of torsion [Hz]; the same.
const TORSION: f64 = 14.262_434_014_307_647;

/// Weights as scenes write them, and what they are called here.
const WEIGHTS: [(&str, &str); 5] = [
    ("wendland", r#"{ name = "wendland", support = 2 }"#),
    ("gaussian", r#"{ name = "gaussian", support = 1.5 }"#),
    ("inverse_distance", r#"{ name = "inverse_distance" }"#),
    ("harmonic", r#"{ name = "harmonic" }"#),
    ("geodesic", r#"{ name = "geodesic", support = 2 }"#),
];

/// Frames along x, y and z.
const FRAMES: [[u32; 3]; 4] = [[6, 2, 2], [11, 1, 1], [11, 2, 2], [21, 3, 3]];
/// Cells of the bar along x, y and z, of eight points each.
const CELLS: [[u32; 3]; 2] = [[20, 2, 2], [40, 4, 4]];

/// A row for each: the error of the tip in per cent, and that of the first frequency of torsion beside it.
pub fn errors(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for (weights, written) in WEIGHTS {
        for kind in ["affine", "rigid"] {
            for frames in &FRAMES[..effort.choose(3, 4)] {
                for cells in &CELLS[effort.choose(1, 0)..] {
                    figures.push(error_of(name, [weights, written, kind], *frames, *cells)?);
                }
            }
        }
    }
    Ok(figures)
}

fn error_of(
    name: &str,
    [weights, written, kind]: [&str; 3],
    frames: [u32; 3],
    cells: [u32; 3],
) -> Result<Figure, String> {
    let numbers = |values: [u32; 3]| format!("[{}, {}, {}]", values[0], values[1], values[2]);
    let settings = vec![
        format!("bodies.bar.mesh.cells={}", numbers(cells)),
        format!("bodies.bar.frames.placement={{ name = \"grid\", counts = {} }}", numbers(frames)),
        format!("bodies.bar.frames.weights={written}"),
        format!("bodies.bar.frames.kind=\"{kind}\""),
    ];
    let built = scene("frames_cantilever", &settings)?;
    let report = built.bodies[0].frames.as_ref().map(|frames| frames.report).unwrap_or_default();
    let tip = value_of(built, 1, "tip", 1)?;
    let modes = souple_run::natural_frequencies(scene("frames_cantilever", &settings)?, 5, 0.0)
        .map_err(|error| error.to_string())?;
    let hertz = modes.first().map(|system| system.hertz.as_slice()).unwrap_or_default();
    // behind two pairs of bending: the fifth
    let torsion = *hertz.get(4).ok_or("the bar has no such frequency")?;
    Ok(Figure {
        name: format!("{name}.{kind}.{weights}.{}x{}x{}.{}", frames[0], frames[1], frames[2], report.points),
        value: 100.0 * (tip / TIP - 1.0).abs(),
        by_processor: None,
        unit: "% of the tip",
        higher_is_better: false,
        error: (torsion / TORSION - 1.0).abs(),
        error_of: format!(
            "first frequency of torsion, {torsion:.4} Hz, FEniCSx; {:.1} frames have a say at a point",
            report.effective
        ),
        baseline: None,
        threads: rayon::current_num_threads(),
        samples: 1,
        spread: 0.0,
        bytes: 0,
    })
}
