//! Bodies whose volume is kept, in scenes: under every stepper, what they go on from, what is refused and told.

use souple_engine::{StepError, World};

use crate::worlds::{read, started};

/// A bar that falls beside its pins and swings.
const HUNG: &str = r#"
format = 1
[world]
period = "5 ms"
gravity = [0, 0, -9.81]
[systems.main]
stepper = "backward_euler"
[bodies.bar]
mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [4, 2, 2], element = "hex8" }
material = { name = "neo_hookean", youngs_modulus = "0.1 MPa", poissons_ratio = 0.3, density = 1000 }
incompressible = { penalty = "10 MPa", tolerance = 1e-5 }
[[bodies.bar.pins]]
region = "x_min"
"#;

fn step(world: &mut World, count: usize) {
    (0..count).for_each(|_| {
        world.step().unwrap();
    });
}

/// How far the worst cell is from its volume.
fn off(world: &World) -> f64 {
    let mut worst = 0.0;
    world.visit_forces(0, &mut |force, at| {
        let ratios = (0..).map_while(|cell| force.cell_field_at(cell, at));
        worst = ratios.map(|field| (field.current_volume / field.volume - 1.0).abs()).fold(worst, f64::max);
    });
    worst
}

/// Steppers that solve equations keep every volume to the tolerance in every step, and statics too.
#[test]
fn steps_keep_volumes() {
    for (stepper, element) in [
        ("backward_euler", "hex8"),
        ("bdf2", "hex8"),
        ("newmark", "hex8"),
        ("quasi_static", "hex8"),
        ("static", "hex8"),
        ("backward_euler", "prism6"),
    ] {
        let settings =
            [format!("systems.main.stepper=\"{stepper}\""), format!("bodies.bar.mesh.element=\"{element}\"")];
        let mut world = started(HUNG, &settings.each_ref().map(String::as_str));
        for _ in 0..6 {
            step(&mut world, 1);
            assert!(off(&world) <= 1e-5, "{stepper} {element}: {:e}", off(&world));
        }
    }
    let mut free = started(
        HUNG,
        &[
            "bodies.bar.incompressible.tolerance=0.5",
            "bodies.bar.incompressible.penalty=1",
            "systems.main.stepper=static",
        ],
    );
    step(&mut free, 1);
    assert!(off(&free) > 1e-4, "{:e}", off(&free));
}

/// A run that goes on from its state makes the same bits, any number of threads too, and multipliers are hashed.
#[test]
fn multipliers_go_on_from_state() {
    let mut world = started(HUNG, &[]);
    step(&mut world, 5);
    let state = world.state().clone();
    let mut resumed = read(HUNG, &[]).unwrap().model.start(state.clone());
    step(&mut world, 5);
    step(&mut resumed, 5);
    assert!(world.state() == resumed.state());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let threaded = pool.install(|| {
        let mut world = started(HUNG, &[]);
        step(&mut world, 10);
        world.state().clone()
    });
    assert!(world.state() == &threaded);
    let mut changed = state.clone();
    let multiplier = changed.systems[0].memory.iter_mut().find(|number| **number != 0.0).unwrap();
    *multiplier = multiplier.next_up();
    assert_ne!(changed.hash(), state.hash());
}

/// The longest step that is forecast has the penalty in it: a free cube of one cell swells and shrinks at `ω² = 12 (K + c)/(ρ a²)`, its eight points
/// of `ρ a³/8` under `∂V/∂x = (±a²/4, ±a²/4, ±a²/4)`, and `(h ω/2)² + h γ/2 = 1` with a margin of 5 %.
#[test]
fn penalties_shorten_the_forecast_step() {
    for penalty in [1e7_f64, 4e7] {
        let mut world = started(
            HUNG,
            &[
                "systems.main.stepper=symplectic_euler",
                "bodies.bar.mesh={ generate = \"bar\", size = [0.1, 0.1, 0.1], cells = [1, 1, 1], element = \"hex8\" }",
                "bodies.bar.pins=[]",
                &format!("bodies.bar.incompressible={{ penalty = {penalty}, time = \"40 ms\" }}"),
                "bodies.bar.damping={ rayleigh_mass = 50 }",
            ],
        );
        let forecast = world.with_system(0, souple_engine::stability::forecast);
        // K = E/(3 (1 - 2 ν))
        let bulk = 1e5 / 1.2;
        let frequency = f64::sqrt(12.0 * (bulk + penalty) / (1000.0 * 0.01));
        // from below: what is left of other modes after 40 products is their share, of a hundredth, to the 80th power
        assert!((forecast.highest_frequency / frequency - 1.0).abs() < 1e-9, "{forecast:?} {frequency}");
        let half = 25.0_f64;
        let longest = 0.95 * 2.0 / (half + (half * half + frequency * frequency).sqrt());
        assert!((forecast.longest_step / longest - 1.0).abs() < 1e-9, "{forecast:?} {longest}");
    }
}

/// Explicit steppers let multipliers take over in time: what hangs at rest in the end keeps its volume.
#[test]
fn explicit_multipliers_take_over() {
    let settings = [
        "systems.main.stepper=symplectic_euler",
        "world.period=\"0.2 ms\"",
        "bodies.bar.material.youngs_modulus=\"1 MPa\"",
        "bodies.bar.incompressible={ penalty = \"2 MPa\", time = \"40 ms\" }",
        "bodies.bar.damping={ rayleigh_mass = 50 }",
    ];
    let mut world = started(HUNG, &settings);
    // what sags does so within 1/8 s, the bar swings at 20/s
    step(&mut world, 500);
    let early = off(&world);
    step(&mut world, 4500);
    assert!(early > 1e-5 && off(&world) < 0.02 * early, "{early:e} {:e}", off(&world));
}

/// What cannot be is refused in words.
#[test]
fn wrong_volumes_are_refused() {
    let explicit = "systems.main.stepper=symplectic_euler";
    for (settings, told) in [
        (
            vec!["systems.main.stepper={ name = \"backward_euler\", newton = \"one\" }"],
            "one linearised solve",
        ),
        (vec![explicit], "solves no equations"),
        (vec![explicit, "bodies.bar.incompressible.time=\"40 ms\""], "to no tolerance"),
        (vec![explicit, "bodies.bar.incompressible={ penalty = 1e6, time = \"40 ms\" }"], "swing ever wider"),
        (vec!["bodies.bar.incompressible.time=\"40 ms\""], "no `time`"),
        (vec!["bodies.bar.mesh.element=tet10", "bodies.bar.incompressible.pressures=points"], "all corners"),
        (vec!["bodies.bar.modes={ count = 3 }"], "`modes`"),
        (vec!["bodies.bar.inelasticity={ fracture = { strain = 0.1 } }"], "`inelasticity.fracture`"),
        (
            vec!["bodies.bar.inelasticity={ creep_time = 1 }", "bodies.bar.material.name=linear"],
            "takes rotations for strain",
        ),
    ] {
        let refused = read(HUNG, &settings).err().unwrap_or_else(|| panic!("{settings:?} was read"));
        assert!(refused.contains(told), "{settings:?}: {refused}");
    }
}

/// A body that is led as a whole to another volume has nothing that could give: the step is refused, and says what is off by how much.
#[test]
fn volumes_that_cannot_be_kept_are_told() {
    let led = [
        "systems.main.stepper=static",
        "bodies.bar.pins=[{ region = { all = true }, motion = { formula = \"[0.1 * t * x, 0, 0]\" } }]",
    ];
    let mut world = started(HUNG, &led);
    let before = world.state().clone();
    let refused = world.step().unwrap_err();
    let StepError::Unmet { force, off, .. } = refused.error.cause() else { panic!("{refused}") };
    assert_eq!(force, "bar.material");
    // 0.1 · 5 ms
    assert!((off - 5e-4).abs() < 1e-9, "{off}");
    assert!(world.state() == &before);
}
