//! Rigid motions that nothing holds: a body without inertia that can move freely has no equilibrium to find.
//!
//! A connected part of a mesh moves rigidly as `u(x) = t + ω × x`, with six numbers. Every pin, spring to ground,
//! attachment, coupling and touching contact hinders `d · u` at a point in a direction `d`; the motions that none
//! hinders are the null space of the sum `Σ c cᵀ` of those conditions over the parts that are joined, less what moves no
//! point: a straight cable turns about itself without anybody noticing. Contacts that do not touch yet may come to hold
//! a part: where they could, a warning says so instead of an error.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_mesh::Sets;
use souple_models::contact::{ContactPoint, Shape};
use souple_models::loads::RigidMotion;

use super::bodies::Placed;
use super::{Draft, bending};
use crate::diagnostic::Code;

/// Something that hinders motion: `Σ w u(row) · d = 0`.
#[derive(Clone, Debug)]
pub struct Joint {
    pub system: usize,
    /// Rows with their weights; those of an end that is the ground are left out.
    pub ends: Vec<(u32, f64)>,
    /// The direction hindered; all where `None`.
    pub direction: Option<Vec3>,
}

/// Pivots below this part of the greatest count as zero: rounding of coordinates, squared in the sum.
const SINGULAR: f64 = 1e-10;
/// More parts joined to each other than this are not judged: the sum is dense.
const MOST_PARTS: usize = 64;
/// A surface point this close to a shape touches it, relative to the size of the body.
const TOUCHING: f64 = 1e-6;

/// A connected part of a body.
struct Part<'a> {
    body: &'a Placed<'a>,
    /// Of how many parts the body has, counted from 1.
    number: usize,
    count: usize,
}

/// Refuses static systems whose bodies can move freely.
pub fn check(draft: &mut Draft) {
    let mut warnings = Vec::new();
    for system in 0..draft.systems.len() {
        if !draft.systems[system].stepper.has_inertia() {
            check_system(draft, system, &mut warnings);
        }
    }
    draft.warnings.extend(warnings);
}

fn check_system(draft: &Draft, system: usize, warnings: &mut Vec<String>) {
    let (parts, part_of_row) = parts_of(draft, system);
    if parts.is_empty() {
        // masses without a link: nothing hangs together
        return;
    }
    let joints = joints_of(draft, system);
    for group in groups(parts.len(), &part_of_row, &joints) {
        if group.len() > MOST_PARTS {
            continue;
        }
        let free = free_motions(draft, system, &group, &part_of_row, &joints);
        if free.count == 0 {
            continue;
        }
        let names: Vec<String> = group.iter().map(|part| parts[*part].name()).collect();
        let what = names.join(" and ");
        let body = parts[group[0]].body.spec;
        let message = format!(
            "{what} can move freely: {} of {} rigid motions are held by nothing, {} shifts and {} turns among \
             them, and a static system finds no equilibrium then",
            free.count,
            free.total,
            free.shifts,
            free.count - free.shifts,
        );
        let may_touch = |part: &usize| {
            let name = &parts[*part].body.spec.name;
            let is_of = |contact: &crate::spec::contact::Contact| {
                contact.body == *name
                    || contact.against == Some(crate::spec::contact::Against::Body(name.clone()))
            };
            draft.spec.contacts.iter().any(is_of)
        };
        if group.iter().any(may_touch) {
            warnings.push(format!(
                "{}: {message}, unless a contact holds it once it touches",
                draft.place(&body.site)
            ));
        } else {
            let expected = "pins, springs or attachments that hold it, or a stepper with inertia";
            draft.log.add(Code::Conflict, &body.site, message, expected);
        }
    }
}

impl Part<'_> {
    fn name(&self) -> String {
        match self.count {
            1 => format!("body `{}`", self.body.spec.name),
            count => format!("part {} of {count} of body `{}`", self.number, self.body.spec.name),
        }
    }
}

/// The connected parts of all bodies of a system, and the part of each row.
fn parts_of<'a>(draft: &'a Draft, system: usize) -> (Vec<Part<'a>>, Vec<usize>) {
    let mut parts = Vec::new();
    let mut part_of_row = vec![0; draft.systems[system].kinematics.row_count()];
    for body in draft.bodies.iter().filter(|body| body.system == system) {
        let first = parts.len();
        let (part_of_cell, count) = body.mesh.components();
        parts.extend((1..=count).map(|number| Part { body, number, count }));
        for (cell, part) in body.mesh.cells().zip(part_of_cell) {
            for node in cell.nodes {
                part_of_row[body.rows.start + *node as usize] = first + part as usize;
            }
        }
    }
    (parts, part_of_row)
}

/// Everything that hinders rows of a system.
fn joints_of(draft: &Draft, system: usize) -> Vec<Joint> {
    let mut joints: Vec<Joint> =
        draft.joints.iter().filter(|joint| joint.system == system).cloned().collect();
    let kinematics = &draft.systems[system].kinematics;
    for constraint in &draft.systems[system].constraints {
        let Some(row) = kinematics.point_block_row(constraint.block) else { continue };
        // of frames that are led, the points that they reach are the joints
        let mut bodies = draft.bodies.iter().filter(|body| body.system == system);
        let Some(row) = bodies.find_map(|body| Some(body.rows.start as u32 + body.point_of(row)?)) else {
            continue;
        };
        let held = constraint.constrained();
        let directions = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| held * axis);
        for direction in directions.into_iter().filter(|direction| *direction != Vec3::ZERO) {
            joints.push(Joint { system, ends: vec![(row, 1.0)], direction: Some(direction) });
        }
    }
    for body in draft.bodies.iter().filter(|body| body.system == system) {
        for spring in body.spec.springs.iter().filter(|spring| spring.stiffness > 0.0) {
            let Some(region) = &spring.region else { continue };
            let rows = draft.selector(body).points(region).into_iter().map(|p| body.rows.start as u32 + p);
            joints.extend(rows.map(|row| Joint { system, ends: vec![(row, 1.0)], direction: None }));
        }
        let place = |row: u32| body.mesh.points[row as usize - body.rows.start];
        let slopes = bending::of(draft, body).into_iter().flat_map(|bending| bending.clamps(place));
        joints.extend(slopes.map(|slope| {
            let direction = slope.normal.try_normalised();
            Joint { system, ends: slope.ends.to_vec(), direction }
        }));
    }
    joints
}

/// Parts that joints connect, each group ascending.
fn groups(part_count: usize, part_of_row: &[usize], joints: &[Joint]) -> Vec<Vec<usize>> {
    let mut joined = Sets::new(part_count);
    for joint in joints {
        for pair in joint.ends.windows(2) {
            let [a, b] = [pair[0].0, pair[1].0].map(|row| part_of_row[row as usize] as u32);
            joined.join(a, b);
        }
    }
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for part in 0..part_count {
        groups.entry(joined.of(part as u32)).or_default().push(part);
    }
    groups.into_values().collect()
}

/// How many independent motions of a group of parts are free, and how many of them are shifts of the whole group.
struct Free {
    count: usize,
    /// Motions that move a point.
    total: usize,
    shifts: usize,
}

fn free_motions(
    draft: &Draft,
    system: usize,
    group: &[usize],
    part_of_row: &[usize],
    joints: &[Joint],
) -> Free {
    let bodies = || draft.bodies.iter().filter(|body| body.system == system);
    let place = |row: usize| {
        let body = bodies().find(|body| body.rows.contains(&row));
        body.map_or(Vec3::ZERO, |body| body.mesh.points[row - body.rows.start])
    };
    // rows of frames belong to no mesh
    let is_of_body = |row: &usize| bodies().any(|body| body.rows.contains(row));
    let in_group = |row: &usize| group.binary_search(&part_of_row[*row]).is_ok();
    let rows = || (0..part_of_row.len()).filter(in_group).filter(is_of_body);
    // lengths relative to the group's size about its middle, so that shifts and turns weigh alike
    let bounds = souple_mesh::BoundingBox::of(rows().map(place));
    let (centre, size) = (bounds.centre(), bounds.diagonal());
    let count = 6 * group.len();
    let arm_of = |row: usize| (place(row) - centre) / size;
    let mut moved = vec![[0.0; 36]; group.len()];
    for row in rows() {
        let part = group.binary_search(&part_of_row[row]).unwrap_or(0);
        for direction in [Vec3::X, Vec3::Y, Vec3::Z] {
            let condition =
                [direction, arm_of(row).cross(direction)].map(|vector| vector.to_array()).concat();
            moved[part]
                .iter_mut()
                .enumerate()
                .for_each(|(k, sum)| *sum += condition[k / 6] * condition[k % 6]);
        }
    }
    let total: usize = moved.iter_mut().map(|sum| rank(sum, 6)).sum();
    let mut sum = vec![0.0; count * count];
    for joint in joints {
        let belongs = |end: &(u32, f64)| group.binary_search(&part_of_row[end.0 as usize]).is_ok();
        if !joint.ends.iter().all(belongs) {
            continue;
        }
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let directions = joint.direction.as_ref().map_or(&axes[..], std::slice::from_ref);
        for direction in directions {
            // d · (t + ω × y) = d · t + (y × d) · ω
            let mut condition: Vec<(usize, f64)> = Vec::new();
            for &(row, weight) in &joint.ends {
                let part = group.binary_search(&part_of_row[row as usize]).unwrap_or(0);
                let numbers =
                    [*direction, arm_of(row as usize).cross(*direction)].map(|vector| vector * weight);
                for (k, number) in numbers.iter().flat_map(|vector| vector.to_array()).enumerate() {
                    condition.push((6 * part + k, number));
                }
            }
            for &(i, a) in &condition {
                for &(j, b) in &condition {
                    sum[i * count + j] += a * b;
                }
            }
        }
    }
    // t the same for all parts, ω zero
    let mut shifts = [[0.0; 3]; 3];
    for (i, row) in shifts.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            for a in 0..group.len() {
                for b in 0..group.len() {
                    *entry += sum[(6 * a + i) * count + 6 * b + j];
                }
            }
        }
    }
    let shifts = 3 - rank(&mut shifts.concat(), 3);
    Free { count: total - rank(&mut sum, count), total, shifts }
}

/// Rank of a symmetric positive semidefinite matrix, by elimination with the greatest diagonal entry as pivot.
fn rank(matrix: &mut [f64], n: usize) -> usize {
    let greatest = (0..n).map(|i| matrix[i * n + i]).fold(0.0, f64::max);
    let mut is_done = vec![false; n];
    for step in 0..n {
        let open = (0..n).filter(|i| !is_done[*i]);
        let pivot = open.max_by(|a, b| matrix[a * n + a].total_cmp(&matrix[b * n + b]));
        let Some(pivot) = pivot.filter(|pivot| matrix[pivot * n + pivot] > SINGULAR * greatest) else {
            return step;
        };
        is_done[pivot] = true;
        let diagonal = matrix[pivot * n + pivot];
        for i in (0..n).filter(|i| !is_done[*i]) {
            let factor = matrix[i * n + pivot] / diagonal;
            if factor != 0.0 {
                for j in 0..n {
                    matrix[i * n + j] -= factor * matrix[pivot * n + j];
                }
            }
        }
    }
    n
}

/// What a shape hinders where it touches a body's points at the start: motion along its normal, and every motion
/// where there is friction.
pub fn touching_joints(
    body: &Placed,
    points: &[ContactPoint],
    shape: &dyn Shape,
    motion: &RigidMotion,
    law: &souple_models::contact::ContactLaw,
) -> Vec<Joint> {
    let pose = motion.pose(0.0);
    let near = law.thickness + TOUCHING * body.mesh.bounds().diagonal();
    let joint = |point: &ContactPoint| {
        let nearest = shape.nearest(pose.to_shape(point.start), near)?;
        let direction = (law.friction == 0.0).then(|| pose.direction_to_world(nearest.normal));
        (nearest.distance <= near).then(|| Joint {
            system: body.system,
            ends: vec![(point.row, 1.0)],
            direction,
        })
    };
    points.iter().filter(|point| point.share > 0.0).filter_map(joint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Conditions at points of one part: three points off a line hold six motions, two leave the turn about their
    /// line, one leaves three turns; a plane that only carries leaves two shifts and a turn.
    #[test]
    fn ranks_of_holds() {
        let held = |points: &[Vec3], directions: &[Vec3]| {
            let mut sum = vec![0.0; 36];
            for (x, d) in points.iter().flat_map(|x| directions.iter().map(move |d| (x, d))) {
                let c = [d.to_array(), x.cross(*d).to_array()].concat();
                (0..36).for_each(|k| sum[k] += c[k / 6] * c[k % 6]);
            }
            rank(&mut sum, 6)
        };
        let all = [Vec3::X, Vec3::Y, Vec3::Z];
        assert_eq!(held(&[Vec3::ZERO, Vec3::X, Vec3::Y], &all), 6);
        assert_eq!(held(&[Vec3::ZERO, Vec3::X], &all), 5);
        assert_eq!(held(&[Vec3::X], &all), 3);
        assert_eq!(held(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[Vec3::Z]), 3);
        assert_eq!(rank(&mut [0.0; 36], 6), 0);
    }
}
