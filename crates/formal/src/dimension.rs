//! Physical dimensions: powers of the base units, and the words people have for them.

use std::fmt;

/// Powers of kilogram, metre, second and kelvin. Angles are pure numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dimension {
    pub mass: i8,
    pub length: i8,
    pub time: i8,
    pub temperature: i8,
}

impl Dimension {
    /// A pure number.
    pub const NONE: Self = Self::new(0, 0, 0);

    /// Powers of kilogram, metre and second.
    pub const fn new(mass: i8, length: i8, time: i8) -> Self {
        Self { mass, length, time, temperature: 0 }
    }

    /// `self · other^power`, or `None` where a power leaves the range of `i8`.
    pub fn times(self, other: Self, power: i8) -> Option<Self> {
        let sum = |own: i8, others: i8| own.checked_add(others.checked_mul(power)?);
        Some(Self {
            mass: sum(self.mass, other.mass)?,
            length: sum(self.length, other.length)?,
            time: sum(self.time, other.time)?,
            temperature: sum(self.temperature, other.temperature)?,
        })
    }

    /// What people call it, with its article: `a pressure`; `None` for dimensions without a common name.
    pub fn name(self) -> Option<&'static str> {
        self.words().map(|(name, _)| name)
    }

    /// A quantity of this dimension as one would write it: `10 kPa`.
    pub fn example(self) -> Option<&'static str> {
        self.words().map(|(_, example)| example)
    }

    fn words(self) -> Option<(&'static str, &'static str)> {
        WORDS.iter().find(|(dimension, _, _)| *dimension == self).map(|(_, name, example)| (*name, *example))
    }

    /// Its name and base units: `a pressure [kg/(m s²)]`.
    pub(crate) fn described(self) -> String {
        match self.name() {
            _ if self == Self::NONE => "a pure number".to_owned(),
            Some(name) => format!("{name} [{self}]"),
            None => format!("a quantity in [{self}]"),
        }
    }
}

/// Dimension, name, example. Where several quantities share a dimension the commoner name stands.
const WORDS: &[(Dimension, &str, &str)] = &[
    (Dimension::NONE, "a pure number", "0.3"),
    (Dimension::new(1, 0, 0), "a mass", "250 g"),
    (Dimension::new(0, 1, 0), "a length", "3 mm"),
    (Dimension::new(0, 2, 0), "an area", "5 mm²"),
    (Dimension::new(0, 3, 0), "a volume", "20 mL"),
    (Dimension::new(0, 0, 1), "a duration", "5 ms"),
    (Dimension::new(0, 0, -1), "a frequency", "440 Hz"),
    (Dimension::new(0, 0, -2), "an angular acceleration", "2 rad/s²"),
    (Dimension::new(0, 1, -1), "a velocity", "0.2 m/s"),
    (Dimension::new(0, 1, -2), "an acceleration", "9.81 m/s²"),
    (Dimension::new(1, 0, -1), "a damping", "5 N s/m"),
    (Dimension::new(1, 0, -2), "a stiffness", "200 N/m"),
    (Dimension::new(1, 1, -1), "a momentum", "2 N s"),
    (Dimension::new(1, 1, -2), "a force", "3 N"),
    (Dimension::new(1, 2, -2), "an energy", "2 J"),
    (Dimension::new(1, 2, -3), "a power", "5 W"),
    (Dimension::new(1, 2, 0), "a moment of inertia", "2e-3 kg m²"),
    (Dimension::new(1, -1, -2), "a pressure", "10 kPa"),
    (Dimension::new(1, -1, -1), "a viscosity", "5 Pa s"),
    (Dimension::new(1, -2, -2), "a force per volume", "5 N/m³"),
    (Dimension::new(1, -3, 0), "a density", "1000 kg/m³"),
    (Dimension::new(1, -2, 0), "a mass per area", "0.2 kg/m²"),
    (Dimension::new(1, -1, 0), "a mass per length", "0.1 kg/m"),
    (Dimension::new(0, -1, 0), "a curvature", "20 1/m"),
    (Dimension::new(0, 2, -1), "a diffusivity", "1e-6 m²/s"),
    (Dimension::new(-1, 0, 2), "a compliance", "5 mm/N"),
    (Dimension::new(-1, 1, 2), "a compressibility", "4e-10 1/Pa"),
    (Dimension { temperature: 1, ..Dimension::NONE }, "a temperature", "310 K"),
];

impl fmt::Display for Dimension {
    /// In base units: `kg/(m s²)`, `1/s`, `1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factors = [("kg", self.mass), ("m", self.length), ("s", self.time), ("K", self.temperature)];
        let side = |wanted: i8| -> Vec<String> {
            let chosen = factors.iter().filter(|(_, power)| power.signum() == wanted);
            chosen.map(|(symbol, power)| format!("{symbol}{}", superscript(power.unsigned_abs()))).collect()
        };
        let (above, below) = (side(1), side(-1));
        f.write_str(&if above.is_empty() { "1".to_owned() } else { above.join(" ") })?;
        match below.as_slice() {
            [] => Ok(()),
            [one] => write!(f, "/{one}"),
            several => write!(f, "/({})", several.join(" ")),
        }
    }
}

/// `power` in raised digits; nothing for 1.
fn superscript(power: u8) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    if power == 1 {
        return String::new();
    }
    power.to_string().bytes().map(|digit| RAISED[usize::from(digit - b'0')]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A printed dimension reads as in a textbook.
    #[test]
    fn dimensions_in_base_units() {
        assert_eq!(Dimension::new(1, -1, -2).to_string(), "kg/(m s²)");
        assert_eq!(Dimension::new(0, 1, -2).to_string(), "m/s²");
        assert_eq!(Dimension::new(1, 2, -3).to_string(), "kg m²/s³");
        assert_eq!(Dimension::new(0, 0, -1).to_string(), "1/s");
        assert_eq!(Dimension::new(0, 12, 0).to_string(), "m¹²");
        assert_eq!(Dimension::NONE.to_string(), "1");
    }

    /// Each dimension has one name, and the example written for it has that dimension.
    #[test]
    fn words_are_unique_and_their_examples_fit() {
        for (at, (dimension, name, example)) in WORDS.iter().enumerate() {
            assert!(WORDS[..at].iter().all(|(other, _, _)| other != dimension), "{name} stands twice");
            assert_eq!(crate::parse_quantity(example).unwrap().dimension, *dimension, "{example}");
        }
    }

    /// Powers outside the range are refused, not wrapped.
    #[test]
    fn powers_do_not_wrap() {
        let metre = Dimension::new(0, 1, 0);
        assert_eq!(metre.times(metre, 127), None);
        assert_eq!(Dimension::new(0, 100, 0).times(metre, -101), Some(Dimension::new(0, -1, 0)));
    }
}
