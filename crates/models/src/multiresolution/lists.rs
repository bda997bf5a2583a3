//! What a step goes through: made anew when other points become active, or when steps are divided otherwise.

use souple_engine::levels::{Division, Filter};
use souple_math::{Mat3, Vec3};

use super::adapt::Verdict;
use super::elastic::{ALL_CORNERS, Due, LawMemory};
use super::links::Loops;
use super::roles::{Following, Roles};
use super::{Coupling, LevelsForce};
use crate::solids::layout::LANES;
use crate::solids::sample_law::Answer;

/// What points and samples do, by the memory of the force.
pub struct Work {
    /// The part of the memory that all this was made from.
    pub known: Vec<f64>,
    /// Of each point: the least rate that its velocity asks for.
    urges: Vec<f64>,
    pub roles: Roles,
    pub following: Following,
    /// Active points, ascending.
    pub active: Vec<u32>,
    /// Rows of these.
    pub active_rows: Vec<u32>,
    /// Of each sample: the part of its volume that no finer level stands for, times its level's share of the moduli [m³].
    pub shares: Vec<f64>,
    /// Of each sample: the volume whose stress acts, times the same [m³].
    pub acting: Vec<f64>,
    /// Of each active point: the mass that elastic forces move [kg].
    pub masses: Vec<f64>,
    /// Of each active point: the mass that hangs on it, which forces from outside move [kg].
    pub carried: Vec<f64>,
    pub division: Option<Division>,
    /// By rate.
    pub due: Vec<Vec<Due>>,
    /// By rate: active points that its samples push.
    pub pushed: Vec<Vec<u32>>,
    /// By rate: active points that have it.
    pub of_rate: Vec<Vec<u32>>,
    pub rate_of_point: Vec<u8>,
    /// Followers that samples read; where loops lag, with those that feed them, in the order in which they are brought there.
    pub ghosts: Vec<u32>,
    /// All followers in that order, where loops lag.
    pub relay: Vec<u32>,
    /// `(1 + h²K/m)⁻¹` of each active point, of the semi-implicit filter.
    pub brakes: Vec<Mat3>,
    /// How much the deformation varies around each active point.
    pub variation: Vec<f64>,
    /// Points to be subdivided, those most in need first.
    pub wanted: Vec<u32>,
    /// Points that may be regrouped, with the greatest variation around those in their place.
    pub unwanted: Vec<(f64, u32)>,
    /// What the last look came to.
    pub verdict: Verdict,
    /// The points that were active before.
    pub before: Vec<u32>,
    /// How fine all points were before.
    pub were: Vec<u8>,
    /// Where all points were before, by those that were active then [m].
    pub followed: Vec<Vec3>,
    /// How far each point has been moved so far because others came to be at work, by the memory [m].
    pub moved: Vec<Vec3>,
    pub stress: LawMemory,
    /// Of each point: what all samples together push it with.
    pub sums: Vec<Vec3>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    rate_of_slot: Vec<u8>,
    is_marked: Vec<bool>,
}

/// A point's interval is at most this part of the longest that is stable by the bound.
const COURANT: f64 = 0.8;

impl Work {
    pub fn new(force: &LevelsForce) -> Self {
        Self {
            known: Vec::new(),
            urges: Vec::new(),
            roles: Roles::default(),
            following: Following::default(),
            active: Vec::new(),
            active_rows: Vec::new(),
            shares: Vec::new(),
            acting: Vec::new(),
            masses: Vec::new(),
            carried: Vec::new(),
            division: None,
            due: Vec::new(),
            pushed: Vec::new(),
            of_rate: Vec::new(),
            rate_of_point: Vec::new(),
            ghosts: Vec::new(),
            relay: Vec::new(),
            brakes: Vec::new(),
            variation: Vec::new(),
            wanted: Vec::new(),
            unwanted: Vec::new(),
            verdict: Verdict::default(),
            before: Vec::new(),
            were: Vec::new(),
            followed: Vec::new(),
            moved: vec![Vec3::ZERO; force.hierarchy.point_count()],
            stress: LawMemory::new(&force.matter, Answer::Stress),
            sums: Vec::new(),
            stiffness: Vec::new(),
            damping: Vec::new(),
            rate_of_slot: Vec::new(),
            is_marked: Vec::new(),
        }
    }

    /// Whether all this was made from a memory.
    pub fn is_of(&self, force: &LevelsForce, memory: &[f64]) -> bool {
        self.known == memory[..force.stays()] && self.urges == memory[force.urges()..force.moved()]
    }

    /// Brings roles, weights, masses and volumes to a memory.
    pub fn refresh(&mut self, force: &LevelsForce, memory: &[f64]) {
        let urges = &memory[force.urges()..force.moved()];
        if self.urges != urges {
            self.urges.clear();
            self.urges.extend_from_slice(urges);
            self.division = None;
        }
        // how long points stay makes no difference
        let memory = &memory[..force.stays()];
        if self.known == memory {
            return;
        }
        self.known.clear();
        self.known.extend_from_slice(memory);
        self.division = None;
        let hierarchy = &force.hierarchy;
        self.roles.derive(hierarchy, |point| force.is_subdivided(memory, point));
        self.following.compose(hierarchy, &self.roles);
        if hierarchy.loops == Loops::Lagged {
            self.roles.relay(hierarchy, &mut self.relay);
        }
        self.active.clear();
        let roles = &self.roles;
        self.active
            .extend((0..hierarchy.point_count() as u32).filter(|point| roles.is_active(*point as usize)));
        self.active_rows.clear();
        self.active_rows.extend(self.active.iter().map(|point| point + force.first_row as u32));
        self.share_volumes(force);
        self.share_masses(force);
    }

    /// Each cell of the finest mesh is stood for by the finest level with a tetrahedron at work there.
    fn share_volumes(&mut self, force: &LevelsForce) {
        let (hierarchy, matter) = (&force.hierarchy, &force.matter);
        self.shares.clear();
        self.shares.resize(matter.slots.len(), 0.0);
        let made = self.known[force.cuts_made()];
        let is_whole = |(cell, _): &(usize, &f64)| !force.cuts.is_through(*cell, made);
        for (cell, volume) in matter.cell_volumes.iter().enumerate().filter(is_whole) {
            let slot_at = |level: usize| matter.slot_of_cell[level][cell] as usize;
            let is_live = |level: &usize| {
                let sample = matter.slots[slot_at(*level)];
                sample.is_some_and(|sample| self.roles.is_live[sample.tet as usize])
            };
            let level = (0..hierarchy.level_count()).rev().find(is_live).unwrap_or(0);
            self.shares[slot_at(level)] += volume * force.share_of_moduli[level];
        }
        self.acting.clear();
        match force.coupling {
            Coupling::Transpose => self.acting.extend_from_slice(&self.shares),
            // every level is whole around its active points
            Coupling::OneWay => self.acting.extend(matter.slots.iter().map(|slot| match slot {
                Some(sample) if self.roles.is_live[sample.tet as usize] => {
                    let corner = hierarchy.tets[sample.tet as usize].corners[0];
                    let level = usize::from(hierarchy.level_of[corner as usize]);
                    sample.volume * force.share_of_moduli[level]
                }
                _ => 0.0,
            })),
        }
        if force.coupling == Coupling::OneWay {
            for (cell, volume) in matter.cell_volumes.iter().enumerate().filter(|cell| !is_whole(cell)) {
                for (slots, share) in matter.slot_of_cell.iter().zip(&force.share_of_moduli) {
                    let acting = &mut self.acting[slots[cell] as usize];
                    *acting = (*acting - volume * share).max(0.0);
                }
            }
        }
    }

    fn share_masses(&mut self, force: &LevelsForce) {
        let hierarchy = &force.hierarchy;
        self.carried.clear();
        self.carried.resize(hierarchy.point_count(), 0.0);
        for (point, mass) in force.finest_masses.iter().enumerate() {
            if self.roles.is_active(point) {
                self.carried[point] += mass;
            }
            for (leader, weight) in self.following.of(point) {
                self.carried[*leader as usize] += mass * weight;
            }
        }
        self.masses.clear();
        match force.coupling {
            Coupling::Transpose => {
                // weights of extrapolated followers may be negative: a point is never left without mass
                for point in &self.active {
                    let carried = &mut self.carried[*point as usize];
                    *carried = carried.max(super::LEAST_MASS * force.whole_masses[*point as usize]);
                }
                self.masses.extend_from_slice(&self.carried);
            }
            Coupling::OneWay => {
                self.masses.extend_from_slice(&force.whole_masses);
                for (carried, whole) in self.carried.iter_mut().zip(&self.masses) {
                    // of a point that hardly anything hangs on
                    if *carried < super::LEAST_MASS * whole {
                        *carried = *whole;
                    }
                }
            }
        }
    }

    /// Gives every active point and every sample its rate, and lists what is due with each.
    pub fn divide(&mut self, force: &LevelsForce, division: &Division) {
        if self.division == Some(*division) {
            return;
        }
        self.division = Some(*division);
        self.bound_stiffness(force);
        self.choose_rates(force, division);
        self.list_samples(force, division);
        self.list_points(force, division);
    }

    /// Gershgorin's bound of each active point's row of the stiffness and of the damping: a follower's row comes to
    /// those that it follows.
    fn bound_stiffness(&mut self, force: &LevelsForce) {
        let (hierarchy, matter) = (&force.hierarchy, &force.matter);
        for bound in [&mut self.stiffness, &mut self.damping] {
            bound.clear();
            bound.resize(hierarchy.point_count(), 0.0);
        }
        for (sample, volume) in matter.slots.iter().zip(&self.acting).filter(|(_, volume)| **volume > 0.0) {
            let Some(sample) = sample else { continue };
            let tet = &hierarchy.tets[sample.tet as usize];
            let lengths = tet.gradients.map(|gradient| gradient.length());
            let sum: f64 = lengths.iter().sum();
            let moduli = &matter.material(sample).small_strain;
            let modulus = moduli.lambda.max(0.0) + 2.0 * moduli.mu;
            for (corner, length) in tet.corners.iter().zip(lengths) {
                self.stiffness[*corner as usize] += volume * modulus * length * sum;
                self.damping[*corner as usize] += volume * 2.0 * force.viscosity * length * sum;
            }
        }
        if force.coupling == Coupling::Transpose {
            for follower in 0..hierarchy.point_count() {
                let (stiffness, damping) = (self.stiffness[follower], self.damping[follower]);
                if stiffness > 0.0 {
                    for (leader, weight) in self.following.of(follower) {
                        self.stiffness[*leader as usize] += weight.abs() * stiffness;
                        self.damping[*leader as usize] += weight.abs() * damping;
                    }
                }
            }
        }
    }

    /// The longest stable interval of an active point, by the bound [s].
    pub fn longest_interval(&self, point: usize, filter: Filter) -> f64 {
        let mass = self.masses[point];
        let (frequency_sq, rate) = (self.stiffness[point] / mass, self.damping[point] / mass);
        // (h ω)² + 2 h c = 4: modified Euler with the damping of the velocity at the start
        let longest = 4.0 / (rate + (rate * rate + 4.0 * frequency_sq).sqrt());
        filter.lengthening() * COURANT * longest
    }

    /// The shortest interval that an active point needs [s].
    pub fn shortest_interval(&mut self, force: &LevelsForce) -> f64 {
        self.bound_stiffness(force);
        let interval = |point: &u32| self.longest_interval(*point as usize, Filter::None);
        self.active.iter().map(interval).fold(f64::INFINITY, f64::min)
    }

    fn choose_rates(&mut self, force: &LevelsForce, division: &Division) {
        let hierarchy = &force.hierarchy;
        self.rate_of_point.clear();
        self.rate_of_point.resize(hierarchy.point_count(), 0);
        for point in &self.active {
            let longest = self.longest_interval(*point as usize, division.filter);
            let rate = (0..division.halvings).find(|rate| division.interval(*rate) <= longest);
            let urged = self.urges[*point as usize] as u8;
            self.rate_of_point[*point as usize] = urged.max(rate.unwrap_or(division.halvings) as u8);
        }
        // the fastest point that a sample comes to, itself or by followers
        self.rate_of_slot.clear();
        self.rate_of_slot.resize(force.matter.slots.len(), 0);
        for (slot, sample) in force.matter.slots.iter().enumerate() {
            let Some(sample) = sample.filter(|_| self.acting[slot] > 0.0) else { continue };
            let corners = hierarchy.tets[sample.tet as usize].corners;
            let rate_of = |corner: u32| {
                let leaders = self.following.of(corner as usize).iter();
                let fastest = leaders.map(|(leader, _)| self.rate_of_point[*leader as usize]).max();
                fastest.unwrap_or(self.rate_of_point[corner as usize])
            };
            self.rate_of_slot[slot] = corners.map(rate_of).into_iter().max().unwrap_or(0);
        }
    }

    /// A sample pushes all its corners at its rate; one-way, each active corner at its own.
    fn list_samples(&mut self, force: &LevelsForce, division: &Division) {
        let rates = division.halvings as usize + 1;
        self.due.resize_with(rates, Vec::new);
        self.due.iter_mut().for_each(Vec::clear);
        for block in 0..force.matter.block_count() {
            if self.acting[block * LANES..(block + 1) * LANES].iter().all(|volume| *volume == 0.0) {
                continue;
            }
            for rate in 0..rates {
                let mut due = Due { block: block as u32, corners: [0; LANES] };
                for lane in 0..LANES {
                    due.corners[lane] = self.corners_due(force, block * LANES + lane, rate as u8);
                }
                if due.corners != [0; LANES] {
                    self.due[rate].push(due);
                }
            }
        }
    }

    fn corners_due(&self, force: &LevelsForce, slot: usize, rate: u8) -> u8 {
        let Some(sample) = force.matter.slots[slot].filter(|_| self.acting[slot] > 0.0) else { return 0 };
        match force.coupling {
            Coupling::Transpose if self.rate_of_slot[slot] == rate => ALL_CORNERS,
            Coupling::Transpose => 0,
            Coupling::OneWay => {
                let corners = force.hierarchy.tets[sample.tet as usize].corners;
                let is_due = |corner: &u32| {
                    let point = *corner as usize;
                    self.roles.is_active(point) && self.rate_of_point[point] == rate
                };
                (0..4).filter(|index: &usize| is_due(&corners[*index])).map(|index| 1_u8 << index).sum()
            }
        }
    }

    /// Ghosts, and the points of each rate.
    fn list_points(&mut self, force: &LevelsForce, division: &Division) {
        let (hierarchy, rates) = (&force.hierarchy, division.halvings as usize + 1);
        for lists in [&mut self.pushed, &mut self.of_rate] {
            lists.resize_with(rates, Vec::new);
            lists.iter_mut().for_each(Vec::clear);
        }
        for point in &self.active {
            self.of_rate[self.rate_of_point[*point as usize] as usize].push(*point);
        }
        self.ghosts.clear();
        self.is_marked.clear();
        self.is_marked.resize(hierarchy.point_count(), false);
        for slot in self.due.iter().flatten().flat_map(|due| due.slots()) {
            for corner in corners_of(force, slot) {
                if !self.roles.is_active(corner as usize) && !self.is_marked[corner as usize] {
                    self.is_marked[corner as usize] = true;
                    self.ghosts.push(corner);
                }
            }
        }
        match hierarchy.loops {
            Loops::Activated => self.ghosts.sort_unstable(),
            Loops::Lagged => {
                let is_ghost = self.roles.ghosts(hierarchy);
                self.ghosts.clear();
                self.ghosts.extend(self.relay.iter().filter(|point| is_ghost[**point as usize]));
            }
        }
        match force.coupling {
            Coupling::OneWay => self.pushed.clone_from(&self.of_rate),
            Coupling::Transpose => self.list_pushed(force, rates),
        }
        self.brakes.clear();
        if division.filter == Filter::SemiImplicit {
            self.make_brakes(force, division);
        }
    }

    fn list_pushed(&mut self, force: &LevelsForce, rates: usize) {
        for rate in 0..rates {
            self.is_marked.fill(false);
            for slot in self.due[rate].iter().flat_map(|due| due.slots()) {
                for corner in corners_of(force, slot) {
                    self.is_marked[corner as usize] |= self.roles.is_active(corner as usize);
                    for (leader, _) in self.following.of(corner as usize) {
                        self.is_marked[*leader as usize] = true;
                    }
                }
            }
            let is_marked = &self.is_marked;
            self.pushed[rate].extend(self.active.iter().filter(|point| is_marked[**point as usize]));
        }
    }

    /// `(1 + h²K/m)⁻¹` with `K = Σ V ((λ + μ) g gᵀ + μ g² 1)`, the point's own stiffness at rest.
    fn make_brakes(&mut self, force: &LevelsForce, division: &Division) {
        let (hierarchy, matter) = (&force.hierarchy, &force.matter);
        self.brakes.resize(hierarchy.point_count(), Mat3::ZERO);
        for (sample, volume) in matter.slots.iter().zip(&self.acting).filter(|(_, volume)| **volume > 0.0) {
            let Some(sample) = sample else { continue };
            let tet = &hierarchy.tets[sample.tet as usize];
            let moduli = &matter.material(sample).small_strain;
            for (corner, g) in tet.corners.iter().zip(tet.gradients) {
                let stiffness =
                    (g.outer(g) * (moduli.lambda + moduli.mu)).plus_diagonal(moduli.mu * g.length_sq());
                self.brakes[*corner as usize] += stiffness * *volume;
            }
        }
        for point in &self.active {
            let point = *point as usize;
            let interval = division.interval(u32::from(self.rate_of_point[point]));
            let brake = &mut self.brakes[point];
            let sum = (*brake * (interval * interval / self.masses[point])).plus_diagonal(1.0);
            // one plus a positive semi-definite matrix
            *brake = sum.try_inverse().unwrap_or(Mat3::IDENTITY);
        }
    }

    pub fn bytes(&self) -> usize {
        let numbers = [&self.known, &self.urges, &self.shares, &self.acting, &self.masses, &self.carried];
        let numbers = numbers.into_iter().chain([&self.stiffness, &self.damping, &self.variation]);
        let points = [&self.active, &self.active_rows, &self.ghosts, &self.relay, &self.wanted, &self.before];
        let points = points.into_iter().chain(&self.pushed).chain(&self.of_rate);
        8 * numbers.map(Vec::capacity).sum::<usize>()
            + 4 * points.map(Vec::capacity).sum::<usize>()
            + size_of::<Due>() * self.due.iter().map(Vec::capacity).sum::<usize>()
            + size_of::<Mat3>() * self.brakes.capacity()
            + size_of::<Vec3>() * self.sums.capacity()
            + 16 * self.unwanted.capacity()
            + self.following.bytes()
            + self.verdict.bytes()
            + self.stress.bytes()
            + self.roles.of_point.capacity()
            + self.roles.is_live.capacity()
            + self.rate_of_point.capacity()
            + self.rate_of_slot.capacity()
            + self.is_marked.capacity()
            + self.were.capacity()
    }
}

/// Corners of the tetrahedron of a sample; of an empty slot none.
fn corners_of(force: &LevelsForce, slot: usize) -> impl Iterator<Item = u32> {
    let corners = |sample: super::matter::Sample| force.hierarchy.tets[sample.tet as usize].corners;
    force.matter.slots[slot].map(corners).into_iter().flatten()
}
