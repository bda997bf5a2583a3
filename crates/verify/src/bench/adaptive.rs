//! EXP-35: bodies whose elements change their law at several thresholds, time of a step beside the deviation of what they do from a body
//! that has the second law everywhere and adapts nothing.
//!
//! The source's pair, Hooke's and St. Venant–Kirchhoff's laws, at equilibrium, and in explicit steps with the 27 samples of a
//! hexahedron that the second takes and with the usual eight; and Hooke's law with Ogden's, which costs ten times as much.

use super::timing::{Held, Timed, in_turn, scene};
use super::{Effort, Figure, value_of};

/// How many times faster than under the second law everywhere a body must be that is off by 5 % at most.
const SAVING: f64 = 2.0;

/// A lower threshold takes longer in explicit steps, which all cost their forces alone (EXP-35).
const NO_FASTER: f64 = 1.0;

/// The variant without a second law: the body of the second alone.
const PLAIN: &str = "plain_second";

/// A scene whose elements change their law.
struct Adapting {
    name: &'static str,
    scene: &'static str,
    /// Periods until no element wants another law.
    periods: u64,
    /// Whose second component is compared.
    probe: &'static str,
    /// Of all variants.
    settings: &'static [&'static str],
    /// Name of the body, and the material of its second law.
    body: &'static str,
    second: &'static str,
    /// Probes of what a body without a second law has not.
    of_laws: &'static [&'static str],
    /// Name of the variant and its criterion.
    variants: &'static [(&'static str, &'static str)],
    /// The variant that must save time.
    saving: Option<&'static str>,
}

const BENT: Adapting = Adapting {
    name: "bent",
    scene: "adaptive_bar",
    periods: 20,
    probe: "tip",
    settings: &[],
    body: "bar",
    of_laws: &["second_law", "at_the_free_end", "at_the_clamp", "excess"],
    second: "{ name = \"st_venant_kirchhoff\", youngs_modulus = 5e6, poissons_ratio = 0.3, density = 1000 }",
    variants: &[
        ("all_first", "volume = 1e9"),
        ("length_6", "edge_length = 0.06"),
        ("length_3", "edge_length = 0.03"),
        ("length_1_5", "edge_length = 0.015"),
        ("volume_6", "volume = 0.06"),
        ("volume_3", "volume = 0.03"),
        ("volume_1_5", "volume = 0.015"),
    ],
    saving: None,
};

const PRESSED: Adapting = Adapting {
    name: "pressed",
    scene: "pressed_pad",
    periods: 500,
    probe: "press",
    settings: &[],
    body: "pad",
    of_laws: &["second_law"],
    second: "{ name = \"ogden\", mu = [9615.4, -9615.4], alpha = [4, -4], bulk_modulus = 83333, density = 1000 }",
    variants: &[
        ("all_first", "edge_length = 1e9"),
        ("length_20", "edge_length = 0.2"),
        ("length_15", "edge_length = 0.15"),
        ("length_10", "edge_length = 0.1"),
        ("length_6", "edge_length = 0.06"),
        ("volume_10", "volume = 0.1"),
    ],
    saving: Some("length_10"),
};

const PULLED: Adapting = Adapting {
    name: "pulled",
    scene: "pulled_pad",
    periods: 500,
    probe: "pull",
    settings: &[],
    body: "pad",
    of_laws: &["second_law"],
    second: "{ name = \"st_venant_kirchhoff\", youngs_modulus = 1e5, poissons_ratio = 0.3, density = 1000 }",
    variants: &[
        ("all_first", "edge_length = 1e9"),
        ("length_20", "edge_length = 0.2"),
        ("length_14", "edge_length = 0.14"),
        ("length_12", "edge_length = 0.12"),
        ("length_10", "edge_length = 0.1"),
        ("length_6", "edge_length = 0.06"),
    ],
    saving: Some("length_14"),
};

/// The gravity test.
const HUNG: Adapting = Adapting {
    name: "hung",
    scene: "hung_block",
    // the swing when the weight comes has gone by then
    periods: 1000,
    probe: "bottom",
    settings: &[],
    body: "block",
    of_laws: &["second_law"],
    second: "{ name = \"st_venant_kirchhoff\", youngs_modulus = 6e4, poissons_ratio = 0.3, density = 1000 }",
    variants: &[
        ("all_first", "edge_length = 1e9"),
        ("length_20", "edge_length = 0.2"),
        ("length_15", "edge_length = 0.15"),
        ("length_10", "edge_length = 0.1"),
        ("length_6", "edge_length = 0.06"),
    ],
    saving: Some("length_20"),
};

const PULLED_BY_EIGHT: Adapting = Adapting {
    name: "pulled_by_eight",
    settings: &["bodies.pad.quadrature=\"default\""],
    variants: &[
        ("all_first", "edge_length = 1e9"),
        ("length_20", "edge_length = 0.2"),
        ("length_12", "edge_length = 0.12"),
        ("length_6", "edge_length = 0.06"),
    ],
    saving: None,
    ..PULLED
};

pub fn table(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for body in [BENT, HUNG, PRESSED, PULLED, PULLED_BY_EIGHT] {
        figures.extend(body.figures(name, effort)?);
    }
    Ok(figures)
}

impl Adapting {
    fn figures(&self, name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
        let read = |settings: &[String]| value_of(scene(self.scene, settings)?, self.periods, self.probe, 1);
        let mut measured: Vec<(&str, f64, Timed)> = Vec::new();
        let adapt = |criterion: &str| {
            vec![format!(
                "bodies.{}.adapt={{ material = {}, back = 0, {criterion} }}",
                self.body, self.second
            )]
        };
        let own = [
            format!("bodies.{}.adapt=", self.body),
            format!("bodies.{}.material={}", self.body, self.second),
        ];
        let plain = self.of_laws.iter().map(|probe| format!("probes.{probe}=")).chain(own).collect();
        let adapting = self.variants.iter().map(|(variant, criterion)| (*variant, adapt(criterion)));
        let variants: Vec<(&str, Vec<String>)> = adapting
            .chain([(PLAIN, plain)])
            .map(|(variant, settings)| {
                let all =
                    settings.into_iter().chain(self.settings.iter().map(|setting| (*setting).to_owned()));
                (variant, all.collect())
            })
            .collect();
        let settings: Vec<Vec<String>> = variants.iter().map(|(_, settings)| settings.clone()).collect();
        // each from the start: later, every element has the law that it keeps
        let timed = in_turn(self.scene, &settings, self.periods as usize, effort.choose(1, 5))?;
        for ((variant, settings), timed) in variants.iter().zip(timed) {
            measured.push((variant, read(settings)?, timed));
        }
        let Some((_, reference, everywhere)) = measured.last() else { return Ok(Vec::new()) };
        let is_length = |variant: &str| variant.starts_with("length");
        let (mut figures, mut before) = (Vec::new(), None::<(&str, &Timed)>);
        for (variant, value, timed) in &measured {
            let error_of = format!("{}, against a body of the second law", self.probe);
            let held = |baseline| Held {
                error: (value / reference - 1.0).abs(),
                error_of: error_of.clone(),
                baseline,
            };
            let row = format!("{name}_{}_{variant}", self.name);
            figures.push(timed.milliseconds_per_step(&row, &held(None)));
            // of lengths, which fall
            if let Some((before, faster)) = before.filter(|_| is_length(variant)) {
                let longer = format!("{row}_longer_than_{before}");
                let wanted = self.saving.map(|_| NO_FASTER);
                figures.push(faster.times_as_fast(&longer, timed, &held(wanted)));
            }
            before = is_length(variant).then_some((*variant, timed));
            if *variant != PLAIN {
                let wanted = (self.saving == Some(*variant)).then_some(SAVING);
                figures.push(timed.times_as_fast(&format!("{row}_saving"), everywhere, &held(wanted)));
            }
        }
        Ok(figures)
    }
}
