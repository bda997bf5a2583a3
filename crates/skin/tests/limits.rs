//! What limits a skin's sub-steps, and how it ends where it cannot go on.

use std::f64::consts::PI;

use souple_engine::FieldState;
use souple_math::Vec3;
use souple_skin::target::particles::Cloud;
use souple_skin::target::{ISO, Moment, Part, Target};
use souple_skin::{Skin, SkinError, SkinScratch};
use souple_table::Value;

use crate::common::{number, part, skin, term};

fn ball(skin: &Skin, radius: f64, scratch: &mut SkinScratch) -> FieldState {
    let corner = Vec3::new(1.1, 1.1, 1.1) * radius;
    skin.start(-corner, corner, &|p| radius - p.length(), scratch).unwrap()
}

fn speed(formula: &'static str) -> Box<dyn souple_skin::strategy::Term> {
    term("speed", &[("formula", Value::Text(formula))])
}

/// A speed that is nothing at both ends of a step and four voxels within it moves a ball by its integral, in one piece: as
/// text and as pressure, at once and in steps twenty times as short.
#[test]
fn speeds_that_come_and_go_within_a_step() {
    let (radius, voxel, period) = (0.5, 0.05, 0.1);
    // ∫ 4 sin²(πt/T) dt = 2 T
    let grown = radius + 2.0 * period;
    for steps in [1, 20] {
        let pressure = term("pressure", &[("speed", Value::Text("4*sin(pi*t/0.1)^2"))]);
        let terms = [pressure, speed("4*sin(pi*t/0.1)^2")];
        let [by_pressure, by_text] = terms.map(|term| {
            let skin = skin(voxel, vec![term]);
            let mut scratch = skin.new_scratch();
            let mut field = ball(&skin, radius, &mut scratch);
            let timestep = period / f64::from(steps);
            for step in 1..=steps {
                skin.step(&Moment::at(f64::from(step) * timestep), timestep, &mut field, &mut scratch)
                    .unwrap();
            }
            let measures = skin.view(&field).measures();
            assert_eq!((measures.components, measures.euler), (1, 2), "in {steps} steps");
            (0.75 * measures.volume / PI).cbrt()
        });
        // middles of sub-steps in which the surface moves half a voxel, of 4 voxels: (π/8)²/6 of the way at most; chords
        // take a tenth of a voxel's square over the radius
        let bar = (PI / 8.0).powi(2) / 6.0 * (grown - radius) + 0.1 * voxel * voxel / radius;
        assert!((by_pressure - grown).abs() < bar, "{by_pressure} for {grown} in {steps} steps");
        assert!((by_text - by_pressure).abs() < bar, "{by_text} for {by_pressure} in {steps} steps");
    }
}

/// A speed as text that looks at the volume comes to rest where it wants it, however strongly it is drawn there in a step.
#[test]
fn speeds_that_look_at_the_size_do_not_overshoot() {
    let skin = skin(0.05, vec![speed("20*(0.6 - volume)/0.6")]);
    let mut scratch = skin.new_scratch();
    let mut field = ball(&skin, 0.5, &mut scratch);
    let mut before = skin.view(&field).measures().volume;
    for step in 1..=10 {
        skin.step(&Moment::at(0.05 * f64::from(step)), 0.05, &mut field, &mut scratch).unwrap();
        let volume = skin.view(&field).measures().volume;
        // from below, and never beyond but for the rounding of values in 32 bits on a surface of 3.4 m²
        assert!(volume >= before - 1e-6 && volume < 0.6 + 1e-6, "{volume} after {before} in step {step}");
        before = volume;
    }
    // e^(-rate t) with the rate 20 A/V0 of more than 100/s
    assert!((before - 0.6).abs() < 1e-4, "{before}");
}

/// A target that turns to no number or ends while the world runs ends it in words with the time.
#[test]
fn targets_that_break_while_running() {
    let formula = |text: &'static str| {
        part(
            "formula",
            &[
                ("formula", Value::Text(text)),
                ("low", Value::Vector([-1.0; 3])),
                ("high", Value::Vector([1.0; 3])),
            ],
        )
    };
    let fails = |text: &'static str, during: [f64; 2]| -> SkinError {
        let mut skin = skin(0.1, vec![term("attraction", &[("strength", number(1.0))])]);
        skin.target = Some(Target { parts: vec![Part { during, ..formula(text) }], iso: ISO });
        let mut scratch = skin.new_scratch();
        let mut field = ball(&skin, 0.5, &mut scratch);
        let mut steps = 1..=400;
        let failed = steps.find_map(|step| {
            skin.step(&Moment::at(0.1 * f64::from(step)), 0.1, &mut field, &mut scratch).err()
        });
        failed.unwrap_or_else(|| panic!("{text} goes on"))
    };
    let error = fails("sqrt(0.55 - t)*(0.5 - sqrt(x^2 + y^2 + z^2))", [0.0, f64::INFINITY]);
    assert!(matches!(error, SkinError::TargetNotANumber { .. }), "{error}");
    let words = error.to_string();
    assert!(
        words.starts_with("at t = 0.6") && words.contains("s parts[0] of its target is NaN at"),
        "{words}"
    );
    let error = fails("0.5 - sqrt(x^2 + y^2 + z^2)", [0.0, 0.35]);
    assert!(matches!(error, SkinError::Target(_)) && error.to_string().contains("at t = 0.4"), "{error}");
}

/// A term that has no number at a moment is named, with the goal that makes none.
#[test]
fn terms_that_break_are_named() {
    let fails = |broken: Box<dyn souple_skin::strategy::Term>| {
        let skin = skin(0.1, vec![speed("0.01"), broken]);
        let mut scratch = skin.new_scratch();
        let mut field = ball(&skin, 0.5, &mut scratch);
        let failed = (1..=10).find_map(|step| {
            skin.step(&Moment::at(0.1 * f64::from(step)), 0.1, &mut field, &mut scratch).err()
        });
        failed.expect("it goes on").to_string()
    };
    let rate = ("rate", number(0.1));
    let error = fails(term("constant_volume", &[rate, ("volume", Value::Text("-1 - t"))]));
    assert!(
        error.contains("terms[1] is NaN") && error.contains("expected a goal above 0, which is -1"),
        "{error}"
    );
    let error = fails(speed("0.01*sqrt(0.5 - t - x)"));
    assert!(error.starts_with("by terms[1] its speed is NaN m/s at ["), "{error}");
}

/// Particles so near to each other that each place would sum over thousands are refused, with where they are; small ones
/// beside a large one are none.
#[test]
fn crowds_of_particles_are_refused() {
    let place = |count: u32, radius: f64| {
        let at = |i: u32| Vec3::new(f64::from(i % 20), f64::from(i / 20 % 20), f64::from(i / 400)) * 1e-5;
        let large = (Vec3::ZERO, 0.01);
        Cloud::default().place((1..count).map(|i| (at(i), radius)).chain([large]))
    };
    // a cell is as wide as four radii, and eight particles fill it
    assert_eq!(place(4000, 0.01), Ok(()));
    assert_eq!(place(8000, 0.005), Ok(()));
    let error = place(4200, 0.01).unwrap_err();
    assert!(error.contains("4200 particles are in a cube of 0.04 m about [1e-5, 0.0, 0.0]"), "{error}");
    assert!(error.contains("expected 512 at most"), "{error}");
}
