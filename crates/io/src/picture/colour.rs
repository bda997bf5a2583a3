//! Colours: linear light, and what a screen shows.

use std::sync::LazyLock;

/// Red, green, blue in linear light, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Colour(pub [f32; 3]);

impl Colour {
    pub const BLACK: Self = Self([0.0; 3]);
    pub const WHITE: Self = Self([1.0; 3]);

    /// Of soft things that have no colour of their own.
    pub fn tissue() -> Self {
        Self::from_screen([214, 122, 104])
    }

    /// From the numbers of a screen, as in `#c8705a`.
    pub fn from_screen(colour: [u8; 3]) -> Self {
        Self(colour.map(|value| LINEAR[usize::from(value)]))
    }

    /// `self + (other - self) amount`
    pub fn mixed(self, other: Self, amount: f32) -> Self {
        let mut mixed = self.0;
        for (value, target) in mixed.iter_mut().zip(other.0) {
            *value += (target - *value) * amount;
        }
        Self(mixed)
    }

    pub fn scaled(self, factor: f32) -> Self {
        Self(self.0.map(|value| value * factor))
    }

    pub fn times(self, other: Self) -> Self {
        let [r, g, b] = self.0;
        let [x, y, z] = other.0;
        Self([r * x, g * y, b * z])
    }

    pub fn plus(self, other: Self) -> Self {
        let [r, g, b] = self.0;
        let [x, y, z] = other.0;
        Self([r + x, g + y, b + z])
    }

    /// How well one can be read on the other: 1 not at all, 21 black on white (WCAG 2.2).
    pub fn contrast(self, other: Self) -> f32 {
        let luminance = |Self([red, green, blue]): Self| 0.2126 * red + 0.7152 * green + 0.0722 * blue + 0.05;
        let (a, b) = (luminance(self), luminance(other));
        a.max(b) / a.min(b)
    }

    /// The numbers of a screen.
    pub fn to_screen(self) -> [u8; 3] {
        self.0.map(|value| {
            let index = (value.clamp(0.0, 1.0) * (SCREEN.len() - 1) as f32).round() as usize;
            SCREEN[index]
        })
    }
}

/// Curve of sRGB: 0 to 1 as the screen has it from linear light.
fn screen_from_linear(value: f64) -> f64 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * libm::pow(value, 1.0 / 2.4) - 0.055 }
}

pub(super) fn linear_from_screen(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

/// The curve by table: fine enough that every one of the 256 values is hit near black, where it is steepest.
static SCREEN: LazyLock<Vec<u8>> = LazyLock::new(|| {
    const STEPS: usize = 1 << 14;
    (0..=STEPS).map(|step| (255.0 * screen_from_linear(step as f64 / STEPS as f64)).round() as u8).collect()
});

/// Linear light of the numbers of a screen: maps and textures ask at every sample of a picture.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|value| linear_from_screen(value as f64 / 255.0) as f32));

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screen_and_back() {
        for value in 0..=255u8 {
            assert_eq!(Colour::from_screen([value; 3]).to_screen(), [value; 3]);
        }
    }
}
