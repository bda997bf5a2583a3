//! `souple check`: a scene without running it.

use std::time::Instant;

use serde_json::{Map, Value, json};
use souple_engine::{World, WorldError};
use souple_math::Vec3;
use souple_models::frames::FramesReport;
use souple_scene::{BodyInfo, LawInfo, NetworkInfo, SkinInfo};
use souple_skin::Cost;

use super::frames_needed::Needed;
use super::progress::Pulse;
use super::{End, Refusal, print_json, print_line, print_note, read_scene, scene_path};

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file, or a folder with a scene.toml
    scene: String,
    /// Changes a value of the scene; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    settings: Vec<String>,
    /// Says how many frames bodies of frames need for it, by their softest motions, such as 5% or 0.05
    #[arg(long, value_name = "ERROR", value_parser = share)]
    accuracy: Option<f64>,
    #[arg(long)]
    pub json: bool,
    /// Warnings and errors alone
    #[arg(long)]
    quiet: bool,
}

/// A share, also in per cent.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let share = number.trim().parse::<f64>().map(|number| number * unit);
    share
        .ok()
        .filter(|share| *share > 0.0 && *share < 1.0)
        .ok_or("expected a share above 0 and below 1, such as 5%".to_owned())
}

pub fn check(arguments: &Arguments) -> Result<End, Refusal> {
    let pulse = Pulse::new("checking", arguments.quiet || arguments.json);
    let scene = read_scene(&arguments.scene, &arguments.settings)?;
    let (title, bodies, probes) = (scene.title.clone(), scene.bodies.clone(), scene.probes);
    let known_skins = scene.skins.clone();
    let networks = scene.networks.clone();
    let mut warnings = scene.warnings.clone();
    let duration = scene.run.duration;
    let hands: Vec<String> = scene.hands.iter().map(|hand| hand.name.clone()).collect();
    let period = scene.model.period;
    let mut world = scene.model.start(scene.state);
    let mut systems = Vec::new();
    for index in 0..world.model().systems.len() {
        let timestep = world.model().timestep(index);
        let forecast = world.with_system(index, |system, state, around, ws| {
            let forecast = souple_engine::stability::forecast(system, state, around, ws);
            json!({
                "name": system.name,
                "stepper": system.stepper.name(),
                "timestep_seconds": timestep,
                "shortest_interval_seconds": system.stepper.interval(timestep),
                "velocity_blocks": system.kinematics.block_count(),
                "forces": system.forces.iter().map(|force| force.name().to_owned()).collect::<Vec<_>>(),
                "highest_frequency_rad_per_second": forecast.highest_frequency,
                "stiffest_force": forecast.stiffest.map(|force| system.forces[force].name().to_owned()),
                "longest_stable_step_seconds": forecast.longest_step.is_finite().then_some(forecast.longest_step),
            })
        });
        systems.push(forecast);
    }
    let network_costs: Vec<Vec<f64>> = networks.iter().map(|network| costs_of(network, &mut world)).collect();
    warnings.extend(souple_run::forecast_warnings(&mut world));
    let counts = souple_run::counts(&world, &bodies);
    let periods = souple_run::periods_in(duration, period)?;
    warnings.extend(periods.warning);
    let steps = periods.count;
    let doubts = |skin: &SkinInfo| -> Vec<String> {
        let doubts = skin.doubts(&world, duration).into_iter();
        doubts.map(|doubt| format!("skin `{}`: {doubt}", skin.name)).collect()
    };
    warnings.extend(known_skins.iter().flat_map(doubts));
    let mut trial = Trial::first(&mut world);
    // before the steps of which the machine decides how many there are
    let mut costs: Vec<(&str, Cost)> = Vec::new();
    for skin in &known_skins {
        match skin.cost(&world) {
            Ok(cost) => costs.push((&skin.name, cost)),
            Err(why) => warnings
                .push(format!("skin `{}`: what a step of it takes could not be measured: {why}", skin.name)),
        }
    }
    trial.go_on(&mut world, steps);
    let clock = Instant::now();
    for probe in &probes {
        let _ = probe.measure(&mut world);
    }
    let measuring = clock.elapsed().as_secs_f64();
    let errors: Vec<_> = trial.refused.iter().map(|error| first_step_refused(arguments, error)).collect();
    let broke_off = trial.broke_off.as_ref();
    warnings.extend(
        broke_off
            .map(|(step, error)| format!("the last of {step} steps that were tried is refused: {error}")),
    );
    let path = scene_path(&arguments.scene);
    let of_body = |body: &BodyInfo, accuracy: f64| Needed::of(&path, &arguments.settings, body, accuracy);
    let carried = bodies.iter().filter(|body| body.frames.is_some());
    let needed: Vec<Needed> = arguments
        .accuracy
        .map_or_else(Vec::new, |accuracy| carried.map(|body| of_body(body, accuracy)).collect());
    drop(pulse);
    let document = json!({
        "scene": scene_path(&arguments.scene).display().to_string(),
        "title": title,
        "valid": errors.is_empty(),
        "errors": errors,
        "counts": counts,
        "systems": systems,
        "networks": networks.iter().zip(&network_costs).map(|(n, costs)| (n.name.clone(), network_to_json(n, costs))).collect::<Map<_, _>>(),
        "skins": costs.iter().map(|(name, cost)| ((*name).to_owned(), skin_to_json(cost))).collect::<Map<_, _>>(),
        "texts": texts_of_table(&bodies).map(|(body, (name, law))| json!({ "body": body, "text": name, "law": law })).collect::<Vec<_>>(),
        "frames": frames_to_json(&bodies),
        "modes": bodies.iter().filter_map(|body| Some((body.name.clone(), json!({ "hz": body.reduced.as_ref()?.hertz.as_ref()? })))).collect::<Map<_, _>>(),
        "frames_needed": needed.iter().map(|of| (of.body.clone(), of.to_json())).collect::<Map<_, _>>(),
        "probes": probes.len(),
        "steps": steps,
        "forecast": {
            "seconds_per_step": trial.seconds_per_step,
            "load": trial.seconds_per_step / period,
            "probes_seconds_per_period": measuring,
            "wall_seconds": trial.seconds_of(steps) + measuring * (steps + 1) as f64,
            "measured_steps": trial.steps,
            "bytes": world.bytes(),
        },
        "warnings": warnings,
    });
    if arguments.json {
        print_json(&document);
        return Ok(end_of(&errors));
    }
    for warning in &warnings {
        print_note(format_args!("warning: {warning}"));
    }
    for error in &errors {
        print_note(format_args!("error: {}", error["message"].as_str().unwrap_or_default()));
    }
    if arguments.quiet {
        return Ok(end_of(&errors));
    }
    print_line(format_args!(
        "{title}: {}",
        if errors.is_empty() { "valid" } else { "its first step is refused" }
    ));
    for (name, count) in &counts {
        print_line(format_args!("  {count:>9} {name}"));
    }
    for (index, system) in systems.iter().enumerate() {
        let longest = system["longest_stable_step_seconds"].as_f64();
        // links that do nothing at first are not in what the first state tells
        let safe =
            networks.iter().filter(|network| network.system == index).filter_map(|network| network.safe_step);
        let safe = safe.reduce(f64::min);
        let any = match safe {
            None => "any step is stable about the first state".to_owned(),
            Some(safe) => format!(
                "any step is stable about the first state, where what is stiff does not act yet; {safe:.3e} s is safe whatever acts"
            ),
        };
        let stable = longest.map_or(any, |step| {
            let of =
                system["stiffest_force"].as_str().map_or_else(String::new, |name| format!(", by `{name}`"));
            let whatever = safe.filter(|safe| *safe < step);
            let whatever =
                whatever.map_or_else(String::new, |safe| format!("; {safe:.3e} s is safe whatever acts"));
            let what =
                if is_divided(system) { "stable where that is at most" } else { "longest stable step" };
            format!("{what} {step:.3e} s{of}{whatever}")
        });
        print_line(format_args!(
            "  system {}: {} at {}; {stable}",
            system["name"].as_str().unwrap_or_default(),
            system["stepper"].as_str().unwrap_or_default(),
            steps_of(system),
        ));
    }
    for (body, (name, law)) in texts_of_table(&bodies) {
        print_line(format_args!("  {name} of {body} is {law}, and runs as that"));
    }
    for (network, costs) in networks.iter().zip(&network_costs) {
        print_network(network, costs);
    }
    for (name, modes) in
        bodies.iter().filter_map(|body| Some((&body.name, body.reduced.as_ref()?.hertz.as_ref()?)))
    {
        let ends = [modes.first(), modes.last()].map(|hertz| hertz.copied().unwrap_or_default());
        print_line(format_args!(
            "  modes of {name}: {}, from {:.4} to {:.4} Hz",
            modes.len(),
            ends[0],
            ends[1]
        ));
    }
    for (name, of_body) in bodies.iter().filter_map(|body| Some((&body.name, body.frames.as_ref()?))) {
        let FramesReport { frames, points, reaching, effective, least_effective, .. } = of_body.report;
        let FramesReport { inertia_condition, moment_condition, .. } = of_body.report;
        print_line(format_args!(
            "  frames of {name}: {frames} at {points} points, {reaching:.1} reach a point, {effective:.1} have a say \
             ({least_effective:.1} at least); condition of their inertia {inertia_condition:.1e}, of the moments that moving \
             least squares would invert {moment_condition:.1e}{}",
            if moment_condition > SINGULAR { ": singular" } else { "" }
        ));
    }
    for of_body in &needed {
        print_line(format_args!("  {}", of_body.told()));
    }
    for (name, cost) in &costs {
        print_line(format_args!(
            "  skin {name}: {} nodes worked out in a step, {}, {:.1} MB, about {:.2} ms of it",
            cost.nodes,
            souple_table::counted(cost.triangles, "triangle"),
            cost.bytes as f64 * 1e-6,
            1e3 * cost.seconds,
        ));
    }
    print_line(format_args!(
        "  about {:.2} ms per step and {:.2} ms for its probes, {:.1} s for {} without what is written, {:.1} MB of forces and \
         matrices",
        1e3 * trial.seconds_per_step,
        1e3 * measuring,
        trial.seconds_of(steps) + measuring * (steps + 1) as f64,
        souple_table::counted(steps, "step"),
        world.bytes() as f64 * 1e-6
    ));
    if let Some(late) = told_late(&hands, trial.seconds_per_step, period) {
        print_line(format_args!("  {late}"));
    }
    Ok(end_of(&errors))
}

/// That hands would be late against the clock, where a period takes longer than it is [s], by what was measured; no warning, as another machine
/// may be in time.
fn told_late(hands: &[String], seconds: f64, period: f64) -> Option<String> {
    let is_late = !hands.is_empty() && seconds > period;
    is_late.then(|| {
        let names: Vec<String> = hands.iter().map(|hand| format!("`{hand}`")).collect();
        format!(
            "load {:.0} %: a period of {:.2} ms takes about {:.2} ms here, and against the clock the world comes late for {}",
            100.0 * seconds / period,
            1e3 * period,
            1e3 * seconds,
            names.join(", ")
        )
    })
}

/// How long the steps of a system are, and the shortest of their parts where points have steps of their own.
fn steps_of(system: &Value) -> String {
    let seconds = |key: &str| system[key].as_f64().unwrap_or_default();
    let [step, shortest] = [seconds("timestep_seconds"), seconds("shortest_interval_seconds")];
    if is_divided(system) {
        format!("{step:.3e} s, its points at parts of it down to {shortest:.3e} s")
    } else {
        format!("{step:.3e} s")
    }
}

fn is_divided(system: &Value) -> bool {
    system["shortest_interval_seconds"] != system["timestep_seconds"]
}

/// Conditions beyond which a matrix is singular to rounding.
const SINGULAR: f64 = 1e15;

/// How well the frames of bodies serve.
fn frames_to_json(bodies: &[BodyInfo]) -> Map<String, Value> {
    let of_body = |body: &BodyInfo| {
        let FramesReport {
            frames,
            points,
            reaching,
            effective,
            least_effective,
            inertia_condition,
            moment_condition,
        } = body.frames.as_ref()?.report;
        let report = json!({
            "frames": frames,
            "points": points,
            "frames_reaching_a_point": reaching,
            "effective_frames_per_point": effective,
            "least_effective_frames": least_effective,
            "inertia_condition": inertia_condition,
            "moment_condition": moment_condition,
        });
        Some((body.name.clone(), report))
    };
    bodies.iter().filter_map(of_body).collect()
}

/// Forecast of a skin.
fn skin_to_json(cost: &Cost) -> Value {
    json!({
        "blocks": cost.blocks,
        "nodes_per_step": cost.nodes,
        "triangles": cost.triangles,
        "bytes": cost.bytes,
        "seconds_per_step": cost.seconds,
    })
}

/// Some steps of a scene, the state being thrown away: what they cost is measured, not guessed.
struct Trial {
    /// How many were made.
    steps: u64,
    first_seconds: f64,
    /// Of those after the first, which finds its memory and its matrices new; of the first where there is no other.
    seconds_per_step: f64,
    /// Why the first step is refused.
    refused: Option<WorldError>,
    /// The number of a later one that is, and why.
    broke_off: Option<(u64, WorldError)>,
}

/// Steps are measured for so long [s], and until there are a few as far as patience goes [s].
const MEASURED: f64 = 0.5;
const FEW: u64 = 4;
const PATIENCE: f64 = 5.0;

impl Trial {
    fn first(world: &mut World) -> Self {
        let clock = Instant::now();
        let refused = world.step().err();
        let first_seconds = clock.elapsed().as_secs_f64();
        Self { steps: 1, first_seconds, seconds_per_step: first_seconds, refused, broke_off: None }
    }

    /// Makes more steps, unless the first is refused.
    fn go_on(&mut self, world: &mut World, most: u64) {
        let clock = Instant::now();
        while self.refused.is_none() && self.steps < most {
            let elapsed = self.first_seconds + clock.elapsed().as_secs_f64();
            if elapsed > PATIENCE || (elapsed > MEASURED && self.steps > FEW) {
                break;
            }
            if let Err(error) = world.step() {
                self.broke_off = Some((self.steps + 1, error));
                break;
            }
            self.steps += 1;
            self.seconds_per_step = clock.elapsed().as_secs_f64() / (self.steps - 1) as f64;
        }
    }

    fn seconds_of(&self, steps: u64) -> f64 {
        if steps == 0 { 0.0 } else { self.first_seconds + self.seconds_per_step * (steps - 1) as f64 }
    }
}

/// A scene whose first step is refused is read and built, and yet no scene that can be run.
fn first_step_refused(arguments: &Arguments, error: &WorldError) -> Value {
    json!({
        "code": "first_step",
        "file": scene_path(&arguments.scene).display().to_string(),
        "line": null,
        "column": null,
        "path": "",
        "value": "",
        "expected": "a scene whose first step can be made: finite forces, bodies that are held, steps short enough",
        "message": format!("the first step is refused: {error}"),
    })
}

fn end_of(errors: &[Value]) -> End {
    if errors.is_empty() { End::Done } else { End::Failed }
}

/// Bodies with a text that is a law of the table: the name of the text, and of the law.
fn texts_of_table(bodies: &[BodyInfo]) -> impl Iterator<Item = (&str, (&str, &'static str))> {
    bodies.iter().flat_map(|body| body.laws.texts_of_table().map(|text| (body.name.as_str(), text)))
}

/// Seconds that the forces of a network take in a step, law by law: the fastest of a few evaluations as it stands.
fn costs_of(network: &NetworkInfo, world: &mut World) -> Vec<f64> {
    const TRIALS: usize = 5;
    world.with_system(network.system, |system, state, around, ws| {
        let mut forces = vec![Vec3::ZERO; ws.rows.positions.len()];
        let cost = |law: &LawInfo| {
            let Some(index) = system.forces.iter().position(|force| force.name() == law.force) else {
                return 0.0;
            };
            let at = system.view(index, &ws.rows, state, around);
            let mut scratch = system.forces[index].new_scratch();
            let mut trial = || {
                let clock = Instant::now();
                system.forces[index].add_force(&at, &mut scratch, &mut forces);
                clock.elapsed().as_secs_f64()
            };
            (0..TRIALS).map(|_| trial()).fold(f64::INFINITY, f64::min)
        };
        network.laws.iter().map(cost).collect()
    })
}

fn network_to_json(network: &NetworkInfo, costs: &[f64]) -> Value {
    let laws = network.laws.iter().zip(costs).map(|(law, seconds)| {
        let parameters = law.parameters.iter().map(|(name, unit, physical, algorithmic)| {
            ((*name).to_owned(), json!({ "unit": unit, "physical": physical, "algorithmic": algorithmic }))
        });
        json!({
            "force": law.force,
            "law": law.law,
            "links": law.links,
            "pairs": law.pairs,
            "saved_pairs": law.saved,
            "state_dimension": law.remembers,
            "temperatures": law.temperatures,
            "stiffest": law.stiffest,
            "parameters": parameters.collect::<Map<_, _>>(),
            "seconds_per_step": seconds,
        })
    });
    json!({
        "masses": network.masses,
        "fixed": network.fixed,
        "links": network.link_count(),
        "pairs": network.pairs()[0],
        "pairs_of_all_layers": network.pairs()[1],
        "numbers_remembered": network.memory(),
        "category": network.category(),
        "timestep_seconds": network.timestep,
        "lightest": network.lightest,
        "lightest_algorithmic": network.lightest.map(|mass| mass / network.timestep.powi(2)),
        "laws": laws.collect::<Vec<_>>(),
        "fills": network.fills.iter().map(|fill| json!({
            "group": fill.group,
            "balls": fill.balls,
            "widest_gap": fill.widest_gap,
        })).collect::<Vec<_>>(),
    })
}

fn print_network(network: &NetworkInfo, costs: &[f64]) {
    print_line(format_args!(
        "  network {}: {} ({} fixed), {} that remember {}; {}",
        network.name,
        souple_table::in_number(network.masses, "mass", "masses"),
        network.fixed,
        souple_table::counted(network.link_count() as u64, "link"),
        souple_table::counted(network.memory() as u64, "number"),
        network.category(),
    ));
    if let Some(mass) = network.lightest {
        let algorithmic = mass / network.timestep.powi(2);
        print_line(format_args!("    lightest mass m = {mass:.4e} kg, M = m/Te² = {algorithmic:.4e} N/m"));
    }
    for fill in &network.fills {
        let gap = fill.widest_gap.map(|radii| {
            format!("; no place of the surface that was looked at is farther than {radii:.3} radii from one")
        });
        print_line(format_args!(
            "    {}: {} fill a shape{}",
            fill.group,
            souple_table::counted(fill.balls as u64, "ball"),
            gap.unwrap_or_default(),
        ));
    }
    if let [pairs, all] = network.pairs()
        && pairs < all
    {
        print_line(format_args!(
            "    crowds join {}, where all layers would {}: {:.2} times as many",
            souple_table::counted(pairs, "pair"),
            souple_table::counted(all, "pair"),
            all as f64 / pairs as f64,
        ));
    }
    for (law, seconds) in network.laws.iter().zip(costs) {
        let links = match (law.links as u64, law.pairs) {
            (0, 0) => String::new(),
            (0, pairs) => format!("{}, ", souple_table::counted(pairs, "pair")),
            (links, _) => format!("{}, ", souple_table::counted(links, "link")),
        };
        let temperatures = match law.temperatures as u64 {
            0 => String::new(),
            count => format!("{}, ", souple_table::counted(count, "temperature")),
        };
        let stiffest = law.stiffest.map(|h| format!("takes {h:.4e} N/m of 4M, ")).unwrap_or_default();
        print_line(format_args!(
            "    {} ({}): {links}{stiffest}{} in the state of each, {temperatures}{:.2} µs a step",
            law.force,
            law.law,
            souple_table::counted(law.remembers as u64, "number"),
            1e6 * seconds,
        ));
        let is_other = |(_, _, physical, algorithmic): &&(_, _, f64, f64)| physical != algorithmic;
        for (name, unit, physical, algorithmic) in law.parameters.iter().filter(is_other) {
            print_line(format_args!(
                "      {name} = {physical:.4e} {unit}, {algorithmic:.4e} with a step as the unit of time"
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Late is what takes longer than a period, where somebody waits for it.
    #[test]
    fn lateness_is_of_hands() {
        let hands = ["right".to_owned()];
        assert_eq!(told_late(&hands, 0.9e-3, 1e-3), None);
        assert_eq!(told_late(&[], 2e-3, 1e-3), None);
        let told = told_late(&hands, 2e-3, 1e-3).unwrap_or_default();
        assert!(told.starts_with("load 200 %: a period of 1.00 ms takes about 2.00 ms"), "{told}");
    }

    /// Of a stepper whose points have steps of their own the shortest is told, of others the step alone.
    #[test]
    fn steps_are_told_with_their_parts() {
        let of = |shortest: f64| json!({ "timestep_seconds": 1e-2, "shortest_interval_seconds": shortest });
        assert_eq!(steps_of(&of(1e-2)), "1.000e-2 s");
        assert_eq!(steps_of(&of(2.5e-3)), "1.000e-2 s, its points at parts of it down to 2.500e-3 s");
    }
}
