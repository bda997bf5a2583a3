//! A chronogram in one picture: moments over each other, the earlier the fainter.

use souple_io::picture::Image;

/// How much of the first moment is left, of the last all.
const FAINTEST: f64 = 0.3;

/// Images of one size over each other, in their order; what has the colour of the background lets through what is below.
pub fn overlaid(images: &[Image], background: [u8; 3]) -> Option<Image> {
    let mut all = images.first()?.clone();
    all.pixels.fill(background);
    let last = images.len().saturating_sub(1).max(1) as f64;
    for (index, image) in images.iter().enumerate() {
        let strength = FAINTEST + (1.0 - FAINTEST) * index as f64 / last;
        let strength = if images.len() == 1 { 1.0 } else { strength };
        for (below, pixel) in all.pixels.iter_mut().zip(&image.pixels) {
            if *pixel == background {
                continue;
            }
            for (out, (own, free)) in below.iter_mut().zip(pixel.iter().zip(background)) {
                *out = (f64::from(*own) * strength + f64::from(free) * (1.0 - strength)).round() as u8;
            }
        }
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The last moment is as it is, earlier ones are fainter where nothing hides them, the background stays.
    #[test]
    fn earlier_moments_are_fainter() {
        let image = |at: usize| {
            let mut pixels = vec![[255; 3]; 4];
            pixels[at] = [0, 100, 255];
            pixels[3] = [at as u8; 3];
            Image { width: 2, height: 2, pixels }
        };
        let all = overlaid(&[image(0), image(1)], [255; 3]).unwrap();
        assert_eq!(all.pixels[1..], [[0, 100, 255], [255; 3], [1; 3]]);
        // 255 + 0.3 (own - 255)
        assert_eq!(all.pixels[0], [179, 209, 255]);
        assert_eq!(overlaid(&[image(0)], [255; 3]).unwrap(), image(0));
        assert!(overlaid(&[], [255; 3]).is_none());
    }
}
