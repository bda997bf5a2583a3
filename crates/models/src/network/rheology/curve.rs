//! Effort over deformation within one step: monotone curves of straight pieces, added side by side or one after the
//! other.
//!
//! A spring is a slanted line, a damper over a step too, a slider a vertical piece between two horizontal ones. Elements
//! in parallel share the deformation and add their efforts; elements in series share the effort and add their
//! deformations. Both sums of such curves are such curves, so a network of any shape is solved for a step exactly,
//! without iterations and without trying which sliders slip.

use super::SLIDERS;

/// Corners that a curve can have: two for each slider, or one on a line.
const CORNERS: usize = 2 * SLIDERS;

/// A place on a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// `q` [m].
    pub deformation: f64,
    /// `Q` [N], traction positive.
    pub effort: f64,
}

/// A monotone curve: corners that neither fall nor turn back, and rays of some slope at both ends.
#[derive(Clone, Copy, Debug)]
pub struct Curve {
    /// A line has one that is none: a point on it.
    corners: [Point; CORNERS],
    count: usize,
    /// Of the rays before the first and behind the last corner, finite [N/m].
    slopes: [f64; 2],
}

/// All that a curve takes on at one number; its ends are equal but on a vertical or horizontal piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    /// Its number that is nearest to `number`; of an interval without numbers, none.
    pub fn nearest(self, number: f64) -> f64 {
        number.max(self.low).min(self.high)
    }

    fn of(number: f64) -> Self {
        Self { low: number, high: number }
    }

    fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Curve {
    /// `Q = slope (q - q₀)`.
    pub fn line(slope: f64, deformation: f64) -> Self {
        let mut corners = [Point::default(); CORNERS];
        corners[0].deformation = deformation;
        Self { corners, count: 1, slopes: [slope; 2] }
    }

    /// Stands at `deformation` between the efforts, and gives way at them.
    pub fn slider(deformation: f64, compression: f64, traction: f64) -> Self {
        let mut corners = [Point::default(); CORNERS];
        corners[0] = Point { deformation, effort: compression };
        corners[1] = Point { deformation, effort: traction };
        Self { corners, count: 2, slopes: [0.0; 2] }
    }

    fn corners(&self) -> &[Point] {
        &self.corners[..self.count]
    }

    fn is_line(&self) -> bool {
        self.count == 1 && self.slopes[0] == self.slopes[1]
    }

    /// The curve seen from the other axis: deformation over effort. Rays that were horizontal become vertical, which is
    /// said by an infinite slope.
    fn swapped(&self) -> Self {
        let mut swapped = *self;
        for corner in &mut swapped.corners[..self.count] {
            *corner = Point { deformation: corner.effort, effort: corner.deformation };
        }
        swapped.slopes = self.slopes.map(|slope| 1.0 / slope);
        swapped
    }

    /// Efforts at a deformation.
    pub fn efforts(&self, deformation: f64) -> Interval {
        let corners = self.corners();
        let ray = |corner: Point, slope: f64| corner.effort + slope * (deformation - corner.deformation);
        let first = corners.partition_point(|corner| corner.deformation < deformation);
        let end = corners.partition_point(|corner| corner.deformation <= deformation);
        if first < end {
            // at corners: all efforts between them, and beyond where a ray goes straight up or down
            let [before, behind] = self.slopes.map(f64::is_infinite);
            let low = if first == 0 && before { f64::NEG_INFINITY } else { corners[first].effort };
            let high = if end == corners.len() && behind { f64::INFINITY } else { corners[end - 1].effort };
            return Interval { low, high };
        }
        if first == 0 {
            return Interval::of(ray(corners[0], self.slopes[0]));
        }
        if first == corners.len() {
            return Interval::of(ray(corners[first - 1], self.slopes[1]));
        }
        let (a, b) = (corners[first - 1], corners[first]);
        let share = (deformation - a.deformation) / (b.deformation - a.deformation);
        // between the corners, whatever rounding says: beyond them a slider would have given way
        Interval::of((a.effort + share * (b.effort - a.effort)).max(a.effort).min(b.effort))
    }

    /// Deformations at an effort, at the nearest that is reached.
    pub fn deformations(&self, effort: f64) -> Interval {
        let swapped = self.swapped();
        let [before, behind] = swapped.slopes;
        let (first, last) = (swapped.corners[0].deformation, swapped.corners[self.count - 1].deformation);
        let least = if before.is_infinite() { first } else { f64::NEG_INFINITY };
        let most = if behind.is_infinite() { last } else { f64::INFINITY };
        // no number stays none
        swapped.efforts(if effort < least {
            least
        } else if effort > most {
            most
        } else {
            effort
        })
    }

    /// `∂Q/∂q` at a deformation, from the right [N/m].
    pub fn slope(&self, deformation: f64) -> f64 {
        let corners = self.corners();
        let next = corners.partition_point(|corner| corner.deformation <= deformation);
        if next == 0 {
            self.slopes[0]
        } else if next == corners.len() {
            self.slopes[1]
        } else {
            let (a, b) = (corners[next - 1], corners[next]);
            (b.effort - a.effort) / (b.deformation - a.deformation)
        }
    }

    /// Side by side: efforts added at the same deformation.
    pub fn beside(&self, other: &Self) -> Self {
        if self.is_line() {
            return other.raised(self);
        }
        if other.is_line() {
            return self.raised(other);
        }
        let mut sum = Self {
            corners: [Point::default(); CORNERS],
            count: 0,
            slopes: [self.slopes[0] + other.slopes[0], self.slopes[1] + other.slopes[1]],
        };
        let (mut a, mut b) = (self.corners().iter().peekable(), other.corners().iter().peekable());
        loop {
            let next = match (a.peek(), b.peek()) {
                (Some(x), Some(y)) => f64::min(x.deformation, y.deformation),
                (Some(x), None) | (None, Some(x)) => x.deformation,
                (None, None) => break,
            };
            while a.next_if(|corner| corner.deformation == next).is_some() {}
            while b.next_if(|corner| corner.deformation == next).is_some() {}
            let Interval { low, high } = self.efforts(next).plus(other.efforts(next));
            sum.push(Point { deformation: next, effort: low });
            if high > low {
                sum.push(Point { deformation: next, effort: high });
            }
        }
        sum
    }

    /// A line added to every effort: corners stay where they are.
    fn raised(&self, line: &Self) -> Self {
        let mut raised = *self;
        for corner in &mut raised.corners[..self.count] {
            corner.effort += line.efforts(corner.deformation).low;
        }
        raised.slopes = raised.slopes.map(|slope| slope + line.slopes[0]);
        raised
    }

    /// One behind the other: deformations added at the same effort.
    pub fn behind(&self, other: &Self) -> Self {
        let mut sum = Self { corners: [Point::default(); CORNERS], count: 0, slopes: [0.0; 2] };
        let lines = [self.is_line(), other.is_line()];
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for curve in [self, other] {
            if curve.slopes[0] == 0.0 {
                low = low.max(curve.corners[0].effort);
            }
            if curve.slopes[1] == 0.0 {
                high = high.min(curve.corners[curve.count - 1].effort);
            }
        }
        let (a, b) = (self.corners(), other.corners());
        let a = if lines[0] && !lines[1] { &a[..0] } else { a };
        let b = if lines[1] { &b[..0] } else { b };
        let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
        let mut last = f64::NEG_INFINITY;
        loop {
            let next = match (a.peek(), b.peek()) {
                (Some(x), Some(y)) => f64::min(x.effort, y.effort),
                (Some(x), None) | (None, Some(x)) => x.effort,
                (None, None) => break,
            };
            while a.next_if(|corner| corner.effort == next).is_some() {}
            while b.next_if(|corner| corner.effort == next).is_some() {}
            // nothing transmits more than its weakest slider
            let effort = next.clamp(low, high);
            if effort == last {
                continue;
            }
            last = effort;
            let own = self.deformations(effort).plus(other.deformations(effort));
            let from = if own.low.is_finite() { own.low } else { own.high };
            let to = if own.high.is_finite() { own.high } else { own.low };
            sum.push(Point { deformation: from, effort });
            if to > from {
                sum.push(Point { deformation: to, effort });
            }
        }
        for (end, slope) in sum.slopes.iter_mut().enumerate() {
            let [x, y] = [self.slopes[end], other.slopes[end]];
            *slope = if x == 0.0 || y == 0.0 { 0.0 } else { x * y / (x + y) };
        }
        sum
    }

    fn push(&mut self, corner: Point) {
        self.corners[self.count] = corner;
        self.count += 1;
    }
}
