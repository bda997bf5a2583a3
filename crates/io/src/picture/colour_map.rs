//! Maps from values to colours, made in OKLab so that equal steps of the value look equally large.

use std::sync::LazyLock;

use souple_table::{Entry, Table};

use super::colour::Colour;

/// A map from values to colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourMap {
    /// From violet through teal to yellow, lighter all the way: read also by eyes that do not tell red from green,
    /// and on paper without colour.
    #[default]
    Sequential,
    /// From blue through light grey to red: for values about zero.
    Diverging,
    Grey,
    /// From green to red as a value nears one, blue below zero: elements by their criterion, and those that have changed
    /// their law.
    Adaptation,
    /// From charred brown through the red of an organ to the white of one without blood.
    Tissue,
    /// One colour for each kind of element, by [`ELEMENT_KINDS`].
    Elements,
}

/// Kinds of elements in the order of the colours of [`ColourMap::Elements`], whose values are their numbers.
pub const ELEMENT_KINDS: [&str; 7] = ["tet", "hex", "prism", "pyramid", "tri", "quad", "edge"];

/// Dark blue, yellow, cyan, pink as in the source; green, orange, grey.
const OF_KINDS: [[u8; 3]; 7] = [
    [52, 78, 158],
    [232, 196, 64],
    [72, 190, 204],
    [226, 132, 176],
    [104, 172, 96],
    [222, 134, 66],
    [128, 132, 140],
];

/// All maps, by the names that the command line takes.
pub static COLOUR_MAPS: Table<ColourMap> = Table {
    kind: "colour map",
    entries: &[
        &Entry {
            name: "sequential",
            summary: "violet, teal, yellow; lighter all the way",
            source: "made in OKLab (Ottosson 2020), after the idea of viridis (Smith & van der Walt 2015)",
            parameters: &[],
            build: ColourMap::Sequential,
        },
        &Entry {
            name: "diverging",
            summary: "blue, light grey, red; for values about zero",
            source: "made in OKLab (Ottosson 2020), after the idea of Moreland 2009",
            parameters: &[],
            build: ColourMap::Diverging,
        },
        &Entry {
            name: "grey",
            summary: "dark to light, for print",
            source: "made in OKLab (Ottosson 2020)",
            parameters: &[],
            build: ColourMap::Grey,
        },
        &Entry {
            name: "adaptation",
            summary: "green to red as a criterion nears its threshold, blue where an element has changed its law",
            source: "Faure 2014, fig. 6.26",
            parameters: &[],
            build: ColourMap::Adaptation,
        },
        &Entry {
            name: "tissue",
            summary: "charred below zero, the red of an organ, pale where it is pressed; its range is -1 to 1",
            source: "Debunne 2000, 5 §5.1",
            parameters: &[],
            build: ColourMap::Tissue,
        },
        &Entry {
            name: "elements",
            summary: "a colour for each kind of element: tetrahedra dark blue, hexahedra yellow, prisms cyan, pyramids pink",
            source: "Faure 2014, fig. 6.17",
            parameters: &[],
            build: ColourMap::Elements,
        },
    ],
};

const MAP_LENGTH: usize = 256;

/// The maps in the order of [`ColourMap`].
static MAPS: LazyLock<[Vec<Colour>; 6]> = LazyLock::new(|| {
    [
        evened(sequential),
        evened(diverging),
        evened(grey),
        stepped(adaptation),
        stepped(tissue),
        stepped(of_kind),
    ]
});

/// Colours at equal steps of the value, with jumps where a function of it has them.
fn stepped(colour: fn(f64) -> Colour) -> Vec<Colour> {
    (0..MAP_LENGTH).map(|index| colour(index as f64 / (MAP_LENGTH - 1) as f64)).collect()
}

/// Colours at equal lengths along a path in OKLab.
fn evened(path: fn(f64) -> [f64; 3]) -> Vec<Colour> {
    const FINE: usize = 2048;
    let path: Vec<[f64; 3]> = (0..=FINE).map(|step| path(step as f64 / FINE as f64)).collect();
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
}

impl ColourMap {
    /// The range of colours for values from `low` to `high`: of a diverging map as far on both sides of zero, which has its middle
    /// colour.
    pub fn spread(self, (low, high): (f64, f64)) -> (f64, f64) {
        if self == Self::Diverging {
            let most = high.abs().max(low.abs());
            return (-most, most);
        }
        (low, high)
    }

    /// The values of its first and last colour, for maps whose colours mean something of their own.
    pub fn own_range(self) -> Option<(f64, f64)> {
        match self {
            Self::Adaptation | Self::Tissue => Some((-1.0, 1.0)),
            Self::Elements => Some((-0.5, ELEMENT_KINDS.len() as f64 - 0.5)),
            Self::Sequential | Self::Diverging | Self::Grey => None,
        }
    }

    /// The colour of tissue that has one of its own, by a value as that of [`ColourMap::Tissue`], 0 to 1; NaN is grey.
    pub fn tissue_of(own: Colour, value: f64) -> Colour {
        if value.is_nan() {
            return Colour([0.35; 3]);
        }
        let [charred, scorched, _, pale, white] = TISSUE.map(Colour::from_screen);
        between([charred, scorched, own, pale, white], value.clamp(0.0, 1.0))
    }

    /// The colour of a value, 0 to 1; NaN is grey.
    pub fn colour(self, value: f64) -> Colour {
        if value.is_nan() {
            return Colour([0.35; 3]);
        }
        MAPS[self as usize][(value.clamp(0.0, 1.0) * (MAP_LENGTH - 1) as f64).round() as usize]
    }
}

/// A point of the path in OKLab: lightness rises evenly, hue falls from violet to yellow, chroma as high as the
/// screen allows, up to a limit.
fn sequential(t: f64) -> [f64; 3] {
    let lightness = 0.34 + 0.59 * t;
    let hue = (303.0 - 196.0 * t).to_radians();
    // a saddle: the teal of the middle reaches less chroma than the ends
    within_screen(lightness, hue, 0.115 + 0.05 * (2.0 * t - 1.0).powi(2))
}

/// From blue through a light grey to red, as light on both sides: which side a value is on, and how far.
fn diverging(t: f64) -> [f64; 3] {
    let away = (2.0 * t - 1.0).abs();
    let hue = if t < 0.5 { 258.0_f64 } else { 28.0 }.to_radians();
    within_screen(0.95 - 0.47 * away, hue, 0.19 * libm::pow(away, 0.9))
}

/// From black to nearly white, for print.
fn grey(t: f64) -> [f64; 3] {
    [0.2 + 0.77 * t, 0.0, 0.0]
}

/// Blue below the middle, which is zero; then from green to red.
fn adaptation(t: f64) -> Colour {
    let [blue, green, red] = [[56, 92, 200], [70, 160, 80], [206, 56, 48]].map(Colour::from_screen);
    if t < 0.5 { blue } else { green.mixed(red, (2.0 * t - 1.0) as f32) }
}

fn of_kind(t: f64) -> Colour {
    let kind = (t * OF_KINDS.len() as f64) as usize;
    Colour::from_screen(OF_KINDS[kind.min(OF_KINDS.len() - 1)])
}

/// Charred, scorched, as it was, pale and white, with straight lines in linear light between them.
const TISSUE: [[u8; 3]; 5] = [[26, 20, 18], [92, 50, 30], [150, 52, 46], [206, 140, 124], [240, 222, 208]];

fn tissue(t: f64) -> Colour {
    between(TISSUE.map(Colour::from_screen), t)
}

/// Straight lines between colours at even distances.
fn between(colours: [Colour; 5], t: f64) -> Colour {
    let place = t * (colours.len() - 1) as f64;
    let first = (place as usize).min(colours.len() - 2);
    colours[first].mixed(colours[first + 1], (place - first as f64) as f32)
}

/// The colour of this lightness and hue, its chroma no higher than wished and than a screen can show.
fn within_screen(lightness: f64, hue: f64, wanted: f64) -> [f64; 3] {
    let at = |chroma: f64| [lightness, chroma * libm::cos(hue), chroma * libm::sin(hue)];
    let shown =
        |chroma: f64| linear_from_oklab(at(chroma)).iter().all(|value| (-1e-4..=1.0001).contains(value));
    if shown(wanted) {
        return at(wanted);
    }
    let (mut low, mut high) = (0.0, wanted);
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

    /// Equal steps of the value are equal steps of OKLab to 15 %; lightness rises all the way, or to the middle and
    /// falls as it rose.
    #[test]
    fn maps_are_uniform() {
        for map in [ColourMap::Sequential, ColourMap::Diverging, ColourMap::Grey] {
            let colours: Vec<[f64; 3]> =
                (0..=16).map(|step| oklab(map.colour(f64::from(step) / 16.0).0.map(f64::from))).collect();
            let steps: Vec<f64> = colours
                .windows(2)
                .map(|pair| {
                    assert!(map == ColourMap::Diverging || pair[1][0] > pair[0][0]);
                    (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt()
                })
                .collect();
            let mean = steps.iter().sum::<f64>() / 16.0;
            assert!(steps.iter().all(|step| (step / mean - 1.0).abs() < 0.15), "{map:?} {steps:?}");
            if map == ColourMap::Diverging {
                for k in 0..8 {
                    assert!((colours[k][0] - colours[16 - k][0]).abs() < 0.02, "{colours:?}");
                    assert!(colours[k + 1][0] > colours[k][0]);
                }
            }
        }
    }

    #[test]
    fn strange_values_have_colours() {
        for entry in COLOUR_MAPS.entries {
            assert_eq!(entry.build.colour(f64::NAN), Colour([0.35; 3]));
            assert_eq!(entry.build.colour(-1.0), entry.build.colour(0.0));
        }
    }
}
