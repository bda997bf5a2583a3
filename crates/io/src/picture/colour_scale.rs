//! From values to places along a map of colours: evenly, or by powers of ten.

use souple_table::{Entry, Table};

/// How values are spread over the colours of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourScale {
    #[default]
    Linear,
    /// Each power of ten has as much of the map; zero, infinitely many of them down, has the first colour, and what is below it none.
    Logarithmic,
}

/// All scales, by the names that the command line takes.
pub static COLOUR_SCALES: Table<ColourScale> = Table {
    kind: "colour scale",
    entries: &[
        &Entry {
            name: "linear",
            summary: "equal differences of values are equal steps of colour",
            source: "analytic",
            parameters: &[],
            build: ColourScale::Linear,
        },
        &Entry {
            name: "log",
            summary: "equal ratios of values are equal steps of colour; zero has the first one, and values below it are grey",
            source: "analytic",
            parameters: &[],
            build: ColourScale::Logarithmic,
        },
    ],
};

/// Most powers of ten that are told apart: more are the rounding of what is zero.
const MOST_DECADES: f64 = 6.0;

impl ColourScale {
    /// Where on the map a value is, 0 at `low` and 1 at `high`; not a number for one without a colour.
    pub fn share(self, value: f64, (low, high): (f64, f64)) -> f64 {
        match self {
            Self::Linear => (value - low) / (high - low).max(f64::MIN_POSITIVE),
            // what is next to zero is as near to it as zero: a cell between it and another value does not lose all its colours
            Self::Logarithmic if value > 0.0 => (libm::log(value / low) / libm::log(high / low)).max(0.0),
            Self::Logarithmic if value == 0.0 => 0.0,
            Self::Logarithmic => f64::NAN,
        }
    }

    /// Whether a value has a colour.
    pub fn has(self, value: f64) -> bool {
        value.is_finite() && (self == Self::Linear || value >= 0.0)
    }

    /// Whether a value has a place between others, by which a range is found.
    pub fn spans(self, value: f64) -> bool {
        self.has(value) && (self == Self::Linear || value > 0.0)
    }

    /// The range for values from `low` to `high`: of powers of ten, whole ones.
    pub fn spread(self, (low, high): (f64, f64)) -> (f64, f64) {
        if self == Self::Linear || !(low > 0.0 && high.is_finite()) {
            return (low, high);
        }
        // a power of ten is one, though its logarithm is rounded
        let top = libm::ceil(libm::log10(high) - 1e-9);
        let bottom = libm::floor(libm::log10(low) + 1e-9).max(top - MOST_DECADES);
        (libm::pow(10.0, bottom.min(top - 1.0)), libm::pow(10.0, top))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_have_equal_parts() {
        let log = ColourScale::Logarithmic;
        let range = log.spread((3.0e2, 4.0e4));
        assert!((range.0 / 1e2 - 1.0).abs() < 1e-12 && (range.1 / 1e5 - 1.0).abs() < 1e-12, "{range:?}");
        for (value, share) in [(1e2, 0.0), (1e3, 1.0 / 3.0), (1e5, 1.0)] {
            assert!((log.share(value, range) - share).abs() < 1e-12, "{value}");
        }
        assert!(log.share(-1.0, range).is_nan() && !log.has(-1.0));
        assert!(log.share(0.0, range) == 0.0 && log.has(0.0) && !log.spans(0.0) && log.spans(1e-300));
        // one value, a power of ten, and more decades than are told apart
        for (values, expected) in
            [((50.0, 50.0), [10.0, 100.0]), ((1e3, 1e3), [1e2, 1e3]), ((1e-30, 1.0), [1e-6, 1.0])]
        {
            let (low, high) = log.spread(values);
            assert!(
                (low / expected[0] - 1.0).abs() < 1e-12 && (high / expected[1] - 1.0).abs() < 1e-12,
                "{low} {high}"
            );
        }
        assert_eq!(ColourScale::Linear.spread((1.0, 5.0)), (1.0, 5.0));
        assert_eq!(ColourScale::Linear.share(2.0, (1.0, 5.0)), 0.25);
    }
}
