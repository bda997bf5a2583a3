//! EXP-35: a bar whose elements change their law at several thresholds, time of a step beside the deviation of its tip.

use super::timing::{Held, Timing, as_it_is, scene, with_threads};
use super::{Effort, Figure, value_of};

/// Periods until no element wants another law.
const PERIODS: u64 = 20;

/// Name of the variant and its criterion.
const VARIANTS: &[(&str, &str)] = &[
    ("all_first", "volume = 1e9"),
    ("length_6", "edge_length = 0.06"),
    ("length_3", "edge_length = 0.03"),
    ("length_1_5", "edge_length = 0.015"),
    ("volume_6", "volume = 0.06"),
    ("volume_3", "volume = 0.03"),
    ("volume_1_5", "volume = 0.015"),
    ("all_second", "edge_length = 1e-9"),
];

pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = |criterion: &str| {
        vec![format!(
            "bodies.bar.adapt={{ material = {{ name = \"st_venant_kirchhoff\", youngs_modulus = 5e6, poissons_ratio = 0.3, density = 1000 }}, back = 0, {criterion} }}"
        )]
    };
    let tip = |settings: &[String]| value_of(scene("adaptive_bar", settings)?, PERIODS, "tip", 1);
    let reference = tip(&settings("edge_length = 1e-9"))?;
    let mut figures = Vec::new();
    for (variant, criterion) in VARIANTS {
        let settings = settings(criterion);
        let held = Held {
            error: (tip(&settings)? / reference - 1.0).abs(),
            error_of: "tip, against the second law everywhere".to_owned(),
            baseline: None,
        };
        let timing = Timing {
            scene: "adaptive_bar",
            settings: &settings,
            prepare: as_it_is,
            warm_up: 0,
            samples: effort.choose(1, 5),
            steps_per_sample: PERIODS as usize,
        };
        let timed = with_threads(1, || timing.sample(1))??;
        figures.push(timed.milliseconds_per_step(&format!("{name}_{variant}"), &held));
    }
    Ok(figures)
}
