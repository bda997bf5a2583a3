//! The report of a run: `report.json`, and the files beside it.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use souple_engine::{EnergyReport, StageTimes, StepReport, UnknownKind, World};
use souple_math::Vec3;
use souple_models::loads::{Attachments, Slip};
use souple_scene::{BodyInfo, SkinInfo};

use crate::expect::summary;
use crate::failure::Failure;
use crate::folds::{self, Fold};
use crate::machine::{binary, instruction_set};
use crate::output::{OutputError, OutputFolder};
use crate::sound::SoundSummary;
use crate::trace::{Summary, write_csv};
use crate::{Trace, Verdict};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Done,
    Interrupted,
    Failed,
}

impl Status {
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        }
    }
}

/// What a run was, in numbers.
pub struct Report {
    pub status: Status,
    pub title: String,
    pub scene: String,
    pub scene_sha256: String,
    /// `path=value` that changed the scene.
    pub settings: Vec<String>,
    pub seed: u64,
    pub threads: usize,
    /// The period it began at: 0, or that of the snapshot it went on from.
    pub first_step: u64,
    /// Periods stepped.
    pub steps: u64,
    pub simulated_seconds: f64,
    pub wall_seconds: f64,
    pub counts: BTreeMap<String, u64>,
    /// Of each skin by its name.
    pub skins: serde_json::Map<String, Value>,
    /// Of each attachment by its name, at the end.
    pub attachments: serde_json::Map<String, Value>,
    /// Changes of the topology of skins, in their order; of a run that went on from a snapshot those since.
    pub skin_changes: Vec<SkinChange>,
    pub stages: StageTimes,
    pub around: AroundSteps,
    /// At the start and at the end.
    pub energy: (EnergyReport, EnergyReport),
    /// Linear and angular, at the start and at the end.
    pub momentum: ((Vec3, Vec3), (Vec3, Vec3)),
    pub solver: StepReport,
    /// Most memory the process has held up to the last step, pictures not included; `None` where the system does
    /// not tell.
    pub peak_bytes: Option<u64>,
    /// Bytes of forces, matrices and factors.
    pub solver_bytes: usize,
    pub probes: Vec<Summary>,
    /// Those that were written.
    pub sounds: Vec<SoundSummary>,
    /// Of bodies that were inside out somewhere.
    pub folds: Vec<Fold>,
    pub hashes: Vec<(u64, String)>,
    pub expectations: Vec<Verdict>,
    /// Why the run ended early, where it failed.
    pub failure: Option<Failure>,
    pub warnings: Vec<String>,
}

/// Wall seconds spent beside the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AroundSteps {
    /// Probes.
    pub measure: f64,
    /// The look for matter that is inside out.
    pub inside_out: f64,
    /// Hashes, frames and snapshots along the way.
    pub write: f64,
}

/// Version of the layout of `report.json`.
const SCHEMA: u64 = 1;

impl Report {
    /// Simulated seconds per second of wall time.
    pub fn real_time_factor(&self) -> f64 {
        if self.wall_seconds > 0.0 { self.simulated_seconds / self.wall_seconds } else { 0.0 }
    }

    pub fn to_json(&self) -> Value {
        let probes: serde_json::Map<String, Value> = self.probes.iter().map(probe_to_json).collect();
        let hashes: Vec<Value> =
            self.hashes.iter().map(|(step, hash)| json!({"step": step, "hash": hash})).collect();
        let StageTimes { pairs, forces, assembly, solve, advance, fields, .. } = self.stages;
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "schema": SCHEMA,
            "status": self.status.as_str(),
            "scene": self.scene,
            "title": self.title,
            "scene_sha256": self.scene_sha256,
            "settings": self.settings,
            "binary": binary(),
            "isa": instruction_set(),
            "threads": self.threads,
            "seed": self.seed,
            "first_step": self.first_step,
            "steps": self.steps,
            "simulated_seconds": self.simulated_seconds,
            "wall_seconds": self.wall_seconds,
            "real_time_factor": self.real_time_factor(),
            "peak_bytes": self.peak_bytes,
            "solver_bytes": self.solver_bytes,
            "counts": self.counts,
            "skins": self.skins,
            "attachments": self.attachments,
            "stages_ms": {
                "pairs": 1e3 * pairs,
                "forces": 1e3 * forces,
                "assembly": 1e3 * assembly,
                "solve": 1e3 * solve,
                "advance": 1e3 * advance,
                "fields": 1e3 * fields,
                "measure": 1e3 * self.around.measure,
                "inside_out": 1e3 * self.around.inside_out,
                "write": 1e3 * self.around.write,
            },
            "derivatives_ms": 1e3 * self.stages.derivatives(),
            "energy": { "initial": energy_to_json(&self.energy.0), "final": energy_to_json(&self.energy.1) },
            "momentum": { "initial": momentum_to_json(self.momentum.0), "final": momentum_to_json(self.momentum.1) },
            "solver": {
                "newton_iterations": self.solver.newton_iterations,
                "linear_iterations": self.solver.linear_iterations,
                "made_definite": self.solver.made_definite,
                "gone_on": self.solver.gone_on,
                "shortened": self.solver.shortened,
                "largest_linear_residual": self.solver.linear_residual,
                "largest_newton_residual": self.solver.newton_residual,
                "contact_iterations": self.solver.contact_iterations,
                "largest_contact_residual": self.solver.contact_residual,
                "wedged_steps": self.solver.wedged_steps,
                "contacts_wedged": self.solver.contacts_wedged,
            },
            "probes": probes,
            "sounds": self.sounds.iter().map(SoundSummary::to_json).collect::<serde_json::Map<_, _>>(),
            "inside_out": folds::to_json(&self.folds),
            "hashes": hashes,
            "expectations": self.expectations.iter().map(Verdict::to_json).collect::<Vec<_>>(),
            "error": self.failure.as_ref().map(Failure::to_json),
            "warnings": self.warnings,
        })
    }
}

/// How attachments stand: how many springs each has, how many of them have torn, and how far the others let go.
pub fn attachments(world: &World) -> serde_json::Map<String, Value> {
    let mut found = serde_json::Map::new();
    for system in 0..world.model().systems.len() {
        world.visit_forces(system, &mut |force, at| {
            if let Some(springs) = force.as_any().downcast_ref::<Attachments>() {
                let Slip { links, torn, greatest } = springs.slip(at);
                let told = json!({"springs": links, "torn": torn, "greatest_slip_m": greatest});
                found.insert(force.name().to_owned(), told);
            }
        });
    }
    found
}

fn probe_to_json(probe: &Summary) -> (String, Value) {
    let value = numbers_to_json;
    let summary = json!({
        "unit": probe.unit,
        "first": value(&probe.first),
        "last": value(&probe.last),
        "min": value(&probe.min),
        "max": value(&probe.max),
        "min_at": value(&probe.min_at),
        "max_at": value(&probe.max_at),
        "frequency": match probe.frequency.as_slice() {
            [single] => json!(single),
            several => json!(several),
        },
    });
    (probe.name.clone(), summary)
}

/// One number, or a list.
pub fn numbers_to_json(numbers: &[f64]) -> Value {
    match numbers {
        [single] => json!(single),
        several => json!(several),
    }
}

fn energy_to_json(energy: &EnergyReport) -> Value {
    // names are unique within a system only: `gravity` of two systems is one line
    let mut by_force: Vec<(&str, f64, f64)> = Vec::new();
    for (name, energy) in &energy.by_force {
        match by_force.iter_mut().find(|(known, _, _)| known == name) {
            Some((_, stored, dissipated)) => {
                *stored += energy.stored;
                *dissipated += energy.dissipated;
            }
            None => by_force.push((name, energy.stored, energy.dissipated)),
        }
    }
    let by_force: serde_json::Map<String, Value> = by_force
        .into_iter()
        .map(|(name, stored, dissipated)| {
            (name.to_owned(), json!({"stored": stored, "dissipated": dissipated}))
        })
        .collect();
    // a coupling is a spring from each of its points, `couplings[0].17`: one line for each coupling
    let mut couplings: BTreeMap<&str, f64> = BTreeMap::new();
    for (name, made) in &energy.made_by_coupling {
        let coupling = name.rsplit_once('.').map_or(name.as_str(), |(coupling, _)| coupling);
        *couplings.entry(coupling).or_default() += made;
    }
    let couplings: serde_json::Map<String, Value> =
        couplings.into_iter().map(|(name, made)| (name.to_owned(), json!({"made": made}))).collect();
    let controls: serde_json::Map<String, Value> =
        energy.made_by_control.iter().map(|(name, made)| (name.clone(), json!({"made": made}))).collect();
    json!({
        "total": energy.total(),
        "kinetic": energy.kinetic,
        "forces": by_force,
        "couplings": couplings,
        "controls": controls,
    })
}

fn momentum_to_json((linear, angular): (Vec3, Vec3)) -> Value {
    json!({"linear": linear.to_array(), "angular": angular.to_array()})
}

/// Points, frames, elements by kind, forces, pairs.
pub fn counts(world: &World, bodies: &[BodyInfo]) -> BTreeMap<String, u64> {
    let mut counts = BTreeMap::new();
    let mut add = |name: &str, count: usize| *counts.entry(name.to_owned()).or_insert(0) += count as u64;
    for (index, (system, state)) in world.model().systems.iter().zip(&world.state().systems).enumerate() {
        for (kind, _) in system.kinematics.unknowns() {
            let name = match kind {
                UnknownKind::Point => "points",
                UnknownKind::RigidFrame => "rigid_frames",
                UnknownKind::AffineFrame => "affine_frames",
                UnknownKind::QuadraticFrame => "quadratic_frames",
                UnknownKind::FloatingFrame { .. } => "floating_frames",
            };
            add(name, 1);
        }
        add("forces", system.forces.len());
        add("constraints", system.constraints.len());
        let mut near = 0;
        world.visit_near(index, &mut |_| near += 1);
        add("pairs", state.pairs.len() + near);
    }
    for block in bodies.iter().flat_map(|body| &body.mesh.blocks) {
        add(block.kind.name(), block.len());
    }
    for body in bodies.iter().filter(|body| body.hanging_count() > 0) {
        add("hanging_points", body.hanging_count());
    }
    counts
}

/// A change of a skin's topology.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinChange {
    pub skin: String,
    /// When it began [s].
    pub time: f64,
    /// Since then.
    pub euler: i64,
    pub components: u64,
}

impl SkinChange {
    fn to_json(&self) -> Value {
        json!({"time": self.time, "euler": self.euler, "components": self.components})
    }

    /// In words.
    pub fn message(&self) -> String {
        let Self { skin, time, euler, components } = self;
        format!(
            "the topology of skin `{skin}` changed at {time:.6} s: {}, Euler characteristic {euler}",
            souple_table::counted(*components, "part")
        )
    }
}

/// Skins as they stand, how their topology changed, and how many of their surfaces were checked to be closed, oriented and manifold.
pub fn skins(world: &World, skins: &[SkinInfo], changes: &[SkinChange]) -> serde_json::Map<String, Value> {
    let skin = |info: &SkinInfo| {
        let view = info.view(world);
        let (measures, [points, triangles]) = (view.measures(), view.counts());
        let numbers = json!({
            "area": measures.area,
            "volume": measures.volume,
            "euler": measures.euler,
            "components": measures.components,
            "events": view.events(),
            "changes": changes.iter().filter(|change| change.skin == info.name).map(SkinChange::to_json).collect::<Vec<_>>(),
            "points": points,
            "triangles": triangles,
            "blocks": view.grid.keys.len(),
            "closed_manifold_surfaces": view.checked(),
        });
        (info.name.clone(), numbers)
    };
    skins.iter().map(skin).collect()
}

/// Names of the files that [`write_report`] and [`write_tables`] may write.
pub const NAMES: [&str; 3] = [REPORT, PROBES, EXPECT];
const REPORT: &str = "report.json";
const PROBES: &str = "probes.csv";
const EXPECT: &str = "expect.txt";

/// `report.json` into the folder of a run.
///
/// # Errors
/// The file cannot be written.
pub fn write_report(folder: &mut OutputFolder, report: &Report) -> Result<(), OutputError> {
    let document = report.to_json();
    Ok(souple_io::write_file(&folder.claim(REPORT)?, |file| writeln!(file, "{document:#}"))?)
}

/// `probes.csv` and `expect.txt` into the folder of a run.
///
/// # Errors
/// A file cannot be written.
pub fn write_tables(folder: &mut OutputFolder, report: &Report, traces: &[Trace]) -> Result<(), OutputError> {
    if !traces.is_empty() {
        write_csv(&folder.claim(PROBES)?, traces)?;
    }
    let verdicts = &report.expectations;
    if !verdicts.is_empty() {
        souple_io::write_file(&folder.claim(EXPECT)?, |file| {
            writeln!(file, "{}", summary(verdicts))?;
            verdicts.iter().try_for_each(|verdict| {
                writeln!(file, "{:10}  {}", verdict.finding.as_str(), verdict.message())
            })
        })?;
    }
    Ok(())
}
