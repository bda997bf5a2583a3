//! Controls: links are made and broken and parameters turned while the world runs, and account is kept of what that makes.

use std::path::Path;

use souple_engine::World;
use souple_scene::{Scene, read_text, read_text_with_files};

const HEAD: &str = "format = 1\n[world]\nperiod = \"1 ms\"\n[systems.main]\nstepper = \"t_simulation\"\n";

fn scene(text: &str) -> Result<Scene, String> {
    read_text("net.toml", &format!("{HEAD}{text}"), Path::new("."), &[]).map_err(|faults| faults.to_string())
}

fn refused(text: &str, words: &[&str]) {
    let message = scene(text).err().expect("the scene is refused");
    for word in words {
        assert!(message.contains(word), "`{word}` is not in:\n{message}");
    }
}

/// A mass of 1 kg 10 cm to the right of where its spring is at rest.
fn pulled(law: &str, controls: &str) -> String {
    format!(
        "[networks.n.masses.nail]\npositions = [[0, 0, 0]]\nmass = 1\nfixed = true\n\
         [networks.n.masses.bob]\npositions = [[1.1, 0, 0]]\nmass = 1\n\
         [[networks.n.links]]\nname = \"band\"\nlaw = {law}\nof = [\"bob\", \"nail\"]\nall = true\nrest_length = 1\n{controls}"
    )
}

fn world(text: &str) -> World {
    let scene = scene(text).unwrap_or_else(|message| panic!("{message}"));
    scene.model.start(scene.state)
}

const SPRING: &str = "{ name = \"spring\", stiffness = 100 }";

/// A link that is cut gives no force from the next period on, and what it held is told as taken away; made again, as given.
#[test]
fn links_are_made_and_broken() {
    let control = "[networks.n.controls.cut]\nlinks = \"band\"\nconnects = \"t < 9.5e-3 or t > 19.5e-3\"\n";
    let mut world = world(&pulled(SPRING, control));
    (0..10).for_each(|_| world.step().unwrap());
    let speed = world.state().systems[0].v[1].x;
    assert!(speed < -0.09, "{speed}");
    let before = world.energy();
    (0..10).for_each(|_| world.step().unwrap());
    assert_eq!(world.state().systems[0].v[1].x, speed);
    let (cut, name) = (world.energy().made_by_control[0].1, world.energy().made_by_control[0].0.clone());
    assert_eq!(name, "n.cut");
    let held = before.by_force.iter().find(|(name, _)| name == "n.links[0]").unwrap().1.stored;
    assert!((cut + held).abs() < 1e-15 && held > 0.4, "{cut} J, not {} J", -held);
    // as it is put in again it is shorter
    world.step().unwrap();
    let again = world.energy().made_by_control[0].1 - cut;
    assert!(again > 0.0 && again < held, "{again} J");
    // kinetic and stored energy change by no more than that
    let total = |energy: &souple_engine::EnergyReport| energy.total() - energy.made_by_control[0].1;
    let drift = (total(&world.energy()) - total(&before)).abs();
    assert!(drift < 1e-3 * held, "{drift} J");
}

/// A connection that is made over a time acts by as much of it as has passed.
#[test]
fn ramps_make_links_slowly() {
    let control = "[networks.n.controls.make]\nlinks = \"band\"\nconnects = \"t < 0\"\nramp = \"4 ms\"\n";
    let mut world = world(&pulled(SPRING, control));
    let mut last = 0.0;
    for gain in [0.75, 0.5, 0.25, 0.0, 0.0] {
        world.step().unwrap();
        let v = world.state().systems[0].v[1].x;
        // the bob has hardly moved
        assert!(
            ((v - last) / (-gain * 100.0 * 0.1 * 1e-3) - 1.0).abs() < 1e-3 || gain == 0.0,
            "{gain}: {v} {last}"
        );
        assert!(gain != 0.0 || v == last);
        last = v;
    }
}

/// Registers of a law follow their formulas; what reads masses reads them at the start of the period, and `previous` makes memory.
#[test]
fn parameters_are_driven() {
    let push = |law: &str, control: &str| {
        let mut world = world(&pulled(law, control));
        world.step().unwrap();
        world.state().systems[0].v[1].x / 1e-3
    };
    let near = |measured: f64, expected: f64| {
        assert!((measured - expected).abs() < 1e-9, "{measured}, not {expected}")
    };
    let turned = |parameter: &str, value: &str| {
        format!(
            "[networks.n.controls.turn]\nlinks = \"band\"\nparameter = \"{parameter}\"\nvalue = \"{value}\"\n"
        )
    };
    near(push(SPRING, &turned("stiffness", "200 + t")), -20.0);
    let tuned = "{ name = \"tuned_spring\", stiffness = 100 }";
    near(push(tuned, &turned("length", "0.9")), -20.0);
    near(push(tuned, ""), -10.0);
    let written = "{ name = \"formula\", push = \"-k*(D - L0)\", parameters = { k = 5 } }";
    near(push(written, &turned("k", "7")), -0.7);
    near(push(written, ""), -0.5);
    let bent = "{ name = \"cohesion\", distance = 1, peak = 1.2, range = 1.5, cohesion = 4 }";
    near(push(bent, &turned("cohesion", "7")), -0.7);
    let pieces = "{ name = \"piecewise_linear\", thresholds = [1.05], slopes = [-10, -20], zero = 1 }";
    near(push(pieces, ""), -1.5);
    near(push(pieces, &turned("slopes[1]", "-40")), -2.5);
    let compiled = "{ name = \"rheological\", network = \"spring(k)\", parameters = { k = \"5 N/m\" } }";
    near(push(compiled, &turned("k", "7")), -0.7);
    let reads = format!(
        "{}inputs.x = {{ of = \"bob\", quantity = \"position\", component = \"x\" }}\n",
        turned("stiffness", "100 * x")
    );
    near(push(SPRING, &reads), -11.0);
    let apart = format!(
        "{}inputs.d = {{ of = \"bob\", to = \"nail\", quantity = \"distance\" }}\n",
        turned("stiffness", "100 * d")
    );
    near(push(SPRING, &apart), -11.0);
    // a latch: once the bob is fast the band is gone for good
    let latch = "[networks.n.controls.latch]\nlinks = \"band\"\nconnects = \"previous > 0 and v < 0.05\"\n\
                 inputs.v = { of = \"bob\", quantity = \"speed\" }\n";
    let mut world = world(&pulled(SPRING, latch));
    (0..200).for_each(|_| world.step().unwrap());
    let v = world.state().systems[0].v[1].x;
    assert!(v < -0.05 && v > -0.062, "{v}");
}

/// A condition on a number that a control drives may come to hold, whatever the number begins with: what switches a state is another part of the object.
#[test]
fn driven_parameters_switch_states() {
    let law = |go: f64| {
        format!(
            "{{ name = \"finite_state\", states = {{ open = \"0\", shut = \"-200*(D - L0)\" }}, parameters = {{ go = {go} }}, \
             transitions = {{ \"open -> shut\" = \"go > 0.5\", \"shut -> open\" = \"go < 0.5\" }} }}"
        )
    };
    let control = "[networks.n.controls.c]\nlinks = \"band\"\nparameter = \"go\"\nvalue = \"if(t < 9.5e-3 or t > 19.5e-3, 0, 1)\"\n";
    for go in [0.0, 1.0] {
        refused(&pulled(&law(go), ""), &["never fires"]);
        let mut world = world(&pulled(&law(go), control));
        let mut speed_after = |steps: usize| {
            (0..steps).for_each(|_| world.step().unwrap());
            world.state().systems[0].v[1].x
        };
        assert_eq!(speed_after(9), 0.0, "{go}");
        let pulled = speed_after(11);
        assert!(pulled < -0.1, "{go}: {pulled} m/s");
        let free = speed_after(2);
        assert_eq!(speed_after(5), free, "{go}");
    }
}

/// The same bits from a snapshot on: what controls remember is State.
#[test]
fn driven_parameters_are_state() {
    let control = "[networks.n.controls.latch]\nlinks = \"band\"\nconnects = \"previous > 0 and v < 0.05\"\n\
                   inputs.v = { of = \"bob\", quantity = \"speed\" }\n";
    let mut one = world(&pulled(SPRING, control));
    (0..20).for_each(|_| one.step().unwrap());
    let mut two = world(&pulled(SPRING, control));
    two.resume(one.state().clone()).unwrap();
    (0..20).for_each(|_| {
        one.step().unwrap();
        two.step().unwrap();
    });
    assert_eq!(one.state().systems[0].q, two.state().systems[0].q);
    assert_eq!(one.state().driven, two.state().driven);
}

#[test]
fn wrong_controls_are_refused() {
    let with = |control: &str| pulled(SPRING, &format!("[networks.n.controls.c]\n{control}\n"));
    refused(&with("links = \"bond\"\nconnects = \"t < 1\""), &["no links `bond`", "band"]);
    refused(&with("links = \"band\""), &["does not say what it does"]);
    refused(&with("links = \"band\"\nconnects = \"t <\""), &["connects"]);
    refused(
        &with("links = \"band\"\nparameter = \"mass\"\nvalue = \"1\""),
        &["no `mass` that can be driven", "one of stiffness"],
    );
    // without the control its condition would never hold, which is not what is wrong
    let switched = pulled(
        "{ name = \"finite_state\", states = { on = \"-k*(D-L0)\", off = \"0\" }, transitions = { \"on -> off\" = \"s > 0.5\" }, parameters = { k = \"100 N/m\", s = 0 } }",
        "[networks.n.controls.c]\nlinks = \"band\"\nparameter = \"ss\"\nvalue = \"1\"\n",
    );
    refused(&switched, &["no `ss` that can be driven", "k, s"]);
    refused(&with("connects = \"t < 1\""), &["does not say what it drives", "links, crowds or actuator"]);
    refused(&with("crowds = \"band\"\nconnects = \"t < 1\""), &["no crowds `band`"]);
    let bent = pulled(
        "{ name = \"cohesion\", distance = 1, peak = 1.2, range = 1.5, cohesion = 4 }",
        "[networks.n.controls.c]\nlinks = \"band\"\nparameter = \"viscosity\"\nvalue = \"1\"\n",
    );
    refused(&bent, &["no `viscosity` that can be driven", "distance, hard, peak, range"]);
    refused(
        &with("links = \"band\"\nconnects = \"x > 0\"\ninputs.x = { of = \"bob\", quantity = \"position\" }"),
        &["`x` is a vector", "component"],
    );
    refused(
        &with("links = \"band\"\nconnects = \"x > 0\"\ninputs.x = { of = \"bib\", quantity = \"speed\" }"),
        &["no group of masses `bib`"],
    );
    let twice = "[networks.n.controls.c]\nlinks = \"band\"\nconnects = \"t < 1\"\n[networks.n.controls.d]\nlinks = \"band\"\nconnects = \"t < 2\"\n";
    refused(&pulled(SPRING, twice), &["two controls connect the links `band`"]);
}

/// Two balls of 1 kg that press each other, 9 cm apart, under crowds that reach 10 cm.
fn pressed(law: &str, more: &str, controls: &str) -> String {
    format!(
        "[networks.n.masses.nail]\npositions = [[0, 0, 0]]\nmass = 1\nfixed = true\n\
         [networks.n.masses.bob]\npositions = [[0.09, 0, 0]]\nmass = 1\n\
         [[networks.n.crowds]]\nname = \"touch\"\nlaw = {law}\n{more}{controls}"
    )
}

const BALL: &str = "{ name = \"ball\", threshold = 0.1, stiffness = 100 }";

/// What acts between masses that come near is driven as links are: parted, made slowly, its numbers turned.
#[test]
fn crowds_are_driven() {
    let push = |text: &str| {
        let mut world = world(text);
        world.step().unwrap();
        world.state().systems[0].v[1].x / 1e-3
    };
    let near = |measured: f64, expected: f64| {
        assert!((measured - expected).abs() < 1e-9, "{measured}, not {expected}")
    };
    let control = |what: &str| format!("[networks.n.controls.c]\ncrowds = \"touch\"\n{what}\n");
    let friction = "friction = { static = 0.6, kinetic = 0.5, stiffness = 50, damping = 1, speed = 0.01 }\n";
    for more in ["", friction] {
        near(push(&pressed(BALL, more, "")), 1.0);
        near(push(&pressed(BALL, more, &control("connects = \"t > 1\""))), 0.0);
        near(push(&pressed(BALL, more, &control("connects = \"t > 1\"\nramp = \"4 ms\""))), 0.75);
        let stiffer = control("parameter = \"stiffness\"\nvalue = \"300\"");
        near(push(&pressed(BALL, more, &stiffer)), 3.0);
        // half of three times
        let both = format!(
            "{stiffer}[networks.n.controls.d]\ncrowds = \"touch\"\nconnects = \"t > 1\"\nramp = \"2 ms\"\n"
        );
        near(push(&pressed(BALL, more, &both)), 1.5);
    }
    // what it makes is booked: half the energy of a ball pressed by 1 cm
    let mut world = world(&pressed(BALL, "", &control("connects = \"t > 1\"")));
    world.step().unwrap();
    let energy = world.energy();
    near(energy.made_by_control[0].1, -0.5 * 100.0 * 0.01 * 0.01);
    near(energy.total() - energy.made_by_control[0].1, 0.005);
}

/// A control that leaves the range of a parameter, or that of the pairs that are looked for, stops the run with its numbers.
#[test]
fn numbers_that_make_no_law_are_told() {
    let stopped = |text: &str, words: &[&str]| {
        let mut world = world(text);
        let error = (0..20).find_map(|_| world.step().err()).expect("the run stops").to_string();
        for word in words {
            assert!(error.contains(word), "`{word}` is not in: {error}");
        }
    };
    let control =
        "[networks.n.controls.c]\nlinks = \"band\"\nparameter = \"stiffness\"\nvalue = \"5 - 1000*t\"\n";
    stopped(
        &pulled(SPRING, control),
        &["n.links[0]", "`stiffness` is -1", "must be a number of at least 0 [N/m]", "time"],
    );
    let wider =
        "[networks.n.controls.c]\ncrowds = \"touch\"\nparameter = \"threshold\"\nvalue = \"0.1 + t\"\n";
    stopped(&pressed(BALL, "", wider), &["n.crowds[0]", "act up to 0.101 m", "within 0.1 m", "`range`"]);
    let mut world = world(&pressed(BALL, "range = 0.2\n", wider));
    (0..20).for_each(|_| world.step().unwrap());
    // from 2 cm beyond on
    assert!(world.state().systems[0].v[1].x > 0.0);
}

/// A cart whose motor is commanded moves by `x' = x + h v + h² u/2m` exactly, with the command cut off at the largest; what the control made,
/// less what is stored, is the work `Σ u Δx`, which is the kinetic energy.
#[test]
fn actuators_are_commanded() {
    let text = "[networks.n.masses.cart]\npositions = [[0.5, 0, 0], [1.5, 0, 0]]\nmass = 1\n\
        [networks.n.actuators.motor]\nof = \"cart\"\ndirection = [2, 0, 0]\nlargest = \"30 N\"\n\
        [networks.n.controls.drive]\nactuator = \"motor\"\nvalue = \"-50 * x - 20 * v\"\n\
        inputs.x = { of = \"cart\", quantity = \"position\", component = \"x\" }\n\
        inputs.v = { of = \"cart\", quantity = \"velocity\", component = \"x\" }\n";
    let text =
        format!("format = 1\n[world]\nperiod = \"1 ms\"\n[systems.main]\nstepper = \"verlet\"\n{text}");
    let scene = read_text("net.toml", &text, Path::new("."), &[]).unwrap_or_else(|faults| panic!("{faults}"));
    let mut world = scene.model.start(scene.state);
    let (mut x, mut v, mut work, h, mass) = (1.0_f64, 0.0_f64, 0.0_f64, 1e-3, 2.0);
    for _ in 0..500 {
        world.step().unwrap();
        let u = (-50.0 * x - 20.0 * v).clamp(-30.0, 30.0);
        let dx = h * v + 0.5 * h * h * u / mass;
        (x, v, work) = (x + dx, v + h * u / mass, work + u * dx);
    }
    let state = &world.state().systems[0];
    // sums of 500 roundings
    assert!(
        (state.q[0].x + 0.5 - x).abs() < 1e-13 && (state.v[1].x - v).abs() < 1e-13,
        "{state:?}, not {x}, {v}"
    );
    let energy = world.energy();
    let stored: f64 = energy.by_force.iter().map(|(_, energy)| energy.stored).sum();
    assert_eq!(energy.made_by_control[0].0, "n.drive");
    let done = energy.made_by_control[0].1 - stored;
    assert!((done - work).abs() < 1e-11 && (energy.kinetic - work).abs() < 1e-11, "{done} J, not {work} J");
}

/// What an actuator lacks is said where it is.
#[test]
fn wrong_actuators_are_refused() {
    let with = |actuator: &str, controls: &str| {
        let actuator = format!("[networks.n.actuators.motor]\n{actuator}\n");
        pulled(SPRING, &format!("{actuator}{controls}"))
    };
    let drive = "[networks.n.controls.c]\nactuator = \"motor\"\nvalue = \"1\"\n";
    let again = "[networks.n.controls.d]\nactuator = \"motor\"\nvalue = \"1\"\n";
    let good = "of = \"bob\"\ndirection = [1, 0, 0]";
    assert!(scene(&with(good, drive)).is_ok());
    refused(&with(good, ""), &["actuator `motor` is not commanded by one control"]);
    refused(&with(good, &format!("{drive}{again}")), &["actuator `motor` is not commanded by one control"]);
    refused(&with("of = \"bib\"\ndirection = [1, 0, 0]", drive), &["no group of masses `bib`", "bob"]);
    refused(&with("of = \"bob\"\ndirection = [0, 0, 0]", drive), &["a direction of no length"]);
    let of = |control: &str| with(good, &format!("{drive}[networks.n.controls.e]\n{control}\n"));
    refused(&of("actuator = \"engine\"\nvalue = \"1\""), &["no actuators `engine`", "motor"]);
    refused(
        &of("actuator = \"motor\"\nconnects = \"t < 1\""),
        &["commands an actuator", "value, plan or table, alone"],
    );
    refused(&of("actuator = \"motor\"\nlinks = \"band\"\nvalue = \"1\""), &["drives several things"]);
}

/// Commands of a plan act period by period, cut off at the largest, and the last goes on; what is wrong with a plan is said with its line.
#[test]
fn plans_are_read() {
    let text = "format = 1\n[world]\nperiod = \"10 ms\"\n[systems.main]\nstepper = \"verlet\"\n\
        [networks.n.masses.cart]\npositions = [[0, 0, 0]]\nmass = 2\n\
        [networks.n.actuators.motor]\nof = \"cart\"\ndirection = [1, 0, 0]\nlargest = 6\n\
        [networks.n.controls.drive]\nactuator = \"motor\"\nplan = \"a.csv\"\n";
    let read = |plan: &str| read_text_with_files("net.toml", text, &[("a.csv", plan)], &[]);
    let head = "time [s],n.else [N],n.drive [N]\n";
    let scene =
        read(&format!("{head}0,5,4\n\n0.01,5,-8\n0.02,5,2\n")).unwrap_or_else(|faults| panic!("{faults}"));
    let mut world = scene.model.start(scene.state);
    let mut speed = 0.0;
    for command in [4.0, -6.0, 2.0, 2.0] {
        world.step().unwrap();
        speed += 0.01 * command / 2.0;
        assert!((world.state().systems[0].v[0].x - speed).abs() < 1e-15, "{command} N");
    }
    for (plan, words) in [
        ("", "no column is of `n.drive`"),
        ("time [s],n.driven [N]\n0,1\n", "no column is of `n.drive`"),
        (head, "it has no rows"),
        (&format!("{head}0,5\n"), "line 2: the row is \"0,5\""),
        (&format!("{head}0,5,4\n0.01,5,NaN\n"), "line 3: the row is \"0.01,5,NaN\""),
        (&format!("{head}0,x,5,4\n"), "line 2: the row is \"0,x,5,4\""),
        ("n.drive [N]\n0\n", "no column is of `n.drive`"),
        ("time [ms],n.drive [N]\n0,4\n", "a column is `time [ms]`"),
        (&format!("{head}0,5,4\n0.02,5,4\n"), "line 3 is of 0.02 s"),
    ] {
        let message = read(plan).err().expect("a refusal").to_string();
        assert!(message.contains(words) && message.contains("a.csv"), "`{words}` is not in:\n{message}");
    }
    let message = read_text_with_files("net.toml", text, &[], &[]).err().expect("a refusal").to_string();
    assert!(
        message.contains("a.csv") && message.contains("a plan, as `souple sweep` writes it"),
        "{message}"
    );
}

/// Gains of a plan answer to what masses are off, up to the largest, and are left aside where that is asked for.
#[test]
fn gains_answer_to_deviations() {
    let text = "format = 1\n[world]\nperiod = \"10 ms\"\n[systems.main]\nstepper = \"verlet\"\n\
        [networks.n.masses.cart]\npositions = [[0, 0, 0], [1, 0, 0]]\nmass = 2\n\
        [networks.n.actuators.motor]\nof = \"cart\"\ndirection = [1, 0, 0]\nlargest = 6\n\
        [networks.n.controls.drive]\nactuator = \"motor\"\nplan = \"a.csv\"\n";
    let read = |text: &str, plan: &str| read_text_with_files("net.toml", text, &[("a.csv", plan)], &[]);
    let head =
        "time [s],n.drive [N],n[1].x [m],n[0].v.x [m/s],n.drive / n[1].x [N/m],n.drive / n[0].v.x [N s/m]\n";
    let plan = format!("{head}0,1,0.5,0.25,2,4\n0.01,1,0.5,0.25,2,400\n0.02,0,0,0,0,0\n");
    let start = |text: &str| {
        let scene = read(text, &plan).unwrap_or_else(|faults| panic!("{faults}"));
        scene.model.start(scene.state)
    };
    let (mut world, mut without) = (start(text), start(&format!("{text}feedback = false\n")));
    let (mut x, mut v, mut speed, h, mass) = (1.0_f64, 0.0_f64, 0.0_f64, 0.01, 4.0);
    for (command, gain) in [(1.0, [2.0, 4.0]), (1.0, [2.0, 400.0]), (0.0, [0.0; 2])] {
        world.step().unwrap();
        without.step().unwrap();
        let u = (command - gain[0] * (x - 0.5) - gain[1] * (v - 0.25)).clamp(-6.0, 6.0);
        (x, v) = (x + h * v + 0.5 * h * h * u / mass, v + h * u / mass);
        speed += h * command / mass;
        // a few roundings
        let state = &world.state().systems[0];
        assert!((state.q[1].x - x).abs() < 1e-14 && (state.v[0].x - v).abs() < 1e-14, "{state:?}");
        assert!((without.state().systems[0].v[0].x - speed).abs() < 1e-15);
    }
    for (from, to, words) in [
        ("n.drive / n[1].x", "n.drive / n[2].x", "a gain is of `n[2].x`"),
        ("n.drive / n[1].x", "n.drive / n[1].w", "a gain is of `n[1].w`"),
        (",n[1].x", ",n[1].y", "a gain is of `n[1].x`"),
    ] {
        let message = read(text, &plan.replacen(from, to, 1)).err().expect("a refusal").to_string();
        assert!(message.contains(words) && message.contains("`n[0].x` to `n[1].v.z`"), "{message}");
    }
    let idle = text.replace("plan = \"a.csv\"", "value = \"1\"\nfeedback = true");
    let message = read(&idle, &plan).err().expect("a refusal").to_string();
    assert!(message.contains("has no plan"), "{message}");
}

/// Commands of a table act by the state that a control reads, between entries by straight lines; what is wrong with a table is said with its line.
#[test]
fn tables_are_read() {
    let text = "format = 1\n[world]\nperiod = \"10 ms\"\n[systems.main]\nstepper = \"verlet\"\n\
        [networks.n.masses.cart]\npositions = [[0.25, 0, 0]]\nmass = 2\nvelocity = [1, 0, 0]\n\
        [networks.n.actuators.motor]\nof = \"cart\"\ndirection = [1, 0, 0]\nlargest = 6\n\
        [networks.n.controls.drive]\nactuator = \"motor\"\ntable = \"a.csv\"\n\
        inputs.x = { of = \"cart\", quantity = \"position\", component = \"x\" }\n\
        inputs.v = { of = \"cart\", quantity = \"velocity\", component = \"x\" }\n";
    let read = |text: &str, table: &str| read_text_with_files("net.toml", text, &[("a.csv", table)], &[]);
    let speed_after = |text: &str, table: &str| {
        let scene = read(text, table).unwrap_or_else(|faults| panic!("{faults}"));
        let mut world = scene.model.start(scene.state);
        world.step().unwrap();
        world.state().systems[0].v[0].x
    };
    let head = "x,v,n.drive [N],value [s]\n";
    let rows = "0,0,1,2\n0,4,3,2\n1,0,5,2\n1,4,-1,2\n";
    // at x = 1/4, v = 1: 3/4 (3/4 1 + 1/4 3) + 1/4 (3/4 5 + 1/4 (-1))
    let command = 0.75 * (0.75 + 0.25 * 3.0) + 0.25 * (0.75 * 5.0 - 0.25);
    let speed = speed_after(text, &format!("{head}{rows}"));
    assert!((speed - (1.0 + 0.01 * command / 2.0)).abs() < 1e-15, "{speed}");
    let nearest = format!("{text}lookup = \"nearest\"\n");
    assert!((speed_after(&nearest, &format!("{head}{rows}")) - 1.005).abs() < 1e-15);
    // what leads nowhere has no say, and largest bounds what is read
    let nowhere = rows.replace("0,0,1,2", "0,0,0,inf").replace("0,4,3,2", "0,4,0,inf").replace("-1,2", "5,2");
    assert!((speed_after(text, &format!("{head}{nowhere}")) - 1.025).abs() < 1e-15);
    assert!((speed_after(text, &format!("{head}{}", nowhere.replace(",5,", ",50,"))) - 1.03).abs() < 1e-15);
    // formulas of inputs are numbers of the state
    let scaled = format!("{text}states.far.value = \"4 * x\"\n");
    let speed = speed_after(&scaled, "far,n.drive [N]\n0,2\n2,4\n");
    assert!((speed - (1.0 + 0.01 * 3.0 / 2.0)).abs() < 1e-15, "{speed}");
    for (table, words) in [
        ("", "columns x, v, `n.drive [N]` and `value [s]`"),
        ("v,x,n.drive [N]\n0,0,1\n", "its columns are `v, x, n.drive`"),
        (head, "0 rows for 0 states"),
        (&format!("{head}0,0,1\n"), "line 2: the row is \"0,0,1\""),
        (&format!("{head}0,0,inf,2\n"), "line 2: the row is \"0,0,inf,2\""),
        (&format!("{head}0,0,1,2\n1,4,1,2\n"), "line 3 is out of its place"),
        (&format!("{head}0,4,1,2\n0,0,1,2\n"), "line 2 is out of its place"),
    ] {
        let message = read(text, table).err().expect("a refusal").to_string();
        assert!(message.contains(words) && message.contains("a.csv"), "`{words}` is not in:\n{message}");
    }
    let idle = text.replace("table = \"a.csv\"", "value = \"1\"\nlookup = \"linear\"");
    let message = read(&idle, "").err().expect("a refusal").to_string();
    assert!(message.contains("has no table"), "{message}");
    let message =
        read(&format!("{text}states.far.value = \"4 * z\"\n"), "").err().expect("a refusal").to_string();
    assert!(message.contains("a formula of x, v"), "{message}");
}
