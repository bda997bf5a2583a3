//! How well frames bend and turn: the reference bar by every kind of weights, kind of frames and number of frames and points.

use super::frames::tip_of;
use super::timing::scene;
use super::{Effort, Figure};
use crate::Case;

/// Weights of frames.
struct Weights {
    /// What they are called here.
    name: &'static str,
    /// As scenes write them.
    written: &'static str,
    tried: &'static [Grid],
}

/// Frames and the points that they are tried with.
#[derive(Clone, Copy)]
struct Grid {
    /// Along x, y and z.
    frames: [u32; 3],
    /// Cells of the bar along x, y and z, of eight points each.
    cells: [[u32; 3]; 3],
}

const N2: [u32; 3] = [20, 2, 2];
const N4: [u32; 3] = [40, 4, 4];
const N6: [u32; 3] = [60, 6, 6];
const N8: [u32; 3] = [80, 8, 8];

const COARSE: Grid = Grid { frames: [6, 2, 2], cells: [N2, N4, N8] };
const ROW: Grid = Grid { frames: [11, 1, 1], cells: [N2, N4, N8] };
const MIDDLE: Grid = Grid { frames: [11, 2, 2], cells: [N2, N4, N8] };
/// 640 points, three for each, hold affine frames by too little: there is no equilibrium.
const FINE: Grid = Grid { frames: [21, 3, 3], cells: [N4, N6, N8] };

const WEIGHTS: [Weights; 5] = [
    Weights {
        name: "wendland",
        written: r#"{ name = "wendland", support = 2 }"#,
        tried: &[COARSE, ROW, MIDDLE, FINE],
    },
    Weights {
        name: "gaussian",
        written: r#"{ name = "gaussian", support = 1.5 }"#,
        tried: &[COARSE, ROW, MIDDLE, FINE],
    },
    // in a bar all ways are straight, and these are those of `wendland`
    Weights {
        name: "geodesic",
        written: r#"{ name = "geodesic", support = 2 }"#,
        tried: &[COARSE, ROW, MIDDLE],
    },
    // these reach all over the bar: the matrix is full, and of 189 frames it takes minutes
    Weights {
        name: "inverse_distance",
        written: r#"{ name = "inverse_distance" }"#,
        tried: &[COARSE, ROW, MIDDLE],
    },
    Weights { name: "harmonic", written: r#"{ name = "harmonic" }"#, tried: &[COARSE, ROW, MIDDLE] },
];

/// A row of the validation cases, by what figures are held against its reference.
pub fn row(id: &str) -> Result<&'static Case, String> {
    let found = crate::cases(&[id.to_owned()]).map_err(|unknown| format!("there is no row `{unknown}`"))?;
    found.into_iter().next().ok_or_else(|| format!("there is no row `{id}`"))
}

/// A row for each: the error of the tip in per cent, and that of the first frequency of torsion beside it.
pub fn errors(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for weights in &WEIGHTS {
        for kind in ["affine", "rigid"] {
            for Grid { frames, cells } in &weights.tried[..effort.choose(3, weights.tried.len())] {
                for cells in &cells[..effort.choose(1, 3)] {
                    figures.push(error_of(name, weights, kind, *frames, *cells)?);
                }
            }
        }
    }
    Ok(figures)
}

fn error_of(
    name: &str,
    weights: &Weights,
    kind: &str,
    frames: [u32; 3],
    cells: [u32; 3],
) -> Result<Figure, String> {
    let numbers = |values: [u32; 3]| format!("[{}, {}, {}]", values[0], values[1], values[2]);
    let mut settings = vec![
        format!("bodies.bar.mesh.cells={}", numbers(cells)),
        format!("bodies.bar.frames.placement={{ name = \"grid\", counts = {} }}", numbers(frames)),
        format!("bodies.bar.frames.weights={}", weights.written),
        format!("bodies.bar.frames.kind=\"{kind}\""),
    ];
    let built = scene("frames_cantilever", &settings)?;
    let report = built.bodies[0].frames.as_ref().map(|frames| frames.report).unwrap_or_default();
    let [x, y, z] = frames;
    let named = format!("{name}.{kind}.{}.{x}x{y}x{z}.{}", weights.name, report.points);
    let told = |error: String| format!("{named}: {error}");
    let (of_tip, of_torsion) = (row("frames_bar_affine")?, row("frames_bar_torsion")?);
    let tip = tip_of(built, 1).map_err(told)?;
    settings.extend(of_torsion.settings.iter().map(|setting| (*setting).to_owned()));
    let modes = souple_run::natural_frequencies(scene("frames_cantilever", &settings)?, 1, 0.0)
        .map_err(|error| told(error.to_string()))?;
    let lowest = modes.first().and_then(|system| system.hertz.first());
    let torsion = *lowest.ok_or("the bar has no such frequency")?;
    Ok(Figure {
        value: 100.0 * (tip / of_tip.reference - 1.0).abs(),
        by_processor: None,
        unit: "% of the tip",
        higher_is_better: false,
        error: (torsion / of_torsion.reference - 1.0).abs(),
        error_of: format!(
            "first frequency of torsion, {torsion:.4} Hz, FEniCSx; {:.0} points a frame, {:.1} frames have a say at a point",
            report.points as f64 / report.frames as f64,
            report.effective
        ),
        baseline: None,
        threads: rayon::current_num_threads(),
        samples: 1,
        spread: 0.0,
        bytes: 0,
        name: named,
    })
}
