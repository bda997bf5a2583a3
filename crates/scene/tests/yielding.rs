//! Constraints that give way where others brace them, contacts push them, or led masses draw them.

use souple_engine::{StepError, World};
use souple_math::Vec3;

use crate::worlds::{dissipated, started};

/// Masses of 1 kg, the first of which are fixed, on rods that bear 3 N, with forces on them [N].
struct Truss {
    places: Vec<Vec3>,
    fixed: usize,
    rods: Vec<[usize; 2]>,
    forces: Vec<Vec3>,
}

const LIMIT: f64 = 3.0;

impl Truss {
    /// Bays of a metre, each braced by both diagonals, held at the left and loaded at its lower right.
    fn cantilever(bays: usize, load: Vec3) -> Self {
        let places: Vec<Vec3> =
            (0..=bays).flat_map(|bay| [0.0, 1.0].map(|y| Vec3::new(bay as f64, y, 0.0))).collect();
        let mut rods = Vec::new();
        for bay in 0..bays {
            let [a, b, c, d] = [0, 1, 2, 3].map(|corner| 2 * bay + corner);
            rods.extend([[a, c], [b, d], [a, d], [b, c], [c, d]]);
        }
        let mut forces = vec![Vec3::ZERO; places.len()];
        forces[2 * bays] = load;
        Self { places, fixed: 2, rods, forces }
    }

    /// Masses anywhere in a cube, joined by chance, under forces that are.
    fn random(seed: u64) -> Self {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let count = 6 + (8.0 * next()) as usize;
        let mut vector = |scale: f64| Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * scale;
        let places: Vec<Vec3> = (0..count).map(|_| vector(4.0)).collect();
        let forces = (0..count).map(|_| vector(16.0)).collect();
        let mut rods = Vec::new();
        for a in 0..count {
            for b in a + 1..count {
                if b >= 3 && (b == a + 1 || next() < 0.5) {
                    rods.push([a, b]);
                }
            }
        }
        Self { places, fixed: 3, rods, forces }
    }

    fn world(&self) -> World {
        let list = |places: &[Vec3]| {
            let places: Vec<String> = places.iter().map(|x| format!("{:?}", x.to_array())).collect();
            format!("[{}]", places.join(", "))
        };
        let (from, to): (Vec<_>, Vec<_>) = self.rods.iter().map(|[a, b]| (*a, *b)).unzip();
        let loads: Vec<String> = self.forces[self.fixed..]
            .iter()
            .zip(&self.places[self.fixed..])
            .map(|(force, place)| {
                let (force, place) = (force.to_array(), place.to_array());
                format!("[[networks.truss.loads]]\nregion = {{ nearest = {place:?} }}\nforce = {force:?}\n")
            })
            .collect();
        let text = format!(
            "format = 1\n[world]\nperiod = \"1 ms\"\n[systems.main]\nstepper = \"t_simulation\"\n\
             [networks.truss.masses.held]\npositions = {}\nmass = 1\nfixed = true\n\
             [networks.truss.masses.joints]\npositions = {}\nmass = 1\n\
             [[networks.truss.constraints]]\nname = \"rods\"\nrod = {{ from = {from:?}, to = {to:?} }}\nyields_at = {LIMIT}\n{}",
            list(&self.places[..self.fixed]),
            list(&self.places[self.fixed..]),
            loads.concat()
        );
        started(&text, &[])
    }

    /// Accelerations under the pushes with the least `½ λ·A λ − b·λ` between limits, by Gauss–Seidel sweeps alone.
    fn accelerations(&self) -> Vec<Vec3> {
        let is_free = |mass: usize| mass >= self.fixed;
        let along: Vec<Vec3> = self
            .rods
            .iter()
            .map(|[a, b]| (self.places[*a] - self.places[*b]).try_normalised().unwrap())
            .collect();
        let mut accelerations: Vec<Vec3> = (0..self.places.len())
            .map(|mass| if is_free(mass) { self.forces[mass] } else { Vec3::ZERO })
            .collect();
        let mut pushes = vec![0.0_f64; self.rods.len()];
        for _ in 0..300_000 {
            let mut most = 0.0_f64;
            for ((rod, along), push) in self.rods.iter().zip(&along).zip(&mut pushes) {
                let [a, b] = *rod;
                let ends = f64::from(u8::from(is_free(a)) + u8::from(is_free(b)));
                let lengthening = along.dot(accelerations[a] - accelerations[b]);
                let wanted = (*push - lengthening / ends).clamp(-LIMIT, LIMIT);
                let change = wanted - *push;
                *push = wanted;
                most = most.max(change.abs());
                for (end, sign) in [(a, 1.0), (b, -1.0)] {
                    if is_free(end) {
                        accelerations[end] += *along * (sign * change);
                    }
                }
            }
            if most < 1e-13 {
                break;
            }
        }
        accelerations
    }

    /// Compares the first step with them.
    fn assert_is_solved(&self, what: &str) {
        let mut world = self.world();
        world.step().unwrap_or_else(|error| panic!("{what}: {error}"));
        let scale = self.forces.iter().map(|force| force.length()).fold(1.0, f64::max);
        for (v, a) in world.state().systems[0].v.iter().zip(self.accelerations()) {
            let found = *v * 1e3;
            // rods turn by h² a/L = 1e-5 at most in a step; what that changes of forces is as much of them, through chains of a dozen
            assert!((found - a).length() < 2e-4 * scale, "{what}: {found:?} {a:?}");
        }
    }
}

/// Trusses with more rods than they need give way as the problem of least work between limits says, and go on doing so.
#[test]
fn braced_cantilevers_give_way() {
    for bays in 2..=5 {
        for load in [
            Vec3::new(0.0, -0.5, 0.0),
            Vec3::new(0.0, -2.0, 0.0),
            Vec3::new(0.0, -6.0, 0.0),
            Vec3::new(3.0, -9.0, 0.0),
            Vec3::new(0.0, -30.0, 0.0),
        ] {
            let truss = Truss::cantilever(bays, load);
            let what = format!("{bays} bays under {load:?}");
            truss.assert_is_solved(&what);
            let mut world = truss.world();
            for step in 0..100 {
                world.step().unwrap_or_else(|error| panic!("{what}, step {step}: {error}"));
            }
        }
    }
}

#[test]
fn random_trusses_give_way() {
    for seed in 1..=60 {
        let truss = Truss::random(seed);
        truss.assert_is_solved(&format!("seed {seed}"));
        let mut world = truss.world();
        for step in 0..20 {
            world.step().unwrap_or_else(|error| panic!("seed {seed}, step {step}: {error}"));
        }
    }
}

/// A wire between a pin and one that moves away flows under its limit from the first step on, and takes the work of that.
#[test]
fn wires_between_led_masses_flow() {
    let mut world = started(
        r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = { name = "t_simulation", start = "trajectory" }
[networks.wire.masses.ends]
positions = [[0, 0, 0], [1, 0, 0]]
mass = 1
[[networks.wire.pins]]
region = { nearest = [0, 0, 0] }
[[networks.wire.pins]]
region = { nearest = [1, 0, 0] }
motion = { formula = ["0.2 * t", 0, 0] }
[[networks.wire.constraints]]
name = "wire"
rod = { chain = true }
yields_at = 7
"#,
        &[],
    );
    for step in 1..=100 {
        world.step().unwrap();
        let taken = 7.0 * 0.2 * 1e-3 * f64::from(step);
        let dissipated = dissipated(&mut world);
        // places are known to 2e-16 in each of a hundred steps, times 7 N
        assert!((dissipated - taken).abs() < 1e-12, "{dissipated} {taken}");
    }
}

/// A square of led masses that is sheared keeps its area; one that is opened flows.
#[test]
fn squares_of_led_masses_flow() {
    let square = |motion: &str| {
        started(
            &format!(
                "format = 1\n[world]\nperiod = \"1 ms\"\n[systems.main]\nstepper = \"t_simulation\"\n\
                 [networks.square.masses.corners]\npositions = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]\nmass = 1\n\
                 [[networks.square.pins]]\nregion = \"corners\"\nmotion = {{ formula = [{motion}, 0] }}\n\
                 [[networks.square.constraints]]\narea = {{}}\nyields_at = 2\n"
            ),
            &[],
        )
    };
    for (motion, flown) in [(r#""0.1 * y * t", 0"#, 0.0), (r#""0.1 * x * t", 0"#, 0.005)] {
        let mut world = square(motion);
        for _ in 0..50 {
            world.step().unwrap();
        }
        let dissipated = dissipated(&mut world);
        assert!((dissipated - 2.0 * flown).abs() < 1e-12, "{motion}: {dissipated}");
    }
}

/// A mass that is thrown against a rod which yields gives all its energy to it: heat is the work of the flow.
#[test]
fn heat_is_the_work_of_the_flow() {
    let text = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = { name = "t_simulation", start = "trajectory" }
[networks.thrown.masses.ends]
positions = [[0, 0, 0], [1, 0, 0]]
mass = 1
[networks.thrown]
start = { velocity = [0, 0, 0] }
[[networks.thrown.pins]]
region = { nearest = [0, 0, 0] }
[[networks.thrown.constraints]]
rod = { chain = true }
yields_at = 20
"#;
    let mut world = started(text, &[r#"networks.thrown.start.velocity=["4 * x", 0, 0]"#]);
    for _ in 0..100 {
        world.step().unwrap();
        let flown = world.state().systems[0].q[1].x - 1.0;
        let taken = dissipated(&mut world);
        assert!((taken - 20.0 * flown).abs() < 1e-11, "{taken} {flown}");
    }
    for _ in 0..200 {
        world.step().unwrap();
    }
    // ½ m v², but for the step in which it stops, Y h²/8 of flow
    let all = dissipated(&mut world);
    assert!((all - 8.0).abs() < 20.0 * 20.0 * 1e-6, "{all}");
}

/// A rod that is pressed until its ends meet has no direction any more, and says so.
#[test]
fn rods_pressed_to_nothing_are_told() {
    let text = r#"
format = 1
[world]
period = "1 ms"
[systems.main]
stepper = "t_simulation"
[networks.pressed.masses.ends]
positions = [[0, 0, 0], [0.02, 0, 0]]
mass = 1
[[networks.pressed.pins]]
region = { nearest = [0, 0, 0] }
[[networks.pressed.constraints]]
rod = { chain = true }
yields_at = 2
[[networks.pressed.loads]]
region = { nearest = [0.02, 0, 0] }
force = [-12, 0, 0]
"#;
    let mut world = started(text, &[]);
    let refused = (0..200).find_map(|_| world.step().err()).expect("a fault");
    let StepError::Fault { what, .. } = &refused.error else { panic!("{refused}") };
    assert!(what.contains("until its ends meet"), "{what}");
}

/// A table whose legs bear less than it brakes with lands on a floor: they are crushed, and bear their limit while they are.
#[test]
fn tables_crush_their_legs() {
    let text = r#"
format = 1
[world]
period = "1 ms"
gravity = [0, -10, 0]
[systems.main]
stepper = "t_simulation"
[networks.table]
start = { velocity = [0, -1, 0] }
[networks.table.masses.top]
positions = [[0, 1.01, 0], [1, 1.01, 0], [1, 1.01, 1], [0, 1.01, 1]]
mass = 1
[networks.table.masses.feet]
positions = [[0, 0.01, 0], [1, 0.01, 0], [1, 0.01, 1], [0, 0.01, 1]]
mass = 0.1
[[networks.table.constraints]]
name = "board"
of = ["top"]
rod = { all = true }
[[networks.table.constraints]]
name = "legs"
of = ["top", "feet"]
rod = { paired = true }
yields_at = 30
[[networks.table.constraints]]
name = "upright"
direction = { from = [0, 1, 2, 3], to = [4, 5, 6, 7] }
[[networks.table.constraints]]
name = "floor"
of = ["feet"]
plane = { place = [0, 0, 0], normal = [0, 1, 0] }
sense = "at_least"
"#;
    let mut world = started(text, &[]);
    for step in 0..400 {
        world.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        let q = &world.state().systems[0].q;
        assert!(q[4..].iter().all(|foot| foot.y > -1e-10), "{step}: {q:?}");
    }
    let q = &world.state().systems[0].q;
    // v² = 1 + 2 g 0.01 where it lands; each quarter of 1 kg is braked by 30 − 10 N over v²/(2·20)
    let crushed = (1.0 + 0.2) / 40.0;
    for top in &q[..4] {
        // it lands and stops within steps: v h/2 of either
        assert!((1.0 - top.y - crushed).abs() < 2e-3, "{q:?}");
    }
}
