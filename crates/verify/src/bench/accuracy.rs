//! EXP-28: the same accuracy by hexahedra and by tetrahedra, and what it costs.

use super::timing::{Held, Timing, as_it_is, scene, with_threads};
use super::{Effort, Figure, value_of};

/// Tip of the beam of EXP-27 in the limit of fine meshes [m].
const LIMIT: f64 = -0.6072;

/// Element and cubes along and across, ever finer.
const MESHES: &[(&str, [u32; 2])] = &[
    ("hex8", [24, 4]),
    ("hex8", [48, 8]),
    ("hex8", [60, 10]),
    ("tet4", [32, 4]),
    ("tet4", [48, 6]),
    ("tet4", [64, 8]),
    ("tet4", [96, 12]),
];

pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    let count = |element: &str| effort.choose(2, MESHES.iter().filter(|(kind, _)| *kind == element).count());
    for element in ["hex8", "tet4"] {
        let meshes = MESHES.iter().filter(|(kind, _)| *kind == element).take(count(element));
        for (_, [along, across]) in meshes {
            let settings = [
                format!("bodies.bar.mesh.cells=[{along}, {across}, {across}]"),
                format!("bodies.bar.mesh.element=\"{element}\""),
            ];
            let tip = value_of(scene("long_beam", &settings)?, 1, "tip", 1)?;
            let held = Held {
                error: (tip / LIMIT - 1.0).abs(),
                error_of: "tip in the limit of fine meshes".to_owned(),
                baseline: None,
            };
            let timing = Timing {
                scene: "long_beam",
                settings: &settings,
                prepare: as_it_is,
                warm_up: 0,
                samples: 1,
                steps_per_sample: 1,
            };
            let mut timed = with_threads(1, || timing.sample(1))??;
            for _ in 1..effort.choose(1, 3) {
                timed.seconds.extend(with_threads(1, || timing.sample(1))??.seconds);
            }
            let seconds = timed.seconds.clone();
            let name = format!("{name}_{element}_{along}x{across}x{across}");
            figures.push(timed.figure(&name, seconds, &held, ("s", false)));
        }
    }
    Ok(figures)
}
