//! How tissue looks beneath a film of blood, and how it shines.

use super::colour::Colour;

/// What red, green and blue light loses on its way through blood, but for 1/e [m]: in whole blood red goes ten times as far as the rest
/// (absorption of oxygenated haemoglobin, Prahl 1998, at 630, 550 and 450 nm).
const ABSORPTION: [f64; 3] = [600e-6, 40e-6, 30e-6];
/// In which cells of the blood send light back, but for 1/e [m].
const SCATTERING: f64 = 150e-6;
/// What they send back of white light, from a film that nothing is seen through.
const BLOOD: Colour = Colour([0.21, 0.004, 0.006]);
/// Thickness of a film that shines as wet, but for 1/e [m].
const SHINING: f64 = 20e-6;

/// A colour seen through a film of a thickness [m], which light passes twice (Beer and Lambert), with what the film sends back.
pub(super) fn seen_through(colour: Colour, thickness: f32) -> Colour {
    let thickness = f64::from(thickness.max(0.0));
    let Colour(below) = colour;
    let passed = [0, 1, 2].map(|k: usize| below[k] * libm::exp(-2.0 * thickness / ABSORPTION[k]) as f32);
    Colour(passed).mixed(BLOOD, -libm::expm1(-thickness / SCATTERING) as f32)
}

/// How much a film shines as water does, 0 to 1.
pub(super) fn wetness(thickness: f32) -> f32 {
    -libm::expm1(-f64::from(thickness.max(0.0)) / SHINING) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without a film tissue looks as it does; a thin one lets red through and little else; a thick one hides all beneath it.
    #[test]
    fn films_redden_and_hide() {
        let (pale, dark) = (Colour([0.8, 0.7, 0.6]), Colour([0.05, 0.05, 0.05]));
        assert_eq!(seen_through(pale, 0.0), pale);
        assert_eq!(wetness(0.0), 0.0);
        let Colour([red, green, blue]) = seen_through(pale, 5e-5);
        assert!(red > 0.5 && green < 0.1 * red && blue < green, "{red} {green} {blue}");
        let [Colour(a), Colour(b)] = [pale, dark].map(|below| seen_through(below, 5e-3));
        assert!(a.iter().zip(b).zip(BLOOD.0).all(|((a, b), c)| (a - b).abs() < 1e-6 && (a - c).abs() < 1e-6));
        assert!(wetness(1e-4) > 0.99);
    }
}
