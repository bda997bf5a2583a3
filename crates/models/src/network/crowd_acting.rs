//! A multitude under its law as controls drive it now: what its pairs do.

use souple_engine::{Configuration, Energy, Pair, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};

use super::crowd::{Crowd, CrowdDescription, HOOK, Listing, Work};
use super::crowd_pass::{Evaluation, Known, Task, key};
use super::friction::{Hook, Phase};
use super::fusible::{Bond, Fusible, MOLTEN};
use super::kernel::LinkKernel;
use super::law::{Moment, Reach, Response};

/// A crowd under its law as it is driven.
#[derive(Clone, Copy)]
pub struct Acting<'a> {
    pub crowd: &'a Crowd,
    pub of: &'a CrowdDescription,
    pub law: &'a dyn LinkKernel,
    /// How much of the law acts.
    pub gain: f64,
}

/// How a pair stands.
pub struct Standing {
    pub pair: [u32; 2],
    pub d: Vec3,
    pub before: Vec3,
    pub reach: Reach,
}

/// What a pair does.
pub struct Act {
    /// On the first ball [N].
    pub axial: Vec3,
    pub across: Vec3,
    pub energy: Energy,
    pub memory: [f64; 8],
}

impl Acting<'_> {
    /// The bond of a pair.
    pub fn bond(
        &self,
        fusible: &Fusible,
        standing: &Standing,
        memory: &[f64; 8],
        at: &Configuration,
    ) -> Bond {
        let [a, b] = standing.pair.map(|row| at.memory[1 + self.crowd.mass_of(row)]);
        fusible.bond(&standing.reach, 0.5 * (a + b), memory[HOOK + self.law.memory_len()])
    }

    /// Moves temperatures on by a step.
    pub fn conduct(&self, at: &Configuration, work: &mut Work, memory: &mut [f64]) {
        let Some(fusible) = &self.of.fusible else { return };
        let mut flows = std::mem::take(&mut work.flows);
        flows.clear();
        flows.resize(self.crowd.mass_count(), 0.0);
        self.visit_standing(at, work, |standing, _| {
            if standing.reach.length < fusible.reach {
                let [a, b] = standing.pair.map(|row| self.crowd.mass_of(row));
                let flow = fusible.conductance * (at.memory[1 + b] - at.memory[1 + a]);
                flows[a] += flow;
                flows[b] -= flow;
            }
        });
        let second = if self.crowd.groups().is_one() { 0..0 } else { self.of.second.clone() };
        let places = self.of.first.clone().chain(second).map(|row| at.positions[row as usize]);
        fusible.advance(self.of.timestep, at.time, places, &flows, &mut memory[1..]);
        work.flows = flows;
    }

    /// What of the driven law does not fit the crowd: pairs beyond its range are not looked for.
    pub fn fault(&self) -> Option<String> {
        let (written, range) = (self.of.law.written().range(), self.of.range);
        (written <= range && self.law.range() > range).then(|| {
            format!(
                "it is driven to act up to {} m, and pairs are looked for within {range} m: give the crowd a longer `range`",
                self.law.range()
            )
        })
    }

    /// What the law stores in a pair that is as far apart as the range [J]; nothing of laws with memory, whose pairs begin there at rest.
    pub fn stored_at_range(&self, time: f64) -> f64 {
        let range = self.of.range;
        let reach = Reach { length: range, before: range, rest: range };
        let stored = match self.law.memory_len() {
            0 => self.gain * self.law.respond(&reach, &Moment::of(time), &[]).stored,
            _ => 0.0,
        };
        // a law that has no number there has no end there either
        if stored.is_finite() { stored } else { 0.0 }
    }

    fn law_memory<'m>(&self, memory: &'m [f64; 8]) -> &'m [f64] {
        &memory[HOOK..HOOK + self.law.memory_len()]
    }

    /// What a pair of this length remembers of its law at the start.
    pub fn begin(&self, length: f64, memory: &mut [f64; 8]) {
        let len = self.law.memory_len();
        if len > 0 {
            self.law.begin(self.of.range, length, &mut memory[HOOK..HOOK + len]);
        }
    }

    /// Whether a pair in State that is out of range has something to give off there: a bond, or what its law remembers from the
    /// step before.
    pub fn tears(&self, pair: &Pair, at: &Configuration) -> bool {
        let (law_len, range_sq) = (self.law.memory_len(), self.of.range * self.of.range);
        let Standing { d, before, .. } = self.crowd.standing([pair.a as u32, pair.b as u32], at);
        let is_bound = self.of.fusible.is_some() && pair.memory[HOOK + law_len] != MOLTEN;
        d.length_sq() >= range_sq && (is_bound || (law_len > 0 && before.length_sq() < range_sq))
    }

    /// `None` out of range, but for what tears there.
    pub fn act(&self, standing: &Standing, memory: &[f64; 8], at: &Configuration) -> Option<Act> {
        let Standing { d, before, reach, .. } = *standing;
        if reach.length >= self.of.range {
            return self.tear(standing, memory, at);
        }
        let mut next = *memory;
        let (moment, own) = (Moment::of(at.time), self.law_memory(memory));
        let remembered = &mut next[HOOK..HOOK + own.len()];
        let Response { mut push, stored, heat } = self.law.respond_and_remember(&reach, &moment, remembered);
        if self.gain == 0.0 {
            // what is parted remembers what it was
            remembered.copy_from_slice(own);
        }
        let u = d.try_normalised().or(before.try_normalised()).unwrap_or(Vec3::X);
        let mut energy = Energy { stored: self.gain * stored, dissipated: self.gain * heat };
        let mut across = Vec3::ZERO;
        if let Some(friction) = &self.of.friction {
            // the elastic part alone presses
            let still = Reach { before: reach.length, ..reach };
            let normal = self.gain * self.law.respond(&still, &moment, own).push;
            let hook = Hook::from_numbers(std::array::from_fn(|i| memory[i]));
            let grip = friction.grip(hook, d, before, normal);
            across = grip.force;
            energy.stored += grip.stored;
            energy.dissipated += grip.heat;
            next[..HOOK].copy_from_slice(&grip.next.numbers());
        }
        if let Some(fusible) = &self.of.fusible {
            let bond = self.bond(fusible, standing, memory, at);
            push += bond.push;
            energy.stored += self.gain * bond.stored;
            energy.dissipated += self.gain * bond.heat;
            // what is parted remembers what it was
            if self.gain > 0.0 {
                next[HOOK + own.len()] = bond.rest;
            }
        }
        Some(Act { axial: u * (self.gain * push), across, energy, memory: next })
    }

    /// What a law that remembers, and a bond, give off where a pair is out of range and was in it a step before: all that they stored.
    pub fn tear(&self, standing: &Standing, memory: &[f64; 8], at: &Configuration) -> Option<Act> {
        let (own, bond_at) = (self.law_memory(memory), HOOK + self.law.memory_len());
        let fusible = self.of.fusible.as_ref().filter(|_| memory[bond_at] != MOLTEN);
        if own.is_empty() && fusible.is_none() {
            return None;
        }
        // velocities of some steppers are not those that led here
        let length = standing.reach.before.min(self.of.range);
        let still = Reach { length, before: length, ..standing.reach };
        let before = Standing { reach: still, ..*standing };
        let (mut heat, mut next) = (0.0, *memory);
        next[..HOOK].copy_from_slice(&Hook::FREE.numbers());
        if !own.is_empty() {
            heat += self.law.respond(&still, &Moment::of(at.time), own).stored;
            self.begin(self.of.range, &mut next);
        }
        if let Some(fusible) = fusible {
            heat += self.bond(fusible, &before, memory, at).stored;
            next[bond_at] = MOLTEN;
        }
        let heat = self.gain * heat;
        let energy = Energy { stored: 0.0, dissipated: heat };
        Some(Act { axial: Vec3::ZERO, across: Vec3::ZERO, energy, memory: next })
    }

    /// The same of a pair in State.
    pub fn act_of(&self, pair: &Pair, at: &Configuration) -> Option<Act> {
        self.act(&self.crowd.standing([pair.a as u32, pair.b as u32], at), &pair.memory, at)
    }

    /// What a pair remembers, from the numbers that State has of it.
    pub fn recalled(&self, known: Option<&[f64]>, length: f64) -> [f64; 8] {
        let (mut memory, own) = ([0.0; 8], self.crowd.remembered_len());
        match known {
            None => self.begin(length, &mut memory),
            Some(numbers) if self.of.friction.is_none() => memory[HOOK..HOOK + own].copy_from_slice(numbers),
            Some(numbers) if own > 0 => memory[..HOOK + own].copy_from_slice(numbers),
            Some(&[x, y, z]) => {
                let hook = Hook { phase: Phase::Stick, began: Vec3::new(x, y, z) };
                memory[..HOOK].copy_from_slice(&hook.numbers());
            }
            Some(numbers) => unreachable!("{} numbers of a hook", numbers.len()),
        }
        memory
    }

    /// A pair that is not plain in a pass: the force on the first ball.
    pub fn act_alone(
        &self,
        at: &Configuration,
        (pair, ways): ([u32; 2], [Vec3; 2]),
        known: Option<&[f64]>,
        task: &mut Task,
    ) -> Vec3 {
        let standing = self.crowd.between(pair, ways);
        if standing.reach.length >= self.of.range && known.is_none() {
            return Vec3::ZERO;
        }
        let memory = self.recalled(known, standing.reach.length);
        let Some(act) = self.act(&standing, &memory, at) else { return Vec3::ZERO };
        task.heat += act.energy.dissipated;
        if standing.reach.length >= self.of.range {
            return Vec3::ZERO;
        }
        let own = if self.of.friction.is_some() { 0 } else { HOOK };
        task.keep(pair, &act.memory[own..HOOK + self.crowd.remembered_len()]);
        act.axial + act.across
    }

    /// Evaluates all pairs that are not in State; forces are added to `out`.
    pub fn pass(&self, at: &Configuration, work: &mut Work, out: Option<&mut [Vec3]>) {
        let CrowdDescription { range, friction, timestep, .. } = self.of;
        let groups = self.crowd.groups();
        work.list.bring_up_to_date(groups, at.positions, *range);
        let with = Evaluation {
            groups,
            list: &work.list,
            law: self.law,
            gain: self.gain,
            friction: friction.as_ref(),
            range: *range,
            timestep: *timestep,
            kept_len: self.crowd.own_len(),
            are_plain: self.crowd.remembered_len() == 0,
        };
        let act = |pair, ways, known: Option<&[f64]>, task: &mut Task| {
            self.act_alone(at, (pair, ways), known, task)
        };
        work.pass.run(&with, at, out, &act);
    }

    /// Calls `visit` for every pair that is in range, or was a step before and has something left, with what it remembers, in the order
    /// of rows.
    pub fn visit_standing(
        &self,
        at: &Configuration,
        work: &mut Work,
        mut visit: impl FnMut(&Standing, &[f64; 8]),
    ) {
        if self.of.listing == Listing::State {
            for pair in at.pairs {
                visit(&self.crowd.standing([pair.a as u32, pair.b as u32], at), &pair.memory);
            }
            return;
        }
        work.list.bring_up_to_date(self.crowd.groups(), at.positions, self.of.range);
        let mut known = Known::from(at.kept, self.crowd.own_len(), self.of.first.start);
        let remembers = self.crowd.remembered_len() > 0;
        for (ball, row) in self.of.first.clone().enumerate() {
            for other in work.list.others(ball) {
                let standing = self.crowd.standing([row, *other], at);
                let is_near = standing.reach.length < self.of.range;
                // what has just left gives off what it stored in the coming step
                if is_near || (remembers && standing.reach.before < self.of.range) {
                    let known = known.find(key(standing.pair));
                    if is_near || known.is_some() {
                        visit(&standing, &self.recalled(known, standing.reach.length));
                    }
                }
            }
        }
    }

    pub fn visit_tangents(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        mut visit: impl FnMut([u32; 2], Mat3),
    ) {
        self.visit_standing(at, Work::of(scratch), |standing, memory| {
            let Standing { pair, d, before, reach } = *standing;
            let (Some(n), true) = (d.try_normalised(), reach.length < self.of.range) else { return };
            let m = before.try_normalised().unwrap_or(n);
            let own = self.law_memory(memory);
            let pressed = self.law.respond(&reach, &Moment::of(at.time), own).push;
            let ([mut now, mut past], mut push) =
                (self.law.slopes(&reach, &Moment::of(at.time), own), pressed);
            if let Some(fusible) = &self.of.fusible {
                let bond = self.bond(fusible, standing, memory, at);
                push += bond.push;
                now += bond.slopes[0];
                past += bond.slopes[1];
            }
            [&mut push, &mut now, &mut past].into_iter().for_each(|number| *number *= self.gain);
            let side = push / reach.length;
            let mut position = n.outer(n) * (now - side) + Mat3::IDENTITY * side + n.outer(m) * past;
            let mut velocity = n.outer(m) * (-self.of.timestep * past);
            if let Some(friction) = &self.of.friction
                && self.gain * pressed > 0.0
            {
                // the hook as it is while it sticks
                let across = Mat3::IDENTITY - n.outer(n);
                position -= across * friction.stiffness;
                velocity -= across * (friction.damping * self.of.timestep);
            }
            visit(pair, position * weights.position + velocity * weights.velocity);
        });
    }
}
