//! Filling a closed shape with balls ("billage", Jimenez 1993, P2-III.2.2; specification §2.12.4).
//!
//! First a sheet of balls that touch the surface from within: places on the surface moved inward by a radius, taken in an
//! order that goes on from what stands, so that balls lie close. Then a close packing inside, which keeps clear of the sheet.
//! No two are closer than a diameter, but where gaps of the sheet are closed. What gaps are left between sheet and packing, matter closes
//! by itself when it settles.

use std::collections::{BTreeSet, HashMap, VecDeque};

use souple_math::Vec3;
use souple_mesh::BoundingBox;

use crate::contact::Shape;

/// Places that are asked about, at most.
const ASKED_MAX: f64 = 2e8;
/// Places on the surface in a diameter.
const SHEET_PITCH: f64 = 0.25;
/// Moves onto the sheet: one where the shape tells distances.
const MOVES: usize = 4;
/// Of a diameter: how finely gaps are looked for.
const FINEST: f64 = 1.0 / 256.0;
/// Of a step: what it must gain.
const LEAST_GAIN: f64 = 1e-2;
/// Of a search: it may creep along a ridge no longer.
const MOST_MOVES: usize = 256;
/// Onto the sheet below an edge, where every move is half as long as the one before if it is as sharp as 60°.
const MOVES_IN: usize = 32;
/// Of a diameter: what is less deep by so much is on the sheet.
const ON_SHEET: f64 = 1e-6;
/// Of a diameter: a ball that is put below a place is so near to it at most. In edges sharper than `2 asin(1/(2 · 0.95))` none is, 63.5°.
const OF_USE: f64 = 0.95;
/// Of a diameter: what is less far from a depth is there.
const LANDED: f64 = 1e-9;
/// How often balls are put into gaps and spread.
const ROUNDS: usize = 4;
/// In which every ball that overlaps may move once.
const SWEEPS: usize = 64;
/// Diameters about a place within which the nearest ball is looked for.
const FAR: i64 = 4;
/// Of a diameter: balls of a close packing are that far apart, but for rounding.
const NEARLY: f64 = 1.0 - 1e-9;

/// How a shape is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filling {
    /// Diameter of the balls, and distance of neighbours [m].
    pub spacing: f64,
    /// Of centres from the surface, inward [m].
    pub inset: f64,
    /// Only so deep under the surface [m]; infinite for all.
    pub depth: f64,
    /// Where centres may be.
    pub bounds: BoundingBox,
    pub gaps: Gaps,
}

/// What becomes of places on the surface where no other ball of the sheet has room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gaps {
    /// They may be up to `√5 - 1` radii from the nearest ball.
    #[default]
    Left,
    /// None is farther than a radius, where balls have room below it: they may overlap for that.
    Closed,
}

/// Where a surface is farthest from the balls below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// On the surface.
    pub place: Vec3,
    /// From there to the nearest ball's own surface [m]; no more is told than [`Self::MOST`] diameters.
    pub width: f64,
}

impl Gap {
    /// From a place to the middle of the nearest ball, in diameters, beyond which none is looked for.
    pub const MOST: f64 = FAR as f64;
}

/// Why there is no filling.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FillingError {
    #[error("no ball of this size has room in the shape")]
    NoRoom,
    #[error("about {0:.1e} places would have to be asked about, at most {max:.0e} are", max = ASKED_MAX)]
    TooMany(f64),
}

impl Filling {
    /// Centres of balls within a shape, the sheet first; the same for the same shape always.
    ///
    /// # Errors
    /// The balls are too large for the shape, or too small for the box.
    pub fn fill(&self, shape: &dyn Shape) -> Result<Vec<Vec3>, FillingError> {
        let pitch = SHEET_PITCH * self.spacing;
        let size = self.bounds.size().to_array();
        // along one axis places are skipped by their distance
        let asked: f64 = size[..2].iter().map(|side| side / pitch + 1.0).product::<f64>()
            + size.iter().map(|side| side / self.spacing + 1.0).product::<f64>();
        if asked.is_nan() || asked > ASKED_MAX {
            return Err(FillingError::TooMany(asked));
        }
        let mut balls = self.sheet(shape, pitch);
        if self.gaps == Gaps::Closed {
            self.close_gaps(shape, pitch, &mut balls);
        }
        self.pack(shape, &mut balls);
        if balls.places.is_empty() { Err(FillingError::NoRoom) } else { Ok(balls.places) }
    }

    /// The place of the surface that is farthest from all balls, of places a quarter of a diameter apart and from the widest of them on
    /// uphill; `None` where no surface is within the bounds.
    pub fn widest_gap(&self, shape: &dyn Shape, places: &[Vec3]) -> Option<Gap> {
        self.widest_gap_of(shape, &self.surface_places(shape), places)
    }

    /// Places of the surface, a quarter of a diameter apart.
    pub fn surface_places(&self, shape: &dyn Shape) -> Vec<Vec3> {
        Self { inset: 0.0, ..*self }.candidates(shape, SHEET_PITCH * self.spacing)
    }

    /// The widest gap where the places of the surface are known.
    pub fn widest_gap_of(&self, shape: &dyn Shape, surface: &[Vec3], places: &[Vec3]) -> Option<Gap> {
        let mut balls = Balls::new(self.spacing);
        places.iter().for_each(|place| balls.put(*place));
        let seeds = surface.iter().map(|place| (balls.clearance(*place), *place));
        let (_, seed) = seeds.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let on_surface = Self { inset: 0.0, ..*self };
        let pitch = SHEET_PITCH * self.spacing;
        let (apart, place) =
            on_surface.widest_near(shape, (seed, pitch), 0.0, |place| balls.clearance(place));
        Some(Gap { place, width: apart - 0.5 * self.spacing })
    }

    /// Balls at the depth of the inset.
    fn sheet(&self, shape: &dyn Shape, pitch: f64) -> Balls {
        let candidates = self.candidates(shape, pitch);
        let mut near = Cells::new(self.spacing);
        candidates.iter().enumerate().for_each(|(index, place)| near.add(*place, index as u32));
        let mut balls = Balls::new(self.spacing);
        let mut front = VecDeque::new();
        for seed in &candidates {
            if !balls.add(*seed) {
                continue;
            }
            front.push_back(*seed);
            while let Some(ball) = front.pop_front() {
                // those that touch it first
                let mut around: Vec<(f64, u32)> = Vec::new();
                near.visit(ball, 2, |index| {
                    let apart = (candidates[index as usize] - ball).length();
                    if (NEARLY..1.5).contains(&(apart / self.spacing)) {
                        around.push((apart, index));
                    }
                });
                around.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
                for (_, index) in around {
                    let place = candidates[index as usize];
                    if balls.add(place) {
                        front.push_back(place);
                    }
                }
            }
        }
        balls
    }

    /// Puts balls at the depth of the inset below whatever places of the surface are farther than a radius from all balls, and lets those that
    /// overlap then spread, till no place is. Above a place of a flat sheet that is `a R` from the nearest of its balls the surface is
    /// `√(1 + a²) - 1` radii from it: what is put there is `√3 R` from others at least, before it spreads.
    fn close_gaps(&self, shape: &dyn Shape, pitch: f64, balls: &mut Balls) {
        // deeper than they reach
        if self.inset > OF_USE * self.spacing {
            return;
        }
        let mut places = Places::new(self.spacing);
        self.surface_places(shape).into_iter().for_each(|place| places.put(place));
        // places of the surface near what has changed
        let mut changed = None;
        for _ in 0..ROUNDS {
            let first = balls.places.len();
            self.cover(shape, pitch, &places.places, changed.as_ref(), balls);
            if balls.places.len() == first {
                return;
            }
            changed = Some(self.spread(shape, pitch, &places, first, balls));
        }
        self.cover(shape, pitch, &places.places, changed.as_ref(), balls);
    }

    /// A ball below every place of the surface that is farther than a radius from all balls, the widest first; below those alone that are
    /// two diameters at most from balls that have changed, where these are given.
    fn cover(
        &self,
        shape: &dyn Shape,
        pitch: f64,
        places: &[Vec3],
        changed: Option<&Balls>,
        balls: &mut Balls,
    ) {
        let surface = Self { inset: 0.0, ..*self };
        let is_near = |place: &&Vec3| {
            let mut is_near = changed.is_none();
            if let Some(changed) = changed {
                changed.visit(**place, 1, |_, _| is_near = true);
            }
            is_near
        };
        let mut seeds: Vec<(f64, Vec3)> = places
            .iter()
            .filter(is_near)
            .map(|place| (balls.room(*place), *place))
            // the widest is within a pitch of one that was looked at
            .filter(|(apart, _)| *apart > self.spacing - pitch)
            .collect();
        seeds.sort_by(|a, b| b.0.total_cmp(&a.0));
        // where no ball came, or none was missing: those that begin beside it would end there too
        let mut ends = Places::new(self.spacing);
        for (_, seed) in seeds {
            let mut is_known = balls.room(seed) <= self.spacing - pitch;
            ends.visit(seed, 1, |_, end| is_known |= (end - seed).length() < pitch);
            if is_known {
                continue;
            }
            loop {
                let (apart, place) =
                    surface.widest_near(shape, (seed, pitch), self.spacing, |place| balls.room(place));
                let ball = (apart > self.spacing).then(|| self.below(shape, place)).flatten();
                match ball {
                    Some(ball) if (ball - place).length() <= OF_USE * self.spacing => balls.put(ball),
                    _ => {
                        ends.put(place);
                        break;
                    }
                }
            }
        }
    }

    /// Where balls are put below a place of the surface; `None` where it is too thin for them, or too sharp.
    fn below(&self, shape: &dyn Shape, place: Vec3) -> Option<Vec3> {
        let BoundingBox { low, high } = self.bounds;
        let mut ball = place.max_components(low).min_components(high);
        for _ in 0..MOVES_IN {
            let nearest = shape.nearest(ball, f64::INFINITY)?;
            let missing = nearest.distance + self.inset;
            if missing <= ON_SHEET * self.spacing {
                return Some(ball);
            }
            ball = (ball - nearest.normal * missing).max_components(low).min_components(high);
        }
        None
    }

    /// Balls that overlap move apart, one by one, the surface being a wall to them: by so much as makes their overlaps smaller
    /// and leaves covered what they covered. Those that are new or have moved.
    fn spread(
        &self,
        shape: &dyn Shape,
        pitch: f64,
        places: &Places,
        first: usize,
        balls: &mut Balls,
    ) -> Balls {
        // the widest place between others is hardly farther than they, but for this
        let covered = self.spacing - 0.25 * pitch;
        let mut changed: BTreeSet<u32> = (first..balls.places.len()).map(|ball| ball as u32).collect();
        let mut active: BTreeSet<u32> = (first..balls.places.len()).map(|ball| ball as u32).collect();
        for ball in first..balls.places.len() {
            balls.visit_overlapping(ball as u32, balls.places[ball], |other, _| {
                active.insert(other);
            });
        }
        for _ in 0..SWEEPS {
            let mut next = BTreeSet::new();
            for ball in active {
                let from = balls.places[ball as usize];
                let (mut push, mut overlap) = (Vec3::ZERO, 0.0);
                balls.visit_overlapping(ball, from, |other, apart| {
                    let away = from - balls.places[other as usize];
                    let way = away.try_normalised().unwrap_or(Vec3::AXES[other as usize % 3]);
                    push += way * (self.spacing - apart);
                    overlap += (self.spacing - apart).powi(2);
                });
                if overlap <= (ON_SHEET * self.spacing).powi(2) {
                    continue;
                }
                let moved = [1.0, 0.5, 0.25, 0.125].into_iter().find_map(|share| {
                    let to = self.below(shape, from + push * share)?;
                    // shells are no thicker for it
                    if !self.is_inside(shape, to, -ON_SHEET * self.spacing) {
                        return None;
                    }
                    let mut left = 0.0;
                    balls.visit_overlapping(ball, to, |_, apart| left += (self.spacing - apart).powi(2));
                    let gains = left < overlap * (1.0 - LEAST_GAIN);
                    (gains && self.stays_covered(places, ball, to, covered, balls)).then_some(to)
                });
                if let Some(to) = moved {
                    balls.shift(ball, to);
                    changed.insert(ball);
                    next.insert(ball);
                    balls.visit_overlapping(ball, to, |other, _| {
                        next.insert(other);
                    });
                }
            }
            active = next;
        }
        // cells as wide as two diameters
        let mut near = Balls::new(2.0 * self.spacing);
        changed.into_iter().for_each(|ball| near.put(balls.places[ball as usize]));
        near
    }

    /// Whether no place that is covered, or is less well than it should be, would be farther from all balls with one of them moved.
    fn stays_covered(&self, places: &Places, ball: u32, to: Vec3, covered: f64, balls: &Balls) -> bool {
        let from = balls.places[ball as usize];
        let mut stays = true;
        places.visit(from, 1, |_, place| {
            let (before, after) = ((place - from).length(), (place - to).length());
            if stays && before <= self.spacing && after > covered.max(before) {
                let mut others = f64::INFINITY;
                balls.visit(place, 1, |other, at| {
                    if other != ball {
                        others = others.min((at - place).length());
                    }
                });
                stays = others <= covered.max(before);
            }
        });
        stays
    }

    /// The place of the sheet near a place of it that is farthest from all balls, and how far: up the slope of the distance,
    /// by ever shorter steps, till what is left of them leads to no more than `least`.
    fn widest_near(
        &self,
        shape: &dyn Shape,
        (seed, pitch): (Vec3, f64),
        least: f64,
        distance: impl Fn(Vec3) -> f64,
    ) -> (f64, Vec3) {
        let (mut best, mut step) = ((distance(seed), seed), pitch);
        let mut moves = 0;
        while step > FINEST * self.spacing && moves < MOST_MOVES {
            // where a step gains nothing in any direction, halves of it hardly come farther than twice its diagonal
            if best.0 + 4.0 * 3.0_f64.sqrt() * step < least {
                break;
            }
            moves += 1;
            let around = (0..27).map(|n| {
                Vec3::new((n % 3) as f64, (n / 3 % 3) as f64, (n / 9) as f64) - Vec3::new(1.0, 1.0, 1.0)
            });
            let tried = around.filter_map(|way| {
                let place = self.landed(shape, best.1 + way * step)?;
                // no farther from where it began than the next candidates are
                ((place - seed).length() <= 2.0 * pitch).then(|| (distance(place), place))
            });
            match tried.max_by(|a, b| a.0.total_cmp(&b.0)) {
                // what gains next to nothing for its length would creep along ridges for ever
                Some(better) if better.0 > best.0 + LEAST_GAIN * step => best = better,
                _ => step *= 0.5,
            }
        }
        best
    }

    /// Places at the depth of the inset, closer to each other than balls are.
    fn candidates(&self, shape: &dyn Shape, pitch: f64) -> Vec<Vec3> {
        let mut found = Vec::new();
        let BoundingBox { low, high } = self.bounds;
        let counts = self.bounds.size().to_array().map(|side| (side / pitch).floor() as usize);
        for (i, j) in (0..=counts[0]).flat_map(|i| (0..=counts[1]).map(move |j| (i, j))) {
            let mut k = 0;
            while k <= counts[2] {
                let start = low + Vec3::new(i as f64, j as f64, k as f64) * pitch;
                let Some(nearest) = shape.nearest(start, f64::INFINITY) else { break };
                let away = (nearest.distance + self.inset).abs();
                if away > pitch {
                    // distances change no faster than places
                    k += ((away / pitch) as usize).max(1);
                    continue;
                }
                k += 1;
                if let Some(place) = self.moved(shape, start)
                    && (place - start).length() <= 2.0 * pitch
                {
                    found.push(place.max_components(low).min_components(high));
                }
            }
        }
        // those that the box cut are as deep as they may
        found.retain(|place| self.is_inside(shape, *place, -ON_SHEET * self.spacing));
        found
    }

    /// A place moved along the normal to the depth of the inset.
    fn moved(&self, shape: &dyn Shape, start: Vec3) -> Option<Vec3> {
        let mut place = start;
        for _ in 0..MOVES {
            let nearest = shape.nearest(place, f64::INFINITY)?;
            place -= nearest.normal * (nearest.distance + self.inset);
        }
        place.is_finite().then_some(place)
    }

    /// The same within the bounds, as soon as it is as deep; `None` of what is not so in the end, or deeper than is asked for.
    fn landed(&self, shape: &dyn Shape, start: Vec3) -> Option<Vec3> {
        let BoundingBox { low, high } = self.bounds;
        let mut place = start.max_components(low).min_components(high);
        for _ in 0..=MOVES {
            let nearest = shape.nearest(place, f64::INFINITY)?;
            let missing = nearest.distance + self.inset;
            if missing.abs() <= LANDED * self.spacing {
                return Some(place);
            }
            place = (place - nearest.normal * missing).max_components(low).min_components(high);
        }
        // what the bounds cut is as deep as it may be
        self.is_inside(shape, place, -ON_SHEET * self.spacing).then_some(place)
    }

    fn is_inside(&self, shape: &dyn Shape, place: Vec3, margin: f64) -> bool {
        shape.nearest(place, f64::INFINITY).is_some_and(|nearest| {
            nearest.distance <= -self.inset - margin && nearest.distance >= -self.depth - self.inset
        })
    }

    /// Layers of hexagonal rows, one above the other: rows along x, side by side along z, layers along y, so that a flat box
    /// holds the densest packing of a plane.
    fn pack(&self, shape: &dyn Shape, balls: &mut Balls) {
        let BoundingBox { low, high } = self.bounds;
        let (row, layer) = (0.75_f64.sqrt() * self.spacing, (2.0_f64 / 3.0).sqrt() * self.spacing);
        let count = |side: f64, step: f64| (side / step + 1e-9).floor() as usize;
        let size = self.bounds.size();
        for j in 0..=count(size.y, layer) {
            let odd_layer = (j % 2) as f64;
            for k in 0..=count(size.z, row) {
                let odd_row = (k % 2) as f64;
                // hollows of the layer below
                let shift = Vec3::new(0.5 * (odd_row + odd_layer) % 1.0, 0.0, 0.0) * self.spacing;
                let across = Vec3::new(0.0, j as f64 * layer, k as f64 * row + odd_layer * row / 3.0);
                for i in 0..=count(size.x, self.spacing) {
                    let place = low + shift + across + Vec3::new(i as f64 * self.spacing, 0.0, 0.0);
                    let is_in =
                        place.x <= high.x + 1e-9 * self.spacing && place.z <= high.z + 1e-9 * self.spacing;
                    if is_in && self.is_inside(shape, place, 0.0) {
                        balls.add(place);
                    }
                }
            }
        }
    }
}

/// Numbers by the cells of a grid.
struct Cells {
    size: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
}

impl Cells {
    fn new(size: f64) -> Self {
        Self { size, cells: HashMap::new() }
    }

    fn cell(&self, place: Vec3) -> [i64; 3] {
        place.to_array().map(|x| (x / self.size).floor() as i64)
    }

    fn add(&mut self, place: Vec3, number: u32) {
        self.cells.entry(self.cell(place)).or_default().push(number);
    }

    fn remove(&mut self, place: Vec3, number: u32) {
        if let Some(numbers) = self.cells.get_mut(&self.cell(place)) {
            numbers.retain(|other| *other != number);
        }
    }

    /// Those in cells at most `reach` from that of a place.
    fn visit(&self, place: Vec3, reach: i64, mut visit: impl FnMut(u32)) {
        let [x, y, z] = self.cell(place);
        for (i, j, k) in (-reach..=reach)
            .flat_map(|i| (-reach..=reach).flat_map(move |j| (-reach..=reach).map(move |k| (i, j, k))))
        {
            self.cells.get(&[x + i, y + j, z + k]).into_iter().flatten().for_each(|number| visit(*number));
        }
    }
}

/// Places that are looked for by where they are: middles of balls, or what these are to cover.
struct Places {
    places: Vec<Vec3>,
    cells: Cells,
}

type Balls = Places;

impl Places {
    fn new(spacing: f64) -> Self {
        Self { places: Vec::new(), cells: Cells::new(spacing) }
    }

    /// Those in cells at most `reach` from that of a place, with their numbers.
    fn visit(&self, place: Vec3, reach: i64, mut visit: impl FnMut(u32, Vec3)) {
        self.cells.visit(place, reach, |number| visit(number, self.places[number as usize]));
    }

    /// The other balls that are nearer than a diameter to a place of one, with how far they are.
    fn visit_overlapping(&self, ball: u32, place: Vec3, mut visit: impl FnMut(u32, f64)) {
        self.visit(place, 1, |other, at| {
            let apart = (at - place).length();
            if other != ball && apart < self.cells.size {
                visit(other, apart);
            }
        });
    }

    /// From the nearest ball; two diameters at most.
    fn room(&self, place: Vec3) -> f64 {
        self.nearest(place, 2)
    }

    /// From the nearest ball; [`FAR`] diameters at most.
    fn clearance(&self, place: Vec3) -> f64 {
        self.nearest(place, FAR)
    }

    /// From the nearest ball; so many diameters at most.
    fn nearest(&self, place: Vec3, most: i64) -> f64 {
        let mut reach = 1;
        loop {
            let mut least = reach as f64 * self.cells.size;
            let within = least;
            self.visit(place, reach, |_, at| least = least.min((at - place).length()));
            // all balls that near are in the cells looked at
            if least < within || reach >= most {
                return least;
            }
            reach *= 2;
        }
    }

    /// Puts a ball where there is known to be room, or is to be.
    fn put(&mut self, place: Vec3) {
        self.cells.add(place, self.places.len() as u32);
        self.places.push(place);
    }

    fn shift(&mut self, ball: u32, to: Vec3) {
        self.cells.remove(self.places[ball as usize], ball);
        self.cells.add(to, ball);
        self.places[ball as usize] = to;
    }

    /// Whether there was room.
    fn add(&mut self, place: Vec3) -> bool {
        let closest = NEARLY * self.cells.size;
        let mut is_free = true;
        self.visit(place, 1, |_, at| is_free &= (at - place).length_sq() >= closest * closest);
        if is_free {
            self.put(place);
        }
        is_free
    }
}

#[cfg(test)]
mod tests {
    use souple_math::Mat3;

    use super::*;
    use crate::contact::shape::{Capsule, Cuboid, Sphere};

    /// On the surface no place is so far from all balls that another would have room; no ball leaves the shape, none overlap.
    #[test]
    fn sheets_are_full() {
        let spacing = 0.1;
        let sphere = Sphere::new(Vec3::new(0.3, 0.1, -0.2), 0.53);
        let bounds = BoundingBox::of([sphere.centre]).grown(sphere.radius);
        let filling =
            Filling { spacing, inset: 0.5 * spacing, depth: f64::INFINITY, bounds, gaps: Gaps::Left };
        let balls = filling.fill(&sphere).unwrap();
        let mut widest: f64 = 0.0;
        for n in 0..2000 {
            // a spiral over the sphere
            let z = 1.0 - (2.0 * f64::from(n) + 1.0) / 2000.0;
            let (turn, r) = (2.399_963 * f64::from(n), (1.0 - z * z).sqrt());
            let place = sphere.centre + Vec3::new(r * turn.cos(), r * turn.sin(), z) * sphere.radius;
            let gap = balls.iter().map(|ball| (*ball - place).length()).fold(f64::INFINITY, f64::min);
            widest = widest.max(gap - 0.5 * spacing);
        }
        // a place above one of the sheet that is a diameter from all others: √(R² + 4 R²) - R
        assert!(widest <= (5.0_f64.sqrt() - 1.0) * 0.5 * spacing, "{widest}");
        for (n, ball) in balls.iter().enumerate() {
            assert!((*ball - sphere.centre).length() <= sphere.radius - 0.5 * spacing + 1e-6 * spacing);
            assert!(balls[..n].iter().all(|other| (*other - *ball).length() >= NEARLY * spacing));
        }
        // of the volume: loosely packed at least
        let share = balls.len() as f64 * (0.5 * spacing / sphere.radius).powi(3);
        assert!(share > 0.4, "{share}");
    }

    /// Closed, no place of the surface is farther than a radius from all balls, of spheres from a ball's own size up, of boxes, of capsules: no ball
    /// leaves the shape for that. A place in a corner of a box is `√3` radii from the ball below it, and more than a diameter from others: those are `2 - √3`
    /// radii from that at least, before they spread.
    #[test]
    fn gaps_are_closed() {
        let place = Vec3::new(0.3, 0.1, -0.2);
        // in radii of balls
        let spheres = [1.0, 1.3, 1.7, 2.0, 2.1, 2.3, 2.6, 3.0, 3.4, 3.9, 4.5, 5.2, 6.2, 8.0, 8.2, 11.0]
            .map(|radius| Box::new(Sphere::new(place, radius)) as Box<dyn Shape>);
        let boxes = [
            [2.0, 2.0, 2.0],
            [2.5, 2.5, 2.5],
            [3.7, 5.1, 2.0],
            [7.9, 6.3, 5.2],
            [11.3, 3.3, 2.2],
            [8.0, 8.0, 8.0],
        ]
        .map(|size| {
            let half_size = Vec3::from_array(size) * 0.5;
            let axes = souple_math::exponential(Vec3::new(0.2, 0.3, 0.1));
            Box::new(Cuboid { centre: place, half_size, axes }) as Box<dyn Shape>
        });
        let capsules = [(1.0, 5.0), (1.4, 3.3), (2.2, 7.1), (3.1, 2.0)].map(|(radius, length)| {
            Box::new(Capsule { from: place, to: place + Vec3::new(0.6, 0.0, 0.8) * length, radius })
                as Box<dyn Shape>
        });
        for (n, shape) in spheres.into_iter().chain(boxes).chain(capsules).enumerate() {
            let surface = shape.outline().unwrap().surface;
            let bounds = BoundingBox::of(surface.points.iter().copied());
            let filling =
                Filling { spacing: 2.0, inset: 1.0, depth: f64::INFINITY, bounds, gaps: Gaps::Closed };
            let balls = filling.fill(shape.as_ref()).unwrap();
            let mut widest: f64 = 0.0;
            for triangle in 0..surface.triangles.len() as u32 {
                let [a, b, c] = surface.corners(triangle);
                let fine = ((b - a).length().max((c - a).length()) / 0.1).ceil() as u32;
                for (i, j) in (0..=fine).flat_map(|i| (0..=fine - i).map(move |j| (i, j))) {
                    let seen = a
                        + (b - a) * (f64::from(i) / f64::from(fine))
                        + (c - a) * (f64::from(j) / f64::from(fine));
                    // outlines are polygons
                    let nearest = shape.nearest(seen, f64::INFINITY).unwrap();
                    let seen = seen - nearest.normal * nearest.distance;
                    let gap = balls.iter().map(|ball| (*ball - seen).length()).fold(f64::INFINITY, f64::min);
                    widest = widest.max(gap - 1.0);
                }
            }
            let told = filling.widest_gap(shape.as_ref(), &balls).unwrap().width;
            let depth = |ball: &Vec3| -shape.nearest(*ball, f64::INFINITY).unwrap().distance;
            let shallow = balls.iter().map(depth).fold(f64::INFINITY, f64::min);
            let apart = |n: usize| {
                balls[..n].iter().map(|other| (*other - balls[n]).length()).fold(f64::INFINITY, f64::min)
            };
            let closest = (0..balls.len()).map(apart).fold(f64::INFINITY, f64::min);
            // ends of searches are so fine, and uneven places are looked at
            assert!(widest <= 1.0 + 2.0 * FINEST && told <= 1.0 + 1e-9, "{n}: {widest} and {told}");
            assert!(shallow >= 1.0 - 4.0 * ON_SHEET, "{n}: {shallow}");
            assert!(closest >= 2.0 - 3.0_f64.sqrt(), "{n}: {closest}");
        }
    }

    /// Balls deeper than they need be leave a gap of that depth, which is told.
    #[test]
    fn deep_balls_leave_wide_gaps() {
        let (spacing, inset) = (0.1, 0.3);
        let sphere = Sphere::new(Vec3::ZERO, 0.5);
        let bounds = BoundingBox::of([sphere.centre]).grown(sphere.radius);
        let filling = Filling { spacing, inset, depth: f64::INFINITY, bounds, gaps: Gaps::Closed };
        let gap = filling.widest_gap(&sphere, &filling.fill(&sphere).unwrap()).unwrap();
        // at least to the depth of the sheet, at most to the farthest place above it that is a diameter from all balls
        assert!(gap.width > inset - 0.5 * spacing && gap.width < inset + spacing, "{gap:?}");
        let none = Filling { bounds: BoundingBox::of([Vec3::ZERO]), ..filling };
        assert_eq!(none.widest_gap(&sphere, &[Vec3::ZERO]), None);
    }

    /// A flat box is filled by a plane of balls; a shell is as deep as it is asked to be; what has no room is told.
    #[test]
    fn planes_shells_and_crumbs() {
        let cuboid = Cuboid { centre: Vec3::ZERO, half_size: Vec3::new(1.0, 1.0, 1.0), axes: Mat3::IDENTITY };
        let flat = BoundingBox { low: Vec3::new(-1.0, 0.0, -1.0), high: Vec3::new(1.0, 0.0, 1.0) };
        let filling =
            Filling { spacing: 0.1, inset: 0.05, depth: f64::INFINITY, bounds: flat, gaps: Gaps::Left };
        let balls = filling.fill(&cuboid).unwrap();
        assert!(balls.iter().all(|ball| ball.y == 0.0) && balls.len() > 350, "{}", balls.len());
        let shell = Filling { depth: 0.1, ..filling }.fill(&cuboid).unwrap();
        assert!(shell.iter().all(|ball| ball.x.abs().max(ball.z.abs()) > 0.8 - 1e-6));
        assert_eq!(Filling { inset: 1.1, ..filling }.fill(&cuboid), Err(FillingError::NoRoom));
        assert!(matches!(Filling { spacing: 1e-6, ..filling }.fill(&cuboid), Err(FillingError::TooMany(_))));
    }
}
