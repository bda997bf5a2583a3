//! How far the ends of a link are apart: by their distance in space, or along an axis that the scene gives.
//!
//! Along an axis every law is one-dimensional, as the modules for sound are: places are single numbers, lengths have a sign,
//! and nothing turns. The masses are points like all others, on which other links may act too.

use std::ops::{AddAssign, SubAssign};

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Real, Vec3};

use super::kernel::{Group, Moving, Stance};
use super::law::Reach;
use super::layout::Part;

/// A link shorter than this has no direction of its own: it keeps that of the step before, and without one gives no force
/// [m].
const SHORTEST: f64 = 1e-150;

/// What the length `D` of a link is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Span {
    /// `|P1 - P2|`; forces are along `P1 - P2`.
    #[default]
    Distance,
    /// `(P1 - P2)·a`, with its sign; forces are along the unit vector `a`.
    Along(Vec3),
}

impl Span {
    /// Of ends that are so apart [m].
    pub fn length(self, apart: Vec3) -> f64 {
        match self {
            Self::Distance => apart.length(),
            Self::Along(axis) => apart.dot(axis),
        }
    }
}

/// Rows of a part as links between them read them.
pub(super) trait Between: Copy {
    /// What links add to a row.
    type Load: Copy + Default + AddAssign + SubAssign;
    /// The same of a group's first ends, side by side.
    type Loads<S: Simd>: Copy;

    /// `D` and `D^r` of a link between two rows [m], and what a push of 1 N does to the first.
    fn one(self, ends: [usize; 2]) -> (f64, f64, Self::Load);
    /// Where two rows are, now and a step before [m]; on an axis as x.
    fn both(self, ends: [usize; 2]) -> [[Vec3; 2]; 2];
    /// Whether two rows are so far apart for certain, without a square root: `D >= distance`.
    fn are_beyond(self, ends: [usize; 2], distance: f64) -> bool;
    fn scaled(load: Self::Load, push: f64) -> Self::Load;
    fn add_to(sums: &mut [Self::Load], ends: [usize; 2], load: Self::Load);

    fn stance<S: Simd>(self, group: &Group<S>) -> Stance<S, Self::Loads<S>>;
    /// The same of links of a straight block.
    #[inline(always)]
    fn straight_stance<S: Simd>(self, group: &Group<S>) -> Stance<S, Self::Loads<S>> {
        self.stance(group)
    }
    /// Of a push along the links as they stand.
    fn loads<S: Simd>(stance: &Stance<S, Self::Loads<S>>, push: Lanes<S>) -> Self::Loads<S>;
    /// # Safety
    /// There is a sum for each row of the part.
    unsafe fn scatter<S: Simd>(group: &Group<S>, loads: Self::Loads<S>, sums: &mut [Self::Load]);
    fn unpack<S: Simd>(group: &Group<S>, loads: Self::Loads<S>, out: &mut [Self::Load]);
    fn time(self) -> f64;
    /// Those of a part, of all rows.
    fn of_part(self, part: &Part) -> Self;
    fn row_count(self) -> usize;
}

impl Between for Moving<'_> {
    type Load = Vec3;
    type Loads<S: Simd> = Vec3<Lanes<S>>;

    fn one(self, [a, b]: [usize; 2]) -> (f64, f64, Vec3) {
        let d = self.positions[a] - self.positions[b];
        let e = d - (self.velocities[a] - self.velocities[b]) * self.timestep;
        (d.length(), e.length(), d.try_normalised().or(e.try_normalised()).unwrap_or(Vec3::ZERO))
    }

    fn both(self, ends: [usize; 2]) -> [[Vec3; 2]; 2] {
        ends.map(|row| {
            let place = self.positions[row];
            [place, place - self.velocities[row] * self.timestep]
        })
    }

    fn are_beyond(self, [a, b]: [usize; 2], distance: f64) -> bool {
        // a little more, so that the root of what is rounded is no less
        (self.positions[a] - self.positions[b]).length_sq() > distance * distance * (1.0 + 4.0 * f64::EPSILON)
    }

    fn scaled(direction: Vec3, push: f64) -> Vec3 {
        direction * push
    }

    fn add_to(sums: &mut [Vec3], [a, b]: [usize; 2], force: Vec3) {
        sums[a] += force;
        sums[b] -= force;
    }

    #[inline(always)]
    fn stance<S: Simd>(self, group: &Group<S>) -> Stance<S, Vec3<Lanes<S>>> {
        let (simd, to, from) = (group.simd, group.ends(0), group.ends(1));
        // SAFETY: ends are below the length of the part's rows (`Part::new`), which these are (`Part::rows_of`)
        let d = unsafe { Vec3::gather_difference(simd, self.positions, to, from) };
        // SAFETY: as above
        let w = unsafe { Vec3::gather_difference(simd, self.velocities, to, from) };
        let h = Lanes::constant(simd, -self.timestep);
        // where the ends were: X - h v
        let e = Vec3::new(w.x.mul_add(h, d.x), w.y.mul_add(h, d.y), w.z.mul_add(h, d.z));
        let length = d.z.mul_add(d.z, d.y.mul_add(d.y, d.x * d.x)).sqrt();
        let before = e.z.mul_add(e.z, e.y.mul_add(e.y, e.x * e.x)).sqrt();
        let shortest = length.splat(SHORTEST);
        let along = Vec3::new(
            length.select_less(shortest, e.x, d.x),
            length.select_less(shortest, e.y, d.y),
            length.select_less(shortest, e.z, d.z),
        );
        let known = length.select_less(shortest, before, length);
        Stance { reach: Reach { length, before, rest: group.rest() }, along, size: known }
    }

    #[inline(always)]
    fn loads<S: Simd>(stance: &Stance<S, Vec3<Lanes<S>>>, push: Lanes<S>) -> Vec3<Lanes<S>> {
        stance.along * stance.directed(push / stance.size)
    }

    #[inline(always)]
    unsafe fn scatter<S: Simd>(group: &Group<S>, forces: Vec3<Lanes<S>>, sums: &mut [Vec3]) {
        // SAFETY: ends are below the length of the part's rows (`Part::new`), as many as sums
        unsafe { forces.scatter_pair(group.simd, sums, group.ends(0), group.ends(1)) };
    }

    #[inline(always)]
    fn unpack<S: Simd>(group: &Group<S>, forces: Vec3<Lanes<S>>, out: &mut [Vec3]) {
        forces.unpack(group.simd, |lane, force| out[lane] = force);
    }

    fn time(self) -> f64 {
        self.time
    }

    fn of_part(self, part: &Part) -> Self {
        Self { positions: part.rows_of(self.positions), velocities: part.rows_of(self.velocities), ..self }
    }

    fn row_count(self) -> usize {
        self.positions.len()
    }
}

/// Where a row is along the axis, now and a step before: `(X·a, (X - h v)·a)` [m].
pub type Place = [f64; 2];

/// Places of rows along an axis.
pub trait Places: Copy {
    fn place(self, row: usize) -> Place;
    /// Differences between the ends of a group's links, which are below the number of rows.
    fn differences<S: Simd>(self, simd: S, to: &[u32], from: &[u32]) -> [Lanes<S>; 2];
    /// The same between as many rows from one on and those from another on.
    #[inline(always)]
    fn straight_differences<S: Simd>(self, simd: S, [to, from]: [usize; 2]) -> [Lanes<S>; 2] {
        let mut out = [Lanes::constant(simd, 0.0); 2];
        for lane in 0..S::F64_LANES {
            let ([a, b], [c, d]) = (self.place(to + lane), self.place(from + lane));
            out[0].as_mut_slice()[lane] = a - c;
            out[1].as_mut_slice()[lane] = b - d;
        }
        out
    }
    /// Of all rows those of a part.
    fn of_part(self, part: &Part) -> Self;
    fn row_count(self) -> usize;
}

/// Rows as they move along an axis.
#[derive(Clone, Copy, Debug)]
pub struct OnAxis<P> {
    pub places: P,
    /// [s]
    pub time: f64,
}

/// Places that are known: for many links on each row.
#[derive(Clone, Copy, Debug)]
pub struct Known<'a> {
    pub places: &'a [Place],
    /// Row of the first place.
    pub first_row: usize,
}

/// Places that are computed as they are asked for.
#[derive(Clone, Copy, Debug)]
pub struct Projected<'a> {
    pub moving: Moving<'a>,
    pub axis: Vec3,
}

impl Projected<'_> {
    /// Of all rows, in order.
    pub fn places_into(self, places: &mut [Place]) {
        Arch::new().dispatch(Placing { projected: self, places });
    }
}

/// Which axis of the world this is; `None` of one that leans.
pub fn axis_of(axis: Vec3) -> Option<usize> {
    [Vec3::X, Vec3::Y, Vec3::Z].into_iter().position(|unit| unit == axis)
}

struct Placing<'a> {
    projected: Projected<'a>,
    places: &'a mut [Place],
}

impl WithSimd for Placing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { projected: Projected { moving, axis }, places } = self;
        let Moving { positions, velocities, timestep, .. } = moving;
        let rows = positions.iter().zip(velocities).zip(places);
        // the same numbers as below, with less to read
        if let Some(only) = axis_of(axis) {
            for ((x, v), place) in rows {
                *place = [x[only], x[only] - timestep * v[only]];
            }
            return;
        }
        for ((x, v), place) in rows {
            let now = x.dot(axis);
            *place = [now, now - timestep * v.dot(axis)];
        }
    }
}

impl Places for Known<'_> {
    fn place(self, row: usize) -> Place {
        self.places[row]
    }

    #[inline(always)]
    fn differences<S: Simd>(self, simd: S, to: &[u32], from: &[u32]) -> [Lanes<S>; 2] {
        // SAFETY: ends are below the length of the part's rows (`Part::new`), which these are (`of_part`)
        unsafe { Lanes::gather_differences(simd, self.places, to, from) }
    }

    #[inline(always)]
    fn straight_differences<S: Simd>(self, simd: S, [to, from]: [usize; 2]) -> [Lanes<S>; 2] {
        let of = |first: usize| &self.places[first..first + S::F64_LANES];
        Lanes::differences_in_order(simd, of(to), of(from))
    }

    fn of_part(self, part: &Part) -> Self {
        let first = part.first_row - self.first_row;
        Self { places: &self.places[first..first + part.row_count()], first_row: part.first_row }
    }

    fn row_count(self) -> usize {
        self.places.len()
    }
}

impl Places for Projected<'_> {
    #[inline(always)]
    fn place(self, row: usize) -> Place {
        let Moving { positions, velocities, timestep, .. } = self.moving;
        let now = positions[row].dot(self.axis);
        [now, now - timestep * velocities[row].dot(self.axis)]
    }

    #[inline(always)]
    fn differences<S: Simd>(self, simd: S, to: &[u32], from: &[u32]) -> [Lanes<S>; 2] {
        let mut out = [Lanes::constant(simd, 0.0); 2];
        for lane in 0..S::F64_LANES {
            let ([a, b], [c, d]) = (self.place(to[lane] as usize), self.place(from[lane] as usize));
            out[0].as_mut_slice()[lane] = a - c;
            out[1].as_mut_slice()[lane] = b - d;
        }
        out
    }

    fn of_part(self, part: &Part) -> Self {
        Self { moving: self.moving.of_part(part), ..self }
    }

    fn row_count(self) -> usize {
        self.moving.positions.len()
    }
}

impl<P: Places> Between for OnAxis<P> {
    type Load = f64;
    type Loads<S: Simd> = Lanes<S>;

    fn one(self, ends: [usize; 2]) -> (f64, f64, f64) {
        let [[a, b], [c, d]] = ends.map(|row| self.places.place(row));
        (a - c, b - d, 1.0)
    }

    fn both(self, ends: [usize; 2]) -> [[Vec3; 2]; 2] {
        ends.map(|row| self.places.place(row).map(|place| Vec3::X * place))
    }

    fn are_beyond(self, [a, b]: [usize; 2], distance: f64) -> bool {
        self.places.place(a)[0] - self.places.place(b)[0] >= distance
    }

    fn scaled(direction: f64, push: f64) -> f64 {
        direction * push
    }

    fn add_to(sums: &mut [f64], [a, b]: [usize; 2], push: f64) {
        sums[a] += push;
        sums[b] -= push;
    }

    #[inline(always)]
    fn stance<S: Simd>(self, group: &Group<S>) -> Stance<S, Lanes<S>> {
        let [length, before] = self.places.differences(group.simd, group.ends(0), group.ends(1));
        let present = group.present();
        Stance { reach: Reach { length, before, rest: group.rest() }, along: present, size: present }
    }

    #[inline(always)]
    fn straight_stance<S: Simd>(self, group: &Group<S>) -> Stance<S, Lanes<S>> {
        let [length, before] = self.places.straight_differences(group.simd, group.first_ends());
        let present = Lanes::constant(group.simd, 1.0);
        Stance { reach: Reach { length, before, rest: group.rest() }, along: present, size: present }
    }

    #[inline(always)]
    fn loads<S: Simd>(stance: &Stance<S, Lanes<S>>, push: Lanes<S>) -> Lanes<S> {
        stance.directed(push)
    }

    #[inline(always)]
    unsafe fn scatter<S: Simd>(group: &Group<S>, pushes: Lanes<S>, sums: &mut [f64]) {
        // SAFETY: ends are below the length of the part's rows (`Part::new`), as many as sums
        unsafe { pushes.scatter_pair(sums, group.ends(0), group.ends(1)) };
    }

    #[inline(always)]
    fn unpack<S: Simd>(_: &Group<S>, pushes: Lanes<S>, out: &mut [f64]) {
        out.copy_from_slice(pushes.as_slice());
    }

    fn time(self) -> f64 {
        self.time
    }

    fn of_part(self, part: &Part) -> Self {
        Self { places: self.places.of_part(part), ..self }
    }

    fn row_count(self) -> usize {
        self.places.row_count()
    }
}

impl<S: Simd, A: Copy> Stance<S, A> {
    /// `number`, or zero where there is no direction, nor for lanes without a link.
    #[inline(always)]
    pub(super) fn directed(&self, number: Lanes<S>) -> Lanes<S> {
        self.size.select_less(number.splat(SHORTEST), number.zero(), number)
    }
}
