//! Forces on the face of what forces may be that sweeps have found, by conjugate residuals.
//!
//! Sweeps find soon which contacts bear, stick and slide, and slowly what a long chain of bodies bears with: each hands a change on to the next. With these
//! sets held, what is left is `D δ = −off`, of as many unknowns as bodies have degrees of freedom at most, and is sought by conjugate residuals, with what each
//! place resists alone as a preconditioner. They go as far as forces stay what they may be; what comes to a limit is held there, and the search goes on
//! without it (Dostál 1997). Of contacts that slide the friction is held too, at what it was: where the normal force then bears less, the next sweep
//! takes it back to its cone. Sweeps then let go of limits what is pushed from them, and alone tell whether forces are found
//! (Silcowitz-Hansen, Niebe & Erleben 2010).
//!
//! `D` has directions in which it resists nothing, where more contacts bear than are needed, and contacts may contradict each other along these: in a row of
//! bodies between walls that are a little too near no forces open all gaps. Conjugate gradients would go along such a direction ever farther the better the
//! rest is solved; conjugate residuals end where the rest is. Then a force that the contradiction takes away is taken away, with what hangs together with it: of two
//! places at different heights the lower one bears nothing. Where it adds to all forces there is no end, and nothing is done.

use souple_math::Vec3;
use souple_solve::reduce::dot;

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
    /// What gaps and slips are off on the face, what forces would change by for that if each were alone, and what that would move.
    residual: Vec<Vec3>,
    alone: Vec<Vec3>,
    moved_alone: Vec<Vec3>,
    /// What forces are changed by, what that moves, and what forces would change by for that.
    direction: Vec<Vec3>,
    product: Vec<Vec3>,
    product_alone: Vec<Vec3>,
    /// Places that hang together with one, and those whose neighbours are still to be looked at.
    together: Vec<bool>,
    waiting: Vec<u32>,
}

/// How many vectors [`Face`] has.
const VECTORS: usize = 6;
/// Of what a change moves alone, what it moves in fact, where it meets no resistance but that of rounding and of what is left of the rest.
const NO_RESISTANCE: f64 = 1e-13;
/// Of the size of all changes of forces, weighed by what they move alone, what one has in a contradiction: more than what is left of the rest may have,
/// which is the root of [`NO_RESISTANCE`] over 1e-6, 3e-4. With that a chain of a thousand bodies resists, as part of what they do alone.
const SHARE: f64 = 1e-3;
/// Of the way to where a force ends, that by which it may leave its cone before: without friction both are one place, to rounding of a root.
const APEX: f64 = 1e-7;
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
        for list in self.vectors_mut() {
            list.clear();
            list.resize(count, Vec3::ZERO);
        }
    }

    fn vectors_mut(&mut self) -> [&mut Vec<Vec3>; VECTORS] {
        let Self { residual, alone, moved_alone, direction, product, product_alone, .. } = self;
        [residual, alone, moved_alone, direction, product, product_alone]
    }

    pub(super) fn bytes(&self) -> usize {
        // they grow together, each to as many as the others
        VECTORS * size_of::<Vec3>() * self.residual.capacity()
            + size_of::<Free>() * self.free.capacity()
            + self.together.capacity()
            + 4 * self.waiting.capacity()
    }
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

    pub(super) fn force_at(&self, place: usize) -> Vec3 {
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

    /// Goes on with conjugate residuals until the face is left at a limit, which is then held; false where it has come to its end.
    fn follow(&mut self, face: &mut Face, last: u64) -> bool {
        let count = self.places.len();
        self.report.contact_iterations += 1;
        for place in 0..count {
            let off = self.off[place] + self.moved(place, &self.change);
            face.residual[place] = face.free[place].part(-off);
            face.alone[place] = self.alone(place, face.residual[place]);
        }
        face.direction.fill(Vec3::ZERO);
        face.product.fill(Vec3::ZERO);
        let mut resistance_before = f64::INFINITY;
        while !self.is_found(face) && self.report.contact_iterations < last {
            self.report.contact_iterations += 1;
            for place in 0..count {
                face.moved_alone[place] = face.free[place].part(self.moved(place, &face.alone));
            }
            let resistance = dot(&face.alone, &face.moved_alone);
            if resistance <= NO_RESISTANCE * dot(&face.residual, &face.alone) {
                return self.take_away(face);
            }
            for place in 0..count {
                let kept = resistance / resistance_before;
                face.direction[place] = face.alone[place] + face.direction[place] * kept;
                face.product[place] = face.moved_alone[place] + face.product[place] * kept;
                face.product_alone[place] = self.alone(place, face.product[place]);
            }
            resistance_before = resistance;
            let wanted = resistance / dot(&face.product, &face.product_alone);
            let limit = self.first_limit(face).filter(|(way, ..)| *way <= wanted);
            let way = limit.map_or(wanted, |(way, ..)| way);
            if !way.is_finite() {
                return false;
            }
            for place in 0..count {
                self.change[place] += face.direction[place] * way;
                face.residual[place] -= face.product[place] * way;
                face.alone[place] -= face.product_alone[place] * way;
            }
            if let Some((_, place, left)) = limit {
                self.hold(face, place, left);
                return true;
            }
        }
        false
    }

    /// Of what contacts contradict each other by, which is all that is left and meets no resistance: goes along it until a force that it takes away has
    /// come to a limit, with all that hang together with that one. False where there is none.
    fn take_away(&mut self, face: &mut Face) -> bool {
        // what is left of the rest would undo what is found of it: the way is as long as contradictions are small
        let least = SHARE * dot(&face.residual, &face.alone).sqrt();
        for (place, by) in face.direction.iter_mut().enumerate() {
            let alone = face.alone[place];
            *by = if self.weight_of(place, alone) > least { alone } else { Vec3::ZERO };
        }
        let Some((way, place, left)) = self.first_limit(face) else { return false };
        self.gather(face, place);
        for (change, by) in self.change.iter_mut().zip(&face.direction) {
            *change += *by * way;
        }
        self.hold(face, place, left);
        true
    }

    /// Keeps of the direction what hangs together with a place by others that are free: what contacts elsewhere contradict each other by is another matter.
    fn gather(&self, face: &mut Face, place: usize) {
        face.together.clear();
        face.together.resize(self.places.len(), false);
        face.together[place] = true;
        face.waiting.push(place as u32);
        while let Some(at) = face.waiting.pop() {
            let slots = self.starts[at as usize]..self.starts[at as usize + 1];
            for other in &self.columns[slots] {
                let is_known = face.free[*other as usize] == Free::Nothing
                    || std::mem::replace(&mut face.together[*other as usize], true);
                if !is_known {
                    face.waiting.push(*other);
                }
            }
        }
        for (by, together) in face.direction.iter_mut().zip(&face.together) {
            if !together {
                *by = Vec3::ZERO;
            }
        }
    }

    /// What force at a place would bring its own gap and slip to where they are to be.
    fn alone(&self, place: usize, off: Vec3) -> Vec3 {
        let [normal, tangent] = self.stiffest[place].map(|by| if by > 0.0 { 1.0 / by } else { 0.0 });
        Vec3::new(off.x * normal, off.y * tangent, off.z * tangent)
    }

    /// `√(δ·D δ)` if the change of a force moved nothing but its own place.
    fn weight_of(&self, place: usize, change: Vec3) -> f64 {
        let [normal, tangent] = self.stiffest[place];
        (change.x * change.x * normal + (change.y * change.y + change.z * change.z) * tangent).sqrt()
    }

    /// Whether what is left is well below what sweeps would go on for.
    fn is_found(&self, face: &Face) -> bool {
        let is_near =
            |place: usize| self.length_of(place, face.alone[place]) <= WELL_BELOW * self.let_be(place);
        (0..self.places.len()).all(is_near)
    }

    /// How far along the direction the first force comes to a limit, at which place, and what is free there then.
    fn first_limit(&self, face: &Face) -> Option<(f64, usize, Free)> {
        let limit_at = |place: usize| {
            let by = face.direction[place];
            if by == Vec3::ZERO {
                return None;
            }
            let force = self.force_at(place);
            let (way, left) = match self.places[place].law {
                Law::Bounds(limit) => ((limit.copysign(by.x) - force.x) / by.x, Free::Nothing),
                Law::Cone(friction) => {
                    let apex = if by.x < 0.0 { force.x / -by.x } else { f64::INFINITY };
                    let cone = way_to_cone(force, by, friction).filter(|_| face.free[place] == Free::All);
                    match cone {
                        Some(way) if way < apex * (1.0 - APEX) => (way, Free::Normal),
                        _ => (apex, Free::Nothing),
                    }
                }
            };
            // a force that sweeps or a way before has left beyond its limit is there
            (way < f64::INFINITY).then_some((way.max(0.0), place, left))
        };
        let limits = (0..self.places.len()).filter_map(limit_at);
        limits.reduce(|first, next| if next.0 < first.0 { next } else { first })
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
