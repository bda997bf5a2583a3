//! Bars of tetrahedra and hexahedra: explicit steps, implicit steps, equilibrium.

use super::timing::{Held, Timing, as_it_is, bend, scene};
use super::{Effort, Figure, value_of};

/// Settings of the explicit benchmarks.
pub fn explicit_settings(element: &str, cells: u32, period: &str) -> Vec<String> {
    vec![
        format!("world.period=\"{period}\""),
        "systems.main.stepper=\"symplectic_euler\"".to_owned(),
        format!("bodies.bar.mesh.cells=[{}, {cells}, {cells}]", 10 * cells),
        format!("bodies.bar.mesh.element=\"{element}\""),
    ]
}

/// How far off an element's answer is, and of what.
type Check = fn() -> Result<(f64, &'static str), String>;

/// This very scheme: the trace of an independent code.
pub fn trace_of_tet4() -> Result<(f64, &'static str), String> {
    let scene = scene("cantilever_dynamic", &explicit_settings("tet4", 3, "50 us"))?;
    let tip = value_of(scene, 1000, "tip", 1)?;
    Ok(((tip / -0.015741317589581534 - 1.0).abs(), "tip after 1000 steps at n = 3, independent code"))
}

/// The forces of the elements where they balance gravity; the independent code integrates with 27 samples.
pub fn rest_of_hex8() -> Result<(f64, &'static str), String> {
    let settings = [
        "bodies.bar.mesh.cells=[30, 3, 3]",
        "bodies.bar.mesh.element=\"hex8\"",
        "bodies.bar.quadrature=\"full\"",
        "systems.main.stepper={ name = \"static\", newton_tolerance = 1e-9 }",
    ];
    let scene = scene("cantilever", &settings.map(str::to_owned))?;
    let tip = value_of(scene, 1, "tip", 1)?;
    Ok(((tip / -0.13619818759625157 - 1.0).abs(), "tip at rest at n = 3 with 27 samples, GetFEM"))
}

pub fn explicit(
    name: &str,
    element: &str,
    peer: f64,
    check: Check,
    effort: Effort,
) -> Result<Vec<Figure>, String> {
    let (error, error_of) = check()?;
    let held = Held { error, error_of: error_of.to_owned(), baseline: Some(peer) };
    let settings = explicit_settings(element, 12, "10 us");
    // complete symplectic steps of the bent bar
    let timing = Timing {
        scene: "cantilever_dynamic",
        settings: &settings,
        prepare: bend,
        warm_up: 0,
        samples: effort.choose(5, 30),
        steps_per_sample: 5,
    };
    Ok(timing.run()?.iter().map(|timed| timed.elements_per_second(name, &held)).collect())
}

pub fn implicit_beam(name: &str, n: u32, peer: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for law in ["corotational", "st_venant_kirchhoff"] {
        let settings = |n: u32, tolerance: &str| {
            vec![
                format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n),
                format!("bodies.bar.material.name=\"{law}\""),
                format!(
                    "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver_tolerance = {tolerance} }}"
                ),
            ]
        };
        // at n = 3: an independent code's ten steps, or where there is none ours solved to rounding
        let tip = |settings: &[String]| value_of(scene("cantilever_dynamic", settings)?, 10, "tip", 1);
        let (reference, error_of) = if law == "st_venant_kirchhoff" {
            (-0.06758904669664875, "tip after 10 steps at n = 3, independent code with one Newton step")
        } else {
            (tip(&settings(3, "1e-12"))?, "tip after 10 steps at n = 3, the same solved to 1e-12")
        };
        let held = Held {
            error: (tip(&settings(3, "1e-6"))? / reference - 1.0).abs(),
            error_of: error_of.to_owned(),
            baseline: Some(peer),
        };
        let timing = Timing {
            scene: "cantilever_dynamic",
            settings: &settings(n, "1e-6"),
            prepare: as_it_is,
            warm_up: 2,
            samples: effort.choose(6, 28),
            steps_per_sample: 1,
        };
        let name = format!("{name}_{law}");
        figures.extend(timing.run()?.iter().map(|timed| timed.milliseconds_per_step(&name, &held)));
    }
    Ok(figures)
}

pub fn soft_beam(name: &str, [x, y, z]: [u32; 3], peer: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for law in ["corotational", "neo_hookean"] {
        let settings = |stepper: &str| {
            vec![
                "world.period=\"2 ms\"".to_owned(),
                "bodies.bar.mesh.size=[1, 0.25, 0.25]".to_owned(),
                format!("bodies.bar.mesh.cells=[{x}, {y}, {z}]"),
                format!("bodies.bar.material.name=\"{law}\""),
                "bodies.bar.material.youngs_modulus=\"30 kPa\"".to_owned(),
                "bodies.bar.material.density=80".to_owned(),
                format!("systems.main.stepper={stepper}"),
            ]
        };
        let fast = settings("{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-4 }");
        let tight =
            settings("{ name = \"backward_euler\", newton_tolerance = 1e-9, solver_tolerance = 1e-10 }");
        let steps = effort.choose(40, 400);
        let sag = |settings: &[String]| value_of(scene("cantilever_dynamic", settings)?, steps, "tip", 1);
        let held = Held {
            error: (sag(&fast)? / sag(&tight)? - 1.0).abs(),
            error_of: format!("sag after {:.2} s against the tightly converged run", steps as f64 * 2e-3),
            baseline: Some(peer),
        };
        let timing = Timing {
            scene: "cantilever_dynamic",
            settings: &fast,
            prepare: as_it_is,
            warm_up: 2,
            samples: effort.choose(8, 98),
            steps_per_sample: 1,
        };
        let name = format!("{name}_{law}");
        figures.extend(timing.run()?.iter().map(|timed| timed.milliseconds_per_step(&name, &held)));
    }
    Ok(figures)
}

/// Bytes of forces, vectors and matrices for each tetrahedron after an implicit step of the reference bar, with a matrix and without.
pub fn memory_100k(effort: Effort) -> Result<Vec<Figure>, String> {
    let n: u32 = effort.choose(6, 12);
    let tets = f64::from(60 * n * n * n);
    let name = effort.choose("memory_13k", "memory_100k");
    // what was set as the goal, with a matrix and without
    let cases = [("matrix", false, 1500.0), ("matrix_free", true, 300.0)];
    let figures = cases.map(|(of, is_matrix_free, most)| {
        let stepper = format!(
            "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-2, \
             matrix_free = {is_matrix_free} }}"
        );
        let settings = [format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n), stepper];
        let timing = Timing {
            scene: "cantilever",
            settings: &settings,
            prepare: as_it_is,
            warm_up: 0,
            samples: 1,
            steps_per_sample: 1,
        };
        let timed = timing.sample(rayon::current_num_threads())?;
        Ok(Figure {
            by_processor: None,
            name: format!("{name}_{of}"),
            value: timed.bytes as f64 / tets,
            unit: "B/tet",
            higher_is_better: false,
            error: 0.0,
            error_of: "bytes are counted".to_owned(),
            baseline: Some(most),
            threads: timed.threads,
            samples: 1,
            spread: 0.0,
            bytes: timed.bytes,
        })
    });
    figures.into_iter().collect()
}

pub fn static_100k(effort: Effort) -> Result<Vec<Figure>, String> {
    let (n, name) = effort.choose((6, "static_13k"), (12, "static_100k"));
    let settings = |n: u32| {
        vec![
            format!("bodies.bar.mesh.cells=[{}, {n}, {n}]", 10 * n),
            "systems.main.stepper={ name = \"static\", newton_tolerance = 1e-8 }".to_owned(),
        ]
    };
    let expected = -0.12977445957955291;
    let error = (value_of(scene("cantilever", &settings(6))?, 1, "tip", 1)? / expected - 1.0).abs();
    let timing = Timing {
        scene: "cantilever",
        settings: &settings(n),
        prepare: as_it_is,
        warm_up: 0,
        samples: 1,
        steps_per_sample: 1,
    };
    let timed = timing.sample(rayon::current_num_threads())?;
    Ok(vec![Figure {
        by_processor: None,
        name: name.to_owned(),
        value: timed.seconds[0],
        unit: "s",
        higher_is_better: false,
        error,
        error_of: "tip at n = 6, FEniCSx".to_owned(),
        baseline: None,
        threads: timed.threads,
        samples: 1,
        spread: 0.0,
        bytes: timed.bytes,
    }])
}
