//! The loops over links of one law: one text for every law and width of register.

use std::fmt::Debug;

use pulp::{Arch, Simd, WithSimd};
use souple_engine::LinkState;
use souple_math::{Dual, Lanes, Real, Vec3};

use super::law::{AsksFor, LinkLaw, MEMORY, Moment, Reach, Response};
use super::layout::{LANES, Part};
use super::span::{Between, Known, OnAxis, Projected};
use super::written::WRITTEN_MEMORY;

/// All rows as they move; memories beside them are of a part's links, `[block][number][lane]`.
#[derive(Clone, Copy, Debug)]
pub struct Moving<'a> {
    /// [m]
    pub positions: &'a [Vec3],
    /// [m/s]
    pub velocities: &'a [Vec3],
    /// [s]
    pub time: f64,
    /// Of the system [s].
    pub timestep: f64,
}

/// The loops for one law, behind a pointer so that a network may mix laws.
pub trait LinkKernel: Debug + Send + Sync {
    fn memory_len(&self) -> usize;
    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]);
    fn is_conservative(&self) -> bool;
    /// See [`LinkLaw::stiffest`]; of a link of this rest length.
    fn stiffest(&self, rest: f64) -> f64;
    /// The same of pairs of a crowd, taken to come as near as half its range: what is stiffer nearer by is not seen.
    fn stiffest_within(&self, range: f64) -> f64 {
        self.stiffest(range)
    }
    /// Beyond it there is no force [m]; infinite where there always is, or nobody can tell.
    fn range(&self) -> f64 {
        f64::INFINITY
    }
    /// See [`LinkLaw::rest_distance`].
    fn rest_distance(&self) -> Option<f64> {
        None
    }
    /// What holds a link together.
    fn state(&self, reach: &Reach, memory: &[f64]) -> LinkState;
    /// `sums[row] += f` over the rows of a part.
    fn add_forces(&self, part: &Part, moving: Moving, memory: &[f64], sums: &mut [Vec3]);
    /// Forces on first ends, `[block][lane]`.
    fn forces(&self, part: &Part, moving: Moving, memory: &[f64], out: &mut [Vec3]);
    /// Moves `memory` of a part's links on by a step; gives the heat of that [J].
    fn advance(&self, part: &Part, moving: Moving, memory: &mut [f64]) -> f64;
    /// `sums[row] += f·a` over the rows of a part, along an axis `a`.
    fn add_pushes(&self, part: &Part, on_axis: OnAxis<Known>, memory: &[f64], sums: &mut [f64]);
    /// [`LinkKernel::forces`] along an axis.
    fn pushes(&self, part: &Part, on_axis: OnAxis<Known>, memory: &[f64], out: &mut [f64]);
    /// [`LinkKernel::advance`] along an axis.
    fn advance_along(&self, part: &Part, on_axis: OnAxis<Projected>, memory: &mut [f64]) -> f64;
    /// Force and energy of one link; `memory` becomes that of the next step.
    fn respond_and_remember(&self, reach: &Reach, moment: &Moment, memory: &mut [f64]) -> Response;
    /// The same without a next step.
    fn respond(&self, reach: &Reach, moment: &Moment, memory: &[f64]) -> Response {
        let (mut numbers, len) = ([0.0; WRITTEN_MEMORY], self.memory_len());
        numbers[..len].copy_from_slice(&memory[..len]);
        self.respond_and_remember(reach, moment, &mut numbers[..len])
    }
    /// The same of many links of one rest length, of a law without memory: pushes [N] and heats [J] over lengths now and a step
    /// before [m]. All slices are whole blocks of eight.
    fn respond_to_many(
        &self,
        rest: f64,
        time: f64,
        [lengths, before]: [&[f64]; 2],
        [pushes, heats]: [&mut [f64]; 2],
    ) {
        let ways = lengths.iter().zip(before).zip(pushes).zip(heats);
        for (((length, before), push), heat) in ways {
            let reach = Reach { length: *length, before: *before, rest };
            let response = self.respond(&reach, &Moment::of(time), &[]);
            (*push, *heat) = (response.push, response.heat);
        }
    }
    /// `∂φ/∂D` and `∂φ/∂D^r` of one link [N/m].
    fn slopes(&self, reach: &Reach, moment: &Moment, memory: &[f64]) -> [f64; 2];

    /// Whether the law asks where ends are.
    fn asks_for(&self) -> AsksFor {
        AsksFor::default()
    }
    /// Numbers of its entry that say what links begin with and nothing later: there is nothing in them to drive.
    fn begins_with(&self) -> &[&'static str] {
        &[]
    }
    /// Names of the parameters that it keeps in place: driven, the law is not made anew ([`super::DrivenLaw`]).
    fn registers(&self) -> Vec<&str> {
        Vec::new()
    }
    /// Lends the law with other values in registers.
    fn driven(&self, values: &[(usize, f64)], act: &mut dyn FnMut(&dyn LinkKernel));
}

/// [`LinkKernel`] of a law in lanes.
///
/// No closures over lanes here: what is not inlined is not compiled for the processor's instructions.
#[derive(Debug)]
pub struct InLanes<L>(pub L);

impl<L: LinkLaw> InLanes<L> {
    fn numbers<R: Real>(&self, memory: &[f64], constant: impl Fn(f64) -> R) -> [R; MEMORY] {
        std::array::from_fn(|i| constant(memory.get(i).copied().unwrap_or(0.0)))
    }
}

impl<L: LinkLaw> LinkKernel for InLanes<L> {
    fn memory_len(&self) -> usize {
        self.0.memory_len()
    }

    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        self.0.begin(rest, length, memory);
    }

    fn is_conservative(&self) -> bool {
        self.0.is_conservative()
    }

    fn stiffest(&self, _: f64) -> f64 {
        self.0.stiffest()
    }

    fn range(&self) -> f64 {
        self.0.range()
    }

    fn rest_distance(&self) -> Option<f64> {
        self.0.rest_distance()
    }

    fn state(&self, reach: &Reach, memory: &[f64]) -> LinkState {
        if reach.length < self.0.range() { self.0.state(reach.rest, memory) } else { LinkState::Apart }
    }

    fn add_forces(&self, part: &Part, moving: Moving, memory: &[f64], sums: &mut [Vec3]) {
        Arch::new().dispatch(Forces::<_, _, true> { law: &self.0, part, rows: moving, memory, out: sums });
    }

    fn forces(&self, part: &Part, moving: Moving, memory: &[f64], out: &mut [Vec3]) {
        Arch::new().dispatch(Forces::<_, _, false> { law: &self.0, part, rows: moving, memory, out });
    }

    fn advance(&self, part: &Part, moving: Moving, memory: &mut [f64]) -> f64 {
        Arch::new().dispatch(Advance { law: &self.0, part, rows: moving, memory })
    }

    fn add_pushes(&self, part: &Part, on_axis: OnAxis<Known>, memory: &[f64], sums: &mut [f64]) {
        Arch::new().dispatch(Forces::<_, _, true> { law: &self.0, part, rows: on_axis, memory, out: sums });
    }

    fn pushes(&self, part: &Part, on_axis: OnAxis<Known>, memory: &[f64], out: &mut [f64]) {
        Arch::new().dispatch(Forces::<_, _, false> { law: &self.0, part, rows: on_axis, memory, out });
    }

    fn advance_along(&self, part: &Part, on_axis: OnAxis<Projected>, memory: &mut [f64]) -> f64 {
        Arch::new().dispatch(Advance { law: &self.0, part, rows: on_axis, memory })
    }

    fn respond_and_remember(&self, reach: &Reach, _: &Moment, memory: &mut [f64]) -> Response {
        let mut numbers = self.numbers(memory, |number| number);
        let response = self.0.respond(reach, &mut numbers);
        let len = self.0.memory_len();
        memory[..len].copy_from_slice(&numbers[..len]);
        response
    }

    fn respond_to_many(
        &self,
        rest: f64,
        _: f64,
        [lengths, before]: [&[f64]; 2],
        [pushes, heats]: [&mut [f64]; 2],
    ) {
        Arch::new().dispatch(Many { law: &self.0, rest, lengths, before, pushes, heats });
    }

    fn slopes(&self, reach: &Reach, _: &Moment, memory: &[f64]) -> [f64; 2] {
        [(1.0, 0.0), (0.0, 1.0)].map(|(now, before)| {
            let reach = Reach {
                length: Dual::new(reach.length, now),
                before: Dual::new(reach.before, before),
                rest: Dual::constant(reach.rest),
            };
            self.0.respond(&reach, &mut self.numbers(memory, Dual::constant)).push.derivative
        })
    }

    fn driven(&self, _: &[(usize, f64)], act: &mut dyn FnMut(&dyn LinkKernel)) {
        act(self);
    }
}

/// Straight blocks whose forces stand side by side before they are summed.
const SUMMED_TOGETHER: usize = 16;

/// A register's worth of links: lanes `lane .. lane + S::F64_LANES` of a block.
pub(super) struct Group<'a, S: Simd> {
    pub simd: S,
    part: &'a Part,
    block: usize,
    lane: usize,
}

/// How the links of a group stand.
pub(super) struct Stance<S: Simd, A> {
    pub reach: Reach<Lanes<S>>,
    /// What pushes are along, of this size: `P1 - P2`, or that of the step before where the ends coincide [m].
    pub along: A,
    pub size: Lanes<S>,
}

impl<'a, S: Simd> Group<'a, S> {
    /// Places of first or second ends among the rows of the part: below `row_count` (`Part::new`).
    #[inline(always)]
    pub fn ends(&self, end: usize) -> &'a [u32] {
        let ends = self.part.ends(self.block);
        &ends[end * LANES + self.lane..end * LANES + self.lane + S::F64_LANES]
    }

    /// Places of the group's first links' ends, of a straight block: those of the others follow.
    #[inline(always)]
    pub fn first_ends(&self) -> [usize; 2] {
        [0, 1].map(|end| self.ends(end)[0] as usize)
    }

    #[inline(always)]
    fn load(&self, numbers: &[f64]) -> Lanes<S> {
        Lanes::load(self.simd, &numbers[self.lane..self.lane + S::F64_LANES])
    }

    /// Rest lengths [m].
    #[inline(always)]
    pub fn rest(&self) -> Lanes<S> {
        self.load(self.part.rest(self.block))
    }

    /// One in lanes with a link, zero in the others.
    #[inline(always)]
    pub fn present(&self) -> Lanes<S> {
        let mut present = Lanes::constant(self.simd, 1.0);
        if self.block >= self.part.full_blocks() {
            for (lane, one) in present.as_mut_slice().iter_mut().enumerate() {
                if self.ends(0)[lane] == self.ends(1)[lane] {
                    *one = 0.0;
                }
            }
        }
        present
    }

    /// The group's numbers of a memory `[number][lane]` of its block.
    #[inline(always)]
    fn memory(&self, numbers: &[f64], len: usize) -> [Lanes<S>; MEMORY] {
        let mut out = [Lanes::constant(self.simd, 0.0); MEMORY];
        for i in 0..len {
            out[i] = self.load(&numbers[i * LANES..(i + 1) * LANES]);
        }
        out
    }
}

/// Adds forces to both ends (`ADDS`), or writes those on first ends link by link.
struct Forces<'a, L, B: Between, const ADDS: bool> {
    law: &'a L,
    part: &'a Part,
    rows: B,
    memory: &'a [f64],
    out: &'a mut [B::Load],
}

impl<L: LinkLaw, B: Between, const ADDS: bool> WithSimd for Forces<'_, L, B, ADDS> {
    type Output = ();

    // F1 = φ u = -F2
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { law, part, rows, memory, out } = self;
        let rows = rows.of_part(part);
        let len = law.memory_len();
        if ADDS {
            assert!(out.len() == rows.row_count(), "a sum for each row of the part");
        }
        let straight = if ADDS { part.straight_blocks() } else { 0 };
        for first in (0..straight).step_by(SUMMED_TOGETHER) {
            let blocks = first..(first + SUMMED_TOGETHER).min(straight);
            let mut loads = [[B::Load::default(); LANES]; SUMMED_TOGETHER];
            for (block, loads) in blocks.clone().zip(&mut loads) {
                let numbers = &memory[block * len * LANES..(block + 1) * len * LANES];
                let mut lane = 0;
                while lane < LANES {
                    let group = Group { simd, part, block, lane };
                    let stance = rows.straight_stance(&group);
                    let mut memory = group.memory(numbers, len);
                    let push = law.respond(&stance.reach, &mut memory).push;
                    B::unpack(&group, B::loads(&stance, push), &mut loads[lane..lane + S::F64_LANES]);
                    lane += S::F64_LANES;
                }
            }
            // first ends, then second ones: what is stored for one block is not read again for the next at once
            for (block, loads) in blocks.clone().zip(&loads) {
                let first = part.ends(block)[0] as usize;
                for (sum, load) in out[first..first + LANES].iter_mut().zip(loads) {
                    *sum += *load;
                }
            }
            for (block, loads) in blocks.zip(&loads) {
                let first = part.ends(block)[LANES] as usize;
                for (sum, load) in out[first..first + LANES].iter_mut().zip(loads) {
                    *sum -= *load;
                }
            }
        }
        for block in straight..part.block_count() {
            let numbers = &memory[block * len * LANES..(block + 1) * len * LANES];
            let mut lane = 0;
            while lane < LANES {
                let group = Group { simd, part, block, lane };
                let stance = rows.stance(&group);
                let mut memory = group.memory(numbers, len);
                let push = law.respond(&stance.reach, &mut memory).push;
                let loads = B::loads(&stance, push);
                if ADDS {
                    // SAFETY: there are as many sums as rows
                    unsafe { B::scatter(&group, loads, out) };
                } else {
                    let first = block * LANES + lane;
                    B::unpack(&group, loads, &mut out[first..first + S::F64_LANES]);
                }
                lane += S::F64_LANES;
            }
        }
    }
}

/// What a law without memory says of many links.
struct Many<'a, L> {
    law: &'a L,
    rest: f64,
    lengths: &'a [f64],
    before: &'a [f64],
    pushes: &'a mut [f64],
    heats: &'a mut [f64],
}

impl<L: LinkLaw> WithSimd for Many<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { law, rest, lengths, before, pushes, heats } = self;
        let rest = Lanes::constant(simd, rest);
        let mut memory = [Lanes::constant(simd, 0.0); MEMORY];
        for first in (0..lengths.len()).step_by(S::F64_LANES) {
            let own = first..first + S::F64_LANES;
            let (length, before) =
                (Lanes::load(simd, &lengths[own.clone()]), Lanes::load(simd, &before[own.clone()]));
            let response = law.respond(&Reach { length, before, rest }, &mut memory);
            response.push.store(&mut pushes[own.clone()]);
            response.heat.store(&mut heats[own]);
        }
    }
}

struct Advance<'a, L, B: Between> {
    law: &'a L,
    part: &'a Part,
    rows: B,
    memory: &'a mut [f64],
}

impl<L: LinkLaw, B: Between> WithSimd for Advance<'_, L, B> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { law, part, rows, memory } = self;
        let rows = rows.of_part(part);
        let len = law.memory_len();
        let mut heat = [0.0; LANES];
        for block in 0..part.block_count() {
            let numbers = &mut memory[block * len * LANES..(block + 1) * len * LANES];
            let mut lane = 0;
            while lane < LANES {
                let group = Group { simd, part, block, lane };
                let stance = rows.stance(&group);
                let mut memory = group.memory(numbers, len);
                let response = law.respond(&stance.reach, &mut memory);
                for i in 0..len {
                    memory[i].store(&mut numbers[i * LANES + lane..i * LANES + lane + S::F64_LANES]);
                }
                let sum = group.load(&heat) + stance.directed(response.heat);
                sum.store(&mut heat[lane..lane + S::F64_LANES]);
                lane += S::F64_LANES;
            }
        }
        heat.iter().sum()
    }
}
