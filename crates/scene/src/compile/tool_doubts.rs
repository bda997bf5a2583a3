//! Tools that start where nothing touches them or are of another scale than what they touch, hands whose coupling is too stiff for them, and
//! devices that are lost after the run.

use std::collections::{BTreeMap, BTreeSet};

use souple_engine::Motion;
use souple_engine::obstacle::Side;
use souple_haptics::{Arm, Coupling, TICK};
use souple_math::Vec3;
use souple_mesh::{BoundingBox, CellLocator};
use souple_models::contact::shape::BuildShape;
use souple_table::{four_digits, readable};

use super::Draft;
use super::bodies::Placed;
use super::contact::built;
use super::motion::motion;
use crate::diagnostic::Site;
use crate::reader::Chosen;
use crate::spec::boundary::MotionSpec;
use crate::spec::contact::{Against, Detect};

/// Dates over the run at which it is looked how fast a hand means to move, beside those of its key frames.
const SAMPLES: u32 = 2000;
/// Parts of the time from a key frame to the next at which it is looked: what is smooth is fastest halfway.
const BETWEEN_KEYS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Lengths of a scene differ by less than this factor, where one touches the other. What is written in millimetres and read in metres is a thousand times
/// as long; a finger is a tenth of an organ, a needle a hundredth, and neither are a hundred organs thick.
const OTHER_SCALE: f64 = 100.0;
/// A body in millimetres is a thousand times as large as what touches it, and the tip of a needle is some hundredths of an organ.
const MILLI: f64 = 1000.0;

/// Finds cells of bodies, each by one tree that is built when first asked.
#[derive(Default)]
struct Locators<'a>(BTreeMap<&'a str, CellLocator<'a>>);

impl<'a> Locators<'a> {
    fn of(&mut self, body: &'a Placed) -> &CellLocator<'a> {
        self.0.entry(&body.spec.name).or_insert_with(|| CellLocator::new(&body.mesh))
    }
}

/// Warns of all of them.
pub fn warn(draft: &mut Draft) {
    let warnings = doubts(draft);
    // several contacts may be of one tool and one body
    let mut told = BTreeSet::new();
    draft.warnings.extend(warnings.into_iter().filter(|warning| told.insert(warning.clone())));
}

fn doubts(draft: &Draft) -> Vec<String> {
    let (mut warnings, mut locators) = (Vec::new(), Locators::default());
    for contact in &draft.spec.contacts {
        let Some(Against::Shape(name)) = &contact.against else { continue };
        let Some(shape) = draft.spec.shapes.iter().find(|shape| shape.name == *name) else { continue };
        // one that turns is elsewhere than its shape says
        if shape.rotation.is_some() {
            continue;
        }
        let tool = (shape.shape.as_ref(), shape.motion.as_ref(), &shape.site);
        let what = format!("shape `{name}`");
        warnings.extend(inside(draft, &mut locators, (&contact.body, contact.detect), &what, tool));
        warnings.extend(of_other_scale(draft, &contact.body, (&what, false), tool));
    }
    for hand in &draft.spec.hands {
        let tool = (hand.tool.as_ref(), hand.motion.as_ref(), &hand.site);
        let what = format!("the tool of hand `{}`", hand.name);
        warnings.extend(inside(draft, &mut locators, (&hand.touch.body, hand.touch.detect), &what, tool));
        warnings.extend(of_other_scale(draft, &hand.touch.body, (&what, true), tool));
    }
    for (info, spec) in draft.hands.iter().filter_map(|info| {
        let spec = draft.spec.hands.iter().find(|hand| hand.name == info.name)?;
        Some((info, spec))
    }) {
        let Some(arm) = info.device.arm() else { continue };
        if let (Some(doubt), Some(chosen)) =
            (lost_too_late(arm, draft.spec.run.written_duration()), &spec.device)
        {
            let place = draft.place(chosen.site_of("lost_at"));
            warnings.push(format!("{place}: hand `{}`: {doubt}", spec.name));
        }
        if spec.touch.imposed.is_some() {
            continue;
        }
        let speed = fastest(arm.intent.as_ref(), spec.motion.as_ref(), draft.spec.run.duration);
        let doubts = too_stiff(&info.port.coupling, arm, speed);
        let place = draft.place(&spec.site);
        warnings.extend(doubts.into_iter().map(|doubt| format!("{place}: hand `{}`: {doubt}", spec.name)));
    }
    warnings
}

/// A tool, what moves it, and where it is written.
type Tool<'a> = (Option<&'a Chosen<BuildShape>>, Option<&'a MotionSpec>, &'a Site);

/// Of a tool that starts with all of its surface inside the body that it is to touch, or with its middle where triangles are touched from outside.
fn inside<'a>(
    draft: &'a Draft,
    locators: &mut Locators<'a>,
    (body, detect): (&str, Detect),
    what: &str,
    (shape, moves, site): Tool,
) -> Option<String> {
    let body = draft.body(body)?;
    if body.mesh.cell_count() == 0 || body.mesh.dimension() < 3 {
        return None;
    }
    let outline = built(draft, shape?)?.outline()?;
    // a container holds the body
    if outline.bodies != Side::Outside {
        return None;
    }
    let moves = motion(draft.log, moves, site)?;
    let offset = moves.map_or(Vec3::ZERO, |moves| moves.offset(Vec3::ZERO, 0.0));
    let locator = locators.of(body);
    let is_inside =
        |place: &Vec3| locator.carrier(*place + offset).is_some_and(|location| location.distance == 0.0);
    let points = &outline.surface.points;
    if points.is_empty() {
        return None;
    }
    let (place, name) = (draft.place(site), &body.spec.name);
    let middle = points.iter().copied().sum::<Vec3>() / points.len() as f64;
    if points.iter().all(is_inside) {
        Some(format!(
            "{place}: {what} starts inside body `{name}`, where no surface is: it feels nothing until it comes out, and is then on the wrong side of it; \
             start it outside"
        ))
    } else if detect == Detect::Triangles && is_inside(&middle) {
        Some(format!(
            "{place}: {what} starts with its middle inside body `{name}`: triangles that face away from it do not push it, and it may feel nothing until it \
             has come out; start it outside"
        ))
    } else {
        None
    }
}

/// Of a tool, or of how it is moved, that is so much larger or smaller than what it touches that one of the two is hardly in metres. A container is as large
/// as it likes.
fn of_other_scale(
    draft: &Draft,
    body: &str,
    (what, is_held): (&str, bool),
    (shape, moves, site): Tool,
) -> Vec<String> {
    let measured = || {
        let body = draft.body(body).filter(|body| body.spec.network.is_none())?;
        let outline = built(draft, shape?)?.outline().filter(|outline| outline.bodies == Side::Outside)?;
        let moved = moves.map_or(Some(0.0), |moves| farthest(draft, moves, site))?;
        let tool = BoundingBox::of(outline.surface.points.iter().copied());
        let all_finite = moved.is_finite() && tool.diagonal().is_finite();
        (all_finite && body.mesh.bounds().diagonal() > 0.0).then_some((body, tool, moved))
    };
    let Some((body, tool, moved)) = measured() else { return Vec::new() };
    let (own, across) = (body.mesh.bounds().diagonal(), tool.diagonal());
    let Vec3 { x, y, z } = tool.size();
    let thickness = x.min(y).min(z);
    let mut doubts = Vec::new();
    // what stands still is ground
    if thickness > OTHER_SCALE * own && (moves.is_some() || is_held) {
        doubts.push(format!("is {} m thick", four_digits(thickness)));
    } else if MILLI * across < own {
        doubts.push(format!("is {} m across", four_digits(across)));
    }
    if moved > OTHER_SCALE * own.max(across) {
        doubts.push(format!("moves by up to {} m", four_digits(moved)));
    }
    let (place, name) = (draft.place(site), &body.spec.name);
    let own = four_digits(own);
    let said = |doubt: String| {
        format!(
            "{place}: {what} {doubt}, and body `{name}`, which it touches, is {own} m across: numbers without a unit are metres (did you mean mm, as \"5 mm\", or \
             `scale = 0.001` of a file?)"
        )
    };
    doubts.into_iter().map(said).collect()
}

/// How far a motion goes from where it starts, at most [m]: to its key frames, or in the course of the run; `None` where it was refused.
fn farthest(draft: &Draft, moves: &MotionSpec, site: &Site) -> Option<f64> {
    let motion = motion(draft.log, Some(moves), site)??;
    let start = motion.offset(Vec3::ZERO, 0.0);
    let dates = match moves {
        MotionSpec::KeyFrames { times, .. } => times.clone(),
        MotionSpec::Formula(_) => sampled(draft.spec.run.duration).collect(),
    };
    let away = dates.into_iter().map(|time| (motion.offset(Vec3::ZERO, time) - start).length());
    Some(away.filter(|length| length.is_finite()).fold(0.0, f64::max))
}

/// Of a device that is lost when the run is over.
fn lost_too_late(arm: &Arm, duration: Option<f64>) -> Option<String> {
    let ((at, lasting), duration) = (arm.lost, duration?);
    (lasting > 0.0 && at >= duration).then(|| {
        let [at, duration] = [at, duration].map(readable);
        format!("its device is lost at {at} s, after the `run.duration` of {duration} s: only a longer run comes to it")
    })
}

/// What of a coupling is too stiff for the arm that holds its device.
///
/// The device feels its force a tick `T` long, and the tool is led to where the device was: as stiff as may be it is a tick behind,
/// `x - y = T v`. Then `M v' = M v - T (k T v + c (v - v₋))`, whose swing from tick to tick dies where `T² k + 2 T c < 2 M`. At a speed `v` of the
/// hand the spring is stretched by `T v` in the air already.
fn too_stiff(coupling: &Coupling, arm: &Arm, speed: f64) -> Vec<String> {
    let Coupling { stiffness, damping, limit } = *coupling;
    let mut doubts = Vec::new();
    let (asked, bound) = (TICK * TICK * stiffness + 2.0 * TICK * damping, 2.0 * arm.mass);
    if asked >= bound {
        doubts.push(format!(
            "a coupling of {} N/m and {} N s/m is too stiff for an arm of {} kg that feels it a millisecond long: the force goes to and fro between its limits; T² k + 2 T c, \
             {} kg, must be below twice that mass",
            four_digits(stiffness),
            four_digits(damping),
            four_digits(arm.mass),
            four_digits(asked)
        ));
    }
    let drag = stiffness * TICK * speed;
    if drag >= limit {
        doubts.push(format!(
            "at {} m/s, as fast as the hand means to move, its tool is a millisecond behind and the coupling of {} N/m pulls with its limit of {} N in the air already: \
             take less than {} N/m",
            four_digits(speed),
            four_digits(stiffness),
            four_digits(limit),
            four_digits(limit / (TICK * speed))
        ));
    }
    doubts
}

/// The greatest speed that is meant in the course of a run [m/s].
fn fastest(intent: &dyn Motion, written: Option<&MotionSpec>, duration: f64) -> f64 {
    let keys = match written {
        Some(MotionSpec::KeyFrames { times, .. }) => times.as_slice(),
        _ => &[],
    };
    let between =
        keys.windows(2).flat_map(|ends| BETWEEN_KEYS.map(|part| ends[0] + part * (ends[1] - ends[0])));
    let times = sampled(duration).chain(between).filter(|time| (0.0..=duration).contains(time));
    let speed = |time: f64| intent.velocity(Vec3::ZERO, time).length();
    times.map(speed).filter(|speed| speed.is_finite()).fold(0.0, f64::max)
}

/// Dates over a run, evenly [s].
fn sampled(duration: f64) -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(move |sample| duration * f64::from(sample) / f64::from(SAMPLES))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use souple_models::loads::RigidMotion;

    use super::*;

    fn arm() -> Arm {
        Arm {
            mass: 0.4,
            stiffness: 300.0,
            damping: 8.0,
            reflex: 0.0,
            delay: 0.06,
            lost: (0.0, 0.0),
            intent: Arc::new(RigidMotion::default()),
        }
    }

    /// The usual coupling is not, one beyond `2 M/T²` is.
    #[test]
    fn couplings_are_bounded_by_the_arm() {
        assert!(too_stiff(&Coupling::DEFAULT, &arm(), 0.0).is_empty());
        let bound = 2.0 * 0.4 / (TICK * TICK);
        let of = |stiffness| too_stiff(&Coupling { stiffness, damping: 0.0, limit: 5.0 }, &arm(), 0.0);
        assert!(of(0.99 * bound).is_empty());
        assert!(of(1.01 * bound)[0].contains("too stiff for an arm of 0.4 kg"));
    }
}
