//! A link law: one scalar function of how far its ends are apart, now and a step before, and of what it remembers.
//!
//! Laws are written once over [`Real`]: in lanes they are the loop of a step, as [`souple_math::Dual`] numbers their own
//! slopes.

use std::fmt::Debug;

use souple_engine::LinkState;
use souple_formal::ParseError;
use souple_math::{Real, Vec3};
use souple_table::{Entry, Values};

use super::kernel::LinkKernel;
use super::span::Span;

/// Most numbers that a law in lanes remembers of a link.
pub const MEMORY: usize = 5;

/// How far the ends of a link are apart [m].
#[derive(Clone, Copy, Debug)]
pub struct Reach<R = f64> {
    /// `D`, now.
    pub length: R,
    /// `D^r`, a step before.
    pub before: R,
    /// The length the link was made with.
    pub rest: R,
}

/// When a link is looked at, and where its ends are.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// [s]
    pub time: f64,
    /// Of the first end and the second, now and a step before [m]; along an axis the place on it, as x. No numbers where nobody tells.
    pub places: [[Vec3; 2]; 2],
}

impl Moment {
    /// Of a link whose law does not ask where its ends are.
    pub fn of(time: f64) -> Self {
        let nowhere = Vec3::new(f64::NAN, f64::NAN, f64::NAN);
        Self { time, places: [[nowhere; 2]; 2] }
    }
}

/// Whether a law asks where ends are, beside how far they are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AsksFor {
    /// On an axis that the links have.
    pub place_on_axis: bool,
    /// In space.
    pub place_in_space: bool,
}

/// What a law makes of a link in a step.
#[derive(Clone, Copy, Debug)]
pub struct Response<R = f64> {
    /// Force on the first end along `(P1 - P2)/|P1 - P2|`, or along the axis of the links, positive when it pushes the ends apart [N].
    pub push: R,
    /// Stored in the link [J].
    pub stored: R,
    /// Given off since the step before [J].
    pub heat: R,
}

/// A law of links.
pub trait LinkLaw: Debug + Send + Sync + 'static {
    /// Numbers that a link remembers, at most [`MEMORY`].
    fn memory_len(&self) -> usize {
        0
    }

    /// What a link of this rest length and this length remembers at the start [m].
    fn begin(&self, _rest: f64, _length: f64, _memory: &mut [f64]) {}

    /// Force and energy of a link; `memory` becomes that of the next step.
    fn respond<R: Real>(&self, reach: &Reach<R>, memory: &mut [R; MEMORY]) -> Response<R>;

    /// The force is minus the derivative of what is stored, and of `D` alone.
    fn is_conservative(&self) -> bool;

    /// What a link takes of the bound `4M` on a mass between itself and a fixed point [N/m]: its transfer function at the
    /// highest frequency a step can carry, `K + 2Z` of a spring and damper.
    fn stiffest(&self) -> f64;

    /// Beyond it there is no force [m]; infinite where there always is.
    fn range(&self) -> f64 {
        f64::INFINITY
    }

    /// How far balls are apart that this law keeps from each other [m]: twice their radius in pictures; none where it does not.
    fn rest_distance(&self) -> Option<f64> {
        None
    }

    /// What holds a link of this rest length together that remembers this.
    fn state(&self, _rest: f64, _memory: &[f64]) -> LinkState {
        LinkState::In(0)
    }
}

/// What laws are made from.
#[derive(Clone, Copy, Debug)]
pub struct Making<'a> {
    pub values: &'a Values,
    /// `Te` of the system [s].
    pub timestep: f64,
    /// What the length `D` of its links is.
    pub span: Span,
    /// Parameters that controls drive: what is read of them is how they begin.
    pub driven: &'a [String],
}

impl Making<'_> {
    /// What lengths are never below [m].
    pub fn least_length(&self) -> f64 {
        match self.span {
            Span::Distance => 0.0,
            Span::Along(_) => f64::NEG_INFINITY,
        }
    }
}

/// Makes a law from its checked parameters.
pub type BuildLink = fn(&Making) -> Result<Box<dyn LinkKernel>, LinkError>;

/// An entry of the table of laws.
pub type LinkEntry = Entry<BuildLink>;

/// Numbers that are each in their range but make no law together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinkError {
    #[error("`{parameter}` is {value}, but {expected}")]
    Unfit { parameter: &'static str, value: String, expected: String },
    #[error("`{place}`: {}", error.without_place())]
    Formula {
        place: String,
        /// Where the formula begins in the text there [bytes].
        begin: usize,
        error: Box<ParseError>,
    },
    #[error("`{place}` {what}")]
    Text {
        place: String,
        what: String,
        /// What of the text is meant, where it is not all of it.
        part: Option<souple_formal::Span>,
    },
}

impl LinkError {
    /// Of all that is written at a place.
    pub fn text(place: impl Into<String>, what: impl Into<String>) -> Self {
        Self::Text { place: place.into(), what: what.into(), part: None }
    }

    /// The keys that lead to what is wrong, and where that is in the text there.
    pub fn place(&self) -> (&str, Option<souple_formal::Span>) {
        match self {
            Self::Unfit { parameter, .. } => (parameter, None),
            Self::Formula { place, begin, error } => (place, Some(error.span().moved_by(*begin))),
            Self::Text { place, part, .. } => (place, *part),
        }
    }
}
