//! Pins become constraints. Two pins may hold one point, along different axes or at the same place; where they want
//! different places along one axis, the scene contradicts itself and is refused.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use souple_engine::{Constraint, Motion};
use souple_math::{Mat3, Vec3};

use super::bodies::Placed;
use super::freedom::Joint;
use super::motion::{AxisMotions, motion_of_pin};
use super::reduced::PlacedReduced;
use super::{Draft, bones, frames, hanging};
use crate::diagnostic::Code;
use crate::spec::boundary::{MotionSpec, Pin};
use crate::spec::region::RegionKind;

/// What holds one point, axis by axis.
#[derive(Clone, Debug, Default)]
struct Hold {
    by: [Option<Led>; 3],
}

/// A pin of the body, by its number, and how it leads.
#[derive(Clone, Debug)]
struct Led {
    pin: usize,
    motion: Option<Arc<dyn Motion>>,
}

impl Led {
    fn offset(&self, start: Vec3, time: f64) -> Vec3 {
        self.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.offset(start, time))
    }
}

/// Times at which two motions of one point are compared, beside those of their key frames.
const SAMPLES: usize = 16;
/// Parts of the run at which they lie: multiples of the golden ratio, which no period divides.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Targets count as equal up to this, relative to each other or to the body's size: rounding of formulas.
const SAME: f64 = 1e-9;

/// All pins of all bodies.
pub fn add(draft: &mut Draft) {
    let mut added: Vec<(usize, Constraint)> = Vec::new();
    let (mut torn, mut holding, mut joints) = (Vec::new(), Vec::new(), Vec::new());
    for body in draft.bodies.iter().flat_map(|body| body.levels_of().chain([body])) {
        let system = &draft.systems[body.system];
        let mut holds = holds(draft, body);
        // plane bodies stay in their plane
        let is_plane = body.spec.section().is_plane();
        if is_plane {
            (0..body.mesh.points.len() as u32).for_each(|point| {
                holds.entry(point).or_default();
            });
        }
        if system.stepper.has_inertia() {
            torn.extend(torn_at_start(draft, body, &holds));
        }
        if body.is_held_by_springs() {
            let (force, held) = held_by_springs(draft, body, holds);
            holding.extend(force.map(|force| (body.system, force)));
            joints.extend(held);
            let (led, hindered) = bones::bind(draft, body, &system.kinematics);
            added.extend(led.into_iter().map(|constraint| (body.system, constraint)));
            joints.extend(hindered);
            continue;
        }
        if let Some(PlacedReduced::Modes(modes)) = &body.reduced {
            let of_modes = modes.constraints(&system.kinematics);
            added.extend(of_modes.into_iter().map(|constraint| (body.system, constraint)));
            joints.extend(joints_of(body, &holds));
            continue;
        }
        let asked =
            holds.iter().filter(|(_, hold)| hold.by.iter().any(Option::is_some)).map(|(point, _)| *point);
        if hanging::refuse_held(draft, body, asked) {
            continue;
        }
        for (point, hold) in holds {
            let Some(row) = body.own_row(point) else { continue };
            let start = body.mesh.points[point as usize];
            let is_held = |axis: usize| hold.by[axis].is_some() || (is_plane && axis == 2);
            let free = [0, 1, 2].map(|axis| if is_held(axis) { 0.0 } else { 1.0 });
            let motions = hold.by.map(|led| led.and_then(|led| led.motion));
            let motion = AxisMotions(motions).into_one();
            let block = system.kinematics.block_of(row);
            let free = Mat3::from_diagonal(Vec3::from_array(free));
            added.push((body.system, Constraint { free, motion, ..Constraint::pin(block, start) }));
        }
    }
    draft.warnings.extend(torn);
    draft.joints.extend(joints);
    for (system, constraint) in added {
        draft.systems[system].constraints.push(constraint);
    }
    for (system, force) in holding {
        draft.systems[system].forces.push(Box::new(force));
    }
}

/// What holds the points of a body of frames or of a polynomial, which are no unknowns: stiff springs along the pinned axes.
fn held_by_springs(
    draft: &Draft,
    body: &Placed,
    holds: BTreeMap<u32, Hold>,
) -> (Option<souple_models::frames::Hold>, Vec<Joint>) {
    let joints = joints_of(body, &holds);
    let mut held = Vec::new();
    for (point, Hold { by }) in holds {
        let axes = [0, 1, 2].map(|axis: usize| by[axis].is_some());
        let motions = by.map(|led| led.and_then(|led| led.motion));
        held.push((point, axes, AxisMotions(motions).into_one()));
    }
    (frames::hold(draft, body, held), joints)
}

/// What pins hinder of a body whose points are no unknowns.
fn joints_of(body: &Placed, holds: &BTreeMap<u32, Hold>) -> Vec<Joint> {
    let of_point = |(point, Hold { by }): (&u32, &Hold)| {
        let row = body.rows.start as u32 + point;
        let axes = [0, 1, 2].map(|axis: usize| by[axis].is_some().then_some(Vec3::AXES[axis]));
        axes.into_iter().flatten().map(move |axis| Joint {
            system: body.system,
            ends: vec![(row, 1.0)],
            direction: Some(axis),
        })
    };
    holds.iter().flat_map(of_point).collect()
}

/// Pins whose points are elsewhere at the start than at rest, in words: what moves starts at rest all around them.
fn torn_at_start(draft: &Draft, body: &Placed, holds: &BTreeMap<u32, Hold>) -> Vec<String> {
    let size = body.mesh.bounds().diagonal();
    let mut farthest: BTreeMap<usize, f64> = BTreeMap::new();
    for (point, hold) in holds {
        let start = body.mesh.points[*point as usize];
        for (axis, led) in hold.by.iter().enumerate() {
            let Some(led) = led else { continue };
            let offset = led.offset(start, 0.0)[axis].abs();
            if offset > SAME * size {
                let known = farthest.entry(led.pin).or_default();
                *known = known.max(offset);
            }
        }
    }
    let told = |(pin, offset): (usize, f64)| {
        let place = draft.place(&body.spec.pins[pin].site);
        format!(
            "{place}: this pin is {offset:.3e} m away from its points at t = 0 already: they jump there, and tear at \
             those beside them; let the motion begin at zero"
        )
    };
    farthest.into_iter().map(told).collect()
}

/// What holds the points of a body; contradictions and motions that are not finite are reported.
fn holds(draft: &Draft, body: &Placed) -> BTreeMap<u32, Hold> {
    let mut holds: BTreeMap<u32, Hold> = BTreeMap::new();
    let mut contradicting = BTreeSet::new();
    for (index, pin) in body.spec.pins.iter().enumerate() {
        let Some(region) = &pin.region else { continue };
        let Some(motion) = motion_of_pin(draft.log, draft.spec, pin) else { continue };
        let selector = draft.selector(body);
        // where a coarser mesh has no point to hold, a finer one stays at work
        let points = if body.is_coarser() { selector.points_if_any(region) } else { selector.points(region) };
        if let Some(motion) = &motion
            && !starts_finite(draft, body, pin, motion.as_ref(), &points)
        {
            continue;
        }
        let led = Led { pin: index, motion };
        for point in points {
            let hold = holds.entry(point).or_default();
            for axis in (0..3).filter(|axis| pin.axes[*axis]) {
                match &hold.by[axis] {
                    None => hold.by[axis] = Some(led.clone()),
                    Some(earlier) if !contradicting.contains(&(earlier.pin, index)) => {
                        if let Some(message) = contradiction(draft, body, [earlier, &led], point, axis) {
                            contradicting.insert((earlier.pin, index));
                            let expected = "one target for each axis of a point: other regions, or `axes`";
                            draft.log.add(Code::Conflict, &pin.site, message, expected);
                        }
                    }
                    Some(_) => {}
                }
            }
        }
    }
    holds
}

/// Where two pins want a point at different places along an axis, in words.
fn contradiction(draft: &Draft, body: &Placed, leds: [&Led; 2], point: u32, axis: usize) -> Option<String> {
    let start = body.mesh.points[point as usize];
    let size = body.mesh.bounds().diagonal();
    let pins = leds.map(|led| &body.spec.pins[led.pin]);
    let times = pins.into_iter().flat_map(key_times).chain(sampled(draft));
    for time in times {
        let [a, b] = leds.map(|led| led.offset(start, time)[axis]);
        if (a - b).abs() > SAME * f64::max(f64::max(a.abs(), b.abs()), size) {
            let name = ["x", "y", "z"][axis];
            let number = body.point_numbers[point as usize];
            let other = draft.place(&pins[0].site);
            return Some(format!(
                "this pin and {other} hold point {number} of body `{}`, at ({}, {}, {}), and want it at different \
                 places along {name}: {a} m and {b} m from its start at t = {time} s",
                body.spec.name, start.x, start.y, start.z
            ));
        }
    }
    None
}

fn sampled(draft: &Draft) -> impl Iterator<Item = f64> {
    let duration = draft.spec.run.duration;
    (0..SAMPLES).map(move |sample| (sample as f64 * GOLDEN).fract() * duration)
}

/// Times [s] at which motions of the pins of a body are looked at; none where no pin leads.
pub fn times_of(draft: &Draft, body: &Placed) -> Vec<f64> {
    let leads = |pin: &&Pin| pin.motion.is_some() || pin.rotation.is_some() || pin.bone.is_some();
    let leading: Vec<&Pin> = body.spec.pins.iter().filter(leads).collect();
    let sampled = sampled(draft).filter(|_| !leading.is_empty());
    leading.iter().flat_map(|pin| key_times(pin)).chain(sampled).collect()
}

fn key_times(pin: &Pin) -> impl Iterator<Item = f64> + '_ {
    let of = |motion: &MotionSpec| match motion {
        MotionSpec::KeyFrames { times, .. } => times.clone(),
        MotionSpec::Formula(_) => Vec::new(),
    };
    [&pin.motion, &pin.rotation].into_iter().flatten().flat_map(of)
}

/// Whether a motion gives finite offsets and velocities at the start; where not, that is reported.
fn starts_finite(draft: &Draft, body: &Placed, pin: &Pin, motion: &dyn Motion, points: &[u32]) -> bool {
    for &point in points {
        let start = body.mesh.points[point as usize];
        let held = |vector: Vec3| (0..3).filter(|axis| pin.axes[*axis]).all(|axis| vector[axis].is_finite());
        let faulty = [("offset", motion.offset(start, 0.0)), ("velocity", motion.velocity(start, 0.0))]
            .into_iter()
            .find(|(_, vector)| !held(*vector));
        if let Some((what, value)) = faulty {
            let number = body.point_numbers[point as usize];
            let message = format!(
                "the {what} of point {number}, at ({}, {}, {}), is ({}, {}, {}) at t = 0",
                start.x, start.y, start.z, value.x, value.y, value.z
            );
            let expected = "formulas that are finite with their derivative by t";
            draft.log.add(Code::NotFinite, &pin.site, message, expected);
            return false;
        }
    }
    true
}

/// Says of attachments and loads that act on held points only, and so do nothing but change reactions.
pub fn warn_of_idle(draft: &mut Draft) {
    let mut warnings = Vec::new();
    for body in &draft.bodies {
        let held = held_points(draft, body);
        warnings.extend(nearly_all(draft, body));
        for load in &body.spec.loads {
            let Some(region) = &load.region else { continue };
            let points = draft.selector(body).points(region);
            if !points.is_empty() && points.iter().all(|point| held[*point as usize]) {
                let place = draft.place(&load.site);
                warnings.push(format!(
                    "{place}: all points of this load are pinned along all axes: it moves nothing"
                ));
            }
        }
    }
    for link in &draft.spec.attachments {
        let (Some(from), Some(to), Some(region)) =
            (draft.body(&link.from), draft.body(&link.to), &link.region)
        else {
            continue;
        };
        let (held, held_there) = (held_points(draft, from), held_points(draft, to));
        let locator = souple_mesh::CellLocator::new(&to.mesh);
        let is_idle = |point: &u32| {
            let carrier = locator.carrier(from.mesh.points[*point as usize]);
            let cell = carrier.and_then(|carrier| to.mesh.cell(carrier.cell));
            held[*point as usize]
                && cell.is_some_and(|cell| cell.nodes.iter().all(|node| held_there[*node as usize]))
        };
        let points = draft.selector(from).points(region);
        let idle: Vec<u32> = points.iter().copied().filter(is_idle).collect();
        if let Some(first) = idle.first() {
            let pins = |body: &Placed| -> String {
                body.spec.pins.first().map_or_else(String::new, |pin| draft.place(&pin.site))
            };
            warnings.push(format!(
                "{}: {} of {} attached points are pinned, and so is what they are attached to, the first is point \
                 {} of body `{}`: these springs move nothing (pins: {} and {})",
                draft.place(&link.site),
                idle.len(),
                points.len(),
                from.point_numbers[*first as usize],
                link.from,
                pins(from),
                pins(to),
            ));
        }
    }
    draft.warnings.extend(warnings);
}

/// A body with so large a part of its points pinned hardly moves: a region may be in other units than it.
const NEARLY_ALL: f64 = 0.9;

/// Says where a solid is pinned nearly whole, and no pin says that it is of all of it. What pins lead is meant to be: a body may be driven
/// by them alone.
fn nearly_all(draft: &Draft, body: &Placed) -> Option<String> {
    let is_meant =
        |pin: &Pin| pin.region.as_ref().is_some_and(|region| matches!(region.kind, RegionKind::All));
    if body.spec.material.is_none() || body.spec.pins.iter().any(is_meant) {
        return None;
    }
    let rests =
        points_where(draft, body, |constraint| constraint.free == Mat3::ZERO && constraint.motion.is_none());
    let (count, all) = (rests.iter().filter(|rests| **rests).count(), rests.len());
    if count as f64 <= NEARLY_ALL * all as f64 {
        return None;
    }
    let holds = |pin: &&Pin| {
        let points = pin.region.as_ref().map(|region| draft.selector(body).points(region));
        points.map_or(0, |points| points.iter().filter(|point| rests[**point as usize]).count())
    };
    // the first of those that hold as many
    let pin = body.spec.pins.iter().rev().max_by_key(holds)?;
    Some(format!(
        "{}: {count} of the {all} points of body `{}` are pinned along all axes, most of them here: next to nothing of it moves; are the region's lengths right?",
        draft.place(&pin.site),
        body.spec.name
    ))
}

/// Per point of a body: whether it is held along all axes.
fn held_points(draft: &Draft, body: &Placed) -> Vec<bool> {
    points_where(draft, body, |constraint| constraint.free == Mat3::ZERO)
}

/// Per point of a body: whether a constraint that is so is on it.
fn points_where(draft: &Draft, body: &Placed, is_so: impl Fn(&Constraint) -> bool) -> Vec<bool> {
    let system = &draft.systems[body.system];
    let mut found = vec![false; body.mesh.points.len()];
    for constraint in system.constraints.iter().filter(|constraint| is_so(constraint)) {
        let point = system.kinematics.point_block_row(constraint.block).and_then(|row| body.point_of(row));
        if let Some(point) = point {
            found[point as usize] = true;
        }
    }
    found
}
