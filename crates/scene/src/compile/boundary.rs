//! Pins become constraints; loads and springs to ground become forces.

use std::collections::BTreeMap;
use std::sync::Arc;

use souple_engine::{Constraint, Force, Motion};
use souple_math::{Mat3, Vec3};
use souple_models::loads::{
    ForceField, FormulaVector, GroundSpring, GroundSprings, Interpolation, KeyFrames, LoadError, PointLoad,
    UniformForce,
};

use super::Draft;
use super::motion::AxisMotions;
use crate::diagnostic::{Code, Log, Site};
use crate::spec::boundary::{Distribution, Load, MotionSpec, Pin, Spring};

/// What holds one point, axis by axis.
#[derive(Clone, Debug, Default)]
struct Hold {
    held: [bool; 3],
    motions: [Option<Arc<dyn Motion>>; 3],
}

/// All pins of all bodies. Where two hold the same point along the same axis, the later one does.
pub fn add_pins(draft: &mut Draft) {
    let mut holds: Vec<BTreeMap<u32, Hold>> = vec![BTreeMap::new(); draft.systems.len()];
    for body in &draft.bodies {
        for pin in &body.spec.pins {
            let Some(region) = &pin.region else { continue };
            let Some(motion) = motion_of(draft, pin) else { continue };
            for point in draft.selector(body).points(region) {
                let hold = holds[body.system].entry(body.rows.start as u32 + point).or_default();
                for axis in (0..3).filter(|axis| pin.axes[*axis]) {
                    hold.held[axis] = true;
                    hold.motions[axis].clone_from(&motion);
                }
            }
        }
    }
    let starts: Vec<Vec<Vec3>> = (0..draft.systems.len())
        .map(|system| {
            let bodies = draft.bodies.iter().filter(|body| body.system == system);
            bodies.flat_map(|body| body.mesh.points.iter().copied()).collect()
        })
        .collect();
    for ((system, holds), starts) in draft.systems.iter_mut().zip(holds).zip(starts) {
        for (row, hold) in holds {
            let free = hold.held.map(|is_held| if is_held { 0.0 } else { 1.0 });
            let leads = hold.motions.iter().any(Option::is_some);
            let motion = leads.then(|| Arc::new(AxisMotions(hold.motions)) as Arc<dyn Motion>);
            let free = Mat3::from_diagonal(Vec3::from_array(free));
            let block = system.kinematics.block_of(row);
            system.constraints.push(Constraint { block, free, start: starts[row as usize], motion });
        }
    }
}

/// `Some(None)` where the pin stays, `None` where its motion was refused.
fn motion_of(draft: &Draft, pin: &Pin) -> Option<Option<Arc<dyn Motion>>> {
    motion(draft.log, pin.motion.as_ref(), &pin.site)
}

/// `Some(None)` where no motion is written, `None` where it was refused.
pub fn motion(log: &Log, spec: Option<&MotionSpec>, site: &Site) -> Option<Option<Arc<dyn Motion>>> {
    let motion: Arc<dyn Motion> = match spec {
        None => return Some(None),
        Some(MotionSpec::Formula(formulas)) => Arc::new(FormulaVector::from_components(formulas.clone())),
        Some(MotionSpec::KeyFrames { times, offsets, is_smooth }) => {
            let interpolation = if *is_smooth { Interpolation::Smooth } else { Interpolation::Linear };
            match KeyFrames::new(times.clone(), offsets.clone(), interpolation) {
                Ok(frames) => Arc::new(frames),
                Err(error) => {
                    log.add(Code::OutOfRange, site, error.to_string(), "key frames in order");
                    return None;
                }
            }
        }
    };
    Some(Some(motion))
}

/// All loads and springs of all bodies.
pub fn add_loads(draft: &mut Draft) {
    let mut added: Vec<(usize, Box<dyn Force>)> = Vec::new();
    for body in &draft.bodies {
        let rows_of = |region: &Option<_>, distribution: Distribution| -> Vec<(u32, f64)> {
            let Some(region) = region else { return Vec::new() };
            let points = draft.selector(body).points(region);
            let share = distribution.share(points.len());
            points.into_iter().map(|point| (body.rows.start as u32 + point, share)).collect()
        };
        for (index, load) in body.spec.loads.iter().enumerate() {
            let rows = rows_of(&load.region, load.distribution);
            let force = point_load(format!("{}.loads[{index}]", body.spec.name), load, rows);
            push(draft, body.system, force, &load.site, &mut added);
        }
        for (index, spring) in body.spec.springs.iter().enumerate() {
            let rows = rows_of(&spring.region, spring.distribution);
            let name = format!("{}.springs[{index}]", body.spec.name);
            let anchor = |row: u32| body.mesh.points[row as usize - body.rows.start];
            let force = ground_springs(name, spring, &rows, anchor);
            push(draft, body.system, force, &spring.site, &mut added);
        }
    }
    for (system, force) in added {
        draft.systems[system].forces.push(force);
    }
}

/// What a region or formula left out has been reported already.
type Built = Option<Result<Box<dyn Force>, LoadError>>;

fn push(draft: &Draft, system: usize, built: Built, site: &Site, added: &mut Vec<(usize, Box<dyn Force>)>) {
    match built {
        Some(Ok(force)) => added.push((system, force)),
        Some(Err(error)) => draft.log.add(Code::OutOfRange, site, error.to_string(), "finite numbers"),
        None => {}
    }
}

fn point_load(name: String, load: &Load, rows: Vec<(u32, f64)>) -> Built {
    let formulas = load.force.as_ref()?;
    if rows.is_empty() {
        return None;
    }
    let variables = crate::spec::boundary::LOAD_VARIABLES.len();
    let is_constant =
        formulas.iter().all(|formula| !(0..variables).any(|variable| formula.depends_on(variable)));
    let field: Arc<dyn ForceField> = if is_constant {
        let nowhere = vec![0.0; variables];
        Arc::new(UniformForce(Vec3::from_array(
            [0, 1, 2].map(|axis: usize| formulas[axis].evaluate(&nowhere)),
        )))
    } else {
        Arc::new(FormulaVector::from_components(formulas.clone()))
    };
    Some(PointLoad::new(name, rows, field).map(|force| Box::new(force) as _))
}

fn ground_springs(name: String, spring: &Spring, rows: &[(u32, f64)], anchor: impl Fn(u32) -> Vec3) -> Built {
    if rows.is_empty() {
        return None;
    }
    let springs = rows.iter().map(|&(row, share)| GroundSpring { row, share, anchor: anchor(row) }).collect();
    Some(
        GroundSprings::new(name, springs, spring.stiffness, spring.damping).map(|force| Box::new(force) as _),
    )
}
