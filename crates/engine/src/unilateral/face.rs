//! Forces on the face of what forces may be that sweeps have found, by conjugate gradients.
//!
//! Sweeps find soon which contacts bear, stick and slide, and slowly what a long chain of bodies bears with: each hands a change on to the next. With these
//! sets held, forces are those with the least `½ δ·D δ + off·δ`, which conjugate gradients find in as many products with `D` as bodies have degrees
//! of freedom. They go as far as forces stay what they may be; what comes to a limit is held there, and the search goes on
//! without it (Dostál 1997). Of contacts that slide the friction is held too. `D` has directions in which it resists nothing, where more contacts bear than
//! are needed: gradients have no share of these but for what contacts contradict each other by, along which it is gone to the next limit. Sweeps then
//! let go of limits what is pushed from them, and alone tell whether forces are found (Silcowitz-Hansen, Niebe & Erleben 2010).

use souple_math::Vec3;

use super::ContactSystem;
use super::places::Law;

/// What of a force may change on a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Free {
    /// It is nothing, or at its limit.
    Nothing,
    /// Along the normal: nothing rubs, or it slides.
    Normal,
    All,
}

/// Scratch of the search on a face.
#[derive(Debug, Default)]
pub(super) struct Face {
    free: Vec<Free>,
    /// What forces are off on the face, and what they would change by if each were alone.
    residual: Vec<Vec3>,
    alone: Vec<Vec3>,
    direction: Vec<Vec3>,
    product: Vec<Vec3>,
}

/// Of what a change moves alone, what it moves in fact, where it meets no resistance but that of rounding.
const NO_RESISTANCE: f64 = 1e-13;
/// Of the greatest friction, what is less sticks.
const SLIDES: f64 = 1.0 - 1e-9;
/// Of what sweeps let be, what the search on a face does: what is left of all places comes together in one.
const WELL_BELOW: f64 = 0.2;

impl Free {
    fn part(self, of: Vec3) -> Vec3 {
        match self {
            Self::Nothing => Vec3::ZERO,
            Self::Normal => Vec3::X * of.x,
            Self::All => of,
        }
    }
}

impl Face {
    fn clear(&mut self, count: usize) {
        self.free.clear();
        for list in [&mut self.residual, &mut self.alone, &mut self.direction, &mut self.product] {
            list.clear();
            list.resize(count, Vec3::ZERO);
        }
    }

    pub(super) fn bytes(&self) -> usize {
        let vectors = [&self.residual, &self.alone, &self.direction, &self.product];
        size_of::<Vec3>() * vectors.map(Vec::capacity).iter().sum::<usize>()
            + size_of::<Free>() * self.free.capacity()
    }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

impl ContactSystem {
    /// Changes forces on the face that they are on, in so many products with `D` at most, each of which counts as a sweep.
    pub(super) fn descend(&mut self, most: u64) {
        let mut face = std::mem::take(&mut self.face);
        face.clear(self.places.len());
        face.free.extend((0..self.places.len()).map(|place| self.free_at(place)));
        let last = self.report.contact_iterations + most;
        while self.report.contact_iterations < last && self.follow(&mut face, last) {}
        self.face = face;
    }

    fn force_at(&self, place: usize) -> Vec3 {
        self.places[place].force + self.change[place]
    }

    fn free_at(&self, place: usize) -> Free {
        let force = self.force_at(place);
        let [normal, tangent] = self.stiffest[place];
        let is_free = match self.places[place].law {
            Law::Cone(_) => force.x > 0.0,
            Law::Bounds(limit) => force.x.abs() < limit,
        };
        match self.places[place].law {
            _ if !is_free || normal <= 0.0 => Free::Nothing,
            Law::Cone(friction) if tangent > 0.0 && force.y.hypot(force.z) < SLIDES * friction * force.x => {
                Free::All
            }
            _ => Free::Normal,
        }
    }

    /// Goes on with conjugate gradients until the face is left at a limit, which is then held; false where it has come to its end.
    fn follow(&mut self, face: &mut Face, last: u64) -> bool {
        self.report.contact_iterations += 1;
        for place in 0..self.places.len() {
            let off = self.off[place] + self.moved(place, &self.change);
            face.residual[place] = face.free[place].part(-off);
            face.alone[place] = self.alone(place, face.residual[place]);
        }
        face.direction.copy_from_slice(&face.alone);
        let mut size = dot(&face.residual, &face.alone);
        while !self.is_found(face) && self.report.contact_iterations < last {
            self.report.contact_iterations += 1;
            for place in 0..self.places.len() {
                face.product[place] = face.free[place].part(self.moved(place, &face.direction));
            }
            let resistance = dot(&face.direction, &face.product);
            let unresisted = resistance <= NO_RESISTANCE * self.resistance_alone(&face.direction);
            let wanted = if unresisted { f64::INFINITY } else { size / resistance };
            let limit = self.first_limit(face);
            let way = limit.map_or(wanted, |(way, ..)| way.min(wanted));
            if !way.is_finite() {
                return false;
            }
            for place in 0..self.places.len() {
                self.change[place] += face.direction[place] * way;
            }
            if let Some((_, place, left)) = limit.filter(|(at, ..)| *at <= wanted) {
                self.hold(face, place, left);
                return true;
            }
            for place in 0..self.places.len() {
                face.residual[place] -= face.product[place] * way;
                face.alone[place] = self.alone(place, face.residual[place]);
            }
            let size_before = std::mem::replace(&mut size, dot(&face.residual, &face.alone));
            for place in 0..self.places.len() {
                face.direction[place] = face.alone[place] + face.direction[place] * (size / size_before);
            }
        }
        false
    }

    /// What force at a place would bring its own gap and slip to where they are to be.
    fn alone(&self, place: usize, off: Vec3) -> Vec3 {
        let [normal, tangent] = self.stiffest[place].map(|by| if by > 0.0 { 1.0 / by } else { 0.0 });
        Vec3::new(off.x * normal, off.y * tangent, off.z * tangent)
    }

    /// `δ·D δ` if forces moved nothing but their own places.
    fn resistance_alone(&self, change: &[Vec3]) -> f64 {
        let of_place = |(by, [normal, tangent]): (&Vec3, &[f64; 2])| {
            by.x * by.x * normal + (by.y * by.y + by.z * by.z) * tangent
        };
        change.iter().zip(&self.stiffest).map(of_place).sum()
    }

    /// Whether what is left is well below what sweeps would go on for.
    fn is_found(&self, face: &Face) -> bool {
        let is_near =
            |place: usize| self.length_of(place, face.alone[place]) <= WELL_BELOW * self.let_be(place);
        (0..self.places.len()).all(is_near)
    }

    /// How far along the direction the first force comes to a limit, at which place, and what is free there then.
    fn first_limit(&self, face: &Face) -> Option<(f64, usize, Free)> {
        let mut first: Option<(f64, usize, Free)> = None;
        for place in 0..self.places.len() {
            if face.free[place] == Free::Nothing {
                continue;
            }
            let (force, by) = (self.force_at(place), face.direction[place]);
            let mut take = |way: f64, left: Free| {
                if first.is_none_or(|(least, ..)| way < least) {
                    first = Some((way, place, left));
                }
            };
            match self.places[place].law {
                Law::Bounds(limit) if by.x != 0.0 => {
                    take((limit.copysign(by.x) - force.x) / by.x, Free::Nothing)
                }
                Law::Bounds(_) => {}
                Law::Cone(friction) => {
                    if by.x < 0.0 {
                        take(force.x / -by.x, Free::Nothing);
                    }
                    if let Some(way) =
                        way_to_cone(force, by, friction).filter(|_| face.free[place] == Free::All)
                    {
                        take(way, Free::Normal);
                    }
                }
            }
        }
        first
    }

    /// Holds a force that has come to a limit there.
    fn hold(&mut self, face: &mut Face, place: usize, left: Free) {
        face.free[place] = left;
        if left == Free::Nothing {
            let end = match self.places[place].law {
                Law::Cone(_) => Vec3::ZERO,
                Law::Bounds(limit) => Vec3::X * limit.copysign(face.direction[place].x),
            };
            self.change[place] = end - self.places[place].force;
        }
    }
}

/// How far along a direction a force that sticks comes to slide, the least root of `|f_t + a s_t|² = μ² (f_n + a s_n)²` ahead.
fn way_to_cone(force: Vec3, by: Vec3, friction: f64) -> Option<f64> {
    let square = friction * friction;
    let product = |a: Vec3, b: Vec3| a.y * b.y + a.z * b.z - square * a.x * b.x;
    let (second, first, none) = (product(by, by), product(force, by), product(force, force));
    // where there is no root it is not a number, and not ahead
    let root = (first * first - second * none).sqrt();
    let larger = -(first + root.copysign(first));
    let ways = [larger / second, none / larger];
    ways.into_iter().filter(|way| *way > 0.0).min_by(f64::total_cmp)
}
