//! Physical dimensions: powers of mass, length and time; angles are pure numbers.

use std::fmt;

/// Powers of kilogram, metre and second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dimension {
    pub mass: i8,
    pub length: i8,
    pub time: i8,
}

impl Dimension {
    /// A number without unit, such as a ratio or an angle.
    pub const PURE: Self = Self::new(0, 0, 0);

    pub const fn new(mass: i8, length: i8, time: i8) -> Self {
        Self { mass, length, time }
    }

    /// The dimension of a product; `None` where a power leaves the range of `i8`.
    pub fn times(self, other: Self) -> Option<Self> {
        Some(Self {
            mass: self.mass.checked_add(other.mass)?,
            length: self.length.checked_add(other.length)?,
            time: self.time.checked_add(other.time)?,
        })
    }

    /// The dimension of a power; `None` where a power leaves the range of `i8`.
    pub fn power(self, exponent: i8) -> Option<Self> {
        Some(Self {
            mass: self.mass.checked_mul(exponent)?,
            length: self.length.checked_mul(exponent)?,
            time: self.time.checked_mul(exponent)?,
        })
    }

    /// In words, with article and unit: `a pressure [kg/(m s²)]`.
    pub fn describe(self) -> String {
        match self.usual() {
            _ if self == Self::PURE => "a pure number".to_owned(),
            Some(usual) => format!("{} [{self}]", usual.name),
            None => format!("a quantity in [{self}]"),
        }
    }

    /// How a quantity of this dimension is usually written, where there is a custom.
    pub fn example(self) -> Option<&'static str> {
        self.usual().map(|usual| usual.example)
    }

    fn usual(self) -> Option<&'static Usual> {
        USUAL.iter().find(|usual| usual.dimension == self)
    }
}

/// A dimension that has a name.
struct Usual {
    dimension: Dimension,
    name: &'static str,
    example: &'static str,
}

const fn usual(mass: i8, length: i8, time: i8, name: &'static str, example: &'static str) -> Usual {
    Usual { dimension: Dimension::new(mass, length, time), name, example }
}

const USUAL: &[Usual] = &[
    usual(0, 0, 0, "a pure number", "0.3"),
    usual(1, 0, 0, "a mass", "5 g"),
    usual(0, 1, 0, "a length", "3 mm"),
    usual(0, 0, 1, "a time", "5 ms"),
    usual(0, 2, 0, "an area", "4 cm^2"),
    usual(0, 3, 0, "a volume", "20 mL"),
    usual(0, 0, -1, "a frequency", "50 Hz"),
    usual(0, 1, -1, "a velocity", "2 m/s"),
    usual(0, 1, -2, "an acceleration", "9.81 m/s^2"),
    usual(0, -1, 0, "a wave number or curvature", "2 1/m"),
    usual(1, -3, 0, "a density", "1000 kg/m^3"),
    usual(1, -2, 0, "a mass per area", "2 kg/m^2"),
    usual(1, -1, 0, "a mass per length", "0.1 kg/m"),
    usual(1, 1, -1, "a momentum", "2 N s"),
    usual(1, 1, -2, "a force", "10 N"),
    usual(1, 2, -2, "an energy or torque", "2 J"),
    usual(1, 2, -3, "a power", "5 W"),
    usual(1, -1, -2, "a pressure", "10 kPa"),
    usual(1, -1, -1, "a viscosity", "2 Pa s"),
    usual(1, 0, -2, "a stiffness or surface tension", "200 N/m"),
    usual(1, 0, -1, "a damping coefficient", "0.5 N s/m"),
    usual(1, -2, -2, "a force per volume", "100 N/m^3"),
    usual(0, 2, -1, "a diffusivity", "2 m^2/s"),
    usual(0, 3, -1, "a flow rate", "5 mL/s"),
    usual(1, 2, 0, "a moment of inertia", "0.1 kg m^2"),
];

/// In base units as this crate also reads them: `kg/(m s²)`, `1/s`, and `1` for a pure number.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let powers = [("kg", self.mass), ("m", self.length), ("s", self.time)];
        let side = |sign: i32| -> Vec<String> {
            let signed = powers.iter().map(|&(symbol, power)| (symbol, sign * i32::from(power)));
            signed
                .filter(|&(_, power)| power > 0)
                .map(|(symbol, power)| symbol.to_owned() + &raised(power))
                .collect()
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

/// The digits of raised numbers, `⁰` to `⁹`.
pub(crate) const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// A power above one as raised digits; nothing for the power of one.
fn raised(power: i32) -> String {
    if power == 1 {
        return String::new();
    }
    power.to_string().bytes().map(|digit| SUPERSCRIPTS[usize::from(digit - b'0')]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dimensions_are_written_in_base_units() {
        assert_eq!(Dimension::new(1, -1, -2).to_string(), "kg/(m s²)");
        assert_eq!(Dimension::new(0, 0, -1).to_string(), "1/s");
        assert_eq!(Dimension::new(1, 2, -12).to_string(), "kg m²/s¹²");
        assert_eq!(Dimension::PURE.to_string(), "1");
        assert_eq!(Dimension::new(1, -1, -2).describe(), "a pressure [kg/(m s²)]");
        assert_eq!(Dimension::new(2, 0, 0).describe(), "a quantity in [kg²]");
    }

    /// Every example of the table has the dimension that it is an example of, and no dimension has two names.
    #[test]
    fn examples_have_their_dimension() {
        for (row, usual) in USUAL.iter().enumerate() {
            let quantity = crate::parse_quantity(usual.example).unwrap();
            assert_eq!(quantity.dimension, usual.dimension, "{}", usual.name);
            assert!(USUAL[..row].iter().all(|other| other.dimension != usual.dimension), "{}", usual.name);
        }
    }
}
