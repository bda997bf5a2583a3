//! Contacts of masses whose forces, and impulses where they collide, are solved for: impacts, friction, supports, stacks and heaps.

use super::network::OSCILLATOR;
use crate::{Case, Reading, Statistic, Tolerance};

const IMPACTS: Case = Case {
    capabilities: &["JIM-97"],
    scene: "rigid_impacts",
    // what the contact is solved to, of what it would be off by
    tolerance: Tolerance::Absolute(2e-7),
    source: "specification §6.3, PA-36 (EXP-01, EXP-59): restitution, Coulomb on impulses",
    ..OSCILLATOR
};

/// A square of 2 kg and 0.16 kg m² whose corner at r = (−0.11953, −0.25634) m from its centre strikes a floor.
const SQUARE: Case = Case {
    source: "specification §6.3, PA-36: J (ω' − ω) = R × P (Routh 1905)",
    // velocities are those of the way of a step: the corner's is off by ω² |r| h/2 = 5.2e-5 with the 1.9 rad/s that it leaves with, and
    // the impulse by that over 1/M + r_x²/J = 0.589
    tolerance: Tolerance::Absolute(4.4e-5),
    mutation: "networks.square.constraints[1].restitution=0.51",
    ..IMPACTS
};

/// The same, turning by 3 rad/s: after its impact by a third of one at most, so that ω² |r| h/2 = 1.5e-6.
const SPINNING: Case = Case {
    tolerance: Tolerance::Absolute(2e-6),
    mutation: "networks.spinning.angular_velocity=[0, 0, 3.01]",
    reading: Reading::component("spinning", 1),
    ..SQUARE
};

const SLIDING_CORNER: &[&str] = &["parameters.rough=0.02"];

const CONTACTS: Case = Case {
    scene: "rigid_contacts",
    source: "specification §6.3, PA-37 (EXP-38, EXP-59)",
    mutation: "parameters.friction=0.38",
    ..IMPACTS
};

/// Impacts come up to v h = 2.2 mm above the floor, with a velocity that is off by g h: 2.2 mm + v h ε² = 1.4 mm of the first height, and less of others.
const BOUNCES: Case = Case {
    reading: Reading::component("bounces", 1).after(163),
    tolerance: Tolerance::Absolute(3.6e-3),
    mutation: "networks.bounces.constraints[0].restitution=0.79",
    source: "specification §6.3, PA-36: a height falls to ε² of itself with each impact",
    ..CONTACTS
};

const STACK: Case = Case {
    scene: "rigid_stack",
    source: "specification §6.3, PA-37 (EXP-59: a stack of five stands for a minute with a drift of less than 1 %)",
    mutation: "parameters.friction=0",
    ..IMPACTS
};

const FRICTIONLESS: &[&str] = &["parameters.friction=0"];

/// Of every period: the depth of contacts, and the gap of those that press.
const COMPLEMENTARY: Case = Case {
    reading: Reading::last("residual").taking(Statistic::Max).after(100),
    // 1e-7 of what a step would enter by without forces, g h² and v h of bricks that have fallen by 3 mm
    reference: 4e-10,
    tolerance: Tolerance::AtMost,
    source: "specification §6.3, PA-37: forces from complementarity",
    // what bounces is pushed until it is apart
    mutation: "networks.stack.constraints[5].restitution=1",
    ..STACK
};

const HEAP: Case = Case {
    scene: "rigid_heap",
    source: "specification §6.3, PA-37: contacts of many",
    mutation: "networks.heap.masses.balls.mass=0.101",
    ..IMPACTS
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "impact_plastic",
        what: "velocity of a ball of 3 kg that one of 1 kg and 1 m/s met with a restitution of nothing: both go on as one",
        reading: Reading::component("plastic", 0),
        reference: 0.25,
        mutation: "networks.plastic.constraints[0].restitution=0.01",
        ..IMPACTS
    },
    Case {
        id: "impact_half_light",
        what: "velocity of the lighter with a restitution of a half: (m₁ − ε m₂) v/(m₁ + m₂)",
        reading: Reading::component("half_light", 0),
        reference: -0.125,
        mutation: "networks.half.constraints[0].restitution=0.51",
        ..IMPACTS
    },
    Case {
        id: "impact_half_heavy",
        what: "velocity of the heavier: (1 + ε) m₁ v/(m₁ + m₂)",
        reading: Reading::component("half_heavy", 0),
        reference: 0.375,
        mutation: "networks.half.constraints[0].restitution=0.51",
        ..IMPACTS
    },
    Case {
        id: "impact_elastic",
        what: "velocity of the lighter after an elastic impact",
        reading: Reading::component("elastic", 0),
        reference: -0.5,
        mutation: "parameters.elastic=0.99",
        ..IMPACTS
    },
    Case {
        id: "impact_slides",
        what: "velocity along the floor of a ball that slides all through its impact: v_t − μ (1 + ε) v_n",
        reading: Reading::component("slides", 0),
        reference: 1.7,
        mutation: "networks.slides.constraints[0].friction=0.21",
        ..IMPACTS
    },
    Case {
        id: "impact_rebounds",
        what: "velocity away from the floor of the same",
        reading: Reading::component("slides", 1),
        reference: 0.5,
        mutation: "networks.slides.constraints[0].restitution=0.51",
        ..IMPACTS
    },
    Case {
        id: "impact_sticks",
        what: "velocity along the floor of a ball whose friction could bear more than there is: it sticks",
        reading: Reading::component("sticks", 0),
        reference: 0.0,
        mutation: "networks.sticks.constraints[0].friction=0.1",
        ..IMPACTS
    },
    Case {
        id: "impacts_in_a_row",
        what: "velocity of the last of five equal balls, which the first met",
        reading: Reading::component("last", 0),
        reference: 1.0,
        mutation: "networks.row.constraints[0].restitution=0.99",
        ..IMPACTS
    },
    Case {
        id: "impacts_in_a_row_leave",
        what: "greatest velocity of the other four",
        reading: Reading::last("others"),
        reference: 0.0,
        mutation: "networks.row.constraints[0].restitution=0.99",
        ..IMPACTS
    },
    Case {
        id: "impact_of_a_corner",
        what: "velocity of the centre of a rigid square that struck with a corner: −V + (1 + ε) V/(M (1/M + r_x²/J))",
        reading: Reading::component("square", 1),
        reference: 0.272_689_729_753_652_6,
        ..SQUARE
    },
    Case {
        id: "impact_of_a_corner_turns",
        what: "what turns it: r_x P",
        reading: Reading::component("square_turns", 2),
        reference: -0.304_260_649_528_027_45,
        // r_x M of that of the velocity
        tolerance: Tolerance::Absolute(1.1e-5),
        ..SQUARE
    },
    Case {
        id: "impact_of_a_corner_that_sticks",
        what: "velocity upward of the centre of one that spins, whose corner sticks while it strikes",
        reference: 0.708_636_639_036_235_3,
        ..SPINNING
    },
    Case {
        id: "impact_of_a_corner_holds_back",
        what: "and along the floor",
        reading: Reading::component("spinning", 0),
        reference: -0.062_908_887_051_588_52,
        ..SPINNING
    },
    Case {
        id: "impact_of_a_corner_stops_its_spin",
        what: "and what is left of its 0.48 kg m²/s",
        reading: Reading::component("spinning_turns", 2),
        reference: 0.039_265_513_343_120_464,
        ..SPINNING
    },
    Case {
        id: "impact_of_a_corner_that_slides",
        what: "velocity upward of the centre of the same with less friction, whose corner slides",
        settings: SLIDING_CORNER,
        reference: 0.717_914_979_403_057_3,
        ..SPINNING
    },
    Case {
        id: "impact_of_a_corner_that_slides_turns",
        what: "and what is left of its spin",
        settings: SLIDING_CORNER,
        reading: Reading::component("spinning_turns", 2),
        reference: 0.051_684_810_823_572_12,
        ..SPINNING
    },
    Case {
        id: "bounce_first",
        what: "height of a ball of 0.1 m at the top of its first bounce from 1 m, with a restitution of 0.8",
        reference: 0.1 + 0.64,
        ..BOUNCES
    },
    Case {
        id: "bounce_third",
        what: "and of its third",
        reading: Reading::component("bounces", 1).after(397),
        reference: 0.1 + 0.262_144,
        ..BOUNCES
    },
    Case {
        id: "block_stops",
        what: "way of a pushed block until friction has stopped it: v²/(2 μ g)",
        reading: Reading::component("block", 0),
        reference: 0.509_683_995_922_528,
        // half of the way of a step at the start, a tenth of the hundredth that is asked
        tolerance: Tolerance::Absolute(5.1e-4),
        ..CONTACTS
    },
    Case {
        id: "block_holds_on_a_slope",
        what: "way in four seconds of a block on a slope of tan θ = 0.39 < μ = 0.4",
        reading: Reading::last("flat"),
        reference: 1e-9,
        tolerance: Tolerance::AtMost,
        ..CONTACTS
    },
    Case {
        id: "block_slides_on_a_slope",
        what: "velocity after four seconds of one on a slope of tan θ = 0.41: g cos θ (tan θ − μ) t",
        reading: Reading::last("steep"),
        reference: 0.363_068_847_603_7,
        tolerance: Tolerance::Relative(1e-6),
        ..CONTACTS
    },
    Case {
        id: "bar_on_three_supports",
        what: "what three supports bear together of a rigid bar that needs two",
        reading: Reading::component("borne", 1),
        reference: 12.5 * 9.81,
        tolerance: Tolerance::Relative(1e-6),
        mutation: "networks.bar.masses.ridge.mass=0.51",
        ..CONTACTS
    },
    Case {
        id: "string_does_not_push",
        what: "greatest height of a bob that was thrown up within the reach of its string: v²/(2 g)",
        reading: Reading::component("bob", 1).taking(Statistic::Max),
        reference: 2.0 + 0.458_715_596_330_275,
        // half of the way of a step at the start
        tolerance: Tolerance::Absolute(7.6e-4),
        mutation: "networks.string.masses.bob.velocity=[0, 3.01, 0]",
        ..CONTACTS
    },
    Case {
        id: "string_catches",
        what: "place of the same when it hangs",
        reading: Reading::component("bob", 1),
        reference: 1.0,
        mutation: "networks.string.constraints[0].rod.length=2.001",
        ..CONTACTS
    },
    Case {
        id: "string_pulls",
        what: "what it pulls with then",
        reading: Reading::component("string_pulls", 1),
        reference: 0.5 * 9.81,
        tolerance: Tolerance::Relative(1e-6),
        mutation: "networks.string.masses.bob.mass=0.501",
        ..CONTACTS
    },
    Case {
        id: "rigid_heap_bears_its_weight",
        what: "what floor and walls bear upward of three hundred balls of 0.1 kg that have come to rest",
        reading: Reading::component("borne", 2),
        reference: 30.0 * 9.81,
        tolerance: Tolerance::Relative(1e-6),
        ..HEAP
    },
    Case {
        id: "rigid_heap_rests",
        what: "kinetic energy that is left",
        reading: Reading::last("moving"),
        reference: 1e-9,
        tolerance: Tolerance::AtMost,
        mutation: "world.gravity=[0, 0, 9.81]",
        ..HEAP
    },
    Case {
        id: "rigid_stack_stands",
        what: "way along the shorter side of the highest of five rigid bricks in a minute",
        reading: Reading::component("top", 1),
        reference: 0.0,
        // a hundredth of the centimetre by which bricks lie beside each other
        tolerance: Tolerance::Absolute(1e-4),
        ..STACK
    },
    Case {
        id: "rigid_stack_is_at_rest",
        what: "kinetic energy of the same after ten seconds",
        reading: Reading::last("moving").after(500),
        reference: 1e-12,
        tolerance: Tolerance::AtMost,
        ..STACK
    },
    Case {
        id: "rigid_stack_creeps_less_than_springs",
        what: "how far the highest is after a minute from where geometry has it",
        reading: Reading::last("astray"),
        // a tenth of what the springs of `brick_stack` sink into each other by: (5 + 4 + 3 + 2 + 1) 1.6 9.81/(8 20000) m
        reference: 1.47e-4,
        tolerance: Tolerance::AtMost,
        ..STACK
    },
    Case {
        id: "rigid_stack_is_complementary",
        what: "how far any contact is from pressing only where it is closed, at most, in two seconds in which the stack comes to rest",
        ..COMPLEMENTARY
    },
    Case {
        id: "rigid_stack_that_slides_enters_nothing",
        what: "the same of bricks that slide off each other and fall to the ground",
        settings: FRICTIONLESS,
        // what falls by 0.8 m comes with 4 m/s, the tip of what topples from there with √3 times as much, in steps of 10 ms
        reference: 7e-9,
        ..COMPLEMENTARY
    },
    Case {
        id: "rigid_stack_comes_apart",
        what: "how far the highest of these has come down, which lies on one of its sides, rigid as it was",
        settings: FRICTIONLESS,
        reading: Reading::component("top", 2).after(100),
        reference: -0.8,
        // what contacts are solved to, as above
        tolerance: Tolerance::Absolute(7e-9),
        mutation: "parameters.friction=0.6",
        ..STACK
    },
];
