//! Laws as text against the same laws of the table, on complete steps; and forces and their derivatives alone.

use std::time::Instant;

use souple_engine::{TangentWeights, World};
use souple_math::Vec3;
use souple_mesh::ElementKind;
use souple_models::materials::{KeptLaws, TextLaw, WRITTEN_LAWS, WrittenLaw};

use super::timing::{Clock, Held, Timed, Timing, bend, median, over, scene, thread_counts, with_threads};
use super::{Effort, Figure};

/// Neo-Hookean energy by tensors, as one would write it.
const TENSORS: &str = "mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2";
/// The same by entries: nothing of it is a tensor operation.
const SCALARS: &str = "mu/2*(F11^2 + F12^2 + F13^2 + F21^2 + F22^2 + F23^2 + F31^2 + F32^2 + F33^2 - 3) - mu*log(D) + lambda/2*log(D)^2";
const DETERMINANT: &str = "F11*(F22*F33 - F23*F32) - F12*(F21*F33 - F23*F31) + F13*(F21*F32 - F22*F31)";

/// Milliseconds within which a law is to be ready.
const READY: f64 = 50.0;

/// How a law is written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Writing {
    Tensors,
    Scalars,
}

/// The bar of `cells` across, under the law of the table and under the same law as text.
fn settings(element: &str, cells: u32, writing: Option<Writing>) -> Vec<String> {
    settings_of_modulus(1e7, element, cells, writing)
}

/// The same with a Young's modulus [Pa] of its own where it is text.
fn settings_of_modulus(modulus: f64, element: &str, cells: u32, writing: Option<Writing>) -> Vec<String> {
    let mut settings = vec![
        r#"world.period="10 us""#.to_owned(),
        r#"systems.main.stepper="symplectic_euler""#.to_owned(),
        format!("bodies.bar.mesh.cells=[{}, {cells}, {cells}]", 10 * cells),
        format!("bodies.bar.mesh.element=\"{element}\""),
    ];
    // Poisson's ratio is 0.3
    let (mu, lambda) = (modulus / 2.6, 0.3 * modulus / (1.3 * 0.4));
    settings.push(match writing {
        None => r#"bodies.bar.material.name="neo_hookean""#.to_owned(),
        Some(writing) => {
            let (energy, definitions) = match writing {
                Writing::Tensors => (TENSORS, String::new()),
                Writing::Scalars => (SCALARS, format!("definitions = {{ D = \"{DETERMINANT}\" }}, ")),
            };
            format!(
                "bodies.bar.material={{ name = \"hyperelastic\", energy = \"{energy}\", {definitions}parameters = {{ mu = \"{mu} Pa\", lambda = \"{lambda} Pa\" }}, density = 1000 }}"
            )
        }
    });
    settings
}

fn started(settings: &[String]) -> Result<World, String> {
    let scene = scene("cantilever_dynamic", settings)?;
    let mut world = scene.model.start(scene.state);
    bend(&mut world).map_err(|error| error.to_string())?;
    Ok(world)
}

/// Adds the seconds of `steps` steps, as they pass and by the processor.
fn time_steps(
    world: &mut World,
    steps: usize,
    [seconds, processor]: &mut [Vec<f64>; 2],
) -> Result<(), String> {
    let clock = Clock::start();
    (0..steps).try_for_each(|_| world.step().map_err(|error| error.to_string()))?;
    clock.stop(seconds, processor, steps);
    Ok(())
}

/// Positions of one world against those of another, relative to how far they have moved.
fn distance(world: &World, other: &World, start: &[Vec3]) -> f64 {
    let (q, r) = (&world.state().systems[0].q, &other.state().systems[0].q);
    let off: f64 = q.iter().zip(r).map(|(a, b)| (*a - *b).length_sq()).sum();
    let moved: f64 = q.iter().zip(start).map(|(a, b)| (*a - *b).length_sq()).sum();
    (off / moved).sqrt()
}

/// Time of a step under the text over that under the law of the table, sample by sample in turn, for tetrahedra (whose law of
/// the table is one loop with the element) and hexahedra; and how long the text takes to be ready.
pub fn law_text(name: &str, writing: Writing, most: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for element in ["tet4", "hex8"] {
        let [known, text] = [None, Some(writing)].map(|writing| settings(element, 6, writing));
        figures.push(text_over_known(&format!("{name}_{element}"), [&known, &text], most, effort)?);
    }
    figures.push(ready(name, writing, effort)?);
    Ok(figures)
}

/// A law of the table: its name, its numbers there and in its text.
pub type OfTable = (&'static str, &'static str, &'static str);

const MODULI: &str = "youngs_modulus = 1e7, poissons_ratio = 0.25";
const LAME: &str = "mu = \"4e6 Pa\", lambda = \"4e6 Pa\"";
/// All of them that texts of the library are.
pub const TABLE: [OfTable; 8] = [
    ("linear", MODULI, LAME),
    ("corotational", MODULI, LAME),
    ("st_venant_kirchhoff", MODULI, LAME),
    ("neo_hookean", MODULI, LAME),
    ("stable_neo_hookean", MODULI, LAME),
    (
        "mooney_rivlin",
        "c10 = 1.5e6, c01 = 5e5, bulk_modulus = 8e6",
        "c10 = \"1.5e6 Pa\", c01 = \"5e5 Pa\", k = \"8e6 Pa\"",
    ),
    (
        "yeoh",
        "c1 = 2e6, c2 = 1e5, c3 = 1e4, bulk_modulus = 8e6",
        "c1 = \"2e6 Pa\", c2 = \"1e5 Pa\", c3 = \"1e4 Pa\", k = \"8e6 Pa\"",
    ),
    (
        "ogden",
        "mu = [5e6, -1e6], alpha = [1.8, -2.5], bulk_modulus = 8e6",
        "mu1 = \"5e6 Pa\", a1 = 1.8, mu2 = \"-1e6 Pa\", a2 = -2.5, k = \"8e6 Pa\"",
    ),
];

/// A text and a law of the table that it is: the name of the law and its numbers; energy, definitions and numbers of the text.
struct Wording<'a> {
    law: &'static str,
    of_table: &'static str,
    energy: &'a str,
    definitions: &'a [(&'static str, &'static str)],
    of_text: &'static str,
}

/// Laws in other words than those of the library: addends in another order, other moduli, sums that are multiplied out.
const REWORDED: [Wording; 6] = [
    Wording {
        law: "linear",
        of_table: MODULI,
        energy: "mu*tr(eps*eps) + 1/2*lambda*tr(eps)*tr(eps)",
        definitions: &[],
        of_text: LAME,
    },
    Wording {
        law: "st_venant_kirchhoff",
        of_table: MODULI,
        energy: "lambda/8*(I1 - 3)^2 + mu*tr(E*E)",
        definitions: &[],
        of_text: LAME,
    },
    Wording {
        law: "corotational",
        of_table: MODULI,
        energy: "lambda/2*(l1 + l2 + l3 - 3)^2 + mu*((l3 - 1)^2 + (l2 - 1)^2 + (l1 - 1)^2)",
        definitions: &[],
        of_text: LAME,
    },
    Wording {
        law: "neo_hookean",
        of_table: MODULI,
        energy: "lambda/2*log(J)^2 + mu/2*(I1 - 3) - mu*log(J)",
        definitions: &[],
        of_text: LAME,
    },
    // m = 4/3 mu and l = lambda + 5/6 mu
    Wording {
        law: "stable_neo_hookean",
        of_table: MODULI,
        energy: "l/2*(J - 1)^2 - 3/4*m*(J - 1) + m/2*(I1 - 3 - log((I1 + 1)/4))",
        definitions: &[("m", "4/3*mu"), ("l", "lambda + 5/6*mu")],
        of_text: LAME,
    },
    Wording {
        law: "mooney_rivlin",
        of_table: "c10 = 1.5e6, c01 = 5e5, bulk_modulus = 8e6",
        energy: "k/2*(J - 1)^2 + c01*(I2_bar - 3) + c10*(I1_bar - 3)",
        definitions: &[],
        of_text: "c10 = \"1.5e6 Pa\", c01 = \"5e5 Pa\", k = \"8e6 Pa\"",
    },
];

/// Every law of the table as it is written in the library against itself, on complete explicit steps of each kind of element and on
/// implicit ones of tetrahedra.
pub fn law_text_table(name: &str, most: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for (law, of_table, of_text) in TABLE {
        let written =
            WRITTEN_LAWS.iter().find(|written| written.name == law).ok_or("every law has a text")?;
        let WrittenLaw { energy, definitions, .. } = *written;
        figures.extend(wording(
            name,
            &Wording { law, of_table, energy, definitions, of_text },
            most,
            effort,
        )?);
    }
    Ok(figures)
}

/// The same of laws in other words.
pub fn law_text_reworded(name: &str, most: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    for reworded in &REWORDED {
        figures.extend(wording(name, reworded, most, effort)?);
    }
    Ok(figures)
}

/// A text against its law on every kind of step.
fn wording(name: &str, wording: &Wording, most: f64, effort: Effort) -> Result<Vec<Figure>, String> {
    const EXPLICIT: [&str; 2] = [r#"world.period="10 us""#, r#"systems.main.stepper="symplectic_euler""#];
    const IMPLICIT: [&str; 1] =
        [r#"systems.main.stepper={ name = "backward_euler", newton = "one", solver_tolerance = 1e-6 }"#];
    let Wording { law, of_table, energy, definitions, of_text } = *wording;
    let definitions: Vec<String> =
        definitions.iter().map(|(name, part)| format!("{name} = \"{part}\"")).collect();
    let definitions = definitions.join(", ");
    let materials = [
        format!("bodies.bar.material={{ name = \"{law}\", {of_table}, density = 1000 }}"),
        format!(
            "bodies.bar.material={{ name = \"hyperelastic\", energy = \"{energy}\", definitions = {{ {definitions} }}, parameters = {{ {of_text} }}, density = 1000 }}",
        ),
    ];
    let explicit = ["tet4", "hex8", "prism6", "pyramid5", "tri3"].map(|element| (element, "", &EXPLICIT[..]));
    let mut figures = Vec::new();
    for (element, manner, stepper) in explicit.into_iter().chain([("tet4", "_implicit", &IMPLICIT[..])]) {
        let settings = materials.each_ref().map(|material| {
            let cells = if element == "tri3" { 24 } else { 5 };
            let mut settings = bar(element, cells, law);
            // the law that the bar was made with gives way
            settings.pop();
            settings.extend(stepper.iter().map(|setting| (*setting).to_owned()));
            settings.push(material.clone());
            settings
        });
        let [known, text] = &settings;
        figures.push(text_over_known(
            &format!("{name}_{law}_{element}{manner}"),
            [known, text],
            most,
            effort,
        )?);
    }
    Ok(figures)
}

/// Time of a step of the second over that of the first, sample by sample in turn, and how far their motions are apart.
fn text_over_known(
    name: &str,
    settings: [&[String]; 2],
    most: f64,
    effort: Effort,
) -> Result<Figure, String> {
    let figure = over_known(name, settings, effort)?;
    Ok(Figure {
        unit: "x built-in",
        error_of: "motion by the law of the table".to_owned(),
        baseline: Some(most),
        ..figure
    })
}

/// Steps of a solid whose rest shape may yield and does not, over those of the elastic solid that it is then.
pub fn inelastic(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let of_element = |element: &str| {
        let elastic = settings(element, 6, None);
        let yields = r#"bodies.bar.inelasticity={ yielding = { stress = "1 GPa" } }"#.to_owned();
        let inelastic: Vec<String> = elastic.iter().cloned().chain([yields]).collect();
        over_known(&format!("{name}_{element}"), [&elastic, &inelastic], effort)
    };
    ["tet4", "hex8"].into_iter().map(of_element).collect()
}

/// Time of a step of one world over that of another, sample by sample in turn.
fn over_known(name: &str, [known, text]: [&[String]; 2], effort: Effort) -> Result<Figure, String> {
    let steps = 10;
    let measured = with_threads(1, || {
        let mut known = started(known)?;
        let start = known.state().systems[0].q.clone();
        let mut text = started(text)?;
        let mut of_known = [Vec::new(), Vec::new()];
        let mut of_text = [Vec::new(), Vec::new()];
        for _ in 0..effort.choose(7, 31) {
            time_steps(&mut known, steps, &mut of_known)?;
            time_steps(&mut text, steps, &mut of_text)?;
        }
        let ratios: Vec<f64> =
            of_text[0].iter().zip(&of_known[0]).map(|(text, known)| text / known).collect();
        let by_processor = over(&of_text[1], &of_known[1]);
        Ok::<_, String>((ratios, by_processor, distance(&known, &text, &start), text.bytes()))
    });
    let (ratios, by_processor, error, bytes) = measured??;
    let samples = ratios.len();
    let (value, spread) = median(ratios);
    Ok(Figure {
        by_processor,
        name: format!("{name}_1t"),
        value,
        unit: "x elastic",
        higher_is_better: false,
        error,
        error_of: "motion of the elastic solid".to_owned(),
        baseline: None,
        threads: 1,
        samples,
        spread,
        bytes,
    })
}

/// From text to a world that can step: what a scene of ten cells takes more with the law as text.
fn ready(name: &str, writing: Writing, effort: Effort) -> Result<Figure, String> {
    let seconds = |writing: Option<Writing>, modulus: f64| {
        let settings = settings_of_modulus(modulus, "hex8", 1, writing);
        let clock = Instant::now();
        let world = started(&settings)?;
        Ok::<_, String>((clock.elapsed().as_secs_f64(), world.bytes()))
    };
    let mut samples = Vec::new();
    let mut bytes = 0;
    for sample in 0..effort.choose(5, 31) {
        // a law that was compiled before is ready at once: each sample has one of its own
        let modulus = 1e7 + f64::from(sample);
        let (without, _) = seconds(None, modulus)?;
        let (with, held) = seconds(Some(writing), modulus)?;
        samples.push(1e3 * (with - without));
        bytes = held;
    }
    let count = samples.len();
    let (value, spread) = median(samples);
    Ok(Figure {
        by_processor: None,
        name: format!("{name}_ready"),
        value,
        unit: "ms",
        higher_is_better: false,
        error: 0.0,
        error_of: "nothing: the text is compiled".to_owned(),
        baseline: Some(READY),
        threads: 1,
        samples: count,
        spread,
        bytes,
    })
}

/// How long every law that ships takes until it can run, derived and from its file, which must not take longer.
pub fn law_ready(effort: Effort) -> Result<Vec<Figure>, String> {
    let folder = std::env::temp_dir().join(format!("souple_bench_laws_{}", std::process::id()));
    let kept = KeptLaws::new(&folder);
    let measured = WRITTEN_LAWS.iter().map(|written| {
        let text = written.text().map_err(|error| error.to_string())?;
        let samples = effort.choose(5, 31);
        let mut medians = Vec::new();
        let mut figures = Vec::new();
        for (name, file, wanted) in [("derived", None, Some(READY)), ("kept", Some(&kept), None)] {
            let (mut seconds, mut processor) = (Vec::new(), Vec::new());
            // the first of each writes the file, and fills caches
            for _ in 0..=samples {
                let clock = Clock::start();
                let law = match file {
                    Some(kept) => TextLaw::kept(text.clone(), kept),
                    None => TextLaw::compile(text.clone()),
                };
                law.map_err(|error| error.to_string())?;
                clock.stop(&mut seconds, &mut processor, 1);
            }
            let milliseconds =
                |times: Vec<f64>| times.into_iter().skip(1).map(|time| 1e3 * time).collect::<Vec<f64>>();
            let by_processor = milliseconds(processor);
            let (value, spread) = median(milliseconds(seconds));
            figures.push(Figure {
                by_processor: (!by_processor.is_empty()).then(|| median(by_processor).0),
                name: format!("law_ready_{}_{name}", written.name),
                value,
                unit: "ms",
                higher_is_better: false,
                error: 0.0,
                error_of: "nothing: the same program".to_owned(),
                baseline: wanted.or(medians.first().copied()),
                threads: 1,
                samples,
                spread,
                bytes: std::fs::metadata(kept.file_of(&text)).map_or(0, |data| data.len() as usize),
            });
            medians.push(value);
        }
        Ok::<_, String>(figures)
    });
    let measured: Result<Vec<Vec<Figure>>, String> = measured.collect();
    // what cannot be removed lies where things are removed
    drop(std::fs::remove_dir_all(folder));
    Ok(measured?.concat())
}

/// One force of the bent bar alone, and its derivative along a direction.
pub struct ForceTimes {
    pub force: Timed,
    pub derivative: Timed,
    /// Forces and derivatives for comparison.
    pub forces: Vec<Vec3>,
    pub derivatives: Vec<Vec3>,
    /// Derivative against central differences of the force.
    pub derivative_error: f64,
    /// Of each sample, complete steps of what it is compared with.
    pub steps: Timed,
}

/// How forces and derivatives are timed, in turn.
#[derive(Clone, Copy)]
pub struct Sampling<'a> {
    pub threads: usize,
    pub samples: usize,
    /// Evaluations of each sample, one after another: those of several find in the caches what they left there, as steps do.
    pub in_a_row: usize,
    /// Of the bar: `bar.material`.
    pub force: &'a str,
    /// Settings of the bar of which as many complete steps are timed in each turn, if any, so that both meet the same machine.
    pub beside: Option<&'a [String]>,
}

/// Times a force of the bar and its derivative.
pub fn force_times(settings: &[String], sampling: Sampling) -> Result<ForceTimes, String> {
    let Sampling { threads, samples, in_a_row, force, beside } = sampling;
    with_threads(threads, || {
        let mut other = beside.map(started).transpose()?;
        let scene = scene("cantilever_dynamic", settings)?;
        let cells = scene.bodies[0].mesh.cell_count();
        let mut world = scene.model.start(scene.state);
        bend(&mut world).map_err(|error| error.to_string())?;
        world.with_system(0, |system, state, around, ws| {
            let index = system.forces.iter().position(|of_bar| of_bar.name() == force);
            let index = index.ok_or_else(|| format!("the bar has no force `{force}`"))?;
            let (force, at) = (&system.forces[index], system.view(index, &ws.rows, state, around));
            let scratch = &mut ws.scratches[index];
            let wave = |i: usize| (i as f64 * 12.9898).sin();
            let delta: Vec<Vec3> = (0..at.positions.len())
                .map(|i| Vec3::new(wave(3 * i), wave(3 * i + 1), wave(3 * i + 2)))
                .collect();
            let weights = TangentWeights { position: 1.0, velocity: 0.0 };
            let zeros = vec![Vec3::ZERO; delta.len()];
            let (mut forces, mut derivatives) = (zeros.clone(), zeros.clone());
            let mut seconds = [Vec::new(), Vec::new(), Vec::new()];
            let mut processor = [Vec::new(), Vec::new(), Vec::new()];
            for _ in 0..samples + 1 {
                let clock = Clock::start();
                if let Some(world) = &mut other {
                    (0..in_a_row).try_for_each(|_| world.step().map_err(|error| error.to_string()))?;
                }
                clock.stop(&mut seconds[2], &mut processor[2], in_a_row);
                let clock = Clock::start();
                for _ in 0..in_a_row {
                    forces.fill(Vec3::ZERO);
                    force.add_force(&at, scratch, &mut forces);
                }
                clock.stop(&mut seconds[0], &mut processor[0], in_a_row);
                let clock = Clock::start();
                for _ in 0..in_a_row {
                    derivatives.fill(Vec3::ZERO);
                    force.add_differential(&at, weights, &delta, scratch, &mut derivatives);
                }
                clock.stop(&mut seconds[1], &mut processor[1], in_a_row);
            }
            // (f(x + ε δ) - f(x - ε δ)) / 2ε
            let step = 1e-7;
            let mut difference = zeros.clone();
            for sign in [1.0, -1.0] {
                let moved: Vec<Vec3> =
                    at.positions.iter().zip(&delta).map(|(x, d)| *x + *d * (sign * step)).collect();
                let mut f = zeros.clone();
                force.add_force(&souple_engine::Configuration { positions: &moved, ..at }, scratch, &mut f);
                difference.iter_mut().zip(f).for_each(|(sum, f)| *sum += f * (sign / (2.0 * step)));
            }
            let bytes = force.bytes() + force.scratch_bytes(scratch);
            // the first of each fills buffers
            let timed = |index: usize| Timed {
                threads,
                seconds: seconds[index][1..].to_vec(),
                // several threads work for one clock
                processor: if threads == 1 {
                    processor[index].iter().skip(1).copied().collect()
                } else {
                    Vec::new()
                },
                cells,
                bytes,
            };
            let [force, derivative, steps] = [0, 1, 2].map(timed);
            let derivative_error = off(&derivatives, &difference);
            Ok(ForceTimes { force, derivative, forces, derivatives, derivative_error, steps })
        })
    })?
}

/// Distance of two fields, relative to the first.
pub fn off(a: &[Vec3], b: &[Vec3]) -> f64 {
    let distance: f64 = a.iter().zip(b).map(|(a, b)| (*a - *b).length_sq()).sum();
    (distance / a.iter().map(|a| a.length_sq()).sum::<f64>()).sqrt()
}

/// Settings of a bar of an element under a law; of a surface element a strip of the same length and height.
pub fn bar(element: &str, cells: u32, law: &str) -> Vec<String> {
    let material = format!("bodies.bar.material.name=\"{law}\"");
    if ElementKind::from_name(element).is_ok_and(|kind| kind.dimension() == 2) {
        let (along, width) = (10 * cells, "length = 1, width = 0.1");
        return vec![
            format!(
                "bodies.bar.mesh={{ generate = \"sheet\", {width}, cells_along = {along}, cells_across = {cells}, element = \"{element}\" }}"
            ),
            "bodies.bar.section={ name = \"plane_strain\", thickness = 0.1 }".to_owned(),
            material,
        ];
    }
    vec![
        format!("bodies.bar.mesh.cells=[{}, {cells}, {cells}]", 10 * cells),
        format!("bodies.bar.mesh.element=\"{element}\""),
        material,
    ]
}

/// What forces alone must be as fast as.
#[derive(Clone, Copy)]
pub enum Wanted {
    ElementsPerSecond(f64),
    /// Complete explicit steps of the same bar, timed in turn with them.
    Steps,
}

/// Forces alone of an element under St. Venant-Kirchhoff's law, and what a derivative product takes of them.
pub fn forces(
    name: &str,
    element: &str,
    cells: u32,
    wanted: Wanted,
    effort: Effort,
) -> Result<Vec<Figure>, String> {
    let settings = bar(element, cells, "st_venant_kirchhoff");
    let mut figures = Vec::new();
    for threads in thread_counts() {
        let steps = super::beams::explicit_settings(element, cells, "10 us");
        let beside = matches!(wanted, Wanted::Steps).then_some(&steps[..]);
        let sampling =
            Sampling { threads, samples: effort.choose(7, 41), in_a_row: 5, force: "bar.material", beside };
        let times = force_times(&settings, sampling)?;
        let held = |baseline, wanted_of: &str| Held {
            error: times.derivative_error,
            error_of: wanted_of.to_owned(),
            baseline: Some(baseline),
        };
        let of_derivative = "derivative against differences of the force";
        let wanted = match wanted {
            Wanted::ElementsPerSecond(number) => number,
            Wanted::Steps => {
                let figure = times.steps.elements_per_second("steps", &held(0.0, of_derivative));
                figure.by_processor.unwrap_or(figure.value)
            }
        };
        figures.push(times.force.elements_per_second(name, &held(wanted, of_derivative)));
        let ForceTimes { force, derivative, .. } = &times;
        let (name, unit) = (format!("{name}_derivative"), ("x force", false));
        let ratios = derivative.seconds.iter().zip(&force.seconds).map(|(d, f)| d / f).collect();
        let by_processor = over(&derivative.processor, &force.processor);
        let figure = force.figure(&name, ratios, &held(2.5, of_derivative), unit);
        figures.push(Figure { by_processor, ..figure });
    }
    Ok(figures)
}

/// Forces of a bent shell of triangles, one thread: what resists bending, and beside it, in turn over the same cells, what resists stretch.
pub fn shells(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let settings = [
        "bodies.bar.mesh={ generate = \"sheet\", length = 1, width = 0.1, cells_along = 400, cells_across = 40, element = \"tri3\" }",
        "bodies.bar.section={ name = \"membrane\", thickness = \"1 mm\" }",
        "bodies.bar.material.name=\"st_venant_kirchhoff\"",
        // the bar is bent along y
        "bodies.bar.rotate=[\"90 deg\", 0, 0]",
        "bodies.bar.bending={}",
    ];
    let settings = settings.map(str::to_owned);
    let times = |force: &str| {
        let samples = effort.choose(7, 41);
        force_times(&settings, Sampling { threads: 1, samples, in_a_row: 5, force, beside: None })
    };
    let (bending, membrane) = (times("bar.bending")?, times("bar.material")?);
    let held = |times: &ForceTimes| Held {
        error: times.derivative_error,
        error_of: "derivative against differences of the force".to_owned(),
        baseline: None,
    };
    let ratios = bending.force.seconds.iter().zip(&membrane.force.seconds).map(|(bent, flat)| bent / flat);
    let (over_membrane, unit) = (format!("{name}_over_membrane"), ("x membrane", false));
    let figure = bending.force.figure(&over_membrane, ratios.collect(), &held(&bending), unit);
    Ok(vec![
        bending.force.elements_per_second(name, &held(&bending)),
        membrane.force.elements_per_second(&format!("{name}_membrane"), &held(&membrane)),
        Figure { by_processor: over(&bending.force.processor, &membrane.force.processor), ..figure },
    ])
}

/// Time of the forces of tetrahedra by Green and Lagrange's strain over that by Cauchy's, one thread (V-01, V-28).
pub fn green_over_cauchy(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let times = |law: &str| {
        let sampling = Sampling {
            threads: 1,
            samples: effort.choose(7, 41),
            in_a_row: 5,
            force: "bar.material",
            beside: None,
        };
        force_times(&bar("tet4", 12, law), sampling)
    };
    let (green, cauchy) = (times("st_venant_kirchhoff")?, times("linear")?);
    let held = Held {
        error: green.derivative_error,
        error_of: "derivative against differences of the force".to_owned(),
        baseline: Some(GREEN_OVER_CAUCHY),
    };
    let ratios = green.force.seconds.iter().zip(&cauchy.force.seconds).map(|(green, cauchy)| green / cauchy);
    let figure = green.force.figure(name, ratios.collect(), &held, ("x Cauchy", false));
    Ok(vec![Figure { by_processor: over(&green.force.processor, &cauchy.force.processor), ..figure }])
}

/// What the source has of its own programs (V-01).
const GREEN_OVER_CAUCHY: f64 = 2.3;

/// How much faster a derivative that is computed once a step must be than one computed at every product (EXP-41).
const STORED_OVER_PRODUCTS: f64 = 2.0;

/// A way to the products with the tangent.
struct Products {
    name: &'static str,
    matrix_free: bool,
    tangent: &'static str,
    wanted: Option<f64>,
}

/// The first is what the others are held against.
const PRODUCTS: [Products; 3] = [
    Products { name: "element_by_element", matrix_free: true, tangent: "exact", wanted: None },
    Products { name: "stored", matrix_free: false, tangent: "exact", wanted: Some(STORED_OVER_PRODUCTS) },
    Products { name: "differences", matrix_free: true, tangent: "difference", wanted: None },
];

/// Products with the tangent from a stored matrix, element by element, and by differences of forces, in one implicit step
/// each; then how much faster than element by element the others are. By the source's own expressions, then by the fastest kernels, whose
/// derivative is hardly dearer than their force.
pub fn tangents(name: &str, effort: Effort) -> Result<Vec<Figure>, String> {
    let mut figures = of_products(&format!("{name}_grouped_constants"), Some("grouped_constants"), effort)?;
    figures.extend(of_products(name, None, effort)?);
    Ok(figures)
}

fn of_products(name: &str, formulation: Option<&str>, effort: Effort) -> Result<Vec<Figure>, String> {
    let step = |products: &Products| {
        let mut settings = bar("hex8", 4, "st_venant_kirchhoff");
        settings.extend(formulation.map(|name| format!("bodies.bar.formulation={{ name = \"{name}\" }}")));
        settings.push(format!("bodies.bar.tangent=\"{}\"", products.tangent));
        settings.push(format!(
            "systems.main.stepper={{ name = \"backward_euler\", newton = \"one\", solver_tolerance = 1e-6, preconditioner = \"block_jacobi\", matrix_free = {} }}",
            products.matrix_free
        ));
        settings
    };
    let tip = |settings: &[String]| super::value_of(scene("cantilever_dynamic", settings)?, 5, "tip", 1);
    let mut figures = Vec::new();
    // of products element by element
    let mut exact: Option<(f64, Timed)> = None;
    for products in &PRODUCTS {
        let settings = step(products);
        let timing = Timing {
            scene: "cantilever_dynamic",
            settings: &settings,
            prepare: super::timing::as_it_is,
            warm_up: 1,
            samples: effort.choose(4, 12),
            steps_per_sample: 1,
        };
        let (timed, tip) = (with_threads(1, || timing.sample(1))??, tip(&settings)?);
        let is_first = exact.is_none();
        let (exact_tip, of_exact) = exact.get_or_insert_with(|| (tip, timed.clone()));
        let exact_tip = *exact_tip;
        let held = |baseline| Held {
            error: (tip / exact_tip - 1.0).abs(),
            error_of: "tip after 5 steps, against products element by element".to_owned(),
            baseline,
        };
        figures.push(timed.milliseconds_per_step(&format!("{name}_{}", products.name), &held(None)));
        if !is_first {
            let row = format!("{name}_{}_saving", products.name);
            figures.push(timed.times_as_fast(&row, of_exact, &held(products.wanted)));
        }
    }
    Ok(figures)
}
