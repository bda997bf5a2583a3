//! Bodies with faces that keep out of each other: contacts of corners on faces, of edges that cross, and of balls on all of these.
//!
//! A body is masses, rigid by exact rods or soft by links, some of which are the corners of triangles. Where a corner is above a face the gap is `n·(p − q)`, `n` the normal of the
//! face and `q` on it; of two edges that cross it is that along the normal of both. Forces, impulses where bodies collide, are found by the step ([`souple_engine::unilateral`])
//! for all contacts at once, and go to the masses of a face or an edge as the barycentric coordinates of where it is touched tell, so that no momentum and no torque is made.
//!
//! Source: Baraff 1989 and 1991, with several contacts and Coulomb's friction.

mod entered;
mod features;
mod meeting;
mod search;

use souple_engine::{Configuration, Detection, ImpactLaw, Pair, Scratch, Sides, Unilateral};
use souple_math::Vec3;

use self::features::Features;
use self::meeting::Meets;
use self::search::Search;
use super::parting::Apart;

pub use self::entered::Entered;
pub use self::features::Polyhedron;

/// What bodies with faces are made of.
#[derive(Debug)]
pub struct PolyhedraDescription {
    pub name: String,
    pub bodies: Vec<Polyhedron>,
    pub law: ImpactLaw,
    /// Of the system [s].
    pub timestep: f64,
    /// When it is searched who is near.
    pub detection: Detection,
}

/// Bodies with faces that keep out of each other.
#[derive(Debug)]
pub struct Polyhedra {
    name: String,
    features: Features,
    law: ImpactLaw,
    timestep: f64,
    detection: Detection,
}

impl Polyhedra {
    /// Of bodies that rest at positions of rows.
    pub fn new(description: PolyhedraDescription, rest_positions: &[Vec3]) -> Self {
        let PolyhedraDescription { name, bodies, law, timestep, detection } = description;
        Self { name, features: Features::new(&bodies, rest_positions), law, timestep, detection }
    }

    /// Whether any two of the bodies meet: one has faces, and they share no corners.
    pub fn may_meet(&self) -> bool {
        let count = self.features.bodies.len();
        (0..count).any(|other| (0..other).any(|one| self.features.may_meet([one, other])))
    }

    fn meets(pair: &Pair) -> Meets {
        Meets::of([pair.a, pair.b])
            .unwrap_or_else(|| unreachable!("pairs are searched, or have been accepted"))
    }

    /// Of the ball, where one is touched [m].
    fn radius(&self, meets: Meets) -> f64 {
        match meets {
            Meets::Face { corner, .. } | Meets::Edge { corner, .. } | Meets::Corner { corner, .. } => {
                let body = self.features.body_of(corner, |body| &body.corners);
                self.features.bodies[body].radius
            }
            Meets::Edges { .. } => 0.0,
        }
    }

    /// The bodies of what meets; `None` where there is no such feature.
    fn bodies(&self, meets: Meets) -> Option<[usize; 2]> {
        let Features { corners, faces, edges, .. } = &self.features;
        let corner = |place: usize| {
            (place < corners.len()).then(|| self.features.body_of(place, |body| &body.corners))
        };
        let edge =
            |place: usize| (place < edges.len()).then(|| self.features.body_of(place, |body| &body.edges));
        let face =
            |place: usize| (place < faces.len()).then(|| self.features.body_of(place, |body| &body.faces));
        Some(match meets {
            Meets::Face { corner: one, face: other } => [corner(one)?, face(other)?],
            Meets::Edge { corner: one, edge: other } => [corner(one)?, edge(other)?],
            Meets::Corner { corner: one, other } => [corner(one)?, corner(other)?],
            Meets::Edges { one, other } => [edge(one)?, edge(other)?],
        })
    }
}

impl Unilateral for Polyhedra {
    fn contact_count(&self, pairs: &[Pair]) -> usize {
        pairs.len()
    }

    fn sides(&self, contact: usize, pairs: &[Pair], positions: &[Vec3]) -> Sides {
        self.features.meeting(Self::meets(&pairs[contact]), positions).sides
    }

    fn gap(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], _time: f64) -> f64 {
        let meets = Self::meets(&pairs[contact]);
        self.features.meeting(meets, positions).distance - self.radius(meets)
    }

    fn slope(&self, contact: usize, pairs: &[Pair], positions: &[Vec3], _time: f64) -> Vec3 {
        self.features.meeting(Self::meets(&pairs[contact]), positions).normal.unwrap_or(Vec3::ZERO)
    }

    fn law(&self) -> ImpactLaw {
        self.law
    }

    fn force(&self, contact: usize, _memory: &[f64], pairs: &[Pair]) -> Vec3 {
        let [x, y, z, ..] = pairs[contact].memory;
        Vec3::new(x, y, z)
    }

    fn set_force(&self, contact: usize, _memory: &mut [f64], pairs: &mut [Pair], force: Vec3) {
        pairs[contact].memory[..3].copy_from_slice(&force.to_array());
    }

    fn describe(&self, contact: usize, pairs: &[Pair]) -> String {
        let Features { corners, faces, edges, .. } = &self.features;
        match Self::meets(&pairs[contact]) {
            Meets::Face { corner, face } => {
                format!("row {} on the face of rows {:?}", corners[corner].row, faces[face])
            }
            Meets::Edge { corner, edge } => {
                format!("row {} on the edge of rows {:?}", corners[corner].row, edges[edge].ends)
            }
            Meets::Corner { corner, other } => {
                format!("row {} on the corner at row {}", corners[corner].row, corners[other].row)
            }
            Meets::Edges { one, other } => {
                format!("the edges of rows {:?} and {:?}", edges[one].ends, edges[other].ends)
            }
        }
    }
}

impl Apart for Polyhedra {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_internal(&self) -> bool {
        let has_balls = self.features.bodies.iter().any(|body| body.radius > 0.0);
        // masses have no rotation: friction at the centres of balls leaves a torque
        self.law.friction == 0.0 || !has_balls
    }

    fn has_pairs(&self) -> bool {
        true
    }

    fn visit_cliques(&self, pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let Features { corners, faces, edges, .. } = &self.features;
        for pair in pairs {
            match Self::meets(pair) {
                Meets::Face { corner, face } => {
                    let [a, b, c] = faces[face];
                    visit(&[corners[corner].row, a, b, c]);
                }
                Meets::Edge { corner, edge } => {
                    let [a, b] = edges[edge].ends;
                    visit(&[corners[corner].row, a, b]);
                }
                Meets::Corner { corner, other } => visit(&[corner, other].map(|it| corners[it].row)),
                Meets::Edges { one, other } => {
                    let [[a, b], [c, d]] = [one, other].map(|edge| edges[edge].ends);
                    visit(&[a, b, c, d]);
                }
            }
        }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Search::default())
    }

    fn find_pairs(&self, at: &Configuration, scratch: &mut Scratch, found: &mut Vec<Pair>) {
        let search: &mut Search =
            scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"));
        search.find(&self.features, self.timestep, at, found);
    }

    // a body that turns comes to bear on other features than it did a period before
    fn pairs_are_stale(&self, _searched: &[Vec3], _at: &Configuration, _scratch: &Scratch) -> bool {
        self.detection == Detection::OnePeriodLate
    }

    fn accepts_pair(&self, pair: &Pair) -> bool {
        let Some(meets) = Meets::of([pair.a, pair.b]) else { return false };
        let Some([one, other]) = self.bodies(meets) else { return false };
        let is_ordered = !matches!(meets, Meets::Edges { .. }) || one < other;
        let needs_ball = matches!(meets, Meets::Edge { .. } | Meets::Corner { .. });
        is_ordered
            && one != other
            && (!needs_ball || self.features.bodies[one].radius > 0.0)
            && !self.features.bodies[other].faces.is_empty()
            && self.features.may_meet([one.min(other), one.max(other)])
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, Search::bytes)
    }

    fn bytes(&self) -> usize {
        self.features.bytes()
    }
}
