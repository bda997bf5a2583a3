//! The report of a run: `report.json`, and the files beside it.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};
use souple_engine::{EnergyReport, StageTimes, StepReport, UnknownKind, World};
use souple_io::IoError;
use souple_math::Vec3;
use souple_scene::BodyInfo;

use crate::machine::instruction_set;
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
    pub seed: u64,
    pub threads: usize,
    pub steps: u64,
    pub simulated_seconds: f64,
    pub wall_seconds: f64,
    pub counts: BTreeMap<String, u64>,
    pub stages: StageTimes,
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
    pub hashes: Vec<(u64, String)>,
    pub warnings: Vec<String>,
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
        let StageTimes { pairs, forces, assembly, solve, advance } = self.stages;
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "schema": SCHEMA,
            "status": self.status.as_str(),
            "scene": self.scene,
            "title": self.title,
            "scene_sha256": self.scene_sha256,
            "binary": format!("souple {}", env!("CARGO_PKG_VERSION")),
            "isa": instruction_set(),
            "threads": self.threads,
            "seed": self.seed,
            "steps": self.steps,
            "simulated_seconds": self.simulated_seconds,
            "wall_seconds": self.wall_seconds,
            "real_time_factor": self.real_time_factor(),
            "peak_bytes": self.peak_bytes,
            "solver_bytes": self.solver_bytes,
            "counts": self.counts,
            "stages_ms": {
                "pairs": 1e3 * pairs,
                "forces": 1e3 * forces,
                "assembly": 1e3 * assembly,
                "solve": 1e3 * solve,
                "advance": 1e3 * advance,
            },
            "energy": { "initial": energy_to_json(&self.energy.0), "final": energy_to_json(&self.energy.1) },
            "momentum": { "initial": momentum_to_json(self.momentum.0), "final": momentum_to_json(self.momentum.1) },
            "solver": {
                "newton_iterations": self.solver.newton_iterations,
                "linear_iterations": self.solver.linear_iterations,
                "largest_linear_residual": self.solver.linear_residual,
                "largest_newton_residual": self.solver.newton_residual,
            },
            "probes": probes,
            "hashes": hashes,
            "warnings": self.warnings,
        })
    }
}

fn probe_to_json(probe: &Summary) -> (String, Value) {
    let value = |numbers: &[f64]| match numbers {
        [single] => json!(single),
        several => json!(several),
    };
    let summary = json!({
        "unit": probe.unit,
        "first": value(&probe.first),
        "last": value(&probe.last),
        "min": value(&probe.min),
        "max": value(&probe.max),
    });
    (probe.name.clone(), summary)
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
    json!({"total": energy.total(), "kinetic": energy.kinetic, "forces": by_force})
}

fn momentum_to_json((linear, angular): (Vec3, Vec3)) -> Value {
    json!({"linear": linear.to_array(), "angular": angular.to_array()})
}

/// Points, frames, elements by kind, forces, pairs.
pub fn counts(world: &World, bodies: &[BodyInfo]) -> BTreeMap<String, u64> {
    let mut counts = BTreeMap::new();
    let mut add = |name: &str, count: usize| *counts.entry(name.to_owned()).or_insert(0) += count as u64;
    for (system, state) in world.model().systems.iter().zip(&world.state().systems) {
        for (kind, _) in system.kinematics.unknowns() {
            let name = match kind {
                UnknownKind::Point => "points",
                UnknownKind::RigidFrame => "rigid_frames",
                UnknownKind::AffineFrame => "affine_frames",
            };
            add(name, 1);
        }
        add("forces", system.forces.len());
        add("constraints", system.constraints.len());
        add("pairs", state.pairs.len());
    }
    for block in bodies.iter().flat_map(|body| &body.mesh.blocks) {
        add(block.kind.name(), block.len());
    }
    counts
}

/// `report.json`, `probes.csv` and `expect.txt` into a folder.
///
/// # Errors
/// A file cannot be written.
pub fn write_all(out: &Path, report: &Report, traces: &[Trace], verdicts: &[Verdict]) -> Result<(), IoError> {
    if !traces.is_empty() {
        write_csv(&out.join("probes.csv"), traces)?;
    }
    if !verdicts.is_empty() {
        souple_io::write_file(&out.join("expect.txt"), |file| {
            verdicts.iter().try_for_each(|verdict| {
                writeln!(file, "{} {}", if verdict.pass { "ok  " } else { "FAIL" }, verdict.message)
            })
        })?;
    }
    let document = report.to_json();
    souple_io::write_file(&out.join("report.json"), |file| writeln!(file, "{document:#}"))
}
