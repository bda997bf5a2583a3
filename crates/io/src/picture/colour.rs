//! Colours: linear light, what a screen shows, and the colour map of scalar values.

use std::sync::LazyLock;

/// Red, green, blue in linear light, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Colour(pub [f32; 3]);

impl Colour {
    pub const BLACK: Self = Self([0.0; 3]);
    pub const WHITE: Self = Self([1.0; 3]);

    /// From the numbers of a screen, as in `#c8705a`.
    pub fn from_screen([red, green, blue]: [u8; 3]) -> Self {
        Self([red, green, blue].map(|value| linear_from_screen(f64::from(value) / 255.0) as f32))
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

fn linear_from_screen(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

/// The curve by table: fine enough that every one of the 256 values is hit near black, where it is steepest.
static SCREEN: LazyLock<Vec<u8>> = LazyLock::new(|| {
    const STEPS: usize = 1 << 14;
    (0..=STEPS).map(|step| (255.0 * screen_from_linear(step as f64 / STEPS as f64)).round() as u8).collect()
});

/// From violet through teal to yellow, lighter all the way: equal steps of the value look equally large, also to
/// eyes that do not tell red from green, and on paper without colour.
static MAP: LazyLock<Vec<Colour>> = LazyLock::new(|| {
    const FINE: usize = 2048;
    let path: Vec<[f64; 3]> = (0..=FINE).map(|step| path(step as f64 / FINE as f64)).collect();
    // equal lengths of the path in OKLab
    let mut lengths = vec![0.0];
    for pair in path.windows(2) {
        let step = (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
        lengths.push(lengths[lengths.len() - 1] + step);
    }
    let total = lengths[FINE];
    (0..MAP_LENGTH)
        .map(|index| {
            let wanted = total * index as f64 / (MAP_LENGTH - 1) as f64;
            let place = lengths.partition_point(|length| *length < wanted).min(FINE);
            Colour(linear_from_oklab(path[place]).map(|value| value.clamp(0.0, 1.0) as f32))
        })
        .collect()
});

const MAP_LENGTH: usize = 256;

/// The colour of a value, 0 to 1.
pub fn colour_map(value: f64) -> Colour {
    if value.is_nan() {
        return Colour([0.35; 3]);
    }
    MAP[(value.clamp(0.0, 1.0) * (MAP_LENGTH - 1) as f64).round() as usize]
}

/// A point of the path in OKLab: lightness rises evenly, hue falls from violet to yellow, chroma as high as the
/// screen allows, up to a limit.
fn path(t: f64) -> [f64; 3] {
    let lightness = 0.34 + 0.59 * t;
    let hue = (303.0 - 196.0 * t).to_radians();
    let at = |chroma: f64| [lightness, chroma * libm::cos(hue), chroma * libm::sin(hue)];
    // a saddle: the teal of the middle reaches less chroma than the ends
    let wanted = 0.115 + 0.05 * (2.0 * t - 1.0).powi(2);
    let shown =
        |chroma: f64| linear_from_oklab(at(chroma)).iter().all(|value| (-1e-4..=1.0001).contains(value));
    let (mut low, mut high) = (0.0, wanted);
    if shown(wanted) {
        return at(wanted);
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if shown(middle) { low = middle } else { high = middle }
    }
    at(low)
}

/// Ottosson 2020.
fn linear_from_oklab([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// OKLab of linear light, the inverse of `linear_from_oklab`.
    fn oklab([r, g, b]: [f64; 3]) -> [f64; 3] {
        let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
        let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
        let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }

    /// Lightness rises all the way, and equal steps of the value are equal steps of OKLab to 15 %.
    #[test]
    fn map_is_uniform() {
        let colours: Vec<[f64; 3]> =
            (0..=16).map(|step| oklab(colour_map(f64::from(step) / 16.0).0.map(f64::from))).collect();
        let steps: Vec<f64> = colours
            .windows(2)
            .map(|pair| {
                assert!(pair[1][0] > pair[0][0]);
                (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt()
            })
            .collect();
        let mean = steps.iter().sum::<f64>() / 16.0;
        assert!(steps.iter().all(|step| (step / mean - 1.0).abs() < 0.15), "{steps:?}");
    }

    #[test]
    fn screen_and_back() {
        for value in 0..=255u8 {
            assert_eq!(Colour::from_screen([value; 3]).to_screen(), [value; 3]);
        }
        assert_eq!(colour_map(f64::NAN), Colour([0.35; 3]));
        assert_eq!(colour_map(-1.0), colour_map(0.0));
    }
}
