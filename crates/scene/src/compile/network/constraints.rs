//! Constraints of networks become relations between rows.

use std::sync::Arc;

use souple_engine::{Force, Motion};
use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_models::loads::{FormulaVector, RigidMotion};
use souple_models::network::relations::{
    Acceleration, Angle, Area, Direction, Guide, Joint, Relation, Rod, Surface, Volume,
};
use souple_models::network::{
    Constraints, Keeping, Parting, Polyhedra, RigidBalls, RigidBallsDescription, Sense, Sided,
    SidedConstraints,
};

use super::super::bodies::Placed;
use super::super::{Draft, memory, motion, start};
use super::{ends, faces, rigid};
use crate::diagnostic::{Code, Log};
use crate::spec::boundary::MotionSpec;
use crate::spec::network::{ConstraintKind, ConstraintSpec, Guided, Join, Network};

/// Of what a relation changes by when its masses move by their greatest coordinate: what is off by more at the start does not hold.
pub(super) const HOLDS: f64 = 1e-9;

/// A constraint that is being made.
pub(super) struct Making<'a> {
    pub draft: &'a Draft<'a>,
    pub body: &'a Placed<'a>,
    pub network: &'a Network,
    pub spec: &'a ConstraintSpec,
}

/// What a constraint became.
pub enum Made {
    /// It holds from both sides.
    Kept(Constraints),
    Sided(SidedConstraints),
    Balls(RigidBalls),
    Faces(Polyhedra),
}

impl Made {
    pub fn into_force(self) -> Box<dyn Force> {
        match self {
            Self::Kept(constraints) => Box::new(constraints),
            Self::Sided(constraints) => Box::new(Parting(constraints)),
            Self::Balls(balls) => Box::new(Parting(balls)),
            Self::Faces(faces) => Box::new(Parting(faces)),
        }
    }

    fn kept(&self) -> Option<&Constraints> {
        match self {
            Self::Kept(constraints) => Some(constraints),
            Self::Sided(_) | Self::Balls(_) | Self::Faces(_) => None,
        }
    }
}

/// The force of a constraint of this number; `None` where it was refused.
pub fn of(draft: &Draft, (body, network): (&Placed, &Network), timestep: f64, index: usize) -> Option<Made> {
    let spec = &network.constraints[index];
    let making = Making { draft, body, network, spec };
    let name = spec.force_name(&body.spec.name, index);
    let kind = spec.kind.as_ref()?;
    if let ConstraintKind::Balls(diameter) = kind {
        return making.balls(name, *diameter, timestep).map(Made::Balls);
    }
    if let ConstraintKind::Faces(tables) = kind {
        return making.faces(name, tables, timestep).map(Made::Faces);
    }
    let relations = making.relations(kind)?;
    if let Some(sense) = spec.sense {
        let sided = Sided { sense, radius: spec.radius, law: spec.law };
        let constraints = SidedConstraints::new(name, relations, sided);
        making.check_sides(&constraints)?;
        let constraints = match kind {
            ConstraintKind::Plane(Guided { place: Some(place), motion }, normal) => {
                let motion = motion::motion(draft.log, motion.as_ref(), &spec.kind_site)?;
                constraints.drawn_as_plane(*place, *normal, motion)
            }
            _ => constraints,
        };
        return Some(Made::Sided(constraints));
    }
    let exact = match spec.yields_at {
        Some(limit) => Keeping::Yielding { limit },
        None => Keeping::Exact { time: spec.time },
    };
    let keeping = spec.augmented.map_or(exact, Keeping::Augmented);
    let constraints = Constraints::new(name, relations, keeping);
    making.check_start(&constraints, keeping)?;
    Some(Made::Kept(constraints))
}

/// Refuses constraints which are kept exactly and share masses so often that memory does not hold the matrix of their forces.
pub fn check_size(network: &Network, body: &Placed, constraints: &[Made], log: &Log) {
    let mut shared = vec![0_u64; body.mesh.points.len()];
    let exact = constraints.iter().filter_map(Made::kept).filter(|it| it.constraint_set().is_some());
    let rows = exact.flat_map(|it| it.relations().iter().flat_map(|relation| relation.rows()));
    for row in rows {
        shared[*row as usize - body.rows.start] += 1;
    }
    let products = shared.iter().fold(0_u64, |sum, count| sum.saturating_add(count.saturating_mul(*count)));
    let most = memory::links_that_fit() as u64;
    let Some(site) = network.constraints.first().map(|spec| &spec.site) else { return };
    if products > most {
        let (mass, count) = shared
            .iter()
            .enumerate()
            .fold((0, 0), |worst, (mass, count)| if *count > worst.1 { (mass, *count) } else { worst });
        let message = format!(
            "constraints that share masses are {products} pairs, and memory holds no more than {most}; mass {mass} is in {count} of them"
        );
        log.add(Code::TooLarge, site, message, "fewer constraints of each mass, or `augmented`");
    }
}

/// The ends of all rods and strings that are drawn, in the order of constraints: no rods within bodies that are drawn by their faces. `None` where some
/// were refused.
pub fn rods(network: &Network, points: &[Vec3], draft: &Draft) -> Option<Vec<[u32; 2]>> {
    let mut drawn = Vec::new();
    for spec in network.constraints.iter().filter(|spec| spec.sense != Some(Sense::AtLeast)) {
        let mut rods = match &spec.kind {
            Some(ConstraintKind::Rod(join, _)) => {
                let of = (join, &spec.of[..], &spec.kind_site, "constraint");
                ends::joined(of, network, points, memory::links_that_fit(), draft.log)?
            }
            Some(ConstraintKind::Rigid) => {
                rigid_groups(spec, network, points).flat_map(|(_, rods)| rods.unwrap_or_default()).collect()
            }
            _ => continue,
        };
        rods.retain(|ends| spec.is_sided() || !faces::hide(network, *ends));
        drawn.extend(rods);
    }
    let masses = points.len() as u32;
    drawn.retain(|ends| ends.iter().all(|end| *end < masses));
    Some(drawn)
}

/// Each group that is a rigid body, by its name, with its rods; `None` where rods do not hold it.
pub(super) fn rigid_groups<'a>(
    spec: &'a ConstraintSpec,
    network: &Network,
    points: &[Vec3],
) -> impl Iterator<Item = (&'a str, Option<Vec<[u32; 2]>>)> {
    let all = spec.of.is_empty().then(|| ("all masses", 0..network.mass_count() as u32));
    let named = spec.of.iter().filter_map(|name| Some((name.as_str(), network.numbers_of(name)?)));
    all.into_iter().chain(named).map(|(name, masses)| {
        let rods = rigid::rods(&points[masses.start as usize..masses.end as usize]);
        let of_network =
            |rods: Vec<[u32; 2]>| rods.into_iter().map(|ends| ends.map(|end| masses.start + end)).collect();
        (name, rods.map(of_network))
    })
}

impl Making<'_> {
    pub(super) fn refuse<T>(&self, code: Code, message: String, expected: &str) -> Option<T> {
        self.draft.log.add(code, &self.spec.kind_site, message, expected);
        None
    }

    pub(super) fn row(&self, mass: u32) -> u32 {
        self.body.rows.start as u32 + mass
    }

    fn place(&self, mass: u32) -> Vec3 {
        self.body.mesh.points[mass as usize]
    }

    fn relations(&self, kind: &ConstraintKind) -> Option<Vec<Box<dyn Relation>>> {
        match kind {
            ConstraintKind::Rod(join, length) => {
                let rod = |[a, b]: [u32; 2]| {
                    let length = length.unwrap_or_else(|| (self.place(a) - self.place(b)).length());
                    if length > 0.0 {
                        return Some(Rod { ends: [self.row(a), self.row(b)], length });
                    }
                    let message = format!("masses {a} and {b} rest at one place, and a rod has a length");
                    self.refuse(Code::Conflict, message, "masses that are apart, a `length`, or a `joint`")
                };
                self.of_pairs(join, rod)
            }
            ConstraintKind::Joint(join) => {
                self.of_pairs(join, |[a, b]| Some(Joint { ends: [self.row(a), self.row(b)] }))
            }
            ConstraintKind::Direction(join, along, rotation) => {
                self.directions(join, *along, rotation.as_ref())
            }
            ConstraintKind::Angle(corners, angle, axis) => self.angles(corners, angle.as_ref(), *axis),
            ConstraintKind::Nail(guided) => self.guided(guided, |row, place| Some(Guide::nail(row, place))),
            ConstraintKind::Line(guided, direction) => {
                self.guided(guided, |row, place| Guide::line(row, place, *direction))
            }
            ConstraintKind::Plane(guided, normal) => {
                self.guided(guided, |row, place| Guide::plane(row, place, *normal))
            }
            ConstraintKind::Surface(zeros) => {
                let zeros: Arc<[Formula]> = zeros.as_slice().into();
                self.of_each(|mass| Some(Surface { row: [self.row(mass)], zeros: Arc::clone(&zeros) }))
            }
            ConstraintKind::Acceleration(formulas, axes) => {
                let value = Arc::new(FormulaVector::from_components(formulas.clone()));
                let axes = Vec3::from_array(axes.map(|is_told| if is_told { 1.0 } else { 0.0 }));
                self.of_each(|mass| {
                    let (row, start) = ([self.row(mass)], self.place(mass));
                    Some(Acceleration { row, axes, start, value: Arc::clone(&value) })
                })
            }
            ConstraintKind::Area(normal, part) => self.area(*normal, part),
            ConstraintKind::Volume(triangles, part) => self.volume(triangles, part),
            ConstraintKind::Rigid => self.rigid(),
            ConstraintKind::Balls(_) | ConstraintKind::Faces(_) => None,
        }
    }

    /// Rods that make rigid bodies of groups.
    fn rigid(&self) -> Option<Vec<Box<dyn Relation>>> {
        let mut relations: Vec<Box<dyn Relation>> = Vec::new();
        for (name, rods) in rigid_groups(self.spec, self.network, &self.body.mesh.points) {
            let Some(rods) = rods else {
                let message = format!(
                    "the masses of `{name}` rest in one plane or line, and rods do not hold what leaves it"
                );
                return self.refuse(
                    Code::Conflict,
                    message,
                    "masses that are not in one plane, or no more than three",
                );
            };
            for [a, b] in rods {
                let length = (self.place(a) - self.place(b)).length();
                if length == 0.0 {
                    let message = format!("masses {a} and {b} of `{name}` rest at one place");
                    return self.refuse(Code::Conflict, message, "masses that are apart");
                }
                relations.push(Box::new(Rod { ends: [self.row(a), self.row(b)], length }));
            }
        }
        if relations.is_empty() {
            let message = "one mass alone is held by nothing".to_owned();
            return self.refuse(Code::EmptyRegion, message, "groups of at least two masses");
        }
        Some(relations)
    }

    /// Balls that keep out of each other, but for those that rods and joints hold.
    fn balls(&self, name: String, diameter: f64, timestep: f64) -> Option<RigidBalls> {
        let (points, most) = (&self.body.mesh.points, memory::links_that_fit());
        let all = 0..points.len() as u32;
        let (first, second) = match &self.spec.of[..] {
            [] => (all.clone(), all),
            _ => ends::groups(&self.spec.of, self.network)?,
        };
        if first != second && first.start.max(second.start) < first.end.min(second.end) {
            let [one, other] = [&self.spec.of[0], &self.spec.of[1]];
            let (shared, last) = (first.start.max(second.start), first.end.min(second.end) - 1);
            let message = format!(
                "masses {shared} to {last} are in `{one}` and in `{other}`, and no ball meets itself"
            );
            return self.refuse(Code::Conflict, message, "groups that share no masses, or one group");
        }
        let mut held = Vec::new();
        for spec in self.network.constraints.iter().filter(|spec| {
            // what may give way does not keep balls apart
            !spec.is_sided() && spec.augmented.is_none() && spec.yields_at.is_none()
        }) {
            if let Some(ConstraintKind::Rod(join, _) | ConstraintKind::Joint(join)) = &spec.kind {
                let of = (join, &spec.of[..], &spec.kind_site, "constraint");
                held.extend(ends::joined(of, self.network, points, most, self.draft.log)?);
            }
            if let Some(ConstraintKind::Rigid) = spec.kind {
                let groups = rigid_groups(spec, self.network, points);
                held.extend(groups.flat_map(|(_, rods)| rods.unwrap_or_default()));
            }
        }
        held.iter_mut().for_each(|ends| ends.sort_unstable());
        held.sort_unstable();
        held.dedup();
        let places = start::places(self.body.spec.start.as_ref(), points);
        let reach = diameter * (1.0 - HOLDS);
        let Some(near) = ends::near(&places, first.clone(), second.clone(), reach, most) else {
            let message = format!("more than {most} pairs of balls begin within each other");
            return self.refuse(Code::TooLarge, message, "balls that begin apart");
        };
        let apart = |[a, b]: [u32; 2]| (places[a as usize] - places[b as usize]).length();
        let entered = near.into_iter().find(|[a, b]| held.binary_search(&[*a.min(b), *a.max(b)]).is_err());
        if let Some([a, b]) = entered.filter(|ends| apart(*ends) < reach) {
            let message =
                format!("masses {a} and {b} begin {} m apart, within balls of {diameter} m", apart([a, b]));
            return self.refuse(Code::Conflict, message, "balls that begin apart, or a smaller `diameter`");
        }
        let rows = |range: std::ops::Range<u32>| self.row(range.start)..self.row(range.end);
        let held = held.into_iter().map(|ends| ends.map(|end| self.row(end))).collect();
        let (first, second) = (rows(first), rows(second));
        Some(RigidBalls::new(RigidBallsDescription {
            name,
            first,
            second,
            diameter,
            law: self.spec.law,
            held,
            timestep,
            detection: self.draft.spec.world.detection,
        }))
    }

    /// What holds from one side does so at the start.
    fn check_sides(&self, constraints: &SidedConstraints) -> Option<()> {
        let points = start::places(self.body.spec.start.as_ref(), &self.body.mesh.points);
        let scale =
            points.iter().flat_map(|point| point.to_array()).fold(0.0_f64, |most, x| most.max(x.abs()));
        let positions = self.rows_at(&points);
        for (index, relation) in constraints.relations().iter().enumerate() {
            let gap = constraints.gap_of(index, &positions, 0.0);
            let slope = relation.slope(&positions, 0.0).unwrap_or(Vec3::ZERO);
            if !(gap.is_finite() && slope.is_finite()) {
                let message = format!("at the start there is no value of {}", relation.describe());
                return self.refuse(Code::NotFinite, message, "formulas that have one where masses start");
            }
            let mass = relation.rows()[0] as usize - self.body.rows.start;
            if -gap > HOLDS * (slope.length() * scale + relation.magnitude(&positions, 0.0).x) {
                let message = format!("mass {mass} begins {:.3e} beyond {}", -gap, relation.describe());
                return self.refuse(Code::Conflict, message, "masses that begin where it holds");
            }
        }
        Some(())
    }

    fn of_pairs<R: Relation + 'static>(
        &self,
        join: &Join,
        relation: impl Fn([u32; 2]) -> Option<R>,
    ) -> Option<Vec<Box<dyn Relation>>> {
        let (points, most) = (&self.body.mesh.points, memory::links_that_fit());
        let of = (join, &self.spec.of[..], &self.spec.kind_site, "constraint");
        let pairs = ends::joined(of, self.network, points, most, self.draft.log)?;
        let masses = points.len() as u32;
        if pairs.iter().flatten().any(|end| *end >= masses) {
            let message = "constraints are between masses, and points of view are none".to_owned();
            return self.refuse(Code::Conflict, message, "groups, parts or ports");
        }
        pairs.into_iter().map(|pair| relation(pair).map(|relation| Box::new(relation) as _)).collect()
    }

    /// Masses of the groups, in the order of these; `None` where there are none.
    fn masses(&self) -> Option<Vec<u32>> {
        let all = self.body.mesh.points.len() as u32;
        let masses: Vec<u32> = match &self.spec.of[..] {
            [] => (0..all).collect(),
            names => {
                let groups = names.iter().filter_map(|name| self.network.numbers_of(name));
                groups.flatten().filter(|mass| *mass < all).collect()
            }
        };
        if masses.is_empty() {
            return self.refuse(
                Code::EmptyRegion,
                "no masses are constrained".to_owned(),
                "groups that have masses",
            );
        }
        Some(masses)
    }

    fn of_each<R: Relation + 'static>(
        &self,
        relation: impl Fn(u32) -> Option<R>,
    ) -> Option<Vec<Box<dyn Relation>>> {
        self.masses()?
            .into_iter()
            .map(|mass| relation(mass).map(|relation| Box::new(relation) as _))
            .collect()
    }

    fn guided(
        &self,
        guided: &Guided,
        guide: impl Fn(u32, Vec3) -> Option<Guide>,
    ) -> Option<Vec<Box<dyn Relation>>> {
        let motion: Option<Arc<dyn Motion>> =
            motion::motion(self.draft.log, guided.motion.as_ref(), &self.spec.kind_site)?;
        self.of_each(|mass| {
            let place = guided.place.unwrap_or_else(|| self.place(mass));
            Some(Guide { motion: motion.clone(), ..guide(self.row(mass), place)? })
        })
    }

    fn directions(
        &self,
        join: &Join,
        along: Option<Vec3>,
        rotation: Option<&MotionSpec>,
    ) -> Option<Vec<Box<dyn Relation>>> {
        let rotation = motion::motion(self.draft.log, rotation, &self.spec.kind_site)?.map(|rotation| {
            Arc::new(RigidMotion { rotation: Some(rotation), ..RigidMotion::default() }) as Arc<dyn Motion>
        });
        let at_start = rotation.as_ref().map_or(Mat3::IDENTITY, |rotation| rotation.turn(0.0));
        let starts = start::places(self.body.spec.start.as_ref(), &self.body.mesh.points);
        self.of_pairs(join, |[a, b]| {
            let along = along.unwrap_or_else(|| self.place(b) - self.place(a));
            let ends = [self.row(a), self.row(b)];
            let Some(direction) = Direction::new(ends, along, rotation.clone()) else {
                let message = format!("masses {a} and {b} rest at one place, and point nowhere");
                return self.refuse(Code::Conflict, message, "masses that are apart, or `along`");
            };
            if (at_start * along).dot(starts[b as usize] - starts[a as usize]) <= 0.0 {
                let message = format!(
                    "from mass {a} to mass {b} it is not along the direction but against or across it at the start"
                );
                return self.refuse(Code::Conflict, message, "a direction less than a right angle away");
            }
            Some(direction)
        })
    }

    fn angles(
        &self,
        corners: &[[u32; 3]],
        angle: Option<&Formula>,
        axis: Option<Vec3>,
    ) -> Option<Vec<Box<dyn Relation>>> {
        let points = self.rows_at(&self.body.mesh.points);
        self.numbered(corners, "corners")?
            .into_iter()
            .map(|rows| {
                let mut relation = Angle { rows, axis, angle: Formula::constant(0.0) };
                if !relation.is_defined(&points) {
                    let masses = rows.map(|row| row as usize - self.body.rows.start);
                    let (message, expected) = match axis {
                        Some(_) => (
                            format!("a segment of the corner {masses:?} lies along the axis, about which it has no angle"),
                            "another `axis`, or masses off it",
                        ),
                        None => (
                            format!("the corner {masses:?} lies in one line, where no direction opens it"),
                            "an `axis`, or masses that are not in one line",
                        ),
                    };
                    return self.refuse(Code::Conflict, message, expected);
                }
                relation.angle = angle.cloned().unwrap_or_else(|| Formula::constant(relation.at(&points)));
                Some(Box::new(relation) as Box<dyn Relation>)
            })
            .collect()
    }

    /// The rows of masses that are told by their numbers within the groups.
    fn numbered(&self, triples: &[[u32; 3]], key: &str) -> Option<Vec<[u32; 3]>> {
        let masses = self.masses()?;
        let mut of_rows = Vec::with_capacity(triples.len());
        for (index, corners) in triples.iter().enumerate() {
            if let Some(wrong) = corners.iter().find(|corner| **corner as usize >= masses.len()) {
                let message = format!("{key}[{index}] is of mass {wrong}, and there are {}", masses.len());
                return self.refuse(Code::OutOfRange, message, &format!("numbers below {}", masses.len()));
            }
            of_rows.push(corners.map(|corner| self.row(masses[corner as usize])));
        }
        Some(of_rows)
    }

    fn area(&self, normal: Vec3, part: &Formula) -> Option<Vec<Box<dyn Relation>>> {
        let masses = self.masses()?;
        if masses.len() < 3 {
            let message = format!("a line through {} masses encloses nothing", masses.len());
            return self.refuse(Code::Conflict, message, "at least three masses");
        }
        let rows = masses.iter().map(|mass| self.row(*mass)).collect();
        let mut area = Area { rows, normal, area: 0.0, part: part.clone() };
        area.area = area.enclosed(&self.rows_at(&self.body.mesh.points));
        if area.area == 0.0 || !area.area.is_finite() {
            let message = format!("the masses enclose {} m² at rest, seen against the normal", area.area);
            return self.refuse(
                Code::Conflict,
                message,
                "another `normal`, or masses that enclose something",
            );
        }
        Some(vec![Box::new(area)])
    }

    fn volume(&self, triangles: &[[u32; 3]], part: &Formula) -> Option<Vec<Box<dyn Relation>>> {
        let of_rows = self.numbered(triangles, "triangles")?;
        let points = self.rows_at(&self.body.mesh.points);
        let volume = Volume::new(&of_rows, part.clone(), &points);
        let enclosed = volume.enclosed(&points);
        if !(enclosed > 0.0 && enclosed.is_finite()) {
            let message = format!("the triangles enclose {enclosed} m³ at rest");
            return self.refuse(
                Code::Conflict,
                message,
                "triangles that enclose something, counterclockwise seen from outside",
            );
        }
        Some(vec![Box::new(volume)])
    }

    /// Masses among the rows of their system.
    pub(super) fn rows_at(&self, masses: &[Vec3]) -> Vec<Vec3> {
        std::iter::repeat_n(Vec3::ZERO, self.body.rows.start).chain(masses.iter().copied()).collect()
    }

    /// What is kept at once, and exactly, holds at the start.
    fn check_start(&self, constraints: &Constraints, keeping: Keeping) -> Option<()> {
        let points = start::places(self.body.spec.start.as_ref(), &self.body.mesh.points);
        let scale =
            points.iter().flat_map(|point| point.to_array()).fold(0.0_f64, |most, x| most.max(x.abs()));
        let positions = self.rows_at(&points);
        let mut gradients = Vec::new();
        for relation in constraints.relations() {
            let value = relation.value(&positions, 0.0);
            gradients.clear();
            relation.add_gradients(&positions, 0.0, &mut gradients);
            let told = relation.second_rate(0.0);
            let magnitude = relation.magnitude(&positions, 0.0);
            let is_finite = value.is_finite() && told.is_none_or(Vec3::is_finite);
            if !(is_finite && gradients.iter().all(|gradient| gradient.is_finite())) {
                let message = format!("at the start there is no value of {}", relation.describe());
                return self.refuse(Code::NotFinite, message, "formulas that have one where masses start");
            }
            for component in 0..3 {
                let slope: f64 = gradients.iter().map(|gradient| gradient.row(component).length()).sum();
                let off = value[component].abs();
                if told.is_some() || off <= HOLDS * (slope * scale + magnitude[component]) {
                    continue;
                }
                if slope == 0.0 {
                    let message = format!(
                        "{} is off by {off:.3e} at the start, where no direction leads to it",
                        relation.describe()
                    );
                    return self.refuse(Code::Conflict, message, "masses that start elsewhere");
                }
                if matches!(keeping, Keeping::Exact { time: 0.0 } | Keeping::Yielding { .. }) {
                    let message = format!(
                        "{} is off by {off:.3e} at the start, and would be put right within a step",
                        relation.describe()
                    );
                    return self.refuse(
                        Code::Conflict,
                        message,
                        "masses that start where it holds, or a `time`",
                    );
                }
            }
        }
        Some(())
    }
}
