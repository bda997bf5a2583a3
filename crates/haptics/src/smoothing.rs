//! The tool between two steps of the world, as the device is to feel it; or the force itself of points that the tool holds.
//!
//! A world that steps a hundred times a second tells a thousand times a second where its tool is: held there, the force
//! would go in steps. What it tells comes early or late by as much as its steps differ in what they take; a tool that stood still
//! until a late message comes, or hurried after an early one, would be felt through the damper as a blow. So what is told is
//! dated by the world's own time, and shown that late that it is there in nearly every case.

use souple_math::Vec3;

use crate::coupling::Moving;

/// What the tool does until the world tells of it again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// It goes through the places that it was told to be at, with the velocities told: late by what the world takes to tell of a period,
    /// and never with a jump, of its velocity neither.
    #[default]
    Interpolate,
    /// It goes on as it was told to move, for a period at most: not late, and with jumps where that was wrong.
    Extrapolate,
    /// It stays where it was told to be.
    Hold,
}

/// Names in scenes.
pub const BETWEEN: [&str; 3] = ["interpolate", "extrapolate", "hold"];

impl Between {
    /// The one of that name among [`BETWEEN`].
    pub fn named(name: &str) -> Self {
        match name {
            "extrapolate" => Self::Extrapolate,
            "hold" => Self::Hold,
            _ => Self::Interpolate,
        }
    }
}

/// Where the tool is shown to be.
#[derive(Clone, Copy, Debug)]
pub struct Smoothing {
    between: Between,
    /// Of the world [s].
    period: f64,
    told: Moving,
    /// When that was [s].
    since: f64,
    course: Course,
}

impl Smoothing {
    pub fn new(between: Between, period: f64) -> Self {
        Self { between, period, told: Moving::default(), since: 0.0, course: Course::new(period) }
    }

    /// The world tells where the tool is at the end of its period of that number, counted from 1; `now` [s].
    pub fn tell(&mut self, step: u64, tool: Moving, now: f64) {
        self.course.tell(step, tool, now);
        (self.told, self.since) = (tool, now);
    }

    /// How many periods of the world had passed, and what part of the next one, when the tool was where it is shown.
    pub fn periods(&self, now: f64) -> f64 {
        let last = self.course.last() / self.period;
        match self.between {
            Between::Interpolate => last.min((now - self.course.delay) / self.period),
            Between::Extrapolate | Between::Hold => last,
        }
    }

    /// Where it is shown.
    pub fn at(&self, now: f64) -> Moving {
        match self.between {
            Between::Interpolate => self.course.at(now),
            Between::Extrapolate => {
                let passed = (now - self.since).clamp(0.0, self.period);
                let velocity = if passed < self.period { self.told.velocity } else { Vec3::ZERO };
                Moving { place: self.told.place + self.told.velocity * passed, velocity }
            }
            Between::Hold => Moving { place: self.told.place, velocity: Vec3::ZERO },
        }
    }
}

/// The way of a tool through what was told of it, shown with a delay that is learnt from how late it was told (Ramjee, Kurose, Towsley &
/// Schulzrinne 1994, "Adaptive playout mechanisms for packetized audio applications in wide-area networks").
///
/// At `now` it shows the time `s = now - delay` of the world: cubic between the places told, with the velocities told. What comes later than
/// ever before finds the tool beyond what was known, and the delay grows: the way shown does not jump to the new one, it
/// joins it as `e'' + 2 e'/τ + e/τ² = 0`, which no further message disturbs.
#[derive(Clone, Copy, Debug)]
struct Course {
    /// Of the world [s].
    period: f64,
    /// In which a way of which nothing is told comes to rest, and in which it joins the one that is told then [s].
    ease: f64,
    /// What was told, oldest first.
    knots: [Knot; KEPT],
    /// Clock less time of the world that is shown [s].
    delay: f64,
    /// Shown less what was told, when that was last told.
    apart: Moving,
    /// When that was [s].
    since: f64,
}

#[derive(Clone, Copy, Debug)]
struct Knot {
    /// Of the world [s].
    time: f64,
    tool: Moving,
    /// Clock less time of the world when it was told [s].
    late: f64,
}

/// Messages by which the delay is learnt, more than a world makes that catches up.
const KEPT: usize = 16;
/// A world of shorter periods may still be held up for as long as this; within less a tool would come to rest with a blow [s].
const EASE: f64 = 0.01;
/// By so much of a period the delay falls with each message when it is longer than was needed of late: the tool is shown that much faster.
const FALL: f64 = 0.05;

impl Course {
    fn new(period: f64) -> Self {
        // at rest for as long as anybody asks, and told as early as a world can tell: at the beginning of a period
        let knot =
            |i: usize| Knot { time: -period * (KEPT - 1 - i) as f64, tool: Moving::default(), late: -period };
        let (knots, ease) = (std::array::from_fn(knot), period.max(EASE));
        Self { period, ease, knots, delay: 0.0, apart: Moving::default(), since: 0.0 }
    }

    /// The end of the last period told [s].
    fn last(&self) -> f64 {
        self.knots[KEPT - 1].time
    }

    fn tell(&mut self, step: u64, tool: Moving, now: f64) {
        let shown = self.at(now);
        let time = step as f64 * self.period;
        self.knots.rotate_left(1);
        self.knots[KEPT - 1] = Knot { time, tool, late: now - time };
        // as late as the latest, the next message comes when the last place told is reached
        let latest = self.knots.iter().map(|knot| knot.late).fold(f64::NEG_INFINITY, f64::max);
        let needed = self.period + latest;
        // nothing older than what is kept can be shown
        self.delay = needed.max(self.delay - FALL * self.period).min(now - self.knots[0].time);
        self.since = now;
        let told = self.told_at(now - self.delay);
        self.apart = Moving { place: shown.place - told.place, velocity: shown.velocity - told.velocity };
    }

    fn at(&self, now: f64) -> Moving {
        let told = self.told_at(now - self.delay);
        // e = (e₀ + (ė₀ + e₀/τ) t) exp(-t/τ)
        let Moving { place, velocity } = self.apart;
        let (passed, rate) = (now - self.since, 1.0 / self.ease);
        let slope = velocity + place * rate;
        let left = f64::exp(-passed * rate);
        let apart = (place + slope * passed) * left;
        Moving { place: told.place + apart, velocity: told.velocity + slope * left - apart * rate }
    }

    /// What was told of a time of the world.
    fn told_at(&self, time: f64) -> Moving {
        let Knot { time: last, tool, .. } = self.knots[KEPT - 1];
        if time >= last {
            return self.beyond(tool, time - last);
        }
        let after = self.knots.partition_point(|knot| knot.time <= time).clamp(1, KEPT - 1);
        between(&self.knots[after - 1], &self.knots[after], time)
    }

    /// It goes on and comes to rest.
    fn beyond(&self, tool: Moving, passed: f64) -> Moving {
        let passed = passed.min(self.ease);
        let left = 1.0 - passed / self.ease;
        Moving {
            place: tool.place + tool.velocity * (0.5 * passed * (1.0 + left)),
            velocity: tool.velocity * left,
        }
    }
}

/// Hermite's cubic.
fn between(a: &Knot, b: &Knot, time: f64) -> Moving {
    let span = b.time - a.time;
    let u = (time - a.time) / span;
    let way = b.tool.place - a.tool.place;
    let (v, w) = (a.tool.velocity * span, b.tool.velocity * span);
    // x = a + u (v + u (3 d - 2 v - w + u (v + w - 2 d)))
    let (second, third) = (way * 3.0 - v * 2.0 - w, v + w - way * 2.0);
    Moving {
        place: a.tool.place + (v + (second + third * u) * u) * u,
        velocity: (v + (second * 2.0 + third * (3.0 * u)) * u) / span,
    }
}

/// The force of points that a tool holds, as it is shown.
#[derive(Clone, Copy, Debug)]
pub struct ForceSmoothing {
    between: Between,
    /// Of the world [s].
    period: f64,
    /// What was shown when it was last told [N].
    from: Vec3,
    /// [N]
    told: Vec3,
    /// By which it changed in the period before [N/s].
    rate: Vec3,
    /// When it was told [s].
    since: f64,
    /// Of which period, counted from 1.
    step: u64,
}

/// Periods of the world in which a force stays that is not told anew: so late is a world that does not catch up.
const SILENT: f64 = 3.0;
/// Time in which it fades afterwards [s].
const FADING: f64 = 0.2;

impl ForceSmoothing {
    pub fn new(between: Between, period: f64) -> Self {
        let zero = Vec3::ZERO;
        Self { between, period, from: zero, told: zero, rate: zero, since: 0.0, step: 0 }
    }

    /// The world tells what is felt at the end of its period of that number, counted from 1 [N].
    pub fn tell(&mut self, step: u64, force: Vec3, now: f64) {
        self.from = self.at(now);
        self.rate = (force - self.told) / self.period;
        (self.told, self.since, self.step) = (force, now, step);
    }

    /// How many periods of the world had passed, and what part of the next one, when what is shown was felt.
    pub fn periods(&self, now: f64) -> f64 {
        let share = ((now - self.since) / self.period).clamp(0.0, 1.0);
        match self.between {
            Between::Interpolate => self.step as f64 - 1.0 + share,
            Between::Extrapolate | Between::Hold => self.step as f64,
        }
    }

    /// What is shown [N]. A spring lets go where it is followed; a force does not, and fades where the world says no more.
    pub fn at(&self, now: f64) -> Vec3 {
        let silence = now - self.since;
        let share = (silence / self.period).clamp(0.0, 1.0);
        let shown = match self.between {
            Between::Interpolate => self.from + (self.told - self.from) * share,
            Between::Extrapolate => self.told + self.rate * (share * self.period),
            Between::Hold => self.told,
        };
        shown * (1.0 - (silence - SILENT * self.period) / FADING).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A force that grows evenly, told each 10 ms: it changes by what it grows in a tick, or, held, in a period; and once the world says no
    /// more it stays for three periods and fades within a fifth of a second, by a two hundredth of it in a tick.
    #[test]
    fn forces_do_not_jump_and_do_not_stay() {
        let cases = [(Between::Interpolate, 1e-3), (Between::Extrapolate, 1e-3), (Between::Hold, 10e-3)];
        for (between, expected) in cases {
            let (mut smoothing, mut before, mut greatest) =
                (ForceSmoothing::new(between, 0.01), 0.0, 0.0_f64);
            for tick in 0..200_u32 {
                let now = f64::from(tick) * 1e-3;
                if tick % 10 == 0 {
                    smoothing.tell(u64::from(tick / 10), Vec3::X * now, now);
                }
                let shown = smoothing.at(now).x;
                // at first nothing is known of how fast it grows
                if tick > 10 {
                    greatest = greatest.max((shown - before).abs());
                }
                before = shown;
            }
            assert!((greatest - expected).abs() < 1e-12, "{between:?} {greatest}");
            // last told at 190 ms
            let stays = smoothing.at(0.2);
            assert_eq!(smoothing.at(0.2195), stays);
            assert!((smoothing.at(0.32) - stays * 0.5).length() < 1e-12 && smoothing.at(0.43) == Vec3::ZERO);
        }
    }

    /// The greatest step of the shown place from millisecond to millisecond, for a tool at speed 1 m/s, told each 10 ms.
    fn greatest_step(between: Between) -> f64 {
        let (mut smoothing, mut before, mut greatest) = (Smoothing::new(between, 0.01), 0.0, 0.0_f64);
        for tick in 0..200_u64 {
            let now = tick as f64 * 1e-3;
            if tick % 10 == 0 {
                smoothing.tell(tick / 10, Moving { place: Vec3::X * now, velocity: Vec3::X }, now);
            }
            let shown = smoothing.at(now).place.x;
            greatest = greatest.max((shown - before).abs());
            before = shown;
        }
        greatest
    }

    /// Held, a tool jumps by what it moves in a period; between, by what it moves in a tick.
    #[test]
    fn tools_do_not_jump() {
        assert!((greatest_step(Between::Hold) - 10e-3).abs() < 1e-12);
        assert!((greatest_step(Between::Interpolate) - 1e-3).abs() < 1e-12);
        assert!((greatest_step(Between::Extrapolate) - 1e-3).abs() < 1e-12);
    }

    /// A world that says no more leaves its tool where it was.
    #[test]
    fn tools_do_not_run_away() {
        for between in [Between::Interpolate, Between::Extrapolate, Between::Hold] {
            let mut smoothing = Smoothing::new(between, 0.01);
            smoothing.tell(1, Moving { place: Vec3::X, velocity: Vec3::X }, 0.0);
            // ways join within a hundred periods, to rounding
            let (late, later) = (smoothing.at(1.0), smoothing.at(5.0));
            assert_eq!(late.place, later.place);
            // what it would have moved in a period at most, to rounding
            assert!((later.place.x - 1.0).abs() <= 0.01 * (1.0 + 1e-12));
            assert!(later.velocity.length() < 1e-12);
        }
    }

    /// A tool that swings by 20 mm in 0.6 s, told of each period of 10 ms as late as `late` says of that period [ticks]: the greatest change in a
    /// tick of its place [m] and of its velocity [m/s], once it was told of thirty periods.
    fn greatest_changes(late: impl Fn(u64) -> u64) -> (f64, f64) {
        let (mut smoothing, mut step) = (Smoothing::new(Between::Interpolate, 0.01), 1);
        let (mut before, mut changes) = (Moving::default(), (0.0_f64, 0.0_f64));
        for tick in 0..3000_u64 {
            let now = tick as f64 * 1e-3;
            if tick >= 10 * step + late(step) {
                smoothing.tell(step, swinging(step as f64 * 0.01), now);
                step += 1;
            }
            let shown = smoothing.at(now);
            if tick > 300 {
                changes.0 = changes.0.max((shown.place - before.place).length());
                changes.1 = changes.1.max((shown.velocity - before.velocity).length());
            }
            before = shown;
        }
        changes
    }

    const SWING: f64 = 0.02;
    const OMEGA: f64 = std::f64::consts::TAU / 0.6;

    fn swinging(time: f64) -> Moving {
        let (sine, cosine) = (OMEGA * time).sin_cos();
        Moving { place: Vec3::X * (SWING * (1.0 - cosine)), velocity: Vec3::X * (SWING * OMEGA * sine) }
    }

    /// Told up to eight ticks early or late, in no order, a tool is shown as it moves: by its speed and its acceleration in a tick, both to
    /// what the cubic between two places is off, `(ωh)² / 12` of the acceleration.
    #[test]
    fn late_messages_are_not_felt() {
        let (place, velocity) = greatest_changes(|step| step * 7 % 9);
        let off = 1.0 + (OMEGA * 0.01).powi(2) / 12.0;
        assert!(place <= SWING * OMEGA * 1e-3 * off, "{place}");
        assert!(velocity <= SWING * OMEGA * OMEGA * 1e-3 * off, "{velocity}");
    }

    /// A message later than any before by half a period, once in forty: the tool is braked evenly, by its speed in a period, and joins the
    /// way it was told of, twice as fast at most; it never stands still at once, which would change its velocity by all of it.
    #[test]
    fn messages_later_than_ever_do_not_jump() {
        let (place, velocity) = greatest_changes(|step| if step % 40 == 0 { 5 } else { 0 });
        let speed = SWING * OMEGA;
        assert!(place <= 2.0 * speed * 1e-3, "{place}");
        assert!(velocity <= (OMEGA + 1.0 / 0.01) * speed * 1e-3, "{velocity}");
    }
}
