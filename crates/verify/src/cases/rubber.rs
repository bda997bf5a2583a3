//! Mooney–Rivlin's, Yeoh's and Ogden's rubber in uniaxial and in equibiaxial stretch, against closed forms.
//!
//! With the stretches `s`, `J = s₁ s₂ s₃` and `β_i = Σ_p μ_p (J^(-1/3) s_i)^α_p`, the stress is
//! `P_i = (β_i - β̄ + k J (J - 1))/s_i`, `β̄` the mean of the three; Mooney–Rivlin's law has the terms `(2 c₁₀, 2)` and
//! `(-2 c₀₁, -2)`; Yeoh's slope `Σ n c_n x^(n-1)` stands for `c₁₀`. The stretch along the directions left
//! free is the root of `P = 0` there. References are to 30 digits.

use crate::{Case, Reading, Tolerance};

const STATIC: &str =
    r#"systems.main.stepper={ name = "static", newton_tolerance = 1e-12, solver_tolerance = 1e-13 }"#;
const TO_FOUR: &str = "parameters.stretch=4";
const TO_LESS: &str = "parameters.stretch=0.6";
const STRIP_OF_OGDEN: &str = r#"bodies.strip.material={ name = "ogden", mu = [6.3e5, 1.2e3, -1e4], alpha = [1.3, 5, -2], bulk_modulus = 8e6, density = 1000 }"#;
const STRIP_OF_YEOH: &str = r#"bodies.strip.material={ name = "yeoh", c1 = 2.5e5, c2 = -5e3, c3 = 500, bulk_modulus = 9e6, density = 1000 }"#;
const SHEET_OF_MOONEY: &str = r#"bodies.sheet.material={ name = "mooney_rivlin", c10 = 2e5, c01 = 5e4, bulk_modulus = 9e6, density = 1000 }"#;

/// Cross-section at rest [m²].
const STRIP: f64 = 0.05 * 0.05;
const SHEET: f64 = 0.1 * 0.02;

const PULLED: Case = Case {
    id: "",
    capabilities: &["FAU-29"],
    what: "",
    scene: "rubber_pulled",
    settings: &[],
    reading: Reading::component("pull", 0),
    refinement: None,
    reference: f64::NAN,
    // Newton's method leaves 1e-12 of the largest force, and free sides are less than a hundred times as soft as what is pulled: 18 times
    // at rest, the bulk modulus over the shear modulus
    tolerance: Tolerance::Relative(1e-10),
    source: "closed form; Holzapfel 2000, Nonlinear Solid Mechanics, §6.5",
    mutation: "bodies.strip.material.bulk_modulus=8.5e6",
};

const SPREAD: Case =
    Case { scene: "rubber_spread", mutation: "bodies.sheet.material.bulk_modulus=8.5e6", ..PULLED };

pub(super) const CASES: &[Case] = &[
    Case {
        id: "mooney_uniaxial",
        what: "pull of Mooney–Rivlin's strip at stretch 2",
        reference: STRIP * 756_431.740_878_207_3,
        ..PULLED
    },
    Case {
        id: "mooney_uniaxial_midway",
        what: "the same midway, at stretch 1.5: the path of equilibria",
        reading: Reading::component("pull", 0).after(10),
        reference: STRIP * 479_538.344_289_181_4,
        ..PULLED
    },
    Case {
        id: "mooney_uniaxial_static",
        what: "the same by `static`, which knows no time",
        settings: &[STATIC],
        reading: Reading::component("pull", 0).after(10),
        reference: STRIP * 479_538.344_289_181_4,
        ..PULLED
    },
    Case {
        id: "mooney_uniaxial_side",
        what: "how far its side comes in at stretch 2",
        reading: Reading::component("side", 1),
        reference: 0.05 * (0.725_672_644_308_085_1 - 1.0),
        ..PULLED
    },
    Case {
        id: "mooney_uniaxial_pressed",
        what: "push of the same strip at stretch 0.6",
        settings: &[TO_LESS],
        reference: STRIP * -1_209_699.251_085_185,
        ..PULLED
    },
    Case {
        id: "ogden_uniaxial",
        what: "pull of Ogden's strip at stretch 4",
        settings: &[STRIP_OF_OGDEN, TO_FOUR],
        reference: STRIP * 1_081_417.544_523_993_5,
        ..PULLED
    },
    Case {
        id: "ogden_uniaxial_side",
        what: "how far its side comes in",
        settings: &[STRIP_OF_OGDEN, TO_FOUR],
        reading: Reading::component("side", 1),
        reference: 0.05 * (0.537_569_523_942_468_8 - 1.0),
        ..PULLED
    },
    Case {
        id: "ogden_uniaxial_pressed",
        what: "push of Ogden's strip at stretch 0.6",
        settings: &[STRIP_OF_OGDEN, TO_LESS],
        reference: STRIP * -951_706.622_836_365_6,
        ..PULLED
    },
    Case {
        id: "ogden_equibiaxial",
        what: "pull of Ogden's sheet at stretch 2 both ways",
        reference: SHEET * 766_801.829_173_303_8,
        ..SPREAD
    },
    Case {
        id: "ogden_equibiaxial_static",
        what: "the same by `static`",
        settings: &[STATIC],
        reference: SHEET * 766_801.829_173_303_8,
        ..SPREAD
    },
    Case {
        id: "ogden_equibiaxial_face",
        what: "how thin it gets",
        reading: Reading::component("face", 2),
        reference: 0.02 * (0.278_663_655_604_988_7 - 1.0),
        ..SPREAD
    },
    Case {
        id: "yeoh_uniaxial",
        what: "pull of Yeoh's strip at stretch 2, by a law derived from its text",
        settings: &[STRIP_OF_YEOH],
        reference: STRIP * 792_145.189_290_046_7,
        ..PULLED
    },
    Case {
        id: "yeoh_uniaxial_far",
        what: "the same at stretch 4, where it has stiffened",
        settings: &[STRIP_OF_YEOH, TO_FOUR],
        reference: STRIP * 2_203_301.231_271_049,
        ..PULLED
    },
    Case {
        id: "mooney_equibiaxial",
        what: "pull of Mooney–Rivlin's sheet at stretch 2 both ways",
        settings: &[SHEET_OF_MOONEY],
        reference: SHEET * 1_340_388.728_020_658,
        ..SPREAD
    },
    Case {
        id: "mooney_equibiaxial_face",
        what: "how thin it gets",
        settings: &[SHEET_OF_MOONEY],
        reading: Reading::component("face", 2),
        reference: 0.02 * (0.292_439_561_457_058_35 - 1.0),
        ..SPREAD
    },
];
