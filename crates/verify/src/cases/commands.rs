//! Actuators that controls command.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

const CARTS: Case = Case {
    capabilities: &["JIM-97"],
    scene: "commanded_carts",
    source: "specification §6.3, PA-44 and PA-45: u of S' = A S + B u; x' = x + h v + h² u/2m under a force that is constant for a period",
    // sums of 200 periods
    tolerance: Tolerance::Absolute(1e-12),
    ..OSCILLATOR
};

const PLANNED: Case = Case {
    scene: "planned_cart",
    source: "specification §6.3, PA-45: the least Σ f² subject to the discretised equations of motion at all times",
    // a hundred commands, each as exact as a number that is printed to its last bit
    tolerance: Tolerance::Absolute(1e-12),
    mutation: "networks.cart.masses.cart.mass=2.001",
    ..CARTS
};

const BOUNDED: Case = Case {
    scene: "bounded_cart",
    source: "specification §6.3, PA-45: the least Σ f² subject to the discretised equations of motion at all times, and to |f| ≤ F",
    ..PLANNED
};

const POSTS: Case = Case {
    scene: "two_posts",
    source: "specification §6.3, PA-45: spacetime constraints, inequalities at all times",
    // commands change by a millionth at most in the last step, of which keys see the square; printed to the last bit
    tolerance: Tolerance::Absolute(1e-6),
    mutation: "networks.table.masses.puck.mass=1.01",
    ..PLANNED
};

const REGULATED: Case = Case {
    scene: "regulated_cart",
    source: "specification §6.3, PA-44: the least ∫ SᵀQS + uᵀRu dt under S' = A S + B u",
    // commands were first sought with differences of 3e-7 N, from which speeds that are exact to 1e-16 tell h/m to 1.5e-8: of 10 N, over two
    // seconds, T²/2m times as much in place
    tolerance: Tolerance::Absolute(1.5e-7),
    mutation: "networks.cart.masses.cart.mass=2.001",
    ..CARTS
};

const STEERED: Case = Case {
    scene: "steered_cart",
    source: "specification §6.3, PA-44: between key states, Y_i = M_i S_i",
    // the same, of two seconds
    ..REGULATED
};

const FASTEST: Case = Case {
    scene: "fastest_cart",
    source: "specification §6.3, PA-46: the least of t + ∫ K C dt, by shots between the entries of a table; to a box |x| ≤ a, |v| ≤ b a cart \
             goes full ahead to the speed V = √(A (d − a) + b²/2) and full back to b, in (2 V − b)/A",
    mutation: "networks.cart.actuators.motor.largest=2",
    ..CARTS
};

/// The table with half as many places along each number of the state.
const COARSE: &str = "networks.cart.controls.drive.table=\"./coarse.table.csv\"";

const SWING: Case = Case {
    scene: "swing_up",
    source: "specification §6.3, PA-46: the least of t + ∫ K C dt, by shots between the entries of a table",
    reading: Reading::last("height"),
    reference: 1.0,
    // within an entry of upright, 1 − cos 6°
    tolerance: Tolerance::Absolute(0.0055),
    mutation: "networks.pendulum.actuators.push.largest=0.2",
    ..CARTS
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "cart_is_led_by_a_formula",
        what: "how far a cart came that was told to go a metre by a formula of the time, constant for periods of 10 ms",
        reading: Reading::last("led"),
        // h²/m Σ 3 (1 − n h)(N − n − 1/2)
        reference: 1.014_975,
        mutation: "networks.led.masses.cart.mass=2.001",
        ..CARTS
    },
    Case {
        id: "cart_is_regulated",
        what: "where a cart is after two seconds that is brought back by a formula of place and speed, and by no more than its motor gives",
        reading: Reading::last("regulated"),
        // the recursion with u = −50 x − 20 v, at most 30 N, in 50 digits
        reference: 0.000_611_225_757_320_417_2,
        mutation: "networks.regulated.actuators.motor.largest=31",
        ..CARTS
    },
    Case {
        id: "planned_cart_arrives",
        what: "where a cart is half a second past the end of a plan that brings it to rest with the least effort",
        reading: Reading::last("place"),
        reference: 1.0,
        ..PLANNED
    },
    Case {
        id: "planned_cart_halfway",
        what: "its speed halfway",
        reading: Reading::last("speed").after(50),
        // h/m Σ_{n<N/2} λ ((N − 1)/2 − n) = λ h N²/8m, λ = 12 m d/(h² N (N² − 1)): 3 d N/(2 h (N² − 1))
        reference: 3.0 * 100.0 / (2.0 * 0.02 * (100.0 * 100.0 - 1.0)),
        ..PLANNED
    },
    Case {
        id: "bounded_cart_arrives",
        what: "where a cart is half a second past the end of a plan that asks no more of its motor than it gives",
        reading: Reading::last("place"),
        reference: 2.0,
        ..BOUNDED
    },
    Case {
        id: "bounded_cart_halfway",
        what: "its speed halfway",
        reading: Reading::last("speed").after(50),
        // h/m Σ_{n<N/2} min(F, λ a_n), a_n = (N − 1)/2 − n, λ = (m d/2 h² − F Σ_{n<11} a_n)/Σ_{11≤n<N/2} a_n²
        reference: 1.531_892_158_474_437_2,
        ..BOUNDED
    },
    Case {
        id: "puck_keeps_from_posts",
        what: "how near a puck comes to the middle of the first post, when it is planned to keep 0.4 m away",
        reading: Reading::last("from_first").taking(Statistic::Min),
        reference: 0.4,
        ..POSTS
    },
    Case {
        id: "puck_arrives",
        what: "where it is at the end of its plan",
        reading: Reading::component("place", 0).after(50),
        reference: 2.0,
        ..POSTS
    },
    Case {
        id: "crane_arrives",
        what: "where the trolley of a crane is that was planned to bring a load to rest three metres on",
        scene: "crane",
        reading: Reading::component("trolley", 0).after(100),
        reference: 3.0,
        // commands change by a millionth at most in the last step, of which keys see the square; printed to the last bit
        tolerance: Tolerance::Absolute(1e-6),
        mutation: "networks.crane.masses.load.mass=1.001",
        ..PLANNED
    },
    Case {
        id: "cart_comes_back_by_gains",
        what: "where a cart is after two seconds that is regulated to rest at the least cost",
        reading: Reading::last("place").after(100),
        // the discrete Riccati equation of 300 periods, and 100 of them with its gains, in 60 digits
        reference: 0.015_504_386_801_776_58,
        ..REGULATED
    },
    Case {
        id: "cart_comes_back_from_elsewhere",
        what: "the same, begun half as far again from its goal as it was planned for",
        settings: &["networks.cart.translate=[0.5, 0, 0]"],
        reading: Reading::last("place").after(100),
        // S_n and u_n = −K_n S_n are as the start is
        reference: 1.5 * 0.015_504_386_801_776_58,
        mutation: "networks.cart.controls.drive.feedback=false",
        ..REGULATED
    },
    Case {
        id: "steered_cart_arrives",
        what: "where a cart is half a second past the end of a plan that a gust on its way was unknown to",
        reading: Reading::last("place"),
        reference: 1.0,
        mutation: "networks.cart.controls.drive.feedback=false",
        ..STEERED
    },
    Case {
        id: "steered_cart_without_gains",
        what: "where it is under the commands alone, after the two seconds that were planned",
        settings: &["networks.cart.controls.drive.feedback=false"],
        reading: Reading::last("place").after(100),
        // 1 + h²/m Σ g_n (N − n − 1/2) with g_n = 4 max(0, 1 − |n h − 0.7|/0.2)
        reference: 1.516,
        ..STEERED
    },
    Case {
        id: "fastest_cart_is_on_time",
        what: "where a cart is that a table over place and speed leads to rest, in 0.913 s, when the fastest is at the edge of the goal",
        reading: Reading::last("place").after(913),
        reference: -0.06,
        // levels pass into each other over an entry and not at once, which is as far as it may be off
        tolerance: Tolerance::Absolute(0.06),
        ..FASTEST
    },
    Case {
        id: "fastest_cart_by_a_coarse_table",
        what: "the same by a table of half as many places along each number of the state",
        settings: &[COARSE],
        reading: Reading::last("place").after(913),
        reference: -0.06,
        tolerance: Tolerance::Absolute(0.12),
        ..FASTEST
    },
    Case {
        id: "fastest_cart_keeps_what_its_table_tells",
        what: "its speed when the table has it in the goal, after what the way from the start costs there",
        // 1.0008 s
        reading: Reading::last("speed").after(1001),
        reference: 0.0,
        // the goal
        tolerance: Tolerance::Absolute(0.24),
        ..FASTEST
    },
    Case {
        id: "fastest_cart_keeps_what_a_coarse_table_tells",
        what: "the same by the coarse table, which has it there later",
        settings: &[COARSE],
        // 1.1142 s
        reading: Reading::last("speed").after(1115),
        reference: 0.0,
        tolerance: Tolerance::Absolute(0.24),
        ..FASTEST
    },
    Case {
        id: "fastest_cart_stays",
        what: "where it is in the end",
        reading: Reading::last("place"),
        reference: 0.0,
        // the goal
        tolerance: Tolerance::Absolute(0.06),
        mutation: "networks.cart.actuators.motor.largest=0.5",
        ..FASTEST
    },
    Case {
        id: "pendulum_is_swung_up",
        what: "how high a pendulum ends that pushes of less than half its weight swing up from rest",
        ..SWING
    },
    Case {
        id: "pendulum_is_caught",
        what: "the same, let go on the way up",
        settings: &["networks.pendulum.masses.bob.positions=[[0.8, -0.6, 0]]"],
        ..SWING
    },
];
