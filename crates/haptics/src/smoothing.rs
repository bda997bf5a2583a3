//! The tool between two steps of the world, as the device is to feel it; or the force itself of points that the tool holds.
//!
//! A world that steps a hundred times a second tells a thousand times a second where its tool is: held there, the force
//! would go in steps.

use souple_math::Vec3;

use crate::coupling::Moving;

/// What the tool does until the world tells of it again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// It goes evenly to where it was told to be: a period late, and never with a jump.
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
    /// Where it was shown when it was last told.
    from: Vec3,
    told: Moving,
    /// When that was [s].
    since: f64,
}

impl Smoothing {
    pub fn new(between: Between, period: f64) -> Self {
        Self { between, period, from: Vec3::ZERO, told: Moving::default(), since: 0.0 }
    }

    /// The world tells where the tool is now.
    pub fn tell(&mut self, tool: Moving, now: f64) {
        self.from = self.at(now).place;
        (self.told, self.since) = (tool, now);
    }

    /// Where it is shown.
    pub fn at(&self, now: f64) -> Moving {
        let share = ((now - self.since) / self.period).clamp(0.0, 1.0);
        let is_over = share >= 1.0;
        match self.between {
            Between::Interpolate => {
                let way = self.told.place - self.from;
                let velocity = if is_over { Vec3::ZERO } else { way / self.period };
                Moving { place: self.from + way * share, velocity }
            }
            Between::Extrapolate => {
                let velocity = if is_over { Vec3::ZERO } else { self.told.velocity };
                Moving { place: self.told.place + self.told.velocity * (share * self.period), velocity }
            }
            Between::Hold => Moving { place: self.told.place, velocity: Vec3::ZERO },
        }
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
}

/// Periods of the world in which a force stays that is not told anew: so late is a world that does not catch up.
const SILENT: f64 = 3.0;
/// Time in which it fades afterwards [s].
const FADING: f64 = 0.2;

impl ForceSmoothing {
    pub fn new(between: Between, period: f64) -> Self {
        let zero = Vec3::ZERO;
        Self { between, period, from: zero, told: zero, rate: zero, since: 0.0 }
    }

    /// The world tells what is felt now [N].
    pub fn tell(&mut self, force: Vec3, now: f64) {
        self.from = self.at(now);
        self.rate = (force - self.told) / self.period;
        (self.told, self.since) = (force, now);
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
            for tick in 0..200 {
                let now = f64::from(tick) * 1e-3;
                if tick % 10 == 0 {
                    smoothing.tell(Vec3::X * now, now);
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
        for tick in 0..200 {
            let now = f64::from(tick) * 1e-3;
            if tick % 10 == 0 {
                smoothing.tell(Moving { place: Vec3::X * now, velocity: Vec3::X }, now);
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
            smoothing.tell(Moving { place: Vec3::X, velocity: Vec3::X }, 0.0);
            let (late, later) = (smoothing.at(0.02), smoothing.at(5.0));
            assert_eq!(late, later);
            // what it would have moved in a period at most, to rounding
            assert!((later.place.x - 1.0).abs() <= 0.01 * (1.0 + 1e-12) && later.velocity == Vec3::ZERO);
        }
    }
}
