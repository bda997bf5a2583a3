//! Bodies of modes and of polynomials in scenes (JIM-97, PA-19 and PA-20): what they answer, what implicit steps make of them, the same bits for any number of threads,
//! and what is refused.

use std::path::Path;

use souple_engine::World;
use souple_math::Vec3;
use souple_scene::{Scene, read_text};

fn read(name: &str, overrides: &[&str]) -> Result<Scene, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let text = std::fs::read_to_string(folder.join("scene.toml")).expect("the scene");
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    read_text(name, &text, &folder, &overrides).map_err(|errors| errors.to_string())
}

fn world(name: &str, overrides: &[&str]) -> World {
    let scene = read(name, overrides).unwrap_or_else(|errors| panic!("{errors}"));
    scene.model.start(scene.state)
}

/// A body knows its modes, its points are no unknowns, and it has the mass of its mesh.
#[test]
fn bodies_know_their_modes() {
    let scene = read("modal_spinning", &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let body = &scene.bodies[0];
    let modes = body.reduced.as_ref().expect("few unknowns");
    let hertz = modes.hertz.as_ref().expect("modes");
    assert_eq!(hertz.len(), 6);
    assert!(hertz.windows(2).all(|pair| pair[0] <= pair[1]) && hertz[0] > 1.0, "{hertz:?}");
    assert!((0..body.mesh.points.len() as u32).all(|point| body.own_row(point).is_none()));
    let mass = scene.model.systems[0].mass.diagonal[modes.rows.start];
    // 0.5 · 0.1 · 0.1 m³ of 1000 kg/m³
    assert!((mass - 5.0).abs() < 1e-12, "{mass}");
}

/// A body of a polynomial moves in the rows of its terms, the same under implicit steps, and a law as text is differentiated there as any.
#[test]
fn polynomials_step_by_all_laws() {
    let text = r#"bodies.bar.material={ name = "hyperelastic", energy = "0.5*mu*(I1 - 3) - mu*log(J) + 0.5*k*log(J)^2", parameters = { mu = "20 kPa", k = "30 kPa" }, density = 1000 }"#;
    for law in [r#"bodies.bar.material.name="neo_hookean""#, text] {
        let settings = [
            "systems.main.stepper={ name = \"backward_euler\", newton_iterations = 6 }",
            "world.period=\"5 ms\"",
            law,
        ];
        let mut world = world("polynomial_spinning", &settings);
        assert_eq!(world.state().systems[0].q.len(), 10);
        // quadratic convergence or none in six: the tangent is the derivative of the force
        (0..20).for_each(|_| world.step().expect("a step"));
    }
    let said =
        read("polynomial_bending", &["bodies.bar.damping.viscosity=1"]).map(|_| ()).expect_err("a fault");
    assert!(said.contains("knows no such `damping.viscosity`"), "{said}");
    let said =
        read("polynomial_bending", &["bodies.bar.modes={ count = 3 }"]).map(|_| ()).expect_err("a fault");
    assert!(said.contains("know no `polynomial`"), "{said}");
}

/// Implicit steps of a free body keep its momentum, whatever they take from its swinging, and its frame stays a rotation.
#[test]
fn implicit_steps_keep_momentum() {
    let damped = "bodies.beam.modes={ count = 7, damping_ratio = 0.1 }";
    let settings = ["systems.main.stepper=\"backward_euler\"", "world.period=\"10 ms\"", damped];
    let mut world = world("modal_spinning", &settings);
    (0..50).for_each(|_| world.step().expect("a step"));
    let linear: Vec3 = world.with_system(0, |system, state, _, ws| {
        system.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
        system.momentum(&ws.rows).0
    });
    // residuals of 1e-6 of the forces of a step, of some newton for 10 ms, in 50 steps
    assert!((linear - Vec3::new(0.5, 0.0, 0.0)).length() < 1e-6, "{linear:?}");
    let q = &world.state().systems[0].q;
    let axes = souple_math::Mat3::from_columns(q[1], q[2], q[3]);
    assert!((axes.transpose_mul(&axes) - souple_math::Mat3::IDENTITY).largest_entry() < 1e-14);
}

/// A held body that begins with a velocity swings as all of its points do: its modes have what of that velocity they can have, most of it
/// in a beam, whose first pair alone has `0.613` of the kinetic energy of a motion across, and six `0.613 + 0.188 + 0.065`.
#[test]
fn held_bodies_begin_with_their_velocity() {
    let settings =
        ["systems.main.stepper=\"verlet\"", "world.period=\"1 ms\"", "bodies.beam.velocity=[0, 1, 0]"];
    let mut world = world("modal_cantilever", &settings);
    let kinetic = world.with_system(0, |system, state, _, ws| {
        system.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
        system.kinetic_energy(&ws.rows)
    });
    // of m v²/2 with m = 1.6 kg; participations of a clamped beam (Blevins 1979, table 8-1), and what the root moves is held still
    let expected = 0.8 * (0.6131 + 0.1883 + 0.0647);
    assert!((kinetic / expected - 1.0).abs() < 0.01, "{kinetic} for {expected}");
}

/// In a world that turns, modes do to each other what the points of their body do: a beam that is led round bends as its mesh.
#[test]
fn modes_of_turning_worlds_are_coupled() {
    let tip = |modes: &str| {
        let settings = [
            "systems.main.stepper=\"rk4\"",
            "world.period=\"0.1 ms\"",
            "world.frame={ rotation = { formula = [\"3 * t\", \"0\", \"0\"] } }",
            "bodies.beam.mesh={ generate = \"bar\", size = [1, 0.04, 0.04], cells = [4, 1, 1], element = \"hex20\" }",
            &format!("bodies.beam.{modes}"),
        ];
        let mut world = world("modal_cantilever", &settings);
        (0..2000).for_each(|_| world.step().expect("a step"));
        world.with_system(0, |system, state, _, ws| {
            system.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
            ws.rows.positions.iter().copied().fold(Vec3::ZERO, |far, x| if x.x > far.x { x } else { far })
        })
    };
    let (few, all) = (tip("modes.count=6"), tip("modes="));
    // modes above the third pair have 0.14 % of a deflection by the tip
    let deflection = (all.y.abs() - 0.02).abs().max((all.z.abs() - 0.02).abs());
    assert!((few - all).length() < 2e-3 * deflection && deflection > 1e-3, "{few:?} for {all:?}");
}

/// What cannot be is said with what would be accepted.
#[test]
fn faults_of_modes_are_said_with_what_to_change() {
    let told = |overrides: &[&str], words: &[&str]| {
        let said = read("modal_cantilever", overrides).map(|_| ()).expect_err("a fault");
        for word in words {
            assert!(said.contains(word), "{word}: {said}");
        }
    };
    told(&["bodies.beam.modes.count=0"], &["count"]);
    let coarse = [
        "bodies.beam.mesh.cells=[1, 1, 1]",
        "bodies.beam.mesh.element=\"hex8\"",
        "bodies.beam.modes.count=13",
    ];
    told(&coarse, &["has 12 modes, not 13", "a finer mesh"]);
    let free = ["bodies.beam.pins=[]", coarse[0], coarse[1], "bodies.beam.modes.count=19"];
    told(&free, &["has 18 modes, not 19"]);
    let hinge = "bodies.beam.pins=[{ region = { nearest = [0, 0, 0] } }]";
    told(&[hinge], &["pins that hold", "or none"]);
    let led = "bodies.beam.pins=[{ region = \"x_min\", motion = { formula = [\"0.1*t\", \"0\", \"0\"] } }]";
    told(&[led], &["those of pins that stay"]);
    told(&["bodies.beam.damping.viscosity=1"], &["know no `damping.viscosity`"]);
    told(&["bodies.beam.formulation.name=\"tensor_mass\""], &["know no `formulation`"]);
}

/// Modes within polynomials have frequencies above those of the mesh, the nearer the higher their degree, and move all points by such: a
/// quadratic one of a beam has its middle a quarter as far as its end.
#[test]
fn modes_within_polynomials_bound_those_of_the_mesh() {
    let first = |modes: &str| {
        let scene = read("modal_cantilever", &[modes]).unwrap_or_else(|errors| panic!("{errors}"));
        scene.bodies[0].reduced.as_ref().and_then(|reduced| reduced.hertz.as_ref()).expect("modes")[0]
    };
    let of_mesh = first("bodies.beam.modes.count=2");
    let within =
        [5, 4, 3, 2].map(|degree| first(&format!("bodies.beam.modes={{ count = 2, degree = {degree} }}")));
    // bounds to rounding of the factor of the mesh's stiffness
    assert!(within[0] > of_mesh * (1.0 - 1e-9) && within.is_sorted(), "{of_mesh}: {within:?}");
    assert!(within[0] / of_mesh < 1.0 + 1e-3, "{of_mesh}: {within:?}");

    let settings = ["bodies.beam.modes={ count = 2, degree = 2 }"];
    let scene = read("modal_cantilever", &settings).unwrap_or_else(|errors| panic!("{errors}"));
    let (rest, first_row) = (scene.bodies[0].mesh.points.clone(), scene.bodies[0].rows.start);
    let mut world = world("modal_cantilever", &settings);
    world.step().expect("a step");
    let moved: Vec<Vec3> = world.with_system(0, |system, state, _, ws| {
        system.place_rows(&state.q, &state.v, 0.0, &mut ws.rows);
        ws.rows.positions[first_row..first_row + rest.len()].to_vec()
    });
    // along an edge: a x + b x² of the clamped end, by the values at the middle and the end
    let along = |x: f64| {
        let on_edge = |p: &Vec3| (p.x - x).abs() + (p.y - rest[0].y).abs() + (p.z - rest[0].z).abs() < 1e-9;
        let point = rest.iter().position(on_edge).expect("a point");
        moved[point].y - rest[point].y
    };
    let [half, whole] = [along(0.5), along(1.0)];
    let (a, b) = (4.0 * half - whole, 2.0 * whole - 4.0 * half);
    assert!(whole > 1e-3);
    for x in (0..=16).map(|cell| f64::from(cell) / 16.0) {
        // rounding of what vanishes at the clamp, squares of which are told from nothing
        assert!((along(x) - x * (a + b * x)).abs() < 1e-7 * whole, "at {x}");
    }
}

/// A deformable primitive knows its natural modes apart from what deforms it as a whole, which no pin may hold and which is told once.
#[test]
fn deformations_of_the_whole_are_beside_modes() {
    let scene = read("deformable_primitive", &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let reduced = scene.bodies[0].reduced.as_ref().expect("few unknowns");
    assert_eq!(reduced.hertz.as_ref().map(Vec::len), Some(6));
    // a frame of four rows, three for each of six modes and six deformations
    assert_eq!(reduced.rows.len(), 4 + 3 * 12);
    let told = |name: &str, override_: &str, words: &[&str]| {
        let said = read(name, &[override_]).map(|_| ()).expect_err("a fault");
        words.iter().for_each(|word| assert!(said.contains(word), "{word}: {said}"));
    };
    let of = |global: &str| format!("bodies.primitive.modes.global=[{global}]");
    told("deformable_primitive", &of("\"stretch\""), &["`stretch` is no deformation", "stretch_x"]);
    told("deformable_primitive", &of("\"bend_xx\""), &["`bend_xx` is no deformation"]);
    told("deformable_primitive", &of("\"shear_xz\", \"shear_xz\""), &["`shear_xz` is there twice"]);
    told("deformable_primitive", "bodies.primitive.modes.global_stiffness=0", &["global_stiffness"]);
    told("deformable_primitive", "bodies.primitive.modes.degree=6", &["degree"]);
    told(
        "deformable_primitive",
        &of("\"twist_x\", \"twist_y\", \"twist_z\""),
        &["1 make others", "of three twists two"],
    );
    let held = "bodies.beam.modes={ count = 2, global = [\"stretch_x\"] }";
    told("modal_cantilever", held, &["is held", "without pins"]);
    told(
        "modal_cantilever",
        "bodies.beam.modes={ count = 7, degree = 1 }",
        &["has 3 modes, not 7", "a higher `degree`"],
    );
    // pins that leave motions, which the factor of a mesh shows and a given space would take for slow modes
    for hinge in ["{ region = { nearest = [0, 0, 0] } }", "{ region = \"x_min\", axes = \"yz\" }"] {
        let settings =
            [format!("bodies.beam.pins=[{hinge}]"), "bodies.beam.modes={ count = 2, degree = 2 }".to_owned()];
        let said = read("modal_cantilever", &settings.each_ref().map(|text| text.as_str()))
            .map(|_| ())
            .expect_err("a fault");
        assert!(said.contains("rigid motions free") && said.contains("or none"), "{said}");
    }
    let coarse = [
        "bodies.beam.mesh={ generate = \"bar\", size = [0.5, 0.1, 0.1], cells = [1, 1, 1], element = \"hex8\" }",
        "bodies.beam.modes={ count = 17, global = [\"stretch_x\", \"stretch_y\"] }",
    ];
    let said = read("modal_spinning", &coarse).map(|_| ()).expect_err("a fault");
    assert!(said.contains("has 16 modes, not 17"), "{said}");
}

/// Within polynomials there are as many modes as their space has beside rigid motions and the whole: 30 − 6 − 6 of the second degree.
#[test]
fn modes_are_counted_in_their_space() {
    let of = |count: usize| {
        let settings =
            [format!("bodies.primitive.modes.count={count}"), "bodies.primitive.modes.degree=2".to_owned()];
        read("deformable_primitive", &settings.each_ref().map(|text| text.as_str())).map(|_| ())
    };
    assert!(of(18).is_ok());
    let said = of(19).expect_err("a fault");
    assert!(said.contains("has 18 modes, not 19"), "{said}");
}

/// The axes of what deforms a whole are the body's: turned at rest, it has the same frequencies beside it.
#[test]
fn deformations_of_the_whole_turn_with_the_body() {
    let hertz = |turned: &str| {
        let settings = ["bodies.beam.modes={ count = 3, global = [\"bend_xz\"] }", turned];
        let scene = read("modal_spinning", &settings).unwrap_or_else(|errors| panic!("{errors}"));
        scene.bodies[0].reduced.as_ref().and_then(|reduced| reduced.hertz.clone()).expect("modes")
    };
    let (straight, turned) = (
        hertz("world.period=\"1 ms\""),
        hertz("bodies.beam.rotate={ axis = [1, 2, 3], angle = \"40 deg\" }"),
    );
    for (a, b) in straight.iter().zip(&turned) {
        // pairs of the iteration to 1e-10 of the shapes, squares of which frequencies see
        assert!((a / b - 1.0).abs() < 1e-8, "{straight:?} {turned:?}");
    }
}

/// Modes that polynomials make too stiff, and pairs of modes that are split, are warned of; others are not.
#[test]
fn doubtful_modes_are_warned_of() {
    let told = |modes: &str, thickness: f64| {
        let mesh = format!(
            "bodies.beam.mesh={{ generate = \"bar\", size = [1, 0.04, {thickness}], cells = [8, 1, 1], element = \"hex20\" }}"
        );
        let scene = read("modal_cantilever", &[&format!("bodies.beam.modes={{ {modes} }}"), &mesh]);
        scene.unwrap_or_else(|errors| panic!("{errors}")).warnings.join("; ")
    };
    // a square beam bends both ways alike
    assert!(told("count = 5", 0.04).contains("takes one mode of a pair"), "{}", told("count = 5", 0.04));
    assert!(!told("count = 6", 0.04).contains("pair"), "{}", told("count = 6", 0.04));
    // the parabola of a thin beam is stiffer by a quarter than its own shape, of five powers it is near
    let stiff = told("count = 1, degree = 2", 0.03);
    assert!(
        stiff.contains("mode 1 among polynomials") && stiff.contains("above that of the mesh"),
        "{stiff}"
    );
    assert!(
        !told("count = 1, degree = 5", 0.03).contains("polynomials"),
        "{}",
        told("count = 1, degree = 5", 0.03)
    );
}
