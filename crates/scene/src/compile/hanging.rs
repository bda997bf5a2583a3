//! Bodies whose points hang in part on others: attached points that touch a mesh are no unknowns but rows, `x = Σ w x_a` over the
//! nodes of the cell that carries them.
//!
//! A body of which some points hang has rows of its own for all its points, one after the other; those that do not hang stand
//! before among the unknowns, and their rows are these as they are.

use souple_engine::{DerivedRow, Feedback, Kinematics};
use souple_math::Vec3;
use souple_mesh::CellLocator;
use souple_table::counted;

use super::Draft;
use super::bodies::Placed;
use super::freedom::Joint;
use super::links::{self, Between, TOUCHING};
use crate::diagnostic::Code;
use crate::spec::interaction::{Holding, Link};

/// The unknowns of a body some of whose points hang: rows in the order of these points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnRows {
    /// Row of the first.
    first: u32,
    /// Ascending.
    points: Vec<u32>,
}

impl OwnRows {
    pub fn row_of(&self, point: u32) -> Option<u32> {
        self.points.binary_search(&point).ok().map(|place| self.first + place as u32)
    }

    pub fn point_of(&self, row: u32) -> Option<u32> {
        self.points.get(row.checked_sub(self.first)? as usize).copied()
    }

    pub fn rows(&self) -> std::ops::Range<u32> {
        self.first..self.first + self.points.len() as u32
    }

    pub fn points(&self) -> &[u32] {
        &self.points
    }
}

/// A point of a body and its weight.
#[derive(Clone, Copy, Debug)]
struct Carrier {
    /// Number of the body.
    body: usize,
    point: u32,
    weight: f64,
}

/// What points of a body hang on.
#[derive(Debug)]
pub struct Hanging {
    /// Of each point; nothing for those that are unknowns.
    carriers: Vec<Vec<Carrier>>,
    pub own: OwnRows,
    /// Bodies that carry it, by their numbers.
    on: Vec<usize>,
}

impl Hanging {
    fn new(count: usize) -> Self {
        Self { carriers: vec![Vec::new(); count], own: OwnRows::default(), on: Vec::new() }
    }

    pub fn give_rows(&mut self, first: usize) {
        self.own.first = first as u32;
    }
}

impl Placed<'_> {
    /// The row of the unknown that a point is; `None` where it hangs, or frames or modes carry it.
    pub fn own_row(&self, point: u32) -> Option<u32> {
        match &self.hanging {
            Some(hanging) => hanging.own.row_of(point),
            None => (!self.is_carried()).then_some(self.rows.start as u32 + point),
        }
    }

    /// The point that a row of an unknown is.
    pub fn point_of(&self, row: u32) -> Option<u32> {
        match &self.hanging {
            Some(hanging) => hanging.own.point_of(row),
            None => self.rows.contains(&(row as usize)).then(|| row - self.rows.start as u32),
        }
    }
}

/// Whether the points of a body may hang: they are its unknowns, and nothing else moves them.
fn may_hang(body: &Placed) -> bool {
    !body.is_carried() && body.levels.is_none() && body.spec.network.is_none() && body.mesh.cell_count() > 0
}

/// Whether points may hang on a body.
fn may_carry(body: &Placed) -> bool {
    body.levels.is_none() && body.mesh.cell_count() > 0
}

/// Finds which points hang on what.
pub fn place(draft: &mut Draft) {
    let mut all: Vec<Option<Hanging>> = draft.bodies.iter().map(|_| None).collect();
    for (_, link) in links::all(draft) {
        if link.hold == Some(Holding::Springs) {
            continue;
        }
        let Some([from, to]) = links::ends(draft, &link, Between::BodiesOfOneSystem) else { continue };
        let is_asked = link.hold == Some(Holding::Rows);
        if !(may_hang(from) && may_carry(to)) {
            if is_asked {
                let (who, why) = match may_hang(from) {
                    true => (&to.spec.name, "has several meshes, or no cells, and carries no rows"),
                    false => (&from.spec.name, "is no body of points alone, whose points could be rows"),
                };
                let message = format!("body `{who}` {why}");
                draft.log.add(Code::Conflict, &link.site, message, "`hold = \"springs\"`");
            }
            continue;
        }
        // frames are held by springs where nothing is said: a row would stand in the matrix of all that reach it
        if !is_asked && (to.is_carried() || link.has_spring()) {
            continue;
        }
        let number = |body: &Placed| draft.bodies.iter().position(|other| std::ptr::eq(other, body));
        let (Some(of), Some(on)) = (number(from), number(to)) else { continue };
        let Some(region) = &link.region else { continue };
        let points = draft.selector(from).points(region);
        let hanging = all[of].get_or_insert_with(|| Hanging::new(from.mesh.points.len()));
        hang(draft, &link, [from, to], on, &points, hanging);
    }
    for (body, hanging) in draft.bodies.iter_mut().zip(&mut all) {
        let Some(mut hanging) = hanging.take() else { continue };
        if hanging.on.is_empty() {
            continue;
        }
        let is_own = |point: &u32| hanging.carriers[*point as usize].is_empty();
        hanging.own.points = (0..body.mesh.points.len() as u32).filter(is_own).collect();
        body.hanging = Some(hanging);
    }
    refuse_circles(draft);
}

/// Hangs those points on a body that touch it.
fn hang(
    draft: &Draft,
    link: &Link,
    [from, to]: [&Placed; 2],
    on: usize,
    points: &[u32],
    hanging: &mut Hanging,
) {
    let locator = CellLocator::new(&to.mesh);
    let mut farthest = (0.0, 0);
    for &point in points {
        let position = from.mesh.points[point as usize];
        let Some(location) = locator.carrier(position).filter(|found| found.distance <= link.reach) else {
            continue;
        };
        let Some(cell) = to.mesh.cell(location.cell) else { continue };
        let weights = location.weights();
        let carriers: Vec<Carrier> = cell
            .nodes
            .iter()
            .zip(weights.iter())
            // what rounding leaves of a node across is none
            .filter(|(_, weight)| weight.abs() > TOUCHING)
            .map(|(node, weight)| Carrier { body: on, point: *node, weight: *weight })
            .collect();
        let carried: Vec3 =
            carriers.iter().map(|carrier| to.mesh.points[carrier.point as usize] * carrier.weight).sum();
        // a cell may carry what is outside of it, extrapolated
        let apart = location.distance.max((position - carried).length());
        if apart > links::touching(to, position) {
            farthest = if apart > farthest.0 { (apart, point) } else { farthest };
            continue;
        }
        let known = &mut hanging.carriers[point as usize];
        if known.iter().any(|carrier| carrier.body != on) {
            let message = format!(
                "point {} of body `{}` hangs on body `{}` already, and on `{}` besides",
                from.point_numbers[point as usize], link.from, draft.bodies[known[0].body].spec.name, link.to
            );
            draft.log.add(
                Code::Conflict,
                &link.site,
                message,
                "regions that share no points, or `hold = \"springs\"`",
            );
            return;
        }
        *known = carriers;
        if !hanging.on.contains(&on) {
            hanging.on.push(on);
        }
    }
    if link.hold == Some(Holding::Rows) && farthest.0 > 0.0 {
        let message = format!(
            "point {} of body `{}` is {:.3e} m away from body `{}`, and rows hold what touches",
            from.point_numbers[farthest.1 as usize], link.from, farthest.0, link.to
        );
        draft.log.add(
            Code::Conflict,
            &link.site,
            message,
            "points within the other body or on it, or `hold = \"springs\"`",
        );
    }
}

/// Bodies in an order in which each comes after those that it hangs on; those that wait for themselves are left out.
pub fn in_order(bodies: &[Placed], system: usize) -> Vec<usize> {
    let mut waiting: Vec<usize> = (0..bodies.len())
        .filter(|number| bodies[*number].system == system && bodies[*number].hanging.is_some())
        .collect();
    let mut order = Vec::new();
    loop {
        let is_ready = |number: &usize| {
            let hanging = bodies[*number].hanging.as_ref();
            hanging.is_some_and(|hanging| !hanging.on.iter().any(|on| waiting.contains(on)))
        };
        let (ready, rest): (Vec<usize>, Vec<usize>) = waiting.iter().copied().partition(is_ready);
        if ready.is_empty() {
            return order;
        }
        order.extend(ready);
        waiting = rest;
    }
}

/// Reports bodies that hang on each other.
fn refuse_circles(draft: &Draft) {
    for system in 0..draft.spec.systems.len() {
        let order = in_order(&draft.bodies, system);
        let hangs = |number: &usize| {
            draft.bodies[*number].system == system && draft.bodies[*number].hanging.is_some()
        };
        let Some(circle) = (0..draft.bodies.len()).filter(hangs).find(|number| !order.contains(number))
        else {
            continue;
        };
        let name = &draft.bodies[circle].spec.name;
        let Some((_, link)) = links::all(draft).into_iter().find(|(_, link)| link.from == *name) else {
            continue;
        };
        let message = format!("body `{name}` hangs on what hangs on it");
        draft.log.add(
            Code::Conflict,
            &link.site,
            message,
            "attachments that form no circle, or `hold = \"springs\"`",
        );
    }
}

/// Appends the rows of a body that hangs; those of what carries it are there.
pub fn add_rows(bodies: &[Placed], number: usize, kinematics: &mut Kinematics) {
    let Some(hanging) = &bodies[number].hanging else { return };
    for (point, carriers) in hanging.carriers.iter().enumerate() {
        let parents = match hanging.own.row_of(point as u32) {
            Some(row) => vec![(row, 1.0)],
            None => {
                let row = |carrier: &Carrier| bodies[carrier.body].rows.start as u32 + carrier.point;
                carriers.iter().map(|carrier| (row(carrier), carrier.weight)).collect()
            }
        };
        // weights are finite, and bodies come after those that they hang on
        let row = DerivedRow { parents, feedback: Feedback::Transpose };
        kinematics.add_derived_row(row).unwrap_or_else(|error| unreachable!("{error}"));
    }
}

/// What hanging hinders.
pub fn joints(draft: &Draft) -> Vec<Joint> {
    let mut joints = Vec::new();
    for body in &draft.bodies {
        let Some(hanging) = &body.hanging else { continue };
        for (point, carriers) in
            hanging.carriers.iter().enumerate().filter(|(_, carriers)| !carriers.is_empty())
        {
            let row = |carrier: &Carrier| draft.bodies[carrier.body].rows.start as u32 + carrier.point;
            let others = carriers.iter().map(|carrier| (row(carrier), -carrier.weight));
            let ends = [((body.rows.start + point) as u32, 1.0)].into_iter().chain(others).collect();
            joints.push(Joint { system: body.system, ends, direction: None });
        }
    }
    joints
}

/// Reports points that are held and hang; whether there are any.
pub fn refuse_held(draft: &Draft, body: &Placed, held: impl Iterator<Item = u32>) -> bool {
    let Some(hanging) = &body.hanging else { return false };
    let both: Vec<u32> = held.filter(|point| hanging.own.row_of(*point).is_none()).collect();
    let (Some(first), Some(pin)) = (both.first(), body.spec.pins.first()) else { return false };
    let on = hanging.carriers[*first as usize].first();
    let name = on.map_or("another", |carrier| draft.bodies[carrier.body].spec.name.as_str());
    let message = format!(
        "{} of body `{}` that {} pinned {} on body `{name}`, the first is point {}: rows go where what carries them goes",
        counted(both.len() as u64, "point"),
        body.spec.name,
        if both.len() == 1 { "is" } else { "are" },
        if both.len() == 1 { "hangs" } else { "hang" },
        body.point_numbers[*first as usize]
    );
    let expected =
        format!("a pin without these points, a pin of `{name}`, or an attachment with `hold = \"springs\"`");
    draft.log.add(Code::Conflict, &pin.site, message, &expected);
    true
}
