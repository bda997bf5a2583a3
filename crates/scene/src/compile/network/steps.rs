//! Whether the masses of networks bear the steps they are taken in.
//!
//! At a mass `2 Σ H` over interactions with free masses and `Σ H` over those with fixed ones must stay below `4 m/Te²`, by
//! Gershgorin's theorem on the Laplacian of the links, with `H = K + 2Z` of a spring and damper. Links are always there; those
//! that a mass meets in crowds are counted as in a dense heap.

use std::ops::Range;

use souple_engine::Force;
use souple_engine::stability::MARGIN;
use souple_engine::steppers::Stability;
use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_models::network::relations::Relation;
use souple_models::network::{Augmented, Constraints, Crowd, Keeping, Links};
use souple_table::four_digits;

use super::super::Draft;
use super::super::bodies::Placed;
use crate::spec::network::Network;

/// Balls of one size that touch one among them at once, by the axes that they move along.
const TOUCHING: [usize; 4] = [0, 2, 6, 12];

/// What one mass may meet in a crowd.
#[derive(Clone, Copy)]
struct Company {
    /// Number of the crowd among those of the body.
    crowd: usize,
    /// What each neighbour takes of the bound [N/m].
    load: f64,
    count: usize,
}

/// How a crowd is peopled.
struct Peopled<'a> {
    crowd: &'a Crowd,
    /// Of the first group and of the second: rows within the body, and how many of them are free and how many fixed.
    groups: [(Range<usize>, [usize; 2]); 2],
}

impl Peopled<'_> {
    /// Who else of the crowd a free mass may meet, free and fixed ones.
    fn others(&self, mass: usize) -> [usize; 2] {
        let [(first, in_first), (second, in_second)] = &self.groups;
        let met = match (first.contains(&mass), second.contains(&mass)) {
            (true, true) => {
                // groups are one, or share some
                let [free, fixed] = [0, 1].map(|kind| in_first[kind].max(in_second[kind]));
                return [free.saturating_sub(1), fixed];
            }
            (true, false) => in_second,
            (false, true) => in_first,
            (false, false) => return [0; 2],
        };
        *met
    }
}

/// Warns of masses whose links and possible neighbours are too stiff for an explicit step.
pub fn warn_of_steps(draft: &mut Draft) {
    let warnings: Vec<String> =
        draft.bodies.iter().filter_map(|body| of_body(draft, body, body.spec.network.as_ref()?)).collect();
    draft.warnings.extend(warnings);
    let growing: Vec<String> = draft.bodies.iter().flat_map(|body| growing(draft, body)).collect();
    draft.warnings.extend(growing);
}

/// Warns of augmented Lagrangians that nothing damps. What a relation is off by, `w = (J W Jᵀ)_cc` of its masses, moves as
/// `s³ + w z s² + w c s + w k = 0`, which is stable where `z c w > k`.
fn growing(draft: &Draft, body: &Placed) -> Vec<String> {
    let system = &draft.systems[body.system];
    let damps = |force: &dyn Force| force.declaration().velocity_terms && !force.as_any().is::<Constraints>();
    if system.forces.iter().any(|force| damps(force.as_ref())) {
        return Vec::new();
    }
    let places = body.mesh.points.iter().copied();
    let positions: Vec<Vec3> = std::iter::repeat_n(Vec3::ZERO, body.rows.start).chain(places).collect();
    let is_here = |row: &u32| body.rows.contains(&(*row as usize));
    let constraints = system.forces.iter().filter_map(|force| force.as_any().downcast_ref::<Constraints>());
    // what is pinned does not move
    let mut masses = system.mass.diagonal.clone();
    for pin in system.constraints.iter().filter(|pin| pin.free == Mat3::ZERO) {
        if let Some(row) = system.kinematics.row_of_block(pin.block) {
            masses[row as usize] = f64::INFINITY;
        }
    }
    let mut warnings = Vec::new();
    for constraints in constraints {
        let Keeping::Augmented(Augmented { stiffness, damping, rate }) = constraints.keeping() else {
            continue;
        };
        if rate == 0.0 || !constraints.relations().iter().all(|it| it.rows().iter().all(is_here)) {
            continue;
        }
        let slopes = constraints.relations().iter().filter_map(|it| slowest(&**it, &masses, &positions));
        let least = slopes.fold(f64::INFINITY, f64::min);
        let wanted = rate / (stiffness * least);
        if least.is_finite() && damping <= wanted {
            let name = constraints.name();
            let place = draft.place(&body.spec.site);
            let cure = if stiffness > 0.0 {
                format!("a `damping` above {wanted:.3e}")
            } else {
                "a `stiffness`, and a `damping`".to_owned()
            };
            warnings.push(format!(
                "{place}: the augmented Lagrangian `{name}` grows where nothing else damps its masses: {cure} would hold it, or a lower `rate`"
            ));
        }
    }
    warnings
}

/// The least `J M⁻¹ Jᵀ` of the components of a relation that masses change.
fn slowest(relation: &dyn Relation, masses: &[f64], positions: &[Vec3]) -> Option<f64> {
    let mut gradients = Vec::new();
    relation.add_gradients(positions, 0.0, &mut gradients);
    let of = |component: usize| -> f64 {
        let rows = relation.rows().iter().zip(&gradients);
        rows.map(|(row, gradient)| gradient.row(component).length_sq() / masses[*row as usize]).sum()
    };
    [0, 1, 2].map(of).into_iter().filter(|slope| *slope > 0.0).reduce(f64::min)
}

/// The mass of a network that bears its steps least, where it may not bear them.
struct Worst<'a> {
    mass: usize,
    /// Of what a step bears, above 1.
    share: f64,
    /// [s]
    timestep: f64,
    is_linked: bool,
    /// Neighbours that it may meet, by crowds.
    met: Vec<(usize, &'a str)>,
}

/// A step that masses bear whatever their links and crowds come to [s]; `None` where they bear those that they are taken in.
///
/// It is told with the margin that the longest step at rest is, and so is never above that. What a step takes of the bound grows between as
/// `h`, of dampers, and as `h²`, of springs: by the former it is on the safe side, and the farther below the longest the longer the step is
/// that is tried.
pub fn safe_step(draft: &Draft, body: &Placed, network: &Network) -> Option<f64> {
    worst(draft, body, network).map(|worst| worst.safe_step())
}

impl Worst<'_> {
    fn safe_step(&self) -> f64 {
        MARGIN * self.timestep / self.share
    }
}

fn of_body(draft: &Draft, body: &Placed, network: &Network) -> Option<String> {
    let worst = worst(draft, body, network)?;
    let safe = worst.safe_step();
    let Worst { mass, share, timestep, is_linked, met } = worst;
    let met: Vec<String> = met.iter().map(|(count, crowd)| format!("{count} in crowd `{crowd}`")).collect();
    let whose = match (is_linked, met.is_empty()) {
        (_, true) => "of the links".to_owned(),
        (true, false) => {
            format!("of the links, and of neighbours as in a dense heap, {},", met.join(" and "))
        }
        (false, false) => format!("of neighbours as in a dense heap, {},", met.join(" and ")),
    };
    Some(format!(
        "{}: K + 2Z {whose} at mass {mass} of network `{}` is {} of what a step of {timestep} s bears: \
         the network may be unstable; a step of {safe:.3e} s is safe whatever states they are in, and a longer one may be, \
         as is told when that is tried",
        draft.place(&body.spec.site),
        body.spec.name,
        four_digits(share),
    ))
}

fn worst<'a>(draft: &'a Draft, body: &Placed, network: &Network) -> Option<Worst<'a>> {
    let system = &draft.systems[body.system];
    if !matches!(system.stepper.stability(), Stability::Limited(_)) {
        return None;
    }
    let spec = &draft.spec.systems[body.system];
    let timestep = system.stepper.interval(draft.spec.world.period / f64::from(spec.steps_per_period));
    let is_fixed: Vec<bool> = network.of_each(|group| group.is_fixed).collect();
    let mut loads = of_links(draft, body, &is_fixed);
    add_constraints(draft, body, timestep, &mut loads);
    let crowds = crowds_of(draft, body, &is_fixed);
    let most = TOUCHING[free_axes(draft, body, network)];
    let places = places(body, &crowds, most);
    let mut company = Vec::new();
    let mut worst: Option<(usize, f64)> = None;
    for (mass, load) in loads.iter().enumerate().filter(|(mass, _)| !is_fixed[*mass]) {
        meet(&crowds, mass, places[mass], &mut company);
        let met: f64 = company.iter().map(|one| one.count as f64 * one.load).sum();
        let bound = 4.0 * system.mass.diagonal[body.rows.start + mass] / (timestep * timestep);
        let share = (load + met) / bound;
        if worst.is_none_or(|(_, known)| share > known) {
            worst = Some((mass, share));
        }
    }
    let (mass, share) = worst.filter(|(_, share)| *share > 1.0)?;
    meet(&crowds, mass, places[mass], &mut company);
    let met = crowds.iter().enumerate().map(|(index, peopled)| {
        let of_crowd = company.iter().filter(|one| one.crowd == index);
        (of_crowd.map(|one| one.count).sum(), peopled.crowd.name())
    });
    let met = met.filter(|(count, _)| *count > 0).collect();
    Some(Worst { mass, share, timestep, is_linked: loads[mass] > 0.0, met })
}

/// What links take of the bound at each mass [N/m].
fn of_links(draft: &Draft, body: &Placed, is_fixed: &[bool]) -> Vec<f64> {
    let mut loads = vec![0.0; body.mesh.points.len()];
    for (index, links) in body.links.iter().enumerate() {
        let name = format!("{}.links[{index}]", body.spec.name);
        let force = draft.systems[body.system].forces.iter().find(|force| force.name() == name);
        let Some(law) = force.and_then(|force| force.as_any().downcast_ref::<Links>()) else { continue };
        for [a, b] in links.ends.iter().map(|ends| ends.map(|end| end as usize)) {
            loads[a] += law.stiffest() * if is_fixed[b] { 1.0 } else { 2.0 };
            loads[b] += law.stiffest() * if is_fixed[a] { 1.0 } else { 2.0 };
        }
    }
    loads
}

/// Adds what constraints of augmented Lagrangians take of the bound at each mass [N/m]; those that are kept exactly take none.
fn add_constraints(draft: &Draft, body: &Placed, timestep: f64, loads: &mut [f64]) {
    let places = body.mesh.points.iter().copied();
    let positions: Vec<Vec3> = std::iter::repeat_n(Vec3::ZERO, body.rows.start).chain(places).collect();
    let forces = draft.systems[body.system].forces.iter();
    for constraints in forces.filter_map(|force| force.as_any().downcast_ref::<Constraints>()) {
        let is_here = |row: &u32| body.rows.contains(&(*row as usize));
        if constraints.relations().iter().all(|relation| relation.rows().iter().all(is_here)) {
            constraints.visit_loads(&positions, timestep, &mut |row, load| {
                loads[row as usize - body.rows.start] += load;
            });
        }
    }
}

fn crowds_of<'a>(draft: &'a Draft, body: &Placed, is_fixed: &[bool]) -> Vec<Peopled<'a>> {
    let peopled = |rows: Range<u32>| {
        let own = rows.start as usize - body.rows.start..rows.end as usize - body.rows.start;
        let fixed = is_fixed[own.clone()].iter().filter(|is_fixed| **is_fixed).count();
        let free = own.len() - fixed;
        (own, [free, fixed])
    };
    let forces = draft.systems[body.system].forces.iter();
    forces
        .filter_map(|force| force.as_any().downcast_ref::<Crowd>())
        .filter(|crowd| {
            let is_here = |rows: &Range<u32>| {
                body.rows.start <= rows.start as usize && rows.end as usize <= body.rows.end
            };
            crowd.rows().iter().all(is_here)
        })
        .map(|crowd| Peopled { crowd, groups: crowd.rows().map(peopled) })
        .collect()
}

/// Puts `most` neighbours around a mass, the stiffest of those that there are.
fn meet(crowds: &[Peopled], mass: usize, most: usize, company: &mut Vec<Company>) {
    company.clear();
    for (index, peopled) in crowds.iter().enumerate() {
        let [free, fixed] = peopled.others(mass);
        let stiffest = peopled.crowd.stiffest();
        company.push(Company { crowd: index, load: 2.0 * stiffest, count: free });
        company.push(Company { crowd: index, load: stiffest, count: fixed });
    }
    company.sort_by(|a, b| b.load.total_cmp(&a.load));
    let mut room = most;
    for one in company {
        one.count = one.count.min(room);
        room -= one.count;
    }
}

/// Neighbours that find a place around each mass, of `most` in all: those that it is linked to are there already, but for the
/// quarter that a flat surface of close-packed balls leaves to others.
fn places(body: &Placed, crowds: &[Peopled], most: usize) -> Vec<usize> {
    let mut linked = vec![0; body.mesh.points.len()];
    // no ball fits between two that are nearer than twice its size
    let near = 2.0 * crowds.iter().map(|peopled| peopled.crowd.range()).fold(0.0, f64::max);
    for links in &body.links {
        let short = links.ends.iter().zip(&links.lengths).filter(|(_, length)| length.abs() < near);
        for end in short.flat_map(|(ends, _)| ends) {
            // points of view are behind the masses
            if let Some(count) = linked.get_mut(*end as usize) {
                *count += 1;
            }
        }
    }
    linked.into_iter().map(|linked| most.saturating_sub(linked).max(most.div_ceil(4))).collect()
}

/// Axes along which masses of a body may move: pins hold all of them along the others, or all lie in a plane that nothing drives
/// them out of.
fn free_axes(draft: &Draft, body: &Placed, network: &Network) -> usize {
    let system = &draft.systems[body.system];
    let mut held = vec![0_u8; body.rows.len()];
    for constraint in &system.constraints {
        let row = system.kinematics.row_of_block(constraint.block).map(|row| row as usize);
        let Some(row) = row.filter(|row| body.rows.contains(row)) else { continue };
        for axis in (0..3).filter(|axis| constraint.free * Vec3::AXES[*axis] == Vec3::ZERO) {
            held[row - body.rows.start] |= 1 << axis;
        }
    }
    let spec = body.spec;
    let is_left_alone = spec.loads.is_empty()
        && spec.start.is_none()
        && spec.angular_velocity == Vec3::ZERO
        && spec.pins.iter().all(|pin| pin.motion.is_none() && pin.bone.is_none())
        && draft.spec.contacts.is_empty()
        && draft.spec.attachments.is_empty()
        && draft.spec.couplings.is_empty()
        && draft.spec.hands.is_empty();
    let is_plane = |axis: usize| {
        let place = body.mesh.points.first().map_or(0.0, |point| point[axis]);
        is_left_alone
            && draft.spec.world.gravity.as_ref().is_none_or(|gravity| is_nothing(&gravity[axis]))
            && spec.velocity[axis] == 0.0
            && network.masses.iter().all(|group| group.velocity[axis] == 0.0)
            && body.mesh.points.iter().all(|point| point[axis] == place)
    };
    let is_free = |axis: &usize| held.iter().any(|held| held & (1 << axis) == 0) && !is_plane(*axis);
    (0..3).filter(is_free).count()
}

/// Whether a formula is zero whatever its variables are.
fn is_nothing(formula: &Formula) -> bool {
    let count = formula.variables().len();
    let is_constant = !(0..count).any(|variable| formula.depends_on(variable));
    is_constant && formula.evaluate(&vec![0.0; count]) == 0.0
}
