//! The clamped bar let go under gravity, backward Euler at 10 ms: traces of an independent code.

use super::bar::{COROTATIONAL, LINEAR, ST_VENANT_KIRCHHOFF};
use crate::{Case, Reading, Tolerance};

const CONVERGED: &str = r#"systems.main.stepper={ name = "backward_euler", newton = "full", newton_tolerance = 1e-11, solver_tolerance = 1e-12 }"#;
const ONE_NEWTON: &str = r#"systems.main.stepper={ name = "backward_euler", newton = "one", newton_tolerance = 1e-11, solver_tolerance = 1e-12 }"#;
const TIP: Reading = Reading::component("tip", 1);

const AFTER_1: Case = Case {
    id: "",
    capabilities: &["FAU-40"],
    what: "",
    scene: "cantilever_dynamic",
    settings: &[],
    reading: TIP.after(1),
    refinement: None,
    reference: f64::NAN,
    tolerance: Tolerance::Relative(1e-7),
    source: "own code, Newton to 1e-12",
    mutation: "world.gravity=[0, -9.811, 0]",
};

const AFTER_10: Case = Case { reading: TIP.after(10), ..AFTER_1 };
const AFTER_20: Case = Case { reading: TIP.after(20), ..AFTER_1 };
const AFTER_100: Case = Case { reading: TIP.after(100), ..AFTER_1 };

pub(super) const CASES: &[Case] = &[
    Case {
        id: "implicit_corotational_converged_1",
        what: "tip of the swinging bar after 1 backward Euler steps of 10 ms, corotational, Newton",
        settings: &[CONVERGED, COROTATIONAL],
        reference: -0.0010452609380532823,
        ..AFTER_1
    },
    Case {
        id: "implicit_corotational_converged_10",
        what: "tip of the swinging bar after 10 backward Euler steps of 10 ms, corotational, Newton",
        settings: &[CONVERGED, COROTATIONAL],
        reference: -0.06781736422475466,
        ..AFTER_10
    },
    Case {
        id: "implicit_corotational_converged_20",
        what: "tip of the swinging bar after 20 backward Euler steps of 10 ms, corotational, Newton",
        settings: &[CONVERGED, COROTATIONAL],
        reference: -0.16575024108957917,
        ..AFTER_20
    },
    Case {
        id: "implicit_corotational_converged_100",
        what: "tip of the swinging bar after 100 backward Euler steps of 10 ms, corotational, Newton",
        settings: &[CONVERGED, COROTATIONAL],
        reference: -0.06549727082595913,
        ..AFTER_100
    },
    Case {
        id: "implicit_linear_one_newton_1",
        what: "tip of the swinging bar after 1 backward Euler steps of 10 ms, linear, one linearised solve",
        settings: &[ONE_NEWTON, LINEAR],
        reference: -0.001045258818886569,
        ..AFTER_1
    },
    Case {
        id: "implicit_linear_one_newton_10",
        what: "tip of the swinging bar after 10 backward Euler steps of 10 ms, linear, one linearised solve",
        settings: &[ONE_NEWTON, LINEAR],
        reference: -0.06793002703952747,
        ..AFTER_10
    },
    Case {
        id: "implicit_linear_one_newton_20",
        what: "tip of the swinging bar after 20 backward Euler steps of 10 ms, linear, one linearised solve",
        settings: &[ONE_NEWTON, LINEAR],
        reference: -0.167510818665232,
        ..AFTER_20
    },
    Case {
        id: "implicit_linear_one_newton_100",
        what: "tip of the swinging bar after 100 backward Euler steps of 10 ms, linear, one linearised solve",
        settings: &[ONE_NEWTON, LINEAR],
        reference: -0.06689013214725349,
        ..AFTER_100
    },
    Case {
        id: "implicit_stvk_converged_1",
        what: "tip of the swinging bar after 1 backward Euler steps of 10 ms, st_venant_kirchhoff, Newton",
        settings: &[CONVERGED, ST_VENANT_KIRCHHOFF],
        reference: -0.0010452671121474627,
        ..AFTER_1
    },
    Case {
        id: "implicit_stvk_converged_10",
        what: "tip of the swinging bar after 10 backward Euler steps of 10 ms, st_venant_kirchhoff, Newton",
        settings: &[CONVERGED, ST_VENANT_KIRCHHOFF],
        reference: -0.06781289404269727,
        ..AFTER_10
    },
    Case {
        id: "implicit_stvk_converged_20",
        what: "tip of the swinging bar after 20 backward Euler steps of 10 ms, st_venant_kirchhoff, Newton",
        settings: &[CONVERGED, ST_VENANT_KIRCHHOFF],
        reference: -0.1656504618150783,
        ..AFTER_20
    },
    Case {
        id: "implicit_stvk_converged_100",
        what: "tip of the swinging bar after 100 backward Euler steps of 10 ms, st_venant_kirchhoff, Newton",
        settings: &[CONVERGED, ST_VENANT_KIRCHHOFF],
        reference: -0.06539372349475858,
        ..AFTER_100
    },
    Case {
        id: "implicit_stvk_one_newton_1",
        what: "tip of the swinging bar after 1 backward Euler steps of 10 ms, st_venant_kirchhoff, one linearised solve",
        settings: &[ONE_NEWTON, ST_VENANT_KIRCHHOFF],
        reference: -0.0010452588188865027,
        ..AFTER_1
    },
    Case {
        id: "implicit_stvk_one_newton_10",
        what: "tip of the swinging bar after 10 backward Euler steps of 10 ms, st_venant_kirchhoff, one linearised solve",
        settings: &[ONE_NEWTON, ST_VENANT_KIRCHHOFF],
        reference: -0.06758904669664875,
        ..AFTER_10
    },
    Case {
        id: "implicit_stvk_one_newton_20",
        what: "tip of the swinging bar after 20 backward Euler steps of 10 ms, st_venant_kirchhoff, one linearised solve",
        settings: &[ONE_NEWTON, ST_VENANT_KIRCHHOFF],
        reference: -0.16450240938013821,
        ..AFTER_20
    },
    Case {
        id: "implicit_stvk_one_newton_100",
        what: "tip of the swinging bar after 100 backward Euler steps of 10 ms, st_venant_kirchhoff, one linearised solve",
        settings: &[ONE_NEWTON, ST_VENANT_KIRCHHOFF],
        reference: -0.06678504848952935,
        ..AFTER_100
    },
];
