//! EXP-28: the same accuracy by hexahedra and by tetrahedra, and what it costs.

use super::timing::{Held, Timing, as_it_is, median, scene, with_threads};
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

/// Up to which error of the tip hexahedra must be the cheaper way to it (EXP-28).
const LARGEST_ERROR: f64 = 0.05;

pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    // error and seconds of the processor of every mesh, hexahedra first
    let mut curves: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
    let count = |element: &str| effort.choose(2, MESHES.iter().filter(|(kind, _)| *kind == element).count());
    for (element, curve) in ["hex8", "tet4"].into_iter().zip(&mut curves) {
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
                let again = with_threads(1, || timing.sample(1))??;
                timed.seconds.extend(again.seconds);
                timed.processor.extend(again.processor);
            }
            let spent = if timed.processor.is_empty() { &timed.seconds } else { &timed.processor };
            curve.push((held.error, median(spent.clone()).0));
            let seconds = timed.seconds.clone();
            let name = format!("{name}_{element}_{along}x{across}x{across}");
            figures.push(timed.figure(&name, seconds, &held, ("s", false)));
        }
    }
    let [hexahedra, tetrahedra] = &curves;
    // only with full effort there are more meshes of tetrahedra than of hexahedra
    let finest = tetrahedra.last().filter(|_| tetrahedra.len() > count("hex8"));
    for (error, seconds) in hexahedra.iter().filter(|(error, _)| *error < LARGEST_ERROR) {
        // the first tetrahedra that are as right; where none are, the finest take less than those would
        let as_right = tetrahedra.iter().find(|(other, _)| other <= error).or(finest);
        let Some((other, longer)) = as_right else { continue };
        figures.push(Figure {
            by_processor: None,
            name: format!("{name}_tet4_over_hex8_at_{:.1}_percent", 100.0 * error),
            value: longer / seconds,
            unit: "x hex8",
            higher_is_better: true,
            error: *other,
            error_of: "tip by the tetrahedra in the limit of fine meshes".to_owned(),
            baseline: Some(1.0),
            threads: 1,
            samples: effort.choose(1, 3),
            spread: 0.0,
            bytes: 0,
        });
    }
    Ok(figures)
}
