//! Contacts between masses whose forces are solved for: signs and friction, momenta and energy, what is refused.

use souple_engine::{Force, Pair, World};
use souple_models::network::{RigidBalls, SidedConstraints};

use crate::worlds::{assert_goes_on, read, started, stepped};

/// A ball of 0.1 m between two walls, of which one comes nearer.
const SQUEEZED: &str = r#"
format = 1
[world]
period = "1 ms"
gravity = [0, 0, 0]
[systems.main]
stepper = "t_simulation"
[networks.n.masses.ball]
positions = [[0.1, 0, 0]]
mass = 0.1
[[networks.n.constraints]]
name = "left"
plane = { place = [0.05, 0, 0], normal = [1, 0, 0], motion = { times = [0, 1e-3, 2e-3], offsets = [[0, 0, 0], [2e-8, 0, 0], [1e-5, 0, 0]] } }
sense = "at_least"
radius = 0.05
[[networks.n.constraints]]
name = "right"
plane = { place = [0.15, 0, 0], normal = [-1, 0, 0] }
sense = "at_least"
radius = 0.05
"#;

/// Contacts that contradict each other by less than a millionth of where they are, here 1e-7 m, are let pass and told; by more they end the run.
#[test]
fn little_contradictions_are_let_pass() {
    let mut world = started(SQUEEZED, &[]);
    world.step().unwrap();
    let report = world.last_report();
    assert_eq!(report.wedged_steps, 1, "{report:?}");
    // one of the walls asks for half of what they are too near at least, and none for more, to rounding of coordinates
    assert!((1e-8..=2e-8 + 1e-16).contains(&report.contacts_wedged), "{report:?}");
    let refused = world.step().expect_err("walls 0.01 mm too near");
    assert!(refused.to_string().contains("no forces bring it there"), "{refused}");
}

/// A ball on a slope against which a wall comes, with so much friction that it cannot slide up: what presses it grows beyond all bounds, and the run ends
/// before the ball is thrown anywhere. With less friction it is lifted.
#[test]
fn what_locks_itself_ends_the_run() {
    let wedge = |friction: f64| {
        format!(
            "format = 1\n[world]\nperiod = \"2 ms\"\ngravity = [0, 0, -9.81]\n[systems.main]\nstepper = \"t_simulation\"\n\
             [networks.n.masses.ball]\npositions = [[0, 0, 0.04]]\nmass = 0.1\n\
             [[networks.n.constraints]]\nname = \"slope\"\nplane = {{ place = [0, 0, 0], normal = [-0.55, 0, 1] }}\nsense = \"at_least\"\nradius = 0.03\nfriction = {friction}\n\
             [[networks.n.constraints]]\nname = \"wall\"\nplane = {{ place = [-0.05, 0, 0], normal = [1, 0, 0], motion = {{ times = [0, 0.5, 1.5], offsets = [[0, 0, 0], [0, 0, 0], [0.05, 0, 0]] }} }}\nsense = \"at_least\"\nradius = 0.03\nfriction = {friction}\n"
        )
    };
    for friction in [0.65, 0.75, 0.9] {
        let mut world = started(&wedge(friction), &[]);
        let refused = (0..750).find_map(|_| {
            let height = world.state().systems[0].q[0].z;
            assert!(height < 0.1, "{friction}: {height}");
            world.step().err()
        });
        let refused =
            refused.unwrap_or_else(|| panic!("{friction}: {:?}", world.state().systems[0].q)).to_string();
        assert!(
            refused.contains("lock themselves") || refused.contains("no forces bring it there"),
            "{refused}"
        );
    }
    let lifted = stepped(started(&wedge(0.3), &[]), 750).state().systems[0].q[0];
    assert!(lifted.z > 0.04 && lifted.z < 0.1, "{lifted:?}");
}

/// Two balls side by side that fall between walls which friction lets nothing slide up: their collisions have no forces by the law, and give nothing back then.
/// The balls come to rest where they are, pressed as much as their weight asks for, not beyond all bounds, and go on resting.
#[test]
fn jammed_balls_come_to_rest() {
    let wall = |name: &str, x: f64, friction: f64| {
        format!(
            "[[networks.n.constraints]]\nname = \"{name}\"\nplane = {{ place = [0, 0, 0], normal = [{x}, 0, 1] }}\nsense = \"at_least\"\nradius = 0.03\nfriction = {friction}\nrestitution = 0.3\n"
        )
    };
    for friction in [0.5, 0.9] {
        let scene = format!(
            "format = 1\n[world]\nperiod = \"2 ms\"\ngravity = [0, 0, -9.81]\n[systems.main]\nstepper = \"t_simulation\"\n\
             [networks.n.masses.b]\npositions = [[-0.035, 0, 0.2], [0.035, 0, 0.2]]\nmass = 0.1\n\
             [[networks.n.constraints]]\nname = \"balls\"\nballs = {{ diameter = 0.06 }}\nfriction = {friction}\n{}{}",
            wall("left", 2.0, friction),
            wall("right", -2.0, friction)
        );
        let mut world = started(&scene, &[]);
        let mut jammed = 0;
        for _ in 0..300 {
            world.step().unwrap();
            jammed += world.last_report().wedged_steps;
        }
        assert!(jammed > 0);
        let state = &world.state().systems[0];
        for (x, v) in state.q.iter().zip(&state.v) {
            // they hang where they came to touch both their wall and each other, and leave it by what jams are let pass
            assert!((x.x.abs() - 0.03).abs() < 1e-6 * 0.2 && v.length() < 1e-3, "{friction}: {x:?}, {v:?}");
        }
    }
}

/// Twelve balls that fall onto a floor, into each other, beside a rigid triangle.
const FALLING: &str = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, -9.81, 0]
[systems.main]
stepper = "t_simulation"
steps_per_period = 5
[networks.heap.masses.balls]
lattice = { origin = [0, 0.06, 0], spacing = 0.11, counts = [3, 4, 1] }
velocity = [0.2, 0, 0.1]
mass = 0.1
[networks.heap.masses.triangle]
positions = [[0.4, 0.2, 0], [0.5, 0.2, 0], [0.45, 0.32, 0.02]]
mass = 0.2
[[networks.heap.constraints]]
name = "rods"
of = ["triangle"]
rod = { all = true }
[[networks.heap.constraints]]
name = "balls"
balls = { diameter = 0.1 }
friction = 0.3
[[networks.heap.constraints]]
name = "floor"
plane = { place = [0, 0, 0], normal = [0.1, 1, 0] }
sense = "at_least"
radius = 0.05
friction = 0.5
[[networks.heap.constraints]]
name = "wall"
plane = { place = [0.8, 0, 0], normal = [-1, 0, 0] }
sense = "at_least"
radius = 0.05
"#;

/// Of each contact its gap [m], and what presses along and across it [N].
fn contacts(world: &World) -> Vec<[f64; 3]> {
    let mut found = Vec::new();
    world.visit_forces(0, &mut |force: &dyn Force, at| {
        let Some(unilateral) = force.unilateral() else { return };
        for contact in 0..unilateral.contact_count(at.pairs) {
            let gap = unilateral.gap(contact, at.pairs, at.positions, at.time);
            let normal = unilateral.slope(contact, at.pairs, at.positions, at.time);
            let push = unilateral.force(contact, at.memory, at.pairs);
            let along = push.dot(normal);
            found.push([gap, along, (push - normal * along).length()]);
        }
    });
    found
}

/// Gaps stay open, forces push, only what is closed presses, and friction is within its cone, in every step of a fall and after it.
#[test]
fn forces_and_gaps_are_complementary() {
    let mut world = started(FALLING, &[]);
    let mut pressing = 0;
    for step in 0..150 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        for [gap, along, across] in contacts(&world) {
            // 1e-7 of what a step would sink without forces, at the speed of the fall some millimetres
            assert!(gap > -1e-9, "step {step}: {gap}");
            assert!(along >= 0.0, "step {step}: {along}");
            // normals have turned from where the step started by its way, a hundredth of a ball at most
            assert!(across <= 0.5 * along + 0.03 * along.max(1e-6), "step {step}: {across} of {along}");
            if along > 1e-6 {
                pressing += 1;
                assert!(gap < 1e-9, "step {step}: {gap} with {along}");
            }
        }
    }
    assert!(pressing > 500, "{pressing}");
}

/// What is found by the grid is what is said pair by pair.
#[test]
fn balls_are_rods_that_keep_apart() {
    let text = FALLING
        .replace("of = [\"triangle\"]\nrod = { all = true }", "of = [\"triangle\"]\nrod = { chain = true }");
    let mut searched = started(&text, &["networks.heap.constraints[1].of=[\"balls\"]"]);
    let pairs = text.replace(
        "balls = { diameter = 0.1 }",
        "of = [\"balls\"]\nrod = { all = true, length = 0.1 }\nsense = \"at_least\"",
    );
    let mut told = started(&pairs, &[]);
    for _ in 0..20 {
        searched.step().unwrap();
        told.step().unwrap();
    }
    for (a, b) in searched.state().systems[0].q.iter().zip(&told.state().systems[0].q) {
        // a hundred steps, each solved to 1e-7 of some millimetres
        assert!((*a - *b).length() < 1e-7, "{a:?} {b:?}");
    }
}

/// A run that goes on from its state makes the same bits, and so do any number of threads.
#[test]
fn contacts_go_on_from_state() {
    assert_goes_on(FALLING, 20);
}

const LATE: &str = "world.collisions=\"one_period_late\"";

/// A ball that flies at another.
const FLYING: &str = r#"
format = 1
[world]
period = "100 ms"
gravity = [0, 0, 0]
[systems.main]
stepper = "t_simulation"
steps_per_period = 100
[networks.pair.masses.thrown]
positions = [[0, 0, 0]]
velocity = [3, 0, 0]
mass = 1
[networks.pair.masses.waiting]
positions = [[1, 0, 0]]
mass = 1
[[networks.pair.constraints]]
name = "balls"
balls = { diameter = 0.1 }
"#;

/// A ball that comes three diameters within a period, looked for beside the steps, does not pass another: it shares its momentum with it.
#[test]
fn fast_balls_do_not_pass_when_looked_for_late() {
    let speeds = |settings: &[&str]| {
        let mut world = started(FLYING, settings);
        (0..10).for_each(|_| {
            world.step().unwrap();
        });
        [0, 1].map(|ball| world.state().systems[0].v[ball].x)
    };
    let (late, in_time) = (speeds(&[LATE]), speeds(&[]));
    for ball in 0..2 {
        // half the momentum each, to the 1e-7 of their approach that contacts are solved to
        assert!((in_time[ball] - 1.5).abs() < 1e-6, "{in_time:?}");
        // the same contact, listed earlier or later
        assert!((late[ball] - in_time[ball]).abs() < 1e-12, "{late:?} {in_time:?}");
    }
}

/// Where balls move little pairs found beside the steps are used, and forces are those of a search in every step.
#[test]
fn heaps_fall_alike_when_looked_for_late() {
    let mut late = started(FALLING, &[LATE]);
    let mut in_time = started(FALLING, &[]);
    let mut used = 0;
    for _ in 0..20 {
        // what is left in State was not searched anew by a step, and is used by this period
        used += usize::from(!late.state().systems[0].detected.positions.is_empty());
        late.step().unwrap();
        in_time.step().unwrap();
        for [gap, along, _] in contacts(&late) {
            assert!(gap > -1e-9 && along >= 0.0, "{gap} {along}");
        }
    }
    assert!(used > 0);
    for (a, b) in late.state().systems[0].q.iter().zip(&in_time.state().systems[0].q) {
        // a hundred steps, each solved to 1e-7 of some millimetres
        assert!((*a - *b).length() < 1e-7, "{a:?} {b:?}");
    }
}

/// A ball that flies off far away makes no contacts of balls that rest apart.
#[test]
fn fast_balls_make_no_contacts_of_others() {
    let text = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, 0, 0]
[systems.main]
stepper = "t_simulation"
[networks.n.masses.resting]
lattice = { origin = [0, 0, 0], spacing = 0.5, counts = [3, 3, 3] }
mass = 1
[networks.n.masses.flying]
positions = [[100, 0, 0]]
velocity = [100, 0, 0]
mass = 1
[[networks.n.constraints]]
balls = { diameter = 0.1 }
"#;
    // 2 m in a step at twice its speed: four spacings
    let mut world = started(text, &[]);
    world.step().unwrap();
    assert!(contacts(&world).is_empty());
}

/// Of two balls on one rod, of one ball twice and of two in the wrong order there is no pair; friction at centres turns pairs.
#[test]
fn pairs_of_balls_are_those_that_meet() {
    for (friction, is_internal) in [("0.3", false), ("0", true)] {
        let world = started(FALLING, &[&format!("networks.heap.constraints[1].friction={friction}")]);
        let mut count = 0;
        world.visit_forces(0, &mut |force, _| {
            if !force.as_any().is::<RigidBalls>() {
                return;
            }
            count += 1;
            let accepted = [(0, 1), (11, 12), (1, 0), (3, 3), (12, 13), (13, 14), (0, 15)]
                .map(|(a, b)| force.accepts_pair(&Pair::new(a, b, [0.0; 8])));
            assert_eq!(accepted, [true, true, false, false, false, false, false]);
            assert_eq!(force.declaration().internal, is_internal);
        });
        assert_eq!(count, 1);
    }
}

/// A ball does not meet itself as one of two groups.
#[test]
fn groups_of_balls_that_share_masses_are_refused() {
    let part = r#"
[modules.two.masses.ends]
positions = [[0, 0.3, 0], [0.2, 0.3, 0]]
mass = 0.1
[modules.two.ports]
left = { kind = "M", of = "ends", mass = 0 }
[networks.heap.modules.x]
module = "two"
translate = [1, 0, 0]
"#;
    let text = format!("{FALLING}{part}");
    let between = |one: &str, other: &str| {
        let setting = format!(
            "networks.heap.constraints=[{{ balls = {{ diameter = 0.1 }}, of = [\"{one}\", \"{other}\"] }}]"
        );
        read(&text, &[&setting]).map(|_| ())
    };
    assert_eq!(between("balls", "x.left"), Ok(()));
    assert_eq!(between("x", "x"), Ok(()));
    let message = between("x", "x.left").unwrap_err();
    assert!(message.contains("are in `x` and in `x.left`"), "{message}");
}

const BOUNCING: &str = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, -10, 0]
[systems.main]
stepper = "t_simulation"
[networks.ball.masses.ball]
positions = [[0, 1, 0]]
mass = 2
[[networks.ball.constraints]]
name = "floor"
plane = { place = [0, 0, 0], normal = [0, 1, 0] }
sense = "at_least"
restitution = 1
"#;

/// An elastic impact is the reversal of what led to it: a ball comes back to where it was let go, as often as it falls.
#[test]
fn elastic_impacts_are_reversible() {
    let mut world = started(BOUNCING, &[]);
    let mut heights = Vec::new();
    for _ in 0..2000 {
        world.step().unwrap();
        heights.push(world.state().systems[0].q[0].y);
    }
    let tops: Vec<f64> =
        heights.windows(3).filter(|it| it[1] >= it[0] && it[1] > it[2]).map(|it| it[1]).collect();
    assert!(tops.len() > 20, "{}", tops.len());
    for top in tops {
        // of 1 m and the first step below it, each impact solved to 1e-7 of the 4 cm of a step
        assert!((top - 1.0).abs() < 2e-3, "{top}");
    }
    let last = heights.iter().rev().take(100).fold(0.0_f64, |most, y| most.max(*y));
    let first = heights.iter().take(100).fold(0.0_f64, |most, y| most.max(*y));
    assert!((last - first).abs() < 1e-6 + 1e-3, "{first} {last}");
}

/// Collisions among balls keep the momentum, and what they take is what is missing.
#[test]
fn collisions_keep_momentum_and_account() {
    let text = r#"
format = 1
[world]
period = "10 ms"
[systems.main]
stepper = "t_simulation"
[networks.gas.masses.left]
lattice = { origin = [-0.5, 0, 0], spacing = 0.12, counts = [2, 3, 2] }
velocity = [1, 0.1, 0]
mass = 0.1
[networks.gas.masses.right]
lattice = { origin = [0.1, 0.03, 0.02], spacing = 0.12, counts = [2, 3, 2] }
velocity = [-1, 0, 0.1]
mass = 0.3
[[networks.gas.constraints]]
name = "balls"
balls = { diameter = 0.1 }
restitution = 0.6
friction = 0.2
[probes.momentum]
quantity = "momentum"
[probes.energy]
quantity = "energy.total"
[probes.given_off]
quantity = "energy.dissipated"
"#;
    let scene = read(text, &[]).unwrap();
    let probes = scene.probes;
    let mut world = scene.model.start(scene.state);
    let measured = |world: &mut World| [0, 1, 2].map(|index| probes[index].measure(world).numbers());
    let start = measured(&mut world);
    (0..100).for_each(|_| {
        world.step().unwrap();
    });
    let end = measured(&mut world);
    for axis in 0..3 {
        // equal and opposite to rounding
        assert!((start[0][axis] - end[0][axis]).abs() < 1e-12, "{start:?} {end:?}");
    }
    assert!(end[2][0] > 0.1, "{end:?}");
    // ½ m v² counts what each step has done, to rounding
    assert!((start[1][0] - end[1][0] - end[2][0]).abs() < 1e-12, "{start:?} {end:?}");
}

/// A rigid brick, joined by more rods than it needs, that strikes an inclined floor with one of its sixteen masses.
const STRIKING: &str = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, 0, -9.81]
[systems.main]
stepper = "t_simulation"
[networks.brick.masses.balls]
lattice = { spacing = 0.1, counts = [4, 2, 2] }
mass = 0.1
velocity = [0, 0, -8]
[[networks.brick.constraints]]
name = "rods"
rod = { reach = 0.145 }
[[networks.brick.constraints]]
name = "ground"
plane = { place = [0, 0, -0.08], normal = [0.2, 0.3, 1] }
sense = "at_least"
radius = 0.05
friction = 0.3
[probes.energy]
quantity = "energy.total"
[probes.residual]
body = "brick"
quantity = "contact_residual"
"#;

/// A mass that is stopped is pushed by what the whole body brings, in one step as far as its rods are long if they did not hold it: they do.
#[test]
fn bodies_that_strike_with_one_mass_stay_rigid() {
    let scene = read(STRIKING, &[]).unwrap();
    let (probes, start) = (scene.probes, scene.state.systems[0].q.clone());
    let mut world = scene.model.start(scene.state);
    let mut before = probes[0].measure(&mut world).numbers()[0];
    for step in 0..60 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        let places = &world.state().systems[0].q;
        for a in 0..start.len() {
            for b in 0..a {
                let stretch = (places[a] - places[b]).length() - (start[a] - start[b]).length();
                // rods hold to 1e-12 of coordinates of metres, and diagonals of the body to some such
                assert!(stretch.abs() < 1e-10, "step {step}: {a} {b} {stretch}");
            }
        }
        // 1e-7 of the 80 mm that a step would sink
        assert!(contacts(&world).iter().all(|[gap, along, _]| *gap > -1e-8 && *along >= 0.0), "step {step}");
        let residual = contacts(&world)
            .iter()
            .fold(0.0_f64, |worst, [gap, along, _]| worst.max(if *along > 0.0 { gap.abs() } else { -gap }));
        assert!(residual < 1e-8, "step {step}: {residual}");
        // of a plane, whose gap is a length
        let probed = probes[1].measure(&mut world).numbers()[0];
        assert!((probed - residual).abs() < 1e-15, "step {step}: {probed} {residual}");
        let energy = probes[0].measure(&mut world).numbers()[0];
        // the way of a step and where it ends differ by g h²/2 of 16 N: 8e-3 J in a step that turns what falls
        assert!(energy < before + 8e-3, "step {step}: {before} {energy}");
        before = energy;
    }
    assert!(before < 30.0, "{before}");
}

/// A wall that is led pushes what lies before it, and carries what sticks to it.
#[test]
fn led_walls_push_and_carry() {
    let carried = r#"networks.ball.constraints=[{ plane = { place = [0, 1, 0], normal = [0, 1, 0], motion = { formula = ["0.5 * t", "0.2 * t", 0] } }, sense = "at_least", friction = 1 }]"#;
    let mut world = started(BOUNCING, &[carried, "networks.ball.velocity=[0.5, 0.2, 0]"]);
    for step in 1..=100 {
        world.step().unwrap();
        let (time, q) = (0.01 * f64::from(step), world.state().systems[0].q[0]);
        assert!((q.x - 0.5 * time).abs() < 1e-6 && (q.y - 1.0 - 0.2 * time).abs() < 1e-6, "{step}: {q:?}");
    }
}

#[test]
fn wrong_contacts_are_refused() {
    let floor = |with: &str| {
        format!(
            "networks.heap.constraints=[{{ plane = {{ place = [0, 0, 0], normal = [0, 1, 0] }}, {with} }}]"
        )
    };
    let other = |kind: &str| format!("networks.heap.constraints=[{{ {kind} }}]");
    for (setting, words) in [
        (floor("sense = \"at_least\", restitution = 1.5"), "restitution"),
        (floor("sense = \"at_least\", friction = -1"), "friction"),
        (floor("sense = \"above\""), "sense"),
        (floor("restitution = 0.5"), "holds from both sides"),
        (floor("sense = \"at_least\", time = 1"), "what holds from one side holds at once"),
        (floor("sense = \"at_least\", radius = 0.07"), "mass 0 begins 1.000e-2 beyond a plane"),
        (floor("sense = \"at_most\""), "mass 0 begins 6.000e-2 beyond a plane"),
        (other("joint = { chain = true }, sense = \"at_least\""), "has no two sides"),
        (other("balls = { diameter = 0.12 }"), "masses 0 and 1 begin 0.11 m apart, within balls of 0.12 m"),
        (other("balls = { diameter = 0 }"), "diameter"),
        (other("balls = {}"), "diameter"),
        (other("balls = { diameter = 0.1 }, sense = \"at_least\""), "has no two sides"),
        (other("balls = { diameter = 0.1 }, radius = 1"), "masses are kept from each other"),
        (
            other("balls = { diameter = 0.1 }, of = [\"a\", \"b\", \"c\"]"),
            "`balls` is between one group and itself",
        ),
        (
            other("rod = { chain = true, length = 3 }, sense = \"at_most\", friction = 0.5"),
            "a string has nothing to rub on",
        ),
        (other("rod = { chain = true, length = 3 }, sense = \"at_least\""), "begins"),
        ("systems.main.stepper=verlet".to_owned(), "relates points by forces that are solved for"),
    ] {
        match read(FALLING, &[&setting]) {
            Ok(_) => panic!("{setting} is taken"),
            Err(message) => assert!(message.contains(words), "{setting}: {message}"),
        }
    }
}

/// What holds from one side is told apart from what holds from both.
#[test]
fn constraints_become_what_they_say() {
    let world = started(FALLING, &[]);
    let mut kinds = Vec::new();
    world.visit_forces(0, &mut |force, _| {
        if force.as_any().is::<SidedConstraints>() {
            kinds.push(("sided", force.name().to_owned()));
        } else if force.as_any().is::<RigidBalls>() {
            kinds.push(("balls", force.name().to_owned()));
        }
    });
    let names: Vec<(&str, &str)> = kinds.iter().map(|(kind, name)| (*kind, name.as_str())).collect();
    assert_eq!(names, [("balls", "heap.balls"), ("sided", "heap.floor"), ("sided", "heap.wall")]);
}

/// A plane without a `place` is one for each mass, through where that rests; with one it is the same for all.
#[test]
fn planes_without_a_place_are_floors_of_each_mass() {
    const RESTING: &str = r#"
format = 1
[world]
period = "10 ms"
gravity = [0, 0, -10]
[systems.main]
stepper = "t_simulation"
[networks.net.masses.all]
positions = [[0, 0, 0.3], [1, 0, 0.6]]
mass = 1
[[networks.net.constraints]]
plane = { normal = [0, 0, 1] }
sense = "at_least"
"#;
    let heights = |settings: &[&str]| {
        stepped(started(RESTING, settings), 100)
            .rows(0)
            .positions
            .iter()
            .map(|place| place.z)
            .collect::<Vec<_>>()
    };
    // to 1e-7 of what a step would sink, half a millimetre
    let is_at =
        |found: Vec<f64>, wanted: [f64; 2]| found.iter().zip(wanted).all(|(z, at)| (z - at).abs() < 1e-9);
    assert!(is_at(heights(&[]), [0.3, 0.6]));
    assert!(is_at(heights(&["networks.net.constraints[0].plane.place=[0, 0, 0]"]), [0.0, 0.0]));
}

/// Restitution 1 keeps the energy of a hit off the centre to first order of the step: half of it halves the error.
#[test]
fn hits_off_the_centre_keep_energy_to_first_order() {
    const FALLING_ROD: &str = r#"
format = 1
[world]
period = "16 ms"
[systems.main]
stepper = "t_simulation"
[networks.net.masses.ends]
positions = [[0, 0, 0.5], [0.4, 0, 0.7]]
velocity = [0, 0, -2]
mass = 1
[[networks.net.constraints]]
rod = { all = true }
[[networks.net.constraints]]
plane = { place = [0, 0, 0], normal = [0, 0, 1] }
sense = "at_least"
restitution = 1
"#;
    let error = |steps: u32| {
        let mut world = started(FALLING_ROD, &[&format!("systems.main.steps_per_period={steps}")]);
        (0..20).for_each(|_| world.step().unwrap());
        let kinetic: f64 = world.rows(0).velocities.iter().map(|velocity| 0.5 * velocity.length_sq()).sum();
        kinetic / 4.0 - 1.0
    };
    let [coarse, fine] = [error(8), error(16)];
    // -0.43 % at 2 ms; what is left of second order is the error itself, squared, over the share of the hit
    assert!((coarse + 0.0043).abs() < 1e-4, "{coarse}");
    assert!((coarse / fine - 2.0).abs() < 0.05, "{coarse} {fine}");
}
