//! Filling a closed shape with balls ("billage", Jimenez 1993, P2-III.2.2; specification §2.12.4).
//!
//! First a sheet of balls that touch the surface from within: places on the surface moved inward by a radius, taken in an
//! order that goes on from what stands, so that balls lie close. Then a close packing inside, which keeps clear of the sheet.
//! No two are closer than a diameter. What gaps are left between sheet and packing, matter closes by itself when it settles.

use std::collections::{HashMap, VecDeque};

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
    /// Those that are farther than a radius get a ball below the sheet.
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
        let pitch = SHEET_PITCH * self.spacing;
        let surface = Self { inset: 0.0, ..*self };
        let mut balls = Balls::new(self.spacing);
        places.iter().for_each(|place| balls.put(*place));
        let candidates = surface.candidates(shape, pitch).into_iter();
        let (_, seed) =
            candidates.map(|place| (balls.clearance(place), place)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let (apart, place) = surface.widest_near(shape, seed, pitch, |place| balls.clearance(place));
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

    /// Puts a ball below the sheet wherever a place of the surface is farther than a radius `R` from all balls. Above a place of the sheet
    /// that is `a R` from the nearest of its balls the surface is `√(1 + a²) - 1` radii from it; a ball that touches those around the place is
    /// `√(4 - a²)` radii from the surface. Both are 1 at `a = √3`: the one or the other is never more.
    fn close_gaps(&self, shape: &dyn Shape, pitch: f64, balls: &mut Balls) {
        let widest = 0.75_f64.sqrt() * self.spacing;
        let mut seeds: Vec<(f64, Vec3)> = self
            .candidates(shape, pitch)
            .into_iter()
            .map(|place| (balls.distance(place), place))
            // a candidate is within a pitch of what is widest
            .filter(|(apart, _)| *apart > widest - pitch)
            .collect();
        seeds.sort_by(|a, b| b.0.total_cmp(&a.0));
        // where the search has ended before: those that begin beside it would end there too
        let (mut ends, mut known) = (Vec::<Vec3>::new(), Cells::new(self.spacing));
        for (_, seed) in seeds {
            let mut is_known = balls.distance(seed) <= widest - pitch;
            known.visit(seed, 1, |end| is_known |= (ends[end as usize] - seed).length() < pitch);
            if is_known {
                continue;
            }
            let (apart, place) = self.widest_near(shape, seed, pitch, |place| balls.distance(place));
            known.add(place, ends.len() as u32);
            ends.push(place);
            if apart <= widest {
                continue;
            }
            let Some(nearest) = shape.nearest(place, f64::INFINITY) else { continue };
            // the first that has room, on the way in
            let steps = (1.0 / FINEST).ceil() as usize;
            for step in 0..=steps {
                let deep = place - nearest.normal * (step as f64 * FINEST * self.spacing);
                let BoundingBox { low, high } = self.bounds;
                let is_in = deep == deep.max_components(low).min_components(high);
                if !is_in || !self.is_inside(shape, deep, -1e-6 * self.spacing) || balls.add(deep) {
                    break;
                }
            }
        }
    }

    /// The place of the sheet near a place of it that is farthest from all balls, and how far: up the slope of the distance,
    /// by ever shorter steps.
    fn widest_near(
        &self,
        shape: &dyn Shape,
        seed: Vec3,
        pitch: f64,
        distance: impl Fn(Vec3) -> f64,
    ) -> (f64, Vec3) {
        let BoundingBox { low, high } = self.bounds;
        let (mut best, mut step) = ((distance(seed), seed), pitch);
        let mut moves = 0;
        while step > FINEST * self.spacing && moves < MOST_MOVES {
            moves += 1;
            let around = (0..27).map(|n| {
                Vec3::new((n % 3) as f64, (n / 3 % 3) as f64, (n / 9) as f64) - Vec3::new(1.0, 1.0, 1.0)
            });
            let tried = around.filter_map(|way| {
                let place = self.moved(shape, best.1 + way * step)?.max_components(low).min_components(high);
                // no farther from where it began than the next candidates are
                let is_on = (place - seed).length() <= 2.0 * pitch
                    && self.is_inside(shape, place, -1e-6 * self.spacing);
                is_on.then(|| (distance(place), place))
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
        found.retain(|place| self.is_inside(shape, *place, -1e-6 * self.spacing));
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

/// Balls that do not overlap.
struct Balls {
    places: Vec<Vec3>,
    cells: Cells,
}

impl Balls {
    fn new(spacing: f64) -> Self {
        Self { places: Vec::new(), cells: Cells::new(spacing) }
    }

    /// From the nearest ball; a diameter at most.
    fn distance(&self, place: Vec3) -> f64 {
        let mut least = self.cells.size;
        self.cells.visit(place, 1, |other| least = least.min((self.places[other as usize] - place).length()));
        least
    }

    /// From the nearest ball; [`FAR`] diameters at most.
    fn clearance(&self, place: Vec3) -> f64 {
        let mut reach = 1;
        loop {
            let mut least = reach as f64 * self.cells.size;
            let within = least;
            self.cells.visit(place, reach, |other| {
                least = least.min((self.places[other as usize] - place).length());
            });
            // all balls that near are in the cells looked at
            if least < within || reach >= FAR {
                return least;
            }
            reach *= 2;
        }
    }

    /// Puts a ball where there is known to be room.
    fn put(&mut self, place: Vec3) {
        self.cells.add(place, self.places.len() as u32);
        self.places.push(place);
    }

    /// Whether there was room.
    fn add(&mut self, place: Vec3) -> bool {
        let closest = NEARLY * self.cells.size;
        let mut is_free = true;
        self.cells.visit(place, 1, |other| {
            is_free &= (self.places[other as usize] - place).length_sq() >= closest * closest;
        });
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
    use crate::contact::shape::{Cuboid, Sphere};

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

    /// Closing leaves narrower gaps. On a sphere of radius `ρ` a ball that touches those around a place `√3 R` from them is `d R` from the surface,
    /// `d² - 3 d R/(ρ - R) = 1`: 1.33 where `ρ` is 6.2 radii.
    #[test]
    fn gaps_are_closed() {
        let mut widest = [0.0_f64; 2];
        for spacing in [0.13, 0.17] {
            let sphere = Sphere::new(Vec3::new(0.3, 0.1, -0.2), 0.53);
            let bounds = BoundingBox::of([sphere.centre]).grown(sphere.radius);
            for (gaps, widest) in [Gaps::Left, Gaps::Closed].into_iter().zip(&mut widest) {
                let filling = Filling { spacing, inset: 0.5 * spacing, depth: f64::INFINITY, bounds, gaps };
                let balls = filling.fill(&sphere).unwrap();
                let mut seen: f64 = 0.0;
                for n in 0..20_000 {
                    let z = 1.0 - (2.0 * f64::from(n) + 1.0) / 20_000.0;
                    let (turn, r) = (2.399_963 * f64::from(n), (1.0 - z * z).sqrt());
                    let place = sphere.centre + Vec3::new(r * turn.cos(), r * turn.sin(), z) * sphere.radius;
                    let gap = balls.iter().map(|ball| (*ball - place).length()).fold(f64::INFINITY, f64::min);
                    seen = seen.max(gap / (0.5 * spacing) - 1.0);
                }
                // what is told is on the surface, and as wide as any place that was looked at, but for how far those are apart
                let gap = filling.widest_gap(&sphere, &balls).unwrap();
                let nearest =
                    balls.iter().map(|ball| (*ball - gap.place).length()).fold(f64::INFINITY, f64::min);
                assert!((nearest - 0.5 * spacing - gap.width).abs() < 1e-12);
                assert!(((gap.place - sphere.centre).length() - sphere.radius).abs() < 1e-9);
                let told = gap.width / (0.5 * spacing);
                // 20,000 places are (4 π/20,000)^½ = 0.025 radii of the sphere apart
                let apart = 0.025 * sphere.radius / (0.5 * spacing);
                assert!(told > seen - 0.5 * apart, "{told} is told and {seen} is seen");
                *widest = widest.max(told.max(seen));
                for (n, ball) in balls.iter().enumerate() {
                    assert!(balls[..n].iter().all(|other| (*other - *ball).length() >= NEARLY * spacing));
                }
            }
        }
        let [left, closed] = widest;
        assert!(closed < left && closed <= 1.33, "{left} and {closed} radii");
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
