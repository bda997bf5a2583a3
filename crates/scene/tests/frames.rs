//! Bodies of frames in scenes: steps as long as wanted (BOS-5), Newton's order, what integrators keep (BOS-6), tissue between
//! organs (BOS-9), the same bits for any number of threads.

use std::path::Path;

use souple_engine::implicit::Rates;
use souple_engine::tangent::{Linearisation, OperatorBuffers, Part, Tangent, TangentOperator};
use souple_engine::{Rows, StepError, World};
use souple_math::Vec3;
use souple_scene::{Scene, read_text};
use souple_solve::LinearOperator;

fn scene(name: &str, overrides: &[&str]) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let text = std::fs::read_to_string(folder.join("scene.toml")).expect("the scene");
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    read_text(name, &text, &folder, &overrides).unwrap_or_else(|errors| panic!("{errors}"))
}

fn world(name: &str, overrides: &[&str]) -> World {
    let scene = scene(name, overrides);
    scene.model.start(scene.state)
}

fn steps(world: &mut World, count: usize) -> Result<(), String> {
    (0..count).try_for_each(|_| world.step().map_err(|error| error.to_string()))
}

const SYMPLECTIC: &str = "systems.main.stepper={ name = \"symplectic_euler\" }";

/// BOS-5: backward Euler takes 20 ms at which explicit steps, whose longest is forecast far shorter, blow up.
#[test]
fn implicit_steps_may_be_long() {
    let period = "world.period=\"20 ms\"";
    let mut implicit = world("ligament", &[period]);
    steps(&mut implicit, 50).expect("backward Euler is stable");
    let stored = implicit.energy().total();
    let mut explicit = world("ligament", &[period, SYMPLECTIC]);
    let longest = explicit.with_system(0, |system, state, around, ws| {
        souple_engine::stability::forecast(system, state, around, ws).longest_step
    });
    assert!(longest < 5e-3, "{longest}");
    let exploded = match steps(&mut explicit, 50) {
        Err(_) => true,
        Ok(()) => explicit.energy().total().abs() > 1e3 * stored.abs(),
    };
    assert!(exploded, "{} next to {stored}", explicit.energy().total());
}

/// Unbalanced forces, relative, after one, two, … iterations of Newton's method in the first step of a bar that spins by 0.4 rad in it;
/// those of rounding are left out.
fn residuals(kind: &str, tangent: &str) -> Vec<f64> {
    let of = |iterations: usize| {
        let stepper = format!(
            "systems.main.stepper={{ name = \"backward_euler\", newton_tolerance = 1e-30, newton_iterations = {iterations} }}"
        );
        let frames = format!("bodies.bar.frames.kind=\"{kind}\"");
        let tangent = format!("bodies.bar.frames.tangent=\"{tangent}\"");
        let spin = "bodies.bar.angular_velocity=[2, 5, 20]";
        let settings = [stepper.as_str(), &frames, &tangent, spin, "world.period=\"20 ms\""];
        match world("frames_spinning", &settings).step().map_err(|error| error.error) {
            Err(StepError::NewtonStalled { residual, .. }) => residual,
            Err(error) => panic!("{error}"),
            Ok(_) => 0.0,
        }
    };
    (1..=7).map(of).take_while(|residual| *residual > 1e-13).collect()
}

/// The order of each iteration, `ln(r₂/r₁)/ln(r₁/r₀)`.
fn orders(residuals: &[f64]) -> Vec<f64> {
    residuals.windows(3).map(|r| (r[2] / r[1]).ln() / (r[1] / r[0]).ln()).collect()
}

/// BOS-5: with the full tangent the number of right digits doubles in every iteration, down to rounding; with that of the material
/// alone it grows by as much in each.
#[test]
fn newton_is_quadratic_with_the_full_tangent() {
    for kind in ["affine", "rigid"] {
        let found = residuals(kind, "full");
        let orders = orders(&found);
        // nearer to two than to one, in every iteration
        assert!(orders.len() >= 2 && orders.iter().all(|order| *order > 1.5), "{kind} {found:?}: {orders:?}");
    }
    let found = residuals("affine", "material");
    let orders = orders(&found);
    assert!(orders.len() >= 4 && orders.iter().all(|order| *order < 1.5), "{found:?}: {orders:?}");
}

fn momentum(world: &World) -> (Vec3, Vec3) {
    world.momentum()
}

/// BOS-6: what each integrator promises for a bar that spins freely. Affine frames live in a linear space, where symplectic
/// steps keep both momenta to rounding; fourth order keeps those of rigid frames; backward Euler never gains energy.
#[test]
fn integrators_keep_what_they_promise() {
    let mut affine = world("frames_spinning", &[]);
    let (start, energy) = (momentum(&affine), affine.energy().total());
    steps(&mut affine, 400).expect("stable");
    let end = momentum(&affine);
    // 400 steps of rounding of 1e-16
    assert!((end.0 - start.0).length() < 1e-12 * start.0.length());
    assert!((end.1 - start.1).length() < 1e-11 * start.1.length());
    // the energy of symplectic steps swings by (h ω)² and does not drift
    assert!((affine.energy().total() / energy - 1.0).abs() < 0.01);

    let rigid = "bodies.bar.frames.kind=\"rigid\"";
    let drift = |period: &str| {
        let mut world = world(
            "frames_spinning",
            &[rigid, "systems.main.stepper=\"rk4\"", &format!("world.period=\"{period}\"")],
        );
        let (start, energy) = (momentum(&world).1, world.energy().total());
        let count = if period == "1 ms" { 200 } else { 100 };
        steps(&mut world, count).expect("stable");
        (
            (momentum(&world).1 - start).length() / start.length(),
            (world.energy().total() / energy - 1.0).abs(),
        )
    };
    let (coarse, fine) = (drift("2 ms"), drift("1 ms"));
    // of fourth order: sixteen times less, or rounding
    assert!(fine.0 < coarse.0 / 8.0 || fine.0 < 1e-10, "{coarse:?} {fine:?}");
    assert!(fine.0 < 1e-5 && fine.1 < 1e-5, "{fine:?}");

    let implicit = "systems.main.stepper={ name = \"backward_euler\", newton_tolerance = 1e-9 }";
    let mut damped = world("frames_spinning", &[rigid, implicit, "world.period=\"5 ms\""]);
    let mut last = damped.energy().total();
    for _ in 0..40 {
        steps(&mut damped, 1).expect("stable");
        let now = damped.energy().total();
        assert!(now <= last * (1.0 + 1e-9), "{now} after {last}");
        last = now;
    }
}

/// BOS-9: the lower organ follows the upper one through the tissue, and pulls back on it; nothing gains energy once the
/// hand that leads rests.
#[test]
fn tissue_ties_two_organs() {
    let mut tied = world("tied_organs", &[]);
    let mut alone = world("tied_organs", &["bodies.upper.pins=[{ region = \"y_max\" }]"]);
    let top_of_lower =
        |world: &World| world.rows(0).positions[..7 * 3 * 7].iter().map(|x| x.y).fold(0.0, f64::max);
    steps(&mut tied, 120).expect("stable");
    steps(&mut alone, 120).expect("stable");
    let lifted = top_of_lower(&tied) - top_of_lower(&alone);
    assert!(lifted > 2e-3, "{lifted}");
    let mut last = tied.energy().total();
    for _ in 0..20 {
        steps(&mut tied, 1).expect("stable");
        let now = tied.energy().total();
        assert!(now <= last + 1e-9 * last.abs(), "{now} after {last}");
        last = now;
    }
}

/// The same bits with one thread and with three.
#[test]
fn threads_change_no_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut world = world("ligament", &["bodies.ligament.mesh.cells=[40, 4, 4]"]);
            steps(&mut world, 5).expect("stable");
            world.state().systems[0].q.clone()
        })
    };
    assert_eq!(run(1), run(3));
}

/// The reference bar on 52 rigid frames, neo-Hookean, in steps of 10 ms.
fn rigid_bar(stepper: &str, more: &[&str]) -> World {
    let stepper = format!("systems.main.stepper={{ name = \"backward_euler\", {stepper} }}");
    let settings = [
        "bodies.bar.mesh.cells=[32, 2, 2]",
        "bodies.bar.frames.placement={ name = \"grid\", counts = [13, 2, 2] }",
        "bodies.bar.frames.kind=\"rigid\"",
        "bodies.bar.material.name=\"neo_hookean\"",
        "world.period=\"10 ms\"",
        &stepper,
    ];
    world("frames_cantilever", &[&settings[..], more].concat())
}

/// The largest distance between rows of two worlds.
fn apart(a: &World, b: &World) -> f64 {
    let rows = a.state().systems[0].q.iter().zip(&b.state().systems[0].q);
    rows.map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
}

/// One linearised solve a step is stable where frames turn a degree or two in each, whoever solves it, and follows the whole step to the
/// first order: about frames that are turned and not moved it would not be.
#[test]
fn one_solve_a_step_is_stable_and_the_same_by_all_solvers() {
    let after = |stepper: &str| {
        let mut world = rigid_bar(stepper, &[]);
        steps(&mut world, 30).unwrap_or_else(|error| panic!("{stepper}: {error}"));
        world
    };
    let start = rigid_bar("newton = \"one\"", &[]);
    let direct = after("newton = \"one\", solver = \"direct\"");
    let moved = apart(&direct, &start);
    assert!(moved > 0.05, "{moved}");
    for stepper in [
        "newton = \"one\", solver = \"cg\", preconditioner = \"incomplete_cholesky\", solver_tolerance = 1e-10",
        "newton = \"one\", preconditioner = \"reference_factor\", solver_tolerance = 1e-10",
        "newton = \"one\", preconditioner = \"reference_factor\", matrix_free = true, solver_tolerance = 1e-10",
    ] {
        // residuals of 1e-10 in each of thirty steps, over the condition of a bar of thirteen frames
        let off = apart(&after(stepper), &direct);
        assert!(off < 1e-6 * moved, "{stepper}: {off}");
    }
    let whole = after("solver = \"direct\"");
    // 30 steps of first order
    let off = apart(&whole, &direct);
    assert!(off < 0.02 * moved, "{off} of {moved}");
}

/// The factor of where frames stood first is turned with them: a bar that has spun round needs no more iterations than one that begins
/// to, a few, where the diagonal of the matrix itself serves for more.
#[test]
fn the_reference_factor_turns_with_frames() {
    for kind in ["rigid", "affine"] {
        let frames = format!("bodies.bar.frames.kind=\"{kind}\"");
        let most_of = |preconditioner: &str| {
            let stepper = format!(
                "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver = \"cg\", preconditioner = \"{preconditioner}\" }}"
            );
            let mut spinning = world("frames_spinning", &[&frames, &stepper, "world.period=\"10 ms\""]);
            let axis = |world: &World| world.state().systems[0].q[1];
            let (mut most, mut turned, mut last) = (0, 0.0, axis(&spinning));
            for _ in 0..150 {
                spinning.step().expect("a step");
                most = most.max(spinning.last_report().linear_iterations);
                turned += last.cross(axis(&spinning)).length();
                last = axis(&spinning);
            }
            assert!(turned > std::f64::consts::PI, "{kind}: {turned} rad");
            most
        };
        let (turned, jacobi) = (most_of("reference_factor"), most_of("block_jacobi"));
        assert!(turned <= 7 && jacobi > 2 * turned, "{kind}: {turned} and {jacobi}");
    }
}

/// Products with the symmetric part are those with the assembled matrix, symmetrised: rigid frames that spin, with inertia, drag and
/// forces that are not balanced.
#[test]
fn symmetric_products_are_those_with_the_matrix() {
    let settings = [
        "bodies.bar.frames.kind=\"rigid\"",
        "bodies.bar.damping={ rayleigh_mass = 30 }",
        "systems.main.stepper=\"backward_euler\"",
        "world.period=\"10 ms\"",
    ];
    let mut spinning = world("frames_spinning", &settings);
    steps(&mut spinning, 3).expect("steps");
    let wave = |count: usize, phase: f64| -> Vec<Vec3> {
        let number = |i: usize| (0.7 * i as f64 + phase).sin();
        (0..count).map(|i| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2))).collect()
    };
    spinning.with_system(0, |system, state, around, ws| {
        let row = || vec![Vec3::ZERO; system.kinematics.row_count()];
        let mut rows = Rows { positions: row(), velocities: row(), time: 0.0 };
        system.place_rows(&state.q, &state.v, 0.0, &mut rows);
        let at = Linearisation {
            system,
            state,
            around: *around,
            rows: &rows,
            q: &state.q,
            v: &state.v,
            rates: Rates::backward_euler(0.01),
            unbalanced: &wave(row().len(), 0.4),
        };
        let mut tangent = Tangent::default();
        let matrix = tangent.assemble(&at, &mut ws.scratches);
        let x = wave(system.kinematics.block_count(), 0.1);
        let product = |operator: &dyn LinearOperator| {
            let mut out = vec![Vec3::ZERO; x.len()];
            operator.apply(&x, &mut out);
            out
        };
        let apart = |a: &[Vec3], b: &[Vec3]| {
            a.iter().zip(b).map(|(a, b)| (*a - *b).largest_component()).fold(0.0, f64::max)
        };
        let whole = product(matrix);
        matrix.symmetrise();
        let half = product(matrix);
        let scale = half.iter().map(|x| x.largest_component()).fold(0.0, f64::max);
        // the part that is left out is not nothing
        assert!(apart(&whole, &half) > 1e-6 * scale);
        for (part, expected) in [(Part::Whole, &whole), (Part::Symmetric, &half)] {
            let mut buffers = OperatorBuffers::new(system);
            let operator = TangentOperator::new(&at, part, &mut ws.scratches, &mut buffers);
            // sums of some hundred products
            let off = apart(&product(&operator), expected);
            assert!(off < 1e-12 * scale, "{part:?}: {off} of {scale}");
        }
    });
}

/// Solvers that take no factor of the reference configuration, or cannot for friction, go on without it.
#[test]
fn the_reference_factor_is_left_where_it_does_not_serve() {
    for solver in ["auto", "cg", "gmres", "bicgstab", "direct"] {
        let stepper =
            format!("newton = \"one\", preconditioner = \"reference_factor\", solver = \"{solver}\"");
        let floor =
            "shapes={ floor = { shape = { name = \"plane\", point = [0, -0.01, 0], normal = [0, 1, 0] } } }";
        let contact =
            "contacts=[{ body = \"bar\", shape = \"floor\", stiffness = \"1 kN/m\", friction = 0.4 }]";
        let mut bar = rigid_bar(&stepper, &[floor, contact]);
        steps(&mut bar, 12).unwrap_or_else(|error| panic!("{solver}: {error}"));
    }
}

/// A run that is resumed makes the factor anew, and has the bits of one that was not.
#[test]
fn a_resumed_reference_factor_is_the_same() {
    let stepper = "newton = \"one\", preconditioner = \"reference_factor\"";
    let mut unbroken = rigid_bar(stepper, &[]);
    steps(&mut unbroken, 3).expect("steps");
    let state = unbroken.state().clone();
    steps(&mut unbroken, 3).expect("steps");
    let mut resumed = rigid_bar(stepper, &[]);
    resumed.resume(state).expect("a state of this model");
    steps(&mut resumed, 3).expect("steps");
    assert_eq!(resumed.state().hash(), unbroken.state().hash());
}

/// A linearised solve begins where the velocities lead: a body that moves evenly takes fewer iterations than where each began at rest, and
/// comes to the same place.
#[test]
fn even_motion_is_solved_for_already() {
    let after = |preconditioner: &str| {
        let stepper = format!(
            "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver = \"cg\", preconditioner = \"{preconditioner}\" }}"
        );
        let mut world = world("stretched_cube", &[&stepper]);
        let mut iterations = Vec::new();
        for _ in 0..9 {
            world.step().expect("a step");
            iterations.push(world.last_report().linear_iterations);
        }
        (world, iterations)
    };
    let (direct, _) = after("reference_factor");
    let (started, iterations) = after("block_jacobi");
    // the first step begins from rest
    assert!(iterations[1..].iter().all(|count| *count < iterations[0]), "{iterations:?}");
    // residuals of 1e-8 of the forces, over the condition of a cube of ten cells: some thousand
    let start = world("stretched_cube", &[]);
    let moved = apart(&direct, &start);
    assert!(apart(&started, &direct) < 1e-5 * moved);
}

/// Points turn with what they are coupled with: a bar of finite elements that bends takes the same steps by the factor of where it
/// began, in few iterations.
#[test]
fn the_reference_factor_serves_points() {
    let after = |solver: &str| {
        let stepper = format!(
            "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-10, {solver} }}"
        );
        let mut world = world(
            "cantilever",
            &[&stepper, "bodies.bar.material.youngs_modulus=\"1 MPa\"", "world.period=\"10 ms\""],
        );
        let mut most = 0;
        for _ in 0..30 {
            world.step().unwrap_or_else(|error| panic!("{solver}: {error:?}"));
            most = most.max(world.last_report().linear_iterations);
        }
        (world, most)
    };
    let (direct, _) = after("solver = \"direct\"");
    let (turned, most) = after("preconditioner = \"reference_factor\"");
    let off = apart(&direct, &turned);
    assert!(off < 1e-7 && most < 40, "{off} m, {most} iterations");
}

fn refusal(name: &str, overrides: &[&str]) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let text = std::fs::read_to_string(folder.join("scene.toml")).expect("the scene");
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    read_text(name, &text, &folder, &overrides).map(|_| ()).expect_err("a scene that cannot be").to_string()
}

/// What bodies of frames cannot be is said in words, with what to change.
#[test]
fn faults_of_frames_are_said_with_what_to_change() {
    let frames = |setting: &str| refusal("ligament", &[&format!("bodies.ligament.frames.{setting}")]);
    let told = |said: &str, words: &[&str]| {
        for word in words {
            assert!(said.contains(word), "{said}");
        }
    };
    // points outside every support
    let apart = "placement={ name = \"given\", at = [0.02, 0.005, 0.005, 0.03, 0.005, 0.005] }";
    told(
        &frames(apart),
        &["no frame reaches", "reaches 2.000e-2 m", "place frames there, or take a `support` above"],
    );
    // frames on top of each other
    let twice = "placement={ name = \"given\", at = [0.02, 0.005, 0.005, 0.02, 0.005, 0.005] }";
    told(&frames(twice), &["frames 0 and 1 are on top of each other", "take fewer frames or move one"]);
    // nothing to turn: one point for the whole shape, which is thinner than the voxels
    let voxels = |size: &str| format!("points={{ name = \"voxels\", size = \"{size}\" }}");
    told(
        &frames(&voxels("20 cm")),
        &["reaches no integration point", "take more points, fewer frames, or a wider support"],
    );
    let thin = [
        "bodies.ligament.frames.kind=\"rigid\"".to_owned(),
        format!("bodies.ligament.frames.{}", voxels("11 mm")),
    ];
    let thin: Vec<&str> = thin.iter().map(String::as_str).collect();
    told(&refusal("ligament", &thin), &["lies on a line", "take more integration points there"]);
    // weights that do not reach: a part of the shape that no frame is in
    let far = refusal("fork", &["bodies.fork.frames.placement.at=[0.39, 0.05, 0, 0.3, 0.05, 0]"]);
    told(&far, &["no frame reaches", "take a `support` above"]);
    // bones that are not there, frames that are not, and two for one
    let bound = |bones: &str| refusal("frames_led", &[&format!("bodies.bar.frames.bones={bones}")]);
    told(&bound("[{ bone = \"hnad\", frames = [0] }]"), &["no bone `hnad`", "did you mean `hand`?"]);
    told(&bound("[{ bone = \"hand\", frames = [12] }]"), &["no frame 12", "0 to 11"]);
    told(&bound("[{ bone = \"hand\", frames = [1, 1] }]"), &["frame 1 follows `hand` already"]);
    told(&refusal("frames_led", &["bones.hand.follows=\"hand\""]), &["`hand` follows itself"]);
    told(&bound("[{ bone = \"hand\", frames = [] }]"), &["no frame is named"]);
    // a pad has the cells of its faces, and a fibre no direction across itself
    told(&refusal("tissues", &["bodies.pad.mesh.across=3"]), &["no `across`"]);
    let axes = "bodies.tube.material_axes={ x = [1, 0, 0], y = [2, 0, 0] }";
    told(&refusal("fibre_tube", &[axes]), &["a `y` that leans from it"]);
}

/// Frames that may move where no point sees it are told of, all the more of them the more; those that a bone leads do not move.
#[test]
fn frames_that_points_miss_are_told() {
    let missed = |name: &str, settings: &[&str]| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
        let text = std::fs::read_to_string(folder.join("scene.toml")).expect("the scene");
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
        let scene = read_text(name, &text, &folder, &settings).unwrap_or_else(|faults| panic!("{faults}"));
        scene.warnings.iter().any(|told| told.contains("integration points as at them"))
    };
    assert!(!missed("ligament", &[]), "as it is");
    let (few, rigid) = ("bodies.ligament.mesh.cells=[7, 1, 1]", "bodies.ligament.frames.kind=\"rigid\"");
    for count in [16, 20, 24] {
        let frames = format!("bodies.ligament.frames.placement.count={count}");
        assert!(missed("ligament", &[few, rigid, &frames]), "{count} frames at 56 points");
    }
    assert!(!missed("frames_led", &["bodies.bar.mesh.cells=[4, 1, 1]"]), "all on a bone");
}

/// Tissue that has no room is refused in words.
#[test]
fn tissue_without_room_is_refused() {
    let pad = |setting: &str| refusal("tissues", &[setting]);
    let thin = pad("bodies.pad.mesh.thickness=\"1 cm\"");
    assert!(
        thin.contains("the narrowest gap is 2.000e-2 m") && thin.contains("a greater `thickness`"),
        "{thin}"
    );
    let itself = pad("bodies.pad.mesh.to=\"lower\"");
    assert!(itself.contains("to itself"), "{itself}");
    let knot = refusal("tissues", &["bodies.pad.mesh.from=\"sheet\"", "bodies.sheet.mesh.from=\"pad\""]);
    assert!(knot.contains("waits for it"), "{knot}");
    let line = pad("bodies.sheet.mesh.from_region={ nearest = [0.1, 0.04, 0.05] }");
    assert!(line.contains("has no width there"), "{line}");
    // thicker than the region is wide; a pad that would go through the organ; a bone to end on
    let thick = ["bodies.ligament.mesh.thickness=\"12 cm\"", "bodies.ligament.mesh.from_region=\"y_max\""];
    let thick = refusal("tissues", &thick);
    assert!(thick.contains("a wider region"), "{thick}");
    let stout = pad("bodies.ligament.mesh.thickness=\"6 cm\"");
    assert!(stout.contains("below the distance of the ends"), "{stout}");
    for away in ["bodies.pad.mesh.from_region=\"y_min\"", "bodies.pad.mesh.to_region=\"y_max\""] {
        let through = pad(away);
        assert!(through.contains("the tissue would go through the body"), "{away}: {through}");
    }
    let bone = refusal("tissues", &["bones={ hand = {} }", "bodies.pad.mesh.to=\"hand\""]);
    assert!(bone.contains("`hand` is a bone or a shape, and no body"), "{bone}");
}

/// What a bone does to some frames of a body is what changes the momentum of the whole, with the mass that couples these to the others.
#[test]
fn the_force_of_a_bone_changes_the_momentum() {
    for kind in ["rigid", "affine"] {
        let settings = [
            format!("bodies.bar.frames.kind=\"{kind}\""),
            "bodies.bar.frames.bones[0].frames=[0, 1, 2, 3]".to_owned(),
            "bones.hand={ motion = { formula = \"[0, t^2, 0]\" } }".to_owned(),
            "world.period=\"1 ms\"".to_owned(),
        ];
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let scene = scene("frames_led", &settings);
        let force = scene.probes.iter().find(|probe| probe.name == "force").unwrap().clone();
        let mut world = scene.model.start(scene.state);
        let (mut given, mut largest) = (Vec3::ZERO, 0.0_f64);
        for _ in 0..200 {
            steps(&mut world, 1).unwrap();
            let now = Vec3::from_array(force.measure(&mut world).numbers().try_into().unwrap());
            given += now * 1e-3;
            largest = largest.max(now.length());
        }
        let (momentum, _) = momentum(&world);
        // a sum by ends of intervals is off by half a step of what changes
        assert!((momentum - given).length() < 1e-3 * largest, "{kind}: {momentum:?} for {given:?}");
    }
}

/// Bones are looked at whether anybody follows them or not, and faults stand where they are written.
#[test]
fn faults_of_bones_are_said_where_they_are() {
    for (settings, wanted, place) in [
        (&["bones.hand.follows=\"hand\""][..], "bone `hand` follows itself", "bones.hand.follows"),
        (&["bones.hand={ follows = \"elbow\" }"], "there is no bone `elbow`", "bones.hand.follows"),
        (
            &["bones={ hand = {}, arm = { follows = \"leg\" }, leg = { follows = \"arm\" } }"],
            "bone `leg` follows itself",
            "bones.leg.follows",
        ),
        (
            &["bones={ hand = {}, arm = { motion = { formula = \"[log(t - 0.05), 0, 0]\" } } }"],
            "at t = 0",
            "bones.arm",
        ),
        (&["shapes={ hand = { shape = \"plane\" } }"], "there is a shape `hand` too", "bones.hand"),
        (&["probes.force.bone=\"hands\""], "nothing of body `bar` follows a bone `hands`", "probes.force"),
    ] {
        let said = refusal("frames_led", settings);
        assert!(said.contains(wanted) && said.contains(place), "{settings:?}: {said}");
    }
}

/// Axes are asked for where a law knows directions, and point somewhere in every cell.
#[test]
fn faults_of_material_axes_are_said() {
    let tube = |setting: &str| refusal("fibre_tube", &[setting]);
    let middle = tube("bodies.tube.material_axes={ x = \"[0, 0, y - y]\" }");
    assert!(middle.contains("an x that is zero in no cell"), "{middle}");
    let infinite = tube("bodies.tube.material_axes={ x = \"[0, 1/(x - x), 0]\" }");
    assert!(infinite.contains("in cell 0 of body `tube`"), "{infinite}");
    let none = refusal("twisted_bar", &["bodies.bar.material_axes={ x = [1, 0, 0] }"]);
    assert!(none.contains("no law of body `bar` knows directions"), "{none}");
    let law = r#"bodies.sheet.material={ name = "hyperelastic", energy = "mu*dot(E, E) + mu*(I4(a) - 1)^2", parameters = { mu = "1 MPa", a = [1, 0, 0] }, density = 1000 }"#;
    let section = r#"bodies.sheet.section={ name = "plane_stress", thickness = "10 mm" }"#;
    let plate = refusal("harmonic_sheet", &[law, section, "bodies.sheet.material_axes={ x = [1, 0, 0] }"]);
    assert!(plate.contains("which takes the axes of the world"), "{plate}");
}

/// Frames on a bone are where it takes them at the end of every step, rigid or affine, by any stepper that takes frames, and so
/// are all points that they carry.
#[test]
fn bound_frames_are_where_their_bone_is() {
    for kind in ["rigid", "affine"] {
        for stepper in
            ["{ name = \"backward_euler\", newton = \"one\" }", "\"backward_euler\"", "\"rk4\"", "\"static\""]
        {
            let kind = format!("bodies.bar.frames.kind=\"{kind}\"");
            let stepper = format!("systems.main.stepper={stepper}");
            let mut world = world("frames_led", &[&kind, &stepper]);
            steps(&mut world, 30).unwrap_or_else(|error| panic!("{stepper}: {error}"));
            // as the scene says it, at 0.3 s
            let (t, pi) = (0.3, std::f64::consts::PI);
            let pivot = Vec3::new(0.25, 0.05, 0.05);
            let turn = souple_math::exponential(Vec3::new(4.0 * pi * t, pi * t, 0.0));
            let offset = Vec3::new(0.5 * t, 0.2 * (2.0 * pi * t).sin(), 0.0);
            let rest = scene("frames_led", &[]).bodies[0].mesh.points.clone();
            let rows = scene("frames_led", &[&kind]).bodies[0].rows.clone();
            let now = &world.rows(0).positions[rows];
            let expected = |x: &Vec3| pivot + offset + turn * (*x - pivot);
            let off = now.iter().zip(&rest).map(|(now, x)| (*now - expected(x)).length()).fold(0.0, f64::max);
            // rounding over thirty steps
            assert!(off < 1e-12, "{kind} {stepper}: {off}");
        }
    }
}
