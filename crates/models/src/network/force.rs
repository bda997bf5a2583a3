//! Links of one law as a force of the engine.

use std::any::Any;

use souple_engine::{
    Configuration, Curvature, Declaration, Energy, Force, LinkShown, LinkState, Pair, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::driven::DrivenLaw;
use super::kernel::{LinkKernel, Moving};
use super::law::{AsksFor, Moment, Reach, Response};
use super::layout::{Arrangement, Ends, LANES, Layout, Part};
use super::pair_tangent::{add_change, add_pair_blocks};
use super::span::{Known, OnAxis, Place, Projected, Span, axis_of};
use super::written::WRITTEN_MEMORY;
use crate::solids::parallel;

/// What links are made of.
#[derive(Debug)]
pub struct LinkDescription<'a> {
    pub name: String,
    pub law: DrivenLaw,
    pub ends: &'a [Ends],
    /// How far they are apart.
    pub span: Span,
    /// [m]
    pub rest_lengths: &'a [f64],
    /// At the start [m].
    pub lengths: &'a [f64],
    /// Of the system [s].
    pub timestep: f64,
    pub account: Account,
}

/// Whether links without memory keep account of what they give off, which costs a second pass over them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Account {
    #[default]
    None,
    Heat,
}

/// Links of one law: `F1 = φ(D, D^r, memory) u = -F2` with `u = (P1 - P2)/D`, or with a given `u` ([`Span::Along`]).
///
/// `D^r` is taken from `X - h v`: a pair that turns without changing its length feels no damping. Its memory is, for
/// each part, the heat given off and the numbers of its links.
#[derive(Debug)]
pub struct Links {
    name: String,
    law: DrivenLaw,
    layout: Layout,
    span: Span,
    timestep: f64,
    account: Account,
    /// Part of each link and its slot there.
    place_of: Vec<(u32, u32)>,
    /// At the start [m]; of links that remember.
    lengths: Vec<f64>,
}

/// What one link does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkStance {
    /// `D` [m].
    pub length: f64,
    /// Positive when it pushes its ends apart [N].
    pub push: f64,
    /// [J]
    pub stored: f64,
}

/// A link with its directions, for tangents.
struct Standing {
    rows: [u32; 2],
    reach: Reach,
    moment: Moment,
    /// `(P1 - P2)/D` now and a step before; `None` where there is no direction.
    directions: Option<[Vec3; 2]>,
}

/// Buffers of a sum of forces.
#[derive(Default)]
struct Sums {
    /// Forces of links across stretches, `[block][lane]`.
    across: Vec<Vec3>,
    /// Of links along an axis: places of rows.
    places: Vec<Place>,
    /// The same: sums on rows.
    pushes: Vec<f64>,
    /// The same: across stretches, `[block][lane]`.
    pushes_across: Vec<f64>,
    /// Of links of which a part acts: their forces on rows as though the whole did.
    whole: Vec<Vec3>,
}

impl Links {
    pub fn new(description: LinkDescription) -> Self {
        let LinkDescription { name, law, ends, span, rest_lengths, lengths, timestep, account } = description;
        let arrangement = match span {
            Span::Distance => Arrangement::Spread,
            Span::Along(_) => Arrangement::Straight,
        };
        let layout = Layout::new(ends, rest_lengths, arrangement);
        let mut place_of = vec![(0, 0); ends.len()];
        for (number, part) in layout.parts.iter().enumerate() {
            for (slot, link) in part.links.iter().enumerate() {
                place_of[*link as usize] = (number as u32, slot as u32);
            }
        }
        let lengths = if law.written().memory_len() > 0 { lengths.to_vec() } else { Vec::new() };
        Self { name, law, layout, span, timestep, account, place_of, lengths }
    }

    pub fn link_count(&self) -> usize {
        self.place_of.len()
    }

    /// Numbers that each link remembers.
    pub fn remembered_len(&self) -> usize {
        self.law.written().memory_len()
    }

    /// What a link takes of the bound `4M` on its masses (see [`super::LinkLaw::stiffest`]) [N/m].
    ///
    /// At the rest length of the first link.
    pub fn stiffest(&self) -> f64 {
        let rest =
            self.layout.parts.iter().find(|part| !part.links.is_empty()).map_or(0.0, |part| part.rest(0)[0]);
        self.law.written().stiffest(rest)
    }

    /// Whether the law asks where ends are.
    pub fn asks_for(&self) -> AsksFor {
        self.law.written().asks_for()
    }

    fn moving<'a>(&self, at: &Configuration<'a>) -> Moving<'a> {
        Moving { positions: at.positions, velocities: at.velocities, time: at.time, timestep: self.timestep }
    }

    /// The rows as they stand along an axis; `places` is scratch.
    fn on_axis<'a>(&self, at: &Configuration, axis: Vec3, places: &'a mut Vec<Place>) -> OnAxis<Known<'a>> {
        let (moving, rows) = (self.moving(at), self.layout.rows());
        places.resize(rows.len(), [0.0; 2]);
        self.layout.for_each_stretch(places, |own, places| {
            let (positions, velocities) = (&moving.positions[own.clone()], &moving.velocities[own]);
            let moving = Moving { positions, velocities, ..moving };
            Projected { moving, axis }.places_into(places);
        });
        OnAxis { places: Known { places, first_row: rows.start }, time: at.time }
    }

    fn remembers(&self) -> bool {
        self.law.written().memory_len() > 0 || self.account == Account::Heat
    }

    fn of_part<'m>(&self, number: usize, memory: &'m [f64]) -> &'m [f64] {
        if self.remembers() {
            &memory[self.layout.memory_range(number, self.law.written().memory_len())][1..]
        } else {
            &[]
        }
    }

    /// The numbers of a part's `slot`-th link.
    fn remembered(&self, part: &Part, slot: usize, memory: &[f64]) -> [f64; WRITTEN_MEMORY] {
        let ((block, lane), len) = (part.place(slot), self.law.written().memory_len());
        std::array::from_fn(|i| if i < len { memory[(block * len + i) * LANES + lane] } else { 0.0 })
    }

    fn standing(&self, part: &Part, slot: usize, at: &Configuration) -> Standing {
        let rows = part.ends_of(slot);
        let [a, b] = rows.map(|row| row as usize);
        let d = at.positions[a] - at.positions[b];
        let e = d - (at.velocities[a] - at.velocities[b]) * self.timestep;
        let (block, lane) = part.place(slot);
        let (length, before) = (self.span.length(d), self.span.length(e));
        let reach = Reach { length, before, rest: part.rest(block)[lane] };
        let directions = match (self.span, d.try_normalised(), e.try_normalised()) {
            (Span::Along(axis), ..) => Some([axis, axis]),
            (_, Some(n), Some(m)) => Some([n, m]),
            (_, n, m) => n.or(m).map(|n| [n, n]),
        };
        let place = |row: usize| {
            let places = [at.positions[row], at.positions[row] - at.velocities[row] * self.timestep];
            match self.span {
                Span::Distance => places,
                Span::Along(axis) => places.map(|place| Vec3::X * axis.dot(place)),
            }
        };
        let moment = Moment { time: at.time, places: [place(a), place(b)] };
        Standing { rows, reach, moment, directions }
    }

    /// How link number `link` stands.
    pub fn stance(&self, link: usize, at: &Configuration) -> LinkStance {
        let (number, slot) = self.place_of[link];
        let part = &self.layout.parts[number as usize];
        let memory = self.remembered(part, slot as usize, self.of_part(number as usize, at.memory));
        let Standing { reach, moment, .. } = self.standing(part, slot as usize, at);
        let (mut stance, gain) =
            (LinkStance { length: reach.length, push: 0.0, stored: 0.0 }, self.law.gain(at.driven));
        self.law.acting(at.driven, &mut |law| {
            let response = law.respond(&reach, &moment, &memory);
            (stance.push, stance.stored) = (gain * response.push, gain * response.stored);
        });
        stance
    }

    /// The sum of a number of what links do, as much of them as acts.
    fn sum_of(&self, at: &Configuration, number: impl Fn(Response) -> f64 + Sync) -> f64 {
        let mut sum = 0.0;
        self.law.acting(at.driven, &mut |law| {
            let of_part = |number_of_part: usize| {
                let (part, memory) =
                    (&self.layout.parts[number_of_part], self.of_part(number_of_part, at.memory));
                let of = |slot| {
                    let numbers = self.remembered(part, slot, memory);
                    let Standing { reach, moment, .. } = self.standing(part, slot, at);
                    number(law.respond(&reach, &moment, &numbers))
                };
                (0..part.links.len()).map(of).sum()
            };
            sum = parallel::sum(0..self.layout.parts.len(), &of_part);
        });
        self.law.gain(at.driven) * sum
    }

    /// Calls `visit(rows, a ∂f1/∂d + b ∂f1/∂w)` for every link, with `d = P1 - P2` and its rate `w`. Returns whether it turned
    /// any round to be definite.
    pub(super) fn visit_tangents(
        &self,
        at: &Configuration,
        curvature: Curvature,
        weights: TangentWeights,
        mut visit: impl FnMut([u32; 2], Mat3),
    ) -> bool {
        let mut turned = false;
        let gain = self.law.gain(at.driven);
        if gain != 0.0 {
            self.law.acting(at.driven, &mut |law| {
                let weights =
                    TangentWeights { position: gain * weights.position, velocity: gain * weights.velocity };
                turned = self.visit_tangents_of(law, at, curvature, weights, &mut visit);
            });
        }
        turned
    }

    fn visit_tangents_of(
        &self,
        law: &dyn LinkKernel,
        at: &Configuration,
        curvature: Curvature,
        weights: TangentWeights,
        visit: &mut impl FnMut([u32; 2], Mat3),
    ) -> bool {
        let mut turned = false;
        for (number, part) in self.layout.parts.iter().enumerate() {
            let memory = self.of_part(number, at.memory);
            for slot in 0..part.links.len() {
                let Standing { rows, reach, moment, directions } = self.standing(part, slot, at);
                let Some([n, m]) = directions else { continue };
                let numbers = self.remembered(part, slot, memory);
                let push = law.respond(&reach, &moment, &numbers).push;
                let [mut now, before] = law.slopes(&reach, &moment, &numbers);
                // φ'(D) n nᵀ + φ/D (I - n nᵀ) + φ'(D^r) n mᵀ,  ∂D^r/∂w = -h m
                let turns = self.span == Span::Distance && reach.length > 0.0;
                let mut across = if turns { push / reach.length } else { 0.0 };
                // of laws with symmetric tangents n = m where φ depends on D^r
                let along = now + before;
                if curvature == Curvature::Definite && (along > 0.0 || across > 0.0) {
                    (now, across) = (-along.abs() - before, -across.abs());
                    turned = true;
                }
                let position = n.outer(n) * (now - across) + Mat3::IDENTITY * across + n.outer(m) * before;
                let velocity = n.outer(m) * (-self.timestep * before);
                visit(rows, position * weights.position + velocity * weights.velocity);
            }
        }
        turned
    }
}

impl Links {
    /// Adds the forces of links of a law on the rows that they join.
    fn sum(&self, law: &dyn LinkKernel, at: &Configuration, sums: &mut Sums, out: &mut [Vec3]) {
        let Sums { across, places, pushes, pushes_across, .. } = sums;
        let (moving, rows) = (self.moving(at), self.layout.rows());
        let memory = |number: usize| self.of_part(number, at.memory);
        let Span::Along(axis) = self.span else {
            self.layout.add_sums(
                across,
                out,
                |number, part, sums| law.add_forces(part, moving, memory(number), sums),
                |number, part, forces| law.forces(part, moving, memory(number), forces),
            );
            return;
        };
        let on_axis = self.on_axis(at, axis, places);
        pushes.clear();
        pushes.resize(rows.len(), 0.0);
        self.layout.add_sums(
            pushes_across,
            pushes,
            |number, part, sums| law.add_pushes(part, on_axis, memory(number), sums),
            |number, part, pushes| law.pushes(part, on_axis, memory(number), pushes),
        );
        self.layout.for_each_stretch(out, |own, out| {
            let pushes = &pushes[own.start - rows.start..own.end - rows.start];
            add_along(axis, pushes, out);
        });
    }
}

/// `out += a push` row by row.
fn add_along(axis: Vec3, pushes: &[f64], out: &mut [Vec3]) {
    if let Some(only) = axis_of(axis) {
        for (sum, push) in out.iter_mut().zip(pushes) {
            sum[only] += push;
        }
        return;
    }
    for (sum, push) in out.iter_mut().zip(pushes) {
        *sum += axis * *push;
    }
}

impl Force for Links {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let conservative = self.law.is_conservative();
        Declaration {
            conservative,
            velocity_terms: !conservative,
            // the line of a damper turns with its ends
            symmetric_tangent: conservative || self.span != Span::Distance,
            // forces along an axis have a torque
            internal: self.span == Span::Distance,
            ..Declaration::ELASTIC
        }
    }

    fn memory_len(&self) -> usize {
        if self.remembers() {
            self.layout.memory_range(self.layout.parts.len(), self.law.written().memory_len()).start
        } else {
            0
        }
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
        let len = self.law.written().memory_len();
        if len == 0 {
            return;
        }
        let mut numbers = vec![0.0; len];
        for (number, part) in self.layout.parts.iter().enumerate() {
            let own = &mut memory[self.layout.memory_range(number, len)][1..];
            for slot in 0..part.links.len() {
                let (block, lane) = part.place(slot);
                let length = self.lengths[part.links[slot] as usize];
                self.law.written().begin(part.rest(block)[lane], length, &mut numbers);
                for (i, value) in numbers.iter().enumerate() {
                    own[(block * len + i) * LANES + lane] = *value;
                }
            }
        }
    }

    fn new_scratch(&self) -> Scratch {
        Box::new(Sums::default())
    }

    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let len = self.law.written().memory_len();
        let heat = |number: usize| at.memory[self.layout.memory_range(number, len).start];
        let dissipated = if self.remembers() { (0..self.layout.parts.len()).map(heat).sum() } else { 0.0 };
        Energy { stored: self.sum_of(at, |response| response.stored), dissipated }
    }

    fn held(&self, at: &Configuration, _scratch: &mut Scratch) -> f64 {
        // what slips in the coming step is out of what is stored now; what a damper gives off is not
        let remembers = self.law.written().memory_len() > 0;
        self.sum_of(at, |response| response.stored + if remembers { response.heat } else { 0.0 })
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let sums: &mut Sums =
            scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"));
        let (gain, rows) = (self.law.gain(at.driven), self.layout.rows());
        let out = &mut out[rows.clone()];
        if gain == 1.0 {
            self.law.acting(at.driven, &mut |law| self.sum(law, at, sums, out));
        } else if gain != 0.0 {
            let mut whole = std::mem::take(&mut sums.whole);
            whole.clear();
            whole.resize(rows.len(), Vec3::ZERO);
            self.law.acting(at.driven, &mut |law| self.sum(law, at, sums, &mut whole));
            for (out, force) in out.iter_mut().zip(&whole) {
                *out += *force * gain;
            }
            sums.whole = whole;
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.visit_tangents(at, Curvature::Exact, weights, |ends, block| {
            add_change(ends, &block, delta, out);
        });
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        for part in &self.layout.parts {
            for slot in 0..part.links.len() {
                visit(&part.ends_of(slot));
            }
        }
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.visit_tangents(at, Curvature::Exact, weights, |ends, block| {
            add_pair_blocks(ends, &block, matrix);
        });
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.visit_tangents(at, Curvature::Definite, weights, |ends, block| {
            add_pair_blocks(ends, &block, matrix);
        })
    }

    fn advance_memory(&self, at: &Configuration, _timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let gain = self.law.gain(at.driven);
        // what is parted remembers what it was
        if !self.remembers() || gain == 0.0 {
            return;
        }
        let moving = self.moving(at);
        self.law.acting(at.driven, &mut |law| {
            self.layout.advance(self.law.written().memory_len(), memory, |part, own| {
                let (heat, numbers) = own.split_at_mut(1);
                heat[0] += gain
                    * match self.span {
                        Span::Distance => law.advance(part, moving, numbers),
                        Span::Along(axis) => {
                            let on_axis = OnAxis { places: Projected { moving, axis }, time: at.time };
                            law.advance_along(part, on_axis, numbers)
                        }
                    };
            });
        });
    }

    fn visit_links(&self, at: &Configuration, visit: &mut dyn FnMut(&LinkShown)) {
        let gain = self.law.gain(at.driven);
        self.law.acting(at.driven, &mut |law| {
            for (number, slot) in &self.place_of {
                let (part, slot) = (&self.layout.parts[*number as usize], *slot as usize);
                let memory = self.remembered(part, slot, self.of_part(*number as usize, at.memory));
                let Standing { rows, reach, moment, .. } = self.standing(part, slot, at);
                let push = gain * law.respond(&reach, &moment, &memory).push;
                // a stop along an axis is a plane: the mass that stands for it is not what is touched
                let is_plane = self.span != Span::Distance && law.range().is_finite();
                let state =
                    if gain == 0.0 || is_plane { LinkState::Apart } else { law.state(&reach, &memory) };
                visit(&LinkShown { ends: rows, state, push });
            }
        });
    }

    fn fault(&self, at: &Configuration) -> Option<(usize, String)> {
        Some((self.layout.rows().start, self.law.fault(at.driven)?))
    }

    fn bytes(&self) -> usize {
        self.layout.bytes() + size_of_val(self.place_of.as_slice()) + 8 * self.lengths.capacity()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |Sums { across, places, pushes, pushes_across, whole }| {
            size_of::<Vec3>() * (across.capacity() + whole.capacity())
                + size_of::<Place>() * places.capacity()
                + 8 * (pushes.capacity() + pushes_across.capacity())
        })
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
